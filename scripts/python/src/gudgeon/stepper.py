"""A run that is advanced step by step, with inputs that change between steps."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, MutableMapping
from typing import TYPE_CHECKING, Any

from ._library import columns_of_run, library, meant, message
from .run import Run, RunError, _Owner, advance, from_handle

if TYPE_CHECKING:
    from .case import Case


class Inputs(MutableMapping[str, float]):
    """The inputs of a run. A new value acts from the next advance on; a prescribed speed changes linearly during it."""

    def __init__(self, owner: _Owner) -> None:
        self._owner, self._number = owner, owner.number
        number = owner.number
        self.units: dict[str, str] = {}
        self._index: dict[str, int] = {}
        for i in range(library().inputs(number)):
            value, name, unit = ctypes.c_double(), ctypes.create_string_buffer(40), ctypes.create_string_buffer(20)
            library().input(number, i, value, name, 40, unit, 20)
            self._index[name.value.decode()] = i
            self.units[name.value.decode()] = unit.value.decode()

    def _at(self, name: str) -> int:
        if name not in self._index:
            raise KeyError(f"no input {name}{meant(name, list(self._index))}; there are: {', '.join(self._index) or 'none'}")
        return self._index[name]

    def __getitem__(self, name: str) -> float:
        value = ctypes.c_double()
        library().input(self._number, self._at(name), value, None, 0, None, 0)
        return value.value

    def __setitem__(self, name: str, value: float) -> None:
        if library().input_set(self._number, self._at(name), value):
            raise ValueError(f"{name} must be a finite number")

    def __delitem__(self, name: str) -> None:
        raise TypeError("inputs cannot be removed")

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def __repr__(self) -> str:
        return repr(dict(self))


class Snapshot:
    """A saved state of a run."""

    def __init__(self, number: int) -> None:
        self._owner = _Owner(number)


class Stepper:
    """A run in steps; made by `Case.begin`.

    >>> stepper = gudgeon.template("dry").begin(end=0.1)
    >>> stepper.advance(0.05)
    False
    >>> saved = stepper.snapshot()
    >>> stepper.advance(0.1)
    True
    >>> stepper.restore(saved)
    >>> round(stepper.t, 3)
    0.05
    """

    def __init__(self, case: Case, end: float | None = None) -> None:
        self._owner = _Owner(case._begin(False, end))
        self._case = case.copy()
        self.inputs = Inputs(self._owner)
        self._names = [column.name for column in columns_of_run(self._number)]
        self._values = (ctypes.c_double * len(self._names))()

    @property
    def _number(self) -> int:
        return self._owner.number

    @property
    def t(self) -> float:
        """The time reached [s]."""
        return float(library().run_time(self._number))

    @property
    def end(self) -> float:
        """The end of the run [s], as far as it is known."""
        return float(library().run_end(self._number))

    def advance(self, to: float) -> bool:
        """Go on to a time [s], or to the end of the run if that comes first. Returns whether the run has ended. Raises RunError if
        the integration cannot go on, ValueError for a time that is not a finite number."""
        status = advance(self._number, to, None, None)
        if status == 4:
            run = self.run
            raise RunError(run.status, run)
        return status == 0

    @property
    def values(self) -> dict[str, float]:
        """All columns at the present time."""
        if library().values(self._number, self._values):
            raise ArithmeticError("the state is outside the model")
        return dict(zip(self._names, self._values))

    def snapshot(self) -> Snapshot:
        return Snapshot(library().run_copy(self._number))

    def restore(self, saved: Snapshot) -> None:
        """Put a saved state of a run of this case back, with its inputs; the snapshot stays. Raises ValueError for that of another
        case."""
        if library().run_assign(self._number, saved._owner.number):
            raise ValueError(message(self._number))

    @property
    def run(self) -> Run:
        """The results so far, as a run of their own."""
        return from_handle(self._case, library().run_copy(self._number))

    def finish(self) -> Run:
        """The results up to here; those of `Case.run` if the run has reached its end."""
        return self.run

    def __enter__(self) -> Stepper:
        return self

    def __exit__(self, *unused: Any) -> None:
        return None
