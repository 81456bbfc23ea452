"""Division of a sweep into parts.

Some items are computed first, and their time decides how many go into a part: so many that sending a task and writing its
file take little time in comparison, and so few that little is lost with a worker. The parts are then fixed: the manifest
records them, and every later run uses them.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

from armill.scale.errors import SweepFailed, refused
from armill.scale.sweep import Sweep
from armill.scale.table import table_of

#: The shortest useful task, s, and a factor for machines that are faster than this one.
SHORTEST_S = 0.05
ROOM = 2.0
#: The longest task, s: what may be lost with a worker.
LONGEST_S = 4.0
#: From this number on, parts are shared out evenly; and the largest number in a folder unless parts get longer.
FEW_PARTS = 200
MOST_PARTS = 20_000
#: Largest part in memory, bytes.
MOST_BYTES = 128 * 2**20
#: Duration of the measurement of the time per item, s, and number of places of the sweep.
MEASURED_S = 0.03
PLACES = 3


@dataclass(frozen=True)
class Plan:
    """A sweep and its parts: ``items_per_part`` each, the last perhaps fewer.

    ``seconds_per_item`` and ``bytes_per_item`` were measured here, on one task; None if the parts were given.
    """

    sweep: Sweep
    items_per_part: int
    seconds_per_item: float | None = None
    bytes_per_item: float | None = None

    @property
    def part_count(self) -> int:
        """-> int: number of parts."""
        return -(-self.sweep.item_count // self.items_per_part)

    def span(self, part: int) -> tuple[int, int]:
        """part -> (first, last): its items, ``last`` not included."""
        first = part * self.items_per_part
        return first, min(first + self.items_per_part, self.sweep.item_count)

    def __str__(self) -> str:
        sweep = self.sweep
        text = (
            f"{sweep.item_count:,} items, {sweep.evaluation_count:,} evaluations, "
            f"in {self.part_count:,} parts of {self.items_per_part:,} items"
        )
        if self.seconds_per_item is None or self.bytes_per_item is None:
            return text
        seconds, size = (each * sweep.item_count for each in (self.seconds_per_item, self.bytes_per_item))
        each = self.seconds_per_item * self.items_per_part
        return f"{text}; {each:.2g} s per part and {seconds:.3g} s in total on one worker here, {size / 1e6:.3g} MB in memory"


def plan(sweep: Sweep, *, items_per_part: int | None = None, threads: int = 1) -> Plan:
    """sweep -> Plan: measured here on ``threads`` threads, or with parts of ``items_per_part``."""
    if items_per_part is not None:
        if isinstance(items_per_part, bool) or items_per_part < 1:
            raise refused(f"items_per_part is {items_per_part!r}", "an integer of at least 1")
        return Plan(sweep, min(int(items_per_part), sweep.item_count))
    seconds, size = _measured(sweep, threads)
    whole = seconds * sweep.item_count
    target = min(max(whole / FEW_PARTS, ROOM * SHORTEST_S), LONGEST_S)
    # Longer parts if the folder would get too many.
    target = max(target, whole / MOST_PARTS)
    items = min(target / seconds, MOST_BYTES / size)
    return Plan(sweep, min(max(_rounded(items), 1), sweep.item_count), seconds, size)


def _measured(sweep: Sweep, threads: int) -> tuple[float, float]:
    """Seconds and bytes per item, of items in some places of the sweep."""
    items = sweep.item_count
    seconds = size = count = 0.0
    for place in range(PLACES):
        requested = 1
        while True:
            first = min(place * items // PLACES, items - 1)
            last = min(first + requested, items)
            try:
                before = time.perf_counter()
                table = table_of(sweep, first, last, threads)
                took = time.perf_counter() - before
            except Exception as error:
                raise SweepFailed(f"items {first} to {last - 1} failed: {type(error).__name__}: {error}") from error
            if took >= MEASURED_S or last - first < requested:
                break
            # Up to 64 times as many, by the time taken.
            requested = max(2 * requested, min(64 * requested, int(requested * MEASURED_S / max(took, 1e-6))))
        seconds, size, count = seconds + took, size + table.nbytes, count + last - first
    return max(seconds / count, 1e-12), max(size / count, 1.0)


def _rounded(items: float) -> int:
    """Rounded down to two digits."""
    whole = int(items)
    step = int(10 ** max(len(str(whole)) - 2, 0))
    return whole // step * step
