"""Labels of the parameters and results of studies on axes, and the units in which they are shown."""

import re
import subprocess
import sys
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gudgeon.program import release_program
from gudgeon.results import MissingResult

#: Places of bearings: prefix of their columns and rows, and name.
PLACES = {
    "piston_pin": ("", "piston pin"),
    "small_end": ("small_end_", "small end"),
    "crank_pin": ("crank_pin_", "crank pin"),
    "main_bearing": ("main_bearing_", "main bearing"),
}

#: Keys of a case whose names alone are not clear as labels.
KEYS = {
    "joint.clearance": "radial clearance",
    "crank_pin.joint.clearance": "crank pin's radial clearance",
    "small_end.joint.clearance": "radial clearance in the small end",
    "asperities.roughness": "combined roughness",
    "initial.crank_speed": "crank speed",
    "lubrication.viscosity": "viscosity",
    "joint.bearing_length": "bearing length",
    "joint.bearing_radius": "bearing radius",
    "contact.restitution": "coefficient of restitution",
    "friction.coefficient": "coefficient of friction",
    "mechanism.gravity": "gravity",
    "drive.damping": "damping of the crank",
    "mechanism.axis_offset": "offset of the cylinder axis",
}

#: Columns of results whose names alone are not clear as labels.
COLUMNS = {
    "min_film_thickness": "smallest film thickness",
    "cycle_min_film_thickness": "thinnest film in the last cycle",
    "cycle_max_force": "largest force in the last cycle",
    "min_film_thickness_mean": "smallest film thickness of a revolution, mean",
    "contact_time_fraction": "time in contact",
    "max_penetration": "largest penetration",
    "max_pin_force": "largest pin force",
    "max_pin_force_mean": "largest pin force of a revolution, mean",
    "mean_pin_force": "mean pin force",
    "mean_crank_speed": "mean crank speed",
    "dissipated_energy": "energy dissipated in a revolution",
    "rhs_evaluations": "evaluations",
    "period_revolutions": "period",
    "lyapunov_exponent": "Lyapunov exponent",
    "small_end_min_film_thickness": "smallest film thickness in the small end",
    "small_end_eccentricity_rate_x_max_abs": "speed of the pin across the small end",
    "small_end_asperity_force_max": "force of asperities in the small end",
    "guide_force_max_abs": "largest side force",
    "guide_friction_power_mean": "power of the friction",
    "pin_speed_rms": "speed of the pin, root mean square",
    "eccentricity_y": "eccentricity across the cylinder",
    "eccentricity_x": "eccentricity along the cylinder",
    "piston_velocity": "piston velocity",
}

