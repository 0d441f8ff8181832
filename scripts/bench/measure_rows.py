#!/usr/bin/env python3
"""Measures how accurate the rows of a trace are, most of which lie inside the steps of the integrator, and writes
data/measured/rows.md.

    scripts/bench/measure_rows.py

Each case runs by the methods radau and auto at three tolerances. Its rows are compared with those of the same case by Radau at
1e-11. Takes five seconds after the build.
"""
from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from measured import built_program, run, table, use_virtual_environment, write_table

use_virtual_environment()

import numpy as np
from gudgeon.results import MissingResult, Run, load_run

CASES = ("sim_I", "sim_II", "sim_III", "sim_IV", "sim_V", "flores/lubricated_400cP", "film/sim_I_finite", "film/elastic",
         "joints/both_pins_lubricated", "friction/lugre")
METHODS = ("radau", "auto")
TOLERANCES = (1e-4, 1e-6, 1e-8)
REFERENCE = 1e-11
#: Headings, and the columns whose largest error is shown; a case without one of them has the others.
KINDS = {"coordinates": ("crank_angle", "rod_angle", "piston_position", "eccentricity_x", "eccentricity_y"),
         "speeds": ("crank_speed", "rod_speed", "piston_velocity"),
         "forces and accelerations": ("rod_acceleration", "piston_acceleration", "pin_force_x", "pin_force_y", "guide_force")}

NOTE = """Largest errors in the rows of a trace, over the range of each column, by `radau` and by `auto`, against Radau at 1e-11. Films of finite
length have a finer table at tighter tolerances, whose error is included.

"""


def run_of(program: Path, case: str, method: str, tolerance: float) -> Run:
    """A run of a case, without its ideal twin."""
    with tempfile.TemporaryDirectory() as folder:
        run(program, case, folder, ("output.ideal_twin=F", "output.digits=15", f"integrator.method={method}",
                                    f"integrator.relative_tolerance={tolerance!r}"))
        return load_run(Path(folder) / f"{Path(case).name}.csv")


def largest_error(run: Run, exact: Run, names: tuple[str, ...]) -> float:
    """Largest error of some columns, each over its range."""
    return max(np.max(np.abs(run[name] - exact[name])) / np.ptp(exact[name]) for name in names if name in exact and np.ptp(exact[name]) > 0)


def main() -> int:
    """Measure all cases."""
    if len(sys.argv) > 1:
        print(__doc__, file=sys.stderr)
        return 2
    rows = []
    try:
        program = built_program()
        for case in CASES:
            exact = run_of(program, case, "radau", REFERENCE)
            for tolerance in TOLERANCES:
                runs = [run_of(program, case, method, tolerance) for method in METHODS]
                rows.append([f"`{case}`", f"{tolerance:.0e}",
                             *(f"{largest_error(one, exact, names):.1e}" for names in KINDS.values() for one in runs)])
    except MissingResult as failure:
        print(f"measure_rows.py: {failure}", file=sys.stderr)
        return 1
    text = NOTE + table(("case", "tolerance", *(f"{kind}: {method}" for kind in KINDS for method in METHODS)), rows)
    print(write_table("rows", "Accuracy of rows inside the steps", "scripts/bench/measure_rows.py", text))
    return 0


if __name__ == "__main__":
    sys.exit(main())
