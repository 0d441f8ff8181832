"""Pictures of the laws of contact, friction and film in runs: force over penetration and its rate, over sliding speed, over eccentricity."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from gudgeon.plots import style
from gudgeon.plots.film_pressure import FILM_PHASE, film_motion
from gudgeon.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    VERMILION,
    WIDTH,
)
from gudgeon.results import MissingResult, Run
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

CONTACT_PHASE = 2
COLOURS = (BLUE, VERMILION, GREEN, BLACK, ORANGE, PURPLE)
#: What a run's rows say about each law: phase, columns and factors of abscissa and ordinate, labels.
VIEWS = (
    (CONTACT_PHASE, "film_thickness", -1e6, "penetration [µm]", "normal_force", 1.0, "normal force [N]"),
    (CONTACT_PHASE, "sliding_speed", 1e3, "sliding speed [mm/s]", "friction_force", 1.0, "friction force [N]"),
    (FILM_PHASE, "eccentricity_ratio", 1.0, "eccentricity ratio", "film_force", 1.0, "film force [N]"),
)
LAWS = {"hertz": ("Hertz", BLACK), "lankarani_nikravesh": ("Lankarani–Nikravesh", VERMILION)}


def contact_states(run: Run) -> dict[str, np.ndarray]:
    """The rows of a trace in contact: time since the first of them [s], penetration [m], its rate [m/s], normal force [N]."""
    inside = run["phase"] == CONTACT_PHASE
    time = run["time"][inside]
    return {
        "time": time - time[0],
        "penetration": -run["film_thickness"][inside],
        "rate": film_motion(run).normal_rate[inside],
        "force": run["normal_force"][inside],
    }


def restitution(run: Run) -> float:
    """Speed of separation divided by speed of approach, for the first contact."""
    speeds = run.events["normal_speed"].astype(float)
    return float(-speeds[run.events["event"] == "contact_ends"].iloc[0] / speeds.iloc[0])


def law_of(run: Run) -> tuple[str, str]:
    """Name and colour of a run's contact law."""
    return LAWS[run.parameter("contact", "law")]


def contact_loop(axis: Axes, runs: list[Run]) -> None:
    """Normal force over penetration, with different lines for loading and unloading."""
    for run in runs:
        name, colour = law_of(run)
        states = contact_states(run)
        turn = int(np.argmax(states["penetration"])) + 1
        x, y = 1e6 * states["penetration"], states["force"]
        axis.plot(x[:turn], y[:turn], color=colour, linewidth=2.2, alpha=0.35, label=f"{name}, loading")
        axis.plot(x[turn - 1 :], y[turn - 1 :], color=colour, linewidth=0.8, label=f"{name}, unloading")
    axis.set_xlabel("penetration [µm]")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)


def penetration_speed(axis: Axes, runs: list[Run]) -> None:
    _speed_over(axis, runs, "time", "time in contact [µs]")


def penetration_portrait(axis: Axes, runs: list[Run]) -> None:
    _speed_over(axis, runs, "penetration", "penetration [µm]")


def _speed_over(axis: Axes, runs: list[Run], abscissa: str, name: str) -> None:
    """Penetration rate over a state of the contact, in millionths of its unit; the label of each run has its restitution."""
    for run in runs:
        law, colour = law_of(run)
        states = contact_states(run)
        law += f", speed of separation over approach {restitution(run):.4f}"
        axis.plot(1e6 * states[abscissa], 1e3 * states["rate"], color=colour, label=law)
    axis.axhline(0, color=GREY, linewidth=0.6)
    axis.set_xlabel(name)
    axis.set_xlim(left=0)


def friction(axis: Axes, run: Run, _ideal: Run | None, _colour: str) -> None:
    """Friction force on the pin over the sliding speed, with the bounds coefficient of friction times mean normal force."""
    inside = run["phase"] == CONTACT_PHASE
    order = np.argsort(run["sliding_speed"][inside], kind="stable")
    speed = 1e3 * run["sliding_speed"][inside][order]
    bound = float(run.parameter("friction", "coefficient")) * run["normal_force"][inside]
    for limit in (-bound.mean(), bound.mean()):
        axis.axhline(limit, color=GREY, linestyle=":", label="coefficient of friction × mean normal force, both signs")
    axis.plot(speed, run["friction_force"][inside][order], ".", color=BLUE, markersize=2)
    axis.axvline(0, color=BLACK, linewidth=0.5)
    axis.set_xlabel("sliding speed [mm/s]")


def draw(runs: Sequence[Run]) -> Drawing:
    """The rows of all runs, as points: one axis for each law that one of them has. Raises MissingResult if none has any."""
    found = [[(run, *points) for run in runs if (points := points_of(run, view)) is not None] for view in VIEWS]
    shown = [(view, points) for view, points in zip(VIEWS, found) if points]
    if not shown:
        raise MissingResult(f"{' '.join(run.name for run in runs)}: no row in contact and none in a film")
    drawing, axes = plt.subplots(1, len(shown), figsize=(WIDTH, 2.9), squeeze=False)
    for axis, (view, points) in zip(axes[0], shown):
        for run, x, y in points:
            axis.plot(x, y, ".", color=COLOURS[runs.index(run) % len(COLOURS)], markersize=2, label=run.name)
        axis.set_xlabel(view[3])
        axis.set_ylabel(view[6])
    style.add_legend(drawing, axes.flat, markerscale=4)
    return drawing


def points_of(run: Run, view: tuple) -> tuple[np.ndarray, np.ndarray] | None:
    """Abscissa and ordinate of the rows of a run in the phase of a view; None if it has no such row or column."""
    phase, x, x_factor, _, y, y_factor, _ = view
    size = y if y in run else f"{y}_x"
    if "phase" not in run or x not in run or size not in run:
        return None
    rows = run["phase"] == phase
    values = run[y] if y in run else np.hypot(run[f"{y}_x"], run[f"{y}_y"])
    return (x_factor * run[x][rows], y_factor * values[rows]) if rows.any() else None
