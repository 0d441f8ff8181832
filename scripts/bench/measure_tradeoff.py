#!/usr/bin/env python3
"""Measures the cost of accuracy in a scene, and recommends settings of the integrator.

    scripts/bench/measure_tradeoff.py cases/sim_I.nml               table, picture and recommendation, in results/tradeoff
    scripts/bench/measure_tradeoff.py cases/flores/*.nml --repeat 9 several cases, wall times the median of nine
    scripts/bench/measure_tradeoff.py --presets                     the results of --accuracy draft, standard, reference in every case
    scripts/bench/measure_tradeoff.py --films cases/sim_I.nml       every film in this scene: cost and results, to data/measured/films.md

Runs a case with all combinations of tolerance, method, max_order and step_rejection with the release build, in parallel on
all processor cores. Each run is compared with a reference at the tightest setting, whose own error is estimated from a run
at the next tightest tolerance and one by the other method. If the measurement is interrupted, the same command continues it: rows
of the table are measured again only if the case or the program has changed. Wall times are measured while other cores
are busy; numbers of evaluations are exact.
"""

import argparse
import csv
import hashlib
import os
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from itertools import product
from pathlib import Path

from measured import TOP, built_program, use_virtual_environment

use_virtual_environment()

import film_tradeoff
import pandas as pd
import tradeoff
from gudgeon import language
from gudgeon.plots import style
from gudgeon.results import MissingResult, Run, load_run, read_summary
from tradeoff import Reference, Settings

REVOLUTIONS = 8  # of a run that would end when its motion is periodic: at another time with each setting

COLUMNS = (
    *("variant", "method", "max_order", "contact_entry", "max_penetration", "tolerance", "points", "status", "seconds"),
    *("evaluations", "state_error", "agrees_until", "digits_3_until", "digits_6_until"),
    *("impacts", "impacts_matched", "impacts_extra", "impact_time_error", "peak_force_error", "least_film_error"),
    *("energy_residual", "mean_speed", "mean_force", "impacts_per_turn", "contact_share", "made_of"),
)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", type=Path, metavar="CASE.nml")
    parser.add_argument("--presets", action="store_true",
                        help="measure only the accuracy levels (of every shipped case unless cases are given)")
    parser.add_argument("--films", action="store_true", help="compare the films with each other in the scenes of these cases")
    parser.add_argument(
        "--out", type=Path, default=TOP / "results" / "tradeoff", metavar="DIR", help="(default: results/tradeoff)"
    )
    parser.add_argument("--tolerances", nargs="+", type=float, default=[10.0**-n for n in range(3, 12)], metavar="TOL")
    parser.add_argument("--methods", nargs="+", default=["adams", "radau", "auto"], choices=("adams", "radau", "auto"))
    parser.add_argument(
        "--orders", nargs="+", type=int, default=[5, 9, 12], metavar="N", help="max_order (default: 5 9 12)"
    )
    parser.add_argument(
        "--penetrations",
        nargs="*",
        type=float,
        default=[1e-3, 1e-5, 1e-7],
        metavar="SHARE",
        help="max_penetration of step_rejection in clearances, for scenes with contact (default: 1e-3 1e-5 1e-7)",
    )
    parser.add_argument(
        "--variants",
        nargs="+",
        default=[""],
        metavar="NAME",
        help="variants of the film, each compared with its own reference (default: the case's own)",
    )
    parser.add_argument(
        "--points",
        nargs="+",
        type=int,
        default=[0, 8, 32],
        metavar="N",
        help="quadrature_points of an oscillating film, 0: chosen from the tolerance (default: 0 8 32)",
    )
    parser.add_argument(
        "--reference",
        nargs=2,
        type=float,
        default=[1e-13, 1e-12],
        metavar="TOL",
        help="tightest and next tightest tolerance (default: 1e-13 1e-12)",
    )
    parser.add_argument("--horizon", type=float, metavar="S",
                        help="time up to which errors are measured (default: while the reference is known)")
    parser.add_argument(
        "--digits", nargs="+", type=int, default=[3, 6], metavar="N",
        help="numbers of correct digits for which settings are recommended (default: 3 6)"
    )
    parser.add_argument(
        "--repeat", type=int, default=5, metavar="N", help="wall time is the median of N runs (default: 5)"
    )
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="number of runs in parallel (default: number of processor cores)"
    )
    parser.add_argument(
        "--timeout", type=float, metavar="S", help="stop a run after this time (default: 120; with --films 7200)"
    )
    language.add_option(parser)
    options = parser.parse_args()
    if options.presets and not options.cases:
        options.cases = sorted(TOP.glob("cases/*.nml")) + sorted(TOP.glob("cases/*/*.nml"))
        options.cases = [case for case in options.cases if "&integrator" in case.read_text(encoding="utf-8")]
    if not options.cases:
        parser.error("a CASE.nml is needed")
    if options.timeout is None:
        options.timeout = 7200.0 if options.films else 120.0
    return options


