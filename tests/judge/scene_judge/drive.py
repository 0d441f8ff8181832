"""The drive of the crank against the rows of a trace: a torque that depends on the speed, or a prescribed speed with a ramp."""
from __future__ import annotations

import bisect
import csv
import math

from .gas import Measured
from .mechanics import Row
from .trace import Run

UNITS = {"rad/s": 1.0, "rpm": math.pi / 30, "1/min": math.pi / 30, "1/s": 2 * math.pi, "N.m": 1.0, "Nm": 1.0, "N m": 1.0, "kN.m": 1e3, "kNm": 1e3}


class Drive:
    """The drive of a rigid crankshaft."""

    def __init__(self, run: Run) -> None:
        n = run.number
        self.is_free = run.text("drive.kind") == "free"
        self.torque = n("drive.torque")
        self.ramp, self.first, self.last = n("drive.ramp_time"), n("drive.ramp_from"), n("initial.crank_speed")
        self.x: list[float] = []
        if run.text("drive.torque_table"):
            with open(run.text("drive.torque_table"), encoding="utf-8-sig", newline="") as file:
                header, *rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
            units = [UNITS[name.split("[")[1].split("]")[0].strip()] for name in header]
            self.x, self.y = ([float(row[k]) * units[k] for row in rows] for k in (0, 1))
            self.slopes = self.all_slopes()

    def all_slopes(self) -> list[float]:
        widths = [b - a for a, b in zip(self.x, self.x[1:])]
        secants = [(b - a) / w for a, b, w in zip(self.y, self.y[1:], widths)]
        if len(secants) == 1:
            return secants * 2
        inner = [Measured.slope(*widths[i:i + 2], *secants[i:i + 2]) for i in range(len(secants) - 1)]
        return [self.end_slope(*widths[:2], *secants[:2]), *inner, self.end_slope(*widths[:-3:-1], *secants[:-3:-1])]

    @staticmethod
    def end_slope(width: float, next_width: float, secant: float, next_secant: float) -> float:
        """Slope of the parabola through three points, limited to the sign of the first secant and to twice its value."""
        slope = secant + (secant - next_secant) * width / (width + next_width)
        return 0.0 if slope * secant <= 0 else math.copysign(min(abs(slope), 2 * abs(secant)), secant)

    def torque_at(self, speed: float) -> float:
        if not self.x:
            return self.torque
        speed = min(max(speed, self.x[0]), self.x[-1])
        i = min(bisect.bisect_right(self.x, speed), len(self.x) - 1) - 1
        width = self.x[i + 1] - self.x[i]
        s = (speed - self.x[i]) / width
        return (self.torque + (1 + 2 * s) * (1 - s)**2 * self.y[i] + s**2 * (3 - 2 * s) * self.y[i + 1]
                + width * s * (1 - s) * ((1 - s) * self.slopes[i] - s * self.slopes[i + 1]))

    def misses(self, row: Row, t: float) -> dict[str, tuple[float, float]]:
        """For each check the error of the row, and the allowed error."""
        if self.is_free:
            size = abs(self.torque) + max(map(abs, self.y), default=0.0) if self.x else abs(self.torque)
            return {"drive's torque": (abs(row.get["crank_moment"] - self.torque_at(row.turn)), 1e-12 * size)}
        s, change = min(t / self.ramp, 1.0) if self.ramp else 1.0, self.last - self.first if self.ramp else 0.0
        speed = self.last - change * (1 - s)**3 * (1 + 3 * s + 6 * s**2)
        rate = 30 * change * s**2 * (1 - s)**2 / self.ramp if self.ramp else 0.0
        size = abs(self.first) + abs(self.last)
        return {"held speed": (abs(row.turn - speed), 1e-12 * size), "held acceleration": (abs(row.turn_rate - rate), 1e-11 * size / self.ramp if self.ramp else 0.0)}
