# SPDX-License-Identifier: BSD-3-Clause
"""What the results have in common."""

import dataclasses
from typing import Any, Dict

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Bools = npt.NDArray[np.bool_]


def _text_of(value: Any) -> str:
    """Short: an array is told by its shape, and so is what has many elements."""
    if isinstance(value, np.ndarray):
        return str(value.tolist()) if value.size <= 4 else f"array of shape {value.shape}"
    if isinstance(value, Record):
        return f"{type(value).__name__}(...)"
    if isinstance(value, dict) or (isinstance(value, tuple) and len(value) > 4):
        return f"{type(value).__name__} of {len(value)}"
    if isinstance(value, tuple) and not hasattr(value, "_fields"):
        return "(" + ", ".join(map(_text_of, value)) + ")"
    return repr(value)


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.array_equal(a, b)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_equal(a[key], b[key]) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(_equal, a, b))
    return bool(a == b)


class Record:
    """Base of the results: a short repr, and comparison that knows arrays."""

    def _fields(self) -> Dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}  # type: ignore[arg-type]

    def __repr__(self) -> str:
        texts = (f"{name}={_text_of(value)}" for name, value in self._fields().items())
        return f"{type(self).__name__}({', '.join(texts)})"

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        assert isinstance(other, Record)
        theirs = other._fields()
        return all(_equal(value, theirs[name]) for name, value in self._fields().items())

    __hash__ = None  # type: ignore[assignment]
