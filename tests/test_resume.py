#!/usr/bin/env python3
"""Runs that are stopped and resumed by the program: the files are those of an uninterrupted run, byte for byte.

    tests/test_resume.py [--kills N] [--seed N] [--program PATH]

Runs are stopped by a limit, by a signal, by kill -9 at random times; started again with other values, killed and resumed.
Checkpoints are damaged, or belong to another case or build; results are changed or removed. Needs a release build (or makes one).
Ends with the line
"N passed, N failed".
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
FREE = ("wall_time,", "  max_steps =", "  max_evaluations =")   # lines that may differ: a run that is done keeps its limits


def contents(path: Path) -> list[bytes]:
    if not path.exists():
        return []
    return [row for row in path.read_bytes().splitlines(keepends=True) if not row.decode().startswith(FREE)]


def differing(one: Path, other: Path, name: str) -> str:
    """Names of the results that differ; empty if all are equal."""
    return " ".join(end for end in RESULTS if contents(one / (name + end)) != contents(other / (name + end)))


def leftovers(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir() if path.suffix in {".part", ".checkpoint", ".lock"}]


def stopped_by_limits(gudgeon: Gudgeon, work: Path) -> None:
    """Every case that can be shortened to half a revolution, in a batch, stopped repeatedly by an increasing limit."""
    files = [file for file in sorted(CASES.glob("*.nml")) + sorted(CASES.glob("*/*.nml"))
             if file.parent.name != "studies" and not file.stem.startswith(("spheres_", "motor"))]
    whole, parts = work / "whole", work / "parts"
    status, _, err = gudgeon.run(*SHORT, "-o", whole, *files)
    check(status == 0, f"uninterrupted runs: {status} {err}")
    for limit in (1, 100, 101, 333, 700):
        status, _, err = gudgeon.run(*SHORT, "--set", f"integrator.max_steps={limit}", "-o", parts, "--resume", *files)
        check("too many steps" in err and status == 4, f"stopped by a limit: {status} {err}")
        check(limit > 1 or "--resume continues" in err, "the message names --resume")
        check(all("from the beginning" not in line for line in err.splitlines()) or limit == 1, f"each run is resumed: {err}")
    status, _, err = gudgeon.run(*SHORT, "--set", "integrator.max_evaluations=2000", "-o", parts, "--resume", *files)
    check(status == 4 and "limit of evaluations reached" in err, "a run stopped by the limit of evaluations")
    status, _, err = gudgeon.run(*SHORT, "-o", parts, "--resume", *files)
    check(status == 0, f"resumed runs reach the end: {status} {err}")
    for file in files:
        wrong = differing(whole, parts, file.stem)
        check(not wrong, f"{file.name}, stopped by limits: {wrong}")
    check(not leftovers(parts), f"files left behind: {leftovers(parts)}")

    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in parts.iterdir()}
    status, out, _ = gudgeon.run(*SHORT, "-o", parts, "--resume", *files)
    check(status == 0 and out.count("done already") == len(files), f"runs that are done are not repeated: {status} {out}")
    check(before == {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in parts.iterdir()},
          "files of runs that are done are unchanged")


def stopped_by_signals(gudgeon: Gudgeon, work: Path, file: Path, length: str, kills: int, chance: random.Random) -> None:
    """One long run, killed or interrupted at random times until it is done."""
    words = ("--set", f"integrator.revolutions={length}", "--set", "integrator.method=auto", "--set", "output.ideal_twin=F", file)
    whole, parts = work / "whole", work / "parts"
    began = time.monotonic()
    status, _, err = gudgeon.run("-o", whole, *words)
    duration = time.monotonic() - began
    check(status == 0, f"uninterrupted run of {file.name}: {status} {err}")
    done = 0
    for _ in range(10*kills + 10):
        process = gudgeon.start("--checkpoint", 0.02, "--resume", "-o", parts, *words)
        sign = chance.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM))
        try:
            process.wait(timeout=chance.uniform(0.01, 2*duration/kills) if done < kills else 600)
        except subprocess.TimeoutExpired:
            process.send_signal(sign)
            process.wait(timeout=600)
        done += process.returncode != 0
        process.communicate()
        if process.returncode == 0:
            break
        check(process.returncode in (4, -sign), f"{file.name}: stopped, exit {process.returncode}")   # -TERM: before signals are handled
    check(process.returncode == 0, f"{file.name}: done after {done} stops")
    check(done >= 3, f"{file.name}: stopped {done} times")
    wrong = differing(whole, parts, file.stem)
    check(not wrong, f"{file.name}, stopped {done} times by signals: {wrong}")
    check(not leftovers(parts), f"files left behind: {leftovers(parts)}")
    print(f"{file.name}: stopped {done} times", flush=True)


def stopped_by_full_disk(gudgeon: Gudgeon, work: Path) -> None:
    """A trace that finds the disk full: the run continues from its last checkpoint when there is room."""
    words = ("--set", "integrator.revolutions=30", CASES / "flores" / "friction_100.nml")
    check(gudgeon.run("-o", work / "whole", *words)[0] == 0, "an uninterrupted run")

    def no_room() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))
    status, _, err = gudgeon.run("--checkpoint", 0.001, "-o", work / "parts", *words, preexec_fn=no_room)
    check(status == 5 and "File too large" in err, f"full disk: {status} {err}")
    check("friction_100.checkpoint" in leftovers(work / "parts"), "the checkpoint stays")
    status, _, err = gudgeon.run("--resume", "-o", work / "parts", *words)
    check(status == 0 and not err, f"the run continues when there is room: {status} {err}")
    wrong = differing(work / "whole", work / "parts", "friction_100")
    check(not wrong, f"stopped by a full disk: {wrong}")


def refusals(gudgeon: Gudgeon, work: Path, chance: random.Random) -> None:
    """A checkpoint that does not belong to this case, program or trace is refused with one line, and no file is changed."""
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
        check(before == {path.name: path.read_bytes() for path in folder.iterdir()}, f"{what}: no file is changed")

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
    mark = program.find(b"\3\0\0\0GNU\0")   # header of the build id, a hash of the whole program by the linker
    check(0 < mark < 4096, "the program has a build id")
    other.write_bytes(program[:mark + 8] + bytes([program[mark + 8] ^ 1]) + program[mark + 9:])
    other.chmod(0o755)
    refused("another build", program=Gudgeon(other), want="another build")
    plain = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-AVX2_Usable"}
    words_of = ("-o", work / "processor", "--set", "integrator.revolutions=1", file)
    gudgeon.run(*words_of, env=plain)
    with_plain = (work / "processor" / trace).read_bytes()
    gudgeon.run(*words_of)
    if with_plain != (work / "processor" / trace).read_bytes():   # otherwise the library has no other functions for this processor
        refused("another processor", env=plain, want="another kind of processor")
    check(gudgeon.run("--resume", "-o", stopped, *words)[0] == 0, "the correct checkpoint is resumed")


def beginnings(gudgeon: Gudgeon, work: Path) -> None:
    """No checkpoint, --checkpoint 0, the ideal twin, and a run that is started again."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", file)
    status, _, err = gudgeon.run("--resume", "-o", work / "a", *words)
    check(status == 0 and err.count("\n") == 1 and "starts from the beginning" in err, f"no checkpoint: {status} {err}")
    limit = ("--set", "integrator.max_steps=20")
    gudgeon.run("--checkpoint", 0, *limit, "-o", work / "b", *words)
    check("sim_I.checkpoint" not in leftovers(work / "b"), "with --checkpoint 0 there is no checkpoint")
    gudgeon.run(*limit, "-o", work / "b", *words)
    check("sim_I.checkpoint" in leftovers(work / "b"), "otherwise there is a checkpoint")
    status, _, err = gudgeon.run("--resume", "-o", work / "b", *words)
    resolved = [(work / folder / "sim_I.resolved.nml").read_text() for folder in ("a", "b")]
    check(status == 0 and resolved[0] == resolved[1], f"the resolved case of a resumed run has its own limits: {status} {err}")
    status, out, _ = gudgeon.run("-o", work / "b", *words)
    check(status == 0 and not leftovers(work / "b"), "a finished run leaves no checkpoint")
    (work / "b" / "sim_I.ideal.csv").unlink()
    status, out, _ = gudgeon.run("--resume", "-o", work / "b", *words)
    check(status == 0 and "done already" in out, "a run that is done is not repeated")
    check((work / "a" / "sim_I.ideal.csv").read_bytes() == (work / "b" / "sim_I.ideal.csv").read_bytes(), "a missing ideal twin is run again")
    status, _, err = gudgeon.run("--resume", "-o", work / "b", "--set", "joint.clearance=3e-5", *words)
    check(status == 0 and "starts from the beginning" in err, "results of another case are not taken for this one")
    for value in ("-1", "ten", "", "1e9", "1.2.3"):
        status, _, err = gudgeon.run("--checkpoint", value, *words)
        check(status == 2 and "--checkpoint" in err, f"--checkpoint {value}: {status} {err}")


