"""Runs the program and reads the files that it writes."""
from __future__ import annotations

import csv
import dataclasses
import math
import re
import subprocess
import tempfile
from pathlib import Path

Values = dict[str, list]         # values of a case: 'joint.clearance' -> [4e-05]
REPEATED = "cylinder", "damper", "valve", "ring"   # groups that are numbered in their order
Columns = dict[str, list[float]]  # columns of a trace: 'crank_angle' -> values


@dataclasses.dataclass
class Run:
    """The result of one run of the program: exit status, message, resolved case, columns, contact events, summary and
    worn surfaces."""

    status: int
    message: str
    case: Values = dataclasses.field(default_factory=dict)
    columns: Columns = dataclasses.field(default_factory=dict)   # without those of bearings that the mechanism does not feel
    every: Columns = dataclasses.field(default_factory=dict)     # all columns
    events: list[dict[str, str]] = dataclasses.field(default_factory=list)
    summary: dict[str, str] = dataclasses.field(default_factory=dict)
    worn: list[dict[str, str]] = dataclasses.field(default_factory=list)
    folder: Path = Path()      # of the case file
    state: str = ""            # text of the state at the end

    def number(self, key: str, default: float = 0.0) -> float:
        """A value of the case; `default` if its group is absent."""
        return self.case.get(key, [default])[0]

    def pair(self, key: str) -> tuple[float, float]:
        one, two = self.case[key]
        return one, two

    def text(self, key: str) -> str:
        return self.case.get(key, [""])[0]

    @property
    def times(self) -> list[float]:
        return self.columns["time"]

    @property
    def has_clearance(self) -> bool:
        return self.text("joint.kind") == "clearance"

    @property
    def has_loose_crank_pin(self) -> bool:
        return self.text("crank_pin.joint.kind") == "clearance"

    @property
    def has_guide(self) -> bool:
        return "guide.kind" in self.case or "ring_friction_force" in self.columns

    @property
    def has_loose_guide(self) -> bool:
        return self.text("guide.kind") in ("clearance", "lubricated")

    def at(self, joint: str) -> Run:
        """The run seen from one joint: its group, laws, columns and events under the names that those of the piston pin have."""
        case = {key: value for key, value in self.case.items() if not (joint != "piston_pin" and key.startswith("joint."))}
        case |= {key.removeprefix(f"{joint}."): value for key, value in self.case.items() if key.startswith(f"{joint}.")}
        columns = self.columns
        if joint != "piston_pin":
            columns = columns | {name.removeprefix(f"{joint}_"): column for name, column in columns.items() if name.startswith(f"{joint}_")}
        return dataclasses.replace(self, case=case, columns=columns, worn=[row for row in self.worn if row["joint"] == joint],
                                   events=[event for event in self.events if event.get("joint", "piston_pin") == joint])


def read_case(text: str) -> Values:
    """The values of a resolved case file by group and key; crank_pin.joint.clearance if the group belongs to one joint."""
    values: Values = {}
    group = ""
    groups: list[str] = []
    for line in text.splitlines():
        if line.startswith("&"):
            groups.append(line[1:].strip())
            group = groups[-1]
            if group in REPEATED:
                group += f"_{groups.count(group)}"
        found = re.match(r"\s+(\w+) = (.*)$", line)
        if not found:
            continue
        key, rest = found.groups()
        quoted = re.match(r"'((?:[^']|'')*)'", rest)
        if key == "place":   # the first key of a group that belongs to one joint
            group = f"{quoted[1]}.{group}"
        elif quoted:
            values[f"{group}.{key}"] = [quoted[1]]
        else:
            rest = rest.split("!")[0]
            values[f"{group}.{key}"] = [word.strip() == ".true." if word.strip().startswith(".t") or word.strip().startswith(".f")
                                        else float(word) for word in rest.split(",")]
    return values


def read_columns(path: Path) -> Columns:
    """A trace, without the units of its column names. Cells that are not numbers become NaN, which fails every check."""
    with path.open() as file:
        names = [name.split("[")[0] for name in file.readline().strip().split(",")]
        rows = []
        for line in file:
            try:
                row = [float(cell) for cell in line.split(",")]
            except ValueError:
                row = [math.nan] * len(names)
            rows.append(row)
    return {name: list(column) for name, column in zip(names, zip(*rows))} if rows else {name: [] for name in names}


def without_carried(case: Values, columns: Columns) -> Columns:
    """The columns without those of bearings of kind quasi_static, which the mechanism does not feel: their pins are ideal."""
    own = ("eccentricity_", "film_", "phase", "asperity_", "friction_", "sliding_", "wall_", "bore_wear", "pin_wear", "max_film", "neglected_")
    for place, prefix in (("", ""), ("crank_pin.", "crank_pin_"), ("main_bearing.", "main_bearing_")):
        if case.get(f"{place}joint.kind") == ["quasi_static"]:
            columns = {name: column for name, column in columns.items() if not re.match(rf"{prefix}(\d+_)?({'|'.join(own)})", name)}
    return columns


def read_run(folder: Path, name: str, status: int = 0, message: str = "") -> Run:
    """The results of the case NAME in a folder."""
    run = Run(status, message)
    for suffix in (".resolved.nml", ".csv", ".summary.csv"):
        if not (folder / f"{name}{suffix}").exists():
            return run
    run.state = (folder / f"{name}.state.nml").read_text() if (folder / f"{name}.state.nml").exists() else ""
    run.case = read_case((folder / f"{name}.resolved.nml").read_text())
    run.every = read_columns(folder / f"{name}.csv")
    run.columns = without_carried(run.case, run.every)
    with (folder / f"{name}.summary.csv").open(newline="") as lines:
        run.summary = {row[0]: row[1] for row in csv.reader(lines)}
    for end, rows in ((".events.csv", run.events), (".wear.csv", run.worn)):
        if (folder / f"{name}{end}").exists():
            with (folder / f"{name}{end}").open(newline="") as lines:
                rows.extend(csv.DictReader(lines))
    return run


def run_case(program: Path, case: Path, settings: dict[str, str], limit: float = 300.0, state: str = "") -> Run:
    """Run one case with additional settings, in a temporary folder, from the text of a state if one is given. Status -1: it took more
    than `limit` seconds."""
    with tempfile.TemporaryDirectory(prefix="judged") as out:
        words = [str(program), "-q", "-j", "1", "-o", out]
        for key, value in settings.items():
            words += ["--set", f"{key}={value}"]
        if state:
            (Path(out) / "begin.state.nml").write_text(state)
            words += ["--from", f"{out}/begin.state.nml"]
        try:
            done = subprocess.run([*words, str(case)], capture_output=True, text=True, timeout=limit, check=False)
        except subprocess.TimeoutExpired:
            return Run(-1, f"more than {limit:g} s")
        return dataclasses.replace(read_run(Path(out), case.stem, done.returncode, done.stderr.strip()), folder=case.parent)


def merged(one: Run, other: Run) -> Run:
    """The rows of two runs of the same motion, sorted by time; of two rows at the same time that of `one` is kept."""
    order = sorted([(t, 0, i) for i, t in enumerate(one.times)] + [(t, 1, i) for i, t in enumerate(other.times)])
    order = [here for k, here in enumerate(order) if k == 0 or here[0] > order[k - 1][0]]
    sources = (one.every, other.every)
    every = {name: [sources[k][name][i] for _, k, i in order] for name in one.every}
    return dataclasses.replace(one, every=every, columns={name: every[name] for name in one.columns})
