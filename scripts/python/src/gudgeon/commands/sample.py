"""Samples the ranges of a study: writes a table of runs, and the study that runs it.

    gudgeon-plot sample STUDY.nml --runs 512                          Sobol points: NAME.sobol.nml and NAME.sobol.csv
    gudgeon-plot sample STUDY.nml --runs 1000 --design latin_hypercube --seed 7 -o DIR
    gudgeon sweep results/NAME.sobol.nml

The ranges are those of the &parameter groups of the study (from, to, scale); its settings are kept. The points are those of SciPy's
qmc: the same seed gives the same points. Both files are written into --out (default: results).
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from gudgeon import study
from gudgeon.results import default_folder

DESIGNS = {"sobol": qmc.Sobol, "latin_hypercube": qmc.LatinHypercube}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("study", type=Path, metavar="STUDY.nml")
    parser.add_argument("--runs", type=int, required=True, metavar="N", help="number of runs; for sobol best a power of 2")
    parser.add_argument("--design", choices=DESIGNS, default="sobol", help="(default: sobol)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the points (default: 1)")
    parser.add_argument("-o", "--out", type=Path, metavar="DIR", help="(default: results)")


def run(options: argparse.Namespace) -> int:
    given = study.read_study(options.study)
    unit = DESIGNS[options.design](len(given.parameters), rng=np.random.default_rng(options.seed)).random(options.runs)
    low, high = np.transpose([parameter.bounds for parameter in given.parameters])
    values = np.column_stack([p.value(column) for p, column in zip(given.parameters, (low + (high - low) * unit).T)])
    title = f"{given.settings.get('title', given.name)}: {options.design}, {options.runs} runs, seed {options.seed}"
    print(study.write_table_study(given, values, options.out or default_folder(), f"{given.name}.{options.design}", title))
    return 0
