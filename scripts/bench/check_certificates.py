#!/usr/bin/env python3
"""Checks what `gudgeon --certify` claims against runs at the tolerance 1e-13.

    scripts/bench/check_certificates.py                       every shipped case as it stands
    scripts/bench/check_certificates.py cases/sim_I.nml       these
    scripts/bench/check_certificates.py --set integrator.method=auto --set integrator.relative_tolerance=1e-8

Each case is certified, run with close rows, and run twice at 1e-13, with `auto` and with Radau, to a quarter beyond the certified time:
from where those two differ by more than 1e-5 of a state's range, or where one of them has taken --timeout seconds of processor time, the true motion is not known. A certificate
fails where it claims more than is true: a time at which some coordinate or speed is off by more than 1e-3 of its range, or a smaller
error than the largest one up to there; or far less: neither 95 % of the true time nor a time at which the error was a tenth of the
limit. A case without a certificate, or without runs to compare it with in time, is neither passed nor failed: it is counted as not compared.
Ends with `N passed, N failed`. `--write`: the rows go into data/measured/certificates.md, in place of those that the same cases
have there. `--until` certifies a shorter run, where one at 1e-13 takes too long.
"""

import argparse
import contextlib
import re
import signal
import sys
import tempfile
from pathlib import Path

from measured import FOLDER, TOP, built_program, use_virtual_environment, write_table

use_virtual_environment()

import subprocess

import numpy as np
import pandas as pd
from gudgeon.commands import number

WORDS = """Certified and true time up to which no coordinate or speed is off by more than 1e-3 of its range; the time up to which two runs at 1e-13,
by `auto` and by Radau, agree within 1e-5 of the range, so that the truth is known; the end of the run; the error that the certificate
states, and the true one, up to the certified time; digits. The runs at 1e-13 end a quarter beyond the certified time:
a true time equal to the known one means "at least". A known time that is shorter than the certified one is that of a run at 1e-13 that
takes too long (`--timeout`): the claim is checked up to there.

"""
LIMIT = 1e-3
KNOWN = 1e-5
BEYOND = 1.25  # the runs at 1e-13 continue to this multiple of the certified time
REFUSED = (2, 3)  # exit statuses of a wrong command line or case
CLOSER_ROWS = 20  # as close as those of a case that gives their distance


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", type=Path, metavar="CASE.nml")
    parser.add_argument("--set", action="append", default=[], metavar="GROUP.KEY=VALUE", help="as of the program")
    parser.add_argument("--rows", type=number(20, whole=True), default=4000, help="rows in a revolution (default: 4000)")
    parser.add_argument("--timeout", type=number(0, itself=False), default=120.0, metavar="S", help="of processor time, for one run (default: 120)")
    parser.add_argument("--until", type=number(0, itself=False), metavar="S", help="simulated time of the runs, where shorter than the case's")
    parser.add_argument("--write", action="store_true", help="put the rows into data/measured/certificates.md")
    parser.add_argument("--program", type=Path, help="(default: the fast build)")
    options = parser.parse_args()
    for case in options.cases:
        if not case.is_file() or "&mechanism" not in case.read_text(encoding="utf-8"):
            parser.error(f"{case}: not a case file")
    if not options.cases:
        options.cases = sorted(TOP.glob("cases/*.nml")) + sorted(TOP.glob("cases/*/*.nml"))
        options.cases = [case for case in options.cases if "&mechanism" in case.read_text(encoding="utf-8")]
    return options


