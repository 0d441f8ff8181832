"""The page of one run: everything in one HTML file that needs no network.

The trace is stored as float32 columns, and the part of plotly.js that draws lines unchanged (npm: plotly.js-basic-dist-min 4.1.1, gzip -9n);
both are compressed by gzip and unpacked by the browser.
"""

import base64
import gzip
import html
import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from gudgeon.language import Language
from gudgeon.names import PLACES, prefixed, suited
from gudgeon.plots import film_pressure
from gudgeon.plots.bearing import last_cycle as rows_of_last_cycle
from gudgeon.plots.bearing import run_cycle
from gudgeon.report import answers
from gudgeon.report.case_rows import case_rows, defaults
from gudgeon.results import Run, numbered

PAGE = Path(__file__).parent / "assets"
LIBRARY = PAGE / "plotly-basic.min.js.gz"

#: A trace with more rows is thinned out; peaks are kept.
MOST_ROWS = 8000

#: Angles around the pin at which the film's pressure is drawn.
ANGLES = 72

#: Axes of an orbit.
ECCENTRICITIES = ("<i>e<sub>y</sub></i> / <i>c</i>", "<i>e<sub>x</sub></i> / <i>c</i>")

#: Quantities of a summary that concern the program and not the run.
OF_THE_PROGRAM = ("identity", "version", "compiler", "compiler_options", "trace_bytes", "events_bytes")

#: Corners of a skirt in its bore, and their names on the page.
CORNERS = {1: "top, +y", 2: "bottom, +y", 3: "top, -y", 4: "bottom, -y"}

#: Columns that the animation needs, if the run has them.
MOTION = (
    "time",
    "crank_angle",
    "rod_angle",
    "piston_position",
    "crank_speed",
    "pin_force_x",
    "pin_force_y",
    "eccentricity_x",
    "eccentricity_y",
    "film_thickness",
    "phase",
    "normal_force",
    "cylinder_pressure",
    *(f"rod_mode_{k}" for k in range(1, 9)),
    "crank_pin_eccentricity_x",
    "crank_pin_eccentricity_y",
    "crank_pin_phase",
    "small_end_eccentricity_x",
    "small_end_eccentricity_y",
    "small_end_phase",
    "main_bearing_eccentricity_x",
    "main_bearing_eccentricity_y",
    "main_bearing_phase",
    "pin_angle",
    "piston_offset",
    "piston_tilt",
    *(f"guide_{corner}_force" for corner in CORNERS),
)

#: Plots over time: column, title, unit shown, factor; with the curve of the ideal joint if there is such a run.
OVER_TIME = (
    ("pin_force", "Pin force", "kN", 1e-3),
    ("pin_angle", "Angle of the pin", "°", 180 / np.pi),
    ("pin_speed", "Speed of the pin", "rad/s", 1.0),
    ("crank_speed", "Crank speed", "rpm", 30 / np.pi),
    ("crank_acceleration", "Crank angular acceleration", "10³ rad/s²", 1e-3),
    ("rod_acceleration", "Rod angular acceleration", "10³ rad/s²", 1e-3),
    ("piston_acceleration", "Piston acceleration", "10³ m/s²", 1e-3),
    ("rod_mid_deflection", "Rod: deflection half way", "µm", 1e6),
    ("rod_stretch", "Rod: stretch", "µm", 1e6),
    ("rod_strain_energy", "Rod: strain energy", "mJ", 1e3),
    ("crankshaft_twist", "Crankshaft: twist", "mrad", 1e3),
    ("crank_moment", "Crank moment", "N m", 1.0),
    ("engine_moment_z", "Roll moment on the engine", "N m", 1.0),
    ("engine_force_x", "Force on the engine along the cylinder", "kN", 1e-3),
    ("guide_force", "Guide force", "kN", 1e-3),
    ("guide_friction_force", "Friction of the piston on its guide", "N", 1.0),
    ("skirt_force", "Force on the skirt", "kN", 1e-3),
    ("skirt_min_film_thickness", "Least film of the skirt", "µm", 1e6),
    ("ring_friction_force", "Friction of the piston rings", "N", 1.0),
    ("piston_offset", "Piston across its bore", "µm", 1e6),
    ("piston_tilt", "Tilt of the piston", "mrad", 1e3),
    ("gas_force", "Gas force", "kN", 1e-3),
    ("energy_residual", "Energy residual", "J", 1.0),
)

