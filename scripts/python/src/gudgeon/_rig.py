"""Pressures as test rigs and indicating systems write them, made the table that the program reads."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

#: Units of pressures in Pa.
PRESSURES = {"pa": 1.0, "hpa": 1e2, "mbar": 1e2, "kpa": 1e3, "bar": 1e5, "mpa": 1e6, "atm": 101325.0,
             **dict.fromkeys(("psi", "lbf/in2", "lbf/in²", "lb/in2", "lb/in²"), 6894.757293168361), **dict.fromkeys(("kgf/cm2", "kgf/cm²"), 98066.5)}  # fmt: skip
#: A unit of pressures, what says that they are absolute, and what that they are gauge pressures: bar, bar(a), kPa abs, psia, psig, barü.
PRESSURE = re.compile(rf"({'|'.join(PRESSURES)})[ _,]*[\[(]? *((?:abs\.?|absolute?|a)|(gauge|gage|g|ü|ue|rel\.?|relativ))? *[\])]?", re.IGNORECASE)
#: From so many usual steps of the angle on, rows are missing.
GAP = 5.0
#: Words in the unit of a crank angle (° is read as deg); those that say from which dead centre it is counted; and what says that it is counted before it.
ANGLE_WORDS = {"deg", "degree", "degrees", "grad", "graus", "ca", "cad", "degca", "kw", "rad"}
OF_DEAD_CENTRE = {"crank", "after", "before", "tdc", "atdc", "btdc", "tdcf", "atdcf", "btdcf", "ot", "zot", "n", "nach", "v", "vor", "not", "vot", "pms", "apms", "dpms", "antes", "depois", "do"}
BEFORE = re.compile(r"btdc|before (?:tdc|top)|\bv(?:or|\.)? ?z?ot\b|\bapms\b|antes do pms", re.IGNORECASE)
#: What names of these columns have in them.
ANGLE_NAMES = re.compile(r"angle|winkel|[âa]ngulo|\bkw\b|\bca\b|\bcad\b|crank|kurbel|theta|phi", re.IGNORECASE)
PRESSURE_NAMES = re.compile(r"press|druck|\bp(_|\b|zyl|cyl|\d)", re.IGNORECASE)


class RigFileError(ValueError):
    """A file is not such a table; the message has its first rows as they were understood."""


def read_pressure(
    path: str | Path,
    *,
    angle: str | int | None = None,
    pressure: str | int | None = None,
    unit: str | None = None,
    decimal: str | None = None,
    shift_deg: float = 0.0,
    period_deg: float = 720.0,
    average: bool = True,
    save: str | Path | None = None,
) -> pd.DataFrame:
    """Read the pressure in a cylinder over the crank angle from a text file of a rig.

    Columns may be separated by semicolons, tabulators, commas or blanks and stand in quotes, decimals by a point or a comma (`decimal`
    says by which), thousands by the other one; before the rows there may be
    any lines, of which the last ones name the columns and their units. Angles before the dead centre (BTDC) change their sign. `angle` and `pressure` choose columns by their names, or a part
    of them, or by their numbers from 0 on; without them they are found by unit and name. `unit` is that of the pressure where the
    file has none, or a gauge pressure's as it stands. `shift_deg` is added to the angles, for files that count from another dead centre than the case.

    With `average` the cycles of `period_deg` degrees (720, or 360 of a two-stroke or compressor) become their mean, at the angles
    of the samples; without it the first whole cycle is taken. The result has the columns crank_angle[deg], from 0 to the period, and
    pressure[bar], absolute or gauge as in the file (a gauge pressure needs the `pressure_offset` of the case); `save` writes it as the table of `&cylinder_pressure`.

    Raises RigFileError for a file without rows of numbers, a column that is not there or not clear, a unit that is not known or says
    that a pressure is a gauge pressure, an angle that does not increase, an angle without a pressure, a gap, or less than one cycle.
    """
    text = _decoded(Path(path).read_bytes())
    names, units, values = _table(text, str(path), decimal)
    shown = _shown(names, units, values)
    first = _column(names, units, angle, lambda text: not np.isnan(_angle(text)), ANGLE_NAMES, "angle", str(path), shown)
    second = _column(names, units, pressure, lambda text: not np.isnan(_pressure(text)[0]), PRESSURE_NAMES, "pressure", str(path), shown, other=first)
    factor = _angle(units[first]) if units[first] else 1.0
    written = unit if unit is not None else units[second]
    in_pa, is_gauge = _pressure(written)
    if np.isnan(factor):
        raise RigFileError(f"{path}: the angle's unit '{units[first]}' is not known, but deg, rad, deg ATDC and deg BTDC are{shown}")
    if np.isnan(in_pa):
        raise RigFileError(f"{path}: the pressure's unit '{unit or units[second]}' is not known: give unit=, one of bar, mbar, kPa, MPa, Pa, hPa, psi{shown}")
    if is_gauge:
        raise RigFileError(f"{path}: '{written}' is a gauge pressure: unit='{next(name for name, size in PRESSURES.items() if size == in_pa)}' reads it as it stands, and pressure_offset of &cylinder_pressure "
                           f"adds the ambient pressure{shown}")  # fmt: skip
    rows = values[:, [first, second]]
    known = np.isfinite(rows)
    inner = np.flatnonzero(known.all(axis=1))
    if len(inner) and (lost := inner[0] + np.flatnonzero(known[inner[0] : inner[-1], 0] & ~known[inner[0] : inner[-1], 1])).size:
        raise RigFileError(f"{path}: the pressure is missing or no number in {lost.size} of {len(rows)} rows, first at the angle {rows[lost[0], 0]:g}{shown}")
    rows = rows[inner]
    if BEFORE.search(names[first]) or BEFORE.search(units[first]):
        rows = (rows if rows[0, 0] > rows[-1, 0] else rows[::-1]) * (-1.0, 1.0)
    degrees, bar = _unrolled(rows[:, 0] * factor, period_deg), rows[:, 1] * in_pa / 1e5
    if len(degrees) < 3 or not np.all(np.diff(degrees) > 0):
        at = 0 if len(degrees) < 3 else int(np.argmin(np.diff(degrees)))
        raise RigFileError(f"{path}: the angle does not increase at row {at + 1} of the numbers{shown}")
    step = float(np.median(np.diff(degrees)))
    if degrees[-1] - degrees[0] < period_deg - 1.5 * step:
        raise RigFileError(f"{path}: the angles span {degrees[-1] - degrees[0]:.4g} degrees, less than a cycle of {period_deg:g}: see period_deg{shown}")
    steps = np.diff(degrees)
    if steps.max() > GAP * np.quantile(steps, 0.95):
        at = int(np.argmax(steps))
        raise RigFileError(f"{path}: no rows between {degrees[at]:g} and {degrees[at + 1]:g} degrees{shown}")
    table = _one_cycle(degrees + shift_deg, bar, period_deg, step, average)
    if save is not None:
        table.to_csv(save, index=False, float_format="%.10g")
    return table


def _decoded(raw: bytes) -> str:
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = raw.decode("utf-16", "replace")
    else:
        try:
            text = raw.decode("utf-8-sig")
        except UnicodeError:
            text = raw.decode("cp1252", "replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


#: A table read one way: how many numbers it has, its first row of numbers alone, the decimal mark, fields of all rows, those of rows of the usual
#: width, their numbers.
_Reading = tuple[int, int, str, list[list[str]], pd.DataFrame, np.ndarray]


def _table(text: str, path: str, decimal: str | None = None) -> tuple[list[str], list[str], np.ndarray]:
    """Names, units and rows of the table of a text, with the separator and the decimal mark that give the most numbers."""
    lines = [line.strip() for line in text.split("\n") if line.strip()]
    found: list[_Reading] = []
    for separator in (";", "\t", ",", " "):
        rows = [re.split(r"\s+", line) for line in lines] if separator == " " else list(csv.reader((line.rstrip(separator) for line in lines), delimiter=separator, skipinitialspace=True))
        width = int(np.median([len(row) for row in rows]))
        if width < 2:
            continue
        cells = pd.DataFrame([[field.strip() for field in row] + [""] * (width - len(row)) if len(row) <= width else [""] * width for row in rows], dtype=str)
        for mark in (",", "."):
            if mark == decimal or decimal is None and (mark != separator or '"' in text):
                numbers = np.array([_numbers(cells.iloc[:, i], mark) for i in range(width)]).T
                several = np.isfinite(numbers).sum(axis=1) > 1
                if (whole := several & (np.isfinite(numbers) | (cells == "").to_numpy()).all(axis=1)).any():
                    found.append((int(several.sum()) * width, int(np.argmax(whole)), mark, rows, cells, numbers))
    best = max((one[0] for one in found), default=0)
    if not best:
        raise RigFileError(f"{path}: no rows of at least two numbers are found; its first lines are\n" + "\n".join("  " + line[:100] for line in lines[:5]))
    _, first, mark, rows, cells, numbers = _clear([one for one in found if one[0] == best], path)
    width = numbers.shape[1]
    heads = [[field.strip() for field in row] for row in rows[:first]]
    heads = [head[:width] for head in heads if len(head) >= width and not any(head[width:]) and np.isnan(_numbers(pd.Series(head[:1]), mark)[0])]
    names, units = [f"column {i}" for i in range(width)], [""] * width
    if heads and len(heads) > 1 and all(not field or PRESSURE.fullmatch(field.strip()) or not np.isnan(_angle(field)) or _is_unit(field) for field in heads[-1]):
        units = [field.strip() if PRESSURE.fullmatch(field.strip()) else _bare(field) for field in heads[-1]]
        names = heads[-2]
    elif heads:
        names = heads[-1]
    for i, name in enumerate(names):
        inside = re.search(r"[\[(](.*?)[\])]", name) or re.search(r"[,\s_]+([^,\s_]+)$", name)
        if inside and not units[i] and not PRESSURE.fullmatch(name) and (name[inside.start()] in "[(" or PRESSURE.fullmatch(inside[1]) or not np.isnan(_angle(inside[1]))):
            units[i], names[i] = inside[1].strip(), name[: inside.start()].strip()
    numbers = numbers[first:]
    return names, units, numbers[np.isfinite(numbers).any(axis=1)]


def _numbers(cells: pd.Series, decimal: str) -> np.ndarray:
    """Numbers of texts with this decimal mark, in which the other one, blanks or apostrophes may part thousands; NaN for other texts."""
    other = "," if decimal == "." else "."
    parts = f"[{other} '\u00a0\u202f]"
    good = cells.str.fullmatch(rf"[-+]?(?:\d+|[1-9]\d{{0,2}}(?:{parts}\d{{3}})+|(?=[.,]\d))(?:[{decimal}]\d*)?(?:[eE][-+]?\d+)?")
    plain = cells.where(good, "").str.replace(parts, "", regex=True).str.replace(decimal, ".", regex=False)
    return np.asarray(pd.to_numeric(plain, errors="coerce"), dtype=float)


def _clear(readings: list[_Reading], path: str) -> _Reading:
    """The right one of readings with equally many numbers, of which one takes a comma or a point for the decimal mark, the other for that of
    thousands: it is the decimal mark of a column in which all numbers have it. Raises RigFileError where only some have it, each before three digits."""
    first, second = (readings + readings[:1])[:2]
    if second is first or second[3] is not first[3]:
        return first
    for i in np.flatnonzero((~((first[5] == second[5]) | (np.isnan(first[5]) & np.isnan(second[5])))).any(axis=0)):
        cells = [str(cell) for cell, known in zip(first[4].iloc[:, i], np.isfinite(first[5][:, i]) & np.isfinite(second[5][:, i])) if known]
        mark = next(mark for mark in ",." if any(mark in cell for cell in cells))
        marked = [cell for cell in cells if mark in cell]
        if len(marked) < len(cells):
            text = marked[0]
            raise RigFileError(f"{path}: is {text} {text.replace(mark, '')} or {text.replace(mark, '.')}? decimal='.' or decimal=',' says it")
        return first if mark == first[2] else second
    return first


def _pressure(unit: str) -> tuple[float, bool]:
    """A unit of pressures in Pa, NaN where it is none, and whether it says that they are gauge pressures."""
    found = PRESSURE.fullmatch(unit.strip().strip("[]").strip())
    return (PRESSURES[found[1].lower()], bool(found[3])) if found else (np.nan, False)


def _angle(unit: str) -> float:
    """A unit of crank angles in degrees; NaN where it is none."""
    words = re.findall(r"[^\W\d_]+", _plain(unit).replace("°", " deg "))
    known = bool(words) and all(word in ANGLE_WORDS or word in OF_DEAD_CENTRE for word in words) and not set(words) <= {"crank", "n", "v", "do"}
    return (180 / np.pi if "rad" in words else 1.0) if known else np.nan


def _bare(unit: str) -> str:
    return unit.strip().strip("[]()").strip()


def _plain(unit: str) -> str:
    return " ".join(_bare(unit).lower().split())


def _is_unit(field: str) -> bool:
    return bool(re.fullmatch(r"[\[(].*[\])]|-|%|s|ms|°c|k|v|mv|a|n ?m|rpm|1/min|u/min|l|cm3|cm³|m3|m³|kw|j", field.strip().lower()))


def _column(
    names: list[str], units: list[str], wanted: str | int | None, known: Callable[[str], bool], pattern: re.Pattern[str], what: str, path: str, shown: str,
    other: int | None = None,
) -> int:  # fmt: skip
    if isinstance(wanted, int):
        if 0 <= wanted < len(names):
            return wanted
        raise RigFileError(f"{path}: {what}={wanted}: there are {len(names)} columns{shown}")
    if wanted is not None:
        found = [i for i, name in enumerate(names) if name == wanted] or [i for i, name in enumerate(names) if wanted.lower() in name.lower()]
    else:
        found = [i for i, unit in enumerate(units) if known(unit) and i != other]
        named = [i for i, name in enumerate(names) if pattern.search(name) and i != other and (i in found or not found)]
        in_cylinder = [i for i in named if re.search(r"zyl|cyl|cil", names[i], re.IGNORECASE)]
        found = in_cylinder or named or found
        if not found and len(names) == 2:
            found = [1 if other == 0 else 0]
    if len(found) == 1:
        return found[0]
    say = f"no column '{wanted}'" if wanted is not None and not found else f"which column is the {what} is not clear"
    raise RigFileError(f"{path}: {say}: give {what}=, one of {', '.join(repr(name) for name in names)}{shown}")


def _shown(names: list[str], units: list[str], values: np.ndarray) -> str:
    """The first rows as they were understood."""
    head = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)]
    return "\nunderstood as\n" + "\n".join("  " + " | ".join(row) for row in [head, *([f"{value:g}" for value in row] for row in values[:3])])


def _unrolled(degrees: np.ndarray, period: float) -> np.ndarray:
    """Angles that begin anew with each cycle, counted on."""
    falls = np.concatenate([[False], np.diff(degrees) < -0.5 * period])
    return degrees + period * np.cumsum(falls)


def _one_cycle(degrees: np.ndarray, bar: np.ndarray, period: float, step: float, average: bool) -> pd.DataFrame:
    """One cycle from 0 to the period: the mean over the cycles by straight lines between samples, or the first one."""
    cycles = max(1, int((degrees[-1] - degrees[0] + 1.5 * step) // period)) if average else 1
    points = round(period / step)
    grid = degrees[0] + step * np.arange(points) if abs(points * step - period) < 1e-6 * period else degrees[degrees < degrees[0] + period - 0.5 * step]
    several = np.mean([np.interp(grid + k * period, degrees, bar) for k in range(cycles)], axis=0)
    inside = np.mod(grid, period)
    inside[np.isclose(inside, period, atol=1e-6 * step)] = 0.0
    order = np.argsort(inside)
    table = pd.DataFrame({"crank_angle[deg]": np.round(inside[order], 9), "pressure[bar]": several[order]})
    if table.iloc[0, 0] > 0:  # the table spans the period, whose ends are the same point
        before, after = table.iloc[-1], table.iloc[0]
        share = (period - before.iloc[0]) / (after.iloc[0] + period - before.iloc[0])
        table = pd.concat([pd.DataFrame([[0.0, before.iloc[1] + share * (after.iloc[1] - before.iloc[1])]], columns=table.columns), table], ignore_index=True)
    end = pd.DataFrame([[period, table.iloc[0, 1]]], columns=table.columns)
    return pd.concat([table, end], ignore_index=True)
