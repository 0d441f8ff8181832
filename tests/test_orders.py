#!/usr/bin/env python3
"""Tests of gudgeon-plot orders: orders of known sums of sines, work of known cycles, losses against the energy balance of a run; and of
what it and other scripts that analyse runs refuse.

    .venv/bin/python tests/test_orders.py        (after scripts/setup.sh --python; runs three cases)

Ends with the line "N passed, N failed".
"""

import re
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import patch

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))
sys.path.insert(0, str(TOP / "tests"))

from measured import use_virtual_environment

use_virtual_environment()

import numpy as np
import pandas as pd
from assertions import Assertions
from gudgeon.cycles import bearing_loads, orders, spectrum, whole_cycles, work
from gudgeon.language import Language
from gudgeon.plots.cycles import draw_bearings, draw_indicator, ideal_diagram
from gudgeon.program import release_program
from gudgeon.report.cycles import section
from gudgeon.report.page import page
from gudgeon.results import MissingResult, Run, load_run

check = Assertions().check
TURN = 2 * np.pi
PLOT = (sys.executable, "-m", "gudgeon")


def made(columns: dict, case: dict | None = None) -> Run:
    """A run made from given columns."""
    return Run("made", pd.DataFrame(columns), dict.fromkeys(columns, "-"), pd.DataFrame(), case=case or {})


def known_orders(uneven: bool, backwards: bool) -> None:
    """3 + 2 cos(2 q + 30 deg) + 0.5 sin(5 q) over 10 revolutions, at equal angles, or at equal times of a crank with varying
    speed."""
    time = np.linspace(0, 1, 7201)
    angle = TURN * 10 * time
    if uneven:
        angle = angle + 0.3 * np.sin(angle) / 2
    sense = -1 if backwards else 1
    q = sense * angle
    value = 3 + 2 * np.cos(2 * angle + np.radians(30)) + 0.5 * np.sin(5 * angle)
    cycles = whole_cycles(made({"time": time, "crank_angle": q, "value": value}))
    what = f"{'uneven' if uneven else 'even'} rows{', backwards' if backwards else ''}"
    check(cycles.number == 5, f"{what}: the last half of the cycles is used", str(cycles.number))
    table = orders(cycles, "value").set_index("order")
    for order, amplitude in ((0.0, 3.0), (2.0, 2.0), (5.0, 0.5), (1.0, 0.0), (7.0, 0.0)):
        found = table.loc[order, "amplitude"]
        check(abs(found - amplitude) < 1e-5, f"{what}: amplitude of order {order}", str(found))
    check(abs(table.loc[2.0, "phase_deg"] - 30) < 1e-2, f"{what}: phase", str(table.loc[2.0, "phase_deg"]))
    check(abs(table.loc[5.0, "phase_deg"] + 90) < 1e-2, f"{what}: phase of the sine", str(table.loc[5.0, "phase_deg"]))
    check(table["scatter"].max() < 1e-4, f"{what}: no scatter")
    parts = np.sum((table["amplitude"].to_numpy()[1:] ** 2) / 2) + table.loc[0.0, "amplitude"] ** 2
    check(abs(parts - np.mean(cycles["value"] ** 2)) < 1e-3, f"{what}: Parseval's sum")


def scatter_is_seen() -> None:
    """Cycles with alternating amplitudes 1 and 2: mean 1.5, scatter 0.5."""
    angle = np.linspace(0, TURN * 8, 8 * 360 + 1)
    size = np.where(np.floor(angle / TURN + 1e-9) % 2 == 0, 1.0, 2.0)
    cycles = whole_cycles(made({"time": angle, "crank_angle": angle, "value": size * np.cos(angle)}), settle=0)
    row = orders(cycles, "value").set_index("order").loc[1.0]
    check(abs(row["amplitude"] - 1.5) < 1e-2 and abs(row["scatter"] - 0.5) < 1e-2, "scatter of the amplitude", str(row.to_dict()))
    frequency, density = spectrum(cycles, "value")
    check(abs(frequency[np.argmax(density)] - 1 / TURN) < 0.05, "the spectrum has its peak at the frequency of the crank")


