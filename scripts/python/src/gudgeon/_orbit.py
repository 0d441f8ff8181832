"""Periodic orbits of a case, their stability, and branches of them over a parameter."""

from __future__ import annotations

import ctypes
import math
import os
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._keys import groups, keys
from ._library import State, library, states_of_case
from .case import Case, CaseError, _find
from .orbits import DIFFERENCE, Image, Lost, Point, Shooting
from .run import Run, _Owner, advance, summary_of

if TYPE_CHECKING:
    import pandas as pd

#: Revolutions in which a motion must settle, the tolerance of that run, and of the runs from section to section.
MOST_REVOLUTIONS, SETTLING, TOLERANCE = 300, 1e-8, 1e-12
#: Residual up to which a divisor of the period is examined, and the share of the clearance that a pin must be away from its wall.
NEARLY, AWAY = 1e-2, 10 * DIFFERENCE
#: Multipliers below this share of the largest are rounding: of a motion with contacts, and of one without.
NOISE, NOISE_OF_FILMS = 1e-6, 1e-8
#: Parameters that are no smooth functions of the motion, or that would change its section.
NO_PARAMETERS = ("case", "run", "integrator", "output", "initial")


class LiftOff(Lost):
    """A contact that lasted, and whose impact speed was held, opens."""

    kind = "lift_off"


class OrbitError(RuntimeError):
    """There is no orbit, or a case has none."""


@dataclass(frozen=True)
class Section:
    """Where an orbit is cut: a state of the case as numbers, which of them are states of the map, and which impact speeds are held."""

    numbers: tuple[State, ...]
    states: tuple[int, ...]
    held: tuple[int, ...]
    modes: tuple[int, ...]

    @cached_property
    def names(self) -> list[str]:
        """Names of the states; of several numbers with one name x and y, or 1, 2, ..."""
        all_names = [number.name for number in self.numbers]
        found = []
        for i in self.states:
            if all_names[i] == "guide_impact_speed":
                found.append(_corner_or(self.numbers, i) + "impact_speed")
                continue
            name, count = all_names[i], all_names.count(all_names[i])
            ends = ("_x", "_y") if "eccentricity" in name else [f"_{k + 1}" for k in range(count)]
            found.append(name + (ends[i - all_names.index(name)] if count > 1 else ""))
        return found

    @property
    def values(self) -> np.ndarray:
        return np.array([self.numbers[i].value for i in self.states])

    def names_held(self) -> list[str]:
        return [_corner_or(self.numbers, i) + "impact_speed" for i in self.held]

    def with_values(self, values: Mapping[int, float]) -> Section:
        """The same section at another state."""
        return replace(self, numbers=tuple(n._replace(value=float(values.get(i, n.value))) for i, n in enumerate(self.numbers)))


def _corner_or(numbers: tuple[State, ...], i: int) -> str:
    """Prefix of the joint, or of the corner of the skirt, to which an impact speed belongs."""
    name = numbers[i].name
    if name != "guide_impact_speed":
        return name.removesuffix("impact_speed")
    return f"guide_{i - [number.name for number in numbers].index(name) + 1}_"


def _place(prefix: str) -> str:
    """The joint of a prefix, as events have it."""
    return prefix[:-1] or "piston_pin"


