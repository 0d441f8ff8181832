#!/usr/bin/env python3
"""Measures what the library, the Python package and mock-up units promise, and writes data/measured/embedding.md.

    scripts/bench/measure_embedding.py [--wheel FILE] [--out DIR] [--point N]

--wheel: a wheel made by auditwheel, tried in a fresh environment in which gfortran and its libraries are hidden (as root); --point: print one
part alone. Needs the packages of scripts/setup.sh --embedding and a library built by scripts/python/build_library.py; strace for point 7.
Times are the best of several, alternating with what they are compared with; on a busy machine only their ratios mean something.
"""

import argparse
import itertools
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from measured import FOLDER, TOP, built_program, use_virtual_environment, write_table

use_virtual_environment()
sys.path[:0] = [str(TOP / "scripts/python/src"), str(TOP / "tests")]

import gudgeon
import numpy as np
import test_fmu
import test_python
from fmpy.validation import validate_fmu
from test_python import case_of

CASES = sorted(str(path.relative_to(TOP / "cases").with_suffix("")) for path in (TOP / "cases").rglob("*.nml") if "studies" not in path.parts)
SCENES = {   # of FMI: film, dry, half film, oscillating, gas, compressor, both joints, guide, elastic rod, wear
    "sim_I": {}, "flores/friction_100": {}, "sim_II": {"lubrication.variant": "half_film"}, "sim_II_oscillating": {}, "gas/measured": {},
    "gas/compressor": {}, "joints/both_pins": {}, "joints/piston_slap": {}, "elastic/engine_rod": {}, "wear/worn_bore": {},
}  # fmt: skip
PROGRAM = built_program()
Rows = Iterator[tuple[str, str, str]]


def scene(name: str) -> gudgeon.Case:
    return case_of(name).set(SCENES[name])


def of_program() -> Rows:
    """Every shipped case in Python, with and without 313 pauses, against the files of the program."""
    test_python.passed = test_python.failed = 0
    test_python.against_program(str(PROGRAM), CASES)
    yield f"{len(CASES)} shipped cases against the program: rows at 17 digits, events, summary, files; the same with 313 pauses", \
        f"{test_python.passed} comparisons, {test_python.failed} differ", "none"


def of_units(folder: str) -> Rows:
    """Mock-up units against runs."""
    complaints, worst, other, common = 0, 0.0, 0.0, 0
    for (name, fmi) in itertools.product(SCENES, (2, 3)):
        case = scene(name)
        path = gudgeon.fmu(case, Path(folder) / "unit.fmu", fmi)
        complaints += len(validate_fmu(str(path)))
        end = 0.05 if name in ("joints/piston_slap", "wear/worn_bore") else case.begin().end
        run = case.run(end=end)
        unit = test_fmu.Unit(path, fmi, folder, end)
        columns = [run.names.index(output) for output in unit.outputs]
        spans = np.ptp(run._rows, axis=0)[columns]
        spans[spans == 0] = 1
        for i, t in enumerate(run["time"][:-1]):
            if i:
                unit.unit.doStep(run["time"][i - 1], t - run["time"][i - 1])
            worst = max(worst, float(np.nanmax(np.abs(unit.get() - run._rows[i, columns]) / spans)))
        unit.free()
        unit, step = test_fmu.Unit(path, fmi, folder, end), end / 8
        for i in range(7):   # at times that rows have as well
            for k in range(5):
                unit.unit.doStep(i * step + k * step / 5, step / 5)
            at = np.flatnonzero(np.abs(run["time"] - (i + 1) * step) < 1e-12 * end)
            if len(at):
                common += 1
                other = max(other, float(np.nanmax(np.abs(unit.get() - run._rows[at[0], columns]) / spans)))
        unit.free()
    yield "FMPy's validation of ten scenes, FMI 2.0 and 3.0", f"{complaints} complaints", "none"
    yield "the same stepped at the times of the rows: largest difference over the column's range", f"{worst:.1e}", "1e-9"
    yield f"another step, at {common} common times", f"{other:.1e}", "1e-9"
    sets = [("joint.clearance", 3e-5), ("mechanism.rod_com[1]", 0.06)]
    path = gudgeon.fmu(case_of("sim_I"), Path(folder) / "unit.fmu")
    unit, stepper = test_fmu.Unit(path, 2, folder, 0.02, sets), case_of("sim_I").set({"joint.clearance": 3e-5, "mechanism.rod_com": (0.06, 0.0)}).begin(end=0.02)
    unit.unit.doStep(0, 0.015)
    stepper.advance(0.015)
    apart = np.abs(unit.get() - [stepper.values[name] for name in unit.outputs]).max()
    yield "parameters set by the master, against a run of the changed case", f"{apart:g}", "0"
    errors = motor_errors(folder)
    yield "torque of `drive/motor` held by the master over 100, 200, 400, 800 steps: error of the speed", ", ".join(f"{e:.2e}" for e in errors), "halves"
    free = case_of("sim_I").set(drive={"kind": "free"}, integrator={"relative_tolerance": 1e-9, "method": "adams"})
    right = free.set({"integrator.relative_tolerance": 1e-12}).run(end=0.1)["crank_speed"]
    smooth, cut = free.run(end=0.1)["crank_speed"], free.begin(end=0.1)
    for i in range(1, 501):
        cut.inputs["drive.torque"] = 1e-12 * i
        cut.advance(0.1 * i / 500)
    own, apart = np.abs(smooth - right).max(), np.abs(cut.finish()["crank_speed"] - right).max()
    yield "a torque cut 500 times at a tolerance of 1e-9: its error over the run's own error", f"{apart / own:.1f} ({own:.1e} rad/s)", "5"


