#!/usr/bin/env python3
"""Case files with random errors, read by a program that is built with every check of the compiler.

    tests/test_fuzz.py [--files N] [--seed N] [--runs SHARE] [--sanitize] [--jobs N] [--keep DIR]

Each file is a shipped case with one to four mutations. Most files are only checked (`--check`), a share of them is run for a short
time. Allowed are exit status 0 with an outcome on standard output, or 3 (in a run also 4 or 5) with clear lines on standard error, each
of which names the file; anything else is a failure, and the file is kept. With --sanitize the program is also built with the address and undefined
behaviour sanitizers. Ends with the line "N passed, N failed", which counts kinds of mutation: a kind has passed if every file
with such a mutation has.
"""
from __future__ import annotations

import argparse
import collections
import concurrent.futures
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unicodedata
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BATCH = 25               # files for each process
LONGEST_MESSAGE = 700    # bytes
SECONDS_A_FILE = 120     # longest time of a run; far more than any needs
SHORT_RUN = ("integrator.revolutions=0.0", "integrator.end_time=2e-4", "output.interval=1e-6", "output.start_time=0.0",
             "integrator.max_evaluations=5000")
NUMBERS = (b"0", b"-0.0", b"1e30", b"-1e30", b"1e-30", b"1e31", b"1d308", b"1e999999999", b"1e-999999999", b"9" * 400, b"nan", b"-Inf",
           b"infinity", b"1e", b"1e+", b".", b"-", b"+", b"0x10", b"1.0.0", b"1,2", b"2*1.0", b"0*1", b"9999*1", b"99999*1", b"1 2 3",
           b"2147483647", b"2147483648", b"-2147483648", b"1_8", b"'1'", b"", b"1e10", b"1e-10", b"1e-15", b"0.5", b"1", b"2", b"90", b"T",
           b".false.", b"1/3", b"(1,2)", b"1e5", b"1e-5", b"1000", b"1e-3", b"1e15", b"-1")
UNITS = (*(b"m km cm mm um nm in m2 mm^2 cm4 kg g mg t lb kg.m2 kg*cm^2 kg/m3 g/cm3 kg/l s ms us min h m/s mm/s rad/s rpm 1/min deg/s deg rad N kN "
           b"MN mN lbf Pa hPa kPa MPa GPa mbar bar psi N.m Nm mN.m J mJ kJ Pa.s mPa.s cP P m2/s mm2/s cSt St 1/Pa 1/MPa K degC degF C F Hz m2/N "
           b"mm3/N/m N.s/m MM furlong u 1/ 1/1 / /m // m/ e e5 d1 x=1 mm=2".split()), "15 µm".encode()[3:], "°C".encode(), "μm".encode())
BYTES = b"\0\t\n\r !\"'&/=,()*.+-0123456789eEdDaZ_%\x7f\x80\xc3\xe9\xff\xfe"


def is_clear(line: str) -> bool:
    """Whether every character is visible: no control or format characters, no white space except the blank."""
    return all(one == " " or unicodedata.category(one) not in ("Cc", "Cf", "Cs", "Zl", "Zp", "Zs") for one in line)


def items(text: bytes, pattern: bytes) -> list[re.Match]:
    return list(re.finditer(pattern, text, re.M))


def flip(text: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(text) or 1)
    return text[:at] + bytes([(text[at] if text else 0) ^ (1 << rng.randrange(8))]) + text[at + 1:]


def insert(text: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(text))
    return text[:at] + bytes(rng.choice(BYTES) for _ in range(rng.choice((1, 1, 1, 2, 5)))) + text[at:]


def delete(text: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(text))
    return text[:at] + text[at + rng.choice((1, 1, 2, 10)):]


def cut(text: bytes, rng: random.Random) -> bytes:
    return text[:rng.randint(0, len(text))]


def value(text: bytes, rng: random.Random) -> bytes:
    """Replace the value of a key: an unusual value, or that of another key."""
    found = items(text, rb"=[ \t]*([^!\n]*)")
    if not found:
        return text
    one = rng.choice(found)
    new = rng.choice(NUMBERS) if rng.random() < 0.7 else rng.choice(found)[1]
    return text[:one.start(1)] + new + text[one.end(1):]


def scale(text: bytes, rng: random.Random) -> bytes:
    """Multiply a number by a power of ten."""
    found = items(text, rb"(?<=[= ,])\d+\.?\d*(?:[ed][-+]?\d+)?")
    if not found:
        return text
    one = rng.choice(found)
    new = b"%.17g" % (float(one[0].replace(b"d", b"e")) * 10.0 ** rng.uniform(-12, 12))
    return text[:one.start()] + new + text[one.end():]


