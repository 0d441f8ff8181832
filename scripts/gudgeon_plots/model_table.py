"""The table and the picture of what each model changes."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from .model_effects import QUANTITIES, Outcome, Search, change, largest_change, percent, scale_of
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, WIDTH

COLOURS = {"taken out": VERMILION, "exchanged": BLUE, "refined": GREEN, "added": ORANGE, "fullest": PURPLE, "cheapest": PURPLE}
SMALLEST = 1e-3  # smallest change that the picture shows [%]


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
    """The table and the answer; `file`: the case's, as a command would name it."""
    given = outcomes[0]
    shown = [quantity for quantity in QUANTITIES if quantity in given.values]
    lines = [
        "One model at a time is taken out, exchanged, refined or added; method auto integrates all scenes. The cost is given as the number of",
        "evaluations of the right-hand side and the processor time, both divided by those of the case; the time is the shortest of three runs.",
        "The changes refer to the whole run: those of the peak force at the piston pin, of the loss per revolution and of the mean crank speed",
        "are relative to the value of the case, that of the minimum film thickness is relative to the clearance, and that of the contact share",
        "is in per cent of the time. After ± stands the uncertainty of the change, by the certificates of both scenes, where it is at least a",
        "tenth of the change. `-`: the scene does not have the quantity.",
        "",
        "| # | | scene | evaluations | time | " + " | ".join(QUANTITIES[one].label for one in shown) + " | certificate |",
        "|---|---|---|---|---|" + "---|" * (len(shown) + 1),
    ]
    idle = idle_scenes(outcomes)
    for number, outcome in enumerate(outcomes):
        if not outcome.is_there or number in idle:
            continue
        cells = [str(number), outcome.variant.kind, outcome.variant.label + (" *" if outcome.variant.assumed else "")]
        cells += [ratio(outcome.evaluations, given.evaluations), ratio(outcome.seconds, given.seconds)]
        if number == 0:
            cells[3:5] = [str(given.evaluations), f"{given.seconds:.2g} s"]
            cells += [figure(one, given) for one in shown]
        else:
            cells += [percent(change(one, given, outcome)) for one in shown]
        lines.append("| " + " | ".join([*cells, outcome.certificate]) + " |")
    lines.append("")
    if idle:
        lines += ["No effect at all in this case: " + ", ".join(f"{n} ({outcomes[n].variant.label})" for n in idle) + ".", ""]
    if assumed := [f"{n}: {one.variant.assumed}" for n, one in enumerate(outcomes) if one.is_there and one.variant.assumed and n not in idle]:
        lines += ["\\* Assumed, since the case does not give it: " + "; ".join(assumed) + ".", ""]
    if refused := [(outcome.variant.label, outcome.refusal) for outcome in outcomes if not (outcome.is_there or outcome.is_no_choice)]:
        lines += ["Not possible with this case:", "", *(f"- {label}: {why}" for label, why in refused), ""]
    return "\n".join([*lines, *answer(search, given, names, limit, file)]) + "\n"


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
    lines = ["## What this scene requires", ""]
    parts = ", ".join(part.label for part in search.parts) or "nothing beyond the case"
    lines += [f"The most complete scene is the case with: {parts}. It takes {cost(search.fullest, given)} of the case.", ""]
    changes = ", ".join(f"{QUANTITIES[name].label} {percent(change(name, search.fullest, given))}" for name in told)
    lines += [f"The case as it is differs from it: {changes}.", ""]
    changes = ", ".join(f"{QUANTITIES[name].label} {percent(change(name, search.fullest, search.cheapest))}" for name in told)
    lines += [
        f"The cheapest scene found within {100 * limit:g} % of the most complete one ({', '.join(QUANTITIES[name].label for name in told)}) takes"
        f" {cost(search.cheapest, given)} of the case: {changes}.",
        "",
        "    " + " ".join(["gudgeon", file, *(f"--set {setting}" for setting in ("integrator.method=auto", *search.cheapest.variant.settings))]),
        "",
    ]
    if search.left_out:
        lines += ["Left out of the most complete scene, one after the other: " + "; ".join(label.removeprefix("without: ") for label in search.left_out) + ".", ""]
    if search.needed:
        lines += ["Needed, or tried without any saving:", "", *(f"- {label}: {why}" for label, why in search.needed), ""]
    open_ones = [name for name in told if search.fullest.uncertainty[name] > limit * scale_of(name, search.fullest)]
    if open_ones:
        words = ", ".join(QUANTITIES[name].label for name in open_ones)
        lines += [f"By its certificate, the most complete scene itself is uncertain by more than {100 * limit:g} % in: {words}.", ""]
    return lines


def cost(outcome: Outcome, given: Outcome) -> str:
    return f"{ratio(outcome.evaluations, given.evaluations)} times the evaluations and {ratio(outcome.seconds, given.seconds)} times the time"


def draw_largest(axis: Axes, points: list[tuple[str, str, Outcome]], shown: list[str], given: Outcome, limit: float) -> None:
    """The largest change of all quantities against the evaluations."""
    for number, kind, outcome in points:
        largest = largest_change(shown, given, outcome)
        if largest < float("inf"):
            draw_point(axis, number, kind, outcome.evaluations / given.evaluations, largest)
    finish(axis, "largest of these", limit)


def draw_point(axis: Axes, number: str, kind: str, cost: float, change: float, label: str | None = None) -> None:
    """A scene with its number; `change` as a fraction."""
    where = (cost, max(SMALLEST, 100 * change))
    axis.plot(*where, "o", color=COLOURS.get(kind, GREY), markersize=3, label=label)
    axis.annotate(number, where, xytext=(2, 2), textcoords="offset points", fontsize=5)


def finish(axis: Axes, title: str, limit: float) -> None:
    axis.axhline(100 * limit, color=GREY, linestyle="--", linewidth=0.6)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_title(title)
    axis.set_ylabel("change [%]")


def draw(name: str, outcomes: list[Outcome], search: Search, names: list[str], limit: float) -> Drawing:
    """Cost against the change of each quantity; a scene has its number of the table."""
    given = outcomes[0]
    shown = [one for one in names if one in given.values]
    drawing, axes = plt.subplots((len(shown) + 1) // 2, 2, figsize=(WIDTH, 0.7 + 2.2 * ((len(shown) + 1) // 2)), squeeze=False)
    idle = idle_scenes(outcomes)
    points = [(str(n), one.variant.kind, one) for n, one in enumerate(outcomes) if n and one.is_there and n not in idle]
    points += [("F", "fullest", search.fullest), ("C", "cheapest", search.cheapest)]
    kinds = []
    for axis, quantity in zip(axes.flat, shown):
        for number, kind, outcome in points:
            found = change(quantity, given, outcome)
            if found is None:
                continue
            first = kind not in kinds and kind != "cheapest"
            if first:
                kinds.append(kind)
            label = {"fullest": "F most complete, C cheapest"}.get(kind, kind) if first else None
            draw_point(axis, number, kind, outcome.seconds / given.seconds, abs(found[0]), label)
        finish(axis, QUANTITIES[quantity].label, limit)
    for axis in list(axes.flat)[len(shown) :]:  # where no quantity is drawn
        draw_largest(axis, points, shown, given, limit)
    for axis in axes.flat[: len(shown)]:
        axis.set_xlabel("processor time over that of the case")
    for axis in axes.flat[len(shown) :]:
        axis.set_xlabel("evaluations over those of the case")
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    drawing.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    drawing.suptitle(f"{name}: what each model costs and changes (no change: at {SMALLEST:g} %)")
    return drawing
