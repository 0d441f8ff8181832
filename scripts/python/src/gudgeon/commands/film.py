"""Draws results of films: the pressure in the bearing at chosen times, and the six simulations with each film.

    gudgeon-plot film results/engine.film.csv                             the pressures of a run with &output film_times
    gudgeon-plot film cases/film/sim_I_finite.nml --at 0.0942,0.0985      run the case, draw its pressures at these times [s]
    gudgeon-plot film cases/film/engine_pin.nml                           a run with &film_history: its film beside that of the run
    gudgeon-plot film --simulations                                       thickness and force in simulations I to VI, three films

The pressures are computed by the program.
"""

import argparse
import subprocess
from pathlib import Path

from gudgeon.commands import Refused, add_output, add_results, save
from gudgeon.plots import film as pictures
from gudgeon.plots import film_pressure
from gudgeon.program import release_program
from gudgeon.results import MissingResult, Results, default_folder, demand_numbers, file_of, load_run, located, read_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", nargs="?", metavar="RUN", help="case file, a CSV file of a run, or name of a run in results/")
    parser.add_argument("--simulations", action="store_true", help="draw the six simulations with each film")
    parser.add_argument("--at", metavar="TIMES", help="times [s] at which the pressures of the case are drawn: t1,t2,.. or from:to:count")
    parser.add_argument("--set", action="append", default=[], metavar="GROUP.KEY=VALUE", help="change a key of the case; repeatable")
    add_results(parser)
    add_output(parser)


def run(options: argparse.Namespace) -> int:
    if options.simulations == bool(options.source):
        raise Refused("give a run or --simulations")
    if options.simulations:
        results = Results(options.results or default_folder(), run_missing=not options.no_run)
        results.make({f"sim_{number}{ending}" for number in pictures.SIMULATIONS for ending, _, _ in pictures.FILMS})
        save(pictures.simulations(results), options, results.directory, "films")
        return 0
    if not (options.at or options.source.endswith(".film.csv")):
        results, name = located(options.source, options.results, not options.no_run)
        path = results.directory / f"{name}.film_history.csv"
        if path.exists():
            table = read_table(path, "crank_angle", "quick_film_thickness", "min_film_thickness")[0]
            demand_numbers(path, table, list(table.columns))
            has_fields = path.with_name(f"{name}.film.csv").exists()
            if len(table) > 1:
                save(pictures.with_memory(load_run(path.with_name(f"{name}.csv")), table, name), options, path.parent, f"{name}_film_history")
            elif not has_fields:
                raise Refused(f"{path}: a steady state has no picture over the crank angle; &output film_times gives its pressures")
            if not has_fields:
                return 0
    path = pressures_of(options)
    name = path.name.removesuffix(".film.csv")
    fields = film_pressure.fields_of(path)
    if not fields:
        raise MissingResult(f"{path}: contains no pressures")
    save(pictures.pressure_fields(load_run(path.with_name(f"{name}.csv")), fields, name), options, path.parent, f"{name}_pressure")
    return 0


def pressures_of(options: argparse.Namespace) -> Path:
    """The file of the pressures. A case with --at is run first."""
    source = Path(options.source)
    if options.at and source.suffix == ".nml":
        overrides = [part for value in (*options.set, f"output.film_times='{options.at}'") for part in ("-s", value)]
        out = options.results or Path("results")
        outcome = subprocess.run([release_program(), "-q", "-o", out, *overrides, source], capture_output=True, text=True, check=False)
        if outcome.returncode != 0:
            raise MissingResult(outcome.stderr.strip())
        return out / f"{source.stem}.film.csv"
    if options.at or options.set:
        raise Refused("--at and --set are for a case file, which is then run")
    return file_of(source, "film", options.results, not options.no_run)
