"""Pictures of parameter studies: curves, maps and bifurcation diagrams, and their numbers."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.names import Shown, of_column, of_parameter
from gudgeon.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    VERMILION,
    WIDTH,
    add_legend,
    mark_decades,
)
from gudgeon.results import MissingResult, events_of, read_table
from gudgeon.study import Runs
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MaxNLocator
from scipy.optimize import brentq

#: From this ratio of largest to smallest value on, a scale is logarithmic.
WIDE_RATIO = 30.0

#: A map of at most so many cells is drawn as a table.
MOST_CELLS = 49

#: Film thickness [µm] that is three times a usual roughness.
THIN = 1.0

#: The colours of a map cover these percentiles of its values if the percentiles cover less than this share of the whole range.
OUTER_PERCENTILES, KEPT_RANGE = (1, 99), 0.75

#: Strobed points that differ by less than this share of the clearance count as one point.
SAME_POINT = 2e-3

#: Longest period that is searched for [revolutions].
LONGEST_PERIOD = 8

#: Impacts count if they are faster than this share of the fastest in the run; slower ones are influenced by the load on the pin.
HARD_IMPACT = 0.5


def grid(runs: Runs, x: str, y: str, column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A column over two parameters: values of x, of y, and of the column (y down, x across), NaN where a run failed."""
    table = runs.table.assign(**{column: np.where(runs.done, runs.table[column], np.nan).astype(float)})
    found = table.pivot(index=y, columns=x, values=column)
    return found.columns.to_numpy(dtype=float), found.index.to_numpy(dtype=float), found.to_numpy(dtype=float)


def mark_failed(axis: Axes, runs: Runs, x: str, y: str, shown_x: Shown, shown_y: Shown) -> None:
    """Draw crosses where runs failed."""
    if not runs.done.all():
        failed = runs.table[~runs.done]
        axis.plot(shown_x(failed[x]), shown_y(failed[y]), "x", color=VERMILION, markersize=4, label="failed")


def is_even_in_logarithm(values: np.ndarray) -> bool:
    """Whether a parameter's values are spaced evenly in their logarithm rather than themselves."""
    steps = np.unique(np.asarray(values, dtype=float))
    if len(steps) < 3 or steps[0] <= 0:
        return False
    plain, ratio = np.diff(steps), np.diff(np.log(steps))
    return bool(np.std(ratio) / np.mean(ratio) < 0.5 * np.std(plain) / np.mean(plain))


def scale_axis(axis: Axes, which: str, values: np.ndarray) -> None:
    """Make an axis logarithmic if its values are spaced evenly in their logarithm."""
    if is_even_in_logarithm(values):
        getattr(axis, f"set_{which}scale")("log")
        mark_decades(getattr(axis, f"{which}axis"))


def spans_decades(values: np.ndarray) -> bool:
    """Whether the range of values needs a logarithmic scale."""
    finite = values[np.isfinite(values)]
    return bool(finite.size and finite.min() > 0 and finite.max() > WIDE_RATIO * finite.min())


def colour_scale(values: np.ndarray) -> tuple[Normalize, str]:
    """Range of colours for the values of a map, and the ends at which values lie beyond it ("neither", "min", "max" or "both").
    Outliers are left out of the range, so that the other values can be distinguished."""
    finite = values[np.isfinite(values)]
    if not finite.size:   # all runs failed
        return Normalize(0, 1), "neither"
    as_log = spans_decades(finite)
    bend = np.log if as_log else np.asarray
    low, high = np.percentile(finite, OUTER_PERCENTILES)
    if bend(high) - bend(low) > KEPT_RANGE * (bend(finite.max()) - bend(finite.min())):
        low, high = finite.min(), finite.max()
    below, above = finite.min() < low, finite.max() > high
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[(below, above)]
    return (LogNorm if as_log else Normalize)(low, high), extend


def is_constant(runs: Runs, column: str) -> bool:
    values = runs.table.loc[runs.done, column].astype(float)
    return bool(values.nunique(dropna=True) <= 1)


def is_grid(runs: Runs, x: str, y: str) -> bool:
    """Whether runs are numbers on a grid of two parameters, one at each of its points."""
    table = runs.table
    if not all(pd.api.types.is_numeric_dtype(table[name]) for name in (x, y)) or table.duplicated([x, y]).any():
        return False
    return table[x].nunique() * table[y].nunique() == len(table)


