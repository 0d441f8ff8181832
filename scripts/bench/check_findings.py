#!/usr/bin/env python3
"""Compares statements of the dissertation about its results with runs of the program, and writes data/measured/findings.md.

    scripts/setup.sh --python
    .venv/bin/python scripts/bench/check_findings.py            # 30 seconds; exit status 1 if a number is outside the range given here
    .venv/bin/python scripts/bench/check_findings.py --check    # the same without writing the table

Each statement of the dissertation is given in our words, together with the command that shows it, a number that is computed from
the result files, and the range in which this number must lie. The simulations write rows at equal crank angles, so that a run and
its ideal joint can be compared row by row.
"""
from __future__ import annotations

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from measured import TOP, built_program, use_virtual_environment, write_table

use_virtual_environment()

import numpy as np

START = 0.02   # share of the run that is left out: the pin is released in the centre and hits the bearing
SIMULATION = ("-a", "reference", "-s", "output.sampling=crank_angle")
LONG = ("-a", "standard", "-s", "integrator.revolutions=62", "-s", "output.sampling=crank_angle", "-s", "output.samples_per_revolution=3600")
SETTLED = slice(12 * 3600, None)
AS_SHIPPED = slice(0, 2 * 3600)


class Runs:
    """Results of cases; each case is run when its result is first needed."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.program, self.folder = program, folder

    @cache
    def of(self, case: str, options: tuple[str, ...] = SIMULATION) -> Run:
        out = self.folder / str(abs(hash((case, options))))
        subprocess.run([self.program, "-q", *options, "-o", out, f"cases/{case}.nml"], cwd=TOP, check=False)
        return Run(out, Path(case).name)


class Run:
    def __init__(self, folder: Path, name: str) -> None:
        self.rows = table(folder / f"{name}.csv")
        ideal = folder / f"{name}.ideal.csv"
        self.ideal = table(ideal) if ideal.exists() else {}
        with (folder / f"{name}.summary.csv").open(encoding="utf-8") as file:
            self.summary = {row["quantity"]: row["value"] for row in csv.DictReader(file)}

    def number(self, quantity: str) -> float:
        return float(self.summary[quantity])

    def deviation(self, column: str) -> np.ndarray:
        """|run - ideal| at equal crank angles, over the largest ideal value, without the start of the run, and without rows at which the
        cylinder opens if the run has the pressure before and the ideal joint that after, or the reverse."""
        run, ideal = self.rows[column], self.ideal[column]
        n = min(len(run), len(ideal))
        found = np.abs(run[:n] - ideal[:n])
        if "cylinder_pressure" in self.rows:
            one, other = self.rows["cylinder_pressure"][:n], self.ideal["cylinder_pressure"][:n]
            found = np.where(np.abs(one - other) < 1e-3 * other, found, 0.0)
        return found[int(START * n):] / np.max(np.abs(ideal))

    def lag(self) -> float:
        """Angle in degrees by which the crank is behind that of the ideal joint at the end of the run."""
        time, angle = self.rows["time"], self.rows["crank_angle"]
        return math.degrees(np.interp(time[-1], self.ideal["time"], self.ideal["crank_angle"]) - angle[-1])

    def speed_gap(self) -> float:
        """Largest difference of the crank speeds at equal times, in percent of the largest speed."""
        ideal = np.interp(self.rows["time"], self.ideal["time"], self.ideal["crank_speed"])
        inside = self.rows["time"] <= self.ideal["time"][-1]
        return 100 * np.max(np.abs(self.rows["crank_speed"] - ideal)[inside]) / np.max(np.abs(ideal))

    def loss(self) -> float:
        return self.rows["energy"][0] - self.rows["energy"][-1]

    def pin_force(self) -> np.ndarray:
        return np.hypot(self.rows["pin_force_x"], self.rows["pin_force_y"])

    def force_ratio(self) -> float:
        """Largest pin force after the start, over that of the ideal joint."""
        ideal = np.hypot(self.ideal["pin_force_x"], self.ideal["pin_force_y"])
        return float(np.max(self.pin_force()[int(START * len(self.rows["time"])):]) / np.max(ideal))

    def contact(self) -> float:
        return 100 * self.number("contact_time_fraction")


@cache
def table(path: Path) -> dict[str, np.ndarray]:
    with path.open(encoding="utf-8") as file:
        names = [name.split("[")[0] for name in file.readline().strip().split(",")]
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return dict(zip(names, values.T))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


@dataclass
class Finding:
    """A statement of the dissertation and the result of the program."""

    place: str                          # section and page of the dissertation
    statement: str
    verdict: str                        # yes, no, or partly
    what: str                           # the measured quantity
    cases: str
    value: Callable[[], float]
    low: float
    high: float
    unit: str = ""
    options: str = "-a reference --set output.sampling=crank_angle"


def findings_of_chapter_6(runs: Runs) -> list[Finding]:
    def sim(number: str, film: str = "") -> Run:
        return runs.of(f"sim_{number}{film}")

    osc = "_oscillating"
    crank, rod, piston = "crank_acceleration", "rod_acceleration", "piston_acceleration"

    def noisy(run: Run, column: str) -> float:
        return 100 * float(np.mean(run.deviation(column) > 0.02))

    return [
        Finding("6.2.1, p. 63", "I: the crank speed follows the ideal joint with a lag, from the dissipation of the film", "yes",
                "lag at the end, Pinkus-Sternlicht", "sim_I", lambda: sim("I").lag(), 0.4, 0.7, "deg"),
        Finding("6.2.1, p. 63", "I: the crank speed lags behind the ideal joint with the oscillating film too", "yes",
                "lag at the end", "sim_I_oscillating",
                lambda: sim("I", osc).lag(), 2.5, 3.7, "deg"),
        Finding("6.2.1, p. 64", "I, Pinkus-Sternlicht: accelerations are very near those of the ideal joint", "yes",
                "largest deviation of the crank acceleration", "sim_I", lambda: 100 * sim("I").deviation(crank).max(), 0, 0.3, "%"),
        Finding("6.2.1, p. 64", "I, oscillating film: regions of strong oscillation", "yes", "deviation of the rod acceleration, rms",
                "sim_I_oscillating", lambda: 100 * rms(sim("I", osc).deviation(rod)), 35, 65, "%"),
        Finding("6.2.1, p. 64", "these oscillations are numerical instabilities", "no: the pin rings on the contact stiffness",
                "relative energy residual of the run", "sim_I_oscillating",
                lambda: sim("I", osc).number("max_energy_residual_relative"), 0, 1e-6),
        Finding("6.2.1, p. 65", "oscillations come from changes between film and contact", "yes", "time in contact", "sim_I_oscillating",
                lambda: sim("I", osc).contact(), 90, 99, "%"),
        Finding("6.2.1, p. 65", "I: the penetration is small", "no at the first impact", "deepest penetration over the clearance",
                "sim_I_oscillating", lambda: sim("I", osc).number("max_penetration") / 20e-6, 0.7, 0.77),
        Finding("6.2.1, p. 66", "I, oscillating film: abrupt changes of force", "yes", "largest pin force", "sim_I_oscillating",
                lambda: sim("I", osc).number("max_pin_force") / 1e3, 18, 20.5, "kN"),
        Finding("6.2.2, p. 68", "a larger clearance dissipates more (Pinkus-Sternlicht)", "yes", "loss in II over loss in I", "sim_I sim_II",
                lambda: sim("II").loss() / sim("I").loss(), 1.9, 2.1),
        Finding("6.2.2, p. 68", "a larger clearance dissipates more (oscillating film)", "yes, but little",
                "loss in II over loss in I",
                "sim_I_oscillating sim_II_oscillating", lambda: sim("II", osc).loss() / sim("I", osc).loss(), 1.0, 1.15),
        Finding("6.2.2, p. 68", "II, Pinkus-Sternlicht: noise in the accelerations", "no: see below",
                "share of rows whose piston acceleration is off by more than 2 %", "sim_II", lambda: noisy(sim("II"), piston), 0, 0.5, "%"),
        Finding("6.2.2, p. 68", "II, Pinkus-Sternlicht: the pin nears the wall without contact", "yes", "smallest film thickness", "sim_II",
                lambda: 1e6 * sim("II").number("min_film_thickness"), 0.7, 0.85, "um"),
        Finding("6.2.2, p. 70", "II, oscillating film: it cannot carry the load", "yes", "time in contact", "sim_II_oscillating",
                lambda: sim("II", osc).contact(), 90, 98, "%"),
        Finding("6.2.3, p. 72", "III: energy is lost with the Pinkus-Sternlicht film", "yes", "loss, Pinkus-Sternlicht", "sim_III",
                lambda: sim("III").loss(), 6.3, 7.0, "J"),
        Finding("6.2.3, p. 72", "III: energy is lost with the oscillating film", "yes", "loss, oscillating film",
                "sim_III_oscillating", lambda: sim("III", osc).loss(), 36, 42, "J"),
        Finding("6.2.3, p. 74", "III, Pinkus-Sternlicht: a film throughout", "yes", "contacts", "sim_III",
                lambda: sim("III").number("contacts"), 0, 0),
        Finding("6.2.3, p. 74", "III, oscillating film: contact for most of the time", "yes", "time in contact", "sim_III_oscillating",
                lambda: sim("III", osc).contact(), 98, 100, "%"),
        Finding("6.2.3, p. 75", "III, oscillating film: the reaction differs much from that of the ideal joint", "only at the start",
                "peak after the start over the ideal peak", "sim_III_oscillating", lambda: sim("III", osc).force_ratio(), 1.0, 1.2),
        Finding("6.2.3, p. 76", "speed increases the relative loss (I to III)", "no: it is the same",
                "relative loss in III over that in I, Pinkus-Sternlicht", "sim_I sim_III",
                lambda: sim("III").loss() / sim("III").rows["energy"][0] / (sim("I").loss() / sim("I").rows["energy"][0]), 0.95, 1.1),
        Finding("6.3, p. 76", "the damping of 0.030 N m s/rad keeps IV near 250 rad/s", "yes, after some 100 revolutions",
                "mean crank speed of the last of 200 revolutions", "sim_IV", lambda: last_speed(runs, "sim_IV"), 244, 253, "rad/s",
                options="-a standard --set integrator.crank_revolutions=200"),
        Finding("6.3, p. 76", "the damping of 0.030 N m s/rad keeps VI near 1000 rad/s", "nearly",
                "mean crank speed of the last of 200 revolutions", "sim_VI",
                lambda: last_speed(runs, "sim_VI"), 960, 990, "rad/s", options="-a standard --set integrator.crank_revolutions=200"),
        Finding("6.3.1, p. 78", "IV: the crank speed is as with the ideal joint (Pinkus-Sternlicht)", "yes", "largest difference", "sim_IV",
                lambda: sim("IV").speed_gap(), 0, 1.0, "%"),
        Finding("6.3.1, p. 78", "IV: the crank speed is as with the ideal joint (oscillating film)", "no after two cycles",
                "largest difference", "sim_IV_oscillating",
                lambda: sim("IV", osc).speed_gap(), 4, 10, "%"),
        Finding("6.3.1, p. 79", "IV, Pinkus-Sternlicht: accelerations alternate between calm and high frequency",
                "no", "share of rows whose rod acceleration is off by more than 2 %", "sim_IV",
                lambda: noisy(sim("IV"), rod), 0, 0.5, "%"),
        Finding("6.3.1, p. 79", "IV, oscillating film: accelerations alternate between calm and high frequency", "yes",
                "share of rows whose rod acceleration is off by more than 2 %", "sim_IV_oscillating",
                lambda: noisy(sim("IV", osc), rod), 50, 90, "%"),
        Finding("6.3.1, p. 80", "disturbances occur where the pin is near contact", "yes", "time in contact", "sim_IV_oscillating",
                lambda: sim("IV", osc).contact(), 93, 99, "%"),
        Finding("6.3.1, p. 81", "IV: the portrait of the piston is altered with both films", "no with Pinkus-Sternlicht",
                "largest deviation of the piston acceleration", "sim_IV", lambda: 100 * sim("IV").deviation(piston).max(), 0, 0.6, "%"),
        Finding("6.3.2, p. 82", "V: pressure and gas force are those of IV", "yes", "peak pressure in V", "sim_V",
                lambda: sim("V").rows["cylinder_pressure"].max() / 1e5, 30.95, 31.1, "bar"),
        Finding("6.3.2, p. 83", "V: the crank speed is hardly affected", "yes", "largest difference", "sim_V",
                lambda: sim("V").speed_gap(), 0, 1.6, "%"),
        Finding("6.3.2, p. 83", "V: accelerations are affected more than in IV", "yes",
                "largest deviation of the crank acceleration in V over that in IV", "sim_IV sim_V",
                lambda: sim("V").deviation(crank).max() / sim("IV").deviation(crank).max(), 3, 30),
        Finding("6.3.2, p. 84", "a larger clearance makes the film thinner", "yes", "smallest film thickness in V over that in IV",
                "sim_IV sim_V", lambda: sim("V").number("min_film_thickness") / sim("IV").number("min_film_thickness"), 0.2, 0.26),
        Finding("6.3.3, p. 87", "VI: the crank speed is near the ideal one (Pinkus-Sternlicht)", "yes", "largest difference", "sim_VI",
                lambda: sim("VI").speed_gap(), 0, 1.0, "%"),
        Finding("6.3.3, p. 88", "VI: the explosion shows in the accelerations", "yes", "peak pressure", "sim_VI",
                lambda: sim("VI").rows["cylinder_pressure"].max() / 1e5, 62.3, 62.6, "bar"),
        Finding("6.3.3, p. 89", "VI, Pinkus-Sternlicht: the film oscillates without contact", "yes", "contacts", "sim_VI",
                lambda: sim("VI").number("contacts"), 0, 0),
        Finding("6.3.3, p. 89", "VI, oscillating film: contact for nearly all of the time", "yes", "time in contact",
                "sim_VI_oscillating",
                lambda: sim("VI", osc).contact(), 98, 100, "%"),
        Finding("6.3.3, p. 90", "VI: Poincare maps of both films are similar", "yes", "correlation of the piston accelerations",
                "sim_VI",
                lambda: correlation(sim("VI"), sim("VI", osc), piston), 0.99, 1),
        Finding("7, p. 93", "the largest step decides the cost", "yes", "evaluations with at most 1e-6 s over those without limit (Adams)",
                "sim_I", lambda: evaluations(runs, "sim_I", "1e-6") / evaluations(runs, "sim_I", "0"), 1.15, 1.35,
                options="--set integrator.method=adams --set integrator.max_step=1e-6"),
        Finding("7, p. 93", "the Pinkus-Sternlicht film is cheap, the oscillating film is expensive",
                "yes with `auto`, no with Adams alone",
                "evaluations, oscillating over Pinkus-Sternlicht", "sim_I sim_I_oscillating",
                lambda: sim("I", osc).number("rhs_evaluations") / sim("I").number("rhs_evaluations"), 1.5, 20),
        Finding("4.2.1, p. 43", "the contact law holds below 1e-5 sqrt(E/rho)", "exceeded in the dissertation's own cases",
                "impacts beyond this speed", "sim_I_oscillating", lambda: sim("I", osc).number("impacts_beyond_validity"), 10, 80),
    ]


def findings_of_appendix_b(runs: Runs) -> list[Finding]:
    options = "-a standard --set integrator.revolutions=62"

    def run(case: str) -> Run:
        return runs.of(f"flores/{case}", LONG)

    def error(case: str, column: str, window: slice) -> float:
        """Rms difference from the ideal joint at equal crank angles, over the rms of the ideal joint, in percent."""
        one, ideal = run(case).rows[column][window], run("ideal").rows[column][window]
        n = min(len(one), len(ideal))
        return 100 * rms(one[:n] - ideal[:n]) / rms(ideal[:n])

    def contact(case: str, window: slice) -> float:
        return 100 * float(np.mean(run(case).rows["phase"][window] == 2))

    def peak(case: str, window: slice) -> float:
        return float(np.max(np.abs(run(case).rows["crank_moment"][window])))

    def scatter(case: str) -> float:
        """Standard deviation of the piston velocity at q = 0 in revolutions 12 to 62 [m/s]."""
        velocity = run(case).rows["piston_velocity"][SETTLED][::3600]
        return float(np.std(velocity))

    return [
        Finding("B.1, p. 105", "0.5 mm, dry: the velocity is perturbed", "yes", "rms deviation of the piston velocity, settled",
                "flores/dry_0500um", lambda: error("dry_0500um", "piston_velocity", SETTLED), 4, 8, "%", options),
        Finding("B.1, p. 106", "0.5 mm, dry: the acceleration is changed much", "yes", "rms deviation, settled", "flores/dry_0500um",
                lambda: error("dry_0500um", "piston_acceleration", SETTLED), 90, 220, "%", options),
        Finding("B.1, p. 106", "less clearance brings the moment nearer to the ideal one", "yes",
                "rms deviation of the moment with 0.01 mm over that with 0.5 mm, settled", "flores/dry_0010um flores/dry_0500um",
                lambda: error("dry_0010um", "crank_moment", SETTLED) / error("dry_0500um", "crank_moment", SETTLED), 0.02, 0.1, "", options),
        Finding("B.1, p. 107", "less clearance means more time in contact", "yes", "contact with 0.5 mm, settled", "flores/dry_0500um",
                lambda: contact("dry_0500um", SETTLED), 65, 90, "%", options),
        Finding("B.1, p. 107", "less clearance means more time in contact", "yes", "contact with 0.01 mm, settled",
                "flores/dry_0010um",
                lambda: contact("dry_0010um", SETTLED), 99.9, 100, "%", options),
        Finding("B.1, p. 108", "less clearance leads to periodic motion", "yes", "scatter of the piston velocity at q = 0 with 0.5 mm, settled",
                "flores/dry_0500um", lambda: scatter("dry_0500um"), 0.6, 1.8, "m/s", options),
        Finding("B.1, p. 108", "less clearance leads to periodic motion", "yes", "scatter with 0.01 mm", "flores/dry_0010um",
                lambda: scatter("dry_0010um"), 0, 1e-5, "m/s",
                options),
        Finding("B.2, p. 110", "more friction reduces the oscillation of the moment", "no in the first two revolutions",
                "peak with friction 0.1 over that with 0.01, revolutions 0 to 2", "flores/friction_010 flores/friction_100",
                lambda: peak("friction_100", AS_SHIPPED) / peak("friction_010", AS_SHIPPED), 1.05, 1.6, "", options),
        Finding("B.2, p. 110", "more friction reduces the oscillation of the moment", "yes once settled",
                "peak with friction 0.1 over that with 0.01, revolutions 12 to 62", "flores/friction_010 flores/friction_100",
                lambda: peak("friction_100", SETTLED) / peak("friction_010", SETTLED), 0.15, 0.4, "", options),
        Finding("B.2, p. 111", "more friction means longer contact", "yes once settled", "contact with friction 0.1, settled",
                "flores/friction_100", lambda: contact("friction_100", SETTLED), 99.9, 100, "%", options),
        Finding("B.2, p. 112", "more friction leads to periodic motion", "yes once settled", "scatter with friction 0.1, settled",
                "flores/friction_100", lambda: scatter("friction_100"), 0, 1e-3, "m/s", options),
        Finding("B.3, p. 114", "oil reduces the deviation from the ideal joint", "yes", "rms deviation of the moment, settled",
                "flores/lubricated_400cP", lambda: error("lubricated_400cP", "crank_moment", SETTLED), 4.5, 6.5, "%", options),
        Finding("B.3, p. 115", "the orbit of the pin is near the wall, without contact", "yes", "smallest film thickness",
                "flores/lubricated_400cP", lambda: 1e6 * run("lubricated_400cP").number("min_film_thickness"), 13, 16, "um", options),
        Finding("B.3, p. 116", "the Poincare map is periodic", "yes", "scatter of the piston velocity at q = 0, settled",
                "flores/lubricated_400cP",
                lambda: scatter("lubricated_400cP"), 0, 1e-5, "m/s", options),
        Finding("B.3, p. 116", "the reaction is near that of a bearing without clearance", "yes", "settled peak over the ideal one",
                "flores/lubricated_400cP", lambda: run("lubricated_400cP").pin_force()[SETTLED].max() / run("ideal").pin_force().max(), 0.98, 1.03, "",
                options),
    ]


def last_speed(runs: Runs, case: str) -> float:
    run = runs.of(case, ("-a", "standard", "-s", "integrator.crank_revolutions=200", "-s", "output.columns=time, crank_angle", "-s",
                         "output.ideal_twin=F", "-s", "output.samples_per_revolution=8"))
    time, angle = run.rows["time"], run.rows["crank_angle"]
    last = angle >= angle[-1] - 8 * math.pi
    return float((angle[last][-1] - angle[last][0]) / (time[last][-1] - time[last][0]))


def evaluations(runs: Runs, case: str, step: str) -> float:
    run = runs.of(case, ("-s", "integrator.method=adams", "-s", f"integrator.max_step={step}", "-s", "output.ideal_twin=F"))
    return run.number("rhs_evaluations")


def correlation(one: Run, other: Run, column: str) -> float:
    n = min(len(one.rows[column]), len(other.rows[column]))
    start = int(START * n)
    return float(np.corrcoef(one.rows[column][start:n], other.rows[column][start:n])[0, 1])


NOTES = """
Revolutions 12 to 62 are called *settled*. The first two revolutions, which the printed figures of appendix B show, are the
transient of a pin that is released from the centre of its bearing; in this transient friction has the opposite effect.

