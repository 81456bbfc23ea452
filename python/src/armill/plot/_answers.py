"""The sources of the numbers of a picture.

A ``Result``, the ``Answer`` of a command, the JSON of either, or the folder that a command wrote. Values at the points of a
path are not in the JSON but in tables: a ``Result`` and a folder have them, otherwise they are given.
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Json = dict[str, Any]
Columns = dict[str, NDArray[Any]]

_ACCEPTED = "an armill.Result, an armill.Answer, the dict of their JSON, or the folder that a command wrote"


class Missing(ValueError):
    """Data that a picture needs is missing."""


class Source:
    """The JSON of an answer, and its tables."""

    def __init__(self, given: Any, picture: str, table: Any = None, file: str = "result.json") -> None:
        self.picture = picture
        self._given = given
        self._table = table
        self._folder: Path | None = None
        self.data: Json = self._read(file)

    def _read(self, file: str) -> Json:
        given: Any = self._given
        if isinstance(given, (str, os.PathLike)):
            given = Path(given)
            self._folder = given if given.is_dir() else given.parent
            path = given / file if given.is_dir() else given
            if not path.is_file():
                raise Missing(f"{self.picture}: the file {path} does not exist")
            given = json.loads(path.read_text(encoding="utf-8"))
        elif isinstance(getattr(given, "json", None), str):
            given = json.loads(given.json)
        if isinstance(given, list) and len(given) == 1:
            given = given[0]
        if isinstance(given, list):
            raise Missing(f"{self.picture}: the answer is a list of {len(given)}: give one of them")
        if not isinstance(given, dict):
            raise TypeError(f"{self.picture}: expected {_ACCEPTED}; given {type(given).__name__}")
        return given

    def need(self, key: str, command: str) -> Any:
        """The value of ``key`` in the answer; ``command`` is the command whose answer has it."""
        value = self.data.get(key)
        if value is None:
            has = ", ".join(self.data)
            raise Missing(f"{self.picture}: the answer has no `{key}`: give that of `{command}`; it has {has}")
        return value

    def one(self, kind: str, analysis: str | None) -> Json:
        """The map or path with the name ``analysis``; by default the first."""
        found: list[Json] = self.need(kind, "armill run")
        named = [each for each in found if analysis in (None, each["name"])]
        if named:
            return named[0]
        if not found:
            other = [key for key in ("maps", "paths", "volumes", "holes") if self.data.get(key)]
            available = f"; it has {', '.join(other)}" if other else ""
            raise Missing(f"{self.picture}: the answer has no {kind}{available}")
        names = ", ".join(repr(each["name"]) for each in found)
        raise Missing(f"{self.picture}: {analysis!r} is not among the {kind}: {names}")

    def has_table(self, file: str) -> bool:
        """Whether a table was given, or `file` is in the folder."""
        return self._table is not None or (self._folder is not None and (self._folder / file).is_file())

    def columns(self, analysis: str | None, needed: Sequence[str], file: str | None = None) -> Columns:
        """The table of an analysis, or ``file`` of the folder, which must have the columns ``needed``."""
        table: Any = self._table
        name = file or f"{slug(analysis or '')}.csv"
        if table is None and self._folder is not None:
            table = self._folder / name
        if table is None and file is None and callable(getattr(self._given, "table", None)):
            table = self._given.table(analysis)
        if table is None:
            raise Missing(
                f"{self.picture}: its points are not in the JSON: give the folder that the command wrote, "
                f"or table= {name}, a DataFrame or a dict of columns"
            )
        columns = read_table(table, self.picture)
        missing = [column for column in needed if column not in columns]
        if missing:
            has = ", ".join(columns)
            raise Missing(f"{self.picture}: the table has no column {', '.join(missing)}; it has {has}")
        return columns


def slug(name: str) -> str:
    """The file name of the analysis ``name``: letters and digits in lower case, all else as hyphens."""
    letters = "".join(c.lower() if c.isalnum() else " " for c in name)
    return "-".join(letters.split())


def read_table(table: Any, picture: str) -> Columns:
    """Columns by name: of a CSV file, a dict, a DataFrame or an Arrow table; empty cells are NaN."""
    if isinstance(table, (str, os.PathLike)):
        return _read_csv(Path(table), picture)
    if callable(getattr(table, "keys", None)):
        return {str(name): np.asarray(table[name]) for name in table.keys()}
    if hasattr(table, "__arrow_c_stream__"):
        try:
            import pyarrow  # type: ignore[import-untyped]
        except ImportError as error:
            raise ImportError(f"{picture}: reading a table needs pyarrow: pip install 'armill[plot]'") from error
        arrow = pyarrow.table(table)
        return {name: arrow[name].to_numpy() for name in arrow.column_names}
    raise TypeError(f"{picture}: table: expected a CSV file, a dict of columns, a DataFrame or an Arrow table")


def _read_csv(path: Path, picture: str) -> Columns:
    if not path.is_file():
        raise Missing(f"{picture}: the file {path} does not exist: write it with `--csv`, or give table=")
    with path.open(encoding="utf-8", newline="") as file:
        names, *rows = list(csv.reader(file))
    return {name: _column([row[i] for row in rows]) for i, name in enumerate(names)}


def _column(cells: list[str]) -> NDArray[Any]:
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype=object)
