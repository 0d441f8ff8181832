"""A case: what a case file says, group by group, as Python objects."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _library
from ._keys import GroupInfo, Key, groups, keys
from ._library import Column, described_columns, library, meant, states_of_case, text_from
from .run import Certificate, Run, _Owner, carry_out
from .stepper import Stepper

if TYPE_CHECKING:
    from ._groups import Groups
    from .report.explorer import Session
else:
    Groups = object

Value: TypeAlias = "float | int | bool | str | Sequence[float] | None"


class CaseError(ValueError):
    """A case is wrong: the text of the program, a line for each thing. `key` is the first key that the text names, or None."""

    def __init__(self, text: str) -> None:
        text = text.replace("the case has no folder", "the case has no folder: gudgeon.Case.from_text(text, folder='/') reads tables anywhere")
        super().__init__(text)
        self.key = next((name for name in keys if f"&{name.replace('.', ' ')} " in text.replace("(", " ")), None)


class Group:
    """A group of a case. Its keys are attributes; None means the default. `del case.contact.law` does the same."""

    def __init__(self, case: Case, info: GroupInfo) -> None:
        object.__setattr__(self, "_case", case)
        object.__setattr__(self, "_info", info)

    def _key(self, name: str) -> str:
        if all(key.name != name for key in self._info.keys):
            raise AttributeError(f"&{self._info.name} has no key {name}{meant(name, [key.name for key in self._info.keys])}")
        return f"{self._info.name}.{name}"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return self._case[self._key(name)]

    def __setattr__(self, name: str, value: Value) -> None:
        self._case[self._key(name)] = value

    def __delattr__(self, name: str) -> None:
        self._case[self._key(name)] = None

    def __dir__(self) -> list[str]:
        return [key.name for key in self._info.keys]

    def __bool__(self) -> bool:
        return self._info.name in self._case

    @property
    def __doc__(self) -> str:  # type: ignore[override]
        return "\n".join([self._info.meaning, "", *(str(key) for key in self._info.keys)])

    def __repr__(self) -> str:
        if not self:
            return f"&{self._info.name} is not in the case"
        given = [f"{key.name} = {self._case[f'{key.group}.{key.name}']!r}" for key in self._info.keys if self._case.is_given(key)]
        return f"&{self._info.name} {', '.join(given)} /"


class Place:
    """The groups of one place, such as `case.crank_pin.joint`."""

    def __init__(self, case: Case, name: str) -> None:
        self._case, self._name = case, name

    def __getattr__(self, name: str) -> Group:
        if f"{self._name}.{name}" not in groups():
            raise AttributeError(f"{self._name} has no group {name}")
        return Group(self._case, groups()[f"{self._name}.{name}"])

    def __dir__(self) -> list[str]:
        return [name.partition(".")[2] for name in groups() if name.startswith(self._name + ".")]


class Case(Groups):
    """A case that can be changed, checked and run. Make one by `gudgeon.read`, `gudgeon.template` or `Case.from_text`.

    >>> case = Case.from_text(template("dry").to_nml())
    >>> case.joint.clearance = "4e-5"
    >>> case["joint.clearance"], case.set({"joint.clearance": 1e-5}).joint.clearance
    (4e-05, 1e-05)
    """

    _handle: int

    def __init__(self, handle: int, name: str, folder: str, cache: str | None = None) -> None:
        self.__dict__.update(_handle=handle, name=name, _folder=folder, _cache=cache)

    @classmethod
    def from_text(cls, text: str, name: str = "case", folder: str | Path | None = None) -> Case:
        """A case from the text of a case file. Tables that it names are read in `folder` and below; None: it may name none; "/":
        anywhere. Raises CaseError where the text cannot be read."""
        place = "" if folder is None else os.path.abspath(folder)
        data = text.encode(errors="surrogateescape")
        return cls(library().case_new(data, len(data), name.encode(), place.encode()), name, place)

    def __del__(self, library: Callable[[], Any] = library) -> None:  # also while Python ends
        if "_handle" in self.__dict__:
            library().case_free(self._handle)

    def _ask(self, status: int) -> None:
        if status:
            raise CaseError(_library.message(self._handle))

    # values

    def __getitem__(self, name: str) -> Any:
        key = _find(name)
        return _read(key, text_from(library().case_get, self._handle, name.encode(), guess=256))

    def __setitem__(self, name: str, value: Value) -> None:
        key = _find(name)
        value = getattr(value, "tolist", lambda: value)()  # of NumPy
        if isinstance(value, (int, float)) and not isinstance(value, bool) and key.kind in ("real", "integer") and key.count == 1:
            self._ask(library().case_set_number(self._handle, key.index, key.element, value))
        else:
            self._ask(library().case_set(self._handle, name.encode(), None if value is None else _write(key, value).encode()))

    def __contains__(self, name: str) -> bool:
        return text_from(library().case_get, self._handle, name.encode(), guess=16) == "present" if name in groups() else name in keys

    def __getattr__(self, name: str) -> Any:
        if name in groups():
            return Group(self, groups()[name])
        if any(group.startswith(name + ".") for group in groups()):
            return Place(self, name)
        raise AttributeError(f"a case has no group {name}{meant(name, list(groups()))}")

    def __setattr__(self, name: str, value: Any) -> None:
        if name != "name":
            raise AttributeError(f"set its keys: case.{name}.KEY = ..., or case.add('{name}', KEY=...)")
        self.__dict__["name"] = value

    def __dir__(self) -> list[str]:
        return [*object.__dir__(self), *(name.partition(".")[0] for name in groups())]

    def is_given(self, key: Key) -> bool:
        """Whether the case itself gives this key."""
        return bool(library().case_given(self._handle, key.index))

    def given(self) -> dict[str, Any]:
        """All values that the case itself gives."""
        return {name: self[name] for name, key in keys.items() if self.is_given(key)}

    def set(self, values: Mapping[str, Value] = {}, **of_groups: Mapping[str, Value]) -> Case:
        """A changed copy: `case.set({"joint.clearance": 1e-5}, drive={"torque": 3})`."""
        new = self.copy()
        for name, value in values.items():
            new[name] = value
        for group, its in of_groups.items():
            new.add(group, **its)
        return new

    def add(self, group: str, **values: Value) -> None:
        """Add a group, or change keys of one."""
        _find_group(group)
        self._ask(library().case_set(self._handle, group.encode(), b""))
        for name, value in values.items():
            self[f"{group}.{name}"] = value

    def remove(self, group: str) -> None:
        """Remove a group with all its values."""
        _find_group(group)
        self._ask(library().case_set(self._handle, group.encode(), b"none"))

    def accuracy(self, level: str) -> Case:
        """A copy with an accuracy level: draft, standard, reference or dissertation."""
        new = self.copy()
        new._ask(library().case_accuracy(new._handle, level.encode()))
        return new

    def start_from(self, start: Run | Stepper | Mapping[str, float | Sequence[float]] | None) -> Case:
        """A copy whose runs begin at t = 0 with the motion that a run has reached, and count from 0, as with `initial.goes_on = False`.
        A dict, such as `run.state`, changes the numbers that it has, and leaves the others of the start; None: as the case says. A start
        that does not fit the case is refused when a run begins.

        >>> case = gudgeon.template("dry")
        >>> settled = case.run(end=0.1)
        >>> again = case.start_from(settled).run(end=0.01)
        >>> bool(again["crank_speed"][0] == settled["crank_speed"][-1])
        True
        """
        new = self.copy()
        owner = getattr(start, "_owner", None)
        if isinstance(start, Run) and owner is None:  # it was read or copied
            start = start.state
            if not start:
                raise ValueError("only a whole run has a state to start from")
        if isinstance(start, Mapping):
            if not library().states(new._handle):
                begun = _Owner(new._begin(False, None, True))
                library().case_start(new._handle, begun.number)
            names = [state.name if state.kind < 2 else "" for state in states_of_case(new._handle)]
            for name, values in start.items():
                numbers = list(values) if isinstance(values, Iterable) else [values]
                places = [i for i, its in enumerate(names) if its == name]
                if len(places) != len(numbers):
                    raise ValueError(f"state {name}: {len(numbers)} numbers, but the case has {len(places)}{meant(name, names)}")
                for i, value in zip(places, numbers):
                    new._ask(library().state_set(new._handle, i, value))
        else:
            library().case_start(new._handle, owner.number if owner else None)
        return new

    @property
    def start(self) -> dict[str, float | tuple[float, ...]]:
        """The motion with which runs begin, as `run.state`; empty: as the case says."""
        found: dict[str, Any] = {}
        for state in states_of_case(self._handle):
            if state.kind < 2:
                found.setdefault(state.name, []).append(int(state.value) if state.kind else state.value)
        return {name: tuple(values) if len(values) > 1 else values[0] for name, values in found.items()}

    def copy(self) -> Case:
        return Case(library().case_copy(self._handle), self.name, self._folder, self._cache)

    __copy__ = copy

    def cache(self, folder: str | Path | None) -> None:
        """Keep tables of films in a folder instead of the user's cache; None: nothing is written at all."""
        self.__dict__["_cache"] = "" if folder is None else os.path.abspath(folder)
        library().case_cache(self._handle, self._cache.encode())

    # texts

    def check(self) -> list[str]:
        """Complete and check the case. Returns notes on implausible values; raises CaseError with everything that is wrong."""
        self._ask(library().case_check(self._handle))
        return text_from(library().case_notes, self._handle).splitlines()

    def to_nml(self, path: str | Path | None = None, complete: bool = False) -> str:
        """The case as a case file: what it gives, or all keys with their defaults."""
        if complete:
            self.check()
            text = text_from(library().case_text, self._handle, guess=30000)
        else:
            text = "".join(self._group_text(info) for name, info in groups().items() if name in self)
        if path is not None:
            Path(path).write_text(text)
        return text

    def _group_text(self, info: GroupInfo) -> str:
        place, _, name = info.name.rpartition(".")
        lines = [f"  place = '{place}'"] if place else []
        for key in info.keys:
            if self.is_given(key):
                lines.append(f"  {key.name} = {_given_text(self, key)}{key.unit and '  ! ' + key.unit}")
        return "\n".join([f"&{name}", *lines, "/", ""])

    def diff(self, other: Case) -> dict[str, tuple[Any, Any]]:
        """The values in which two cases differ."""
        both = {name: (self[name], other[name]) for name in keys}
        return {name: pair for name, pair in both.items() if pair[0] != pair[1]}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.to_nml() == other.to_nml() and self.start == other.start

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.to_nml(), self.name, self._folder, self._cache, self.start)

    def __repr__(self) -> str:
        return f"<Case {self.name}: {', '.join(name for name in groups() if name in self)}>"

    # runs

    @property
    def columns(self) -> list[Column]:
        """The columns that a run will have."""
        self.check()
        return described_columns(library().case_columns(self._handle), library().case_column, self._handle)

    def run(
        self,
        *,
        until: float | None = None,
        end: float | None = None,
        accuracy: str | None = None,
        columns: str | Sequence[str] | None = None,
        progress: Callable[[float], None] | bool | None = None,
        timeout: float | None = None,
        certify: bool = False,
        ideal_twin: bool = False,
    ) -> Run:
        """Run the case to its end, or to the time `end` [s] instead.

        until: stop at this time [s] without being told so before; accuracy: a level of the command line; columns: names, or
        "none"; progress: True, or a function of the share done; timeout [s] of the clock; certify: estimate the accuracy, by two
        more runs; ideal_twin: run the twin with ideal joints too. Raises CaseError for a wrong case, RunError if the integration
        cannot go on: its `run` has the results so far, as has that of a KeyboardInterrupt or TimeoutError.
        """
        case = self if accuracy is None and columns is None else self._with(accuracy, columns)
        return carry_out(case, until, end, progress, timeout, certify, ideal_twin)

    def begin(self, end: float | None = None, columns: str | Sequence[str] | None = None) -> Stepper:
        """A run that is advanced step by step, and whose inputs may change between steps."""
        return Stepper(self._with(None, columns), end)

    def explore(self, port: int = 0) -> Session:
        """A page whose sliders run the case: a notebook shows it, a browser opens its `address`. Only this machine can; `close` ends it."""
        from .report.explorer import Session

        return Session(self, port)

    def certify(self) -> Certificate:
        """How many digits of a run are right."""
        found = self.run(certify=True).certificate
        assert found is not None
        return found

    def _with(self, accuracy: str | None, columns: str | Sequence[str] | None) -> Case:
        case = self.copy() if accuracy is None else self.accuracy(accuracy)
        if columns is not None:
            case["output.columns"] = columns if isinstance(columns, str) else ", ".join(columns)
        return case

    def _begin(self, twin: bool, end: float | None, without_rows: bool = False) -> int:
        """A handle of a run."""
        handle = library().run_new(self._handle, twin, end or 0.0, without_rows)
        if not handle:
            raise CaseError(_library.message(self._handle))
        return handle


