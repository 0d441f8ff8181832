#!/usr/bin/env python3
"""Functional mock-up units against runs: FMPy has no complaint, outputs have the bits of the rows, and a master may stop, go back and
change what its inputs are.

    tests/test_fmu.py [--all]

Needs NumPy, pandas and FMPy, and the shared library: that of the environment variable GUDGEON_LIBRARY, or else build/library. Ends
with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import math
import os
import subprocess
import sys
import tempfile
import traceback
import zipfile
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts" / "python" / "src"))
os.environ.setdefault("GUDGEON_LIBRARY", str(TOP / "build" / "library" / "libgudgeon.so"))
import fmpy
import gudgeon
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

CASES = ["sim_I", "friction/coulomb_static", "gas/compressor"]
ALL_CASES = [
    "sim_I", "flores/friction_100", "sim_II_oscillating", "gas/compressor", "gas/measured", "joints/both_pins", "joints/guide_friction",
    "elastic/engine_rod", "wear/worn_bore", "joints/piston_slap",
]  # fmt: skip
passed = failed = 0


def check(holds: bool, what: str) -> None:
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    if not holds:
        print(f"FAILED: {what}")


class Unit:
    """A unit in a master."""

    def __init__(self, path: Path, fmi: int, folder: str, stop: float | None = None, sets=(), tolerance: float | None = None,
                 early: bool = False) -> None:  # fmt: skip
        self.description = fmpy.read_model_description(str(path))
        self.reference = {v.name: v.valueReference for v in self.description.modelVariables}
        self.outputs = [v.name for v in self.description.modelVariables if v.causality == "output"]
        self.messages: list[str] = []
        self.place = fmpy.extract(str(path), tempfile.mkdtemp(dir=folder))  # a library that is loaded must not be replaced
        self.unit = fmpy.instantiate_fmu(self.place, self.description, "CoSimulation", logger=self.log, early_return_allowed=early)
        self.fmi = fmi
        if early:
            self.unit.setBoolean([self.reference["return_at_contacts"]], [True])
        self.begin(stop, sets, tolerance)

    def begin(self, stop: float | None = None, sets=(), tolerance: float | None = None) -> None:
        """The experiment, and the initialisation with these parameters."""
        if self.fmi == 2:
            self.unit.setupExperiment(startTime=0, stopTime=stop, tolerance=tolerance)
            self.unit.enterInitializationMode()
        else:
            self.unit.enterInitializationMode(startTime=0, stopTime=stop, tolerance=tolerance)
        for name, value in sets:
            self.set(name, value)
        self.unit.exitInitializationMode()

    def log(self, *arguments) -> None:
        self.messages.append(arguments[-1].decode())

    def set(self, name: str, value: float) -> None:
        (self.unit.setReal if self.fmi == 2 else self.unit.setFloat64)([self.reference[name]], [value])

    def get(self, *names: str) -> np.ndarray:
        wanted = [self.reference[name] for name in names or self.outputs]
        return np.array((self.unit.getReal if self.fmi == 2 else self.unit.getFloat64)(wanted))

    def free(self) -> None:
        self.unit.terminate()
        self.unit.freeInstance()


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.array_equal(a, b, equal_nan=True))


def bits(name: str, fmi: int, folder: str) -> None:
    """A unit is valid, and its outputs at the times of rows are the rows, bit for bit."""
    case = gudgeon.read(TOP / "cases" / f"{name}.nml")
    path = gudgeon.fmu(case, Path(folder) / "unit.fmu", fmi)
    check(validate_fmu(str(path)) == [], f"{name}, FMI {fmi}: {validate_fmu(str(path))}")
    end = case.begin().end if name not in ("joints/piston_slap", "wear/worn_bore") else 0.05
    run = case.run(end=end)
    unit = Unit(path, fmi, folder, end)
    t = run["time"]
    columns = [run.names.index(output) for output in unit.outputs]
    wrong = 0
    for i in range(len(t) - 1):
        if i:
            unit.unit.doStep(t[i - 1], t[i] - t[i - 1])
        wrong += not same(unit.get(), run._rows[i, columns])
    check(wrong == 0 and len(t) > 100, f"{name}, FMI {fmi}: {wrong} of {len(t)} rows differ")
    unit.free()
    step, spans = 1.37 * t[-1] / (len(t) - 1), np.ptp(run._rows, axis=0)[columns]
    unit = Unit(path, fmi, folder, end)
    stepper = case.begin(end=end)
    worst = 0.0
    for i in range(60):
        unit.unit.doStep(i * step, step)
        stepper.advance(i * step + step)
        values = stepper.values
        apart = np.abs(unit.get() - [values[name] for name in unit.outputs])
        worst = max(worst, float(np.nanmax(apart / np.where(spans > 0, spans, 1))))
    check(worst < 1e-9, f"{name}, FMI {fmi}: another step, {worst}")
    unit.free()


def parameters(fmi: int, folder: str) -> None:
    """Parameters, refusals, and the end of a run."""
    case = gudgeon.read(TOP / "cases" / "sim_I.nml")
    path = gudgeon.fmu(case, Path(folder) / "unit.fmu", fmi, ["time", "pin_force_x", "piston_position"])
    unit = Unit(path, fmi, folder, 0.02, [("joint.clearance", 3e-5), ("mechanism.rod_com[1]", 0.06)])
    check(unit.outputs == ["piston_position", "pin_force_x"], f"chosen outputs: {unit.outputs}")
    check(unit.get("joint.clearance")[0] == 3e-5, "a parameter is read back")
    changed = case.set({"joint.clearance": 3e-5, "mechanism.rod_com": (0.06, 0.0)}).begin(end=0.02)
    unit.unit.doStep(0, 0.01)
    changed.advance(0.01)
    check(same(unit.get(), np.array([changed.values[name] for name in unit.outputs])), f"FMI {fmi}: parameters are those of the case")
    try:
        unit.set("joint.clearance", 1e-5)
        check(False, "a parameter of a running unit is refused")
    except FMICallException:
        check(fmi == 3 or any("cannot be used here" in text for text in unit.messages), f"the master is told: {unit.messages}")
    try:
        unit.unit.doStep(0.005, 0.001)
        check(False, "a step from another time is refused")
    except FMICallException:
        check(fmi == 3 or any("must begin where" in text for text in unit.messages), f"the master is told: {unit.messages}")
    if fmi == 2:
        try:
            unit.unit.doStep(0.01, 0.02)
            check(False, "a step beyond the end is discarded")
        except FMICallException as error:
            check(error.status == 2, f"status of a step beyond the end: {error.status}")
        import ctypes

        value = ctypes.c_double()
        unit.unit.fmi2GetRealStatus(unit.unit.component, 2, ctypes.byref(value))
        check(abs(value.value - 0.02) < 1e-12, f"last successful time {value.value}")
    unit.free()
    inertias = [f"crankshaft.inertia[{n}]" for n in range(1, 7)]
    four = gudgeon.fmu(gudgeon.read(TOP / "cases" / "cylinders" / "four_dry.nml"), Path(folder) / "shaft.fmu", fmi, ["time", "crank_angle"])
    shaft = Unit(four, fmi, folder, 0.01, [(inertias[2], 3e-3)])
    check([shaft.get(name)[0] for name in inertias] == [0.004, 0.002, 0.003, 0.002, 0.002, 0.12], "a list of six numbers has six parameters")
    shaft.free()
    messages: list[str] = []
    wrong = [("joint.clearance", -1.0)]
    try:
        made = Unit.__new__(Unit)
        made.messages = messages
        made.__init__(path, fmi, folder, 0.02, wrong)  # type: ignore[misc]
        check(False, "a wrong parameter is refused")
    except FMICallException:
        check(fmi == 3 or any("must be > 0" in text for text in made.messages), f"the master is told what is wrong: {made.messages}")
    with zipfile.ZipFile(path) as file:
        check("documentation/index.html" in file.namelist() and "binaries" in " ".join(file.namelist()), "files")


def refusals(fmi: int, folder: str) -> None:
    """What a master must not do is an error, and never ends it: references and times beyond all bounds, wrong kinds, steps after the
    end."""
    path = gudgeon.fmu(gudgeon.read(TOP / "cases" / "sim_I.nml"), Path(folder) / "refusals.fmu", fmi)
    unit = Unit(path, fmi, folder, 0.02)
    one, own = unit.unit, unit.reference
    get, put = (one.getReal, one.setReal) if fmi == 2 else (one.getFloat64, one.setFloat64)
    get_whole, put_whole = (one.getInteger, one.setInteger) if fmi == 2 else (one.getInt32, one.setInt32)
    whole = next(v.valueReference for v in unit.description.modelVariables if v.type in ("Integer", "Int32"))

    def refused(what: str, action) -> None:
        try:
            action()
            check(False, f"FMI {fmi}: {what} is refused")
        except FMICallException as error:
            check(error.status == 3, f"FMI {fmi}: status of {what}: {error.status}")

    for reference in (2**31, 2**31 + 12345, 2**32 - 1, 2**31 - 1):
        refused(f"reference {reference}", lambda reference=reference: get([reference]))
        refused(f"setting reference {reference}", lambda reference=reference: put([reference], [1.0]))
    check(f"{2**31 + 12345} cannot" in " ".join(unit.messages), "the master is told the reference")
    refused("a real output as an integer", lambda: get_whole([own["piston_position"]]))
    refused("a real parameter as an integer", lambda: get_whole([own["joint.clearance"]]))
    refused("an integer as a real", lambda: get([whole]))
    refused("setting a real as an integer", lambda: put_whole([own["joint.clearance"]], [1]))
    if fmi == 3:
        refused("a real output as a boolean", lambda: one.getBoolean([own["piston_position"]]))
        import ctypes

        two = (ctypes.c_double * 2)()
        arguments = one.component, (ctypes.c_uint * 1)(own["piston_position"]), 1, two, 2
        refused("a wrong number of values", lambda: one.fmi3GetFloat64(*arguments))
    one.doStep(0, 0.005)
    for start, step in ((math.nan, 0.001), (0.005, math.nan), (0.005, math.inf), (math.inf, 0.001), (0.005, -0.001), (0.007, 0.001)):
        refused(f"a step from {start} by {step}", lambda start=start, step=step: one.doStep(start, step))
    one.doStep(0.005, 0.005)
    want = gudgeon.read(TOP / "cases" / "sim_I.nml").begin(end=0.02)
    want.advance(0.01)
    check(same(unit.get(), np.array([want.values[name] for name in unit.outputs])), f"FMI {fmi}: refused steps change nothing")
    one.terminate()
    refused("a step after the end", lambda: one.doStep(0.01, 0.001))
    one.reset()
    for wrong in ({"startTime": math.nan}, {"startTime": 1, "stopTime": 0.5}, {"startTime": 0, "stopTime": math.nan},
                  {"startTime": 0, "stopTime": 1, "tolerance": math.nan}):  # fmt: skip
        refused(f"a set-up with {wrong}", lambda wrong=wrong: (one.setupExperiment if fmi == 2 else one.enterInitializationMode)(**wrong))
    one.freeInstance()


def ends(folder: str) -> None:
    """A unit of a case that ends when its motion repeats goes on to the stop time of the master."""
    case = gudgeon.read(TOP / "cases" / "sim_I.nml").set(run={"until": "periodic", "periodic_tolerance": 0.1})
    alone = case.run().summary["simulated_time"]
    path = gudgeon.fmu(case, Path(folder) / "periodic.fmu", columns=["time", "piston_position"])
    unit = Unit(path, 2, folder, 2 * alone)
    unit.unit.doStep(0, 1.9 * alone)
    want = case.set({"run.until": "end"}).begin(end=2 * alone)
    want.advance(1.9 * alone)
    check(unit.get("piston_position")[0] == want.values["piston_position"], f"a unit goes on after {alone} s")
    unit.free()


def files(folder: str) -> None:
    """Files of one name, one file twice, and names with apostrophes or of the unit's own files go with a unit."""
    here = Path(folder) / "tables"
    (here / "other").mkdir(parents=True)
    own = (TOP / "cases/drive/motor.csv").read_text()
    (here / "it's a table.csv").write_text(own)
    (here / "identity").write_text(own)
    case = gudgeon.read(TOP / "cases" / "drive/motor.nml")
    for name in ("it's a table.csv", "identity"):
        one = gudgeon.Case.from_text(case.set({"drive.torque_table": name}).to_nml(), "named", here)
        unit = Unit(gudgeon.fmu(one, Path(folder) / "named.fmu"), 2, folder, 0.02)
        unit.unit.doStep(0, 0.01)
        want = case.begin(end=0.02)
        want.advance(0.01)
        check(unit.get("crank_speed")[0] == want.values["crank_speed"], f"a unit with the file {name}")
        unit.free()


