"""The laws of friction and film, from their published equations, against the rows of a trace."""
from __future__ import annotations

import math

from .mechanics import Row
from .trace import Run

ROUNDING = 1e-14   # of a speed found from those of crank, rod and piston, in their sum


class Friction:
    """Friction over normal force along t, at a sliding speed: Ambrosio (4.9, 4.10), Coulomb (4.8) with a larger friction at rest,
    Threlfall, Brown and McPhee (2016), and Stribeck's curve eased in by a hyperbolic tangent; with bristles of a deflection z that
    follows its own equation: LuGre (1995), Dahl (1968), elasto-plastic (Dupont et al. 2002)."""

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
        """Least and largest friction over normal force along t at a sliding speed known to +- `give`."""
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
        """Of bristles that slide on, without the viscous part."""
        if self.static == self.coefficient:
            return self.coefficient
        fall = math.exp(-((v / self.number("stribeck_speed")) ** 2))
        return self.static * fall + self.coefficient * (1 - fall)

    def side(self, v: float, z: float) -> tuple[int, bool]:
        """On which side of what is not smooth: the sense of sliding, bristles that give way."""
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
        """As `range`, with the deflection z of the bristles [m]."""
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


def viscosity(run: Run) -> float:
    """Dynamic viscosity of the oil [Pa s]: as the case has it, or by ASTM D341 or Vogel's equation from two others; the density by table
    54D of ASTM D1250."""
    law = run.text("lubrication.viscosity_law")
    if law in ("", "given"):
        return run.number("lubrication.viscosity")
    (t1, t2), (nu1, nu2) = run.pair("lubrication.known_temperatures"), run.pair("lubrication.known_viscosities")
    t, rho = run.number("lubrication.temperature"), run.number("lubrication.density")
    if law == "vogel":
        pole = run.number("lubrication.vogel_temperature")
        share = (1 / (t - pole) - 1 / (t2 - pole)) / (1 / (t1 - pole) - 1 / (t2 - pole))
        nu = nu1**share * nu2**(1 - share)
    else:
        def height(nu: float) -> float:
            return math.log10(math.log10(1e6 * nu + 0.7 + math.exp(-1.47 - 1.84e6 * nu - 0.51e12 * nu**2)))
        wanted = height(nu2) + (height(nu1) - height(nu2)) * math.log(t / t2) / math.log(t1 / t2)
        low, high = 1.7e-7, 1e30
        for _ in range(400):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if height(middle) < wanted else (low, middle)
        nu = low
    way = 0.6278 * (t - 288.15) / rho
    return rho * math.exp(-way * (1 + 0.8 * way)) * nu


def squeeze_film(run: Run, row: Row, slip: tuple[float, float]) -> tuple[float, float]:
    """Force on the pin of the Pinkus-Sternlicht film, the closed form (5.34 to 5.37, the sign of 5.36 corrected) [N]. One that gives way
    to the contact over a depth is that of the eccentricity ratio 1 - q, where the pin is beyond it."""
    c, get = run.number("joint.clearance"), row.get
    e = get["eccentricity_x"], get["eccentricity_y"]
    size = math.hypot(*e)
    n = (e[0] / size, e[1] / size)
    gap = get["film_thickness"] / c
    eps = size / c
    least = run.number("lubrication.least_film_ratio") if run.text("lubrication.transition") == "weighted" else 0.0
    if gap < least:
        gap, eps = least, 1 - least
    open_ = gap * (1 + eps)   # 1 - eps^2, exact near the wall
    rate = (n[0] * slip[0] + n[1] * slip[1]) / c
    turn = row.journal_turn + row.bearing_turn - 2 * (n[0] * slip[1] - n[1] * slip[0]) / (eps * c)
    scale = viscosity(run) * run.number("joint.bearing_length") * (run.number("joint.bearing_radius") - c)**3 / c**2
    k = math.sqrt(open_ * ((turn / (2 * rate))**2 + 1 / eps**2))
    if rate > 0:
        share = (k + 3) / (k + 1.5)
        radial = -6 * scale * rate / ((2 + eps**2) * open_**1.5) * (4 * k * eps**2 + (2 + eps**2) * math.pi * share)
    else:
        share = k / (k + 1.5)
        radial = 6 * scale * rate / ((2 + eps**2) * open_**1.5) * (4 * k * eps**2 - (2 + eps**2) * math.pi * share)
    along = 6 * scale * math.pi * eps * turn / ((2 + eps**2) * math.sqrt(open_)) * share
    return radial * n[0] - along * n[1], radial * n[1] + along * n[0]
