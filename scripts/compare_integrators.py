#!/usr/bin/env python3
"""Table and picture from the rows that scripts/compare_integrators.sh collects.

    compare_integrators.py integrators.csv     prints the table, writes integrators.png and integrators.svg beside it
"""
from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

COLOURS = {"adams": "#0072B2", "radau": "#D55E00", "auto": "#000000"}   # Okabe-Ito
MARKERS = {"adams": "o", "radau": "s", "auto": "x"}
TARGET = 1e-6


def cheapest(rows: pd.DataFrame, target: float) -> pd.Series | None:
    """The run of fewest evaluations whose error is at most the target."""
    good = rows[(rows["error"] <= target) & (rows["status"] == 0)]
    return None if good.empty else good.loc[good["evaluations"].idxmin()]


def print_table(data: pd.DataFrame) -> None:
    """Every row, then for each scene what each method needs for the target error."""
    print(data.to_string(index=False))
    print(f"\ncheapest run with an error of at most {TARGET:g}:")
    print(f"{'scene':24s} {'method':6s} {'tolerance':>9s} {'evaluations':>11s} {'ms':>9s} {'error':>9s} {'auto faster by':>14s}")
    for scene, of_scene in data.groupby("scene", sort=False):
        best = {m: cheapest(rows, TARGET) for m, rows in of_scene.groupby("method", sort=False)}
        for method, row in best.items():
            if row is None:
                print(f"{scene:24s} {method:6s} not reached")
                continue
            gain = ""
            if method != "auto" and best.get("auto") is not None:
                gain = f"{row['seconds'] / best['auto']['seconds']:.2f}"
            print(f"{scene:24s} {method:6s} {row['tolerance']:9.0e} {row['evaluations']:11d} {1e3 * row['seconds']:9.3f}"
                  f" {row['error']:9.1e} {gain:>14s}")


def draw(data: pd.DataFrame, path: Path) -> None:
    """Error against evaluations (above) and wall time (below), a column a scene."""
    scenes = list(data["scene"].unique())
    rows = (len(scenes) + 4) // 5
    columns = (len(scenes) + rows - 1) // rows
    figure, axes = plt.subplots(2 * rows, columns, figsize=(3.1 * columns, 5.2 * rows), layout="constrained", squeeze=False)
    for axis in axes.flat:
        axis.set_visible(False)
    for i, scene in enumerate(scenes):
        for k, (quantity, label) in enumerate((("evaluations", "evaluations"), ("milliseconds", "wall time (ms)"))):
            axis = axes[2 * (i // columns) + k][i % columns]
            axis.set_visible(True)
            for method, of_method in data[data["scene"] == scene].groupby("method", sort=False):
                done = of_method[(of_method["status"] == 0) & (of_method["error"] < 0.5)]
                axis.loglog(done[quantity], done["error"].clip(lower=1e-14), color=COLOURS[method], marker=MARKERS[method],
                            markersize=4, linewidth=1, label=method)
            low, high = axis.get_xlim()
            axis.xaxis.set_minor_formatter(NullFormatter())
            if high < 30 * low:   # hardly a decade: name what lies between
                axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
                axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_xlabel(label)
            axis.set_ylabel("error")
            axis.grid(True, which="major", linewidth=0.4, alpha=0.5)
            if k == 0:
                axis.set_title(scene, fontsize=10)
            if i == 0 and k == 0:
                axis.legend(fontsize=8)
    for suffix in (".png", ".svg"):
        figure.savefig(path.with_suffix(suffix), dpi=130)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    path = Path(sys.argv[1])
    data = pd.read_csv(path)
    data["milliseconds"] = 1e3 * data["seconds"]
    print_table(data.drop(columns="milliseconds"))
    draw(data, path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