class Motion:
    """The map of a case: its states after so many revolutions from the section, over those before and a parameter. Threads may call it
    at once: each has copies of the case of its own."""

    def __init__(self, case: Case, revolutions: int, key: str | None = None, section: Section | None = None) -> None:
        self.case, self.revolutions, self.key = _whole(case, revolutions), revolutions, key
        self.section = section or _section(self.case)
        self._own = threading.local()

    def __call__(self, x: np.ndarray, p: float = math.nan) -> Image:
        section, own = self.section, self._own
        if not hasattr(own, "case"):
            own.case, own.probe, own.p = self.case.copy(), self.case.copy(), None
        if self.key is not None and p != own.p:
            self._set(own, p)
        for i, value in zip(section.states, x):
            library().state_set(own.case._handle, i, value)
        try:
            owner = _Owner(own.case._begin(False, None, True))
        except CaseError as error:
            raise Lost(str(error).splitlines()[0]) from None
        if advance(owner.number, 1e300, None, None) == 4:
            raise Lost(summary_of(owner.number, {"status"})["status"])
        library().case_start(own.probe._handle, owner.number)
        events = [event for event in _events(owner.number) if event[0] > 0]
        for place in (_place(prefix) for prefix in map(lambda i: _corner_or(section.numbers, i), section.held)):
            if any(event[2] == place for event in events):
                raise LiftOff(f"the contact of {place} that lasted opened")
        modes = tuple(_value(own.probe, i) for i in section.modes)
        if modes != tuple(section.numbers[i].value for i in section.modes):
            raise Lost("a contact begins or ends at the section: give another section_deg")
        begins, ends = [e[1] for e in events if not e[3]], [e[4] for e in events if e[3]]
        measures = {
            "period": library().run_time(owner.number), "contacts": len(begins), "least_impact_speed": min(begins, default=math.nan),
            "least_depth": min(ends, default=math.nan),
        }  # fmt: skip
        return Image(np.array([_value(own.probe, i) for i in section.states]), tuple((e[2], e[3]) for e in events), measures)

    def _set(self, own: Any, p: float) -> None:
        """Set the parameter, and what a start has of the case."""
        assert self.key is not None
        if self.key.startswith("held."):
            library().state_set(own.case._handle, self._held(self.key), p)
        else:
            own.case[self.key] = float(p)
            try:
                self._start(own.case)
            except CaseError as error:
                raise Lost(str(error).splitlines()[0]) from None
        own.p = p

    def _start(self, case: Case) -> None:
        """Start a case from the section, but with its own clearances and prescribed speed."""
        library().case_start(case._handle, None)
        begun = _Owner(case._begin(False, None, True))
        library().case_start(case._handle, begun.number)
        if library().states(case._handle) != len(self.section.numbers):
            raise Lost("the case has other states there")
        for i, number in enumerate(self.section.numbers):
            if not (number.name.endswith("clearance") or number.name == "crank_speed" and i not in self.section.states):
                library().state_set(case._handle, i, number.value)

    def _held(self, key: str) -> int:
        return self.section.held[[f"held.{name}" for name in self.section.names_held()].index(key)]

    def at(self, x: np.ndarray, p: float = math.nan) -> Case:
        """The case with its start at a point of the map."""
        case = self.case.copy()
        if self.key is not None and not self.key.startswith("held."):
            case[self.key] = float(p)
            self._start(case)
        elif self.key is not None:
            library().state_set(case._handle, self._held(self.key), p)
        for i, value in zip(self.section.states, x):
            library().state_set(case._handle, i, value)
        return case

    def scale(self) -> np.ndarray:
        """Natural sizes: clearance and clearance times crank speed of a pin, and of a piston in its bore, whose tilt is the clearance over
        the length of the skirt; the crank speed; else half of the range in one period."""
        of = {number.name: abs(number.value) for number in self.section.numbers}
        speed, found, swings = of["crank_speed"], [], None
        for k, i in enumerate(self.section.states):
            name = self.section.numbers[i].name
            clearance = of.get(name.partition("eccentricity")[0].removesuffix("carried_") + "clearance", math.nan)
            if "eccentricity" in name:
                found.append(clearance * (speed if name.endswith("rate") else 1))
            elif name.startswith(("piston_offset", "piston_tilt")):
                length = self.case["guide.skirt_top"] + self.case["guide.skirt_bottom"] if "tilt" in name else 1
                found.append(of["bore_clearance"] / length * (speed if name.endswith("rate") else 1))
            elif name in ("crank_speed", "pin_speed"):
                found.append(speed)
            elif name.endswith("impact_speed"):
                found.append(of[_clearance_beside(name)] * speed)
            else:
                swings = self._swings() if swings is None else swings
                found.append(swings[k] or (1e-5 if self.section.numbers[i].unit == "m" else 1e-3))
        return np.array(found)

    def _swings(self) -> np.ndarray:
        """Half of the range of each state in one period."""
        owner, probe = _Owner(_whole(self.case, self.revolutions)._begin(False, None, True)), self.case.copy()
        found, end = [self.section.values], self(self.section.values).measures["period"]
        for part in range(1, 9):
            advance(owner.number, end * part / 8, None, None)
            library().case_start(probe._handle, owner.number)
            found.append(np.array([_value(probe, i) for i in self.section.states]))
        return np.ptp(np.array(found), axis=0) / 2