def table_panel(drawing: Drawing, axis: Axes, shown_x: Shown, shown_y: Shown, shown: Shown, xs: np.ndarray, ys: np.ndarray, values: np.ndarray) -> None:
    """A column of a study over its two parameters as a table: equal cells with their numbers on light colours. Failed runs are ×."""
    norm, _ = colour_scale(values)
    axis.pcolormesh(values, norm=norm, cmap="Oranges", edgecolors="white", linewidth=1)
    for (row, column), value in np.ndenumerate(values):
        dark = np.isfinite(value) and norm(value) > 0.6
        said = f"{value:.0f}" if abs(value) >= 100 or abs(value) < 1e-3 * norm.vmax and not isinstance(norm, LogNorm) else f"{value:.2g}"
        axis.text(column + 0.5, row + 0.5, said if np.isfinite(value) else "×", ha="center", va="center", fontsize=7, color="white" if dark else BLACK)
    axis.set_xticks(np.arange(len(xs)) + 0.5, [f"{shown_x(one):.3g}" for one in xs])
    axis.set_yticks(np.arange(len(ys)) + 0.5, [f"{shown_y(one):.3g}" for one in ys])
    axis.tick_params(length=0)
    axis.set(xlabel=shown_x.label, ylabel=shown_y.label, title=shown.label)
    axis.grid(visible=False)


def map_panel(
    drawing: Drawing, axis: Axes, runs: Runs, x: str, y: str, column: str, norm: Normalize | None = None, beside: Sequence[Axes] = (),
) -> None:  # fmt: skip
    """A column of a study over its two parameters, with the colour bar below it, or below all axes `beside`, whose colours `norm` has."""
    xs, ys, values = grid(runs, x, y, column)
    shown_x, shown_y = of_parameter(x, xs), of_parameter(y, ys)
    shown = of_column(column, runs.units[column], values)
    values = shown(values)
    if norm is None and values.size <= MOST_CELLS:
        table_panel(drawing, axis, shown_x, shown_y, shown, xs, ys, values)
        return
    own, extend = colour_scale(values)
    norm = norm or own
    colours = "viridis" if column.startswith("min_film") and shown.factor > 0 else "magma"
    image = axis.pcolormesh(shown_x(xs), shown_y(ys), values, norm=norm, cmap=colours, shading="nearest")
    if isinstance(norm, LogNorm) and colours == "viridis":
        exponents = range(int(np.floor(np.log10(norm.vmin))), int(np.ceil(np.log10(norm.vmax))) + 1)
        levels = [m * 10.0**k for k in exponents for m in (1, 3) if np.nanmin(values) < m * 10.0**k < np.nanmax(values)]
        if levels:
            lines = axis.contour(shown_x(xs), shown_y(ys), values, levels=levels, colors="white", linewidths=0.8)
            long = [level for level, parts in zip(lines.levels, lines.allsegs) if sum(map(len, parts)) > 12]
            axis.clabel(lines, long, fmt=lambda value: f"{value:g}", fontsize=7)
    mark_failed(axis, runs, x, y, shown_x, shown_y)
    scale_axis(axis, "x", shown_x(xs))
    scale_axis(axis, "y", shown_y(ys))
    axis.set_xlabel(shown_x.label)
    axis.set_ylabel(shown_y.label)
    axis.grid(visible=False)
    if norm is own or beside:
        bar = drawing.colorbar(image, ax=beside or axis, location="bottom", label=shown.label, extend="neither" if beside else extend, aspect=30, pad=0.02)
        if isinstance(norm, LogNorm):
            mark_decades(bar.ax.xaxis)


