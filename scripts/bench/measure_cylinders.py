#!/usr/bin/env python3
"""Counts evaluations and instructions of engines with several cylinders beside one cylinder, and writes data/measured/cylinders.md.

    scripts/bench/measure_cylinders.py [--program PATH]

Needs valgrind. Instructions are counted since they do not depend on what else the machine does.
"""
from __future__ import annotations

import re
import tempfile
from pathlib import Path

from measured import counted, program_of, table, write_table

ENGINES = {"a film of finite length": "film/sim_IV_finite", "a dry pin": "cylinders/four_dry", "ideal pins, Wiebe": "cylinders/inline_four",
           "ideal pins, a table": "cylinders/six_mwm"}
SINGLE = {"cylinders/six_mwm": ("mechanism.crank_inertia=0.01",)}   # on a rigid shaft it has an inertia
RIGID = ("crankshaft=none", "damper=none")
SHAFT = ("crankshaft.inertia=9*0.03", "crankshaft.stiffness=1.2e6", "crankshaft.damping=2.0", "crankshaft.absolute_damping=0.1")
PHASES = (0, -480, -240, -600, -120, -360)   # degrees
TURNS = (8, 24)   # revolutions of two runs, whose difference leaves out the start
NOTE = """Difference of runs of 8 and 24 revolutions at a relative tolerance of 1e-6, method auto, constant speed, without answers of the last
cycle: evaluations of the right-hand side in a revolution, instructions of one of them in the run's own integration, instructions in a
revolution with steps, events and the record of extremes. Six cylinders stand at stations 3 to 8 of nine or on a rigid shaft, one at
station 3. One cylinder on nine stations shows what the stations cost alone, six on a rigid shaft what the cylinders cost: each bounds from
below what six on nine stations can cost. Each closing, opening and combustion of a cylinder starts the method again, so more cylinders
with a gas cycle need more evaluations; a measured pressure has no such bounds.

"""


def scene(cylinders: int, stations: bool) -> list[str]:
    """Settings that give a case of one cylinder others and a shaft."""
    found = list(SHAFT) if stations else []
    for i in range(cylinders if cylinders > 1 or stations else 0):
        found.append(f"cylinder_{i + 1}.phase_deg={PHASES[i]}")
        if stations:
            found.append(f"cylinder_{i + 1}.station={i + 3}")
    return found


def cost(program: Path, case: str, settings: list[str], turns: int) -> tuple[int, int, int]:
    """Evaluations, instructions inside them, instructions of a run."""
    common = ("run.until=end", "drive.kind=constant_speed", "drive.torque=0.0", "drive.damping=0.0", f"integrator.revolutions={turns}",
              "integrator.relative_tolerance=1e-6",
              "integrator.method=auto", "output.samples_per_revolution=1", "output.columns=time", "output.answers=F", "output.ideal_twin=F",
              "output.window=all", "cylinder=none", *RIGID)
    with tempfile.TemporaryDirectory() as folder:
        profile = Path(folder) / "profile"
        evaluations, instructions = counted(program, case, folder, (*common, *SINGLE.get(case, ()), *settings), str(profile))
        return evaluations, inclusive(profile.read_text(), "scene_problem_MOD_derivatives"), instructions


def inclusive(profile: str, function: str) -> int:
    """Instructions of a call of a function and of what it calls, on the average of all calls in a profile of callgrind."""
    number = re.search(rf"\((\d+)\) [^\n]*{function}$", profile, re.MULTILINE)[1]
    calls = cost = 0
    for count, spent in re.findall(rf"^cfn=\({number}\)[^\n]*\ncalls=(\d+)[^\n]*\n\S+ (\d+)", profile, re.MULTILINE):
        calls += int(count)
        cost += int(spent)
    return round(cost / calls)


def main() -> None:
    program = program_of(__doc__)
    rows = []
    for name, case in ENGINES.items():
        one = None
        for cylinders, stations in ((1, False), (1, True), (6, False), (6, True)):
            settings = scene(cylinders, stations)
            cost(program, case, settings, 1)   # makes the film table
            few, many = (cost(program, case, settings, turns) for turns in TURNS)
            evaluations, instructions = ((many[k] - few[k]) / (TURNS[1] - TURNS[0]) for k in (0, 2))
            one = one or (many[1], instructions)
            shaft = "nine stations" if stations else "rigid"
            rows.append((name, f"{cylinders}, {shaft}", f"{evaluations:.0f}", f"{many[1]}", f"{many[1] / one[0]:.2f}",
                         f"{1e-3 * instructions:.0f}", f"{instructions / one[1]:.2f}"))
            print(*rows[-1], flush=True)
    text = NOTE + table(("engine", "cylinders, shaft", "evaluations", "instructions of one", "of one cylinder", "thousand instructions",
                         "of one cylinder"), rows)
    print(write_table("cylinders", "Cost of several cylinders", "scripts/bench/measure_cylinders.py", text))


if __name__ == "__main__":
    main()
