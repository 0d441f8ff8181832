"""Reads the table of figures, figures.csv beside this module: number, quantities, runs, run of the ideal joint, window, title.

A window such as "10-12" names the revolutions that are drawn; the run is then made long enough. Without a window the case's own run
is drawn."""

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

TABLE = Path(__file__).with_name("figures.csv")


@dataclass(frozen=True)
class Figure:
    """A figure: every quantity (a key of quantities.QUANTITIES) of every run, with the run of the ideal joint in the same axes."""

    number: str
    quantities: tuple[str, ...]
    runs: tuple[str, ...]
    ideal: str
    title: str
    window: tuple[int, int] | None = None  # revolutions of the crank
    has_windows: bool = False  # whether the table names a window for it, even if another part is drawn

    @property
    def stem(self) -> str:
        """Name of its files, chosen so that figures are sorted by number."""
        chapter, count = self.number.split(".")
        return f"figure_{chapter}.{int(count):02d}{'_start' if self.has_windows and not self.window else ''}"

    @property
    def at_start(self) -> "Figure":
        """The same figure of the case's own run, from its beginning."""
        return replace(self, window=None)

    @property
    def shows_many_cycles(self) -> bool:
        return "section" in self.quantities

    @property
    def needs(self) -> tuple[str, ...]:
        return self.runs + ((self.ideal,) if self.ideal else ())


def read_figures(path: Path = TABLE) -> dict[str, Figure]:
    """The figures of the table by number, in its order. Raises ValueError for a wrong or repeated number and for a wrong window."""
    figures: dict[str, Figure] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            number = row["number"]
            if not re.fullmatch(r"[0-9A-Z]\.[1-9][0-9]*", number):
                raise ValueError(f"{path}: {number!r} is not a figure number")
            if number in figures:
                raise ValueError(f"{path}: figure {number} appears twice")
            window = read_window(row["window"])
            figures[number] = Figure(
                number,
                tuple(row["quantities"].split()),
                tuple(row["runs"].split()),
                row["ideal"],
                row["title"],
                window,
                window is not None,
            )
    return figures


def read_window(text: str) -> tuple[int, int] | None:
    """The revolutions of a window such as "10-12"; None for an empty text. Raises ValueError if the text is not a window."""
    if not text:
        return None
    match = re.fullmatch(r"([0-9]+)-([0-9]+)", text)
    if not match or int(match[1]) >= int(match[2]):
        raise ValueError(f"{text!r} is not a window of revolutions")
    return int(match[1]), int(match[2])
