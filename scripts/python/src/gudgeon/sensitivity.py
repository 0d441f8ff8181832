"""Global sensitivity of a study's results to its parameters, computed by SALib: elementary effects of Morris, indices of Sobol."""

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing
from SALib.analyze import morris as morris_analysis
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import morris as morris_sample
from SALib.sample import sobol as sobol_sample

from gudgeon import language
from gudgeon.names import of_column, of_parameter, plain_unit, prefixed
from gudgeon.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    WIDTH,
    add_legend,
)
from gudgeon.study import Parameter, Runs

METHODS = ("morris", "sobol")

#: Number of levels of Morris's grid.
LEVELS = 4

#: Confidence level of all intervals.
CONFIDENCE = 0.95

#: Number of resamples of the bootstrap that gives the intervals.
RESAMPLES = 500

#: Colour and mark of each parameter in the order of the study.
MARKS = (
    (BLUE, "o"), (VERMILION, "s"), (GREEN, "^"), (PURPLE, "D"), (ORANGE, "v"), (BLACK, "P"), (SKY, "X"), (GREY, "*"),
)

#: For each method, the index that ranks the parameters, and a second index that is shown with it.
INDICES = {"morris": ("mu_star", "sigma"), "sobol": ("ST", "S1")}


@dataclass(frozen=True)
class Output:
    """A column of the results, or its decimal logarithm."""

    column: str
    log: bool = False

    @classmethod
    def parse(cls, text: str) -> "Output":
        return cls(text.removeprefix("log:"), text.startswith("log:"))

    @property
    def name(self) -> str:
        return f"log10 {self.column}" if self.log else self.column

    def unit(self, runs: Runs) -> str:
        return "decades" if self.log else runs.units[self.column]

    def values(self, runs: Runs) -> np.ndarray:
        """The values; NaN where the run failed or has no such value."""
        values = np.where(runs.done, pd.to_numeric(runs.table[self.column], errors="coerce"), np.nan).astype(float)
        if not self.log:
            return values
        return np.log10(values, where=values > 0, out=np.full(len(values), np.nan))


@dataclass(frozen=True)
class Indices:
    """Results of one method for one output: a row for each parameter."""

    method: str
    output: str
    table: pd.DataFrame
    points: int  # trajectories or base points that were used
    left_out: int  # those left out because one of their runs has no value
    spread: float  # standard deviation of the output
    mean: float
    unit: str

    @property
    def ranked(self) -> pd.DataFrame:
        return self.table.sort_values(INDICES[self.method][0], ascending=False)

    @property
    def constant(self) -> bool:
        return not self.spread > 0


def problem(parameters: Sequence[Parameter]) -> dict[str, object]:
    """The parameters in the form that SALib expects."""
    return {
        "num_vars": len(parameters),
        "names": [parameter.key for parameter in parameters],
        "bounds": [parameter.bounds for parameter in parameters],
    }


def sample(method: str, parameters: Sequence[Parameter], points: int, seed: int) -> np.ndarray:
    """Rows of the sampled space: `points` trajectories of Morris, or base points of Saltelli's scheme with their exchanges."""
    if method == "morris":
        return morris_sample.sample(problem(parameters), points, num_levels=LEVELS, seed=seed)
    return sobol_sample.sample(problem(parameters), points, calc_second_order=False, seed=seed)


def block(method: str, parameters: int) -> int:
    """Number of rows that belong together: those of a trajectory, or of a base point with its exchanges."""
    return parameters + (1 if method == "morris" else 2)


def values(parameters: Sequence[Parameter], sampled: np.ndarray) -> np.ndarray:
    """Values of the case's keys for rows of the sampled space."""
    return np.column_stack([p.value(column) for p, column in zip(parameters, sampled.T)])


