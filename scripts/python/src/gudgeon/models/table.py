"""The table and the picture of what each model changes."""

import matplotlib.pyplot as plt
import pandas as pd
from gudgeon.models.effects import (
    QUANTITIES,
    Outcome,
    Search,
    change,
    largest_change,
    percent,
    scale_of,
)
from gudgeon.plots.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    VERMILION,
    WIDTH,
    mark_decades,
)
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

COLOURS = {"taken out": VERMILION, "exchanged": BLUE, "refined": GREEN, "added": ORANGE, "fullest": PURPLE, "cheapest": PURPLE}
LABELS: dict[str, str | None] = {"fullest": "F most complete, C cheapest", "cheapest": None}  # in the legend, where not the kind itself
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
        "The changes refer to the whole run, that of the loss to a revolution of the last whole cycle: those of the peak force at the piston",
        "pin, of the loss and of the mean crank speed are relative to the value of the case, that of the minimum film thickness is relative to",
        "the clearance, and that of the contact share is in per cent of the time. After ± stands the uncertainty of the change, by the",
        "certificates of both scenes, where it is at least a tenth of the change. `-`: the scene does not have the quantity.",
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


Point = tuple[str, str, float, float]  # number, kind, cost, change as a fraction


def draw_points(axis: Axes, points: list[Point], limits: tuple[float, float], title: str, limit: float) -> None:
    """Change against cost between two costs. Scenes that lie close together share a label; scenes without a change have none."""
    for _, kind, cost, changed in points:
        axis.plot(cost, max(SMALLEST, 100 * changed), "o", color=COLOURS.get(kind, GREY), markersize=3, label=LABELS.get(kind, kind))
    axis.axhline(100 * limit, color=GREY, linestyle="--", linewidth=0.6)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlim(*limits)
    mark_decades(axis.xaxis)
    mark_decades(axis.yaxis)
    axis.autoscale_view()
    axis.set_title(title)
    axis.set_ylabel("change [%]")
    for numbers, cost, height in clusters(axis, points):
        axis.annotate(", ".join(numbers), (cost, height), xytext=(2, 2), textcoords="offset points", fontsize=5)


def clusters(axis: Axes, points: list[Point]) -> list[tuple[list[str], float, float]]:
    """Numbers of the scenes whose points or labels would overlap, and the place of their common label: beside the rightmost point."""
    shown = [(number, cost, 100 * change) for number, _, cost, change in points if 100 * change > SMALLEST]
    scale = axis.transAxes.inverted()
    placed = [(*scale.transform(axis.transData.transform(place)), number, *place) for number, *place in shown]
    groups: list[list[tuple[float, float, str, float, float]]] = []
    for point in sorted(placed):
        for group in groups:
            height = sum(other[1] for other in group) / len(group)
            if point[0] - group[-1][0] < 0.03 + 0.03 * len(group) and abs(point[1] - height) < 0.035:
                group.append(point)
                break
        else:
            groups.append([point])
    return [
        (sorted((one[2] for one in group), key=lambda number: (len(number), number)), max(one[3] for one in group), group[-1][4])
        for group in groups
    ]


def wider(costs: list[float]) -> tuple[float, float]:
    """Limits of an axis that shows all costs, with room for the labels."""
    room = (max(costs) / min(costs)) ** 0.06
    return min(costs) / room, max(costs) * room


def draw(name: str, outcomes: list[Outcome], search: Search, names: list[str], limit: float) -> Drawing:
    """Cost against the change of each quantity; a scene has its number of the table."""
    given = outcomes[0]
    shown = [one for one in names if one in given.values]
    drawing, axes = plt.subplots((len(shown) + 1) // 2, 2, figsize=(WIDTH, 0.7 + 2.2 * ((len(shown) + 1) // 2)), squeeze=False)
    idle = idle_scenes(outcomes)
    points = [(str(n), one.variant.kind, one) for n, one in enumerate(outcomes) if n and one.is_there and n not in idle]
    points += [("F", "fullest", search.fullest), ("C", "cheapest", search.cheapest)]
    seconds = [outcome.seconds / given.seconds for *_, outcome in points]
    for axis, quantity in zip(axes.flat, shown):
        changes = [(number, kind, outcome, change(quantity, given, outcome)) for number, kind, outcome in points]
        found = [(number, kind, outcome.seconds / given.seconds, abs(one[0])) for number, kind, outcome, one in changes if one]
        draw_points(axis, found, wider(seconds), QUANTITIES[quantity].label, limit)
    for axis in list(axes.flat)[len(shown) :]:  # where no quantity is drawn
        largest = [(number, kind, outcome.evaluations / given.evaluations, largest_change(shown, given, outcome)) for number, kind, outcome in points]
        largest = [point for point in largest if point[3] < float("inf")]
        draw_points(axis, largest, wider([cost for *_, cost, _ in largest]), "largest of these", limit)
    for axis in axes.flat[: len(shown)]:
        axis.set_xlabel("processor time over that of the case")
    for axis in axes.flat[len(shown) :]:
        axis.set_xlabel("evaluations over those of the case")
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    drawing.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    drawing.suptitle(f"{name}: what each model costs and changes (no change: at {SMALLEST:g} %, without a number)")
    return drawing
