"""What a figure can show of a run. A new quantity is a new entry of QUANTITIES."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator, MultipleLocator

from .results import Run
from .style import BLACK, CYCLE, PURPLE

#: A run's range is called far larger than the ideal joint's from this factor on: the figure then adds a detail.
FAR_LARGER = 3.0

#: Points once a cycle are spread no farther than to this share of the run's range.
LEAST_SHARE = 1e-5


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
    note: Callable[[Run], str] | None = None   # beside the run's name

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

    def is_cut(self, run: Run, ideal: Run) -> bool:
        """Whether the detail leaves part of the run out."""
        low, high = self.detail_range(ideal)
        return bool(self.values(run).min() < low or self.values(run).max() > high)


def held_speed(run: Run) -> bool:
    return run.parameter("drive", "kind") == "constant_speed"


def abscissa(run: Run) -> tuple[np.ndarray, str]:
    """Crank angle in degrees where the speed is held, else time in milliseconds."""
    if held_speed(run):
        return np.degrees(run["crank_angle"]), "crank angle [deg]"
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
        axis.xaxis.set_major_locator(MultipleLocator(step))


def ideal_line(axis: Axes, x: np.ndarray, y: np.ndarray) -> None:
    axis.plot(x, y, color=BLACK, linestyle=(0, (4, 2)), linewidth=0.7, label="ideal joint")


def series(label: str, values: Callable[[Run], np.ndarray],
           extra: Callable[[Axes, Run], None] | None = None) -> Quantity:
    """A curve over time or crank angle, the ideal joint overlaid."""

    def draw(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
        axis.plot(abscissa(run)[0], values(run), color=colour)
        if ideal is not None:
            ideal_line(axis, abscissa(ideal)[0], values(ideal))
        if extra is not None:
            extra(axis, run)
        mark_abscissa(axis, run)

    return Quantity(label, values, draw)


def column(name: str, factor: float = 1.0) -> Callable[[Run], np.ndarray]:
    return lambda run: factor * run[name]


def pin_force(run: Run) -> np.ndarray:
    """Size of the joint's force on the pin [kN]."""
    return 1e-3 * np.hypot(run["pin_force_x"], run["pin_force_y"])


def contact_peaks(axis: Axes, run: Run) -> None:
    """The largest force of each contact, from begin to end: what the samples of the trace miss."""
    contacts = run.contacts
    if contacts.empty:
        return
    scale = 1e3 if not held_speed(run) else 1.0
    begin, end = contacts["begin"], contacts["end"]
    if held_speed(run):
        speed = np.degrees(run["crank_speed"][0])
        begin, end = speed * begin + np.degrees(run["crank_angle"][0]), speed * end + np.degrees(run["crank_angle"][0])
    force = 1e-3 * contacts["force"]
    axis.hlines(force, scale * begin, scale * end, color=PURPLE, linewidth=0.9)
    axis.plot(0.5 * scale * (begin + end), force, ".", color=PURPLE, markersize=3,
              label="largest normal force of each contact")


