"""Several cylinders on one crankshaft: the others than that of the mechanism, the stations of the shaft and the rings of its dampers.

The bodies of another cylinder are followed from the angle of its throw; its inertia is that of their speeds; the slopes of inertia and
potential energy are imaginary parts at a complex angle. A station j turns so that ((J + sum I) q_j')' = sum (I'/2 q_j'^2 + G - F p) + torques of the shaft, of rings, of
its own damping and of the drive.
"""
from __future__ import annotations

import cmath
import dataclasses
import math

from .trace import Run

INTERPOLATED = 2e-14   # rounding error of a state in a row, relative
STEP = 1e-30   # imaginary part of an angle from which derivatives follow [rad]


@dataclasses.dataclass
class Other:
    """A cylinder with ideal joints, in its own axes."""

    number: int
    station: int
    shift: float                        # its crank angle less that of its station
    gravity: tuple[float, float]
    length: tuple[float, float]         # crank, rod
    mass: tuple[float, float, float]    # crank, rod, piston
    inertia_about: tuple[float, float]  # crank, rod, about their centres of mass
    com: tuple[list[float], list[float]]
    axis_offset: float

    def of_angle(self, q: complex) -> tuple[complex, complex, complex]:
        """Twice the kinetic energy at a speed of 1 rad/s, the potential energy, and dx/dq of the piston."""
        r, length = self.length
        a = cmath.asin((r * cmath.sin(q) - self.axis_offset) / length)
        k = r * cmath.cos(q) / (length * cmath.cos(a))
        (u, v), (uc, vc) = self.com[1], self.com[0]
        along, normal = (cmath.cos(a), -cmath.sin(a)), (cmath.sin(a), cmath.cos(a))
        pin, pin_rate = (r * cmath.cos(q), r * cmath.sin(q)), (-r * cmath.sin(q), r * cmath.cos(q))
        rod = [pin[i] + u * along[i] + v * normal[i] for i in (0, 1)]
        rod_rate = [pin_rate[i] + k * (v * along[i] - u * normal[i]) for i in (0, 1)]
        crank = uc * cmath.cos(q) - vc * cmath.sin(q), uc * cmath.sin(q) + vc * cmath.cos(q)
        rate = -r * cmath.sin(q) - length * cmath.sin(a) * k
        moving = (self.inertia_about[0] + self.mass[0] * (uc**2 + vc**2) + self.inertia_about[1] * k**2
                  + self.mass[1] * (rod_rate[0]**2 + rod_rate[1]**2) + self.mass[2] * rate**2)
        high = [self.mass[0] * crank[i] + self.mass[1] * rod[i] for i in (0, 1)]
        high[0] += self.mass[2] * (pin[0] + length * cmath.cos(a))
        return moving, -(self.gravity[0] * high[0] + self.gravity[1] * high[1]), rate

    def energies(self, q: float) -> list[float]:
        """The real quantities of an angle."""
        return [one.real for one in self.of_angle(q)]

    def slopes(self, q: float) -> list[float]:
        """Their derivatives with respect to the angle, to rounding, since they are analytic in it."""
        return [one.imag / STEP for one in self.of_angle(complex(q, STEP))]


