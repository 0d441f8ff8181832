"""A run on one A4 page: its case in engineering units, its answers, where the losses go, and plots of the last cycle: four, or two beside long tables."""

import re
import textwrap
from collections.abc import Callable, Sequence

import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.names import PLACES, suited
from gudgeon.plots.bearing import first_angle, last_cycle, run_cycle
from gudgeon.plots.columns import COLOURS, crank_angles, values_of
from gudgeon.plots.style import BLUE
from gudgeon.report.answers import FIRM, Answers, amount, lines, losses_of, number, numbered_bearings, of_numbered, title
from gudgeon.report.page import notes, warnings
from gudgeon.results import MissingResult, Run
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import MultipleLocator

A4 = (8.27, 11.69)  # inch
LINE, SPACE, LEAST = 0.115, 9.0, 1.2  # heights of a line of 7 points, of all tables and plots, and of a plot at least [inch]
EDGE, TITLE = 0.4, 0.25  # margin of the paper, in which printers do not print, and height of a line of its title [inch]

#: The plots, of which the first four that the run has are drawn: title, unit, factor, columns.
Plot = tuple[str, str, float, tuple[str, ...]]
PLOTS: tuple[Plot, ...] = (
    ("film thickness", "µm", 1e6, tuple(f"{pre}film_thickness" for pre, _ in PLACES.values())),
    ("force", "kN", 1e-3, ("pin_force", "crankpin_force", "guide_force")),
    ("cylinder pressure", "bar", 1e-5, ("cylinder_pressure",)),
    ("crank moment", "N m", 1.0, ("crank_moment",)),
    ("piston acceleration", "10³ m/s²", 1e-3, ("piston_acceleration",)),
    ("crank speed", "rpm", 30 / np.pi, ("crank_speed",)),
)


def case_lines(run: Run) -> list[tuple[str, str]]:
    """The machine, its bearings and its oil in engineering units."""

    def shown(group: str, key: str, unit: str, factor: float = 1.0, offset: float = 0.0) -> str:
        value = run.parameter(group, key)
        try:
            value = float(str(value))
        except ValueError:
            return ""
        return f"{number(factor * (value + offset))} {unit}" if value else ""

    found = [("Stroke", shown("mechanism", "crank_length", "mm", 2e3)), ("Rod", shown("mechanism", "rod_length", "mm", 1e3)),
             ("Bore", shown("combustion", "bore", "mm", 1e3) or shown("cylinder_pressure", "bore", "mm", 1e3)),
             ("Crank speed", shown("initial", "crank_speed", "rpm", 30 / np.pi)), ("Gas", gas_of(run, shown))]
    for place, (_, name) in PLACES.items():
        group = "joint" if place == "piston_pin" else f"{place}.joint"
        if clearance := shown(group, "clearance", "µm", 1e6):
            size = " × ".join(part for part in (shown(group, "bearing_radius", "mm", 2e3), shown(group, "bearing_length", "mm", 1e3)) if part)
            found.append((name.capitalize(), ", ".join(part for part in (size, f"clearance {clearance}") if part)))
    oil = [str(run.parameter("lubrication", "oil", "") or ""), shown("lubrication", "temperature", "°C", 1.0, -273.15), shown("lubrication", "viscosity", "mPa s", 1e3)]
    return [(name, text) for name, text in [*found, ("Oil", language.current.keep(language.current.number(", ".join(part for part in oil if part))))] if text]


def gas_of(run: Run, shown: Callable[..., str]) -> str:
    """What the gas of the case is: pressures of a compressor, compression ratio and heat of an engine, or a measured pressure; empty without one."""
    if "cylinder_pressure" in run.case:
        return "measured pressure"
    kind = str(run.parameter("combustion", "cycle", "four_stroke")) if "combustion" in run.case else ""
    pressures = [shown("combustion", f"{side}_pressure", "bar", 1e-5) for side in ("suction", "discharge")]
    if kind == "compressor":
        return f"compressor, {' to '.join(pressures)}"
    ratio, heat = shown("combustion", "compression_ratio", "").strip(), float(str(run.parameter("combustion", "heat", 0.0) or 0.0))
    return f"{kind.split('_')[0]} strokes, compression ratio {ratio}" + (f", {amount(heat, 'J')} a cycle" if heat else "") if kind and ratio else ""