def motor_errors(folder: str) -> list[float]:
    """Relative errors of the speed where the master holds the motor's torque."""
    case, end = case_of("drive/motor"), 0.05
    table = np.loadtxt(TOP / "cases/drive/motor.csv", delimiter=",", skiprows=2)
    want, found = case.run(end=end)["crank_speed"], []
    path = gudgeon.fmu(case.set({"drive.torque_table": None}), Path(folder) / "motor.fmu")
    for steps in (100, 200, 400, 800):
        unit = test_fmu.Unit(path, 2, folder, end)
        for i in range(steps):
            unit.set("drive.torque", test_fmu._torque(table, unit.get("crank_speed")[0]))
            unit.unit.doStep(i * end / steps, end / steps)
        found.append(abs(unit.get("crank_speed")[0] - want[-1]) / np.ptp(want))
        unit.free()
    return found


def of_states(folder: str) -> Rows:
    """Saved states, memory and threads."""
    same = total = 0
    for name, method in itertools.product(("flores/friction_100", "friction/lugre", "sim_I", "gas/compressor", "wear/worn_bore"), ("adams", "radau", "auto")):
        stepper = case_of(name).set({"integrator.method": method}).begin()
        end = min(stepper.end, 0.03)
        for i in range(20):
            stepper.advance(end * (i + 0.5) / 20)
            saved = stepper.snapshot()
            stepper.advance(end * (i + 1) / 20)
            first = [*stepper.values.values()]
            stepper.restore(saved)
            stepper.advance(end * (i + 1) / 20)
            same, total = same + np.array_equal(first, [*stepper.values.values()], equal_nan=True), total + 1
    yield "save, step, put back, step: the same bits (contact, bristles, film, valves, wear; Adams, Radau, auto)", f"{same} of {total}", "all"
    case = case_of("sim_I")

    def in_python() -> None:
        stepper = case.begin(end=0.002)
        stepper.advance(0.001)
        stepper.restore(stepper.snapshot())
        stepper.finish()

    yield "growth of resident memory over 1,000 instances in Python, with saved states", f"{growth(in_python)} kB", "1000 kB"
    unit = test_fmu.Unit(gudgeon.fmu(case, Path(folder) / "unit.fmu"), 2, folder, 0.1)
    import fmpy

    def in_master() -> None:
        one = fmpy.instantiate_fmu(unit.place, unit.description, "CoSimulation")
        one.setupExperiment(startTime=0, stopTime=0.1)
        one.enterInitializationMode()
        one.exitInitializationMode()
        one.doStep(0, 0.001)
        one.freeFMUstate(one.getFMUstate())
        one.fmi2FreeInstance(one.component)

    yield "the same of a unit", f"{growth(in_master)} kB", "1000 kB"
    table = gudgeon.sweep(case.set({"integrator.revolutions": 1}), {"joint.clearance": np.linspace(1e-5, 4e-5, 250)}, workers=1)
    others = [gudgeon.sweep(case.set({"integrator.revolutions": 1}), {"joint.clearance": np.repeat(np.linspace(1e-5, 4e-5, 250), 8)}, workers=8)]
    wrong = sum(not others[0].iloc[k::8].reset_index(drop=True).equals(table) for k in range(8))
    yield "8 threads, 250 runs each, against one thread: rows of results that differ", f"{250 * wrong if wrong else 0} of 2000", "none"
    garbled = [0] * 8

    def refuse(number: int) -> None:
        for i in range(4000):
            try:
                gudgeon.Case.from_text(f"&mechanism nothing_{number}_{i} = 1 /").check()
            except gudgeon.CaseError as error:
                garbled[number] += f"nothing_{number}_{i}" not in str(error)

    threads = [threading.Thread(target=refuse, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    yield "8 threads, 4,000 refused cases each: wrong messages", f"{sum(garbled)} of 32000", "none"


def growth(once: Callable[[], None], times: int = 1000) -> int:
    """Growth of the resident memory over so many calls after the first 500 [kB]."""
    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1000

    for _ in range(500):
        once()
    before = resident()
    for _ in range(times):
        once()
    return resident() - before


def best(*calls: Callable[[], object], repeats: int = 5) -> list[tuple[float, float]]:
    """Least time of the clock and of the processor of each call [s], called in turn."""
    def processor() -> float:
        return sum(part.ru_utime + part.ru_stime for part in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))

    found = [(9e9, 9e9)] * len(calls)
    for _ in range(repeats):
        for i, call in enumerate(calls):
            clock, used = time.perf_counter(), processor()
            call()
            found[i] = (min(found[i][0], time.perf_counter() - clock), min(found[i][1], processor() - used))
    return found


def burn(programs: int) -> None:
    """Programs that do nothing but count, at once."""
    code = "for i in range(10_000_000): pass"
    for running in [subprocess.Popen([sys.executable, "-c", code]) for _ in range(programs)]:
        running.wait()


def of_speed(folder: str) -> Rows:
    """Costs beside those of the program."""
    path = TOP / "cases/sim_I.nml"
    python, program = best(lambda: gudgeon.read(path).run(), lambda: subprocess.run([PROGRAM, "-q", "-o", folder, path], check=True), repeats=20)
    yield "simulation I read and run in Python, and by the program: ms of the clock", f"{1e3 * python[0]:.1f}, {1e3 * program[0]:.1f}: {python[0] / program[0]:.2f}", "ratio 1.1"
    study = Path(folder) / "study.nml"
    study.write_text(f"&study case = '{path}' /\n&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 10 /\n"
                     "&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02, count = 100 /\n")
    loose = gudgeon.read(path).set({"integrator.relative_tolerance": 1e-4})
    design = {"joint.clearance": np.linspace(1e-5, 4e-5, 10), "lubrication.viscosity": np.linspace(0.005, 0.02, 100)}
    command = [PROGRAM, "sweep", "-q", "--fresh", "-s", "integrator.relative_tolerance=1e-4", "-o", folder, study]
    one, two, sweep, both = best(lambda: gudgeon.sweep(loose, design, workers=1), lambda: gudgeon.sweep(loose, design, workers=2),
                                 lambda: subprocess.run([*command, "-j", "1"], check=True), lambda: subprocess.run([*command, "-j", "2"], check=True))
    yield "sweep of 1,000 runs on one core, and `gudgeon sweep -j 1`: s of the processor", f"{one[1]:.2f}, {sweep[1]:.2f}: {one[1] / sweep[1]:.2f}", "ratio 1.3"
    alone, beside = best(lambda: burn(1), lambda: burn(2), repeats=3)
    yield "two threads over one, and `gudgeon sweep -j 2` over `-j 1`: times faster by the clock", f"{one[0] / two[0]:.2f}, {sweep[0] / both[0]:.2f}", "1.7 on two quiet cores"
    yield "the same of two plain loops at once: what the machine had to give", f"{2 * alone[0] / beside[0]:.2f}", ""
    yield "processor time of two threads over one", f"{two[1] / one[1]:.2f}", ""
    unit = test_fmu.Unit(gudgeon.fmu(case_of("sim_I"), Path(folder) / "unit.fmu"), 2, folder, 0.1)
    at = iter(np.arange(0, 0.1, 1e-5))
    step, outputs = [], []
    for t in itertools.islice(at, 2000):
        clock = time.perf_counter()
        unit.unit.doStep(t, 1e-5)
        middle = time.perf_counter()
        unit.get()
        step.append(middle - clock)
        outputs.append(time.perf_counter() - middle)
    yield "a step of a unit in FMPy, and all outputs beside it: us (median)", f"{1e6 * np.median(step):.0f}, {1e6 * np.median(outputs):.0f}", "20 for the outputs"


def of_start(wheel: str | None, folder: str) -> Rows:
    """Variations, and a fresh environment."""
    clock = time.perf_counter()
    table = gudgeon.sweep(gudgeon.template("film"), {"joint.clearance": np.linspace(1e-5, 6e-5, 50)})
    yield "50 variations with one line of Python", f"{(table.status == 'done').sum()} done in {time.perf_counter() - clock:.2f} s", "all"
    code = "import time; import numpy; t = time.perf_counter(); import gudgeon; print(1e3*(time.perf_counter() - t))"
    environment = {**os.environ, "PYTHONPATH": str(TOP / "scripts/python/src")}
    times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout) for _ in range(5)]
    yield "`import gudgeon` beyond NumPy: ms", f"{min(times):.1f}", "30"
    if wheel is None:
        return
    subprocess.run([sys.executable, "-m", "venv", f"{folder}/fresh"], check=True)
    python = f"{folder}/fresh/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", wheel, "scipy"], check=True)
    code = ("import sys\nif len(sys.argv) > 1: import scipy.linalg, scipy.integrate\nimport gudgeon, hashlib\nrun = gudgeon.template('film').run()\n"
            "print(hashlib.sha256((run._rows + 0.0).tobytes()).hexdigest(), run.status)")
    here = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout
    hide = "for f in $(ldconfig -p | sed -n 's/.* => //p' | grep -e libgfortran -e libquadmath) $(ls /usr/bin/*gfortran*); do mount --bind /dev/null $f; done\n"
    lines = f"PATH=/usr/bin:/bin; gfortran --version >/dev/null 2>&1 && echo gfortran\n{python} -c \"$CODE\"; {python} -c \"$CODE\" x"
    bare = {name: value for name, value in os.environ.items() if name not in ("GUDGEON_LIBRARY", "PYTHONPATH")}
    there = subprocess.run(["unshare", "-m", "sh", "-c", hide + lines], capture_output=True, text=True, env={**bare, "CODE": code}).stdout
    yield "a wheel in a fresh environment without gfortran and its libraries, alone and beside SciPy: the bits of the checkout", \
        f"{there.splitlines().count(here.strip())} of 2", "all"


