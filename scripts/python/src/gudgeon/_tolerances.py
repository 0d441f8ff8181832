"""What distributions of the keys of a case do to its answers: Sobol points, percentiles, probabilities, runs that failed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from ._keys import keys as declared
from ._library import meant
from ._sweep import counted, sweep
from ._table import Table, Unit, sheet, text_of
from .case import Case
from .run import Page, Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CONFIDENCE = 0.95
#: Shares nearer to 0 and 1 than this have no finite value in many distributions.
LEAST_SHARE = 1e-9


class Probability(NamedTuple):
    """A probability with its interval of 95 %. Runs that failed count at its upper end as if they were within."""

    value: float
    low: float
    high: float


def tolerances(
    case: Case,
    distributions: Mapping[str, Any],
    keep: Sequence[str] = (),
    *,
    runs: int = 256,
    below: Mapping[str, float] | None = None,
    above: Mapping[str, float] | None = None,
    reduce: Callable[[Run], Mapping[str, Any]] | None = None,
    percentiles: Sequence[float] = (1, 10, 50, 90, 99),
    seed: int = 1,
    workers: int | None = None,
    progress: Callable[[float], None] | bool | None = None,
) -> Tolerances:
    """Runs of a case with keys drawn from independent distributions, at `runs` scrambled Sobol points (a power of 2).

    distributions: for each key a distribution of `scipy.stats` (norm, uniform, lognorm, ..., whatever has `ppf`), a function of the
    share that is below its value, or measured samples. keep: quantities of the summary; reduce: a function of the run that returns
    others. below, above: limits of quantities, whose probabilities the report shows. Runs that fail are counted; they are in no
    percentile.

    >>> from scipy import stats
    >>> found = tolerances(gudgeon.template("dry"), {"mechanism.piston_mass": stats.norm(0.14, 0.001)}, ["max_pin_force"], runs=8)
    >>> len(found.table), found.failures
    (8, {})
    """
    from scipy.stats import qmc

    if runs < 2 or runs & (runs - 1):
        raise ValueError(f"runs = {runs}: must be a power of 2")
    limits = {name: None for chosen in (below, above) for name in chosen or {}}
    kept = list(dict.fromkeys([*keep, *(limits if reduce is None else {})]))
    shares = np.clip(qmc.Sobol(len(distributions), rng=seed).random(runs), LEAST_SHARE, 1 - LEAST_SHARE)
    if not kept and reduce is None:
        raise ValueError("give quantities of the summary in keep, below or above, or a function reduce")
    values = np.column_stack([_values(name, of, share) for (name, of), share in zip(distributions.items(), shares.T)])
    names = list(distributions)
    table = sweep(case, values, names=names, keep=kept, reduce=reduce, workers=workers, progress=progress)
    quantities = [name for name in table.columns if name not in names and name != "status"]
    if unknown := [name for name in [*limits, *keep] if name not in quantities or table[name].isna().all()]:
        reasons = "; ".join(counted(table.status[table.status != "done"]))
        near = "" if reasons or reduce is not None else meant(unknown[0], list(case.run(columns="none").summary))
        raise ValueError(f"no run has {', '.join(dict.fromkeys(unknown))}" + (f" ({reasons})" if reasons else "") + near)
    given = {name: case[name] for name in names}
    nominal = sweep(case, pd.DataFrame([given]), keep=kept, reduce=reduce).iloc[0]
    return Tolerances(case, names, quantities, table, nominal, dict(below or {}), dict(above or {}), tuple(percentiles))


def _values(name: str, of: Any, shares: np.ndarray) -> np.ndarray:
    """The values of the distribution of a key that are above these shares of it."""
    if hasattr(of, "ppf"):
        return np.asarray(of.ppf(shares), dtype=float)
    if callable(of):
        return np.array([float(of(share)) for share in shares])
    try:
        return np.quantile(np.asarray(of, dtype=float), shares)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: give a distribution of scipy.stats, a function of the share below, or numbers in SI units") from None


@dataclass(frozen=True)
class Tolerances:
    """Runs with keys from distributions. `table` has a row for each run: keys, status, quantities; `nominal` the row of the case as it
    is."""

    case: Case
    keys: list[str]
    quantities: list[str]
    table: pd.DataFrame
    nominal: pd.Series
    below: dict[str, float]
    above: dict[str, float]
    chosen: tuple[float, ...]

    @property
    def done(self) -> pd.DataFrame:
        """The rows of the runs that are done."""
        return self.table[self.table.status == "done"]

    @property
    def failures(self) -> dict[str, int]:
        """The number of runs that failed for each reason, in which `...` stands for the value of a key."""
        return counted(self.table.status[self.table.status != "done"])

    def samples(self, name: str) -> np.ndarray:
        """The values of a quantity in the runs that are done and have it."""
        return self.done[name].dropna().to_numpy(dtype=float)

    def percentile(self, name: str, share: float) -> tuple[float, float, float]:
        """A percentile of a quantity, and the ends of its interval of 95 % from the order of the values, that of random points: Sobol
        points are nearer. An end is infinite where there are too few runs."""
        from scipy.stats import quantile_test

        values = self.samples(name)
        found = float(np.quantile(values, share / 100))
        interval = quantile_test(values, q=found, p=share / 100).confidence_interval(CONFIDENCE)
        low, high = (float(end) if np.isfinite(end) else sign * np.inf for end, sign in ((interval.low, -1), (interval.high, 1)))
        return found, low, high

    @property
    def percentiles(self) -> pd.DataFrame:
        """The chosen percentiles of the quantities."""
        found = {name: [self.percentile(name, share)[0] for share in self.chosen] for name in self.quantities}
        return pd.DataFrame.from_dict(found, orient="index", columns=list(self.chosen))

    def probability(self, name: str, *, below: float | None = None, above: float | None = None) -> Probability:
        """The probability that a quantity is below a limit, or above one, of the runs that are done; Clopper and Pearson's interval, that
        of random points."""
        from scipy.stats import binomtest

        if (below is None) == (above is None):
            raise TypeError("give a limit below or above")
        values = self.samples(name)
        within = int((values < below).sum() if below is not None else (values > above).sum())
        lost = len(self.table) - len(values)
        low = binomtest(within, len(self.table)).proportion_ci(CONFIDENCE).low
        high = binomtest(within + lost, len(self.table)).proportion_ci(CONFIDENCE).high
        return Probability(within / len(values), float(low), float(high))

    @property
    def rank_correlation(self) -> pd.DataFrame:
        """Spearman's correlation of each quantity with each key: which tolerance matters."""
        ranks = self.done[[*self.keys, *self.quantities]].astype(float).rank()
        return ranks.corr().loc[self.quantities, self.keys]

    @cached_property
    def _units(self) -> dict[str, Unit]:
        """Readable units of keys and quantities; those of quantities that are not of the summary are unknown."""
        units = {name: declared[name].unit for name in self.keys}
        own = self.case.run(columns="none").summary.units if self.quantities else {}
        units |= {name: own.get(name, "") for name in self.quantities}
        return {name: Unit.of(name, unit, self.samples(name)) for name, unit in units.items()}

    def tables(self) -> dict[str, Table]:
        """The percentiles with their intervals, the probabilities, the rank correlations, the failures, in readable units."""
        units = self._units
        rows = []
        for name in self.quantities:
            parts = [self.percentile(name, share) for share in self.chosen]
            shown = [[units[name](value) for value in part] for part in parts]
            texts = [f"{text_of(value)} ({_end(low)} to {_end(high)})" for value, low, high in shown]
            nominal = "-" if pd.isna(self.nominal[name]) else text_of(units[name](float(self.nominal[name])))
            rows.append([f"{name} [{units[name].name}]" if units[name].name else name, nominal, *texts])
        found = {"Percentiles": _table(["quantity", "nominal", *(f"{share:g} %" for share in self.chosen)], rows)}
        rows = []
        for limits, word, sign in ((self.below, "below", "<"), (self.above, "above", ">")):
            for name, limit in limits.items():
                chance = self.probability(name, **{word: limit})
                said = f"{name} {sign} {text_of(units[name](limit), 3, units[name].name)}"
                rows.append([said, *(f"{100 * value:.3g} %" for value in chance)])
        if rows:
            found["Probabilities"] = _table(["of", "probability", "at least", "at most"], rows)
        rows = [[name, *("-" if np.isnan(value) else f"{value:+.2f}" for value in line)] for name, line in self.rank_correlation.iterrows()]
        found["Rank correlations"] = _table(["quantity", *self.keys], rows)
        if self.failures:
            found["Runs that failed"] = _table(["reason", "runs"], [[reason, str(count)] for reason, count in self.failures.items()])
        return found

    @property
    def said(self) -> str:
        return f"{len(self.table)} runs at Sobol points, {len(self.table) - len(self.done)} failed; in brackets intervals of {100 * CONFIDENCE:g} %, ? where the runs are too few."

    def __repr__(self) -> str:
        return "\n\n".join([self.said, *(f"{title}:\n\n{table.markdown()}" for title, table in self.tables().items())])

    def draw(self) -> Figure:
        """For each quantity its histogram with the nominal value, the outer percentiles and the limits; and its values over the key that
        matters most, coloured by the second."""
        from matplotlib.figure import Figure

        from .names import COLUMNS, KEYS

        units = self._units
        labels = {name: units[name].label(KEYS.get(name) or COLUMNS.get(name) or name.split(".")[-1].replace("_", " ")) for name in (*self.keys, *self.quantities)}
        drawing = Figure(figsize=(7, 2.7 * len(self.quantities)), layout="constrained")
        for (left, right), name in zip(drawing.subplots(len(self.quantities), 2, squeeze=False), self.quantities):
            left.hist(units[name](self.samples(name)), "auto", color="#0072B2", alpha=0.5)
            marks = [("nominal", self.nominal[name], "black", "-")]
            marks += [(f"{share:g} %", self.percentile(name, share)[0], "#D55E00", ":") for share in (self.chosen[0], self.chosen[-1])]
            marks += [("limit", limits[name], "#009E73", "--") for limits in (self.below, self.above) if name in limits]
            for said, value, colour, style in marks:
                left.axvline(units[name](float(value)), color=colour, linestyle=style, linewidth=1.4, label=said)
            left.set(xlabel=labels[name], ylabel="runs")
            left.legend(frameon=True)
            order = self.rank_correlation.loc[name].abs().sort_values(ascending=False).index
            first, *others = order
            rows = self.done.dropna(subset=[name])
            over, up = (units[which](rows[which].to_numpy(dtype=float)) for which in (first, name))
            shade = units[others[0]](rows[others[0]].to_numpy(dtype=float)) if others else None
            points = right.scatter(over, up, c=shade, s=12)
            if others:
                drawing.colorbar(points, label=labels[others[0]])
            right.set(xlabel=labels[first], ylabel=labels[name])
        beyond = [(name, "below", limit) for name, limit in self.below.items()] + [(name, "above", limit) for name, limit in self.above.items()]
        shares = [f"{COLUMNS.get(name) or name.replace('_', ' ')} {word} {units[name](limit):.3g} {units[name].printed} in {100 * self.probability(name, **{word: limit}).value:.2g} % of the runs"
                  for name, word, limit in beyond]
        drawing.suptitle("\n".join(shares))
        return drawing

    def report(self) -> Page:
        """A page: percentiles, probabilities, what matters, the runs that failed, histograms."""
        from .language import Language
        from .report.cycles import picture

        parts = [f"<p>{self.said}</p>"]
        parts += [f"<h2>{title}</h2>{table.html()}" for title, table in self.tables().items()]
        parts.append(picture(self.draw(), "Histograms, and the quantities over the keys that matter most", Language()))
        return Page(sheet(f"{self.case.name}: tolerances", *parts))


def _end(value: float) -> str:
    return "?" if np.isinf(value) else text_of(float(value))


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    cells = pd.DataFrame(rows, columns=list(columns))
    return Table(cells, cells)
