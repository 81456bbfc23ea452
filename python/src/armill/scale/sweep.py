"""What is asked: items in an order that never changes, and a function of some of them.

The items are all combinations of the axes, the last axis fastest. The function gets a ``Block`` of items that follow each
other and gives columns: as many rows as there are items, or a whole multiple of it, item after item.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armill.scale.errors import refused

#: Items are counted in 64 bits.
MOST_ITEMS = 2**62

Columns = Mapping[str, Any]
Work = Callable[["Block"], Columns]


@dataclass(frozen=True)
class Sweep:
    """axes and work -> what is asked.

    ``axes`` has the length of each axis by its name; ``work`` is a function, or an object that can be called, that gives
    columns for a ``Block``. It must be importable on the workers, or travel in a pickle, and give the same for the same
    block. ``evaluations_per_item`` is what rates are told in. ``seed`` is handed on and is part of what is asked.
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
                raise refused(f"axis `{name}` is no name", "letters, digits and _ make a name of a column")
            if not isinstance(length, int) or isinstance(length, bool) or length < 1:  # pyright: ignore
                raise refused(f"axis `{name}` has the length {length!r}", "a whole number from 1 on")
        if self.item_count > MOST_ITEMS:
            raise refused(f"{self.item_count:.3g} items are more than can be counted", "sweep over less")
        if not callable(self.work):
            raise refused(f"work: a {type(self.work).__name__} cannot be called", "a function of a Block")
        if self.evaluations_per_item < 1:
            raise refused(f"evaluations_per_item is {self.evaluations_per_item}", "a whole number from 1 on")

    @property
    def item_count(self) -> int:
        """-> int: how many items."""
        return math.prod(int(length) for length in self.axes.values())

    @property
    def evaluation_count(self) -> int:
        """-> int: how many evaluations of the model they are."""
        return self.item_count * self.evaluations_per_item

    def block(self, first: int, last: int, threads: int = 1) -> Block:
        """The items from ``first`` up to ``last``, which is not among them."""
        return Block(first, last, dict(self.axes), threads, self.seed)


@dataclass(frozen=True)
class Block:
    """Items that follow each other, from ``first`` up to ``last``, which is not among them.

    ``threads`` is on how many threads the work may run, ``seed`` that of the sweep.
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
        """axis name -> (items,) int: where each item stands on this axis."""
        if not self._indices:
            lengths = tuple(int(length) for length in self.axes.values())
            places = np.unravel_index(np.arange(self.first, self.last), lengths)
            self._indices.update(zip(self.axes, places, strict=True))
        return self._indices[axis]
