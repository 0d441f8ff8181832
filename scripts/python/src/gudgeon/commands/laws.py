"""Draws what the rows of runs say about their laws: normal force over penetration, friction force over sliding speed, film force over
eccentricity ratio. Rows in contact, or in the film, are points.

    gudgeon-plot laws cases/flores/dry_0500um.nml
    gudgeon-plot laws results/hertz.csv results/lankarani.csv -o laws.pdf
"""

import argparse

from gudgeon import language
from gudgeon.commands import add_output, add_results, save
from gudgeon.plots import laws
from gudgeon.results import located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help="case file, trace, or name of a run in results/")
    add_results(parser)
    add_output(parser, "beside the first run")


def run(options: argparse.Namespace) -> int:
    places = [located(word, options.results, not options.no_run) for word in options.runs]
    runs = [results[name] for results, name in places]
    for shown in runs:
        language.current.keep(shown.name)
    save(laws.draw(runs), options, places[0][0].directory, f"{runs[0].name}_laws")
    return 0
