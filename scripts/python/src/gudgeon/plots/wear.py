"""Pictures of worn surfaces: the depth of wear around pin and bore."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.names import prefixed
from gudgeon.plots import style
from gudgeon.plots.style import BLUE, VERMILION, WIDTH
from gudgeon.results import demand_numbers, read_table
from matplotlib.figure import Figure as Drawing

#: Surface, label, colour.
SURFACES = (("pin", "pin", VERMILION), ("bore", "bore", BLUE))

#: Deepest wear in the round picture, over the radius of the surface.
EXAGGERATED = 0.35


def surfaces_of(path: Path) -> list[tuple[str, pd.DataFrame]]:
    """The joints of a file NAME.wear.csv, with their rows. Joints that have not worn are left out."""
    table, _ = read_table(path, "joint", "angle", *(f"{surface}_depth" for surface, *_ in SURFACES))
    demand_numbers(path, table, ["angle", *(f"{surface}_depth" for surface, *_ in SURFACES)])
    return [(joint, rows) for joint, rows in table.groupby("joint", sort=False)
            if max(rows["pin_depth"].max(), rows["bore_depth"].max()) > 0]


def draw(worn: list[tuple[str, pd.DataFrame]], titles: list[str]) -> Drawing:
    """One row for each joint: the surfaces with exaggerated wear, and the depth over the angle."""
    drawing = plt.figure(figsize=(WIDTH, 0.6 + 2.1 * len(worn)))
    grid = drawing.add_gridspec(len(worn), 2, width_ratios=(2, 3))
    for place, ((_, rows), title) in enumerate(zip(worn, titles)):
        angle = rows["angle"].to_numpy()
        depths = {surface: rows[f"{surface}_depth"].to_numpy() for surface, *_ in SURFACES}
        deepest = max(depth.max() for depth in depths.values())
        unit, factor = prefixed("m", np.array([deepest]))
        around = drawing.add_subplot(grid[place, 0], projection="polar")
        over = drawing.add_subplot(grid[place, 1])
        for (surface, label, colour), radius, sign in zip(SURFACES, (0.9, 1.0), (-1, 1)):
            if not depths[surface].max() > 0:
                continue
            closed = np.append(depths[surface], depths[surface][0])
            turns = np.radians(np.append(angle, angle[0]))
            around.fill_between(turns, radius, radius + sign * EXAGGERATED * closed / deepest, color=colour, alpha=0.4, linewidth=0)
            around.plot(turns, radius + sign * EXAGGERATED * closed / deepest, color=colour)
            around.plot(np.linspace(0, 2 * np.pi, 361), np.full(361, radius), color=colour, linewidth=0.5)
            over.step(angle, factor * depths[surface], where="mid", color=colour, label=label)
        around.set_ylim(0, 1 + EXAGGERATED)
        around.set_yticks([])
        around.set_xticks(np.radians(range(0, 360, 90)))
        around.spines["polar"].set_visible(False)
        over.set_title(title, loc="left")
        over.set_xlim(0, 360)
        over.set_xticks(range(0, 361, 90))
        over.set_ylim(bottom=0)
        over.set_ylabel(f"depth of wear [{unit}]")
    over.set_xlabel("angle on the surface, from x towards y [°]")
    style.add_legend(drawing, drawing.axes)
    return drawing
