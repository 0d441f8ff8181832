"""Pictures of settled cycles: means with their scatter, orders and spectra, loads on the bearings, the indicator diagram."""

import matplotlib.pyplot as plt
import numpy as np
from gudgeon._heat import heat_release
from gudgeon.cycles import Cycles, bearing_loads, orders, spectrum
from gudgeon.names import Shown, plain_unit, shown_unit, suited
from gudgeon.plots.style import BLACK, BLUE, GREY, ORANGE, VERMILION, WIDTH, CrankAngles
from gudgeon.report.answers import number
from gudgeon.results import Run, numbered
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MaxNLocator

HEIGHT = 1.7  # height of a row [inch]


def shown(cycles: Cycles, column: str) -> Shown:
    """A column as an axis shows it: name, unit, factor to this unit."""
    unit, factor = shown_unit(column, cycles.run.units.get(column, ""), cycles[column])
    return Shown(column.replace("_", " "), plain_unit(unit), factor)


def draw_means(cycles: Cycles, columns: list[str]) -> Drawing:
    """Each column over the cycle: single cycles as thin lines, their mean, and a band of one standard deviation on both sides. Cycles that
    repeat within a line's width are one line."""
    drawing, axes = plt.subplots(len(columns), 1, figsize=(WIDTH, 0.5 + HEIGHT * len(columns)), sharex=True, squeeze=False)
    order = np.argsort(cycles.place)
    angle = np.degrees(cycles.place[order])
    repeats = all(cycles[column].std(axis=0).max() < 0.003 * np.ptp(cycles[column]) for column in columns)
    for axis, column in zip(axes[:, 0], columns):
        as_shown = shown(cycles, column)
        values = as_shown.factor * cycles[column][:, order]
        mean, scatter = values.mean(axis=0), values.std(axis=0)
        if not repeats:
            for k in range(min(cycles.number, 40)):
                axis.plot(angle, values[k], color=GREY, linewidth=0.25, alpha=0.6, label="single cycles" if k == 0 else None)
            axis.fill_between(angle, mean - scatter, mean + scatter, color=ORANGE, alpha=0.45, linewidth=0, label="standard deviation")
        axis.plot(angle, mean, color=BLUE, label="mean")
        axis.set_ylabel(as_shown.label)
    axes[-1, 0].set_xlabel("crank angle within the cycle [deg]")
    axes[-1, 0].set_xticks(np.arange(0, np.degrees(cycles.length) + 1, 90))
    if not repeats:
        drawing.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    what = "a revolution" if cycles.length < 7 else f"{cycles.length / (2 * np.pi):g} revolutions"
    how = ", which repeat" if repeats and cycles.number > 1 else ""
    drawing.suptitle(f"{cycles.run.name}: {cycles.number} {'cycle' if cycles.number == 1 else 'cycles'} of {what}{how}")
    drawing.align_ylabels()
    return drawing


def draw_orders(cycles: Cycles, columns: list[str], highest: float) -> Drawing:
    """Amplitudes by order, and the amplitude density by frequency, of each column."""
    drawing, axes = plt.subplots(len(columns), 2, figsize=(WIDTH, 0.5 + HEIGHT * len(columns)), squeeze=False)
    scatters = False
    for (left, right), column in zip(axes, columns):
        table = orders(cycles, column)
        table = table[(table["order"] > 0) & (table["order"] <= highest)]
        width = 0.7 * (table["order"].iloc[1] - table["order"].iloc[0]) if len(table) > 1 else 0.5
        as_shown = shown(cycles, column)
        amplitude, scatter = as_shown.factor * table["amplitude"], as_shown.factor * table["scatter"]
        left.bar(table["order"], amplitude, width=width, color=BLUE)
        if scatter.max() > 0.003 * amplitude.max():
            left.errorbar(table["order"], amplitude, yerr=scatter, fmt="none", ecolor=VERMILION, elinewidth=0.7)
            scatters = True
        left.set_ylabel(as_shown.label)
        left.set_ylim(bottom=0)
        frequency, density = spectrum(cycles, column)
        density = as_shown.factor * density
        there = (frequency > 0) & (density > 0)
        right.loglog(frequency[there], density[there], color=BLACK, linewidth=0.6)
        if there.any():
            top = density[there].max()
            right.set_ylim(top * 1e-6, top * 3)
        right.set_ylabel(f"[{as_shown.unit or '1'}/√Hz]")
    axes[0, 0].set_title("amplitude by order" + (" (bars: scatter from cycle to cycle)" if scatters else ""))
    axes[0, 1].set_title("amplitude density")
    axes[-1, 0].set_xlabel("order: cycles in a revolution")
    axes[-1, 1].set_xlabel("frequency [Hz]")
    drawing.suptitle(cycles.run.name)
    return drawing


