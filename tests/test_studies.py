#!/usr/bin/env python3
"""Tests of parameter studies outside the program: samples, sensitivity indices, numbers of the pictures, shipped studies.

    .venv/bin/python tests/test_studies.py      (after scripts/setup.sh --studies; brings the release build up to date)

Ends with the line "N passed, N failed".
"""

import io
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from contextlib import redirect_stderr
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "scripts" / "bench"))

from measured import use_virtual_environment

use_virtual_environment()

import matplotlib.colors
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon import (
    names,
    sensitivity,
    study,
)
from gudgeon._table import Unit
from gudgeon.commands import study as study_command
from gudgeon.plots import contact_laws as contact_study
from gudgeon.plots import maps as study_maps
from gudgeon.plots import restitution as restitution_study
from gudgeon.plots import strobes as study_strobes
from gudgeon.plots import studies as study_pictures
from gudgeon.program import release_program
from gudgeon.results import MissingResult
from gudgeon.sensitivity import Output
from gudgeon.study import Parameter, Runs
from scipy.integrate import solve_ivp

PLOT = (sys.executable, "-m", "gudgeon")
SNAKEMAKE = Path(sys.executable).with_name("snakemake")


class InDirectory(unittest.TestCase):
    """A test with a temporary folder."""

    def setUp(self) -> None:
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.work = Path(holder.name)

    def write(self, name: str, text: str) -> Path:
        path = self.work / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path


PI = [Parameter(f"x.{n}", -np.pi, np.pi) for n in range(1, 4)]


def ishigami(x: np.ndarray, a: float = 7.0, b: float = 0.1) -> np.ndarray:
    return np.sin(x[:, 0]) + a * np.sin(x[:, 1]) ** 2 + b * x[:, 2] ** 4 * np.sin(x[:, 0])


