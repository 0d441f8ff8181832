"""Writes an HTML page about one run: the mechanism in motion, interactive plots, the case, the summary, warnings.

    gudgeon-plot report cases/sim_V_oscillating.nml   -> results/sim_V_oscillating.html
    gudgeon-plot report cases/flores/dry_0500um.nml -o dry.html
    gudgeon-plot report engine                        from results/engine.csv in the current folder
    gudgeon-plot report cases/sim_IV.nml --cycles crank_speed guide_force
    gudgeon-plot report engine --short                one A4 page to print: results/engine_short.pdf

The page is one file and needs no network. It shows the pressure around the pin in a film of finite length if the run has written
it (&output film_times = 'from:to:count'), and the worn surfaces of a run with &wear. A case file without
results is run.
"""

import argparse
import sys
from pathlib import Path

from gudgeon import language
from gudgeon.commands import FORMATS, Refused, add_results
from gudgeon.plots import short, style
from gudgeon.plots.film_pressure import fields_of
from gudgeon.plots.wear import surfaces_of
from gudgeon.report.page import page
from gudgeon.results import MissingResult, located


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="RUN", help="case file, trace, or name of a run in results/")
    parser.add_argument("-o", "--out", type=Path, metavar="PATH", help="file of the page, or its folder (default: RUN.html beside the trace)")
    parser.add_argument("--short", action="store_true",
                        help="one A4 page (PDF, or PNG or SVG by the ending of -o): case, answers, losses, up to four plots of the last cycle")
    parser.add_argument("--cycles", nargs="+", metavar="COLUMN",
                        help="columns whose cycles and orders are shown, even if the run has not settled")
    add_results(parser)


def run(options: argparse.Namespace) -> int:
    results, name = located(options.case, options.results, not options.no_run)
    directory, shown = results.directory, results[name]
    if not shown.case:
        raise MissingResult(f"{name}.resolved.nml is missing beside the trace")
    if options.short:
        out = options.out if options.out and options.out.suffix[1:] in FORMATS else (options.out or directory) / f"{name}_short.pdf"
        print(*style.save(short.draw(shown, name), out.parent, out.stem, [out.suffix[1:]]))
        return 0
    if "bearing_load" in shown.case:
        raise Refused(f"{name}: a bearing by itself has no mechanism to draw: --short, or gudgeon-plot bearing")
    twin = results[f"{name}.ideal"] if results.has(f"{name}.ideal") else None
    pressures, worn = directory / f"{name}.film.csv", directory / f"{name}.wear.csv"
    text = page(shown, twin, fields_of(pressures) if pressures.exists() else None, language.current, options.cycles,
                surfaces_of(worn) if worn.exists() else None)
    out = options.out or directory / f"{name}.html"
    if out.is_dir():
        out = out / f"{name}.html"
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as problem:
        print(f"gudgeon-plot report: {out}: {problem.strerror}", file=sys.stderr)
        return 5
    print(f"{out}: {language.current.number(f'{len(text.encode()) / 1e6:.2f}')} MB")
    return 0
