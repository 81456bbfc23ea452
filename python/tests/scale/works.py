"""Work for sweeps of the tests: quick, slow, and failing."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armill.scale import Block, Sweep


@dataclass(frozen=True)
class Waves:
    """Sines over two axes; takes ``seconds`` per block."""

    scale: NDArray[np.float64]
    seconds: float = 0.0

    def __call__(self, block: Block) -> dict[str, object]:
        time.sleep(self.seconds)
        at = self.scale[block["row"]] + 0.1 * block["column"]
        missing = np.ma.masked_array(np.sqrt(np.abs(at)), mask=at < 0)
        return {"height_um": np.sin(at), "root_um": missing, "name": np.char.add("r", block["row"].astype(str))}


def waves(rows: int = 40, columns: int = 25, seconds: float = 0.0) -> Sweep:
    """1000 items; parts of 50 of them make 20."""
    return Sweep({"row": rows, "column": columns}, Waves(np.linspace(-3, 7, rows), seconds), evaluations_per_item=3)


@dataclass(frozen=True)
class Deadly:
    """Kills its own process at one item, so often as the file has no line for it."""

    item: int
    times: int
    diary: Path

    def __call__(self, block: Block) -> dict[str, object]:
        if block.first <= self.item < block.last:
            died = len(self.diary.read_text()) if self.diary.exists() else 0
            if died < self.times:
                with self.diary.open("a") as file:
                    file.write("x")
                    file.flush()
                    os.fsync(file.fileno())
                os.kill(os.getpid(), 9)
        return {"value": block["i"] ** 2}


@dataclass(frozen=True)
class DeadlyWriter:
    """Has its own process killed while it writes the part with one item, the first time."""

    item: int
    diary: Path

    def __call__(self, block: Block) -> dict[str, object]:
        if block.first <= self.item < block.last and not self.diary.exists():
            self.diary.touch()
            # The bytes are in the file, which has not got its name yet.
            os.fsync = lambda _: os.kill(os.getpid(), 9)
        return {"value": block["i"] ** 2}


def refuses(block: Block) -> dict[str, object]:
    """Fails at item 77."""
    if block.first <= 77 < block.last:
        raise ValueError("joint 3 at 151.2 deg exceeds its limit of 150.0 deg")
    return {"value": block["i"]}


def squares(block: Block) -> dict[str, object]:
    """Two rows per item."""
    value = np.repeat(block["i"], 2).astype(float)
    value[1::2] *= -1
    return {"value": value}
