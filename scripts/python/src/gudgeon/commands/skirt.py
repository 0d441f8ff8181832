"""Draws a piston in its bore over the last cycle: pressure of the film on both faces of its skirt, gaps at their ends, friction of skirt
and rings, and the Stribeck curves of the rings.

    gudgeon-plot skirt cases/joints/skirt.nml                 run the case twice: its cycle, then six pressures in it
    gudgeon-plot skirt results/skirt.skirt.csv                a run with &output film_times: at those times
    gudgeon-plot skirt cases/joints/rings.nml                 rings alone
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from gudgeon.commands import Refused, add_output, add_results, save
from gudgeon.plots import skirt as pictures
from gudgeon.program import release_program
from gudgeon.results import MissingResult, Run, demand_numbers, load_run, located, read_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", metavar="RUN", help="case file, a CSV file of a run, or name of a run in results/")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    given = Path(options.source)
    results, name = located(given.with_name(given.name.replace(".skirt.csv", ".csv")), options.results, not options.no_run)
    shown = results[name]
    if "skirt_force" not in shown and "ring_friction_force" not in shown:
        raise Refused(f"{name}: neither a skirt with a film (&guide kind = 'lubricated') nor rings (&ring)")
    table = pressures(results.directory / f"{name}.skirt.csv")
    if table is None and "skirt_force" in shown and given.suffix == ".nml" and not options.no_run:
        shown, table = filmed(given, shown)
    save(pictures.draw(shown, table), options, results.directory, f"{name}_skirt")
    return 0


def pressures(path: Path) -> pd.DataFrame | None:
    """The rows of a NAME.skirt.csv; None if it is not there."""
    if not path.exists():
        return None
    table = read_table(path, "time", "crank_angle", "side", "height", "angle", "gap", "pressure")[0]
    demand_numbers(path, table, list(table.columns))
    return table


def filmed(case: Path, shown: Run) -> tuple[Run, pd.DataFrame | None]:
    """The run again, with six pressures of its last cycle, in a folder of its own."""
    begin, length = (float(shown.summary.get(f"cycle_{name}", ("nan", ""))[0]) for name in ("start", "duration"))
    if not np.isfinite(begin + length):
        raise MissingResult(f"{shown.name}: the run has no whole cycle")
    times = ", ".join(repr(begin + length * (k + 0.5) / 6) for k in range(6))
    with tempfile.TemporaryDirectory() as folder:
        words = [release_program(), "-q", "-o", folder, "-s", f"output.film_times='{times}'", case]
        outcome = subprocess.run(words, capture_output=True, text=True, check=False)
        if outcome.returncode != 0:
            raise MissingResult(outcome.stderr.strip())
        return load_run(Path(folder) / f"{shown.name}.csv"), pressures(Path(folder) / f"{shown.name}.skirt.csv")
