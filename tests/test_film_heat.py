#!/usr/bin/env python3
"""Heating of films, from the columns of whole runs: forces, losses and temperatures against own formulas and quadrature, the ledger
of heat, settled temperatures against plain runs, runs in two halves, shear thinning, and what is refused.

    .venv/bin/python tests/test_film_heat.py [--program PATH]        (after scripts/setup.sh --python)

No formula of the program is used: the viscosity is solved from ASTM D341, the short film is integrated as Booker (1965) has it.
Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))
sys.path.insert(0, str(TOP / "tests"))

from measured import use_virtual_environment

use_virtual_environment()

import numpy as np
import pandas as pd
from assertions import Assertions
from gudgeon.program import release_program
from scipy.integrate import cumulative_simpson
from scipy.optimize import brentq

assertions = Assertions()
check = assertions.check

RADIUS, LENGTH, CLEARANCE = 0.024, 0.02, 25e-6   # of the crank pin and its bearing [m]
OIL = {"known_temperatures": (313.15, 373.15), "known_viscosities": (1e-4, 1.14e-5), "density": 884.0}
INLET, HOUSING, CONDUCTANCE, SPECIFIC_HEAT = 363.15, 353.15, 4.0, 2000.0

ENGINE = """
&mechanism crank_length=0.045, crank_mass=1.1, crank_inertia=0.004, crank_com=0.006,-0.002, rod_length=0.15, rod_mass=0.62,
  rod_inertia=0.0024, rod_com=0.042,0.003, piston_mass=0.47 /
&drive kind='constant_speed' /
&initial crank_speed=314.1592653589793 /
&combustion bore=0.082, compression_ratio=9.5, heat_capacity_ratio=1.35, heat=900.0, wiebe_efficiency=5.0, wiebe_form=3.0,
  start_deg=345.0, duration_deg=50.0 /
&joint place='crank_pin', kind='clearance', clearance=2.5e-05, bearing_radius=0.024025, bearing_length=0.02 /
&lubrication place='crank_pin', law='finite_bearing', variant='short', viscosity_law='walther', temperature=363.15,
  known_temperatures=313.15,373.15, known_viscosities=0.0001,1.14e-05, density=884.0 /
&heat place='crank_pin', heat_capacity=5.0, inlet_temperature=363.15, conductance=4.0, housing_temperature=353.15 /
&integrator relative_tolerance=1e-9, revolutions=2 /
&output digits=17, samples_per_revolution=7200, columns='standard, crank_pin_film_viscosity' /
"""

PIN = ENGINE.replace("place='crank_pin', ", "").replace("crank_pin_", "")


class Runs:
    """Runs of the program in one folder."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.program, self.folder = program, folder

    def start(self, text: str, name: str, *settings: str) -> subprocess.CompletedProcess:
        case = self.folder / f"{name}.nml"
        case.write_text(text)
        options = [part for setting in settings for part in ("--set", setting)]
        return subprocess.run([self.program, "-q", "-o", self.folder, *options, case], capture_output=True, text=True, check=False)

    def rows(self, name: str) -> pd.DataFrame:
        frame = pd.read_csv(self.folder / f"{name}.csv")
        return frame.rename(columns=lambda column: column.split("[")[0])

    def summary(self, name: str) -> dict[str, float | str]:
        table = pd.read_csv(self.folder / f"{name}.summary.csv").set_index("quantity")["value"]
        return {key: number(value) for key, value in table.items()}

    def run(self, text: str, name: str, *settings: str) -> tuple[pd.DataFrame, dict]:
        """A run that must succeed: its rows and its summary."""
        outcome = self.start(text, name, *settings)
        check(outcome.returncode == 0, f"{name} runs", outcome.stderr)
        if outcome.returncode != 0:
            raise SystemExit(assertions.report())
        return self.rows(name), self.summary(name)


def number(text: object) -> float | str:
    try:
        return float(text)
    except ValueError:
        return str(text)


def density(t: np.ndarray) -> np.ndarray:
    k = 0.6278 / OIL["density"] * (t - 288.15)
    return OIL["density"] * np.exp(-k * (1 + 0.8 * k))


def viscosity(t: float) -> float:
    """Dynamic viscosity [Pa s]: lg lg Z is linear in lg T, and the viscosity with this Z is found by bracketing."""
    def z_of(nu: float) -> float:
        return nu + 0.7 + np.exp(-1.47 - 1.84 * nu - 0.51 * nu**2)

    (t1, t2), (y1, y2) = OIL["known_temperatures"], [np.log10(np.log10(z_of(1e6 * nu))) for nu in OIL["known_viscosities"]]
    y = y1 + (y2 - y1) * np.log10(t / t1) / np.log10(t2 / t1)
    nu = brentq(lambda nu: z_of(nu) - 10 ** 10**y, 1e-3, 1e6, xtol=1e-14, rtol=1e-14)
    return float(density(np.array(t))) * nu * 1e-6


