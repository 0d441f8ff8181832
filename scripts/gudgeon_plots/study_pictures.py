"""Pictures of parameter studies: curves, maps, bifurcation diagrams, and what they say in numbers."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure as Drawing
from scipy.optimize import brentq

from .figures import add_legend
from .results import MissingResult, events_of, read_table
from .study import Runs
from .style import BLACK, BLUE, GREEN, GREY, VERMILION, WIDTH

#: Contours of the least film thickness [um]. A film of three times the roughness of its surfaces separates them.
FILM_CONTOURS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0)

#: Strobed points that differ by less than this share of the clearance are one point.
SAME_POINT = 2e-3

#: Longest period that is looked for [revolutions].
LONGEST_PERIOD = 8

#: Impacts at more than this share of the fastest of a run: slower ones are those that the load presses on.
HARD_IMPACT = 0.5


def grid(runs: Runs, x: str, y: str, column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A column over two parameters: values of x, of y, and of the column (y down, x across), NaN where a run failed."""
    table = runs.table.assign(**{column: np.where(runs.done, runs.table[column], np.nan).astype(float)})
    found = table.pivot(index=y, columns=x, values=column)
    return found.columns.to_numpy(dtype=float), found.index.to_numpy(dtype=float), found.to_numpy(dtype=float)


def mark_failed(axis: Axes, runs: Runs, x: str, y: str, scale: float = 1.0) -> None:
    """Crosses where runs failed."""
    if not runs.done.all():
        failed = runs.table[~runs.done]
        axis.plot(scale * failed[x], failed[y], "x", color=VERMILION, markersize=4, label="failed")


def draw_film(axis: Axes, runs: Runs) -> plt.cm.ScalarMappable:
    """The least film thickness [um] over clearance and speed."""
    clearance, speed, film = grid(runs, "joint.clearance", "initial.crank_speed", "min_film_thickness")
    film = 1e6 * film
    norm = LogNorm(1e-3, 10.0)
    image = axis.pcolormesh(1e6 * clearance, speed, film, norm=norm, cmap="viridis", shading="nearest")
    levels = [level for level in FILM_CONTOURS if np.nanmin(film) < level < np.nanmax(film)]
    if levels:
        lines = axis.contour(1e6 * clearance, speed, film, levels=levels, colors="white", linewidths=0.8)
        long = [level for level, parts in zip(lines.levels, lines.allsegs) if sum(map(len, parts)) > 12]
        axis.clabel(lines, long, fmt=lambda value: f"{value:g} µm", fontsize=7)
    mark_failed(axis, runs, "joint.clearance", "initial.crank_speed", 1e6)
    return image


def draw_contact(axis: Axes, runs: Runs) -> plt.cm.ScalarMappable:
    """The share of time in contact [%] over clearance and speed."""
    clearance, speed, share = grid(runs, "joint.clearance", "initial.crank_speed", "contact_time_fraction")
    norm = Normalize(60.0, 100.0)
    image = axis.pcolormesh(1e6 * clearance, speed, 100 * share, norm=norm, cmap="magma", shading="nearest")
    mark_failed(axis, runs, "joint.clearance", "initial.crank_speed", 1e6)
    return image


def draw_maps(studies: dict[str, Runs]) -> Drawing:
    """Both films of simulations I and IV over clearance and speed."""
    drawing, axes = plt.subplots(2, 2, figsize=(WIDTH, 5.4), sharex=True, sharey=True)
    for row, number in zip(axes, ("I", "IV")):
        carried, touching = studies[f"map_{number}"], studies[f"map_{number}_oscillating"]
        image = draw_film(row[0], carried)
        drawing.colorbar(image, ax=row[0], label="least film thickness [µm]")
        row[0].set_title(
            f"{number}, Pinkus–Sternlicht: contact {100 * np.nanmax(carried['contact_time_fraction']):.3g} %"
        )
        image = draw_contact(row[1], touching)
        drawing.colorbar(image, ax=row[1], label="time in contact [%]", extend="min")
        row[1].set_title(f"{number}, oscillating film")
        row[0].set_ylabel("crank speed [rad/s]")
    for axis in axes.flat:
        axis.set(xscale="log", yscale="log")
        axis.grid(visible=False)
        axis.set_xticks([10, 20, 50, 100, 200], ["10", "20", "50", "100", "200"])
        axis.set_yticks([50, 100, 200, 500, 1000], ["50", "100", "200", "500", "1000"])
        axis.minorticks_off()
    for axis in axes[1]:
        axis.set_xlabel("clearance [µm]")
    drawing.suptitle("When does the film carry the pin? Constant crank speed, after four revolutions")
    return drawing