def rerun_with_other_values(gudgeon: Gudgeon, work: Path, kills: int, chance: random.Random) -> None:
    """Runs into a folder with results of other values, killed at random times: files of other values are never mixed with those of
    the new run, and --resume ends with the rows of the values that it is given."""
    name, folder = "sim_III", work / "again"
    always = ("--set", "integrator.method=auto", "--set", "integrator.revolutions=12", "--checkpoint", 0.02, CASES / f"{name}.nml")
    speeds = [1500, 1600, 1700, 1800]
    expected, duration = {}, 0.0
    for speed in speeds:
        began = time.monotonic()
        status, _, err = gudgeon.run("-o", work / str(speed), "--set", f"initial.crank_speed={speed}", *always)
        duration = max(duration, time.monotonic() - began)
        check(status == 0, f"uninterrupted run at {speed} rad/s: {status} {err}")
        expected[speed] = {end: b"".join(contents(work / str(speed) / (name + end))) for end in RESULTS}
    check(len({files[".csv"] for files in expected.values()}) == len(speeds), "each speed gives different rows")

    def foreign(speed: int) -> str:
        """Results in the folder that belong to another speed although the resolved case has this one."""
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
        wanted = speed if present is None or chance.random() < 0.7 else present   # with the new values, or again with the old ones
        status, out, err = gudgeon.run("--resume", *words, f"initial.crank_speed={wanted}")
        if status == 3 and wanted != found and "but the stopped run has" in err:   # the checkpoint of other values
            status, out, err = gudgeon.run(*words, f"initial.crank_speed={wanted}")
        done_before += "done already" in out
        wrong = [end for end in RESULTS if b"".join(contents(folder / (name + end))) != expected[wanted][end]]
        check(status == 0 and not wrong, f"kill {i}, then {wanted} rad/s: exit {status}, {err}{wrong} are not its results")
        check(not leftovers(folder), f"kill {i}: files left behind: {leftovers(folder)}")
        present = wanted
    print(f"{name} run again with other values: {killed} kills in {kills} runs, {early} before the new run wrote a file, "
          f"{done_before} resumed that were done already", flush=True)


