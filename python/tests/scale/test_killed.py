"""A sweep killed by SIGKILL at any moment: nothing of it is half-written, and the run after it ends it with the same bytes.

``ARMILL_KILLS=100`` asks for more moments than every run of the tests has time for.
"""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import time
from pathlib import Path

from armill import scale

from . import works
from .conftest import manifest, script, sums

#: As many as a sweep of 2 items a part makes.
PARTS = 500


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


def test_killed_at_any_moment_the_next_run_ends_it_with_the_same_bytes(tmp_path: Path) -> None:
    process = started(tmp_path / "undisturbed")
    begun = time.monotonic()
    assert process.wait() == 0
    whole_time = time.monotonic() - begun
    undisturbed = finished(tmp_path / "undisturbed")
    assert len(undisturbed) == PARTS

    caught = []
    for k in range(int(os.environ.get("ARMILL_KILLS", "4"))):
        # Scattered by the golden ratio over the whole run.
        moment = (k * 0.61803398875) % 1
        folder = tmp_path / f"killed {k}"
        process = started(folder)
        time.sleep(whole_time * moment)
        process.kill()
        assert process.wait() in (-signal.SIGKILL, 0), "a run that failed by itself"

        left = finished(folder)
        assert left.items() <= undisturbed.items(), f"after {moment:.3f}: a part that is no part of the sweep"
        # The manifest is whole wherever it is, and tells no part that is not there.
        told = manifest(folder)["parts"] if (folder / "manifest.json").exists() else []
        assert {f"part-{part['part']:06d}.parquet" for part in told} <= left.keys(), f"after {moment:.3f}"

        again = scale.run(works.waves(), folder, items_per_part=2)
        assert again.part_count == PARTS
        assert sums(folder) == list(undisturbed[name] for name in sorted(undisturbed)), f"after {moment:.3f}"
        assert not list(folder.rglob(f"*{scale.files.UNFINISHED}")), f"after {moment:.3f}"
        caught.append(len(left))
    print(f"parts left by each kill: {caught} of {PARTS}")
    assert min(caught) < PARTS, "every run was over before it was killed"
