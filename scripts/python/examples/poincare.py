#!/usr/bin/env python3
"""A Poincare section: where the pin is in its clearance, once a revolution, over a thousand revolutions.

    poincare.py [PICTURE]

Without friction the motion of Flores's mechanism fills a cloud: it is chaotic. With friction it settles on a point.
"""

import sys
from pathlib import Path

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style  # the look of all pictures of gudgeon

CASES = Path(__file__).resolve().parents[3] / "cases/flores"
SETTLE = 200  # revolutions that are left out
COLUMNS = ["time", "crank_angle", "eccentricity_x", "eccentricity_y", "eccentricity_ratio"]


def section(name: str, turns: int) -> np.ndarray:
    """Eccentricity over the clearance, (revolution, 2), at the crank angle 0."""
    case = gudgeon.read(CASES / f"{name}.nml").set(
        integrator={"revolutions": turns},
        output={"sampling": "crank_angle", "samples_per_revolution": 1, "columns": COLUMNS, "ideal_twin": False},
    )
    run = case.run()
    return np.column_stack([run["eccentricity_x"], run["eccentricity_y"]])[SETTLE:] / case.joint.clearance


def main(picture: str | None = None) -> dict[str, float]:
    sections = {"dry_0500um": section("dry_0500um", 1200), "friction_100": section("friction_100", 400)}
    sizes = {name: float(np.ptp(points, axis=0).max()) for name, points in sections.items()}
    print(", ".join(f"{name}: {len(sections[name])} points within {size:.3g} of the clearance" for name, size in sizes.items()))
    if picture:
        said = {"dry_0500um": "no friction, clearance 0.5 mm", "friction_100": "friction 0.1"}
        drawing, axes = plt.subplots(1, 2, figsize=(style.WIDTH, 3.4))
        for axis, (name, points) in zip(axes, sections.items()):
            axis.add_patch(plt.Circle((0, 0), 1, fill=False, color="0.6"))
            axis.plot(points[:, 1], points[:, 0], ".", markersize=1.5 if len(points) > 500 else 6)   # x is up
            axis.set(aspect="equal", xlim=(-1.15, 1.15), ylim=(-1.15, 1.15), title=said[name],
                     xlabel="across the cylinder / clearance", ylabel="along the cylinder / clearance")
        drawing.suptitle("Once a revolution: without friction the pin is never at the same place, with friction always")
        style.keep(drawing, picture)
    return sizes


if __name__ == "__main__":
    main(*sys.argv[1:2])
