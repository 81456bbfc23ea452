"""Placements x points x load cases: the cost of a path for many placements of its part.

An item is a placement. Placements are given one by one, or by values of some coordinates, of which all combinations are
evaluated: the axes are then these coordinates, in the given order. The other coordinates are those of the study. Coordinates
have the names and units of the columns.

=======================  =================================================================================
column                   contents
=======================  =================================================================================
``x_mm`` ... ``rail_mm`` the placement, in the coordinates of ``[place]`` of a study
``unreachable_points``   points that the best branch does not reach inside limits and margin
``cost_um``              objective over the reachable points; null where none is reachable
``branch``               the best branch; empty for an arm without named branches, and for holes
=======================  =================================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armill import Study
from armill._types import StudyLike
from armill.scale.errors import refused
from armill.scale.sweep import Block, Sweep
from armill.scale.sweeps.named_files import named_files

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: The coordinates of a placement, in the order of ``Study.evaluate_placements``, which has them in m and rad.
COORDINATES = ("x_mm", "y_mm", "z_mm", "heading_deg", "tilt_deg", "roll_deg", "spin_deg", "rail_mm")
MM = 1e3
UM = 1e6


class Axes(TypedDict, total=False):
    """Values of coordinates."""

    x_mm: ArrayLike
    y_mm: ArrayLike
    z_mm: ArrayLike
    heading_deg: ArrayLike
    tilt_deg: ArrayLike
    roll_deg: ArrayLike
    spin_deg: ArrayLike
    rail_mm: ArrayLike


@dataclass(frozen=True)
class Placements:
    """Evaluates placements. ``values`` has the values of each axis; ``nominal`` is the placement of the study."""

    study: Study
    files: dict[str, str]
    analysis: str | None
    nominal: NDArray[np.float64]
    values: dict[str, NDArray[np.float64]]
    places: NDArray[np.float64] | None

    def __call__(self, block: Block) -> dict[str, Any]:
        places = self.at(block)
        scores = self.study.evaluate_placements(places, analysis=self.analysis, threads=block.threads)
        columns: dict[str, Any] = {
            coordinate: numbers * MM if coordinate.endswith("_mm") else np.degrees(numbers)
            for coordinate, numbers in zip(COORDINATES, places.T, strict=False)
        }
        unreachable = scores.n_unreachable
        cost = np.ma.masked_array(scores.cost_of_reachable * UM, mask=unreachable == scores.point_count)
        branch = np.asarray(scores.branch, dtype=np.str_)
        return columns | {"unreachable_points": unreachable, "cost_um": cost, "branch": branch}

    def at(self, block: Block) -> NDArray[np.float64]:
        """The placements of a block."""
        if self.places is not None:
            return self.places[block["place"]]
        places = np.tile(self.nominal, (len(block), 1))
        for coordinate, values in self.values.items():
            places[:, COORDINATES.index(coordinate)] = values[block[_index(coordinate)]]
        return places


def _index(coordinate: str) -> str:
    """The axis of a coordinate: `x_index` of `x_mm`."""
    return f"{coordinate.rpartition('_')[0]}_index"


def placements(
    study: StudyLike, places: ArrayLike | None = None, *, analysis: str | None = None, **axes: Unpack[Axes]
) -> Sweep:
    """study, (n, 6) places or values by coordinate -> Sweep: the cost of its path for each placement.

    ``places`` are those of ``Study.evaluate_placements``, (n, 6) to (n, 8), m and rad. Or give values of ``x_mm``, ``y_mm``,
    ``z_mm``, ``heading_deg``, ``tilt_deg``, ``roll_deg``, ``spin_deg`` and ``rail_mm``, one array each, in the unit of the
    name: ``placements(study, x_mm=np.linspace(700, 1100, 81))``.
    """
    found = study if isinstance(study, Study) else Study.load(study)
    # A worker may have another working directory.
    found = Study.from_text(found.text, Path(found.folder).absolute(), robot=found.robot)
    nominal = found.nominal_placement(analysis)
    unknown = sorted(set(axes) - set(COORDINATES))
    if unknown:
        named = [coordinate for coordinate in COORDINATES if coordinate.rpartition("_")[0] == unknown[0]]
        hint = f"`{named[0]}`, in the unit of its name" if named else f"the coordinates are {', '.join(COORDINATES)}"
        raise refused(f"a placement has no coordinate `{unknown[0]}`", hint)
    if (places is None) == (not axes):
        raise refused("places are given twice or not at all", "give either places, or values of x_mm, y_mm, z_mm, ...")
    given_axes: dict[str, Any] = dict(axes)
    values = {coordinate: _values(coordinate, numbers, nominal) for coordinate, numbers in given_axes.items()}
    given = None if places is None else np.atleast_2d(np.asarray(places, dtype=float))
    work = Placements(found, named_files(found), analysis, nominal, values, given)
    # Check the options with the first placement, which also gives the number of points and cases.
    lengths = {"place": len(given)} if given is not None else {_index(name): len(array) for name, array in values.items()}
    sweep = Sweep(lengths, work)
    first = found.evaluate_placements(work.at(sweep.block(0, 1)), analysis=analysis)
    return Sweep(lengths, work, evaluations_per_item=first.point_count * first.case_count)


def _values(coordinate: str, numbers: ArrayLike, nominal: NDArray[np.float64]) -> NDArray[np.float64]:
    """The values of a coordinate, m and rad."""
    array = np.atleast_1d(np.asarray(numbers, dtype=float))
    if array.ndim != 1 or not array.size or not np.isfinite(array).all():
        raise refused(f"{coordinate}: expected finite numbers of shape (n,), given {array.shape}", "one for each placement")
    if COORDINATES.index(coordinate) >= len(nominal):
        raise refused("the robot of this study is not on a rail", f"omit `{coordinate}`")
    return array / MM if coordinate.endswith("_mm") else np.radians(array)
