"""Pictures of any parameter study: curves over one parameter, points over each of several; the axes of all studies."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.names import Shown, of_column, of_parameter
from gudgeon.plots.style import BLUE, VERMILION, WIDTH, mark_decades
from gudgeon.study import Runs
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MaxNLocator

#: From this ratio of largest to smallest value on, a scale is logarithmic.
WIDE_RATIO = 30.0


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


def is_constant(runs: Runs, column: str) -> bool:
    values = runs.table.loc[runs.done, column].astype(float)
    return bool(values.nunique(dropna=True) <= 1)


def failed_note(runs: Runs) -> str:
    """Part of a title about failed runs."""
    failed = int((~runs.done).sum())
    return f"; {failed} of {len(runs.table)} runs failed (×)" if failed else ""


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
