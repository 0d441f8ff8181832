"""The laws of friction, from their published equations, against the rows of a trace."""
from __future__ import annotations

import math

from .trace import Run

ROUNDING = 1e-14   # of a speed that is the sum of those of crank, rod and piston, relative to their magnitudes
LANDING = 0.1      # error of a position where a step lands on an event, in tolerances of the clearance


class Friction:
    """Friction force over normal force along t at a sliding speed: Ambrosio (4.9, 4.10), Coulomb (4.8) with a larger friction at
    rest, Threlfall, Brown and McPhee (2016), and a Stribeck curve smoothed by a hyperbolic tangent; and with bristles, whose
    deflection z has a differential equation of its own: LuGre (1995), Dahl (1968), elasto-plastic (Dupont et al. 2002)."""

    def __init__(self, run: Run) -> None:
        self.law = run.text("friction.law")
        self.number = lambda key, default=0.0: run.number(f"friction.{key}", default)
        self.coefficient = self.number("coefficient")
        self.static = self.number("static_coefficient") or self.coefficient
        self.v0, self.v1 = self.number("v0"), self.number("v1")
        self.has_bristles = self.law in ("lugre", "dahl", "elasto_plastic")
        self.stiffness = self.number("bristle_stiffness")
        self.gives_way = self.static / self.stiffness if self.has_bristles else 0.0   # deflection at break-away [m]
        self.elastic = self.number("breakaway_ratio", 0.7) * self.coefficient / self.stiffness if self.has_bristles else 0.0
        self.coulomb = self.law == "coulomb" or self.law == "ambrosio" and self.v1 <= 0
        self.grip = {"ambrosio": self.ramp, "threlfall": self.eased, "brown_mcphee": self.peaked, "stribeck": self.falling}.get(self.law)

    def range(self, speed: float, give: float) -> tuple[float, float]:
        """Smallest and largest friction over normal force along t, for a sliding speed known within +- `give`."""
        found = sorted(self.ratio(v) for v in (speed - give, speed, speed + give))
        return found[0], found[-1]

    def ratio(self, speed: float) -> float:
        size = abs(speed)
        if self.coulomb:
            grip = self.coefficient if size else 0.0
        else:
            grip = self.grip(size)
        return -math.copysign(grip + self.number("viscous_coefficient") * size, speed)

    def steady(self, v: float) -> float:
        """Friction of bristles in steady sliding, without the viscous part."""
        if self.static == self.coefficient:
            return self.coefficient
        fall = math.exp(-((v / self.number("stribeck_speed")) ** 2))
        return self.static * fall + self.coefficient * (1 - fall)

    def side(self, v: float, z: float) -> tuple[int, bool]:
        """Sides of what is not smooth: the sense of sliding, and whether the bristles are beyond break-away."""
        sense = (v > 0) - (v < 0) if abs(v) > self.v1 else 0
        return sense, self.law == "elasto_plastic" and v * z > 0 and abs(z) > self.elastic

    def bristle_rate(self, v: float, z: float) -> float:
        """[m/s]"""
        share, full = 1.0, self.steady(v) / self.stiffness
        if self.law == "elasto_plastic":
            if v * z <= 0 or abs(z) <= self.elastic:
                share = 0.0
            elif abs(z) < full:
                share = math.sin(math.pi / 2 * (abs(z) - self.elastic) / (full - self.elastic)) ** 2
        return v - share * abs(v) * z / full

    def bristle_range(self, speed: float, z: float, give: float) -> tuple[float, float]:
        """Like `range`, with the deflection z of the bristles [m]."""
        found = []
        for v in (speed - give, speed, speed + give):
            damping = self.number("bristle_damping")
            if self.number("damping_speed"):
                damping *= math.exp(-((v / self.number("damping_speed")) ** 2))
            found.append(-self.stiffness * z - damping * self.bristle_rate(v, z) - self.number("viscous_coefficient") * v)
        return min(found), max(found)

    def ramp(self, size: float) -> float:
        if size >= self.v1:
            return self.coefficient
        return 0.0 if size <= self.v0 else self.coefficient * (size - self.v0) / (self.v1 - self.v0)

    def eased(self, size: float) -> float:
        return -self.coefficient * math.expm1(-3 * min(size, self.v1) / self.v1)

    def peaked(self, size: float) -> float:
        u = size / self.number("transition_speed")
        return self.coefficient * math.tanh(4 * u) + (self.static - self.coefficient) * 16 * u / (u * u + 3) ** 2

    def falling(self, size: float) -> float:
        fall = math.exp(-((size / self.number("stribeck_speed")) ** self.number("stribeck_exponent", 2.0)))
        return (self.coefficient * (1 - fall) + self.static * fall) * math.tanh(size / self.number("transition_speed"))