#: Plots over time of every bearing, by the part of their columns behind the place: title, unit shown, factor. Those of the first
#: come before all other plots.
FIRST_OF_BEARINGS = (
    ("film_thickness", "film thickness (below 0: penetration)", "µm", 1e6),
    ("normal_force", "contact force", "kN", 1e-3),
)
OF_BEARINGS = (
    ("eccentricity_ratio", "eccentricity over the clearance", "", 1.0),
    ("asperity_force", "force of the asperities", "kN", 1e-3),
    ("friction_force", "friction", "N", 1.0),
    ("film_temperature", "film temperature", "°C", 1.0),
    ("film_viscosity", "viscosity of the film", "mPa s", 1e3),
    ("max_film_pressure", "largest film pressure", "MPa", 1e-6),
    ("film_power", "power that the film takes", "W", 1.0),
    ("film_side_flow", "oil flow out of the film", "cm³/s", 1e6),
    ("film_moment", "moment of the oil shear", "N m", 1.0),
    ("film_force", "film force", "kN", 1e-3),
)

#: Units of columns in a trace, and what a page shows: unit and factor.
UNITS = {"K": ("°C", 1.0), "m": ("µm", 1e6), "N": ("kN", 1e-3), "Pa": ("MPa", 1e-6), "kg/s": ("g/s", 1e3), "Pa.s": ("mPa s", 1e3), "N.m": ("N m", 1.0)}

#: Parts of a page that its line of contents leads to, if the run has them: what they are called.
CONTENTS = (("answers", "Answers"), ("losses", "Losses"), ("motion", "Motion"), ("curves", "Plots"), ("more-plots", "More plots"), ("wear", "Wear"),
            ("cycles", "Settled cycles"), ("summary", "Summary"), ("case", "Case"), ("program", "Program"))

#: Plots that a page shows at once, if the run has them, and prints: by their first column, and how many over time. The others are folded.
MAIN = re.compile(r"(\w+_)?(film_thickness|normal_force)|pin_force|crank_speed|piston_acceleration|crank_moment|guide_force|gas_force|cylinder_volume")
MOST_MAIN = 6

#: Plots in which the run of the ideal joint has a plot of its own, because the quantity is a property of that run.
APART = ("energy_residual",)


def packed(data: bytes) -> str:
    """Bytes compressed by gzip, as base64 text; equal bytes give equal texts."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def chosen_rows(columns: list[np.ndarray], most: int = MOST_ROWS, apart: tuple[int, int] = (0, 0)) -> np.ndarray:
    """Rows to keep: all, or for each stretch of rows the first and those with the smallest and largest value of every column, and rows at
    equal distances between them up to half of `most`. Of the rows `apart` (first, and the one behind the last) as many are kept as of all others."""
    rows = len(columns[0])
    if rows <= most:
        return np.arange(rows)
    if 0 < apart[1] - apart[0] < rows:
        return np.union1d(chosen_rows(columns, most // 2), apart[0] + chosen_rows([values[slice(*apart)] for values in columns], most // 2))
    stretches = max(1, most // (2 * len(columns) + 1))
    bounds = np.linspace(0, rows, stretches + 1).astype(int)
    kept = {0, rows - 1}
    for low, high in zip(bounds, bounds[1:]):
        kept.add(int(low))
        for values in columns:
            kept.update((int(low + values[low:high].argmin()), int(low + values[low:high].argmax())))
    if len(kept) < most // 2:
        kept.update(np.linspace(0, rows - 1, most // 2 - len(kept)).astype(int).tolist())
    return np.array(sorted(kept))


def with_sizes(run: Run) -> dict[str, np.ndarray]:
    """The run's columns, temperatures in °C, and the magnitudes of the forces on the pins, the crank and in the films."""
    columns = {name: run[name] - (273.15 if run.units.get(name) == "K" else 0.0) for name in run.trace.columns}
    for name in [name.removesuffix("_x") for name in columns if name.endswith("force_x")]:
        if f"{name}_y" in columns:
            columns[name] = np.hypot(run[f"{name}_x"], run[f"{name}_y"])
    return columns


#: A plot over time: title, unit shown, factor, and the columns of its curves with their names.
Listed = tuple[str, str, float, list[tuple[str, str]]]

#: Colours of the bearings' curves in one chart, by place.
OF_PLACE = dict(zip(PLACES, ("blue", "vermilion", "green", "purple")))


