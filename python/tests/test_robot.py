"""Results of a robot compared with numpy: finite differences, matrix products, forward of inverse."""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import armill
from conftest import ROOT

FORCES = np.array([[3.0, -5.0, 5.0, 0.4, -1.5, 2.0], [-20.0, 4.0, 1.0, 0.0, 0.0, 0.0]])


def turn(matrix: np.ndarray) -> np.ndarray:
    """Axis times angle of a small turn."""
    return 0.5 * np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])


def test_forward_gives_rotations_and_a_tool_fixed_to_the_flange(mh12, joints, tool):
    flange, tip = mh12.forward(joints), mh12.forward(joints, tool)
    assert flange.shape == tip.shape == (300, 4, 4)
    eye = flange[:, :3, :3] @ flange[:, :3, :3].transpose(0, 2, 1)
    assert np.abs(eye - np.eye(3)).max() < 1e-14
    assert np.abs(tip - flange @ tool).max() < 1e-14


def test_jacobian_matches_finite_differences(mh12, joints, tool):
    jacobians, step = mh12.jacobian(joints, tool), 1e-6
    assert jacobians.shape == (300, 6, 6)
    here = mh12.forward(joints, tool)
    for joint in range(mh12.dof):
        by = np.zeros(mh12.dof)
        by[joint] = step
        there, before = mh12.forward(joints + by, tool), mh12.forward(joints - by, tool)
        moved = (there - before)[:, :3, 3] / (2 * step)
        turned = np.array([turn((a - b)[:3, :3] @ h[:3, :3].T) for a, b, h in zip(there, before, here)]) / (2 * step)
        # Rounding of 1e-16 m over a step of 1e-6, and the square of the step.
        assert np.abs(jacobians[:, :3, joint] - moved).max() < 1e-9
        assert np.abs(jacobians[:, 3:, joint] - turned).max() < 1e-9


def test_compliance_is_that_of_springs_in_the_joints(mh12, joints, tool):
    jacobians = mh12.jacobian(joints, tool)
    witness = jacobians @ np.diag(mh12.joint_compliance) @ jacobians.transpose(0, 2, 1)
    compliance = mh12.compliance(joints, tool)
    assert np.abs(compliance - witness).max() <= 1e-12 * np.abs(witness).max()
    assert np.array_equal(compliance, compliance.transpose(0, 2, 1))


def test_deviation_is_compliance_times_wrench_and_its_contributions_add_up(mh12, joints, tool):
    deviation = mh12.deviation(joints, FORCES, tool)
    witness = np.einsum("nij,cj->nci", mh12.compliance(joints, tool)[:, :3], FORCES)
    assert deviation.shape == (300, 2, 3)
    assert np.abs(deviation - witness).max() <= 1e-12 * np.abs(witness).max()
    contributions = mh12.contributions(joints, FORCES, tool)
    assert contributions.shape == (300, 2, len(mh12.contributors), 3) and mh12.contributors == mh12.joint_names
    assert np.abs(contributions.sum(axis=2) - deviation).max() <= 1e-12 * np.abs(deviation).max()


def test_a_force_is_a_wrench_without_moment(mh12, joints):
    wrenches = np.hstack([FORCES[:, :3], np.zeros((2, 3))])
    assert np.array_equal(mh12.deviation(joints, FORCES[:, :3]), mh12.deviation(joints, wrenches))


def test_forward_of_inverse_is_the_pose_and_every_posture_is_returned(mh12, joints, tool):
    poses = mh12.forward(joints, tool)
    postures = mh12.inverse(poses, tool)
    assert len(postures) == 300 and postures.offsets.shape == (301,)
    assert np.abs(mh12.forward(postures.joints, tool) - poses[postures.pose_index]).max() < 1e-9
    assert len(postures.branch) == len(postures.pose_index) == len(postures.joints) == postures.offsets[-1]
    low, high = mh12.limits.T
    inside = ((postures.joints >= low - 1e-9) & (postures.joints <= high + 1e-9)).all(axis=1)
    assert np.array_equal(postures.within_limits, inside)
    for i, given in enumerate(joints):
        own = postures[i]
        first, last = postures.offsets[i], postures.offsets[i + 1]
        assert np.array_equal(own, postures.joints[first:last])
        # The posture of the pose is among them, up to whole turns.
        away = np.abs((own - given + np.pi) % (2 * np.pi) - np.pi).max(axis=1)
        assert away.min() < 1e-6
        names = postures.branch[first:last]
        assert len(set(names)) == len(names) and postures.reason(i) is None


