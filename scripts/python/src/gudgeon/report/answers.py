"""The answers at the top of the page of a run: some ten lines that an engineer wants, from the rows of the run's summary alone.

Values of a cycle are those of the last whole cycle; a run without one has values of the whole run.
"""

import html
import math
from collections.abc import Callable

from gudgeon.language import Language
from gudgeon.names import PLACES
from gudgeon.results import Run

#: Shown together behind a value: the crank angle at which it occurs.
ANGLE = "_angle"


class Answers:
    """The rows of a summary as numbers."""

    def __init__(self, run: Run) -> None:
        self.summary = run.summary

    def __call__(self, name: str) -> float | None:
        try:
            return float(self.summary[name][0])
        except (KeyError, ValueError):
            return None

    def shown(self, name: str, unit: str, factor: float = 1.0, offset: float = 0.0) -> str:
        """A value in a unit, with its crank angle if there is one; empty without this row."""
        value = self(name)
        if value is None:
            return ""
        text = f"{factor * (value + offset):.4g} {unit}"
        angle = self(name + ANGLE)
        return text if angle is None else f"{text} at {angle:.1f}°"

    def first(self, names: tuple[str, ...], unit: str, factor: float = 1.0) -> str:
        """The first of several rows that the summary has."""
        return next((text for name in names if (text := self.shown(name, unit, factor))), "")


def losses(rows: Answers, pre: str) -> str:
    """Loss of a bearing: of its film and of its friction together."""
    parts = [value for part in ("film", "friction") if (value := rows(f"{pre}cycle_mean_{part}_power")) is not None]
    return f"{sum(parts):.4g} W" if parts else ""


def touching(rows: Answers, pre: str) -> str:
    """Share of the time in contact, and the deepest penetration."""
    share = rows(f"{pre}cycle_contact_share")
    if share is None:
        share = rows(f"{pre}contact_time_fraction")
    deep = rows(f"{pre}max_penetration")
    if share is None or not (rows(f"{pre}contacts") or share):
        return ""
    return f"{100 * share:.3g} %" + (f", up to {1e6 * deep:.3g} µm deep" if deep else "")


#: Lines of bearings: name, and the text for the rows with a prefix.
OF_BEARINGS: tuple[tuple[str, Callable[[Answers, str], str]], ...] = (
    ("Thinnest film", lambda rows, pre: rows.first((f"{pre}cycle_min_film_thickness", f"{pre}min_film_thickness"), "µm", 1e6)),
    ("Largest film pressure", lambda rows, pre: rows.first((f"{pre}cycle_max_film_pressure", f"{pre}max_film_pressure"), "MPa", 1e-6)),
    ("Largest force", lambda rows, pre: rows.first((f"{pre}cycle_max_force", f"{pre}max_pin_force"), "kN", 1e-3)),
    ("Mean loss", losses),
    ("Film temperature", lambda rows, pre: rows.shown(f"{pre}cycle_mean_film_temperature", "°C", 1.0, -273.15)
     or rows.shown(f"{pre}film_temperature", "°C", 1.0, -273.15)),
    ("Oil flow", lambda rows, pre: rows.first((f"{pre}cycle_mean_film_side_flow", f"{pre}mean_film_side_flow"), "cm³/min", 6e7)),
    ("In contact", touching),
)


def machine(rows: Answers) -> list[tuple[str, str]]:
    """Lines of the machine."""
    found = []
    pressures = [f"{name} {1e-5 * value:.4g}" for key, name in (("imep", "IMEP"), ("bmep", "BMEP"), ("fmep", "FMEP"))
                 if (value := rows(f"cycle_{key}")) is not None]
    if pressures:
        found.append(("Mean effective pressures", ", ".join(pressures) + " bar"))
    powers = [f"{said} {1e-3 * value:.4g} kW" for key, said in (("indicated", "indicated"), ("brake", "brake"))
              if (value := rows(f"cycle_{key}_power")) is not None]
    if powers:
        found.append(("Power", ", ".join(powers)))
    if text := rows.shown("cycle_max_cylinder_pressure", "bar", 1e-5):
        found.append(("Cylinder pressure", text))
    speed = rows("cycle_mean_crank_speed")
    speed = rows("mean_crank_speed") if speed is None else speed
    if speed is not None:
        text = f"{speed * 9.549296585513721:.4g} rpm"
        if (change := rows("cycle_speed_fluctuation")) is not None and change > 1e-12:
            text += f", fluctuates by {100 * change:.3g} %"
        found.append(("Crank speed", text))
    swing, drift = rows("pin_swing"), rows("pin_drift_per_revolution")
    if swing is not None:
        text = f"swings by {math.degrees(swing):.3g}°"
        found.append(("Piston pin", text if drift is None else f"{text}, drifts by {math.degrees(drift):.3g}° a revolution"))
    return found


def lines(run: Run) -> tuple[list[str], list[tuple[str, list[str]]], list[tuple[str, str]]]:
    """Names of the bearings; the lines of the bearings, with a text for each; and those of the machine. There are ten at most."""
    rows = Answers(run)
    places = [(pre, name) for pre, name in PLACES.values() if rows(f"{pre}min_film_thickness") is not None]
    ours = [(name, [text(rows, pre) for pre, _ in places]) for name, text in OF_BEARINGS]
    ours = [(name, texts) for name, texts in ours if any(texts)]
    others = machine(rows)
    return [name for _, name in places], ours, others[: max(0, 10 - len(ours))]


def unsettled(run: Run) -> str:
    """One line on a motion that still changes from cycle to cycle; empty if it has settled or that is not known."""
    if run.summary.get("cycle_is_settled", ("", ""))[0] != "no":
        return ""
    rows, said = Answers(run), ""
    for pre, name in PLACES.values():
        change = rows(f"{pre}film_thickness_change")
        if change is not None and abs(change) > 0.05:
            said = f": the film thickness at the {name} changes by {100 * abs(change):.2g} % from cycle to cycle"
    return f"The motion has not settled{said}; --set run.until=periodic"


def section(run: Run, language: Language | None = None) -> str:
    """The section as HTML; empty if the summary has none of these rows."""
    say = (language or Language()).say
    names, ours, others = lines(run)
    if not (ours or others):
        return ""
    cell = html.escape
    head = "".join(f"<th>{cell(say(name))}</th>" for name in names)
    body = "".join(f"<tr><td>{cell(say(name))}</td>" + "".join(f"<td>{cell(say(text))}</td>" for text in texts) + "</tr>" for name, texts in ours)
    bearings = f"<table><tr><th></th>{head}</tr>{body}</table>" if ours else ""
    of_machine = "".join(f"<tr><td>{cell(say(name))}</td><td>{cell(say(text))}</td></tr>" for name, text in others)
    note = f'<p class="warning">{cell(say(text))}</p>' if (text := unsettled(run)) else ""
    return (f'<section id="answers"><h2>{cell(say(title(run)))}</h2>{note}<div class="answers">{bearings}'
            f"<table>{of_machine}</table></div></section>")


def title(run: Run) -> str:
    """What the answers are of."""
    if "cycle_start" not in run.summary:
        return "Answers of the run"
    turns = Answers(run)("cycle_revolutions") or 1
    return "Answers of the last cycle" + (f" ({turns:g} revolutions)" if turns > 1 else "")

