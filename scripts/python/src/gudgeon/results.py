"""Results of runs: traces, events, summaries and cases as run, by the name of the case."""

import csv
import os
import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from gudgeon._library import meant
from gudgeon.program import CHECKOUT, MissingResult, release_program

COLUMN = re.compile(r"^(?P<name>\w+)\[(?P<unit>.*)\]$")


@dataclass(frozen=True)
class Run:
    """One run: its trace by column name without unit, and the other result files; events are those of the piston pin."""

    name: str
    trace: pd.DataFrame
    units: dict[str, str]
    events: pd.DataFrame
    summary: dict[str, tuple[str, str]] = field(default_factory=dict)
    case: dict[str, dict[str, object]] = field(default_factory=dict)
    case_units: dict[str, str] = field(default_factory=dict)  # of keys of the case, "group.key"

    def __getitem__(self, column: str) -> np.ndarray:
        if column not in self:
            raise self.lack(column)
        return self.trace[column].to_numpy()

    def lack(self, column: str) -> MissingResult:
        """The error for a column that the trace does not have: what may be meant, what there is, or how it may be asked for."""
        there = [*self.trace.columns, *(name[:-2] for name in self.trace.columns if name.endswith("_x"))]
        wanted = str(self.parameter("output", "columns", "standard"))
        otherwise = f"it has {', '.join(self.trace.columns)}" if "standard" in wanted else "a run with &output columns = 'standard' may have it"
        return MissingResult(f"{self.name}: the trace has no column {column}{meant(column, there) or f'; {otherwise}'}")

    def __contains__(self, column: str) -> bool:
        return column in self.trace.columns

    def parameter(self, group: str, key: str, default: object = None) -> object:
        """A value of the case as it was run, or the default if the case lacks this group."""
        return self.case.get(group, {}).get(key, default)

    @property
    def clearance(self) -> float:
        """Radial clearance [m]; 0 for an ideal joint."""
        return float(self.parameter("joint", "clearance", 0.0)) if "film_thickness" in self else 0.0

    @property
    def volume(self) -> str:
        """What the column cylinder_volume is: a measured pressure without a compression ratio has the swept volume alone."""
        measured = "cylinder_pressure" in self.case and not float(self.parameter("cylinder_pressure", "compression_ratio", 0.0))
        return "swept volume" if measured else "cylinder volume"

    @property
    def viscosity(self) -> float:
        """Dynamic viscosity of the piston pin's film [Pa s]: what the run computed for its oil, or the number in the case."""
        return float(self.summary["viscosity"][0] if "viscosity" in self.summary else self.parameter("lubrication", "viscosity", 0.0))

    @property
    def cycle(self) -> float:
        """Crank angle after which the loads repeat [rad]: two revolutions with the gas of four strokes, else one."""
        if "bearing_load" in self.case:
            return np.radians(float(self.parameter("bearing_load", "period_deg")))
        one_turn = self.parameter("combustion", "cycle") in ("two_stroke", "compressor") or self.parameter("cylinder_pressure", "period_deg") == 360
        has_gas = "gas_force" in self or bool({"combustion", "cylinder_pressure"} & self.case.keys())
        return (4 if has_gas and not one_turn else 2) * np.pi

    @property
    def certified_until(self) -> float | None:
        """Time up to which the run is certified [s] (`gudgeon --certify`); None if all of it is certified, or no certificate was
        requested."""
        text = self.summary.get("certified_until", ("", ""))[0]
        if not text:
            return None
        until = float(text)
        return until if until < self["time"][-1] * (1 - 1e-9) else None

    @cached_property
    def contacts(self) -> pd.DataFrame:
        """One row for each contact: begin [s], end [s], penetration [m], force [N]. A contact that lasts beyond the run ends with
        the run; its largest values are those of the trace."""
        ends = self.events[self.events["event"] == "contact_ends"]
        found = (
            pd.DataFrame(
                {
                    "begin": ends["time"] - ends["duration"],
                    "end": ends["time"],
                    "penetration": ends["max_penetration"],
                    "force": ends["max_normal_force"],
                }
            )
            .astype(float)
            .reset_index(drop=True)
        )
        begins = self.events.loc[self.events["event"] == "contact_begins", "time"]
        if len(begins) > len(found):
            rest = self.trace[self.trace["time"] >= begins.iloc[-1]]
            if not rest.empty:
                found.loc[len(found)] = [
                    begins.iloc[-1],
                    rest["time"].iloc[-1],
                    -rest["film_thickness"].min(),
                    rest["normal_force"].max(),
                ]
        return found


