"""Parameter studies: their files, their runs, their results."""

import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import f90nml
import numpy as np
import pandas as pd

from gudgeon.results import MissingResult, read_table

#: A string or comment; or a bound of a range, which f90nml would end at the slash of a unit: key and value.
BOUND = re.compile(
    r"""('[^'\n]*'|"[^"\n]*"|![^\n]*)|(\b(?:from|to)\s*=\s*)([^\s'"][^'",!\n=]*?)(?=\s*(?:[,!\n]|/(?![a-z(])|\b\w+\s*=|\Z))""",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Parameter:
    """A key of the case that varies between two values in a unit (empty: that of the key), evenly in its logarithm if `log`."""

    key: str
    low: float
    high: float
    log: bool = False
    unit: str = ""

    @property
    def bounds(self) -> list[float]:
        """Bounds in the sampled space."""
        return [float(value) for value in np.log([self.low, self.high])] if self.log else [self.low, self.high]

    def value(self, sampled: np.ndarray) -> np.ndarray:
        """Value of the key for a value of the sampled space; rounding cannot bring it outside the range."""
        return np.clip(np.exp(sampled) if self.log else sampled, self.low, self.high)


@dataclass(frozen=True)
class Study:
    """A NAME.nml with &study and &parameter groups."""

    path: Path
    settings: dict[str, object]
    parameters: tuple[Parameter, ...]

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def case(self) -> Path:
        return (self.path.parent / str(self.settings["case"])).resolve()


def read_study(path: Path) -> Study:
    """Read the study in a file; its parameters must be given as ranges."""
    if not path.is_file():
        raise MissingResult(f"{path}: no such file")
    try:
        groups = f90nml.reads(BOUND.sub(lambda found: found[1] or f"{found[2]}'{found[3]}'", path.read_text(encoding="utf-8")))
    except (ValueError, AssertionError, StopIteration, UnicodeDecodeError) as problem:
        raise MissingResult(f"{path}: not a study file") from problem
    found = groups.get("parameter", [])
    parameters = []
    for group in found if isinstance(found, list) else [found]:
        if not {"key", "from", "to"} <= group.keys():
            raise MissingResult(f"{path}: &parameter key = {group.get('key')}: needs key, from and to here")
        (low, unit), (high, other) = (number_and_unit(path, group, end) for end in ("from", "to"))
        scale = group.get("scale", "linear")
        if unit != other:
            raise MissingResult(f"{path}: &parameter key = {group['key']}: needs from and to in one unit here")
        if scale not in ("linear", "log") or low >= high or (scale == "log" and low <= 0):
            raise MissingResult(f"{path}: &parameter key = {group['key']}: from {low} to {high}, {scale}: not a range")
        parameters.append(Parameter(group["key"], low, high, scale == "log", unit))
    if "case" not in groups.get("study", {}) or not parameters:
        raise MissingResult(f"{path}: needs &study case and at least one &parameter")
    return Study(path, dict(groups["study"]), tuple(parameters))


def number_and_unit(path: Path, group: f90nml.Namelist, key: str) -> tuple[float, str]:
    """Number and unit of a value such as `20 um`."""
    text = str(group[key])
    found = re.fullmatch(r"([-+]?[\d.]+(?:[ed][-+]?\d+)?)\s*(.*)", text.strip(), re.IGNORECASE)
    if found is None:
        raise MissingResult(f"{path}: &parameter key = {group['key']}, {key} = {text}: not a number")
    return float(found[1].lower().replace("d", "e")), found[2]


def write_table_study(study: Study, values: np.ndarray, directory: Path, name: str, title: str) -> Path:
    """Write a study with one run for each row of `values`, columns in the order of the parameters, to NAME.nml and its table
    NAME.csv. Returns the path of NAME.nml."""
    directory.mkdir(parents=True, exist_ok=True)
    table = pd.DataFrame(values, columns=[parameter.key for parameter in study.parameters])
    for parameter in study.parameters:
        if parameter.unit:
            table[parameter.key] = table[parameter.key].map(f"{{:.12e}} {parameter.unit}".format)
    table.to_csv(directory / f"{name}.csv", index=False, lineterminator="\n", float_format="%.12e")
    group = study.settings | {"title": title, "case": str(study.case), "table": f"{name}.csv"}
    f90nml.Namelist({"study": group}).write(directory / f"{name}.nml", force=True)
    return directory / f"{name}.nml"


def sweep(program: Path, study: Path, out: Path, options: Sequence[str] = ()) -> "Runs":
    """Run a study with gudgeon; failed runs state the reason in their rows."""
    outcome = subprocess.run([program, "sweep", "--quiet", "-o", out, *options, study], check=False)
    if outcome.returncode not in (0, 4):
        raise MissingResult(f"{study}: gudgeon sweep ended with status {outcome.returncode}")
    return Runs.read(out / f"{study.stem}.runs.csv")


def asked_columns(runs: Path) -> list[str]:
    """The columns that the study of a NAME.runs.csv asks for by `statistics`, as NAME.study.nml beside it has them: `max abs x` is x_max_abs."""
    study = runs.with_name(f"{runs.name.removesuffix('.runs.csv')}.study.nml")
    asked = str(f90nml.read(study)["study"].get("statistics", "")) if study.exists() else ""
    words = [part.split() for part in asked.split(",") if part.strip()]
    return ["_".join([part[-1], *part[:-1]]) for part in words]


@dataclass(frozen=True)
class Runs:
    """The results of a study, NAME.runs.csv: one row for each run, columns by name without unit."""

    table: pd.DataFrame
    units: dict[str, str]

    @classmethod
    def read(cls, path: Path) -> "Runs":
        if not path.exists():
            raise MissingResult(f"no result {path}")
        table, units = read_table(path, "run", "status")
        for name in table.select_dtypes(exclude="number").columns:
            table[name] = table[name].map(_as_written)
        if list(table["run"]) != list(range(1, len(table) + 1)):
            raise MissingResult(f"{path}: runs are missing; the same command of gudgeon sweep continues it")
        return cls(table, units)

    @property
    def done(self) -> np.ndarray:
        return (self.table["status"] == "done").to_numpy()

    def __getitem__(self, column: str) -> np.ndarray:
        return self.table[column].to_numpy()

    def failures(self) -> dict[str, int]:
        """The number of runs that failed for each reason."""
        return self.table.loc[~self.done, "status"].value_counts().to_dict()


def _as_written(cell: object) -> object:
    """A cell without the apostrophe that keeps spreadsheet programs from running a text as a formula."""
    return cell[1:] if isinstance(cell, str) and re.match(r"'+[=+\-@\t\r]", cell) else cell


def warn_of_failures(name: str, runs: Runs) -> None:
    """Print a line on standard error for each reason for which runs failed; if no run is done, raise an error with the reasons."""
    if not runs.done.any():
        reasons = "; ".join(f"{count}: {reason}" for reason, count in runs.failures().items())
        raise MissingResult(f"{name}: no results, all {len(runs.table)} runs failed ({reasons})")
    for reason, count in runs.failures().items():
        print(f"{name}: {count} of {len(runs.table)} runs failed: {reason}", file=sys.stderr)
