"""A sweep killed by SIGKILL at any time: no file is incomplete, and the next run finishes it with the same bytes.

``ARMILL_KILLS=100`` tests more times than a normal test run.
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

#: Parts of the sweep with 2 items per part.
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


def test_after_a_kill_at_any_time_the_next_run_gives_the_same_bytes(tmp_path: Path) -> None:
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
