#!/usr/bin/env python3
"""The compressor of speed_controller.py as a functional mock-up unit in a master: FMPy here, as in any tool that reads FMI 2.0.

    fmu_in_master.py [PICTURE]

The master knows nothing of the mechanism: a motor with inductance, of which it integrates the current, turns the crank of the unit. The
same loop with a Stepper gives the same bits.
"""

import sys
import tempfile
from pathlib import Path

import fmpy
import gudgeon
import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style  # the look of all pictures of gudgeon
from speed_controller import RPM, compressor

STEP, END = 2e-4, 0.4  # s
VOLTAGE, RESISTANCE, INDUCTANCE, FLUX = 200.0, 0.6, 6e-3, 1.2  # V, Ohm, H, V s


def motor(current: float, speed: float) -> float:
    """The current after a step [A], by the implicit Euler method."""
    return (current + STEP / INDUCTANCE * (VOLTAGE - FLUX * speed)) / (1 + STEP / INDUCTANCE * RESISTANCE)


def in_unit(path: Path, folder: str) -> list[tuple[float, float, float]]:
    """Time, speed and current, with the unit."""
    description = fmpy.read_model_description(str(path))
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    unit = fmpy.instantiate_fmu(fmpy.extract(str(path), folder), description, "CoSimulation")
    unit.setupExperiment(startTime=0, stopTime=END)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    rows, current = [], 0.0
    for i in range(round(END / STEP)):
        (speed,) = unit.getReal([reference["crank_speed"]])
        current = motor(current, speed)
        rows.append((i * STEP, speed, current))
        unit.setReal([reference["drive.torque"]], [FLUX * current])
        unit.doStep(i * STEP, STEP)
    unit.terminate()
    unit.freeInstance()
    return rows


def in_python() -> list[tuple[float, float, float]]:
    """The same with a Stepper."""
    stepper, rows, current = compressor.begin(end=END), [], 0.0
    for i in range(round(END / STEP)):
        speed = stepper.values["crank_speed"]
        current = motor(current, speed)
        rows.append((i * STEP, speed, current))
        stepper.inputs["drive.torque"] = FLUX * current
        stepper.advance(i * STEP + STEP)
    return rows


def main(picture: str | None = None) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        path = gudgeon.fmu(compressor, Path(folder) / "compressor.fmu", columns=["time", "crank_speed", "cylinder_pressure"])
        size, rows = path.stat().st_size, np.array(in_unit(path, folder))
    apart = float(np.abs(rows - np.array(in_python())).max())
    t, speed, current = rows.T
    print(f"unit of {size / 1e6:.1f} MB; {len(rows)} steps to {speed[-1] / RPM:.0f} rpm; largest difference from a Stepper {apart:g}")
    if picture:
        drawing, (above, below) = plt.subplots(2, 1, figsize=(style.WIDTH, 3.4), sharex=True)
        above.plot(t, speed / RPM)
        above.set_ylabel("speed of the unit [rpm]")
        below.plot(t, current, color=style.VERMILION)
        below.set(xlabel="time [s]", ylabel="current of the motor [A]")
        same = "the same bits as in Python" if apart == 0 else f"{apart:.1g} from Python"
        drawing.suptitle(f"The motor brings the unit to {speed[-1] / RPM:.0f} rpm: {same}")
        style.keep(drawing, picture)
    return {"apart": apart, "speed": float(speed[-1]), "steps": len(rows)}


if __name__ == "__main__":
    main(*sys.argv[1:2])
