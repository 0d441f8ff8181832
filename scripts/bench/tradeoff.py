"""Speed against accuracy: the cost of integrator settings in a scene, and the error of each run against a reference run.

Errors are measured up to the horizon: the time up to which the reference and its checks (the next tightest tolerance, the
other method) agree within REFERENCE_AGREEMENT of each state's range. Beyond the horizon the true motion is not known.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.plots import compare
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, VERMILION, WIDTH
from gudgeon.results import Run
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import NullFormatter

#: The horizon ends where the checks differ from the reference by more than this share of a state's range.
REFERENCE_AGREEMENT = 1e-7

#: Columns of a trace that are states of a scene, in any joint or station; those that the scene has and that change are compared.
STATES = re.compile(
    r"crank_angle|rod_angle|crank_speed|rod_speed|piston_position|piston_velocity|pin_speed|(.*_)?(eccentricity_[xy]|twist|film_temperature)"
)

COLOURS = {"adams": BLUE, "radau": VERMILION, "auto": GREEN}
MARKERS = {"adams": "o", "radau": "s", "auto": "^"}


@dataclass(frozen=True)
class Settings:
    """The settings that are varied. `max_penetration` [m] is 0 for contact entry root; `variant` is empty for the case's own
    film."""

    variant: str
    method: str
    max_order: int
    contact_entry: str
    max_penetration: float
    tolerance: float
    points: int = 0  # points of the film's quadrature; 0: chosen from the tolerance

    @property
    def key(self) -> tuple:
        """Equal for equal settings, also after they have been written and read."""
        return (
            self.variant,
            self.method,
            self.max_order,
            self.contact_entry,
            f"{self.max_penetration:.6e}",
            f"{self.tolerance:.6e}",
            self.points,
        )

    def overrides(self) -> list[str]:
        """Values for gudgeon's --set."""
        found = [
            f"integrator.method={self.method}",
            f"integrator.max_order={self.max_order}",
            f"integrator.relative_tolerance={self.tolerance:g}",
            f"integrator.contact_entry={self.contact_entry}",
        ]
        if self.max_penetration > 0:
            found.append(f"integrator.max_penetration={self.max_penetration:.6e}")
        if self.variant:
            found.append(f"lubrication.variant={self.variant}")
        if self.points > 0:
            found.append(f"lubrication.quadrature_points={self.points}")
        return found

    def __str__(self) -> str:
        text = f"{self.method}, tolerance {self.tolerance:g}, max_order {self.max_order}"
        if self.contact_entry != "root":
            text += f", {self.contact_entry} {self.max_penetration:.1e} m"
        if self.points > 0:
            text += f", {self.points} points"
        return text


@dataclass(frozen=True)
class Reference:
    """The run with which others are compared, and its own accuracy."""

    run: Run
    horizon: float  # s
    whole: bool  # whether the horizon is the end of the run
    error: float  # largest difference from its checks up to the horizon, relative to the range
    checks: tuple[Run, ...] = ()  # the runs by which it is checked

    def known(self, agreement: float) -> float:
        """Time [s] up to which the error is at most `agreement` of the states' ranges; a larger agreement gives a later time."""
        return known_until(self.run, self.checks, agreement)[0] if self.checks else self.horizon


def moving_states(run: Run) -> list[str]:
    return [column for column in run.trace.columns if STATES.fullmatch(column) and np.ptp(run[column]) > 0]


def state_error(reference: Run, run: Run, until: float) -> float:
    """Largest difference of any state up to a time, relative to the state's range; infinite if the run ends before."""
    if run["time"][-1] < until * (1 - 1e-9):
        return np.inf
    found = compare.agree(reference, run, moving_states(reference), compare.AGREEMENT)
    return max(float(np.abs(item.difference[item.time <= until]).max()) / item.scale for item in found)


