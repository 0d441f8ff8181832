#!/usr/bin/env python3
"""Several cylinders on one crankshaft: whole runs against motions, frequencies and amplitudes computed by other programs
(data/cylinders), equalities between cases, the energy of cases that no reference has, and what the program refuses; the same of one cylinder whose
axis is beside the crank axis.

    .venv/bin/python tests/test_cylinders.py [--program PATH]        (after scripts/setup.sh --python)

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

import numpy as np
import pandas as pd
from assertions import Assertions
from case_runner import Runner, bare
from gudgeon.program import release_program

assertions = Assertions()
check = assertions.check
CASES = TOP / "cases" / "cylinders"
DATA = TOP / "data" / "cylinders"
FINE = ("output.digits=17", "integrator.relative_tolerance=1e-11")
STATES = ("crank_angle", "rod_angle", "piston_position", "crank_speed", "rod_speed", "piston_velocity", "twist", "station", "damper_1_speed")


def order(values: np.ndarray, h: float, cycles: int = 1) -> float:
    """Amplitude at order h of values at equal angles of `cycles` cycles of 720 degrees, the end left out."""
    return 2 * abs(np.fft.rfft(values)[round(2 * h) * cycles]) / len(values)


# references

def compare(run: Runner, name: str, interval: float, states: float, others: float, *changes: str) -> None:
    """All columns of a reference, relative to their largest value; rows at jumps of the gas are left out."""
    reference = pd.read_csv(DATA / f"{name}.csv")
    wanted = ", ".join(column.partition("[")[0] for column in reference.columns)
    case = next(folder / f"{name}.nml" for folder in (CASES, DATA) if (folder / f"{name}.nml").exists())
    found, summary = run(case, *FINE, f"output.interval={interval!r}", f"output.columns=standard, {wanted}",
                         "output.window=all", "output.sampling=time", "run.until=end", *changes)
    check(float(summary["max_energy_residual_relative"]) < 1e-11, f"{name}: no energy is lost", summary["max_energy_residual_relative"])
    rows = min(len(found), len(reference))
    check(rows >= len(reference) - 1, f"{name}: every row of the reference is there", f"{rows} of {len(reference)}")
    for column in reference.columns:
        a, b = found[column].to_numpy()[:rows], reference[column].to_numpy()[:rows]
        off = np.sort(np.abs(a - b) / max(np.abs(b).max(), 1e-9))
        jumps = 4 if name == "inline_four" else 0   # rows at the instants at which its cylinders open
        limit = states if any(part in column for part in STATES) else others
        check(off[-1 - jumps] < limit, f"{name}: {column} is that of the reference", f"{off[-1 - jumps]:.2g}")


def references(run: Runner) -> None:
    """Tolerances are a tenth of what the references ask for."""
    compare(run, "inline_four", 6 * 5.8177641733144315e-05, 1e-9, 1e-9, "integrator.revolutions=0", "integrator.end_time=0.041887902047863905")
    compare(run, "six_mwm", 6 * 8.333333333333333e-05, 1e-7, 1e-7, "integrator.end_time=0.06")
    compare(run, "four_dry", 4 * 2e-5, 1e-7, 1e-6, "integrator.revolutions=0", "integrator.end_time=0.012")
    compare(run, "offset_four", 6 * 0.00011635528346628863, 1e-9, 1e-9)
    compare(run, "offset_dry", 1.6e-4, 1e-8, 1e-5)
    found = pd.read_csv(run.result(DATA / "offset_dry.nml", "events.csv"))
    wanted = pd.read_csv(DATA / "offset_dry.events.csv")
    off = (found["time[s]"] - wanted["time[s]"]).abs().max() if len(found) == len(wanted) else np.inf
    check(off < 1e-10 and list(found["event"]) == list(wanted["event"]), "offset_dry: contacts begin and end when they do in the reference", f"{off!r}")


def facts(run: Runner) -> None:
    table = pd.read_csv(DATA / "facts.csv").set_index(["case", "quantity"])

    def fact(case: str, quantity: str, value: float) -> None:
        row = table.loc[(case, quantity)]
        check(abs(value - row["value"]) <= row["tolerance"], f"{case}: {quantity} is that of other programs", f"{value!r} for {row['value']!r}")

    free = run(CASES / "six_mwm.nml", *FINE, "drive.kind=free", "output.window=all", "run.until=end", "integrator.end_time=1e-4")[1]
    for i in range(1, 9):
        fact("six_mwm", f"natural_frequency_{i}[Hz]", float(free[f"natural_frequency_{i}"]))
    for i in range(1, 10):
        fact("six_mwm", f"mode_1_station_{i}", float(free[f"mode_1_station_{i}"]))
    dry = run(CASES / "four_dry.nml", *FINE, "integrator.revolutions=0", "integrator.end_time=1e-4")[1]
    for i in range(1, 6):
        fact("four_dry", f"natural_frequency_{i}[Hz]", float(dry[f"natural_frequency_{i}"]))

    rows, settled = run(CASES / "six_mwm.nml", "output.digits=17", "integrator.relative_tolerance=1e-9",
                        "run.until=end", "integrator.end_time=0.72", "output.start_time=0.66", "output.sampling=time",
                        "output.window=all", f"output.interval={0.06 / 1440!r}")
    rows = bare(rows)
    last = rows.iloc[-1441:-1]
    check(settled["firing_order"] == "1-5-3-6-2-4", "six_mwm: the firing order is 1-5-3-6-2-4", settled["firing_order"])
    fact("six_mwm", "natural_frequency_1_held[Hz]", float(settled["natural_frequency_1"]))
    swing = (last["station_1_twist"] - last["station_9_twist"]).to_numpy()
    for h in (6, 3, 1.5, 4.5, 5.5, 6.5):
        fact("six_mwm", f"station_1_order_{h}[rad]", order(swing, h))
    for h in (6, 3, 6.5):
        fact("six_mwm", f"segment_8_order_{h}[N.m]", order(last["segment_8_torque"].to_numpy(), h))
    fact("six_mwm", "station_1_peak_to_peak[rad]", swing.max() - swing.min())
    fact("six_mwm", "mean_crank_moment[N.m]", last["crank_moment"].mean())
    for h in (6, 3, 1.5):
        summed = float(settled[f"cycle_front_twist_order_{h}"])
        check(abs(summed - order(swing, h)) < 1e-7 * swing.max(), f"six_mwm: the summary has the amplitude of order {h}", f"{summed!r}")
    work = float(settled["cycle_work_gas"])
    check(abs(work / 6 - table.loc[("six_mwm", "indicated_work_per_cylinder[J]"), "value"]) < 1e-6 * work,
          "six_mwm: all cylinders do the same work", f"{work / 6!r}")

    rows = bare(run(CASES / "inline_four.nml", *FINE, "combustion=none", "mechanism.gravity=0", "integrator.revolutions=2",
                    "output.sampling=crank_angle", "output.samples_per_revolution=720")[0]).iloc[:1440]
    for column in ("engine_force_x", "engine_force_y", "crank_moment", "engine_moment_y", "engine_moment_z"):
        for h in (1, 2, 4, 6):
            unit = "N" if "force" in column else "N.m"
            if ("inline_four_motored", f"{column}_order_{h}[{unit}]") in table.index:
                fact("inline_four_motored", f"{column}_order_{h}[{unit}]", order(rows[column].to_numpy(), h))


# programs of others

def v6_pressure(angle: float) -> float:
    """Gas pressure of the Modelica library's EngineV6 over the piston's place [bar above the atmosphere], angle [rad]: crank 0.1 m,
    rod 0.2 m, stroke parameter 0.22 m, 0.1 m of piston below a top at 0.42 m."""
    x = 1 - (0.32 - 0.1 * np.cos(angle) - np.sqrt(0.04 - (0.1 * np.sin(angle)) ** 2)) / 0.22
    if np.sin(angle) < 0:   # compression
        coefficients = (177.4132, -287.2189, 151.8252, -24.9973, 2.4) if x < 0.986061 else (2836360, -10569296, 14761814, -9158505, 2129670)
    else:
        coefficients = (-3929704, 14748765, -20747000, 12964477, -3036495) if x > 0.933 else (145.930, -131.707, 17.3438, 17.9272, 2.4)
    return float(np.polyval(coefficients, x))


V6 = """&mechanism crank_length = 0.1, crank_mass = 4.007406870129424, crank_inertia = 0.0075720353827615095
  crank_com = 0.03551266838636118, 0.0, rod_length = 0.2, rod_mass = 2.0328, rod_inertia = 0.0088088, rod_com = 0.09, 0.0
  piston_mass = 6.047565858160352, gravity = 9.80665, gravity_angle_deg = 30.0 /
