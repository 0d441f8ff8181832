"""Gas with a mass and a temperature: its state, its flows and its heat in every row, and mass and pressure against the integrals of
their rates."""
from __future__ import annotations

import math

from .energy import SAFETY, pieces_of
from .gas import Compressor, Cylinder, Gas
from .quadrature import NODES, integral, stencils
from .rows import SUM, RowChecks
from .trace import Run

NARROW = 1e-3     # below this relative difference of the pressures an orifice has the flow of a parabola
FLOW = 1e-6       # allowed error of a flow where the pressures are nearly equal: a difference of rounded numbers
BLURRED = 1e-3    # of a size: if the quadrature error exceeds this, the integral begins anew
NUDGE = 1e-6      # relative change of a pressure by which the slope of the flows is found
KINKED = 10       # the errors of rows inside a step in which a valve opens, shuts or reaches its full lift, over those of other rows
COLUMNS = "wall_heat_flow", "leak_flow"
VALVE_COLUMNS = "suction_flow", "discharge_flow", "suction_valve_lift", "discharge_valve_lift"


def has_charge(run: Run) -> bool:
    return "working_gas.gas_constant" in run.case


def requested_charge(run: Run) -> list[str]:
    """The columns on request that the judge needs."""
    if not has_charge(run):
        return []
    moving = [f"{port}_valve_speed" for port, valve in valves_of(run).items() if valve[-1]]
    return [*COLUMNS, *(VALVE_COLUMNS if "valve_1.area" in run.case else ()), *moving]


def valves_of(run: Run) -> dict[str, list[float]]:
    """The numbers of the valve of each port."""
    keys = "area", "lift", "force_area", "stiffness", "preload", "damping", "mass"
    return {port: [run.number(f"{group}.{key}") for key in keys] for group in ("valve_1", "valve_2") if f"{group}.area" in run.case
            for port in ("suction", "discharge") if run.text(f"{group}.port") in ("both", port)}


class Charge:
    """The laws of the gas of a case in its cylinder."""

    def __init__(self, run: Run, gas: Cylinder) -> None:
        n = self.number = run.number
        self.run, self.gas = run, gas
        self.constant, self.inlet, self.leak = n("working_gas.gas_constant"), n("working_gas.temperature"), n("working_gas.leak_area")
        self.is_engine = isinstance(gas, Gas)
        self.ratio = n("combustion.heat_capacity_ratio") if self.is_engine else n("working_gas.heat_capacity_ratio")
        self.is_state = "valve_1.area" in run.case or "wall_heat.wall_temperature" in run.case or self.leak > 0
        self.fill = n("combustion.intake_pressure") if self.is_engine else n("combustion.suction_pressure")
        self.valves = valves_of(run)
        self.returning = 0.0 if not self.valves else self.inlet * (n("combustion.discharge_pressure") / self.fill)**(1 - 1 / self.ratio)

    def orifice(self, area: float, high: float, low: float, temperature: float) -> float:
        """Flow from a pressure to a lower one."""
        g = self.ratio
        ratio = max(low / high, (2 / (g + 1))**(g / (g - 1)))
        y = max(1 - ratio, 0.0) / NARROW
        at = ratio if y >= 1 else 1 - NARROW
        size = math.sqrt(2 * g / (g - 1) * (at**(2 / g) - at**((g + 1) / g))) * (1.0 if y >= 1 else y * (3 - y) / 2)
        return area * high / math.sqrt(self.constant * temperature) * size

    def wall_heat(self, p: float, temperature: float, volume: float, turn: float) -> float:
        """Heat to the walls [W]."""
        if "wall_heat.wall_temperature" not in self.run.case:
            return 0.0
        n, law, gas = self.number, self.run.text("wall_heat.law"), self.gas
        bore = n("combustion.bore")
        speed = gas.displacement / gas.area * abs(turn) / math.pi
        if law == "constant":
            size = n("wall_heat.heat_transfer_coefficient")
        elif law == "hohenberg":
            size = 130 * volume**-0.06 * (p / 1e5)**0.8 * temperature**-0.4 * (speed + 1.4)**0.8
        elif law == "reynolds":
            k = n("wall_heat.conductivity")
            density = p / (self.constant * temperature)
            size = n("wall_heat.coefficient") * k / bore * (density * speed * bore / n("wall_heat.viscosity"))**n("wall_heat.exponent")
        else:
            closed = gas.volume(gas.sense * gas.closes)
            burnt = max(p - self.fill * (closed / volume)**self.ratio, 0.0)
            gas_speed = 2.28 * speed + 3.24e-3 * gas.displacement * self.inlet / (self.fill * closed) * burnt
            size = 3.26 * bore**-0.2 * (p / 1e3)**0.8 * temperature**-0.53 * gas_speed**0.8
        return n("wall_heat.factor", 1.0) * size * (math.pi * bore**2 / 2 + 4 * volume / bore) * (temperature - n("wall_heat.wall_temperature"))

    def burning(self, q: float, turn: float) -> float:
        """Heat of combustion [W] at an angle from the dead centre."""
        if not self.is_engine or not self.gas.heat:
            return 0.0
        gas = self.gas
        z = (gas.closes + (gas.sense * q - gas.closes) % gas.period - gas.start) / gas.duration
        if not 0 < z < 1:
            return 0.0
        return gas.heat * gas.a * gas.n * z**(gas.n - 1) * math.exp(-gas.a * z**gas.n) / gas.duration * gas.sense * turn

    def is_open(self, q: float) -> bool:
        return self.is_engine and not self.gas.closes + (self.gas.sense * q - self.gas.closes) % self.gas.period < self.gas.opens


