"""Placements x points x load cases: the cost of a path for many placements of its part.

An item is a placement. Placements are given one by one, or by values of some coordinates, of which all combinations are
evaluated: the axes are then these coordinates, in the given order. The other coordinates are those of the study.

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
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armill import Study
from armill.scale.errors import refused
from armill.scale.sweep import Block, Sweep
from armill.scale.sweeps.named_files import named_files

#: The coordinates of a placement, in SI, and the factors of columns.
DEGREES = ("x", "y", "z", "heading", "tilt", "roll", "spin", "rail")
LENGTHS = ("x", "y", "z", "rail")
MM = 1e3
UM = 1e6


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
            f"{degree}_mm" if degree in LENGTHS else f"{degree}_deg": _scaled(degree, numbers)
            for degree, numbers in zip(DEGREES, places.T, strict=False)
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
        for degree, values in self.values.items():
            places[:, DEGREES.index(degree)] = values[block[f"{degree}_index"]]
        return places


def _scaled(degree: str, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    return numbers * MM if degree in LENGTHS else np.degrees(numbers)


def placements(study: Study | str | Path, places: ArrayLike | None = None, *, analysis: str | None = None, **axes: ArrayLike) -> Sweep:
    """study, (n, 6) places or values by coordinate -> Sweep: the cost of its path for each placement.

    ``places`` are those of ``Study.evaluate_placements``, (n, 6) to (n, 8), m and rad. Or give values of ``x``, ``y``, ``z``,
    ``heading``, ``tilt``, ``roll``, ``spin`` and ``rail``, one array each: ``placements(study, x=np.linspace(0.7, 1.1, 81))``.
    """
    found = study if isinstance(study, Study) else Study.load(study)
    # A worker may have another working directory.
    found = Study.from_text(found.text, Path(found.folder).absolute())
    nominal = found.nominal_placement(analysis)
    unknown = sorted(set(axes) - set(DEGREES))
    if unknown:
        raise refused(f"a placement has no coordinate `{unknown[0]}`", f"the coordinates are {', '.join(DEGREES)}")
    if (places is None) == (not axes):
        raise refused("places are given twice or not at all", "give either places, or values of x, y, z, ...")
    values = {degree: _values(degree, numbers, nominal) for degree, numbers in axes.items()}
    given = None if places is None else np.atleast_2d(np.asarray(places, dtype=float))
    work = Placements(found, named_files(found), analysis, nominal, values, given)
    # Check the options with the first placement, which also gives the number of points and cases.
    lengths = {"place": len(given)} if given is not None else {f"{degree}_index": len(array) for degree, array in values.items()}
    sweep = Sweep(lengths, work)
    first = found.evaluate_placements(work.at(sweep.block(0, 1)), analysis=analysis)
    return Sweep(lengths, work, evaluations_per_item=first.point_count * first.case_count)


def _values(degree: str, numbers: ArrayLike, nominal: NDArray[np.float64]) -> NDArray[np.float64]:
    array = np.atleast_1d(np.asarray(numbers, dtype=float))
    if array.ndim != 1 or not array.size or not np.isfinite(array).all():
        raise refused(f"{degree}: expected finite numbers of shape (n,), given {array.shape}", "m for lengths, rad for angles")
    if DEGREES.index(degree) >= len(nominal):
        raise refused("the robot of this study is not on a rail", "omit `rail`")
    return array
