#!/usr/bin/env python3
"""The answers of the last whole cycle in summaries: work, mean effective pressures and extremes, against an independent quadrature of an
engine, against the rows of traces, and as a closed ledger in all shipped cases.

    tests/test_cycle_answers.py [--program PATH]

Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from assertions import Assertions

ROOT = Path(__file__).resolve().parent.parent
assertions = Assertions()
check = assertions.check

# An engine with ideal joints, viscous friction of the rings and damping at constant speed. Its values were computed by Gauss quadrature
# over 17 pieces of the cycle by an independent program, to ten digits.
ENGINE = """&mechanism crank_length=0.045, crank_mass=1.1, crank_inertia=0.004, crank_com=0.006,-0.002, rod_length=0.15, rod_mass=0.62,
  rod_inertia=0.0024, rod_com=0.042,0.003, piston_mass=0.47, gravity=9.80665 /
&drive kind='constant_speed', damping=0.02 /
&initial crank_angle_deg=0, crank_speed=314.1592653589793 /
&combustion bore=0.082, compression_ratio=9.5, heat_capacity_ratio=1.35, heat=900.0, wiebe_efficiency=5.0, wiebe_form=3.0,
  start_deg=345.0, duration_deg=50.0, intake_pressure=101325.0, crankcase_pressure=101325.0 /
&guide kind='friction', viscous=12.0 /
&integrator revolutions=2, relative_tolerance=1e-9 /
"""
ENGINE_ANSWERS = {
    "cycle_work_gas": 465.686029664, "cycle_work_guide": -49.0970009246, "cycle_work_damping": -78.9568352087,
    "cycle_work_drive": -337.632193531, "cycle_indicated_power": 11642.1507416, "cycle_brake_power": 10414.7257185,
    "cycle_imep": 979790.251172, "cycle_bmep": 876491.548176, "cycle_fmep": 103298.702996,
    "cycle_max_cylinder_pressure": 4736276.99121, "cycle_max_cylinder_pressure_angle": 377.374715926, "cycle_mean_piston_speed": 9.0,
}
DISPLACEMENT = 0.000475291552562   # of this engine [m3]


def run(program: Path, out: Path, case: Path, *settings: str) -> tuple[dict[str, float], list[dict[str, float]]]:
    """Summary and rows of the trace of a case."""
    words = [word for setting in settings for word in ("--set", setting)]
    ran = subprocess.run([program, "-q", "-o", out, *words, case], capture_output=True, text=True, check=False)
    if ran.returncode:
        check(False, f"{case.name} is run: {ran.stderr}")
        return {}, []
    with (out / f"{case.stem}.summary.csv").open() as file:
        summary = {row["quantity"]: number(row["value"]) for row in csv.DictReader(file)}
    with (out / f"{case.stem}.csv").open() as file:
        rows = [{name.split("[")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    return summary, rows


def number(text: str):
    try:
        return float(text)
    except ValueError:
        return text


def close(found: float, wanted: float, tolerance: float) -> bool:
    return abs(found - wanted) <= tolerance*abs(wanted)


def test_engine(program: Path, work: Path) -> None:
    case = work / "engine.nml"
    case.write_text(ENGINE)
    summary, _ = run(program, work, case)
    for name, wanted in ENGINE_ANSWERS.items():
        tolerance = 3e-7 if name.endswith("angle") else 2e-8
        check(close(summary[name], wanted, tolerance), f"engine: {name}", f"{summary[name]}, not {wanted}")
    check(summary["cycle_revolutions"] == 2 and summary["cycle_is_settled"] == "unknown", "engine: one cycle of two revolutions")
    loose, _ = run(program, work, case, "integrator.relative_tolerance=1e-5")
    check(close(loose["cycle_work_gas"], ENGINE_ANSWERS["cycle_work_gas"], 1e-4), "engine: the work of the gas follows the tolerance",
          str(loose["cycle_work_gas"]))
    longer, _ = run(program, work, case, "integrator.revolutions=6")
    check(close(longer["cycle_work_gas"], ENGINE_ANSWERS["cycle_work_gas"], 2e-8), "engine: the third cycle", str(longer["cycle_work_gas"]))
    check(longer["cycle_is_settled"] == "yes", "engine at constant speed: settled")


def test_ledger(program: Path, work: Path) -> None:
    """In every shipped case the rest is the error of the integration, and the work of parts has the sign of a loss where it must."""
    for case in sorted(path for path in (ROOT / "cases").rglob("*.nml") if "studies" not in path.parts):
        if "&study" in case.read_text():
            continue
        summary, _ = run(program, work, case, "output.samples_per_revolution=10")
        if "cycle_work_rest" not in summary:
            continue
        parts = sum(value for name, value in summary.items() if "cycle_work_" in name and name != "cycle_work_rest")
        rest = summary["cycle_work_rest"]
        size = max(abs(value) for name, value in summary.items() if "cycle_work_" in name or name == "cycle_energy_change")
        check(abs(summary["cycle_energy_change"] - parts - rest) <= 1e-8*max(size, 1e-9), "the ledger is closed", case.name)
        # two residuals; a cycle begins and ends inside steps, whose interpolation adds as much as the error at their ends
        check(abs(rest) <= 10*summary["max_energy_residual"] + 1e-12*size, "the rest is within the energy residual",
              f"{case.name}: {rest} J, residual {summary['max_energy_residual']} J")
        for loss in ("friction", "asperities", "damping", "elastic"):
            for name, value in summary.items():
                if name.endswith(f"cycle_work_{loss}"):
                    check(value <= 1e-9*size, f"work of {loss} is a loss", f"{case.name}: {value}")
        if "cycle_imep" in summary:
            swept = summary["cycle_work_gas"]/summary["cycle_imep"]
            left = summary["cycle_imep"] - summary["cycle_bmep"] - summary["cycle_fmep"]
            check(abs(left*swept - (summary["cycle_energy_change"] - rest)) <= 1e-8*size, "IMEP - BMEP - FMEP is the change of energy",
                  case.name)
            moves = abs(summary["cycle_energy_change"]) > 0.02*abs(summary["cycle_work_gas"])
            noted = any(name.startswith("note_") and "not that of a settled motion" in str(value) for name, value in summary.items())
            check(noted == moves, "a note where the energy changes by more than 2 % of the work", case.name)
            if case.stem == "v_twin":
                check(not moves and abs(summary["cycle_brake_power"]/summary["cycle_indicated_power"] - 1) < 0.02,
                      "the V twin is settled: brake power and indicated power are alike but for its film")


def integral(rows: list[dict[str, float]], column, begins: float, ends: float) -> float:
    """Trapezoids over the rows between two times, which must be among the rows."""
    inside = [row for row in rows if begins*(1 - 1e-9) <= row["time"] <= ends*(1 + 1e-9)]
    return sum(0.5*(column(a) + column(b))*(b["time"] - a["time"]) for a, b in zip(inside, inside[1:]))


def test_reversals(program: Path, work: Path) -> None:
    """Load of the piston pin along the rod. A piston alone is pushed along the cylinder by m a(q), and a weightless rod carries m a / cos A:
    with r = R/L, x = R cos q + L cos A, sin A = r sin q, it reverses where the acceleration is 0."""
    case = work / "reversing.nml"
    case.write_text("""&mechanism crank_length=0.05, crank_mass=1, crank_inertia=1e-3, crank_com=0,0, rod_length=0.16, rod_mass=1e-12,
  rod_inertia=1e-15, rod_com=0,0, piston_mass=0.4, gravity=0 /
