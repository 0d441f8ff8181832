#!/usr/bin/env python3
"""Prepares the pages of the manual for scripts/manual.sh.

    scripts/manual/pages.py collect PROGRAM   into build/manual_pages: data/manual, its tutorials as notebooks too, the tables of
                                              data/measured, the pages of other folders that they refer to, the program's reference
                                              pages, and every file with a link to it
    scripts/manual/pages.py local             replaces what the pages of FORD load from a network by files in build/manual_pages/api
    scripts/manual/pages.py number            puts the numbers of the pages of build/manual/gudgeon.pdf into the contents of print.html, from
                                              which Chromium prints it again
"""
from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import messages
import tutorial

TOP = Path(__file__).resolve().parents[2]
SOURCE = TOP / "data/manual"
MEASURED = TOP / "data/measured"
BESIDE = Path(__file__).resolve().parent
PAGES = TOP / "build/manual_pages"
API = PAGES / "api"
REFERENCE = {"case_file": "case", "results": "results", "studies": "study", "oils": "oils"}   # page: argument of gudgeon --reference
OTHERS = ("CONTRIBUTING.md", "CHANGELOG.md", "cases/README.md", "cases/studies/README.md", "data/README.md", "tests/README.md",
          "scripts/bench/README.md", "scripts/cluster/README.md")   # pages of other folders that the manual has
LINK = re.compile(r"(!\[[^\]]*\]\(|\]\()([^)#\s]+)(#[^)\s]*)?(\))")


def place_in_manual(path: Path) -> Path:
    """Place of a file of the repository below PAGES: pages side by side, other files as they are in files/."""
    if path == TOP / "README.md":   # the manual begins with a page of its own
        return PAGES / "index.md"
    if path.parent in (SOURCE, BESIDE):
        return PAGES / path.name
    if path.suffix != ".md":
        return PAGES / "files" / path.relative_to(TOP)
    if path.parent == MEASURED:
        return PAGES / f"measured_{path.name}"
    words = [word for word in path.relative_to(TOP).with_suffix("").parts if word not in ("README", "data", "manual", "scripts")]
    return PAGES / ("_".join(words or path.relative_to(TOP).with_suffix("").parts).lower() + ".md")


def shown(picture: Path) -> Path:
    """What the manual shows of a picture: the vectors beside it, where there are any."""
    vectors = picture.with_suffix(".svg")
    return vectors if vectors.exists() else picture


def relinked(text: str, origin: Path, page: Path, wanted: set[Path]) -> str:
    """The Markdown text of the file `origin` with its links changed so that they hold in `page`; the files are added to `wanted`."""

    def new(match: re.Match[str]) -> str:
        target = (origin.parent / match[2]).resolve()
        if match[1].startswith("!"):
            target = shown(target)
        if "://" in match[2] or match[2].startswith("mailto:") or TOP not in target.parents:
            return match[0]
        if target.is_dir():   # a folder is its page, if it has one
            target = target / "README.md"
        if not target.exists():
            return match[0]
        if target != TOP / "README.md":
            wanted.add(target)
        return f"{match[1]}{os.path.relpath(place_in_manual(target), page.parent)}{match[3] or ''}{match[4]}"

    return LINK.sub(new, text)


