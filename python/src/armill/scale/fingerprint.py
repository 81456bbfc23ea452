"""The request of a sweep as text for the manifest: two sweeps are the same if these texts are equal.

Short values are written as they are, everything else as the SHA-256 of its bytes: arrays with type and shape, functions with
source and closure, other objects with the contents of their pickle. Not included: what a function reads from a file or a
global value.
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

#: A text up to this length is written to the manifest as it is.
SHORT = 60
#: Largest depth of nested objects.
DEEPEST = 20


def request_of(sweep: Sweep) -> dict[str, str]:
    """sweep -> its request: texts by name."""
    # Machines that round differently give different bits.
    request = {"armill": armill.__version__, "arithmetic": _armill.arithmetic()}
    request |= {f"axis {name}": str(length) for name, length in sweep.axes.items()}
    request |= {"evaluations_per_item": str(sweep.evaluations_per_item), "seed": str(sweep.seed)}
    work = sweep.work
    if dataclasses.is_dataclass(work) and not isinstance(work, type):
        request["work"] = _words(type(work), 0)
        for part in dataclasses.fields(work):
            request[f"work.{part.name}"] = _words(getattr(work, part.name), 0)
    else:
        request["work"] = _words(work, 0)
    return request


def fingerprint(request: Mapping[str, str]) -> str:
    """request -> its SHA-256."""
    lines = "".join(f"{name}\0{request[name]}\0" for name in sorted(request))
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
        raise refused("work: its objects contain each other", "use arrays, numbers and texts in it")
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
    content = _words([enclosed, function.__defaults__, function.__kwdefaults__], depth + 1)
    return f"{function.__module__}.{function.__qualname__}, {_hashed(_source(function), content)}"


def _named(value: Any) -> str:
    name = f"{value.__module__}.{value.__qualname__}"
    # The version of armill identifies all of its source.
    own = name.startswith(("armill.", "builtins."))
    return name if own or not isinstance(value, type) else f"{name}, {_hashed(_source(value))}"


def _source(value: Any) -> str | bytes:
    try:
        return inspect.getsource(value)
    except (OSError, TypeError):
        code = getattr(value, "__code__", None)
        return b"" if code is None else _code_words(code)


def _code_words(code: types.CodeType) -> bytes:
    """The bytecode of code without source, such as interactive input."""
    content = [_code_words(part) if isinstance(part, types.CodeType) else repr(part).encode() for part in code.co_consts]
    return _hashed(code.co_code, repr(code.co_names), *content).encode()


def _object_words(value: Any, depth: int) -> str:
    if dataclasses.is_dataclass(value):
        parts: Any = [(part.name, getattr(value, part.name)) for part in dataclasses.fields(value)]
        kind = type(value)
        return f"{kind.__module__}.{kind.__qualname__}, {_words([kind, parts], depth + 1)}"
    try:
        reduced: Any = value.__reduce_ex__(4)
    except TypeError as error:
        raise refused(f"work contains a {type(value).__name__}, which cannot be pickled: {error}", "use objects that can be pickled") from error
    if isinstance(reduced, str):
        return reduced
    # Iterators of items are treated as lists.
    parts = [list(part) if hasattr(part, "__next__") else part for part in reduced]
    return f"{type(value).__module__}.{type(value).__qualname__}, {_words(parts, depth + 1)}"
