#!/usr/bin/env python3
"""Merges the result files of a study's chunks into the files that one process would have written, byte for byte.

    scripts/cluster/merge_runs.py DIR/NAME OUT [A-B...]    merge DIR/NAME.A-B.runs.csv of the given chunks (default: of all
                                                           chunks found) into OUT/NAME.runs.csv
    gudgeon sweep --check STUDY.nml | scripts/cluster/merge_runs.py --count    print the number of runs of the study

NAME.cycles.csv and NAME.strobe.csv are merged as well if the chunks have them. The chunks must follow one another without a gap,
beginning with run 1, and their first lines must be equal. Only the standard library of Python is needed.
"""

import argparse
import os
import re
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

KINDS = ("runs", "cycles", "strobe")


class BadChunks(Exception):
    """Chunks that do not make up a study."""


Chunk = tuple[int, int, Path]  # first run, last run, file


def chunks_of(prefix: Path, kind: str, ranges: Sequence[str] = ()) -> list[Chunk]:
    """The files of the chunks in the order of their runs: those of `ranges` (A-B), or all that are found."""
    pattern = re.compile(re.escape(prefix.name) + rf"\.(\d+)-(\d+)\.{kind}\.csv")
    names = (f"{prefix.name}.{range_}.{kind}.csv" for range_ in ranges)
    paths = [prefix.with_name(name) for name in names] if ranges else list(prefix.parent.iterdir())
    matches = [(pattern.fullmatch(path.name), path) for path in paths]
    return sorted((int(match[1]), int(match[2]), path) for match, path in matches if match)


def check_order(chunks: list[Chunk]) -> None:
    """Refuse gaps and overlaps."""
    expected = 1
    for first, last, path in chunks:
        if first != expected:
            what = f"runs {expected} to {first - 1} are missing" if first > expected else "overlaps the chunk before it"
            raise BadChunks(f"{path}: {what}")
        expected = last + 1


def check_rows(lines: Iterable[bytes], first: int, last: int, every: bool, path: Path) -> Iterable[bytes]:
    """The lines of a chunk. Their first field must be a run number from `first` to `last`, in order; `every`: each number exactly
    once."""
    expected = first
    for line in lines:
        field = line.split(b",", 1)[0]
        if not line.endswith(b"\n"):
            raise BadChunks(f"{path}: ends within a row")
        run = int(field) if field.isdigit() else -1
        if not expected <= run <= last or (every and run != expected):
            raise BadChunks(f"{path}: run {expected} expected, found {field.decode(errors='replace')!r}")
        expected = run + 1 if every else run
        yield line
    if every and expected != last + 1:
        raise BadChunks(f"{path}: runs {expected} to {last} are missing")


def merge(chunks: list[Chunk], every: bool, target: Path) -> None:
    """Write one file of all chunks, complete and flushed to the disk, or none; `every`: with each run exactly once."""
    check_order(chunks)
    partial = target.with_name(target.name + ".partial")
    partial.unlink(missing_ok=True)
    header = None
    with partial.open("xb") as out:  # "x": a link of that name is not followed
        for first, last, path in chunks:
            with path.open("rb") as file:
                head = file.readline()
                if header is None:
                    header = head
                    out.write(head)
                elif head != header:
                    raise BadChunks(f"{path}: its first line is not that of {chunks[0][2]}")
                # the only line break of a row is at its end
                out.writelines(check_rows(file, first, last, every, path))
        out.flush()
        os.fsync(out.fileno())
    os.replace(partial, target)


def merge_all(prefix: Path, out: Path, ranges: Sequence[str]) -> None:
    """Merge every kind of file that the chunks have. The file of runs is written last: if it exists, the others are complete."""
    out.mkdir(parents=True, exist_ok=True)
    for kind in reversed(KINDS):
        chunks = chunks_of(prefix, kind, ranges)
        if kind == "runs" and not chunks:
            raise BadChunks(f"{prefix}.A-B.runs.csv: no such chunk")
        if kind == "runs" or any(path.exists() for _, _, path in chunks):
            merge(chunks, kind == "runs", out / f"{prefix.name}.{kind}.csv")


def count_of(text: str) -> int:
    """The number of runs that `gudgeon sweep --check` prints, also where some of the runs would fail."""
    found = re.findall(r"\b(\d+) runs?\b", text)
    if len(found) != 1:
        raise BadChunks(f"gudgeon sweep --check prints no number of runs: {text.strip()!r}")
    return int(found[0])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", action="store_true", help="print the number of runs found in the text on standard input")
    parser.add_argument("chunks", nargs="?", type=Path, metavar="DIR/NAME")
    parser.add_argument("out", nargs="?", type=Path, metavar="OUT")
    parser.add_argument("ranges", nargs="*", metavar="A-B")
    options = parser.parse_args()
    try:
        if options.count:
            print(count_of(sys.stdin.read()))
            return 0
        if options.chunks is None or options.out is None:
            parser.error("DIR/NAME and OUT are needed")
        merge_all(options.chunks, options.out, options.ranges)
    except (BadChunks, OSError) as problem:
        print(f"merge_runs.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