def ocvirk(e: np.ndarray, star: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Force on the pin [N] of the short film, (2, rows): the positive part of 6 mu v*.r (L^2/4 - z^2)/h^3 summed over angles, with
    Gauss points on each half of the arc, denser towards the thinnest film."""
    force = np.zeros_like(e)
    nodes, weights = np.polynomial.legendre.leggauss(160)
    alpha = np.arctan2(star[1], star[0])
    gamma = np.arctan2(e[1], e[0])
    eps = np.hypot(*e) / CLEARANCE
    for i in range(e.shape[1]):
        ends = alpha[i] + np.array([-np.pi / 2, np.pi / 2])
        thinnest = gamma[i] + 2 * np.pi * np.round((alpha[i] - gamma[i]) / (2 * np.pi))
        parts = np.unique(np.concatenate([ends, [a for a in thinnest + np.array([-0.4, 0, 0.4]) if ends[0] < a < ends[1]]]))
        for a, b in zip(parts[:-1], parts[1:], strict=True):
            theta = (a + b) / 2 + (b - a) / 2 * nodes
            h = CLEARANCE * (1 - eps[i] * np.cos(theta - gamma[i]))
            p = mu[i] * np.hypot(*star[:, i]) * np.cos(theta - alpha[i]) * LENGTH**3 / h**3   # 6 mu v*.r times L^3/6
            force[:, i] -= (b - a) / 2 * RADIUS * np.array([weights @ (p * np.cos(theta)), weights @ (p * np.sin(theta))])
    return force


def balance(runs: Runs) -> None:
    """Force, power, flow and temperature in a dynamic scene, row by row."""
    rows, summary = runs.run(ENGINE, "engine")
    e = rows[["crank_pin_eccentricity_x", "crank_pin_eccentricity_y"]].to_numpy().T
    rate = rows[["crank_pin_eccentricity_rate_x", "crank_pin_eccentricity_rate_y"]].to_numpy().T
    pin, bearing = rows["crank_speed"].to_numpy(), -rows["rod_speed"].to_numpy()
    star = rate - 0.5 * (pin + bearing) * np.array([-e[1], e[0]])
    temperature = rows["crank_pin_film_temperature"].to_numpy()
    some = np.arange(7, len(rows), 41)
    mu = np.array([viscosity(t) for t in temperature[some]])
    wrong = np.abs(rows["crank_pin_film_viscosity"].to_numpy()[some] / mu - 1).max()
    check(wrong < 1e-12, "viscosity of the film by ASTM D341 at its temperature", f"{wrong:.1e}")
    found = rows[["crank_pin_film_force_x", "crank_pin_film_force_y"]].to_numpy().T
    wrong = np.abs(ocvirk(e[:, some], star[:, some], mu) - found[:, some]).max() / np.abs(found).max()
    check(wrong < 1e-9, "force of the short film at this viscosity", f"{wrong:.1e}")
    mu_all = rows["crank_pin_film_viscosity"].to_numpy()
    eps = np.hypot(*e) / CLEARANCE
    drag = mu_all * (pin - bearing) ** 2 * RADIUS**3 * LENGTH * 2 * np.pi / (CLEARANCE * np.sqrt(1 - eps**2))
    power = -(found * star).sum(axis=0) + drag
    flow = 2 * RADIUS * LENGTH * np.hypot(*star)
    to_oil = density(temperature) * SPECIFIC_HEAT * flow * (temperature - INLET)
    to_housing = CONDUCTANCE * (temperature - HOUSING)
    time = rows["time"].to_numpy()
    expected = temperature[0] + cumulative_simpson((power - to_oil - to_housing) / 5.0, x=time, initial=0)
    wrong = np.abs(temperature - expected)
    check(wrong.max() < 3e-6, "temperature is the integral of what heats and cools the film", f"{wrong.max():.1e} K")
    check(np.ptp(temperature) > 0.3, "the film warms in this scene", f"{np.ptp(temperature):.3f} K")
    for name, rates in (("heat_in", power), ("heat_to_oil", to_oil), ("heat_to_housing", to_housing)):
        whole = cumulative_simpson(rates, x=time, initial=0)[-1]
        wrong = abs(summary[f"crank_pin_{name}"] - whole) / abs(whole)
        check(wrong < 1e-5, f"{name} is its integral over the run", f"{wrong:.1e}")
    check(abs(summary["crank_pin_heat_residual"]) < 1e-7 * summary["crank_pin_heat_in"], "the ledger of heat closes",
          str(summary["crank_pin_heat_residual"]))
    mean = cumulative_simpson(temperature, x=time, initial=0)[-1] / time[-1]
    check(abs(summary["crank_pin_cycle_mean_film_temperature"] - mean) < 1e-6, "mean temperature of the cycle",
          f"{summary['crank_pin_cycle_mean_film_temperature']} {mean}")
    check(abs(summary["crank_pin_cycle_heat_to_oil"] - summary["crank_pin_heat_to_oil"]) < 1e-9, "a run of one cycle is that cycle")


def other_elements(runs: Runs) -> None:
    """The temperature against the integral of powers that have columns, for every kind of load element with a film, at both pins."""
    contact = "&contact law='hertz', youngs_modulus=2*207e9, poissons_ratio=2*0.3 /\n"
    impacts = contact.replace("hertz", "lankarani_nikravesh") + "&friction law='ambrosio', coefficient=0.1, v0=0.001, v1=0.01 /\n"
    rough = "&asperities roughness=1e-6, youngs_modulus=2*207e9, poissons_ratio=2*0.3, coefficient=0.1 /\n"
    cases = {
        "rough": (rough, ("lubrication.known_viscosities=0.00001,0.000002",)),
        "elastic": (contact, ("lubrication.elastic_film=T", "contact.geometry=johnson", "lubrication.pressure_viscosity=1e-8")),
        "weighted": (impacts, ("lubrication.transition=weighted",
                     "lubrication.transition_depth=1e-6", "lubrication.known_viscosities=0.0000015,0.0000005",
                     "initial.eccentricity=2.51e-5,0")),
        "no_moment": ("", ("lubrication.film_moment=F",)),
        "long": ("", ("lubrication.law=pinkus_sternlicht", "lubrication.variant=closed_form")),
        "own_flow": ("", ("heat.side_flow=1e-6",)),
        # on the side to which the load presses: a pin that leaves the other one slowly meets the unbounded force of a film of no thickness
        "touching": (impacts, ("lubrication.law=pinkus_sternlicht", "lubrication.variant=half_film", "initial.eccentricity=-2.51e-5,0",
                      "lubrication.known_viscosities=0.00001,0.000002")),
    }
    for name, (groups, settings) in cases.items():
        for text, prefix in ((ENGINE, "crank_pin_"), (PIN, "")):
            asked = "film_power" + (", film_side_flow" if name not in ("long", "touching") else "")
            asked += ", neglected_shear_power" if name in ("no_moment", "long", "touching") else ""
            columns = "standard, " + ", ".join(prefix + column for column in asked.split(", "))
            own = [setting.replace("initial.", f"initial.{prefix}") for setting in settings]
            own = [f"{prefix.rstrip('_')}.{part}" if prefix and not part.startswith("initial.") else part for part in own]
            place = "place='crank_pin', " if prefix else ""
            rows, summary = runs.run(text + groups.replace("&contact ", f"&contact {place}").replace("&asperities ",
                                     f"&asperities {place}").replace("&friction ", f"&friction {place}"), f"{prefix}{name}",
                                     f"output.columns={columns}", "integrator.revolutions=1",
                                     "integrator.relative_tolerance=1e-8", *own)
            column = {part: rows[prefix + part].to_numpy() if prefix + part in rows else np.zeros(len(rows)) for part in (
                "film_power", "neglected_shear_power", "film_side_flow", "friction_force", "sliding_speed", "film_temperature")}
            if name == "own_flow":
                column["film_side_flow"] = 1e-6
            t, time = column["film_temperature"], rows["time"].to_numpy()
            power = column["film_power"] + column["neglected_shear_power"] - column["friction_force"] * column["sliding_speed"]
            out = density(t) * SPECIFIC_HEAT * column["film_side_flow"] * (t - INLET) + CONDUCTANCE * (t - HOUSING)
            expected = t[0] + cumulative_simpson((power - out) / 5.0, x=time, initial=0)
            rise = np.abs(t - t[0]).max()
            wrong = np.abs(t - expected).max()
            limit = 2e-2 if name in ("touching", "weighted") else 2e-4   # the rows do not resolve impacts
            check(wrong < limit * max(rise, 0.01), f"temperature against powers, {prefix}{name}", f"{wrong:.1e} of {rise:.2e} K")
            pre = prefix
            check(abs(summary[f"{pre}heat_residual"]) < 1e-5 * (abs(summary[f"{pre}heat_in"]) + abs(summary[f"{pre}heat_to_housing"])),
                  f"ledger of heat, {prefix}{name}", str(summary[f"{pre}heat_residual"]))
            if name in ("rough", "touching", "weighted"):
                friction = np.abs(column["friction_force"] * column["sliding_speed"]).max()
                check(friction > 0.1, f"surfaces rub, {prefix}{name}", f"{friction:.1e} W")


def settled(runs: Runs) -> None:
    """Jumps lead where a plain run goes, for one bearing and for two."""
    quick = ("integrator.relative_tolerance=1e-8", "output.samples_per_revolution=72", "output.columns=standard")
    capacity = "crank_pin.heat.heat_capacity=4"
    _, plain = runs.run(ENGINE, "plain", *quick, capacity, "integrator.revolutions=160", "crank_pin.lubrication.temperature=372.7")
    _, jumps = runs.run(ENGINE, "jumps", *quick, capacity, "run.until=periodic", "integrator.revolutions=0")
    check(jumps["motion"] == "periodic", "the motion with jumps is periodic")
    check(1 <= jumps["crank_pin_temperature_jumps"] <= 8, "some jumps", str(jumps["crank_pin_temperature_jumps"]))
    wrong = abs(plain["crank_pin_cycle_mean_film_temperature"] - jumps["crank_pin_cycle_mean_film_temperature"])
    check(wrong < 1e-4, "jumps lead where a plain run goes", f"{wrong:.1e} K")
    check("crank_pin_temperature_jumps" not in plain, "a run until the end never jumps")
    _, slow = runs.run(ENGINE, "slow", *quick, "crank_pin.heat.heat_capacity=60", "run.until=periodic", "integrator.revolutions=0")
    check(slow["periodic_after"] <= 40, "a slow film settles within 20 cycles", str(slow["periodic_after"]))
    gap = slow["crank_pin_cycle_heat_to_oil"] + slow["crank_pin_cycle_heat_to_housing"] \
        - slow["crank_pin_cycle_mean_film_power"] * slow["cycle_duration"]
    check(abs(gap) < 3e-6 * slow["crank_pin_cycle_heat_to_housing"], "heat of a settled cycle balances", f"{gap:.1e} J")
    check(abs(slow["crank_pin_heat_residual"]) < 1e-6 * slow["crank_pin_heat_in"], "the ledger closes over jumps",
          str(slow["crank_pin_heat_residual"]))
    for tolerance in (1e-3, 1e-4, 1e-5):   # too loose to improve the first estimate of the jumps' slope
        _, loose = runs.run(ENGINE, "loose", *quick[1:], f"integrator.relative_tolerance={tolerance}", "run.until=periodic",
                            "integrator.revolutions=0", "crank_pin.heat.heat_capacity=60")
        check(loose["motion"] == "periodic" and loose["periodic_after"] <= 80, f"a slow film settles at {tolerance:g}",
              f"{loose['motion']}")
        wrong = abs(loose["crank_pin_cycle_mean_film_temperature"] - slow["crank_pin_cycle_mean_film_temperature"])
        check(wrong < 1e-3, f"its temperature at {tolerance:g}", f"{wrong:.1e} K")
    both = ENGINE.replace("place='crank_pin', ", "").replace("&lubrication", "&joint place='crank_pin', kind='clearance', "
                          "clearance=2.5e-05, bearing_radius=0.024025, bearing_length=0.02 /\n&lubrication")
    quick += ("joint.clearance=1.5e-5", "joint.bearing_radius=0.011")
    _, plain = runs.run(both, "two_plain", *quick, "heat.heat_capacity=1", "integrator.revolutions=200")
    _, jumps = runs.run(both, "two_jumps", *quick, "heat.heat_capacity=1", "run.until=periodic", "integrator.revolutions=0")
    for prefix in ("", "crank_pin_"):
        name = f"{prefix}cycle_mean_film_temperature"
        check(abs(plain[name] - jumps[name]) < 1e-3, f"two films settle, {name}", f"{plain[name]} {jumps[name]}")
        check(f"{prefix}temperature_jumps" in jumps, f"both films jump, {prefix}")


def halves(runs: Runs) -> None:
    """A run that goes on from a state has the temperature and the ledger of the whole run."""
    quick = ("output.samples_per_revolution=72", "output.columns=standard")
    _, whole = runs.run(ENGINE, "whole", *quick, "integrator.revolutions=4")
    runs.run(ENGINE, "half", *quick, "integrator.revolutions=2")
    _, second = runs.run(ENGINE, "second", *quick, "integrator.revolutions=4", f"initial.from='{runs.folder}/half.state.nml'")
    for name in ("film_temperature", "heat_in", "heat_to_oil", "heat_stored"):
        wrong = abs(whole[f"crank_pin_{name}"] / second[f"crank_pin_{name}"] - 1)
        check(wrong < 1e-6, f"a run in two halves, {name}", f"{wrong:.1e}")
    check(abs(second["crank_pin_heat_residual"]) < 1e-7, "its ledger closes")


def thinning(runs: Runs) -> None:
    """The viscosity at the rate of shear, and its force, with and without heat."""
    asked = "output.columns=standard, crank_pin_film_viscosity, crank_pin_film_power"
    for name, settings in {"thin_hot": (), "thin": ("crank_pin.heat=none",)}.items():
        rows, _ = runs.run(ENGINE, name, asked, "crank_pin.lubrication.thinning_ratio=0.6", "crank_pin.lubrication.thinning_rate=3e5",
                           "integrator.revolutions=1", *settings)
        e = rows[["crank_pin_eccentricity_x", "crank_pin_eccentricity_y"]].to_numpy().T
        turning = (rows["crank_speed"] + rows["rod_speed"]).to_numpy()
        shear = np.abs(turning) * RADIUS / (CLEARANCE * np.sqrt(1 - (np.hypot(*e) / CLEARANCE) ** 2))
        t = rows["crank_pin_film_temperature"].to_numpy() if name == "thin_hot" else np.full(len(rows), 363.15)
        some = np.arange(3, len(rows), 157)
        expected = np.array([viscosity(t[i]) for i in some]) * (0.6 + 0.4 / (1 + shear[some] / 3e5))
        found = rows["crank_pin_film_viscosity"].to_numpy()
        wrong = np.abs(found[some] / expected - 1).max()
        check(wrong < 1e-12, f"viscosity at the rate of shear, {name}", f"{wrong:.1e}")
        rate = rows[["crank_pin_eccentricity_rate_x", "crank_pin_eccentricity_rate_y"]].to_numpy().T
        star = rate - 0.5 * (rows["crank_speed"] - rows["rod_speed"]).to_numpy() * np.array([-e[1], e[0]])
        force = rows[["crank_pin_film_force_x", "crank_pin_film_force_y"]].to_numpy().T
        wrong = np.abs(ocvirk(e[:, some], star[:, some], found[some]) - force[:, some]).max() / np.abs(force).max()
        check(wrong < 1e-9, f"force of a film that thins, {name}", f"{wrong:.1e}")


def refusals(runs: Runs) -> None:
    """One line each, with exit status 3; a film without a steady state ends with 4."""
    no_heat = "&heat place='crank_pin', heat_capacity=5.0, inlet_temperature=363.15 /"
    for name, text, settings, wanted in (
            ("given", ENGINE, ("crank_pin.lubrication.viscosity_law=given", "crank_pin.lubrication.viscosity=0.01"), "&heat needs an oil"),
            ("no_outflow", ENGINE, ("crank_pin.lubrication.law=pinkus_sternlicht", "crank_pin.lubrication.variant=closed_form",
                                    "crank_pin.heat.conductance=0", "output.columns=standard"), "side_flow"),
            ("printed", ENGINE, ("crank_pin.lubrication.law=pinkus_sternlicht", "crank_pin.lubrication.variant=as_printed",
                                 "output.columns=standard"), "proportional to the viscosity"),
            ("oscillating", ENGINE, ("crank_pin.lubrication.law=oscillating_film", "crank_pin.lubrication.variant=bearing_frame",
                                     "output.columns=standard"), "proportional to the viscosity"),
            ("no_capacity", ENGINE.replace("heat_capacity=5.0, ", ""), (), "heat_capacity"),
            ("no_inlet", ENGINE.replace("inlet_temperature=363.15, ", ""), (), "inlet_temperature"),
            ("cold", ENGINE, ("crank_pin.heat.inlet_temperature=199",), ">= 200"),
            ("hot", ENGINE, ("crank_pin.heat.housing_temperature=701",), "<= 700"),
            ("negative", ENGINE, ("crank_pin.heat.conductance=-1",), ">= 0"),
            ("pole", ENGINE, ("crank_pin.lubrication.viscosity_law=vogel", "crank_pin.lubrication.vogel_temperature=260",
                              "crank_pin.heat.inlet_temperature=265"), "vogel_temperature"),
            ("dry", "\n".join(line for line in ENGINE.split("\n") if "known_temp" not in line).replace(
                "&lubrication place='crank_pin', law='finite_bearing', variant='short', viscosity_law='walther', temperature=363.15,",
                "&contact place='crank_pin', youngs_modulus=2*207e9, poissons_ratio=2*0.3 /"), ("output.columns=standard",),
             "needs the group lubrication"),
            ("ideal", ENGINE, ("crank_pin.joint.kind=ideal",), "ideal"),
            ("no_rate", ENGINE, ("crank_pin.lubrication.thinning_ratio=0.5",), "thinning_rate"),
            ("no_ratio", ENGINE, ("crank_pin.lubrication.thinning_rate=1e5",), "thinning_ratio"),
            ("thick", ENGINE, ("crank_pin.lubrication.thinning_ratio=1.5",), "<= 1")):
        outcome = runs.start(text, name, *settings)
        check(outcome.returncode == 3 and wanted in outcome.stderr, f"refused: {name}", f"{outcome.returncode} {outcome.stderr}")
    hot = ("crank_pin.heat.heat_capacity=0.001", "crank_pin.heat.conductance=1e-6", "crank_pin.heat.side_flow=1e-12",
           "crank_pin.lubrication.temperature=600", "crank_pin.heat.inlet_temperature=600", "crank_pin.lubrication.viscosity_law=vogel",
           "crank_pin.lubrication.known_viscosities=0.01,0.005")
    outcome = runs.start(ENGINE.replace(no_heat, ""), "no_steady_state", *hot)
    check(outcome.returncode == 4 and "reached 700 K: no steady state; more side_flow or conductance" in outcome.stderr,
          "a film without steady state ends the run", f"{outcome.returncode} {outcome.stderr}")


def carried(runs: Runs) -> None:
    """Quasi-static bearings against an independent program: a film that warms under a steady load, and one settled by jumps."""
    bearing = """&bearing_load table='one.csv', period_deg=360 /
&initial crank_speed=314.1592653589793 /
&joint kind='quasi_static', clearance=3e-05, bearing_radius=0.02503, bearing_length=0.02 /
&lubrication law='finite_bearing', variant='short', viscosity_law='walther', temperature=353.15, known_temperatures=313.15,373.15,
  known_viscosities=0.0001,1.14e-05, density=884.0 /
&heat heat_capacity=2.0, inlet_temperature=353.15, conductance=5.0, housing_temperature=343.15 /
&integrator revolutions=50, relative_tolerance=1e-10 /
&output samples_per_revolution=2, digits=17, columns='time, standard, film_power, film_side_flow, max_film_pressure' /
"""
    (runs.folder / "one.csv").write_text("crank_angle[deg],load[N]\n0,4000\n180,4000\n")
    rows, _ = runs.run(bearing, "steady")
    wanted = pd.read_csv(TOP / "data" / "bearing" / "steady_heat.csv").rename(columns=lambda column: column.split("[")[0])
    for name in wanted:
        wrong = np.abs(rows[name].to_numpy()[:len(wanted)] - wanted[name].to_numpy()).max()
        limit = 1e-8 if name == "film_temperature" else 2e-9 * max(np.ptp(wanted[name]), np.abs(wanted[name]).max())
        check(wrong <= limit, f"steady load, film that warms, {name}", f"{wrong:.1e}")
    facts = pd.read_csv(TOP / "data" / "bearing" / "facts.csv").groupby("case")
    facts = {case: dict(zip(group["quantity"], group["value"], strict=True)) for case, group in facts}
    # settled: the temperature by jumps, and the same far from its start
    for start in (353.15, 420.0):
        _, summary = runs.run(bearing, "settled", "run.until=periodic", "integrator.revolutions=0", "heat.heat_capacity=40",
                              f"lubrication.temperature={start}", "run.periodic_tolerance=1e-7")
        fixed = facts["steady_heat, settled (closed form)"]
        wrong = abs(summary["cycle_mean_film_temperature"] - fixed["cycle_mean_film_temperature"])
        check(wrong < 1e-8, f"closed fixed point of the temperature, from {start} K", f"{wrong:.1e} K")
        for name in ("cycle_max_eccentricity_ratio", "cycle_mean_film_power", "cycle_mean_film_side_flow", "cycle_heat_to_oil",
                     "cycle_heat_to_housing"):
            check(abs(summary[name] / fixed[name] - 1) < 1e-8, f"closed fixed point, {name}", str(summary[name]))
    # near the fixed point the true time constant is 2.8 s with C = 40 J/K, below C/(rho c_p Q + G) = 3.6 s
    rows, _ = runs.run(bearing, "relaxes", "heat.heat_capacity=40", "lubrication.temperature=361.0", "integrator.revolutions=100")
    away = rows["film_temperature"].to_numpy() - fixed["cycle_mean_film_temperature"]
    constant = (rows["time"].iloc[-1] - rows["time"].iloc[40]) / np.log(away[40] / away[-1])
    check(abs(constant - 2.8) < 0.06, "time constant", f"{constant:.3f} s")
    case = (TOP / "cases" / "bearings" / "big_end_heat.nml").read_text()
    for tolerance, limit, relative in (("1e-4", 2e-6, 2e-7), ("1e-7", 3e-8, 2e-8)):
        rows, summary = runs.run(case, "big_end_heat", "integrator.relative_tolerance=1e-10", f"run.periodic_tolerance={tolerance}",
                                 "output.digits=17", "output.window=last_period")
        for name, value in facts["big_end_heat"].items():
            if name == "film_temperature at 0 deg":
                turns = rows["crank_angle"] / (4 * np.pi)   # of the load; a period may begin within one
                found = rows["crank_pin_film_temperature"][np.abs(turns - turns.round()).idxmin()]
                check(abs(found - value) < limit, "settled temperature at 0 degrees", f"{found - value:.1e} K")
            elif name != "cycle_mean_load":
                found = summary[f"crank_pin_{name}"]
                bound = limit if "temperature" in name else 2e-3 if name.endswith("angle") else relative * abs(value)
                check(abs(found - value) < bound, f"big end that heats up, {name}", f"{found} {value}")
        check(summary["periodic_after"] <= 2 * 16, "settled within 16 cycles", str(summary["periodic_after"]))
        check(summary.get("method_switches", 0) == 0, "auto stays explicit")
    # thinning, closed forms: the load, from near the angle of the fixed point
    closed = pd.read_csv(TOP / "data" / "bearing" / "closed.csv")
    for row in closed[closed.iloc[:, 0].str.contains("thinning")].itertuples(index=False):
        eps, load, speed, angle = row[1], row[2], row[3], np.radians(row[6])
        text = bearing.replace("viscosity_law='walther', temperature=353.15, known_temperatures=313.15,373.15,", "viscosity=0.011,")
        text = "\n".join(line for line in text.split("\n") if not line.startswith("&heat")).replace(
            "known_viscosities=0.0001,1.14e-05, density=884.0", "thinning_ratio=0.5, thinning_rate=2e5")
        text = text.replace("bearing_radius=0.02503, bearing_length=0.02", "bearing_radius=0.02003, bearing_length=0.016")
        rows, _ = runs.run(text, "thin_steady", f"initial.crank_speed={speed}", f"bearing_load.factor={load / 4000!r}",
                           "integrator.revolutions=30", f"initial.eccentricity={3e-5 * eps * np.cos(angle)},{3e-5 * eps * np.sin(angle)}")
        check(abs(rows["eccentricity_ratio"].iloc[-1] / eps - 1) < 1e-9, f"eccentricity of a film that thins, {eps}",
              str(rows["eccentricity_ratio"].iloc[-1]))


ROUGH = """
&bearing_load table = 'reversing.csv', period_deg = 360, factor = {factor} /
&initial crank_speed = 68 rpm /
&joint kind = 'quasi_static', clearance = 106 um, bearing_radius = 24 mm, bearing_length = {length} mm /
&lubrication law = 'finite_bearing', variant = '{variant}', oil = 'SAE 10W-40', temperature = 400, report = .true. /
&heat heat_capacity = 100, inlet_temperature = 350 /
&asperities roughness = 1.13 um /
&integrator revolutions = 2 /
"""

# After two revolutions: from an integration of its own, implicit in the position of the pin (SDIRK of order 2 with step doubling, to
# 1e-5): the forces are never inverted, the film is integrated by 48 points of Gauss over Sommerfeld's angle, the asperities by 4,000
# points. Its results at 1e-4 and 1e-5 differ by 2e-6, those of the flow of the narrow bearing by 3e-6.
REVERSED = {
    "wide": {"film_energy_lost": 2.4614711, "heat_in": 130.24412, "heat_to_oil": 120.45432, "film_temperature": 400.0979,
             "mean_film_side_flow": 8.5685623e-7},
    "narrow": {"film_energy_lost": 0.19985498, "heat_in": 31.387498, "heat_to_oil": 16.916749, "film_temperature": 400.14471,
               "mean_film_side_flow": 1.2023021e-7},
}


def rough_reversal(runs: Runs) -> None:
    """A load that reverses lifts the pin out of the roughness of one side and presses it into that of the other. Where the heat of the
    film is not kept, the run says so with its exit status."""
    angles = np.arange(0, 360, 20)
    table = "crank_angle[deg],load[kN]\n" + "".join(f"{a},{171 * np.cos(np.radians(a)):.6f}\n" for a in angles)
    (runs.folder / "reversing.csv").write_text(table)
    for name, factor, length in (("wide", 0.1, 20), ("narrow", 0.01, 2.7)):
        text = ROUGH.format(factor=factor, length=length, variant="short")
        for tolerance in (8e-4, 1e-5, 1e-6, 1e-8):
            _, found = runs.run(text, name, f"integrator.relative_tolerance={tolerance}")
            for quantity, value in REVERSED[name].items():
                wrong = abs(found[quantity] / value - 1)
                check(wrong < max(2 * tolerance, 1e-5), f"{name}, tolerance {tolerance:g}: {quantity}", f"{wrong:.1e}")
            check(found["heat_residual_relative"] < max(0.2 * tolerance, 1e-5), f"{name}, tolerance {tolerance:g}: ledger",
                  str(found["heat_residual_relative"]))
    _, found = runs.run(ROUGH.format(factor=0.1, length=20, variant="short"), "cool", "heat=none", "integrator.relative_tolerance=1e-3")
    wrong = abs(found["film_energy_lost"] / 2.4614197 - 1)   # by the same integration
    check(wrong < 5e-4, "without heat, loosest tolerance", f"{wrong:.1e}")
    # a table, pressed by 51 MPa on its projected area: whatever the tolerance, the run ends, and says what it has not kept
    (runs.folder / "reversing.csv").write_text("crank_angle[deg],load_x[N],load_y[N]\n0,1000,0\n165,1000,0\n180,-1000,0\n345,-1000,0\n")
    text = ("&bearing_load table = 'reversing.csv' /\n&initial crank_speed = 1.4 /\n"
            "&joint kind = 'quasi_static', clearance = 7.27 um, bearing_radius = 8.4 mm, bearing_length = 2.33 mm /\n"
            "&lubrication law = 'finite_bearing', oil = 'ISO VG 46', temperature = 400 /\n"
            "&heat heat_capacity = 1, inlet_temperature = 350 /\n&asperities roughness = 0.267 um /\n&integrator revolutions = 2 /\n")
    for tolerance in (1e-2, 2e-4, 1e-6):
        outcome = runs.start(text, "table", f"integrator.relative_tolerance={tolerance}")
        found = runs.summary("table")
        rest = found["heat_residual_relative"]
        limit = min(0.05, 1e3 * min(tolerance, 1e-3))   # that of the energy
        check(outcome.returncode == (0 if rest <= limit else 4), f"table, tolerance {tolerance:g}: status by the residual", f"{rest:.1e}")
        noted = any("the heat of a film is kept only to" in str(value) for key, value in found.items() if key.startswith("note_"))
        check(noted == (0.1 * limit < rest <= limit), f"table, tolerance {tolerance:g}: note by the residual", f"{rest:.1e}")
        if tolerance < 1e-5:
            check(abs(found["heat_in"] - found["heat_to_oil"] - (found["film_temperature"] - 400)) < 1e-5, "table: ledger", "")


MARCHED = PIN.replace("viscosity_law='walther', temperature=363.15,\n  known_temperatures=313.15,373.15, "
                      "known_viscosities=0.0001,1.14e-05, density=884.0", "viscosity={viscosity}, {thins}cavitation='mass_conserving'")
MARCHED = "\n".join(line for line in MARCHED.split("\n") if not line.startswith(("&heat", "&output", "&integrator"))) + """
&film_history around=48, along=4 /
&supply kind='grooves', position_deg=90, width_deg=30, length=0.012, pressure=2 bar /
&integrator revolutions=4, relative_tolerance=1e-6 /
"""


def marched(runs: Runs) -> None:
    """A film that is marched after a run has the mean of the viscosity of the run, whose film thins: as one of that viscosity. The loads
    of both runs, which the march carries, differ by little."""
    thins, rate = 0.5, 2e4
    rows, thin = runs.run(MARCHED.format(viscosity=0.012, thins=f"thinning_ratio={thins}, thinning_rate={rate}, "), "marched")
    last = rows[rows["crank_angle"] >= rows["crank_angle"].iloc[-1] - 4 * np.pi + 1e-9]
    turning = np.gradient(rows["rod_angle"], rows["time"])[last.index] if "rod_angle" in rows else last["rod_speed"]
    shear = np.abs(turning) * RADIUS / (CLEARANCE * np.sqrt(1 - last["eccentricity_ratio"] ** 2))
    mean = 0.012 * np.mean(thins + (1 - thins) / (1 + shear / rate))
    check(mean < 0.0105, "the oil thins", f"{mean}")
    _, same = runs.run(MARCHED.format(viscosity=mean, thins=""), "marched")
    for name in ("film_history_min_film_thickness", "film_history_mean_supply_flow", "film_history_mean_power_loss"):
        check(abs(thin[name] / same[name] - 1) < 0.01, f"film that thins, {name}", f"{thin[name]} {same[name]}")


IMPOSSIBLE = """
&mechanism crank_length=45 mm, crank_mass=1.1, crank_inertia=0.004, crank_com=0.006, -0.002, rod_length=150 mm, rod_mass=0.62,
  rod_inertia=0.0024, rod_com=0.042, 0.003, piston_mass=664814.3 /
&drive /
&initial crank_speed=314.1592653589793 /
&joint kind='quasi_static', clearance=10 um, bearing_radius=10.01 mm, bearing_length=30 mm /
&contact law='hertz', geometry='conformal', youngs_modulus=2*207 GPa, poissons_ratio=2*0.3 /
&lubrication law='finite_bearing', variant='short', viscosity=9 mPa.s, elastic_film=.true., pressure_viscosity=1.8e-8 /
&integrator revolutions=1, max_evaluations=7500, method='adams' /
"""


def impossible(runs: Runs) -> None:
    """A pin whose film would need 1e10 N: no row has a value that is not finite."""
    outcome = runs.start(IMPOSSIBLE, "impossible")
    text = (runs.folder / "impossible.csv").read_text()
    check(outcome.returncode == 4, "a film without bounds ends the run", str(outcome.returncode))
    check(not {"inf", "nan", "infinity"} & set(text.lower().replace("\n", ",").split(",")), "only finite numbers in rows", text[-300:])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, help="the program; default: the release build")
    parser.add_argument("parts", nargs="*", help="names of tests")
    options = parser.parse_args()
    program = (options.program or release_program()).resolve()
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(program, Path(folder))
        for part in (balance, other_elements, settled, halves, thinning, carried, rough_reversal, marched, impossible, refusals):
            if not options.parts or part.__name__ in options.parts:
                part(runs)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
