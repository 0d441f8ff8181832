"""The picture of the study of restitutions: what a restitution that is asked for changes, and what impacts have; and its numbers."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.plots.studies import failed_note
from gudgeon.plots.style import BLUE, GREEN, GREY, VERMILION, WIDTH, add_legend, mark_decades
from gudgeon.results import events_of, read_table
from gudgeon.study import Runs
from matplotlib.figure import Figure as Drawing
from scipy.optimize import brentq

#: Impacts count if they are faster than this share of the fastest in the run; slower ones are influenced by the load on the pin.
HARD_IMPACT = 0.5


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
