"""Draws the indicator diagram of a run: pressure over volume, single cycles light and their mean dark.

    gudgeon-plot indicator cases/gas/compressor_valves.nml    the results of the case, which is run if they are missing
    gudgeon-plot indicator engine --settle 20

Of a compressor whose valves have losses these are shaded, and the diagram of ideal valves is dashed. Of a four-stroke engine the heat that
the mean pressure shows stands beside it, with the angles of 10, 50 and 90 % of it. The cycles are those of gudgeon-plot orders. Writes
NAME.indicator.png.
"""

import argparse

from gudgeon import language
from gudgeon.commands import Refused, add_output, add_results, number, save
from gudgeon.cycles import whole_cycles
from gudgeon.plots.cycles import draw_indicator
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--settle", type=number(0), metavar="REVOLUTIONS",
                        help="revolutions that are left out at the start (default: half of the run)")
    parser.add_argument("--cycles", type=number(1, whole=True), metavar="N", help="draw only the last N cycles")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    results, name = located(options.case, options.results, not options.no_run)
    cycles = whole_cycles(results[name], options.settle, options.cycles)
    if "cylinder_pressure" not in cycles:
        raise Refused(f"{name}: the run has no gas")
    language.current.keep(name)
    save(draw_indicator(cycles), options, results.directory, f"{name}.indicator")
    return 0
