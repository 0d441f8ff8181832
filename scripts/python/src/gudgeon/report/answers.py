"""The answers at the top of the page of a run: what an engineer wants, by its importance, from the rows of the run's summary alone.

All values are those of the last whole cycle; those of a run without one are of the whole run.
"""

import html
import math
import re
from collections.abc import Callable, Mapping

from gudgeon.language import Language
from gudgeon.names import PLACES, readable
from gudgeon.results import Run, numbered

#: Shown together behind a value: the crank angle at which it occurs.
ANGLE = "_angle"

#: Digits that a certificate does not confirm, within a text; pages show them grey.
LOOSE = str.maketrans("0123456789", "".join(chr(0x1D7F6 + digit) for digit in range(10)))
FIRM = {loose: chr(digit) for digit, loose in zip(LOOSE, LOOSE.values())}


class Answers:
    """The rows of a summary as numbers; how many cylinders there are, and which of them the trace shows."""

    def __init__(self, run: Run) -> None:
        self.summary = run.summary
        cylinders = numbered(run.case, "cylinder")
        self.cylinders = len(cylinders)
        self.cylinder = 1 + next((i for i, one in enumerate(cylinders) if one.get("full")), 0)   # the full one
        self.of_cycle = "cycle_start" in run.summary
        self.is_certified = "certified_until" in run.summary

    def __call__(self, name: str) -> float | None:
        try:
            return float(self.summary[name][0])
        except (KeyError, ValueError):
            return None

    def difference(self, name: str) -> float:
        """How far the runs of the certificate are apart; 0 without a certificate, infinite where it does not have this row."""
        found = self(f"{name}_difference") if self.is_certified else 0.0
        return math.inf if found is None else abs(found)

    def total(self, of: Mapping[str, float]) -> tuple[float, float]:
        """The sum of rows, each times a factor, and its difference; rows that are not there count as 0."""
        there = {name: factor for name, factor in of.items() if self(name) is not None}
        return sum(factor * (self(name) or 0.0) for name, factor in there.items()), sum(abs(factor) * self.difference(name) for name, factor in there.items())

    def figure(self, name: str, factor: float = 1.0, offset: float = 0.0, form: str = ".4g") -> str:
        """A value times a factor; empty without this row."""
        value = self(name)
        return "" if value is None else number(factor * (value + offset), abs(factor) * self.difference(name), form)

    def shown(self, name: str, unit: str, factor: float = 1.0, offset: float = 0.0, form: str = ".4g") -> str:
        """A value in a unit, or with a prefix to it that suits the value, with its crank angle if there is one; empty without this row."""
        unit, prefix = readable(unit, factor * ((self(name) or 0.0) + offset))
        text, angle = self.figure(name, factor * prefix, offset, form), self.figure(name + ANGLE, form=".1f")
        return text and f"{text} {unit}" + (f" at {angle}°" if angle else "")

    def of(self, pre: str, in_cycle: str, in_run: str) -> str:
        """The name of a bearing's row, of the last cycle or of the whole run."""
        return pre + (in_cycle if self.of_cycle else in_run)


def number(value: float, difference: float = 0.0, form: str = ".4g") -> str:
    """A value with four digits and a typographic minus, without an exponent up to 1e7. Digits are LOOSE where half a unit of their place is
    below the difference."""
    text = f"{value:{form}}"
    if "e+" in text and abs(value) < 1e7:
        text = f"{float(text):.0f}"
    if difference != 0 and math.isfinite(value):
        digits, mark, exponent = text.partition("e")
        units = len(digits.partition(".")[0]) - 1  # the place of units in the text
        places = ((units - i if i <= units else units - i + 1) + int(exponent or 0) for i in range(len(digits)))
        text = "".join(one if difference <= 0.5 * 10.0**place else one.translate(LOOSE) for one, place in zip(digits, places)) + mark + exponent
    return text.replace("-", "−")


def amount(value: float, unit: str, difference: float = 0.0) -> str:
    """A value with its unit, which has a prefix that suits it."""
    unit, factor = readable(unit, value)
    return f"{number(factor * value, factor * difference)} {unit}"


def html_of(text: str) -> str:
    """A text in HTML, with its LOOSE digits as such."""
    loose = "".join(map(chr, FIRM))
    return re.sub(f"[{loose}](?:[.,]?[{loose}])*", lambda found: f'<span class="loose">{found[0].translate(FIRM)}</span>', html.escape(text))


