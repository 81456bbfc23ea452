"""The request of a sweep as text for the manifest: two sweeps are the same if these texts are equal.

Short values are written as they are, everything else as the SHA-256 of its bytes: arrays with type and shape, functions with
source, closure and the global values that their code names, other objects with the contents of their pickle. Not included:
what a function reads from a file, and the contents of other packages.
"""

from __future__ import annotations

import dataclasses
import dis
import functools
import hashlib
import inspect
import os
import sys
import sysconfig
import threading
import types
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
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
#: Functions whose words are being written: one that calls itself is named only.
_OPEN: ContextVar[tuple[types.FunctionType, ...]] = ContextVar("_OPEN", default=())
#: One thread parses at a time: in CPython 3.11 others make it a SystemError (python/cpython#106905).
_PARSING = threading.Lock()


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
    name = f"{function.__module__}.{function.__qualname__}"
    if function in _OPEN.get() or _is_installed(function.__module__):
        return name
    token = _OPEN.set((*_OPEN.get(), function))
    try:
        enclosed = [cell.cell_contents for cell in function.__closure__ or ()]
        content = _words([enclosed, function.__defaults__, function.__kwdefaults__], depth + 1)
        used = _hashed(*(part for pair in _globals(function) for part in (pair[0], _global_words(*pair, depth + 1))))
    finally:
        _OPEN.reset(token)
    return f"{name}, {_hashed(_source(function), content, used)}"


def _globals(function: types.FunctionType) -> list[tuple[str, Any]]:
    """Name and value of each global that the code of a function names, and the code in it."""
    known = function.__globals__
    return [(name, known[name]) for name in sorted(set(_global_names(function.__code__))) if name in known]


def _global_names(code: types.CodeType) -> Iterator[str]:
    yield from (str(step.argval) for step in dis.get_instructions(code) if step.opname in ("LOAD_GLOBAL", "LOAD_NAME"))
    for part in code.co_consts:
        if isinstance(part, types.CodeType):
            yield from _global_names(part)


def _global_words(name: str, value: Any, depth: int) -> str:
    """The words of a global; of a module its name."""
    if isinstance(value, types.ModuleType):
        return value.__name__
    try:
        return _words(value, depth)
    except Exception as error:
        hint = "pass what it reads as an argument, or use a work object with it"
        raise refused(f"work: the global `{name}` that it uses cannot be identified: {error}", hint) from error


def _named(value: Any) -> str:
    name = f"{value.__module__}.{value.__qualname__}"
    if not isinstance(value, type) or _is_installed(value.__module__):
        return name
    members: list[Any] = list(vars(value).values())
    methods = [method for method in members if isinstance(method, types.FunctionType) and method not in _OPEN.get()]
    token = _OPEN.set((*_OPEN.get(), *methods))
    try:
        used = {name: each for method in methods for name, each in _globals(method) if each is not value}
        words = [part for pair in sorted(used.items()) for part in (pair[0], _global_words(*pair, 1))]
    finally:
        _OPEN.reset(token)
    return f"{name}, {_hashed(_source(value), *words)}"


@functools.cache
def _is_installed(module: str | None) -> bool:
    """Whether a module is part of Python or of an installed package, which their versions identify."""
    # Code that was executed without a module is not.
    if module is None:
        return False
    if module.partition(".")[0] in ("armill", "builtins"):
        return True
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None:
        return module != "__main__" and module in sys.builtin_module_names
    places = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    return any(Path(file).resolve().is_relative_to(Path(place).resolve()) for place in places if place)


def _source(value: Any) -> str | bytes:
    code = getattr(value, "__code__", None)
    try:
        with _PARSING:
            source = inspect.getsource(value)
    except (OSError, TypeError):
        return b"" if code is None else _code_words(code)
    # The source of a lambda is that of its line, which may have others.
    if code is not None and source.count("lambda") > 1 and value.__name__ == "<lambda>":
        return source.encode() + _code_words(code)
    return source


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
