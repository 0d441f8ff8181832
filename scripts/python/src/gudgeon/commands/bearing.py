"""Draws the orbit of a pin in its clearance circle over the last cycle of a run, in fixed axes and in those of the load; of an engine
with numbered bearings all of them along the shaft, and their losses.

    gudgeon-plot bearing cases/bearings/big_end.nml    its results, or the case is run
    gudgeon-plot bearing engine --place main_bearing   of results/engine.csv: results/engine_main_bearing_orbit.png
    gudgeon-plot bearing cases/cylinders/inline_four_bearings.nml    all bearings of an engine
    gudgeon-plot bearing --shipped -o cases/bearings   the picture that is shipped

The thinnest film and, of one bearing, every 90 degrees of the crank are marked. The load, the force of the pin on its bearing, is a light area with a bar for its
size; the film over the crank angle stands beside it.
"""

import argparse

from gudgeon.commands import Refused, add_output, add_results, save
from gudgeon.plots import bearing as pictures
from gudgeon.results import located, shipped_case

SHIPPED = "big_end"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", nargs="?", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--place", choices=tuple(pictures.PLACES), help="which bearing (default: the first that has a film)")
    parser.add_argument("--shipped", action="store_true", help="draw the shipped case")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    if options.shipped == bool(options.source):
        raise Refused("give a run, or --shipped")
    results, name = located(options.source or shipped_case(SHIPPED), options.results, not options.no_run)
    one = results[name]
    if not options.place and any(pictures.numbered(one).values()):
        save(pictures.engine(one, name), options, results.path(name).parent, name)
        return 0
    place = options.place or next((place for place in pictures.PLACES if pictures.has_film(one, place)), "")
    if not place or not pictures.has_film(one, place):
        raise Refused(f"{name}: no film with columns film_force and eccentricity{f' at {place}' if place else ''}")
    stem = name if options.shipped else f"{name}_{options.place}_orbit" if options.place else f"{name}_orbit"
    save(pictures.orbit(one, place, name), options, results.path(name).parent, stem)
    return 0
