"""Compares two traces: overlay, difference, and the horizon up to which they agree.

Runs A and B agree in a column at a time if their difference is at most a given share (the agreement) of the column's range in
A over the time that both runs cover; for a column that is constant in A, a share of its absolute value. B is interpolated linearly
to the times of A. The horizon of a column is the last time up to which it agrees without interruption; the horizon of the runs is
the earliest horizon of their columns.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.names import shown_unit
from gudgeon.plots import style
from gudgeon.plots.style import BLACK, BLUE, GREY, VERMILION, WIDTH
from gudgeon.results import MissingResult, Run
from matplotlib.figure import Figure as Drawing

#: Two runs agree while they differ by less than this share of the range.
AGREEMENT = 0.01

#: Columns that are compared if both runs have them. They are states: forces and accelerations jump, and a jump one sample later
#: would look like another motion.
COLUMNS = ("crank_speed", "rod_speed", "piston_velocity", "film_thickness")


@dataclass(frozen=True)
class Agreement:
    """One column of two runs over the time that both cover."""

    column: str
    time: np.ndarray
    a: np.ndarray
    b: np.ndarray
    scale: float
    horizon: float
    whole: bool  # whether the column agrees to the end

    @property
    def difference(self) -> np.ndarray:
        return self.b - self.a


def horizon(time: np.ndarray, difference: np.ndarray, tolerance: float) -> tuple[float, bool]:
    """Last time up to which |difference| <= tolerance without a break, and whether that is the end.

    Where the first time already differs, the horizon is that time.
    """
    apart = np.flatnonzero(~(np.abs(difference) <= tolerance))
    if apart.size == 0:
        return float(time[-1]), True
    return float(time[max(apart[0] - 1, 0)]), False


def scale_of(values: np.ndarray) -> float:
    """Range of the values, or their absolute value if they are constant."""
    spread = float(np.ptp(values))
    size = float(np.abs(values).max())
    return spread if spread > 1e-12 * size else size


def agree(a: Run, b: Run, columns: Iterable[str], agreement: float) -> list[Agreement]:
    """Compare columns of two runs. Raises MissingResult if they share no time or lack a column."""
    begin, end = max(a["time"][0], b["time"][0]), min(a["time"][-1], b["time"][-1])
    inside = (a["time"] >= begin) & (a["time"] <= end)
    if inside.sum() < 2:
        raise MissingResult(f"{a.name} and {b.name} have no time in common")
    time = a["time"][inside]
    found = []
    for column in columns:
        if column not in a or column not in b:
            raise MissingResult(f"{column}: not a column of both {a.name} and {b.name}")
        left, right = a[column][inside], np.interp(time, b["time"], b[column])
        scale = scale_of(left)
        found.append(Agreement(column, time, left, right, scale, *horizon(time, right - left, agreement * scale)))
    return found


def draw(a: Run, b: Run, names: tuple[str, str], found: list[Agreement], agreement: float) -> Drawing:
    """Overlay and difference of each column, the horizon marked."""
    limit = min(item.horizon for item in found)
    drawing, axes = plt.subplots(
        2 * len(found),
        1,
        figsize=(WIDTH, 0.6 + 2.2 * len(found)),
        sharex=True,
        squeeze=False,
        height_ratios=[3, 2] * len(found),
    )
    for item, above, below in zip(found, axes[::2, 0], axes[1::2, 0]):
        unit, factor = shown_unit(item.column, a.units[item.column], np.concatenate([item.a, item.b]))
        above.plot(1e3 * item.time, factor * item.a, color=BLUE, label=f"A: {names[0]}")
        above.plot(1e3 * item.time, factor * item.b, color=VERMILION, linestyle=(0, (4, 1.5)), label=f"B: {names[1]}")
        above.set_ylabel(f"{item.column.replace('_', ' ')}\n[{unit}]")
        below.plot(1e3 * item.time, factor * item.difference, color=BLACK, linewidth=0.6)
        below.axhspan(
            -agreement * factor * item.scale,
            agreement * factor * item.scale,
            color=GREY,
            alpha=0.25,
            linewidth=0,
            label=f"agreement: ±{100 * agreement:g} % of the range",
        )
        below.set_ylabel("B − A")
        for axis in (above, below):
            axis.axvline(1e3 * limit, color=GREY, linewidth=1, linestyle=":", label=f"horizon: {1e3 * limit:.4g} ms")
    axes[-1, 0].set_xlabel("time [ms]")
    axes[-1, 0].set_xlim(1e3 * found[0].time[0], 1e3 * found[0].time[-1])
    until = "to the end" if all(item.whole for item in found) else f"up to {1e3 * limit:.4g} ms"
    drawing.suptitle(f"{names[0]} and {names[1]} agree {until}")
    drawing.align_ylabels()
    style.add_legend(drawing, axes.flat)
    return drawing


def report(found: list[Agreement], agreement: float) -> str:
    """The text to print, in the language of the pictures: largest difference and horizon of each column, then the horizon of the runs."""
    say = language.current.say
    lines = [
        say(f"compared from {found[0].time[0]:.6g} s to {found[0].time[-1]:.6g} s; agreement: within {agreement:g} of a column's range in A")
    ]
    for item in found:
        largest = np.abs(item.difference).max() / item.scale if item.scale else np.abs(item.difference).max()
        until = say("agrees to the end" if item.whole else f"agrees up to {item.horizon:.6g} s")
        lines.append(f"{item.column:24} {until:27} " + say(f"largest difference {largest:.2e} of its range"))
    first = min(found, key=lambda item: (item.whole, item.horizon))
    lines.append(say(f"horizon: {first.horizon:.6g} s, the end" if first.whole else f"horizon: {first.horizon:.6g} s, set by {language.current.keep(first.column)}"))
    return "\n".join(lines)


def shared_columns(a: Run, b: Run) -> list[str]:
    """Columns compared by default: those that both traces have and that vary in one of them. Raises MissingResult if there is none."""
    found = [column for column in COLUMNS if column in a and column in b and (np.ptp(a[column]) > 0 or np.ptp(b[column]) > 0)]
    if not found:
        raise MissingResult(f"{a.name} and {b.name} share no column that varies, of {' '.join(COLUMNS)}; choose --columns")
    return found


def different_names(a: Path, b: Path) -> tuple[str, str]:
    """The names of two files, with as many folders as are needed to distinguish them."""
    left, right = a.resolve().parts, b.resolve().parts
    for count in range(1, max(len(left), len(right)) + 1):
        if left[-count:] != right[-count:]:
            break
    return "/".join(left[-count:]), "/".join(right[-count:])
