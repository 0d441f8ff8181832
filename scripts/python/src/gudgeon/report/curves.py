"""The plots of a page: curves of a run over time, orbits, and planes of two quantities."""

from collections.abc import Sequence

import numpy as np
from gudgeon.names import PLACES, prefixed, suited
from gudgeon.results import Run

#: Axes of an orbit.
ECCENTRICITIES = ("<i>e<sub>y</sub></i> / <i>c</i>", "<i>e<sub>x</sub></i> / <i>c</i>")

#: Corners of a skirt in its bore, and their names on the page.
CORNERS = {1: "top, +y", 2: "bottom, +y", 3: "top, -y", 4: "bottom, -y"}

#: Plots over time: column, title, unit shown, factor; with the curve of the ideal joint if there is such a run.
OVER_TIME = (
    ("pin_force", "Pin force", "kN", 1e-3),
    ("pin_angle", "Angle of the pin", "°", 180 / np.pi),
    ("pin_speed", "Speed of the pin", "rad/s", 1.0),
    ("crank_speed", "Crank speed", "rpm", 30 / np.pi),
    ("crank_acceleration", "Crank angular acceleration", "10³ rad/s²", 1e-3),
    ("rod_acceleration", "Rod angular acceleration", "10³ rad/s²", 1e-3),
    ("piston_acceleration", "Piston acceleration", "10³ m/s²", 1e-3),
    ("rod_mid_deflection", "Rod: deflection half way", "µm", 1e6),
    ("rod_stretch", "Rod: stretch", "µm", 1e6),
    ("rod_strain_energy", "Rod: strain energy", "mJ", 1e3),
    ("crankshaft_twist", "Crankshaft: twist", "mrad", 1e3),
    ("crank_moment", "Crank moment", "N m", 1.0),
    ("engine_moment_z", "Roll moment on the engine", "N m", 1.0),
    ("engine_force_x", "Force on the engine along the cylinder", "kN", 1e-3),
    ("guide_force", "Guide force", "kN", 1e-3),
    ("guide_friction_force", "Friction of the piston on its guide", "N", 1.0),
    ("skirt_force", "Force on the skirt", "kN", 1e-3),
    ("skirt_min_film_thickness", "Least film of the skirt", "µm", 1e6),
    ("ring_friction_force", "Friction of the piston rings", "N", 1.0),
    ("piston_offset", "Piston across its bore", "µm", 1e6),
    ("piston_tilt", "Tilt of the piston", "mrad", 1e3),
    ("gas_force", "Gas force", "kN", 1e-3),
    ("energy_residual", "Energy residual", "J", 1.0),
)

#: Plots over time of every bearing, by the part of their columns behind the place: title, unit shown, factor. Those of the first
#: come before all other plots.
FIRST_OF_BEARINGS = (
    ("film_thickness", "film thickness (below 0: penetration)", "µm", 1e6),
    ("normal_force", "contact force", "kN", 1e-3),
)

OF_BEARINGS = (
    ("eccentricity_ratio", "eccentricity over the clearance", "", 1.0),
    ("asperity_force", "force of the asperities", "kN", 1e-3),
    ("friction_force", "friction", "N", 1.0),
    ("film_temperature", "film temperature", "°C", 1.0),
    ("film_viscosity", "viscosity of the film", "mPa s", 1e3),
    ("max_film_pressure", "largest film pressure", "MPa", 1e-6),
    ("film_power", "power that the film takes", "W", 1.0),
    ("film_side_flow", "oil flow out of the film", "cm³/s", 1e6),
    ("film_moment", "moment of the oil shear", "N m", 1.0),
    ("film_force", "film force", "kN", 1e-3),
)

#: Units of columns in a trace, and what a page shows: unit and factor.
UNITS = {"K": ("°C", 1.0), "m": ("µm", 1e6), "N": ("kN", 1e-3), "Pa": ("MPa", 1e-6), "kg/s": ("g/s", 1e3), "Pa.s": ("mPa s", 1e3), "N.m": ("N m", 1.0)}

