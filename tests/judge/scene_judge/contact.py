"""Contact laws and geometries, from their published equations, against the rows of a trace."""
from __future__ import annotations

import bisect
import math
from collections.abc import Callable

from .trace import Run


def root(rises: Callable[[float], float], low: float, high: float) -> float:
    """The zero of an increasing function, by bisection."""
    for _ in range(200):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (middle, high) if rises(middle) < 0 else (low, middle)
    return (low + high) / 2


def simpson(values: list[float], step: float) -> float:
    return step / 3 * (values[0] + values[-1] + 4 * sum(values[1:-1:2]) + 2 * sum(values[2:-1:2]))


class Geometry:
    """The elastic force as a function of the penetration, for the geometry that a case names."""

    def __init__(self, run: Run) -> None:
        self.number = lambda key: run.number(f"contact.{key}")
        self.clearance, self.bore, self.length = (run.number(f"joint.{key}") for key in ("clearance", "bearing_radius", "bearing_length"))
        (e1, e2), (nu1, nu2) = run.pair("contact.youngs_modulus"), run.pair("contact.poissons_ratio")
        self.give = (1 - nu1**2) / e1 + (1 - nu2**2) / e2
        self.name = run.text("contact.geometry")
        self.force: Callable[[float], float] = getattr(self, self.name)
        self.exponent = run.number("contact.exponent", 2.0)   # largest exponent of the force's growth with the penetration

    def hertz_sphere(self, depth: float) -> float:
        """F = K d^n."""
        stiffness = self.number("stiffness")
        if not stiffness:
            pin = self.bore - self.clearance
            stiffness = 4 / (3 * self.give) * math.sqrt(self.bore * pin / self.clearance)
        return stiffness * depth**self.exponent

    def johnson(self, depth: float) -> float:
        """d/c = x [ln(4/x) - 1], x = F/(pi E* L c); from d = 0.3 c on along the tangent."""
        unit, d = math.pi * self.length * self.clearance / self.give, depth / self.clearance
        x = root(lambda x: x * (math.log(4 / x) - 1) - min(d, 0.3), 1e-320, 0.5)
        return unit * (x + max(0.0, d - 0.3) / (math.log(4 / x) - 2))

    def conformal(self, depth: float) -> float:
        return math.pi * self.length * self.clearance / self.give * self.load(depth)

    def load(self, depth: float) -> float:
        """x = F/(pi E* L c) of d/c = x [P(y) - ln y] + W x, y = x/(1 + x)."""
        fit = (2.26404928e-5, 1.74709353, -1.52090276, 1.79797044, -1.78288296, 1.09851009, -0.295968247)

        def depth_of(x: float) -> float:
            y = x / (1 + x)
            return x * (sum(p * y**k for k, p in enumerate(fit)) - math.log(y) + self.number("housing_compliance"))
        d = depth / self.clearance
        return root(lambda x: depth_of(x) - d, 1e-320, 4 * d + 1)

    def pereira(self, depth: float) -> float:
        """F = (0.965 c + 0.0965) L E*/c d^n in N and mm, n = Y c^-0.005."""
        c = 1e3 * self.clearance
        factor = 1.51 * math.log(1e3 * c)**-0.151 if c < 0.34954 else 0.0151 * c + 1.151
        return (0.965 * c + 0.0965) * 1e3 * self.length / (1e6 * self.give) / c * (1e3 * depth)**(factor * c**-0.005)

    def winkler(self, depth: float) -> float:
        """Springs around the bore: the sum of k (penetration at the angle) over the arc in contact."""
        bedding, nu = self.number("bedding_modulus"), self.number("liner_poissons_ratio")
        if not bedding:
            bedding = self.number("liner_modulus") * (1 - nu) / ((1 + nu) * (1 - 2 * nu) * self.number("liner_thickness"))
        half = math.atan2(math.sqrt(depth * (2 * self.clearance + depth)), self.clearance)
        angles = [half * i / 128 for i in range(129)]
        springs = [(depth - 2 * (self.clearance + depth) * math.sin(a / 2)**2) * math.cos(a) for a in angles]
        return 2 * bedding * self.bore * self.length * simpson(springs, half / 128)

    def carried(self, half_angle: float, peak: float) -> tuple[float, float]:
        """The load of a contact arc, by Persson (1964), independently of the penetration: the dimensionless load x that belongs to
        the arc, and the force that results from the pressures with the given peak."""
        b = math.tan(half_angle / 2)
        x = 2 * b**2 * (b**2 + 1) / (2 - math.log(b**2 + 1) - 2 * b**4)
        result, _ = self.over_arc(half_angle)
        return x, peak * self.bore * self.length * result / self.persson(b, 0.0)

    @staticmethod
    def persson(b: float, angle: float) -> float:
        """Pressure of a pin in a bore at an angle from the line of centres, by Persson (1964), times R L/F; b = tan(a/2)."""
        y, rest = math.tan(angle / 2), math.sqrt(max(0.0, b**2 - math.tan(angle / 2)**2))
        near = 2 * math.atanh(rest / math.sqrt(b**2 + 1)) / (2 * math.pi * b**2 * (b**2 + 1))
        return 2 * rest / (math.pi * math.sqrt(b**2 + 1) * (1 + y**2)) + near

    def over_arc(self, half_angle: float) -> tuple[float, float]:
        """Integrals over the arc of Persson's pressure times the cosine of the angle, and of the pressure."""
        b = math.tan(half_angle / 2)
        # the angle is half_angle sin(s), because the pressure goes to zero like a square root
        steps = [math.pi / 2 * i / 256 for i in range(257)]
        shape = [self.persson(b, half_angle * math.sin(s)) * math.cos(s) for s in steps]
        along = [one * math.cos(half_angle * math.sin(s)) for one, s in zip(shape, steps)]
        return 2 * half_angle * simpson(along, math.pi / 512), 2 * half_angle * simpson(shape, math.pi / 512)

    def pressing(self, depth: float, half_angle: float) -> float:
        """The forces that press on the surfaces, added without regard to their direction, over the normal force. Geometries without an
        arc touch along a line."""
        if depth <= 0:
            return 1.0
        if self.name == "conformal" and half_angle > 0:
            result, whole = self.over_arc(half_angle)
            return whole / result
        if self.name == "winkler":
            half = math.atan2(math.sqrt(depth * (2 * self.clearance + depth)), self.clearance)
            angles = [half * i / 128 for i in range(129)]
            springs = [depth - 2 * (self.clearance + depth) * math.sin(a / 2)**2 for a in angles]
            return simpson(springs, 1.0) / simpson([one * math.cos(a) for one, a in zip(springs, angles)], 1.0)
        return 1.0


