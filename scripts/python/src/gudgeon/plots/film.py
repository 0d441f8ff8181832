"""Pictures of films: the pressure in the bearing at chosen times, and the six simulations with each film."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon import language
from gudgeon.plots.style import BLACK, BLUE, GREEN, VERMILION, WIDTH, mark_decades
from gudgeon.results import Results, Run, read_table
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

SIMULATIONS = ("I", "II", "III", "IV", "V", "VI")
#: Ending of the case's name, film, colour.
FILMS = (("", "Pinkus–Sternlicht", BLUE), ("_oscillating", "oscillating", VERMILION), ("_finite", "finite length", GREEN))


def grid_of(field: pd.DataFrame) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Angles around the bore [rad] from -pi to pi, positions along its whole length [m], pressures (positions, angles) [Pa], film
    thickness at the angles [m]."""
    angle = (field["angle"] + np.pi) % (2 * np.pi) - np.pi
    table = field.assign(angle=angle).pivot(index="place", columns="angle", values="pressure")
    thickness = field.assign(angle=angle).groupby("angle")["film_thickness"].first().to_numpy()
    angles, half = table.columns.to_numpy(), table.to_numpy()
    places = np.concatenate([-table.index.to_numpy()[:0:-1], table.index.to_numpy()])
    pressure = np.concatenate([half[:0:-1], half])
    seam = 0.5 * (pressure[:, :1] + pressure[:, -1:])   # pressure at -pi and pi, midway between the outer nodes
    ends = 0.5 * (thickness[0] + thickness[-1])
    return (np.concatenate([[-np.pi], angles, [np.pi]]), places, np.hstack([seam, pressure, seam]),
            np.concatenate([[ends], thickness, [ends]]))