def read_table(path: Path, *needed: str) -> tuple[pd.DataFrame, dict[str, str]]:
    """A CSV file of the program: its columns named without units, and their units. Raises MissingResult for a file that is no table
    or lacks a column that is needed."""
    try:
        table = pd.read_csv(path)
    except (pd.errors.EmptyDataError, pd.errors.ParserError, UnicodeDecodeError) as problem:
        raise MissingResult(f"{path}: not a CSV file with columns ({str(problem).strip()})") from problem
    units, names = {}, []
    for heading in table.columns:
        match = COLUMN.match(heading)
        name = match["name"] if match else heading
        names.append(name)
        units[name] = match["unit"] if match else ""
    table.columns = names
    if lacking := [name for name in needed if name not in names]:
        raise MissingResult(f"{path}: has no column {' '.join(lacking)}; the columns are {' '.join(names)}")
    return table, units


def demand_numbers(path: Path, table: pd.DataFrame, columns: Iterable[str]) -> None:
    """Raises MissingResult if one of these columns has a cell that is no finite number."""
    for column in columns:
        if not (pd.api.types.is_numeric_dtype(table[column]) and np.isfinite(table[column]).all()):
            raise MissingResult(f"{path}: column {column}: not a number in each row")


def read_summary(path: Path) -> dict[str, tuple[str, str]]:
    """quantity -> (value, unit)."""
    with path.open(newline="", encoding="utf-8") as file:
        return {row["quantity"]: (row["value"], row["unit"]) for row in csv.DictReader(file)}


#: Groups that a case may have several times, by number.
REPEATED = ("cylinder", "damper", "ring", "valve")


def numbered(case: dict[str, dict[str, object]], name: str) -> list[dict[str, object]]:
    """All groups of this name, in the order of their numbers."""
    return [case[key] for key in sorted((key for key in case if key.startswith(name + "_") and key[len(name) + 1:].isdigit()),
                                        key=lambda key: int(key[len(name) + 1:]))]


def read_case(path: Path) -> dict[str, dict[str, object]]:
    """Reads a NAME.resolved.nml: see `parse_case`."""
    return parse_case(path.read_text(encoding="utf-8"))


def parse_case(text: str, units: dict[str, str] | None = None) -> dict[str, dict[str, object]]:
    """Reads a resolved case as the program writes it: group -> key -> number, list of numbers, logical or text. `units` takes the units
    behind them, by "group.key".

    A group that belongs to one joint has a prefix, as in crank_pin.joint; the first key of the group names the joint. Groups that may
    be repeated have numbers, as in cylinder_3."""
    case: dict[str, dict[str, object]] = {}
    name = ""
    for line in text.splitlines():
        if line.startswith("&"):
            name = line[1:].strip()
            if name in REPEATED:
                name += f"_{sum(group.startswith(name + '_') for group in case) + 1}"
            case.setdefault(name, {})
        elif match := re.match(r"\s*(\w+)\s*=\s*(.*)$", line):
            key, value = match[1], _value(match[2])
            if key == "place":
                if not case[name]:
                    del case[name]
                name = f"{value}.{name}"
                case.setdefault(name, {})
            else:
                case[name][key] = value
                if units is not None and (unit := re.search(r"  ! ([^']+)$", line)):
                    units[f"{name}.{key}"] = unit[1]
    return case


def events_of(joint: str, events: pd.DataFrame) -> pd.DataFrame:
    """The events of one joint, piston_pin or crank_pin; a table without the column `joint` has those of the piston pin only."""
    if "joint" not in events:
        return events if joint == "piston_pin" else events.iloc[:0]
    return events[events["joint"] == joint].reset_index(drop=True)


def _value(text: str) -> object:
    if quoted := re.match(r"'((?:[^']|'')*)'", text):
        return quoted[1].replace("''", "'")
    text = text.split("!")[0].strip()
    if text in (".true.", ".false."):
        return text == ".true."
    numbers = [float(part) for part in text.replace(",", " ").split()]
    return numbers[0] if len(numbers) == 1 else numbers


