"""The same bytes on all backends, also if a worker is killed."""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from armill import _armill, scale
from armill.scale.backends import Lost, Outcome
from armill.scale.manifest import Done
from armill.scale.task import Failed
from armill.scale.window import AHEAD, MOST_LOST, worked

from . import works
from .conftest import Killer, busy_of_ray, manifest, sums

# Warnings of other packages are ignored.
pytestmark = pytest.mark.filterwarnings("default")


class Reversed:
    """A backend that returns the newest part first, and counts the parts sent."""

    def __init__(self, loses: dict[int, int] | None = None) -> None:
        self.sent: list[int] = []
        self.most = 0
        self.loses = dict(loses or {})

    def width(self) -> int:
        return 4

    def send(self, part: int) -> None:
        self.sent.append(part)
        self.most = max(self.most, len(self.sent))

    def arrived(self) -> Iterable[Outcome]:
        part = self.sent.pop()
        if self.loses.get(part, 0) > 0:
            self.loses[part] -= 1
            yield Lost(part, "a signal")
        elif part == 666:
            yield Failed(part, "part 666 is bad")
        else:
            yield Done(part, 1, 1, "")

    def close(self) -> None: ...


def test_a_hundred_thousand_parts_are_never_all_under_way() -> None:
    backend, requested = Reversed(), 0

    def parts() -> Iterable[int]:
        nonlocal requested
        for part in range(1000, 101_000):
            requested += 1
            yield part

    taken = worked(backend, parts())
    first = next(taken)
    assert first.part == 1000 + 4 * AHEAD - 1
    assert requested == 4 * AHEAD, "parts are requested for when there is room"
    assert {done.part for done in taken} | {first.part} == set(range(1000, 101_000))
    assert backend.most == 4 * AHEAD


def test_a_lost_part_is_sent_again_a_limited_number_of_times() -> None:
    done = worked(Reversed({3: MOST_LOST - 1, 5: 1}), range(10))
    assert sorted(part.part for part in done) == list(range(10))
    with pytest.raises(scale.SweepFailed, match=f"part 3 did not come back from {MOST_LOST} workers, the last time by a signal"):
        list(worked(Reversed({3: MOST_LOST}), range(10)))


def test_a_part_that_fails_is_not_tried_again() -> None:
    with pytest.raises(scale.SweepFailed, match="part 666 is bad"):
        list(worked(Reversed(), range(660, 700)))


