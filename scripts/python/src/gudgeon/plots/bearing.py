"""Pictures of a bearing under its load: the orbit of the pin in the clearance circle; all bearings of an engine along its shaft."""

import re

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.names import PLACES
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, WIDTH
from gudgeon.results import Run
from gudgeon.results import numbered as numbered_groups
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.patches import Rectangle
from matplotlib.ticker import MultipleLocator

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
    drawing = plt.figure(figsize=(WIDTH, 0.66 * WIDTH))
    axes = drawing.subplot_mosaic([["fixed", "turning"], ["fixed", "film"]], width_ratios=[1.75, 1])
    left, right, film = axes["fixed"], axes["turning"], axes["film"]
    thinnest, largest = int(np.argmin(thickness)), float(np.abs(load).max())
    draw_circle(left, place_in_circle, thinnest)
    draw_load(left, load / largest, largest)
    draw_strokes(left, place_in_circle, angle, cycle)
    draw_quarters(left, place_in_circle, angle, cycle)
    fine = np.linspace(0, len(angle) - 1, PARTS * (len(angle) - 1) + 1)
    place_then, load_then = (np.interp(fine, np.arange(len(angle)), values) for values in (place_in_circle, load))
    turned = place_then * np.exp(-1j * np.angle(load_then))
    draw_circle(right, turned, PARTS * thinnest)
    right.plot(turned.imag, turned.real, color=BLUE)
    right.annotate("", (0, 1), (0, 0), arrowprops={"arrowstyle": "->", "color": ORANGE, "linewidth": 0.8})
    left.set_title("fixed axes: x up, angles of the crank [deg]", loc="left")
    right.set_title("axes of the load", loc="left")
    within = (angle + 1e-6) % cycle
    order = np.argsort(within, kind="stable")
    film.plot(within[order], 1e6 * thickness[order], color=BLUE)
    mark_least(film, within[order], 1e6 * thickness[order], cycle)
    film.set_xlabel("crank angle [deg]")
    film.set_ylabel("film thickness [µm]")
    film.set_ylim(0)
    film.xaxis.set_major_locator(MultipleLocator(180))
    left.legend(loc="upper left", bbox_to_anchor=(0, 0.0), ncols=4, columnspacing=1, handlelength=1.2)
    where = "bearing" if "bearing_load" in run.case else place.replace("_", " ")
    least, then = (float(run.summary.get(f"{prefix}cycle_min_film_thickness{what}", (found, ""))[0])   # which may be between two rows
                   for what, found in (("", thickness[thinnest]), ("_angle", angle[thinnest])))
    words = f"thinnest film {1e6 * least:.3g} µm of {1e6 * clearance:.4g} µm, crank at {then % cycle:.1f}°"
    drawing.suptitle(f"{language.current.keep(name)}: {where}, {words}")
    return drawing


def mark_least(axes: Axes, x: np.ndarray, y: np.ndarray, cycle: float) -> None:
    """A dot at the least value of a curve, and the words "thinnest film" below or above it, where they miss the curve and the axes."""
    least, wide, high, point = int(np.argmin(y)), 0.36 * cycle, 0.08 * y.max(), 0.009 * y.max()   # of the words; of a point of type
    places = [(part, away) for away in (-6, 6, 12, 18, 24) for part in (0.5, 1.0, 0.0)]

    def misses(part: float, away: int) -> bool:
        left, low = x[least] - part * wide, y[least] + away * point - (high if away < 0 else 0)
        there = y[(x >= left) & (x <= left + wide)]
        return low > 0 and left >= 0 and left + wide <= cycle and not ((there > low) & (there < low + high)).any()

    part, away = next((place for place in places if misses(*place)), places[1])
    axes.plot(x[least], y[least], "o", color=VERMILION, markersize=4)
    axes.annotate("thinnest film", (x[least], y[least]), (0, away), textcoords="offset points", color=VERMILION, fontsize=7,
                  ha={0.5: "center", 1.0: "right", 0.0: "left"}[part], va="bottom" if away > 0 else "top")


def run_cycle(run: Run) -> float:
    """Crank angle of the cycle [rad]."""
    turns = run.summary.get("cycle_revolutions")
    return 2 * np.pi * float(turns[0]) if turns else run.cycle