def describe_maps(studies: dict[str, Runs]) -> list[str]:
    """The numbers of the maps."""
    lines = []
    for name, runs in studies.items():
        share = runs.table.loc[runs.done, "contact_time_fraction"].astype(float)
        film = 1e6 * runs.table.loc[runs.done, "min_film_thickness"].astype(float)
        least = ", ".join(f"above {level:g} µm in {100 * (film > level).mean():.0f} %" for level in (0.1, 0.3, 1.0))
        lines.append(
            f"{name}: {runs.done.sum()} of {len(runs.table)} runs done; in contact {100 * share.min():.3g} to"
            f" {100 * share.max():.3g} % of the time (median {100 * share.median():.3g} %);"
            f" least film {film.min():.3g} to {film.max():.3g} µm, {least} of the runs"
        )
    return lines


def read_strobe(path: Path, runs: Runs) -> pd.DataFrame:
    """NAME.strobe.csv, with the parameters of each point's run beside it."""
    if not path.exists():
        raise MissingResult(f"no result {path}")
    strobe, _ = read_table(path)
    parameters = runs.table.columns[1 : runs.table.columns.get_loc("status")]
    return strobe.merge(runs.table[["run", *parameters]], on="run", validate="many_to_one")


def period(points: np.ndarray, tolerance: float) -> int:
    """Revolutions after which a sequence of points (rows) repeats within a tolerance; 0 if not within the longest
    period looked for, or if there are not two of it."""
    for length in range(1, min(LONGEST_PERIOD, len(points) // 2) + 1):
        if np.abs(points[length:] - points[:-length]).max() <= tolerance:
            return length
    return 0


def periods(strobe: pd.DataFrame, parameter: str) -> pd.Series:
    """Of each run, by the value of its parameter."""
    found = {}
    for _, points in strobe.groupby("run", sort=True):
        found[points[parameter].iloc[0]] = period(points[["eccentricity_ratio_y"]].to_numpy(), SAME_POINT)
    return pd.Series(found).sort_index()


def with_ratios(strobe: pd.DataFrame, clearance: float | None, speed: float | None) -> pd.DataFrame:
    """Points over clearance and over the speed at which it turns; what is not a parameter is given."""
    clearance = strobe["joint.clearance"] if clearance is None else clearance
    speed = strobe["initial.crank_speed"] if speed is None else speed
    return strobe.assign(
        eccentricity_ratio_y=strobe["eccentricity_y"] / clearance,
        velocity_ratio=strobe["piston_velocity"] / (clearance * speed),
    )


def draw_bifurcation(strobes: dict[str, pd.DataFrame]) -> Drawing:
    """Strobed points over clearance and over speed."""
    drawing, axes = plt.subplots(2, 2, figsize=(WIDTH, 5.2), sharey="row")
    columns = (
        ("bifurcation_clearance", "joint.clearance", 1e6, "clearance [µm], at 524 rad/s", "log"),
        ("bifurcation_speed", "initial.crank_speed", 1.0, "crank speed [rad/s], at 100 µm", "linear"),
    )
    for (name, parameter, unit, label, scale), (above, below) in zip(columns, axes.T):
        strobe = strobes[name]
        settled = periods(strobe, parameter)
        repeats = strobe[parameter].map(settled).to_numpy()
        for axis, column in ((above, "eccentricity_ratio_y"), (below, "velocity_ratio")):
            for mask, colour, size in (
                (repeats == 0, BLACK, 0.3),
                (repeats > 1, VERMILION, 3.0),
                (repeats == 1, BLUE, 3.0),
            ):
                axis.scatter(
                    unit * strobe.loc[mask, parameter],
                    strobe.loc[mask, column],
                    s=size,
                    c=colour,
                    linewidths=0,
                    rasterized=True,
                )
            axis.set_xscale(scale)
        below.set_xlabel(label)
    axes[0][0].set_ylabel("eccentricity across / c")
    axes[1][0].set_ylabel("piston velocity / (c · crank speed)")
    drawing.suptitle(
        "Flores slider-crank, dry: state at the dead centre in 80 revolutions\n"
        f"blue: the same in each, red: repeats after 2 to {LONGEST_PERIOD}, black: does not"
    )
    return drawing


def describe_bifurcation(strobe: pd.DataFrame, name: str, parameter: str, unit: float, label: str) -> str:
    """How many motions repeat after how many revolutions, and where the last of each kind are."""
    found = periods(strobe, parameter)
    counts = found.value_counts()
    later = counts[[n for n in counts.index if n > 1]].sum()
    text = f"{name}: of {len(found)} values from {unit * found.index[0]:.4g} to {unit * found.index[-1]:.4g} {label} "
    text += f"{counts.get(1, 0)} repeat every revolution, {later} after 2 to {LONGEST_PERIOD}, {counts.get(0, 0)} do not"
    for what, values in (("repeat", found.index[found > 0]), ("do not", found.index[found == 0])):
        if len(values):
            text += f"; those that {what} lie from {unit * values[0]:.4g} to {unit * values[-1]:.4g}"
    return text


def restitution_of_law(nominal: float) -> float:
    """The ratio of speeds after and before an impact that nothing else acts on, by Lankarani and Nikravesh's law: with
    F = K d^n (1 + q v/v0), q = 3 (1 - e^2)/4, the energy gives q - ln(1 + q) = -q r - ln(1 - q r) for the ratio r."""
    q = 0.75 * (1.0 - nominal**2)
    if q == 0.0:
        return 1.0
    return brentq(lambda ratio: (-q * ratio - np.log1p(-q * ratio)) - (q - np.log1p(q)), 1e-9, min(1.0, 1 / q - 1e-9))


def impacts(path: Path, settled_from: float) -> tuple[np.ndarray, np.ndarray]:
    """Speeds at which the contacts of a run's events begin and end, of those that begin after a crank angle."""
    events = events_of("piston_pin", read_table(path)[0])
    begins = events[events["event"] == "contact_begins"].reset_index(drop=True)
    ends = events[events["event"] == "contact_ends"].reset_index(drop=True)
    both = min(len(begins), len(ends))
    begins, ends = begins[:both], ends[:both]
    counted = (begins["crank_angle"] >= settled_from).to_numpy()
    return begins["normal_speed"].abs().to_numpy()[counted], ends["normal_speed"].abs().to_numpy()[counted]


def measured_restitution(directory: Path, runs: Runs, settled_from: float) -> pd.DataFrame:
    """For each run the median ratio of speeds, and its quartiles, of the hard impacts, and how many there were."""
    rows = []
    for run, nominal in zip(runs["run"], runs["contact.restitution"]):
        before, after = impacts(directory / f"{run}.events.csv", settled_from)
        hard = before > HARD_IMPACT * before.max(initial=0.0)
        low, middle, high = np.quantile(after[hard] / before[hard], (0.25, 0.5, 0.75)) if hard.any() else 3 * [np.nan]
        rows.append((nominal, low, middle, high, int(hard.sum())))
    return pd.DataFrame(rows, columns=["nominal", "low", "middle", "high", "count"])


def draw_restitution(runs: Runs, measured: pd.DataFrame) -> Drawing:
    """What the coefficient of restitution changes, and the coefficient that comes out."""
    drawing, axes = plt.subplots(2, 2, figsize=(WIDTH, 4.8), sharex=True)
    nominal = runs["contact.restitution"]
    panels = (
        (axes[0][0], "contact_time_fraction", 100.0, "time in contact [%]"),
        (axes[0][1], "max_pin_force_mean", 1e-3, "peak pin force [kN]"),
        (axes[1][0], "dissipated_energy", 1.0, "dissipated in a revolution [J]"),
    )
    for axis, column, unit, label in panels:
        axis.plot(nominal, unit * np.where(runs.done, runs[column], np.nan), ".-", color=BLUE)
        axis.set(ylabel=label, ylim=(0, None))
    axes[0][1].plot(nominal, 1e-3 * np.where(runs.done, runs["max_pin_force"], np.nan), ".", color=GREY)
    axes[0][1].set_title("of a revolution, mean; grey: highest")
    axis = axes[1][1]
    axis.fill_between(measured["nominal"], measured["low"], measured["high"], color=BLUE, alpha=0.25, linewidth=0)
    axis.plot(measured["nominal"], measured["middle"], ".-", color=BLUE, label="hard impacts, middle half")
    line = np.linspace(0, 1, 101)
    axis.plot(line, [restitution_of_law(value) for value in line], color=VERMILION, label="the law, impact alone")
    axis.plot(line, line, color=GREEN, linestyle="--", label="as asked for")
    axis.set(ylabel="speed after / before", ylim=(0, 1.1))
    for axis in axes[1]:
        axis.set_xlabel("coefficient of restitution asked for")
    add_legend(drawing, [axes[1][1]])
    drawing.suptitle("Flores slider-crank, 5000 rpm, clearance 0.5 mm, dry")
    return drawing


def describe_restitution(runs: Runs, measured: pd.DataFrame) -> str:
    """The numbers of the picture at a few coefficients."""
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


def draw_curves(runs: Runs, parameter: str, columns: Sequence[str]) -> Drawing:
    """Columns over the one parameter of any study."""
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 1.9 * len(columns)), sharex=True, squeeze=False)
    for axis, column in zip(axes[:, 0], columns):
        axis.plot(runs[parameter], np.where(runs.done, runs[column], np.nan), ".-", color=BLUE)
        axis.set_ylabel(f"{column.replace('_', ' ')} [{runs.units[column]}]")
    axes[-1][0].set_xlabel(parameter)
    return drawing


def draw_map(runs: Runs, x: str, y: str, columns: Sequence[str]) -> Drawing:
    """Columns over the two parameters of any study."""
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 3.2 * len(columns)), sharex=True, squeeze=False)
    for axis, column in zip(axes[:, 0], columns):
        image = axis.pcolormesh(*grid(runs, x, y, column), shading="nearest")
        drawing.colorbar(image, ax=axis, label=f"{column.replace('_', ' ')} [{runs.units[column]}]")
        mark_failed(axis, runs, x, y)
        axis.set_ylabel(y)
        axis.grid(visible=False)
    axes[-1][0].set_xlabel(x)
    return drawing
