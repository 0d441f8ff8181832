"""Draws the figures of the table."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from .figure_map import Figure
from .quantities import QUANTITIES, Quantity
from .results import MissingResult, Results, Run
from .style import BLUE, GREY, VERMILION, WIDTH

WIDE_HEIGHT = 1.75  # of an axis with a curve over time [inch]
LEGEND_HEIGHT = 0.55  # of title and legend [inch]


@dataclass(frozen=True)
class Panel:
    """One axis of a figure: a run, several, or none where its result is missing."""

    quantity: Quantity
    runs: tuple[Run, ...]
    ideal: Run | None = None
    detail: bool = False
    missing: str = ""


def label(run: Run) -> str:
    """What tells a run from the others of its figure."""
    law = run.parameter("lubrication", "law")
    if law == "pinkus_sternlicht" and run.parameter("drive", "kind") != "constant_speed":
        return "Pinkus–Sternlicht film"
    if law == "oscillating_film":
        return "oscillating film"
    clearance = f"c = {1e3 * run.clearance:.3g} mm"
    if law:
        return f"oil of {float(run.parameter('lubrication', 'viscosity')):.3g} Pa s, {clearance}"
    if "friction" in run.case:
        return f"friction {float(run.parameter('friction', 'coefficient')):.3g}, {clearance}"
    return clearance


def colour(run: Run) -> str:
    return VERMILION if run.parameter("lubrication", "law") == "oscillating_film" else BLUE


def arrange(figure: Figure, results: Results) -> list[list[Panel]]:
    """Rows of panels: runs side by side, a detail below where peaks would flatten the rest; three runs over time go one
    below the other, the detail at their side."""
    try:
        ideal = results[figure.ideal] if figure.ideal else None
    except MissingResult:
        ideal = None
    rows: list[list[Panel]] = []
    for name in figure.quantities:
        quantity = QUANTITIES[name]
        full, detail, present = [], [], []
        for run_name in figure.runs:
            try:
                run = results[run_name]
            except MissingResult:
                full.append(Panel(quantity, (), missing=run_name))
                continue
            present.append(run)
            full.append(Panel(quantity, (run,), ideal))
            if quantity.needs_detail(run, ideal):
                detail.append(Panel(quantity, (run,), ideal, detail=True))
        if quantity.draw_all is not None:
            rows.append([Panel(quantity, tuple(present))])
            continue
        if detail:
            detail = [Panel(p.quantity, p.runs, p.ideal, True, p.missing) for p in full]
        if quantity.wide and len(full) > 2:
            rows += [list(pair) for pair in zip(full, detail)] if detail else [[panel] for panel in full]
        else:
            rows += [full, detail] if detail else [full]
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
    panel.quantity.draw(axis, run, panel.ideal, colour(run))
    if panel.detail:
        axis.set_ylim(panel.quantity.detail_range(panel.ideal))
        cut = panel.quantity.is_cut(run, panel.ideal)
        axis.set_title("detail, peaks cut off" if cut else "in the detail's range", color=GREY)
    elif named:
        note = panel.quantity.note
        axis.set_title(label(run) + (f", {note(run)}" if note else ""), color=colour(run))


def draw(figure: Figure, results: Results) -> Drawing:
    """The figure, ready to be saved. Raises MissingResult if none of its runs is there."""
    rows = arrange(figure, results)
    if all(panel.missing for row in rows for panel in row):
        raise MissingResult(f"no result of {' '.join(figure.runs)}")
    columns = max(len(row) for row in rows)
    plane_height = min(WIDTH / columns, 2.75)
    heights = [WIDE_HEIGHT if row[0].quantity.wide else plane_height for row in rows]
    drawing, axes = plt.subplots(
        len(rows), columns, figsize=(WIDTH, sum(heights) + LEGEND_HEIGHT), squeeze=False, height_ratios=heights
    )
    for row, row_axes in zip(rows, axes):
        for panel, axis in zip(row, row_axes):
            draw_panel(axis, panel, named=not all(p.quantity.draw_all for p in row))
        for axis in row_axes[len(row) :]:
            axis.set_axis_off()
        previous = None
        for panel, axis in zip(row, row_axes):
            if panel.quantity is not previous:
                axis.set_ylabel(panel.quantity.label)
            previous = panel.quantity
    for column_axes in axes.T:  # curves over time: numbers below the lowest only
        for upper, lower in zip(column_axes, column_axes[1:]):
            if upper.get_xlabel() == lower.get_xlabel() and lower.get_xlabel().startswith(("time", "crank angle [")):
                upper.set_xlabel("")
                upper.tick_params(labelbottom=False)
    drawing.align_ylabels(axes[:, 0])
    add_legend(drawing, axes.flat)
    drawing.suptitle(f"{figure.number}  {figure.title}", fontweight="bold")
    return drawing


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
