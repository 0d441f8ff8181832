#!/usr/bin/env python3
"""Writes the declarations of groups and keys for editors and type checkers, from what the library declares.

    scripts/python/make_stubs.py [PATH]      by default _groups.pyi of the package; the wheel has it
"""

import keyword
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent / "src" / "gudgeon"
HEAD = '''"""Groups and keys of cases, as the program declares them. Made by make_stubs.py."""

from collections.abc import Sequence

from .case import Group, Place

class Real:
    def __get__(self, of: object, kind: object = ..., /) -> float: ...
    def __set__(self, of: object, value: float | str | None, /) -> None: ...

class Pair:
    def __get__(self, of: object, kind: object = ..., /) -> tuple[float, ...]: ...
    def __set__(self, of: object, value: Sequence[float] | str | None, /) -> None: ...

class Whole:
    def __get__(self, of: object, kind: object = ..., /) -> int: ...
    def __set__(self, of: object, value: int | str | None, /) -> None: ...

class Switch:
    def __get__(self, of: object, kind: object = ..., /) -> bool: ...
    def __set__(self, of: object, value: bool | None, /) -> None: ...

class Text:
    def __get__(self, of: object, kind: object = ..., /) -> str: ...
    def __set__(self, of: object, value: str | None, /) -> None: ...
'''
KINDS = {"real": "Real", "integer": "Whole", "switch": "Switch", "word": "Text", "text": "Text"}


def stubs() -> str:
    """The text of the declarations."""
    sys.path.insert(0, str(PACKAGE.parent))
    from gudgeon._keys import groups
    from gudgeon.case import Case

    parts, attributes, places = [HEAD], [], {}
    for full, group in groups().items():
        place, _, name = full.rpartition(".")
        own = bool(place) and name in groups() and {key.name for key in group.keys} != {key.name for key in groups()[name].keys}
        kind = class_of(full if own else name)
        if place:
            places.setdefault(place, []).append(f"    {name}: {kind}")
        elif not hasattr(Case, name):  # `run` is a method
            attributes.append(f"    {name}: {kind}")
        if place and name in groups() and not own:
            continue
        parts.append(f'class {kind}(Group):\n    """{quoted(group.meaning)}"""')
        for key in (key for key in group.keys if not keyword.iskeyword(key.name)):  # case["initial.from"]
            parts.append(f'    {key.name}: {"Pair" if key.count > 1 else KINDS[key.kind]}\n    """{quoted(str(key))}"""')
    for place, its in places.items():
        parts.append(f"class {place.title().replace('_', '')}Place(Place):\n" + "\n".join(its))
        attributes.append(f"    {place}: {place.title().replace('_', '')}Place")
    return "\n".join([*parts, "class Groups:", *attributes, ""])


def class_of(group: str) -> str:
    """The name of the class of a group. That of a place has the place before it if its keys are others than those of the group alone."""
    return group.replace(".", "_").title().replace("_", "") + "Group"


def quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else PACKAGE / "_groups.pyi"
    path.write_text(stubs(), encoding="utf-8")
    print(path)
