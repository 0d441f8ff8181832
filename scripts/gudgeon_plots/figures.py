"""Draws the figures of the table."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from .figure_map import Figure
from .quantities import QUANTITIES
from .quantity import Quantity, colour, label
from .results import MissingResult, Results, Run
from .style import GREY, WIDTH

WIDE_HEIGHT = 1.75  # of an axis with a curve over time [inch]
LEGEND_HEIGHT = 0.55  # of title and legend [inch]


@dataclass(frozen=True)
class Panel:
    """One axis of a figure: a run, several, or none where its result is missing.

    `kind` is "full", "detail" (the range around the ideal joint) or "difference" (the run less the ideal joint).
    """

    quantity: Quantity
    runs: tuple[Run, ...]
    ideal: Run | None = None
    kind: str = "full"
    missing: str = ""


def second_look(panel: Panel) -> Panel | None:
    """What a curve with the ideal joint's overlaid needs beside it: where the run's peaks would flatten the rest, the range
    around the ideal joint; else the difference, which the line width hides. None where neither helps."""
    quantity, ideal = panel.quantity, panel.ideal
    if panel.missing or ideal is None or quantity.values is None:
        return None
    if quantity.needs_detail(panel.runs[0], ideal):
        return replace(panel, kind="detail")
    return replace(panel, kind="difference") if quantity.wide else None


def arrange(figure: Figure, results: Results) -> list[list[Panel | None]]:
    """Rows of panels: runs side by side, a second look at each below; three runs over time go one below the other, the
    second look at their side. None is an empty place."""
    try:
        ideal = results[figure.ideal] if figure.ideal else None
    except MissingResult:
        ideal = None
    rows: list[list[Panel | None]] = []
    for name in figure.quantities:
        quantity = QUANTITIES[name]
        full = []
        for run_name in figure.runs:
            try:
                full.append(Panel(quantity, (results[run_name],), ideal))
            except MissingResult:
                full.append(Panel(quantity, (), missing=run_name))
        if quantity.draw_all is not None:
            present = tuple(run for panel in full for run in panel.runs)
            rows.append([Panel(quantity, present, missing="" if present else " ".join(figure.runs))])
            continue
        second = [second_look(panel) for panel in full]
        if not any(second):
            rows += [[panel] for panel in full] if quantity.wide and len(full) > 2 else [full]
        elif quantity.wide and len(full) > 2:
            rows += [list(pair) for pair in zip(full, second)]
        else:
            rows += [full, second]
    if all(len(row) == 1 and not row[0].quantity.wide for row in rows):
        rows = [[panel for row in rows for panel in row]]
    return rows


def draw_panel(axis: Axes, panel: Panel, named: bool) -> None:
    if panel.missing:
        axis.set_axis_off()
        axis.text(0.5, 0.5, f"no result of\n{panel.missing}", ha="center", va="center", color=GREY)
        return
    if panel.quantity.draw_all is not None:
        panel.quantity.draw_all(axis, list(panel.runs))
        return
    run = panel.runs[0]
    if panel.kind == "difference":
        panel.quantity.draw_difference(axis, run, panel.ideal, colour(run))
        return
    panel.quantity.draw(axis, run, panel.ideal, colour(run))
    if panel.kind == "detail":
        axis.set_ylim(panel.quantity.detail_range(panel.ideal))
        axis.set_title("detail, peaks cut off", color=GREY)
    elif named:
        note = panel.quantity.note
        axis.set_title(label(run) + (f", {note(run)}" if note else ""), color=colour(run))


def draw(figure: Figure, results: Results) -> Drawing:
    """The figure, ready to be saved. Raises MissingResult if none of its runs is there."""
    rows = arrange(figure, results)
    runs = [run for row in rows for panel in row if panel for run in panel.runs]
    if not runs:
        raise MissingResult(f"no result of {' '.join(figure.runs)}")
    columns = max(len(row) for row in rows)
    plane_height = min(WIDTH / columns, 2.75)
    heights = [WIDE_HEIGHT if any(p and p.quantity.wide for p in row) else plane_height for row in rows]
    drawing, axes = plt.subplots(
        len(rows), columns, figsize=(WIDTH, sum(heights) + LEGEND_HEIGHT), squeeze=False, height_ratios=heights
    )
    for row, row_axes in zip(rows, axes):
        for panel, axis in zip(row, row_axes):
            if panel is None:
                axis.set_axis_off()
            else:
                draw_panel(axis, panel, named=not all(p and p.quantity.draw_all for p in row))
        for axis in row_axes[len(row) :]:
            axis.set_axis_off()
        previous = None
        for panel, axis in zip(row, row_axes):
            if panel and panel.quantity is not previous:
                axis.set_ylabel(panel.quantity.label)
                previous = panel.quantity
    for column_axes in axes.T:  # curves over time: numbers below the lowest only
        for upper, lower in zip(column_axes, column_axes[1:]):
            if upper.get_xlabel() == lower.get_xlabel() and lower.get_xlabel().startswith(("time", "crank angle [")):
                upper.set_xlabel("")
                upper.tick_params(labelbottom=False)
    drawing.align_ylabels(axes[:, 0])
    add_legend(drawing, axes.flat)
    drawing.suptitle(f"{figure.number}  {figure.title}{span(runs[0]) if figure.has_windows else ''}", fontweight="bold")
    return drawing


def span(run: Run) -> str:
    """What a title says of the revolutions that a trace covers."""
    first, last = (run["crank_angle"][row] / (2 * np.pi) for row in (0, -1))
    return f", revolutions {first:.4g} to {last:.4g}"


def add_legend(drawing: Drawing, axes: Iterable[Axes]) -> None:
    """One legend for all axes, below them; each label once."""
    entries = {}
    for axis in axes:
        for handle, text in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(text, handle)
    if entries:
        drawing.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=4)


def save(drawing: Drawing, directory: Path, stem: str, formats: Iterable[str]) -> list[Path]:
    """Write a drawing in each format; dates are left out, so that equal results give equal files."""
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for form in formats:
        path = directory / f"{stem}.{form}"
        dateless = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(form)
        drawing.savefig(path, metadata=dateless)
        paths.append(path)
    plt.close(drawing)
    return paths
