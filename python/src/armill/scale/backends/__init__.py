"""Backends that run tasks: threads of this process (``local.py``), Dask (``dask.py``), Ray (``ray.py``).

A backend receives parts and returns their outcomes in any order. ``window.py`` decides how many are sent.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

from armill.scale.errors import refused
from armill.scale.manifest import Done
from armill.scale.task import Failed, Task


@dataclass(frozen=True)
class Lost:
    """A part whose worker died, and the known reason. It may be sent again."""

    part: int
    why: str


Outcome = Done | Failed | Lost


class Backend(Protocol):
    """Runs a task for each part sent."""

    def width(self) -> int:
        """Current number of parts that can run at once."""
        ...

    def send(self, part: int) -> None:
        """Sends a part."""
        ...

    def arrived(self) -> Iterable[Outcome]:
        """Waits for at least one of the parts sent, and returns the outcomes that have arrived."""
        ...

    def close(self) -> None:
        """Cancels parts without an outcome, and stops what was started here."""
        ...


@dataclass(frozen=True)
class BackendOptions:
    """Options of a backend: a name, an address or a client; number of workers; time to wait for them, s."""

    backend: Any
    workers: int | None
    threads_per_worker: int
    timeout: float


def opened(options: BackendOptions, task: Task) -> Backend:
    """The requested backend, ready for parts."""
    backend = options.backend
    if backend == "local":
        from armill.scale.backends.local import Local

        return Local(options, task)
    if isinstance(backend, str) and (backend == "ray" or backend.startswith("ray://")):
        from armill.scale.backends.ray import Ray

        return Ray(options, task)
    is_address = isinstance(backend, str) and backend.partition("://")[0] in {"tcp", "tls", "ucx", "ws", "wss"}
    if backend == "dask" or is_address or (not isinstance(backend, str) and hasattr(backend, "submit")):
        from armill.scale.backends.dask import Dask

        return Dask(options, task)
    hint = '"local", "dask", "ray", the address of a scheduler ("tcp://HOST:8786", "ray://HOST:10001"), or a client of dask'
    raise refused(f"`{backend}` is not a backend", hint)
