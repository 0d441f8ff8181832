#!/usr/bin/env python3
"""Bearings of kind quasi_static as a user runs them: closed forms of the short film, traces and answers of an independent program, one
way against the full scene, limits, symmetries, and what is refused.

    tests/test_bearings.py [--program PATH]

Needs the standard library alone. Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "tests"))

from assertions import Assertions
from program_runs import run as run_and_tell
from program_runs import summary_of

assertions = Assertions()
check = assertions.check
run = partial(run_and_tell, quiet=True)
CASES = TOP / "cases" / "bearings"
DATA = TOP / "data" / "bearing"
EXACT = ("integrator.relative_tolerance=1e-12", "output.digits=17")
TO_THE_END = ("run.until=end", "output.samples_per_revolution=360")
#: The bearing of closed.csv: pin of 20 mm radius, 16 mm long, clearance 30 um, 11 mPa s.
CLOSED = """&bearing_load table='one.csv', period_deg=360, frame='{frame}', journal='{journal}', bearing='{bearing}', factor={load!r} /
&initial crank_speed={speed!r}, eccentricity={x!r},{y!r} /
&joint kind='quasi_static', clearance=30 um, bearing_radius=20.03 mm, bearing_length=16 mm /
&lubrication law='finite_bearing', variant='{variant}', viscosity=0.011 {more} /
&integrator end_time={end!r}, relative_tolerance={tolerance} /
&output interval={end!r}, digits=17, columns='time, standard, film_power, film_side_flow, max_film_pressure' /
"""
#: Speed of the crank, journal, bearing and frame of the cases of closed.csv.
TURNING = {"steady load, journal turns": (300.0, "crank", "fixed", "fixed"),
           "load turns with the journal": (300.0, "crank", "fixed", "crank"),
           "journal and bearing at rest, load turns": (150.0, "fixed", "fixed", "crank"),
           "journal and bearing turn alike, load at rest": (150.0, "crank", "crank", "fixed"),
           "squeeze from the centre": (0.0, "fixed", "fixed", "fixed"),
           "squeeze from the centre, load at half the speed of the journal": (150.0, "crank", "crank", "crank")}


def rows_of(path: Path) -> list[dict[str, float]]:
    with path.open(newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def good(done: subprocess.CompletedProcess, name: str) -> bool:
    check(done.returncode == 0, f"{name} runs", done.stderr)
    return done.returncode == 0


def last_row(program: Path, folder: Path, **values: object) -> dict[str, float]:
    """The last row of a bearing like that of closed.csv under a constant load."""
    settings = {"x": 0.0, "y": 0.0, "variant": "short", "more": "", "tolerance": "1e-12"} | values
    (folder / "one.csv").write_text("crank_angle[deg],load[N]\n0,1\n180,1\n")
    (folder / "closed.nml").write_text(CLOSED.format(**settings))
    done = run(program, folder / "closed.nml", folder)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return rows_of(folder / "closed.csv")[-1]


def near(found: float, wanted: float, tolerance: float, name: str) -> None:
    """Compare relative to the wanted value."""
    check(abs(found - wanted) <= tolerance * abs(wanted), name, f"{found!r}, wanted {wanted!r}")


def check_closed_forms(program: Path, folder: Path) -> None:
    """Ocvirk's locus, turning loads and pure squeeze, integrated from the centre or from near the centre of the whirl."""
    with (DATA / "closed.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["case"] in TURNING]
    check(len(rows) == 48, "all rows of closed.csv")
    for row in rows:
        speed, journal, bearing, frame = TURNING[row["case"]]
        ratio, load = float(row["eccentricity_ratio"]), float(row["load[N]"])
        squeezes, angle = row["time[s]"] != "", math.radians(float(row["angle_from_load_to_eccentricity[deg]"]))
        end = float(row["time[s]"]) if squeezes else 1.0 if ratio < 0.2 else 0.3 if ratio < 0.4 else 0.15
        start = 0.0 if squeezes else 0.9 * ratio * 30e-6
        last = last_row(program, folder, frame=frame, journal=journal, bearing=bearing, load=load, speed=speed, end=end,
                        x=start * math.cos(0.9 * angle), y=start * math.sin(0.9 * angle))
        name = f"{row['case']}: {ratio}"
        loose = 1e-9 if ratio > 0.99 else 1e-10   # turning so long, rounding of the angle counts
        near(last["eccentricity_ratio[-]"], ratio, loose, name)
        found = math.atan2(last["eccentricity_y[m]"], last["eccentricity_x[m]"]) - (speed * end if frame == "crank" else 0)
        difference = (found - angle + math.pi) % (2 * math.pi) - math.pi
        check(abs(math.degrees(difference)) <= (1e-6 if ratio > 0.98 else 2e-8), f"{name}: angle", f"{math.degrees(difference)} deg")
        if not squeezes:
            near(last["film_power[W]"], float(row["film_power[W]"]), 1e-10, f"{name}: power")
            near(last["film_side_flow[m3/s]"], float(row["side_flow[m3/s]"]), 1e-10, f"{name}: flow")


def check_finite_film(program: Path, folder: Path) -> None:
    """Steady load on the film of finite length, solved at every evaluation, L/D 0.5 and 1: load, angle, flow and peak."""
    c, radius, mu, speed = 30e-6, 0.02, 0.011, 300.0
    with (DATA / "steady_finite.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        ratio, slender = float(row["eccentricity_ratio"]), float(row["L_over_D"])
        if slender != 0.5 or ratio not in (0.5, 0.9):
            continue
        length = 2 * radius * slender
        unit = mu * speed * length * radius**3 / c**2
        angle = math.radians(float(row["angle_from_load_to_eccentricity[deg]"]))
        text = CLOSED.replace("bearing_length=16 mm", f"bearing_length={length!r}")
        (folder / "one.csv").write_text("crank_angle[deg],load[N]\n0,1\n180,1\n")
        (folder / "finite.nml").write_text(text.format(
            frame="fixed", journal="crank", bearing="fixed", load=unit * float(row["load_over_mu_omega_L_R3_per_c2"]), speed=speed,
            x=ratio * c * math.cos(angle), y=ratio * c * math.sin(angle), variant="table", tolerance="1e-7",
            more=f", cavitation='{row['condition']}', film_points=128, table_points=33", end=0.1))
        name = f"finite film {row['condition']} {ratio}"
        if not good(run(program, folder / "finite.nml", folder), name):
            continue
        last = rows_of(folder / "finite.csv")[-1]
        near(last["eccentricity_ratio[-]"], ratio, 1e-3, name)
        found = math.degrees(math.atan2(last["eccentricity_y[m]"], last["eccentricity_x[m]"]))
        check(abs(found - math.degrees(angle)) < 0.1, f"{name}: angle", f"{found}")
        near(last["film_side_flow[m3/s]"], float(row["side_flow_over_c_R2_omega"]) * c * radius**2 * speed, 3e-3, f"{name}: flow")
        near(last["max_film_pressure[Pa]"], float(row["p_max_over_mu_omega_R2_per_c2"]) * mu * speed * radius**2 / c**2, 5e-3,
             f"{name}: peak")


def compare(found: list[dict[str, float]], wanted: list[dict[str, float]], tolerance: dict[str, float], name: str) -> None:
    """Compare columns at equal times, relative to their ranges; `tolerance` is by parts of their names, '' for the others."""
    at = {round(row["time[s]"], 9): row for row in found}
    pairs = [(at[round(row["time[s]"], 9)], row) for row in wanted if round(row["time[s]"], 9) in at]
    check(len(pairs) >= len(wanted) - 1, f"{name}: rows", f"{len(pairs)} of {len(wanted)}")
    for column in wanted[0]:
        if column not in found[0] or column in ("time[s]", "crank_angle[rad]"):
            continue
        values = [b[column] for _, b in pairs]
        size = max(values) - min(values) or 1.0
        allowed = next((limit for part, limit in tolerance.items() if part in column and part), tolerance[""])
        error = max(abs(a[column] - b[column]) for a, b in pairs) / size
        check(error <= allowed, f"{name}: {column}", f"{error:.2g}, allowed {allowed}")


def check_traces(program: Path, folder: Path) -> None:
    """Whole traces, and the answers of a settled cycle, against an independent program."""
    columns = "output.columns=time, standard, {0}film_power, {0}film_side_flow, {0}max_film_pressure"
    runs = (("big_end", "crank_pin_", ("integrator.revolutions=4",), {"": 1e-9}, "big_end"),
            ("flores2006", "", ("integrator.revolutions=8", "output.start_time=0.18"), {"": 1e-9}, "flores2006"),
            ("rough", "crank_pin_", ("integrator.revolutions=2", "wear=none"), {"": 1e-7, "asperity_force": 1e-6}, "rough"),
            ("big_end", "crank_pin_", ("integrator.revolutions=2", "lubrication.variant=table", "lubrication.cavitation=gumbel",
                                       "integrator.relative_tolerance=1e-8", "lubrication.table_points=129"),
             {"": 1e-4, "side_flow": 4e-4}, "big_end_finite"))
    for case, prefix, settings, tolerance, reference in runs:
        done = run(program, CASES / f"{case}.nml", folder, *EXACT, *TO_THE_END, columns.format(prefix), *settings)
        if good(done, reference):
            compare(rows_of(folder / f"{case}.csv"), rows_of(DATA / f"{reference}.csv"), tolerance, reference)
    with (DATA / "facts.csv").open(newline="") as file:
        facts = list(csv.DictReader(file))
    for case, prefix in (("big_end", "crank_pin_"), ("flores2006", "")):
        if not good(run(program, CASES / f"{case}.nml", folder, *EXACT, "run.periodic_tolerance=1e-9"), f"{case}, settled"):
            continue
        summary = summary_of(folder / f"{case}.summary.csv")
        check(float(summary["crank_revolutions"]) <= 16, f"{case} settles", summary["crank_revolutions"])
        check(summary["cycle_is_settled"] == "yes", f"{case} is settled")
        for fact in (fact for fact in facts if fact["case"] == case):
            name = prefix + fact["quantity"]
            if name not in summary:
                check(fact["quantity"] == "cycle_mean_load", f"{name} is in the summary")
            elif fact["unit"] == "deg":
                check(abs(float(summary[name]) - float(fact["value"])) < 2e-3, name, f"{summary[name]}, wanted {fact['value']}")
            else:
                near(float(summary[name]), float(fact["value"]), 2e-8, name)
    for start in ("0,0.9", "0.94,0", "-0.97,0"):
        setting = "initial.crank_pin_eccentricity=" + ",".join(str(float(part) * 25e-6) for part in start.split(","))
        if good(run(program, CASES / "big_end.nml", folder, *EXACT, "run.periodic_tolerance=1e-9", setting), f"from {start}"):
            summary = summary_of(folder / "big_end.summary.csv")
            near(float(summary["crank_pin_cycle_min_film_thickness"]), 3.22850233833e-6, 1e-9, f"the same orbit from {start}")
            check(float(summary["crank_revolutions"]) <= 16, f"within 8 cycles from {start}")


def check_one_way(program: Path, folder: Path) -> None:
    """The mechanism does not feel the bearing: its columns are the same bytes. The full scene, with clearance, is near."""
    ideal = run(program, CASES / "big_end.nml", folder / "ideal", *TO_THE_END, "integrator.revolutions=2", "crank_pin.joint.kind=ideal",
                "crank_pin.joint.clearance=0", "lubrication=none", "output.digits=17")
    carried = run(program, CASES / "big_end.nml", folder / "carried", *TO_THE_END, "integrator.revolutions=2", "output.digits=17")
    if good(ideal, "ideal") and good(carried, "carried"):
        with (folder / "ideal" / "big_end.csv").open(newline="") as one, (folder / "carried" / "big_end.csv").open(newline="") as two:
            pairs = list(zip(csv.DictReader(one), csv.DictReader(two)))
        same = all(a[name] == b[name] for a, b in pairs for name in a if name != "energy_residual[J]")
        check(len(pairs) == 721 and same, "the mechanism's own columns are the same bytes")
        a, b = (summary_of(folder / name / "big_end.summary.csv") for name in ("ideal", "carried"))
        lost = float(b["crank_pin_cycle_mean_film_power"])
        check(lost > 100, "the bearing has a loss")
        swept = 0.09*math.pi/4*0.082**2   # stroke and bore of the case [m3]
        allowed = 3e-6*float(a["cycle_indicated_power"])/lost   # both works are integrated with the tolerance 1e-6
        near(float(a["cycle_brake_power"]) - float(b["cycle_brake_power"]), lost, allowed, "the brake power is less by the loss of the bearing")
        near((float(b["cycle_fmep"]) - float(a["cycle_fmep"]))*swept, lost*float(b["cycle_duration"]), allowed, "and the FMEP larger")
        near(float(b["cycle_one_way_fmep"])*swept, lost*float(b["cycle_duration"]), 1e-8, "this part of it has a row")
        notes = " ".join(value for name, value in b.items() if name.startswith("note_"))
        check("not fed back" in notes and "not fed back" not in " ".join(a.values()), "a note says that it is not fed back", notes)
    full = run(program, CASES / "big_end.nml", folder / "full", "crank_pin.joint.kind=clearance", "lubrication.report=T",
               "run.until=end", "integrator.revolutions=8", "integrator.relative_tolerance=1e-8")
    carried = run(program, CASES / "big_end.nml", folder / "carried", "integrator.relative_tolerance=1e-8")
    if good(full, "full scene") and good(carried, "one way"):
        a, b = (summary_of(folder / name / "big_end.summary.csv") for name in ("full", "carried"))
        for name, allowed in (("min_film_thickness", 1e-3), ("max_film_pressure", 1e-3), ("mean_film_power", 3e-3),
                              ("mean_film_side_flow", 3e-3)):
            near(float(b["crank_pin_cycle_" + name]), float(a["crank_pin_cycle_" + name]), allowed, f"one way: {name}")


def check_symmetries(program: Path, folder: Path) -> None:
    """Twice the load with twice the viscosity, and twice both speed and load, give the same orbit; a mirrored load a mirrored one;
    frames and directions agree; rigid walls with an elastic film; auto stays with the explicit method."""
    def orbit(name: str, *settings: str) -> list[dict[str, float]]:
        done = run(program, CASES / "main_bearing.nml", folder / name, *EXACT, *TO_THE_END, "integrator.revolutions=2",
                   "output.sampling=crank_angle", "lubrication.oil=''", "lubrication.temperature=0", *settings)
        return rows_of(folder / name / "main_bearing.csv") if good(done, name) else []

    def differ(a: list[dict[str, float]], b: list[dict[str, float]], sign: float = 1) -> float:
        return max((abs(p[x] - q[x]) + abs(p[y] - sign * q[y]) for p, q in zip(a, b)), default=1) / 28e-6

    x, y = "eccentricity_x[m]", "eccentricity_y[m]"
    one = orbit("one", "lubrication.viscosity=0.01")
    check(len(one) == 721, "rows of the orbit")
    check(differ(one, orbit("twice", "lubrication.viscosity=0.02", "bearing_load.factor=2")) < 1e-9, "load and viscosity doubled")
    check(differ(one, orbit("fast", "lubrication.viscosity=0.01", "bearing_load.factor=2", "initial.crank_speed=6000 rpm")) < 1e-9,
          "speed and load doubled")
    turned = orbit("turned", "lubrication.viscosity=0.01", "bearing_load.direction_deg=90")
    off = max((abs(p[x] - q[y]) + abs(p[y] + q[x]) for p, q in zip(one, turned)), default=1) / 28e-6
    check(off < 1e-7, "load turned by 90 degrees", f"{off:.1e}")   # sine and cosine round otherwise there: 1.3e-9
    table = (CASES / "main_bearing.load.csv").read_text().splitlines()
    rows = [line.split(",") for line in table[1:]]
    (folder / "mirror.csv").write_text(table[0] + "\n" + "".join(f"{-float(a)},{b},{-float(c)}\n" for a, b, c in reversed(rows)))
    mirror = orbit("mirror", "lubrication.viscosity=0.01", f"bearing_load.table={folder}/mirror.csv", "initial.crank_speed=-3000 rpm")
    check(differ(one, mirror, -1) < 1e-7, "mirrored load, crank backwards")
    done = run(program, CASES / "elastic_pin.nml", folder / "soft", *EXACT, "lubrication.pressure_viscosity=0")
    rigid = run(program, CASES / "elastic_pin.nml", folder / "rigid", *EXACT, "lubrication.pressure_viscosity=0",
                "lubrication.elastic_film=F", "contact=none")
    if good(done, "elastic walls") and good(rigid, "rigid walls"):
        pairs = list(zip(rows_of(folder / "soft" / "elastic_pin.csv"), rows_of(folder / "rigid" / "elastic_pin.csv")))
        largest = max(abs(a["film_eccentricity_x[m]"] - b[x]) + abs(a["film_eccentricity_y[m]"] - b[y]) for a, b in pairs)
        check(largest < 1e-9 * 10e-6, "the film between elastic walls moves as between rigid ones", f"{largest:.2g} m")
    for case in ("big_end", "flores2006", "main_bearing", "rough", "elastic_pin"):
        for tolerance in ("1e-4", "1e-6", "1e-9"):
            if good(run(program, CASES / f"{case}.nml", folder / "auto", f"integrator.relative_tolerance={tolerance}"), case):
                summary = summary_of(folder / "auto" / f"{case}.summary.csv")
                check(summary["method_switches"] == "0" and "jacobians" not in summary, f"{case} at {tolerance}: explicit")
    done = run(program, CASES / "flores2006.nml", folder / "radau", "integrator.method=radau", "integrator.relative_tolerance=1e-8")
    if good(done, "radau"):
        near(float(summary_of(folder / "radau" / "flores2006.summary.csv")["cycle_max_eccentricity_ratio"]), 0.8186432136727, 1e-6, "radau")


def check_going_on(program: Path, folder: Path) -> None:
    """A run from the state of another one is its second half; a resolved case gives the same bytes."""
    settings = ("run.until=end", "output.digits=17")
    for case in ("flores2006", "rough"):
        whole = run(program, CASES / f"{case}.nml", folder / "whole", *settings, "integrator.revolutions=4")
        half = run(program, CASES / f"{case}.nml", folder / "half", *settings, "integrator.revolutions=2")
        rest = run(program, CASES / f"{case}.nml", folder / "rest", *settings, "integrator.revolutions=4",
                   f"initial.from={folder}/half/{case}.state.nml")
        again = run(program, folder / "whole" / f"{case}.resolved.nml", folder / "again")
        if all([good(whole, case), good(half, case), good(rest, case), good(again, case)]):
            a, b = rows_of(folder / "whole" / f"{case}.csv")[-1], rows_of(folder / "rest" / f"{case}.csv")[-1]
            name = next(name for name in a if name.endswith("eccentricity_ratio[-]"))
            near(b[name], a[name], 1e-6, f"{case} goes on")
            check((folder / "again" / f"{case}.resolved.csv").read_bytes() == (folder / "whole" / f"{case}.csv").read_bytes(),
                  f"{case}: the resolved case gives the same bytes")


#: Case, settings that are refused, and what the message must contain.
REFUSED = (
    ("big_end", ("lubrication=none",), "needs the group lubrication"),
    ("big_end", ("lubrication.law=oscillating_film", "lubrication.variant=bearing_frame", "lubrication.kinematic_viscosity=1e-5"),
     "depends on the velocity"),
    ("big_end", ("lubrication.law=pinkus_sternlicht", "lubrication.variant=as_printed"), "depends on the velocity"),
    ("big_end", ("contact.law=hertz",), "unless elastic_film"),
    ("big_end", ("crank_pin.friction.law=coulomb", "crank_pin.friction.coefficient=0.1"), "not for kind = 'quasi_static'"),
    ("big_end", ("lubrication.transition=weighted", "lubrication.transition_depth=1e-6"), "must be switch"),
    ("big_end", ("crank_pin.wear.rate=1e-15,0",), "needs surfaces that touch"),
    ("big_end", ("crank_pin.joint.clearance=0",), "clearance"), ("big_end", ("crank_pin.joint.bearing_length=0",), "bearing_length"),
    ("big_end", ("crank_pin.joint.load_share=0.5",), "main_bearing"),
    ("big_end", ("initial.crank_pin_eccentricity=2.6e-5,0",), "clearance"),
    ("big_end", ("initial.crank_pin_eccentricity_rate=1,0",), "follows from the load"),
    ("big_end", ("main_bearing.joint.kind=clearance", "main_bearing.joint.clearance=1e-5", "main_bearing.joint.bearing_radius=0.02",
                 "main_bearing.joint.bearing_length=0.02"), "ideal or quasi_static"),
    ("big_end", ("main_bearing.joint.kind=quasi_static", "main_bearing.joint.clearance=1e-5", "main_bearing.joint.bearing_radius=0.02",
                 "main_bearing.joint.bearing_length=0.02", "main_bearing.joint.load_share=1.5"), "load_share"),
    ("flores2006", ("mechanism.gravity=3",), "is for a mechanism"), ("flores2006", ("drive.torque=3",), "is for a mechanism"),
    ("flores2006", ("drive.kind=free",), "constant_speed"), ("flores2006", ("guide.kind=friction",), "is for a mechanism"),
    ("flores2006", ("joint.kind=ideal",), "quasi_static"), ("flores2006", ("bearing_load.journal=rod",), "crank_to_rod"),
    ("flores2006", ("bearing_load.period_deg=700",), "multiple of 360"), ("flores2006", ("bearing_load.table=none.csv",), "none.csv"),
    ("flores2006", ("bearing_load.table=",), "without load"), ("flores2006", ("bearing_load.load=1,0",), "cannot be combined with table"),
    ("flores2006", ("bearing_load.frame=pin",), "frame"), ("flores2006", ("bearing_load.period_deg=360",), "more than its period"),
    ("flores2006", ("run.period_revolutions=1",), "period_revolutions"), ("flores2006", ("bearing_load.factor=0",), "factor"),
    ("flores2006", ("bearing_load.crank_to_rod=1.5",), "crank_to_rod"))
#: Tables of a load that are refused, and a part of the message.
HEAD = "crank_angle[deg],load[N]\n"
TABLES = {"empty": ("", "header"), "one row": (HEAD + "0,1\n", "two rows"), "a word": (HEAD + "0,1\n90,x\n", "load"),
          "not a number": (HEAD + "0,1\n90,nan\n", "nan"), "infinite": (HEAD + "0,1\n90,inf\n", "inf"),
          "a gap": (HEAD + "0,1\n90,\n", "missing"), "falling": (HEAD + "0,1\n90,1\n45,1\n", "increasing"),
          "twice": (HEAD + "0,1\n90,1\n90,2\n", "already given"), "close": (HEAD + "0,1\n90,1\n90.0000001,2\n", "1e-6 degrees"),
          "too long": (HEAD + "0,1\n90,1\n800,2\n", "more than its period"), "open": (HEAD + "0,1\n90,1\n720,2\n", "first row"),
          "only the period": (HEAD + "0,1\n720,1\n", "second row"), "heavy": (HEAD + "0,1\n90,2e12\n", "1e12"),
          "wrong unit": ("crank_angle[deg],load[kg]\n0,1\n90,1\n", "kN"), "no unit": ("crank_angle,load\n0,1\n90,1\n", "unit"),
          "three columns": ("crank_angle[deg],load[N],load_y[N]\n0,1,1\n90,1,1\n", "load_x"),
          "swapped": ("crank_angle[deg],load_y[N],load_x[N]\n0,1,1\n90,1,1\n", "load_x"),
          "four columns": ("a[deg],b[N],c[N],d[N]\n0,1,1,1\n", "two columns"), "short row": (HEAD + "0,1\n90\n", "two columns")}


def check_refused(program: Path, folder: Path) -> None:
    """Wrong settings and tables end with status 3, one line, and no result; other units are the same load."""
    for case, settings, word in REFUSED:
        done = run(program, CASES / f"{case}.nml", folder / "refused", *settings)
        check(done.returncode == 3 and word in done.stderr and done.stderr.count("\n") == 1, f"refused: {case} {settings}", done.stderr)
    for name, (table, word) in TABLES.items():
        (folder / "bad.csv").write_text(table)
        done = run(program, CASES / "flores2006.nml", folder / "refused", f"bearing_load.table={folder}/bad.csv")
        check(done.returncode == 3 and word in done.stderr and done.stderr.count("\n") == 1, f"refused table: {name}", done.stderr)
    check(not (folder / "refused").exists(), "no result of a refused case")
    extremes = []
    for name, table in {"kN": "crank_angle[deg],load[kN]\n0,1\n90,-2\n200,1.5\n720,1\n",
                        "N": 'phi[rad] , "load_x [N]","load_y[N]"\n' + "".join(
                            f"{math.radians(a)!r},{b},0\n" for a, b in ((0, 1000), (90, -2000), (200, 1500)))}.items():
        (folder / "good.csv").write_text(table)
        if good(run(program, CASES / "flores2006.nml", folder, f"bearing_load.table={folder}/good.csv"), f"load in {name}"):
            extremes.append(float(summary_of(folder / "flores2006.summary.csv")["cycle_max_eccentricity_ratio"]))
    check(len(extremes) == 2 and abs(extremes[0] - extremes[1]) < 1e-6, "other units, the same orbit", str(extremes))


def check_extremes(program: Path, folder: Path) -> None:
    """Bearings at the ends of all ranges finish, or stop with a reason and all rows."""
    for settings in (("bearing_load.factor=1e-12",), ("bearing_load.factor=1e6",), ("lubrication.viscosity=1e-6",),
                     ("lubrication.viscosity=100",), ("initial.crank_speed=1e-3", "output.samples_per_revolution=36"),
                     ("initial.crank_speed=2e4",), ("initial.crank_speed=-200",), ("joint.clearance=1e-9",), ("joint.clearance=5e-3",),
                     ("initial.eccentricity=3.5559e-5,0",), ("initial.eccentricity=0,-3.555999e-5",), ("joint.bearing_length=1e-5",),
                     ("bearing_load.interpolation=cubic",), ("bearing_load.offset_deg=719.999",), ("drive.ramp_time=0.02",),
                     ("bearing_load.journal=rod", "bearing_load.bearing=rod", "bearing_load.frame=rod", "bearing_load.crank_to_rod=0.999"),
                     ("bearing_load.period_deg=5760",), ("lubrication.law=pinkus_sternlicht", "lubrication.variant=half_film"),
                     ("lubrication.law=pinkus_sternlicht", "lubrication.variant=closed_form")):
        done = run(program, CASES / "flores2006.nml", folder / "extreme", "run.until=end", "integrator.revolutions=4", *settings)
        check(done.returncode in (0, 4), f"ends: {settings}", done.stderr)
        if done.returncode == 4:
            check(done.stderr.count("\n") == 1 and " at t = " in done.stderr, f"says why: {settings}", done.stderr)
        rows = rows_of(folder / "extreme" / "flores2006.csv")
        check(len(rows) > 0 and all(math.isfinite(value) for row in rows for value in row.values()), f"finite numbers: {settings}")
        check(all(row["eccentricity_ratio[-]"] < 1 for row in rows), f"inside the clearance: {settings}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to test instead of the fast build")
    options = parser.parse_args()
    program = options.program or Path(subprocess.run(
        [TOP / "scripts" / "build.sh"], capture_output=True, text=True, check=True, cwd=TOP).stdout.strip())
    program = program.resolve()
    with tempfile.TemporaryDirectory() as name:
        for part in (check_closed_forms, check_finite_film, check_traces, check_one_way, check_symmetries, check_going_on,
                     check_refused, check_extremes):
            part(program, Path(name))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