def over_time(columns: dict[str, np.ndarray], run: Run) -> list[Listed]:
    """The plots over time: those of every run, one for each quantity of the bearings, and those of the columns that the case asks for
    by name."""

    def of_bearings(listed: Sequence[tuple[str, str, str, float]]) -> list[Listed]:
        found = []
        for name, title, unit, factor in listed:
            those = [(place, pre + name) for place, (pre, _) in PLACES.items() if pre + name in columns and is_informative(columns[pre + name])]
            pre = named_bearing(columns, those[0][0]) if len(those) == 1 else ""
            found.append(((pre + title).capitalize(), unit, factor, [(column, PLACES[place][1]) for place, column in those]))
        return found

    of_machine: list[Listed] = [(title, unit, factor, [(name, "")]) for name, title, unit, factor in OVER_TIME]
    if "crankpin_force" in columns:
        of_machine[0] = ("Forces on the pins", "kN", 1e-3, [("pin_force", "piston pin"), ("crankpin_force", "crank pin")])
    found = of_bearings(FIRST_OF_BEARINGS) + of_machine + of_bearings(OF_BEARINGS)
    known = {name for *_, curves in found for name, _ in curves} | {name for name in columns if name.endswith(("_x", "_y")) and name[:-2] in columns}
    asked = [part.strip() for part in str(run.parameter("output", "columns", "")).split(",")]
    for name in asked:
        if name in columns and name not in known and name not in ("time", "crank_angle"):
            unit, factor = UNITS.get(run.units.get(name, ""), (run.units.get(name, ""), 1.0))
            found.append((name.replace("_", " ").capitalize(), unit, factor, [(name, "")]))
    return found


def named_bearing(columns: dict[str, np.ndarray], place: str) -> str:
    """The name of a bearing before a quantity; empty for the piston pin's if there is no other."""
    pre, name = PLACES[place]
    others = any(f"{other}eccentricity_x" in columns for other, _ in PLACES.values() if other)
    return f"{name}: " if pre or others else ""


def is_informative(values: np.ndarray) -> bool:
    return bool(np.ptp(values) > 0)


def timed(name: str, factor: float, said: str, colour: str) -> dict:
    """A curve over time."""
    return {"name": said, "x": "time", "x_factor": 1e3, "y": name, "y_factor": factor, "colour": colour}


def colour_of(bearing: str) -> str:
    """Colour of a bearing, by its name."""
    return next(OF_PLACE[place] for place, (_, name) in PLACES.items() if name == bearing)


def plots(columns: dict[str, np.ndarray], run: Run) -> list[dict]:
    """The plots of the page, in the form that its script expects: curves refer to columns by name."""
    found = []
    for title, unit, factor, listed in over_time(columns, run):
        listed = [(name, said) for name, said in listed if name in columns and is_informative(columns[name])]
        if listed and listed[0][0] in APART:
            name = listed[0][0]
            for run_name, said in ((name, title), (f"ideal {name}", f"{title} of the ideal joint's run")):
                if run_name in columns and is_informative(columns[run_name]):
                    shown_unit, factor = prefixed(unit, columns[run_name])
                    colour = "blue" if run_name == name else "ink"
                    found.append({"title": said, "x": "time [ms]", "y": shown_unit, "timed": True, "curves": [timed(run_name, factor, said, colour)]})
            continue
        several, curves = len(listed) > 1, []
        for name, said in listed:
            colour = colour_of(said) if several else "blue"
            curves.append(timed(name, factor, said if several else "this run", colour))
            if f"ideal {name}" in columns:
                curves.append(timed(f"ideal {name}", factor, "ideal joint", colour if several else "ink") | {"dash": "dash"})
        if curves:
            found.append({"title": title, "x": "time [ms]", "y": unit, "timed": True, "curves": curves})

    for quantity, title, unit, factor in (
        ("gap", "Gaps of the skirt's corners (below 0: penetration)", "µm", 1e6),
        ("deflection", "Deflections of the skirt's faces", "µm", 1e6),
        ("force", "Forces on the skirt's corners", "kN", 1e-3),
    ):
        curves = [timed(f"guide_{corner}_{quantity}", factor, said, colour)
                  for (corner, said), colour in zip(CORNERS.items(), ("blue", "green", "vermilion", "purple")) if f"guide_{corner}_{quantity}" in columns]
        if curves:
            found.append({"title": title, "x": "time [ms]", "y": unit, "timed": True, "curves": curves})

    def plane(title: str, x: str, y: str, names: tuple[str, str], factors: tuple[float, float], **more: object) -> dict:
        curve: dict[str, object] = {
            "name": title,
            "x": names[0],
            "x_factor": factors[0],
            "y": names[1],
            "y_factor": factors[1],
            "colour": "blue",
        }
        return {"title": title, "x": x, "y": y, "timed": False, "square": True, "curves": [curve], **more}

    if run.clearance:
        found.append(
            plane(
                "Pin orbit over the clearance",
                *ECCENTRICITIES,
                ("eccentricity_y", "eccentricity_x"),
                (1 / run.clearance,) * 2,
                circle=True,
                phase="phase",
            )
        )
    for place, title in (("small_end", "Orbit of the pin in the small end"), ("crank_pin", "Orbit of the crank pin"),
                         ("main_bearing", "Orbit in the main bearing")):
        if f"{place}_phase" in columns:
            found.append(
                plane(
                    title,
                    *ECCENTRICITIES,
                    (f"{place}_eccentricity_y", f"{place}_eccentricity_x"),
                    (1 / float(run.parameter(f"{place}.joint", "clearance")),) * 2,
                    circle=True,
                    phase=f"{place}_phase",
                )
            )
    unit, factor = suited("10³ m/s²", 1e-3, columns["piston_acceleration"])
    found.append(
        plane(
            "Piston: velocity and acceleration",
            "velocity [m/s]",
            f"acceleration [{unit}]",
            ("piston_velocity", "piston_acceleration"),
            (1.0, factor),
        )
    )
    if "cylinder_volume" in columns:
        unit, factor = suited("cm³", 1e6, columns["cylinder_volume"])
        found.append(plane("p–V diagram", f"{run.volume} [{unit}]", "pressure [bar]", ("cylinder_volume", "cylinder_pressure"), (factor, 1e-5)))
    for plot in (plot for plot in found if plot["timed"]):
        unit, factor = suited(plot["y"], plot["curves"][0]["y_factor"], np.concatenate([columns[curve["y"]] for curve in plot["curves"]]))
        plot["y"] = unit
        for curve in plot["curves"]:
            curve["y_factor"] = factor
    return found


