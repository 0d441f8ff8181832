"""The release build of gudgeon."""

import subprocess
from pathlib import Path

from .environment import TOP
from .results import MissingResult


def release_program() -> Path:
    """The release build of gudgeon, brought up to date."""
    outcome = subprocess.run([TOP / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(f"cannot build gudgeon:\n{outcome.stderr}")
    return TOP / outcome.stdout.strip()
