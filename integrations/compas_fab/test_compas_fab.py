"""The back end against COMPAS FAB's own kinematics, with the robots of COMPAS FAB."""

from __future__ import annotations

import math
from pathlib import Path

import armill
import compas_fab
import numpy as np
import pytest
from armill_compas_fab import ArmillPlanner, _transforms
from compas.geometry import Frame, Point, Vector
from compas_fab.backends import AnalyticalKinematicsPlanner
from compas_fab.backends.exceptions import InverseKinematicsError, MPMaxJumpError, MPNoIKSolutionError
from compas_fab.backends.kinematics.solvers import UR10eKinematics
from compas_fab.robots import (
    FrameTarget,
    FrameWaypoints,
    PointAxisTarget,
    ReachabilityMap,
    RobotCellLibrary,
    TargetMode,
)

COMPLIANCE = [2e-6, 3e-6, 4e-6, 1e-5, 1e-5, 2e-5]
URDF = Path(compas_fab.get("robot_library/abb_irb120_3_58/urdf/robot_description.urdf"))


def planner(name: str = "ur10e", robot: armill.Robot | None = None) -> tuple[ArmillPlanner, object]:
    cell, state = getattr(RobotCellLibrary, name)(load_geometry=False)
    found = robot or armill.Robot.load("universal-robots/ur10e")
    ready = ArmillPlanner(found.with_compliance(COMPLIANCE, [0.1 * each for each in COMPLIANCE]))
    ready.set_robot_cell(cell, state)
    return ready, state


def at(state, joints):
    new = state.copy()
    new.robot_configuration.joint_values[: len(joints)] = list(joints)
    return new


def distance(a: Frame, b: Frame) -> float:
    return max(a.point.distance_to_point(b.point), (a.xaxis - b.xaxis).length, (a.yaxis - b.yaxis).length)


def test_base_and_flange_may_differ_by_constant_transforms() -> None:
    robot = armill.Robot.load("universal-robots/ur10e")
    ours = robot.forward(np.random.default_rng(2).uniform(-2, 2, (20, 6)))
    base, tip = robot.forward([0.1, -0.4, 0.9, 0.3, 0.2, -0.7]), robot.forward([-1.1, 0.4, 0.5, -0.3, 1.2, 0.7])
    found = _transforms(ours, base @ ours @ tip)
    assert np.abs(found[0] - base).max() < 1e-9 and np.abs(found[1] - tip).max() < 1e-9 and found[2] < 1e-9
    longer = ours.copy()
    longer[10:, 0, 3] += 1e-4
    assert _transforms(ours, longer)[2] > 1e-6


@pytest.mark.parametrize(("name", "robot"), [("ur10e", None), ("abb_irb120_3_58", armill.Robot.from_urdf(URDF)), ("ur5_cone_tool", "urdf")])
def test_forward_kinematics_are_those_of_the_cell(name: str, robot: armill.Robot | str | None) -> None:
    if robot == "urdf":
        robot = armill.Robot.from_urdf(compas_fab.get("robot_library/ur5_robot/urdf/robot_description.urdf"))
    ready, state = planner(name, robot)
    mode = TargetMode.TOOL if name == "ur5_cone_tool" else TargetMode.ROBOT
    state.robot_base_frame = Frame([1, 2, 3], [0, 1, 0], [-1, 0, 0])
    for joints in np.random.default_rng(1).uniform(-1.5, 1.5, (10, 6)):
        there = at(state, joints)
        theirs = ready.client.robot_cell.forward_kinematics_target_frame(there, mode)
        assert distance(ready.forward_kinematics(there, mode), theirs) < 1e-6
        in_mm = ready.forward_kinematics(there, mode, native_scale=0.001)
        assert in_mm.point.distance_to_point(theirs.point * 1000) < 1e-3


