#!/usr/bin/env python3
"""Failures of the machine during a run: kills, signals, full disks, folders that cannot be written, two runs in one folder, pipes
and links in the place of files, and the state of the disk after a power cut.

    tests/test_faults.py [--kills N] [--seed N] [--program PATH]

In every case all files contain complete rows (except the last row of a trace under its temporary name, which a kill -9 may cut), a
summary or resolved case is complete or absent, the finished cases of a batch are kept, and the exit status states the failure.
Needs a release build (or makes one). Tests that need root are skipped without it, with a message.
Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import contextlib
import errno
import os
import random
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from assertions import Assertions

ROOT = Path(__file__).resolve().parent.parent
FLORES = ROOT / "cases" / "flores"
LONG = ("--set", "integrator.revolutions=400")          # a run of many seconds
SHORT = ("--set", "integrator.revolutions=0.2", "--set", "output.ideal_twin=F", "--set", "integrator.method=auto")
PATIENCE = 600                                          # seconds; a program that takes longer hangs
assertions = Assertions()
check = assertions.check


def wait_for(condition, what: str) -> None:
    """Wait until a condition holds that a run is to bring about; a run that does not, fails the test at once."""
    ends = time.monotonic() + 60
    while not condition():
        if time.monotonic() > ends:
            check(False, f"waited in vain for {what}")
            sys.exit(assertions.report())
        time.sleep(0.001)


def holds(process: subprocess.Popen, number: int) -> bool:
    """Whether a process holds a signal, instead of being ended by it."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return bool(int(re.search(r"SigBlk:\s*(\w+)", status)[1], 16) >> (number - 1) & 1)


class Gudgeon:
    """The program, started as users and other programs start it."""

    def __init__(self, program: Path):
        self.program = program

    def start(self, *words: object, **how) -> subprocess.Popen:
        settings = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL, **how}
        return subprocess.Popen([str(self.program), *map(str, words)], **settings)

    def run(self, *words: object, **how) -> tuple[int, str, str]:
        process = self.start(*words, **how)
        out, err = process.communicate(timeout=PATIENCE)
        return process.returncode, (out or b"").decode(), (err or b"").decode()