def warnings(run: Run) -> list[str]:
    """What a reader has to know of a run besides its notes: how far it is certified, why it ended early, what its answers lack."""
    found = answers.warnings(run)
    if (until := run.certified_until) is not None:
        found.append(
            f"The run is certified up to {answers.amount(until, 's')}: beyond, shaded in the plots, single values are not reliable. How far "
            "results of the whole run are is in the summary (..._difference)."
        )
    status = run.summary.get("status", ("unknown", ""))[0]
    if status != "done":
        found.append(f"The run did not end as requested: {status}.")
    return found


def notes(run: Run) -> list[str]:
    """The notes of the summary, in the words of the program."""
    return [text for name, (text, _) in run.summary.items() if name.startswith("note_")]


def contacts(run: Run) -> list[dict]:
    return [{key: float(value) for key, value in row.items()} for row in run.contacts.to_dict("records")]


def rows_html(rows: list[tuple[str, ...]], heading: str = "") -> str:
    def cell(text: str, is_name: bool) -> str:   # long texts take several lines, paths too; a short value never; names are broken behind a "_"
        is_long, escaped = len(text) > 30, html.escape(text)
        kind = ' class="text"' if is_long else ""
        return f"<td{kind}>{escaped.replace('_', '_<wbr>') if is_long or is_name else escaped}</td>"

    cells = ["<tr>" + "".join(cell(text, place == 0) for place, text in enumerate(row)) + "</tr>" for row in rows]
    head = f'<tr><th colspan="3">{html.escape(heading)}</th></tr>' if heading else ""
    return head + "".join(cells)


def summary_number(text: str) -> str:
    try:
        return f"{float(text):.6g}"
    except ValueError:
        return text


def film_columns(run: Run, rows: np.ndarray, fields: list[pd.DataFrame] | None = None) -> tuple[np.ndarray, np.ndarray, bool] | None:
    """Square root of the film's pressure divided by its largest value, as bytes (rows, angles); peak pressure of each row [Pa]; and
    whether the pressure is below its mean anywhere."""
    angles = 2 * np.pi * np.arange(ANGLES) / ANGLES - np.pi
    found = film_pressure.pressure(run, angles)
    if found is None and fields:
        found = film_pressure.from_fields(run, fields, angles)
    if found is None:
        return None
    found = found[rows]
    largest = np.abs(found).max() or 1.0
    levels = np.sign(found) * np.sqrt(np.abs(found) / largest)
    return np.rint(127 * levels).astype(np.int8), found.max(axis=1), bool((found < 0).any())


