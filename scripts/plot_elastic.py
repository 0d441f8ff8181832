#!/usr/bin/env python3
"""Draws what an elastic connecting rod makes of the first impacts of Flores's slider-crank (cases/elastic/first_impact.nml).

    scripts/plot_elastic.py                      -> results/elastic/first_impact.png
    scripts/plot_elastic.py --out cases/elastic  the picture that is shipped

Runs the case with a rigid rod, one that only bends, two that only stretch or stretch too simply, and the whole, by the release build,
and prints the table of the first contact.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

from gudgeon_plots import elastic_pictures, figures, language  # noqa: E402
from gudgeon_plots.program import release_program  # noqa: E402
from gudgeon_plots.results import MissingResult, load_run  # noqa: E402

CASE = TOP / "cases" / "elastic" / "first_impact.nml"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=TOP / "results" / "elastic", metavar="DIR", help="(default: results/elastic)")
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument("--program", type=Path, help="this program instead of a release build")
    language.add_option(parser)
    options = parser.parse_args()
    runs = []
    try:
        program = options.program or release_program()
        with tempfile.TemporaryDirectory(prefix="elastic") as scratch:
            for i, (*_, settings) in enumerate(elastic_pictures.RODS):
                out = Path(scratch) / str(i)
                words = [word for setting in settings for word in ("--set", setting)]
                subprocess.run([program, "-q", "-o", out, *words, CASE], check=True)
                runs.append(load_run(out / f"{CASE.stem}.csv"))
    except (MissingResult, subprocess.CalledProcessError) as failure:
        print(failure, file=sys.stderr)
        return 1
    print(elastic_pictures.describe_first_impacts(runs))
    for path in figures.save(elastic_pictures.draw_first_impacts(runs), options.out, CASE.stem, options.format or ["png"]):
        print(path)
    language.current.warn("plot_elastic.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
