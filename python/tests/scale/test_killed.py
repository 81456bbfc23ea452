"""A sweep, or a worker of one, killed by SIGKILL at any time: no file is incomplete, none unfinished remains, and the bytes are the same.

``ARMILL_KILLS=100`` tests more times than a normal test run.
"""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from armill import scale

from . import works
from .conftest import Killer, busy_of_ray, manifest, script, sums

#: Parts of the sweep with 2 items per part.
PARTS = 500


def moments(at_least: int) -> Iterator[float]:
    """Times between 0 and 1, scattered by the golden ratio."""
    for k in range(int(os.environ.get("ARMILL_KILLS", at_least))):
        yield (k * 0.61803398875) % 1


def started(folder: Path) -> subprocess.Popen[bytes]:
    """The sweep, as soon as it has made its folder."""
    process = subprocess.Popen(script(folder, items_per_part=2), stderr=subprocess.DEVNULL)
    while not folder.exists() and process.poll() is None:
        time.sleep(0.001)
    return process


def finished(folder: Path) -> dict[str, str]:
    """SHA-256 of the parts that have their own names; those that a killed run left unfinished are hidden files."""
    parts = folder.glob("parts/part-*.parquet")
    return {part.name: hashlib.sha256(part.read_bytes()).hexdigest() for part in parts}


def test_after_a_kill_at_any_time_the_next_run_gives_the_same_bytes(tmp_path: Path) -> None:
    process = started(tmp_path / "undisturbed")
    begun = time.monotonic()
    assert process.wait() == 0
    whole_time = time.monotonic() - begun
    undisturbed = finished(tmp_path / "undisturbed")
    assert len(undisturbed) == PARTS

    caught = []
    for k, moment in enumerate(moments(4)):
        folder = tmp_path / f"killed {k}"
        process = started(folder)
        time.sleep(whole_time * moment)
        process.kill()
        assert process.wait() in (-signal.SIGKILL, 0), "the run failed before it was killed"

        left = finished(folder)
        assert left.items() <= undisturbed.items(), f"after {moment:.3f}: a part that does not belong to the sweep"
        # The manifest is complete if it exists, and lists only existing parts.
        listed = manifest(folder)["parts"] if (folder / "manifest.json").exists() else []
        assert {f"part-{part['part']:06d}.parquet" for part in listed} <= left.keys(), f"after {moment:.3f}"

        again = scale.run(works.waves(), folder, items_per_part=2)
        assert again.part_count == PARTS
        assert sums(folder) == list(undisturbed[name] for name in sorted(undisturbed)), f"after {moment:.3f}"
        assert not list(folder.rglob(f"*{scale.files.UNFINISHED}")), f"after {moment:.3f}"
        caught.append(len(left))
    print(f"parts left by each kill: {caught} of {PARTS}")
    assert min(caught) < PARTS, "every run was over before it was killed"


def finishes_though_a_worker_is_killed(tmp_path: Path, backend: Any, victims: Callable[[], Callable[[], int]]) -> None:
    """Runs a sweep for each moment, and kills one worker when that share of the parts is there; `victims` is called before each run."""
    sweep = works.waves(seconds=0.01)
    scale.run(sweep, tmp_path / "undisturbed", workers=1, items_per_part=2)
    undisturbed = sums(tmp_path / "undisturbed")
    caught = []
    for k, moment in enumerate(moments(2)):
        folder = tmp_path / f"killed {k}"
        killer = Killer(folder, 1 + int(moment * 0.9 * PARTS), victims())
        done = scale.run(sweep, folder, backend, items_per_part=2)
        caught.append(killer.join())
        assert (done.done_before, done.part_count) == (0, PARTS)
        assert sums(folder) == undisturbed, f"after {moment:.3f}"
        assert not list(folder.rglob(f"*{scale.files.UNFINISHED}")), f"after {moment:.3f}"
    print(f"parts there at each kill: {caught} of {PARTS}")
    assert min(caught) > 0, "no process was killed in a run"
    assert min(caught) < PARTS, "every run was over before a worker was killed"


def test_workers_of_dask_killed_at_any_time_leave_no_unfinished_file(tmp_path: Path, client: Any) -> None:
    def victims() -> Callable[[], int]:
        # The one killed before is started again.
        client.wait_for_workers(4, timeout=300)
        pids: list[int] = list(client.run(os.getpid).values())
        return lambda: pids[0]

    finishes_though_a_worker_is_killed(tmp_path, client, victims)


def test_processes_of_ray_killed_at_any_time_leave_no_unfinished_file(tmp_path: Path, four_of_ray: Any) -> None:
    finishes_though_a_worker_is_killed(tmp_path, "ray", lambda: busy_of_ray)
    assert four_of_ray.is_initialized(), "what was started elsewhere is kept"
