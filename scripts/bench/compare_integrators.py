#!/usr/bin/env python3
"""Compares the program's integrators with public codes on shipped scenes; scripts/bench/compare_integrators.sh runs this script.

    compare_integrators.py DIR              writes DIR/integrators.md, integrators.csv, .png and .svg
    compare_integrators.py DIR --compiled   measures the compiled codes again; keeps SciPy's rows in DIR/integrators.csv
    compare_integrators.py DIR --draw       draws DIR/integrators.csv again; with --language pt in Portuguese

All codes integrate the same right-hand side, that of build/scene_library/scene_library.so, in the program's own coordinates and
with its own absolute tolerances. Each code runs at tolerances from 1e-3 to 1e-12 until a run needs more than a given number of
evaluations: in smooth scenes at two tolerances per decade (SciPy one), in dry contact at ten (SciPy two). Evaluations for Jacobians
by finite differences are counted.

In smooth scenes the error is the largest error of q, A, x and their rates at the end, each divided by its largest value during the
run; the reference is a run of the program at 1e-13. In dry contact it is the largest error of the first 40 instants at which
contacts begin and end, divided by the time of one radian of the crank; a run with other contacts has failed. There small errors
grow from impact to impact, and single runs are right by chance: the largest error at a tolerance and all tighter ones counts. Times
are processor times and are measured for compiled codes only; they are divided by the time of one right-hand side of a sequence in
which each waits for the one before, measured before and after each run.
"""
from __future__ import annotations

import argparse
import ctypes
import functools
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon import language
from gudgeon.plots import style
from scene_problem import FOLDER, Outcome, Scene, load_library
from scipy import __version__ as scipy_version
from scipy import integrate

from measured import write_table

LOOSEST, TIGHTEST = -3, -12   # powers of ten of the tolerances
TARGETS = (1e-4, 1e-6, 1e-8, 1e-10)
CONTACTS = 40      # number of instants that are compared
REPEATS = 7        # a short run is repeated so often
MOST_COMPILED, MOST_PYTHON = 1_000_000, 50_000   # a run is given up after so many evaluations
OWN = ("adams", "radau", "auto")
SCIPY = {"SciPy DOP853": integrate.DOP853, "SciPy Radau": integrate.Radau, "SciPy LSODA": integrate.LSODA}
DRIVERS = {"CVODE Adams": ("cvode_run", 1), "CVODE BDF": ("cvode_run", 2), "RADAU5": ("radau5_run", 0)}   # library, method
SOURCES = {"cvode_run": "SUNDIALS CVODE of Debian (libsundials-dev)", "radau5_run": "Hairer's RADAU5 of Debian (r-cran-desolve)"}
OWN_STYLE = {"adams": (style.BLUE, "-", 1.6), "radau": (style.VERMILION, "-", 1.6), "auto": (style.BLACK, (0, (2, 2)), 1.2)}   # colour, line, width
DRAWN = {"simulation I": "an oil film (simulation I)", "dry contact": "dry contact"}   # scenes of the picture


@dataclass(frozen=True)
class Problem:
    """A scene of the comparison."""

    name: str
    case: str
    revolutions: float
    reference: str           # integrator of the reference run
    by_contacts: bool = False
    twin: bool = False

    def tolerances(self, is_compiled: bool) -> list[float]:
        """The tolerances at which a code runs."""
        per_decade = (10 if self.by_contacts else 2) if is_compiled else (2 if self.by_contacts else 1)
        return [10 ** (-k / per_decade) for k in range(-LOOSEST * per_decade, -TIGHTEST * per_decade + 1)]


PROBLEMS = (Problem("lubricated", "flores/lubricated_400cP", 2, "adams"),
            Problem("simulation I", "sim_I", 4, "adams"),
            Problem("simulation IV", "sim_IV", 2, "auto"),
            Problem("simulation V", "sim_V", 2, "auto"),
            Problem("dry contact", "flores/dry_0500um", 0.8333, "adams", by_contacts=True),
            Problem("ideal joint (sim. VI)", "sim_VI", 4, "adams", twin=True))


def repeated(run, seconds_in_turn, repeats: int) -> tuple[Outcome, float]:
    """The outcome of a run with the shortest time of several runs, and the median of their times divided by the time of a right-hand
    side, which is measured between them since the clock of a processor changes. A long run is made only once."""
    outcomes, before, ratios = [], seconds_in_turn(), []
    for _ in range(repeats):
        outcomes.append(run())
        after = seconds_in_turn()
        ratios.append(outcomes[-1].seconds / (0.5 * (before + after)))
        before = after
        if outcomes[-1].seconds > 0.3:
            break
    return min(outcomes, key=lambda outcome: outcome.seconds), float(np.median(ratios))


