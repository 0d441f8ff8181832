"""A run in motion: crank, rod and piston, and the orbit of the pin in its clearance."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots.style import BLACK, BLUE, GREY, VERMILION
from matplotlib.animation import FuncAnimation


def animated(run: Any, frames: int) -> FuncAnimation:
    """The animation of a `gudgeon.Run`. The piston moves along x; the rod ends at the piston pin, or beside it in its clearance, which
    is drawn to a scale of its own."""
    crank, rod = run.case["mechanism.crank_length"], run.case["mechanism.rod_length"]
    offset = run.case["mechanism.axis_offset"]
    rows = np.linspace(0, len(run) - 1, frames).astype(int)
    angle, tilt, piston = (run[name][rows] for name in ("crank_angle", "rod_angle", "piston_position"))
    pin_x, pin_y = crank * np.cos(angle), crank * np.sin(angle)
    end_x, end_y = pin_x + rod * np.cos(tilt), pin_y - rod * np.sin(tilt)
    loose = "eccentricity_x" in run.names
    drawing, axes = plt.subplots(1, 2 if loose else 1, figsize=(8, 3), squeeze=False, width_ratios=[2.2, 1] if loose else None)
    axis = axes[0, 0]
    (members,) = axis.plot([], [], "o-", color=BLUE, linewidth=3, markersize=6)
    half = 0.35 * crank
    (body,) = axis.plot([], [], color=BLACK, linewidth=1.5)
    axis.axhline(offset, color=GREY, linewidth=0.5)
    axis.set(xlim=(-1.3 * crank, 1.3 * crank + rod), ylim=(-1.4 * crank, 1.4 * crank), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    if loose:
        clearance = run.case["joint.clearance"]
        e_x, e_y = run["eccentricity_x"] / clearance, run["eccentricity_y"] / clearance
        orbit = axes[0, 1]
        orbit.add_patch(plt.Circle((0, 0), 1, fill=False, color=BLACK))
        orbit.plot(e_x, e_y, color=GREY, linewidth=0.4)
        (pin,) = orbit.plot([], [], "o", color=VERMILION)
        most = 1.1 * max(1.0, float(np.hypot(e_x, e_y).max()))
        orbit.set(xlim=(-most, most), ylim=(-most, most), aspect="equal", xlabel="eccentricity / clearance")

    def show(i: int) -> list[Any]:
        members.set_data([0, pin_x[i], end_x[i]], [0, pin_y[i], end_y[i]])
        body.set_data(piston[i] + half * np.array([-1, 1, 1, -1, -1]), offset + half * np.array([-1, -1, 1, 1, -1]))
        axis.set_title(f"{1e3 * run['time'][rows[i]]:.2f} ms", fontsize=9)
        if loose:
            pin.set_data([e_x[rows[i]]], [e_y[rows[i]]])
        return [members, body, *([pin] if loose else [])]

    return FuncAnimation(drawing, show, frames=frames, interval=40)
