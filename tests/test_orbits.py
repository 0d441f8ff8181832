#!/usr/bin/env python3
"""Periodic orbits, their multipliers and branches, against closed forms, variational equations and the program itself.

    tests/test_orbits.py PROGRAM [--all]

With --all also orbits that take longer. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import itertools
import math
import os
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts" / "python" / "src"))
os.environ.setdefault("GUDGEON_LIBRARY", str(TOP / "build" / "library" / "libgudgeon.so"))
import gudgeon
import matplotlib
import numpy as np
from assertions import Assertions
from gudgeon import _orbit, orbits
from gudgeon.orbits import Image, Shooting
from scipy.optimize import brentq

matplotlib.use("Agg")
assertions = Assertions()
check = assertions.check


def refuses(kind: type, words: str, action) -> None:
    """Check that an action raises an error whose text has these words."""
    try:
        action()
    except kind as error:
        check(words in str(error), f"{words!r} is in {str(error)!r}")
    else:
        check(False, f"{kind.__name__}: {words}")


def case_of(name: str, **sets: float | str) -> gudgeon.Case:
    return gudgeon.read(TOP / "cases" / f"{name}.nml", sets={key.replace("__", "."): value for key, value in sets.items()})


# maps with closed forms


def henon(x: np.ndarray, a: float) -> Image:
    return Image(np.array([1 - a * x[0] ** 2 + x[1], 0.3 * x[0]]))


def twice(map: Callable[[np.ndarray, float], Image]) -> Callable[[np.ndarray, float], Image]:
    return lambda x, p: map(map(x, p).x, p)


def oscillator(amplitude: float, omega: float, damping: float, stop: float, restitution: float, periods: int = 1) -> Callable[..., Image]:
    """x'' + damping x' + x = amplitude cos(omega t), with a rigid stop: the flow between impacts is exact. The map begins at t = 0."""
    decay, own = damping / 2, math.sqrt(1 - damping**2 / 4)
    force = amplitude / (1 - omega**2 + 1j * damping * omega)

    def flow(t0: float, x: float, v: float) -> Callable[[float], tuple[float, float]]:
        def forced(t: float) -> tuple[float, float]:
            now = force * np.exp(1j * omega * t)
            return now.real, (1j * omega * now).real

        a = x - forced(t0)[0]
        b = (v - forced(t0)[1] + decay * a) / own

        def at(t: float) -> tuple[float, float]:
            s, c, e = np.sin(own * (t - t0)), np.cos(own * (t - t0)), np.exp(-decay * (t - t0))
            free, rate = e * (a * c + b * s), e * ((own * b - decay * a) * c - (own * a + decay * b) * s)
            return free + forced(t)[0], rate + forced(t)[1]

        return at

    def image(state: np.ndarray, p: float = math.nan) -> Image:
        t, end, x, v, speeds = 0.0, periods * math.tau / omega, *state, []
        while True:
            at = flow(t, x, v)
            times = np.linspace(t, end, 300 * periods)
            beyond = np.flatnonzero(at(times[1:])[0] > stop)
            if not len(beyond):
                return Image(np.array(at(end)), len(speeds), {"speed": min(speeds, default=math.inf)})
            hit = beyond[0] + 1
            low = times[hit - 1] if hit > 1 else t + 1e-9
            t = brentq(lambda moment: at(moment)[0] - stop, low, times[hit], xtol=1e-15)
            speeds.append(at(t)[1])
            x, v = stop, -restitution * at(t)[1]

    image.flow = flow  # type: ignore[attr-defined]
    return image