class Judge:
    """Computes the error of an outcome against the reference run of a scene."""

    def __init__(self, scene: Scene, problem: Problem) -> None:
        self.scene = scene
        self.by_contacts = problem.by_contacts
        self.crank_speed = abs(scene.look(scene.start())[3])
        watched = scene.run_own(problem.reference, 1e-13, watches=True)
        self.end = watched.y
        self.values, self.largest = scene.look(watched.y), np.maximum(scene.largest(), 1e-300)
        self.instants = scene.run_own(problem.reference, 1e-13).instants[:CONTACTS]

    def error(self, outcome: Outcome) -> float:
        """Error of an outcome; nan if the run failed."""
        if not outcome.done:
            return np.nan
        if not self.by_contacts:
            return float(np.max(np.abs(self.scene.look(outcome.y) - self.values)[:6] / self.largest[:6]))
        if len(outcome.instants) < CONTACTS:
            return np.nan
        off = float(np.max(np.abs(outcome.instants[:CONTACTS] - self.instants))) * self.crank_speed
        return off if off < 0.1 else np.nan


def measure(problem: Problem, library: ctypes.CDLL, drivers: dict[str, ctypes.CDLL], has_scipy: bool) -> list[dict]:
    """Measures all codes on one scene, or only the compiled codes."""
    np.seterr(all="ignore")   # warnings of codes that leave the range of the model
    scene = Scene(library, problem.case, f"integrator.revolutions={problem.revolutions}", problem.twin)
    judge, rows = Judge(scene, problem), []
    # at crank angle 0, where all begin, a sine takes less time; the end of the dry run belongs to another discrete state
    place = (0.0, scene.start()) if problem.by_contacts else (scene.t_end, judge.end)
    in_turn = functools.partial(scene.seconds_in_turn, *place)

    def follow(method: str, run, repeats: int, most: int, is_compiled: bool) -> None:
        for tolerance in problem.tolerances(is_compiled):
            outcome, bare = repeated(lambda t=tolerance: run(t), in_turn, repeats)
            rows.append({"scene": problem.name, "method": method, "tolerance": tolerance, "evaluations": outcome.evaluations,
                         "jacobians": outcome.jacobians, "steps": outcome.steps, "error": judge.error(outcome),
                         "seconds": outcome.seconds if is_compiled else np.nan,
                         "bare": bare if is_compiled else np.nan})
            if outcome.evaluations > most:
                return

    for name in OWN:
        follow(name, lambda tolerance, name=name: scene.run_own(name, tolerance), REPEATS, MOST_COMPILED, True)
    for name, (driver, number) in DRIVERS.items():
        if driver in drivers:
            follow(name, lambda tolerance, d=driver, k=number: scene.run_compiled(drivers[d], d, k, tolerance, MOST_COMPILED), REPEATS,
                   MOST_COMPILED, True)
    for name, method in SCIPY.items() if has_scipy else ():
        follow(name, lambda tolerance, m=method: scene.run_scipy(m, tolerance, MOST_PYTHON), 1, MOST_PYTHON, False)
    np.seterr(all="warn")
    shortest = min(in_turn() for _ in range(20))
    print(f"{problem.name}: right-hand side in turn {1e9 * shortest:.0f} ns", file=sys.stderr, flush=True)
    today = time.strftime("%Y-%m-%d")
    return [row | {"ns_in_turn": 1e9 * shortest, "date": today} for row in rows]


def with_rows_of_scipy(new: pd.DataFrame, path: Path) -> pd.DataFrame:
    """The new rows of compiled codes, together with the rows of SciPy from an earlier measurement."""
    before = pd.read_csv(path)
    before = before[before["method"].isin(SCIPY)]
    return pd.concat([rows for problem in PROBLEMS for rows in (new[new["scene"] == problem.name], before[before["scene"] == problem.name])])


def settled(data: pd.DataFrame) -> pd.DataFrame:
    """The data, in dry contact with the largest error of a code at a tolerance and all tighter ones."""
    contacts = [problem.name for problem in PROBLEMS if problem.by_contacts]
    data = data.sort_values("tolerance", kind="stable")
    largest = data.groupby(["scene", "method"])["error"].cummax().where(data["scene"].isin(contacts), data["error"])
    return data.assign(error=largest).sort_index()