def runs(folder: Path) -> None:
    """Whole runs: the joints dissipate the work of drive and damping, of which friction is a part; loads are those of the trace."""
    program = release_program()

    def run(case: str, *settings: str) -> Run:
        words = [w for s in settings for w in ("--set", s)]
        subprocess.run([program, "-q", "-o", folder, *words, TOP / "cases" / f"{case}.nml"], check=True)
        return load_run(folder / f"{Path(case).name}.csv")

    sampled = ("output.sampling=crank_angle", "output.samples_per_revolution=3600")
    settled = run("flores/friction_100", "run.until=periodic", "integrator.method=auto", *sampled, "integrator.revolutions=0")
    cycles = whole_cycles(settled, settle=settled["crank_angle"][-1] / TURN - 2.5)
    table = work(settled).set_index("quantity")
    check(cycles.number == 2, "two whole cycles", str(cycles.number))
    check(len(cycles.angle) == 3600, "rows at equal crank angles are used as they are")
    drive, joints = table.loc["drive", "work[J]"], table.loc[["contact, piston pin", "friction, piston pin"], "work[J]"].sum()
    check(abs(drive + joints) < 2e-3 * drive, "at constant speed the work of the drive is the loss of the joint", f"{drive}, {joints}")
    friction = table.loc["friction, piston pin", "work[J]"]
    check(-friction < 1.02 * drive and -friction > 0.5 * drive, "most of the loss is friction", f"{friction}")
    loads = bearing_loads(cycles)
    dead_centre = int(np.argmin(np.abs(cycles.place)))
    check(loads["piston on the rod, in the rod's frame"][0, 0, dead_centre] > 0, "in the dead centre the piston pulls the rod outwards")
    check(loads["crank on the rod, in the rod's frame"][0, 0, dead_centre] < 0, "at the dead centre the crank pulls the rod inwards")
    check(loads["crank on the main bearing"][0, 0, dead_centre] > 0, "at the dead centre the crank loads its bearing outwards")
    size = np.hypot(*loads["piston on the rod, in the rod's frame"])
    check(np.allclose(size, np.hypot(cycles["pin_force_x"], cycles["pin_force_y"])), "a rotation of the frame does not change the magnitude")
    fired = run("sim_IV", "run.until=periodic", "output.window=last_period", "integrator.method=auto", *sampled)
    text = page(fired)
    check('id="cycles"' in text and text.count("data:image/png") == 2, "the page of a periodic run shows its cycles")
    check("which is periodic" in text and "crank speed [rpm]" in text, "the page of a periodic run says that the run is periodic")
    table = work(fired).set_index("quantity")
    gas, damping = table.loc["gas", "work[J]"], table.loc["damping", "work[J]"]
    check(gas > 0 and abs(gas + damping) < 0.05 * gas, "a settled engine: the work of the gas is nearly that of the damping",
          f"{gas}, {damping}")
    told = subprocess.run(
        [*PLOT, "orders", folder / "sim_IV.csv", "--settle", "0"], capture_output=True, text=True, check=False
    )
    check(told.returncode == 0, "the script runs", told.stderr)
    check("film thickness [µm], strongest orders: " in told.stdout and " bar\n" in told.stdout and "e+0" not in told.stdout, "it prints readable units", told.stdout)
    for kind in ("orders.csv", "work.csv", "cycles.png", "orders.png", "bearings.png", "indicator.png"):
        check((folder / f"sim_IV.{kind}").stat().st_size > 100, f"it writes {kind}")
    spoken = subprocess.run([*PLOT, "orders", folder / "sim_IV.csv", "--settle", "0", "--language", "pt"], capture_output=True, text=True, check=False)
    check("1 ciclo\n" in spoken.stdout and re.search(r"amortecimento +−\d+,\d", spoken.stdout) and re.search(r"ordens mais fortes: [\d,]+: [\d,]+;", spoken.stdout)
          and not re.search(r"\d\.\d", spoken.stdout), "what it prints in Portuguese", spoken.stdout + spoken.stderr)
    check(pd.read_csv(folder / "sim_IV.work.csv")["work[J]"].dtype == float, "its tables keep decimal points")
    (folder / "sim_IV.indicator.png").unlink()
    told = subprocess.run([*PLOT, "indicator", folder / "sim_IV.csv", "--settle", "0"], capture_output=True, text=True, check=False)
    check(told.returncode == 0 and (folder / "sim_IV.indicator.png").stat().st_size > 100, "gudgeon-plot indicator", told.stderr)
    settled_cycles = whole_cycles(fired, 0)
    shown = [float(part) for part in re.findall(r"\d+\.\d", draw_indicator(settled_cycles).axes[1].get_title())]
    wanted = [340 + 40 * (-np.log(1 - share * (1 - np.exp(-5))) / 5) ** (1 / 3) for share in (0.1, 0.5, 0.9)]   # by Wiebe's function
    check(len(shown) == 3 and np.allclose(shown, wanted, atol=0.3), "the heat beside the indicator diagram of an engine", f"{shown} {wanted}")
    drawing = draw_indicator(settled_cycles)
    loop = drawing.axes[0].lines[-1].get_xydata()
    check(len(loop) > 10 and np.array_equal(loop[0], loop[-1]), "the p-V loop is closed", f"{loop[0]} {loop[-1]}")
    said = [float(part) for part in re.findall(r"\d+\.?\d*", drawing._suptitle.get_text().partition(": ")[2])]
    area = 1e5 * abs(np.trapezoid(loop[:, 1], loop[:, 0])) / np.ptp(loop[:, 0])   # mean effective pressure by the drawn loop
    # the curve has a point for each row of the trace: its area and its peak miss less than a per cent
    check(len(said) == 2 and abs(1e5 * said[0] / area - 1) < 0.01 and abs(said[1] / loop[:, 1].max() - 1) < 0.01, "its title has IMEP and largest pressure", f"{said} {area}")
    # ideal valves of the compressor of data/gas/air_springs.nml: 1403.144 W at 25 turns a second, in closed form
    machine = {"combustion": {"suction_pressure": 1e5, "discharge_pressure": 5e5}, "working_gas": {"heat_capacity_ratio": 1.4}}
    swept = 0.08 * np.pi / 4 * 0.07**2
    volume, pressure = ideal_diagram(replace(fired, case=machine), 0.05 * swept, 1.05 * swept)
    check(abs(np.trapezoid(1e5 * pressure, volume) / -(1403.144 / 25) - 1) < 1e-4, "the diagram of ideal valves", f"{np.trapezoid(1e5 * pressure, volume)}")
    still = SimpleNamespace(place=settled_cycles.place, length=settled_cycles.length, number=1, run=settled_cycles.run)
    with patch("gudgeon.plots.cycles.bearing_loads", lambda _: {"a load that does not turn": np.ones((2, 1, len(settled_cycles.place)))}):
        numbers = [text.xyann for text in draw_bearings(still).axes[0].texts]
        drawn = draw_bearings(still).axes[0]
    check("[N]" in drawn.get_title() and abs(drawn.lines[0].get_ydata().max() - 2**0.5) < 1e-12, "loads of a very small machine are in N", drawn.get_title())
    check(len({tuple(np.round(place, 3)) for place in numbers}) == 4, "the numbers of four dots in one place stand around it", str(numbers))
    drawing = draw_bearings(settled_cycles)
    force = bearing_loads(settled_cycles)["crank on the main bearing"].mean(axis=1)
    numbers = {int(text.get_text()): text.xy for text in drawing.axes[-1].texts}
    check(set(numbers) == {0, 180, 360, 540}, "loads on the bearings: crank angles within the cycle", str(numbers))
    for number, (_, size) in numbers.items():
        row = int(np.argmin(np.abs(settled_cycles.place - np.radians(number))))
        check(abs(size - np.hypot(*force[:, row]) / 1e3) < 1e-9, f"the mark at {number} degrees has the load of the trace")
    axis = drawing.axes[-1]
    check(axis.get_theta_offset() == np.pi / 2 and axis.get_theta_direction() == -1, "the cylinder axis points upwards")
    for case, said in (({"combustion": {}}, "cylinder volume"), ({"cylinder_pressure": {"compression_ratio": 0.0}}, "swept volume"),
                       ({"cylinder_pressure": {"compression_ratio": 9.0}}, "cylinder volume")):
        check(replace(fired, case=case).volume == said, f"the volume of {case} is the {said}")
    told = subprocess.run(
        [*PLOT, "orders", folder / "sim_IV.csv", "--columns", "nonsense"], capture_output=True, text=True, check=False
    )
    check(told.returncode == 1 and "no column nonsense" in told.stderr and told.stderr.count("\n") == 1,
          "an unknown column is refused", told.stderr)


