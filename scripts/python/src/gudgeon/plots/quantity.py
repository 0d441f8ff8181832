"""The ways in which quantities of runs are drawn on an axis, and what all curves share: abscissa, names, colours."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from gudgeon.plots.ringing import draw_envelope, rings, zoom_window
from gudgeon.plots.style import BLACK, BLUE, GREY, VERMILION
from gudgeon.results import Run
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

#: From this ratio of the run's range to that of the ideal joint on, the figure also has a detail of the smaller range.
FAR_LARGER = 3.0

#: Share of a run during which a pin that is released in the centre falls onto its bearing or film.
STARTING_SHARE = 0.02

#: A difference at constant speed is drawn as its range if more than this share of its stretches ring.
MOST_OF_THE_TIME = 0.5

#: The start is cut off if the rest of the run covers less than this share of the whole range.
START_CUT = 0.7


@dataclass(frozen=True)
class Quantity:
    """A way to draw runs on an axis.

    `values` returns the values on the vertical axis, from which ranges are found. `draw(axis, run, ideal, colour)` draws one run,
    or `draw_all(axis, runs)` all runs on one axis. `wide` axes show a curve over time, others a plane. `below` draws a second panel
    of a run, labelled `below_label`, if `has_below` is true for the run. A quantity with `many_cycles` is drawn from runs over
    hundreds of revolutions.
    """

    label: str
    values: Callable[[Run], np.ndarray] | None = None
    draw: Callable[[Axes, Run, Run | None, str], None] | None = None
    draw_all: Callable[[Axes, list[Run]], None] | None = None
    wide: bool = True
    note: Callable[[Run], str] | None = None  # text beside the run's name
    difference: Callable[[Axes, Run, Run, str], None] | None = None  # draws the difference, for a plane
    below: Callable[[Axes, Run, str], None] | None = None
    below_label: str = ""
    has_below: Callable[[Run], bool] = lambda run: False
    many_cycles: bool = False
    fine: bool = False  # drawn from runs with many rows in each contact

    def needs_detail(self, run: Run, ideal: Run | None) -> bool:
        """Whether peaks of the run would flatten the curve of the ideal joint."""
        if ideal is None or self.values is None:
            return False
        return np.ptp(self.values(run)) > FAR_LARGER * np.ptp(self.values(ideal)) > 0

    def detail_range(self, ideal: Run) -> tuple[float, float]:
        """The range of the ideal joint, extended on both sides to twice its width; extended upwards only if values cannot be
        negative."""
        low, high = self.values(ideal).min(), self.values(ideal).max()
        room = high - low
        return (-0.03 * high, high + room) if low >= 0 else (low - 0.5 * room, high + 0.5 * room)

    def rings(self, run: Run) -> bool:
        """Whether the curve over time would be a filled band at the width of a picture."""
        return self.wide and self.values is not None and is_band(run, self.values(run))

    def zoomed(self, run: Run, ideal: Run) -> tuple[float, float]:
        """The part of the abscissa that a zoom shows."""
        x, y = abscissa(run)[0], self.values(run)
        return zoom_window(x, y, np.interp(run["time"], ideal["time"], self.values(ideal)), x[0] + 0.1 * np.ptp(x))

    def draw_zoom(self, axis: Axes, run: Run, ideal: Run, colour: str) -> None:
        """Some of the oscillations that the envelope represents."""
        low, high = self.zoomed(run, ideal)
        x, name = abscissa(run)
        inside = (x >= low) & (x <= high)
        axis.plot(x[inside], self.values(run)[inside], color=colour, label=curve_name(run))
        ideal_line(axis, x[inside], np.interp(run["time"], ideal["time"], self.values(ideal))[inside])
        axis.set_xlim(low, high)
        axis.set_xlabel(name)
        axis.xaxis.set_major_locator(MaxNLocator(5))
        axis.set_title("zoom on the grey stretch", color=GREY)

    def draw_difference(self, axis: Axes, run: Run, ideal: Run, colour: str) -> None:
        """The run minus the ideal joint at the same time. In a run from t = 0 nothing carries the pin at first; these first moments
        are not taken into account for the range."""
        if self.difference is not None:
            self.difference(axis, run, ideal, colour)
            return
        difference = self.values(run) - np.interp(run["time"], ideal["time"], self.values(ideal))
        axis.axhline(0, color=BLACK, linewidth=0.7)
        plot_curve(axis, run, difference, colour, rings(abscissa(run)[0], difference, MOST_OF_THE_TIME))
        cut = cut_start(axis, run, difference)
        axis.set_title(f"run − ideal joint, at the same time{', start cut off' if cut else ''}", color=GREY)
        mark_abscissa(axis, run)


def shade_uncertified(axis: Axes, run: Run, abscissa: np.ndarray) -> None:
    """Shade the part of a run beyond its certified time; `abscissa` holds the horizontal value of each row, `axis` has its range."""
    if run.certified_until is None:
        return
    rows = int((run["time"] <= run.certified_until).sum())
    axis.axvspan(abscissa[max(rows - 1, 0)], abscissa[-1], color=GREY, alpha=0.18, linewidth=0, zorder=0, gid="uncertified")


def after_start(run: Run) -> np.ndarray:
    """The rows after the first moments of a run, in which a pin released in the centre falls; all rows of a later window."""
    return run["time"] >= STARTING_SHARE * run["time"][-1]


def start_is_cut(run: Run, values: np.ndarray) -> bool:
    return bool(np.ptp(values[after_start(run)]) < START_CUT * np.ptp(values))


def cut_start(axis: Axes, run: Run, values: np.ndarray, more: np.ndarray | None = None) -> bool:
    """Limit an axis to the values after the start, and to the values `more`, if the start would flatten them. Returns whether it
    did."""
    if not start_is_cut(run, values):
        return False
    counted = values[after_start(run)]
    counted = counted if more is None else np.concatenate([counted, more])
    room = 0.06 * np.ptp(counted)
    axis.set_ylim(counted.min() - room, counted.max() + room)
    return True


def start_note(values: Callable[[Run], np.ndarray]) -> Callable[[Run], str]:
    """A function that returns a note for the title if the start is cut off: the value farthest from the rest of the run."""

    def note(run: Run) -> str:
        y = values(run)
        if not start_is_cut(run, y):
            return ""
        rest = y[after_start(run)]
        low, high = rest.min() - y.min(), y.max() - rest.max()
        farthest = f"{y.max() if high > low else y.min():.3g}".replace("-", "−")
        return f"start to {farthest} cut off"

    return note


def is_band(run: Run, y: np.ndarray) -> bool:
    """Whether a curve over time oscillates faster than a picture can show. At constant speed a picture has two revolutions, in
    which single impacts can be distinguished; the start, which is cut off, is not taken into account."""
    counted = after_start(run)
    return not held_speed(run) and rings(abscissa(run)[0][counted], y[counted])


def plot_curve(axis: Axes, run: Run, y: np.ndarray, colour: str, as_band: bool = False) -> None:
    """A curve over time or crank angle; its envelope where it oscillates faster than a picture can show."""
    x = abscissa(run)[0]
    if as_band or is_band(run, y):
        draw_envelope(axis, x, y, colour)
    else:
        axis.plot(x, y, color=colour, label=curve_name(run))


def curve_name(run: Run) -> str:
    """The name of a run's curve in the legend: its film, or "with clearance"."""
    law = run.parameter("lubrication", "law")
    return label(run) if law in ("pinkus_sternlicht", "oscillating_film") and not held_speed(run) else "with clearance"


