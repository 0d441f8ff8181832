#!/usr/bin/env python3
"""Films with memory as a user runs them: the bearing cases of data/film/engine against the results of an independent program,
each column within its tolerance in facts.csv, shapes of a bearing, limits, and what is refused; certificates, studies and states of a
bearing by itself; after the run of a mechanism, the same film in a bearing by itself under the load of that run, tables of supply
pressures and compliances, fields.

    tests/test_bearing_cases.py [--program PATH]

Needs the standard library alone. Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "tests"))

from assertions import Assertions
from program_runs import run, summary_of

assertions = Assertions()
check = assertions.check
BEARINGS = TOP / "data" / "film" / "engine"
COARSE = ("film_history.around=96", "film_history.along=8")
OF_RUN = ("time", "crank_angle", "quick_")   #: columns of the run, not of the film
#: Settings that are refused, and what the message must contain.
REFUSED = (
    (("supply.width_deg=0",), "width_deg"), (("supply.length=1",), "length"), (("supply.position_deg=a",), "position_deg"),
    (("supply.position_deg=1,2,3,4,5,6,7,8,9",), "position_deg"), (("supply.kind=slots",), "kind"), (("supply.kind=holes",), "diameter"),
    (("supply.kind=holes", "supply.diameter=1e-4"), "hole is smaller than a cell"), (("bore.outer_radius=0.025",), "outer_radius"),
    (("bearing_load.table=absent.csv",), "absent.csv"), (("film_history.around=23",), "around"), (("film_history.cycle_deg=500",), "cycle_deg"),
    (("supply.length=1e-4",), "groove is smaller than a cell"),
    (("lubrication.pressure_viscosity=1e-6", "supply.pressure=3e7"), "20/pressure_viscosity"), (("mechanism.gravity=3",), "mechanism"))

#: The same for a case with a mechanism.
AFTER_RUN_REFUSED = (
    (("crank_pin.film_history=none",), "film_history"), (("crank_pin.film_history.cycle_deg=500",), "cycle_deg"),
    (("crank_pin.bore.compliance_table=absent.csv",), "outer_radius"),
    (("crank_pin.bore.outer_radius=0.0202",), "outer_radius"), (("crank_pin.supply.pressure_table=absent.csv",), "absent.csv"),
    (("crank_pin.supply.kind=holes",), "diameter"), (("crank_pin.supply.length=1",), "length"),
    (("lubrication=none", "contact.law=hertz"), "lubrication"),
    (("lubrication.law=finite_bearing",), "cavitation"), (("lubrication.law=finite_bearing", "lubrication.cavitation=none"), "cavitation"))


def columns_of(path: Path) -> dict[str, list[float]]:
    """The columns of a table of numbers by their names."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0] if name != "joint"}


def scale_of(columns: dict[str, list[float]], name: str) -> float:
    """Largest magnitude of a column; for eccentricities and forces that of the vector."""
    if name.startswith(("eccentricity", "film_force")):
        return max(map(math.hypot, columns[name.replace("_y[", "_x[")], columns[name.replace("_x[", "_y[")]))
    return max(map(abs, columns[name]))


