"""Films against each other: what an evaluation and a run cost with each, and what the run says.

The same scene with every film, integrated by `auto` at the relative tolerance of the cases. Times are the least of some runs; a direct
solution takes too long to be repeated. Answers come from a run of its own, since they cost evaluations.
"""

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from .results import read_summary


@dataclass(frozen=True)
class Film:
    """A film and the values of a case that ask for it."""

    name: str
    overrides: tuple[str, ...]
    repeats: bool = True  # quick enough to be run several times
    reports: bool = True  # and to be looked at three times in each step


def table(points: int, nodes: int) -> Film:
    return Film(f"table, {points} x {points} values, {nodes} nodes", (*FINITE, "lubrication.variant=table",
                f"lubrication.table_points={points}", f"lubrication.film_points={nodes}"))


LONG = ("lubrication.law=pinkus_sternlicht",)
FINITE = ("lubrication.law=finite_bearing",)
FILMS = (
    Film("as_printed", (*LONG, "lubrication.variant=as_printed"), repeats=False, reports=False),
    Film("closed_form", (*LONG, "lubrication.variant=closed_form")),
    Film("half_film", (*LONG, "lubrication.variant=half_film")),
    Film("oscillating", ("lubrication.law=oscillating_film", "lubrication.kinematic_viscosity=1.38e-5")),
    Film("short", (*FINITE, "lubrication.variant=short")),
    table(17, 64),
    table(33, 64),
    table(65, 128),
    Film("direct, 64 nodes", (*FINITE, "lubrication.variant=direct", "lubrication.film_points=64"), repeats=False, reports=False),
)


def run(program: Path, case: Path, out: str, values: tuple[str, ...], timeout: float) -> dict[str, float] | None:
    """The numbers in the summary of a run without rows; None if it does not come to an end."""
    always = ("integrator.method=auto", "output.ideal_twin=.false.", "output.columns=time", "output.samples_per_revolution=1")
    overrides = [part for value in (*always, *values) for part in ("-s", value)]
    try:
        done = subprocess.run([str(program), "-q", "-j", "1", "-o", out, *overrides, str(case)], capture_output=True, text=True, check=False,
                              timeout=timeout)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        return None
    numbers = {}
    for name, (value, _) in read_summary(Path(out) / f"{case.stem}.summary.csv").items():
        try:
            numbers[name] = float(value)
        except ValueError:
            continue
    return numbers


def row(program: Path, case: Path, film: Film, repeat: int, timeout: float) -> str:
    """One line of the table."""
    with tempfile.TemporaryDirectory() as out:
        if film.repeats:   # the first one makes its table
            run(program, case, out, film.overrides, timeout)
        runs = [run(program, case, out, film.overrides, timeout) for _ in range(repeat if film.repeats else 1)]
        answers = run(program, case, out, (*film.overrides, "lubrication.report=.true."), timeout) if film.reports else runs[0]
    if answers is None or any(one is None for one in runs):
        return f"| `{case.stem}` | {film.name} | does not end in {timeout:.0f} s | | | | | |"
    seconds = min(one["wall_time"] for one in runs)
    evaluations = runs[0]["rhs_evaluations"]
    thinnest = answers["min_film_thickness"]
    cells = [f"`{case.stem}`", film.name, f"{evaluations:.0f}", f"{1e6 * seconds / evaluations:.2g}", f"{1e3 * seconds:.3g}",
             f"{1e6 * thinnest:.3f}" if thinnest > 0 else f"{1e6 * thinnest:.1f}, touches",
             f"{1e-6 * answers['max_film_pressure']:.4g}" if "max_film_pressure" in answers else "",
             f"{1e3 * answers['film_energy_lost']:.4g}" if "film_energy_lost" in answers else ""]
    return "| " + " | ".join(cells) + " |"


def print_table(program: Path, cases: list[Path], repeat: int, timeout: float) -> None:
    print("| case | film | evaluations | us each | run [ms] | thinnest film [um] | largest pressure [MPa] | lost in the film [mJ] |")
    print("|---|---|---|---|---|---|---|---|")
    for case in cases:
        for film in FILMS:
            print(row(program, case.resolve(), film, repeat, timeout), flush=True)