def of_interruption() -> Rows:
    """Ctrl-C."""
    def interrupted(run: Callable[[], object], after: float) -> tuple[float, BaseException]:
        threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        began = time.perf_counter()
        try:
            run()
        except KeyboardInterrupt as error:
            return time.perf_counter() - began - after, error
        raise SystemExit("not interrupted")

    waits = []
    for name in ("sim_V", "flores/dry_0500um", "film/sim_IV_mixed", "joints/piston_slap", "elastic/engine_rod"):
        case = case_of(name).set({"integrator.revolutions": 100000, "output.columns": "none"})
        wait, error = interrupted(case.run, 0.7)
        assert error.run.summary["simulated_time"] > 0   # type: ignore[attr-defined]
        waits.append(wait)
    yield "Ctrl-C in runs of five cases: the longest wait, with the run so far", f"{max(waits):.2f} s", "0.2 s"
    long = case_of("sim_I").set({"integrator.revolutions": 300})
    wait, error = interrupted(lambda: gudgeon.sweep(long, {"joint.clearance": np.linspace(1e-5, 4e-5, 2000)}), 1.5)
    yield "Ctrl-C in a sweep: the wait, and the rows that are kept", f"{wait:.2f} s, {len(error.table)} rows", "0.2 s"   # type: ignore[attr-defined]
    try:
        gudgeon.sweep(case_of("sim_I"), {"joint.clearance": [1e-5, 2e-5]}, reduce=lambda run: run["nothing"], workers=1)
    except RuntimeError as error:
        yield "an exception in `reduce`", f"says `{str(error)[:15]}`", "its row"


