"""Picture and numbers of the effect of an elastic rod on an impact, and of members and joints on a mechanism."""

import math

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    VERMILION,
    WIDTH,
)
from gudgeon.results import Run
from matplotlib.figure import Figure as Drawing

#: Rods: name, colour, line, settings of cases/elastic/first_impact.nml. Curves that nearly coincide with others are dashed.
RODS = (
    ("rigid", BLACK, "-", ("elastic_rod=none",)),
    ("bends (4 modes)", GREEN, (0, (4, 4)), ("elastic_rod.axial_shapes=0",)),
    ("stretches (1 shape)", VERMILION, "-", ("elastic_rod.axial_shapes=1",)),
    ("bends and stretches", BLUE, "-", ()),
    ("stretches (8 shapes)", PURPLE, (0, (4, 4)), ("elastic_rod.transverse_modes=0",)),
)
WHOLE = 3  #: index of the rod that bends and stretches

#: Where the names of the rods stand in the picture of the contact's force: parts of its time and of the largest force.
NAMES_AT = ((0.26, 1.0), (0.29, 0.9), (0.53, 0.69), (0.7, 0.45), (0.75, 0.36))

#: Begin and end [ms] and speeds [m/s] of the first two contacts with 24 cable elements (ANCF) along the rod.
FINITE_ELEMENTS = ((0.2107, 1.972, 0.3394, -0.874), (0.6871, 1.074, 0.8728, -0.764))


def draw_first_impacts(runs: list[Run]) -> Drawing:
    """Film thickness over time, and the force of the first contact, whose time is grey in the panel above."""
    drawing, axes = plt.subplots(2, 1, figsize=(WIDTH, 4.8), layout="constrained")
    first, largest = (0.19, 0.37), 1e-3 * max(float(run["normal_force"].max()) for run in runs)
    for (name, colour, line, _), run, (share, height) in zip(RODS, runs, NAMES_AT):
        time, film = 1e3 * run["time"], 1e6 * run["film_thickness"]
        if name in ("rigid", "stretches (1 shape)", RODS[WHOLE][0]):
            axes[0].plot(time, film, color=colour, linestyle=line)
        force = 1e-3 * run["normal_force"]
        axes[1].plot(time, force, color=colour, linestyle=line)
        axes[1].annotate(name, (np.interp(share, [0, 1], first), height * largest), color=colour, fontsize=7)
    for begin, _, end, _ in FINITE_ELEMENTS:
        axes[0].plot([begin, end], [0, 0], "x", color=GREY, markersize=5)
    axes[0].axvspan(*first, color=GREY, alpha=0.18, linewidth=0)
    axes[0].annotate("× contacts of finite elements", (0.99, 0.03), xycoords="axes fraction", ha="right", fontsize=7, color=GREY)
    axes[0].axhline(0, color=GREY, linewidth=0.6)
    axes[0].set(ylabel="film thickness [µm]\n(below 0: penetration)", xlabel="time [ms]")
    axes[1].set(ylabel="contact force [kN]", xlabel="time [ms], grey above", xlim=first, facecolor="#EFEFEF")
    drawing.suptitle("A rod that stretches halves the force of the first impact, and the contact lasts longer")
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


#: Numbers of axial shapes whose first contacts are compared, and the text for their table.
AXIAL_SHAPES = range(1, 9)
FIRST_IMPACT_SAYS = (
    "`cases/elastic/first_impact.nml`: the pin hits its bearing 0.2 ms after the start. A rigid rod, and a rod that only bends, "
    "leave the bearing "
    "with 1.74 m/s. The waves along a rod that stretches take half of this speed away. The finite elements are 24 cable elements (ANCF, Exudyn)."
)
AXIAL_SHAPES_SAY = (
    "Speed after the first contact for several numbers of axial shapes, with 4 transverse modes. The speed depends on the phase "
    "of the shortest waves "
    "at the end of the contact: from 4 shapes on it is above or below that of the finite elements, -0.874 m/s, and converges "
    "slowly. The 8 shapes of "
    "the case, the largest number that a rod may have, give a speed 3 to 4 % smaller. The times of the contact converge much faster."
)


def describe_axial_shapes(runs: list[Run]) -> str:
    """A table of the first contact for several numbers of axial shapes."""
    lines = ["| axial shapes | contact begins | ends |", "|---|---|---|"]
    for shapes, run in zip(AXIAL_SHAPES, runs):
        begin, end = (f"{1e3 * event['time']:.4f} ms, {event['normal_speed']:+.3f} m/s" for _, event in run.events.iloc[:2].iterrows())
        lines.append(f"| {shapes} | {begin} | {end} |")
    return "\n".join(lines)