def draw_maps(studies: dict[str, Runs]) -> Drawing:
    """Both films of simulations I and IV over clearance and speed, with one scale for the thickness and one for the time in contact. A
    bold line is the thickness that a film needs above a usual roughness."""
    drawing, axes = plt.subplots(2, 2, figsize=(WIDTH, 7.0), sharex=True, sharey=True)
    x, y = "joint.clearance", "initial.crank_speed"
    films = np.concatenate([1e6 * grid(studies[f"map_{number}"], x, y, "min_film_thickness")[2].ravel() for number in ("I", "IV")])
    for row, number in zip(axes, ("I", "IV")):
        carried, touching = studies[f"map_{number}"], studies[f"map_{number}_oscillating"]
        last = row[0] is axes[-1][0]
        map_panel(drawing, row[0], carried, x, y, "min_film_thickness", LogNorm(np.nanmin(films), np.nanmax(films)), list(axes[:, 0]) if last else ())
        xs, ys, values = grid(carried, x, y, "min_film_thickness")
        row[0].contour(1e6 * xs, ys, 1e6 * values, levels=[THIN], colors="white", linewidths=2.2)
        share = 100 * np.nanmax(carried["contact_time_fraction"].astype(float))
        row[0].set_title(f"{number}, Pinkus–Sternlicht film: in contact {share:.3g} %")
        map_panel(drawing, row[1], touching, x, y, "contact_time_fraction", Normalize(60, 100), list(axes[:, 1]) if last else ())
        row[1].set_title(f"{number}, oscillating film{failed_note(touching)}")
        for axis in row:
            axis.set(xlabel=axis.get_xlabel() if last else "", ylabel=axis.get_ylabel() if axis is row[0] else "")
    drawing.suptitle(f"Left of the bold line the film is thicker than {THIN:g} µm; with an oscillating film the pin touches everywhere")
    return drawing


def failed_note(runs: Runs) -> str:
    """Part of a title about failed runs."""
    failed = int((~runs.done).sum())
    return f"; {failed} of {len(runs.table)} runs failed (×)" if failed else ""


def describe_maps(studies: dict[str, Runs]) -> list[str]:
    """The numbers of the maps."""
    lines = []
    for name, runs in studies.items():
        share = runs.table.loc[runs.done, "contact_time_fraction"].astype(float)
        film = 1e6 * runs.table.loc[runs.done, "min_film_thickness"].astype(float)
        least = ", ".join(f"above {level:g} µm in {100 * (film > level).mean():.0f} %" for level in (0.1, 0.3, 1.0))
        lines.append(
            f"{name}: {runs.done.sum()} of {len(runs.table)} runs done; in contact {100 * share.min():.3g} to"
            f" {100 * share.max():.3g} % of the time (median {100 * share.median():.3g} %);"
            f" smallest film thickness {film.min():.3g} to {film.max():.3g} µm, {least} of the runs"
        )
    return lines


def read_strobe(path: Path, runs: Runs) -> pd.DataFrame:
    """NAME.strobe.csv, with the parameters of its run at each point."""
    if not path.exists():
        raise MissingResult(f"no result {path}")
    strobe, units = read_table(path)
    parameters = runs.table.columns[1 : runs.table.columns.get_loc("status")]
    exponent = [EXPONENT] if EXPONENT in runs.table and runs.table[EXPONENT].notna().any() else []
    found = strobe.merge(runs.table[["run", *parameters, *exponent]], on="run", validate="many_to_one")
    found.attrs = units
    return found


