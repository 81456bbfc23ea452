"""Files that are written atomically, and a folder that is locked for one run."""

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
from armill.scale.remote import Folder, RemotePath

#: Suffix of unfinished files.
UNFINISHED = ".unfinished"
#: Errors of a full disk, a quota or a file size limit.
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write_whole(path: Folder, data: bytes | memoryview, run: str = "") -> None:
    """Writes a temporary file, flushes it to the disk, and renames it: readers see all of it or nothing.

    The temporary file is locked while it is written; its name contains ``run``. A file that is not on a disk is written by
    one call.
    """
    if isinstance(path, RemotePath):
        path.write_bytes(data)
        return
    while not _written(path, data, run):
        pass


def _written(path: Path, data: bytes | memoryview, run: str) -> bool:
    """Whether it is written: False if another run removed the temporary file before it was locked."""
    temporary = path.with_name(f".{path.name}.{run}-{uuid.uuid4().hex}{UNFINISHED}")
    try:
        with temporary.open("xb") as file:
            if _locked(file) is False or os.fstat(file.fileno()).st_nlink == 0:
                temporary.unlink(missing_ok=True)
                return False
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            if os.name == "posix":
                # While it is locked: another run takes an unlocked file for one without a writer.
                temporary.replace(path)
        if os.name != "posix":
            temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return True


def sha256_of(path: Folder) -> str:
    """path -> SHA-256 of the file in hexadecimal digits."""
    if isinstance(path, RemotePath):
        return hashlib.sha256(path.read_bytes()).hexdigest()
    whole = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(2**20):
            whole.update(piece)
    return whole.hexdigest()


def made(folder: Folder) -> None:
    """Creates the folder and its parents. Raises InputError if that is not possible, or the folder is not writable."""
    hint = "give a writable folder"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        # Another run may remove it first.
        probe = folder / f".{uuid.uuid4().hex}{UNFINISHED}"
        probe.write_bytes(b"")
        probe.unlink(missing_ok=True)
    except OSError as error:
        raise refused(f"cannot write into {folder}: {error.strerror or error}", hint) from error


def remove_unfinished(folder: Folder, run: str | None = None) -> None:
    """Removes files of killed writers: unfinished files of ``run``, which has ended, and those of other runs without a writer.

    A file of another run is kept if it is locked, or if locks are not supported. A process of ``run`` that is still writing
    only repeats a finished part. There are none in a folder that is not on a disk.
    """
    if isinstance(folder, RemotePath):
        return
    for left in folder.glob(f".*{UNFINISHED}"):
        is_ours = run is not None and f".{run}-" in left.name
        with contextlib.suppress(OSError):
            if is_ours or os.name != "posix":
                # An open file cannot be removed where there are no locks.
                left.unlink()
            else:
                with left.open("r+b") as file:
                    if _locked(file) is True:
                        left.unlink()


def _locked(file: IO[bytes]) -> bool | None:
    """Locks the file while it is open: False if another process has locked it, None if locks are not supported."""
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
def alone_in(folder: Folder) -> Generator[None]:
    """Locks the folder for one run. The system releases the lock when the process ends.

    Some shared disks, and folders that are not on a disk, have no locks; two runs there would write the same bytes.
    """
    if isinstance(folder, RemotePath):
        yield
        return
    with (folder / ".lock").open("ab") as file:
        if _locked(file) is False:
            raise refused(f"another run uses {folder}", "wait for it, or stop it first")
        yield
