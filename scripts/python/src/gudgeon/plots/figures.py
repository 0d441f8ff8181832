"""Draws the figures of the table."""

from dataclasses import dataclass, replace

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots.figure_map import Figure
from gudgeon.plots.quantities import QUANTITIES
from gudgeon.plots.quantity import Quantity, colour, label
from gudgeon.plots.style import GREY, WIDTH, add_legend
from gudgeon.results import MissingResult, Results, Run
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

WIDE_HEIGHT = 1.75  # height of an axis with a curve over time [inch]
SQUARE_WIDTH = 4.2  # width of a figure of one orbit, which leaves room for its title [inch]
LEGEND_HEIGHT = 0.55  # height of title and legend [inch]


@dataclass(frozen=True)
class Panel:
    """One axis of a figure: one run, several, or none if its result is missing.

    `kind` is "full", "detail" (the range around the ideal joint), "difference" (the run minus the ideal joint), "zoom" (some
    oscillations of a curve that rings) or "below" (a second view of the quantity). `rows` is its height in rows.
    """

    quantity: Quantity
    runs: tuple[Run, ...]
    ideal: Run | None = None
    kind: str = "full"
    missing: str = ""
    rows: int = 1


def second_look(panel: Panel) -> Panel | None:
    """The second panel that a curve drawn together with the ideal joint needs: a zoom if it oscillates faster than the picture can
    show; the range around the ideal joint if peaks of the run would flatten the rest; otherwise the difference, which the line
    width hides. None if no second panel helps."""
    quantity, ideal = panel.quantity, panel.ideal
    if panel.missing:
        return None
    if quantity.below is not None:
        return replace(panel, kind="below") if quantity.has_below(panel.runs[0]) else None
    if ideal is None or quantity.values is None:
        return None
    if quantity.rings(panel.runs[0]):
        return replace(panel, kind="zoom")
    if quantity.needs_detail(panel.runs[0], ideal):
        return replace(panel, kind="detail")
    return replace(panel, kind="difference")


def arrange(figure: Figure, results: Results, cycles: Results | None = None) -> list[list[Panel | None]]:
    """Rows of panels: runs side by side, the second panel of each below it; three runs over time are placed one below the other,
    with the second panels at their side. A panel without a second panel covers both rows; None stands for the place that it covers.
    `cycles` contains the runs over many cycles."""
    rows: list[list[Panel | None]] = []
    for name in figure.quantities:
        quantity = QUANTITIES[name]
        source = cycles if quantity.many_cycles and cycles is not None else results
        try:
            ideal = source[figure.ideal] if figure.ideal else None
        except MissingResult:
            ideal = None
        full = []
        for run_name in figure.runs:
            try:
                full.append(Panel(quantity, (source[run_name],), ideal))
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
            rows += [[panel if below else replace(panel, rows=2) for panel, below in zip(full, second)], second]
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
    elif panel.kind == "zoom":
        panel.quantity.draw_zoom(axis, run, panel.ideal, colour(run))
    elif panel.kind == "below":
        panel.quantity.below(axis, run, colour(run))
    else:
        panel.quantity.draw(axis, run, panel.ideal, colour(run))
    if panel.kind == "detail":
        axis.set_ylim(panel.quantity.detail_range(panel.ideal))
        axis.set_title("detail, peaks cut off", color=GREY)
    elif panel.kind == "full" and named and not panel.quantity.many_cycles:
        note = panel.quantity.note(run) if panel.quantity.note else ""
        axis.set_title(label(run) + (f", {note}" if note else ""), color=colour(run))


def panel_label(panel: Panel) -> str:
    """Label of its vertical axis."""
    if panel.kind == "below":
        return panel.quantity.below_label
    return ("Δ " if panel.kind == "difference" else "") + panel.quantity.label


def draw(figure: Figure, results: Results, cycles: Results | None = None) -> Drawing:
    """The figure, ready to be saved; `cycles` contains the runs over many cycles. Raises MissingResult if none of its runs
    exists."""
    rows = arrange(figure, results, cycles)
    runs = [run for row in rows for panel in row if panel for run in panel.runs]
    if not runs:
        raise MissingResult(f"no result of {' '.join(figure.runs)}")
    columns = max(len(row) for row in rows)
    plane_height = min(WIDTH / columns, 2.75)
    heights = [WIDE_HEIGHT if any(p and p.quantity.wide for p in row) else plane_height for row in rows]
    drawing = plt.figure(figsize=(WIDTH, sum(heights) + LEGEND_HEIGHT))
    grid = drawing.add_gridspec(len(rows), columns, height_ratios=heights)
    lowest: dict[int, tuple[Axes, int]] = {}
    for place, row in enumerate(rows):
        previous = ""
        for column, panel in enumerate(row):
            if panel is None:
                continue
            axis = drawing.add_subplot(grid[place : place + panel.rows, column])
            draw_panel(axis, panel, named=not all(p and p.quantity.draw_all for p in row))
            if panel_label(panel) != previous:
                axis.set_ylabel(panel_label(panel))
                previous = panel_label(panel)
            if column in lowest and panel.quantity.wide and lowest[column][0].get_xlim() == axis.get_xlim():
                lowest[column][0].set_xlabel("")  # curves over the same time: labels below the lowest only
                lowest[column][0].tick_params(labelbottom=False)
            lowest[column] = (axis, place)
    if len(drawing.axes) == 1 and drawing.axes[0].get_aspect() == 1:
        drawing.set_figwidth(SQUARE_WIDTH)
    drawing.align_ylabels()
    add_legend(drawing, drawing.axes)
    drawing.suptitle(
        f"{figure.number}  {figure.title}{span(runs[0]) if figure.has_windows else ''}", fontweight="bold", x=0.01, horizontalalignment="left"
    )
    return drawing


def span(run: Run) -> str:
    """The revolutions that a trace covers, as part of a title."""
    first, last = (run["crank_angle"][row] / (2 * np.pi) for row in (0, -1))
    return f", revolutions {first:.4g} to {last:.4g}"
