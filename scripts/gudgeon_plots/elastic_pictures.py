"""What an elastic rod makes of an impact: its picture, and what it says in numbers."""

import matplotlib.pyplot as plt
from matplotlib.figure import Figure as Drawing

from .figures import add_legend
from .results import Run
from .style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, WIDTH

#: Rods: name, colour, line, what is set of cases/elastic/first_impact.nml. Those that lie on each other are dashed.
RODS = (
    ("rigid", BLACK, "-", ("elastic_rod=none",)),
    ("bends (4 modes)", GREEN, (0, (4, 4)), ("elastic_rod.axial_shapes=0",)),
    ("stretches (1 shape)", ORANGE, "-", ("elastic_rod.axial_shapes=1",)),
    ("bends and stretches", BLUE, "-", ()),
    ("stretches (8 shapes)", VERMILION, (0, (4, 4)), ("elastic_rod.transverse_modes=0",)),
)
WHOLE = 3  #: of them, the one that does both

#: Begin, end [ms] and speeds [m/s] of the first two contacts with 24 cable elements (ANCF) along the rod.
FINITE_ELEMENTS = ((0.2107, 1.972, 0.3394, -0.874), (0.6871, 1.074, 0.8728, -0.764))


def draw_first_impacts(runs: list[Run]) -> Drawing:
    """Film thickness, contact force, and how the rod is bent and stretched, over time."""
    drawing, axes = plt.subplots(3, 1, figsize=(WIDTH, 6.4), layout="constrained")
    for (name, colour, line, _), run in zip(RODS, runs):
        time = 1e3 * run["time"]
        axes[0].plot(time, 1e6 * run["film_thickness"], color=colour, linestyle=line, label=name)
        axes[1].plot(time, 1e-3 * run["normal_force"], color=colour, linestyle=line, label=name)
    for begin, _, end, _ in FINITE_ELEMENTS:
        axes[0].plot([begin, end], [0, 0], "x", color=GREY, markersize=5, label="finite elements: begin and end")
    axes[0].axhline(0, color=GREY, linewidth=0.6)
    axes[0].set_ylabel("film thickness [µm]\n(below 0: penetration)")
    axes[1].set_ylabel("contact force [kN]")
    axes[1].set_xlim(0.19, 0.37)
    elastic = runs[WHOLE]
    time = 1e3 * elastic["time"]
    axes[2].plot(time, 1e6 * elastic["rod_mid_deflection"], color=PURPLE, label="deflection half way")
    axes[2].plot(time, 1e6 * elastic["rod_stretch"], color=BLUE, linestyle="--", label="stretch")
    axes[2].set_ylabel("of the elastic rod [µm]")
    axes[2].legend(loc="upper left")
    for axis in axes:
        axis.set_xlabel("time [ms]")
    add_legend(drawing, axes[:2])
    return drawing


def describe_first_impacts(runs: list[Run]) -> str:
    """A table of the first contact of each rod."""
    lines = ["| rod | first contact begins | ends | peak force | evaluations |", "|---|---|---|---|---|"]
    for (name, *_), run in zip(RODS, runs):
        begin, end = run.events.iloc[0], run.events.iloc[1]
        lines.append(
            f"| {name} | {1e3 * begin['time']:.4f} ms, {begin['normal_speed']:+.3f} m/s | {1e3 * end['time']:.4f} ms, "
            f"{end['normal_speed']:+.3f} m/s | {1e-3 * end['max_normal_force']:.1f} kN | {run.summary['rhs_evaluations'][0]} |"
        )
    begin, begin_speed, end, end_speed = FINITE_ELEMENTS[0]
    lines.append(f"| finite elements | {begin:.4f} ms, {begin_speed:+.3f} m/s | {end:.4f} ms, {end_speed:+.3f} m/s | | |")
    return "\n".join(lines)