def _clearance_beside(name: str) -> str:
    return "bore_clearance" if name.startswith("guide") else name.removesuffix("impact_speed") + "clearance"


def _whole(case: Case, revolutions: float) -> Case:
    return case.set({"integrator.crank_revolutions": float(revolutions)})


def _value(case: Case, i: int) -> float:
    value, kind = ctypes.c_double(), ctypes.c_int()
    library().state(case._handle, i, value, None, 0, None, 0, None, 0, kind)
    return value.value


def _events(number: int) -> list[tuple[float, float, str, bool, float]]:
    """Time, normal speed, place, whether the contact ends, and its largest penetration."""
    values, ends, place, found = (ctypes.c_double * 6)(), ctypes.c_int(), ctypes.create_string_buffer(20), []
    for i in range(library().events(number)):
        library().event(number, i, values, ends, place, 20)
        found.append((values[0], values[2], place.value.decode(), bool(ends.value), values[4]))
    return found


def _started(case: Case, section: Section) -> Case:
    """A copy of a case that starts from the state of a section."""
    case = case.copy()
    for i, number in enumerate(section.numbers):
        library().state_set(case._handle, i, number.value)
    return case


def _remembers(case: Case, prefix: str) -> bool:
    """Whether the contact law of a joint, or of the skirt, damps by the speed at which a contact began."""
    if prefix.startswith("guide"):
        group, law = "guide", "contact_law"
    else:
        group, law = f"{_place(prefix)}.contact", "law"
        group = group if group in groups() and group in case else "contact"
    laws = keys[f"{group}.dissipation"].laws
    return case[f"{group}.{law}"] in laws and not case[f"{group}.dissipation"] > 0 and case[f"{group}.restitution"] < 1


def _section(case: Case) -> Section:
    """The section at the start of a case, by one run of the map from there."""
    numbers = tuple(states_of_case(case._handle))
    of = {number.name: number.value for number in numbers if number.kind < 2}
    owner = _Owner(case._begin(False, None, True))
    if advance(owner.number, 1e300, None, None) == 4:
        raise OrbitError(f"no orbit: {summary_of(owner.number, {'status'})['status']}")
    places = {event[2] for event in _events(owner.number) if event[0] > 0}
    states, held, modes = [], [], []
    for i, number in enumerate(numbers):
        name = number.name
        if number.kind == 1:
            modes.append(i)
        elif number.kind == 0 and name.endswith("impact_speed"):
            prefix = _corner_or(numbers, i)
            touches = of[prefix + "contact"] == 1 if name.startswith("guide") else of[prefix + "phase"] == 2
            if touches and _remembers(case, prefix):
                (states if _place(prefix) in places else held).append(i)
        elif not (number.kind == 2 or name in ("crank_angle", "pin_angle") or name.endswith("clearance")):
            if name != "crank_speed" or case["drive.kind"] != "constant_speed":
                states.append(i)
    if not states:
        raise OrbitError("no orbit: the case has no states beside the crank: all joints are ideal, and all bodies rigid")
    return Section(numbers, tuple(states), tuple(held), tuple(modes))