def known_until(reference: Run, checks: Sequence[Run], agreement: float) -> tuple[float, bool]:
    """Time up to which all checks agree with the reference in every state, and whether that is the end of the run."""
    found = [item for check in checks for item in compare.agree(reference, check, moving_states(reference), agreement)]
    end = min(item.horizon for item in found)
    return end, all(item.whole for item in found) and end >= reference["time"][-1]


def choose_reference(tight: dict[str, Run], next_tight: dict[str, Run], horizon: float | None = None) -> Reference:
    """Choose, among the tightest runs of the methods, the one that differs least from its own next tightest run. It is checked by
    that run and by the tightest runs of the other methods. `horizon` is a time [s] given by the user; it is limited to the end of
    the runs."""

    def steadiness(method: str) -> tuple[float, float]:
        if method not in next_tight:
            return (0.0, 0.0)
        until, _ = known_until(tight[method], [next_tight[method]], REFERENCE_AGREEMENT)
        return until, -state_error(tight[method], next_tight[method], until)

    method = max(tight, key=steadiness)
    run = tight[method]
    checks = [other for name, other in tight.items() if name != method]
    checks += [next_tight[method]] if method in next_tight else []
    until, whole = known_until(run, checks, REFERENCE_AGREEMENT)
    if horizon is not None:
        end = min(other["time"][-1] for other in [run, *checks])
        until, whole = min(horizon, end), horizon >= run["time"][-1]
    return Reference(run, until, whole, max(state_error(run, check, until) for check in checks), tuple(checks))


def match_times(reference: Sequence[float], found: Sequence[float], until: float = np.inf) -> list[tuple[int, int]]:
    """Pairs (index in reference, index in found) of times that are mutually nearest, and closer than half the distance of the
    reference time to its nearest neighbour. Reference times beyond `until` are left out."""
    a, b = np.asarray(reference, dtype=float), np.asarray(found, dtype=float)
    if a.size == 0 or b.size == 0:
        return []
    pairs = []
    for i in np.flatnonzero(a <= until):
        j = int(np.abs(b - a[i]).argmin())
        if int(np.abs(a - b[j]).argmin()) != i:
            continue
        others = np.delete(a, i)
        room = np.abs(others - a[i]).min() / 2 if others.size else np.inf
        if abs(b[j] - a[i]) <= room:
            pairs.append((int(i), j))
    return pairs


def impact_times(run: Run) -> np.ndarray:
    return run.events.loc[run.events["event"] == "contact_begins", "time"].to_numpy(dtype=float)


def pin_force(run: Run) -> np.ndarray:
    """Force on the pin [N]; of a bearing by itself, that of its film."""
    force = "pin_force" if "pin_force_x" in run else "film_force"
    return np.hypot(run[f"{force}_x"], run[f"{force}_y"])


def peak_force(run: Run, until: float) -> float:
    """Largest pin force up to a time [N]: of the rows, and of the contacts that have ended, whose largest force may lie between
    rows."""
    inside = run["time"] <= until
    peaks = [pin_force(run)[inside].max()]
    ended = run.events[(run.events["event"] == "contact_ends") & (run.events["time"].astype(float) <= until)]
    return float(np.nanmax([*peaks, *ended["max_normal_force"].astype(float)]))


def least_film(run: Run, until: float) -> float:
    """Smallest film thickness up to a time [m], negative in contact; NaN with an ideal joint."""
    if "film_thickness" not in run:
        return np.nan
    ended = run.events[(run.events["event"] == "contact_ends") & (run.events["time"].astype(float) <= until)]
    return float(np.nanmin([*run["film_thickness"][run["time"] <= until], *-ended["max_penetration"].astype(float)]))


