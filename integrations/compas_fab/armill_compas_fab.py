"""A back end of COMPAS FAB: postures, reach and straight motions of armill, with the deviation of the tool under load.

::

    planner = ArmillPlanner(armill.Robot.load("universal-robots/ur10e").with_compliance(...))
    planner.set_robot_cell(robot_cell)
    planner.inverse_kinematics(target, state)
    planner.deviation(configuration, state, force=[0, 0, -50])

Lengths are m, angles rad, forces N, moments N m, as in COMPAS FAB. Forces act on the tool at the tool centre point; they and
deviations are in the axes of the world. Collisions are not checked.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import armill
import numpy as np
from compas.geometry import Frame, Transformation
from compas_fab.backends.exceptions import (
    BackendTargetNotSupportedError,
    InverseKinematicsError,
    MPMaxJumpError,
    MPNoIKSolutionError,
)
from compas_fab.backends.interfaces import (
    ClientInterface,
    ForwardKinematics,
    InverseKinematics,
    PlanCartesianMotion,
    SetRobotCell,
    SetRobotCellState,
)
from compas_fab.backends.interfaces.planner import PlannerInterface
from compas_fab.robots import (
    FrameTarget,
    FrameWaypoints,
    JointTrajectory,
    JointTrajectoryPoint,
    PointAxisTarget,
    ReachabilityMap,
    RobotCell,
    RobotCellState,
    TargetMode,
)
from compas_robots import Configuration
from compas_robots.model import Joint

#: Largest difference of the two models of a robot at random joint positions, m and rad.
SAME = 1e-6
#: Rounding of joint positions at a limit, rad (m).
ROUNDING = 1e-9
#: Number of random joint positions at which they are compared.
COMPARED = 20
#: Number of rotations about the axis of a point and axis target.
SPINS = 36
#: Distance between the points of a straight motion, m, and rotation between them, rad.
STEP_M = 0.01
STEP_RAD = math.radians(5)
#: Largest change of a joint from point to point, rad.
JUMP_RAD = math.radians(30)


@dataclass(frozen=True)
class Deviation:
    """The deviation of the tool at n configurations under load cases, in the axes of the world.

    ``vectors`` (n, cases, 3) in m; ``covariance`` (n, cases, 3, 3) in m^2, from the uncertainty of the compliances;
    ``contributions`` (n, cases, contributors, 3) in m, which add up to the vectors; ``contributors`` names them.
    """

    vectors: np.ndarray
    covariance: np.ndarray
    contributions: np.ndarray
    contributors: list[str]

    @property
    def magnitudes(self) -> np.ndarray:
        """(n, cases) lengths of the vectors, m."""
        return np.linalg.norm(self.vectors, axis=-1)


class ArmillPlanner(ForwardKinematics, InverseKinematics, PlanCartesianMotion, SetRobotCell, SetRobotCellState, PlannerInterface):
    """A planner for one robot of armill, which must have the kinematics of the robot in the cell.

    ``robot`` is from the library (``armill.Robot.load``) or from the URDF of the cell (``armill.Robot.from_urdf``), with
    ``with_compliance`` where its compliances are measured.
    """

    def __init__(self, robot: armill.Robot) -> None:
        super().__init__()
        self.robot = robot
        self._client = ClientInterface()
        # base_of_cell_from_base_of_armill, flange_of_armill_from_pcf; of the main group
        self._base, self._tip = np.eye(4), np.eye(4)

    # Cell

    def set_robot_cell(self, robot_cell: RobotCell, robot_cell_state: RobotCellState | None = None, options: dict | None = None) -> None:
        """Sets the cell. Raises ValueError if its robot is another one, with the difference."""
        names = robot_cell.get_configurable_joint_names()
        if len(names) != self.robot.dof:
            raise ValueError(f"the main group has {len(names)} joints ({', '.join(names)}), {self.robot.name} has {self.robot.dof}")
        self._base, self._tip = _same_robot(self.robot, robot_cell, names)
        self._client._robot_cell = robot_cell
        self._client._robot_cell_state = robot_cell_state or robot_cell.default_cell_state()

    def set_robot_cell_state(self, robot_cell_state: RobotCellState, options: dict | None = None) -> None:
        """Sets the state: the attached tool and the frame of the base."""
        self.client.robot_cell.assert_cell_state_match(robot_cell_state)
        self._client._robot_cell_state = robot_cell_state

    # Kinematics

    def forward_kinematics(
        self,
        robot_cell_state: RobotCellState,
        target_mode: TargetMode,
        group: str | None = None,
        native_scale: float | None = None,
        options: dict | None = None,
    ) -> Frame:
        """The frame of flange, tool or workpiece in the world."""
        group = self._group(group)
        joints = self._values(robot_cell_state.robot_configuration)
        pcf = _frame(self._world(robot_cell_state) @ self.robot.forward(joints) @ self._tip)
        frame = self.client.robot_cell.pcf_to_target_frames(robot_cell_state, pcf, target_mode, group)
        return frame.scaled(1.0 / native_scale) if native_scale else frame

    def iter_inverse_kinematics(
        self,
        target: FrameTarget | PointAxisTarget,
        robot_cell_state: RobotCellState | None = None,
        group: str | None = None,
        options: dict | None = None,
    ) -> Iterator[Configuration]:
        """All postures at the target within the joint limits.

        Nearest to the configuration of the state first; with ``force`` in the options, (3,) N or (6,) N and N m, the one with
        the smallest deviation first. Options: ``force``, ``max_results``, ``spins`` (number of rotations about the axis of a
        ``PointAxisTarget``; 36). Raises InverseKinematicsError with the reason if there is none.
        """
        options, group = options or {}, self._group(group)
        state = robot_cell_state or self.client.robot_cell_state
        frames = _frames(target, int(options.get("spins", SPINS)))
        pcf = self.client.robot_cell.target_frames_to_pcf(state, frames, target.target_mode, group)
        found = self.robot.inverse(self._flanges(pcf, state))
        joints = self._within(found.joints, found.within_limits)
        if not len(joints):
            reason = found.reason(0) or "every posture is outside the joint limits"
            raise InverseKinematicsError(f"{self.robot.name}: {reason}", target_pcf=pcf[0])
        if "force" in options:
            cost = self.deviation(joints, state, options["force"], group=group, target_mode=target.target_mode).magnitudes.max(axis=1)
        else:
            start = self._values(state.robot_configuration)
            joints = _turned(joints, start, self._limits(), self._period())
            cost = np.abs(joints - start).sum(axis=1)
        for i in np.argsort(cost, kind="stable")[: options.get("max_results", 100)]:
            yield self._configuration(joints[i], group)

    def plan_cartesian_motion(
        self,
        waypoints: FrameWaypoints,
        start_state: RobotCellState,
        group: str | None = None,
        options: dict | None = None,
    ) -> JointTrajectory:
        """A straight motion through the waypoints in one branch.

        The branch is the nearest to the start; with ``force`` in the options the one with the smallest largest deviation. Points
        between the waypoints are at most ``max_step`` (0.01 m) and 5 deg apart. Raises MPNoIKSolutionError where a point is
        unreachable, MPMaxJumpError where a joint would move more than ``max_jump`` (30 deg, in rad) from point to point.
        """
        if not isinstance(waypoints, FrameWaypoints):
            raise BackendTargetNotSupportedError(f"a straight motion needs FrameWaypoints, not {type(waypoints).__name__}")
        options, group = options or {}, self._group(group)
        cell, mode = self.client.robot_cell, waypoints.target_mode
        given = waypoints.normalized_to_meters().target_frames
        poses = np.concatenate([[_matrix(given[0])], *(_between(a, b, options.get("max_step", STEP_M)) for a, b in itertools.pairwise(given))])
        pcf = cell.target_frames_to_pcf(start_state, [_frame(pose) for pose in poses], mode, group)
        flanges = self._flanges(pcf, start_state)
        start = self._values(start_state.robot_configuration)
        postures = self.robot.inverse(flanges)
        paths = [path for branch in sorted(set(postures.branch)) if (path := self._followed(postures, branch, start)) is not None]
        if not paths:
            stuck = self._stuck(postures)
            where = _frame(poses[stuck]).point
            raise MPNoIKSolutionError(f"no branch of {self.robot.name} follows the motion; furthest to {where}", target=pcf[stuck])
        if "force" in options:
            costs = [self.deviation(path, start_state, options["force"], group=group, target_mode=mode).magnitudes.max() for path in paths]
        else:
            costs = [float(np.abs(path[0] - start).sum()) for path in paths]
        best = paths[int(np.argmin(costs))]
        self._no_jumps(best, options.get("max_jump", JUMP_RAD))
        configurations = [self._configuration(joints, group) for joints in best]
        points = [JointTrajectoryPoint(c.joint_values, c.joint_types, joint_names=c.joint_names) for c in configurations]
        return JointTrajectory(points, configurations[0].joint_names, configurations[0], fraction=1.0)

    # Deviation

    def deviation(
        self,
        configurations: Configuration | list[Configuration] | np.ndarray,
        robot_cell_state: RobotCellState,
        force: Any,
        *,
        group: str | None = None,
        target_mode: TargetMode = TargetMode.TOOL,
    ) -> Deviation:
        """The deviation of the tool centre point under ``force``: (3,) N, (6,) N and N m, or (cases, 3 or 6).

        ``target_mode`` is the frame that is loaded: ``TOOL``, ``ROBOT`` (the flange) or ``WORKPIECE``.
        """
        group = self._group(group)
        if isinstance(configurations, np.ndarray):
            joints = configurations.reshape(-1, self.robot.dof)
        else:
            given = configurations if isinstance(configurations, list) else [configurations]
            joints = np.array([self._values(each) for each in given])
        if target_mode == TargetMode.TOOL and robot_cell_state.get_attached_tool_id(group) is None:
            target_mode = TargetMode.ROBOT
        pcf_from_tool = self.client.robot_cell.pcf_to_target_frames(robot_cell_state, Frame.worldXY(), target_mode, group)
        tool = self._tip @ _matrix(pcf_from_tool)
        turn = self._world(robot_cell_state)[:3, :3]
        forces = np.atleast_2d(np.asarray(force, float))
        in_base = np.concatenate([part @ turn for part in np.split(forces, forces.shape[1] // 3, axis=1)], axis=1)
        vectors = self.robot.deviation(joints, in_base, tool) @ turn.T
        covariance = turn @ self.robot.deviation_covariance(joints, in_base, tool) @ turn.T
        return Deviation(vectors, covariance, self.robot.contributions(joints, in_base, tool) @ turn.T, self.robot.contributors)

    def least_deviations(self, reachability: ReachabilityMap, robot_cell_state: RobotCellState, force: Any) -> list[list[float]]:
        """The smallest deviation of all postures at each frame of a calculated map, m, in its 2D order; NaN where unreachable.

        It is the length of the vector under the load case with the largest one.
        """
        return [
            [
                float(self.deviation(found, robot_cell_state, force).magnitudes.max(axis=1).min()) if found else math.nan
                for found in ([each for each in postures if each is not None] for postures in row)
            ]
            for row in reachability.configurations
        ]

    # Parts

    def _group(self, group: str | None) -> str:
        main = self.client.robot_cell.main_group_name
        if group not in (None, main):
            raise ValueError(f"group {group!r}: only the main group {main!r} is supported")
        return main

    def _world(self, state: RobotCellState) -> np.ndarray:
        """world_from_base, of the base of armill."""
        return _matrix(state.robot_base_frame) @ self._base

    def _flanges(self, pcf: list[Frame], state: RobotCellState) -> np.ndarray:
        """(n, 4, 4) base_from_flange of armill."""
        return np.linalg.inv(self._world(state)) @ np.array([_matrix(frame) for frame in pcf]) @ np.linalg.inv(self._tip)

    def _values(self, configuration: Configuration) -> np.ndarray:
        names = self.client.robot_cell.get_configurable_joint_names()
        if configuration.joint_names:
            return np.array([configuration[name] for name in names])
        return np.array(configuration.joint_values)

    def _configuration(self, joints: np.ndarray, group: str) -> Configuration:
        configuration = self.client.robot_cell.zero_configuration(group)
        configuration.joint_values = [float(value) for value in joints]
        return configuration

    def _limits(self) -> np.ndarray:
        """(dof, 2) the narrower of the limits of armill and of the cell."""
        return np.array([_narrower(own, joint) for own, joint in zip(self.robot.limits, self.client.robot_cell.get_configurable_joints(), strict=True)])

    def _within(self, joints: np.ndarray, flags: np.ndarray) -> np.ndarray:
        limits = self._limits()
        middle = np.clip(np.nan_to_num(limits.mean(axis=1)), -math.pi, math.pi)
        joints = _turned(joints[flags], middle, limits, self._period())
        return joints[_inside(joints, limits)]

    def _period(self) -> np.ndarray:
        """(dof,) a full turn of each revolute joint; 0 for prismatic joints."""
        types = self.client.robot_cell.get_configurable_joint_types()
        return np.array([0.0 if kind == Joint.PRISMATIC else 2 * math.pi for kind in types])

    def _followed(self, postures: armill.Postures, branch: str, start: np.ndarray) -> np.ndarray | None:
        """(n, dof) joint positions in one branch, each joint in the turn next to the point before; None if it cannot follow."""
        chosen = np.array([each == branch for each in postures.branch])
        index, first = np.unique(postures.pose_index[chosen], return_index=True)
        if len(index) < len(postures):
            return None
        limits, path = self._limits(), np.array(postures.joints[chosen][first])
        path[0] = _turned(path[:1], start, limits, self._period())[0]
        for i in range(1, len(path)):
            path[i] = _next_turn(path[i], path[i - 1], self._period())
        return path if np.all(_inside(path, limits)) else None

    def _stuck(self, postures: armill.Postures) -> int:
        """Index of the first point without a posture within the limits, or the last point."""
        for i in range(len(postures)):
            part = slice(postures.offsets[i], postures.offsets[i + 1])
            if not len(self._within(postures.joints[part], postures.within_limits[part])):
                return i
        return len(postures) - 1

    def _no_jumps(self, path: np.ndarray, limit: float) -> None:
        steps = np.abs(np.diff(path, axis=0))
        if steps.size and steps.max() > limit:
            i, joint = np.unravel_index(int(steps.argmax()), steps.shape)
            name = self.client.robot_cell.get_configurable_joint_names()[joint]
            raise MPMaxJumpError(
                f"joint {name} would move {math.degrees(steps.max()):.1f} deg from point {i} to the next",
                joint_name=name,
                joint_values_a=path[i].tolist(),
                joint_values_b=path[i + 1].tolist(),
                value_difference=float(steps.max()),
                value_threshold=limit,
            )


def _same_robot(robot: armill.Robot, cell: RobotCell, names: list[str]) -> tuple[np.ndarray, np.ndarray]:
    """The constant transforms of base and tip between the two models. Raises ValueError if there are none."""
    generator = np.random.default_rng(0)
    limits = np.clip(robot.limits, -math.pi, math.pi)
    joints = np.concatenate([np.zeros((1, robot.dof)), generator.uniform(limits[:, 0], limits[:, 1], (COMPARED, robot.dof))])
    tip = cell.get_end_effector_link_name()
    zero = cell.zero_configuration()
    theirs = []
    for row in joints:
        configuration = zero.copy()
        configuration.joint_values = row.tolist()
        theirs.append(_matrix(cell.robot_model.forward_kinematics(configuration, link_name=tip)))
    base, flange_from_tip, difference = _transforms(robot.forward(joints), np.array(theirs))
    if difference > SAME:
        raise ValueError(
            f"{robot.name} is not the robot of the cell: at the same joint positions the flanges differ by up to"
            f" {1000 * difference:.3g} mm beyond constant transforms of base and flange; use armill.Robot.from_urdf with the URDF of the cell"
        )
    return base, flange_from_tip


def _transforms(ours: np.ndarray, theirs: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Constant transforms with ``theirs[i] = base @ ours[i] @ tip``, and the largest difference; (n, 4, 4) poses at the same joints.

    Motions from the first pose do not depend on the base: their rotation axes differ by the rotation of the tip, and the
    equations for its position are linear.
    """
    motions = np.linalg.inv(ours[0]) @ ours[1:]
    seen = np.linalg.inv(theirs[0]) @ theirs[1:]
    axes, seen_axes = (np.array([_rotation_vector(each[:3, :3]) for each in poses]) for poses in (motions, seen))
    left, _, right = np.linalg.svd(axes.T @ seen_axes)
    tip = np.eye(4)
    tip[:3, :3] = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    equations = np.concatenate([each[:3, :3] - np.eye(3) for each in motions])
    sides = np.concatenate([tip[:3, :3] @ other[:3, 3] - each[:3, 3] for each, other in zip(motions, seen, strict=True)])
    tip[:3, 3] = np.linalg.lstsq(equations, sides, rcond=None)[0]
    base = theirs[0] @ np.linalg.inv(tip) @ np.linalg.inv(ours[0])
    return base, tip, float(np.abs(base @ ours @ tip - theirs).max())


