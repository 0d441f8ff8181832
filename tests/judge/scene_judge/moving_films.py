"""Films between elastic walls: whether the place of the film is the integral of the rate that belongs to its force.

The force of such a film is that of the walls, and the film moves at the rate at which its pressure has this force. Rows between two
steps have places as accurate as those of the steps, but not differences of places, and where a film is thin, its force is the small
difference of much larger ones of wedge and squeeze. Therefore the rate is found from the force by solving the film's equation, not
the force from differences of rows, and integrated.
"""
from __future__ import annotations

import math

from .energy import SAFETY
from .films import Film
from .mechanics import Vector
from .quadrature import stencils
from .rows import FILM, RowChecks

BLURRED = 1e-3    # of the clearance: if the quadrature error exceeds this, the integral begins anew: the rows are too far apart
LEAST_RATIO = 1e-3    # smallest eccentricity ratio at which the line of centres is known
FULL_TURN = 48    # directions in which the force of a film is looked for
HALVINGS = 100    # at most
MOST = 8_000      # number of rows for which the rate is found if the film's pressure is integrated: in blocks over the whole run
BLOCK = 500       # rows one after the other


def rate_for(film: Film, eps: float, gap: float, pin_speed: float, force: Vector, near: float | None) -> tuple[Vector, float]:
    """Rate of the film's place along n and t [m/s] at which its force is `force`, and the direction of that rate as the film sees it. The
    force is proportional to the rate at the same direction. `near` is a direction nearby, if one is known."""
    c, wanted = film.clearance, math.atan2(force[1], force[0])

    def at(angle: float) -> Vector:
        return film.force(eps, gap, c * math.cos(angle), c * (math.sin(angle) + 0.5 * eps * pin_speed), pin_speed)

    def off(angle: float) -> float:
        found = at(angle)
        return math.remainder(math.atan2(found[1], found[0]) - wanted, 2 * math.pi)

    low, high = bracket(off, near)
    at_low, at_high = off(low), off(high)
    side = 0
    for _ in range(HALVINGS):   # false position, by Illinois; the middle where that would leave the bracket
        if abs(high - low) < 1e-13 or not at_low or not at_high:
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        if not min(low, high) < middle < max(low, high):
            middle = 0.5 * (low + high)
        value = off(middle)
        if abs(value) < 1e-12:
            low, at_low = middle, value
            break
        if (value > 0) == (at_high > 0):
            high, at_high, at_low, side = middle, value, (0.5 * at_low if side == 1 else at_low), 1
        else:
            low, at_low, at_high, side = middle, value, (0.5 * at_high if side == -1 else at_high), -1
    angle = low if abs(at_low) <= abs(at_high) else high
    found = at(angle)
    speed = math.hypot(*force) / math.hypot(*found)
    return (c * speed * math.cos(angle), c * (speed * math.sin(angle) + 0.5 * eps * pin_speed)), angle


def bracket(off, near: float | None) -> tuple[float, float]:
    """Two directions between which `off` changes its sign, but not from pi to -pi."""
    width = 1e-3
    while near is not None and width < 1.0:
        low, high = off(near - width), off(near + width)
        if low * high <= 0 and abs(low) + abs(high) < math.pi:
            return near - width, near + width
        width *= 4
    angles = [2 * math.pi * i / FULL_TURN for i in range(FULL_TURN + 1)]
    values = [off(angle) for angle in angles]
    for i in range(FULL_TURN):
        if values[i] * values[i + 1] <= 0 and abs(values[i]) + abs(values[i + 1]) < math.pi:
            return angles[i], angles[i + 1]
    return angles[0], angles[1]   # no film has this force: the rate will be wrong, and its integral will show that


def film_rates(checks: RowChecks) -> dict[int, Vector]:
    """Rate of the film's place along x and y by its force, in all rows where there is one, or in some blocks of them if it takes
    long."""
    law, columns = checks.film_law, checks.run.columns
    every = 1 if law.law == "pinkus_sternlicht" and law.variant != "half_film" else max(1, len(checks.run.times) // MOST)
    found: dict[int, Vector] = {}
    near = None
    for i in range(len(checks.run.times)):
        if i // BLOCK % every:
            continue
        place = columns["film_eccentricity_x"][i], columns["film_eccentricity_y"][i]
        force = columns["film_force_x"][i], columns["film_force_y"][i]
        size, load = math.hypot(*place), math.hypot(*force)
        if columns["phase"][i] != FILM or not LEAST_RATIO < size / law.clearance < 1 or not load > 0:
            continue
        n = place[0] / size, place[1] / size
        thicker = math.exp(checks.run.number("lubrication.pressure_viscosity") * load / (2 * law.radius * law.length))
        row = checks.row(i)
        if checks.joint == "crank_pin":
            row = row.crank_pin(columns, i)
        own = (n[0] * force[0] + n[1] * force[1]) / thicker, (n[0] * force[1] - n[1] * force[0]) / thicker
        (along, across), near = rate_for(law, size / law.clearance, columns["film_thickness"][i] / law.clearance,
                                         row.journal_turn + row.bearing_turn, own, near)
        found[i] = n[0] * along - n[1] * across, n[1] * along + n[0] * across
    return found


def moving_film_drift(checks: RowChecks) -> tuple[float, float, str]:
    """`drift` of the film's place."""
    places = {name: checks.run.columns[name] for name in ("film_eccentricity_x", "film_eccentricity_y")}
    return drift(checks.run.times, film_rates(checks), places, checks.film_law.clearance)


def drift(times: list[float], rates: dict[int, Vector], places: dict[str, list[float]], size: float) -> tuple[float, float, str]:
    """The largest distance of a place from the integral of its rate, which is known in some rows, beyond the bound of the quadrature, over a
    size; that bound, and the name; from the first row of each piece of rows."""
    rows = sorted(rates)
    worst = (0.0, 0.0, "")
    if len(rows) < 2:
        return worst
    apart = min(b - a for a, b in zip(rows, rows[1:]))
    pieces: list[list[int]] = []
    for k, i in enumerate(rows):
        if k and i - rows[k - 1] == apart:
            pieces[-1].append(k)
        else:
            pieces.append([k])
    stencil = stencils([times[i] for i in rows], pieces, joined=False)
    for axis, (name, column) in enumerate(places.items()):
        rate, place = [rates[i][axis] for i in rows], [column[i] for i in rows]
        for piece, ours in zip(pieces, stencil):
            first, moved, bound = piece[0], 0.0, 0.0
            for k, one in zip([k for k in piece if k > 0], ours):
                if k == first:   # the interval before the first row of a piece
                    continue
                by_rate = sum(rate[j] * w for j, w in zip(one.fine, one.by))
                moved += by_rate
                bound += SAFETY * abs(by_rate - sum(rate[j] * w for j, w in zip(one.coarse, one.coarse_by)))
                if bound > BLURRED * size:   # the rows do not resolve the motion here
                    first, moved, bound = k, 0.0, 0.0
                    continue
                beyond = (abs(place[k] - place[first] - moved) - bound) / size
                if not beyond <= worst[0]:
                    worst = (beyond, bound / size, name)
    return worst
