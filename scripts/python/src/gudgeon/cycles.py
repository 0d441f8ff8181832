"""Whole cycles of a settled run: orders, spectra, means with their scatter, work over the cycle, loads on the bearings."""

import re
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import fft, interpolate, signal

from gudgeon.names import PLACES
from gudgeon.results import MissingResult, Run

TURN = 2 * np.pi
FEWEST_ROWS = 36  # in a revolution: the work of the gas in simulation IV is off by 1e-4; with 12 by 10 %
POINTS = 720  # in a revolution, where the rows of the trace are not at equal crank angles


@dataclass(frozen=True)
class Cycles:
    """Columns at equal crank angles over whole cycles: values of each column as (cycle, angle)."""

    run: Run
    angle: np.ndarray  # within a cycle [rad], from 0
    start: np.ndarray  # crank angle at which each cycle begins [rad]
    values: dict[str, np.ndarray]
    sense: float  # sign of the crank's rotation

    @property
    def length(self) -> float:
        """Of a cycle [rad]."""
        return self.run.cycle

    @property
    def place(self) -> np.ndarray:
        """Crank angle within the cycle of each column of the values, measured from 0 of the trace's own crank angle [rad]."""
        return np.mod(self.start[0] * self.sense + self.angle + 1e-9, self.length) - 1e-9

    @property
    def number(self) -> int:
        return len(self.start)

    def __getitem__(self, column: str) -> np.ndarray:
        if column not in self:
            raise self.run.lack(column)
        return self.values[column]

    def __contains__(self, column: str) -> bool:
        return column in self.values