def _fits(case: Case) -> bool:
    """Whether no pin is so near its wall that a difference of its place opens or closes a contact, and no surfaces stick."""
    start = case.start
    for name, value in start.items():
        if name.endswith("eccentricity") and isinstance(value, tuple):
            clearance = start[name.removesuffix("eccentricity").removesuffix("carried_") + "clearance"]
            assert isinstance(clearance, float)
            if abs(math.hypot(*value) - clearance) < AWAY * clearance:
                return False
        if name.endswith("sliding") and value == 0 and start[name.removesuffix("sliding") + "phase"] == 2:
            return False
    return True


def _prepared(case: Case) -> Case:
    """The case as runs from section to section need it."""
    if any(group.endswith("wear") and group in case for group in groups()):
        raise OrbitError("no orbit: &wear changes the bore from revolution to revolution")
    if case["drive.ramp_time"] > 0:
        raise OrbitError("no orbit: drive.ramp_time prescribes the speed over time")
    case = case.copy()
    for group in [group for group in groups() if group.endswith(("film_history", "supply", "bore", "shape")) and group in case]:
        case.remove(group)
    for group in [group for group in groups() if group.endswith("lubrication") and group in case]:
        if case[f"{group}.cavitation"] == "mass_conserving":  # of that film; during a run it is as reynolds
            case[f"{group}.cavitation"] = "reynolds"
    case.remove("run")
    case.add("output", columns="none", ideal_twin=False, answers=False, film_times="")
    case.add("integrator", method="auto", relative_tolerance=TOLERANCE, absolute_tolerance=None)
    for name in ("end_time", "revolutions"):
        case[f"integrator.{name}"] = None
    return _whole(case, 1)


def _settled(case: Case) -> tuple[Case, int]:
    """The case with the motion to which it settles as its start, and the period of the motion [revolutions]; 0: it does not repeat."""
    it = case.copy()
    it["integrator.relative_tolerance"] = SETTLING
    it["integrator.crank_revolutions"] = None
    it.add("run", until="periodic", most_revolutions=MOST_REVOLUTIONS)
    owner = _Owner(it._begin(False, None, True))
    advance(owner.number, 1e300, None, None)
    summary = summary_of(owner.number, {"status", "period_revolutions"})
    new = case.copy()
    library().case_start(new._handle, owner.number)
    if summary["status"] != "done":
        raise OrbitError(f"no orbit: {summary['status']}")
    return new, summary.get("period_revolutions", 0)


def _repeats(case: Case, revolutions: int) -> bool:
    """Whether so many revolutions are whole cycles of the gas: those that the angle of a start is reduced by."""
    def begun(turns: int) -> float:
        turned = case.start_from({"crank_angle": 1 + turns * math.tau})
        owner = _Owner(turned._begin(False, None, True))
        library().case_start(turned._handle, owner.number)
        return float(turned.start["crank_angle"])  # pyright: ignore

    return abs(begun(0) - begun(revolutions)) < 1e-6


def _turned(case: Case, revolutions: float) -> Case:
    """The case with the state as its start that it reaches after a part of a revolution."""
    if not revolutions:
        return case
    owner, new = _Owner(_whole(case, revolutions)._begin(False, None, True)), case.copy()
    advance(owner.number, 1e300, None, None)
    library().case_start(new._handle, owner.number)
    return new


