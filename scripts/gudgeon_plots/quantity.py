"""How a quantity of runs is drawn on an axis, and what curves of all quantities share: abscissa, names, colours."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from .results import Run
from .style import BLACK, BLUE, GREY, VERMILION

#: A run's range is called far larger than the ideal joint's from this factor on: the figure then adds a detail.
FAR_LARGER = 3.0

#: Share of a run in which a pin released in the centre falls on its bearing or film.
STARTING_SHARE = 0.02


@dataclass(frozen=True)
class Quantity:
    """A way to draw runs on an axis.

    `values` gives what is on the vertical axis, for ranges; `draw(axis, run, ideal, colour)` draws one run, or
    `draw_all(axis, runs)` all of them on one axis. `wide` axes show a curve over time, others a plane.
    """

    label: str
    values: Callable[[Run], np.ndarray] | None = None
    draw: Callable[[Axes, Run, Run | None, str], None] | None = None
    draw_all: Callable[[Axes, list[Run]], None] | None = None
    wide: bool = True
    note: Callable[[Run], str] | None = None  # beside the run's name

    def needs_detail(self, run: Run, ideal: Run | None) -> bool:
        """Whether the ideal joint's curve would be flattened by the run's peaks."""
        if ideal is None or self.values is None:
            return False
        return np.ptp(self.values(run)) > FAR_LARGER * np.ptp(self.values(ideal)) > 0

    def detail_range(self, ideal: Run) -> tuple[float, float]:
        """The range of the ideal joint with as much room again on both sides together; above it only, for a size."""
        low, high = self.values(ideal).min(), self.values(ideal).max()
        room = high - low
        return (-0.03 * high, high + room) if low >= 0 else (low - 0.5 * room, high + 0.5 * room)

    def draw_difference(self, axis: Axes, run: Run, ideal: Run, colour: str) -> None:
        """The run less the ideal joint at the same time. A run from t = 0 begins with a pin that nothing carries yet: its
        first moments do not count for the range."""
        difference = self.values(run) - np.interp(run["time"], ideal["time"], self.values(ideal))
        counted = difference[run["time"] >= STARTING_SHARE * run["time"][-1]]
        cut = np.ptp(difference) > FAR_LARGER * np.ptp(counted)
        axis.axhline(0, color=BLACK, linewidth=0.7)
        axis.plot(abscissa(run)[0], difference, color=colour)
        if cut:
            room = 0.1 * np.ptp(counted)
            axis.set_ylim(counted.min() - room, counted.max() + room)
        axis.set_title(f"run − ideal joint, at the same time{', start cut off' if cut else ''}", color=GREY)
        mark_abscissa(axis, run)


def label(run: Run) -> str:
    """What tells a run from the others of its figure."""
    law = run.parameter("lubrication", "law")
    if law == "pinkus_sternlicht" and not held_speed(run):
        return "Pinkus–Sternlicht film"
    if law == "oscillating_film":
        return "oscillating film"
    clearance = f"c = {1e3 * run.clearance:.3g} mm"
    if law:
        return f"oil of {float(run.parameter('lubrication', 'viscosity')):.3g} Pa s, {clearance}"
    if "friction" in run.case:
        return f"friction {float(run.parameter('friction', 'coefficient')):.3g}, {clearance}"
    return clearance


def colour(run: Run) -> str:
    return VERMILION if run.parameter("lubrication", "law") == "oscillating_film" else BLUE


def held_speed(run: Run) -> bool:
    return run.parameter("drive", "kind") == "constant_speed"


def first_revolution(run: Run) -> int:
    """Whole revolutions of the crank before the trace begins."""
    return int(np.floor(run["crank_angle"][0] / (2 * np.pi) + 1e-6))


def abscissa(run: Run) -> tuple[np.ndarray, str]:
    """Crank angle in degrees where the speed is held, from the trace's first whole revolution on; else time in
    milliseconds."""
    if held_speed(run):
        return np.degrees(run["crank_angle"]) - 360 * first_revolution(run), "crank angle [deg]"
    return 1e3 * run["time"], "time [ms]"


def mark_abscissa(axis: Axes, run: Run) -> None:
    """Name and range of time or crank angle; angles are numbered in quarter, half or whole turns."""
    x, name = abscissa(run)
    axis.set_xlabel(name)
    axis.set_xlim(x[0], x[-1])
    if held_speed(run):
        step = 90.0
        while np.ptp(x) > 6 * step:
            step *= 2
        axis.set_xticks(np.arange(step * np.ceil(x[0] / step - 1e-3), x[-1] + 1e-3 * step, step))


def ideal_line(axis: Axes, x: np.ndarray, y: np.ndarray) -> None:
    axis.plot(x, y, color=BLACK, linestyle=(0, (4, 2)), linewidth=0.7, label="ideal joint")


def column(name: str, factor: float = 1.0) -> Callable[[Run], np.ndarray]:
    return lambda run: factor * run[name]


def series(
    label: str, values: Callable[[Run], np.ndarray], extra: Callable[[Axes, Run], None] | None = None
) -> Quantity:
    """A curve over time or crank angle, the ideal joint overlaid."""

    def draw(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
        axis.plot(abscissa(run)[0], values(run), color=colour)
        if ideal is not None:
            ideal_line(axis, abscissa(ideal)[0], values(ideal))
        if extra is not None:
            extra(axis, run)
        mark_abscissa(axis, run)

    return Quantity(label, values, draw)
