"""Finds the models of any case and their alternatives: variants of the case that change one model each. They are derived from its
resolved file and the template of the program."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

from gudgeon.names import PLACES

PREFIXES = ("", *(f"{place}." for place in PLACES))  # of a group: none (piston pin or all joints), or one place only
LAWS = ("friction", "asperities", "lubrication", "contact")
SKIRT = ("guide.lubrication", "guide.asperities")  # of a lubricated skirt
OTHER_GROUPS = ("guide", "elastic_rod", "crankshaft", "combustion", "cylinder_pressure")
WORDS = {
    "friction": "friction",
    "asperities": "asperities",
    "lubrication": "film",
    "contact": "contact",
    "guide": "model of the guide",
    "elastic_rod": "elasticity of the rod",
    "crankshaft": "elasticity of the crankshaft",
    "combustion": "gas",
    "cylinder_pressure": "gas",
}
EXCHANGED = {"contact": ("law", "geometry"), "friction": ("law",), "lubrication": ("law", "variant", "cavitation"), "guide": ("law", "contact_law")}
STEEL_DENSITY = 7850.0  # kg/m^3
MOST_SHAPES = 8

Case = dict[str, dict[str, object]]


@dataclass(frozen=True)
class Key:
    """A key of the template: its value there, and its allowed values."""

    value: str
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Variant:
    """A case with one model taken out, exchanged, refined or added."""

    kind: str
    label: str
    settings: tuple[str, ...]  # GROUP.KEY=VALUE of the program's --set
    assumed: str = ""  # values that the case does not give
    fuller: bool = False  # more detailed than the case: a part of the most complete scene


def read_template(text: str) -> dict[str, dict[str, Key]]:
    """The groups and keys that `gudgeon --template` prints, including groups that are commented out: group -> key -> Key. A group with
    a place has it before its name, as in `--set`."""
    groups: dict[str, dict[str, Key]] = {}
    name = ""
    for line in text.splitlines():
        line = re.sub(r"^! (?=(&|\s))", "", line)
        if match := re.match(r"&(\w+)", line):
            name = match[1]
        elif name and (match := re.match(r"\s+place = '(\w+)'$", line)):
            name = f"{match[1]}.{name}"
        elif name and (match := re.match(r"\s+(\w+) = (.*?)\s+! (.*)$", line)):
            choices = re.match(r"one of ((?:\w+, )*\w+)", match[3])
            names = choices[1].split(", ") if choices else []
            groups.setdefault(name, {})[match[1]] = Key(match[2].strip("'"), tuple(word for word in names if word != "default"))
    return groups


def groups_named(case: Case, group: str) -> list[str]:
    """The groups of the case with that name, with their prefixes."""
    return [place + group for place in PREFIXES if place + group in case]


def loose_joints(case: Case) -> list[str]:
    return [name for name in groups_named(case, "joint") if case[name].get("kind") == "clearance"]


def carried_joints(case: Case) -> list[str]:
    return [name for name in groups_named(case, "joint") if case[name].get("kind") == "quasi_static"]


def place_of(name: str) -> str:
    """' at the crank pin' for a group that belongs to one place alone, otherwise an empty text."""
    return f" at the {pin_of(name)}" if name.startswith(PREFIXES[1:]) else ""


def pin_of(name: str) -> str:
    """The place of a joint in words."""
    return next((place[:-1].replace("_", " ") for place in PREFIXES[1:] if name.startswith(place)), "piston pin")


def variants_of(case: Case, template: dict[str, dict[str, Key]]) -> list[Variant]:
    """All variants of a case, given as its resolved file. Not all of them need be valid: the program refuses invalid ones."""
    if "bearing_load" in case:
        return exchanged(case, template)
    return [*taken_out(case), *rungs(case), *exchanged(case, template), *refined(case), *added(case, template)]


def rungs(case: Case) -> list[Variant]:
    """The other steps from an ideal pin over a film that carries its load, one way, to a joint with clearance; from the film of a skirt
    to dry corners; and between rings in closed form and with a film."""
    found = []
    if SKIRT[0] in case:
        other = "gumbel" if case[SKIRT[0]].get("cavitation") == "reynolds" else "reynolds"
        found.append(Variant("exchanged", f"film of the skirt: cavitation {other}", (f"{SKIRT[0]}.cavitation={other}",)))
        if case["guide"].get("stiffness"):
            found.append(Variant("taken out", "rigid faces of the skirt", ("guide.stiffness=0",)))
        else:
            found.append(Variant("added", "elastic faces of the skirt", ("guide.stiffness=5e7",), "springs of 5e7 N/m", fuller=True))
        dry = ("guide.kind=clearance", "guide.stiffness=5e7", "guide.restitution=0.4", "guide.coefficient=0.05", *(f"{name}=none" for name in SKIRT))
        found.append(Variant("exchanged", "skirt with dry corners", dry, "stiffness 5e7 N/m, restitution 0.4, friction 0.05"))
    rings = [name for name in case if name.startswith("ring_")]
    if rings and "rings.asperities" in case and not any(case[name].get("crown_offset") for name in rings):
        model = "film" if any(case[name].get("model") != "film" for name in rings) else "closed_form"
        found.append(Variant("exchanged", f"piston rings: {model.replace('_', ' ')}", tuple(f"{name}.model={model}" for name in rings)))
    loose = loose_joints(case)
    for name in loose:
        own = [law for group in ("contact", "friction") for law in {group, name.replace("joint", group)} if law in case]
        shared = [law for law in own if "." not in law]
        if (name.replace("joint", "lubrication") in case or "lubrication" in case) and (len(loose) == 1 or not shared):
            settings = (f"{name}.kind=quasi_static", *(f"{law}=none" for law in sorted(own)))
            found.append(Variant("taken out", f"quasi-static {pin_of(name)}", settings))
    for name in carried_joints(case):
        others = any(other != name for other in (*loose, *carried_joints(case)))
        laws = () if others else tuple(f"{law}=none" for group in (*LAWS, "wear") for law in groups_named(case, group))
        found.append(Variant("taken out", f"ideal {pin_of(name)}", (f"{name}.kind=ideal", f"{name}.clearance=0", *laws)))
        if not name.startswith("main_bearing."):
            found.append(Variant("added", f"motion of the {pin_of(name)} in its clearance", (f"{name}.kind=clearance",), fuller=True))
    return found


def taken_out(case: Case) -> list[Variant]:
    found = []
    loose = loose_joints(case)
    for group in LAWS + OTHER_GROUPS:
        for name in groups_named(case, group):
            settings = [f"{name}=none"]
            if group == "contact":  # friction needs the normal force
                settings += [f"{other}=none" for other in groups_named(case, "friction") if place_of(other) == place_of(name)]
            if group == "guide":
                settings += [f"{other}=none" for other in SKIRT if other in case]
            label = f"no {WORDS[group]}{place_of(name)}"
            if group == "contact" and len(settings) > 1:
                label = f"no contact{place_of(name)}, and so no friction"
            found.append(Variant("taken out", label, tuple(settings)))
    rigid = tuple(f"{name}=none" for name in ("elastic_rod", "crankshaft") if name in case)
    for name in loose:
        settings = ideal_joints(case, [name])
        found.append(Variant("taken out", f"ideal {pin_of(name)}", settings))
    of_skirt = tuple(f"{other}=none" for other in SKIRT if other in case)
    bore = ("guide=none", *of_skirt) if case.get("guide", {}).get("kind") in ("clearance", "lubricated") else ()
    if len(loose) > 1 or (loose and (rigid or bore)):
        found.append(Variant("taken out", "ideal twin: no clearance, rigid members", ideal_joints(case, loose) + rigid + bore))
    if case["mechanism"]["gravity"]:
        found.append(Variant("taken out", "no gravity", ("mechanism.gravity=0",)))
    if case["drive"]["kind"] == "free":
        found.append(Variant("taken out", "crank held at its starting speed", ("drive.kind=constant_speed",)))
    return found


def ideal_joints(case: Case, names: list[str]) -> tuple[str, ...]:
    """Settings that make these joints ideal, and remove the laws that no joint uses any more."""
    settings = [f"{name}.kind=ideal" for name in names]
    if len(loose_joints(case)) == len(names):
        settings += [f"{law}=none" for group in LAWS for law in groups_named(case, group)]
    else:
        settings += [f"{law}=none" for name in names for group in LAWS if (law := name.replace("joint", group)) in case and "." in law]
    return tuple(settings)


def exchanged(case: Case, template: dict[str, dict[str, Key]]) -> list[Variant]:
    found = []
    for group, keys in EXCHANGED.items():
        for name in groups_named(case, group):
            for key in keys:
                if key == "contact_law" and case[name].get("kind") != "clearance":
                    continue
                now = case[name].get(key)
                for choice in template[group][key].choices:
                    if choice == now or now is None:
                        continue
                    what = WORDS.get(group, group) if group != "guide" else "guide"
                    word = "" if key == "law" else f" {key.replace('_', ' ')}"
                    found.append(
                        Variant(
                            "exchanged",
                            f"{what}{word} {choice}{place_of(name)}",
                            (f"{name}.{key}={choice}",),
                            fuller=is_fuller(case, name, key, choice),
                        )
                    )
    return found


def is_fuller(case: Case, name: str, key: str, choice: str) -> bool:
    """Whether a law is more detailed than that of the case: a bearing of its real length, a pin in a bore."""
    now = case[name][key]
    return (key, now, choice) in (("law", "pinkus_sternlicht", "finite_bearing"), ("geometry", "hertz_sphere", "conformal"))


def refined(case: Case) -> list[Variant]:
    found = []
    if "elastic_rod" in case:
        rod = case["elastic_rod"]
        modes = min(MOST_SHAPES, int(rod["transverse_modes"]) + 2)
        shapes = min(MOST_SHAPES, int(rod["axial_shapes"]) + 2)
        settings = (f"elastic_rod.transverse_modes={modes}", f"elastic_rod.axial_shapes={shapes}")
        found.append(Variant("refined", f"rod with {modes} modes and {shapes} axial shapes", settings, fuller=True))
    return found


def added(case: Case, template: dict[str, dict[str, Key]]) -> list[Variant]:
    """Models that the case lacks, if the case has the data that they need. Assumed values are stated."""
    found = []
    loose, mechanism = loose_joints(case), case["mechanism"]
    for name in ("joint", "crank_pin.joint"):
        if len(loose) != 1 or name in loose:
            continue
        like = case[loose[0]]
        keys = [key for key in ("clearance", "bearing_radius", "bearing_length") if like.get(key)]
        settings = (f"{name}.kind=clearance", *(f"{name}.{key}={like[key]:.9g}" for key in keys))
        other = "crank" if name.startswith("crank_pin.") else "piston"
        found.append(
            Variant("added", f"clearance at the {other} pin too", settings, "its bearing, clearance and laws those of the other pin", fuller=True)
        )
    if loose and not groups_named(case, "friction") and groups_named(case, "contact"):
        value = template["friction"]["coefficient"].value
        found.append(
            Variant("added", "friction", ("friction.law=ambrosio", f"friction.coefficient={value}"), f"coefficient {value}", fuller=True)
        )
    if "guide" not in case:
        coefficient = case.get("friction", {}).get("coefficient") or float(template["guide"]["coefficient"].value)
        settings = ("guide.kind=friction", f"guide.coefficient={coefficient:.9g}")
        found.append(Variant("added", "friction of the guide", settings, f"coefficient {coefficient:g}", fuller=True))
    if "elastic_rod" not in case:
        found.append(added_rod(mechanism, template["elastic_rod"]))
    if not mechanism["gravity"]:
        found.append(Variant("added", "gravity", ("mechanism.gravity=9.80665",), fuller=True))
    return found


def added_rod(mechanism: dict[str, object], template: dict[str, Key]) -> Variant:
    """A steel rod with the mass of the case's rod in its shank, and a section with the proportions of the template."""
    area = float(mechanism["rod_mass"]) / (STEEL_DENSITY * float(mechanism["rod_length"]))
    proportion = float(template["section_inertia"].value) / float(template["section_area"].value) ** 2
    settings = (f"elastic_rod.section_area={area:.4g}", f"elastic_rod.section_inertia={proportion * area**2:.4g}")
    assumed = f"steel, its mass in the shank: section {1e6 * area:.3g} mm^2, {1e12 * proportion * area**2:.3g} mm^4"
    return Variant("added", "elastic rod", settings, assumed, fuller=True)