&drive kind='constant_speed' /
&initial crank_angle_deg=10, crank_speed=200 /
&integrator revolutions=3, relative_tolerance=1e-10 /
""")
    ratio, scale = 0.05/0.16, 0.4*0.05*200**2

    def load(angle: float) -> float:   # along the rod, pressing: -m a / cos A, over m R w^2
        sine, cosine = ratio*math.sin(angle), math.sqrt(1 - (ratio*math.sin(angle))**2)
        return (math.cos(angle) + ratio*(math.cos(angle)**2 - math.sin(angle)**2)/cosine + ratio*sine**2*math.cos(angle)**2/cosine**3)/cosine

    low, high = 0.5, 2.0
    while high - low > 1e-14:
        middle = 0.5*(low + high)
        low, high = (middle, high) if load(middle) > 0 else (low, middle)
    largest = max(abs(load(math.pi*i/100000)) for i in range(100001) if load(math.pi*i/100000) < 0)
    summary, _ = run(program, work, case)
    for name, wanted in (("load_reversals", 2.0), ("reversed_load", scale*largest), ("degrees_under_reversed_load", 360 - 2*math.degrees(low))):
        check(close(summary[f"cycle_{name}"], wanted, 1e-7), f"load along the rod: cycle_{name}", f"{summary[f'cycle_{name}']}, not {wanted}")
    pressed, _ = run(program, work, case, "initial.crank_speed=1", "mechanism.gravity=9.80665")   # its weight is 200 times m R w^2
    check(pressed["cycle_load_reversals"] == 0 == pressed["cycle_degrees_under_reversed_load"] == pressed["cycle_reversed_load"],
          "a slow piston always presses", str({name: value for name, value in pressed.items() if "revers" in name}))
    for name in ("joints/both_pins_lubricated", "pin/engine", "flores/dry_0100um", "joints/both_pins", "gas/compressor"):
        is_dry = name in ("flores/dry_0100um", "joints/both_pins")
        pins = prefixes(program, work, name)
        summary, rows = run(program, work, ROOT / "cases" / f"{name}.nml", "output.samples_per_revolution=36000", "output.sampling=crank_angle",
                            "output.ideal_twin=F", "integrator.revolutions=2",
                            "output.columns=standard," + ",".join(f"{place}load_along_rod" for place in pins))
        turned = 2*math.pi*summary["cycle_revolutions"]
        begins = next(row["crank_angle"] for row in rows if row["time"] >= summary["cycle_start"])
        inside = [row for row in rows if begins - 1e-9 <= row["crank_angle"] <= begins + turned + 1e-9]
        for place in pins:
            loads = [row[f"{place}load_along_rod"] for row in inside]
            senses = [math.copysign(1, value) for value in loads if value]
            number_of = sum(a != b for a, b in zip(senses, senses[1:]))
            sense = -1 if max(loads) > -min(loads) else 1
            degrees = sum(0.01 for value in loads[1:] if value*sense > 0)
            largest = max(0.0, *(value*sense for value in loads))
            found = {word: summary[f"{place}cycle_{word}"] for word in ("load_reversals", "reversed_load", "degrees_under_reversed_load")}
            # of a dry contact, rows 0.01 degrees apart miss the shortest impacts; at the kink of an ideal valve no slope shows the peak; rows
            # and peaks are from polynomials of degrees of their own
            short = 1e-4 if name == "gas/compressor" else 1e-7
            check(abs(found["load_reversals"] - number_of) <= (0.05*number_of if is_dry else 0), f"{name}: {place}load_reversals against the rows",
                  f"{found['load_reversals']}, not {number_of}")
            check(largest*(1 - short) <= found["reversed_load"] <= largest*(1.05 if is_dry else 1.001), f"{name}: {place}reversed_load against the rows",
                  f"{found['reversed_load']}, not {largest}")
            # each reversal lies somewhere between two rows
            check(abs(found["degrees_under_reversed_load"] - degrees) <= 0.011*(number_of + 1), f"{name}: {place}degrees under reversed load against the rows",
                  f"{found['degrees_under_reversed_load']}, not {degrees}")


def prefixes(program: Path, work: Path, name: str) -> list[str]:
    """Prefixes of the pins of a case whose load along the rod is a result."""
    summary, _ = run(program, work, ROOT / "cases" / f"{name}.nml", "output.ideal_twin=F", "integrator.revolutions=2")
    return [key.removesuffix("cycle_load_reversals") for key in summary if key.endswith("cycle_load_reversals")]


def test_slap(program: Path, work: Path) -> None:
    """The hardest impact of a cycle, its angle and corner, and the number of impacts against the events; the energy against the rows."""
    case = ROOT / "cases" / "joints" / "piston_slap.nml"
    summary, rows = run(program, work, case, "output.samples_per_revolution=20000")
    with (work / "piston_slap.events.csv").open() as file:
        events = [row for row in csv.DictReader(file) if row["event"] == "contact_begins"]
    begins = [(float(row["time[s]"]), float(row["normal_speed[m/s]"]), float(row["crank_angle[rad]"]), row["joint"]) for row in events]
    ends = summary["cycle_start"] + summary["cycle_duration"]
    inside = [event for event in begins if summary["cycle_start"] < event[0] <= ends]
    for joint, prefix in (("piston_pin", ""), *((f"guide_{i}", f"guide_{i}_") for i in range(1, 5))):
        ours = [event for event in inside if event[3] == joint]
        check(summary[f"{prefix}cycle_impacts"] == len(ours), f"{joint}: number of impacts", f"{summary[f'{prefix}cycle_impacts']}, not {len(ours)}")
        check(close(summary[f"{prefix}cycle_max_impact_speed"], max(event[1] for event in ours), 1e-9), f"{joint}: largest speed of impacts in the cycle")
        check(close(summary[f"{prefix}max_impact_speed"], max(event[1] for event in begins if event[3] == joint), 1e-9), f"{joint}: the same in the run")
    skirt = [event for event in inside if event[3] != "piston_pin"]
    time, speed, angle, corner = max(skirt, key=lambda event: event[1])
    check(close(summary["cycle_slap_speed"], speed, 1e-9) and summary["cycle_slap_corner"] == corner, "speed and corner of the slap")
    check(abs(summary["cycle_slap_angle"] - math.degrees(angle) % 360) < 1e-6, "crank angle of the slap", str(summary["cycle_slap_angle"]))
    check(summary["cycle_slap_impacts"] == len(skirt), "impacts of the skirt")
    resolved = (work / "piston_slap.resolved.nml").read_text()
    mass, inertia = (float(next(line for line in resolved.splitlines() if line.strip().startswith(f"{key} =")).split("=")[1].split("!")[0])
                     for key in ("piston_mass", "piston_inertia"))

    def energy(event) -> float:   # the rows before and after, which are at most 3e-7 s away
        nearest = min(rows, key=lambda row: abs(row["time"] - event[0]))
        return 0.5*(mass*nearest["piston_offset_rate"]**2 + inertia*nearest["piston_tilt_rate"]**2)

    largest = max(map(energy, skirt))
    check(close(summary["cycle_slap_energy"], largest, 0.02), "energy of the slap against the rows", f"{summary['cycle_slap_energy']}, not {largest}")
    check(close(summary["guide_2_cycle_max_impact_energy"], max(energy(event) for event in skirt if event[3] == "guide_2"), 0.02), "energy at one corner")
    study = work / "slaps.nml"
    study.write_text(f"&study case = '{case}', statistics = 'cycle_slap_speed, max abs guide_1_force, guide_2_cycle_max_impact_speed_angle' /\n"
                     "&parameter key = 'integrator.revolutions', values = '2, 3' /\n")
    ran = subprocess.run([program, "sweep", "-q", "-o", work, study], capture_output=True, text=True, check=False)
    check(ran.returncode == 0, "a study of the slap", ran.stderr)
    with (work / "slaps.runs.csv").open() as file:
        for row, revolutions in zip(csv.DictReader(file), (2, 3)):
            alone, _ = run(program, work, case, f"integrator.revolutions={revolutions}")
            check(close(float(row["cycle_slap_speed[m/s]"]), alone["cycle_slap_speed"], 1e-4), "speed of the slap in a study", str(row))
            check(abs(float(row["guide_2_cycle_max_impact_speed_angle[deg]"]) - alone["guide_2_cycle_max_impact_speed_angle"]) < 0.1, "its angle")
    study.write_text(study.read_text().replace("cycle_slap_speed", "cycle_slap_sped"))
    ran = subprocess.run([program, "sweep", "-q", "-o", work, study], capture_output=True, text=True, check=False)
    check(ran.returncode == 3 and "'cycle_slap_sped': must be" in ran.stderr and "did you mean cycle_slap_speed?" in ran.stderr, "a wrong name", ran.stderr)


def test_rows(program: Path, work: Path) -> None:
    """Work and extremes against the rows of dense traces."""
    for name, place in (("joints/both_pins_lubricated", "crank_pin_"), ("film/sim_IV_mixed", ""), ("joints/piston_slap", ""),
                        ("flores/friction_050", ""), ("film/weighted", "")):
        case = ROOT / "cases" / f"{name}.nml"
        summary, rows = run(program, work, case, "output.samples_per_revolution=20000", "output.sampling=crank_angle",
                            "output.angle_origin_deg=0", "output.ideal_twin=F", "integrator.method=auto",
                            *(["output.columns=standard,film_power"] if "film" in name or "lubricated" in name else []),
                            *(["lubrication.report=T"] if "mixed" in name else []))
        if not rows:
            continue
        begins = summary["cycle_start"]
        ends = begins + summary["cycle_duration"]
        inside = [row for row in rows if begins <= row["time"] <= ends]
        drive = integral(rows, lambda row: row["crank_moment"]*row["crank_speed"], begins, ends)
        size = max(abs(value) for key, value in summary.items() if "cycle_work_" in key or key == "cycle_energy_change")
        check(abs(summary["cycle_work_drive"] - drive) <= 2e-3*size, f"{name}: work of the drive against the rows",
              f"{summary['cycle_work_drive']}, not {drive}")
        if f"{place}normal_force" in rows[0] and f"{place}cycle_work_friction" in summary and f"{place}sliding_speed" in rows[0]:
            friction = integral(rows, lambda row: row[f"{place}friction_force"]*row[f"{place}sliding_speed"], begins, ends)
            check(abs(summary[f"{place}cycle_work_friction"] - friction) <= 2e-3*size, f"{name}: work of friction against the rows",
                  f"{summary[f'{place}cycle_work_friction']}, not {friction}")
        if f"{place}film_power" in rows[0]:   # of the film law itself, where the ledger takes the whole work less the other parts
            film = -integral(rows, lambda row: row[f"{place}film_power"], begins, ends)
            check(abs(summary[f"{place}cycle_work_film"] - film) <= 2e-3*size, f"{name}: work of the film against the rows",
                  f"{summary[f'{place}cycle_work_film']}, not {film}")
        lost = sum(summary.get(f"{place}cycle_mean_{loss}_power", 0) for loss in ("film", "friction"))*summary["cycle_duration"]
        turned = integral(rows, lambda row: abs(row["rod_speed"] + (row["crank_speed"] if place else row.get("piston_tilt_rate", 0))),
                          begins, ends)
        moment = summary[f"{place}cycle_mean_friction_moment"]
        check(abs(moment*turned - lost) <= 1e-3*abs(lost) + 1e-12*size, f"{name}: mean moment of friction against the rows",
              f"{moment} N m, not {lost/turned}")
        if f"{place}asperity_force" in rows[0]:
            share = integral(rows, lambda row: row[f"{place}asperity_force"], begins, ends)/integral(
                rows, lambda row: math.hypot(row[f"{place}pin_force_x"], row[f"{place}pin_force_y"]), begins, ends)
            found = summary[f"{place}cycle_asperity_load_share"]
            check(close(found, share, 1e-3), f"{name}: share of the asperities against the rows", f"{found}, not {share}")
        if f"{place}film_thickness" in rows[0]:
            thinnest = min(inside, key=lambda row: row[f"{place}film_thickness"])
            film = summary[f"{place}cycle_min_film_thickness"]
            check(film <= thinnest[f"{place}film_thickness"] + 1e-15, f"{name}: no row has a thinner film",
                  f"{film}, {thinnest[f'{place}film_thickness']}")
            check(close(film, thinnest[f"{place}film_thickness"], 1e-3), f"{name}: smallest film thickness")
            apart = summary[f"{place}cycle_min_film_thickness_angle"] - math.degrees(thinnest["crank_angle"])
            apart = abs((apart + 180) % 360 - 180)
            check(apart < 0.5, f"{name}: crank angle of the thinnest film", f"{apart} degrees apart")


#: Scenes with extremes that are hard to find: at the first instant of the last cycle, two in one step, a graded table of the gas.
EXTREMES = (
    ("gas/two_stroke", ("combustion.wiebe_form=1.7",)), ("sim_VI", ("integrator.revolutions=4", "combustion.wiebe_form=5.406771")),
    ("sim_II", ("integrator.revolutions=4",)), ("bearings/small_engine", ("initial.crank_angle_deg=123",)),
    ("sim_VI", ("integrator.revolutions=4",)), ("bearings/elastic_pin", ()), ("film/elastic", ()), ("wear/worn_bore", ("output.samples_per_revolution=36000",)),
    ("bearings/refrigerant_compressor", ()), ("joints/both_pins", ("output.samples_per_revolution=36000",)), ("elastic/engine_rod", ()), ("elastic/engine_crankshaft", ()),
    ("cylinders/six_mwm", ("run.until=end", "output.window=all", "integrator.end_time=0.12")), ("joints/piston_slap", ("output.samples_per_revolution=36000",)), ("pin/engine", ()),
)
#: Answers with their columns: the largest value (1) or the smallest (-1).
EXTREME_COLUMNS = (("cycle_max_drive_torque", lambda row: row.get("crank_moment"), 1),
                   ("cycle_min_drive_torque", lambda row: row.get("crank_moment"), -1),
                   ("cycle_max_crank_speed", lambda row: row.get("crank_speed"), 1),
                   ("cycle_min_crank_speed", lambda row: row.get("crank_speed"), -1),
                   ("cycle_max_rod_mid_deflection", lambda row: abs(row["rod_mid_deflection"]) if "rod_mid_deflection" in row else None, 1),
                   ("cycle_max_rod_strain_energy", lambda row: row.get("rod_strain_energy"), 1),
                   ("cycle_max_crankshaft_twist", lambda row: abs(row["crankshaft_twist"]) if "crankshaft_twist" in row else None, 1),
                   ("cycle_max_cylinder_pressure", lambda row: row.get("cylinder_pressure"), 1),
                   ("cycle_min_film_thickness", lambda row: row.get("film_thickness"), -1),
                   ("cycle_max_eccentricity_ratio", lambda row: row.get("eccentricity_ratio"), 1),
                   ("cycle_max_segment_8_torque", lambda row: abs(row["segment_8_torque"]) if "segment_8_torque" in row else None, 1),
                   ("cycle_max_station_9_twist", lambda row: abs(row["station_9_twist"]) if "station_9_twist" in row else None, 1),
                   ("cycle_max_normal_force", lambda row: row.get("normal_force"), 1),
                   ("guide_1_cycle_min_gap", lambda row: row.get("guide_1_gap"), -1), ("guide_4_cycle_max_force", lambda row: row.get("guide_4_force"), 1),
                   ("cycle_max_pin_angle", lambda row: row.get("pin_angle"), 1), ("cycle_min_pin_angle", lambda row: row.get("pin_angle"), -1),
                   ("cycle_max_force", lambda row: math.hypot(row["pin_force_x"], row["pin_force_y"]) if "pin_force_x" in row else None, 1))


def test_extremes(program: Path, work: Path) -> None:
    """No row of the last cycle is beyond an extreme of the cycle, by more than the digits that a trace has; of a force by more than
    1e-6, since a step is not searched where three values of a force at ends of steps show that it only rises or only falls, and so
    of an eccentricity; of twists and torques by more than 1e-4, and of the angle of a pin by more than 1e-6, since they are cubics
    between the ends of steps."""
    for name, settings in EXTREMES:
        summary, rows = run(program, work, ROOT / "cases" / f"{name}.nml", "output.samples_per_revolution=3600", "output.ideal_twin=F",
                            "output.digits=12", *settings)
        begins = summary["cycle_start"] if rows else 0
        inside = [row for row in rows if begins <= row["time"] <= begins + summary["cycle_duration"]]
        for answer, column, sense in EXTREME_COLUMNS:
            if not inside or answer not in summary or column(inside[0]) is None:
                continue
            most = max(inside, key=lambda row: sense*column(row))
            margin = {"cycle_max_force": 1e-6, "cycle_max_drive_torque": 1e-6, "cycle_min_drive_torque": 1e-6, "cycle_max_eccentricity_ratio": 1e-6, "cycle_max_segment_8_torque": 1e-4,
                      "cycle_max_station_9_twist": 1e-4, "cycle_max_pin_angle": 1e-6, "cycle_min_pin_angle": 1e-6}.get(answer, 1e-9)
            check(sense*(summary[answer] - column(most)) >= -margin*abs(column(most)), f"{name}: no row is beyond {answer}",
                  f"{summary[answer]}, {column(most)}")
            check(close(summary[answer], column(most), 1e-3), f"{name}: {answer} is near the largest of the rows",
                  f"{summary[answer]}, {column(most)}")
            if answer == "cycle_max_cylinder_pressure":
                apart = (summary[f"{answer}_angle"] - math.degrees(most["crank_angle"]) + 180) % 360 - 180
                check(abs(apart) < 0.15, f"{name}: crank angle of {answer}", f"{apart} degrees from the row")   # rows are 0.1 apart


def test_no_gas(program: Path, work: Path) -> None:
    """A cylinder of the mechanism without gas has no answer of a pressure."""
    case = work / "engine.nml"
    case.write_text(ENGINE + "&cylinder gas=.false. /\n&cylinder phase_deg=360 /\n")
    summary, rows = run(program, work, case)
    check(bool(rows) and "cycle_work_gas" in summary, "the other cylinder works")
    check(not any("max_cylinder_pressure" in name for name in summary), "no answer of a pressure without gas")
    check(not any("cylinder_pressure" in name or "gas_force" in name for name in rows[0]), "no column of a gas that does not act")


# An engine of 488 cm3 with four piston rings, and the FMEP of these at speeds [rpm] and viscosities [Pa s]: that of the same closed form, to
# the last of its digits, and that of rings with a film that squeezes and a state each, over settled cycles, both by an independent program [kPa];
# 0: not known, only the two of this program are compared.
RINGED = """&mechanism crank_length=0.043, crank_mass=2.0, crank_inertia=0.1, rod_length=0.138, rod_mass=0.55, rod_inertia=0.0022, rod_com=0.038,0.0,
  piston_mass=0.5, gravity=9.80665 /