def period(points: np.ndarray, tolerance: float) -> int:
    """Number of revolutions after which a sequence of points (rows) repeats within a tolerance; 0 if it does not within the longest
    period that is searched for, or if the sequence is shorter than two periods."""
    for length in range(1, min(LONGEST_PERIOD, len(points) // 2) + 1):
        if np.abs(points[length:] - points[:-length]).max() <= tolerance:
            return length
    return 0


def periods(strobe: pd.DataFrame, parameter: str) -> pd.Series:
    """The period of each run, by the value of its parameter."""
    found = {}
    for _, points in strobe.groupby("run", sort=True):
        found[points[parameter].iloc[0]] = period(points[["eccentricity_ratio_y"]].to_numpy(), SAME_POINT)
    return pd.Series(found).sort_index()


def with_ratios(strobe: pd.DataFrame, clearance: float | None, speed: float | None) -> pd.DataFrame:
    """The points divided by the clearance and by clearance times crank speed; a value that is not a parameter of the study is
    passed."""
    clearance = strobe["joint.clearance"] if clearance is None else clearance
    speed = strobe["initial.crank_speed"] if speed is None else speed
    return strobe.assign(
        eccentricity_ratio_y=strobe["eccentricity_y"] / clearance,
        velocity_ratio=strobe["piston_velocity"] / (clearance * speed),
    )


def strobe_panel(axis: Axes, strobe: pd.DataFrame, parameter: str, column: str, repeats: np.ndarray, label: str = "") -> None:
    """Points of a column once in a revolution over the parameter, coloured by the period of each run."""
    shown = of_parameter(parameter, strobe[parameter])
    for mask, colour, size, name in (
        (repeats == 0, BLACK, 0.5, f"does not repeat within {LONGEST_PERIOD} revolutions"),
        (repeats > 1, VERMILION, 3.0, f"repeats after 2 to {LONGEST_PERIOD} revolutions"),
        (repeats == 1, BLUE, 3.0, "repeats every revolution"),
    ):
        points = strobe[mask]
        axis.scatter(
            shown(points[parameter]), points[column], s=size, c=colour, linewidths=0, rasterized=True, label=name
        )
    scale_axis(axis, "x", shown(strobe[parameter]))
    axis.set_xlabel(shown.label)
    axis.set_ylabel(label)


#: Column of the largest Lyapunov exponent [1/revolution], and the largest magnitude that the colours show.
EXPONENT = "lyapunov_exponent"
EXPONENT_SHOWN = 1.0

#: Colours of exponents, the lighter the larger, so that chaos and periodic motion differ in grey too.
EXPONENTS = LinearSegmentedColormap.from_list("exponents", plt.get_cmap("plasma")(np.linspace(0, 0.8, 64)))

#: Columns of a strobe divided by the clearance, or by clearance times crank speed.
RATIOS = {
    "eccentricity_ratio_y": "eccentricity across the cylinder / c",
    "velocity_ratio": "piston velocity / (c · crank speed)",
}


def draw_bifurcation(strobes: dict[str, tuple[pd.DataFrame, str, str]], title: str) -> Drawing:
    """Strobed points over a parameter; for each study its points, its parameter, and a text about the values that are constant."""
    drawing, axes = plt.subplots(
        len(RATIOS), len(strobes), figsize=(WIDTH, 0.6 + 2.4 * len(RATIOS)), sharey="row", sharex="col", squeeze=False
    )
    coloured = None
    for (strobe, parameter, held), panels in zip(strobes.values(), axes.T):
        repeats = strobe[parameter].map(periods(strobe, parameter)).to_numpy()
        for axis, (column, label) in zip(panels, RATIOS.items()):
            label = label if axis in axes[:, 0] else ""
            coloured = panel_of_strobes(axis, strobe, parameter, column, repeats, label) or coloured
        panels[0].set_title(held)
        panels[0].set_xlabel("")
    explain_strobes(drawing, axes, coloured, all(EXPONENT in strobe for strobe, _, _ in strobes.values()))
    drawing.suptitle(title)
    return drawing


def panel_of_strobes(
    axis: Axes, strobe: pd.DataFrame, parameter: str, column: str, repeats: np.ndarray, label: str
) -> PathCollection | None:
    """Points of a column in the colours of the Lyapunov exponent, which are returned; without an exponent in the colours of the
    period."""
    if EXPONENT in strobe:
        return exponent_panel(axis, strobe, parameter, column, label)
    return strobe_panel(axis, strobe, parameter, column, repeats, label)


def explain_strobes(drawing: Drawing, axes: np.ndarray, coloured: PathCollection | None, all_coloured: bool) -> None:
    """Add the colour bar of the exponents and the legend of the periods."""
    if coloured is not None:
        label = of_column(EXPONENT, "1/revolution", [EXPONENT_SHOWN]).label
        bar = drawing.colorbar(coloured, ax=axes, location="bottom", aspect=50, pad=0.02, extend="both")
        bar.set_label(f"{label}: below 0 the motion repeats, above it is chaotic")
    if not all_coloured:
        add_legend(drawing, axes.flat, markerscale=3)


def exponent_panel(axis: Axes, strobe: pd.DataFrame, parameter: str, column: str, label: str) -> PathCollection:
    """Points of a column once in a revolution over the parameter, coloured by the largest Lyapunov exponent of their run: dark if
    neighbouring motions converge, light if they diverge."""
    shown = of_parameter(parameter, strobe[parameter])
    points = axis.scatter(
        shown(strobe[parameter]),
        strobe[column],
        s=np.where(strobe[EXPONENT] > 0, 0.15, 3.0),
        c=strobe[EXPONENT],
        cmap=EXPONENTS,
        norm=Normalize(-EXPONENT_SHOWN, EXPONENT_SHOWN),
        linewidths=0,
        antialiased=False,
        rasterized=True,
    )
    scale_axis(axis, "x", shown(strobe[parameter]))
    axis.set_xlabel(shown.label)
    axis.set_ylabel(label)
    return points


def draw_strobes(strobe: pd.DataFrame, parameter: str, title: str) -> Drawing:
    """The strobed columns of a study of one parameter. Points of a run count as one if all their columns agree within a share of
    the column's range in the whole study."""
    parameters = list(strobe.columns).index(parameter)
    columns = [name for name in strobe.columns[2:parameters]]
    scaled = strobe[columns] / (strobe[columns].max() - strobe[columns].min()).replace(0, 1)
    found = {run: period(scaled.loc[rows.index].to_numpy(), SAME_POINT) for run, rows in strobe.groupby("run")}
    repeats = strobe["run"].map(found).to_numpy()
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 0.7 + 2.2 * len(columns)), sharex=True, squeeze=False)
    coloured = None
    for axis, column in zip(axes[:, 0], columns):
        shown = of_column(column, strobe.attrs.get(column, ""), strobe[column])
        scaled = strobe.assign(**{column: shown(strobe[column])})
        coloured = panel_of_strobes(axis, scaled, parameter, column, repeats, shown.label)
    for axis in axes[:-1, 0]:
        axis.set_xlabel("")
    explain_strobes(drawing, axes, coloured, coloured is not None)
    drawing.suptitle(title)
    return drawing


