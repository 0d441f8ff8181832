"""The table of figures, scripts/figures.csv: number, quantities, runs, ideal joint's run, title."""

import csv
import re
from dataclasses import dataclass
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

    @property
    def stem(self) -> str:
        """Name of its files: figures sort by number."""
        chapter, count = self.number.split(".")
        return f"figure_{chapter}.{int(count):02d}"

    @property
    def needs(self) -> tuple[str, ...]:
        return self.runs + ((self.ideal,) if self.ideal else ())


def read_figures(path: Path = TABLE) -> dict[str, Figure]:
    """The table by number, in its order. Raises ValueError on a wrong or repeated number."""
    figures: dict[str, Figure] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            number = row["number"]
            if not re.fullmatch(r"[0-9A-Z]\.[1-9][0-9]*", number):
                raise ValueError(f"{path}: {number!r} is no figure number")
            if number in figures:
                raise ValueError(f"{path}: figure {number} is there twice")
            figures[number] = Figure(
                number, tuple(row["quantities"].split()), tuple(row["runs"].split()), row["ideal"], row["title"]
            )
    return figures
