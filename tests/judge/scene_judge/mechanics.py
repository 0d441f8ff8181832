"""Kinematics, energy, and balances of force and moment of crank, rod and piston, written from the motion of each body.

x points up along the cylinder, y sideways, and the crank turns from x to y. The column of the rod counts its angle in the opposite
sense, so its angular velocity in the plane is minus the column. A body is a frame with an origin, an angle, and its centre of mass
(u, v).
"""
from __future__ import annotations

import copy
import dataclasses
import math

from .elastic import ElasticRod
from .engine import Engine
from .trace import Run

Vector = tuple[float, float]
LAST_DIGITS = 1e-13   # rounding, relative to the forces whose difference a force is


def cross(a: Vector, b: Vector) -> float:
    return a[0] * b[1] - a[1] * b[0]


def rotated(u: float, v: float, angle: float) -> Vector:
    c, s = math.cos(angle), math.sin(angle)
    return u * c - v * s, u * s + v * c


def velocity(origin: Vector, arm: Vector, turn: float) -> Vector:
    """Velocity of a point at `arm` from the body's origin, which has the given velocity; the angular velocity is `turn`."""
    return origin[0] - turn * arm[1], origin[1] + turn * arm[0]


def acceleration(origin: Vector, arm: Vector, turn: float, turn_rate: float) -> Vector:
    return (origin[0] - turn_rate * arm[1] - turn * turn * arm[0], origin[1] + turn_rate * arm[0] - turn * turn * arm[1])


@dataclasses.dataclass
class Balance:
    """A sum that must vanish, and the sum of the magnitudes of its terms, to which rounding is proportional; `noise` is rounding
    that the terms already contain."""

    miss: float
    size: float
    noise: float = 0.0


def balance(*terms: float) -> Balance:
    return Balance(abs(math.fsum(terms)), sum(map(abs, terms)))


def scaled(factor: float, vector: Vector) -> Vector:
    return factor * vector[0], factor * vector[1]


def vector_balance(name: str, *terms: Vector) -> dict[str, Balance]:
    """Balances of both components, each relative to the magnitudes of the vectors, because one component may be rounding only."""
    size = sum(math.hypot(*term) for term in terms)
    return {f"{name} along {axis}": Balance(abs(math.fsum(term[k] for term in terms)), size) for k, axis in enumerate("xy")}


@dataclasses.dataclass
class Bodies:
    """The constants of a case that the mechanics needs."""

    crank_length: float
    rod_length: float
    mass: tuple[float, float, float]      # crank, rod, piston
    inertia: tuple[float, float]          # crank, rod, about their centres of mass
    crank_com: Vector
    rod_com: Vector
    gravity: float
    downwards: Vector                     # unit vector
    damping: float
    pin_radius: float
    piston_inertia: float = 0.0           # about its centre of mass; for a piston with clearance in its bore
    piston_com: Vector = (0.0, 0.0)
    elastic: ElasticRod | None = None
    shaft: tuple[float, float, float] | None = None   # elastic crankshaft: flywheel's inertia, stiffness, damping
    engine: Engine | None = None          # other cylinders, or stations of the crankshaft
    axis_offset: float = 0.0              # y of the cylinder axis
    skirt_spring: float = 0.0             # stiffness of the ends of the faces of a lubricated skirt

    @classmethod
    def of(cls, run: Run) -> Bodies:
        n = run.number
        found = cls(n("mechanism.crank_length"), n("mechanism.rod_length"),
                   (n("mechanism.crank_mass"), n("mechanism.rod_mass"), n("mechanism.piston_mass")),
                   (n("mechanism.crank_inertia") + n("drive.flywheel_inertia"), n("mechanism.rod_inertia")),
                   run.pair("mechanism.crank_com"), run.pair("mechanism.rod_com"), n("mechanism.gravity"),
                   rotated(-1.0, 0.0, math.radians(n("mechanism.gravity_angle_deg"))), n("drive.damping"),
                   n("joint.bearing_radius") - n("joint.clearance"),
                   *((n("guide.piston_inertia"), run.pair("guide.piston_com")) if run.has_loose_guide else ()))
        found.axis_offset = n("mechanism.axis_offset")
        if run.text("guide.kind") == "lubricated":
            found.skirt_spring = n("guide.stiffness")
        if "elastic_rod.section_area" in run.case:
            found.elastic = ElasticRod(run)
        if Engine.is_in(run):
            found.engine = Engine(run)
        elif "crankshaft.flywheel_inertia" in run.case:
            found.shaft = n("crankshaft.flywheel_inertia"), n("crankshaft.torsional_stiffness"), n("crankshaft.torsional_damping")
        return found


