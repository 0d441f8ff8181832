#!/usr/bin/env python3
"""Samples the ranges of a study: writes a table of runs, and the study that runs it.

    scripts/sample_study.py STUDY.nml --runs 512                          Sobol points: NAME.sobol.nml and NAME.sobol.csv
    scripts/sample_study.py STUDY.nml --runs 1000 --design latin_hypercube --seed 7 -o DIR
    gudgeon sweep results/NAME.sobol.nml

The ranges are those of the &parameter groups of the study (from, to, scale); its settings are kept. The points are those of SciPy's
qmc: the same seed gives the same points. Both files are written into --out (default: results).
"""

import argparse
import sys
from pathlib import Path

from gudgeon_plots.environment import TOP, use_virtual_environment

use_virtual_environment(more=("scipy", "f90nml"))

import numpy as np  # noqa: E402
from scipy.stats import qmc  # noqa: E402

from gudgeon_plots import study  # noqa: E402
from gudgeon_plots.results import MissingResult  # noqa: E402

DESIGNS = {"sobol": qmc.Sobol, "latin_hypercube": qmc.LatinHypercube}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", type=Path, metavar="STUDY.nml")
    parser.add_argument("--runs", type=int, required=True, metavar="N", help="number of runs; for sobol best a power of 2")
    parser.add_argument("--design", choices=DESIGNS, default="sobol", help="(default: sobol)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the points (default: 1)")
    parser.add_argument("-o", "--out", type=Path, default=TOP / "results", metavar="DIR", help="(default: results)")
    options = parser.parse_args()
    try:
        given = study.read_study(options.study)
        unit = DESIGNS[options.design](len(given.parameters), rng=np.random.default_rng(options.seed)).random(options.runs)
        low, high = np.transpose([parameter.bounds for parameter in given.parameters])
        values = np.column_stack([p.value(column) for p, column in zip(given.parameters, (low + (high - low) * unit).T)])
        title = f"{given.settings.get('title', given.name)}: {options.design}, {options.runs} runs, seed {options.seed}"
        print(study.write_table_study(given, values, options.out, f"{given.name}.{options.design}", title))
    except (MissingResult, OSError) as problem:
        print(f"sample_study.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
