#!/usr/bin/env python3
"""The messages of the program, read from its source: texts of errors, refusals and notes, with `...` for what is filled in.

    scripts/manual/messages.py     prints them as a page of Markdown, by the layer that says them
"""
from __future__ import annotations

import re
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "src"
#: Procedures whose argument is a message, and results that are one.
SAYS = re.compile(r"\bcall (?:\w+%)?(?:fail|refuse\w*|forbid|demand|remark|expect|add_line|tell)\s*\((.*)\)\s*$|^\s*(?:text|reason|message|fault)\s*=\s*(.*)$")
FILES_OF_RESULTS = {"stop_reason", "result_notes", "case_notes", "run_start", "scene_state", "film_balance", "simulation"}   # where `text = ` is a message
TITLES = {"io": "Case files, command line, results", "scene": "Building and running a mechanism", "study": "Studies", "joint": "Joints", "contact": "Contact and wear",
          "friction": "Friction", "film": "Films", "gas": "Gas", "chain": "Mechanism", "model": "Values", "ode": "Integration", "base": "Numbers and units"}


def statements(path: Path) -> list[str]:
    """The statements of a source file, each on one line, without comments."""
    found, open_ = [], ""
    for line in path.read_text(encoding="utf-8").splitlines():
        code = re.sub(r"^((?:[^'!]|'[^']*')*)!.*$", r"\1", line).strip()
        if not code:
            continue
        open_ += code.removeprefix("&").strip() + " "
        if code.endswith("&"):
            open_ = open_.rstrip().removesuffix("&")
            continue
        found.append(open_.strip())
        open_ = ""
    return found


def told(expression: str) -> str:
    """The literals of an expression, joined as they are told, with `...` between them; empty if they are no sentence."""
    pieces = re.findall(r"'((?:[^']|'')*)'|([^']+)", expression)
    text = ""
    for literal, between in pieces:
        if between:
            joined = re.fullmatch(r"\s*//\s*", between)
            if not joined and text and not text.endswith("..."):
                text += "..." if "//" in between else "\n"   # another argument
            elif not joined and not text and "//" in between:
                text = "..."
        else:
            text += literal.replace("''", "'")
    best = re.sub("[#@]", "...", max(text.split("\n"), key=len)).strip()
    if re.fullmatch(r"&\w+ \w+|(\w+\.\w+ ?)+", best):   # names of keys
        return ""
    return best if len(re.sub(r"\W|\d", "", best.replace("...", ""))) > 8 and " " in best.strip(". ") else ""


def messages() -> dict[str, list[str]]:
    """Messages by layer, in the order of the files."""
    found: dict[str, list[str]] = {}
    for path in sorted(SOURCE.rglob("*.f90")):
        layer = path.relative_to(SOURCE).parts[0]
        for statement in statements(path):
            said = SAYS.search(statement)
            if not said or (said[2] is not None and path.stem not in FILES_OF_RESULTS):
                continue
            text = told(said[1] or said[2] or "")
            if "demand" in said[0] and text:
                text = f"required {text}"
            if text and layer in TITLES and text not in found.setdefault(layer, []):
                found[layer].append(text)
    return found


def page() -> str:
    found = messages()
    parts = []
    for layer, title in TITLES.items():
        if found.get(layer):
            parts.append(f"### {title}\n\n" + "".join(f"- `{text.replace('`', '')}`\n" for text in found[layer]))
    return "\n".join(parts)


if __name__ == "__main__":
    print(page())