&drive kind = 'free', flywheel_inertia = 1.0, torque_table = 'v6_load.csv' /
&initial crank_speed = 10.0 /
&cylinder_pressure table = 'v6_pressure.csv', period_deg = 360, bore = 0.1, crankcase_pressure = 1.0e5 /
&cylinder throw = 1, phase_deg = -30.0, bank_deg = -30.0 /
&cylinder throw = 2, phase_deg = 90.0, bank_deg = 30.0 /
&cylinder throw = 3, phase_deg = 210.0, bank_deg = -30.0 /
&cylinder throw = 4, phase_deg = 210.0, bank_deg = 30.0 /
&cylinder throw = 5, phase_deg = 90.0, bank_deg = -30.0 /
&cylinder throw = 6, phase_deg = -30.0, bank_deg = 30.0 /
&integrator end_time = 1.01, relative_tolerance = 1.0e-11 /
&output interval = 0.101, digits = 17 /
"""
EXUDYN = """&mechanism crank_length = 0.5, crank_mass = 2.0, crank_inertia = 0.041666666666666664, crank_com = 0.25, 0.0, rod_length = 1.0
  rod_mass = 4.0, rod_inertia = 0.3333333333333333, rod_com = 0.5, 0.0, piston_mass = 1.0, gravity = 0.0 /
&drive kind = 'free', torque = 10.0 /
&initial crank_speed = 0.0 /
&integrator end_time = 1.0, relative_tolerance = 1.0e-12 /
&output interval = 1.0, digits = 17 /
"""
DISCS = """&mechanism crank_length = 0.01, crank_mass = 0.0, crank_inertia = 0.0, rod_length = 0.05, rod_mass = 1.0e-6, rod_inertia = 1.0e-12
  rod_com = 0.025, 0.0, piston_mass = 1.0e-6, gravity = 0.0 /
