#!/usr/bin/env python3
"""Statistics of columns in studies (`&study statistics`) against the traces of the same runs, and what is refused.

    .venv/bin/python tests/test_column_statistics.py [--program PATH]        (after scripts/setup.sh --python)

Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))
sys.path.insert(0, str(TOP / "tests"))

from measured import use_virtual_environment

use_virtual_environment()

import numpy as np
import pandas as pd
from assertions import Assertions
from gudgeon.program import release_program
from scipy.integrate import simpson

assertions = Assertions()
check = assertions.check

#: Statistics, by their words, of values over times.
OF = {
    "min": lambda x, t: x.min(),
    "max": lambda x, t: x.max(),
    "max abs": lambda x, t: np.abs(x).max(),
    "range": lambda x, t: np.ptp(x),
    "mean": lambda x, t: simpson(x, x=t) / (t[-1] - t[0]),
    "rms": lambda x, t: np.sqrt(simpson(x**2, x=t) / (t[-1] - t[0])),
}

JUMPING = ("max", "max abs", "range")


def sweep(program: Path, folder: Path, text: str, *options: str) -> subprocess.CompletedProcess:
    (folder / "study.nml").write_text(text)
    return subprocess.run([program, "sweep", "-q", "--fresh", "-o", folder / "out", *options, folder / "study.nml"], capture_output=True, text=True, check=False)


def against_traces(program: Path, folder: Path) -> None:
    """Every statistic of some columns, also of columns that only the statistics ask for, over the last cycle of engines and over the
    whole of a run that is shorter than a cycle."""
    columns = ("piston_acceleration", "crankpin_force_x", "crank_pin_film_power", "crank_pin_max_film_pressure", "crank_pin_film_thickness")
    plain = ("piston_acceleration", "film_thickness", "pin_force_x", "crank_speed")
    for case, names, turns, settings, limit in (
        ("film/heat", columns, 2, ("run.until=end", "integrator.revolutions=6"), 2e-5),
        ("joints/both_pins_lubricated", (*plain, "crank_pin_eccentricity_ratio"), 1, ("integrator.revolutions=3",), 1e-4),   # rows at even times
        ("flores/friction_050", plain, 1, (), 2e-3),   # rows do not resolve its impacts
        ("film/heat", columns[:2], 0, ("run.until=end", "integrator.revolutions=0.7", "crank_pin.lubrication.report=F"), 2e-5),
    ):
        wanted = [(word, name) for word in OF for name in names]
        asked = ", ".join(f"{word} {name}" for word, name in wanted)
        study = (f"&study case = '{TOP / 'cases' / case}.nml', statistics = '{asked}', traces = 'all' /\n"
                 "&parameter key = 'integrator.relative_tolerance', values = 1e-8 /\n")
        dense = f"output.columns=time, crank_angle, {', '.join(names)}"
        options = [part for setting in (*settings, dense, "output.samples_per_revolution=14400", "output.digits=17") for part in ("--set", setting)]
        done = sweep(program, folder, study, *options)
        check(done.returncode == (0 if turns else 4), f"study of {case}", done.stderr)
        if done.returncode not in (0, 4):
            continue
        row = pd.read_csv(folder / "out" / "study.runs.csv").iloc[0].rename(lambda name: name.split("[")[0])
        trace = pd.read_csv(folder / "out" / "study" / "1.csv").rename(columns=lambda name: name.split("[")[0])
        turned = (trace["crank_angle"] - trace["crank_angle"].iloc[0]) / (2 * np.pi)
        ended = np.floor(turned.iloc[-1] + 1e-9)
        inside = (turned > ended - turns - 1e-9) & (turned < ended + 1e-9) if turns else turned >= 0
        t = trace["time"][inside].to_numpy()
        if turns == 0:
            check("no whole revolution" in str(row["status"]), "no whole revolution")
        for word, name in wanted:
            found = row[f"{name}_{word.replace(' ', '_')}"]
            values = trace[name][inside].to_numpy()
            expected = OF[word](values, t)
            size = max(abs(expected), np.ptp(values))
            if word in JUMPING and name == "piston_acceleration" and turns == 2:   # for 1e-7 s after the gas is let out at 540 degrees
                check(found >= expected, f"{word} {name}, {case}, with a jump between rows", f"{found} {expected}")
                continue
            check(abs(found - expected) <= limit * size, f"{word} {name}, {case}", f"{found} {expected}")
            if word == "max":   # extremes are searched inside steps
                check(found >= expected - 1e-7 * size, f"no row is above the largest {name}, {case}", f"{found} {expected}")
    # columns that are asked for do not change the rest of the row, nor the digits of a run
    study = f"&study case = '{TOP / 'cases' / 'sim_I'}.nml' {{}} /\n&parameter key = 'joint.clearance', values = 1e-5, 2e-5 /\n"
    sweep(program, folder, study.format(""))
    without = (folder / "out" / "study.runs.csv").read_text().splitlines()
    sweep(program, folder, study.format(", statistics = 'mean film_force_x'"))
    with_them = (folder / "out" / "study.runs.csv").read_text().splitlines()
    check(all(longer.startswith(shorter + ",") for shorter, longer in zip(without, with_them, strict=True)), "other columns stay the same",
          str((without[1], with_them[1])))


def refused(program: Path, folder: Path) -> None:
    """One line, with the word that was meant."""
    for asked, said in (
        ("max abs piston_aceleration", "no such column in this scene; did you mean piston_acceleration?"),
        ("maks piston_acceleration", "must be a statistic and a column; did you mean max?"),
        ("piston_acceleration", "must be a statistic and a column"),
        ("max pin_force_x, max pin_force_x", "'max pin_force_x': is given twice"),
        ("max abs", "no such column"),
        ("mean nonsense", "no such column in this scene\n"),
        ("max pin_force_x,", "must be a statistic and a column"),
        ("mean cylinder_pressure", "no such column in this scene"),
    ):
        study = f"&study case = '{TOP / 'cases' / 'sim_I'}.nml', statistics = '{asked}' /\n&parameter key = 'joint.clearance', values = 1e-5 /\n"
        done = sweep(program, folder, study)
        check(done.returncode == 3 and said in done.stderr and done.stderr.count("\n") == 1 and "&study statistics = " in done.stderr,
              f"refused: {asked}", f"{done.returncode} {done.stderr}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, help="the program; default: the release build")
    program = (parser.parse_args().program or release_program()).resolve()
    with tempfile.TemporaryDirectory() as folder:
        against_traces(program, Path(folder))
        refused(program, Path(folder))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
