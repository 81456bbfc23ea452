"""Arrays of any kind are accepted, or refused with the expected shape."""

from __future__ import annotations

import numpy as np
import pytest

import armill

FORCE = [3.0, -5.0, 5.0]


def misaligned(array: np.ndarray) -> np.ndarray:
    """The same numbers, one byte off."""
    room = np.zeros(array.nbytes + 1, dtype=np.uint8)
    other = room[1:].view(np.float64).reshape(array.shape)
    other[...] = array
    assert not other.flags.aligned
    return other


@pytest.mark.parametrize(
    "change",
    [
        np.asfortranarray,
        lambda a: np.repeat(a, 2, axis=0)[::2],
        lambda a: np.repeat(a, 3, axis=1)[:, ::3],
        lambda a: a[::-1][::-1],
        misaligned,
        lambda a: a.astype(">f8"),
        lambda a: a.astype(np.longdouble),
        lambda a: a.tolist(),
        lambda a: tuple(map(tuple, a)),
    ],
    ids=["fortran", "rows", "columns", "reversed", "misaligned", "endian", "longdouble", "lists", "tuples"],
)
def test_the_same_numbers_give_the_same_bits_for_any_memory_layout(mh12, joints, change):
    assert np.array_equal(mh12.deviation(change(joints), FORCE), mh12.deviation(joints, FORCE))


def test_accepts_single_precision_and_integers(mh12, joints):
    single = joints.astype(np.float32)
    assert np.array_equal(mh12.forward(single), mh12.forward(single.astype(np.float64)))
    whole = np.array([[0, 1, 0, 0, 1, 0]], dtype=np.int16)
    assert np.array_equal(mh12.forward(whole), mh12.forward(whole.astype(float)))


def test_inputs_are_never_changed_and_outputs_are_writable_copies(mh12, joints):
    before = joints.copy()
    joints.flags.writeable = False
    out = mh12.forward(joints)
    out[...] = 0.0
    assert np.array_equal(joints, before) and mh12.forward(joints).any()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (np.zeros((3, 5)), r"joints: expected shape \(\.\.\., 6\), given \(3, 5\)"),
        (np.zeros(7), r"given \(7,\)"),
        (np.zeros((2, 6, 2)), r"given \(2, 6, 2\)"),
        (np.float64(1.0), r"given \(\)"),
        ([[0, 0, 0, 0, 0, 0], [0, 0, 0, np.nan, 0, 0]], r"joints\[1, 3\] is NaN"),
        ([0, 0, np.inf, 0, 0, 0], r"joints\[2\] is inf"),
    ],
)
def test_wrong_shapes_and_numbers_are_refused(mh12, given, message):
    with pytest.raises(ValueError, match=message) as refused:
        mh12.forward(given)
    assert isinstance(refused.value, armill.InputError)


@pytest.mark.parametrize(
    "given",
    [
        np.zeros(6, dtype=complex),
        np.zeros(6, dtype=object),
        np.array(["0"] * 6),
        np.zeros(6, dtype=bool),
        np.zeros(6, dtype="datetime64[s]"),
        "yaskawa",
        None,
        {"a": 1},
        [[0, 0], [0]],
    ],
)
def test_refuses_values_that_are_not_real_numbers_with_the_expected_shape(mh12, given):
    with pytest.raises(TypeError, match=r"joints: expected real numbers of shape \(\.\.\., 6\), given"):
        mh12.forward(given)


def test_forces_of_other_widths_are_refused(mh12, joints):
    for wrong in (np.zeros(4), np.zeros((2, 5)), np.zeros((0, 3)), np.zeros((1, 3, 2)), 1.0):
        with pytest.raises(armill.InputError, match=r"forces: expected shape \(\.\.\., 3\) or \(\.\.\., 6\)"):
            mh12.deviation(joints, wrong)
    with pytest.raises(armill.InputError, match=r"forces\[1, 2\] is NaN"):
        mh12.deviation(joints, [[1, 2, 3], [1, 2, np.nan]])


