#!/usr/bin/env python3
"""The Python package against the program: the same cases give the same bits, whatever the way in.

    tests/test_python.py PROGRAM [--all]

Needs NumPy and pandas, and the shared library: that of the environment variable GUDGEON_LIBRARY, or else build/library.
With --all every shipped case is compared. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import ast
import copy
import doctest
import html
import importlib
import keyword
import math
import multiprocessing
import os
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts" / "python" / "src"))
os.environ.setdefault("GUDGEON_LIBRARY", str(TOP / "build" / "library" / "libgudgeon.so"))
import gudgeon
import matplotlib
import numpy as np
import pandas as pd
from assertions import Assertions
from gudgeon import _fit
from scipy import stats

matplotlib.use("Agg")

#: One case of each kind that ends soon; tables of films take too long here.
CASES = [
    "sim_I", "sim_V", "sim_II_oscillating", "flores/friction_100", "friction/lugre", "gas/compressor", "gas/measured",
    "joints/both_pins", "joints/piston_slap", "elastic/engine_rod", "drive/motor", "drive/start_up", "wear/worn_bore",
]  # fmt: skip
assertions = Assertions()
check, refuses = assertions.check, assertions.refuses


def case_of(name: str) -> gudgeon.Case:
    return gudgeon.read(TOP / "cases" / f"{name}.nml")


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    """Equal, but for the sign of a zero, which files do not have."""
    return a.shape == b.shape and (a + 0.0).tobytes() == (b + 0.0).tobytes()


def against_program(program: str, names: list[str]) -> None:
    """Columns, events, summary and files of runs are those of the command line; the same with pauses."""
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            path = TOP / "cases" / f"{name}.nml"
            done = subprocess.run([program, "-q", "-o", folder, "-s", "output.digits=17", str(path)], capture_output=True, text=True)
            base = Path(folder) / Path(name).name
            if not Path(f"{base}.csv").is_file():
                check(False, f"{name}: {done.stderr}")
                continue
            want = gudgeon.load(base)
            case = case_of(name).set({"output.digits": 17})
            began = base.with_suffix(".state.nml").read_text().splitlines()[1:]
            try:
                run = case.run()
            except gudgeon.RunError as error:
                run = error.run
            check(run.names == want.names and run.units == want.units, f"{name}: columns")
            check(same_bits(run._rows, want._rows), f"{name}: rows are those of the command line, bit for bit")
            check(run.events.astype(str).equals(want.events.astype(str)), f"{name}: events")
            passing = ("wall_time", "film_table_time", "compiler", "compiler_options")
            differ = [q for q in {*run.summary, *want.summary} if q not in passing and run.summary.get(q) != want.summary.get(q)]
            check(not differ, f"{name}: quantities {differ} of the summary")
            stepper = case.begin()
            for i in range(1, 314):
                stepper.advance(stepper.end * i / 314)
            while not stepper.advance(1e300):
                pass
            check(same_bits(stepper.finish()._rows, want._rows), f"{name}: 313 pauses change nothing")
            check(run.state and run.state == want.state, f"{name}: the state is that of the command line, bit for bit")
            saved = run.save(Path(folder) / "saved").with_suffix(".state.nml").read_text().splitlines()[1:]
            check(saved == began, f"{name}: so is its file, with what the run has counted")
            for suffix in (".csv", ".events.csv", ".wear.csv", ".resolved.nml"):
                if Path(f"{base}{suffix}").is_file():
                    both = [Path(part, base.name + suffix).read_bytes() for part in (folder, f"{folder}/saved")]
                    check(both[0] == both[1], f"{name}{suffix} is saved as the command line writes it")


def cases() -> None:
    """Reading, changing, writing and refusing cases."""
    case = case_of("sim_I")
    check(gudgeon.Case.from_text(case.to_nml()) == case, "a case is read back from its own text")
    check(gudgeon.Case.from_text(case.to_nml(complete=True)).run().status == "done", "so is the complete one")
    check(pickle.loads(pickle.dumps(case)) == case, "a case is pickled as its text")
    other = case.set({"joint.clearance": 3e-5}, drive={"torque": 3})
    check(other.diff(case) == {"joint.clearance": (3e-5, 2e-5), "drive.torque": (3.0, 0.0)}, f"diff: {other.diff(case)}")
    check(case.joint.clearance == 2e-5, "a changed copy leaves the case")
    case.integrator.end_time = 0.01
    check(not case.is_given(gudgeon.keys["integrator.revolutions"]) and case.run().summary["simulated_time"] == 0.01, "ends: the last one counts")
    case.integrator.revolutions = 1
    check(case.check() == [] and case["integrator.end_time"] == 0, "also when it is set the other way round")
    del case.joint.clearance
    refuses(gudgeon.CaseError, "&joint clearance", case.check)
    case.add("guide", coefficient=0.1, v0=1e-3, v1=1e-2)
    check("guide" in case, "a group is added")
    case.remove("guide")
    check("guide" not in case and not case.guide, "a group is removed")
    check("clearance" in dir(case.joint) and "crank_pin" in dir(case) and "joint" in dir(case.crank_pin), "names are completed")
    check("radial clearance" in case.joint.__doc__ and "> 0" in case.joint.__doc__, "help has meaning and limits")
    refuses(KeyError, "did you mean joint.clearance?", lambda: case["joint.clearence"])
    refuses(AttributeError, "did you mean clearance?", lambda: setattr(case.joint, "clearence", 1))
    refuses(AttributeError, "did you mean joint?", lambda: case.jiont)
    refuses(gudgeon.CaseError, "must be one of", lambda: setattr(case.contact, "law", "herz"))
    refuses(gudgeon.CaseError, "must be a whole number", lambda: setattr(case.integrator, "max_order", 1.5))
    refuses(gudgeon.CaseError, "1e-30", lambda: setattr(case.joint, "clearance", math.nan))
    refuses(gudgeon.CaseError, "must be a file in the folder", lambda: case.set({"drive.torque_table": "/etc/passwd"}).check())
    refuses(gudgeon.CaseError, "must be a file in the folder", lambda: case.set({"drive.torque_table": "../x.csv"}).check())
    refuses(gudgeon.CaseError, "has no folder: gudgeon.Case.from_text(text, folder='/')", lambda: gudgeon.Case.from_text(case_of("drive/motor").to_nml()).check())
    check(gudgeon.Case.from_text(case_of("drive/motor").to_nml(), folder="/").check() is not None, "a case with a table is read back where any folder is allowed")
    with tempfile.TemporaryDirectory() as folder:
        odd = Path(folder) / "odd.nml"
        odd.write_bytes("&joint clearance = 20 µm /".encode("latin-1"))
        refuses(gudgeon.CaseError, "odd.nml:1: &joint clearance: \\xB5m: not UTF-8", lambda: gudgeon.read(odd).check())
        odd.write_text("&joint clearance = 20 um /", encoding="utf-16")
        refuses(gudgeon.CaseError, "odd.nml: encoded in UTF-16", lambda: gudgeon.read(odd))
    try:
        case_of("sim_I").set({"joint.clearance": -1}).check()
    except gudgeon.CaseError as error:
        check(error.key == "joint.clearance", f"an error names its key: {error.key}")
    for change in (lambda: setattr(case_of("film/heat").lubrication, "temperature", 380.0), lambda: case_of("film/heat").set({"heat.conductance": 3}),
                   lambda: gudgeon.sweep(case_of("film/heat"), {"lubrication.temperature": [370, 380]}, errors="raise"), lambda: case_of("film/heat").add("heat", conductance=1)):
        refuses((gudgeon.CaseError, RuntimeError), "the case has this group for crank_pin: write crank_pin.", change)
    shared = case_of("bearings/big_end_heat").set({"crank_pin.lubrication.temperature": 365})
    check(shared.crank_pin.lubrication.oil == shared.lubrication.oil and shared.check() == [], "a group of one joint begins with the values for all joints")
    refuses(gudgeon.CaseError, "write crank_pin.lubrication.temperature", lambda: setattr(shared.lubrication, "temperature", 350.0))
    masses = case_of("sim_I").set({"mechanism.crank_com[2]": 1e-3})
    check(masses["mechanism.crank_com"] == (0.0, 1e-3) == gudgeon.Case.from_text(masses.to_nml())["mechanism.crank_com"], "one number of a list")
    masses["mechanism.crank_com[1]"] = "2 mm"
    check(masses["mechanism.crank_com[1]"] == 2e-3 and masses["mechanism.crank_com[2]"] == 1e-3, "with a unit, the other one stays")
    shaft = case_of("cylinders/four_dry").set({"crankshaft.inertia[2]": 3e-3})
    check(shaft["crankshaft.inertia"] == (0.004, 0.003, 0.002, 0.002, 0.002, 0.12) and shaft.check() == [], "of six numbers")
    refuses(KeyError, "no key mechanism.crank_com[3]", lambda: masses["mechanism.crank_com[3]"])
    refuses(KeyError, "no key joint.clearance[1]", lambda: masses.set({"joint.clearance[1]": 1e-5}))
    refuses(gudgeon.CaseError, "crankshaft.inertia: number 1 must be given before", lambda: case_of("sim_I").set({"crankshaft.inertia[2]": 1.0}))
    key = gudgeon.keys["contact.restitution"]
    check(key.bounds == (0, 1, True, True) or key.bounds[:2] == (0, 1), f"bounds: {key.bounds}")
    long = [k.name for k in gudgeon.keys.values() if len(k.meaning) >= 250 or len(", ".join(k.words)) > 500]
    check(len(gudgeon.keys) > 200 and not long, f"no declaration is cut: {long}")
    check(gudgeon.template("film").run(end=0.001).status == "done", "a template runs")
    check({c.name for c in case_of("sim_I").columns} == set(case_of("sim_I").run(end=0.001).names), "columns are known before the run")


def round_trips() -> None:
    """Every template and every shipped case is read back from its own text, complete or not, and from its pickle."""
    shipped = [path for path in sorted((TOP / "cases").rglob("*.nml")) if "&mechanism" in path.read_text()]
    kinds = ("complete", "dry", "film", "engine", "compressor", "slap", "elastic", "wear")
    for case in [gudgeon.read(path) for path in shipped] + [gudgeon.template(kind) for kind in kinds]:
        want = case.to_nml(complete=True)
        for way in (case.to_nml(), want):
            check(gudgeon.Case.from_text(way, case.name, case._folder).to_nml(complete=True) == want, f"{case.name} is read back from its text")
        again = pickle.loads(pickle.dumps(case))
        check(again == case and again.to_nml(complete=True) == want, f"{case.name} is read back from its pickle")
    oiled = gudgeon.template("engine")
    refuses(gudgeon.CaseError, "gives it", lambda: oiled.set({"lubrication.density": 900}).check())
    check("oil = 'SAE" in oiled.to_nml() and "oil = 'SAE" in oiled.to_nml(complete=True), "the name of an oil is written")


def links() -> None:
    """A link in the folder of a case does not lead out of it; the message has nothing of the file that it points to."""
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder, "inside")
        inside.mkdir()
        Path(folder, "secret.csv").write_text("secret words\n")
        (inside / "table.csv").symlink_to("../secret.csv")
        text = case_of("drive/motor").set({"drive.torque_table": "table.csv"}).to_nml()
        refuses(gudgeon.CaseError, "must be a file in the folder", gudgeon.Case.from_text(text, folder=inside).check)
        try:
            gudgeon.Case.from_text(text, folder=inside).check()
        except gudgeon.CaseError as error:
            check("secret" not in str(error), f"a message has no word of the file: {error}")
        (inside / "table.csv").unlink()
        (inside / "table.csv").symlink_to("other.csv")
        (inside / "other.csv").write_bytes((TOP / "cases/drive/motor.csv").read_bytes())
        Path(folder, "linked").symlink_to("inside")
        for place in (inside, Path(folder, "linked")):
            check(gudgeon.Case.from_text(text, folder=place).check() is not None, "a link within the folder, or to it, is followed")


def copies() -> None:
    """A run is pickled and copied without the memory of the library, and comes back from other processes; what goes on is refused."""
    case = case_of("wear/worn_bore")
    run = case.run(end=0.02)

    def is_same(other: gudgeon.Run) -> bool:
        tables = {name: table.equals(other.tables[name]) for name, table in run.tables.items()}
        words = {name: value for name, value in run.summary.items() if name != "wall_time"}
        found = {name: value for name, value in other.summary.items() if name != "wall_time"}
        same = same_bits(run._rows, other._rows) and run.events.equals(other.events) and words == found and run.case == other.case
        return same and list(tables) == ["wear"] and all(tables.values()) and not other["time"].flags.writeable

    check(is_same(pickle.loads(pickle.dumps(run))) and is_same(copy.deepcopy(run)), "a run is pickled and copied")
    limited = case_of("sim_V").set({"integrator.max_steps": 50})
    for start in ("fork", "spawn"):
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context(start)) as pool:
            check(is_same(pool.submit(case.run, end=0.02).result()), f"a run comes back from a process ({start})")
            error = pool.submit(limited.run).exception()
            check(isinstance(error, gudgeon.RunError) and len(error.run) > 0, f"so does that of an error ({start}): {error}")
    stepper = case.begin(end=0.02)
    for one in (stepper, stepper.snapshot(), stepper.inputs):
        for action in (pickle.dumps, copy.deepcopy):
            refuses(TypeError, "neither pickled nor copied", lambda one=one, action=action: action(one))
    saved = stepper.snapshot()
    for other in (case_of("sim_I"), case.set({"joint.clearance": 3e-5})):
        refuses(ValueError, "another case", lambda other=other: other.begin(end=0.02).restore(saved))
    other = case.begin(end=0.02)
    stepper.advance(0.01)
    other.restore(stepper.snapshot())
    check(other.t == 0.01, "a state of a run of an equal case is put back")
    for time_ in (math.nan, math.inf):
        refuses(ValueError, "finite number", lambda time_=time_: stepper.advance(time_))
        refuses(ValueError, "finite number", lambda time_=time_: case.run(until=time_))
        refuses(ValueError, "finite number", lambda time_=time_: case.run(end=time_))


def starts(program: str) -> None:
    """Runs that start from the motion of another one."""
    for name in ("friction/lugre", "gas/compressor", "joints/piston_slap", "elastic/engine_rod"):
        case = case_of(name).set({"output.digits": 17, "output.ideal_twin": False, "integrator.end_time": 0.02})
        first = case.run()
        with tempfile.TemporaryDirectory() as folder:
            base = first.save(folder)
            file = TOP / "cases" / f"{name}.nml"
            sets = ["output.digits=17", "output.ideal_twin=F", "integrator.end_time=0.02", "initial.goes_on=F"]
            words = [word for one in sets for word in ("-s", one)]
            done = subprocess.run([program, "-q", "-o", f"{folder}/on", *words, "--from", f"{base}.state.nml", str(file)], capture_output=True, text=True)
            want = gudgeon.load(f"{folder}/on/{base.name}")
            loaded = gudgeon.load(base)
            check(loaded.state == first.state, f"{name}: the state is read with the files")
        on = case.start_from(first)
        check(same_bits(on.run()._rows, want._rows), f"{name}: a run goes on as that of the command line, bit for bit {done.stderr}")
        for start in (first.state, loaded, pickle.loads(pickle.dumps(first))):
            check(case.start_from(start) == on and same_bits(case.start_from(start).run()._rows, want._rows), f"{name}: from numbers too")
        check(pickle.loads(pickle.dumps(on)) == on and on.copy().start == first.state and on != case, f"{name}: copies keep their start")
        check(on.start_from(None) == case and same_bits(on.start_from(None).run()._rows, first._rows), f"{name}: a start is taken back")
    case = case_of("friction/coulomb_static")
    stepper = case.begin(end=0.01)
    stepper.advance(0.0071)  # inside a step
    values, on = stepper.values, case.start_from(stepper).run(end=1e-4)
    for column in ("eccentricity_x", "eccentricity_y", "piston_velocity", "pin_force_x"):
        check(abs(on[column][0] - values[column]) < 1e-9 * np.abs(on[column]).max(), f"a start inside a step: {column} {on[column][0]} {values[column]}")
    stepper.advance(0.01)
    check(same_bits(stepper.finish()._rows, case.run(end=0.01)._rows), "to ask for the state changes nothing")
    changed = case.start_from(stepper).start_from({"crank_angle": 1.5})
    check(changed.start["crank_angle"] == 1.5 and changed.run(end=1e-4)["crank_angle"][0] == 1.5, "one number of a start is changed")
    refuses(ValueError, "did you mean eccentricity?", lambda: case.start_from({"ecentricity": 0.0}))
    refuses(ValueError, "1 numbers, but the case has 2", lambda: case.start_from({"eccentricity": 0.0}))
    refuses(gudgeon.CaseError, "finite", lambda: case.start_from({"crank_angle": math.nan}))
    refuses(gudgeon.CaseError, "the start of the case: &initial", lambda: case_of("sim_IV").start_from(stepper).run())
    refuses(ValueError, "only a whole run", lambda: case.start_from(case.run(end=0.05).cycle()))


def damaged() -> None:
    """A damaged file of a run is one error that names it."""
    run = case_of("sim_I").run(end=0.01)
    with tempfile.TemporaryDirectory() as folder:
        for suffix in (".csv", ".summary.csv", ".events.csv"):
            for wrong in (b"", b"\xff\xfe\x00", b"time[s],x[m]\n1,2\n3\n", b"a,b\n1,x\n"):
                base = run.save(folder)
                Path(f"{base}{suffix}").write_bytes(wrong)
                refuses(ValueError, f"sim_I{suffix}: not a file of results", lambda base=base: gudgeon.load(base))


def runs() -> None:
    """What a run gives, how it stops, and that its memory is safe."""
    run = case_of("sim_I").run(ideal_twin=True)
    check(not run["time"].flags.writeable and run.pin_force_x is not None, "columns are read-only views")
    column = run["piston_position"]
    before = column.copy()
    twin = run.twin
    del run
    case_of("sim_V").run(end=0.05)
    check(same_bits(np.array(column), before), "a column keeps its memory")
    check(twin is not None and "eccentricity_x" not in twin.names, "the twin has no clearance")
    run = case_of("sim_I").run()
    refuses(KeyError, "did you mean pin_force_x?", lambda: run["pin_forse_x"])
    refuses(AttributeError, "no column", lambda: run.nothing)
    check(list(run.to_pandas().columns) == run.names and run.units["pin_force_x"] == "N", "a table of pandas")
    check(abs(run.at(run["time"][100])["crank_angle"] - run["crank_angle"][100]) < 1e-12, "values at a time")
    end = run["time"][-1]
    rounded = end * (1 + 5e-11)  # as the ten digits of a summary may say
    check(run.at(rounded)["crank_angle"] == run["crank_angle"][-1] and run.at(0)["time"] == 0, "values at the ends of a run")
    refuses(ValueError, "not within the run", lambda: run.at(1.000001 * end))
    check(abs(run.at(crank_angle_deg=90)["crank_angle"] - math.pi / 2) < 1e-6, "values at a crank angle")
    cycle = run.cycle()
    turn = abs(cycle["crank_angle"][-1] - cycle["crank_angle"][0])
    check(abs(turn / (2 * math.pi) - round(turn / (2 * math.pi))) < 0.01, f"the last cycle turns whole revolutions: {turn}")
    cycles = run.cycles
    check(len(cycles) == int(run.summary["crank_revolutions"]) and cycles["crank_speed"]["largest"].iloc[-1] == cycle["crank_speed"].max(), "cycles")
    with tempfile.TemporaryDirectory() as folder:
        run.animate(frames=3).save(Path(folder) / "run.gif", writer="pillow")
        check(Path(folder, "run.gif").stat().st_size > 5000, "an animation")
    from matplotlib import pyplot

    axes = pyplot.figure().gca()
    check(gudgeon.compare(run, run, ax=axes)["largest"].max() == 0 and len(axes.lines) > 20, "a run is not apart from itself")
    axes = pyplot.figure().gca()
    check(run.plot("pin_force_x", over="crank_angle", cycle=-1, ax=axes) is axes, "columns are drawn")
    check(set(np.diff(axes.get_xticks())) == {90.0}, "crank angles have a tick each 90 degrees", str(axes.get_xticks()))
    pyplot.close("all")
    dataset = run.to_xarray()
    check(dataset.pin_force_x.attrs["units"] == "N" and float(dataset.crank_angle[5]) == run["crank_angle"][5], "a dataset of xarray")
    with tempfile.TemporaryDirectory() as folder:
        run.to_parquet(Path(folder) / "run.parquet")
        check(pd.read_parquet(Path(folder) / "run.parquet").equals(run.to_pandas()), "a table of parquet")
    found = gudgeon.orders(run, "piston_acceleration")
    check(found.order[found.amplitude.idxmax()] == 1 and set(found) == {"order", "amplitude", "phase_deg", "scatter"}, "orders")
    check("<svg" in run._repr_html_() and "sim_I" in run._repr_html_(), "a run shows itself")
    valves = gudgeon.template("compressor").set({"mechanism.piston_mass": 30.0}).run()
    shown = valves._repr_html_()   # answers in readable units, as gudgeon.table has them, with the notes of the run
    check("cycle_start" not in shown and f"{valves.summary['cycle_max_force'] / 1e3:.3g} kN" in shown and "last cycle" in shown, f"answers of a run that shows itself: {shown[-2000:]}")
    check(all(html.escape(note) in shown for note in valves.notes) and valves.notes, f"and its notes: {valves.notes}")
    title = case_of("sim_I")
    title.name = "<script>"
    check("<script>" not in title.run(end=0.001)._repr_html_(), "names are escaped")
    short = case_of("sim_I").run(until=0.01)
    check(short["time"][-1] <= 0.01 and "interrupted" in short.status and same_bits(short._rows[-5], run._rows[len(short) - 5]), "until")
    shares: list[float] = []
    case_of("sim_I").run(progress=shares.append)
    check(shares == sorted(shares) and shares[-1] == 1, "progress")
    long = case_of("sim_V").set({"integrator.revolutions": 10000}).set({"output.columns": "none"})
    began = time.process_time()   # which other processes do not use; the whole run takes 10 s, the one below hours
    refuses(TimeoutError, "more than", lambda: long.run(timeout=0.1))
    check(time.process_time() - began < 5, "a timeout ends a run")
    dear = case_of("film/sim_I_finite").set({"lubrication.variant": "direct", "lubrication.film_points": 256, "integrator.method": "radau"})
    began = time.process_time()
    refuses(TimeoutError, "more than", lambda: dear.run(timeout=1))
    check(time.process_time() - began < 8, "a timeout ends a run whose steps take seconds")
    threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    began = time.process_time()
    try:
        long.run()
        check(False, "Ctrl-C is not lost")
    except KeyboardInterrupt as error:
        check(error.run.summary["simulated_time"] > 0, "Ctrl-C keeps the run so far")
        check(time.process_time() - began < 5, "Ctrl-C is felt soon")
    limited = case_of("sim_V").set({"integrator.max_steps": 50})
    try:
        limited.run()
        check(False, "a run that cannot go on raises RunError")
    except gudgeon.RunError as error:
        check("steps" in str(error) and len(error.run) > 0, f"RunError has the run: {error}")
    certificate = case_of("sim_I").certify()
    check(3 < certificate.digits < 12 and certificate.until > 0.01, f"a certificate: {certificate.digits}")


def steps() -> None:
    """Saved states and inputs."""
    reeds = {"valve_1.mass": 1e-3, "valve_1.damping": 0.5}
    for name, more in (("sim_I", {}), ("flores/friction_100", {}), ("gas/compressor", {}), ("gas/compressor_valves", reeds), ("wear/worn_bore", {})):
        for method in ("adams", "radau", "auto"):
            stepper = case_of(name).set({"integrator.method": method, **more}).begin()
            end = min(stepper.end, 0.05)
            stepper.advance(0.4 * end)
            saved = stepper.snapshot()
            stepper.advance(0.5 * end)
            first = stepper.values
            stepper.restore(saved)
            check(stepper.t == 0.4 * end, f"{name}, {method}: the time is put back")
            stepper.advance(0.5 * end)
            check(np.array_equal([*first.values()], [*stepper.values.values()], equal_nan=True), f"{name}, {method}: the same values")
    free = case_of("sim_I").set(drive={"kind": "free"})
    tight = free.set({"integrator.relative_tolerance": 1e-9, "integrator.method": "adams"})
    smooth, cut = tight.begin(end=0.02), tight.begin(end=0.02)
    loose = free.set({"integrator.relative_tolerance": 1e-11, "integrator.method": "adams"}).begin(end=0.02)
    for i in range(1, 501):
        cut.inputs["drive.torque"] = 1e-12 * i  # new values, to be felt nowhere
        cut.advance(0.02 * i / 500)
    smooth.advance(1)
    loose.advance(1)
    error = np.abs(smooth.finish()["crank_speed"] - loose.finish()["crank_speed"]).max()
    apart = np.abs(smooth.finish()["crank_speed"] - cut.finish()["crank_speed"]).max()
    check(apart < 5 * max(error, 1e-9), f"500 cuts: {apart}, own error {error}")
    alone = case_of("sim_I").set(drive={"kind": "free"}).begin(end=0.05).inputs
    case_of("sim_V").run(end=0.01)
    check(alone["drive.torque"] == 0, "inputs keep their run")
    held = case_of("sim_I").set(drive={"kind": "constant_speed"}).begin(end=0.05)
    check([*held.inputs] == ["drive.crank_speed"], f"a prescribed speed is an input: {held.inputs}")
    start = held.inputs["drive.crank_speed"]
    held.advance(0.01)
    held.inputs["drive.crank_speed"] = 1.1 * start
    held.advance(0.02)
    middle = held.values
    held.advance(0.03)
    check(abs(middle["crank_speed"] - 1.1 * start) < 1e-9 * start, "a ramp reaches its value")
    check(abs(held.values["crank_speed"] - 1.1 * start) < 1e-9 * start and held.values["crank_acceleration"] == 0, "and ends there")
    turned = start * 0.01 + 1.05 * start * 0.01 + 1.1 * start * 0.01
    check(abs(held.values["crank_angle"] - held.run["crank_angle"][0] - turned) < 1e-9 * turned, "the angle is its integral")
    check(abs(held.finish().summary["max_energy_residual_relative"]) < 1e-5, "the ledger of energy is kept")
    outside = case_of("sim_I").set(cylinder_pressure={"kind": "external", "bore": 0.07, "pressure": 2e5})
    stepper = outside.begin(end=0.02)
    check("cylinder_pressure" in stepper.inputs and stepper.inputs["cylinder_pressure"] == 2e5, "a pressure from outside is an input")
    stepper.advance(0.01)
    stepper.inputs["cylinder_pressure"] = 5e5
    stepper.advance(0.015)
    area = math.pi / 4 * 0.07**2
    check(abs(stepper.values["gas_force"] - (5e5 - 101325) * area) < 1e-6, "the pressure acts on the piston")
    check(stepper.finish().summary["max_energy_residual_relative"] < 1e-5, "its work is in the ledger")
    refuses(KeyError, "there are: ", lambda: stepper.inputs.__setitem__("nothing", 1))
    refuses(ValueError, "finite", lambda: stepper.inputs.__setitem__("cylinder_pressure", math.inf))


def top_of(run: gudgeon.Run) -> dict[str, float]:
    return {"top": float(run["piston_position"].max())}


def sweeps() -> None:
    """Designs, their order whatever the threads, errors, and that a sweep that was stopped goes on."""
    case = case_of("sim_I").set({"integrator.revolutions": 1})
    design = {"joint.clearance": np.linspace(1e-5, 4e-5, 5), "friction.coefficient": [0.05, 0.1]}
    table = gudgeon.sweep(case, design, workers=2)
    check(len(table) == 10 and (table["status"] == "done").all(), "all runs are done")
    for row in (0, 7):
        alone = case.set({name: table[name][row] for name in design}).run(columns="none")
        check(alone.summary["max_pin_force"] == table["max_pin_force"][row], f"row {row} has the bits of a run alone")
    check(gudgeon.sweep(case, design, workers=1).equals(table), "threads change nothing")
    table = gudgeon.sweep(case, {"mechanism.rod_com[2]": [0.0, 2e-3]})
    alone = case.set({"mechanism.rod_com": (case["mechanism.rod_com[1]"], 2e-3)}).run(columns="none")
    check(alone.summary["max_pin_force"] == table["max_pin_force"][1] != table["max_pin_force"][0], "one number of a list is swept")
    table = gudgeon.sweep(case, {"joint.clearance": [1e-5, -1.0, 2e-5]}, reduce=lambda run: {"top": run["piston_position"].max()})
    check(list(table["status"] == "done") == [True, False, True] and "must be > 0" in table["status"][1], "a wrong row says why")
    check(table["top"][2] > 0.1, "reduce has the rows of the run")
    refuses(RuntimeError, "row 1", lambda: gudgeon.sweep(case, {"joint.clearance": [1e-5, -1.0]}, errors="raise"))
    refuses(RuntimeError, "reduce, row 0", lambda: gudgeon.sweep(case, {"joint.clearance": [1e-5]}, reduce=lambda run: run["nothing"]))
    refuses(KeyError, "did you mean", lambda: gudgeon.sweep(case, {"joint.clearence": [1]}))
    table = gudgeon.sweep(case, np.array([[1e-5, 0.1], [2e-5, 0.2]]), names=["joint.clearance", "friction.coefficient"], keep=["contacts"])
    check(list(table.columns) == ["joint.clearance", "friction.coefficient", "status", "contacts"], "an array with names")
    shares: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "sweep.parquet"
        first = gudgeon.sweep(case, design, store=store, progress=shares.append)
        check(shares == sorted(shares) and shares[-1] == 1 and store.is_file(), "progress, and rows that are kept")
        kept = pd.read_parquet(store)
        kept.iloc[:4].to_parquet(store)
        again = gudgeon.sweep(case, design, store=store)
        check(again.astype(str).equals(first.astype(str)), "a sweep goes on from the rows that are kept")
        refuses(ValueError, "another design", lambda: gudgeon.sweep(case, {"joint.clearance": [1e-5, 2e-5]}, store=store))
    apart = gudgeon.sweep(case, {"joint.clearance": [1e-5, 2e-5]}, reduce=top_of, workers="processes")
    check(list(apart["top"]) == [top_of(case.set({"joint.clearance": c}).run())["top"] for c in (1e-5, 2e-5)], "a sweep in processes")
    long = case.set({"integrator.revolutions": 300})
    ends: list[float] = []

    def stops(_: gudgeon.Run) -> dict:
        ends.append(time.monotonic())
        if len(ends) == 1 + (os.cpu_count() or 1):   # one of the threads has kept a row
            os.kill(os.getpid(), signal.SIGINT)
        return {}

    try:
        gudgeon.sweep(long, {"joint.clearance": np.linspace(1e-5, 4e-5, 2000)}, reduce=stops)
        check(False, "Ctrl-C ends a sweep")
    except KeyboardInterrupt as error:
        waited = time.monotonic() - ends[os.cpu_count() or 1]
        check(waited < 30, f"Ctrl-C in a sweep is felt after {waited:.2f} s")
        check(0 < len(error.table) < 2000 and (error.table["status"] == "done").all(), "the rows so far are kept")


def threads() -> None:
    """Messages and bits in eight threads."""
    alone = case_of("sim_I").run(end=0.01, columns="none").summary["max_pin_force"]
    wrong: list[str] = []

    def work(number: int) -> None:
        case = case_of("sim_I")
        for i in range(100):
            name = f"nothing_{number}_{i}"
            try:
                gudgeon.Case.from_text(f"&mechanism {name} = 1 /").check()
            except gudgeon.CaseError as error:
                if name not in str(error):
                    wrong.append(str(error))
            if i % 10 == 0 and case.run(end=0.01, columns="none").summary["max_pin_force"] != alone:
                wrong.append("other bits")

    all_of_them = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in all_of_them:
        thread.start()
    for thread in all_of_them:
        thread.join()
    check(not wrong, f"threads do not disturb each other: {wrong[:3]}")


def tables_beside() -> None:
    """While one thread waits for a table of a film, others read and check cases."""
    with tempfile.TemporaryDirectory() as folder:
        case = case_of("film/sim_I_finite")
        case.cache(folder)
        case.lubrication.cavitation = "reynolds"
        case.lubrication.film_points = 256
        ended: list[float] = []
        began = time.monotonic()
        waits = threading.Thread(target=lambda: (case.run(end=1e-5, columns="none"), ended.append(time.monotonic())))
        waits.start()
        time.sleep(0.1)   # the table takes more than a second
        check(waits.is_alive(), "the table is being made")
        case_of("sim_I").check()
        checked = time.monotonic()
        waits.join()
        check(checked - began < 0.5 * (ended[0] - began), f"a check in {checked - began:.2f} s beside a table of {ended[0] - began:.2f} s")


def static_lengths() -> None:
    """gfortran keeps the length of a function's text in static memory, which threads share: no such function is called while a run
    advances, neither directly nor by the models and integrators, whose procedures are called through tables."""
    library = os.environ["GUDGEON_LIBRARY"]
    symbols = subprocess.run(["nm", library], capture_output=True, text=True, check=True).stdout
    lengths = {int(line.split()[0], 16) for line in symbols.splitlines() if " slen." in line}
    users, calls, name = set(), {}, ""
    for line in subprocess.run(["objdump", "-d", "--no-show-raw-insn", library], capture_output=True, text=True, check=True).stdout.splitlines():
        if line.endswith(">:"):
            name = line.partition("<")[2][:-2]
        elif (found := re.search(r"# ([0-9a-f]+) <", line)) and int(found[1], 16) in lengths:
            users.add(name)
        elif found := re.search(r"\b(?:call|jmp) +[0-9a-f]+ <([^>+]+)>", line):
            calls.setdefault(name, set()).add(found[1].removesuffix("@plt"))
    reached, waiting = set(), ["gudgeon_run_advance"]
    while waiting:
        if (name := waiting.pop()) not in reached:
            reached.add(name)
            waiting += calls.get(name, ())
    check(len(lengths) > 100 and len(reached) > 50 and not reached & users, f"an advance calls {reached & users}")
    layers = "ode model chain contact friction film gas joint".split()
    modules = {path.stem for layer in layers for path in (TOP / "src" / layer).rglob("*.f90")}
    # before a run: checks, tables, names; after it: errors of the film with memory
    apart = {"conflict", "static_conflict", "description", "declare", "make_table", "find_oil", "make_step", "wiebe_misfit", "pin_title"}
    wrong = [user for user in users if (of := re.match(r"__(\w+)_MOD_(\w+)", user)) and of[1] in modules and of[2] not in apart]
    check(not wrong, f"texts in models and integrators: {wrong}")


def pages() -> None:
    """The page of a run of this process has its title, its case and its largest force."""
    run = case_of("sim_V_oscillating").run(end=0.02, ideal_twin=True)
    with tempfile.TemporaryDirectory() as folder:
        run.report(Path(folder) / "run.html")
        text = Path(folder, "run.html").read_text()
        run.save(folder, "saved")
        again = gudgeon.load(Path(folder) / "saved")
    check("<iframe" in again.report()._repr_html_() and again.twin is not None, "a run that was saved has its page, and its twin")
    check(str(run.case.case.title) in text and "&lubrication" in text.replace("&amp;", "&"), "the page of a run has its title and its case")
    largest = np.hypot(run["pin_force_x"], run["pin_force_y"]).max()
    found = re.search(r'"pin_force": ([-+0-9.e]+)', text)
    check(found is not None and abs(float(found[1]) / largest - 1) < 1e-12, f"the page of a run has its largest force: {found}, {largest}")


def tables() -> None:
    """The tables beside rows and events, of a run of this process and of its files."""
    run = case_of("film/sim_I_fed").run(end=0.6)
    check(list(run.tables) == ["film_history"], f"tables of a run with a film with memory: {list(run.tables)}")
    least = run.tables["film_history"]["min_film_thickness[m]"].min()
    check(abs(least / run.summary["film_history_min_film_thickness"] - 1) < 1e-8, f"its thinnest film is that of the summary: {least}")
    run = case_of("wear/worn_bore").run(end=0.02)
    with tempfile.TemporaryDirectory() as folder:
        again = gudgeon.load(run.save(folder))
        check(list(again.tables) == ["wear"] and again.tables["wear"].equals(run.tables["wear"]), "tables of a run and of its files")
    check(case_of("sim_I").run(end=0.01).tables == {}, "a run without tables has none")


def memory() -> None:
    """Resident memory does not grow over many instances."""

    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    case = case_of("sim_I")
    sizes = []
    for _ in range(3):
        for _ in range(150):
            stepper = case.begin(end=0.002)
            stepper.advance(0.001)
            saved = stepper.snapshot()
            stepper.advance(0.002)
            stepper.restore(saved)
            stepper.finish()
        sizes.append(resident())
    check(sizes[2] - sizes[1] < 1e6, f"memory grows: {sizes}")


def fits() -> None:
    """Known keys are found again, with the standard errors and directions of closed forms; what the data do not fix is said."""
    random = np.random.default_rng(3)
    matrix, at = random.standard_normal((40, 3)), np.array([0.4, 0.7, 0.2])
    data = matrix @ at + 0.01 * random.standard_normal(40)
    place, residuals, jacobian = _fit.search(lambda points: points @ matrix.T, data, np.ones(40), np.ones(3), np.full(3, 0.5), 4, 1e-3, 1)
    best = np.linalg.lstsq(matrix, data, rcond=None)[0]
    check(abs(place - best).max() < 1e-9 and abs(jacobian - matrix).max() < 1e-9 and np.allclose(residuals, matrix @ best - data), "a linear model is solved")

    def with_failures(points: np.ndarray) -> np.ndarray:
        return np.where(points[:, :1] > 0.9, np.nan, points @ matrix.T)

    found = _fit.search_on_designs(with_failures, data, np.ones(40), np.ones(3), [64, 32], 1)
    check(abs(found[0] - best).max() < 1e-6 and abs(found[2] - matrix).max() < 1e-5, "also on designs, whose surfaces of a linear model are planes")
    refuses(RuntimeError, "runs of a design have failed", lambda: _fit.search_on_designs(lambda p: p @ matrix.T + np.nan, data, np.ones(40), np.ones(3), [8], 1))
    keys = [_fit.Key(name, 0.0, 1.0) for name in "abc"]
    observed = _fit.Answers(dict.fromkeys(map(str, range(40)), 0.0), None)
    linear = _fit.Fit(gudgeon.template("dry"), keys, place, observed, data, residuals, jacobian, False, 0, None)
    want = np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)) * (residuals @ residuals) / 37)
    check(np.allclose(list(linear.standard_errors.values()), want, rtol=1e-6), "its standard errors are those of the normal equations")
    check(abs(linear.condition / np.linalg.cond(matrix) - 1) < 1e-6 and linear.free == [], "its condition number")

    crank = gudgeon.template("dry").set({"mechanism.gravity": 0, "joint.kind": "ideal"})
    for group in ("contact", "friction"):
        crank.remove(group)
    for key in ("clearance", "bearing_radius", "bearing_length"):
        crank[f"joint.{key}"] = None
    run = crank.run()
    acceleration = run["piston_acceleration"]
    table = pd.DataFrame({"crank_angle": run["crank_angle"], "pin_force_x": run["pin_force_x"] + 2 * random.standard_normal(len(run))})
    found = gudgeon.fit(crank.set({"mechanism.piston_mass": 0.1}), table, {"mechanism.piston_mass": ("50 g", "500 g")}, starts=2)
    mass = -(table.pin_force_x @ acceleration) / (acceleration @ acceleration)  # the force of the pin is mass times acceleration
    apart = table.pin_force_x + mass * acceleration
    error = math.sqrt(apart @ apart / (len(apart) - 1) / (acceleration @ acceleration))
    check(abs(found.values["mechanism.piston_mass"] / mass - 1) < 1e-6, f"the mass in closed form: {found.values}, {mass}")
    check(abs(found.standard_errors["mechanism.piston_mass"] / error - 1) < 1e-4 and found.case.mechanism.piston_mass == found.values["mechanism.piston_mass"], "its error")
    check("0.14" in repr(found) and "kg" in repr(found) and f"until {run['crank_angle'][-1]:.4g} rad" in repr(found) and "<img" in found.report().text and "http" not in found.report().text, "a page of the fit")

    loose = crank.set({"mechanism.rod_mass": 1e-9, "mechanism.rod_inertia": 1e-12}, drive={"kind": "free"})
    run = loose.run()
    table = pd.DataFrame({"time": run["time"], "crank_speed": run["crank_speed"]})
    found = gudgeon.fit(loose, table, {"mechanism.piston_mass": (0.05, 0.5), "mechanism.crank_inertia": (2e-5, 1e-3)}, starts=2)
    (direction,) = found.free  # without other forces only the ratio of the masses acts
    check(all(abs(part - 1) < 1e-3 for part in direction.values()) and len(direction) == 2, f"masses that only scale: {found.free}")
    check(all(math.isinf(error) for error in found.standard_errors.values()) and "not fixed" in repr(found), "which are not fixed")

    dry = gudgeon.template("dry").set({"integrator.revolutions": 0.25})
    run = dry.set({"joint.clearance": "21 um"}).run()
    table = pd.DataFrame({"time": run["time"], "piston_acceleration": run["piston_acceleration"]}).drop_duplicates("time")
    found = gudgeon.fit(dry, table, {"joint.clearance": ("15 um", "30 um")}, starts=1)
    ends = dry.certify().until
    check(ends < 0.5 * run["time"][-1] and found.until <= ends and len(found.residuals) < len(table) / 2, f"traces end where certificates end: {found.until}, {ends}")
    refuses(ValueError, "give bands or answers", lambda: gudgeon.fit(dry, table, {"joint.clearance": ("15 um", "30 um")}, until=1e-9))

    oiled = gudgeon.template("film").set({"lubrication.viscosity": 0.02, "lubrication.oil": None, "lubrication.temperature": None,
                                          "lubrication.law": "pinkus_sternlicht", "lubrication.variant": "half_film"})
    twin = oiled.set({"lubrication.viscosity": 0.027, "joint.clearance": oiled.joint.clearance * 1.2}).accuracy("reference").run()
    table = pd.DataFrame({"time": twin["time"], "eccentricity_x": twin["eccentricity_x"], "eccentricity_y": twin["eccentricity_y"]})
    keys = {"lubrication.viscosity": (0.01, 0.06), "joint.clearance": (0.7 * oiled.joint.clearance, 2 * oiled.joint.clearance)}
    found = gudgeon.fit(oiled, table, keys, until=0.5 * twin["time"][-1])
    want = {"lubrication.viscosity": 0.027, "joint.clearance": 1.2 * oiled.joint.clearance}
    check(all(abs(found.values[key] / want[key] - 1) < 1e-3 for key in keys) and found.free == [], f"a twin of a film: {found}")
    check(found.until <= 0.5 * twin["time"][-1] and len(found.residuals) < 2 * len(table), "traces are compared until the given time")

    engine = gudgeon.template("engine").set({"integrator.revolutions": 4, "joint.kind": "ideal", "joint.clearance": None})
    engine.remove("lubrication")
    for key in ("bearing_radius", "bearing_length"):
        engine[f"joint.{key}"] = None
    want = {"combustion.heat": 395.0, "combustion.compression_ratio": 9.1}
    names = ["cycle_imep", "cycle_max_cylinder_pressure", "cycle_max_drive_torque"]
    summary = engine.set(want).run().summary
    found = gudgeon.fit(engine, {name: summary[name] for name in names}, {"combustion.heat": (250, 600), "combustion.compression_ratio": (6, 14)})
    check(all(abs(found.values[key] / want[key] - 1) < 1e-4 for key in want) and found.at_limits == [], f"a twin of an engine: {found}")
    check("cycle_imep" in str(found.compared) and "MPa" in str(found.compared) and "<img" in found.report().text, "a page of a fit to answers")
    spread = {name: 0.01 * summary[name] for name in names}
    known = gudgeon.fit(engine, {name: summary[name] for name in names}, {"combustion.heat": (250, 380), "combustion.compression_ratio": (6, 14)}, errors=spread)
    check(known.at_limits == ["combustion.heat"] and "At a limit" in repr(known), f"a key at its limit: {known}")
    limits = {"mechanism.piston_mass": (-0.05, 0.5)}  # a negative mass is refused
    force = {"max_pin_force": crank.run(columns="none").summary["max_pin_force"]}
    shares = stats.qmc.Sobol(1, rng=1)
    for found, tried in (
        (gudgeon.fit(crank, force, limits, designs=[32, 16]), shares.random(32)), (gudgeon.fit(crank, force, limits), shares.reset().random(8)),
    ):  # fmt: skip
        lost = int((tried * 0.55 < 0.05).sum())
        check(lost > 0 and list(found.failures.values()) == [lost] and "piston_mass" in list(found.failures)[0], f"runs that failed: {found.failures}")
        check(abs(found.values["mechanism.piston_mass"] / 0.14 - 1) < 1e-4 and f"Runs left out: {lost}" in repr(found), f"they are left out: {found}")
    refuses(RuntimeError, "8 of 8 runs of a design have failed: combustion.", lambda: gudgeon.fit(engine, {"cycle_imep": 1e6}, {"combustion.compression_ratio": (0.5, 0.9)}, designs=[8]))
    refuses(ValueError, "smaller than the second", lambda: gudgeon.fit(engine, {"cycle_imep": 1e6}, {"combustion.heat": (300, 300)}))
    refuses(ValueError, "give bands", lambda: gudgeon.fit(oiled, table, keys, designs=[8]))
    refuses(RuntimeError, "no imep; did you mean cycle_imep?", lambda: gudgeon.fit(engine, {"imep": 1.0}, {"combustion.heat": (300, 400)}))
    refuses(ValueError, "the least and the largest value", lambda: gudgeon.fit(engine, {"cycle_imep": 1e6}, {"combustion.heat": 300}))  # type: ignore[arg-type]
    refuses(ValueError, "errors: none for cycle_imep", lambda: gudgeon.fit(engine, {"cycle_imep": 1e6}, {"combustion.heat": (300, 400)}, errors={"imep": 1}))
    refuses(ValueError, "not finite numbers", lambda: gudgeon.fit(engine, {"cycle_imep": math.nan}, {"combustion.heat": (300, 400)}))
    refuses(ValueError, "a column time [s] or crank_angle", lambda: gudgeon.fit(engine, pd.DataFrame({"t": [0.0]}), {"combustion.heat": (300, 400)}))
    refuses(RuntimeError, "compression_ratio", lambda: gudgeon.fit(engine, {"cycle_imep": 1e6}, {"combustion.compression_ratio": (0.5, 0.9)}))


def tolerances() -> None:
    """Percentiles and probabilities of a force that is proportional to a mass are those of the mass; runs that fail are counted."""
    crank = gudgeon.template("dry").set({"mechanism.gravity": 0, "joint.kind": "ideal", "integrator.revolutions": 1})
    for group in ("contact", "friction"):
        crank.remove(group)
    for key in ("clearance", "bearing_radius", "bearing_length"):
        crank[f"joint.{key}"] = None
    mass = stats.lognorm(0.1, scale=0.14)
    found = gudgeon.tolerances(crank, {"mechanism.piston_mass": mass}, ["max_pin_force"], runs=256, below={"max_pin_force": 4.0})
    unit = found.nominal["max_pin_force"] / 0.14
    for share in (10, 50, 90):
        value, low, high = found.percentile("max_pin_force", share)
        check(low < value < high and abs(value / (unit * mass.ppf(share / 100)) - 1) < 2e-3, f"the {share} % percentile of a product: {value}")
    chance = found.probability("max_pin_force", below=4.0)
    check(abs(chance.value - mass.cdf(4.0 / unit)) < 2 / 256 and chance.low < mass.cdf(4.0 / unit) < chance.high, f"a probability: {chance}")
    check(found.failures == {} and abs(found.rank_correlation.iloc[0, 0] - 1) < 1e-9, "what matters")
    page = found.report().text
    check("<img" in page and "max_pin_force &lt; 4.00 N" in page and "http" not in page, "a page of tolerances")
    samples = [0.1, 0.12, 0.13, -0.1]
    found = gudgeon.tolerances(crank, {"mechanism.piston_mass": samples, "mechanism.rod_mass": lambda share: 0.2 + 0.01 * share}, ["max_pin_force"], runs=64)
    drawn = found.table["mechanism.piston_mass"]
    check(drawn.between(-0.1, 0.13).all() and found.table["mechanism.rod_mass"].between(0.2, 0.21).all(), "measured samples, and a function of the share")
    lost = int((drawn <= 0).sum())
    check(0 < lost < 32 and list(found.failures.values()) == [lost] and len(found.done) == 64 - lost, f"runs that failed are counted: {found.failures}")
    chance = found.probability("max_pin_force", above=0.0)
    check(chance.value == 1 and chance.high == 1 and chance.low < 1 - lost / 64, f"they widen the interval: {chance}")
    check("Runs that failed" in repr(found) and "piston_mass" in repr(found), "and are said")
    refuses(ValueError, "power of 2", lambda: gudgeon.tolerances(crank, {"mechanism.piston_mass": mass}, ["max_pin_force"], runs=100))
    refuses(ValueError, "did you mean max_pin_force?", lambda: gudgeon.tolerances(crank, {"mechanism.piston_mass": mass}, ["max_pin_forse"], runs=2))
    refuses(ValueError, "give quantities", lambda: gudgeon.tolerances(crank, {"mechanism.piston_mass": mass}, runs=2))
    refuses(ValueError, "piston_mass: give a distribution", lambda: gudgeon.tolerances(crank, {"mechanism.piston_mass": ["140 g"]}, ["max_pin_force"], runs=2))
    refuses(ValueError, "no run has nothing", lambda: gudgeon.tolerances(crank, {"mechanism.piston_mass": mass}, ["nothing"], runs=2))
    refuses(TypeError, "below or above", lambda: found.probability("max_pin_force"))


def writes_nowhere(program: str) -> None:
    """A run in Python writes no file."""
    with tempfile.TemporaryDirectory() as folder:
        code = f"import gudgeon; gudgeon.read({str(TOP / 'cases' / 'sim_I.nml')!r}).run(end=0.001)"
        environment = {**os.environ, "HOME": folder, "XDG_CACHE_HOME": folder, "PYTHONDONTWRITEBYTECODE": "1"}
        environment["PYTHONPATH"] = str(TOP / "scripts" / "python" / "src")
        done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True)
        check(done.returncode == 0 and not done.stdout and not done.stderr, f"nothing is printed: {done.stdout}{done.stderr}")
        check(not list(Path(folder).iterdir()), f"nothing is written: {list(Path(folder).iterdir())}")


def texts_of_the_package() -> None:
    """The examples in docstrings hold, and the declarations for editors have every key."""
    for name in ("gudgeon", *(f"gudgeon.{part}" for part in ("case", "run", "stepper", "_sweep", "_table", "_fit", "_tolerances", "_orbit", "_fmu", "_keys", "_library"))):
        module = importlib.import_module(name)
        counts = doctest.testmod(module, extraglobs={"gudgeon": gudgeon, **vars(gudgeon)})
        check(counts.failed == 0, f"examples in {name}: {counts}")
    made = subprocess.run([sys.executable, str(TOP / "scripts/python/make_stubs.py")], check=True, capture_output=True, text=True)
    classes = {node.name: node for node in ast.parse(Path(made.stdout.strip()).read_text()).body if isinstance(node, ast.ClassDef)}
    for group in {key.group for key in gudgeon.keys.values()}:
        own, shared = (name.replace(".", "_").title().replace("_", "") + "Group" for name in (group, group.rpartition(".")[2]))
        declared = {node.target.id for node in classes.get(own, classes.get(shared)).body if isinstance(node, ast.AnnAssign)}
        names = {key.name for key in gudgeon.keys.values() if key.group == group and not keyword.iskeyword(key.name)}
        check(names == declared, f"&{group} is declared for editors")
    done = subprocess.run([Path(sys.executable).with_name("basedpyright"), "-p", TOP / "scripts/python"], capture_output=True, text=True)
    check(done.returncode == 0, f"types: {done.stdout[-2000:]}")
    check({node.target.id for node in classes["Groups"].body if isinstance(node, ast.AnnAssign)} <= set(dir(case_of("sim_I"))), "groups")


def main() -> int:
    program = os.path.abspath(sys.argv[1])
    names = CASES
    if "--all" in sys.argv:
        found = sorted((TOP / "cases").rglob("*.nml"))
        names = [str(p.relative_to(TOP / "cases").with_suffix("")) for p in found if "studies" not in p.parts]
    for part in (lambda: against_program(program, names), cases, round_trips, links, copies, lambda: starts(program), damaged, runs, steps, sweeps, threads, tables_beside, static_lengths, texts_of_the_package, pages, tables, fits, tolerances, memory, lambda: writes_nowhere(program)):
        try:
            part()
        except Exception:
            check(False, traceback.format_exc())
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
