#!/usr/bin/env python3
"""Runs that were stopped and taken up again, by the program: files are those of a run that was not, byte for byte.

    tests/test_resume.py [--kills N] [--seed N] [--program PATH]

Stopped by a limit, by a signal, by kill -9 at random instants; run again with other values, killed and taken up; checkpoints
damaged, of another case, of another build; results that were changed or removed. Needs a release build (or makes one). Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from test_faults import ROOT, Gudgeon, assertions, check, program_built

CASES = ROOT / "cases"
SHORT = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", "--set", "output.ideal_twin=F")
RESULTS = (".csv", ".events.csv", ".summary.csv", ".resolved.nml", ".ideal.csv", ".ideal.summary.csv")
FREE = ("wall_time,", "  max_steps =")   # what may differ: a run that is done is left with the limits that it had


def contents(path: Path) -> list[bytes]:
    if not path.exists():
        return []
    return [row for row in path.read_bytes().splitlines(keepends=True) if not row.decode().startswith(FREE)]


def differing(one: Path, other: Path, name: str) -> str:
    """Names of the results that differ; empty if none does."""
    return " ".join(end for end in RESULTS if contents(one / (name + end)) != contents(other / (name + end)))


def leftovers(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir() if path.suffix in {".part", ".checkpoint", ".lock"}]


def stopped_by_limits(gudgeon: Gudgeon, work: Path) -> None:
    """Every simulation, in a batch, stopped again and again by a limit that rises."""
    files = sorted(CASES.glob("sim_*.nml")) + sorted((CASES / "flores").glob("*.nml")) + sorted((CASES / "joints").glob("*.nml"))
    whole, parts = work / "whole", work / "parts"
    status, _, err = gudgeon.run(*SHORT, "-o", whole, *files)
    check(status == 0, f"whole runs: {status} {err}")
    for limit in (1, 100, 101, 333, 700):
        status, _, err = gudgeon.run(*SHORT, "--set", f"integrator.max_steps={limit}", "-o", parts, "--resume", *files)
        check("too many steps" in err and status == 4, f"stopped by a limit: {status} {err}")
        check(limit > 1 or "--resume continues" in err, "and says how to go on")
        check(all("from the beginning" not in line for line in err.splitlines()) or limit == 1, f"each goes on: {err}")
    status, _, err = gudgeon.run(*SHORT, "--set", "integrator.max_evaluations=2000", "-o", parts, "--resume", *files)
    check(status == 4 and "limit of evaluations reached" in err, "another limit")
    status, _, err = gudgeon.run(*SHORT, "-o", parts, "--resume", *files)
    check(status == 0, f"and to the end: {status} {err}")
    for file in files:
        wrong = differing(whole, parts, file.stem)
        check(not wrong, f"{file.name}, stopped by limits: {wrong}")
    check(not leftovers(parts), f"left behind: {leftovers(parts)}")

    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in parts.iterdir()}
    status, out, _ = gudgeon.run(*SHORT, "-o", parts, "--resume", *files)
    check(status == 0 and out.count("done already") == len(files), f"what is done stays: {status} {out}")
    check(before == {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in parts.iterdir()}, "as it is")


def stopped_by_signals(gudgeon: Gudgeon, work: Path, file: Path, length: str, kills: int, chance: random.Random) -> None:
    """One long run, killed or asked to stop at random instants until it is done."""
    words = ("--set", f"integrator.revolutions={length}", "--set", "integrator.method=auto", "--set", "output.ideal_twin=F", file)
    whole, parts = work / "whole", work / "parts"
    began = time.monotonic()
    status, _, err = gudgeon.run("-o", whole, *words)
    duration = time.monotonic() - began
    check(status == 0, f"whole run of {file.name}: {status} {err}")
    done = 0
    for _ in range(10*kills + 10):
        process = gudgeon.start("--checkpoint", 0.02, "--resume", "-o", parts, *words)
        sign = chance.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM))
        try:
            process.wait(timeout=chance.uniform(0.01, 2*duration/kills) if done < kills else 600)
        except subprocess.TimeoutExpired:
            process.send_signal(sign)
            process.wait(timeout=60)
        done += process.returncode != 0
        process.communicate()
        if process.returncode == 0:
            break
        check(process.returncode in (4, -sign), f"{file.name}: stopped, exit {process.returncode}")   # -TERM: before it is held
    check(process.returncode == 0, f"{file.name}: done after {done} stops")
    check(done >= 3, f"{file.name}: stopped {done} times")
    wrong = differing(whole, parts, file.stem)
    check(not wrong, f"{file.name}, stopped {done} times by signals: {wrong}")
    check(not leftovers(parts), f"left behind: {leftovers(parts)}")
    print(f"{file.name}: stopped {done} times", flush=True)


def stopped_by_full_disk(gudgeon: Gudgeon, work: Path) -> None:
    """A trace that finds no room: the run goes on from its last checkpoint when there is some."""
    words = ("--set", "integrator.revolutions=30", CASES / "flores" / "friction_100.nml")
    check(gudgeon.run("-o", work / "whole", *words)[0] == 0, "whole run")

    def no_room() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))
    status, _, err = gudgeon.run("--checkpoint", 0.001, "-o", work / "parts", *words, preexec_fn=no_room)
    check(status == 5 and "File too large" in err, f"no room: {status} {err}")
    check("friction_100.checkpoint" in leftovers(work / "parts"), "the checkpoint stays")
    status, _, err = gudgeon.run("--resume", "-o", work / "parts", *words)
    check(status == 0 and not err, f"goes on when there is room: {status} {err}")
    wrong = differing(work / "whole", work / "parts", "friction_100")
    check(not wrong, f"stopped by a full disk: {wrong}")


def refusals(gudgeon: Gudgeon, work: Path, chance: random.Random) -> None:
    """What is not the checkpoint of this case, program and trace is refused in one line, and nothing is touched."""
    file = CASES / "flores" / "friction_100.nml"
    words = ("--set", "integrator.method=auto", file)
    stopped = work / "stopped"
    gudgeon.run("-o", stopped, "--set", "integrator.max_steps=300", *words)
    checkpoint, trace = "friction_100.checkpoint", "friction_100.csv"
    good = (stopped / checkpoint).read_bytes()

    def refused(what: str, *extra: object, program: Gudgeon = gudgeon, change=lambda folder: None, want: str = "",
                **how) -> None:
        folder = work / "changed"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(stopped, folder)
        change(folder)
        before = {path.name: path.read_bytes() for path in folder.iterdir()}
        status, out, err = program.run("--resume", "-o", folder, *extra, *words, **how)
        check(status == 3 and not out and err.count("\n") == 1 and err.startswith("gudgeon: ") and want in err,
              f"{what} is refused in one line: exit {status}, {out}{err}")
        check(before == {path.name: path.read_bytes() for path in folder.iterdir()}, f"{what}: nothing is touched")

    def flipped(place: int):
        return lambda folder: (folder / checkpoint).write_bytes(good[:place] + bytes([good[place] ^ 1 << chance.randrange(8)])
                                                                 + good[place + 1:])
    for place in [0, len(good) - 1, *chance.sample(range(len(good)), 40)]:
        refused(f"byte {place} changed", change=flipped(place), want=checkpoint)
    for length in (0, 1, 18, 100, len(good) - 1):
        refused(f"cut to {length} bytes", change=lambda folder, n=length: (folder / checkpoint).write_bytes(good[:n]),
                want=checkpoint)
    refused("another clearance", "--set", "joint.clearance=4e-4", want="&joint clearance = 4")
    refused("another tolerance", "--accuracy", "draft", want="&integrator relative_tolerance")
    refused("a longer run", "--set", "integrator.revolutions=3", want="&integrator revolutions")
    refused("other columns", "--set", "output.columns=time", want="&output columns")
    text = (stopped / trace).read_bytes()
    refused("a trace that was changed", change=lambda folder: (folder / trace).write_bytes(b"T" + text[1:]), want=trace)
    refused("a trace that is too short", change=lambda folder: (folder / trace).write_bytes(text[:-200]), want=trace)
    refused("a trace that is missing", change=lambda folder: (folder / trace).unlink(), want=trace)
    events = "friction_100.events.csv"
    refused("events that are missing", change=lambda folder: (folder / events).unlink(), want=events)
    other = work / "other_build"
    program = gudgeon.program.read_bytes()
    mark = program.find(b"\3\0\0\0GNU\0")   # of the build id, which the linker makes of the whole program
    check(0 < mark < 4096, "the program has a build id")
    other.write_bytes(program[:mark + 8] + bytes([program[mark + 8] ^ 1]) + program[mark + 9:])
    other.chmod(0o755)
    refused("another build", program=Gudgeon(other), want="another build")
    plain = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-AVX2_Usable"}
    words_of = ("-o", work / "processor", "--set", "integrator.revolutions=1", file)
    gudgeon.run(*words_of, env=plain)
    with_plain = (work / "processor" / trace).read_bytes()
    gudgeon.run(*words_of)
    if with_plain != (work / "processor" / trace).read_bytes():   # else the processor has no choice, or the library
        refused("another processor", env=plain, want="another kind of processor")
    check(gudgeon.run("--resume", "-o", stopped, *words)[0] == 0, "the right one goes on")


def beginnings(gudgeon: Gudgeon, work: Path) -> None:
    """No checkpoint, none wanted, the ideal twin, and a run begun anew."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", file)
    status, _, err = gudgeon.run("--resume", "-o", work / "a", *words)
    check(status == 0 and err.count("\n") == 1 and "starts from the beginning" in err, f"no checkpoint: {status} {err}")
    limit = ("--set", "integrator.max_steps=20")
    gudgeon.run("--checkpoint", 0, *limit, "-o", work / "b", *words)
    check("sim_I.checkpoint" not in leftovers(work / "b"), "with --checkpoint 0 there is none")
    gudgeon.run(*limit, "-o", work / "b", *words)
    check("sim_I.checkpoint" in leftovers(work / "b"), "else there is")
    status, out, _ = gudgeon.run("-o", work / "b", *words)
    check(status == 0 and not leftovers(work / "b"), "a run that begins anew and is done leaves none")
    (work / "b" / "sim_I.ideal.csv").unlink()
    status, out, _ = gudgeon.run("--resume", "-o", work / "b", *words)
    check(status == 0 and "done already" in out, "a run that is done")
    check((work / "a" / "sim_I.ideal.csv").read_bytes() == (work / "b" / "sim_I.ideal.csv").read_bytes(), "its twin is run again")
    status, _, err = gudgeon.run("--resume", "-o", work / "b", "--set", "joint.clearance=3e-5", *words)
    check(status == 0 and "starts from the beginning" in err, "another case that is done is not this one")
    for value in ("-1", "ten", "", "1e9", "1.2.3"):
        status, _, err = gudgeon.run("--checkpoint", value, *words)
        check(status == 2 and "--checkpoint" in err, f"--checkpoint {value}: {status} {err}")