def analyse(
    method: str,
    parameters: Sequence[Parameter],
    sampled: np.ndarray,
    result: np.ndarray,
    output: tuple[str, str],
    seed: int,
) -> Indices:
    """Indices of a result (`output`: its name and unit) with their confidence intervals. A block that contains a value that is not
    finite is left out as a whole; the remaining blocks are still a sample of the same scheme, restricted to runs that reach their
    end."""
    size = block(method, len(parameters))
    whole = np.isfinite(result.reshape(-1, size)).all(axis=1)
    kept = np.repeat(whole, size)
    names = [parameter.key for parameter in parameters]
    columns = ("mu", "mu_star", "mu_star_conf", "sigma") if method == "morris" else ("S1", "S1_conf", "ST", "ST_conf")
    used, given = result[kept], int(whole.sum())
    spread = float(used.std()) if given else np.nan
    if given < 2 or spread <= 1e-12 * np.abs(used).max():
        table = pd.DataFrame(0.0 if given >= 2 else np.nan, index=names, columns=list(columns))
        spread = 0.0 if given >= 2 else np.nan
    else:
        settings = {"conf_level": CONFIDENCE, "num_resamples": RESAMPLES, "seed": seed}
        if method == "morris":
            found = morris_analysis.analyze(problem(parameters), sampled[kept], used, num_levels=LEVELS, **settings)
        else:
            found = sobol_analysis.analyze(problem(parameters), used, calc_second_order=False, **settings)
        table = pd.DataFrame({name: np.asarray(found[name], dtype=float) for name in columns}, index=names)
    mean = float(used.mean()) if given else np.nan
    name, unit = output
    return Indices(method, name, table, given, int((~whole).sum()), spread, mean, unit)


