"""Writes the trace and the summary of runs as a spreadsheet reads them: semicolons between columns and decimal commas, or points.

    gudgeon-plot export cases/sim_I.nml --decimal comma               results/sim_I.export.csv, results/sim_I.export.summary.csv
    gudgeon-plot export engine --columns time film_thickness -o tables
"""

import argparse
from pathlib import Path

import pandas as pd

from gudgeon.commands import Names, add_results
from gudgeon.results import MissingResult, located

MARKS = {"comma": (";", ","), "point": (",", ".")}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("--decimal", choices=tuple(MARKS), default="comma", help="mark of decimals; columns are separated by ; or , (default: comma)")
    parser.add_argument("--columns", nargs="+", action=Names, metavar="NAME", help="columns of the trace, without units (default: all)")
    parser.add_argument("-o", "--out", type=Path, metavar="DIR", help="folder for the files (default: beside the data)")
    add_results(parser)


def run(options: argparse.Namespace) -> int:
    for word in options.runs:
        results, name = located(word, options.results, not options.no_run)
        trace = pd.read_csv(results.path(name))
        bare = {column.partition("[")[0]: column for column in trace.columns}
        wanted = options.columns or list(bare)
        if missing := [column for column in wanted if column not in bare]:
            raise MissingResult(f"{results.path(name)}: no column {missing[0]}; it has {', '.join(bare)}")
        summary = pd.read_csv(results.path(name).with_name(f"{name}.summary.csv"), dtype=str, keep_default_na=False)
        if options.decimal == "comma":
            numbers = pd.to_numeric(summary["value"], errors="coerce").notna()
            summary.loc[numbers, "value"] = summary.loc[numbers, "value"].str.replace(".", ",", regex=False)
        folder = options.out or results.directory
        folder.mkdir(parents=True, exist_ok=True)
        for table, suffix in ((trace[[bare[column] for column in wanted]], ".export.csv"), (summary, ".export.summary.csv")):
            separator, mark = MARKS[options.decimal]
            table.to_csv(folder / f"{name}{suffix}", sep=separator, decimal=mark, index=False, encoding="utf-8-sig")   # the mark of UTF-8: Excel
            print(folder / f"{name}{suffix}")
    return 0
