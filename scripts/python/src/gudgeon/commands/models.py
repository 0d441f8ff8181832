"""Which models a case needs: the effect and the cost of each model of a scene.

    gudgeon-plot models cases/sim_I.nml
    gudgeon-plot models cases/joints/both_pins.nml --within 0.02 --quantities peak_force loss
    gudgeon-plot models cases/sim_III.nml --set integrator.revolutions=2

Runs the case with models removed, exchanged, refined and added, one at a time: members (rigid, elastic), contact laws and
geometries, film, friction, clearance at each joint, a film that carries an ideal pin (kind quasi_static) between both, the ideal twin, gas, gravity, the drive. The possible models are found from the
case itself and `gudgeon --template`. Each scene is certified (`gudgeon --certify`), and its cost is the shortest processor time of
three runs. Ends with the cheapest scene whose quantities are within --within of those of the most complete scene, the case with all
refinements and additions.

Prints a table in Markdown, and writes models_NAME.csv, all figures, and models_NAME.png, change and cost of each model. Exit status 1
where the case cannot be run.
"""

import argparse
import sys
from pathlib import Path

from gudgeon import language
from gudgeon.commands import FORMATS, Refused, add_output
from gudgeon.models import table
from gudgeon.models.effects import QUANTITIES, Laboratory, find_cheapest
from gudgeon.models.variants import Variant, case_name
from gudgeon.plots import style
from gudgeon.program import MissingResult, release_program
from gudgeon.results import default_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", type=Path, metavar="CASE.nml")
    parser.add_argument("--within", type=float, default=0.05, metavar="PART", help="allowed relative difference (default: 0.05, 5 %%)")
    parser.add_argument("--quantities", nargs="+", choices=tuple(QUANTITIES), default=list(QUANTITIES),
                        help="quantities that are compared (default: all)")
    parser.add_argument("--set", action="append", default=[], metavar="GROUP.KEY=VALUE", help="change a key of the case; repeatable")
    parser.add_argument("--timeout", type=float, default=300.0, metavar="S", help="longest time of a run (default: 300)")
    parser.add_argument("--program", type=Path, help="program to run (default: the fast build)")
    add_output(parser, "results", several=True)


def run(options: argparse.Namespace) -> int:
    if not options.case.is_file():
        raise Refused(f"no such case: {options.case}")
    if not 0 < options.within < 1:
        raise Refused(f"--within {options.within:g}: must be > 0 and < 1")
    name = language.current.keep(case_name(options.case))
    laboratory = Laboratory(
        options.case.resolve(),
        options.program or release_program(),
        ["integrator.method=auto", *options.set],
        options.timeout,
        lambda what: print(f"{name}: {what}", file=sys.stderr, flush=True),
    )
    try:
        variants = laboratory.read_base()
        for setting in (setting for variant in variants for setting in variant.settings):
            language.current.keep(setting.partition("=")[2])   # words of keys
        outcomes = [laboratory.measure(variant) for variant in (Variant("given", "the case as it is", ()), *variants)]
        if not outcomes[0].is_there:
            raise MissingResult(outcomes[0].refusal)
        search = find_cheapest(laboratory, outcomes, options.quantities, options.within)
    finally:
        laboratory.close()
    out = options.out or default_folder()
    out.mkdir(parents=True, exist_ok=True)
    data = table.as_data(outcomes)
    data.to_csv(out / f"models_{name}.csv", index=False)
    drawing = table.draw(name, data, options.quantities, options.within)
    style.adapt(drawing, options.title, options.label, options.size)
    print(*style.save(drawing, out, f"models_{name}", options.format or FORMATS[:1]), file=sys.stderr)
    print(table.as_markdown(str(options.case), outcomes, search, options.quantities, options.within))
    return 0
