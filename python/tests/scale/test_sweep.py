"""Requests, their parts, and the resulting rows."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import armill
from armill import scale
from armill.scale import planning
from armill.scale.fingerprint import request_of

from . import works
from .conftest import manifest, sums


def test_items_are_all_combinations_and_the_last_axis_is_fastest() -> None:
    block = scale.Sweep({"a": 3, "b": 4}, works.refuses).block(3, 9)
    assert block["a"].tolist() == [0, 1, 1, 1, 1, 2]
    assert block["b"].tolist() == [3, 0, 1, 2, 3, 0]
    assert len(block) == 6


@pytest.mark.parametrize(
    ("axes", "message"),
    [({}, "no axis"), ({"a": 0}, "length 0"), ({"a b": 3}, "is not a valid name"), ({"a": 2**40, "b": 2**40}, "too many")],
)
def test_refuses_invalid_axes(axes: dict[str, int], message: str) -> None:
    with pytest.raises(armill.InputError, match=message) as error:
        scale.Sweep(axes, works.refuses)
    assert error.value.problems[0]["hint"]


def test_axis_lengths_may_be_integers_of_numpy() -> None:
    sweep = scale.Sweep({"i": np.int64(3)}, works.refuses)  # type: ignore[dict-item]
    assert sweep.item_count == 3 and request_of(sweep) == request_of(scale.Sweep({"i": 3}, works.refuses))


def test_parts_cover_the_items_once() -> None:
    plan = scale.plan(works.waves(), items_per_part=37)
    spans = [plan.span(part) for part in range(plan.part_count)]
    assert [first for first, _ in spans] == [0, *(last for _, last in spans[:-1])]
    assert spans[-1][1] == 1000


@pytest.mark.parametrize("seconds", [1e-7, 2e-5, 3e-3, 0.7])
def test_a_planned_part_takes_longer_than_sending_it(monkeypatch: pytest.MonkeyPatch, seconds: float) -> None:
    now = 0.0

    def clocked(block: scale.Block) -> dict[str, object]:
        nonlocal now
        now += seconds * len(block)
        return {"value": block["row"] + block["column"]}

    # A clock by which every item takes as long as on any other machine.
    monkeypatch.setattr(planning, "time", SimpleNamespace(perf_counter=lambda: now))
    plan = scale.plan(scale.Sweep({"row": 4000, "column": 2500}, clocked))
    assert plan.seconds_per_item == pytest.approx(seconds)
    part = seconds * plan.items_per_part
    assert part >= 0.09 or plan.part_count == 1, "sending it takes some ten milliseconds"
    assert part <= max(4.0, 1e7 * seconds / 20_000) * 1.001, "so much is lost with a worker"
    assert "in total on one worker here" in str(plan)


def test_rows_are_in_the_order_of_the_items_for_any_parts(tmp_path: Path) -> None:
    few = scale.run(works.waves(), tmp_path / "few", items_per_part=333)
    many = scale.run(works.waves(), tmp_path / "many", items_per_part=40, workers=3)
    assert few.read().to_table().equals(many.read().to_table())
    frame = many.read().to_table()
    assert frame["row"].to_pylist() == np.repeat(np.arange(40), 25).tolist()
    at = np.linspace(-3, 7, 40)[frame["row"].to_numpy()] + 0.1 * frame["column"].to_numpy()
    assert np.array_equal(frame["height_um"].to_numpy(), np.sin(at))
    assert frame["root_um"].null_count == int((at < 0).sum()) > 0
    assert (many.rows, many.part_count, many.evaluation_count) == (1000, 25, 3000)


def test_an_item_may_have_several_rows(tmp_path: Path) -> None:
    done = scale.run(scale.Sweep({"i": 10}, works.squares), tmp_path, items_per_part=3)
    frame = done.read().to_table()
    assert frame["i"].to_pylist() == [i for i in range(10) for _ in range(2)]
    assert frame["value"].to_pylist() == [sign * i for i in range(10) for sign in (1.0, -1.0)]


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"x": np.array([1.0, np.nan, 3.0])}, "`x` is nan at item 1: mask what is missing"),
        ({"x": np.zeros(4)}, "4 rows are not a multiple of 3 items"),
        ({"x": np.zeros(3), "y": np.zeros(6)}, "expected columns of one length, given x 3, y 6"),
        ({"i": np.zeros(3)}, "columns have the names of axes: i"),
        ({"x": np.zeros((3, 2))}, r"`x` has the shape \(3, 2\)"),
        ({"x": np.array([None] * 3)}, "`x` has the type object"),
        ({}, "given none"),
    ],
)
def test_refuses_invalid_columns_with_their_items(tmp_path: Path, columns: dict[str, object], message: str) -> None:
    sweep = scale.Sweep({"i": 3}, lambda _: columns)
    with pytest.raises(scale.SweepFailed, match=rf"part 0 \(items 0 to 2\) failed: ValueError: .*{message}"):
        scale.run(sweep, tmp_path, items_per_part=3)


def test_the_request_depends_on_its_values() -> None:
    same = works.waves()
    assert request_of(same) == request_of(works.waves())
    for other in (
        works.waves(41),
        works.waves(seconds=0.1),
        scale.Sweep(same.axes, works.Waves(np.linspace(-3, 7.0000001, 40)), 3),
        scale.Sweep(same.axes, same.work, 3, seed=1),
        scale.Sweep(same.axes, works.squares, 3),
    ):
        assert request_of(other) != request_of(same)


def test_the_request_depends_on_source_and_closure_of_functions() -> None:
    def of(factor: float) -> scale.Sweep:
        return scale.Sweep({"i": 3}, lambda block: {"x": factor * block["i"]})

    assert request_of(of(2)) == request_of(of(2))
    assert request_of(of(2)) != request_of(of(3))


def test_the_manifest_has_the_request_and_the_parts(tmp_path: Path) -> None:
    done = scale.run(works.waves(), tmp_path, items_per_part=300)
    written = manifest(tmp_path)
    assert (written["format"], written["complete"], written["item_count"], written["items_per_part"]) == (1, True, 1000, 300)
    assert written["request"]["armill"] == armill.__version__
    assert written["request"]["axis row"] == "40"
    assert written["request"]["work.scale"].startswith("<f8 40, sha256:")
    assert [part["sha256"] for part in written["parts"]] == sums(tmp_path)
    assert [part["rows"] for part in written["parts"]] == [300, 300, 300, 100]
    assert written["columns"] == [
        ["row", "int32"],
        ["column", "int32"],
        ["height_um", "double"],
        ["root_um", "double"],
        ["name", "string"],
    ]
    left = sorted(path.name for path in done.folder.iterdir())
    assert left == [".lock", "manifest.json", "parts"]