def gap(rows: Answers, pre: str, is_film: bool) -> str:
    """The thinnest film; or the deepest penetration, where that is negative."""
    name = rows.of(pre, "cycle_min_film_thickness", "min_film_thickness")
    value = rows(name)
    return "" if value is None or (value >= 0) != is_film else rows.shown(name, "m", 1.0 if is_film else -1.0)


def temperature(rows: Answers, pre: str) -> str:
    """The mean of the cycle, or the one at the end of the run."""
    mean = rows.shown(f"{pre}cycle_mean_film_temperature", "°C", 1.0, -273.15)
    last = rows.shown(f"{pre}film_temperature", "°C", 1.0, -273.15)
    return mean or (f"{last} at the end" if last else "")


def losses(rows: Answers, pre: str) -> str:
    """Loss of a bearing: of its film and of its friction together."""
    names = [name for part in ("film", "friction") if rows(name := f"{pre}cycle_mean_{part}_power") is not None]
    value, difference = rows.total(dict.fromkeys(names, 1.0))
    return amount(value, "W", difference) if names else ""


def touching(rows: Answers, pre: str) -> str:
    """Share of the time in contact, where there has been any, with the number of impacts and the speed of the hardest one."""
    name, fastest = rows.of(pre, "cycle_contact_share", "contact_time_fraction"), f"{pre}cycle_max_impact_speed"
    if rows(name) is None or not (rows(f"{pre}contacts") or rows(name)):
        return ""
    impacts, speed = rows.figure(f"{pre}cycle_impacts", form=".0f") if rows(f"{pre}cycle_impacts") else "", rows(fastest)
    hardest = f", {impacts} impacts at up to {amount(speed, 'm/s', rows.difference(fastest))}" if impacts and speed is not None else ""
    return f"{rows.figure(name, 100, form='.3g')} %" + hardest


def largest_force(rows: Answers, pre: str) -> str:
    """The largest force, with its crank angle if there is one."""
    return rows.shown(rows.of(pre, "cycle_max_force", "max_pin_force"), "N")


def force(rows: Answers, pre: str) -> str:
    """The largest force, and that along the rod in the other sense."""
    text = largest_force(rows, pre)
    back, degrees = rows.shown(f"{pre}cycle_reversed_load", "N"), rows.figure(f"{pre}cycle_degrees_under_reversed_load", form=".0f")
    if not (text and back and degrees):
        return text
    return text + (f"; reversed {back} over {degrees}°" if (rows(f"{pre}cycle_reversed_load") or 0.0) > 0 else "; never reversed")


def slap(rows: Answers) -> str:
    """The hardest impact of the skirt, or of one with a film its fastest end and the least film."""
    if (speed := rows.shown("cycle_max_slap_speed", "m/s")) and (film := rows.shown("cycle_min_skirt_film_thickness", "m")):
        return f"{speed}, film from {film}"
    speed, energy = rows.shown("cycle_slap_speed", "m/s"), rows.shown("cycle_slap_energy", "J")
    impacts = rows.figure("cycle_slap_impacts", form=".0f")
    if not (speed and energy and impacts):
        return ""
    corner = rows.summary["cycle_slap_corner"][0].removeprefix("guide_")
    return f"{speed} at {rows.figure('cycle_slap_angle', form='.1f')}°, corner {corner}, {energy}; {impacts} impacts"


#: Change from cycle to cycle up to which a run is called settled, as the program does.
MOST_CHANGE = 0.05

#: Lines of bearings: name, and the text for the rows with a prefix.
Lines = tuple[tuple[str, Callable[[Answers, str], str]], ...]
OF_BEARINGS: Lines = (
    ("Thinnest film", lambda rows, pre: gap(rows, pre, True)),
    ("Deepest penetration", lambda rows, pre: gap(rows, pre, False)),
    ("Largest film pressure", lambda rows, pre: rows.shown(rows.of(pre, "cycle_max_film_pressure", "max_film_pressure"), "Pa")),
    ("Largest force", force),
    ("Mean loss", losses),
    ("Film temperature", temperature),
    ("Oil flow", lambda rows, pre: rows.shown(rows.of(pre, "cycle_mean_film_side_flow", "mean_film_side_flow"), "cm³/min", 6e7)),
    ("In contact", touching),
    ("Wear of the bore in 100 h", lambda rows, pre: rows.shown(f"{pre}cycle_wear_depth_100h_bore", "m")),
)

#: Those of numbered bearings, short enough for a column each.
OF_NUMBERED: Lines = tuple((name, largest_force if text is force else text) for name, text in OF_BEARINGS if name != "Oil flow")


