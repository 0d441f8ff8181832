#!/usr/bin/env python3
"""Measures what the models of a piston in its bore cost and give: dry corners, the film of the skirt on coarser and finer grids and with both
conditions of rupture, rings in closed form and with films. Writes data/measured/piston.md.

    scripts/bench/measure_piston.py [--program PROGRAM]
"""
from __future__ import annotations

import tempfile

from measured import program_of, table, timed_run, write_table

CASE = "joints/piston"
DRY = ("guide.kind=clearance", "guide.stiffness=5e7", "guide.restitution=0.4", "guide.coefficient=0.05", "guide.lubrication=none", "guide.asperities=none")
CLOSED = tuple(f"ring_{number}.model=closed_form" for number in range(1, 5))
NONE = (*(f"ring_{number}=none" for number in range(1, 5)), "rings.lubrication=none", "rings.asperities=none")


def grid(around: int, along: int, *more: str) -> tuple[str, ...]:
    return f"guide.lubrication.around={around}", f"guide.lubrication.along={along}", *more


RUNGS = (("ideal guide, rings in closed form", ("guide=none", "guide.lubrication=none", "guide.asperities=none", *CLOSED)),
         ("ideal guide, rings with films", ("guide=none", "guide.lubrication=none", "guide.asperities=none")),
         ("dry corners, rings in closed form", (*DRY, *CLOSED)), ("film 4 x 16, Gumbel, rings in closed form", grid(4, 16, "guide.lubrication.cavitation=gumbel", *CLOSED)),
         ("film 4 x 16, rings in closed form", grid(4, 16, *CLOSED)), ("film 6 x 24, no rings", grid(6, 24, *NONE)),
         *((f"the same on elastic faces of {stiffness} N/m", grid(6, 24, f"guide.stiffness={stiffness}", *NONE)) for stiffness in ("2e8", "5e7", "2e7")), ("film 6 x 24, rings in closed form", grid(6, 24, *CLOSED)),
         ("film 6 x 24, rings with films", grid(6, 24)), ("film 12 x 48, rings with films", grid(12, 48)))
TEXT = """Engine of 488 cm3 at 3000 rpm (`cases/joints/piston.nml`), four turns at a relative tolerance of 1e-6, the last cycle of two. The time is the least processor time of three
runs with all files. Dry corners have 5e7 N/m, a restitution of 0.4 and a friction of 0.05, all assumed; the force of a dry corner is that of its hardest impact.
"""
COLUMNS = (("cycle_skirt_fmep", 1e-3, ".2f"), ("cycle_ring_fmep", 1e-3, ".2f"), ("cycle_min_skirt_film_thickness", 1e6, ".2f"), ("cycle_min_ring_1_film_thickness", 1e6, ".3f"))


def main() -> None:
    program = program_of(__doc__)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, settings in RUNGS:
            seconds, summary = timed_run(program, CASE, folder, settings)
            force = max((float(summary[key]) for key in summary if key in ("cycle_max_skirt_force", *(f"guide_{k}_max_force" for k in range(1, 5)))), default=0.0)
            speed = float(summary.get("cycle_max_slap_speed") or summary.get("cycle_slap_speed") or 0)
            rows.append([name, summary["rhs_evaluations"], f"{seconds:.2f}", f"{force:.0f}" if force else "-", f"{1e3*speed:.0f}" if speed else "-",
                         *(f"{factor*float(summary[key]):{form}}" if key in summary else "-" for key, factor, form in COLUMNS)])
    head = ("model", "evaluations", "time [s]", "largest side force [N]", "fastest end of the skirt [mm/s]", "FMEP of the skirt [kPa]", "of the rings [kPa]",
            "least film of the skirt [µm]", "of the top ring [µm]")
    write_table("piston", "What the models of a piston in its bore cost and give", "scripts/bench/measure_piston.py", TEXT + "\n" + table(head, rows))


if __name__ == "__main__":
    main()
