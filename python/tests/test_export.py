"""Exported robots, read by other programs: the flange is where armill has it, and springs deflect as predicted."""

from __future__ import annotations

import json
import subprocess
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import armill
from conftest import ROOT

# Tolerance of rounding for arms of a few metres, m and rad.
SAME = 1e-9
# Makers with frames and signs of their own; the last one has a coupled joint.
NOMINAL = ["yaskawa/mh12", "kuka/kr210r2700extra", "abb/irb6640-185-280", "staubli/tx200", "universal-robots/ur10e", "kuka/lbr-iiwa-14-r820"]
COUPLED = "fanuc/r2000ic"
RAIL = "Ty(q1) Tz(400) Rz(37) Rx(20) Rz(A) Tx(150) Rx(-20) Rz(-37) Ry(-B) Tz(600) Rx(C) Tx(120) Ry(30) Rz(D) Tz(80) Rx(E) Tx(40) Rz(F)"


def calibrated_text(name: str, seed: int = 5) -> str:
    """The robot file with six small motions behind each joint but the last, as `armill calibrate` writes them."""
    rng = np.random.default_rng(seed)
    lines, after = [], False
    text = armill.Robot.load(name).to_toml()
    count = text.count("joint = ", 0, text.index("[[joint]]"))
    seen = 0
    for line in text.splitlines():
        lines.append(line)
        if after is False and "joint = " in line and line.lstrip().startswith("{"):
            seen += 1
            if seen == count:
                after = True
                continue
            for axis in "xyz":
                lines.append(f'  {{ along = "{axis}", length_mm = {rng.normal(0, 0.5):.6f}, symbol = "calibrated" }},')
            for axis in "xyz":
                lines.append(f'  {{ about = "{axis}", angle_deg = {rng.normal(0, 0.08):.6f}, symbol = "calibrated" }},')
    return "\n".join(lines) + "\n"


@pytest.fixture(scope="module", params=[*NOMINAL, "calibrated mh12", "calibrated ur10e", "rail"])
def arm(request, tmp_path_factory):
    """A robot and the name or file that the command takes."""
    name = request.param
    if name.startswith("calibrated"):
        library = {"calibrated mh12": "yaskawa/mh12", "calibrated ur10e": "universal-robots/ur10e"}[name]
        file = tmp_path_factory.mktemp("arm") / "arm.toml"
        file.write_text(calibrated_text(library))
    elif name == "rail":
        file = tmp_path_factory.mktemp("arm") / "arm.toml"
        text = armill.Robot.from_text(RAIL, "chain", name="rail").to_toml()
        file.write_text(text.replace("# limits_mm = [lower, upper]", "limits_mm = [-3000, 3000]"))
    else:
        return armill.Robot.load(name), name
    return armill.Robot.load(file), str(file)


def positions(robot, count=200):
    return np.random.default_rng(29).uniform(-2.8, 2.8, (count, robot.dof))


def assert_same(robot, flange_at, count=200):
    joints = positions(robot, count)
    expected = robot.forward(joints)
    worst = max(np.abs(flange_at(q) - pose).max() for q, pose in zip(joints, expected, strict=True))
    assert worst < SAME, worst


# --- independent readers


def by_yourdfpy(text, joint_names):
    yourdfpy = pytest.importorskip("yourdfpy", reason="the wheel yourdfpy is not installed")
    import io

    robot = yourdfpy.URDF.load(io.StringIO(text), load_meshes=False, load_collision_meshes=False)

    def at(q):
        robot.update_cfg(dict(zip(joint_names, q, strict=True)))
        return robot.get_transform("flange", "base_link")

    return at


def by_pinocchio(text, joint_names):
    pin = pytest.importorskip("pinocchio", reason="the wheel pin is not installed")
    model = pin.buildModelFromXML(text)
    assert [name for name in model.names if name != "universe"] == joint_names
    data = model.createData()

    def at(q):
        pin.framesForwardKinematics(model, data, pin.integrate(model, pin.neutral(model), np.asarray(q)))
        return data.oMf[model.getFrameId("flange")].homogeneous

    return at


def mujoco_model(text):
    mujoco = pytest.importorskip("mujoco", reason="the wheel mujoco is not installed")
    model = mujoco.MjModel.from_xml_string(text)
    return mujoco, model, mujoco.MjData(model)


