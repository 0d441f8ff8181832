#!/usr/bin/env python3
"""Measures how closely the program agrees with the reference curves in data/, and writes data/measured/references.md.

    scripts/bench/measure_references.py [--program FILE]

data/references.csv lists the references: the case of each, the time up to which it is valid, and how closely its own two runs
agree. Each case is run up to this time with a relative tolerance of 1e-11 and the rows of its reference. Exit status 1 if a run
fails or has other rows or events.
"""
from __future__ import annotations

import csv
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from measured import TOP, program_of, run, table, write_table

STATES = ("crank_angle", "rod_angle", "piston_position", "crank_speed", "rod_speed", "piston_velocity")
OTHER_NAMES = {"normal_force[N]": "asperity_force[N]"}   # another name in the reference of mixed_sim_I
NOTE = """Each case of `data/references.csv`, with a relative tolerance of 1e-11, against its reference: the largest difference of crank angle, rod
angle, piston position and their rates ("states") and of all other columns, over the largest value of the column, and the largest difference of the
instants of contacts. Beside each difference stands that of two runs of the reference with different tolerances: the uncertainty of the
reference. "Compared" is the number of events that are compared; the reference has more where its two runs differ before its end."""


@dataclass
class Reference:
    """A line of data/references.csv."""

    name: str
    case: Path
    events: str
    own: tuple[str, str, str]   # differences of its two runs: states, other columns, times of events


def number(text: str, digits: str = ".1e") -> str:
    return format(float(text), digits) if text else ""


def references() -> list[Reference]:
    with (TOP / "data/references.csv").open(newline="") as file:
        return [Reference(row["reference"], TOP / row["case"], f"{row['events_of_both']} of {row['events']}",
                          (number(row["state_difference"]), number(row["other_difference"]), number(row["time_difference[s]"])))
                for row in csv.DictReader(file)]


def columns(path: Path) -> dict[str, list[float]]:
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    return {name: [float(row[i] or "nan") for row in rows] for i, name in enumerate(header)}


def events(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def compare(program: Path, reference: Reference) -> tuple[float, float, float, int]:
    """Largest relative differences of the states and of the other columns, and of the event times [s]; number of events
    compared."""
    theirs = columns(TOP / f"data/{reference.name}.csv")
    times = theirs["time[s]"]
    with tempfile.TemporaryDirectory() as folder:
        settings = ["integrator.relative_tolerance=1e-11", "integrator.revolutions=0", f"integrator.end_time={times[-1]!r}",
                    f"output.interval={times[-1] / (len(times) - 1)!r}", "output.digits=17", "output.ideal_twin=F"]
        run(program, reference.case, folder, settings)
        ours = columns(Path(folder) / f"{reference.case.stem}.csv")
        our_events = events(Path(folder) / f"{reference.case.stem}.events.csv")
    if len(ours["time[s]"]) != len(times):
        raise RuntimeError(f"{reference.name}: {len(ours['time[s]'])} rows, {len(times)} in the reference")
    worst = {True: 0.0, False: 0.0}
    for name, values in theirs.items():
        is_asperity = reference.name.endswith("mixed_sim_I")
        here = ours[OTHER_NAMES.get(name, name) if is_asperity else name]
        size = max(map(abs, values))
        off = max(abs(a - b) for a, b in zip(here, values))
        is_state = name.partition("[")[0] in (*STATES, "time")
        worst[is_state] = max(worst[is_state], off / size if size > 0 else off)
    their_events = [row for row in events(TOP / f"data/{reference.name}.events.csv") if float(row["time[s]"]) <= times[-1]]
    if [row["event"] for row in our_events] != [row["event"] for row in their_events]:
        raise RuntimeError(f"{reference.name}: events {len(our_events)}, other than the {len(their_events)} of the reference")
    late = [abs(float(a["time[s]"]) - float(b["time[s]"])) for a, b in zip(our_events, their_events)]
    return worst[True], worst[False], max(late, default=0.0), len(late)


def main() -> int:
    program = program_of(__doc__)
    rows = []
    failed = 0
    for one in references():
        try:
            states, others, late, count = compare(program, one)
        except RuntimeError as problem:
            print(f"measure_references: {problem}", file=sys.stderr)
            failed += 1
            continue
        rows.append((f"`{one.name}`", f"{states:.1e}", one.own[0], f"{others:.1e}", one.own[1], f"{count}", one.events,
                     f"{late:.1e}" if count else "", one.own[2]))
        print(*rows[-1], flush=True)
    if failed:
        return 1
    text = NOTE + "\n\n" + table(("reference", "states", "of its runs", "other columns", "of its runs", "compared", "events of both its runs",
                                   "times [s]", "of its runs [s]"), rows)
    print(write_table("references", "Agreement with the reference curves", "scripts/bench/measure_references.py", text))
    return 0


if __name__ == "__main__":
    sys.exit(main())
