"""The table and the picture of what each model changes."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from .model_effects import QUANTITIES, Outcome, Search, change, largest_change, percent
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
        "One model at a time is taken out, exchanged, refined or added; all scenes with method auto. Cost: evaluations of the right-hand",
        "side and processor time over those of the case (least of three runs). Changes are those of the whole run: of the peak force at the piston pin, the loss in",
        "a revolution and the mean crank speed relative, of the minimum film over the clearance, of the contact share in parts of the time.",
        "Behind ±: how far the certificates of both scenes leave the change open, where that is a tenth of it or more. `-`: that scene does",
        "not have the quantity.",
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
        lines += ["Of no effect at all here: " + ", ".join(f"{n} ({outcomes[n].variant.label})" for n in idle) + ".", ""]
    if assumed := [f"{n}: {one.variant.assumed}" for n, one in enumerate(outcomes) if one.is_there and one.variant.assumed and n not in idle]:
        lines += ["\\* Assumed beyond the case: " + "; ".join(assumed) + ".", ""]
    if refused := [(outcome.variant.label, outcome.refusal) for outcome in outcomes if not (outcome.is_there or outcome.is_no_choice)]:
        lines += ["Not to be had:", "", *(f"- {label}: {why}" for label, why in refused), ""]
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
    units = {"peak_force": "N", "contact_share": "", "min_film": "m", "loss": "J", "mean_speed": "rad/s"}
    return f"{outcome.values[name]:.4g} {units[name]}".strip()


def answer(search: Search, given: Outcome, names: list[str], limit: float, file: str) -> list[str]:
    """The cheapest scene within the limit of the fullest, and what was tried on the way."""
    told = [name for name in names if name in search.fullest.values]
    lines = ["## What this scene requires", ""]
    parts = ", ".join(part.label for part in search.parts) or "nothing beyond the case"
    lines += [f"The fullest scene is the case with: {parts}. It takes {cost(search.fullest, given)} of the case.", ""]
    changes = ", ".join(f"{QUANTITIES[name].label} {percent(change(name, search.fullest, given))}" for name in told)
    lines += [f"The case as it is differs from it: {changes}.", ""]
    changes = ", ".join(f"{QUANTITIES[name].label} {percent(change(name, search.fullest, search.cheapest))}" for name in told)
    lines += [
        f"The cheapest scene found within {100 * limit:g} % of the fullest ({', '.join(QUANTITIES[name].label for name in told)}) takes"
        f" {cost(search.cheapest, given)} of the case: {changes}.",
        "",
        "    " + " ".join(["gudgeon", file, *(f"--set {setting}" for setting in ("integrator.method=auto", *search.cheapest.variant.settings))]),
        "",
    ]
    if search.left_out:
        lines += ["Left out of the fullest scene, one after the other: " + "; ".join(label.removeprefix("without: ") for label in search.left_out) + ".", ""]
    if search.needed:
        lines += ["Needed, or not worth it:", "", *(f"- {label}: {why}" for label, why in search.needed), ""]
    open_ones = [name for name in told if search.fullest.uncertainty[name] > limit * scale_of(name, search.fullest)]
    if open_ones:
        words = ", ".join(QUANTITIES[name].label for name in open_ones)
        lines += [f"The certificate of the fullest scene itself leaves more than {100 * limit:g} % open in: {words}.", ""]
    return lines


def cost(outcome: Outcome, given: Outcome) -> str:
    return f"{ratio(outcome.evaluations, given.evaluations)} times the evaluations and {ratio(outcome.seconds, given.seconds)} times the time"


def scale_of(name: str, outcome: Outcome) -> float:
    measure = QUANTITIES[name].measure
    return abs(outcome.values[name]) if measure == "relative" else outcome.clearance if measure == "clearance" else 1.0


def draw_largest(axis: Axes, points: list[tuple[str, str, Outcome]], shown: list[str], given: Outcome, limit: float) -> None:
    """The largest change of all quantities against the evaluations."""
    for number, kind, outcome in points:
        largest = largest_change(shown, given, outcome)
        if largest == float("inf"):
            continue
        where = (outcome.evaluations / given.evaluations, max(SMALLEST, 100 * largest))
        axis.plot(*where, "o", color=COLOURS.get(kind, GREY), markersize=3)
        axis.annotate(number, where, xytext=(2, 2), textcoords="offset points", fontsize=5)
    axis.axhline(100 * limit, color=GREY, linestyle="--", linewidth=0.6)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_title("largest of these")
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
            where = (outcome.seconds / given.seconds, max(SMALLEST, 100 * abs(found[0])))
            first = kind not in kinds and kind != "cheapest"
            if first:
                kinds.append(kind)
            label = {"fullest": "F fullest, C cheapest"}.get(kind, kind) if first else None
            axis.plot(*where, "o", color=COLOURS.get(kind, GREY), markersize=3, label=label)
            axis.annotate(number, where, xytext=(2, 2), textcoords="offset points", fontsize=5)
        axis.axhline(100 * limit, color=GREY, linestyle="--", linewidth=0.6)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_title(QUANTITIES[quantity].label)
        axis.set_ylabel("change [%]")
    for axis in list(axes.flat)[len(shown) :]:  # a place that is left
        draw_largest(axis, points, shown, given, limit)
    for axis in axes.flat[: len(shown)]:
        axis.set_xlabel("processor time over that of the case")
    for axis in axes.flat[len(shown) :]:
        axis.set_xlabel("evaluations over those of the case")
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    drawing.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    drawing.suptitle(f"{name}: what each model costs and changes (no change: at {SMALLEST:g} %)")
    return drawing
