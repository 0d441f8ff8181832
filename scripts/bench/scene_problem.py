"""Makes scenes of gudgeon available to integrators in Python and C, through build/scene_library/scene_library.so."""
from __future__ import annotations

import ctypes as c
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy import integrate, optimize

from measured import TOP

FOLDER = TOP / "build" / "scene_library"
MOST_INSTANTS = 1000
Doubles = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")


class TooManyEvaluations(Exception):
    """Raised when a run needs more evaluations of the right-hand side than are allowed."""


@dataclass
class Outcome:
    """Result of one run."""

    done: bool = False
    evaluations: int = 0
    jacobians: int = 0
    steps: int = 0
    seconds: float = 0.0
    y: np.ndarray = field(default_factory=lambda: np.empty(0))
    instants: np.ndarray = field(default_factory=lambda: np.empty(0))   # times at which contacts begin and end [s]
    said: str = ""


def load_library(path: Path = FOLDER / "scene_library.so") -> c.CDLL:
    """Load the library of scenes and declare the types of its functions."""
    library = c.CDLL(str(path))
    ints = np.ctypeslib.ndpointer(dtype=np.int32, flags="C_CONTIGUOUS")
    types = {
        "scene_open": (c.c_int, c.c_char_p, c.c_char_p, c.c_int, c.POINTER(c.c_void_p)),
        "scene_close": (None, c.c_void_p),
        "scene_sizes": (None, c.c_void_p, ints),
        "scene_start": (c.c_int, c.c_void_p, Doubles, c.POINTER(c.c_double), Doubles, Doubles),
        "scene_rates": (c.c_int, c.c_void_p, c.c_double, Doubles, Doubles),
        "scene_events": (c.c_int, c.c_void_p, c.c_double, Doubles, Doubles, Doubles),
        "scene_handle_event": (c.c_int, c.c_void_p, c.c_int, c.c_double, Doubles, c.POINTER(c.c_int)),
        "scene_look": (None, c.c_void_p, c.c_double, Doubles, Doubles),
        "scene_integrate": (c.c_int, c.c_void_p, c.c_char_p, c.c_double, c.c_int, Doubles, c.POINTER(c.c_double), ints),
        "scene_largest": (None, c.c_void_p, Doubles),
        "scene_instants": (None, c.c_void_p, c.c_int, Doubles),
        "scene_seconds_in_turn": (c.c_double, c.c_void_p, c.c_double, Doubles),
    }
    for name, (result, *arguments) in types.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library


class CompiledRun(c.Structure):
    """The C structure run_t of scripts/bench/scene_library/scene_run.h."""

    _fields_ = [("handle", c.c_void_p), ("rates", c.c_void_p), ("events", c.c_void_p), ("handle_event", c.c_void_p),
                ("sizes", c.c_void_p), ("n", c.c_int), ("most_rates", c.c_int), ("n_rates", c.c_int), ("n_jacobians", c.c_int),
                ("n_steps", c.c_int), ("n_instants", c.c_int), ("most_instants", c.c_int), ("seconds", c.c_double)]