class Contact:
    """F = f(d) [1 + chi d'/d'_0] (Reis 2013, 4.7), d'_0 the speed at which the contact began, with the elastic force of the geometry.

    The program's manual limits it: the force never pulls, the quotient of the rates is at most 100, and a slower impact counts as
    one with the least impact speed."""

    MOST = 100.0
    DAMPING = {
        "hertz": lambda e: 0.0,
        "lankarani_nikravesh": lambda e: 3 * (1 - e**2) / 4,
        "hunt_crossley": lambda e: 3 * (1 - e) / 2,
        "herbert_mcwhannell": lambda e: 6 * (1 - e) / ((2 * e - 1)**2 + 3),
        "gonthier": lambda e: (1 - e**2) / e,
        "zhiying_qishao": lambda e: 3 / 4 * (1 - e**2) * math.exp(2 * (1 - e)),
        "flores": lambda e: 8 * (1 - e) / (5 * e),
        "carvalho_martins": lambda e: 3 / 2 * (1 - e) * (11 - e) / (1 + 9 * e) if 3 * e > 1 else (1 - e**2) / e,
    }

    def __init__(self, run: Run) -> None:
        self.law = run.text("contact.law")
        self.geometry = Geometry(run)
        self.dissipation = run.number("contact.dissipation")
        self.damper, self.full = run.number("contact.damping"), run.number("contact.full_damping_depth")
        e = run.number("contact.restitution")
        self.loss = 0.0
        if self.law == "exact" and e < 1:
            self.loss = self.exact(e)
        elif self.law in self.DAMPING and not self.dissipation:
            self.loss = self.DAMPING[self.law](e)
        self.least = run.number("contact.least_impact_speed", 1e-5)
        begins = [event for event in run.events if event["event"] == "contact_begins"]
        self.begin = [float(event["time[s]"]) for event in begins]
        self.speed = [float(event["normal_speed[m/s]"]) for event in begins]
        self.pressed = False   # the first contact is present at the start, and its impact speed is not known yet

    @staticmethod
    def exact(e: float) -> float:
        """The chi for which a free impact has the restitution e: chi (1 + e) = ln[(1 + chi)/(1 - chi e)]."""
        if 1 - e < 1e-3:
            h = 1 - e
            return 3 / 2 * h * (1 + h)   # two terms of the series
        return root(lambda chi: math.log1p(chi) - math.log1p(-chi * e) - chi * (1 + e), (1 - e) / 2, (1 - 1e-15) / e)

    def learn(self, depth: float, rate: float, time: float, normal: float) -> bool:
        """The impact speed of a contact that is present at the start follows from the first row with a clear damping force. Whether the
        contact at this time has a known speed."""
        if not (self.pressed and self.loss and depth > 0) or bisect.bisect_right(self.begin, time * (1 + 1e-9)) > 1:
            return True
        damping = normal / self.geometry.force(depth) - 1
        if normal <= 0 or abs(damping) < 0.01:
            return False
        self.speed[0], self.pressed = self.loss * rate / damping, False
        return True

    def force(self, depth: float, rate: float, time: float) -> float:
        return max(0.0, sum(self.terms(depth, rate, time)))

    def size(self, depth: float, rate: float, time: float) -> float:
        """Sum of the magnitudes of the elastic and the damping force, which may cancel each other."""
        return sum(map(abs, self.terms(depth, rate, time)))

    def terms(self, depth: float, rate: float, time: float) -> tuple[float, float]:
        """Elastic and damping force."""
        if depth <= 0:
            return 0.0, 0.0
        elastic = self.geometry.force(depth)
        if self.law == "impact":
            s = min(1.0, depth / self.full)
            return elastic, self.damper * (3 * s**2 - 2 * s**3) * rate
        if self.dissipation:
            return elastic, elastic * self.dissipation * rate
        began = bisect.bisect_right(self.begin, time * (1 + 1e-9)) - 1
        first = max(self.speed[began] if began >= 0 else 0.0, self.least)
        return elastic, elastic * self.loss * min(rate / first, self.MOST)