def test_poses_that_are_none_are_refused_with_their_index(mh12, joints):
    poses = mh12.forward(joints)
    for change, words in [
        (lambda p: p.__setitem__((5, 0, 0), 2.0), r"poses\[5\] is not a valid pose: its axes are not of length 1"),
        (lambda p: p.__setitem__((5, 3, 0), 0.1), r"poses\[5\] is not a valid pose: the last row"),
        (lambda p: p.__setitem__((5, 1, 3), np.nan), r"poses\[5\] is not a valid pose: a number is not finite"),
        (lambda p: p.__setitem__((5, slice(0, 3), 2), -p[5, :3, 2]), r"poses\[5\] is not a valid pose: its axes are left-handed"),
    ]:
        wrong = poses.copy()
        change(wrong)
        with pytest.raises(armill.InputError, match=words):
            mh12.inverse(wrong)
        with pytest.raises(armill.InputError, match=words):
            mh12.evaluate(wrong, FORCE, normal=[0, 0, 1])
    with pytest.raises(armill.InputError, match="tool is not a valid pose"):
        mh12.forward(joints, np.zeros((4, 4)))
    for tool in (np.eye(3), np.eye(4)[:3], np.stack([np.eye(4)] * 2)):
        with pytest.raises(armill.InputError, match=r"tool: expected shape \(4, 4\), given"):
            mh12.forward(joints, tool)


def test_masked_values_are_refused(mh12, joints):
    masked = np.ma.masked_array(joints, mask=False)
    assert np.array_equal(mh12.forward(masked), mh12.forward(joints))
    masked[3, 2] = np.ma.masked
    with pytest.raises(armill.InputError, match="joints: the array has masked values"):
        mh12.forward(masked)


def test_columns_of_a_data_frame_are_put_in_the_order_of_the_joints(mh12, joints):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(joints, columns=mh12.joint_names)
    assert np.array_equal(mh12.forward(frame[mh12.joint_names[::-1]]), mh12.forward(joints))
    assert np.array_equal(mh12.forward(pandas.DataFrame(joints)), mh12.forward(joints))
    with pytest.raises(armill.InputError, match="joints: the columns are a, b, c, d, e, f, the joints are S, L, U, R, B, T"):
        mh12.forward(pandas.DataFrame(joints, columns=list("abcdef")))


def test_poses_of_other_packages_are_taken(mh12, joints):
    from scipy.spatial.transform import Rotation

    poses = mh12.forward(joints[:9])

    class SE3:
        """As spatialmath has it: `A` is a matrix, or a list of them."""

        def __init__(self, matrices):
            self.A = matrices

    pair = (Rotation.from_matrix(poses[:, :3, :3]), poses[:, :3, 3])
    witness = mh12.inverse(poses).joints
    assert np.array_equal(mh12.inverse(SE3(list(poses))).joints, witness)
    assert np.abs(mh12.inverse(pair).joints - witness).max() < 1e-9
    one = (Rotation.from_matrix(poses[0, :3, :3]), poses[0, :3, 3])
    assert np.abs(mh12.evaluate(one, FORCE, branch="best").joints - mh12.evaluate(poses[0], FORCE, branch="best").joints).max() < 1e-9
    with pytest.raises(armill.InputError, match="9 rotations and 4 translations"):
        mh12.inverse((pair[0], poses[:4, :3, 3]))


def test_refuses_invalid_options(mh12, joints):
    for threads in (0, 2000, -1, 2**70):
        with pytest.raises(armill.InputError, match="threads: .* is not a number from 1 to 1024"):
            mh12.forward(joints, threads=threads)
    with pytest.raises(TypeError, match="expected an integer, given str"):
        mh12.forward(joints, threads="two")
    poses = mh12.forward(joints)
    with pytest.raises(armill.InputError, match="branch: `sideways` is not a branch"):
        mh12.evaluate(poses, FORCE, branch="sideways", normal=[0, 0, 1])
    with pytest.raises(armill.InputError, match="normal has no direction"):
        mh12.evaluate(poses, FORCE, normal=[0, 0, 0])
    with pytest.raises(armill.InputError, match=r"home: expected shape \(6,\)"):
        mh12.inverse(poses, home=[0.0])
    with pytest.raises(armill.InputError, match="revolute and of prismatic joints"):
        armill.Robot.from_dh(np.zeros((2, 4)), "modified", prismatic=[1], limits=[[-1, 1]] * 2)
    with pytest.raises(armill.InputError, match="joint 5 does not exist"):
        armill.Robot.from_dh(np.zeros((2, 4)), "modified", prismatic=[5])
    with pytest.raises(armill.InputError, match="convention"):
        armill.Robot.from_dh(np.zeros((2, 4)), "craigish")