def oil_of(run: Run, rows: np.ndarray, fields: list[pd.DataFrame] | None) -> np.ndarray | None:
    """Part of the gap that oil fills, as bytes (rows, angles), of a film with memory; None of other films."""
    if not fields or "film_fraction" not in fields[0]:
        return None
    angles = 2 * np.pi * np.arange(ANGLES) / ANGLES - np.pi
    return np.rint(127 * film_pressure.from_fields(run, fields, angles, "film_fraction")[rows]).astype(np.int8)


def supply_of(run: Run) -> list[dict[str, float]]:
    """Middles and half widths [rad] of the grooves and holes that feed the piston pin's film, if they are in its bearing."""
    if run.parameter("supply", "kind") in (None, "circumferential_groove") or run.parameter("supply", "fixed_to") == "pin":
        return []
    radius = float(run.parameter("joint", "bearing_radius"))
    wide = float(run.parameter("supply", "width_deg", 0.0)) * np.pi / 360
    half = wide or 0.5 * float(run.parameter("supply", "diameter", 0.0)) / radius
    middles = run.parameter("supply", "position_deg")
    middles = middles if isinstance(middles, list) else str(middles).split(",")
    return [{"angle": float(np.radians(float(middle))), "half": half} for middle in middles]


def largest_deflection(columns: dict[str, np.ndarray]) -> float:
    """Largest deflection of an elastic rod across its chord, anywhere along the rod [m]."""
    modes = [name for name in columns if name.startswith("rod_mode_")]
    if not modes:
        return 0.0
    along = np.linspace(0, np.pi, 33)
    shapes = np.array([np.sin(int(name.rsplit("_", 1)[1]) * along) for name in modes])
    return float(np.abs(np.array([columns[name] for name in modes]).T @ shapes).max())


def engine_of(run: Run, columns: dict[str, np.ndarray]) -> dict | None:
    """Several cylinders on one crankshaft, as the page's script draws them: for each cylinder its station (from 0) and the angle from
    the full cylinder's crank to its own [rad]; for each station the column of its twist, or None for the full cylinder's; and the
    largest twist [rad]. None for a run of one cylinder without stations."""
    cylinders = numbered(run.case, "cylinder")
    inertias = run.case.get("crankshaft", {}).get("inertia", [])
    stations = len(inertias) if isinstance(inertias, list) else 0
    if len(cylinders) < 2 and stations < 2:
        return None
    cylinders = cylinders or [{}]
    full = next((i for i, one in enumerate(cylinders) if one.get("full")), 0)
    angles = [np.radians(float(one.get("phase_deg", 0.0)) - float(one.get("bank_deg", 0.0))) for one in cylinders]
    twists = [name if (name := f"station_{i + 1}_twist") in columns else None for i in range(stations)]
    return {
        "cylinders": [[max(int(one.get("station", 1)), 1) - 1, float(angle - angles[full])] for one, angle in zip(cylinders, angles)],
        "full": full,
        "twists": twists,
        "largest": max([float(np.abs(columns[name]).max()) for name in twists if name], default=0.0),
    }