def turn_statistics(run: Run, after: float) -> dict[str, float]:
    """Statistics of a chaotic motion from a time on: means over whole crank revolutions."""
    turn = np.floor(np.abs(run["crank_angle"] - run["crank_angle"][0]) / (2 * np.pi) + 1e-9)
    first = turn[np.searchsorted(run["time"], after)] + 1 if after < run["time"][-1] else turn[-1]
    inside = (turn >= first) & (turn < turn[-1] + (turn[-1] == 0))
    if inside.sum() < 2:
        inside = run["time"] >= 0  # the run is too short: use all of it
    time = run["time"][inside]
    force = pin_force(run)[inside]
    impacts = impact_times(run)
    turns = max(float(np.ptp(run["crank_angle"][inside])) / (2 * np.pi), 1e-9)
    found = {
        "mean_speed": float(np.ptp(run["crank_angle"][inside])) / float(np.ptp(time)),
        "mean_force": float(force.mean()),
        "impacts_per_turn": float(((impacts >= time[0]) & (impacts <= time[-1])).sum()) / turns,
    }
    found["contact_share"] = float((run["phase"][inside] == 2).mean()) if "phase" in run else 0.0
    return found


def measure(reference: Reference, run: Run) -> dict[str, float]:
    """The errors of a run, by the columns of the table; beyond the horizon the differences of its statistics."""
    until = reference.horizon
    expected, found = impact_times(reference.run), impact_times(run)
    pairs = match_times(expected, found, until)
    late = [abs(found[j] - expected[i]) for i, j in pairs]
    force, film = peak_force(reference.run, until), least_film(reference.run, until)
    return {
        "state_error": state_error(reference.run, run, until),
        "agrees_until": known_until(reference.run, [run], compare.AGREEMENT)[0],
        **{f"digits_{n}_until": known_until(reference.run, [run], 10.0**-n)[0] for n in (3, 6)},
        **turn_statistics(run, 0.0 if reference.whole else until),
        "impacts": int((expected <= until).sum()),
        "impacts_matched": len(pairs),
        "impacts_extra": int((found <= until).sum()) - sum(1 for _, j in pairs if found[j] <= until),
        "impact_time_error": max(late, default=0.0),
        "peak_force_error": abs(peak_force(run, until) - force) / force if force else 0.0,
        "least_film_error": abs(least_film(run, until) - film) / abs(film) if film else np.nan,
        "energy_residual": float(run.summary["max_energy_residual_relative"][0]),
        "evaluations": int(run.summary["rhs_evaluations"][0]),
    }


def pareto_front(cost: Sequence[float], error: Sequence[float]) -> list[int]:
    """Indices, by rising cost, of the points on the Pareto front: no other point has at most the same cost and at most the same
    error. Of equal points the first is kept; points that are not finite are left out."""
    cost, error = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    front: list[int] = []
    for i in np.lexsort((error, cost)):
        if np.isfinite(cost[i]) and np.isfinite(error[i]) and (not front or error[i] < error[front[-1]]):
            front.append(int(i))
    return front


def cheapest(table: pd.DataFrame, digits: int) -> pd.Series | None:
    """The fastest run whose states are right to so many digits, and that has the same impacts as the reference."""
    good = table[
        (table["status"] == "done")
        & (table["state_error"] <= 10.0**-digits)
        & (table["impacts_matched"] == table["impacts"])
        & (table["impacts_extra"] == 0)
    ]
    return None if good.empty else good.loc[good["seconds"].idxmin()]


def settings_of(row: pd.Series) -> Settings:
    return Settings(
        str(row["variant"]),
        row["method"],
        int(row["max_order"]),
        row["contact_entry"],
        float(row["max_penetration"]),
        float(row["tolerance"]),
        int(row["points"]),
    )


def recommendation(table: pd.DataFrame, reference: Reference, digits: Sequence[int]) -> list[str]:
    """For each number of digits: the recommended settings and their cost."""
    lines = []
    for count in digits:
        best = cheapest(table, count)
        if reference.error > 10.0**-count:
            lines.append(f"for {count} digits: unknown, because the error of the reference itself is {reference.error:.1e}")
        elif best is None:
            lines.append(f"for {count} digits: none of these settings")
        else:
            lines.append(
                f"for {count} digits use {settings_of(best)}: {best['seconds']:.2g} s,"
                f" {best['evaluations']:.0f} evaluations"
                f" (state {best['state_error']:.0e}, impact times {best['impact_time_error']:.0e} s,"
                f" peak force {best['peak_force_error']:.0e}, smallest film thickness {best['least_film_error']:.0e})"
            )
    return lines


