#!/usr/bin/env python3
"""Draws the picture of README.md, data/readme.png: the mechanism with its clearance magnified, pin orbits, piston accelerations. With --language pt
data/readme_pt.png."""

import argparse
from pathlib import Path

from measured import TOP, use_virtual_environment

use_virtual_environment()

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.plots.quantity import ideal_line
from gudgeon.plots.style import BLACK, BLUE, GREY, VERMILION, keep
from gudgeon.results import Results, Run, default_folder
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyBboxPatch, Polygon

#: A dry run that is not chaotic, so that the picture is the same with every version.
DRY, OILED, IDEAL = "friction_100", "lubricated_400cP", "ideal"

#: Magnification of the clearance in the drawing: the pin is drawn smaller and farther from the centre.
MAGNIFICATION = 8.0

#: Crank angle of the drawing [deg].
ANGLE = 55.0

STEEL = "#C8CDD2"
LIGHT = "#E8EBEE"


def bar(start: np.ndarray, end: np.ndarray, half_width: float) -> Polygon:
    """A straight bar from start to end."""
    along = (end - start) / np.hypot(*(end - start))
    across = half_width * np.array([-along[1], along[0]])
    return Polygon(
        [start + across, end + 0.7 * across, end - 0.7 * across, start - across],
        facecolor=STEEL,
        edgecolor=BLACK,
        linewidth=0.7,
    )


def mechanism(axis: Axes, run: Run, degrees: float) -> None:
    """The mechanism at a crank angle: (y, x) in metres, the cylinder axis upwards."""
    at = int(np.searchsorted(run["crank_angle"], np.radians(degrees)))
    crank = float(run.parameter("mechanism", "crank_length"))
    bearing = float(run.parameter("joint", "bearing_radius"))
    angle = run["crank_angle"][at]
    crankpin = crank * np.array([np.sin(angle), np.cos(angle)])
    piston = np.array([0.0, run["piston_position"][at]])
    pin = piston + MAGNIFICATION * np.array([run["eccentricity_y"][at], run["eccentricity_x"][at]])
    width, below, above = 2.4 * bearing, 1.5 * bearing, 2.6 * bearing

    for side in (-1, 1):
        axis.plot(
            [side * 1.04 * width] * 2, [1.45 * crank, piston[1] + 4.6 * bearing], color=BLACK, linewidth=1.5, zorder=0
        )
    axis.add_patch(Circle((0, 0), crank * 1.25, facecolor=LIGHT, edgecolor=GREY, linewidth=0.6))
    axis.add_patch(bar(np.zeros(2), crankpin, 0.9 * bearing))
    axis.add_patch(
        FancyBboxPatch(
            (-width, piston[1] - below),
            2 * width,
            below + above,
            boxstyle=f"round,pad=0,rounding_size={0.3 * bearing}",
            facecolor=LIGHT,
            edgecolor=BLACK,
            linewidth=0.9,
        )
    )
    axis.add_patch(Circle(piston, bearing, facecolor="white", edgecolor=BLACK, linewidth=0.9))
    axis.add_patch(bar(crankpin, pin, 0.55 * bearing))
    axis.add_patch(Circle(pin, bearing - MAGNIFICATION * run.clearance, facecolor=BLUE, edgecolor=BLACK, linewidth=0.7))
    for centre in (np.zeros(2), crankpin):
        axis.add_patch(Circle(centre, 0.45 * bearing, facecolor="white", edgecolor=BLACK, linewidth=0.7))
    axis.set_xlim(-1.35 * crank, 1.35 * crank)
    axis.set_ylim(-1.35 * crank, crank + float(run.parameter("mechanism", "rod_length")) + 3.4 * bearing)
    axis.set_aspect("equal")
    axis.set_axis_off()
    axis.set_title(f"clearance × {MAGNIFICATION:g}")


def orbit(axis: Axes, run: Run, colour: str) -> None:
    axis.plot(run["eccentricity_y"] / run.clearance, run["eccentricity_x"] / run.clearance, color=colour, linewidth=0.6)


def write(results: Results, path: Path) -> None:
    """Draw the picture to `path`."""
    results.make((DRY, OILED, IDEAL))
    dry, oiled, ideal = results[DRY], results[OILED], results[IDEAL]
    drawing, (left, middle, right) = plt.subplots(1, 3, figsize=(8.4, 3.0), width_ratios=[1.2, 2.2, 3.4])
    mechanism(left, oiled, ANGLE)
    middle.add_patch(Circle((0, 0), 1, fill=False, edgecolor=BLACK, linewidth=0.9, zorder=3))
    orbit(middle, dry, VERMILION)
    orbit(middle, oiled, BLUE)
    middle.set_aspect("equal")
    middle.set_axis_off()
    middle.set_title("pin centre in the clearance circle")
    for run, colour, name in ((dry, VERMILION, "dry, with friction"), (oiled, BLUE, "oil film")):
        right.plot(np.degrees(run["crank_angle"]), 1e-3 * run["piston_acceleration"], color=colour, label=name)
    ideal_line(right, np.degrees(ideal["crank_angle"]), 1e-3 * ideal["piston_acceleration"])
    right.set_xlim(0, 720)
    right.set_xticks(range(0, 721, 180))
    right.set_xlabel("crank angle [deg]")
    right.set_title("piston acceleration [10³ m/s²]")
    right.legend(loc="lower right")
    keep(drawing, path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    language.add_option(parser)
    parser.parse_args()
    write(Results(default_folder()), TOP / "data" / ("readme.png" if language.current.is_english else "readme_pt.png"))