#: x'' + 2 z x' + x = cos(omega t): z, omega, stop, restitution, periods, phase and speed of the impact, multipliers; closed forms of
#: orbits with one impact (Shaw and Holmes, J. Sound Vib. 90 (1983) 129).
IMPACTS = (
    (0.05, 2.8, 0, 0.8, 1, 2.98554359151, 0.334482131901, (-0.193234157284, -2.64630941941)),
    (0.05, 2.6, 0, 0.8, 1, 2.93471426828, 0.500672492549, (-0.509412840475 + 0.493056669813j,)),
    (0.05, 2.2, 0, 0.8, 1, 2.57873802755, 1.74263987912, (0.55663266125 + 0.413715889923j,)),
    (0.05, 1.8, 0, 0.8, 1, 0.512029448418, 2.37221720592, (0.538378052997 + 0.401958888613j,)),
    (0.1, 2, 0, 0.5, 1, 1.46985548039, 1.80324261171, (0.347724548935, 0.38355653399)),
    (0.1, 2, 0.1, 0.5, 1, 1.77717383304, 1.70150847463, (0.36360245003 + 0.0341362139827j,)),
    (0.1, 2, -0.1, 0.5, 1, 1.16253712774, 1.73600644015, (0.325379721532, 0.409896542246)),
    (0.02, 2, 0, 0.9, 1, 1.55160793853, 8.3479462612, (0.843815232119, 0.846569473068)),
    (0.05, 4.2, 0, 0.8, 2, 2.59998982563, 0.758943814489, (0.546950220155 + 0.418746821585j,)),
)  # fmt: skip


def closed_forms() -> None:
    """Orbits, multipliers and special points of maps whose own are known in closed form."""
    for z, omega, stop, restitution, periods, phase, speed, multipliers in IMPACTS:
        image = oscillator(1.0, omega, 2 * z, stop, restitution, periods)
        end = periods * math.tau / omega
        start = image.flow(phase / omega, stop, -restitution * speed)(end)  # type: ignore[attr-defined]
        found = Shooting(image, [1.0, 1.0]).find(start)
        apart = max(min(abs(one - other) for other in found.multipliers) for one in multipliers)
        check(apart < 1e-6 and abs(found.image.measures["speed"] - speed) < 1e-9, f"impacts at {omega}: {found.multipliers} {multipliers}")
        check(found.stable == (max(map(abs, multipliers)) < 1), f"impacts at {omega}: stable")
    shooting = Shooting(lambda x, p: oscillator(1.0, p, 0.1, 0.0, 0.8)(x), [1.0, 1.0], 0.05)
    first = oscillator(1.0, 2.5, 0.1, 0.0, 0.8)
    x = np.array([-0.3, 0.2])
    for _ in range(400):
        x = first(x).x
    branch, _ = shooting.follow(shooting.find(x, 2.5), (2.5, 2.8), 1)
    flips = [point for point in branch if point.kind == "flip"]
    check(len(flips) == 1 and abs(flips[0].p - 2.6588845466848356) < 1e-6, f"flip of the oscillator: {[f.p for f in flips]}")
    # doubling: brute force on the branch that leaves the flip
    two = shooting.of(lambda x, p: oscillator(1.0, p, 0.1, 0.0, 0.8, 2)(x))
    after, _ = two.follow(two.double(shooting, flips[0]), (2.6, 2.68), points=12)
    at = next(point for point in after if abs(point.p - flips[0].p) > 1e-3)
    x = at.x + [1e-3, 0]
    for _ in range(400):
        x = two.map(x, at.p).x
    check(at.stable and min(abs(x - at.x).max(), abs(two.map(at.x, at.p).x - x).max()) < 1e-7, f"twice the period of the oscillator: {x} {at.x}")

    once = Shooting(henon, [1.0, 1.0], 0.1)
    start = once.find([0.6, 0.2], 0.1)
    up, down = (once.follow(start, (-0.5, 0.6), side, 40)[0] for side in (1, -1))
    flip, fold = next(p for p in up if p.kind == "flip"), next(p for p in down if p.kind == "fold")
    check(abs(flip.p - 3 * 0.7**2 / 4) < 1e-6 and abs(fold.p + 0.7**2 / 4) < 1e-9, f"Henon: {flip.p}, {fold.p}")
    two = Shooting(twice(henon), [1.0, 1.0], 0.1)
    doubled, _ = two.follow(two.double(once, flip), (0.1, 1.2))
    second = next(point for point in doubled if point.kind == "flip")
    check(abs(second.p - 0.9125) < 1e-6, f"second flip of Henon's map: {second.p}")  # 1.3^2/4 + 0.7^2
    exchanged = Shooting(lambda x, a: Image(henon(x[::-1], a).x[::-1]), [1.0, 1.0], 0.1).find([0.2, 0.6], 0.1)
    check(abs(exchanged.multipliers - start.multipliers).max() < 1e-9 and abs(exchanged.x[::-1] - start.x).max() < 1e-9, "the order of states")
    delayed = Shooting(lambda x, a: Image(np.array([a * x[0] * (1 - x[1]), x[0]])), [1.0, 1.0], 0.1)
    found = delayed.follow(delayed.find([0.4, 0.4], 1.7), (1.5, 2.3), 1)[0]
    tori = [point for point in found if point.kind == "neimark_sacker"]
    check(len(tori) == 1 and abs(tori[0].p - 2) < 1e-6, f"delayed logistic: {[t.p for t in tori]}")
    angle = math.degrees(np.angle(next(m for m in tori[0].multipliers if m.imag > 0)))
    check(abs(angle - 60) < 1e-3, f"its angle: {angle}")
    # grazing: the one-impact orbits of this oscillator begin at a fold, see COCO's recipes, 15.2
    shooting = Shooting(lambda x, p: oscillator(p, 1.0, 0.1, 1.0, 0.8)(x), [1.0, 1.0], 0.1)
    found = shooting.find(oscillator(0.15, 1.0, 0.1, 1.0, 0.8).flow(*_impact(0.15))(math.tau), 0.15)  # type: ignore[attr-defined]
    apart = min(abs(one - (-0.560715540697 + 0.16440943014j)) for one in found.multipliers)
    check(apart < 2e-5, f"oscillator near grazing, where the map is curved: {found.multipliers}")
    edge = Shooting(lambda x, p: Image(0.5 * x + (x > 0), bool(x[0] > 0)), [1.0])
    found = edge.find([-1e-5])
    check(found.mixed and abs(found.multipliers[0] - 0.5) < 1e-9, "no difference is taken across a change of the pattern")


