#!/usr/bin/env python3
"""Draws results of films: the pressure in the bearing at chosen times, and the six simulations with each film.

    scripts/plot_film.py cases/film/sim_I_finite.nml --at 0.0942,0.0985   run the case, draw its pressures at these times [s]
    scripts/plot_film.py RESULTS/sim_I_finite.film.csv                    draw the pressures of a run with &output film_times
    scripts/plot_film.py --simulations                                    thickness and force in simulations I to VI, three films

The pressures are computed by the release build of the program.
"""

import argparse
import subprocess
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

from gudgeon_plots import figures, film_pictures, film_pressure, language  # noqa: E402
from gudgeon_plots.program import release_program  # noqa: E402
from gudgeon_plots.results import MissingResult, Results, load_run  # noqa: E402


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("source", nargs="?", type=Path, metavar="CASE.nml|NAME.film.csv")
    what.add_argument("--simulations", action="store_true", help="draw the six simulations with each film")
    parser.add_argument("--at", metavar="TIMES", help="times [s] at which the pressures of the case are drawn: t1,t2,.. or "
                                                      "from:to:count")
    parser.add_argument("--set", action="append", default=[], metavar="GROUP.KEY=VALUE",
                        help="change a key of the case; repeatable")
    parser.add_argument("--results", type=Path, default=TOP / "results", metavar="DIR",
                        help="folder of the traces (default: results)")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="folder for the pictures (default: figures in the folder of the traces)")
    language.add_option(parser)
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    parser.add_argument("--no-run", action="store_true", help="do not run cases; print the command where a result is missing")
    options = parser.parse_args()
    if options.source and options.source.suffix == ".nml" and not options.at:
        parser.error("a case needs --at")
    if not (options.source and options.source.suffix == ".nml") and (options.at or options.set):
        parser.error("--at and --set are for a case, which is then run")
    return options


def fields_file(options: argparse.Namespace) -> Path:
    """The file of the pressures; if a case is given, it is run first."""
    if options.source.suffix != ".nml":
        return options.source
    overrides = [part for value in (*options.set, f"output.film_times='{options.at}'") for part in ("-s", value)]
    command = [release_program(), "-q", "-o", options.results, *overrides, options.source]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(outcome.stderr.strip())
    return options.results / f"{options.source.stem}.film.csv"


def main() -> int:
    options = arguments()
    folder = options.source.parent if options.source and options.source.suffix != ".nml" else options.results
    out = options.out or folder / "figures"
    formats = options.format or ["png"]
    try:
        if options.simulations:
            results = Results(options.results, run_missing=not options.no_run)
            results.make({f"sim_{number}{ending}" for number in film_pictures.SIMULATIONS for ending, _, _ in film_pictures.FILMS})
            print(*figures.save(film_pictures.simulations(results), out, "films", formats))
            language.current.warn("plot_film.py")
            return 0
        path = fields_file(options)
        name = path.name.removesuffix(".film.csv")
        fields = film_pressure.fields_of(path)
        if not fields:
            raise MissingResult(f"{path}: contains no pressures")
        drawing = film_pictures.pressure_fields(load_run(path.with_name(f"{name}.csv")), fields, name)
        print(*figures.save(drawing, out, f"{name}_pressure", formats))
        language.current.warn("plot_film.py")
    except (MissingResult, OSError) as problem:
        print(f"plot_film.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