def prefixes(method: str, parameters: int, rows: int) -> list[int]:
    """Numbers of rows in a quarter, a half and all of the sample."""
    size = block(method, parameters)
    points = rows // size
    return [size * n for n in sorted({max(points // 4, 2), max(points // 2, 2), points})]


def records(found: Indices) -> list[dict[str, object]]:
    """Rows of the table of indices: one for each parameter and index."""
    rows = []
    for parameter, row in found.table.iterrows():
        for index in (name for name in found.table.columns if not name.endswith("_conf")):
            rows.append(
                {
                    "method": found.method,
                    "output": found.output,
                    "parameter": parameter,
                    "index": index,
                    "value": row[index],
                    "confidence": row.get(f"{index}_conf", np.nan),
                    "points": found.points,
                    "points_left_out": found.left_out,
                }
            )
    return rows


def describe(found: Indices) -> str:
    """One to three sentences about the result, in the language of the pictures."""
    say, number = language.current.say, language.current.number
    left_out = f", {found.left_out} left out for runs without a value" if found.left_out else ""
    what = "trajectories" if found.method == "morris" else "base points"
    head = f"{found.output}, {found.method} ({say(f'{found.points} {what}{left_out}')}):"
    if found.points < 2:
        return f"{head} {say('too few are left for a result.')}"
    if found.constant:
        return f"{head} {say(f'{found.mean:.4g} in every run: no parameter matters within these ranges.')}"
    index, beside = INDICES[found.method]
    ranked = found.ranked
    ahead = ranked[ranked[index] > ranked[f"{index}_conf"]]
    said = [
        f"{key} " + number(f"{row[index]:.2g} +- {row[f'{index}_conf']:.1g} ({row[beside]:.2g})") for key, row in ahead.iterrows()
    ]
    text = f"{head} {say(f'mean {found.mean:.4g}, standard deviation {found.spread:.3g}')}; {index} ({beside}): {', '.join(said)}"
    nothing = [key for key, row in ranked.iterrows() if row[index] == 0]
    unclear = [key for key in ranked.index if key not in ahead.index and key not in nothing]
    text += f"; {say('not distinguishable from no effect')}: {', '.join(unclear)}" if unclear else ""
    text += f"; {say('no effect at all')}: {', '.join(nothing)}." if nothing else "."
    if found.method == "sobol":
        alone = 100 * ranked["S1"].sum()
        rest = "the rest (including random errors)" if alone < 100 else "no measurable part"
        text += " " + say(f"The parameters one by one explain {np.clip(alone, 0, 100):.0f} % of the variance, their interaction {rest}.")
    return text


def draw(found: Sequence[Indices], parameters: Sequence[Parameter], title: str) -> Drawing:
    """A row of panels for each output that varies, a panel for each method; parameters in the order of the study."""
    still = {item.output: item for item in found if item.constant}
    outputs = list(dict.fromkeys(item.output for item in found if item.output not in still)) or list(still)
    methods = [method for method in METHODS if any(item.method == method for item in found)]
    height = 0.9 + len(outputs) * (1.1 + 0.2 * len(parameters))
    drawing, axes = plt.subplots(
        len(outputs), len(methods), figsize=(WIDTH, height), squeeze=False, layout="constrained"
    )
    for item in found:
        if item.output in outputs:
            draw_panel(axes[outputs.index(item.output)][methods.index(item.method)], item, parameters)
    notes = [f"{output_name(item)}: {item.mean:.3g} in every run" for name, item in still.items() if name not in outputs]
    drawing.suptitle("\n".join([title, *notes]))
    add_legend(drawing, drawing.axes)
    return drawing


def output_name(found: Indices) -> str:
    """Name of a result in titles."""
    column = found.output.removeprefix("log10 ")
    return of_column(column, "", np.zeros(0)).name + (", its logarithm" if found.output != column else "")


def draw_panel(axis: plt.Axes, found: Indices, parameters: Sequence[Parameter]) -> None:
    """Morris: standard deviation of a parameter's effects over their mean magnitude, one mark for each parameter. Sobol: a light
    bar for its total index, and within it a dark bar for its first-order index."""
    axis.set_title(f"{'Morris' if found.method == 'morris' else 'Sobol'}:\n{output_name(found)}")
    if found.constant:
        text = "no value" if np.isnan(found.mean) else f"{found.mean:.3g} in every run"
        axis.text(0.5, 0.5, text, transform=axis.transAxes, ha="center", va="center", color=GREY)
        axis.set_xticks([])
        axis.set_yticks([])
        return
    names = [of_parameter(parameter.key, np.zeros(0)).name for parameter in parameters]
    draw_morris(axis, found, names) if found.method == "morris" else draw_sobol(axis, found, names)


def draw_morris(axis: plt.Axes, found: Indices, names: Sequence[str]) -> None:
    """The plane of mu* and sigma, for the effect of a change over the whole range of a parameter. Parameters far to the right have
    a large effect; those above the line sigma = mu* interact with others or act nonlinearly."""
    unit, factor = prefixed(found.unit, found.table["mu_star"].to_numpy())
    size, scatter = factor * found.table["mu_star"], factor * found.table["sigma"]
    error = factor * found.table["mu_star_conf"]
    for place, name in enumerate(names):
        colour, mark = MARKS[place % len(MARKS)]
        axis.errorbar(
            size.iloc[place], scatter.iloc[place], xerr=error.iloc[place], color=colour, marker=mark, markersize=5, linestyle="none",
            elinewidth=0.7, capsize=1.5, label=name,
        )
    top = 1.1 * max(float((size + error).max()), float(scatter.max()))
    axis.plot([0, top], [0, top], color=GREY, linestyle=":", linewidth=0.8, label="σ = µ*")
    axis.set_xlim(-0.03 * top, top)
    axis.set_ylim(-0.03 * top, top)
    of_unit = f" [{plain_unit(unit)}]" if plain_unit(unit) else ""
    axis.set_xlabel(f"µ*: mean size of the effect{of_unit}")
    axis.set_ylabel(f"σ: scatter of the effect{of_unit}")


def draw_sobol(axis: plt.Axes, found: Indices, names: Sequence[str]) -> None:
    place = np.arange(len(names))
    for index, width, colour, label, beside in (
        ("ST", 0.8, SKY, "total index", -0.27),
        ("S1", 0.3, BLUE, "first-order index", 0.0),
    ):
        axis.barh(place, found.table[index], width, color=colour, label=label)
        axis.errorbar(
            found.table[index], place + beside, xerr=found.table[f"{index}_conf"], fmt="none", ecolor=BLACK, elinewidth=0.7, capsize=1.5
        )
    axis.set_yticks(place, names)
    axis.set_ylim(len(names) - 0.4, -0.6)
    axis.grid(axis="y", visible=False)
    axis.axvline(0, color=GREY, linewidth=0.6)
    axis.set_xlabel("share of the variance; error bars: 95 %")
