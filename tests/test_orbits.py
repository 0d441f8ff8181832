#!/usr/bin/env python3
"""Periodic orbits, their multipliers and branches, against closed forms, variational equations and the program itself.

    tests/test_orbits.py PROGRAM [--all]

With --all also orbits that take longer. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import contextlib
import io
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
from gudgeon.cli import main as main_of_plots
from gudgeon.orbits import Image, Shooting
from scipy.optimize import brentq

matplotlib.use("Agg")
assertions = Assertions()
check, refuses = assertions.check, assertions.refuses


def case_of(name: str, **sets: float | str) -> gudgeon.Case:
    return gudgeon.read(TOP / "cases" / f"{name}.nml", sets={key.replace("__", "."): value for key, value in sets.items()})


# maps with closed forms


def henon(x: np.ndarray, a: float) -> Image:
    return Image(np.array([1 - a * x[0] ** 2 + x[1], 0.3 * x[0]]))


def twice(map: Callable[[np.ndarray, float], Image]) -> Callable[[np.ndarray, float], Image]:
    return lambda x, p: map(map(x, p).x, p)


def oscillator(amplitude: float, omega: float, damping: float, stop: float, restitution: float, periods: int = 1, looks: int = 300) -> Callable[..., Image]:
    """x'' + damping x' + x = amplitude cos(omega t), with a rigid stop: the flow between impacts is exact, and is looked at so often in
    a period. The map begins at t = 0."""
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
            times = np.linspace(t, end, looks * periods)
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

#: The same with x'' + 0.1 x' + x = A cos t, stop at 1, restitution 0.8 (Dankowicz and Schilder, Recipes for continuation, 15.2): A,
#: speed of the impact, a multiplier; closed forms; its error by a difference of 1e-6, beside which the map is curved within the square of
#: the speed. The branch turns back at a fold, and meets the motion that just reaches the stop at 0.1.
RECIPES = (
    (0.1001, 0.0127569343186, -0.181875209523 + 0.555296125017j, 4e-4), (0.101, 0.0285633058873, -0.406254576386 + 0.419987615846j, 2e-5),
    (0.105, 0.0586975841885, -0.499223460497 + 0.303658220353j, 1e-6), (0.12, 0.116960882214, -0.543120954002 + 0.21552727814j, 1e-6),
    (0.15, 0.194237250971, -0.560715540697 + 0.16440943014j, 1e-6), (0.3, 0.485000881426, -0.576680600645 + 0.0941905682014j, 1e-6),
    (1.0, 1.69573293759, -0.584295314342 + 0.00560035149247j, 1e-6),
)  # fmt: skip
RECIPES_FOLD = 0.09997075362831327


def closed_forms() -> None:
    """Orbits, multipliers and special points of maps whose own are known in closed form."""
    for z, omega, stop, restitution, periods, phase, speed, multipliers in IMPACTS:
        image = oscillator(1.0, omega, 2 * z, stop, restitution, periods)
        end = periods * math.tau / omega
        start = image.flow(phase / omega, stop, -restitution * speed)(end)  # type: ignore[attr-defined]
        found = Shooting(image, [0.3, 0.3]).find(start)
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
    # slow impacts last shorter than a 300th of a period
    shooting = Shooting(lambda x, p: oscillator(p, 1.0, 0.1, 1.0, 0.8, looks=4000 if p < 0.102 else 300)(x), [3e-3, 3e-3], 0.02)
    for amplitude, speed, multiplier, error in RECIPES:
        found = shooting.find(oscillator(amplitude, 1.0, 0.1, 1.0, 0.8).flow(*_impact(amplitude))(math.tau), amplitude)  # type: ignore[attr-defined]
        apart = min(abs(one - multiplier) for one in found.multipliers)
        check(apart < error and abs(found.image.measures["speed"] - speed) < 1e-8, f"recipes, {amplitude}: {found.multipliers} {multiplier}")
        if amplitude == 0.1001:
            branch, _ = shooting.follow(found, (0.0999, 0.12), -1, 70)
            folds = [point.p for point in branch if point.kind == "fold"]
            check(len(folds) > 0 and abs(folds[0] - RECIPES_FOLD) < 2e-7, f"recipes, fold: {len(branch)} {folds}")

    # x' = x/2 + p below 0 and -2/5 x + p above: the branch x = 2 p, then x = 5/7 p, goes on where the pattern changes, at p = 0
    kinked = Shooting(lambda x, p: Image(np.where(x < 0, 0.5, -0.4) * x + p, bool(x[0] >= 0)), [1.0], 1.0)
    branch, why = kinked.follow(kinked.find([-2.0], -1.0), (-1.0, 1.0), 1)
    grazing = [point for point in branch if point.kind == "grazing"]
    check(len(grazing) == 1 and abs(grazing[0].p) < 2 * orbits.LEAST_STEP and why is None, f"grazing: {[point.p for point in grazing]} {why}")
    check(all(abs(point.multipliers[0] - (0.5 if point.p < 0 else -0.4)) < 1e-9 for point in branch), "multipliers beside grazing")
    check(abs(branch[-1].p - 1) < 1e-9 and abs(branch[-1].x[0] - 5 / 7) < 1e-9, f"the branch goes on: {branch[-1].p} {branch[-1].x}")
    edge = Shooting(lambda x, p: Image(0.5 * x + (x > 0), bool(x[0] > 0)), [1.0])
    found = edge.find([-1e-5])
    check(found.mixed and abs(found.multipliers[0] - 0.5) < 1e-9, "no difference is taken across a change of the pattern")
    for away, distance in ((3e-5, 3.75e-5), (4e-4, math.inf)):
        shifted = Shooting(lambda x, p, away=away: Image(0.5 * x, bool(x[0] > away)), [1.0])
        found = shifted.edge_distance(shifted.find([0.0]))
        check(found == distance, f"a push of {away} leads away: {found}")  # 3e-4 halved as long as the pattern changes
    narrow = Shooting(lambda x, p: Image(0.5 * x, bool(abs(x[0]) > 1e-7)), [1.0])
    refuses(orbits.Edge, "on both sides", lambda: narrow.find([0.0]))
    closing = Shooting(lambda x, p: Image(0.5 * x, bool(abs(x[0]) > max(1e-7, 1e-4 - p))), [1.0])
    branch, why = closing.follow(closing.find([0.0], -1.0), (-1.0, 1.0), 1)
    check(branch[-1].kind == "edge" and isinstance(why, orbits.Edge) and branch[-1].p < 1e-4, f"an edge ends the branch: {branch[-1].p} {why}")


def _impact(amplitude: float) -> tuple[float, float, float]:
    """Time, place and speed after the impact of an orbit of RECIPES, found by brute force."""
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
#: The same with the impact speed of friction_100 held elsewhere: each is another motion.
FAMILY = ((0.003, -0.59289211), (0.005, -0.54801816), (0.01, -0.507294), (0.0642440770632365, -0.38313188), (0.08, -0.37471722))


def one_period(program: str) -> None:
    """Orbits and multipliers; they close in the command line; neither differences nor the section matter."""
    for name, changes, held, multipliers in ORBITS:
        found = gudgeon.orbit(case_of(name).set(changes), held=held)
        for one, want in zip(found.multipliers, multipliers):
            # integration to 1e-12 over differences of 3e-4, times some thousand steps
            check(abs(one - want) < 2e-5 * abs(multipliers[0]) + 4e-8, f"{name}: {found.multipliers} {multipliers}")
        check(found.stable and found.revolutions == 1 and found.residual < 1e-9, f"{name}: {found}")
        check(abs(found.exponent - math.log(abs(multipliers[0]))) < 2e-4, f"{name}: exponent {found.exponent}")
    orbit = gudgeon.orbit(case_of("flores/friction_100"), held=0.0451961513600284)
    for held, multiplier in FAMILY:
        found = gudgeon.orbit(orbit._case, start=orbit, held=held)
        check(abs(found.multipliers[0] - multiplier) < 2e-5, f"impact speed {held} held: {found.multipliers}")  # found to 1e-8
    slow = gudgeon.orbit(case_of("flores/dry_0100um"), held=0.016233510626227125)
    check(slow.revolutions == 2 and abs(slow.multipliers[0] + 0.957481023) < 6e-6, f"a motion that settles slowly: {slow}")
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
        check(abs(other.multipliers[0] - orbit.multipliers[0]) < 1e-5, f"section at {section}: {other.multipliers[0]}")
        check(abs(other.section_deg - section) < 1e-6, f"section at {other.section_deg}")
    largest = []
    for size in (1e-3, 1e-4, 1e-5):
        orbits.DIFFERENCE, before = size, orbits.DIFFERENCE
        largest.append(gudgeon.orbit(orbit._case, start=orbit).multipliers[0])
        orbits.DIFFERENCE = before
        # rounding and steps of the integrator: 1e-8 at most
        check(abs(largest[-1] - orbit.multipliers[0]) < 1e-5 + 1e-8 / size, f"differences of {size}: {largest[-1]} {orbit.multipliers[0]}")
    section = orbit._motion.section
    other = _orbit.Motion(orbit._case, 1, "friction.coefficient", _orbit.replace(section, numbers=section.numbers[:-1]))
    refuses(orbits.Lost, "other states", lambda: other(orbit._point.x, 0.1))
    five = _orbit.Section(section.numbers, (*section.states, *section.held), (), section.modes)
    motion = _orbit.Motion(orbit._case, 1, section=five)
    shooting = Shooting(motion, [*orbit._shooting.units[:-1], 5e-4 * 523.6])
    x = np.append(orbit._point.x, orbit.held["impact_speed"])
    jacobian, _ = shooting.differences(np.append(x, 0) / shooting.units, motion(x))
    values = np.linalg.eigvals(jacobian[:, :-1])
    check(min(abs(values - 1)) < 1e-6, f"a held impact speed has the multiplier 1: {values}")


def flights() -> None:
    """An orbit with a flight in each revolution; a section at its end is moved, which changes no multiplier."""
    orbit = gudgeon.orbit(case_of("friction/lugre"))
    check(orbit.revolutions == 1 and len(orbit.events) == 2 and "impact_speed" in orbit._motion.section.names, f"a flight: {orbit}")
    lands = math.degrees(orbit.events["crank_angle"][1])
    moved = gudgeon.orbit(orbit._case, start=orbit, section_deg=lands)
    check("section moved to" in repr(moved) and abs(moved.section_deg - lands - 360 / 7) < 1e-6, f"section at {lands}: {moved}")
    for found in (orbit, moved):
        check(abs(found.multipliers[:2] - (0.840511245, -0.696076899)).max() < 1e-5, f"multipliers: {found.multipliers}")
    stuck = case_of("friction/coulomb_static").start_from({"sliding": 0, "phase": 2, "eccentricity": (-5.04e-4, 0.0)})
    check(_orbit._fits(stuck.start_from({"sliding": -1})) and not _orbit._fits(stuck), "no section is where surfaces stick")


def skirts() -> None:
    """A piston that its weight presses to one side of the bore: both corners touch all the time. By Liouville's theorem the product of its
    multipliers is exp of the mean of minus damping over mass: of the skirt's motion across the bore that of the piston over the square
    of the cosine of the rod, whose mass is none, and of its tilt the inertia over the square of the lever."""
    restitution, mass, inertia, levers, stiffness, impact = 0.9, 0.2, 8.5e-5, (0.012, -0.028), 1e6, 1.0
    sets = {
        "mechanism.gravity": 30.0, "mechanism.gravity_angle_deg": 90.0, "mechanism.rod_mass": 1e-9, "mechanism.rod_inertia": 1e-12,
        "initial.crank_speed": 30.0, "guide.coefficient": 0.0, "guide.piston_com": (0.0, 0.0), "guide.stiffness": stiffness,
        "guide.contact_law": "lankarani_nikravesh", "guide.restitution": restitution,
    }  # fmt: skip
    case = gudgeon.template("slap")
    case.remove("combustion")
    case = case.set(sets)
    presses = [mass * 30.0 * abs(lever) / 0.04 / stiffness for lever in levers[::-1]]  # penetrations of the upper and lower corner
    tilt = (presses[1] - presses[0]) / 0.04
    start = {
        "piston_offset": -4e-5 - presses[0] - 0.012 * tilt, "piston_tilt": tilt, "guide_3_contact": 1, "guide_4_contact": 1,
        "guide_impact_speed": (0.0, 0.0, impact, impact),
    }  # fmt: skip
    orbit = gudgeon.orbit(case, 1, start=start)
    check(orbit.held == {"guide_3_impact_speed": impact, "guide_4_impact_speed": impact} and len(orbit.events) == 0, f"corners that touch: {orbit}")
    run = orbit.run()
    slope = (0.0225 / 0.084 * np.sin(run["crank_angle"])) ** 2
    rate = 0.0
    for corner, lever in zip((3, 4), levers):
        damping = 0.75 * (1 - restitution**2) * stiffness * -run[f"guide_{corner}_gap"] / impact
        rate = rate + damping * ((1 - slope) / mass + lever**2 / inertia)
    want = math.exp(-np.trapezoid(rate, run["time"]))
    product = np.prod(orbit.multipliers).real
    check(abs(product / want - 1) < 1e-3 and 0.1 < want < 0.9, f"product of the multipliers: {product} {want}")  # offsets over the rod's length
    refuses(gudgeon.OrbitError, "guide_3_impact_speed", lambda: gudgeon.orbit(case, 1, start=start, held={"guide_1_impact_speed": 1.0}))
    # corners that lift and land: the impact speed of the one that touches at the section is a state
    case = case_of("joints/piston_slap")
    for group in ("contact", "friction"):
        case.remove(group)
    case = case.set({"joint.clearance": None, "joint.bearing_radius": None, "joint.kind": "ideal", "drive.kind": "constant_speed"})
    start = {
        "piston_offset": -9.5293e-05, "piston_offset_rate": 0.037418, "piston_tilt": -4.16715e-4, "piston_tilt_rate": -2.94586,
        "guide_3_contact": 1, "guide_impact_speed": (0.01, 0.01, 0.0434875, 0.01),
    }  # fmt: skip
    orbit = gudgeon.orbit(case, 1, start=start)
    check(orbit._motion.section.names[4:] == ["guide_3_impact_speed"] and orbit.held == {}, f"states of a skirt: {orbit._motion.section.names}")
    end = orbit.run(columns="none")
    check(len(end.events) > 100 and abs(end.state["guide_impact_speed"][2] / orbit.state["guide_impact_speed"][2] - 1) < 1e-6, "it comes back")  # pyright: ignore
    for name, size in (("piston_offset", 1e-4), ("piston_tilt_rate", 1e-4 / 0.035 * 262)):
        check(abs(end.state[name] - orbit.state[name]) < 1e-8 * size, f"a skirt comes back: {name} {end.state[name]} {orbit.state[name]}")  # pyright: ignore


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
    axes = branch.plot("eccentricity_y", over=branch.points)
    drawn = {line.get_linestyle(): line.get_xdata() for line in axes.lines}
    check(drawn["-"].min() == drawn["--"].max() == flips[0], f"stable orbits are full lines, unstable ones dashed: {drawn}")
    check(list(drawn["None"]) == flips and len(axes.collections) == 1, "a flip is a circle, over the points of brute force")
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


def command(program: str) -> None:
    """gudgeon-plot branch over the strobes of a study: a table, a picture, and what it says of wrong arguments."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        case_of("flores/dry_0100um", contact__dissipation=3.55).to_nml(place / "flores.nml")
        (place / "speeds.nml").write_text("""
            &study case = 'flores.nml', settle_cycles = 1, strobe_angle_deg = 0.0, strobe_columns = 'eccentricity_y' /
            &parameter key = 'initial.crank_speed', from = 890, to = 900, count = 2 /""")
        subprocess.run([program, "sweep", "-q", "-j", "1", "-o", folder, place / "speeds.nml"], check=True)
        words = ["branch", f"{place}/flores.nml", "initial.crank_speed", "900", "890", "--points", "3", "--over", f"{place}/speeds.strobe.csv", "-o", folder]

        def run(*more: str) -> tuple[object, str]:
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                try:
                    return main_of_plots([*words, *more]), said.getvalue()
                except SystemExit as stopped:
                    return stopped.code, said.getvalue()

        status, said = run()
        rows = (place / "flores.branch.csv").read_text().splitlines()
        check(status == 0 and "orbit of 1 revolution: stable, largest multiplier -0.537" in said and len(rows) == 4, f"the command: {status} {said}")
        check(rows[0].startswith("initial.crank_speed,arclength,kind,stable,multiplier_1_re") and (place / "flores.branch.png").stat().st_size > 5000, rows[0])
        status, said = run("--column", "nothing")
        check(status == 2 and "no column nothing; there are: run, " in said, f"a column that strobes do not have: {said}")
        words[2] = "crank_speed"
        status, said = run()
        check(status == 2 and "initial.crank_speed" in said, f"a key that there is not: {said}")


