"""Compares a run with one of the same scene by the other method at a hundredth of its tolerance: states up to the horizon, then
statistics.

The distance that two accurate runs may have is measured, not assumed. Two further runs, also at a hundredth of the tolerance, start
with an error of one tolerance (the relative tolerance times the size of each coordinate); one of them has the same relative error
in constants of its laws, because a run makes errors all the time. Their distance from the reference at a later time shows to what
an error of one tolerance has grown: it is one grown tolerance. A run makes at most one such error in every step, so its distance is
measured in grown tolerances. Where the run is beyond the allowed distance, further ones make the error shortly before: a pin that
crept may by then vibrate on elastic walls, at a speed of which errors of the start show nothing. Where a grown tolerance is of order
one, states are not compared: the motion no longer depends on its start, and only statistics can agree.
"""
from __future__ import annotations

import dataclasses
import math
import random
from collections.abc import Callable
from pathlib import Path

from .mechanics import Bodies, Row
from .trace import Run, run_case

ROWS = 400            # number of rows at which states are compared
LIMIT = 100.0         # allowed error in grown tolerances, for each revolution begun
LATE = 3              # rows for which the run may be in another contact than its reference and is not compared
MORE = 4              # number of neighbours in addition where the state is beyond the allowed distance
HORIZON = 0.2         # states are not compared if the allowed error exceeds this part of the coordinates' sizes
FINEST = 1e-13        # smallest tolerance of a reference
MOST_EVALUATIONS = 2_000_000_000   # largest value that a case may have
SOFTER = 1e-2         # largest relative error of a crankshaft's stiffness
BLOCKS = 10           # number of revolutions for the statistics
LEAST_BLOCKS = 4      # smallest number of them beyond the horizon
STEADY = 0.7          # smallest over largest crank speed for which statistics of revolutions are meaningful
SPREAD = 5.0          # allowed difference of means in standard errors, from the scatter of many blocks
FEW = 14.0            # the same from the scatter of three runs, equally improbable by Student's distribution
SLACK = 0.02          # and in addition this part of the mean: errors of order one continue beyond the horizon


@dataclasses.dataclass
class Comparison:
    """Agreement of a run with its reference. The check fails if a share is above 1."""

    share: float = 0.0          # largest distance over the allowed distance, up to the horizon
    tolerances: float = 0.0     # largest distance in grown tolerances
    time: float = 0.0           # time of the largest distance [s]
    before: float = math.inf    # time of the last row before one beyond the allowed distance [s]
    horizon: float = 0.0        # [s]
    rows: int = 0               # number of rows that were compared
    statistics: dict[str, float] = dataclasses.field(default_factory=dict)   # shares, by name
    unjudged: str = ""          # reason why nothing could be compared
    no_statistics: str = ""     # reason why statistics could not be compared, if they should be

    @property
    def has_statistics(self) -> bool:
        return bool(self.statistics)


@dataclasses.dataclass
class Scales:
    """Sizes of the coordinates and their rates; for each joint with clearance those of its eccentricity."""

    angle: float
    speed: float
    joints: list[tuple[float, float]]


def states(run: Run) -> list[tuple[float, ...]]:
    """Crank angle and speed, and for each joint with clearance the eccentricity and its rate, at every row; for a piston with
    clearance in its bore the distance of its centre of mass from the axis, the displacement of the skirt's ends by the tilt, and
    the rates of both."""
    bodies = Bodies.of(run)
    found = []
    for i in range(len(run.times)):
        row = Row(bodies, run.columns, i)
        e = (row.get["eccentricity_x"], row.get["eccentricity_y"], *row.slip) if run.has_clearance else ()
        c = (*row.offset, *row.offset_rate) if run.has_loose_crank_pin else ()
        arm = skirt_arm(run)
        p = (row.offset_y, arm * row.tilt, row.offset_rate_y, arm * row.tilt_rate) if run.has_loose_guide else ()
        found.append((row.q, row.turn, *e, *c, *p))
    return found


