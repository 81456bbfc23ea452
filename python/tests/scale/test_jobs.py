"""Arrays of jobs: each computes some of the parts, and a last call takes them over."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import armill
from armill import scale

from . import works
from .conftest import sums


def job(folder: Path, number: int, jobs: int = 3) -> scale.Finished:
    return scale.run(works.waves(), folder, items_per_part=50, shard=(number, jobs), progress=False)


def test_jobs_together_give_the_same_files(tmp_path: Path) -> None:
    scale.run(works.waves(), tmp_path / "whole", items_per_part=50)
    with ThreadPoolExecutor(3) as pool:
        found = list(pool.map(lambda number: job(tmp_path / "jobs", number), range(3)))
    assert [each.part_count for each in found] == [7, 7, 6] and sum(each.rows for each in found) == 1000
    assert [each.evaluation_count for each in found] == [1050, 1050, 900]
    with pytest.raises(armill.InputError, match="contains no sweep"):
        scale.read(tmp_path / "jobs")
    last = scale.run(works.waves(), tmp_path / "jobs")
    assert (last.part_count, last.done_before, last.task_seconds) == (20, 20, 0.0)
    assert sums(tmp_path / "jobs") == sums(tmp_path / "whole")
    assert (tmp_path / "jobs/manifest.json").read_bytes() == (tmp_path / "whole/manifest.json").read_bytes()
    assert scale.read(tmp_path / "jobs").to_table().equals(scale.read(tmp_path / "whole").to_table())


def test_a_missing_job_is_computed_by_the_last_call(tmp_path: Path) -> None:
    job(tmp_path, 0)
    job(tmp_path, 2)
    last = scale.run(works.waves(), tmp_path)
    assert (last.done_before, last.rows) == (13, 1000) and last.task_seconds > 0


def test_a_job_is_not_repeated(tmp_path: Path) -> None:
    job(tmp_path, 1)
    again = job(tmp_path, 1)
    assert (again.done_before, again.task_seconds) == (7, 0.0)
    assert json.loads((tmp_path / "jobs/1-of-3/manifest.json").read_text())["shard"] == [1, 3]


def test_jobs_that_do_not_exist_or_differ_are_refused(tmp_path: Path) -> None:
    with pytest.raises(armill.InputError, match="shard: job 3 of 3 does not exist"):
        job(tmp_path, 3)
    with pytest.raises(armill.InputError, match="items_per_part is not given"):
        scale.run(works.waves(), tmp_path, shard=(0, 2))
    job(tmp_path, 0)
    with pytest.raises(armill.InputError, match="contains another sweep: axis row"):
        scale.run(works.waves(41), tmp_path)
    with pytest.raises(armill.InputError, match="has parts of 50 items, not 60"):
        scale.run(works.waves(), tmp_path, items_per_part=60)
    scale.run(works.waves(), tmp_path, items_per_part=60, shard=(1, 3))
    with pytest.raises(armill.InputError, match="contains jobs of another sweep"):
        scale.run(works.waves(), tmp_path)


def test_jobs_in_memory(tmp_path: Path) -> None:
    fsspec = pytest.importorskip("fsspec")
    try:
        for number in range(2):
            scale.run(works.waves(), "memory://jobs/waves", items_per_part=100, shard=(number, 2))
        assert scale.run(works.waves(), "memory://jobs/waves").done_before == 10
    finally:
        fsspec.filesystem("memory").rm("/jobs", recursive=True)