def run(
    program: Path, case: Path, out: Path, settings: list[str], limit: float, states: list[str] | None = None
) -> tuple[pd.DataFrame, dict[str, str]]:
    """Trace of the time and the states, and summary, of a run; of one that takes too long the rows that it had. Without names of
    states the run is certified, and they are those of its certificate."""
    trace, summary = out / f"{case.stem}.csv", out / f"{case.stem}.summary.csv"
    for left in (trace, summary):
        left.unlink(missing_ok=True)
    words = [str(program), "-q", "-o", str(out)] + (["--certify"] if states is None else [])
    for setting in settings:
        words += ["--set", setting]
    running = subprocess.Popen([*words, str(case)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while running.poll() is None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            running.wait(0.5)
        if processor_time(running.pid) > limit:
            running.send_signal(signal.SIGINT)
            running.wait()
    said = running.communicate()[1].strip()
    if running.returncode in REFUSED:
        sys.exit(f"check_certificates.py: {said}")
    if not (trace.exists() and summary.exists()):
        return pd.DataFrame(), {}
    if states is None:
        states = certified_states(out / f"{case.stem}.certificate.csv")
    rows = pd.read_csv(trace, usecols=["time[s]", *states])
    trace.unlink()
    return rows, pd.read_csv(summary, index_col=0, dtype=str)["value"].to_dict()


def processor_time(process: int) -> float:
    """Seconds of processor time that a process has taken; 0 where it has ended."""
    said = subprocess.run(["ps", "-o", "time=", "-p", str(process)], capture_output=True, text=True, check=False).stdout.strip()
    seconds = 0.0
    for part in said.replace("-", ":").split(":") if said else ():
        seconds = 60 * seconds + float(part)
    return seconds


def certified_states(certificate: Path) -> list[str]:
    """Columns that are coordinates or speeds; none without a certificate."""
    if not certificate.exists():
        return []
    columns = pd.read_csv(certificate, index_col="column")
    return list(columns.index[columns["is_state"] == "yes"])


def state_errors(a: pd.DataFrame, b: pd.DataFrame, ranges: pd.Series) -> np.ndarray:
    """Largest difference of any coordinate or speed in each row, over its range."""
    rows = min(len(a), len(b))
    errors = np.zeros(rows)
    for name in a.columns.drop("time[s]"):
        if ranges[name] > 0:
            errors = np.maximum(errors, np.abs(a[name].to_numpy()[:rows] - b[name].to_numpy()[:rows]) / ranges[name])
    return errors


def end_of(times: np.ndarray, errors: np.ndarray, limit: float) -> float:
    """Time up to which no error exceeds a limit."""
    beyond = np.flatnonzero(errors > limit)
    last = beyond[0] - 1 if len(beyond) else len(errors) - 1
    return times[last] if last >= 0 else 0.0


def row_settings(case: Path, options: argparse.Namespace) -> list[str]:
    """Settings of the certified run: close rows of all digits."""
    settings = [*options.set, "output.digits=17", "output.ideal_twin=F", "output.columns=standard"]
    if options.until:
        settings.append(f"integrator.end_time={options.until:.9g}")
    interval = re.search(r"\binterval\s*=\s*([-+.\deEdD]+)", case.read_text(encoding="utf-8"))
    if interval:
        return [*settings, f"output.interval={float(interval[1].lower().replace('d', 'e')) / CLOSER_ROWS:.9g}"]
    return [*settings, f"output.samples_per_revolution={options.rows}"]


def judge(program: Path, case: Path, options: argparse.Namespace, out: Path) -> tuple[str, str | None]:
    """A row of the table and what is wrong (an empty text: nothing); None for what is wrong where nothing could be compared."""
    settings = row_settings(case, options)
    plain, claim = run(program, case, out, settings, 4 * options.timeout)
    name = f"{case.stem:32s}"
    if claim.get("status") != "done":
        return f"{name} has no run in time", None
    if "certified_until" not in claim:
        return f"{name} {claim.get('certificate', '?')}", None
    until, error, end = float(claim["certified_until"]), float(claim["state_error"]), plain["time[s]"].iloc[-1]
    tight = [*settings, "integrator.relative_tolerance=1e-13", "integrator.absolute_tolerance=0"]
    if BEYOND * until < end:
        tight.append(f"integrator.end_time={max(BEYOND * until, plain['time[s]'][10]):.9g}")
    states = list(plain.columns.drop("time[s]"))
    truth, _ = run(program, case, out, [*tight, "integrator.method=auto"], options.timeout, states)
    check, _ = run(program, case, out, [*tight, "integrator.method=radau"], options.timeout, states)
    if truth.empty or check.empty:
        return f"{name} has no run at 1e-13 in time", None
    ranges = plain.max() - plain.min()
    times = truth["time[s]"].to_numpy()
    doubts = state_errors(truth, check, ranges)
    known = end_of(times, doubts, KNOWN)
    errors = state_errors(plain, truth, ranges)
    errors = errors[times[: len(errors)] <= known]
    true_until, true_decade = end_of(times, errors, LIMIT), end_of(times, errors, LIMIT / 10)
    row_gap = times[1] - times[0]
    rows = min(np.searchsorted(times, until, side="right"), len(errors))
    largest, doubt = errors[:rows].max(initial=0.0), doubts[:rows].max(initial=0.0)
    wrong = ""
    if true_until < known - row_gap and until > true_until + row_gap:
        wrong = "claims more time than is true"
    elif error < largest - doubt:
        wrong = "claims a smaller error than is true"
    elif until < min(0.95 * true_until, true_decade) - row_gap:
        wrong = "claims far less time than is true"
    row = (
        f"{name} {1e3 * until:10.5g} {1e3 * true_until:10.5g} {1e3 * known:10.5g} {1e3 * end:9.5g}"
        f" {error:9.1e} {largest:9.1e} {float(claim['certified_digits']):5.1f}"
    )
    return row, wrong


def earlier_rows() -> dict[str, str]:
    """Rows of the table that is there, by their cases."""
    path = FOLDER / "certificates.md"
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return {line.split()[0]: line.strip() for line in lines if line.startswith("    ") and not line.split()[0].startswith(("scripts", "case"))}


def main() -> int:
    options = arguments()
    program = options.program or built_program()
    failed = passed = not_compared = 0
    title = f"{'case':32s} {'until [ms]':>10s} {'true':>10s} {'known':>10s} {'end':>9s} {'error':>9s} {'true':>9s} digits"
    command = " ".join(["scripts/bench/check_certificates.py --write", *(f"--set {setting}" for setting in options.set)])
    rows = earlier_rows()
    print(title)
    with tempfile.TemporaryDirectory() as folder:
        for case in options.cases:
            row, wrong = judge(program, case, options, Path(folder))
            rows[case.stem] = f"{row} FAILED: {wrong}" if wrong else row
            print(rows[case.stem], flush=True)
            failed += bool(wrong)
            passed += wrong == ""
            not_compared += wrong is None
            if options.write:
                lines = "\n".join(f"    {line}" for line in (title, *(rows[name] for name in sorted(rows))))
                write_table("certificates", "Certificates against runs at the tolerance 1e-13", command, WORDS + lines)
    if not_compared:
        print(f"{not_compared} not compared")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
