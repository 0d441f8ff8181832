#!/usr/bin/env python3
"""Measures the results of the shipped cases, and how they depend on some keys. Each table is written to data/measured/NAME.md.

    scripts/bench/measure_cases.py              all tables
    scripts/bench/measure_cases.py NAME ...     these tables
    scripts/bench/measure_cases.py --list       the names of the tables

The numbers are from the summaries of runs with the method auto and the tolerance of each case (`-a standard`).
"""
from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import measured
from measured import built_program, run, write_table

SIMULATIONS = [f"sim_{number}{film}" for film in ("", "_oscillating") for number in ("I", "II", "III", "IV", "V", "VI")]
FINITE = [f"film/sim_{number}_finite" for number in ("I", "II", "III", "IV", "V", "VI")]

#: Column of a table: heading, quantity of the summary, factor, format of the number.
Column = tuple[str, str, float, str]
CONTACTS: Column = ("contacts", "contacts", 1, ".0f")
SHARE: Column = ("in contact [%]", "contact_time_fraction", 100, ".1f")
FILM: Column = ("smallest film thickness [um]", "min_film_thickness", 1e6, ".3f")
DEPTH: Column = ("deepest penetration [um]", "max_penetration", 1e6, ".2f")
FORCE: Column = ("largest pin force [kN]", "max_pin_force", 1e-3, ".2f")
SPEED: Column = ("mean crank speed [rad/s]", "mean_crank_speed", 1, ".2f")
RESIDUAL: Column = ("relative energy residual", "max_energy_residual_relative", 1, ".0e")
WORK: Column = ("evaluations", "rhs_evaluations", 1, ".0f")
LOST: Column = ("energy taken by the film [mJ]", "film_energy_lost", 1e3, ".4g")
PRESSURE: Column = ("largest pressure [MPa]", "max_film_pressure", 1e-6, ".4g")
REPORT = ("lubrication.report=T",)


@dataclass
class Row:
    label: str
    case: str
    values: tuple[str, ...] = ()


@dataclass
class Table:
    title: str
    columns: tuple[Column, ...]
    rows: list[Row]
    note: str = ""


def of_cases(*cases: str) -> list[Row]:
    return [Row(f"`{case}`", case) for case in cases]


def weighted() -> list[Row]:
    rows = []
    for shape, depth, ratio in (("smooth", 3e-6, 0.03), ("linear", 3e-6, 0.03), ("smooth", 3e-7, 0.03), ("smooth", 1e-5, 0.03),
                                ("smooth", 3e-6, 0.1), ("smooth", 3e-6, 0.01), ("smooth", 3e-6, 0.001)):
        rows.append(Row(f"{shape}, {1e6 * depth:g} um, {ratio:g}", "film/weighted", (
            f"lubrication.transition_shape={shape}", f"lubrication.transition_depth={depth}", f"lubrication.least_film_ratio={ratio}")))
    return rows


def elastic_walls() -> list[Row]:
    rows = []
    walls = {"rigid": ("contact=none", "lubrication.elastic_film=F", "lubrication.pressure_viscosity=0"),
             "elastic": ("lubrication.pressure_viscosity=0",), "elastic, 1.8e-8 1/Pa": ("lubrication.pressure_viscosity=1.8e-8",)}
    for speed in (295, 543):
        for name, values in walls.items():
            rows.append(Row(f"{speed} rad/s, {name}", "film/elastic", (f"initial.crank_speed={speed}", *REPORT, *values)))
    return rows


def viscosity() -> list[Row]:
    oil = ("lubrication.viscosity_law=walther", "lubrication.known_temperatures=313.15, 373.15",
           "lubrication.known_viscosities=32e-6, 5.4e-6", "lubrication.density=865", "lubrication.viscosity=0")
    return [Row("11.7 mPa s, as shipped", "sim_I")] + [
        Row(f"{celsius} degrees C", "sim_I", (*oil, f"lubrication.temperature={celsius + 273.15}")) for celsius in (40, 60, 80, 100)]


def shapes() -> list[Row]:
    rows = [Row("rigid rod", "elastic/dry_friction", ("elastic_rod=none",))]
    for modes, axial in ((0, 0), (1, 0), (2, 0), (4, 0), (8, 0), (0, 4), (0, 8), (2, 4), (4, 8)):
        rows.append(Row(f"{modes} transverse modes, {axial} axial shapes", "elastic/dry_friction",
                        (f"elastic_rod.transverse_modes={modes}", f"elastic_rod.axial_shapes={axial}")))
    return rows


