"""Folders that are not on a disk: ``s3://``, ``gs://``, ``memory://`` and all others of fsspec, with the methods of ``pathlib.Path``.

A file is written by one call of the file system: complete or not at all in object stores. There are no locks.
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from armill.scale.errors import needed, refused

#: Options of a file system of fsspec, such as ``{"endpoint_url": ...}``.
StorageOptions: TypeAlias = "Mapping[str, Any] | None"
_ADDRESS = re.compile(r"([a-z][a-z0-9+.-]+)://(.*)", re.DOTALL)


@dataclass(frozen=True)
class Size:
    """What is known of a file."""

    st_size: int


@dataclass(frozen=True)
class RemotePath:
    """A file or folder of a file system of fsspec."""

    system: Any
    protocol: str
    path: str

    def __truediv__(self, name: str) -> RemotePath:
        return RemotePath(self.system, self.protocol, f"{self.path.rstrip('/')}/{name}")

    def __str__(self) -> str:
        return f"{self.protocol}://{self.path.lstrip('/')}"

    def __fspath__(self) -> str:
        raise TypeError(f"{self} is not on a disk: use its methods")

    @property
    def name(self) -> str:
        """The last part."""
        return self.path.rstrip("/").rpartition("/")[2]

    @property
    def parent(self) -> RemotePath:
        """The folder that contains it."""
        return RemotePath(self.system, self.protocol, self.path.rstrip("/").rpartition("/")[0])

    def absolute(self) -> RemotePath:
        """Itself."""
        return self

    def read_bytes(self) -> bytes:
        """The contents of the file."""
        # A listing of before may lack files of other machines.
        self.system.invalidate_cache()
        data: bytes = self.system.cat_file(self.path)
        return data

    def write_bytes(self, data: bytes | memoryview) -> None:
        """Writes the file in one call."""
        self.system.pipe_file(self.path, bytes(data))

    def stat(self) -> Size:
        """The size of the file."""
        self.system.invalidate_cache()
        return Size(int(self.system.info(self.path)["size"]))

    def unlink(self, missing_ok: bool = False) -> None:
        """Removes the file."""
        try:
            self.system.rm_file(self.path)
        except FileNotFoundError:
            if not missing_ok:
                raise

    def glob(self, pattern: str) -> Iterator[RemotePath]:
        """The files of this folder with names of the pattern."""
        self.system.invalidate_cache()
        for found in self.system.glob(f"{self.path.rstrip('/')}/{pattern}"):
            yield RemotePath(self.system, self.protocol, str(found))

    def mkdir(self, parents: bool = True, exist_ok: bool = True) -> None:
        """Makes the folder, where the file system has folders."""
        self.system.makedirs(self.path, exist_ok=exist_ok)


#: The folder of a sweep.
Folder: TypeAlias = Path | RemotePath


def folder_of(folder: str | os.PathLike[str] | RemotePath, options: StorageOptions = None) -> Folder:
    """A path on a disk, or the address of a folder of fsspec.

    Raises InputError for an unknown protocol, and MissingExtra if the package for it is not installed.
    """
    if isinstance(folder, RemotePath):
        return folder
    text = os.fspath(folder)
    found = _ADDRESS.fullmatch(text)
    if not found or found[1] == "file":
        if options:
            raise refused(f"storage_options are given for {text}", "they are for addresses such as s3://bucket/folder")
        return Path(found[2] if found else text)
    protocol = found[1]
    fsspec: Any = needed("fsspec", "scale")
    known = set(fsspec.available_protocols())
    if protocol not in known:
        raise refused(f"{text}: `{protocol}` is not a file system of fsspec", f"one of {', '.join(sorted(known))}")
    try:
        system, path = fsspec.core.url_to_fs(text, **(options or {}))
    except ImportError as error:
        raise ImportError(f"{text} needs another package: {error}") from error
    return RemotePath(system, protocol, str(path))


def is_missing(error: OSError) -> bool:
    """Whether a file does not exist, for any file system."""
    return isinstance(error, FileNotFoundError) or error.errno == errno.ENOENT
