"""Comparison of films: the cost of an evaluation and of a run with each of them, and the results of the run.

The same scene runs with every film, integrated by `auto` at the relative tolerance of the cases. Times are the shortest of several
runs; the direct solution runs once because it takes long. The instructions of an evaluation are counted by valgrind, if it is
installed, as the difference of two short runs, so that they do not depend on other programs on the computer. Finished rows are
stored: after an interruption the same command continues, unless the case or the program has changed.
"""

import hashlib
import json
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from gudgeon.results import read_summary

from measured import write_table as write_measured


@dataclass(frozen=True)
class Film:
    """A film, and the settings of a case that select it."""

    name: str
    overrides: tuple[str, ...]
    repeats: bool = True  # fast enough to be run several times
    reports: bool = True  # fast enough for the report, which evaluates the film three times a step
    counted: tuple[float, float] = (0.05, 0.35)  # revolutions of the two runs whose instructions are counted


def table(points: int, nodes: int) -> Film:
    return Film(f"table, {points} x {points} values, {nodes} nodes", (*FINITE, "lubrication.variant=table",
                f"lubrication.table_points={points}", f"lubrication.film_points={nodes}"))


LONG = ("lubrication.law=pinkus_sternlicht",)
FINITE = ("lubrication.law=finite_bearing",)
FILMS = (
    Film("as_printed", (*LONG, "lubrication.variant=as_printed"), repeats=False, reports=False, counted=(0.01, 0.02)),
    Film("closed_form", (*LONG, "lubrication.variant=closed_form")),
    Film("half_film", (*LONG, "lubrication.variant=half_film")),
    Film("oscillating", ("lubrication.law=oscillating_film", "lubrication.kinematic_viscosity=1.38e-5")),
    Film("short", (*FINITE, "lubrication.variant=short")),
    table(17, 64),
    table(33, 64),
    table(65, 128),
    Film("direct, 32 nodes", (*FINITE, "lubrication.variant=direct", "lubrication.film_points=32"), repeats=False, counted=(0.002, 0.004)),
)
YARDSTICK = "closed_form"  # the film to which the costs of the others are compared


def command(program: Path, case: Path, out: str, values: tuple[str, ...]) -> list[str]:
    """The command of a run with as few rows as possible."""
    always = ("integrator.method=auto", "output.ideal_twin=.false.", "output.columns=time", "output.samples_per_revolution=1")
    overrides = [part for value in (*always, *values) for part in ("-s", value)]
    return [str(program), "-q", "-j", "1", "-o", out, *overrides, str(case)]


def run(program: Path, case: Path, out: str, values: tuple[str, ...], timeout: float) -> dict[str, float | str]:
    """Run a case and return the numbers of its summary; `stopped` is the reason why it did not reach its end."""
    try:
        done = subprocess.run(command(program, case, out, values), capture_output=True, text=True, check=False, timeout=timeout)
    except subprocess.TimeoutExpired:
        return {"stopped": f"does not end in {timeout:.0f} s"}
    numbers: dict[str, float | str] = {}
    summary = Path(out) / f"{case.stem}.summary.csv"
    for name, (value, _) in (read_summary(summary).items() if summary.exists() else ()):
        try:
            numbers[name] = float(value)
        except ValueError:
            continue
    if done.returncode != 0:
        at = re.search(r"crank angle ([-.0-9]+) deg", done.stderr)
        why = "too much work in a revolution" if "too much work" in done.stderr else f"exit status {done.returncode}"
        numbers["stopped"] = f"stopped, {why}" + (f", at {float(at[1]):.0f} deg" if at else "")
    return numbers


def instructions(program: Path, case: Path, film: Film, timeout: float) -> float | None:
    """Instructions of one evaluation of the whole scene, including its share of the integrator; None without valgrind."""
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        return None
    found = []
    for revolutions in film.counted:
        with tempfile.TemporaryDirectory() as out:
            values = (*film.overrides, f"integrator.revolutions={revolutions}")
            try:
                done = subprocess.run([valgrind, "--tool=callgrind", "--callgrind-out-file=/dev/null", *command(program, case, out, values)],
                                      capture_output=True, text=True, check=False, timeout=timeout)
                evaluations = float(read_summary(Path(out) / f"{case.stem}.summary.csv")["rhs_evaluations"][0])
            except (subprocess.TimeoutExpired, OSError, KeyError):
                return None
            counted = re.search(r"Collected : (\d+)", done.stderr)
            if done.returncode != 0 or counted is None:
                return None
            found.append((int(counted[1]), evaluations))
    (few, fewer), (many, more) = found
    return (many - few) / (more - fewer) if more > fewer else None


