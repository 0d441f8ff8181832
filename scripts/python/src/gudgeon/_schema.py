"""The JSON Schema of cases, from the declarations of the program."""

from __future__ import annotations

import json
from typing import Any

from . import _library


def schema() -> dict[str, Any]:
    """The JSON Schema (2020-12) of a case as an object of groups, each an object of keys: that of a case read by f90nml, or written
    as JSON."""
    return json.loads(_library.text_from(_library.library().schema, guess=100000))
