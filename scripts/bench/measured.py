"""What the measurements share: the checkout, its programs, runs of its cases, and tables data/measured/NAME.md, each beginning with its
command, date and machine."""
from __future__ import annotations

import argparse
import csv
import datetime
import importlib.util
import os
import platform
import re
import resource
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
FOLDER = TOP / "data" / "measured"


def use_virtual_environment() -> None:
    """Restart the script with the Python of .venv if this one lacks the package gudgeon or what it draws with; if both lack it, exit with
    a message that names the command that installs it."""
    if all(importlib.util.find_spec(name) for name in ("gudgeon", "matplotlib", "pandas")):
        return
    python = TOP / ".venv" / "bin" / "python"
    if python.exists() and Path(sys.prefix).resolve() != python.parents[1].resolve():
        os.execv(python, [str(python), *sys.argv])
    sys.exit(f"{Path(sys.argv[0]).name}: run scripts/setup.sh --python")


def built_program(*words: str) -> Path:
    """The release build of gudgeon, or of a program of fpm.toml in this folder, brought up to date; words are those of scripts/build.sh.
    Exits where it cannot be built."""
    outcome = subprocess.run([TOP / "scripts" / "build.sh", *words], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        sys.exit(f"{Path(sys.argv[0]).name}: cannot build {' '.join(words) or 'gudgeon'}:\n{outcome.stderr}")
    return TOP / outcome.stdout.strip()


def program_of(about: str) -> Path:
    """The program that the command line names (--program), or the release build; `about` is the text of --help."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    program = parser.parse_args().program
    return program.resolve() if program else built_program()


def run(program: Path, case: Path | str, folder: Path | str, settings: Iterable[str] = (), options: Iterable[str] = (),
        under: Iterable[str] = ()) -> dict[str, str]:
    """Run a case, a file or its name below cases/, with other values of its keys and its results in a folder. Returns the summary, and
    what the program said as `said`. Exits with its message where the run fails."""
    case = case if isinstance(case, Path) else TOP / "cases" / f"{case}.nml"
    words = [word for setting in settings for word in ("--set", setting)]
    done = subprocess.run([*under, program, "-q", "-o", folder, *options, *words, case], cwd=TOP, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{Path(sys.argv[0]).name}: {case.stem} {' '.join(words)}: {done.stderr.strip()}")
    with (Path(folder) / f"{case.stem}.summary.csv").open(encoding="utf-8", newline="") as file:
        return {row["quantity"]: row["value"] for row in csv.DictReader(file)} | {"said": done.stderr}


def timed_run(program: Path, case: Path | str, folder: Path | str, settings: Iterable[str] = ()) -> tuple[float, dict[str, str]]:
    """The least processor time of three runs of a case with all files [s], and its summary."""

    def used() -> float:
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    times, summary = [], {}
    for _ in range(3):
        before = used()
        summary = run(program, case, folder, settings)
        times.append(used() - before)
    return min(times), summary


def counted(program: Path, case: str, folder: str, settings: Iterable[str], profile: str = "/dev/null") -> tuple[int, int]:
    """Evaluations of the right-hand side in a run, and all its instructions, counted by valgrind."""
    summary = run(program, case, folder, settings, under=("valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}"))
    return int(summary["rhs_evaluations"]), int(re.search(r"refs: +([\d,]+)", summary["said"])[1].replace(",", ""))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table of Markdown."""
    head, *lines = ("| " + " | ".join(row) + " |" for row in (list(head), *rows))
    return "\n".join((head, re.sub(r"[^|]+", "---", head), *lines))


def machine() -> str:
    """Processor and number of cores."""
    model = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    except OSError:
        pass
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


def write_table(name: str, title: str, command: str, text: str, folder: Path = FOLDER) -> Path:
    """Write NAME.md into data/measured or another folder: title, command, date, machine, and the text."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.md"
    head = f"# {title}\n\n    {command}\n\n{datetime.date.today().isoformat()}, {machine()}.\n\n"
    path.write_text(head + text.strip() + "\n", encoding="utf-8")
    return path