class Orbit:
    """A periodic motion, by its state at a section; made by `gudgeon.orbit` and `Branch.orbit`."""

    def __init__(self, motion: Motion, shooting: Shooting, point: Point, is_moved: bool = False) -> None:
        self._motion, self._shooting, self._point, self._is_moved = motion, shooting, point, is_moved
        self._case = motion.at(point.x, point.p)
        #: Residual of the state after one period, in units of the natural sizes.
        self.residual = point.residual
        self.revolutions = motion.revolutions
        #: Duration of one period [s].
        self.period = float(point.image.measures["period"])

    @property
    def multipliers(self) -> np.ndarray:
        """Floquet multipliers of one period, the largest first; those that are lost in rounding are 0."""
        return _without_noise(self._point, self._touches)

    @property
    def _touches(self) -> bool:
        return bool(self._point.image.pattern) or any("phase" in name and value == 2 for name, value in self.state.items())

    @property
    def stable(self) -> bool:
        return self._point.stable

    @property
    def exponent(self) -> float:
        """Largest exponent [1/revolution]: the logarithm of the size of the largest multiplier, over the revolutions of the period."""
        return math.log(abs(self.multipliers[0])) / self.revolutions

    @property
    def state(self) -> dict[str, float | tuple[float, ...]]:
        """The motion at the section, as `Run.state`."""
        return self._case.start

    @property
    def units(self) -> dict[str, str]:
        return {number.name: number.unit for number in self._motion.section.numbers}

    @property
    def section_deg(self) -> float:
        """Crank angle of the section [degrees]."""
        angle = math.degrees(float(self.state["crank_angle"]))  # pyright: ignore
        return round(angle, 9) % (360 if _repeats(self._case, 1) else 720)

    @property
    def held(self) -> dict[str, float]:
        """Impact speeds of contacts that last for the whole period, which are parameters of the motion [m/s]."""
        section = self._motion.section
        return {name: _value(self._case, i) for name, i in zip(section.names_held(), section.held)}

    @cached_property
    def edge_distance(self) -> float:
        """How small a change of one state leads to another sequence of contacts, in units of the natural sizes (of a pin its clearance);
        infinite: more than 3e-4."""
        return self._shooting.edge_distance(self._point)

    @property
    def events(self) -> pd.DataFrame:
        """Beginnings and ends of contacts in one period."""
        events = self.run(columns="none").events
        return events.query("time > 0").reset_index(drop=True)

    def run(self, columns: str = "standard") -> Run:
        """A run of one period, with its rows."""
        return _whole(self._case, self.revolutions).set({"output.columns": columns}).run()

    def save(self, path: str | Path) -> None:
        """Write the state to a file from which other runs start: `gudgeon --from PATH CASE.nml`."""
        lines = [f"! orbit of {_revolutions(self.revolutions)} at crank angle {self.section_deg:.6g} degrees", "&initial"]
        for name, value in self.state.items():
            lines.append(f"  {name} = {', '.join(map(repr, value)) if isinstance(value, tuple) else repr(value)}")
        Path(path).write_text("\n".join([*lines, "/", ""]))

    def __repr__(self) -> str:
        largest = complex(self.multipliers[0])
        size = f"{largest.real:.5g} ± {abs(largest.imag):.5g}i" if largest.imag else f"{largest.real:.5g}"
        text = f"orbit of {_revolutions(self.revolutions)}: {'stable' if self.stable else 'unstable'}, largest multiplier {size} ({self.exponent:.4f} a revolution)"
        for name, value in self.held.items():
            text += f"; contact of {_place(name.removesuffix('impact_speed'))} lasts, impact speed {value:.4g} m/s held"
        if self._is_moved:
            text += f"; section moved to {self.section_deg:.4g} degrees, away from the beginning or end of a contact"
        if self.edge_distance < math.inf:
            text += f"; edge: a push of {self.edge_distance:.0e} of the clearance leads to another motion"
        return text


def _revolutions(count: int) -> str:
    return f"{count} revolution{'s' if count > 1 else ''}"


def _without_noise(point: Point, touches: bool) -> np.ndarray:
    found = point.multipliers
    found[abs(found) < (NOISE if touches else NOISE_OF_FILMS) * abs(found[0])] = 0
    return found if np.imag(found).any() else np.real(found)