def films(folder: str) -> None:
    """A unit with a table of each of two films names both, and has the bits of the case."""
    here = Path(folder) / "films"
    here.mkdir()
    values = {"law": "finite_bearing", "variant": "table", "film_points": 32, "table_points": 17, "viscosity": 0.02}
    case = gudgeon.read(TOP / "cases" / "joints/both_pins.nml").set({"integrator.revolutions": 0.02})
    case = case.set({"joint.bearing_length": 0.02, "crank_pin.joint.bearing_length": 0.03}, lubrication={**values, "table_file": "one.table"})
    case.add("crank_pin.lubrication", **values, table_file="two.table")
    case = gudgeon.Case.from_text(case.to_nml(), "films", here)
    path = gudgeon.fmu(case, Path(folder) / "films.fmu", columns=["time", "piston_position", "pin_force_x"])
    with zipfile.ZipFile(path) as file:
        text = file.read("resources/case.nml").decode()
        check("table_file = 'one.table'" in text and "table_file = 'two.table'" in text, f"a unit names both tables: {text}")
    unit = Unit(path, 2, folder, 0.0004)
    unit.unit.doStep(0, 0.0003)
    want = case.begin(end=0.0004)
    want.advance(0.0003)
    check(unit.get("pin_force_x")[0] == want.values["pin_force_x"], "a unit with two tables has the bits of its case")
    unit.free()


