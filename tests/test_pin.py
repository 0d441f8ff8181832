#!/usr/bin/env python3
"""The piston pin that floats or is fixed in the piston: whole runs against motions of an independent program (data/pin), closed forms,
limits, identities, the energy of combinations that no reference has, and what the program refuses.

    .venv/bin/python tests/test_pin.py [--program PATH]        (after scripts/setup.sh --python)

Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))
sys.path.insert(0, str(TOP / "tests"))

from measured import use_virtual_environment

use_virtual_environment()

import case_runner
import numpy as np
import pandas as pd
from assertions import Assertions
from case_runner import bare
from gudgeon.program import release_program

assertions = Assertions()
check = assertions.check
DATA = TOP / "data" / "pin"
FINE = ("output.digits=17", "integrator.relative_tolerance=1e-11")
STATES = ("crank_angle", "rod_angle", "piston_position", "crank_speed", "rod_speed", "piston_velocity")
PREFIX = "small_end_"


class Runner(case_runner.Runner):
    """Rows and events have names without units."""

    def __call__(self, case: str | Path, *changes: str) -> tuple[pd.DataFrame, dict[str, str]]:
        rows, summary = super().__call__(case, *changes)
        return bare(rows), summary

    def events(self, case: str | Path) -> pd.DataFrame:
        """The events of the last run."""
        return bare(pd.read_csv(self.result(case, "events.csv")))


def off(a: pd.Series, b: pd.Series) -> float:
    """Largest difference of two columns over the range of the second one."""
    return float(np.abs(a.to_numpy() - b.to_numpy()).max() / max(np.abs(b).max(), 1e-300))


# references

def references(run: Runner) -> None:
    """The references ask for 1e-6 in states, 1e-3 in other columns and 1e-8 s in events; a hundredth of that is demanded."""
    for name in ("dry_both", "film_both_engine", "dry_small_end"):
        wanted = bare(pd.read_csv(DATA / f"{name}.csv"))
        found, summary = run(DATA / f"{name}.nml", "output.digits=17", "output.columns=" + ", ".join(wanted.columns))
        check(len(found) == len(wanted), f"{name}: every row is there")
        for column in wanted.columns[1:]:
            scale = max(np.ptp(wanted[column]), 1e-300)
            difference = np.abs(found[column] - wanted[column]).max() / scale if np.ptp(wanted[column]) > 0 else 0
            check(difference < (1e-8 if column in STATES else 1e-7), f"{name}: {column} is that of the reference", f"{difference:.2g}")
        check(float(summary["max_energy_residual_relative"]) < 1e-10, f"{name}: no energy is lost", summary["max_energy_residual_relative"])
        events = bare(pd.read_csv(DATA / f"{name}.events.csv"))
        if len(events):
            own = run.events(DATA / f"{name}.nml")
            check(list(own["joint"]) == list(events["joint"]) and list(own["event"]) == list(events["event"]), f"{name}: the same contacts")
            check(np.abs(own["time"] - events["time"]).max() < 1e-10, f"{name}: contact times", str(np.abs(own["time"] - events["time"]).max()))
            check(np.abs(own["normal_speed"] / events["normal_speed"] - 1).max() < 1e-6, f"{name}: speeds of the contacts")


def tolerances(run: Runner) -> None:
    """A run is nearer to the reference at a closer tolerance."""
    wanted = bare(pd.read_csv(DATA / "film_both_engine.csv"))
    errors = [off(run(DATA / "film_both_engine.nml", "output.digits=17", f"integrator.relative_tolerance={t}")[0]["pin_speed"],
                  wanted["pin_speed"]) for t in ("1e-6", "1e-8", "1e-10")]
    check(errors[0] < 1e-4 and errors[1] < 1e-5 and errors[2] < 1e-7, "the pin's speed converges on the reference", str(errors))
    evaluations = int(run(DATA / "film_both_engine.nml", "integrator.relative_tolerance=1e-6")[1]["rhs_evaluations"])
    check(evaluations < 3000, "the engine's films need few evaluations", str(evaluations))


# the pin fixed in the piston

BODIES = """&mechanism crank_length = 0.05, crank_mass = 0.3, crank_inertia = 0.002, crank_com = 0.025, 0.0
  rod_length = 0.12, rod_mass = 0.21, rod_inertia = 0.00025, rod_com = 0.06, 0.003, piston_mass = 0.14, gravity = 9.80665, gravity_angle_deg = 20.0 /
