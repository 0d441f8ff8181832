"""A piston in its bore over one cycle: pressure on both faces of its skirt, gaps at their ends, friction of skirt and rings, Stribeck
curves of the rings."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon import language
from gudgeon.plots.columns import crank_angles, rows_of_cycle
from gudgeon.plots.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, WIDTH
from gudgeon.results import Run
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MaxNLocator, MultipleLocator

COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
IN_A_ROW = 3   # pairs of faces
LEVELS = 14   # of pressure
ABOVE = {"loc": "lower center", "bbox_to_anchor": (0.5, 0.98)}   # place of a legend
ENDS = ("+y, top", "+y, bottom", "−y, top", "−y, bottom")


def draw(run: Run, table: pd.DataFrame | None) -> Drawing:
    """The pressures of `table` (rows of a NAME.skirt.csv, or none), then what the run has of gaps, frictions and rings."""
    fields = [] if table is None else [field for _, field in table.groupby("time", sort=True)]
    rings = [number for number in range(1, 7) if f"ring_{number}_friction_force" in run]
    has_stribeck = bool(rings) and "cylinder_pressure" in run
    kinds = ["gaps"] * ("guide_1_gap" in run and "skirt_force" in run) + ["friction"] + ["stribeck"] * has_stribeck
    maps = -(-len(fields) // IN_A_ROW)
    heights = [1.7] * maps + [1.6] * len(kinds)
    drawing = plt.figure(figsize=(WIDTH, 0.5 + sum(heights)))
    grid = drawing.add_gridspec(len(heights), 2 * IN_A_ROW, height_ratios=heights)
    if fields:
        draw_faces(drawing, [[drawing.add_subplot(grid[k // IN_A_ROW, 2 * (k % IN_A_ROW) + side]) for side in range(2)] for k in range(len(fields))], fields)
    rows = rows_of_cycle(run, -1)
    for place, kind in enumerate(kinds, maps):
        {"gaps": draw_gaps, "friction": draw_friction, "stribeck": draw_stribeck}[kind](drawing.add_subplot(grid[place, :]), run, rows)
    found = "the piston in its bore"
    if fields:
        hardest = table.loc[table["pressure"].idxmax()]
        found = f"the film carries hardest at {np.degrees(hardest['crank_angle']) % 720:.0f}°, {1e-6 * hardest['pressure']:.2g} MPa"
    drawing.suptitle(f"{language.current.keep(run.name)}: {found}")
    return drawing


def draw_faces(drawing: Drawing, axes: list[list[Axes]], fields: list[pd.DataFrame]) -> None:
    """Both faces unrolled, -y on the left, with one scale of pressures."""
    top = max(1e-6 * max(field["pressure"].max() for field in fields), 1e-9)
    for k, (pair, field) in enumerate(zip(axes, fields)):
        for axis, side in zip(pair, (-1, 1)):
            half = field[field["side"] == side].pivot(index="height", columns="angle", values="pressure")
            angles = np.concatenate([-half.columns.to_numpy()[::-1], half.columns.to_numpy()])
            pressures = 1e-6 * np.hstack([half.to_numpy()[:, ::-1], half.to_numpy()])
            mesh = axis.contourf(angles, 1e3 * half.index.to_numpy(), pressures, levels=np.linspace(0, top, LEVELS + 1), cmap="viridis")
            axis.grid(False)
            axis.xaxis.set_major_locator(MultipleLocator(30))
            axis.set_title(f"{'−y' if side < 0 else '+y'} {pressures.max():.2g} MPa", loc="left")
            axis.set_xlabel(f"at {np.degrees(field['crank_angle'].iloc[0]) % 720:.0f}°" if side < 0 else "face [°]")
            if k % IN_A_ROW or side > 0:
                axis.tick_params(labelleft=False)
            else:
                axis.set_ylabel("above the pin [mm]")
    drawing.colorbar(mesh, ax=[axis for pair in axes for axis in pair], label="pressure [MPa]", pad=0.01, ticks=MaxNLocator(6))


def over_cycle(axis: Axes, run: Run, rows: slice, column: str, factor: float, colour: str, label: str) -> None:
    """A column over the crank angle in the cycle."""
    x, order = crank_angles(run["crank_angle"][rows], run.cycle)
    axis.plot(x, factor * run[column][rows][order], color=colour, label=label)
    axis.xaxis.set_major_locator(MultipleLocator(90))
    axis.set_xlabel("crank angle [°]")


def draw_gaps(axis: Axes, run: Run, rows: slice) -> None:
    """The gaps at the four ends of the faces."""
    for number, (label, colour) in enumerate(zip(ENDS, COLOURS), 1):
        over_cycle(axis, run, rows, f"guide_{number}_gap", 1e6, colour, label)
    axis.set_ylabel("gap at an end [µm]")
    axis.set_ylim(bottom=0)
    axis.legend(ncols=4, **ABOVE)


def draw_friction(axis: Axes, run: Run, rows: slice) -> None:
    """Friction of the bore on skirt and rings."""
    if "skirt_friction_force" in run:
        over_cycle(axis, run, rows, "skirt_friction_force", 1.0, BLACK, "skirt")
    for number, colour in zip(range(1, 7), COLOURS):
        if f"ring_{number}_friction_force" in run:
            over_cycle(axis, run, rows, f"ring_{number}_friction_force", 1.0, colour, f"ring {number}")
    axis.set_ylabel("friction [N]")
    axis.legend(ncols=7, **ABOVE)


def draw_stribeck(axis: Axes, run: Run, rows: slice) -> None:
    """Friction of each ring over its load, by viscosity times speed over the load per length of its circumference: in each stroke a
    branch, which squeeze tells apart."""
    gas = next(group for group in ("combustion", "cylinder_pressure") if group in run.case)
    bore, back = float(run.parameter(gas, "bore")), float(run.parameter(gas, "crankcase_pressure", 101325.0))
    viscosity = float(run.parameter("rings.lubrication", "viscosity", 0.0))
    speed = np.abs(run["piston_velocity"][rows])
    for number, colour in zip(range(1, 7), COLOURS):
        if f"ring_{number}_friction_force" not in run:
            continue
        above, behind, below, height, tension = (float(run.parameter(f"ring_{number}", key, 0.0)) for key in ("gas_above", "gas_behind", "gas_below", "height", "tension"))
        pressed = height * (behind - (0.0 if f"ring_{number}_film_thickness" in run else 0.5 * (above + below)))   # the film has its own pressures at the edges
        closing = 2 * tension / bore
        load = np.maximum(closing + pressed * (run["cylinder_pressure"][rows] - back), 0.1 * closing)
        duty = (viscosity or 1.0) * speed / load
        axis.plot(duty, np.abs(run[f"ring_{number}_friction_force"][rows]) / (np.pi * bore * load), color=colour, label=f"ring {number}", marker=".", markersize=2, linestyle="none")
    axis.set_xscale("log")
    axis.set_xlim(left=1e-3 * axis.get_xlim()[1])
    axis.set_xlabel("viscosity × speed / load per length" if viscosity else "speed / load per length [m²/(N s)]")
    axis.set_ylabel("friction / load")
    axis.set_ylim(bottom=0)
    axis.legend(ncols=6, **ABOVE)
