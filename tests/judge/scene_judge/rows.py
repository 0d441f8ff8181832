"""Checks every row of a trace against mechanics and the laws."""
from __future__ import annotations

import dataclasses
import math

from .contact import Contact
from .drive import Drive
from .films import Asperities, Film, viscosities
from .gas import gas_of
from .guide import Guide
from .laws import LANDING, ROUNDING, Friction
from .mechanics import Bodies, Row
from .trace import Run

FREE, FILM, CONTACT = 0, 1, 2
SUM = 1e-9        # allowed residual of a sum that must vanish, relative to its terms
LAW = 1e-6        # allowed relative error of a law's force, beyond the rounding of its arguments
DETAILED = 1500   # number of rows in which the equations of an elastic rod are checked
STICKS = 10       # allowed sliding speed of surfaces that stick, in tolerances of the speeds
INTEGRATED = 1500  # number of rows in which a film is judged if its pressure is integrated
SOLVED = 8         # the same if its pressure is solved for
LEAST_GAP = 1e-4   # smallest film thickness over the clearance in the table of a film
OSCILLATING = 2e-5  # allowed relative error of the oscillating film's averages
WORN = 3e-6        # allowed relative error of the sum of the forces that press on an arc, of which the program adds 32
ASPERITIES = 1e-5  # allowed relative error of the series of F52 and of the spline through the forces
CLEAR = 0.01       # largest relative uncertainty of a force, from the film's velocity between rows
MOVING = 2e-4, 2000  # allowed error of a rate in rows between two steps, relative and in tolerances: there the positions of the film
                     # are as accurate as in the steps, but not their differences
EVENT = 1e-10     # error of the time of an event, of the distance to the row before it
LEAST_BEND = 5e-9  # [m] if the break-away deflection is smaller, break-away is within a step and cannot be checked between steps
BENT = 1000       # allowed excess over static friction in rows between the steps, in tolerances of the static friction


@dataclasses.dataclass
class Miss:
    """The worst row of one check: its error over the allowed error. The check fails if this share is above 1."""

    check: str
    share: float = 0.0
    time: float = 0.0
    rows: int = 0

    def take(self, miss: float, allowed: float, time: float) -> None:
        self.rows += 1
        if miss <= 0:
            return
        share = miss / allowed if allowed > 0 else math.inf
        if not share <= self.share:   # NaN counts as the worst
            self.share, self.time = (share if share == share else math.inf), time

    @property
    def text(self) -> str:
        return f"{self.check}: {self.share:.3g} times what is allowed at t = {self.time:.9g} s"


def slope(times: list[float], values: list[float]) -> float:
    """Derivative at the middle time of the polynomial through values at times."""
    middle = len(times) // 2
    here, total = times[middle], 0.0
    for j, t in enumerate(times):
        if j == middle:
            continue
        weight = 1 / (t - here)
        for k, other in enumerate(times):
            if k not in (j, middle):
                weight *= (here - other) / (t - other)
        total += weight * (values[j] - values[middle])
    return total


def inside(value: float, low: float, high: float) -> float:
    """Distance of a value from a range; 0 inside it."""
    return max(low - value, value - high, 0.0) if value == value else math.nan


