"""The answer of a command."""

from __future__ import annotations

import json as _json
from collections.abc import ItemsView, Iterator, KeysView, ValuesView
from html import escape as _escape
from typing import Any, Literal, cast

from armill._armill import Robot, Samples

#: Characters of a value that a notebook shows.
_SHOWN = 200


class Answer:
    """The answer of a command, by key (``answer["postures"]``) or by name (``answer.postures``).

    It behaves as the dict or list that ``data`` is: ``list(answer)``, ``"postures" in answer``, ``len(answer)``,
    ``dict(answer)``.

    ``json`` is the text that the command prints with ``--json``, final newline included; ``data`` the same as values;
    ``messages`` the lines that the command prints on stderr; ``within_tolerance`` is False if ``strict=True`` is given and
    the tolerance is exceeded; ``robot_file`` is the path of the robot file that the command wrote, if it wrote one.
    """

    def __init__(self, json: str, messages: list[str], within_tolerance: bool, robot_file: str | None = None) -> None:
        self.json = json
        self.messages = messages
        self.within_tolerance = within_tolerance
        self.robot_file = robot_file
        self._data: Any = None

    @property
    def data(self) -> Any:
        """-> dict or list: the answer as values."""
        if self._data is None:
            self._data = _json.loads(self.json)
        return self._data

    def __getitem__(self, key: str | int) -> Any:
        return self.data[key]

    def __iter__(self) -> Iterator[Any]:
        return iter(self.data)

    def __contains__(self, key: object) -> bool:
        return key in self.data

    def __len__(self) -> int:
        return len(self.data)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Answer) and self.json == other.json

    def __hash__(self) -> int:
        return hash(self.json)

    def keys(self) -> KeysView[str]:
        """-> the keys of the answer, none of a list."""
        return self._dict().keys()

    def values(self) -> ValuesView[Any]:
        """-> the values of the answer, none of a list."""
        return self._dict().values()

    def items(self) -> ItemsView[str, Any]:
        """-> keys with values of the answer, none of a list."""
        return self._dict().items()

    def get(self, key: str, default: Any = None) -> Any:
        """key -> its value, or ``default`` where there is none."""
        return self._dict().get(key, default)

    def updated_robot(self) -> Robot:
        """-> Robot: with what was found, read from the file that the command wrote: give ``out=`` in the call."""
        if self.robot_file is None:
            raise ValueError('the command wrote no robot file: give out="robot.toml" to identify, calibrate, learn, journal, drives or motion')
        return Robot.load(self.robot_file)

    def samples(self, n: int, method: Literal["sobol", "random"] = "sobol", *, seed: int = 0) -> Samples:
        """n -> Samples: robots as probable as the measurements make them, of the values found and their covariance.

        Those of ``updated_robot().sample(n)``: compliances, geometry, backlash and model error, as far as the command finds them.
        """
        return self.updated_robot().sample(n, method, seed=seed)

    def _dict(self) -> dict[str, Any]:
        return cast("dict[str, Any]", self.data) if isinstance(self.data, dict) else {}

    def __getattr__(self, name: str) -> Any:
        # Names that Python itself looks up, such as `__deepcopy__`, are never keys.
        if not name.startswith("_") and name in self._dict():
            return self.data[name]
        raise AttributeError(f"the answer has no `{name}`: see `answer.data`")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._dict()]

    def __repr__(self) -> str:
        return f"<armill.Answer: {', '.join(self._dict()) or f'{len(self.data)} rows'}>"

    def _repr_html_(self) -> str:
        pairs = self._dict().items() or ((str(number), row) for number, row in enumerate(self.data))
        rows = ((key, _json.dumps(value, ensure_ascii=False)) for key, value in pairs)
        short = ((key, text if len(text) <= _SHOWN else f"{text[:_SHOWN]} ...") for key, text in rows)
        body = "".join(f"<tr><th>{_escape(key)}</th><td>{_escape(text)}</td></tr>" for key, text in short)
        return f"<table>{body}</table>"
