"""The quantities of a run that a figure can show. A new quantity is a new entry of QUANTITIES."""

from dataclasses import replace

import numpy as np
from gudgeon.plots import gas as gas_pictures
from gudgeon.plots import laws as contact_pictures
from gudgeon.plots.quantity import (
    Quantity,
    abscissa,
    after_start,
    column,
    curve_name,
    first_revolution,
    mark_abscissa,
    series,
    start_is_cut,
)
from gudgeon.plots.style import BLACK, GREY, PURPLE, mark_decades
from gudgeon.results import Run
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator

#: If points taken once a cycle spread over less than this share of the run's range, the axis still covers this share.
LEAST_SHARE = 1e-5

#: Crank angle in the cycle at which points are taken once a cycle [rad]: neither velocity nor acceleration is stationary there.
SECTION = np.pi / 4

#: Number of cycles with a point, the last of the run.
SECTION_CYCLES = 60

#: The samples show the largest force of a contact if one of them has at least this share of it.
SEEN_PEAK = 0.98

#: Lower end of the axis of the film thickness for runs with contacts [um], since the thickness passes through 0.
LEAST_DRAWN_FILM = 0.1


def pin_force(run: Run) -> np.ndarray:
    """Size of the joint's force on the pin [kN]."""
    return 1e-3 * np.hypot(run["pin_force_x"], run["pin_force_y"])


def contact_peaks(axis: Axes, run: Run) -> None:
    """Mark the largest force of those contacts whose peak lies between the samples of the trace."""
    contacts = run.contacts
    contacts = contacts[contacts["end"] >= run["time"][0]]
    time, force = run["time"], pin_force(run)
    missed = []
    for begin, end, peak in zip(contacts["begin"], contacts["end"], 1e-3 * contacts["force"]):
        rows = force[np.searchsorted(time, begin) : np.searchsorted(time, end, side="right")]
        if rows.size == 0 or rows.max() < SEEN_PEAK * peak:
            missed.append((np.interp(0.5 * (begin + end), time, abscissa(run)[0]), peak))
    if missed:
        axis.plot(*zip(*missed), ".", color=PURPLE, markersize=3, label="largest normal force of a contact, between samples")


