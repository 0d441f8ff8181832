"""Integrals over the rows of a trace, which may have unequal distances, with a bound of their error from every second row."""
from __future__ import annotations

import dataclasses
import math

NODES = 6   # number of rows through which the polynomial of an interval passes
CLOSEST = 1e-3   # smallest distance of its rows, over the length of the interval: through closer rows a polynomial swings
SWING = 30.0     # largest sum of the weights' magnitudes, over that length: six equally spaced rows beside the interval have 23
GAUSS = ((0.0, 4 / 9), (-math.sqrt(0.15), 5 / 18), (math.sqrt(0.15), 5 / 18))   # points, weights on [-1/2, 1/2]; exact


@dataclasses.dataclass
class Integral:
    """The integral from the first row to each row, and the bound of its error there."""

    value: list[float]
    bound: list[float]


@dataclasses.dataclass
class Stencil:
    """The rows from which the integral over one interval is computed, and their weights; and the same for every second row."""

    fine: list[int]
    by: list[float]
    coarse: list[int]
    coarse_by: list[float]


def weights(nodes: list[float], a: float, b: float) -> list[float]:
    """Weights of the integral from a to b of the polynomial through values at the nodes, of which there are at most six."""
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


def nearest(rows: list[int], position: int, count: int, times: list[float]) -> list[int]:
    """The `count` rows nearest to the interval that ends with the row at `position` of the list, without those that are very close
    to the next one."""
    first = min(max(position - count // 2, 0), max(len(rows) - count, 0))
    found = rows[first:first + count]
    if position < 1 or position >= len(rows):
        return found
    least = CLOSEST * (times[rows[position]] - times[rows[position - 1]])
    if all(times[b] - times[a] >= least for a, b in zip(found, found[1:])):
        return found
    before = spaced(rows[position - 1::-1], count, times, least)
    after = spaced(rows[position:], count, times, least)
    taken = min(len(before), max(count // 2, count - len(after)))
    return before[:taken][::-1] + after[:count - taken]


def steady(rows: list[int], times: list[float], a: float, b: float) -> tuple[list[int], list[float]]:
    """Those of the rows whose polynomial does not swing in the interval from a to b, and their weights: the farthest rows are left
    out until the weights are not much larger than the interval."""
    while True:
        found = weights([times[k] for k in rows], a, b)
        if len(rows) == 1 or sum(map(abs, found)) <= SWING * (b - a):
            return rows, found
        farthest = max(rows, key=lambda k: abs(times[k] - 0.5 * (a + b)))
        rows = [k for k in rows if k != farthest]


def spaced(rows: list[int], count: int, times: list[float], least: float) -> list[int]:
    """The first `count` rows of a list, at least so far apart."""
    found = rows[:1]
    for row in rows[1:]:
        if len(found) == count:
            break
        if abs(times[row] - times[found[-1]]) >= least:
            found.append(row)
    return found


def stencils(times: list[float], pieces: list[list[int]], joined: bool) -> list[list[Stencil]]:
    """The stencils of every interval, for each piece.

    A piece is a list of consecutive rows in which everything is smooth; the interval before its first row belongs to it. The row
    before that interval is the state before the jump. If only slopes jump (`joined`), this row belongs to the piece as well.
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
            fine = nearest(piece, position, NODES, times)
            coarse = nearest(half, (position + 1) // 2, NODES, times) if len(piece) > NODES else fine[:max(1, len(fine) - 1)]
            if len(fine) == 1:   # one row only: the row before it bounds the error, although there may be a jump between them
                coarse = [row - 1]
            ours.append(Stencil(*steady(fine, times, a, b), *steady(coarse, times, a, b)))
        found.append(ours)
    return found


def integral(values: list[float], stencil: list[list[Stencil]]) -> Integral:
    """The running integral of a quantity given at the rows.

    Its error bound is the difference from the integral over every second row, which is about sixty times the error if everything is
    smooth. The magnitudes of the differences of all pieces are added, so that differences of two contacts cannot cancel."""
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
