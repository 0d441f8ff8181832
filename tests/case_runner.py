"""Runs of the program for tests that read its results with pandas, each in a folder of its own."""
from __future__ import annotations

import subprocess
from pathlib import Path

import pandas as pd


def bare(frame: pd.DataFrame) -> pd.DataFrame:
    """A table whose columns have their names without units."""
    return frame.rename(columns=lambda name: name.partition("[")[0])


class Runner:
    """Runs cases, given by their files or their texts, with changes GROUP.KEY=VALUE."""

    def __init__(self, program: str, folder: Path) -> None:
        self.program, self.folder, self.number = program, folder, 0

    def __call__(self, case: str | Path, *changes: str) -> tuple[pd.DataFrame, dict[str, str]]:
        """The trace and the summary of a run, which must succeed."""
        self.number += 1
        options = [part for change in changes for part in ("--set", change)]
        done = subprocess.run([self.program, "-q", "-o", self.folder / str(self.number), *options, str(self.file(case))],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        summary = pd.read_csv(self.result(case, "summary.csv"), dtype=str).set_index("quantity")["value"].to_dict()
        return pd.read_csv(self.result(case, "csv")), summary

    def result(self, case: str | Path, suffix: str) -> Path:
        """A file of the last run."""
        return self.folder / str(self.number) / f"{self.file(case).stem}.{suffix}"

    def file(self, case: str | Path) -> Path:
        """The file of a case, or of the text of one."""
        if isinstance(case, Path):
            return case
        path = self.folder / f"case_{abs(hash(case))}.nml"
        path.write_text(case)
        return path

    def refused(self, case: str | Path, *changes: str) -> str:
        """The message of a case that is wrong; empty if it is not."""
        options = [part for change in changes for part in ("--set", change)]
        done = subprocess.run([self.program, "--check", *options, str(self.file(case))], capture_output=True, text=True, check=False)
        return done.stderr if done.returncode == 3 else ""