&drive kind='constant_speed' /
&initial crank_angle_deg=180, crank_speed=314.1592653589793 /
&ring height=1.2e-3, crown=6e-6, tension=8, gas_below=0.15 /
&ring height=1.2e-3, crown=8e-6, tension=7, gas_above=0.15, gas_behind=0.15, gas_below=0.02 /
&ring height=0.4e-3, crown=3e-6, tension=10, gas_above=0.02, gas_behind=0.02 /
&ring height=0.4e-3, crown=3e-6, tension=10 /
&lubrication place='rings', law='reynolds', viscosity=0.008 /
&asperities place='rings', roughness=0.4e-6, coefficient=0.1, transition_speed=0.01 /
&combustion bore=0.085, compression_ratio=10, heat_capacity_ratio=1.33, heat=750.0, wiebe_efficiency=5.0, wiebe_form=2.0,
  start_deg=345.0, duration_deg=60.0, intake_pressure=101325.0, crankcase_pressure=101325.0 /
&integrator revolutions=2, relative_tolerance=1e-8 /
"""
RING_FMEP = ((3000, 0.008, 10.87, 11.61), (3000, 0.004, 7.94, 8.49), (2000, 0.008, 9.00, 9.5557), (800, 0.012, 0.0, 0.0), (1500, 0.010, 0.0, 0.0), (6000, 0.006, 0.0, 0.0))
RINGS = ((1.2e-3, 6e-6, 8.0, 1.0, 1.0, 0.15), (1.2e-3, 8e-6, 7.0, 0.15, 0.15, 0.02), (0.4e-3, 3e-6, 10.0, 0.02, 0.02, 0.0), (0.4e-3, 3e-6, 10.0, 0.0, 0.0, 0.0))


FILMS = (*(f"ring_{number}.model=film" for number in range(1, 5)), "rings.asperities.youngs_modulus=110e9,120e9", "rings.asperities.poissons_ratio=0.3,0.26",
         "integrator.revolutions=4", "integrator.relative_tolerance=1e-6")
LUBRICATED = [f"guide.{key}" for key in ("kind=lubricated", "bore_clearance=35e-6", "skirt_top=0.012", "skirt_bottom=0.033", "piston_radius=0.0424", "barrel=30e-6",
              "piston_inertia=4.5e-4", "piston_com=0.006,0.0005", "lubrication.viscosity=0.008", "lubrication.around=4", "lubrication.along=16", "asperities.roughness=1e-6")]
# The second cycle from films of 3 um at 2000 rpm by the independent program: FMEP [Pa] and least film [m] of each ring, with relative tolerances of any
# scheme on the same grid. The faces of its skirt are elastic, which rings hardly feel.
RING_FACTS = ((3122.3379, 3.033139e-07), (2048.8525, 6.5246933e-07), (2199.3796, 5.1237034e-07), (2185.2085, 5.1820466e-07))


def test_ring_films(program: Path, work: Path) -> None:
    """Rings with a film, each a state: an independent program, their mirror image, halves of a run, what is refused."""
    case = work / "films.nml"
    case.write_text(RINGED)
    slow = (*LUBRICATED, "initial.crank_speed=209.43951023931953")
    summary, _ = run(program, work, case, *FILMS, *slow)
    for number, (fmep, film) in enumerate(RING_FACTS, 1):
        check(close(summary[f"cycle_ring_{number}_fmep"], fmep, 1e-3), f"ring {number} with a film: FMEP", str(summary[f"cycle_ring_{number}_fmep"]))
        check(close(summary[f"cycle_min_ring_{number}_film_thickness"], film, 1e-3), f"ring {number} with a film: least film",
              str(summary[f"cycle_min_ring_{number}_film_thickness"]))
    lost = summary["cycle_ring_fmep"]*math.pi/4*0.085**2*0.086
    lost += summary["cycle_skirt_fmep"]*math.pi/4*0.085**2*0.086
    check(close(-summary["cycle_work_guide"], lost, 5e-4) and summary["max_energy_residual_relative"] < 1e-5, "rings with a film: nothing else but the skirt loses work", str(lost))
    tilted = ("ring_1.crown_offset=1e-4", "ring_2.crown_offset=-2e-4")
    turned = ("ring_1.crown_offset=-1e-4", "ring_2.crown_offset=2e-4")
    plain, _ = run(program, work, case, *FILMS, *slow, *tilted)
    other, _ = run(program, work, case, *FILMS, *slow, *turned)
    check(not close(plain["cycle_ring_1_fmep"], other["cycle_ring_1_fmep"], 1e-3), "the crown beside the middle counts")
    backwards, _ = run(program, work, case, *FILMS, *LUBRICATED, "guide.piston_com=0.006,-0.0005", "initial.crank_speed=-209.43951023931953", *tilted)
    check(close(plain["cycle_ring_fmep"], backwards["cycle_ring_fmep"], 1e-5), "rings with a film: an engine that turns the other way loses as much")
    for settings, message in ((("rings.asperities=none",), "needs the group asperities with place = 'rings'"), (("ring_3.crown_offset=2e-4",), "must be shorter than half of height"),
                              (("ring_1.model=closed_form", "ring_1.crown_offset=1e-5"), "needs model = 'film'"), (("rings.lubrication.along=7",), "must be >= 8 and <= 128")):
        ran = subprocess.run([program, "--check", *(word for one in (*FILMS, *settings) for word in ("--set", one)), case], capture_output=True, text=True, check=False)
        check(ran.returncode == 3 and message in ran.stderr, f"refused: {settings}", ran.stderr)


def ring_friction(ring: tuple[float, ...], speed: float, pressure: float) -> float:
    """The equation of the manual."""
    height, crown, tension, above, behind, below = ring
    load = max(2*tension/0.085 + height*(behind - (above + below)/2)*pressure, 0.2*tension/0.085)
    film = 2.446*0.008*abs(speed)*height**2/(8*crown)/load
    return -math.pi*0.085*(3.18*math.sqrt(0.008*load)*speed/(speed**2 + 1e-4)**0.25 + 0.1*load*math.tanh(speed/0.01)*math.exp(-film/0.4e-6))


def test_rings(program: Path, work: Path) -> None:
    """Friction of piston rings: each row, its losses, and what they are over."""
    case = work / "rings.nml"
    case.write_text(RINGED)
    swept = math.pi/4*0.085**2*0.086
    for rpm, viscosity, closed, film in RING_FMEP:
        summary, rows = run(program, work, case, f"initial.crank_speed={math.pi*rpm/30}", f"rings.lubrication.viscosity={viscosity}")
        if not rows:
            return
        name = f"rings at {rpm} rpm, {viscosity} Pa s"
        fmep = summary["cycle_ring_fmep"]*1e-3
        check(not closed or abs(fmep - closed) <= 0.006, f"{name}: FMEP", f"{fmep} kPa, not {closed}")
        squeezed, _ = run(program, work, case, *FILMS, f"initial.crank_speed={math.pi*rpm/30}", f"rings.lubrication.viscosity={viscosity}")
        check(not film or abs(squeezed["cycle_ring_fmep"]*1e-3 - film) <= 0.006, f"{name}: FMEP with a film", f"{squeezed['cycle_ring_fmep']} Pa, not {film} kPa")
        check(0.9 < fmep*1e3/squeezed["cycle_ring_fmep"] < 1, f"{name}: within a tenth of rings with a film", f"{fmep*1e3/squeezed['cycle_ring_fmep']}")
        parts = [summary[f"cycle_ring_{number}_fmep"] for number in range(1, 5)]
        check(close(sum(parts), summary["cycle_ring_fmep"], 1e-9) and "cycle_ring_5_fmep" not in summary, f"{name}: sum of the rings")
        lost = summary["cycle_ring_fmep"]*swept
        check(close(-summary["cycle_work_guide"], lost, 5e-4) and close(summary["cycle_fmep"], lost/swept, 5e-4), f"{name}: nothing else loses work",
              f"{-summary['cycle_work_guide']} J, not {lost}")
        check(close(summary["cycle_mean_ring_power"]*summary["cycle_duration"], lost, 1e-9), f"{name}: loss in W")
        if (rpm, viscosity) != (3000, 0.008):
            continue
        for row in rows:
            wanted = [ring_friction(ring, row["piston_velocity"], row["cylinder_pressure"] - 101325) for ring in RINGS]
            found = [row[f"ring_{number}_friction_force"] for number in range(1, 5)]
            check(all(abs(a - b) <= 1e-8*abs(b) + 1e-6 for a, b in zip(found, wanted)), "friction of each ring in a row", f"{found}, not {wanted}")
            check(abs(row["guide_friction_force"] - sum(wanted)) <= 1e-8*sum(map(abs, wanted)) + 1e-5, "they are all of the friction of the guide")
        mirrored, _ = run(program, work, case, f"initial.crank_speed={-math.pi*rpm/30}")
        check(close(mirrored["cycle_ring_fmep"], summary["cycle_ring_fmep"], 1e-6), "an engine that turns the other way loses as much")
        smooth, _ = run(program, work, case, "rings.asperities=none")
        check(0.8*fmep < smooth["cycle_ring_fmep"]*1e-3 < fmep, "smooth rings have less friction")
    loose, _ = run(program, work, case, *(f"guide.{key}" for key in ("kind=clearance", "bore_clearance=35e-6", "skirt_top=0.012", "skirt_bottom=0.033",
        "piston_radius=0.0424", "piston_inertia=4.5e-4", "piston_com=0.006,0.0005", "stiffness=5e7", "restitution=0.4", "coefficient=0")))
    check(close(loose["cycle_ring_fmep"], 10870, 1e-3) and loose["max_energy_residual_relative"] < 1e-5, "rings of a piston that slaps",
          f"{loose['cycle_ring_fmep']}, {loose['max_energy_residual_relative']}")
    twin, _ = run(program, work, case, "output.ideal_twin=T", "guide.kind=clearance", "guide.bore_clearance=35e-6", "guide.skirt_top=0.012", "guide.skirt_bottom=0.033",
                  "guide.piston_radius=0.0424", "guide.piston_inertia=4.5e-4", "guide.stiffness=5e7", "guide.coefficient=0")
    with (work / "rings.ideal.csv").open() as file:
        check("ring_friction_force[N]" in file.readline(), "the ideal twin has the rings, which are no clearance")
    study = work / "tension.nml"
    study.write_text(f"&study case = '{case}', statistics = 'cycle_ring_fmep, cycle_ring_2_fmep, max abs ring_friction_force' /\n"
                     "&parameter key = 'ring_2.tension', values = '7, 14' /\n&parameter key = 'rings.lubrication.viscosity', values = '0.008, 0.004' /\n")
    ran = subprocess.run([program, "sweep", "-q", "-o", work, study], capture_output=True, text=True, check=False)
    check(ran.returncode == 0, "a study of tension and oil", ran.stderr)
    with (work / "tension.runs.csv").open() as file:
        found = [float(row["cycle_ring_fmep[Pa]"]) for row in csv.DictReader(file)]
    check(len(found) == 4 and abs(max(found) - found[2]) + abs(min(found) - found[1]) == 0 and close(found[0], 10870, 1e-3), "more with tension, less with thinner oil", str(found))


def test_wear(program: Path, work: Path) -> None:
    """The wear of an hour of the last cycle against the difference of two runs, which are a revolution apart; at a tolerance at which
    the motion, which amplifies differences, is that of both."""
    case = ROOT / "cases" / "wear" / "flores.nml"
    depths = []
    for revolutions in (3, 4):
        summary, _ = run(program, work, case, f"integrator.revolutions={revolutions}", "integrator.relative_tolerance=1e-10",
                         "output.samples_per_revolution=10")
        with (work / "flores.wear.csv").open() as file:
            depths.append([{name.split("[")[0]: row[name] for name in row} for row in csv.DictReader(file)])
    for surface in ("pin", "bore"):
        growth = max(float(after[f"{surface}_depth"]) - float(before[f"{surface}_depth"]) for before, after in zip(*depths))
        found = summary[f"cycle_wear_depth_rate_{surface}"]
        check(close(found, growth*3600/summary["cycle_duration"], 1e-2), f"wear of the {surface} in an hour of the last cycle",
              f"{found}, not {growth*3600/summary['cycle_duration']}")


def test_scope(program: Path, work: Path) -> None:
    """A run until it is periodic with a window: the answers are of the window that the trace shows, not of the start."""
    case = ROOT / "cases" / "wear" / "flores.nml"
    summary, rows = run(program, work, case, "run.until=periodic", "output.window=last_period", "friction.coefficient=0.1",
                        "output.samples_per_revolution=5000")
    if not rows:
        return
    largest = max(math.hypot(row["pin_force_x"], row["pin_force_y"]) for row in rows)
    check(close(summary["cycle_max_force"], largest, 1e-2), "the largest force of the cycle is that of the window",
          f"{summary['cycle_max_force']}, {largest}")
    check(summary["max_pin_force"] > 2*summary["cycle_max_force"], "the whole run has the larger force of the start")
    check(close(summary["cycle_duration"], summary["period"], 1e-9) and close(summary["cycle_start"], summary["window_start"], 1e-9),
          "the cycle is the period in the window")
    check(summary["cycle_is_settled"] == "yes", "a periodic motion is settled")
    line = subprocess.run([program, "-o", work, *("--set run.until=periodic --set output.window=last_period --set friction.coefficient=0.1"
                                                  .split()), case], capture_output=True, text=True, check=False).stdout
    check("kN in the last cycle)" in line, "the line of the run tells the force of the last cycle where it differs", line)
    off, _ = run(program, work, case, "output.answers=F")
    check(not any("cycle_" in name for name in off), "answers = .false. takes them out")


# The second cycle of cases/joints/skirt.nml from the centre at rest, by an independent program on the same grid; relative tolerances: its own errors
# and those of a run at 1e-6.
SKIRT_FACTS = (("cycle_min_skirt_film_thickness", 1.1452507e-05, 1e-3), ("cycle_max_skirt_film_pressure", 2881960, 1e-3), ("cycle_max_skirt_force", 2313.9996, 2e-4),
               ("cycle_skirt_fmep", 9749.1014, 2e-4), ("cycle_max_slap_speed", 0.046442549, 2e-3), ("cycle_max_slap_energy", 0.00087061018, 2e-3))


def check_faces(program: Path, work: Path, case: Path) -> None:
    """The pressures of both faces in NAME.skirt.csv, summed over their grid with its mirror image, are the force in the row of this time."""
    _, rows = run(program, work, case, "output.film_times='0.06, 0.07'", "integrator.end_time=0.07")
    at = {round(row["time"]*1e6): row for row in rows}
    with (work / "skirt.skirt.csv").open() as file:
        nodes = [{name.split("[")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    heights, angles = sorted({node["height"] for node in nodes}), sorted({node["angle"] for node in nodes})
    check(len(nodes) == 2*2*25*6 and abs(heights[0] + 0.033) + abs(heights[-1] - 0.012) < 1e-12 and abs(angles[0] - 3.75) < 1e-9, "nodes of both faces at two times")
    wide = {z: (heights[min(k + 1, 24)] - heights[max(k - 1, 0)])/2 for k, z in enumerate(heights)}
    for time in (60000, 70000):
        force = -sum(node["side"]*node["pressure"]*math.cos(math.radians(node["angle"]))*2*0.0424*math.radians(7.5)*wide[node["height"]]
                     for node in nodes if round(node["time"]*1e6) == time)
        check(abs(force - at[time]["skirt_force"]) < 1e-4*abs(force) + 1e-2, "pressures of both faces against the force", f"{force}, {at[time]['skirt_force']}")


def test_skirt(program: Path, work: Path) -> None:
    """The film of the skirt against an independent program; what it must equal; what is refused."""
    case = ROOT / "cases/joints/skirt.nml"
    summary, rows = run(program, work, case)
    if not rows:
        return
    for name, wanted, tolerance in SKIRT_FACTS:
        check(close(summary[name], wanted, tolerance), f"skirt: {name}", f"{summary[name]}, not {wanted}")
    check(abs(summary["cycle_min_skirt_film_thickness_angle"] - 530) < 3, "skirt: where the least film is", str(summary["cycle_min_skirt_film_thickness_angle"]))
    check(close(summary["cycle_fmep"], summary["cycle_skirt_fmep"], 1e-4), "skirt: nothing else loses work", str(summary["cycle_fmep"]))
    for row in rows:
        check(row["skirt_power"] >= 0, "skirt: it takes power", str(row["skirt_power"]))
        z = 0.006   # the top from the centre of mass; 35 + 30 um: clearance and relief there
        check(abs(row["guide_1_gap"] + row["piston_offset"] + z*row["piston_tilt"] - 65e-6) < 1e-12, "skirt: gap at the top")
    check_faces(program, work, case)
    draft = "guide.lubrication.around=4", "guide.lubrication.along=16", "integrator.relative_tolerance=1e-5"
    plain, _ = run(program, work, case, *draft)
    mirrored, _ = run(program, work, case, *draft, "initial.crank_speed=-314.1592653589793", "initial.crank_angle_deg=180", "guide.piston_com=0.006,-0.0005")
    for name in ("cycle_skirt_fmep", "cycle_min_skirt_film_thickness", "cycle_max_skirt_force"):
        check(close(plain[name], summary[name], 0.06), f"skirt: {name} on a coarse grid", f"{plain[name]}, {summary[name]}")
        check(close(mirrored[name], plain[name], 1e-4), f"skirt: {name} of the mirror image", f"{mirrored[name]}, {plain[name]}")
    (work / "profile.csv").write_text("height[mm],relief[um]\n" + "".join(f"{z},{30*((z + 10.5)/22.5)**2}\n" for z in range(-33, 13)))
    table, _ = run(program, work, case, *draft, "guide.barrel=0", f"guide.profile_table={work / 'profile.csv'}")
    check(close(table["cycle_skirt_fmep"], plain["cycle_skirt_fmep"], 1e-3), "skirt: the profile of a table", str(table["cycle_skirt_fmep"]))
    for settings, message in ((("guide.asperities=none",), "needs the groups lubrication and asperities with place = 'guide'"), (("guide.restitution=0.5",), "a lubricated skirt has no dry corners"),
                              (("guide.stiffness=-1e7",), "must be >= 0"), (("initial.piston_offset=36e-6",), "must leave a gap between skirt and bore"),
                              (("guide.asperities.roughness=35e-6",), "must be < bore_clearance"), ((f"guide.profile_table={work / 'profile.csv'}",), "is in profile_table: one of both"),
                              (("guide.skirt_top=0.013", "guide.barrel=0", f"guide.profile_table={work / 'profile.csv'}"), "must cover the skirt"),
                              (("guide.kind=friction",), "needs &guide kind = 'lubricated'")):
        ran = subprocess.run([program, "--check", *(word for one in settings for word in ("--set", one)), case], capture_output=True, text=True, check=False)
        check(ran.returncode == 3 and message in ran.stderr, f"refused: {settings}", ran.stderr)


# The same engine at 2000 rpm with elastic faces and four rings with films by an independent program on the same grid (order 5 at 1e-8): answers of its
# second cycle, with relative tolerances of extremes, which its rows miss by up to 3e-4, and of means; limits of its rows over the largest value of a column,
# which the kinks of the forces leave to a run at 1e-6.
ELASTIC = (*LUBRICATED, "guide.lubrication.around=5", "guide.lubrication.along=20", "guide.stiffness=5e7", "guide.asperities.youngs_modulus=70e9,120e9",
           "guide.asperities.poissons_ratio=0.33,0.26", "initial.crank_speed=209.43951023931953")
ELASTIC_FACTS = (("cycle_min_skirt_film_thickness", 8.1793765e-06, 5e-4), ("cycle_max_skirt_film_pressure", 3154421.3, 5e-4), ("cycle_max_skirt_force", 2556.0611, 1e-4),
                 ("cycle_skirt_fmep", 6200.3276, 1e-4), ("cycle_max_slap_speed", 0.086995308, 1e-3), ("cycle_max_slap_energy", 0.0027387675, 5e-4),
                 ("cycle_max_deflection", 3.4650765e-05, 1e-4), ("cycle_ring_fmep", 9555.7426, 1e-4))


def elastic_rows(program: Path, work: Path, case: Path) -> None:
    """Every other row of the independent program."""
    _, rows = run(program, work, case, *FILMS, *ELASTIC, "integrator.revolutions=0", "integrator.end_time=0.12", "output.sampling=time", "output.interval=3.3333333333333334e-4")
    at = {round(row["time"]*1e6): row for row in rows}
    with (ROOT / "data/film/skirt_elastic_rings.csv").open() as file:
        wanted = [{name.split("[")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    for name in (name for name in wanted[0] if name != "time"):
        size = max(abs(row[name]) for row in wanted)
        worst = max(abs(at[round(row["time"]*1e6)][name] - row[name]) for row in wanted)
        of_states = name.startswith(("piston_offset", "piston_tilt", "guide_")) and "acceleration" not in name or name.endswith("film_thickness")
        check(worst <= (1e-4 if of_states else 1e-3)*size and len(wanted) == 179, f"elastic skirt: rows of {name}", f"{worst/(size or 1)}")


def test_elastic_skirt(program: Path, work: Path) -> None:
    """Elastic faces of a lubricated skirt: an independent program, energy, mirror image, stiff and soft springs, halves of a run."""
    case = work / "elastic.nml"
    case.write_text(RINGED)
    elastic_rows(program, work, case)
    summary, rows = run(program, work, case, *FILMS, *ELASTIC, "output.columns=standard, skirt_spring_energy")
    for name, wanted, tolerance in ELASTIC_FACTS:
        check(close(summary[name], wanted, tolerance), f"elastic skirt: {name}", f"{summary[name]}, not {wanted}")
    check(summary["max_energy_residual_relative"] < 1e-7, "elastic skirt: energy", str(summary["max_energy_residual_relative"]))
    for row in rows:
        bent = [row[f"guide_{k}_deflection"] for k in range(1, 5)]
        check(row["skirt_power"] >= 0 and min(bent) >= -1e-10, "elastic skirt: it takes power, and no spring is drawn to the wall", f"{row['skirt_power']}, {min(bent)}")
        check(abs(row["guide_4_gap"] - 65e-6 - row["piston_offset"] + 0.039*row["piston_tilt"] - bent[3]) < 1e-12, "elastic skirt: gap at the bottom")
        check(close(row["skirt_spring_energy"], 2.5e7*sum(w*w for w in bent), 1e-9), "elastic skirt: energy of the springs")
    draft = (*LUBRICATED, "guide.stiffness=5e7", "integrator.relative_tolerance=1e-6", "integrator.revolutions=4")
    plain, _ = run(program, work, case, *draft)
    fine = (*draft, "integrator.relative_tolerance=1e-9")   # a state restarts the method: at 1e-6 halves differ by 1.5e-5, here by 1e-8
    whole, _ = run(program, work, case, *fine)
    mirrored, _ = run(program, work, case, *draft, "initial.crank_speed=-314.1592653589793", "guide.piston_com=0.006,-0.0005")
    for name in ("cycle_skirt_fmep", "cycle_min_skirt_film_thickness", "cycle_max_skirt_force", "cycle_max_deflection"):
        check(close(mirrored[name], plain[name], 1e-4), f"elastic skirt: {name} of the mirror image", f"{mirrored[name]}, {plain[name]}")
    run(program, work / "half", case, *fine, "integrator.revolutions=2")
    words = [word for setting in fine for word in ("--set", setting)]
    halves = subprocess.run([program, "-q", "-o", work / "halves", *words, "--from", work / "half" / "elastic.state.nml", case], capture_output=True, text=True, check=False)
    with (work / "halves" / "elastic.summary.csv").open() as file:
        found = {row["quantity"]: number(row["value"]) for row in csv.DictReader(file)}
    for name in ("cycle_skirt_fmep", "cycle_max_deflection", "cycle_max_skirt_force"):
        check(close(found[name], whole[name], 1e-6), f"elastic skirt: {name} of a run in two halves", f"{found[name]}, {whole[name]} {halves.stderr}")
    free, _ = run(program, work, case, *draft, "drive.kind=free", "drive.damping=0.02", "integrator.relative_tolerance=1e-8", "integrator.revolutions=2")
    check(free["max_energy_residual_relative"] < 1e-8 and free["max_deflection"] > 1e-5, "elastic skirt: energy with a free crank", str(free["max_energy_residual_relative"]))
    _, rigid = run(program, work, case, *draft, "guide.stiffness=0")
    span = max(row["piston_offset"] for row in rigid) - min(row["piston_offset"] for row in rigid)
    misses = []
    for stiffness in (1e9, 1e10, 1e11):
        _, stiff = run(program, work, case, *draft, f"guide.stiffness={stiffness}")
        misses.append(max(abs(a["piston_offset"] - b["piston_offset"]) for a, b in zip(stiff, rigid))/span)
    check(all(7 < a/b < 14 for a, b in zip(misses, misses[1:])) and misses[2] < 1e-3, "stiff springs tend to a rigid skirt as 1/K", str(misses))
    soft, _ = run(program, work, case, *draft, "guide.stiffness=2e6", "guide.lubrication.cavitation=gumbel", "integrator.revolutions=2")
    check(soft["max_deflection"] > 35e-6 and soft["max_energy_residual_relative"] < 1e-6, "elastic skirt: soft springs", str(soft["max_deflection"]))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path)
    options = parser.parse_args()
    program = options.program
    if program is None:
        built = subprocess.run([ROOT / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
        if built.returncode:
            sys.exit(f"{built.stderr}\n0 passed, 1 failed")
        program = ROOT / built.stdout.strip()
    with tempfile.TemporaryDirectory(prefix="answers") as work:
        for test in (test_engine, test_ledger, test_reversals, test_slap, test_rows, test_extremes, test_no_gas, test_rings, test_ring_films, test_skirt, test_elastic_skirt, test_wear, test_scope):
            folder = Path(work) / test.__name__
            folder.mkdir()
            test(program.resolve(), folder)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