def scales_of(run: Run, rows: list[tuple[float, ...]]) -> Scales:
    speed = max(max(abs(row[1]) for row in rows), 1 / max(run.times[-1], 1e-300))   # at rest, one radian in the time simulated
    found = Scales(1.0, speed, [])
    for k, (group, _) in enumerate(loose_joints(run)):
        rates = sorted(math.hypot(*row[4 + 4 * k:6 + 4 * k]) for row in rows)
        c = run.number("guide.bore_clearance" if group == "guide" else f"{group}.clearance")
        found.joints.append((c, max(c * speed, rates[len(rates) // 2])))
    return found


def loose_joints(run: Run) -> list[tuple[str, str]]:
    """Group of each joint with clearance, and the prefix of the keys of its start."""
    found = [("joint", "")] if run.has_clearance else []
    if run.has_loose_crank_pin:
        found.append(("crank_pin.joint", "crank_pin_"))
    return [*found, ("guide", "piston_")] if run.has_loose_guide else found


def skirt_arm(run: Run) -> float:
    """Half the length of the skirt [m]."""
    return (run.number("guide.skirt_top") + run.number("guide.skirt_bottom")) / 2


def distance(one: tuple[float, ...], two: tuple[float, ...], scales: Scales) -> float:
    """The largest difference of two states, relative to the size of the coordinate or to its present value, whichever is larger."""
    sizes = [scales.angle, scales.speed]
    for k, (eccentricity, rate) in enumerate(scales.joints):
        rate = max(rate, math.hypot(*two[4 + 4 * k:6 + 4 * k]))
        sizes += [eccentricity, eccentricity, rate, rate]
    return max(abs(a - b) / size for a, b, size in zip(one, two, sizes))


def contacts_before(run: Run) -> list[int]:
    """At every row, the number of contacts that have begun and of those that have ended."""
    times = [float(event["time[s]"]) for event in run.events]
    found, k = [], 0
    for t in run.times:
        while k < len(times) and times[k] <= t:
            k += 1
        found.append(k)
    return found


class Reruns:
    """Runs of one scene that are compared. `settings` are those of the judged run."""

    def __init__(self, program: Path, case: Path, settings: dict[str, str], judged: Run, limit: float, seed: int) -> None:
        self.program, self.case, self.limit = program, case, limit
        self.random = random.Random(seed)
        self.tolerance = min(judged.number("integrator.relative_tolerance"), 1e-3)
        self.span = float(judged.summary["simulated_time"])
        self.turn = abs(judged.number("initial.crank_speed"))
        self.judged = judged
        self.settings = {**settings, "output.digits": "17", "output.ideal_twin": ".false.", "integrator.revolutions": "0.0",
                         "output.start_time": "0.0", "integrator.max_evaluations": str(int(min(10 * judged.number("integrator.max_evaluations"), MOST_EVALUATIONS)))}
        film_steps = float(judged.summary.get("jacobians", "0"))
        self.other = "adams" if judged.text("integrator.method") == "radau" or (
            judged.text("integrator.method") == "auto" and not film_steps and judged.summary.get("step_limited_by") != "stability") else "radau"

    def run(self, span: float, rows: int, state: str = "", **more: str) -> Run:
        settings = {**self.settings, "integrator.end_time": repr(span), "output.interval": repr(span / rows)}
        settings.update({key.replace("__", "."): value for key, value in more.items()})
        return run_case(self.program, self.case, settings, self.limit, state)

    def reference(self, span: float, rows: int, change: dict[str, str], state: str = "") -> Run:
        return self.run(span, rows, state, integrator__method=f"'{self.other}'",
                        integrator__relative_tolerance=repr(max(self.tolerance / 100, FINEST)), **change)

    def neighbour_start(self, scales: Scales, off: float) -> dict[str, str]:
        """Settings of the start in which every integrated coordinate has an error of `off` times its size."""
        run = self.judged

        def sign() -> float:
            return self.random.choice((-1.0, 1.0)) * off
        start = {}
        if run.text("drive.kind") != "constant_speed":
            start["initial__crank_angle_deg"] = repr(run.number("initial.crank_angle_deg") + sign() * math.degrees(scales.angle))
            start["initial__crank_speed"] = repr(run.number("initial.crank_speed") + sign() * scales.speed)
        for (group, prefix), (eccentricity, rate) in zip(loose_joints(run), scales.joints):
            if group == "guide":
                for key, arm in (("piston_offset", 1.0), ("piston_tilt", skirt_arm(run))):
                    for name, size in ((key, eccentricity), (f"{key}_rate", rate)):
                        start[f"initial__{name}"] = repr(run.number(f"initial.{name}") + sign() * size / arm)
                continue
            for key, size in ((f"{prefix}eccentricity", eccentricity), (f"{prefix}eccentricity_rate", rate)):
                start[f"initial__{key}"] = ",".join(repr(value + sign() * size) for value in run.pair(f"initial.{key}"))
        return start

    def neighbour_laws(self, off: float, reference: Run) -> dict[str, str]:
        """Settings of the laws' constants with a relative error of `off`: an error that acts all the time, as that of the steps
        does. The stiffness of a crankshaft has the error that changes its twist by the angle `off`, the tolerance of an angle: the
        shaft starts without twist, so the start cannot have this error."""
        changed = {}
        twist = max(map(abs, reference.columns.get("crankshaft_twist", [0.0])))
        if twist > 0:
            stiffness = self.judged.number("crankshaft.torsional_stiffness")
            changed["crankshaft__torsional_stiffness"] = repr(stiffness * (1 + self.random.choice((-1.0, 1.0)) * min(off / twist, SOFTER)))
        for key in ("joint.clearance", "contact.youngs_modulus", "lubrication.viscosity", "mechanism.piston_mass", "mechanism.crank_inertia",
                    "guide.stiffness", "guide.coefficient", "guide.viscous"):
            if self.judged.number(key) > 0:
                changed[key.replace(".", "__")] = ",".join(repr(value * (1 + self.random.choice((-1.0, 1.0)) * off))
                                                           for value in self.judged.case[key])
        return changed

    def compare(self) -> Comparison:
        """Compare states up to the horizon; if the horizon is before the end of the run, statistics over ten revolutions too."""
        runs = self.family(self.span, ROWS, max(self.tolerance, 10 * FINEST))
        if isinstance(runs, str):
            return Comparison(unjudged=runs)
        found = compare_states(*runs, self.tolerance, self.revolutions())
        if not found.share <= 1:   # how far an error grows depends on its direction; both neighbours may have hardly grown
            found = self.compare_with_more(*runs)
        if found.horizon < self.span and self.turn > 0 and loose_joints(self.judged):
            self.compare_statistics(found)
        return found

    def family(self, span: float, rows: int, off: float) -> tuple[Run, Run, list[Run]] | str:
        """The run, its reference and two neighbours of the reference; or the reason why one of them did not reach the end."""
        again = self.run(span, rows)
        reference = self.reference(span, rows, {})
        for name, run in (("the run itself", again), (f"the reference by {self.other}", reference)):
            if run.status == 3:
                raise ValueError(f"a scene for the comparison was refused: {run.message}")
            if run.status or len(run.times) < 10:
                return f"{name}: {run.summary.get('status', run.message)[:120]}"
        scales = scales_of(reference, states(reference))
        neighbours = self.neighbours(span, rows, off, reference, scales)
        for run in neighbours:   # at the edge of what is possible a neighbour may be refused
            if run.status:
                return f"a neighbour of the reference: {run.summary.get('status', run.message)[:120]}"
        return again, reference, neighbours

    def neighbours(self, span: float, rows: int, off: float, reference: Run, scales: Scales) -> list[Run]:
        """Two runs near the reference: with errors of the start, and also of the laws' constants."""
        changes = self.neighbour_start(scales, off), {**self.neighbour_start(scales, off), **self.neighbour_laws(off, reference)}
        return [self.reference(span, rows, change) for change in changes]

    def compare_with_more(self, run: Run, reference: Run, neighbours: list[Run]) -> Comparison:
        """Compare states again, with more neighbours."""
        scales = scales_of(reference, states(reference))
        while len(neighbours) < 2 + MORE:
            neighbours = neighbours + self.neighbours(self.span, ROWS, max(self.tolerance, 10 * FINEST), reference, scales)
        neighbours = [one for one in neighbours if not one.status]
        found = compare_states(run, reference, neighbours, self.tolerance, self.revolutions())
        if found.share <= 1 or not 0 < found.before < math.inf:
            return found
        late = self.late_neighbours(reference, scales, found.before)
        return compare_states(run, reference, neighbours + late, self.tolerance, self.revolutions()) if late else found

    def late_neighbours(self, reference: Run, scales: Scales, time: float) -> list[Run]:
        """Runs near the reference that make the error of their coordinates at a time; none if the reference does not go on from there."""
        off, found = max(self.tolerance, 10 * FINEST), []
        until = self.reference(time, ROWS, {})
        kept = sum(t < time * (1 - 1e-9) for t in reference.times)
        for _ in range(MORE):
            run = self.reference(self.span, ROWS, {}, self.erroneous(until.state, scales, off))
            first = next((i for i, t in enumerate(run.times) if t > time * (1 - 1e-9)), len(run.times)) if not run.status else 0
            if run.status or kept + len(run.times) - first < len(reference.times):
                continue
            columns = {name: reference.columns[name][:kept] + column[first:] for name, column in run.columns.items()}
            events = [event for event in reference.events if float(event["time[s]"]) < time] + run.events
            found.append(dataclasses.replace(run, columns=columns, events=events))
        return found

    def erroneous(self, state: str, scales: Scales, off: float) -> str:
        """The text of a state with an error of `off` times its size in every coordinate."""
        sizes = {"crank_angle": scales.angle, "crank_speed": scales.speed}
        for (group, prefix), (size, rate) in zip(loose_joints(self.judged), scales.joints):
            for key, arm in (("offset", 1.0), ("tilt", skirt_arm(self.judged))) if group == "guide" else (("eccentricity", 1.0),):
                sizes |= {f"{prefix}{key}": size / arm, f"{prefix}{key}_rate": rate / arm}
        lines = []
        for line in state.split("&so_far")[0].splitlines():
            name, _, rest = line.strip().partition(" = ")
            values, mark, words = rest.partition("!")
            if name in sizes:
                rest = ", ".join(repr(float(one) + self.random.choice((-1.0, 1.0)) * off * sizes[name]) for one in values.split(","))
                line = f"  {name} = {rest}   {mark}{words}"
            lines.append(line)
        return "\n".join(lines) + "\n&so_far" + "&so_far".join(state.split("&so_far")[1:])

    def revolutions(self) -> float:
        travel = self.judged.columns["crank_angle"]
        return max(1.0, abs(travel[-1] - travel[0]) / (2 * math.pi))

    def compare_statistics(self, found: Comparison) -> None:
        block = 2 * math.pi / self.turn
        first = min(math.ceil(found.horizon / block), BLOCKS)
        if BLOCKS - first < LEAST_BLOCKS:
            return
        # the neighbours start with so large an error that they become independent of their start as early as the run
        runs = self.family(BLOCKS * block, 720 * BLOCKS, LIMIT * max(self.tolerance, 10 * FINEST))
        if isinstance(runs, str):
            found.no_statistics = runs
            return
        run, reference, neighbours = runs
        late = [abs(turn) for turn, t in zip(reference.columns["crank_speed"], reference.times) if t >= first * block]
        if not late:   # `until = 'periodic'`: the run may have settled or stopped before
            found.no_statistics = "the reference ends before these revolutions"
            return
        if min(late) < STEADY * max(late):
            found.no_statistics = "the crank speed is not steady"
            return
        for name, figure in FIGURES.items():
            by_run = [[figure(one, k * block, (k + 1) * block) for k in range(first, BLOCKS)] for one in (run, reference, *neighbours)]
            # the energy itself is accurate to the tolerance only
            known = LIMIT * self.tolerance * max(map(abs, reference.columns["energy"])) if figure is loss else 0.0
            found.statistics[name] = mean_share(by_run[0], by_run[1:], known)


def compare_states(run: Run, reference: Run, neighbours: list[Run], tolerance: float, revolutions: float) -> Comparison:
    """The largest distance of a run from its reference, over the allowed distance, up to the horizon."""
    count = min(map(len, (run.times, reference.times, *(one.times for one in neighbours))))
    ours, theirs = states(run), states(reference)
    others = [states(one) for one in neighbours]
    events = [contacts_before(one) for one in (run, reference, *neighbours)]
    scales = scales_of(reference, theirs)
    found = Comparison(horizon=run.times[-1])
    grown = max(tolerance, 10 * FINEST)
    late, last = 0, 0
    for i in range(count):
        late = late + 1 if events[0][i] != events[1][i] else 0
        if len({number[i] for number in events[1:]}) > 1 or 0 < late <= LATE:
            continue   # one run is already in a contact that another has not reached
        grown = max(grown, *(distance(theirs[i], one[i], scales) for one in others))
        allowed = LIMIT * revolutions * grown
        if allowed > HORIZON:
            found.horizon = run.times[i]
            break
        found.rows += 1
        last = i
        apart = distance(ours[i], theirs[i], scales)
        if apart > allowed:
            found.before = min(found.before, run.times[max(i - 1, 0)])
        if not apart / allowed <= found.share:
            found.share, found.tolerances, found.time = apart / allowed, apart / grown, run.times[i]
    else:
        if last < count - 1 - LATE:   # after that row the runs have different contacts
            found.horizon = run.times[last]
    return found


def window(run: Run, low: float, high: float) -> range:
    times = run.times
    first = next((i for i, t in enumerate(times) if t >= low), len(times))
    last = next((i for i in range(first, len(times)) if times[i] >= high), len(times))
    return range(first, last)


def contact_share(run: Run, low: float, high: float) -> float:
    rows = window(run, low, high)
    return sum(run.columns[name][i] == 2 for name in ("phase", "crank_pin_phase") if name in run.columns for i in rows) / max(len(rows), 1)


def mean_pin_force(run: Run, low: float, high: float) -> float:
    """Logarithm of the mean pin force: a few hard impacts dominate the force, and means of values of such different size are
    uncertain."""
    rows = window(run, low, high)
    mean = sum(math.hypot(run.columns["pin_force_x"][i], run.columns["pin_force_y"][i]) for i in rows) / max(len(rows), 1)
    return math.log(max(mean, 1e-300))


def impacts(run: Run, low: float, high: float) -> float:
    return sum(event["event"] == "contact_begins" and low <= float(event["time[s]"]) < high for event in run.events)


def loss(run: Run, low: float, high: float) -> float:
    """Energy that the joint takes from the bodies [J]: the work of drive, damping and gas minus the increase of the energy."""
    rows = window(run, low, high)
    if len(rows) < 2:
        return 0.0
    damping, columns, work = run.number("drive.damping"), run.columns, 0.0
    gas = columns.get("gas_force") or [0.0] * len(run.times)

    def power(i: int) -> float:
        turn = columns.get("flywheel_speed", columns["crank_speed"])[i]
        return columns["crank_moment"][i] * turn - damping * turn**2 - gas[i] * columns["piston_velocity"][i]
    for i in rows[1:]:
        work += 0.5 * (power(i) + power(i - 1)) * (run.times[i] - run.times[i - 1])
    return work - (columns["energy"][rows[-1]] - columns["energy"][rows[0]])


FIGURES: dict[str, Callable[[Run, float, float], float]] = {
    "contact share": contact_share, "mean pin force": mean_pin_force, "impacts per revolution": impacts, "loss per revolution": loss}


def mean_share(ours: list[float], theirs: list[list[float]], known: float) -> float:
    """The difference of the means over the difference that chance allows, from the scatter of the references' blocks plus
    `known`."""
    blocks, n = len(ours), len(theirs)
    means = [sum(one[k] for one in theirs) / n for k in range(blocks)]
    mean = sum(means) / blocks
    by_block = sum((one[k] - means[k])**2 for one in theirs for k in range(blocks)) / ((n - 1) * blocks * blocks)
    by_run = sum((sum(one) / blocks - mean)**2 for one in theirs) / (n - 1)   # larger than by blocks if the blocks are correlated
    chance = max(SPREAD * math.sqrt(by_block), FEW * math.sqrt(by_run)) * math.sqrt(1 + 1 / n)
    allowed = chance + SLACK * max(abs(value) for value in means) + known
    apart = abs(sum(ours) / blocks - mean)
    return apart / allowed if allowed > 0 else (0.0 if apart == 0 else math.inf)
