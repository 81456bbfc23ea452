"""Tables in memory as the CSV files that commands read."""

from __future__ import annotations

import csv
import importlib
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast

from armill import _armill


def is_table(value: object) -> bool:
    """Whether a value is a table in memory: by columns, or with the interface of Arrow."""
    return isinstance(value, Mapping) or hasattr(value, "__arrow_c_stream__")


class TableFiles:
    """Temporary CSV files of tables, for as long as the context lasts."""

    def __enter__(self) -> TableFiles:
        self._folder = TemporaryDirectory(prefix="armill-")
        self._count = 0
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def of(self, values: Sequence[Any]) -> list[Any]:
        """values -> the same with the path of a file in place of each table: `table-1.csv`, `table-2.csv`, ..."""
        return [self._path(value) if is_table(value) else value for value in values]

    def without_folder(self, text: Any) -> Any:
        """A text of a command with the names of these files in place of their paths; any other value as it is."""
        return text.replace(f"{self._folder.name}{os.sep}", "") if isinstance(text, str) else text

    def _path(self, table: Any) -> Path:
        self._count += 1
        path = Path(self._folder.name) / f"table-{self._count}.csv"
        write(table, path)
        return path


def write(table: Any, path: Path | os.PathLike[str]) -> None:
    """Writes a table with all digits; cells of missing values are empty."""
    columns = _columns(table)
    lengths = {name: len(values) for name, values in columns.items()}
    if not columns or len(set(lengths.values())) != 1:
        given = ", ".join(f"{name} {length}" for name, length in lengths.items()) or "none"
        raise ValueError(f"a table has columns of one length, given {given}")
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([_cell(value) for value in row] for row in zip(*columns.values(), strict=True))


def _columns(table: Any) -> dict[str, list[Any]]:
    """The values of a table by column."""
    if isinstance(table, Mapping):
        given = cast("Mapping[str, Any]", table)
        return {str(name): _values(str(name), values) for name, values in given.items()}
    if isinstance(table, _armill.Table) or (hasattr(table, "columns") and hasattr(table, "to_numpy")):
        # pandas and polars.
        return {str(name): _values(str(name), table[name]) for name in table.columns}
    arrow = importlib.import_module("pyarrow")
    return cast("dict[str, list[Any]]", arrow.table(table).to_pydict())


def _values(name: str, values: Any) -> list[Any]:
    # The import of armill does not load numpy.
    import numpy as np

    array = np.ma.asanyarray(values) if np.ma.isMaskedArray(values) else np.asarray(values)
    if array.ndim != 1:
        raise ValueError(f"column `{name}` has the shape {array.shape}: expected (rows,)")
    return cast("list[Any]", array.tolist())


def _cell(value: Any) -> str:
    """A value as text: empty for None, NaN and the missing values of pandas."""
    if value is None or value != value or type(value).__name__ in ("NAType", "NaTType"):
        return ""
    return str(value)
