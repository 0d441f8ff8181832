#!/usr/bin/env python3
"""Compares the piston slap of the benchmark of Flores, Leine and Glocker (2010) with Siconos, and examines its first impact.

    scripts/bench/compare_siconos.py [--program FILE] [--out DIR]

The walls of Siconos (data/siconos_guide_clearance.csv) are rigid; a stiff contact should give nearly the same motion. Both ends of
the slider hit the guide within 2 us, and no law of a single impact determines the motion after two simultaneous impacts. This
script runs cases/joints/slider_clearance.nml with stiffnesses from 1e7 to 1e11 N/m: from the start, from Siconos's own state just
after the first impact, and without tilt of the slider. It also computes the first impact alone with rigid walls, as a sequence of
impacts and by Moreau's time stepping with several step sizes. The tables are written to slider_clearance.md in the folder --out
(default: data/measured).
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import FOLDER, TOP, built_program, write_table

CASE, LATER = TOP / "cases/joints/slider_clearance.nml", TOP / "cases/joints/slider_after_impact.nml"
REFERENCE = TOP / "data/siconos_guide_clearance.csv"
STIFFNESSES = ("1e7", "1e8", "3e8", "1e9", "3e9", "1e10", "1e11")
CLEARANCE = 1e-3
TOLERANCE = "1e-9"
EARLY = 0.04          # [s] time over which the mean difference of y is taken
AFTER = 2.8e-3        # [s] time of the row of Siconos just after the first impact

# Data of the benchmark (Multibody System Dynamics 23:165), for the model with rigid bodies
L1, L2, M1, M2, M3, J1, J2, J3 = 0.153, 0.306, 0.038, 0.038, 0.076, 7.4e-5, 5.9e-4, 2.7e-6
LONG, HIGH, G, RESTITUTION, FRICTION = 0.05, 0.025, 9.81, 0.4, 0.01
COUPLING = (M2 / 2 + M3) * L1 * L2

Vector = list[float]


def solved(q: Vector, force: Vector) -> Vector:
    """Solve the equations of motion: accelerations of crank, rod and slider's tilt (angles from x to y) for a vector of generalized
    forces."""
    a, b = J1 + (M1 / 4 + M2 + M3) * L1**2, J2 + (M2 / 4 + M3) * L2**2
    c = COUPLING * math.cos(q[0] - q[1])
    det = a * b - c * c
    return [(force[0] * b - force[1] * c) / det, (force[1] * a - force[0] * c) / det, force[2] / J3]


def acceleration(q: Vector, v: Vector) -> Vector:
    s = COUPLING * math.sin(q[0] - q[1])
    return solved(q, [-s * v[1]**2 - G * L1 * math.cos(q[0]) * (M1 / 2 + M2 + M3),
                      s * v[0]**2 - G * L2 * math.cos(q[1]) * (M2 / 2 + M3), 0.0])


def corner(q: Vector, k: int) -> tuple[float, Vector, Vector]:
    """Gap of corner k of the slider, and the derivatives of the gap and of the corner's position along x with respect to the
    angles. The corners are top and bottom on the side of +y, then top and bottom on the side of -y."""
    along, side = (LONG, -LONG)[k % 2], (1, 1, -1, -1)[k]
    s, c = math.sin(q[2]), math.cos(q[2])
    y = L1 * math.sin(q[0]) + L2 * math.sin(q[1]) + along * s + side * HIGH * c
    return (HIGH + CLEARANCE - side * y, [-side * L1 * math.cos(q[0]), -side * L2 * math.cos(q[1]), -side * (along * c - side * HIGH * s)],
            [-L1 * math.sin(q[0]), -L2 * math.sin(q[1]), -along * s - side * HIGH * c])


def dot(a: Vector, b: Vector) -> float:
    return sum(x * y for x, y in zip(a, b))


def moved(q: Vector, v: Vector, h: float) -> tuple[Vector, Vector]:
    """State after a step h of Heun's method."""
    one = acceleration(q, v)
    then = [a + h * b for a, b in zip(v, one)]
    two = acceleration([a + h * (b + c) / 2 for a, b, c in zip(q, v, then)], then)
    after = [a + h * (b + c) / 2 for a, b, c in zip(v, one, two)]
    return [a + h * (b + c) / 2 for a, b, c in zip(q, v, after)], after


def before_impact() -> tuple[float, Vector, Vector]:
    """Time and state 5 us before the first impact."""
    q, v, h = [0.0, 0.0, 0.0], [150.0, -75.0, -0.01], 2e-7
    steps = round(2.686e-3 / h)
    for _ in range(steps):
        q, v = moved(q, v, h)
    return steps * h, q, v