def _rotation_vector(turn: np.ndarray) -> np.ndarray:
    axis, angle = _axis_angle(turn)
    return angle * axis


def _frames(target: Any, spins: int) -> list[Frame]:
    """The frames of a target, in m."""
    if isinstance(target, FrameTarget):
        return [target.normalized_to_meters().target_frame]
    if not isinstance(target, PointAxisTarget):
        raise BackendTargetNotSupportedError(f"a FrameTarget or a PointAxisTarget is needed, not {type(target).__name__}")
    target = target.normalized_to_meters()
    z = np.array(target.target_z_axis, float)
    z /= np.linalg.norm(z)
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
    x /= np.linalg.norm(x)
    angles = np.arange(spins) * 2 * math.pi / spins
    axes = [(math.cos(a) * x + math.sin(a) * np.cross(z, x)) for a in angles]
    return [Frame(target.target_point, axis.tolist(), np.cross(z, axis).tolist()) for axis in axes]


def _between(first: Frame, last: Frame, step_m: float) -> np.ndarray:
    """(n, 4, 4) poses after the first, on a straight line and at a constant rate about one axis, with the last."""
    a, b = _matrix(first), _matrix(last)
    turn = a[:3, :3].T @ b[:3, :3]
    axis, angle = _axis_angle(turn)
    count = max(1, math.ceil(np.linalg.norm(b[:3, 3] - a[:3, 3]) / step_m), math.ceil(angle / STEP_RAD))
    poses = np.tile(b, (count, 1, 1))
    for i in range(count - 1):
        part = (i + 1) / count
        poses[i, :3, 3] = a[:3, 3] + part * (b[:3, 3] - a[:3, 3])
        poses[i, :3, :3] = a[:3, :3] @ _rotation(axis, part * angle)
    return poses


