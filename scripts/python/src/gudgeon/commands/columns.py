"""Draws columns of one or several runs over the crank angle or the time.

    gudgeon-plot columns cases/sim_V.nml                           those that most readers want
    gudgeon-plot columns cases/sim_V.nml cases/sim_V_oscillating.nml --columns pin_force film_thickness --cycle -1
    gudgeon-plot columns engine.csv --columns all --over time -o engine.pdf

A vector's name, such as pin_force, stands for the magnitude of pin_force_x and pin_force_y.
"""

import argparse

from gudgeon import language
from gudgeon.commands import Names, add_output, add_results, save
from gudgeon.plots import columns
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--columns", nargs="+", action=Names, metavar="NAME", help="columns without units, or all")
    parser.add_argument("--over", choices=("crank_angle", "time"), default="crank_angle", help="(default: crank_angle)")
    parser.add_argument("--cycle", type=int, metavar="N", help="only this cycle, counted from 0; -1 is the last whole one")
    add_results(parser)
    add_output(parser, "beside the first run")


def run(options: argparse.Namespace) -> int:
    places = [located(word, options.results, not options.no_run) for word in options.runs]
    runs = [results[name] for results, name in places]
    for shown in runs:
        language.current.keep(shown.name)
    wanted = options.columns or columns.available(runs[0])
    if wanted == ["all"]:
        wanted = [name for name in runs[0].trace.columns if name not in ("time", "crank_angle")]
    for name in wanted:   # columns without a translation keep their names
        language.current.keep(name.replace("_", " "))
    drawing = columns.draw(runs, wanted, options.over, options.cycle)
    save(drawing, options, places[0][0].directory, f"{runs[0].name}_columns")
    return 0