def _impact(amplitude: float) -> tuple[float, float, float]:
    """Time, place and speed after the impact of an orbit of COCO's oscillator, found by brute force."""
    image, x = oscillator(amplitude, 1.0, 0.1, 1.0, 0.8), np.array([0.0, 0.0])
    for _ in range(500):
        x = image(x).x
    flow = image.flow(0.0, *x)  # type: ignore[attr-defined]
    times = np.linspace(0, math.tau, 2000)
    hit = next(t for t, after in itertools.pairwise(times) if flow(after)[0] > 1)
    t = brentq(lambda moment: flow(moment)[0] - 1, hit, hit + math.tau / 1999)
    return t, 1.0, -0.8 * flow(t)[1]


# orbits of cases

#: Case, changes, impact speed held, multipliers of variational equations that no developer of this program wrote.
ORBITS = (
    ("flores/friction_100", {}, 0.0451961513600284, (-0.395569079,)),
    ("flores/dry_0100um", {"initial.crank_speed": 1000.0}, 0.3369286739642539, (-0.186731491,)),
    ("flores/dry_0100um", {"initial.crank_speed": 1400.0}, 0.1937703944808569, (-0.0200191225,)),
    ("flores/lubricated_400cP", {}, None, (1.31831949e-4, 2.46785756e-5)),
)


