"""The command `gudgeon-plot WHAT [RUN...] [-o PATH] [--language pt]`, also `python -m gudgeon WHAT`."""

import argparse
import importlib
import os
import signal
import sys

#: What can be drawn: the module of gudgeon.commands with this name does it.
WHAT = {
    "columns": "columns of runs over time or crank angle",
    "compare": "two runs in one picture, their difference, and how long they agree",
    "table": "answers of runs side by side in readable units, or the rows of a study (draws nothing)",
    "export": "the trace and the summary of runs for a spreadsheet, with decimal commas (draws nothing)",
    "report": "an HTML page about one run: animation, plots, case, summary, warnings",
    "explore": "a page whose sliders run a case: mechanism, orbits, curves and answers at once",
    "figure": "figures of the dissertation",
    "orders": "settled cycles of a run: orders, means and scatter, work, loads on the bearings",
    "indicator": "pressure over volume, losses of valves, the heat that a pressure shows",
    "bearing": "the orbit of a pin in its clearance circle, in fixed axes and in those of the load",
    "campbell": "critical speeds of a crankshaft: natural frequencies, orders, shapes",
    "branch": "periodic orbits of a case over a key: stability, flips, folds, ends",
    "film": "the pressure in a film at chosen times",
    "skirt": "a piston in its bore: pressure on its skirt, gaps, friction of skirt and rings, Stribeck curves",
    "wear": "worn surfaces of pins and bores",
    "laws": "forces of contact and friction of runs over penetration and sliding speed",
    "study": "a parameter study: curves, maps or points",
    "models": "which models a case needs: effect and cost of each",
    "sensitivity": "how the results of a study depend on its parameters, by Morris and Sobol",
    "sample": "a random design of a study, for gudgeon sweep (draws nothing)",
}


def usage() -> str:
    lines = ["usage: gudgeon-plot WHAT [RUN...] [-o PATH] [--language pt]", ""]
    lines += [f"  {what:12} {said}" for what, said in WHAT.items()]
    lines += ["", "RUN is a case file, whose results are in results/ or beside it, a trace, or the name of a run in results/.",
              "Pictures are written beside the data.",
              "gudgeon-plot WHAT --help has the options of each."]
    return "\n".join(lines)


def main(words: list[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    words = sys.argv[1:] if words is None else words
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)   # gudgeon-plot --help | head
    if not words or words[0] in ("-h", "--help"):
        print(usage())
        return 0
    before = next((i for i, word in enumerate(words) if word in WHAT), 0)   # --language pt may stand before WHAT
    what, *rest = words[before], *words[:before], *words[before + 1 :]
    if what not in WHAT:
        from gudgeon._library import meant

        print(f"gudgeon-plot: {what}: must be one of {', '.join(WHAT)}{meant(what, list(WHAT))}", file=sys.stderr)
        return 2
    name = f"gudgeon-plot {what}"
    try:
        return run(name, what, rest)
    except ModuleNotFoundError as lacking:
        packages = "in a checkout: scripts/setup.sh --python, or pip install './scripts/python[plots]'"
        print(f"{name}: needs the Python package {lacking.name}: {packages}", file=sys.stderr)
        return 1


def run(name: str, what: str, words: list[str]) -> int:
    """Run the command `what`; what it needs is imported here."""
    os.environ["MPLBACKEND"] = "Agg"
    from gudgeon import language
    from gudgeon.commands import Refused
    from gudgeon.program import MissingResult

    command = importlib.import_module(f"gudgeon.commands.{what}")
    parser = argparse.ArgumentParser(prog=name, description=command.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    command.add_arguments(parser)
    language.add_option(parser)
    options = parser.parse_args(words)
    try:
        status = command.run(options)
    except Refused as problem:
        parser.error(str(problem))
    except (MissingResult, OSError) as problem:
        print(f"{name}: {problem}", file=sys.stderr)
        return 1
    language.current.warn(name)
    return status


if __name__ == "__main__":
    sys.exit(main())
