"""The answer of a command."""

from __future__ import annotations

import json as _json
from typing import Any, cast


class Answer:
    """The answer of a command, by key (``answer["postures"]``) or by name (``answer.postures``).

    ``json`` is the text that the command prints with ``--json``, final newline included; ``data`` the same as values;
    ``messages`` the lines that the command prints on stderr; ``within_tolerance`` is False if ``strict=True`` is given and
    the tolerance is exceeded.
    """

    def __init__(self, json: str, messages: list[str], within_tolerance: bool) -> None:
        self.json = json
        self.messages = messages
        self.within_tolerance = within_tolerance
        self._data: Any = None

    @property
    def data(self) -> Any:
        """-> dict or list: the answer as values."""
        if self._data is None:
            self._data = _json.loads(self.json)
        return self._data

    def __getitem__(self, key: str | int) -> Any:
        return self.data[key]

    def _keys(self) -> list[str]:
        data = self.data
        return list(cast("dict[str, Any]", data)) if isinstance(data, dict) else []

    def __getattr__(self, name: str) -> Any:
        # Names that Python itself looks up, such as `__deepcopy__`, are never keys.
        if not name.startswith("_") and name in self._keys():
            return self.data[name]
        raise AttributeError(f"the answer has no `{name}`: see `answer.data`")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._keys()]

    def __repr__(self) -> str:
        return f"<armill.Answer: {', '.join(self._keys()) or f'{len(self.data)} rows'}>"
