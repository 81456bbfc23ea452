"""What identifies the work of a sweep: its source, closure and globals."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import armill
from armill.scale import Sweep
from armill.scale.fingerprint import request_of

FACTOR = 2.0
TABLE = np.arange(5.0)
LOCK = threading.Lock()


def helper(value: Any) -> Any:
    return value * FACTOR


class Inner:
    size = 3

    def scaled(self, block: Any) -> Any:
        return TABLE[block["i"]] * self.size


def by_global(block: Any) -> Mapping[str, Any]:
    return {"y": FACTOR * block["i"]}


def by_helper(block: Any) -> Mapping[str, Any]:
    return {"y": helper(block["i"])}


def by_comprehension(block: Any) -> Mapping[str, Any]:
    return {"y": [TABLE[i] for i in block["i"]]}


def by_class(block: Any) -> Mapping[str, Any]:
    return {"y": Inner().scaled(block)}


def by_module(block: Any) -> Mapping[str, Any]:
    return {"y": np.sin(block["i"])}


def recursive(block: Any, depth: int = 3) -> Mapping[str, Any]:
    return recursive(block, depth - 1) if depth else {"y": FACTOR * block["i"]}


def by_lock(block: Any) -> Mapping[str, Any]:
    with LOCK:
        return {"y": block["i"]}


def work(function: Any) -> str:
    return request_of(Sweep({"i": 5}, function))["work"]


@pytest.mark.parametrize("function", [by_global, by_helper, recursive])
def test_a_changed_global_is_another_sweep(function: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    before = work(function)
    assert work(function) == before
    monkeypatch.setitem(globals(), "FACTOR", 3.0)
    assert work(function) != before


@pytest.mark.parametrize("function", [by_comprehension, by_class])
def test_a_changed_array_is_another_sweep(function: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    before = work(function)
    monkeypatch.setitem(globals(), "TABLE", TABLE + 1)
    assert work(function) != before


def test_a_changed_helper_is_another_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    before = work(by_helper)

    def helper(value: Any) -> Any:
        return value

    monkeypatch.setitem(globals(), "helper", helper)
    assert work(by_helper) != before


def test_globals_that_are_not_used_and_modules_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    before = work(by_module)
    monkeypatch.setitem(globals(), "FACTOR", 3.0)
    assert work(by_module) == before


def test_two_lambdas_on_a_line_differ() -> None:
    one, other = (lambda block: {"y": block["i"]}), (lambda block: {"y": 2 * block["i"]})
    assert work(one) != work(other)
    assert work(one) == work(one)


def test_a_global_that_cannot_be_identified_is_named() -> None:
    with pytest.raises(armill.InputError, match="the global `LOCK` that it uses cannot be identified"):
        work(by_lock)
