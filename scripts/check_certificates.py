#!/usr/bin/env python3
"""Checks what `gudgeon --certify` claims against runs at the tolerance 1e-13.

    scripts/check_certificates.py                       every shipped case as it stands
    scripts/check_certificates.py cases/sim_I.nml       these
    scripts/check_certificates.py --set integrator.method=auto --set integrator.relative_tolerance=1e-8

Each case is certified, run with close rows, and run twice at 1e-13, with `auto` and with Radau: where those two part (1e-6 of a
state's range) nothing is known and the case counts no further. A certificate fails where it claims more than is true: a time at which
some coordinate or speed is off by more than 1e-3 of its range, or a smaller error than the largest one up to there; or far less:
neither 95 % of the true time nor a time at which the error was a tenth of the limit. Ends with `N passed, N failed`. `--write`: the
table goes into data/measured/certificates.md.
"""

import argparse
import re
import sys
import tempfile
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment()

import subprocess  # noqa: E402

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402

from gudgeon_plots.measured import write_table  # noqa: E402
from gudgeon_plots.program import release_program  # noqa: E402

STATES = ("crank_angle", "rod_angle", "piston_position", "crank_speed", "rod_speed", "piston_velocity", "eccentricity_x", "eccentricity_y")
WORDS = """Certified and true time up to which no coordinate or speed is off by more than 1e-3 of its range; the time up to which two runs at 1e-13,
by `auto` and by Radau, agree within 1e-6 of the range, so that the truth is known; the end of the run; the error that the certificate
states, and the true one, up to the certified time; digits; impacts matched.

"""
LIMIT = 1e-3
KNOWN = 1e-6
CLOSER_ROWS = 20  # as close as those of a case that says how far apart they are


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", type=Path, metavar="CASE.nml")
    parser.add_argument("--set", action="append", default=[], metavar="GROUP.KEY=VALUE", help="as of the program")
    parser.add_argument("--rows", type=int, default=4000, help="rows in a revolution (default: 4000)")
    parser.add_argument("--timeout", type=float, default=120.0, metavar="S", help="for one run (default: 120)")
    parser.add_argument("--write", action="store_true", help="write data/measured/certificates.md")
    parser.add_argument("--program", type=Path, help="(default: the fast build)")
    options = parser.parse_args()
    if not options.cases:
        options.cases = sorted(TOP.glob("cases/*.nml")) + sorted(TOP.glob("cases/*/*.nml"))
        options.cases = [case for case in options.cases if "&mechanism" in case.read_text(encoding="utf-8")]
    return options


def run(program: Path, case: Path, out: Path, settings: list[str], limit: float, *more: str) -> tuple[pd.DataFrame, dict[str, str]]:
    """Trace and summary of a run; an empty trace where it did not come to its end in time."""
    words = [str(program), "-q", "-o", str(out), *more]
    for setting in settings:
        words += ["--set", setting]
    try:
        done = subprocess.run([*words, str(case)], capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return pd.DataFrame(), {}
    if done.returncode != 0:
        return pd.DataFrame(), {}
    summary = pd.read_csv(out / f"{case.stem}.summary.csv", index_col=0, dtype=str)["value"].to_dict()
    trace = pd.read_csv(out / f"{case.stem}.csv")
    (out / f"{case.stem}.csv").unlink()
    return trace, summary


def state_errors(a: pd.DataFrame, b: pd.DataFrame) -> np.ndarray:
    """Largest difference of any coordinate or speed in each row, over its range in the first."""
    rows = min(len(a), len(b))
    errors = np.zeros(rows)
    for name in a.columns:
        if name.split("[")[0].removeprefix("crank_pin_") not in STATES or np.ptp(a[name]) == 0:
            continue
        errors = np.maximum(errors, np.abs(a[name].to_numpy()[:rows] - b[name].to_numpy()[:rows]) / np.ptp(a[name]))
    return errors


def end_of(times: np.ndarray, errors: np.ndarray, limit: float) -> float:
    """Time up to which no error exceeds a limit."""
    beyond = np.flatnonzero(errors > limit)
    last = beyond[0] - 1 if len(beyond) else len(errors) - 1
    return times[last] if last >= 0 else 0.0


def judge(program: Path, case: Path, options: argparse.Namespace, out: Path) -> tuple[str, str]:
    """A row of the table and what is wrong, or an empty text."""
    rows = ["output.digits=17", "output.ideal_twin=F", "output.columns=standard"]
    interval = re.search(r"\binterval\s*=\s*([-+.\deEdD]+)", case.read_text(encoding="utf-8"))
    if interval:
        rows.append(f"output.interval={float(interval[1].lower().replace('d', 'e')) / CLOSER_ROWS:.9g}")
    else:
        rows.append(f"output.samples_per_revolution={options.rows}")
    plain, claim = run(program, case, out, [*options.set, *rows], options.timeout, "--certify")
    if plain.empty:
        return f"{case.stem:32s} has no run in time", ""
    if "certified_until" not in claim:
        return f"{case.stem:32s} {claim.get('certificate', '?')}", ""
    tight = [*options.set, *rows, "integrator.relative_tolerance=1e-13", "integrator.absolute_tolerance=0"]
    truth, _ = run(program, case, out, [*tight, "integrator.method=auto"], options.timeout)
    check, _ = run(program, case, out, [*tight, "integrator.method=radau"], options.timeout)
    if truth.empty:
        return f"{case.stem:32s} has no run at 1e-13 in time", ""
    times = truth["time[s]"].to_numpy()
    known = end_of(times, state_errors(truth, check), KNOWN) if not check.empty else times[-1]
    errors = state_errors(plain, truth)
    errors = errors[times[: len(errors)] <= known]
    true_until, true_decade = end_of(times, errors, LIMIT), end_of(times, errors, LIMIT / 10)
    until, error = float(claim["certified_until"]), float(claim["state_error"])
    row_gap = times[1] - times[0]
    largest = errors[: np.searchsorted(times, until, side="right")].max(initial=0.0)
    wrong = ""
    if true_until < known - row_gap and until > true_until + row_gap:
        wrong = "claims more time than is true"
    elif until <= known + row_gap and error < largest:
        wrong = "claims a smaller error than is true"
    elif until < min(0.95 * true_until, true_decade) - row_gap:
        wrong = "claims far less time than is true"
    row = (
        f"{case.stem:32s} {1e3 * until:10.5g} {1e3 * true_until:10.5g} {1e3 * known:10.5g} {1e3 * times[-1]:9.5g}"
        f" {error:9.1e} {largest:9.1e} {float(claim['certified_digits']):5.1f}"
        f" {claim['certified_impacts_matched']}/{claim['certified_impacts']}"
    )
    return row, wrong


def main() -> int:
    options = arguments()
    program = options.program or release_program()
    failed = passed = 0
    rows = [f"{'case':32s} {'until [ms]':>10s} {'true':>10s} {'known':>10s} {'end':>9s} {'error':>9s} {'true':>9s} digits impacts"]
    print(rows[0])
    with tempfile.TemporaryDirectory() as folder:
        for case in options.cases:
            row, wrong = judge(program, case, options, Path(folder))
            rows.append(f"{row} FAILED: {wrong}" if wrong else row)
            print(rows[-1], flush=True)
            failed += bool(wrong)
            passed += not wrong
    if options.write:
        command = " ".join(["scripts/check_certificates.py --write", *(f"--set {setting}" for setting in options.set)])
        write_table("certificates", "Certificates against runs at the tolerance 1e-13", command, WORDS + "\n".join(f"    {row}" for row in rows))
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