def load_run(path: Path) -> Run:
    """The run whose trace is `path`; events, summary and case are read from the same folder, if they exist."""
    name = path.name.removesuffix(".csv")
    base = path.with_name(name.removesuffix(".ideal"))
    trace, units = read_table(path, "time")
    if trace.empty:
        raise MissingResult(f"{path}: contains no rows")
    demand_numbers(path, trace, trace.columns)
    ideal = name.endswith(".ideal")

    def beside(suffix: str) -> Path:
        return base.with_name(base.name + suffix)

    events = pd.DataFrame(
        columns=["time", "crank_angle", "event", "normal_speed", "duration", "max_penetration", "max_normal_force", "joint"]
    )
    if beside(".events.csv").exists() and not ideal:
        events = events_of("piston_pin", read_table(beside(".events.csv"))[0])
    summary = read_summary(beside(".summary.csv")) if beside(".summary.csv").exists() and not ideal else {}
    of_keys: dict[str, str] = {}
    case = parse_case(beside(".resolved.nml").read_text(encoding="utf-8"), of_keys) if beside(".resolved.nml").exists() else {}
    return Run(name, trace, units, events, summary, case, of_keys)


def drawable(run: Any) -> Run:
    """A run of `gudgeon.Case.run` or `gudgeon.load`, as pictures and pages need it."""
    summary = {name: (str(value), run.summary.units[name]) for name, value in run.summary.items()}
    text = run._resolved or (run.case.to_nml(complete=True) if run.case is not None else "")
    of_keys: dict[str, str] = {}
    case = parse_case(text, of_keys)
    return Run(run.name, run.to_pandas(), run.units, events_of("piston_pin", run.events), summary, case, of_keys)


def case_files() -> dict[str, Path]:
    """The shipped case file of each name, if this package belongs to a checkout. In cases/studies/ only base/ has cases; the other
    files are studies."""
    if CHECKOUT is None:
        return {}
    return {path.stem: path for path in sorted((CHECKOUT / "cases").rglob("*.nml")) if path.parent.name != "studies"}


def shipped_case(name: str) -> Path:
    """The shipped case file of this name. Raises MissingResult without a checkout."""
    if name not in case_files():
        raise MissingResult(f"no shipped case {name}: the shipped cases are in a checkout")
    return case_files()[name]


def default_folder() -> Path:
    """The folder of the results of shipped cases: results/ of the checkout, or of the current folder."""
    return (CHECKOUT or Path()) / "results"


