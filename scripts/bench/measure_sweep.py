#!/usr/bin/env python3
"""Measures the cost of a parameter study beyond that of its runs, and the gain by a second process.

    scripts/bench/measure_sweep.py [--runs 10000] [--repeats 3] [--processes 2]
    scripts/bench/measure_sweep.py --instructions

The study varies clearance and viscosity of simulation I (method auto, accuracy draft, a grid). Three measurements:
 - throughput of `gudgeon sweep` on one process and on several, measured alternately; the best of the repeats. Other programs that
   run on the machine make it wrong. For comparison as many programs of one process at once, which share nothing but the machine:
   what they lack to the number of processes is the machine's;
 - processor time of the sweep and of the same runs simulated one after the other in one process (scripts/bench/measure_runs.f90), without
   and with the statistics of revolutions;
 - instructions of a sweep of 200 runs under valgrind: those of the simulations, and those of the sweep itself (setting and checking
   the parameters, writing the rows). With --instructions only this is measured.
Run it from the top of the checkout. It prints a table.
"""
import argparse
import os
import re
import resource
import subprocess
import tempfile
import time

from measured import built_program

STUDY = """&study case = '{case}' /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = {first} /
&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02, count = 100 /
"""
SETTINGS = ["-q", "--fresh", "-s", "integrator.method=auto", "-s", "integrator.relative_tolerance=1e-4"]


def timed(*commands):
    """Wall time and processor time in seconds of commands that run at the same time, and the output of the last one."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    for running in [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]:
        printed, _ = running.communicate()
        if running.returncode != 0:
            raise SystemExit(f"measure_sweep: exit status {running.returncode} of {' '.join(running.args)}")
    clock = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return clock, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, printed


def instructions(command, function, folder):
    """Instructions spent inside a function."""
    done = subprocess.run(["valgrind", "--tool=callgrind", f"--toggle-collect={function}",
                           f"--callgrind-out-file={folder}/callgrind", *command], capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def count_instructions(sweep, folder):
    """Print the number of instructions in a sweep of 200 runs on one process that are not part of the simulations."""
    whole = instructions(sweep, "__study_worker_MOD_run", folder)
    simulated = instructions(sweep, "__study_worker_MOD_carry_out", folder)
    if simulated == 0:
        raise SystemExit("measure_sweep: the procedure `carry_out` was not found in the program")
    print(f"sweep, 1 process: {simulated/200:.0f} instructions a run in the simulation, {(whole - simulated)/200:.0f} beside it, "
          f"{100*(whole/simulated - 1):.2f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=10000, help="a multiple of 200 (default: %(default)s)")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--instructions", action="store_true", help="count only the instructions of a sweep")
    options = parser.parse_args()
    gudgeon = built_program()
    with tempfile.TemporaryDirectory() as folder:
        def study(count, part=1):
            os.makedirs(f"{folder}/{part}", exist_ok=True)
            path = f"{folder}/{part}/study_{count}.nml"
            with open(path, "w", encoding="utf-8") as file:
                file.write(STUDY.format(case=os.path.abspath("cases/sim_I.nml"), first=count // 100))
            return path

        def sweep(path, processes):
            return [gudgeon, "sweep", *SETTINGS, "-j", str(processes), "-o", os.path.dirname(path), path]

        if options.instructions:
            count_instructions(sweep(study(200), 1), folder)
            return
        path, runs = study(options.runs), built_program("measure_runs")
        parts = [sweep(study(options.runs // options.processes, part), 1) for part in range(2, 2 + options.processes)]
        clock, processor = {}, {}
        for _ in range(options.repeats):
            for name, *commands in (("sweep, 1 process", sweep(path, 1)),
                                    (f"sweep, {options.processes} processes", sweep(path, options.processes)),
                                    (f"{options.processes} programs at once", *parts),
                                    ("bare runs", [runs, path]), ("runs with statistics", [runs, path, "watched"])):
                seconds, cpu, printed = timed(*commands)
                if "runs" == name.split()[-1] or "statistics" in name:   # without the time that builds the cases
                    cpu, seconds = (float(x) for x in printed.split("\n")[1].split(",")[2:])
                clock[name] = min(seconds, clock.get(name, seconds))
                processor[name] = min(cpu, processor.get(name, cpu))
        print(f"{options.runs} runs, best of {options.repeats}; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
        for name in clock:
            print(f"{name:24s} {clock[name]:8.2f} s  {processor[name]:8.2f} s processor time, "
                  f"{1e6*processor[name]/options.runs:8.1f} us a run, {100*(processor[name]/processor['bare runs'] - 1):+5.1f} %")
        alone = clock["sweep, 1 process"]
        print(f"throughput on {options.processes} processes over 1: {alone/clock[f'sweep, {options.processes} processes']:.2f}, of "
              f"{options.processes} programs at once {alone/clock[f'{options.processes} programs at once']:.2f}; processor time of a run, 1 process over "
              f"{options.processes}: {processor['sweep, 1 process']/processor[f'sweep, {options.processes} processes']:.3f}")
        count_instructions(sweep(study(200), 1), folder)


if __name__ == "__main__":
    main()
