"""What a page draws of a run: the scene of its animation and plots, and the numbers behind them as bytes."""

import re
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from gudgeon.language import Language
from gudgeon.plots import film_pressure
from gudgeon.plots.bearing import first_angle
from gudgeon.report.curves import CORNERS, named_bearing, plots, with_sizes
from gudgeon.results import Run, numbered

#: A trace with more rows is thinned out; peaks are kept.
MOST_ROWS = 8000

#: Angles around the pin at which the film's pressure is drawn.
ANGLES = 72

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

#: Plots that a page shows at once, if the run has them, and prints: by their first column, and how many over time. The others are folded.
MAIN = re.compile(r"(\w+_)?(film_thickness|normal_force)|pin_force|crank_speed|piston_acceleration|crank_moment|guide_force|gas_force|cylinder_volume")

MOST_MAIN = 6


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
    say = (language or Language()).say
    columns = with_sizes(run)
    if ideal is not None:
        for name, values in with_sizes(ideal).items():
            if name in columns and name != "time":
                columns[f"ideal {name}"] = np.interp(run["time"], ideal["time"], values)
    drawn = said_plots([plot for plot in plots(columns, run) if shown(plot)], say)
    engine = engine_of(run, columns)
    used = used_columns(columns, drawn, engine)
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
    touched, line = contacts(run), time_line(columns, run)
    scene = {
        "rows": len(rows),
        "columns": used,
        "plots": drawn,
        "contacts": touched,
        "line": line | {"title": say(line["title"])},
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
        "bore": bore_of(run) if "piston_tilt" in columns else None,
        **{place: orbit_of(run, columns, place) for place in ("crank_pin", "small_end", "main_bearing")},
        "engine": engine,
        "speed": float(run.parameter("initial", "crank_speed")),
        "modes": sum(name.startswith("rod_mode_") for name in used),
        "peak": peaks(run, columns, touched),
    }
    data = {
        "trace": b"".join(columns[name][rows].astype("<f4").tobytes() for name in used),
        "pressure": film[0].tobytes() if film else b"",
        "oil": b"" if oil is None else oil.tobytes(),
    }
    return scene, data


def said_plots(drawn: list[dict], say: Callable[[str], str]) -> list[dict]:
    """Plots in the page's language; `main` is true of those that are not folded."""
    main = [plot for plot in drawn if MAIN.fullmatch(plot["curves"][0]["y" if plot["timed"] else "x"])]
    timed_ones = [plot for plot in main if plot["timed"]][:MOST_MAIN]
    for plot in drawn:
        plot["main"] = plot in timed_ones or plot in main and not plot["timed"]
    for plot in drawn:
        plot |= {part: say(plot[part]) for part in ("title", "x", "y")}
        for curve in plot["curves"]:
            curve["name"] = say(curve["name"])
    return drawn


def used_columns(columns: dict[str, np.ndarray], drawn: list[dict], engine: dict | None) -> list[str]:
    """Names of the columns that the animation and the plots need, each once."""
    used = [name for name in MOTION if name in columns]
    for plot in drawn:
        used += [curve[axis] for curve in plot["curves"] for axis in ("x", "y")]
        used += [plot["phase"]] if plot.get("phase") in columns else []
    used += [name for name in (engine or {}).get("twists", []) if name]
    return list(dict.fromkeys(used))


def peaks(run: Run, columns: dict[str, np.ndarray], touched: list[dict]) -> dict[str, float]:
    """Largest values, to which the animation scales what it draws."""

    def largest(*names: str) -> float:
        return max((float(columns[name].max()) for name in names if name in columns), default=0.0)

    return {
        "pin_force": largest("pin_force"),
        "guide_force": largest(*(f"guide_{corner}_force" for corner in CORNERS)),
        "normal_force": max([contact["force"] for contact in touched] + [largest("normal_force")]),
        "eccentricity_ratio": float(run["eccentricity_ratio"].max()) if run.clearance else 0.0,
        "cylinder_pressure": largest("cylinder_pressure"),
        "rod_deflection": largest_deflection(columns),
    }


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


def contacts(run: Run) -> list[dict]:
    return [{key: float(value) for key, value in row.items()} for row in run.contacts.to_dict("records")]


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


def first_moment(columns: dict[str, np.ndarray], of_fields: Sequence[float] = (), cycle: dict[str, float] | None = None) -> float:
    """The time at which the page opens [s]: that of the largest pin force in the last cycle, or after the first tenth of a run without
    one, where there are fields of a film between the first and the last of them."""
    time = columns["time"]
    shown = time >= (cycle["begin"] if cycle else time[0] + 0.1 * (time[-1] - time[0]))
    if of_fields:
        shown = (time >= min(of_fields)) & (time <= max(of_fields))
    force = np.where(shown, columns["pin_force"], 0.0)
    return float(time[int(np.argmax(force))])


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