&drive kind = 'free' /
&initial crank_speed = 100.0 /
&cylinder full = .true., station = 1 /
&crankshaft {shaft} /
&integrator revolutions = 1.0 /
"""


LOOSE = ("joint.kind=clearance", "joint.clearance=2e-5", "joint.bearing_radius=0.009", "contact.law=hertz")
CRANK_PIN = ("crank_pin.joint.kind=clearance", "crank_pin.joint.clearance=4e-5", "crank_pin.joint.bearing_radius=0.014", "crank_pin.contact.law=hertz")
FLOATING = ("pin.kind=floating", "pin.mass=0.05", "pin.inertia=2e-6", "small_end.joint.kind=clearance", "small_end.joint.clearance=1e-5", "small_end.joint.bearing_radius=0.009",
            "small_end.contact.law=hertz")
BORE = ("guide.kind=clearance", "guide.coefficient=0.05", "guide.bore_clearance=1e-4", "guide.skirt_top=0.02", "guide.skirt_bottom=0.02", "guide.piston_radius=0.034",
        "guide.piston_inertia=1e-4", "guide.stiffness=1e8", "guide.piston_com=0.005,-0.001")
ROD = ("guide=none", "elastic_rod.youngs_modulus=2.07e11", "elastic_rod.section_area=1.5e-4", "elastic_rod.section_inertia=3e-9")
FOUR_STROKE = ("combustion.cycle=four_stroke",)
TWO_STROKE = ("combustion.cycle=two_stroke", "combustion.port_opens_deg=110")
COMPRESSOR = ("combustion.cycle=compressor", "combustion.dead_space=0.05", "combustion.suction_pressure=1e5", "combustion.discharge_pressure=4e5",
              "combustion.polytropic_exponent=1.3")


def programs_of_others(run: Runner) -> None:
    """Machines of other programs, against their own equations integrated by a Runge-Kutta method of order 4, and printed digits. Where
    a program's stored result is less exact than that, the manual says so (Numerics)."""
    angles = np.concatenate([np.arange(3600) * 0.05, [180 - 1e-9, 180 + 1e-5], 180 + np.arange(1, 3600) * 0.05, [360 - 1e-5]])
    rows = "".join(f"{a!r},{v6_pressure(np.radians(a)) + 1!r}\n" for a in angles.tolist())
    (run.folder / "v6_pressure.csv").write_text("crank_angle[deg],pressure[bar]\n" + rows)
    rows = "".join(f"{speed!r},{-100 * (speed / 200) ** 2!r}\n" for speed in (np.arange(2001) * 0.5).tolist())
    (run.folder / "v6_load.csv").write_text("speed[rad/s],torque[N.m]\n" + rows)
    angle = float(bare(run(V6)[0])["crank_angle"].iloc[-1])
    # the pressure is a table: kinks of the polynomial lie between its points, 2e-6 of the angle
    check(abs(angle - 346.4738788) < 1e-5, "the V6 of the Modelica library turns as its equations say", f"{angle!r}")
    place = float(bare(run(EXUDYN)[0])["piston_position"].iloc[-1])
    check(abs(place - 1.35506404343) < 1e-10, "the slider-crank of Exudyn moves to the limit of its small steps", f"{place!r}")
    for what, shaft, printed in [
        ("the five discs of Friswell et al.", "inertia = 3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05, stiffness = 12e3, 12e3, 14e3, 10e3",
         (81.21, 141.21, 378.95, 536.36)),
        ("two discs", "inertia = 211.4, 8.3, stiffness = 9.775e6", (176.1,))]:
        summary = run(DISCS.format(shaft=shaft))[1]
        found = [float(summary[f"natural_frequency_{i}"]) for i in range(1, len(printed) + 1)]
        digits = len(str(printed[0]).partition(".")[2])
        check([round(value, digits) for value in found] == list(printed), f"natural frequencies of {what}", str(found))


# equalities

def another_cylinder(run: Runner) -> None:
    """With ideal joints any cylinder may be the full one."""
    def with_full(k: int) -> tuple[pd.DataFrame, dict[str, str]]:
        full = [f"cylinder_{i}.full={'T' if i == k else 'F'}" for i in range(1, 5)]
        phase = {1: 0, 2: -540, 3: -180, 4: -360}[k]
        return run(CASES / "four_dry.nml", *FINE, "joint=none", "contact=none", "friction=none", *full, "integrator.revolutions=0",
                   f"initial.crank_angle_deg={200 + phase + 540}", "integrator.end_time=0.02", "output.interval=1e-4")
    first, one = with_full(2)
    second, other = with_full(4)
    for column in [c for c in first if c in second.columns and c.startswith(("engine", "segment", "damper", "crank_moment", "energy["))]:
        a, b = first[column].to_numpy(), second[column].to_numpy()
        off = np.abs(a - b).max() / np.abs(a).max()
        check(off < 1e-8, f"another cylinder as the full one: {column} is the same", f"{off:.2g}")
    check(one["natural_frequency_1"][:14] == other["natural_frequency_1"][:14], "another cylinder as the full one: the same frequencies")


BODIES = """&mechanism crank_length = 0.04, crank_mass = 1.2, crank_inertia = 0.0018, crank_com = -0.004, 0.0
  rod_length = 0.135, rod_mass = 0.55, rod_inertia = 0.0019, rod_com = 0.04, 0.0, piston_mass = 0.42, gravity = {gravity} /
&drive kind = '{kind}' /
&initial crank_speed = 300.0 /
{cylinders}
&integrator revolutions = 2.0, relative_tolerance = 1.0e-11 /
&output sampling = 'crank_angle', samples_per_revolution = 360, digits = 17 /
"""


def engine(cylinders: str, kind: str = "constant_speed", gravity: float = 0.0) -> str:
    return BODIES.format(cylinders=cylinders, kind=kind, gravity=gravity)