#: Plots in which the run of the ideal joint has a plot of its own, because the quantity is a property of that run.
APART = ("energy_residual",)

#: A plot over time: title, unit shown, factor, and the columns of its curves with their names.
Listed = tuple[str, str, float, list[tuple[str, str]]]

#: Colours of the bearings' curves in one chart, by place.
OF_PLACE = dict(zip(PLACES, ("blue", "vermilion", "green", "purple")))


def with_sizes(run: Run) -> dict[str, np.ndarray]:
    """The run's columns, temperatures in °C, and the magnitudes of the forces on the pins, the crank and in the films."""
    columns = {name: run[name] - (273.15 if run.units.get(name) == "K" else 0.0) for name in run.trace.columns}
    for name in [name.removesuffix("_x") for name in columns if name.endswith("force_x")]:
        if f"{name}_y" in columns:
            columns[name] = np.hypot(run[f"{name}_x"], run[f"{name}_y"])
    return columns


def over_time(columns: dict[str, np.ndarray], run: Run) -> list[Listed]:
    """The plots over time: those of every run, one for each quantity of the bearings, and those of the columns that the case asks for
    by name."""

    def of_bearings(listed: Sequence[tuple[str, str, str, float]]) -> list[Listed]:
        found = []
        for name, title, unit, factor in listed:
            those = [(place, pre + name) for place, (pre, _) in PLACES.items() if pre + name in columns and is_informative(columns[pre + name])]
            pre = named_bearing(columns, those[0][0]) if len(those) == 1 else ""
            found.append(((pre + title).capitalize(), unit, factor, [(column, PLACES[place][1]) for place, column in those]))
        return found

    of_machine: list[Listed] = [(title, unit, factor, [(name, "")]) for name, title, unit, factor in OVER_TIME]
    if "crankpin_force" in columns:
        of_machine[0] = ("Forces on the pins", "kN", 1e-3, [("pin_force", "piston pin"), ("crankpin_force", "crank pin")])
    found = of_bearings(FIRST_OF_BEARINGS) + of_machine + of_bearings(OF_BEARINGS)
    known = {name for *_, curves in found for name, _ in curves} | {name for name in columns if name.endswith(("_x", "_y")) and name[:-2] in columns}
    asked = [part.strip() for part in str(run.parameter("output", "columns", "")).split(",")]
    for name in asked:
        if name in columns and name not in known and name not in ("time", "crank_angle"):
            unit, factor = UNITS.get(run.units.get(name, ""), (run.units.get(name, ""), 1.0))
            found.append((name.replace("_", " ").capitalize(), unit, factor, [(name, "")]))
    return found


def named_bearing(columns: dict[str, np.ndarray], place: str) -> str:
    """The name of a bearing before a quantity; empty for the piston pin's if there is no other."""
    pre, name = PLACES[place]
    others = any(f"{other}eccentricity_x" in columns for other, _ in PLACES.values() if other)
    return f"{name}: " if pre or others else ""


def is_informative(values: np.ndarray) -> bool:
    return bool(np.ptp(values) > 0)


def timed(name: str, factor: float, said: str, colour: str) -> dict:
    """A curve over time."""
    return {"name": said, "x": "time", "x_factor": 1e3, "y": name, "y_factor": factor, "colour": colour}


def colour_of(bearing: str) -> str:
    """Colour of a bearing, by its name."""
    return next(OF_PLACE[place] for place, (_, name) in PLACES.items() if name == bearing)


def timed_plot(title: str, unit: str, curves: list[dict]) -> dict:
    """A plot over time."""
    return {"title": title, "x": "time [ms]", "y": unit, "timed": True, "curves": curves}


def plane(title: str, x: str, y: str, names: tuple[str, str], factors: tuple[float, float], **more: object) -> dict:
    """A plot of one quantity over another one, with one curve."""
    curve = {"name": title, "x": names[0], "x_factor": factors[0], "y": names[1], "y_factor": factors[1], "colour": "blue"}
    return {"title": title, "x": x, "y": y, "timed": False, "square": True, "curves": [curve], **more}


