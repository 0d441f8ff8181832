"""The energy balance of a run, and whether its speeds and positions are the integrals of its accelerations and speeds."""
from __future__ import annotations

import bisect
import dataclasses
import math

from .mechanics import Bodies, Row
from .quadrature import Stencil, integral, stencils
from .rows import CONTACT, LEAST_BEND, RowChecks
from .trace import Run

BLURRED = 1e-2   # of a size: if the quadrature error exceeds this, the rows are too far apart to judge integrals
RESOLVED = 0.25   # largest angle [rad] by which the oscillation of a shape may proceed between two rows
SAFETY = 4.0   # the difference of two quadratures bounds the error of the better one if the rows resolve the motion; if
#                they hardly do, four times the difference
DEFLECTED = 0.2   # smallest size of a rod's shape, in static deflections under the forces of inertia and gravity


@dataclasses.dataclass
class Balances:
    """Largest residuals relative to the sizes of the balanced quantities: as found, and beyond the error bound of the
    quadrature."""

    plain: float         # energy - its first value - work, over the energy scale
    residual: float      # the same, minus the bound
    bound: float         # error bound of the quadrature, in the same scale
    differs: float       # largest difference from the column energy_residual, over the energy scale
    claimed: float       # largest value of that column, over the energy scale
    drift: float         # largest error of a speed or position against the integral of its rate
    drift_bound: float
    time: float          # time of the largest residual [s]
    worst: str = ""      # name of that speed or position
    scale: float = 0.0   # [J]


def phase_key(checks: RowChecks, i: int) -> tuple[float, int, tuple[int, bool], tuple[bool, bool]]:
    """Phase of a joint in a row, number of its contact, side of its friction, and sides of the kinks of a film in transition to
    contact."""
    columns = checks.run.columns
    phase = columns["phase"][i] if "phase" in columns else 0
    if phase != CONTACT:
        return phase, -1, (0, False), checks.zone(i)
    side = 0, False
    if checks.friction:
        side = checks.friction.side(columns["sliding_speed"][i], columns["bristle"][i] if "bristle" in columns else 0.0)
    return phase, bisect.bisect_left(checks.begins, checks.run.times[i]), side, checks.zone(i)


def gas_part(checks: RowChecks, i: int) -> int:
    """Part of the gas cycle."""
    columns = checks.run.columns
    return checks.gas.part_of(i, columns["crank_angle"][i], columns["crank_speed"][i]) if checks.gas else 0


def pieces_of(checks: RowChecks, run: Run) -> list[list[int]]:
    """Pieces of rows within which nothing jumps: same phase, same contact, same part of the gas cycle, same side of the
    friction."""
    begins = checks.guide.begins if checks.guide else []
    keys = [(phase_key(checks, i), phase_key(checks.crank_pin, i) if checks.crank_pin else None, gas_part(checks, i),
             checks.guide.side(checks.row(i), i, begins, run.times[i]) if checks.guide else None) for i in range(len(run.times))]
    pieces: list[list[int]] = []
    for i, key in enumerate(keys):
        if i and key == keys[i - 1]:
            pieces[-1].append(i)
        else:
            pieces.append([i])
    return pieces


def sizes(run: Run) -> dict[str, float]:
    """Sizes that errors of speeds and positions are divided by when the values are nearly zero: for the pin one clearance, for the
    crank one radian, in the time of one radian; if the crank is at rest, in the simulated time. A film that carries a piston's weight
    has in rows between two steps an error of this force that is much larger than the integral of it, the error of the speed; so the
    speed that gravity gives in the simulated time is another least size."""
    span = max(run.times[-1] - run.times[0], 1e-300)
    speed = max(max(map(abs, run.columns["crank_speed"])), 1 / span)
    way = run.number("joint.clearance") or run.number("mechanism.crank_length")
    own = run.number("crank_pin.joint.clearance")
    carried = abs(Bodies.of(run).gravity) * span if run.text("lubrication.law") not in ("", "none") else 0.0
    return {"rod_velocity_x": speed * max(way, own), "rod_velocity_y": speed * max(way, own), "crank_pin_eccentricity_x": own,
            "crank_pin_eccentricity_y": own, "crank_speed": speed, "rod_speed": speed * way / run.number("mechanism.rod_length"),
            "piston_velocity": max(speed * way, carried), "crank_angle": 1.0, "piston_position": way,
            **bore_sizes(run, speed), **elastic_sizes(run, speed)}


