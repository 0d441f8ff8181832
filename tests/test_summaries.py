#!/usr/bin/env python3
"""Summaries and events of all shipped cases against their own traces: no row is beyond a peak.

    tests/test_summaries.py [--program PATH]

Needs a release build (or makes one). Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import math
import sys
import tempfile
from pathlib import Path

from test_faults import ROOT, Gudgeon, assertions, check, program_built

LONG = {"sim_IV", "sim_V"}   # with the method of their files: 4 and 11 million steps


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def judge(folder: Path, name: str, slack: float) -> None:
    """One case. `slack` is the rounding of the numbers in the files: of a force, which has two components."""
    summary = {row["quantity"]: row["value"] for row in table(folder / f"{name}.summary.csv")}
    rows = table(folder / f"{name}.csv")
    force = max(math.hypot(float(row["pin_force_x[N]"]), float(row["pin_force_y[N]"])) for row in rows)
    peak = float(summary["max_pin_force"])
    check(peak >= force * (1 - slack), f"{name}: max_pin_force {peak!r} is below a row, {force!r}")
    fractions = sum(float(value) for quantity, value in summary.items() if "_time_fraction_with_" in quantity)
    check(fractions <= 1 + 1e-9, f"{name}: times by method sum to {fractions} of the run")
    if "film_thickness[m]" not in rows[0]:
        return
    film = min(float(row["film_thickness[m]"]) for row in rows)
    thinnest, deepest = float(summary["min_film_thickness"]), float(summary["max_penetration"])
    check(thinnest <= film, f"{name}: min_film_thickness {thinnest!r} is above a row, {film!r}")
    check(deepest >= -film, f"{name}: max_penetration {deepest!r} is below a row, {-film!r}")
    if not (folder / f"{name}.events.csv").exists():
        return
    for event in table(folder / f"{name}.events.csv"):
        if event["event"] != "contact_ends":
            continue
        end = float(event["time[s]"])
        inside = [row for row in rows if end - float(event["duration[s]"]) < float(row["time[s]"]) < end]
        if not inside:
            continue
        depth = max(-float(row["film_thickness[m]"]) for row in inside)
        normal = max(float(row["normal_force[N]"]) for row in inside)
        check(float(event["max_penetration[m]"]) >= depth, f"{name}: a contact to {end} s is deeper in a row")
        check(float(event["max_normal_force[N]"]) >= normal, f"{name}: a contact to {end} s presses harder in a row")
        check(float(event["max_penetration[m]"]) <= deepest, f"{name}: a contact to {end} s is deeper than the deepest")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path)
    gudgeon = Gudgeon(parser.parse_args().program or program_built())
    files = [file for folder in (".", "flores", "wiebe") for file in sorted((ROOT / "cases" / folder).glob("*.nml"))]
    with tempfile.TemporaryDirectory() as work:
        for method, slack, options in (("auto", 1e-9, ()), ("auto", 4e-16, ("--set", "output.digits=17")), ("adams", 1e-9, ())):
            chosen = [file for file in files if method == "auto" or file.stem not in LONG]
            status, _, err = gudgeon.run("--set", f"integrator.method={method}", *options, "-o", work, *chosen)
            check(status == 0, f"cases run: {status} {err}")
            for file in chosen:
                judge(Path(work), file.stem, slack)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
