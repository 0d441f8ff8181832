"""Curves that oscillate faster than the width of a picture can show: their envelope with its mean, and a zoom on some
oscillations."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

#: Number of stretches of the abscissa in an envelope; each is some dots wide in a printed panel.
STRETCHES = 150

#: A stretch rings if the curve turns at least this often in it and covers at least this share of the curve's range.
LEAST_TURNS, LEAST_SHARE = 2, 0.1

#: A curve rings if at least this share of its stretches rings.
RINGING_SHARE = 0.08

#: Number of oscillations that a zoom shows.
SHOWN_OSCILLATIONS = 12


@dataclass(frozen=True)
class Envelope:
    """Smallest, largest and mean value of a curve in stretches of the abscissa of equal length, how often it turns in each, and its
    ripple: its range about the line through the means, which is small for a steep curve that does not ring."""

    x: np.ndarray
    low: np.ndarray
    high: np.ndarray
    mean: np.ndarray
    turns: np.ndarray
    ripple: np.ndarray

    @property
    def rings(self) -> np.ndarray:
        """Whether each stretch rings."""
        span = np.nanmax(self.high) - np.nanmin(self.low)
        # a far peak elsewhere must not hide ringing, so the median width of a stretch is used as well
        usual = np.nanmedian(self.high) - np.nanmedian(self.low)
        return (self.turns >= LEAST_TURNS) & (self.ripple > LEAST_SHARE * min(span, 10 * max(usual, span / 10)))


def envelope(x: np.ndarray, y: np.ndarray, stretches: int = STRETCHES) -> Envelope:
    """The mean is over x, by the trapezoidal rule, so that a stretch with many close rows has no more weight than others."""
    bounds = np.linspace(x[0], x[-1], stretches + 1)
    place = np.clip(np.searchsorted(bounds, x, side="right") - 1, 0, stretches - 1)
    low, high = range_of(place, y, stretches)
    area = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])
    mean = np.diff(np.interp(bounds, x, area)) / np.diff(bounds)
    turn = np.flatnonzero(np.diff(np.sign(np.diff(y))) != 0) + 1
    turns = np.bincount(place[turn], minlength=stretches)
    empty = ~np.isfinite(low)
    low[empty], high[empty] = mean[empty], mean[empty]
    middle = 0.5 * (bounds[1:] + bounds[:-1])
    below, above = range_of(place, y - np.interp(x, middle, mean), stretches)
    return Envelope(middle, low, high, mean, turns, np.where(empty, 0.0, above - below))


def range_of(place: np.ndarray, y: np.ndarray, stretches: int) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest value in each stretch, infinite where it has none; `place` has the stretch of each value."""
    low, high = np.full(stretches, np.inf), np.full(stretches, -np.inf)
    np.minimum.at(low, place, y)
    np.maximum.at(high, place, y)
    return low, high


def rings(x: np.ndarray, y: np.ndarray, share: float = RINGING_SHARE) -> bool:
    """Whether a picture of the whole curve would be a filled band: more than a share of its stretches ring."""
    if len(x) < 4 * STRETCHES:
        return False
    return bool(np.mean(envelope(x, y).rings) > share)


def draw_envelope(axis: Axes, x: np.ndarray, y: np.ndarray, colour: str) -> None:
    """Draw the band between smallest and largest value light, and the mean dark."""
    found = envelope(x, y)
    axis.fill_between(found.x, found.low, found.high, color=colour, alpha=0.4, linewidth=0, label="range of the ringing")
    axis.plot(found.x, found.mean, color=colour, label="mean of the ringing")


def zoom_window(x: np.ndarray, y: np.ndarray, reference: np.ndarray, after: float) -> tuple[float, float]:
    """Bounds in x of a zoom on some oscillations, around the beginning of the largest ringing about the reference beyond x =
    after."""
    found = envelope(x, y)
    later = found.x > after
    width = np.where(later & found.rings, found.ripple, 0.0)
    if not width.any():
        width = np.where(later, found.ripple, 0.0)
    middle = found.x[int(np.argmax(width))]
    step = found.x[1] - found.x[0]
    near = (x > middle - 2 * step) & (x < middle + 2 * step)
    off = (y - reference)[near]
    crossings = np.count_nonzero(np.diff(np.sign(off - np.median(off))))
    period = 2 * np.ptp(x[near]) / max(crossings, 1)
    length = min(max(SHOWN_OSCILLATIONS * period, step), 0.2 * np.ptp(x))
    start = min(max(middle - 0.3 * length, x[0]), x[-1] - length)
    return float(start), float(start + length)
