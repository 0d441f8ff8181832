#!/usr/bin/env python3
"""Tests of the pictures of the Python package: table of figures, comparisons, film pressures, trade-off, pages.

    .venv/bin/python tests/test_plots.py        (after scripts/setup.sh --python; runs the contact and Flores cases)

Ends with the line "N passed, N failed".
"""

import contextlib
import importlib
import io
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))

from measured import use_virtual_environment

use_virtual_environment()

import elastic_pictures
import gudgeon
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import show_noise
import tradeoff
from gudgeon import cli, language, names, study
from gudgeon.commands import study as study_command
from gudgeon.plots import bearing as bearing_pictures
from gudgeon.plots import columns, compare, figures, film_pressure, laws, ringing, short, style
from gudgeon.plots import film as film_pictures
from gudgeon.plots import skirt as skirt_pictures
from gudgeon.plots.figure_map import read_figures
from gudgeon.plots.quantities import QUANTITIES, once_a_cycle
from gudgeon.portuguese import TEXTS
from gudgeon.program import release_program
from gudgeon.report import curves as report_curves
from gudgeon.report import page as report_page
from gudgeon.report import scene as report_scene
from gudgeon.report.case_rows import case_rows
from gudgeon.results import (
    FineResults,
    MissingResult,
    Results,
    Run,
    WindowResults,
    case_files,
    drawable,
    load_run,
    located,
    parse_case,
    read_case,
)
from matplotlib import font_manager
from matplotlib.figure import Figure as Drawing
from matplotlib.transforms import Bbox


def run(columns: dict, case: dict | None = None, events: dict | None = None) -> Run:
    """A run made from given columns."""
    names = ("time", "crank_angle", "event", "normal_speed", "duration", "max_penetration", "max_normal_force")
    return Run(
        "made",
        pd.DataFrame(columns),
        dict.fromkeys(columns, "-"),
        pd.DataFrame(events or {}, columns=names),
        case=case or {},
    )


#: The figures of chapter 6 of the dissertation: simulation, number of its first figure, its quantities in the printed order.
UNFIRED = "crank_speed crank_acceleration rod_acceleration piston_acceleration"
CHAPTER_6 = (
    ("I", 1, f"{UNFIRED} pin_orbit film_thickness portrait pin_force"),
    ("II", 9, f"{UNFIRED} pin_orbit film_thickness portrait pin_force"),
    ("III", 17, f"{UNFIRED} film_thickness pin_orbit portrait pin_force"),
    ("IV", 25, f"indicator {UNFIRED} film_thickness pin_orbit portrait pin_force"),
    ("V", 34, f"indicator {UNFIRED} film_thickness pin_orbit portrait pin_force"),
    ("VI", 43, f"indicator {UNFIRED} film_thickness pin_orbit portrait pin_force"),
)

#: The other printed figures that show results: number, first quantity, cases.
OTHERS = """
    4.1 contact_loop spheres_hertz
    4.2 contact_loop spheres_hertz spheres_lankarani
    4.3 penetration_speed spheres_hertz spheres_lankarani
    4.4 friction sliding_coulomb
    4.5 friction sliding_ambrosio
    A.2 indicator wiebe_340
    B.2 piston_velocity dry_0500um
    B.3 piston_acceleration dry_0500um
    B.4 crank_moment dry_0500um dry_0100um dry_0010um
    B.5 pin_orbit dry_0500um dry_0100um dry_0010um
    B.6 portrait dry_0500um dry_0100um dry_0010um
    B.7 crank_moment friction_010
    B.8 crank_moment friction_050
    B.9 crank_moment friction_100
    B.10 pin_orbit friction_010
    B.11 pin_orbit friction_050
    B.12 pin_orbit friction_100
    B.13 portrait friction_010
    B.14 portrait friction_050
    B.15 portrait friction_100
    B.16 piston_velocity lubricated_400cP
    B.17 piston_acceleration lubricated_400cP
    B.18 crank_moment lubricated_400cP
    B.19 pin_orbit lubricated_400cP
    B.20 portrait lubricated_400cP
    B.21 pin_force lubricated_400cP
"""

#: Names of quantities in titles.
TITLES = {
    "crank_speed": "crank speed",
    "crank_acceleration": "crank angular acceleration",
    "rod_acceleration": "rod angular acceleration",
    "piston_velocity": "piston velocity",
    "piston_acceleration": "piston acceleration",
    "crank_moment": "crank moment",
    "pin_force": "pin force",
    "film_thickness": "minimum film thickness",
    "pin_orbit": "pin orbit",
    "portrait": "Poincaré map",
    "indicator": "p–V diagram",
}