def together(*parts: Variant) -> tuple[str, ...]:
    """Settings of several variants together: later settings replace earlier ones, and removing a group removes its settings."""
    settings: dict[str, str] = {}
    for part in parts:
        for setting in part.settings:
            key, value = setting.split("=", 1)
            if value == "none":
                settings = {one: other for one, other in settings.items() if not one.startswith(f"{key}.")}
            settings[key] = value
    return tuple(f"{key}={value}" for key, value in settings.items())


REQUIRED = re.compile(r"&(\w+)(?: of (\w+))? (\w+): required\b")
NOT_OF_LAW = re.compile(r"&(\w+) (\w+) = \S+: must be one of (\w+)")


def completed(variant: Variant, message: str, case: Case, template: dict[str, dict[str, Key]]) -> Variant | None:
    """The variant with the key that was missing when the program refused it, taken from the template; None if it cannot be
    completed."""
    if match := REQUIRED.search(message):
        group, key = match[1], match[3]
        given = (name for name in PREFIXES if any(one.startswith(f"{name}{group}.") for one in variant.settings))
        place = f"{match[2]}." if match[2] else next(given, "")
        value = missing_value(f"{place}{group}", group, key, case, template)
        if value is None:
            return None
        where = " at the crank pin" if match[2] else ""
        setting, assumed = f"{place}{group}.{key}={value}", f"{key} = {value}{where}"
    elif match := NOT_OF_LAW.search(message):
        setting, assumed = f"{match[1]}.{match[2]}={match[3]}", ""
    else:
        return None
    if any(one.split("=")[0] == setting.split("=")[0] for one in variant.settings):
        return None
    joined = ", ".join(part for part in (variant.assumed, assumed) if part)
    return replace(variant, settings=(*variant.settings, setting), assumed=joined)


def missing_value(name: str, group: str, key: str, case: Case, template: dict[str, dict[str, Key]]) -> str | None:
    if key == "kinematic_viscosity" and case.get(name, {}).get("viscosity"):
        density = float(template[group]["viscosity"].value) / float(template[group][key].value)
        return f"{float(case[name]['viscosity']) / density:.6g}"
    if key == "bedding_modulus":  # for a bearing wall as thick as the bearing's radius
        joint = case.get(name.replace(group, "joint"), {})
        modulus = case.get(name, {}).get("youngs_modulus", [0.0])
        modulus = modulus[0] if isinstance(modulus, list) else modulus
        return f"{modulus / joint['bearing_radius']:.6g}" if joint.get("bearing_radius") and modulus else None
    found = template.get(group, {}).get(key)
    return found.value if found else None


def case_name(path: Path) -> str:
    return path.name.removesuffix(".nml")
