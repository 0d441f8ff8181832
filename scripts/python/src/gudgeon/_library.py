"""The shared library, loaded when it is first needed: its functions with their types, and texts from it."""

from __future__ import annotations

import ctypes as c
import os
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple


class Column(NamedTuple):
    """A column of a run."""

    name: str
    unit: str
    meaning: str


class State(NamedTuple):
    """A number of a state; of several with one name each has its own."""

    name: str
    value: float
    unit: str
    meaning: str
    kind: int  # 0: number, 1: whole number, 2: what the run has counted


_handle, _text, _size, _int = c.c_void_p, c.c_char_p, c.c_size_t, c.c_int


class Key(c.Structure):
    """`struct gudgeon_key`: a key of case files."""

    _fields_ = [(name, _int) for name in ("kind", "count", "required", "is_path")] + [
        (name, c.c_char * size)
        for name, size in (
            [(name, 32) for name in ("group", "name")]
            + [("unit", 16)]
            + [(name, 32) for name in ("range", "usual", "default", "example", "choice")]
            + [("words", 512), ("laws", 512), ("meaning", 256)]
        )
    ]


class Group(c.Structure):
    """`struct gudgeon_group`: a group of case files."""

    _fields_ = [("is_model", _int), ("name", c.c_char * 32), ("place", c.c_char * 32), ("meaning", c.c_char * 256)]


_naming = [_text, _size]
_FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "case_new": (_handle, [_text, _size, _text, _text]),
    "case_copy": (_handle, [_handle]),
    "case_free": (None, [_handle]),
    "case_set": (_int, [_handle, _text, _text]),
    "case_set_number": (_int, [_handle, _int, _int, c.c_double]),
    "case_accuracy": (_int, [_handle, _text]),
    "case_check": (_int, [_handle]),
    "case_get": (_size, [_handle, _text, _text, _size]),
    "case_given": (_int, [_handle, _int]),
    "case_text": (_size, [_handle, _text, _size]),
    "case_notes": (_size, [_handle, _text, _size]),
    "case_cache": (_int, [_handle, _text]),
    "case_columns": (_int, [_handle]),
    "case_column": (_int, [_handle, _int, *_naming * 3]),
    "case_start": (_int, [_handle, _handle]),
    "states": (_int, [_handle]),
    "state": (_int, [_handle, _int, c.POINTER(c.c_double), *_naming * 3, c.POINTER(_int)]),
    "state_set": (_int, [_handle, _int, c.c_double]),
    "run_new": (_handle, [_handle, _int, c.c_double, _int]),
    "run_advance": (_int, [_handle, c.c_double, c.c_int64]),
    "run_finish": (_int, [_handle]),
    "run_certify": (_int, [_handle]),
    "run_save": (_int, [_handle, _text]),
    "run_free": (None, [_handle]),
    "run_copy": (_handle, [_handle]),
    "run_assign": (_int, [_handle, _handle]),
    "run_time": (c.c_double, [_handle]),
    "run_end": (c.c_double, [_handle]),
    "inputs": (_int, [_handle]),
    "input": (_int, [_handle, _int, c.POINTER(c.c_double), *_naming * 2]),
    "input_set": (_int, [_handle, _int, c.c_double]),
    "columns": (_int, [_handle]),
    "column": (_int, [_handle, _int, *_naming * 3]),
    "rows": (c.POINTER(c.c_double), [_handle, c.POINTER(c.c_int64)]),
    "values": (_int, [_handle, c.POINTER(c.c_double)]),
    "events": (c.c_int64, [_handle]),
    "event": (_int, [_handle, c.c_int64, c.POINTER(c.c_double), c.POINTER(_int), *_naming]),
    "summary": (_size, [_handle, _text, _size]),
    "keys": (_int, []),
    "key": (_int, [_int, _int, c.POINTER(Key)]),
    "groups": (_int, [_int, c.POINTER(Group)]),
    "template": (_size, [_text, _text, _size]),
    "schema": (_size, [_text, _size]),
    "message": (_size, [_handle, _text, _size]),
    "version": (_size, [_text, _size]),
}


_LONG = ("run_new", "run_advance", "run_finish", "run_certify", "run_save")


def path() -> Path:
    """The library of the package, of the checkout in which the package is, or of the prefix of Python; the environment variable
    GUDGEON_LIBRARY names another."""
    own = Path(__file__).with_name("libgudgeon.so")
    built = Path(__file__).resolve().parents[4] / "build" / "library" / own.name  # by build_library.py
    found = (place for place in (built, own, Path(sys.prefix) / "lib" / own.name) if place.exists())
    return Path(os.environ.get("GUDGEON_LIBRARY") or next(found, own))


class LibraryMissing(ImportError):
    """The library with the program is not there, or not for this machine. Results can be read without it."""


@cache
def library() -> Any:
    """The functions of the library. Those that may take long leave other threads of Python free."""
    try:
        free, held = c.CDLL(str(path())), c.PyDLL(str(path()))
    except OSError as error:
        raise LibraryMissing(f"{error}; '{sys.executable} -m pip install ./scripts/python' in the checkout compiles it, in some minutes") from None

    class Functions:
        """Functions by their names without gudgeon_."""

    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(free if name in _LONG else held, f"gudgeon_{name}")
        function.restype, function.argtypes = result, arguments
        setattr(Functions, name, staticmethod(function))
    return Functions


def text_from(function: Callable[..., int], *arguments: Any, guess: int = 4096) -> str:
    """The text that a function copies into a buffer."""
    buffer = c.create_string_buffer(guess)
    length = function(*arguments, buffer, guess)
    if length >= guess:
        buffer = c.create_string_buffer(length + 1)
        function(*arguments, buffer, length + 1)
    return buffer.value.decode()


def message(handle: int) -> str:
    """The last message of a handle."""
    return text_from(library().message, handle)


def described_columns(count: int, describe: Callable[..., int], handle: int) -> list[Column]:
    """The columns that a function describes by their numbers."""
    name, unit, meaning = (c.create_string_buffer(200) for _ in range(3))
    found = []
    for i in range(count):
        describe(handle, i, name, 200, unit, 200, meaning, 200)
        found.append(Column(name.value.decode(), unit.value.decode(), meaning.value.decode()))
    return found


def states_of_case(handle: int) -> list[State]:
    """The motion with which runs of a case begin, and what its run had counted; empty: they begin as the case says."""
    value, kind = c.c_double(), c.c_int()
    name, unit, meaning = (c.create_string_buffer(200) for _ in range(3))
    found = []
    for i in range(library().states(handle)):
        library().state(handle, i, value, name, 200, unit, 200, meaning, 200, kind)
        found.append(State(name.value.decode(), value.value, unit.value.decode(), meaning.value.decode(), kind.value))
    return found


def columns_of_run(number: int) -> list[Column]:
    return described_columns(library().columns(number), library().column, number)


def meant(word: str, words: Sequence[str]) -> str:
    """What is said after a word that is not there."""
    from difflib import get_close_matches

    near = get_close_matches(word, words, 1) or [name for name in words if name.endswith((f"_{word}", f".{word}"))]
    return f"; did you mean {near[0]}?" if near else ""