def drive_speed(run: Run) -> float:
    """Speed of the crank by which the program's absolute tolerances are chosen [rad/s]: that of the case or the speed reached; for
    a crank at rest one radian in the time simulated."""
    reached = max(map(abs, run.columns["crank_speed"]))
    ramp = run.number("drive.ramp_time")
    speed = reached if ramp > run.times[-1] else max(abs(run.number("initial.crank_speed")), reached)
    return speed or 1 / max(run.times[-1] - run.times[0], 1e-300)


def bore_sizes(run: Run, speed: float) -> dict[str, float]:
    """The same sizes for a piston with clearance in its bore."""
    if not run.has_loose_guide:
        return {}
    way = run.number("guide.bore_clearance")
    turn = 2 * way / (run.number("guide.skirt_top") + run.number("guide.skirt_bottom"))
    return {"piston_offset": way, "piston_tilt": turn, "piston_offset_rate": way * speed, "piston_tilt_rate": turn * speed}


def elastic_sizes(run: Run, speed: float) -> dict[str, float]:
    """The same sizes for elastic members: for each shape the largest value of all shapes of its kind, at least a part of its static
    deflection under the forces of inertia and gravity, or of the one by a pin that crosses its clearance in the time simulated,
    because the error of a shape is a small part of these, even if the shape itself is not excited."""
    found = {"crankshaft_twist": 1.0, "flywheel_speed": speed}
    bodies = Bodies.of(run)
    if not bodies.elastic:
        return found
    load = sum(bodies.mass[1:]) * (bodies.crank_length * drive_speed(run)**2 + abs(bodies.gravity))
    crossing = 0.01 * run.number("joint.clearance") / max(run.times[-1] - run.times[0], 1e-300)   # slow for a pin in its bearing
    for name, stiffness in zip(bodies.elastic.names, bodies.elastic.stiffness):
        kind = ("rod_mode",) if name.startswith("rod_mode") else ("rod_stretch", "rod_axial")
        least = DEFLECTED * max(load / stiffness, crossing / bodies.elastic.frequencies[name])
        for what, floor in (("", least), ("_rate", least * bodies.elastic.frequencies[name])):
            names = [one + what for one in bodies.elastic.names if one.startswith(kind)]
            found[name + what] = max(1e-300, floor, *(abs(value) for one in names for value in run.columns[one]))
    return found


def worst_drift(run: Run, rates: dict[str, str], stencil: list[list[Stencil]], frequencies: dict[str, float]) -> tuple[float, float, str]:
    """The largest of |value - first - integral of its rate| minus its bound, divided by the value's size; that bound, and the name.
    Values whose integral is not known to a hundredth of their size are left out. The acceleration of a stiff shape of a rod is the
    small difference of its elastic force and the load, so an error of the state returns in it multiplied by the frequency squared;
    between rows that do not resolve this frequency, the rate of the shape is not judged."""
    worst = (0.0, 0.0, "")
    least = sizes(run)
    for name, rate in rates.items():
        values, found = run.columns[name], integral(run.columns[rate], stencil)
        size = max(least[name], *map(abs, values), abs(found.value[-1]))
        frequency = frequencies.get(name, 0.0)
        if SAFETY * max(found.bound) > BLURRED * size:   # contacts shorter than the distance of the rows
            continue
        first = 0
        for i, (value, by_rate, bound) in enumerate(zip(values, found.value, found.bound)):
            if i and frequency * (run.times[i] - run.times[i - 1]) > RESOLVED:
                first = i
            beyond = (abs(value - values[first] - by_rate + found.value[first]) - SAFETY * bound) / size
            if not beyond <= worst[0]:
                worst = (beyond, SAFETY * bound / size, name)
    return worst


