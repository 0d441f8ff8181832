"""Runs of the program with settings, and what its summaries say; needs the standard library alone."""
from __future__ import annotations

import csv
import subprocess
from pathlib import Path


def run(program: Path, case: Path, folder: Path, *settings: str, quiet: bool = False) -> subprocess.CompletedProcess:
    """Run a case with settings GROUP.KEY=VALUE; results are in the folder."""
    words = [word for setting in settings for word in ("--set", setting)]
    command = [program, *(["--quiet"] if quiet else []), case, "--out", folder, *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)


def summary_of(path: Path) -> dict[str, str]:
    """The values of a summary by their quantities."""
    with path.open(newline="") as file:
        return {row["quantity"]: row["value"] for row in csv.DictReader(file)}
