#!/usr/bin/env python3
"""The examples of the Python package: each runs in less than 20 s of processor time, draws its picture, and finds what it must.

    .venv/bin/python tests/test_examples.py [--all]      --all: also those that take more than five seconds

Needs the packages of scripts/setup.sh --embedding, and the shared library: that of the environment variable GUDGEON_LIBRARY, or else
build/library. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import contextlib
import importlib
import io
import json
import os
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
EXAMPLES = TOP / "scripts" / "python" / "examples"
sys.path[:0] = [str(TOP / "scripts" / "python" / "src"), str(EXAMPLES)]
os.environ.setdefault("GUDGEON_LIBRARY", str(TOP / "build" / "library" / "libgudgeon.so"))
import matplotlib

matplotlib.use("Agg")

#: What must hold of the numbers that `main` of an example returns. Those of the fit are the values with which its measurement was made;
#: those of the films are orders of magnitude and signs that mechanics demands.
HOLDS: dict[str, Callable[[dict[str, float]], bool]] = {
    "pin_offset": lambda found: found["slap"] < 0.8 * found["centred"] and 0 < found["offset"] < 1e-3,
    "tolerances": lambda found: found["done"] == 1 and found["low"] < 0.8 * found["median"] and abs(found["median"] / found["nominal"] - 1) < 0.1
    and 0.01 < found["chance"] < 0.1,
    "sobol_indices": lambda found: abs(found["sum"] - 1) < 0.25 and found["lubrication.viscosity"] > found["joint.clearance"] > found["combustion.heat"],
    "speed_controller": lambda found: abs(found["rpm"] - 1800) < 20 and found["torque"] > 5 and found["residual"] < 1e-4,
    "poincare": lambda found: found["dry_0500um"] > 1 and found["friction_100"] < 1e-3,
    "fmu_in_master": lambda found: found["apart"] == 0 and 1500 < found["speed"] * 30 / 3.14159 < 1600 and found["steps"] == 2000,
    "fit_clearance": lambda found: abs(found["clearance"] / 2.5e-4 - 1) < 0.02 and abs(found["friction"] / 0.15 - 1) < 0.1
    and 0 < found["clearance_error"] < 0.05 * 2.5e-4 and 0 < found["friction_error"] < 0.2 * 0.15
    and found["chaos"] > 1000 and found["calm"] < 10,
}
LONG = {"fit_clearance"}
passed = failed = 0


def check(holds: bool, what: str) -> None:
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    if not holds:
        print(f"FAILED: {what}")


def main() -> int:
    check({path.stem for path in EXAMPLES.glob("*.py")} == set(HOLDS), "every example is tested")
    page = (TOP / "data/manual/python.md").read_text(encoding="utf-8")
    shown = {"controller": lambda speed: 3.0}
    blocks = ["\n".join(line[4:] for line in block.splitlines()) for block in page.split("\n\n") if block.startswith("    ")]
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):   # for the files that the page writes
        for block in blocks[1:]:   # the first is for a shell
            try:
                exec(block, shown)
            except Exception:
                check(False, f"the page on Python: {block}: {traceback.format_exc()}")
        check(shown["table"]["pressure[bar]"].max() > 40 and Path("pressure.csv").is_file(), "the page on Python: a table of a rig")
    check(shown["run"].status.startswith("interrupted") or shown["run"].status == "done", "the page on Python runs")
    cells = json.loads((EXAMPLES / "first_steps.ipynb").read_text(encoding="utf-8"))["cells"]
    for cell in cells:
        if cell["cell_type"] == "code":
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(cell["source"], shown)
            except Exception:
                check(False, f"the notebook: {cell['source']}: {traceback.format_exc()}")
    check(len(shown["table"]) == 16 and "<svg" in shown["run"]._repr_html_(), "the notebook")
    for name, holds in HOLDS.items():
        check(f"examples/{name}.py" in page and f"examples/{name}.png" in page, f"the page on Python has {name}")
        if name in LONG and "--all" not in sys.argv:
            continue
        began = time.process_time()
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / f"{name}.png"
            try:
                found = importlib.import_module(name).main(str(picture))
            except Exception:
                check(False, f"{name}: {traceback.format_exc()}")
                continue
            check(holds(found), f"{name}: {found}")
            check(picture.stat().st_size > 8000, f"{name}: a picture")
        check(time.process_time() - began < 20, f"{name}: {time.process_time() - began:.1f} s of processor time")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
