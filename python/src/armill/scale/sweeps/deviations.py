"""Poses x load cases x samples: deviation of the tool for samples of the joint compliances.

An item is a pose with one sample of the joint compliances; the poses of a sample are consecutive. Each item has one row per
load case.

==============================  ==========================================================================
column                          contents
==============================  ==========================================================================
``case``                        load case: the row of ``forces``, from 0
``dx_um``, ``dy_um``, ``dz_um`` deviation of the TCP, base axes; null where the pose is unreachable
``within_joint_limits``         whether every joint is inside its limits
==============================  ==========================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armill import Robot
from armill.scale.errors import refused
from armill.scale.sweep import Block, Sweep

UM = 1e6


@dataclass(frozen=True)
class Deviations:
    """``Robot.evaluate`` of a robot with the joint compliances of a sample."""

    robot: Robot
    poses: NDArray[np.float64]
    forces: NDArray[np.float64]
    samples: NDArray[np.float64] | None
    options: dict[str, Any]

    def __call__(self, block: Block) -> dict[str, Any]:
        sample, pose = block["sample"], block["pose"]
        # The items of a sample follow each other.
        starts = np.flatnonzero(np.diff(sample, prepend=-1))
        ends = [*starts[1:], len(block)]
        parts = [self.of(sample[first], pose[first:last], block.threads) for first, last in zip(starts, ends, strict=True)]
        deviation, reachable, within = (np.concatenate(each) for each in zip(*parts, strict=True))
        cases = len(self.forces)
        missing = np.repeat(~reachable, cases)
        columns: dict[str, Any] = {"case": np.tile(np.arange(cases, dtype=np.int32), len(block))}
        for axis, name in enumerate("xyz"):
            columns[f"d{name}_um"] = np.ma.masked_array(deviation[:, :, axis].ravel() * UM, mask=missing)
        return columns | {"within_joint_limits": np.repeat(within, cases)}

    def of(self, sample: int, poses: NDArray[np.int64], threads: int) -> tuple[Any, Any, Any]:
        """One sample at some poses: deviations, whether reachable, whether inside joint limits."""
        robot = self.robot if self.samples is None else self.robot.with_compliance(self.samples[sample])
        found = robot.evaluate(self.poses[poses], self.forces, **self.options, threads=threads)
        return found.deviation, found.reachable, found.within_limits


def deviations(
    robot: Robot | str,
    poses: ArrayLike,
    forces: ArrayLike,
    samples: ArrayLike | None = None,
    *,
    tool: ArrayLike | None = None,
    branch: str = "nominal",
    normal: ArrayLike | None = None,
    home: ArrayLike | None = None,
) -> Sweep:
    """robot, (n, 4, 4) poses, (cases, 3) forces, (samples, dof) compliances -> Sweep: the deviation for all combinations.

    Poses are base_from_tool, forces act on the tool at the TCP (N; (cases, 6) with moments), samples are joint compliances,
    rad/(N m), by default those of the robot. ``tool``, ``branch``, ``normal`` and ``home`` are those of ``Robot.evaluate``.
    """
    arm = robot if isinstance(robot, Robot) else Robot.load(robot)
    many = np.asarray(poses, dtype=float)
    loads = np.atleast_2d(np.asarray(forces, dtype=float))
    drawn = None if samples is None else np.atleast_2d(np.asarray(samples, dtype=float))
    if many.ndim != 3 or not many.size:
        raise refused(f"poses: expected shape (n, 4, 4), given {many.shape}", "homogeneous matrices, base_from_tool")
    if drawn is not None and (drawn.shape[1:] != (arm.dof,) or not np.isfinite(drawn).all() or (drawn < 0).any()):
        raise refused(f"samples: expected numbers of at least 0, of shape (n, {arm.dof}), given {drawn.shape}", "one per joint, rad/(N m)")
    options = {"tool": tool, "branch": branch, "normal": normal, "home": home}
    work = Deviations(arm, many, loads, drawn, {name: value for name, value in options.items() if value is not None})
    # Check the options with one pose.
    work.of(0, np.arange(1), 1)
    axes = {"sample": 1 if drawn is None else len(drawn), "pose": len(many)}
    return Sweep(axes, work, evaluations_per_item=len(loads))
