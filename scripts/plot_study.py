#!/usr/bin/env python3
"""Draws parameter studies from their results, NAME.runs.csv and NAME.strobe.csv.

    scripts/plot_study.py                        the shipped studies, from the results of scripts/run_studies.sh
    scripts/plot_study.py --picture map          one of map, bifurcation, restitution, contact_laws
    scripts/plot_study.py results/x.runs.csv     any study: curves, maps or points of --columns
    scripts/plot_study.py --numbers              only print the numbers of the shipped studies, in Markdown

Prints the numbers of the pictures and the paths of the files. Runs that failed are not drawn; their number is printed on standard
error.
"""

import argparse
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment(more=("f90nml",))

import f90nml  # noqa: E402
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402

from gudgeon_plots import contact_study, figures, language, study_pictures  # noqa: E402
from gudgeon_plots.results import MissingResult  # noqa: E402
from gudgeon_plots.study import Runs, warn_of_failures  # noqa: E402

COLUMNS = ("min_film_thickness", "contact_time_fraction")

MAPS = ("map_I", "map_I_oscillating", "map_IV", "map_IV_oscillating")

#: Values of the Flores studies that do not vary the key.
FLORES_SPEED = 523.5987755982989  # rad/s
FLORES_CLEARANCE = 100e-6  # m


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="*", type=Path, metavar="NAME.runs.csv", help="results of any study")
    parser.add_argument(
        "--picture", action="append", choices=tuple(PICTURES), help="picture of the shipped studies; repeatable"
    )
    parser.add_argument("--columns", nargs="+", metavar="COLUMN",
                        help=f"columns of a given study to draw, without their units (default: {' '.join(COLUMNS)})")
    parser.add_argument(
        "--results", type=Path, default=TOP / "results" / "studies", metavar="DIR", help="(default: results/studies)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the pictures (default: beside the results)")
    parser.add_argument("--numbers", action="store_true", help="only print the numbers of the shipped studies, in Markdown")
    language.add_option(parser)
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    options = parser.parse_args()
    if options.columns and not options.runs:
        parser.error("--columns is for studies whose NAME.runs.csv is given")
    if options.numbers and options.runs:
        parser.error("--numbers is for the shipped studies alone")
    return options


def read(results: Path, name: str) -> Runs:
    runs = Runs.read(results / f"{name}.runs.csv")
    warn_of_failures(name, runs)
    return runs


def maps(results: Path) -> tuple[figures.Drawing, list[str]]:
    studies = {name: read(results, name) for name in MAPS}
    return study_pictures.draw_maps(studies), study_pictures.describe_maps(studies)


def bifurcation(results: Path) -> tuple[figures.Drawing, list[str]]:
    kinds = {
        "bifurcation_clearance": ("joint.clearance", 1e6, "µm", None, FLORES_SPEED, "524 rad/s"),
        "bifurcation_speed": ("initial.crank_speed", 1.0, "rad/s", FLORES_CLEARANCE, None, "c = 100 µm"),
    }
    strobes, lines = {}, []
    for name, (parameter, unit, label, clearance, speed, held) in kinds.items():
        strobe = study_pictures.read_strobe(results / f"{name}.strobe.csv", read(results, name))
        strobe = study_pictures.with_ratios(strobe, clearance, speed)
        strobes[name] = (strobe, parameter, held)
        lines.append(study_pictures.describe_bifurcation(strobe, name, parameter, unit, label))
    title = "Flores slider-crank, dry: state at the dead centre in 80 revolutions"
    return study_pictures.draw_bifurcation(strobes, title), lines


def restitution(results: Path) -> tuple[figures.Drawing, list[str]]:
    runs = read(results, "restitution")
    measured = study_pictures.measured_restitution(results / "restitution", runs, settled_from=80 * np.pi)
    drawing = study_pictures.draw_restitution(runs, measured)
    return drawing, [study_pictures.describe_restitution(runs, measured)]


def contact_laws(results: Path) -> tuple[figures.Drawing, list[str]]:
    runs = read(results, "contact_laws")
    return contact_study.draw_contact_laws(runs), [contact_study.describe_contact_laws(runs)]


PICTURES = {"map": maps, "bifurcation": bifurcation, "restitution": restitution, "contact_laws": contact_laws}


def any_study(path: Path, columns: list[str]) -> dict[str, figures.Drawing]:
    """Pictures of a study by their names: curves over one parameter, maps over a grid of two, points over each parameter of a
    sample or of a grid of more; also the strobed points, if the study has them."""
    runs = Runs.read(path)
    warn_of_failures(path.name, runs)
    names = list(runs.table.columns)
    parameters = names[1 : names.index("status")]
    if unknown := [column for column in columns if column not in names]:
        raise MissingResult(f"{path}: no column {' '.join(unknown)}; the columns are {' '.join(names)}")
    if words := [column for column in columns if not pd.api.types.is_numeric_dtype(runs.table[column])]:
        raise MissingResult(f"{path}: {' '.join(words)}: contains words, no numbers that can be drawn")
    stem = path.name.removesuffix(".runs.csv")
    study = path.with_name(f"{stem}.study.nml")
    settings = f90nml.read(study)["study"] if study.exists() else {}
    title = language.current.keep(str(settings.get("title") or stem))
    if len(parameters) == 1:
        found = {stem: study_pictures.draw_curves(runs, *parameters, columns, title)}
    elif len(parameters) == 2 and study_pictures.is_grid(runs, *parameters):
        found = {stem: study_pictures.draw_map(runs, *parameters, columns, title)}
    else:
        found = {stem: study_pictures.draw_scatter(runs, parameters, columns, title)}
    strobes = path.with_name(f"{stem}.strobe.csv")
    if strobes.exists() and len(parameters) == 1:
        strobe = study_pictures.read_strobe(strobes, runs)
        found[f"{stem}.strobe"] = study_pictures.draw_strobes(strobe, parameters[0], title)
    return found


def main() -> int:
    options = arguments()
    formats = options.format or ["png"]
    try:
        for path in options.runs:
            for stem, drawing in any_study(path, options.columns or list(COLUMNS)).items():
                print(*figures.save(drawing, options.out or path.parent, stem, formats))
        for name in options.picture or ([] if options.runs else PICTURES):
            drawing, lines = PICTURES[name](options.results)
            if options.numbers:
                print(*(f"- {line}".replace("\n  ", "\n    - ") for line in lines), sep="\n")
                continue
            print(*lines, sep="\n")
            print(*figures.save(drawing, options.out or options.results, name, formats))
    except (MissingResult, OSError) as problem:
        print(f"plot_study.py: {problem}", file=sys.stderr)
        return 1
    language.current.warn("plot_study.py")
    return 0


if __name__ == "__main__":
    sys.exit(main())
