"""A rod that bends and stretches and a crankshaft that twists, by Lagrange's equations.

The points of the rod are at xi + u - sigma along the chord from pin to pin and at w across it. Mass integrals of the shapes are
computed by Gauss's rule from the shapes themselves. The kinetic energy is of second order in the amplitudes. Its derivatives in the
equations of motion are found by complex-step differentiation along the motion, not by formulas.
"""
from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from .trace import Run

Vector = tuple[float, float]
STEP = 1e-40       # complex step of the differentiation
POINTS = 48        # points of Gauss's rule


def gauss(n: int) -> list[tuple[float, float]]:
    """Points and weights of Gauss's rule on [0, 1]."""
    found = []
    for i in range(n):
        x = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(50):
            before, here = 1.0, x
            for k in range(2, n + 1):
                before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
            slope = n * (x * here - before) / (x * x - 1)
            x -= here / slope
            if abs(here / slope) < 1e-16:
                break
        found.append(((1 - x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return found


class ElasticRod:
    """Constants of the shapes, transverse shapes first. A state is (A, amplitudes...), where A is the angle of the chord from y to
    x."""

    def __init__(self, run: Run) -> None:
        n = run.number
        self.length = length = n("mechanism.rod_length")
        self.mass, self.inertia, self.com = n("mechanism.rod_mass"), n("mechanism.rod_inertia"), run.pair("mechanism.rod_com")
        self.across, self.along = int(n("elastic_rod.transverse_modes")), int(n("elastic_rod.axial_shapes"))
        self.names = [f"rod_mode_{k + 1}" for k in range(self.across)]
        self.names += ["rod_stretch" if j == 0 else f"rod_axial_{j + 1}" for j in range(self.along)]
        shank = n("elastic_rod.shank_mass")
        if not shank > 0:
            shank = min(self.mass, 2 * self.mass * self.com[0] / length, 2 * self.mass * (1 - self.com[0] / length))
        at_end = self.mass * self.com[0] / length - shank / 2
        young, area, second = n("elastic_rod.youngs_modulus"), n("elastic_rod.section_area"), n("elastic_rod.section_inertia")
        points = gauss(POINTS)
        places = [(x * length, shank * w) for x, w in points] + [(length, at_end)]

        def mass_integral(f) -> float:
            return math.fsum(m * f(xi) for xi, m in places)

        def phi(k: int, xi: float) -> float:
            return math.sin((k + 1) * math.pi * xi / length) if xi < length else 0.0

        def psi(j: int, xi: float) -> float:
            return xi / length if j == 0 else phi(j - 1, xi)

        def drawn(i: int, k: int, xi: float) -> float:
            """int phi_i' phi_k' from 0 to xi."""
            a, b = (i + 1) * math.pi / length, (k + 1) * math.pi / length
            if i == k:
                return a * a * (xi / 2 + math.sin(2 * a * xi) / (4 * a))
            return a * b / 2 * (math.sin((a - b) * xi) / (a - b) + math.sin((a + b) * xi) / (a + b))

        rows, columns = range(self.across), range(self.along)
        self.s = [mass_integral(lambda xi, k=k: phi(k, xi)) for k in rows]
        self.t = [mass_integral(lambda xi, k=k: xi * phi(k, xi)) for k in rows]
        self.m = [mass_integral(lambda xi, k=k: phi(k, xi)**2) for k in rows]
        self.p = [[mass_integral(lambda xi, i=i, k=k: drawn(i, k, xi)) for k in rows] for i in rows]
        self.q = [[mass_integral(lambda xi, i=i, k=k: xi * drawn(i, k, xi)) for k in rows] for i in rows]
        self.z0 = [mass_integral(lambda xi, j=j: psi(j, xi)) for j in columns]
        self.z1 = [mass_integral(lambda xi, j=j: xi * psi(j, xi)) for j in columns]
        self.ma = [[mass_integral(lambda xi, i=i, j=j: psi(i, xi) * psi(j, xi)) for j in columns] for i in columns]
        self.z = [[mass_integral(lambda xi, j=j, k=k: psi(j, xi) * phi(k, xi)) for k in rows] for j in columns]
        self.drawn_in = [drawn(k, k, length) for k in rows]   # twice b_k
        self.slopes = [[(k + 1) * math.pi / length * end for k in rows] for end in (1,)]
        self.slopes.append([slope * (-1)**(k + 1) for k, slope in enumerate(self.slopes[0])])
        bend = [young * second * ((k + 1) * math.pi / length)**4 * length / 2 for k in rows]
        pull = [young * area / length * (1 if j == 0 else (j * math.pi)**2 / 2) for j in columns]
        self.stiffness = bend + pull
        self.damping = [2 * n("elastic_rod.damping_ratio") * math.sqrt(k * m) for k, m in zip(bend, self.m)]
        self.damping += [2 * n("elastic_rod.axial_damping_ratio") * math.sqrt(k * self.ma[j][j]) for j, k in enumerate(pull)]

    @property
    def frequencies(self) -> dict[str, float]:
        """Natural angular frequency of each shape alone [rad/s], by its name: with the damping ratio at most 1, no motion of the shape
        by itself is faster."""
        masses = self.m + [self.ma[j][j] for j in range(self.along)]
        return {name: math.sqrt(k / m) if m > 0 else math.inf for name, k, m in zip(self.names, self.stiffness, masses)}

    def first_moment(self, shapes: Sequence) -> tuple:
        """First moment of the rod about its big end, along and across the chord [kg m]."""
        eta, a = shapes[:self.across], shapes[self.across:]
        du = sum(z * x for z, x in zip(self.z0, a))
        for x, row in zip(eta, self.p):
            du -= x * sum(p * y for p, y in zip(row, eta)) / 2
        return self.mass * self.com[0] + du, self.mass * self.com[1] + sum(s * x for s, x in zip(self.s, eta))

    def moment_rate(self, shapes: Sequence, rates: Sequence) -> tuple:
        """Rate of the first moment in the frame of the chord."""
        eta, rate = shapes[:self.across], rates[:self.across]
        du = sum(z * x for z, x in zip(self.z0, rates[self.across:]))
        for x, row in zip(rate, self.p):
            du -= x * sum(p * y for p, y in zip(row, eta))
        return du, sum(s * x for s, x in zip(self.s, rate))

    def turning(self, shapes: Sequence, rates: Sequence) -> tuple:
        """Moment of inertia about the big end [kg m^2], angular momentum of the shapes [kg m^2/s], twice the shapes' own kinetic
        energy."""
        n = self.across
        eta, a, eta_rate, a_rate = shapes[:n], shapes[n:], rates[:n], rates[n:]
        inertia = self.inertia + self.mass * (self.com[0]**2 + self.com[1]**2)
        inertia += sum(m * x * x for m, x in zip(self.m, eta)) + 2 * sum(z * x for z, x in zip(self.z1, a))
        momentum = -sum(t * x for t, x in zip(self.t, eta_rate))
        twice = sum(m * x * x for m, x in zip(self.m, eta_rate))
        for x, row in zip(eta, self.q):
            inertia -= x * sum(q * y for q, y in zip(row, eta))
        for x, v, mass, row in zip(a, a_rate, self.ma, self.z):
            inertia += x * sum(m * y for m, y in zip(mass, a))
            twice += v * sum(m * y for m, y in zip(mass, a_rate))
            momentum += sum(z * (v * y - x * w) for z, y, w in zip(row, eta, eta_rate))
        return inertia, momentum, twice

    def kinetic(self, state: Sequence, rates: Sequence, end: Sequence):
        """Kinetic energy [J] if the centre of the big end moves with the velocity `end`."""
        angle, shapes, turn = state[0], state[1:], rates[0]
        c, s = cmath.cos(angle), cmath.sin(angle)
        along, across = end[0] * c - end[1] * s, end[0] * s + end[1] * c
        first, rate = self.first_moment(shapes), self.moment_rate(shapes, rates[1:])
        inertia, momentum, twice = self.turning(shapes, rates[1:])
        return (self.mass * (end[0]**2 + end[1]**2) / 2 + along * (rate[0] + turn * first[1]) + across * (rate[1] - turn * first[0])
                + (inertia * turn / 2 + momentum) * turn + twice / 2)

    def energies(self, state: Sequence[float], rates: Sequence[float], end: Vector) -> tuple[float, float]:
        """Kinetic energy and strain energy [J]."""
        return self.kinetic(state, rates, end).real, sum(k * x * x for k, x in zip(self.stiffness, state[1:])) / 2

    def from_big_end(self, state: Sequence[float], rates: Sequence[float]) -> tuple[Vector, Vector]:
        """Position and velocity of the centre of mass relative to the big end."""
        (u, v), (du, dv), turn = self.first_moment(state[1:]), self.moment_rate(state[1:], rates[1:]), rates[0]
        c, s = math.cos(state[0]), math.sin(state[0])

        def turned(x: float, y: float) -> Vector:
            return (x * c + y * s) / self.mass, (y * c - x * s) / self.mass
        return turned(u, v), turned(du + turn * v, dv - turn * u)

    def chord(self, shapes: Sequence, rates: Sequence) -> tuple:
        """Length of the chord from pin to pin [m], and its rate."""
        n = self.across
        stretch, speed = (shapes[n], rates[n]) if self.along else (0.0, 0.0)
        return (self.length + stretch - sum(d * x * x for d, x in zip(self.drawn_in, shapes)) / 2,
                speed - sum(d * x * v for d, x, v in zip(self.drawn_in, shapes, rates[:n])))

    def chord_acceleration(self, shapes: Sequence[float], rates: Sequence[float], second: Sequence[float]) -> float:
        """[m/s^2]"""
        moved = self.chord([x + 1j * STEP * v for x, v in zip(shapes, rates)], [v + 1j * STEP * a for v, a in zip(rates, second)])
        return moved[1].imag / STEP

    def end_turn(self, end: int, turn: float, rates: Sequence[float]) -> float:
        """Angular velocity of the rod at its big end (0) or its pin (1), from x to y [rad/s]; the state has that of the chord from
        y to x."""
        return -turn + sum(slope * v for slope, v in zip(self.slopes[end], rates))

    def inertial_forces(self, state: Sequence[float], rates: Sequence[float], second: Sequence[float], end: Vector, end_second: Vector
                        ) -> list[tuple[float, float]]:
        """d/dt dT/dz' - dT/dz for x and y of the big end, the angle of the chord and each shape; and the magnitude of its terms."""
        h = 1j * STEP
        z = [x + h * v for x, v in zip(state, rates)]
        v = [x + h * a for x, a in zip(rates, second)]
        c = [x + h * a for x, a in zip(end, end_second)]

        def momentum_rate(lower: tuple, upper: tuple) -> tuple[float, float]:
            one, two = self.kinetic(z, *upper).imag / STEP, self.kinetic(z, *lower).imag / STEP
            return (one - two) / 2, 1e-7 * (abs(one) + abs(two))   # T is quadratic in the rates, so the difference is exact except for rounding

        found = [momentum_rate((v, (c[0] - (k == 0), c[1] - (k == 1))), (v, (c[0] + (k == 0), c[1] + (k == 1)))) for k in (0, 1)]
        for k in range(len(state)):
            rate, rounding = momentum_rate(([x - (i == k) for i, x in enumerate(v)], c), ([x + (i == k) for i, x in enumerate(v)], c))
            slope = self.kinetic([x + h * (i == k) for i, x in enumerate(state)], rates, end).imag / STEP
            found.append((rate - slope, abs(rate) + abs(slope) + rounding))
        return found

    def applied(self, state: Sequence[float], rates: Sequence[float], weight: Vector, big_end: tuple[Vector, float], pin: tuple[Vector, float]
                ) -> list[list[float]]:
        """Terms of the generalized forces of the same coordinates: weight, force and moment at the big end, force and moment at the
        pin, stiffness and damping; from the virtual work at the displaced pin and centre of mass."""
        shapes = state[1:]
        found = [[self.mass * weight[k], big_end[0][k], pin[0][k]] for k in (0, 1)]
        for k in range(len(state)):
            moved = [x + 1j * STEP * (i == k) for i, x in enumerate(state)]
            c, s = cmath.cos(moved[0]), cmath.sin(moved[0])
            u, v = self.first_moment(moved[1:])
            length = self.chord(moved[1:], [0.0] * len(shapes))[0]
            terms = [weight[0] * (u * c + v * s).imag / STEP, weight[1] * (v * c - u * s).imag / STEP,
                     pin[0][0] * (length * c).imag / STEP, -pin[0][1] * (length * s).imag / STEP]
            if k == 0:
                terms += [-big_end[1], -pin[1]]
            else:
                if k <= self.across:
                    terms += [self.slopes[0][k - 1] * big_end[1], self.slopes[1][k - 1] * pin[1]]
                terms += [-self.stiffness[k - 1] * shapes[k - 1], -self.damping[k - 1] * rates[k]]
            found.append(terms)
        return found


def requested_columns(run: Run) -> list[str]:
    """Names of the columns of elastic members on request that the judge needs."""
    names = []
    if "elastic_rod.section_area" in run.case:
        names += [f"{name}_{what}" for name in ElasticRod(run).names for what in ("rate", "acceleration")]
    if "crankshaft.flywheel_inertia" in run.case:
        names.append("flywheel_acceleration")
    return names
