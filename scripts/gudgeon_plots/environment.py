"""Finds a Python that has the packages for the plots. This module imports only the standard library."""

import importlib.util
import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PACKAGES = ("matplotlib", "numpy", "pandas", "plotly")
STUDIES = ("SALib", "f90nml")


def use_virtual_environment(studies: bool = False, more: tuple[str, ...] = ()) -> None:
    """Restart the script with the Python of .venv if this one lacks the packages for the plots (with `studies` also those for
    parameter studies, and those named in `more`). If both lack them, exit with a message that names the command that installs
    them."""
    wanted = PACKAGES + (STUDIES if studies else ()) + more
    missing = [name for name in wanted if importlib.util.find_spec(name) is None]
    if not missing:
        return
    python = TOP / ".venv" / "bin" / "python"
    if python.exists() and Path(sys.prefix).resolve() != python.parents[1].resolve():
        os.execv(python, [str(python), *sys.argv])
    option = "--studies" if studies else "--python"
    sys.exit(f"{Path(sys.argv[0]).name}: needs {', '.join(missing)}: run scripts/setup.sh {option}")