def overrides(values: list[str]) -> list[str]:
    """Options of the program that set these values, GROUP.KEY=VALUE."""
    return [part for value in values for part in ("-s", value)]


class Study:
    """One case and film variant: its runs, reference and table."""

    def __init__(self, case: Path, variant: str, program: Path, options: argparse.Namespace) -> None:
        self.case, self.variant, self.program, self.options = case.resolve(), variant, program, options
        self.name = case.stem + (f"_{variant}" if variant else "")
        self.table = options.out / f"{self.name}.csv"
        text = self.case.read_text(encoding="utf-8")
        whole = ["run.until=end", f"integrator.revolutions={REVOLUTIONS}", "output.window=all", "output.sampling=time"]
        self.length = whole if "'periodic'" in text else []
        made_of = [program.read_bytes(), self.case.read_bytes(), repr((options.horizon, options.reference, self.length)).encode()]
        self.made_of = hashlib.sha1(b"".join(made_of)).hexdigest()[:10]

    def run(self, settings: Settings, out: str, *more: str) -> str:
        """Run the case once with its results in the directory `out`, and return the status."""
        values = [*settings.overrides(), *self.length, "output.ideal_twin=.false.", *more]
        command = [str(self.program), "-q", "-o", out, *overrides(values), str(self.case)]
        try:
            outcome = subprocess.run(command, capture_output=True, text=True, check=False, timeout=self.options.timeout)
        except subprocess.TimeoutExpired:
            return "timeout"
        if outcome.returncode in (2, 3):  # the settings or the case are wrong: all other runs would fail too
            raise MissingResult(outcome.stderr.strip())
        return "done" if outcome.returncode == 0 else "failed"

    def load(self, out: str) -> Run:
        return load_run(Path(out) / f"{self.case.stem}.csv")

    def reference(self) -> Reference:
        """The runs at the tightest tolerance by both methods and at the next tightest, made in parallel."""
        wanted = list(product(("adams", "radau"), self.options.reference))

        def make(method: str, tolerance: float) -> Run | None:
            with tempfile.TemporaryDirectory() as out:
                settings = Settings(self.variant, method, 12, "root", 0.0, tolerance)
                return self.load(out) if self.run(settings, out, "output.digits=17") == "done" else None

        with ThreadPoolExecutor(self.options.jobs) as pool:
            runs = dict(zip(wanted, pool.map(lambda item: make(*item), wanted)))
        tight, loose = (
            {method: run for (method, value), run in runs.items() if value == tolerance and run is not None}
            for tolerance in self.options.reference
        )
        if not tight or len(tight) + len(loose) < 2:
            raise MissingResult(f"{self.name}: too few reference runs come to an end; try --reference 1e-12 1e-11")
        return tradeoff.choose_reference(tight, loose, self.options.horizon)

    def settings(self, run: Run) -> list[Settings]:
        """All settings to be run for a case whose reference is `run`."""
        touches, clearance = len(tradeoff.impact_times(run)) > 0, run.clearance
        has_points = "oscillating" in str(run.parameter("lubrication", "law", default=""))
        entries = [("root", 0.0)]
        if touches:
            entries += [("step_rejection", share * clearance) for share in self.options.penetrations]
        return [
            Settings(self.variant, method, order, *entry, tolerance, points)
            for method, order, entry, tolerance, points in product(
                self.options.methods,
                self.options.orders,
                entries,
                self.options.tolerances,
                self.options.points if has_points else [0],
            )
        ]

    def row(self, settings: Settings, reference: Reference) -> dict[str, object]:
        """Run once with all digits, for the errors, and with the settings of the case, for the wall time."""
        with tempfile.TemporaryDirectory() as out:
            row: dict[str, object] = vars(settings) | {"made_of": self.made_of}
            row["status"] = self.run(settings, out, "output.digits=17")
            if row["status"] != "done":
                return row
            row |= tradeoff.measure(reference, self.load(out))
            times = []
            for _ in range(self.options.repeat):
                self.run(settings, out)
                times.append(float(read_summary(Path(out) / f"{self.case.stem}.summary.csv")["wall_time"][0]))
            return row | {"seconds": statistics.median(times)}

    def rows(self) -> pd.DataFrame:
        """The rows of the table that are still valid; the file is written again with these rows only."""
        columns = list(COLUMNS)
        if not self.table.exists():
            self.table.parent.mkdir(parents=True, exist_ok=True)
            found = pd.DataFrame(columns=columns)
        else:
            found = pd.read_csv(self.table, keep_default_na=False, na_values=["nan"], dtype={"made_of": str})
            if list(found.columns) != columns:
                return pd.DataFrame(columns=columns)
            found = found[found["made_of"] == self.made_of].copy()
            numbers = columns[columns.index("seconds") : -1]
            found[numbers] = found[numbers].apply(pd.to_numeric, errors="coerce")
        return found

    def measure(self, reference: Reference) -> pd.DataFrame:
        """Run the settings that the table lacks, and add a row when a run ends. Returns all rows of the wanted settings."""
        wanted = self.settings(reference.run)
        old = self.rows()
        old.to_csv(self.table, index=False, na_rep="nan")
        have = {tradeoff.settings_of(row).key for _, row in old.iterrows()}
        missing = [settings for settings in wanted if settings.key not in have]
        with self.table.open("a", newline="", encoding="utf-8") as file, ThreadPoolExecutor(self.options.jobs) as pool:
            writer = csv.DictWriter(file, COLUMNS, restval="nan", lineterminator="\n")
            try:
                waiting = [pool.submit(self.row, settings, reference) for settings in missing]
                for count, done in enumerate(as_completed(waiting), len(wanted) - len(missing) + 1):
                    writer.writerow(done.result())
                    file.flush()
                    progress(f"{self.name}: {count} of {len(wanted)}", last=count == len(wanted))
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        keys = {settings.key for settings in wanted}
        table = self.rows()
        return table[[tradeoff.settings_of(row).key in keys for _, row in table.iterrows()]].reset_index(drop=True)


