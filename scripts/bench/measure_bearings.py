#!/usr/bin/env python3
"""Counts evaluations and instructions of a cycle of bearings that carry their load, and writes data/measured/bearings.md.

    scripts/bench/measure_bearings.py [--program PATH]

Needs valgrind. Instructions are counted since they do not depend on what else the machine does.
"""
from __future__ import annotations

import argparse
import csv
import re
import subprocess
import tempfile
from pathlib import Path

from measured import TOP, built_program, write_table

CASES = ("big_end", "flores2006", "rough", "car_diesel")
TURNS = (20, 60)   # revolutions of two runs, whose difference leaves out the start
NOTE = """Difference of runs of 20 and 60 revolutions of `cases/bearings/` at a relative tolerance of 1e-6, method auto, without wear; with answers: those of
the last cycle, which look for the largest pressure and integrate the side flow. An evaluation is one of the right-hand side; the film is evaluated
about seven times in each.

| case | evaluations a cycle | million instructions a cycle | the same with answers |
|---|---|---|---|
"""


def cost(program: Path, case: str, turns: int, answers: bool) -> tuple[int, int]:
    """Instructions of a run, and its evaluations of the right-hand side."""
    settings = ("run.until=end", f"integrator.revolutions={turns}", "output.samples_per_revolution=1", "integrator.relative_tolerance=1e-6",
                "output.columns=time", f"output.answers={'T' if answers else 'F'}", "wear=none")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "-q", "-o", folder,
                               *(word for setting in settings for word in ("--set", setting)), TOP / "cases" / "bearings" / f"{case}.nml"],
                              capture_output=True, text=True, check=True)
        with (Path(folder) / f"{case}.summary.csv").open(newline="") as file:
            summary = {row["quantity"]: row["value"] for row in csv.DictReader(file)}
    return int(re.search(r"refs: +([\d,]+)", done.stderr)[1].replace(",", "")), int(summary["rhs_evaluations"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to measure instead of the fast build")
    program = parser.parse_args().program or built_program()
    cycles = (TURNS[1] - TURNS[0]) / 2   # of two revolutions
    text = NOTE
    for case in CASES:
        cost(program, case, 2, False)   # makes the film tables
        (plain, evaluations), (answered, _) = (
            tuple((after - before) / cycles for before, after in zip(cost(program, case, TURNS[0], answers), cost(program, case, TURNS[1], answers)))
            for answers in (False, True))
        text += f"| `{case}` | {evaluations:.0f} | {1e-6 * plain:.1f} | {1e-6 * answered:.1f} |\n"
    print(write_table("bearings", "Cost of bearings that carry their load", "scripts/bench/measure_bearings.py", text))


if __name__ == "__main__":
    main()