def rerun_with_other_values(gudgeon: Gudgeon, work: Path, kills: int, chance: random.Random) -> None:
    """Runs into a folder that holds the results of other values, killed at random instants: nothing of the other values ever stands
    beside what the new run has written, and --resume ends with the rows of the values that it is given."""
    name, folder = "sim_III", work / "again"
    always = ("--set", "integrator.method=auto", "--set", "integrator.revolutions=12", "--checkpoint", 0.02, CASES / f"{name}.nml")
    speeds = [1500, 1600, 1700, 1800]
    expected, duration = {}, 0.0
    for speed in speeds:
        began = time.monotonic()
        status, _, err = gudgeon.run("-o", work / str(speed), "--set", f"initial.crank_speed={speed}", *always)
        duration = max(duration, time.monotonic() - began)
        check(status == 0, f"whole run at {speed} rad/s: {status} {err}")
        expected[speed] = {end: b"".join(contents(work / str(speed) / (name + end))) for end in RESULTS}
    check(len({files[".csv"] for files in expected.values()}) == len(speeds), "each speed has its own rows")

    def foreign(speed: int) -> str:
        """Results in the folder that are of another speed, where the resolved case says this one."""
        for end in (".csv", ".events.csv", ".ideal.csv"):
            for path in (folder / (name + end), folder / (name + end + ".part")):
                rows = path.read_bytes() if path.exists() else b""
                if not expected[speed][end].startswith(rows[:rows.rfind(b"\n") + 1]):
                    return f"{path.name} is not of {speed} rad/s"
        for end in (".summary.csv", ".ideal.summary.csv"):
            rows = contents(folder / (name + end))
            if rows and next((row for row in rows if row.startswith(b"identity,")), b"none") not in expected[speed][end]:
                return f"{name + end} is not of {speed} rad/s"
        return ""

    present, killed, early, done_before = None, 0, 0, 0
    for i in range(kills):
        speed = chance.choice([each for each in speeds if each != present])
        words = ("-o", folder, "-j", chance.choice((1, 2)), *always, "--set")
        process = gudgeon.start(*words, f"initial.crank_speed={speed}")
        try:
            process.wait(timeout=chance.choice((chance.uniform(0, 0.03), *2*[chance.uniform(0, 1.1*duration)])))
        except subprocess.TimeoutExpired:
            process.kill()
            killed += 1
        process.communicate()
        resolved = folder / f"{name}.resolved.nml"
        found = of_speed(resolved, speeds)
        early += found != speed
        if found is not None:
            check(not foreign(found), f"kill {i}: {foreign(found)}")
        wanted = speed if present is None or chance.random() < 0.7 else present   # with the new values, or the old ones again
        status, out, err = gudgeon.run("--resume", *words, f"initial.crank_speed={wanted}")
        if status == 3 and wanted != found and "but the stopped run has" in err:   # the checkpoint of other values
            status, out, err = gudgeon.run(*words, f"initial.crank_speed={wanted}")
        done_before += "done already" in out
        wrong = [end for end in RESULTS if b"".join(contents(folder / (name + end))) != expected[wanted][end]]
        check(status == 0 and not wrong, f"kill {i}, then {wanted} rad/s: exit {status}, {err}{wrong} are not its results")
        check(not leftovers(folder), f"kill {i}: left behind: {leftovers(folder)}")
        present = wanted
    print(f"{name} run again with other values: {killed} kills in {kills} runs, {early} before the new run had its place, "
          f"{done_before} taken up that were done", flush=True)


