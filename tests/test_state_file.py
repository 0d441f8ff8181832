#!/usr/bin/env python3
"""Files of states: a run in two halves agrees with the whole, energies and wear add up, a state that does not fit is refused.

    tests/test_state_file.py [--program PATH]

Needs a release build (or makes one). Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import re
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

from test_faults import ROOT, Gudgeon, assertions, check, disk, program_built, wait_for

CASES = ROOT / "cases"
ACCURATE = ("integrator.method=auto", "integrator.contact_entry=root", "output.ideal_twin=F", "output.digits=17",
            "integrator.relative_tolerance=1e-9")
#: Cases in which neighbouring motions do not diverge, with their length, the part of it that comes first, and the largest difference
#: of the last row from that of the whole run, relative to the largest value of its column. Errors of impacts grow from one to the
#: next: a whole run at ten times the tolerance differs from these by as much.
HALVES = {
    "flores/dry_0010um": ("revolutions=2", 0.47, 1e-4),
    "friction/lugre": ("revolutions=1", 0.63, 1e-4),
    "friction/coulomb_static": ("revolutions=0.6", 0.5, 1e-4),
    "contact/sliding_coulomb": ("", 0.2, 1e-5),
    "sim_I": ("revolutions=2", 0.3, 1e-5),
    "sim_III": ("crank_revolutions=3", 0.6, 1e-5),
    "sim_III_oscillating": ("revolutions=1", 0.47, 1e-4),
    "sim_VI_oscillating": ("revolutions=1", 0.47, 1e-4),
    "film/elastic": ("revolutions=1", 0.47, 1e-5),
    "film/weighted": ("revolutions=1", 0.4, 1e-4),
    "elastic/dry_friction": ("revolutions=1", 0.5, 1e-4),
    "elastic/engine_crankshaft": ("revolutions=1", 0.4, 1e-5),
    "joints/both_pins_lubricated": ("revolutions=1", 0.5, 1e-5),
    "joints/crank_pin": ("revolutions=1", 0.5, 1e-4),
    "joints/guide_friction": ("revolutions=1", 0.5, 1e-5),
    "joints/piston_slap": ("revolutions=0.6", 0.6, 1e-3),
    "gas/compressor": ("revolutions=2", 0.35, 1e-5),
    "wear/flores": ("revolutions=1", 0.5, 1e-4),
    "wear/worn_bore": ("revolutions=3", 0.5, 1e-3),
    "drive/motor": ("", 0.5, 1e-5),
}


def table(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary(folder: Path, name: str) -> dict[str, str]:
    return {row["quantity"]: row["value"] for row in table(folder / f"{name}.summary.csv")}


def settings(*values: str) -> list[str]:
    return [word for value in values if value for word in ("--set", value)]


def differs(one: float, other: float, scale: float, tolerance: float) -> bool:
    return not abs(one - other) <= tolerance*scale


def test_halves(gudgeon: Gudgeon, work: Path, case: str, length: str, part: float, tolerance: float) -> None:
    """A run in two halves: rows, events, extremes, energies and wear are those of the whole."""
    file, name = CASES / f"{case}.nml", case.split("/")[-1]
    common = settings(*ACCURATE, length and f"integrator.{length}")
    status, _, error = gudgeon.run("-q", "-o", work / "whole", *common, file)
    check(not status, f"{case}: the whole run", error)
    whole = summary(work / "whole", name)
    end = float(whole["simulated_time"])
    status, _, error = gudgeon.run("-q", "-o", work / "first", *settings(*ACCURATE, f"integrator.end_time={end*part!r}"), file)
    check(not status, f"{case}: the first half", error)
    status, _, error = gudgeon.run("-q", "-o", work / "second", "--from", work / "first" / f"{name}.state.nml", *common, file)
    check(not status, f"{case}: the second half", error)
    if status:
        return
    second = summary(work / "second", name)
    rows, halves = table(work / "whole" / f"{name}.csv"), [table(work / half / f"{name}.csv") for half in ("first", "second")]
    times = [[f"{float(row['time[s]']):.12e}" for row in part] for part in (rows, *halves)]
    if times[1][-1] == times[2][0]:   # the row at which the second half begins
        times[1].pop()
    check(times[0] == times[1] + times[2],
          f"{case}: the rows of both halves are those of the whole", f"{len(rows)}, {[len(half) for half in halves]}")
    for column in rows[0]:
        if "residual" in column:   # what rounding and tolerance leave
            continue
        scale = max(abs(float(row[column])) for row in rows)
        check(not differs(float(rows[-1][column]), float(halves[1][-1][column]), scale, tolerance),
              f"{case}: the last {column}", f"{rows[-1][column]}, in halves {halves[1][-1][column]}, largest {scale}")
    events = [[(row["joint"], row["event"]) for row in table(work / half / f"{name}.events.csv")]
              for half in ("whole", "first", "second")]
    check(events[0] == events[1] + events[2], f"{case}: the events of both halves are those of the whole",
          f"{len(events[0])}, {len(events[1])}, {len(events[2])}")
    totals = [key for key in whole if re.search(
        r"contacts|contact_time|max_(penetration|pin_force|film)|min_film|work|lost|loss|worn|wear|deflection|stretch|twist|volume",
        key) and "cycle_" not in key and "entry" not in key and "frequency" not in key and "_with_" not in key]
    for key in totals:
        check(not differs(float(whole[key]), float(second[key]), abs(float(whole[key])), 10*tolerance),
              f"{case}: {key} adds up", f"{whole[key]}, in halves {second[key]}")
    check(float(second["max_energy_residual_relative"]) < 1e-6, f"{case}: the energy is kept over both halves",
          second["max_energy_residual_relative"])
    worn = [table(work / half / f"{name}.wear.csv") for half in ("whole", "second")]
    check(len(worn[0]) == len(worn[1]), f"{case}: the worn surfaces have the same bins")
    for column in (worn[0] or [{}])[0]:
        if "depth" in column or "volume" in column:
            scale = max(float(row[column]) for row in worn[0])
            most = max(abs(float(row[column]) - float(other[column])) for row, other in zip(*worn))/max(scale, 1e-30)
            # the wear of a bin is that of a few impacts, whose errors grow from one to the next (0.011 by rounding alone)
            check(most <= 0.05, f"{case}: {column} of the worn surfaces adds up", f"{most} of the largest")


def test_settled(gudgeon: Gudgeon, work: Path) -> None:
    """A start from a settled motion: at t = 0 with counts of its own, and settled at once; also into another clearance."""
    case = CASES / "gas" / "compressor.nml"
    common = settings("run.until=periodic", "integrator.revolutions=0", "output.ideal_twin=F")
    status, _, error = gudgeon.run("-q", "-o", work / "settled", *common, case)
    check(not status, "a compressor settles", error)
    state = work / "settled" / "compressor.state.nml"
    status, _, error = gudgeon.run("-q", "-o", work / "again", "--from", state, "-s", "initial.goes_on=F", "-s",
                                   "integrator.revolutions=1", "-s", "output.ideal_twin=F", case)
    check(not status, "one revolution of the settled motion", error)
    rows = table(work / "again" / "compressor.csv")
    check(float(rows[0]["time[s]"]) == 0, "the start from a settled motion is at t = 0", rows[0]["time[s]"])
    for column in ("crank_speed[rad/s]", "eccentricity_x[m]", "eccentricity_y[m]", "cylinder_pressure[Pa]"):
        scale = max(abs(float(row[column])) for row in rows)
        check(not differs(float(rows[0][column]), float(rows[-1][column]), scale, 2e-3),
              f"a revolution from a settled motion returns to its {column}", f"{rows[0][column]}, {rows[-1][column]}")
    wide = settings("joint.clearance=60e-6", "initial.goes_on=F", "output.ideal_twin=F", "integrator.revolutions=0.1")
    clearance = float(re.search(r"^\s*clearance = (\S+)", state.read_text(), re.M)[1])
    status, _, error = gudgeon.run("-q", "-o", work / "wide", "--from", state, *wide, case)
    first = table(work / "wide" / "compressor.csv")[0]
    check(not differs(float(first["eccentricity_x[m]"]), 60e-6/clearance*float(rows[0]["eccentricity_x[m]"]), 60e-6, 1e-7),
          "in a wider bearing a pin on its film keeps its place relative to the clearance", first["eccentricity_x[m]"])


def test_pressed(gudgeon: Gudgeon, work: Path) -> None:
    """A state whose pin is in the wall, with a contact that has no speed of impact: it leaves as from the same start in the case."""
    text = (CASES / "flores" / "dry_0100um.nml").read_text()
    case = work / "pressed.nml"
    case.write_text(text)
    common = settings("initial.crank_speed=0", "contact.restitution=0.8", "output.interval=1e-5", "integrator.revolutions=0",
                      "output.ideal_twin=F", "integrator.relative_tolerance=1e-9")
    gudgeon.run("-q", "-o", work / "in_case", *common, "-s", "integrator.end_time=3e-4", "-s", "initial.eccentricity=1.05e-4,0", case)
    gudgeon.run("-q", "-o", work / "start", *common, "-s", "integrator.end_time=1e-9", "-s", "initial.eccentricity=9.5e-5,0", case)
    state = (work / "start" / "pressed.state.nml").read_text()
    for phase in (0, 2):
        edited = re.sub(r"phase = \d", f"phase = {phase}", re.sub(r"eccentricity = \S+,\s*\S+", "eccentricity = 1.05e-4, 0", state))
        (work / "edited.nml").write_text(re.sub(r"eccentricity_rate = \S+,\s*\S+", "eccentricity_rate = 0, 0", edited))
        status, _, error = gudgeon.run("-q", "-o", work / "from", "--from", work / "edited.nml", *common, "-s", "initial.goes_on=F", "-s",
                                       "integrator.end_time=3e-4", case)
        check(not status, f"a state whose pin is in the wall, phase {phase}", error)
        ends = [[row for row in table(work / folder / "pressed.events.csv") if row["event"] == "contact_ends"] for folder in ("in_case", "from")]
        check(all(ends), f"a pin in the wall leaves it, phase {phase}")
        if all(ends):
            left, found = (float(rows[0]["normal_speed[m/s]"]) for rows in ends)
            check(left < 0 and not differs(left, found, abs(left), 1e-5), f"it leaves as from a case, phase {phase}", f"{found}, {left}")


def test_study(gudgeon: Gudgeon, work: Path) -> None:
    """&study start = 'previous': each run starts from the end of the run before it, as --from does."""
    case, text = CASES / "flores" / "dry_0100um.nml", "1e-4, 9e-5, 1.1e-4"
    study = work / "branch.nml"
    study.write_text(f"&study case = '{case}' start = 'previous' traces = 'all' /\n&parameter key = 'joint.clearance' "
                     f"values = '{text}' /\n")
    status, _, error = gudgeon.run("sweep", "-q", "-j", "2", "-o", work / "sweep", study)
    check(not status, "a study along a branch", error)
    before: list[object] = []
    for number, clearance in enumerate(text.split(", "), 1):
        folder = work / f"run{number}"
        gudgeon.run("-q", "-o", folder, *before, *settings(f"joint.clearance={clearance}", "output.ideal_twin=F"), case)
        check((folder / "dry_0100um.csv").read_bytes() == (work / "sweep" / "branch" / f"{number}.csv").read_bytes(),
              f"run {number} of the study is the case from the state before it")
        before = ["--from", folder / "dry_0100um.state.nml", "--set", "initial.goes_on=F"]
    status, _, error = gudgeon.run("sweep", "-q", "--rows", "2:3", "-o", work / "rows", study)
    check(status == 3 and "--rows" in error, "a range of rows of a study along a branch is refused", error)


def test_refusals(gudgeon: Gudgeon, work: Path) -> None:
    """A wrong file, and a state of another scene: one line, exit status 3, no results."""
    case, out = CASES / "flores" / "dry_0010um.nml", work / "refused"
    gudgeon.run("-q", "-o", work / "good", *settings("integrator.revolutions=0.1"), case)
    good = (work / "good" / "dry_0010um.state.nml").read_text()
    bad = work / "bad.nml"
    changes = {   # what is replaced, by what, and what the message contains
        "a group with another name": (r"&initial", "&start", "&start: the file of a state has the groups"),
        "no end of a group": (r"\n/\n", "\n", "not closed"),
        "no number": (r"(eccentricity_rate = )\S+", r"\1fast,", "&initial eccentricity_rate: must be a number"),
        "one number of two": (r"(eccentricity_rate = [^,]*),[^!]*", r"\1", "1 values, but the case needs 2"),
        "a key that is missing": (r"\n *eccentricity_rate[^\n]*", "", "&initial eccentricity_rate: missing"),
        "a key given twice": (r"(\n *phase[^\n]*)", r"\1\1", "&initial phase: given twice"),
        "a phase that the case does not have": (r"phase = \d", "phase = 1", "&initial phase: "),
        "half a phase": (r"phase = \d", "phase = 0.5", "&initial phase: must be a whole number"),
        "a state without place": (r"\n *phase", "\n film_eccentricity = 0, 0\n phase", "film_eccentricity: the case has no place"),
        "a total that is missing": (r"\n *work[^\n]*", "", "&so_far work: missing"),
        "a time before 0": (r"( time =) \S+", r"\1 -5", "&so_far time: must be >= 0"),
        "an angle without limit": (r"(crank_angle =) \S+", r"\1 1e30", "&initial crank_angle: must be at most 1e9 in size (rad)"),
        "a crank speed without limit": (r"(crank_speed =) \S+", r"\1 -2e9", "&initial crank_speed: must be at most 1e9 in size (rad/s)"),
        "a rate without limit": (r"(eccentricity_rate = )\S+", r"\1 1e30,", "&initial eccentricity_rate: must be at most 1e9 in size (m/s)"),
        "a time after the end": (r"( time =) \S+", r"\1 9.0", "&so_far time: is not before the end"),
    }
    for what, (old, new, message) in changes.items():
        text = re.sub(old, new, good, count=1)
        check(text != good, f"{what}: the file is changed")
        bad.write_text(text)
        for check_only in ([], ["--check"]):
            status, _, error = gudgeon.run("-o", out, "--from", bad, *check_only, case)
            check(status == 3 and error.count("\n") == 1 and message in error and "bad.nml" in error,
                  f"{what} is refused {' '.join(check_only)}", f"{status} {error}")
    for other in ("friction/lugre", "joints/both_pins", "elastic/engine_rod", "gas/compressor", "wear/flores"):
        status, _, error = gudgeon.run("-o", out, "--from", work / "good" / "dry_0010um.state.nml", CASES / f"{other}.nml")
        check(status == 3 and error.count("\n") == 1 and "state.nml: &" in error, f"a state of another scene in {other}", error)
    status, _, error = gudgeon.run("-o", out, "--from", work / "nowhere.nml", case)
    check(status == 3 and "nowhere.nml" in error, "a state that is not there", error)
    check(not out.exists(), "a refused state leaves no results")
    only_motion = good[:good.index("&so_far")]
    bad.write_text(only_motion)
    status, _, error = gudgeon.run("-q", "-o", work / "motion", "--from", bad, *settings("integrator.revolutions=0.1"), case)
    rows = table(work / "motion" / "dry_0010um.csv")
    check(not status and rows and float(rows[0]["time[s]"]) == 0, "a state without totals begins at t = 0", error)


def test_dear_evaluations(gudgeon: Gudgeon, work: Path) -> None:
    """A run whose film is solved at every evaluation: a signal ends it soon, in the motion and while its exponent is measured."""
    case, common = CASES / "film" / "sim_I_finite.nml", ("lubrication.variant=direct", "integrator.method=radau")
    for what, *values in (("motion", "lubrication.film_points=256"),
                          ("exponent", "lubrication.film_points=64", "integrator.revolutions=1e-3", "run.lyapunov_revolutions=2")):
        process = gudgeon.start("-o", work / what, *settings(*common, *values), case)
        wait_for((work / what / "sim_I_finite.csv.part").exists, "rows")
        time.sleep(3)
        process.send_signal(signal.SIGTERM)
        began = time.monotonic()
        process.communicate(timeout=300)
        check(process.returncode == 4 and time.monotonic() - began < 60 and (work / what / "sim_I_finite.state.nml").exists(),
              f"{what}: ended soon, with its state", f"{process.returncode}, {time.monotonic() - began} s")
    gudgeon.run("-q", "-o", work / "limit", *settings(*common, "integrator.max_evaluations=200"), case)
    evaluations = int(summary(work / "limit", "sim_I_finite")["rhs_evaluations"])
    check(200 <= evaluations < 250, "the limit of evaluations is passed by less than one step", f"{evaluations}")


def test_stops(gudgeon: Gudgeon, work: Path) -> None:
    """A run that is stopped leaves its state; a new run says what it discards; a disk that is full is named."""
    case, name = CASES / "flores" / "dry_0500um.nml", "dry_0500um"
    folder = work / "stopped"
    for number in (signal.SIGINT, signal.SIGTERM):
        shutil.rmtree(folder, ignore_errors=True)
        process = gudgeon.start("-o", folder, *settings("integrator.revolutions=4000"), case)
        wait_for(lambda: (folder / f"{name}.csv.part").exists() and (folder / f"{name}.csv.part").stat().st_size > 0, "rows")
        process.send_signal(number)
        process.communicate(timeout=60)
        state = folder / f"{name}.state.nml"
        check(process.returncode == 4 and state.exists(), f"a run stopped by {number.name} leaves its state")
    reached = float(re.search(r"^\s*time = (\S+)", state.read_text(), re.M)[1])
    stopped = float(summary(folder, name)["simulated_time"])
    check(not differs(reached, stopped, stopped, 1e-9), "the state is that at which the run was stopped", f"{reached}, {stopped}")
    turns = 1.05*reached*523.6/6.2832
    status, _, error = gudgeon.run("-q", "-o", work / "on", "--from", state, *settings(f"integrator.revolutions={turns}"), case)
    check(not status, "a stopped run goes on", error)
    status, _, error = gudgeon.run("-o", folder, *settings("integrator.revolutions=0.1"), case)
    check(not status and "discards the results of an earlier run that was stopped at t = " in error, "a new run says what it discards",
          error)
    status, _, error = gudgeon.run("-o", folder, *settings("integrator.revolutions=0.1"), case)
    check(not status and "discards" not in error, "results of a run that is done are replaced without a word", error)
    status, _, error = gudgeon.run("-o", folder, "--from", state, *settings("integrator.revolutions=0.2"), case)
    check(not status and "replaces the results of the run from which it goes on" in error, "a run goes on in the same folder", error)
    limit = gudgeon.run("-q", "-o", work / "limit", *settings("integrator.max_steps=500"), case)
    check(limit[0] == 4 and (work / "limit" / f"{name}.state.nml").exists(), "a run ended by a limit leaves its state")
    with disk(work / "disk", "size=64k") as mounted:
        if not mounted:
            print("skipped: a full disk (needs root and tmpfs)")
            return
        status, _, error = gudgeon.run("-o", work / "disk", *settings("integrator.revolutions=400"), case)
        left = [path.name for path in (work / "disk").iterdir() if path.name.endswith(".state.nml.part")]
        check(status == 5 and "No space left" in error and not left, "a full disk is named, and no part of a state is left", error)


def test_deep_folder(gudgeon: Gudgeon, work: Path) -> None:
    """States in a folder whose path is longer than what messages show of it are told apart."""
    folder = work / Path(*["of-a-long-path" * 4] * 5)
    folder.mkdir(parents=True)
    for name in ("one", "other"):
        shutil.copy(CASES / "flores" / "ideal.nml", folder / f"{name}.nml")
        status, _, error = gudgeon.run("-q", "-o", folder, *settings("integrator.revolutions=1"), folder / f"{name}.nml")
        check(not status, f"{name}: a run in a deep folder", error)
    status, _, error = gudgeon.run("-o", folder, "--from", folder / "one.state.nml", *settings("integrator.revolutions=2"), folder / "other.nml")
    check(not status and "from which it goes on" not in error, "a run goes on from another one's state in a deep folder", error)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=Path)
    gudgeon = Gudgeon((parser.parse_args().program or program_built()).resolve())
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for case, (length, part, tolerance) in HALVES.items():
            test_halves(gudgeon, work / case.replace("/", "_"), case, length, part, tolerance)
        for test in (test_settled, test_pressed, test_study, test_refusals, test_stops, test_deep_folder, test_dear_evaluations):
            (work / test.__name__).mkdir()
            test(gudgeon, work / test.__name__)
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
