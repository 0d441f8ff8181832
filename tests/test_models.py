#!/usr/bin/env python3
"""Tests of gudgeon-plot models: the variants of constructed cases, its table against runs of the program, its result, wrong
input.

    .venv/bin/python tests/test_models.py        (after scripts/setup.sh --python; about 250 short runs)

Ends with the line "N passed, N failed".
"""

import contextlib
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))
sys.path.insert(0, str(TOP / "tests"))

from measured import use_virtual_environment

use_virtual_environment()

import pandas as pd
from assertions import Assertions
from gudgeon.models.effects import Outcome, change, percent, will_do
from gudgeon.models.variants import (
    Variant,
    completed,
    read_template,
    together,
    variants_of,
)
from gudgeon.program import release_program
from gudgeon.results import read_summary

check = Assertions().check
PLOT = (sys.executable, "-m", "gudgeon")
SHORT = ("integrator.revolutions=1.2", "integrator.relative_tolerance=1e-5")


def settings_of(variants: list[Variant]) -> dict[str, tuple[str, ...]]:
    return {variant.label: variant.settings for variant in variants}


def variants_of_made_cases(template: dict) -> None:
    """The variants of a dry joint, of two lubricated joints, and of a case with elastic members."""
    check(template["contact"]["law"].choices[:2] == ("lankarani_nikravesh", "hertz"), "choices of the template", str(template["contact"]["law"]))
    check("exponent" in template["contact"] and template["asperities"]["roughness"].value == "0.4e-6",
          "keys, including those of groups in comments")
    mechanism = {"gravity": 9.8, "rod_mass": 1.0, "rod_length": 0.2}
    joint = {"kind": "clearance", "clearance": 1e-5, "bearing_radius": 0.01}
    dry = {"mechanism": mechanism, "drive": {"kind": "free"}, "joint": joint, "contact": {"law": "hertz", "geometry": "hertz_sphere"}}
    found = settings_of(variants_of(dry, template))
    check(found["no contact"] == ("contact=none",), "the contact can be removed")
    check(found["ideal piston pin"] == ("joint.kind=ideal", "contact=none"), "a joint that becomes ideal loses its laws",
          str(found["ideal piston pin"]))
    skirt = settings_of(variants_of({**dry, "guide": {"kind": "lubricated"}, "guide.lubrication": {"cavitation": "reynolds"}, "guide.asperities": {}}, template))
    check(skirt["no model of the guide"] == ("guide=none", "guide.lubrication=none", "guide.asperities=none"), "the film of a skirt goes with its guide")
    check(skirt["film of the skirt: cavitation gumbel"] == ("guide.lubrication.cavitation=gumbel",), "the other condition of rupture in the film of a skirt")
    check(skirt["elastic faces of the skirt"] == ("guide.stiffness=5e7",) and "rigid faces of the skirt" not in skirt, "elastic faces can be added")
    elastic = settings_of(variants_of({**dry, "guide": {"kind": "lubricated", "stiffness": 5e7}, "guide.lubrication": {"cavitation": "reynolds"}, "guide.asperities": {}}, template))
    check(elastic["rigid faces of the skirt"] == ("guide.stiffness=0",) and "elastic faces of the skirt" not in elastic, "elastic faces can be taken out")
    check("guide.kind=clearance" in skirt["skirt with dry corners"], "dry corners instead of the film of the skirt")
    rings = dry | {"ring_1": {"model": "closed_form", "crown_offset": 0.0}, "ring_2": {"model": "film", "crown_offset": 0.0}}
    check(settings_of(variants_of(rings | {"rings.asperities": {}}, template))["piston rings: film"] == ("ring_1.model=film", "ring_2.model=film"), "films of all rings")
    check("piston rings: film" not in settings_of(variants_of(rings, template)), "smooth rings have no film")
    check(found["crank held at its starting speed"] == ("drive.kind=constant_speed",), "the crank can be held at its starting speed")
    check(len([label for label in found if label.startswith("contact ") and "geometry" not in label]) == 9, "there are nine other contact laws")
    check(found["friction"][0] == "friction.law=ambrosio", "friction can be added")
    film = dry | {"lubrication": {"law": "finite_bearing", "variant": "short"}}
    check(settings_of(variants_of(film, template))["quasi-static piston pin"] == ("joint.kind=quasi_static", "contact=none"),
          "a film can carry the pin of a joint, without its contact")
    carried = {key: film[key] for key in ("mechanism", "drive", "lubrication")} | {"main_bearing.joint": joint | {"kind": "quasi_static"}}
    found_carried = settings_of(variants_of(carried, template))
    check(found_carried["ideal main bearing"] == ("main_bearing.joint.kind=ideal", "main_bearing.joint.clearance=0", "lubrication=none"),
          "a carried bearing can be ideal", str(found_carried.get("ideal main bearing")))
    check("quasi-static piston pin" not in found, "a dry joint cannot be carried")
    check("crank_pin.joint.clearance=1e-05" in found["clearance at the crank pin too"], "the other pin can have clearance")
    check(not any("film" in label or "gas" in label for label in found), "a dry case has no variants of film and gas")
    area = float(dict(one.split("=") for one in found["elastic rod"])["elastic_rod.section_area"])
    check(abs(area * 7850 * 0.2 - 1.0) < 1e-3, "the elastic rod has the mass of the rigid one", str(area))
    both = dry | {"crank_pin.joint": joint, "lubrication": {"law": "pinkus_sternlicht", "variant": "closed_form"}, "friction": {"law": "coulomb", "coefficient": 0.1}}
    both |= {"elastic_rod": {"transverse_modes": 2, "axial_shapes": 7}, "mechanism": mechanism | {"gravity": 0.0}, "drive": {"kind": "constant_speed"}}
    found = settings_of(variants_of(both, template))
    check("no film" in found and "no film at the crank pin" not in found, "a film of both joints is removed from both")
    one = settings_of(variants_of(both | {"crank_pin.lubrication": {"law": "pinkus_sternlicht"}}, template))
    check(one["no film at the crank pin"] == ("crank_pin.lubrication=none",), "a film of one joint is removed from that joint")
    check(found["no contact, and so no friction"] == ("contact=none", "friction=none"), "friction is removed together with the contact")
    check(found["ideal crank pin"] == ("crank_pin.joint.kind=ideal",), "one of two joints can be ideal")
    check("elastic_rod=none" in found["ideal twin: no clearance, rigid members"], "the ideal twin has a rigid rod")
    check(found["rod with 4 modes and 8 axial shapes"][1] == "elastic_rod.axial_shapes=8",
          "the number of shapes does not exceed the allowed number")
    check("gravity" in found and "no gravity" not in found and "elastic rod" not in found, "models that the case has are not added")
    check(not any("held" in label for label in found), "a crank at constant speed stays so")
    parts = (Variant("", "", ("a.law=1", "a.x=2", "b.law=3")), Variant("", "", ("a=none",)), Variant("", "", ("b.law=4",)))
    check(together(*parts) == ("b.law=4", "a=none"), "settings of two variants are combined", str(together(*parts)))


