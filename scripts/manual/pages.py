#!/usr/bin/env python3
"""Prepares the pages of the manual for scripts/manual.sh.

    scripts/manual/pages.py collect PROGRAM   into build/manual_pages: data/manual, the tables of data/measured and the program's
                                              reference pages
    scripts/manual/pages.py link              changes the links of README.md in build/manual to files of the repository
"""
from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SOURCE = TOP / "data/manual"
MEASURED = TOP / "data/measured"
PAGES = TOP / "build/manual_pages"
BUILT = TOP / "build/manual"
REFERENCE = {"case_file": "case", "results": "results", "studies": "study"}   # page: argument of gudgeon --reference
LINK = re.compile(r"(\]\()([^)#\s]+)(#[^)\s]*)?(\))")


def place_in_manual(path: Path) -> Path | None:
    """Path of a file of the repository among the built pages, if it is a page of the manual."""
    if path.parent in (SOURCE, MEASURED) and path.suffix == ".md":
        name = "findings" if path == MEASURED / "findings.md" else path.stem
        return BUILT / "page" / (name + ".html" if path.parent == SOURCE or name == "findings" else f"measured_{name}.html")
    return TOP / "build/manual/index.html" if path == TOP / "README.md" else None


def relinked(text: str, origin: Path, page: Path) -> str:
    """The Markdown text of the file `origin` with its links changed so that they hold in the built page."""

    def new(match: re.Match[str]) -> str:
        if "://" in match[2]:
            return match[0]
        target = (origin.parent / match[2]).resolve()
        target = place_in_manual(target) or target
        return f"{match[1]}{os.path.relpath(target, page.parent)}{match[3] or ''}{match[4]}"

    return LINK.sub(new, text)


def title_of(text: str, path: Path) -> str:
    found = re.search(r"^# (.+)$", text, re.MULTILINE)
    return found[1] if found else path.stem.replace("_", " ")


def collect(program: str) -> None:
    PAGES.mkdir(parents=True, exist_ok=True)
    tables = []
    for path in sorted(MEASURED.glob("*.md")):
        page = place_in_manual(path)
        text = path.read_text(encoding="utf-8")
        title = title_of(text, path)
        if page.stem != "findings":
            tables.append(f"- [{title}]({page.name})\n")
        body = re.sub(r"^# .*\n+", "", relinked(text, path, page), count=1, flags=re.MULTILINE)   # FORD prints the title
        (PAGES / f"{page.stem}.md").write_text(f"---\ntitle: {title}\n---\n\n{body}", encoding="utf-8")
    for path in sorted(SOURCE.glob("*.md")):
        page = place_in_manual(path)
        text = path.read_text(encoding="utf-8")
        head, _, body = text.partition("\n\n")
        body = re.sub(r"\A# .*\n+", "", relinked(body, path, page))   # FORD prints the title
        if path.stem in REFERENCE:
            body += subprocess.run([program, "--reference", REFERENCE[path.stem]], check=True, capture_output=True, text=True).stdout
        if path.stem == "measured":
            body += "".join(tables)
        (PAGES / path.name).write_text(f"---\n{head}\n---\n\n{body}", encoding="utf-8")


def link() -> None:
    """Change the links of README.md, the first page of the manual, which FORD leaves unchanged."""
    page = BUILT / "index.html"
    text = page.read_text(encoding="utf-8")

    def new(match: re.Match[str]) -> str:
        target = (TOP / match[2]).resolve()
        if "://" in match[2] or (page.parent / match[2]).exists() or not target.exists():
            return match[0]
        return f'{match[1]}"{os.path.relpath(place_in_manual(target) or target, page.parent)}"'

    page.write_text(re.sub(r'((?:href|src)=)"([^"#]+)"', new, text), encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["collect"] and len(sys.argv) == 3:
        collect(sys.argv[2])
    elif sys.argv[1:] == ["link"]:
        link()
    else:
        sys.exit(__doc__)