def test_a_pose_out_of_reach_has_a_reason_and_no_posture(mh12):
    pose = np.eye(4)
    pose[0, 3] = 9.0
    postures = mh12.inverse(pose)
    assert len(postures) == 1 and postures[0].shape == (0, 6)
    assert "beyond the stretched arm" in postures.reason(0)
    with pytest.raises(IndexError, match="pose 1 does not exist"):
        postures.reason(1)


def test_evaluate_gives_the_posture_of_its_branch_and_the_deviation_there(mh12, joints, tool):
    poses = mh12.forward(joints, tool)
    evaluation = mh12.evaluate(poses, FORCES, tool, normal=[-0.8, 0.3, 0.5], branch="front elbow-up no-flip")
    normal = np.array([-0.8, 0.3, 0.5]) / np.linalg.norm([-0.8, 0.3, 0.5])
    assert 20 < evaluation.reachable.sum() <= 300
    where = evaluation.reachable
    assert np.abs(mh12.forward(evaluation.joints[where], tool) - poses[where]).max() < 1e-9
    assert {name for name, h in zip(evaluation.branch, where) if h} == {"front elbow-up no-flip"}
    witness = mh12.deviation(evaluation.joints[where], FORCES, tool)
    assert np.abs(evaluation.deviation[where] - witness).max() <= 1e-9 * np.abs(witness).max()
    along = witness @ normal
    in_plane = np.linalg.norm(witness - along[..., None] * normal, axis=2)
    assert np.abs(evaluation.in_plane[where] - in_plane.max(axis=1)).max() < 1e-9 * in_plane.max()
    assert np.array_equal(evaluation.worst_case[where], in_plane.argmax(axis=1))
    assert np.abs(evaluation.contributions[where].sum(axis=1) - evaluation.in_plane[where]).max() < 1e-9 * in_plane.max()
    assert np.abs(np.abs(evaluation.normal_deviation[where]) - np.abs(along).max(axis=1)).max() < 1e-9 * in_plane.max()
    for values in (evaluation.joints, evaluation.deviation, evaluation.in_plane, evaluation.magnitude, evaluation.contributions):
        assert np.isnan(values[~where]).all() and np.isfinite(values[where]).all()
    assert (evaluation.worst_case[~where] == -1).all() and evaluation.worst_case.dtype == np.int64
    assert evaluation.reachable[np.nanargmin(evaluation.in_plane)]
    reasons = [evaluation.reason(i) for i in np.flatnonzero(~where)]
    assert all(reasons) and evaluation.reason(int(np.flatnonzero(where)[0])) is None


def test_the_best_posture_is_no_worse_than_any_inside_the_limits(mh12, joints):
    poses = mh12.forward(joints[:40])
    normal = [0.0, 0.0, 1.0]
    best = mh12.evaluate(poses, FORCES, branch="best", normal=normal)
    postures = mh12.inverse(poses)
    deviation = mh12.deviation(postures.joints, FORCES)
    in_plane = np.linalg.norm(deviation[..., :2], axis=2).max(axis=1)
    for i in range(40):
        own = (postures.pose_index == i) & postures.within_limits
        assert best.reachable[i] and best.within_limits[i]
        assert abs(best.in_plane[i] - in_plane[own].min()) < 1e-9 * in_plane.max()


def test_without_a_normal_the_plane_is_perpendicular_to_the_tool(mh12):
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[:3, 3] = [0.9, 0.1, 0.4]
    poses = np.stack([pose, pose])
    poses[1, 0, 3] = 1.0
    assert np.array_equal(mh12.evaluate(poses, [1, 2, 3]).in_plane, mh12.evaluate(poses, [1, 2, 3], normal=[0, 0, 2]).in_plane)
    poses[1, :3, :3] = np.eye(3)
    with pytest.raises(armill.InputError, match=r"poses\[1\] and poses\[0\] have different tool directions.*\n.*normal"):
        mh12.evaluate(poses, [1, 2, 3])


