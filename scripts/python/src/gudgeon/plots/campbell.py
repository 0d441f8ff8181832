"""Critical speeds of a crankshaft: the Campbell diagram with the vector sums of its modes, and their shapes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.plots.style import BLUE, GREEN, GREY, ORANGE, VERMILION, WIDTH
from gudgeon.results import numbered

if TYPE_CHECKING:
    from gudgeon.results import Run
    from matplotlib.figure import Figure as Drawing

COLOURS = (VERMILION, BLUE, GREEN)
LEAST = 0.1  # vector sums below this share of the largest have no mark


@dataclass
class Shaft:
    """Natural frequencies [Hz], shapes (mode, station) of the first of them, and for each cylinder its station (from 0) and the
    angle from the crank of the full cylinder to its own [rad]."""

    frequency: np.ndarray
    shape: np.ndarray
    station: np.ndarray
    angle: np.ndarray
    speed: float        # of the case [rpm]
    step: float         # between orders

    @classmethod
    def of(cls, run: Run) -> Shaft:
        """The shaft of a run, from its summary and its case."""
        def values(name: str) -> list[float]:
            found = []
            while (key := name.format(len(found) + 1)) in run.summary:
                found.append(float(run.summary[key][0]))
            return found

        modes = 1
        while f"mode_{modes + 1}_station_1" in run.summary:
            modes += 1
        groups = numbered(run.case, "cylinder") or [{}]
        full = next((i for i, group in enumerate(groups) if group.get("full")), 0)
        angle = np.array([group.get("phase_deg", 0.0) - group.get("bank_deg", 0.0) for group in groups])
        gas = run.case.get("cylinder_pressure") or run.case.get("combustion") or {}
        is_long = gas.get("period_deg", 360) == 720 or gas.get("cycle") == "four_stroke"
        return cls(np.array(values("natural_frequency_{}")), np.array([values(f"mode_{k}_station_{{}}") for k in range(1, modes + 1)]),
                   np.array([max(int(group.get("station", 1)), 1) - 1 for group in groups]), np.radians(angle - angle[full]),
                   abs(run.case["initial"]["crank_speed"]) * 30 / np.pi, 0.5 if is_long else 1.0)

    def vector_sum(self, mode: int, order: float) -> float:
        """|sum of the amplitudes at the cylinders, each turned by `order` times its angle|; modes from 0."""
        return float(abs(np.sum(self.shape[mode][self.station] * np.exp(1j * order * self.angle))))

    def critical_speeds(self, highest: float) -> pd.DataFrame:
        """All speeds at which an order up to `highest` excites a natural frequency whose shape is known."""
        rows = [(mode + 1, order, 60 * self.frequency[mode] / order, self.vector_sum(mode, order))
                for mode in range(len(self.shape)) for order in np.arange(self.step, highest + 1e-9, self.step)]
        return pd.DataFrame(rows, columns=["mode", "order", "speed[rpm]", "vector_sum[-]"])


def draw(name: str, shaft: Shaft, table: pd.DataFrame, highest: float, fastest: float | None) -> Drawing:
    """Left: frequencies over speed with the lines of the orders, marks as large as the vector sums. Right: shapes over the stations."""
    drawing, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.4), width_ratios=[1.6, 1])
    fastest = fastest or 2 * shaft.speed
    top = 1.15 * shaft.frequency[min(len(shaft.shape), 2) - 1]
    largest = table["vector_sum[-]"].max()
    for order in np.arange(shaft.step, highest + 1e-9, shaft.step):
        marks = table[(table["order"] == order) & (table["vector_sum[-]"] > LEAST * largest)]
        left.plot([0, fastest], [0, order * fastest / 60], color=GREY, linewidth=0.8 if len(marks) else 0.3)
        if len(marks) and order * fastest / 60 < top:
            left.annotate(f"{order:g}", (fastest, order * fastest / 60), textcoords="offset points", xytext=(2, -2), fontsize=6)
        elif len(marks):
            left.annotate(f"{order:g}", (60 * top / order, top), textcoords="offset points", xytext=(-2, 2), fontsize=6)
    for mode in range(len(shaft.shape)):
        colour = COLOURS[mode % len(COLOURS)]
        left.axhline(shaft.frequency[mode], color=colour)
        marks = table[(table["mode"] == mode + 1) & (table["vector_sum[-]"] > LEAST * largest)]
        left.scatter(marks["speed[rpm]"], np.full(len(marks), shaft.frequency[mode]), s=60 * marks["vector_sum[-]"] / largest, color=colour, zorder=3)
        right.plot(np.arange(1, shaft.shape.shape[1] + 1), shaft.shape[mode], "o-", markersize=3, color=colour, label=f"{shaft.frequency[mode]:.4g} Hz")
    left.axvline(shaft.speed, color=ORANGE, linestyle="--")
    left.set(xlim=(0, fastest), ylim=(0, top), xlabel="speed [rpm]", ylabel="frequency [Hz]")
    right.set(xlabel="station", ylabel="amplitude of the shape")
    right.axhline(0, color=GREY, linewidth=0.5)
    right.legend()
    drawing.suptitle(f"{name}: critical speeds")
    return drawing
