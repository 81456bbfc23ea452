"""How many parts are under way: a few more than can be at work, however many there are.

A part whose worker died is sent again, a few times: a part that brings down every worker should not bring down them all.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from armill.scale.backends import Backend, Lost
from armill.scale.errors import SweepFailed
from armill.scale.manifest import Done
from armill.scale.task import Failed

#: Parts sent for each that can be at work: the next waits at the worker while the answer of the last travels.
AHEAD = 2
#: A part may lose so many workers before it counts as the reason.
MOST_LOST = 3


def worked(backend: Backend, parts: Iterable[int]) -> Iterator[Done]:
    """Sends all parts, never too many at once, and gives what is done as it comes. Raises SweepFailed for one that fails."""
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
        # What else has arrived is kept.
        if failed:
            raise SweepFailed(failed.why)
        for part in again:
            backend.send(part)
            under_way += 1
