#!/usr/bin/env python3
"""Runs a command that prints a table, and writes what it prints to data/measured/NAME.md behind its command, date and machine.

    scripts/record.py NAME TITLE COMMAND [ARGUMENT ...]
    scripts/record.py costs "What a model costs" scripts/measure_costs

Standard error of the command goes to the terminal. If it fails the file stays as it was.
"""
import shlex
import subprocess
import sys

from gudgeon_plots.measured import write_table


def main() -> int:
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    name, title, *command = sys.argv[1:]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0 or not done.stdout.strip():
        print(f"record: {shlex.join(command)}: exit status {done.returncode}, nothing written", file=sys.stderr)
        return 1
    print(write_table(name, title, shlex.join(command), done.stdout))
    return 0


if __name__ == "__main__":
    sys.exit(main())