def bristle_drift(checks: RowChecks, pieces: list[list[int]]) -> tuple[float, float, str]:
    """The same for the deflection of bristles, integrated from the first row of each piece, divided by ten times the break-away
    deflection. Where sliding reverses, the rate has a kink, and rows within such a step have errors of about 5e-4 at a tolerance of
    1e-6. Rows so far apart that the deflection relaxes by more than a quarter from one to the next are not judged, nor those between
    which the bodies, of half the mass of the lightest one that has mass or more, may vibrate on the bristles by more than a quarter of a radian."""
    columns, friction = checks.run.columns, checks.friction
    springs = friction.stiffness / (0.5 * min(mass for mass in checks.bodies.mass[1:] if mass > 0))   # per normal force
    z = columns["bristle"]
    touching = [phase == CONTACT for phase in columns["phase"]]
    rate = [friction.bristle_rate(v, bent) if on else 0.0 for v, bent, on in zip(columns["sliding_speed"], z, touching)]
    found, size = integral(rate, stencils(checks.run.times, pieces, joined=False)), 10 * friction.static / friction.stiffness
    worst = (0.0, 0.0, "")
    for rows in pieces:
        first = rows[0]
        for before, i in zip(rows, rows[1:]) if touching[first] else ():
            v, load = (max(map(abs, columns[name][before:i + 1])) for name in ("sliding_speed", "normal_force"))
            apart = checks.run.times[i] - checks.run.times[before]
            if friction.stiffness * v / friction.steady(v) * apart > 0.25 or math.sqrt(springs * load) * apart > RESOLVED:
                first = i
            bound = SAFETY * (found.bound[i] - found.bound[first])
            beyond = (abs(z[i] - z[first] - found.value[i] + found.value[first]) - bound) / size
            if not beyond <= worst[0]:
                worst = (beyond, bound / size, "bristle")
    return worst


