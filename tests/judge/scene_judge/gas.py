"""The gas in the cylinder: engines, compressors and measured pressures, against the rows of a trace."""
from __future__ import annotations

import bisect
import csv
import math

from .trace import Run

GAUSS_5 = ((0.0, 0.5688888888888889), (0.5384693101056831, 0.47862867049936647), (0.906179845938664, 0.23692688505618908))


class Cylinder:
    """The volume as a function of the crank angle, and the values of the gas that a row of a trace should have. Angles count from
    the dead centre, except those of rows."""

    def __init__(self, run: Run, group: str) -> None:
        self.under = run.number(f"{group}.crankcase_pressure")
        self.area = math.pi / 4 * run.number(f"{group}.bore")**2
        self.crank, self.rod = run.number("mechanism.crank_length"), run.number("mechanism.rod_length")
        self.axis = run.number("mechanism.axis_offset")
        self.top = math.asin(self.axis / (self.rod + self.crank))
        self.bottom = math.pi + math.asin(self.axis / (self.rod - self.crank)) - self.top
        self.highest, self.dead = self.height(0.0), 0.0
        self.rounding = 1e-15 * self.area * (self.crank + self.rod)   # rounding of `volume`, a difference of lengths

    def volume(self, q: float) -> float:
        """Dead volume, plus the distance of the piston from its top position times the area [m^3]."""
        return self.dead + self.area * (self.highest - self.height(q))

    def height(self, q: float) -> float:
        """Height of the piston pin above the crank axis [m]."""
        across = self.crank * math.sin(q + self.top) - self.axis
        return self.crank * math.cos(q + self.top) + math.sqrt((self.rod - across) * (self.rod + across))

    @property
    def displacement(self) -> float:
        return self.area * (self.highest - self.height(self.bottom))

    def wanted(self, i: int, q: float) -> float | None:
        """Pressure of row i, at the crank angle q of the mechanism [Pa]; None if the law does not determine it."""
        return None if self.jumps_near(q - self.top, 1e-7) else self.pressure(q - self.top)

    def part_of(self, i: int, q: float, turn: float) -> int:
        """Part of the cycle; a row on a boundary belongs to the part before it."""
        return self.part(q - self.top - math.copysign(1e-10, turn))

    def pressure(self, q: float) -> float:
        raise NotImplementedError

    def jumps_near(self, q: float, margin: float) -> bool:
        return False

    def part(self, q: float) -> int:
        return 0


class Gas(Cylinder):
    """Engines of appendix A, four-stroke or two-stroke with ports: the first law of thermodynamics for the closed cylinder,
    integrated.

    p V^g = p_1 V_1^g + (g - 1) * integral of V^(g-1) dQ, Wiebe's release Q = Q_in (1 - exp(-a z^n)). An engine whose crank starts, or
    is held, with a negative speed is the mirror image."""

    def __init__(self, run: Run) -> None:
        super().__init__(run, "combustion")
        n = run.number
        self.sense = -1 if n("initial.crank_speed") < 0 else 1
        full = next((key.split(".")[0] for key, value in run.case.items() if key.endswith(".full") and value[0]), "cylinder_1")
        self.exponent, self.heat, self.a, self.n = (n("combustion.heat_capacity_ratio"), n("combustion.heat") * n(f"{full}.heat_scale", 1.0),
                                                    n("combustion.wiebe_efficiency"), n("combustion.wiebe_form"))
        self.start, self.duration = math.radians(n("combustion.start_deg")), math.radians(n("combustion.duration_deg"))
        self.intake = n("combustion.intake_pressure")
        self.loses = "wall_heat.wall_temperature" in run.case or n("working_gas.leak_area", 0.0) > 0   # then not of the angle alone
        self.dead = self.displacement / (n("combustion.compression_ratio") - 1)
        two_strokes = run.text("combustion.cycle") == "two_stroke"
        self.period = (2 if two_strokes else 4) * math.pi
        bottom = self.bottom if self.sense > 0 else 2 * math.pi - self.bottom
        self.closes, self.opens = bottom, 2 * math.pi + bottom
        if two_strokes:
            self.opens = 2 * math.pi + math.radians(n("combustion.port_opens_deg"))
            self.closes = self.same_height(self.opens)
        self.closed = self.intake * self.volume(self.sense * self.closes)**self.exponent
        self.panels = 400
        self.grid = [0.0]
        for i in range(self.panels):
            self.grid.append(self.grid[-1] + self.panel(i / self.panels, (i + 1) / self.panels))

    def same_height(self, opens: float) -> float:
        """The angle on the other side of the bottom dead centre with the height of the piston at `opens`, by bisection."""
        bottom = self.bottom if self.sense > 0 else 2 * math.pi - self.bottom
        low, high, height = bottom, 2 * math.pi, self.height(self.sense * opens)
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.height(self.sense * middle) < height else (low, middle)
        return low

    def source(self, s: float) -> float:
        """V^(g-1) dQ/ds, where s is z, or for a release that begins abruptly z^n."""
        if self.n >= 1:
            z, rate = s, self.n * s**(self.n - 1) if s > 0 or self.n == 1 else 0.0
            burnt = s**self.n
        else:
            z, rate, burnt = s**(1 / self.n), 1.0, s
        return self.volume(self.sense * (self.start + z * self.duration))**(self.exponent - 1) * self.heat * self.a * rate * math.exp(-self.a * burnt)

    def panel(self, low: float, high: float) -> float:
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return half * sum(w * (self.source(middle) if x == 0 else self.source(middle - x * half) + self.source(middle + x * half))
                          for x, w in GAUSS_5)

    def wanted(self, i: int, q: float) -> float | None:
        found = super().wanted(i, q)
        return None if self.loses and found != self.intake else found

    def pressure(self, q: float) -> float:
        """Pressure at the angle q [Pa]."""
        angle = self.closes + (self.sense * q - self.closes) % self.period
        if not angle < self.opens:
            return self.intake
        added = 0.0
        z = min((angle - self.start) / self.duration, 1.0)
        if z > 0:
            s = z if self.n >= 1 else z**self.n
            whole = min(int(s * self.panels), self.panels)
            added = self.grid[whole] + (self.panel(whole / self.panels, s) if whole < self.panels else 0.0)
        return (self.closed + (self.exponent - 1) * added) / self.volume(self.sense * angle)**self.exponent

    def jumps_near(self, q: float, margin: float) -> bool:
        """Whether a part of the cycle begins or ends so near that the row may belong to either side."""
        bounds = (self.closes, self.start, self.start + self.duration, self.opens)
        return any(abs((self.sense * q - bound + margin) % self.period) < 2 * margin for bound in bounds)

    def part(self, q: float) -> int:
        """Number of the part of the cycle, counted through all cycles."""
        cycle, angle = divmod(self.sense * q - self.closes, self.period)
        bounds = (self.start, min(self.start + self.duration, self.opens), self.opens)
        return 4 * int(cycle) + sum(angle + self.closes >= bound for bound in bounds)