def unit(text: bytes, rng: random.Random) -> bytes:
    """Put a unit behind a number, or something like one."""
    found = items(text, rb"(?<=[= ,])\d+\.?\d*(?:[ed][-+]?\d+)?")
    if not found:
        return text
    one = rng.choice(found)
    written = rng.choice(UNITS) if rng.random() < 0.7 else rng.choice(UNITS) + bytes(rng.choice(BYTES) for _ in range(rng.choice((1, 2))))
    return text[:one.end()] + rng.choice((b"", b" ", b" ", b"  ", b"\t")) + written + text[one.end():]


def rename(text: bytes, rng: random.Random) -> bytes:
    """Misspell a key or group, or give it the name of another."""
    found = items(text, rb"\b[a-z_]+(?= *=)|(?<=&)[a-z]+")
    if not found:
        return text
    one = rng.choice(found)
    new = rng.choice((rng.choice(found)[0], delete(one[0], rng), insert(one[0], rng), one[0].upper(), one[0] * 100, one[0] + b"(1)",
                      one[0] + b"(2)", one[0] + b"(0)", one[0] + b"(99999)", one[0] + b"%x", one[0] + b"(1:2)"))
    return text[:one.start()] + new + text[one.end():]


def lines(text: bytes, rng: random.Random) -> bytes:
    """Remove, repeat or move lines."""
    parts = text.splitlines(keepends=True)
    if not parts:
        return text
    at = rng.randrange(len(parts))
    line = parts.pop(at) if rng.random() < 0.7 else parts[at]
    if rng.random() < 0.6:
        parts.insert(rng.randint(0, len(parts)), line)
    return b"".join(parts)


def groups(text: bytes, rng: random.Random) -> bytes:
    """Remove or repeat groups, or change their order."""
    parts = re.split(rb"(?m)^(?=&)", text)
    at = rng.randrange(len(parts))
    group = parts[at]
    if rng.random() < 0.4:
        parts.append(group)
    elif rng.random() < 0.5:
        parts.pop(at)
    else:
        rng.shuffle(parts)
    return b"".join(parts)


def encoding(text: bytes, rng: random.Random) -> bytes:
    plain = text.decode("latin-1")
    return rng.choice((
        lambda: text.replace(b"\n", b"\r\n"), lambda: text.replace(b"\n", b"\r"), lambda: b"\xef\xbb\xbf" + text,
        lambda: plain.encode("utf-16"), lambda: plain.encode("utf-16-be"), lambda: plain.encode("utf-32"),
        lambda: text.replace(b"e", b"\xe9", rng.randint(1, 3)), lambda: text.replace(b"'", "\N{RIGHT SINGLE QUOTATION MARK}".encode()),
        lambda: text.replace(b" ", "\N{NO-BREAK SPACE}".encode(), rng.randint(1, 5)), lambda: text.rstrip(b"\n"),
        lambda: text.replace(b"\n", b"\0", rng.randint(1, 3)), lambda: text.replace(b"-", "\N{MINUS SIGN}".encode()),
        lambda: text.replace(b"\n", b"\n\n"), lambda: text.replace(b"\n", b" "), lambda: text.replace(b"  ", b"\t"),
        lambda: text.upper()))()


