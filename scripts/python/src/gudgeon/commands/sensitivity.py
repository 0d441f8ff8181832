"""Measures how the results of a study depend on its parameters: samples their ranges, runs the study, and analyses it with SALib.

    gudgeon-plot sensitivity cases/studies/sensitivity_I.nml        both methods; table and picture in results/sensitivity
    gudgeon-plot sensitivity STUDY.nml --method morris --morris 20 --outputs log:min_film_thickness impacts
    gudgeon-plot sensitivity --table cases/studies/sensitivity_*.nml  only print a table of the Sobol indices of earlier calls

The study's &parameter groups give the ranges (from, to, scale), which are sampled by the methods of Morris (elementary
effects along trajectories) and Sobol (shares of the variance, by Saltelli's scheme). Samples are reproducible (--seed).
Failed runs are counted and listed; the trajectory or base point that contains a failed run is left out. If an analysis is
interrupted, the same command continues it. Confidence intervals are 95 % intervals; --convergence also prints the indices from a
quarter and a half of the sample.
"""

import argparse
from pathlib import Path

import pandas as pd

from gudgeon import language, sensitivity, study
from gudgeon.commands import Refused, add_output, save
from gudgeon.program import release_program
from gudgeon.results import MissingResult, default_folder
from gudgeon.sensitivity import METHODS, Indices, Output

OUTPUTS = ("min_film_thickness", "contact_time_fraction")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("studies", nargs="+", type=Path, metavar="STUDY.nml")
    parser.add_argument("--method", action="append", choices=METHODS, help="method of analysis; repeatable (default: both)")
    parser.add_argument(
        "--outputs",
        nargs="+",
        type=Output.parse,
        default=[Output(name) for name in OUTPUTS],
        metavar="COLUMN",
        help=f"columns to analyse, without their units; log:COLUMN for the logarithm (default: {' '.join(OUTPUTS)})",
    )
    parser.add_argument("--morris", type=int, default=50, metavar="N",
                        help="number of trajectories of Morris's method (default: 50)")
    parser.add_argument("--sobol", type=int, default=256, metavar="N",
                        help="number of base points of Sobol's method, a power of 2 (default: 256)")
    parser.add_argument("--seed", type=int, default=1, metavar="N",
                        help="seed of the samples and of the confidence intervals (default: 1)")
    add_output(parser, "results/sensitivity, with the runs and the table", several=True)
    parser.add_argument("-j", "--jobs", type=int, metavar="N", help="number of processes (default: number of processors)")
    parser.add_argument("-s", "--set", action="append", default=[], metavar="GROUP.KEY=VALUE", help="change a key of the base case")
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    parser.add_argument("--fresh", action="store_true", help="discard the runs of an earlier call")
    parser.add_argument("--convergence", action="store_true", help="also print the indices from parts of the sample")
    parser.add_argument("--table", action="store_true",
                        help="only print the indices found in the folder --out, as a Markdown table")


def examine(path: Path, method: str, program: Path, options: argparse.Namespace) -> tuple[list[Indices], list[Indices]]:
    """Sample, run and analyse one study by one method: indices of each output, and those from parts of the sample."""
    given = study.read_study(path)
    points = options.morris if method == "morris" else options.sobol
    sampled = sensitivity.sample(method, given.parameters, points, options.seed)
    title = f"{given.settings.get('title', given.name)}: {method}, {points} points, seed {options.seed}"
    values = sensitivity.values(given.parameters, sampled)
    table = study.write_table_study(given, values, options.out, f"{given.name}.{method}", title)
    flags = [part for value in options.set for part in ("--set", value)]
    flags += ["--jobs", str(options.jobs)] if options.jobs else []
    flags += ["--fresh"] if options.fresh else []
    runs = study.sweep(program, table, options.out, flags)
    study.warn_of_failures(table.stem, runs)
    found, parts = [], []
    for output in options.outputs:
        if output.column not in runs.table:
            raise MissingResult(f"{table.stem}: no column {output.column}; the columns are {' '.join(runs.units)}")
        result = output.values(runs)
        for rows in sensitivity.prefixes(method, len(given.parameters), len(sampled)):
            named = (output.name, output.unit(runs))
            part = sensitivity.analyse(method, given.parameters, sampled[:rows], result[:rows], named, options.seed)
            (found if rows == len(sampled) else parts).append(part)
    return found, parts


def print_convergence(found: list[Indices], parts: list[Indices]) -> None:
    """Print the ranking index of each parameter over the size of the sample."""
    for whole in found:
        if whole.constant:
            continue
        index = sensitivity.INDICES[whole.method][0]
        sizes = [*(part for part in parts if (part.method, part.output) == (whole.method, whole.output)), whole]
        table = pd.DataFrame({part.points: part.table[index] for part in sizes})
        table["+-"] = whole.table[f"{index}_conf"]
        print(f"\n{whole.output}, {whole.method} {index} {language.current.say('by points')}:")
        print(table.to_string(float_format=lambda value: language.current.number(f"{value:.3g}")))


def report(path: Path, program: Path, options: argparse.Namespace) -> None:
    """Analyse one study by every method: write the table, print a paragraph of text, draw the picture."""
    given = study.read_study(path)
    results = [examine(path, method, program, options) for method in options.method or METHODS]
    found = [item for whole, _ in results for item in whole]
    records = pd.DataFrame([row for item in found for row in sensitivity.records(item)])
    target = options.out / f"{given.name}.indices.csv"
    records.to_csv(target, index=False, float_format="%.6g", lineterminator="\n")
    print(f"{given.name}:", *(sensitivity.describe(item) for item in found), sep="\n  ")
    if options.convergence:
        print_convergence(found, [item for _, parts in results for item in parts])
    print(target)
    save(sensitivity.draw(found, given.parameters, language.current.keep(str(given.settings.get("title", given.name)))), options, options.out, given.name)


def print_table(studies: list[Path], folder: Path) -> None:
    """Print the total Sobol indices of all studies with their 95 % intervals: a row for each parameter, a column for each study and
    result."""
    columns = {}
    for path in studies:
        indices = pd.read_csv(folder / f"{path.stem}.indices.csv")
        total = indices[(indices["method"] == "sobol") & (indices["index"] == "ST")]
        for output, rows in total.groupby("output", sort=False):
            given = study.read_study(path)
            columns[f"{given.name.removeprefix('sensitivity_')}: {output}"] = {
                row.parameter: f"{row.value:.2f} ± {row.confidence:.2f}" for row in rows.itertuples()
            }
    say = language.current.say
    table = pd.DataFrame(columns).fillna("not varied").map(say)
    print(say("Total Sobol indices with 95 % intervals."), end="\n\n")
    print(f"| {say('parameter')} |", " | ".join(table.columns), "|")
    print("|---" * (len(table.columns) + 1) + "|")
    for parameter, row in table.iterrows():
        print(f"| `{parameter}` |", " | ".join(row), "|")


def run(options: argparse.Namespace) -> int:
    if options.sobol < 2 or options.sobol & (options.sobol - 1):
        raise Refused(f"--sobol {options.sobol}: must be a power of 2")
    if options.morris < 2:
        raise Refused(f"--morris {options.morris}: must be at least 2")
    options.out = options.out or default_folder() / "sensitivity"
    if options.table:
        print_table(options.studies, options.out)
        return 0
    program = (options.program or release_program()).absolute()
    for path in options.studies:
        report(path, program, options)
    return 0