def program_built() -> Path:
    run = subprocess.run([ROOT / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{run.stderr}\n0 passed, 1 failed")
    return ROOT / run.stdout.strip()


def torn(path: Path) -> str:
    """What is incomplete in a result file; empty if the file is complete."""
    text = path.read_bytes()
    name = path.name.removesuffix(".part")
    if name != path.name:
        text = text[:text.rfind(b"\n") + 1]
    if text and not text.endswith(b"\n"):
        return f"{path.name} ends in the middle of a row: {text[-60:]!r}"
    rows = text.decode().splitlines()
    if name.endswith(".summary.csv"):
        return "" if rows and rows[-1].startswith("compiler_options,") else f"{path.name} is not complete"
    if name.endswith(".resolved.nml"):
        return "" if rows and rows[-1] == "/" and rows[-2].strip().startswith("window") else f"{path.name} is not complete"
    if name.endswith(".state.nml"):
        return "" if rows and rows[-1] == "/" and "&so_far" in rows else f"{path.name} is not complete"
    columns = rows[0].count(",") if rows else 0
    for row in rows[1:]:
        if row.count(",") != columns:
            return f"{path.name}: {row.count(',') + 1} fields of {columns + 1}: {row[:80]}"
    return ""


def whole(folder: Path, what: str, parts: bool = False) -> None:
    """Check that every file in a folder is complete; files under temporary names are allowed only with `parts`."""
    files = [path for path in folder.iterdir() if path.is_file()] if folder.is_dir() else []
    faults = [torn(path) for path in files if not (path.name.endswith(".part") and any(
        word in path.name for word in (".resolved.", ".summary.", ".state.")))]
    check(not any(faults), f"{what}: incomplete files: {[fault for fault in faults if fault][:2]}")
    if not parts:
        left = [path.name for path in files if path.name.endswith(".part")]
        check(not left, f"{what}: no files under temporary names, not {left}")


def test_kills(gudgeon: Gudgeon, work: Path, kills: int, rng: random.Random) -> None:
    """kill -9 at random times, sometimes with the results of an earlier run in the folder; the next run is not obstructed."""
    cases = [FLORES / "dry_0500um.nml", FLORES / "friction_050.nml", ROOT / "cases" / "sim_IV.nml"]
    left = 0
    for i in range(kills):
        folder = work / "killed"
        if i % 5 == 0:
            shutil.rmtree(folder, ignore_errors=True)
        process = gudgeon.start("-o", folder, "-j", "2", "--set", f"integrator.revolutions={rng.choice((1, 4, 40))}", "--set",
                                "output.samples_per_revolution=5000", "--set", "integrator.method=auto", *cases)
        time.sleep(rng.choice((rng.uniform(0, 0.02), rng.uniform(0, 0.5))))
        process.kill()
        process.communicate(timeout=PATIENCE)
        if folder.is_dir():
            left += any(folder.glob("*.part"))
            whole(folder, f"kill {i}", parts=True)
    check(left > 0, "some runs are killed before their end")
    for ending in (".ideal.csv", ".summary.csv", ".resolved.nml"):   # including files that the next run does not write
        (work / "killed" / f"sim_IV{ending}.part").write_text("left behind\n")
    status, _, err = gudgeon.run("-o", work / "killed", *SHORT, *cases)
    check(status == 0 and all(" discards the results of an earlier run that was stopped" in row or ": note: " in row for row in err.splitlines()),
          f"a run after the kills is finished: {status} {err}")
    whole(work / "killed", "after the kills")


def test_signals(gudgeon: Gudgeon, work: Path) -> None:
    """Ctrl-C and similar signals end all cases of a batch, including those that have not begun."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
        folder = work / number.name
        process = gudgeon.start("-o", folder, "-j", "1", *LONG, ROOT / "cases" / "sim_I.nml", FLORES / "dry_0100um.nml")
        wait_for((folder / "sim_I.csv.part").exists, "sim_I.csv.part")
        time.sleep(0.2)
        process.send_signal(number)
        _, err = process.communicate(timeout=PATIENCE)
        lines = err.decode().splitlines()
        check(process.returncode == 4, f"{number.name}: exit status 4, not {process.returncode}")
        check(len(lines) == 2 and "interrupted at t =" in lines[0] and "dry_0100um.nml: interrupted before" in lines[1],
              f"{number.name}: one line for each case: {lines}")
        summary = (folder / "sim_I.summary.csv").read_text()
        check("status,interrupted at t" in summary.replace('"', ""), f"{number.name}: the summary states the interruption")
        check((folder / "sim_I.state.nml").is_file(), f"{number.name}: the state is written")
        whole(folder, number.name)
    folder = work / "twin"   # is not begun after its case was interrupted, and an earlier one does not stay beside the new case
    folder.mkdir()
    (folder / "sim_I.ideal.csv").write_text("time[s]\n0\n")
    process = gudgeon.start("-o", folder, *LONG, "--set", "output.ideal_twin=T", ROOT / "cases" / "sim_I.nml")
    wait_for((folder / "sim_I.csv.part").exists, "sim_I.csv.part")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=PATIENCE)
    check(process.returncode == 4 and err.decode().count("\n") == 1 and b"interrupted at t =" in err, f"ideal twin: one line, not {err}")
    check(not (folder / "sim_I.ideal.csv").exists(), "ideal twin: the earlier one is removed")
    whole(folder, "twin")
    folder = work / "later"   # the case is done, its ideal twin is not
    process = gudgeon.start("-o", folder, "-j", "1", *SHORT[4:], "--set", "integrator.revolutions=60", "--set", "output.ideal_twin=T",
                            "--set", "output.interval=1e-6", ROOT / "cases" / "sim_II.nml")
    wait_for((folder / "sim_II.ideal.csv.part").exists, "sim_II.ideal.csv.part")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=PATIENCE)
    check(process.returncode == 4 and b"sim_II.nml: ideal twin: interrupted" in err,
          f"an ideal twin that is interrupted is named in the message: {process.returncode} {err}")
    check("status,done," in (folder / "sim_II.summary.csv").read_text(), "the case of an interrupted ideal twin is done")
    folder = work / "nohup"
    process = gudgeon.start("-o", folder, *SHORT, FLORES / "dry_0100um.nml",
                            preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=PATIENCE)
    check(process.returncode == 0, "a signal that was ignored at the start of the program stays ignored")


@contextlib.contextmanager
def disk(folder: Path, options: str):
    """A file system in memory; yields False if this user is not allowed to mount one."""
    folder.mkdir()
    done = os.geteuid() == 0 and shutil.which("mount") and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True, check=False).returncode == 0
    try:
        yield done
    finally:
        if done:
            subprocess.run(["umount", str(folder)], check=True)


def full(gudgeon: Gudgeon, folder: Path, what: str, *words: object, **how) -> None:
    status, out, err = gudgeon.run("-o", folder, "--set", "integrator.method=auto", *words, FLORES / "dry_0500um.nml", **how)
    check(status == 5 and (not out or ": ended early; " in out), f"{what}: exit status 5, not {status}; {out}")
    check(err.count("\n") == 1 and ("No space left" in err or "too large" in err), f"{what}: one line: {err}")
    whole(folder, what)


def test_full_disk(gudgeon: Gudgeon, work: Path) -> None:
    """A disk without room for the trace, the summary, the resolved case, or any file."""
    for size in (4, 8, 16, 64, 300):
        with disk(work / f"disk{size}", f"size={size}k") as mounted:
            if not mounted:
                print("skipped: a full disk (needs root and tmpfs); a limit of the file size is tested instead")
                break
            full(gudgeon, work / f"disk{size}", f"a disk of {size} kB")
    for size in (0, 100, 3000, 100_000, 300_000):
        full(gudgeon, work / f"limit{size}", f"a limit of {size} bytes for files",
             preexec_fn=lambda size=size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
    for size in (300_000, 4_200_000):   # the second is enough for the ideal twin; the case then fails while it writes its rows
        full(gudgeon, work / f"twin{size}", f"a limit of {size} bytes for files, with an ideal twin", "-j", "2", "--set", "output.ideal_twin=T",
             "--set", "output.samples_per_revolution=5000",
             preexec_fn=lambda size=size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))


def test_full_disk_has_summary(gudgeon: Gudgeon, work: Path) -> None:
    """If the disk becomes full, the run states this in its summary, for which room is reserved: an incomplete trace always has a
    summary."""
    case = FLORES / "friction_100.nml"
    words = ("--set", "integrator.revolutions=30", "--set", "output.ideal_twin=F", case)
    for size in (40, 60, 100, 500, 2000):
        with disk(work / f"disk{size}", f"size={size}k") as mounted:
            if not mounted:
                print("skipped: the summary on a full disk (needs root and tmpfs)")
                return
            folder = work / f"disk{size}"
            status, _, err = gudgeon.run("-o", folder, *words)
            check(status == 5 and "No space left" in err, f"a disk of {size} kB: {status} {err}")
            summary = folder / "friction_100.summary.csv"
            check(summary.exists() or not (folder / "friction_100.csv").exists(), f"a disk of {size} kB: a trace without a summary")
            if size >= 60:
                check(summary.exists() and "status,stopped: " in summary.read_text().replace('"', ""), f"a disk of {size} kB: the summary states the failure")
            whole(folder, f"a disk of {size} kB")


def test_planted(gudgeon: Gudgeon, work: Path) -> None:
    """Links, pipes and devices in the place of files: the program does not write through them and does not wait for them."""
    case = FLORES / "ideal.nml"
    folder = work / "links"
    folder.mkdir()
    victim = work / "victim"
    victim.write_text("precious\n")
    for name in ("csv", "summary.csv", "resolved.nml", "events.csv", "state.nml"):
        for ending in ("", ".part"):
            (folder / f"ideal.{name}{ending}").symlink_to(victim)
    (folder / "ideal.ideal.csv.part").hardlink_to(victim)
    status, _, err = gudgeon.run("-q", "-o", folder, case)
    check(status == 0 and not err, f"a run in a folder with links: {status} {err}")
    check(victim.read_text() == "precious\n", "the targets of the links are unchanged")
    check(not any(path.is_symlink() for path in folder.iterdir()), f"the links are replaced: {[p.name for p in folder.iterdir()]}")

    pipe = work / "pipe.nml"
    os.mkfifo(pipe)
    for bad in (pipe, "/dev/zero", "/dev/null"):
        for words in ((bad,), ("--check", bad)):
            status, _, err = gudgeon.run("-o", folder, *words)
            check(status == 3 and err == f"gudgeon: {bad}: not a regular file\n", f"{bad} as a case: {status} {err}")
    for name in ("csv", "summary.csv", "resolved.nml"):   # pipes with the names of results are replaced
        os.mkfifo(work / f"ideal.{name}")
    status, _, err = gudgeon.run("-o", work, *SHORT, case)
    check(status == 0 and not err, f"pipes in the place of results: {status} {err}")


def test_names(gudgeon: Gudgeon, work: Path) -> None:
    """A case whose results would have the names of another one's is refused, the results that stand there stay; what a terminal obeys
    in the name of a file does not reach standard output."""
    results = work / "results"
    shutil.copy(FLORES / "dry_0100um.nml", work / "c.nml")
    status, _, err = gudgeon.run("-o", results, *SHORT[:2], "--certify", work / "c.nml")
    check(status == 0, f"c: {status} {err}")
    before = {path.name: path.read_bytes() for path in results.iterdir()}
    for name in before:   # a case with the name of each result that it could replace
        if not name.endswith(".csv") or name == "c.csv":
            continue
        other = work / f"{name.removesuffix('.csv')}.nml"
        shutil.copy(FLORES / "ideal.nml", other)
        status, _, err = gudgeon.run("-o", results, *SHORT, other)
        check(status == 2 and err.count("\n") == 1 and "give another name with --name" in err, f"{other.name}: {status} {err}")
        status, _, err = gudgeon.run("-o", results, *SHORT, "--name", other.stem, FLORES / "ideal.nml")
        check(status == 2 and err.count("\n") == 1, f"--name {other.stem}: {status} {err}")
    check({path.name: path.read_bytes() for path in results.iterdir()} == before, "the results of c stay")
    own = results / "c.resolved.nml"
    status, _, err = gudgeon.run("-o", results, *SHORT, "--name", "c", own)
    check(status == 2 and "would be replaced" in err and own.read_bytes() == before[own.name], f"a case file is not replaced: {status} {err}")
    name = "a\x1b[31mb\nc"
    shutil.copy(FLORES / "ideal.nml", work / f"{name}.nml")
    (work / f"s{name}.nml").write_text("&study case = 'c.nml' /\n&parameter key = 'joint.clearance', values = '1e-5, 2e-5' /\n")
    for words in ((*SHORT, f"{name}.nml"), ("--check", f"{name}.nml"), ("sweep", *SHORT[:2], f"s{name}.nml")):
        _, out, err = gudgeon.run("-o", name, *words, cwd=work)
        lines = (out + err).splitlines()
        check("\x1b" not in out + err and lines and all(r"a\x1B" in line for line in lines if ".csv" in line), f"{words}: {lines}")


def test_standard_input(gudgeon: Gudgeon, work: Path) -> None:
    """A case can be read from /dev/stdin; a signal ends the program while it waits for the case."""
    case = FLORES / "ideal.nml"
    with case.open("rb") as file:
        status, _, err = gudgeon.run("-o", work / "file", *SHORT, "/dev/stdin", stdin=file)
    check(status == 0, f"a case on standard input, from a file: {status} {err}")
    process = gudgeon.start("-o", work / "pipe", *SHORT, "/dev/stdin", stdin=subprocess.PIPE)
    time.sleep(0.1)
    _, err = process.communicate(case.read_bytes(), timeout=PATIENCE)
    check(process.returncode == 0, f"a case on standard input, from a pipe after a delay: {process.returncode} {err}")
    same = [(work / name / "stdin.csv").read_bytes() for name in ("file", "pipe")]
    check(same[0] == same[1], "a case on standard input gives the same results")
    for number in (signal.SIGINT, signal.SIGTERM):
        process = gudgeon.start("-o", work / "none", "/dev/stdin", stdin=subprocess.PIPE)
        wait_for(lambda: holds(process, number), f"a program that holds {number.name}")
        process.send_signal(number)
        status = process.wait(timeout=PATIENCE)
        err = process.stderr.read().decode()
        process.stdin.close()
        check(status == 4 and "interrupted before it began" in err, f"{number.name} while the program waits for a case: {status} {err}")
    for delay in (0, 0.001, 0.002, 0.004, 0.008):   # early signals: either the system ends the program, or the program ends itself
        process = gudgeon.start("-o", work / "early", *LONG, FLORES / "dry_0500um.nml")
        time.sleep(delay)
        process.send_signal(signal.SIGTERM)
        check(process.wait(timeout=PATIENCE) in (4, -signal.SIGTERM), f"SIGTERM after {delay} s: {process.returncode}")
        process.communicate()


LIBRARY = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
static void tell(const char *what, const char *path, const char *other) {
  char line[9000];
  static int log = -1;
  if (log < 0) log = open(getenv("CALLS"), O_WRONLY | O_APPEND | O_CREAT, 0666);
  int n = snprintf(line, sizeof line, "%s\t%s\t%s\n", what, path, other);
  ssize_t (*out)(int, const void *, size_t) = dlsym(RTLD_NEXT, "write");
  if (out(log, line, n) != n) abort();
}
static const char *name_of(int file, char *name) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  ssize_t n = readlink(link, name, 4000);
  name[n < 0 ? 0 : n] = 0;
  return name;
}
int rename(const char *from, const char *to) {
  int (*real)(const char *, const char *) = dlsym(RTLD_NEXT, "rename");
  int status = real(from, to);
  if (!status) tell("rename", from, to);
  return status;
}
int unlink(const char *path) {
  int (*real)(const char *) = dlsym(RTLD_NEXT, "unlink");
  int status = real(path);
  if (!status) tell("remove", path, "");
  return status;
}
int fsync(int file) {
  char name[4096];
  int (*real)(int) = dlsym(RTLD_NEXT, "fsync");
  tell("disk", name_of(file, name), "");
  return real(file);
}
ssize_t write(int file, const void *bytes, size_t n) {
  char name[4096];
  ssize_t (*real)(int, const void *, size_t) = dlsym(RTLD_NEXT, "write");
  tell("write", name_of(file, name), "");
  return real(file, bytes, n);
}
"""


REFUSALS = r"""
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#define REFUSE(call) if (getenv(call)) { errno = atoi(getenv(call)); return -1; }
int fsync(int file) { (void)file; REFUSE("FSYNC") return 0; }
int flock(int file, int way) { (void)file; (void)way; REFUSE("OTHERS") return 0; }
"""


def test_calls_not_offered(gudgeon: Gudgeon, work: Path) -> None:
    """A file system without fsync and locks: the run is done. A disk that fails is told."""
    source, library = work / "refusals.c", work / "refusals.so"
    source.write_text(REFUSALS)
    built = subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source], capture_output=True, text=True, check=False)
    if built.returncode:
        print(f"skipped: calls that are not offered (gcc: {built.stderr[:100]})")
        return
    for number in (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP, errno.EIO):
        folder = work / str(number)
        others = "" if number == errno.EIO else f"{number}"
        how = {"cwd": work, "env": {**os.environ, "LD_PRELOAD": f"./{library.name}", "FSYNC": str(number), **({"OTHERS": others} if others else {})}}
        status, _, err = gudgeon.run("-o", folder, *SHORT, FLORES / "dry_0100um.nml", **how)
        summary = folder / "dry_0100um.summary.csv"
        if number == errno.EIO:
            check(status == 5 and os.strerror(number) in err, f"fsync that fails is told: {status} {err}")
        else:
            check(status == 0 and not err and summary.is_file(), f"fsync and other calls give {os.strerror(number)}: {status} {err}")
            whole(folder, f"calls give {os.strerror(number)}")


