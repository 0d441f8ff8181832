"""The command `gudgeon`: the program of the package."""

import os
import sys
from pathlib import Path


def main() -> None:
    program = Path(__file__).parent / "bin" / "gudgeon"
    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}"  # gudgeon plot
    os.execv(program, ["gudgeon", *sys.argv[1:]])