def of_speed(resolved: Path, speeds: list[int]) -> int | None:
    """The speed in a resolved case."""
    for line in resolved.read_text().splitlines() if resolved.exists() else []:
        key, _, value = line.partition("=")
        if key.strip() == "crank_speed":
            return next(speed for speed in speeds if float(value.split("!")[0]) == speed)
    return None


def results_of_others(gudgeon: Gudgeon, work: Path) -> None:
    """What is done is taken for done only where all of it is there and belongs to this case and program."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", "--set", "output.ideal_twin=T", file)
    whole, folder = work / "whole", work / "folder"
    check(gudgeon.run("-o", whole, *words)[0] == 0, "whole run")

    def taken_up(what: str, name: str, change, twin_only: bool = False) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(whole, folder)
        change(folder / name)
        status, out, err = gudgeon.run("--resume", "-o", folder, *words)
        check(status == 0 and ("done already" in out) == twin_only, f"{what}: run again: {status} {out}{err}")
        check(not differing(whole, folder, "sim_I"), f"{what}: {differing(whole, folder, 'sim_I')} are not whole")

    for end in RESULTS:
        taken_up(f"without sim_I{end}", f"sim_I{end}", Path.unlink, end.startswith(".ideal"))
    for end in (".csv", ".events.csv", ".ideal.csv"):
        taken_up(f"sim_I{end} cut", f"sim_I{end}", lambda path: path.write_bytes(path.read_bytes()[:-1]), end.startswith(".ideal"))
        taken_up(f"sim_I{end} longer", f"sim_I{end}", lambda path: path.write_bytes(path.read_bytes() + b"0\n"),
                 end.startswith(".ideal"))

    def of_another(path: Path) -> None:
        text = path.read_text()
        at = text.index("\nidentity,") + 10
        path.write_text(text[:at] + ("0" if text[at] != "0" else "1") + text[at + 1:])
    for end in (".summary.csv", ".ideal.summary.csv"):
        taken_up(f"sim_I{end} of another run", f"sim_I{end}", of_another, end.startswith(".ideal"))
    # a scene without contacts and without a twin leaves nothing of the scene that had them
    plain = work / "sim_I.nml"
    shutil.copy(CASES / "flores" / "ideal.nml", plain)
    status, _, err = gudgeon.run("-o", folder, *words[:4], plain)
    check(status == 0, f"a plain scene of the same name: {status} {err}")
    left = sorted(path.name for path in folder.iterdir())
    check(left == ["sim_I.csv", "sim_I.resolved.nml", "sim_I.summary.csv"], f"what is left: {left}")
    # another case that happens to have the name of a twin is none
    named = work / "sim_I.ideal.nml"
    shutil.copy(CASES / "flores" / "ideal.nml", named)
    gudgeon.run("-o", folder, "--set", "integrator.revolutions=0.1", named)
    before = (folder / "sim_I.ideal.csv").read_bytes()
    gudgeon.run("-o", folder, *words[:4], "--set", "output.ideal_twin=F", file)
    check((folder / "sim_I.ideal.csv").read_bytes() == before, "results of a case with the name of a twin stay")


def twin_taken_up(gudgeon: Gudgeon, work: Path) -> None:
    """An ideal twin that was stopped goes on like any other run."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=4", "--set", "integrator.method=auto", file)
    check(gudgeon.run("-o", work / "whole", *words)[0] == 0, "whole run")
    for limit in (20, 60, 100, 200):
        status, _, err = gudgeon.run("--resume", "--set", f"integrator.max_steps={limit}", "-o", work / "parts", *words)
        check(status == 4 and err.count("too many steps") == 1, f"stopped after {limit} steps: {status} {err}")
    summary = (work / "parts" / "sim_I.ideal.summary.csv").read_text()
    check('status,"done"' in summary or 'status,"too many steps' in summary, f"the twin has a summary: {summary[:200]}")
    check(gudgeon.run("--resume", "-o", work / "parts", *words)[0] == 0, "and to the end")
    check(not differing(work / "whole", work / "parts", "sim_I"), f"{differing(work / 'whole', work / 'parts', 'sim_I')} differ")
    check(not leftovers(work / "parts"), f"left behind: {leftovers(work / 'parts')}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--kills", type=int, default=20, help="signals to each long run (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path)
    options = parser.parse_args()
    gudgeon = Gudgeon(options.program or program_built())
    chance = random.Random(options.seed)
    work = Path(tempfile.mkdtemp())
    try:
        stopped_by_limits(gudgeon, work / "limits")
        stopped_by_signals(gudgeon, work / "film", CASES / "sim_V_oscillating.nml", "60", options.kills, chance)
        stopped_by_signals(gudgeon, work / "dry", CASES / "flores" / "friction_100.nml", "60", options.kills, chance)
        rerun_with_other_values(gudgeon, work / "rerun", options.kills, chance)
        results_of_others(gudgeon, work / "others")
        twin_taken_up(gudgeon, work / "twin")
        stopped_by_full_disk(gudgeon, work / "disk")
        refusals(gudgeon, work / "refused", chance)
        beginnings(gudgeon, work / "begin")
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