def test_postures_are_those_of_the_analytical_solver() -> None:
    ready, state = planner()
    other = AnalyticalKinematicsPlanner(UR10eKinematics())
    other.set_robot_cell(ready.client.robot_cell)
    there = at(state, [0.3, -1.2, 1.4, -0.7, 0.9, 0.2])
    target = FrameTarget(ready.forward_kinematics(there, TargetMode.ROBOT), TargetMode.ROBOT)
    ours = list(ready.iter_inverse_kinematics(target, there))
    assert np.abs(np.array(ours[0].joint_values) - [0.3, -1.2, 1.4, -0.7, 0.9, 0.2]).max() < 1e-6
    assert len(ours) == 8
    for found in ours:
        assert distance(ready.client.robot_cell.forward_kinematics_target_frame(at(state, found.joint_values), TargetMode.ROBOT), target.target_frame) < 1e-6
    # The same eight, as points on the circle; the solver of COMPAS FAB has its own base frame.
    theirs = [np.array(c.joint_values) for c in other.iter_inverse_kinematics(FrameTarget(other.forward_kinematics(there, TargetMode.ROBOT), TargetMode.ROBOT), there)]
    circle = lambda joints: np.exp(1j * np.asarray(joints))  # noqa: E731
    for found in theirs:
        assert min(np.abs(circle(found) - circle(c.joint_values)).max() for c in ours) < 1e-4


def test_the_least_deviation_comes_first_and_is_that_of_armill() -> None:
    ready, state = planner()
    state.robot_base_frame = Frame([1, 0, 0], [0, 1, 0], [-1, 0, 0])
    there = at(state, [0.3, -1.2, 1.4, -0.7, 0.9, 0.2])
    target = FrameTarget(ready.forward_kinematics(there, TargetMode.ROBOT), TargetMode.ROBOT)
    force = [10.0, -20.0, 30.0]
    found = list(ready.iter_inverse_kinematics(target, there, options={"force": force}))
    sizes = ready.deviation(found, there, force).magnitudes[:, 0]
    assert len(found) == 8 and np.all(np.diff(sizes) >= 0) and sizes[-1] > 1.05 * sizes[0]
    # J C J^T f with the Jacobian of the cell's own kinematics by differences, in axes of the world.
    joints, step = np.array(found[0].joint_values), 1e-6
    point = lambda q: np.array(ready.client.robot_cell.forward_kinematics_target_frame(at(there, q), TargetMode.ROBOT).point)  # noqa: E731
    jacobian = np.array([(point(joints + step * e) - point(joints - step * e)) / (2 * step) for e in np.eye(6)]).T
    expected = jacobian @ np.diag(COMPLIANCE) @ jacobian.T @ force
    deviation = ready.deviation(found[0], there, force)
    assert np.abs(deviation.vectors[0, 0] - expected).max() < 1e-5 * np.abs(expected).max()
    assert np.allclose(deviation.contributions.sum(axis=2), deviation.vectors, atol=1e-15)
    assert np.all(np.linalg.eigvalsh(deviation.covariance[0, 0]) >= -1e-18)
    assert deviation.contributors[:6] == ready.robot.contributors[:6]


def test_moments_and_the_attached_tool() -> None:
    robot = armill.Robot.from_urdf(compas_fab.get("robot_library/ur5_robot/urdf/robot_description.urdf"))
    ready, state = planner("ur5_cone_tool", robot)
    joints = np.array([[0.3, -1.2, 1.4, -0.7, 0.9, 0.2]])
    at_tool, at_flange = (ready.deviation(joints, state, [0, 0, 50, 0, 0, 0], target_mode=mode) for mode in (TargetMode.TOOL, TargetMode.ROBOT))
    assert at_tool.magnitudes[0, 0] != pytest.approx(at_flange.magnitudes[0, 0], rel=1e-3)
    moved = ready.deviation(joints, state, [[0, 0, 50], [0, 0, 50]])
    assert moved.vectors.shape == (1, 2, 3) and np.allclose(moved.vectors[0, 0], at_tool.vectors[0, 0])


def test_a_point_and_an_axis_leave_the_spin_free() -> None:
    ready, state = planner()
    target = PointAxisTarget(Point(0.6, 0.2, 0.4), Vector(0, 0, -1), TargetMode.ROBOT)
    found = list(ready.iter_inverse_kinematics(target, state, options={"force": [0, 0, 50], "spins": 12, "max_results": 5}))
    assert len(found) == 5
    for each in found:
        frame = ready.client.robot_cell.forward_kinematics_target_frame(at(state, each.joint_values), TargetMode.ROBOT)
        assert frame.point.distance_to_point(target.target_point) < 1e-6 and (frame.zaxis - Vector(0, 0, -1)).length < 1e-6


