"""Draws parameter studies from their results, NAME.runs.csv and NAME.strobe.csv.

    gudgeon-plot study results/x.runs.csv        any study: curves, maps or points of --columns
    gudgeon-plot study                           the shipped studies, from the results of scripts/run_studies.sh
    gudgeon-plot study --picture map             one of map, bifurcation, restitution, contact_laws
    gudgeon-plot study --numbers                 only print the numbers of the shipped studies, in Markdown

Prints the numbers of the pictures and the paths of the files. Runs that failed are not drawn; their number is printed on standard
error.
"""

import argparse
from pathlib import Path

import f90nml
import numpy as np
import pandas as pd

from gudgeon import language
from gudgeon.commands import Names, Refused, add_output, save
from gudgeon.plots import contact_laws as contact_study
from gudgeon.plots import figures, strobes, studies
from gudgeon.plots.maps import describe_maps, draw_map, draw_maps, is_grid
from gudgeon.plots.restitution import describe_restitution, draw_restitution, measured_restitution
from gudgeon.results import MissingResult, default_folder
from gudgeon.study import Runs, asked_columns, warn_of_failures

COLUMNS = ("min_film_thickness", "contact_time_fraction")

MAPS = ("map_I", "map_I_oscillating", "map_IV", "map_IV_oscillating")

#: Values of the Flores studies that do not vary the key.
FLORES_SPEED = 523.5987755982989  # rad/s
FLORES_CLEARANCE = 100e-6  # m


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="*", type=Path, metavar="NAME.runs.csv", help="results of any study")
    parser.add_argument("--picture", action="append", choices=tuple(PICTURES), help="picture of the shipped studies; repeatable")
    parser.add_argument("--columns", nargs="+", action=Names, metavar="COLUMN",
                        help=f"columns of a given study to draw, without their units (default: those of its statistics, or else {' '.join(COLUMNS)})")
    parser.add_argument("--results", type=Path, metavar="DIR", help="of the shipped studies (default: results/studies)")
    parser.add_argument("--numbers", action="store_true", help="only print the numbers of the shipped studies, in Markdown")
    add_output(parser, several=True)


def read(results: Path, name: str) -> Runs:
    runs = Runs.read(results / f"{name}.runs.csv")
    warn_of_failures(language.current.keep(name), runs)
    return runs


def maps(results: Path) -> tuple[figures.Drawing, list[str]]:
    found = {name: read(results, name) for name in MAPS}
    return draw_maps(found), describe_maps(found)


def bifurcation(results: Path) -> tuple[figures.Drawing, list[str]]:
    kinds = {
        "bifurcation_clearance": ("joint.clearance", 1e6, "µm", None, FLORES_SPEED, "at 5000 rpm"),
        "bifurcation_speed": ("initial.crank_speed", 1.0, "rad/s", FLORES_CLEARANCE, None, "at a clearance c of 100 µm"),
    }
    found, lines = {}, []
    for name, (parameter, unit, label, clearance, speed, held) in kinds.items():
        strobe = strobes.read_strobe(results / f"{name}.strobe.csv", read(results, name))
        strobe = strobes.with_ratios(strobe, clearance, speed)
        found[name] = (strobe, parameter, held)
        lines.append(strobes.describe_bifurcation(strobe, name, parameter, unit, label))
    title = "Dry joint, state at the dead centre: chaos at large clearance and low speed, else the motion repeats"
    return strobes.draw_bifurcation(found, title), lines


def restitution(results: Path) -> tuple[figures.Drawing, list[str]]:
    runs = read(results, "restitution")
    measured = measured_restitution(results / "restitution", runs, settled_from=80 * np.pi)
    drawing = draw_restitution(runs, measured)
    return drawing, [describe_restitution(runs, measured)]


def contact_laws(results: Path) -> tuple[figures.Drawing, list[str]]:
    runs = read(results, "contact_laws")
    return contact_study.draw_contact_laws(runs), [contact_study.describe_contact_laws(runs)]


PICTURES = {"map": maps, "bifurcation": bifurcation, "restitution": restitution, "contact_laws": contact_laws}


def any_study(path: Path, columns: list[str] | None) -> dict[str, figures.Drawing]:
    """Pictures of a study by their names: curves over one parameter, maps over a grid of two, points over each parameter of a
    sample or of a grid of more; also the strobed points, if the study has them. Without `columns` those are drawn for which the study
    asks by `statistics`, or else COLUMNS. A parameter that has one value in all runs is no axis."""
    runs = Runs.read(path)
    warn_of_failures(path.name, runs)
    names = list(runs.table.columns)
    given = names[1 : names.index("status")]
    parameters = [name for name in given if runs.table[name].nunique() > 1] or given[:1]
    columns = columns or [name for name in asked_columns(path) if name in names] or list(COLUMNS)
    if unknown := [column for column in columns if column not in names]:
        raise MissingResult(f"{path}: no column {' '.join(unknown)}; the columns are {' '.join(names)}")
    if words := [column for column in columns if not pd.api.types.is_numeric_dtype(runs.table[column])]:
        raise MissingResult(f"{path}: {' '.join(words)}: contains words, no numbers that can be drawn")
    stem = path.name.removesuffix(".runs.csv")
    study = path.with_name(f"{stem}.study.nml")
    settings = f90nml.read(study)["study"] if study.exists() else {}
    title = language.current.keep(str(settings.get("title") or stem))
    if len(parameters) == 1:
        found = {stem: studies.draw_curves(runs, *parameters, columns, title)}
    elif len(parameters) == 2 and is_grid(runs, *parameters):
        found = {stem: draw_map(runs, *parameters, columns, title)}
    else:
        found = {stem: studies.draw_scatter(runs, parameters, columns, title)}
    points = path.with_name(f"{stem}.strobe.csv")
    if points.exists() and len(parameters) == 1:
        strobe = strobes.read_strobe(points, runs)
        found[f"{stem}.strobe"] = strobes.draw_strobes(strobe, parameters[0], title)
    return found


def run(options: argparse.Namespace) -> int:
    if options.columns and not options.runs:
        raise Refused("--columns is for studies whose NAME.runs.csv is given")
    if options.numbers and options.runs:
        raise Refused("--numbers is for the shipped studies alone")
    results = options.results or default_folder() / "studies"
    for path in options.runs:
        for stem, drawing in any_study(path, options.columns).items():
            save(drawing, options, path.parent, stem)
    for name in options.picture or ([] if options.runs else PICTURES):
        drawing, said = PICTURES[name](results)
        lines = [language.current.say(line) for line in said]
        if options.numbers:
            print(*(f"- {line}".replace("\n  ", "\n    - ") for line in lines), sep="\n")
            continue
        print(*lines, sep="\n")
        save(drawing, options, results, name)
    return 0
