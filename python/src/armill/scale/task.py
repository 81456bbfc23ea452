"""One part on any machine: compute it, write its file, return a few numbers.

The sweep is in the folder as a pickle: a task is small, and any worker with access to the folder can run it. Errors are
returned as values: they would occur on any worker.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import pickle
import time
from dataclasses import dataclass
from typing import Any

import armill
from armill import _armill
from armill.scale.errors import needed
from armill.scale.files import FULL, write_whole
from armill.scale.manifest import Done, part_path
from armill.scale.planning import Plan
from armill.scale.remote import Folder
from armill.scale.table import table_of


@dataclass(frozen=True)
class Failed:
    """A part that cannot be computed or written, and why."""

    part: int
    why: str


@dataclass(frozen=True)
class Task:
    """Computes a part when called with its number."""

    folder: Folder
    home: Folder
    pickle_name: str
    fingerprint: str
    version: str
    arithmetic: str
    threads: int
    run: str

    def __call__(self, part: int) -> Done | Failed:
        """part -> Done or Failed."""
        try:
            return self._done(part)
        except OSError as error:
            if error.errno in FULL:
                return Failed(part, f"the disk of {self.folder} is full ({error.strerror}): make room")
            return Failed(part, f"part {part}: {error}")
        except Exception as error:
            return Failed(part, f"part {part}{self._items(part)} failed: {type(error).__name__}: {error}")

    def _items(self, part: int) -> str:
        """The items of the part, if known."""
        try:
            first, last = self._plan().span(part)
        except Exception:
            return ""
        return f" (items {first} to {last - 1})"

    def _plan(self) -> Plan:
        return _plan(self.home, self.pickle_name)

    def _done(self, part: int) -> Done:
        if armill.__version__ != self.version:
            raise RuntimeError(f"this worker has armill {armill.__version__}, the sweep was started with {self.version}")
        if _armill.arithmetic() != self.arithmetic:
            raise RuntimeError(f"this worker rounds {_armill.arithmetic()}, the sweep was started on one that rounds {self.arithmetic}")
        plan = self._plan()
        before = time.perf_counter()
        table = table_of(plan.sweep, *plan.span(part), self.threads)
        table = table.replace_schema_metadata({"armill.sweep": self.fingerprint})
        data = _parquet(table)
        write_whole(part_path(self.folder, part), data, self.run)
        columns = tuple((column.name, str(column.type)) for column in table.schema)
        took = time.perf_counter() - before
        return Done(part, table.num_rows, len(data), hashlib.sha256(data).hexdigest(), columns, took)


def _parquet(table: Any) -> memoryview:
    arrow, parquet = needed("pyarrow", "scale"), needed("pyarrow.parquet", "scale")
    sink = arrow.BufferOutputStream()
    parquet.write_table(table, sink, compression="zstd")
    return memoryview(sink.getvalue())


@functools.lru_cache(maxsize=2)
def _plan(folder: Folder, name: str) -> Plan:
    """The plan in this file, whose name is the hash of its contents."""
    try:
        data = (folder / name).read_bytes()
    except FileNotFoundError as error:
        raise RuntimeError(f"this worker has no access to {folder}: use a folder that all machines share") from error
    if pickle_name(data) != name:
        raise RuntimeError(f"{folder}/{name} is damaged")
    plan: Plan = pickle.loads(data)
    return plan


def pickle_name(data: bytes) -> str:
    """The name of the file with this pickle."""
    return f".sweep-{hashlib.sha256(data).hexdigest()[:32]}.pickle"


def task(plan: Plan, folders: tuple[Folder, Folder], fingerprint: str, threads: int, run: str) -> Task:
    """The task that makes the parts of this plan for this run, and writes the pickle that it reads.

    `folders` are those of the sweep and of the pickle, which differ for a job of an array.
    """
    folder, home = folders
    data = _pickled(plan)
    name = pickle_name(data)
    forgotten(home)
    write_whole(home / name, data)
    return Task(folder, home, name, fingerprint, armill.__version__, _armill.arithmetic(), threads, run)


def forgotten(folder: Folder) -> None:
    """Removes the pickle after the run."""
    for old in folder.glob(".sweep-*.pickle"):
        old.unlink(missing_ok=True)


def _pickled(plan: Plan) -> bytes:
    try:
        # It supports functions of scripts and notebooks too, and is installed with both backends.
        pickler: Any = importlib.import_module("cloudpickle")
    except ModuleNotFoundError:
        pickler = pickle
    data: bytes = pickler.dumps(plan)
    return data
