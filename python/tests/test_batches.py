"""Leading axes, paired forces, samples of compliances, and arrays of the caller: each equals the same one by one."""

from __future__ import annotations

import numpy as np
import pytest

import armill

FORCES = np.array([[3.0, -5.0, 5.0], [-20.0, 4.0, 1.0]])


def test_leading_axes_are_those_of_the_result(mh12, joints, tool):
    grid = joints[:24].reshape(2, 3, 4, 6)
    for method, rest in (("forward", (4, 4)), ("jacobian", (6, 6)), ("compliance", (6, 6))):
        flat = getattr(mh12, method)(joints[:24], tool)
        found = getattr(mh12, method)(grid, tool)
        assert found.shape == (2, 3, 4, *rest)
        assert np.array_equal(found.reshape(flat.shape), flat)
    cases = np.stack([FORCES, 2 * FORCES, 3 * FORCES])
    deviation = mh12.deviation(grid, cases, tool)
    assert deviation.shape == (2, 3, 4, 3, 2, 3)
    assert np.array_equal(deviation.reshape(24, 6, 3), mh12.deviation(joints[:24], cases.reshape(6, 3), tool))
    assert mh12.contributions(grid, cases, tool).shape == (2, 3, 4, 3, 2, 6, 3)
    assert mh12.branch_of(grid) == mh12.branch_of(joints[:24])


def test_leading_axes_of_poses(mh12, joints):
    poses = mh12.forward(joints[:24])
    poses[5, 0, 3] = 9.0
    flat, grid = mh12.inverse(poses), mh12.inverse(poses.reshape(4, 6, 4, 4))
    assert len(grid) == 24 and np.array_equal(grid.joints, flat.joints)
    assert np.array_equal(grid[2, 3], flat[15]) and np.array_equal(grid[15], flat[15]) and np.array_equal(grid[-1], flat[23])
    assert "beyond" in grid.reason((0, 5)) and grid.reason((0, 5)) == flat.reason(5)
    with pytest.raises(IndexError, match="pose 6 does not exist: there are 6 poses"):
        grid[0, 6]
    with pytest.raises(IndexError, match="3 indices for 2 axes"):
        grid[0, 0, 0]
    one = mh12.evaluate(poses, FORCES, normal=[0, 0, 1])
    many = mh12.evaluate(poses.reshape(4, 6, 4, 4), FORCES, normal=[0, 0, 1])
    assert many.deviation.shape == (4, 6, 2, 3) and many.joints.shape == (4, 6, 6) and many.in_plane.shape == (4, 6)
    for name in ("reachable", "joints", "deviation", "in_plane", "worst_case", "within_limits", "contributions"):
        assert np.array_equal(getattr(many, name).ravel(), getattr(one, name).ravel(), equal_nan=True), name
    assert many.branch == one.branch and many.reason((0, 5)) == one.reason(5) is not None


def test_a_pose_that_is_none_is_named_by_its_indices(mh12, joints):
    poses = mh12.forward(joints[:6]).reshape(2, 3, 4, 4)
    poses[1, 2, 0, 0] = 3.0
    with pytest.raises(armill.InputError, match=r"poses\[1, 2\] is not a valid pose"):
        mh12.inverse(poses)


def test_paired_forces_are_one_for_each_item(mh12, joints, tool):
    forces = np.random.default_rng(5).normal(0, 50, (300, 6))
    deviation = mh12.deviation(joints, forces, tool, paired=True)
    assert deviation.shape == (300, 3)
    witness = mh12.deviation(joints[:40], forces[:40], tool)[np.arange(40), np.arange(40)]
    assert np.array_equal(deviation[:40], witness)
    contributions = mh12.contributions(joints, forces, tool, paired=True)
    assert contributions.shape == (300, 6, 3)
    assert np.abs(contributions.sum(axis=1) - deviation).max() < 1e-12 * np.abs(deviation).max()
    grid = mh12.deviation(joints.reshape(10, 30, 6), forces.reshape(10, 30, 6), tool, paired=True)
    assert np.array_equal(grid.reshape(300, 3), deviation)
    assert np.array_equal(mh12.deviation(joints[0], forces[0], tool, paired=True), deviation[0])
    for threads in (1, 3):
        assert np.array_equal(mh12.deviation(joints, forces, tool, paired=True, threads=threads), deviation)
    assert mh12.deviation(np.zeros((0, 6)), np.zeros((0, 3)), paired=True).shape == (0, 3)
    with pytest.raises(armill.InputError, match=r"forces have the leading axes \[300\], the items \[299\]"):
        mh12.deviation(joints[1:], forces, paired=True)


def test_paired_forces_at_poses(mh12, joints, tool):
    poses = mh12.forward(joints, tool)
    forces = np.random.default_rng(5).normal(0, 50, (300, 3))
    found = mh12.evaluate(poses, forces, tool, normal=[0, 0, 1], paired=True)
    assert found.deviation.shape == (300, 3) and set(found.worst_case.tolist()) <= {-1, 0}
    for i in range(0, 300, 37):
        one = mh12.evaluate(poses[i], forces[i], tool, normal=[0, 0, 1])
        for name in ("joints", "deviation", "in_plane", "normal_deviation", "contributions"):
            assert np.array_equal(getattr(found, name)[i], getattr(one, name), equal_nan=True), name
        assert found.reason(i) == one.reason() and found.branch[i] == one.branch[0]