def cheapest(rows: pd.DataFrame, target: float, by: str = "evaluations") -> pd.Series | None:
    """The cheapest run whose error is at most the target."""
    good = rows[rows["error"] <= target].dropna(subset=[by])
    return None if good.empty else good.loc[good[by].idxmin()]


def table(data: pd.DataFrame) -> list[str]:
    """For each scene and target error, what each method needs: evaluations, and processor time divided by that of a right-hand
    side."""
    lines = []
    for scene, of_scene in data.groupby("scene", sort=False):
        lines += ["", f"## {scene}", "", f"One right-hand side in turn: {of_scene['ns_in_turn'].iloc[0]:.0f} ns.", "",
                  "| method | " + " | ".join(f"error {t:.0e}" for t in TARGETS) + " |", "|---" * (1 + len(TARGETS)) + "|"]
        for method, rows in of_scene.groupby("method", sort=False):
            cells = []
            for target in TARGETS:
                few, fast = cheapest(rows, target), cheapest(rows, target, "bare")
                text = "–" if few is None else f"{few['evaluations']:,.0f}"
                if fast is not None:
                    text += f" ({fast['bare']:,.0f})"
                cells.append(text)
            lines.append(f"| {method} | " + " | ".join(cells) + " |")
    return lines


def time_of_evaluation(data: pd.DataFrame, target: float = 1e-6) -> list[str]:
    """For each implicit code and smooth scene, the time of the fastest run with at most this error, for each of its evaluations."""
    smooth = [problem.name for problem in PROBLEMS if not problem.by_contacts and not problem.twin]
    lines = ["", "## Time of an evaluation", "",
             f"The time of the fastest run with an error of at most {target:.0e}, with all that belongs to its steps, for each evaluation, divided",
             "by the time of a right-hand side in turn. For `radau` and `auto` the number in brackets also counts each Jacobian in closed form",
             "as one evaluation, as the other codes count those of their difference Jacobians.", "",
             "| method | " + " | ".join(smooth) + " |", "|---" * (1 + len(smooth)) + "|"]
    for method in ("radau", "auto", "RADAU5", "CVODE BDF"):
        cells = []
        for scene in smooth:
            run = cheapest(data[(data["scene"] == scene) & (data["method"] == method)], target, "bare")
            if run is None:
                cells.append("–")
                continue
            text = f"{run['bare'] / run['evaluations']:.2f}"
            cells.append(text + (f" ({run['bare'] / (run['evaluations'] + run['jacobians']):.2f})" if method in OWN else ""))
        if method in set(data["method"]):
            lines.append(f"| {method} | " + " | ".join(cells) + " |")
    return lines


def report(data: pd.DataFrame, drivers: dict[str, ctypes.CDLL]) -> str:
    """The text of the measured page, without its first lines."""
    codes = ", ".join([f"SciPy {scipy_version}", *(text if name in drivers else f"without {text.split(' of')[0]}" for name, text in SOURCES.items())])
    dates = " to ".join(sorted({data["date"].min(), data["date"].max()}))
    head = [f"gfortran, -O3 -flto; {codes}. Measured {dates}.", "",
            "Each column is for one error, and each entry has two numbers:", "",
            "- the number of evaluations of the right-hand side in the cheapest run with at most this error, of the runs at",
            "  tolerances 1e-3 to 1e-12 (two per decade, SciPy one; in dry contact ten, SciPy two). Evaluations for Jacobians by",
            "  finite differences are counted.",
            "  `radau` and `auto` have Jacobians in closed form where only the piston pin has clearance; these are part of the",
            "  time, but are not counted;",
            "- in brackets, the processor time of the fastest run with at most this error, divided by the time of one right-hand",
            f"  side that waits for the one before. The run is repeated up to {REPEATS} times, with a measurement of that right-hand side before",
            "  and after each; the number is the median quotient. (The time above each table is the shortest measured.) This may be",
            "  another run than that of the first number. SciPy has no second number, because its time is mainly that of Python.", "",
            f"\"–\" means that no run had this error. A code is given up after a run of more than {MOST_PYTHON:,} (SciPy) or",
            f"{MOST_COMPILED:,} evaluations. All codes integrate the program's own right-hand side in its own coordinates and with",
            "its own absolute tolerances, except the crank speed, which the program integrates at a hundredth of its tolerance.",
            "The program's own methods also carry the integral of the work of the forces, which the other codes do not.", "",
            "The error is the largest error of crank angle, rod angle, piston position and their rates at the end, each divided by its",
            "largest value during the run (lubricated, IV and V 2 revolutions, I and ideal 4). In dry contact it is the largest error of the",
            f"first {CONTACTS} instants at which contacts begin and end, up to 10 ms, divided by the time of one radian of the crank. There",
            "small errors grow from impact to impact, and single runs are right by chance; so the largest error at a tolerance and all",
            "tighter ones counts. Every run is in `integrators.csv`, with its own error.", "",
            "![Error against evaluations and time](integrators.png)"]
    return "\n".join(head + table(settled(data)) + time_of_evaluation(settled(data))) + "\n"