class Compressor(Cylinder):
    """Gas behind self-acting valves: while the piston moves in one direction, p = K / V^n between suction and discharge pressure;
    an open valve holds one of these pressures and determines a new K. K is followed from row to row, since a piston may turn back
    anywhere."""

    def __init__(self, run: Run) -> None:
        super().__init__(run, "combustion")
        n = run.number
        self.low, self.high = n("combustion.suction_pressure"), n("combustion.discharge_pressure")
        self.exponent = n("combustion.polytropic_exponent")
        self.dead = self.displacement * n("combustion.dead_space")
        self.rows: list[tuple[float | None, int]] = []   # pressure, and number of the piece between events
        angles, turns = [q - self.top for q in run.columns["crank_angle"]], run.columns["crank_speed"]
        known = self.start(angles[0], turns[0])   # K
        state, piece = "", 0
        for i, q in enumerate(angles):
            if i:
                known = self.reached(known, angles[i - 1], q, turns[i - 1], turns[i])
            if known is None and run.columns["cylinder_pressure"][i] in (self.low, self.high):   # a valve is open
                known = run.columns["cylinder_pressure"][i] * self.volume(q)**self.exponent
            pressure, now = None, "?"
            if known is not None:
                pressure, now = self.held(known, q)
                known = pressure * self.volume(q)**self.exponent
            half_turn = f"{now}{divmod(q, 2 * math.pi)[0]}{q % (2 * math.pi) >= self.bottom}{turns[i] > 0}"
            piece += half_turn != state
            state = half_turn
            self.rows.append((pressure, piece))

    def start(self, q: float, turn: float) -> float:
        """K of a machine that has run for a long time; a machine at rest is filled at the suction pressure."""
        if turn == 0:
            return self.low * self.volume(q)**self.exponent
        full, empty = self.low * self.volume(self.bottom)**self.exponent, self.volume(0.0)**self.exponent
        at = q % (2 * math.pi)
        comes_in = abs(at - self.bottom) < 1e-12 or (at > self.bottom) == (turn > 0) and 1e-12 < at < 2 * math.pi - 1e-12
        return full if comes_in else min(full, self.high * empty)

    def held(self, known: float, q: float) -> tuple[float, str]:
        pressure = known / self.volume(q)**self.exponent
        return (self.low, "suction") if pressure <= self.low else (self.high, "discharge") if pressure >= self.high else (pressure, "closed")

    def reached(self, known: float | None, before: float, here: float, turn_before: float, turn: float) -> float | None:
        """K at the end of a movement, after the dead centres in it. None if the piston turned back between two rows with a valve
        open, or made a whole stroke between them: then the rows do not determine K."""
        if abs(here - before) > math.pi:
            return None
        first, last = sorted((before, here))
        between = [one + 2 * math.pi * k for one in (0.0, self.bottom)
                   for k in range(math.ceil((first - one) / (2 * math.pi)), math.floor((last - one) / (2 * math.pi)) + 1)]
        for one in sorted(between):
            if known is not None:
                known = self.held(known, one)[0] * self.volume(one)**self.exponent
        if known is not None and turn_before * turn <= 0 and {self.held(known, q)[1] for q in (before, here)} != {"closed"}:
            return None
        return known

    def wanted(self, i: int, q: float) -> float | None:
        return self.rows[i][0]

    def part_of(self, i: int, q: float, turn: float) -> int:
        return self.rows[i][1]