def first_angle(run: Run) -> float:
    """Where an axis of the crank angle in the last cycle begins [degrees]: at -360 for two revolutions whose largest pressure is within
    90 degrees of 0 or 720, where an axis from 0 would cut it in two; else at 0."""
    gas = next((name for name in ("cylinder_pressure", "gas_force") if name in run), None)
    if gas is None or round(run_cycle(run) / np.pi) != 4:
        return 0.0
    rows = last_cycle(run)
    peak = np.degrees(run["crank_angle"][rows][np.argmax(run[gas][rows])]) % 720
    return -360.0 if min(peak, 720 - peak) < 90 else 0.0


def draw_circle(axes: Axes, track: np.ndarray, thinnest: int) -> None:
    """The clearance circle, and the thinnest film of an orbit of complex places over the clearance."""
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 361))
    axes.plot(circle.imag, circle.real, color=BLACK, linewidth=1)
    place = track[thinnest]
    axes.plot([0, place.imag / abs(place)], [0, place.real / abs(place)], color=VERMILION, linewidth=0.6, linestyle="--")
    axes.plot(place.imag, place.real, "o", color=VERMILION, markersize=4, zorder=4)
    axes.set_aspect("equal")
    axes.axis("off")


def draw_load(axes: Axes, load: np.ndarray, largest: float) -> None:
    """The load over its largest value [N] as a light area, with a bar for its size."""
    axes.fill(load.imag, load.real, facecolor=ORANGE, alpha=0.22, edgecolor=ORANGE, linewidth=0.5)
    bar = float(f"{0.5 * largest:.0e}")
    axes.plot([-1, -1 + bar / largest], [-1.3, -1.3], color=ORANGE, linewidth=2, solid_capstyle="butt")
    axes.text(-0.97 + bar / largest, -1.3, f"load, {1e-3 * bar:g} kN", fontsize=7, va="center")


