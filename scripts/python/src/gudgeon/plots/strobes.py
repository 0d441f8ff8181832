"""Points of a study once in a revolution: bifurcation diagrams, and their numbers."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.names import of_column, of_parameter
from gudgeon.plots.studies import scale_axis
from gudgeon.plots.style import BLACK, BLUE, VERMILION, WIDTH, add_legend
from gudgeon.results import MissingResult, read_table
from gudgeon.study import Runs
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure as Drawing

#: Strobed points that differ by less than this share of the clearance count as one point.
SAME_POINT = 2e-3

#: Longest period that is searched for [revolutions].
LONGEST_PERIOD = 8

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


def panel_of_strobes(
    axis: Axes, strobe: pd.DataFrame, parameter: str, column: str, repeats: np.ndarray, label: str
) -> PathCollection | None:
    """Points of a column once in a revolution over the parameter, in the colours of the largest Lyapunov exponent of their run: dark if
    neighbouring motions converge, light if they diverge; these points are returned. Without an exponent in the colours of the period."""
    shown, coloured = of_parameter(parameter, strobe[parameter]), None
    if EXPONENT in strobe:
        coloured = axis.scatter(
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
    else:
        for mask, colour, size, name in (
            (repeats == 0, BLACK, 0.5, f"does not repeat within {LONGEST_PERIOD} revolutions"),
            (repeats > 1, VERMILION, 3.0, f"repeats after 2 to {LONGEST_PERIOD} revolutions"),
            (repeats == 1, BLUE, 3.0, "repeats every revolution"),
        ):
            points = strobe[mask]
            axis.scatter(shown(points[parameter]), points[column], s=size, c=colour, linewidths=0, rasterized=True, label=name)
    scale_axis(axis, "x", shown(strobe[parameter]))
    axis.set_xlabel(shown.label)
    axis.set_ylabel(label)
    return coloured


def explain_strobes(drawing: Drawing, axes: np.ndarray, coloured: PathCollection | None, all_coloured: bool) -> None:
    """Add the colour bar of the exponents and the legend of the periods."""
    if coloured is not None:
        label = of_column(EXPONENT, "1/revolution", [EXPONENT_SHOWN]).label
        bar = drawing.colorbar(coloured, ax=axes, location="bottom", aspect=50, pad=0.02, extend="both")
        bar.set_label(f"{label}: below 0 the motion repeats, above it is chaotic")
    if not all_coloured:
        add_legend(drawing, axes.flat, markerscale=3)


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
