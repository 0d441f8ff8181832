#!/usr/bin/env python3
"""What do supply, an elastic bore and thickening oil change in the film of a piston pin, and what does its computation cost?

    scripts/bench/measure_fed_film.py [--grids 96x8,192x16]

The fed films of simulations I and IV (cases/film/sim_I_fed.nml, sim_IV_fed.nml) with other supplies and bores, on each grid; the times
of computations with more and more cells and steps. Writes data/measured/fed_film.md.
"""
import argparse
import csv
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import TOP, built_program, write_table

CASES = ("sim_I", "sim_IV")
VARIANTS = (
    ("grooves at 90 and 270 deg, 2 bar", ()),
    ("flooded ends, 1 bar above cavitation, no supply", ("supply=none", "lubrication.ambient_over_cavitation=1e5")),
    ("grooves, ring of 2.5", ("bore.outer_radius=0.025",)),
    ("grooves, ring of 1.7", ("bore.outer_radius=0.017",)),
    ("grooves, ring of 2.5, Barus 1.5e-8 1/Pa", ("bore.outer_radius=0.025", "lubrication.pressure_viscosity=1.5e-8")),
    ("circumferential groove of 2 mm, 2 bar",
     ("supply.kind=circumferential_groove", "supply.groove_width=0.002", "supply.width_deg=0", "supply.length=0")),
    ("one groove at 0 deg, 2 bar", ("supply.position_deg=0",)),
    ("the orbit of the run, grooves", ("film_history.drive=orbit",)))
#: Grids and steps of the costs: cells round, along, rows in a revolution.
COSTS = ((48, 4, 360), (96, 4, 360), (96, 8, 360), (96, 8, 720), (192, 8, 360), (192, 16, 360), (384, 16, 360))


def march(program: Path, folder: Path, case: str, settings: tuple[str, ...]) -> dict[str, float] | None:
    """Numbers of the summary of a run and its processor time [s]; None where the film cannot be solved."""
    words = [word for setting in settings for word in ("--set", setting)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program, "-q", TOP / "cases" / "film" / f"{case}_fed.nml", "--out", folder, *words], capture_output=True,
                          text=True, check=False)
    took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    with (folder / f"{case}_fed.summary.csv").open(newline="") as file:
        found = {row["quantity"]: row["value"] for row in csv.DictReader(file)}
    if done.returncode:
        print(f"{case} {' '.join(settings)}: {done.stderr.strip()}", file=sys.stderr)
        return None
    return {"time": took} | {name: float(value) for name, value in found.items() if name.startswith("film_history_")}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grids", default="96x8,192x16", help="cells round the bearing and along half of it")
    options = parser.parse_args()
    program = built_program()
    text = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for case in CASES:
            text += [f"\n## {case.replace('sim_', 'Simulation ')}\n",
                     "| film | cells | thinnest [um] | film of the run [um] | pressure [MPa] | of the run [MPa] | least fill | flow [ml/s] | cycles |",
                     "|---|---|---|---|---|---|---|---|---|"]
            for title, settings in VARIANTS:
                for grid in options.grids.split(","):
                    around, along = grid.split("x")
                    found = march(program, folder, case, (*settings, f"film_history.around={around}", f"film_history.along={along}"))
                    if found is None:
                        text.append(f"| {title} | {grid} | not solved | | | | | | |")
                        continue
                    text.append("| {} | {} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {:.2f} | {:.3f} | {:.0f} |".format(
                        title, grid, 1e6 * found["film_history_min_film_thickness"],
                        1e6 * found["film_history_quick_min_film_thickness"], 1e-6 * found["film_history_max_film_pressure"],
                        1e-6 * found["film_history_quick_max_film_pressure"], found["film_history_least_fill"],
                        1e6 * found["film_history_mean_side_flow"], found["film_history_cycles"]))
        text += ["\n## Cost of simulation I\n", "Processor time of the film with memory alone (the run without it is subtracted), for a cycle of 720 degrees.\n",
                 "| cells | steps in a cycle | rigid [s/cycle] | ring of 2.5, 15 modes [s/cycle] |", "|---|---|---|---|"]
        for around, along, rows in COSTS:
            times = []
            for bore in ((), ("bore.outer_radius=0.025",)):
                settings = (f"film_history.around={around}", f"film_history.along={along}", f"output.samples_per_revolution={rows}", *bore)
                with_march = march(program, folder, "sim_I", settings)
                without = march(program, folder, "sim_I", (*settings[2:3], "film_history=none", "supply=none",
                                                         "lubrication.cavitation=reynolds"))
                times.append("not solved" if with_march is None or without is None else
                             f"{(with_march['time'] - without['time']) / with_march['film_history_cycles']:.2f}")
            text.append(f"| {around} x {along} | {2 * rows} | {times[0]} | {times[1]} |")
    write_table("fed_film", "The film of a piston pin that must be fed", "scripts/bench/measure_fed_film.py", "\n".join(text))


if __name__ == "__main__":
    main()
