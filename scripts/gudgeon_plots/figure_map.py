"""The table of figures, scripts/figures.csv: number, quantities, runs, ideal joint's run, window, title.

A window, "10-12", names the revolutions that are drawn of a run that is made so long; without one the case's own run is
drawn."""

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

TABLE = Path(__file__).resolve().parents[1] / "figures.csv"


@dataclass(frozen=True)
class Figure:
    """A figure: every quantity (a key of quantities.QUANTITIES) of every run, the ideal joint's run overlaid."""

    number: str
    quantities: tuple[str, ...]
    runs: tuple[str, ...]
    ideal: str
    title: str
    window: tuple[int, int] | None = None  # revolutions of the crank
    has_windows: bool = False  # whether the table gives it a window, shown or not

    @property
    def stem(self) -> str:
        """Name of its files: figures sort by number."""
        chapter, count = self.number.split(".")
        return f"figure_{chapter}.{int(count):02d}{'_start' if self.has_windows and not self.window else ''}"

    @property
    def at_start(self) -> "Figure":
        """The same figure of the case's own run, from its start on."""
        return replace(self, window=None)

    @property
    def shows_many_cycles(self) -> bool:
        return "section" in self.quantities

    @property
    def needs(self) -> tuple[str, ...]:
        return self.runs + ((self.ideal,) if self.ideal else ())


def read_figures(path: Path = TABLE) -> dict[str, Figure]:
    """The table by number, in its order. Raises ValueError on a wrong or repeated number and on a wrong window."""
    figures: dict[str, Figure] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            number = row["number"]
            if not re.fullmatch(r"[0-9A-Z]\.[1-9][0-9]*", number):
                raise ValueError(f"{path}: {number!r} is no figure number")
            if number in figures:
                raise ValueError(f"{path}: figure {number} is there twice")
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
    """The revolutions that "10-12" names, none of an empty text. Raises ValueError if they are none."""
    if not text:
        return None
    match = re.fullmatch(r"([0-9]+)-([0-9]+)", text)
    if not match or int(match[1]) >= int(match[2]):
        raise ValueError(f"{text!r} is no window of revolutions")
    return int(match[1]), int(match[2])