def states(fmi: int, folder: str) -> None:
    """A saved state goes on with the same bits; many instances take no memory."""
    case = gudgeon.read(TOP / "cases" / "friction/coulomb_static.nml")
    path = gudgeon.fmu(case, Path(folder) / "unit.fmu", fmi)
    unit = Unit(path, fmi, folder, 0.1)
    unit.unit.doStep(0, 0.02)
    get = unit.unit.getFMUState if hasattr(unit.unit, "getFMUState") else unit.unit.getFMUstate
    put = unit.unit.setFMUState if hasattr(unit.unit, "setFMUState") else unit.unit.setFMUstate
    state = get()
    unit.unit.doStep(0.02, 0.03)
    first = unit.get()
    put(state)
    unit.unit.doStep(0.02, 0.03)
    check(same(first, unit.get()), f"FMI {fmi}: a state that is put back goes on as before")
    (unit.unit.freeFMUState if hasattr(unit.unit, "freeFMUState") else unit.unit.freeFMUstate)(state)
    unit.unit.reset()
    unit.free()

    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    sizes = []
    place = fmpy.extract(str(path), tempfile.mkdtemp(dir=folder))
    for _ in range(3):
        for _ in range(40):
            one = fmpy.instantiate_fmu(place, unit.description, "CoSimulation")
            if fmi == 2:
                one.setupExperiment(startTime=0, stopTime=0.1)
                one.enterInitializationMode()
            else:
                one.enterInitializationMode(startTime=0, stopTime=0.1)
            one.exitInitializationMode()
            one.doStep(0, 0.001)
            one.terminate()
            one.fmi2FreeInstance(one.component) if fmi == 2 else one.fmi3FreeInstance(one.component)
        sizes.append(resident())
    check(sizes[2] - sizes[1] < 1e6, f"FMI {fmi}: memory grows: {sizes}")


