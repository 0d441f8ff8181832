#!/usr/bin/env python3
"""What follows from the declarations: the JSON Schema of cases, completion in shells, and the manual page.

    tests/test_shell_pages.py PROGRAM

Needs f90nml and jsonschema. Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
"""

import ast
import contextlib
import io
import itertools
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import f90nml
import jsonschema

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "scripts" / "python" / "src"))
os.environ.setdefault("GUDGEON_LIBRARY", str(TOP / "build" / "library" / "libgudgeon.so"))
import gudgeon
from gudgeon import cli
from gudgeon.language import Language
from gudgeon.portuguese import TEXTS, UNTRANSLATED
from gudgeon.portuguese_keys import MEANINGS

passed = failed = 0

#: Changes of simulation I that the schema refuses: group, key, value.
WRONG = [
    ("mechanism", "rod_length", -0.2), ("mechanism", "rod_length", "long"), ("mechanism", "rod_com", [1.0]), ("mechanism", "rod_lenght", 1.0),
    ("mechanism", "piston_mass", -1.0), ("drive", "kind", "fast"), ("drive", "torque", True), ("initial", "crank_speed", "x"),
    ("joint", "kind", 1), ("joint", "clearance", -1e-5), ("joint", "clearance", [1e-5, 2e-5]), ("contact", "restitution", 1.5),
    ("contact", "law", "herz"), ("integrator", "method", "euler"), ("integrator", "max_order", 1.5), ("integrator", "max_order", 99),
    ("integrator", "relative_tolerance", 0.5), ("output", "digits", 40), ("output", "every_step", "yes"), ("lubrication", "viscosity", -1.0),
]  # fmt: skip


def check(holds: bool, what: str) -> None:
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    if not holds:
        print(f"FAILED: {what}")


