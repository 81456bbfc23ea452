"""Runs the unfinished parts of a sweep, and writes the manifest of its folder.

::

    manifest of the folder -> valid parts -> the others to workers -> files, and the manifest at intervals -> complete

The manifest is written about once a second. If the process is killed, parts finished since then are repeated, with the same
bytes.
"""

from __future__ import annotations

import functools
import os
import time
import uuid
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from armill import Cancelled
from armill.scale import files
from armill.scale.backends import BackendOptions, opened
from armill.scale.errors import SweepFailed, needed, refused
from armill.scale.fingerprint import request_of
from armill.scale.manifest import JOBS, NAME, PARTS, Done, Manifest, same_sweep
from armill.scale.planning import Plan, plan
from armill.scale.progress import Progress
from armill.scale.reading import is_whole, read
from armill.scale.remote import Folder, StorageOptions, folder_of
from armill.scale.sweep import Sweep
from armill.scale.task import forgotten, task
from armill.scale.window import worked

#: Interval at which the manifest is written, s, and the largest fraction of the time for it.
KEPT_S = 1.0
KEPT_PART = 0.05
#: Number of threads that check files.
CHECKERS = 4


@dataclass(frozen=True)
class Finished:
    """A finished sweep: its folder, its contents, and the work of this run.

    Of a job of an array they are its own. ``done_before`` is the number of parts that were valid before; ``redone`` are the damaged parts that were repeated.
    ``seconds`` is the duration of this run, ``task_seconds`` the total duration of its tasks.
    """

    folder: Folder
    rows: int
    part_count: int
    evaluation_count: int
    done_before: int
    redone: tuple[int, ...]
    seconds: float
    task_seconds: float

    def read(self) -> Any:
        """-> pyarrow.dataset.Dataset: its rows, as ``armill.scale.read`` returns them."""
        return read(self.folder)


def run(
    sweep: Sweep | Plan,
    folder: str | os.PathLike[str],
    backend: Any = "local",
    *,
    workers: int | None = None,
    threads_per_worker: int = 1,
    items_per_part: int | None = None,
    progress: bool | None = None,
    timeout: float = 30.0,
    shard: tuple[int, int] | None = None,
    storage_options: StorageOptions = None,
) -> Finished:
    """sweep, folder -> Finished: computes the missing parts of the folder.

    ``backend`` is ``"local"`` (threads of this process), ``"dask"`` (processes of this machine), the address of a scheduler
    of Dask (``"tcp://HOST:8786"``), a ``dask.distributed.Client``, ``"ray"`` (processes of this machine, or the cluster of
    ``RAY_ADDRESS``), or the address of a cluster of Ray (``"ray://HOST:10001"``). ``workers`` are started here, or waited for where they run elsewhere; without it as many as
    there are processors, or as come. Each has ``threads_per_worker``. ``items_per_part`` fixes the parts, which are else
    planned by what some items take here. ``progress`` shows a bar always or never; without it where stderr is a terminal.
    ``shard`` is the number of this job, from 0, and the number of jobs, for arrays of jobs of a batch system: it computes its part
    of the parts, of which ``items_per_part`` must be given; a call without ``shard`` takes over the parts of all jobs.
    ``folder`` is on a disk, or an address of fsspec such as ``s3://bucket/folder``, with its ``storage_options``.
    ``timeout`` is how long a scheduler may take to answer, and its workers to come, s. Ctrl-C stops it; the same call goes on.
    """
    began = time.monotonic()
    for name, value in (("workers", workers), ("threads_per_worker", threads_per_worker), ("items_per_part", items_per_part)):
        if value is not None and (isinstance(value, bool) or value < 1):
            raise refused(f"{name} is {value!r}", "an integer of at least 1")
    needed("pyarrow.parquet", "scale")
    place = folder_of(folder, storage_options).absolute()
    home = _home(place, shard)
    files.made(home)
    with files.alone_in(home):
        ready, manifest = _begun(sweep, (place, home), items_per_part, threads_per_worker, shard)
        if shard is None:
            _take_over(place, manifest)
        before = len(manifest.done)
        damaged = _damaged(place, manifest)
        for part in damaged:
            del manifest.done[part]
        files.made(place / PARTS)
        files.remove_unfinished(home)
        files.remove_unfinished(place / PARTS)
        task_seconds = 0.0
        if not manifest.is_complete:
            shown = Progress(progress, _evaluations(ready, manifest.parts), _evaluations(ready, manifest.done))
            if damaged:
                shown.note(f"{len(damaged)} parts are not as they were written and are repeated")
            options = BackendOptions(backend, workers, threads_per_worker, timeout)
            task_seconds = _work(ready, (place, home), manifest, options, shown)
        return Finished(
            place,
            sum(done.rows for done in manifest.done.values()),
            len(manifest.parts),
            _evaluations(ready, manifest.done),
            before - len(damaged),
            tuple(damaged),
            time.monotonic() - began,
            task_seconds,
        )


def _home(place: Folder, shard: tuple[int, int] | None) -> Folder:
    """The folder of the manifest: that of the sweep, or of a job."""
    if shard is None:
        return place
    job, jobs = shard
    if not 0 <= job < jobs:
        raise refused(f"shard: job {job} of {jobs} does not exist", "the number of the job from 0, and the number of jobs")
    return place / JOBS / f"{job}-of-{jobs}"


