"""Shared by the tests of sweeps: clusters that are started once, and the contents of folders."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow", reason='sweeps need pyarrow: pip install "armill[scale]"')

# Processes that are started here can import the works of these tests.
os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])])


SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from scale import works
from armill import scale
scale.run(works.waves(seconds={seconds}), {folder!r}, "local", workers=2, items_per_part={items_per_part}, progress={progress})
"""


def script(folder: Path, items_per_part: int, seconds: float = 0.0, progress: bool = False) -> list[str]:
    """The command of a sweep in a separate process, which may be killed."""
    tests = str(Path(__file__).parents[1])
    code = SCRIPT.format(tests=tests, folder=str(folder), items_per_part=items_per_part, seconds=seconds, progress=progress)
    return [sys.executable, "-c", code]


def sums(folder: Path) -> list[str]:
    """SHA-256 of all parts."""
    parts = sorted((folder / "parts").iterdir())
    return [hashlib.sha256(part.read_bytes()).hexdigest() for part in parts]


def manifest(folder: Path) -> dict[str, Any]:
    written: dict[str, Any] = json.loads((folder / "manifest.json").read_text())
    return written


class Killer:
    """Kills a process by signal when a folder contains `parts` parts, and counts the parts then."""

    def __init__(self, folder: Path, parts: int, victim: Callable[[], int]) -> None:
        self._parts, self._folder, self._victim = parts, folder, victim
        self.there = -1
        self._thread = threading.Thread(target=self._wait)
        self._thread.start()

    def _wait(self) -> None:
        until = time.monotonic() + 300
        while time.monotonic() < until and self._count() < self._parts:
            time.sleep(0.005)
        os.kill(self._victim(), signal.SIGKILL)
        self.there = self._count()

    def _count(self) -> int:
        return len(list(self._folder.glob("parts/part-*")))

    def join(self) -> int:
        """Number of parts when it was killed."""
        self._thread.join()
        return self.there


def at_work(pid: int) -> bytes:
    """The command line of a process; empty if it has ended."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


def busy_of_ray() -> int:
    """A process of the Ray started here that works on a part."""
    psutil = pytest.importorskip("psutil")
    until = time.monotonic() + 300
    while time.monotonic() < until:
        for process in psutil.Process().children(recursive=True):
            # Ray writes the current task there.
            if at_work(process.pid).startswith(b"ray::_part"):
                pid: int = process.pid
                return pid
    raise AssertionError("no process of ray is at work on a part")


@pytest.fixture(scope="session")
def cluster() -> Iterator[Any]:
    """Four workers of Dask, which are restarted when killed."""
    distributed = pytest.importorskip("distributed")
    dask = pytest.importorskip("dask")
    # The cluster gives up a worker that is away this long after a kill, also where it has been back and was killed again.
    with dask.config.set({"distributed.deploy.lost-worker-timeout": "1 hour"}), distributed.LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        yield cluster


@pytest.fixture(scope="session")
def client(cluster: Any) -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.Client(cluster, set_as_default=False) as client:
        yield client


@pytest.fixture(scope="session")
def four_of_ray() -> Iterator[Any]:
    """Ray with four processors."""
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=4, include_dashboard=False, logging_level="error", log_to_driver=False)
    yield ray
    ray.shutdown()
