"""Pressure and force of the gas over the first cycle. They depend on the crank angle alone, so the cycles are equal, and runs with
the same load share an axis, where one of them is dashed."""

from collections.abc import Callable

import numpy as np
from gudgeon.plots.quantity import colour, label
from gudgeon.results import Run
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

DASHES = ("-", (0, (4, 3)))


def each(draw: Callable[[Axes, Run, dict], None]) -> Callable[[Axes, list[Run]], None]:
    """A function that draws all runs of an axis by drawing one after the other; runs have a name if there are several."""

    def draw_all(axis: Axes, runs: list[Run]) -> None:
        for run, dashes in zip(runs, DASHES):
            look = {"color": colour(run), "linestyle": dashes, "linewidth": 0.9}
            draw(axis, run, look | ({"label": label(run)} if len(runs) > 1 else {}))

    return draw_all


def first_cycle(run: Run) -> np.ndarray:
    """The rows of the first cycle; a run begins with one."""
    return np.abs(run["crank_angle"] - run["crank_angle"][0]) <= run.cycle


def indicator(axis: Axes, run: Run, look: dict) -> None:
    rows = first_cycle(run)
    axis.plot(1e6 * run["cylinder_volume"][rows], 1e-5 * run["cylinder_pressure"][rows], **look)
    axis.set_xlabel(f"{run.volume} [cm³]")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)


def over_cycle(axis: Axes, run: Run, values: np.ndarray, look: dict) -> None:
    rows = first_cycle(run)
    axis.plot(np.degrees(run["crank_angle"][rows]), values[rows], **look)
    axis.set_xlabel("crank angle in the cycle [deg]")
    first = np.degrees(run["crank_angle"][0])
    axis.set_xlim(first, first + np.degrees(run.cycle))
    axis.xaxis.set_major_locator(MultipleLocator(180))
    axis.set_ylim(bottom=min(0.0, values.min()))


def gas_force(axis: Axes, run: Run, look: dict) -> None:
    over_cycle(axis, run, 1e-3 * run["gas_force"], look)


def cylinder_pressure(axis: Axes, run: Run, look: dict) -> None:
    over_cycle(axis, run, 1e-5 * run["cylinder_pressure"], look)
