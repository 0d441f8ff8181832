"""Columns of runs over time or crank angle."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.names import plain_unit, shown_unit
from gudgeon.plots import style
from gudgeon.plots.quantity import shade_uncertified
from gudgeon.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    WIDTH,
)
from gudgeon.results import Run, cycles_turned
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

COLOURS = (BLUE, VERMILION, GREEN, BLACK, ORANGE, PURPLE, SKY)

#: Columns that are drawn by default, those that the runs have.
DEFAULT = ("crank_speed", "piston_acceleration", "pin_force", "film_thickness", "cylinder_pressure")


def values_of(run: Run, column: str) -> np.ndarray:
    """A column of a run, or the magnitude of a vector of which it has the columns _x and _y. Raises MissingResult if it has neither."""
    if column not in run and f"{column}_x" in run:
        return np.hypot(run[f"{column}_x"], run[f"{column}_y"])
    return run[column]


def available(run: Run) -> list[str]:
    """The default columns that a run has and that vary."""
    there = [name for name in DEFAULT if name in run or f"{name}_x" in run]
    return [name for name in there if np.ptp(values_of(run, name)) > 0] or there


def plot_column(axis: Axes, runs: Sequence[Run], column: str, over: str = "crank_angle", cycle: int | None = None) -> None:
    """Draw one column of several runs on an axis, over "time" [ms] or "crank_angle" [deg]; `cycle` chooses one cycle, counted from 0, or
    from the end if negative."""
    values = [values_of(run, column) for run in runs]
    unit = runs[0].units.get(column, runs[0].units.get(f"{column}_x", ""))
    shown, factor = shown_unit(column, unit, np.concatenate(values))
    if unit == "K":
        shown, values = "°C", [one - 273.15 for one in values]
    for run, column_values, colour in zip(runs, values, COLOURS * len(runs)):
        rows = rows_of_cycle(run, cycle)
        x, order = 1e3 * run["time"][rows], slice(None)
        if over != "time":
            x, order = crank_angles(run["crank_angle"][rows], None if cycle is None else run.cycle)
        alone = cycle is None and len(runs) == 1
        if alone and over == "time" and column.endswith("film_thickness") and jumps_of(run, column.removesuffix("film_thickness")):
            show_least(axis, run, x, factor * column_values)
        else:
            axis.plot(x, factor * column_values[rows][order], color=colour, label=run.name)
        if alone:
            shade_uncertified(axis, run, x)
            mark_jumps(axis, run, column, x, factor * column_values)
        if over != "time":
            axis.xaxis.set_major_locator(style.CrankAngles())
    shown = plain_unit(shown)
    axis.set_ylabel(f"{column.replace('_', ' ')}\n[{shown}]" if shown else column.replace("_", " "))


def jumps_of(run: Run, place: str) -> int:
    """How often the temperature of the film of this place ("", "crank_pin_", ...) jumped to its settled value."""
    return int(float(run.summary.get(f"{place}temperature_jumps", ("0", ""))[0]))


def settled_temperature(run: Run, column: str) -> float | None:
    """The mean temperature [°C] in the last cycle of a film that has settled by jumps; None of any other column."""
    place = column.removesuffix("film_temperature")
    mean = run.summary.get(f"{place}cycle_mean_film_temperature")
    return float(mean[0]) - 273.15 if mean and place != column and jumps_of(run, place) else None


def mark_jumps(axis: Axes, run: Run, column: str, x: np.ndarray, values: np.ndarray) -> None:
    """Number the jumps of a film's temperature to its settled value: they stand for many cycles that are left out. Those that cannot be
    seen have no number. A band marks the settled value."""
    settled = settled_temperature(run, column)
    if settled is None:
        return
    axis.axhline(settled, color=ORANGE, alpha=0.4, linewidth=5, zorder=0)
    axis.annotate(f"settled: {settled:.1f} °C", (1, settled), xycoords=("axes fraction", "data"), xytext=(0, 5), textcoords="offset points", ha="right", fontsize=7)
    steps = np.abs(np.diff(values))
    rows = sorted(row for row in np.argsort(-steps)[: jumps_of(run, column.removesuffix("film_temperature"))] if steps[row] > 0.005 * np.ptp(values))
    for i, row in enumerate(rows):
        axis.axvline(x[row], color=GREY, linestyle=":", linewidth=0.8)
        axis.annotate(f"jump {i + 1}", (x[row], 0.06), xycoords=("data", "axes fraction"), xytext=(3, 0), textcoords="offset points", fontsize=7, color=GREY)


def show_least(axis: Axes, run: Run, x: np.ndarray, values: np.ndarray) -> None:
    """Draw the least value of each cycle in place of the curve: while a film warms up, its change from cycle to cycle is the question."""
    least = [rows.start + int(values[rows].argmin()) for rows in (rows_of_cycle(run, number) for number in range(whole_cycles(run)))]
    axis.plot(x[least], values[least], "o--", color=BLUE, markersize=3.5, linewidth=0.6)
    axis.margins(y=0.2)
    axis.annotate("least of each cycle", (1, 1), xycoords="axes fraction", xytext=(0, -8), textcoords="offset points", ha="right", fontsize=7)


def crank_angles(angle: np.ndarray, cycle: float | None) -> tuple[np.ndarray, np.ndarray | slice]:
    """Crank angles [deg] for an axis, and the rows in their order: of one cycle of this length [rad] counted within it, or as they
    are."""
    if cycle is None:
        return np.degrees(angle), slice(None)
    within = np.degrees(np.mod(angle + 1e-9, cycle))
    order = np.argsort(within, kind="stable")
    return within[order], order


def rows_of_cycle(run: Run, cycle: int | None) -> slice:
    """The rows of one whole cycle of a run, or all rows. The last one ends where the cycle ends whose answers are in the summary."""
    if cycle is None:
        return slice(None)
    travel = turned(run)
    wanted = cycle if cycle >= 0 else whole_cycles(run) + cycle
    found = np.flatnonzero((travel >= wanted - 1e-9) & (travel <= wanted + 1 + 1e-9))
    return slice(found[0], found[-1] + 1) if found.size else slice(0, 0)


def turned(run: Run) -> np.ndarray:
    """Cycles that the crank has turned through until each row; whole where the cycle ends whose answers are in the summary."""
    begin, length = (float(run.summary.get(f"cycle_{name}", (np.nan, ""))[0]) for name in ("start", "duration"))
    return cycles_turned(run["time"], run["crank_angle"], run.cycle, begin + length if np.isfinite(begin + length) else None)


def whole_cycles(run: Run) -> int:
    return max(int(turned(run)[-1] + 1e-6), 1)


def title_of(run: Run, columns: Sequence[str]) -> str:
    """The title or the name of the case, with the temperature to which a film has settled by jumps."""
    title = str(run.parameter("case", "title", "")) or run.name
    settled = next((found for column in columns if (found := settled_temperature(run, column)) is not None), None)
    if settled is not None:
        return f"{run.name}: the film settles at {settled:.1f} °C; each jump skips the cycles that warm it"
    return language.current.keep(title)


def draw(runs: Sequence[Run], columns: Sequence[str], over: str = "crank_angle", cycle: int | None = None) -> Drawing:
    """One axis for each column, with all runs."""
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 0.6 + 1.6 * len(columns)), sharex=True, squeeze=False)
    for axis, column in zip(axes[:, 0], columns):
        plot_column(axis, runs, column, over, cycle)
    axes[-1, 0].set_xlabel("time [ms]" if over == "time" else "crank angle [deg]")
    drawing.align_ylabels()
    if len(runs) > 1:
        style.add_legend(drawing, axes.flat)
    else:
        drawing.suptitle(title_of(runs[0], columns))
    return drawing
