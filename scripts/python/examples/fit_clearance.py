#!/usr/bin/env python3
"""Clearance and friction of a worn joint from the measured acceleration of the piston.

    fit_clearance.py [PICTURE]

While the pin has impacts (on the left of the picture: without friction), two runs whose clearances differ by a millionth are soon as far
apart as any two: such traces cannot be fitted. Levels of the settled spectrum can. They are known at points of a Sobol design, and
interpolated between them; least_squares finds clearance and friction there, and two further designs around the result make it sharper.
The "measurement" is a run by another method at a hundredth of the tolerance, with noise.
"""

import sys
from pathlib import Path

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.optimize import least_squares
from scipy.stats import qmc

NAMES = ["joint.clearance", "friction.coefficient"]
ROWS, SETTLE, TURNS = 360, 6, 16  # in a revolution; revolutions that are left out, and all of them
ORDERS = np.array([2, 4, 6, 9, 13, 19, 28, 40])  # limits of the bands, in orders of the crank
LEAST, MOST = np.log10([1e-4, 0.01]), np.log10([5e-4, 0.25])

machine = gudgeon.read(Path(__file__).resolve().parents[3] / "cases/flores/friction_050.nml").set(
    integrator={"revolutions": TURNS},
    output={"samples_per_revolution": ROWS, "columns": ["time", "piston_acceleration"], "ideal_twin": False},
)


def levels(acceleration: np.ndarray) -> np.ndarray:
    """Level of each band [dB], over the settled revolutions."""
    power = np.abs(np.fft.rfft(acceleration[SETTLE * ROWS : TURNS * ROWS].reshape(-1, ROWS), axis=1)) ** 2
    return np.array([10 * np.log10(power[:, a:b].mean(axis=0).sum()) for a, b in zip(ORDERS[:-1], ORDERS[1:])])


def study(least: np.ndarray, most: np.ndarray, runs: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Points between these limits, as logarithms, and the levels there."""
    points = qmc.scale(qmc.Sobol(2, rng=seed).random(runs), least, most)
    table = gudgeon.sweep(machine, 10**points, names=NAMES, keep=[], reduce=lambda run: dict(enumerate(levels(run.piston_acceleration))))
    return points, table[list(range(len(ORDERS) - 1))].to_numpy()


def fit(measured: np.ndarray) -> tuple[np.ndarray, float]:
    """Clearance and friction whose levels are the measured ones, and the root mean square difference of the levels [dB]."""
    least, most = LEAST, MOST
    for stage, runs in enumerate((128, 64, 64)):
        centre, half = (least + most) / 2, (most - least) / 2
        points, found = study(least, most, runs, stage)
        places = (points - centre) / half
        between = RBFInterpolator(places, found, smoothing=0.003)
        nearest = places[((found - measured) ** 2).sum(axis=1).argsort()[:5]]
        fits = [least_squares(lambda x: between(x[None])[0] - measured, start, bounds=(-1, 1)) for start in nearest]
        best = min(fits, key=lambda one: one.cost)
        centre = centre + half * best.x
        least, most = centre - 0.35 * half, centre + 0.35 * half
    return 10**centre, float(np.sqrt(2 * best.cost / len(measured)))


def measurement(clearance: float, friction: float) -> gudgeon.Run:
    """What stands for a measurement."""
    values = dict(zip(NAMES, (clearance, friction)))
    return machine.set(values | {"integrator.method": "adams", "integrator.relative_tolerance": 1e-8}).run()


def main(picture: str | None = None, clearance: float = 2.5e-4, friction: float = 0.15) -> dict[str, float]:
    truth = measurement(clearance, friction)["piston_acceleration"]
    measured = truth + 0.02 * truth.std() * np.random.default_rng(1).standard_normal(len(truth))
    (found_clearance, found_friction), rest = fit(levels(measured))
    print(f"clearance {1e6 * found_clearance:.1f} um (true: {1e6 * clearance:.1f}), friction {found_friction:.3f} (true: {friction}), levels within {rest:.2f} dB")
    neighbours = {}
    for label, of in (("without friction", None), ("with friction", friction)):
        one = machine.set({"joint.clearance": clearance, "friction.coefficient": friction})
        if of is None:
            one.remove("friction")
        two = one.set({"joint.clearance": clearance * (1 + 1e-6)})
        neighbours[label] = np.abs(one.run()["piston_acceleration"] - two.run()["piston_acceleration"])
    if picture:
        drawing, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
        for label, apart in neighbours.items():
            left.semilogy(np.arange(len(apart)) / ROWS, apart + 1e-3, linewidth=0.5, label=label)
        left.set(xlabel="revolutions", ylabel="difference of the acceleration [m/s²]", title="two clearances, a millionth apart")
        left.legend()
        fitted = machine.set(dict(zip(NAMES, (found_clearance, found_friction)))).run()
        middle = np.sqrt(ORDERS[1:] * ORDERS[:-1])
        right.plot(middle, levels(measured), "ko", label="measured")
        right.plot(middle, levels(fitted["piston_acceleration"]), label=f"fit: {1e6 * found_clearance:.0f} um, friction {found_friction:.3f}")
        right.set(xlabel="order", ylabel="level [dB]", title="settled spectrum of the piston's acceleration")
        right.legend()
        drawing.savefig(picture, dpi=110)
    chaos = float(np.median(neighbours["without friction"][-ROWS:]))
    return {"clearance": found_clearance, "friction": found_friction, "rest": rest, "chaos": chaos, "calm": float(neighbours["with friction"].max())}


if __name__ == "__main__":
    main(*sys.argv[1:2])
