"""Periodic points of a map, their multipliers, and branches of them over a parameter.

A map is any function `map(x, p)` that returns the `Image` of a state x after one period at the parameter p, or raises `Lost`. It is
smooth as long as the pattern of its images is the same; a difference is never taken across a change of the pattern. Here the map is
scaled: w is the state in units of `scale`, followed by the parameter in units of `weight`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

#: Difference of a state or of the parameter, and the least one beside a change of the pattern.
DIFFERENCE, LEAST_DIFFERENCE = 3e-4, 1e-6
#: Largest residual of a periodic point, and the most corrections from one prediction.
RESIDUAL, MOST_CORRECTIONS = 1e-9, 12
#: First, largest and least step along a branch, and the cosine of the largest turn of its tangent in a step.
FIRST_STEP, LARGEST_STEP, LEAST_STEP, LARGEST_TURN = 0.1, 0.4, 1e-4, math.cos(math.radians(25))
#: Distances from a flip along the eigenvector of -1 at which an orbit of twice the period is looked for.
DISTANCES = (0.02, 0.05, 0.1, 0.01)
#: A special point is located until its test is as small as this.
TEST = 1e-6


class Lost(RuntimeError):
    """There is no image, or no periodic point was found. `kind` is what then ends a branch."""

    kind = "end"


class Edge(Lost):
    """The pattern changes so close to a point, on both sides, that there are no differences."""

    kind = "edge"


@dataclass(frozen=True)
class Image:
    """State after one period; `pattern` names the sequence of events; `measures` are results by name."""

    x: np.ndarray
    pattern: Hashable = None
    measures: Mapping[str, float] = field(default_factory=dict)


Map: TypeAlias = Callable[[np.ndarray, float], Image]


@dataclass(frozen=True)
class Point:
    """A periodic point. `jacobian` are the scaled derivatives of the image by w; `tangent` is that of the branch through the point."""

    w: np.ndarray
    x: np.ndarray
    p: float
    image: Image
    residual: float
    jacobian: np.ndarray
    tangent: np.ndarray
    mixed: bool  # there is another pattern within the size of the differences
    corrections: int = 0
    arclength: float = 0.0
    kind: str = ""
    runs: int = 0

    @property
    def multipliers(self) -> np.ndarray:
        """All multipliers, the largest first."""
        found = np.linalg.eigvals(self.jacobian[:, :-1])
        return found[np.argsort(-abs(found), kind="stable")]

    @property
    def stable(self) -> bool:
        return bool(abs(self.multipliers[0]) < 1)

    def ahead(self, step: float, other: Point | None) -> tuple[np.ndarray, np.ndarray]:
        """Where the branch is expected after a step of the arclength, and the derivatives there: tangent and derivatives are those of this
        point, and change as they do to another one, before it or behind it."""
        if other is None:
            return self.w + step * self.tangent, self.jacobian
        share = step / (other.arclength - self.arclength)
        return (
            self.w + step * (self.tangent + share / 2 * (other.tangent - self.tangent)),
            self.jacobian + share * (other.jacobian - self.jacobian),
        )

    def tests(self) -> dict[str, float | None]:
        """Functions that change their sign at special points; None where there is no such function."""
        multipliers = self.multipliers
        pairs = [abs(m) ** 2 - 1 for m in multipliers if m.imag > 0]
        flip = complex(np.prod(1 + multipliers)).real
        return {"fold": float(self.tangent[-1]), "flip": flip, "neimark_sacker": min(pairs, key=abs, default=None)}


class Shooting:
    """Searches for periodic points of a map. `workers` is the number of threads that take its differences."""

    def __init__(self, map: Map, scale: Sequence[float] | np.ndarray, weight: float = 1.0, workers: int = 1) -> None:
        self.map, self.units, self.workers = map, np.append(np.asarray(scale, float), weight), workers
        self.runs = 0
        self._pool = ThreadPoolExecutor(workers) if workers > 1 else None

    def of(self, map: Map) -> Shooting:
        """The same search for another map of the same states."""
        return Shooting(map, self.units[:-1], self.units[-1], self.workers)

    def _image(self, w: np.ndarray) -> Image:
        self.runs += 1
        *x, p = w * self.units
        return self.map(np.array(x), p)

    def _attempt(self, w: np.ndarray) -> Image | None:
        try:
            return self._image(w)
        except Lost:
            return None

    def _residual(self, w: np.ndarray, image: Image) -> np.ndarray:
        return image.x / self.units[:-1] - w[:-1]

    def differences(self, w: np.ndarray, image: Image) -> tuple[np.ndarray, bool]:
        """Derivatives of the image by w, and whether another pattern was met. Those by the state are central; where another pattern is met
        on one side the other side is used alone, where on both a quarter of the difference. Of those by the parameter, of which no
        multiplier depends, one side is enough: each time the other one. Raises Edge."""
        columns: list[np.ndarray | None] = [None] * len(w)
        size, side, mixed = DIFFERENCE, 1, False
        while left := [i for i, column in enumerate(columns) if column is None]:
            if size < LEAST_DIFFERENCE:
                raise Edge("the sequence of contacts changes on both sides of the motion")
            sides = [(side,) if i == len(w) - 1 else (1, -1) for i in left]
            moves = [sign * size * np.eye(len(w))[i] for i, signs in zip(left, sides) for sign in signs]
            found = iter((self._pool.map if self._pool else map)(self._attempt, [w + move for move in moves]))
            for i, signs in zip(left, sides):
                its = [(next(found), sign) for sign in signs]
                good = [(one.x, sign) for one, sign in its if one is not None and one.pattern == image.pattern]
                mixed = mixed or len(good) < len(signs)
                if len(good) == 2:
                    columns[i] = (good[0][0] - good[1][0]) / (2 * size)
                elif good:
                    columns[i] = (good[0][0] - image.x) / (good[0][1] * size)
            size, side = size / 4, -side
        return np.array(columns).T / self.units[:-1, None], mixed

    def edge_distance(self, point: Point) -> float:
        """How small a change of one state leads to another pattern; infinite if those of the differences do not."""
        def changes(size: float) -> bool:
            found = (self._attempt(point.w + sign * size * unit) for unit in np.eye(len(point.w))[:-1] for sign in (1, -1))
            return any(its is None or its.pattern != point.image.pattern for its in found)

        size = DIFFERENCE
        if not changes(size):
            return math.inf
        while size > LEAST_DIFFERENCE and changes(size / 2):
            size /= 2
        return size

    def _correct(self, w: np.ndarray, normal: np.ndarray, jacobian: np.ndarray | None, most: int) -> tuple[np.ndarray, Image, float, int]:
        """Newton's method in the hyperplane through w with this normal: a periodic point, its image and residual, and how many corrections
        it took. Derivatives are kept while a correction halves the residual, with Broyden's update; with new ones a correction is damped
        by halves."""
        anchor, image, fresh = w, self._image(w), False
        residual = self._residual(w, image)
        for correction in range(most):
            size = abs(residual).max()
            if size < RESIDUAL and abs(normal @ (w - anchor)) < RESIDUAL:
                return w, image, size, correction
            if jacobian is None:
                jacobian, fresh = self.differences(w, image)[0], True
            matrix = np.vstack([jacobian - np.eye(len(w))[:-1], normal])
            try:
                step = np.linalg.solve(matrix, -np.append(residual, normal @ (w - anchor)))
            except np.linalg.LinAlgError:
                raise Lost("the derivatives are singular") from None
            share = 1.0
            while True:
                found = self._attempt(w + share * step)
                after = self._residual(w + share * step, found) if found else np.full(len(w) - 1, math.inf)
                if abs(after).max() < size or not fresh:
                    break
                share /= 2
                if share < 1 / 64:
                    raise Lost(f"the residual stays at {size:.1e}")
            if found and abs(after).max() < size:
                jacobian = jacobian + np.outer(after - (1 - share) * residual, step) / (share * (step @ step))
                w, image, residual = w + share * step, found, after
            if abs(after).max() > size / 2:
                jacobian, fresh = None, False
        raise Lost(f"the residual is {abs(residual).max():.1e} after {most} corrections")

    def _point(self, w: np.ndarray, image: Image, residual: float, corrections: int, along: np.ndarray, arclength: float) -> Point:
        """The point at w, with its derivatives; its tangent goes along the given direction."""
        jacobian, mixed = self.differences(w, image)
        tangent = np.linalg.svd(jacobian - np.eye(len(w))[:-1])[2][-1]
        *x, p = w * self.units
        return Point(w, np.array(x), p, image, residual, jacobian, tangent if tangent @ along >= 0 else -tangent, mixed, corrections,
                     arclength, runs=self.runs)  # fmt: skip

    def find(self, x: Sequence[float] | np.ndarray, p: float = 0.0) -> Point:
        """The periodic point near x at the parameter p. Raises Lost."""
        w = np.append(x, p) / self.units
        held = np.eye(len(w))[-1]
        return self._point(*self._correct(w, held, None, 3 * MOST_CORRECTIONS), held, 0.0)

    def double(self, once: Shooting, flip: Point) -> Point:
        """A periodic point of this map near a flip of another map, of which this is two periods. Its tangent leads away. Raises Lost."""
        values, vectors = np.linalg.eig(flip.jacobian[:, :-1])
        away = np.append(np.real(vectors[:, np.argmin(abs(values + 1))]), 0.0)
        start = flip.w * once.units / self.units
        for distance in DISTANCES:
            w = start + distance * away / abs(away).max()
            try:
                w, image, residual, count = self._correct(w, away / np.linalg.norm(away), None, MOST_CORRECTIONS)
                if abs(once._residual(w * self.units / once.units, once._image(w * self.units / once.units))).max() > distance / 2:
                    return self._point(w, image, residual, count, w - start, 0.0)
            except Lost:
                continue
        raise Lost("no motion of twice the period was found beside the flip")

    def follow(
        self, start: Point, limits: tuple[float, float], direction: float = 0.0, points: int = 60, tell: Callable[[Point], None] | None = None,
    ) -> tuple[list[Point], Lost | None]:  # fmt: skip
        """The branch from a point, towards a growing (1) or falling (-1) parameter, or along the tangent of the point (0), until the parameter
        leaves its limits or the branch ends: its points, special ones among them, and why it ended (None: at the limits, or after so
        many points)."""
        if direction * start.tangent[-1] < 0:
            start = replace(start, tangent=-start.tangent)
        last, branch, step, count = start, [start], FIRST_STEP, 1
        before: Point | None = None
        why = Lost("")
        while count < points:
            grazes = False
            w, jacobian = last.ahead(step, before)
            try:
                found = self._correct(w, last.tangent, jacobian, MOST_CORRECTIONS)
                grazes = found[1].pattern != last.image.pattern
                if grazes and step > LEAST_STEP:
                    step /= 2
                    continue
                p = found[0][-1] * self.units[-1]
                if is_over := not min(limits) <= p <= max(limits):
                    share = (min(max(limits), max(min(limits), p)) - last.p) / (p - last.p)
                    step *= share
                    found = self._correct(last.w + share * (found[0] - last.w), np.eye(len(w))[-1], jacobian, MOST_CORRECTIONS)
                new = self._point(*found, last.tangent, last.arclength + step)
                if new.tangent @ last.tangent < LARGEST_TURN and not grazes:
                    raise Lost("the branch turns too sharply")
            except Lost as error:
                why = error
                step /= 2
                if step < LEAST_STEP:
                    return [*branch[:-1], replace(branch[-1], kind=branch[-1].kind or why.kind)], why
                continue
            branch += [replace(last, kind="grazing")] if grazes else self._special(last, new)
            branch.append(new)
            last, before, count = new, None if grazes else last, count + 1
            if tell:
                tell(new)
            if is_over:
                return branch, None
            step = min(1.6 * step, LARGEST_STEP) if new.corrections <= 5 else step / 1.6 if new.corrections > 7 else step
        return branch, None

    def _special(self, a: Point, b: Point) -> list[Point]:
        """Folds, flips and Neimark-Sacker points between neighbours, by regula falsi over the arclength."""
        found = []
        for kind in a.tests():
            low, high, best = 0.0, b.arclength - a.arclength, b
            at_low, at_high = a.tests()[kind], b.tests()[kind]
            if at_low is None or at_high is None or at_low * at_high > 0 or a.kind == kind:
                continue
            for _ in range(MOST_CORRECTIONS):
                margin = 0.02 * (high - low)
                step = min(max(low - at_low * (high - low) / (at_high - at_low), low + margin), high - margin)
                try:
                    w, jacobian = a.ahead(step, b)
                    best = self._point(*self._correct(w, a.tangent, jacobian, MOST_CORRECTIONS), a.tangent, a.arclength + step)
                except Lost:
                    break
                test = best.tests()[kind]
                if test is None or abs(test) < TEST:
                    break
                if at_low * test > 0:
                    low, at_low = step, test
                else:
                    high, at_high = step, test
            found.append(replace(best, kind=kind))
        return sorted(found, key=lambda point: point.arclength)
