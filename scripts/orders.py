#!/usr/bin/env python3
"""Analyses the settled cycles of a run: orders and spectra, means and their scatter, work and losses, loads on the bearings.

    scripts/orders.py sim_IV                                 the results of the case, which is run if they are missing
    scripts/orders.py results/sim_IV.csv --columns crank_speed guide_force
    scripts/orders.py dry_0500um --settle 20 --highest 60    cycles after 20 revolutions, orders up to 60

A cycle is one revolution of the crank, or two if there is gas. The analysis takes the whole cycles after the first half of the run,
or after --settle revolutions. A trace with `&output sampling = 'crank_angle'` is used as it is; other traces are interpolated to
equal crank angles. The most accurate input is a run with `&run until = 'periodic'` and `&output window = 'last_period'`. Writes,
into --out:

    NAME.orders.csv      each column's amplitude, phase and scatter by order
    NAME.work.csv        work on the bodies in the last whole cycle [J], by its parts, from the summary; with gas also as mean
                         effective pressures [Pa]: work over the swept volume
    NAME.cycles.png, NAME.orders.png, NAME.bearings.png and, with gas, NAME.indicator.png
"""

import argparse
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment(more=("scipy",))

import pandas as pd  # noqa: E402

from gudgeon_plots import cycle_pictures, figures, language  # noqa: E402
from gudgeon_plots.cycles import orders, whole_cycles, work  # noqa: E402
from gudgeon_plots.limits import number  # noqa: E402
from gudgeon_plots.report_cycles import COLUMNS, chosen  # noqa: E402
from gudgeon_plots.results import MissingResult, Results  # noqa: E402


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", metavar="NAME", help="name of a case, its file or its trace")
    parser.add_argument("--columns", nargs="+", metavar="COLUMN",
                        help=f"columns to analyse, without units (default: {' '.join(COLUMNS)}, those that vary)")
    parser.add_argument("--settle", type=number(0), metavar="REVOLUTIONS",
                        help="revolutions that are left out at the start (default: half of the run)")
    parser.add_argument("--cycles", type=number(1, whole=True), metavar="N", help="analyse only the last N cycles")
    parser.add_argument("--highest", type=number(0, itself=False), default=20.0, metavar="ORDER", help="highest order in the picture (default: 20)")
    parser.add_argument("--results", type=Path, metavar="DIR", help="folder of the traces (default: results, or that of the trace)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the files (default: beside the trace)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    language.add_option(parser)
    return parser.parse_args()


def main() -> int:
    try:
        return analyse(arguments())
    except (MissingResult, OSError) as problem:
        print(f"orders.py: {problem}", file=sys.stderr)
        return 1


def analyse(options: argparse.Namespace) -> int:
    """Write the tables and the pictures of one case. Raises MissingResult for a trace that lacks what they need."""
    given = Path(options.case)
    name = given.name.removesuffix(".nml").removesuffix(".csv")
    directory = options.results or (given.parent if given.suffix == ".csv" else TOP / "results")
    results = Results(directory, case=given if given.suffix == ".nml" and given.exists() else None)
    out = options.out or directory
    forms = options.format or ["png"]
    if not results.path(name).exists():
        results.make([name])
    cycles = whole_cycles(results[name], options.settle, options.cycles)
    columns = chosen(cycles, options.columns)
    tables = {column: orders(cycles, column) for column in columns}
    done = work(results[name])
    out.mkdir(parents=True, exist_ok=True)
    done.to_csv(out / f"{name}.work.csv", index=False)
    pd.concat([table.assign(column=column) for column, table in tables.items()])[
        ["column", "order", "amplitude", "phase_deg", "scatter"]
    ].to_csv(out / f"{name}.orders.csv", index=False)
    paths = [out / f"{name}.work.csv", out / f"{name}.orders.csv"]
    paths += figures.save(cycle_pictures.draw_means(cycles, columns), out, f"{name}.cycles", forms)
    paths += figures.save(cycle_pictures.draw_orders(cycles, columns, options.highest), out, f"{name}.orders", forms)
    paths += figures.save(cycle_pictures.draw_bearings(cycles), out, f"{name}.bearings", forms)
    if "cylinder_pressure" in cycles:
        paths += figures.save(cycle_pictures.draw_indicator(cycles), out, f"{name}.indicator", forms)
    language.current.warn("orders.py")
    print(f"{name}: {cycles.number} cycles")
    print(done.to_string(index=False, float_format=lambda value: f"{value:.5g}"))
    for column, table in tables.items():
        strongest = table[table["order"] > 0].nlargest(4, "amplitude")
        said = ", ".join(f"{row.order:g}: {row.amplitude:.4g}" for row in strongest.itertuples())
        print(f"{column} [{cycles.run.units.get(column, '')}], strongest orders: {said}")
    for path in paths:
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
