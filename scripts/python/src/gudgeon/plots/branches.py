"""Branches of periodic orbits over a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gudgeon.names import COLUMNS, KEYS, plain_unit, prefixed, shown_unit
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION

if TYPE_CHECKING:
    import pandas as pd
    from gudgeon._orbit import Branch

#: Special points: how they are named and coloured.
KINDS = {
    "fold": ("fold", ORANGE), "flip": ("flip, the period doubles", VERMILION), "neimark_sacker": ("Neimark-Sacker", GREEN), "grazing": ("grazing", PURPLE),
    "lift_off": ("lift-off", BLACK), "edge": ("edge", BLACK), "end": ("end", BLACK),
}  # fmt: skip


def draw_branch(branch: Branch, column: str, over: pd.DataFrame | None, axes: Any) -> Any:
    """A column of a branch over its parameter; see `Branch.plot`. An orbit of several revolutions has a line for each of them."""
    table = branch.points
    if column not in table:
        raise KeyError(f"no column {column}; there are: {', '.join(table.columns)}")
    unit_x, along = shown_unit(branch.key, branch.units[branch.key], table[branch.key].to_numpy())
    unit_y, up = prefixed(branch.units.get(column, ""), table[column].to_numpy())
    named = set(axes.get_legend_handles_labels()[1])

    def once(label: str) -> str | None:
        """A label that the legend does not have yet."""
        new = label not in named
        named.add(label)
        return label if new else None

    if over is not None:
        axes.scatter(along * over[branch.key], up * over[column], s=1, c=GREY, linewidths=0, rasterized=True, zorder=1, label=once("Poincaré sections"))
    x, special, stable = along * table[branch.key].to_numpy(), (table["kind"] != "").to_numpy(), table["stable"].to_numpy()
    # a special point is on the border: its neighbour says how a piece of the line is drawn
    pieces = np.where(special[:-1], stable[1:], np.where(special[1:], stable[:-1], stable[:-1] & stable[1:]))
    for values in branch.lines(column):
        y = up * values
        for sort, style, label in ((True, "-", "stable"), (False, "--", "unstable")):
            ends = np.array([(i, i + 1) for i in np.flatnonzero(pieces == sort)], int).reshape(-1, 2)
            runs = np.split(ends, np.flatnonzero(np.diff(ends[:, 0]) > 1) + 1) if len(ends) else []
            for run in runs:
                chosen = [*run[:, 0], run[-1, 1]]
                axes.plot(x[chosen], y[chosen], style, color=BLUE, label=once(label))
        for kind, (label, colour) in KINDS.items():
            its = (table["kind"] == kind).to_numpy()
            if its.any():
                axes.plot(x[its], y[its], "o", color=colour, markerfacecolor="none", markersize=4, zorder=3, label=once(label))
    axes.set_xlabel(_label(KEYS.get(branch.key) or branch.key.rpartition(".")[2], unit_x))
    axes.set_ylabel(_label(COLUMNS.get(column) or column, unit_y))
    return axes


def _label(name: str, unit: str) -> str:
    unit = plain_unit(unit)
    return name.replace("_", " ") + (f" [{unit}]" if unit else "")
