"""The measured table of extreme scenes, data/measured/extremes.md: outcomes by axis, reasons, worst errors, and each reported scene."""
from __future__ import annotations

import collections
import dataclasses
import re
from collections.abc import Callable

from .verdict import Verdict

SHARES = (0.5, 0.75, 0.9, 0.99, 1.0)
LONGEST = 400   # largest number of characters of a reason that are shown

FIGURES: dict[str, Callable[[Verdict], float | None]] = {
    "energy missing, relative": lambda v: v.energy.plain if v.energy else None,
    "quadrature known to, relative": lambda v: v.energy.bound if v.energy else None,
    "state off the other method's, grown tolerances": lambda v: v.states.tolerances if v.states and not v.states.unjudged else None,
    "statistics, of what chance allows": lambda v: max(v.states.statistics.values()) if v.states and v.states.has_statistics else None,
}


@dataclasses.dataclass
class Result:
    """The result of one scene."""

    number: int
    axes: str
    case: str
    outcome: str
    reason: str
    residual: float | None   # largest relative energy residual, if the run has one

    @property
    def row(self) -> str:
        """The row of the table in which it is counted: all combinations share one."""
        return "combinations" if " + " in self.axes else self.axes


def percentiles(values: list[float]) -> list[str]:
    """For each of the SHARES, the value that this share of the values does not exceed."""
    values = sorted(values)
    return [f"{values[min(int(share * len(values)), len(values) - 1)]:.2g}" for share in SHARES]


def figures_of(verdicts: list[Verdict]) -> dict[str, list[float]]:
    """The values of each measured error in the judged scenes, by its name; errors without values are left out."""
    found = {name: [value for value in map(figure, verdicts) if value is not None] for name, figure in FIGURES.items()}
    return {name: values for name, values in found.items() if values}


def counts_of(results: list[Result]) -> dict[str, collections.Counter]:
    """The number of scenes with each outcome, for each axis and for all."""
    counts: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
    for one in results:
        counts[one.row][one.outcome] += 1
        counts["all"][one.outcome] += 1
    return counts


def judged_text(verdicts: list[Verdict], scenes: int) -> str:
    """The number of judged scenes, and by which checks they were judged."""
    return (f"judged independently: {sum(bool(one.checks) for one in verdicts)} of {scenes} scenes, "
            f"integrals in {sum(one.energy is not None for one in verdicts)}, "
            f"states by the other method in {sum(one.states is not None and not one.states.unjudged for one in verdicts)}, "
            f"statistics beyond their horizon in {sum(one.states is not None and one.states.has_statistics for one in verdicts)}")


def without_numbers(reason: str) -> str:
    """A reason without the numbers of its run and without the place in brackets, so that equal reasons are counted together."""
    return re.sub(r"after [\d.]+ of \d+ revolutions", "before its last revolution", reason)


def row(*cells: object) -> str:
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"


def markdown(results: list[Result], verdicts: list[Verdict], order: list[str], outcomes: tuple[str, ...], never: tuple[str, ...],
             again: str) -> str:
    """The whole table. `order`: the axes; `outcomes`: all of them; `never`: those that must not be; `again`: the command of one scene."""
    counts = counts_of(results)
    residuals = [one.residual for one in results if one.outcome == "finished" and one.residual is not None]
    text = [f"{len(results)} scenes at the ends of every range: the first half on one axis each, the others on two to five axes. A scene finishes, "
            "stops with exit status 4 and a reason, or is refused with exit status 3; the other six outcomes must not occur. What each of them "
            "means is on the page of the tests, [tests/README.md](../../tests/README.md).", "",
            row("axis", *outcomes), "|---" * (len(outcomes) + 1) + "|"]
    text += [row(name, *(counts[name][outcome] for outcome in outcomes)) for name in [*order, "combinations", "all"] if name in counts]
    text += ["", "Largest errors. The energy residual is that of every finished run, as the program states it; the others are those of the "
             f"independent judge ({judged_text(verdicts, len(results))}). The state is compared with that of the other method in units of an initial "
             "error of one tolerance, as it grows along the motion; up to 100 of these are allowed for each revolution.", "",
             row("not exceeded in", *(f"{100 * share:.0f} %" for share in SHARES[:-1]), "all"), "|---" * (len(SHARES) + 1) + "|"]
    if residuals:
        text.append(row("energy residual of finished runs, relative", *percentiles(residuals)))
    text += [row(name, *percentiles(values)) for name, values in figures_of(verdicts).items()]
    reasons = collections.Counter(without_numbers(one.reason) for one in results if one.outcome == "stopped")
    text += ["", "Why runs stopped:", "", row("runs", "reason"), "|---|---|"]
    text += [row(number, reason.rstrip("; ")) for reason, number in reasons.most_common()]
    reported = sorted((one for one in results if one.outcome in never), key=lambda one: one.number)
    text += ["", f"Reported scenes: {len(reported) or 'none'}." + (f" `{again}` shows scene N." if reported else "")]
    if reported:
        text += ["", row("scene", "axes", "case", "outcome", "what is reported"), "|---|---|---|---|---|"]
        text += [row(one.number, one.axes, f"`{one.case}`", one.outcome, one.reason[:LONGEST].replace("\n", " ")) for one in reported]
    return "\n".join(text)
