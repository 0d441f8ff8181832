"""Runs from their files."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ._library import Column, LibraryMissing
from .case import Case
from .run import EVENT_COLUMNS, Run


def load(path: str | Path, folder: str | Path | None = None) -> Run:
    """A run from its files: `load("results/sim_I")`, or a name that is looked for in `results/`. Its case may read the tables that it
    names in the folder of the files, or in `folder`; "/": anywhere. Without the library of the program `case` is None. Raises
    ValueError with the name of a file that is damaged."""
    import numpy as np
    import pandas as pd

    base = Path(str(path).removesuffix(".csv"))
    if not Path(f"{base}.csv").is_file():
        base = Path("results") / base
    with _reading(f"{base}.csv") as path, open(path) as file:
        headings = [name.partition("[") for name in file.readline().strip().split(",")]
        columns = [Column(name, unit.rstrip("]"), "") for name, _, unit in headings]
        if not columns[0].name:
            raise ValueError("no columns")
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
        if rows.size and rows.shape[1] != len(columns):
            raise ValueError(f"{rows.shape[1]} columns instead of {len(columns)}")
        rows = rows.reshape(-1, len(columns))
    rows.flags.writeable = False
    with _reading(f"{base}.summary.csv") as path:
        table = pd.read_csv(path, dtype=str, keep_default_na=False)[["quantity", "value", "unit"]]
    events = None
    if Path(f"{base}.events.csv").is_file():
        with _reading(f"{base}.events.csv") as path:
            events = _events_of_file(path)
    case, resolved = None, Path(f"{base}.resolved.nml")
    if resolved.is_file():
        with _reading(f"{resolved}"), suppress(LibraryMissing):
            case = Case.from_text(resolved.read_text(), base.name, folder or base.parent)
    run = Run(case, columns, rows, events, table.values.tolist(), base.name)
    run._resolved = resolved.read_text() if resolved.is_file() else None
    run._files = base
    if Path(f"{base}.ideal.csv").is_file():
        run.twin = load(f"{base}.ideal.csv", folder)
    return run


@contextmanager
def _reading(path: str) -> Generator[str]:
    """What is wrong with the contents of a file becomes one error with its name."""
    try:
        yield path
    except (ValueError, LookupError) as error:
        raise ValueError(f"{path}: not a file of results, or damaged: {' '.join(str(error).split())}") from None


def _events_of_file(path: str) -> list[list[Any]]:
    import pandas as pd

    table = pd.read_csv(path)
    if len(table.columns) != len(EVENT_COLUMNS):
        raise ValueError(f"{len(table.columns)} columns instead of {len(EVENT_COLUMNS)}")
    return table.values.tolist()