class Indices(unittest.TestCase):
    """The analysis of gudgeon-plot sensitivity, for functions with known indices."""

    #: Ishigami's function with a = 7, b = 0.1: V1 = (1 + b pi^4/5)^2 / 2, V2 = a^2/8, V13 = 8 b^2 pi^8 / 225.
    PARTS = np.array([0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49 / 8, 8 * 0.01 * np.pi**8 / 225])

    def check_ishigami(self, found: sensitivity.Indices) -> None:
        v1, v2, v13 = self.PARTS / self.PARTS.sum()
        for index, wanted in (("S1", [v1, v2, 0]), ("ST", [v1 + v13, v2, v13])):
            np.testing.assert_allclose(found.table[index], wanted, atol=0.03)
            inside = np.abs(found.table[index] - wanted) < 1.5 * found.table[f"{index}_conf"] + 1e-3
            self.assertTrue(inside.all(), found.table)
            self.assertTrue((found.table[f"{index}_conf"] < 0.15).all(), found.table)

    def test_sobol(self) -> None:
        x = sensitivity.sample("sobol", PI, 1024, 1)
        self.assertEqual(len(x), 1024 * sensitivity.block("sobol", 3))
        found = sensitivity.analyse("sobol", PI, x, ishigami(x), ("y", "m"), 1)
        self.check_ishigami(found)
        self.assertEqual((found.points, found.left_out), (1024, 0))
        self.assertEqual(list(found.ranked.index), ["x.1", "x.2", "x.3"])
        self.assertNotIn("no effect at all", sensitivity.describe(found))

    def test_failed_runs_leave_out_their_block_only(self) -> None:
        x = sensitivity.sample("sobol", PI, 1024, 1)
        y = ishigami(x)
        y[[7, 8, 100, 2000]] = np.nan  # rows 7 and 8 belong to one block of five
        found = sensitivity.analyse("sobol", PI, x, y, ("y", "m"), 1)
        self.assertEqual((found.points, found.left_out), (1021, 3))
        self.check_ishigami(found)
        self.assertIn("3 left out for runs without a value", sensitivity.describe(found))
        self.assertEqual({row["points_left_out"] for row in sensitivity.records(found)}, {3})
        found = sensitivity.analyse("sobol", PI, x, np.full(len(x), np.nan), ("y", "m"), 1)
        self.assertIn("too few", sensitivity.describe(found))

    def test_morris_of_a_linear_function(self) -> None:
        parameters = [Parameter("a.x", 0.0, 2.0), Parameter("a.y", 1e-6, 1e-4, log=True), Parameter("a.z", -1.0, 1.0)]
        sampled = sensitivity.sample("morris", parameters, 20, 3)
        values = sensitivity.values(parameters, sampled)
        result = 3.0 * values[:, 0] - 2.0 * np.log10(values[:, 1])
        found = sensitivity.analyse("morris", parameters, sampled, result, ("y", "m"), 3)
        np.testing.assert_allclose(found.table["mu"], [6.0, -4.0, 0.0], atol=1e-9)
        np.testing.assert_allclose(found.table["mu_star"], [6.0, 4.0, 0.0], atol=1e-9)
        np.testing.assert_allclose(found.table["sigma"], 0.0, atol=1e-9)
        self.assertEqual(sensitivity.prefixes("morris", 3, len(sampled)), [20, 40, 80])

    def test_what_does_not_vary_is_said(self) -> None:
        x = sensitivity.sample("sobol", PI, 8, 1)
        found = sensitivity.analyse("sobol", PI, x, np.full(len(x), 0.3), ("y", "m"), 1)
        self.assertTrue(found.constant)
        self.assertIn("0.3 in every run", sensitivity.describe(found))
        drawing = sensitivity.draw(
            [found, sensitivity.analyse("sobol", PI, x, ishigami(x), ("z", "m"), 1)], PI, "title"
        )
        self.assertEqual(drawing._suptitle.get_text(), "title\ny: 0.3 in every run")
        self.assertEqual(len(drawing.axes), 1)
        plt.close(drawing)

    def test_samples_repeat_by_seed_and_keep_the_ranges(self) -> None:
        parameters = [Parameter("a.x", 10e-6, 60e-6, log=True), Parameter("a.y", 0.5, 0.95)]
        for method in sensitivity.METHODS:
            first, again, other = (sensitivity.sample(method, parameters, 16, seed) for seed in (1, 1, 2))
            np.testing.assert_array_equal(first, again)
            self.assertTrue((first != other).any())
            values = sensitivity.values(parameters, first)
            self.assertTrue((values >= [10e-6, 0.5]).all() and (values <= [60e-6, 0.95]).all())

    def test_outputs(self) -> None:
        runs = Runs(pd.DataFrame({"run": [1, 2, 3], "status": ["done", "broke", "done"], "h": [1e-6, 1e-6, -1.0]}), {})
        np.testing.assert_array_equal(Output.parse("log:h").values(runs), [-6.0, np.nan, np.nan])
        np.testing.assert_array_equal(Output.parse("h").values(runs), [1e-6, np.nan, -1.0])
        self.assertEqual(runs.failures(), {"broke": 1})


