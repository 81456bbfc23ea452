"""What measurements give: compliances, geometry, forces, accuracy, roundness."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal

from armill._answer import Answer
from armill._commands._call import call, command
from armill._types import Path, Progress, RobotLike, StudyLike, TableLike, TurnOrder

if TYPE_CHECKING:
    import numpy.typing as npt


@command
def identify(
    tests: TableLike | None = None,
    *,
    robot: RobotLike,
    unknowns: str | None = None,
    points: Literal["known", "common", "separate"] | None = None,
    point_u_mm: float | None = None,
    prior: Literal["typical", "none"] | None = None,
    tool_mm: npt.ArrayLike | None = None,
    out: Path | None = None,
    plan: int | None = None,
    pull_n: float | None = None,
    gauge_um: float | None = None,
    trust_units: bool = False,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """table of load tests -> Answer: joint compliances; with ``plan`` and no table, a plan of load tests."""
    return call("identify", [] if tests is None else [tests], locals())


@command
def calibrate(
    file: TableLike,
    *,
    robot: RobotLike,
    unknowns: Literal["geometry", "zeros"] | None = None,
    validation: TableLike | float | None = None,
    same_set_up: bool = False,
    prior_mm: float | None = None,
    prior_deg: float | None = None,
    columns: Mapping[str, str] | str | None = None,
    turns: bool = False,
    turn_order: TurnOrder | None = None,
    turn_mm: float | None = None,
    tool_mm: npt.ArrayLike | None = None,
    out: Path | None = None,
    residuals: Path | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """table of measured poses -> Answer: calibrated lengths, angles and joint zeros of the arm."""
    return call("calibrate", [file], locals())


@command
def learn(
    poses_file: TableLike,
    *,
    robot: RobotLike,
    unknowns: Literal["geometry", "zeros", "none"] | None = None,
    prior_mm: float | None = None,
    prior_deg: float | None = None,
    stretches: int | None = None,
    other: TableLike | None = None,
    same_point: bool = False,
    columns: Mapping[str, str] | str | None = None,
    turns: bool = False,
    turn_order: TurnOrder | None = None,
    turn_mm: float | None = None,
    tool_mm: npt.ArrayLike | None = None,
    out: Path | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """table of measured poses -> Answer: what the calibrated arm leaves of them, learnt and tried on poses held out."""
    return call("learn", [poses_file], locals())


@command
def journal(
    journal: Path,
    *,
    work: TableLike | None = None,
    next: int | None = None,
    candidates: TableLike | None = None,
    position_u_um: float | None = None,
    displacement_u_um: float | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """journal of measurements -> Answer: geometry, compliances and backlash of the arm from all of them, and what to measure next."""
    return call("journal", [journal], locals())


@command
def tracker(
    file: Path | Sequence[Path],
    *,
    robot: RobotLike,
    base: Sequence[Path] | None = None,
    joints: Path | None = None,
    joint_unit: Literal["deg", "rad"] | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """files of a laser tracker and joint positions -> Answer: a table of poses, misread and drifting reflectors."""
    files = [file] if isinstance(file, (str, os.PathLike)) else list(file)
    return call("tracker", files, locals())


@command
def forces(
    file: TableLike,
    *,
    air_s: Sequence[Sequence[float]] | None = None,
    no_drift: bool = False,
    low_pass_hz: float | None = None,
    spindle_rpm: float | None = None,
    cycle: int | None = None,
    channels: Sequence[str] | None = None,
    rate_hz: float | None = None,
    columns: Sequence[str] | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """record of a dynamometer -> Answer: forces without drift, averaged over spindle revolutions."""
    return call("forces", [file], locals())


@command
def roundness(
    *files: TableLike,
    upr: int | None = None,
    harmonics: int | None = None,
    radius_mm: float | None = None,
    unit: Literal["mm", "um", "m", "in"] | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """measured profiles -> Answer: roundness deviation: the four reference circles, filter, harmonics."""
    return call("roundness", files, locals())


@command
def ballbar(
    *files: TableLike,
    radius_mm: float | None = None,
    direction: Literal["CW", "CCW"] | None = None,
    start_deg: float | None = None,
    feed_mm_per_min: float | None = None,
    plane: Literal["XY", "YZ", "ZX", "YX", "ZY", "XZ"] | None = None,
    centre: Literal["setup", "least-squares"] | None = None,
    lobes: int | None = None,
    cyclic: float | Literal["found"] | None = None,
    reversal_deg: npt.ArrayLike | None = None,
    no_axes: bool = False,
    leave_out_outliers: bool = False,
    before: TableLike | Sequence[TableLike] | None = None,
    teach: Path | None = None,
    points: int | None = None,
    teach_lobes: int | None = None,
    program: Path | None = None,
    frame: int | None = None,
    tool: int | None = None,
    within_um: float | None = None,
    retract_mm: float | None = None,
    blend_mm: float | None = None,
    study: StudyLike | None = None,
    analysis: str | None = None,
    zero_deg: float | None = None,
    mirrored: bool = False,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """ball-bar tests -> Answer: circular deviation and its causes."""
    return call("ballbar", files, locals())


@command
def pose_accuracy(
    file: TableLike,
    *,
    robot: RobotLike,
    columns: Mapping[str, str] | str | None = None,
    turns: bool = False,
    turn_order: TurnOrder | None = None,
    turn_mm: float | None = None,
    tool_mm: npt.ArrayLike | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """table of measured poses -> Answer: pose accuracy and pose repeatability (ISO 9283)."""
    return call("pose-accuracy", [file], locals())


@command
def path_accuracy(
    *files: TableLike,
    commanded: TableLike | None = None,
    points: Path | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """measured paths -> Answer: path accuracy and path repeatability (ISO 9283)."""
    return call("path-accuracy", files, locals())


@command
def motion(
    log: TableLike,
    *,
    robot: RobotLike,
    tool_mm: npt.ArrayLike | None = None,
    compare: Sequence[TableLike] | None = None,
    zone_mm: npt.ArrayLike | None = None,
    time_unit: Literal["s", "ms", "us", "ns"] | None = None,
    angle_unit: Literal["deg", "rad"] | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """joint logs -> Answer: how a controller moves an arm: accelerations, smoothing, lag, zones."""
    return call("motion", [log], locals())


@command
def drives(
    log: TableLike,
    *,
    names: Sequence[str] | str | None = None,
    gear: npt.ArrayLike | None = None,
    rotor_inertia: npt.ArrayLike | None = None,
    robot: RobotLike | None = None,
    out: Path | None = None,
    compare: TableLike | None = None,
    time_unit: Literal["s", "ms", "us", "ns"] | None = None,
    angle_unit: Literal["deg", "rad"] | None = None,
    drawing: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """log of encoders and torques -> Answer: delay, torsion, stiffness, friction and load of the drives."""
    return call("drives", [log], locals())


@command
def frf(
    *files: TableLike,
    band_hz: npt.ArrayLike | None = None,
    modes: int | None = None,
    point: int | None = None,
    axes: Sequence[str] | str | None = None,
    drawing: Path | None = None,
    out: Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Answer:
    """frequency response functions -> Answer: modes of a tool or an arm, with uncertainties."""
    return call("frf", files, locals())