@pytest.fixture(scope="session")
def alone(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The sums of a sweep made by one thread."""
    folder = tmp_path_factory.mktemp("alone")
    scale.run(works.waves(seconds=0.02), folder, workers=1, items_per_part=10)
    return sums(folder)


@pytest.mark.parametrize("workers", [1, 3, 8])
def test_threads_give_the_same_bytes(tmp_path: Path, alone: list[str], workers: int) -> None:
    scale.run(works.waves(seconds=0.02), tmp_path, workers=workers, items_per_part=10)
    assert sums(tmp_path) == alone


def test_dask_gives_the_same_bytes_though_a_worker_is_killed(tmp_path: Path, alone: list[str], client: Any) -> None:
    pids = client.run(os.getpid)
    killer = Killer(tmp_path, 20, lambda: next(iter(pids.values())))
    done = scale.run(works.waves(seconds=0.02), tmp_path, client, items_per_part=10)
    killer.join()
    assert done.done_before == 0
    assert sums(tmp_path) == alone
    assert not set(client.run(os.getpid).values()) >= set(pids.values()), "a worker was killed"


def test_ray_gives_the_same_bytes_though_a_worker_is_killed(tmp_path: Path, alone: list[str], four_of_ray: Any) -> None:
    killer = Killer(tmp_path, 20, busy_of_ray)
    scale.run(works.waves(seconds=0.02), tmp_path, "ray", items_per_part=10)
    killer.join()
    assert sums(tmp_path) == alone
    assert four_of_ray.is_initialized(), "what was started elsewhere is kept"


def test_a_part_that_kills_a_worker_is_done_by_another(tmp_path: Path, client: Any) -> None:
    sweep = scale.Sweep({"i": 40}, works.Deadly(17, 2, tmp_path / "diary"))
    done = scale.run(sweep, tmp_path / "sweep", client, items_per_part=10)
    assert done.read().to_table()["value"].to_pylist() == [i * i for i in range(40)]
    assert (tmp_path / "diary").read_text() == "xx"


def left_unfinished(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob(f".*{scale.files.UNFINISHED}")]


def test_nothing_is_left_of_a_worker_of_dask_that_is_killed_while_it_writes(tmp_path: Path, client: Any) -> None:
    done = scale.run(scale.Sweep({"i": 40}, works.DeadlyWriter(17, tmp_path / "diary")), tmp_path / "sweep", client, items_per_part=10)
    assert done.read().to_table()["value"].to_pylist() == [i * i for i in range(40)]
    assert (tmp_path / "diary").exists(), "a worker was killed"
    assert left_unfinished(tmp_path) == []


def test_nothing_is_left_of_a_worker_of_ray_that_is_killed_while_it_writes(tmp_path: Path, four_of_ray: Any) -> None:
    sweep = scale.Sweep({"i": 40}, works.DeadlyWriter(17, tmp_path / "diary"))
    done = scale.run(sweep, tmp_path / "sweep", "ray", items_per_part=10)
    assert done.read().to_table()["value"].to_pylist() == [i * i for i in range(40)]
    assert (tmp_path / "diary").exists() and four_of_ray.is_initialized(), "a worker was killed"
    assert left_unfinished(tmp_path) == []


def test_reports_a_part_that_kills_every_worker_of_ray(tmp_path: Path, four_of_ray: Any) -> None:
    sweep = scale.Sweep({"i": 40}, works.Deadly(17, 99, tmp_path / "diary"))
    with pytest.raises(scale.SweepFailed, match=r"part 1 did not come back from 3 workers, the last time by .*\n  \d of 4 parts are kept"):
        scale.run(sweep, tmp_path / "sweep", "ray", items_per_part=10)


def test_a_failing_part_on_a_worker_reports_its_items(tmp_path: Path, client: Any) -> None:
    with pytest.raises(scale.SweepFailed, match=r"part 7 \(items 70 to 79\) failed: ValueError: joint 3 at 151\.2 deg"):
        scale.run(scale.Sweep({"i": 100}, works.refuses), tmp_path, client, items_per_part=10)


def test_reports_a_scheduler_that_does_not_answer_in_time(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(scale.SweepFailed, match=r"scheduler at tcp://127\.0\.0\.1:9 did not answer within 1 s"):
        scale.run(works.waves(), tmp_path, "tcp://127.0.0.1:9", timeout=1, items_per_part=50)


def test_reports_missing_workers_in_time(tmp_path: Path, client: Any) -> None:
    with pytest.raises(scale.SweepFailed, match=r"the scheduler has 4 of 9 workers after 1 s"):
        scale.run(works.waves(), tmp_path, client, workers=9, timeout=1, items_per_part=50)


def test_accepts_the_address_of_a_scheduler(tmp_path: Path, alone: list[str], cluster: Any) -> None:
    scale.run(works.waves(seconds=0.02), tmp_path, cluster.scheduler_address, items_per_part=10)
    assert sums(tmp_path) == alone


def test_reports_a_folder_without_access_for_workers(tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from armill.scale import task

    real = task.task

    def elsewhere(*given: Any) -> Any:
        made = real(*given)
        return dataclasses.replace(made, folder=Path("/nowhere"), home=Path("/nowhere"))

    monkeypatch.setattr("armill.scale.running.task", elsewhere)
    with pytest.raises(scale.SweepFailed, match="has no access to /nowhere: use a folder that all machines share"):
        scale.run(works.waves(), tmp_path, client, items_per_part=50)


def test_reports_a_worker_of_another_version(tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    import armill

    own = armill.__version__
    monkeypatch.setattr(armill, "__version__", "9.9.9")
    with pytest.raises(scale.SweepFailed, match=rf"this worker has armill {own}, the sweep was started with 9\.9\.9"):
        scale.run(works.waves(), tmp_path, client, items_per_part=50)


def test_reports_a_worker_with_other_rounding(tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_armill, "arithmetic", lambda: "otherwise")
    with pytest.raises(scale.SweepFailed, match=r"this worker rounds \w+, the sweep was started on one that rounds otherwise"):
        scale.run(works.waves(), tmp_path, client, items_per_part=50)


@pytest.mark.parametrize(
    ("backend", "address", "joined"),
    [("ray", None, {"num_cpus": 2, "include_dashboard": False}), ("ray", "head:6379", {"address": "auto"}), ("ray://head:10001", None, {"address": "ray://head:10001"})],
    ids=["processes of this machine", "the cluster of the environment", "an address"],
)
def test_ray_joins_the_cluster_that_is_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, backend: str, address: str | None, joined: dict[str, Any]
) -> None:
    calls: list[dict[str, Any]] = []

    def init(**options: Any) -> None:
        calls.append({name: value for name, value in options.items() if not name.startswith("log")})
        raise ConnectionError("nothing there")

    monkeypatch.delenv("RAY_ADDRESS", raising=False)
    if address:
        monkeypatch.setenv("RAY_ADDRESS", address)
    monkeypatch.setitem(sys.modules, "ray", SimpleNamespace(init=init, is_initialized=lambda: False))
    with pytest.raises(scale.SweepFailed, match="cannot be reached: nothing there"):
        scale.run(works.waves(), tmp_path, backend, workers=2, items_per_part=50)
    assert calls == [joined]


@pytest.mark.parametrize(("backend", "package", "extra"), [("dask", "distributed", "scale"), ("ray", "ray", "ray")])
def test_reports_how_to_install_a_missing_backend(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, backend: str, package: str, extra: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(scale.MissingExtra, match=rf'{package} is not installed .*: pip install "armill\[{extra}\]"'):
        scale.run(works.waves(), tmp_path, backend, items_per_part=50)


def test_reports_a_killed_scheduler_and_repeating_the_call_continues(tmp_path: Path, alone: list[str]) -> None:
    pytest.importorskip("distributed")
    script = (
        "import os, time, distributed\n"
        "if __name__ == '__main__':\n"
        "    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=False, protocol='tcp')\n"
        "    print(cluster.scheduler_address, flush=True)\n"
        "    time.sleep(60)\n"
    )
    other = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    assert other.stdout is not None
    address = other.stdout.readline().strip()
    # Its workers are its threads, and can import the works of these tests.
    killer = Killer(tmp_path, 5, lambda: other.pid)
    with pytest.raises(scale.SweepFailed, match=r"connection to the scheduler was lost .*\n  \d+ of 100 parts are kept"):
        scale.run(works.waves(seconds=0.02), tmp_path, address, items_per_part=10, timeout=3)
    killer.join()
    other.wait()
    other.stdout.close()
    kept = len(manifest(tmp_path)["parts"])
    assert scale.run(works.waves(seconds=0.02), tmp_path, workers=8).done_before == kept
    assert sums(tmp_path) == alone
