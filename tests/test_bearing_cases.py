#!/usr/bin/env python3
"""Bearing cases as a user runs them: the seven bearings of data/film/engine against the results of an independent program, each column
within its tolerance in facts.csv, limits, and what is refused.

    tests/test_bearing_cases.py [--program PATH]

Needs the standard library alone. Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "tests"))

from assertions import Assertions

assertions = Assertions()
check = assertions.check
BEARINGS = TOP / "data" / "film" / "engine"
COARSE = ("film_history.around=96", "film_history.along=8")
#: Settings that are refused, and what the message must contain.
REFUSED = (
    (("supply.width_deg=0",), "width_deg"), (("supply.length=1",), "length"), (("supply.position_deg=a",), "position_deg"),
    (("supply.position_deg=1,2,3,4,5,6,7,8,9",), "position_deg"), (("supply.kind=slots",), "kind"), (("supply.kind=holes",), "diameter"),
    (("supply.kind=holes", "supply.diameter=1e-4"), "hole is smaller than a cell"), (("bore.outer_radius=0.025",), "outer_radius"),
    (("film_history.table=absent.csv",), "absent.csv"), (("film_history.around=23",), "around"),
    (("lubrication.pressure_viscosity=1e-4",), "pressure_viscosity"), (("mechanism.gravity=3",), "mechanism"))


def run(program: Path, case: Path, folder: Path, *settings: str) -> subprocess.CompletedProcess:
    """Run a case with settings; results are in the folder."""
    command = [program, case, "--out", folder, *(word for setting in settings for word in ("--set", setting))]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)


def columns_of(path: Path) -> dict[str, list[float]]:
    """The columns of a table of numbers by their names."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def summary_of(path: Path) -> dict[str, str]:
    """The values of a summary by their quantities."""
    with path.open(newline="") as file:
        return {row["quantity"]: row["value"] for row in csv.DictReader(file)}


def scale_of(columns: dict[str, list[float]], name: str) -> float:
    """Largest magnitude of a column; for eccentricities and forces that of the vector."""
    if name.startswith(("eccentricity", "film_force")):
        return max(map(math.hypot, columns[name.replace("_y[", "_x[")], columns[name.replace("_x[", "_y[")]))
    return max(map(abs, columns[name]))


def check_references(program: Path, folder: Path) -> None:
    """All columns of the seven bearings within their tolerances; the resolved case gives the same rows."""
    with (BEARINGS / "facts.csv").open(newline="") as file:
        facts = list(csv.DictReader(file))
    for case in sorted({fact["case"] for fact in facts}):
        done = run(program, BEARINGS / f"{case}.nml", folder)
        check(done.returncode == 0, f"{case} runs", done.stderr)
        if done.returncode:
            continue
        found, wanted = columns_of(folder / f"{case}.film_history.csv"), columns_of(BEARINGS / f"{case}.film_history.csv")
        for fact in (fact for fact in facts if fact["case"] == case):
            name = fact["quantity"]
            target = wanted[name] if fact["value"] == "rms" else [float(fact["value"])]
            error = math.sqrt(sum((a - b)**2 for a, b in zip(found[name], target)) / len(target)) / scale_of(wanted, name)
            check(len(found[name]) == len(target) and error <= float(fact["tolerance"]), f"{case}: {name}",
                  f"error {error:.2g}, allowed {fact['tolerance']}")
        check(float(summary_of(folder / f"{case}.summary.csv")["film_history_mass_residual"]) < 1e-9, f"mass of {case}")
    done = run(program, folder / "steady_groove.resolved.nml", folder / "again")
    again = folder / "again" / "steady_groove.resolved.film_history.csv"
    check(done.returncode == 0 and again.read_bytes() == (folder / "steady_groove.film_history.csv").read_bytes(),
          "the resolved case gives the same rows", done.stderr)


def check_limits(program: Path, folder: Path) -> None:
    """More oil thickens the film of a load; without any supply it thins from cycle to cycle."""
    case, least, fill = BEARINGS / "load_groove.nml", {}, {}
    for name, settings in {"groove": (), "dry": ("supply=none", "film_history.most_cycles=2"),
                           "drier": ("supply=none", "film_history.most_cycles=6"), "unfed": ("supply.pressure=0",), "flooded": ("lubrication.ambient_over_cavitation=1e5",)}.items():
        done = run(program, case, folder / name, *COARSE, *settings)
        check(done.returncode == 0, f"runs: {name}", done.stderr)
        if done.returncode:
            return
        summary = summary_of(folder / name / "load_groove.summary.csv")
        least[name], fill[name] = (float(summary[f"film_history_{of}"]) for of in ("min_film_thickness", "least_fill"))
        if name == "dry":
            check(float(summary["film_history_mean_supply_flow"]) == 0, "no supply, no flow from it")
    check(least["unfed"] < least["groove"] < least["flooded"] and least["drier"] < least["dry"], "more oil, a thicker film", str(least))
    check(fill["drier"] < fill["dry"] < fill["unfed"] < fill["groove"] < fill["flooded"], "more oil, a fuller gap", str(fill))


def check_refused(program: Path, folder: Path) -> None:
    """Wrong settings and tables end with status 3, one line, and no result."""
    for settings, word in REFUSED:
        done = run(program, BEARINGS / "load_groove.nml", folder / "refused", *settings)
        check(done.returncode == 3 and word in done.stderr and done.stderr.count("\n") == 1, f"refused: {settings}", done.stderr)
    header = "time[s],pin_speed[rad/s],eccentricity_x[m],eccentricity_y[m],load_x[N],load_y[N]\n"
    text = (BEARINGS / "load_groove.nml").read_text().replace("load_groove.table.csv", "bad.csv")
    (folder / "bad.nml").write_text(text)
    for name, table in {"empty": "", "no rows": header, "a word": header + "0,1,0,0,x,0\n", "short": header + "0,1,0,0,1\n",
                        "times": header + "0,1,0,0,1,0\n0,1,0,0,1,0\n", "no load": "time[s],pin_speed[rad/s]\n0,1\n",
                        "not finite": header + "0,1,0,0,nan,0\n"}.items():
        (folder / "bad.csv").write_text(table)
        done = run(program, folder / "bad.nml", folder / "refused")
        check(done.returncode == 3 and "bad.csv" in done.stderr and done.stderr.count("\n") == 1, f"refused table: {name}", done.stderr)
    check(not (folder / "refused").exists(), "no result of a refused case")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to test instead of the fast build")
    options = parser.parse_args()
    program = options.program or Path(subprocess.run(
        [TOP / "scripts" / "build.sh"], capture_output=True, text=True, check=True, cwd=TOP).stdout.strip())
    program = program.resolve()
    with tempfile.TemporaryDirectory() as name:
        check_references(program, Path(name))
        check_limits(program, Path(name))
        check_refused(program, Path(name))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