def numbered_bearings(rows: Answers) -> list[tuple[str, str]]:
    """Prefixes of the rows of an engine's numbered bearings, and their names: main bearings, then crank pins."""
    found = [match for name in rows.summary if (match := re.fullmatch(r"(main_bearing|crank_pin)_(\d+)_min_film_thickness", name))]
    return [(f"{one[1]}_{one[2]}_", f"{PLACES[one[1]][1]} {one[2]}") for one in sorted(found, key=lambda one: (one[1] == "crank_pin", int(one[2])))]


def of_all_bearings(rows: Answers) -> list[tuple[str, str]]:
    """The thinnest film of all numbered bearings, their loss and oil flow."""
    thinnest, found = rows.summary.get("cycle_thinnest_bearing", ("", ""))[0] + "_", []
    if name := dict(numbered_bearings(rows)).get(thinnest):
        found.append(("Thinnest film", f"{gap(rows, thinnest, True)}, {name}"))
    if power := rows.shown("cycle_bearings_power", "W"):
        found.append(("Loss of all bearings", power))
    flow, difference = rows.total({rows.of(pre, "cycle_mean_film_side_flow", "mean_film_side_flow"): 6e7 for pre, _ in numbered_bearings(rows)})
    if flow:
        found.append(("Oil flow of all bearings", f"{number(flow, difference)} cm³/min"))
    return found


def largest(rows: Answers, pattern: str) -> re.Match[str] | None:
    """The row with the largest value of those whose whole name has this pattern."""
    found = [match for name in rows.summary if (match := re.fullmatch(pattern, name))]
    return max(found, key=lambda match: rows(match[0]) or 0.0, default=None)


def speed(rows: Answers) -> str:
    """The mean speed, and by how much of it the speed fluctuates, on a shaft of several stations at its ends too."""
    text = rows.shown(rows.of("", "cycle_mean_crank_speed", "mean_crank_speed"), "rpm", 30 / math.pi)
    if not text or (rows("cycle_speed_fluctuation") or 0.0) <= 1e-12:
        return text
    own, front, driven = (f"{rows.figure(name, 100, form='.3g')} %" for name in ("cycle_speed_fluctuation", "front_irregularity", "cyclic_irregularity"))
    ends = f" at the crank of cylinder {rows.cylinder}, {front} at the front end, {driven} at the driven end" if rows("front_irregularity") is not None else ""
    return f"{text}, fluctuates by {own}{ends}"


def shaft(rows: Answers) -> list[tuple[str, str]]:
    """Lines of a shaft that twists."""
    found = []
    pre = "cycle_max" if rows.of_cycle else "max"
    if text := rows.figure(f"{pre}_crankshaft_twist", 1e3):
        found.append(("Largest twist of the shaft", f"{text} mrad"))
    if most := largest(rows, rf"{pre}_station_(\d+)_twist"):
        found.append(("Largest twist of the shaft", f"{rows.figure(most[0], 1e3)} mrad, station {most[1]} against the crank of cylinder {rows.cylinder}"))
    if most := largest(rows, r"cycle_front_twist_order_([\d.]+)"):
        found.append(("Strongest order of the twist", f"order {most[1]}, {rows.figure(most[0], 1e3)} mrad of the front end against the driven end"))
    if most := largest(rows, rf"{pre}_segment_(\d+)_torque"):
        found.append(("Largest torque in the shaft", f"{rows.shown(most[0], 'N m')}, segment {most[1]}"))
    return found