def draw_strokes(axes: Axes, track: np.ndarray, angle: np.ndarray, cycle: float) -> None:
    """An orbit with a colour for each stroke, angles [deg] counted within the cycle."""
    stroke = np.floor((angle % cycle) / 180 + 1e-9).astype(int)
    for number, colour in zip(range(int(cycle // 180)), (BLUE, GREEN, PURPLE, SKY) * 4):
        rows = stroke == number
        rows[1:] |= rows[:-1]   # to where the next one begins
        line = np.where(rows, track, complex(np.nan, np.nan))
        axes.plot(line.imag, line.real, color=colour, linewidth=1.2, label=f"{180 * number}–{180 * number + 180}°")


def draw_quarters(axes: Axes, track: np.ndarray, angle: np.ndarray, cycle: float) -> None:
    """The crank's quarters [deg], counted within the cycle, as dots with numbers outside of the circle, which are kept apart."""
    first = 90 * np.ceil(angle.min() / 90 - 1e-6)
    quarters = np.arange(first, min(angle.max(), first + cycle - 90) + 1e-6, 90)
    places = np.array([track[int(np.argmin(np.abs(angle - quarter)))] for quarter in quarters])
    order = np.argsort(np.angle(places))
    around = np.angle(places)[order]
    for _ in range(200):
        gaps = np.diff(around, append=around[0] + 2 * np.pi)
        push = 0.5 * np.maximum(0.18 - gaps, 0)
        around = around - push + np.roll(push, 1)
    for k, direction in zip(order, around):
        place, at = places[k], 1.14 * np.exp(1j * direction)
        axes.plot(place.imag, place.real, "o", color=BLACK, markersize=2.5, zorder=3)
        axes.annotate(f"{quarters[k] % cycle:.0f}", (place.imag, place.real), (at.imag, at.real), fontsize=7, ha="center", va="center",
                      arrowprops={"arrowstyle": "-", "color": GREY, "linewidth": 0.4, "shrinkA": 0, "shrinkB": 0})
    axes.set_xlim(-1.25, 1.25)
    axes.set_ylim(-1.4, 1.25)


def numbered(run: Run) -> dict[str, tuple[int, ...]]:
    """Numbers of the main bearings and crank pins of an engine that the rows of a run have."""
    return {place: tuple(int(found[1]) for name in run.trace.columns if (found := re.fullmatch(rf"{place}_(\d+)_film_thickness", name)))
            for place in ("main_bearing", "crank_pin")}


def engine(run: Run, name: str) -> Drawing:
    """Orbits of all numbered bearings along a drawing of the shaft, with their thinnest films, and their losses; x upwards, y to the right."""
    bearings = numbered(run)
    cylinders = numbered_groups(run.case, "cylinder")
    phases = [float(one.get("phase_deg", 0)) for one in cylinders]
    throws = [int(one.get("throw", 0)) or i + 1 for i, one in enumerate(cylinders)]
    n = max([*throws, *(number - 1 for number in bearings["main_bearing"])])
    drawing, (shaft, losses) = plt.subplots(2, 1, figsize=(WIDTH, 0.98 * WIDTH), height_ratios=[3.6, 1], sharex=True)
    ups = {throw: np.cos(np.radians(phase - phases[0])) >= -1e-9 for throw, phase in zip(throws, phases, strict=True)}
    draw_shaft(shaft, [ups.get(throw, True) for throw in range(1, n + 1)])
    labels, places = [], []
    for place, height in (("main_bearing", -1.6), ("crank_pin", 1.75)):
        for number in bearings[place]:
            if place == "main_bearing":
                at = 2.0 * (number - 1)
            else:
                sharing = [i for i, throw in enumerate(throws) if throw == throws[number - 1]]
                at = 2.0 * throws[number - 1] - 1 + 0.9 * (sharing.index(number - 1) - (len(sharing) - 1) / 2)
            prefix = f"{place}_{number}_"
            draw_small_orbit(shaft, run, prefix, at, height)
            thickness, angle, loss = (float(run.summary[f"{prefix}cycle_{what}"][0]) for what in
                                      ("min_film_thickness", "min_film_thickness_angle", "mean_film_power"))
            label = f"{PLACES[place][1]} {number}"
            shaft.text(at, height + 0.9 * np.sign(height), f"{label}\n{1e6 * thickness:.3g} µm\n{angle:.0f}°", ha="center",
                       va="bottom" if height > 0 else "top", fontsize=6)
            losses.bar(at, loss, width=0.5, color=BLUE if place == "main_bearing" else ORANGE)
            labels.append(label)
            places.append(at)
    shaft.set_ylim(-3.35, 3.5)
    shaft.set_xlim(-1, 2 * n + 1)
    shaft.axis("off")
    losses.set_ylabel("loss [W]")
    losses.set_xticks(places, [label.replace("main bearing", "main").replace("crank pin", "pin") for label in labels], fontsize=6)
    thinnest = run.summary["cycle_thinnest_bearing"][0]
    thickness = float(run.summary[f"{thinnest}_cycle_min_film_thickness"][0])
    drawing.suptitle(f"{language.current.keep(name)}: thinnest film {1e6 * thickness:.3g} µm at {thinnest.replace('_', ' ')}, "
                     f"bearings {float(run.summary['cycle_bearings_power'][0]):.4g} W")
    return drawing


def draw_shaft(axes: Axes, ups: list[bool]) -> None:
    """A crankshaft from the side: journals of the main bearings, and throws up or down."""
    high = 0.55
    for b in range(len(ups) + 1):
        axes.add_patch(Rectangle((2 * b - 0.45, -0.2), 0.9, 0.4, facecolor="#DDDDDD", edgecolor=BLACK, linewidth=0.6))
    for j, up in enumerate(ups):
        middle, pin = 2 * j + 1, high if up else -high
        for side in (-0.45, 0.45):
            axes.add_patch(Rectangle((middle + side - 0.1, min(-0.2, pin - 0.18)), 0.2, abs(pin) + 0.38, facecolor="white",
                                     edgecolor=BLACK, linewidth=0.6))
        axes.add_patch(Rectangle((middle - 0.35, pin - 0.15), 0.7, 0.3, facecolor="#DDDDDD", edgecolor=BLACK, linewidth=0.6))


def draw_small_orbit(axes: Axes, run: Run, prefix: str, at: float, height: float) -> None:
    """The orbit of a bearing in its clearance circle, at a place of the picture, with its thinnest film."""
    rows = last_cycle(run)
    x, y, thickness = (run[f"{prefix}{quantity}"][rows] for quantity in ("eccentricity_x", "eccentricity_y", "film_thickness"))
    clearance = float(np.median(thickness + np.hypot(x, y)))
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 181))
    size = 0.85
    axes.plot(at + size * circle.imag, height + size * circle.real, color=BLACK, linewidth=0.8)
    axes.plot(at + size * y / clearance, height + size * x / clearance, color=BLUE)
    thinnest = int(np.argmin(thickness))
    axes.plot(at + size * y[thinnest] / clearance, height + size * x[thinnest] / clearance, "o", color=VERMILION, markersize=3)
    axes.set_aspect("equal")
