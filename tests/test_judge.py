#!/usr/bin/env python3
"""Tests that the independent judge of runs (tests/judge/scene_judge) detects faults.

    tests/test_judge.py [--program FILE] [--jobs N] [--mutants [FOLDER]]

Correct runs must pass. Then the judge must find each of these faults with the check that is meant for it: a column of a trace that
is changed slightly (its sign, or one part in a thousand or less), and a program that writes another value into the resolved case
than it has used (restitution, friction, damping, heat, tolerance and others). With --mutants, copies of the program with one wrong
line of physics are built and judged; with a FOLDER only those whose line is in src/FOLDER. A copy that stops by itself because its
energy is not kept counts as found. Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import copy
import dataclasses
import importlib.machinery
import importlib.util
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "judge"))
from assertions import Assertions
from scene_judge.energy import SAFETY
from scene_judge.quadrature import integral, stencils
from scene_judge.trace import Run, merged, run_case
from scene_judge.verdict import judge_files, judge_scene, requested, summary_of

assertions = Assertions()
check = assertions.check

STOPPED = 4   # exit status of a run that ends early

Finding = tuple[bool, str, str]   # whether the assertion holds, its name, what was found otherwise

SMALL_TABLE = {"lubrication.table_points": "33", "lubrication.film_points": "64"}
OIL = {f"lubrication.{key}": value for key, value in {"viscosity": "0", "viscosity_law": "'walther'", "temperature": "350", "density": "870",
                                                      "known_temperatures": "313.15, 373.15", "known_viscosities": "1e-4, 1.1e-5"}.items()}

TIGHT_CRANK_PIN = {"crank_pin.joint.kind": "'clearance'", **{f"crank_pin.joint.{key}": value for key, value in
                   {"clearance": "1e-7", "bearing_radius": "0.02", "bearing_length": "0.02"}.items()}}

WEAR = {"wear.rate": "1e-15, 3e-14"}
LENGTH = {"joint.bearing_length": "0.02"}
LENGTHS = {**LENGTH, "crank_pin.joint.bearing_length": "0.03"}

#: Runs by name: case, and settings that keep the run short. Together they contain every law and both joints.
SCENES = {
    "engine": ("cylinders/four_dry", {"integrator.revolutions": "0.2"}),
    "carried": ("bearings/big_end_heat", {"run.until": "end", "integrator.revolutions": "2.0"}),
    "dry": ("flores/friction_050", {"integrator.revolutions": "0.3"}),
    "sticks": ("friction/coulomb_static", {"integrator.revolutions": "0.3"}),
    "threlfall": ("flores/friction_050", {"integrator.revolutions": "0.15", "friction.law": "threlfall", "friction.v1": "0.4"}),
    "brown_mcphee": ("friction/brown_mcphee", {"integrator.revolutions": "0.15", "friction.viscous_coefficient": "0.01",
                                               "friction.transition_speed": "0.2"}),
    "stribeck": ("friction/brown_mcphee", {"integrator.revolutions": "0.15", "friction.law": "stribeck", "friction.stribeck_speed": "0.3",
                                           "friction.transition_speed": "0.1"}),
    "conformal": ("contact/conformal_exact", {"integrator.revolutions": "0.15", **WEAR}),
    "johnson": ("contact/johnson_gonthier", {"integrator.revolutions": "0.15"}),
    "liner": ("contact/liner_carvalho_martins", {"integrator.revolutions": "0.15", **WEAR}),
    "pereira": ("contact/pereira_impact", {"integrator.revolutions": "0.15"}),
    "dissipation": ("contact/hunt_crossley", {"integrator.revolutions": "0.15", "contact.dissipation": "0.4"}),
    "lugre": ("friction/lugre", {"integrator.revolutions": "0.15"}),
    "elasto_plastic": ("friction/lugre", {"integrator.revolutions": "0.15", "friction.law": "elasto_plastic"}),
    "film": ("sim_V", {"integrator.method": "'auto'", "integrator.revolutions": "1.2", "initial.crank_angle_deg": "170",
                       "integrator.max_step": "5e-5"}),
    "contact": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "0.25", "initial.crank_angle_deg": "340"}),
    "weighted": ("film/weighted", {"integrator.revolutions": "0.3", "integrator.max_step": "2e-5"}),
    "compressor": ("gas/compressor", {"integrator.method": "'auto'", "integrator.revolutions": "1.2", "drive.kind": "'free'"}),
    "two_stroke": ("gas/two_stroke", {"integrator.method": "'auto'", "integrator.revolutions": "1.2", "initial.crank_angle_deg": "170"}),
    "woschni": ("gas/engine_walls", {"integrator.revolutions": "1.2", "initial.crank_angle_deg": "170"}),
    "hohenberg": ("gas/engine_walls", {"integrator.revolutions": "1.2", "initial.crank_angle_deg": "170", "wall_heat.law": "hohenberg", "initial.crank_speed": "-250"}),
    "valves": ("gas/compressor_valves", {"integrator.revolutions": "1.2", "integrator.relative_tolerance": "1e-7"}),
    "reeds": ("gas/compressor_valves", {"integrator.revolutions": "1.2", "integrator.relative_tolerance": "1e-7", "valve_1.mass": "1e-3", "valve_1.damping": "0.5"}),
    "filled": ("gas/compressor", {"integrator.method": "'auto'", "integrator.revolutions": "1.2", "working_gas.gas_constant": "287", "working_gas.temperature": "300"}),
    "measured": ("gas/measured", {"integrator.method": "'auto'", "integrator.revolutions": "0.5", "initial.crank_angle_deg": "300",
                                  "cylinder_pressure.offset_deg": "-17.3"}),
    "ramp": ("drive/start_up", {"integrator.method": "'auto'", "integrator.end_time": "0.05", "output.interval": "2.5e-4"}),
    # from rest, with a rod whose mass is at its centre: forces are only the rounding of inertial forces that cancel
    "start": ("flores/dry_0100um", {"integrator.method": "'auto'", "integrator.revolutions": "0.2", "mechanism.rod_inertia": "0",
                                    "drive.ramp_from": "0", "drive.ramp_time": "5e-4"}),
    "motor": ("drive/motor", {"integrator.method": "'auto'", "integrator.end_time": "0.1", "output.interval": "5e-4",
                              "integrator.relative_tolerance": "3e-7"}),   # at 1e-6 rows inside a step of 5 ms are too far off
    "elastic": ("film/elastic", {"integrator.revolutions": "0.1", "lubrication.variant": "short"}),
    "thickening": ("film/elastic", {"integrator.revolutions": "0.1", "integrator.relative_tolerance": "1e-7",
                                    "lubrication.law": "pinkus_sternlicht", "lubrication.variant": "closed_form",
                                    "lubrication.pressure_viscosity": "1.8e-8"}),
    "printed": ("sim_I", {"integrator.method": "'auto'", "integrator.revolutions": "0.02", "lubrication.variant": "as_printed",
                          "initial.eccentricity": "1e-5, 0", "initial.eccentricity_rate": "-1e-3, 0"}),
    "half": ("sim_II", {"integrator.method": "'auto'", "integrator.revolutions": "0.5", "lubrication.variant": "half_film"}),
    "short": ("film/sim_II_finite", {"integrator.revolutions": "0.5", "lubrication.variant": "short"}),
    "finite": ("film/sim_II_finite", {"integrator.revolutions": "0.5", **SMALL_TABLE}),
    "gumbel": ("film/sim_II_finite", {"integrator.revolutions": "0.5", **SMALL_TABLE, "lubrication.cavitation": "gumbel"}),
    "full": ("film/sim_II_finite", {"integrator.revolutions": "0.5", **SMALL_TABLE, "lubrication.cavitation": "none"}),
    "direct": ("film/sim_II_finite", {"integrator.revolutions": "0.02", "integrator.relative_tolerance": "1e-4", "lubrication.variant": "direct",
                                      "lubrication.film_points": "32"}),
    "rough": ("film/sim_IV_mixed", {"integrator.revolutions": "1.2", "initial.crank_angle_deg": "170", "lubrication.variant": "short", **WEAR}),
    "warm": ("sim_I", {"integrator.method": "'auto'", "integrator.revolutions": "0.2", **OIL}),
    # a hot oil, whose density is a fifth less than that at 15 degrees, and which is so thin that its inertia matters
    "inertia": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "0.3", **OIL, "lubrication.kinematic_viscosity": "0",
                                      "lubrication.temperature": "624", "lubrication.known_viscosities": "1e-6, 2.7e-7"}),
    "both": ("joints/both_pins", {"integrator.revolutions": "0.2", "drive.kind": "'free'", "mechanism.gravity_angle_deg": "25", **WEAR, **LENGTHS}),
    "crank": ("joints/crank_pin", {"integrator.revolutions": "0.2", "integrator.relative_tolerance": "1e-7"}),
    "slap": ("joints/piston_slap", {"integrator.revolutions": "0.3", "mechanism.gravity_angle_deg": "25", **WEAR, **LENGTH}),
    # almost without inertia of tilting: the acceleration of the centre of mass is a small difference of those of pin and tilt
    "jammed": ("joints/piston_slap", {"integrator.revolutions": "1e-4", "mechanism.gravity": "9.8", "initial.piston_tilt": "-0.04",
                                      "guide.piston_com": "-0.0104, 0.0002", "guide.piston_inertia": "5e-8", "guide.contact_law": "'exact'",
                                      "guide.stiffness": "1e12", "guide.coefficient": "0", "guide.viscous": "0"}),
    "guide": ("flores/ideal", {"drive.kind": "'free'", "mechanism.gravity": "9.8", "guide.law": "threlfall", "guide.coefficient": "0.1", "guide.v1": "0.5",
                               "guide.viscous": "3"}),
    "films": ("joints/both_pins_lubricated", {"integrator.revolutions": "0.5"}),
    # a small tolerance, because the shortening of the rod's chord by bending contributes only about 1e-5 of the energy
    "rod": ("elastic/dry_friction", {"integrator.revolutions": "0.1", "integrator.relative_tolerance": "1e-8", "drive.kind": "'free'", "mechanism.gravity": "1000",
                                     "mechanism.gravity_angle_deg": "25"}),
    "rods": ("joints/both_pins", {"integrator.revolutions": "0.05", "elastic_rod.section_area": "9.6e-5", "elastic_rod.section_inertia": "5.12e-10",
                                   **WEAR, **LENGTHS}),
    "worn": ("wear/worn_bore", {"integrator.revolutions": "1.2", "wear.extrapolation": "1", "wear.rate": "0, 1e-11"}),
    "shaft": ("elastic/engine_crankshaft", {"integrator.revolutions": "0.3"}),
    "bent": ("flores/ideal", {"integrator.revolutions": "0.3", "elastic_rod.section_area": "9.6e-5", "elastic_rod.section_inertia": "5.12e-10",
                              "drive.kind": "'free'", "mechanism.gravity": "9.8"}),
    # a film of 1e-11 of the clearance, where wedge and squeeze nearly cancel
    "thin": ("sim_V", {"integrator.method": "'auto'", "integrator.revolutions": "0.1", "joint.clearance": "0.005", **TIGHT_CRANK_PIN}),
    # corners whose damping acts fully at a depth that is less than the error of the contact's begin
    "sharp": ("sim_I_oscillating", {
        "integrator.method": "'auto'", "integrator.revolutions": "0.5", "contact": "none", "friction": "none", "lubrication.law": "'finite_bearing'",
        "lubrication.variant": "'short'", "lubrication.cavitation": "'gumbel'", "lubrication.viscosity": "88.39831674523636", "joint.bearing_length": "0.02",
        "guide.law": "'threlfall'", "guide.coefficient": "0", "guide.v1": "0.01", "guide.kind": "'clearance'",
        "guide.bore_clearance": "0.00024438502086830547", "guide.skirt_top": "0.001", "guide.skirt_bottom": "0.002070999603267184",
        "guide.piston_radius": "0.0035705841968826607", "guide.piston_inertia": "1", "guide.viscous": "0", "guide.stiffness": "194502201286.36316", "guide.exponent": "1.5",
        "guide.contact_law": "'impact'", "guide.damping": "0.7953737193324473", "guide.full_damping_depth": "1e-12",
        "initial.piston_offset": "0.00024438502086830547", "initial.piston_tilt": "0.07957833032876606", "initial.piston_offset_rate": "1",
        "initial.piston_tilt_rate": "-1e-06"}),
    # long steps in a film between elastic walls
    "walls": ("sim_I", {"integrator.method": "'auto'", "integrator.revolutions": "1", "initial.crank_angle_deg": "180", "initial.eccentricity": "0, 0",
                        "initial.eccentricity_rate": "0, 0", "contact.law": "'hertz'", "contact.geometry": "'winkler'", "contact.dissipation": "27.574438901218087",
                        "contact.bedding_modulus": "19275657055354.285", "friction": "none", "lubrication.elastic_film": ".true.",
                        "lubrication.pressure_viscosity": "4.301593438724609e-11", "lubrication.variant": "'closed_form'"}),
    # a piston that turns back within 30 us, in a step of 1 ms, and kicks the pin: it vibrates on its elastic walls where it crept before
    "kicked": ("sim_V", {
        "integrator.method": "'auto'", "integrator.revolutions": "0.0", "initial.crank_speed": "0.001",
        "integrator.end_time": "0.07333723647981304", "output.interval": "0.0007333723647981303", "drive.torque": "-0.01",
        "drive.kind": "'free'", "lubrication.law": "'finite_bearing'", "lubrication.variant": "'short'",
        "lubrication.kinematic_viscosity": "1.38e-5", "contact.law": "'hertz'", "contact.geometry": "'pereira'",
        "contact.restitution": "1.0", "mechanism.axis_offset": "-0.13715999999999998", "friction": "none",
        "lubrication.elastic_film": ".true.", "lubrication.pressure_viscosity": "0.0", "combustion.cycle": "'compressor'",
        "combustion.dead_space": "0.19685514056368977", "combustion.suction_pressure": "2321.316151653656",
        "combustion.discharge_pressure": "2321.3161539749726", "combustion.polytropic_exponent": "0.0",
        "combustion.crankcase_pressure": "101325.0", "ring_1.model": "'closed_form'", "ring_1.height": "0.002283113788383792",
        "ring_1.crown": "3.143238743826279e-06", "ring_1.tension": "100", "ring_1.gas_above": "1.0",
        "ring_1.gas_behind": "0.18480313952879235", "ring_1.gas_below": "0.0", "ring_2.model": "'closed_form'",
        "ring_2.height": "0.0013865434090337236", "ring_2.crown": "2.5699428181072092e-06", "ring_2.tension": "11.152881295244448",
        "ring_2.gas_above": "0.0", "ring_2.gas_behind": "0.0", "ring_2.gas_below": "0.0",
        "rings.lubrication.viscosity": "0.005161142769203369", "rings.lubrication.along": "40", "rings.asperities.roughness": "1e-05",
        "rings.asperities.density_product": "0.017245352771784878", "rings.asperities.sharpness": "0.00019089993061699063",
        "rings.asperities.integral": "'exact'", "rings.asperities.coefficient": "0.0",
        "rings.asperities.transition_speed": "0.0011546432973841305", "working_gas.gas_constant": "287.0",
        "working_gas.temperature": "300.0", "working_gas.leak_area": "3.547215056962957e-07", "working_gas.heat_capacity_ratio": "1.01",
        "valve_1.port": "'suction'", "valve_1.area": "2.4411032469109545e-05", "valve_1.lift": "1e-05", "valve_1.stiffness": "1",
        "valve_1.force_area": "0.01", "valve_1.preload": "0.0", "valve_2.port": "'discharge'", "valve_2.area": "0.002878424503366101",
        "valve_2.lift": "0.009322234193987923", "valve_2.stiffness": "0.0", "valve_2.force_area": "3.0460655650461108e-05",
        "valve_2.preload": "0.0", "valve_1.mass": "0.03337687361200232", "valve_1.damping": "0.0"}),
    # at the dead centre a wide valve holds the pressure of almost no gas: its rate follows from 3e-8 of the pressure
    "little_gas": ("sim_V", {"integrator.method": "'auto'", "integrator.revolutions": "1.0", "drive.kind": "'constant_speed'", "combustion.cycle": "'compressor'",
                             "combustion.dead_space": "1e-4", "combustion.suction_pressure": "1934", "combustion.discharge_pressure": "1934.000002",
                             "combustion.polytropic_exponent": "0", "working_gas.gas_constant": "120", "working_gas.temperature": "300",
                             "working_gas.heat_capacity_ratio": "1.6666666666666667", "valve_1.port": "'suction'", "valve_1.area": "2.4e-5", "valve_1.lift": "2.3e-4",
                             "valve_1.stiffness": "12", "valve_1.force_area": "0.01", "valve_1.mass": "8.2e-6", "valve_2.port": "'discharge'", "valve_2.area": "0.01",
                             "valve_2.lift": "1e-5", "valve_2.force_area": "1e-6"}),
    # a shape of the rod that is much faster than the distance of rows, and at rest relative to the load
    "rigid": ("sim_V", {"integrator.method": "'auto'", "integrator.revolutions": "1", "mechanism.crank_mass": "0", "lubrication.transition": "'weighted'",
                        "lubrication.transition_depth": "2.9976694336073933e-05", "lubrication.least_film_ratio": "0.02113403968150216",
                        "lubrication.variant": "'half_film'", "elastic_rod.youngs_modulus": "1e13", "elastic_rod.section_area": "1e-5",
                        "elastic_rod.section_inertia": "2.3137476317273072e-08", "elastic_rod.transverse_modes": "2",
                        "elastic_rod.axial_shapes": "0", "elastic_rod.damping_ratio": "0.999", "mechanism.rod_com": "0.06, 0"}),
    # a crankshaft whose twist is small, but larger than the tolerance of an angle
    "twisted": ("sim_V", {"integrator.method": "'auto'", "integrator.revolutions": "1", "integrator.relative_tolerance": "2.881411704428786e-08",
                          **TIGHT_CRANK_PIN, "crankshaft.flywheel_inertia": "0.16449913650826556",
                          "crankshaft.torsional_stiffness": "7758960.105467266", "crankshaft.torsional_damping": "0"}),
    # large forces on the piston, and almost none at its pins
    "held": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "0", "integrator.end_time": "1e-12", "output.interval": "1e-14",
                                   "initial.crank_speed": "0.001", "drive.damping": "12", **TIGHT_CRANK_PIN, "crank_pin.joint.clearance": "5e-5",
                                   "guide.kind": "'clearance'", "guide.bore_clearance": "3.3e-6", "guide.skirt_top": "0.025", "guide.skirt_bottom": "0.0014",
                                   "guide.piston_radius": "0.0088", "guide.piston_inertia": "0.0078", "guide.stiffness": "1e12",
                                   "guide.piston_com": "-0.034, 0.002", "guide.exponent": "1", "guide.contact_law": "'hertz'",
                                   "initial.piston_offset": "1.7e-6", "initial.piston_tilt": "1.2e-4", "initial.piston_offset_rate": "7.8e-5",
                                   "initial.piston_tilt_rate": "-0.009"}),
    # axial shapes of a rod that is hardly loaded: at most 3e-21 m
    "unexcited": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "1e-9", "drive.kind": "'constant_speed'", "drive.ramp_time": "0.29", "drive.ramp_from": "0.001",
                                        "elastic_rod.youngs_modulus": "1e13", "elastic_rod.section_area": "0.01", "elastic_rod.section_inertia": "1.7e-8",
                                        "elastic_rod.transverse_modes": "0", "elastic_rod.axial_shapes": "8", "elastic_rod.damping_ratio": "0",
                                        "elastic_rod.axial_damping_ratio": "0.999", "mechanism.rod_com": "0.06, 0", "elastic_rod.shank_mass": "6.770427831142613e-05"}),
    # a film that vanishes within 6 nm, in a row that is the event
    "vanishing": ("sim_V_oscillating", {
        "integrator.method": "'auto'", "integrator.revolutions": "0.52", "combustion.compression_ratio": "1.01", "friction.law": "'brown_mcphee'",
        "friction.coefficient": "0.003511238350332956", "friction.transition_speed": "10", "lubrication.transition": "'weighted'",
        "lubrication.transition_depth": "6.1335016555588155e-09", "lubrication.transition_shape": "'linear'",
        "lubrication.least_film_ratio": "0.02386501152501811", "lubrication.law": "'pinkus_sternlicht'", "lubrication.variant": "'closed_form'",
        "lubrication.viscosity": "0", "lubrication.kinematic_viscosity": "0", "lubrication.viscosity_law": "'vogel'",
        "lubrication.temperature": "690.1075805773098", "lubrication.known_temperatures": "313.15, 373.15", "lubrication.density": "1485.9958429449339",
        "lubrication.known_viscosities": "2.2519402354257648e-05, 2.251940235425765e-06", "combustion.cycle": "'compressor'",
        "combustion.dead_space": "0.0001", "combustion.suction_pressure": "1094.3432460567346", "combustion.discharge_pressure": "1094.343247151078",
        "combustion.polytropic_exponent": "0.1", "combustion.crankcase_pressure": "1094.3432460567346", "guide.law": "'brown_mcphee'",
        "guide.coefficient": "0.0022202365980267", "guide.transition_speed": "0.01328424062907412", "guide.viscous": "156.74371735244947",
        "guide.kind": "'clearance'", "guide.bore_clearance": "3.57554633696415e-06", "guide.skirt_top": "0.009980214649986368",
        "guide.skirt_bottom": "0.2", "guide.piston_radius": "0.004711212066419684", "guide.piston_inertia": "1e-08", "guide.stiffness": "1e12",
        "guide.piston_com": "0, 0", "guide.exponent": "2.1768060770871935", "guide.contact_law": "'lankarani_nikravesh'",
        "guide.restitution": "0.9445339501958341", "initial.piston_offset": "3.933100970660565e-06"}),
    # a corner that leaves the wall: its damping cancels its elastic force up to a depth of 9e-12 m
    "leaving": ("sim_I", {
        "integrator.method": "'auto'", "integrator.revolutions": "1", "mechanism.crank_mass": "0", "guide.law": "'threlfall'", "guide.coefficient": "0", "guide.v1": "10",
        "guide.viscous": "0", "guide.kind": "'clearance'", "guide.bore_clearance": "9.355995606964534e-06", "guide.skirt_top": "0.03371482011696212",
        "guide.skirt_bottom": "0.0019440315368506403", "guide.piston_radius": "0.001", "guide.piston_inertia": "1", "guide.stiffness": "60370577684.152954",
        "guide.piston_com": "0.035854252724698735, 0.008044996321147678", "guide.exponent": "1.5", "guide.contact_law": "'impact'",
        "guide.damping": "7.626816356900431", "guide.full_damping_depth": "1.3967762099789478e-08", "initial.piston_offset": "9.355995606964534e-06",
        "initial.piston_tilt": "-0.0005247502470239622", "initial.piston_offset_rate": "0.5873025102089904"}),
    # errors of the start that hardly grow, in two directions of four
    "thick": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "1.0", "output.ideal_twin": ".false.", "integrator.max_evaluations": "20000",
                                    "lubrication.kinematic_viscosity": "1.0", "contact.law": "'hertz'", "friction": "none", "lubrication.elastic_film": ".true.",
                                    "lubrication.pressure_viscosity": "1e-12", "lubrication.law": "'pinkus_sternlicht'", "lubrication.variant": "'closed_form'"}),
    "massless": ("friction/lugre", {"integrator.revolutions": "0.05", "mechanism.rod_mass": "0"}),
    "loose": ("flores/friction_050", {"integrator.revolutions": "0.3", "integrator.relative_tolerance": "1e-3"}),
    # at rest at first, where no film has a force
    "still": ("sim_V_oscillating", {"integrator.method": "'auto'", "integrator.revolutions": "0", "integrator.end_time": "1.5e-5", "output.interval": "1.5e-7",
                                    "initial.eccentricity": "3.575570906243101e-05, -7.704206510968281e-06", "initial.eccentricity_rate": "0, 0",
                                    "initial.crank_angle_deg": "180", "initial.crank_speed": "0", "mechanism.gravity": "101.3",
                                    "lubrication.transition": "'weighted'", "lubrication.transition_depth": "3.26090332549357e-09",
                                    "lubrication.transition_shape": "'linear'", "lubrication.least_film_ratio": "1e-06",
                                    "lubrication.law": "'pinkus_sternlicht'", "lubrication.variant": "'closed_form'"}),
    # an oscillating film so wide that its force is less than 1e-13 N
    "wide": ("sim_V", {"integrator.method": "'radau'", "integrator.revolutions": "0", "integrator.end_time": "0.026", "joint.clearance": "0.005",
                       "combustion.wiebe_form": "0.1", "drive.kind": "'free'", "initial.crank_speed": "96.1128866560898", "output.interval": "0.0003487293603932208",
                       "drive.torque": "-553.9213311866381", "lubrication.law": "'oscillating_film'", "lubrication.variant": "''",
                       "lubrication.kinematic_viscosity": "1.38e-5", "friction.law": "'stribeck'", "friction.coefficient": "0.0016770691976616676",
                       "friction.static_coefficient": "0.0016770691976616676", "friction.transition_speed": "2.473881475586106e-08",
                       "friction.viscous_coefficient": "1", "friction.stribeck_speed": "2.5006445615549477", "friction.stribeck_exponent": "3.826614389130299",
                       "combustion.cycle": "'compressor'", "combustion.dead_space": "0.0001", "combustion.suction_pressure": "145008.25701383664",
                       "combustion.discharge_pressure": "9313790.420172257", "combustion.polytropic_exponent": "1.0",
                       "combustion.crankcase_pressure": "145008.25701383664"}),
    "ideal": ("flores/ideal", {"drive.kind": "'free'", "drive.damping": "0.03", "mechanism.gravity": "9.8", "initial.crank_angle_deg": "20"}),
}

PHASES = {"carried": {0}, "engine": {0, 2}, **dict.fromkeys(("kicked", "little_gas", "still", "unexcited", "leaving", "thick", "twisted", "thin", "sharp", "walls", "rigid", "held", "thickening", "printed", "half", "short", "finite", "gumbel", "full", "direct", "rough", "warm"), {1}),
          "wide": {1, 2}, "vanishing": {1, 2}, "massless": {0, 2}, "loose": {0, 2}, "start": {0, 2}, "dry": {0, 2}, "sticks": {0, 2}, "threlfall": {0, 2}, "brown_mcphee": {0, 2}, "stribeck": {0, 2}, "lugre": {0, 2},
          "elasto_plastic": {0, 2}, "conformal": {0, 2}, "johnson": {0, 2},
          "liner": {0, 2}, "pereira": {0, 2}, "dissipation": {0, 2}, "film": {1}, "contact": {1, 2}, "weighted": {1, 2}, "elastic": {1},
          "inertia": {1, 2}, "compressor": {1}, "two_stroke": {1}, "woschni": {1}, "hohenberg": {1}, "valves": {1}, "reeds": {1}, "filled": {1}, "measured": {1}, "ramp": {1}, "motor": {1}, "both": {0, 2}, "crank": {0}, "films": {1},
          "worn": {0, 2}, "slap": {0, 2}, "jammed": {0, 2}, "guide": {0}, "ideal": {0}, "rod": {0, 2}, "rods": {0, 2}, "shaft": {1}, "bent": {0}}   # 0 free flight, 1 film, 2 contact

#: (fault, scene, column, change of (value, row), text that the verdict must contain)
CORRUPTIONS: list[tuple[str, str, str, Callable[[float, int], float], str]] = [
    ("energy column one part in a million too large", "dry", "energy", lambda v, i: v * (1 + 1e-6), "energy column"),
    ("film of a carried bearing with one part in a million of the load too much", "carried", "crank_pin_film_force_x", lambda v, i: v * (1 + 1e-6), "of the largest load off"),
    ("place of a carried bearing one part in a thousand off", "carried", "crank_pin_eccentricity_x", lambda v, i: v * 1.001, "is not the integral of the rate by the load"),
    ("temperature of a film 10 K too high", "carried", "crank_pin_film_temperature", lambda v, i: v + 10, "film_power is"),
    ("power of a film one part in a thousand too large", "carried", "crank_pin_film_power", lambda v, i: v * 1.001, "film_power is"),
    ("temperature of a film that drifts", "carried", "crank_pin_film_temperature", lambda v, i: v + 1e-4 * i, "is not the integral of its heat balance"),
    ("side flow of a short film doubled", "carried", "crank_pin_film_side_flow", lambda v, i: 2 * v, "film_side_flow is"),
    ("a station turns further than its torques say", "engine", "station_1_speed", lambda v, i: v + 1e-3 * i, "station 1: its angular momentum"),
    ("another cylinder's gas force 10 N too large", "engine", "cylinder_3_gas_force", lambda v, i: v + 10, "station 4: its angular momentum"),
    ("torque of a segment one part in a million too large", "engine", "segment_3_torque", lambda v, i: v * (1 + 1e-6), "segment 3"),
    ("torque of a damper doubled", "engine", "damper_1_torque", lambda v, i: 2 * v, "station 1: its angular momentum"),
    ("energy of an engine one part in a million too large", "engine", "energy", lambda v, i: v * (1 + 1e-6), "energy column"),
    ("crank of an engine turns with a wrong torque", "engine", "segment_2_torque", lambda v, i: v + 1e-3, "Euler, crank"),
    ("energy residual 1 J too large", "dry", "energy_residual", lambda v, i: v + 1.0, "column energy_residual"),
    ("pin force along x wrong by one part in a million", "dry", "pin_force_x", lambda v, i: v * (1 + 1e-6), "Newton, piston"),
    ("pin force along y with the opposite sign", "dry", "pin_force_y", lambda v, i: -v, "guide force"),
    ("guide force with the opposite sign", "film", "guide_force", lambda v, i: -v, "guide force"),
    ("crank pin force on the rod wrong", "film", "crankpin_force_y", lambda v, i: v * 1.001, "Newton, rod along y"),
    ("force on the crank's bearing wrong", "film", "crank_bearing_force_x", lambda v, i: v * 1.001, "Newton, crank along x"),
    ("force on the frame wrong", "film", "frame_force_x", lambda v, i: v * 1.001, "force on the frame, x"),
    ("crank acceleration wrong", "film", "crank_acceleration", lambda v, i: v * 1.001, "Euler, crank"),
    ("rod acceleration wrong", "film", "rod_acceleration", lambda v, i: v * 1.001, "Euler, rod"),
    ("piston acceleration with the opposite sign", "ideal", "piston_acceleration", lambda v, i: -v, "Newton, piston"),
    ("crank moment 1 N m too large", "film", "crank_moment", lambda v, i: v + 1.0, "Euler, crank"),
    ("piston position wrong", "film", "piston_position", lambda v, i: v + 1e-9, "pin in the bearing, x"),
    ("eccentricity wrong", "contact", "eccentricity_y", lambda v, i: v * 1.001, "pin in the bearing, y"),
    ("film thickness too large", "film", "film_thickness", lambda v, i: v * (1 + 1e-9), "film thickness"),
    ("normal force too large", "contact", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("friction force in the direction of sliding", "contact", "friction_force", lambda v, i: -v, "friction law"),
    ("friction at rest above static friction", "sticks", "friction_force", lambda v, i: v * 1.2, "friction law"),
    ("Threlfall friction force too large", "threlfall", "friction_force", lambda v, i: v * (1 + 1e-5), "friction law"),
    ("Brown-McPhee friction force too small", "brown_mcphee", "friction_force", lambda v, i: v * (1 - 1e-5), "friction law"),
    ("Stribeck friction force too large", "stribeck", "friction_force", lambda v, i: v * (1 + 1e-5), "friction law"),
    ("normal force of a conformal contact too large", "conformal", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("contact arc too wide", "conformal", "contact_half_angle", lambda v, i: v * (1 + 1e-5), "contact half-angle"),
    ("peak contact pressure too large", "conformal", "peak_pressure", lambda v, i: v * (1 + 1e-5), "peak pressure"),
    ("normal force of a Johnson contact too large", "johnson", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("normal force of a Pereira contact too large", "pereira", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("normal force of a liner too small", "liner", "normal_force", lambda v, i: v * (1 - 1e-5), "contact law"),
    ("normal force with dissipation too small", "dissipation", "normal_force", lambda v, i: v * (1 - 1e-5), "contact law"),
    ("rate of wear of a conformal contact too large", "conformal", "pin_wear_rate", lambda v, i: v * (1 + 1e-5), "rate of wear"),
    ("rate of wear of a liner too small", "liner", "bore_wear_rate", lambda v, i: v * (1 - 1e-5), "rate of wear"),
    ("rate of wear by asperities too large", "rough", "bore_wear_rate", lambda v, i: v * (1 + 1e-4), "rate of wear"),
    ("rate of wear that does not give the volume", "slap", "bore_wear_rate", lambda v, i: v * 1.01, "bore is not the integral of its rate"),
    ("rate of wear at the crank pin too large", "both", "crank_pin_pin_wear_rate", lambda v, i: v * (1 + 1e-5), "crank pin: rate of wear"),
    ("wear without contact", "both", "pin_wear_rate", lambda v, i: v or 1e-30, "rate of wear"),
    ("wear where the pin does not touch the bore", "both", "eccentricity_y", lambda v, i: -v, "pin is worn at other places"),
    ("wear of a worn bore too small", "worn", "bore_wear_rate", lambda v, i: v * 0.9, "bore is not the integral of its rate"),
    ("bristle deflection too large", "lugre", "bristle", lambda v, i: v * (1 + 1e-4), "friction law"),
    ("bristle deflection in free flight", "lugre", "bristle", lambda v, i: v or 1e-12, "no bristles bent"),
    ("bristle deflection twice too large", "elasto_plastic", "bristle", lambda v, i: 2 * v, "bristles bent by static friction"),
    ("bristle deflection that does not follow from its rate", "elasto_plastic", "bristle", lambda v, i: v * (1 + 0.1 * (i % 2)),
     "bristle is not the integral of its rate"),
    ("sliding speed too large", "dry", "sliding_speed", lambda v, i: v * (1 + 1e-6), "sliding speed"),
    ("normal force at the crank pin too large", "both", "crank_pin_normal_force", lambda v, i: v * (1 + 1e-5), "crank pin: contact law"),
    ("normal force too large, clearance at the crank pin only", "crank", "crank_pin_normal_force", lambda v, i: v * (1 + 1e-5),
     "crank pin: contact law"),
    ("friction force at the crank pin in the direction of sliding", "both", "crank_pin_friction_force", lambda v, i: -v,
     "crank pin: friction law"),
    ("sliding speed at the crank pin too large", "crank", "crank_pin_sliding_speed", lambda v, i: v * (1 + 1e-6), "crank pin: sliding speed"),
    ("crank pin force on the rod that is not that of the contact law", "both", "crankpin_force_y", lambda v, i: v * (1 + 1e-6),
     "crank pin: contact force on the pin"),
    ("eccentricity of the crank pin wrong", "both", "crank_pin_eccentricity_y", lambda v, i: v * (1 + 1e-5), "pin in the bearing, y"),
    ("eccentricity rate of the crank pin wrong", "both", "crank_pin_eccentricity_rate_x", lambda v, i: v * 1.001, "energy column"),
    ("eccentricity rate wrong, clearance at the crank pin only", "crank", "crank_pin_eccentricity_rate_y", lambda v, i: v + 1e-6,
     "pin speed, y"),
    ("film force at the crank pin too large", "films", "crank_pin_film_force_y", lambda v, i: v * (1 + 1e-5),
     "crank pin: film force on the pin"),
    ("rod acceleration wrong, clearance at both pins", "both", "rod_acceleration", lambda v, i: v * 1.001, "Euler, rod"),
    ("crank acceleration wrong, clearance at both pins", "both", "crank_acceleration", lambda v, i: v * 1.001, "Euler, crank"),
    ("normal force on a corner of the skirt too large", "slap", "guide_1_force", lambda v, i: v * (1 + 1e-5), "contact law of a corner"),
    ("friction force on a corner in the direction of sliding", "slap", "guide_2_friction", lambda v, i: -v, "friction law of a corner"),
    ("gap of a corner too large", "slap", "guide_3_gap", lambda v, i: v + 1e-12, "gap of a corner"),
    ("tilt acceleration of the piston wrong", "slap", "piston_tilt_acceleration", lambda v, i: v * 1.001, "Euler, piston"),
    ("lateral offset of the piston wrong", "slap", "piston_offset", lambda v, i: v + 1e-9, "pin in the bearing, y"),
    ("rate of the lateral offset wrong", "slap", "piston_offset_rate", lambda v, i: v * 1.001, "energy column"),
    ("tilt rate wrong", "slap", "piston_tilt_rate", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("guide force that is not the sum of the corner forces", "slap", "guide_force", lambda v, i: v * (1 + 1e-6),
     "force of the corners on the guide"),
    ("friction force on the piston wrong", "slap", "guide_friction_force", lambda v, i: v + 1e-3, "friction on the piston"),
    ("friction force on the guide too large", "guide", "guide_friction_force", lambda v, i: v * (1 + 1e-5), "friction on the guide"),
    ("friction force on the guide with the opposite sign", "guide", "guide_friction_force", lambda v, i: -v, "Newton, piston"),
    ("amplitude of a rod's transverse mode too large", "rod", "rod_mode_1", lambda v, i: v * (1 + 1e-6), "Lagrange, rod_mode_1"),
    ("stretch rate of the rod too large", "rod", "rod_stretch_rate", lambda v, i: v * 1.001, "energy column"),
    ("rate of an axial shape wrong", "rod", "rod_axial_3_rate", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("acceleration of an axial shape wrong", "rod", "rod_axial_2_acceleration", lambda v, i: v * 1.0001, "Lagrange, rod_axial_2"),
    ("crank pin force on an elastic rod wrong", "rod", "crankpin_force_y", lambda v, i: v * (1 + 1e-6), "Newton, rod along y"),
    ("angular acceleration of an elastic rod wrong", "rod", "rod_acceleration", lambda v, i: v * 1.0001, "Euler, rod"),
    ("angular acceleration of an elastic rod wrong, clearance at both pins", "rods", "rod_acceleration", lambda v, i: v * 1.0001, "Euler, rod"),
    ("acceleration of a rod's mode wrong, clearance at both pins", "rods", "rod_mode_2_acceleration", lambda v, i: v * 1.0001,
     "Lagrange, rod_mode_2"),
    ("stretch of the rod wrong", "bent", "rod_stretch", lambda v, i: v + 1e-9, "pin in the bearing, x"),
    ("stretch acceleration of the rod wrong", "bent", "rod_stretch_acceleration", lambda v, i: v * 1.001, "pin acceleration"),
    ("moment of an elastic crankshaft too large", "shaft", "crankshaft_moment", lambda v, i: v * (1 + 1e-6), "shaft's law"),
    ("angular acceleration of the flywheel wrong", "shaft", "flywheel_acceleration", lambda v, i: v * 1.001, "Euler, flywheel"),
    ("flywheel speed too large", "shaft", "flywheel_speed", lambda v, i: v * (1 + 1e-6), "energy column"),
    ("film force wrong", "film", "film_force_x", lambda v, i: v * 1.001, "film force on the pin"),
    ("film force too large where film and contact act together", "weighted", "film_force_y", lambda v, i: v * (1 + 1e-5),
     "contact force on the pin"),
    ("normal force too large where film and contact act together", "weighted", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("film eccentricity between elastic walls wrong", "elastic", "film_eccentricity_x", lambda v, i: v * (1 + 1e-5), "elastic walls"),
    ("wall deflection too large", "elastic", "wall_deflection", lambda v, i: v * (1 + 1e-6), "wall deflection"),
    ("film force of the variant as_printed wrong", "printed", "pin_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("tangential force of a thin oil's film with inertia wrong", "inertia", "pin_force_y", lambda v, i: v * (1 + 1e-4), "film law"),
    ("film force of the half film wrong", "half", "pin_force_y", lambda v, i: v * (1 + 1e-5), "film law"),
    ("film force of the short bearing wrong", "short", "pin_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("film force of the finite bearing wrong", "finite", "pin_force_x", lambda v, i: 1.05 * v, "film law"),
    ("film force of the oscillating film wrong", "contact", "pin_force_y", lambda v, i: v * (1 + 1e-4), "film law"),
    ("asperity force too large", "rough", "asperity_force", lambda v, i: v * (1 + 1e-4), "asperities"),
    ("boundary friction in the direction of sliding", "rough", "friction_force", lambda v, i: -v, "boundary friction"),
    ("film force between rough surfaces wrong", "rough", "film_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("film force between elastic walls wrong", "thickening", "film_force_x", lambda v, i: v * 1.001, "film law"),
    ("cylinder pressure too large", "film", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("cylinder pressure of a compressor too large", "compressor", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("cylinder pressure of a two-stroke engine too large", "two_stroke", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("temperature of the gas too high", "woschni", "gas_temperature", lambda v, i: v * 1.001, "state of the gas"),
    ("heat to the walls by Woschni's law too large", "woschni", "wall_heat_flow", lambda v, i: v * 1.001, "heat to the walls"),
    ("heat to the walls by Hohenberg's law too large", "hohenberg", "wall_heat_flow", lambda v, i: v * 1.001, "heat to the walls"),
    ("leak with the opposite sign", "woschni", "leak_flow", lambda v, i: -v, "leak"),
    ("flow through a valve too large", "valves", "discharge_flow", lambda v, i: v * 1.001, "discharge flow"),
    ("lift of a valve too large", "valves", "suction_valve_lift", lambda v, i: v * 1.001, "lift of the suction valve"),
    ("pressure of a compressor that drifts", "valves", "cylinder_pressure", lambda v, i: v * (1 + 1e-5 * i), "cylinder_pressure is not the integral"),
    ("flow back through a reed left out", "reeds", "discharge_flow", lambda v, i: max(v, 0.0), "discharge flow"),
    ("speed of a reed too large", "reeds", "discharge_valve_speed", lambda v, i: v * 1.001, "discharge_valve_speed is not the integral"),
    ("lift of a reed that drifts", "reeds", "suction_valve_lift", lambda v, i: v * (1 + 1e-5 * i), "suction_valve_lift is not the integral"),
    ("mass between ideal valves too large", "filled", "gas_mass", lambda v, i: v * 1.001, "state of the gas"),
    ("temperature between ideal valves too high", "filled", "gas_temperature", lambda v, i: v * 1.001, "temperature of the gas"),
    ("pressure that is not the measured one", "measured", "cylinder_pressure", lambda v, i: v * (1 + 1e-4), "gas law"),
    ("crank speed of a ramp wrong", "ramp", "crank_speed", lambda v, i: v * (1 + 1e-9), "held speed"),
    ("crank acceleration of a ramp wrong", "ramp", "crank_acceleration", lambda v, i: v * (1 + 1e-9), "held acceleration"),
    ("motor torque too large", "motor", "crank_moment", lambda v, i: v * (1 + 1e-9), "drive's torque"),
    ("gas force with the opposite sign", "film", "gas_force", lambda v, i: -v, "gas force"),
    ("cylinder volume wrong", "film", "cylinder_volume", lambda v, i: v * 1.001, "cylinder volume"),
    ("crank angle that is not the integral of the speed", "ideal", "crank_angle", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("force of a corner with a sharp contact too large", "sharp", "guide_1_force", lambda v, i: v * (1 + 1e-5), "contact law of a corner"),
    ("force of a thin film too large", "thin", "pin_force_x", lambda v, i: v * 1.001, "film law"),
    ("film force between elastic walls too large in long steps", "walls", "film_force_x", lambda v, i: v * 1.001, "film law"),
    ("amplitude of a fast shape wrong", "rigid", "rod_mode_2", lambda v, i: v * 1.001, "Lagrange, rod_mode_2"),
    ("rate of a slower shape wrong", "rigid", "rod_mode_1_rate", lambda v, i: v * 1.001, "is not the integral of its rate"),
    ("small force of the crank pin wrong", "held", "crankpin_force_x", lambda v, i: v + 1e-6, "crank pin: film force on the pin"),
    ("force of a corner that leaves the wall too large", "leaving", "guide_1_force", lambda v, i: v * (1 + 1e-5), "contact law of a corner"),
    ("film force beyond the place where it vanishes", "vanishing", "film_force_x", lambda v, i: v + 1e-3, "film law"),
    ("acceleration of an axial shape that is hardly loaded wrong", "unexcited", "rod_axial_2_acceleration", lambda v, i: v * 1.001, "Lagrange, rod_axial_2"),
    ("rod speed wrong by 5 % at a loose tolerance", "loose", "rod_speed", lambda v, i: v * 1.05, "is not the integral of its rate"),
    ("one value that is not a number", "dry", "crank_speed", lambda v, i: float("nan") if i == 50 else v, "Newton, crank"),
]

#: (wrong value, scene, key, value with which the program runs although it states the scene's value, text that the verdict must
#: contain)
LIARS = [
    ("wrong restitution", "dry", "contact.restitution", "0.89", "contact law"),
    ("wrong restitution, Gonthier", "johnson", "contact.restitution", "0.71", "contact law"),
    ("wrong restitution, Carvalho and Martins", "liner", "contact.restitution", "0.61", "contact law"),
    ("wrong restitution, exact damping", "conformal", "contact.restitution", "0.51", "contact law"),
    ("wrong housing compliance", "conformal", "contact.housing_compliance", "0.39", "contact law"),
    ("wrong bearing length", "johnson", "joint.bearing_length", "0.0401", "contact law"),
    ("wrong liner thickness", "liner", "contact.liner_thickness", "0.501e-3", "contact law"),
    ("wrong contact damping", "pereira", "contact.damping", "5.1e3", "contact law"),
    ("wrong depth of full damping", "pereira", "contact.full_damping_depth", "1.1e-6", "contact law"),
    ("wrong dissipation", "dissipation", "contact.dissipation", "0.41", "contact law"),
    ("wrong coefficient of friction", "dry", "friction.coefficient", "0.051", "friction law"),
    ("wrong static friction, Coulomb", "sticks", "friction.static_coefficient", "0.151", "friction law"),
    ("wrong static friction, Brown and McPhee", "brown_mcphee", "friction.static_coefficient", "0.151", "friction law"),
    ("wrong transition speed", "stribeck", "friction.transition_speed", "0.11", "friction law"),
    ("wrong bristle stiffness", "lugre", "friction.bristle_stiffness", "2.01e4", "friction law"),
    ("wrong bristle damping", "lugre", "friction.bristle_damping", "0.0101", "friction law"),
    ("wrong damping of the crank", "ideal", "drive.damping", "0.031", "Euler, crank"),
    ("wrong heat of combustion", "film", "combustion.heat", "166.0", "gas law"),
    ("wrong moment of inertia of the piston", "slap", "guide.piston_inertia", "2.001e-5", "Euler, piston"),
    ("wrong length of the skirt", "slap", "guide.skirt_top", "0.0151", "gap of a corner"),
    ("wrong clearance of the bore", "slap", "guide.bore_clearance", "101e-6", "gap of a corner"),
    ("wrong viscous friction of the guide", "guide", "guide.viscous", "3.01", "friction on the guide"),
    ("wrong section area of the rod", "rod", "elastic_rod.section_area", "9.599e-5", "Lagrange, rod_axial_4"),
    ("wrong section inertia of the rod", "rods", "elastic_rod.section_inertia", "5.121e-10", "Lagrange, rod_mode_2"),
    ("wrong damping ratio of the rod", "rod", "elastic_rod.axial_damping_ratio", "0.01999", "Lagrange, rod_stretch"),
    ("wrong mass of the rod's shank", "bent", "elastic_rod.shank_mass", "0.2099", "Lagrange, rod_mode_1"),
    ("wrong torsional stiffness", "shaft", "crankshaft.torsional_stiffness", "1.9999e4", "shaft's law"),
    ("wrong flywheel inertia", "shaft", "crankshaft.flywheel_inertia", "0.004001", "Euler, flywheel"),
    ("wrong viscosity", "film", "lubrication.viscosity", "0.0118", "film law"),
    ("wrong transition depth", "weighted", "lubrication.transition_depth", "3.001e-6", "contact law"),
    ("wrong least film ratio", "weighted", "lubrication.least_film_ratio", "0.0299", "film law"),
    ("wrong viscosity where film and contact act together", "weighted", "lubrication.viscosity", "0.0201", "film law"),
    ("wrong compliance of the walls under the film", "elastic", "contact.housing_compliance", "0.3864", "elastic walls"),
    ("wrong viscosity, half film", "half", "lubrication.viscosity", "0.0118", "film law"),
    ("wrong viscosity, short bearing", "short", "lubrication.viscosity", "0.0118", "film law"),
    ("wrong cavitation condition", "finite", "lubrication.cavitation", "'none'", "film law"),
    ("wrong roughness", "rough", "asperities.roughness", "0.401e-6", "asperities"),
    ("wrong coefficient of boundary friction", "rough", "asperities.coefficient", "0.101", "boundary friction"),
    ("wrong oil temperature", "warm", "lubrication.temperature", "350.1", "film law"),
    ("wrong pressure-viscosity coefficient", "thickening", "lubrication.pressure_viscosity", "1.9e-8", "film law"),
    ("wrong piston mass", "ideal", "mechanism.piston_mass", "0.92", "Newton, piston"),
    ("wrong direction of gravity", "both", "mechanism.gravity_angle_deg", "25.01", "Newton, crank"),
    ("wrong rod mass, clearance at both pins", "both", "mechanism.rod_mass", "0.2101", "energy column"),
    ("wrong gravity", "film", "mechanism.gravity", "9.8", "Newton, piston"),
    ("a larger tolerance than stated, in contact", "contact", "integrator.relative_tolerance", "1e-4", "grown tolerances from"),
    ("a larger tolerance than stated, in a film", "short", "integrator.relative_tolerance", "1e-3", "grown tolerances from"),
    ("a larger tolerance than stated, with a crankshaft that twists", "shaft", "integrator.relative_tolerance", "1e-3", "grown tolerances from"),
    ("wrong viscosity of a thin film", "thin", "lubrication.viscosity", "0.0118", "film law"),
    ("wrong viscosity between elastic walls", "walls", "lubrication.viscosity", "0.01171", "film law"),
    ("wrong piston mass in one method alone", "dry", "mechanism.piston_mass", "0.25", "beyond the horizon"),
]

#: Scenes whose states must be within the allowed distance of a run by the other method.
COMPARED = ("twisted", "thick", "kicked")

#: (wrong line, file, text of the line, its text in the mutant, scene, text that the verdict must contain)
MUTANTS = [
    ("contact damping with the opposite sign", "contact_law.f90", "1 + self%damping*min(", "1 - self%damping*min(", "dry", "contact law"),
    ("dissipation one part in a thousand too large", "contact_law.f90", "max(0.0_dp, 1 + self%dissipation*",
     "max(0.0_dp, 1 + 1.001_dp*self%dissipation*", "dissipation", "contact law"),
    ("exact damping one part in a thousand too large", "exact_restitution.f90", "damping = one_minus_exp(y)/e",
     "damping = 1.001_dp*one_minus_exp(y)/e", "conformal", "contact law"),
    ("a constant of Johnson's law one part in a thousand too large", "johnson.f90", "m = log(4.0_dp) - 1 - log(d)",
     "m = log(4.0_dp) - 1.001_dp - log(d)", "johnson", "contact law"),
    ("a coefficient of the conformal fit wrong", "conformal.f90", " 1.74709353_dp", " 1.75709353_dp", "conformal", "contact law"),
    ("peak pressure of the conformal contact too small", "conformal.f90", "(2*r/(sqrt(b**2 + 1)", "(r/(sqrt(b**2 + 1)",
     "conformal", "peak pressure"),
    ("Pereira's exponent wrong", "pereira.f90", "1.51_dp*log", "1.511_dp*log", "pereira", "contact law"),
    ("the Winkler foundation without the small difference of the radii", "winkler.f90",
     "self%clearance*excess_over_sine(a))", "0*excess_over_sine(a))", "liner", "contact law"),
    ("friction in the direction of sliding", "ambrosio.f90", "ratio = -sign(ratio, sliding_speed)",
     "ratio = sign(ratio, sliding_speed)", "dry", "friction law"),
    ("a constant of the Brown-McPhee law wrong", "brown_mcphee.f90", "0.25_dp*u**2 + 0.75_dp)**2", "0.25_dp*u**2 + 0.76_dp)**2",
     "brown_mcphee", "friction law"),
    ("rate of the LuGre bristles one percent wrong", "lugre.f90", "abs(v)*z/g\n  end function",
     "0.99_dp*abs(v)*z/g\n  end function", "lugre", "bristle is not the integral"),
    ("film force one part in a thousand too large while the pin withdraws", "pinkus_sternlicht.f90",
     "if (eps_dot < 0) radial = self%withdrawal_sign*radial", "if (eps_dot < 0) radial = self%withdrawal_sign*(1.001_dp*radial)",
     "film", "film law"),
    ("withdrawal force of the variant as_printed with the opposite sign", "pinkus_sternlicht.f90", "self%withdrawal_sign = -1",
     "self%withdrawal_sign = 1", "printed", "film law"),
    ("radial force of the half film too large", "half_film.f90", "radial = -scale*((square*",
     "radial = -1.001_dp*scale*((square*", "half", "film law"),
    ("tangential force of the short bearing wrong", "short_bearing.f90", "cs = 2*eps*s**3", "cs = 2.002_dp*eps*s**3", "short", "film law"),
    ("Reynolds's cavitation condition ignored", "finite_film.f90", "if (cavitation == cavitation_reynolds) call find_film",
     "if (cavitation < 0) call find_film",
     "finite", "film law"),
    ("Gumbel's cavitation condition ignored", "finite_film.f90", "if (cavitation == cavitation_gumbel) then",
     "if (cavitation < 0) then", "gumbel", "film law"),
    ("film thickness of the direct solution too small", "reynolds_grid.f90", "height = gap + 2*(1 - gap)",
     "height = gap + 1.9_dp*(1 - gap)", "direct", "film law"),
    ("tangential force from the table too small in one direction", "film_map.f90", "if (t < 0) tangential = -tangential",
     "if (t < 0) tangential = -0.9_dp*tangential", "finite", "film law"),
    ("table without cavitation scaled like one with cavitation", "film_map.f90", "      s_r = b/(w2*w)",
     "      s_r = abs(b)/(w2*w)", "full", "film law"),
    ("half of the wedge speed", "finite_bearing.f90", "[v(1) + 0.5_dp*motion%pin_speed*e(2), v(2) - 0.5_dp*motion%pin_speed*e(1)]",
     "[v(1) + 0.25_dp*motion%pin_speed*e(2), v(2) - 0.25_dp*motion%pin_speed*e(1)]", "short", "film law"),
    ("shear of the oscillating film one percent too large", "oscillating_film.f90", "along*(real(response%shear) -",
     "along*(1.01_dp*real(response%shear) -",
     "contact", "film law"),
    ("wear at the crank pin in the wrong direction", "wear_record.f90", "angles(of_bore) = scene%chain%body_angle(now%motion, site%bearing)",
     "angles(of_bore) = -scene%chain%body_angle(now%motion, site%bearing)", "both", "crank_pin_bore is worn at other places"),
    ("wear in a piston that tilts without the tilt", "wear_record.f90", "angles(of_bore) = scene%chain%body_angle(now%motion, site%bearing)",
     "angles(of_bore) = -50*scene%chain%body_angle(now%motion, site%bearing)", "slap", "bore is worn at other places"),
    ("wear along lines of contact too large", "wear_record.f90", "on_line = on_line + shares(i)", "on_line = on_line + 1.01_dp*shares(i)",
     "both", "is not the integral of its rate"),
    ("wear on arcs of contact counted by the normal force alone", "clearance_joint.f90", "sliding_load*ratio", "sliding_load*(0.9_dp + 0.1_dp*ratio)",
     "conformal", "rate of wear"),
    ("depth of wear of the pin with the radius of the bore", "wear_record.f90", "merge(joint%pin_radius, joint%bearing%radius, k == of_pin)",
     "joint%bearing%radius", "both", "are not those of the summary"),
    ("density of asperities wrong", "asperities.f90", "self%density_product**2*sqrt", "self%density_product**2*1.001_dp*sqrt",
     "rough", "asperities"),
    ("transition speed of the boundary friction halved", "asperities.f90", "*tanh(sliding_speed/self%transition_speed)",
     "*tanh(2*sliding_speed/self%transition_speed)", "rough",
     "boundary friction"),
    ("radial speed in a film of rough surfaces without the slope of the gap", "mixed_film.f90", "slope*radial*n + ratio",
     "radial*n + ratio", "rough", "film law"),
    ("limit of the film thickness in the transition wrong", "film_transition.f90", "(1 - least_film_ratio)*bearing%clearance",
     "(1 - 1.01_dp*least_film_ratio)*bearing%clearance", "weighted",
     "film law"),
    ("film between elastic walls without their rotation", "elastic_film.f90", " + drawn*[-e(2), e(1)]", "", "elastic", "film law"),
    ("pressure-viscosity effect halved", "elastic_film.f90", "self%per_area*norm2(load))", "0.5_dp*self%per_area*norm2(load))",
     "thickening", "film law"),
    ("oil temperature 0.1 K too high", "oil_viscosity.f90", "(log(self%temperature) - x(1))",
     "(log(self%temperature + 0.1_dp) - x(1))", "warm", "film law"),
    ("share of the film in the transition wrong", "film_transition.f90", "w = s**2*(3 - 2*s)", "w = s**2*(2.999_dp - 2*s)",
     "weighted", "contact law"),
    ("sliding speed of the crank pin without part of the bearing's rotation", "joint_evaluation.f90",
     "- joint%bearing_speed*(joint%distance + pin_radius)",
     "- joint%bearing_speed*pin_radius", "both", "crank pin: sliding speed"),
    ("friction of a corner without its moment on the piston", "skirt_corners.f90",
     "*corner%normal_force - corner%from_com(2)*corner%friction_force", "*corner%normal_force",
     "slap", "Euler, piston"),
    ("Coriolis force on the rod's shapes wrong", "elastic_rod_body.f90", "on_shape(n + j) = -2*turn*",
     "on_shape(n + j) = -2.001_dp*turn*", "rod", "Lagrange, rod_"),
    ("chord of the rod without its second-order shortening by bending", "elastic_rod_body.f90", " - second)", ")", "rod", "Newton, rod along x"),
    ("bending of the rod without the axial load", "elastic_rod_body.f90", "- 2*rod%shortening(k)*motion%shape(k)*pin(1) + dot",
     "+ dot", "rod", "Lagrange, rod_mode_1"),
    ("rate of the chord's shortening by bending five percent too small", "elastic_rod_piece.f90", "chord = -2*sum(rod%shortening",
     "chord = -1.9_dp*sum(rod%shortening", "rod",
     "energy not kept"),
    ("torsional damping with the opposite sign", "elastic_crankshaft.f90", "self%damping*(motion%flywheel_speed - motion%crank_speed)\n",
     "self%damping*(motion%crank_speed - motion%flywheel_speed)\n", "shaft", "shaft's law"),
    ("moment on the rod without that of the eccentric pin force", "chain_loads.f90", "-(moment + eccentricity(1)",
     "-(moment + 0*eccentricity(1)", "both", "Euler, rod"),
    ("valve of the compressor opens too late", "valve_gas.f90", "*(1 - opening_margin)", "*0.999_dp", "compressor", "gas law"),
    ("interpolation of the measured pressure wrong", "monotone_cubic.f90", "0.5_dp*abs(parabola))*2", "0.5_dp*abs(parabola))*2.2_dp",
     "measured", "gas law"),
    ("gas pressure one part in a thousand too large", "gas_cycle.f90", "values(i) = p*(volume", "values(i) = 1.001_dp*p*(volume",
     "film", "gas law"),
    ("a constant of Woschni's law wrong", "woschni.f90", "h = 3.26_dp*", "h = 3.27_dp*", "woschni", "heat to the walls"),
    ("enthalpy of the incoming gas with the temperature of the cylinder", "cylinder_charge.f90", "now%valve_flow(k)*temperature(merge(1, 2, excess(k) >= 0), k)",
     "now%valve_flow(k)*now%temperature", "valves", "cylinder_pressure is not the integral"),
    ("damper of a reed with the opposite sign", "valve_reeds.f90", "- valve%damping*", "+ valve%damping*", "reeds", "suction_valve_speed is not the integral"),
    ("flow through an orifice without its parabola", "nozzle_flow.f90", "if (y < 1) psi = psi*y*(3 - y)/2", "if (y < 1) psi = psi*y", "woschni", "leak"),
]


def traced(program: Path, scene: str) -> Run:
    """A run with rows at every step and on a regular grid; if the first run ends early, that run."""
    name, settings = SCENES[scene]
    case, plain = ROOT / "cases" / f"{name}.nml", {**settings, "output.digits": "17", "output.ideal_twin": ".false."}
    plain |= requested(run_case(program, case, plain))
    first = run_case(program, case, {**plain, "output.every_step": ".true."})
    if first.status:
        return first
    return merged(first, run_case(program, case, {**plain, "output.interval": repr(float(first.summary["simulated_time"]) / 4000)}))


def changed(run: Run, column: str, change: Callable[[float, int], float]) -> Run:
    own = {column: [change(value, i) for i, value in enumerate(run.every[column])]}
    return dataclasses.replace(run, columns=run.columns | {name: own[name] for name in own if name in run.columns}, every=run.every | own)


def corrupted(program: Path, scene: str) -> list[Finding]:
    """Check that a correct run passes, and that the check of a column fails if the column is changed."""
    found: list[Finding] = []
    run = traced(program, scene)
    verdict = judge_files(copy.deepcopy(run))
    if run.status:
        return [(False, f"{scene}: sound", "; ".join(verdict.faults))]
    found.append((not verdict.faults, f"{scene}: sound", "; ".join(verdict.faults)))
    found.append((verdict.checks > 10 and (verdict.energy is not None or scene == "engine"), f"{scene}: checked", "; ".join(summary_of(verdict))))
    phases = set(run.columns.get("phase", [0.0]))
    found.append((phases == PHASES[scene], f"{scene}: has the phases that the test needs", str(phases)))
    for what, where, column, change, says in CORRUPTIONS:
        if where == scene:
            faults = judge_files(changed(run, column, change)).faults
            found.append((any(says in fault for fault in faults), f"{what}: found by the judge", "; ".join(faults) or "no fault found"))
    return found


LIAR = """#!/usr/bin/env python3
# Runs a program with one value changed, but writes the unchanged value into the resolved case.
import re, subprocess, sys
from pathlib import Path
words, key, value = sys.argv[1:], {key!r}, {value!r}
out, group, name = words[words.index("-o") + 1], *key.split(".")
instead = [] if {once} and any("relative_tolerance=" in word for word in words) else ["--set", key + "=" + value]
code = subprocess.run([{program!r}, *words[:-1], *instead, words[-1]]).returncode
for file in Path(out).glob("*.resolved.nml"):
    text = file.read_text()
    file.write_text(re.sub(r"(?<=\\n  )" + name + r" = \\S+", name + " = " + {said!r}, text) if instead else text)
