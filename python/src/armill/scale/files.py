"""Files that are written whole or not at all, and a folder that one run has for itself."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import uuid
from collections.abc import Generator
from pathlib import Path

from armill.scale.errors import refused

#: What the names of files end in that are not whole yet.
UNFINISHED = ".unfinished"
#: What a system says of a disk, a quota or a file that may not grow.
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write_whole(path: Path, data: bytes | memoryview) -> None:
    """Writes beside, makes sure that it lies on the disk, and renames: whoever looks sees all of it or none."""
    beside = path.with_name(f".{path.name}.{uuid.uuid4().hex}{UNFINISHED}")
    try:
        with beside.open("xb") as file:
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


def tidied(folder: Path) -> None:
    """Takes away what runs left unfinished that were killed."""
    for left in folder.glob(f".*{UNFINISHED}"):
        left.unlink(missing_ok=True)


@contextlib.contextmanager
def alone_in(folder: Path) -> Generator[None]:
    """Keeps other runs out of the folder. The system lets go of it however this process ends."""
    with (folder / ".lock").open("ab") as file:
        if os.name == "posix":
            import fcntl

            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise refused(f"another run is at work in {folder}", "wait for it, or stop it first") from error
            except OSError:
                # Some shared disks know no locks; two runs there would write the same bytes.
                pass
        yield
