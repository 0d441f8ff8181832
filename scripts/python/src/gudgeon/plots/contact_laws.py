"""The study of contact laws and geometries: its picture and its numbers."""

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, VERMILION, WIDTH, add_legend
from gudgeon.study import Runs
from matplotlib.figure import Figure as Drawing

LAW, GEOMETRY, RESTITUTION = "contact.law", "contact.geometry", "contact.restitution"

#: Laws without a coefficient of restitution, and that without any loss.
WITHOUT_RESTITUTION, WITHOUT_LOSS = ("hertz", "impact"), "hertz"

#: Colour and mark of a geometry.
MARKS = {
    "hertz_sphere": (BLUE, "o"),
    "johnson": (VERMILION, "^"),
    "conformal": (BLACK, "s"),
    "pereira": (GREEN, "v"),
    "winkler": (GREY, "D"),
}

#: Columns of the study that are shown: unit, label, whether its axis is logarithmic.
SHOWN = (
    ("max_pin_force_mean", 1e-3, "peak pin force [kN]", True),
    ("contact_time_fraction", 100.0, "time in contact [%]", False),
    ("dissipated_energy", 1.0, "dissipated in a revolution [J]", False),
)


def draw_contact_laws(runs: Runs) -> Drawing:
    """A row of dots for each law, one for each geometry; a column of panels for each quantity, a row of panels for each coefficient of
    restitution. The law without loss is far from all others and stands in a note."""
    table = runs.table.assign(done=runs.done)
    laws = [law for law in dict.fromkeys(table[LAW]) if law != WITHOUT_LOSS]
    asked = sorted(set(table[RESTITUTION]), reverse=True)
    drawing, axes = plt.subplots(len(asked), len(SHOWN), figsize=(WIDTH, 0.9 + 0.2 * len(laws) * len(asked)), sharex="col", sharey=True, squeeze=False)
    for row, restitution in zip(axes, asked):
        for axis, (quantity, unit, label, _) in zip(row, SHOWN):
            for geometry, (colour, mark) in MARKS.items():
                done = table[(table[GEOMETRY] == geometry) & (table[RESTITUTION] == restitution) & table["done"] & (table[LAW] != WITHOUT_LOSS)]
                axis.plot(unit * done[quantity], [laws.index(law) for law in done[LAW]], mark, color=colour, markersize=4, alpha=0.8, label=geometry)
            if axis in axes[-1]:
                axis.set_xlabel(label)
        row[0].set_yticks(range(len(laws)), laws)
        row[0].set_ylim(len(laws) - 0.5, -0.5)
        row[0].set_title(f"restitution {restitution:g} asked for", loc="left")
    for axis, (quantity, unit, *_) in zip(axes[-1], SHOWN):
        axis.set_xlim(0, 1.06 * unit * table.loc[table["done"] & (table[LAW] != WITHOUT_LOSS), quantity].max())
    without = table[(table[LAW] == WITHOUT_LOSS) & table["done"]]
    if len(without):
        force, share = 1e-3 * without["max_pin_force_mean"], 100 * without["contact_time_fraction"]
        said = f"{WITHOUT_LOSS}: {force.min():.0f} to {force.max():.0f} kN, {share.min():.0f} to {share.max():.0f} % in contact, 0 J"
        axes[0][-1].set_title(said, loc="right", fontsize=7, color=GREY)
    add_legend(drawing, [axes[0][0]])
    drawing.suptitle("The contact geometry decides the force, the law hardly (Flores, 5000 rpm, clearance 0.5 mm, dry)")
    return drawing


def describe_contact_laws(runs: Runs) -> str:
    """Results by geometry and law: means over the laws that have a coefficient of restitution, and the scatter between these
    laws."""
    table = runs.table[runs.done]
    lines = [
        f"contact_laws: {runs.done.sum()} of {len(runs.table)} runs done; peak pin force, time in contact, dissipated in a "
        "revolution: mean over the laws with a restitution, standard deviation between them"
    ]
    known = table[~table[LAW].isin(WITHOUT_RESTITUTION)]
    for (restitution, geometry), rows in known.groupby([RESTITUTION, GEOMETRY], sort=False):
        figures = ", ".join(
            f"{unit * np.mean(rows[name]):.3g} ± {unit * np.std(rows[name]):.2g} {label.split('[')[1][:-1]}"
            for name, unit, label, _ in SHOWN
        )
        lines.append(f"  {geometry}, {restitution:g}: {figures}")
    first = table[table[RESTITUTION] == table[RESTITUTION].max()]
    for law in WITHOUT_RESTITUTION:
        for _, row in first[first[LAW] == law].iterrows():
            figures = ", ".join(f"{unit * row[name]:.3g} {label.split('[')[1][:-1]}" for name, unit, label, _ in SHOWN)
            lines.append(f"  {row[GEOMETRY]}, {law}: {figures}")
    return "\n".join(lines)
