"""Placements x points x cases: what a path costs wherever its part lies.

An item is a place. Places are told one by one, or by values for some of the degrees, all combinations of which are taken:
the axes are then those degrees, in the order that they are given. What is not given stays as the study has it.

=======================  =================================================================================
column                   what it is
=======================  =================================================================================
``x_mm`` ... ``rail_mm`` the place, as ``[place]`` of a study has it
``unreachable_points``          points that the best branch does not hold inside limits and margin
``cost_um``              what is to be least, of the points that it holds; null where it holds none
``branch``               that branch; empty of an arm whose branches have no names, and of holes
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

#: The degrees of a place, in SI, and what one is multiplied with in a column.
DEGREES = ("x", "y", "z", "heading", "tilt", "roll", "spin", "rail")
LENGTHS = ("x", "y", "z", "rail")
MM = 1e3
UM = 1e6


@dataclass(frozen=True)
class Placements:
    """What places are worth. ``values`` has those of each degree that is an axis; ``drawn`` is where the study has the part."""

    study: Study
    files: dict[str, str]
    ask: str | None
    drawn: NDArray[np.float64]
    values: dict[str, NDArray[np.float64]]
    places: NDArray[np.float64] | None

    def __call__(self, block: Block) -> dict[str, Any]:
        places = self.at(block)
        judged = self.study.judge(places, ask=self.ask, threads=block.threads)
        columns: dict[str, Any] = {
            f"{degree}_mm" if degree in LENGTHS else f"{degree}_deg": _told(degree, numbers)
            for degree, numbers in zip(DEGREES, places.T, strict=False)
        }
        lost = judged.lost
        cost = np.ma.masked_array(judged.cost * UM, mask=lost == judged.point_count)
        branch = np.asarray(judged.branch, dtype=np.str_)
        return columns | {"unreachable_points": lost, "cost_um": cost, "branch": branch}

    def at(self, block: Block) -> NDArray[np.float64]:
        """The places of a block."""
        if self.places is not None:
            return self.places[block["place"]]
        places = np.tile(self.drawn, (len(block), 1))
        for degree, values in self.values.items():
            places[:, DEGREES.index(degree)] = values[block[f"{degree}_index"]]
        return places


def _told(degree: str, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    return numbers * MM if degree in LENGTHS else np.degrees(numbers)


def placements(study: Study | str | Path, places: ArrayLike | None = None, *, ask: str | None = None, **axes: ArrayLike) -> Sweep:
    """study, (n, 6) places or values by degree -> Sweep: what its path costs at each place.

    Places are as ``Study.judge`` takes them, (n, 6) to (n, 8), m and rad. Or give values of ``x``, ``y``, ``z``, ``heading``,
    ``tilt``, ``roll``, ``spin`` and ``rail``, one array each: ``placements(study, x=np.linspace(0.7, 1.1, 81), spin=...)``.
    """
    found = study if isinstance(study, Study) else Study.load(study)
    # A worker stands in another folder.
    found = Study.from_text(found.text, Path(found.folder).absolute())
    drawn = found.drawn_place(ask)
    unknown = sorted(set(axes) - set(DEGREES))
    if unknown:
        raise refused(f"a place has no degree `{unknown[0]}`", f"those of a place are {', '.join(DEGREES)}")
    if (places is None) == (not axes):
        raise refused("places are told twice or not at all", "give places, or values of x, y, z, ...: either")
    values = {degree: _values(degree, numbers, drawn) for degree, numbers in axes.items()}
    given = None if places is None else np.atleast_2d(np.asarray(places, dtype=float))
    work = Placements(found, named_files(found), ask, drawn, values, given)
    # The first place shows whether the others can be judged, and how many points and cases there are.
    lengths = {"place": len(given)} if given is not None else {f"{degree}_index": len(array) for degree, array in values.items()}
    sweep = Sweep(lengths, work)
    first = found.judge(work.at(sweep.block(0, 1)), ask=ask)
    return Sweep(lengths, work, evaluations_per_item=first.point_count * first.case_count)


def _values(degree: str, numbers: ArrayLike, drawn: NDArray[np.float64]) -> NDArray[np.float64]:
    array = np.atleast_1d(np.asarray(numbers, dtype=float))
    if array.ndim != 1 or not array.size or not np.isfinite(array).all():
        raise refused(f"{degree}: expected finite numbers of shape (n,), given {array.shape}", "m for lengths, rad for angles")
    if DEGREES.index(degree) >= len(drawn):
        raise refused("the robot of this study stands on no rail", "leave `rail` out")
    return array
