"""What a command answers."""

from __future__ import annotations

import json as _json
from typing import Any, cast


class Answer:
    """What a command answers, by key (``answer["postures"]``) or by name (``answer.postures``).

    ``json`` is the very text that the command prints with ``--json``, the last line end included; ``data`` the same as
    values; ``talk`` what it says beside it, line by line; ``holds`` whether the tolerance is held, where ``strict=True``
    asked.
    """

    def __init__(self, json: str, talk: list[str], holds: bool) -> None:
        self.json = json
        self.talk = talk
        self.holds = holds
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
        # What Python itself asks for, such as `__deepcopy__`, is never a key.
        if not name.startswith("_") and name in self._keys():
            return self.data[name]
        raise AttributeError(f"the answer has no `{name}`: see `answer.data`")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._keys()]

    def __repr__(self) -> str:
        return f"<armill.Answer: {', '.join(self._keys()) or f'{len(self.data)} rows'}>"