def elastic_methods() -> list[Row]:
    cases = ("elastic/dry_friction", "elastic/first_impact", "elastic/engine_rod", "elastic/engine_crankshaft")
    return [Row(f"`{case}`, {tolerance}, {method}", case, (f"integrator.method='{method}'", f"integrator.relative_tolerance={tolerance}"))
            for case in cases for tolerance in ("1e-6", "1e-9") for method in ("adams", "radau", "auto")]


TABLES = {
    "simulations": Table("The simulations of chapter 6", (CONTACTS, SHARE, FILM, FORCE, SPEED, RESIDUAL, WORK),
                         of_cases(*SIMULATIONS, *FINITE, "film/sim_IV_mixed"),
                         "A negative film thickness is a penetration. With the Pinkus-Sternlicht film there is no contact. The "
                         "oscillating film has no force along the line of centres and cannot carry a load: with it the pin is in contact for most of the "
                         "time."),
    "joints": Table("Clearance at the crank pin, and clearance of the piston in its bore", (
        CONTACTS, SHARE, FILM, FORCE, ("crank pin: contacts", "crank_pin_contacts", 1, ".0f"),
        ("crank pin: film thickness [um]", "crank_pin_min_film_thickness", 1e6, ".3f"),
        ("crank pin: force [kN]", "crank_pin_max_pin_force", 1e-3, ".2f"), ("skirt corner 1: contacts", "guide_1_contacts", 1, ".0f"), RESIDUAL),
        of_cases("joints/both_pins", "joints/crank_pin", "joints/both_pins_lubricated", "joints/piston_slap", "joints/guide_friction"),
        "`both_pins` and `piston_slap` are chaotic: their numbers depend on the tolerance."),
    "weighted": Table("Film and contact that share the load: shape, `transition_depth`, `least_film_ratio`", (CONTACTS, SHARE, DEPTH, FILM),
                      weighted(), "Case `film/weighted`. Both lengths are chosen, not derived from the bearing; the results "
                                  "depend on them."),
    "elastic_walls": Table("Elastic walls under the film", (FILM, FORCE, PRESSURE, LOST, WORK), elastic_walls(),
                           "Case `film/elastic` with a film of finite length. Inertia sets the load of a piston pin, so elastic walls change neither film "
                           "thickness nor pressure; oil whose viscosity grows with the pressure does. Elastic walls make the equations less stiff."),
    "viscosity": Table("Simulation I with oil of several temperatures", (
        ("viscosity [mPa s]", "viscosity", 1e3, ".3g"), FILM, FORCE), viscosity(),
                       "An oil of 32 mm2/s at 40 and 5.4 mm2/s at 100 degrees C (Walther's law)."),
    "elastic_methods": Table("Scenes with elastic members by several methods and tolerances", (
        WORK, ("Jacobians", "jacobians", 1, ".0f"),
        ("changes of method", "method_switches", 1, ".0f"), RESIDUAL), elastic_methods(),
                             "A Jacobian is found by finite differences: it takes as many further evaluations as there are "
                             "positions and rates. In dry contact every impact excites new waves along the rod, and Adams needs "
                             "about as many evaluations as Radau. In an engine with a film the waves are damped, but stability "
                             "still limits the steps of Adams, which needs 300 to 5000 times the evaluations of Radau."),
    "elastic_rod": Table("Number of shapes of an elastic rod, and evaluations", (CONTACTS, FORCE, WORK, RESIDUAL), shapes(),
                         "Case `elastic/dry_friction`, two revolutions, method auto. The waves along the rod determine the size "
                         "of the steps; therefore axial shapes need most evaluations."),
}


def write(program: Path, name: str) -> None:
    table = TABLES[name]
    rows = []
    for row in table.rows:
        with tempfile.TemporaryDirectory() as out:
            values = run(program, row.case, out, ("output.ideal_twin=F", "output.columns=time", "output.samples_per_revolution=1", *row.values),
                         ("-a", "standard"))
        rows.append([row.label, *(format(factor * float(values[quantity]), how) if quantity in values else ""
                                  for _, quantity, factor, how in table.columns)])
    text = table.note + "\n\n" + measured.table(("", *(column[0] for column in table.columns)), rows)
    print(write_table(name, table.title, f"scripts/bench/measure_cases.py {name}", text))


def main() -> int:
    names = sys.argv[1:]
    if names == ["--list"]:
        print(*TABLES, sep="\n")
        return 0
    if any(name not in TABLES for name in names):
        print(__doc__, file=sys.stderr)
        return 2
    program = built_program()
    for name in names or TABLES:
        write(program, name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