def balances(checks: RowChecks) -> Balances:
    """Kinetic and potential energy against the work of gas, joints, damping and drive, by quadrature over the rows."""
    run = checks.run
    film = checks.film or checks.crank_pin and checks.crank_pin.film
    pieces = pieces_of(checks, run)
    stencil = stencils(run.times, pieces, joined=not (film or checks.gas))
    kinetic, potential, power = [], [], []
    rod: list[list[float]] = [[], [], [], []]   # speeds and accelerations of the rod's centre of mass
    for i in range(len(run.times)):
        row = checks.row(i)
        one, two = row.energy_terms()
        kinetic.append(sum(one))
        potential.append(sum(two))
        power.append(power_of(checks, row, i))
        if checks.crank_pin:
            for values, value in zip(rod, (*row.rod_velocity, *row.rod_acceleration())):
                values.append(value)
    work = integral(power, stencil)
    spread = max(potential) - min(potential)
    bodies = checks.bodies
    scale = max(max(kinetic) + spread, max(map(abs, work.value)), sum(bodies.mass) * abs(bodies.gravity) * bodies.crank_length, 1e-300)
    first = kinetic[0] + potential[0]
    column = run.columns["energy_residual"]
    found = Balances(0.0, 0.0, SAFETY * max(work.bound) / scale, 0.0, max(map(abs, column)) / scale, 0.0, 0.0, 0.0, scale=scale)
    for i, t in enumerate(run.times):
        residual = kinetic[i] + potential[i] - first - work.value[i]
        found.plain = max(found.plain, abs(residual) / scale)
        beyond = (abs(residual) - SAFETY * work.bound[i]) / scale
        if not beyond <= found.residual:
            found.residual, found.time = beyond, t
        found.differs = max(found.differs, (abs(residual - column[i]) - SAFETY * work.bound[i]) / scale)
    rates = {"crank_speed": "crank_acceleration", "rod_speed": "rod_acceleration", "piston_velocity": "piston_acceleration",
             "crank_angle": "crank_speed", "piston_position": "piston_velocity"}
    if checks.crank_pin:   # Newton's law of the rod, and its position
        names = "rod_velocity_x", "rod_velocity_y", "rod_acceleration_x", "rod_acceleration_y"
        run = dataclasses.replace(run, columns=run.columns | dict(zip(names, rod)))
        rates |= {f"rod_velocity_{axis}": f"rod_acceleration_{axis}" for axis in "xy"}
        rates |= {f"crank_pin_eccentricity_{axis}": f"crank_pin_eccentricity_rate_{axis}" for axis in "xy"}
    if checks.guide and checks.guide.is_loose:
        rates |= {f"piston_{one}": f"piston_{one}_rate" for one in ("offset", "tilt")}
        rates |= {f"piston_{one}_rate": f"piston_{one}_acceleration" for one in ("offset", "tilt")}
    run, more = elastic_rates(run, bodies)
    rates |= more
    frequencies = {f"{name}_rate": value for name, value in bodies.elastic.frequencies.items()} if bodies.elastic else {}
    found.drift, found.drift_bound, found.worst = worst_drift(run, rates, stencil, frequencies)
    for joint in (checks, checks.crank_pin):
        if joint and joint.friction and joint.friction.has_bristles and joint.friction.gives_way >= LEAST_BEND:
            drift = bristle_drift(joint, pieces)
            if not drift[0] <= found.drift:
                found.drift, found.drift_bound, found.worst = drift
    return found


def elastic_rates(run: Run, bodies: Bodies) -> tuple[Run, dict[str, str]]:
    """Pairs of columns of elastic members of which one is the integral of the other; and the run with a column of the twist's
    rate."""
    rates: dict[str, str] = {}
    if bodies.elastic:
        for name in bodies.elastic.names:
            rates |= {name: f"{name}_rate", f"{name}_rate": f"{name}_acceleration"}
    if bodies.shaft:
        twist = [a - b for a, b in zip(run.columns["flywheel_speed"], run.columns["crank_speed"])]
        run = dataclasses.replace(run, columns=run.columns | {"crankshaft_twist_rate": twist})
        rates |= {"crankshaft_twist": "crankshaft_twist_rate", "flywheel_speed": "flywheel_acceleration"}
    return run, rates


def power_of(checks: RowChecks, row: Row, i: int) -> float:
    """Power of the gas on the piston, of the joints on their bodies, of damping and drive on the crank [W]."""
    turn = row.driven_turn()
    power = row.get["crank_moment"] * turn - row.bodies.damping * turn**2 - row.gas * row.com_velocity[0] + row.elastic_power()
    if checks.guide:
        power += checks.guide.power(row)
    if checks.has_joint:
        moment = checks.joint_moment(row)
        power += row.force[0] * row.slip[0] + row.force[1] * row.slip[1]
        moment = row.joint_moment() if moment is None else moment
        power += moment * row.end_turn(1)
        if row.is_loose:
            power -= (moment + row.get["eccentricity_x"] * row.force[1] - row.get["eccentricity_y"] * row.force[0]) * row.tilt_rate
    if checks.crank_pin:
        own = row.crank_pin(checks.crank_pin.run.columns, i)
        moment = checks.crank_pin.joint_moment(own)
        if moment is None:
            moment = row.crank_pin_moment()
        power += own.force[0] * own.slip[0] + own.force[1] * own.slip[1] + moment * row.turn + row.bearing_moment(moment) * row.end_turn(0)
    return power