def progress(text: str, last: bool) -> None:
    """Print a line on standard error: on a terminal it overwrites the one before, otherwise only the last is printed."""
    if sys.stderr.isatty():
        print(f"\r{text}", end="\n" if last else "", file=sys.stderr, flush=True)
    elif last:
        print(text, file=sys.stderr, flush=True)


def preset_row(study: Study) -> str:
    """One row of the table of accuracy levels."""
    reference = study.reference()
    run = reference.run
    known = f"{reference.error:.0e}" + ("" if reference.whole else f" for {1e3 * reference.horizon:.3g} ms")
    cells = [f"`{study.case.relative_to(TOP / 'cases').with_suffix('')}`", f"{1e3 * run['time'][-1]:.3g} ms", known]
    for level, promise in tradeoff.LEVELS.items():
        with tempfile.TemporaryDirectory() as out:
            values = [*study.length, "output.ideal_twin=F", "output.digits=17"]
            command = [str(study.program), "-q", "-a", level, "-o", out, *overrides(values)]
            outcome = subprocess.run([*command, str(study.case)], capture_output=True, text=True, check=False)
            done = outcome.returncode == 0
            cells.append(tradeoff.level_cell(reference, study.load(out), promise) if done else "failed")
    return "| " + " | ".join(cells) + " |"