def describe_bifurcation(strobe: pd.DataFrame, name: str, parameter: str, unit: float, label: str) -> str:
    """The number of runs that repeat after one revolution, after several, or not at all, and the parameter ranges where they
    lie."""
    found = periods(strobe, parameter)
    counts = found.value_counts()
    later = counts[[n for n in counts.index if n > 1]].sum()
    text = f"{name}: of {len(found)} values from {unit * found.index[0]:.4g} to {unit * found.index[-1]:.4g} {label} "
    text += f"{counts.get(1, 0)} repeat every revolution, {later} after 2 to {LONGEST_PERIOD}, {counts.get(0, 0)} do not"
    for what, values in (("repeat", found.index[found > 0]), ("do not", found.index[found == 0])):
        if len(values):
            text += f"; those that {what} lie from {unit * values[0]:.4g} to {unit * values[-1]:.4g}"
    return text


def restitution_of_law(nominal: float) -> float:
    """The ratio of speeds after and before an impact without other forces, by the law of Lankarani and Nikravesh: with
    F = K d^n (1 + q v/v0), q = 3 (1 - e^2)/4, the energy balance is q - ln(1 + q) = -q r - ln(1 - q r) for the ratio r."""
    q = 0.75 * (1.0 - nominal**2)
    if q == 0.0:
        return 1.0
    return brentq(lambda ratio: (-q * ratio - np.log1p(-q * ratio)) - (q - np.log1p(q)), 1e-9, min(1.0, 1 / q - 1e-9))


def impacts(path: Path, settled_from: float) -> tuple[np.ndarray, np.ndarray]:
    """Speeds at which the contacts in an events file begin and end, for contacts that begin after a crank angle."""
    events = events_of("piston_pin", read_table(path)[0])
    begins = events[events["event"] == "contact_begins"].reset_index(drop=True)
    ends = events[events["event"] == "contact_ends"].reset_index(drop=True)
    both = min(len(begins), len(ends))
    begins, ends = begins[:both], ends[:both]
    counted = (begins["crank_angle"] >= settled_from).to_numpy()
    return begins["normal_speed"].abs().to_numpy()[counted], ends["normal_speed"].abs().to_numpy()[counted]


def measured_restitution(directory: Path, runs: Runs, settled_from: float) -> pd.DataFrame:
    """For each run the median and quartiles of the ratio of speeds in the fast impacts, and the number of these impacts."""
    rows = []
    for run, nominal in zip(runs["run"], runs["contact.restitution"]):
        before, after = impacts(directory / f"{run}.events.csv", settled_from)
        hard = before > HARD_IMPACT * before.max(initial=0.0)
        low, middle, high = np.quantile(after[hard] / before[hard], (0.25, 0.5, 0.75)) if hard.any() else 3 * [np.nan]
        rows.append((nominal, low, middle, high, int(hard.sum())))
    return pd.DataFrame(rows, columns=["nominal", "low", "middle", "high", "count"])