#: Settings of cases/elastic/first_impact.nml for all runs that compare members; then, for each run, its name and its further
#: settings.
MEMBER_RUN = (
    "integrator.end_time=0", "integrator.revolutions=3", "output.interval=0", "output.samples_per_revolution=3600",
    "contact.law=lankarani_nikravesh", "contact.restitution=0.9",
)
LOOSE_CRANK_PIN = (
    "crank_pin.joint.kind=clearance", "crank_pin.joint.clearance=1e-4", "crank_pin.joint.bearing_radius=0.012",
)
LOOSE_PISTON = (
    "guide.kind=clearance", "guide.bore_clearance=1e-4", "guide.skirt_top=0.015", "guide.skirt_bottom=0.020", "guide.piston_radius=0.020",
    "guide.piston_inertia=2e-5", "guide.contact_law=lankarani_nikravesh", "guide.restitution=0.6", "guide.stiffness=1e8",
    "guide.exponent=1", "guide.coefficient=0",
)
ELASTIC_ROD = (
    "elastic_rod.transverse_modes=2", "elastic_rod.axial_shapes=4", "elastic_rod.damping_ratio=0.01", "elastic_rod.axial_damping_ratio=0.01",
)
ELASTIC_CRANKSHAFT = (
    "crankshaft.flywheel_inertia=0.01", "crankshaft.torsional_stiffness=2e4", "crankshaft.torsional_damping=0.5",
)
RIGID = ("elastic_rod=none",)
MEMBERS = (
    ("piston pin loose", RIGID),
    ("crank pin loose too", (*RIGID, *LOOSE_CRANK_PIN)),
    ("piston loose in its bore too", (*RIGID, *LOOSE_PISTON)),
    ("elastic rod", ELASTIC_ROD),
    ("elastic crankshaft", (*RIGID, *ELASTIC_CRANKSHAFT)),
    ("all of it", (*ELASTIC_ROD, *LOOSE_CRANK_PIN, *LOOSE_PISTON, *ELASTIC_CRANKSHAFT)),
)
MEMBERS_SAY = (
    "Flores's slider-crank at 3500 rpm with a clearance of 0.2 mm at the piston pin, dry, restitution 0.9 "
    "(`cases/elastic/first_impact.nml` over "
    "three revolutions). Each row adds one joint or member to the first row. Impacts are those of all three revolutions, forces "
    "and losses those of "
    "the last two. The motions are chaotic: the numbers depend on the tolerance."
)


def late_part(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Crank angle in revolutions and rows, after the first revolution."""
    turns = (run["crank_angle"] - run["crank_angle"][0]) / (2 * math.pi)
    return turns, turns >= 1


def impacts(run: Run, joint: str) -> float:
    """Contacts that begin per revolution, over the whole run; for a skirt, those of its four corners together."""
    names = [f"guide_{i}_contacts" for i in range(1, 5)] if joint == "skirt" else [f"{joint}contacts"]
    return sum(float(run.summary[name][0]) for name in names if name in run.summary) / 3


def draw_members(runs: list[Run]) -> Drawing:
    """The force on the piston pin over the second and third revolution, a row for each, with its largest value at the right; the hardest
    on top."""
    rows = []
    for (name, _), run in zip(MEMBERS, runs):
        turns, late = late_part(run)
        force = 1e-3 * np.hypot(run["pin_force_x"], run["pin_force_y"])[late]
        rows.append((float(force.max()), name, turns[late], force))
    rows.sort(key=lambda row: -row[0])
    drawing, axes = plt.subplots(len(rows), 1, figsize=(WIDTH, 0.62 * len(rows) + 0.6), sharex=True, sharey=True, layout="constrained")
    for axis, (peak, name, turns, force) in zip(axes, rows):
        axis.fill_between(turns, force, color=BLUE if name == MEMBERS[0][0] else GREY, linewidth=0)
        axis.annotate(f"{peak:.1f} kN", (1.01, 0.5), xycoords="axes fraction", va="center")
        axis.set_ylabel(name, rotation=0, ha="right", va="center")
        axis.set_yticks([])
        axis.spines["left"].set_visible(False)
        if axis is not axes[-1]:
            axis.tick_params(axis="x", length=0)
            axis.spines["bottom"].set_color("#DDDDDD")
    axes[0].set_title("force on the piston pin; at the right its largest value", loc="left")
    axes[-1].set_xlabel("revolutions of the crank")
    axes[-1].set_xlim(1, 3)
    axes[-1].set_ylim(0, None)
    drawing.suptitle("A second clearance adds impacts; an elastic rod or crankshaft softens them")
    return drawing


def describe_members(runs: list[Run]) -> str:
    """A table of impacts, forces and losses for each member."""
    lines = ["| | impacts per revolution: piston pin | crank pin | skirt | largest force on the piston pin [kN] | on the crank's bearing [kN] "
             "| side force [kN] | loss per revolution [J] | evaluations |", "|---|---|---|---|---|---|---|---|---|"]
    for (name, _), run in zip(MEMBERS, runs):
        _, late = late_part(run)
        counts = [impacts(run, joint) for joint in ("", "crank_pin_", "skirt")]
        forces = [1e-3 * np.hypot(run[f"{one}_x"], run[f"{one}_y"])[late].max() for one in ("pin_force", "crank_bearing_force")]
        forces.append(1e-3 * abs(run["guide_force"][late]).max())
        speed = run["flywheel_speed"] if "flywheel_speed" in run else run["crank_speed"]
        power, time = (run["crank_moment"] * speed)[late], run["time"][late]
        work = float((0.5 * (power[1:] + power[:-1]) * np.diff(time)).sum()) - (run["energy"][late][-1] - run["energy"][late][0])
        lines.append("| " + " | ".join((name, *(f"{one:.1f}" for one in counts), *(f"{one:.1f}" for one in forces), f"{work / 2:.2f}",
                                        run.summary["rhs_evaluations"][0])) + " |")
    return "\n".join(lines)
