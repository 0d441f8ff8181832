#!/usr/bin/env python3
"""Summaries and events of all shipped cases, and of tests/skirt_on_stiff_bore.nml, against their own traces: no row exceeds an
extreme of the summary.

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

STIFF = ROOT / "tests" / "skirt_on_stiff_bore.nml"
LONG = {"sim_IV", "sim_V"}   # run with another method than in their files, which need 4 and 11 million steps
PREFIXES = {"piston_pin": "", "crank_pin": "crank_pin_"}   # prefixes of the names of a joint's columns and quantities


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def force(row: dict[str, str], prefix: str) -> float:
    """Magnitude of the force on a pin; for a crank pin with clearance that of its contact and its film, only one of which acts."""
    names = [f"{prefix}{name}[N]" for name in (("pin_force_x", "pin_force_y") if not prefix else (
        "normal_force", "friction_force", "film_force_x", "film_force_y"))]
    return math.hypot(*(float(row[name]) for name in names if name in row))


def judge(folder: Path, name: str, slack: float) -> None:
    """Check one case. `slack` is the relative rounding, from the numbers in the files, of a force with two components."""
    summary = {row["quantity"]: row["value"] for row in table(folder / f"{name}.summary.csv")}
    rows = table(folder / f"{name}.csv")
    end, residual = float(summary["simulated_time"]), float(summary["max_energy_residual"])
    check(float(rows[-1]["time[s]"]) <= end, f"{name}: the last row is after the end of the run, {end!r} s")
    check(max(abs(float(row["energy_residual[J]"])) for row in rows) <= residual,
          f"{name}: max_energy_residual {residual!r} is smaller than in a row")
    fractions = sum(float(value) for quantity, value in summary.items() if "_time_fraction_with_" in quantity)
    check(not fractions or abs(fractions - 1) <= 1e-8, f"{name}: times by method sum to {fractions} of the run")
    events = table(folder / f"{name}.events.csv") if (folder / f"{name}.events.csv").exists() else []
    loose = {joint for joint, prefix in PREFIXES.items() if f"{prefix}film_thickness[m]" in rows[0]}
    corners = {f"guide_{i}" for i in range(1, 5) if f"guide_{i}_gap[m]" in rows[0] and "skirt_force[N]" not in rows[0]}   # not of a film
    check({event["joint"] for event in events} <= loose | corners, f"{name}: events of other joints than {loose | corners}")
    for corner in corners:
        judge_corner(name, corner, summary, rows, [event for event in events if event["joint"] == corner], slack)
    for joint, prefix in PREFIXES.items():
        has_figures = any(f"{prefix}{quantity}" in summary for quantity in ("contacts", "min_film_thickness", "max_penetration"))
        check(has_figures == (joint in loose),
              f"{name}: figures of the {joint} {'are missing' if joint in loose else 'are there although it is ideal'}")
        if joint == "piston_pin" or joint in loose:
            judge_pin(name, prefix, summary, rows, slack)
        if joint in loose:
            judge_contacts(name, prefix, summary, rows, [event for event in events if event["joint"] == joint])
    has_wear = any("wear_rate" in column for column in rows[0])
    check(has_wear == (folder / f"{name}.wear.csv").exists(), f"{name}: file of the worn surfaces")
    if has_wear:
        judge_wear(name, summary, table(folder / f"{name}.wear.csv"))


def judge_wear(name: str, summary: dict[str, str], bins: list[dict[str, str]]) -> None:
    """Check volumes and depths of the worn surfaces, one row for each bin."""
    for joint in {row["joint"] for row in bins}:
        for surface in ("pin", "bore"):
            volume, depth = (float(summary[f"{PREFIXES[joint]}{quantity}_{surface}"]) for quantity in ("worn_volume", "max_wear_depth"))
            rows = [row for row in bins if row["joint"] == joint]
            total, deepest = math.fsum(float(row[f"{surface}_volume[m3]"]) for row in rows), max(float(row[f"{surface}_depth[m]"]) for row in rows)
            check(abs(total - volume) <= 1e-8 * volume, f"{name}: worn_volume_{surface} {volume!r} is not the sum {total!r} of its bins")
            check(depth == deepest, f"{name}: max_wear_depth_{surface} {depth!r} is not that of the bins, {deepest!r}")


def judge_pin(name: str, prefix: str, summary: dict[str, str], rows: list[dict[str, str]], slack: float) -> None:
    """Check the largest pin force, which an ideal piston pin has too."""
    largest = max(force(row, prefix) for row in rows)
    peak = float(summary[f"{prefix}max_pin_force"])
    check(peak >= largest * (1 - slack), f"{name}: {prefix}max_pin_force {peak!r} is smaller than in a row, {largest!r}")


def judge_contacts(name: str, prefix: str, summary: dict[str, str], rows: list[dict[str, str]], events: list[dict[str, str]]) -> None:
    """Check film thickness and contacts of one joint."""
    film = min(float(row[f"{prefix}film_thickness[m]"]) for row in rows)
    thinnest, deepest = float(summary[f"{prefix}min_film_thickness"]), float(summary[f"{prefix}max_penetration"])
    check(thinnest <= film, f"{name}: {prefix}min_film_thickness {thinnest!r} is larger than in a row, {film!r}")
    check(deepest >= -film, f"{name}: {prefix}max_penetration {deepest!r} is smaller than in a row, {-film!r}")
    begun = sum(event["event"] == "contact_begins" for event in events)
    check(begun == int(summary[f"{prefix}contacts"]), f"{name}: {prefix}contacts differ from the {begun} in the events file")
    for event in events:
        if event["event"] != "contact_ends":
            continue
        end = float(event["time[s]"])
        inside = [row for row in rows if end - float(event["duration[s]"]) < float(row["time[s]"]) < end]
        if not inside:
            continue
        depth = max(-float(row[f"{prefix}film_thickness[m]"]) for row in inside)
        normal = max(float(row[f"{prefix}normal_force[N]"]) for row in inside)
        check(float(event["max_penetration[m]"]) >= depth, f"{name}: penetration of the {prefix}contact that ends at {end} s is larger in a row")
        check(float(event["max_normal_force[N]"]) >= normal,
              f"{name}: normal force of the {prefix}contact that ends at {end} s is larger in a row")
        check(float(event["max_penetration[m]"]) <= deepest,
              f"{name}: penetration of the {prefix}contact that ends at {end} s exceeds that of the summary")


def judge_corner(name: str, corner: str, summary: dict[str, str], rows: list[dict[str, str]], events: list[dict[str, str]],
                 slack: float) -> None:
    """Check the contacts of one corner of a piston with clearance in its bore."""
    begun = sum(event["event"] == "contact_begins" for event in events)
    check(begun == int(summary[f"{corner}_contacts"]), f"{name}: {corner}_contacts differ from the {begun} in the events file")
    deepest, largest = (float(summary[f"{corner}_{quantity}"]) for quantity in ("max_penetration", "max_force"))
    depth = max(-float(row[f"{corner}_gap[m]"]) for row in rows)
    force_of_rows = max(abs(float(row[f"{corner}_force[N]"])) for row in rows)
    check(deepest >= depth * (1 - slack), f"{name}: {corner}_max_penetration {deepest!r} is smaller than in a row, {depth!r}")
    check(largest >= force_of_rows * (1 - slack), f"{name}: {corner}_max_force {largest!r} is smaller than in a row, {force_of_rows!r}")
    for event in events:
        if event["event"] == "contact_ends":
            check(float(event["max_penetration[m]"]) <= deepest, f"{name}: penetration of a contact of {corner} exceeds that of the summary")
            check(float(event["max_normal_force[N]"]) <= largest, f"{name}: normal force of a contact of {corner} exceeds that of the summary")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path)
    gudgeon = Gudgeon(parser.parse_args().program or program_built())
    files = [file for folder in (".", "flores", "joints", "wear", "wiebe") for file in sorted((ROOT / "cases" / folder).glob("*.nml"))]
    with tempfile.TemporaryDirectory() as work:
        for method, slack, options in (("auto", 1e-9, ()), ("auto", 4e-16, ("--set", "output.digits=17")), ("adams", 1e-9, ())):
            chosen = [file for file in files if method == "auto" or file.stem not in LONG]
            status, _, err = gudgeon.run("--set", f"integrator.method={method}", *options, "-o", work, *chosen)
            check(status == 0, f"all cases run: {status} {err}")
            for file in chosen:
                judge(Path(work), file.stem, slack)
        # a skirt on a stiff bore: between the steps the energy is known less exactly than at their ends, and the crank turns back
        status, _, err = gudgeon.run("-o", work, STIFF)
        check(status == 4 and "turned back" in err, f"{STIFF.name}: {status} {err}")
        judge(Path(work), STIFF.stem, 1e-9)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