&initial crank_angle_deg = 30.0, crank_speed = 250.0 /
&drive kind = '{drive}', damping = 0.001 /
{pin}
{joints}
&integrator end_time = 0.02, relative_tolerance = 1.0e-12 /
&output interval = 1.0e-4, digits = 17 /
"""
JOINT = "&joint place = '{0}', kind = 'clearance', clearance = {1}, bearing_radius = 0.01, bearing_length = 0.018 /\n"
OCVIRK = "&lubrication law = 'finite_bearing', variant = 'short', viscosity = 0.04, film_moment = .true. /\n"
LONG = "&lubrication law = 'pinkus_sternlicht', viscosity = 0.04, film_moment = .true. /\n"
DRY = "&contact law = 'lankarani_nikravesh', restitution = 0.8 /\n"


def single(pin: str, place: str, laws: str, drive: str) -> str:
    return BODIES.format(drive=drive, pin=pin, joints=JOINT.format(place, 4e-5) + laws)


def either_body(run: Runner) -> None:
    """With a film and its moment, and in contact without friction, it does not matter which body holds the pin."""
    for what, laws in {"Ocvirk": OCVIRK, "Pinkus and Sternlicht": LONG, "frictionless contact": DRY}.items():
        for drive in ("free", "constant_speed"):
            rod, _ = run(single("", "piston_pin", laws, drive))
            piston, summary = run(single("&pin kind = 'piston' /", "small_end", laws, drive))
            plain = run(single("&pin kind = 'rod' /", "piston_pin", laws, drive))[0]
            check(plain.equals(rod), f"{what}: a pin of the rod is what a case has without the group")
            check(float(summary["max_energy_residual_relative"]) < 1e-10, f"{what}: no energy is lost with a pin of the piston")
            for column in ("crank_angle", "rod_angle", "piston_velocity", "piston_acceleration", "pin_force_x", "pin_force_y", "guide_force",
                           "crankpin_force_x", "frame_force_y", "crank_moment"):
                # rounding of the film's sines and logarithms, amplified by its stiffness: up to 7e-9
                check(off(piston[column], rod[column]) < 1e-7, f"{what}: {column} is the same whichever body holds the pin",
                      f"{off(piston[column], rod[column]):.2g}")
            check(off(-piston[PREFIX + "eccentricity_x"], rod["eccentricity_x"]) < 1e-9, f"{what}: the eccentricity is the opposite")
            check("eccentricity_x" not in piston and PREFIX + "film_thickness" in piston, f"{what}: columns have the name of the place")
    friction = "&friction law = 'ambrosio', coefficient = 0.1, v0 = 0.001, v1 = 0.01 /\n"
    rod = run(single("", "piston_pin", DRY + friction, "free"))[0]
    piston, summary = run(single("&pin kind = 'piston' /", "small_end", DRY + friction, "free"))
    check(off(piston["rod_angle"], rod["rod_angle"]) > 1e-9 and float(summary["max_energy_residual_relative"]) < 1e-10,
          "with dry friction the arm of the eccentricity makes a difference")


# the floating pin

PIN = "&pin kind = 'floating', mass = {0}, inertia = {1} /"


def floating(first: str, second: str, drive: str = "free", mass: float = 0.05, inertia: float = 2.6e-6, c: tuple = (4e-5, 3e-5)) -> str:
    def at(place: str, laws: str) -> str:
        return "\n".join(line.replace(" ", f" place = '{place}', ", 1) for line in laws.splitlines())
    return BODIES.format(drive=drive, pin=PIN.format(mass, inertia), joints=JOINT.format("piston_pin", c[0]) + JOINT.format("small_end", c[1])
                         + at("piston_pin", first) + "\n" + at("small_end", second))


def identities(run: Runner) -> None:
    """In every row the pin is where rod and piston are, and forces and moments balance."""
    columns = "output.columns=standard, joint_moment, small_end_joint_moment"
    for what, text in {"two films": floating(OCVIRK, LONG), "dry": floating(DRY, DRY + "&friction law = 'ambrosio', coefficient = 0.1, v0 = 0.001, v1 = 0.01 /")}.items():
        rows, summary = run(text, columns, "mechanism.gravity_angle_deg=0")
        q, angle = rows["crank_angle"], rows["rod_angle"]
        along = 0.05 * np.cos(q) + 0.12 * np.cos(angle) - rows["piston_position"] - (rows["eccentricity_x"] - rows[PREFIX + "eccentricity_x"])
        across = 0.05 * np.sin(q) - 0.12 * np.sin(angle) - (rows["eccentricity_y"] - rows[PREFIX + "eccentricity_y"])
        check(max(np.abs(along).max(), np.abs(across).max()) < 1e-15, f"{what}: e_b - e_s is the distance of the bearings", f"{np.abs(along).max():.2g}")
        turn = rows["joint_moment"] + rows[PREFIX + "joint_moment"] - 2.6e-6 * rows["pin_acceleration"]
        check(np.abs(turn).max() <= 1e-12 * np.abs(rows[PREFIX + "joint_moment"]).max(), f"{what}: both moments turn the pin", f"{np.abs(turn).max():.2g}")
        check(off(rows["guide_force"], -rows["pin_force_y"]) < 1e-10, f"{what}: the chain's reactions are the forces of the joint in the piston",
              f"{off(rows['guide_force'], -rows['pin_force_y']):.2g}")
        piston = -rows["pin_force_x"] - 0.14 * (rows["piston_acceleration"] + 9.80665)
        check(np.abs(piston).max() < 1e-10 * np.abs(rows["pin_force_x"]).max(), f"{what}: the joint's force moves the piston")
        check(float(summary["max_energy_residual_relative"]) < 1e-10, f"{what}: no energy is lost", summary["max_energy_residual_relative"])


def nothing_turns_it(run: Runner) -> None:
    rows, summary = run(floating("&contact law = 'hertz' /", "&contact law = 'hertz' /"), "initial.pin_speed=-7")
    check((rows["pin_speed"] == -7).all(), "without friction the pin keeps its speed to the last bit")
    check(float(summary["max_energy_residual_relative"]) < 1e-9, "contacts without loss keep the energy", summary["max_energy_residual_relative"])
    check(abs(float(summary["pin_turn"]) + 7 * 0.02) < 1e-12, "the turn is its speed times the time", summary["pin_turn"])


def limits(run: Runner) -> None:
    """A film of thick oil in one bearing fixes the pin there: first order in 1/viscosity."""
    rod_speed = float(0.05 * np.cos(np.pi / 6) * 250 / np.sqrt(0.12**2 - 0.025**2))
    time = ("integrator.end_time=0.005", "mechanism.rod_com=0.06,0")
    m, inertia = 0.05, 2.6e-6
    total = 0.21 + m
    com = (0.21 * 0.06 + m * 0.12) / total
    about = 0.00025 + 0.21 * (0.06 - com) ** 2 + inertia + m * (0.12 - com) ** 2
    in_rod = run(single("", "piston_pin", OCVIRK, "free"), *time[:1], f"mechanism.rod_mass={total!r}", f"mechanism.rod_com={com!r},0",
                 f"mechanism.rod_inertia={about!r}")[0]
    in_piston = run(single("&pin kind = 'piston' /", "small_end", LONG, "free"), *time, f"mechanism.piston_mass={0.14 + m!r}", "small_end.joint.clearance=3e-5")[0]
    for what, fixed, place in (("rod", in_rod, "small_end"), ("piston", in_piston, "piston_pin")):
        start = f"initial.pin_speed={-rod_speed if what == 'rod' else 0.0!r}"
        errors = [off(run(floating(OCVIRK, LONG), *time, start, f"{place}.lubrication.viscosity={mu}")[0]["rod_speed"], fixed["rod_speed"])
                  for mu in (4, 16, 64)]
        check(3 < errors[0] / errors[1] < 5 and 3.5 < errors[1] / errors[2] < 4.5 and errors[2] < 1e-3,
              f"thick oil fixes the pin in the {what}", str(errors))


def squeeze(run: Runner) -> None:
    """Crank at rest: piston and pin sink through two Ocvirk films in series, t = (2 lam^2 mu L R^3/(c^2 Q)) (J' - 2)."""
    text = f"""&mechanism crank_length = 0.05, crank_mass = 0.3, crank_inertia = 0.002, rod_length = 0.12, rod_mass = 0.21, rod_inertia = 0.00025,
  rod_com = 0.06, 0.0, piston_mass = 0.4 /
&drive kind = 'constant_speed' /
&initial crank_speed = 0.0 /
{PIN.format(0.05, 2.6e-6)}
&joint place = 'piston_pin', kind = 'clearance', clearance = 20e-6, bearing_radius = 0.01, bearing_length = 0.03 /
&joint place = 'small_end', kind = 'clearance', clearance = 30e-6, bearing_radius = 0.01, bearing_length = 0.02 /
&lubrication law = 'finite_bearing', variant = 'short', viscosity = 0.02 /
&integrator end_time = 0.4, relative_tolerance = 1e-10 /
&output interval = 0.04, digits = 17 /
"""
    last = run(text)[0].iloc[-1]
    for prefix, eps in (("", 0.0677845), (PREFIX, 0.3573995)):
        check(abs(last[prefix + "eccentricity_ratio"] / eps - 1) < 1e-5, f"two films in series: {prefix}eccentricity", repr(last[prefix + "eccentricity_ratio"]))
    check(abs(last["pin_speed"]) < 1e-9, "two films in series: the pin does not turn")


def ring(run: Runner) -> None:
    """A light, centred pin between films that hardly move is a floating ring: w/omega_r goes to k_s/(k_b + k_s)."""
    rows = run(floating(OCVIRK, OCVIRK, "constant_speed"), "mechanism.piston_mass=1e-6", "mechanism.gravity=0", "initial.crank_speed=20", "initial.crank_angle_deg=0",
               "piston_pin.lubrication.viscosity=0.4", "small_end.lubrication.viscosity=0.2", "integrator.end_time=0.002", "output.interval=1e-5",
               "pin.mass=1e-6", "pin.inertia=1e-12", "integrator.relative_tolerance=1e-9")[0]
    k = [mu * (0.01 - c) ** 3 / c for mu, c in ((0.4, 4e-5), (0.2, 3e-5))]
    share = rows["pin_speed"] / -rows["rod_speed"]
    check(abs(share.iloc[-1] / (k[1] / sum(k)) - 1) < 1e-3, "a floating ring turns with the share of its films", f"{share.iloc[-1]!r} {k[1] / sum(k)!r}")


def coulomb(run: Runner) -> None:
    """True sticking in both joints: every row obeys the law, and a pin that sticks turns with its body."""
    law = DRY + "&friction law = 'coulomb', coefficient = {0}, static_coefficient = {1} /\n"
    for drive in ("free", "constant_speed"):
        rows, summary = run(floating(law.format(0.08, 0.1), law.format(0.05, 0.07), drive), "integrator.relative_tolerance=1e-9", "output.interval=2e-6",
                            "integrator.end_time=0.01")
        check(float(summary["max_energy_residual_relative"]) < 1e-8, "sticking in two joints: no energy is lost", summary["max_energy_residual_relative"])
        stuck = 0
        for prefix, sliding, static in (("", 0.08, 0.1), (PREFIX, 0.05, 0.07)):
            n, f, v = (rows[prefix + name] for name in ("normal_force", "friction_force", "sliding_speed"))
            sticks = (n > 0) & (np.abs(v) < 1e-7)
            slides = (n > 0) & (np.abs(v) > 1e-5)
            stuck += int(sticks.sum())
            check((np.abs(f[sticks]) <= static * n[sticks] * (1 + 1e-6)).all(), f"{prefix} friction that holds is within its bound",
                  str((np.abs(f[sticks]) / n[sticks]).max()))
            check((np.abs(f[slides] + np.sign(v[slides]) * sliding * n[slides]) <= 1e-9 * n.max()).all(), f"{prefix} friction opposes sliding")
        check(stuck > 0, "some rows stick", str(stuck))
    high = law.format(5.0, 5.0)
    rows = run(floating(DRY, high, c=(1e-5, 1e-5)), "integrator.relative_tolerance=1e-9", "integrator.end_time=0.01")[0]
    sticks = (rows[PREFIX + "normal_force"] > 0) & (np.abs(rows[PREFIX + "sliding_speed"]) < 1e-9)
    check(sticks.any(), "a rough small end makes the pin stick")
    spin = np.abs(rows["pin_speed"] + rows["rod_speed"])[sticks]
    rolls = np.hypot(rows[PREFIX + "eccentricity_rate_x"], rows[PREFIX + "eccentricity_rate_y"])[sticks] / 0.01
    check((spin <= 1.01 * rolls + np.abs(rows["rod_speed"][sticks]) * 2e-3 + 1e-6).all(), "a pin that sticks in the rod turns with it, but for its rolling in the clearance",
          f"{spin.max():.3g}")


def spin_down(run: Runner) -> None:
    """Crank at rest, the piston on the pin and the pin in the rod: equal friction forces slow a spinning pin evenly, w = w_0 - M t/I, without moving it, until
    both surfaces stick in the same instant. The contacts begin at their static penetrations (N/K)^(2/3), and the rod is too heavy to turn."""
    piston, pin, mu, g, stiffness, inertia, start, radius, c = 0.4, 0.05, 0.06, 9.80665, 1e10, 2.6e-6, 20.0, 0.01, (4e-5, 3e-5)
    load = (piston * g, (piston + pin) * g)
    force = mu * load[0]
    e = [clearance + (n / stiffness) ** (2 / 3) for clearance, n in zip(c, load)]
    text = f"""&mechanism crank_length = 0.05, crank_mass = 0.3, crank_inertia = 0.002, rod_length = 0.12, rod_mass = 0.21, rod_inertia = 1e6,
  rod_com = 0.06, 0.0, piston_mass = {piston} /
&drive kind = 'constant_speed' /
&initial crank_speed = 0.0, pin_speed = {start}, eccentricity = {e[0]!r}, 0.0, small_end_eccentricity = {-e[1]!r}, 0.0 /
{PIN.format(pin, inertia)}
&joint place = 'piston_pin', kind = 'clearance', clearance = {c[0]}, bearing_radius = {radius} /
&joint place = 'small_end', kind = 'clearance', clearance = {c[1]}, bearing_radius = {radius} /
&contact law = 'hertz', stiffness = {stiffness} /
&friction place = 'piston_pin', law = 'coulomb', coefficient = {mu} /
&friction place = 'small_end', law = 'coulomb', coefficient = {force / load[1]!r} /
&integrator end_time = 0.015, relative_tolerance = 1e-9 /
&output interval = 1e-4, digits = 17 /
"""
    rows = run(text)[0]
    want = np.maximum(start - force * (2 * radius - sum(c)) / inertia * rows["time"], 0)
    check((np.abs(rows["pin_speed"] - want) < 1e-7).all(), "a pin that friction stops in both bearings at once", f"{np.abs(rows['pin_speed'] - want).max():.3g}")
    stands = rows["time"] > inertia * start / (force * (2 * radius - sum(c))) + 1e-5
    largest = max(np.abs(rows[prefix + "friction_force"][stands]).max() for prefix in ("", PREFIX))
    check(stands.sum() > 30 and largest < 1e-7, "nothing turns it then", f"{largest:.3g}")


def wear(run: Runner) -> None:
    """Both surfaces of both bearings wear by rate times force times sliding path, wherever on them."""
    rate, pressed = 1e-14, TOP / "cases" / "pin" / "ticking.nml"
    rows = run(pressed, f"wear.rate={rate}, {2 * rate}", "integrator.revolutions=1", "output.samples_per_revolution=20000", "joint.bearing_length=0.03",
               "small_end.joint.bearing_length=0.024")[0]
    worn = bare(pd.read_csv(run.result(pressed, "wear.csv")))
    for place, prefix, length, c in (("piston_pin", "", 0.03, 30e-6), ("small_end", PREFIX, 0.024, 40e-6)):
        path = np.trapezoid(rows[prefix + "normal_force"] * np.abs(rows[prefix + "sliding_speed"]), rows["time"])
        own = worn[worn["joint"] == place]
        for surface, radius, factor in (("pin", 0.011 - c, 1), ("bore", 0.011, 2)):
            volume = own[f"{surface}_depth"].sum() * radius * length * 2 * np.pi / len(own)
            check(abs(volume / (factor * rate * path) - 1) < 1e-3, f"wear of the {surface} at the {place}", f"{volume!r} {factor * rate * path!r}")


def energies(run: Runner) -> None:
    """Combinations that no reference has: no energy is lost."""
    rod = ("elastic_rod.youngs_modulus=2.07e11", "elastic_rod.section_area=2e-4", "elastic_rod.section_inertia=4e-9")
    bore = ("guide.kind=clearance", "guide.bore_clearance=1e-4", "guide.skirt_top=0.02", "guide.skirt_bottom=0.02", "guide.piston_com=0.004,0.001",
            "guide.piston_radius=0.04", "guide.piston_inertia=4e-4", "guide.stiffness=1e8", "guide.coefficient=0.05")
    big_end = ("crank_pin.joint.kind=clearance", "crank_pin.joint.clearance=4e-5", "crank_pin.joint.bearing_radius=0.02", "crank_pin.contact.law=hertz")
    friction = "&friction law = 'ambrosio', coefficient = 0.1, v0 = 0.001, v1 = 0.01 /\n"
    scenes = {"films": floating(OCVIRK, LONG), "dry": floating(DRY + friction, DRY + friction.replace("0.1,", "0.05,")),
              "film and contact": floating(OCVIRK, DRY + friction), "film to contact": floating(DRY + OCVIRK.replace("0.04", "0.004"), DRY + LONG.replace("0.04", "0.004"))}
    for what, text in scenes.items():
        for beside, changes in {"nothing": (), "an elastic rod": rod, "slap": bore, "a loose crank pin": big_end, "all three": rod + bore + big_end,
                                "friction of the guide": ("guide.coefficient=0.1",),
                                "a ramp": ("drive.kind=constant_speed", "drive.ramp_time=0.004", "drive.ramp_from=150"),
                                "an elastic crankshaft": ("crankshaft.flywheel_inertia=0.02", "crankshaft.torsional_stiffness=2e4"),
                                "gas": ("combustion.bore=0.05", "combustion.compression_ratio=9", "combustion.heat_capacity_ratio=1.35", "combustion.heat=100",
                                        "combustion.wiebe_efficiency=5", "combustion.wiebe_form=3", "combustion.start_deg=345", "combustion.duration_deg=50"),
                                "cylinders": ("cylinder_1.full=T", "cylinder_2.phase_deg=180")}.items():
            summary = run(text, "integrator.relative_tolerance=1e-9", "integrator.end_time=0.006", *changes)[1]
            lost = float(summary["max_energy_residual_relative"])
            check(lost < 1e-7, f"{what} with {beside}: no energy is lost", f"{lost:.2g}")


def elements(run: Runner) -> None:
    """Further load elements in either bearing."""
    lugre = DRY + ("&friction law = 'lugre', coefficient = 0.08, static_coefficient = 0.12, stribeck_speed = 0.02, bristle_stiffness = 2e4, "
                   "bristle_damping = 0.4, damping_speed = 0.1 /\n")
    rough = OCVIRK + ("&asperities roughness = 0.4e-6, density_product = 0.05, sharpness = 1.0e-2, youngs_modulus = 2*207.0e9, poissons_ratio = 2*0.3, "
                      "coefficient = 0.1, transition_speed = 0.01 /\n")
    warm = OCVIRK.replace("viscosity = 0.04", "oil = 'SAE 30', temperature = 90 degC") + (
        "&heat heat_capacity = 60.0, inlet_temperature = 90 degC, conductance = 4.0, housing_temperature = 80 degC /\n")
    elastic = "&contact law = 'hertz', geometry = 'conformal' /\n" + OCVIRK.replace("film_moment", "elastic_film = .true., film_moment")
    for what, first, second in (("bristles", lugre, lugre), ("bristles and a film", lugre, OCVIRK), ("rough surfaces", rough, LONG), ("rough surfaces in the rod", OCVIRK, rough),
                                ("warm films", warm, warm), ("elastic walls in the piston", elastic, LONG), ("elastic walls in the rod", OCVIRK, elastic)):
        summary = run(floating(first, second), "integrator.relative_tolerance=1e-9", "integrator.end_time=0.006")[1]
        lost = float(summary["max_energy_residual_relative"])
        check(lost < 1e-7, f"{what}: no energy is lost", f"{lost:.2g}")
        methods = [run(floating(first, second), "integrator.relative_tolerance=1e-9", "integrator.end_time=0.002", f"integrator.method={method}")[0].iloc[-1]
                   for method in ("adams", "radau")]
        check(abs(methods[0]["pin_speed"] - methods[1]["pin_speed"]) < 1e-4 * abs(methods[0]["pin_speed"]), f"{what}: both methods agree",
              f"{methods[0]['pin_speed']!r} {methods[1]['pin_speed']!r}")


def random_scenes(run: Runner, scenes: int = 60, seed: int = 7) -> None:
    """Scenes at random, also far from usual ones: each run ends and keeps its energy."""
    random = np.random.default_rng(seed)

    def pick(*words: str) -> str:
        return str(random.choice(words))

    def size(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    def laws() -> str:
        kind = pick("dry", "film", "both", "rough", "smooth")
        film = f"&lubrication law = 'finite_bearing', variant = 'short', viscosity = {size(0.003, 1):.4g} /\n"
        if pick("short", "long") == "long":
            film = f"&lubrication law = 'pinkus_sternlicht', viscosity = {size(0.003, 1):.4g} /\n"
        contact = f"&contact law = '{pick('lankarani_nikravesh', 'hunt_crossley', 'flores', 'exact')}', restitution = {random.uniform(0.1, 0.95):.3g} /\n"
        coefficient = random.uniform(0.01, 0.5)
        friction = pick("&friction law = 'ambrosio', coefficient = {0:.3g}, v0 = 0.001, v1 = 0.01 /\n", "&friction law = 'coulomb', coefficient = {0:.3g}, static_coefficient = {1:.3g} /\n",
                        "&friction law = 'lugre', coefficient = {0:.3g}, static_coefficient = {1:.3g}, stribeck_speed = 0.02, bristle_stiffness = 2e4, "
                        "bristle_damping = 0.4, damping_speed = 0.1 /\n").format(coefficient, coefficient * random.uniform(1, 1.6))
        asperities = "&asperities roughness = 0.4e-6, density_product = 0.05, sharpness = 1.0e-2, coefficient = 0.1, transition_speed = 0.01 /\n"
        return {"dry": contact + friction, "film": film, "both": contact + friction + film, "rough": film + asperities, "smooth": contact}[kind]

    for number in range(scenes):
        c = (size(3e-6, 3e-4), size(3e-6, 3e-4))
        text = floating(laws(), laws(), pick("free", "constant_speed"), size(1e-3, 1), size(1e-8, 1e-4), c)
        changes = ["integrator.relative_tolerance=1e-8", "integrator.end_time=0.003", "integrator.max_evaluations=300000", f"mechanism.piston_mass={size(0.01, 5):.4g}",
                   f"initial.crank_angle_deg={random.uniform(0, 360):.4g}", f"initial.crank_speed={random.choice([-1, 1]) * size(1, 2000):.4g}",
                   f"initial.pin_speed={random.normal(0, 300):.4g}", f"initial.eccentricity={random.uniform(-0.6, 0.6) * c[0]:.4g},0",
                   f"initial.small_end_eccentricity=0,{random.uniform(-0.6, 0.6) * c[1]:.4g}"]
        out = run.folder / f"scene_{number}"
        path = run.file(text)
        done = subprocess.run([run.program, "-q", "-o", out, *(part for change in changes for part in ("--set", change)), str(path)],
                              capture_output=True, text=True, check=False, timeout=600)
        check(done.returncode == 0 or (done.returncode == 4 and "evaluations" in done.stderr), f"scene {number} runs to its end", done.stderr[:300])
        if done.returncode == 0:
            summary = pd.read_csv(out / f"{path.stem}.summary.csv", dtype=str).set_index("quantity")["value"]
            lost = float(summary["max_energy_residual_relative"])
            check(lost < 1e-5, f"scene {number} keeps its energy", f"{lost:.2g} {path.read_text()[300:]} {changes}")


def results(run: Runner) -> None:
    """Turn, drift and swing follow from the rows."""
    text = floating(OCVIRK, LONG, "constant_speed")
    rows, summary = run(text, "initial.crank_angle_deg=0", "integrator.end_time=0", "integrator.revolutions=3", "output.interval=0",
                        "output.samples_per_revolution=2000",
                        "output.sampling=crank_angle", "integrator.relative_tolerance=1e-9")
    angle = rows["pin_angle"].to_numpy()
    check(abs(float(summary["pin_turn"]) - angle[-1]) < 1e-9, "pin_turn is the last angle")
    check(abs(float(summary["pin_drift_per_revolution"]) - angle[-1] / 3) < 1e-8, "pin_drift_per_revolution is its mean", summary["pin_drift_per_revolution"])
    check(abs(float(summary["pin_swing"]) - np.ptp(angle[-2001:])) < 1e-6, "pin_swing is that of the last revolution", summary["pin_swing"])
    for name, relative in (("turning_in_piston", rows["pin_speed"]), ("turning_in_rod", rows["pin_speed"] + rows["rod_speed"])):
        turned = np.trapezoid(np.abs(relative), rows["time"]) if hasattr(np, "trapezoid") else np.trapezoid(np.abs(relative), rows["time"])
        check(abs(float(summary[name]) / turned - 1) < 1e-5, f"{name} is the integral of the speed", f"{summary[name]} {turned!r}")
    share = float(summary["turning_in_rod"]) / (float(summary["turning_in_rod"]) + float(summary["turning_in_piston"]))
    check(abs(float(summary["small_end_turning_share"]) - share) < 1e-9, "small_end_turning_share")
    check("pin_warning" not in summary, "films decide where the pin turns")
    summary = run(DATA / "dry_both.nml", "integrator.relative_tolerance=1e-8")[1]
    events = run.events(DATA / "dry_both.nml")
    begins = events[events["event"] == "contact_begins"].groupby("joint")["normal_speed"].max()
    check(abs(float(summary["max_impact_speed"]) / begins["piston_pin"] - 1) < 1e-9 and
          abs(float(summary["small_end_max_impact_speed"]) / begins["small_end"] - 1) < 1e-9, "the largest impact speed of each joint")
    summary = run(DATA / "dry_both.nml", "integrator.relative_tolerance=1e-8", "small_end.friction.coefficient=0.04", "small_end.joint.clearance=1e-4")[1]
    check("same moment" in summary.get("pin_warning", ""), "equal friction in dry bearings is undecided")


def periodic(run: Runner) -> None:
    """A pin that drifts has a periodic motion; its angle goes on."""
    text = floating(OCVIRK, LONG, "constant_speed")
    rows, summary = run(text, "integrator.end_time=0", "run.until=periodic", "run.most_revolutions=40", "integrator.relative_tolerance=1e-8", "output.interval=0",
                        "output.samples_per_revolution=90")
    check(summary["motion"] == "periodic", "a motion with drift is periodic", summary["motion"])
    check(abs(float(summary["cycle_pin_turn"])) > 1e-6, "the pin drifts", summary["cycle_pin_turn"])
    exponent = run(text, "integrator.end_time=0", "integrator.revolutions=12", "run.lyapunov_revolutions=6", "integrator.relative_tolerance=1e-8",
                   "output.interval=0")[1]
    check(float(exponent.get("lyapunov_exponent", "1")) < 0, "its neighbours come nearer", exponent.get("lyapunov_exponent", exponent.get("lyapunov_warning", "")))


def twin(run: Runner) -> None:
    """The ideal twin has the mass of the pin in its piston."""
    text = floating(OCVIRK, LONG)
    run(text, "output.ideal_twin=T")
    name = run.file(text).stem
    frame = bare(pd.read_csv(run.folder / str(run.number) / f"{name}.ideal.csv"))
    ideal = run(BODIES.format(drive="free", pin="", joints=""), "mechanism.piston_mass=0.19")[0]
    check(off(frame["crank_speed"], ideal["crank_speed"]) < 1e-12, "the twin is the ideal mechanism with piston and pin as one", f"{off(frame['crank_speed'], ideal['crank_speed']):.2g}")


def resumes(run: Runner) -> None:
    """A run in two halves ends as the whole run."""
    for case in (DATA / "dry_small_end.nml", DATA / "film_both_engine.nml"):
        end = 0.006
        whole = run(case, "output.digits=17", f"integrator.end_time={2 * end}")
        run(case, "output.digits=17", f"integrator.end_time={end}")
        state = run.result(case, "state.nml")
        rest = run(case, "output.digits=17", f"integrator.end_time={2 * end}", f"initial.from={state}")
        a, b = whole[0].iloc[-1], rest[0].iloc[-1]
        for column in ("pin_angle", "pin_speed", "eccentricity_x", PREFIX + "eccentricity_y"):
            check(abs(a[column] - b[column]) < 1e-6 * max(abs(a[column]), 1e-6), f"{case.stem} goes on: {column}", f"{a[column]!r} {b[column]!r}")
        for name in ("turning_in_rod", "turning_in_piston", "pin_turn"):
            # a pin that creeps: its angle is the sum of what films leave of two large moments (1.6e-6 by rounding alone)
            check(abs(float(whole[1][name]) - float(rest[1][name])) < 1e-4, f"{case.stem} goes on: {name}", f"{whole[1][name]} {rest[1][name]}")


def refusals(run: Runner) -> None:
    both, plain = floating(OCVIRK, LONG), single("", "piston_pin", OCVIRK, "free")
    for case, changes, says in [
        (both, ["small_end.joint=none", "small_end.lubrication=none"], "needs two joints with kind = 'clearance'"),
        (both, ["joint.kind=ideal", "piston_pin.lubrication=none"], "needs two joints with kind = 'clearance'"),
        (both.replace("mass = 0.05, ", ""), [], "&pin mass: required with kind = 'floating'"),
        (both.replace(", inertia = 2.6e-06", ""), [], "&pin inertia: required with kind = 'floating'"),
        (both, ["pin.mass=0"], "must be > 0"),
        (both, ["pin.mass=-1"], "must be > 0"),
        (both, ["small_end.lubrication.film_moment=F"], "must be .true. with a floating pin"),
        (floating(OCVIRK, "&lubrication law = 'oscillating_film', viscosity = 0.01, kinematic_viscosity = 1e-5 /\n"), [],
         "follows the motion of an ideal mechanism"),
        (plain, ["pin.kind=rod", "pin.mass=0.1"], "belongs to rod"),
        (plain, ["pin.kind=piston"], "must be ideal with &pin kind = 'piston'"),
        (plain, ["pin.kind=hand"], "must be one of rod, piston, floating"),
        (plain, ["initial.pin_speed=1"], "is for &pin kind = 'floating' alone"),
        (single("", "small_end", OCVIRK, "free"), [], "needs &pin kind = 'piston' or 'floating'"),
        (single("&pin kind = 'piston', inertia = 1e-6 /", "small_end", OCVIRK, "free"), [], "belongs to piston"),
    ]:
        message = run.refused(case, *changes)
        check(says in message and message.count("\n") == 1, f"refused with one line: {says} {' '.join(changes)[:50]}", message[:400])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=None)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run = Runner(options.program or str(release_program()), Path(folder))
        for part in (references, tolerances, either_body, identities, nothing_turns_it, limits, squeeze, ring, coulomb, spin_down, wear, energies, elements, random_scenes,
                     results, periodic, twin, resumes, refusals):
            part(run)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