def output(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def as_json(path: Path) -> dict:
    """A case as JSON; a group that stands there twice, for two places, is a list. Numbers with units, and lists that are texts,
    are converted by the package."""
    case: dict = {}
    read = f90nml.read(path)
    if re.search(r"=\s*[-+.\deE*]+ +[A-Za-z]|&supply", re.sub(r"!.*", "", path.read_text())):
        read = f90nml.reads(gudgeon.read(path).to_nml())
    for name, group in json.loads(json.dumps(read.todict())).items():
        if repeated := re.fullmatch(r"_grp_(\w+)_\d+", name) or re.fullmatch(r"(cylinder|damper|ring|valve)_\d+", name):
            case.setdefault(repeated[1], []).append(group)
        elif name != "_start_index":
            case[name] = group
    return case


def schema(program: str) -> None:
    validator = jsonschema.Draft202012Validator(json.loads(output(program, "--reference", "schema")))
    validator.check_schema(validator.schema)
    cases = [path for path in sorted((TOP / "cases").rglob("*.nml")) if "&mechanism" in path.read_text()]
    for path in cases:
        errors = [f"{list(error.absolute_path)}: {error.message[:80]}" for error in validator.iter_errors(as_json(path))]
        check(not errors, f"{path.relative_to(TOP)} is valid: {errors[:2]}")
    check(len(cases) > 60, f"shipped cases: {len(cases)}")
    for group, key, value in WRONG:
        case = as_json(TOP / "cases" / "sim_I.nml")
        case[group][key] = value
        check(not validator.is_valid(case), f"refused: {group}.{key} = {value}")
    case = as_json(TOP / "cases" / "sim_I.nml")
    del case["mechanism"]["rod_length"]
    check(not validator.is_valid(case) and not validator.is_valid({"nothing": {}}), "a required key, and an unknown group")


def units_of(schema: object) -> set[str]:
    """The units of all keys in a schema."""
    if isinstance(schema, dict):
        return {schema["x-unit"]} if "x-unit" in schema else set().union(*map(units_of, schema.values()))
    return set()


def units(program: str) -> None:
    """A case with the unit of each key behind its numbers, as the program prints it, is the case without units."""
    written: set[str] = set()

    def with_unit(line: re.Match[str]) -> str:
        written.add(line[3])
        return line[1] + ", ".join(f"{number} {line[3]}" for number in line[2].split(", "))

    files: list[tuple[Path, tuple[str, ...]]] = [(path, ()) for path in sorted((TOP / "cases").rglob("*.nml")) if path.parent.name != "studies"]
    files.append((TOP / "cases" / "gas" / "engine_walls.nml", ("-s", "wall_heat.law=constant", "-s", "wall_heat.heat_transfer_coefficient=300")))
    for path, settings in files:
        resolved = output(program, "--resolved", *settings, str(path))
        text = re.sub(r"^(  \w+ = )([^'\n!]+?)  ! (.*)$", with_unit, resolved, flags=re.MULTILINE)
        done = subprocess.run([program, "--resolved", "-"], input=text, capture_output=True, text=True, cwd=path.parent)
        check(done.stdout == resolved, f"{path.relative_to(TOP)} with units: {done.stderr[:300]}")
    missing = units_of(json.loads(output(program, "--reference", "schema"))) - written
    check(not missing, f"all units of keys stand in shipped cases, not {missing}")


def written_by_f90nml(program: str) -> None:
    """f90nml writes key(1:2) for a list that begins with number 1."""
    case = f90nml.read(TOP / "cases" / "sim_I.nml")
    case["mechanism"].start_index["rod_com"] = [1]
    text = str(case)
    check("rod_com(1:2)" in text, "f90nml writes indices")
    done = subprocess.run([program, "--resolved", "-"], input=text, capture_output=True, text=True)
    check(done.stdout == output(program, "--resolved", str(TOP / "cases" / "sim_I.nml")), f"a case that f90nml has written: {done.stderr}")


def completion(program: str) -> None:
    script = output(program, "--completion", "bash")
    for line, wanted in (
        ("gudgeon --se", "--set"), ("gudgeon -s joint.ki", "joint.kind=clearance"), ("gudgeon -s drive.torque", "drive.torque="),
        ("gudgeon --accuracy d", "draft"), ("gudgeon --template=f", "film"), ("gudgeon --reference sch", "schema"),
        ("gudgeon cases/sim_VI", "cases/sim_VI.nml"), ("gudgeon sw", "sweep"), ("gudgeon pl", "plot"),
    ):  # fmt: skip
        words = shlex.split(line.replace("=", " = "))
        setup = f"COMP_LINE={shlex.quote(line)}; COMP_POINT={len(line)}; COMP_WORDS=({' '.join(map(shlex.quote, words))}); COMP_CWORD={len(words) - 1}"
        done = subprocess.run(["bash", "-c", f"compopt() {{ :; }}\n{script}\n{setup}; _gudgeon; printf '%s\\n' \"${{COMPREPLY[@]}}\""],
                              capture_output=True, text=True, cwd=TOP)  # fmt: skip
        check(wanted in done.stdout.split(), f"{line!r} completes {wanted}: {done.stdout[:200]}{done.stderr}")
    check("-l accuracy -s a -x -a" in output(program, "--completion", "fish"), "fish")
    check(output(program, "--completion", "zsh").startswith("#compdef gudgeon"), "zsh")
    done = subprocess.run([program, "--completion", "csh"], capture_output=True, text=True)
    check(done.returncode == 2 and "must be bash, zsh or fish" in done.stderr, done.stderr)


def words_of(text: str) -> set[str]:
    """Words of three letters and more; no paths, names with _, or notes on a run."""
    text = re.sub(r"^  (?:note|aviso): .*$|\S*[/_=]\S*|\b[a-z]+\.[a-z]+", "", re.sub(r"\b(\w+)/(diameter|diâmetro|s|min)\b", r"\1 \2", text), flags=re.MULTILINE)
    return set(re.findall(r"(?<!-)[^\W\d]{3,}", text))


def enumerated(schema: object) -> set[str]:
    """All words that keys can have."""
    parts = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else []
    words = set(schema.get("enum", [])) if isinstance(schema, dict) else set()
    return {word for word in words if isinstance(word, str)}.union(*map(enumerated, parts))


def portuguese(program: str, folder: str) -> None:
    """With --language pt no English word is left in the answer to --check and in the lines of runs and studies."""
    kept = enumerated(json.loads(output(program, "--reference", "schema"))) | {"rpm", "bar", "mPa", "MPa", "mrad", "ideal", "diametral", "Lyapunov", "min"}
    cases = [path for path in sorted((TOP / "cases").rglob("*.nml")) if path.parent.name != "studies"]
    said = []

    def bare(text: str) -> str:
        """What the program said without the folders, whose names may have any words."""
        return text.replace(str(TOP), "").replace(folder, "")

    for command in (["--check", *map(str, cases)], ["sweep", "--check", *map(str, sorted((TOP / "cases" / "studies").glob("*.nml")))]):
        said.append([bare(subprocess.run([program, *command, "--language", language], capture_output=True, text=True).stdout) for language in ("en", "pt")])
        check(len(said[-1][1].splitlines()) == len(said[-1][0].splitlines()) > 10, f"as many lines: {command[:2]}")
    for case, *options in (
        ("flores/dry_0500um", "--certify"), ("sim_IV", "--certify"), ("cylinders/inline_four_bearings",), ("joints/piston_slap",), ("joints/skirt",),
        ("film/sim_I_fed",), ("pin/dry",), ("pin/engine", "-srun.until=end", "-sintegrator.crank_revolutions=2"), ("film/heat",), ("gas/compressor_valves",),
        ("flores/dry_0500um", "-srun.until=periodic", "-srun.most_revolutions=6"), ("flores/dry_0500um", "-srun.lyapunov_revolutions=5"),
        ("flores/lubricated_400cP", "-srun.until=periodic"), ("bearings/lemon_main",), ("wear/worn_bore", "-sintegrator.end_time=1e-3"),
        ("sim_IV", "-sjoint.clearance=1e-3", "-sintegrator.max_steps=30"),
    ):  # fmt: skip
        both = []
        for language in ("en", "pt"):
            path = TOP / "cases" / f"{case}.nml"
            done = subprocess.run([program, "--language", language, "-o", folder, *options, str(path)], capture_output=True, text=True, timeout=600)
            check(f"{path.stem}: " in done.stdout and f"{folder}/{path.stem}.csv; " in done.stdout, f"{case} {options}: {done.stdout[:300]}{done.stderr}")
            both.append(bare(done.stdout).replace(path.stem, ""))
        said.append(both)
    study = Path(folder) / "grid.nml"
    study.write_text(f"&study case = '{TOP}/cases/sim_I.nml' /\n&parameter key = 'integrator.max_steps', values = 100000, 5 /\n")
    said.append([bare(subprocess.run([program, "sweep", "--fresh", "--language", language, "-o", folder, str(study)], capture_output=True, text=True).stdout).replace("grid", "")
                 for language in ("en", "pt")])  # fmt: skip
    check("simulações" in said[-1][1], f"a study: {said[-1]}")
    for english, done in said:
        left = (words_of(english) & words_of(done)) - kept
        check(not left, f"no word stays English: {sorted(left)} in {done[:300]}")
        check(not re.search(r"\d\.\d", re.sub(r"\S*[/_=]\S*|^  aviso: .*$", "", done, flags=re.MULTILINE)), f"decimal commas: {done[:300]}")
    done = subprocess.run([program, "--language", "pt", "--resolved", str(cases[0])], capture_output=True, text=True)
    check(done.stdout == output(program, "--resolved", str(cases[0])), "a resolved case is one in every language")


#: Calls whose texts, and arguments whose texts, a picture or a page shows; texts that do not occur, or whose parts are translated.
SHOWN_BY, SHOWN_AS = {"set_xlabel", "set_ylabel", "set_title", "suptitle", "annotate", "text", "say"}, {"label", "title", "xlabel", "ylabel"}
OTHERS = {"None: {}.", "{}: {} cycle of a revolution, which repeat", "{}: {} cycle of {} revolutions, which repeat"}


def variants(node: ast.AST, known: dict[str, ast.AST]) -> list[str]:
    """The texts that an expression can be, {} for what only a run knows. `known`: expressions of local names."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return [node.value]
    if isinstance(node, ast.FormattedValue):
        return variants(node.value, known) or ["{}"]
    if isinstance(node, ast.IfExp):
        return variants(node.body, known) + variants(node.orelse, known)
    if isinstance(node, ast.Name) and node.id in known:
        return variants(known[node.id], {})
    parts = node.values if isinstance(node, ast.JoinedStr) else [node.left, node.right] if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add) else []
    found = [variants(part, known) or ["{}"] for part in parts]
    return ["".join(words) for words in itertools.product(*found)] if any(part != ["{}"] for part in found) else []


def texts(path: Path) -> set[str]:
    """The texts that a module shows, as far as they stand in its calls."""
    found: set[str] = set()
    module = ast.parse(path.read_text(encoding="utf-8"))
    constants = {node.targets[0].id: node.value for node in module.body if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)}
    for function in [node for node in ast.walk(module) if isinstance(node, ast.FunctionDef)]:
        grown = {node.target.id for node in ast.walk(function) if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name)}
        known = constants | {node.targets[0].id: node.value for node in ast.walk(function) if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id not in grown}
        for call in [node for node in ast.walk(function) if isinstance(node, ast.Call)]:
            name = getattr(call.func, "attr", getattr(call.func, "id", ""))
            shown = [*(call.args if name in SHOWN_BY else ()), *(word.value for word in call.keywords if word.arg in SHOWN_AS)]
            found.update(text for node in shown for text in variants(node, known))
    return found - OTHERS


def written_texts() -> None:
    """Every text in a call that shows one has its Portuguese, with a number or with nothing for what only a run knows."""
    count, said = 0, Language("pt")

    def is_known(text: str) -> bool:
        said.unknown.clear()
        said.say(text)
        return not said.unknown

    for path in sorted([*(TOP / "scripts/python/src/gudgeon").rglob("*.py"), *(TOP / "scripts/bench").glob("*.py")]):
        for text in sorted(texts(path)):
            values = itertools.product(("1", ""), repeat=text.count("{}"))
            check(any(is_known(text.format(*found)) for found in values), f"{path.name}: no Portuguese of {text!r}")
            count += 1
    check(count > 150, f"texts in calls: {count}")


def meanings() -> None:
    """The explorer tells in Portuguese what each of its keys is; no translation is of a text that is gone."""
    said, shown = Language("pt"), {key.meaning: key for key in gudgeon.keys.values() if key.name == "oil" or (key.kind != "text" and key.count == 1)}
    for key in shown.values():
        said.unknown.clear()
        text = key.described(said.say)
        check(not said.unknown and ("padrão" in text or "obrigatória" in text), f"{key.group}.{key.name}: no Portuguese of {sorted(said.unknown)}: {text}")
    check(len(shown) > 250 and MEANINGS.keys() <= shown.keys(), f"portuguese_keys.py: no key has {sorted(MEANINGS.keys() - shown.keys())}")


def glossary() -> None:
    """The Portuguese glossary has the words of the English one, and those of pictures, pages and the program."""
    tables = [re.findall(r"^\| ([^|]+) \| ([^|]+) \|", (TOP / f"data/manual/glossary{end}.md").read_text(encoding="utf-8"), re.MULTILINE)[1:] for end in ("", "_pt")]
    ours, words = ({word for english, _ in table for word in re.split(", ", english)} for table in tables)
    missing = ours - words - {"digest", "mobility", "chatter", "place", "row of a study", "row", "column"}
    check(not missing, f"glossary_pt.md lacks {sorted(missing)}")
    printed = dict(re.findall(r"^    '(.*)', '(.*)', &$", (TOP / "src/io/portuguese.f90").read_text(encoding="utf-8"), re.MULTILINE))
    for english, portuguese in tables[1]:
        for word, said in zip(english.split(", "), portuguese.split("; ")[0].split(", ")):
            for texts_of in (TEXTS, printed):
                other = {"bore", "speed", "frame", "impact"}  # the diameter, of the animation, axes of a load, a law
                check(word in other or texts_of.get(word, said) == said, f"{word}: {said} in glossary_pt.md, but {texts_of.get(word)}")


#: Small studies: over a law, so that words stand at an axis; of two numbers; from a table, so that it has no grid.
STUDIES = {
    "words": "&study case = '{top}/cases/flores/dry_0500um.nml', title = 'Leis' /\n&parameter key = 'contact.law', values = 'exact', 'hertz' /\n",
    "grid": "&study case = '{top}/cases/sim_I.nml', title = 'Filmes' /\n&parameter key = 'joint.clearance', from = 1e-5, to = 3e-5, count = 2 /\n"
    "&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02, count = 2 /\n",
}

#: Words that are Portuguese too, and names in what is printed.
SAME = {"degC", "angular", "normal", "sigma", "morris", "sobol", "star", "Poincaré"}

#: What gudgeon-plot draws and prints of shipped cases, by the case of each command.
DRAWN: dict[str, tuple[str, ...]] = {
    "sim_I": ("columns", "laws", "compare {folder}/sim_I_fed.csv", "table", "export"), "film/sim_I_fed": ("film", "bearing"), "wear/flores": ("wear",),
    "flores/dry_0500um": ("columns --columns normal_force pin_force_x crank_moment --over time", "report"), "pin/engine": ("report --short", "table"),
    "joints/piston": ("skirt", "report"), "joints/piston_slap": ("report --short",), "joints/rings": ("orders",), "gas/compressor_valves": ("indicator", "report --short"),
    "film/heat": ("bearing --place crank_pin",), "cylinders/inline_four_bearings": ("bearing", "report"), "cylinders/six_mwm": ("campbell", "report --short"),
    "bearings/big_end": ("report --short",),
}  # fmt: skip


def plotted(words: list[str]) -> tuple[str, str, set[str]]:
    """What a command of gudgeon-plot prints, its errors, and the texts for which it lacks a translation."""
    with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(io.StringIO()) as errors:
        try:
            status = cli.main(words)
        except SystemExit as refusal:
            status = refusal.code
    check(status == 0, f"gudgeon-plot {' '.join(words)}: {errors.getvalue()}")
    return said.getvalue(), errors.getvalue(), gudgeon.language.current.unknown


def plots(program: str, folder: str) -> None:
    """With --language pt no text of a picture or a page of gudgeon-plot lacks its Portuguese, and no English word is left in what it prints."""
    commands = []
    for case in DRAWN:
        subprocess.run([program, "-q", "-o", folder, str(TOP / "cases" / f"{case}.nml")], check=True, stderr=subprocess.DEVNULL)
    for case, drawn in DRAWN.items():
        for command in drawn:
            what, *options = command.format(folder=folder).split()
            out = [] if what == "table" else ["-o", f"{folder}/out{'.pdf' if '--short' in options else '/'}"]
            commands.append([what, f"{folder}/{Path(case).name}.csv", *options, *out])
    Path(folder, "out").mkdir()
    for name, text in STUDIES.items():
        study = Path(folder, f"{name}.nml")
        study.write_text(text.format(top=TOP))
        subprocess.run([program, "sweep", "-q", "-o", folder, str(study)], check=True)
        commands.append(["study", f"{folder}/{name}.runs.csv", "-o", f"{folder}/out"])
    study = str(Path(folder, "grid.nml"))
    settings = ("--set", "contact.dissipation=3.55", "--set", "integrator.revolutions=200")
    Path(folder, "flip.nml").write_text(output(program, *settings, "--resolved", str(TOP / "cases/flores/dry_0100um.nml")))
    commands += [
        ["table", f"{folder}/grid.runs.csv"], ["sample", study, "--runs", "4", "-o", folder], ["figure", "--list"],
        ["sensitivity", study, "--program", program, "--morris", "4", "--sobol", "4", "--convergence", "--fresh", "-o", f"{folder}/out"],
        ["sensitivity", "--table", study, "-o", f"{folder}/out"], ["models", str(TOP / "cases/flores/ideal.nml"), "--set", "integrator.revolutions=0.2", "--program", program, "-o", folder],
        ["branch", f"{folder}/flip.nml", "initial.crank_speed", "760", "705", "-o", f"{folder}/out"],
    ]  # fmt: skip
    kept = enumerated(json.loads(output(program, "--reference", "schema"))) | UNTRANSLATED | {Path(words[1]).stem for words in commands} | SAME
    for words in commands:
        said, errors, unknown = plotted([*words, "--language", "pt"])
        check(not unknown and "no translation" not in errors, f"{words}: no Portuguese of {sorted(unknown)}")
        if [line for line in said.splitlines() if not re.fullmatch(rf"({re.escape(folder)}\S+ ?)+([\d,]+ MB)?", line)]:
            left = (words_of(plotted([*words, "--language", "en"])[0]) & words_of(said)) - kept
            check(not left, f"{words}: no word stays English: {sorted(left)}")
            wrong = [] if words[0] in ("table", "models", "figure") else re.findall(r"^(?! {4}|.*[/=]).*\d\.\d.*$", said, re.MULTILINE)
            check(not wrong, f"{words}: decimal commas: {wrong}")


def manual_page(program: str) -> None:
    page = output(program, "--man")
    with tempfile.NamedTemporaryFile("w", suffix=".1") as file:
        file.write(page)
        file.flush()
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-wall", file.name], capture_output=True, text=True)
            check(done.returncode == 0 and not done.stderr, f"groff: {done.stderr[:300]}")
        if shutil.which("mandoc"):
            done = subprocess.run(["mandoc", "-Tlint", file.name], capture_output=True, text=True)
            check(done.returncode == 0, f"mandoc: {done.stdout[:300]}")
    for word in (".SH OPTIONS", ".SH EXIT STATUS", ".SH FILES", r"\-\-certify"):
        check(word in page, f"the manual page has {word}")


def installed(program: str) -> None:
    """scripts/install.sh puts the manual page and the completions where man and the shells look."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([TOP / "scripts/install.sh", f"{folder}/bin"], capture_output=True, text=True)
        check(done.returncode == 0 and len(done.stdout.splitlines()) == 5, f"install.sh: {done.stdout}{done.stderr}")
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "XDG_DATA_HOME": f"{folder}/share"}
        page = Path(folder, "share/man/man1/gudgeon.1")
        check(page.read_text() == output(program, "--man"), "the manual page")
        if shutil.which("man"):
            environment.pop("MANPATH", None)
            said = subprocess.run(["man", "-w", "gudgeon"], capture_output=True, text=True, env=environment).stdout
            check(said.strip() == str(page), f"man finds it: {said}")
        for path, shell in (("bash-completion/completions/gudgeon", "bash"), ("zsh/site-functions/_gudgeon", "zsh"),
                            ("fish/vendor_completions.d/gudgeon.fish", "fish")):  # fmt: skip
            check(Path(folder, "share", path).read_text() == output(program, "--completion", shell), path)
        loader = Path("/usr/share/bash-completion/bash_completion")
        if loader.is_file():
            script = f". {loader}; _completion_loader gudgeon; complete -p gudgeon"
            said = subprocess.run(["bash", "-c", script], capture_output=True, text=True, env=environment).stdout
            check("_gudgeon" in said, f"bash-completion loads it: {said}")


def main() -> int:
    program = os.path.abspath(sys.argv[1])
    schema(program)
    units(program)
    written_by_f90nml(program)
    completion(program)
    manual_page(program)
    installed(program)
    with tempfile.TemporaryDirectory() as folder:
        portuguese(program, folder)
    written_texts()
    meanings()
    glossary()
    with tempfile.TemporaryDirectory() as folder:
        plots(program, folder)
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
