"""Arms converted to other packages and back have equal kinematics, evaluated by these packages."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import armill
from armill import interop

ARMS = ["yaskawa/mh12", "kuka/kr120r2500pro"]
# Tolerance of rounding for arms of a few metres, m and rad.
SAME = 1e-9

# A rail, an axis along no coordinate axis, joints with reversed signs.
SKEW = "Ty(q1) Tz(400) Rz(37) Rx(20) Rz(A) Tx(150) Rx(-20) Rz(-37) Ry(-B) Tz(600) Rx(C) Tx(120) Ry(30) Rz(D) Tz(80) Rx(E) Tx(40) Rz(F)"

COUPLED = """
format = 1
name = "coupled"

[chain]
source = "made up"
motions = [
  { along = "z", length_mm = 400 },
  { about = "y", joint = "A" },
  { along = "z", length_mm = 600 },
  { about = "y", joint = "B" },
  { along = "x", length_mm = 500 },
]

[[joint]]
name = "A"
sign = 1
source = "made up"

[[joint]]
name = "B"
sign = 1
coupling = [{ joint = "A", factor = -1 }]
source = "made up"

[sources."made up"]
what = "a test"
where = "here"
licence = "none"
"""


@pytest.fixture(params=[*ARMS, "skew"])
def arm(request):
    if request.param == "skew":
        return armill.Robot.from_text(SKEW, "chain", name="skew")
    return armill.Robot.load(request.param)


@pytest.fixture
def rtb():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("roboticstoolbox", reason="the wheel roboticstoolbox-python is not installed")


@pytest.fixture
def pin():
    return pytest.importorskip("pinocchio", reason="the wheel pin is not installed")


def positions(dof):
    return np.random.default_rng(23).uniform(-2.5, 2.5, (100, dof))


def by_toolbox(ets, joints):
    return np.array([ets.fkine(q).A for q in joints]), np.array([ets.jacob0(q) for q in joints])


def by_pinocchio(pin, model, frame, joints):
    data, of = model.createData(), model.getFrameId(frame)
    poses, jacobians = [], []
    for q in joints:
        at = pin.integrate(model, pin.neutral(model), q)
        pin.computeJointJacobians(model, data, at)
        pin.updateFramePlacements(model, data)
        poses.append(data.oMf[of].homogeneous.copy())
        jacobians.append(pin.getFrameJacobian(model, data, of, pin.LOCAL_WORLD_ALIGNED).copy())
    return np.array(poses), np.array(jacobians)


def assert_equal_kinematics(arm, others):
    joints = positions(arm.dof)
    poses, jacobians = others(joints)
    assert np.abs(arm.forward(joints) - poses).max() < SAME
    assert np.abs(arm.jacobian(joints) - jacobians).max() < SAME


def test_the_toolbox_has_the_kinematics_of_the_arm(rtb, arm):
    ets = interop.to_ets(arm)
    assert_equal_kinematics(arm, lambda joints: by_toolbox(ets, joints))
    limited = np.isfinite(arm.limits).all(axis=1)
    limits = np.array([joint.qlim for joint, known in zip(ets.joints(), limited) if known])
    assert not limited.any() or np.allclose(limits, arm.limits[limited])


def test_converts_an_arm_to_the_toolbox_and_back(rtb, arm):
    back = interop.from_ets(interop.to_ets(arm), name="again")
    joints = positions(arm.dof)
    assert np.abs(back.forward(joints) - arm.forward(joints)).max() < SAME
    assert np.allclose(back.limits, arm.limits) and back.dof == arm.dof and back.name == "again"


def test_converts_a_robot_of_the_toolbox(rtb):
    puma = rtb.models.DH.Puma560()
    arm = interop.from_ets(puma)
    assert_equal_kinematics(arm, lambda joints: by_toolbox(puma.ets(), joints))
    # The closed form of the arm is kept.
    assert {arm.inverse(pose).branch[0].count(" ") for pose in arm.forward(0.5 * np.ones((1, 6)))} == {2}


def test_pinocchio_has_the_kinematics_of_the_arm(pin, arm):
    model = interop.to_pinocchio(arm)
    assert_equal_kinematics(arm, lambda joints: by_pinocchio(pin, model, "flange", joints))
    assert list(model.names)[1:] == arm.joint_names
    limits = np.column_stack([model.lowerPositionLimit, model.upperPositionLimit])
    assert np.allclose(limits, arm.limits)


def test_converts_an_arm_to_pinocchio_and_back(pin, arm):
    back = interop.from_pinocchio(interop.to_pinocchio(arm))
    joints = positions(arm.dof)
    assert np.abs(back.forward(joints) - arm.forward(joints)).max() < SAME
    assert back.joint_names == arm.joint_names and np.allclose(back.limits, arm.limits)


def test_converts_a_model_of_pinocchio(pin):
    model = pin.buildSampleModelManipulator()
    arm = interop.from_pinocchio(model)
    assert_equal_kinematics(arm, lambda joints: by_pinocchio(pin, model, model.frames[-1].name, joints))


def test_compliances_can_be_given_after_a_conversion(rtb):
    mh12 = armill.Robot.load("yaskawa/mh12")
    back = interop.from_ets(interop.to_ets(mh12)).with_compliance(mh12.joint_compliance)
    joints = positions(6)
    assert np.allclose(back.deviation(joints, [3, -5, 5]), mh12.deviation(joints, [3, -5, 5]), atol=1e-12)


def test_refuses_what_cannot_be_converted(rtb, pin):
    coupled = armill.Robot.from_text(COUPLED, "armill")
    for over in (interop.to_ets, interop.to_pinocchio):
        with pytest.raises(ValueError, match="differs by .* coupled joints"):
            over(coupled)
    with pytest.raises(TypeError, match="expected a roboticstoolbox.ETS, given int"):
        interop.from_ets(3)
    swapped = rtb.ET.Rz(jindex=1) * rtb.ET.tx(1.0) * rtb.ET.Ry(jindex=0)
    with pytest.raises(ValueError, match=r"joints are numbered \[1, 0\]: expected 0 to 1 from base on"):
        interop.from_ets(swapped)
    with pytest.raises(TypeError, match="expected a pinocchio.Model, given int"):
        interop.from_pinocchio(3)
    with pytest.raises(ValueError, match="the model has no frame 'tip'; it has universe"):
        interop.from_pinocchio(interop.to_pinocchio(armill.Robot.load("yaskawa/mh12")), "tip")
    with pytest.raises(ValueError, match="degrees of freedom|side branches"):
        interop.from_pinocchio(pin.buildSampleModelHumanoid())


def test_accepts_poses_of_spatialmath_and_scipy(rtb):
    spatialmath = pytest.importorskip("spatialmath")
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    mh12 = armill.Robot.load("yaskawa/mh12")
    poses = mh12.forward(positions(6)[:5] * 0.3)
    expected = mh12.inverse(poses)
    tool = np.eye(4)
    tool[:3, 3] = [0, 0.02, 0.15]
    for given in (
        spatialmath.SE3(list(poses), check=False),
        (rotation.from_matrix(poses[:, :3, :3]), poses[:, :3, 3]),
    ):
        assert np.allclose(mh12.inverse(given).joints, expected.joints, atol=1e-9)
        assert mh12.evaluate(given, [0, 0, -50], normal=[0, 0, 1]).reachable.all()
    single = spatialmath.SE3(poses[0], check=False)
    assert np.allclose(mh12.inverse(single).joints, expected[0], atol=1e-9)
    assert np.allclose(mh12.forward(np.zeros(6), spatialmath.SE3(tool)), mh12.forward(np.zeros(6), tool))


def urdf_with_inertials(rng: np.random.Generator) -> str:
    """Six joints about axes in arbitrary directions and one that slides; a body of random inertia on each link, and on two that are fixed."""

    def numbers(values):
        return " ".join(repr(float(value)) for value in values)

    def body():
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        inertia = turn @ np.diag(rng.uniform(1, 2, 3)) @ turn.T
        entries = [("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)]
        inertia = " ".join(f'{key}="{float(inertia[i, j])!r}"' for key, i, j in entries)
        origin = f'<origin xyz="{numbers(rng.uniform(-0.4, 0.4, 3))}" rpy="{numbers(rng.uniform(-3, 3, 3))}"/>'
        return f'<inertial>{origin}<mass value="{float(rng.uniform(1, 200))!r}"/><inertia {inertia}/></inertial>'

    links, joints, parent = ['<link name="base_link"/>'], [], "base_link"
    for index in range(7):
        links.append(f'<link name="l{index}">{body()}</link>')
        axis = rng.normal(size=3) if index % 2 else np.eye(3)[index % 3] * (-1) ** (index // 2)
        kind = "prismatic" if index == 3 else "revolute"
        origin = f'<origin xyz="{numbers(rng.uniform(-0.6, 0.6, 3))}" rpy="{numbers(rng.uniform(-3, 3, 3))}"/>'
        limit = '<limit lower="-3" upper="3" effort="0" velocity="0"/>'
        joints.append(
            f'<joint name="j{index}" type="{kind}"><parent link="{parent}"/><child link="l{index}"/>{origin}'
            f'<axis xyz="{numbers(axis / np.linalg.norm(axis))}"/>{limit}</joint>'
        )
        parent = f"l{index}"
    for name, parent in [("box", "l2"), ("tool0", "l6")]:
        links.append(f'<link name="{name}">{body()}</link>')
        origin = f'<origin xyz="{numbers(rng.uniform(-0.6, 0.6, 3))}" rpy="{numbers(rng.uniform(-3, 3, 3))}"/>'
        joints.append(
            f'<joint name="to_{name}" type="fixed"><parent link="{parent}"/><child link="{name}"/>{origin}</joint>'
        )
    return f'<robot name="bodies">{"".join(links)}{"".join(joints)}</robot>'


def test_mass_matrices_of_a_urdf_are_those_of_pinocchio(pin):
    rng = np.random.default_rng(41)
    text = urdf_with_inertials(rng)
    arm = armill.Robot.from_text(text, "urdf", name="bodies")
    model = pin.buildModelFromXML(text)
    assert arm.dof == model.nq == 7
    joints = rng.uniform(-3, 3, (10_000, 7))
    ours, data = arm.mass_matrix(joints), model.createData()
    worst = 0.0
    for q, found in zip(joints, ours, strict=True):
        upper = np.triu(pin.crba(model, data, q))
        expected = upper + np.triu(upper, 1).T
        worst = max(worst, np.abs(found - expected).max() / np.abs(expected).max())
    # A few hundred roundings of sums of bodies of up to 200 kg at up to 5 m.
    assert worst < 1e-10


def test_modes_solve_the_equation_of_motion_with_the_mass_matrix_of_pinocchio(pin):
    rng = np.random.default_rng(43)
    text = urdf_with_inertials(rng)
    compliance = rng.uniform(1e-7, 1e-5, 7)
    arm = armill.Robot.from_text(text, "urdf", name="bodies").with_compliance(compliance)
    model = pin.buildModelFromXML(text)
    data = model.createData()
    joints = rng.uniform(-3, 3, (100, 7))
    modes = arm.modes(joints)
    assert modes.shape == (100, 7, 8)
    for q, found in zip(joints, modes, strict=True):
        upper = np.triu(pin.crba(model, data, q))
        mass = upper + np.triu(upper, 1).T
        squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, np.diag(1 / compliance))).real)
        assert np.abs((2 * np.pi * found[:, 0]) ** 2 / squares - 1).max() < 1e-8
        # The modes make up the compliance at the tool.
        shapes = found[:, 2:]
        still = (shapes / ((2 * np.pi * found[:, 0]) ** 2)[:, None]).T @ shapes
        expected = arm.compliance(q[None])[0]
        assert np.abs(still - expected).max() < 1e-9 * np.abs(expected).max()
    assert np.all(modes[:, :, 1] == 0.03)


def test_masses_of_a_model_of_pinocchio_are_converted(pin):
    rng = np.random.default_rng(3)
    model = pin.buildSampleModelManipulator()
    for joint in range(1, model.njoints):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        inertia = turn @ np.diag(rng.uniform(1, 2, 3)) @ turn.T
        model.inertias[joint] = pin.Inertia(float(rng.uniform(1, 20)), rng.normal(0, 0.2, 3), inertia)
    robot = interop.from_pinocchio(model)
    data = model.createData()
    for q in rng.uniform(-1, 1, (5, model.nv)):
        upper = np.triu(pin.crba(model, data, q))
        expected = upper + np.triu(upper, 1).T
        assert np.allclose(robot.mass_matrix(q), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_masses_at_inclined_axes_are_converted(pin):
    rng = np.random.default_rng(4)
    model = pin.Model()
    parent = 0
    for joint in range(4):
        axis = rng.normal(size=3)
        place = pin.SE3(pin.exp3(rng.normal(size=3)), rng.normal(0, 0.3, 3))
        parent = model.addJoint(parent, pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis)), place, f"j{joint}")
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        inertia = turn @ np.diag(rng.uniform(1, 2, 3)) @ turn.T
        model.appendBodyToJoint(parent, pin.Inertia(2.0 + joint, rng.normal(0, 0.2, 3), inertia), pin.SE3.Identity())
    model.addFrame(pin.Frame("tool0", parent, pin.SE3(np.eye(3), np.array([0.1, 0.0, 0.2])), pin.FrameType.OP_FRAME))
    robot = interop.from_pinocchio(model)
    data = model.createData()
    for q in rng.uniform(-1, 1, (5, 4)):
        upper = np.triu(pin.crba(model, data, q))
        expected = upper + np.triu(upper, 1).T
        assert np.allclose(robot.mass_matrix(q), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