def scene_of(
    run: Run,
    ideal: Run | None = None,
    fields: list[pd.DataFrame] | None = None,
    language: Language | None = None,
    most: int = MOST_ROWS,
    shown: Callable[[dict], bool] = lambda plot: True,
) -> tuple[dict, dict[str, bytes]]:
    """What drawing.js draws of a run: a scene for JSON, and bytes by name: its columns one after the other as float32 (`trace`), and the
    film's pressure and oil around the pin (`pressure`, `oil`; empty without them). `fields` as in `page`; `most`: rows that are kept;
    `shown`: of each plot, whether it is wanted."""
    language = language or Language()
    say = language.say
    columns = with_sizes(run)
    if ideal is not None:
        for name, values in with_sizes(ideal).items():
            if name in columns and name != "time":
                columns[f"ideal {name}"] = np.interp(run["time"], ideal["time"], values)
    drawn = [plot for plot in plots(columns, run) if shown(plot)]
    main = [plot for plot in drawn if MAIN.fullmatch(plot["curves"][0]["y" if plot["timed"] else "x"])]
    timed_ones = [plot for plot in main if plot["timed"]][:MOST_MAIN]
    for plot in drawn:
        plot["main"] = plot in timed_ones or plot in main and not plot["timed"]
    for plot in drawn:
        plot |= {part: say(plot[part]) for part in ("title", "x", "y")}
        for curve in plot["curves"]:
            curve["name"] = say(curve["name"])
    used = [name for name in MOTION if name in columns]
    for plot in drawn:
        for curve in plot["curves"]:
            used += [curve[axis] for axis in ("x", "y") if curve[axis] not in used]
        if plot.get("phase") in columns and plot["phase"] not in used:
            used.append(plot["phase"])
    engine = engine_of(run, columns)
    used += [name for name in (engine or {}).get("twists", []) if name and name not in used]
    cycle = last_cycle(run, columns)
    ends = np.searchsorted(run["time"], (cycle["begin"], cycle["end"])) + (-1, 1) if cycle else (0, 0)
    rows = chosen_rows([columns[name] for name in used], most, (max(int(ends[0]), 0), int(ends[1])))   # a page opens on the last cycle
    for plot in drawn:   # of the last cycle alone where lines between the rows kept of others are no curves: some 90 rows a revolution still are, but for pressures that jump
        plot["alone"] = not plot["timed"] and len(rows) < len(run["time"]) / (1 if "cylinder_volume" in plot["curves"][0]["x"] else 8)
    film = film_columns(run, rows, fields)
    oil = oil_of(run, rows, fields)
    if film:
        columns["film_peak"] = np.zeros(len(run["time"]))
        columns["film_peak"][rows] = film[1]
        used.append("film_peak")
    touched = contacts(run)
    bore = bore_of(run) if "piston_tilt" in columns else None
    scene = {
        "rows": len(rows),
        "columns": used,
        "plots": drawn,
        "contacts": touched,
        "line": time_line(columns, run) | {"title": say(time_line(columns, run)["title"])},
        "start": first_moment(columns, [field["time"].iloc[0] for field in fields or []], cycle),
        "angles": ANGLES if film else 0,
        "signed": bool(film and film[2]),
        "supply": supply_of(run),
        "certified": run.certified_until,
        "cycle": cycle,
        "clearance": run.clearance,
        "crank": float(run.parameter("mechanism", "crank_length")),
        "rod": float(run.parameter("mechanism", "rod_length")),
        "axis": float(run.parameter("mechanism", "axis_offset", 0)),
        "bearing": drawn_bearing_radius(run),
        "bore": bore,
        "crank_pin": orbit_of(run, columns, "crank_pin"),
        "small_end": orbit_of(run, columns, "small_end"),
        "main_bearing": orbit_of(run, columns, "main_bearing"),
        "engine": engine,
        "speed": float(run.parameter("initial", "crank_speed")),
        "modes": sum(name.startswith("rod_mode_") for name in used),
        "peak": {
            "pin_force": float(columns["pin_force"].max()),
            "guide_force": max([float(columns[f"guide_{i}_force"].max()) for i in CORNERS if f"guide_{i}_force" in columns], default=0.0),
            "normal_force": max([contact["force"] for contact in touched], default=0.0),
            "eccentricity_ratio": float(run["eccentricity_ratio"].max()) if run.clearance else 0.0,
            "cylinder_pressure": float(columns["cylinder_pressure"].max()) if "cylinder_pressure" in columns else 0.0,
            "rod_deflection": largest_deflection(columns),
        },
    }
    if "normal_force" in columns:
        scene["peak"]["normal_force"] = max(scene["peak"]["normal_force"], float(columns["normal_force"].max()))
    data = {
        "trace": b"".join(columns[name][rows].astype("<f4").tobytes() for name in used),
        "pressure": film[0].tobytes() if film else b"",
        "oil": b"" if oil is None else oil.tobytes(),
    }
    return scene, data


def text_of(name: str, language: Language) -> str:
    """A file of the pages with the parts that they share, its texts in [[...]] translated."""
    text = (PAGE / name).read_text(encoding="utf-8")
    for part in ("head", "motion"):
        text = text.replace(f"{{{{{part}}}}}", (PAGE / f"{part}.html").read_text(encoding="utf-8"))
    return re.sub(r"\[\[(.+?)\]\]", lambda found: html.escape(language.say(found[1])), text)


def filled(text: str, parts: Mapping[str, str]) -> str:
    """A text with {{fields}}, each filled once, so that inserted texts are not searched for fields."""
    head, *fields = text.split("{{")
    return head + "".join(parts[name] + rest for name, rest in (field.split("}}", 1) for field in fields))