sys.exit(code)
"""


def liar(file: Path, program: Path, key: str, value: str, said: float, once: bool) -> Path:
    """A program that runs with one value and states another in the resolved case. `once`: it uses the stated value if a tolerance
    is given, as in the runs for comparison."""
    file.write_text(LIAR.format(program=str(program.resolve()), key=key, value=value, said=repr(said), once=once))
    file.chmod(0o755)
    return file


def lied(program: Path, folder: Path, number: int) -> list[Finding]:
    """Check that a program with other physics than it states is detected."""
    what, scene, key, value, says = LIARS[number]
    name, settings = SCENES[scene]
    case = ROOT / "cases" / f"{name}.nml"
    said = run_case(program, case, {**settings, "output.ideal_twin": ".false."}).number(key)
    lies = liar(folder / f"liar{number}", program, key, value, said, once="tolerance" in what or "method alone" in what)
    verdict = judge_scene(lies, case, settings)
    return [(any(says in fault for fault in verdict.faults), f"a program with {what}: found by the judge", "; ".join(summary_of(verdict)))]


def compared(program: Path, scene: str) -> list[Finding]:
    """Check that a correct run passes with all its comparisons."""
    name, settings = SCENES[scene]
    verdict = judge_scene(program, ROOT / "cases" / f"{name}.nml", settings)
    agree = verdict.states is not None and not verdict.states.unjudged and not verdict.faults
    return [(agree, f"{scene}: sound, and as by the other method", "; ".join(summary_of(verdict)))]


def test_judge(program: Path, folder: Path, jobs: int | None) -> None:
    """All scenes, changed columns and false programs, in several processes."""
    missing = {where for _, where, _, _, _ in CORRUPTIONS} - set(SCENES)
    check(not missing, "every changed column has a scene", str(missing))
    with ProcessPoolExecutor(jobs) as pool:
        tasks = [pool.submit(corrupted, program, scene) for scene in SCENES]
        tasks += [pool.submit(compared, program, scene) for scene in COMPARED]
        tasks += [pool.submit(lied, program, folder, number) for number in range(len(LIARS))]
        for task in tasks:
            for finding in task.result():
                check(*finding)


def test_quadrature() -> None:
    """The error of an integral over a piece of one row is within its bound; an interval much longer than those before it."""
    times, pieces = [0.0, 1.0, 2.0, 3.0], [[0, 1, 2], [3]]
    found = integral(times, stencils(times, pieces, joined=False))
    check(abs(found.value[-1] - 4.5) <= SAFETY * found.bound[-1], "an integral over a piece of one row is within its bound",
          f"{found.value[-1]} +- {found.bound[-1]}, 4.5 expected")
    times = [i * 1e-16 for i in range(10)] + [5e-10 * 2**i for i in range(6)]
    values = [1e-4 * (-1)**i if i < 10 else 0.0 for i in range(16)]   # a vibration that is not resolved, and then none
    found = integral(values, stencils(times, [list(range(16))], joined=False))
    check(max(map(abs, found.value)) <= 1e-13, "rows that are very close to each other do not make the next integral wrong", f"{found.value[-1]}, 0 expected")


def test_draw() -> None:
    """The scenes of tests/judge/extremes wear at the pin, at the bore or at both."""
    loader = importlib.machinery.SourceFileLoader("extremes", str(ROOT / "tests" / "judge" / "extremes"))
    spec = importlib.util.spec_from_loader("extremes", loader)
    assert spec
    extremes = sys.modules["extremes"] = importlib.util.module_from_spec(spec)
    loader.exec_module(extremes)
    rates = [extremes.wear(random.Random(i), {"integrator.revolutions": "1.0"}, True)["wear.rate"] for i in range(500)]
    check("0.0,0.0" not in rates and any("0.0" in rate for rate in rates), "extreme scenes wear at the pin, at the bore or at both",
          f"{rates.count('0.0,0.0')} of {len(rates)} do not wear")


def test_options(program: Path) -> None:
    """Wrong options end with exit status 2 and a message, and nothing is counted as passed."""
    case = ROOT / "cases" / "sim_I.nml"
    for words, said in ((("judge", case, "--set", "bad"), "--set bad: must have the form GROUP.KEY=VALUE"),
                        (("extremes", "--scenes", "0"), "--scenes 0: must be >= 1"),
                        (("extremes", "--scenes", "3", "--again", "99"), "--again 99: the scenes are 0 to 2")):
        outcome = subprocess.run([ROOT / "tests" / "judge" / words[0], *words[1:], "--program", program], capture_output=True, text=True, check=False)
        check(outcome.returncode == 2 and said in outcome.stderr and "passed" not in outcome.stdout,
              f"{words[0]} {words[-2]} {words[-1]} is refused", f"{outcome.returncode} {outcome.stdout}{outcome.stderr}")


class Mutants:
    """Copies of the program with one wrong line each. The whole program is compiled once. For each copy only the changed file is
    compiled, and linked before the library; this is valid because the lines are in procedures: its module file must stay the same."""

    FLAGS = ("-O1", "-fopenmp", "-fimplicit-none")

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        tree = folder / "whole"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", ".git", ".venv", "results", "__pycache__"))
        path = {**os.environ, "PATH": f"{ROOT / '.venv' / 'bin'}:{os.environ['PATH']}"}
        built = subprocess.run(["fpm", "build", "--flag", "-O1"], cwd=tree, env=path, capture_output=True, text=True, check=False)
        libraries, mains = list(tree.glob("build/*/gudgeon/libgudgeon.a")), list(tree.glob("build/*/gudgeon/src_main.f90.o"))
        if built.returncode or not libraries or not mains:
            sys.exit(f"{built.stderr[-300:]}\n0 passed, 1 failed")
        self.library, self.main = libraries[0], mains[0]
        self.modules = self.main.parent.parent

    def program(self, number: int, source: Path, old: str, new: str) -> tuple[Path | None, str]:
        """The program in which `new` replaces `old`, or the reason why there is none."""
        text = source.read_text()
        if text.count(old) != 1:
            return None, f"the line is {text.count(old)} times in {source.name}"
        own = self.folder / f"mutant{number}"
        own.mkdir()
        changed_source, program = own / source.name, own / "gudgeon"
        changed_source.write_text(text.replace(old, new))
        words = ["gfortran", *self.FLAGS, "-J", str(own), "-I", str(self.modules)]
        compiled = subprocess.run([*words, "-c", str(changed_source), "-o", str(own / "mutant.o")], capture_output=True, text=True, check=False)
        if compiled.returncode:
            return None, compiled.stderr[-300:]
        for module in (*own.glob("*.mod"), *own.glob("*.smod")):
            if module.read_bytes() != (self.modules / module.name).read_bytes():
                return None, f"the interface {module.name} changes"
        linked = subprocess.run([*words, str(self.main), str(own / "mutant.o"), str(self.library), "-o", str(program)],
                                capture_output=True, text=True, check=False)
        return (None, linked.stderr[-300:]) if linked.returncode else (program, "")

    def judged(self, number: int) -> Finding:
        """Whether the judge, or the program itself by its balance of energy, finds the wrong line."""
        what, file, old, new, scene, says = MUTANTS[number]
        name = f"mutant ({what}): found by the judge"
        program, reason = self.program(number, next((ROOT / "src").rglob(file)), old, new)
        if not program:
            return False, name, reason
        os.environ["XDG_CACHE_HOME"] = str(program.parent)   # a mutant must not use tables of films of others
        run = traced(program, scene)
        if run.status == STOPPED and run.summary.get("status", "").startswith(("energy not kept", "energy of the gas not kept")):
            print(f"{name}: not needed, the program stops by itself: {run.summary['status']}", flush=True)
            return True, name, ""
        faults = judge_files(run).faults
        return any(says in fault for fault in faults), name, "; ".join(faults) or "no fault found"


def test_mutants(folder: Path, part: str, jobs: int | None) -> None:
    """Build and judge copies of the program with one wrong line, for the lines in src/part."""
    chosen = [number for number, mutant in enumerate(MUTANTS) if list((ROOT / "src" / part).rglob(mutant[1]))]
    check(chosen, "the folder contains a wrong line", f"src/{part}")
    mutants = Mutants(folder)
    with ProcessPoolExecutor(jobs) as pool:
        for finding in pool.map(mutants.judged, chosen):
            check(*finding)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="program to test (default: the release build)")
    parser.add_argument("--mutants", nargs="?", const="", metavar="FOLDER",
                        help="only build and judge copies of the program with a wrong line, or those whose line is in src/FOLDER")
    parser.add_argument("--jobs", type=int, metavar="N", help="number of processes (default: one for each processor core)")
    options = parser.parse_args()
    program = options.program
    if not program and options.mutants is None:
        run = subprocess.run([ROOT / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
        if run.returncode:
            sys.exit(f"{run.stderr}\n0 passed, 1 failed")
        program = ROOT / run.stdout.strip()
    with tempfile.TemporaryDirectory(prefix="judge") as folder:
        if options.mutants is not None:
            test_mutants(Path(folder), options.mutants, options.jobs)
        else:
            test_quadrature()
            test_draw()
            test_options(program)
            test_judge(program, Path(folder), options.jobs)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
