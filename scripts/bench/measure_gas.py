#!/usr/bin/env python3
"""Measures whether the energy of gas with a mass is kept, and writes data/measured/gas.md.

    scripts/bench/measure_gas.py [--scenes 3600] [--seed 3] [--jobs 2] [--program FILE]

Random scenes of tests/judge/extremes whose gas has a mass (walls, a leak, valves with losses, other cylinders, at the ends of all ranges)
run at their tolerance, and those that end well again at 1e-11. Takes ten minutes.
"""
from __future__ import annotations

import argparse
import collections
import concurrent.futures
import csv
import importlib.machinery
import importlib.util
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import TOP, built_program, table, write_table

LIMIT, TIGHT, EVALUATIONS = 1e-9, 1e-11, 100_000
SHARES = (50, 90, 99, 100)


def module_of(path: Path):
    """A module from a file without suffix."""
    sys.path.insert(0, str(path.parent))
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    spec = importlib.util.spec_from_loader(path.name, loader)
    found = sys.modules[path.name] = importlib.util.module_from_spec(spec)
    loader.exec_module(found)
    return found


def outcome(extremes, program: Path, base: str, settings: dict[str, str]) -> tuple[str, float | None]:
    """How a run ends, and the residual of the gas's energy; None without one."""
    with tempfile.TemporaryDirectory() as out:
        try:
            made = subprocess.run(extremes.command(program, base, settings, out), capture_output=True, text=True, timeout=600, check=False)
        except subprocess.TimeoutExpired:
            return "longer than 600 s", None
        if made.returncode == 3:
            return "refused", None
        if made.returncode not in (0, 4):
            return f"exit status {made.returncode}", None
        with next(Path(out).glob("*.summary.csv")).open(newline="") as lines:
            summary = {row[0]: row[1] for row in csv.reader(lines)}
    ledger = summary.get("gas_residual_relative")
    if made.returncode == 4:
        return "stopped: " + re.split(extremes.PLACE, summary["status"])[0].split(" (")[0].split(":")[0], ledger and float(ledger)
    return "done", ledger and float(ledger)


def quantiles(values: list[float]) -> list[str]:
    values = sorted(values)
    return [f"{values[min(len(values) - 1, len(values) * share // 100)]:.1g}" for share in SHARES] if values else ["-"] * len(SHARES)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=3600)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--program", type=Path, help="program to run (default: the release build)")
    options = parser.parse_args()
    program = options.program.resolve() if options.program else built_program()
    extremes = module_of(TOP / "tests" / "judge" / "extremes")
    ends, ledgers, tight_ends, tight, poor = collections.Counter(), [], collections.Counter(), [], []
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        scenes = extremes.scenes(options.scenes, options.seed, EVALUATIONS, Path(folder), charges=1.0)

        def both(scene) -> tuple:
            _, base, settings = scene
            first = outcome(extremes, program, base, settings)
            if first[0] != "done" or first[1] is None:
                return first, None
            more = {"integrator.relative_tolerance": repr(TIGHT), "integrator.max_evaluations": str(5 * EVALUATIONS)}
            return first, outcome(extremes, program, base, settings | more)

        for i, (first, second) in enumerate(pool.map(both, scenes)):
            ends[first[0]] += 1
            if second is None:
                continue
            ledgers.append(abs(first[1]))
            tight_ends[second[0]] += 1
            if second[0] == "done":
                tight.append(abs(second[1]))
                poor += [str(i)] if tight[-1] > LIMIT else []
    rows = [["at the tolerance of the scene, mostly 1e-6", str(len(ledgers)), *quantiles(ledgers)], [f"at {TIGHT:g}", str(len(tight)), *quantiles(tight)]]
    text = f"{options.scenes} random scenes: " + ", ".join(f"{number} {end}" for end, number in ends.most_common()) + ".\n\n"
    text += f"The residual of the gas's energy over its work, of the {len(ledgers)} that end well with pressure and mass as states:\n\n"
    text += table(("", "runs", *(f"{share} %" for share in SHARES)), rows) + "\n\n"
    text += f"At {TIGHT:g} they end so: " + ", ".join(f"{number} {end}" for end, number in tight_ends.most_common()) + f"; {len(poor)} of those that are done keep it less well than to {LIMIT:g}"
    text += f": `tests/judge/extremes --scenes {options.scenes} --seed {options.seed} --charges 1 --evaluations {EVALUATIONS} --again N`, N = {', '.join(poor)}." if poor else "."
    print(write_table("gas", "Gas with a mass", f"scripts/bench/measure_gas.py --scenes {options.scenes} --seed {options.seed}", text))
    return 0


if __name__ == "__main__":
    sys.exit(main())