def one_period(program: str) -> None:
    """Orbits and multipliers; they close in the command line; neither differences nor the section matter."""
    for name, changes, held, multipliers in ORBITS:
        found = gudgeon.orbit(case_of(name).set(changes), held=held)
        for one, want in zip(found.multipliers, multipliers):
            check(abs(one - want) < 6e-6 * abs(multipliers[0]) + 4e-8, f"{name}: {found.multipliers} {multipliers}")  # 1e-12 over 1e-4
        check(found.stable and found.revolutions == 1 and found.residual < 1e-9, f"{name}: {found}")
        check(abs(found.exponent - math.log(abs(multipliers[0]))) < 2e-4, f"{name}: exponent {found.exponent}")
    orbit = gudgeon.orbit(case_of("flores/friction_100"), held=0.0451961513600284)
    check(repr(orbit) == "orbit of 1 revolution: stable, largest multiplier -0.39557 (-0.9274 a revolution); contact of piston_pin lasts, "
          "impact speed 0.0452 m/s held", repr(orbit))  # fmt: skip
    check(orbit.held == {"impact_speed": 0.0451961513600284} and orbit.units["eccentricity"] == "m" and len(orbit.events) == 0, "what it has")
    with tempfile.TemporaryDirectory() as folder:
        orbit.save(Path(folder) / "x.state.nml")
        sets = ["integrator.crank_revolutions=1", "integrator.relative_tolerance=1e-12", "output.ideal_twin=F"]
        words = [word for one in sets for word in ("-s", one)]
        subprocess.run([program, "-q", "-o", folder, *words, "--from", f"{folder}/x.state.nml", TOP / "cases/flores/friction_100.nml"], check=True)
        after = gudgeon.load(f"{folder}/friction_100").state
    for name, scale in (("eccentricity", 5e-4), ("eccentricity_rate", 5e-4 * 523.6)):
        check(np.abs(np.subtract(after[name], orbit.state[name])).max() < 1e-8 * scale, f"a saved orbit closes: {name} {after[name]} {orbit.state[name]}")
    for section in (90, 200):
        other = gudgeon.orbit(orbit._case, start=orbit, section_deg=section)
        check(abs(other.multipliers[0] - orbit.multipliers[0]) < 2e-5, f"section at {section}: {other.multipliers[0]}")
        check(abs(other.section_deg - section) < 1e-6, f"section at {other.section_deg}")
    largest = []
    for size in (1e-3, 1e-4, 1e-5):
        orbits.DIFFERENCE, before = size, orbits.DIFFERENCE
        largest.append(gudgeon.orbit(orbit._case, start=orbit).multipliers[0])
        orbits.DIFFERENCE = before
    check(abs(largest[0] - largest[1]) < 1e-5 and abs(largest[2] - largest[1]) < 2e-4, f"sizes of differences: {largest}")
    section = orbit._motion.section
    five = _orbit.Section(section.numbers, (*section.states, *section.held), (), section.modes)
    motion = _orbit.Motion(orbit._case, 1, section=five)
    shooting = Shooting(motion, [*orbit._shooting.units[:-1], 5e-4 * 523.6])
    x = np.append(orbit._point.x, orbit.held["impact_speed"])
    jacobian, _ = shooting.differences(np.append(x, 0) / shooting.units, motion(x))
    values = np.linalg.eigvals(jacobian[:, :-1])
    check(min(abs(values - 1)) < 1e-6, f"a held impact speed has the multiplier 1: {values}")


