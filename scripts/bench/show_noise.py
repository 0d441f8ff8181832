#!/usr/bin/env python3
"""Shows the cause of the noise that the dissertation reports with the Pinkus-Sternlicht film (6.2.2, 6.2.3, 6.3): the integration
error.

    scripts/bench/show_noise.py                 simulations I to V: data/measured/noise.md, results/figures/noise.png

The dissertation integrates the coordinates (q, A, x) of the bodies with a relative and absolute error of 1e-6 and steps of at most
1e-7 s (table 6.3). An error of 1e-6 m of the piston's position is larger than the smallest film thickness. Here each simulation is
integrated in the same way, with the program's right-hand side, then with an error of 1e-8, and finally in the program's own
coordinates, in which the eccentricity is a state, with 1e-9. The integration error is the difference of the crank acceleration from
that of the last run.
"""

import argparse
import io
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from measured import TOP, built_program, use_virtual_environment, write_table

use_virtual_environment()

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon import language
from gudgeon.plots import style
from gudgeon.plots.style import BLACK, BLUE, GREY, VERMILION, WIDTH, mark_decades
from gudgeon.results import COLUMN, MissingResult, read_table

SIMULATIONS = ("I", "II", "III", "IV", "V")
#: Revolutions of a run: two; with combustion one cycle and the beginning of the next.
REVOLUTIONS = {"I": 2, "II": 2, "III": 2, "IV": 3, "V": 3}
SAMPLES = 720
MAX_STEP = 1e-7  # s
PRINTED, TIGHT = 1e-6, 1e-8
#: A difference larger than this share of the largest acceleration counts as noise.
NOISE = 0.02
#: This share of the run is not counted: the pin is released in the centre and falls onto its film.
START = 0.02


@dataclass(frozen=True)
class Noise:
    """One simulation: times [s], crank acceleration [rad/s2] and eccentricity ratio of the reference, and by tolerance the
    differences of the other runs from it, divided by the largest acceleration."""

    simulation: str
    time: np.ndarray
    acceleration: np.ndarray
    ratio: np.ndarray
    difference: dict[float, np.ndarray]

    @property
    def counted(self) -> np.ndarray:
        return self.time >= START * self.time[-1]

    def largest(self, tolerance: float) -> float:
        return float(np.nanmax(np.abs(self.difference[tolerance][self.counted])))

    def noisy(self, tolerance: float) -> np.ndarray:
        return self.counted & (np.abs(self.difference[tolerance]) > NOISE)

    def eccentricities(self, tolerance: float) -> tuple[float, float]:
        """Median of the eccentricity ratio in the rows with noise, and in those without."""
        noisy = self.noisy(tolerance)
        quiet = self.counted & ~noisy
        return (float(np.median(self.ratio[noisy])) if noisy.any() else np.nan, float(np.median(self.ratio[quiet])))


def in_absolute_coordinates(program: Path, simulation: str, tolerance: float) -> pd.DataFrame:
    """Rows of a simulation integrated in (q, A, x); fewer rows than asked for if the pin comes into contact."""
    case = TOP / "cases" / f"sim_{simulation}.nml"
    words = [program, case, REVOLUTIONS[simulation], SAMPLES, tolerance, MAX_STEP]
    outcome = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if outcome.returncode not in (0, 1):
        raise MissingResult(f"absolute_run {case}: {outcome.stderr.strip()}")
    table = pd.read_csv(io.StringIO(outcome.stdout))
    return table.rename(columns=lambda name: COLUMN.match(name)["name"])


def in_own_coordinates(program: Path, simulation: str, out: Path) -> pd.DataFrame:
    """The same rows from a run of the program in its own coordinates."""
    settings = (
        f"integrator.revolutions={REVOLUTIONS[simulation]}",
        "integrator.method=auto",
        "integrator.relative_tolerance=1e-9",
        f"output.samples_per_revolution={SAMPLES}",
        "output.columns=time,crank_acceleration,eccentricity_ratio",
        "output.ideal_twin=false",
    )
    words = [program, "-q", "-o", out, *(word for value in settings for word in ("-s", value)), TOP / "cases" / f"sim_{simulation}.nml"]
    outcome = subprocess.run(words, capture_output=True, text=True, check=False)
    if outcome.returncode != 0:
        raise MissingResult(outcome.stderr.strip())
    return read_table(out / f"sim_{simulation}.csv")[0]


def measure(simulation: str, absolute: Path, own: Path, out: Path) -> Noise:
    reference = in_own_coordinates(own, simulation, out)
    scale = float(np.abs(reference["crank_acceleration"]).max())
    difference = {}
    for tolerance in (PRINTED, TIGHT):
        found = in_absolute_coordinates(absolute, simulation, tolerance)
        rows = np.searchsorted(reference["time"], found["time"] * (1 - 1e-9))
        away = np.full(len(reference), np.nan)
        away[rows] = (found["crank_acceleration"].to_numpy() - reference["crank_acceleration"].to_numpy()[rows]) / scale
        difference[tolerance] = away
    columns = (reference[name].to_numpy() for name in ("time", "crank_acceleration", "eccentricity_ratio"))
    return Noise(simulation, *columns, difference)


