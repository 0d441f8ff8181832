"""The program gudgeon: the release build of a checkout, or the program on the PATH."""

import shutil
import subprocess
from functools import cache
from pathlib import Path

_TOP = Path(__file__).resolve().parents[4]

#: The checkout of which this package is a part; None where the package is installed elsewhere.
CHECKOUT = _TOP if (_TOP / "scripts" / "build.sh").is_file() else None


class MissingResult(Exception):
    """Raised for a result that does not exist and cannot be made."""


@cache
def release_program() -> Path:
    """The release build of the checkout, brought up to date once; without a checkout the program on the PATH."""
    if CHECKOUT is None:
        if found := shutil.which("gudgeon"):
            return Path(found)
        raise MissingResult("the program gudgeon is not on the PATH")
    outcome = subprocess.run([CHECKOUT / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(f"cannot build gudgeon:\n{outcome.stderr}")
    return CHECKOUT / outcome.stdout.strip()