def film_thickness(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    """Film thickness on a logarithmic axis, with gaps where the pin is in contact."""
    x, _ = abscissa(run)
    h = 1e6 * run["film_thickness"]
    axis.plot(x, np.where(h > 0, h, np.nan), color=colour, label=curve_name(run))
    axis.set_yscale("log")
    if touches(run):
        axis.set_ylim(bottom=max(axis.get_ylim()[0], LEAST_DRAWN_FILM))
    mark_decades(axis.yaxis)
    mark_abscissa(axis, run)


def penetration(axis: Axes, run: Run, _colour: str) -> None:
    """Penetration of the pin into its bearing, positive upwards; the start is cut off if it would flatten the rest."""
    x, _ = abscissa(run)
    depth = np.maximum(-1e6 * run["film_thickness"], 0.0)
    axis.fill_between(x, depth, 0, color=PURPLE, alpha=0.25, linewidth=0)
    axis.plot(x, depth, color=PURPLE, linewidth=0.5, label="in contact")
    axis.set_ylim(bottom=0)
    if start_is_cut(run, depth):
        axis.set_ylim(0, 1.06 * depth[after_start(run)].max())
        axis.set_title(f"start to {max(depth.max(), -least_film_thickness(run)):.3g} cut off", color=GREY)
    mark_abscissa(axis, run)


def touches(run: Run) -> bool:
    return bool((run["film_thickness"] < 0).any())


def least_film_thickness(run: Run) -> float:
    """The run's smallest film thickness [um], of all steps if the summary has it."""
    return 1e6 * float(run.summary.get("min_film_thickness", (run["film_thickness"].min(), ""))[0])


def least_film(run: Run) -> str:
    """The run's smallest film thickness or largest penetration."""
    least = least_film_thickness(run)
    return f"smallest film thickness {least:.3g} µm" if least >= 0 else f"deepest penetration {-least:.3g} µm"


def pin_orbit(axis: Axes, run: Run, _ideal: Run | None, colour: str) -> None:
    """The pin's centre in the clearance circle, along the cylinder axis (x) upwards."""
    x, y = run["eccentricity_x"] / run.clearance, run["eccentricity_y"] / run.clearance
    outside = run["film_thickness"] < 0
    near = outside.copy()
    near[1:] |= outside[:-1]
    near[:-1] |= outside[1:]
    axis.add_patch(Circle((0, 0), 1, fill=False, edgecolor=BLACK, linewidth=0.8, zorder=3))
    if not outside.all():
        axis.plot(np.where(outside, np.nan, y), np.where(outside, np.nan, x), color=colour, linewidth=0.6, label=curve_name(run))
    if outside.any():
        thin = 0.6 if len(x) < 20000 else 0.3
        axis.plot(np.where(near, y, np.nan), np.where(near, x, np.nan), color=PURPLE, linewidth=thin, label="in contact")
    axis.plot(y[0], x[0], "o", color=BLACK, markersize=3, markerfacecolor="white", zorder=4, label="beginning")
    reach = 1.05 * max(1.0, np.hypot(x, y).max())
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")
    axis.set_xlabel(r"$e_y/c$")


def last_cycle(run: Run) -> Run:
    """The rows of a run's last cycle; all rows of a window of later revolutions."""
    if first_revolution(run) > 0:
        return run
    travel = np.abs(run["crank_angle"] - run["crank_angle"][0])
    return replace(run, trace=run.trace[travel >= travel[-1] - run.cycle * (1 + 1e-9)].reset_index(drop=True))


def portrait(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
    """Piston acceleration over velocity in the last cycle. The curve of the ideal joint is broad and lies behind."""
    if ideal is not None:
        shown = last_cycle(ideal)
        axis.plot(
            shown["piston_velocity"],
            1e-3 * shown["piston_acceleration"],
            color=GREY,
            linewidth=2.2,
            alpha=0.5,
            label="ideal joint",
        )
    shown = last_cycle(run)
    axis.plot(shown["piston_velocity"], 1e-3 * shown["piston_acceleration"], color=colour, linewidth=0.6, label=curve_name(run))
    axis.set_xlabel("piston velocity [m/s]")
    axis.margins(x=0.05)


def portrait_difference(axis: Axes, run: Run, ideal: Run, colour: str) -> None:
    """Piston acceleration minus that of the ideal joint at the same crank angle, over velocity."""
    shown = last_cycle(run)
    other = np.interp(np.abs(shown["crank_angle"]), np.abs(ideal["crank_angle"]), ideal["piston_acceleration"])
    axis.axhline(0, color=BLACK, linewidth=0.7)
    axis.plot(shown["piston_velocity"], 1e-3 * (shown["piston_acceleration"] - other), color=colour, linewidth=0.6)
    axis.set_xlabel("piston velocity [m/s]")
    axis.set_title("run − ideal joint", color=GREY)
    axis.margins(x=0.05)


def cycle_note(run: Run) -> str:
    """The cycle that a portrait shows, as text."""
    if first_revolution(run) > 0:
        return ""
    cycles = round(abs(run["crank_angle"][-1] - run["crank_angle"][0]) / run.cycle)
    return f"cycle {cycles}"


def once_a_cycle(run: Run, section: float) -> tuple[np.ndarray, np.ndarray]:
    """Piston velocity [m/s] and acceleration [m/s2] whenever the crank angle passes `section` [rad] of a cycle. The start
    is left out: there the pin is placed in the centre."""
    angle = run["crank_angle"]
    ahead = np.maximum.accumulate(angle)
    first = np.floor((angle[0] - section) / run.cycle + 1e-9) + 1
    last = np.floor((ahead[-1] - section) / run.cycle + 1e-9)
    at = section + run.cycle * np.arange(first, last + 1)
    return np.interp(at, ahead, run["piston_velocity"]), np.interp(at, ahead, run["piston_acceleration"])


def section(axis: Axes, run: Run, ideal: Run | None, colour: str) -> None:
    """One point for each of the last cycles of a long run, from light to dark."""
    if ideal is not None:
        velocity, acceleration = once_a_cycle(ideal, SECTION)
        axis.plot(
            velocity[-SECTION_CYCLES:],
            1e-3 * acceleration[-SECTION_CYCLES:],
            "+",
            color=BLACK,
            markersize=6,
            markeredgewidth=0.6,
            label="ideal joint, once a cycle",
        )
    velocity, acceleration = once_a_cycle(run, SECTION)
    count = len(velocity)
    velocity, acceleration = velocity[-SECTION_CYCLES:], acceleration[-SECTION_CYCLES:]
    shades = LinearSegmentedColormap.from_list("cycles", ["#DDDDDD", colour, BLACK])(np.linspace(0.1, 0.8, len(velocity)))
    axis.scatter(velocity, 1e-3 * acceleration, s=7, c=shades, linewidths=0, label="once a cycle, light to dark")
    axis.set_title(f"cycles {count - len(velocity) + 1} to {count}", color=GREY)
    axis.set_xlabel("piston velocity [m/s]")
    axis.margins(0.12)
    axis.set_xlim(widened(axis.get_xlim(), LEAST_SHARE * np.ptp(run["piston_velocity"])))
    axis.set_ylim(widened(axis.get_ylim(), 1e-3 * LEAST_SHARE * np.ptp(run["piston_acceleration"])))
    axis.xaxis.set_major_locator(MaxNLocator(2, steps=[1, 2, 5, 10]))
    axis.yaxis.set_major_locator(MaxNLocator(5))


def widened(bounds: tuple[float, float], least: float) -> tuple[float, float]:
    """A range that is not narrower than `least`, so that points that agree to many digits appear as one point."""
    middle, half = 0.5 * (bounds[0] + bounds[1]), 0.5 * max(least, bounds[1] - bounds[0])
    return middle - half, middle + half


QUANTITIES: dict[str, Quantity] = {
    "crank_speed": series("crank speed\n[rad/s]", column("crank_speed")),
    "crank_acceleration": series("crank acceleration\n[10³ rad/s²]", column("crank_acceleration", 1e-3)),
    "rod_acceleration": series("rod acceleration\n[10³ rad/s²]", column("rod_acceleration", 1e-3)),
    "piston_velocity": series("piston velocity\n[m/s]", column("piston_velocity")),
    "piston_acceleration": series("piston acceleration\n[10³ m/s²]", column("piston_acceleration", 1e-3)),
    "crank_moment": series("crank moment\n[N m]", column("crank_moment")),
    "pin_force": series("pin force\n[kN]", pin_force, contact_peaks),
    "film_thickness": Quantity(
        "film thickness [µm]",
        None,
        film_thickness,
        note=least_film,
        below=penetration,
        below_label="penetration [µm]",
        has_below=touches,
        fine=True,
    ),
    "pin_orbit": Quantity(r"$e_x/c$", None, pin_orbit, wide=False, fine=True),
    "portrait": Quantity(
        "piston acceleration\n[10³ m/s²]",
        lambda run: 1e-3 * last_cycle(run)["piston_acceleration"],
        portrait,
        wide=False,
        note=cycle_note,
        difference=portrait_difference,
        fine=True,
    ),
    "section": Quantity(
        "once a cycle, $q=45°$:\npiston acceleration [10³ m/s²]", None, section, wide=False, many_cycles=True
    ),
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