def label(run: Run) -> str:
    """Label that distinguishes a run from the others of its figure."""
    law = run.parameter("lubrication", "law")
    if law == "pinkus_sternlicht" and not held_speed(run):
        return "Pinkus–Sternlicht film"
    if law == "oscillating_film":
        return "oscillating film"
    clearance = f"c = {1e3 * run.clearance:.3g} mm"
    if law:
        return f"oil of {run.viscosity:.3g} Pa s, {clearance}"
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
    """Crank angle in degrees if the speed is constant, measured from the first whole revolution of the trace; otherwise time in
    milliseconds."""
    if held_speed(run):
        return np.degrees(run["crank_angle"]) - 360 * first_revolution(run), "crank angle [deg]"
    return 1e3 * run["time"], "time [ms]"


def mark_abscissa(axis: Axes, run: Run) -> None:
    """Set label and range of time or crank angle; angles have ticks at quarter, half or whole revolutions."""
    x, name = abscissa(run)
    axis.set_xlabel(name)
    axis.set_xlim(x[0], x[-1])
    shade_uncertified(axis, run, x)
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
    """A curve over time or crank angle, with that of the ideal joint."""

    def draw(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
        y = values(run)
        plot_curve(axis, run, y, colour)
        if ideal is not None:
            ideal_line(axis, abscissa(ideal)[0], values(ideal))
            if found.rings(run):
                axis.axvspan(*found.zoomed(run, ideal), color=GREY, alpha=0.4, linewidth=0)
        if extra is not None:
            extra(axis, run)
        cut_start(axis, run, y, None if ideal is None else values(ideal))
        mark_abscissa(axis, run)

    found = Quantity(label, values, draw, note=start_note(values), fine=True)
    return found
