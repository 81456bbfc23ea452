"""Robots x studies: every study with every change, one row each.

An item is a study with one set of changes: keys of a study file and their values, ``{"robot": "kuka/kr120r2500pro",
"tolerance_um": 40, "tool.flange_from_tool_mm_deg": [...]}``.

===================  =================================================================================
column               contents
===================  =================================================================================
``study``            index of the study
``change``           index of the set of changes
``answer``           the answer in one sentence
``max_in_plane_um``  the largest of all maps, volumes, paths and sets of holes; null where nothing is reachable
``warnings``         number of warnings
===================  =================================================================================

and one for each of ``columns``: its place in ``result.json``, such as ``{"roundness_um": "paths.0.roundness_um"}``.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

from armill import Robot, Study
from armill._types import RobotLike, StudyLike
from armill.scale.errors import needed, refused
from armill.scale.sweep import Block, Sweep
from armill.scale.sweeps.named_files import named_files

#: In the standard library since Python 3.11.
TOML = "tomllib" if sys.version_info >= (3, 11) else "tomli"
#: Keys of the analyses in a result.
ANALYSES = ("maps", "volumes", "paths", "holes")


@dataclass(frozen=True)
class Studies:
    """Runs studies with changes."""

    texts: list[str]
    folders: list[str]
    files: list[dict[str, str]]
    changes: list[dict[str, Any]]
    columns: dict[str, str]
    #: The robot given with each study, in place of that of its text.
    robots: list[Robot | None]

    def __call__(self, block: Block) -> dict[str, Any]:
        items = zip(block["study"], block["change"], strict=True)
        rows = [self._row(int(study), int(change), block.threads) for study, change in items]
        columns: dict[str, Any] = {
            "answer": np.asarray([row["answer"] for row in rows], dtype=np.str_),
            "warnings": np.asarray([row["warnings"] for row in rows], dtype=np.int32),
        }
        for name in ("max_in_plane_um", *self.columns):
            values = [row[name] for row in rows]
            missing = [value is None for value in values]
            numbers = [0.0 if value is None else value for value in values]
            columns[name] = np.ma.masked_array(np.asarray(numbers, dtype=float), mask=missing)
        return columns

    def changed(self, study: int, change: int) -> Study:
        """A study with a set of changes."""
        table = needed(TOML, "scale").loads(self.texts[study])
        changes, robot = dict(self.changes[change]), self.robots[study]
        if "robot" in changes:
            robot = changes.pop("robot") if isinstance(changes["robot"], Robot) else None
        for key, value in changes.items():
            *above, last = key.split(".")
            place = table
            for name in above:
                place = place.setdefault(name, {})
            place[last] = value
        return Study.from_text(toml_of(table), self.folders[study], robot=robot)

    def _row(self, study: int, change: int, threads: int) -> dict[str, Any]:
        answer = self.changed(study, change).run(threads=threads).answer
        largest = [analysis.get("max_in_plane_um") for kind in ANALYSES for analysis in answer.get(kind, [])]
        row: dict[str, Any] = {
            "answer": answer["answer"],
            "warnings": len(answer["warnings"]),
            "max_in_plane_um": max((value for value in largest if value is not None), default=None),
        }
        return row | {name: _at(answer, where) for name, where in self.columns.items()}


def toml_of(table: Mapping[str, Any]) -> str:
    """table -> the same as TOML, a line for each of its keys."""
    return "".join(f"{json.dumps(key)} = {_value(value)}\n" for key, value in table.items())


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        pairs = cast("Mapping[str, Any]", value).items()
        return "{" + ", ".join(f"{json.dumps(key)} = {_value(part)}" for key, part in pairs) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value(part) for part in cast("Sequence[Any]", value)) + "]"
    if isinstance(value, np.generic):
        return _value(cast("Any", value).item())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        # JSON writes a delete as it is, which TOML does not read.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return str(value)


def _at(answer: Any, where: str) -> float | None:
    """The number at a place of the result, `paths.0.roundness_um`; None for null."""
    found: Any = answer
    for name in where.split("."):
        try:
            found = found[int(name) if isinstance(found, list) else name]
        except (KeyError, IndexError, ValueError, TypeError):
            raise ValueError(f"the result has no `{where}`") from None
    if found is not None and (isinstance(found, bool) or not isinstance(found, (int, float))):
        raise ValueError(f"`{where}` of the result is not a number")
    return found


def studies(
    studies: Sequence[StudyLike],
    changes: Sequence[Mapping[str, Any]] = ({},),
    *,
    robots: Sequence[RobotLike] | None = None,
    columns: Mapping[str, str] | None = None,
) -> Sweep:
    """studies, changes -> Sweep: each study with each set of changes; ``robots`` are changes of the robot only.

    The value of the change ``robot`` is a ``Robot``, a name or a path.
    Every worker must have access to named robot files and to the files of the studies.
    """
    found = [study if isinstance(study, Study) else Study.load(study) for study in studies]
    if not found:
        raise refused("there is no study", "give at least one")
    sets = [dict(change) for change in changes]
    if robots is not None:
        named = [robot if isinstance(robot, Robot) else str(robot) for robot in robots]
        sets = [{**change, "robot": robot} for robot in named for change in sets]
    if not sets:
        raise refused("there is no set of changes", "use {} for an unchanged study")
    texts = [study.text for study in found]
    folders = [str(Path(study.folder).absolute()) for study in found]
    given = [study.robot for study in found]
    work = Studies(texts, folders, [], sets, dict(columns or {}), given)
    # Every study with every change is checked before the first of them runs.
    lengths = {"study": len(found), "change": len(sets)}
    files: list[dict[str, str]] = []
    for study in range(len(found)):
        for change in range(len(sets)):
            changed = work.changed(study, change)
            changed.check()
            files.append(named_files(changed))
    return Sweep(lengths, Studies(texts, folders, files, sets, work.columns, given))