def printed_figures() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Number -> first quantity and cases, as in the dissertation."""
    found = {}
    for number, quantity, *cases in (line.split() for line in OTHERS.strip().splitlines()):
        found[number] = (quantity, tuple(cases))
    for simulation, first, quantities in CHAPTER_6:
        for count, quantity in enumerate(quantities.split(), first):
            found[f"6.{count}"] = (quantity, (f"sim_{simulation}", f"sim_{simulation}_oscillating"))
    return found


class FigureMap(unittest.TestCase):
    def setUp(self) -> None:
        self.figures = read_figures()

    def test_every_figure_shows_what_the_print_has_under_its_number(self) -> None:
        printed = printed_figures()
        self.assertEqual(len(printed), 5 + 51 + 1 + 20)
        self.assertEqual(set(self.figures), set(printed))
        for number, figure in self.figures.items():
            with self.subTest(number):
                quantity, cases = printed[number]
                self.assertEqual((figure.quantities[0], figure.runs), (quantity, cases))
                if number[0] in "6B":
                    self.assertIn(TITLES[quantity], figure.title)
                if number[0] == "6":
                    self.assertIn(f"Simulation {cases[0].removeprefix('sim_')}:", figure.title)

    def test_two_panels_of_the_print(self) -> None:
        for number, second in (
            ("4.3", "penetration_portrait"),
            ("6.25", "gas_force"),
            ("6.34", "gas_force"),
            ("6.43", "gas_force"),
            ("A.2", "cylinder_pressure"),
        ):
            self.assertEqual(self.figures[number].quantities[1], second, number)

    def test_curves_and_maps_have_their_ideal_joint(self) -> None:
        for number, figure in self.figures.items():
            plain = {"pin_orbit", "film_thickness", "indicator"} & set(figure.quantities) or number[0] in "4A"
            ideal = "ideal" if number[0] == "B" else f"{figure.runs[0]}.ideal"
            self.assertEqual(figure.ideal, "" if plain else ideal, number)

    def test_appendix_b_shares_one_settled_window(self) -> None:
        for number, figure in self.figures.items():
            self.assertEqual(figure.window, (10, 12) if number[0] == "B" else None, number)
            self.assertIsNone(figure.at_start.window)
        self.assertEqual(self.figures["B.7"].stem, "figure_B.07")
        self.assertEqual(self.figures["B.7"].at_start.stem, "figure_B.07_start")
        self.assertEqual(self.figures["6.7"].at_start.stem, "figure_6.07")

    def test_quantities_and_cases_exist(self) -> None:
        cases = case_files()
        for figure in self.figures.values():
            self.assertTrue(figure.quantities and figure.runs and figure.title, figure)
            for name in figure.quantities:
                self.assertIn(name, QUANTITIES, figure)
            for name in figure.needs:
                self.assertIn(name.removesuffix(".ideal"), cases, figure)

    def test_no_figure_is_drawn_twice(self) -> None:
        contents = [(figure.quantities, figure.runs) for figure in self.figures.values()]
        self.assertEqual(len(set(contents)), len(contents))

    def test_every_simulation_and_every_quantity_is_drawn(self) -> None:
        runs = {name for figure in self.figures.values() for name in figure.runs}
        for number in ("I", "II", "III", "IV", "V", "VI"):
            self.assertLessEqual({f"sim_{number}", f"sim_{number}_oscillating"}, runs)
        self.assertEqual({name for figure in self.figures.values() for name in figure.quantities}, set(QUANTITIES))

    def test_wrong_tables_are_refused(self) -> None:
        head = "number,quantities,runs,ideal,window,title\n"
        rows_of = (
            "6.1,a,b,,,c\n6.1,a,b,,,d\n",
            "6.01,a,b,,,c\n",
            "six,a,b,,,c\n",
            "6.1,a,b,,12-10,c\n",
            "6.1,a,b,,5,c\n",
        )
        for rows in rows_of:
            with tempfile.TemporaryDirectory() as work, self.assertRaises(ValueError):
                path = Path(work) / "figures.csv"
                path.write_text(head + rows, encoding="utf-8")
                read_figures(path)


class Comparison(unittest.TestCase):
    def test_horizon_is_the_last_agreeing_time(self) -> None:
        time = np.arange(6.0)
        difference = np.array([0, 0.1, -0.1, 0.3, 0, 0])
        self.assertEqual(compare.horizon(time, difference, 0.2), (2.0, False))
        self.assertEqual(compare.horizon(time, difference, 0.3), (5.0, True))
        self.assertEqual(compare.horizon(time, -difference, 0.2), (2.0, False))
        self.assertEqual(compare.horizon(time, difference + 1, 0.2), (0.0, False))

    def test_not_a_number_is_no_agreement(self) -> None:
        self.assertEqual(compare.horizon(np.arange(3.0), np.array([0, np.nan, 0]), 1.0), (0.0, False))

    def test_agreement_is_a_share_of_the_range(self) -> None:
        time = np.linspace(0, 1, 11)
        a = run({"time": time, "crank_speed": 100 + 10 * time})
        b = run({"time": time, "crank_speed": 100 + 10 * time + 2 * time**2})
        (found,) = compare.agree(a, b, ["crank_speed"], 0.05)  # 2 t^2 <= 0.05 * 10 up to t = 0.5
        self.assertAlmostEqual(found.horizon, 0.5)
        self.assertFalse(found.whole)
        self.assertIn("horizon: 0.5 s", compare.report([found], 0.05))

    def test_times_of_a_are_taken_in_the_common_span(self) -> None:
        a = run({"time": np.linspace(0, 1, 11), "crank_speed": np.linspace(0, 1, 11)})
        b = run({"time": np.linspace(0.2, 2, 7), "crank_speed": np.linspace(0.2, 2, 7)})
        (found,) = compare.agree(a, b, ["crank_speed"], 1e-9)
        self.assertTrue(found.whole)
        self.assertAlmostEqual(found.time[0], 0.2)
        self.assertAlmostEqual(found.time[-1], 1.0)

    def test_constant_columns_are_measured_by_their_size(self) -> None:
        self.assertEqual(compare.scale_of(np.full(5, -3.0)), 3.0)
        self.assertEqual(compare.scale_of(np.array([1.0, 4.0])), 3.0)

    def test_what_cannot_be_compared_is_refused(self) -> None:
        a = run({"time": np.array([0.0, 1.0]), "crank_speed": np.zeros(2)})
        b = run({"time": np.array([2.0, 3.0]), "crank_speed": np.zeros(2)})
        with self.assertRaises(MissingResult):
            compare.agree(a, b, ["crank_speed"], 0.01)
        with self.assertRaises(MissingResult):
            compare.agree(a, a, ["rod_speed"], 0.01)

    def test_names_tell_equal_files_apart(self) -> None:
        self.assertEqual(compare.different_names(Path("/x/a.csv"), Path("/y/a.csv")), ("x/a.csv", "y/a.csv"))
        self.assertEqual(compare.different_names(Path("/x/a.csv"), Path("/x/b.csv")), ("a.csv", "b.csv"))


class RigTables(unittest.TestCase):
    """Pressures as rigs write them, against the curve from which the files are made."""

    def setUp(self) -> None:
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        self.work = Path(work.name)

    @staticmethod
    def curve(angle: np.ndarray) -> np.ndarray:
        """Pressure [bar] in a four-stroke cycle."""
        return 1 + 40 * np.exp(-(((np.mod(angle, 720) - 370) / 20) ** 2))

    def made(self, text: str, encoding: str = "utf-8") -> Path:
        path = self.work / "rig.csv"
        path.write_bytes(text.encode(encoding))
        return path

    def rows(self, angles: np.ndarray, separator: str, mark: str, shift: float = 0, scale: float = 1) -> str:
        return "\n".join(f"{a:.2f}{separator}{p:.6f}".replace(".", mark) for a, p in zip(angles - shift, scale * self.curve(angles), strict=True))

    def compare(self, table: pd.DataFrame, points: int) -> None:
        self.assertEqual(list(table.columns), ["crank_angle[deg]", "pressure[bar]"])
        angles, bar = table.to_numpy().T
        self.assertEqual((len(table), angles[0], angles[-1]), (points, 0, 720))
        np.testing.assert_allclose(bar, self.curve(angles), atol=2e-5)   # the digits of the files

    def test_notations(self) -> None:
        angles = np.arange(0, 720, 0.5)
        german = "Prüfstand 7;\r\nKurbelwinkel;Zylinderdruck\r\n°KW;bar\r\n" + self.rows(angles, ";", ",").replace("\n", "\r\n") + "\r\n"
        self.compare(gudgeon.read_pressure(self.made(german, "cp1252")), 1441)
        self.compare(gudgeon.read_pressure(self.made("\ufeff" + german)), 1441)
        self.compare(gudgeon.read_pressure(self.made("CA[deg]\tp_cyl[MPa]\n" + self.rows(angles, "\t", ".", scale=0.1)), save=self.work / "x.csv"), 1441)
        self.compare(pd.read_csv(self.work / "x.csv"), 1441)
        self.compare(gudgeon.read_pressure(self.made(self.rows(angles, " ", ".")), unit="bar"), 1441)
        self.compare(gudgeon.read_pressure(self.made("angle,pressure (kPa)\n" + self.rows(angles, ",", ".", shift=360, scale=100)), shift_deg=360), 1441)
        self.compare(gudgeon.read_pressure(self.made("angle,pressure (kPa)\n" + self.rows(angles + 0.25, ",", ".", scale=100))), 1442)
        for unit in ("bar(a)", "bar (abs)", "bar abs", "barA", "[bar abs]"):
            self.compare(gudgeon.read_pressure(self.made(f"Winkel;Druck\n°KW;{unit}\n" + self.rows(angles, ";", ","))), 1441)
        trailing = "Winkel;Druck\n°KW;bar\n" + self.rows(angles, ";", ",").replace("\n", ";\n") + ";\nMittelwert;2,3\n"
        self.compare(gudgeon.read_pressure(self.made(trailing)), 1441)
        gauge = "Winkel;Druck\n°KW;bar (Ü)\n" + self.rows(angles, ";", ",")
        self.compare(gudgeon.read_pressure(self.made(gauge), unit="bar"), 1441)

    def test_tables_of_american_rigs(self) -> None:
        """Angles before the dead centre, psi, quoted headers and numbers, thousands in groups as Excel exports them."""
        angles, psi = np.arange(-360, 360), 6894.757293168361e-5

        def rows(form: str, sign: int = 1, add: float = 0.0) -> str:
            return "".join(form.format(sign * a, self.curve(a) / psi * 2 + add) for a in angles)   # up to 1189 psi

        for text, options in (
            ('"Test cell 4","Run 0117"\n"RPM","9,000"\n"Crank Angle (deg BTDC)","Cyl 1 Pressure (psia)"\n' + rows('{},"{:,.4f}"\n', -1), {}),
            ('"Crank Angle"\t"Cyl Pressure"\t"MAP"\n"deg ATDC"\t"psig"\t"psia"\n' + rows("{}\t{:,.4f}\t13.50\n"), {"unit": "psi"}),
            ('CAD,PCYL\nATDC,"psi, abs"\n' + rows('{},"{:,.4f}"\n'), {}),
            ("Crank angle (°BTDC),Pressure (lbf/in²)\n" + "".join(reversed(rows("{},{:.4f}\n", -1).splitlines(True))), {}),
            ("Crank Angle, deg;Pressure, psia\n" + rows("{};{:,.4f}\n"), {}),
        ):
            table = gudgeon.read_pressure(self.made(text), **options)
            angle, bar = table.to_numpy().T
            np.testing.assert_allclose(bar, 2 * self.curve(angle), atol=1e-5)
            self.assertEqual(len(table), 721)
        german = "Winkel;Druck\n°KW n. OT;mbar\n" + rows("{};{:,.4f}\n").translate(str.maketrans(",.", ".,"))
        np.testing.assert_allclose(gudgeon.read_pressure(self.made(german))["pressure[bar]"].max(), 82 / psi / 1e3, rtol=1e-6)

    def test_a_comma_of_decimals_or_of_thousands(self) -> None:
        angles = np.arange(720)
        fixed = "a;p\ndeg;bar\n" + self.rows(angles, ";", ",").replace(",00;", ";").replace("000\n", "\n")[:-3]
        self.assertAlmostEqual(gudgeon.read_pressure(self.made(fixed))["pressure[bar]"].max(), 41, places=2)   # 1,000 to 41,000: each has a comma
        whole = "a\tp\ndeg\tpsi\n" + "".join(f"{a}\t{30 * self.curve(a):,.0f}\n" for a in angles)   # 30 to 1,230
        with self.assertRaisesRegex(gudgeon.RigFileError, r"is 1,\d{3} 1\d{3} or 1.\d{3}\? decimal='.' or decimal=',' says it"):
            gudgeon.read_pressure(self.made(whole))
        self.assertAlmostEqual(gudgeon.read_pressure(self.made(whole), decimal=".")["pressure[bar]"].max(), 1230 * 6894.757e-5, places=3)

    def test_cycles(self) -> None:
        angles = np.arange(0, 3 * 720)
        text = "a;p\ndeg;bar\n" + "\n".join(f"{a % 720};{self.curve(a) + a // 720 - 1:.6f}" for a in angles)
        self.compare(gudgeon.read_pressure(self.made(text)), 721)   # of pressures 1 bar below, right, 1 bar above
        first = gudgeon.read_pressure(self.made(text), average=False)
        np.testing.assert_allclose(first["pressure[bar]"], self.curve(first["crank_angle[deg]"]) - 1, atol=2e-5)

    def test_refused(self) -> None:
        angles = np.arange(0, 720)
        two = "angle;p in;p out\ndeg;bar;bar\n" + "\n".join(f"{a};1;2" for a in angles)
        for text, options, said in (
            ("hello\nworld", {}, "no rows of at least two numbers"),
            (two, {}, "which column is the pressure is not clear: give pressure=, one of 'angle', 'p in', 'p out'\nunderstood as\n  angle \\[deg\\]"),
            (two, {"pressure": "oil"}, "no column 'oil'"),
            (self.rows(angles, ";", ","), {}, "give unit="),
            ("a;p\ndeg;bar\n" + self.rows(angles[:400], ";", ","), {}, "less than a cycle of 720"),
            ("a;p\ndeg;bar\n" + self.rows(angles[::-1], ";", ","), {}, "does not increase"),
            ("a;p\ndeg;bar\n" + self.rows(np.delete(angles, range(200, 260)), ";", ","), {}, "no rows between 199 and 260 degrees"),
            ("a;p\ndeg;bar\n" + self.rows(angles, ";", ",").replace("\n7,00;", "\n7,00;1."), {},
             "the pressure is missing or no number in 1 of 720 rows, first at the angle 7"),
            ("a;p\ndeg;barü\n" + self.rows(angles, ";", ","), {}, "'barü' is a gauge pressure: unit='bar'"),
        ):
            with self.assertRaisesRegex(gudgeon.RigFileError, said):
                gudgeon.read_pressure(self.made(text), **options)

    def test_export(self) -> None:
        (self.work / "x.csv").write_text("time[s],crank_angle[rad]\n0.0,1.5\n0.25,-2.5E-03\n")
        (self.work / "x.summary.csv").write_text("quantity,value,unit\nstatus,done,\nversion,0.3.0,\nsimulated_time,2.5E-01,s\n")
        for words, trace, summary in (
            ([], "time[s];crank_angle[rad]\n0,0;1,5\n0,25;-0,0025\n", "quantity;value;unit\nstatus;done;\nversion;0.3.0;\nsimulated_time;2,5E-01;s\n"),
            (["--decimal", "point", "--columns", "crank_angle"], "crank_angle[rad]\n1.5\n-0.0025\n", None),
        ):
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(cli.main(["export", str(self.work / "x.csv"), *words]), 0)
            self.assertEqual((self.work / "x.export.csv").read_text("utf-8-sig"), trace)
            self.assertIn((self.work / "x.export.summary.csv").read_text("utf-8-sig"), [summary] if summary else [summary, (self.work / "x.summary.csv").read_text()])


class ForPapers(unittest.TestCase):
    """A picture with title, words, size and font as asked for, of crank speeds in rpm."""

    def test_options(self) -> None:
        before = dict(plt.rcParams)
        try:
            with tempfile.TemporaryDirectory() as work, contextlib.redirect_stdout(io.StringIO()):
                path = Path(work) / "x.csv"
                path.write_text("time[s],crank_angle[rad],crank_speed[rad/s]\n0,0,104.719755\n1,3,104.719755\n2,6,209.43951\n")
                path.with_name("x.summary.csv").write_text("quantity,value,unit\nstatus,done,\n")
                words = ["--title", "Run up", "--label", "crank speed=Drehzahl", "--size", "8.5x6", "--font", "DejaVu Serif,10", "--rpm", "--format", "svg"]
                self.assertEqual(cli.main(["columns", str(path), *words]), 0)
                both = ["--columns", "crank_speed,crank_angle", "--over", "time", "-o", f"{work}/both.svg"]
                self.assertEqual(cli.main(["--language", "pt", "columns", str(path), *both]), 0)
                portuguese = Path(work, "both.svg").read_text(encoding="utf-8")
                text = path.with_name("x_columns.svg").read_text()
            self.assertIn('width="240.944882pt" height="170.07874pt"', text)   # 8.5 cm and 6 cm, of 72 points an inch
            said = re.findall("<!-- (.*?) -->", text)   # texts of the picture, which are drawn as paths
            self.assertLessEqual({"Run up", "Drehzahl", "[rpm]", "2000", "1000"}, set(said))
            self.assertIn("DejaVuSerif-", text)
            self.assertLessEqual({"rotação", "ângulo da manivela", "tempo [ms]"}, set(re.findall("<!-- (.*?) -->", portuguese)))
        finally:
            names.speeds_in_rpm(None)
            language.use("en")
            plt.rcParams.update(before)

    def test_refusals(self) -> None:
        for words, said in ((["--size", "12"], "12: must be WxH, width and height in cm"), (["--size", "0x5"], "0x5: must be WxH"), (["--font", "No Such Font"], "no such font"), (["--label", "x"], "OLD=NEW")):
            with contextlib.redirect_stderr(io.StringIO()) as message, self.assertRaises(SystemExit):
                cli.main(["columns", "x.csv", *words])
            self.assertIn(said, message.getvalue())


    def test_families_of_fonts(self) -> None:
        before = dict(plt.rcParams)
        try:
            self.assertTrue(style.use_font("serif", 9))
            with self.assertNoLogs("matplotlib.font_manager"):
                self.assertIn("Serif", Path(font_manager.findfont(font_manager.FontProperties(family=plt.rcParams["font.family"]))).name)
        finally:
            plt.rcParams.update(before)

    def test_words_that_are_not_known(self) -> None:
        """A command, and columns: what may be meant, what the trace has, and the other columns only where the run has left them out."""
        with contextlib.redirect_stderr(io.StringIO()) as message:
            self.assertEqual(cli.main(["reprot", "x"]), 2)
        self.assertTrue(message.getvalue().endswith("did you mean report?\n"), message.getvalue())
        few = run({"time": [0.0], "pin_force_x": [1.0]}, {"output": {"columns": "pin_force_x"}})
        for made, wanted, said in ((few, "pin_fosce_x", "did you mean pin_force_x"), (few, "speed", "&output columns = 'standard' may have it"),
                                   (run({"time": [0.0], "pin_force_x": [1.0]}), "a", "no column a; it has time, pin_force_x")):
            with self.assertRaisesRegex(MissingResult, said):
                made[wanted]

    def test_a_reader_that_stops(self) -> None:
        """gudgeon-plot --help | head: no traceback."""
        with subprocess.Popen([sys.executable, "-m", "gudgeon", "--help"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=os.environ | {"PYTHONUNBUFFERED": "1"}) as process:
            process.stdout.close()
            self.assertEqual(process.stderr.read(), b"")


class WarmFilm(unittest.TestCase):
    """A film whose temperature jumps: its settled value, and the least thickness of each cycle in place of the curve."""

    def test_picture(self) -> None:
        angle = np.radians(np.arange(0, 1081, 10.0))
        least = np.array([3.0, 2.0, 2.5])   # of each revolution, at 180 degrees
        cycle = np.minimum((angle / (2 * np.pi) + 1e-9).astype(int), 2)
        values = {"time[s]": angle / 100, "crank_angle[rad]": angle, "film_temperature[K]": np.array([363.15, 375.15, 373.15])[cycle],
                   "film_thickness[m]": 1e-6 * (least[cycle] + 1 + np.cos(angle))}
        with tempfile.TemporaryDirectory() as work, contextlib.redirect_stdout(io.StringIO()):
            path = Path(work) / "x.csv"
            pd.DataFrame(values).to_csv(path, index=False)
            path.with_name("x.summary.csv").write_text("quantity,value,unit\nstatus,done,\ntemperature_jumps,2,1\ncycle_mean_film_temperature,373.15,K\n")
            drawing = columns.draw([load_run(path)], ["film_temperature", "film_thickness"], "time")
        warm, thickness = drawing.axes
        said = {text.get_text() for text in warm.texts}
        self.assertEqual(said, {"settled: 100.0 °C", "jump 1", "jump 2"})
        np.testing.assert_allclose(thickness.lines[0].get_ydata(), least)
        np.testing.assert_allclose(thickness.lines[0].get_xdata(), 10 * np.radians([180, 540, 900]))
        plt.close(drawing)


class OnePage(unittest.TestCase):
    """The short report: case, answers, losses and plots, all on the page."""

    def made(self, more: dict[str, str]) -> Run:
        angle = np.radians(np.arange(0, 721, 2.0))
        columns = {"time": angle / 100, "crank_angle": angle, "film_thickness": 3e-6 + 1e-6 * np.sin(angle), "pin_force_x": 2e3 * np.cos(angle), "pin_force_y": 0 * angle,
                   "cylinder_pressure": 1e5 + angle, "crank_moment": np.sin(angle), "crank_speed": 300 + angle}
        rows = {"status": "done", "min_film_thickness": "2e-6", "cycle_start": "0", "cycle_duration": str(angle[-1] / 100), "cycle_revolutions": "2", "cycle_min_film_thickness": "2e-6",
                "cycle_min_film_thickness_angle": "270", "cycle_max_film_pressure": "5e7", "cycle_wear_depth_100h_bore": "2.5e-6", "cycle_mean_film_power": "40",
                "cycle_imep": "1e6", "cycle_bmep": "9.8e5", "cycle_fmep": "2e4", "cycle_work_gas": "200", "cycle_indicated_power": "5e3", "cycle_joint_fmep": "8e3",
                "cycle_ring_1_fmep": "1.2e4", "cycle_ring_fmep": "1.2e4", "cycle_work_guide": "-2.4"}
        case = {"mechanism": {"crank_length": 0.045, "rod_length": 0.15}, "initial": {"crank_speed": 314.159265358979}, "combustion": {"bore": 0.08}, "case": {"title": "An engine"},
                "joint": {"clearance": 8e-6, "bearing_radius": 0.012, "bearing_length": 0.03}, "lubrication": {"oil": "SAE 30", "temperature": 373.15, "viscosity": 0.0}}
        made = run(columns, case)
        made.summary.update({name: (value, "") for name, value in (rows | more).items()})
        return made

    def test_page(self) -> None:
        drawing = short.draw(self.made({}), "engine")
        np.testing.assert_allclose(drawing.get_size_inches() * 25.4, (210, 297), atol=0.2)
        self.assertEqual(drawing.get_suptitle(), "An engine")
        said = {text.get_text() for axes in drawing.axes for text in axes.texts}
        self.assertLessEqual({"90 mm", "150 mm", "80 mm", "3000 rpm", "24 mm × 30 mm, clearance 8 µm", "SAE 30, 100 °C", "2 µm at 270.0°", "50 MPa", "2.5 µm", "40 W", "60 W"}, said)
        bars = next(axes for axes in drawing.axes if "FMEP 0.2 bar" in axes.get_title(loc="left"))
        np.testing.assert_allclose([bar.get_width() for bar in bars.patches], [40, 60])   # piston pin, ring 1: 8 and 12 kPa of 1 MPa at 5 kW
        titles = [axes.get_title(loc="left") for axes in drawing.axes if axes.lines]
        self.assertEqual(titles, ["film thickness [µm]", "force [kN]", "cylinder pressure [bar]", "crank moment [N m]"])
        self.fits(drawing)

    def test_page_in_portuguese(self) -> None:
        """The longer words cover no value, and an oil has decimal commas."""
        self.addCleanup(language.use, "en")
        said = language.use("pt")
        made = self.made({"cycle_max_drive_torque": "1234.5", "cycle_min_drive_torque": "-1234.5"})
        made.case["lubrication"] = {"oil": "", "temperature": 0.0, "viscosity": 0.0117}
        drawing = short.draw(made, "engine")
        said.localise(drawing)
        self.assertEqual(said.unknown, set())
        self.fits(drawing)
        texts = [text for axes in drawing.axes for text in axes.texts]
        self.assertIn("11,7 mPa s", [text.get_text() for text in texts])
        covered = [(one.get_text(), other.get_text()) for i, one in enumerate(texts) for other in texts[i + 1 :] if one.axes is other.axes
                   and one.get_window_extent().overlaps(other.get_window_extent()) and one.get_text() and other.get_text()]
        self.assertEqual(covered, [])

    def fits(self, drawing: Drawing) -> None:
        """All texts are on the page, values beside their units, and no table covers another one or a plot."""
        broken = [text.get_text() for axes in drawing.axes for text in axes.texts if re.search(r"\d\n(kW|kN|bar|µm|%|cm³)", text.get_text())]
        self.assertEqual(broken, [])
        drawing.draw_without_rendering()
        page = drawing.bbox
        blocks = []
        for axes in drawing.axes:
            boxes = [text.get_window_extent() for text in axes.texts]
            for text, box in zip(axes.texts, boxes):
                self.assertTrue(box.x0 >= 0 and box.y0 >= 0 and box.x1 <= page.x1 and box.y1 <= page.y1, text.get_text())
            if axes.lines:
                self.assertGreater(axes.get_window_extent().height / drawing.dpi, 0.7, "a plot that can be read")
            if boxes or axes.lines:
                blocks.append((axes.get_title(loc="left"), Bbox.union([*boxes, axes.get_tightbbox()])))
        for i, (name, box) in enumerate(blocks):
            for other, under in blocks[i + 1 :]:
                self.assertFalse(Bbox.intersection(box, under) is not None and Bbox.intersection(box, under).height > 2, f"{name} covers {other}")
        plt.close(drawing)

    def test_numbered_bearings(self) -> None:
        """Nine bearings of an engine: a line for each in a table, and both kinds where the losses go."""
        bearings = [f"main_bearing_{number}" for number in range(1, 6)] + [f"crank_pin_{number}" for number in range(1, 5)]
        more = {f"{bearing}_{name}": value for bearing in bearings for name, value in (
            ("min_film_thickness", "2e-6"), ("cycle_min_film_thickness", "2.345e-6"), ("cycle_min_film_thickness_angle", "642.2"), ("cycle_max_film_pressure", "1.086e8"),
            ("cycle_max_force", "23280"), ("cycle_reversed_load", "4136"), ("cycle_degrees_under_reversed_load", "149"), ("cycle_mean_film_power", "98.92"),
            ("cycle_mean_film_side_flow", "2e-6"), ("cycle_joint_fmep", "1e3"))}
        made = self.made(more | {"cycle_thinnest_bearing": "crank_pin_2", "cycle_bearings_power": "890.3"})
        for row in ("min_film_thickness", "cycle_joint_fmep"):   # no bearing but these
            del made.summary[row]
        made.trace["crank_pin_2_film_thickness"] = made.trace["film_thickness"]
        drawing = short.draw(made, "engine")
        said = [text.get_text() for axes in drawing.axes for text in axes.texts]
        self.assertLessEqual({bearing.replace("_", " ") for bearing in bearings} | {"2.345 µm at 642.2°, crank pin 2", "890.3 W"}, set(said))
        self.assertEqual((said.count("108.6 MPa"), said.count("98.92 W")), (9, 9))
        bars = next(axes for axes in drawing.axes if "FMEP" in axes.get_title(loc="left"))
        widths = dict(zip([text.get_text() for text in bars.get_yticklabels()], [bar.get_width() for bar in bars.patches]))
        self.assertEqual((widths["Main bearings"], widths["Crank pins"]), (25, 20))   # 5 and 4 kPa of 1 MPa at 5 kW
        self.assertIn("crank pin 2: film thickness [µm]", [axes.get_title(loc="left") for axes in drawing.axes])
        self.fits(drawing)

    def test_long_tables_have_room(self) -> None:
        """All rows that a run may have: they are there, and two plots make room for them."""
        more = {f"{pre}{name}": value for pre in ("", "small_end_", "crank_pin_", "main_bearing_") for name, value in (
            ("min_film_thickness", "2e-6"), ("cycle_min_film_thickness", "2e-6"), ("cycle_min_film_thickness_angle", "270"), ("cycle_max_film_pressure", "5e7"),
            ("cycle_max_force", "12345"), ("cycle_reversed_load", "2345"), ("cycle_degrees_under_reversed_load", "123"), ("cycle_mean_film_power", "40"),
            ("cycle_mean_film_temperature", "390"), ("cycle_mean_film_side_flow", "1e-6"), ("contacts", "7"), ("cycle_contact_share", "0.1"), ("cycle_impacts", "12"),
            ("cycle_max_impact_speed", "1.25"), ("cycle_wear_depth_100h_bore", "2.5e-6"), ("cycle_joint_fmep", "8e3"))}
        more |= {f"cycle_ring_{number}_fmep": "2e3" for number in range(1, 7)} | {
            "cycle_skirt_fmep": "4e3", "cycle_work_elastic": "-1", "cycle_work_guide": "-4", "cycle_fmep": "6e4", "cycle_max_gas_temperature": "1234", "cycle_wall_heat_flow": "21",
            "cycle_leak_share": "0.01", "cycle_indicated_efficiency": "0.46", "cycle_mass_flow": "0.0075", "cycle_volumetric_efficiency": "0.84",
            "cycle_isentropic_efficiency": "0.92", "cycle_discharge_temperature": "488", "cycle_suction_loss": "51", "cycle_discharge_loss": "31",
            "cycle_max_suction_valve_speed": "2.3", "cycle_max_discharge_valve_speed": "4.1", "cycle_max_cylinder_pressure": "1e7", "cycle_mean_crank_speed": "300",
            "cycle_speed_fluctuation": "0.1", "cycle_max_drive_torque": "14.77", "cycle_slap_speed": "0.48", "cycle_slap_angle": "373", "cycle_slap_corner": "guide_3",
            "cycle_slap_energy": "0.028", "cycle_slap_impacts": "73", "cycle_brake_power": "4862.4", "cycle_indicated_power": "4930.4", "pin_swing": "0.1", "pin_drift_per_revolution": "0.01", "cycle_one_way_fmep": "4e3"}
        drawing = short.draw(self.made(more), "engine")
        said = {text.get_text() for axes in drawing.axes for text in axes.texts}
        self.assertLessEqual({"Drive torque", "Hardest slap", "Piston pin", "Wear of the bore in 100 h"}, said)
        self.assertEqual(len([axes for axes in drawing.axes if axes.lines]), 2)
        self.fits(drawing)

    def test_warnings_and_notes(self) -> None:
        """What the long page says of a run is not left out of the short one; what has no room is counted; a run without any has its page."""
        drawing = short.draw(self.made({"status": "done"}), "engine")
        self.assertNotIn("Note", [text.get_text() for axes in drawing.axes for text in axes.texts])
        self.fits(drawing)
        more = {"cycle_is_settled": "no", "motion": "not_periodic", "crank_revolutions": "1000", "status": "done", "note_1": "&joint clearance = 2 mm: usually 1 to 500 um"}
        drawing = short.draw(self.made(more), "engine")
        said = " ".join(text.get_text() for axes in drawing.axes for text in axes.texts).replace("\n", " ")
        self.assertIn("The motion did not repeat within 1000 revolutions", said)
        self.assertIn("&joint clearance = 2 mm: usually 1 to 500 um", said)
        self.fits(drawing)
        long = "one of many notes on values that are far from those of usual machines, as long as such notes are where a case has been made in a hurry: millimetres?"
        drawing = short.draw(self.made(more | {f"note_{i}": f"{i}: {long}" for i in range(1, 41)}), "engine")
        said = [text.get_text() for axes in drawing.axes for text in axes.texts]
        more = next(int(match[1]) for text in said if (match := re.fullmatch(r"(\d+) more: gudgeon-plot report", text)))
        self.assertEqual(said.count("Note"), 41 - more + 1)
        self.fits(drawing)

    def test_the_gas_of_the_case(self) -> None:
        for group, keys, text, spoken in (
            ("combustion", {"cycle": "compressor", "suction_pressure": 0.62e5, "discharge_pressure": 7.6e5}, "compressor, 0.62 bar to 7.6 bar", "compressor, 0,62 bar a 7,6 bar"),
            ("combustion", {"cycle": "two_stroke", "compression_ratio": 8.0, "heat": 2.9e6}, "two strokes, compression ratio 8, 2.9 MJ a cycle", "dois tempos, taxa de compressão 8, 2,9 MJ por ciclo"),
            ("combustion", {"compression_ratio": 8.5}, "four strokes, compression ratio 8.5", "quatro tempos, taxa de compressão 8,5"),
            ("cylinder_pressure", {"table": "p.csv"}, "measured pressure", "pressão medida"),
        ):
            case = {"mechanism": {"crank_length": 0.045}, group: keys}
            portuguese = language.Language("pt")
            found = dict(short.case_lines(run({"time": [0.0]}, case)))["Gas"]
            self.assertEqual((found, portuguese.say(found), portuguese.unknown), (text, spoken, set()))
        self.assertNotIn("Gas", dict(short.case_lines(run({"time": [0.0]}, {"mechanism": {"crank_length": 0.045}}))))

    def test_units_of_very_small_and_very_large_machines(self) -> None:
        """Axes end between 0.1 and 1e4: a pin force of 1.4 N is not 0.0014 kN, a moment of 1.4e6 N m has no factor above its axis."""
        for size, titles in ((1e-3, ["film thickness [nm]", "force [N]", "cylinder pressure [bar]", "crank moment [mN m]"]),
                             (1e4, ["film thickness [mm]", "force [MN]", "cylinder pressure [bar]", "crank moment [kN m]"])):
            made = self.made({})
            for name in ("film_thickness", "pin_force_x", "pin_force_y", "crank_moment"):
                made.trace[name] *= size
            drawing = short.draw(made, "engine")
            axes = {one.get_title(loc="left"): one for one in drawing.axes if one.lines}
            self.assertEqual(list(axes), titles)
            self.assertAlmostEqual(np.nanmax(axes[titles[1]].lines[0].get_ydata()), 2 if size < 1 else 20)   # of 2 N and 20 MN
            plt.close(drawing)

    def test_a_long_title_a_peak_at_0_and_legends(self) -> None:
        """Nothing is nearer than 8 mm to the edge, where printers cut; legends are above their plots, the peak of the gas is whole, and the
        cycle has a gap where its end meets its beginning."""
        angle = np.radians(np.arange(100, 821, 1.0))
        columns = {"time": angle / 100, "crank_angle": angle, "film_thickness": 3e-6 + 1e-8 * angle, "crank_pin_film_thickness": 2e-6 + 1e-8 * angle, "pin_force_x": 2e3 * np.cos(angle),
                   "pin_force_y": 0 * angle, "guide_force": 2e2 * np.sin(angle), "cylinder_pressure": 1e5 + 5e6 * np.exp(-((np.degrees(angle) - 725) / 20) ** 2), "crank_moment": 0 * angle}
        made = run(columns, {"mechanism": {}, "case": {"title": "One of the longest titles that anybody has ever given to a slider-crank mechanism with clearance"}})
        made.summary.update({name: (value, "") for name, value in {"cycle_start": str(angle[0] / 100), "cycle_duration": str(4 * np.pi / 100), "cycle_revolutions": "2"}.items()})
        drawing = short.draw(made, "engine")
        drawing.draw_without_rendering()
        mm = drawing.dpi / 25.4
        box = drawing.get_tightbbox()
        self.assertGreaterEqual(297 - 25.4 * box.y1, 8)
        self.assertGreaterEqual(min(25.4 * box.x0, 25.4 * box.y0, 210 - 25.4 * box.x1), 8)
        drawn = {axes.get_title(loc="left"): axes for axes in drawing.axes if axes.lines}
        self.assertEqual(list(drawn), ["film thickness [µm]", "force [kN]", "cylinder pressure [bar]"])   # a moment that is always 0 is not drawn
        for title in list(drawn)[:2]:
            axes = drawn[title]
            legend, heading = axes.get_legend().get_window_extent(), axes._left_title.get_window_extent()
            self.assertGreaterEqual(legend.y0, axes.get_window_extent().y1 - 0.2 * mm)
            self.assertGreaterEqual(heading.y0, legend.y1 - 0.2 * mm)
            self.assertLessEqual(legend.x1, axes.get_window_extent().x1 + 2 * mm)
        line = drawn["cylinder pressure [bar]"].lines[0]
        self.assertAlmostEqual(line.get_xdata()[np.nanargmax(line.get_ydata())], 5, places=6)
        self.assertEqual(np.count_nonzero(np.isnan(line.get_xdata())), 1)
        np.testing.assert_allclose((np.nanmin(line.get_xdata()), np.nanmax(line.get_xdata())), (-360, 359), atol=1e-6)
        plt.close(drawing)


class WithoutLibrary(unittest.TestCase):
    """Results are read where the library of the program is not built, and what needs it says how to build it."""

    def test_results(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([release_program(), "-q", "-o", folder, "-s", "integrator.revolutions=2", TOP / "cases" / "sim_I.nml"], check=True)
            code = ("import gudgeon; run = gudgeon.load('sim_I'); print(len(run['time']), run.summary['status'], run.case, "
                    "len(run.report()._repr_html_()) > 1000)\ntry: gudgeon.template('dry')\nexcept ImportError as error: print(error)")
            environment = os.environ | {"GUDGEON_LIBRARY": f"{folder}/none.so", "PYTHONPATH": str(TOP / "scripts" / "python" / "src")}
            done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout.split("\n")[0], "1441 done None True", done.stderr)
        self.assertIn("none.so", done.stdout)
        self.assertIn("pip install ./scripts/python", done.stdout)


class Tables(unittest.TestCase):
    """Answers of runs side by side. Units and per cents by hand."""

    def setUp(self) -> None:
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        self.work = Path(work.name)
        self.base, self.hot, self.cold = (self.made(*values) for values in (
            ("a/base", "4.22E-06", "3.61E+03", "7.1E+02", "3.7315E+02", "0", 7),
            ("a/hot", "3.165E-06", "3.61E+03", "1.0E+01", "3.9315E+02", "2.5E-01", 14),
            ("b/base", "8.44E-06", "-7.22E+03", "3.5E+02", "3.7315E+02", "0", 7)))

    def made(self, name: str, film: str, force: str, angle: str, heat: str, share: str, contacts: int) -> Path:
        path = self.work / f"{name}.csv"
        path.parent.mkdir(exist_ok=True)
        path.write_text("time[s]\n0\n1\n")
        path.with_suffix(".summary.csv").write_text(
            "quantity,value,unit\nstatus,done,\ncycle_start,0,s\ncycle_revolutions,2,1\n"
            f"cycle_min_film_thickness,{film},m\ncycle_min_film_thickness_angle,{angle},deg\ncycle_max_force,{force},N\n"
            f"cycle_mean_film_temperature,{heat},K\ncycle_contact_share,{share},1\ncontacts,{contacts},1\n"
            "crank_pin_cycle_max_film_pressure,8.5035E+07,Pa\npin_swing,1.570796327E+00,rad\ncycle_mean_crank_speed,3.769911184E+02,rad/s\n"
            "cycle_mean_film_side_flow,1E-06,m3/s\ncycle_wear_depth_rate_bore,2.25E-09,m/h\ncycle_mean_film_temperature_difference,2.5E-02,K\n"
            + ("cycle_brake_power,4.9E+03,W\n" if name == "a/hot" else ""))
        return path

    def rows(self, *arguments: object, **options: object) -> dict[str, list[str]]:
        cells = gudgeon.table(*arguments, **options).cells
        return {row[0]: row[1:] for row in cells.values.tolist()}

    def test_one_run_in_readable_units(self) -> None:
        found = self.rows(self.base)
        wanted = {
            "cycle_min_film_thickness": "4.22 um", "cycle_min_film_thickness_angle": "710 deg", "cycle_max_force": "3.61 kN",
            "cycle_mean_film_temperature": "100 degC", "crank_pin_cycle_max_film_pressure": "85.0 MPa", "pin_swing": "90.0 deg",
            "cycle_mean_crank_speed": "3600 rpm", "cycle_mean_film_side_flow": "60.0 cm3/min", "cycle_wear_depth_rate_bore": "2.25 nm/h"}
        self.assertEqual(found, {name: [text] for name, text in wanted.items()})  # neither what is done nor what is 0

    def test_runs_side_by_side(self) -> None:
        found = self.rows([self.base, self.hot])
        self.assertEqual(found["cycle_min_film_thickness"], ["4.22 um", "3.17 um (-25.0 %)"])
        self.assertEqual(found["cycle_min_film_thickness_angle"], ["710 deg", "10.0 deg (+20.0 deg)"])  # over the end of the cycle
        self.assertEqual(found["cycle_mean_film_temperature"], ["100 degC", "120 degC (+20.0 K)"])
        self.assertEqual(found["cycle_contact_share"], ["0", "0.250"])  # of nothing there is no share
        self.assertEqual(found["cycle_brake_power"], ["-", "4.90 kW"])
        self.assertEqual(found["cycle_max_force"], ["3.61 kN", "3.61 kN (0.0 %)"])
        turned = self.rows([self.base, self.cold], "cycle_max_force")
        self.assertEqual(turned, {"cycle_max_force": ["3.61 kN", "-7.22 kN (-300 %)"]})
        data = gudgeon.table([self.base, self.hot], "contacts").data
        self.assertEqual(data.iloc[0].tolist(), ["contacts", "", 7, 14, 100.0, "%"])

    def test_rows_are_chosen(self) -> None:
        found = self.rows([self.base, self.cold], ["*_force", "cycle_mean_film*"], digits=4)
        self.assertEqual(list(found), ["cycle_max_force", "cycle_mean_film_temperature", "cycle_mean_film_side_flow",
                                       "cycle_mean_film_temperature_difference"])
        self.assertEqual(found["cycle_mean_film_temperature_difference"][0], "0.02500 K")
        with self.assertRaisesRegex(KeyError, "no row cycle_max_forc; did you mean cycle_max_force"):
            gudgeon.table(self.base, "cycle_max_forc")

    def test_equal_names_are_told_apart(self) -> None:
        self.assertEqual(list(gudgeon.table([self.base, self.cold]).cells), ["row", "a/base", "b/base"])
        self.assertEqual(list(gudgeon.table([self.base, self.hot]).cells), ["row", "base", "hot"])
        self.assertEqual(list(gudgeon.table([self.base, self.base, self.base]).cells), ["row", "base", "base 2", "base 3"])

    def test_files_and_what_is_printed(self) -> None:
        found = gudgeon.table([self.base, self.hot], ["cycle_max_force", "status"])
        self.assertEqual(str(found), "| row             |    base |             hot |\n"
                                     "| --------------- | ------: | --------------: |\n"
                                     "| cycle_max_force | 3.61 kN | 3.61 kN (0.0 %) |\n"
                                     "| status          |    done |            done |")
        self.assertEqual(found.save(self.work / "x.csv").read_text(), "row,unit,base,hot,hot: change,unit of change\n"
                                                                      "cycle_max_force,kN,3.61,3.61,0,%\nstatus,,done,done,,\n")
        page = found.save(self.work / "x.html").read_text()
        self.assertIn('<td style="text-align: right">3.61 kN (0.0 %)</td>', page)
        self.assertNotIn("http", page)
        self.assertIn("| status ", found.save(self.work / "x.md").read_text())
        with self.assertRaisesRegex(ValueError, "x.txt: must end in .md, .csv, .html"):
            found.save(self.work / "x.txt")
        for words, status, said in (
            (["a/base.csv", "hot", "--results", "a", "--rows", "pin_swing"], 0, "| pin_swing | 90.0 deg | 90.0 deg (0.0 %) |"),
            (["base", "--results", "a", "--format", "csv", "--rows", "contacts"], 0, "row,unit,base\ncontacts,,7\n"),
            (["base", "--results", "a", "--rows", "nothing"], 1, "gudgeon-plot table: no row nothing"),
            (["base", "--results", "a", "-o", "x.txt"], 1, "x.txt: must end in"),
            (["base", "x.runs.csv"], 2, "stand alone"),
            (["base", "hot", "--results", "a", "--rows", "pin_swing", "--language", "pt"], 0, "| linha     |     base |              hot |\n"),
            (["base", "hot", "--results", "a", "--rows", "pin_swing", "--language", "pt"], 0, "| pin_swing | 90,0 deg | 90,0 deg (0,0 %) |"),
            (["base", "--results", "a", "--language", "pt", "--format", "csv"], 2, "CSV is read by programs"),
            (["base", "--results", "a", "--language", "pt", "-o", "x.csv"], 2, "CSV is read by programs"),
        ):
            done = subprocess.run([sys.executable, "-m", "gudgeon", "table", *words], cwd=self.work, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(said, done.stdout if status == 0 else done.stderr)

    def test_rows_of_a_study(self) -> None:
        path = self.work / "x.runs.csv"
        path.write_text("run,contact.law,joint.clearance,status,impacts[-],max_pin_force[N]\n"
                        "1,hertz,1e-5,done,2,4.5E+04\n2,flores,2e-5,too deep,,\n")
        found = gudgeon.table(path, ["max_pin_force", "impacts"])
        self.assertEqual(list(found.cells), ["run", "contact.law", "joint.clearance [um]", "status", "max_pin_force [kN]", "impacts"])
        self.assertEqual(found.cells.values.tolist(), [["1", "hertz", "10.0", "done", "45.0", "2.00"], ["2", "flores", "20.0", "too deep", "-", "-"]])
        self.assertEqual(list(gudgeon.table(path).cells)[-1], "max_pin_force [kN]")

    def test_a_study_shows_what_it_asks_for(self) -> None:
        path = self.work / "y.runs.csv"
        path.write_text("run,joint.clearance,integrator.revolutions,status,min_film_thickness[m],max_pin_force[N],cycle_fmep[Pa],guide_force_max_abs[N]\n"
                        "1,1e-5,8,done,,45,2e4,3\n2,2e-5,8,done,,46,3e4,4\n")
        self.assertEqual(list(gudgeon.table(path).cells), ["run", "joint.clearance [um]", "integrator.revolutions", "max_pin_force [N]"])
        (self.work / "y.study.nml").write_text("&study\n  statistics = 'cycle_fmep, max abs guide_force'\n/\n")
        self.assertEqual(list(gudgeon.table(path).cells)[3:], ["cycle_fmep [kPa]", "guide_force_max_abs [N]"])
        (self.work / "y.strobe.csv").write_text("run,cycle,eccentricity_y[m]\n1,1,1e-6\n2,1,2e-6\n")
        found = study_command.any_study(path, None)
        self.assertEqual(list(found), ["y", "y.strobe"])   # curves over the one key that differs, and its strobes
        self.assertEqual(len(found["y"].axes), 2)
        self.assertTrue(found["y"].axes[-1].get_xlabel().startswith("radial clearance"))
        np.testing.assert_allclose(found["y"].axes[0].lines[0].get_ydata(), [20, 30])   # kPa

    def test_answers_of_skirts_and_compressors(self) -> None:
        path = self.work / "z.csv"
        path.write_text("time[s]\n0\n")
        path.with_suffix(".summary.csv").write_text(
            "quantity,value,unit\nstatus,done,\ncycle_start,0,s\ncycle_min_skirt_film_thickness,1.61E-05,m\ncycle_max_slap_speed,2.78E-02,m/s\n"
            "cycle_min_ring_1_film_thickness,5.42E-07,m\ncycle_mass_flow,2.161E-03,kg/s\ncycle_volumetric_efficiency,9.16E-01,1\n"
            "cycle_discharge_temperature,3.639130349E+02,K\ncycle_suction_loss,4.45,W\ncycle_max_drive_torque,180.04,N.m\ncycle_min_drive_torque,-440,N.m\nrecent_mass_flow,2E-03,kg/s\n")
        self.assertEqual(list(self.rows(path).values()), [["16.1 um"], ["27.8 mm/s"], ["0.542 um"], ["2.16 g/s"], ["0.916"], ["90.8 degC"], ["4.45 W"], ["180 N m"], ["-440 N m"], ["2.00 g/s"]])


class Poincare(unittest.TestCase):
    def test_once_a_cycle(self) -> None:
        angle = np.linspace(0, 13, 2601)
        columns = {"time": angle, "crank_angle": angle, "piston_velocity": angle, "piston_acceleration": 2 * angle}
        velocity, acceleration = once_a_cycle(run(columns), 0.0)
        np.testing.assert_allclose(velocity, [2 * np.pi, 4 * np.pi])
        np.testing.assert_allclose(acceleration, [4 * np.pi, 8 * np.pi])
        velocity, _ = once_a_cycle(run(columns | {"gas_force": 0 * angle}), 0.0)  # four strokes: two revolutions
        np.testing.assert_allclose(velocity, [4 * np.pi])
        velocity, _ = once_a_cycle(run(columns), 1.0)
        np.testing.assert_allclose(velocity, [1.0, 1 + 2 * np.pi])


class Certified(unittest.TestCase):
    """The part of a run beyond its certified time is shaded."""

    def shaded(self, until: str | None, held: bool) -> list[tuple[float, float]]:
        angle = np.linspace(0, 8 * np.pi, 2001)
        columns = {"time": angle / 100, "crank_angle": angle, "crank_speed": np.cos(angle)}
        made = replace(
            run(columns, {"drive": {"kind": "constant_speed" if held else "free"}}),
            summary={"certified_until": (until, "s")} if until else {},
        )
        drawing, axis = plt.subplots()
        QUANTITIES["crank_speed"].draw(axis, made, None, "blue")
        found = [patch.get_extents().transformed(axis.transData.inverted()) for patch in axis.patches if patch.get_gid() == "uncertified"]
        plt.close(drawing)
        return [(box.x0, box.x1) for box in found]

    def test_the_page_says_until_when(self) -> None:
        """In a unit that suits the time, without an exponent."""
        for until, text in (("12.345", "12.35 s"), ("1.13", "1.13 s"), ("0.0421", "42.1 ms")):
            made = replace(run({"time": [0.0, 20.0], "crank_angle": [0.0, 20.0]}), summary={"certified_until": (until, "s"), "status": ("done", "")})
            (said,) = report_page.warnings(made, language.Language())
            self.assertTrue(said.startswith(f"The run is certified up to {text}: beyond"), said)
            (said,) = report_page.warnings(made, language.Language("pt"))
            self.assertIn(f"certificada até {text.replace('.', ',')}: além", said)

    def test_a_status_is_a_message(self) -> None:
        """It stays as the program says it, also in Portuguese, and is not reported as untranslated."""
        portuguese, status = language.Language("pt"), "limit of evaluations reached at t = 0.1078 s, phase film"
        made = replace(run({"time": [0.0, 20.0], "crank_angle": [0.0, 20.0]}), summary={"status": (status, "")})
        self.assertEqual((report_page.warnings(made, portuguese), portuguese.unknown), ([f"A simulação não terminou como pedido: {status}."], set()))

    def test_from_the_certified_time_to_the_end(self) -> None:
        ((begin, end),) = self.shaded("0.1", held=False)
        self.assertAlmostEqual(begin, 100, delta=0.2)
        self.assertAlmostEqual(end, 80 * np.pi, delta=1e-9)
        ((begin, end),) = self.shaded("0.1", held=True)
        self.assertAlmostEqual(begin, np.degrees(10), delta=1)
        self.assertAlmostEqual(end, 4 * 360, delta=1e-9)

    def test_nothing_where_all_is_certified_or_nobody_asked(self) -> None:
        self.assertEqual(self.shaded(f"{8 * np.pi / 100:.9e}", held=False), [])
        self.assertEqual(self.shaded(None, held=False), [])


class FilmPressure(unittest.TestCase):
    """Forces from the pressures against quadratures of an independent program."""

    ANGLES = np.linspace(-np.pi, np.pi, 3600, endpoint=False)
    CLEARANCE, BEARING, WIDTH, VISCOSITY = 1e-4, 1e-2, 2e-2, 0.05

    def case(self, lubrication: dict, rod: float, crank: float) -> dict:
        return {
            "mechanism": {"crank_length": crank, "rod_length": rod},
            "joint": {"clearance": self.CLEARANCE, "bearing_radius": self.BEARING, "bearing_length": self.WIDTH},
            "lubrication": {"viscosity": self.VISCOSITY, **lubrication},
        }

    def made(self, eps: float, case: dict, **columns: float) -> Run:
        values = dict.fromkeys(
            ("time", "crank_angle", "rod_angle", "crank_speed", "rod_speed", "piston_velocity", "eccentricity_y"), 0.0
        )
        values |= {"eccentricity_x": eps * self.CLEARANCE, "eccentricity_ratio": eps, "film_thickness": 1.0, "phase": 1}
        return run({name: [value] for name, value in (values | columns).items()}, case)

    def resultant(self, made: Run) -> np.ndarray:
        return np.array(film_pressure.resultant(made, self.ANGLES, film_pressure.pressure(made, self.ANGLES)))[:, 0]

    def test_pinkus_sternlicht(self) -> None:
        radius = self.BEARING - self.CLEARANCE
        unit = self.VISCOSITY * self.WIDTH * radius**3 / self.CLEARANCE**2
        rod = 1e-6
        for eps, wedge, rate, radial, tangential in (
            (0.5, 1, -0.001, -1.7488, 4.8261),
            (0.5, 1, 0.3, -14.7324, 6.6629),
            (0.5, 1, -0.3, 2.6801, 3.0107),
            (0.9, 1, 0.3, -135.4481, 23.1470),
            (0.9, 1, -0.3, 1.1114, 4.5537),
            (0.99, 1, -0.3, 0.6850, 4.9871),
        ):
            pin_speed = wedge / (1 - 2 * rod / (eps * self.CLEARANCE))  # the centre of the pin moves with the end of the rod
            made = self.made(
                eps,
                self.case({"law": "pinkus_sternlicht"}, rod, 1e-9),
                rod_speed=-pin_speed,
                piston_velocity=-rate * self.CLEARANCE,
            )
            np.testing.assert_allclose(self.resultant(made) / unit, [radial, tangential], rtol=2e-3, atol=2e-3)

    def test_finite_film_by_its_file(self) -> None:
        """The page shows the pressures in the program's file, rotated to the eccentricity, or none."""
        motion = {"rod_speed": 0.0, "eccentricity_x": 0.5 * self.CLEARANCE, "eccentricity_ratio": 0.5, "film_thickness": 1.0, "phase": 1}
        columns = {name: np.full(5, float(value)) for name, value in motion.items()} | {"time": np.linspace(0.0, 4.0, 5)}
        made = Run("made", pd.DataFrame(columns), {}, pd.DataFrame(), {}, {"lubrication": {"law": "finite_bearing"}})
        self.assertIsNone(film_pressure.pressure(made, self.ANGLES))
        bore = np.linspace(-2.0, 2 * np.pi - 2.0, 400, endpoint=False)
        fields = [pd.DataFrame({"time": time, "place": 0.0, "angle": bore, "film_thickness": 1 - np.cos(bore - 1.5),
                                "pressure": top * np.maximum(np.cos(bore - 1.5 - 0.3), 0)}) for time, top in ((1.0, 10.0), (3.0, 30.0))]
        found = film_pressure.from_fields(made, fields, self.ANGLES)
        wanted = np.outer([0, 10, 20, 30, 0], np.maximum(np.cos(self.ANGLES - 0.3), 0))
        self.assertLess(np.abs(found - wanted).max(), 0.5)

    def test_film_with_memory(self) -> None:
        """The rows of NAME.film_history.csv are drawn over the crank angle in its order, in both languages."""
        names = ("crank_angle", "min_film_thickness", "quick_film_thickness", "max_film_pressure", "quick_film_pressure", "film_fill",
                 "supply_flow", "side_flow")
        table = pd.DataFrame({name: np.linspace(1.0, 2.0, 5) for name in names} | {"crank_angle": 4 * np.pi + np.radians([600, 719, 1, 90, 180])})
        made = Run("made", pd.DataFrame(), {}, pd.DataFrame(), {}, {"supply": {"kind": "grooves"}})
        drawing = film_pictures.with_memory(made, table, "made")
        lines = drawing.axes[0].get_lines()
        np.testing.assert_allclose(lines[0].get_xdata(), [1, 90, 180, 600, 719], atol=1e-9)
        np.testing.assert_allclose(lines[0].get_ydata(), [1.5e6, 1.75e6, 2e6, 1e6, 1.25e6])
        self.assertEqual([len(axis.get_lines()) for axis in drawing.axes], [2, 2, 1, 2])

    def test_skirt_and_rings(self) -> None:
        """Half of each face is mirrored, one scale for all times; friction over load of a ring by its tension and the gas behind it."""
        turn = np.radians(np.arange(0.0, 721.0, 90.0))
        columns = {"time": turn, "crank_angle": turn, "piston_velocity": np.full(9, -2.0), "cylinder_pressure": np.full(9, 3e5), "ring_1_friction_force": np.full(9, 5.0),
                   "ring_1_film_thickness": np.ones(9), "skirt_friction_force": np.full(9, 7.0), "skirt_force": np.ones(9)} | {f"guide_{k}_gap": np.full(9, k * 1e-6) for k in range(1, 5)}
        case = {"combustion": {"bore": 0.1, "crankcase_pressure": 1e5, "cycle": "four_stroke"}, "rings.lubrication": {"viscosity": 0.01},
                "ring_1": {"tension": 5.0, "height": 1e-3, "gas_behind": 0.5}}
        made = Run("made", pd.DataFrame(columns), {}, pd.DataFrame(), {}, case)
        rows = [(time, time, side, height, angle, 1e-5, 1e6 * (time + side + height + angle)) for time in (3.0, 4.0) for side in (1, -1) for height in (0.0, 0.01) for angle in (10.0, 30.0)]
        table = pd.DataFrame(rows, columns=["time", "crank_angle", "side", "height", "angle", "gap", "pressure"])
        drawing = skirt_pictures.draw(made, table)
        faces = [axis for axis in drawing.axes if axis.collections and axis.get_title(loc="left")]
        self.assertEqual([axis.get_title(loc="left") for axis in faces], ["−y 32 MPa", "+y 34 MPa", "−y 33 MPa", "+y 35 MPa"])
        highest = [path.vertices for path in faces[0].collections[0].get_paths() if len(path.vertices)][-1]   # 12 MPa at 10 deg, 32 MPa at 30 deg
        self.assertTrue((np.abs(highest[:, 0]) > 27).all() and highest[:, 0].min() == -30 and highest[:, 0].max() == 30)
        self.assertEqual({(axis.collections[0].levels[0], axis.collections[0].levels[-1]) for axis in faces}, {(0, 35.01)})
        gaps, friction, stribeck = (axis for axis in drawing.axes if axis.get_lines())
        self.assertEqual([line.get_ydata()[0] for line in gaps.get_lines()], [1, 2, 3, 4])
        self.assertEqual([line.get_ydata()[0] for line in friction.get_lines()], [7, 5])
        load = 2 * 5 / 0.1 + 1e-3 * 0.5 * 2e5
        np.testing.assert_allclose(stribeck.get_lines()[0].get_ydata(), 5 / (np.pi * 0.1 * load))
        np.testing.assert_allclose(stribeck.get_lines()[0].get_xdata(), 0.01 * 2 / load)

    def test_gap_of_a_bearing_with_a_shape(self) -> None:
        """The gap of a centred pin in the middle and at both ends, from a table, a barrel and a tilt."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text, place in (("shape", "angle[deg],deviation[um]\n0,1\n180,3\n", ""),
                                      ("worn", "joint,angle[deg],bore_depth[m]\nsmall_end,0,1\ncrank_pin,0,1e-6\ncrank_pin,180,3e-6\n", "crank_pin.")):
                table = Path(folder) / name
                table.write_text(text)
                shape = {"table": str(table), "factor": 2.0, "direction_deg": 90.0, "barrel": 1e-6, "tilt": [1e-4, 0.0]}
                made = Run("made", pd.DataFrame(), {}, pd.DataFrame(), {}, {"shape": shape, "joint": {"kind": "ideal"}} | {
                    f"{place}joint": {"kind": "quasi_static", "clearance": 2e-5, "bearing_length": 0.02}})
                angle, middle, *ends = film_pictures.gap_of(made)
                np.testing.assert_allclose(np.interp([0, 90, 270], angle, middle), [24e-6, 22e-6, 26e-6], rtol=1e-9)
                np.testing.assert_allclose([end[0] for end in ends], [24e-6, 26e-6], rtol=1e-9)
            self.assertEqual(film_pictures.gap_of(Run("made", pd.DataFrame(), {}, pd.DataFrame(), {}, {"joint": {"kind": "ideal"}})), [])

    def test_oscillating_film(self) -> None:
        speed, rod, crank = 300.0, 0.2, 0.05
        radius = self.BEARING - self.CLEARANCE
        for number, in_phase, out_of_phase in ((0.17, -9.67356114, 0.02133481), (1.0, -9.63125302, 0.73596503)):
            case = self.case(
                {"law": "oscillating_film", "kinematic_viscosity": speed * (self.CLEARANCE / number) ** 2}, rod, crank
            )
            unit = self.VISCOSITY * radius**2 / self.CLEARANCE**2 * self.WIDTH  # unit of a force, over the surface speed
            made = self.made(0.5, case, crank_speed=speed)  # U = -R (r/l) w, real
            surface = -radius * crank / rod * speed
            np.testing.assert_allclose(self.resultant(made), [0, -unit * surface * in_phase], rtol=2e-3, atol=1e-6)
            made = self.made(0.5, case, crank_speed=speed, crank_angle=np.pi / 2)  # U imaginary
            rate = crank / rod * speed**2 / np.sqrt(1 - (crank / rod) ** 2)
            surface = radius * rate / speed  # Re(-i s P*) = s Im P*
            np.testing.assert_allclose(self.resultant(made), [0, -unit * surface * out_of_phase], rtol=2e-3, atol=1e-6)

    def test_the_viscosity_of_an_oil(self) -> None:
        """An oil whose viscosity the run has computed gives the pressures of its numbers; at 15 degC its density is that of the case."""
        motion = {"crank_speed": 300.0, "rod_speed": 50.0}
        for law in ("pinkus_sternlicht", "oscillating_film"):
            given = self.case({"law": law, "kinematic_viscosity": self.VISCOSITY / 900}, 0.2, 0.05)
            oil = self.case({"law": law, "viscosity": 0.0, "kinematic_viscosity": 0.0, "density": 900.0, "temperature": 288.15}, 0.2, 0.05)
            wanted = self.resultant(self.made(0.5, given, **motion))
            found = self.resultant(replace(self.made(0.5, oil, **motion), summary={"viscosity": (str(self.VISCOSITY), "Pa s")}))
            np.testing.assert_allclose(found, wanted, rtol=1e-12)
            self.assertGreater(np.abs(wanted).max(), 1)

    def test_no_pressure_in_contact(self) -> None:
        made = self.made(1.1, self.case({"law": "pinkus_sternlicht"}, 0.2, 0.05), phase=2, rod_speed=50.0)
        self.assertFalse(film_pressure.pressure(made, self.ANGLES).any())


class MadeResults:
    """Runs from given columns for every name that figures need; those named in `missing` do not exist."""

    def __init__(self, missing: tuple[str, ...] = (), turns: float = 8, rows: int = 2001) -> None:
        self.missing, self.turns, self.rows = missing, turns, rows

    def __getitem__(self, name: str) -> Run:
        if name in self.missing:
            raise MissingResult(name)
        angle = np.linspace(0, 2 * np.pi * self.turns, self.rows)
        wave, beat = np.cos(angle), np.sin(37 * angle)
        rough = 0 if name.endswith("ideal") else 2e4
        flores = not name.startswith(("sim", "wiebe"))
        columns = {
            "time": angle / 250,
            "crank_angle": angle,
            "crank_speed": 250 + 20 * wave,
            "rod_speed": wave,
            "piston_velocity": 10 * np.sin(angle + 1e-3 * beat) + 0.01,
            "crank_moment": 100 * wave + rough * beat,
        }
        columns |= {
            name: 3e3 * wave + rough * beat
            for name in ("crank_acceleration", "rod_acceleration", "piston_acceleration", "pin_force_x", "pin_force_y")
        }
        if rough:
            e = np.array([np.cos(3 * angle), np.sin(2 * angle)]) * (1e-5 if "sim" not in name or "oscillating" in name else 6e-6)
            columns |= {
                "eccentricity_x": e[0],
                "eccentricity_y": e[1],
                "eccentricity_ratio": np.hypot(*e) / 1e-5,
                "film_thickness": 1e-5 - np.hypot(*e),
            }
        if name.startswith(("sim_IV", "sim_V", "wiebe")):
            columns |= {
                "cylinder_volume": 2e-4 - 1e-4 * wave,
                "cylinder_pressure": 1e5 + 3e6 * wave**16,
                "gas_force": 1e4 * wave**16,
            }
        case = {
            "joint": {"clearance": 1e-5},
            "drive": {"kind": "constant_speed" if flores else "free"},
        }
        if name.startswith(("sim_IV", "sim_V", "wiebe")):
            case["combustion"] = {"start_deg": 340.0}
        if "friction" in name:
            case["friction"] = {"coefficient": 0.05}
        if "lubricated" in name or name.startswith("sim"):
            case["lubrication"] = {
                "law": "oscillating_film" if "oscillating" in name else "pinkus_sternlicht",
                "viscosity": 0.4,
            }
        made = run(columns, case)
        return Run(name, made.trace, made.units, made.events, case=case)


def written(drawing: plt.Figure) -> list:
    """Every text in a drawing: numbers, names, titles, legends."""
    found = [text for legend in drawing.legends for text in legend.get_texts()]
    for axes in drawing.axes:
        if axes.axison:
            for axis in (axes.xaxis, axes.yaxis):
                found += [tick.label1 for tick in axis._update_ticks()] + [axis.label, axis.offsetText]
        found += [axes.title, *axes.texts]
    return [text for text in [*found, drawing._suptitle] if text and text.get_visible() and text.get_text().strip()]


def overlaps(drawing: plt.Figure) -> list[tuple[str, str]]:
    """Texts that overlap each other or leave the page."""
    drawing.canvas.draw()
    width, height = drawing.canvas.get_width_height()
    boxes = [(text.get_text(), text.get_window_extent()) for text in written(drawing)]
    found = [
        (name, "the margin")
        for name, box in boxes
        if box.x0 < -1 or box.y0 < -1 or box.x1 > width + 1 or box.y1 > height + 1
    ]
    for i, (name, box) in enumerate(boxes):
        found += [
            (name, other)
            for other, second in boxes[i + 1 :]
            if min(box.x1, second.x1) - max(box.x0, second.x0) > 0.5
            and min(box.y1, second.y1) - max(box.y0, second.y0) > 0.5
        ]
    return found


def empty_panels(drawing: plt.Figure) -> list[str]:
    """Panels without a curve and without a point, and places of the page without a panel."""
    found = []
    for axes in drawing.axes:
        shown = [np.isfinite(np.asarray(line.get_xydata(), dtype=float)).all(axis=1).any() for line in axes.lines if len(line.get_xdata()) > 2]
        if not any(shown) and not axes.collections:
            found.append(axes.get_ylabel() or axes.get_title() or "a panel")
    grid = drawing.axes[0].get_gridspec()
    covered = sum(len(spec.rowspan) * len(spec.colspan) for spec in (axes.get_subplotspec() for axes in drawing.axes))
    if covered < grid.nrows * grid.ncols:
        found.append(f"{covered} of {grid.nrows * grid.ncols} places have panels")
    return found


class Drawing(unittest.TestCase):
    #: One figure of each kind.
    KINDS = "6.1 6.2 6.5 6.6 6.7 6.8 6.25 6.32 A.2 B.3 B.5 B.6 B.7 B.9 B.12 B.13 B.21".split()

    def test_figures_are_drawn_and_no_text_overlaps(self) -> None:
        table = read_figures()
        for number in self.KINDS:
            drawing = figures.draw(table[number], MadeResults())
            self.assertEqual(overlaps(drawing), [], number)
            self.assertEqual(empty_panels(drawing), [], number)
            plt.close(drawing)

    def test_figures_in_portuguese(self) -> None:
        table, portuguese = read_figures(), language.Language("pt")
        for number in self.KINDS:
            drawing = figures.draw(table[number], MadeResults())
            portuguese.localise(drawing)
            self.assertEqual(overlaps(drawing), [], number)
            texts = [text.get_text() for text in written(drawing)]
            self.assertFalse([text for text in texts if re.search(r"\d\.\d", text.removeprefix(number))], number)
            self.assertTrue(drawing._suptitle.get_text().startswith(number), number)
            plt.close(drawing)
        self.assertEqual(portuguese.unknown, set())

    def test_every_title_and_quantity_has_its_portuguese(self) -> None:
        portuguese = language.Language("pt")
        for figure in read_figures().values():
            said = portuguese.say(f"{figure.number}  {figure.title}")
            self.assertNotEqual(said, f"{figure.number}  {figure.title}")
        for quantity in QUANTITIES.values():
            portuguese.say(quantity.label)
            portuguese.say(quantity.below_label)
        self.assertEqual(portuguese.unknown, set())

    def test_first_impacts_of_elastic_rods(self) -> None:
        time = np.linspace(0, 1e-3, 101)
        events = {
            "time": [2e-4, 3e-4],
            "crank_angle": [0.0, 0.0],
            "event": ["contact_begins", "contact_ends"],
            "normal_speed": [2.0, -0.8],
            "duration": [np.nan, 1e-4],
            "max_penetration": [np.nan, 1e-5],
            "max_normal_force": [np.nan, 1.1e4],
        }
        columns = {name: np.sin(3e3 * time) for name in ("film_thickness", "normal_force", "rod_mid_deflection", "rod_stretch")}
        runs = [run({"time": time, **columns}, events=events) for _ in elastic_pictures.RODS]
        for made in runs:
            made.summary["rhs_evaluations"] = ("7", "1")
        drawing = elastic_pictures.draw_first_impacts(runs)
        self.assertEqual(overlaps(drawing), [])
        plt.close(drawing)
        self.assertIn("| rigid | 0.2000 ms, +2.000 m/s | 0.3000 ms, -0.800 m/s | 11.0 kN | 7 |", elastic_pictures.describe_first_impacts(runs))

    def test_members(self) -> None:
        """A pin force of 3 and 4 kN, a bearing force of 1 kN, a moment of 2 N m whose work is dissipated: 4 pi J per revolution."""
        time = np.linspace(0, 3, 301)
        ones = np.ones_like(time)
        columns = {"crank_angle": 2 * math.pi * time, "crank_speed": 2 * math.pi * ones, "crank_moment": 2 * ones, "energy": 5 * ones,
                   "pin_force_x": 3e3 * ones, "pin_force_y": 4e3 * ones, "crank_bearing_force_x": 1e3 * ones, "crank_bearing_force_y": 0 * ones,
                   "guide_force": np.where(time < 0.9, 9e3, -2e3)}
        runs = [run({"time": time, **columns}) for _ in elastic_pictures.MEMBERS]
        for made in runs:
            made.summary.update({"rhs_evaluations": ("7", "1"), "contacts": ("6", "1"), "guide_1_contacts": ("1", "1"), "guide_4_contacts": ("2", "1")})
        drawing = elastic_pictures.draw_members(runs)
        self.assertEqual(overlaps(drawing), [])
        portuguese = language.Language("pt")
        portuguese.localise(drawing)
        self.assertEqual(portuguese.unknown, set())
        plt.close(drawing)
        self.assertIn(f"| all of it | 2.0 | 0.0 | 1.0 | 5.0 | 1.0 | 2.0 | {4 * math.pi:.2f} | 7 |", elastic_pictures.describe_members(runs))

    def test_integrators_in_portuguese(self) -> None:
        portuguese = language.Language("pt")
        scenes = pd.read_csv(TOP / "data" / "measured" / "integrators.csv")["scene"].unique()
        for text in (*scenes, "evaluations of the right-hand side", "an oil film (simulation I)", "error", "SciPy DOP853", "CVODE BDF", "RADAU5", "adams"):
            portuguese.say(text)
        self.assertEqual(portuguese.unknown, set())
        self.assertEqual(portuguese.say("simulation IV"), "simulação IV")

    def test_largest_deflection_of_a_rod(self) -> None:
        zero, far = np.zeros(3), np.array([0.0, 2e-6, 1e-6])
        self.assertEqual(report_scene.largest_deflection({"time": zero}), 0)
        self.assertAlmostEqual(report_scene.largest_deflection({"rod_mode_1": far, "rod_mode_2": zero}), 2e-6, delta=1e-12)
        self.assertAlmostEqual(report_scene.largest_deflection({"rod_mode_1": zero, "rod_mode_2": -far}), 2e-6, delta=1e-12)

    def test_overlaps_are_found(self) -> None:
        drawing, axes = plt.subplots(figsize=(3, 2))
        self.assertEqual(overlaps(drawing), [])
        axes.text(0.5, 0.5, "one")
        axes.text(0.5, 0.5, "two")
        self.assertEqual(overlaps(drawing), [("one", "two")])
        plt.close(drawing)

    def test_a_missing_run_leaves_its_place(self) -> None:
        figure = read_figures()["6.1"]
        drawing = figures.draw(figure, MadeResults(("sim_I_oscillating",)))
        self.assertIn("sim_I_oscillating", drawing.axes[1].texts[0].get_text())
        plt.close(drawing)
        with self.assertRaises(MissingResult):
            figures.draw(figure, MadeResults(figure.runs))

    def test_long_titles_are_fitted(self) -> None:
        drawing = figures.draw(read_figures()["B.10"], MadeResults())
        drawing._suptitle.set_text(2 * drawing._suptitle.get_text())
        self.assertTrue(any("the margin" in pair for pair in overlaps(drawing)))
        style.fit_title(drawing)
        self.assertFalse(any("the margin" in pair for pair in overlaps(drawing)), overlaps(drawing))
        plt.close(drawing)

    def test_vectors_stay_light(self) -> None:
        """The largest parts of a drawing are pixels in its vectors, the others remain lines; places are to a hundredth of a point."""
        drawing, axis = plt.subplots()
        noise = np.random.default_rng(1).standard_normal(20_000)
        (dense,) = axis.plot(noise)
        (light,) = axis.plot(np.linspace(-1, 1, 500) ** 2)
        points = axis.scatter(np.arange(3000), noise[:3000])
        with tempfile.TemporaryDirectory() as folder:
            png, svg = style.keep(drawing, f"{folder}/x.png")
            text = svg.read_text()
            self.assertGreater(png.stat().st_size, 5000)
        self.assertEqual([part.get_rasterized() for part in (dense, light, points)], [True, False, True])
        self.assertIn("data:image/png;base64", text)
        self.assertLess(len(re.sub(r'base64,[^"]*', "", text)), style.VECTORS)
        places = " ".join(re.findall(r' d="([^"]*)"', text))
        self.assertTrue(re.search(r"\d\.\d\d ", places) and not re.search(r"\.\d{3}", places))

    def test_ringing_is_told_from_a_steep_curve(self) -> None:
        x = np.linspace(0, 100, 20001)
        steep = 50 * np.sin(2 * np.pi * x / 25)
        self.assertFalse(ringing.rings(x, steep + 0.01 * np.sin(2 * np.pi * x / 0.2)), "a steep curve with a little noise")
        self.assertTrue(ringing.rings(x, steep + 20 * np.sin(2 * np.pi * x / 0.2)))
        self.assertFalse(ringing.rings(x, np.where(x < 30, 20 * np.sin(2 * np.pi * x / 0.2), 0.0), 0.5), "most of the time")

    def test_films_are_drawn_with_a_small_tolerance(self) -> None:
        """Runs with contact are made again with more rows, runs of a film alone with a smaller tolerance, others are the cases' own."""
        fine = FineResults(Results(Path("nowhere")))
        fine.own = MadeResults()
        fine.own.has = lambda name: True
        fine.touches = lambda name: "oscillating" in name
        self.assertTrue(fine.is_made("sim_I") and fine.is_made("sim_I_oscillating"))
        self.assertFalse(fine.is_made("friction_050"), "neither contact nor film")
        self.assertIn("integrator.relative_tolerance=1e-09", fine.settings(["sim_I"]))
        self.assertIn("output.samples_per_revolution=7200", fine.settings(["sim_I_oscillating"]))
        self.assertFalse(fine.is_made("sim_I.ideal"))

    def test_details_show_the_ideal_joint(self) -> None:
        table, results = read_figures(), MadeResults()

        def kinds(number: str) -> list:
            return [[panel.kind for panel in row] for row in figures.arrange(table[number], results)]

        self.assertEqual(kinds("6.1"), [["full", "full"], ["difference", "difference"]])  # same range
        self.assertEqual(kinds("6.4"), [["full", "full"], ["zoom", "zoom"]])  # rings
        self.assertEqual(kinds("B.3"), [["full"], ["detail"]])
        self.assertEqual(kinds("B.4"), [["full", "detail"]] * 3)
        self.assertEqual(kinds("6.7"), [["full", "full"], ["detail", "detail"], ["full", "full"]])

    def test_the_difference_to_the_ideal_joint_is_that_at_the_same_time(self) -> None:
        time = np.linspace(0, 1, 401)
        columns = {"time": time, "crank_angle": time, "crank_speed": 3 * time + np.where(time < 0.01, 50, 0)}
        ideal = run({"time": [0, 0.5, 1], "crank_speed": [0, 1, 2]})
        drawing, axes = plt.subplots()
        QUANTITIES["crank_speed"].draw_difference(axes, run(columns), ideal, "black")
        np.testing.assert_allclose(axes.lines[1].get_ydata()[200:], time[200:])
        self.assertLess(axes.get_ylim()[1], 2)  # the start does not determine the range
        self.assertIn("start cut off", axes.get_title())
        plt.close(drawing)

    def test_titles_say_the_revolutions(self) -> None:
        figure = read_figures()["B.7"]
        drawing = figures.draw(figure, MadeResults())
        self.assertIn("revolutions 0 to 8", drawing._suptitle.get_text())
        plt.close(drawing)

    def test_portraits_show_one_cycle_of_both_joints(self) -> None:
        drawing = figures.draw(read_figures()["6.32"], MadeResults())
        lines = {line.get_label(): line for line in drawing.axes[0].lines}
        for name in ("ideal joint", "Pinkus–Sternlicht film"):  # a four-stroke cycle: two of the eight revolutions
            self.assertEqual(len(lines[name].get_xdata()), 501, name)
        self.assertIn("cycle 4", drawing.axes[0].get_title())
        plt.close(drawing)

    def test_sections_are_points_of_their_last_cycles(self) -> None:
        long = MadeResults(turns=200, rows=1601)
        drawing = figures.draw(read_figures()["6.7"], MadeResults(), long)
        axes = [axes for axes in drawing.axes if "once a cycle" in axes.get_ylabel() or axes.collections]
        self.assertEqual(len(axes), 2)
        for axis in axes:
            self.assertEqual(len(axis.collections[0].get_offsets()), 60)
            self.assertTrue(all(line.get_linestyle() == "None" for line in axis.lines))
            self.assertIn("cycles 141 to 200", axis.get_title())
            velocity = axis.collections[0].get_offsets()[:, 0]
            np.testing.assert_allclose(velocity, 10 * np.sin(np.pi / 4) + 0.01, atol=0.02)
        plt.close(drawing)

    def test_films_are_logarithmic_and_penetration_is_apart(self) -> None:
        drawing = figures.draw(read_figures()["6.6"], MadeResults())
        film, other, deep = drawing.axes
        self.assertEqual([axes.get_yscale() for axes in (film, other, deep)], ["log", "log", "linear"])
        self.assertEqual(deep.get_ylabel(), "penetration [µm]")
        for axes in (film, other):
            self.assertGreater(np.nanmin(axes.lines[0].get_ydata()), 0)
        self.assertGreater(deep.lines[0].get_ydata().max(), 0)
        plt.close(drawing)

    def test_legends_name_the_solid_line(self) -> None:
        for number, name in (("6.1", "Pinkus–Sternlicht film"), ("B.7", "with clearance"), ("6.7", "oscillating film")):
            drawing = figures.draw(read_figures()[number], MadeResults())
            self.assertIn(name, [text.get_text() for text in drawing.legends[0].get_texts()], number)
            plt.close(drawing)

    def test_orbits_name_only_curves_that_show(self) -> None:
        for thickness, shown in ((1e-6, {"with clearance", "beginning"}), (-1e-6, {"in contact", "beginning"})):
            turn = np.linspace(0, 2 * np.pi, 50)
            made = run({"eccentricity_x": np.cos(turn) * 1e-4, "eccentricity_y": np.sin(turn) * 1e-4, "film_thickness": np.full(50, thickness)},
                       {"joint": {"clearance": 1e-4}})
            drawing, axis = plt.subplots()
            QUANTITIES["pin_orbit"].draw(axis, made, None, "blue")
            self.assertEqual(set(axis.get_legend_handles_labels()[1]), shown)
            plt.close(drawing)

    def test_last_tick_is_numbered(self) -> None:
        drawing = figures.draw(read_figures()["B.4"], MadeResults(turns=2, rows=1441))
        drawing.canvas.draw()
        for axes in drawing.axes[-2:]:
            self.assertEqual([tick.get_text() for tick in axes.get_xticklabels()][-1], "720")
        plt.close(drawing)

    def test_gas_figures_show_both_films(self) -> None:
        drawing = figures.draw(read_figures()["6.25"], MadeResults())
        self.assertEqual([len(axes.lines) for axes in drawing.axes], [2, 2])
        self.assertEqual(len(drawing.legends[0].get_texts()), 2)
        plt.close(drawing)


