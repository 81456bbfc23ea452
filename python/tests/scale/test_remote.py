"""Folders of fsspec: in memory, on a disk by an address, and in a bucket of a local server of S3."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import armill
from armill import scale

from . import works

fsspec = pytest.importorskip("fsspec")


@pytest.fixture
def memory() -> Iterator[str]:
    yield "memory://sweeps/waves"
    fsspec.filesystem("memory").rm("/sweeps", recursive=True)


def table(folder: object, **options: object) -> dict[str, list[object]]:
    return scale.read(folder, **options).to_table().to_pydict()


def test_a_folder_in_memory_has_the_bytes_of_one_on_a_disk(memory: str, tmp_path: Path) -> None:
    on_disk = scale.run(works.waves(), tmp_path / "waves", items_per_part=50)
    found = scale.run(works.waves(), memory, items_per_part=50)
    assert (found.rows, found.part_count, found.done_before) == (on_disk.rows, 20, 0)
    system = fsspec.filesystem("memory")
    for path in sorted((tmp_path / "waves").rglob("*.*")):
        if not path.name.startswith("."):
            assert system.cat_file(f"/sweeps/waves/{path.relative_to(tmp_path / 'waves')}") == path.read_bytes(), path
    # The pickle of the run is removed.
    assert not [name for name in system.find("/sweeps") if ".sweep-" in name or ".unfinished" in name]
    assert table(memory) == table(tmp_path / "waves") == found.read().to_table().to_pydict()
    again = scale.run(works.waves(), memory)
    assert (again.done_before, again.task_seconds) == (20, 0.0)


def test_damaged_parts_in_memory_are_repeated_and_other_sweeps_refused(memory: str) -> None:
    scale.run(works.waves(), memory, items_per_part=50)
    system = fsspec.filesystem("memory")
    before = system.cat_file("/sweeps/waves/parts/part-000003.parquet")
    system.pipe_file("/sweeps/waves/parts/part-000003.parquet", before[:-1] + b"x")
    system.rm_file("/sweeps/waves/parts/part-000007.parquet")
    with pytest.raises(armill.InputError, match="2 parts are not as they were written: 3, 7"):
        scale.read(memory, verify=True)
    found = scale.run(works.waves(), memory)
    assert found.redone == (3, 7) and system.cat_file("/sweeps/waves/parts/part-000003.parquet") == before
    with pytest.raises(armill.InputError, match="memory://sweeps/waves contains another sweep: axis row"):
        scale.run(works.waves(41), memory)
    system.pipe_file("/sweeps/waves/manifest.json", b"{")
    with pytest.raises(armill.InputError, match="is not the manifest of a sweep"):
        scale.read(memory)


def test_an_address_of_a_disk_is_its_path(tmp_path: Path) -> None:
    scale.run(works.waves(), f"file://{tmp_path}/waves", items_per_part=500)
    assert (tmp_path / "waves/manifest.json").is_file()
    assert table(tmp_path / "waves") == table(f"file://{tmp_path}/waves")


def test_addresses_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(armill.InputError, match="`nothing` is not a file system of fsspec"):
        scale.run(works.waves(), "nothing://bucket/waves")
    with pytest.raises(armill.InputError, match="memory://sweeps/none contains no sweep"):
        scale.read("memory://sweeps/none")
    with pytest.raises(armill.InputError, match="storage_options are given for"):
        scale.run(works.waves(), tmp_path / "waves", storage_options={"key": "value"})
    assert not (tmp_path / "waves").exists()


def test_a_sweep_becomes_a_data_set_over_its_axes(tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    scale.run(works.waves(), tmp_path / "waves", items_per_part=50)
    data = scale.read_xarray(tmp_path / "waves")
    assert dict(data.sizes) == {"row": 40, "column": 25} and data.height_um.attrs["units"] == "um"
    at = np.linspace(-3, 7, 40)[:, None] + 0.1 * np.arange(25)
    assert np.array_equal(data.height_um, np.sin(at))
    assert np.array_equal(np.isnan(data.root_um), at < 0) and data.name.values[7, 3] == "r7"


@pytest.fixture(scope="session")
def bucket(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, object]]:
    """Options of a bucket `sweeps` of a server on this machine."""
    pytest.importorskip("s3fs")
    pytest.importorskip("moto.server")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address = f"http://127.0.0.1:{port}"
    os.environ.setdefault("AWS_DEFAULT_REGION", "us-east-1")
    log = (tmp_path_factory.mktemp("s3") / "log").open("w")
    server = subprocess.Popen([sys.executable, "-m", "moto.server", "-p", str(port)], stdout=log, stderr=log)
    try:
        for _ in range(600):
            try:
                urllib.request.urlopen(f"{address}/moto-api/", timeout=1).close()
                break
            except OSError:
                assert server.poll() is None, "the server of S3 ended"
                time.sleep(0.1)
        options: dict[str, object] = {"key": "test", "secret": "test", "client_kwargs": {"endpoint_url": address}}
        fsspec.filesystem("s3", **options).mkdir("sweeps")
        yield options
    finally:
        server.terminate()
        server.wait()
        log.close()


@pytest.mark.filterwarnings("ignore")
def test_a_folder_in_a_bucket(bucket: dict[str, object], tmp_path: Path) -> None:
    scale.run(works.waves(), tmp_path / "waves", items_per_part=100)
    found = scale.run(works.waves(), "s3://sweeps/waves", items_per_part=100, storage_options=bucket)
    assert (found.rows, found.part_count) == (1000, 10) and str(found.folder) == "s3://sweeps/waves"
    assert table("s3://sweeps/waves", storage_options=bucket, verify=True) == table(tmp_path / "waves")
    system = fsspec.filesystem("s3", **bucket)
    assert system.cat_file("sweeps/waves/manifest.json") == (tmp_path / "waves/manifest.json").read_bytes()
    system.rm_file("sweeps/waves/parts/part-000004.parquet")
    again = scale.run(works.waves(), "s3://sweeps/waves", storage_options=bucket)
    assert (again.done_before, again.redone) == (9, (4,))