def report(study: Study, reference: Reference, table: pd.DataFrame) -> None:
    """Print the reference, the Pareto front and the recommendation; draw the picture."""
    run, done = reference.run, table[table["status"] == "done"].reset_index(drop=True)
    print(f"\n== {study.name}")
    print(
        f"reference: {run.parameter('integrator', 'method')}, tolerance {study.options.reference[0]:g};"
        f" known to {reference.error:.1e} of the states' ranges"
        + (" to the end" if reference.whole else f" up to {reference.horizon:.4g} s of {run['time'][-1]:.4g} s")
        + f", {(tradeoff.impact_times(run) <= reference.horizon).sum()} impacts"
    )
    print(f"{len(done)} of {len(table)} runs were finished; Pareto front of wall time and state error:")
    digits = ", ".join(f"{n} digits up to {reference.known(10.0**-n):.4g} s" for n in study.options.digits)
    beyond = tradeoff.turn_statistics(run, 0.0 if reference.whole else reference.horizon)
    print(f"known to {digits}; revolutions " + ("" if reference.whole else "beyond the horizon: ")
          + ", ".join(f"{name} {value:.4g}" for name, value in beyond.items()))
    front = done.loc[tradeoff.pareto_front(done["seconds"], done["state_error"])]
    shown = front[list(COLUMNS[1:-1])].drop(columns="status")
    print(shown.to_string(index=False, float_format=lambda value: f"{value:.2g}"))
    print(*tradeoff.recommendation(table, reference, study.options.digits), sep="\n")
    drawing = tradeoff.draw(table, reference, study.name)
    style.add_legend(drawing, drawing.axes)
    print(study.table, *style.save(drawing, study.options.out, study.name, ["png", "svg"]))
    language.current.warn("measure_tradeoff.py")


def main() -> int:
    options = arguments()
    rows: list[str] = []
    try:
        program = built_program()
        if options.films:
            film_tradeoff.write_table(program, options.cases, options.repeat, options.timeout, options.out)
            return 0
        if options.presets:
            print(
                "Largest error of the states (coordinates, speeds) in the run, relative to their ranges, and number of evaluations.",
                "`E for T ms`: the motion is chaotic, and the error stays below E up to the time T. `reference known to`: the same",
                "error of the reference run, with which the others are compared. Cases whose run ends when the motion is periodic make",
                f"{REVOLUTIONS} revolutions here.\n",
                sep="\n",
            )
            print("| case | length | reference known to | draft | standard | reference |", "|---|---|---|---|---|---|", sep="\n")
            for case in options.cases:
                try:
                    print(preset_row(Study(case, "", program, options)), flush=True)
                except MissingResult as problem:
                    print(f"| `{case.stem}` | no reference | {problem} | | | |", flush=True)
            return 0
        for case, variant in product(options.cases, options.variants):
            study = Study(case, variant, program, options)
            reference = study.reference()
            table = study.measure(reference)
            report(study, reference, table)
            rows += tradeoff.markdown(study.name, table, reference, options.digits)
        print("\n| case | reference known to | digits | use | time [ms] | evaluations | state error |")
        print("|---|---|---|---|---|---|---|", *rows, sep="\n")
    except (MissingResult, OSError) as problem:
        print(f"measure_tradeoff.py: {problem}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nmeasure_tradeoff.py: interrupted; the same command continues", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
