"""The laws of films, from the equations of their pressures, against the rows of a trace.

Pressures are integrated over the film here: of the long bearing (Sommerfeld, positive part), of the short one (Ocvirk), of the
oscillating film from the flow in a gap, of rough surfaces over the arc where they touch; that of a film of finite length is found
by a solver of its own, on a coarse grid. The closed form of Pinkus and Sternlicht is the printed one.
"""
from __future__ import annotations

import bisect
import cmath
import functools
import math

from .mechanics import Row, Vector
from .trace import Run

MOST_TABLE_ERROR = 0.15  # of the force; a table that is less accurate is reported, whatever it states
RATIO = 2.0     # from one piece of the film to the next one away from the thinnest place
NODES = ((-0.9739065285171717, 0.0666713443086881), (-0.8650633666889845, 0.1494513491505806), (-0.6794095682990244, 0.2190863625159820),
         (-0.4333953941292472, 0.2692667193099963), (-0.1488743389816312, 0.2955242247147529))   # of Gauss and Legendre, the left half
GRIDS = ((96, 8), (48, 4))  # nodes round a film of finite length, and along half of it
GRID_ERROR = (0.015, 1.0)   # possible error of the force extrapolated from both, of the force and of their difference: 192 forces, in gaps of 1e-4
# to 0.5, were off by at most 0.86 of it
SWEEPS = 600    # at most, of its relaxation
GAP_AT_WALL = 1e-6   # 1 - eps at which films that do not end at the wall are held


def gauss(function, start: float, end: float) -> list[float]:
    """Integrals of a pair of functions over one piece."""
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    sums = [0.0, 0.0]
    for at, weight in NODES:
        for place in (middle + half * at, middle - half * at):
            one, two = function(place)
            sums[0] += weight * one
            sums[1] += weight * two
    return [half * value for value in sums]


def over_arc(function, start: float, end: float, scale: float) -> Vector:
    """Integrals of a pair of functions of phi from start to end, between -2 pi and 2 pi, in pieces that grow from the thinnest place,
    phi = 0, where the functions change within `scale`, and from 2 pi and -2 pi likewise."""
    marks = {start, end}
    for turn in (-2 * math.pi, 0.0, 2 * math.pi):
        width = 0.5 * scale
        marks.add(turn)
        while width < math.pi:
            marks |= {turn - width, turn + width}
            width *= RATIO
    inside = [mark for mark in sorted(marks) if start <= mark <= end]
    pieces = [gauss(function, a, b) for a, b in zip(inside, inside[1:])]
    return math.fsum(piece[0] for piece in pieces), math.fsum(piece[1] for piece in pieces)


def half_circle(scale: float) -> list[tuple[float, float]]:
    """Places from 0 to pi with their weights in an integral of an even function over the whole circle, which changes within `scale`
    at 0: of Gauss and Legendre in pieces that grow."""
    found, start, end = [], 0.0, 0.5 * scale
    while start < math.pi:
        end = min(end, math.pi)
        middle, half = 0.5 * (start + end), 0.5 * (end - start)
        found += [(middle + side * half * at, 2 * half * weight) for at, weight in NODES for side in (1, -1)]
        start, end = end, end + RATIO * (end - start)
    return found


