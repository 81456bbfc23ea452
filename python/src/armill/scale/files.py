"""Files that are written whole or not at all, and a folder that one run has for itself."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import uuid
from collections.abc import Generator
from pathlib import Path
from typing import IO

from armill.scale.errors import refused

#: What the names of files end in that are not whole yet.
UNFINISHED = ".unfinished"
#: What a system says of a disk, a quota or a file that may not grow.
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write_whole(path: Path, data: bytes | memoryview, run: str = "") -> None:
    """Writes to a file beside, makes sure that it is on the disk, and renames it: readers see all of it or nothing.

    The file beside is locked while it is written, and its name tells which ``run`` it is of.
    """
    beside = path.with_name(f".{path.name}.{run}-{uuid.uuid4().hex}{UNFINISHED}")
    try:
        with beside.open("xb") as file:
            _locked(file)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise


def sha256_of(path: Path) -> str:
    """path -> SHA-256 of the file in hexadecimal digits."""
    whole = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(2**20):
            whole.update(piece)
    return whole.hexdigest()


def made(folder: Path) -> None:
    """Makes the folder, with all above it. Raises InputError where that cannot be, or nothing can be written into it."""
    hint = "give a folder that you may write into"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".{uuid.uuid4().hex}{UNFINISHED}"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise refused(f"cannot write into {folder}: {error.strerror}", hint) from error


def remove_unfinished(folder: Path, run: str | None = None) -> None:
    """Removes what killed writers left: every unfinished file of ``run``, which has ended, and those of others that no process writes.

    A file of another run stays where it is locked, or where the system cannot tell. A process of ``run`` that is still
    writing only repeats a part that is done.
    """
    for left in folder.glob(f".*{UNFINISHED}"):
        is_ours = run is not None and f".{run}-" in left.name
        with contextlib.suppress(OSError):
            if is_ours or _is_abandoned(left):
                left.unlink()


def _is_abandoned(path: Path) -> bool:
    if os.name != "posix":
        # A file that is open cannot be removed there.
        return True
    with path.open("r+b") as file:
        return _locked(file) is True


def _locked(file: IO[bytes]) -> bool | None:
    """Locks the file as long as it is open: False where another process has locked it, None where there are no such locks."""
    if os.name != "posix":
        return None
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


@contextlib.contextmanager
def alone_in(folder: Path) -> Generator[None]:
    """Keeps other runs out of the folder. The system lets go of it however this process ends.

    Some shared disks know no locks; two runs there would write the same bytes.
    """
    with (folder / ".lock").open("ab") as file:
        if _locked(file) is False:
            raise refused(f"another run is at work in {folder}", "wait for it, or stop it first")
        yield
