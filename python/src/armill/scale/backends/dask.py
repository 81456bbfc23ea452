"""Dask: a cluster of this machine, or any scheduler.

The scheduler reassigns the tasks of a lost worker. A task that killed several workers is returned as ``KilledWorker``.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterable
from typing import Any

from armill.scale.backends import BackendOptions, Lost, Outcome
from armill.scale.errors import SweepFailed, needed
from armill.scale.task import Task

#: Interval at which the number of workers is updated, s.
LOOK_AGAIN_S = 5.0


class Dask:
    """A client, and the cluster if it was started here."""

    def __init__(self, options: BackendOptions, task: Task) -> None:
        self._distributed = needed("distributed", "scale")
        self._task = task
        self._own: list[Any] = []
        self._sent: dict[Any, int] = {}
        self._count = 0
        self._looked, self._width = -LOOK_AGAIN_S, 0
        try:
            self._client = self._connected(options)
            self._found(options)
        except BaseException:
            self.close()
            raise
        self._arrivals = self._distributed.as_completed(
            [], loop=self._client.loop, with_results=True, raise_errors=False
        )

    def _connected(self, options: BackendOptions) -> Any:
        if not isinstance(options.backend, str):
            return options.backend
        address = options.backend
        if address == "dask":
            address = self._started(options)
        try:
            client = self._distributed.Client(address, timeout=options.timeout, set_as_default=False)
        except (OSError, TimeoutError) as error:
            raise SweepFailed(
                f"the scheduler at {address} did not answer within {options.timeout:g} s: check that it is running, and the address"
            ) from error
        self._own.insert(0, client)
        return client

    def _started(self, options: BackendOptions) -> str:
        """The address of a cluster of this machine."""
        try:
            cluster = self._distributed.LocalCluster(
                n_workers=options.workers,
                # Threads of the mechanics, not of Dask.
                threads_per_worker=1,
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
            )
        except RuntimeError as error:
            hint = 'a script that starts processes does so under `if __name__ == "__main__":`'
            raise SweepFailed(f"the workers did not start ({error}): {hint}") from error
        self._own.append(cluster)
        address: str = cluster.scheduler_address
        return address

    def _found(self, options: BackendOptions) -> None:
        try:
            self._client.wait_for_workers(options.workers or 1, timeout=options.timeout)
        except (OSError, TimeoutError) as error:
            there = len(self._client.scheduler_info(n_workers=-1)["workers"])
            raise SweepFailed(
                f"the scheduler has {there} of {options.workers or 1} workers after {options.timeout:g} s: start them, or wait longer (timeout=)"
            ) from error

    def width(self) -> int:
        now = time.monotonic()
        if now - self._looked > LOOK_AGAIN_S:
            self._looked, self._width = now, sum(self._client.nthreads().values())
        # Without workers one part waits for them.
        return max(self._width, 1)

    def send(self, part: int) -> None:
        self._count += 1
        # A unique name on the scheduler: a part may be sent again.
        key = f"armill-{self._task.fingerprint[:12]}-{id(self):x}-{self._count}-part-{part}"
        future = self._client.submit(self._task, part, key=key, pure=False)
        self._sent[future] = part
        self._arrivals.add(future)

    def arrived(self) -> Iterable[Outcome]:
        for future, result in self._arrivals.next_batch():
            part = self._sent.pop(future)
            if future.status == "finished":
                yield result
            elif future.status == "error":
                error = future.exception()
                yield Lost(part, f"{type(error).__name__}: {error}")
            else:
                raise SweepFailed(f"the connection to the scheduler was lost ({future.status})")

    def close(self) -> None:
        if self._sent:
            self._client.cancel(list(self._sent), force=True)
            self._sent.clear()
        for own in self._own:
            own.close()
        self._own.clear()