class Film:
    """The film of a joint's case. Forces are on the pin [N], along n = e/|e| and t."""

    def __init__(self, run: Run) -> None:
        number, text = run.number, run.text
        self.law, self.variant = text("lubrication.law"), text("lubrication.variant")
        self.cavitation = text("lubrication.cavitation")
        self.clearance, self.length = number("joint.clearance"), number("joint.bearing_length")
        self.radius = number("joint.bearing_radius") - self.clearance
        self.viscosity, self.kinematic = viscosities(run)
        self.least = number("lubrication.least_film_ratio")
        self.scale = self.viscosity * self.length * self.radius**3 / self.clearance**2
        self.lever = number("mechanism.crank_length") / number("mechanism.rod_length", 1.0)
        self.axis_offset = number("mechanism.axis_offset") / number("mechanism.rod_length", 1.0)
        self.is_solved = self.law == "finite_bearing" and self.variant != "short"
        self.table_error = min(float(run.summary.get("film_table_error", 0.0)), MOST_TABLE_ERROR)

    @property
    def is_known(self) -> bool:
        """Whether there is an equation for it here."""
        return self.law != "oscillating_film" or self.variant == "bearing_frame"

    def force(self, eps: float, gap: float, along: float, across: float, pin_speed: float) -> Vector:
        """At the eccentricity ratio eps, gap = 1 - eps, with the pin's centre moving so along n and t [m/s], and both surfaces together
        turning by `pin_speed` [rad/s]: radial and tangential force."""
        b, t = self.squeeze_and_wedge(eps, along, across, pin_speed)
        if self.law == "finite_bearing":
            if self.variant == "short":
                found = self.short(eps, gap, b, t)
            else:
                found = finite(self.slenderness, self.cavitation, eps, gap, b, t)[0]
        elif self.variant == "half_film":
            found = self.half(eps, gap, b, t)
        else:
            found = self.closed(eps, gap, b, t)
        return self.scale * found[0], self.scale * found[1]

    def margin(self, eps: float, gap: float, along: float, across: float, pin_speed: float) -> float:
        """Possible relative error of that force: of the coarse solutions here, and of the program's table, as it states."""
        if not self.is_solved:
            return 0.0
        return self.table_error + finite(self.slenderness, self.cavitation, eps, gap, *self.squeeze_and_wedge(eps, along, across, pin_speed))[1]

    def squeeze_and_wedge(self, eps: float, along: float, across: float, pin_speed: float) -> Vector:
        """v* = e' - (omega/2) z x e along n and t [1/s], e over the clearance."""
        return along / self.clearance, across / self.clearance - 0.5 * eps * pin_speed

    @property
    def slenderness(self) -> float:
        return round(0.5 * self.length / self.radius, 12)

    def closed(self, eps: float, gap: float, b: float, t: float) -> Vector:
        """(5.34) to (5.37) with W eps = -2 t; (5.36) with its misprinted sign where the case asks for that."""
        if not b:
            b = 1e-300
        open_ = gap * (1 + eps)   # 1 - eps^2, exact near the wall
        turn = -2 * t / eps
        k = math.sqrt(open_ * ((turn / (2 * b))**2 + 1 / eps**2))
        if b > 0:
            share = (k + 3) / (k + 1.5)
            radial = -6 * b / ((2 + eps**2) * open_**1.5) * (4 * k * eps**2 + (2 + eps**2) * math.pi * share)
        else:
            share = k / (k + 1.5)
            radial = 6 * b / ((2 + eps**2) * open_**1.5) * (4 * k * eps**2 - (2 + eps**2) * math.pi * share)
            if self.variant == "as_printed":
                radial = -radial
        return radial, 6 * math.pi * eps * turn / ((2 + eps**2) * math.sqrt(open_)) * share

    @staticmethod
    def half(eps: float, gap: float, b: float, t: float) -> Vector:
        """The pressure (5.20) of the long bearing where it is positive: between two zeros, found by halving."""
        def pressure(phi: float) -> float:
            h = gap + 2 * eps * math.sin(0.5 * phi)**2
            wedge = 2 * t * math.sin(phi) * (2 - eps * math.cos(phi))
            squeeze = b * (4 * math.cos(phi) - eps * math.cos(2 * phi))   # (1/h^2 - 2/(2 + eps^2))/eps times (2 + eps^2) h^2
            return 6 * (wedge + squeeze) / ((2 + eps**2) * h**2)

        def part(phi: float) -> Vector:
            p = pressure(phi)
            return -p * math.cos(phi), -p * math.sin(phi)

        kappa = math.sqrt(gap / (1 + eps))
        places = [2 * math.atan2(kappa**power * math.sin(0.5 * s), math.cos(0.5 * s)) for s in
                  (2 * math.pi * (i + 0.5) / 90 - math.pi for i in range(90)) for power in (0, 0.5, 1)]
        places = sorted(places)
        signs = [pressure(phi) > 0 for phi in places]
        zeros = []
        for i, phi in enumerate(places):
            if signs[i] == signs[i - 1]:
                continue
            low, high = places[i - 1] - (2 * math.pi if i == 0 else 0.0), phi
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if (pressure(middle) > 0) == signs[i - 1] else (low, middle)
            zeros.append((0.5 * (low + high), signs[i]))
        if len(zeros) != 2:
            return math.nan, math.nan
        start, end = next(z for z, rises in zeros if rises), next(z for z, rises in zeros if not rises)
        return over_arc(part, start, end if end > start else end + 2 * math.pi, kappa)

    def short(self, eps: float, gap: float, b: float, t: float) -> Vector:
        """6 (b cos phi + t sin phi) (lambda^2 - zeta^2)/H^3 where it is positive."""
        alpha = math.atan2(t, b)
        width = 4 * (0.5 * self.length / self.radius)**2 * math.hypot(b, t)

        def part(phi: float) -> Vector:
            p = width * math.cos(phi - alpha) / (gap + 2 * eps * math.sin(0.5 * phi)**2)**3
            return -p * math.cos(phi), -p * math.sin(phi)

        return over_arc(part, alpha - 0.5 * math.pi, alpha + 0.5 * math.pi, math.sqrt(gap))

    def oscillating(self, row: Row, eps: float, gap: float) -> tuple[complex, float]:
        """Its tangential force [N] is the real part, the magnitude is the largest force in a period at this place; and the sum of
        the magnitudes of its parts, whose rounding it contains. The gap's flow under i w rho V = -P'/R + mu V'', V = U at the pin, 0
        at the bearing, is the same all round, and P comes back to itself. U follows the rod of the mechanism with ideal joints."""
        turn = self.lever * math.sin(row.q) - self.axis_offset
        slope = math.sqrt(1 - turn**2)
        speed = -self.lever * math.cos(row.q) * row.turn / slope
        rate = (self.lever * math.sin(row.q) * row.turn**2 - speed**2 * turn) / slope
        w, rho = abs(row.turn), self.viscosity / self.kinematic
        surface = self.radius * complex(speed, -rate / w)
        root = cmath.sqrt(1j * w / self.kinematic)
        held = max(gap, self.least, GAP_AT_WALL)
        eps = 1 - held if held > gap else eps
        kappa = math.sqrt(held / (1 + eps))
        moved, held_back, shares = [], [], []
        for theta, weight in half_circle(kappa):
            h = self.clearance * (held + 2 * eps * math.sin(0.5 * theta)**2)
            half = 0.5 * root * h
            slow = cmath.tanh(half) / half
            moved.append(0.5 * h * surface * slow)                                   # flow with the surface
            held_back.append(h * slow_rest(half) / (1j * w * rho * self.radius))     # and against a gradient of 1
            shares.append((weight, theta, h, half, slow))
        flow = sum(s[0] * m / r for s, m, r in zip(shares, moved, held_back)) / sum(s[0] / r for s, r in zip(shares, held_back))
        total, size = 0j, 0.0
        for (weight, theta, h, half, slow), m, r in zip(shares, moved, held_back):
            gradient = (m - flow) / r
            shear = -self.viscosity * surface * 2 * half / h / cmath.tanh(2 * half) - gradient * h * slow / (2 * self.radius)
            total += weight * math.cos(theta) * (shear - gradient)
            size += weight * (abs(shear) + abs(gradient))
        return self.radius * self.length * total, self.radius * self.length * size


