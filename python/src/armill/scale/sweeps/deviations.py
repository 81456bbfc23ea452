"""Poses or joint positions x load cases x samples: deviation of the tool for samples of the joint compliances.

An item is a pose, or one of the joint positions, with one sample of the joint compliances; the items of a sample are
consecutive. Each item has one row per load case.

==============================  ==========================================================================
column                          contents
==============================  ==========================================================================
``case``                        load case: the row of ``forces``, from 0
``dx_um``, ``dy_um``, ``dz_um`` deviation of the TCP, base axes; null where the pose is unreachable
``branch``                      the branch used; empty where the pose is unreachable
``within_joint_limits``         whether every joint is inside its limits
==============================  ==========================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armill import Robot
from armill._types import Branch, Poses, RobotLike
from armill.scale.errors import refused
from armill.scale.sweep import Block, Sweep

UM = 1e6
#: A joint at its limit may be rounded to beyond it, rad or m.
AT_LIMIT = 1e-9


@dataclass(frozen=True)
class Deviations:
    """``Robot.evaluate`` at poses, or ``Robot.deviation`` at joint positions, with the joint compliances of a sample."""

    robot: Robot
    #: (n, 4, 4) poses or (n, dof) joint positions.
    items: NDArray[np.float64]
    are_joints: bool
    forces: NDArray[np.float64]
    samples: NDArray[np.float64] | None
    options: dict[str, Any]

    def __call__(self, block: Block) -> dict[str, Any]:
        sample, item = block["sample"], block[self.axis]
        # The items of a sample follow each other.
        starts = np.flatnonzero(np.diff(sample, prepend=-1))
        ends = [*starts[1:], len(block)]
        parts = [self.of(sample[first], item[first:last], block.threads) for first, last in zip(starts, ends, strict=True)]
        deviation, reachable, within, branch = (np.concatenate(each) for each in zip(*parts, strict=True))
        cases = len(self.forces)
        missing = np.repeat(~reachable, cases)
        columns: dict[str, Any] = {"case": np.tile(np.arange(cases, dtype=np.int32), len(block))}
        for axis, name in enumerate("xyz"):
            columns[f"d{name}_um"] = np.ma.masked_array(deviation[:, :, axis].ravel() * UM, mask=missing)
        return columns | {"branch": np.repeat(branch, cases), "within_joint_limits": np.repeat(within, cases)}

    @property
    def axis(self) -> str:
        """The axis of the items."""
        return "joints" if self.are_joints else "pose"

    def of(self, sample: int, items: NDArray[np.int64], threads: int) -> tuple[Any, Any, Any, Any]:
        """One sample at some items: deviations, whether reachable, whether inside joint limits, branch."""
        compliances = None if self.samples is None else self.samples[sample]
        at = self.items[items]
        if self.are_joints:
            deviation = self.robot.deviation(at, self.forces, **self.options, compliances=compliances, threads=threads)
            lower, upper = self.robot.limits.T
            within = ((at >= lower - AT_LIMIT) & (at <= upper + AT_LIMIT)).all(axis=1)
            return deviation, np.ones(len(at), dtype=bool), within, np.asarray(self.robot.branch_of(at), dtype=np.str_)
        found = self.robot.evaluate(at, self.forces, **self.options, compliances=compliances, threads=threads)
        return found.deviation, found.reachable, found.within_limits, np.asarray(found.branch, dtype=np.str_)


def deviations(
    robot: RobotLike,
    forces: ArrayLike,
    *,
    poses: ArrayLike | None = None,
    joints: ArrayLike | None = None,
    samples: ArrayLike | None = None,
    tool: Poses | None = None,
    branch: Branch | None = None,
    normal: ArrayLike | None = None,
    home: ArrayLike | None = None,
) -> Sweep:
    """robot, (cases, 3) forces, (n, 4, 4) poses or (n, dof) joints -> Sweep: the deviation for all combinations.

    Poses are base_from_tool; each is evaluated in the posture of ``branch`` (``nominal`` if not given), joint positions as
    they are given. Forces act on the tool at the TCP (N; (cases, 6) with moments). ``samples`` (samples, dof) are joint
    compliances, rad/(N m), by default those of the robot. ``tool``, ``branch``, ``normal`` and ``home`` are those of
    ``Robot.evaluate``; only ``tool`` applies to joint positions. The deviation at joint positions is that of
    ``Robot.deviation``: it includes the load only, no backlash.
    """
    arm = robot if isinstance(robot, Robot) else Robot.load(robot)
    if (poses is None) == (joints is None):
        raise refused("poses and joints are given both or not at all", "give `poses=` or `joints=`")
    of_poses = {"branch": branch, "normal": normal, "home": home}
    unused = [name for name, value in of_poses.items() if value is not None and poses is None]
    if unused:
        raise refused(f"`{unused[0]}` applies to poses, not to joints", f"omit `{unused[0]}`")
    many = np.asarray(joints if poses is None else poses, dtype=float)
    loads = np.atleast_2d(np.asarray(forces, dtype=float))
    drawn = None if samples is None else np.atleast_2d(np.asarray(samples, dtype=float))
    if poses is not None and (many.ndim != 3 or not many.size):
        raise refused(f"poses: expected shape (n, 4, 4), given {many.shape}", "homogeneous matrices, base_from_tool")
    if poses is None and (many.ndim != 2 or not many.size):
        raise refused(f"joints: expected shape (n, {arm.dof}), given {many.shape}", "one position per joint, rad (m)")
    if drawn is not None and (drawn.shape[1:] != (arm.dof,) or not np.isfinite(drawn).all() or (drawn < 0).any()):
        raise refused(f"samples: expected numbers of at least 0, of shape (n, {arm.dof}), given {drawn.shape}", "one per joint, rad/(N m)")
    options = {"tool": tool, **of_poses}
    work = Deviations(arm, many, poses is None, loads, drawn, {name: value for name, value in options.items() if value is not None})
    # Check the options with one item.
    work.of(0, np.arange(1), 1)
    axes = {"sample": 1 if drawn is None else len(drawn), work.axis: len(many)}
    return Sweep(axes, work, evaluations_per_item=len(loads))