def machine(rows: Answers) -> list[tuple[str, str]]:
    """Lines of the machine, by their importance."""
    found = [("Forces and plots", f"cylinder {rows.cylinder} of {rows.cylinders}")] if rows.cylinders > 1 else []
    found += of_all_bearings(rows)
    if pressures := [f"{name} {text}" for name in ("IMEP", "BMEP", "FMEP") if (text := rows.shown(f"cycle_{name.lower()}", "bar"))]:
        text = f" (bearings {rows.shown('cycle_one_way_fmep', 'bar')}, not fed back)" if rows("cycle_one_way_fmep") else ""
        found.append(("Mean effective pressures", ", ".join(pressures) + text))
    if powers := [f"{said} {text}" for said in ("indicated", "brake") if (text := rows.shown(f"cycle_{said}_power", "W"))]:
        found.append(("Power", ", ".join(powers)))
    if text := rows.shown("cycle_max_cylinder_pressure", "bar"):
        found.append(("Cylinder pressure", text))
    if text := speed(rows):
        found.append(("Crank speed", text))
    if torques := [text for what in ("min", "max") if (text := rows.shown(rows.of("", f"cycle_{what}_drive_torque", f"{what}_drive_torque"), "N m"))]:
        mean = rows.shown("cycle_work_drive", "N m", 1 / (2 * math.pi * (rows("cycle_revolutions") or 1)))
        found.append(("Drive torque", " to ".join(torques) + (f", mean {mean}" if mean else "")))
    found += shaft(rows)
    scattered = (rows("recent_mass_flow_scatter") or 0.0) > MOST_CHANGE   # from cycle to cycle: a run that has not settled, or valves that flutter
    gas = [f"{name} {text}" for name, text in (
        ("up to", rows.shown("cycle_max_gas_temperature", "°C", 1, -273.15)), ("to the walls", rows.shown("cycle_heat_to_walls", "J")),
        ("to the walls", rows.shown("cycle_wall_heat_flow", "W")), ("leak", rows.shown("cycle_leak_share", "%", 100)),
        ("leak", rows.shown("cycle_leak_flow", "g/s", 1000)), ("efficiency", rows.shown("cycle_indicated_efficiency", "%", 100)),
        ("delivers", rows.shown("cycle_mass_flow", "g/s", 1000)), ("in the mean of the last revolutions", rows.shown("recent_mass_flow", "g/s", 1000) if scattered else ""), ("volumetric efficiency", rows.shown("cycle_volumetric_efficiency", "%", 100)),
        ("isentropic efficiency", rows.shown("cycle_isentropic_efficiency", "%", 100)), ("delivery temperature", rows.shown("cycle_discharge_temperature", "°C", 1, -273.15)),
        ("lost in the suction valve", rows.shown("cycle_suction_loss", "W")), ("in the discharge valve", rows.shown("cycle_discharge_loss", "W")),
        ("suction valve hits with", rows.shown("cycle_max_suction_valve_speed", "m/s")),
        ("discharge valve hits with", rows.shown("cycle_max_discharge_valve_speed", "m/s"))) if text]
    if gas:
        found.append(("Gas", ", ".join(gas)))
    if text := slap(rows):
        found.append(("Hardest slap", text))
    if swing := rows.figure("pin_swing", 180 / math.pi, form=".3g"):
        drift = rows.figure("pin_drift_per_revolution", 180 / math.pi, form=".3g")
        found.append(("Piston pin", f"swings by {swing}°" + (f", drifts by {drift}° a revolution" if drift else "")))
    return found


def losses_of(rows: Answers) -> list[tuple[str, float, float]]:
    """The parts of FMEP with their values and differences [Pa]: piston rings, bearings, the film of the skirt, what else the bore takes, elastic members."""
    work, imep = rows("cycle_work_gas"), rows("cycle_imep")
    if not work or not imep or not rows("cycle_fmep"):
        return []
    taken = -imep / work
    parts = [(f"Ring {number}", {f"cycle_ring_{number}_fmep": 1.0}) for number in range(1, 7)]
    parts += [(name.capitalize(), {f"{pre}cycle_joint_fmep": 1.0, f"{pre}cycle_work_contact": taken}) for pre, name in [*PLACES.values(), *numbered_bearings(rows)]]
    parts += [("Skirt", {"cycle_skirt_fmep": 1.0}), ("Piston in its bore", {"cycle_work_guide": taken, "cycle_ring_fmep": -1.0, "cycle_skirt_fmep": -1.0}),
              ("Elastic members", {"cycle_work_elastic": taken})]
    found = [(name, *rows.total(of)) for name, of in parts]
    return [part for part in found if abs(part[1]) > 1e-3 * abs(rows("cycle_fmep") or 0.0)]


def losses_section(rows: Answers, say: Callable[[str], str]) -> str:
    """Where the losses go, as a table with bars; empty if there are none."""
    found = losses_of(rows)
    if not found:
        return ""
    total, of_total = rows.total({"cycle_fmep": 1.0})
    largest, watts = max(abs(value) for _, value, _ in found), (rows("cycle_indicated_power") or 0.0) / (rows("cycle_imep") or 1.0)

    def line(name: str, value: float, difference: float, share: str = "", width: float = 0.0) -> str:
        texts = (name, amount(value, "Pa", difference), amount(watts * value, "W", abs(watts) * difference), share)
        return "<tr>" + "".join(f"<td>{html_of(say(text))}</td>" for text in texts) + f'<td class="bar"><i style="width: {width:.1f}%"></i></td></tr>'

    def share(value: float, difference: float) -> str:
        return f"{number(100 * value / total, 100 * (difference + abs(value / total) * of_total) / abs(total), '.3g')} %"

    body = "".join(line(*part, share(*part[1:]), 100 * max(part[1], 0.0) / largest) for part in found) + line("All losses (FMEP)", total, of_total)
    return f'<section id="losses"><h2>{html.escape(say("Where the losses go"))}</h2><table>{body}</table></section>'


