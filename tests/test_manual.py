#!/usr/bin/env python3
"""The manual and all Markdown pages: their links, the description of every result, the build, and the law of the page "Adding a
law".

    scripts/setup.sh --manual && tests/test_manual.py [--program PATH]

Needs a release build (or makes one). Ends with the line "N passed, N failed".
"""
from __future__ import annotations

import argparse
import csv
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

for folder in ("manual", "bench"):
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts" / folder))

import pages as manual_pages
import tell_rungs
import tutorial
from test_faults import ROOT, assertions, check, program_built
from test_report import Browser  # restarts in .venv

LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(r"`((?:src|tests|data|cases|scripts)/[\w./*-]+)`")
HREF = re.compile(r'(?:href|src)="([^"]+)"')


def pages() -> list[Path]:
    """All pages of the checkout, also where it is not a repository."""
    found = [*ROOT.glob("*.md")]
    for folder in ("src", "tests", "data", "cases", "scripts"):
        found += (ROOT / folder).rglob("*.md")
    return sorted(page for page in found if "build" not in page.relative_to(ROOT).parts)


def anchors(page: Path) -> set[str]:
    """Anchors of the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-") for heading in headings}


def check_markdown() -> None:
    """Every link and every path in a page refers to a file that exists."""
    for page in pages():
        text = page.read_text(encoding="utf-8")
        broken = []
        for link in LINK.findall(text):
            if "://" in link or link.startswith("mailto:"):
                continue
            place, _, anchor = link.partition("#")
            target = (page.parent / place).resolve() if place else page
            if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
                broken.append(link)
        for path in PATH.findall(text):
            if not (any(ROOT.glob(path)) if "*" in path else (ROOT / path).exists()) and not path.endswith(("linear_ramp.f90", "hu_guo.f90")):
                broken.append(path)
        check(not broken, f"{page.relative_to(ROOT)}: its links and paths lead to existing files and headings", str(broken))


def tables(page: Path) -> list[list[list[str]]]:
    """The tables of a page: rows of cells, the heading first."""
    found: list[list[list[str]]] = []
    before = False
    for line in page.read_text(encoding="utf-8").splitlines():
        is_row = line.startswith("|")
        if is_row and not before:
            found.append([])
        if is_row and not re.fullmatch(r"[|: -]+", line):
            found[-1].append([cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]])
        before = is_row
    return found


def value_in(case: Path, group: str, key: str) -> float | None:
    """A number in a case file; None where it has no such group or key."""
    found = re.search(rf"^&{group}\b(.*?)^\s*/|^&{group}\b([^\n]*)/", re.sub(r"!.*", "", case.read_text(encoding="utf-8")), re.MULTILINE | re.DOTALL)
    value = found and re.search(rf"\b{key}\s*=\s*([-+.\deE]+)", found[1] or found[2])
    return float(value[1]) if value else None


MEASURED = re.compile(r"\d\.\d|\de-?\d")
NOT_MEASURED = {"cases/README.md": "simulation case figures", "tests/README.md": "what is judged",
                "data/manual/typical_values.md": "typical of", "data/manual/messages.md": "message"}   # first cells of tables of parameters and limits


def check_tables() -> None:
    """Tables written by hand hold no measured numbers. A measured table begins with its command, which is there, its date and its
    machine."""
    for page in pages():
        name = str(page.relative_to(ROOT))
        if name.startswith("data/measured/"):
            check_origin(page, name)
            continue
        cells = [cell for table in tables(page) if not table[0][0] or table[0][0] not in NOT_MEASURED.get(name, "")
                 for row in table[1:] for cell in row if MEASURED.search(re.sub(r"`[^`]*`|\[.*?\]\(.*?\)", "", cell))]
        check(not cells, f"{name}: its tables have no measured numbers", str(cells[:2]))


def check_origin(page: Path, name: str) -> None:
    """Command, date and machine of a measured table."""
    head = page.read_text(encoding="utf-8").split("\n\n")[1:3]
    command = re.sub(r"^sh -c '", "", head[0].strip()).split()[0]
    check(head[0].startswith("    ") and (command == "gudgeon-plot" or (ROOT / command).is_file()), f"{name}: begins with a command that is there", command)
    check(re.match(r"\d{4}-\d\d-\d\d, .*cores", head[1]), f"{name}: says date and machine", head[1][:80])


def check_page_of_cases() -> None:
    """The page of the cases has their values, every case, and the figures that scripts/python/src/gudgeon/plots/figures.csv lists."""
    page = ROOT / "cases/README.md"
    for row in table_with(page, "simulation"):
        case = ROOT / f"cases/sim_{row[0]}.nml"
        heat = value_in(case, "combustion", "heat")
        said = (float(row[1].split()[0]) * 1e-6, float(row[2].split()[0]), None if row[3] == "no" else float(row[3].split()[0]), float(row[4]))
        there = (value_in(case, "joint", "clearance"), value_in(case, "initial", "crank_speed"), heat, value_in(case, "integrator", "revolutions"))
        check(all(a == b or (a and b and abs(a / b - 1) < 1e-9) for a, b in zip(said, there)), f"cases/README.md: simulation {row[0]}", f"{said}, {there}")
    text = page.read_text(encoding="utf-8")
    cases = [case for case in sorted((ROOT / "cases").rglob("*.nml"))
             if case.parent.name not in ("studies", "base", "wiebe") and not re.fullmatch(r"sim_[IV]+(_oscillating|_finite)?", case.stem)]
    missing = [case.stem for case in cases if not re.search(rf"[`/]{case.stem}`", text)]
    check(not missing, "cases/README.md names every case", str(missing))
    named: set[str] = set()
    for row in table_with(page, "figures"):
        for part in row[0].split(", "):
            chapter, first = part.split("-")[0].split(".")
            last = part.split("-")[-1].split(".")[1]
            named |= {f"{chapter}.{number}" for number in range(int(first), int(last) + 1)}
    figures = first_column(ROOT / "scripts/python/src/gudgeon/plots/figures.csv")
    check(named == figures, "cases/README.md: the figures are those of figures.csv", str(named ^ figures))


def check_lists() -> None:
    """Lists of tests, folders, references and pages are complete."""
    text = (ROOT / "tests/README.md").read_text(encoding="utf-8")
    missing = [test.name for test in (ROOT / "tests").glob("test_*.*") if test.suffix in (".py", ".sh") and f"`{test.name}`" not in text]
    check(not missing, "tests/README.md names every test", str(missing))
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    folders = [*(ROOT / "src").iterdir(), *(ROOT / name for name in ("cases", "data", "scripts", "src", "tests"))]
    missing = [folder.name for folder in folders if folder.is_dir() and f"`{folder.name}/`" not in text]
    check(not missing, "CONTRIBUTING.md: the map has every folder", str(missing))
    listed = first_column(ROOT / "data/references.csv")
    there = {path.stem for path in (ROOT / "data").glob("*.csv") if (ROOT / "data" / f"{path.stem}.events.csv").exists()}
    there |= {f"film/models/{path.stem}" for path in (ROOT / "data/film/models").glob("*.nml")}
    check(listed == there, "data/references.csv lists every reference", str(listed ^ there))


def table_with(page: Path, first: str) -> list[list[str]]:
    """Rows of the table of a page whose first column has this head, without the heads."""
    return next(table for table in tables(page) if table[0][0] == first)[1:]


def first_column(path: Path) -> set[str]:
    """Values in the first column of a CSV file."""
    with path.open(encoding="utf-8", newline="") as lines:
        return {row[0] for row in list(csv.reader(lines))[1:] if row}


def check_built(program: Path) -> None:
    """The manual is built without a warning, loads nothing from a network, and the links of its pages lead to existing files."""
    done = subprocess.run(["scripts/manual.sh", "--pdf", program], cwd=ROOT, capture_output=True, text=True)
    said = "".join(line for line in done.stderr.splitlines(keepends=True) if not line.startswith("setup: gudgeon-plot "))   # of another clone, or not on the PATH
    check(done.returncode == 0 and not said, "the manual is built without a warning", said[-500:])
    built = ROOT / "build/manual"
    check((built / "gudgeon.pdf").exists() and (built / "gudgeon.pdf").read_bytes()[:5] == b"%PDF-", "the manual is printed")
    check_printed(built)
    for page in [built / "index.html", *sorted(built.glob("*.html")), *sorted(built.glob("api/*.html")), *sorted(built.glob("api/module/*.html"))[:5]]:
        if not page.exists():
            check(False, f"{page.name} is built")
            continue
        text = page.read_text(encoding="utf-8")
        loaded = re.findall(r'<(?:script|link|img|iframe)\b[^>]*(?:src|href)="((?:https?:)?//[^"]+)"', text)
        check(not loaded, f"manual, {page.name}: loads nothing from a network", str(loaded))
        links = [link for link in HREF.findall(text) if "://" not in link and not link.startswith(("#", "mailto:", "data:", "//", "/")) and link != "."]
        broken = [link for link in links if not (page.parent / unquote(link.partition("#")[0])).exists()]
        check(not broken and (links or page.name == "404.html"), f"manual, {page.name}: its links lead to existing files", str(broken))


PARTS = {"msup": 2, "msub": 2, "mfrac": 2, "mover": 2, "munder": 2, "mroot": 2, "msubsup": 3, "munderover": 3}   # elements of MathML


def check_printed(built: Path) -> None:
    """The contents of the PDF have the pages where its sections begin; the font has the letters of the equations, whose parts are as many as MathML
    has; numbers of the text are typeset."""
    import hooks  # in .venv
    from fontTools.ttLib import TTFont

    text = (built / "print.html").read_text(encoding="utf-8")
    begins = manual_pages.pages_printed((built / "gudgeon.pdf").read_bytes())
    said = {name: int(page) for name, page in re.findall(r'data-page="(\w+)">(\d+)<', text)}
    check(len(said) > 40 and all(begins[name] == page for name, page in said.items()), "the contents of the PDF have its pages", str(said))
    check(list(said.values()) == sorted(said.values()), "in their order", str(said))
    font = TTFont(built / "STIXTwoMath.woff")
    letters = {ord(letter) for math in re.findall(r"<math.*?</math>", text, re.DOTALL) for letter in html.unescape(re.sub(r"<[^>]+>", "", math)) if not letter.isspace()}
    lacking = {chr(letter) for letter in (letters | {0x221A}) - set(font.getBestCmap())}
    check("MATH" in font and not lacking and (built / "STIXTwoMath.woff").stat().st_size < 2e5, "the font has the letters of the equations, and few others", str(lacking))
    equations = [ElementTree.fromstring(math) for math in re.findall(r"<math.*?</math>", text, re.DOTALL)]
    odd = {(part.tag, len(part)) for equation in equations for part in equation.iter()
           if (wanted := PARTS.get(part.tag.rpartition("}")[2])) and len(part) != wanted}
    check(len(equations) > 300 and not odd, "powers, indices and fractions have their parts", str(odd))
    for written, wanted in (("1e-3 to 6.61e10 N/m^1.5", "10⁻³ to 6.61·10¹⁰ N/m<sup>1.5</sup>"), ("-0.25 kg m^2, 3.1-3.30, 2026-11-26", "−0.25 kg m², 3.1–3.30, 2026-11-26"),
                            ("1.35 um<code>1e-3</code> x86-64 2e+01", "1.35 µm<code>1e-3</code> x86-64 20")):
        check(hooks.typeset(written) == wanted, f"the manual prints {written}", hooks.typeset(written))


def commands_of(page: Path) -> list[str]:
    """The commands in the blocks of code of a page, without their comments."""
    lines = re.findall(r"^    ((?:gudgeon|fpm|pip|gcc|\. scripts|scripts/|tests/|\.venv/bin/).*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return [re.sub(r"\s+#.*", "", line).strip() for line in lines]


def check_commands(program: Path) -> None:
    """Every command in a page is run here, page by page in its order, or tests/commands_not_run.csv says why not; the options and words of commands inside
    sentences are there."""
    with (ROOT / "tests/commands_not_run.csv").open(encoding="utf-8", newline="") as lines:
        excused = {row["command"]: row["why"] for row in csv.DictReader(lines)}
    check(all(excused.values()), "each command that is not run has its reason")
    met: set[str] = set()
    for page in pages():
        name = str(page.relative_to(ROOT))
        todo = [] if name.startswith("data/measured/") or page.name.startswith("tutorial_") else commands_of(page)
        met |= {command for command in todo if command in excused}
        todo = [command for command in todo if command not in excused]
        if not todo:
            continue
        with tempfile.TemporaryDirectory() as folder:
            work = Path(folder, "work")
            work.mkdir()
            for link in ("cases", "data", "scripts"):
                (work / link).symlink_to(ROOT / link)
            (work / "sim_I.nml").symlink_to(ROOT / "cases/sim_I.nml")
            for case in ("engine", "CASE"):   # names that pages use for a case of the reader
                (work / f"{case}.nml").write_text(subprocess.run([program, "--template=engine"], capture_output=True, text=True).stdout)
            (Path(folder) / "gudgeon").symlink_to(program)
            for command in todo:
                done = subprocess.run(command, shell=True, cwd=work, capture_output=True, text=True, timeout=300,
                                      env={**os.environ, "PATH": f"{folder}:{ROOT / '.venv/bin'}:{os.environ['PATH']}"})
                check(done.returncode == 0, f"{name}: runs {command}", done.stderr[-300:])
    check(met == set(excused), "tests/commands_not_run.csv has no other commands", str(set(excused) - met))
    check_words(program)
    check_locale()


def check_words(program: Path) -> None:
    """Options of gudgeon, and words and options of gudgeon-plot, in all pages."""
    options = subprocess.run([program, "--help"], capture_output=True, text=True).stdout
    source = ROOT / "scripts/python/src/gudgeon"
    words = {path.stem: path.read_text(encoding="utf-8") for path in (source / "commands").glob("*.py")}
    common = "".join(path.read_text(encoding="utf-8") for path in source.glob("*.py"))
    for page in pages():
        text = page.read_text(encoding="utf-8")
        wrong = []
        for code in [*re.findall(r"`([^`\n]+)`", text), *re.findall(r"^    (.+)$", text, re.MULTILINE)]:
            code = code.removeprefix("$ ").split("#")[0].split(" > ")[0]
            found = re.match(r"gudgeon-plot ([a-z]+)\b", code)
            if not found and not code.startswith("gudgeon "):
                continue
            if found and found[1] not in words:
                wrong.append(code)
            there = words.get(found[1], "") + common if found else options
            wrong += [f"{code}: {option}" for option in re.findall(r"(?<!\S)(--[a-z-]+)", code) if option not in there]
        check(not wrong, f"{page.relative_to(ROOT)}: its commands and their options are there", str(wrong))


def check_locale() -> None:
    """Pages and scripts call awk in the locale C: elsewhere it may read and write numbers with a decimal comma."""
    for path in [*pages(), *(ROOT / "scripts").glob("*.sh"), *(ROOT / "scripts/bench").glob("*.sh")]:
        bare = re.findall(r"^(?!#).*(?<!LC_ALL=C )\bawk\b.*$", path.read_text(encoding="utf-8"), re.MULTILINE)
        check(not bare, f"{path.relative_to(ROOT)}: awk in the locale C", str(bare[:1]))


def check_keys(program: Path) -> None:
    """The groups that pages name, and the keys of the table of typical values, are there."""
    said = "".join(subprocess.run([program, "--reference", subject], capture_output=True, text=True).stdout for subject in ("case", "study"))
    groups, keys = set(re.findall(r"^## &(\w+)", said, re.MULTILINE)) | {"so_far", "name"}, set(re.findall(r"^\| `(\w+)` \|", said, re.MULTILINE))
    for page in (ROOT / "data/manual").glob("*.md"):
        named = set(re.findall(r"`&(\w+)", page.read_text(encoding="utf-8")))
        check(named <= groups, f"{page.name}: the groups that it names are there", str(named - groups))
    rows = table_with(ROOT / "data/manual/typical_values.md", "typical of")
    named = {key for row in rows for key in re.findall(r"`(?:\w+\.)?(\w+)`", row[1])}
    check(named <= keys, "typical_values.md: its keys are there", str(named - keys))


def check_pictures() -> None:
    """Each picture is made by a command that data/pictures.csv names and that is there; a vector file beside it by the same one with --format svg."""
    with (ROOT / "data/pictures.csv").open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    listed = {row["picture"]: row["command"] for row in rows}
    questions = {row["question"] for row in rows}
    check(len(questions) == len(rows) and all(one.endswith("?") for one in questions), "data/pictures.csv: a question of its own for each picture")
    there = {str(path.relative_to(ROOT)) for folder in ("cases", "data", "scripts") for path in (ROOT / folder).rglob("*") if path.suffix in (".png", ".svg")}
    there = {path for path in there if "/build/" not in path}
    there -= {path for path in there if path.endswith(".svg") and path.removesuffix(".svg") + ".png" in there}
    check(there == set(listed), "data/pictures.csv has every picture", str(there ^ set(listed)))
    drawn = {path for path, command in listed.items() if path.endswith(".png") and not command.startswith("tests/")}   # others show a browser
    bare = {path for path in drawn if not (ROOT / path).with_suffix(".svg").is_file()}
    check(len(drawn) > 30 and not bare, "each picture that is drawn has vectors beside it", str(bare))
    heavy = {path: size for path in drawn - bare if (size := (ROOT / path).with_suffix(".svg").stat().st_size) > 250_000}
    check(not heavy, "no vectors are large", str(heavy))
    missing = {command for command in listed.values() if not (command.startswith("gudgeon-plot ") or (ROOT / command.split()[0]).is_file())}
    check(not missing, "data/pictures.csv: the commands are there", str(missing))


def check_pictures_of_pages() -> None:
    """The manual shows the vectors of each picture. Those of a page are together no heavier than 500 kB, unless it reads its many pictures as they
    come into view."""
    import hooks  # in .venv

    for page in pages():
        wanted: set[Path] = set()
        text = page.read_text(encoding="utf-8")
        there = manual_pages.relinked(text, page, manual_pages.place_in_manual(page), wanted)
        pixels = [name for name in re.findall(r"!\[[^]]*\]\(([^)]*\.png)\)", there) if not name.endswith(("explore.png", "explore_pt.png"))]
        sizes = [one.stat().st_size for one in wanted if one.suffix in (".png", ".svg")]
        check(not pixels and (len(sizes) > hooks.MANY or sum(sizes) < 5e5), f"{page.relative_to(ROOT)}: its pictures are vectors in the manual, and light", f"{pixels} {sizes}")


def check_tutorials(program: Path) -> None:
    """The commands of README and the tutorials print what the pages show; the Portuguese pages have the same files, commands and outputs, with
    `--language pt` where they draw or write a page, and what these commands print in Portuguese."""
    from gudgeon.language import Language  # in .venv

    spoken = Language("pt")
    spoken.keep("film_thickness")
    for name, other in (("README.md", "data/manual/readme_pt.md"), ("data/manual/tutorial_engine.md", "data/manual/tutorial_engine_pt.md"),
                        ("data/manual/tutorial_compressor.md", "data/manual/tutorial_compressor_pt.md"), ("data/manual/tutorial_laws.md", "data/manual/tutorial_laws_pt.md")):
        wrong = tutorial.run(ROOT / name, program)
        check(not wrong, f"{name} shows what its commands print", "\n".join(wrong))
        ours, theirs = ([tutorial.COMMAND.findall(body) or body for _, body, _ in tutorial.blocks((ROOT / one).read_text(encoding="utf-8"))] for one in (name, other))
        for i, block in enumerate(theirs):
            for k, (command, _) in enumerate(block if isinstance(block, list) else ()):
                if " --language pt" in command and i < len(ours) and k < len(ours[i]):
                    english, printed = ours[i][k]
                    ours[i][k] = (command if command.replace(" --language pt", "").replace("horizonte", "horizon") == english else english, spoken.say(printed))
        check(len(ours) > 2 and ours == theirs, f"{other} has the same commands", str([pair for pair in zip(ours, theirs) if pair[0] != pair[1]]))


def check_notebooks() -> None:
    """A tutorial as a notebook has the files, commands and pictures of its page, in their order."""
    for page in sorted((ROOT / "data/manual").glob("tutorial_*.md")):
        text = page.read_text(encoding="utf-8")
        cells = json.loads(tutorial.notebook(text))["cells"]
        sources = [cell["source"] for cell in cells if cell["cell_type"] == "code"]
        check([source.partition("\n")[2] for source in sources if source.startswith("%%bash")] == tutorial.commands(text), f"{page.name}: a notebook has its commands")
        files = {source.partition("\n")[0].split()[1]: source.partition("\n")[2] for source in sources if source.startswith("%%writefile")}
        named = {match[1]: body.rstrip() for before, body, _ in tutorial.blocks(text) if not body.startswith("$ ") and (match := tutorial.FILE.search(before))}
        check(files == named and named, f"{page.name}: and its files", str(set(files) ^ set(named)))
        check(len([source for source in sources if "Image(" in source]) == text.count("](tutorials/"), f"{page.name}: and its pictures")
        check(not any("](" in cell["source"] or "\n    $ " in cell["source"] for cell in cells if cell["cell_type"] == "markdown"), f"{page.name}: without links and blocks in its texts")


def check_pictures_of_tutorials() -> None:
    """A tutorial shows each picture that its commands name, and each picture that is kept."""
    kept = {path.name for path in (ROOT / "data/manual/tutorials").glob("*.png")}
    seen = set()
    for page in sorted((ROOT / "data/manual").glob("tutorial_*.md")):
        text = page.read_text(encoding="utf-8")
        named, shown = set(re.findall(r"^    results/([\w.]+\.png)", text, re.MULTILINE)), set(re.findall(r"!\[[^]]+\]\(tutorials/([\w.]+\.png)\)", text))
        if page.stem.endswith("_pt"):
            named = {name.replace(".png", "_pt.png") for name in named}
            check(all(name.endswith("_pt.png") for name in shown), f"{page.name} shows pictures in Portuguese", str(shown))
        check(named <= shown, f"{page.name} shows what it makes", str(named - shown))
        seen |= shown
    check(seen == kept, "the pictures of tutorials are shown", str(seen ^ kept))


def check_rungs() -> None:
    """The table of rungs is that of the results of gudgeon-plot models that are kept."""
    text = (ROOT / "data/measured/rungs.md").read_text(encoding="utf-8")
    for question, asked in tell_rungs.QUESTIONS.items():
        check(tell_rungs.section(question, *asked) in text, f"data/measured/rungs.md, {question}: is that of scripts/bench/tell_rungs.py")


def check_symbols() -> None:
    """The table of symbols gives each letter one meaning."""
    letters = [letter for row in table_with(ROOT / "data/manual/symbols.md", "symbol") for letter in re.findall(r"\$([^$]+)\$", row[0])]
    check(len(letters) > 60 and len(set(letters)) == len(letters), "data/manual/symbols.md: each symbol once", str({one for one in letters if letters.count(one) > 1}))


def check_results_in_python(program: Path) -> None:
    """The ten lines of Python of the page "Results" find the largest force of the summary."""
    code = code_after((ROOT / "data/manual/results.md").read_text(encoding="utf-8"), "**In ten lines of Python**")
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "engine.nml"
        case.write_text(subprocess.run([program, "--template=engine"], capture_output=True, text=True).stdout, encoding="utf-8")
        subprocess.run([program, "-q", case.name], cwd=folder, check=True)
        done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
        found = re.findall(r"[\d.]+(?:E[+-]\d+)?", done.stdout)
        check(done.returncode == 0 and abs(float(found[0]) / float(found[2]) - 1) < 0.01, "results in ten lines of Python", done.stdout + done.stderr)


def check_messages() -> None:
    """Each message with a cure is one that the source has, and the list of all is not empty."""
    done = subprocess.run([sys.executable, ROOT / "scripts/manual/messages.py"], capture_output=True, text=True)
    check(done.stdout.count("\n- ") > 250, "the messages of the program are found in its source", done.stderr[-300:])
    missing = [row[0] for row in table_with(ROOT / "data/manual/messages.md", "message") if row[0].strip("`") not in done.stdout]
    check(not missing, "each message with a cure is in the source", str(missing))


def check_drawings() -> None:
    """The drawings of the manual are those that their script draws."""
    kept = ROOT / "data/manual/drawings"
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, ROOT / "scripts/manual/drawings.py", folder], capture_output=True, text=True)
        check(done.returncode == 0, "the drawings are drawn", done.stderr[-300:])
        drawn = {path.name: path.read_bytes() for path in Path(folder).glob("*.svg")}
    check(drawn == {path.name: path.read_bytes() for path in kept.glob("*.svg")}, "the drawings are those of scripts/manual/drawings.py")


#: Types a word into the search of a page.
SEARCH = """const q = document.querySelector('.md-search__input'); q.focus(); q.value = arguments[0];
q.dispatchEvent(new Event('input', {bubbles: true})); q.dispatchEvent(new Event('keyup'));"""


def check_read() -> None:
    """A browser that reaches no network opens the manual from the file system: style, equations, drawings, search, and no message."""
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    check(chromium and driver, "Chromium is there: scripts/setup.sh --browser")
    if not (chromium and driver):
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:   # Chromium may still be writing
        browser = Browser(chromium, driver, profile, "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1")
        try:
            for page in ("index", "theory", "case_file"):
                browser.open(ROOT / f"build/manual/{page}.html")
                wide = browser.run("return getComputedStyle(document.querySelector('.md-header')).position === 'sticky'")
                check(wide, f"manual, {page}: is styled")
                broken = browser.run("return [...document.images].filter(i => !i.naturalWidth).map(i => i.src)")
                check(not broken, f"manual, {page}: every picture is shown", str(broken))
                flat = browser.run("return [...document.querySelectorAll('math')].filter(m => m.getBoundingClientRect().height < 4).length")
                check(flat == 0, f"manual, {page}: equations are drawn", str(flat))
                numbered = browser.run("return [...document.querySelectorAll('.equation .number')].map(n => n.textContent)")
                check(numbered == [f"eq. {i + 1}" for i in range(len(numbered))] and (page != "theory" or len(numbered) > 10),
                      f"manual, {page}: equations are numbered", str(numbered))
                browser.run(SEARCH, "asperities")
                check(browser.wait("document.querySelectorAll('.md-search-result__item').length > 1", 20), f"manual, {page}: the search finds")
                check(not (said := browser.messages()), f"manual, {page}: console", str(said))
            browser.open(ROOT / "build/manual/gallery.html")
            check(browser.run("return document.querySelectorAll('td img[loading=lazy]').length") > 45, "manual: the gallery reads pictures as they come into view")
            browser.run("document.querySelectorAll('td img').forEach(i => i.loading = 'eager')")   # else those out of view wait
            check(browser.wait("[...document.querySelectorAll('td img')].every(i => i.naturalWidth)", 20), "manual: the gallery shows every picture")
            check(browser.run("return document.querySelectorAll('td img[src$=svg]').length") > 45, "manual: as vectors")
            browser.open(ROOT / "build/manual/case_file.html")
            browser.run(SEARCH, "oil flow")
            browser.wait("document.querySelector('.md-search-result__link')", 20)
            found = browser.run("return document.querySelector('.md-search-result__link').href")
            check("/index.html" in found, "manual: the search for oil flow finds the table of answers first", found)
            for word, page in (("read_pressure", "python"), ("Excel", "results"), ("joint.clearance", "typical_values"), ("cycle_imep", "results")):   # behind a dot, a bracket
                browser.open(ROOT / "build/manual/case_file.html")
                browser.run(SEARCH, word)
                browser.wait("document.querySelector('.md-search-result__link')", 20)
                found = browser.run("return [...document.querySelectorAll('.md-search-result__link')].map(e => e.href.split('/').pop())")
                check(any(link.startswith(f"{page}.html") for link in found), f"manual: the search for {word} finds the page {page}", str(found))
            for scheme, theme in (("dark", "slate"), ("light", "default")):   # also where the other one was seen before
                browser.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
                browser.open(ROOT / "build/manual/index.html")
                check(browser.wait(f"document.body.dataset.mdColorScheme === '{theme}'", 10), f"manual: a {scheme} system has a {scheme} page", str(browser.run("return document.body.dataset.mdColorScheme")))
            browser.cdp("Emulation.setEmulatedMedia", features=[])
            browser.open(ROOT / "build/manual/tutorial_laws_pt.html")
            check(browser.run("return document.documentElement.lang") == "pt-BR", "manual: a Portuguese page says so")
            names = browser.run("return [...document.querySelectorAll('.md-nav--primary .md-nav__link')].map(e => e.textContent.trim())")
            check({"Shipped studies", "Em português", "Paper"} <= set(names) and len([one for one in names if one == "Parameter studies"]) == 1,
                  "manual: names in the navigation", str(names))
            for page in ("index", "theory", "films", "case_file", "gallery"):
                browser.open(ROOT / f"build/manual/{page}.html")
                check((width := browser.width_at(400)) == 400, f"manual, {page}: fits a phone", f"{width} instead of 400")
                if page in ("index", "gallery"):
                    cut = browser.run("return [...document.querySelectorAll('.md-content table')].filter(t => t.getBoundingClientRect().right > 400 || t.scrollWidth > t.clientWidth + 1).length")
                    check(cut == 0, f"manual, {page}: tables are whole on a phone", str(cut))
            browser.width_at(0)
            browser.open(ROOT / "build/manual/api/index.html")
            check(browser.run("return getComputedStyle(document.querySelector('.navbar')).display") == "flex", "manual, api: is styled")
            check(not (said := browser.messages()), "manual, api: console", str(said))
        finally:
            browser.close()


def described(program: Path) -> set[tuple[str, str]]:
    """Names and units of `gudgeon --reference results`."""
    text = subprocess.run([program, "--reference", "results"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"^\| `([^`]+)` \| ([^|]*?) +\|", text, re.MULTILINE)) | set(re.findall(r"^\| `([^`]+)` \| ( *)\|", text, re.MULTILINE))


def names_of_engine(name: str) -> list[str]:
    """Names by which a column or quantity of several cylinders may be described."""
    column = re.sub(r"^(station|segment|damper|main_bearing)_\d+_", r"\1_1_", re.sub(r"^cylinder_\d+_", "cylinder_2_", name))
    quantity = re.sub(r"^(natural_frequency|mode)_\d+", r"\1_N", re.sub(r"_order_[\d.]+$", "_order_H", name))
    for body, letter in (("station", "J"), ("segment", "J"), ("damper", "R")):
        quantity = re.sub(rf"{body}_\d+", f"{body}_{letter}", quantity)
    return [column, quantity]


def is_described(name: str, unit: str, known: set[tuple[str, str]]) -> bool:
    """Whether the reference has a column or quantity: by its name, without the prefix of a joint, or with capitals in place of a
    number or word."""
    whole, name = name, re.sub(r"^(crank_pin_(\d+_)?|small_end_|main_bearing_(\d+_)?(?!\d*_?force)|guide_\d_(?!gap|force|friction))", "", name)
    names = [whole, name, f"crank_pin_{name}", re.sub(r"^(rod_mode|rod_axial)_\d$", r"\1_2", name), re.sub(r"^steps_limited_by_\w+$", "steps_limited_by_NAME", name),
             re.sub(r"^(steps_of)_(order_)?\d+", r"\1_\2N", name), *names_of_engine(name),
             re.sub(r"^note_\d+$", "note_N", name), re.sub(r"(?<![a-z])ring_\d_", "ring_1_", name),
             re.sub(r"^\w+_time_fraction_with_\w+$", "PHASE_time_fraction_with_NAME", name)]
    if any((one, unit) in known for one in names):
        return True
    return name.endswith("_difference") and ("NAME_difference", "") in known and is_described(whole.removesuffix("_difference"), unit, known)


def check_reference(program: Path) -> None:
    """Every column and every quantity of the shipped cases is described in the reference, with its unit."""
    known = described(program)
    cases = [path for path in sorted((ROOT / "cases").rglob("*.nml")) if "studies" not in path.parts]
    short = ["-q", "--set", "integrator.max_evaluations=2000", "--set", "integrator.method=auto"]
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            options = ["-q", "--certify"] if case.stem in ("sim_I", "dry_0500um") else short
            done = subprocess.run([program, *options, "-o", folder, case], cwd=ROOT, capture_output=True, text=True, timeout=600)
            check(done.returncode in (0, 4), f"{case.stem}: a run, done or stopped by its limit", done.stderr)
            results: set[tuple[str, str]] = set()
            for trace in Path(folder).glob("*.csv"):
                rows = trace.read_text(encoding="utf-8").splitlines()
                if trace.name.endswith(".summary.csv"):
                    results |= {(row.split(",", 1)[0], row.rsplit(",", 1)[1]) for row in rows[1:]}
                elif not trace.name.endswith(("certificate.csv", "film.csv", "skirt.csv")):
                    results |= {(name, unit) for name, _, unit in (column.rstrip("]").partition("[") for column in rows[0].split(","))}
            missing = [name for name, unit in results if not is_described(name, unit, known)]
            check(results and not missing, f"the manual describes the results of {case.stem}, with their units", str(missing))


def check_answers_table(program: Path) -> None:
    """Every name in the table of answers of the manual's first page is in the reference of results, every row of the page of a run in its
    source, every group in that of cases."""
    rows = [line.split("|")[1:-1] for line in (ROOT / "data/manual/index.md").read_text(encoding="utf-8").split("| I want |")[1].split("\n\n")[0].splitlines()[2:]]
    known = subprocess.run([program, "--reference", "results"], capture_output=True, text=True, check=False).stdout
    known += subprocess.run([program, "--reference", "case"], capture_output=True, text=True, check=False).stdout
    page = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "scripts/python/src/gudgeon/report").glob("*.py"))
    check(len(rows) > 12, "answers: the table")
    for wanted, shown, *others in rows:
        names = [name.strip("&") for cell in others for name in re.findall(r"`(&?[a-z]\w*)", cell)]
        missing = [name for name in names if not re.search(rf"\b{name}\b", known)]
        check(not missing, f"answers: {wanted}: {missing}")
        check(shown.strip() in page, f"answers: {wanted}: {shown}")


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
        columns = runs.read_text(encoding="utf-8").splitlines()[0].split(",") if runs.exists() else []
        missing = [column for column in columns if "." not in column and f"`{column.partition('[')[0]}`" not in page]
        check(columns and not missing, "the manual describes the columns of a study", str(missing))


def code_after(text: str, words: str) -> str:
    """The indented block after these words."""
    lines: list[str] = []
    for line in text[text.index(words):].splitlines()[1:]:
        if line.startswith("    ") or (not line and lines):
            lines.append(line[4:])
        elif lines:
            break
    return "\n".join(lines).strip() + "\n"


def insert(file: Path, lines: dict[str, str]) -> None:
    """Put each line before the first place of a text in a file."""
    text = file.read_text(encoding="utf-8")
    for place, line in lines.items():
        assert place in text
        text = text.replace(place, f"    {line.strip()}\n{place}" if not line.endswith(",") else f"{line} {place}", 1)
    file.write_text(text, encoding="utf-8")


def check_new_answer(copy: Path) -> None:
    """An answer that is one line beside its column is where users look for it: against the rows of the trace."""
    with (copy / "results/dry_0100um.summary.csv").open() as file:
        summary = {row["quantity"]: row["value"] for row in csv.DictReader(file)}
    with (copy / "results/dry_0100um.csv").open() as file:
        force = max(abs(float(row["guide_force[N]"])) for row in csv.DictReader(file))
    kept = float(summary["max_guide_force"])
    check(0 < force <= kept * (1 + 1e-9), "a new answer against its column", f"{kept}, {force}")
    check(float(summary["cycle_max_guide_force"]) <= kept, "a new answer over the last cycle")
    (copy / "study.nml").write_text("&study case = 'cases/sim_I.nml', statistics = 'cycle_max_guide_force, max abs guide_force' /\n"
                                    "&parameter key = 'integrator.revolutions', values = '2, 3' /\n")
    done = run_in(copy, "fpm run -- sweep -q study.nml")
    check(done.returncode == 0, "a new answer in a study", done.stderr[-300:])
    with (copy / "results/study.runs.csv").open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        new, known = float(row["cycle_max_guide_force[N]"]), float(row["guide_force_max_abs[N]"])
        check(abs(new / known - 1) < 1e-3, "a new answer in a study, against the statistic of the column", f"{new}, {known}")


def run_in(folder: Path, command: str) -> subprocess.CompletedProcess:
    """Run a command there; `fpm run` with the flags of the tests, whose objects are there already."""
    strict = re.search(r"^@strict$.*?^options (--profile .*?)$.*?^options (--flag .*?)$", (folder / "fpm.rsp").read_text(), re.MULTILINE | re.DOTALL)
    assert strict
    command = command.replace("fpm run ", f"fpm run {strict[1]} {strict[2]} ")
    return subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)


def check_law() -> None:
    """The law of the page "Adding a law" is added to a copy of the sources, as the page says, built, run and tested. A law with the wrong
    sign is found by that test."""
    page = (ROOT / "data/manual/adding_a_law.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        for name in ("src", "cases", "data", "fpm.toml", "fpm.rsp", "tests", "scripts"):
            if (ROOT / name).is_dir():   # without what other tests are writing
                shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__", "build", "_groups.pyi"))
            else:
                shutil.copy(ROOT / name, copy / name)
        (copy / "build").mkdir()
        for path in (ROOT / "build").glob("*"):   # what fpm has built here is not built again; other folders may be changing
            if path.is_file():
                shutil.copy(path, copy / "build" / path.name)
            elif path.name.startswith("gfortran_") or path.name == "dependencies":
                shutil.copytree(path, copy / "build" / path.name)
        law = copy / "src/friction/linear_ramp.f90"
        law.write_text(code_after(page, "**1. "), encoding="utf-8")
        use, _, line = code_after(page, "**2. ").partition("...")
        insert(copy / "src/friction/friction_laws.f90", {"  implicit none\n": use, "    call list%law('dahl'": line})
        (copy / "src/contact/hu_guo.f90").write_text(code_after(page, "**5. "), encoding="utf-8")
        use, _, line = code_after(page, "**6. ").partition("...")
        insert(copy / "src/contact/contact_laws.f90", {"  implicit none\n": use, "    call list%law('flores'": line})
        columns = copy / "src/scene/trace_columns.f90"
        insert(columns, {"    call row%add('frame_force_x[N]'": code_after(page, "**7. ")})
        insert(columns, {"column_list_t, name_length, ": "largest_size,"})
        for number in ("**3. ", "**8. "):
            for command in code_after(page, number).splitlines():
                done = run_in(copy, command)
                check(done.returncode == 0, f"adding a law: {command}", (done.stdout + done.stderr)[-800:])
                check(any(word in done.stdout for word in ("linear_ramp", "done", "max_guide_force")), f"adding a law, output of: {command}", done.stdout[-300:])
        check_new_answer(copy)
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
    check_tables()
    check_page_of_cases()
    check_lists()
    check_drawings()
    check_messages()
    check_symbols()
    check_rungs()
    check_pictures()
    check_pictures_of_pages()
    program = (options.program or program_built()).resolve()
    check_commands(program)
    check_tutorials(program)
    check_pictures_of_tutorials()
    check_notebooks()
    check_results_in_python(program)
    check_keys(program)
    check_reference(program)
    check_answers_table(program)
    check_study(program)
    check_built(program)
    check_read()
    check_law()
    return assertions.report()


if __name__ == "__main__":
    sys.exit(main())