def equalities(run: Runner) -> None:
    boxer = bare(run(engine("&cylinder / \n&cylinder phase_deg = -180.0, bank_deg = -180.0 /"))[0])
    one = bare(run(engine(""))[0])
    scale = one["frame_force_x"].abs().max()
    check(boxer[["engine_force_x", "engine_force_y"]].abs().max().max() < 1e-9 * scale, "a boxer has no force on its frame")

    pair = bare(run(engine("&cylinder / \n&cylinder /", "free", 9.80665))[0])
    half = bare(run(engine("", "free", 9.80665))[0])
    check((pair["crank_speed"] - half["crank_speed"]).abs().max() < 1e-8, "two cylinders in step move as one of double inertia and weight")
    check((pair["engine_force_x"] - 2 * half["frame_force_x"]).abs().max() < 1e-7 * scale, "two in step have twice the force of one")

    rotating, swinging = 0.55 * (1 - 0.04 / 0.135), 0.42 + 0.55 * 0.04 / 0.135
    weight = -(2 * rotating + swinging) * 0.04 / 1.2
    vee = bare(run(engine("&cylinder throw = 1 /\n&cylinder throw = 1, bank_deg = 90.0 /"), f"mechanism.crank_com={weight!r},0")[0]).iloc[:720]
    for column in ("engine_force_x", "engine_force_y"):
        found = order(vee[column].to_numpy(), 1)
        check(found < 1e-7 * scale, f"a balanced V of 90 degrees: no first order of {column}", f"{found:.2g}")
    check(order(vee["engine_force_x"].to_numpy(), 2) > 0.01 * scale, "a balanced V of 90 degrees has a second order")

    alone = run(engine("&cylinder /", "free", 9.80665))[0]
    none = run(engine("", "free", 9.80665))[0]
    check(alone.equals(none), "one cylinder alone is no group at all")
    taken = run(engine("&cylinder / \n&cylinder phase_deg = 90.0 /", "free", 9.80665), "cylinder=none")[0]
    check(taken.equals(none), "--set cylinder=none takes all of them out")

    rows = bare(run(CASES / "inline_four.nml", *FINE)[0])
    off = (rows["crank_moment"] + rows["engine_moment_z"]).abs().max() / rows["crank_moment"].abs().max()
    check(off < 1e-9, "at constant speed the drive takes the roll moment of the engine", f"{off:.2g}")

    text = engine("&cylinder station = 1 /\n&cylinder station = 2, phase_deg = 180.0 /\n"
                  "&crankshaft inertia = 0.01, 0.01, 0.2, stiffness = 1.0e5 /", "free", 9.80665)
    rows, summary = run(text)
    energy = bare(rows)["energy"]
    check((energy - energy.iloc[0]).abs().max() < 1e-9 * energy.iloc[0], "without gas and damping a free shaft keeps its energy")


def limits(run: Runner) -> None:
    """A shaft that is 100 times as stiff is 100 times nearer to the rigid one; a ring is nearer to one made fast as its oil is
    thicker."""
    cylinders = "&cylinder {0} /\n&cylinder {1} phase_deg = 180.0 /"
    stations = cylinders.format("station = 1,", "station = 2,")
    changes = ("output.sampling=time", "combustion.bore=0.08", "combustion.compression_ratio=10", "combustion.heat_capacity_ratio=1.35",
               "combustion.heat=900", "combustion.wiebe_efficiency=5", "combustion.wiebe_form=3", "combustion.start_deg=345", "combustion.duration_deg=50")
    rigid = bare(run(engine(cylinders.format("", ""), "free"), "drive.flywheel_inertia=0.22", *changes)[0])["crank_angle"]
    off = []
    for k in (1e5, 1e7, 1e9):
        shaft = f"{stations}\n&crankshaft inertia = 0.01, 0.01, 0.2, stiffness = {k!r} /"
        off.append((bare(run(engine(shaft, "free"), *changes)[0])["crank_angle"] - rigid).abs().max())
    check(off[0] > 80 * off[1] and 80 < off[1] / off[2] < 120, "a shaft 100 times as stiff is 100 times nearer to the rigid one", str(off))
    shaft = stations + "\n&crankshaft inertia = {0}, 0.01, 0.2, stiffness = 1.0e5 /\n"
    fast = bare(run(engine(shaft.format(0.014), "free"), *changes)[0])["crank_angle"]
    off = []
    for c in (10.0, 100.0, 1000.0):
        ring = f"&damper station = 1, kind = 'viscous', inertia = 0.004, damping = {c!r} /"
        off.append((bare(run(engine(shaft.format(0.01) + ring, "free"), *changes)[0])["crank_angle"] - fast).abs().max())
    check(off[0] > 2 * off[1] > 8 * off[2] > 0, "a ring in thicker oil is nearer to one made fast", str(off))


