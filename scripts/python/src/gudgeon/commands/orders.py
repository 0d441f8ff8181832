"""Analyses the settled cycles of a run: orders and spectra, means and their scatter, work and losses, loads on the bearings.

    gudgeon-plot orders cases/sim_IV.nml                       the results of the case, which is run if they are missing
    gudgeon-plot orders results/sim_IV.csv --columns crank_speed guide_force
    gudgeon-plot orders engine --settle 20 --highest 60    cycles after 20 revolutions, orders up to 60

A cycle is one revolution of the crank, or two of a four-stroke engine. The analysis takes the whole cycles after the first half of the run,
or after --settle revolutions. A trace with `&output sampling = 'crank_angle'` is used as it is; other traces are interpolated to
equal crank angles. The most accurate input is a run with `&run until = 'periodic'` and `&output window = 'last_period'`. Writes:

    NAME.orders.csv      each column's amplitude, phase and scatter by order
    NAME.work.csv        work on the bodies in the last whole cycle [J], by its parts, from the summary; with gas also as mean
                         effective pressures [Pa]: work over the swept volume
    (both tables with decimal points in every --language; what is printed has its words and decimal marks)
    NAME.cycles.png, NAME.orders.png, NAME.bearings.png and, with gas, NAME.indicator.png, as gudgeon-plot indicator
"""

import argparse

import pandas as pd

from gudgeon import language
from gudgeon.commands import Names, add_output, add_results, number, save
from gudgeon.cycles import orders, whole_cycles, work
from gudgeon.plots import cycles as pictures
from gudgeon.report.answers import number as figure
from gudgeon.report.cycles import COLUMNS, chosen, readable_work
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--columns", nargs="+", action=Names, metavar="COLUMN",
                        help=f"columns to analyse, without units (default: {' '.join(COLUMNS)}, those that vary)")
    parser.add_argument("--settle", type=number(0), metavar="REVOLUTIONS",
                        help="revolutions that are left out at the start (default: half of the run)")
    parser.add_argument("--cycles", type=number(1, whole=True), metavar="N", help="analyse only the last N cycles")
    parser.add_argument("--highest", type=number(0, itself=False), default=20.0, metavar="ORDER", help="highest order in the picture (default: 20)")
    add_results(parser)
    add_output(parser, several=True)


def run(options: argparse.Namespace) -> int:
    results, name = located(options.case, options.results, not options.no_run)
    out = options.out or results.directory
    language.current.keep(name)
    cycles = whole_cycles(results[name], options.settle, options.cycles)
    columns = chosen(cycles, options.columns)
    tables = {column: orders(cycles, column) for column in columns}
    done = work(results[name])
    out.mkdir(parents=True, exist_ok=True)
    done.to_csv(out / f"{name}.work.csv", index=False)
    pd.concat([table.assign(column=column) for column, table in tables.items()])[
        ["column", "order", "amplitude", "phase_deg", "scatter"]
    ].to_csv(out / f"{name}.orders.csv", index=False)
    say, number = language.current.say, language.current.number
    print(say(f"{name}: {cycles.number} {'cycle' if cycles.number == 1 else 'cycles'}"))
    if len(done):
        print(readable_work(done).map(lambda cell: number(say(str(cell)))).rename(columns=say).to_string(index=False))
    for column, table in tables.items():
        strongest = table[table["order"] > 0].nlargest(4, "amplitude")
        shown = pictures.shown(cycles, column)
        said = "; ".join(f"{row.order:g}: {figure(shown.factor * row.amplitude)}" for row in strongest.itertuples())
        print(f"{say(shown.label)}, {say('strongest orders')}: {number(said)}")
    print(out / f"{name}.work.csv", out / f"{name}.orders.csv")
    save(pictures.draw_means(cycles, columns), options, out, f"{name}.cycles")
    save(pictures.draw_orders(cycles, columns, options.highest), options, out, f"{name}.orders")
    save(pictures.draw_bearings(cycles), options, out, f"{name}.bearings")
    if "cylinder_pressure" in cycles:
        save(pictures.draw_indicator(cycles), options, out, f"{name}.indicator")
    return 0
