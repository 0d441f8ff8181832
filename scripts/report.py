#!/usr/bin/env python3
"""Writes an HTML page about one run: the mechanism in motion, interactive plots, the case, the summary, warnings.

    scripts/report.py sim_V_oscillating             -> results/sim_V_oscillating.html
    scripts/report.py cases/flores/dry_0500um.nml -o dry.html
    scripts/report.py engine                        from results/engine.csv in the current folder
    scripts/report.py sim_IV --cycles crank_speed guide_force

The page is one file and needs no network. It shows the pressure around the pin in a film of finite length if the run has written
it (&output film_times = 'from:to:count'), and the worn surfaces of a run with &wear. Traces are searched in results/ of the current
folder, then in results/ of the checkout. If the result of a shipped case or of a case file is missing, the case is run with the release build.
"""

import argparse
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment(more=("scipy",))

from gudgeon_plots import language  # noqa: E402
from gudgeon_plots.film_pressure import fields_of  # noqa: E402
from gudgeon_plots.report_page import page  # noqa: E402
from gudgeon_plots.results import MissingResult, Results  # noqa: E402
from gudgeon_plots.wear_pictures import surfaces_of  # noqa: E402


def folder_of(given: Path, name: str) -> Path:
    """Folder of the trace: that of the given trace, or results/ of the current folder if the trace is there, or results/ of the
    checkout."""
    if given.suffix == ".csv":
        return given.parent
    return Path("results") if (Path("results") / f"{name}.csv").exists() else TOP / "results"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", metavar="CASE", help="name of a case, its file or its trace")
    parser.add_argument(
        "--results", type=Path, metavar="DIR", help="folder of the traces (default: results, or that of the trace)"
    )
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="file of the page (default: CASE.html beside the trace)")
    parser.add_argument("--cycles", nargs="+", metavar="COLUMN",
                        help="columns whose cycles and orders are shown, even if the run has not settled")
    parser.add_argument("--no-run", action="store_true", help="do not run the case; print the command if the result is missing")
    language.add_option(parser)
    options = parser.parse_args()
    given = Path(options.case)
    name = given.name.removesuffix(".nml").removesuffix(".csv")
    directory = options.results or folder_of(given, name)
    case = given if given.suffix == ".nml" and given.exists() else None
    results = Results(directory, run_missing=not options.no_run, case=case)
    try:
        if not results.path(name).exists():
            results.make([name])
        run = results[name]
        if not run.case:
            raise MissingResult(f"{name}.resolved.nml is missing beside the trace")
        twin = results[f"{name}.ideal"] if results.path(f"{name}.ideal").exists() else None
        pressures, worn = directory / f"{name}.film.csv", directory / f"{name}.wear.csv"
        text = page(run, twin, fields_of(pressures) if pressures.exists() else None, language.current, options.cycles,
                    surfaces_of(worn) if worn.exists() else None)
        language.current.warn("report.py")
    except MissingResult as problem:
        print(f"report.py: {problem}", file=sys.stderr)
        return 1
    out = options.out or directory / f"{name}.html"
    if out.is_dir():
        out = out / f"{name}.html"
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as problem:
        print(f"report.py: {out}: {problem.strerror}", file=sys.stderr)
        return 5
    print(f"{out}: {len(text.encode('utf-8')) / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
