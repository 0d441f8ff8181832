"""The results of a run: columns as NumPy arrays, events, summary; as tables of pandas and xarray; to and from files."""

from __future__ import annotations

import csv
import ctypes
import math
import re
import time
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from . import _library
from ._library import Column, columns_of_run, library, meant

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    import xarray as xr

    from .case import Case

SLICE = 0.03  # of a run, after which interruptions are looked for [s]
EVENT_COLUMNS = ["time", "crank_angle", "event", "normal_speed", "duration", "max_penetration", "max_normal_force", "joint"]


class RunError(RuntimeError):
    """The integration could not go on; `run` has the results so far."""

    def __init__(self, text: str, run: Run) -> None:
        super().__init__(text)
        self.run = run

    def __reduce__(self) -> tuple[Any, ...]:
        return RunError, (str(self), self.run)


class Summary(Mapping[str, Any]):
    """The quantities of a run: numbers, or words. `units` are their units."""

    def __init__(self, rows: Sequence[tuple[str, str, str]]) -> None:
        self._texts = {name: text for name, text, _ in rows}
        self.units = {name: unit for name, _, unit in rows}

    def __getitem__(self, name: str) -> Any:
        if name not in self._texts:
            raise KeyError(f"no quantity {name}{meant(name, list(self._texts))}")
        return _number(self._texts[name])

    def __contains__(self, name: object) -> bool:
        return name in self._texts

    def get(self, name: str, default: Any = None) -> Any:
        return self[name] if name in self._texts else default

    def __iter__(self) -> Iterator[str]:
        return iter(self._texts)

    def __len__(self) -> int:
        return len(self._texts)

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:{width}}  {value} {self.units[name] if self.units[name] != '1' else ''}" for name, value in self.items())

    def _repr_html_(self) -> str:
        return _table((name, value, self.units[name]) for name, value in self.items())


class Certificate(Summary):
    """How accurate a run is, by runs with a hundredth of its tolerance and with another method."""

    @property
    def digits(self) -> float:
        """Digits that agree until `until`; not a number if the run cannot be certified."""
        return self.get("certified_digits", math.nan)

    @property
    def until(self) -> float:
        """The time until which the trace is certified [s]."""
        return self.get("certified_until", math.nan)