def _restored(text: str, name: str, folder: str, cache: str | None, start: dict[str, Any]) -> Case:
    case = Case.from_text(text, name, folder or None)
    if cache is not None:
        case.cache(cache or None)
    return case.start_from(start) if start else case


def _find(name: str) -> Key:
    try:
        return keys[name]
    except KeyError:
        raise KeyError(f"no key {name}{meant(name, list(keys))}") from None


def _find_group(name: str) -> None:
    if name not in groups():
        raise KeyError(f"no group {name}{meant(name, list(groups()))}")


def _read(key: Key, text: str) -> Any:
    """A value as the case file has it, as a Python object."""
    if key.kind == "real":
        numbers = tuple(float(part) for part in text.split(","))
        return numbers if key.count > 1 else numbers[0]
    if key.kind == "integer":
        return int(text)
    if key.kind == "switch":
        return text == ".true."
    return text[1:-1].replace("''", "'")


def _write(key: Key, value: Any) -> str:
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return value
    if isinstance(value, (int, float)):
        return repr(value)
    return ", ".join(part if isinstance(part, str) else repr(float(part)) for part in value)


def _given_text(case: Case, key: Key) -> str:
    return text_from(library().case_get, case._handle, f"{key.group}.{key.name}".encode(), guess=256)


def template(kind: str = "complete") -> Case:
    """A case to begin with: "complete" has every key; "dry", "film", "engine", "compressor", "slap", "elastic", "wear" are short
    cases that run."""
    text = text_from(library().template, kind.encode(), guess=60000)
    if not text:
        raise ValueError(f"no template {kind}")
    return Case.from_text(text, kind)


def read(path: str | Path, *, sets: Mapping[str, Value] = {}) -> Case:
    """Read a case file; `sets` are values that replace those of the file. Tables that it names are read in its folder and below.
    Raises CaseError where it cannot be read, also for bytes that are not UTF-8."""
    path = Path(path)
    data = path.read_bytes()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise CaseError(f"{path}: encoded in UTF-16: save it in UTF-8")
    case = Case.from_text(data.decode(errors="surrogateescape"), path.stem, path.parent)
    for name, value in sets.items():
        case[name] = value
    return case