def early_returns(folder: str) -> None:
    """With return_at_contacts a step of FMI 3.0 ends where a contact begins or ends; the motion does not depend on that."""
    case = gudgeon.read(TOP / "cases" / "flores/friction_100.nml")
    path = gudgeon.fmu(case, Path(folder) / "early.fmu", 3)
    unit = Unit(path, 3, folder, 0.01, early=True)
    times, t, returned = [], 0.0, True
    while t < 0.01 * (1 - 1e-9):
        _, _, returned, last = unit.unit.doStep(t, 0.01 - t)
        times += [last] if returned else []
        t = last
    run = case.run(end=0.01)
    check(len(times) > 10 and times == list(run.events["time"]), f"{len(times)} early returns, {len(run.events)} events")
    want = case.begin(end=0.01)
    want.advance(1)
    check(same(unit.get(), np.array([want.values[name] for name in unit.outputs])), "early returns change nothing")
    unit.free()


def resets(fmi: int, folder: str) -> None:
    """A unit begins anew, or says why it cannot."""
    path = gudgeon.fmu(gudgeon.read(TOP / "cases" / "sim_I.nml"), Path(folder) / "reset.fmu", fmi)
    unit = Unit(path, fmi, folder, 0.02)
    unit.unit.doStep(0, 0.01)
    first = unit.get()
    unit.unit.reset()
    unit.begin(0.02)
    unit.unit.doStep(0, 0.01)
    check(same(first, unit.get()), f"FMI {fmi}: a unit that is reset goes the same way")
    Path(unit.place, "resources", "case.nml").write_text("&nothing /")
    try:
        unit.unit.reset()
        check(False, "a unit whose case has changed is not reset")
    except FMICallException:
        check(any("nothing" in text for text in unit.messages), f"FMI {fmi}: the master is told why: {unit.messages}")
    unit.free()


