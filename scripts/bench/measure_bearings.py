#!/usr/bin/env python3
"""Counts evaluations and instructions of a cycle of bearings that carry their load, and writes data/measured/bearings.md.

    scripts/bench/measure_bearings.py [--program PATH]

Needs valgrind. Instructions are counted since they do not depend on what else the machine does.
"""
from __future__ import annotations

import tempfile
from pathlib import Path

from measured import counted, program_of, table, write_table

CASES = ("big_end", "flores2006", "rough", "car_diesel")
TURNS = (20, 60)   # revolutions of two runs, whose difference leaves out the start
NOTE = """Difference of runs of 20 and 60 revolutions of `cases/bearings/` at a relative tolerance of 1e-6, method auto, without wear; with answers: those of
the last cycle, which look for the largest pressure and integrate the side flow. An evaluation is one of the right-hand side; the film is evaluated
about seven times in each.

"""


def cost(program: Path, case: str, turns: int, answers: bool) -> tuple[int, int]:
    """Evaluations of the right-hand side in a run, and its instructions."""
    settings = ("run.until=end", f"integrator.revolutions={turns}", "output.samples_per_revolution=1", "integrator.relative_tolerance=1e-6",
                "output.columns=time", f"output.answers={'T' if answers else 'F'}", "wear=none")
    with tempfile.TemporaryDirectory() as folder:
        return counted(program, f"bearings/{case}", folder, settings)


def main() -> None:
    program = program_of(__doc__)
    cycles = (TURNS[1] - TURNS[0]) / 2   # of two revolutions
    rows = []
    for case in CASES:
        cost(program, case, 2, False)   # makes the film tables
        (evaluations, plain), (_, answered) = (
            tuple((after - before) / cycles for before, after in zip(cost(program, case, TURNS[0], answers), cost(program, case, TURNS[1], answers)))
            for answers in (False, True))
        rows.append((f"`{case}`", f"{evaluations:.0f}", f"{1e-6 * plain:.1f}", f"{1e-6 * answered:.1f}"))
    text = NOTE + table(("case", "evaluations a cycle", "million instructions a cycle", "the same with answers"), rows)
    print(write_table("bearings", "Cost of bearings that carry their load", "scripts/bench/measure_bearings.py", text))


if __name__ == "__main__":
    main()