class FromRuns(unittest.TestCase):
    """The results that figures 4.1 to 4.5 and those of appendix B show, by numbers of their runs."""

    MASS, SPEED = 0.01644, 0.05  # reduced mass of the two spheres [kg]; speed of approach [m/s]
    RESTITUTION = 0.913176677806  # solution of chi (1 + e) = ln[(1 + chi)/(1 - chi e)], chi = 3 (1 - 0.9^2)/4

    @classmethod
    def setUpClass(cls) -> None:
        cls.work = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.work.cleanup)
        cls.figures = read_figures()
        cls.own = Results(Path(cls.work.name))
        cls.settled = WindowResults(cls.own, (10, 12))
        cls.long = WindowResults(cls.own, (10, 40))   # two revolutions are not enough for chaotic motions
        contact = {name for number, figure in cls.figures.items() if number[0] == "4" for name in figure.runs}
        flores = {name for number, figure in cls.figures.items() if number[0] == "B" for name in figure.needs}
        with contextlib.redirect_stderr(io.StringIO()):
            cls.own.make(contact | flores)
            cls.settled.make(flores)
            cls.long.make(flores)

    def drawn(self, number: str) -> plt.Figure:
        """Draw figure 4.x and check its texts."""
        drawing = figures.draw(self.figures[number], self.own)
        self.addCleanup(plt.close, drawing)
        self.assertEqual(overlaps(drawing), [], number)
        return drawing

    def lines(self, number: str) -> dict[str, np.ndarray]:
        """The curves of figure 4.x by their names in the legend."""
        return {line.get_label(): line.get_xydata().T for axes in self.drawn(number).axes for line in axes.lines}

    def work_of(self, curve: np.ndarray) -> float:
        """Integral of the force over the penetration, from um to J."""
        return float(1e-6 * np.trapezoid(curve[1], curve[0]))

    def test_hertz_gives_back_what_it_took(self) -> None:
        lines = self.lines("4.1")
        loading, unloading = lines["Hertz, loading"], lines["Hertz, unloading"]
        energy = self.MASS * self.SPEED**2 / 2
        self.assertAlmostEqual(self.work_of(loading) / energy, 1, places=3)
        self.assertAlmostEqual(self.work_of(unloading) / energy, -1, places=3)
        back = np.interp(loading[0], unloading[0][::-1], unloading[1][::-1])
        self.assertLess(np.abs(back - loading[1]).max(), 2e-3 * loading[1].max())

    def test_lankarani_nikravesh_loses_what_the_restitution_says(self) -> None:
        lines = self.lines("4.2")
        loading, unloading = lines["Lankarani–Nikravesh, loading"], lines["Lankarani–Nikravesh, unloading"]
        energy = self.MASS * self.SPEED**2 / 2
        loop = self.work_of(loading) + self.work_of(unloading)
        self.assertAlmostEqual(loop / energy, 1 - self.RESTITUTION**2, places=3)
        elastic, depth = lines["Hertz, loading"], np.linspace(0.2, 1.6, 15)
        above, below = np.interp(depth, *loading), np.interp(depth, *unloading[:, ::-1])
        self.assertTrue(np.all(above > 1.02 * np.interp(depth, *elastic)))
        self.assertTrue(np.all(below < 0.98 * np.interp(depth, *elastic)))

    def test_speeds_of_separation(self) -> None:
        over_time, over_depth = self.drawn("4.3").axes
        for axes in (over_time, over_depth):
            hertz, lossy = axes.lines[0].get_xydata(), axes.lines[1].get_xydata()
            for curve, ratio in ((hertz, 1), (lossy, self.RESTITUTION)):
                self.assertAlmostEqual(curve[0, 1] / 50, 1, places=3)  # mm/s
                self.assertAlmostEqual(curve[-1, 1] / 50, -ratio, places=3)
                self.assertTrue(np.all(np.diff(curve[:, 1]) < 0))
        self.assertTrue(np.all(np.diff(over_time.lines[0].get_xdata()) > 0))
        names = [text.get_text() for text in over_time.figure.legends[0].get_texts()]
        self.assertIn("1.0000", names[0])
        self.assertIn("0.9132", names[1])

    def friction_ratio(self, number: str) -> tuple[np.ndarray, np.ndarray]:
        """Sliding speed [mm/s] and friction force over the full friction, as drawn, slowest first."""
        (name,) = self.figures[number].runs
        load = self.own[name]["normal_force"].mean()
        self.assertLess(np.ptp(self.own[name]["normal_force"]), 0.07 * load)
        axes = self.drawn(number).axes[0]
        speed, force = max((line.get_xydata() for line in axes.lines), key=len).T
        self.assertGreater(speed.max(), 15)
        self.assertLess(speed.min(), -15)
        return speed, force / (0.03 * load)

    def test_coulomb_friction_jumps_at_zero(self) -> None:
        speed, ratio = self.friction_ratio("4.4")
        sliding = np.abs(speed) > 0.05
        np.testing.assert_allclose(ratio[sliding], -np.sign(speed[sliding]), atol=0.04)
        slow = ratio[sliding & (np.abs(speed) < 1)]
        self.assertAlmostEqual(np.ptp(slow), 2, delta=0.08)  # the whole jump is within 1 mm/s on both sides
        sticking = ratio[np.abs(speed) < 1e-6]
        self.assertGreater(len(sticking), 20)
        self.assertLess(np.abs(sticking).max(), 1.04)

    def test_ambrosio_friction_is_a_ramp(self) -> None:
        speed, ratio = self.friction_ratio("4.5")
        wanted = -np.sign(speed) * np.clip((np.abs(speed) - 1) / 9, 0, 1)
        np.testing.assert_allclose(ratio, wanted, atol=0.04)
        self.assertLess(np.abs(np.diff(ratio)).max(), 0.05)  # no jump
        self.assertEqual(np.abs(ratio[np.abs(speed) < 0.99]).max(), 0)

    def test_appendix_b_is_drawn_of_its_window(self) -> None:
        for name in ("friction_010", "lubricated_400cP", "ideal"):
            turns = self.settled[name]["crank_angle"] / (2 * np.pi)
            self.assertEqual(len(turns), 2 * WindowResults.SAMPLES + 1)
            np.testing.assert_allclose(turns[[0, -1]], [10, 12], atol=1e-9)
        for number in ("B.7", "B.21"):
            drawing = figures.draw(self.figures[number], self.settled)
            self.assertIn("revolutions 10 to 12", drawing._suptitle.get_text())
            self.assertEqual(overlaps(drawing), [], number)
            np.testing.assert_allclose(drawing.axes[-1].get_xlim(), [0, 720], atol=1e-6)
            self.assertEqual(drawing.axes[-1].get_xticks()[-1], 720)
            plt.close(drawing)
        drawing = figures.draw(self.figures["B.7"].at_start, self.own)
        self.assertIn("revolutions 0 to 2", drawing._suptitle.get_text())
        plt.close(drawing)

    def roughness(self, results: Results, name: str) -> float:
        """Deviation of the crank moment from that of the ideal joint, relative to its size."""
        ideal = results["ideal"]["crank_moment"]
        return float(np.sqrt(np.mean((results[name]["crank_moment"] - ideal) ** 2) / np.mean(ideal**2)))

    def unrest(self, name: str) -> float:
        """Largest difference of the piston velocity between two successive revolutions [m/s]."""
        velocity = self.settled[name]["piston_velocity"]
        half = len(velocity) // 2
        return float(np.sqrt(np.mean((velocity[:half] - velocity[half : 2 * half]) ** 2)))

    def test_settled_friction_calms_and_less_clearance_too(self) -> None:
        for three in (("friction_010", "friction_050", "friction_100"), ("dry_0500um", "dry_0100um", "dry_0010um")):
            rough = [self.roughness(self.long, name) for name in three]
            self.assertGreater(rough[0], 1.1 * rough[1])
            self.assertGreater(rough[1], 1.1 * rough[2])
            open_share = [float((self.settled[name]["film_thickness"] > 0).mean()) for name in three]
            self.assertEqual(sorted(open_share, reverse=True), open_share)
            unrest = [self.unrest(name) for name in three]
            self.assertGreater(unrest[0], 2 * unrest[1])
            self.assertGreater(unrest[1], 100 * unrest[2])
        for name in ("dry_0010um", "friction_100", "lubricated_400cP"):  # settled: these runs become periodic
            self.assertLess(self.unrest(name), 1e-4, name)

    def test_the_start_would_say_the_opposite_of_friction(self) -> None:
        peak = [np.abs(self.own[f"friction_{n}"]["crank_moment"]).max() for n in ("010", "050", "100")]
        self.assertEqual(sorted(peak), peak)
        settled = [np.abs(self.settled[f"friction_{n}"]["crank_moment"]).max() for n in ("050", "100")]
        self.assertTrue(peak[1] > 2 * settled[0] and peak[2] > 3 * settled[1])


