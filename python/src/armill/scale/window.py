"""Limits the number of parts sent: a few more than can run at once.

A part whose worker died is sent again a limited number of times, since the part itself may kill its workers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from armill.scale.backends import Backend, Lost
from armill.scale.errors import SweepFailed
from armill.scale.manifest import Done
from armill.scale.task import Failed

#: Parts sent per part that can run: the next waits at the worker while the last outcome is sent.
AHEAD = 2
#: Number of lost workers after which a part is regarded as the cause.
MOST_LOST = 3


def worked(backend: Backend, parts: Iterable[int]) -> Iterator[Done]:
    """Sends all parts, a limited number at once, and yields finished ones. Raises SweepFailed if a part fails."""
    waiting = iter(parts)
    lost: Counter[int] = Counter()
    under_way = 0
    while True:
        room = AHEAD * backend.width() - under_way
        for _, part in zip(range(room), waiting, strict=False):
            backend.send(part)
            under_way += 1
        if not under_way:
            return
        failed, again = None, list[int]()
        for outcome in backend.arrived():
            under_way -= 1
            match outcome:
                case Done():
                    yield outcome
                case Failed():
                    failed = failed or outcome
                case Lost(part, why):
                    lost[part] += 1
                    if lost[part] == MOST_LOST:
                        failed = Failed(part, f"part {part} did not come back from {MOST_LOST} workers, the last time by {why}")
                    again.append(part)
        # Other outcomes that have arrived are kept.
        if failed:
            raise SweepFailed(failed.why)
        for part in again:
            backend.send(part)
            under_way += 1
