"""Threads of this process. The native part runs without the lock of Python; for work in Python use processes: Dask."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from armill.scale.backends import BackendOptions, Lost, Outcome
from armill.scale.task import Task


class Local:
    """A pool of threads, one task on each."""

    def __init__(self, options: BackendOptions, task: Task) -> None:
        self._task = task
        self._width = options.workers or max(_processors() // options.threads_per_worker, 1)
        self._pool = ThreadPoolExecutor(self._width, thread_name_prefix="armill-sweep")
        self._sent: dict[Future[Outcome], int] = {}

    def width(self) -> int:
        return self._width

    def send(self, part: int) -> None:
        self._sent[self._pool.submit(self._outcome, part)] = part

    def _outcome(self, part: int) -> Outcome:
        return self._task(part)

    def arrived(self) -> Iterable[Outcome]:
        ready, _ = wait(self._sent, return_when=FIRST_COMPLETED)
        for future in ready:
            part = self._sent.pop(future)
            error = future.exception()
            yield future.result() if error is None else Lost(part, f"{type(error).__name__}: {error}")

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