def of_safety(folder: str) -> Rows:
    """What is written and read."""
    path = gudgeon.fmu(gudgeon.template("film"), Path(folder) / "unit.fmu")
    code = {"a run in Python": f"import gudgeon; gudgeon.read({str(TOP / 'cases/sim_I.nml')!r}).run()",
            "a run with a table of a film, without a cache": f"import gudgeon; c = gudgeon.read({str(TOP / 'cases/film/sim_I_finite.nml')!r}); c.cache(None); c.run(end=1e-3)",
            "a unit in FMPy": f"import fmpy; fmpy.simulate_fmu({folder + '/place'!r}, stop_time=0.01)"}
    import fmpy

    fmpy.extract(str(path), f"{folder}/place")
    environment = {**os.environ, "PYTHONPATH": str(TOP / "scripts/python/src"), "PYTHONDONTWRITEBYTECODE": "1"}
    for what, lines in code.items():
        trace = f"{folder}/trace"
        subprocess.run(["strace", "-f", "-qq", "-o", trace, "-e", "trace=openat,open,creat,rename,renameat2,unlink,unlinkat,mkdir", sys.executable, "-c", lines],
                       check=True, env=environment, cwd=folder, capture_output=True)
        written = [line for line in Path(trace).read_text().splitlines() if re.search(r"O_WRONLY|O_RDWR|O_CREAT|rename|unlink|mkdir|creat\(", line)
                   and "/dev/" not in line and "= -1" not in line]
        yield f"files written by {what} (strace)", f"{len(written)}" + (f" ({written[0][:90]})" if written else ""), "none"
    tried = refused = 0
    for key in (key for key in gudgeon.keys.values() if key.is_path):
        for file in ("/etc/passwd", "../cases/sim_I.nml", "a/../../x.csv"):
            case = case_of("sim_I")
            case[f"{key.group}.{key.name}"] = file
            tried += 1
            try:
                case.check()
            except gudgeon.CaseError as error:
                refused += "must be a file in the folder" in str(error) and key.name in str(error)
    yield "keys that name files, outside the folder of the case: refused", f"{refused} of {tried}", "all"
    case = case_of("sim_I").set({"case.title": "<script>'&\"</script>"})
    case.name = "<i>&name"
    run, path = case.run(end=1e-3), gudgeon.fmu(case, Path(folder) / "title.fmu")
    texts = [run._repr_html_(), run.report().text, run.report()._repr_html_()]
    described = fmpy.read_model_description(str(path)).description == "<script>'&\"</script>"
    found = sum("<script>'" in text or "<i>&name" in text for text in texts)
    yield "titles and names in pages, notebooks and descriptions of units: unescaped", f"{found + (not described)}", "none"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel")
    parser.add_argument("--out", type=Path, default=FOLDER, help="folder of the page (default: %(default)s)")
    parser.add_argument("--point", type=int, choices=range(1, 8), help="print this part alone")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        parts = {
            1: ("The same results", of_program), 2: ("Mock-up units", lambda: of_units(folder)), 3: ("States, memory, threads", lambda: of_states(folder)),
            4: ("Speed", lambda: of_speed(folder)), 5: ("Start", lambda: of_start(options.wheel, folder)), 6: ("Interruption", of_interruption),
            7: ("Safety", lambda: of_safety(folder)),
        }  # fmt: skip
        text = ["| | measured | wanted |", "|---|---|---|"]
        for number, (title, part) in parts.items():
            if options.point in (None, number):
                text.append(f"| **{number}. {title}** | | |")
                for row in part():
                    text.append(f"| {' | '.join(row)} |")
                    print(text[-1], flush=True)
    if options.point is None:
        load = f"The machine was shared; load over 15 minutes: {os.getloadavg()[2]:.1f}.\n\n"
        print(write_table("embedding", "The program inside other programs", "scripts/bench/measure_embedding.py --wheel FILE", load + "\n".join(text), options.out))


if __name__ == "__main__":
    main()
