"""Where tasks run: threads of this process (``local.py``), Dask (``dask.py``), Ray (``ray.py``).

A backend takes parts and gives what became of them in any order. How many are sent is not its business (``window.py``).
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
    """A part whose worker died, and what is known of it: another may have it."""

    part: int
    why: str


Outcome = Done | Failed | Lost


class Backend(Protocol):
    """Runs a task for one part after the other."""

    def width(self) -> int:
        """How many parts can be at work at once, by now."""
        ...

    def send(self, part: int) -> None:
        """Takes a part."""
        ...

    def arrived(self) -> Iterable[Outcome]:
        """Waits until one at least of the parts sent has come to its end, and tells those that have."""
        ...

    def close(self) -> None:
        """Gives up what was sent and not told, and lets go of what was started here."""
        ...


@dataclass(frozen=True)
class Wanted:
    """What was asked of a backend: a name, an address or a client; how many workers; how long to wait for them, s."""

    backend: Any
    workers: int | None
    threads_per_worker: int
    timeout: float


def opened(wanted: Wanted, task: Task) -> Backend:
    """The backend that is wanted, ready to take parts."""
    backend = wanted.backend
    if backend == "local":
        from armill.scale.backends.local import Local

        return Local(wanted, task)
    if isinstance(backend, str) and (backend == "ray" or backend.startswith("ray://")):
        from armill.scale.backends.ray import Ray

        return Ray(wanted, task)
    is_address = isinstance(backend, str) and backend.partition("://")[0] in {"tcp", "tls", "ucx", "ws", "wss"}
    if backend == "dask" or is_address or (not isinstance(backend, str) and hasattr(backend, "submit")):
        from armill.scale.backends.dask import Dask

        return Dask(wanted, task)
    hint = '"local", "dask", "ray", the address of a scheduler ("tcp://HOST:8786", "ray://HOST:10001"), or a client of dask'
    raise refused(f"there is no backend {backend!r}", hint)
