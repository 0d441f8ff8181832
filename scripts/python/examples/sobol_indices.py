#!/usr/bin/env python3
"""Which parameter matters for the film of a piston pin: Sobol indices by SALib.

    sobol_indices.py [PICTURE]
"""

import sys

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style  # the look of all pictures of gudgeon
from SALib.analyze import sobol as analysis
from SALib.sample import sobol as sampling

PROBLEM = {
    "num_vars": 4,
    "names": ["joint.clearance", "joint.bearing_length", "lubrication.viscosity", "combustion.heat"],
    "bounds": [[6e-6, 12e-6], [18e-3, 22e-3], [4e-3, 10e-3], [280, 380]],
}
#: The long bearing, whose force is a formula: a film of finite length needs a table of seconds for each length and clearance. Its film
#: is too thick: this example is about the method.
QUICK = {"lubrication.law": "pinkus_sternlicht", "lubrication.variant": "half_film"}

engine = gudgeon.template("engine").set(
    {"lubrication.temperature": None, "lubrication.oil": None, "lubrication.viscosity": 0.0065, "integrator.revolutions": 4}
).set(QUICK)


def main(picture: str | None = None) -> dict[str, float]:
    design = sampling.sample(PROBLEM, 128, calc_second_order=False, seed=1)
    table = gudgeon.sweep(engine, design, names=PROBLEM["names"], keep=["cycle_min_film_thickness"])
    found = analysis.analyze(PROBLEM, table.cycle_min_film_thickness.to_numpy(), calc_second_order=False, seed=1)
    for name, first, total in zip(PROBLEM["names"], found["S1"], found["ST"]):
        print(f"{name:24} first {first:.2f}, total {total:.2f}")
    if picture:
        drawing, axis = plt.subplots(figsize=(style.WIDTH, 2.8))
        names = [name.split(".")[-1].replace("_", " ") for name in PROBLEM["names"]]
        places = np.arange(PROBLEM["num_vars"])
        axis.barh(places - 0.2, found["S1"], 0.4, xerr=found["S1_conf"], color=style.BLUE, label="alone")
        axis.barh(places + 0.2, found["ST"], 0.4, xerr=found["ST_conf"], color=style.SKY, label="with others")
        axis.set_yticks(places, names)
        axis.set_xlabel(f"share of the variance of the thinnest film (Sobol index), {len(table)} runs")
        axis.legend()
        most = np.argmax(found["ST"])
        drawing.suptitle(f"The {names[most]} makes {100 * found['S1'][most]:.0f} % of the scatter of the thinnest film")
        style.keep(drawing, picture)
    return dict(zip(PROBLEM["names"], found["ST"])) | {"sum": float(found["S1"].sum()), "runs": len(table)}


if __name__ == "__main__":
    main(*sys.argv[1:2])