def check_references(program: Path, folder: Path) -> None:
    """All columns of the bearings within their tolerances, of a cycle on coarse cells too; its first rows on the same cells are equal but
    for the digits of the reference and the tolerance of a step; the resolved case gives the same rows."""
    with (BEARINGS / "facts.csv").open(newline="") as file:
        facts = list(csv.DictReader(file))
    for case in sorted(path.stem for path in BEARINGS.glob("*.nml")):
        wanted = columns_of(BEARINGS / f"{case}.film_history.csv")
        rows = len(wanted["time[s]"])
        for cells in ((), COARSE) if rows > 1 else ((),):
            done = run(program, BEARINGS / f"{case}.nml", folder, *cells)
            check(done.returncode == 0 and "film with memory: thinnest" in done.stdout, f"{case} runs", done.stderr)
            if done.returncode:
                continue
            found = columns_of(folder / f"{case}.film_history.csv")
            for fact in (fact for fact in facts if fact["case"] == case):
                name = fact["quantity"]
                target = wanted[name] if fact["value"] == "rms" else [float(fact["value"])]
                error = math.sqrt(sum((a - b)**2 for a, b in zip(found[name], target)) / len(target)) / scale_of(wanted, name)
                check(len(found[name]) == len(target) and error <= float(fact["tolerance"]), f"{case}: {name}",
                      f"error {error:.2g}, allowed {fact['tolerance']}")
                error = max(abs(a - b) for a, b in zip(found[name][:20], wanted[name])) / scale_of(wanted, name)
                check(rows == 1 or cells or error < 1e-7, f"first rows of {case}: {name}", f"{error:.2g}")
            summary = summary_of(folder / f"{case}.summary.csv")
            check(float(summary["film_history_mass_residual"]) < 1e-9, f"mass of {case}")
            check(not cells or any("fewer than 4" in value for name, value in summary.items() if name.startswith("note_")), "the note is in the summary")
    done = run(program, folder / "steady_two_grooves_load.resolved.nml", folder / "again")
    again = folder / "again" / "steady_two_grooves_load.resolved.film_history.csv"
    check(done.returncode == 0 and again.read_bytes() == (folder / "steady_two_grooves_load.film_history.csv").read_bytes(),
          "the resolved case gives the same rows", done.stderr)


