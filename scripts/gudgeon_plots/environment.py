"""Finds the Python that has the plots' packages. Imports only what every Python has."""

import importlib.util
import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PACKAGES = ("matplotlib", "numpy", "pandas", "plotly")


def use_virtual_environment() -> None:
    """Go on in .venv's Python if this one lacks the packages; leave with what to do if neither has them."""
    missing = [name for name in PACKAGES if importlib.util.find_spec(name) is None]
    if not missing:
        return
    python = TOP / ".venv" / "bin" / "python"
    if python.exists() and Path(sys.prefix).resolve() != python.parents[1].resolve():
        os.execv(python, [str(python), *sys.argv])
    sys.exit(f"{Path(sys.argv[0]).name}: needs {', '.join(missing)}: run scripts/setup.sh --python")