class Row:
    """One row of a trace: the motion of every body, and the forces in its columns."""

    def __init__(self, bodies: Bodies, columns: dict[str, list[float]], i: int) -> None:
        self.bodies = bodies
        get = {name: column[i] for name, column in columns.items()}
        self.get = get
        self.q, self.turn, self.turn_rate = get["crank_angle"], get["crank_speed"], get["crank_acceleration"]
        self.rod_turn, self.rod_turn_rate = -get["rod_speed"], -get["rod_acceleration"]
        self.x, self.vx, self.ax = get["piston_position"], get["piston_velocity"], get["piston_acceleration"]
        rod_angle = -get["rod_angle"]
        self.crank_arm = rotated(*bodies.crank_com, self.q)
        self.crankpin = rotated(bodies.crank_length, 0.0, self.q)
        self.rod_arm = rotated(*bodies.rod_com, rod_angle)
        self.chord, self.chord_rate = bodies.rod_length, 0.0
        self.shape_state, self.shape_rates, self.shape_second = [], [], []   # elastic rod: angle of the chord from y to x, and shapes
        if bodies.elastic:
            names = bodies.elastic.names
            self.shape_state = [get["rod_angle"], *(get[name] for name in names)]
            self.shape_rates = [get["rod_speed"], *(get[f"{name}_rate"] for name in names)]
            self.shape_second = [get["rod_acceleration"], *(get[f"{name}_acceleration"] for name in names)]
            self.chord, self.chord_rate = bodies.elastic.chord(self.shape_state[1:], self.shape_rates[1:])
        self.is_detailed = True   # the equations of an elastic rod are checked in this row
        self.rod = rotated(self.chord, 0.0, rod_angle)
        self.crankpin_velocity = velocity((0.0, 0.0), self.crankpin, self.turn)
        # crank pin in the rod's big end: eccentricity, and the centre of the big end
        self.has_loose_crank_pin = "crank_pin_phase" in get
        self.offset = get.get("crank_pin_eccentricity_x", 0.0), get.get("crank_pin_eccentricity_y", 0.0)
        self.offset_rate = get.get("crank_pin_eccentricity_rate_x", 0.0), get.get("crank_pin_eccentricity_rate_y", 0.0)
        self.big_end = self.crankpin[0] - self.offset[0], self.crankpin[1] - self.offset[1]
        self.big_end_velocity = self.crankpin_velocity[0] - self.offset_rate[0], self.crankpin_velocity[1] - self.offset_rate[1]
        self.pin_velocity = velocity(self.big_end_velocity, self.rod, self.rod_turn)
        self.pin_velocity = tuple(v + self.chord_rate * one / self.chord for v, one in zip(self.pin_velocity, self.rod))
        # piston with clearance in its bore: lateral position of its centre of mass, tilt, and the centre relative to the pin's
        # bearing
        self.is_loose = "piston_tilt" in get
        self.offset_y, self.offset_rate_y = get.get("piston_offset", 0.0), get.get("piston_offset_rate", 0.0)
        self.tilt, self.tilt_rate, self.tilt_acceleration = (get.get(f"piston_tilt{one}", 0.0) for one in ("", "_rate", "_acceleration"))
        self.com = rotated(*bodies.piston_com, self.tilt)
        self.com_velocity = self.vx - self.tilt_rate * self.com[1], self.offset_rate_y
        self.bearing = self.x, bodies.axis_offset + self.offset_y - self.com[1]
        self.bearing_velocity = self.vx, self.offset_rate_y - self.tilt_rate * self.com[0]
        self.bore_friction = get.get("guide_friction_force", 0.0)
        self.journal_turn, self.bearing_turn = self.end_turn(1), self.tilt_rate
        self.law_noise = 0.0   # rounding of the column of the joint's force: none, because the law computes it
        self.force = get["pin_force_x"], get["pin_force_y"]
        self.gas = get.get("gas_force", 0.0)
        # eccentricity of the pin in its bearing
        self.slip = self.pin_velocity[0] - self.vx, self.pin_velocity[1] - self.bearing_velocity[1]
        self.speed_size = abs(bodies.crank_length * self.turn) + abs(bodies.rod_length * self.rod_turn) + abs(self.vx)

    def energy_terms(self) -> tuple[list[float], list[float]]:
        """Kinetic and potential energies of the bodies [J]."""
        b = self.bodies
        crank = velocity((0.0, 0.0), self.crank_arm, self.turn)
        rod = self.rod_velocity
        moving = b.elastic.energies(self.shape_state, self.shape_rates, self.big_end_velocity) if b.elastic else (0.0, 0.0)
        rigid = [0.5 * b.mass[1] * (rod[0]**2 + rod[1]**2), 0.5 * b.inertia[1] * self.rod_turn**2] if not b.elastic else [moving[0]]
        kinetic = [0.5 * b.mass[0] * (crank[0]**2 + crank[1]**2), 0.5 * b.inertia[0] * self.turn**2,
                   *rigid, 0.5 * b.mass[2] * self.com_velocity[0]**2,
                   0.5 * b.mass[2] * self.com_velocity[1]**2, 0.5 * b.piston_inertia * self.tilt_rate**2]
        arm = b.elastic.from_big_end(self.shape_state, self.shape_rates)[0] if b.elastic else self.rod_arm
        places = self.crank_arm, (self.big_end[0] + arm[0], self.big_end[1] + arm[1]), (self.x + self.com[0], self.offset_y)
        strain = [moving[1]]
        if b.skirt_spring:
            strain += [0.5 * b.skirt_spring * self.get[f"guide_{k}_deflection"]**2 for k in range(1, 5)]
        if b.shaft:
            kinetic.append(0.5 * b.shaft[0] * self.get["flywheel_speed"]**2)
            strain.append(0.5 * b.shaft[1] * self.get["crankshaft_twist"]**2)
        if b.engine:
            more = b.engine.energy_terms(self.get)
            kinetic += more[0]
            strain += more[1]
        return kinetic, strain + [-m * b.gravity * (b.downwards[0] * x + b.downwards[1] * y) for m, (x, y) in zip(b.mass, places)]

    @property
    def com_acceleration(self) -> Vector:
        """Acceleration of the piston's centre of mass."""
        return math.fsum(self.com_acceleration_terms), self.get.get("piston_offset_acceleration", 0.0)

    @property
    def com_acceleration_terms(self) -> tuple[float, ...]:
        """The acceleration of the piston's centre of mass along the cylinder: that of its pin, and by the tilt."""
        return self.ax, -self.tilt_acceleration * self.com[1], -self.tilt_rate**2 * self.com[0]

    @property
    def bearing_acceleration(self) -> float:
        """Lateral acceleration of the pin's bearing in the piston."""
        return self.com_acceleration[1] - self.tilt_acceleration * self.com[0] + self.tilt_rate**2 * self.com[1]

    def piston_moment_terms(self, joint_moment: float) -> list[float]:
        """Terms of Euler's law of the piston about its centre of mass without the bore, from the joint's moment on the rod [N
        m]."""
        e = self.get.get("eccentricity_x", 0.0), self.get.get("eccentricity_y", 0.0)
        return [-self.bodies.piston_inertia * self.tilt_acceleration, -joint_moment, -e[0] * self.force[1], e[1] * self.force[0],
                self.com[0] * self.force[1], -self.com[1] * self.force[0]]

    @property
    def rod_velocity(self) -> Vector:
        """Velocity of the rod's centre of mass."""
        if self.bodies.elastic:
            own = self.bodies.elastic.from_big_end(self.shape_state, self.shape_rates)[1]
            return self.big_end_velocity[0] + own[0], self.big_end_velocity[1] + own[1]
        return velocity(self.big_end_velocity, self.rod_arm, self.rod_turn)

    def crank_pin(self, columns: dict[str, list[float]], i: int) -> Row:
        """The row seen from the joint of crank and rod, from its columns; the journal of this joint belongs to the crank."""
        row = copy.copy(self)
        row.get = {name: column[i] for name, column in columns.items()}
        row.force = -self.get["crankpin_force_x"], -self.get["crankpin_force_y"]
        row.slip = self.offset_rate
        row.journal_turn, row.bearing_turn = self.turn, self.end_turn(0)
        row.law_noise = self.noise() + 1e-10 * math.hypot(*row.force)   # the column's force is found from the bodies' motion
        return row

    def end_turn(self, end: int) -> float:
        """Angular velocity of the rod's big end (0) and of its pin (1), from x to y."""
        return self.bodies.elastic.end_turn(end, -self.rod_turn, self.shape_rates[1:]) if self.bodies.elastic else self.rod_turn

    def crank_drive(self) -> float:
        """Moment that drives the crank: that of the drive and its damping, or that of an elastic shaft or of an engine's shaft [N m]."""
        if self.bodies.engine:
            return math.fsum(self.bodies.engine.on_crank(self.get, self.bodies.damping))
        return self.get["crankshaft_moment"] if self.bodies.shaft else self.get["crank_moment"] - self.bodies.damping * self.turn

    def elastic_power(self) -> float:
        """Power of the damping of the shapes and of the shaft [W]."""
        power = 0.0
        if self.bodies.elastic:
            power -= sum(c * v * v for c, v in zip(self.bodies.elastic.damping, self.shape_rates[1:]))
        if self.bodies.shaft:
            power -= self.bodies.shaft[2] * (self.get["flywheel_speed"] - self.turn)**2
        return power

    def driven_turn(self) -> float:
        """Angular velocity of the part that the drive turns [rad/s]."""
        return self.get["flywheel_speed"] if self.bodies.shaft else self.turn

    def elastic_rod_sums(self, joint_moment: float, at_big_end: float) -> tuple[list[float], list[float]]:
        """Residuals of Lagrange's equations of the rod, and the magnitudes of their terms: x and y of the big end, chord's angle,
        shapes."""
        b, elastic = self.bodies, self.bodies.elastic
        on_rod = self.get["crankpin_force_x"], self.get["crankpin_force_y"]
        weight = scaled(b.gravity, b.downwards)
        forces = elastic.applied(self.shape_state, self.shape_rates, weight, (on_rod, at_big_end), (self.force, joint_moment))
        second = acceleration((0.0, 0.0), self.crankpin, self.turn, self.turn_rate)
        if self.has_loose_crank_pin:   # no column has the big end's acceleration; it follows from Newton's law
            free = elastic.inertial_forces(self.shape_state, self.shape_rates, self.shape_second, self.big_end_velocity, (0.0, 0.0))
            second = tuple((math.fsum(forces[k]) - free[k][0]) / b.mass[1] for k in (0, 1))
        inertial = elastic.inertial_forces(self.shape_state, self.shape_rates, self.shape_second, self.big_end_velocity, second)
        size = sum(math.hypot(forces[0][k], forces[1][k]) for k in range(3)) + b.mass[1] * math.hypot(*second)
        extra = [size, size, b.rod_length * (math.hypot(*on_rod) + math.hypot(*self.force))] + [0.0] * len(elastic.names)
        return ([rate - math.fsum(terms) for (rate, _), terms in zip(inertial, forces)],
                [size + sum(map(abs, terms)) + more for (_, size), terms, more in zip(inertial, forces, extra)])

    def bearing_moment(self, moment: float) -> float:
        """Moment on the rod at the crank pin about the centre of its big end, from the moment on the crank: together with the
        forces they balance about any point [N m]."""
        return -(moment - cross(self.offset, (self.get["crankpin_force_x"], self.get["crankpin_force_y"])))

    def rod_moment_terms(self) -> list[float]:
        """Terms of Euler's law of the rod about its centre of mass, without the joint's moment; their sum gives that moment [N
        m]."""
        at_crank = self.get["crankpin_force_x"], self.get["crankpin_force_y"]
        to_crank = -self.rod_arm[0], -self.rod_arm[1]
        to_pin = self.rod[0] - self.rod_arm[0], self.rod[1] - self.rod_arm[1]
        return [self.bodies.inertia[1] * self.rod_turn_rate, -to_crank[0] * at_crank[1], to_crank[1] * at_crank[0],
                -to_pin[0] * self.force[1], to_pin[1] * self.force[0]]

    def noise(self) -> float:
        """Rounding that any force of the row may contain: the last digits of weights, inertial forces and the gas force [N]."""
        b = self.bodies
        inertial = (b.crank_length + b.rod_length) * (self.turn**2 + self.rod_turn**2 + abs(self.turn_rate) + abs(self.rod_turn_rate))
        size = sum(b.mass) * (abs(b.gravity) + inertial) + abs(self.gas) + math.hypot(*self.force)
        if b.elastic:
            size += sum(k * abs(x) for k, x in zip(b.elastic.stiffness, self.shape_state[1:]))
            size += sum(b.mass) * sum(map(abs, self.shape_second[1:]))
        if self.is_loose or self.has_loose_crank_pin:   # accelerations of the rod are found from those of the piston
            size += sum(b.mass[1:]) * abs(self.ax)
        size += b.inertia[1] * (self.turn**2 + self.rod_turn**2 + abs(self.rod_turn_rate)) / b.rod_length
        return LAST_DIGITS * size * b.rod_length / abs(self.rod[0])   # the guide force is proportional to the rod's slope

    def joint_moment(self) -> float:
        """Moment of the piston pin's joint on the rod, from the rod's motion [N m]."""
        at_big_end = self.bearing_moment(self.crank_pin_moment()) if self.has_loose_crank_pin else 0.0
        if self.bodies.elastic:
            return -self.elastic_rod_sums(0.0, at_big_end)[0][2]   # residual of the chord's equation
        return math.fsum((*self.rod_moment_terms(), -at_big_end))

    def crank_pin_moment(self) -> float:
        """Moment of the crank pin's joint on the crank, from the crank's motion [N m]."""
        b, get = self.bodies, self.get
        pin = self.crankpin[0] - self.crank_arm[0], self.crankpin[1] - self.crank_arm[1]
        return math.fsum((b.inertia[0] * self.turn_rate, -self.crank_drive(),
                          cross(self.crank_arm, (get["crank_bearing_force_x"], get["crank_bearing_force_y"])),
                          cross(pin, (get["crankpin_force_x"], get["crankpin_force_y"]))))

    def rod_acceleration(self) -> Vector:
        """Acceleration of the rod's centre of mass, from the forces on the rod."""
        weight = scaled(self.bodies.gravity, self.bodies.downwards)
        forces = (self.get["crankpin_force_x"], self.get["crankpin_force_y"]), self.force
        return (weight[0] + (forces[0][0] + forces[1][0]) / self.bodies.mass[1], weight[1] + (forces[0][1] + forces[1][1]) / self.bodies.mass[1])

    def pin_acceleration(self, big_end: Vector) -> Vector:
        """Acceleration of the rod's pin, from that of its big end; also for a chord whose length changes."""
        at_end = acceleration(big_end, self.rod, self.rod_turn, self.rod_turn_rate)
        if not self.bodies.elastic:
            return at_end
        second = self.bodies.elastic.chord_acceleration(self.shape_state[1:], self.shape_rates[1:], self.shape_second[1:])
        across = 2 * self.chord_rate * self.rod_turn
        return (at_end[0] + (second * self.rod[0] - across * self.rod[1]) / self.chord, at_end[1] + (second * self.rod[1] + across * self.rod[0]) / self.chord)

    def elastic_balances(self, joint_moment: float | None, crank_pin_moment: float | None) -> dict[str, Balance]:
        """Lagrange's equations of an elastic rod, without those that contain a moment that no law here determines."""
        known = joint_moment is not None and crank_pin_moment is not None
        at_big_end = self.bearing_moment(crank_pin_moment) if known else 0.0
        sums = [Balance(abs(miss), size) for miss, size in zip(*self.elastic_rod_sums(joint_moment if known else 0.0, at_big_end))]
        found = {} if self.has_loose_crank_pin else {"Newton, rod along x": sums[0], "Newton, rod along y": sums[1]}
        if known:
            found["Euler, rod"] = sums[2]
        for name, one in zip(self.bodies.elastic.names, sums[3:]):
            if known or not name.startswith("rod_mode"):
                found[f"Lagrange, {name}"] = one
        return found

    def balances(self, joint_moment: float | None, crank_pin_moment: float | None = 0.0) -> dict[str, Balance]:
        """Sums that vanish in every row, by name. `joint_moment`: moment of the joint on the rod [N m], None if no law here
        determines it; `crank_pin_moment`: moment of the joint at the crank pin on the crank."""
        b, get, g = self.bodies, self.get, scaled(self.bodies.gravity, self.bodies.downwards)
        found = {}
        kinetic, potential = self.energy_terms()
        found["energy column"] = balance(get["energy"], *(-e for e in kinetic), *(-e for e in potential))
        on_rod = get["crankpin_force_x"], get["crankpin_force_y"]
        on_crank = get["crank_bearing_force_x"], get["crank_bearing_force_y"]
        at_pin = acceleration((0.0, 0.0), self.crankpin, self.turn, self.turn_rate)
        crank = acceleration((0.0, 0.0), self.crank_arm, self.turn, self.turn_rate)
        rod = acceleration(at_pin, self.rod_arm, self.rod_turn, self.rod_turn_rate)
        found["Newton, piston"] = balance(*(b.mass[2] * one for one in self.com_acceleration_terms), self.gas, self.force[0], -self.bore_friction,
                                          -b.mass[2] * g[0])
        # the guide force follows from the rod's moments, so it contains their rounding
        found["guide force"] = Balance(abs(get["guide_force"] + self.force[1] - b.mass[2] * (g[1] - self.com_acceleration[1])), abs(self.force[1]) + abs(on_rod[1]) + (
            sum(map(abs, self.rod_moment_terms())) + abs(self.rod[1] * on_rod[0])) / abs(self.rod[0]))
        if b.elastic:
            if self.is_detailed:
                found |= self.elastic_balances(joint_moment, crank_pin_moment)
        elif not self.has_loose_crank_pin:   # there is no column of the rod's acceleration
            found |= vector_balance("Newton, rod", scaled(b.mass[1], rod), scaled(-b.mass[1], g), scaled(-1, on_rod), scaled(-1, self.force))
        found |= vector_balance("Newton, crank", scaled(b.mass[0], crank), scaled(-b.mass[0], g), scaled(-1, on_crank), on_rod)
        arm, pin = self.crank_arm, (self.crankpin[0] - self.crank_arm[0], self.crankpin[1] - self.crank_arm[1])
        if crank_pin_moment is not None:
            found["Euler, crank"] = Balance(
                abs(math.fsum((b.inertia[0] * self.turn_rate, -self.crank_drive(), cross(arm, on_crank), cross(pin, on_rod), -crank_pin_moment))),
                abs(b.inertia[0] * self.turn_rate) + abs(get["crank_moment"]) + abs(b.damping * self.turn) + abs(self.crank_drive()) + abs(crank_pin_moment)
                + math.hypot(*arm) * math.hypot(*on_crank) + math.hypot(*pin) * math.hypot(*on_rod))
            if b.engine:
                found["Euler, crank"].size += math.fsum(map(abs, b.engine.on_crank(get, b.damping)))
        if b.engine:
            found |= {name: balance(*terms) for name, terms in b.engine.segment_terms(get).items()}
        if b.shaft:
            twisting = b.shaft[1] * get["crankshaft_twist"], b.shaft[2] * get["flywheel_speed"], -b.shaft[2] * self.turn
            found["shaft's law"] = balance(get["crankshaft_moment"], *(-term for term in twisting))
            found["Euler, flywheel"] = balance(b.shaft[0] * get["flywheel_acceleration"], -get["crank_moment"], b.damping * get["flywheel_speed"],
                                               get["crankshaft_moment"])
        if joint_moment is not None and crank_pin_moment is not None and not b.elastic:
            at_big_end = self.bearing_moment(crank_pin_moment)
            found["Euler, rod"] = Balance(
                abs(math.fsum((*self.rod_moment_terms(), -joint_moment, -at_big_end))), abs(joint_moment) + abs(at_big_end) + sum(
                    map(abs, self.rod_moment_terms())) + b.rod_length * (math.hypot(*on_rod) + math.hypot(*self.force)))
        found["force on the frame, x"] = balance(get["frame_force_x"], -on_crank[0], self.gas, -self.bore_friction)
        found["force on the frame, y"] = balance(get["frame_force_y"], -on_crank[1], get["guide_force"])
        e = get.get("eccentricity_x", 0.0), get.get("eccentricity_y", 0.0)
        found["pin in the bearing, x"] = balance(self.crankpin[0], -self.offset[0], self.rod[0], -self.x, -e[0])
        found["pin in the bearing, y"] = balance(self.crankpin[1], -self.offset[1], self.rod[1], -self.bearing[1], -e[1])
        if "eccentricity_x" not in get:
            found["pin speed, x"] = balance(self.pin_velocity[0], -self.vx)
            found["pin speed, y"] = balance(self.big_end_velocity[1], self.rod_turn * self.rod[0], self.chord_rate * self.rod[1] / self.chord,
                                            -self.bearing_velocity[1])
        if "eccentricity_x" not in get and not self.has_loose_crank_pin:
            at_end = self.pin_acceleration(at_pin)
            found["pin acceleration, x"] = Balance(abs(at_end[0] - self.ax), abs(at_end[0]) + abs(at_pin[0]))
            found["pin acceleration, y"] = Balance(abs(at_end[1] - self.bearing_acceleration), abs(at_pin[1]) + abs(
                self.rod_turn_rate * self.rod[0]) + abs(self.bearing_acceleration))
        noise = self.noise()
        for name, one in found.items():
            if name.startswith(("Newton", "guide", "force", "Lagrange")):
                one.noise = noise
            elif name.startswith("Euler"):
                one.noise = noise * (b.crank_length + b.rod_length)
        return found