def _axis_angle(turn: np.ndarray) -> tuple[np.ndarray, float]:
    transformation = Transformation.from_matrix(np.block([[turn, np.zeros((3, 1))], [0, 0, 0, 1]]).tolist())
    axis, angle = transformation.rotation.axis_and_angle
    return np.array(axis), angle


def _rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def _next_turn(joints: np.ndarray, last: np.ndarray, period: np.ndarray) -> np.ndarray:
    return joints + period * np.round((last - joints) / np.where(period > 0, period, 1.0))


def _turned(joints: np.ndarray, near: np.ndarray, limits: np.ndarray, period: np.ndarray) -> np.ndarray:
    """(n, dof) -> the same postures with each revolute joint in the turn within its limits that is next to ``near``."""
    turns = joints[..., None] + period[:, None] * np.arange(-2, 3)
    outside = (turns < limits[:, :1] - ROUNDING) | (turns > limits[:, 1:] + ROUNDING)
    cost = np.where(outside, np.inf, np.abs(turns - near[:, None]))
    chosen = np.take_along_axis(turns, cost.argmin(axis=-1)[..., None], axis=-1)[..., 0]
    return np.where(np.isfinite(cost.min(axis=-1)), chosen, joints)


def _inside(joints: np.ndarray, limits: np.ndarray) -> np.ndarray:
    """(n,) bool: whether all joints are within the limits."""
    return np.all((joints >= limits[:, 0] - ROUNDING) & (joints <= limits[:, 1] + ROUNDING), axis=1)


def _narrower(own: np.ndarray, joint: Any) -> tuple[float, float]:
    limit = joint.limit
    if limit is None or limit.lower is None or limit.upper is None or limit.upper <= limit.lower:
        return (float(own[0]), float(own[1]))
    return (max(float(own[0]), limit.lower), min(float(own[1]), limit.upper))


def _matrix(frame: Frame) -> np.ndarray:
    return np.array(Transformation.from_frame(frame).matrix)


def _frame(pose: np.ndarray) -> Frame:
    return Frame(pose[:3, 3].tolist(), pose[:3, 0].tolist(), pose[:3, 1].tolist())