def of_speed(resolved: Path, speeds: list[int]) -> int | None:
    """The speed in a resolved case."""
    for line in resolved.read_text().splitlines() if resolved.exists() else []:
        key, _, value = line.partition("=")
        if key.strip() == "crank_speed":
            return next(speed for speed in speeds if float(value.split("!")[0]) == speed)
    return None


def results_of_others(gudgeon: Gudgeon, work: Path) -> None:
    """A run counts as done only if all of its results exist and belong to this case and program."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", "--set", "output.ideal_twin=T", file)
    whole, folder = work / "whole", work / "folder"
    check(gudgeon.run("-o", whole, *words)[0] == 0, "an uninterrupted run")

    def taken_up(what: str, name: str, change, twin_only: bool = False) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(whole, folder)
        change(folder / name)
        status, out, err = gudgeon.run("--resume", "-o", folder, *words)
        check(status == 0 and ("done already" in out) == twin_only, f"{what}: run again: {status} {out}{err}")
        check(not differing(whole, folder, "sim_I"), f"{what}: {differing(whole, folder, 'sim_I')} are not those of an uninterrupted run")

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
    # files that only some runs have, and a certificate that is wanted later
    for case, more, end in ((file, ("--set", "output.film_times=0.001"), ".film.csv"), (CASES / "wear" / "flores.nml", (), ".wear.csv"),
                            (file, ("--certify",), ".certificate.csv")):
        said = (*words[:-1], *more, "-o", work / f"with{end}", case)
        result = work / f"with{end}" / (case.stem + end)
        check(gudgeon.run(*said)[0] == 0 and result.exists(), f"a run with {end}")
        check("done already" in gudgeon.run("--resume", *said)[1], f"a run with {end} is done")
        before = result.read_bytes()
        result.unlink()
        status, out, err = gudgeon.run("--resume", *said)
        check(status == 0 and "done already" not in out and result.exists() and result.read_bytes() == before,
              f"without its {end} it is run again: {status} {out}{err}")
    status, out, err = gudgeon.run("--resume", "--certify", "-o", whole, *words)
    check(status == 0 and "digits to" in out and (whole / "sim_I.certificate.csv").exists(),
          f"a run that is done and has no certificate gets one: {status} {out}{err}")
    shutil.rmtree(whole)
    gudgeon.run("-o", whole, *words)
    # a scene without contacts and without an ideal twin removes the files of a scene that had them
    plain = work / "sim_I.nml"
    shutil.copy(CASES / "flores" / "ideal.nml", plain)
    status, _, err = gudgeon.run("-o", folder, *words[:4], plain)
    check(status == 0, f"a plain scene of the same name: {status} {err}")
    left = sorted(path.name for path in folder.iterdir())
    check(left == ["sim_I.csv", "sim_I.resolved.nml", "sim_I.summary.csv"], f"remaining files: {left}")
    # a case that happens to have the name of an ideal twin is not removed
    named = work / "sim_I.ideal.nml"
    shutil.copy(CASES / "flores" / "ideal.nml", named)
    gudgeon.run("-o", folder, "--set", "integrator.revolutions=0.1", named)
    before = (folder / "sim_I.ideal.csv").read_bytes()
    gudgeon.run("-o", folder, *words[:4], "--set", "output.ideal_twin=F", file)
    check((folder / "sim_I.ideal.csv").read_bytes() == before, "results of a case with the name of an ideal twin are kept")


def twin_taken_up(gudgeon: Gudgeon, work: Path) -> None:
    """An ideal twin that was stopped is resumed like any other run."""
    file = CASES / "sim_I.nml"
    words = ("--set", "integrator.revolutions=4", "--set", "integrator.method=auto", file)
    check(gudgeon.run("-o", work / "whole", *words)[0] == 0, "an uninterrupted run")
    for limit in (20, 60, 100, 200):
        status, _, err = gudgeon.run("--resume", "--set", f"integrator.max_steps={limit}", "-o", work / "parts", *words)
        check(status == 4 and err.count("too many steps") == 1, f"stopped after {limit} steps: {status} {err}")
    summary = (work / "parts" / "sim_I.ideal.summary.csv").read_text()
    check('status,"done"' in summary or 'status,"too many steps' in summary, f"the ideal twin has a summary: {summary[:200]}")
    check(gudgeon.run("--resume", "-o", work / "parts", *words)[0] == 0, "an ideal twin is resumed to its end")
    check(not differing(work / "whole", work / "parts", "sim_I"), f"{differing(work / 'whole', work / 'parts', 'sim_I')} differ")
    check(not leftovers(work / "parts"), f"files left behind: {leftovers(work / 'parts')}")


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