def test_power_cut(gudgeon: Gudgeon, work: Path) -> None:
    """The order of writes to the disk, recorded by a library that intercepts the calls. The content of a file is on the disk before
    the file gets its name, all names are on the disk before the program ends, and an earlier summary that says "done" is removed
    from the disk before the first result of the new run gets its name."""
    source, library, calls = work / "calls.c", work / "calls.so", work / "calls"
    source.write_text(LIBRARY)
    built = subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source], capture_output=True, text=True, check=False)
    if built.returncode:
        print(f"skipped: the order of writes to the disk (gcc: {built.stderr[:100]})")
        return
    folder = (work / "results").resolve()
    for i, words in enumerate((("-j", "1"), ("-j", "2", "--set", "initial.crank_speed=1010"), ("--set", "integrator.max_steps=12"))):
        calls.unlink(missing_ok=True)
        status, _, err = gudgeon.run("-o", folder, *SHORT[:2], *SHORT[4:], *words, ROOT / "cases" / "sim_III.nml",
                                     cwd=work, env={**os.environ, "LD_PRELOAD": f"./{library.name}", "CALLS": str(calls)})
        check(status == (4 if i == 2 else 0), f"a run whose calls are recorded: {status} {err}")
        unsafe: set[str] = set()    # files with content that may not be on the disk
        loose: list[str] = []       # changes of the folder that may not be on the disk
        done = 0
        for line in calls.read_text().splitlines():
            what, path, other = line.split("\t")
            if what == "write":
                unsafe.add(path)
            elif what == "disk":
                unsafe.discard(path)
                if Path(path) == folder:
                    loose = []
            elif what == "remove":
                loose.append(f"remove {path}")
            else:
                source_path = str(Path(path).resolve().parent / Path(path).name)
                check(source_path not in unsafe, f"run {i}: {Path(other).name} gets its name before its content is on the disk")
                check(not any("summary.csv" in each and "remove" in each and not each.endswith(".part") for each in loose),
                      f"run {i}: {Path(other).name} gets its name while an earlier summary may still be on the disk")
                loose.append(f"rename {other}")
                done += 1
        check(done >= 5, f"run {i}: only {done} files get their names")
        left = [each for each in loose if not each.endswith(".part")]
        check(not left, f"run {i}: not certainly on the disk: {left}")


