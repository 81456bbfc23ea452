"""Ray: processes of this machine, or any cluster. Ray itself does not retry tasks."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable
from typing import Any

from armill.scale.backends import BackendOptions, Lost, Outcome
from armill.scale.errors import SweepFailed, needed
from armill.scale.task import Task


#: Interval at which the number of processors is updated, s.
LOOK_AGAIN_S = 5.0


class Ray:
    """A connection, which is closed if it was opened here."""

    def __init__(self, options: BackendOptions, task: Task) -> None:
        self._ray = needed("ray", "ray")
        self._threads = options.threads_per_worker
        self._own = not self._ray.is_initialized()
        self._sent: dict[Any, int] = {}
        self._looked, self._width = -LOOK_AGAIN_S, 1
        if self._own:
            self._start(options)
        run = self._ray.remote(_part)
        self._remote = run.options(num_cpus=self._threads, max_retries=0)
        self._task = self._ray.put(task)

    def _start(self, options: BackendOptions) -> None:
        quiet: dict[str, Any] = {"logging_level": "error", "log_to_driver": False}
        try:
            if options.backend == "ray" and os.environ.get("RAY_ADDRESS"):
                self._ray.init(address="auto", **quiet)
            elif options.backend == "ray":
                workers = options.workers and options.workers * self._threads
                self._ray.init(num_cpus=workers, include_dashboard=False, **quiet)
            else:
                self._ray.init(address=options.backend, **quiet)
        except (ConnectionError, TimeoutError, RuntimeError) as error:
            raise SweepFailed(f"ray at {options.backend} cannot be reached: {error}") from error

    def width(self) -> int:
        now = time.monotonic()
        if now - self._looked > LOOK_AGAIN_S:
            processors = self._ray.cluster_resources().get("CPU", 1)
            self._looked, self._width = now, max(int(processors) // self._threads, 1)
        return self._width

    def send(self, part: int) -> None:
        self._sent[self._remote.remote(self._task, part)] = part

    def arrived(self) -> Iterable[Outcome]:
        first, _ = self._ray.wait(list(self._sent), num_returns=1)
        ready, _ = self._ray.wait(list(self._sent), num_returns=len(self._sent), timeout=0)
        for reference in ready or first:
            part = self._sent.pop(reference)
            try:
                yield self._ray.get(reference)
            except self._ray.exceptions.RayError as error:
                yield Lost(part, f"{type(error).__name__}: {str(error).strip().partition(chr(10))[0]}")

    def close(self) -> None:
        for reference in self._sent:
            self._ray.cancel(reference, force=True)
        self._sent.clear()
        if self._own:
            self._ray.shutdown()


def _part(task: Task, part: int) -> Outcome:
    return task(part)