def libraries(folder: str) -> None:
    """A unit has its own copies of what it needs, under names of its own, and looks for them beside itself."""
    path = gudgeon.fmu(gudgeon.template("film"), Path(folder) / "film.fmu")
    place = Path(fmpy.extract(str(path), tempfile.mkdtemp(dir=folder))) / "binaries/linux64"
    said = subprocess.run(["ldd", place / "gudgeon.so"], capture_output=True, text=True).stdout
    check(said.count(f"=> {place}/gudgeon-lib") == 2 and "not found" not in said, f"libraries of a unit: {said}")


def motor(folder: str) -> None:
    """The torque of drive/motor, given by a master that holds it between steps: the error halves with the step."""
    case = gudgeon.read(TOP / "cases" / "drive/motor.nml")
    table = np.loadtxt(TOP / "cases" / "drive/motor.csv", delimiter=",", skiprows=2)
    end = 0.05
    want = case.run(end=end)
    plain = case.set({"drive.torque_table": None})
    path = gudgeon.fmu(plain, Path(folder) / "motor.fmu")
    from_table = case.begin(end=end)
    errors = []
    for steps in (100, 200, 400):
        unit = Unit(path, 2, folder, end)
        for i in range(steps):
            # the torque of the table at the present speed, as the program interpolates it
            unit.set("drive.torque", _torque(table, unit.get("crank_speed")[0]))
            unit.unit.doStep(i * end / steps, end / steps)
        errors.append(abs(unit.get("crank_speed")[0] - want["crank_speed"][-1]) / np.ptp(want["crank_speed"]))
        unit.free()
    del from_table
    ratios = [errors[i] / errors[i + 1] for i in range(2)]
    check(all(1.6 < ratio < 2.5 for ratio in ratios), f"the error of a held torque halves with the step: {errors}")


def _torque(table: np.ndarray, speed: float) -> float:
    from scipy.interpolate import PchipInterpolator

    return float(PchipInterpolator(table[:, 0], table[:, 1])(speed))


def command(folder: str) -> None:
    """gudgeon-fmu as a command."""
    environment = {**os.environ, "PYTHONPATH": str(TOP / "scripts" / "python" / "src")}
    call = [sys.executable, "-m", "gudgeon._fmu", str(TOP / "cases" / "sim_I.nml"), "-o", folder, "--fmi", "3", "--columns", "pin_force_x"]
    done = subprocess.run(call, capture_output=True, text=True, env=environment)
    check(done.returncode == 0 and Path(folder, "sim_I.fmu").is_file(), f"gudgeon-fmu: {done.stderr}")
    done = subprocess.run([*call[:-1], "nothing"], capture_output=True, text=True, env=environment)
    check(done.returncode == 1 and "no such column" in done.stderr, f"a wrong column: {done.stderr}")
    case = gudgeon.read(TOP / "cases" / "sim_I.nml").set({"case.title": "<b> & 'x'"})
    path = gudgeon.fmu(case, Path(folder) / "title.fmu")
    check(fmpy.read_model_description(str(path)).description == "<b> & 'x'", "titles are escaped")
    for one, columns in ((case, ["crank_speed", "film_thickness", "piston_position"]), (case.set({"output.columns": "crank_speed, film_thickness, piston_position"}), None)):
        path = gudgeon.fmu(one, Path(folder) / "timed.fmu", fmi=3, columns=columns)   # FMPy refuses a unit of FMI 3 without a time
        found = {variable.name: variable for variable in fmpy.read_model_description(str(path)).modelVariables}
        check(found["time"].causality == "independent" and len(fmpy.simulate_fmu(str(path), stop_time=1e-3)) > 1, "a unit has its time where its columns do not name it")
        shown = {name: found[name].displayUnit for name in ("film_thickness", "piston_position", "mechanism.crank_length", "joint.clearance")}
        check(shown == {"film_thickness": "um", "piston_position": None, "mechanism.crank_length": None, "joint.clearance": "um"}, f"lengths of films in um, strokes in m: {shown}")


def main() -> int:
    names = ALL_CASES if "--all" in sys.argv else CASES
    with tempfile.TemporaryDirectory() as folder:
        for fmi in (2, 3):
            parts = [lambda name=name: bits(name, fmi, folder) for name in names]
            parts += [lambda: parameters(fmi, folder), lambda: states(fmi, folder), lambda: resets(fmi, folder), lambda: refusals(fmi, folder)]
            for part in parts:
                try:
                    part()
                except Exception:
                    check(False, traceback.format_exc())
        for part in (early_returns, libraries, motor, command, ends, files, films):
            try:
                part(folder)
            except Exception:
                check(False, traceback.format_exc())
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