def test_folders(gudgeon: Gudgeon, work: Path) -> None:
    """A folder that cannot take results: one line and exit status 5; existing files stay."""
    case = FLORES / "dry_0500um.nml"
    with disk(work / "read_only", "ro") as mounted:
        if not mounted and os.geteuid() != 0:
            (work / "read_only").chmod(0o555)
            mounted = True
        if mounted:
            for folder in (work / "read_only", work / "read_only" / "sub"):
                status, _, err = gudgeon.run("-o", folder, *SHORT, case)
                check(status == 5 and err.count("\n") == 1, f"a read-only folder: {status} {err}")
        else:
            print("skipped: a read-only folder (needs tmpfs)")
    (work / "file").write_text("kept")
    for folder in (work / "file", work / "file" / "sub"):
        status, _, err = gudgeon.run("-o", folder, *SHORT, case)
        check(status == 5 and err.count("\n") == 1 and "ot a directory" in err, f"a file in the place of the folder: {status} {err}")
    check((work / "file").read_text() == "kept", "a file in the place of the folder stays")
    for ending in ("csv", "events.csv", "summary.csv", "resolved.nml"):
        folder = work / ending
        (folder / f"dry_0500um.{ending}").mkdir(parents=True)
        status, _, err = gudgeon.run("-o", folder, *SHORT, case)
        check(status == 5 and err.count("\n") == 1 and f"dry_0500um.{ending}: Is a directory" in err,
              f"a folder in the place of {ending}: {status} {err}")
        whole(folder, f"a folder in place of {ending}", parts=ending.endswith("csv"))
    check((work / "summary.csv" / "dry_0500um.csv").is_file(), "a trace whose summary cannot be written is kept")


