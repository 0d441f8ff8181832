#!/usr/bin/env python3
"""Draws the figures of the dissertation, and compares runs.

    scripts/plot.py --all                       every figure, as PNG, in results/figures
    scripts/plot.py --figure 6.7 --format pdf   one figure; both options can be repeated
    scripts/plot.py --figure B.7 --window start appendix B from the pin's release on, as figure_B.07_start
    scripts/plot.py --list                      list the figures
    scripts/plot.py --compare A.csv B.csv       two traces in one picture, their difference, and how long they agree
    scripts/plot.py --readme                    the picture of README.md, data/readme.png

Cases whose results are missing are run with the release build.
"""

import argparse
import signal
import sys
import time
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

from gudgeon_plots import compare, figures, language, readme_picture  # noqa: E402
from gudgeon_plots.figure_map import Figure, read_figures  # noqa: E402
from gudgeon_plots.limits import number  # noqa: E402
from gudgeon_plots.quantities import QUANTITIES  # noqa: E402
from gudgeon_plots.results import FineResults, ManyCycles, MissingResult, Results, WindowResults  # noqa: E402


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--figure", action="append", metavar="NUMBER", help="draw this figure; repeatable")
    what.add_argument("--all", action="store_true", help="draw every figure")
    what.add_argument("--list", action="store_true", help="list the figures")
    what.add_argument("--compare", nargs=2, type=Path, metavar=("A.csv", "B.csv"), help="compare two traces")
    what.add_argument("--readme", action="store_true", help="draw README.md's picture")
    parser.add_argument(
        "--results", type=Path, default=TOP / "results", metavar="DIR", help="folder of the traces (default: results)"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="folder for the pictures (default: figures in the folder of the traces)"
    )
    language.add_option(parser)
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument(
        "--window",
        choices=("settled", "start"),
        default="settled",
        help="appendix B: the settled motion, or the cases' own first revolutions, in which the pin drops from the centre "
        "(default: settled)",
    )
    parser.add_argument("--no-run", action="store_true", help="do not run cases; print the command where a result is missing")
    parser.add_argument("--rerun", action="store_true", help="run the cases even if there are results")
    parser.add_argument("--columns", nargs="+", metavar="NAME", help="columns to compare, without units")
    parser.add_argument(
        "--agreement",
        type=number(0, itself=False),
        metavar="SHARE",
        help=f"two runs agree as long as they differ by less than this share of the range (default: {compare.AGREEMENT:g})",
    )
    options = parser.parse_args()
    if not options.compare and (options.columns or options.agreement):
        parser.error("--columns and --agreement are for --compare")
    return options


def draw_figures(wanted: list[Figure], own: Results, out: Path, formats: list[str]) -> int:
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
            drawing = figures.draw(figure, source(figure), cycles)
            print(*figures.save(drawing, out, figure.stem, formats))
        except MissingResult as problem:
            print(f"plot.py: figure {figure.number}: {problem}", file=sys.stderr)
            failed += 1
    return failed


def main() -> int:
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # --list | head
    options = arguments()
    formats = options.format or ["png"]
    out = options.out or options.results / "figures"
    table = read_figures()
    if options.list:
        for figure in table.values():
            window = f", revolutions {figure.window[0]} to {figure.window[1]}" if figure.window else ""
            print(f"{figure.number:5} {figure.title}{window}  ({' '.join(figure.runs)})")
        return 0
    try:
        if options.compare:
            return compare.compare_files(*options.compare, options.columns, options.agreement or compare.AGREEMENT, out, formats)
        results = Results(options.results, run_missing=not options.no_run, rerun=options.rerun)
        if options.readme:
            print(*readme_picture.write(results, TOP / "data" / "readme.png"))
            return 0
        unknown = [number for number in options.figure or [] if number not in table]
        if unknown:
            print(f"plot.py: no such figure: {' '.join(unknown)}; --list prints the figures", file=sys.stderr)
            return 2
        started = time.monotonic()
        wanted = [table[number] for number in options.figure or table]
        if options.window == "start":
            wanted = [figure.at_start for figure in wanted]
        failed = draw_figures(wanted, results, out, formats)
        language.current.warn("plot.py")
        print(f"{len(wanted) - failed} of {len(wanted)} figures in {time.monotonic() - started:.0f} s, in {out}")
        return 1 if failed else 0
    except (MissingResult, OSError) as problem:
        print(f"plot.py: {problem}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
