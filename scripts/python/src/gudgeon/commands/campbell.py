"""Draws critical speeds of a crankshaft with several cylinders: natural frequencies against the orders of the excitation, and shapes.

    gudgeon-plot campbell cases/cylinders/six_mwm.nml    the results of the case, which is run if they are missing
    gudgeon-plot campbell diesel --highest 9 --speed 3000

At the speed 60 f/h the order h excites the natural frequency f. How strongly depends on the vector sum of the shape's amplitudes at
the cylinders, each turned by h times the crank angle between it and the full cylinder: all cylinders excite a mode together, or
cancel each other. Writes NAME.campbell.png and

    NAME.campbell.csv    mode, order, critical speed [rpm], vector sum (the largest amplitude of a shape is 1)
"""

import argparse

from gudgeon import language
from gudgeon.commands import Refused, add_output, add_results, number, save
from gudgeon.plots import campbell
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--highest", type=number(0, itself=False), default=12.0, metavar="ORDER", help="highest order (default: 12)")
    parser.add_argument("--speed", type=number(0, itself=False), metavar="RPM", help="largest speed in the picture (default: twice that of the case)")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    results, name = located(options.case, options.results, not options.no_run)
    found = results[name]
    if "natural_frequency_1" not in found.summary:
        raise Refused(f"{name}: the run has no natural frequencies: give lists of stations in &crankshaft")
    language.current.keep(name)
    shaft = campbell.Shaft.of(found)
    out = options.out if options.out and not options.out.suffix else results.directory
    out.mkdir(parents=True, exist_ok=True)
    table = shaft.critical_speeds(options.highest)
    table.to_csv(out / f"{name}.campbell.csv", index=False)
    print(out / f"{name}.campbell.csv")
    save(campbell.draw(name, shaft, table, options.highest, options.speed), options, results.directory, f"{name}.campbell")
    return 0