class Engine:
    """The crankshaft of a case. Station 0 is the first; `full` that of the mechanism."""

    def __init__(self, run: Run) -> None:
        n, case = run.number, run.case
        count = max((int(key.split(".")[0][9:]) for key in case if key.startswith("cylinder_") and key[9:10].isdigit()), default=0)
        names = [f"cylinder_{k + 1}" for k in range(count)]
        full = next((k for k, name in enumerate(names) if case[f"{name}.full"][0]), 0)
        self.inertia = case.get("crankshaft.inertia", [0.0])
        self.is_chain = len(self.inertia) > 1
        self.full = max(int(n(f"cylinder_{full + 1}.station")) - 1, 0)
        size = len(self.inertia)
        self.driven = (int(n("crankshaft.drive_station")) or size) - 1

        def listed(key: str, wanted: int) -> list[float]:
            found = case.get(f"crankshaft.{key}", [0.0])
            return found * wanted if len(found) == 1 else found
        self.stiffness, self.drag, self.still = listed("stiffness", size - 1), listed("absolute_damping", size), n("crankshaft.absolute_damping_speed")
        frequency = n("crankshaft.loss_frequency")
        self.damping = [c + (e * k / frequency if frequency else 0.0) for c, e, k in zip(listed("damping", size - 1), listed("loss_factor", size - 1), self.stiffness)]
        self.rings = [k + 1 for k in range(4) if f"damper_{k + 1}.station" in case]
        self.ring_station = {k: int(n(f"damper_{k}.station")) - 1 for k in self.rings}
        self.ring_inertia = {k: n(f"damper_{k}.inertia") for k in self.rings}
        self.ring_stiffness = {k: n(f"damper_{k}.stiffness") * (run.text(f"damper_{k}.kind") == "rubber") for k in self.rings}
        self.others, self.scale = [], n(f"cylinder_{full + 1}.pressure_scale", 1.0)
        self.has_gas = case.get(f"cylinder_{full + 1}.gas", [True])[0]
        down = math.radians(n("mechanism.gravity_angle_deg"))
        for k, name in enumerate(names):
            if k == full:
                continue
            bank = math.radians(n(f"{name}.bank_deg") - n(f"{names[full]}.bank_deg"))
            shift = math.radians(n(f"{name}.phase_deg") - n(f"{names[full]}.phase_deg")) - bank
            g = n("mechanism.gravity")
            self.others.append(Other(k + 1, max(int(n(f"{name}.station")) - 1, 0), shift, (-g * math.cos(down - bank), -g * math.sin(down - bank)),
                                     (n("mechanism.crank_length"), n("mechanism.rod_length")), (n(f"{name}.crank_mass"), n(f"{name}.rod_mass"), n(f"{name}.piston_mass")),
                                     (n(f"{name}.crank_inertia"), n(f"{name}.rod_inertia")), (case[f"{name}.crank_com"], case[f"{name}.rod_com"]), n("mechanism.axis_offset")))

    @staticmethod
    def is_in(run: Run) -> bool:
        return "cylinder_1.station" in run.case or len(run.case.get("crankshaft.inertia", [])) > 1

    def requested(self) -> list[str]:
        """Names of the columns on request that are needed."""
        speeds = [f"station_{j + 1}_speed" for j in range(len(self.inertia)) if self.is_chain and j != self.full]
        return speeds + [f"cylinder_{other.number}_gas_force" for other in self.others]

    def twist(self, get: dict[str, float], j: int) -> float:
        return get.get(f"station_{j + 1}_twist", 0.0)

    def speed(self, get: dict[str, float], j: int) -> float:
        return get.get(f"station_{j + 1}_speed", get["crank_speed"])

    def torques(self, get: dict[str, float], j: int, damping: float) -> list[float]:
        """Torques on a station [N m], without inertia and, at that of the mechanism, without its crank."""
        speed = self.speed(get, j)
        found = [-self.drag[j] * (speed - self.still)]
        if j == self.driven:
            found += [get["crank_moment"], -damping * speed]
        if self.is_chain:
            found += [get[f"segment_{j + 1}_torque"]] if j + 1 < len(self.inertia) else []
            found += [-get[f"segment_{j}_torque"]] if j else []
        found += [get[f"damper_{k}_torque"] for k in self.rings if self.ring_station[k] == j]
        for other in self.others:
            if other.station == j:
                q = get["crank_angle"] + self.twist(get, j) + other.shift
                of_inertia, of_energy, _ = other.slopes(q)
                found += [0.5 * of_inertia * speed**2, -of_energy, -get[f"cylinder_{other.number}_gas_force"] * other.energies(q)[2]]
        return found

    def rounding(self, get: dict[str, float], j: int) -> float:
        """Rounding error of the torques of the segments at a station, which are differences of its speeds and angles [N m]."""
        beside = [k for k in (j - 1, j) if 0 <= k < len(self.stiffness)] if self.is_chain else []
        return sum(INTERPOLATED * (self.stiffness[k] * abs(self.twist(get, j)) + self.damping[k] * abs(self.speed(get, j))) for k in beside)

    def moving(self, get: dict[str, float], j: int) -> float:
        """Inertia of a station with its other cylinders [kg m^2]."""
        q = get["crank_angle"] + self.twist(get, j)
        return self.inertia[j] + sum(other.energies(q + other.shift)[0] for other in self.others if other.station == j)

    def on_crank(self, get: dict[str, float], damping: float) -> list[float]:
        """Terms of the moment that the shaft has on the crank of the mechanism [N m]."""
        j = self.full
        of_inertia = sum(other.slopes(get["crank_angle"] + other.shift)[0] for other in self.others if other.station == j)
        return [*self.torques(get, j, damping), -self.moving(get, j) * get["crank_acceleration"], -of_inertia * get["crank_speed"]**2]

    def energy_terms(self, get: dict[str, float]) -> tuple[list[float], list[float]]:
        """Kinetic and potential energies [J]."""
        kinetic = [0.5 * self.moving(get, j) * self.speed(get, j)**2 for j in range(len(self.inertia))]
        kinetic += [0.5 * self.ring_inertia[k] * get[f"damper_{k}_speed"]**2 for k in self.rings]
        potential = [other.energies(get["crank_angle"] + self.twist(get, other.station) + other.shift)[1] for other in self.others]
        potential += [0.5 * k * (self.twist(get, j + 1) - self.twist(get, j))**2 for j, k in enumerate(self.stiffness)]
        return kinetic, potential + [0.5 * self.ring_stiffness[k] * get.get(f"damper_{k}_twist", 0.0)**2 for k in self.rings]

    def segment_terms(self, get: dict[str, float]) -> dict[str, list[float]]:
        """Terms of the law of each segment, which must vanish [N m]."""
        found = {}
        for j in range(len(self.inertia) - 1 if self.is_chain else 0):
            k, c = self.stiffness[j], self.damping[j]
            found[f"segment {j + 1}"] = [get[f"segment_{j + 1}_torque"], -k * self.twist(get, j + 1), k * self.twist(get, j), -c * self.speed(get, j + 1), c * self.speed(get, j)]
        return found
