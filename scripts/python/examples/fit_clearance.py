#!/usr/bin/env python3
"""Clearance and friction of a worn joint from the measured acceleration of the piston.

    fit_clearance.py [PICTURE]

While the pin has impacts (on the left of the picture: without friction), two runs whose clearances differ by a millionth are soon as far
apart as any two: such traces cannot be fitted. Levels of the settled spectrum can: gudgeon.fit with bands. The "measurement" is a run by
another method at a hundredth of the tolerance, with noise.
"""

import sys
from pathlib import Path

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.plots import style  # the look of all pictures of gudgeon

LIMITS = {"joint.clearance": ("100 um", "500 um"), "friction.coefficient": (0.01, 0.25)}
ROWS, SETTLE, TURNS = 360, 6, 16  # in a revolution; revolutions that are left out, and all of them
ORDERS = np.array([2, 4, 6, 9, 13, 19, 28, 40])  # limits of the bands, in orders of the crank

machine = gudgeon.read(Path(__file__).resolve().parents[3] / "cases/flores/friction_050.nml").set(
    integrator={"revolutions": TURNS},
    output={"samples_per_revolution": ROWS, "columns": ["crank_angle", "piston_acceleration"], "ideal_twin": False},
)


def measurement(clearance: float, friction: float) -> pd.DataFrame:
    """What stands for a measurement."""
    values = dict(zip(LIMITS, (clearance, friction)))
    run = machine.set(values | {"integrator.method": "adams", "integrator.relative_tolerance": 1e-8}).run()
    truth = run["piston_acceleration"]
    noise = 0.02 * truth.std() * np.random.default_rng(1).standard_normal(len(truth))
    return pd.DataFrame({"crank_angle": run["crank_angle"], "piston_acceleration": truth + noise})


def neighbours(clearance: float, friction: float | None) -> np.ndarray:
    """Difference of the acceleration of two clearances, a millionth apart."""
    one = machine.set({"joint.clearance": clearance, "friction.coefficient": friction or 0.1})
    if friction is None:
        one.remove("friction")
    two = one.set({"joint.clearance": clearance * (1 + 1e-6)})
    return np.abs(one.run()["piston_acceleration"] - two.run()["piston_acceleration"])


def main(picture: str | None = None, clearance: float = 2.5e-4, friction: float = 0.15) -> dict[str, float]:
    found = gudgeon.fit(machine, measurement(clearance, friction), LIMITS, bands=ORDERS, settle=SETTLE)
    print(found)
    print(f"true: {1e6 * clearance:.1f} um, {friction}")
    apart = {"without friction": neighbours(clearance, None), "with friction": neighbours(clearance, friction)}
    if picture:
        drawing, (left, right) = plt.subplots(1, 2, figsize=(style.WIDTH, 2.9))
        for label, values in apart.items():
            left.semilogy(np.arange(len(values)) / ROWS, values + 1e-3, linewidth=0.4)
            left.annotate(label, (0.98, 0.9 if "out" in label else 0.05), xycoords="axes fraction", ha="right")
        left.set(xlabel="revolutions", ylabel="difference of the acceleration [m/s²]", title="two clearances, a millionth apart",
                 ylim=(1e-5, 1e7), xticks=range(0, TURNS + 1, 4))
        middle = np.sqrt(ORDERS[1:] * ORDERS[:-1])
        right.plot(middle, found.observed.measured, "ko", markersize=4, label="measured")
        own = gudgeon.levels(found.case.run(), "piston_acceleration", ORDERS, SETTLE)
        values = f"{1e6 * found.values['joint.clearance']:.0f} µm, friction {found.values['friction.coefficient']:.3f}"
        right.plot(middle, own, label=f"fit: {values}")
        right.set(xlabel="order", ylabel="level [dB]", title="settled spectrum of the acceleration")
        right.margins(0.05)
        right.legend()
        off = max(abs(found.values["joint.clearance"] / clearance - 1), abs(found.values["friction.coefficient"] / friction - 1))
        drawing.suptitle(f"Traces without friction part at once, but levels of the spectrum tell clearance and friction to {100 * off:.0f} %")
        style.keep(drawing, picture)
    errors = found.standard_errors
    return {
        "clearance": found.values["joint.clearance"], "friction": found.values["friction.coefficient"], "rest": found.rms,
        "clearance_error": errors["joint.clearance"], "friction_error": errors["friction.coefficient"],
        "chaos": float(np.median(apart["without friction"][-ROWS:])), "calm": float(apart["with friction"].max()),
    }  # fmt: skip


if __name__ == "__main__":
    main(*sys.argv[1:2])