def draw_restitution(runs: Runs, measured: pd.DataFrame) -> Drawing:
    """Results over the coefficient of restitution, and the measured restitution."""
    drawing, axes = plt.subplots(2, 2, figsize=(WIDTH, 4.8), sharex=True)
    nominal = runs["contact.restitution"]
    panels = (
        (axes[0][0], "contact_time_fraction", 100.0, "time in contact [%]"),
        (axes[0][1], "max_pin_force_mean", 1e-3, "peak pin force [kN]"),
        (axes[1][0], "dissipated_energy", 1.0, "dissipated in a revolution [J]"),
    )
    for axis, column, unit, label in panels:
        axis.plot(nominal, unit * np.where(runs.done, runs[column], np.nan), ".-", color=BLUE, label="mean over the revolutions")
        axis.set_ylabel(label)
    axes[0][1].plot(
        nominal, 1e-3 * np.where(runs.done, runs["max_pin_force"], np.nan), ".", color=GREY, label="largest of all revolutions"
    )
    axes[0][1].set_yscale("log")
    mark_decades(axes[0][1].yaxis)
    for axis in (axes[0][0], axes[1][0]):
        axis.set_ylim(bottom=0)
    axis = axes[1][1]
    axis.fill_between(measured["nominal"], measured["low"], measured["high"], color=BLUE, alpha=0.25, linewidth=0)
    axis.plot(measured["nominal"], measured["middle"], ".-", color=BLUE, label="hard impacts: median, middle half")
    line = np.linspace(0, 1, 101)
    axis.plot(line, [restitution_of_law(value) for value in line], color=VERMILION, label="the law, impact alone")
    axis.plot(line, line, color=GREEN, linestyle="--", label="as asked for")
    axis.set(ylabel="speed after / before", ylim=(0, 1.1))
    for axis in axes[1]:
        axis.set_xlabel("coefficient of restitution asked for")
    add_legend(drawing, axes.flat)
    drawing.suptitle(f"Asked for up to 0.75 a restitution changes little: the law gives no less than {restitution_of_law(0.0):.2f} (Flores, 5000 rpm, 0.5 mm, dry){failed_note(runs)}")
    return drawing


def describe_restitution(runs: Runs, measured: pd.DataFrame) -> str:
    """The numbers of the picture for a few coefficients."""
    lines = [f"restitution: {runs.done.sum()} of {len(runs.table)} runs done; asked for: time in contact, peak force, "]
    lines[0] += "dissipated in a revolution, speed after over before hard impacts (their number; the law alone)"
    for wanted in (0.0, 0.25, 0.5, 0.75, 0.9, 1.0):
        i = int(np.abs(runs["contact.restitution"] - wanted).argmin())
        row, found = runs.table.iloc[i], measured.iloc[i]
        lines.append(
            f"  {found['nominal']:.3g}: {100 * row['contact_time_fraction']:.3g} %,"
            f" {1e-3 * row['max_pin_force_mean']:.3g} kN, {row['dissipated_energy']:.3g} J,"
            f" {found['middle']:.3f} ({found['count']:.0f}; {restitution_of_law(found['nominal']):.3f})"
        )
    return "\n".join(lines)


def shown_columns(runs: Runs, columns: Sequence[str]) -> tuple[list[str], list[str]]:
    """The columns that differ between runs, and a text for the title about the others; if none differs, all columns."""
    varying = [column for column in columns if not is_constant(runs, column)] or list(columns)
    notes = []
    for column in columns:
        if column not in varying:
            values = runs.table.loc[runs.done, column].astype(float)
            shown = of_column(column, runs.units[column], values)
            value = f"{shown(values.iloc[0]):.4g} {shown.unit}".strip() if len(values) else "no value"
            notes.append(f"{shown.name}: {value} in every run")
    return varying, notes


def titled(drawing: Drawing, title: str, runs: Runs, notes: Sequence[str]) -> Drawing:
    drawing.suptitle("\n".join([f"{title}{failed_note(runs)}", *notes]))
    return drawing


