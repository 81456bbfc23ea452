"""A sweep: items in a fixed order, and a function of some of them.

The items are all combinations of the axes, the last axis fastest. The function receives a ``Block`` of consecutive items and
returns columns with as many rows as items, or a whole multiple of it, item after item.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armill.scale.errors import refused

#: Item numbers have 64 bits.
MOST_ITEMS = 2**62

Columns = Mapping[str, Any]
Work = Callable[["Block"], Columns]


@dataclass(frozen=True)
class Sweep:
    """axes and work -> a sweep.

    ``axes`` has the length of each axis by name; ``work`` is a function, or another callable, that returns columns for a
    ``Block``. It must be importable on the workers or picklable, and return the same for the same block.
    ``evaluations_per_item`` is the unit of rates. ``seed`` is passed on and is part of the request.
    """

    axes: Mapping[str, int]
    work: Work
    evaluations_per_item: int = 1
    seed: int | None = None

    def __post_init__(self) -> None:
        if not self.axes:
            raise refused("a sweep has no axis", 'give one at least: axes={"pose": 1000}')
        for name, length in self.axes.items():
            if not name.isidentifier():
                raise refused(f"axis `{name}` is not a valid name", "use letters, digits and _")
            if not isinstance(length, Integral) or isinstance(length, bool) or length < 1:  # pyright: ignore
                raise refused(f"axis `{name}` has the length {length!r}", "an integer of at least 1")
        object.__setattr__(self, "axes", {name: int(length) for name, length in self.axes.items()})
        if self.item_count > MOST_ITEMS:
            raise refused(f"{self.item_count:.3g} items are too many", f"at most {MOST_ITEMS:.3g} items")
        if not callable(self.work):
            raise refused(f"work: a {type(self.work).__name__} cannot be called", "a function of a Block")
        if self.evaluations_per_item < 1:
            raise refused(f"evaluations_per_item is {self.evaluations_per_item}", "an integer of at least 1")

    @property
    def item_count(self) -> int:
        """-> int: number of items."""
        return math.prod(int(length) for length in self.axes.values())

    @property
    def evaluation_count(self) -> int:
        """-> int: number of evaluations of the model."""
        return self.item_count * self.evaluations_per_item

    def block(self, first: int, last: int, threads: int = 1) -> Block:
        """The items from ``first`` up to, but not including, ``last``."""
        return Block(first, last, dict(self.axes), threads, self.seed)


@dataclass(frozen=True)
class Block:
    """Consecutive items from ``first`` up to, but not including, ``last``.

    ``threads`` is the number of threads for the work, ``seed`` that of the sweep.
    """

    first: int
    last: int
    axes: Mapping[str, int]
    threads: int = 1
    seed: int | None = None
    _indices: dict[str, NDArray[np.int64]] = field(default_factory=dict[str, NDArray[np.int64]], compare=False, repr=False)

    def __len__(self) -> int:
        return self.last - self.first

    def __getitem__(self, axis: str) -> NDArray[np.int64]:
        """axis name -> (items,) int: index of each item on this axis."""
        if not self._indices:
            lengths = tuple(int(length) for length in self.axes.values())
            places = np.unravel_index(np.arange(self.first, self.last), lengths)
            self._indices.update(zip(self.axes, places, strict=True))
        return self._indices[axis]
