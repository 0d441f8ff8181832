"""Pictures of the laws of contact and friction in runs: force over penetration and its rate, friction force over sliding speed."""

import numpy as np
from matplotlib.axes import Axes

from .film_pressure import film_motion
from .results import Run
from .style import BLACK, BLUE, GREY, VERMILION

CONTACT_PHASE = 2
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