def what_the_program_misses(template: dict) -> None:
    case = {"lubrication": {"viscosity": 0.1}}
    film = Variant("exchanged", "", ("lubrication.law=oscillating_film",))
    better = completed(film, "x.nml: &lubrication kinematic_viscosity: required with law = 'oscillating_film' (m^2/s)", case, template)
    value = float(better.settings[1].split("=")[1])
    check(abs(value / 0.1 - 1.38e-5 / 0.0117) < 1e-8, "the kinematic viscosity is that of the case's oil", str(value))
    check(completed(better, "x.nml: &lubrication kinematic_viscosity: required", case, template) is None, "the same key is not completed twice")
    better = completed(film, "x.nml: &joint of crank_pin bearing_length: required with contact geometry = 'johnson' (m)", case, template)
    check(better is not None and better.settings[1].startswith("crank_pin.joint.bearing_length=0."),
          "the bearing length of the crank pin is completed", str(better))
    check(completed(film, "x.nml: &output interval = 3: must be > 0", case, template) is None, "an error that no default value can repair")


def changes() -> None:
    """Changes that are relative, over the clearance, or absolute; and their uncertainty from the certificates."""
    one = Outcome(Variant("", "", ()), clearance=1e-5)
    one.values = {"peak_force": 200.0, "contact_share": 0.5, "min_film": 1e-6, "loss": 4.0}
    one.uncertainty = dict.fromkeys(one.values, 0.0)
    other = Outcome(Variant("", "", ()), clearance=2e-5)
    other.values = {"peak_force": 190.0, "contact_share": 0.53, "min_film": 5e-7}
    other.uncertainty = {"peak_force": 20.0, "contact_share": 0.0, "min_film": 0.0}
    check(change("peak_force", one, other) == (-0.05, 0.1), "a relative change and its uncertainty", str(change("peak_force", one, other)))
    check(abs(change("contact_share", one, other)[0] - 0.03) < 1e-12, "a share")
    check(abs(change("min_film", one, other)[0] + 0.05) < 1e-12, "a film thickness is divided by the clearance")
    check(change("loss", one, other) is None, "a quantity that the other run lacks")
    check(percent((-0.05, 0.1)) == "-5 % ± 1e+01" and percent((1e-9, 0.0)) == "0 %" and percent(None) == "-", "changes as text",
          percent((-0.05, 0.1)))
    check(will_do(["peak_force"], 0.01, one, other), "a difference within the uncertainty of the certificates is accepted")
    check(not will_do(["contact_share"], 0.01, one, other) and not will_do(["loss"], 0.9, one, other),
          "a difference that is too large, or not known, is not accepted")


def run_program(program: Path, folder: Path, words: list[str]) -> dict[str, float]:
    """Summary of a run of cases/sim_I.nml with the given options."""
    subprocess.run([program, "-q", "-o", folder, *words, TOP / "cases" / "sim_I.nml"], check=True, capture_output=True)
    numbers = {}
    for name, (value, _) in read_summary(folder / "sim_I.summary.csv").items():
        with contextlib.suppress(ValueError):
            numbers[name] = float(value)
    return numbers


