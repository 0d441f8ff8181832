"""Answers of runs side by side in readable units, and the rows of a study: as Markdown, CSV and HTML."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ._library import meant
from .run import Run, Summary

if TYPE_CHECKING:
    import pandas as pd

    Row = tuple["Unit", list[Any], list[float | None], str]

#: Rows that are shown where none are chosen: of the last cycle, and of a run without a whole cycle. `*` stands for the places of bearings.
OF_CYCLE = (
    "status", "cycle_is_settled", "*cycle_min_film_thickness", "*cycle_min_film_thickness_angle", "*cycle_min_gap",
    "*cycle_max_film_pressure", "*cycle_max_force", "*cycle_contact_share", "*cycle_mean_film_power", "*cycle_mean_friction_power",
    "*cycle_mean_film_temperature", "*cycle_mean_film_side_flow", "*cycle_wear_depth_rate_*", "cycle_imep", "cycle_bmep", "cycle_fmep", "cycle_skirt_fmep", "cycle_ring_fmep",
    "cycle_min_skirt_film_thickness", "cycle_max_slap_speed", "cycle_slap_speed", "cycle_slap_energy", "cycle_min_ring_*_film_thickness",
    "cycle_indicated_power", "cycle_brake_power", "cycle_max_cylinder_pressure", "cycle_mean_crank_speed", "cycle_speed_fluctuation",
    "cycle_mass_flow", "recent_mass_flow", "cycle_volumetric_efficiency", "cycle_isentropic_efficiency", "cycle_discharge_temperature", "cycle_suction_loss",
    "cycle_discharge_loss", "cycle_leak_flow", "cycle_wall_heat_flow",
    "cycle_max_drive_torque", "cycle_min_drive_torque", "pin_swing", "pin_drift_per_revolution",
)  # fmt: skip
OF_RUN = (
    "status", "*min_film_thickness", "*min_gap", "*max_film_pressure", "*max_pin_force", "*max_force", "*contacts", "*contact_time_fraction",
    "*max_wear_depth_*", "mean_crank_speed", "max_drive_torque",
)  # fmt: skip
#: Columns of a study that are shown where none are chosen and its file asks for none by `statistics`.
OF_STUDY = ("*min_film_thickness", "*contact_time_fraction", "*max_pin_force", "mean_crank_speed")

#: Units that are shown in another one, and the factor to it.
SHOWN = {"rad": ("deg", 180 / math.pi), "kg/s": ("g/s", 1e3), "m3": ("mm3", 1e9), "m3/s": ("cm3/min", 6e7), "1": ("", 1.0), "-": ("", 1.0)}


class Unit(NamedTuple):
    """The unit in which a row is shown: (value + offset) * factor is in it."""

    name: str
    factor: float = 1.0
    offset: float = 0.0

    @classmethod
    def of(cls, row: str, unit: str, values: Any) -> Unit:
        """The readable unit of a row with these values in the unit of its file."""
        import numpy as np

        from .names import prefixed

        if is_place(row, unit) and unit == "K":
            return cls("degC", offset=-273.15)
        if unit == "rad/s" and "crank_speed" in row:
            return cls("rpm", 30 / math.pi)
        if unit == "m" and "film_thickness" in row:   # so that bearings can be compared
            return cls("um", 1e6)
        if unit in SHOWN:
            return cls(*SHOWN[unit])
        name, factor = prefixed(unit.replace(".", " "), np.array(values, dtype=float))
        return cls(name.replace("µ", "u"), factor)

    @property
    def printed(self) -> str:
        """Its name as pictures have it: µm, °C, cm³/min."""
        from .names import plain_unit

        return re.sub(r"^u(?=[A-Za-z])", "µ", plain_unit(self.name)).replace("degC", "°C")

    def label(self, quantity: str) -> str:
        """A quantity as an axis shows it, with its unit."""
        return f"{quantity} [{self.printed}]" if self.name else quantity

    def __call__(self, value: Any) -> Any:
        return value if self.factor == 1 and self.offset == 0 else (value + self.offset) * self.factor


class Table:
    """A table that can be printed, shown in a notebook and saved. `data` has its numbers in the units that are shown, `cells` its
    texts."""

    def __init__(self, data: pd.DataFrame, cells: pd.DataFrame) -> None:
        self.data, self.cells = data, cells

    def _right(self) -> list[bool]:
        """Whether each column stands on the right: those of numbers."""
        return [any(cell.lstrip("+-")[:1].isdigit() for cell in self.cells[name]) for name in self.cells]

    def markdown(self) -> str:
        rows = [[cell.replace("|", "\\|") for cell in row] for row in [list(self.cells.columns), *self.cells.values.tolist()]]
        right, widths = self._right(), [max(3, *map(len, column)) for column in zip(*rows)]
        rule = [(width - 1) * "-" + (":" if on_right else "-") for width, on_right in zip(widths, right)]
        padded = [[f"{cell:{'>' if on_right else '<'}{width}}" for cell, on_right, width in zip(row, right, widths)] for row in rows]
        return "\n".join("| " + " | ".join(row) + " |" for row in [padded[0], rule, *padded[1:]])

    def csv(self) -> str:
        return self.data.to_csv(index=False, float_format="%.10g", lineterminator="\n")

    def html(self) -> str:
        style = [' style="text-align: right"' if on_right else "" for on_right in self._right()]
        rows = [("th", list(self.cells.columns)), *(("td", row) for row in self.cells.values.tolist())]
        parts = ["".join(f"<{kind}{way}>{html.escape(cell)}</{kind}>" for cell, way in zip(row, style)) for kind, row in rows]
        return "<table>" + "".join(f"<tr>{part}</tr>" for part in parts) + "</table>"

    def save(self, path: str | Path) -> Path:
        """Write a file whose name ends in .md, .csv or .html."""
        path = Path(path)
        ways = {".md": lambda: self.markdown() + "\n", ".csv": self.csv, ".html": lambda: sheet(path.stem, self.html())}
        if path.suffix not in ways:
            raise ValueError(f"{path}: must end in {', '.join(ways)}")
        path.write_text(ways[path.suffix](), encoding="utf-8")
        return path

    def __repr__(self) -> str:
        return self.markdown()

    def _repr_html_(self) -> str:
        return self.html()


def table(runs: Any, rows: str | Iterable[str] | None = None, *, digits: int = 3) -> Table:
    """Answers of one run or of several side by side in readable units, with the differences from the first one.

    runs: runs, files of results, names of runs in results/, or a list of these; also the results of one study, NAME.runs.csv, which
    have a line for each run. rows: names of rows of the summary (columns of the study), or patterns such as "crank_pin_cycle_*";
    default: the answers of the last cycle, or of the whole run if it has none. Differences are in per cent; those of temperatures and
    of crank angles in K and in degrees. digits: of the texts. Raises KeyError for rows that no run has.

    >>> case = gudgeon.template("engine")
    >>> print(table([case.run(), case.set({"combustion.heat": 420}).run()], ["cycle_max_force", "cycle_max_cylinder_pressure"]))
    | row                         |   engine |           engine 2 |
    | --------------------------- | -------: | -----------------: |
    | cycle_max_force             |  14.7 kN |  17.0 kN (+15.3 %) |
    | cycle_max_cylinder_pressure | 4.34 MPa | 4.96 MPa (+14.2 %) |
    """
    given = [runs] if isinstance(runs, (str, Path, Run, Summary)) else list(runs)
    wanted = [rows] if isinstance(rows, str) else None if rows is None else list(rows)
    if len(given) == 1 and str(given[0]).endswith(".runs.csv"):
        return _of_study(Path(str(given[0])), wanted, digits)
    places, summaries = zip(*map(_place_and_summary, given))
    return _side_by_side(_labels(places), summaries, wanted, digits)


def _place_and_summary(run: Any) -> tuple[tuple[str, ...], Summary]:
    """The parts of the name of a run, the last of which may distinguish it from others, and its summary."""
    from .results import file_of, read_summary

    if isinstance(run, Run):
        return (run.name,), run.summary
    if isinstance(run, Summary):
        return ("run",), run
    path = file_of(run, "summary", run_missing=False)
    found = read_summary(path)
    parts = (*path.resolve().parent.parts, path.name.removesuffix(".summary.csv"))
    return parts, Summary([(name, value, unit) for name, (value, unit) in found.items()])


def _labels(places: Sequence[tuple[str, ...]]) -> list[str]:
    """Names of runs with as many folders as distinguish them; equal ones are numbered."""
    count = 1
    while len({place[-count:] for place in places}) < len(set(places)):
        count += 1
    found: list[str] = []
    for label in ("/".join(place[-count:]) for place in places):
        number = sum(other == label or other.startswith(f"{label} ") for other in found) + 1
        found.append(label if number == 1 else f"{label} {number}")
    return found


def _chosen(names: Sequence[str], wanted: Sequence[str]) -> list[str]:
    """The names that these names and patterns mean, in the order in which they are asked for. Raises KeyError for one that means none."""
    found: list[str] = []
    for pattern in wanted:
        these = [name for name in names if fnmatchcase(name, pattern)]
        if not these:
            raise KeyError(f"no row {pattern}{meant(pattern, list(names))}")
        found += [name for name in these if name not in found]
    return found


def _answers(names: Sequence[str], patterns: Sequence[str]) -> list[str]:
    """Those of the names that these patterns mean, in their own order."""
    return [name for name in names if any(fnmatchcase(name, pattern) for pattern in patterns)]


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_place(row: str, unit: str) -> bool:
    """Whether a row is a place on a scale, a temperature or a crank angle, of which no share can be said."""
    from .names import NO_PLACE

    return unit in ("K", "deg") and not row.endswith(NO_PLACE)


def _side_by_side(labels: list[str], summaries: Sequence[Summary], wanted: list[str] | None, digits: int) -> Table:
    import pandas as pd

    names = list(dict.fromkeys(name for summary in summaries for name in summary))
    if wanted is None:
        chosen = _answers(names, OF_CYCLE if any("cycle_start" in summary for summary in summaries) else OF_RUN)
        # what is as it should be, or nowhere, is no answer
        chosen = [name for name in chosen if any(summary.get(name, 0) not in (0, "done", "yes") for summary in summaries)]
    else:
        chosen = _chosen(names, wanted)
    data, cells = [], []
    for name in chosen:
        unit, values, changes, of_changes = _row(name, summaries)
        texts = [text_of(value, digits, unit.name) for value in values]
        texts = [text if change is None else f"{text} ({_signed(change)} {of_changes})" for text, change in zip(texts, changes)]
        cells.append([name, *texts])
        data.append([name, unit.name, *values, *changes[1:], of_changes])
    heads = ["row", "unit", *labels, *(f"{label}: change" for label in labels[1:]), "unit of change"]
    found = pd.DataFrame(data, columns=heads)
    return Table(found if len(labels) > 1 else found.drop(columns="unit of change"), pd.DataFrame(cells, columns=["row", *labels]))


def _row(name: str, summaries: Sequence[Summary]) -> Row:
    """Unit, values, and changes from the first run with their unit, of one row."""
    values = [summary.get(name) for summary in summaries]
    if not all(value is None or is_number(value) for value in values):
        return Unit(""), values, [None] * len(values), ""
    own = next(summary.units[name] for summary in summaries if name in summary)
    unit = Unit.of(name, own, [value for value in values if value is not None])
    values = [None if value is None else unit(value) for value in values]
    first = values[0]
    changes: list[float | None] = [None] * len(values)
    if first is not None and is_place(name, own):
        turn = 360 * summaries[0].get("cycle_revolutions", 1) if name.endswith("_angle") else math.inf
        changes[1:] = [None if value is None else math.remainder(value - first, turn) for value in values[1:]]
        return unit, values, changes, own
    if first:
        changes[1:] = [None if value is None else 100 * (value - first) / abs(first) for value in values[1:]]
    return unit, values, changes, "%"


def _of_study(path: Path, wanted: list[str] | None, digits: int) -> Table:
    """A line for each run of a study: its parameters, and columns of its results; the status where runs have failed."""
    import pandas as pd

    from .names import of_parameter
    from .study import Runs, asked_columns

    runs = Runs.read(path)
    names = list(runs.table.columns)
    end = names.index("status")
    if wanted is None:
        asked = [name for name in asked_columns(path) if name in names[end:]]
        results = asked or [name for name in _answers(names[end + 1 :], OF_STUDY) if len(runs.table[name].dropna())]
    else:
        results = _chosen(names[end:], wanted)
    data, cells = {}, {}
    for name in [*names[:end], *(["status"] if not runs.done.all() and "status" not in results else []), *results]:
        values = runs.table[name]
        if not pd.api.types.is_numeric_dtype(values):
            data[name], cells[name] = values, values.astype(str)
            continue
        if 0 < names.index(name) < end:
            shown = of_parameter(name, values.to_numpy())
            unit = Unit("degC", offset=-273.15) if shown.unit == "°C" else Unit(shown.unit.replace("µ", "u").replace("²", "2").replace("³", "3"), shown.factor)
        else:
            unit = Unit.of(name, runs.units[name], values.to_numpy())
        head = f"{name} [{unit.name}]" if unit.name else name
        whole = pd.api.types.is_integer_dtype(values) and unit.factor == 1
        data[head] = values if whole else unit(values)
        cells[head] = [text_of(int(value) if whole else value, digits) for value in data[head]]
    return Table(pd.DataFrame(data), pd.DataFrame(cells))


def text_of(value: Any, digits: int = 3, unit: str = "") -> str:
    """A value as a text of so many digits, with its unit; "-" where there is none."""
    if value is None or value != value:
        return "-"
    if not is_number(value):
        return str(value)
    size = abs(value)
    if isinstance(value, int):
        text = str(value)
    elif 10 ** (digits - 1) <= size < 1e7:
        text = f"{value:.0f}"
    elif 1e-4 <= size < 1e7:
        text = f"{float(f'{value:.{digits}g}'):.{max(0, digits - 1 - math.floor(math.log10(size)))}f}"
    else:
        text = f"{value:.{digits}g}".replace("e-0", "e-").replace("e+0", "e")
    return f"{text} {unit}".strip()


def _signed(change: float) -> str:
    text = f"{change:+.1f}" if abs(change) < 99.95 else f"{change:+.0f}"
    return "0.0" if text in ("+0.0", "-0.0") else text


def sheet(title: str, *parts: str) -> str:
    """A page of HTML that needs no other file, of these parts."""
    css = (Path(__file__).parent / "report/assets/page.css").read_text(encoding="utf-8")
    said = html.escape(title)
    head = f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{said}</title><style>{css}</style></head>'
    return f"{head}\n<body><h1>{said}</h1>\n" + "\n".join(parts) + "\n</body></html>\n"
