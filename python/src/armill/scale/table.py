"""The rows of a part: the axes, then the columns of the work.

Numbers are finite; missing values are masked (``numpy.ma``), and null in the file.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from armill.scale.errors import needed
from armill.scale.sweep import Block, Sweep

#: Kinds of numpy for columns: booleans, integers, floats, texts.
KINDS = "biufU"


def table_of(sweep: Sweep, first: int, last: int, threads: int) -> Any:
    """items -> pyarrow.Table: the columns of the work. Raises what the work raises; ValueError for invalid columns."""
    arrow = needed("pyarrow", "scale")
    block = sweep.block(first, last, threads)
    given = sweep.work(block)
    columns = {name: _column(name, values, block) for name, values in given.items()}
    lengths = {len(values) for values in columns.values()}
    if not columns or len(lengths) != 1:
        given_lengths = ", ".join(f"{name} {len(values)}" for name, values in columns.items())
        raise ValueError(f"expected columns of one length, given {given_lengths or 'none'}")
    rows = lengths.pop()
    if rows == 0 or rows % len(block):
        raise ValueError(f"{rows} rows are not a multiple of {len(block)} items")
    own = set(columns) & set(sweep.axes)
    if own:
        raise ValueError(f"columns have the names of axes: {', '.join(sorted(own))}")
    axes = {name: np.repeat(block[name], rows // len(block)) for name in sweep.axes}
    arrays = {name: arrow.array(values.astype(_index_kind(sweep.axes[name]))) for name, values in axes.items()}
    for name, values in columns.items():
        masked = np.ma.getmaskarray(values) if np.ma.isMaskedArray(values) else None
        arrays[name] = arrow.array(np.ma.getdata(values), mask=masked)
    return arrow.table(arrays)


def _index_kind(length: int) -> str:
    return "int32" if length < 2**31 else "int64"


def _column(name: str, values: Any, block: Block) -> Any:
    column = np.asanyarray(values)
    if column.ndim != 1:
        raise ValueError(f"column `{name}` has the shape {column.shape}: expected one number or text per row")
    if column.dtype.kind not in KINDS:
        raise ValueError(f"column `{name}` has the type {column.dtype}: expected numbers, texts or booleans")
    if column.dtype.kind == "f":
        bad = ~np.isfinite(np.ma.getdata(column)) & ~np.ma.getmaskarray(column)
        if bad.any():
            row = int(np.argmax(bad))
            item = block.first + row * len(block) // len(column)
            raise ValueError(f"column `{name}` is {np.ma.getdata(column)[row]} at item {item}: mask what is missing")
    return column
