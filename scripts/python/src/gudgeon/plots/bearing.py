"""Pictures of a bearing under its load: the orbit of the pin in the clearance circle."""

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.names import PLACES
from gudgeon.plots.style import BLACK, BLUE, GREY, ORANGE, VERMILION, WIDTH
from gudgeon.results import Run
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

#: The largest load in the picture, over the radius of the clearance circle.
LOAD_RADIUS = 1.25

#: Parts into which the steps between rows are divided in the axes of the load: it may turn fast between two rows.
PARTS = 16


def has_film(run: Run, place: str) -> bool:
    prefix, _ = PLACES[place]
    return f"{prefix}film_force_x" in run and f"{prefix}eccentricity_x" in run


def last_cycle(run: Run) -> np.ndarray:
    """The rows of the last whole cycle: that of the summary, or the last one in which the loads repeat."""
    time, angle = run["time"], run["crank_angle"]
    start, duration = (float(run.summary[name][0]) if name in run.summary else np.nan for name in ("cycle_start", "cycle_duration"))
    if np.isfinite(start):
        inside = (time >= start * (1 - 1e-9)) & (time <= (start + duration) * (1 + 1e-9))
        if np.count_nonzero(inside) > 2:
            return inside
    return np.abs(angle - angle[-1]) <= run.cycle * (1 + 1e-9)


def orbit(run: Run, place: str, name: str) -> Drawing:
    """The orbit in fixed axes and in axes that turn with the load, over the clearance; x upwards, y to the right."""
    prefix, _ = PLACES[place]
    rows = last_cycle(run)
    own = f"{prefix}film_eccentricity" if f"{prefix}film_eccentricity_x" in run else f"{prefix}eccentricity"
    x, y = run[f"{own}_x"][rows], run[f"{own}_y"][rows]
    thickness = run[f"{prefix}film_thickness"][rows]
    clearance = float(np.median(thickness + np.hypot(x, y)))
    load = -(run[f"{prefix}film_force_x"] + 1j * run[f"{prefix}film_force_y"])[rows]
    place_in_circle = (x + 1j * y) / clearance
    angle = np.degrees(run["crank_angle"][rows])
    cycle = np.degrees(run_cycle(run))
    drawing, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 0.58 * WIDTH))
    scale = LOAD_RADIUS / np.abs(load).max()
    left.plot(scale * load.imag, scale * load.real, color=ORANGE, linewidth=0.6, label=f"load, up to {1e-3 * np.abs(load).max():.3g} kN")
    thinnest = int(np.argmin(thickness))
    ends = scale * load[thinnest]
    left.annotate("", (ends.imag, ends.real), (0, 0), arrowprops={"arrowstyle": "->", "color": ORANGE, "linewidth": 0.8})
    right.annotate("", (0, LOAD_RADIUS), (0, 0), arrowprops={"arrowstyle": "->", "color": ORANGE, "linewidth": 0.8})
    draw_orbit(left, place_in_circle, angle, thinnest, cycle)
    fine = np.linspace(0, len(angle) - 1, PARTS * (len(angle) - 1) + 1)
    place_then, load_then, angle_then = (np.interp(fine, np.arange(len(angle)), values) for values in (place_in_circle, load, angle))
    draw_orbit(right, place_then * np.exp(-1j * np.angle(load_then)), angle_then, PARTS * thinnest, cycle)
    left.set_title("fixed axes", loc="left")
    right.set_title("axes of the load", loc="left")
    right.plot([], [], color=BLUE, label="pin, dots every 90° of the crank")
    right.plot([], [], "o", color=VERMILION, markersize=4, label="thinnest film")
    for axes in (left, right):
        axes.legend(loc="upper left", bbox_to_anchor=(0, 0.0), ncols=2)
    where = "bearing" if "bearing_load" in run.case else place.replace("_", " ")
    words = f"thinnest film {1e6 * thickness[thinnest]:.3g} µm of {1e6 * clearance:.4g} µm, crank at {angle[thinnest] % cycle:.1f}°"
    drawing.suptitle(f"{language.current.keep(name)}: {where}, {words}")
    return drawing


def run_cycle(run: Run) -> float:
    """Crank angle of the cycle [rad]."""
    turns = run.summary.get("cycle_revolutions")
    return 2 * np.pi * float(turns[0]) if turns else run.cycle


def draw_orbit(axes: Axes, track: np.ndarray, angle: np.ndarray, thinnest: int, cycle: float) -> None:
    """One orbit of complex places over the clearance, with the crank's quarters, which are counted within the cycle [deg], and the
    thinnest film."""
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 361))
    axes.plot(circle.imag, circle.real, color=BLACK, linewidth=1)
    axes.plot(0.5 * circle.imag, 0.5 * circle.real, color=GREY, linewidth=0.4, linestyle=":")
    axes.plot(track.imag, track.real, color=BLUE)
    first = 90 * np.ceil(angle.min() / 90 - 1e-6)
    for quarter in np.arange(first, min(angle.max(), first + cycle - 90) + 1e-6, 90):
        row = int(np.argmin(np.abs(angle - quarter)))
        axes.plot(track[row].imag, track[row].real, "o", color=BLUE, markersize=2)
        axes.annotate(f"{quarter % cycle:.0f}", (track[row].imag, track[row].real), (2, 2), textcoords="offset points",
                      fontsize=6, color=BLUE)
    axes.plot(track[thinnest].imag, track[thinnest].real, "o", color=VERMILION, markersize=4)
    axes.plot([0, track[thinnest].imag / abs(track[thinnest])], [0, track[thinnest].real / abs(track[thinnest])], color=VERMILION,
              linewidth=0.6, linestyle="--")
    axes.set_aspect("equal")
    axes.set_xlim(-1.3, 1.3)
    axes.set_ylim(-1.3, 1.3)
    axes.axis("off")