def across(q: Vector, v: Vector) -> float:
    """Speed of the slider's centre along y [m/s]."""
    return L1 * math.cos(q[0]) * v[0] + L2 * math.cos(q[1]) * v[1]


def moreau(h: float) -> tuple[int, float, float]:
    """The first impact by the time stepping of Moreau and Jean: number of impacts, lateral speed and tilt rate after it. In each
    step Newton's impact law is solved for all corners that are closed at the middle of the step together, by projected Gauss-Seidel
    iterations."""
    _, q, v = before_impact()
    impacts = 0
    for _ in range(round(12e-6 / h)):
        old = v
        _, v = moved(q, old, h)
        shut = [k for k in range(4) if (found := corner(q, k))[0] + h / 2 * dot(found[1], old) <= 0]
        rows = [corner(q, k)[1:] for k in shut]
        responses = [(solved(q, n), solved(q, t)) for n, t in rows]
        press, rub = [0.0] * len(shut), [0.0] * len(shut)
        for _ in range(2000 if shut else 0):
            change = 0.0
            for i, ((n, t), (by_n, by_t)) in enumerate(zip(rows, responses)):
                new = max(0.0, press[i] - (dot(n, v) + RESTITUTION * dot(n, old)) / dot(n, by_n))
                v = [a + (new - press[i]) * b for a, b in zip(v, by_n)]
                change, press[i] = change + abs(new - press[i]), new
                new = min(max(rub[i] - dot(t, v) / dot(t, by_t), -FRICTION * new), FRICTION * new)
                v = [a + (new - rub[i]) * b for a, b in zip(v, by_t)]
                change, rub[i] = change + abs(new - rub[i]), new
            if change < 1e-15:
                break
        impacts += sum(p > 1e-9 for p in press)
        q = [a + h * (b + c) / 2 for a, b, c in zip(q, old, v)]
    return impacts, across(q, v), v[2]


def one_by_one(most: int) -> list[tuple[float, int, float, float]]:
    """The first impact as a sequence of single impacts, each by Newton's law: time, corner, lateral speed and tilt rate after each.
    In the few microseconds between the impacts other forces are neglected."""
    time, q, v = before_impact()
    found = []
    for _ in range(most):
        ahead = [(gap / -rate, k) for k in range(4) if (rate := dot((at := corner(q, k))[1], v)) < 0 and (gap := at[0]) > -1e-12]
        wait, k = min(ahead)
        if wait > 20e-6:
            break
        time, (q, v) = time + wait, moved(q, v, wait) if wait > 1e-9 else ([a + wait * b for a, b in zip(q, v)], v)
        _, n, t = corner(q, k)
        slide = FRICTION * math.copysign(1.0, dot(t, v))
        kick = solved(q, [a - slide * b for a, b in zip(n, t)])
        blow = -(1 + RESTITUTION) * dot(n, v) / dot(n, kick)
        v = [a + blow * b for a, b in zip(v, kick)]
        found.append((time, k + 1, across(q, v), v[2]))
    return found


def table(file: Path) -> dict[str, list[float]]:
    """Columns of a trace by name, without units."""
    with file.open(newline="") as lines:
        rows = list(csv.reader(lines))
    return {name.split("[")[0]: [float(row[k] or "nan") for row in rows[1:]] for k, name in enumerate(rows[0])}


def run(program: Path, case: Path, settings: dict[str, str]) -> dict[str, list[float]]:
    """Run a case with settings and return its trace."""
    with tempfile.TemporaryDirectory(prefix="siconos") as out:
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        subprocess.run([program, "-q", "-o", out, *words, case], check=True)
        return table(Path(out) / f"{case.stem}.csv")


def differences(got: dict[str, list[float]], want: dict[str, list[float]], start: float, until: tuple[float, ...]) -> list[float]:
    """Largest difference of the crank angle [revolutions], and the mean difference of y over the clearance up to each time."""
    first = next(i for i, t in enumerate(want["time"]) if t > start - 1e-9)
    y = [abs(a / CLEARANCE - b) for a, b in zip(got["piston_offset"], want["slider_y_over_clearance"][first:])]
    turn = [abs(a / (2 * math.pi) - b) for a, b in zip(got["crank_angle"], want["crank_revolutions"][first:])]
    counts = [sum(start - 1e-9 < t <= one + 1e-9 for t in want["time"]) for one in until]
    return [max(turn), *(sum(y[:n]) / n for n in counts)]