def slow_rest(half: complex) -> complex:
    """1 - tanh(z)/z, without a cancellation where z is small."""
    if abs(half) > 0.1:
        return 1 - cmath.tanh(half) / half
    z = half**2
    return z * (1 / 3 - z * (2 / 15 - z * (17 / 315 - z * (62 / 2835 - z * (1382 / 155925 - z * 21844 / 6081075)))))


@functools.lru_cache(maxsize=4096)
def finite(half_length: float, cavitation: str, eps: float, gap: float, b: float, t: float) -> tuple[Vector, float]:
    """Force over mu L R^3/c^2 of a film of finite length, extrapolated from two grids, and its possible relative error."""
    speed, alpha = math.hypot(b, t), math.atan2(t, b)
    if not speed:
        return (0.0, 0.0), 0.0
    fine, coarse = (on_grid(grid, half_length, cavitation, eps, gap, alpha) for grid in GRIDS)
    found = tuple(speed * (4 * one - other) / 3 for one, other in zip(fine, coarse))
    apart = speed * math.dist(fine, coarse) / (math.hypot(*found) or 1.0)
    return found, GRID_ERROR[0] + GRID_ERROR[1] * apart


def on_grid(grid: tuple[int, int], half_length: float, cavitation: str, eps: float, gap: float, alpha: float) -> Vector:
    """That force for a velocity of 1 in the direction alpha: control volumes, relaxed place by place."""
    n, m = grid
    kappa = math.sqrt(gap / (1 + eps))
    scales = (kappa, kappa**0.5, 1.0)

    def place(s: float) -> float:
        low, high = -math.pi, math.pi
        for _ in range(50):
            middle = 0.5 * (low + high)
            found = sum(2 * math.atan2(math.sin(0.5 * middle), scale * math.cos(0.5 * middle)) for scale in scales) / len(scales)
            low, high = (middle, high) if found < s else (low, middle)
        return 0.5 * (low + high)

    def height(phi: float) -> float:
        return gap + 2 * eps * math.sin(0.5 * phi)**2

    nodes = [place(2 * math.pi * (i + 0.5) / n - math.pi) for i in range(n)]
    faces = [place(2 * math.pi * i / n - math.pi) for i in range(n)] + [math.pi]   # face i is before node i
    gaps = [(nodes[i] - nodes[i - 1]) % (2 * math.pi) for i in range(n)]
    ahead = [height(faces[i])**3 / gaps[i] for i in range(n)]
    cubes = [sum(height(faces[i] + (faces[i + 1] - faces[i]) * (k + 0.5) / 8)**3 for k in range(8)) / 8 * (faces[i + 1] - faces[i])
             for i in range(n)]
    source = [12 * (math.sin(faces[i + 1] - alpha) - math.sin(faces[i] - alpha)) for i in range(n)]
    fine = min(max(kappa, 0.02), 0.5)   # of the length: the places along it lie closer to its end
    stretch = math.asinh(1 / fine)
    at = [half_length * (1 - fine * math.sinh(stretch * (1 - j / m))) for j in range(m + 1)]
    at[0], at[m] = 0.0, half_length
    edges = [0.0] + [0.5 * (at[j] + at[j + 1]) for j in range(m)]
    widths = [edges[j + 1] - edges[j] for j in range(m)]
    steps = [1 / (at[j + 1] - at[j]) for j in range(m)]
    p = [[0.0] * (m + 1) for _ in range(n)]
    over = 2 / (1 + math.pi / n)
    for _ in range(SWEEPS):
        change, largest = 0.0, 0.0
        for i in range(n):
            mine, before, after = p[i], p[i - 1], p[(i + 1) % n]
            left, right, cube, push = ahead[i], ahead[(i + 1) % n], cubes[i], source[i]
            for j in range(m):
                width, out = widths[j], cube * steps[j]
                total = left * before[j] + right * after[j]
                weight = (left + right) * width + out
                total = total * width + out * mine[j + 1] + push * width
                if j:
                    back = cube * steps[j - 1]
                    total += back * mine[j - 1]
                    weight += back
                new = mine[j] + over * (total / weight - mine[j])
                if cavitation == "reynolds" and new < 0:
                    new = 0.0
                change = max(change, abs(new - mine[j]))
                largest = max(largest, abs(new))
                mine[j] = new
        if change <= 1e-6 * largest:
            break
    radial = across = 0.0
    for i in range(n):
        for j in range(m):
            value = p[i][j] if cavitation == "none" else max(p[i][j], 0.0)
            radial -= value * widths[j] * (math.sin(faces[i + 1]) - math.sin(faces[i]))
            across += value * widths[j] * (math.cos(faces[i + 1]) - math.cos(faces[i]))
    return radial / half_length, across / half_length