def page(
    run: Run,
    ideal: Run | None = None,
    fields: list[pd.DataFrame] | None = None,
    language: Language | None = None,
    cycle_columns: list[str] | None = None,
    worn: list[tuple[str, pd.DataFrame]] | None = None,
) -> str:
    """The HTML text of the page. `fields`: the pressures of a NAME.film.csv; `cycle_columns`: columns whose cycles and orders are
    shown; `worn`: the worn surfaces of a NAME.wear.csv."""
    from gudgeon.report import cycles as report_cycles

    language = language or Language()
    say = language.say
    scene, data = scene_of(run, ideal, fields, language)
    scene |= spoken(language, "drawing", "page")
    said = [*(say(text) for text in warnings(run)), *notes(run)]
    known = defaults()
    left_out = say("Keys that have their defaults are left out." if known is not None else "Keys that are empty, 0 or no are left out.")
    case = "".join(rows_html([(key, language.number(text)) for key, text in rows], f"&{group}") for group, rows in case_rows(run, known))

    def summary(of_program: bool) -> str:
        return rows_html(
            [
                (name, summary_number(value), "" if unit == "1" else unit)
                for name, (value, unit) in run.summary.items()
                if not name.startswith(("steps_of_order", "note_")) and (name in OF_THE_PROGRAM) == of_program
            ]
        )

    parts = {
        "title": html.escape(str(run.parameter("case", "title", "")) or run.name),
        "subtitle": html.escape(
            f"{run.name}: "
            + say(
                f"{len(run['time'])} samples over {run['time'][-1]:.6g} s"
                + (f", of which {scene['rows']} are kept here, peaks among them" if scene["rows"] < len(run["time"]) else "")
            )
        ),
        "language": language.name,
        "style": (PAGE / "page.css").read_text(encoding="utf-8"),
        "drawing": (PAGE / "drawing.js").read_text(encoding="utf-8"),
        "script": (PAGE / "page.js").read_text(encoding="utf-8"),
        "warnings": "".join(f'<p class="warning">{html.escape(text)}</p>' for text in said)
        or f'<p class="fine">{html.escape(say("No warnings."))}</p>',
        "wear": wear_section(worn, language) if worn else "",
        "answers": answers.section(run, language),
        "cycles": report_cycles.section(run, cycle_columns, language),
        "summary": f"<div><table>{summary(False)}</table></div>",
        "program": f"<div><table>{summary(True)}</table></div>",
        "case": f'<p class="hint">{html.escape(left_out)}</p><div><table>{case}</table></div>',
        "footer": html.escape(
            f"gudgeon {run.summary.get('version', ('', ''))[0]}. "
            + say(
                "Film pressures are computed for this page from the motion in the trace. Plots by plotly.js, MIT licence."
            )
        ),
        "scene": json.dumps(scene, ensure_ascii=False).replace("</", "<\\/"),
        **{name: packed(content) if content else "" for name, content in data.items()},
        "library": base64.b64encode(LIBRARY.read_bytes()).decode("ascii"),
    }
    there = "".join(parts.values()) + text_of("page.html", language)
    parts["contents"] = " ".join(f'<a href="#{name}">{html.escape(say(said))}</a>' for name, said in CONTENTS if f'id="{name}"' in there)
    return filled(text_of("page.html", language), parts)


def wear_section(worn: list[tuple[str, pd.DataFrame]], language: Language) -> str:
    """The section on worn surfaces as HTML."""
    from gudgeon.plots import wear as wear_pictures
    from gudgeon.report import cycles as report_cycles

    heading = language.say("Wear of pin and bore")
    drawing = wear_pictures.draw(worn, [PLACES[joint][1] for joint, _ in worn])
    said = "Depth around each surface, exaggerated, and over the angle on it"
    return f'<section id="wear"><h2>{html.escape(heading)}</h2>{report_cycles.picture(drawing, said, language)}</section>'


def last_cycle(run: Run, columns: dict[str, np.ndarray]) -> dict[str, float] | None:
    """Times at which the last whole cycle of the run begins and ends [s], the angle at its beginning [rad], its length and the beginning
    of its axis [degrees]; None without one in the trace."""
    try:
        begin, length, turns = (float(run.summary[f"cycle_{name}"][0]) for name in ("start", "duration", "revolutions"))
    except (KeyError, ValueError):
        return None
    time = columns["time"]
    if not (length > 0 and time[0] <= begin + 0.01 * length and begin < time[-1]):
        return None
    angle = float(np.interp(begin, time, columns["crank_angle"]))
    return {"begin": begin, "end": begin + length, "angle": angle, "degrees": 360 * turns, "from": first_angle(run)}