def settled(drift: float, revolutions: int = 8) -> Run:
    """A run from given columns: the crank speed has an amplitude of 2 rad/s at order 3, and drifts by the given amount per
    revolution."""
    angle = np.linspace(0, revolutions * TURN, revolutions * 360 + 1)
    columns = {name: np.zeros_like(angle) for name in ("crank_moment", "energy", "energy_residual")}
    speed = 100 + 2 * np.cos(3 * angle) + drift * angle / TURN
    work_of_cycle = {"cycle_work_drive": ("3.5", "J"), "crank_pin_cycle_work_film": ("-3.4", "J"), "cycle_work_rest": ("0.1", "J")}
    return replace(made(columns | {"time": angle / 100, "crank_angle": angle, "crank_speed": speed}), summary=work_of_cycle)


def sections_of_pages() -> None:
    """The section on settled cycles in the page: its figures, and the reason if there are none."""
    text = section(settled(0.0))
    check("4 cycles of one revolution" in text and text.count("data:image/png") == 2, "a settled run: cycles and pictures", text[:200])
    check("<td>crank speed</td><td>100</td><td>3: 2</td>" in text, "a settled run: mean and strongest order")
    check("<td>drive</td><td>3.5 J</td>" in text and "<td>film, crank pin</td><td>−3.4 J</td>" in text and "<td>100 mJ</td>" in text, "a settled run: work")
    check("None: the motion has not settled. The mean of crank speed drifts by" in section(settled(1.0)), "a run that drifts has no section")
    check("data:image/png" in section(settled(1.0), ["crank_speed"]), "a run that drifts has a section if columns are requested")
    check("None: no whole cycle" in section(settled(0.0, 1)), "a run that is too short has no section")
    whole = settled(0.0, 2)
    cut = replace(whole, trace=whole.trace.iloc[:-1], case={"output": {"window": "last_period"}})
    check("2 cycles of one revolution" in section(cut), "a last period whose last row is before its end")
    portuguese = Language("pt")
    check("Trabalho no último ciclo" in section(settled(0.0), None, portuguese) and portuguese.unknown <= {"made"}, "in Portuguese", str(portuguese.unknown))
    check("a single whole cycle" in section(settled(0.0, 2)), "a run of one cycle has no section")
    try:
        section(settled(0.0), ["nonsense"])
        check(False, "a missing column is refused")
    except MissingResult as problem:
        check("no column nonsense" in str(problem), "a missing column is refused", str(problem))


