"""Many runs of a case with varied values, in threads."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from itertools import product
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

from .case import Case, CaseError, Value, _find

if TYPE_CHECKING:
    import pandas as pd

    from .run import Run

QUANTITIES = (
    "simulated_time", "crank_revolutions", "mean_crank_speed", "max_pin_force", "contacts", "contact_time_fraction",
    "min_film_thickness", "max_penetration", "friction_work", "max_film_pressure", "max_energy_residual_relative",
)  # fmt: skip


def sweep(
    case: Case,
    design: Mapping[str, Sequence[Value]] | pd.DataFrame | Any,
    *,
    names: Sequence[str] | None = None,
    keep: Iterable[str] | None = None,
    reduce: Callable[[Run], Mapping[str, Any]] | None = None,
    workers: int | str | None = None,
    progress: Callable[[float], None] | bool | None = None,
    store: str | Path | None = None,
    errors: str = "keep",
) -> pd.DataFrame:
    """Run a case for each row of a design, and return a row for each run, in the order of the design.

    design: a dict of sequences (all combinations), a DataFrame, or an array with `names` for its columns; keep: quantities of the
    summary (default: those of a study that the run has); reduce: a function of the run, whose results become columns: only with it
    rows are made; workers: number of threads, or "processes" if `reduce` is Python that takes long; store: a parquet file that keeps
    the rows, from which an interrupted sweep goes on; progress: True, or a function of the share done; errors: "raise", or "keep"
    (the column status then says what was wrong). A KeyboardInterrupt has the rows so far in `table`.

    >>> found = sweep(gudgeon.template("dry"), {"joint.clearance": ["20 um", "40 um"]}, keep=["max_pin_force"])
    >>> found.columns.tolist(), len(found)
    (['joint.clearance', 'status', 'max_pin_force'], 2)
    """
    import pandas as pd

    from .run import _bar

    table = _table(design, names)
    for name in table.columns:
        _find(name)
    base = case.copy()
    if reduce is None:
        base["output.columns"] = "none"
    wanted = list(keep) if keep is not None else None
    done: dict[int, dict[str, Any]] = {}
    if store is not None and Path(store).is_file():
        done = _stored(Path(store), table)
    rows = [row for row in range(len(table)) if row not in done]
    count = workers if isinstance(workers, int) else os.cpu_count() or 1
    chunk = max(1, min(50, math.ceil(len(rows) / (4 * count))))
    chunks = [rows[i : i + chunk] for i in range(0, len(rows), chunk)]
    columns = list(table.columns)
    values = [list(row) for row in table.itertuples(index=False, name=None)]

    def result() -> pd.DataFrame:
        return pd.DataFrame([{**dict(zip(columns, values[row])), **done[row]} for row in sorted(done)], index=sorted(done))

    in_threads = workers != "processes"
    tell = _bar if progress is True else progress or None
    pool = (ThreadPoolExecutor if in_threads else ProcessPoolExecutor)(count)
    stopped = Event()
    shared = (done, stopped) if in_threads else None
    waiting: dict[Future[dict[int, dict[str, Any]]], list[int]] = {}
    try:
        for part in chunks:
            waiting[pool.submit(_chunk, base, columns, part, [values[row] for row in part], wanted, reduce, shared)] = part
        while waiting:
            finished, _ = wait(waiting, timeout=0.1, return_when=FIRST_COMPLETED)
            for future in finished:
                part = waiting.pop(future)
                done.update(future.result())
                failed = next((row for row in part if done[row]["status"] != "done"), None)
                if errors == "raise" and failed is not None:
                    raise RuntimeError(f"row {failed}: {done[failed]['status']}")
            if finished and store is not None:
                result().to_parquet(store)
            if finished and tell is not None:
                tell(len(done) / len(table))
    except BaseException as error:
        stopped.set()
        error.table = result()  # type: ignore[attr-defined]
        raise
    finally:
        for future in waiting:
            future.cancel()
        pool.shutdown(wait=False, cancel_futures=True)
    return result()


def counted(reasons: Iterable[str]) -> dict[str, int]:
    """How often runs failed for each reason, in which `...` stands for the value of a key."""
    import pandas as pd

    return pd.Series(list(reasons), dtype=str).str.replace(r"= [-+.\deE]+:", "= ...:", regex=True).value_counts().to_dict()


def _table(design: Any, names: Sequence[str] | None) -> pd.DataFrame:
    import pandas as pd

    if isinstance(design, pd.DataFrame):
        return design.reset_index(drop=True)
    if isinstance(design, Mapping):
        return pd.DataFrame(list(product(*design.values())), columns=list(design))
    if names is None and getattr(getattr(design, "dtype", None), "names", None):
        return pd.DataFrame.from_records(design)
    if names is None:
        raise TypeError("an array needs the names of its columns")
    return pd.DataFrame(design, columns=list(names))


def _stored(path: Path, table: pd.DataFrame) -> dict[int, dict[str, Any]]:
    """The rows that a stored sweep has. Raises ValueError if they are those of another design."""
    import pandas as pd

    found = pd.read_parquet(path)
    given = found[found.columns.intersection(table.columns)]
    if not found.index.isin(table.index).all() or not given.equals(table.loc[found.index]):
        raise ValueError(f"{path} has the results of another design")
    rest = [name for name in found.columns if name not in table.columns]
    return {int(row): dict(zip(rest, values)) for row, values in zip(found.index, found[rest].itertuples(index=False, name=None))}


def _chunk(
    base: Case, columns: Sequence[str], rows: Sequence[int], values: Sequence[Sequence[Value]], keep: Sequence[str] | None,
    reduce: Callable[[Run], Mapping[str, Any]] | None, shared: tuple[dict[int, dict[str, Any]], Event] | None,
) -> dict[int, dict[str, Any]]:  # fmt: skip
    """The results of several rows, of which the later ones cost less: only their numbers change. `shared` are the results of all rows
    in this process, and whether it is to stop."""
    from .run import _Owner, advance, from_handle, summary_of

    found, stopped = shared or ({}, Event())

    def look(share: float) -> None:
        if stopped.is_set():
            raise InterruptedError

    case = base.copy()
    names = {"status", *(QUANTITIES if keep is None else keep)}
    for row, its in zip(rows, values):
        try:
            for name, value in zip(columns, its):
                case[name] = value
            number = case._begin(False, None)
        except CaseError as error:
            found[row] = {"status": str(error).splitlines()[0]}
            continue
        owner = _Owner(number)
        advance(number, 1e300, look, None)
        summary = summary_of(number, names)
        result: dict[str, Any] = {"status": summary["status"]}
        if keep is None:
            result.update({name: summary[name] for name in QUANTITIES if name in summary})
        else:
            result.update({name: summary.get(name, math.nan) for name in keep})
        if reduce is not None:
            try:
                result.update(reduce(from_handle(case.copy(), owner)))
            except Exception as error:
                raise RuntimeError(f"reduce, row {row}: {error!r}") from error
        found[row] = result
    return found