def of_bearings(rows: Answers, places: list[tuple[str, str]], listed: Lines = OF_BEARINGS) -> list[tuple[str, list[str]]]:
    """The lines of bearings, which have these prefixes and names, with a text for each."""
    found = [(name, [text(rows, pre) for pre, _ in places]) for name, text in listed]
    return [(name, texts) for name, texts in found if any(texts)]


def lines(run: Run) -> tuple[list[str], list[tuple[str, list[str]]], list[tuple[str, str]]]:
    """Names of the bearings; the lines of the bearings, with a text for each; and those of the machine. Numbered bearings have their
    table from `of_numbered`."""
    rows = Answers(run)
    places = [(pre, name) for pre, name in PLACES.values() if rows(f"{pre}min_film_thickness") is not None]
    return [name for _, name in places], of_bearings(rows, places), machine(rows)


def of_numbered(run: Run) -> tuple[list[str], list[tuple[str, list[str]]]]:
    """The answers of an engine's numbered bearings: what they are, and a line for each bearing with their texts."""
    rows = Answers(run)
    places = numbered_bearings(rows)
    found = of_bearings(rows, places, OF_NUMBERED)
    return [name for name, _ in found], [(name, [texts[i] for _, texts in found]) for i, (_, name) in enumerate(places)]


def section(run: Run, language: Language | None = None) -> str:
    """The section as HTML; empty if the summary has none of these rows."""
    say = (language or Language()).say
    names, ours, others = lines(run)
    heads, numbered = of_numbered(run)
    if not (ours or others or numbered):
        return ""
    cell = html_of

    def table(lines: list[tuple[str, list[str]]], head: list[str] | None = None) -> str:
        first = f"<tr><th></th>{''.join(f'<th>{cell(say(name))}</th>' for name in head)}</tr>" if head else ""
        body = "".join(f"<tr><td>{cell(say(name))}</td>" + "".join(f"<td>{cell(say(text))}</td>" for text in texts) + "</tr>" for name, texts in lines)
        return f"<table>{first}{body}</table>" if lines else ""

    of_machine = table([(name, [text]) for name, text in others])
    return (f'<section id="answers"><h2>{cell(say(title(run)))}</h2><div class="answers">{table(ours, names)}{of_machine}{table(numbered, heads)}'
            "</div></section>") + losses_section(Answers(run), say)


def warnings(run: Run) -> list[str]:
    """What a reader of the answers has to know: a motion that still changes from cycle to cycle, and contacts beyond their theory."""
    rows, found, said = Answers(run), [], ""
    for pre, name in PLACES.values():
        change = rows(f"{pre}film_thickness_change")
        if change is not None and abs(change) > MOST_CHANGE:
            said = f": the film thickness at the {name} changes by {100 * abs(change):.2g} % from cycle to cycle"
        for row, what in (("impacts", "faster"), ("contacts", "deeper")):
            if beyond := rows(f"{pre}{row}_beyond_validity"):
                contacts = rows(f"{pre}contacts") or beyond
                found.append(f"{beyond:.0f} of {contacts:.0f} contacts at the {name} are {what} than the theory holds.")
    if run.summary.get("cycle_is_settled", ("", ""))[0] == "no":
        turns = rows("crank_revolutions") or 0.0
        found.insert(0, f"The motion did not repeat within {turns:.4g} revolutions{said}: other cycles have other answers, of which gudgeon-plot orders shows the "
                     "scatter" if run.summary.get("motion", ("", ""))[0] == "not_periodic" else f"The motion has not settled{said}; --set run.until=periodic")  # fmt: skip
    return found


def title(run: Run) -> str:
    """What the answers are of."""
    if "cycle_start" not in run.summary:
        return "Answers of the run"
    turns = Answers(run)("cycle_revolutions") or 1
    return "Answers of the last cycle" + (f" ({turns:g} revolutions)" if turns > 1 else "")

