"""Measured tables: data/measured/NAME.md, each beginning with its command, date and machine."""
from __future__ import annotations

import datetime
import os
import platform
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent.parent / "data" / "measured"


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
