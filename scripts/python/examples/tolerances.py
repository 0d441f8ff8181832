#!/usr/bin/env python3
"""What the tolerances of manufacture and the oil's temperature do to the film of a piston pin, by Monte Carlo with Sobol points.

    tolerances.py [PICTURE]

Each parameter has a distribution of scipy.stats; one from OpenTURNS serves as well: computeQuantile(share)[0] in place of ppf(share).
"""

import sys

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from scipy import stats
from scipy.stats import qmc

PARAMETERS = {
    "joint.clearance": stats.norm(8e-6, 0.8e-6),  # m: a fit with a tolerance of 5 um, three standard deviations on both sides
    "joint.bearing_length": stats.uniform(19.8e-3, 0.4e-3),  # m
    "lubrication.viscosity": stats.lognorm(0.15, scale=0.0065),  # Pa s: of the oil's temperature
    "combustion.heat": stats.norm(350, 10),  # J: from engine to engine
}
RUNS = 256
KEPT = ["cycle_min_film_thickness", "cycle_max_force", "cycle_mean_film_power"]
#: The long bearing, whose force is a formula: a film of finite length needs a table of seconds for each length and clearance. Its film
#: is too thick: this example is about the method.
QUICK = {"lubrication.law": "pinkus_sternlicht", "lubrication.variant": "half_film"}

engine = gudgeon.template("engine").set({"lubrication.temperature": None, "lubrication.oil": None, "lubrication.viscosity": 0.0065}).set(QUICK)


def main(picture: str | None = None) -> dict[str, float]:
    shares = qmc.Sobol(len(PARAMETERS), rng=1).random(RUNS)
    design = np.column_stack([of.ppf(share) for of, share in zip(PARAMETERS.values(), shares.T)])
    table = gudgeon.sweep(engine, design, names=list(PARAMETERS), keep=KEPT)
    film = 1e6 * table.cycle_min_film_thickness
    nominal = 1e6 * engine.run(columns="none").summary["cycle_min_film_thickness"]
    low, median, high = np.quantile(film, [0.01, 0.5, 0.99])
    print(f"{RUNS} engines: thinnest film {low:.2f} to {high:.2f} um (1 % to 99 %), median {median:.2f}, nominal {nominal:.2f}")
    if picture:
        drawing, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
        left.hist(film, 24)
        left.axvline(nominal, color="black", label="nominal")
        left.axvline(low, color="tab:red", label="1 %")
        left.set(xlabel="thinnest film of the last cycle [um]", ylabel="engines")
        left.legend()
        shown = right.scatter(1e6 * table["joint.clearance"], film, c=1e3 * table["lubrication.viscosity"], s=12)
        drawing.colorbar(shown, label="viscosity [mPa s]")
        right.set(xlabel="clearance [um]", ylabel="thinnest film [um]")
        drawing.savefig(picture, dpi=110)
    return {"low": low, "median": median, "high": high, "nominal": nominal, "done": float((table.status == "done").mean())}


if __name__ == "__main__":
    main(*sys.argv[1:2])