def check_services(program: Path, folder: Path) -> None:
    """What every case has: a certificate, which says that it is not one of the film with memory, a study on two processes, a run that
    goes on from another one; the march is that of one run all the same."""
    case, quick, exact = BEARINGS / "load_groove.nml", (*COARSE, "film_history.most_cycles=3"), (*COARSE, "output.digits=17")
    command = [program, case, "--out", folder / "once", "--certify", *(word for setting in quick for word in ("--set", setting))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    summary = summary_of(folder / "once" / "load_groove.summary.csv")
    check(done.returncode == 0 and "note: not certified: film_history" in done.stdout and "film_history" in summary["certificate_note"] and
          float(summary["certified_digits"]) > 3 and (folder / "once" / "load_groove.certificate.csv").exists(), "a certificate", done.stdout + done.stderr)
    (folder / "study.nml").write_text(
        f"&study case='{case}', statistics='film_history_min_film_thickness' /\n&parameter key='joint.clearance', values=3e-5, 3.2e-5, 3.4e-5 /\n")
    command = [program, "sweep", folder / "study.nml", "--out", folder, "-j", "2", *(word for setting in exact for word in ("--set", setting))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    check(done.returncode == 0, "a study of the clearance", done.stderr)
    with (folder / "study.runs.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    thinnest = [float(row["film_history_min_film_thickness[m]"]) for row in rows]
    check(len(rows) == 3 and len(set(thinnest)) == 3, "three runs of the study", str(rows))
    once = run(program, case, folder / "one", *exact)
    check(float(summary_of(folder / "one" / "load_groove.summary.csv")["film_history_min_film_thickness"]) == thinnest[0],
          "the same film in a study, to the last bit", once.stderr)
    least = []
    for start in ("", folder / "one" / "load_groove.state.nml"):
        done = run(program, case, folder / "two", *quick, "integrator.revolutions=2", f"initial.from={start}")
        least.append(float(summary_of(folder / "two" / "load_groove.summary.csv")["film_history_min_film_thickness"]))
        check(done.returncode == 0, f"two revolutions, from '{start}'", done.stderr)
    check(abs(least[0] / least[1] - 1) < 1e-6, "the film of a run that goes on", str(least))   # that of the run differs by its tolerance


def check_limits(program: Path, folder: Path) -> None:
    """More oil thickens the film of a load; without any supply it thins from cycle to cycle."""
    case, least, fill = BEARINGS / "load_groove.nml", {}, {}
    for name, settings in {"groove": (), "dry": ("supply=none", "film_history.most_cycles=2"),
                           "drier": ("supply=none", "film_history.most_cycles=6"), "unfed": ("supply.pressure=0",), "flooded": ("lubrication.ambient_over_cavitation=1e5",)}.items():
        done = run(program, case, folder / name, *COARSE, *settings)
        check(done.returncode == 0, f"runs: {name}", done.stderr)
        if done.returncode:
            return
        summary = summary_of(folder / name / "load_groove.summary.csv")
        least[name], fill[name] = (float(summary[f"film_history_{of}"]) for of in ("min_film_thickness", "least_fill"))
        if name == "dry":
            check(float(summary["film_history_mean_supply_flow"]) == 0, "no supply, no flow from it")
    check(least["unfed"] < least["groove"] < least["flooded"] and least["drier"] < least["dry"], "more oil, a thicker film", str(least))
    check(fill["drier"] < fill["dry"] < fill["unfed"] < fill["groove"] < fill["flooded"], "more oil, a fuller gap", str(fill))


def shaped(folder: Path, name: str, load: str, *lines: str, c: float = 2.5e-5, r: float = 0.025025, length: float = 0.02, speed: float = 300.0,
           start: str = "5e-6, 0.0") -> Path:
    """The file of a bearing under a load for one revolution, with further groups."""
    path = folder / f"{name}.nml"
    path.write_text("\n".join([f"&bearing_load {load} /", f"&initial crank_speed={speed!r}, eccentricity={start} /",
                               f"&joint kind='quasi_static', clearance={c!r}, bearing_radius={r!r}, bearing_length={length!r} /",
                               "&film_history most_cycles=1 /", "&integrator revolutions=1, relative_tolerance=1e-6 /",
                               "&output sampling='crank_angle', samples_per_revolution=360, digits=12 /", *lines]) + "\n")
    return path


def check_shapes(program: Path, folder: Path) -> None:
    """A lemon with relief, a barrel and a tilt against an independent program on the same cells; Lund and Thomsen's lemon; symmetries."""
    oil = "&lubrication law='finite_bearing', variant='short', cavitation='mass_conserving', viscosity=0.0095 /"
    grooves = "&supply kind='grooves', pressure=300000.0, position_deg=90, 270, width_deg=15, length=0.010 /"
    table = BEARINGS / "shape_lemon.csv"
    wanted = columns_of(BEARINGS / "shape_load.film_history.csv")
    shape = f"&shape table='{table}', barrel=1e-06, tilt=5e-05, 5e-05 /"
    case = shaped(folder, "shape_load", f"table='{BEARINGS / 'shape_load.load.csv'}', period_deg=360", oil, grooves, shape, start="-1e-5, 0.0")
    done = run(program, case, folder)
    check(done.returncode == 0, "shape_load runs", done.stderr)
    found = columns_of(folder / "shape_load.film_history.csv")
    check(set(wanted) <= set(found), "shape_load has the tilting moment", str(list(found)))
    for name in wanted:
        error = max(abs(a - b) for a, b in zip(found[name], wanted[name])) / scale_of(wanted, name)
        check(len(found[name]) == len(wanted[name]) and error < 1e-8, f"shape_load: {name}", f"{error:.2g}")
    summary = summary_of(folder / "shape_load.summary.csv")
    largest = max(map(math.hypot, wanted["film_tilting_moment_x[N.m]"], wanted["film_tilting_moment_y[N.m]"]))
    check(abs(float(summary["film_history_max_tilting_moment"]) / largest - 1) < 1e-6, "the largest tilting moment", summary["film_history_max_tilting_moment"])
    plain = "load=-6000.0, 500.0"
    steady = "film_history.around=192", "film_history.along=16"
    done = run(program, shaped(folder, "shape_steady", plain, oil, grooves, shape.replace("5e-05, 5e-05", "1e-4, -5e-05")), folder, *steady)
    check(done.returncode == 0, "shape_steady runs", done.stderr)
    found = columns_of(folder / "shape_steady.film_history.csv")
    for name, (value,) in columns_of(BEARINGS / "shape_steady.film_history.csv").items():
        error = abs(found[name][0] / value - 1)
        check(error < 1e-8, f"shape_steady: {name}", f"{error:.2g}")

    # Lund and Thomsen (1978): preload 1/2, L/D 1, two axial grooves of 20 degrees at ambient pressure; S and eccentricity over the
    # pad clearance, attitude from the load; the printed attitude at S = 0.161 is a misprint (its K and eccentricity fit 85.3)
    pad, mu, speed, radius = 4e-5, 0.0095, 300.0, 0.025
    rows = [(float(d), 0.5 * pad * (1 - abs(math.cos(math.radians(d))))) for d in range(0, 360, 2)]
    write_table(folder / "lund.shape.csv", "angle[deg],deviation[m]", rows)
    for s, eccentricity, attitude in ((0.211, 0.260, 87.79), (0.120, 0.350, 81.80), (0.097, 0.381, 78.65)):
        force = mu * speed / (2 * math.pi) * (2 * radius) ** 2 * (radius / pad) ** 2 / s
        path = shaped(folder, "lund", f"load={force!r}, 0.0", f"&lubrication law='finite_bearing', variant='short', cavitation='reynolds', viscosity={mu} /",
                      "&supply kind='grooves', pressure=0.0, position_deg=90, 270, width_deg=20, length=0.05 /", "&shape table='lund.shape.csv' /",
                      c=0.5 * pad, r=radius + 0.5 * pad, length=2 * radius, speed=speed, start="2e-6, 2e-6")
        done = run(program, path, folder, "film_history.around=144", "film_history.along=12")
        check(done.returncode == 0, f"Lund and Thomsen's lemon, S = {s}: runs", done.stderr)
        found = columns_of(folder / "lund.film_history.csv")
        x, y = found["eccentricity_x[m]"][0] / pad, found["eccentricity_y[m]"][0] / pad
        check(abs(math.hypot(x, y) - eccentricity) < 2e-3 and abs(math.degrees(math.atan2(y, x)) - attitude) < 0.3,
              f"Lund and Thomsen's lemon, S = {s}", f"{math.hypot(x, y):.4f} at {math.degrees(math.atan2(y, x)):.2f} for {eccentricity} at {attitude}")

    # a tilt the other way: the opposite tilting moment; all of it in a mirror; a constant deviation is more clearance, a cosine an
    # eccentricity, worn depths are deviations
    cosine = [(0.9375 * i, 4e-6 * math.cos(math.radians(0.9375 * i))) for i in range(384)]   # at all cells and faces of 96 or 192
    for name, rows in (("wide", [(0.0, 5e-6), (120.0, 5e-6), (240.0, 5e-6)]), ("cosine", cosine), ("left", [(0.0, 1e-6), (40.0, 6e-6), (200.0, 0.0)]),
                       ("right", [(0.0, 1e-6), (160.0, 0.0), (320.0, 6e-6)])):
        write_table(folder / f"{name}.shape.csv", "angle[deg],deviation[m]", rows)
    (folder / "of_left.wear.csv").write_text(
        "joint,angle[deg],pin_depth[m],bore_depth[m],pin_volume[m3],bore_volume[m3]\npiston_pin,0,7e-6,1e-6,0,0\npiston_pin,40,0,6e-6,0,0\n"
        "piston_pin,200,0,0.0,0,0\ncrank_pin,0,0,9e-6,0,0\ncrank_pin,180,0,9e-6,0,0\n", encoding="utf-8-sig")   # as spreadsheets save it

    def film(name: str, group: str, c: float = 2.5e-5, r: float = 0.025025, load: str = plain, speed: float = 300.0) -> dict[str, float]:
        done = run(program, shaped(folder, name, load, oil, grooves, f"&shape {group} /" if group else "", c=c, r=r, speed=speed), folder)
        check(done.returncode == 0, f"{name} runs", done.stderr)
        return {key: value for key, (value,) in columns_of(folder / f"{name}.film_history.csv").items() if not key.startswith(OF_RUN)}

    def same(a: dict[str, float], b: dict[str, float], opposite: tuple[str, ...] = ()) -> str:
        return ", ".join(key for key in a if abs(a[key] - b[key] * (-1 if key.startswith(opposite) else 1)) > 1e-7 * abs(a[key]))

    across = ("film_tilting_moment_x", "film_tilting_moment_y")
    there, back = film("there", "tilt=1e-4, 5e-5"), film("back", "tilt=-1e-4, -5e-5")
    check(not same(there, back, across), "a tilt the other way: the opposite tilting moment", same(there, back, across))
    left, right = film("left", "table='left.shape.csv', barrel=1e-6, tilt=5e-5, 8e-5"), film("right", "table='right.shape.csv', barrel=1e-6, tilt=5e-5, -8e-5", load="load=-6000.0, -500.0", speed=-300.0)
    turned = ("eccentricity_y", "film_force_y", "film_moment", "film_tilting_moment_x")
    check(not same(left, right, turned), "a bearing in a mirror", same(left, right, turned))
    check(not same(left, film("worn", "table='of_left.wear.csv', barrel=1e-6, tilt=5e-5, 8e-5")), "worn depths are deviations")
    check(not same(film("wide", "table='wide.shape.csv'"), film("wider", "", 3e-5, 0.02503)), "a constant deviation is more clearance")
    shifted, round_one = film("shifted", "table='cosine.shape.csv'"), film("round_one", "")
    shifted["eccentricity_x[m]"] -= 4e-6
    moment = abs(shifted.pop("film_moment[N.m]") / round_one["film_moment[N.m]"] - 1)   # the slope of the table is one of differences
    check(not same(shifted, round_one) and moment < 1e-5, "a deviation like a cosine is an eccentricity", f"{same(shifted, round_one)} {moment:.1e}")
    fed = "&supply kind='circumferential_groove', groove_width=0.004, pressure=1e5 /"
    write_table(folder / "few.csv", "angle[deg],deviation[m]", [(0.0, 0.0), (180.0, 1e-6)])
    write_table(folder / "closed.csv", "angle[deg],deviation[m]", [(0.0, -3e-5), (120.0, 0.0), (240.0, 0.0)])
    write_table(folder / "far.csv", "angle[deg],deviation[m]", [(0.0, 0.0), (120.0, 0.0), (400.0, 0.0)])
    for supply, group, says in ((grooves, "tilt=3e-3, 0.0", "the pin would touch at its ends"), (fed, "tilt=1e-5, 0.0", "two equal lands"),
                                (grooves, "barrel=-1e-6", "barrel"), (grooves, f"table='{folder / 'few.csv'}'", "at least three rows"),
                                (grooves, f"table='{folder / 'closed.csv'}'", "the bore has no gap there"), (grooves, f"table='{folder / 'far.csv'}'", "more than one turn"),
                                (grooves, f"table='{folder / 'wide.shape.csv'}', factor=1e4", "at most 0.1 bearing_radius")):
        done = run(program, shaped(folder, "wrong", plain, oil, supply, f"&shape {group} /"), folder)
        check(done.returncode == 3 and says in done.stderr, f"refused: {group[-40:]}", done.stderr)


def check_refused(program: Path, folder: Path) -> None:
    """Wrong settings and files of earlier versions end with status 3, one line, and no result."""
    for settings, word in REFUSED:
        done = run(program, BEARINGS / "load_groove.nml", folder / "refused", *settings)
        check(done.returncode == 3 and word in done.stderr and done.stderr.count("\n") == 1, f"refused: {settings}", done.stderr)
    done = subprocess.run([program, "--check", BEARINGS / "load_groove.nml", "--set", "supply.kind=holes", "--set", "supply.diameter=1e-4"],
                          capture_output=True, text=True, check=False)
    check(done.returncode == 3 and "smaller than a cell" in done.stderr, "--check knows the cells", done.stderr)
    (folder / "old.nml").write_text("&joint clearance=3e-5, bearing_radius=0.02, bearing_length=0.02 /\n&lubrication viscosity=0.01 /\n"
                                    "&film_history drive='load', table='old.csv' /\n")
    done = run(program, folder / "old.nml", folder / "refused")
    check(done.returncode == 3 and done.stderr.count("\n") == 1 and done.stderr.endswith(
        "old.nml: a bearing by itself is a case with &bearing_load now: table or load, &initial crank_speed, &joint kind = 'quasi_static'; "
        "&film_history table is gone (manual: A bearing by itself)\n"), "an old file is refused once", done.stderr)
    check(not (folder / "refused").exists(), "no result of a refused case")


def check_constant(program: Path, folder: Path) -> None:
    """A bearing under a constant load, which may be a table, comes to rest, by every method, where rotation and load balance in the short
    film; errors of the integration are no motion."""
    (folder / "constant.load.csv").write_text("crank_angle[deg],load_x[N],load_y[N]\n0,-6200,900\n360,-6200,900\n720,-6200,900\n")
    places = []
    for method, load in (("adams", f"table={folder}/constant.load.csv"), ("radau", "load=-6200,900"), ("auto", "load=-6200,900"), ("auto", "load=-900,-6200")):
        turn = ("bearing_load.table=", "bearing_load.interpolation=linear", f"bearing_load.direction_deg={0 if load[5:7] != '-9' else -90}")
        done = run(program, TOP / "cases" / "bearings" / "main_bearing.nml", folder / "at_rest", *turn, f"bearing_load.{load}", f"integrator.method={method}")
        check(done.returncode == 0, f"constant load, {method}: runs", done.stderr)
        found = summary_of(folder / "at_rest" / "main_bearing.summary.csv")
        check(found["motion"] == "periodic" and int(found["periodic_after"]) < 40, f"constant load, {method}: comes to rest",
              f"{found['motion']} after {found.get('periodic_after')}")
        rows = columns_of(folder / "at_rest" / "main_bearing.csv")
        places.append((rows["eccentricity_x[m]"][-1], rows["eccentricity_y[m]"][-1]))
    off = max(math.dist(place, places[0]) for place in places) / math.hypot(*places[0])
    check(off < 1e-4, "the same place by a table, a load and a load that is turned", f"{off:.1e}")


def write_table(path: Path, head: str, rows: list[tuple[float, ...]]) -> None:
    path.write_text(head + "\n" + "".join(",".join(repr(value) for value in row) + "\n" for row in rows))


def equal_within(found: dict[str, list[float]], wanted: dict[str, list[float]], tolerance: float) -> str:
    """The columns that both have and that differ by more than the tolerance, over their scale."""
    wrong = []
    for name in (name for name in set(found) & set(wanted) if not name.startswith(OF_RUN)):
        error = max((abs(a - b) for a, b in zip(found[name], wanted[name])), default=math.inf) / scale_of(wanted, name)
        if error > tolerance or len(found[name]) != len(wanted[name]):
            wrong.append(f"{name} {error:.2g}")
    return ", ".join(wrong)


def check_after_runs(program: Path, folder: Path) -> None:
    """The film after the run of a joint with clearance."""
    quick = ("film_history.around=48", "film_history.along=4", "output.digits=17", "film_history.most_cycles=2")
    case = TOP / "cases" / "film" / "sim_I_fed.nml"
    done = run(program, case, folder, *quick)
    check(done.returncode == 0 and "film with memory at the piston pin" in done.stdout, "the film of sim_I_fed is marched", done.stderr)
    after = columns_of(folder / "sim_I_fed.film_history.csv")
    summary = summary_of(folder / "sim_I_fed.summary.csv")
    check(abs(float(summary["film_history_min_film_thickness"]) - min(after["min_film_thickness[m]"])) < 1e-15, "thinnest film, summary")
    check(float(summary["film_history_quick_min_film_thickness"]) == min(after["quick_film_thickness[m]"]), "film of the run, summary")
    again = run(program, folder / "sim_I_fed.resolved.nml", folder / "again")
    check(again.returncode == 0 and (folder / "again" / "sim_I_fed.resolved.film_history.csv").read_bytes() ==
          (folder / "sim_I_fed.film_history.csv").read_bytes(), "the resolved case gives the same film", again.stderr)
    # along the orbit of the run Reynolds' film without supply has the force of the run: frames, signs and speeds (grid: 1.5 %)
    done = run(program, case, folder / "orbit", "lubrication.cavitation=reynolds", "supply=none", "film_history.drive=orbit")
    rows, run_rows = columns_of(folder / "orbit" / "sim_I_fed.film_history.csv"), columns_of(folder / "orbit" / "sim_I_fed.csv")
    n = len(rows["time[s]"])
    error = max(math.hypot(a - c, b - d) for a, b, c, d in zip(
        rows["film_force_x[N]"], rows["film_force_y[N]"], run_rows["film_force_x[N]"][-n:], run_rows["film_force_y[N]"][-n:]))
    check(error < 0.05 * scale_of(run_rows, "film_force_x[N]"), "the film along an orbit has the force of the run", f"{error:.3g} N")
    check_big_end(program, folder, quick)


def check_alone(program: Path, folder: Path) -> None:
    """The film of a quasi-static bearing behind a mechanism is that of the bearing by itself under the load of that run: of a piston pin
    in fixed axes, of a big end, which turns with the rod, in those of the rod, where its load is that of the table."""
    text = (TOP / "cases" / "bearings" / "big_end.nml").read_text().replace("'short'", "'short', cavitation = 'mass_conserving'")
    groups = """&film_history place='{place}', around=48, along=4, most_cycles=2 /
&supply place='{place}', position_deg=100.0, width_deg=30.0, length=0.009, pressure=2.0e5 /
"""
    for place, prefix, bodies in (("piston_pin", "", "journal='rod', frame='fixed'"), ("crank_pin", "crank_pin_", "bearing='rod', frame='rod'")):
        (folder / f"{place}.nml").write_text(text.replace("place = 'crank_pin'", f"place = '{place}'") + groups.format(place=place))
        done = run(program, folder / f"{place}.nml", folder, "run.until=end", "integrator.revolutions=4", "output.sampling=crank_angle",
                   "output.samples_per_revolution=180", "output.digits=17")
        check(done.returncode == 0, f"behind a mechanism: {place}", done.stderr)
        if done.returncode:
            continue
        trace = {name: column[-361:] for name, column in columns_of(folder / f"{place}.csv").items()}
        rows = []
        for k in range(360):
            c, s = (math.cos(trace["rod_angle[rad]"][k]), math.sin(trace["rod_angle[rad]"][k])) if "frame='rod'" in bodies else (1.0, 0.0)
            x, y = -trace[f"{prefix}film_force_x[N]"][k], -trace[f"{prefix}film_force_y[N]"][k]
            rows.append((2.0 * k, c * x - s * y, s * x + c * y))
        write_table(folder / f"{place}.load.csv", "crank_angle[deg],load_x[N],load_y[N]", rows)
        start = trace[f"{prefix}eccentricity_x[m]"][0], trace[f"{prefix}eccentricity_y[m]"][0]
        (folder / f"{place}_alone.nml").write_text(
            f"&bearing_load table='{place}.load.csv', crank_to_rod=0.3, {bodies} /\n&initial crank_speed=314.1592653589793, eccentricity={start[0]!r}, {start[1]!r} /\n"
            + text[text.index("&joint"):text.index("&combustion")].replace("place = 'crank_pin', ", "") + groups.replace("place='{place}', ", "")
            + "&integrator revolutions=2 /\n&output sampling='crank_angle', samples_per_revolution=180, digits=17 /\n")
        done = run(program, folder / f"{place}_alone.nml", folder)
        check(done.returncode == 0, f"alone: {place}", done.stderr)
        alone = columns_of(folder / f"{place}_alone.film_history.csv")
        wrong = equal_within(alone, columns_of(folder / f"{place}.film_history.csv"), 1e-6)
        check(not wrong, f"alone as behind a mechanism: {place}", wrong)
        wrong = max(abs(alone["film_force_x[N]"][k - 1] + rows[k][1]) for k in range(1, 360)) / scale_of(alone, "film_force_x[N]")
        check(wrong < 1e-9, f"the load of the table is that of the film: {place}", f"{wrong:.1e}")


def check_big_end(program: Path, folder: Path, quick: tuple[str, ...]) -> None:
    """The bearing of the crank pin turns with the rod; an elastic bore by the table of its compliances; a supply over the crank
    angle; fields."""
    text = (TOP / "cases" / "joints" / "both_pins_lubricated.nml").read_text()
    supply = "&supply place = 'crank_pin', position_deg = 90.0, 270.0, width_deg = 30.0, length = 0.009, pressure = 2.0e5 /"
    bore = "&bore place = 'crank_pin', outer_radius = 0.03, modes = 3 /"
    (folder / "big_end.nml").write_text(f"{text}\n&film_history place = 'crank_pin' /\n{supply}\n{bore}\n")
    run_settings = (*(word.replace("film_history", "crank_pin.film_history") for word in quick), "output.sampling=crank_angle", "output.samples_per_revolution=360", "contact=none", "friction=none")
    done = run(program, folder / "big_end.nml", folder, *run_settings)
    check(done.returncode == 0, "a film with memory at the crank pin", done.stderr)
    trace = columns_of(folder / "big_end.csv")
    after = columns_of(folder / "big_end.film_history.csv")
    compliance = {n: value * 0.020 / 207.0e9 for n, value in ring_of(1.5, 0.3, 3).items()}
    rows = "".join(f"{n}{w},{n}{w},{value!r}\n" for n, value in compliance.items() for w in ("c", "s") if n) + f"0,0,{compliance[0]!r}\n"
    (folder / "bore.csv").write_text("load,shape,compliance[m/Pa]\n" + rows)
    (folder / "feed.csv").write_text("crank_angle[deg],pressure[bar]\n0,2\n350,2\n700,2\n")
    done = run(program, folder / "big_end.nml", folder / "table", *run_settings, "crank_pin.bore.outer_radius=0",
               f"crank_pin.bore.compliance_table={folder / 'bore.csv'}", f"crank_pin.supply.pressure_table={folder / 'feed.csv'}",
               f"output.film_times={trace['time[s]'][-100]!r}")
    check(done.returncode == 0, "a bore by its compliances, a supply over the crank angle", done.stderr)
    if done.returncode:
        return
    tabled = columns_of(folder / "table" / "big_end.film_history.csv")
    wrong = equal_within(tabled, after, 1e-5)
    check(not wrong, "compliances of a ring and a constant supply in tables give the same film", wrong)
    field = columns_of(folder / "table" / "big_end.film.csv")
    k = min(range(len(tabled["time[s]"])), key=lambda i: abs(tabled["time[s]"][i] - field["time[s]"][0]))
    check(abs(max(field["pressure[Pa]"]) / tabled["max_film_pressure[Pa]"][k] - 1) < 1e-12 and
          abs(min(field["film_thickness[m]"]) / tabled["min_film_thickness[m]"][k] - 1) < 1e-12, "field of pressure and gap")
    check(all(p == 0 or f == 1 for p, f in zip(field["pressure[Pa]"], field["film_fraction[-]"])), "p (1 - f) = 0 in the field")
    resolved = run(program, folder / "table" / "big_end.resolved.nml", folder / "again")
    check(resolved.returncode == 0 and (folder / "again" / "big_end.resolved.film_history.csv").read_bytes() ==
          (folder / "table" / "big_end.film_history.csv").read_bytes(), "the resolved case has its tables", resolved.stderr)
    for settings, word in AFTER_RUN_REFUSED:
        done = run(program, folder / "big_end.nml", folder / "refused", *settings)
        check(done.returncode == 3 and word in done.stderr, f"refused after a run: {settings}", done.stderr)


def ring_of(ratio: float, nu: float, modes: int) -> dict[int, float]:
    """Displacements E u/(a p) of the bore of a ring for cos n theta, by Airy's function with four conditions solved by elimination."""
    found = {0: (ratio**2 + 1) / (ratio**2 - 1) + nu}
    kappa = (3 - nu) / (1 + nu)
    for n in range(2, modes + 1):
        rows = []
        for r, load in ((1.0, -1.0), (ratio, 0.0)):
            rows.append([n * (1 - n) * r**(n - 2), (2 + n - n * n) * r**n, -n * (1 + n) * r**(-n - 2), (2 - n - n * n) * r**-n, load])
            rows.append([(n - 1) * r**(n - 2), (n + 1) * r**n, -(n + 1) * r**(-n - 2), -(n - 1) * r**-n, 0.0])
        for i in range(4):
            k = max(range(i, 4), key=lambda j: abs(rows[j][i]))
            rows[i], rows[k] = rows[k], rows[i]
            for j in range(4):
                if j != i:
                    factor = rows[j][i] / rows[i][i]
                    rows[j] = [a - factor * b for a, b in zip(rows[j], rows[i])]
        a, b, c, d = (rows[i][4] / rows[i][i] for i in range(4))
        found[n] = (1 + nu) * (-n * a + (kappa - n - 1) * b + n * c + (kappa + n - 1) * d)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to test instead of the fast build")
    options = parser.parse_args()
    program = options.program or Path(subprocess.run(
        [TOP / "scripts" / "build.sh"], capture_output=True, text=True, check=True, cwd=TOP).stdout.strip())
    program = program.resolve()
    with tempfile.TemporaryDirectory() as name:
        check_references(program, Path(name))
        check_services(program, Path(name))
        check_limits(program, Path(name))
        check_constant(program, Path(name))
        check_shapes(program, Path(name))
        check_refused(program, Path(name))
        check_alone(program, Path(name))
        check_after_runs(program, Path(name))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
