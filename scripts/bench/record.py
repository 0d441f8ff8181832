#!/usr/bin/env python3
"""Runs a command that prints a table, and writes its output to data/measured/NAME.md, after the command, the date and the machine.

    scripts/bench/record.py NAME TITLE COMMAND [ARGUMENT ...]
    scripts/bench/record.py costs "What a model costs" scripts/bench/measure_costs

The lines are also shown on standard error as they are printed. If the command fails, an existing file is not changed.
"""
import shlex
import subprocess
import sys

from measured import write_table


def main() -> int:
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    name, title, *command = sys.argv[1:]
    lines = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            lines.append(line)
            print(line, end="", file=sys.stderr, flush=True)
    text = "".join(lines)
    if process.returncode != 0 or not text.strip():
        print(f"record: {shlex.join(command)}: exit status {process.returncode}, nothing written", file=sys.stderr)
        return 1
    print(write_table(name, title, shlex.join(command), text))
    return 0


if __name__ == "__main__":
    sys.exit(main())