**The noise of the Pinkus-Sternlicht film.** The dissertation reports noise in the accelerations of II, and of IV and V, where the
pin comes near the wall. The program finds none. The noise is the integration error of the dissertation: it integrates the
coordinates (q, A, x) with a relative and absolute error of 1e-6, and 1e-6 m is more than the smallest film thickness of II, 0.77
um. If the same equations are integrated in this way, the noise appears in II to V near the wall, but not in I; with an error of
1e-8 it nearly vanishes. `scripts/bench/show_noise.py` measures it: [noise](noise.md).
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="do not write the table")
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    options = parser.parse_args()
    program = options.program or built_program()
    lines = ["| where | what the dissertation says, in our words | agrees? | what is measured | cases | value |", "|---|---|---|---|---|---|"]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(program.resolve(), Path(folder))
        findings = findings_of_chapter_6(runs) + findings_of_appendix_b(runs)
        commands: dict[str, None] = {}
        for one in findings:
            value = one.value()
            held = one.low <= value <= one.high
            wrong += not held
            shown = f"{value:.3g} {one.unit}".strip()
            if not held:
                print(f"check_findings: {one.place}: {one.what} of {one.cases}: {value:.5g} is not in {one.low:g} to {one.high:g}", file=sys.stderr)
            for case in one.cases.split():
                commands[f"gudgeon {one.options} cases/{case}.nml"] = None
            lines.append(f"| {one.place} | {one.statement} | {one.verdict} | {one.what} | {', '.join(f'`{c}`' for c in one.cases.split())} | {shown} |")
    if not options.check and not wrong:
        text = "\n".join(lines) + "\n" + NOTES + "\n**Commands.** Numbers are computed from the files of:\n\n" + "\n".join(f"    {c}" for c in commands)
        write_table("findings", "Which results of the dissertation hold", "scripts/bench/check_findings.py", text)
    print(f"{len(findings) - wrong} passed, {wrong} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
