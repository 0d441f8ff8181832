#!/usr/bin/env python3
"""Draws the effect of each joint with clearance and of each elastic member in one mechanism: Flores's slider-crank at 3500 rpm, 0.2 mm, dry.

    scripts/plot_members.py                     writes results/members/members.png
    scripts/plot_members.py --out cases/joints  writes the picture that is shipped; with --table also data/measured/members.md

The mechanism of cases/elastic/first_impact.nml runs three revolutions with each joint or member alone, and with all of them
together. Prints impacts, forces and losses of the second and third revolution.
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
from gudgeon_plots.results import MissingResult, load_run  # noqa: E402

CASE = TOP / "cases" / "elastic" / "first_impact.nml"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=TOP / "results" / "members", metavar="DIR", help="(default: results/members)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument("--table", action="store_true", help="also write data/measured/members.md")
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    language.add_option(parser)
    options = parser.parse_args()
    runs = []
    try:
        program = options.program or release_program()
        options.out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="members") as scratch:
            for i, (_, settings) in enumerate(elastic_pictures.MEMBERS):
                out = Path(scratch) / str(i)
                words = [word for setting in (*elastic_pictures.MEMBER_RUN, *settings) for word in ("--set", setting)]
                subprocess.run([program, "-q", "-o", out, *words, CASE], check=True)
                runs.append(load_run(out / f"{CASE.stem}.csv"))
    except (MissingResult, OSError, subprocess.CalledProcessError) as failure:
        print(f"plot_members.py: {failure}", file=sys.stderr)
        return 1
    table = elastic_pictures.describe_members(runs)
    print(table)
    if options.table:
        write_table("members", "Effects of each joint with clearance and of each elastic member", "scripts/plot_members.py --table",
                    f"{elastic_pictures.MEMBERS_SAY}\n\n{table}")
    for path in figures.save(elastic_pictures.draw_members(runs), options.out, "members", options.format or ["png"]):
        print(path)
    language.current.warn("plot_members.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
