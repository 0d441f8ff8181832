#!/usr/bin/env python3
"""Measures the trade between accuracy and cost of the wear that a run counts, and writes data/measured/wear.md.

    scripts/bench/measure_wear.py               all tables
    scripts/bench/measure_wear.py --out DIR     into another folder

Cost is counted in evaluations of the scene, so that the tables are the same on a busy machine.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from measured import FOLDER, built_program, run, table, use_virtual_environment, write_table

use_virtual_environment()

import numpy as np
import pandas as pd

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
REFERENCE = 1e-12
ROUND = ("wear.bore=round", "wear.extrapolation=1")

#: Scenes with wear: title, case, settings. The motion of each is not chaotic over the time simulated.
SCENES = (
    ("line: `wear/flores`, half a revolution", "wear/flores", ("integrator.revolutions=0.5",)),
    ("conformal arc: `contact/conformal_exact`, half a revolution", "contact/conformal_exact",
     ("wear.rate=1e-14,1e-14", "integrator.revolutions=0.5")),
    ("arc in a liner: `wear/worn_bore`, counted in a round bore, half a revolution", "wear/worn_bore", (*ROUND, "integrator.revolutions=0.5")),
    ("asperities: `film/sim_IV_mixed`, thin oil, one revolution", "film/sim_IV_mixed",
     ("lubrication.variant=short", "lubrication.viscosity=0.002", "wear.rate=1e-16,1e-16", "integrator.revolutions=1")),
)
BINS = (36, 90, 180, 360, 720)
FINEST_BINS = 1440
#: Revolutions that are simulated for the same 8000 of wear.
SIMULATED = (2, 4, 8, 16, 32)
FINEST_SIMULATED = 160


class Runs:
    """Runs of cases in a scratch folder."""

    def __init__(self, folder: str) -> None:
        self.folder, self.program = Path(folder), built_program()

    def __call__(self, case: str, *settings: str) -> tuple[dict[str, float], pd.DataFrame | None]:
        """The numbers of the summary, and the worn surfaces if the run counts wear."""
        base = self.folder / Path(case).name
        summary = {}
        for name, value in run(self.program, case, self.folder, ("output.samples_per_revolution=1", "output.ideal_twin=F", *settings)).items():
            try:
                summary[name] = float(value)
            except ValueError:
                continue
        summary["evaluations"] = summary["rhs_evaluations"] + summary["trace_evaluations"]
        worn = base.with_name(f"{base.name}.wear.csv")
        return summary, pd.read_csv(worn) if worn.exists() else None


def distribution_error(worn: pd.DataFrame, true: pd.DataFrame) -> float:
    """Largest difference of the cumulative volumes of the bore, over its volume; the bins of one are whole parts of the other's."""
    mine, fine = (one["bore_volume[m3]"].cumsum().to_numpy() for one in (worn, true))
    step = len(fine) // len(mine)
    return float(np.abs(mine - fine[step - 1::step]).max() / fine[-1])


def over_tolerances(runs: Runs) -> str:
    parts = ["""## Tolerance

Error of the volume worn from the bore against a run at 1e-12, that of its distribution (largest difference of the cumulative volume over
the volume), and evaluations with and without the group `&wear`."""]
    for title, case, settings in SCENES:
        true, true_worn = runs(case, *settings, f"integrator.relative_tolerance={REFERENCE}")
        rows = []
        for tolerance in TOLERANCES:
            chosen = (*settings, f"integrator.relative_tolerance={tolerance}")
            summary, worn = runs(case, *chosen)
            without, _ = runs(case, *(setting for setting in chosen if not setting.startswith("wear.")), "wear=none")
            error = abs(summary["worn_volume_bore"] / true["worn_volume_bore"] - 1)
            rows.append((f"{tolerance:.0e}", f"{error:.1e}", f"{distribution_error(worn, true_worn):.1e}", f"{summary['evaluations']:.0f}",
                         f"{without['evaluations']:.0f}", f"{summary['evaluations'] / without['evaluations']:.2f}"))
        parts += [f"**{title}**", table(("tolerance", "volume", "distribution", "evaluations", "without wear", "ratio"), rows)]
    return "\n\n".join(parts)


def over_bins(runs: Runs) -> str:
    settings = ("wear.extrapolation=10000", "integrator.revolutions=2.5")
    true, true_worn = runs("wear/worn_bore", *settings, f"wear.bins={FINEST_BINS}")
    rows = []
    for bins in BINS:
        summary, worn = runs("wear/worn_bore", *settings, f"wear.bins={bins}")
        rows.append((str(bins), f"{abs(summary['worn_volume_bore'] / true['worn_volume_bore'] - 1):.1e}",
                     f"{distribution_error(worn, true_worn):.1e}", f"{summary['evaluations']:.0f}"))
    return f"""## Bins of a worn bore

`wear/worn_bore`, 2.5 revolutions with an extrapolation of 10000, against {FINEST_BINS} bins. An evaluation in contact takes time in
proportion to the number of bins that touch.

{table(("bins", "volume", "distribution", "evaluations"), rows)}"""


def over_extrapolation(runs: Runs) -> str:
    def simulated(revolutions: int) -> tuple[dict[str, float], pd.DataFrame]:
        summary, worn = runs("wear/worn_bore", f"integrator.revolutions={revolutions}", f"wear.extrapolation={8000 // revolutions}",
                            "wear.greatest_step_ratio=1")
        assert worn is not None
        return summary, worn

    true, true_worn = simulated(FINEST_SIMULATED)
    rows = []
    for revolutions in SIMULATED:
        summary, worn = simulated(revolutions)
        rows.append((str(revolutions), str(8000 // revolutions), f"{summary['wear_step_over_penetration']:.2f}",
                     f"{abs(summary['worn_volume_bore'] / true['worn_volume_bore'] - 1):.1e}",
                     f"{abs(summary['max_wear_depth_bore'] / true['max_wear_depth_bore'] - 1):.1e}",
                     f"{distribution_error(worn, true_worn):.1e}", f"{summary['evaluations']:.0f}"))
    return f"""## Extrapolation

8000 revolutions of `wear/worn_bore`, of which so many are simulated, against {FINEST_SIMULATED} of them; without the limit of the change of depth. The first
revolution, in which the pin still bounces, weighs more the fewer are simulated.

{table(("simulated", "extrapolation", "change over penetration", "volume", "largest depth", "distribution", "evaluations"), rows)}"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=FOLDER, metavar="DIR", help="folder of the page (default: data/measured)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="wear") as folder:
        runs = Runs(folder)
        text = "\n\n".join((over_tolerances(runs), over_bins(runs), over_extrapolation(runs)))
    print(write_table("wear", "Wear: accuracy and cost", "scripts/bench/measure_wear.py", text, options.out))
    return 0


if __name__ == "__main__":
    sys.exit(main())