def orbit(title: str, pre: str, clearance: float) -> dict:
    """The orbit of a pin over its clearance [m]; `pre` comes before the names of its columns."""
    names = (f"{pre}eccentricity_y", f"{pre}eccentricity_x")
    return plane(title, *ECCENTRICITIES, names, (1 / clearance,) * 2, circle=True, phase=f"{pre}phase")


def plots(columns: dict[str, np.ndarray], run: Run) -> list[dict]:
    """The plots of the page, in the form that its script expects: curves refer to columns by name."""
    over = [*plots_of_quantities(columns, run), *plots_of_corners(columns)]
    for plot in over:
        plot["y"], factor = suited(plot["y"], plot["curves"][0]["y_factor"], np.concatenate([columns[curve["y"]] for curve in plot["curves"]]))
        for curve in plot["curves"]:
            curve["y_factor"] = factor
    return [*over, *planes(columns, run)]


def plots_of_quantities(columns: dict[str, np.ndarray], run: Run) -> list[dict]:
    """The plots over time that `over_time` lists, with the curves of the ideal joint."""
    found = []
    for title, unit, factor, listed in over_time(columns, run):
        listed = [(name, said) for name, said in listed if name in columns and is_informative(columns[name])]
        if listed and listed[0][0] in APART:
            name = listed[0][0]
            for run_name, said in ((name, title), (f"ideal {name}", f"{title} of the ideal joint's run")):
                if run_name in columns and is_informative(columns[run_name]):
                    shown_unit, factor = prefixed(unit, columns[run_name])
                    found.append(timed_plot(said, shown_unit, [timed(run_name, factor, said, "blue" if run_name == name else "ink")]))
            continue
        several, curves = len(listed) > 1, []
        for name, said in listed:
            colour = colour_of(said) if several else "blue"
            curves.append(timed(name, factor, said if several else "this run", colour))
            if f"ideal {name}" in columns:
                curves.append(timed(f"ideal {name}", factor, "ideal joint", colour if several else "ink") | {"dash": "dash"})
        if curves:
            found.append(timed_plot(title, unit, curves))
    return found


def plots_of_corners(columns: dict[str, np.ndarray]) -> list[dict]:
    """The plots over time of the corners of a skirt."""
    found = []
    for quantity, title, unit, factor in (
        ("gap", "Gaps of the skirt's corners (below 0: penetration)", "µm", 1e6),
        ("deflection", "Deflections of the skirt's faces", "µm", 1e6),
        ("force", "Forces on the skirt's corners", "kN", 1e-3),
    ):
        curves = [timed(f"guide_{corner}_{quantity}", factor, said, colour)
                  for (corner, said), colour in zip(CORNERS.items(), ("blue", "green", "vermilion", "purple")) if f"guide_{corner}_{quantity}" in columns]
        if curves:
            found.append(timed_plot(title, unit, curves))
    return found


def planes(columns: dict[str, np.ndarray], run: Run) -> list[dict]:
    """Orbits of the pins, the piston's acceleration over its velocity, and the p-V diagram."""
    found = [orbit("Pin orbit over the clearance", "", run.clearance)] if run.clearance else []
    for place, title in (("small_end", "Orbit of the pin in the small end"), ("crank_pin", "Orbit of the crank pin"),
                         ("main_bearing", "Orbit in the main bearing")):
        if f"{place}_phase" in columns:
            found.append(orbit(title, f"{place}_", float(run.parameter(f"{place}.joint", "clearance"))))
    unit, factor = suited("10³ m/s²", 1e-3, columns["piston_acceleration"])
    found.append(plane("Piston: velocity and acceleration", "velocity [m/s]", f"acceleration [{unit}]",
                       ("piston_velocity", "piston_acceleration"), (1.0, factor)))
    if "cylinder_volume" in columns:
        unit, factor = suited("cm³", 1e6, columns["cylinder_volume"])
        found.append(plane("p–V diagram", f"{run.volume} [{unit}]", "pressure [bar]", ("cylinder_volume", "cylinder_pressure"), (factor, 1e-5)))
    return found
