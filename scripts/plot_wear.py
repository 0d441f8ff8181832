#!/usr/bin/env python3
"""Draws the worn surfaces of pins and bores, from NAME.wear.csv of runs with the group &wear.

    scripts/plot_wear.py results/flores.wear.csv       writes results/figures/flores_wear.png
    scripts/plot_wear.py cases/wear/flores.nml         run the case with the release build of the program and draw its wear
    scripts/plot_wear.py --shipped --out cases/wear    the picture that is shipped, of both cases in cases/wear

Several files make one picture. Angles are those of each body, from x towards y at its assembly: the bore does not turn, the pin
turns with its rod. In the round pictures the deepest wear is a third of the radius.
"""

import argparse
import subprocess
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

from gudgeon_plots import figures, language, wear_pictures  # noqa: E402
from gudgeon_plots.program import release_program  # noqa: E402
from gudgeon_plots.results import MissingResult  # noqa: E402

#: Shipped cases and their titles.
SHIPPED = {
    "flores": "Flores, 0.5 mm, 5000 rpm, friction 0.05: 2 revolutions",
    "worn_bore": "Soft liner, 0.1 mm, 100 rad/s: 8000 revolutions",
}


def wear_file(source: Path, results: Path) -> Path:
    """The file of the worn surfaces; if a case is given, it is run first."""
    if source.suffix != ".nml":
        return source
    outcome = subprocess.run([release_program(), "-q", "-o", results, source], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(outcome.stderr.strip())
    path = results / f"{source.stem}.wear.csv"
    if not path.exists():
        raise MissingResult(f"{source}: counts no wear; it needs the group &wear")
    return path


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="*", type=Path, metavar="CASE.nml|NAME.wear.csv")
    parser.add_argument("--shipped", action="store_true", help="draw the shipped cases")
    parser.add_argument("--results", type=Path, default=TOP / "results", metavar="DIR", help="folder of the results (default: results)")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="folder for the pictures (default: figures in the folder of the results)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    language.add_option(parser)
    options = parser.parse_args()
    if options.shipped == bool(options.sources):
        parser.error("give cases or files of worn surfaces, or --shipped")
    sources = [TOP / "cases" / "wear" / f"{name}.nml" for name in SHIPPED] if options.shipped else options.sources
    worn, titles = [], []
    try:
        for source in sources:
            path = wear_file(source, options.results)
            name = path.name.removesuffix(".wear.csv")
            found = wear_pictures.surfaces_of(path)
            if not found:
                raise MissingResult(f"{path}: nothing has worn")
            worn += found
            titles += [SHIPPED[name] if options.shipped else f"{language.current.keep(name)}: {wear_pictures.JOINTS[joint]}"
                       for joint, _ in found]
        stem = "wear" if options.shipped else f"{name}_wear"
        print(*figures.save(wear_pictures.draw(worn, titles), options.out or options.results / "figures", stem, options.format or ["png"]))
        language.current.warn("plot_wear.py")
    except (MissingResult, OSError) as problem:
        print(f"plot_wear.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