def energies(run: Runner) -> None:
    """Combinations that no reference has: no energy is lost."""
    base = ("integrator.relative_tolerance=1e-9", "integrator.revolutions=0", "integrator.end_time=0.006")
    rod = ("elastic_rod.youngs_modulus=2.07e11", "elastic_rod.section_area=2e-4", "elastic_rod.section_inertia=4e-9")
    bore = ("guide.kind=clearance", "guide.bore_clearance=1e-4", "guide.skirt_top=0.02", "guide.skirt_bottom=0.02",
            "guide.piston_radius=0.04", "guide.piston_inertia=4e-4", "guide.stiffness=1e8", "guide.coefficient=0.05")
    pin = ("crank_pin.joint.kind=clearance", "crank_pin.joint.clearance=4e-5", "crank_pin.joint.bearing_radius=0.02", "crank_pin.contact.law=hertz")
    for what, changes in {"an elastic rod": rod, "slap": bore, "a loose crank pin": pin,
                          "a ramp": ("drive.kind=constant_speed", "drive.torque=0", "drive.ramp_time=0.004", "drive.ramp_from=150"),
                          "a held station": ("drive.kind=constant_speed", "drive.torque=0", "crankshaft.drive_station=3"),
                          "the speed held at the front": ("drive.kind=constant_speed", "drive.torque=0", "crankshaft.drive_station=1"),
                          "sticking": ("friction.law=coulomb", "friction.static_coefficient=0.1"),
                          "a rubber damper": ("damper_1.kind=rubber", "damper_1.stiffness=4e4"),
                          "a compressor": ("combustion.cycle=compressor", "combustion.dead_space=0.05", "combustion.suction_pressure=1e5",
                                           "combustion.discharge_pressure=4e5", "combustion.polytropic_exponent=1.3")}.items():
        lost = float(run(CASES / "four_dry.nml", *base, *changes)[1]["max_energy_residual_relative"])
        check(lost < 1e-7, f"{what} beside other cylinders: no energy is lost", f"{lost:.2g}")
    rows, summary = run(CASES / "four_dry.nml", *base, "drive.kind=constant_speed", "drive.torque=0", "crankshaft.drive_station=3")
    check(np.ptp(bare(rows)["crank_speed"]) < 1e-12, "a held station of the full cylinder has a constant speed")


# a cylinder axis beside the crank axis

#: The engine of cases/drive/offset_crank.nml with an ideal guide.
SMALL = TOP / "cases" / "drive" / "offset_crank.nml"
OFFSET = "mechanism.axis_offset=0.006"


def offset_linkage(run: Runner) -> None:
    """Stroke, dead centres, ratio of the times down and up, and places of the piston in closed form."""
    for row in pd.read_csv(DATA / "offset_slider_crank.csv").itertuples():
        rows, summary = run(engine(""), "output.sampling=crank_angle", "output.samples_per_revolution=36", f"mechanism.crank_length={row.crank_m!r}",
                            f"mechanism.rod_length={row.rod_m!r}", f"mechanism.axis_offset={row.offset_m!r}")
        place = bare(rows)["piston_position"]
        off = max(abs(place[i] - wanted) for i, wanted in ((3, row.x_30deg_m), (9, row.x_90deg_m), (20, row.x_200deg_m)))
        check(off < 1e-12, "an offset axis: the piston is where the closed form puts it", f"{off:.2g} m with {row.offset_m} m")
        if not row.offset_m:
            check("stroke" not in summary, "without an offset the summary has no dead centres")
            continue
        top, bottom = float(summary["top_dead_centre_angle"]), float(summary["bottom_dead_centre_angle"])
        check(abs(float(summary["stroke"]) - row.stroke_m) < 1e-12, "an offset axis: stroke", summary["stroke"])
        check(max(abs(top - row.angle_tdc_deg), abs(bottom - row.angle_bdc_deg)) < 1e-8, "an offset axis: dead centres", f"{top!r} {bottom!r}")
        check(abs((bottom - top) / (360 - bottom + top) - row.down_over_up) < 1e-10, "an offset axis: time down over time up")


def offset_of_the_pin(run: Runner) -> None:
    """A pin offset in a tight, stiff bore is the same linkage, by equations without an offset of the axis: the piston's centre of mass
    runs on y = 0 and its pin on y = d. What is left is the play of the bore and the stiffness of its walls."""
    same = ("drive.kind=constant_speed", "integrator.revolutions=2", "output.samples_per_revolution=360", "integrator.relative_tolerance=1e-8", "output.digits=15")
    bore = ("guide.kind=clearance", "guide.coefficient=0", "guide.bore_clearance=1e-7", "guide.skirt_top=0.02", "guide.skirt_bottom=0.02", "guide.piston_radius=0.034",
            "guide.piston_inertia=1e-4", "guide.stiffness=1e8", "guide.restitution=0.5", "guide.piston_com=0,-0.008", "combustion=none")
    tight = bare(run(SMALL, *same, *bore, "mechanism.axis_offset=0")[0]).iloc[360:]
    ideal = bare(run(SMALL, *same, "guide=none", "combustion=none", "mechanism.axis_offset=0.008")[0]).iloc[360:]
    for column, allowed in (("piston_position", 1e-5), ("pin_force_x", 5e-3), ("pin_force_y", 1e-2), ("crank_moment", 5e-3)):
        off = float(np.sqrt(((tight[column] - ideal[column]) ** 2).mean() / (ideal[column] ** 2).mean()))
        check(off < allowed, f"a pin offset in a tight bore moves as an offset axis: {column}", f"{off:.2g}")