def markdown(name: str, table: pd.DataFrame, reference: Reference, digits: Sequence[int]) -> list[str]:
    """Rows of the table in data/measured/tradeoff.md."""
    end = float(reference.run["time"][-1])
    known = f"{reference.error:.0e} up to {1e3 * reference.horizon:.3g} of {1e3 * end:.3g} ms"
    rows = []
    for count in digits:
        best = cheapest(table, count) if reference.error <= 10.0**-count else None
        answer = "none | | |"
        if best is not None:
            cost = f"{1e3 * best['seconds']:.2g} | {best['evaluations']:.0f}"
            answer = f"{settings_of(best)} | {cost} | {best['state_error']:.0e}"
        rows.append(f"| `{name}` | {known} | {count} | {answer} |")
    return rows


#: The accuracy levels of the command line, and the share of a state's range that each is meant for.
LEVELS = {"draft": 1e-2, "standard": 1e-4, "reference": 1e-8}


def level_cell(reference: Reference, run: Run, promise: float) -> str:
    """Result of an accuracy level: the state error over the whole run, or the time up to which a motion with impacts is as
    accurate."""
    evaluations = int(run.summary["rhs_evaluations"][0])
    error = state_error(reference.run, run, reference.horizon) if moving_states(reference.run) else 0.0
    cost = f"{evaluations / 1000:.3g}k" if evaluations >= 1000 else str(evaluations)
    if reference.whole or error <= promise:
        return f"{error:.0e}, {cost}"
    until = min(known_until(reference.run, [run], promise)[0], reference.known(promise))
    return f"{promise:.0e} for {1e3 * until:.3g} ms, {cost}"


#: Errors that the picture shows: column, label.
ERRORS = (
    ("state_error", "largest state error / its range"),
    ("peak_force_error", "error of the largest pin force / it"),
)


def draw(table: pd.DataFrame, reference: Reference, title: str) -> Drawing:
    """Errors over evaluations, which do not depend on the load of the machine as times do, with the Pareto fronts."""
    done = table[(table["status"] == "done") & np.isfinite(table["state_error"])].reset_index(drop=True)
    drawing, axes = plt.subplots(1, len(ERRORS), figsize=(WIDTH, 3.6))
    for axis, (error, label) in zip(axes, ERRORS):
        axis.set(xscale="log", yscale="log")
        for method, colour in COLOURS.items():
            for entry, filled in (("root", True), ("step_rejection", False)):
                rows = done[(done["method"] == method) & (done["contact_entry"] == entry)]
                if not rows.empty:
                    axis.scatter(
                        rows["evaluations"],
                        rows[error].clip(lower=1e-16),
                        s=6 + 1.2 * rows["max_order"],
                        marker=MARKERS[method],
                        facecolors=colour if filled else "none",
                        edgecolors=colour,
                        linewidths=0.6,
                        alpha=0.75,
                        label=method if filled else f"{method}, step rejection",
                    )
        front = done.loc[pareto_front(done["evaluations"], done[error])]
        axis.plot(front["evaluations"], front[error].clip(lower=1e-16), color=BLACK, drawstyle="steps-post", label="Pareto front")
        if error == "state_error":
            axis.axhline(max(reference.error, 1e-16), color=GREY, linestyle=":", label="the reference's own error")
        axis.set_xlabel("evaluations of the right-hand side")
        axis.set_ylabel(label)
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.margins(0.05)
    until = "to the end" if reference.whole else f"up to {1e3 * reference.horizon:.4g} ms"
    drawing.suptitle(f"{title}: error {until} against cost; larger markers: higher max_order")
    return drawing
