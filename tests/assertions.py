"""Named assertions of the tests in Python, counted in the same way as in tests/checks.f90.

The numbers in a name are ignored: an assertion that is made for many files, kills or rows counts once, and passes if it holds each
time.
"""
from __future__ import annotations

import collections
import re
from collections.abc import Callable

MOST_PRINTED = 5   # failures of one assertion that are printed
NUMBER = re.compile(r"(?<![A-Za-z_0-9])[-+.]*\d[\d.+\-eEdD]*")


def without_figures(name: str) -> str:
    """The name with every number replaced by '#'; digits inside a word, as in dry_0100um, are kept."""
    return NUMBER.sub("#", name)


class Assertions:
    """The assertions of one test run. Only failures are printed."""

    def __init__(self) -> None:
        self.turns: collections.Counter = collections.Counter()
        self.failures: collections.Counter = collections.Counter()

    def check(self, held: object, name: str, found: str = "") -> None:
        """Make the assertion `name` once; `found` describes what was found instead, and is not part of the name."""
        key = without_figures(name)
        self.turns[key] += 1
        if held:
            return
        self.failures[key] += 1
        if self.failures[key] <= MOST_PRINTED:
            print(f"FAILED: {name}" + (f": {found}" if found else ""), flush=True)

    def refuses(self, kind: type | tuple[type, ...], words: str, action: Callable[[], object]) -> None:
        """Check that an action raises an error of this kind whose text has these words."""
        try:
            action()
        except kind as error:
            self.check(words in str(error), f"{words!r} is in {str(error)!r}")
        else:
            self.check(False, f"{kind}: {words}")

    @property
    def failed(self) -> int:
        return sum(number > 0 for number in self.failures.values())

    @property
    def passed(self) -> int:
        return len(self.turns) - self.failed

    def report(self) -> int:
        """Print the last line. Returns the exit status, 1 if an assertion failed or none was made."""
        for name, number in self.failures.items():
            if number > MOST_PRINTED:
                print(f"FAILED: {name}: {number} of {self.turns[name]} turns")
        print(f"{self.passed} passed, {self.failed} failed")
        return 0 if self.passed and not self.failed else 1
