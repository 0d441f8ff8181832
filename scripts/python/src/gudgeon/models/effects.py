"""What each model changes: runs a case's variants, compares the user's quantities, and looks for the cheapest scene that will do."""

import re
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from gudgeon import language
from gudgeon.models.variants import (
    Case,
    Key,
    Variant,
    case_name,
    completed,
    read_template,
    together,
    variants_of,
)
from gudgeon.results import MissingResult, read_case, read_summary

MOST_COMPLETIONS = 8
NOISE = 0.03  # of costs: an exchange must save more, a scene that is simpler may cost no more
REPEATS = 3  # of runs shorter than LONG
LONG = 1.0  # [s]
LEAST_PERCENT = 0.005  # less is shown as 0


@dataclass(frozen=True)
class Quantity:
    """A quantity that the user selects, and the form in which its change is reported."""

    name: str
    label: str
    source: str  # in the summary
    measure: str  # "relative"; "clearance": over the clearance; "share": as it is
    unit: str = ""


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("peak_force", "peak force", "max_pin_force", "relative", "N"),
        Quantity("contact_share", "contact share", "contact_time_fraction", "share"),
        Quantity("min_film", "minimum film", "min_film_thickness", "clearance", "m"),
        Quantity("loss", "loss", "", "relative", "J"),  # from the work in the last whole cycle, see loss_of
        Quantity("mean_speed", "mean speed", "mean_crank_speed", "relative", "rad/s"),
    )
}


@dataclass
class Outcome:
    """What came of one scene."""

    variant: Variant
    refusal: str = ""  # why there is none
    values: dict[str, float] = field(default_factory=dict)  # by quantity
    uncertainty: dict[str, float] = field(default_factory=dict)  # in the quantity's own unit, by its certificate
    certificate: str = ""
    evaluations: int = 0
    seconds: float = 0.0  # of processor
    clearance: float = 0.0

    @property
    def is_there(self) -> bool:
        return not self.refusal

    @property
    def is_no_choice(self) -> bool:
        """Whether the program refused a word that belongs to another law."""
        key = self.variant.settings[0].split("=")[0].split(".")[-1] if self.variant.settings else ""
        return f" {key} = " in self.refusal and ": must be one of " in self.refusal


