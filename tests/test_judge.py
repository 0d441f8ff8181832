#!/usr/bin/env python3
"""Whether the independent judge of runs (scripts/scene_judge) sees what is wrong.

    tests/test_judge.py [--program FILE] [--mutants [FOLDER]]

Sound runs must pass. Then each column of their traces is changed a little, by a sign or a part in a thousand; programs say that they
ran one case and ran another (another restitution, friction, damping, heat), or with a looser tolerance than asked for: the check
that is meant for it must go red. --mutants builds copies of the program with one line of their physics broken, and judges those, or only those
whose line is in src/FOLDER: half a minute or so each. Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import copy
import dataclasses
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Callable

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
from assertions import Assertions  # noqa: E402
from scene_judge.elastic import requested_columns  # noqa: E402
from scene_judge.trace import Run, merged, run_case  # noqa: E402
from scene_judge.verdict import judge_files, judge_scene, summary_of  # noqa: E402

assertions = Assertions()
check = assertions.check

Finding = tuple[bool, str, str]   # whether an assertion holds, its name, what was found instead

SMALL_TABLE = {"lubrication.table_points": "33", "lubrication.film_points": "64"}
OIL = {f"lubrication.{key}": value for key, value in {"viscosity": "0", "viscosity_law": "'walther'", "temperature": "350", "density": "870",
                                                      "known_temperatures": "313.15, 373.15", "known_viscosities": "1e-4, 1.1e-5"}.items()}

#: Runs by name: the case, and settings that keep it short. Between them they have every law and both joints.
SCENES = {
    "dry": ("flores/friction_050", {"integrator.revolutions": "0.3"}),
    "sticks": ("friction/coulomb_static", {"integrator.revolutions": "0.3"}),
    "threlfall": ("flores/friction_050", {"integrator.revolutions": "0.15", "friction.law": "threlfall", "friction.v1": "0.4"}),
    "brown_mcphee": ("friction/brown_mcphee", {"integrator.revolutions": "0.15", "friction.viscous_coefficient": "0.01",
                                               "friction.transition_speed": "0.2"}),
    "stribeck": ("friction/brown_mcphee", {"integrator.revolutions": "0.15", "friction.law": "stribeck", "friction.stribeck_speed": "0.3",
                                           "friction.transition_speed": "0.1"}),
    "conformal": ("contact/conformal_exact", {"integrator.revolutions": "0.15"}),
    "johnson": ("contact/johnson_gonthier", {"integrator.revolutions": "0.15"}),
    "liner": ("contact/liner_carvalho_martins", {"integrator.revolutions": "0.15"}),
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
    "measured": ("gas/measured", {"integrator.method": "'auto'", "integrator.revolutions": "0.5", "initial.crank_angle_deg": "300",
                                  "cylinder_pressure.offset_deg": "-17.3"}),
    "ramp": ("drive/start_up", {"integrator.method": "'auto'", "integrator.end_time": "0.05", "output.interval": "2.5e-4"}),
    "motor": ("drive/motor", {"integrator.method": "'auto'", "integrator.end_time": "0.1", "output.interval": "5e-4"}),
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
    "rough": ("film/sim_IV_mixed", {"integrator.revolutions": "1.2", "initial.crank_angle_deg": "170", "lubrication.variant": "short"}),
    "warm": ("sim_I", {"integrator.method": "'auto'", "integrator.revolutions": "0.2", **OIL}),
    "both": ("joints/both_pins", {"integrator.revolutions": "0.2", "drive.kind": "'free'", "mechanism.gravity_angle_deg": "25"}),
    "crank": ("joints/crank_pin", {"integrator.revolutions": "0.2", "integrator.relative_tolerance": "1e-7"}),
    "slap": ("joints/piston_slap", {"integrator.revolutions": "0.3", "mechanism.gravity_angle_deg": "25"}),
    "guide": ("flores/ideal", {"drive.kind": "'free'", "mechanism.gravity": "9.8", "guide.law": "threlfall", "guide.coefficient": "0.1", "guide.v1": "0.5",
                               "guide.viscous": "3"}),
    "films": ("joints/both_pins_lubricated", {"integrator.revolutions": "0.5"}),
    # so exactly that what the rod's bending draws of its chord tells, some 1e-5 of the energy
    "rod": ("elastic/dry_friction", {"integrator.revolutions": "0.1", "integrator.relative_tolerance": "1e-8", "drive.kind": "'free'", "mechanism.gravity": "1000",
                                     "mechanism.gravity_angle_deg": "25"}),
    "rods": ("joints/both_pins", {"integrator.revolutions": "0.05", "elastic_rod.section_area": "9.6e-5", "elastic_rod.section_inertia": "5.12e-10"}),
    "shaft": ("elastic/engine_crankshaft", {"integrator.revolutions": "0.3"}),
    "bent": ("flores/ideal", {"integrator.revolutions": "0.3", "elastic_rod.section_area": "9.6e-5", "elastic_rod.section_inertia": "5.12e-10",
                              "drive.kind": "'free'", "mechanism.gravity": "9.8"}),
    "ideal": ("flores/ideal", {"drive.kind": "'free'", "drive.damping": "0.03", "mechanism.gravity": "9.8", "initial.crank_angle_deg": "20"}),
}

PHASES = {**dict.fromkeys(("thickening", "printed", "half", "short", "finite", "gumbel", "full", "direct", "rough", "warm"), {1}),
          "dry": {0, 2}, "sticks": {0, 2}, "threlfall": {0, 2}, "brown_mcphee": {0, 2}, "stribeck": {0, 2}, "lugre": {0, 2},
          "elasto_plastic": {0, 2}, "conformal": {0, 2}, "johnson": {0, 2},
          "liner": {0, 2}, "pereira": {0, 2}, "dissipation": {0, 2}, "film": {1}, "contact": {1, 2}, "weighted": {1, 2}, "elastic": {1},
          "compressor": {1}, "two_stroke": {1}, "measured": {1}, "ramp": {1}, "motor": {1}, "both": {0, 2}, "crank": {0}, "films": {1},
          "slap": {0, 2}, "guide": {0}, "ideal": {0}, "rod": {0, 2}, "rods": {0, 2}, "shaft": {1}, "bent": {0}}   # 0 free flight, 1 film, 2 contact

#: (what is changed, scene, column, change of (value, row), what the verdict must say)
CORRUPTIONS: list[tuple[str, str, str, Callable[[float, int], float], str]] = [
    ("kinetic energy a part in a million too large", "dry", "energy", lambda v, i: v * (1 + 1e-6), "energy column"),
    ("residual of energy claimed to be large", "dry", "energy_residual", lambda v, i: v + 1.0, "column energy_residual"),
    ("joint's force along x off by a part in a million", "dry", "pin_force_x", lambda v, i: v * (1 + 1e-6), "Newton, piston"),
    ("joint's force along y with the other sign", "dry", "pin_force_y", lambda v, i: -v, "guide force"),
    ("guide force with the other sign", "film", "guide_force", lambda v, i: -v, "guide force"),
    ("force on the rod off", "film", "crankpin_force_y", lambda v, i: v * 1.001, "Newton, rod along y"),
    ("force on the crank's bearing off", "film", "crank_bearing_force_x", lambda v, i: v * 1.001, "Newton, crank along x"),
    ("force on the frame off", "film", "frame_force_x", lambda v, i: v * 1.001, "force on the frame, x"),
    ("crank acceleration off", "film", "crank_acceleration", lambda v, i: v * 1.001, "Euler, crank"),
    ("rod acceleration off", "film", "rod_acceleration", lambda v, i: v * 1.001, "Euler, rod"),
    ("piston acceleration with the other sign", "ideal", "piston_acceleration", lambda v, i: -v, "Newton, piston"),
    ("crank moment that drives", "film", "crank_moment", lambda v, i: v + 1.0, "Euler, crank"),
    ("piston in another place", "film", "piston_position", lambda v, i: v + 1e-9, "pin in the bearing, x"),
    ("eccentricity of another pin", "contact", "eccentricity_y", lambda v, i: v * 1.001, "pin in the bearing, y"),
    ("thicker film", "film", "film_thickness", lambda v, i: v * (1 + 1e-9), "film thickness"),
    ("harder contact", "contact", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("friction with the sliding", "contact", "friction_force", lambda v, i: -v, "friction law"),
    ("friction at rest above the static one", "sticks", "friction_force", lambda v, i: v * 1.2, "friction law"),
    ("a little more friction of Threlfall", "threlfall", "friction_force", lambda v, i: v * (1 + 1e-5), "friction law"),
    ("a little less friction of Brown and McPhee", "brown_mcphee", "friction_force", lambda v, i: v * (1 - 1e-5), "friction law"),
    ("a little more friction of Stribeck", "stribeck", "friction_force", lambda v, i: v * (1 + 1e-5), "friction law"),
    ("a little harder conformal contact", "conformal", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("a wider arc", "conformal", "contact_half_angle", lambda v, i: v * (1 + 1e-5), "contact half-angle"),
    ("more pressure in the middle", "conformal", "peak_pressure", lambda v, i: v * (1 + 1e-5), "peak pressure"),
    ("a little harder contact of Johnson", "johnson", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("a little harder contact of Pereira", "pereira", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("a little softer liner", "liner", "normal_force", lambda v, i: v * (1 - 1e-5), "contact law"),
    ("a little less dissipation", "dissipation", "normal_force", lambda v, i: v * (1 - 1e-5), "contact law"),
    ("bristles a little more bent", "lugre", "bristle", lambda v, i: v * (1 + 1e-4), "friction law"),
    ("bristles bent in free flight", "lugre", "bristle", lambda v, i: v or 1e-12, "no bristles bent"),
    ("bristles bent too far", "elasto_plastic", "bristle", lambda v, i: 2 * v, "bristles bent by static friction"),
    ("bristles of another history", "elasto_plastic", "bristle", lambda v, i: v * (1 + 0.1 * (i % 2)), "bristle is not the integral of its rate"),
    ("faster sliding", "dry", "sliding_speed", lambda v, i: v * (1 + 1e-6), "sliding speed"),
    ("harder contact at the crank pin", "both", "crank_pin_normal_force", lambda v, i: v * (1 + 1e-5), "crank pin: contact law"),
    ("harder contact at the crank pin alone", "crank", "crank_pin_normal_force", lambda v, i: v * (1 + 1e-5), "crank pin: contact law"),
    ("friction with the sliding at the crank pin", "both", "crank_pin_friction_force", lambda v, i: -v, "crank pin: friction law"),
    ("faster sliding at the crank pin", "crank", "crank_pin_sliding_speed", lambda v, i: v * (1 + 1e-6), "crank pin: sliding speed"),
    ("force on the rod that is not the law's", "both", "crankpin_force_y", lambda v, i: v * (1 + 1e-6), "crank pin: contact force on the pin"),
    ("eccentricity of another crank pin", "both", "crank_pin_eccentricity_y", lambda v, i: v * (1 + 1e-5), "pin in the bearing, y"),
    ("rate of the crank pin off", "both", "crank_pin_eccentricity_rate_x", lambda v, i: v * 1.001, "energy column"),
    ("rate of a crank pin alone off", "crank", "crank_pin_eccentricity_rate_y", lambda v, i: v + 1e-6, "pin speed, y"),
    ("another film at the crank pin", "films", "crank_pin_film_force_y", lambda v, i: v * (1 + 1e-5), "crank pin: film force on the pin"),
    ("rod acceleration off with both pins loose", "both", "rod_acceleration", lambda v, i: v * 1.001, "Euler, rod"),
    ("crank acceleration off with both pins loose", "both", "crank_acceleration", lambda v, i: v * 1.001, "Euler, crank"),
    ("a little harder corner of the skirt", "slap", "guide_1_force", lambda v, i: v * (1 + 1e-5), "contact law of a corner"),
    ("friction that drives a corner", "slap", "guide_2_friction", lambda v, i: -v, "friction law of a corner"),
    ("a wider gap", "slap", "guide_3_gap", lambda v, i: v + 1e-12, "gap of a corner"),
    ("a piston that tilts on its own", "slap", "piston_tilt_acceleration", lambda v, i: v * 1.001, "Euler, piston"),
    ("another offset", "slap", "piston_offset", lambda v, i: v + 1e-9, "pin in the bearing, y"),
    ("offset faster than it grows", "slap", "piston_offset_rate", lambda v, i: v * 1.001, "energy column"),
    ("tilt that is not the integral of its rate", "slap", "piston_tilt_rate", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("guide force that no corner gives", "slap", "guide_force", lambda v, i: v * (1 + 1e-6), "force of the corners on the guide"),
    ("friction of the piston off", "slap", "guide_friction_force", lambda v, i: v + 1e-3, "friction on the piston"),
    ("a little more friction on the guide", "guide", "guide_friction_force", lambda v, i: v * (1 + 1e-5), "friction on the guide"),
    ("friction on the guide that is no force", "guide", "guide_friction_force", lambda v, i: -v, "Newton, piston"),
    ("a rod bent a little more", "rod", "rod_mode_1", lambda v, i: v * (1 + 1e-6), "Lagrange, rod_mode_1"),
    ("a rod that stretches faster", "rod", "rod_stretch_rate", lambda v, i: v * 1.001, "energy column"),
    ("a shape that is not the integral of its rate", "rod", "rod_axial_3_rate", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("shapes of another motion", "rod", "rod_axial_2_acceleration", lambda v, i: v * 1.0001, "Lagrange, rod_axial_2"),
    ("force on an elastic rod off", "rod", "crankpin_force_y", lambda v, i: v * (1 + 1e-6), "Newton, rod along y"),
    ("an elastic rod that turns on its own", "rod", "rod_acceleration", lambda v, i: v * 1.0001, "Euler, rod"),
    ("an elastic rod between two loose pins turns on its own", "rods", "rod_acceleration", lambda v, i: v * 1.0001, "Euler, rod"),
    ("a bent rod between two loose pins", "rods", "rod_mode_2_acceleration", lambda v, i: v * 1.0001, "Lagrange, rod_mode_2"),
    ("a bent rod's pin elsewhere", "bent", "rod_stretch", lambda v, i: v + 1e-9, "pin in the bearing, x"),
    ("a bent rod's pin is pulled", "bent", "rod_stretch_acceleration", lambda v, i: v * 1.001, "pin acceleration"),
    ("more moment of an elastic shaft", "shaft", "crankshaft_moment", lambda v, i: v * (1 + 1e-6), "shaft's law"),
    ("a flywheel that turns on its own", "shaft", "flywheel_acceleration", lambda v, i: v * 1.001, "Euler, flywheel"),
    ("a faster flywheel", "shaft", "flywheel_speed", lambda v, i: v * (1 + 1e-6), "energy column"),
    ("another film", "film", "film_force_x", lambda v, i: v * 1.001, "film force on the pin"),
    ("more film beside a contact", "weighted", "film_force_y", lambda v, i: v * (1 + 1e-5), "contact force on the pin"),
    ("harder contact beside a film", "weighted", "normal_force", lambda v, i: v * (1 + 1e-5), "contact law"),
    ("a film elsewhere between elastic walls", "elastic", "film_eccentricity_x", lambda v, i: v * (1 + 1e-5), "elastic walls"),
    ("walls that give way more", "elastic", "wall_deflection", lambda v, i: v * (1 + 1e-6), "wall deflection"),
    ("another printed film", "printed", "pin_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("another half film", "half", "pin_force_y", lambda v, i: v * (1 + 1e-5), "film law"),
    ("another short film", "short", "pin_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("another film of a finite bearing", "finite", "pin_force_x", lambda v, i: 1.05 * v, "film law"),
    ("another oscillating film", "contact", "pin_force_y", lambda v, i: v * (1 + 1e-4), "film law"),
    ("harder asperities", "rough", "asperity_force", lambda v, i: v * (1 + 1e-4), "asperities"),
    ("asperities that rub forwards", "rough", "friction_force", lambda v, i: -v, "boundary friction"),
    ("another film between asperities", "rough", "film_force_x", lambda v, i: v * (1 + 1e-5), "film law"),
    ("another film between elastic walls", "thickening", "film_force_x", lambda v, i: v * 1.001, "film law"),
    ("more pressure", "film", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("more pressure in a compressor", "compressor", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("more pressure in a two-stroke engine", "two_stroke", "cylinder_pressure", lambda v, i: v * 1.001, "gas law"),
    ("another pressure than the measured one", "measured", "cylinder_pressure", lambda v, i: v * (1 + 1e-4), "gas law"),
    ("another speed of the ramp", "ramp", "crank_speed", lambda v, i: v * (1 + 1e-9), "held speed"),
    ("another acceleration of the ramp", "ramp", "crank_acceleration", lambda v, i: v * (1 + 1e-9), "held acceleration"),
    ("more torque of the motor", "motor", "crank_moment", lambda v, i: v * (1 + 1e-9), "drive's torque"),
    ("another gas force", "film", "gas_force", lambda v, i: -v, "gas force"),
    ("another cylinder", "film", "cylinder_volume", lambda v, i: v * 1.001, "cylinder volume"),
    ("crank speed that is not the rate of the angle", "ideal", "crank_angle", lambda v, i: v * 1.01, "is not the integral of its rate"),
    ("one row that is no number", "dry", "crank_speed", lambda v, i: float("nan") if i == 50 else v, "Newton, crank"),
]

#: (what the program does, scene, value that it runs with instead of the one that it says, what the verdict must say)
LIARS = [
    ("another restitution", "dry", "contact.restitution", "0.89", "contact law"),
    ("another restitution of Gonthier", "johnson", "contact.restitution", "0.71", "contact law"),
    ("another restitution of Carvalho and Martins", "liner", "contact.restitution", "0.61", "contact law"),
    ("another exact restitution", "conformal", "contact.restitution", "0.51", "contact law"),
    ("another housing", "conformal", "contact.housing_compliance", "0.39", "contact law"),
    ("a longer bearing", "johnson", "joint.bearing_length", "0.0401", "contact law"),
    ("a thicker liner", "liner", "contact.liner_thickness", "0.501e-3", "contact law"),
    ("another damper", "pereira", "contact.damping", "5.1e3", "contact law"),
    ("another depth of the damper", "pereira", "contact.full_damping_depth", "1.1e-6", "contact law"),
    ("more dissipation", "dissipation", "contact.dissipation", "0.41", "contact law"),
    ("another friction", "dry", "friction.coefficient", "0.051", "friction law"),
    ("more friction at rest", "sticks", "friction.static_coefficient", "0.151", "friction law"),
    ("another friction at rest", "brown_mcphee", "friction.static_coefficient", "0.151", "friction law"),
    ("another speed of transition", "stribeck", "friction.transition_speed", "0.11", "friction law"),
    ("stiffer bristles", "lugre", "friction.bristle_stiffness", "2.01e4", "friction law"),
    ("other damping of bristles", "lugre", "friction.bristle_damping", "0.0101", "friction law"),
    ("more damping", "ideal", "drive.damping", "0.031", "Euler, crank"),
    ("more heat", "film", "combustion.heat", "166.0", "gas law"),
    ("a heavier piston to turn", "slap", "guide.piston_inertia", "2.001e-5", "Euler, piston"),
    ("a longer skirt", "slap", "guide.skirt_top", "0.0151", "gap of a corner"),
    ("a wider bore", "slap", "guide.bore_clearance", "101e-6", "gap of a corner"),
    ("a tighter ring pack", "guide", "guide.viscous", "3.01", "friction on the guide"),
    ("a thinner rod", "rod", "elastic_rod.section_area", "9.599e-5", "Lagrange, rod_axial_4"),
    ("a rod that bends less", "rods", "elastic_rod.section_inertia", "5.121e-10", "Lagrange, rod_mode_2"),
    ("a rod with less damping", "rod", "elastic_rod.axial_damping_ratio", "0.01999", "Lagrange, rod_stretch"),
    ("a lighter shank", "bent", "elastic_rod.shank_mass", "0.2099", "Lagrange, rod_mode_1"),
    ("a softer shaft", "shaft", "crankshaft.torsional_stiffness", "1.9999e4", "shaft's law"),
    ("a heavier flywheel", "shaft", "crankshaft.flywheel_inertia", "0.004001", "Euler, flywheel"),
    ("thicker oil", "film", "lubrication.viscosity", "0.0118", "film law"),
    ("a deeper transition", "weighted", "lubrication.transition_depth", "3.001e-6", "contact law"),
    ("a film held farther out", "weighted", "lubrication.least_film_ratio", "0.0299", "film law"),
    ("thicker oil beside a contact", "weighted", "lubrication.viscosity", "0.0201", "film law"),
    ("another stiffness under the film", "elastic", "contact.housing_compliance", "0.3864", "elastic walls"),
    ("a thicker half film", "half", "lubrication.viscosity", "0.0118", "film law"),
    ("a thicker short film", "short", "lubrication.viscosity", "0.0118", "film law"),
    ("another cavitation", "finite", "lubrication.cavitation", "'none'", "film law"),
    ("rougher surfaces", "rough", "asperities.roughness", "0.401e-6", "asperities"),
    ("more boundary friction", "rough", "asperities.coefficient", "0.101", "boundary friction"),
    ("a warmer oil", "warm", "lubrication.temperature", "350.1", "film law"),
    ("more pressure-viscosity", "thickening", "lubrication.pressure_viscosity", "1.9e-8", "film law"),
    ("a heavier piston", "ideal", "mechanism.piston_mass", "0.92", "Newton, piston"),
    ("gravity from elsewhere", "both", "mechanism.gravity_angle_deg", "25.01", "Newton, crank"),
    ("a heavier rod between two loose pins", "both", "mechanism.rod_mass", "0.2101", "energy column"),
    ("less gravity", "film", "mechanism.gravity", "9.8", "Newton, piston"),
    ("a looser tolerance than asked for, in contact", "contact", "integrator.relative_tolerance", "1e-4", "grown tolerances off"),
    ("a looser tolerance than asked for, in a film", "short", "integrator.relative_tolerance", "1e-3", "grown tolerances off"),
    ("a heavier piston in one method alone", "dry", "mechanism.piston_mass", "0.25", "beyond the horizon"),
]

#: (what is broken, file, what it says, what it says in the mutant, scene, what the verdict must say)
MUTANTS = [
    ("contact damping gives energy", "contact_law.f90", "1 + self%damping*min(", "1 - self%damping*min(", "dry", "contact law"),
    ("a thousandth more dissipation", "restitution_law.f90", "max(0.0_dp, 1 + self%dissipation*", "max(0.0_dp, 1 + 1.001_dp*self%dissipation*", "dissipation", "contact law"),
    ("exact gives back a little less", "exact_restitution.f90", "damping = one_minus_exp(y)/e", "damping = 1.001_dp*one_minus_exp(y)/e", "conformal", "contact law"),
    ("Johnson's cylinder without the one", "johnson.f90", "m = log(4.0_dp) - 1 - log(d)", "m = log(4.0_dp) - 1.001_dp - log(d)", "johnson", "contact law"),
    ("a coefficient of the conformal fit off", "conformal.f90", " 1.74709353_dp", " 1.75709353_dp", "conformal", "contact law"),
    ("pressure of half the arc", "conformal.f90", "(2*b/sqrt(b**2 + 1) +", "(b/sqrt(b**2 + 1) +", "conformal", "peak pressure"),
    ("Pereira's exponent off", "pereira.f90", "1.51_dp*log", "1.511_dp*log", "pereira", "contact law"),
    ("the bedding without its small difference", "winkler.f90", "self%clearance*difference)", "0*difference)", "liner", "contact law"),
    ("friction drives", "ambrosio.f90", "ratio = -sign(ratio, sliding_speed)", "ratio = sign(ratio, sliding_speed)", "dry", "friction law"),
    ("static friction grips too early", "brown_mcphee.f90", "0.25_dp*u**2 + 0.75_dp)**2", "0.25_dp*u**2 + 0.76_dp)**2", "brown_mcphee", "friction law"),
    ("bristles give way too late", "lugre.f90", "abs(v)*z/g\n  end function", "0.99_dp*abs(v)*z/g\n  end function", "lugre", "bristle is not the integral"),
    ("film holds too much as it withdraws", "pinkus_sternlicht.f90", "if (eps_dot < 0) radial = self%withdrawal_sign*radial", "if (eps_dot < 0) radial = self%withdrawal_sign*(1.001_dp*radial)", "film", "film law"),
    ("a printed film that lets go", "pinkus_sternlicht.f90", "self%withdrawal_sign = -1", "self%withdrawal_sign = 1", "printed", "film law"),
    ("half a film with an arc too long", "half_film.f90", "    radial = -scale*b*square*(2 + square)", "    radial = -1.001_dp*scale*b*square*(2 + square)", "half", "film law"),
    ("a short film that swerves", "short_bearing.f90", "cs = 2*eps*s**3", "cs = 2.002_dp*eps*s**3", "short", "film law"),
    ("a film that does not rupture", "finite_film.f90", "if (cavitation == cavitation_reynolds) call find_film", "if (cavitation < 0) call find_film",
     "finite", "film law"),
    ("a film that pulls", "finite_film.f90", "if (cavitation == cavitation_gumbel) then", "if (cavitation < 0) then", "gumbel", "film law"),
    ("a thinner film than there is", "reynolds_grid.f90", "height = gap + 2*(1 - gap)", "height = gap + 1.9_dp*(1 - gap)", "direct", "film law"),
    ("a table that draws the pin less one way", "film_map.f90", "if (t < 0) tangential = -tangential", "if (t < 0) tangential = -0.9_dp*tangential", "finite", "film law"),
    ("a table without cavitation that is scaled as the others", "film_map.f90", "      s_r = b/(w2*w)", "      s_r = abs(b)/(w2*w)", "full", "film law"),
    ("half of the wedge", "finite_bearing.f90", "[v(1) + 0.5_dp*motion%pin_speed*e(2), v(2) - 0.5_dp*motion%pin_speed*e(1)]",
     "[v(1) + 0.25_dp*motion%pin_speed*e(2), v(2) - 0.25_dp*motion%pin_speed*e(1)]", "short", "film law"),
    ("an oscillating film with the shear of another one", "oscillating_film.f90", "along*(real(response%shear) -", "along*(1.01_dp*real(response%shear) -",
     "contact", "film law"),
    ("asperities a thousandth too many", "asperities.f90", "self%density_product**2*sqrt", "self%density_product**2*1.001_dp*sqrt", "rough", "asperities"),
    ("asperities that rub at any speed", "asperities.f90", "*tanh(sliding_speed/self%transition_speed)", "*tanh(2*sliding_speed/self%transition_speed)", "rough",
     "boundary friction"),
    ("the film of rough surfaces moves as smooth ones do", "mixed_film.f90", "slope*radial*n + ratio", "radial*n + ratio", "rough", "film law"),
    ("a held film farther in", "film_transition.f90", "(1 - least_film_ratio)*bearing%clearance", "(1 - 1.01_dp*least_film_ratio)*bearing%clearance", "weighted",
     "film law"),
    ("a film between elastic walls that does not turn with them", "clearance_joint.f90", " + drawn*[-e(2), e(1)]", "", "elastic", "film law"),
    ("oil that thickens half as fast under pressure", "elastic_film.f90", "self%per_area*norm2(load))", "0.5_dp*self%per_area*norm2(load))", "thickening", "film law"),
    ("oil of another temperature", "oil_viscosity.f90", "(log(self%temperature) - x(1))", "(log(self%temperature + 0.1_dp) - x(1))", "warm", "film law"),
    ("the film keeps a thousandth too much", "film_transition.f90", "w = s**2*(3 - 2*s)", "w = s**2*(2.999_dp - 2*s)", "weighted", "contact law"),
    ("the crank pin slides without its bearing's turning", "joint_motion.f90", "- joint%bearing_speed*(joint%distance + pin_radius)",
     "- joint%bearing_speed*pin_radius", "both", "crank pin: sliding speed"),
    ("a corner's friction turns nothing", "piston_guide.f90", "*corner%normal_force - corner%from_com(2)*corner%friction_force", "*corner%normal_force",
     "slap", "Euler, piston"),
    ("shapes without a part of the Coriolis force", "elastic_rod_body.f90", "on_shape(n + j) = -2*turn*", "on_shape(n + j) = -2.001_dp*turn*", "rod", "Lagrange, rod_"),
    ("a rod that bending does not draw together", "elastic_rod_body.f90", " - second)", ")", "rod", "Newton, rod along x"),
    ("a rod that does not buckle", "elastic_rod_body.f90", "- 2*rod%shortening(k)*motion%shape(k)*pin(1) + dot", "+ dot", "rod", "Lagrange, rod_mode_1"),
    ("a pin that bending draws less", "elastic_rod_piece.f90", "chord = -2*sum(rod%shortening", "chord = -1.9_dp*sum(rod%shortening", "rod",
     "energy not kept"),
    ("a shaft that damps the other way", "elastic_crankshaft.f90", "self%damping*(motion%flywheel_speed - motion%crank_speed)\n",
     "self%damping*(motion%crank_speed - motion%flywheel_speed)\n", "shaft", "shaft's law"),
    ("angular momentum from nowhere", "chain_loads.f90", "-(moment + eccentricity(1)", "-(moment + 0*eccentricity(1)", "both", "Euler, rod"),
    ("a valve opens too late", "valve_gas.f90", "*(1 - opening_margin)", "*0.999_dp", "compressor", "gas law"),
    ("a measured pressure is off between its rows", "monotone_cubic.f90", "0.5_dp*abs(parabola))*2", "0.5_dp*abs(parabola))*2.2_dp",
     "measured", "gas law"),
    ("gas loses no heat as it expands", "gas_cycle.f90", "values(i) = p*(volume", "values(i) = 1.001_dp*p*(volume", "film", "gas law"),
]


def traced(program: Path, scene: str) -> Run:
    """A run with rows at every step and on a grid."""
    name, settings = SCENES[scene]
    case, plain = ROOT / "cases" / f"{name}.nml", {**settings, "output.digits": "17", "output.ideal_twin": ".false."}
    plain |= requested_columns(run_case(program, case, plain))
    first = run_case(program, case, {**plain, "output.every_step": ".true."})
    if first.status:
        sys.exit(f"{scene}: {first.message}\n0 passed, 1 failed")
    return merged(first, run_case(program, case, {**plain, "output.interval": repr(float(first.summary["simulated_time"]) / 4000)}))


def changed(run: Run, column: str, change: Callable[[float, int], float]) -> Run:
    columns = dict(run.columns)
    columns[column] = [change(value, i) for i, value in enumerate(columns[column])]
    return dataclasses.replace(run, columns=columns)


def corrupted(program: Path, scene: str) -> list[Finding]:
    """A sound run passes; with a column of it changed, the check that reads it goes red."""
    found: list[Finding] = []
    run = traced(program, scene)
    verdict = judge_files(copy.deepcopy(run))
    found.append((not verdict.faults, f"{scene}: sound", "; ".join(verdict.faults)))
    found.append((verdict.checks > 10 and verdict.energy is not None, f"{scene}: checked", "; ".join(summary_of(verdict))))
    phases = set(run.columns.get("phase", [0.0]))
    found.append((phases == PHASES[scene], f"{scene}: has the phases that it is there for", str(phases)))
    for what, where, column, change, says in CORRUPTIONS:
        if where == scene:
            faults = judge_files(changed(run, column, change)).faults
            found.append((any(says in fault for fault in faults), f"{what}: seen", "; ".join(faults) or "no fault found"))
    return found


LIAR = """#!/usr/bin/env python3
# Runs a program with one value changed, and writes into the resolved case that it was not.
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
    """A program that runs with one value and says that it ran with another. `once`: not where a tolerance is asked for, as in the
    runs that are compared with."""
    file.write_text(LIAR.format(program=str(program.resolve()), key=key, value=value, said=repr(said), once=once))
    file.chmod(0o755)
    return file