class Files(InDirectory):
    """Reading of studies and results."""

    def test_ranges(self) -> None:
        path = self.write(
            "s.nml",
            "&study case = 'c.nml', settle_cycles = 2 /\n"
            "&parameter key = 'a.b', from = 1e-6, to = 2.0, scale = 'log' /\n"
            "&parameter key = 'a.c', from = 1, to = 3, count = 4 /\n",
        )
        found = study.read_study(path)
        self.assertEqual(found.parameters, (Parameter("a.b", 1e-6, 2.0, True), Parameter("a.c", 1.0, 3.0)))
        self.assertEqual(found.case, self.work / "c.nml")
        table = study.write_table_study(found, np.array([[1e-6, 1.0], [2.0, 3.0]]), self.work / "o", "t", "it's")
        text = (self.work / "o" / "t.csv").read_text(encoding="utf-8")
        self.assertEqual(text.splitlines()[0], "a.b,a.c")
        np.testing.assert_allclose(pd.read_csv(self.work / "o" / "t.csv"), [[1e-6, 1.0], [2.0, 3.0]], rtol=1e-12)
        self.assertIn("settle_cycles = 2", table.read_text(encoding="utf-8"))

    def test_ranges_with_units(self) -> None:
        found = study.read_study(self.write(
            "s.nml", "&study case = 'c.nml' / &parameter key = 'a.b', from = 20 um, to = '60 um' / &parameter key = 'a.c', from = 1d0, to = 3 /\n"))
        self.assertEqual(found.parameters, (Parameter("a.b", 20.0, 60.0, unit="um"), Parameter("a.c", 1.0, 3.0)))
        study.write_table_study(found, np.array([[20.0, 1.0]]), self.work / "o", "t", "")
        self.assertEqual(self.ranges("from = 60 rad/s, to = 1d2 rad/s count = 5 / as long as the bench allows"), ("60 rad/s", "100 rad/s"))
        self.assertEqual(self.ranges("\n from = 1 N m s/rad ! least\n to = 2 N m s/rad\n/"), ("1 N m s/rad", "2 N m s/rad"))
        self.assertEqual(self.ranges("from = 2 J/(kg K), to = 3 J/(kg K), count = 2/"), ("2 J/(kg K)", "3 J/(kg K)"))
        cell, plain = (self.work / "o" / "t.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
        self.assertEqual((float(cell.removesuffix(" um")), float(plain)), (20.0, 1.0))

    def ranges(self, keys: str) -> tuple[str, str]:
        found = study.read_study(self.write("s.nml", f"&study case = 'a/from = 7' / &parameter key = 'a.b' {keys}\n")).parameters[0]
        return f"{found.low:.15g} {found.unit}", f"{found.high:.15g} {found.unit}"

    def test_what_is_no_range_is_refused(self) -> None:
        for text in (
            "&study case = 'c' / &parameter key = 'a.b', from = 20 um, to = 0.1 mm /",
            "&study case = 'c' / &parameter key = 'a.b', from = 'many', to = 2 /",
            "&study case = 'c' /",
            "&parameter key = 'a.b', from = 1, to = 2 /",
            "&study case = 'c' / &parameter key = 'a.b', values = 1, 2 /",
            "&study case = 'c' / &parameter key = 'a.b', from = 2, to = 1 /",
            "&study case = 'c' / &parameter key = 'a.b', from = 0, to = 1, scale = 'log' /",
        ):
            with self.assertRaises(MissingResult):
                study.read_study(self.write("s.nml", text + "\n"))

    def test_apostrophes_before_formulas_are_taken_away(self) -> None:
        path = self.write(
            "s.runs.csv", "run,case.title,status,x[m]\n1,'=1+1,done,-1\n2,''-a,done,2\n3,'a',\"'@x, y\",\n4,,done,3\n"
        )
        runs = Runs.read(path)
        self.assertEqual(list(runs.table["case.title"][:3]), ["=1+1", "'-a", "'a'"])
        self.assertTrue(pd.isna(runs["case.title"][3]))
        self.assertEqual(runs.table["status"][2], "@x, y")
        np.testing.assert_array_equal(runs["x"], [-1.0, 2.0, np.nan, 3.0])

    def test_results_with_missing_runs_are_refused(self) -> None:
        path = self.write("s.runs.csv", "run,a.b,status,x[m]\n1,1,done,1\n3,1,done,1\n")
        with self.assertRaisesRegex(MissingResult, "missing"):
            Runs.read(path)


class Pictures(InDirectory):
    """The numbers of gudgeon-plot study."""

    def test_period(self) -> None:
        def period(*values: float) -> int:
            return study_strobes.period(np.array(values)[:, None], 1e-3)

        self.assertEqual(period(*[1.0, 1.0005] * 4), 1)
        self.assertEqual(period(*[1.0, 2.0] * 4), 2)
        self.assertEqual(period(*[1.0, 2.0, 3.0] * 4), 3)
        self.assertEqual(period(*np.sin(np.arange(40.0) ** 2)), 0)
        self.assertEqual(period(1.0), 0)

    def test_bifurcation_in_words(self) -> None:
        rows = []
        for run, (value, points) in enumerate(((1.0, [0.1] * 6), (2.0, [0.1, 0.2] * 3), (3.0, [1, 5, 2, 8, 3, 9]))):
            rows += [{"run": run, "a": value, "eccentricity_ratio_y": point} for point in points]
        text = study_strobes.describe_bifurcation(pd.DataFrame(rows), "x", "a", 10.0, "m")
        self.assertIn("of 3 values from 10 to 30 m 1 repeat every revolution, 1 after 2 to 8, 1 do not", text)
        self.assertIn("that repeat lie from 10 to 20; those that do not lie from 30 to 30", text)

    def test_bifurcation_coloured_by_the_exponent(self) -> None:
        rows = [
            {"run": run, "joint.clearance": value, "eccentricity_y": point * value, "piston_velocity": point, "lyapunov_exponent": exponent}
            for run, (value, exponent) in enumerate(((1e-5, -2.0), (2e-5, -0.1), (4e-5, 0.3)))
            for point in (0.1, 0.2, 0.3)
        ]
        strobe = study_strobes.with_ratios(pd.DataFrame(rows), None, 100.0)
        drawing = study_strobes.draw_bifurcation({"one": (strobe, "joint.clearance", "held")}, "title")
        panels = [axis for axis in drawing.axes if axis.collections and axis.get_label() != "<colorbar>"]
        self.assertEqual(len(panels), 2)
        for axis in panels:
            (points,) = axis.collections
            np.testing.assert_array_equal(points.get_array(), strobe["lyapunov_exponent"])
            grey = points.to_rgba(np.linspace(-1, 1, 9))[:, :3] @ (0.299, 0.587, 0.114)   # as a printer without colours does it
            self.assertTrue((np.diff(grey) > 0.02).all() and grey[-1] - grey[0] > 0.5, grey)
        labels = [axis.get_xlabel() for axis in drawing.axes if axis.get_label() == "<colorbar>"]
        self.assertEqual(labels, ["Lyapunov exponent [1/revolution]: below 0 the motion repeats, above it is chaotic"])
        plt.close(drawing)
        plain = strobe.drop(columns="lyapunov_exponent")
        drawing = study_strobes.draw_bifurcation({"one": (plain, "joint.clearance", "held")}, "title")
        self.assertFalse([axis for axis in drawing.axes if axis.get_label() == "<colorbar>"])
        plt.close(drawing)

    def test_restitution_of_the_law(self) -> None:
        for nominal in (0.0, 0.4, 0.9):
            q = 0.75 * (1 - nominal**2)

            def motion(_: float, state: np.ndarray, q: float = q) -> list[float]:
                depth, speed = state
                return [speed, -(max(depth, 0.0) ** 1.5) * (1 + q * speed)]

            def out(_: float, state: np.ndarray) -> float:
                return state[0] if state[1] < 0 else 1.0

            out.terminal = True
            found = solve_ivp(motion, (0, 20), [0.0, 1.0], events=out, rtol=1e-9, atol=1e-12)
            self.assertAlmostEqual(restitution_study.restitution_of_law(nominal), -found.y[1][-1], places=5)
        self.assertEqual(restitution_study.restitution_of_law(1.0), 1.0)

    def test_measured_restitution(self) -> None:
        rows = ["time[s],crank_angle[rad],event,normal_speed[m/s],duration[s],max_penetration[m],max_normal_force[N]"]
        for angle, before, after in ((1, 9.0, 9.0), (20, 2.0, -1.0), (21, 0.9, -0.9), (22, 1.5, -0.9), (23, 1.2, None)):
            rows.append(f"0.1,{angle},contact_begins,{before},,,")
            rows += [f"0.2,{angle},contact_ends,{after},0.1,1e-6,10"] if after else []
        self.write("r/1.events.csv", "\n".join(rows) + "\n")
        runs = Runs(pd.DataFrame({"run": [1], "contact.restitution": [0.7]}), {})
        found = restitution_study.measured_restitution(self.work / "r", runs, settled_from=6.28).iloc[0]
        self.assertEqual(found["count"], 2)  # without the first impact, which is not settled, the slow one, and the last
        self.assertAlmostEqual(found["middle"], 0.55)

    def test_contact_laws(self) -> None:
        """Means and scatter over the laws with a restitution, the other laws separately; a failed run is left out."""
        rows = []
        for law, force in (("hertz", 9e4), ("exact", 2e4), ("flores", 4e4), ("gonthier", 1e6)):
            for restitution in (0.9, 0.5):
                row = {"contact.law": law, "contact.geometry": "johnson", "contact.restitution": restitution}
                row |= {"status": "no" if law == "gonthier" else "done", "contact_time_fraction": 0.5}
                rows.append(row | {"max_pin_force_mean": force * restitution, "dissipated_energy": 0.25})
        runs = Runs(pd.DataFrame(rows), {})
        text = contact_study.describe_contact_laws(runs)
        self.assertIn("6 of 8 runs done", text)
        self.assertIn("  johnson, 0.9: 27 ± 9 kN, 50 ± 0 %, 0.25 ± 0 J", text)
        self.assertIn("  johnson, 0.5: 15 ± 5 kN", text)
        self.assertEqual(text.count("johnson, hertz: 81 kN"), 1)
        drawing = contact_study.draw_contact_laws(runs)
        panels = [axis for axis in drawing.axes if axis.get_title("left")]
        self.assertEqual([axis.get_title("left") for axis in panels], ["restitution 0.9 asked for", "restitution 0.5 asked for"])
        points = [line.get_xydata() for line in panels[0].lines if line.get_label() == "johnson"]
        np.testing.assert_allclose(points[0], [[18.0, 0], [36.0, 1]])
        self.assertIn("hertz: 45 to 81 kN, 50 to 50 % in contact, 0 J", [axis.get_title("right") for axis in drawing.axes])
        plt.close(drawing)

    def test_maps(self) -> None:
        table = pd.DataFrame(
            {"run": range(1, 5), "a": [1, 1, 2, 2], "b": [5, 6, 5, 6], "status": 3 * ["done"] + ["no"]}
        )
        x, y, z = study_maps.grid(Runs(table.assign(h=[1.0, 2.0, 3.0, 4.0]), {}), "a", "b", "h")
        np.testing.assert_array_equal([*x, *y], [1, 2, 5, 6])
        np.testing.assert_array_equal(z, [[1.0, 3.0], [2.0, np.nan]])


class AnyStudy(InDirectory):
    """Pictures of any study."""

    UNITS = {"joint.clearance": "m", "initial.crank_speed": "rad/s"}

    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(plt.close, "all")
        patch = unittest.mock.patch.object(names, "key_units", lambda: self.UNITS)
        patch.start()
        self.addCleanup(patch.stop)

    def grid_runs(self) -> Runs:
        """Film thicknesses over three decades, on a grid with logarithmic spacing; one run failed; no contact."""
        clearance, speed = np.meshgrid(np.geomspace(1e-5, 1e-4, 10), np.geomspace(50, 1000, 9))
        film = 1e-5 * (clearance.ravel() / 1e-5) ** -2 * (speed.ravel() / 50) ** -1
        table = pd.DataFrame({"run": np.arange(1, 91), "joint.clearance": clearance.ravel(), "initial.crank_speed": speed.ravel()})
        table = table.assign(status="done", min_film_thickness=film, contact_time_fraction=0.0, max_pin_force=film * 1e8)
        table.loc[7, ["status", "min_film_thickness", "contact_time_fraction", "max_pin_force"]] = ["stopped", np.nan, np.nan, np.nan]
        return Runs(table, {"min_film_thickness": "m", "contact_time_fraction": "-", "max_pin_force": "N"})

    def test_maps_of_grids_that_are_even_in_their_logarithm(self) -> None:
        columns = ("min_film_thickness", "contact_time_fraction", "max_pin_force")
        drawing = study_maps.draw_map(self.grid_runs(), "joint.clearance", "initial.crank_speed", columns, "films")
        panels = [axes for axes in drawing.axes if axes.get_xlabel() == "radial clearance [µm]"]
        self.assertEqual(len(panels), 2)  # a column that is equal in every run is in the title and has no panel
        self.assertEqual(drawing._suptitle.get_text(), "films; 1 of 90 runs failed (×)\ntime in contact: 0 % in every run")
        for axes in panels:
            self.assertEqual((axes.get_xscale(), axes.get_yscale(), axes.get_ylabel()), ("log", "log", "crank speed [rad/s]"))
            self.assertIsInstance(axes.collections[0].norm, matplotlib.colors.LogNorm)
            self.assertEqual(len(axes.lines[0].get_xdata()), 1)  # the cross of the run that failed
        bars = {axes.get_xlabel() for axes in drawing.axes} - {"radial clearance [µm]"}
        self.assertEqual(bars, {"smallest film thickness [µm]", "largest pin force [kN]"})

    def test_the_shipped_maps_share_their_scales(self) -> None:
        runs = self.grid_runs()
        for name in study_command.MAPS:
            runs.table.rename(columns=lambda one: f"{one}[{runs.units.get(one, '')}]" if one in runs.units else one).to_csv(self.work / f"{name}.runs.csv", index=False)
        with redirect_stderr(io.StringIO()):
            drawing, lines = study_command.maps(self.work)
        self.assertEqual((len(lines), len(drawing.axes)), (4, 6))
        scales = [axes.collections[0].norm for axes in drawing.axes[:4]]
        self.assertEqual([(one.vmin, one.vmax) for one in scales[:2]], [(one.vmin, one.vmax) for one in scales[2:]])

    def test_small_maps_are_tables_with_numbers(self) -> None:
        runs = self.grid_runs()
        few = runs.table["joint.clearance"].isin(sorted(set(runs.table["joint.clearance"]))[:4]) & (runs.table["initial.crank_speed"] < 120)
        small = Runs(runs.table[few].reset_index(drop=True), runs.units)
        drawing = study_maps.draw_map(small, "joint.clearance", "initial.crank_speed", ["min_film_thickness"], "films")
        (axes,) = drawing.axes
        shown = [text.get_text() for text in axes.texts]
        self.assertEqual((len(shown), len(axes.get_xticks()), axes.get_title()), (len(small.table), 4, "smallest film thickness [µm]"))
        self.assertEqual((shown[0], axes.get_xticklabels()[0].get_text()), ("10", "10"))
        most = small.table.loc[small.table["min_film_thickness"].astype(float).idxmax()]
        found = f"up to {1e6 * most['min_film_thickness']:.3g} µm, at {1e6 * most['joint.clearance']:.3g} µm and {most['initial.crank_speed']:.3g} rad/s"
        self.assertEqual(drawing.get_suptitle(), f"films: {found}")
        failed = Runs(small.table.assign(status="failed"), small.units)
        drawing = study_maps.draw_map(failed, "joint.clearance", "initial.crank_speed", ["min_film_thickness"], "films")
        self.assertIn("runs failed", drawing.get_suptitle())
        self.assertNotIn("up to", drawing.get_suptitle())

    def test_colours_say_what_lies_beyond_them(self) -> None:
        values = np.concatenate([np.linspace(1, 2, 400), [50.0]])
        norm, extend = study_maps.colour_scale(values)
        self.assertEqual(extend, "both")
        self.assertLess(norm.vmax, 2.1)
        norm, extend = study_maps.colour_scale(np.linspace(1, 2, 400))
        self.assertEqual((norm.vmin, norm.vmax, extend), (1, 2, "neither"))

    def test_curves(self) -> None:
        table = pd.DataFrame({"run": [1, 2, 3], "initial.crank_speed": [100.0, 200.0, 300.0], "status": ["done", "stopped", "done"]})
        runs = Runs(table.assign(min_film_thickness=[-1e-6, np.nan, -3e-6]), {"min_film_thickness": "m"})
        drawing = study_pictures.draw_curves(runs, "initial.crank_speed", ["min_film_thickness"], "deep")
        axes = drawing.axes[0]
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("crank speed [rad/s]", "largest penetration [µm]"))
        np.testing.assert_allclose(axes.lines[0].get_ydata(), [1, np.nan, 3])
        np.testing.assert_allclose(axes.lines[1].get_xdata(), [200])
        self.assertIn("1 of 3 runs failed", drawing._suptitle.get_text())

    def test_samples_are_points_over_each_parameter(self) -> None:
        runs = self.grid_runs()
        runs.table["joint.clearance"] = np.random.default_rng(1).permutation(np.linspace(1e-5, 2e-5, 90))
        self.assertFalse(study_maps.is_grid(runs, "joint.clearance", "initial.crank_speed"))
        drawing = study_pictures.draw_scatter(runs, ["joint.clearance", "initial.crank_speed"], ["min_film_thickness"], "x")
        self.assertEqual(len(drawing.axes), 2)
        self.assertEqual(drawing.axes[0].get_yscale(), "log")

    def test_units_take_the_prefix_of_their_largest_value(self) -> None:
        for unit, largest, wanted in (("m", 2e-4, "µm"), ("m", 0.05, "mm"), ("N", 2e4, "kN"), ("Pa", 3e8, "MPa"), ("rad/s", 1e3, "rad/s")):
            shown, factor = names.prefixed(unit, np.array([0.1, 1.0]) * largest)
            self.assertEqual(shown, wanted)
            self.assertTrue(1 <= factor * largest <= 1000, (unit, factor))

    def test_every_parameter_of_the_shipped_studies_has_its_unit(self) -> None:
        unittest.mock.patch.stopall()
        units = names.key_units()
        self.assertEqual(units["joint.clearance"], "m")
        self.assertEqual(units["lubrication.viscosity"], "Pa s")
        self.assertEqual(units["initial.crank_speed"], "rad/s")
        self.assertEqual(units["contact.restitution"], "")
        self.assertEqual(names.of_parameter("lubrication.viscosity", np.array([0.004, 0.04])).label, "viscosity [mPa s]")
        warm = names.of_parameter("lubrication.temperature", np.array([313.15, 353.15]))
        self.assertEqual((warm.label, *np.round(warm(np.array([313.15, 353.15])), 9)), ("temperature [°C]", 40.0, 80.0))
        self.assertEqual(names.of_column("gas_temperature_mean", "K", np.array([300.0])).unit, "°C")
        for ending in ("rms", "range", "difference"):   # those of °C would be others
            self.assertEqual(names.of_column(f"gas_temperature_{ending}", "K", np.array([30.0])).unit, "K")
            self.assertEqual(Unit.of(f"gas_temperature_{ending}", "K", [30.0]).name, "K")
        self.assertEqual(Unit.of("gas_temperature_mean", "K", [300.0])(300.0), 300.0 - 273.15)
        self.assertEqual(names.of_parameter("guide.piston_com[2]", np.array([-7e-4, 7e-4])).label, "piston com[2] [µm]")   # one number of a list