def pressure_fields(run: Run, fields: list[pd.DataFrame], name: str) -> Drawing:
    """One row for each time: the pressure over the unrolled bore (red: where the film of a film with memory ruptures), and the
    pressure in its middle plane with the film thickness."""
    drawing, axes = plt.subplots(len(fields), 2, figsize=(WIDTH, 0.5 + 1.75 * len(fields)), squeeze=False,
                                 gridspec_kw={"width_ratios": (3, 2)})
    for (left, right), field in zip(axes, fields):
        angles, places, pressure, thickness = grid_of(field)
        degrees, mega = np.degrees(angles), 1e-6 * pressure
        top = max(mega.max(), 1e-9)
        if "film_fraction" in field:
            empty = grid_of(field.assign(pressure=field["film_fraction"]))[2]
            left.contour(degrees, 1e3 * places, empty, levels=[0.999], colors=VERMILION, linewidths=0.8)
        mesh = left.pcolormesh(degrees, 1e3 * places, mega, cmap="viridis", vmin=0, vmax=top, shading="gouraud", rasterized=True)
        left.contour(degrees, 1e3 * places, mega, levels=top * np.array([0.02, 0.25, 0.5, 0.75]), colors="white", linewidths=0.4)
        drawing.colorbar(mesh, ax=left, pad=0.01)
        left.axvline(degrees[np.argmin(thickness)], color="white", linewidth=0.6, linestyle=":")
        time, crank = field["time"].iloc[0], np.degrees(field["crank_angle"].iloc[0]) % 720
        left.set_title(f"{1e3 * time:.4g} ms, crank at {crank:.1f}° of 720°: {mega.max():.3g} MPa, "
                       f"film {1e6 * thickness.min():.3g} µm", loc="left")
        left.set_ylabel("along the bore [mm]")
        left.grid(False)
        right.plot(degrees, mega[len(places) // 2], color=BLACK)
        right.set_ylabel("in the middle [MPa]")
        right.set_ylim(bottom=0)
        other = right.twinx()
        other.plot(degrees, 1e6 * thickness, color=BLUE)
        other.set_ylabel("film thickness [µm]", color=BLUE)
        other.set_ylim(bottom=0)
        other.grid(False)
        other.tick_params(colors=BLUE)
        for axis in (left, right):
            axis.set_xlim(-180, 180)
            axis.set_xticks(range(-180, 181, 90))
    axes[-1, 0].set_xlabel("angle in the bearing, from the cylinder axis [°]")
    axes[-1, 1].set_xlabel("angle in the bearing [°]")
    drawing.suptitle(f"{name}: pressure of the film over the bore [MPa] (dotted: where it is thinnest)")
    return drawing


def with_memory(run: Run, table: pd.DataFrame, name: str) -> Drawing:
    """A film with memory over its cycle beside the film of the run (NAME.film_history.csv): thickness, pressure, the part of the gap
    that oil fills, flow from the supply and out of the ends."""
    angle = np.degrees(table["crank_angle"].to_numpy())
    order = np.argsort(angle % 720)
    x = (angle % 720)[order]
    gap = gap_of(run)
    drawing, axes = plt.subplots(4 + bool(gap), 1, figsize=(WIDTH, 6.6 + 1.2 * bool(gap)))
    if gap:
        draw_gap(axes[0], gap)
        axes = axes[1:]
    for axis in axes[:3]:
        axis.sharex(axes[3])
        axis.tick_params(labelbottom=False)
    series = (
        (0, "min_film_thickness", 1e6, "film with memory", BLUE), (0, "quick_film_thickness", 1e6, "film of the run", GREEN),
        (1, "max_film_pressure", 1e-6, "film with memory", BLUE), (1, "quick_film_pressure", 1e-6, "film of the run", GREEN),
        (2, "film_fill", 1.0, "film with memory", BLUE),
        (3, "supply_flow", 1e6, "from the supply", BLUE), (3, "side_flow", 1e6, "out of the ends", VERMILION))
    for i, column, factor, label, colour in series:
        axes[i].plot(x, factor * table[column].to_numpy()[order], color=colour, label=label)
    for axis, label in zip(axes, ("thinnest film [µm]", "largest pressure [MPa]", "oil in the gap", "flow [ml/s]")):
        axis.set_ylabel(label)
    axes[0].set_yscale("log")
    mark_decades(axes[0].yaxis)
    axes[2].set_ylim(0, 1)
    axes[0].legend(loc="best", ncols=2)
    axes[3].legend(loc="best", ncols=2)
    axes[3].set_xlim(0, 360 if np.ptp(angle) < 361 else 720)
    axes[3].set_xticks(range(0, 361 if np.ptp(angle) < 361 else 721, 90))
    axes[3].set_xlabel("crank angle [°]")
    fed, quick = (1e6 * table[f"{which}_film_thickness"].min() for which in ("min", "quick"))
    drawing.suptitle(f"{language.current.keep(name)}: with memory the film is at least {fed:.2g} µm thick, without it {quick:.2g} µm")
    return drawing


def gap_of(run: Run) -> list[np.ndarray]:
    """Angles [deg] and the gap [m] there of a centred pin in the bearing of a film with memory, in the middle and at both ends; empty
    if its bore is round, or its table is not there or in units that are not known here."""
    case: dict[str, dict[str, Any]] = run.case
    place = next((group.removesuffix("film_history") for group in case if group.endswith(".film_history")), None)
    if place is None:   # the groups are for every bearing, and there is one
        place = next((group.removesuffix("joint") for group, keys in case.items()
                      if group.rpartition(".")[2] == "joint" and keys["kind"] != "ideal"), "")
    shape = case.get(f"{place}shape", case.get("shape"))
    if shape is None:
        return []
    joint = case[f"{place}joint"]
    angle = np.linspace(0, 360, 721)
    middle = np.full_like(angle, joint["clearance"])
    if shape["table"]:
        if not Path(shape["table"]).is_file():
            return []
        table, units = read_table(Path(shape["table"]), "angle")
        if "joint" in table:
            table = table[table["joint"].str.startswith(place[:-1] or "piston_pin")]
        depth = "bore_depth" if "joint" in table else "deviation"
        if depth not in table or (units["angle"], units[depth]) not in (("deg", "m"), ("deg", "mm"), ("deg", "um")):
            return []
        factor = shape["factor"] * {"m": 1.0, "mm": 1e-3, "um": 1e-6}[units[depth]]
        middle += factor * np.interp(angle - shape["direction_deg"], table["angle"], table[depth], period=360)
    tilt = np.outer(shape["tilt"], [1.0]) * (np.cos(np.radians(angle)), np.sin(np.radians(angle)))
    return [angle, middle, *(middle + shape["barrel"] - 0.5 * end * joint["bearing_length"] * tilt.sum(axis=0) for end in (1, -1))]


def draw_gap(axes: Axes, gap: list[np.ndarray]) -> None:
    """The gap of a centred pin over the angle of the bearing, in the middle and at both ends."""
    angle, *gaps = gap
    for values, colour, label in zip(gaps, (BLUE, GREEN, VERMILION), ("in the middle", "at one end", "at the other end")):
        axes.plot(angle, 1e6 * values, color=colour, label=label, linewidth=None if colour == BLUE else 0.6)
    axes.set_xticks(range(0, 361, 90))
    axes.set_xlim(0, 360)
    axes.set_xlabel("angle in the bearing [°]")
    axes.set_ylabel("gap, pin centred [µm]")
    axes.legend(loc="upper center")


def simulations(results: Results) -> Drawing:
    """Film thickness and pin force of the six simulations over the crank's last two revolutions, each with every film."""
    drawing, axes = plt.subplots(len(SIMULATIONS), 2, figsize=(WIDTH, 1.5 * len(SIMULATIONS)), squeeze=False)
    for (left, right), simulation in zip(axes, SIMULATIONS):
        for ending, film, colour in FILMS:
            run = results[f"sim_{simulation}{ending}"]
            turns = run["crank_angle"] / (2 * np.pi)
            last = turns >= np.floor(turns[-1] + 1e-6) - 2
            x = turns[last] - turns[last][0] + (turns[last][0] - np.floor(turns[last][0] + 1e-6))
            size = np.hypot(run["pin_force_x"], run["pin_force_y"])[last]
            shown = run["film_thickness"][last] > 0
            left.plot(x, np.where(shown, 1e6 * run["film_thickness"][last], np.nan), color=colour, label=film)
            right.plot(x, 1e-3 * size, color=colour, label=film)
        left.set_yscale("log")
        left.set_ylabel(f"{simulation}: film [µm]")
        right.set_ylabel("pin force [kN]")
        for axis in (left, right):
            axis.set_xlim(0, 2)
    for axis in axes[-1]:
        axis.set_xlabel("revolutions, the last two of the run")
    handles, labels = axes[0, 1].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=3)
    drawing.suptitle("Simulations I to VI with three films: film at its thinnest (gaps: the pin touches), pin force")
    return drawing
