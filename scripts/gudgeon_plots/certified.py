"""Reads how far a run is certified (`gudgeon --certify`), and shades the part of a plot beyond that time."""

from matplotlib.axes import Axes

from .results import Run
from .style import GREY


def certified_until(run: Run) -> float | None:
    """Time up to which the run is certified [s]; None if all of it is certified, or no certificate was requested."""
    text = run.summary.get("certified_until", ("", ""))[0]
    if not text:
        return None
    until = float(text)
    return until if until < run["time"][-1] * (1 - 1e-9) else None


def shade_uncertified(axis: Axes, run: Run, abscissa: object) -> None:
    """Shade the part of a run beyond its certified time; `abscissa` holds the horizontal value of each row, `axis` has its
    range."""
    until = certified_until(run)
    if until is None:
        return
    rows = int((run["time"] <= until).sum())
    begin = abscissa[max(rows - 1, 0)]
    axis.axvspan(begin, abscissa[-1], color=GREY, alpha=0.18, linewidth=0, zorder=0, gid="uncertified")