def film_thickness(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    x, _ = abscissa(run)
    h = 1e6 * run["film_thickness"]
    axis.plot(x, h, color=colour)
    axis.axhline(0, color=BLACK, linewidth=0.7)
    if h.min() < 0:
        axis.fill_between(x, h, 0, where=h < 0, color=PURPLE, alpha=0.5, linewidth=0, label="penetration")
    else:
        axis.set_ylim(bottom=-0.03 * h.max())
    mark_abscissa(axis, run)


def least_film(run: Run) -> str:
    """The run's least film thickness, of all steps where the summary tells it."""
    least = float(run.summary.get("min_film_thickness", (run["film_thickness"].min(), ""))[0])
    return f"least {1e6 * least:.3g} µm".replace("-", "−")


def pin_orbit(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    """The pin's centre in the clearance circle, along the cylinder axis (x) upwards."""
    x, y = run["eccentricity_x"] / run.clearance, run["eccentricity_y"] / run.clearance
    outside = run["film_thickness"] < 0
    near = outside.copy()
    near[1:] |= outside[:-1]
    near[:-1] |= outside[1:]
    axis.add_patch(Circle((0, 0), 1, fill=False, edgecolor=BLACK, linewidth=0.8, zorder=3))
    axis.plot(np.where(near & outside, np.nan, y), np.where(near & outside, np.nan, x), color=colour, linewidth=0.6)
    if outside.any():
        axis.plot(np.where(near, y, np.nan), np.where(near, x, np.nan), color=PURPLE, linewidth=0.6, label="in contact")
    axis.plot(y[0], x[0], "o", color=BLACK, markersize=3, markerfacecolor="white", zorder=4, label="start")
    reach = 1.05 * max(1.0, np.hypot(x, y).max())
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")
    axis.set_xlabel(r"$e_y/c$")


def portrait(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
    axis.plot(run["piston_velocity"], 1e-3 * run["piston_acceleration"], color=colour, linewidth=0.6)
    if ideal is not None:
        last = ideal["crank_angle"] >= ideal["crank_angle"][-1] - ideal.cycle   # one turn, or the dashes fill up
        ideal_line(axis, ideal["piston_velocity"][last], 1e-3 * ideal["piston_acceleration"][last])
    axis.set_xlabel("piston velocity [m/s]")
    axis.margins(x=0.05)


def once_a_cycle(run: Run, section: float) -> tuple[np.ndarray, np.ndarray]:
    """Piston velocity [m/s] and acceleration [m/s2] each time the crank angle passes `section` [rad] of a cycle, the
    start itself left out: there the pin is placed, not moved, in the centre."""
    angle = run["crank_angle"]
    ahead = np.maximum.accumulate(angle)
    first = np.floor((angle[0] - section) / run.cycle + 1e-9) + 1
    last = np.floor((ahead[-1] - section) / run.cycle + 1e-9)
    at = section + run.cycle * np.arange(first, last + 1)
    return np.interp(at, ahead, run["piston_velocity"]), np.interp(at, ahead, run["piston_acceleration"])


def section(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
    """Once a cycle, at the gas-exchange dead centre, q = 0: first point open, then a line from point to point."""
    if ideal is not None:
        velocity, acceleration = once_a_cycle(ideal, 0.0)
        axis.plot(1e3 * velocity, 1e-3 * acceleration, "+", color=BLACK, markersize=7, markeredgewidth=0.8,
                  label="ideal joint, once a cycle")
    velocity, acceleration = once_a_cycle(run, 0.0)
    axis.plot(1e3 * velocity, 1e-3 * acceleration, "-", color=colour, linewidth=0.4, alpha=0.6)
    axis.plot(1e3 * velocity, 1e-3 * acceleration, "o", color=colour, markersize=3.5)
    axis.plot(1e3 * velocity[:1], 1e-3 * acceleration[:1], "o", color=colour, markerfacecolor="white", markersize=3.5)
    axis.set_xlabel("piston velocity [mm/s]")
    axis.margins(0.12)
    axis.set_xlim(widened(axis.get_xlim(), 1e3 * LEAST_SHARE * np.ptp(run["piston_velocity"])))
    axis.set_ylim(widened(axis.get_ylim(), 1e-3 * LEAST_SHARE * np.ptp(run["piston_acceleration"])))
    axis.xaxis.set_major_locator(MaxNLocator(4))
    axis.yaxis.set_major_locator(MaxNLocator(5))


def widened(bounds: tuple[float, float], least: float) -> tuple[float, float]:
    """A range no narrower than `least`: points that agree to many digits are shown as one."""
    middle, half = 0.5 * (bounds[0] + bounds[1]), 0.5 * max(least, bounds[1] - bounds[0])
    return middle - half, middle + half


def indicator(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    axis.plot(1e6 * run["cylinder_volume"], 1e-5 * run["cylinder_pressure"], color=colour, linewidth=0.6)
    axis.set_xlabel("volume [cm³]")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)


def gas_force(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    angle, force = fold(np.degrees(run["crank_angle"]), 1e-3 * run["gas_force"], 720.0)
    axis.plot(angle, force, color=colour, linewidth=0.6)
    axis.set_xlabel("crank angle in the cycle [deg]")
    axis.set_xlim(0, 720)
    axis.xaxis.set_major_locator(MultipleLocator(180))
    axis.set_ylim(bottom=min(0.0, force[np.isfinite(force)].min()))


def fold(angle: np.ndarray, values: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Angles modulo a period, with a gap where a new period begins."""
    folded = angle % period
    breaks = np.flatnonzero(np.diff(folded) < 0) + 1
    return np.insert(folded, breaks, np.nan), np.insert(values, breaks, np.nan)


def _release(run: Run) -> str:
    return f"heat from {float(run.parameter('combustion', 'start_deg')) - 360:+.0f}°".replace("-", "−").replace("+0", "0")


def wiebe_pressure(axis: Axes, runs: list[Run]) -> None:
    for run, colour in zip(runs, CYCLE):
        axis.plot(np.degrees(run["crank_angle"]) - 360, run["cylinder_pressure"] / run["cylinder_pressure"][0],
                  color=colour, label=_release(run))
    axis.set_xlabel("crank angle from firing dead centre [deg]")
    axis.set_xlim(-180, 180)
    axis.xaxis.set_major_locator(MultipleLocator(60))
    axis.set_ylim(bottom=0)


def wiebe_indicator(axis: Axes, runs: list[Run]) -> None:
    for run, colour in zip(runs, CYCLE):
        axis.plot(run["cylinder_volume"] / run["cylinder_volume"].max(),
                  run["cylinder_pressure"] / run["cylinder_pressure"][0], color=colour, label=_release(run))
    axis.set_xlabel(r"volume $V/V_1$")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)


QUANTITIES: dict[str, Quantity] = {
    "crank_speed": series("crank speed [rad/s]", column("crank_speed")),
    "crank_acceleration": series("crank acceleration\n[10³ rad/s²]", column("crank_acceleration", 1e-3)),
    "rod_acceleration": series("rod acceleration\n[10³ rad/s²]", column("rod_acceleration", 1e-3)),
    "piston_velocity": series("piston velocity [m/s]", column("piston_velocity")),
    "piston_acceleration": series("piston acceleration\n[10³ m/s²]", column("piston_acceleration", 1e-3)),
    "crank_moment": series("crank moment [N m]", column("crank_moment")),
    "pin_force": series("pin reaction [kN]", pin_force, contact_peaks),
    "film_thickness": Quantity("film thickness [µm]", None, film_thickness, note=least_film),
    "pin_orbit": Quantity(r"$e_x/c$", None, pin_orbit, wide=False),
    "portrait": Quantity("piston acceleration\n[10³ m/s²]", column("piston_acceleration", 1e-3), portrait, wide=False),
    "section": Quantity("once a cycle, $q=0$:\npiston acceleration [10³ m/s²]", None, section, wide=False),
    "indicator": Quantity("pressure [bar]", None, indicator, wide=False),
    "gas_force": Quantity("gas force [kN]", None, gas_force, wide=False),
    "wiebe_pressure": Quantity(r"pressure $p/p_1$", draw_all=wiebe_pressure, wide=False),
    "wiebe_indicator": Quantity(r"pressure $p/p_1$", draw_all=wiebe_indicator, wide=False),
}
