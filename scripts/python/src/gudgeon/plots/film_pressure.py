"""Pressure around the pin, computed from a trace: the program integrates the pressures of films but does not write them.

Angles are measured from the direction of the eccentricity, x towards y; arrays are (rows of the trace, angles).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from gudgeon.results import MissingResult, Run, demand_numbers, read_table

FILM_PHASE = 1


@dataclass(frozen=True)
class FilmMotion:
    """The motion of a joint that determines its film, one value for each row of the trace."""

    ratio: np.ndarray  # eps = |e|/c
    direction: np.ndarray  # of the eccentricity, from x towards y [rad]
    normal_rate: np.ndarray  # of |e| [m/s]
    tangent_rate: np.ndarray  # speed of the pin's centre along t [m/s]
    pin_speed: np.ndarray  # the rod's angular velocity, x towards y [rad/s]


def film_motion(run: Run) -> FilmMotion:
    """Eccentricity and its rate, from the columns of a trace of a joint with clearance."""
    crank, rod = (float(run.parameter("mechanism", key)) for key in ("crank_length", "rod_length"))
    q, a = run["crank_angle"], run["rod_angle"]
    q1, a1 = run["crank_speed"], run["rod_speed"]
    rate_x = -crank * q1 * np.sin(q) - rod * a1 * np.sin(a) - run["piston_velocity"]
    rate_y = crank * q1 * np.cos(q) - rod * a1 * np.cos(a)
    direction = np.arctan2(run["eccentricity_y"], run["eccentricity_x"])
    cosine, sine = np.cos(direction), np.sin(direction)
    return FilmMotion(
        run["eccentricity_ratio"], direction, rate_x * cosine + rate_y * sine, rate_y * cosine - rate_x * sine, -a1
    )


def pinkus_sternlicht(run: Run, angles: np.ndarray) -> np.ndarray:
    """Pressure (5.20) [Pa], negative pressures set to 0."""
    clearance, pin_radius = run.clearance, float(run.parameter("joint", "bearing_radius")) - run.clearance
    motion = film_motion(run)
    eps = np.minimum(motion.ratio, 1 - 1e-12)[:, None]
    wedge = eps * motion.pin_speed[:, None] - 2 * motion.tangent_rate[:, None] / clearance
    squeeze = motion.normal_rate[:, None] / clearance
    cosine, sine = -np.cos(angles), -np.sin(angles)
    bracket = wedge * sine * (2 + eps * cosine) - squeeze * (4 * cosine + eps * (2 * cosine**2 - 1))
    scale = 6 * viscosity_of(run)[:, None] * (pin_radius / clearance) ** 2
    return np.maximum(0.0, scale * bracket / ((2 + eps**2) * (1 + eps * cosine) ** 2))


def viscosity_of(run: Run) -> np.ndarray:
    """Dynamic viscosity of the film [Pa s], one value for each row: it varies with the temperature in a run with `&heat`."""
    return run["film_viscosity"] if "film_viscosity" in run else np.full(len(run["time"]), run.viscosity)


def kinematic_viscosity_of(run: Run) -> np.ndarray:
    """That over the density [m2/s], which follows the temperature of the film by the table for lubricating oils of ASTM D1250; or the
    number in the case."""
    if given := float(run.parameter("lubrication", "kinematic_viscosity", 0.0)):
        return np.full(len(run["time"]), given)
    density = float(run.parameter("lubrication", "density"))
    temperature = run["film_temperature"] if "film_temperature" in run else float(run.parameter("lubrication", "temperature"))
    expansion = 0.6278 / density**2 * (temperature - 288.15)
    return viscosity_of(run) / (density * np.exp(-expansion * (1 + 0.8 * expansion)))


def inertia_function(v: np.ndarray) -> np.ndarray:
    """B = u^2 t/(1 - t), t = tanh(u)/u, at u^2 = i v: the flow resistance of the film with its inertia; without inertia B = 3."""
    u = np.sqrt(1j * np.maximum(v, 1e-3))
    t = np.tanh(u) / u
    small = 3 + 1j * v / 5 + v**2 / 175
    return np.where(v < 0.05, small, u**2 * t / (1 - t))


def ideal_rod_motion(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """The rod's angular velocity [rad/s] and acceleration [rad/s2], x towards y, in the mechanism with an ideal joint at constant
    speed."""
    rod = float(run.parameter("mechanism", "rod_length"))
    ratio = float(run.parameter("mechanism", "crank_length")) / rod
    q, q1 = run["crank_angle"], run["crank_speed"]
    sine = ratio * np.sin(q) - float(run.parameter("mechanism", "axis_offset", 0)) / rod
    cosine = np.sqrt(1 - sine**2)
    rate = ratio * np.cos(q) * q1 / cosine
    return -rate, -(rate**2 * sine - ratio * np.sin(q) * q1**2) / cosine


def oscillating(run: Run, angles: np.ndarray, points: int = 160) -> np.ndarray:
    """Pressure of the oscillating film (5.1-5.9) in the bearing's frame [Pa], relative to its mean, of both signs: dP/dth is
    integrated over points that are closer where the film is thin (Sommerfeld's substitution). The acceleration terms of the
    variant 'as_printed' are omitted."""
    clearance, pin_radius = run.clearance, float(run.parameter("joint", "bearing_radius")) - run.clearance
    least = float(run.parameter("lubrication", "least_film_ratio", 1e-3))
    eps = np.minimum(film_motion(run).ratio, 1 - least)[:, None]
    psi = np.linspace(-np.pi, np.pi, points + 1)[None, :]
    eta = (1 - eps**2) / (1 + eps * np.cos(psi))
    cosine = (1 - eta) / np.where(eps > 1e-9, eps, 1)
    theta = np.where(eps > 1e-9, np.sign(psi) * np.arccos(np.clip(cosine, -1, 1)), psi)

    frequency = np.abs(run["crank_speed"])[:, None]
    speed, acceleration = (values[:, None] for values in ideal_rod_motion(run))
    phasor = pin_radius * (speed - 1j * acceleration / frequency)
    v = clearance**2 * frequency / (4 * kinematic_viscosity_of(run)[:, None]) * eta**2
    resistance = inertia_function(v)
    flow = _integral(resistance / eta**2, theta)[:, -1:] / _integral((resistance + 1j * v) / eta**3, theta)[:, -1:]
    gradient = (
        2 * viscosity_of(run)[:, None] * pin_radius / clearance**2 * phasor * (eta * resistance - flow * (resistance + 1j * v)) / eta**3
    )
    pressure = _integral(gradient.real, theta)
    pressure -= _integral(pressure, theta)[:, -1:] / (2 * np.pi)
    wrapped = (np.asarray(angles) + np.pi) % (2 * np.pi) - np.pi
    return np.stack([np.interp(wrapped, th, p) for th, p in zip(theta, pressure)])


def _integral(values: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Running integral along each row, 0 at the first point."""
    steps = 0.5 * (values[:, 1:] + values[:, :-1]) * np.diff(theta, axis=1)
    return np.concatenate([np.zeros((len(values), 1), dtype=steps.dtype), np.cumsum(steps, axis=1)], axis=1)


def pressure(run: Run, angles: np.ndarray) -> np.ndarray | None:
    """Pressure [Pa] at the angles from the eccentricity; 0 where no film acts. None for a run without film, and for a
    film of finite length, whose pressure has no closed form: see `from_fields`."""
    law = run.parameter("lubrication", "law")
    if law is None or "phase" not in run or law == "finite_bearing":
        return None
    found = oscillating(run, angles) if law == "oscillating_film" else pinkus_sternlicht(run, angles)
    found[run["phase"] != FILM_PHASE] = 0
    return found


def fields_of(path: Path) -> list[pd.DataFrame]:
    """The nodes of the piston pin's film in a NAME.film.csv, one table for each time."""
    if not path.exists():
        raise MissingResult(f"no pressure fields {path}")
    table = read_table(path, "time", "joint", "place", "angle", "pressure", "film_thickness")[0]
    demand_numbers(path, table, ["time", "angle", "pressure", "film_thickness"])
    return [field for _, field in table[table["joint"] == "piston_pin"].groupby("time", sort=True)]


def from_fields(run: Run, fields: list[pd.DataFrame], angles: np.ndarray, quantity: str = "pressure") -> np.ndarray:
    """Pressure [Pa] or another column of a NAME.film.csv in the middle plane of the bore at the angles from the eccentricity,
    interpolated linearly between its times; 0 before the first and after the last."""
    times = np.array([field["time"].iloc[0] for field in fields])
    lines = []
    for field in fields:
        line = field[field["place"] == field["place"].min()].sort_values("angle")
        thinnest = line["angle"].to_numpy()[np.argmin(line["film_thickness"].to_numpy())]
        lines.append(np.interp(angles, line["angle"] - thinnest, line[quantity], period=2 * np.pi))
    time = run["time"]
    place = np.clip(np.searchsorted(times, time, side="right"), 1, max(len(times) - 1, 1))
    if len(times) < 2:
        return np.where(np.isclose(time, times[0])[:, None], lines[0], 0.0)
    part = ((time - times[place - 1]) / (times[place] - times[place - 1]))[:, None]
    found = (1 - part) * np.array(lines)[place - 1] + part * np.array(lines)[place]
    found[(time < times[0]) | (time > times[-1]) | (run["phase"] != FILM_PHASE)] = 0
    return found


def resultant(run: Run, angles: np.ndarray, found: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force on the pin [N] along and across the eccentricity, from pressures at equally spaced angles."""
    radius = float(run.parameter("joint", "bearing_radius")) - run.clearance
    area = float(run.parameter("joint", "bearing_length")) * radius * (angles[1] - angles[0])
    return -area * (found * np.cos(angles)).sum(axis=1), -area * (found * np.sin(angles)).sum(axis=1)
