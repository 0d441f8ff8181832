"""Integrals over the rows of a trace, which need not be equally far apart, with a bound of their error by halving the rows."""
from __future__ import annotations

import dataclasses
import math

NODES = 6   # rows that the polynomial of an interval goes through
GAUSS = ((0.0, 4 / 9), (-math.sqrt(0.15), 5 / 18), (math.sqrt(0.15), 5 / 18))   # on an interval of length 1: exact for its degree


@dataclasses.dataclass
class Integral:
    """The integral from the first row to each, and what it may be off by there."""

    value: list[float]
    bound: list[float]


@dataclasses.dataclass
class Stencil:
    """The rows that the integral over one interval is made of, and their weights; the same from every second row."""

    fine: list[int]
    by: list[float]
    coarse: list[int]
    coarse_by: list[float]


def weights(nodes: list[float], a: float, b: float) -> list[float]:
    """Of the integral from a to b of the polynomial through values at the nodes, six at most."""
    middle, length = 0.5 * (a + b), b - a
    found = []
    for j, x in enumerate(nodes):
        total = 0.0
        for at, weight in GAUSS:
            point = middle + at * length
            product = weight
            for k, other in enumerate(nodes):
                if k != j:
                    product *= (point - other) / (x - other)
            total += product
        found.append(length * total)
    return found


def nearest(rows: list[int], position: int, count: int) -> list[int]:
    """`count` of the rows around the interval that ends with the row at `position` of the list."""
    first = min(max(position - count // 2, 0), max(len(rows) - count, 0))
    return rows[first:first + count]


def stencils(times: list[float], pieces: list[list[int]], joined: bool) -> list[list[Stencil]]:
    """The stencils of every interval, piece by piece.

    A piece is a list of consecutive rows in which everything is smooth; the interval before its first row belongs to it. The row
    before stands for the motion before the jump: where only slopes jump (`joined`), it is a row of this piece too.
    """
    found = []
    for own in pieces:
        piece = [own[0] - 1, *own] if joined and own[0] > 0 else own
        half = piece[::2] if len(piece) % 2 or len(piece) < 3 else [*piece[::2], piece[-1]]
        ours = []
        for position, row in enumerate(piece):
            if row < max(own[0], 1):
                continue
            a, b = times[row - 1], times[row]
            fine = nearest(piece, position, NODES)
            coarse = nearest(half, (position + 1) // 2, NODES) if len(piece) > NODES else fine[:max(1, len(fine) - 1)]
            ours.append(Stencil(fine, weights([times[k] for k in fine], a, b), coarse, weights([times[k] for k in coarse], a, b)))
        found.append(ours)
    return found


def integral(values: list[float], stencil: list[list[Stencil]]) -> Integral:
    """The running integral of one quantity given at the rows.

    Its bound is what it differs by from the integral over every second row: some sixty times its error where all is smooth. The
    differences of the pieces are added by size, so that those of one contact do not hide those of another."""
    total, bound = [0.0], [0.0]
    before = 0.0
    for piece in stencil:
        difference, largest = 0.0, 0.0
        for one in piece:
            fine = sum(values[k] * w for k, w in zip(one.fine, one.by))
            coarse = sum(values[k] * w for k, w in zip(one.coarse, one.coarse_by))
            total.append(total[-1] + fine)
            difference += fine - coarse
            largest = max(largest, abs(difference))
            bound.append(before + largest)
        before += largest
    return Integral(total, bound)
