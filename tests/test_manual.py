#!/usr/bin/env python3
"""The manual and all Markdown pages: their links, the description of every result, the build, and the law of the page "Adding a
law".

    scripts/setup.sh --manual && tests/test_manual.py [--program PATH]

Needs a release build (or makes one). Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote

from test_faults import ROOT, assertions, check, program_built

LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(r"`((?:src|tests|data|cases|scripts)/[\w./*-]+)`")
HREF = re.compile(r'(?:href|src)="([^"]+)"')


def pages() -> list[Path]:
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split()
    return [ROOT / name for name in names]


def anchors(page: Path) -> set[str]:
    """Anchors of the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


def check_markdown() -> None:
    """Every link and every path in a page refers to a file that exists."""
    for page in pages():
        text = page.read_text(encoding="utf-8")
        name = page.relative_to(ROOT)
        for link in LINK.findall(text):
            if "://" in link or link.startswith("mailto:"):
                continue
            place, _, anchor = link.partition("#")
            target = (page.parent / place).resolve() if place else page
            check(target.exists(), f"{name}: the link {link} leads to an existing file")
            if anchor and target.suffix == ".md" and target.exists():
                check(anchor in anchors(target), f"{name}: the link {link} leads to an existing heading")
        for path in PATH.findall(text):
            found = any(ROOT.glob(path)) if "*" in path else (ROOT / path).exists()
            check(found or path.endswith("linear_ramp.f90"), f"{name}: the path {path} exists")


def check_built(program: Path) -> None:
    """The manual is built without a warning, and the links of its pages lead to existing files."""
    done = subprocess.run(["scripts/manual.sh", program], cwd=ROOT, capture_output=True, text=True)
    check(done.returncode == 0 and not done.stderr, "the manual is built without a warning", done.stderr[-500:])
    built = ROOT / "build/manual"
    for page in [built / "index.html", *sorted((built / "page").glob("*.html"))]:
        if not page.exists():
            check(False, f"{page.name} is built")
            continue
        text = page.read_text(encoding="utf-8")
        for link in HREF.findall(text):
            if "://" in link or link.startswith(("#", "mailto:", "data:", "//")):
                continue
            check((page.parent / unquote(link.partition("#")[0])).exists(), f"manual, {page.name}: the link {link} leads to an existing file")


def described(program: Path) -> set[tuple[str, str]]:
    """Names and units of `gudgeon --reference results`."""
    text = subprocess.run([program, "--reference", "results"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"^\| `([^`]+)` \| ([^|]*?) +\|", text, re.MULTILINE)) | set(re.findall(r"^\| `([^`]+)` \| ( *)\|", text, re.MULTILINE))


def is_described(name: str, unit: str, known: set[tuple[str, str]]) -> bool:
    """Whether the reference has a column or quantity: by its name, without the prefix of a joint, or with capitals in place of a
    number or word."""
    whole, name = name, re.sub(r"^(crank_pin_|guide_\d_(?!gap|force|friction))", "", name)
    names = [whole, name, re.sub(r"^(rod_mode|rod_axial)_\d$", r"\1_2", name), re.sub(r"^steps_limited_by_\w+$", "steps_limited_by_NAME", name),
             re.sub(r"^(steps_of)_(order_)?\d+", r"\1_\2N", name), re.sub(r"^beyond_\w+_difference$", "beyond_NAME_difference", name),
             re.sub(r"^\w+_time_fraction_with_\w+$", "PHASE_time_fraction_with_NAME", name)]
    return any((one, unit) in known for one in names)


def check_reference(program: Path) -> None:
    """Every column and every quantity of the shipped cases is described in the reference, with its unit."""
    known = described(program)
    cases = [path for path in sorted((ROOT / "cases").rglob("*.nml")) if "studies" not in path.parts]
    short = ["-q", "--set", "integrator.max_evaluations=2000", "--set", "integrator.method=auto"]
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            options = ["-q", "--certify"] if case.stem in ("sim_I", "dry_0500um") else short
            done = subprocess.run([program, *options, "-o", folder, case], cwd=ROOT, capture_output=True, text=True, timeout=60)
            check(done.returncode in (0, 4), f"{case.stem}: a run, done or stopped by its limit", done.stderr)
            for trace in Path(folder).glob("*.csv"):
                rows = trace.read_text(encoding="utf-8").splitlines()
                if trace.name.endswith(".summary.csv"):
                    for row in rows[1:]:
                        name, unit = row.split(",", 1)[0], row.rsplit(",", 1)[1]
                        check(is_described(name, unit, known), f"the manual describes {name} [{unit}]", trace.name)
                elif not trace.name.endswith(("certificate.csv", "film.csv")):
                    for column in rows[0].split(","):
                        name, _, unit = column.rstrip("]").partition("[")
                        check(is_described(name, unit, known), f"the manual describes the column {column}", trace.name)


