"""Draws the figures of the dissertation.

    gudgeon-plot figure --all                       every figure, as PNG, in results/figures
    gudgeon-plot figure 6.7 6.8 --format pdf        these
    gudgeon-plot figure B.7 --window start          appendix B from the pin's release on, as figure_B.07_start
    gudgeon-plot figure --list                      list the figures

Cases whose results are missing are run.
"""

import argparse
import sys
import time

from gudgeon import language
from gudgeon.commands import Refused, add_output, add_results, save
from gudgeon.plots import figures
from gudgeon.plots.figure_map import Figure, read_figures
from gudgeon.plots.quantities import QUANTITIES
from gudgeon.results import (
    FineResults,
    ManyCycles,
    MissingResult,
    Results,
    WindowResults,
    default_folder,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("numbers", nargs="*", metavar="NUMBER", help="figures of the dissertation")
    parser.add_argument("--all", action="store_true", help="draw every figure")
    parser.add_argument("--list", action="store_true", help="list the figures")
    parser.add_argument("--window", choices=("settled", "start"), default="settled",
                        help="appendix B: the settled motion, or the cases' own first revolutions, in which the pin drops from the centre "
                        "(default: settled)")
    parser.add_argument("--rerun", action="store_true", help="run the cases even if there are results")
    add_results(parser)
    add_output(parser, "figures in the folder of the results", several=True)


def run(options: argparse.Namespace) -> int:
    table = read_figures()
    if options.list:
        for figure in table.values():
            window = f", revolutions {figure.window[0]} to {figure.window[1]}" if figure.window else ""
            print(f"{figure.number:5} {language.current.say(f'{figure.title}{window}')}  ({' '.join(figure.runs)})")
        return 0
    if bool(options.numbers) == options.all:
        raise Refused("give the numbers of figures, --all or --list")
    if unknown := [number for number in options.numbers if number not in table]:
        raise Refused(f"no such figure: {' '.join(unknown)}; --list prints the figures")
    started = time.monotonic()
    results = Results(options.results or default_folder(), run_missing=not options.no_run, rerun=options.rerun)
    wanted = [table[number] for number in options.numbers or table]
    if options.window == "start":
        wanted = [figure.at_start for figure in wanted]
    failed = draw_figures(wanted, results, options)
    print(language.current.say(f"{len(wanted) - failed} of {len(wanted)} figures in {time.monotonic() - started:.0f} s"))
    return 1 if failed else 0


def draw_figures(wanted: list[Figure], own: Results, options: argparse.Namespace) -> int:
    """Draw the figures; returns the number of those that could not be drawn."""
    fine, cycles = FineResults(own), ManyCycles(own)
    windows = {figure.window: WindowResults(own, figure.window) for figure in wanted if figure.window}

    def source(figure: Figure) -> Results:
        is_fine = any(QUANTITIES[name].fine for name in figure.quantities)
        return windows[figure.window] if figure.window else fine if is_fine else own

    for results in (own, fine, *windows.values()):
        results.make({name for figure in wanted if source(figure) is results for name in figure.needs})
    cycles.make({name for figure in wanted if figure.shows_many_cycles for name in figure.needs})
    failed = 0
    for figure in wanted:
        try:
            save(figures.draw(figure, source(figure), cycles), options, own.directory / "figures", figure.stem)
        except MissingResult as problem:
            print(f"gudgeon-plot figure: {figure.number}: {problem}", file=sys.stderr)
            failed += 1
    return failed