class Ringing(unittest.TestCase):
    """Curves that oscillate faster than the width of a picture can show."""

    X = np.linspace(0, 100, 30001)

    def test_what_rings(self) -> None:
        slow = np.sin(self.X)
        self.assertFalse(ringing.rings(self.X, slow))
        burst = np.where((self.X > 40) & (self.X < 60), np.sin(60 * self.X), 0)
        self.assertTrue(ringing.rings(self.X, slow + burst))
        self.assertFalse(ringing.rings(self.X, slow + 1e-3 * burst))  # too small to be seen
        self.assertFalse(ringing.rings(self.X[:500], (slow + burst)[:500]))

    def test_envelope_and_mean(self) -> None:
        found = ringing.envelope(self.X, 3 * np.sin(60 * self.X) + 1)
        np.testing.assert_allclose(found.high, 4, atol=0.05)
        np.testing.assert_allclose(found.low, -2, atol=0.05)
        self.assertLess(abs(found.mean - 1).max(), 0.35)
        self.assertLess(abs(found.mean.mean() - 1), 1e-2)

    def test_mean_is_over_the_abscissa_not_over_rows(self) -> None:
        x = np.concatenate([np.linspace(0, 50, 100001), np.linspace(50.0001, 100, 11)])
        found = ringing.envelope(x, (x > 50).astype(float), 1)
        self.assertAlmostEqual(found.mean[0], 0.5, places=3)

    def test_zoom_is_on_the_largest_ringing(self) -> None:
        burst = np.exp(-((self.X - 62) ** 2)) * np.sin(60 * self.X)
        low, high = ringing.zoom_window(self.X, burst, 0 * self.X, 10.0)
        self.assertTrue(60.5 < low < high < 63.5, (low, high))
        shown = (self.X > low) & (self.X < high)
        turns = np.count_nonzero(np.diff(np.sign(burst[shown])))
        self.assertTrue(12 <= turns <= 40, turns)


