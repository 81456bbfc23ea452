"""Folders: of another sweep, damaged, unfinished, not writable, full."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import time
from collections.abc import Container
from functools import partial
from pathlib import Path
from typing import IO

import pytest

import armill
from armill import scale
from armill.scale import files

from . import works
from .conftest import manifest, script, sums


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    """The 20 parts of a finished sweep."""
    scale.run(works.waves(), tmp_path / "whole", items_per_part=50)
    return tmp_path / "whole"


def test_a_finished_sweep_is_not_repeated(whole: Path) -> None:
    times = [part.stat().st_mtime_ns for part in sorted((whole / "parts").iterdir())]
    again = scale.run(works.waves(), whole)
    assert (again.done_before, again.redone, again.task_seconds) == (20, (), 0.0)
    assert [part.stat().st_mtime_ns for part in sorted((whole / "parts").iterdir())] == times


def test_refuses_another_sweep_and_reports_the_differences(whole: Path) -> None:
    with pytest.raises(armill.InputError, match=r"contains another sweep: axis row: 40 there, 41 here; work\.scale: <f8 40"):
        scale.run(works.waves(41), whole)


def test_another_version_is_another_sweep(whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(armill, "__version__", "9.9.9")
    with pytest.raises(armill.InputError, match=r"armill: .* there, 9\.9\.9 here"):
        scale.run(works.waves(), whole)


def test_other_parts_are_refused(whole: Path) -> None:
    with pytest.raises(armill.InputError, match="has parts of 50 items, not 60"):
        scale.run(works.waves(), whole, items_per_part=60)


def test_damaged_truncated_and_missing_parts_are_repeated(whole: Path) -> None:
    before = sums(whole)
    parts = sorted((whole / "parts").iterdir())
    data = bytearray(parts[3].read_bytes())
    data[len(data) // 2] ^= 1
    parts[3].write_bytes(data)
    parts[7].write_bytes(parts[7].read_bytes()[:100])
    parts[11].unlink()
    with pytest.raises(armill.InputError, match="2 parts are not as they were written: 7, 11"):
        scale.read(whole)
    with pytest.raises(armill.InputError, match="3 parts are not as they were written: 3, 7, 11"):
        scale.read(whole, verify=True)
    again = scale.run(works.waves(), whole)
    assert (again.done_before, again.redone) == (17, (3, 7, 11))
    assert sums(whole) == before


def test_an_unfinished_sweep_is_read_only_on_request(whole: Path) -> None:
    written = manifest(whole)
    written["parts"] = written["parts"][2:5]
    (whole / "manifest.json").write_text(json.dumps(written))
    with pytest.raises(armill.InputError, match="contains 3 of 20 parts"):
        scale.read(whole)
    frame = scale.read(whole, partial=True).to_table()
    assert frame.num_rows == 150
    assert frame["row"][0].as_py() == 4


@pytest.mark.parametrize(
    "text",
    ["", "{}", "[]", '{"format": 2}', "{", '{"format": 1, "request": {}}', "\x00"],
)
def test_refuses_an_invalid_manifest(whole: Path, text: str) -> None:
    (whole / "manifest.json").write_text(text)
    for call in (lambda: scale.run(works.waves(), whole), lambda: scale.read(whole)):
        with pytest.raises(armill.InputError, match="is not the manifest of a sweep"):
            call()


def test_a_changed_manifest_is_noticed(whole: Path) -> None:
    written = manifest(whole)
    written["request"]["axis row"] = "41"
    (whole / "manifest.json").write_text(json.dumps(written))
    with pytest.raises(armill.InputError, match="do not match"):
        scale.read(whole)


def test_a_folder_without_sweep_is_refused(tmp_path: Path) -> None:
    with pytest.raises(armill.InputError, match="contains no sweep"):
        scale.read(tmp_path)


def test_refuses_a_folder_that_is_not_writable(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(armill.InputError, match="cannot write into"):
        scale.run(works.waves(), tmp_path / "file")


def test_two_runs_do_not_share_a_folder(tmp_path: Path) -> None:
    with files.alone_in(tmp_path), pytest.raises(armill.InputError, match="another run uses"):
        scale.run(works.waves(), tmp_path)


@pytest.mark.skipif(os.name != "posix", reason="elsewhere the system keeps files that are open")
def test_unfinished_files_of_others_are_kept_while_they_are_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dead, other, part = tmp_path / ".part-000001.parquet.a-1.unfinished", tmp_path / "unfinished", tmp_path / "part-000002.parquet"
    dead.touch()
    other.touch()
    real, seen = os.fsync, []

    def fsync(number: int) -> None:
        # Another run begins while this one writes, then this run ends.
        files.remove_unfinished(tmp_path)
        seen.append(sorted(path.name for path in tmp_path.iterdir()))
        files.remove_unfinished(tmp_path, "another")
        seen.append(sorted(path.name for path in tmp_path.iterdir()))
        real(number)

    monkeypatch.setattr(os, "fsync", fsync)
    files.write_whole(part, b"whole", "mine")
    assert part.read_bytes() == b"whole"
    assert not dead.exists() and other.exists()
    assert [len(names) for names in seen] == [2, 2] and seen[0][0].startswith(".part-000002.parquet.mine-")


@pytest.mark.skipif(os.name != "posix", reason="elsewhere the system keeps files that are open")
@pytest.mark.parametrize("locks", [True, False], ids=["removed before the lock", "being removed"])
def test_a_file_that_another_run_removes_before_it_is_locked_is_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, locks: bool
) -> None:
    part, real, calls = tmp_path / "part-000001.parquet", files._locked, []

    def locked(file: IO[bytes]) -> bool | None:
        calls.append(file.name)
        if len(calls) > 1:
            return real(file)
        # Another run begins between the creation of the file and its lock.
        os.unlink(file.name)
        return real(file) if locks else False

    monkeypatch.setattr(files, "_locked", locked)
    files.write_whole(part, b"whole", "mine")
    assert (part.read_bytes(), len(set(calls))) == (b"whole", 2)
    assert list(tmp_path.iterdir()) == [part]


def test_folders_are_made_while_another_run_removes_unfinished_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = Path.write_bytes

    def write_bytes(path: Path, data: bytes) -> int:
        written = real(path, data)
        files.remove_unfinished(tmp_path)
        return written

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    files.made(tmp_path)
    assert not list(tmp_path.iterdir())


def test_unfinished_files_of_a_run_are_removed_when_it_ends(tmp_path: Path) -> None:
    late = tmp_path / ".part-000001.parquet.mine-1.unfinished"
    with late.open("xb") as file:
        # A killed process may keep its lock for a moment.
        files._locked(file)
        if os.name == "posix":
            files.remove_unfinished(tmp_path, "mine")
            assert not late.exists()


@pytest.mark.parametrize(("also", "kept"), [((), 6), (range(10, 99), 0)], ids=["room for the manifest", "none"])
def test_a_full_disk_reports_the_kept_parts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, also: Container[int], kept: int
) -> None:
    real, written = os.fsync, []

    def fsync(number: int) -> None:
        written.append(number)
        # The manifest, the sweep, six parts; then it is full, except for the space of the failed part.
        if len(written) == 9 or len(written) in also:
            raise OSError(errno.ENOSPC, "No space left on device")
        real(number)

    monkeypatch.setattr(os, "fsync", fsync)
    with pytest.raises(scale.SweepFailed, match=r"is full \(No space left on device\): make room\n  \d+ of 20 parts are kept") as error:
        scale.run(works.waves(), tmp_path, items_per_part=50, workers=1)
    assert not list(tmp_path.rglob(".*.unfinished"))
    assert f"{len(manifest(tmp_path)['parts'])} of 20" in str(error.value)
    # Parts may have been written while others were reported.
    assert len(manifest(tmp_path)["parts"]) in ((0,) if kept == 0 else (kept, kept + 1, kept + 2))
    monkeypatch.undo()
    again = scale.run(works.waves(), tmp_path)
    assert again.done_before in ((0,) if kept == 0 else (kept, kept + 1, kept + 2))
    assert len(sums(tmp_path)) == 20


def test_a_failing_part_reports_its_items_and_the_others_are_kept(tmp_path: Path) -> None:
    message = r"part 7 \(items 70 to 79\) failed: ValueError: joint 3 at 151\.2 deg exceeds its limit of 150\.0 deg\n  7 of 10 parts"
    with pytest.raises(scale.SweepFailed, match=message):
        scale.run(scale.Sweep({"i": 100}, works.refuses), tmp_path, items_per_part=10, workers=1)
    assert len(manifest(tmp_path)["parts"]) == 7


def test_bad_numbers_of_workers_are_refused(tmp_path: Path) -> None:
    for name in ("workers", "threads_per_worker", "items_per_part"):
        with pytest.raises(armill.InputError, match=f"{name} is 0"):
            scale.run(works.waves(), tmp_path, **{name: 0})
    with pytest.raises(armill.InputError, match="`slurm` is not a backend"):
        scale.run(works.waves(), tmp_path, "slurm")


def started(folder: Path, progress: bool = False) -> subprocess.Popen[str]:
    # A shell has its background jobs ignore Ctrl-C, and what they start does too.
    heeds = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    command = script(folder, items_per_part=10, seconds=0.05, progress=progress)
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=heeds)


def has_parts(folder: Path, count: int, process: subprocess.Popen[str]) -> None:
    """Waits until the manifest has `count` parts."""
    until = time.monotonic() + 300
    while time.monotonic() < until and process.poll() is None:
        if (folder / "manifest.json").exists() and len(manifest(folder)["parts"]) >= count:
            return
        time.sleep(0.02)
    raise AssertionError(f"the run did not get this far: {process.communicate()[1]}")


def test_a_killed_run_continues_where_it_was(tmp_path: Path) -> None:
    process = started(tmp_path / "killed")
    has_parts(tmp_path / "killed", 20, process)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    assert process.stderr is not None
    process.stderr.close()
    kept = {part["part"] for part in manifest(tmp_path / "killed")["parts"]}
    files = [tmp_path / "killed" / "parts" / f"part-{part:06d}.parquet" for part in sorted(kept)]
    times = [file.stat().st_mtime_ns for file in files]
    again = scale.run(works.waves(seconds=0.05), tmp_path / "killed", workers=8)
    assert again.done_before == len(kept)
    assert again.part_count == 100
    assert [file.stat().st_mtime_ns for file in files] == times, "finished parts are kept"
    scale.run(works.waves(seconds=0.05), tmp_path / "undisturbed", items_per_part=10, workers=50)
    assert sums(tmp_path / "killed") == sums(tmp_path / "undisturbed")


def test_ctrl_c_keeps_finished_parts_and_reports_them(tmp_path: Path) -> None:
    process = started(tmp_path, progress=True)
    has_parts(tmp_path, 1, process)
    process.send_signal(signal.SIGINT)
    _, printed = process.communicate(timeout=30)
    assert "Cancelled: cancelled: " in printed
    assert "of 100 parts are kept in" in printed
    assert 1 <= len(manifest(tmp_path)["parts"]) < 100
    assert not list(tmp_path.rglob(".*.unfinished"))
