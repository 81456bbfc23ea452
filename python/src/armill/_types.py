"""Types of arguments, for type checkers."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

from armill._armill import Robot, Study

if TYPE_CHECKING:
    # The import of armill does not load numpy.
    import numpy.typing as npt

Path: TypeAlias = str | os.PathLike[str]
#: A robot, its name in the library, or the path of a robot file.
RobotLike: TypeAlias = Robot | Path
#: A study, its folder or file, or the name of an example study.
StudyLike: TypeAlias = Study | Path
#: Called with the number of points finished.
Progress: TypeAlias = Callable[[int], object]

#: A branch, or words of it: those that are left out are those of the nominal branch.
Branch: TypeAlias = Literal[
    "nominal",
    "best",
    "front elbow-up no-flip",
    "front elbow-up flip",
    "front elbow-down no-flip",
    "front elbow-down flip",
    "back elbow-up no-flip",
    "back elbow-up flip",
    "back elbow-down no-flip",
    "back elbow-down flip",
    "front elbow-up",
    "front elbow-down",
    "back elbow-up",
    "back elbow-down",
    "front no-flip",
    "front flip",
    "back no-flip",
    "back flip",
    "elbow-up no-flip",
    "elbow-up flip",
    "elbow-down no-flip",
    "elbow-down flip",
    "front",
    "back",
    "elbow-up",
    "elbow-down",
    "no-flip",
    "flip",
]
Objective: TypeAlias = Literal["worst", "mean", "above-tolerance"]
Component: TypeAlias = Literal["in-plane", "cross-track", "axial"]
RankBy: TypeAlias = Literal["nominal", "plus-two-sigma", "within-tolerance"]
TurnOrder: TypeAlias = Literal["fixed-xyz", "moving-xyz"]


class ArrowStream(Protocol):
    """A table with the interface of Arrow: of pandas, polars, pyarrow, duckdb, armill."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...


#: The path of a table, a data frame, an Arrow table, or arrays by column name.
TableLike: TypeAlias = "Path | ArrowStream | Mapping[str, npt.ArrayLike]"


class SE3(Protocol):
    """Poses of spatialmath."""

    @property
    def A(self) -> Any: ...


class Transform(Protocol):
    """Rotations or transforms of scipy."""

    def as_matrix(self) -> Any: ...


#: Matrices (..., 4, 4), poses of spatialmath, transforms of scipy, or a pair of rotations of scipy and translations.
Poses: TypeAlias = "npt.ArrayLike | SE3 | Transform | tuple[Transform, npt.ArrayLike]"