class RowChecks:
    """Checks the rows of a run; `misses` are the worst row of each check."""

    def __init__(self, whole: Run, joint: str = "piston_pin") -> None:
        run = self.run = whole.at(joint)
        self.joint = joint
        self.crank_pin = RowChecks(whole, "crank_pin") if joint == "piston_pin" and whole.has_loose_crank_pin else None
        self.bodies = Bodies.of(run)
        self.misses: dict[str, Miss] = {}
        self.begins = [float(event["time[s]"]) for event in run.events if event["event"] == "contact_begins"]
        self.has_joint = run.has_clearance
        self.film = run.text("lubrication.law")
        self.film_law = Film(run) if self.has_joint and self.film else None
        self.asperities = Asperities(run) if self.has_joint and "asperities.roughness" in run.case else None
        self.contact = Contact(run) if self.has_joint and run.text("contact.law") else None
        self.friction = Friction(run) if self.has_joint and run.text("friction.law") else None
        self.elastic = self.run.case.get("lubrication.elastic_film", [False])[0]
        self.wears = self.has_joint and "wear.rate" in run.case
        self.worn_bore = self.wears and run.text("wear.bore") == "worn"   # no law of a round bore
        self.weighted = self.contact is not None and run.text("lubrication.transition") == "weighted"
        self.drive = Drive(run) if joint == "piston_pin" and "crankshaft.flywheel_inertia" not in run.case else None
        engine = self.bodies.engine
        knows_gas = not engine or engine.has_gas and engine.scale == 1
        self.gas = gas_of(run) if joint == "piston_pin" and knows_gas else None
        self.guide = Guide(whole) if whole.has_guide and joint == "piston_pin" else None
        tolerance = min(run.number("integrator.relative_tolerance"), 1e-3)
        self.gas_tolerance = max(10 * tolerance, 1e-9)

    def take(self, check: str, miss: float, allowed: float, time: float) -> None:
        self.misses.setdefault(check, Miss(check)).take(miss, allowed, time)

    def row(self, i: int) -> Row:
        return Row(self.bodies, self.run.columns, i)

    def share(self, depth: float) -> float:
        """Share of the contact in the joint's load at a penetration [m]: all of it, or the share in a transition from the film."""
        if not self.weighted:
            return 1.0
        s = min(max(depth / self.run.number("lubrication.transition_depth"), 0.0), 1.0)
        return s if self.run.text("lubrication.transition_shape") == "linear" else 3 * s**2 - 2 * s**3

    def zone(self, i: int) -> tuple[bool, bool]:
        """Whether the pin is beyond each kink of a film in transition to contact: where it is limited, and where it vanishes. A row
        on a kink belongs to the side before it."""
        if not self.weighted:
            return False, False
        number, clearance = self.run.number, self.run.number("joint.clearance")
        kinks = -number("lubrication.least_film_ratio") * clearance, number("lubrication.transition_depth")
        beyond = [-self.run.columns["film_thickness"][i] - kink for kink in kinks]
        before = self.zone(i - 1) if i and min(map(abs, beyond)) < 1e-12 * clearance else (False, False)
        held, gone = (old if abs(d) < 1e-12 * clearance else d > 0 for d, old in zip(beyond, before))
        return held, gone

    def joint_moment(self, row: Row) -> float | None:
        """Moment of the joint on its journal [N m]: friction at the pin's radius, none from pressure; None for the shear of a
        film."""
        phase = row.get.get("phase", FREE)
        if self.film and phase != FREE and self.run.case.get("lubrication.film_moment", [False])[0]:
            return None
        if self.weighted and self.film == "oscillating_film":
            return None
        if phase == CONTACT and self.friction or phase == FILM and self.asperities and self.film != "oscillating_film":
            return row.get["friction_force"] * self.bodies.pin_radius
        return None if phase == FILM and self.film == "oscillating_film" else 0.0

    def check(self) -> dict[str, Miss]:
        every = max(1, len(self.run.times) // DETAILED) if self.bodies.elastic else 1
        for i in range(len(self.run.times)):
            row = self.row(i)
            row.is_detailed = i % every == 0
            t = row.get["time"]
            at_crank_pin = row.crank_pin(self.crank_pin.run.columns, i) if self.crank_pin else None
            moments = self.joint_moment(row) if self.has_joint else 0.0, self.crank_pin.joint_moment(at_crank_pin) if self.crank_pin else 0.0
            for name, found in row.balances(*moments).items():
                self.take(name, found.miss, SUM * found.size + found.noise + 1e-300, t)
            if self.crank_pin:
                self.crank_pin.check_joint(at_crank_pin, i)
            if self.has_joint:
                self.check_joint(row, i)
            for name, (miss, allowed) in (self.drive.misses(row, t) if self.drive else {}).items():
                self.take(name, miss, allowed + 1e-300, t)
            if self.gas:
                self.check_gas(row, i, t)
            if self.guide:
                self.guide.check(self, row, t)
        if self.crank_pin:
            self.misses |= {f"crank pin: {name}": dataclasses.replace(miss, check=f"crank pin: {name}")
                            for name, miss in self.crank_pin.misses.items()}
        return self.misses

    def check_joint(self, row: Row, i: int) -> None:
        get, c, t = row.get, self.run.number("joint.clearance"), row.get["time"]
        e = get["eccentricity_x"], get["eccentricity_y"]
        size = math.hypot(*e)
        thinnest = math.hypot(get["film_eccentricity_x"], get["film_eccentricity_y"]) if self.elastic else size
        self.take("eccentricity ratio", abs(size / c - get["eccentricity_ratio"]), 1e-14 * (1 + size / c), t)
        if self.worn_bore:
            return
        self.take("film thickness", abs(c - thinnest - get["film_thickness"]), 1e-14 * (c + size), t)
        phase = get["phase"]
        if self.wears:
            self.check_wear(row, size, phase, t)
        n = (e[0] / size, e[1] / size) if size > 0 else (1.0, 0.0)
        give = ROUNDING * row.speed_size
        if phase != CONTACT and self.friction and self.friction.has_bristles:
            self.take("no bristles bent", abs(get["bristle"]), 0.0, t)
        if phase == FREE:
            self.take("no force in free flight", math.hypot(*row.force), row.law_noise, t)
        if phase == FILM:
            self.check_film(row, n, give, i)
        if phase == CONTACT and self.contact:
            self.check_contact(row, n, give, i)

    def check_contact(self, row: Row, n: tuple[float, float], give: float, i: int) -> None:
        get, t = row.get, row.get["time"]
        depth, rate = -get["film_thickness"], n[0] * row.slip[0] + n[1] * row.slip[1]
        share = self.share(depth)
        if i == 0 and depth > 0:
            self.contact.pressed = True
        known = self.contact.learn(depth, rate, t, get["normal_force"] / share if share else 0.0)
        low, high = (share * self.contact.force(depth, rate + d, t) for d in (-give, give))
        normal, friction = get["normal_force"], get["friction_force"]
        # the depth is the difference of two lengths, and the force may have ended in a row at the rounded time of this event
        exponent = self.contact.geometry.exponent + 2 * self.weighted
        rounding = 1e-15 * self.run.number("joint.clearance") + 4e-16 * abs(t * rate)
        blur = exponent * rounding / depth + self.blur_of_share(row, i) if depth > 0 else 0.0
        if known:
            self.take("contact law", inside(normal, low, high), (LAW + blur) * max(abs(normal), share * self.contact.size(depth, rate, t)), t)
        if "contact_half_angle" in get:
            self.check_arc(row, depth, normal, blur, t)
        want = -normal * n[0] - friction * n[1], -normal * n[1] + friction * n[0]
        film = (get["film_force_x"], get["film_force_y"]) if self.weighted else (0.0, 0.0)
        self.take("contact force on the pin", math.hypot(row.force[0] - want[0] - film[0], row.force[1] - want[1] - film[1]),
                  SUM * (abs(normal) + abs(friction) + math.hypot(*film)) + row.law_noise, t)
        if self.weighted:
            self.check_film_law(row, n, film, 1 - share, give, i)
        sliding = n[0] * row.slip[1] - n[1] * row.slip[0] + (row.journal_turn - row.bearing_turn) * self.bodies.pin_radius
        sliding -= row.bearing_turn * (self.run.number("joint.clearance") + depth)
        self.take("sliding speed", abs(sliding - get["sliding_speed"]), 10 * give, t)
        if not self.friction:
            self.take("no friction", abs(friction), 0.0, t)
            return
        if self.friction.has_bristles:
            bent = self.friction.stiffness * abs(get["bristle"])
            low, high = self.friction.bristle_range(get["sliding_speed"], get["bristle"], 10 * give)
            self.take("friction law", inside(friction, low * normal, high * normal), LAW * normal * (bent + abs(low) + abs(high)) + 1e-300, t)
            if self.friction.gives_way < LEAST_BEND:
                return
            self.take("bristles bent by static friction", max(0.0, bent - self.friction.static),
                      BENT * self.run.number("integrator.relative_tolerance") * self.friction.static, t)
            return
        low, high = self.friction.range(get["sliding_speed"], 10 * give)
        drift = STICKS * self.run.number("integrator.relative_tolerance")
        law = LAW
        if self.friction.coulomb and abs(sliding) <= max(1e3 * give, drift * row.speed_size):   # the surfaces stick, or nearly stick
            low, high = -self.friction.static, self.friction.static
            law = max(LAW, drift)   # in the row where slip begins, friction is already beyond its limit
        self.take("friction law", inside(friction, low * normal, high * normal), law * normal * (abs(low) + abs(high)) / 2 + 1e-300, t)

    def check_arc(self, row: Row, depth: float, normal: float, blur: float, t: float) -> None:
        """The load that belongs to the contact arc is that of the penetration, and the pressures over the arc result in the normal
        force."""
        if depth <= 0:
            return
        geometry = self.contact.geometry
        x, force = geometry.carried(row.get["contact_half_angle"], row.get["peak_pressure"])
        want = geometry.load(depth)
        self.take("contact half-angle", abs(x - want), (LAW + 2 * blur) * want, t)
        self.take("peak pressure", abs(force - normal), (LAW + 2 * blur) * normal + 1e-300, t)

    def check_wear(self, row: Row, size: float, phase: float, t: float) -> None:
        """Check the volumes that wear in a second."""
        get, load, share, least = row.get, 0.0, WORN, 0.0
        depth = -get["film_thickness"]
        if phase == CONTACT and self.contact and get["normal_force"] > 0:
            load = get["normal_force"] * self.contact.geometry.pressing(depth, get.get("contact_half_angle", 0.0))
            share += 1e-14 * self.run.number("joint.clearance") / depth   # on a narrow arc the program's pressure is a quotient of differences
        elif phase == FILM and self.asperities and get["asperity_force"] > 0:
            along, whole = self.asperities.forces(size, -depth)
            load, share, least = get["asperity_force"] * (whole / along if along > 0 else 1.0), ASPERITIES, 1e-6 * self.asperities.scale * ASPERITIES
        speed = abs(get["sliding_speed"])
        for name, rate in zip(("pin_wear_rate", "bore_wear_rate"), self.run.pair("wear.rate")):
            self.take("rate of wear", abs(get[name] - rate * load * speed), (share * load + least) * rate * speed + 1e-300, t)

    def check_film(self, row: Row, n: tuple[float, float], give: float, i: int) -> None:
        get, t = row.get, row.get["time"]
        film = get["film_force_x"], get["film_force_y"]
        rest = row.force[0] - film[0], row.force[1] - film[1]
        if self.asperities:
            normal, friction = get["asperity_force"], get["friction_force"]
            rest = rest[0] + normal * n[0] + friction * n[1], rest[1] + normal * n[1] - friction * n[0]
            self.check_asperities(row, n, give, t)
        self.take("film force on the pin", math.hypot(*rest), row.law_noise + (SUM * math.hypot(*row.force) if self.asperities else 0.0), t)
        if self.elastic:
            self.check_walls(row, give, t)
            self.check_moving_film(row, film, i)
            return
        if self.contact:
            self.take("no contact force in a film", abs(get["normal_force"]) + abs(get["friction_force"]), 0.0, t)
        self.check_film_law(row, n, film if self.asperities else row.force, 1.0, give, i)

    def check_asperities(self, row: Row, n: tuple[float, float], give: float, t: float) -> None:
        """Check that asperities in contact press the pin towards the centre, and their friction."""
        get, rough = row.get, self.asperities
        size, gap = math.hypot(get["eccentricity_x"], get["eccentricity_y"]), get["film_thickness"]
        normal, friction = get["asperity_force"], get["friction_force"]
        want = rough.force(size, gap)
        self.take("asperities", abs(normal - want), ASPERITIES * want + 1e-6 * rough.scale * ASPERITIES, t)
        radius = self.bodies.pin_radius
        speed = n[0] * row.slip[1] - n[1] * row.slip[0] + row.journal_turn * radius - row.bearing_turn * (size + radius)
        low, high = sorted(-rough.coefficient * normal * math.tanh((speed + d) / rough.speed) for d in (10 * give, -10 * give))
        self.take("boundary friction", inside(friction, low, high), LAW * abs(normal) * rough.coefficient + 1e-300, t)

    def check_walls(self, row: Row, give: float, t: float) -> None:
        """Check that the load of the elastic walls is that of the film, along their deflection."""
        get = row.get
        d = get["eccentricity_x"] - get["film_eccentricity_x"], get["eccentricity_y"] - get["film_eccentricity_y"]
        depth = math.hypot(*d)
        want = self.contact.geometry.force(depth) if depth > 0 else 0.0
        blur = 4e-15 * (self.contact.geometry.exponent + 1) * self.run.number("joint.clearance") / depth if depth > 0 else 0.0
        miss = math.hypot(row.force[0] + want * d[0] / depth, row.force[1] + want * d[1] / depth) if depth > 0 else math.hypot(*row.force)
        self.take("elastic walls", miss, (LAW + blur) * want + row.law_noise + 1e-300, t)
        self.take("wall deflection", abs(depth - get["wall_deflection"]), 1e-14 * (depth + self.run.number("joint.clearance")), t)

    def is_judged(self, i: int) -> bool:
        """Whether a film is judged in a row; not in every row if it takes long."""
        if self.film == "pinkus_sternlicht" and self.film_law.variant != "half_film":
            return True
        return i % max(1, len(self.run.times) // (SOLVED if self.film_law.is_solved else INTEGRATED)) == 0

    def check_film_law(self, row: Row, n: tuple[float, float], force: tuple[float, float], share: float, give: float, i: int) -> None:
        """Check a share of the film that the case names."""
        get, law, c, t = row.get, self.film_law, self.run.number("joint.clearance"), row.get["time"]
        eps, gap = get["eccentricity_ratio"], get["film_thickness"] / c
        least = self.run.number("lubrication.least_film_ratio") if self.weighted else 0.0
        size = math.hypot(*row.slip) + c * abs(row.journal_turn + row.bearing_turn)
        place = eps, gap
        if self.asperities:
            mean, slope = self.asperities.mean_gap(get["film_thickness"])
            place = 1 - mean / c, mean / c
        if self.film == "oscillating_film":
            self.check_oscillating(row, n, force, share, *place, i)
            return
        if not self.is_judged(i) or eps <= 1e-3 or size <= 1e6 * give:
            return
        along, across = n[0] * row.slip[0] + n[1] * row.slip[1], n[0] * row.slip[1] - n[1] * row.slip[0]
        if law.law == "pinkus_sternlicht" and law.variant != "half_film" and abs(along) <= 1e6 * give:
            return
        if self.asperities:
            along, across = slope * along, place[0] / eps * across
            eps, gap = place
        elif self.weighted and gap < least:
            gap, eps = least, 1 - least
        if not 1e-3 < eps < 1 or law.is_solved and gap < LEAST_GAP:
            return
        turn = row.journal_turn + row.bearing_turn
        if "film_temperature" in get:
            share *= viscosities(self.run, get["film_temperature"])[0] / law.viscosity
        want = law.force(eps, gap, along, across, turn)
        others = [] if law.is_solved else [law.force(eps, gap, along + dx, across + dy, turn) for dx, dy in ((give, 0), (0, give))]
        blur = sum(math.hypot(other[0] - want[0], other[1] - want[1]) for other in others)
        blur += 1e-15 / max(gap, least) * math.hypot(*want)
        if not law.is_solved:   # a thin film's force can be the small difference of much larger ones of wedge and squeeze
            other = law.force(eps - 1e-15, gap + 1e-15, along, across, turn)
            blur += math.hypot(other[0] - want[0], other[1] - want[1])
        blur += self.blur_of_share(row, i) * math.hypot(*want)
        miss = math.hypot(n[0] * force[0] + n[1] * force[1] - share * want[0], n[0] * force[1] - n[1] * force[0] - share * want[1])
        self.take("film law", miss, (LAW + law.margin(eps, gap, along, across, turn)) * share * math.hypot(*want) + 10 * blur, t)

    def blur_of_share(self, row: Row, i: int) -> float:
        """Error of the share of a film in transition to contact: a quotient of two differences of lengths, at a time that is
        rounded as well, and may be that of an event. A step that lands on the event of a kink ends within its own error of it, and
        the share goes on linearly until the kink is reached."""
        if not self.weighted:
            return 0.0
        clearance, depth = self.run.number("joint.clearance"), self.run.number("lubrication.transition_depth")
        landing = LANDING * self.run.number("integrator.relative_tolerance") * clearance
        near = min(abs(row.get["film_thickness"] + kink) for kink in (0.0, depth)) <= landing
        late = 4e-16 * abs(row.get["time"]) + (EVENT * (row.get["time"] - self.run.times[i - 1]) if i else 0.0)
        rounding = 4e-15 * clearance + late * math.hypot(*row.slip)
        return (rounding + near * landing) / depth

    def check_oscillating(self, row: Row, n: tuple[float, float], force: tuple[float, float], share: float, eps: float, gap: float,
                          i: int) -> None:
        """Check a film that carries no load along the line of centres."""
        t = row.get["time"]
        if self.film_law.is_known:
            self.take("no load along the line of centres", abs(force[0] * n[0] + force[1] * n[1]), SUM * math.hypot(*force) + row.law_noise, t)
        if self.joint != "piston_pin" or not self.film_law.is_known or not self.is_judged(i) or not (abs(row.turn) > 1e-3 and eps > 1e-3):
            return
        whole, size = self.film_law.oscillating(row, eps, gap)
        found = n[0] * force[1] - n[1] * force[0]
        allowed = (OSCILLATING * share + self.blur_of_share(row, i)) * abs(whole) + ROUNDING * share * size + row.law_noise
        self.take("film law", abs(found - share * whole.real), allowed, t)

    def check_moving_film(self, row: Row, force: tuple[float, float], i: int) -> None:
        """Check a film between elastic walls, whose pressure takes long to find, with the rate of its place from the rows around this
        one; other films by moving_films."""
        times, law = self.run.times, self.film_law
        if not law.is_solved or not self.is_judged(i) or i < 2 or i > len(times) - 3 or len({*times[i - 2:i + 3]}) < 5:
            return
        columns = self.run.columns["film_eccentricity_x"], self.run.columns["film_eccentricity_y"]
        place = columns[0][i], columns[1][i]
        size, c = math.hypot(*place), self.run.number("joint.clearance")
        if not 1e-3 < size / c < 1 or {self.run.columns["phase"][k] for k in range(i - 2, i + 3)} != {FILM}:
            return
        n = place[0] / size, place[1] / size
        load = math.hypot(*force)
        thicker = math.exp(self.run.number("lubrication.pressure_viscosity") * load / (2 * law.radius * law.length))

        turn = row.journal_turn + row.bearing_turn

        def rate(reach: int) -> tuple[float, float]:
            rows = range(i - reach, i + reach + 1)
            x, y = (slope([times[k] for k in rows], [column[k] for k in rows]) for column in columns)
            return n[0] * x + n[1] * y, n[0] * y - n[1] * x

        where = size / c, row.get["film_thickness"] / c
        want, coarse = (law.force(*where, *rate(reach), turn) for reach in (2, 1))
        blur = thicker * math.hypot(want[0] - coarse[0], want[1] - coarse[1])
        if blur > CLEAR * load:
            return
        miss = math.hypot(n[0] * force[0] + n[1] * force[1] - thicker * want[0], n[0] * force[1] - n[1] * force[0] - thicker * want[1])
        along, across = rate(2)   # nearly zero, apart from the rotation with the pin, if the walls hardly deform
        given = math.hypot(along, across - turn * size / 2) / (math.hypot(along, across) or 1.0)
        between = max(MOVING[0], MOVING[1] * self.run.number("integrator.relative_tolerance")) / min(max(given, 1e-12), 1.0)
        # the force is that of the walls, whose deflection is known to the tolerance of the eccentricity
        deflection = abs(row.get["wall_deflection"])
        walls = min(1.0, self.run.number("integrator.relative_tolerance") * c / deflection) if deflection > 0 else 1.0
        self.take("film law", miss, (between + law.margin(*where, *rate(2), turn) + walls) * load + 3 * blur + row.law_noise, row.get["time"])

    def check_gas(self, row: Row, i: int, t: float) -> None:
        get, gas = row.get, self.gas
        self.take("gas force", abs((get["cylinder_pressure"] - gas.under) * gas.area - get["gas_force"]),
                  SUM * (get["cylinder_pressure"] + gas.under) * gas.area, t)
        volume = gas.volume(row.q - gas.top)
        self.take("cylinder volume", abs(volume - get["cylinder_volume"]), SUM * volume + gas.rounding, t)
        want = gas.wanted(i, row.q)
        if want is not None:
            # an angle of many revolutions is rounded, and where the cylinder opens abruptly a small error of the angle has a large
            # effect
            self.take("gas law", abs(get["cylinder_pressure"] - want), self.gas_tolerance * want, t)