def test_reachability_map() -> None:
    ready, state = planner()
    down = [[Frame([x, 0.2, 0.3], [1, 0, 0], [0, -1, 0]) for x in (0.5, 0.7, 0.9)], [Frame([x, 0.2, 0.3], [1, 0, 0], [0, -1, 0]) for x in (1.2, 3.0, 4.0)]]
    result = ReachabilityMap()
    result.calculate(iter(down), ready, state, TargetMode.ROBOT, ik_options={})
    assert [len(found) for row in result.configurations for found in row] == [8, 8, 8, 4, 0, 0]
    least = ready.least_deviations(result, state, [0, 0, 50])
    every = ready.deviation(result.configurations[0][1], state, [0, 0, 50]).magnitudes
    assert least[0][1] == pytest.approx(float(every.min()))
    assert [math.isnan(each) for each in least[1]] == [False, True, True]


def test_straight_motions_stay_in_one_branch() -> None:
    ready, state = planner()
    start = at(state, [0.3, -1.2, 1.4, -0.7, 0.9, 0.2])
    first = ready.forward_kinematics(start, TargetMode.ROBOT)
    last = Frame(first.point + Vector(0.1, 0.05, -0.03), first.xaxis, first.yaxis)
    trajectory = ready.plan_cartesian_motion(FrameWaypoints([first, last], TargetMode.ROBOT), start)
    joints = np.array([point.joint_values for point in trajectory.points])
    assert np.abs(joints[0] - [0.3, -1.2, 1.4, -0.7, 0.9, 0.2]).max() < 1e-6
    assert len(joints) >= 12 and np.abs(np.diff(joints, axis=0)).max() < math.radians(5)
    line = np.array([ready.client.robot_cell.forward_kinematics_target_frame(at(start, q), TargetMode.ROBOT).point for q in joints])
    along = np.array(last.point - first.point)
    assert np.abs(np.cross(line - np.array(first.point), along / np.linalg.norm(along))).max() < 1e-6
    stiff = ready.plan_cartesian_motion(FrameWaypoints([first, last], TargetMode.ROBOT), start, options={"force": [0, 0, 50]})
    sizes = [ready.deviation(np.array([p.joint_values for p in t.points]), start, [0, 0, 50]).magnitudes.max() for t in (stiff, trajectory)]
    assert sizes[0] <= sizes[1]


def test_errors() -> None:
    ready, state = planner()
    with pytest.raises(InverseKinematicsError) as found:
        list(ready.iter_inverse_kinematics(FrameTarget(Frame([5, 0, 0], [1, 0, 0], [0, 1, 0]), TargetMode.ROBOT), state))
    assert "reach" in found.value.message
    there = Frame([0.5, 0.2, 0.3], [1, 0, 0], [0, -1, 0])
    with pytest.raises(MPNoIKSolutionError, match="follows the motion"):
        ready.plan_cartesian_motion(FrameWaypoints([there, Frame([2, 0.2, 0.3], [1, 0, 0], [0, -1, 0])], TargetMode.ROBOT), state)
    with pytest.raises(MPMaxJumpError, match="would move"):
        ready.plan_cartesian_motion(FrameWaypoints([there, Frame([0.6, 0.2, 0.3], [1, 0, 0], [0, -1, 0])], TargetMode.ROBOT), state, options={"max_jump": 1e-4})
    cell, _ = RobotCellLibrary.abb_irb120_3_58(load_geometry=False)
    with pytest.raises(ValueError, match="is not the robot of the cell"):
        ready.set_robot_cell(cell)
    unknown = ArmillPlanner(armill.Robot.load("universal-robots/ur10e"))
    unknown.set_robot_cell(ready.client.robot_cell)
    with pytest.raises(armill.InputError, match="compliance"):
        unknown.deviation(np.zeros((1, 6)), state, [0, 0, 1])
    with pytest.raises(ValueError, match="only the main group"):
        ready.forward_kinematics(state, TargetMode.ROBOT, group="hand")
