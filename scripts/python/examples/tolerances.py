#!/usr/bin/env python3
"""What the tolerances of manufacture and the oil's temperature do to the film of a piston pin, by Monte Carlo with Sobol points.

    tolerances.py [PICTURE]

Each parameter has a distribution of scipy.stats; one from OpenTURNS serves as well: lambda share: of.computeQuantile(share)[0].
"""

import sys

import gudgeon
from gudgeon.plots import style  # the look of all pictures of gudgeon
from scipy import stats

PARAMETERS = {
    "joint.clearance": stats.norm(8e-6, 0.8e-6),  # m: a fit with a tolerance of 5 um, three standard deviations on both sides
    "joint.bearing_length": stats.uniform(19.8e-3, 0.4e-3),  # m
    "lubrication.viscosity": stats.lognorm(0.15, scale=0.0065),  # Pa s: of the oil's temperature
    "combustion.heat": stats.norm(350, 10),  # J: from engine to engine
}
FILM, LIMIT = "cycle_min_film_thickness", 0.9e-6  # m
#: The long bearing, whose force is a formula: a film of finite length needs a table of seconds for each length and clearance. Its film
#: is too thick: this example is about the method.
QUICK = {"lubrication.law": "pinkus_sternlicht", "lubrication.variant": "half_film"}

engine = gudgeon.template("engine").set({"lubrication.temperature": None, "lubrication.oil": None, "lubrication.viscosity": 0.0065}).set(QUICK)


def main(picture: str | None = None) -> dict[str, float]:
    found = gudgeon.tolerances(engine, PARAMETERS, [FILM, "cycle_max_force"], below={FILM: LIMIT})
    print(found)
    if picture:
        style.keep(found.draw(), picture)
    low, median, high = (1e6 * found.percentile(FILM, share)[0] for share in (1, 50, 99))
    nominal, chance = 1e6 * float(found.nominal[FILM]), found.probability(FILM, below=LIMIT).value
    return {"low": low, "median": median, "high": high, "nominal": nominal, "chance": chance, "done": len(found.done) / len(found.table)}


if __name__ == "__main__":
    main(*sys.argv[1:2])
