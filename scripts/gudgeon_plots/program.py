"""The release build of gudgeon."""

import subprocess
from pathlib import Path

from .environment import TOP
from .results import MissingResult


def release_program() -> Path:
    """The release build of gudgeon, brought up to date."""
    return built_program()


def built_program(*name: str) -> Path:
    """The release build of gudgeon, or of a program of scripts/fpm.toml, brought up to date."""
    outcome = subprocess.run([TOP / "scripts" / "build.sh", *name], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(f"cannot build {' '.join(name) or 'gudgeon'}:\n{outcome.stderr}")
    return TOP / outcome.stdout.strip()