def test_samples_of_the_compliances_are_robots_with_them(mh12, joints, tool):
    samples = mh12.joint_compliance * np.random.default_rng(4).uniform(0.5, 2.0, (5, 6))
    robots = [mh12.with_compliance(sample) for sample in samples]
    deviation = mh12.deviation(joints, FORCES, tool, compliances=samples)
    assert deviation.shape == (5, 300, 2, 3)
    assert np.array_equal(deviation, [robot.deviation(joints, FORCES, tool) for robot in robots])
    assert np.array_equal(mh12.deviation(joints, FORCES, tool, compliances=samples[1]), deviation[1])
    assert np.array_equal(mh12.compliance(joints, tool, compliances=samples)[3], robots[3].compliance(joints, tool))
    grid = mh12.contributions(joints[:6].reshape(2, 3, 6), FORCES, tool, compliances=samples[:4].reshape(2, 2, 6))
    assert grid.shape == (2, 2, 2, 3, 2, 6, 3)
    assert np.array_equal(grid[1, 0].reshape(6, 2, 6, 3), robots[2].contributions(joints[:6], FORCES, tool))
    forces = np.tile(FORCES, (150, 1))
    paired = mh12.deviation(joints, forces, tool, compliances=samples, paired=True)
    assert np.array_equal(paired[4], robots[4].deviation(joints, forces, tool, paired=True))

    poses = mh12.forward(joints, tool)
    found = mh12.evaluate(poses, FORCES, tool, branch="best", normal=[0, 0, 1], compliances=samples)
    assert found.deviation.shape == (5, 300, 2, 3) and len(found.branch) == 1500
    for i, robot in enumerate(robots):
        one = robot.evaluate(poses, FORCES, tool, branch="best", normal=[0, 0, 1])
        assert np.array_equal(found.deviation[i], one.deviation, equal_nan=True)
        assert np.array_equal(found.joints[i], one.joints, equal_nan=True)
        assert found.branch[300 * i : 300 * (i + 1)] == one.branch and found.reason((i, 7)) == one.reason(7)


def test_compliances_that_are_none_are_refused(mh12, joints):
    with pytest.raises(armill.InputError, match=r"compliances: expected shape \(\.\.\., 6\), given \(5,\)"):
        mh12.deviation(joints, FORCES, compliances=np.ones(5))
    with pytest.raises(armill.InputError, match="is not a number from 0 to 1"):
        mh12.deviation(joints, FORCES, compliances=[mh12.joint_compliance, -mh12.joint_compliance])
    # A robot without compliances of its own has those that are given.
    opw = armill.Robot.from_opw(a1=0.155, a2=-0.2, b=0.0, c1=0.45, c2=0.614, c3=0.64, c4=0.1)
    assert opw.deviation(joints, FORCES, compliances=mh12.joint_compliance).any()
    assert mh12.deviation(joints, FORCES, compliances=np.zeros((0, 6))).shape == (0, 300, 2, 3)


@pytest.mark.parametrize("count", [3, 20_000])
def test_out_is_written_and_returned(mh12, count):
    joints = np.random.default_rng(1).uniform(-0.5, 0.5, (count, 6))
    out = np.full((count, 2, 3), np.nan)
    assert mh12.deviation(joints, FORCES, out=out) is out
    assert np.array_equal(out, mh12.deviation(joints, FORCES))
    for method, rest in (("forward", (4, 4)), ("jacobian", (6, 6)), ("compliance", (6, 6))):
        into = np.empty((count, *rest))
        assert getattr(mh12, method)(joints, out=into) is into
        assert np.array_equal(into, getattr(mh12, method)(joints))
    # A part of a larger array.
    both = np.zeros((2, count, 2, 3))
    mh12.deviation(joints, FORCES, out=both[1])
    assert np.array_equal(both[1], out) and not both[0].any()


def test_an_out_that_does_not_fit_is_refused(mh12, joints):
    whole = np.zeros((300, 6, 6))
    for wrong, words in [
        (np.zeros((300, 3, 2)), r"out: expected a contiguous array of float64 with the shape \(300, 2, 3\)"),
        (np.zeros((300, 2, 6))[:, :, ::2], "out: expected a contiguous"),
        (np.asfortranarray(np.zeros((300, 2, 3))), "out: expected a contiguous"),
    ]:
        with pytest.raises(armill.InputError, match=words):
            mh12.deviation(joints, FORCES, out=wrong)
    for wrong in (np.zeros((300, 2, 3), dtype=np.float32), [[0.0]]):
        with pytest.raises(TypeError, match="out: expected a contiguous"):
            mh12.deviation(joints, FORCES, out=wrong)
    whole.flags.writeable = False
    with pytest.raises(armill.InputError, match="out: cannot be written"):
        mh12.compliance(joints, out=whole)
    # The memory of an input.
    room = np.zeros((300, 36))
    with pytest.raises(armill.InputError, match="out: cannot be written"):
        mh12.jacobian(room[:50, :6].base.reshape(-1)[:1800].reshape(300, 6), out=room.reshape(300, 6, 6))


def test_the_branch_of_joints_is_that_of_inverse(mh12, joints):
    postures = mh12.inverse(mh12.forward(joints))
    assert mh12.branch_of(postures.joints) == postures.branch
    assert mh12.branch_of(np.zeros(6)) == mh12.branch_of(np.zeros((1, 6)))