class Run:
    """The results of a run. `run["pin_force_x"]` or `run.pin_force_x` is a column, a read-only array without a copy."""

    def __init__(
        self, case: Case | None, columns: Sequence[Column], rows: np.ndarray, events: Sequence[Sequence[Any]] | None,
        summary: Sequence[tuple[str, str, str]], name: str,
    ) -> None:  # fmt: skip
        self.case, self.name = case, name
        self._columns, self._rows, self._events = list(columns), rows, events
        self._index = {column.name: i for i, column in enumerate(columns)}
        self.summary = Summary(summary)
        self.twin: Run | None = None
        self.certificate: Certificate | None = None
        self._resolved: str | None = None  # the complete case, if it was read from a file
        self._files: Path | None = None  # that it was read from: their path without suffix

    def __getstate__(self) -> dict[str, Any]:
        """What a pickle and a deep copy have: everything but the memory of the library and the files."""
        whole = self.__dict__.get("_owner") or self._files
        tables = {"tables": self.tables, "state": self.state} if whole else {}
        return {**self.__dict__, **tables, "_rows": self._rows.copy(), "_files": None, "_owner": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._rows.flags.writeable = False

    # columns

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._index:
            raise KeyError(f"no column {name}{meant(name, self.names)}")
        return self._rows[:, self._index[name]]

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name not in self._index:
            raise AttributeError(f"no column {name}")
        return self[name]

    def __len__(self) -> int:
        return len(self._rows)

    def __dir__(self) -> list[str]:
        return [*object.__dir__(self), *self.names]

    @property
    def names(self) -> list[str]:
        """Names of the columns, in their order."""
        return [column.name for column in self._columns]

    @property
    def units(self) -> dict[str, str]:
        return {column.name: column.unit for column in self._columns}

    @property
    def meanings(self) -> dict[str, str]:
        return {column.name: column.meaning for column in self._columns}

    @property
    def status(self) -> str:
        """'done', or why the run ended early."""
        return str(self.summary["status"])

    @property
    def notes(self) -> list[str]:
        """What is implausible, or beyond a model."""
        return [str(value) for name, value in self.summary.items() if name.startswith("note_")]

    @property
    def events(self) -> pd.DataFrame:
        """Beginnings and ends of contacts."""
        import pandas as pd

        return pd.DataFrame(self._events or [], columns=EVENT_COLUMNS)

    def at(self, time: float | None = None, *, crank_angle_deg: float | None = None) -> dict[str, float]:
        """All columns at a time [s], or at the first passage of a crank angle [degrees], linear between rows."""
        import numpy as np

        if (time is None) == (crank_angle_deg is None):
            raise TypeError("give a time or a crank angle")
        along = self["time"] if time is not None else np.degrees(self["crank_angle"])
        where = time if time is not None else crank_angle_deg
        assert where is not None
        close = 1e-9 * np.ptp(along)  # a time that is the end but for rounding
        where = min(max(where, along.min()), along.max()) if along.min() - close <= where <= along.max() + close else where
        past = np.flatnonzero((along[:-1] - where) * (along[1:] - where) <= 0)
        if not len(past):
            raise ValueError(f"{where} is not within the run: {along.min()} to {along.max()}")
        i = past[0]
        share = (where - along[i]) / (along[i + 1] - along[i]) if along[i + 1] != along[i] else 0.0
        values = self._rows[i] * (1 - share) + self._rows[i + 1] * share
        return dict(zip(self.names, map(float, values)))

    def cycle(self, i: int = -1, revolutions: int | None = None) -> Run:
        """The rows of one whole cycle: of the last one, or by number from 0. A cycle has the revolutions that the gas takes to
        repeat, or those given; the last one ends where the cycle ends whose answers are in the summary (`cycle_...`)."""
        travel = self._cycles_turned(revolutions)
        whole = int(travel[-1])
        if not -whole <= i < whole:
            raise IndexError(f"the run has {whole} whole cycles")
        chosen = (travel >= i % whole) & (travel <= i % whole + 1 + 1e-9)
        return Run(self.case, self._columns, self._rows[chosen], None, [], f"{self.name}, cycle {i % whole}")

    def _cycles_turned(self, revolutions: int | None = None) -> np.ndarray:
        """Cycles that the crank has turned through until each row, see `cycles_turned`."""
        from .results import cycles_turned

        if revolutions is None:
            revolutions = int(self.summary.get("cycle_revolutions", 1))
        end = self.summary["cycle_start"] + self.summary["cycle_duration"] if "cycle_start" in self.summary else None
        return cycles_turned(self["time"], self["crank_angle"], 2 * math.pi * revolutions, end)

    @property
    def cycles(self) -> pd.DataFrame:
        """Least, mean and largest value of each column in the rows of each whole cycle. Between rows a value may go further: the true
        extremes of the last cycle, searched inside the steps, are in the summary (`cycle_max_...`, `cycle_min_...`).

        >>> cycles = gudgeon.template("engine").run().cycles
        >>> cycles["crank_angle"].columns.tolist(), len(cycles) > 1
        (['least', 'mean', 'largest'], True)
        """
        import numpy as np
        import pandas as pd

        parts = [self.cycle(i)._rows for i in range(int(self._cycles_turned()[-1]))]
        names = pd.MultiIndex.from_product([self.names, ["least", "mean", "largest"]])
        found = [np.stack([rows.min(axis=0), rows.mean(axis=0), rows.max(axis=0)], axis=1).ravel() for rows in parts]
        return pd.DataFrame(found, columns=names)

    # tables and files

    def to_pandas(self) -> pd.DataFrame:
        import pandas as pd

        return pd.DataFrame(self._rows, columns=self.names)

    def to_xarray(self) -> xr.Dataset:
        """A dataset over time, with units and meanings as attributes."""
        import xarray as xr

        data = {
            c.name: ("time", self[c.name], {"units": c.unit, "long_name": c.meaning}) for c in self._columns if c.name != "time"
        }
        words = {name: value for name, value in self.summary.items() if name in ("status", "version")}
        return xr.Dataset(data, {"time": ("time", self["time"], {"units": "s"})}, {"case": self.name, **words})

    def to_parquet(self, path: str | Path) -> None:
        self.to_pandas().to_parquet(path)

    @cached_property
    def tables(self) -> dict[str, pd.DataFrame]:
        """What the run has beside rows and events, by the names of the files that the command line writes: `film` (fields of
        pressure), `wear`, `film_history`."""
        import pandas as pd

        with TemporaryDirectory() as folder:
            base = self._files or self.save(folder)
            names = {path: path.name[len(base.name) + 1 : -4] for path in sorted(base.parent.glob(f"{base.name}.*.csv"))}
            others = ("events", "summary", "certificate", "ideal")
            return {name: pd.read_csv(path) for path, name in names.items() if name.split(".")[0] not in others}

    @cached_property
    def state(self) -> dict[str, float | tuple[float, ...]]:
        """The motion that a whole run has reached, as the group &initial of NAME.state.nml has it; empty if it is not known. Others may
        start from it, see `Case.start_from`."""
        if self.__dict__.get("_owner") is not None and self.case is not None:
            return self.case.start_from(self).start
        path = Path(f"{self._files}.state.nml")
        return _motion_of_file(path.read_text()) if self._files and path.is_file() else {}

    def save(self, folder: str | Path, name: str | None = None) -> Path:
        """Write the files of the command line: NAME.csv, NAME.events.csv, NAME.summary.csv, NAME.state.nml, NAME.resolved.nml, ..."""
        handle = self.__dict__.get("_owner")
        if handle is None or self.case is None:
            raise ValueError("only a whole run that this process has made can be saved")
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        base = folder / (name or self.name)
        if library().run_save(handle.number, str(base).encode()):
            raise OSError(_library.message(handle.number))
        self.case.to_nml(f"{base}.resolved.nml", complete=True)
        if self.twin is not None:
            self.twin.save(folder, f"{base.name}.ideal")
            Path(f"{base}.ideal.resolved.nml").unlink()
        return base

    # pictures

    def plot(self, *names: str, over: str = "time", cycle: int | None = None, ax: Any = None) -> Any:
        """Columns over another column or over the crank angle in degrees, which is counted within the cycle if one is shown. Returns
        the axes of matplotlib."""
        import matplotlib.pyplot as plt

        from .names import plain_unit, prefixed
        from .plots.columns import crank_angles
        from .plots.style import CrankAngles

        run = self if cycle is None else self.cycle(cycle)
        if over == "crank_angle":
            x, order = crank_angles(run["crank_angle"], None if cycle is None else 2 * math.pi * int(self.summary.get("cycle_revolutions", 1)))
            along = "crank angle [deg]"
        else:
            shown, factor = prefixed(self.units[over], run[over])
            x, order, along = factor * run[over], slice(None), _label(over, plain_unit(shown))
        ax = ax or plt.gca()
        if over == "crank_angle":
            ax.xaxis.set_major_locator(CrankAngles())
        for name in names:
            shown, factor = prefixed(self.units[name], run[name])
            ax.plot(x, factor * run[name][order], label=_label(name, plain_unit(shown)))
        ax.set_xlabel(along)
        if len(ax.lines) == 1:
            ax.set_ylabel(ax.lines[0].get_label())
        else:
            ax.set_ylabel("")
            ax.legend()
        return ax

    def animate(self, cycle: int | None = None, frames: int = 120) -> Any:
        """The mechanism in motion, and the orbit of the pin in its clearance, as an animation of matplotlib."""
        from .plots.animation import animated

        return animated(self if cycle is None else self.cycle(cycle), frames)

    def report(self, path: str | Path | None = None) -> Page:
        """The page of the run, as `gudgeon-plot report` writes it: animation, plots, case, summary, notes. A notebook shows it; with a
        path it is written."""
        from .report.page import page
        from .results import drawable

        made = Page(page(drawable(self), drawable(self.twin) if self.twin else None))
        if path is not None:
            made.save(path)
        return made

    def __repr__(self) -> str:
        return f"<Run {self.name}: {self.summary.get('status', '')}, {len(self)} rows, {len(self._columns)} columns>"

    def _repr_html_(self) -> str:
        from html import escape

        from ._table import table

        name = next((name for name in ("piston_acceleration", *self.names[1:]) if name in self._index), None)
        shown, said = (self.cycle(-1), ", last cycle") if "cycle_start" in self.summary and "crank_angle" in self._index else (self, "")
        picture = _polyline(shown["time"], shown[name]) if name and len(shown) > 1 else ""
        notes = "".join(f"<br>{escape(note)}" for note in self.notes)
        return f"<b>{escape(self.name)}</b>: {escape(str(self.summary.get('status', '')))}{picture}<br>{escape(name or '')}{said}{table(self)._repr_html_() if self.summary else ''}{notes}"


def _label(column: str, unit: str) -> str:
    """A column on an axis."""
    return column.replace("_", " ") + (f" [{unit}]" if unit else "")


class Page:
    """A page of HTML that needs no other file and no network; notebooks show it."""

    def __init__(self, text: str) -> None:
        self.text = text

    def save(self, path: str | Path) -> Path:
        path = Path(path)
        path.write_text(self.text, encoding="utf-8")
        return path

    def _repr_html_(self) -> str:
        from html import escape

        return f'<iframe width="100%" height="700" style="border:0" srcdoc="{escape(self.text)}"></iframe>'


class _Owner:
    """Keeps the memory of a run of the library while its rows are in use."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __del__(self, library: Callable[[], Any] = library) -> None:  # also while Python ends
        library().run_free(self.number)

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a run that goes on, and its saved states, can be neither pickled nor copied; its results can (Stepper.run)")


def from_handle(case: Case, owner: _Owner | int) -> Run:
    """The run of a handle, which is finished here. The run owns the handle from now on."""
    import numpy as np

    owner = _Owner(owner) if isinstance(owner, int) else owner
    number = owner.number
    library().run_finish(number)
    columns = columns_of_run(number)
    count = ctypes.c_int64()
    address = library().rows(number, count)
    if count.value * len(columns):
        buffer = (ctypes.c_double * (count.value * len(columns))).from_address(ctypes.addressof(address.contents))
        buffer._owner = owner  # type: ignore[attr-defined]
        rows = np.frombuffer(buffer).reshape(count.value, len(columns))  # pyright: ignore
        rows.flags.writeable = False
    else:
        rows = np.empty((0, len(columns)))
    run = Run(case, columns, rows, _events(number), _quantities(number), case.name)
    run.__dict__["_owner"] = owner
    return run


def _events(number: int) -> list[list[Any]] | None:
    count = library().events(number)
    if count < 0:
        return None
    values, ends, place = (ctypes.c_double * 6)(), ctypes.c_int(), ctypes.create_string_buffer(20)
    found = []
    for i in range(count):
        library().event(number, i, values, ends, place, 20)
        t, angle, speed, *rest = values
        kind = "contact_ends" if ends.value else "contact_begins"
        found.append([t, angle, kind, speed, *(rest if ends.value else [math.nan] * 3), place.value.decode()])
    return found


def summary_of(number: int, names: Container[str] | None = None) -> Summary:
    """The summary of a handle, whose run is finished here, or these of its rows."""
    library().run_finish(number)
    return Summary(_quantities(number, names))


def _quantities(number: int, names: Container[str] | None = None) -> list[tuple[str, str, str]]:
    """The rows of the summary of a handle: name, text, unit."""
    lines = _library.text_from(library().summary, number, guess=20000).splitlines()[1:]
    if names is not None:
        lines = [line for line in lines if line.partition(",")[0] in names]
    return [(name, value, unit) for name, value, unit in csv.reader(lines)]


def carry_out(
    case: Case, until: float | None, end: float | None, progress: Callable[[float], None] | bool | None, timeout: float | None,
    certify: bool, ideal_twin: bool,
) -> Run:  # fmt: skip
    """`Case.run`."""
    number = case._begin(False, end)
    tell = _bar if progress is True else progress or None
    try:
        status = advance(number, 1e300 if until is None else until, tell, timeout)
    except BaseException as error:  # the run so far goes with it
        error.run = from_handle(case.copy(), number)  # type: ignore[attr-defined]
        raise
    run = from_handle(case.copy(), number)
    if status == 4 or status == 0 and run.status != "done":
        raise RunError(run.status, run)
    if certify:
        before = len(run.summary)
        library().run_certify(number)
        rows = _quantities(number)
        run.summary = Summary(rows)
        run.certificate = Certificate(rows[before:])
    if ideal_twin:
        twin = case._begin(True, end)
        advance(twin, 1e300 if until is None else until, None, None)
        run.twin = from_handle(case.copy(), twin)
    return run


def advance(number: int, to: float, tell: Callable[[float], None] | None, timeout: float | None) -> int:
    """Advance a run of the library in slices of about `SLICE`, between which Python looks for interruptions. Returns -1 at a pause, 0
    at its end, 4 if it cannot go on. Raises ValueError for a time that is not a finite number."""
    began = before = time.monotonic()
    steps = 1  # which may take seconds
    while True:
        status = library().run_advance(number, to, steps)
        now, clock = library().run_time(number), time.monotonic()
        steps = max(1, min(4 * steps, int(steps * SLICE / max(clock - before, 1e-6)), 1_000_000))
        before = clock
        if tell is not None:
            tell(min(1.0, now / max(library().run_end(number), 1e-300)))
        if status == 2:
            raise ValueError(_library.message(number))
        if status != -1 or now >= to:
            return int(status)
        if timeout is not None and clock - began > timeout:
            raise TimeoutError(f"the run took more than {timeout} s")


def _bar(share: float) -> None:
    """Progress in one line, in a terminal or a notebook alone."""
    import sys

    if sys.stderr.isatty() or "ipykernel" in sys.modules:
        print(f"\r{share:4.0%} {'#' * round(40 * share)}", end="\n" if share >= 1 else "", file=sys.stderr, flush=True)


def compare(a: Run, b: Run, *names: str, ax: Any = None) -> pd.DataFrame:
    """How far two runs are apart in these columns, or in all that both have: largest and root mean square difference, and the range
    of `a`. Rows of `b` are interpolated at the times of `a`. The differences are drawn into `ax`, axes of matplotlib, if given.

    >>> case = gudgeon.template("dry")
    >>> found = compare(case.run(end=0.02), case.run(end=0.02, accuracy="reference"), "piston_position")
    >>> bool(0 < found.largest["piston_position"] < 1e-4 * found.range["piston_position"])
    True
    """
    import numpy as np
    import pandas as pd

    rows = []
    inside = a["time"] <= b["time"][-1]
    for name in names or [name for name in a.names if name in b.names and name != "time"]:
        apart = np.interp(a["time"][inside], b["time"], b[name]) - a[name][inside]
        rows.append((name, a.units[name], np.abs(apart).max(), math.sqrt(np.mean(apart**2)), np.ptp(a[name])))
        if ax is not None:
            ax.plot(a["time"][inside], apart, label=f"{name} [{a.units[name]}]")
    if ax is not None:
        ax.set(xlabel="time [s]", ylabel=f"{b.name} - {a.name}")
        ax.legend()
    return pd.DataFrame(rows, columns=["column", "unit", "largest", "rms", "range"]).set_index("column")


def orders(run: Run, name: str, settle: float | None = None) -> pd.DataFrame:
    """Amplitude, phase [deg] and scatter of each order of a column, cycles in a revolution, over the whole cycles after `settle`
    revolutions (default: half of the run).

    >>> found = orders(gudgeon.template("engine").run(), "piston_acceleration")
    >>> float(found.order[found.amplitude.idxmax()])
    1.0
    """
    from .cycles import orders, whole_cycles
    from .results import drawable

    return orders(whole_cycles(drawable(run), settle), name)


def _motion_of_file(text: str) -> dict[str, float | tuple[float, ...]]:
    """The group &initial of a file of a state."""
    group = re.sub("!.*", "", text).partition("&initial")[2].partition("/")[0]
    parts = re.split(r"(\w+) *=", group)[1:]
    numbers = {name: [_number(value) for value in values.split(",")] for name, values in zip(parts[::2], parts[1::2])}
    return {name: tuple(values) if len(values) > 1 else values[0] for name, values in numbers.items()}


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _table(rows: Any) -> str:
    from html import escape

    cells = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table>{cells}</table>"


def _polyline(x: Any, y: Any) -> str:
    """A small picture without axes."""
    import numpy as np

    chosen = np.linspace(0, len(x) - 1, min(len(x), 400)).astype(int)
    across = 300 * (x[chosen] - x[0]) / (np.ptp(x) or 1)
    up = 58 - 56 * (y[chosen] - y.min()) / (np.ptp(y) or 1)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up))
    return f'<br><svg width="300" height="60"><polyline points="{points}" fill="none" stroke="currentColor"/></svg>'
