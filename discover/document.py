"""A document as JSON text: every number finite or null."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np


def json_text(document: Mapping[str, Any]) -> str:
    """Return `document` as JSON with a newline at its end.

    Raises
    ------
    TypeError
        For a value that JSON has no form for.

    Examples
    --------
    >>> json_text({"a": float("inf"), "b": np.float64(0.5), "c": (np.int64(1),)}).split()
    ['{', '"a":', 'null,', '"b":', '0.5,', '"c":', '[', '1', ']', '}']
    """
    return json.dumps(_plain(document), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
