"""The table and the picture of what each model changes."""

import matplotlib.pyplot as plt
import pandas as pd
from gudgeon import language
from gudgeon.models.effects import (
    QUANTITIES,
    Outcome,
    Search,
    change,
    percent,
    scale_of,
)
from gudgeon.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, WIDTH
from matplotlib.figure import Figure as Drawing
from matplotlib.patches import Patch

COLOURS = {"taken out": VERMILION, "exchanged": BLUE, "refined": GREEN, "added": ORANGE}
SMALLEST, LARGEST = 1e-2, 1e3  # changes that the picture shows [%]; larger ones are at its edge


INTRODUCTION = """\
One model at a time is taken out, exchanged, refined or added; method auto integrates all scenes. The cost is given as the number of
evaluations of the right-hand side and the processor time, both divided by those of the case; the time is the shortest of three runs.
The changes refer to the whole run, that of the loss to a revolution of the last whole cycle: those of the peak force at the piston
pin, of the loss and of the mean crank speed are relative to the value of the case, that of the minimum film thickness is relative to
the clearance, and that of the contact share is in per cent of the time. After ± stands the uncertainty of the change, by the
certificates of both scenes, where it is at least a tenth of the change. `-`: the scene does not have the quantity."""


def as_data(outcomes: list[Outcome]) -> pd.DataFrame:
    """All figures, one row a scene; changes are those from the first."""
    given = outcomes[0]
    rows = []
    for number, outcome in enumerate(outcomes):
        variant = outcome.variant
        row = {"number": number, "kind": variant.kind, "scene": variant.label, "settings": " ".join(variant.settings)}
        row |= {"assumed": variant.assumed, "refusal": outcome.refusal}
        if outcome.is_there:
            row |= {"evaluations": outcome.evaluations, "processor_time[s]": outcome.seconds}
            for name in QUANTITIES:
                found = change(name, given, outcome)
                row |= {name: outcome.values.get(name), f"{name}_difference": outcome.uncertainty.get(name)}
                row |= {f"{name}_change": found[0] if found else None}
            row["certificate"] = outcome.certificate
        rows.append(row)
    return pd.DataFrame(rows)


def ratio(value: float, reference: float) -> str:
    return f"{value / reference:.2g}" if reference > 0 else "-"


def as_markdown(file: str, outcomes: list[Outcome], search: Search, names: list[str], limit: float) -> str:
    """The table and the answer, in the language of the pictures; `file`: the case's, as a command would name it."""
    say, given = language.current.say, outcomes[0]
    shown = [quantity for quantity in QUANTITIES if quantity in given.values]
    lines = [
        *say(INTRODUCTION).split("\n"),
        "",
        "| # | | " + " | ".join(say(head) for head in ("scene", "evaluations", "time", *(QUANTITIES[one].label for one in shown), "certificate")) + " |",
        "|---|---|---|---|---|" + "---|" * (len(shown) + 1),
    ]
    idle = idle_scenes(outcomes)
    for number, outcome in enumerate(outcomes):
        if not outcome.is_there or number in idle:
            continue
        cells = [str(number), outcome.variant.kind, say(outcome.variant.label) + (" *" if outcome.variant.assumed else "")]
        cells += [ratio(outcome.evaluations, given.evaluations), ratio(outcome.seconds, given.seconds)]
        if number == 0:
            cells[3:5] = [str(given.evaluations), f"{given.seconds:.2g} s"]
            cells += [figure(one, given) for one in shown]
        else:
            cells += [percent(change(one, given, outcome)) for one in shown]
        cells = [cells[0], say(cells[1]), cells[2], *map(say, cells[3:]), say(outcome.certificate)]
        lines.append("| " + " | ".join(cells) + " |")
    lines.append("")
    if idle:
        lines += [say("No effect at all in this case") + ": " + ", ".join(f"{n} ({say(outcomes[n].variant.label)})" for n in idle) + ".", ""]
    if assumed := [f"{n}: {spoken(one.variant.assumed)}" for n, one in enumerate(outcomes) if one.is_there and one.variant.assumed and n not in idle]:
        lines += [r"\* " + say("Assumed, since the case does not give it") + ": " + "; ".join(assumed) + ".", ""]
    if refused := [(say(outcome.variant.label), outcome.refusal) for outcome in outcomes if not (outcome.is_there or outcome.is_no_choice)]:
        lines += [say("Not possible with this case") + ":", "", *(f"- {label}: {why}" for label, why in refused), ""]
    return "\n".join([*lines, *answer(search, given, names, limit, file)]) + "\n"


def spoken(listed: str) -> str:
    """A list with commas, part by part in the language of the pictures; keys with their values stay."""
    pairs = (part.partition(" at ") if " = " in part else ("", "", part) for part in listed.split(", "))
    return ", ".join(f"{key}{at and ' '}{language.current.say(at.lstrip() + rest)}" for key, at, rest in pairs)


def idle_scenes(outcomes: list[Outcome]) -> list[int]:
    """Those in which nothing changes at all, because what they change never acts: laws of a contact that does not happen."""
    given = outcomes[0]
    found = []
    for number, outcome in enumerate(outcomes):
        if number == 0 or not outcome.is_there or outcome.values.keys() != given.values.keys():
            continue
        if all(abs(value - given.values[name]) <= 1e-9 * abs(value) for name, value in outcome.values.items()):
            found.append(number)
    return found


def figure(name: str, outcome: Outcome) -> str:
    return f"{outcome.values[name]:.4g} {QUANTITIES[name].unit}".strip()