def draw_bearings(cycles: Cycles) -> Drawing:
    """Polar plots of the loads on the bearings: the mean cycle dark, single cycles light. Dots mark each 90 degrees of the crank,
    or each 180 degrees where a cycle has two revolutions."""
    loads = bearing_loads(cycles)
    drawing, axes = plt.subplots(
        1, len(loads), figsize=(WIDTH, WIDTH / len(loads) + 0.6), subplot_kw={"projection": "polar"}, squeeze=False
    )
    marks = [int(np.argmin(np.abs(cycles.place - k * cycles.length / 4))) for k in range(4)]
    for axis, (name, force) in zip(axes[0], loads.items()):
        unit, factor = suited("kN", 1e-3, np.hypot(*force))
        for k in range(min(cycles.number, 20)):
            x, y = force[0, k], force[1, k]
            axis.plot(np.arctan2(y, x), factor * np.hypot(x, y), color=GREY, linewidth=0.25, alpha=0.6)
        x, y = force.mean(axis=1)
        x, y = np.append(x, x[0]), np.append(y, y[0])
        axis.plot(np.arctan2(y, x), factor * np.hypot(x, y), color=BLUE)
        # numbers stand outwards; two of the marks are close together where the gas is thin: the later one is turned aside
        turned: list[tuple[float, int]] = []
        for mark in marks:
            angle, size = np.arctan2(y[mark], x[mark]), factor * np.hypot(x[mark], y[mark])
            axis.plot(angle, size, "o", color=VERMILION, markersize=2.5)
            near = [other for other, its in turned if np.hypot(x[its] - x[mark], y[its] - y[mark]) < 0.2 * np.hypot(x, y).max()]
            aside = max(angle + np.array([0, 0.7, -0.7, 1.4, -1.4, 2.1, -2.1, np.pi]), key=lambda way: min((min(1.3, abs(np.angle(np.exp(1j * (way - other))))) for other in near), default=1.3))
            turned.append((aside, mark))
            axis.annotate(
                f"{round(np.degrees(cycles.place[mark])) % round(np.degrees(cycles.length))}", (angle, size), fontsize=6, ha="center", va="center",
                xytext=(9 * np.sin(aside), 9 * np.cos(aside)), textcoords="offset points", color=VERMILION,
            )
        axis.set_title(f"{name if ', ' in name else f'{name}, in fixed axes'} [{unit}]".replace(", ", ",\n"), pad=6)
        axis.set_theta_zero_location("N")   # x, or the outward axis of the rod, points upwards and y to the right, as in the other pictures
        axis.set_theta_direction(-1)
        axis.set_xticks(np.radians([0, 90, 180, 270]))
        axis.yaxis.set_major_locator(MaxNLocator(3))
        axis.tick_params(labelsize=5.5, labelcolor=GREY, pad=0)
        axis.set_rlabel_position(60)
    drawing.suptitle(f"{cycles.run.name}: loads on the bearings, mean cycle blue; dots: crank angle [deg]")
    return drawing


def ideal_diagram(run: Run, least: float, largest: float) -> tuple[np.ndarray, np.ndarray]:
    """Volumes and pressures [bar] of a compressor with ideal valves and no heat between two volumes: isentropic compression, delivery,
    expansion and suction."""
    low, high = (1e-5 * float(str(run.parameter("combustion", f"{side}_pressure"))) for side in ("suction", "discharge"))
    ratio = float(str(run.parameter("working_gas", "heat_capacity_ratio")))
    rising = np.linspace(low, min(high, low * (largest / least) ** ratio), 200)
    compression = largest * (low / rising) ** (1 / ratio)
    expansion = least * (rising[-1] / rising) ** (1 / ratio)
    return np.concatenate((compression, expansion[::-1], [largest])), np.concatenate((rising, rising[::-1], [low]))


