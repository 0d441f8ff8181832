#!/usr/bin/env python3
"""Determines the sign of the radial force (5.36) of the Pinkus-Sternlicht film, and writes data/measured/film_sign.md.

    scripts/bench/measure_film_sign.py

Integrates the pressure (5.20) over the arc on which it is positive, and evaluates the closed form with the corrected and with the printed sign;
no part of the program is used.
"""
from __future__ import annotations

import math

from measured import table, write_table

STATES = ((0.5, -0.001), (0.5, 0.3), (0.5, -0.3), (0.9, 0.3), (0.9, -0.3), (0.99, -0.3))   # eps, eps'
WEDGE = 1.0      # W = omega - 2 gamma'
POINTS = 200_000
NOTE = """Radial and tangential force of the Pinkus-Sternlicht film, f_r and f_t in units of P = mu w R^3/c^2, with W = 1: the pressure (5.20)
integrated over the arc on which it is positive, the closed form (5.36) with the corrected sign, and its radial part as printed, which for
eps' < 0 has the other sign. The closed form is close to the integral for a pin that approaches the wall (eps' > 0) and poor for one that leaves
it; the sign follows from the integral."""


def integrated(eps: float, rate: float) -> tuple[float, float]:
    """Force of the positive pressure, by the midpoint rule over Sommerfeld's angle, which resolves a thin film."""
    radial = tangential = 0.0
    step = 2 * math.pi / POINTS
    for k in range(POINTS):
        angle = (k + 0.5) * step
        cosine = (math.cos(angle) - eps) / (1 - eps * math.cos(angle))   # of the angle from the largest film thickness
        sine = math.sqrt(1 - eps * eps) * math.sin(angle) / (1 - eps * math.cos(angle))
        thickness = 1 + eps * cosine
        bracket = WEDGE * eps * sine * (2 + eps * cosine) - rate * (4 * cosine + eps * (2 * cosine * cosine - 1))
        pressure = 6 * bracket / ((2 + eps * eps) * thickness * thickness)
        if pressure > 0:
            width = math.sqrt(1 - eps * eps) / (1 - eps * math.cos(angle)) * step
            radial += pressure * cosine * width
            tangential += pressure * sine * width
    return radial, tangential


def closed_form(eps: float, rate: float) -> tuple[float, float]:
    """(5.36) and (5.37), with the corrected sign of the radial part."""
    k = math.sqrt((1 - eps * eps) * ((WEDGE / (2 * rate)) ** 2 + 1 / (eps * eps)))
    common = 6 * rate / ((2 + eps * eps) * (1 - eps * eps) ** 1.5)
    tangential = 6 * math.pi * eps * WEDGE / ((2 + eps * eps) * math.sqrt(1 - eps * eps))
    if rate >= 0:
        return -common * (4 * k * eps * eps + (2 + eps * eps) * math.pi * (k + 3) / (k + 1.5)), tangential * (k + 3) / (k + 1.5)
    return common * (4 * k * eps * eps - (2 + eps * eps) * math.pi * k / (k + 1.5)), tangential * k / (k + 1.5)


def main() -> None:
    rows = []
    for eps, rate in STATES:
        one, two = integrated(eps, rate), closed_form(eps, rate)
        printed = two[0] if rate >= 0 else -two[0]
        rows.append((f"{eps}", f"{rate}", f"{one[0]:.4f}, {one[1]:.4f}", f"{two[0]:.4f}, {two[1]:.4f}", f"{printed:.4f}"))
    text = NOTE + "\n\n" + table(("eps", "eps'", "f_r, f_t from (5.20)", "corrected formula", "f_r as printed"), rows)
    print(write_table("film_sign", "Sign of the radial force of the Pinkus-Sternlicht film", "scripts/bench/measure_film_sign.py", text))


if __name__ == "__main__":
    main()