class Portuguese(unittest.TestCase):
    def test_texts(self) -> None:
        portuguese = language.Language("pt")
        for english, said in (
            ("crank speed [rad/s]", "velocidade da manivela [rad/s]"),
            ("6.1  Simulation I: crank speed", "6.1  Simulação I: velocidade da manivela"),
            ("Pinkus–Sternlicht film, smallest film thickness 4.22 µm", "filme de Pinkus–Sternlicht, filme mínimo 4,22 µm"),
            ("piston velocity\n[m/s]", "velocidade do pistão\n[m/s]"),
            ("$10^{0.5}$", "$10^{0{,}5}$"),
            ("crank speed\n[rpm]", "rotação\n[rpm]"),
            ("1.75", "1,75"),
        ):
            self.assertEqual(portuguese.say(english), said)
        self.assertEqual(portuguese.unknown, set())
        self.assertEqual(portuguese.say("a thing nobody knows 1.5"), "a thing nobody knows 1,5")
        self.assertEqual(portuguese.unknown, {"a thing nobody knows 1.5"})

    def test_other_pictures(self) -> None:
        """Texts of elastic rods, films and trade-offs, and the names of the columns by which runs are compared."""
        portuguese = language.Language("pt")
        for text in (
            *(name for name, *_ in elastic_pictures.RODS),
            *(name for _, name, _ in film_pictures.FILMS),
            *(label for _, label in tradeoff.ERRORS),
            *(column.replace("_", " ") for column in compare.COLUMNS),
            *names.KEYS.values(),
            *names.COLUMNS.values(),
        ):
            portuguese.say(text)
        self.assertEqual(portuguese.unknown, set())

    def test_one_word_for_one_part(self) -> None:
        """The crank pin has one name in Portuguese, in pictures, on pages and in what the program prints."""
        printed = dict(re.findall(r"^    '((?:[^']|'')*)', '((?:[^']|'')*)'", (TOP / "src/io/portuguese.f90").read_text(encoding="utf-8"), re.MULTILINE))
        self.assertEqual(printed["crank pin"], "pino da manivela")
        other_sense = {"speed", "bore"}   # of the animation, of a bearing
        self.assertEqual([text for text, said in printed.items() if TEXTS.get(text, said) != said and text not in other_sense], [])
        self.assertEqual([said for said in TEXTS.values() if re.search("moente|cabeça", said, re.IGNORECASE)], [])

    def test_what_compare_prints(self) -> None:
        time = np.linspace(0, 1, 11)
        a, b = (run({"time": time, "crank_speed": 100 + 10 * time + size * time**2}) for size in (0, 2))
        self.addCleanup(language.use, "en")
        said = language.use("pt")
        printed = compare.report(compare.agree(a, b, ["crank_speed"], 0.05), 0.05)
        self.assertIn("horizonte: 0,5 s, por causa de crank_speed", printed)
        self.assertIn("comparadas de 0 s a 1 s; concordância: diferença de até 0,05 da faixa", printed)
        self.assertEqual(said.unknown, set())

    def test_a_name_behind_what_it_is(self) -> None:
        """As in the scenes of gudgeon-plot models; a name that is a word of a text, such as a run that is called friction, changes no text."""
        said = language.Language("pt")
        for name in ("lugre", "friction", "0.01"):
            said.keep(name)
        self.assertEqual(said.say("0.01"), "0,01")   # a number is no name
        self.assertEqual([said.say(text) for text in ("friction lugre at the crank pin", "no friction", "normal force over penetration")],
                         ["atrito lugre no pino da manivela", "sem atrito", "força normal em função da penetração"])
        self.assertEqual(said.unknown, set())

    def test_names_and_units_need_no_translation(self) -> None:
        """Units with the prefixes of large and small values; the user's own titles in `gudgeon-plot columns`."""
        portuguese = language.Language("pt")
        for unit in names.PREFIXED:
            for size, _ in names.PREFIXES:
                portuguese.say(f"[{names.plain_unit(names.prefixed(unit, np.array([1.5 * size]))[0])}/√Hz]")
        self.assertEqual(portuguese.unknown, set())
        titled = run({"time": [0.0, 1.0], "crank_angle": [0.0, 6.3], "pin_force": [0.0, 1.0]}, {"case": {"title": "My machine: clearance 0.5 mm"}})
        self.addCleanup(language.use, "en")
        portuguese = language.use("pt")
        drawing = columns.draw([titled], ["pin_force"])
        portuguese.localise(drawing)
        self.assertEqual((drawing._suptitle.get_text(), portuguese.unknown), ("My machine: clearance 0.5 mm", set()))
        plt.close("all")

    def test_english_stays_as_it_is(self) -> None:
        english = language.Language()
        self.assertEqual(english.say("crank speed 1.5"), "crank speed 1.5")

    def test_numbers_at_axes(self) -> None:
        drawing, axes = plt.subplots()
        axes.plot([0, 1], [0, 0.5])
        language.Language("pt").localise(drawing)
        drawing.canvas.draw()
        self.assertIn("0,2", [tick.get_text() for tick in axes.get_xticklabels()])
        plt.close(drawing)