class Throttled(Cylinder):
    """Gas behind valves with losses, whose pressure is a state of the motion."""

    def __init__(self, run: Run) -> None:
        super().__init__(run, "combustion")
        self.dead = self.displacement * run.number("combustion.dead_space")
        c = run.columns
        self.pieces, state = [0], None
        for lifts in zip(c["suction_valve_lift"], c["discharge_valve_lift"]) if "suction_valve_lift" in c else ():
            now = tuple((lift > 0) + (lift >= full) for lift, full in zip(lifts, (max(c["suction_valve_lift"]), max(c["discharge_valve_lift"]))))
            self.pieces.append(self.pieces[-1] + (state is not None and now != state))
            state = now
        # a reed has a speed in the row in which it meets its seat or its stop, and none behind; between rows it may meet them too
        for port in ("suction", "discharge"):
            if f"{port}_valve_speed" not in c:
                continue
            x, v, full, breaks = c[f"{port}_valve_lift"], c[f"{port}_valve_speed"], max(c[f"{port}_valve_lift"]), 0
            for i in range(1, len(x)):
                inside = [0 < x[k] < full for k in (i - 1, i)]
                reach = 2 * max(abs(v[i - 1]), abs(v[i])) * (run.times[i] - run.times[i - 1])
                breaks += ((inside[0] or v[i - 1] != 0) != (inside[1] or v[i] != 0) or (v[i - 1] != 0 and not inside[0])
                           or all(inside) and reach > min(x[i - 1], x[i], full - x[i - 1], full - x[i]))
                self.pieces[i + 1] += breaks

    def wanted(self, i: int, q: float) -> float | None:
        return None

    def part_of(self, i: int, q: float, turn: float) -> int:
        return self.pieces[min(i + 1, len(self.pieces) - 1)]


class Measured(Cylinder):
    """A table of the pressure over a period, interpolated by Steffen's cubic polynomials."""

    UNITS = {"deg": 1.0, "rad": 180 / math.pi, "Pa": 1.0, "hPa": 1e2, "kPa": 1e3, "MPa": 1e6, "mbar": 1e2, "bar": 1e5,
             "psi": 4.4482216152605 / 0.0254**2}

    def __init__(self, run: Run) -> None:
        super().__init__(run, "cylinder_pressure")
        n = run.number
        if n("cylinder_pressure.compression_ratio") > 1:
            self.dead = 2 * self.crank * self.area / (n("cylinder_pressure.compression_ratio") - 1)
        with open(run.text("cylinder_pressure.table"), encoding="utf-8-sig", newline="") as file:
            header, *rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
        angle_unit, pressure_unit = (self.UNITS[name.split("[")[1].split("]")[0].strip()] for name in header)
        self.period = math.radians(n("cylinder_pressure.period_deg"))
        self.x = [math.radians(float(a) * angle_unit + n("cylinder_pressure.offset_deg")) for a, _ in rows]
        self.y = [float(p) * pressure_unit + n("cylinder_pressure.pressure_offset") for _, p in rows]
        if self.x[-1] - self.x[0] > self.period * (1 - 1e-9):
            self.y[0] = (self.y[0] + self.y.pop()) / 2
            self.x.pop()
        self.x.append(self.x[0] + self.period)
        self.y.append(self.y[0])
        widths = [b - a for a, b in zip(self.x, self.x[1:])]
        secants = [(b - a) / w for a, b, w in zip(self.y, self.y[1:], widths)]
        self.slopes = [self.slope(widths[i - 1], widths[i], secants[i - 1], secants[i]) for i in range(len(widths))]
        self.slopes.append(self.slopes[0])

    @staticmethod
    def slope(width: float, next_width: float, secant: float, next_secant: float) -> float:
        if secant * next_secant <= 0:
            return 0.0
        mean = (secant * next_width + next_secant * width) / (width + next_width)
        return math.copysign(2 * min(abs(secant), abs(next_secant), abs(mean) / 2), secant)

    def pressure(self, q: float) -> float:
        q = self.x[0] + (q - self.x[0]) % self.period
        i = min(bisect.bisect_right(self.x, q), len(self.x) - 1) - 1
        width = self.x[i + 1] - self.x[i]
        s = (q - self.x[i]) / width
        return ((1 + 2 * s) * (1 - s)**2 * self.y[i] + s**2 * (3 - 2 * s) * self.y[i + 1]
                + width * s * (1 - s) * ((1 - s) * self.slopes[i] - s * self.slopes[i + 1]))


def gas_of(run: Run) -> Cylinder | None:
    """The gas of a run, if it has any."""
    if "cylinder_pressure.bore" in run.case:
        return Measured(run)
    if "combustion.bore" not in run.case:
        return None
    if run.text("combustion.cycle") != "compressor":
        return Gas(run)
    return Throttled(run) if "valve_1.area" in run.case else Compressor(run)
