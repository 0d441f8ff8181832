#!/usr/bin/env python3
"""Writes data/measured/rungs.md: for each kind of question, what each model costs and changes, from the results of gudgeon-plot models that
data/measured/models_*.csv keeps.

    scripts/bench/tell_rungs.py
"""
from __future__ import annotations

import csv

from measured import FOLDER, write_table

#: Question: the cases, the models that it compares, and the quantities it asks for.
QUESTIONS = {
    "Bearing": (("sim_I", "sim_III", "compressor", "motor"), ("ideal piston pin", "quasi-static piston pin", "film variant half_film", "film finite_bearing",
                                       "clearance at the crank pin too", "elastic rod", "no film"), ("peak_force", "min_film", "loss")),
    "Impact": (("both_pins", "dry_friction"), ("no friction", "contact exact", "contact hertz", "contact geometry johnson", "contact geometry conformal",
                                               "friction coulomb", "friction lugre", "ideal crank pin", "clearance at the crank pin too", "elastic rod",
                                               "no elasticity of the rod"), ("peak_force", "contact_share", "loss")),
    "Wear": (("flores",), ("no friction", "contact exact", "contact geometry conformal", "contact geometry winkler", "friction coulomb", "elastic rod",
                           "clearance at the crank pin too"), ("peak_force", "contact_share", "loss")),
    "Slap": (("piston_slap",), ("no friction", "ideal piston pin", "ideal guide", "contact geometry conformal", "elastic rod",
                                "clearance at the crank pin too"), ("peak_force", "contact_share", "loss")),
    "Control": (("motor",), ("ideal twin: no clearance, rigid members", "ideal piston pin", "film finite_bearing", "friction of the guide",
                             "elastic rod", "elastic crankshaft"), ("peak_force", "loss", "mean_speed")),
}
NAMES = {"peak_force": "peak force", "contact_share": "contact share", "min_film": "minimum film", "loss": "loss", "mean_speed": "mean speed"}


def per_cent(part: float) -> str:
    return f"{100 * part:+.0f} %" if abs(part) >= 0.1 else f"{100 * part:+.2g} %"


def section(question: str, cases: tuple[str, ...], rungs: tuple[str, ...], quantities: tuple[str, ...]) -> str:
    lines = [f"## {question}\n", f"| case | model | evaluations | time | {' | '.join(NAMES[name] for name in quantities)} |", "|---" * (4 + len(quantities)) + "|"]
    for case in cases:
        path = FOLDER / f"models_{case}.csv"
        if not path.exists():
            continue
        with path.open(encoding="utf-8", newline="") as file:
            rows = {row["scene"]: row for row in csv.DictReader(file)}
        given = rows["the case as it is"]
        for rung in ("the case as it is", *(rung for rung in rungs if rung in rows and rows[rung]["evaluations"])):
            row = rows[rung]
            costs = [float(row[name]) / float(given[name]) for name in ("evaluations", "processor_time[s]")]
            changes = [per_cent(float(value)) if (value := row[f"{name}_change"]) else "-" for name in quantities]
            lines.append(f"| [`{case}`](models_{case}.md) | {rung} | {costs[0]:.2g} | {costs[1]:.2g} | {' | '.join(changes)} |")
    return "\n".join(lines)


def main() -> None:
    text = "\n\n".join([
        "The cost is the number of evaluations of the right-hand side, and the processor time, of the whole run, both over those of the case; the changes are "
        "those of the whole run against the case (of the minimum film over the clearance, of the contact share in parts of the time). Each case has a page "
        "with all its models, and the certificate of each run: a change smaller than its uncertainty there is none.",
        *(section(question, *asked) for question, asked in QUESTIONS.items())])
    write_table("rungs", "Effect and cost of each model", "scripts/bench/tell_rungs.py", text)


if __name__ == "__main__":
    main()