def orbit(
    case: Case, revolutions: int | None = None, *, section_deg: float | None = None,
    start: Orbit | Run | Mapping[str, Any] | None = None, held: float | Mapping[str, float] | None = None,
) -> Orbit:  # fmt: skip
    """A periodic orbit of a case, with its Floquet multipliers.

    revolutions: of one period, a multiple of the gas cycle; None: that of `start`, or of the motion to which the case settles. section_deg:
    crank angle of the section (default: that of the start), which is moved by sevenths of a revolution where a pin is too near its wall.
    start: an orbit, a run or a state near it; None: the case settles first. held: impact speeds to be held of contacts that last for the whole
    period. Raises OrbitError.

    >>> gudgeon.orbit(gudgeon.template("film").set({"drive.kind": "constant_speed"})).stable
    True
    """
    case = _prepared(case)
    if start is None:
        case, period = _settled(case)
        if not (period or revolutions):
            raise OrbitError(f"no orbit: the motion of the case does not repeat within {MOST_REVOLUTIONS} revolutions; give start= or "
                             "revolutions=, or follow a branch from a parameter where it does")  # fmt: skip
        periods = [revolutions] if revolutions else [k for k in range(1, period + 1) if period % k == 0 and _repeats(case, k)]
    else:
        case = case.start_from(start.state if isinstance(start, Orbit) else start)
        periods = [revolutions or (start.revolutions if isinstance(start, Orbit) else 1)]
    if not _repeats(case, periods[-1]):
        raise OrbitError(f"no orbit of {_revolutions(periods[-1])}: the gas takes more to repeat")
    angle = math.degrees(float(case.start["crank_angle"]))  # pyright: ignore
    case = _turned(case, 0.0 if section_deg is None else (section_deg - angle) / 360 % 1)
    is_moved = not _fits(case)
    for _ in range(7):
        if _fits(case):
            break
        case = _turned(case, 1 / 7)
    else:
        raise OrbitError("no orbit: the surfaces stick at every section, or a pin is too near its wall")
    why = Lost("")
    for k in periods:
        try:
            motion = Motion(case, k)
            if held is not None:
                motion = _holding(motion, held)
            shooting = Shooting(motion, motion.scale())
            x = motion.section.values
            if k < periods[-1] and abs((motion(x).x - x) / shooting.units[:-1]).max() > NEARLY:
                continue
            point = shooting.find(x)
        except Lost as error:
            why = error
            continue
        if point.stable or k == periods[-1]:
            return Orbit(motion, shooting, point, is_moved)
    raise OrbitError(f"no orbit: {why}")


def _holding(motion: Motion, held: float | Mapping[str, float]) -> Motion:
    """The map with other impact speeds held."""
    names = motion.section.names_held()
    wanted = held if isinstance(held, Mapping) else dict.fromkeys(names, held)
    if not wanted or any(name not in names for name in wanted):
        raise OrbitError(f"no orbit: impact speeds that can be held: {', '.join(names) or 'none, since no contact lasts for the whole period'}")
    values = {i: wanted[name] for name, i in zip(names, motion.section.held) if name in wanted}
    return Motion(_started(motion.case, motion.section.with_values(values)), motion.revolutions)