def size(text: bytes, rng: random.Random) -> bytes:
    """Make the file empty or huge, with lines of a million characters, or with thousands of groups, keys or values."""
    long = rng.choice((10**6 - len(text) - 20, 10**6, 300000))
    at = rng.randint(0, len(text))
    return rng.choice((
        lambda: b"", lambda: b"\n" * long, lambda: text + b"! " + b"x" * long, lambda: text[:at] + b"x" * long + text[at:],
        lambda: text[:at] + b" " * long + text[at:], lambda: text[:at] + b"9" * long + text[at:],
        lambda: text[:at] + b"'" * long + text[at:], lambda: text.replace(b"= ", b"= '" + b"t" * long + b"'", 1),
        lambda: text[:at] + b"1, " * (long // 3) + text[at:], lambda: text + b"&a /\n" * (long // 5),
        lambda: text.replace(b"\n", b"\n x=1\n" * 5000, 1), lambda: text[:at] + b"," * long, lambda: text[:at] + b"(" * long,
        lambda: text[:at] + b"&" * long, lambda: text * 20))()


MUTATIONS = (flip, insert, delete, cut, value, scale, unit, rename, lines, groups, encoding, size)
WEIGHTS = (4, 4, 3, 1, 6, 8, 8, 4, 3, 3, 2, 1)


def mutant(case: bytes, rng: random.Random) -> tuple[bytes, str]:
    """A case with one to four mutations, and their names."""
    chosen = rng.choices(MUTATIONS, WEIGHTS, k=rng.choice((1, 1, 2, 4)))
    for mutate in chosen:
        case = mutate(case, rng)
    return case, "+".join(mutate.__name__ for mutate in chosen)


def build(sanitize: bool) -> Path:
    """The program with the flags of the strict tests."""
    flags = re.search(r'^@strict\n[^@]*^options --flag "(.*)"', (ROOT / "fpm.rsp").read_text(), re.M)[1]
    if sanitize:
        flags += " -fsanitize=address,undefined"
    words = ["fpm", "run", "gudgeon", "--profile", "debug", "--flag", flags, "--runner", "echo"]
    run = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{run.stdout}{run.stderr}\n0 passed, 1 failed")
    return ROOT / run.stdout.split()[-1]


class Fuzz:
    """Gives batches of mutants to one program."""

    def __init__(self, program: Path, work: Path, seed: int):
        self.program, self.work, self.seed = program, work, seed
        texts = [path.read_bytes() for path in sorted((ROOT / "cases").rglob("*.nml"))]
        self.cases = [text for text in texts if b"&mechanism" in text]   # the others are studies

    def start(self, files: list[Path], is_run: bool) -> tuple[int | str, str, str]:
        """Exit status (or 'hang'), standard output and standard error of the program over some files."""
        words = [str(self.program), "-j", "1"]
        if is_run:
            words += ["-o", str(files[0].parent / "out")]
            for setting in SHORT_RUN:
                words += ["--set", setting]
        else:
            words.append("--check")
        try:
            run = subprocess.run([*words, *map(str, files)], capture_output=True, timeout=SECONDS_A_FILE * len(files), check=False,
                                 stdin=subprocess.DEVNULL, env={**os.environ, "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1"})
        except subprocess.TimeoutExpired:
            return "hang", "", ""
        return run.returncode, run.stdout.decode("utf-8", "surrogateescape"), run.stderr.decode("utf-8", "surrogateescape")

    def wrong(self, files: list[Path], is_run: bool) -> tuple[str, dict[str, str]]:
        """What is wrong in the output for some files together ('' if nothing), and the outcome of each file."""
        status, out, err = self.start(files, is_run)
        allowed = (0, 3, 4, 5) if is_run else (0, 3)
        if status not in allowed:
            return f"exit status {status}: {err[-1500:]}", {}
        outcome: dict[str, str] = {}
        worst = 0
        for line in [*out.split("\n")[:-1], *err.split("\n")[:-1]]:
            if len(line.encode("utf-8", "surrogateescape")) > LONGEST_MESSAGE or not is_clear(line):
                return f"a line that is not clear: {line[:1000]!r}", {}
            is_message = line.startswith("gudgeon: ")
            if line.startswith("  ") or re.fullmatch("gudgeon: and [0-9]+ more errors", line) and "refused" in outcome.values():
                continue   # belongs to the line before
            names = [path.name for path in files if f"/{path.name}:" in line or line.startswith(f"{path.stem}: ")]
            if is_message and (": note: " in line or any(text in line for text in ("a build for debugging", "computing the film table"))):
                continue
            if len(names) != 1 or outcome.get(names[0], "refused") != "refused" or names[0] in outcome and not is_message:
                return f"a second outcome of a file: {line[:300]!r}", {}
            if not is_message:
                outcome[names[0]] = "correct" if not is_run else "finished"
                if " ended early; " in line:
                    del outcome[names[0]]   # its message follows
                continue
            outcome[names[0]] = "stopped" if " at t =" in line or "run to t =" in line else "refused"
            worst = max(worst, 4 if outcome[names[0]] == "stopped" else 3)
        if len(outcome) != len(files):
            return f"no line for {[path.name for path in files if path.name not in outcome]}; {out[-300:]} {err[-300:]}", {}
        if status != worst:
            return f"exit status {status}, not {worst}: {err[-300:]}", {}
        return "", outcome

    def batch(self, number: int, count: int, is_run: bool) -> tuple[list[tuple[str, str]], list[tuple[bytes, str]]]:
        """(mutations, outcome) of every file of a batch; and the files that fail, with the reason."""
        rng = random.Random(f"{self.seed} {number}")
        folder = self.work / f"b{number}"
        folder.mkdir()
        kinds: dict[str, str] = {}
        files = []
        for i in range(count):
            path = folder / f"f{number}x{i}y.nml"
            text, kinds[path.name] = mutant(rng.choice(self.cases), rng)
            path.write_bytes(text)
            files.append(path)
        what, outcome = self.wrong(files, is_run)
        bad = []
        if what:
            outcome = {}
            for path in files:   # repeat one by one to find the file that fails
                alone, found = self.wrong([path], is_run)
                outcome.update(found)
                if alone:
                    bad.append((path.read_bytes(), alone))
                    outcome[path.name] = "FAILED"
            if not bad:
                bad.append((b"".join(path.read_bytes() for path in files), f"fails only together with the others: {what}"))
        shutil.rmtree(folder)
        return [(kinds[name], found) for name, found in outcome.items()], bad


def odd_paths(fuzz: Fuzz) -> list[str]:
    """Paths that are not plain files: a folder, a pipe, a device, a link without target, a missing file."""
    work = fuzz.work
    (work / "folder.nml").mkdir()
    (work / "link.nml").symlink_to(work / "nothing")
    (work / "loop.nml").symlink_to(work / "loop.nml")
    failures = []
    for path in ("folder.nml", "link.nml", "loop.nml", "none.nml", "x" * 300 + ".nml", "new\nline.nml", "\xff\x01.nml"):
        status, out, err = fuzz.start([work / path], False)
        if status != 3 or out or err.count("\n") != 1 or not is_clear(err[:-1]):
            failures.append(f"{path[:40]!r}: {status} {err[:300]!r}")
    for path in ("/dev/null", "/dev/zero", "/proc/self/mem"):
        status, out, err = fuzz.start([Path(path)], False)
        if status != 3 or out or err.count("\n") != 1:
            failures.append(f"{path}: {status} {err[:300]!r}")
    pipe = work / "pipe.nml"
    os.mkfifo(pipe)
    status, out, err = fuzz.start([pipe], False)
    if status != 3 or err != f"gudgeon: {pipe}: not a regular file\n":
        failures.append(f"a pipe without a writer: {status} {err[:300]!r}")
    return failures


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=float, default=0.1, help="share of the files that are run and not only checked")
    parser.add_argument("--sanitize", action="store_true")
    parser.add_argument("--program", type=Path, help="program to test (default: build one)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--keep", type=Path, default=ROOT / "results" / "fuzz", help="folder for the files that fail")
    options = parser.parse_args()
    program = options.program or build(options.sanitize)
    counts: collections.Counter = collections.Counter()
    by_kind: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
    failed = done = 0
    batches = [(number, min(BATCH, options.files - number * BATCH)) for number in range(-(-options.files // BATCH))]
    with tempfile.TemporaryDirectory(prefix="fuzz") as work, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        fuzz = Fuzz(program, Path(work), options.seed)
        for failure in odd_paths(fuzz):
            print(f"FAILED: {failure}")
            failed += 1
        odd = 1 if failed else 0
        is_run = {number: random.Random(f"run {options.seed} {number}").random() < options.runs for number, _ in batches}
        running = {pool.submit(fuzz.batch, number, count, is_run[number]): number for number, count in batches}
        for future in concurrent.futures.as_completed(running):
            outcomes, bad = future.result()
            for kind, outcome in outcomes:
                counts["run" if is_run[running[future]] else "check", outcome] += 1
                for name in kind.split("+"):
                    by_kind[name][outcome] += 1
            for text, what in bad:
                options.keep.mkdir(parents=True, exist_ok=True)
                path = options.keep / f"{options.seed}_{running[future]}_{failed}.nml"
                path.write_bytes(text)
                print(f"FAILED: {path}{' (run)' if is_run[running[future]] else ''}: {what}", flush=True)
                failed += 1
            done += len(outcomes)
            if sys.stderr.isatty():
                print(f"\r{done} of {options.files}, {failed} failed", end="", file=sys.stderr)
    for (how, outcome), number in sorted(counts.items()):
        print(f"{how}: {number} {outcome}")
    for kind, found in sorted(by_kind.items()):
        print(f"  {kind}: " + ", ".join(f"{number} {outcome}" for outcome, number in sorted(found.items())))
    # one assertion for each kind of mutation and one for unusual paths, not one for each file
    wrong = max(sum(found["FAILED"] > 0 for found in by_kind.values()) + odd, 1 if failed else 0)
    print(f"{len(by_kind) + 1 - wrong} passed, {wrong} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