def refusals() -> None:
    """What has no orbit, or no branch, says why."""
    check_case = case_of("flores/friction_100")
    start = gudgeon.orbit(check_case)
    refuses(gudgeon.OrbitError, "does not repeat within 300 revolutions; give start=", lambda: gudgeon.orbit(case_of("flores/dry_0500um")))
    refuses(gudgeon.OrbitError, "all joints are ideal", lambda: gudgeon.orbit(case_of("flores/ideal")))
    refuses(gudgeon.OrbitError, "&wear", lambda: gudgeon.orbit(case_of("wear/worn_bore")))
    refuses(gudgeon.OrbitError, "ramp_time", lambda: gudgeon.orbit(case_of("flores/friction_100", drive__ramp_time=0.1)))
    refuses(gudgeon.OrbitError, "impact speeds that can be held: none", lambda: gudgeon.orbit(case_of("flores/lubricated_400cP"), held=0.1))
    fed = _orbit._prepared(case_of("film/sim_I_fed"))
    check("film_history" not in fed and fed.check() is not None, "a film with memory is left out")
    rocks = gudgeon.template("dry").set({"drive.kind": "free", "initial.crank_speed": 5.0, "mechanism.gravity_angle_deg": 90.0})
    refuses(gudgeon.OrbitError, "the crank stopped or turned back", lambda: gudgeon.orbit(rocks))
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
    for part in (closed_forms, lambda: one_period(program), flights, skirts, without_loss, branches, lambda: command(program), refusals, *([longer] if "--all" in sys.argv else [])):
        try:
            part()
        except Exception:
            check(False, traceback.format_exc())
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
