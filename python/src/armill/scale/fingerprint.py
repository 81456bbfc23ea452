"""What a sweep was asked, in words that fit into a manifest: two sweeps are the same if these words are.

Short values stand as they are, everything else as SHA-256 of its bytes: arrays with their type and shape, functions with
their source and what they enclose, other objects with what a pickle would hold of them. Not seen: what a function reads
from elsewhere, a file or a global value.
"""

from __future__ import annotations

import dataclasses
import hashlib
import inspect
import os
import types
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

import armill
from armill import _armill
from armill.scale.errors import refused
from armill.scale.sweep import Sweep

#: A text up to this length stands in a manifest as it is.
SHORT = 60
#: Objects in objects, at the most.
DEEPEST = 20


def asked(sweep: Sweep) -> dict[str, str]:
    """sweep -> what was asked, by name."""
    # Machines that round otherwise give other bits.
    told = {"armill": armill.__version__, "arithmetic": _armill.arithmetic()}
    told |= {f"axis {name}": str(length) for name, length in sweep.axes.items()}
    told |= {"evaluations_per_item": str(sweep.evaluations_per_item), "seed": str(sweep.seed)}
    work = sweep.work
    if dataclasses.is_dataclass(work) and not isinstance(work, type):
        told["work"] = _words(type(work), 0)
        for part in dataclasses.fields(work):
            told[f"work.{part.name}"] = _words(getattr(work, part.name), 0)
    else:
        told["work"] = _words(work, 0)
    return told


def fingerprint(told: Mapping[str, str]) -> str:
    """What was asked -> SHA-256 of it."""
    lines = "".join(f"{name}\0{told[name]}\0" for name in sorted(told))
    return hashlib.sha256(lines.encode()).hexdigest()


def _hashed(*parts: str | bytes) -> str:
    whole = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        whole.update(len(data).to_bytes(8, "little"))
        whole.update(data)
    return f"sha256:{whole.hexdigest()}"


def _words(value: Any, depth: int) -> str:
    if depth > DEEPEST:
        raise refused("what the work holds goes round in a circle", "let it hold arrays, numbers and texts")
    if value is None or isinstance(value, (bool, int, float, complex)):
        return repr(value)
    if isinstance(value, np.generic):
        return repr(cast("Any", value).item())
    if isinstance(value, (str, os.PathLike)):
        text = os.fspath(cast("str | os.PathLike[str]", value))
        return repr(text) if len(text) <= SHORT else f"{len(text)} characters, {_hashed(text)}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes, {_hashed(value)}"
    if isinstance(value, np.ndarray):
        return _array_words(value, depth)  # pyright: ignore
    if isinstance(value, Mapping):
        pairs: list[tuple[Any, Any]] = list(value.items())  # pyright: ignore
        return _hashed("mapping", *(_words(part, depth + 1) for pair in pairs for part in pair))
    if isinstance(value, Sequence):
        parts: list[Any] = list(value)  # pyright: ignore
        return _hashed("sequence", *(_words(part, depth + 1) for part in parts))
    if isinstance(value, types.FunctionType):
        return _function_words(value, depth)
    if isinstance(value, (type, types.BuiltinFunctionType)):
        return _named(value)
    return _object_words(value, depth)


def _array_words(array: np.ndarray[Any, Any], depth: int) -> str:
    kind = f"{array.dtype.str} {'x'.join(map(str, array.shape))}"
    if array.dtype.hasobject:
        return f"{kind}, {_words(array.tolist(), depth + 1)}"
    return f"{kind}, {_hashed(np.ascontiguousarray(array).tobytes())}"


def _function_words(function: types.FunctionType, depth: int) -> str:
    enclosed = [cell.cell_contents for cell in function.__closure__ or ()]
    held = _words([enclosed, function.__defaults__, function.__kwdefaults__], depth + 1)
    return f"{function.__module__}.{function.__qualname__}, {_hashed(_source(function), held)}"


def _named(value: Any) -> str:
    name = f"{value.__module__}.{value.__qualname__}"
    # The version of armill stands for the source of all that is in it.
    own = name.startswith(("armill.", "builtins."))
    return name if own or not isinstance(value, type) else f"{name}, {_hashed(_source(value))}"


def _source(value: Any) -> str | bytes:
    try:
        return inspect.getsource(value)
    except (OSError, TypeError):
        code = getattr(value, "__code__", None)
        return b"" if code is None else _code_words(code)


def _code_words(code: types.CodeType) -> bytes:
    """Of what was typed in and has no source: what it does."""
    held = [_code_words(part) if isinstance(part, types.CodeType) else repr(part).encode() for part in code.co_consts]
    return _hashed(code.co_code, repr(code.co_names), *held).encode()


def _object_words(value: Any, depth: int) -> str:
    if dataclasses.is_dataclass(value):
        parts: Any = [(part.name, getattr(value, part.name)) for part in dataclasses.fields(value)]
        kind = type(value)
        return f"{kind.__module__}.{kind.__qualname__}, {_words([kind, parts], depth + 1)}"
    try:
        reduced: Any = value.__reduce_ex__(4)
    except TypeError as error:
        raise refused(f"work holds a {type(value).__name__}, which cannot travel: {error}", "let it hold what pickles") from error
    if isinstance(reduced, str):
        return reduced
    # Iterators of items, if there are any, are looked at as lists.
    parts = [list(part) if hasattr(part, "__next__") else part for part in reduced]
    return f"{type(value).__module__}.{type(value).__qualname__}, {_words(parts, depth + 1)}"