class PrintsNoise(unittest.TestCase):
    """The figures of scripts/bench/show_noise.py."""

    def made(self) -> show_noise.Noise:
        """Noise of 10 % where the eccentricity is larger than 0.95 c; the start, in which the pin falls, is not counted."""
        time = np.linspace(0, 1, 1001)
        ratio = 0.9 + 0.09 * np.sin(20 * time)
        away = np.where(ratio > 0.95, 0.1, 1e-4)
        away[:10] = 5.0
        return show_noise.Noise("II", time, np.cos(time), ratio, {1e-6: away, 1e-8: 1e-3 * away})

    def test_noise_is_where_the_film_is_thin(self) -> None:
        noise = self.made()
        self.assertAlmostEqual(noise.largest(1e-6), 0.1)
        self.assertAlmostEqual(noise.largest(1e-8), 1e-4)
        there, elsewhere = noise.eccentricities(1e-6)
        self.assertTrue(0.95 < there < 0.99 and elsewhere < 0.95, (there, elsewhere))
        self.assertTrue(np.isnan(noise.eccentricities(1e-8)[0]))
        row = show_noise.table([noise])[-1]
        self.assertTrue(row.startswith("| II | 10 % |") and row.endswith("| 0.01 % |"), row)

    def test_the_picture(self) -> None:
        drawing, portuguese = show_noise.draw([self.made(), self.made()]), language.Language("pt")
        self.assertEqual([axes.get_yscale() for axes in drawing.axes], 2 * ["linear", "log"])
        self.assertEqual(empty_panels(drawing), [])
        self.assertEqual(overlaps(drawing), [])
        portuguese.localise(drawing)
        self.assertEqual(portuguese.unknown, set())
        plt.close(drawing)


class Windows(unittest.TestCase):
    def test_settings_of_a_window(self) -> None:
        class Own(Results):
            speeds = {"a": 100 * np.pi, "b": -100 * np.pi, "c": 1.0}

            def make(self, names: object) -> None:
                pass

            def __getitem__(self, name: str) -> Run:
                return run({"time": [0.0]}, {"initial": {"crank_speed": self.speeds[name]}})

        found = WindowResults(Own(Path("there")), (5, 8))
        self.assertEqual(found.path("a"), Path("there/revolutions_5-8/a.csv"))
        self.assertEqual(found.settings(["a", "b"])[:2], ["integrator.revolutions=8", "output.start_time=0.1"])
        with self.assertRaisesRegex(MissingResult, "different speeds"):
            found.settings(["a", "c"])


