"""The case on the page of a run: the keys that differ from their defaults, in the units that an engineer writes."""

from collections.abc import Mapping

from gudgeon._keys import keys
from gudgeon._library import LibraryMissing
from gudgeon.language import Language
from gudgeon.report.explorer import shown_unit
from gudgeon.results import Run, parse_case


def shown(value: object, unit: str, language: Language) -> str:
    """A value of a case, in the unit that an engineer writes; texts and words are those of the case file in every language."""
    if isinstance(value, bool):
        return language.say("yes" if value else "no")
    numbers = value if isinstance(value, list) else [value]
    if not all(isinstance(one, float) for one in numbers):
        return str(value)
    said, factor, offset = shown_unit(unit, max(map(abs, numbers), default=0.0))
    between = ", " if language.is_english else "; "   # of numbers with decimal commas
    text = f"{between.join(f'{one * factor + offset:.6g}' for one in numbers)} {said}".replace("-", "−").replace(" °", "°" if said == "°" else " °").strip()
    return language.number(text)


def defaults() -> dict[str, object] | None:
    """The defaults of all keys of cases, by "group.key"; None where the library of the program is not there, which knows them."""
    try:
        known = {name: key for name, key in keys.items() if not key.required}
    except LibraryMissing:
        return None
    words = {name: f"'{key.default}'" if key.kind in ("word", "text") else key.default for name, key in known.items()}
    return {name: parse_case(f"&a\nx = {text}")["a"]["x"] for name, text in words.items()}


def case_rows(run: Run, known: Mapping[str, object] | None, language: Language | None = None) -> list[tuple[str, list[tuple[str, str]]]]:
    """The groups of a case with those keys that differ from their `known` defaults, or without these from nothing, no and 0."""
    language = language or Language()

    def is_default(name: str, value: object) -> bool:
        parts = value if isinstance(value, list) else [value]
        if known is None:
            return not any(parts)
        return name in known and all(part == known[name] for part in parts)

    groups = ((group, [(key, shown(value, run.case_units.get(f"{group}.{key}", ""), language)) for key, value in given.items() if not is_default(f"{group}.{key}", value)])
              for group, given in run.case.items())
    return [(group, rows) for group, rows in groups if rows]
