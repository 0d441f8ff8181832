"""The study of contact laws and geometries: its picture and its numbers."""

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, VERMILION, WIDTH, add_legend
from gudgeon.study import Runs
from matplotlib.figure import Figure as Drawing

LAW, GEOMETRY, RESTITUTION = "contact.law", "contact.geometry", "contact.restitution"

#: Laws without a coefficient of restitution.
WITHOUT_RESTITUTION = ("hertz", "impact")

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
    """One horizontal position for each law, one mark for each geometry; a column of panels for each coefficient of restitution."""
    table = runs.table.assign(done=runs.done)
    laws = list(dict.fromkeys(table[LAW]))
    asked = sorted(set(table[RESTITUTION]), reverse=True)
    drawing, axes = plt.subplots(len(SHOWN), len(asked), figsize=(WIDTH, 6.2), sharex=True, sharey="row", squeeze=False)
    for column, restitution in enumerate(asked):
        for axis, (quantity, unit, label, is_log) in zip(axes[:, column], SHOWN):
            for geometry, (colour, mark) in MARKS.items():
                rows = table[(table[GEOMETRY] == geometry) & (table[RESTITUTION] == restitution) & table["done"]]
                places = [laws.index(law) for law in rows[LAW]]
                axis.plot(
                    places, unit * rows[quantity], mark, color=colour, markersize=4, fillstyle="none", label=geometry
                )
            if is_log:
                axis.set_yscale("log")
                axis.set_yticks([10, 20, 50, 100], ["10", "20", "50", "100"])
                axis.minorticks_off()
            else:
                axis.set_ylim(min(0.0, axis.get_ylim()[0]), None)
            if column == 0:
                axis.set_ylabel(label)
        axes[0][column].set_title(f"restitution {restitution:g} asked for")
        axes[-1][column].set_xlim(-0.5, len(laws) - 0.5)
        axes[-1][column].set_xticks(range(len(laws)), [law.replace("_", " ") for law in laws], rotation=60, ha="right")
    add_legend(drawing, [axes[0][0]])
    drawing.suptitle("Flores slider-crank, 5000 rpm, clearance 0.5 mm, dry: means over 200 revolutions")
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
