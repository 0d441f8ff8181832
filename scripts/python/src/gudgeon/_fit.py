"""Keys of a case from measured data, by least squares: on traces, on levels of spectra, on answers of cycles."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from ._keys import keys as declared
from ._library import meant
from ._sweep import counted, sweep
from ._table import Table, Unit, sheet, text_of
from .case import Case, Value
from .run import Page, Run, _label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    Model = Callable[[np.ndarray], np.ndarray]  # points as rows -> answers as rows

#: A direction is not fixed if its singular value is smaller than this share of the largest: the Jacobian is no more exact.
JACOBIAN = 1e-4
#: A key has a part in a direction if its component is larger than this share of the largest.
PART = 0.1
#: Smoothing of the surface through the answers of a design, and the starts of the search on it.
SMOOTHING, STARTS = 0.003, 5
#: The size of a design's box over that of the one before.
SMALLER = 0.35


@dataclass(frozen=True)
class Key:
    """A key that is sought between two limits. Its coordinate, from 0 to `reach`, is the logarithm of the value over the least one, so
    that steps are relative changes; or the share of the range, if the limits are not both positive."""

    name: str
    least: float
    most: float

    @property
    def is_log(self) -> bool:
        return self.least > 0

    @property
    def reach(self) -> float:
        return math.log(self.most / self.least) if self.is_log else 1.0

    def value(self, coordinate: Any) -> Any:
        return self.least * np.exp(coordinate) if self.is_log else self.least + (self.most - self.least) * coordinate

    def coordinate(self, value: float) -> float:
        return math.log(value / self.least) if self.is_log else (value - self.least) / (self.most - self.least)

    def slope(self, value: float) -> float:
        """Change of the value with the coordinate."""
        return value if self.is_log else self.most - self.least


class Traces:
    """Columns over time or crank angle, compared where they were measured."""

    def __init__(self, data: pd.DataFrame) -> None:
        self.over = "time" if "time" in data else "crank_angle"
        self.names = [name for name in data.columns if name not in ("time", "crank_angle")]
        self.data = data

    @property
    def columns(self) -> list[str]:
        return ["time", "crank_angle", *self.names]

    @property
    def measured(self) -> np.ndarray:
        return self.data[self.names].to_numpy(dtype=float).T.ravel()

    def scale(self, errors: Mapping[str, float] | None) -> np.ndarray:
        one = [errors[name] if errors else self.data[name].std() or 1.0 for name in self.names]
        return np.repeat(one, len(self.data))

    def until(self, run: Run, time: float) -> Traces:
        """The part of the data before a time of this run."""
        end = time if self.over == "time" else abs(float(np.interp(time, run["time"], run["crank_angle"])))
        return Traces(self.data[self.data[self.over].abs() <= end * (1 + 1e-9)])

    def of(self, run: Run) -> np.ndarray:
        from scipy.interpolate import Akima1DInterpolator

        along, first = np.unique(run[self.over], return_index=True)
        at = self.data[self.over].to_numpy(dtype=float)
        close = 1e-9 * np.ptp(along)
        at = np.where((at > along[-1]) & (at < along[-1] + close), along[-1], at)
        return np.concatenate([Akima1DInterpolator(along, run[name][first])(at) for name in self.names])

    @property
    def labels(self) -> list[str]:
        return [name for name in self.names for _ in range(len(self.data))]


class Levels:
    """Levels of columns in bands of orders [dB], over the settled revolutions."""

    def __init__(self, data: pd.DataFrame, bands: Sequence[float], settle: float | None) -> None:
        self.bands, self.settle = list(bands), settle
        self.names = [name for name in data.columns if name not in ("time", "crank_angle")]
        self.measured = np.concatenate([levels(data, name, self.bands, settle) for name in self.names])

    @property
    def columns(self) -> list[str]:
        return ["time", "crank_angle", *self.names]

    def scale(self, errors: Mapping[str, float] | None) -> np.ndarray:
        return np.repeat([errors[name] if errors else 1.0 for name in self.names], len(self.bands) - 1)

    def of(self, run: Run) -> np.ndarray:
        return np.concatenate([levels(run, name, self.bands, self.settle) for name in self.names])

    @property
    def labels(self) -> list[str]:
        return [f"{name}, orders {a:g} to {b:g} [dB]" for name in self.names for a, b in zip(self.bands, self.bands[1:])]


class Failed(RuntimeError):
    """Runs on which a fit depends have failed."""


class Answers:
    """Quantities of the summary, or what a function of the run returns."""

    def __init__(self, data: Mapping[str, float], function: Callable[[Run], Mapping[str, float]] | None) -> None:
        self.names, self.function = list(data), function
        self.measured = np.array([float(value) for value in data.values()])
        self.columns = None if function else "none"

    def scale(self, errors: Mapping[str, float] | None) -> np.ndarray:
        return np.array([errors[name] for name in self.names]) if errors else np.where(self.measured == 0, 1.0, abs(self.measured))

    def of(self, run: Run) -> np.ndarray:
        found = self.function(run) if self.function else run.summary
        return np.array([float(found[name]) for name in self.names])

    @property
    def labels(self) -> list[str]:
        return self.names


def levels(run: Run | pd.DataFrame, name: str, bands: Sequence[float], settle: float | None = None) -> np.ndarray:
    """Levels of a column in bands between these orders of the crank [dB], mean over the whole revolutions after `settle` (default: half
    of them). Of a chaotic motion they can be compared, traces cannot. `run`: a run, or a table with the crank angle [rad].

    >>> angle = np.linspace(0, 20 * np.pi, 3601)
    >>> table = pd.DataFrame({"crank_angle": angle, "x": np.cos(3 * angle) + 10 * np.cos(5 * angle)})
    >>> low, high = levels(table, "x", [2, 4, 8])
    >>> float(round(high - low, 6))
    20.0
    """
    from .cycles import whole_cycles
    from .results import Run as Results

    trace = pd.DataFrame({"crank_angle": np.asarray(run["crank_angle"]), name: np.asarray(run[name])})
    cycles = whole_cycles(Results(getattr(run, "name", "data"), trace, {}, trace.iloc[:0]), settle)[name]
    power = np.mean(np.abs(np.fft.rfft(cycles, axis=1)) ** 2, axis=0)
    orders = np.arange(len(power))
    return np.array([10 * np.log10(power[(orders >= a) & (orders < b)].sum()) for a, b in zip(bands, bands[1:])])


def fit(
    case: Case,
    data: pd.DataFrame | Mapping[str, Any],
    keys: Mapping[str, tuple[Value, Value]],
    *,
    errors: Mapping[str, float] | None = None,
    answers: Callable[[Run], Mapping[str, float]] | None = None,
    bands: Sequence[float] | None = None,
    settle: float | None = None,
    designs: Sequence[int] | None = None,
    until: float | None = None,
    starts: int = 8,
    step: float = 1e-3,
    seed: int = 1,
    workers: int | None = None,
) -> Fit:
    """Values of keys with which a case has the measured data, by `scipy.optimize.least_squares`.

    data: a table with `time` [s] or `crank_angle` [rad] and columns of runs: traces, which are compared until the certificate of the
    runs ends (or `until` [s]); with `bands` (orders of the crank) the levels of their spectra are compared instead. Or numbers by their
    names: quantities of the summary, or what `answers(run)` returns. keys: least and most of each key, sought evenly in its logarithm if
    both are positive. errors: standard deviation of the measurement of each name; without it the residuals tell.

    designs: numbers of Sobol points in ever smaller boxes, between whose answers a surface is drawn and searched: for chaotic motion,
    whose answers are not smooth (default with `bands`: 128, 64, 64; else none, least_squares runs the case itself). settle: revolutions
    left out; starts: points from which the best start is taken; step: of the differences. Runs that fail on designs or among the starts
    are left out and counted; others raise RuntimeError. Raises ValueError if traces cannot be compared.
    """
    if wrong := [name for name, limits in keys.items() if not isinstance(limits, Sequence) or isinstance(limits, str) or len(limits) != 2]:
        raise ValueError(f"{', '.join(wrong)}: give the least and the largest value, such as (1e-5, 5e-5)")
    sought = [Key(name, *(float(case.set({name: limit})[name]) for limit in limits)) for name, limits in keys.items()]
    if wrong := [key.name for key in sought if not key.least < key.most]:
        raise ValueError(f"{', '.join(wrong)}: the first limit must be smaller than the second")
    of_numbers = not isinstance(data, pd.DataFrame) and all(np.ndim(value) == 0 for value in data.values())
    designs = list(designs) if designs is not None else [128, 64, 64] if bands is not None else []
    if of_numbers:
        observed: Any = Answers(data, answers)
    else:
        frame = pd.DataFrame(data)
        if "time" not in frame and "crank_angle" not in frame:
            raise ValueError("a table of measured data needs a column time [s] or crank_angle [rad]")
        observed = Traces(frame) if bands is None else Levels(frame, bands, settle)
        if designs and bands is None:
            raise ValueError("traces are compared by themselves, not on designs: give bands")
    if not np.isfinite(observed.measured).all():
        raise ValueError("the data have values that are not finite numbers")
    if errors is not None and (missing := [name for name in observed.names if name not in errors]):
        raise ValueError(f"errors: none for {', '.join(missing)}")
    base = case if observed.columns is None else case._with(None, observed.columns)
    runs = 0
    failed: list[tuple[str, str]] = []  # values of the keys, and the reason

    def model(points: np.ndarray) -> np.ndarray:
        nonlocal runs
        runs += len(points)
        values = np.column_stack([key.value(column) for key, column in zip(sought, points.T)])
        if isinstance(observed, Answers) and not observed.function:
            table = sweep(base, values, names=list(keys), keep=observed.names, workers=workers)
            found = table.reindex(columns=observed.names).to_numpy(dtype=float, copy=True)
        else:
            nothing = np.full(len(observed.measured), np.nan)
            table = sweep(
                base, values, names=list(keys), keep=[], workers=workers,
                reduce=lambda run: {"found": observed.of(run) if run.status == "done" else nothing},
            )  # fmt: skip
            found = np.stack([row if np.ndim(row) else nothing for row in table.get("found", [math.nan] * len(table))])
        found[(table.status != "done").to_numpy()] = np.nan
        beyond = ", or the data go beyond the run" if isinstance(observed, Traces) else ""
        for row in np.flatnonzero(~np.isfinite(found).all(axis=1)):
            missing = dict.fromkeys(label for label, value in zip(observed.labels, found[row]) if not np.isfinite(value))
            reason = table.status[row] if table.status[row] != "done" else f"the run has no {', '.join(missing)}{beyond}"
            failed.append((", ".join(f"{name} = {value:.6g}" for name, value in zip(keys, values[row])), reason))
        return found

    def values_at(place: np.ndarray) -> dict[str, Value]:
        return {key.name: float(key.value(x)) for key, x in zip(sought, place)}

    reach = np.array([key.reach for key in sought])
    own = [case[key.name] for key in sought]
    inside = all(key.least <= value <= key.most for key, value in zip(sought, own))
    place = np.array([key.coordinate(value) for key, value in zip(sought, own)]) if inside else reach / 2
    scale = observed.scale(errors)
    try:
        if designs:
            place, residuals, jacobian = search_on_designs(model, observed.measured, scale, reach, designs, seed)
        else:
            for count in (starts, 0, 0):  # again where the certificate of the result ends earlier
                if isinstance(observed, Traces):
                    run = base.set(values_at(place)).run(certify=until is None)
                    runs += 3 if until is None else 1
                    end = until if run.certificate is None else run.certificate.until
                    part = observed.until(run, end)
                    if len(part.data) * len(part.names) <= len(sought):
                        raise ValueError(f"traces can be compared until {end:.3g} s alone, which is too short: give bands or answers")
                    if count == 0 and len(part.data) == len(observed.data):
                        break
                    observed, scale = part, part.scale(errors)
                place, residuals, jacobian = search(model, observed.measured, scale, reach, place, count, step, seed)
                if until is not None or not isinstance(observed, Traces):
                    break
    except Failed as error:
        its, reason = failed[-1]
        if isinstance(observed, Answers) and not observed.function and reason.startswith("the run has no"):
            summary = case.run(columns="none").summary
            reason += next((meant(name, list(summary)) for name in observed.names if name not in summary), "")
        raise RuntimeError(f"{error}: {its}: {reason}") from None
    last = float(observed.data[observed.over].iloc[-1]) if isinstance(observed, Traces) else None
    found = observed.measured + scale * residuals
    return Fit(case.set(values_at(place)), sought, place, observed, found, residuals, jacobian, errors is not None, runs, last,
               counted(reason for _, reason in failed))  # fmt: skip


def search(
    model: Model, measured: np.ndarray, scale: np.ndarray, reach: np.ndarray, start: np.ndarray, starts: int, step: float, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The coordinates whose answers are the measured ones, the residuals over `scale`, and their Jacobian, by central differences. Starts
    whose runs fail are left out. Raises Failed."""
    from scipy.optimize import least_squares
    from scipy.stats import qmc

    def residuals(points: np.ndarray) -> np.ndarray:
        found = (model(points) - measured) / scale
        if not np.isfinite(found).all():
            raise Failed("a run of the search has failed")
        return found

    def jacobian(place: np.ndarray) -> np.ndarray:
        above, below = np.minimum(place + step, reach), np.maximum(place - step, 0)
        points = np.vstack([np.where(np.eye(len(place)) > 0, end, place) for end in (above, below)])
        found = residuals(points)
        return ((found[: len(place)] - found[len(place) :]) / (above - below)[:, None]).T

    if starts:
        points = np.vstack([start, reach * qmc.Sobol(len(reach), rng=seed).random(starts)])
        sizes = ((model(points) - measured) ** 2 / scale**2).sum(axis=1)
        start = points[np.argmin(np.where(np.isfinite(sizes), sizes, np.inf))]
    start = np.clip(start, 1e-6 * reach, (1 - 1e-6) * reach)
    found = least_squares(lambda x: residuals(x[None])[0], start, jacobian, (np.zeros_like(reach), reach), xtol=1e-7, ftol=1e-10, max_nfev=40)
    return found.x, found.fun, jacobian(found.x)


