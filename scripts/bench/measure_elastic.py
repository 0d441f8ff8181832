#!/usr/bin/env python3
"""Measures the effects of elastic members and of joints with clearance in Flores's slider-crank (cases/elastic/first_impact.nml).

    scripts/bench/measure_elastic.py first_impact    the first impacts with a rigid rod, with a rod that only bends, with two that only
                                                     stretch (one of them with too few axial shapes), and with the full model
    scripts/bench/measure_elastic.py members         three revolutions with each joint or member alone, and with all of them together

Prints a table and draws a picture, into results/elastic or --out. With --write the table goes to data/measured and the picture to
cases/, which are shipped.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import measured
from measured import TOP, built_program, use_virtual_environment, write_table

use_virtual_environment()

import elastic_pictures
from gudgeon import language
from gudgeon.plots import style
from gudgeon.results import Run, load_run

CASE = TOP / "cases" / "elastic" / "first_impact.nml"
#: Title of the table and folder of the picture of each measurement.
WHAT = {
    "first_impact": ("What an elastic rod makes of the first impact", TOP / "cases" / "elastic"),
    "members": ("Effects of each joint with clearance and of each elastic member", TOP / "cases" / "joints"),
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=WHAT)
    parser.add_argument("--out", type=Path, default=TOP / "results" / "elastic", metavar="DIR", help="(default: results/elastic)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument("--write", action="store_true", help="write the shipped table and picture")
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    language.add_option(parser)
    options = parser.parse_args()
    title, shipped = WHAT[options.what]
    program = options.program or built_program()

    def run(*settings: str) -> Run:
        out = Path(scratch) / str(len(list(Path(scratch).iterdir())))
        measured.run(program, CASE, out, settings)
        return load_run(out / f"{CASE.stem}.csv")

    try:
        with tempfile.TemporaryDirectory(prefix="elastic") as scratch:
            if options.what == "members":
                runs = [run(*elastic_pictures.MEMBER_RUN, *settings) for _, settings in elastic_pictures.MEMBERS]
                drawing, table = elastic_pictures.draw_members(runs), elastic_pictures.describe_members(runs)
                text = f"{elastic_pictures.MEMBERS_SAY}\n\n{table}"
            else:
                runs = [run(*settings) for *_, settings in elastic_pictures.RODS]
                shapes = [run(f"elastic_rod.axial_shapes={number}") for number in elastic_pictures.AXIAL_SHAPES]
                drawing, table = elastic_pictures.draw_first_impacts(runs), elastic_pictures.describe_first_impacts(runs)
                text = "\n\n".join((elastic_pictures.FIRST_IMPACT_SAYS, table, elastic_pictures.AXIAL_SHAPES_SAY,
                                    elastic_pictures.describe_axial_shapes(shapes)))
        print(text)
        if options.write:
            print(write_table(options.what, title, f"scripts/bench/measure_elastic.py {options.what} --write", text))
        stem = options.what if language.current.is_english else f"{options.what}_pt"
        print(*(style.keep(drawing, shipped / f"{stem}.png") if options.write else style.save(drawing, options.out, stem, options.format or style.KEPT[:1])))
    except OSError as failure:
        print(f"measure_elastic.py: {failure}", file=sys.stderr)
        return 1
    language.current.warn("measure_elastic.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