def whole_cycles(run: Run, settle: float | None = None, most: int | None = None) -> Cycles:
    """The last `most` whole cycles of a run that begin after `settle` revolutions (default: half of the run; 0 if the trace
    contains the last period alone). Rows at equal crank angles are used as they are; other rows are interpolated by cubic
    polynomials over the crank angle."""
    travel = run["crank_angle"] - run["crank_angle"][0]
    sense = 1.0 if travel[-1] >= 0 else -1.0
    travel = sense * travel
    if np.any(np.diff(travel) <= 0):
        raise MissingResult(f"{run.name}: the crank stops or turns back, so there are no cycles")
    if settle is None:
        settle = 0.0 if run.parameter("output", "window") == "last_period" else travel[-1] / TURN / 2
    rounding = 1e-6
    if run.parameter("output", "window") == "last_period" and len(travel) > 1:  # rows at equal times end before the period ends
        rounding = 1.01 * float(np.max(np.diff(travel)))
    number = int((travel[-1] - settle * TURN + rounding) // run.cycle)
    if most is not None:
        number = min(number, most)
    if number < 1:
        raise MissingResult(f"{run.name}: no whole cycle of {run.cycle / TURN:g} revolutions after {settle:g} revolutions")
    rows = TURN / float(np.median(np.diff(travel)))
    if rows < FEWEST_ROWS:
        raise MissingResult(f"{run.name}: {rows:.3g} rows in a revolution are too few, {FEWEST_ROWS} are needed")
    points, first = grid_of(travel, run.cycle, number)
    angle = np.arange(points) * (run.cycle / points)
    begin = travel[-1] - number * run.cycle if first is None else travel[first]
    start = begin + np.arange(number) * run.cycle
    places = (start[:, None] + angle[None, :]).ravel()
    values = {}
    for name in run.trace.columns:
        column = run[name]
        if first is not None:
            taken = column[first : first + number * points]
        elif name.endswith("phase"):
            taken = column[np.clip(np.searchsorted(travel, places, side="right") - 1, 0, len(column) - 1)]
        else:
            taken = interpolate.CubicSpline(travel, column)(np.clip(places, travel[0], travel[-1]))
        values[name] = taken.reshape(number, points)
    return Cycles(run, angle, run["crank_angle"][0] + sense * start, values, sense)


def grid_of(travel: np.ndarray, length: float, number: int) -> tuple[int, int | None]:
    """Number of points of a cycle; and the row of the first point, if the rows are already at equal crank angles."""
    steps = np.diff(travel)
    points = int(round(length / np.median(steps)))
    if np.ptp(steps) < 1e-4 * np.median(steps) and abs(points * np.median(steps) - length) < 1e-6 * length and points > 1:
        first = len(travel) - 1 - number * points
        if first >= 0:
            return points, first
    return int(round(length / TURN * POINTS)), None


def orders(cycles: Cycles, column: str) -> pd.DataFrame:
    """Amplitude and phase [deg] of each order (cycles of the quantity per revolution), by a Fourier sum over all cycles together. A
    term is amplitude cos(order q + phase), with the crank angle q positive in the direction of rotation. `scatter` is the standard
    deviation of the amplitude from cycle to cycle. Order 0 is the mean."""
    values = cycles[column]
    points = values.shape[1]
    of_each = fft.rfft(values, axis=1) / points
    of_each = of_each * np.exp(-1j * np.arange(of_each.shape[1]) * TURN / cycles.length * cycles.place[0])
    together = of_each.mean(axis=0)
    factor = np.full(len(together), 2.0)
    factor[0] = 1.0
    if points % 2 == 0:
        factor[-1] = 1.0
    return pd.DataFrame(
        {
            "order": np.arange(len(together)) * TURN / cycles.length,
            "amplitude": factor * np.abs(together),
            "phase_deg": np.degrees(np.angle(together)),
            "scatter": np.std(factor * np.abs(of_each), axis=0),
        }
    )


def spectrum(cycles: Cycles, column: str) -> tuple[np.ndarray, np.ndarray]:
    """Frequency [Hz] and amplitude spectral density [unit/sqrt(Hz)] over the time of the cycles (Welch, Hann windows of half of
    it)."""
    time = cycles["time"].ravel()
    count = len(time)
    even = np.linspace(time[0], time[-1], count)
    values = np.interp(even, time, cycles[column].ravel())
    rate = (count - 1) / (time[-1] - time[0])
    frequency, density = signal.welch(values, rate, nperseg=max(8, count // 2), detrend="constant")
    return frequency, np.sqrt(density)


WORK_IN_CYCLE = re.compile(r"(?P<prefix>crank_pin_|small_end_)?cycle_(work_(?P<part>\w+)|energy_change)")
NAMES = dict(PLACES.values())
LABELS = {"gas": "gas", "drive": "drive", "damping": "damping", "guide": "guide", "elastic": "elastic members",
          "rest": "rest: error of the integration", None: "change of the energy"}


def work(run: Run) -> pd.DataFrame:
    """Work on the bodies in the last whole cycle of a run [J], from its summary; with gas also as mean effective pressure [Pa], that is
    divided by the volume that the piston sweeps. Empty if the summary has none."""
    values = {name: float(value) for name, (value, _) in run.summary.items() if WORK_IN_CYCLE.fullmatch(name)}
    imep = float(run.summary.get("cycle_imep", ("0", ""))[0])
    swept = values["cycle_work_gas"] / imep if imep else 0.0
    rows = []
    for name, value in values.items():
        found = WORK_IN_CYCLE.fullmatch(name)
        part = found["part"]
        label = LABELS.get(part) or f"{part}, {NAMES[found['prefix'] or '']}"
        row = {"quantity": label, "work[J]": value}
        if swept:
            row["mean_effective_pressure[Pa]"] = value / swept
        rows.append(row)
    return pd.DataFrame(rows)


def bearing_loads(cycles: Cycles) -> dict[str, np.ndarray]:
    """Loads on the bearings over all cycles, (2, cycles, angles) [N]: the force of the piston on the rod and of the crank on the
    rod, both along the rod (positive outwards) and across it; and the force of the crank on its main bearing, along x and y."""
    angle = cycles["rod_angle"]
    cosine, sine = np.cos(angle), np.sin(angle)

    def along_rod(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.array([x * cosine + y * sine, -x * sine + y * cosine])

    loads = {}
    if "pin_force_x" in cycles:  # force of the joint on the pin, which belongs to the rod
        loads["piston on the rod, in the rod's frame"] = along_rod(cycles["pin_force_x"], cycles["pin_force_y"])
    if "crankpin_force_x" in cycles:
        loads["crank on the rod, in the rod's frame"] = along_rod(cycles["crankpin_force_x"], cycles["crankpin_force_y"])
    if "crank_bearing_force_x" in cycles:
        loads["crank on the main bearing"] = np.array([-cycles["crank_bearing_force_x"], -cycles["crank_bearing_force_y"]])
    return loads
