"""Bearings of kind quasi_static: their load against the mechanism's columns or the table of the case, their motion against the integral
of the rate at which the film's own equation carries that load, their temperature against the integral of their heat balance.

The rate is e' = v* + (omega_journal + omega_bearing)/2 z x e with the v* of the force -W; the film's power is W . v* and its shear, the
side flow of a short film 2 R L |v*|.
"""
from __future__ import annotations

import bisect
import csv
import dataclasses
import math

from .films import Film, density_at, viscosities
from .mechanics import Vector
from .moving_films import BLOCK, LEAST_RATIO, MOST, drift, rate_for
from .trace import Columns, Run

PLACES = {"piston_pin": "", "crank_pin": "crank_pin_", "main_bearing": "main_bearing_"}
FORCE = 1e-9        # allowed error of the film's force against the load, of the largest load
TABLE = 1e-6        # the same against a table of loads, whose angles have units
LEAST_LOAD = 1e-6   # of the largest load: below it the direction of the force is not known well
UNITS = {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": 4.4482216152605}
HOTTEST = 100.0     # natural size of a temperature [K]


@dataclasses.dataclass
class Bearing:
    """A bearing in one run: forces of the film on its journal [N] and the speeds of journal and bearing [rad/s] in every row."""

    name: str
    run: Run
    columns: Columns
    force: list[Vector]
    journal: list[float]
    bearing: list[float]
    allowed: float    # error of the force


def requested_heat(run: Run) -> list[str]:
    """Names of the columns on request with which the heat of films is judged."""
    names = []
    for place, prefix in PLACES.items():
        if f"{prefix}film_temperature" in run.every:
            law = run.at(place)
            names += [f"{prefix}film_power"]
            names += [f"{prefix}film_side_flow"] if law.text("lubrication.law") == "finite_bearing" else []
            names += [] if law.case["lubrication.film_moment"][0] else [f"{prefix}neglected_shear_power"]
    return names


def bearings_of(run: Run) -> list[Bearing]:
    """The bearings of a run."""
    found = []
    columns = run.every
    turn = columns.get("crank_speed", [run.number("initial.crank_speed")] * len(run.times))
    if "bearing_load.period_deg" in run.case:
        force = [(-x, -y) for x, y in loads_of_table(run)]
        crank, rod = turn, rod_speeds(run, turn)
        speeds = {"fixed": [0.0] * len(turn), "crank": crank, "rod": rod}
        own = next(prefix for prefix in PLACES.values() if f"{prefix}film_thickness" in columns)
        return [Bearing("bearing", run, renamed(columns, own), force, speeds[run.text("bearing_load.journal")],
                        speeds[run.text("bearing_load.bearing")], TABLE)]
    rest, rod = [0.0] * len(turn), [-value for value in columns["rod_speed"]]
    loads = {"piston_pin": ("pin_force", 1.0, rod, rest), "crank_pin": ("crankpin_force", -1.0, turn, rod), "main_bearing": ("crank_bearing_force", 1.0, turn, rest)}
    for place, (name, sign, journal, bearing) in loads.items():
        own = run.at(place)
        if f"{PLACES[place]}eccentricity_x" not in columns:   # ideal, or numbered bearings of several cylinders, which are not judged
            continue
        if own.text("joint.kind") != "quasi_static" or place != "piston_pin" and f"{place}.joint.kind" not in run.case:
            continue
        sign *= own.number("joint.load_share", 1.0) if place == "main_bearing" else 1.0
        force = [(sign * x, sign * y) for x, y in zip(columns[f"{name}_x"], columns[f"{name}_y"])]
        found.append(Bearing(place, own, renamed(columns, PLACES[place]), force, journal, bearing, FORCE))
    return found


def renamed(columns: Columns, prefix: str) -> Columns:
    return columns | {name.removeprefix(prefix): column for name, column in columns.items() if prefix and name.startswith(prefix)}


def rod_speeds(run: Run, turn: list[float]) -> list[float]:
    """Angular speed of the rod of a bearing by itself, from x to y: sin A = ratio sin q turns the other way."""
    ratio = run.number("bearing_load.crank_to_rod")
    return [-w * ratio * math.cos(q) / math.sqrt(1 - (ratio * math.sin(q))**2) for q, w in zip(run.every["crank_angle"], turn)]


def loads_of_table(run: Run) -> list[Vector]:
    """The load on the journal in every row, by the table of the case or constant."""
    rows = [(0.0, *run.pair("bearing_load.load"))]
    if run.text("bearing_load.table"):
        with (run.folder / run.text("bearing_load.table")).open(newline="") as file:
            lines = [line for line in csv.reader(file) if line and not line[0].startswith("#")]
        units = [UNITS[name[name.index("[") + 1:-1]] for name in lines[0][1:]]
        rows = sorted((float(line[0]), *(float(cell) * unit for cell, unit in zip(line[1:], units))) for line in lines[1:])
    period, number = run.number("bearing_load.period_deg"), run.number
    if rows[-1][0] >= rows[0][0] + period * (1 - 1e-12):
        rows.pop()
    rows.append((rows[0][0] + period, *rows[0][1:]))
    angles, direction, ratio = [row[0] for row in rows], math.radians(number("bearing_load.direction_deg")), number("bearing_load.crank_to_rod")
    found = []
    for q in run.every["crank_angle"]:
        at = (math.degrees(q) - number("bearing_load.offset_deg") - angles[0]) % period + angles[0]
        k = min(max(bisect.bisect(angles, at) - 1, 0), len(rows) - 2)
        share = (at - angles[k]) / (angles[k + 1] - angles[k])
        load = [a + share * (b - a) for a, b in zip(rows[k][1:], rows[k + 1][1:])]
        frame = {"fixed": 0.0, "crank": q, "rod": -math.asin(ratio * math.sin(q))}[run.text("bearing_load.frame")]
        x, y = (load + [0.0])[:2]
        turn, factor = direction + frame, number("bearing_load.factor", 1.0)
        found.append((factor * (math.cos(turn) * x - math.sin(turn) * y), factor * (math.sin(turn) * x + math.cos(turn) * y)))
    return found


def carried_motion(one: Bearing, film: Film) -> tuple[dict[int, Vector], dict[int, tuple[float, float]]]:
    """In the rows where the film carries a load, or in some blocks of them if it takes long: the rate of the eccentricity along x and y [m/s];
    what the film takes from the motion [W] and the side flow of a short film [m^3/s]."""
    columns, hot = one.columns, "heat.heat_capacity" in one.run.case
    largest = max(math.hypot(*force) for force in one.force)
    every = max(1, len(one.run.times) // MOST)
    rates: dict[int, Vector] = {}
    figures: dict[int, tuple[float, float]] = {}
    near = None
    for i, force in enumerate(one.force):
        e = columns["eccentricity_x"][i], columns["eccentricity_y"][i]
        size, load = math.hypot(*e), math.hypot(*force)
        if i // BLOCK % every or not LEAST_RATIO < size / film.clearance < 1 or not load > LEAST_LOAD * largest:
            continue
        n = e[0] / size, e[1] / size
        thicker = viscosities(one.run, columns["film_temperature"][i])[0] / film.viscosity if hot else 1.0
        own = (n[0] * force[0] + n[1] * force[1]) / thicker, (n[0] * force[1] - n[1] * force[0]) / thicker
        gap = columns["film_thickness"][i] / film.clearance
        (along, across), near = rate_for(film, size / film.clearance, gap, one.journal[i] + one.bearing[i], own, near)
        rates[i] = n[0] * along - n[1] * across, n[1] * along + n[0] * across
        across -= 0.5 * (one.journal[i] + one.bearing[i]) * size
        shear = (one.journal[i] - one.bearing[i])**2 * film.radius**3 * film.length / (film.clearance * math.sqrt(gap * (1 + size / film.clearance)))
        figures[i] = (thicker * (2 * math.pi * film.viscosity * shear - own[0] * along - own[1] * across),
                      2 * film.radius * film.length * math.hypot(along, across))
    return rates, figures


def judge_carried(run: Run, allowed: float) -> tuple[int, list[str], list[str]]:
    """Number of checks, faults and notes; `allowed`: error of a place over the clearance, and of a temperature over 100 K."""
    checks, faults, notes = 0, [], []
    for one in bearings_of(run) if run.every else []:
        if one.run.text("bearing_load.interpolation") != "cubic":
            largest = max(max(math.hypot(*force) for force in one.force), 1e-300)
            miss = max(math.hypot(x - f[0], y - f[1]) for x, y, f in zip(one.columns["film_force_x"], one.columns["film_force_y"], one.force)) / largest
            checks += 1
            if not miss <= one.allowed:
                faults.append(f"{one.name}: the film's force is {miss:.3g} of the largest load off that load")
        else:
            one.force = list(zip(one.columns["film_force_x"], one.columns["film_force_y"]))
        law = one.run.text("lubrication.law")
        if law == "oscillating_film" or any(key.startswith("asperities.") for key in one.run.case) or one.run.case.get("lubrication.elastic_film", [False])[0] \
                or one.run.number("lubrication.thinning_ratio", 1.0) < 1:
            notes.append(f"{one.name}: motion not judged, its film is not alone or not linear")
            continue
        film = Film(one.run)
        if film.is_solved:
            notes.append(f"{one.name}: motion not judged, a film of finite length is solved on a coarse grid")
            continue
        rates, figures = carried_motion(one, film)
        places = {name: one.columns[name] for name in ("eccentricity_x", "eccentricity_y")}
        far, _, name = drift(run.times, rates, places, film.clearance)
        checks += 1
        if not far <= allowed:
            faults.append(f"{one.name}: {name} is not the integral of the rate by the load: {far:.3g} of the clearance off, {allowed:.1g} allowed")
        if "heat.heat_capacity" in one.run.case:
            made, found = judge_heat(one, figures, allowed, film)
            checks += made
            faults += found
    return checks, faults, notes


def judge_heat(one: Bearing, figures: dict[int, tuple[float, float]], allowed: float, film: Film) -> tuple[int, list[str]]:
    """The power and the flow of a film in every row, and its temperature against the integral of what heats it less what flows away."""
    number, columns, faults = one.run.number, one.columns, []
    heating = [a + b for a, b in zip(columns["film_power"], columns.get("neglected_shear_power", [0.0] * len(one.force)))]
    for k, (name, column) in enumerate((("film_power", heating), ("film_side_flow", columns.get("film_side_flow")))[:2 if film.law == "finite_bearing" else 1]):
        largest = max(map(abs, column))
        miss = max((abs(column[i] - pair[k]) for i, pair in figures.items()), default=0.0)
        if not miss <= 1e-6 * largest + 1e-300:
            faults.append(f"{one.name}: {name} is {miss / largest:.3g} of its largest value off")
    housing = number("heat.housing_temperature") or number("heat.inlet_temperature")
    rates = {}
    for i, t in enumerate(columns["film_temperature"]):
        flow = number("heat.side_flow") or (columns["film_side_flow"][i] if "film_side_flow" in columns else 0.0)
        out = density_at(one.run, t) * number("heat.specific_heat") * flow * (t - number("heat.inlet_temperature")) \
            + number("heat.conductance") * (t - housing)
        rates[i] = ((heating[i] - out) / number("heat.heat_capacity"), 0.0)
    prefixes = [PLACES[one.name]] if one.name in PLACES else PLACES.values()
    if any(float(one.run.summary.get(f"{prefix}temperature_jumps", 0)) for prefix in prefixes):   # it is no integral
        return 2, faults
    far, _, _ = drift(one.run.times, rates, {"film_temperature": columns["film_temperature"]}, HOTTEST)
    if not far <= allowed:
        faults.append(f"{one.name}: film_temperature is not the integral of its heat balance: {HOTTEST * far:.3g} K off")
    return 2, faults
