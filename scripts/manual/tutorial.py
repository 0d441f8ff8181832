#!/usr/bin/env python3
"""Runs the commands of a tutorial in their order, and compares what they print with what the page shows.

    scripts/manual/tutorial.py PAGE [--program PROGRAM] [--write]     --write: puts what they print into the page, and the
                                                                       pictures that they make, as PNG and SVG, into data/manual/tutorials,
                                                                       those of a page NAME_pt.md with the ending _pt
    scripts/manual/tutorial.py PAGE --notebook                         prints the page as a notebook for Jupyter

A block after a line that ends with "`NAME`:" is a file. In a block that begins with "$ " each such line is a command, run in the folder of the files, and the lines behind it are its output; `...` stands for anything, and numbers may be off by
2e-3 of their value, with ~ before them by a third. The widths of the columns of a table do not matter.
"""
from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
BLOCK = re.compile(r"^(\S[^\n]*)\n\n((?:    [^\n]*\n|\n(?=    ))+)", re.MULTILINE)
FILE = re.compile(r"`([\w.]+\.\w+)`[^`]*:$")
COMMAND = re.compile(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", re.MULTILINE)
PORTUGUESE = "_pt"   # end of the name of a page in Portuguese, and of its pictures
PICTURE = re.compile(r"^!\[[^]]*\]\(tutorials/([^)]*)\)\n", re.MULTILINE)


def blocks(text: str) -> list[tuple[str, str, str]]:
    """The indented blocks of a page, each with the line before it and its text as it stands."""
    return [(block[1], unindented(block[2]), block[2]) for block in BLOCK.finditer(text)]


def unindented(block: str) -> str:
    return "".join(line[4:] if line.strip() else "\n" for line in block.splitlines(keepends=True))


def commands(text: str) -> list[str]:
    """All commands of a page."""
    return [line[2:] for _, body, _ in blocks(text) for line in body.splitlines() if line.startswith("$ ")]


def alike(shown: str, printed: str) -> bool:
    """Whether a printed line is the shown one."""
    shown, printed = (re.sub(r"--+", "--", re.sub(" +", " ", line)) if line.startswith("|") else line for line in (shown, printed))
    parts = [re.escape(NUMBER.sub("#", part.replace("~", ""))) for part in shown.split("...")]
    if not re.fullmatch(".*".join(parts), NUMBER.sub("#", printed)):
        return False
    if "..." in shown:
        return True
    pairs = zip(NUMBER.finditer(shown), NUMBER.findall(printed))
    return all(abs(float(a[0]) - float(b)) <= (0.33 if shown[: a.start()].endswith("~") else 2e-3) * max(abs(float(a[0])), abs(float(b))) for a, b in pairs)


def run(page: Path, program: Path, write: bool = False) -> list[str]:
    """What is wrong in the page, one line each."""
    text = page.read_text(encoding="utf-8")
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder, "work")
        work.mkdir()
        (Path(folder) / "gudgeon").symlink_to(program)
        path = f"{folder}:{TOP / '.venv/bin'}:{os.environ['PATH']}"
        for before, body, block in blocks(text):
            name = FILE.search(before)
            if not body.startswith("$ "):
                if name:
                    with (work / name[1]).open("w", encoding="utf-8") as file:
                        file.write(body)
                continue
            now = ""
            for command, shown in COMMAND.findall(body):
                done = subprocess.run(command, shell=True, cwd=work, capture_output=True, text=True, env={**os.environ, "PATH": path})
                printed = re.sub(r"(\.csv; )\d+ steps, .*", r"\1...", done.stdout.rstrip("\n"))   # steps and times differ with compilers
                lines = shown.rstrip("\n").splitlines()
                fresh = [line if line in lines or i >= len(lines) or not alike(lines[i], line) else lines[i] for i, line in enumerate(printed.splitlines())]
                now += "".join(f"    {line}\n" for line in [f"$ {command}", *fresh])
                if write and [one for one in (work / "results").glob("*.png") if not one.with_suffix(".svg").exists()]:   # as vectors too
                    vectors = command.replace(".png", ".svg") if ".png" in command else f"{command.partition(' |')[0]} --format svg"
                    subprocess.run(vectors, shell=True, cwd=work, capture_output=True, check=True, env={**os.environ, "PATH": path})
                if done.returncode:
                    wrong.append(f"{command}: exit status {done.returncode}: {done.stderr[-300:]}")
                elif len(lines) != len(printed.splitlines()) or not all(map(alike, lines, printed.splitlines())):
                    wrong.append(f"{command} prints: {printed}")
            text = text.replace(block, now)
        if write:
            from gudgeon.plots.style import fewer_colours  # only here: needs .venv

            for picture in sorted((work / "results").glob("*.*g")):
                kept = TOP / "data/manual/tutorials" / f"{picture.stem}{PORTUGUESE if page.stem.endswith(PORTUGUESE) else ''}{picture.suffix}"
                shutil.copy(picture, kept)
                if kept.suffix == ".png":
                    fewer_colours(kept)
    if write:
        page.write_text(text, encoding="utf-8")
    return wrong


def notebook(text: str) -> str:
    """A page as a notebook for Jupyter: its files and commands are cells that run, with the outputs of the page; pictures are shown where
    the page has them."""
    cells: list[dict[str, object]] = []

    def code(source: str, output: str = "") -> None:
        outputs = [{"output_type": "stream", "name": "stdout", "text": output}] if output.strip() else []
        cells.append({"cell_type": "code", "execution_count": None, "metadata": {}, "source": source, "outputs": outputs})

    def prose(part: str) -> None:
        texts = PICTURE.split(part)   # texts and, between them, names of pictures
        for i, one in enumerate(texts):
            if i % 2:
                code(f'from IPython.display import Image\n\nImage("results/{one.replace(PORTUGUESE + ".", ".")}")')
            elif plain := re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", one).strip():
                cells.append({"cell_type": "markdown", "metadata": {}, "source": plain})

    end = 0
    for block in BLOCK.finditer(text):
        prose(text[end : block.start(2)])
        end, body, name = block.end(2), unindented(block[2]), FILE.search(block[1])
        if body.startswith("$ "):
            for command, output in COMMAND.findall(body):
                code(f"%%bash\n{command}", output)
        elif name:
            code(f"%%writefile {name[1]}\n{body.rstrip()}")
        else:
            prose(f"```\n{body}```")
    prose(text[end:])
    metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    return json.dumps({"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 4}, ensure_ascii=False, indent=1)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path)
    parser.add_argument("--program", type=Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--notebook", action="store_true")
    options = parser.parse_args()
    if options.notebook:
        print(notebook(options.page.read_text(encoding="utf-8")))
        return 0
    program = options.program or TOP / subprocess.run([TOP / "scripts/build.sh"], check=True, capture_output=True, text=True).stdout.strip()
    wrong = run(options.page, program.resolve(), options.write)
    print("\n".join(wrong))
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
