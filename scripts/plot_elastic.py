#!/usr/bin/env python3
"""Draws the effect of an elastic connecting rod on the first impacts of Flores's slider-crank (cases/elastic/first_impact.nml).

    scripts/plot_elastic.py                      writes results/elastic/first_impact.png
    scripts/plot_elastic.py --out cases/elastic  writes the picture that is shipped; with --table also data/measured/first_impact.md

The case is run by the release build with a rigid rod, with a rod that only bends, with two that only stretch (one of them with too
few axial shapes), and with the full model of the rod. Prints a table of the first contact.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

from gudgeon_plots import elastic_pictures, figures, language  # noqa: E402
from gudgeon_plots.measured import write_table  # noqa: E402
from gudgeon_plots.program import release_program  # noqa: E402
from gudgeon_plots.results import MissingResult, Run, load_run  # noqa: E402

CASE = TOP / "cases" / "elastic" / "first_impact.nml"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=TOP / "results" / "elastic", metavar="DIR", help="(default: results/elastic)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument("--table", action="store_true", help="also write data/measured/first_impact.md")
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    language.add_option(parser)
    options = parser.parse_args()
    runs, shapes = [], []
    try:
        program = options.program or release_program()
        options.out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="elastic") as scratch:
            def run(*settings: str) -> Run:
                out = Path(scratch) / "_".join(("run", *settings))
                subprocess.run([program, "-q", "-o", out, *(word for setting in settings for word in ("--set", setting)), CASE], check=True)
                return load_run(out / f"{CASE.stem}.csv")

            runs = [run(*settings) for *_, settings in elastic_pictures.RODS]
            if options.table:
                shapes = [run(f"elastic_rod.axial_shapes={number}") for number in elastic_pictures.AXIAL_SHAPES]
    except (MissingResult, OSError, subprocess.CalledProcessError) as failure:
        print(f"plot_elastic.py: {failure}", file=sys.stderr)
        return 1
    table = elastic_pictures.describe_first_impacts(runs)
    print(table)
    if options.table:
        print(write_table("first_impact", "What an elastic rod makes of the first impact", "scripts/plot_elastic.py --table", "\n\n".join(
            (elastic_pictures.FIRST_IMPACT_SAYS, table, elastic_pictures.AXIAL_SHAPES_SAY, elastic_pictures.describe_axial_shapes(shapes)))))
    for path in figures.save(elastic_pictures.draw_first_impacts(runs), options.out, CASE.stem, options.format or ["png"]):
        print(path)
    language.current.warn("plot_elastic.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