def offset_chains(run: Runner) -> None:
    """Every chain keeps its energy, with gas and gravity across; the mirror image of a machine, turning backwards, is the same machine."""
    base = ("integrator.relative_tolerance=1e-9", "integrator.revolutions=1", OFFSET, "mechanism.gravity_angle_deg=70", "drive.kind=free", "drive.torque=-3")
    for what, changes in {"ideal pins": ("guide=none",), "a piston pin": LOOSE, "a crank pin": CRANK_PIN, "both pins": (*LOOSE, *CRANK_PIN), "a floating pin": (*LOOSE, *FLOATING),
                          "slap": BORE, "slap with a floating pin": (*BORE, *LOOSE, *FLOATING), "slap with a crank pin": (*BORE, *CRANK_PIN), "an elastic rod": ROD,
                          "an elastic rod with both pins and slap": (*ROD, *LOOSE, *CRANK_PIN, *BORE)}.items():
        lost = float(run(SMALL, *base, *changes)[1]["max_energy_residual_relative"])
        check(lost < 1e-7, f"an offset axis with {what}: no energy is lost", f"{lost:.2g}")
    for gas in (FOUR_STROKE, TWO_STROKE, COMPRESSOR):
        both = []
        for sign in (1, -1):
            rows, summary = run(SMALL, *FINE, *gas, "guide=none", "integrator.revolutions=2.2", "drive.kind=free", f"initial.crank_angle_deg={sign * 100}",
                                f"initial.crank_speed={sign * 377}", f"mechanism.axis_offset={sign * 0.006}", f"mechanism.gravity_angle_deg={sign * 30}",
                                f"mechanism.rod_com=0.025,{sign * 5e-4}", f"mechanism.crank_com=0.002,{sign * 1e-3}", "output.samples_per_revolution=90")
            both.append(bare(rows))
        for column, way in (("piston_position", 1), ("cylinder_pressure", 1), ("guide_force", -1), ("crank_speed", -1)):
            a, b = (one[column].to_numpy() for one in both)
            off = np.abs(a - way * b).max() / np.abs(a).max()
            check(off < 1e-9, f"the mirror image of an offset axis: {column}", f"{off:.2g} with {gas[0]}")


# bearings of a whole engine

def bearings(run: Runner) -> None:
    """Every main bearing and every big end: orbits, pressures, losses against another program; parts of the whole; one cylinder alone."""
    reference = bare(pd.read_csv(DATA / "mains_inline_four.csv"))
    wanted = reference.columns.drop(["time", "crank_angle"])
    loads = [f"main_bearing_{b}_force_{axis}" for b in range(1, 6) for axis in "xy"]
    rows, summary = run(DATA / "mains_inline_four.nml", f"output.columns={', '.join(['time', 'crank_angle', *wanted, *loads])}")
    state = run.result(DATA / "mains_inline_four.nml", "state.nml")
    rows = bare(rows)

    def by_angle(table: pd.DataFrame) -> pd.DataFrame:
        return table.assign(at=np.round(np.degrees(table["crank_angle"]), 6) % 720).drop_duplicates("at").set_index("at")

    found, other = by_angle(rows), by_angle(reference)
    check(len(other) == 176 and set(other.index) <= set(found.index), "mains_inline_four: every row of the reference is there", str(len(found)))
    found = found.loc[other.index]
    off = {column: (found[column] - other[column]).abs().max() / other[column].abs().max() for column in wanted}
    worst = max(off, key=off.get)
    check(off[worst] < 1e-6, "mains_inline_four: all columns are those of the reference", f"{worst}: {off[worst]:.2g}")
    off = max((rows[f"main_bearing_{b}_film_force_{axis}"] - rows[f"main_bearing_{b}_force_{axis}"]).abs().max() for b in range(1, 6) for axis in "xy")
    check(off < 1e-4, "the films of the main bearings carry the columns of their loads", f"{off:.2g} N")

    table = pd.read_csv(DATA / "facts.csv").set_index(["case", "quantity"]).loc["mains_inline_four"]
    for quantity, row in table.iterrows():
        apart = float(summary[quantity.partition("[")[0]]) - row["value"]
        if quantity.startswith("main_bearing_3") and "angle" in quantity:   # it repeats after one revolution
            apart = (apart + 180) % 360 - 180
        check(abs(apart) <= row["tolerance"], f"mains_inline_four: {quantity} is that of the reference", f"{apart:.3g} for {row['tolerance']:.3g}")
    names = [f"main_bearing_{b}" for b in range(1, 6)] + [f"crank_pin_{i}" for i in range(1, 5)]
    total = sum(float(summary[f"{name}_cycle_joint_fmep"]) for name in names)
    check(abs(total / float(summary["cycle_one_way_fmep"]) - 1) < 1e-12, "the bearings' parts add up to their FMEP", f"{total!r}")
    check(summary["cycle_thinnest_bearing"] == "crank_pin_1", "of four equal films the first is named", summary["cycle_thinnest_bearing"])

    again = run(DATA / "mains_inline_four.nml", f"initial.from={state}", "run.until=end", "integrator.revolutions=2", "output.window=all", "initial.goes_on=F")[1]
    off = max(abs(float(again[f"{name}_cycle_min_film_thickness"]) / float(summary[f"{name}_cycle_min_film_thickness"]) - 1) for name in names)
    check(off < 1e-6, "all bearings go on from their state", f"{off:.2g}")
    taken = run(DATA / "mains_inline_four.nml", "main_bearing.joint.numbers='2, 3'", "crank_pin.joint=none")[1]
    for name in ("main_bearing_2_cycle_min_film_thickness", "main_bearing_3_cycle_mean_film_power"):
        check(abs(float(taken[name]) / float(summary[name]) - 1) < 1e-6, f"two bearings alone: {name}", taken[name])
    check("main_bearing_1_cycle_mean_film_power" not in taken and taken["cycle_thinnest_bearing"] == "main_bearing_3", "other numbers are not there")

    one = (DATA / "mains_inline_four.nml").read_text()
    one = "\n".join(line for line in one.splitlines() if not line.startswith(("&cylinder", "&joint place = 'crank", "&output"))) + "\n&output digits = 17 /\n"
    half = run(one.replace("numbers = 'all'", "load_share = 0.5"))[1]
    alone = run(one.replace("&combustion", "&cylinder /\n&combustion").replace("numbers = 'all'", "numbers = '1'"))[1]
    for name in ("cycle_min_film_thickness", "cycle_mean_film_power", "cycle_max_film_pressure"):
        check(alone[f"main_bearing_1_{name}"] == half[f"main_bearing_{name}"], f"a main bearing of one cylinder has half of its load: {name}", alone[f"main_bearing_1_{name}"])


