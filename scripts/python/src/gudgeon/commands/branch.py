"""Follows a branch of periodic orbits of a case over a key, and draws it with its flips, folds and ends.

    gudgeon-plot branch flores.nml initial.crank_speed 1000 650
    gudgeon-plot branch flores.nml initial.crank_speed 1000 650 --doubled 1 --over results/speeds.strobe.csv

The branch begins with the motion to which the case settles at FROM. Stable orbits are drawn as full lines, unstable ones dashed, special
points as circles, strobes of a study over the same key as grey points. Prints what was found and writes NAME.branch.png and

    NAME.branch.csv    a row for each orbit: key, kind of a special point, multipliers, exponent [1/revolution], state, events, accuracy
"""

import argparse
from pathlib import Path

import pandas as pd

import gudgeon
from gudgeon import language
from gudgeon.commands import Refused, add_output, number, save
from gudgeon.names import PLACES, plain_unit, shown_unit
from gudgeon.plots.strobes import read_strobe
from gudgeon.plots.style import WIDTH, add_legend, plt
from gudgeon.study import Runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", type=Path, metavar="CASE.nml", help="case file")
    parser.add_argument("key", metavar="KEY", help="such as joint.clearance, or held.impact_speed")
    parser.add_argument("start", type=float, metavar="FROM", help="value in SI units, at which the case settles to an orbit")
    parser.add_argument("end", type=float, metavar="TO", help="value at which the branch is left")
    parser.add_argument("--revolutions", type=number(1, whole=True), metavar="K", help="of one period (default: that to which the case settles)")
    parser.add_argument("--held", type=number(0, itself=False), metavar="SPEED", help="impact speed [m/s] of contacts that last for the whole period")
    parser.add_argument("--doubled", type=number(0, whole=True), default=0, metavar="N", help="follow so many doublings, each from the first flip")
    parser.add_argument("--points", type=number(2, whole=True), default=60, metavar="N", help="at most so many orbits on a branch (default: 60)")
    parser.add_argument("--column", default="eccentricity_y", metavar="NAME", help="of NAME.branch.csv (default: eccentricity_y)")
    parser.add_argument("--over", type=Path, metavar="STROBE.csv", help="strobes of a study over the same key")
    add_output(parser, "results")


def require(table: pd.DataFrame, *names: str) -> None:
    """Refuse columns that a table does not have."""
    for name in names:
        if name not in table:
            raise Refused(f"no column {name}; there are: {', '.join(table.columns)}")


def finding(table: pd.DataFrame, key: str, unit: str) -> str:
    """Where the period doubles, for the title."""
    flips = table.loc[table["kind"] == "flip", key].to_numpy()
    shown, factor = shown_unit(key, unit, flips)
    return f"the period doubles at {', '.join(f'{factor * value:.3g}' for value in flips)} {plain_unit(shown)}" if len(flips) else "periodic orbits"


def run(options: argparse.Namespace) -> int:
    limits = (options.start, options.end)
    for name in (options.key, *PLACES):
        language.current.keep(name)
    over = None
    if options.over is not None:
        over = read_strobe(options.over, Runs.read(Path(str(options.over).replace(".strobe.csv", ".runs.csv"))))
        require(over, options.column, options.key)
    try:
        case = gudgeon.read(options.case)
        at_start = case if options.key.startswith("held.") else case.set({options.key: options.start})
        start = gudgeon.orbit(at_start, options.revolutions, held=options.held)
        print(language.current.say(str(start)))
        branches = [gudgeon.continuation(case, options.key, limits, start=start, points=options.points, both=False)]
        print(language.current.say(str(branches[0])))
        for _ in range(options.doubled):
            branches.append(branches[-1].doubled(0, points=options.points))
            print(language.current.say(str(branches[-1])))
    except (gudgeon.OrbitError, gudgeon.CaseError, KeyError) as problem:
        raise Refused(problem.args[0].replace("give start= or revolutions=", "give --revolutions")) from None
    table = pd.concat([branch.points for branch in branches])
    language.current.keep(options.case.stem)
    folder = options.out if options.out and not options.out.suffix else options.out.parent if options.out else Path("results")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{options.case.stem}.branch.csv"
    table.to_csv(path, index=False)
    print(path)
    require(table, options.column)
    drawing, axes = plt.subplots(figsize=(WIDTH, 3.6))
    for i, branch in enumerate(branches):
        branch.plot(options.column, over if i == 0 else None, axes)
    axes.set_xlim(*sorted(axes.get_xlim()))
    add_legend(drawing, [axes])
    drawing.suptitle(f"{options.case.stem}: {finding(table, options.key, branches[0].units[options.key])}")
    save(drawing, options, folder, f"{options.case.stem}.branch")
    return 0
