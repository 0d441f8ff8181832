"""Draws the worn surfaces of pins and bores of runs with the group &wear.

    gudgeon-plot wear cases/wear/flores.nml            its results, or the case is run
    gudgeon-plot wear a.wear.csv b.wear.csv -o both.png
    gudgeon-plot wear --shipped -o cases/wear          the picture that is shipped, of both cases in cases/wear

Several runs make one picture. Angles are those of each body, from x towards y at its assembly: the bore does not turn, the pin
turns with its rod. In the round pictures the deepest wear is a third of the radius.
"""

import argparse

from gudgeon import language
from gudgeon.commands import Refused, add_output, add_results, save
from gudgeon.names import PLACES
from gudgeon.plots import wear as pictures
from gudgeon.results import MissingResult, file_of, shipped_case

#: Shipped cases and their titles.
SHIPPED = {
    "flores": "Flores, 0.5 mm, 5000 rpm, friction 0.05: 2 revolutions",
    "worn_bore": "Soft liner, 0.1 mm, 100 rad/s: 8000 revolutions",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="*", metavar="RUN", help="case file, NAME.wear.csv, or name of a run in results/")
    parser.add_argument("--shipped", action="store_true", help="draw the shipped cases")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    if options.shipped == bool(options.runs):
        raise Refused("give runs, or --shipped")
    worn, titles = [], []
    for word in options.runs or [shipped_case(name) for name in SHIPPED]:
        path = file_of(word, "wear", options.results, not options.no_run)
        name = path.name.removesuffix(".wear.csv")
        found = pictures.surfaces_of(path)
        if not found:
            raise MissingResult(f"{path}: nothing has worn")
        worn += found
        titles += [SHIPPED[name] if options.shipped else f"{language.current.keep(name)}: {PLACES[joint][1]}" for joint, _ in found]
    save(pictures.draw(worn, titles), options, path.parent, "wear" if options.shipped else f"{name}_wear")
    return 0