def refusals(run: Runner) -> None:
    six, dry, four = CASES / "six_mwm.nml", CASES / "four_dry.nml", CASES / "inline_four.nml"
    mains = DATA / "mains_inline_four.nml"
    for case, changes, says in [
        (six, ["crankshaft.stiffness=1e6,2e6"], "must have 8 values or one, not 2"),
        (six, ["crankshaft.inertia=0.1"], "must have 2 to 16 values"),
        (six, ["cylinder_2.station=12"], "must be <= 9"),
        (six, ["cylinder_2.station=0"], "must be > 0"),
        (six, ["cylinder_2.phase_deg=2000"], ">= -1440 and <= 1440"),
        (six, ["crankshaft.flywheel_inertia=0.1"], "must not be given together with the list inertia"),
        (six, ["crankshaft=none"], "needs the lists inertia and stiffness"),
        (six, ["crankshaft.inertia=0,0,0.04,0.03,0.04,0.04,0.03,0.04,2"], "must be > 0 for a station on which no cylinder"),
        (six, ["crankshaft.drive_station=10"], "must be <= 9"),
        (six, ["crankshaft.loss_frequency=0"], "must be > 0 (rad/s)"),
        (dry, ["cylinder_1.full=T"], "must be .true. in one cylinder alone"),
        (dry, ["damper_1.stiffness=1e4"], "is for kind = 'rubber' alone"),
        (dry, ["damper_1.station=7"], "must be <= 6"),
        (dry, ["cylinder_2.piston_mass=1"], "must be that of &mechanism"),
        (dry, ["cylinder_1.throw=3"], "without a gap"),
        (dry, ["cylinder_3.throw=2"], "both must have one station"),
        (four, ["cylinder_2.station=2"], "needs the lists inertia and stiffness"),
        (four, ["cylinder_2.throw=1", "cylinder_2.crank_mass=1"], "another cylinder has the crank of this throw"),
        (four, ["damper_1.station=1", "damper_1.inertia=0.01", "damper_1.stiffness=1e4"], "needs the lists inertia and stiffness"),
        (four, ["cylinder_7.phase_deg=10"], "there is no cylinder_5 before it"),
        (four, [*COMPRESSOR, "cylinder_2.heat_scale=0.5"], "a compressor or a measured pressure has none"),
        (six, ["cylinder_2.heat_scale=0"], "a compressor or a measured pressure has none"),
        (four, ["crankshaft.flywheel_inertia=1", "crankshaft.torsional_stiffness=1e5"], "needs one cylinder"),
        (engine("&cylinder /\n" * 17), [], "at most 16 of these groups"),
        (mains, ["main_bearing.joint.numbers=7"], "numbers = 7: must be all or numbers from 1 to 5: the shaft has 4 throws"),
        (mains, ["main_bearing.joint.numbers='2, x'"], "must be all or numbers from 1 to 5"),
        (mains, ["main_bearing.joint.numbers='2, 3, 2'"], "must not have the same number twice"),
        (mains, ["crank_pin.joint.numbers='0, 1'"], "must be all or numbers from 1 to 4: there are 4 cylinders"),
        (mains, ["main_bearing.joint.load_share=0.5"], "must be 1 with further cylinders: the throws of the shaft give the load"),
        (mains, ["crank_pin.joint.kind=clearance"], "only the full cylinder has joints with clearance"),
        (mains, ["cylinder=none", "main_bearing.joint=none"], "needs the groups cylinder: there is one cylinder alone"),
        (four, ["joint.numbers=all"], "is for place = 'main_bearing' or 'crank_pin' alone"),
        (SMALL, ["mechanism.axis_offset=0.07"], "axis_offset = 0.07: must be shorter than rod_length - crank_length, less clearances, = 0.0615: the crank could not turn"),
        (SMALL, ["mechanism.axis_offset=-0.062"], "axis_offset = -0.062: must be shorter than"),
        (SMALL, [*LOOSE, "guide=none", "mechanism.axis_offset=0.06149"], "less clearances, = 0.06148"),
        (SMALL, ["combustion.start_deg=181"], "start_deg = 181: must be >= 181.57"),
        (SMALL, ["mechanism.axis_offset=-0.004", "combustion.duration_deg=194"], "duration_deg = 194: must be <= 193.4"),
        (SMALL, [*TWO_STROKE, "combustion.port_opens_deg=179", "mechanism.axis_offset=-0.02"], "port_opens_deg = 179: must be below the angle of the bottom dead centre"),
    ]:
        message = run.refused(case, *changes)
        check(says in message and message.count("\n") == 1, f"refused with one line: {' '.join(changes)[:60]}", message[:300])


    # a gas group before the cylinders is none of them
    text = six.read_text()
    gas = text[text.index("&cylinder_pressure"):text.index("&run")]
    moved = run.folder / "gas_first.nml"
    moved.write_text(text.replace(gas, "").replace("&cylinder station = 3", gas.replace("mwm_pressure.csv", str(CASES / "mwm_pressure.csv")) + "&cylinder station = 3", 1))
    found = subprocess.run([run.program, "--check", moved], capture_output=True, text=True, check=False)
    check(found.returncode == 0 and "displacement 6 x 1186 = 7118 cm3; cylinders: 6" in found.stdout, "a gas group before the cylinders", found.stderr[:200])


