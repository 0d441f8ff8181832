#!/usr/bin/env python3
"""The pin offset with the softest slap of the piston.

    pin_offset.py [PICTURE]

The skirt moves from wall to wall. The energy of a slap is half of the piston's mass times the square of the speed at which a corner of the
skirt meets the wall; the hardest slap of the last cycle is made as soft as possible.
"""

import sys

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style  # the look of all pictures of gudgeon
from scipy.optimize import minimize_scalar

MASS = 0.2  # of the piston of the template [kg]

engine = gudgeon.template("slap").set(integrator={"revolutions": 6}, output={"columns": ["time", "crank_angle"]})


def hardest(run: gudgeon.Run) -> dict[str, float]:
    """Energy of the hardest slap in the last cycle [J]."""
    events = run.events
    speeds = events.normal_speed[(events.event == "contact_begins") & (events.time >= run.summary["cycle_start"])]
    return {"slap": 0.5 * MASS * float((speeds**2).max())}


def slap(offset: float) -> float:
    """The same for a pin offset [m]."""
    return hardest(engine.set({"guide.piston_com[2]": offset}).run())["slap"]


def main(picture: str | None = None) -> dict[str, float]:
    best = minimize_scalar(slap, bounds=(0, 1e-3), method="bounded", options={"xatol": 1e-5, "maxiter": 15})
    centred = slap(0.0)
    print(f"offset {1e3 * best.x:.2f} mm: hardest slap {1e3 * best.fun:.1f} mJ; without offset {1e3 * centred:.1f} mJ")
    if picture:
        offsets = np.linspace(-1.2e-3, 1.2e-3, 25)
        table = gudgeon.sweep(engine, {"guide.piston_com[2]": offsets}, reduce=hardest)
        drawing, axis = plt.subplots(figsize=(style.WIDTH, 3.0))
        axis.plot(1e3 * offsets, 1e3 * table.slap, ".-")
        axis.plot(1e3 * best.x, 1e3 * best.fun, "s", color=style.VERMILION, label=f"best: {1e3 * best.x:.2f} mm")
        axis.set(xlabel="pin offset [mm]", ylabel="hardest slap [mJ]", ylim=(0, None))
        axis.legend()
        drawing.suptitle(f"An offset of {1e3 * best.x:.2f} mm softens the hardest slap from {1e3 * centred:.0f} to {1e3 * best.fun:.0f} mJ")
        style.keep(drawing, picture)
    return {"offset": best.x, "slap": best.fun, "centred": centred}


if __name__ == "__main__":
    main(*sys.argv[1:2])