def test_a_single_item_has_a_result_without_the_first_axis(mh12, joints, tool):
    one = joints[7]
    assert np.array_equal(mh12.forward(one, tool), mh12.forward(joints, tool)[7])
    assert np.array_equal(mh12.jacobian(one), mh12.jacobian(joints)[7])
    assert np.array_equal(mh12.compliance(one), mh12.compliance(joints)[7])
    assert np.array_equal(mh12.deviation(one, FORCES), mh12.deviation(joints, FORCES)[7])
    assert np.array_equal(mh12.deviation(joints, FORCES[0]), mh12.deviation(joints, FORCES)[:, 0])
    assert mh12.deviation(one, [1, 2, 3]).shape == (3,)
    assert mh12.contributions(one, [1, 2, 3]).shape == (6, 3)
    evaluation = mh12.evaluate(mh12.forward(one), [1, 2, 3], branch="best")
    assert evaluation.joints.shape == (6,) and evaluation.deviation.shape == (3,) and evaluation.in_plane.shape == ()


def test_no_items_give_empty_results(mh12):
    assert mh12.forward(np.zeros((0, 6))).shape == (0, 4, 4)
    assert mh12.deviation(np.zeros((0, 6)), FORCES).shape == (0, 2, 3)
    assert len(mh12.inverse(np.zeros((0, 4, 4)))) == 0
    assert mh12.evaluate(np.zeros((0, 4, 4)), FORCES).joints.shape == (0, 6)


def test_robots_of_other_texts_are_the_same_arm(tmp_path):
    rows = [[0.0, 0.0, 0.450, 0.0], [0.155, -np.pi / 2, 0.0, -np.pi / 2], [0.614, np.pi, 0.0, 0.0]]
    dh = armill.Robot.from_dh(rows, "modified", limits=[[-1, 1]] * 3, name="three")
    q = np.array([0.3, -0.2, 0.9])

    def craig(a, alpha, d, theta):
        (ca, sa), (ct, st) = (np.cos(alpha), np.sin(alpha)), (np.cos(theta), np.sin(theta))
        return np.array(
            [[ct, -st, 0, a], [st * ca, ct * ca, -sa, -sa * d], [st * sa, ct * sa, ca, ca * d], [0, 0, 0, 1]]
        )

    witness = np.eye(4)
    for (a, alpha, d, theta), angle in zip(rows, q):
        witness = witness @ craig(a, alpha, d, theta + angle)
    assert np.abs(dh.forward(q) - witness).max() < 1e-15
    assert dh.name == "three" and np.array_equal(dh.limits, [[-1, 1]] * 3)

    opw = armill.Robot.from_opw(a1=0.155, a2=-0.2, b=0.0, c1=0.45, c2=0.614, c3=0.64, c4=0.1, name="upright")
    upright = opw.forward(np.zeros(6))
    assert np.abs(upright[:3, 3] - [0.155 - 0.2, 0, 0.45 + 0.614 + 0.64 + 0.1]).max() < 1e-15
    assert np.isinf(opw.limits).all() and opw.joint_compliance is None

    file = tmp_path / "mine.toml"
    file.write_text(armill.Robot.load("yaskawa/mh12").to_toml())
    again = armill.Robot.load(file)
    q = np.full(6, 0.3)
    assert np.array_equal(again.deviation(q, [1, 2, 3]), armill.Robot.load("yaskawa/mh12").deviation(q, [1, 2, 3]))
    file.write_text(opw.to_toml())
    assert np.abs(armill.Robot.load(file).forward(q) - opw.forward(q)).max() < 1e-12


def test_a_urdf_ends_at_the_given_flange(samples):
    path = next(iter(sorted((samples / "robots").rglob("*.urdf"))), None)
    assert path is not None, "a URDF among the samples"
    whole = armill.Robot.from_urdf(path)
    assert whole.dof >= 4 and armill.Robot.load(path).dof == whole.dof
    with pytest.raises(armill.InputError, match="no_such_link"):
        armill.Robot.from_urdf(path, flange="no_such_link")


def test_other_compliances_scale_the_deviation(mh12, joints):
    twice = mh12.with_compliance(2 * mh12.joint_compliance, 0.1 * mh12.joint_compliance)
    assert np.array_equal(twice.deviation(joints, FORCES), 2 * mh12.deviation(joints, FORCES))
    again = armill.Robot.from_text(twice.to_toml(), "armill")
    # Seven digits of a compliance are written.
    assert np.abs(again.joint_compliance / twice.joint_compliance - 1).max() < 1e-6
    assert "given without a source" in twice.to_toml() and "given without" not in mh12.to_toml()
    guess = mh12.with_compliance(2 * mh12.joint_compliance, source="guess of 2026").to_toml()
    assert "guess of 2026" in guess and "identified" not in guess and "your own measurement" not in guess
    with pytest.raises(armill.InputError, match=r"compliance: expected shape \(6,\), given \(2,\)"):
        mh12.with_compliance([1e-6, 1e-6])
    with pytest.raises(armill.InputError, match="is not a number from 0 to 1"):
        mh12.with_compliance(-mh12.joint_compliance)