def write(axes: Axes, heading: str, head: Sequence[str], rows: Sequence[tuple[str, Sequence[str]]], widths: Sequence[float]) -> float:
    """A table of texts, from the top of its axes; the widths of the columns are shares of that of the axes. Returns its height [inch]."""
    say: Callable[[str], str] = language.current.say
    axes.axis("off")
    axes.set_title(language.current.keep(say(heading)), loc="left", fontweight="bold")
    letters = 150 * axes.get_subplotspec().get_position(axes.figure).width
    edges, depth = np.concatenate(([0], np.cumsum(widths))), 0.0
    for cells in ([("", head)] if head else []) + list(rows):
        said = [re.sub(r"(?<=\d) (?=[^\W\d_]|%)", "\u00a0", say(text).translate(FIRM)) for text in (cells[0], *cells[1])]   # a value stays beside its unit
        texts = [textwrap.fill(text, max(int(letters * width * (0.75 if i == 0 and letters < 100 else 1)), 8)).replace("\u00a0", " ") for i, (text, width) in enumerate(zip(said, widths))]
        for line in "\n".join(texts).splitlines():
            language.current.keep(line)   # it is in the page's language
        for x, text in zip(edges, texts):
            axes.annotate(text, (x, 1), (0, -72 * depth), xycoords="axes fraction", textcoords="offset points", va="top", fontsize=7,
                          color="#555555" if x == 0 else "black", fontweight="bold" if cells[1] is head else None).set_in_layout(False)
        depth += LINE * (0.35 + max(text.count("\n") + 1 for text in texts))
    return depth


def widths_of(head: Sequence[str], rows: Sequence[tuple[str, Sequence[str]]]) -> list[float]:
    """Widths of columns as shares, by their longest texts; those of more than 24 letters take more lines."""
    say: Callable[[str], str] = language.current.say
    longest = [min(max(len(say(cell)) for cell in column) + 3, 24) for column in zip(["", *head], *([name, *texts] for name, texts in rows))]
    return [one / sum(longest) for one in longest]


def draw(run: Run, name: str) -> Drawing:
    """The page. Raises MissingResult for a run without rows."""
    if len(run["time"]) < 3:
        raise MissingResult(f"{name}: the trace has no cycle")
    drawing = plt.figure(figsize=A4)
    axes = drawing.subplot_mosaic([["case", "machine"], ["bearings", "bearings"], ["numbered", "numbered"], ["notes", "notes"], ["losses", "losses"], ["a", "b"], ["c", "d"]],
                                  height_ratios=[1.5, 1.6, 0.1, 0.1, 0.9, 1.6, 1.6])
    headline = textwrap.fill(str(run.parameter("case", "title", "")) or name, 68)
    for line in headline.splitlines():
        language.current.keep(line)
    below = 1 - (EDGE + TITLE * (headline.count("\n") + 1)) / A4[1]
    drawing.get_layout_engine().set(rect=(0.05, 0.035, 0.9, below - 0.035))
    drawing.suptitle(headline, y=1 - EDGE / A4[1], va="top", fontsize=12, fontweight="bold").set_in_layout(False)
    places, ours, others = lines(run)
    tall = max(write(axes["case"], "Case", (), [(said, [text]) for said, text in case_lines(run)], (0.3, 0.7)),
               write(axes["machine"], "Machine", (), [(said, [text]) for said, text in others], (0.4, 0.6)))
    wide, heading = [], title(run)
    for letter, head, rows_of in (("bearings", places, ours), ("numbered", *of_numbered(run))):
        if rows_of:
            even = (0.22, *[0.78 / len(head)] * len(head))
            wide.append(write(axes[letter], heading, head, rows_of, even if letter == "bearings" else widths_of(head, rows_of)))
            heading = ""
        else:
            axes[letter].remove()
            wide.append(0.01)
    losses = 0.2 * draw_losses(axes["losses"], Answers(run)) + 0.1
    said = lines_of_notes(run, SPACE - tall - sum(wide) - losses - LEAST)
    wide.append(write(axes["notes"], "", (), said, (0.06, 0.94)) if said else 0.01)
    if not said:
        axes["notes"].remove()
    left = SPACE - tall - sum(wide) - losses   # what the tables leave
    plots = [0.5 * left] * 2 if left >= 2 * LEAST else [max(left, LEAST), 0.01]
    axes["case"].get_subplotspec().get_gridspec().set_height_ratios([max(tall, 0.1), *wide, losses, *plots])
    rows = last_cycle(run)
    chosen = [(said, unit, factor, found) for said, unit, factor, names in [*thinnest_film(run), *PLOTS]
              if (found := [one for one in names if (one in run or f"{one}_x" in run) and np.ptp(values_of(run, one)[rows]) > 0])]
    letters = "abcd" if plots[1] >= LEAST else "ab"
    for letter in "cd"[: 4 - len(letters)]:
        axes[letter].remove()
    for letter in letters[len(chosen):]:
        axes[letter].axis("off")
    for axis, (said, unit, factor, found) in zip((axes[letter] for letter in letters), chosen):
        unit, factor = suited(unit, factor, np.concatenate([values_of(run, one)[rows] for one in found]))
        axis.set_title(f"{said} [{unit}]", loc="left", pad=16 if len(found) > 1 else None)
        draw_cycle(axis, run, rows, factor, found)
    return drawing


