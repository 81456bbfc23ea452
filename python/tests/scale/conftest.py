"""What the tests of sweeps share: clusters that are started once, and what lies in a folder."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow", reason='sweeps need pyarrow: pip install "armill[scale]"')


def sums(folder: Path) -> list[str]:
    """SHA-256 of all parts."""
    parts = sorted((folder / "parts").iterdir())
    return [hashlib.sha256(part.read_bytes()).hexdigest() for part in parts]


def manifest(folder: Path) -> dict[str, Any]:
    told: dict[str, Any] = json.loads((folder / "manifest.json").read_text())
    return told


@pytest.fixture(scope="session")
def cluster() -> Iterator[Any]:
    """Four workers of Dask, whose nannies start another where one dies."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
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