def processor_time() -> float:
    """Of all programs run so far [s]; the sum is exact, its parts are sampled."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Laboratory:
    """Runs one case in variants."""

    def __init__(self, case: Path, program: Path, settings: list[str], timeout: float, say: Callable[[str], None]) -> None:
        self.file, self.program, self.settings, self.timeout, self.say = case, program, settings, timeout, say
        printed = subprocess.run([program, "--template"], capture_output=True, text=True, check=True).stdout
        self.template: dict[str, dict[str, Key]] = read_template(printed)
        self.folder = Path(tempfile.mkdtemp(prefix="gudgeon_models_"))
        self.case: Case = {}

    def close(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, settings: tuple[str, ...], *more: str) -> tuple[int, str, float]:
        """Exit status, messages, and processor time [s]; -1 if it took too long."""
        words = [str(self.program), "-q", "-o", str(self.folder), *more]
        for setting in (*self.settings, "output.ideal_twin=F", "output.answers=T", "run.lyapunov_revolutions=0", *settings):
            words += ["--set", setting]
        before = processor_time()
        try:
            done = subprocess.run([*words, str(self.file)], capture_output=True, text=True, check=False, timeout=self.timeout)
        except subprocess.TimeoutExpired:
            return -1, f"not done in {self.timeout:g} s", 0.0
        return done.returncode, done.stderr.strip(), processor_time() - before

    def read_base(self) -> list[Variant]:
        """Run the case as it is; its variants. Raises MissingResult where it cannot be run."""
        status, said, _ = self.run(())
        if status != 0:
            raise MissingResult(said or f"{self.file}: no run")
        self.case = read_case(self.folder / f"{case_name(self.file)}.resolved.nml")
        return variants_of(self.case, self.template)

    def measure(self, variant: Variant) -> Outcome:
        """Run a variant, with its certificate; its cost is the least of some runs without."""
        self.say(variant.label)
        for _ in range(MOST_COMPLETIONS):
            status, said, _ = self.run(variant.settings, "--certify")
            if status != 3:
                break
            better = completed(variant, said, self.case, self.template)
            if better is None:
                break
            variant = better
        if status != 0:
            return Outcome(variant, refusal=short(said))
        base = self.folder / case_name(self.file)
        summary = {name: value for name, (value, _) in read_summary(base.with_name(f"{base.name}.summary.csv")).items()}
        resolved = read_case(base.with_name(f"{base.name}.resolved.nml"))
        outcome = Outcome(variant, evaluations=int(summary["rhs_evaluations"]), certificate=certificate_of(summary))
        joint = resolved["joint"]
        outcome.clearance = float(joint["clearance"]) if joint.get("kind", "ideal") != "ideal" else 0.0
        for quantity in QUANTITIES.values():
            if quantity.name == "loss" and "cycle_revolutions" in summary:
                outcome.values["loss"], outcome.uncertainty["loss"] = loss_of(summary)
            elif quantity.source in summary:
                outcome.values[quantity.name] = float(summary[quantity.source])
                outcome.uncertainty[quantity.name] = float(summary.get(f"{quantity.source}_difference", "nan"))
        outcome.seconds = self.run(variant.settings)[2]
        for _ in range(REPEATS - 1 if outcome.seconds < LONG else 0):
            outcome.seconds = min(outcome.seconds, self.run(variant.settings)[2])
        return outcome


def loss_of(summary: dict[str, str]) -> tuple[float, float]:
    """Energy that the joints take from the bodies in a revolution of the last whole cycle, and its uncertainty [J]."""
    parts = [name for name in summary if re.search(r"cycle_work_(contact|friction|film|asperities)$", name)]
    revolutions = float(summary["cycle_revolutions"])
    duration = float(summary["cycle_duration"])
    loss = -sum(float(summary[name]) for name in parts)
    uncertainty = sum(float(summary.get(f"{name}_difference", "nan")) for name in parts)
    for name in summary:  # bearings of kind quasi_static do no work on the bodies
        if (match := re.match(r"(.*)cycle_mean_(film|friction)_power$", name)) and f"{match[1]}cycle_work_film" not in summary:
            loss += duration * float(summary[name])
            uncertainty += duration * float(summary.get(f"{name}_difference", "nan"))
    return loss / revolutions, uncertainty / revolutions


def short(said: str) -> str:
    """The program's first complaint without its name and the case's."""
    lines = [line for line in said.splitlines() if line.startswith("gudgeon: ")]
    return (lines[0].split(": ", 2)[-1] if lines else said.splitlines()[0] if said else "no result").strip()


def certificate_of(summary: dict[str, str]) -> str:
    if "certified_until" not in summary:
        return summary.get("certificate", "none").replace("not certified: ", "none: ")
    until, end = float(summary["certified_until"]), float(summary["simulated_time"])
    digits = f"{float(summary['certified_digits']):.1f} digits"
    return f"{digits} to the end" if until >= end * (1 - 1e-9) else f"{digits} to {100 * until / end:.2g} % of the time"


def scale_of(name: str, outcome: Outcome) -> float:
    """What a change of a quantity is divided by; 0 where there is nothing to divide by."""
    measure = QUANTITIES[name].measure
    return abs(outcome.values[name]) if measure == "relative" else outcome.clearance if measure == "clearance" else 1.0


def change(name: str, reference: Outcome, other: Outcome) -> tuple[float, float] | None:
    """Change of a quantity from a reference, and its uncertainty by both certificates; None where one of them does not have it."""
    if name not in reference.values or name not in other.values:
        return None
    was, value = reference.values[name], other.values[name]
    scale = scale_of(name, reference)
    if QUANTITIES[name].measure == "relative":
        scale = max(scale, 1e-12 * abs(value))
    if not scale:
        return (0.0, 0.0) if value == was else None
    return (value - was) / scale, (reference.uncertainty[name] + other.uncertainty[name]) / scale


def will_do(names: list[str], limit: float, reference: Outcome, other: Outcome) -> bool:
    """Whether a scene gives every quantity within the limit, or within the accuracy of both certificates."""
    for name in names:
        if name not in reference.values:
            continue
        found = change(name, reference, other)
        if found is None or abs(found[0]) > max(limit, found[1]):
            return False
    return True


def fullest(laboratory: Laboratory, outcomes: list[Outcome]) -> tuple[Outcome, list[Variant]]:
    """The scene with every refinement and addition that runs, and what is in it; one that cannot be joined to the others is left out."""
    parts: list[Variant] = []
    base = Variant("given", "the case as it is", ())
    found = None
    candidates = [outcome.variant for outcome in outcomes if outcome.variant.fuller and outcome.is_there]
    if candidates:
        found = laboratory.measure(joined(candidates, "most complete scene"))
        if found.is_there:
            return found, candidates
    for candidate in candidates:
        trial = laboratory.measure(joined([*parts, candidate], "most complete scene so far"))
        if trial.is_there:
            parts, found = [*parts, candidate], trial
    return (found if parts and found else laboratory.measure(base)), parts


def joined(parts: list[Variant], label: str) -> Variant:
    return Variant("together", label, together(*parts), "; ".join(part.assumed for part in parts if part.assumed))


@dataclass
class Search:
    """The way from the most complete scene to the cheapest one that will do."""

    fullest: Outcome
    parts: list[Variant]
    cheapest: Outcome
    left_out: list[str] = field(default_factory=list)  # of the fullest, or of the case
    needed: list[tuple[str, str]] = field(default_factory=list)  # and why


def find_cheapest(laboratory: Laboratory, outcomes: list[Outcome], names: list[str], limit: float) -> Search:
    """Take from the most complete scene what changes the quantities by less than the limit and saves time: the parts that make it fuller
    than the case, then models of the case, and exchanges that are cheaper, those that save most first."""
    top, parts = fullest(laboratory, outcomes)
    search = Search(top, parts, top)
    kept, changes = list(parts), []
    given = outcomes[0]

    def consider(kept_now: list[Variant], changes_now: list[Variant], label: str, is_simpler: bool) -> bool:
        trial = laboratory.measure(joined([*kept_now, *changes_now], label))
        if not trial.is_there:
            search.needed.append((label, trial.refusal))
            return False
        if not will_do(names, limit, top, trial):
            worst = max((name for name in names if name in top.values), key=lambda name: size_of(change(name, top, trial)))
            search.needed.append((label, f"{language.current.say(QUANTITIES[worst].label)} {language.current.number(percent(change(worst, top, trial)))}"))
            return False
        if not saves(search.cheapest, trial, is_simpler):
            search.needed.append((label, language.current.say("saves nothing")))
            return False
        search.cheapest = trial
        search.left_out.append(label)
        return True

    cost = {outcome.variant.label: outcome.seconds for outcome in outcomes if outcome.is_there}
    for part in sorted(parts, key=lambda part: -cost.get(part.label, 0.0)):
        rest = [other for other in kept if other.label != part.label]
        if consider(rest, changes, f"without: {part.label}", True):
            kept = rest
    simpler = [
        outcome
        for outcome in outcomes[1:]
        if outcome.is_there
        and not outcome.variant.fuller
        and outcome.variant.kind in ("taken out", "exchanged")
        and will_do(names, 2 * limit, given, outcome)
        and saves(given, outcome, is_simplification(outcome))
    ]
    for outcome in sorted(simpler, key=lambda outcome: outcome.seconds):
        touched = {setting.split("=")[0] for setting in outcome.variant.settings}
        if any(setting.split("=")[0] in touched for other in changes for setting in other.settings):
            continue
        if consider(kept, [*changes, outcome.variant], outcome.variant.label, is_simplification(outcome)):
            changes = [*changes, outcome.variant]
    return search


def is_simplification(outcome: Outcome) -> bool:
    return outcome.variant.kind == "taken out" and "held" not in outcome.variant.label


def saves(before: Outcome, after: Outcome, is_simpler: bool) -> bool:
    """Whether a scene is useful: simpler without costing more, or cheaper in both evaluations and time."""
    if is_simpler:
        return after.evaluations <= (1 + NOISE) * before.evaluations or after.seconds < (1 - NOISE) * before.seconds
    return after.evaluations < (1 - NOISE) * before.evaluations and after.seconds < (1 + NOISE) * before.seconds


def size_of(found: tuple[float, float] | None) -> float:
    return abs(found[0]) if found else float("inf")


def percent(found: tuple[float, float] | None) -> str:
    """A change with its uncertainty, where that is as much as a tenth of what is shown."""
    if found is None:
        return "-"
    value, uncertainty = 100 * found[0], 100 * found[1]
    shown = "0 %" if abs(value) < LEAST_PERCENT else f"{value:+.0f} %" if abs(value) >= 100 else f"{value:+.2g} %"
    if uncertainty != uncertainty:
        return f"{shown} ± ?"
    return shown if uncertainty < max(LEAST_PERCENT, 0.1 * abs(value)) else f"{shown} ± {uncertainty:.1g}"