def without_loss() -> None:
    """The determinant of a part of a revolution with five impacts and no loss: the mass of the pin across the cylinder is that of the rod's
    turn, in proportion to 1/cos^2 of its angle, so that by Liouville's theorem the determinant is cos^2 at the end over cos^2 at the start."""
    sets = {"contact.law": "hertz", "integrator.crank_revolutions": 0.16, "integrator.relative_tolerance": 1e-13, "output.ideal_twin": False}
    case = case_of("flores/dry_0500um").set(sets)

    def image(x: np.ndarray) -> tuple[np.ndarray, int]:
        run = case.start_from({"eccentricity": x[:2], "eccentricity_rate": x[2:]}).run(columns="none")
        return np.array([*run.state["eccentricity"], *run.state["eccentricity_rate"]]), len(run.events)  # pyright: ignore

    scale, start = np.array([5e-4, 5e-4, 0.26, 0.26]), np.zeros(4)
    events = image(start)[1]
    pairs = [[image(start + sign * 1e-6 * scale * unit) for sign in (1, -1)] for unit in np.eye(4)]
    check(events == 10 and all(its[1] == events for pair in pairs for its in pair), f"events: {events}")
    jacobian = np.array([(plus[0] - minus[0]) / 2e-6 / scale for plus, minus in pairs])
    want = 1 - (0.05 / 0.12 * math.sin(0.16 * math.tau)) ** 2
    check(abs(np.linalg.det(jacobian) / want - 1) < 2e-3, f"determinant: {np.linalg.det(jacobian)} {want}, entries of {abs(jacobian).max()}")


def branches() -> None:
    """Flips, the branch of twice the period, and the lift-off of a contact that lasts."""
    case = case_of("flores/dry_0100um", initial__crank_speed=900.0)
    start = gudgeon.orbit(case, held=0.04014758743845336)
    check(abs(start.multipliers[0] + 0.537801681) < 1e-5, f"orbit at 900 rad/s: {start.multipliers}")
    branch = gudgeon.continuation(case, "initial.crank_speed", (900, 640), start=start, parallel=False)
    flips = branch.special[branch.special["kind"] == "flip"]["initial.crank_speed"].tolist()
    check(len(flips) == 1 and abs(flips[0] - 710.22148) < 2e-3, f"flip: {flips}")
    check("flip at initial.crank_speed = 710.22" in repr(branch) and "below it the motion of 1 revolution is unstable" in repr(branch), repr(branch))
    doubled = branch.doubled(0)
    check(doubled.revolutions == 2 and (doubled.points["revolutions"] == 2).all(), "twice the period")
    flips = doubled.special[doubled.special["kind"] == "flip"]["initial.crank_speed"].tolist()
    check(len(flips) >= 1 and abs(flips[0] - 659.23549) < 2e-3, f"flip of the doubled branch: {flips}")
    chosen = next(i for i, row in doubled.points.iterrows() if row["initial.crank_speed"] < 695 and row["stable"])
    orbit = doubled.orbit(chosen)
    pushed = {**orbit.state, "eccentricity_rate": tuple(1.001 * np.array(orbit.state["eccentricity_rate"]))}
    end = orbit._case.start_from(pushed).set({"integrator.crank_revolutions": 200.0, "integrator.relative_tolerance": 1e-10}).run().state
    apart = np.abs(np.subtract(end["eccentricity"], orbit.state["eccentricity"])).max()
    check(apart < 1e-4 * 1e-4, f"200 revolutions of brute force end on the doubled branch: {apart}")
    last = branch.orbit(len(branch.points) - 1)
    back = gudgeon.continuation(case, "initial.crank_speed", (640, 900), start=last, parallel=False, both=False)
    again = gudgeon.orbit(case, start=back.orbit(len(back.points) - 1))
    check(abs(np.subtract(again.state["eccentricity"], start.state["eccentricity"])).max() < 1e-7 * 1e-4, "a branch meets its start again")
    case = case_of("flores/dry_0100um", initial__crank_speed=1000.0)
    start = gudgeon.orbit(case, held=0.3369286739642539)
    branch = gudgeon.continuation(case, "initial.crank_speed", (1000, 900), start=start)
    place = float(branch.ended[0].split(" = ")[1].split()[0])
    check(len(branch.ended) == 1 and abs(place - 956.869) < 0.05 and "the contact of piston_pin that lasted opened" in branch.ended[0], str(branch.ended))
    family = gudgeon.continuation(case_of("flores/friction_100"), "held.impact_speed", (0.04, 0.09), parallel=False,
                                  start=gudgeon.orbit(case_of("flores/friction_100"), held=0.0642440770632365))  # fmt: skip
    near = family.points.iloc[(family.points["held.impact_speed"] - 0.08).abs().argmin()]
    want = np.interp(near["held.impact_speed"], [0.0642440770632365, 0.08], [-0.38313188, -0.37471722])
    check(abs(near["multiplier_1_re"] - want) < 1e-3, f"family over the impact speed: {near['multiplier_1_re']} {want}")