def lines_of_notes(run: Run, room: float) -> list[tuple[str, list[str]]]:
    """What a reader of the answers has to know, as the page of a run has it: as much as there is room for [inch], with the number of others."""
    say, keep = language.current.say, language.current.keep
    said = [keep(text) for text in (*warnings(run, language.current), *notes(run))]
    shown = said if len(said) * 2.35 * LINE < room else said[: max(int(room / (2.35 * LINE)) - 1, 1)]   # of up to two lines each
    more = [keep(say(f"{len(said) - len(shown)} more: gudgeon-plot report"))] if len(shown) < len(said) else []
    return [("Note", [text]) for text in (*shown, *more)]


def thinnest_film(run: Run) -> list[Plot]:
    """The plot of the thinnest film of an engine's numbered bearings, as in PLOTS."""
    thinnest = run.summary.get("cycle_thinnest_bearing", ("", ""))[0]
    return [(f"{name}: film thickness", "µm", 1e6, (f"{pre}film_thickness",)) for pre, name in numbered_bearings(Answers(run)) if pre == f"{thinnest}_"]


def draw_cycle(axes: Axes, run: Run, rows: np.ndarray, factor: float, columns: Sequence[str]) -> None:
    """Columns over the crank angle of the last cycle."""
    begin = first_angle(run)
    angle, order = crank_angles(run["crank_angle"][rows] - np.radians(begin), run_cycle(run))
    seam = np.flatnonzero(np.diff(order) < 0) + 1   # where the end of the run meets the beginning of its cycle
    for column, colour in zip(columns, COLOURS):
        place = next((said for pre, said in reversed(PLACES.values()) if column == f"{pre}film_thickness"), column.replace("crankpin", "crank pin").replace("_", " "))
        values = factor * values_of(run, column)[rows][order]
        axes.plot(np.insert(angle + begin, seam, np.nan), np.insert(values, seam, np.nan), color=colour, label=place)
    axes.set_xlabel("crank angle [deg]")
    axes.xaxis.set_major_locator(MultipleLocator(90 if np.degrees(run_cycle(run)) < 400 else 180))
    if len(columns) > 1:   # below the title, where there are no curves
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=len(columns), borderaxespad=0.1, borderpad=0, handlelength=1.4, columnspacing=1.2)


def draw_losses(axes: Axes, rows: Answers) -> int:
    """The parts of FMEP as bars with their power, numbered bearings together, whose own powers are in their table; without a gas the losses
    of the bearings. Returns their number."""
    of_gas = losses_of(rows)
    imep, power = rows("cycle_imep") or 1.0, rows("cycle_indicated_power") or 0.0
    numbered = numbered_bearings(rows)
    parts = [(name, value * power / imep) for name, value, _ in of_gas] or [
        (name.capitalize(), sum(rows(f"{pre}cycle_mean_{part}_power") or 0.0 for part in ("film", "friction"))) for pre, name in [*PLACES.values(), *numbered]]
    together: dict[str, float] = {}
    for name, watts in parts:
        name = re.sub(r" \d+$", "s", name) if name.lower() in dict(map(reversed, numbered)) else name
        together[name] = together.get(name, 0.0) + watts
    parts = [(name, watts) for name, watts in together.items() if watts][::-1]
    total = f" (FMEP {amount(rows('cycle_fmep') or 0.0, 'bar')})" if of_gas else ""
    if not parts:
        axes.axis("off")
        return 0
    axes.set_title(language.current.keep(language.current.say("Where the losses go") + language.current.say(total)), loc="left", fontweight="bold")
    bars = axes.barh([name for name, _ in parts], [watts for _, watts in parts], color=BLUE, height=0.6)
    axes.bar_label(bars, [amount(watts, "W") for _, watts in parts], padding=3, fontsize=7)
    axes.margins(x=0.12)
    axes.xaxis.set_visible(False)
    axes.spines["bottom"].set_visible(False)
    axes.grid(False)
    return len(parts)
