"""Wear of pins and bores: volumes from the rows of a trace, by quadrature, and where they are worn.

Archard's law: in each second k Int p |v| dA wears, over the arc of contact. The pressures result in the normal force F along the
line of centres, whatever the arc. Therefore the volumes around a surface, as vectors in the directions in which they are worn, add up to
k Int F |v| u dt, where u is the direction of the line of centres in the frame of that surface.
"""
from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

from .energy import SAFETY, phase_key
from .quadrature import integral, stencils

if TYPE_CHECKING:
    from .rows import RowChecks

SURFACES = "pin", "bore"
VOLUME = 1e-4, 10.0   # allowed error of a volume: relative, and in tolerances
PLACE = 1.5           # allowed distance of the centre of the wear in bins: a volume is spread over the angle passed in a part of a step, at most two
BLURRED = 0.02        # of a volume: if the quadrature error exceeds this, the rows are too far apart
SUM = 1e-8            # rounding of the numbers of the files


def judge_wear(checks: RowChecks) -> tuple[int, list[str], list[str]]:
    """Number of checks made, faults and notes of the joints whose wear is counted."""
    made, faults, notes = 0, [], []
    for joint in filter(None, (checks, checks.crank_pin)):
        if joint.wears:
            prefix = "" if joint is checks else "crank_pin_"
            found, blurred = worn(joint, checks, prefix)
            made += 1
            faults += found
            notes += [f"wear not judged: the quadrature is only known to {blurred:.1g}"] if blurred > BLURRED else []
    return made, faults, notes


def worn(joint: RowChecks, whole: RowChecks, prefix: str) -> tuple[list[str], float]:
    """Faults of one joint, and the error bound of the quadrature, relative to the volume."""
    run, faults = joint.run, files(joint, prefix)
    if joint.worn_bore and run.number("wear.extrapolation", 1.0) > 1:
        return faults, 0.0
    speed = run.columns["sliding_speed"]
    keys = [(phase_key(joint, i), v > 0) for i, v in enumerate(speed)]
    pieces: list[list[int]] = []
    for i, key in enumerate(keys):
        if i and key == keys[i - 1]:
            pieces[-1].append(i)
        else:
            pieces.append([i])
    stencil = stencils(run.times, pieces, joined=False)
    force = run.columns["asperity_force" if joint.asperities else "normal_force"]
    load = [abs(f * v) for f, v in zip(force, speed)]
    tolerance = min(run.number("integrator.relative_tolerance"), 1e-3)
    blurred = 0.0
    for surface, rate, turned in zip(SURFACES, run.pair("wear.rate"), angles(joint, whole, prefix)):
        if not rate:
            continue
        volume = float(run.summary[f"{prefix}worn_volume_{surface}"])
        rates = run.columns[f"{surface}_wear_rate"]
        found = integral(rates, stencil)
        # where the sliding reverses or a contact begins or ends, the rate is not smooth
        kinks = sum((rates[i - 1] + rates[i]) * (run.times[i] - run.times[i - 1]) for i in range(1, len(keys)) if keys[i] != keys[i - 1])
        size, bound = max(volume, found.value[-1], 1e-300), SAFETY * max(found.bound) + kinks
        blurred = max(blurred, bound / size)
        if bound > BLURRED * size:
            continue
        allowed = max(VOLUME[0], VOLUME[1] * tolerance)
        if not abs(volume - found.value[-1]) <= allowed * size + bound:
            faults.append(f"wear: {prefix}worn_volume_{surface} is not the integral of its rate: {abs(volume - found.value[-1]) / size:.3g} of it off")
        if joint.worn_bore:
            continue
        lines = [math.atan2(y, x) - turn for x, y, turn in zip(run.columns["eccentricity_x"], run.columns["eccentricity_y"], turned)]
        want = complex(*(integral([rate * one * part(line) for one, line in zip(load, lines)], stencil).value[-1] for part in (math.cos, math.sin)))
        bins = volumes(joint, surface)
        got = sum(one * cmath.exp(2j * math.pi * (i + 0.5) / len(bins)) for i, one in enumerate(bins))
        if not abs(got - want) <= (PLACE * 2 * math.pi / len(bins) + allowed) * size + 2 * bound:
            faults.append(f"wear: the {prefix}{surface} is worn at other places than its load says: the centre of the wear is off by "
                          f"{abs(got - want) / size:.3g} of the radius")
    return faults, blurred


def volumes(joint: RowChecks, surface: str) -> list[float]:
    return [float(row[f"{surface}_volume[m3]"]) for row in joint.run.worn]


def files(joint: RowChecks, prefix: str) -> list[str]:
    """Faults of NAME.wear.csv against the summary."""
    run, faults = joint.run, []
    if len(run.worn) != run.number("wear.bins"):
        return [f"wear: {len(run.worn)} rows of the {joint.joint} in the file"]
    length, radius = run.number("joint.bearing_length"), run.number("joint.bearing_radius")
    for surface, r in zip(SURFACES, (radius - run.number("joint.clearance"), radius)):
        bins, total = volumes(joint, surface), float(run.summary[f"{prefix}worn_volume_{surface}"])
        deepest = max(bins) / (r * length * 2 * math.pi / len(bins))
        said = float(run.summary[f"{prefix}max_wear_depth_{surface}"])
        depths = [float(row[f"{surface}_depth[m]"]) * r * length * 2 * math.pi / len(bins) for row in run.worn]
        if not (abs(math.fsum(bins) - total) <= SUM * total and abs(deepest - said) <= SUM * said
                and all(abs(depth - one) <= SUM * one for depth, one in zip(depths, bins))):
            faults.append(f"wear: volumes and depths of the {prefix}{surface} in the file are not those of the summary")
    return faults


def angles(joint: RowChecks, whole: RowChecks, prefix: str) -> tuple[list[float], list[float]]:
    """Angles by which pin and bore have turned in each row, from x to y [rad]."""
    columns, rod = whole.run.columns, whole.bodies.elastic
    bent = [0.0] * len(whole.run.times)
    for k in range(rod.across if rod else 0):   # slopes of the sines at the end of the rod
        slope = (k + 1) * math.pi / rod.length * (1 if prefix else (-1)**(k + 1))
        bent = [one + slope * q for one, q in zip(bent, columns[f"rod_mode_{k + 1}"])]
    end = [one - angle for one, angle in zip(bent, columns["rod_angle"])]
    if prefix:
        return columns["crank_angle"], end
    return end, columns.get("piston_tilt", [0.0] * len(end))
