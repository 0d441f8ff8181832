#!/usr/bin/env python3
"""A controller of the crank's speed: a motor drives a compressor, and its torque follows the speed it has reached.

    speed_controller.py [PICTURE]

The run is advanced millisecond by millisecond. Between two of them the controller reads the speed and sets the torque, as a drive's
firmware would. After half of the time the wanted speed rises from 1500 to 1800 rpm.
"""

import sys
from pathlib import Path

import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style  # the look of all pictures of gudgeon

STEP, END = 1e-3, 1.2  # s
RPM = 2 * np.pi / 60
PROPORTIONAL, INTEGRAL, LARGEST = 2.0, 5.0, 60.0  # N m s, N m, N m

compressor = gudgeon.read(Path(__file__).resolve().parents[3] / "cases/gas/compressor.nml").set(
    drive={"kind": "free", "flywheel_inertia": 0.08}, output={"ideal_twin": False}
)


def wanted(t: float) -> float:
    """The speed that is wanted [rad/s]."""
    return (1500 if t < END / 2 else 1800) * RPM


class Controller:
    """A proportional and integral controller, whose torque is limited."""

    def __init__(self, torque: float) -> None:
        self.sum = torque

    def torque(self, t: float, speed: float) -> float:
        error = wanted(t) - speed
        found = self.sum + PROPORTIONAL * error
        if abs(found) < LARGEST:
            self.sum += INTEGRAL * error * STEP
        return float(np.clip(found, -LARGEST, LARGEST))


def main(picture: str | None = None) -> dict[str, float]:
    controller, rows = Controller(12.0), []
    with compressor.begin(end=END) as stepper:
        for i in range(round(END / STEP)):
            t, speed = i * STEP, stepper.values["crank_speed"]
            stepper.inputs["drive.torque"] = controller.torque(t, speed)
            rows.append((t, speed / RPM, stepper.inputs["drive.torque"]))
            stepper.advance(t + STEP)
        run = stepper.finish()
    t, rpm, torque = np.array(rows).T
    last = t > END - 0.2
    print(f"last 0.2 s: {rpm[last].mean():.1f} rpm, from {rpm[last].min():.1f} to {rpm[last].max():.1f}; torque {torque[last].mean():.2f} N m")
    if picture:
        drawing, (above, below) = plt.subplots(2, 1, figsize=(style.WIDTH, 3.4), sharex=True)
        above.plot(run["time"], run["crank_speed"] / RPM, linewidth=0.6)
        above.plot(t, [wanted(x) / RPM for x in t], "k--", linewidth=1, label="wanted")
        above.set_ylabel("speed [rpm]")
        above.legend()
        below.step(t, torque, where="post", color=style.VERMILION, linewidth=0.8)
        below.set(xlabel="time [s]", ylabel="torque [N m]")
        reached = t[(rpm >= 1800) & (t > END / 2)][0] - END / 2
        drawing.suptitle(f"The controller reaches 1800 rpm after {1e3 * reached:.0f} ms and holds it within {np.abs(rpm[last] - 1800).max():.0f} rpm")
        style.keep(drawing, picture)
    return {"rpm": rpm[last].mean(), "torque": torque[last].mean(), "residual": run.summary["max_energy_residual_relative"], "speed": float(rpm[-1])}


if __name__ == "__main__":
    main(*sys.argv[1:2])