def test_standard_output(gudgeon: Gudgeon, work: Path) -> None:
    """A reader of standard output that ends is not a failure, a full device is; closed descriptors do not change the results."""
    case = FLORES / "dry_0500um.nml"
    for words in (("-o", work / "pipe", *SHORT, case), ("--template",)):
        process = gudgeon.start(*words)
        process.stdout.close()
        err = process.stderr.read().decode()
        check(process.wait(timeout=PATIENCE) == 0 and not err, f"closed standard output, {words[0]}: {process.returncode} {err}")
        with open("/dev/full", "wb") as device:
            status, _, err = gudgeon.run(*words, stdout=device)
        check(status == 5 and err.count("\n") == 1, f"standard output on a full device, {words[0]}: {status} {err}")
    whole(work / "pipe", "closed standard output")
    reference = (work / "pipe" / "dry_0500um.csv").read_bytes()
    for i, descriptors in enumerate(("1", "2", "1 2", "0 1 2")):
        shell = " ".join(f"{one}{'<' if one == '0' else '>'}&-" for one in descriptors.split())
        words = shlex.join([str(gudgeon.program), "-o", str(work / f"none{i}"), *SHORT, str(case), str(FLORES / "friction_050.nml")])
        status = subprocess.run(f"{words} {shell}", shell=True, capture_output=True, check=False, timeout=PATIENCE).returncode
        check(status == 0, f"without descriptors {descriptors}: {status}")
        whole(work / f"none{i}", f"without descriptors {descriptors}")
        check((work / f"none{i}" / "dry_0500um.csv").read_bytes() == reference, f"without descriptors {descriptors}: the trace is the same")


