#!/usr/bin/env python3
"""The folders of src are layers: a module uses only modules of its own folder and of lower layers, never of a folder beside or
above it. Above its registry no module names a law. The tests of single models use neither scenes nor case files, so that a changed
model is tested within seconds. Lines of Fortran, comments included, have at most 132 characters. Also: the page on the architecture
names procedures that exist, the version is the same everywhere, and the linters of Fortran and Python are content.

    tests/test_layers.py        (after scripts/setup.sh --lint)

The test reads the `use` statements. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
SRC = TOP / "src"
TESTS = TOP / "tests"

#: The layers from the lowest to the highest; folders in one row must not use each other.
LAYERS = [
    ["base"],
    ["ode", "model"],
    ["chain", "contact", "friction", "film", "gas"],
    ["joint"],
    ["scene"],
    ["io"],
    ["study"],
    ["api", "main"],
]
MOST = 132  # largest number of characters in a line

#: The registries, whose `use` statements name all laws. Only files of the same folder may do so too.
REGISTRIES = ["contact/contact_laws", "friction/friction_laws", "film/films", "gas/gas_laws", "gas/wall_laws"]

RANK = {folder: rank for rank, row in enumerate(LAYERS) for folder in row}


def folder_of(path: Path) -> str:
    """The first folder below src; `main` for the program itself."""
    parts = path.relative_to(SRC).parts
    return parts[0] if len(parts) > 1 else "main"


def modules(files: list[Path]) -> dict[str, str]:
    """Folder of every module."""
    found = {}
    for path in files:
        for name in re.findall(r"^\s*module\s+(?!procedure\b)(\w+)\s*$", path.read_text(), re.M | re.I):
            found[name.lower()] = folder_of(path)
    return found


def used_modules(text: str) -> list[str]:
    return [name.lower() for name in re.findall(r"^\s*use\s+(?:,\s*\w+\s*::\s*)?(\w+)", text, re.M | re.I)]


def wrong_arrows(files: list[Path]) -> list[str]:
    """`use` statements that refer to a higher layer, or to another folder of the same layer."""
    home = modules(files)
    wrong = []
    for path in files:
        folder = folder_of(path)
        for name in used_modules(path.read_text()):
            used = home.get(name)
            if used is None or used == folder:
                continue
            if RANK[used] >= RANK[folder]:
                wrong.append(f"{path.relative_to(SRC.parent)}: {folder} uses {name} of {used}")
    return wrong


def named_laws(files: list[Path]) -> list[str]:
    """`use` statements that refer to a law from another folder, and comparisons of the name of a law with a text."""
    home = modules(files)
    laws = set()
    for registry in REGISTRIES:
        used = used_modules((SRC / f"{registry}.f90").read_text())
        laws |= {name for name in used if home.get(name) == registry.split("/")[0] and not name.endswith(("_law", "_geometry"))}
    wrong = []
    for path in files:
        text = path.read_text()
        folder = folder_of(path)
        wrong += [f"{path.relative_to(SRC.parent)} names the law {name}" for name in used_modules(text) if name in laws and home[name] != folder]
        for name in re.findall(r"(?:contact|geometry|friction|film|law|combustion)%name *(?:==|/=) *'(\w+)'", text):
            wrong.append(f"{path.relative_to(SRC.parent)} asks whether a law is {name}")
    return wrong


def used_by_units() -> set[str]:
    """Layers that the test program of single models uses, by all modules that it needs."""
    files = [path for folder in (SRC, TESTS) for path in folder.rglob("*.f90")]
    by_module = {name: path for path in files for name in re.findall(r"^\s*module\s+(?!procedure\b)(\w+)\s*$", path.read_text(), re.M)}
    reached, waiting = set(), ["units"]
    while waiting:
        name = waiting.pop()
        path = TESTS / "units.f90" if name == "units" else by_module.get(name)
        if path is None or path in reached:
            continue
        reached.add(path)
        waiting += used_modules(path.read_text())
    return {folder_of(path) for path in reached if path.is_relative_to(SRC)}


def missing_procedures(page: Path) -> list[str]:
    """Procedures in the tables of a page, `file.f90` and `name` in neighbouring cells, that the file does not have."""
    wrong = []
    rows = re.findall(r"\| `(src/[\w/]+\.f90)` \| `(\w+)` \|", page.read_text(encoding="utf-8"))
    for file, name in rows:
        path = TOP / file
        if not path.is_file() or not re.search(rf"^[^!'\n]*\b(subroutine|function|procedure) +{name}\b", path.read_text(), re.M):
            wrong.append(f"{file} {name}")
    return wrong if rows else ["no procedure at all"]


def versions() -> dict[str, str]:
    """The version in each file that has it."""
    places = {"fpm.toml": r'^version = "([^"]+)"', "src/base/version_number.f90": r"program_version = '([^']+)'", "CITATION.cff": r"^version: (\S+)",
              "scripts/python/pyproject.toml": r'^version = "([^"]+)"', "CHANGELOG.md": r"^## (\S+)"}
    found = {}
    for file, pattern in places.items():
        if match := re.search(pattern, (TOP / file).read_text(encoding="utf-8"), re.M):
            found[file] = match[1]
    return found


def complaints(*command: str) -> str:
    """What a linter in .venv complains of; empty if it is content."""
    program = TOP / ".venv" / "bin" / command[0]
    if not program.exists():
        return f"{command[0]} is missing: scripts/setup.sh --lint"
    done = subprocess.run([program, *command[1:]], cwd=TOP, capture_output=True, text=True)
    return "" if done.returncode == 0 else done.stdout + done.stderr


def main() -> int:
    files = sorted(SRC.rglob("*.f90"))
    passed = failed = 0

    def check(name: str, holds: bool) -> None:
        nonlocal passed, failed
        passed, failed = passed + holds, failed + (not holds)
        if not holds:
            print(f"FAILED: {name}")

    folders = {folder_of(path) for path in files}
    check(f"every folder of src has a layer: {sorted(folders - set(RANK))}", folders <= set(RANK))
    if folders <= set(RANK):
        wrong = wrong_arrows(files)
        check("no module uses a higher layer:\n  " + "\n  ".join(wrong), not wrong)
    wrong = named_laws(files)
    check("no module above its registry names a law:\n  " + "\n  ".join(wrong), not wrong)
    high = used_by_units() & {"scene", "io", "study"}
    check(f"tests of single models use the layers {sorted(high)}", not high)
    for path in files:
        name = path.stem
        check(
            f"{path.relative_to(SRC.parent)} contains the module of its name",
            name == "main" or re.search(rf"^\s*(module|submodule\s*\([\w:]+\))\s+{name}\s*$", path.read_text(), re.M | re.I) is not None,
        )
    top = SRC.parent
    for path in sorted(file for folder in ("src", "tests", "scripts") for file in (top / folder).rglob("*.f90") if "build" not in file.parts):
        long = [number for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > MOST]
        check(f"{path.relative_to(top)}: lines {long} have more than {MOST} characters", not long)
    wrong = missing_procedures(TOP / "data/manual/architecture.md")
    check("data/manual/architecture.md names procedures that are not there:\n  " + "\n  ".join(wrong), not wrong)
    scripts = [path for folder in ("tests", "scripts") for path in (TOP / folder).rglob("*") if path.is_file() and path.read_bytes()[:2] == b"#!"]
    idle = [str(path.relative_to(TOP)) for path in scripts if "build" not in path.parts and not os.access(path, os.X_OK)]
    check(f"scripts without an execute bit, which a wheel would not start either: {idle}", not idle and len(scripts) > 50)
    found = versions()
    check(f"the version is the same everywhere: {found}", len(found) >= 4 and len(set(found.values())) == 1)
    for command in (("fortitude", "check", "src", "tests", "scripts/bench", "--output-format", "concise"), ("ruff", "check", "--output-format", "concise")):
        said = complaints(*command)
        check(f"{command[0]}:\n{said}", not said)
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