def resolved(path: Path, settings: Iterable[str] = ()) -> str:
    """A case file as it is now, changed by the settings, with all defaults: the text of a NAME.resolved.nml."""
    words = [word for setting in settings for word in ("--set", setting)]
    outcome = subprocess.run([release_program(), "--resolved", *words, path], capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(outcome.stderr.strip())
    return outcome.stdout


class Results:
    """The runs in a folder; missing runs are made with the release build."""

    def __init__(
        self, directory: Path, run_missing: bool = True, rerun: bool = False, files: dict[str, Path] | None = None
    ) -> None:
        """`files` are the case files by their names; by default the shipped ones."""
        self.directory = directory
        self.files = case_files() if files is None else files
        self.run_missing = run_missing
        self.rerun = rerun
        self._runs: dict[str, Run] = {}

    def path(self, name: str) -> Path:
        return self.directory / f"{name}.csv"

    def has(self, name: str) -> bool:
        """Whether there is a result of this name."""
        return self.path(name).exists()

    def settings(self, names: Iterable[str]) -> list[str]:
        """Additional settings for the runs of these cases: none."""
        return []

    def difference(self, name: str) -> str:
        """In what the case of a result differs from its case file as it is now; empty if it does not."""
        path = self.directory / f"{name}.resolved.nml"
        if not path.exists():
            return f"{path.name} is missing"
        now, then = parse_case(resolved(self.files[name], self.settings([name]))), read_case(path)
        for group in {**now, **then}:
            if group not in now or group not in then:
                return f"&{group} is there in one of them"
            ours, theirs = now[group], then[group]
            for key in {**ours, **theirs}:
                if ours.get(key) != theirs.get(key) and f"{key}_digest" not in ours:   # of a table: what it contains
                    return f"{group}.{key} is {ours.get(key)}, was {theirs.get(key)}"
        return ""

    def make(self, names: Iterable[str]) -> None:
        """Run the cases among `names` that have no result. The name of an ideal joint's run stands for its case. Raises MissingResult
        for a result that is not that of its case as it is now."""
        names = set(names)
        wanted = {name.removesuffix(".ideal") for name in names if self.rerun or not self.path(name).exists()}
        for name in sorted({name.removesuffix(".ideal") for name in names} & self.files.keys() - wanted):
            if found := self.difference(name):
                case = os.path.relpath(self.files[name])
                raise MissingResult(
                    f"{self.path(name)} is not the result of {case} as it is now ({found}): run {case} again, or give the CSV file"
                )
        if not wanted:
            return
        if unknown := wanted - self.files.keys():
            raise MissingResult(f"neither a trace in {self.directory} nor a shipped case: {' '.join(sorted(unknown))}")
        paths = [os.path.relpath(self.files[name]) for name in sorted(wanted)]
        settings = [word for setting in self.settings(wanted) for word in ("--set", setting)]
        command = ["-o", str(self.directory), *settings, *paths]
        if not self.run_missing:
            raise MissingResult(f"no result in {self.directory}; run: gudgeon {' '.join(command)}")
        print(f"running {' '.join(sorted(wanted))}", file=sys.stderr, flush=True)
        outcome = subprocess.run([release_program(), *command], capture_output=True, text=True, check=False)
        if outcome.returncode != 0:
            print(outcome.stderr, file=sys.stderr, end="")

    def __getitem__(self, name: str) -> Run:
        if name not in self._runs:
            if not self.path(name).exists():
                raise MissingResult(f"no result {self.path(name)}")
            self._runs[name] = load_run(self.path(name))
        return self._runs[name]


class FineResults(Results):
    """The same runs as pictures need them, with the columns of the figures only, in a separate folder. Runs with contact are made again
    with ten times the samples of the case, which do not change the motion. Runs in which a film carries the pin throughout are made again
    with a smaller tolerance: at the 1e-6 of the cases the integration error of accelerations is visible in their difference from the ideal
    joint. Other runs are the cases' own."""

    SAMPLES = 7200
    #: Relative tolerance of films. In simulation V the noise of the piston's acceleration is 20 m/s2 at 1e-6.
    TOLERANCE = 1e-9
    COLUMNS = (
        "time,crank_angle,crank_speed,crank_acceleration,rod_acceleration,piston_velocity,piston_acceleration,pin_force_x,pin_force_y,"
        "eccentricity_x,eccentricity_y,film_thickness,phase,normal_force"
    )

    def __init__(self, own: Results) -> None:
        super().__init__(own.directory / "fine", own.run_missing, own.rerun)
        self.files = own.files
        self.own = own

    def settings(self, names: Iterable[str]) -> list[str]:
        """Of runs that all touch, or none."""
        touch = any(self.touches(name) for name in names)
        return [
            f"output.samples_per_revolution={self.SAMPLES}" if touch else f"integrator.relative_tolerance={self.TOLERANCE}",
            f"output.columns={self.COLUMNS}",
            "output.ideal_twin=false",
        ]

    def make(self, names: Iterable[str]) -> None:
        names = set(names)
        self.own.make(names)
        for touch in (True, False):
            super().make(name for name in names if self.is_made(name) and self.touches(name) == touch)

    def is_made(self, name: str) -> bool:
        """Whether a run is made again."""
        return self.own.has(name) and (self.touches(name) or self.is_film(name))

    def is_film(self, name: str) -> bool:
        """Whether the run is one of a film; its twin with ideal joints is not."""
        return not name.endswith(".ideal") and bool(self.own[name].parameter("lubrication", "law"))

    def touches(self, name: str) -> bool:
        """Whether the pin is in contact at any time of a run."""
        return not self.own[name].contacts.empty

    def __getitem__(self, name: str) -> Run:
        return super().__getitem__(name) if self.is_made(name) else self.own[name]


class ManyCycles(Results):
    """The same cases over hundreds of revolutions, with eight rows in each at equal crank angles."""

    REVOLUTIONS = 200
    SAMPLES = 8

    def __init__(self, own: Results) -> None:
        super().__init__(own.directory / f"revolutions_{self.REVOLUTIONS}", own.run_missing, own.rerun)
        self.files = own.files

    def settings(self, names: Iterable[str]) -> list[str]:
        return [
            f"integrator.revolutions={self.REVOLUTIONS}",
            "integrator.method=auto",
            "output.sampling=crank_angle",
            f"output.samples_per_revolution={self.SAMPLES}",
        ]


class WindowResults(Results):
    """The same cases over more revolutions, so that a later window can be shown: traces of that window only, in a separate folder
    below the results of the cases."""

    #: Rows in a revolution: a contact of a hundredth of a millisecond still has several rows.
    SAMPLES = 3600
    #: Relative tolerance. At the cases' own 1e-6 the last digits of the tolerance determine how far a run with friction 0.1 has
    #: settled by then: it repeats within 2e-5 to 4e-2 m/s. At 1e-7 and below it repeats within 6e-5 to 8e-5 m/s.
    TOLERANCE = 1e-8

    def __init__(self, own: Results, window: tuple[int, int]) -> None:
        super().__init__(own.directory / f"revolutions_{window[0]}-{window[1]}", own.run_missing, own.rerun)
        self.files = own.files
        self.own = own
        self.window = window

    def settings(self, names: Iterable[str]) -> list[str]:
        """Raises MissingResult if the speeds of the cases differ, because the window then has a different time in each."""
        self.own.make(names)
        speeds = {abs(float(self.own[name].parameter("initial", "crank_speed"))) for name in names}
        if len(speeds) != 1:
            raise MissingResult(f"{' '.join(sorted(names))}: cases of different speeds have no common window")
        begin = 2 * np.pi * self.window[0] / speeds.pop()
        return [
            f"integrator.revolutions={self.window[1]}",
            f"output.start_time={begin:.12g}",
            f"output.samples_per_revolution={self.SAMPLES}",
            f"integrator.relative_tolerance={self.TOLERANCE}",
        ]


def located(word: str | Path, folder: Path | None = None, run_missing: bool = True) -> tuple[Results, str]:
    """Where the results of a run are, and its name. A run is given by its case file, by one of its CSV files, or by its name in a
    folder, which is results/ unless given. Results of a case file are in that folder or beside the file; a case without results is
    run, if `run_missing`. Raises MissingResult for a case file that is not there or has changed since its run."""
    given = Path(word)
    if given.suffix == ".nml":
        if not given.is_file():
            raise MissingResult(f"{given}: no such case file")
        name = given.stem
        places = [Results(place, run_missing, files={name: given}) for place in ([folder] if folder else [Path("results"), given.parent])]
        there = [results for results in places if results.has(name)]
        results = (there or places)[0]
        if len(there) > 1:   # make() below tells what is wrong with the first
            results = next((one for one in there if not one.difference(name)), results)
        results.make([name])
        return results, name
    if given.suffix == ".csv":
        given = given.with_name(re.sub(r"(\.(events|summary|film|skirt|wear))?\.csv$", "", given.name))
        path = (folder or given.parent) / given.name
    else:
        path = (folder or Path("results")) / given
    results = Results(path.parent, run_missing, files={})
    if not results.has(path.name):
        raise MissingResult(f"no trace {results.path(path.name)}: give the trace of a run, its case file, or its name in results/")
    return results, path.name


def file_of(word: str | Path, kind: str, folder: Path | None = None, run_missing: bool = True) -> Path:
    """The file NAME.KIND.csv of a run that is given as in `located`, or as this file itself. Raises MissingResult if the run has not
    written it."""
    if Path(word).name.endswith(f".{kind}.csv"):
        return Path(word)
    results, name = located(word, folder, run_missing)
    path = results.directory / f"{name}.{kind}.csv"
    if not path.exists():
        raise MissingResult(f"{path} is missing: the run has not written it")
    return path


def cycles_turned(time: np.ndarray, angle: np.ndarray, length: float, end: float | None) -> np.ndarray:
    """Cycles of `length` [rad] that the crank has turned through until each row, raised by rounding. A whole number is reached at
    `end` [s], where the cycle ends whose answers are in the summary: rows before the first whole cycle have negative values. Without
    it cycles are counted from the first row."""
    travel = np.abs(angle - angle[0]) / length
    before = 0.0 if end is None else (np.interp(end, time, travel) + 1e-6) % 1 - 1e-6
    return travel - before + 1e-9