def whole_table(program: Path, folder: Path) -> None:
    """A short simulation I: the figures in the table are those of the program, and the command of its result gives these
    figures."""
    wanted = ["peak_force", "min_film", "mean_speed"]
    command = [*PLOT, "models", TOP / "cases" / "sim_I.nml", "--program", program, "--out", folder, "--within", "0.06"]
    command += ["--quantities", *wanted, "--timeout", "600", *(word for one in SHORT for word in ("--set", one))]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    check(told.returncode == 0, "the script runs", told.stderr[-300:])
    if told.returncode != 0:
        return
    check((folder / "models_sim_I.png").stat().st_size > 10000, "a picture")
    text = told.stdout
    table = pd.read_csv(folder / "models_sim_I.csv").set_index("scene")
    short = [word for one in ("integrator.method=auto", "output.ideal_twin=F", *SHORT) for word in ("--set", one)]
    for scene in ("the case as it is", "no gravity", "no film", "film finite_bearing"):
        row = table.loc[scene]
        check(pd.notna(row["evaluations"]), f"{scene}: it was run", str(row["refusal"]))
        if pd.isna(row["evaluations"]):
            continue
        own = [word for one in str(row["settings"]).split() if "=" in one for word in ("--set", one)]
        summary = run_program(program, folder, [*short, *own])
        check(int(row["evaluations"]) == int(summary["rhs_evaluations"]), f"{scene}: evaluations", str(row["evaluations"]))
        for quantity, name in (("peak_force", "max_pin_force"), ("min_film", "min_film_thickness"), ("mean_speed", "mean_crank_speed")):
            check(row[quantity] == summary[name], f"{scene}: {quantity}", f"{row[quantity]}, {summary[name]}")
    ideal = table.loc["ideal piston pin"]
    check(ideal["loss"] == 0 and pd.isna(ideal["min_film"]), "an ideal joint has no loss and no film", str(ideal.to_dict()))
    check(table.loc["no contact, and so no friction", "peak_force_change"] == 0, "removing a contact law has no effect if there is no contact")
    check(abs(table.loc["no film", "contact_share"]) > 0.5, "without the film there is contact")
    check(table["certificate"].dropna().str.contains("digits|none").all(), "each scene has a certificate")
    printed = re.search(r"^    gudgeon \S+ (.*)$", text, re.MULTILINE)
    check(printed is not None, "the command of the cheapest scene is printed")
    parts = table[table["kind"].isin(["added", "refined", "exchanged"])]
    inside = re.search(r"the case with: (.*?)\. It takes", text)[1].split(", ")
    fullest = together(*(Variant("", "", tuple(str(parts.loc[label, "settings"]).split())) for label in inside))
    top = run_program(program, folder, [*short, *(word for one in fullest for word in ("--set", one))])
    cheap = run_program(program, folder, [*short, *shlex.split(printed[1])])
    for name, scale in (("max_pin_force", top["max_pin_force"]), ("mean_crank_speed", top["mean_crank_speed"]), ("min_film_thickness", 2e-5)):
        check(abs(cheap[name] - top[name]) <= 0.061 * abs(scale), f"the cheapest scene is within the limit: {name}", f"{cheap[name]}, {top[name]}")
    check(cheap["rhs_evaluations"] <= 1.1 * top["rhs_evaluations"], "the cheapest scene does not cost more than the most complete one")


def bad_input(program: Path, folder: Path) -> None:
    broken = folder / "broken.nml"
    broken.write_text("&mechanism crank_length = -1 /\n", encoding="utf-8")
    for words, status, said in (
        ([folder / "nowhere.nml"], 2, "no such case"),
        ([TOP / "cases" / "sim_I.nml", "--within", "5"], 2, "--within 5: must be > 0 and < 1"),
        ([TOP / "cases" / "sim_I.nml", "--quantities", "beauty"], 2, "invalid choice"),
        ([broken], 1, "&mechanism crank_length = -1"),
        ([TOP / "cases" / "sim_I.nml", "--set", "joint.clearence=1"], 1, "clearence"),
    ):
        told = subprocess.run(
            [*PLOT, "models", *words, "--program", program, "--out", folder], capture_output=True, text=True, check=False
        )
        check(told.returncode == status and said in told.stderr, f"refused: {said}", f"{told.returncode} {told.stderr}")
        check("Traceback" not in told.stderr, f"no traceback of Python: {said}")


def main() -> int:
    program = release_program()
    template = read_template(subprocess.run([program, "--template"], capture_output=True, text=True, check=True).stdout)
    variants_of_made_cases(template)
    what_the_program_misses(template)
    changes()
    with tempfile.TemporaryDirectory() as folder:
        bad_input(program, Path(folder))
        whole_table(program, Path(folder))
    return check.__self__.report()


if __name__ == "__main__":
    sys.exit(main())
