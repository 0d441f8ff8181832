"""What a figure can show of a run. A new quantity is a new entry of QUANTITIES."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator

from . import contact_pictures, gas_pictures
from .quantity import Quantity, abscissa, column, mark_abscissa, series
from .results import Run
from .style import BLACK, GREY, PURPLE

#: Points once a cycle are spread no farther than to this share of the run's range.
LEAST_SHARE = 1e-5


def pin_force(run: Run) -> np.ndarray:
    """Size of the joint's force on the pin [kN]."""
    return 1e-3 * np.hypot(run["pin_force_x"], run["pin_force_y"])


def contact_peaks(axis: Axes, run: Run) -> None:
    """The largest force of each contact, from begin to end: what the samples of the trace miss."""
    contacts = run.contacts
    contacts = contacts[contacts["end"] >= run["time"][0]]
    if contacts.empty:
        return
    begin, end = (np.interp(contacts[edge], run["time"], abscissa(run)[0]) for edge in ("begin", "end"))
    force = 1e-3 * contacts["force"]
    axis.hlines(force, begin, end, color=PURPLE, linewidth=0.9)
    axis.plot(
        0.5 * (begin + end),
        force,
        ".",
        color=PURPLE,
        markersize=3,
        label="largest normal force of each contact",
    )


def film_thickness(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    """Film thickness, logarithmic where the film stays open; where the pin touches, logarithmic to both sides of a linear
    stretch around 0."""
    x, _ = abscissa(run)
    h = 1e6 * run["film_thickness"]
    axis.plot(x, h, color=colour)
    if h.min() > 0:
        axis.set_yscale("log")
        axis.yaxis.set_major_formatter("{x:g}")
        axis.yaxis.set_minor_formatter(lambda value, _: f"{value:g}" if f"{value:.0e}"[0] in "25" else "")
    else:
        axis.set_yscale("symlog", linthresh=1.0)
        axis.yaxis.set_major_formatter("{x:g}")
        axis.axhline(0, color=BLACK, linewidth=0.7)
        axis.fill_between(x, h, 0, where=h < 0, color=PURPLE, alpha=0.5, linewidth=0, label="penetration")
    mark_abscissa(axis, run)


def least_film(run: Run) -> str:
    """The run's least film thickness or deepest penetration, of all steps where the summary tells it."""
    least = 1e6 * float(run.summary.get("min_film_thickness", (run["film_thickness"].min(), ""))[0])
    return f"film at least {least:.3g} µm" if least >= 0 else f"penetration up to {-least:.3g} µm"


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
    axis.plot(y[0], x[0], "o", color=BLACK, markersize=3, markerfacecolor="white", zorder=4, label="beginning")
    reach = 1.05 * max(1.0, np.hypot(x, y).max())
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")
    axis.set_xlabel(r"$e_y/c$")


def portrait(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
    """Piston acceleration over velocity. The ideal joint's is broad and lies below: over several cycles dashes fill up."""
    if ideal is not None:
        axis.plot(
            ideal["piston_velocity"],
            1e-3 * ideal["piston_acceleration"],
            color=GREY,
            linewidth=2.2,
            alpha=0.5,
            label="ideal joint",
        )
    axis.plot(run["piston_velocity"], 1e-3 * run["piston_acceleration"], color=colour, linewidth=0.6)
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
        axis.plot(
            1e3 * velocity,
            1e-3 * acceleration,
            "+",
            color=BLACK,
            markersize=7,
            markeredgewidth=0.8,
            label="ideal joint, once a cycle",
        )
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
    "indicator": Quantity("pressure [bar]", draw_all=gas_pictures.each(gas_pictures.indicator), wide=False),
    "gas_force": Quantity("gas force [kN]", draw_all=gas_pictures.each(gas_pictures.gas_force), wide=False),
    "cylinder_pressure": Quantity(
        "pressure [bar]", draw_all=gas_pictures.each(gas_pictures.cylinder_pressure), wide=False
    ),
    "contact_loop": Quantity("normal force [N]", draw_all=contact_pictures.contact_loop, wide=False),
    "penetration_speed": Quantity("penetration speed [mm/s]", draw_all=contact_pictures.penetration_speed, wide=False),
    "penetration_portrait": Quantity(
        "penetration speed [mm/s]", draw_all=contact_pictures.penetration_portrait, wide=False
    ),
    "friction": Quantity("friction force [N]", None, contact_pictures.friction, wide=False),
}
