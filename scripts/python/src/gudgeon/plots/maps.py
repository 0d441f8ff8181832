"""Maps of parameter studies over two parameters, and their numbers."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.names import Shown, of_column, of_parameter
from gudgeon.plots.studies import failed_note, mark_failed, scale_axis, shown_columns, spans_decades, titled
from gudgeon.plots.style import BLACK, WIDTH, mark_decades
from gudgeon.study import Runs
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure as Drawing

#: A map of at most so many cells is drawn as a table.
MOST_CELLS = 49

#: Film thickness [µm] that is three times a usual roughness.
THIN = 1.0

#: The colours of a map cover these percentiles of its values if the percentiles cover less than this share of the whole range.
OUTER_PERCENTILES, KEPT_RANGE = (1, 99), 0.75


def is_grid(runs: Runs, x: str, y: str) -> bool:
    """Whether runs are numbers on a grid of two parameters, one at each of its points."""
    table = runs.table
    if not all(pd.api.types.is_numeric_dtype(table[name]) for name in (x, y)) or table.duplicated([x, y]).any():
        return False
    return table[x].nunique() * table[y].nunique() == len(table)


def grid(runs: Runs, x: str, y: str, column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A column over two parameters: values of x, of y, and of the column (y down, x across), NaN where a run failed."""
    table = runs.table.assign(**{column: np.where(runs.done, runs.table[column], np.nan).astype(float)})
    found = table.pivot(index=y, columns=x, values=column)
    return found.columns.to_numpy(dtype=float), found.index.to_numpy(dtype=float), found.to_numpy(dtype=float)


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


def where_largest(runs: Runs, x: str, y: str, column: str) -> str:
    """The largest value of a column over two parameters, and where it is, for a title; nothing if no run has a value."""
    values = runs.table[column].where(runs.done).astype(float)
    if not values.notna().any():
        return ""
    row = runs.table.loc[values.idxmax()]
    shown = of_column(column, runs.units[column], np.array([row[column]], dtype=float))
    value, *place = (f"{one(row[key]):.3g} {one.unit}".strip() for key, one in ((column, shown), *((key, of_parameter(key, runs[key])) for key in (x, y))))
    return f": up to {value}, at {place[0]} and {place[1]}"


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