def misfire(run: Runner) -> None:
    """A cylinder without heat compresses its charge without loss, p V^g constant, and does no work in a cycle; the others do what they did."""
    angles = ("output.sampling=crank_angle", "output.samples_per_revolution=720", "output.columns=standard, cylinder_3_gas_force, cylinder_4_gas_force")
    fired, of_four = run(CASES / "inline_four.nml", *FINE, *angles)
    found, of_three = run(CASES / "misfire.nml", *FINE, *angles)
    same, _ = run(CASES / "inline_four.nml", *FINE, *angles, *(f"cylinder_{k}.heat_scale=1" for k in range(1, 5)))
    check(same.equals(fired), "heat_scale = 1 is no factor at all")
    fired, found = bare(fired), bare(found)
    check((found["cylinder_4_gas_force"] - fired["cylinder_4_gas_force"]).abs().max() < 1e-9 * fired["cylinder_4_gas_force"].abs().max(),
          "a misfire: the other cylinders fire as before")
    q = (np.degrees(found["crank_angle"].to_numpy()) - 180) % 720   # of cylinder 3, from its own gas-exchange dead centre
    area, bottom = np.pi / 4 * 0.08**2, 0.08 * (1 + 1 / 9)
    depth = 0.08 / 9 + 0.175 - 0.04 * np.cos(np.radians(q)) - np.sqrt(0.135**2 - (0.04 * np.sin(np.radians(q))) ** 2)
    closed = (q > 180.1) & (q < 539.9)
    wanted = (95000 * (bottom / depth[closed]) ** 1.35 - 101325) * area
    off = np.abs(found["cylinder_3_gas_force"].to_numpy()[closed] - wanted).max() / wanted.max()
    check(closed.sum() > 700 and off < 1e-9, "a misfire: the charge is compressed without heat", f"{off:.2g}")
    ratio = float(of_three["cycle_work_gas"]) / float(of_four["cycle_work_gas"])
    check(abs(ratio - 0.75) < 1e-8, "a misfire: three cylinders of four do work", f"{ratio!r}")
    moment = found["crank_moment"].to_numpy()[:1440]
    check(order(moment, 0.5) > 0.1 * abs(moment.mean()), "a misfire: the moment has the order 0.5")
    full, dead = run(CASES / "misfire.nml", *FINE, *angles, "cylinder_1.full=F", "cylinder_3.full=T", "output.columns=standard, cylinder_1_gas_force")
    full = bare(full)
    at = (np.degrees(full["crank_angle"].to_numpy())) % 720
    depth = 0.08 / 9 + 0.175 - 0.04 * np.cos(np.radians(at)) - np.sqrt(0.135**2 - (0.04 * np.sin(np.radians(at))) ** 2)
    closed = (at > 180.1) & (at < 539.9)
    off = np.abs(full["cylinder_pressure"].to_numpy()[closed] / (95000 * (bottom / depth[closed]) ** 1.35) - 1).max()
    check(closed.sum() > 700 and off < 1e-9, "a full cylinder that misfires", f"{off:.2g}")
    check(float(dead["cycle_heat_released"]) == 0, "a full cylinder that misfires releases no heat", dead["cycle_heat_released"])


def resumes(run: Runner) -> None:
    """A run that goes on from a state at a bound of two cylinders ends as the whole run."""
    whole = run(CASES / "inline_four.nml", *FINE, "integrator.revolutions=3", "drive.kind=free", "drive.flywheel_inertia=0.5")
    run(CASES / "inline_four.nml", *FINE, "integrator.revolutions=1.5", "drive.kind=free", "drive.flywheel_inertia=0.5")
    state = run.result(CASES / "inline_four.nml", "state.nml")
    rest = run(CASES / "inline_four.nml", *FINE, "integrator.revolutions=3", "drive.kind=free", "drive.flywheel_inertia=0.5", f"initial.from={state}")
    a, b = bare(whole[0]).iloc[-1], bare(rest[0]).iloc[-1]
    check(abs(a["crank_speed"] - b["crank_speed"]) < 1e-8 and abs(a["time"] - b["time"]) < 1e-12, "a run goes on across a bound of two cylinders",
          f"{a['crank_speed']!r} {b['crank_speed']!r}")
    run(CASES / "four_dry.nml", *FINE, "integrator.revolutions=0", "integrator.end_time=0.006")
    state = run.result(CASES / "four_dry.nml", "state.nml")
    rest = run(CASES / "four_dry.nml", *FINE, "integrator.revolutions=0", "integrator.end_time=0.012", f"initial.from={state}")
    whole = run(CASES / "four_dry.nml", *FINE, "integrator.revolutions=0", "integrator.end_time=0.012")
    a, b = bare(whole[0]).iloc[-1], bare(rest[0]).iloc[-1]
    for column in ("segment_1_torque", "damper_1_speed", "station_6_twist", "eccentricity_y"):
        check(abs(a[column] - b[column]) < 1e-6 * max(abs(a[column]), 1e-9), f"a run goes on with its shaft: {column}", f"{a[column]!r} {b[column]!r}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=None)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run = Runner(options.program or str(release_program()), Path(folder))
        for part in (references, facts, programs_of_others, another_cylinder, equalities, limits, energies, offset_linkage, offset_of_the_pin,
                     offset_chains, bearings, misfire, refusals, resumes):
            part(run)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