def draw(data: pd.DataFrame, path: Path) -> None:
    """Draw the error over the evaluations in a scene with a film and in one with dry contact: the program's own methods in colour, each
    curve with its name at its end. The other scenes and the times are in the page."""
    data = settled(data)
    figure, axes = plt.subplots(1, len(DRAWN), figsize=(style.WIDTH * 1.15, 3.4), sharey=True)
    for axis, (scene, title) in zip(axes, DRAWN.items()):
        ends = []
        for method, rows in data[data["scene"] == scene].groupby("method", sort=False):
            done = rows[rows["error"] < 0.5].dropna(subset=["error", "evaluations"])
            if done.empty:
                continue
            colour, line, wide = OWN_STYLE.get(method, (style.GREY, "-", 0.7))
            axis.loglog(done["evaluations"], done["error"].clip(lower=1e-14), color=colour, linestyle=line, linewidth=wide, zorder=3 if method in OWN else 2)
            ends.append((np.log10(max(done["error"].iloc[-1], 1e-14)), done["evaluations"].iloc[-1], method, colour))
        low = axis.get_ylim()[0]
        axis.margins(x=0.06)
        last = np.inf
        for height, evaluations, method, colour in sorted(ends, reverse=True):   # names do not cover each other
            last = min(height, last - 0.65)
            axis.annotate(method, (evaluations, 10.0**height), xytext=(1.04, (last - np.log10(low)) / (np.log10(axis.get_ylim()[1]) - np.log10(low))),
                          textcoords="axes fraction", va="center", fontsize=7, color=colour, arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.4, "relpos": (0, 0.5), "shrinkA": 0, "shrinkB": 2})
        axis.set(title=title, xlabel="evaluations of the right-hand side")
        marks = [mark for mark in (2000, 10_000, 50_000, 200_000) if axis.get_xlim()[0] <= mark <= axis.get_xlim()[1]]
        axis.set_xticks(marks, [f"{mark:,}".replace(",", " ") for mark in marks])
        axis.set_xticks([], minor=True)
    axes[0].set_ylabel("error")
    figure.suptitle("In a film radau, in dry contact adams needs the fewest evaluations for an accuracy; auto finds out which")
    style.keep(figure, path)
    language.current.warn("compare_integrators.py")


def main() -> int:
    """Measure all codes and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="DIR", help="folder in which the results are written")
    parser.add_argument("--compiled", action="store_true", help="measure the compiled codes only")
    parser.add_argument("--draw", action="store_true", help="only draw the picture again")
    language.add_option(parser)
    options = parser.parse_args()
    folder, compiled_only = options.folder, options.compiled
    table_of_runs = folder / "integrators.csv"
    if (options.draw or compiled_only) and not table_of_runs.exists():
        sys.exit(f"compare_integrators: {table_of_runs} is missing: measure all codes first, without --compiled and --draw")
    if options.draw:
        draw(pd.read_csv(table_of_runs), folder / "integrators.png")
        return 0
    library = load_library()
    drivers = {name: ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL) for name in SOURCES if (path := FOLDER / f"{name}.so").exists()}
    data = pd.DataFrame([row for problem in PROBLEMS for row in measure(problem, library, drivers, not compiled_only)])
    if compiled_only:
        data = with_rows_of_scipy(data, table_of_runs)
    data.to_csv(table_of_runs, index=False, float_format="%.7g")
    page = write_table("integrators", "Integrators at equal error", "scripts/bench/compare_integrators.sh", report(data, drivers), folder)
    draw(data, folder / "integrators.png")
    print(page.read_text(encoding="utf-8"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
