"""The piston's guide against the rows of a trace: its friction, and the corners or the film of a skirt with clearance in its bore."""
from __future__ import annotations

import bisect
import dataclasses
import math
import re

from .contact import Contact
from .films import Asperities
from .laws import LANDING, ROUNDING, Friction
from .mechanics import Row, rotated
from .trace import Run

LAW = 1e-6    # allowed relative error of a law's force, beyond the rounding of its arguments
SUM = 1e-9    # allowed error of a sum, relative to its terms
F52 = 1e-5    # allowed relative error of the program's series for the pressure of asperities


class RingFilm:
    """The face of a piston ring with a film, and its asperities."""

    def __init__(self, run: Run, ring: str) -> None:
        own = {key.removeprefix("rings."): value for key, value in run.case.items() if key.startswith("rings.")}
        own |= {"joint.bearing_radius": [1.0], "joint.bearing_length": [1.0]}
        self.asperities = Asperities(dataclasses.replace(run, case=own))
        height, crown, offset = (run.number(f"{ring}.{key}") for key in ("height", "crown", "crown_offset"))
        n = int(run.number("rings.lubrication.along"))
        self.relief = [crown * ((2 * j / n - 1) - 2 * offset / height)**2 for j in range(n + 1)]
        bore = run.number("combustion.bore") or run.number("cylinder_pressure.bore")
        self.area = [math.pi * bore * height / n * (0.5 if j in (0, n) else 1.0) for j in range(n + 1)]

    def pressing(self, gap: float) -> float:
        """Force of the asperities around the circumference at a least gap [N]."""
        return self.asperities.scale * math.fsum(area * self.asperities.pressure(h) for area, h in
                                                 zip(self.area, ((gap + relief) / self.asperities.roughness for relief in self.relief)) if h < 8)