def answer(search: Search, given: Outcome, names: list[str], limit: float, file: str) -> list[str]:
    """The cheapest scene within the limit of the fullest, and what was tried on the way."""
    told = [name for name in names if name in search.fullest.values]
    say, number = language.current.say, language.current.number

    def changes(outcome: Outcome) -> str:
        return ", ".join(f"{say(QUANTITIES[name].label)} {number(percent(change(name, search.fullest, outcome)))}" for name in told)

    labels = ", ".join(say(QUANTITIES[name].label) for name in told)
    lines = ["## " + say("What this scene requires"), ""]
    parts = ", ".join(say(part.label) for part in search.parts) or say("nothing beyond the case")
    lines += [f"{say('The most complete scene is the case with')}: {parts}. {say(f'It takes {cost(search.fullest, given)} of the case.')}", ""]
    lines += [f"{say('The case as it is differs from it')}: {changes(given)}.", ""]
    lines += [
        say(f"The cheapest scene found within {100 * limit:g} % of the most complete one") + f" ({labels}) "
        + say(f"takes {cost(search.cheapest, given)} of the case") + f": {changes(search.cheapest)}.",
        "",
        "    " + " ".join(["gudgeon", file, *(f"--set {setting}" for setting in ("integrator.method=auto", *search.cheapest.variant.settings))]),
        "",
    ]
    if search.left_out:
        lines += [say("Left out of the most complete scene, one after the other") + ": " + "; ".join(say(label.removeprefix("without: ")) for label in search.left_out) + ".", ""]
    if search.needed:
        lines += [say("Needed, or tried without any saving") + ":", "", *(f"- {say(label)}: {why}" for label, why in search.needed), ""]
    open_ones = [name for name in told if search.fullest.uncertainty[name] > limit * scale_of(name, search.fullest)]
    if open_ones:
        words = ", ".join(say(QUANTITIES[name].label) for name in open_ones)
        lines += [say(f"By its certificate, the most complete scene itself is uncertain by more than {100 * limit:g} % in") + f": {words}.", ""]
    return lines


def cost(outcome: Outcome, given: Outcome) -> str:
    return f"{ratio(outcome.evaluations, given.evaluations)} times the evaluations and {ratio(outcome.seconds, given.seconds)} times the time"


def draw(name: str, data: pd.DataFrame, names: list[str], limit: float) -> Drawing:
    """From the data of `as_data`: a row for each model, those that change most on top, with the change of each quantity and the processor
    time over that of the case. Models without any effect, and quantities that none changes, are left out."""
    rows = data[(data["number"] > 0) & data["evaluations"].notna()]
    changes = 100 * rows[[f"{one}_change" for one in names if f"{one}_change" in rows]].astype(float).abs()
    changes = changes.loc[:, changes.max() > SMALLEST]
    order = changes.max(axis=1).sort_values().index
    rows, changes = rows.loc[order], changes.loc[order]
    rows, changes = rows[changes.max(axis=1) > SMALLEST], changes[changes.max(axis=1) > SMALLEST]
    drawing, axes = plt.subplots(1, len(changes.columns) + 1, sharey=True, figsize=(WIDTH, 1.2 + 0.15 * len(rows)), squeeze=False)
    heights, colours = range(len(rows)), [COLOURS[kind] for kind in rows["kind"]]
    for axis, (column, values) in zip(axes.flat, changes.items()):
        axis.axvspan(SMALLEST, 100 * limit, color=GREY, alpha=0.18, linewidth=0)
        axis.scatter(values.where(values > SMALLEST).clip(upper=LARGEST), heights, c=colours, s=14, clip_on=False, zorder=3)
        axis.set(xscale="log", xlim=(SMALLEST, LARGEST), title=QUANTITIES[str(column).removesuffix("_change")].label)
        axis.set_xticks([0.01, 1, 100], ["0.01", "1", "100"])
        axis.set_xticks([], minor=True)
    axes[0, len(changes.columns) // 2].set_xlabel(f"change [%]; grey: below {100 * limit:g} %")
    times = rows["processor_time[s]"] / data["processor_time[s]"].iloc[0]
    cost = axes[0, -1]
    cost.barh(heights, times - 1, left=1, color=colours, height=0.6)
    cost.axvline(1, color=BLACK, linewidth=0.6)
    low, high = min(0.5, 0.9 * times.min()), max(2.0, 1.1 * times.max())
    cost.set(xscale="log", xlim=(low, high), title="time", xlabel="of the case")
    marks = [mark for mark in ((0.5, 1, 2, 5) if high / low < 30 else (0.01, 0.1, 1, 10, 100, 1000)) if low <= mark <= high]
    cost.set_xticks(marks, [f"{mark:g}" for mark in marks])
    cost.set_xticks([], minor=True)
    axes[0, 0].set_yticks(heights, rows["scene"])
    axes[0, 0].set_ylim(-0.7, len(rows) - 0.3)
    for axis in axes.flat:
        axis.tick_params(axis="y", length=0)
    kinds = [kind for kind in COLOURS if kind in set(rows["kind"])]
    drawing.legend([Patch(color=COLOURS[kind]) for kind in kinds], kinds, loc="outside lower center", ncols=len(kinds))
    many = int((changes.max(axis=1) > 100 * limit).sum())
    drawing.suptitle(f"{name}: {many} of {len(rows)} models change a result by more than {100 * limit:g} %, most of all: {rows['scene'].iloc[-1]}")
    return drawing