def refusals() -> None:
    angle = np.concatenate([np.linspace(0, 5, 100), np.linspace(5, 0, 100)])
    for columns, words in (
        ({"time": np.arange(200.0), "crank_angle": angle}, "turns back"),
        ({"time": np.arange(200.0), "crank_angle": np.linspace(0, 5, 200)}, "no whole cycle"),
        ({"time": np.arange(200.0), "crank_angle": np.linspace(0, 200 * TURN / 30, 200)}, "29.8 rows in a revolution are too few, 36 are needed"),
    ):
        try:
            whole_cycles(made(columns))
            check(False, f"refused: {words}")
        except MissingResult as problem:
            check(words in str(problem), f"refused: {words}", str(problem))
    portuguese = Language("pt")
    few = section(made({"time": np.arange(200.0), "crank_angle": np.linspace(0, 200 * TURN / 30, 200)}), None, portuguese)
    check("são necessárias" in few and portuguese.unknown <= {"made"}, "a run with few rows, in Portuguese", few)
    trace = TOP / "data" / "sim_I.csv"
    for status, words, said in ((2, ("orders", trace, "--settle", "nan"), "nan: must be a number >= 0"),
                                (2, ("orders", trace, "--cycles", "0"), "0: must be a whole number >= 1"),
                                (2, ("orders", trace, "--highest", "0"), "0: must be a number > 0"),
                                (2, ("compare", trace, trace, "--agreement", "-1"), "-1: must be a number > 0"),
                                (2, ("figure", "6.7", "--all"), "give the numbers of figures, --all or --list"),
                                (2, ("figure", "7.6"), "no such figure: 7.6"),
                                (2, ("nonsense", trace), "nonsense: must be one of columns, compare, "),
                                (2, ("orders", trace, "-o", "x.png"), "x.png: give a folder"),
                                (2, ("film", trace, "--at", "0.01"), "--at and --set are for a case file"),
                                (1, ("columns", trace, "--columns", "nonsense"), "no column nonsense"),
                                (1, ("laws", TOP / "data" / "sim_I.events.csv", "--no-run"), "gudgeon-plot laws: "),
                                (2, ("check_certificates.py", TOP / "cases" / "studies" / "map_I.nml"), "map_I.nml: not a case file"),
                                (2, ("check_certificates.py", TOP / "cases" / "sim_I.nml", "--rows", "0"), "0: must be a whole number >= 20"),
                                (1, ("compare", trace, trace, "--out", trace / "x"), "gudgeon-plot compare: "),
                                (1, ("orders", trace, "--out", trace / "x"), "gudgeon-plot orders: ")):
        command = [sys.executable, TOP / "scripts" / "bench" / words[0]] if words[0].endswith(".py") else [*PLOT, words[0]]
        outcome = subprocess.run([*command, *words[1:]], capture_output=True, text=True, check=False)
        check(outcome.returncode == status and said in outcome.stderr and "Traceback" not in outcome.stderr,
              f"{' '.join(str(word) for word in words[:1] + words[-2:])} is refused", outcome.stderr)


def main() -> int:
    for uneven in (False, True):
        for backwards in (False, True):
            known_orders(uneven, backwards)
    scatter_is_seen()
    sections_of_pages()
    refusals()
    with tempfile.TemporaryDirectory() as folder:
        runs(Path(folder))
    return check.__self__.report()


if __name__ == "__main__":
    sys.exit(main())