def refusals() -> None:
    """What has no orbit, or no branch, says why."""
    check_case = case_of("flores/friction_100")
    start = gudgeon.orbit(check_case)
    refuses(gudgeon.OrbitError, "does not repeat within 300 revolutions; give start=", lambda: gudgeon.orbit(case_of("flores/dry_0500um")))
    refuses(gudgeon.OrbitError, "all joints are ideal", lambda: gudgeon.orbit(case_of("flores/ideal")))
    refuses(gudgeon.OrbitError, "&wear", lambda: gudgeon.orbit(case_of("wear/worn_bore")))
    refuses(gudgeon.OrbitError, "ramp_time", lambda: gudgeon.orbit(case_of("flores/friction_100", drive__ramp_time=0.1)))
    refuses(gudgeon.OrbitError, "impact speeds that can be held: none", lambda: gudgeon.orbit(case_of("flores/lubricated_400cP"), held=0.1))
    refuses(gudgeon.OrbitError, "the gas takes more", lambda: gudgeon.orbit(case_of("sim_IV", drive__kind="constant_speed"), 1, start={}))
    refuses(gudgeon.OrbitError, "not between", lambda: gudgeon.continuation(check_case, "initial.crank_speed", (600, 700), start=start))
    refuses(gudgeon.OrbitError, "is a state", lambda: gudgeon.continuation(case_of("sim_IV"), "initial.crank_speed", (200, 300)))
    refuses(gudgeon.OrbitError, "one real number", lambda: gudgeon.continuation(check_case, "mechanism.rod_com", (0, 1), start=start))
    for key in ("integrator.end_time", "initial.crank_angle_deg", "run.periodic_tolerance"):
        refuses(gudgeon.OrbitError, "is no parameter", lambda key=key: gudgeon.continuation(check_case, key, (0.01, 1), start=start))
    refuses(gudgeon.OrbitError, "held.impact_speed", lambda: gudgeon.continuation(check_case, "held.speed", (0.01, 1), start=start))
    refuses(KeyError, "did you mean", lambda: gudgeon.continuation(check_case, "joint.clearence", (1, 2), start=start))


def longer() -> None:
    """Flights in each revolution, elastic rods and a free crank, against the exponents of the program with their errors."""
    for name, revolutions, exponent, error in (
        ("friction/lugre", 1, -0.1738, 0.018), ("elastic/dry_friction", 1, -1.803, 0.086), ("sim_IV", 2, -0.07488, 0.03),
    ):  # fmt: skip
        found = gudgeon.orbit(case_of(name))
        check(found.revolutions == revolutions and abs(found.exponent - exponent) < error, f"{name}: {found}")
    branch = gudgeon.continuation(case_of("friction/lugre"), "friction.coefficient", (0.09, 0.11), start=gudgeon.orbit(case_of("friction/lugre")))
    folds = branch.special[branch.special["kind"] == "fold"]["friction.coefficient"].tolist()
    check(len(folds) == 1 and abs(folds[0] - 0.1002803) < 2e-6, f"fold of lugre: {folds} {branch}")


def main() -> int:
    program = os.path.abspath(sys.argv[1])
    for part in (closed_forms, lambda: one_period(program), without_loss, branches, refusals, *([longer] if "--all" in sys.argv else [])):
        try:
            part()
        except Exception:
            check(False, traceback.format_exc())
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
