"""What studies are used for: placement, posture, compensation, comparison."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from armill._answer import Answer
from armill._commands._call import call, command
from armill._types import Component, Objective, Path, Progress, RankBy, RobotLike, StudyLike

if TYPE_CHECKING:
    import numpy.typing as npt


@command
def posture(
    study: StudyLike,
    *,
    out: Path | None = None,
    no_pictures: bool = False,
    csv: bool = False,
    strict: bool = False,
    force: bool = False,
    objective: Objective | None = None,
    component: Component | None = None,
    turns_deg: npt.ArrayLike | None = None,
    step_deg: float | None = None,
    turn_deg_per_mm: float | None = None,
    least_wrist_deg: float | None = None,
    margin_deg: float | None = None,
    reversal_um_mm: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: the best spin of the tool and branch along the paths of a study."""
    return call("posture", [study], locals())


@command
def stability(
    study: StudyLike | None = None,
    *,
    material: str | None = None,
    cutter_diameter_mm: float | None = None,
    teeth: int | None = None,
    helix_deg: float | None = None,
    corner_radius_mm: float | None = None,
    side: str | None = None,
    radial_mm: float | None = None,
    modes: Path | None = None,
    joints_deg: npt.ArrayLike | None = None,
    point: int | None = None,
    path: str | None = None,
    spindle_rpm: float | None = None,
    feed_mm_per_min: float | None = None,
    depth_mm: float | None = None,
    speeds_rpm: npt.ArrayLike | None = None,
    deepest_mm: float | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study or cut, modal data -> Answer: stability of the cut against chatter: lobes, limits of the depth, vibration."""
    return call("stability", [] if study is None else [study], locals())


@command
def place(
    study: StudyLike,
    *,
    out: Path | None = None,
    no_pictures: bool = False,
    csv: bool = False,
    strict: bool = False,
    force: bool = False,
    analysis: str | None = None,
    x_mm: npt.ArrayLike | None = None,
    y_mm: npt.ArrayLike | None = None,
    z_mm: npt.ArrayLike | None = None,
    heading_deg: npt.ArrayLike | None = None,
    tilt_deg: npt.ArrayLike | None = None,
    roll_deg: npt.ArrayLike | None = None,
    spin_deg: npt.ArrayLike | None = None,
    rail_mm: npt.ArrayLike | None = None,
    branch: str | None = None,
    objective: Objective | None = None,
    component: Component | None = None,
    margin_deg: float | None = None,
    rank_by: RankBy | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: the placement of the part with the smallest deviation of a path."""
    return call("place", [study], locals())


@command
def advise(
    study: StudyLike,
    *,
    out: Path | None = None,
    no_pictures: bool = False,
    csv: bool = False,
    strict: bool = False,
    force: bool = False,
    analysis: str | None = None,
    x_mm: npt.ArrayLike | None = None,
    y_mm: npt.ArrayLike | None = None,
    z_mm: npt.ArrayLike | None = None,
    heading_deg: npt.ArrayLike | None = None,
    tilt_deg: npt.ArrayLike | None = None,
    roll_deg: npt.ArrayLike | None = None,
    spin_deg: npt.ArrayLike | None = None,
    rail_mm: npt.ArrayLike | None = None,
    branch: str | None = None,
    objective: Objective | None = None,
    component: Component | None = None,
    margin_deg: float | None = None,
    rank_by: RankBy | None = None,
    seed: int | None = None,
    program: Path | None = None,
    frame: int | None = None,
    tool: int | None = None,
    within_um: float | None = None,
    retract_mm: float | None = None,
    blend_mm: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: measures to bring a path within its tolerance."""
    return call("advise", [study], locals())


@command
def compare(
    *studies: StudyLike,
    robot: RobotLike | Sequence[RobotLike] | None = None,
    given_placement: bool = False,
    out: Path | None = None,
    no_pictures: bool = False,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """studies -> Answer: the same path in several robot cells, compared."""
    return call("compare", studies, locals())


@command
def compensate(
    study: StudyLike,
    *,
    analysis: str | None = None,
    out: Path | None = None,
    nominal: bool = False,
    surface: bool = False,
    program: Path | None = None,
    frame: int | None = None,
    tool: int | None = None,
    within_um: float | None = None,
    retract_mm: float | None = None,
    blend_mm: float | None = None,
    feed_mm_per_min: float | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: compensated paths, on which the tool follows the nominal path."""
    return call("compensate", [study], locals())


@command
def backlash(
    study: StudyLike,
    *,
    lobes: int | None = None,
    noise_um: float | None = None,
    circles: int | None = None,
    within_mm: npt.ArrayLike | None = None,
    radii_mm: npt.ArrayLike | None = None,
    simulate: Path | None = None,
    runs: int | None = None,
    seed: int | None = None,
    analysis: str | Sequence[str] | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: backlash of each joint from ball-bar tests; the best test circles; synthetic tests."""
    return call("backlash", [study], locals())


@command
def budget(
    study: StudyLike,
    *,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """study -> Answer: the error budget of a measured circle, and the predicted part of it."""
    return call("budget", [study], locals())