def first_angle(run: Run) -> float:
    """Where an axis of the crank angle in the last cycle begins [degrees]: at -360 for two revolutions whose largest pressure is within
    90 degrees of 0 or 720, where an axis from 0 would cut it in two; else at 0."""
    gas = next((name for name in ("cylinder_pressure", "gas_force") if name in run), None)
    if gas is None or round(run_cycle(run) / np.pi) != 4:
        return 0.0
    rows = rows_of_last_cycle(run)
    peak = np.degrees(run["crank_angle"][rows][np.argmax(run[gas][rows])]) % 720
    return -360.0 if min(peak, 720 - peak) < 90 else 0.0


def first_moment(columns: dict[str, np.ndarray], of_fields: Sequence[float] = (), cycle: dict[str, float] | None = None) -> float:
    """The time at which the page opens [s]: that of the largest pin force in the last cycle, or after the first tenth of a run without
    one, where there are fields of a film between the first and the last of them."""
    time = columns["time"]
    shown = time >= (cycle["begin"] if cycle else time[0] + 0.1 * (time[-1] - time[0]))
    if of_fields:
        shown = (time >= min(of_fields)) & (time <= max(of_fields))
    force = np.where(shown, columns["pin_force"], 0.0)
    return float(time[int(np.argmax(force))])


def script_words(*scripts: str) -> list[str]:
    """The texts in scripts of the pages: those in W(...)."""
    found = {word for name in scripts for word in re.findall(r'\bW\("([^"]+)"\)', (PAGE / f"{name}.js").read_text(encoding="utf-8"))}
    return sorted(found)


def spoken(language: Language, *scripts: str) -> dict[str, object]:
    """What drawing.js calls `spoken`: the words of these scripts in the page's language, and whether numbers have decimal commas."""
    return {"words": {word: language.say(word) for word in script_words(*scripts)}, "comma": not language.is_english}


def time_line(columns: dict[str, np.ndarray], run: Run) -> dict:
    """The curve of the page's time line: the film thickness from 0 or below, or the magnitude of the pin's force. Its extremes are
    those of the summary, which include the values between two rows."""

    def of_summary(name: str, otherwise: float) -> float:
        try:
            return float(run.summary[name][0])
        except (KeyError, ValueError):
            return otherwise

    if "film_thickness" in columns:
        thickness = columns["film_thickness"]
        least = min(float(thickness.min()), of_summary("min_film_thickness", np.inf))
        return {
            "column": "film_thickness",
            "title": named_bearing(columns, "piston_pin") + "film thickness",
            "unit": "m",
            "range": [min(0.0, least), float(thickness.max())],
            "extremes": [least, float(thickness.max())],
        }
    largest = max(float(columns["pin_force"].max()), of_summary("max_pin_force", 0.0))
    return {
        "column": "pin_force",
        "title": "pin force",
        "unit": "N",
        "range": [0.0, largest],
        "extremes": [float(columns["pin_force"].min()), largest],
    }


def orbit_of(run: Run, columns: dict[str, np.ndarray], place: str) -> dict[str, float] | None:
    """Clearance of a joint [m] and its largest eccentricity over the clearance; None if it has no clearance."""
    if f"{place}_eccentricity_x" not in columns:
        return None
    clearance = float(run.parameter(f"{place}.joint", "clearance"))
    largest = np.hypot(columns[f"{place}_eccentricity_x"], columns[f"{place}_eccentricity_y"]).max()
    return {"clearance": clearance, "peak_ratio": float(largest) / clearance}


def bore_of(run: Run) -> dict[str, object]:
    """Clearance and dimensions of a skirt in its bore [m]: ends and centre of mass from the pin, along and across."""
    along, across = run.parameter("guide", "piston_com")
    keys = {"clearance": "bore_clearance", "top": "skirt_top", "bottom": "skirt_bottom", "radius": "piston_radius"}
    return {"along": along, "across": across, **{name: float(run.parameter("guide", key)) for name, key in keys.items()}}


def drawn_bearing_radius(run: Run) -> float:
    """The bearing's radius [m], or a radius that suits the picture if the case gives none."""
    return float(run.parameter("joint", "bearing_radius", 0) or 0) or 0.2 * float(
        run.parameter("mechanism", "crank_length")
    )