def shows_heat(run: Run) -> bool:
    """Whether the pressure of a run shows the heat of a four-stroke engine."""
    return run.parameter("combustion", "cycle") == "four_stroke"


def draw_indicator(cycles: Cycles) -> Drawing:
    """Pressure over volume: single cycles light, the mean dark. Of a compressor whose valves have losses these are shaded, with the diagram of
    ideal valves dashed; of a four-stroke engine the heat that the mean pressure shows stands beside it."""
    run = cycles.run
    heats = shows_heat(run)
    drawing, axes = plt.subplots(1, 1 + heats, figsize=((1 if heats else 0.65) * WIDTH, (0.42 if heats else 0.5) * WIDTH), squeeze=False)
    axis = axes[0, 0]
    unit, factor = suited("cm³", 1e6, cycles["cylinder_volume"])
    volume, pressure = cycles["cylinder_volume"] * factor, cycles["cylinder_pressure"] / 1e5
    if cycles.number > 1:
        axis.plot(volume[:40].ravel(), pressure[:40].ravel(), color=GREY, linewidth=0.3)
    mean_volume, mean_pressure = (np.append(mean, mean[0]) for mean in (volume.mean(axis=0), pressure.mean(axis=0)))
    axis.plot(mean_volume, mean_pressure, color=BLUE)
    if numbered(cycles.run.case, "valve"):   # beyond the pressures of suction and discharge
        for key, beyond in (("suction_pressure", np.less), ("discharge_pressure", np.greater)):
            level = 1e-5 * float(str(cycles.run.parameter("combustion", key)))
            axis.fill_between(mean_volume, level, mean_pressure, where=beyond(mean_pressure, level), color=BLUE, alpha=0.3, linewidth=0)
            axis.axhline(level, color=GREY, linewidth=0.5, zorder=0)
        axis.plot(*ideal_diagram(run, mean_volume.min(), mean_volume.max()), color=BLACK, linewidth=0.6, linestyle="--", label="ideal valves")
        axis.legend()
    if heats:
        draw_heat(cycles, axes[0, 1])
    axis.set_xlabel(f"{cycles.run.volume} [{unit}]")
    axis.set_ylabel("cylinder pressure [bar]")
    drawing.suptitle(f"{run.name}: {indicator_finding(run)}".removesuffix(": "))
    return drawing


def indicator_finding(run: Run) -> str:
    """What the summary says of a diagram: the losses of valves, or indicated mean effective and largest pressure."""
    found = {name: float(run.summary[f"cycle_{name}"][0]) for name in ("suction_loss", "discharge_loss", "imep", "max_cylinder_pressure") if f"cycle_{name}" in run.summary}
    if lost := [value for name, value in found.items() if name.endswith("_loss")]:
        return f"the valves take {sum(lost):.3g} W"
    return f"IMEP {number(1e-5 * found['imep'])} bar, largest pressure {number(1e-5 * found['max_cylinder_pressure'])} bar" if len(found) == 2 else ""


def draw_heat(cycles: Cycles, axis: Axes) -> None:
    """The heat that the mean pressure of a four-stroke engine shows, with the angles of 10, 50 and 90 % of it."""
    order = np.argsort(cycles.place)
    columns = {name: cycles[name].mean(axis=0)[order] for name in ("cylinder_pressure", "cylinder_volume")}
    columns["crank_angle"] = cycles.place[order]
    found = heat_release({name: np.tile(values, 2) + (name == "crank_angle") * np.repeat([0, cycles.length], len(order)) for name, values in columns.items()},
                         float(str(cycles.run.parameter("combustion", "heat_capacity_ratio"))))
    axis.plot(found.angle, found.heat, color=BLUE)
    for at in found.angles:
        axis.axvline(at, color=GREY, linewidth=0.5)
    axis.set_xlabel("crank angle [deg]")
    axis.xaxis.set_major_locator(CrankAngles())
    axis.set_ylabel("heat shown by the pressure [J]")
    axis.set_title(f"10, 50, 90 % at {found.angles[0]:.1f}, {found.angles[1]:.1f}, {found.angles[2]:.1f} deg")
