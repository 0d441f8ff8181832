"""What the program declares of case files: groups and keys with unit, limits, words, default and meaning."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import inf

from . import _library

KINDS = ("real", "integer", "switch", "word", "text")


@dataclass(frozen=True)
class Key:
    """A key of case files.

    `kind` is one of `KINDS`; `limits` is the text of the program, such as ``'> 0 and <= 1'``; `usual` are sizes in real machines;
    `laws` are those words of the key `choice` that have the key, or empty if all have it. A number of a list is a key too:
    ``keys["guide.piston_com[2]"]``, counted from 1.
    """

    group: str
    name: str
    kind: str
    count: int
    unit: str
    limits: str
    usual: str
    words: tuple[str, ...]
    default: str
    required: bool
    choice: str
    laws: tuple[str, ...]
    is_path: bool
    meaning: str
    index: int
    element: int = 0  # of a key of several numbers, counted from 0

    @property
    def bounds(self) -> tuple[float, float, bool, bool]:
        """Least and largest value, and whether each belongs to the range."""
        least, most, with_least, with_most = -inf, inf, True, True
        for sign, number in re.findall(r"(>=|<=|>|<) *([-+.0-9eE]+)", self.limits):
            if sign[0] == ">":
                least, with_least = float(number), sign == ">="
            else:
                most, with_most = float(number), sign == "<="
        return least, most, with_least, with_most

    def __str__(self) -> str:
        return self.described()

    def described(self, say: Callable[[str], str] = str) -> str:
        """What the key is, on a line; `say` translates. Words and the default are those of a case file."""
        parts = [self.unit and f"[{self.unit}]", say(self.limits), self.usual and say(f"usually {self.usual}")]
        parts += [f"{say('one of')} {', '.join(self.words)}"] if self.words else []
        parts += [say("required") if self.required else f"{say('default')} {self.default or repr('')}"]
        return f"{self.name}: {say(self.meaning)} ({'; '.join(part for part in parts if part)})"


@dataclass(frozen=True)
class GroupInfo:
    """A group of case files; that of a joint or of its laws has a place in front of its name: ``crank_pin.joint``."""

    name: str
    is_model: bool
    meaning: str
    keys: tuple[Key, ...]


@cache
def groups() -> dict[str, GroupInfo]:
    """All groups by their names, in the order of the case file."""
    library = _library.library()
    declared = (_library.Key * library.keys())()
    library.key(0, len(declared), declared)
    found = (_library.Group * library.groups(0, None))()
    library.groups(len(found), found)
    keys: dict[str, list[Key]] = {}
    for index, key in enumerate(declared):
        text = {name: getattr(key, name).decode() for name, _ in key._fields_ if name not in ("kind", "count", "required", "is_path")}
        keys.setdefault(text["group"], []).append(
            Key(
                text["group"], text["name"], KINDS[key.kind - 1], key.count if key.kind == 1 else 1, text["unit"], text["range"],
                text["usual"], _words(text["words"]), text["default"], bool(key.required), text["choice"], _words(text["laws"]),
                bool(key.is_path), text["meaning"], index,
            )
        )  # fmt: skip
    return {
        (name := group.name.decode()): GroupInfo(name, bool(group.is_model), group.meaning.decode(), tuple(keys.get(name, ())))
        for group in found
    }


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(", ")) if text else ()


class Keys(Mapping[str, Key]):
    """All keys by their full names, such as ``joint.clearance`` or ``crank_pin.joint.clearance``."""

    @staticmethod
    @cache
    def _all() -> dict[str, Key]:
        return {f"{key.group}.{key.name}": key for group in groups().values() for key in group.keys}

    def __getitem__(self, name: str) -> Key:
        found = re.fullmatch(r"(.+)\[([1-9]\d*)\]", name)
        if found is None or found[1] not in self._all():
            return self._all()[name]
        key = self._all()[found[1]]
        if key.count == 1 or int(found[2]) > key.count:
            raise KeyError(name)
        return replace(key, name=f"{key.name}[{found[2]}]", count=1, element=int(found[2]) - 1)

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __repr__(self) -> str:
        return f"<{len(self)} keys of case files>"


keys = Keys()