class Guide:
    """The guide of a case. The corners are numbered from 1: top and bottom towards +y, then top and bottom towards -y."""

    def __init__(self, run: Run) -> None:
        n = run.number
        self.viscous = n("guide.viscous")
        self.rings = [name for name in run.columns if re.fullmatch(r"ring_\d_friction_force", name)]
        self.films = {name[:6]: RingFilm(run, name[:6]) for name in self.rings if f"{name[:6]}_film_thickness" in run.columns}
        case = {key.replace("guide.", "friction."): value for key, value in run.case.items() if key.startswith("guide.")}
        self.friction = Friction(dataclasses.replace(run, case={"friction.law": ["ambrosio"]} | case))   # without &guide: of no coefficient
        self.is_loose = run.has_loose_guide
        if not self.is_loose:
            return
        self.clearance, self.radius, self.tolerance = n("guide.bore_clearance"), n("guide.piston_radius"), n("integrator.relative_tolerance")
        along = run.pair("guide.piston_com")[0]
        self.reach = n("mechanism.crank_length") + n("mechanism.rod_length")
        self.height = n("guide.skirt_top") - along, -n("guide.skirt_bottom") - along
        self.contacts: list[Contact] = []
        self.has_film = run.text("guide.kind") == "lubricated"
        if self.has_film:
            self.widest = n("guide.barrel_height") - along if n("guide.barrel_height") <= 2 else sum(self.height) / 2
            self.barrel = n("guide.barrel") * 4 / (self.height[0] - self.height[1])**2
            self.has_profile = bool(run.text("guide.profile_table"))
            self.spring = n("guide.stiffness")
            return
        case = {key.replace("guide.", "contact."): value for key, value in run.case.items() if key.startswith("guide.")}
        case |= {"contact.law": run.case["guide.contact_law"], "contact.geometry": ["hertz_sphere"],
                 "contact.youngs_modulus": [1e11, 1e11], "contact.poissons_ratio": [0.3, 0.3]}
        self.contacts = [Contact(dataclasses.replace(run, case=case, events=[e for e in run.events if e["joint"] == f"guide_{k}"]))
                         for k in range(1, 5)]

    def corner(self, k: int, row: Row) -> tuple[float, float]:
        """Position of corner k relative to the piston's centre of mass [m]."""
        return rotated(self.height[(k - 1) % 2], math.copysign(self.radius, 2.5 - k), row.tilt)

    def depth(self, k: int, row: Row) -> float:
        """Penetration of corner k into the wall [m]."""
        return math.copysign(1.0, 2.5 - k) * (row.offset_y + self.corner(k, row)[1]) - self.radius - self.clearance

    def rates(self, k: int, row: Row) -> tuple[float, float]:
        """Rate of the penetration, and speed of the corner along the wall [m/s]."""
        x, y = self.corner(k, row)
        return math.copysign(1.0, 2.5 - k) * (row.offset_rate_y + row.tilt_rate * x), row.com_velocity[0] - row.tilt_rate * y

    def power(self, row: Row) -> float:
        """Power of all forces of the bore on the piston [W]."""
        get, v = row.get, row.com_velocity[0]
        if not self.is_loose:
            return get["guide_friction_force"] * v
        total = get.get("ring_friction_force", 0.0) * v - self.viscous * v**2
        if self.has_film:
            if self.spring:   # with the rate of the energy of the springs
                return total - get["skirt_power"]
            return total + get["skirt_friction_force"] * v + get["skirt_force"] * row.offset_rate_y + get["skirt_moment"] * row.tilt_rate
        for k in range(1, 5):
            rate, along = self.rates(k, row)
            total += get[f"guide_{k}_friction"] * along - get[f"guide_{k}_force"] * rate
        return total

    def side(self, row: Row, i: int, begins: list[list[float]], time: float) -> tuple:
        """Everything that jumps or has a kink: corners in contact, the number of their contact, and the sense of sliding."""
        if not self.is_loose:
            sense = row.get["guide_force"] > 0
            return self.friction.side(row.com_velocity[0], 0.0)[0], sense
        found: list[tuple[int, int] | None] = []
        for k in range(1, 1 + len(self.contacts)):
            touches = row.get[f"guide_{k}_force"] > 0 or self.depth(k, row) > 0
            found.append((bisect.bisect_left(begins[k - 1], time), self.friction.side(self.rates(k, row)[1], 0.0)[0]) if touches else None)
        return tuple(found)

    @property
    def begins(self) -> list[list[float]]:
        return [contact.begin for contact in self.contacts] if self.is_loose else []

    def check_film(self, checks, row: Row, t: float) -> None:
        """Check the gaps at the ends of the faces of a lubricated skirt, its power, and that it takes power."""
        get, v = row.get, row.com_velocity[0]
        for k in range(1, 1 + 4 * (not self.has_profile)):
            z = self.height[(k - 1) % 2]
            bent = get[f"guide_{k}_deflection"] if self.spring else 0.0
            gap = self.clearance + self.barrel * (z - self.widest)**2 - math.copysign(1.0, 2.5 - k) * (row.offset_y + z * row.tilt) + bent
            checks.take("gap at an end of the skirt", abs(get[f"guide_{k}_gap"] - gap), 1e-14 * (self.clearance + abs(z * row.tilt) + abs(bent)), t)
            checks.take("the wall draws an end of the skirt", max(0.0, -bent), 100 * self.tolerance * self.clearance + 1e-300, t)
        parts = get["skirt_force"] * row.offset_rate_y, get["skirt_moment"] * row.tilt_rate, get["skirt_friction_force"] * v
        if not self.spring:   # else the energy balance tells
            checks.take("power of the skirt", abs(get["skirt_power"] + math.fsum(parts)), SUM * sum(map(abs, parts)) + 1e-300, t)
        if get["skirt_asperity_force"] <= 0:   # else their elastic energy is in it
            checks.take("the film of the skirt gives power", max(0.0, -get["skirt_power"]), SUM * sum(map(abs, parts)), t)

    def check(self, checks, row: Row, t: float) -> None:
        """Check one row; `checks` records the errors."""
        get, v = row.get, row.com_velocity[0]
        give = 10 * ROUNDING * (row.speed_size + abs(row.tilt_rate) * math.hypot(*row.com))
        rings = get.get("ring_friction_force", 0.0)
        one_by_one = [get[name] for name in self.rings]
        checks.take("friction of the rings", abs(sum(one_by_one) - rings), SUM * abs(rings) + 1e-300, t)
        plain = [get[name] * v for name in self.rings if name[:6] not in self.films]   # gas and squeeze may make a film push
        checks.take("friction of a ring drives", max(0.0, *plain) if plain else 0.0, 1e-300, t)
        for name, film in self.films.items():
            force = film.pressing(get[f"{name}_film_thickness"])
            checks.take("asperities of a ring", abs(get[f"{name}_asperity_force"] - force), F52 * force + 1e-9 * film.asperities.scale * film.area[1], t)
        if not self.is_loose:
            low, high = self.friction.range(v, give)
            normal, got = abs(get["guide_force"]), get["guide_friction_force"] + self.viscous * v - rings
            low, high = low * normal, high * normal
            slack = LAW * (abs(low) + abs(high)) / 2 + SUM * (abs(self.viscous * v) + abs(rings)) + row.noise() * max(abs(low), abs(high)) / (normal or 1.0)
            checks.take("friction on the guide", max(low - got, got - high, 0.0), slack + 1e-300, t)
            return
        total, moment, size = rings - self.viscous * v, 0.0, 0.0
        if self.has_film:
            total, moment = total + get["skirt_friction_force"], get["skirt_moment"]
            size = abs(moment) + abs(get["skirt_force"]) * (self.radius + abs(self.height[0]) + abs(self.height[1]))
            self.check_film(checks, row, t)
        for k in range(1, 1 + len(self.contacts)):
            depth, (rate, along) = self.depth(k, row), self.rates(k, row)
            checks.take("gap of a corner", abs(get[f"guide_{k}_gap"] + depth), 1e-15 * (self.radius + abs(row.offset_y)) * 4, t)
            depth = -get[f"guide_{k}_gap"]
            normal, friction = get[f"guide_{k}_force"], get[f"guide_{k}_friction"]
            if t <= checks.run.times[0] and depth > 0:
                self.contacts[k - 1].pressed = True
            known = self.contacts[k - 1].learn(depth, rate, t, normal)
            low, high = (self.contacts[k - 1].force(depth, rate + d, t) for d in (-give, give))
            low, high = min(low, high), max(low, high)
            size_of_law = self.contacts[k - 1].size(depth, rate, t)
            blur = 4e-15 * (self.radius + self.clearance) / depth * self.contacts[k - 1].geometry.exponent if depth > 0 else 0.0
            near = 1e-15 * (self.radius + self.clearance + abs(self.height[(k - 1) % 2] * row.tilt)) + 1e-9 * self.clearance
            events = self.contacts[k - 1].begin
            if (i := bisect.bisect_left(events, t * (1 - 1e-15))) < len(events) and events[i] <= t * (1 + 1e-15):
                # a step that lands on the event ends within its own error of the wall, and within the rounding of the chain's lengths
                near += 1e-15 * self.reach + LANDING * self.tolerance * (abs(row.offset_y) + abs(self.height[(k - 1) % 2] * row.tilt) + self.clearance)
            # a row where the contact begins or ends, written before or after this event
            at_wall = abs(self.contacts[k - 1].force(2 * near, rate, t)) if abs(depth) <= near else 0.0
            if known:
                checks.take("contact law of a corner", max(low - normal, normal - high, 0.0), (LAW + blur) * max(abs(normal), size_of_law) + at_wall, t)
            low, high = (one * normal for one in self.friction.range(along, give))
            checks.take("friction law of a corner", max(low - friction, friction - high, 0.0), LAW * (abs(low) + abs(high)) / 2 + 1e-300, t)
            total += friction
            x, y = self.corner(k, row)
            side = math.copysign(1.0, 2.5 - k)
            moment += -side * x * normal - y * friction
            size += abs(x * normal) + abs(y * friction)
        checks.take("friction on the piston", abs(total - get["guide_friction_force"]), SUM * (abs(total) + abs(self.viscous * v) + abs(rings)) + 1e-300, t)
        corners = range(1, 1 + len(self.contacts))
        pressing = sum(math.copysign(get[f"guide_{k}_force"], 2.5 - k) for k in corners) if corners else -get["skirt_force"]
        forces = sum(abs(get[f"guide_{k}_force"]) for k in corners) + math.hypot(*row.force) + abs(pressing)
        checks.take("force of the corners on the guide", abs(pressing - get["guide_force"]), SUM * forces + 10 * row.noise(), t)
        joint = checks.joint_moment(row) if checks.has_joint else 0.0
        if joint is None:   # the moment of a film's shear has no column
            return
        turning = row.piston_moment_terms(joint) + [moment]
        size += sum(map(abs, turning))
        checks.take("Euler, piston", abs(math.fsum(turning)), SUM * size + 10 * row.noise() * (self.radius + abs(self.height[0]) + abs(self.height[1])), t)