class Scene:
    """A case, its right-hand side, and runs of it by several codes."""

    def __init__(self, library: c.CDLL, case: str, options: str = "", twin: bool = False) -> None:
        self.library = library
        self.handle = c.c_void_p()
        path = str(TOP / "cases" / f"{case}.nml")
        if library.scene_open(path.encode(), options.encode(), int(twin), c.byref(self.handle)) != 0:
            raise SystemExit(f"compare_integrators: the scene of {case} cannot be built")
        self.n = int(self.sizes()[0])
        self.relative, self.absolute = np.zeros(self.n), np.zeros(self.n)
        self.t_end = 0.0
        self.start()

    def sizes(self) -> np.ndarray:
        """Number of states without and with quadratures, and present number of event functions."""
        sizes = np.zeros(3, dtype=np.int32)
        self.library.scene_sizes(self.handle, sizes)
        return sizes

    def start(self) -> np.ndarray:
        """Set the scene to its start, and return the state there."""
        y, t_end = np.zeros(self.n), c.c_double()
        if self.library.scene_start(self.handle, y, c.byref(t_end), self.relative, self.absolute) != 0:
            raise SystemExit("compare_integrators: a scene cannot be built")
        self.t_end = t_end.value
        return y

    def look(self, y: np.ndarray) -> np.ndarray:
        """q, A, x, their rates, and e_x, e_y, for the state y at the end."""
        values = np.zeros(8)
        self.library.scene_look(self.handle, self.t_end, np.ascontiguousarray(y), values)
        return values

    def largest(self) -> np.ndarray:
        """The largest absolute values of the same quantities in the last run with watches = True."""
        values = np.zeros(8)
        self.library.scene_largest(self.handle, values)
        return values

    def seconds_in_turn(self, t: float, y: np.ndarray) -> float:
        """Time in seconds of one right-hand side at (t, y), in the discrete state of the start, in a sequence in which each waits for
        the one before."""
        self.start()
        return self.library.scene_seconds_in_turn(self.handle, t, np.ascontiguousarray(y))

    def tolerances(self, tolerance: float) -> tuple[float, np.ndarray]:
        """The relative tolerance for all states, and an absolute tolerance for each state from the program's own scales."""
        return tolerance, tolerance * np.where(self.absolute > 0, self.absolute, 1.0)

    def run_own(self, method: str, tolerance: float, watches: bool = False) -> Outcome:
        """Run by the program's own method adams, radau or auto."""
        y, seconds, counts = np.zeros(self.n), c.c_double(), np.zeros(4, dtype=np.int32)
        status = self.library.scene_integrate(self.handle, method.encode(), tolerance, int(watches), y, c.byref(seconds), counts)
        instants = np.zeros(min(int(counts[3]), MOST_INSTANTS))
        self.library.scene_instants(self.handle, len(instants), instants)
        return Outcome(status == 0, int(counts[0]), int(counts[1]), int(counts[2]), seconds.value, y, instants, f"status {status}")

    def run_compiled(self, driver: c.CDLL, name: str, method: int, tolerance: float, most: int) -> Outcome:
        """Run by a driver in C, such as scripts/bench/scene_library/cvode_run.c."""
        y = self.start()
        relative, absolute = self.tolerances(tolerance)
        address = {f: c.cast(getattr(self.library, f"scene_{f}"), c.c_void_p) for f in ("rates", "events", "handle_event", "sizes")}
        run = CompiledRun(self.handle, address["rates"], address["events"], address["handle_event"], address["sizes"], self.n, most, 0,
                       0, 0, 0, MOST_INSTANTS, 0.0)
        instants = np.zeros(MOST_INSTANTS)
        pointer = c.POINTER(c.c_double)
        status = getattr(driver, name)(c.byref(run), method, c.c_double(relative), absolute.ctypes.data_as(pointer), c.c_double(0.0),
                                       c.c_double(self.t_end), y.ctypes.data_as(pointer), instants.ctypes.data_as(pointer))
        return Outcome(status >= 0, run.n_rates, run.n_jacobians, run.n_steps, run.seconds, y, instants[: run.n_instants],
                       f"status {status}")

    def run_scipy(self, method: type, tolerance: float, most: int) -> Outcome:
        """Run by a method of scipy.integrate."""
        outcome = Outcome()
        f = np.zeros(self.n)

        def rates(t: float, y: np.ndarray) -> np.ndarray:
            outcome.evaluations += 1
            if outcome.evaluations > most:
                raise TooManyEvaluations
            if self.library.scene_rates(self.handle, t, np.ascontiguousarray(y), f) != 0:
                return np.full(self.n, np.nan)
            return f.copy()

        relative, absolute = self.tolerances(tolerance)
        t, y, instants = 0.0, self.start(), []
        before = time.perf_counter()
        try:
            while t < self.t_end:
                solver = method(rates, t, y, self.t_end, rtol=relative, atol=absolute)
                t, y, index, ends = self.run_phase(solver, outcome)
                if index > 0:
                    y, is_contact = np.ascontiguousarray(y), c.c_int()
                    ends = self.library.scene_handle_event(self.handle, index, t, y, c.byref(is_contact)) != 0
                    if is_contact.value:
                        instants.append(t)
                if ends:
                    break
            outcome.done = True
        except (TooManyEvaluations, RuntimeError, ValueError, np.linalg.LinAlgError) as error:
            outcome.said = type(error).__name__
        outcome.seconds = time.perf_counter() - before
        outcome.y, outcome.instants = np.array(y), np.array(instants)
        return outcome

    def run_phase(self, solver: integrate.OdeSolver, outcome: Outcome) -> tuple[float, np.ndarray, int, bool]:
        """Integrate up to the next event: time, state, number of the event (0: the end of the run), and whether the run can
        continue."""
        g, rate = self.events(solver.t, solver.y)
        low = g < 0
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(message)
            outcome.steps += 1
            g_new, rate_new = self.events(solver.t, solver.y)
            first_t, first = solver.t, 0
            for i in range(len(g)):
                if low[i] and stays_negative(solver.t - solver.t_old, g[i], rate[i], g_new[i], rate_new[i]):
                    continue
                found, t_found, low[i] = self.passage(solver, i, low[i])
                if found and (first == 0 or t_found < first_t):
                    first_t, first = t_found, i + 1
            if first > 0:
                return first_t, solver.dense_output()(first_t), first, False
            g, rate = g_new, rate_new
        return solver.t, solver.y, 0, True

    def events(self, t: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Event functions and their derivatives with respect to time."""
        n = int(self.sizes()[2])
        g, rate = np.zeros(n), np.zeros(n)
        self.library.scene_events(self.handle, t, np.ascontiguousarray(y), g, rate)
        return g, rate

    def passage(self, solver: integrate.OdeSolver, i: int, low: bool) -> tuple[bool, float, bool]:
        """The first zero crossing of an event function in the last step, from negative to not negative; ten places of the step are
        tested."""
        dense = solver.dense_output()

        def g(t: float) -> float:
            return self.events(t, dense(t))[0][i]

        times = np.linspace(solver.t_old, solver.t, 11)
        for left, right in zip(times[:-1], times[1:]):
            at_right = g(right)
            if low and at_right >= 0:
                return True, right if at_right == 0 or g(left) >= 0 else optimize.brentq(g, left, right, xtol=1e-15, rtol=1e-15), low
            low = low or at_right < 0
        return False, solver.t, low


def stays_negative(width: float, left: float, left_rate: float, right: float, right_rate: float) -> bool:
    """Whether a function that is negative at both ends of a step stays negative between them. The estimate is its cubic Hermite
    interpolant, with the curvature counted twice."""
    if left >= 0 or right >= 0:
        return False
    inner = left + width * left_rate / 3, right - width * right_rate / 3
    bend = max(abs(inner[0] - (2 * left + right) / 3), abs(inner[1] - (left + 2 * right) / 3))
    return max(inner) + bend < 0
