"""Robots for other programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from armill._answer import Answer
from armill._commands._call import call, command
from armill._types import Path, Progress, RobotLike

if TYPE_CHECKING:
    import numpy.typing as npt


@command
def export(
    robot: RobotLike,
    *,
    format: Literal["urdf", "xacro", "ur", "dh", "sdf", "mjcf"] | None = None,
    out: Path | None = None,
    coupling: Literal["own", "mimic"] | None = None,
    stiffness: Literal["passive", "joints"] | None = None,
    joints_deg: npt.ArrayLike | None = None,
    convention: Literal["standard", "modified", "hayati"] | None = None,
    compliance_rad_per_n_m: npt.ArrayLike | None = None,
    compliance_class: Literal["light", "medium", "heavy"] | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """robot -> Answer: a robot as URDF, xacro, UR calibration, Denavit-Hartenberg table, SDF or MJCF."""
    return call("export", [robot], locals())
