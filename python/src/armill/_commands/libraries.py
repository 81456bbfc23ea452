"""The libraries, and the postures at one pose."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from armill._answer import Answer
from armill._commands._call import call, command
from armill._types import Path, Progress, RobotLike

if TYPE_CHECKING:
    import numpy.typing as npt


@command
def robots(
    robot: RobotLike | None = None,
    *,
    drawing: Path | None = None,
    bodies: bool = False,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """robot or nothing -> Answer: the robot library, or the data of one robot."""
    return call("robots", [] if robot is None else [robot], locals())


@command
def materials(
    material: str | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """material or nothing -> Answer: the material library, or the data of one material."""
    return call("materials", [] if material is None else [material], locals())


@command
def modes(
    robot: RobotLike,
    *,
    joints_deg: npt.ArrayLike,
    tool_mm: npt.ArrayLike | None = None,
    compliance_rad_per_n_m: npt.ArrayLike | None = None,
    compliance_class: Literal["light", "medium", "heavy"] | None = None,
    damping_ratio: float | None = None,
    base: str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """robot -> Answer: the modes of vibration in one posture: frequencies, directions, joints."""
    return call("modes", [robot], locals())


@command
def receptance(
    robot: RobotLike | None = None,
    *,
    assembly: Path,
    joints_deg: npt.ArrayLike | None = None,
    nose_mm: npt.ArrayLike | None = None,
    compliance_rad_per_n_m: npt.ArrayLike | None = None,
    compliance_class: Literal["light", "medium", "heavy"] | None = None,
    damping_ratio: float | None = None,
    modes: Path | None = None,
    rigid: bool = False,
    feed_deg: float | None = None,
    frequencies_hz: npt.ArrayLike | None = None,
    out: Path | None = None,
    modal_out: Path | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """robot or modal data, tool assembly -> Answer: receptance at the tip, its modes and stiffness."""
    return call("receptance", [] if robot is None else [robot], locals())


@command
def pose(
    robot: RobotLike,
    *,
    joints_deg: npt.ArrayLike | None = None,
    at_mm: npt.ArrayLike | None = None,
    tilt_deg: float | None = None,
    axis: npt.ArrayLike | None = None,
    spin_deg: float | None = None,
    home_deg: npt.ArrayLike | None = None,
    tool_mm: npt.ArrayLike | None = None,
    wrench_n: npt.ArrayLike | None = None,
    compliance_rad_per_n_m: npt.ArrayLike | None = None,
    compliance_class: Literal["light", "medium", "heavy"] | None = None,
    load_dependent: bool = False,
    reference_joints_deg: npt.ArrayLike | None = None,
    drawing: Path | None = None,
    base: str | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """robot -> Answer: all postures at one pose: joints, compliance, deviation."""
    return call("pose", [robot], locals())