def check_study(program: Path) -> None:
    """The study of the page "Studies" can be run, and the page describes every column of its results."""
    page = (ROOT / "data/manual/studies.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.nml"
        text = code_after(page, "A study over the clearance").replace("'../sim_I.nml'", f"'{ROOT}/cases/sim_I.nml'")
        study.write_text(text.replace("count = 10", "count = 2"), encoding="utf-8")
        done = subprocess.run([program, "sweep", "-q", "-o", folder, "-s", "integrator.method=auto", "-s", "run.lyapunov_revolutions=1", study],
                              capture_output=True, text=True)
        check(done.returncode == 0, "the study of the manual runs", done.stderr)
        runs = Path(folder) / "study.runs.csv"
        for column in runs.read_text(encoding="utf-8").splitlines()[0].split(",") if runs.exists() else []:
            check("." in column or f"`{column.partition('[')[0]}`" in page, f"the manual describes the column {column} of a study")


def code_after(text: str, words: str) -> str:
    """The indented block after these words."""
    lines: list[str] = []
    for line in text[text.index(words):].splitlines()[1:]:
        if line.startswith("    ") or (not line and lines):
            lines.append(line[4:])
        elif lines:
            break
    return "\n".join(lines).strip() + "\n"


def run_in(folder: Path, command: str) -> subprocess.CompletedProcess:
    return subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)


def check_law() -> None:
    """The law of the page "Adding a law" is added to a copy of the sources, as the page says, built, run and tested. A law with the wrong
    sign is found by that test."""
    page = (ROOT / "data/manual/adding_a_law.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        for name in ("src", "cases", "data", "fpm.toml", "fpm.rsp", "tests", "scripts"):
            (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, copy / name)
        law = copy / "src/friction/linear_ramp.f90"
        law.write_text(code_after(page, "**1. "), encoding="utf-8")
        use, _, line = code_after(page, "**2. ").partition("...")
        registry = copy / "src/friction/friction_law_list.f90"
        text = registry.read_text(encoding="utf-8")
        text = text.replace("  implicit none\n", f"  {use.strip()}\n  implicit none\n", 1)
        text = text.replace("    call list%law(elasto_plastic_t())\n", f"    call list%law(elasto_plastic_t())\n    {line.strip()}\n", 1)
        registry.write_text(text, encoding="utf-8")
        for command in code_after(page, "**3. ").splitlines():
            done = run_in(copy, command)
            check(done.returncode == 0, f"adding a law: {command}", (done.stdout + done.stderr)[-800:])
            check("linear_ramp" in done.stdout or "done" in done.stdout, f"adding a law, output of: {command}", done.stdout[-300:])
        suite = copy / "tests/test_friction.f90"
        text = suite.read_text(encoding="utf-8")
        text = text.replace("  end subroutine run_test_friction\n", f"    {code_after(page, 'and call it in').strip()}\n  end subroutine run_test_friction\n")
        text = text.replace("end module test_friction", code_after(page, "Put this procedure into") + "end module test_friction")
        suite.write_text(text, encoding="utf-8")
        command = code_after(page, "Then run this suite alone").strip()
        done = run_in(copy, command)
        check(done.returncode == 0 and re.search(r"^\d+ passed, 0 failed$", done.stdout, re.MULTILINE), f"adding a law: {command}",
              (done.stdout + done.stderr)[-800:])
        text = law.read_text(encoding="utf-8")
        law.write_text(text.replace("ratio = -self%coefficient", "ratio = self%coefficient"), encoding="utf-8")
        done = run_in(copy, command)
        check(done.returncode != 0 and "linear_ramp: friction opposes sliding" in done.stdout, "adding a law: its test finds a wrong sign",
              (done.stdout + done.stderr)[-800:])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path)
    options = parser.parse_args()
    check_markdown()
    program = (options.program or program_built()).resolve()
    check_reference(program)
    check_study(program)
    check_built(program)
    check_law()
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