def title_of(page: Path) -> str:
    return re.search(r"^# (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)[1]


def reference(program: str, subject: str) -> str:
    return subprocess.run([program, "--reference", subject], check=True, capture_output=True, text=True).stdout


def rungs(question: str, page: Path, wanted: set[Path]) -> str:
    """The measured effect and cost of each rung of a question, as a section of its page."""
    path = MEASURED / "rungs.md"
    found = re.search(rf"^## {question}\n(.*?)(?=^## |\Z)", path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    return f"\n## Effect and cost\n{relinked(found[1], path, page, wanted)}"


def gallery() -> str:
    """Every picture of the checkout, but for those in Portuguese, with its question and its command, as a table; drawings last. It leads to its vectors, and says where its
    pixels are."""
    with (TOP / "data/pictures.csv").open(encoding="utf-8", newline="") as lines:
        listed = sorted(csv.DictReader(lines), key=lambda row: row["picture"].endswith(".svg"))
    rows = []
    for row in (row for row in listed if not Path(row["picture"]).stem.endswith(tutorial.PORTUGUESE)):
        picture = os.path.relpath(TOP / row["picture"], SOURCE)
        vectors = os.path.relpath(shown(TOP / row["picture"]), SOURCE)
        pixels = f" [PNG]({picture})" if vectors != picture else ""
        rows.append(f"| [![{row['question']}]({picture})]({vectors}) | **{row['question']}**<br>`{row['command'].replace('|', chr(92) + '|')}`{pixels} |\n")
    return "\n| picture | question and command |\n|---|---|\n" + "".join(rows)


def collect(program: str) -> None:
    shutil.rmtree(PAGES, ignore_errors=True)
    wanted = {path for folder in (SOURCE, MEASURED) for path in folder.glob("*.md")} | {TOP / name for name in OTHERS}
    wanted |= {SOURCE / "manual.css", BESIDE / "iframe-worker.js"}
    done: set[Path] = set()
    while todo := wanted - done:
        for path in todo:
            page = place_in_manual(path)
            page.parent.mkdir(parents=True, exist_ok=True)
            done.add(path)
            if path.suffix != ".md":
                shutil.copy(path, page)
                continue
            text = path.read_text(encoding="utf-8") + (gallery() if path == SOURCE / "gallery.md" else "")
            text = relinked(text, path, page, wanted)
            if path.parent == SOURCE and path.stem in REFERENCE:
                text += reference(program, REFERENCE[path.stem])
            if path.stem.startswith("which_"):
                text += rungs(path.stem.removeprefix("which_").capitalize(), page, wanted)
            if path.stem.startswith("tutorial_"):
                page.with_suffix(".ipynb").write_text(tutorial.notebook(path.read_text(encoding="utf-8")), encoding="utf-8")
                said = "Esta página como notebook" if path.stem.endswith("_pt") else "This page as a notebook"
                text = text.replace("\n\n", f"\n\n[{said}]({page.stem}.ipynb) (Jupyter)\n\n", 1)
            if path == SOURCE / "messages.md":
                text += messages.page()
            if path == SOURCE / "measured.md":
                text += "".join(f"- [{title_of(table)}](measured_{table.name})\n" for table in sorted(MEASURED.glob("*.md")))
            page.write_text(text, encoding="utf-8")


def local() -> None:
    """FORD's pages load Bootstrap from a network; MkDocs has a copy. No comment of the source has equations, so MathJax is left out."""
    import mkdocs

    theme = Path(mkdocs.__file__).parent / "themes/mkdocs"
    for file in ("css/bootstrap.min.css", "js/bootstrap.bundle.min.js"):
        (API / file).parent.mkdir(exist_ok=True)
        shutil.copy(theme / file, API / file)
    for page in API.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        top = os.path.relpath(API, page.parent)
        text = re.sub(r'<link href="https://[^"]*/bootstrap\.min\.css"[^>]*>', f'<link href="{top}/css/bootstrap.min.css" rel="stylesheet">', text)
        text = re.sub(r'<script src="https://[^"]*/bootstrap\.bundle\.min\.js"[^>]*>', f'<script src="{top}/js/bootstrap.bundle.min.js">', text)
        text = re.sub(r'<script src="https://[^"]*MathJax[^>]*></script>', "", text)
        page.write_text(text, encoding="utf-8")


def pages_printed(printed: bytes) -> dict[str, int]:
    """The page of a PDF of Chromium on which each section begins. Its objects stand open in the file: pages in their order, and a list of places."""
    order = {number: i for i, number in enumerate(re.findall(rb"^(\d+) 0 obj\n<</Type /Page\n", printed, re.MULTILINE), 1)}
    return {name.decode(): order[page] for name, page in re.findall(rb"/([\w-]+) \[(\d+) 0 R /XYZ", printed)}


def number() -> None:
    manual = TOP / "build/manual"
    pages = pages_printed((manual / "gudgeon.pdf").read_bytes())
    text = (manual / "print.html").read_text(encoding="utf-8")
    text = re.sub(r'(<span class="page" data-page="([^"]*)">)\d+', lambda place: f"{place[1]}{pages[place[2]]}", text)
    (manual / "print.html").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["collect"] and len(sys.argv) == 3:
        collect(sys.argv[2])
    elif sys.argv[1:] == ["local"]:
        local()
    elif sys.argv[1:] == ["number"]:
        number()
    else:
        sys.exit(__doc__)
