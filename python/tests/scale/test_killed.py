"""A sweep killed by SIGKILL at any moment: nothing of it is half-written, and the run after it ends it with the same bytes.

``ARMILL_KILLS=100`` asks for more moments than every run of the tests has time for.
"""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from armill import scale

from . import works
from .conftest import manifest, sums

SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from scale import works
from armill import scale
scale.run(works.waves(), {folder!r}, "local", workers=2, items_per_part=10)
"""


def started(folder: Path) -> subprocess.Popen[bytes]:
    script = SCRIPT.format(tests=str(Path(__file__).parents[1]), folder=str(folder))
    return subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.DEVNULL)


def finished(folder: Path) -> dict[str, str]:
    """SHA-256 of the parts that have their own names; those that a killed run left unfinished are hidden files."""
    parts = folder.glob("parts/part-*.parquet")
    return {part.name: hashlib.sha256(part.read_bytes()).hexdigest() for part in parts}


def test_killed_at_any_moment_the_next_run_ends_it_with_the_same_bytes(tmp_path: Path) -> None:
    begun = time.monotonic()
    assert started(tmp_path / "undisturbed").wait() == 0
    whole_time = time.monotonic() - begun
    undisturbed = finished(tmp_path / "undisturbed")
    assert len(undisturbed) == 100

    caught = []
    for k in range(int(os.environ.get("ARMILL_KILLS", "5"))):
        # Scattered by the golden ratio over the whole run, its start of Python included.
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

        again = scale.run(works.waves(), folder, items_per_part=10)
        assert again.part_count == 100
        assert sums(folder) == list(undisturbed[name] for name in sorted(undisturbed)), f"after {moment:.3f}"
        assert not list(folder.rglob(f"*{scale.files.UNFINISHED}")), f"after {moment:.3f}"
        caught.append(len(left))
    print(f"parts left by each kill: {caught} of 100")
    assert min(caught) < 100, "every run was over before it was killed"