def lied(program: Path, folder: Path, number: int) -> list[Finding]:
    """A program with other physics than it says is found out."""
    what, scene, key, value, says = LIARS[number]
    name, settings = SCENES[scene]
    case = ROOT / "cases" / f"{name}.nml"
    said = run_case(program, case, {**settings, "output.ideal_twin": ".false."}).number(key)
    lies = liar(folder / f"liar{number}", program, key, value, said, once="tolerance" in what or "alone" in what)
    verdict = judge_scene(lies, case, settings)
    return [(any(says in fault for fault in verdict.faults), f"a program with {what}: seen", "; ".join(summary_of(verdict)))]


def test_judge(program: Path, folder: Path) -> None:
    """All scenes, corruptions and liars, on all processor cores."""
    missing = {where for _, where, _, _, _ in CORRUPTIONS} - set(SCENES)
    check(not missing, "every corruption has its scene", str(missing))
    with ProcessPoolExecutor() as pool:
        tasks = [pool.submit(corrupted, program, scene) for scene in SCENES]
        tasks += [pool.submit(lied, program, folder, number) for number in range(len(LIARS))]
        for task in tasks:
            for finding in task.result():
                check(*finding)


def test_mutants(folder: Path, part: str) -> None:
    """Copies of the program with one line broken, of those in src/part. What the lines before have not touched is not built again."""
    tree = folder / "mutant"
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", ".git", ".venv", "results"))
    whole: tuple[Path, str] | None = None
    for what, file, old, new, scene, says in MUTANTS:
        source = next((tree / "src").rglob(file))
        if not source.is_relative_to(tree / "src" / part):
            continue
        if whole:
            whole[0].write_text(whole[1])
        os.environ["XDG_CACHE_HOME"] = str(tree / f"cache {what}")   # tables of films are the mutant's own
        text = source.read_text()
        whole = source, text
        check(text.count(old) == 1, f"mutant ({what}): the line is there", file)
        source.write_text(text.replace(old, new))
        path = {**os.environ, "PATH": f"{ROOT / '.venv' / 'bin'}:{os.environ['PATH']}"}
        built = subprocess.run(["fpm", "build", "--flag", "-O1"], cwd=tree, env=path, capture_output=True, text=True, check=False)
        programs = [one for one in tree.glob("build/*/app/gudgeon") if one.is_file()]
        if built.returncode or not programs:
            check(False, f"mutant ({what}): built", built.stderr[-300:])
            continue
        faults = judge_files(traced(programs[0], scene)).faults
        check(any(says in fault for fault in faults), f"mutant ({what}): seen", "; ".join(faults) or "no fault found")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, help="this program instead of a release build")
    parser.add_argument("--mutants", nargs="?", const="", metavar="FOLDER",
                        help="build and judge broken copies of the program alone; those broken in src/FOLDER")
    options = parser.parse_args()
    program = options.program
    if not program:
        run = subprocess.run([ROOT / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
        if run.returncode:
            sys.exit(f"{run.stderr}\n0 passed, 1 failed")
        program = ROOT / run.stdout.strip()
    with tempfile.TemporaryDirectory(prefix="judge") as folder:
        if options.mutants is not None:
            test_mutants(Path(folder), options.mutants)
        else:
            test_judge(program, Path(folder))
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
