#!/usr/bin/env python3
"""Runs that were stopped and taken up again, by the program: files are those of a run that was not, byte for byte.

    tests/test_resume.py [--kills N] [--seed N] [--program PATH]

Stopped by a limit, by a signal, by kill -9 at random instants; checkpoints damaged, of another case, of another build; traces
that were changed. Needs a release build (or makes one). Ends with the line "N passed, N failed".
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

from test_faults import ROOT, Gudgeon, check, counts, program_built

CASES = ROOT / "cases"
SHORT = ("--set", "integrator.revolutions=0.5", "--set", "integrator.method=auto", "--set", "output.ideal_twin=F")
RESULTS = (".csv", ".events.csv", ".summary.csv", ".resolved.nml")
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
    files = sorted(CASES.glob("sim_*.nml")) + sorted((CASES / "flores").glob("*.nml"))
    whole, parts = work / "whole", work / "parts"
    status, _, err = gudgeon.run(*SHORT, "-o", whole, *files)
    check(status == 0, f"whole runs: {status} {err}")
    for limit in (1, 100, 101, 333, 700):
        status, _, err = gudgeon.run(*SHORT, "--set", f"integrator.max_steps={limit}", "-o", parts, "--resume", *files)
        check("too many steps" in err and status == 4, f"stopped by a limit: {status} {err}")
        check(limit > 1 or "--resume goes on" in err, "and says how to go on")
        check(all("from the beginning" not in line for line in err.splitlines()) or limit == 1, f"each goes on: {err}")
    status, _, err = gudgeon.run(*SHORT, "--set", "integrator.max_evaluations=2000", "-o", parts, "--resume", *files)
    check(status == 4 and "too much work" in err, "another limit")
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
    other.write_bytes(gudgeon.program.read_bytes() + b"\0")
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
        stopped_by_full_disk(gudgeon, work / "disk")
        refusals(gudgeon, work / "refused", chance)
        beginnings(gudgeon, work / "begin")
    finally:
        shutil.rmtree(work, ignore_errors=True)
    print(f"{counts['passed']} passed, {counts['failed']} failed")
    return counts["failed"] > 0


if __name__ == "__main__":
    sys.exit(main())