def test_two_runs(gudgeon: Gudgeon, work: Path) -> None:
    """Two runs of one name in one folder are not mixed: the second is refused while the first runs."""
    folder = work / "two"
    case = FLORES / "dry_0500um.nml"
    first = gudgeon.start("-o", folder, *LONG, case)
    wait_for((folder / "dry_0500um.csv.part").exists, "dry_0500um.csv.part")
    status, _, err = gudgeon.run("-o", folder, *SHORT, case)
    check(status == 5 and err.count("\n") == 1 and "another run is writing it" in err, f"the second run is refused: {status} {err}")
    status, _, err = gudgeon.run("-o", folder, *SHORT, FLORES / "ideal.nml")
    check(status == 0, f"another case may run there: {status} {err}")
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=PATIENCE)
    check(first.returncode == 4, "the first run continues until it is interrupted")
    whole(folder, "two runs")
    resolved = (folder / "dry_0500um.resolved.nml").read_text()
    check("\n  revolutions = 400" in resolved, "the resolved case is that of the first run")
    status, _, err = gudgeon.run("-o", folder, *SHORT, case)
    check(status == 0, f"after the first run another is accepted: {status} {err}")
    reference = (folder / "dry_0500um.csv").read_bytes()
    for i in range(5):   # all at the same time
        together = [gudgeon.start("-o", folder, *SHORT, case) for _ in range(8)]
        errors = [process.communicate(timeout=PATIENCE)[1].decode() for process in together]
        ended = [process.returncode for process in together]
        check(0 in ended and set(ended) <= {0, 5}, f"eight at once: {ended}")
        check(all((not error) if status == 0 else "another run" in error for status, error in zip(ended, errors)), f"{errors}")
        check((folder / "dry_0500um.csv").read_bytes() == reference, f"eight at once, {i}: the trace is that of one run")
        whole(folder, "eight at once")