def search_on_designs(
    model: Model, measured: np.ndarray, scale: np.ndarray, reach: np.ndarray, designs: Sequence[int], seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same on surfaces through the answers at Sobol points, in ever smaller boxes around the best place. Runs that fail are left
    out. Raises Failed if too few are left."""
    from scipy.interpolate import RBFInterpolator
    from scipy.optimize import least_squares
    from scipy.stats import qmc

    least, most = np.zeros_like(reach), reach.copy()
    for stage, runs in enumerate(designs):
        centre, half = (least + most) / 2, (most - least) / 2
        points = least + (most - least) * qmc.Sobol(len(reach), rng=seed + stage).random(runs)
        found = (model(points) - measured) / scale
        good = np.isfinite(found).all(axis=1)
        if good.sum() < 2 * len(reach) + 1:
            raise Failed(f"{(~good).sum()} of {runs} runs of a design have failed")
        places, found = ((points - centre) / half)[good], found[good]
        surface = RBFInterpolator(places, found, smoothing=SMOOTHING)
        nearest = places[(found**2).sum(axis=1).argsort()[:STARTS]]
        best = min((least_squares(lambda x: surface(x[None])[0], start, bounds=(-1, 1)) for start in nearest), key=lambda one: one.cost)
        place = centre + half * best.x
        jacobian = best.jac / half
        least, most = np.maximum(0, place - SMALLER * half), np.minimum(reach, place + SMALLER * half)
    return place, best.fun, jacobian


@dataclass(frozen=True)
class Fit:
    """Values of keys found from data. `case` is the case with them.

    Errors, condition and directions are those of small changes around the result: of keys between positive limits relative ones, of
    others shares of the range. `free` are directions that the data do not fix, key -> exponent (share of the range), the largest 1: along
    each the keys may change together.
    """

    case: Case
    sought: list[Key]
    place: np.ndarray
    observed: Any
    found: np.ndarray
    residuals: np.ndarray
    jacobian: np.ndarray
    errors_known: bool
    runs: int
    until: float | None
    failures: dict[str, int] = field(default_factory=dict)  # runs that were left out, by their reasons

    @property
    def keys(self) -> list[str]:
        return [key.name for key in self.sought]

    @property
    def values(self) -> dict[str, float]:
        return {key.name: float(key.value(x)) for key, x in zip(self.sought, self.place)}

    @property
    def rms(self) -> float:
        """Root mean square residual, in the unit of the data if there is one name of data alone, else over the scales."""
        apart = self.found - self.observed.measured if len(set(self.observed.names)) == 1 else self.residuals
        return float(np.sqrt(np.mean(apart**2)))

    @cached_property
    def scatter(self) -> float:
        """Standard deviation of the data over their scales: 1 if their errors were given, else that of the residuals."""
        if self.errors_known:
            return 1.0
        spare = len(self.residuals) - len(self.sought)
        return math.sqrt(float(self.residuals @ self.residuals) / spare) if spare > 0 else math.nan

    @cached_property
    def _decomposed(self) -> tuple[np.ndarray, np.ndarray]:
        """Singular values, the largest first, and directions as rows."""
        _, singular, directions = np.linalg.svd(self.jacobian, full_matrices=True)
        return np.concatenate([singular, np.zeros(len(self.sought) - len(singular))]), directions

    @property
    def condition(self) -> float:
        """The largest singular value of the Jacobian over the smallest."""
        singular = self._decomposed[0]
        return float(singular[0] / singular[-1]) if singular[-1] > 0 else math.inf

    @cached_property
    def _is_free(self) -> np.ndarray:
        """Whether each direction is not fixed: its error is more than half of what the limits allow, or its singular value is noise."""
        singular, directions = self._decomposed
        reach = np.array([key.reach for key in self.sought])
        shares = np.abs(directions) / np.abs(directions).max(axis=1, keepdims=True)
        allowed = np.min(np.where(shares > PART, reach / np.maximum(np.abs(directions), 1e-300), np.inf), axis=1)
        scatter = 0.0 if math.isnan(self.scatter) else self.scatter
        return (singular < JACOBIAN * singular[0]) | (scatter > 0.5 * allowed * singular)

    @property
    def free(self) -> list[dict[str, float]]:
        found = []
        for direction in self._decomposed[1][self._is_free]:
            parts = direction / direction[np.argmax(np.abs(direction))]
            found.append({key: float(part) for key, part in zip(self.keys, parts) if abs(part) > PART})
        return found

    @cached_property
    def _covariance(self) -> np.ndarray:
        """Of the coordinates, in the directions that are fixed."""
        singular, directions = self._decomposed
        fixed = directions[~self._is_free] / singular[~self._is_free, None]
        return self.scatter**2 * fixed.T @ fixed

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard error of each key in its unit; infinite for one that the data do not fix."""
        loose = {key for direction in self.free for key in direction}
        found = np.sqrt(np.diag(self._covariance))
        return {
            key.name: math.inf if key.name in loose else float(error * key.slope(value))
            for key, error, value in zip(self.sought, found, self.values.values())
        }

    @property
    def correlation(self) -> pd.DataFrame:
        """Of the errors of the keys."""
        size = np.sqrt(np.diag(self._covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            return pd.DataFrame(self._covariance / np.outer(size, size), self.keys, self.keys)

    @property
    def at_limits(self) -> list[str]:
        """Keys that ended at one of their limits."""
        return [key.name for key, x in zip(self.sought, self.place) if min(x, key.reach - x) < 1e-4 * key.reach]

    @cached_property
    def table(self) -> Table:
        """Keys with values and standard errors in readable units."""
        data, cells = [], []
        for key, value, error in zip(self.sought, self.values.values(), self.standard_errors.values()):
            unit = Unit.of(key.name, declared[key.name].unit, [value])
            shown, off = unit(value), error * unit.factor
            data.append([key.name, unit.name, shown, off])
            digits = 3 if not (0 < off < abs(shown)) else max(3, min(9, 2 + math.floor(math.log10(abs(shown))) - math.floor(math.log10(off))))
            cells.append([key.name, text_of(shown, digits, unit.name), "not fixed" if math.isinf(off) else text_of(off, 2, unit.name)])
        columns = ["key", "value", "standard error"]
        return Table(pd.DataFrame(data, columns=["key", "unit", *columns[1:]]), pd.DataFrame(cells, columns=columns))

    @property
    def notes(self) -> list[str]:
        """What has to be known of the result."""
        found = [f"{len(self.residuals)} data, {self.runs} runs; root mean square residual {self.rms:.3g}; condition number {self.condition:.3g}."]
        if self.until is not None:
            found.append(f"Traces are compared until {self.until:.4g} {'s' if self.observed.over == 'time' else 'rad'}.")
        found += [f"Runs left out: {count} ({reason})." for reason, count in self.failures.items()]
        for direction in self.free:
            found.append("Not fixed by the data: " + " · ".join(f"{key}^{part:.2g}" for key, part in direction.items()) + ".")
        if self.at_limits:
            found.append(f"At a limit: {', '.join(self.at_limits)}.")
        return found

    def __repr__(self) -> str:
        return "\n".join([self.table.markdown(), "", *self.notes])

    @property
    def compared(self) -> Table:
        """Each of the data, and what the fitted case has, in readable units; for answers and levels."""
        own = self.case.run(columns="none").summary.units if isinstance(self.observed, Answers) else {}
        rows = []
        for name, measured, found in zip(self.observed.labels, self.observed.measured, self.found):
            unit = Unit.of(name, own.get(name, ""), [measured])
            rows.append([name, *(text_of(float(unit(value)), 4, unit.name) for value in (measured, found))])
        cells = pd.DataFrame(rows, columns=["data", "measured", "fit"])
        return Table(cells, cells)

    def draw(self) -> Figure:
        """The data and what the fitted case has."""
        from matplotlib.figure import Figure

        if isinstance(self.observed, Answers):
            drawing = Figure(figsize=(7, 1 + 0.3 * len(self.residuals)), layout="constrained")
            axis = drawing.subplots()
            axis.barh(self.observed.labels, self.residuals, color="tab:red")
            axis.axvline(0, color="black", linewidth=0.7)
            axis.invert_yaxis()
            axis.set_xlabel("fit − measured, over its error" if self.errors_known else "(fit − measured) / measured")
            return drawing
        names, units = [""], {}
        if isinstance(self.observed, Traces):
            names = self.observed.names
            units = {column.name: column.unit for column in self.case._with(None, self.observed.columns).columns}
        drawing = Figure(figsize=(9, 3.2 * len(names)), layout="constrained")
        axes = drawing.subplots(len(names), 2, squeeze=False)
        measured, found = (values.reshape(len(names), -1) for values in (self.observed.measured, self.found))
        for (left, right), name, data, own in zip(axes, names, measured, found):
            if name:
                x = self.observed.data[self.observed.over].to_numpy(dtype=float)
                along = "time [s]" if self.observed.over == "time" else "crank angle [rad]"
                for axis in (left, right):
                    axis.set_xlabel(along)
            else:
                x = np.arange(len(data))
                for axis in (left, right):
                    axis.set_xticks(x, self.observed.labels, rotation=90, fontsize=6)
            left.plot(x, data, ".k", markersize=3, label="measured")
            left.plot(x, own, color="tab:blue", linewidth=0.9, label="fit")
            left.set_ylabel(_label(name, units.get(name, "")))
            left.legend()
            right.axhline(0, color="black", linewidth=0.7)
            right.plot(x, own - data, ".", color="tab:red", markersize=3)
            right.set_ylabel("fit − measured")
        return drawing

    def report(self) -> Page:
        """A page: keys with their errors, what the data do not fix, correlation, singular values, the data and the fit."""
        from html import escape

        from .language import Language
        from .report.cycles import picture

        parts = [self.table.html(), *(f"<p>{escape(note)}</p>" for note in self.notes)]
        said = "Residuals, fit − measured" if isinstance(self.observed, Answers) else "Measured, and the fitted case; residuals"
        of_each = [] if isinstance(self.observed, Traces) else [self.compared.html()]
        parts += ["<h2>Data and fit</h2>", *of_each, picture(self.draw(), said, Language())]
        singular, directions = self._decomposed
        rows = [[text_of(float(value)), *(text_of(float(part), 2) for part in row)] for value, row in zip(singular, directions)]
        parts += ["<h2>Singular values and their directions</h2>", _html(["singular value", *self.keys], rows)]
        rows = [[key, *("-" if np.isnan(value) else f"{value:.2f}" for value in line)] for key, line in self.correlation.iterrows()]
        parts += ["<h2>Correlation of the errors</h2>", _html(["", *self.keys], rows)]
        return Page(sheet(f"{self.case.name}: fit", *parts))


def _html(columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    cells = pd.DataFrame(rows, columns=list(columns))
    return Table(cells, cells).html()
