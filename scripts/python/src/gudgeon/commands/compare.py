"""Compares two runs: one picture with their difference, and how long they agree.

    gudgeon-plot compare A.csv B.csv
    gudgeon-plot compare cases/sim_I.nml cases/sim_I_oscillating.nml --columns film_thickness --agreement 0.05
"""

import argparse

from gudgeon import language
from gudgeon.commands import Names, add_output, add_results, number, save
from gudgeon.plots import compare
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs=2, metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--columns", nargs="+", action=Names, metavar="NAME", help="columns to compare, without units (default: speeds and film thickness)")
    parser.add_argument("--agreement", type=number(0, itself=False), metavar="SHARE", default=compare.AGREEMENT,
                        help="runs agree as long as they differ by less than this share of the range (default: %(default)g)")
    add_results(parser)
    add_output(parser, "beside the first run")


def run(options: argparse.Namespace) -> int:
    places = [located(word, options.results, not options.no_run) for word in options.runs]
    a, b = (results[name] for results, name in places)
    found = compare.agree(a, b, options.columns or compare.shared_columns(a, b), options.agreement)
    print(compare.report(found, options.agreement))
    names = compare.different_names(*(results.path(name) for results, name in places))
    for name in names:
        language.current.keep(name)
    save(compare.draw(a, b, names, found, options.agreement), options, places[0][0].directory, f"compare_{a.name}_{b.name}")
    return 0