def flange_of_mujoco(mujoco, model, data):
    site = model.site("flange").id
    pose = np.eye(4)
    pose[:3, :3] = data.site_xmat[site].reshape(3, 3)
    pose[:3, 3] = data.site_xpos[site]
    return pose


def by_mujoco(text, joint_names):
    mujoco, model, data = mujoco_model(text)

    def at(q):
        for name, value in zip(joint_names, q, strict=True):
            data.joint(name).qpos[0] = value
        mujoco.mj_kinematics(model, data)
        return flange_of_mujoco(mujoco, model, data)

    return at


def matrix_of(pose: ElementTree.Element | None) -> np.ndarray:
    """A pose of SDF: position and quaternion x, y, z, w."""
    matrix = np.eye(4)
    if pose is None or not (pose.text or "").strip():
        return matrix
    assert pose.get("rotation_format") == "quat_xyzw"
    x, y, z, i, j, k, w = map(float, pose.text.split())
    matrix[:3, :3] = np.array(
        [
            [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
            [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
            [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
        ]
    )
    matrix[:3, 3] = [x, y, z]
    return matrix


def moved(kind: str, axis: np.ndarray, q: float) -> np.ndarray:
    matrix = np.eye(4)
    if kind == "prismatic":
        matrix[:3, 3] = axis * q
    elif kind == "revolute":
        cross = np.cross(np.eye(3), axis)
        matrix[:3, :3] = np.eye(3) + np.sin(q) * cross + (1 - np.cos(q)) * cross @ cross
    return matrix


def by_drake(text, joint_names):
    """Drake reads SDF with libsdformat."""
    parsing = pytest.importorskip("pydrake.multibody.parsing", reason="the wheel drake is not installed")
    from pydrake.multibody.plant import MultibodyPlant

    plant = MultibodyPlant(0.0)
    parsing.Parser(plant).AddModelsFromString(text, "sdf")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    base = plant.GetFrameByName("base_link")
    assert np.abs(plant.CalcRelativeTransform(context, plant.world_frame(), base).GetAsMatrix4() - np.eye(4)).max() == 0

    def at(q):
        for name, value in zip(joint_names, q, strict=True):
            joint = plant.GetJointByName(name)
            (joint.set_translation if "rismatic" in type(joint).__name__ else joint.set_angle)(context, value)
        return plant.CalcRelativeTransform(context, base, plant.GetFrameByName("flange")).GetAsMatrix4()

    return at


def by_sdf(text, joint_names):
    """The frame semantics of the specification of SDF, joint by joint; `mimic` too."""
    model = ElementTree.fromstring(text).find("model")
    links = {link.get("name"): link for link in model.findall("link")}
    joints = model.findall("joint")
    frames = {frame.get("name"): frame for frame in model.findall("frame")}

    def at(q):
        given = dict(zip(joint_names, q, strict=True))
        placed = {"world": np.eye(4), "__model__": np.eye(4)}
        for joint in joints:
            parent, child = joint.findtext("parent"), joint.findtext("child")
            pose = joint.find("pose")
            here = placed[pose.get("relative_to") if pose is not None else parent] @ matrix_of(pose)
            axis = np.array([float(part) for part in (joint.findtext("axis/xyz") or "0 0 1").split()])
            mimic = joint.find("axis/mimic")
            value = given.get(joint.get("name"), 0.0)
            if mimic is not None:
                value = given[mimic.get("joint")] * float(mimic.findtext("multiplier"))
            link = links[child].find("pose")
            assert link is None or link.get("relative_to") == joint.get("name")
            placed[child] = here @ moved(joint.get("type"), axis, value) @ matrix_of(link)
        flange = frames.get("flange")
        if flange is None:
            return placed["flange"]
        return placed[flange.get("attached_to")] @ matrix_of(flange.find("pose"))

    return at


def by_table(text, joint_names):
    """A Denavit-Hartenberg table, row by row."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    convention = next(line.split(" = ")[1] for line in lines if line.startswith("convention"))
    header, *rows = [[cell.strip() for cell in line.split(",")] for line in lines if " = " not in line]

    def about(axis, angle):
        return moved("revolute", np.eye(3)[axis], angle)

    def along(axis, by):
        return moved("prismatic", np.eye(3)[axis], by)

    def at(q):
        given = dict(zip(joint_names, q, strict=True))
        pose = np.eye(4)
        for cells in rows:
            row = dict(zip(header, cells, strict=True))
            theta, d = np.radians(float(row["theta_deg"])), float(row["d_mm"]) / 1e3
            if row["type"] == "revolute":
                theta += given[row["joint"]]
            elif row["type"] == "prismatic":
                d += given[row["joint"]]
            z = about(2, theta) @ along(2, d)
            x = along(0, float(row["a_mm"]) / 1e3) @ about(0, np.radians(float(row["alpha_deg"])))
            x = x @ about(1, np.radians(float(row.get("beta_deg", 0))))
            pose = pose @ (x @ z if convention == "modified" else z @ x)
        return pose

    return at


def rpy(roll, pitch, yaw):
    return moved("revolute", np.eye(3)[2], yaw) @ moved("revolute", np.eye(3)[1], pitch) @ moved("revolute", np.eye(3)[0], roll)


def by_ur_yaml(text):
    """As urdf/ur_macro.xacro of ur_description uses the file, from the base of the controller to tool0."""
    yaml = pytest.importorskip("yaml", reason="the wheel PyYAML is not installed")
    kinematics = yaml.safe_load(text)["kinematics"]
    assert kinematics["hash"].startswith("calib_")
    links = [kinematics[name] for name in ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")]

    def at(q):
        pose = np.eye(4)
        for link, angle in zip(links, q, strict=True):
            origin = rpy(link["roll"], link["pitch"], link["yaw"])
            origin[:3, 3] = [link["x"], link["y"], link["z"]]
            pose = pose @ origin @ moved("revolute", np.eye(3)[2], angle)
        return pose

    return at


# --- geometry


@pytest.mark.parametrize("reader", [by_yourdfpy, by_pinocchio])
def test_a_urdf_has_the_flange_of_the_robot(arm, reader):
    robot, _ = arm
    assert_same(robot, reader(robot.to_urdf(), robot.joint_names))
    again = armill.Robot.from_text(robot.to_urdf(), "urdf")
    joints = positions(robot)
    assert np.abs(again.forward(joints) - robot.forward(joints)).max() < 1e-12
    assert np.allclose(again.limits, robot.limits, atol=1e-12)


def test_mujoco_has_the_flange_of_the_robot(arm):
    robot, _ = arm
    assert_same(robot, by_mujoco(robot.to_mjcf(), robot.joint_names))


@pytest.mark.parametrize("reader", [by_sdf, by_drake])
def test_an_sdf_has_the_flange_of_the_robot(arm, reader):
    robot, _ = arm
    assert_same(robot, reader(robot.to_sdf(), robot.joint_names))
    if robot.joint_compliance is not None:
        # Springs at zero do not move the flange.
        assert_same(robot, reader(robot.to_sdf(stiffness="passive"), robot.joint_names), 20)


@pytest.mark.parametrize("convention", ["standard", "modified", "hayati"])
def test_a_table_has_the_flange_of_the_robot(arm, convention):
    robot, name = arm
    if name.endswith(".toml") and convention != "hayati":
        # Axes of the calibrated arms are parallel within some 0.1 deg: the normals are hundreds of metres away.
        try:
            text = robot.to_dh(convention)
        except armill.InputError as error:
            assert "hayati" in str(error)
            return
    else:
        text = robot.to_dh(convention)
    assert_same(robot, by_table(text, robot.joint_names))
    again = armill.Robot.from_text(text, "dh")
    joints = positions(robot)
    assert np.abs(again.forward(joints) - robot.forward(joints)).max() < 1e-11


@pytest.mark.parametrize("calibrated", [False, True])
def test_a_ur_calibration_has_the_flange_of_the_robot(calibrated):
    name = "universal-robots/ur10e"
    robot = armill.Robot.from_text(calibrated_text(name), "armill") if calibrated else armill.Robot.load(name)
    text = robot.to_ur()
    assert_same(robot, by_ur_yaml(text))
    again = armill.Robot.from_text(text, "ur")
    assert_same(again, by_ur_yaml_from_base_link(text))


def by_ur_yaml_from_base_link(text):
    at = by_ur_yaml(text)
    return lambda q: rpy(0, 0, np.pi) @ at(q)


@pytest.fixture
def xacro():
    return pytest.importorskip("xacro", reason="the wheel xacro is not installed")


VENDOR = """<?xml version="1.0"?>
<robot name="vendor" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="arm.xacro"/>
  <link name="base_link"/>
{joints}
</robot>
"""


def test_macros_make_the_calibrated_robot(arm, xacro, tmp_path):
    robot, name = arm
    answer = armill.export(name, out=tmp_path / "arm.xacro")
    assert sorted(path.rsplit("/", 1)[1] for path in answer.files) == ["arm.xacro", "arm_geometry.yaml"]
    (tmp_path / "cell.xacro").write_text(
        '<robot name="cell" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="arm.xacro"/><xacro:armill_arm prefix=""/></robot>'
    )
    text = xacro.process_file(str(tmp_path / "cell.xacro")).toxml()
    assert_same(robot, by_pinocchio(text, robot.joint_names))
    # armill reads it as well.
    again = armill.Robot.load(tmp_path / "cell.xacro")
    joints = positions(robot)
    assert np.abs(again.forward(joints) - robot.forward(joints)).max() < 1e-12


def test_the_xacro_of_a_manufacturer_takes_the_calibrated_origins(xacro, tmp_path):
    """Its joints keep names, axes and links; only `<origin>` is replaced."""
    file = tmp_path / "arm.toml"
    file.write_text(calibrated_text("yaskawa/mh12"))
    robot = armill.Robot.load(file)
    armill.export(file, out=tmp_path / "arm.xacro")
    axes = {"S": "0 0 1", "L": "0 1 0", "U": "0 -1 0", "R": "-1 0 0", "B": "0 -1 0", "T": "-1 0 0"}
    parent, joints = "base_link", []
    for joint, axis in axes.items():
        joints.append(
            f'<link name="vendor_{joint}"/><joint name="{joint}" type="continuous"><parent link="{parent}"/>'
            f'<child link="vendor_{joint}"/><xacro:armill_origin joint="{joint}"/><axis xyz="{axis}"/></joint>'
        )
        parent = f"vendor_{joint}"
    joints.append(
        f'<link name="flange"/><joint name="end" type="fixed"><parent link="{parent}"/><child link="flange"/><xacro:armill_flange_origin/></joint>'
    )
    (tmp_path / "vendor.xacro").write_text(VENDOR.format(joints="\n".join(joints)))
    text = xacro.process_file(str(tmp_path / "vendor.xacro")).toxml()
    assert_same(robot, by_pinocchio(text, robot.joint_names))


def test_coupled_joints_are_written_as_decided():
    robot = armill.Robot.load(COUPLED)
    for write in (robot.to_urdf, robot.to_sdf, robot.to_mjcf, robot.to_dh):
        with pytest.raises(armill.InputError, match="J3 is coupled to joint J2"):
            write()
    own = np.eye(6)
    own[2, 1] = 1
    names = robot.joint_names
    for at in (
        by_pinocchio(robot.to_urdf(coupling="own"), names),
        by_mujoco(robot.to_mjcf(coupling="own"), names),
        by_sdf(robot.to_sdf(coupling="own"), names),
        by_table(robot.to_dh(coupling="own"), names),
    ):
        assert_same(robot, lambda q, at=at: at(own @ q))
    assert_same(robot, by_yourdfpy(robot.to_urdf(coupling="mimic"), names))
    assert_same(robot, by_sdf(robot.to_sdf(coupling="mimic"), names))
    with pytest.raises(armill.InputError, match="no joint that follows"):
        robot.to_mjcf(coupling="mimic")


def test_masses_are_those_of_the_robot():
    robot = armill.Robot.load("yaskawa/mh12")
    pin = pytest.importorskip("pinocchio", reason="the wheel pin is not installed")
    model = pin.buildModelFromXML(robot.to_urdf())
    data = model.createData()
    mujoco, simulated, state = mujoco_model(robot.to_mjcf())
    for q in positions(robot, 50):
        expected = robot.mass_matrix(q)
        upper = np.triu(pin.crba(model, data, q))
        assert np.abs(upper + np.triu(upper, 1).T - expected).max() < 1e-9 * np.abs(expected).max()
        state.qpos[:] = q
        mujoco.mj_forward(simulated, state)
        full = np.zeros((6, 6))
        mujoco.mj_fullM(simulated, state, full) if mujoco.__version__ >= "3.4" else mujoco.mj_fullM(simulated, full, state.qM)
        assert np.abs(full - expected).max() < 1e-9 * np.abs(expected).max()


# --- stiffness

ELASTIC = """
[[spring]]
at = "base"
about = "y"
compliance_rad_per_n_m = 3e-7
source = "paper"

[[spring]]
at = "L"
along = "x"
compliance_um_per_n = 0.02
source = "paper"

[[spring]]
at = "flange"
about = "x"
compliance_rad_per_n_m = 2e-6
source = "paper"
"""


def elastic_text() -> str:
    text = calibrated_text("yaskawa/mh12")
    at = text.index("[[mass]]")
    return text[:at] + ELASTIC.lstrip() + "\n" + text[at:]


def deflected(mujoco, model, data, wrench, drives):
    """Positions of static equilibrium under a wrench at the flange, by Newton's method with the forces that MuJoCo computes; `drives` do not move."""
    model.opt.gravity[:] = 0
    start = data.qpos.copy()
    site, body = model.site("flange").id, model.body("flange").id
    free = [model.jnt_dofadr[j] for j in range(model.njnt) if model.joint(j).name not in drives]
    stiffness = np.array([model.jnt_stiffness[j] for j in range(model.njnt)])
    for _ in range(20):
        mujoco.mj_forward(model, data)
        applied = np.zeros(model.nv)
        mujoco.mj_applyFT(model, data, wrench[:3], wrench[3:], data.site_xpos[site], body, applied)
        rest = (applied + data.qfrc_spring)[free]
        data.qpos[free] += rest / stiffness[free]
        if np.abs(rest).max() < 1e-12 * np.abs(applied).max():
            break
    mujoco.mj_forward(model, data)
    return data.qpos - start


@pytest.mark.parametrize("how", ["passive", "joints"])
@pytest.mark.parametrize("name", ["yaskawa/mh12", "kuka/kr210r2700extra", "staubli/tx200", "elastic"])
def test_the_deflection_in_mujoco_is_the_one_that_armill_predicts(name, how, samples_of_positions):
    robot = armill.Robot.from_text(elastic_text(), "armill") if name == "elastic" else armill.Robot.load(name)
    drives = robot.joint_names if how == "passive" else []
    for q in samples_of_positions(robot, 10):
        text = robot.to_mjcf(stiffness=how, joints=q)
        mujoco, model, data = mujoco_model(text)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        before = flange_of_mujoco(mujoco, model, data)
        assert np.abs(before - robot.forward(q)).max() < SAME
        start = data.qpos.copy()
        for force in ([100.0, 0, 0], [0, -100.0, 0], [30.0, 50.0, -80.0, 5.0, -8.0, 10.0]):
            wrench = np.zeros(6)
            wrench[: len(force)] = force
            data.qpos[:] = start
            deflected(mujoco, model, data, wrench, drives)
            found = flange_of_mujoco(mujoco, model, data)[:3, 3] - before[:3, 3]
            predicted = robot.deviation(q, wrench if len(force) == 6 else force)
            # Second order: turns of some 1e-3 rad, of a deflection.
            assert np.linalg.norm(found - predicted) < 5e-3 * np.linalg.norm(predicted), (found, predicted)
            # A hundredth of the force: the first order alone.
            data.qpos[:] = start
            deflected(mujoco, model, data, wrench / 100, drives)
            found = (flange_of_mujoco(mujoco, model, data)[:3, 3] - before[:3, 3]) * 100
            assert np.linalg.norm(found - predicted) < 5e-5 * np.linalg.norm(predicted), (found, predicted)


@pytest.fixture
def samples_of_positions():
    def sample(robot, count):
        low, high = np.clip(robot.limits.T, -3, 3)
        return low + np.random.default_rng(17).uniform(0.2, 0.8, (count, robot.dof)) * (high - low)

    return sample


def test_a_simulation_comes_to_rest_at_the_predicted_deflection():
    """Time integration of MuJoCo, with damping that the test adds: no equation of ours."""
    robot = armill.Robot.load("yaskawa/mh12")
    q = np.radians([20, 10, -20, 30, 40, 50])
    mujoco, model, data = mujoco_model(robot.to_mjcf(stiffness="joints", joints=q))
    model.opt.gravity[:] = 0
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    before = flange_of_mujoco(mujoco, model, data)
    mass = robot.mass_matrix(q)
    # Aperiodic, joint by joint.
    model.dof_damping[:] = 2 * np.sqrt(np.diag(mass) * model.jnt_stiffness)
    force = np.array([30.0, -50.0, 50.0])
    body = model.body("flange").id
    for _ in range(20_000):
        data.qfrc_applied[:] = 0
        mujoco.mj_applyFT(model, data, force, np.zeros(3), data.site_xpos[model.site("flange").id], body, data.qfrc_applied)
        mujoco.mj_step(model, data)
    assert np.abs(data.qvel).max() < 1e-9
    found = flange_of_mujoco(mujoco, model, data)[:3, 3] - before[:3, 3]
    predicted = robot.deviation(q, force)
    assert np.linalg.norm(found - predicted) < 5e-3 * np.linalg.norm(predicted)


@pytest.mark.parametrize("name", ["yaskawa/mh12", "elastic"])
def test_springs_of_an_sdf_have_the_energy_of_the_compliances_in_drake(name, samples_of_positions):
    """Generalised forces of the springs that Drake reads from the file, at deflections of the size that armill predicts."""
    parsing = pytest.importorskip("pydrake.multibody.parsing", reason="the wheel drake is not installed")
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import JacobianWrtVariable, MultibodyForces

    robot = armill.Robot.from_text(elastic_text(), "armill") if name == "elastic" else armill.Robot.load(name)
    plant = MultibodyPlant(0.0)
    parsing.Parser(plant).AddModelsFromString(robot.to_sdf(stiffness="passive"), "sdf")
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    plant.Finalize()
    context = plant.CreateDefaultContext()
    drives = [plant.GetJointByName(drive).velocity_start() for drive in robot.joint_names]
    free = [index for index in range(plant.num_velocities()) if index not in drives]
    flange = plant.GetFrameByName("flange")
    force = np.array([30.0, -50.0, 20.0])

    def spring_forces(q):
        plant.SetPositions(context, q)
        forces = MultibodyForces(plant)
        plant.CalcForceElementsContribution(context, forces)
        return forces.generalized_forces().copy()

    for joints in samples_of_positions(robot, 5):
        q = np.zeros(plant.num_positions())
        q[drives] = joints
        plant.SetPositions(context, q)
        jacobian = plant.CalcJacobianTranslationalVelocity(
            context, JacobianWrtVariable.kV, flange, np.zeros(3), plant.world_frame(), plant.world_frame()
        )[:, free]
        # Stiffness of each passive joint, from the force of its spring for a small deflection.
        stiffness = []
        for index in free:
            moved = q.copy()
            moved[index] += 1e-6
            stiffness.append(-spring_forces(moved)[index] / 1e-6)
        found = jacobian @ ((jacobian.T @ force) / np.array(stiffness))
        predicted = robot.deviation(joints, force)
        assert np.linalg.norm(found - predicted) < 1e-8 * np.linalg.norm(predicted)


def test_springs_of_an_sdf_are_the_inverse_compliances():
    robot = armill.Robot.load("yaskawa/mh12")
    q = np.radians([20, 10, -20, 30, 40, 50])
    for how, reference in (("passive", np.zeros(6)), ("joints", q)):
        text = robot.to_sdf(stiffness=how, joints=q)
        springs = {
            joint.get("name"): (float(joint.findtext("axis/dynamics/spring_stiffness")), float(joint.findtext("axis/dynamics/spring_reference")))
            for joint in ElementTree.fromstring(text).find("model").findall("joint")
            if joint.find("axis/dynamics") is not None
        }
        names = [f"{name}_spring" if how == "passive" else name for name in robot.joint_names]
        assert list(springs) == names
        found = np.array(list(springs.values()))
        assert np.allclose(found[:, 0] * robot.joint_compliance, 1, rtol=1e-12) and np.allclose(found[:, 1], reference, atol=1e-12)


# --- what is not known or not expressed


def test_stiffness_that_is_not_known_is_refused_or_marked_as_assumed(tmp_path):
    robot = armill.Robot.load("kuka/kr120r2500pro")
    with pytest.raises(armill.InputError, match="compliances of this robot are not known"):
        robot.to_mjcf(stiffness="passive")
    answer = armill.export("kuka/kr120r2500pro", format="mjcf", stiffness="passive", compliance_class="heavy")
    assert any("assumed, not measured" in warning for warning in answer.warnings)
    assert "assumed, not measured" in answer.text
    assert "stiffness" not in robot.to_mjcf().split("-->", 1)[1]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["yaskawa/mh12", "--out", "arm.step"], "is not one of a robot format"),
        (["yaskawa/mh12"], "the format of the robot is not given"),
        (["yaskawa/mh12", "--format", "xacro"], "two files"),
        (["yaskawa/mh12", "--out", "arm.yaml"], "cannot describe this robot"),
        (["fanuc/r2000ic", "--out", "arm.urdf"], "J3 is coupled to joint J2"),
        (["yaskawa/mh12", "--out", "arm.urdf", "--stiffness", "passive"], "URDF cannot express stiffness"),
        (["yaskawa/mh12", "--out", "arm.sdf", "--stiffness", "joints"], "keep one posture"),
        (["yaskawa/mh12", "--out", "arm.sdf", "--stiffness", "joints", "--joints-deg", "1,2"], "2 joint positions for 6 joints"),
        (["no/such", "--out", "arm.urdf"], "neither in the library nor a robot file"),
    ],
)
def test_what_cannot_be_written_is_one_error_and_no_file(command, tmp_path, words, message):
    ran = subprocess.run([command, "export", *words], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 2 and ran.stderr.count("error:") == 1 and message in ran.stderr
    assert ran.stdout == "" and list(tmp_path.iterdir()) == []


def test_a_file_is_replaced_by_force_only(command, tmp_path):
    (tmp_path / "arm_geometry.yaml").write_text("mine")
    words = [command, "export", "yaskawa/mh12", "--out", "arm.xacro"]
    ran = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 2 and "--force" in ran.stderr
    assert not (tmp_path / "arm.xacro").exists() and (tmp_path / "arm_geometry.yaml").read_text() == "mine"
    ran = subprocess.run([*words, "--force", "--json"], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0 and json.loads(ran.stdout)["files"] == ["arm.xacro", "arm_geometry.yaml"]


def test_meshes_of_a_urdf_are_kept(tmp_path):
    """Links, masses and meshes of the source, at the same places."""
    file = tmp_path / "arm.urdf"
    file.write_text(
        '<robot name="two"><link name="foot"><visual><origin xyz="0 0 0.1" rpy="0.1 0 0"/><geometry><mesh filename="package://two/foot.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>'
        '<link name="rod"><visual><origin xyz="0 0 0.1" rpy="0 1.5 0"/><geometry><mesh filename="rod.dae"/></geometry></visual></link>'
        '<joint name="turn" type="revolute"><parent link="foot"/><child link="rod"/><origin xyz="0 0 0.5" rpy="0.3 0 0"/><axis xyz="0.6 0 0.8"/><limit lower="-1" upper="1"/></joint></robot>'
    )
    answer = armill.export(file, format="urdf")
    assert any("rod.dae" in warning for warning in answer.warnings)
    yourdfpy = pytest.importorskip("yourdfpy", reason="the wheel yourdfpy is not installed")
    import io

    def placed(text, links):
        robot = yourdfpy.URDF.load(io.StringIO(text), load_meshes=False, build_scene_graph=True)
        robot.update_cfg({"turn": 0.7})
        found = []
        for link in links:
            visual = robot.link_map[link].visuals[0]
            found.append((visual.geometry.mesh.filename, robot.get_transform(link, robot.base_link) @ visual.origin))
        return found

    for (own, at), (theirs, expected) in zip(placed(answer.text, ["base_link", "turn_link"]), placed(file.read_text(), ["foot", "rod"]), strict=True):
        assert own == theirs and np.abs(at - expected).max() < SAME


def test_the_files_are_those_of_the_command(command, tmp_path):
    robot = armill.Robot.load("yaskawa/mh12")
    for name, text in {"urdf": robot.to_urdf(), "sdf": robot.to_sdf(), "mjcf": robot.to_mjcf(), "dh": robot.to_dh()}.items():
        ran = subprocess.run([command, "export", "yaskawa/mh12", "--format", name], cwd=tmp_path, capture_output=True, text=True)
        assert ran.returncode == 0 and ran.stdout.rstrip() == text.rstrip()
    assert (ROOT / "docs/guide/export.md").is_file()
