"""Heat that a measured or computed pressure shows: from the columns of the pressure, the volume and the crank angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class HeatRelease:
    """Apparent heat: that of combustion less what goes to the walls and past the rings."""

    angle: np.ndarray  # crank angle in the cycle [degrees]
    heat: np.ndarray  # released since the start [J]
    total: float  # its largest value [J]
    angles: tuple[float, float, float]  # at which 10, 50 and 90 % of it are reached [degrees]
    exponent: float  # n of p V^n between 100 and 40 degrees before the firing dead centre; some 1.3 to 1.4

    def __repr__(self) -> str:
        ten, half, ninety = self.angles
        return (f"{self.total:.4g} J; 10, 50 and 90 % at {ten:.4g}, {half:.4g} and {ninety:.4g} degrees; "
                f"compressed with the exponent {self.exponent:.4g}")


def heat_release(run: Any, ratio: float, start: float = 300.0, end: float = 480.0, period: float = 720.0) -> HeatRelease:
    """The heat that the pressure of a run's last cycle shows between two crank angles [degrees], firing at 360, with a constant ratio of
    the heat capacities: the change of p V/(ratio - 1) plus the integral of p dV. No derivative of the pressure is taken.

    It stands and falls with the ratio (1.3 for 1.4: 45 % more heat), with the dead centre (1 degree: 10 to 14 %) and with the zero of the
    pressure (0.2 bar: 9 %): look at the exponent first."""
    degrees = np.degrees(np.asarray(run["crank_angle"], dtype=float))
    pressure, volume = np.asarray(run["cylinder_pressure"], dtype=float), np.asarray(run["cylinder_volume"], dtype=float)
    if degrees[-1] < degrees[0]:
        degrees = -degrees
    cycle = period * np.floor((degrees[-1] - end) / period + 1e-9)
    at = degrees - cycle
    if at[0] > start:
        raise ValueError(f"the run has no whole window from {start:g} to {end:g} degrees")
    inside = (at >= start - 1e-6) & (at <= end + 1e-6)
    angle, p, v = at[inside], pressure[inside], volume[inside]
    work = np.concatenate(([0.0], np.cumsum(0.5 * (p[1:] + p[:-1]) * np.diff(v))))
    heat = p * v / (ratio - 1) + work
    heat = heat - heat[angle <= angle[0] + 10].mean()
    top = int(heat.argmax())
    found = []
    for share in (0.1, 0.5, 0.9):
        below = np.flatnonzero(heat[:top] < share * heat[top])
        k = int(below[-1]) if len(below) else 0
        found.append(float(np.interp(share * heat[top], heat[k : k + 2], angle[k : k + 2])))
    early, late = (int(np.abs(at - place).argmin()) for place in (260.0, 320.0))
    exponent = np.log(pressure[late] / pressure[early]) / np.log(volume[early] / volume[late])
    return HeatRelease(angle, heat, float(heat[top]), (found[0], found[1], found[2]), float(exponent))
