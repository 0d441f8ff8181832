"""Finds the Python that has the plots' packages. Imports only what every Python has."""

import importlib.util
import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PACKAGES = ("matplotlib", "numpy", "pandas", "plotly")
STUDIES = ("SALib", "f90nml")


def use_virtual_environment(studies: bool = False, more: tuple[str, ...] = ()) -> None:
    """Continue with .venv's Python if this one lacks the packages, with `studies` also those of parameter studies, and `more`. If
    neither has them, exit with a message that says which command installs them."""
    wanted = PACKAGES + (STUDIES if studies else ()) + more
    missing = [name for name in wanted if importlib.util.find_spec(name) is None]
    if not missing:
        return
    python = TOP / ".venv" / "bin" / "python"
    if python.exists() and Path(sys.prefix).resolve() != python.parents[1].resolve():
        os.execv(python, [str(python), *sys.argv])
    option = "--studies" if studies else "--python"
    sys.exit(f"{Path(sys.argv[0]).name}: needs {', '.join(missing)}: run scripts/setup.sh {option}")