class Reading(unittest.TestCase):
    def test_a_case_as_run(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            path = Path(work) / "x.resolved.nml"
            path.write_text(
                "&case\n  title = 'it''s'\n/\n&joint\n  clearance = 5.0E-04  ! m\n/\n&contact\n"
                "  density = 1.0, 2.0  ! kg/m^3\n/\n&output\n  every_step = .true.\n/\n",
                encoding="utf-8",
            )
            self.assertEqual(
                read_case(path),
                {
                    "case": {"title": "it's"},
                    "joint": {"clearance": 5e-4},
                    "contact": {"density": [1.0, 2.0]},
                    "output": {"every_step": True},
                },
            )

    def test_a_loose_crank_pin_is_told_from_the_piston_pin(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            path = Path(work, "x.csv")
            path.write_text("time[s],film_thickness[m],crank_pin_phase[-]\n0,1e-4,0\n1,1e-4,2\n", encoding="utf-8")
            path.with_name("x.resolved.nml").write_text(
                "&joint\n  kind = 'clearance'\n  clearance = 2.0E-04  ! m\n/\n"
                "&joint\n  place = 'crank_pin'\n  clearance = 1.0E-04  ! m\n/\n"
                "&contact\n  place = 'crank_pin'\n  law = 'hertz'\n/\n",
                encoding="utf-8",
            )
            path.with_name("x.events.csv").write_text(
                "time[s],crank_angle[rad],event,normal_speed[m/s],duration[s],max_penetration[m],max_normal_force[N],joint\n"
                "0.1,0,contact_begins,1,,,,crank_pin\n0.2,0,contact_begins,2,,,,piston_pin\n"
                "0.3,0,contact_ends,-1,0.2,3e-6,30,crank_pin\n0.5,0,contact_ends,-2,0.3,5e-6,50,piston_pin\n",
                encoding="utf-8",
            )
            loaded = load_run(path)
        self.assertEqual(loaded.clearance, 2e-4)
        self.assertEqual(loaded.parameter("crank_pin.joint", "clearance"), 1e-4)
        self.assertEqual(list(loaded.case), ["joint", "crank_pin.joint", "crank_pin.contact"])
        np.testing.assert_allclose(loaded.contacts.to_numpy(), [[0.2, 0.5, 5e-6, 50]])

    def test_columns_lose_their_units(self) -> None:
        trace = load_run(TOP / "data" / "sim_I.csv")
        self.assertIn("crank_speed", trace)
        self.assertEqual(trace.units["crank_speed"], "rad/s")

    def test_files_that_are_no_such_result_say_so(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            path = Path(work) / "x.csv"
            texts = {"": "not a CSV file", "a,b\n1\n2,3,4\n": "not a CSV file", "\n": "not a CSV file", "time[s],a\n0,1\n": "no column"}
            for text, said in texts.items():
                path.write_text(text)
                for read in (study.Runs.read, film_pressure.fields_of):
                    with self.assertRaisesRegex(MissingResult, f"x.csv: .*{said}", msg=f"{read} of {text!r}"):
                        read(path)
            few = load_run(path)
            self.assertEqual(list(few["a"]), [1])
            for cells in ("0,x", "0,1\n1,nan", "0,1\n1", "0,inf"):
                path.write_text(f"time[s],a\n{cells}\n")
                with self.assertRaisesRegex(MissingResult, "x.csv: column a: not a number in each row"):
                    load_run(path)
            with self.assertRaisesRegex(MissingResult, "x and x share no column that varies"):
                path.write_text("time[s],a\n0,1\n1,2\n")
                compare.shared_columns(load_run(path), load_run(path))
            path.write_text("time[s],a\n0,1\n")
            with self.assertRaisesRegex(MissingResult, "x: the trace has no column pin_force_x"):
                few["pin_force_x"]
            for text in ("time[s],a\n0,1\n", "run,status\n1,done\n2,&output start_time = .05: must be (s)\n", "&study case='x'"):
                path.write_text(text)
                with self.assertRaisesRegex(MissingResult, "x.csv: "):
                    study.read_study(path)

    def test_wrong_options_are_refused_in_one_line(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            there = Path(work)
            (there / "x.runs.csv").write_text("run,joint.clearance,status,impacts[-]\n1,1e-5,done,1\n2,2e-5,done,2\n")
            (there / "failed.runs.csv").write_text("run,joint.clearance,status,impacts[-]\n1,1e-5,too deep,\n2,2e-5,too long,\n3,3e-5,too deep,\n")
            (there / "x.wear.csv").write_text("joint,angle[deg],pin_depth[m],bore_depth[m]\npiston_pin,0,x,1\n")
            (there / "x.film.csv").write_text("time[s],joint,place,angle[deg],pressure[Pa],film_thickness[m]\n0,piston_pin,0,0,,1\n")
            for name, text in (("alone.csv", "time[s],crank_angle[rad]\n0,0\n1,1\n"), ("alone.resolved.nml", "&bearing_load\n  load = 1.0, 0.0\n/\n"),
                               ("alone.film_history.csv", "crank_angle[rad],quick_film_thickness[m],min_film_thickness[m]\n0,1,1\n")):
                (there / name).write_text(text)
            for status, words, said in (
                (1, ("study", there / "x.runs.csv", "--columns", "status"), "status: contains words, no numbers"),
                (1, ("study", there / "failed.runs.csv", "--columns", "impacts"),
                 "failed.runs.csv: no results, all 3 runs failed (2: too deep; 1: too long)\n"),
                (2, ("study", there / "x.runs.csv", "--numbers"), "--numbers is for the shipped studies alone"),
                (2, ("study", "--columns", "impacts"), "--columns is for studies"),
                (1, ("wear", there / "x.wear.csv"), "column pin_depth: not a number in each row"),
                (1, ("film", there / "x.film.csv"), "column pressure: not a number in each row"),
                (2, ("report", there / "alone.csv"), "alone: a bearing by itself has no mechanism to draw"),
                (2, ("film", there / "alone.csv"), "alone.film_history.csv: a steady state has no picture"),
                (2, ("film", there / "x.film.csv", "--at", "0.01"), "--at and --set are for a case"),
                (1, ("measure_elastic.py", "members", "--program", there / "nothing"), "measure_elastic.py: "),
            ):
                command = [TOP / "scripts" / "bench" / words[0]] if str(words[0]).endswith(".py") else ["-m", "gudgeon", words[0]]
                outcome = subprocess.run([sys.executable, *command, *words[1:]], capture_output=True, text=True, check=False)
                self.assertEqual(outcome.returncode, status, f"{words}: {outcome.stderr}")
                self.assertIn(said, outcome.stderr)
                self.assertNotIn("Traceback", outcome.stderr)

    def test_a_contact_that_outlasts_the_run(self) -> None:
        time = np.linspace(0, 1, 11)
        made = run(
            {"time": time, "film_thickness": -time, "normal_force": 5 * time},
            events={
                "time": [0.1, 0.3, 0.75],
                "crank_angle": [0, 0, 0],
                "event": ["contact_begins", "contact_ends", "contact_begins"],
                "normal_speed": [1, -1, 1],
                "duration": [np.nan, 0.2, np.nan],
                "max_penetration": [np.nan, 7, np.nan],
                "max_normal_force": [np.nan, 8, np.nan],
            },
        )
        np.testing.assert_allclose(made.contacts.to_numpy(), [[0.1, 0.3, 7, 8], [0.75, 1, 1, 5]])

    def test_a_run_of_this_process_is_drawn(self) -> None:
        class Quantities(dict):
            units = {"contacts": "1"}

        columns = pd.DataFrame({"time": [0.0, 1.0], "film_thickness": [2e-5, 1e-5]})
        own = SimpleNamespace(
            name="own", to_pandas=lambda: columns, units={"time": "s", "film_thickness": "m"}, summary=Quantities(contacts=1),
            events=pd.DataFrame({"joint": ["crank_pin", "piston_pin"], "time": [0.1, 0.2]}),
            _resolved=None,
            case=SimpleNamespace(to_nml=lambda complete: "&joint\n  kind = 'clearance'\n  clearance = 2e-5   ! m\n/\n"),
        )
        made = drawable(own)
        self.assertEqual((made.clearance, made.summary, list(made.events["time"])), (2e-5, {"contacts": ("1", "1")}, [0.2]))
        np.testing.assert_array_equal(made["film_thickness"], [2e-5, 1e-5])

    def test_missing_results_say_what_to_run(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            with self.assertRaisesRegex(MissingResult, "run: gudgeon -o .*cases/sim_I.nml"):
                Results(Path(work), run_missing=False).make(["sim_I", "sim_I.ideal"])
            with self.assertRaisesRegex(MissingResult, "nor a shipped case: nonsense$"):
                Results(Path(work)).make(["nonsense"])


class ResultsOfACase(unittest.TestCase):
    """Which results belong to a case file: here a/pin.nml and b/pin.nml, two machines of one name."""

    def setUp(self) -> None:
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        self.addCleanup(os.chdir, Path.cwd())
        os.chdir(work.name)
        self.case("a/pin.nml", "20 um")
        self.case("b/pin.nml", "50 um")

    def case(self, path: str, clearance: str) -> None:
        Path(path).parent.mkdir(exist_ok=True)
        text = subprocess.run([release_program(), "--template=dry"], capture_output=True, text=True, check=True).stdout
        Path(path).write_text(text.replace("clearance = 20 um", f"clearance = {clearance}"))

    def run_case(self, path: str, *options: str) -> None:
        subprocess.run([release_program(), "-q", *options, path], check=True)

    def clearance(self, word: str, **options: object) -> float:
        results, name = located(word, **options)
        return results[name].clearance

    def test_results_are_beside_the_case_or_where_they_were_put(self) -> None:
        self.run_case("b/pin.nml")
        self.run_case("a/pin.nml", "-o", "a")
        self.assertEqual([self.clearance(f"{place}/pin.nml") for place in "ab"], [20e-6, 50e-6])
        self.assertEqual((self.clearance("pin"), self.clearance("a/pin.csv"), self.clearance("a/pin.events.csv")), (50e-6, 20e-6, 20e-6))
        self.run_case("a/pin.nml", "-o", "c")
        self.assertEqual(self.clearance("a/pin.nml", folder=Path("c")), 20e-6)

    def test_a_case_without_results_is_run(self) -> None:
        with self.assertRaisesRegex(MissingResult, "run: gudgeon -o results b/pin.nml"):
            located("b/pin.nml", run_missing=False)
        self.assertEqual(self.clearance("b/pin.nml"), 50e-6)
        self.assertTrue(Path("results/pin.csv").exists())

    def test_results_of_another_machine_are_said(self) -> None:
        self.run_case("b/pin.nml")
        with self.assertRaisesRegex(MissingResult, r"results/pin.csv is not .* a/pin.nml as it is now \(joint.clearance is 2e-05, was 5e-05\)"):
            located("a/pin.nml")
        self.case("b/pin.nml", "30 um")
        with self.assertRaisesRegex(MissingResult, r"\(joint.clearance is 3e-05, was 5e-05\): run b/pin.nml again"):
            located("b/pin.nml")
        with Path("a/pin.nml").open("a") as case:
            case.write("&gas cycle = 'two_stroke' /\n")
        with self.assertRaisesRegex(MissingResult, "a/pin.nml:20: &gas: unknown group"):
            located("a/pin.nml")
        Path("results/pin.resolved.nml").unlink()
        with self.assertRaisesRegex(MissingResult, "pin.resolved.nml is missing"):
            located("b/pin.nml")
        self.run_case("b/pin.nml")
        self.assertEqual(self.clearance("b/pin.nml"), 30e-6)

    def test_a_table_that_has_changed_is_another_case(self) -> None:
        for name in ("motor.nml", "motor.csv"):
            Path(name).write_text((TOP / "cases" / "drive" / name).read_text())
        self.run_case("motor.nml", "-s", "integrator.end_time=0.001")
        with self.assertRaisesRegex(MissingResult, "integrator.end_time is"):
            located("motor.nml")
        self.run_case("motor.nml")
        self.assertEqual(located("motor.nml")[1], "motor")
        Path("motor.csv").write_text(Path("motor.csv").read_text().replace("100,15", "100,16"))
        with self.assertRaisesRegex(MissingResult, "drive.torque_table_digest is"):
            located("motor.nml")

    def test_shipped_cases_are_given_by_their_paths(self) -> None:
        with self.assertRaisesRegex(MissingResult, "no trace results/sim_I.csv: give the trace of a run, its case file"):
            located("sim_I")
        with self.assertRaisesRegex(MissingResult, "c/pin.nml: no such case file"):
            located("c/pin.nml")


class Columns(unittest.TestCase):
    """`gudgeon-plot columns` and `laws`."""

    def setUp(self) -> None:
        self.angle = np.linspace(0, 7 * np.pi, 701)
        self.run = run({"time": self.angle / 100, "crank_angle": self.angle, "pin_force_x": 3e3 * np.cos(self.angle),
                        "pin_force_y": 3e3 * np.sin(self.angle)})
        self.run.units.update(pin_force_x="N", pin_force_y="N")

    def test_a_vector_is_drawn_by_its_magnitude_in_a_fitting_unit(self) -> None:
        drawing = columns.draw([self.run], ["pin_force"])
        (line,) = drawing.axes[0].lines
        np.testing.assert_allclose(line.get_ydata(), 3)
        self.assertIn("[kN]", drawing.axes[0].get_ylabel())
        np.testing.assert_allclose(line.get_xdata(), np.degrees(self.angle))
        plt.close(drawing)

    def test_one_cycle(self) -> None:
        for cycle, first in ((0, 0), (1, 2), (-1, 4), (-3, 0)):   # of three whole revolutions
            rows = columns.rows_of_cycle(self.run, cycle)
            np.testing.assert_allclose(self.angle[rows][[0, -1]], np.array([first, first + 2]) * np.pi, atol=0.05)

    def test_crank_angles_have_ticks_of_quarter_turns(self) -> None:
        for turns, step in ((0.25, 30), (1, 90), (2, 90), (3.5, 180), (8, 360), (50, 2880)):
            for first in (0.0, 28 * np.pi):
                angle = np.linspace(first, first + 2 * np.pi * turns, 500)
                drawing = columns.draw([run({"time": angle, "crank_angle": angle, "pin_force": angle})], ["pin_force"])
                ticks = drawing.axes[0].get_xticks()
                self.assertEqual((set(np.diff(ticks)), set(ticks % step)), ({step}, {0}), turns)
                plt.close(drawing)

    def test_the_last_cycle_is_that_of_the_summary(self) -> None:
        """Three and a half cycles, of which the last whole one ends with the run: it is counted from 0 degrees."""
        made = replace(self.run, summary={"cycle_start": (str(0.05 * np.pi), "s"), "cycle_duration": (str(0.02 * np.pi), "s")})
        for cycle, first in ((-1, 5), (-3, 1), (0, 1)):
            rows = columns.rows_of_cycle(made, cycle)
            np.testing.assert_allclose(self.angle[rows][[0, -1]], np.array([first, first + 2]) * np.pi, atol=0.02)
        drawing = columns.draw([made], ["pin_force_x"], cycle=-1)
        x, y = drawing.axes[0].lines[0].get_data()
        np.testing.assert_allclose(x[[0, -1]], (0, 360), atol=2)   # rows are 1.8 degrees apart
        np.testing.assert_allclose(y, 3 * np.cos(np.radians(x)), atol=0.02)
        self.assertTrue(set(range(0, 361, 90)) <= set(np.round(drawing.axes[0].get_xticks()).astype(int)))
        plt.close(drawing)

    def test_bearings_of_an_engine_stand_along_its_shaft(self) -> None:
        """Circles of main bearings at the journals, of crank pins at their throws; two rods on one throw stand beside each other."""
        angle = np.radians(np.arange(0, 721, 4.0))
        columns, rows = {"time": angle / 100, "crank_angle": angle}, {"cycle_thinnest_bearing": "crank_pin_2", "cycle_bearings_power": "30"}
        names = [f"main_bearing_{b}" for b in (1, 2)] + [f"crank_pin_{i}" for i in (1, 2)]
        for k, name in enumerate(names):
            x, y = (5e-6 + k * 1e-6) * np.cos(angle), 4e-6 * np.sin(angle)
            columns |= {f"{name}_eccentricity_x": x, f"{name}_eccentricity_y": y, f"{name}_film_thickness": 1e-5 - np.hypot(x, y)}
            rows |= {f"{name}_cycle_min_film_thickness": f"{5e-6 - k * 1e-6}", f"{name}_cycle_min_film_thickness_angle": "180", f"{name}_cycle_mean_film_power": f"{5 * (k + 1)}"}
        made = run(columns)
        made.summary.update({name: (value, "") for name, value in rows.items()})
        made.case.update(cylinder_1={"phase_deg": 0.0, "throw": 1.0}, cylinder_2={"phase_deg": 0.0, "throw": 1.0})
        self.assertEqual(bearing_pictures.numbered(made), {"main_bearing": (1, 2), "crank_pin": (1, 2)})
        drawing = bearing_pictures.engine(made, "made")
        shaft, losses = drawing.axes
        self.assertEqual({text.get_text().split("\n")[0]: text.get_position()[0] for text in shaft.texts},
                         {"main bearing 1": 0.0, "main bearing 2": 2.0, "crank pin 1": 0.55, "crank pin 2": 1.45})
        self.assertEqual([bar.get_height() for bar in losses.patches], [5.0, 10.0, 15.0, 20.0])
        self.assertIn("thinnest film 2 µm at crank pin 2", drawing.get_suptitle())
        plt.close(drawing)

    def test_orbits_have_the_angles_of_the_trace(self) -> None:
        """A last cycle of two revolutions that begins at an odd one: each number at the orbit is the angle of the trace at this place."""
        angle = np.radians(np.arange(0, 9 * 360 + 1))
        x, y = 8e-6 * np.cos(angle / 2), 6e-6 * np.sin(angle / 2)
        made = run({"time": angle / 100, "crank_angle": angle, "eccentricity_x": x, "eccentricity_y": y, "film_thickness": 1e-5 - np.hypot(x, y),
                    "film_force_x": -1e3 * np.cos(20 * angle), "film_force_y": -1e3 * np.sin(20 * angle)})
        made.summary.update(cycle_start=(str(0.14 * np.pi), "s"), cycle_duration=(str(0.04 * np.pi), "s"), cycle_revolutions=("2", "1"))
        drawing = bearing_pictures.orbit(made, "piston_pin", "made")
        left, right, film = drawing.axes
        found = {int(text.get_text()): np.array(text.xy) for text in left.texts if text.get_text().isdigit()}
        self.assertEqual(set(found), set(range(0, 720, 90)))
        for number, place in found.items():
            at = np.radians(number) / 2
            np.testing.assert_allclose(place, [0.6 * np.sin(at), 0.8 * np.cos(at)], atol=0.01)
        path = max(right.lines, key=lambda line: len(line.get_xdata()))   # the load turns by 20 degrees from row to row
        self.assertLess(np.hypot(*np.diff(path.get_xydata(), axis=0).T).max(), 0.02)
        numbers = [text.get_position() for text in left.texts if text.get_text().isdigit()]   # where they are written: outside, apart
        self.assertGreater(min(math.dist(a, b) for i, a in enumerate(numbers) for b in numbers[:i]), 0.15)
        self.assertGreater(min(math.hypot(*place) for place in numbers), 1.1)
        strokes = {line.get_label(): line.get_xydata() for line in left.lines if "°" in line.get_label()}
        self.assertEqual(list(strokes), ["0–180°", "180–360°", "360–540°", "540–720°"])
        second = strokes["180–360°"][~np.isnan(strokes["180–360°"][:, 0])]   # from (0.6, 0) to (0, -0.8), and nowhere else
        for end in ([0.6, 0], [0, -0.8]):
            self.assertLess(np.hypot(*(second - end).T).min(), 0.02)
        self.assertTrue((second[:, 1] < 0.02).all() and (second[:, 0] > -0.02).all())
        self.assertIn("load, 0.5 kN", [text.get_text() for text in left.texts])
        at, thickness = film.lines[0].get_data()
        np.testing.assert_allclose(thickness, 10 - np.hypot(8 * np.cos(np.radians(at) / 2), 6 * np.sin(np.radians(at) / 2)), atol=1e-6)
        self.assertTrue(drawing.get_suptitle().endswith(("thinnest film 2 µm of 10 µm, crank at 0.0°", "crank at 360.0°")), drawing.get_suptitle())   # by the rows
        made.summary.update(cycle_min_film_thickness=("1.98e-6", "m"), cycle_min_film_thickness_angle=("359.7", "deg"))
        between = bearing_pictures.orbit(made, "piston_pin", "made")
        self.assertIn("thinnest film 1.98 µm of 10 µm, crank at 359.7°", between.get_suptitle())   # by the summary, as the page has it
        (word,) = film.texts   # at the dot itself: a mark of a legend inside the axes would be a second one
        dots = [line for line in film.lines if line.get_marker() == "o"]
        self.assertEqual((word.get_text(), film.get_legend(), len(dots)), ("thinnest film", None, 1))
        self.assertEqual(list(word.xy), [float(values[0]) for values in dots[0].get_data()])
        drawing.canvas.draw()
        box, curve = word.get_window_extent(), film.transData.transform(film.lines[0].get_xydata())
        self.assertFalse(((curve > [box.x0, box.y0]) & (curve < [box.x1, box.y1])).all(axis=1).any())
        plt.close(drawing)
        plt.close(between)

    def test_each_bearing_has_a_picture_of_its_own(self) -> None:
        with tempfile.TemporaryDirectory() as work, contextlib.redirect_stdout(io.StringIO()) as said:
            subprocess.run([release_program(), "-q", "-o", work, TOP / "cases" / "bearings" / "car_diesel.nml"], check=True)
            for words in ((), ("--place", "crank_pin"), ("--place", "main_bearing")):
                self.assertEqual(cli.main(["bearing", f"{work}/car_diesel.csv", *words]), 0)
        self.assertEqual([Path(path).name for path in said.getvalue().splitlines()], [f"car_diesel_{what}orbit.png" for what in ("", "crank_pin_", "main_bearing_")])

    def test_a_missing_column_is_refused(self) -> None:
        with self.assertRaisesRegex(MissingResult, "no column film_thickness"):
            columns.draw([self.run], ["film_thickness"])

    def test_laws_show_the_rows_of_their_phase(self) -> None:
        ratio = np.linspace(0.5, 1.1, 7)
        phase = np.where(ratio > 1, 2, 1)
        made = run({"time": ratio, "phase": phase, "eccentricity_ratio": ratio, "film_thickness": 1e-5 * (1 - ratio),
                    "film_force_x": 3 * ratio, "film_force_y": 4 * ratio, "normal_force": 1e8 * np.maximum(ratio - 1, 0)})
        drawing = laws.draw([made])
        contact, film = (axes.lines[0].get_xydata() for axes in drawing.axes)
        np.testing.assert_allclose(contact, [[1.0, 1e7]], rtol=1e-9)
        np.testing.assert_allclose(film, np.column_stack([ratio, 5 * ratio])[phase == 1])
        plt.close(drawing)
        with self.assertRaisesRegex(MissingResult, "no row in contact and none in a film"):
            laws.draw([self.run])

    def test_every_command_has_a_module(self) -> None:
        there = {path.stem for path in (TOP / "scripts/python/src/gudgeon/commands").glob("*.py")} - {"__init__"}
        self.assertEqual(there, set(cli.WHAT))
        for what in cli.WHAT:
            self.assertIn(f"gudgeon-plot {what}", importlib.import_module(f"gudgeon.commands.{what}").__doc__)


class Page(unittest.TestCase):
    def test_thinning_keeps_peaks(self) -> None:
        values = np.sin(np.arange(100000) / 700)
        values[54321], values[777] = 9, -9
        rows = report_scene.chosen_rows([np.arange(100000.0), values], 2000)
        self.assertLessEqual(len(rows), 2002)
        self.assertTrue({0, 777, 54321, 99999} <= set(rows.tolist()))
        self.assertEqual(len(report_scene.chosen_rows([values[:2000]], 2000)), 2000)

    def test_thinning_keeps_the_last_cycle(self) -> None:
        """A page opens on the last cycle, of which a thousand others must leave more than some rows."""
        values = np.sin(np.arange(720000) * np.pi / 360)
        rows = report_scene.chosen_rows([np.arange(720000.0), values], 8000, (719280, 720000))
        self.assertEqual(np.count_nonzero(rows >= 719280), 720)
        self.assertLessEqual(len(rows), 8002)
        self.assertTrue(0 in rows and np.all(np.diff(rows) > 0))
        made = self.made()   # the rows of its last tenth
        time = made["time"]
        trace = pd.DataFrame({name: np.tile(column, 30) for name, column in made.trace.items()}).assign(time=np.arange(30 * len(time)) * time[1], cylinder_volume=1e-4, cylinder_pressure=1e5)
        made = replace(made, trace=trace)
        made.summary.update({"cycle_start": (str(29 * len(time) * time[1]), "s"), "cycle_duration": (str(len(time) * time[1]), "s"), "cycle_revolutions": ("1", "")})
        scene, data = report_scene.scene_of(made, most=2 * len(time) + 400)
        times = np.frombuffer(data["trace"], "<f4")[: scene["rows"]]
        self.assertGreaterEqual(np.count_nonzero(times >= scene["cycle"]["begin"] - time[1] / 2), len(time))
        self.assertTrue(all(plot["alone"] == (not plot["timed"]) for plot in scene["plots"]))   # lines between rows of other cycles are no curves

    def test_units_of_very_small_and_very_large_machines(self) -> None:
        for size, unit, factor, volume in ((1e-3, "N", 1.0, "cm³"), (1.0, "kN", 1e-3, "cm³"), (1e5, "MN", 1e-6, "l")):
            made = self.made()
            force = np.full(len(made["time"]), 0.5)
            force[0] = 2e3
            trace = made.trace.assign(pin_force_x=size * force, pin_force_y=0.0, cylinder_volume=size * 1e-7 * force, cylinder_pressure=1e5 * force)
            made = replace(made, trace=trace)
            drawn = {plot["title"]: plot for plot in report_curves.plots(report_curves.with_sizes(made), made)}
            plot = next(plot for plot in drawn.values() if plot["curves"][0]["y"] == "pin_force")
            self.assertEqual((plot["y"], plot["curves"][0]["y_factor"]), (unit, factor))
            self.assertEqual(drawn["p–V diagram"]["x"], f"cylinder volume [{volume}]")

    def made(self) -> Run:
        """A run with contact whose summary has larger extremes than its rows."""
        found = MadeResults()["sim_I_oscillating"]
        count = len(found["time"])
        trace = found.trace.assign(
            rod_angle=0.0, piston_position=0.2, phase=np.where(found["film_thickness"] < 0, 2, 1), energy_residual=1e-7 * found["time"],
        )
        case = found.case | {
            "mechanism": {"crank_length": 0.05, "rod_length": 0.2}, "initial": {"crank_speed": 250.0}, "lubrication": {}, "case": {},
        }
        summary = {
            "status": ("done", "-"), "min_film_thickness": ("-9e-6", "m"), "contacts": ("3", "1"), "compiler_options": ("-O3", ""),
        }
        self.assertEqual(len(trace), count)
        return Run(found.name, trace, {}, found.events, summary, case)

    def test_the_time_line_has_the_extremes_of_the_summary(self) -> None:
        made = self.made()
        self.assertGreater(made["film_thickness"].min(), -9e-6)
        line = report_scene.time_line(report_curves.with_sizes(made), made)
        self.assertEqual(line["range"], [-9e-6, made["film_thickness"].max()])
        self.assertEqual(line["extremes"], line["range"])

    def test_energy_residuals_have_plots_of_their_own(self) -> None:
        made = self.made()
        columns = report_curves.with_sizes(made)
        columns["ideal energy_residual"] = 3e4 * columns["energy_residual"]
        drawn = {plot["title"]: plot for plot in report_curves.plots(columns, made)}
        own, ideal = drawn["Energy residual"], drawn["Energy residual of the ideal joint's run"]
        self.assertEqual([len(plot["curves"]) for plot in (own, ideal)], [1, 1])
        self.assertEqual((own["y"], ideal["y"]), ("nJ", "µJ") if columns["energy_residual"].max() < 1e-6 else ("µJ", "mJ"))

    def test_orbits_are_coloured_by_contact(self) -> None:
        made = self.made()
        drawn = {plot["title"]: plot for plot in report_curves.plots(report_curves.with_sizes(made), made)}
        orbit = drawn["Pin orbit over the clearance"]
        self.assertEqual((orbit["phase"], orbit["x"]), ("phase", "<i>e<sub>y</sub></i> / <i>c</i>"))

    def test_the_page_has_the_notes_of_the_summary(self) -> None:
        """The words of the program stand on the page as they are, escaped, and not in the table of the summary again."""
        made = self.made()
        made.summary.update({"status": ("interrupted at 0.1 s", ""), "note_1": ("&joint clearance = 2 mm: usually 1 to 500 um", ""),
                             "note_2": ("a force < 1e9 N", "")})
        text = report_page.page(made)
        for said in ("&amp;joint clearance = 2 mm: usually 1 to 500 um", "a force &lt; 1e9 N", "The run did not end as requested: interrupted at"):
            self.assertEqual(text.count(f'<p class="warning">{said}'), 1, said)
        self.assertNotIn("note_1", text)
        self.assertNotIn("No warnings.", text)

    def test_no_warning_is_denied(self) -> None:
        """A motion that has not settled, and contacts that are too fast: both are told, and nothing says that there are no warnings."""
        for name, value, said in (("cycle_is_settled", "no", "The motion has not settled"),
                                  ("impacts_beyond_validity", "2", "2 of 3 contacts at the piston pin")):
            made = self.made()
            made.summary[name] = (value, "1")
            text = report_page.page(made)
            self.assertNotIn("No warnings.", text)
            self.assertEqual(text.count(f'<p class="warning">{said}'), 1)

    def test_the_page_opens_where_the_force_is_largest(self) -> None:
        columns = {"time": np.linspace(0, 1, 11), "pin_force": np.array([9.0, 0, 1, 2, 7, 3, 2, 1, 1, 1, 1])}
        self.assertAlmostEqual(report_scene.first_moment(columns), 0.4)  # the fall of the pin at the beginning is not counted

    def test_pages_in_both_languages(self) -> None:
        made, portuguese = self.made(), language.Language("pt")
        english, said = report_page.page(made), report_page.page(made, None, None, portuguese)
        self.assertEqual(portuguese.unknown, set())
        for text in (english, said):
            head = text.split("<script", 1)[0].replace("<wbr>", "")
            self.assertNotIn("[[", head)
            self.assertNotIn("{{", head)
            self.assertLess(head.index('<details id="summary">'), head.index("<td>contacts"))  # folded; what is of the program is in the last table
            self.assertLess(head.index("<td>contacts"), head.index('<details id="program">'))
            self.assertGreater(head.index("compiler_options"), head.index('<details id="program">'))
        self.assertIn('<html lang="pt">', said)
        self.assertIn("pino do pistão no mancal", said)
        self.assertNotIn("piston pin in its bearing", said.split("<script", 1)[0])

    def test_every_word_of_the_page_has_its_portuguese(self) -> None:
        portuguese = language.Language("pt")
        for text in [*report_page.script_words("drawing", "page", "explore"), *(title for _, title, *_ in (*report_curves.OVER_TIME, *report_curves.FIRST_OF_BEARINGS))]:
            portuguese.say(text)
        self.assertEqual(portuguese.unknown, set())
        self.assertGreater(len(report_page.script_words("drawing", "page", "explore")), 15)

    def test_the_case_has_what_differs_from_its_defaults_in_units_of_engineers(self) -> None:
        units: dict[str, str] = {}
        case = parse_case("&mechanism\n  crank_length = 0.045  ! m\n  crank_com = 0.0, 0.0  ! m\n  gravity = 9.80665  ! m/s^2\n/\n&drive\n  torque_table = ''\n/\n"
                          "&lubrication\n  place = 'crank_pin'\n  temperature = 383.15  ! K\n  report = .false.\n/\n&initial\n  crank_speed = 314.159265358979  ! rad/s\n"
                          "  crank_angle_deg = -20.0  ! degrees\n/\n&combustion\n  cycle = 'four_stroke'\n  intake_pressure = 190000.0  ! Pa\n/\n", units)
        made = Run("a", pd.DataFrame({"time": [0.0]}), {}, pd.DataFrame(), {}, case, units)
        known = {"mechanism.gravity": 9.80665, "mechanism.crank_com": 0.0, "combustion.cycle": "four_stroke", "drive.torque_table": "", "crank_pin.lubrication.report": False}
        of_engine = [("mechanism", [("crank_length", "45 mm")]), ("crank_pin.lubrication", [("temperature", "110 °C")]),
                     ("initial", [("crank_speed", "3000 rpm"), ("crank_angle_deg", "−20°")]), ("combustion", [("intake_pressure", "1.9 bar")])]
        self.assertEqual(case_rows(made, known), of_engine)
        of_engine[0][1].append(("gravity", "9.80665 m/s²"))   # without the library, which knows the defaults
        of_engine[3][1].insert(0, ("cycle", "four_stroke"))
        self.assertEqual(case_rows(made, None), of_engine)

    def test_the_case_in_portuguese(self) -> None:
        """Decimal commas, semicolons between numbers, sim for yes; titles, paths and words of keys are those of the case file."""
        case = parse_case("&case\n  title = 'Clearance 0.5 mm'\n/\n&mechanism\n  rod_com = 0.0105, 0.0  ! m\n/\n&output\n  ideal_twin = .true.\n/\n&drive\n  kind = 'free'\n"
                          "  torque_table = 'motor_2.5.csv'\n/\n", units := {})
        made = Run("a", pd.DataFrame({"time": [0.0]}), {}, pd.DataFrame(), {}, case, units)
        self.assertEqual(case_rows(made, None, language.Language("pt")),
                         [("case", [("title", "Clearance 0.5 mm")]), ("mechanism", [("rod_com", "10,5; 0 mm")]), ("output", [("ideal_twin", "sim")]),
                          ("drive", [("kind", "free"), ("torque_table", "motor_2.5.csv")])])
        found = self.made()
        found.summary["wall_time"] = ("0.25", "s")
        self.assertIn("<td>0,25</td>", report_page.page(found, None, None, language.Language("pt")))

    def test_packing_depends_on_the_data_only(self) -> None:
        self.assertEqual(report_page.packed(b"abc"), report_page.packed(b"abc"))


class Tradeoff(unittest.TestCase):
    def test_pareto_front_by_rising_cost(self) -> None:
        cost = [3, 1, 2, 2, 4, 5]
        error = [1e-3, 1e-1, 1e-2, 5e-3, 1e-3, 1e-6]
        self.assertEqual(tradeoff.pareto_front(cost, error), [1, 3, 0, 5])

    def test_pareto_front_keeps_one_of_equals_and_no_failures(self) -> None:
        self.assertEqual(tradeoff.pareto_front([1, 1, 0, np.nan], [2, 2, np.inf, 1]), [0])
        self.assertEqual(tradeoff.pareto_front([], []), [])

    def test_impacts_match_one_to_one(self) -> None:
        self.assertEqual(tradeoff.match_times([1, 2, 3], [1.1, 2.05, 2.9]), [(0, 0), (1, 1), (2, 2)])
        self.assertEqual(tradeoff.match_times([1, 2, 3], [1.0, 3.0]), [(0, 0), (2, 1)])  # one missed
        self.assertEqual(tradeoff.match_times([1, 2], [1.0, 1.1, 2.0]), [(0, 0), (1, 2)])  # one too many
        self.assertEqual(tradeoff.match_times([1, 2], [2.9]), [])  # too far from any
        self.assertEqual(tradeoff.match_times([], [1.0]), [])

    def test_impacts_beyond_the_horizon_are_left_out(self) -> None:
        self.assertEqual(tradeoff.match_times([1, 2, 3], [1, 2, 3], until=2.5), [(0, 0), (1, 1)])

    def test_state_error_is_in_shares_of_the_range_up_to_the_horizon(self) -> None:
        time = np.linspace(0, 1, 11)
        a = run({"time": time, "rod_angle": 4 * time, "crank_speed": np.ones(11)})
        b = run({"time": time, "rod_angle": 4 * time + 0.4 * time, "crank_speed": np.zeros(11)})
        self.assertAlmostEqual(tradeoff.state_error(a, b, 0.5), 0.05)
        self.assertAlmostEqual(tradeoff.state_error(a, b, 1.0), 0.1)
        short = run({"time": time[:5], "rod_angle": 4 * time[:5]})
        self.assertEqual(tradeoff.state_error(a, short, 1.0), np.inf)

    def test_reference_is_the_steadier_method(self) -> None:
        time = np.linspace(0, 1, 11)

        def off(by: float) -> Run:
            return run({"time": time, "rod_angle": time * (1 + by)})

        chosen = tradeoff.choose_reference(
            {"adams": off(0), "radau": off(3e-9)}, {"adams": off(1e-9), "radau": off(9e-9)}
        )
        self.assertEqual((chosen.horizon, chosen.whole), (1.0, True))
        self.assertAlmostEqual(chosen.error, 3e-9, delta=1e-15)

    def test_recommended_runs_miss_no_impact(self) -> None:
        table = pd.DataFrame(
            {
                "status": ["done", "done", "failed"],
                "state_error": [1e-4, 1e-4, 0.0],
                "impacts": [3, 3, 3],
                "impacts_matched": [2, 3, 3],
                "impacts_extra": [0, 0, 0],
                "seconds": [1.0, 2.0, 0.1],
            }
        )
        self.assertEqual(tradeoff.cheapest(table, 3)["seconds"], 2.0)
        self.assertIsNone(tradeoff.cheapest(table, 6))

    def test_the_picture_is_over_evaluations_alone(self) -> None:
        rows = 6
        table = pd.DataFrame(
            {
                "status": "done", "state_error": np.geomspace(1e-8, 1e-3, rows), "peak_force_error": np.geomspace(1e-7, 1e-2, rows),
                "evaluations": np.geomspace(1e5, 1e3, rows), "seconds": np.random.default_rng(1).random(rows), "method": "adams",
                "contact_entry": "root", "max_order": 12,
            }
        )
        reference = tradeoff.Reference(run({"time": [0.0, 1.0]}), 1.0, True, 1e-10)
        drawing = tradeoff.draw(table, reference, "x")
        self.assertEqual([axes.get_xlabel() for axes in drawing.axes], 2 * ["evaluations of the right-hand side"])
        for axes, error in zip(drawing.axes, ("state_error", "peak_force_error")):
            np.testing.assert_allclose(axes.collections[0].get_offsets()[:, 1], table[error])
        plt.close(drawing)

    def test_settings_are_known_again(self) -> None:
        settings = tradeoff.Settings("", "adams", 12, "step_rejection", 5e-7, 10.0**-9)
        row = pd.Series(vars(settings) | {"tolerance": 1e-9})
        self.assertEqual(tradeoff.settings_of(row).key, settings.key)


if __name__ == "__main__":
    outcome = unittest.main(exit=False).result
    wrong = len(outcome.failures) + len(outcome.errors)
    print(f"{outcome.testsRun - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)
