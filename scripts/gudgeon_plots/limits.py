"""Numbers on the command line of a script, with their limits."""

import argparse
import math
from collections.abc import Callable


def number(least: float, *, itself: bool = True, whole: bool = False) -> Callable[[str], float]:
    """A type for argparse: a finite number of at least `least`; with itself=False larger than it; with `whole` without fraction."""
    wanted = f"must be a {'whole ' if whole else ''}number {'>=' if itself else '>'} {least:g}"

    def convert(text: str) -> float:
        try:
            value = int(text) if whole else float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or value < least or (value == least and not itself):
            raise argparse.ArgumentTypeError(f"{text}: {wanted}")
        return value

    return convert