class ChargeChecks:
    """The checks of the rows of a run."""

    def __init__(self, checks: RowChecks) -> None:
        self.checks, self.run, self.gas = checks, checks.run, checks.gas
        self.charge = Charge(self.run, self.gas)
        self.columns = self.run.columns
        self.faults: list[str] = []
        self.worst: dict[str, float] = {}

    def take(self, name: str, miss: float, allowed: float, time: float) -> None:
        if not miss <= allowed and not miss / allowed <= self.worst.get(name, 1.0):
            self.worst[name] = miss / allowed
            self.faults = [fault for fault in self.faults if not fault.startswith(name)] + [f"{name}: {miss:.3g} off, {allowed:.3g} allowed, at t = {time:.9g} s"]

    def check_rows(self) -> int:
        """Check the gas in every row; the number of checks."""
        made = set()
        for i, t in enumerate(self.run.times):
            get = {name: column[i] for name, column in self.columns.items()}
            p, m, temperature, volume = (get[name] for name in ("cylinder_pressure", "gas_mass", "gas_temperature", "cylinder_volume"))
            self.take("state of the gas", abs(p * volume - m * self.charge.constant * temperature), SUM * p * volume, t)
            made.add("state of the gas")
            if isinstance(self.gas, Compressor):   # compressed along its polytrope from the suction chamber
                wanted = self.charge.inlet * (p / self.charge.fill)**(1 - 1 / self.gas.exponent)
                self.take("temperature of the gas", abs(temperature - wanted), SUM * wanted, t)
                made.add("temperature of the gas")
            if not self.charge.is_state or self.gas.jumps_near(get["crank_angle"] - self.gas.top, 1e-7):
                continue
            for name, value, wanted, size in self.flows(get):
                made.add(name)
                self.take(name, abs(value - wanted), FLOW * size, t)
        return len(made)

    def flows(self, get: dict[str, float]):
        """Name, value, value by the law and size of each flow in a row."""
        charge, n = self.charge, self.run.number
        p, temperature, volume = (get[name] for name in ("cylinder_pressure", "gas_temperature", "cylinder_volume"))
        closed = not charge.is_open(get["crank_angle"] - self.gas.top)
        heat = charge.wall_heat(p, temperature, volume, get["crank_speed"])
        yield "heat to the walls", get["wall_heat_flow"], heat if closed else 0.0, abs(heat) + 1e-300
        case = n("combustion.crankcase_pressure")
        leak = charge.orifice(charge.leak, p, case, temperature) if p >= case else -charge.orifice(charge.leak, case, p, charge.inlet)
        yield "leak", get["leak_flow"], leak if closed else 0.0, charge.orifice(charge.leak, max(p, case), 0.0, temperature) + 1e-300
        for port, (area, lift, force_area, stiffness, preload, _, mass) in charge.valves.items():
            before, behind, warm = (charge.fill, p, charge.inlet) if port == "suction" else (p, n("combustion.discharge_pressure"), temperature)
            excess, span = before - behind, stiffness * lift
            if mass:   # a state of the motion; gas flows both ways
                opening = get[f"{port}_valve_lift"]
                yield f"lift of the {port} valve", opening, min(max(opening, 0.0), lift), lift
                come, gone = (before, behind) if excess > 0 else (behind, before)
                hot = warm if excess > 0 else charge.returning if port == "discharge" else temperature
                flow = math.copysign(charge.orifice(area * opening / lift, come, gone, hot), excess)
                yield f"{port} flow", get[f"{port}_flow"], flow, charge.orifice(area, come, 0.0, hot) * (1 + 2 * n("integrator.relative_tolerance") / FLOW) + 1e-300   # it meets its seat a tolerance behind it
                continue
            share = min(max((excess * force_area - preload) / span, 0.0), 1.0) if stiffness else float(excess > 0)
            near = FLOW * (1 + max(before, behind) * force_area / span) if stiffness else 1.0   # the difference is one of rounded pressures
            yield f"lift of the {port} valve", get[f"{port}_valve_lift"], lift * share, lift * near / FLOW if abs(excess) < 1e-9 * before else lift * near
            full = charge.orifice(area, max(before, behind), 0.0, warm)
            yield f"{port} flow", get[f"{port}_flow"], charge.orifice(area * share, before, behind, warm) if excess > 0 else 0.0, full * max(1.0, near / FLOW * 1e-3) + 1e-300

    def excess(self, port: str, pressure: float) -> float:
        """Difference of the pressures that opens a valve."""
        return self.charge.fill - pressure if port == "suction" else pressure - self.run.number("combustion.discharge_pressure")

    def rates(self) -> dict[str, list[float]]:
        """Rates of the mass, of the pressure, and of lift and speed of valves with a mass in every row."""
        charge, g = self.charge, self.charge.ratio
        heat_capacity = g * charge.constant / (g - 1)
        masses, pressures = [], []
        for i in range(len(self.run.times)):
            get = {name: column[i] for name, column in self.columns.items()}
            q, turn = get["crank_angle"] - self.gas.top, get["crank_speed"]
            if charge.is_open(q):
                masses.append(0.0)
                pressures.append(0.0)
                continue
            come, gone, leak = get.get("suction_flow", 0.0), get.get("discharge_flow", 0.0), get["leak_flow"]
            warm = get["gas_temperature"]
            enthalpy = heat_capacity * (come * (charge.inlet if come > 0 else warm) - gone * (warm if gone > 0 else charge.returning) - leak * (warm if leak > 0 else charge.inlet))
            across = self.gas.crank * math.sin(q + self.gas.top) - self.gas.axis
            swept = self.gas.area * self.gas.crank * (math.sin(q + self.gas.top) + across * math.cos(q + self.gas.top) / math.sqrt((self.gas.rod - across) * (self.gas.rod + across)))
            masses.append(come - gone - leak)
            pressures.append(((g - 1) * (charge.burning(q, turn) - get["wall_heat_flow"] + enthalpy) - g * get["cylinder_pressure"] * swept * turn) / get["cylinder_volume"])
        found = {"gas_mass": masses, "cylinder_pressure": pressures}
        for port, (_, full, force_area, stiffness, preload, damping, mass) in charge.valves.items():
            if not mass:
                continue
            pressure, lifts, speeds = (self.columns[name] for name in ("cylinder_pressure", f"{port}_valve_lift", f"{port}_valve_speed"))
            found[f"{port}_valve_lift"] = list(speeds)
            found[f"{port}_valve_speed"] = [(self.excess(port, p) * force_area - preload - stiffness * x - damping * v) / mass if 0 < x < full or v else 0.0
                                            for p, x, v in zip(pressure, lifts, speeds)]
        return found

    def natural_sizes(self) -> dict[str, float]:
        """Lift and speed of each valve with a mass to which the tolerance is relative."""
        found = {}
        for port, (_, full, _, stiffness, preload, _, mass) in self.charge.valves.items():
            if mass:
                found[f"{port}_valve_lift"] = full
                found[f"{port}_valve_speed"] = math.sqrt((preload + stiffness * full) * full / mass)
        return found

    def returns_at(self, i: int) -> float:
        """Rate at which the flows bring the pressure of a row back [1/s]."""
        charge = self.charge
        get = {name: column[i] for name, column in self.columns.items()}
        nudged = {name: value * (1 + NUDGE) if name in ("cylinder_pressure", "gas_temperature") else value for name, value in get.items()}
        change = sum(abs(b[2] - a[2]) for a, b in zip(self.flows(get), self.flows(nudged)) if a[0] == "leak" or a[0].endswith("flow"))
        hottest = max(get["gas_temperature"], charge.inlet, charge.returning)
        return charge.ratio * charge.constant * hottest * change / (NUDGE * get["cylinder_pressure"] * get["cylinder_volume"])

    def unsure(self, size: float) -> list[float]:
        """What errors of one tolerance in the pressure of every row add up to in the integral of its rate, up to each row: where wide ports
        hold the pressure of little gas, its rate is what is left of flows that nearly balance."""
        error, total = self.run.number("integrator.relative_tolerance") * size, [0.0]
        rates = [self.returns_at(i) for i in range(len(self.run.times))]
        for i in range(1, len(rates)):
            total.append(total[-1] + error * max(rates[i - 1:i + 1]) * (self.run.times[i] - self.run.times[i - 1]))
        return total

    def check_integrals(self, allowed: float) -> int:
        """Check mass and pressure against the integrals of their rates, from the first row of each part of the cycle; the number of checks."""
        pieces = pieces_of(self.checks, self.run)
        stencil = stencils(self.run.times, pieces, joined=False)
        rates, sizes = self.rates(), self.natural_sizes()
        for name, rate in rates.items():
            values, found = self.columns[name], integral(rate, stencil)
            size = sizes.get(name) or max(values)
            unsure = self.unsure(size) if name == "cylinder_pressure" else [0.0] * len(values)
            for rows in pieces:
                rows = [i for i in rows if not (self.charge.is_open(q := self.columns["crank_angle"][i] - self.gas.top) or self.gas.jumps_near(q, 1e-7))]
                if len(rows) <= 2 * NODES:   # of a sudden combustion: too few for a bound of the quadrature's error
                    continue
                first = rows[0]
                for i in rows:
                    bound = SAFETY * (found.bound[i] - found.bound[first]) + unsure[i] - unsure[first]
                    if bound > BLURRED * size:
                        first = i
                        continue
                    off = abs(values[i] - values[first] - found.value[i] + found.value[first]) - bound
                    self.take(f"{name} is not the integral of its rate", off / size, allowed, self.run.times[i])
        return len(rates)


def judge_charge(checks: RowChecks, allowed: float, resolved: bool) -> tuple[int, list[str], list[str]]:
    """Number of checks, faults and notes on the gas of the mechanism's cylinder. `resolved`: the rows are close enough for integrals."""
    if not has_charge(checks.run) or checks.gas is None or "gas_mass" not in checks.run.columns:
        return 0, [], []
    found = ChargeChecks(checks)
    made = found.check_rows()
    if resolved and found.charge.is_state:
        made += found.check_integrals(allowed * (KINKED if found.charge.valves else 1))
    return made, found.faults, []