#: Units that take a prefix.
PREFIXED = ("m", "s", "N", "Pa", "J", "W", "Pa s", "N m", "m/s", "m/h", "m^3/s", "kg")
PREFIXES = ((1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"), (1e6, "M"), (1e9, "G"))


@dataclass(frozen=True)
class Shown:
    """A quantity on an axis: its name, its unit, and the factor from its values to that unit, with what is added then."""

    name: str
    unit: str = ""
    factor: float = 1.0
    shift: float = 0.0

    def __call__(self, values: np.ndarray | float) -> np.ndarray | float:
        """Values in the unit shown."""
        return self.factor * values + self.shift

    @property
    def label(self) -> str:
        return f"{self.name} [{self.unit}]" if self.unit else self.name


_in_rpm: bool | None = None


def speeds_in_rpm(wanted: bool | None) -> None:
    """Whether pictures show crank speeds in rpm instead of rad/s. None: those of runs, but keys of studies in the unit of their values."""
    global _in_rpm
    _in_rpm = wanted


def shown_unit(name: str, unit: str, values: np.ndarray) -> tuple[str, float]:
    """The unit in which a picture shows a column or key, and the factor to this unit."""
    in_rpm = "." not in name if _in_rpm is None else _in_rpm
    if in_rpm and unit == "rad/s" and name.endswith("crank_speed"):
        return "rpm", 30 / np.pi
    return prefixed(unit.replace(".", " "), values)


def prefixed(unit: str, values: np.ndarray) -> tuple[str, float]:
    """The unit with the prefix that brings the largest value between 1 and 1000, and the factor to this unit."""
    sizes = np.abs(values[np.isfinite(values)])
    if unit not in PREFIXED or not sizes.any():
        return unit, 1.0
    largest = sizes.max()
    if unit == "m^3/s":
        return ("mm³/s", 1e9) if largest < 1e-3 else ("m³/s", 1.0)
    fitting = [item for item in PREFIXES if item[0] <= largest * (1 + 1e-9) and not (unit == "kg" and item[0] != 1)]
    size, prefix = fitting[-1] if fitting else PREFIXES[0] if unit != "kg" else (1.0, "")
    return prefix + unit, 1.0 / size


def readable(unit: str, value: float) -> tuple[str, float]:
    """The unit in which an engineer writes a value, and the factor to it: lengths of films in µm, speeds in m/s and pressures of a gas
    ("bar", of a value in Pa) in bar, unless they are far too small or large for that; all others by `prefixed`."""
    size = abs(value)
    if 0 < size < 1e-10:   # rounding, of which no prefix tells anything
        return ("Pa" if unit == "bar" else unit), 1.0
    if unit == "bar" and not 0 < size < 1e4:
        return unit, 1e-5
    if unit == "m" and 1e-7 <= size < 1e-3:
        return "µm", 1e6
    if unit == "m/s" and 0.1 <= size < 1e3:
        return unit, 1.0
    return prefixed("Pa" if unit == "bar" else unit, np.array([value], dtype=float))


#: Units of axes, each with the SI unit of its values.
OF_AXES = {"kN": "N", "N": "N", "µm": "m", "MPa": "Pa", "mJ": "J", "J": "J", "W": "W", "N m": "N m", "mPa s": "Pa s", "cm³/s": "m^3/s", "10³ m/s²": "m/s²", "10³ rad/s²": "rad/s²"}


def suited(unit: str, factor: float, values: np.ndarray) -> tuple[str, float]:
    """The unit of an axis and the factor from SI to it: those given, unless the largest of the values were below 0.1 or at least 1e4 in this unit, as
    in very small and very large machines; then the unit with the prefix that suits it."""
    largest = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    if 0.1 <= factor * largest < 1e4 or not largest or unit not in (*OF_AXES, "cm³"):
        return unit, factor
    if unit == "cm³":
        return ("mm³", 1e9) if factor * largest < 0.1 else ("l", 1e3)
    return prefixed(OF_AXES[unit], np.array([largest]))


def plain_unit(unit: str) -> str:
    """A unit in typographic form; empty for a number without unit."""
    if unit in ("-", "1", ""):
        return ""
    unit = re.sub(r"(?<=[a-z])\^?([23])(?!\d)", lambda power: "²³"[int(power[1]) - 2], unit)
    return unit.replace(".", " ").replace("degrees", "deg")


@lru_cache
def key_units() -> dict[str, str]:
    """The unit of every key of a case, from the program's template; empty, with a line on standard error, if the program cannot be built or run."""
    try:
        text = subprocess.run([release_program(), "--template"], capture_output=True, text=True, check=True).stdout
    except (MissingResult, OSError, subprocess.CalledProcessError) as problem:
        print(f"parameters of studies are drawn without units: {problem}", file=sys.stderr)
        return {}
    units, group = {}, ""
    for line in text.splitlines():
        line = line.removeprefix("!").strip()  # before groups that a case may have
        if line.startswith("&"):
            group = line[1:].strip()
        elif match := re.match(r"\s*(\w+) = .*?! ([^,:]+)[,:]", line):
            found = match[2].strip()
            units[f"{group}.{match[1]}"] = "" if re.match(r"[<>]|one of|required|default", found) else found
    return units


def of_parameter(key: str, values: np.ndarray) -> Shown:
    """A key of a study, as an axis shows it."""
    own = re.split(r"[\[(]", key)[0].split(".")[-2:]   # KEY[2] or KEY(2): one number of a list
    name = KEYS.get(key) or key.split(".")[-1].replace("_", " ")
    unit = key_units().get(".".join(own), "")
    unit = unit if re.fullmatch(r"[\w/ ^.]{1,12}", unit) and " " not in unit.replace("Pa s", "").replace("N m", "") else ""
    return shown_in(name, *shown_unit(key, unit, np.asarray(values, dtype=float)))


def of_column(column: str, unit: str, values: np.ndarray) -> Shown:
    """A column of a study's results, as an axis shows it. A film thickness that is negative in every run is shown as a
    penetration."""
    values = np.asarray(values, dtype=float)
    finite = values[np.isfinite(values)]
    if column == "min_film_thickness" and finite.size and (finite < 0).all():
        shown, factor = prefixed(unit, values)
        return Shown("largest penetration", shown, -factor)
    name = COLUMNS.get(column) or column.replace("_", " ")
    if column.endswith("_fraction"):
        return Shown(name, "%", 100.0)
    return shown_in(name, *shown_unit(column, unit, values))


#: Ends of the names of quantities that are no temperature, or no angle, though they have its unit.
NO_PLACE = ("difference", "range", "rms")


def shown_in(name: str, unit: str, factor: float) -> Shown:
    """A quantity in a unit; temperatures in °C."""
    return Shown(name, "°C", 1.0, -273.15) if unit == "K" and not name.endswith(NO_PLACE) else Shown(name, plain_unit(unit), factor)
