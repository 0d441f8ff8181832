"""gudgeon: dynamics of the slider-crank mechanism with clearance in its joints.

>>> import gudgeon
>>> case = gudgeon.template("dry")
>>> run = case.set({"joint.clearance": "40e-6"}).run(end=0.1)
>>> run.status, bool(run.piston_acceleration.max() > 0)
('done', True)
"""

from __future__ import annotations

import importlib
from typing import Any

_HOMES = {
    "Case": "case", "CaseError": "case", "Column": "_library", "read": "case", "template": "case",
    "Run": "run", "RunError": "run", "Summary": "run", "Certificate": "run", "load": "files", "compare": "run",
    "orders": "run", "Page": "run",
    "Stepper": "stepper", "Snapshot": "stepper", "Inputs": "stepper",
    "sweep": "_sweep", "schema": "_schema", "fmu": "_fmu", "table": "_table", "Table": "_table",
    "fit": "_fit", "Fit": "_fit", "levels": "_fit", "tolerances": "_tolerances", "Tolerances": "_tolerances",
    "read_pressure": "_rig", "RigFileError": "_rig", "heat_release": "_heat", "HeatRelease": "_heat",
    "Key": "_keys", "keys": "_keys", "groups": "_keys",
    "orbit": "_orbit", "continuation": "_orbit", "Orbit": "_orbit", "Branch": "_orbit", "OrbitError": "_orbit",
}  # fmt: skip

__all__ = [*_HOMES, "certify", "version"]  # pyright: ignore


def __getattr__(name: str) -> Any:
    """Names are imported when they are first used."""
    if name not in _HOMES:
        raise AttributeError(f"module gudgeon has no attribute {name}")
    value = getattr(importlib.import_module(f"gudgeon.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


def certify(case: Any) -> Any:
    """How many digits of a run of the case are right."""
    return case.certify()


def version() -> str:
    """The version of the program."""
    from . import _library

    return _library.text_from(_library.library().version)