def measure(program: Path, case: Path, film: Film, repeat: int, timeout: float) -> dict[str, float | str | None]:
    """Cost and results of one film in one scene."""
    with tempfile.TemporaryDirectory() as out:
        report = ("lubrication.report=.true.",) if film.reports else ()
        answers = run(program, case, out, (*film.overrides, *report), timeout)   # the first run computes the table of a film
        seconds = answers.get("wall_time")
        if film.repeats and "stopped" not in answers:
            seconds = min(run(program, case, out, film.overrides, timeout)["wall_time"] for _ in range(repeat))
    if "film_energy_lost" in answers:   # also by shear that does not act, so that films with and without its moment can be compared
        answers["film_energy_lost"] += answers.get("neglected_shear_loss", 0.0)
    wanted = ("stopped", "rhs_evaluations", "min_film_thickness", "max_film_pressure", "film_energy_lost", "film_table_error")
    return {"seconds": seconds, "instructions": instructions(program, case, film, timeout), **{key: answers.get(key) for key in wanted}}


def line(case: str, film: str, row: dict[str, float | str | None], yardstick: dict[str, float | str | None]) -> str:
    def cell(key: str, text: str, factor: float = 1.0) -> str:
        return text.format(factor * row[key]) if row.get(key) is not None else ""

    thinnest = row.get("min_film_thickness")
    each = row.get("instructions")
    over = f"{each / yardstick['instructions']:.2g}" if each and yardstick.get("instructions") else ""
    whole, over_whole = "", ""
    if each and row.get("rhs_evaluations"):
        whole = f"{1e-6 * each * row['rhs_evaluations']:.3g}"
        if yardstick.get("instructions") and not row.get("stopped"):
            over_whole = f"{each * row['rhs_evaluations'] / yardstick['instructions'] / yardstick['rhs_evaluations']:.3g}"
    cells = [f"`{case}`", film, cell("rhs_evaluations", "{:.0f}"), f"{each:.4g}" if each else "", over,
             whole, over_whole, cell("seconds", "{:.3g}", 1e3),
             "" if thinnest is None else f"{1e6 * thinnest:.3f}" if thinnest > 0 else f"{1e6 * thinnest:.1f}, contact",
             cell("max_film_pressure", "{:.4g}", 1e-6), cell("film_energy_lost", "{:.4g}", 1e3), row.get("stopped") or ""]
    return "| " + " | ".join(cells) + " |"


def write_table(program: Path, cases: list[Path], repeat: int, timeout: float, out: Path) -> None:
    """Measure the rows that are missing, and write the table to data/measured."""
    kept = out / "films.json"
    rows: dict[str, dict] = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    mark = hashlib.sha1(program.read_bytes()).hexdigest()[:10]
    lines = []
    for case in cases:
        text = hashlib.sha1(case.read_bytes()).hexdigest()[:10]
        found = {}
        for film in FILMS:
            key = " ".join((mark, text, str(repeat), *film.overrides))
            if key not in rows:
                rows[key] = measure(program, case.resolve(), film, repeat, timeout)
                kept.parent.mkdir(parents=True, exist_ok=True)
                kept.write_text(json.dumps(rows, indent=1), encoding="utf-8")
            found[film.name] = rows[key]
            print(line(case.stem, film.name, rows[key], found.get(YARDSTICK, {})), flush=True)
        lines += [line(case.stem, film.name, found[film.name], found[YARDSTICK]) for film in FILMS]
    names = " ".join(str(case) for case in cases)
    print(write_measured("films", "Films against each other", f"scripts/bench/measure_tradeoff.py --films {names}", HEAD + "\n".join(lines)))


HEAD = """Each scene with every film, integrated by `auto` at a relative tolerance of 1e-6. "Instructions each" are the instructions of one evaluation of
the whole scene with its share of the integrator, counted by valgrind; "in the run" is this number times the evaluations. The columns "over"
are ratios to `closed_form` in the same scene. Times are the shortest of several runs (`as_printed` and `direct`: of one run) and depend on the
load of the computer. The oscillating film follows the motion of the ideal mechanism and does not resist the motion of the pin's centre, so
it may add energy.

| case | film | evaluations | instructions each | over | in the run [10^6] | over | time [ms] | smallest film thickness [um] | largest pressure [MPa] | energy dissipated in the film [mJ] | |
|---|---|---|---|---|---|---|---|---|---|---|---|
"""
