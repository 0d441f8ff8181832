#!/usr/bin/env python3
"""Films of finite length in whole runs: their tables in the cache and in files, their pressure fields, and whole mechanisms against
independent programs.

    tests/test_film_tables.py

Builds the fast program. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import csv
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from test_faults import wait_for

TOP = Path(__file__).resolve().parent.parent
REFERENCES = TOP / "data" / "film" / "models"
CASE = TOP / "cases" / "film" / "sim_I_finite.nml"
SMALL = ["-s", "lubrication.table_points=33", "-s", "lubrication.film_points=64", "-s", "integrator.revolutions=1"]


def build() -> Path:
    done = subprocess.run([TOP / "scripts" / "build.sh"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"test_film_tables: {done.stderr}")
    return TOP / done.stdout.strip()


def columns(path: Path) -> dict[str, list[float]]:
    with path.open() as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) if row[i] else float("nan") for row in rows[1:]] for i, name in enumerate(rows[0])}


class Cache(unittest.TestCase):
    """A table is computed once, stored completely or not at all, and checked when it is read."""

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.cache = self.folder / "cache"

    def run_case(self, name: str, *options: str, **changed: str) -> tuple[subprocess.CompletedProcess, bytes]:
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.cache), **changed}
        done = subprocess.run([GUDGEON, "-q", "-o", self.folder / name, *SMALL, *options, CASE], env=environment,
                              capture_output=True, text=True, check=False)
        trace = self.folder / name / "sim_I_finite.csv"
        return done, trace.read_bytes() if trace.exists() else b""

    def test_kept_and_checked(self) -> None:
        done, first = self.run_case("first")
        self.assertEqual(done.returncode, 0, done.stderr)
        tables = list((self.cache / "gudgeon").iterdir())
        self.assertEqual([table.suffix for table in tables], [".table"], "one table and no incomplete file")
        whole = tables[0].read_bytes()
        written = tables[0].stat().st_mtime_ns
        _, again = self.run_case("again")
        self.assertEqual(first, again, "a table from the cache gives the same run")
        self.assertEqual(tables[0].stat().st_mtime_ns, written, "a table in the cache is not computed again")
        for what, bytes_there in (("truncated", whole[: len(whole) // 2]), ("changed", whole[:5000] + b"?" + whole[5001:]),
                                  ("empty", b""), ("foreign", b"x" * len(whole))):
            with self.subTest(what):
                tables[0].write_bytes(bytes_there)
                done, remade = self.run_case(what)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(first, remade, f"a {what} table is computed again")
                self.assertEqual(tables[0].read_bytes(), whole, f"a {what} table is replaced")

    @unittest.skipIf("LD_PRELOAD" in os.environ, "builds call different functions of those that are rounded otherwise")
    def test_same_bits_of_all_builds(self) -> None:
        """The program with all checks of the compiler makes the same table and the same trace as the released one. One whose elementary
        functions round otherwise, as on another processor, keeps a table of its own."""
        found = subprocess.run(["fpm", "@strict", "--target", "runs", "--runner", "echo"], cwd=TOP, capture_output=True, text=True, check=True)
        strict = TOP / found.stdout.strip().splitlines()[-1].replace("/test/runs", "/app/gudgeon")
        traces, tables = [], []
        for name, program in (("released", GUDGEON), ("strict", strict)):
            subprocess.run([program, "-q", "-o", self.folder / name, *SMALL, "-s", "output.digits=17", CASE], check=True,
                           env={**os.environ, "XDG_CACHE_HOME": str(self.folder / f"cache of {name}")})
            traces.append((self.folder / name / "sim_I_finite.csv").read_bytes())
            tables.append({table.name: table.read_bytes() for table in (self.folder / f"cache of {name}" / "gudgeon").iterdir()})
        self.assertEqual(tables[0], tables[1])
        self.assertEqual(traces[0], traces[1])
        rounding = self.folder / "rounding.so"
        subprocess.run(["cc", "-O1", "-fno-builtin", "-shared", "-fPIC", "-o", rounding, TOP / "tests" / "rounding.c", "-ldl", "-lm"], check=True)
        self.run_case("here")
        here = set((self.cache / "gudgeon").iterdir())
        self.run_case("elsewhere", LD_PRELOAD=str(rounding))
        self.assertEqual(len(set((self.cache / "gudgeon").iterdir()) - here), 1, "a program that rounds otherwise has its own table")

    def test_stated_error(self) -> None:
        """The summary states the error of the table, also of one from the cache; a smaller table has a larger error. Without a
        table there is no such line."""

        def stated(name: str, *options: str) -> list[float]:
            done, _ = self.run_case(name, "-s", "lubrication.cavitation=gumbel", *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            with (self.folder / name / "sim_I_finite.summary.csv").open() as file:
                rows = {row["quantity"]: (row["value"], row["unit"]) for row in csv.DictReader(file)}
            self.assertTrue(all(unit == "1" for name, (_, unit) in rows.items() if name in ("film_table_error", "film_table_mean_error")))
            return [float(rows[name][0]) for name in ("film_table_error", "film_table_mean_error") if name in rows]

        made, kept, small = stated("made"), stated("kept"), stated("small", "-s", "lubrication.table_points=17")
        self.assertEqual(made, kept)
        self.assertEqual(len(made), 2)
        self.assertTrue(0 < made[1] < made[0] < 0.03, made)
        self.assertGreater(small[0], 3 * made[0])
        self.assertEqual(stated("short", "-s", "lubrication.variant=short"), [])

    def test_announced(self) -> None:
        """A table that is computed is announced in one line, also off a terminal, unless the user wants errors only. Its time is in
        the summary."""

        def said(name: str, *options: str) -> tuple[list[str], float]:
            done = subprocess.run([GUDGEON, *options, "-o", self.folder / name, *SMALL, CASE], capture_output=True, text=True,
                                  check=True, env={**os.environ, "XDG_CACHE_HOME": str(self.cache)})
            with (self.folder / name / "sim_I_finite.summary.csv").open() as file:
                rows = {row["quantity"]: row for row in csv.DictReader(file)}
            self.assertEqual(rows["film_table_time"]["unit"], "s")
            return [line for line in done.stderr.splitlines() if "film table" in line], float(rows["film_table_time"]["value"])

        lines, computed = said("first")
        self.assertEqual(len(lines), 1, lines)
        self.assertIn(str(self.cache), lines[0], "it says where the table is kept")
        lines, read = said("again")
        self.assertEqual(lines, [], "a table from the cache is not announced")
        self.assertLess(0.0, read)
        self.assertLess(read, computed)
        shutil.rmtree(self.cache)
        self.assertEqual(said("quiet", "--quiet")[0], [])

    def test_certificate(self) -> None:
        """The runs for a certificate have the next finer table: that of their own tolerance if it is finer."""
        for tolerance, wanted in (("1e-4", ["33 64", "97 128"]), ("1e-6", ["97 128", "97 192"])):
            case = ("-s", "integrator.revolutions=0.2", "-s", f"integrator.relative_tolerance={tolerance}",
                    "-s", "lubrication.cavitation=gumbel")
            subprocess.run([GUDGEON, "-q", "--certify", "-o", self.folder / tolerance, *case, CASE], check=True,
                           env={**os.environ, "XDG_CACHE_HOME": str(self.cache)})
            keys = [table.read_bytes().splitlines()[1].decode() for table in (self.cache / "gudgeon").iterdir()]
            self.assertEqual(sorted(" ".join(key.split()[-2:]) for key in keys), wanted)
            shutil.rmtree(self.cache)

    def test_places_that_are_not_files(self) -> None:
        """A device is no place for a table, also for a check; a relative cache folder is ignored, as its specification says."""
        for device in ("/dev/zero", "/dev/null", "/dev/full"):
            for options in ((), ("--check",)):
                done, _ = self.run_case("device", "-s", f"lubrication.table_file={device}", *options)
                self.assertEqual(done.returncode, 3, f"{device} {options}")
                self.assertIn(f"&lubrication table_file = {device}: not a regular file", done.stderr)
        self.assertFalse((self.folder / "device").exists())
        done = subprocess.run([GUDGEON, "-q", "-o", self.folder / "relative", *SMALL, CASE], capture_output=True, text=True, check=False,
                              cwd=self.folder, env={**os.environ, "XDG_CACHE_HOME": "there", "HOME": str(self.folder / "home")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.folder / "there").exists())
        self.assertEqual(len(list((self.folder / "home" / ".cache" / "gudgeon").iterdir())), 1)

    def test_other_tables(self) -> None:
        self.run_case("one")
        self.run_case("same", "-s", "lubrication.viscosity=0.03", "-s", "joint.clearance=20e-6")
        self.assertEqual(len(list((self.cache / "gudgeon").iterdir())), 1, "the table does not depend on the oil")
        for clearance in ("15e-6", "30e-6", "50e-6"):
            self.run_case("other", "-s", f"joint.clearance={clearance}")
        self.assertEqual(len(list((self.cache / "gudgeon").iterdir())), 1, "a study of the clearance needs no further tables")
        self.run_case("longer", "-s", "joint.bearing_length=0.02")
        self.run_case("half", "-s", "lubrication.cavitation=gumbel")
        self.assertEqual(len(list((self.cache / "gudgeon").iterdir())), 3, "the table depends on length and cavitation")

    def test_sweep(self) -> None:
        """Each run of a sweep has its own table, and the cache has no further ones."""
        case = self.folder / "short.nml"
        case.write_text(CASE.read_text().replace("law = 'finite_bearing'", "law = 'finite_bearing', cavitation = 'gumbel'")
                        .replace("revolutions = 4.0", "revolutions = 2.0"))
        study = self.folder / "study.nml"
        for key, values in (("joint.bearing_length", "0.010, 0.020"), ("integrator.relative_tolerance", "1e-4, 1e-6")):
            study.write_text(f"&study title = 'tables', case = '{case}', settle_cycles = 0 /\n"
                             f"&parameter key = '{key}', values = {values} /\n")
            self.run_program(self.cache, "sweep", "--fresh", "-j", "1", "-o", self.folder, study)
            with (self.folder / "study.runs.csv").open() as file:
                swept = [float(row["min_film_thickness[m]"]) for row in csv.DictReader(file)]
            for cache in (self.cache, self.folder / "another"):
                for value, thickness in zip(values.split(", "), swept):
                    with self.subTest(key=key, value=value, cache=cache.name):
                        self.run_program(cache, "-o", self.folder / "single", "-s", f"{key}={value}", case)
                        with (self.folder / "single" / "short.summary.csv").open() as file:
                            single = {row[0]: row[1] for row in csv.reader(file)}["min_film_thickness"]
                        self.assertAlmostEqual(thickness, float(single), delta=1e-9 * thickness)

    def run_program(self, cache: Path, *options: str | Path) -> None:
        subprocess.run([GUDGEON, *options, "-q"], env={**os.environ, "XDG_CACHE_HOME": str(cache)}, check=True)

    def test_no_cache(self) -> None:
        self.cache.write_text("a file in the place of the cache folder")
        done, trace = self.run_case("none")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(trace, "a run without a cache has a trace")

    def test_file_of_the_case(self) -> None:
        table = self.folder / "oil.table"
        named = ("-s", f"lubrication.table_file={table}")
        done, first = self.run_case("first", *named)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse(self.cache.exists(), "a table with a file of its own is not in the cache")
        written = table.stat().st_mtime_ns
        _, again = self.run_case("again", *named)
        self.assertEqual((first, written), (again, table.stat().st_mtime_ns), "the file of a table is used again")
        self.run_case("longer", *named, "-s", "joint.bearing_length=0.02")
        self.assertNotEqual(written, table.stat().st_mtime_ns, "a table of another film is replaced")
        beside = self.folder / "cases" / CASE.name
        beside.parent.mkdir()
        beside.write_bytes(CASE.read_bytes())
        done = subprocess.run([GUDGEON, "-q", "-o", self.folder / "beside", *SMALL, "-s", "lubrication.table_file=oil.table", beside],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((beside.parent / "oil.table").exists(), "a relative path of a table starts at the case")
        table.write_text("a letter")
        done, _ = self.run_case("foreign", *named)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("table_file", done.stderr)
        self.assertEqual(table.read_text(), "a letter", "a file that is not a table is not changed")
        done, _ = self.run_case("nowhere", "-s", f"lubrication.table_file={self.folder}/no/oil.table")
        self.assertEqual(done.returncode, 5, done.stderr)

    def test_check_makes_none(self) -> None:
        done, _ = self.run_case("check", "--check")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse(self.cache.exists(), "--check computes no table")

    def test_interrupted(self) -> None:
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.cache)}
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        process = subprocess.Popen([GUDGEON, "-o", self.folder / "stopped", "-s", "lubrication.table_points=513", CASE],   # a table of half a minute
                                   env=environment, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        wait_for((self.cache / "gudgeon").is_dir, "the folder of the tables")
        time.sleep(1)
        process.send_signal(signal.SIGTERM)   # background jobs of a shell ignore SIGINT
        _, said = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 4, said)
        self.assertIn("interrupted before it began", said)
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, 10, "s of processor time until the program has ended")
        self.assertFalse(list(self.cache.glob("gudgeon/*")), "an incomplete table is not stored")


class Fields(unittest.TestCase):
    """The pressures in NAME.film.csv, integrated over the bore, give the force in the row of the same time."""

    def fields(self, case: Path, *options: str) -> tuple[dict[float, list[tuple[float, ...]]], dict[str, list[float]]]:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        done = subprocess.run([GUDGEON, "-q", "-o", folder, "-s", "output.interval=0.001", "-s", "output.ideal_twin=F",
                               "-s", "integrator.method=auto", *options, case], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        times: dict[float, list[tuple[float, ...]]] = {}
        with (folder / f"{case.stem}.film.csv").open() as file:
            for row in csv.DictReader(file):
                self.assertEqual(row["joint"], "piston_pin")
                node = tuple(float(row[name]) for name in ("angle[rad]", "place[m]", "pressure[Pa]", "film_thickness[m]"))
                times.setdefault(float(row["time[s]"]), []).append(node)
        return times, columns(folder / f"{case.stem}.csv")

    def resultant(self, nodes: list[tuple[float, ...]], radius: float) -> tuple[float, float]:
        """Force by the trapezoidal rule along the bore, then around it; for both halves of the bore."""
        lines: dict[float, list[tuple[float, float]]] = {}
        for angle, place, pressure, _ in nodes:
            lines.setdefault(angle, []).append((place, pressure))
        angles = sorted(lines)
        loads = [2 * sum(0.5 * (b[0] - a[0]) * (a[1] + b[1]) for a, b in zip(line, line[1:])) for line in map(lines.get, angles)]
        force = [0.0, 0.0]
        for i, angle in enumerate(angles):
            width = 0.5 * ((angles[(i + 1) % len(angles)] - angles[i - 1]) % (2 * math.pi)) * radius
            force[0] -= loads[i] * math.cos(angle) * width
            force[1] -= loads[i] * math.sin(angle) * width
        return force[0], force[1]

    def test_pressure_carries_the_force(self) -> None:
        finite, mixed, long_one = CASE, TOP / "cases" / "film" / "sim_IV_mixed.nml", TOP / "cases" / "sim_II.nml"
        for case, options in ((finite, SMALL), (finite, [*SMALL, "-s", "lubrication.variant=short"]),
                              (finite, [*SMALL, "-s", "lubrication.cavitation=gumbel"]), (mixed, SMALL),
                              (long_one, ["-s", "integrator.revolutions=1", "-s", "lubrication.variant=half_film"])):
            with self.subTest(case=case.stem, options=options):
                times, trace = self.fields(case, *options, "-s", "output.film_times='0.004:0.02:5'")
                self.assertEqual(len(times), 5)
                clearance = 4e-5 if case == long_one else 2e-5
                for time_, nodes in times.items():
                    row = min(range(len(trace["time[s]"])), key=lambda i: abs(trace["time[s]"][i] - time_))
                    force = self.resultant(nodes, 0.01 - clearance)
                    wanted = trace["film_force_x[N]"][row], trace["film_force_y[N]"][row]
                    self.assertLessEqual(math.dist(force, wanted), 0.02 * math.hypot(*wanted) + 1e-3, f"at {time_} s")
                    self.assertGreaterEqual(min(node[2] for node in nodes), 0.0)
                    self.assertTrue(all(0 < node[3] < 2 * clearance for node in nodes),
                                    "the film thickness is between 0 and the diametral clearance")


STATES = ("crank_angle", "rod_angle", "piston_position", "crank_speed", "rod_speed", "piston_velocity")
PLACES = ("eccentricity_x", "eccentricity_y", "film_thickness", "eccentricity_ratio")
OTHER_NAMES = {"mixed_sim_I": {"normal_force[N]": "asperity_force[N]"}}   # columns that have another name in the references


class References(unittest.TestCase):
    """Whole mechanisms against independent programs (data/film/models): every column, as exactly as two runs of the reference
    agree."""

    def compare(self, name: str, states: float, places: float, forces: float, *options: str) -> list[dict[str, str]]:
        """Compare the largest differences over the size of the column: states, eccentricities, others. Returns the events of our
        run."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([GUDGEON, "-q", "-o", folder, *options, REFERENCES / f"{name}.nml"], capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            ours, theirs = columns(Path(folder) / f"{name}.csv"), columns(REFERENCES / f"{name}.csv")
            events = Path(folder) / f"{name}.events.csv"
            rows = list(csv.DictReader(events.read_text().splitlines())) if events.exists() else []
        for column, values in theirs.items():
            ours_here = ours[OTHER_NAMES.get(name, {}).get(column, column)]
            quantity = column.split("[")[0]
            bound = states if quantity in (*STATES, "time") else places if quantity in PLACES else forces
            worst = max(abs(a - b) for a, b in zip(ours_here, values, strict=True)) / max(map(abs, values))
            self.assertLessEqual(worst, bound, f"{name}: {column}")
        return rows

    def test_short_bearing(self) -> None:
        self.compare("short_bearing_sim_I", 4.6e-9, 6.3e-6, 6.3e-6)

    def test_mixed(self) -> None:
        self.compare("mixed_sim_I", 9.8e-10, 2.2e-6, 2.2e-6)

    def test_weighted(self) -> None:
        """The times of the five events too."""
        ours = self.compare("weighted_smooth", 5.3e-9, 9.4e-7, 9.4e-7)
        theirs = list(csv.DictReader((REFERENCES / "weighted_smooth.events.csv").read_text().splitlines()))
        self.assertEqual([row["event"] for row in ours], [row["event"] for row in theirs])
        for one, other in zip(ours, theirs):
            self.assertAlmostEqual(float(one["time[s]"]), float(other["time[s]"]), delta=3.1e-11)

    def test_finite_bearing(self) -> None:
        """The reference's own table of the film has errors of 1e-6, 1e-4 and 1e-3."""
        self.compare("finite_reynolds_engine", 1e-6, 1e-4, 1e-3, "-s", "lubrication.table_points=65", "-s", "lubrication.film_points=128")


if __name__ == "__main__":
    GUDGEON = build()
    result = unittest.main(exit=False, verbosity=0).result
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed - len(result.skipped)} passed, {failed} failed")
    sys.exit(failed > 0)