def rebound(program: Path, stiffness: str) -> tuple[int, float, float]:
    """Contacts of the first impact, lateral speed and tilt rate after it."""
    got = run(program, CASE, {"guide.stiffness": stiffness, "integrator.end_time": "2.76e-3", "output.interval": "1e-5",
                              "integrator.relative_tolerance": TOLERANCE})
    shut = sum(sum(b > 0 >= a for a, b in zip(f, f[1:])) for f in ([-g for g in got[f"guide_{k}_gap"]] for k in (1, 2)))
    return shut, *((got[name][-1] - got[name][-2]) / 1e-5 for name in ("piston_offset", "piston_tilt"))


def lines_of(program: Path) -> list[str]:
    """The lines of all tables."""
    want = table(REFERENCE)
    lines = ["## With rigid walls: the first impact", "",
             "In Siconos's rows from 2.8 to 3.0 ms the slider leaves at -0.29 m/s with a tilt rate of 3.92 rad/s. By Moreau's "
             "time stepping here:", "",
             "| step | impacts of single corners | lateral speed after [m/s] | tilt rate after [rad/s] |", "|---|---|---|---|"]
    for name, step in (("2 us", 2e-6), ("0.5 us (Siconos)", 5e-7), ("0.1 us", 1e-7), ("0.02 us", 2e-8), ("0.005 us", 5e-9)):
        lines.append("| {} | {} | {:.3f} | {:.2f} |".format(name, *moreau(step)))
    lines += ["", "As a sequence of impacts, each by Newton's law for one corner (approach speed 0.842 m/s):", "",
              "| impact | time after the first [us] | corner | lateral speed after [m/s] | tilt rate after [rad/s] |",
              "|---|---|---|---|---|"]
    blows = one_by_one(400)
    for k in [*range(6), 20, 50, 100, 200, 399]:
        time, at, speed, tilt = blows[k]
        lines.append(f"| {k + 1} | {1e6 * (time - blows[0][0]):.4f} | {at} | {speed:.5f} | {tilt:.4f} |")
    lines += ["", "## With a stiff contact: the speed after the first impact", "",
              "| stiffness [N/m] | lateral speed after [m/s] | tilt rate after [rad/s] |", "|---|---|---|"]
    for k in range(32, 53):
        stiffness = f"{10 ** (k / 4):.3g}"
        _, speed, tilt = rebound(program, stiffness)
        lines.append(f"| {stiffness} | {speed:.3f} | {tilt:.2f} |")
    lines += ["", f"## The whole benchmark, at a tolerance of {TOLERANCE}", "",
              "| stiffness [N/m] | crank angle over 0.2 s [revolutions] | y over the clearance, mean over 40 ms | the same without tilt: crank | y |",
              "|---|---|---|---|---|"]
    for stiffness in STIFFNESSES:
        settings = {"guide.stiffness": stiffness, "integrator.relative_tolerance": TOLERANCE}
        one = differences(run(program, CASE, settings), want, 0.0, (EARLY,))
        flat = differences(run(program, CASE, {**settings, "initial.piston_tilt_rate": "0"}), want, 0.0, (EARLY,))
        lines.append(f"| {stiffness} | {one[0]:.4f} | {one[1]:.3f} | {flat[0]:.4f} | {flat[1]:.3f} |")
    lines += ["", f"## From Siconos's state at {1e3 * AFTER:g} ms, after the first impact ({LATER.name}), at a tolerance of {TOLERANCE}", "",
              "| stiffness [N/m] | crank angle to 0.2 s [revolutions] | y over the clearance, mean to 10 ms | to 20 ms | to 40 ms |", "|---|---|---|---|---|"]
    for stiffness in STIFFNESSES:
        got = run(program, LATER, {"guide.stiffness": stiffness, "integrator.relative_tolerance": TOLERANCE})
        lines.append("| {} | {:.4f} | {:.5f} | {:.5f} | {:.4f} |".format(stiffness, *differences(got, want, AFTER, (0.01, 0.02, EARLY))))
    return lines


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    parser.add_argument("--out", type=Path, default=FOLDER, metavar="DIR", help="folder of slider_clearance.md (default: data/measured)")
    options = parser.parse_args()
    lines = lines_of(options.program or built_program())
    write_table("slider_clearance", "Piston slap against Siconos", "scripts/bench/compare_siconos.py",
                "\n".join(["Differences from `data/siconos_guide_clearance.csv`; data/README.md explains them.", "", *lines]),
                options.out)
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