def draw_curves(runs: Runs, parameter: str, columns: Sequence[str], title: str) -> Drawing:
    """Columns over the only parameter of a study, with crosses on the axis where runs failed."""
    columns, notes = shown_columns(runs, columns)
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 0.5 + 1.9 * len(columns)), sharex=True, squeeze=False)
    is_number = pd.api.types.is_numeric_dtype(runs.table[parameter])
    places = runs.table[parameter].to_numpy() if is_number else np.arange(len(runs.table))
    shown_x = of_parameter(parameter, places) if is_number else Shown(parameter.replace("_", " ").replace(".", " "))
    for axis, column in zip(axes[:, 0], columns):
        values = np.where(runs.done, runs[column], np.nan).astype(float)
        shown = of_column(column, runs.units[column], values)
        axis.plot(shown_x(places), shown(values), ".-" if is_number else "o", color=BLUE)
        axis.set_ylabel(shown.label)
        if spans_decades(shown(values)):
            axis.set_yscale("log")
            mark_decades(axis.yaxis)
        failed = ~runs.done
        if failed.any():
            axis.plot(
                shown_x(places[failed]), np.zeros(failed.sum()), "x", color=VERMILION, markersize=4, clip_on=False,
                transform=axis.get_xaxis_transform(), label="failed",
            )
    if is_number:
        scale_axis(axes[-1][0], "x", shown_x(places))
    else:
        axes[-1][0].set_xticks(places, [str(value) for value in runs.table[parameter]], rotation=30, ha="right")
    axes[-1][0].set_xlabel(shown_x.label)
    return titled(drawing, title, runs, notes)


def where_largest(runs: Runs, x: str, y: str, column: str) -> str:
    """The largest value of a column over two parameters, and where it is, for a title; nothing if no run has a value."""
    values = runs.table[column].where(runs.done).astype(float)
    if not values.notna().any():
        return ""
    row = runs.table.loc[values.idxmax()]
    shown = of_column(column, runs.units[column], np.array([row[column]], dtype=float))
    value, *place = (f"{one(row[key]):.3g} {one.unit}".strip() for key, one in ((column, shown), *((key, of_parameter(key, runs[key])) for key in (x, y))))
    return f": up to {value}, at {place[0]} and {place[1]}"


def draw_map(runs: Runs, x: str, y: str, columns: Sequence[str], title: str) -> Drawing:
    """Columns over the two parameters of a study."""
    columns, notes = shown_columns(runs, columns)
    across = min(len(columns), 2)
    rows = -(-len(columns) // across)
    drawing, axes = plt.subplots(rows, across, figsize=(WIDTH * (0.5 + 0.25 * across), 0.5 + 3.4 * rows), squeeze=False)
    for axis, column in zip(axes.flat, columns):
        map_panel(drawing, axis, runs, x, y, column)
    for axis in axes.flat[len(columns) :]:
        axis.remove()
    if len(columns) == 1:
        title += where_largest(runs, x, y, columns[0])
    return titled(drawing, title, runs, notes)


def draw_scatter(runs: Runs, parameters: Sequence[str], columns: Sequence[str], title: str) -> Drawing:
    """Columns over each parameter of a sample, or of a grid of more than two parameters."""
    columns, notes = shown_columns(runs, columns)
    height = 0.5 + 1.7 * len(columns)
    drawing, axes = plt.subplots(len(columns), len(parameters), figsize=(WIDTH, height), sharex="col", sharey="row", squeeze=False)
    for row, column in zip(axes, columns):
        values = np.where(runs.done, runs[column], np.nan).astype(float)
        shown = of_column(column, runs.units[column], values)
        for axis, parameter in zip(row, parameters):
            is_number = pd.api.types.is_numeric_dtype(runs.table[parameter])
            shown_x = of_parameter(parameter, runs[parameter]) if is_number else Shown(parameter.replace("_", " ").replace(".", " "))
            places = shown_x(runs[parameter]) if is_number else runs.table[parameter].astype(str)
            axis.plot(places, shown(values), ".", color=BLUE, markersize=2)
            if spans_decades(shown(values)):
                axis.set_yscale("log")
                mark_decades(axis.yaxis)
            axis.margins(x=0.06)
            if is_number:
                axis.xaxis.set_major_locator(MaxNLocator(3))
            else:
                axis.tick_params(axis="x", rotation=60)
            if axis in axes[-1]:
                axis.set_xlabel(shown_x.label.replace(" [", "\n["))
        row[0].set_ylabel(shown.label.replace(" [", "\n["))
    return titled(drawing, title, runs, notes)