class Asperities:
    """Rough surfaces that touch through a film (Greenwood and Tripp), and the mean gap that they leave (Patir and Cheng)."""

    def __init__(self, run: Run) -> None:
        number = run.number
        self.roughness, self.clearance = number("asperities.roughness"), number("joint.clearance")
        self.coefficient, self.speed = number("asperities.coefficient"), number("asperities.transition_speed")
        moduli, poisson = run.pair("asperities.youngs_modulus"), run.pair("asperities.poissons_ratio")
        combined = 1 / sum((1 - nu**2) / e for nu, e in zip(poisson, moduli))
        factor = 16 * math.sqrt(2) * math.pi / 15 * number("asperities.density_product")**2 * math.sqrt(number("asperities.sharpness"))
        self.scale = factor * combined * number("joint.bearing_radius") * number("joint.bearing_length")
        self.is_fit = run.text("asperities.integral") == "fit"

    def mean_gap(self, h: float) -> Vector:
        """The gap, and its slope."""
        slope = 0.5 * math.erfc(-h / (math.sqrt(2) * self.roughness))
        return h * slope + self.roughness / math.sqrt(2 * math.pi) * math.exp(-0.5 * (h / self.roughness)**2), slope

    def force(self, size: float, h: float) -> float:
        """Towards the middle [N], at the eccentricity `size`, h = c - size."""
        return self.forces(size, h)[0]

    def forces(self, size: float, h: float) -> Vector:
        """That force, and the sum of the pressing forces without regard to their direction."""
        reach = (4.0 if self.is_fit else 8.0) * self.roughness
        if h >= reach:
            return 0.0, 0.0
        last = math.pi if reach - h >= 2 * size else 2 * math.asin(math.sqrt((reach - h) / (2 * size)))
        points = 400
        along = whole = 0.0
        for i in range(points):
            theta = last * (i + 0.5) / points
            one = self.pressure((h + 2 * size * math.sin(0.5 * theta)**2) / self.roughness)
            along += math.cos(theta) * one
            whole += one
        return tuple(2 * self.scale * total * last / points for total in (along, whole))

    def pressure(self, h: float) -> float:
        if self.is_fit:
            return 4.4086e-5 * max(4 - h, 0.0)**6.804
        return table_of_means()(h)