def _begun(
    sweep: Sweep | Plan,
    folders: tuple[Folder, Folder],
    items_per_part: int | None,
    threads: int,
    shard: tuple[int, int] | None,
) -> tuple[Plan, Manifest]:
    """The plan of the folder and its manifest; new if there is none."""
    place, home = folders
    given = sweep if isinstance(sweep, Plan) else None
    if given and items_per_part is not None:
        raise refused("items_per_part is given twice", "a plan has its parts")
    what = sweep.sweep if isinstance(sweep, Plan) else sweep
    requested = given.items_per_part if given else items_per_part
    manifest = Manifest.read(home)
    jobs = [] if shard else _jobs(place)
    if manifest is None and shard and requested is None:
        raise refused("items_per_part is not given", "jobs of an array plan for themselves: give all the same number, or a plan")
    if manifest is None and not jobs:
        ready = given or plan(what, items_per_part=requested, threads=threads)
        return ready, Manifest.of(ready, shard)
    first = manifest or jobs[0]
    same_sweep(first, request_of(what), place)
    ready = plan(what, items_per_part=requested or first.items_per_part)
    if ready.items_per_part != first.items_per_part:
        message = f"{place} has parts of {first.items_per_part} items, not {ready.items_per_part}"
        raise refused(message, "the parts of a sweep cannot be changed; omit items_per_part, or give another folder")
    return ready, manifest or Manifest.of(ready)


def _jobs(place: Folder) -> list[Manifest]:
    """The manifests of the jobs of an array."""
    homes = sorted((path.parent for path in (place / JOBS).glob(f"*/{NAME}")), key=str)
    return [found for found in map(Manifest.read, homes) if found is not None]


def _take_over(place: Folder, manifest: Manifest) -> None:
    """Adds the parts of jobs to the manifest of the sweep."""
    for job in _jobs(place):
        if job.fingerprint != manifest.fingerprint or job.items_per_part != manifest.items_per_part:
            raise refused(f"{place} contains jobs of another sweep", "remove the folder `jobs`, or give another folder")
        if job.done and not manifest.columns:
            manifest.columns = job.columns
        for part, done in job.done.items():
            manifest.done.setdefault(part, done)
    if manifest.is_complete:
        manifest.write(place)


def _damaged(place: Folder, manifest: Manifest) -> list[int]:
    parts = sorted(manifest.done)
    with ThreadPoolExecutor(CHECKERS) as pool:
        whole = pool.map(functools.partial(is_whole, place, manifest, verify=True), parts)
        return [part for part, good in zip(parts, whole, strict=True) if not good]


def _evaluations(ready: Plan, parts: Iterable[int]) -> int:
    spans = (ready.span(part) for part in parts)
    return sum(last - first for first, last in spans) * ready.sweep.evaluations_per_item


def _work(ready: Plan, folders: tuple[Folder, Folder], manifest: Manifest, options: BackendOptions, shown: Progress) -> float:
    """Runs all unfinished parts and writes the manifest; returns the duration of the tasks."""
    place, home = folders
    keeper = _Keeper(home, manifest)
    try:
        seconds = _parts(ready, folders, keeper, options, shown)
        keeper.write()
        return seconds
    except KeyboardInterrupt as error:
        raise Cancelled(f"cancelled: {keeper.last()}") from error
    except SweepFailed as error:
        raise SweepFailed(f"{error}\n  {keeper.last()}") from error
    except OSError as error:
        if error.errno not in files.FULL:
            raise
        raise SweepFailed(f"the disk of {place} is full ({error.strerror}): make room\n  {keeper.last()}") from error
    finally:
        shown.end()


def _parts(ready: Plan, folders: tuple[Folder, Folder], keeper: _Keeper, options: BackendOptions, shown: Progress) -> float:
    """Runs all unfinished parts; returns the duration of their tasks."""
    seconds = 0.0
    place, home = folders
    manifest = keeper.manifest
    keeper.write()
    run_name = uuid.uuid4().hex
    to_do = [part for part in manifest.parts if part not in manifest.done]
    try:
        backend = opened(options, task(ready, folders, manifest.fingerprint, options.threads_per_worker, run_name))
        shown.begin()
        try:
            for done in worked(backend, to_do):
                keeper.take(done)
                seconds += done.seconds
                first, last = ready.span(done.part)
                shown.add((last - first) * ready.sweep.evaluations_per_item)
        finally:
            backend.close()
    finally:
        forgotten(home)
        # Left by a worker that was killed while it wrote.
        files.remove_unfinished(place / PARTS, run_name)
    return seconds


class _Keeper:
    """Writes the manifest at intervals, since its size grows with the parts."""

    def __init__(self, place: Folder, manifest: Manifest) -> None:
        self.manifest = manifest
        self._place = place
        self._next = 0.0
        self._kept = 0

    def take(self, done: Done) -> None:
        manifest = self.manifest
        if not manifest.columns:
            manifest.columns = done.columns
        elif manifest.columns != done.columns:
            differing = [" ".join(column) for column in set(manifest.columns) ^ set(done.columns)]
            raise SweepFailed(f"part {done.part} has other columns than the parts before: {', '.join(sorted(differing))}")
        manifest.done[done.part] = done
        if time.monotonic() >= self._next:
            self.write()

    def write(self) -> None:
        began = time.monotonic()
        self.manifest.write(self._place)
        self._kept = len(self.manifest.done)
        ended = time.monotonic()
        self._next = ended + max(KEPT_S, (ended - began) / KEPT_PART)

    def last(self) -> str:
        """Writes it after an error, if there is room; returns the number of kept parts as text."""
        try:
            self.write()
        except OSError as error:
            if error.errno not in files.FULL:
                raise
        return f"{self._kept} of {len(self.manifest.parts)} parts are kept in {self._place}: repeat the call to continue"