def without_masses() -> str:
    """The MH12 of the library without its masses."""
    text = (ROOT / "robots/yaskawa/mh12.toml").read_text()
    return re.sub(r"(?:\[\[mass\]\]|\[sources\.masses\])\n(?:.+\n)+", "", text)


def test_gravity_is_the_work_of_the_weight():
    text = without_masses()
    with pytest.raises(armill.InputError, match="no masses"):
        armill.Robot.from_text(text, "armill", "light").gravity(np.zeros(6), np.zeros(6))
    mass = '\n[[mass]]\nat = "flange"\nmass_kg = 10.0\ncentre_mm = [0.0, 0.0, 0.0]\nsource = "test"\n'
    mass += '\n[sources.test]\nwhat = "made up"\nwhere = "here"\nlicence = "none"\n'
    heavy = armill.Robot.from_text(text + mass, "armill", "heavy")
    low, high = heavy.limits.T
    q, reference = 0.6 * low + 0.4 * high, 0.5 * (low + high)
    pull = np.array([0.0, 0.0, -10.0 * 9.80665])
    witness = heavy.deviation(q, pull) - heavy.deviation(reference, pull)
    assert np.abs(heavy.gravity(q, reference) - witness).max() < 1e-12 * np.abs(witness).max() + 1e-18
    assert not heavy.gravity(reference, reference).any()


def test_modes_and_mass_matrices_need_masses():
    text = without_masses()
    light = armill.Robot.from_text(text, "armill", "light")
    for method in (light.mass_matrix, light.modes):
        with pytest.raises(armill.InputError, match="no masses"):
            method(np.zeros(6))
    mass = '\n[[mass]]\nat = "flange"\nmass_kg = 10.0\ncentre_mm = [0.0, 0.0, 0.0]\nsource = "test"\n'
    mass += '\n[sources.test]\nwhat = "made up"\nwhere = "here"\nlicence = "none"\n'
    heavy = armill.Robot.from_text(text + mass, "armill", "heavy")
    q = 0.6 * heavy.limits[:, 0] + 0.4 * heavy.limits[:, 1]
    # m J^T J of a point at the flange.
    jacobian = heavy.jacobian(q)[:3]
    witness = 10.0 * jacobian.T @ jacobian
    assert np.abs(heavy.mass_matrix(q) - witness).max() < 1e-12 * np.abs(witness).max()
    # A point has three modes; the other motions have no mass.
    modes = heavy.modes(q)
    assert np.isfinite(modes[:3, 0]).all() and np.isinf(modes[3:, 0]).all() and not modes[3:, 1:].any()


def test_a_robot_without_compliance_reports_what_to_do(joints):
    opw = armill.Robot.from_opw(a1=0.155, a2=-0.2, b=0.0, c1=0.45, c2=0.614, c3=0.64, c4=0.1)
    with pytest.raises(armill.InputError, match="with_compliance") as refused:
        opw.deviation(joints, FORCES)
    assert refused.value.problems[0]["message"] == "robot `robot` has no joint compliance"


def test_a_pickled_robot_is_equal_bit_by_bit(mh12, joints, samples):
    stiff = mh12.with_compliance(mh12.joint_compliance / 3)
    urdf = armill.Robot.load(next(iter(sorted((samples / "robots").rglob("*.urdf")))))
    for robot in (mh12, stiff):
        again = pickle.loads(pickle.dumps(robot))
        assert again.name == robot.name and again.dof == robot.dof
        assert np.array_equal(again.deviation(joints, FORCES), robot.deviation(joints, FORCES))
    q = np.full(urdf.dof, 0.1)
    assert np.array_equal(pickle.loads(pickle.dumps(urdf)).forward(q), urdf.forward(q))


def test_unknown_robots_are_refused_with_the_message_of_the_command(tmp_path):
    with pytest.raises(armill.InputError, match="did you mean `yaskawa/mh12`"):
        armill.Robot.load("yaskawa/mh21")
    broken = tmp_path / "broken.toml"
    broken.write_text('format = 1\nname = "x"\nfoo = 1\n')
    with pytest.raises(armill.InputError) as refused:
        armill.Robot.load(Path(broken))
    assert len(refused.value.problems) > 1 and refused.value.problems[0]["file"] == str(broken)