class Sweeps(InDirectory):
    """Tests that run the program."""

    STUDY = """&study
  title = 'small', case = '{case}', settle_cycles = 1, cycles = .true.
  strobe_angle_deg = 90.0, strobe_columns = 'eccentricity_x,film_thickness'
/
&parameter key = 'joint.clearance', from = 10.0e-6, to = 40.0e-6, count = 3 /
&parameter key = 'initial.crank_speed', from = 100.0, to = 400.0, count = 3, scale = 'log' /
"""

    def setUp(self) -> None:
        super().setUp()
        self.program = release_program()
        self.study = self.write(
            "small.nml", self.STUDY.format(case=TOP / "cases" / "studies" / "base" / "sim_I_driven.nml")
        )

    def run_program(self, *words: object) -> subprocess.CompletedProcess:
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, cwd=TOP)

    def test_shipped_studies_are_correct(self) -> None:
        studies = sorted((TOP / "cases" / "studies").glob("*.nml"))
        self.assertGreater(len(studies), 8)
        outcome = self.run_program(self.program, "sweep", "--check", *studies)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)

    def test_texts_come_back_as_they_were_written(self) -> None:
        titles = ["=1+1", "-a, b", "'=x", "''@y", "plain", "it's", "+", "-5"]
        base = TOP / "cases" / "studies" / "base" / "sim_I_driven.nml"
        study_file = self.write("titles.nml", f"&study case = '{base}', table = 'titles.csv' /\n")
        table = pd.DataFrame({"case.title": titles, "integrator.revolutions": 2})
        # a table is read like results: a text that is to begin with an apostrophe and a formula character needs one more apostrophe
        table["case.title"] = [f"'{title}" if title.startswith("'") else title for title in titles]
        table.to_csv(self.work / "titles.csv", index=False)
        outcome = self.run_program(self.program, "sweep", "-q", "-o", self.work, study_file)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        found = Runs.read(self.work / "titles.runs.csv")
        self.assertEqual([str(title) for title in found["case.title"]], titles)
        again = self.work / "again.csv"  # the column of the results can be used as a table
        pd.read_csv(self.work / "titles.runs.csv", dtype=str)[["case.title", "integrator.revolutions"]].to_csv(
            again, index=False
        )
        study_file = self.write("again.nml", f"&study case = '{base}', table = 'again.csv' /\n")
        outcome = self.run_program(self.program, "sweep", "-q", "-o", self.work, study_file)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        one, other = ((self.work / f"{name}.runs.csv").read_bytes() for name in ("titles", "again"))
        self.assertEqual(one, other)

    def test_samples(self) -> None:
        ranges = TOP / "cases" / "studies" / "sensitivity_I.nml"
        for design in ("sobol", "latin_hypercube"):
            command = (*PLOT, "sample", ranges, "--runs", 64, "--design", design, "-o", self.work)
            outcome = self.run_program(*command)
            self.assertEqual(outcome.returncode, 0, outcome.stderr)
            table = (self.work / f"sensitivity_I.{design}.csv").read_bytes()
            values = pd.read_csv(io.BytesIO(table))
            for parameter in study.read_study(ranges).parameters:  # one point in each of the equal parts of each range
                low, high = parameter.bounds
                sampled = np.log(values[parameter.key]) if parameter.log else values[parameter.key]
                self.assertEqual(sorted((64 * (sampled - low) / (high - low)).astype(int)), list(range(64)), (design, parameter.key))
            self.run_program(*command)
            self.assertEqual(table, (self.work / f"sensitivity_I.{design}.csv").read_bytes(), "the same seed, the same points")
            self.run_program(*command, "--seed", 2)
            self.assertNotEqual(table, (self.work / f"sensitivity_I.{design}.csv").read_bytes(), "another seed, other points")
            outcome = self.run_program(self.program, "sweep", "--check", self.work / f"sensitivity_I.{design}.nml")
            self.assertIn("correct, 64 runs", outcome.stdout)

    @unittest.skipIf(sys.version_info < (3, 11), "Snakemake needs Python 3.11")
    def test_snakemake_writes_what_one_process_writes(self) -> None:
        options = "--set integrator.revolutions=2"
        out = self.work / "cluster"
        settings = (f"study={self.study}", f"out={out}", "chunk=4", f"program={self.program}", f"options={options}")
        outcome = self.run_program(
            *("env", f"XDG_CACHE_HOME={self.work}"),   # which Snakemake needs, also where nothing can be written to the home folder
            *(SNAKEMAKE, "--snakefile", TOP / "scripts" / "cluster" / "Snakefile"),
            *("--directory", self.work, "--cores", 2, "--config", *settings),
        )
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        outcome = self.run_program(self.program, "sweep", "-q", "-o", self.work, *options.split(), self.study)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        for kind in ("runs", "cycles", "strobe"):
            one, merged = ((where / f"small.{kind}.csv").read_bytes() for where in (self.work, out))
            self.assertEqual(one, merged, kind)
            self.assertGreater(one.count(b"\n"), 9)

    def test_table_of_indices(self) -> None:
        head = "method,output,parameter,index,value,confidence,points,points_left_out"
        rows = ["sobol,y,joint.clearance,ST,0.333,0.0714,8,0", "sobol,y,joint.clearance,S1,0.1,0.2,8,0"]
        shipped = TOP / "cases" / "studies"
        (self.work / "sensitivity_I.indices.csv").write_text("\n".join([head, *rows]) + "\n")
        rows = ["sobol,z,joint.clearance,ST,0.5,0.1,8,0", "sobol,z,mechanism.gravity,ST,0.21,0.14,8,0"]
        (self.work / "sensitivity_IV.indices.csv").write_text("\n".join([head, *rows]) + "\n")
        outcome = self.run_program(
            *(*PLOT, "sensitivity", "--table", "--out", self.work),
            *(shipped / "sensitivity_I.nml", shipped / "sensitivity_IV.nml"),
        )
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        for line in (
            "| parameter | I: y | IV: z |",
            "| `joint.clearance` | 0.33 ± 0.07 | 0.50 ± 0.10 |",
            "| `mechanism.gravity` | not varied | 0.21 ± 0.14 |",
        ):
            self.assertIn(line, outcome.stdout)

    def test_sensitivity_of_a_small_study(self) -> None:
        outcome = self.run_program(
            *(*PLOT, "sensitivity", self.study, "--program", self.program),
            *(
                "--method",
                "morris",
                "--morris",
                3,
                "--out",
                self.work,
                "--outputs",
                "log:min_film_thickness",
                "impacts",
            ),
            *("--set", "integrator.revolutions=2"),
        )
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        found = pd.read_csv(self.work / "small.indices.csv")
        thinner = found[(found["output"] == "log10 min_film_thickness") & (found["index"] == "mu")]
        self.assertEqual(list(thinner["parameter"]), ["joint.clearance", "initial.crank_speed"])
        self.assertTrue(
            (thinner["value"] < -0.1).all(), thinner
        )  # the film is thinner with larger clearance and with higher speed
        self.assertIn("impacts, morris (3 trajectories): 0 in every run", outcome.stdout)
        self.assertTrue((self.work / "small.png").stat().st_size > 10_000)


if __name__ == "__main__":
    with redirect_stderr(io.StringIO()) as log:
        result = unittest.main(exit=False, verbosity=0).result
    wrong = len(result.failures) + len(result.errors)
    if wrong:
        print(log.getvalue())
    for test, reason in result.skipped:
        print(f"skipped: {test}: {reason}")
    print(f"{result.testsRun - wrong - len(result.skipped)} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)
