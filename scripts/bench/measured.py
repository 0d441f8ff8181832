"""What the measurements share: the checkout, its programs, and tables data/measured/NAME.md, each beginning with its command, date and
machine."""
from __future__ import annotations

import datetime
import importlib.util
import os
import platform
import subprocess
import sys
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
