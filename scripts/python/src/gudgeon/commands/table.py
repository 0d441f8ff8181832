"""Prints answers of runs side by side in readable units, with their differences from the first run; or the rows of a study.

    gudgeon-plot table base                                     the answers of one run
    gudgeon-plot table base hot worn                            differences in per cent, of temperatures in K, of angles in degrees
    gudgeon-plot table base hot --rows cycle_imep 'crank_pin_*' -o answers.html
    gudgeon-plot table results/study.runs.csv --rows impacts    a line for each run

Prints Markdown, or CSV or HTML with --format; -o writes a file whose name ends in .md, .csv or .html. Markdown and HTML are in the
language of --language, with its decimal commas; names of rows stay. CSV has decimal points and is in English.
"""

import argparse
from pathlib import Path

import gudgeon
from gudgeon import language
from gudgeon._table import Table
from gudgeon.commands import Names, Refused, add_results, number
from gudgeon.results import MissingResult, file_of

KINDS = {"md": "markdown", "csv": "csv", "html": "html"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help="case file, trace, name of a run in results/; or NAME.runs.csv of a study")
    parser.add_argument("--rows", nargs="+", action=Names, metavar="NAME", help="rows of the summary, columns of a study; also patterns: 'crank_pin_*'")
    parser.add_argument("--digits", type=number(1, whole=True), default=3, metavar="N", help="(default: 3)")
    parser.add_argument("--format", choices=tuple(KINDS), default="md", help="of what is printed (default: md)")
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="write a file instead")
    add_results(parser)


def run(options: argparse.Namespace) -> int:
    of_study = [word.endswith(".runs.csv") for word in options.runs]
    if any(of_study) and len(of_study) > 1:
        raise Refused("the results of a study, NAME.runs.csv, stand alone")
    if not language.current.is_english and (options.out.suffix if options.out else f".{options.format}") == ".csv":
        raise Refused("CSV is read by programs, in English with decimal points: leave --language out; gudgeon-plot export writes decimal commas")
    runs = options.runs if any(of_study) else [file_of(word, "summary", options.results, not options.no_run) for word in options.runs]
    try:
        found = spoken(gudgeon.table(runs, options.rows, digits=options.digits))
        print(found.save(options.out) if options.out else getattr(found, KINDS[options.format])().rstrip("\n"))
    except (KeyError, ValueError) as problem:
        raise MissingResult(problem.args[0]) from problem
    return 0


def spoken(found: Table) -> Table:
    """A table with the words and decimal marks of the language; names of rows, runs and keys stay."""
    if language.current.is_english:
        return found
    words, cells, first = language.current.exact, found.cells.copy(), found.cells.columns[0]
    for name in cells.columns.drop("row", errors="ignore"):   # names of rows may have digits
        cells[name] = [words.get(cell) or language.current.number(cell) for cell in cells[name]]
    return Table(found.data, cells.rename(columns={first: words.get(first, first)}))
