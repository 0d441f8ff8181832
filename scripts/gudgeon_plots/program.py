"""The release build of gudgeon."""

import subprocess
from pathlib import Path

from .environment import TOP
from .results import MissingResult


def release_program() -> Path:
    """The release build of gudgeon, brought up to date."""
    command = ". scripts/setup.sh && fpm build --profile release >&2 && fpm run --profile release --runner echo"
    outcome = subprocess.run(["sh", "-c", command], cwd=TOP, capture_output=True, text=True, check=False)
    found = [word for word in outcome.stdout.split() if word.endswith("/app/gudgeon")]
    if outcome.returncode != 0 or not found:
        raise MissingResult(f"cannot build gudgeon:\n{outcome.stderr}")
    return TOP / found[-1]