def table(found: list[Noise]) -> list[str]:
    lines = [
        "| simulation | largest difference with 1e-6 | rows off by more than 2 % | median eccentricity / c there, elsewhere "
        "| largest difference with 1e-8 |",
        "|---|---|---|---|---|",
    ]
    for noise in found:
        there, elsewhere = noise.eccentricities(PRINTED)
        share = 100 * noise.noisy(PRINTED).sum() / noise.counted.sum()
        where = "-" if np.isnan(there) else f"{there:.4f}"
        lines.append(
            f"| {noise.simulation} | {100 * noise.largest(PRINTED):.2g} % | {share:.1f} % | {where}, {elsewhere:.3f} "
            f"| {100 * noise.largest(TIGHT):.2g} % |"
        )
    return lines


def draw(found: list[Noise]) -> plt.Figure:
    """One row for each simulation: the acceleration as the dissertation integrates it, and its error over the film thickness."""
    drawing, axes = plt.subplots(len(found), 2, figsize=(WIDTH, 0.6 + 1.45 * len(found)), width_ratios=[3, 2], squeeze=False)
    for (left, right), noise in zip(axes, found):
        scale = 1e-3 * np.abs(noise.acceleration).max()
        left.plot(1e3 * noise.time, 1e-3 * noise.acceleration + scale * noise.difference[PRINTED], color=VERMILION, linewidth=0.7,
                  label="(q, A, x), error 1e-6")
        left.plot(1e3 * noise.time, 1e-3 * noise.acceleration, color=BLACK, linewidth=0.5, label="own coordinates, error 1e-9")
        left.set_ylabel(f"{noise.simulation}: crank acceleration\n[10³ rad/s²]")
        shown = 1e-3 * noise.acceleration[noise.counted]
        left.set_ylim(shown.min() - 0.3 * np.ptp(shown), shown.max() + 0.3 * np.ptp(shown))
        left.set_xlim(0, 1e3 * noise.time[-1])
        for tolerance, colour in ((PRINTED, VERMILION), (TIGHT, BLUE)):
            size = 100 * np.abs(noise.difference[tolerance])[noise.counted]
            label = "(q, A, x), error 1e-6" if tolerance == PRINTED else "(q, A, x), error 1e-8"
            right.plot(1 - noise.ratio[noise.counted], size, ".", color=colour, markersize=1.5, label=label)
        right.axhline(100 * NOISE, color=GREY, linewidth=0.6)
        right.set(xscale="log", yscale="log", xlim=(1e-3, 1), ylim=(1e-3, 300))
        mark_decades(right.xaxis)
        mark_decades(right.yaxis)
        right.set_ylabel("error [% of the largest]")
    axes[-1][0].set_xlabel("time [ms]")
    axes[-1][1].set_xlabel("film thickness / c")
    style.add_legend(drawing, axes.flat, markerscale=4)
    drawing.suptitle("Crank acceleration with the Pinkus–Sternlicht film, integrated as in the dissertation")
    return drawing


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--simulation", action="append", choices=SIMULATIONS,
                        help="simulation to measure; repeatable (default: all)")
    parser.add_argument("--results", type=Path, default=TOP / "results", metavar="DIR",
                        help="folder of the runs (default: results)")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="folder for the pictures (default: figures in the folder of the runs)")
    language.add_option(parser)
    parser.add_argument("--format", action="append", choices=("png", "svg", "pdf"), help="repeatable (default: png)")
    options = parser.parse_args()
    try:
        own, absolute = built_program(), built_program("absolute_run")
        out = options.results / "noise"
        out.mkdir(parents=True, exist_ok=True)
        found = [measure(simulation, absolute, own, out) for simulation in options.simulation or SIMULATIONS]
        lines = table(found)
        print(*lines, sep="\n")
        if not options.simulation:
            said = (
                "Integration error of the crank acceleration with the coordinates (q, A, x), the given relative = absolute error\n"
                "and steps of at most 1e-7 s. The reference is the program in its own coordinates at 1e-9. Errors are divided by the\n"
                "largest acceleration; the first 2 % of the run are left out.\n\n"
            )
            title = "Noise of the Pinkus-Sternlicht film in the coordinates of the dissertation"
            print(write_table("noise", title, "scripts/bench/show_noise.py", said + "\n".join(lines)))
        print(*style.save(draw(found), options.out or options.results / "figures", "noise", options.format or ["png"]))
        language.current.warn("show_noise.py")
    except (MissingResult, OSError) as problem:
        print(f"show_noise.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