def test_batch(gudgeon: Gudgeon, work: Path) -> None:
    """One case of a batch fails in each possible way: the others are finished, and the highest exit status is returned."""
    folder = work / "batch"
    stops = work / "stops.nml"
    stops.write_text((ROOT / "cases" / "sim_I.nml").read_text().replace("&integrator", "&integrator\n  max_steps = 5"))
    wrong = work / "wrong.nml"
    wrong.write_text((ROOT / "cases" / "sim_I.nml").read_text().replace("kind = 'clearance'", "kind = 'loose'"))
    blocked = work / "blocked.nml"
    shutil.copy(FLORES / "ideal.nml", blocked)
    (folder / "blocked.csv").mkdir(parents=True)
    good = [FLORES / "dry_0500um.nml", FLORES / "friction_050.nml", FLORES / "ideal.nml"]
    for bad, want in ((wrong, 3), (stops, 4), (blocked, 5), (work / "none.nml", 3)):
        status, out, err = gudgeon.run("-o", folder, *SHORT, good[0], bad, *good[1:])
        check(status == want and err.count("\n") == 1 and str(bad) in err.replace(str(folder / "blocked"), str(bad)),
              f"{bad.name}: {status} {err}")
        check(out.count(": done; ") == 3, f"{bad.name}: the others are finished: {out}")
        for case in good:
            check("status,done," in (folder / f"{case.stem}.summary.csv").read_text(), f"{bad.name}: {case.stem} is done")
            (folder / f"{case.stem}.summary.csv").unlink()
    shutil.rmtree(folder)
    (folder / "blocked.csv").mkdir(parents=True)
    status, out, err = gudgeon.run("-o", folder, *SHORT, wrong, good[0], stops, blocked)
    check(status == 5 and out.count(": done; ") == 1 and err.count("\n") == 3, f"three of four cases fail: {status} {out} {err}")
    whole(folder, "a batch", parts=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path)
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)   # a background job and its children would ignore signals, as with nohup
    for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
        signal.signal(number, signal.SIG_DFL)
    gudgeon = Gudgeon(options.program or program_built())
    with tempfile.TemporaryDirectory(prefix="faults") as work:
        for test in (test_signals, test_full_disk, test_full_disk_has_summary, test_planted, test_names, test_standard_input, test_calls_not_offered,
                     test_power_cut,
                     test_folders, test_standard_output, test_two_runs, test_batch):
            folder = Path(work) / test.__name__
            folder.mkdir()
            test(gudgeon, folder)
        test_kills(gudgeon, Path(work), options.kills, random.Random(options.seed))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
