#!/usr/bin/env python3
"""Measures what the models of the gas cost and change: an engine without and with mass, leak and walls, a compressor with ideal valves, springs
and reeds. Writes data/measured/gas_models.md.

    scripts/bench/measure_gas_models.py [--program PROGRAM]
"""
from __future__ import annotations

import tempfile

from measured import program_of, table, timed_run, write_table

ENGINE, COMPRESSOR = "gas/engine_walls", "gas/compressor_valves"
ADIABATIC = ("wall_heat=none", "working_gas.leak_area=0")
IDEAL = ("wall_heat=none", "valve=none", "working_gas=none", "combustion.polytropic_exponent=1.4")


def reed(mass: str, *more: str) -> tuple[str, ...]:
    return f"valve_1.mass={mass}", "valve_1.damping=0.5", *more


RUNGS = ((ENGINE, "engine, pressure from the angle alone", ("wall_heat=none", "working_gas=none")), (ENGINE, "with temperature and mass", ADIABATIC),
         (ENGINE, "with a leak", ("wall_heat=none",)), (ENGINE, "with a leak and walls", ()), (COMPRESSOR, "compressor, ideal valves", IDEAL),
         (COMPRESSOR, "springs", ADIABATIC), (COMPRESSOR, "springs, a leak and walls", ()), (COMPRESSOR, "reeds of 0.28 g", reed("0.28 g", *ADIABATIC)),
         (COMPRESSOR, "reeds of 1 g", reed("1 g", *ADIABATIC)), (COMPRESSOR, "reeds of 3 g", reed("3 g", *ADIABATIC)))
TEXT = """Engine: `cases/gas/engine_walls.nml`, 200 J of heat, four turns. Compressor: `cases/gas/compressor_valves.nml`, six turns at 25 turns a second, valves of 2 cm2; reeds of
0.28, 1 and 3 g are tuned to 12, 6.4 and 3.7 times the turns, their damping is 0.5 N s/m. Both at a relative tolerance of 1e-6 with a film in the pin, all files and
standard columns; the answers of the last cycle. The time is the least processor time of three runs.
"""
COLUMNS = (("cycle_max_cylinder_pressure", 1e-5, ".3f"), ("cycle_indicated_power", 1, ".1f"), ("cycle_mass_flow", 1e3, ".3f"), ("max_pin_force", 1, ".0f"))


def main() -> None:
    program = program_of(__doc__)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for case, name, settings in RUNGS:
            seconds, summary = timed_run(program, case, folder, (*settings, "output.columns=standard"))
            rows.append([name, summary["rhs_evaluations"], f"{1e3*seconds:.0f}", *(f"{factor*float(summary[key]):{form}}" if summary.get(key) else "-" for key, factor, form in COLUMNS)])
    head = ("model", "evaluations", "time [ms]", "largest pressure [bar]", "indicated power [W]", "mass flow [g/s]", "largest force on the pin [N]")
    write_table("gas_models", "What the models of the gas cost and change", "scripts/bench/measure_gas_models.py", TEXT + "\n" + table(head, rows))


if __name__ == "__main__":
    main()