class Branch:
    """Orbits over a parameter; made by `gudgeon.continuation`."""

    def __init__(
        self, motion: Motion, shooting: Shooting, limits: tuple[float, float], found: list[Point], ends: list[tuple[Point, Lost | None]],
    ) -> None:  # fmt: skip
        self._motion, self._shooting, self._limits, self._found, self._ends = motion, shooting, limits, found, ends
        #: The parameter, such as `initial.crank_speed`.
        self.key = motion.key or ""
        self.revolutions = motion.revolutions

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns of `points`."""
        section = self._motion.section
        states = {name: section.numbers[i].unit for name, i in zip(section.names, section.states)}
        speeds = {f"held_{name}": "m/s" for name in section.names_held()}
        own = {"exponent": "1/revolution", "period": "s", "least_impact_speed": "m/s", "least_depth": "m"}
        return {self.key: "m/s" if self.key.startswith("held.") else keys[self.key].unit, **states, **speeds, **own}

    @cached_property
    def points(self) -> pd.DataFrame:
        """A row for each point, special ones among them: the parameter, `kind` ('', fold, flip, neimark_sacker, grazing, lift_off, edge,
        end), `stable`, the first multipliers, the exponent, the states at the section, contacts in a period, accuracy and cost."""
        import pandas as pd

        section, rows = self._motion.section, []
        touches = any(section.numbers[i].name.endswith("phase") and section.numbers[i].value == 2 for i in section.modes)
        for point in self._found:
            multipliers = _without_noise(point, touches or bool(point.image.pattern))
            row: dict[str, Any] = {self.key: point.p, "arclength": point.arclength, "kind": point.kind, "stable": point.stable}
            for i, multiplier in enumerate(multipliers[:3]):
                row.update({f"multiplier_{i + 1}_re": multiplier.real, f"multiplier_{i + 1}_im": multiplier.imag})
            row.update(modulus=abs(multipliers[0]), exponent=math.log(abs(multipliers[0])) / self.revolutions, revolutions=self.revolutions)
            row.update(period=point.image.measures["period"], **dict(zip(section.names, point.x)))
            for name, i in zip(section.names_held(), section.held):
                row[f"held_{name}"] = point.p if self.key == f"held.{name}" else section.numbers[i].value
            row.update({name: value for name, value in point.image.measures.items() if name != "period"})
            row.update(residual=point.residual, mixed=point.mixed, runs=point.runs)
            rows.append(row)
        return pd.DataFrame(rows)

    @property
    def special(self) -> pd.DataFrame:
        """The rows of `points` that are special."""
        return self.points.query("kind != ''")

    def lines(self, column: str) -> list[np.ndarray]:
        """A column of `points`; of a state those at each passage of the section in a period."""
        found, motion = [self.points[column].to_numpy()], self._motion
        if column not in motion.section.names:
            return found
        for passed in range(1, self.revolutions):
            later, values = Motion(motion.case, passed, self.key, motion.section), []
            for point in self._found:
                try:
                    values.append(later(point.x, point.p).x[motion.section.names.index(column)])
                except Lost:
                    values.append(math.nan)
            found.append(np.array(values))
        return found

    def _unit(self, value: float) -> str:
        return f"{self.key} = {value:.6g} {self.units[self.key]}".rstrip()

    @property
    def ended(self) -> list[str]:
        """Why the branch ends, at both ends; nothing where it reaches a limit or has enough points."""
        return [f"the branch ends at {self._unit(point.p)}: {why}" for point, why in self._ends if why is not None]

    def orbit(self, i: int) -> Orbit:
        """The orbit of a row of `points`."""
        return Orbit(self._motion, self._shooting, self._found[i])

    def doubled(self, i: int = 0, limits: tuple[float, float] | None = None, points: int = 60) -> Branch:
        """The branch of twice the period that begins at a flip, by its number. Raises OrbitError."""
        flips = [point for point in self._found if point.kind == "flip"]
        if not -len(flips) <= i < len(flips):
            raise OrbitError(f"the branch has {len(flips)} flips")
        case = self._motion.at(flips[i].x, flips[i].p)
        motion = Motion(case, 2 * self.revolutions, self.key)
        shooting = self._shooting.of(motion)
        try:
            start = shooting.double(self._shooting, flips[i])
        except Lost as error:
            raise OrbitError(str(error)) from None
        limits = limits or self._limits
        found, why = shooting.follow(start, limits, points=points)
        return Branch(motion, shooting, limits, found, [(found[-1], why)])

    def plot(self, column: str = "eccentricity_y", over: pd.DataFrame | None = None, ax: Any = None) -> Any:
        """A column of `points` over the parameter: stable orbits are full lines, unstable ones dashed, special points circles. `over`: a table
        with the same columns, such as the strobes of a study, as grey points below. Returns the axes of matplotlib."""
        import matplotlib.pyplot as plt

        from .plots.branches import draw_branch

        return draw_branch(self, column, over, ax or plt.gca())

    def __repr__(self) -> str:
        lines = [f"branch of {_revolutions(self.revolutions)}: {len(self._found)} points, {self._unit(self._found[0].p)} to {self._unit(self._found[-1].p)}"]
        flips = 0
        for i, point in enumerate(self._found):
            if point.kind in ("fold", "flip", "neimark_sacker", "grazing"):
                line = f"{point.kind.replace('_', '-')} at {self._unit(point.p)}"
                after = self._found[min(i + 1, len(self._found) - 1)]
                if point.kind == "flip":
                    side = "below" if (after.p < point.p) == (not after.stable) else "above"
                    line += f": {side} it the motion of {_revolutions(self.revolutions)} is unstable; branch.doubled({flips}) goes on"
                    flips += 1
                lines.append(line)
        return "\n".join([*lines, *self.ended])


def continuation(
    case: Case, key: str, limits: tuple[float, float], *, start: Orbit | None = None, points: int = 60, both: bool = True,
    parallel: bool = True, progress: Callable[[float], None] | None = None,
) -> Branch:  # fmt: skip
    """The branch of orbits over a key of the case, or over "held.impact_speed", between limits.

    start: an orbit on it; None: that to which the case settles at the first limit. points: at most so many to each side; both: to both sides
    of the start, else towards the second limit. parallel: threads for the derivatives. progress: is told the parameter of each point.
    Raises OrbitError.
    """
    is_held = key.startswith("held.")
    if not is_held:
        _parameter(case, key)
    if start is None:
        start = orbit(case if is_held else case.set({key: limits[0]}))
    motion = Motion(start._case, start.revolutions, key)
    names = [f"held.{name}" for name in motion.section.names_held()]
    if is_held and key not in names:
        raise OrbitError(f"{key}: impact speeds that are held: {', '.join(names) or 'none, since no contact lasts for the whole period'}")
    value = start.held[key.removeprefix("held.")] if is_held else start._case[key]
    low, high = sorted(limits)
    close = 1e-9 * (high - low)
    if not low - close <= value <= high + close:
        raise OrbitError(f"the start is at {key} = {value:.6g}, which is not between {low:.6g} and {high:.6g}")
    workers = min(len(os.sched_getaffinity(0)), 2 * len(start._point.w)) if parallel else 1
    shooting = Shooting(motion, start._shooting.units[:-1], (high - low) / 10, workers)
    sides = [1, -1] if both else [1 if limits[1] > value else -1]
    found: list[Point] = []
    ends = []
    try:
        first = shooting.find(start._point.x, value)
    except Lost as error:
        raise OrbitError(f"no orbit: {error}") from None
    for side in sides:
        if abs(value - (high if side > 0 else low)) <= close:
            continue
        branch, why = shooting.follow(first, limits, side, points, progress and (lambda point: progress(point.p)))
        ends.append((branch[-1], why))
        if side < 0:
            branch = [replace(point, arclength=-point.arclength) for point in branch]
        found = [*branch[:0:-1], *found] if side < 0 and found else [*found, *branch]
    return Branch(motion, shooting, limits, found, ends)


def _parameter(case: Case, key: str) -> None:
    """Refuse a key over which there is no branch."""
    info = _find(key)
    if info.kind != "real" or info.count > 1:
        raise OrbitError(f"{key}: a branch needs a key with one real number")
    if key == "initial.crank_speed":
        if case["drive.kind"] != "constant_speed":
            raise OrbitError(f"{key}: the speed of a free crank is a state, not a parameter")
    elif key.partition(".")[0] in NO_PARAMETERS:
        raise OrbitError(f"{key}: is no parameter of the motion")