@functools.lru_cache(maxsize=1)
def table_of_means():
    """F52(H), the mean of (u - H)^(5/2) over u > H for Gaussian u: with u = H + x^2 by the trapezoidal rule, then between values of H a
    cubic through the logarithms of four."""
    step, first, last = 0.02, -12.0, 8.2
    count = round((last - first) / step) + 1
    places = [first + step * i for i in range(count)]
    logs = []
    for h in places:
        most = math.sqrt(max(-h, 0.0) + 10)
        xs = [most * (i + 0.5) / 400 for i in range(400)]
        logs.append(math.log(math.fsum(2 * x**6 * math.exp(-0.5 * (h + x * x)**2) for x in xs) * most / 400 / math.sqrt(2 * math.pi)))

    def mean(h: float) -> float:
        if h < first + step:
            return (-h)**2.5 * (1 + 1.875 / h**2)
        i = min(max(bisect.bisect(places, h) - 2, 0), count - 4)
        u = (h - places[i]) / step
        a, b, c, d = logs[i:i + 4]
        return math.exp(-a * (u - 1) * (u - 2) * (u - 3) / 6 + b * u * (u - 2) * (u - 3) / 2 - c * u * (u - 1) * (u - 3) / 2
                        + d * u * (u - 1) * (u - 2) / 6)
    return mean


def density_at(run: Run, temperature: float) -> float:
    """Density of the oil [kg/m^3] by table 54D of ASTM D1250."""
    rho = run.number("lubrication.density")
    way = 0.6278 * (temperature - 288.15) / rho
    return rho * math.exp(-way * (1 + 0.8 * way))


def viscosities(run: Run, temperature: float | None = None) -> tuple[float, float]:
    """Dynamic [Pa s] and kinematic viscosity [m^2/s] of the oil: as the case has them, or by ASTM D341 or Vogel's equation from two
    others at the film's temperature or another one."""
    law = run.text("lubrication.viscosity_law")
    if law in ("", "given"):
        return run.number("lubrication.viscosity"), run.number("lubrication.kinematic_viscosity")
    (t1, t2), (nu1, nu2) = run.pair("lubrication.known_temperatures"), run.pair("lubrication.known_viscosities")
    t = run.number("lubrication.temperature") if temperature is None else temperature
    if law == "vogel":
        pole = run.number("lubrication.vogel_temperature")
        share = (1 / (t - pole) - 1 / (t2 - pole)) / (1 / (t1 - pole) - 1 / (t2 - pole))
        nu = nu1**share * nu2**(1 - share)
    else:
        def sum_of(nu: float) -> float:
            return 1e6 * nu + 0.7 + math.exp(-1.47 - 1.84e6 * nu - 0.51e12 * nu**2)

        height = [math.log10(math.log10(sum_of(nu))) for nu in (nu1, nu2)]
        wanted = 10 ** 10 ** (height[1] + (height[0] - height[1]) * math.log(t / t2) / math.log(t1 / t2))
        low, high = 1e-12, 1e30
        for _ in range(400):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if sum_of(middle) < wanted else (low, middle)
        nu = low
    return density_at(run, t) * nu, nu
