"""Clearance of armill against the library coal, with the collision meshes of real arms.

    python -m venv coal && coal/bin/pip install coal==3.0.3 xacro==2.1.1 trimesh==5.2.0 numpy==2.4.6
    cargo build --release --package armill-validation --example clearances
    coal/bin/python validation/clearance-coal/compare.py FOLDER [--count 10000]

FOLDER contains the ROS packages of ARMS and those that they include, next to each other.

armill reads the xacro file, its meshes and a study with four obstacles; of this it prints the least distance and its two bodies.
Here xacro expands the same file, numpy multiplies the transforms along the URDF, trimesh reads the meshes and coal gives the distances.
Joint positions are random within the limits of the URDF. Lengths in m, joint positions in rad.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

import coal
import numpy as np
import trimesh
import xacro

ARMS = {
    "Yaskawa MH12": "motoman_mh12_support/urdf/mh12.xacro",
    "KUKA KR 120 R2500 pro": "kuka_kr120_support/urdf/kr120r2500pro.xacro",
    "FANUC M-20iA": "fanuc_m20ia_support/urdf/m20ia.xacro",
}
PROGRAM = Path(__file__).resolve().parents[2] / "target/release/examples/clearances"
SEED = 1
TOLERANCE_MM = 1e-3

# The obstacles, in m: the same numbers are in the study.
BOX = ([0.6, 0.4, 0.0], [1.0, 0.7, 1.2])
CYLINDER = ([-0.5, -1.0, 0.0], [-0.5, -1.0, 1.5], 0.15)
CAPSULE = ([0.2, -1.2, 1.6], [1.2, -1.2, 1.6], 0.1)
TORUS_AT = [0.9, -0.4, 1.1]


def study(robot: str, torus: str) -> str:
    def mm(point):
        return "[" + ", ".join(f"{1e3 * x:.1f}" for x in point) + "]"

    def round_body(body):
        return f"{{ from = {mm(body[0])}, to = {mm(body[1])}, diameter = {2e3 * body[2]:.1f} }}"

    return f"""format = 1
robot = "{robot}"
tolerance_um = 100
compliance = {{ class = "light" }}
plane = {{ centre_mm = [900, 0, 300], tilt_deg = 90, half_size_mm = 200, step_mm = 20 }}
load = {{ cases_n = [[3, 5, 5]] }}
[[obstacle]]
name = "box"
box_mm = {{ from = {mm(BOX[0])}, to = {mm(BOX[1])} }}
[[obstacle]]
name = "cylinder"
cylinder_mm = {round_body(CYLINDER)}
[[obstacle]]
name = "capsule"
capsule_mm = {round_body(CAPSULE)}
[[obstacle]]
name = "torus"
mesh = "{torus}"
mesh_unit = "m"
base_from_obstacle_mm_deg = [{", ".join(f"{1e3 * x:.1f}" for x in TORUS_AT)}, 0, 0, 0]
"""


def expanded(folder: Path, file: str) -> ET.Element:
    """The URDF of a xacro file, with $(find PACKAGE) as a folder."""
    with tempfile.TemporaryDirectory() as copy:
        for source in folder.glob("*/urdf/*"):
            target = Path(copy) / source.relative_to(folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            text = source.read_text()
            for package in folder.iterdir():
                text = text.replace(f"$(find {package.name})", f"{copy}/{package.name}")
            target.write_text(text)
        return ET.fromstring(xacro.process_file(f"{copy}/{file}").toxml())


def transform(element) -> np.ndarray:
    """The transform of an <origin>."""
    if element is None:
        return np.eye(4)
    angles = [float(x) for x in element.get("rpy", "0 0 0").split()]
    result = trimesh.transformations.euler_matrix(*angles, "sxyz")
    result[:3, 3] = [float(x) for x in element.get("xyz", "0 0 0").split()]
    return result


def solid(mesh: trimesh.Trimesh):
    """A mesh of coal."""
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(mesh.faces), len(mesh.vertices))
    vertices, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in mesh.vertices:
        vertices.append(np.asarray(vertex, dtype=float))
    for face in mesh.faces:
        faces.append(coal.Triangle(*(int(corner) for corner in face)))
    model.addSubModel(vertices, faces)
    model.endModel()
    return model


def at_end(shape, body):
    """A round body of coal, whose axis is z about its centre, between two points."""
    start, end = (np.asarray(point, dtype=float) for point in body[:2])
    length = np.linalg.norm(end - start)
    frame = trimesh.geometry.align_vectors([0, 0, 1], (end - start) / length)
    frame[:3, 3] = 0.5 * (start + end)
    return shape(body[2], length), frame


class Arm:
    """The arm of a URDF, whose packages are in `folder`."""

    def __init__(self, root: ET.Element, folder: Path):
        self.joints = []
        for joint in root.findall("joint"):
            axis = joint.find("axis")
            self.joints.append(
                (
                    joint.get("type"),
                    joint.find("parent").get("link"),
                    joint.find("child").get("link"),
                    transform(joint.find("origin")),
                    [float(x) for x in axis.get("xyz").split()] if axis is not None else None,
                    joint.find("limit"),
                )
            )
        children = {child for _, _, child, *_ in self.joints}
        self.root = next(link.get("name") for link in root.findall("link") if link.get("name") not in children)
        self.bodies = {}
        for link in root.findall("link"):
            collision = link.find("collision")
            if collision is not None:
                shape = collision.find("geometry/mesh")
                path = folder / shape.get("filename").removeprefix("package://")
                mesh = trimesh.load(path, process=False)
                scale = [float(x) for x in shape.get("scale", "1 1 1").split()]
                mesh.apply_scale(scale)
                self.bodies[link.get("name")] = (solid(mesh), transform(collision.find("origin")))
        # The number of turning joints between base and link.
        self.rank = {self.root: 0}
        open_joints = list(self.joints)
        while open_joints:
            joint = open_joints.pop(0)
            if joint[1] in self.rank:
                self.rank[joint[2]] = self.rank[joint[1]] + (joint[0] != "fixed")
            else:
                open_joints.append(joint)
        turning = [joint for joint in self.joints if joint[0] != "fixed"]
        turning.sort(key=lambda joint: self.rank[joint[2]])
        self.limits = [[float(joint[5].get(end)) for end in ("lower", "upper")] for joint in turning]

    def frames(self, positions):
        """The frame of each link."""
        found = {self.root: np.eye(4)}
        waiting = list(self.joints)
        while waiting:
            kind, parent, child, origin, axis, _ = joint = waiting.pop(0)
            if parent not in found:
                waiting.append(joint)
                continue
            found[child] = found[parent] @ origin
            if kind != "fixed":
                turn = trimesh.transformations.rotation_matrix(positions[self.rank[child] - 1], axis)
                found[child] = found[child] @ turn
        return found


def placed(frame):
    return coal.Transform3s(frame[:3, :3], frame[:3, 3])


def distance(first, second, limit):
    """Distance of two bodies; 0 in contact, `limit` where the balls around them are farther apart."""
    (one, at), (other, there) = first, second
    balls = [frame.transform(shape.aabb_center) for shape, frame in (first, second)]
    if np.linalg.norm(balls[0] - balls[1]) - one.aabb_radius - other.aabb_radius > limit:
        return limit
    if coal.collide(one, at, other, there, coal.CollisionRequest(), coal.CollisionResult()) > 0:
        return 0.0
    request = coal.DistanceRequest()
    request.rel_err = request.abs_err = 0.0
    # The usual 1e-6 would leave boxes and cylinders up to half a micrometre away.
    request.gjk_tolerance = 1e-9
    request.gjk_max_iterations = 1000
    return coal.distance(one, at, other, there, request, coal.DistanceResult())


def least(arm: Arm, pairs, obstacles, positions):
    """The least distance of all pairs, m."""
    frames = arm.frames(positions)
    bodies = {name: (shape, placed(frames[name] @ local)) for name, (shape, local) in arm.bodies.items()}
    best = np.inf
    for first, second in pairs:
        best = min(best, distance(bodies[first], bodies[second], best))
    for name, body in bodies.items():
        if arm.rank[name] > 0:
            for obstacle in obstacles:
                best = min(best, distance(body, obstacle, best))
    return best


def compare(folder: Path, title: str, file: str, count: int, program: Path) -> bool:
    arm = Arm(expanded(folder, file), folder)
    numbers = np.random.default_rng(SEED)
    limits = np.array(arm.limits)
    all_positions = numbers.uniform(limits[:, 0], limits[:, 1], size=(count, len(limits)))
    torus = trimesh.creation.torus(major_radius=0.2, minor_radius=0.05, major_sections=48, minor_sections=24)
    with tempfile.TemporaryDirectory() as place:
        # armill takes meshes from the folder of the study alone.
        shutil.copytree(folder, place, dirs_exist_ok=True)
        # Binary STL has single precision: both programs read this file.
        torus.export(f"{place}/torus.stl")
        Path(place, "cell.toml").write_text(study(file, "torus.stl"))
        torus = trimesh.load(f"{place}/torus.stl")
        lines = "".join(",".join(f"{x:.15g}" for x in np.degrees(q)) + "\n" for q in all_positions)
        command = [program, f"{place}/cell.toml"]
        answer = subprocess.run(command, input=lines, capture_output=True, text=True, check=False)
        if answer.returncode != 0:
            sys.exit(answer.stderr)
    first, *rest = answer.stdout.splitlines()
    left_out = {frozenset(pair.split(":")) for pair in first.split(",") if pair}
    names = sorted(arm.bodies, key=lambda name: arm.rank[name])
    pairs = [
        (one, other)
        for index, one in enumerate(names)
        for other in names[index + 1 :]
        if arm.rank[other] - arm.rank[one] > 1 and {one, other} not in left_out
    ]
    here = np.eye(4)
    box, box_at = coal.Box(*np.subtract(BOX[1], BOX[0])), here.copy()
    box_at[:3, 3] = 0.5 * np.add(*BOX)
    torus_at = here.copy()
    torus_at[:3, 3] = TORUS_AT
    obstacles = [(box, box_at), at_end(coal.Cylinder, CYLINDER), at_end(coal.Capsule, CAPSULE), (solid(torus), torus_at)]
    obstacles = [(shape, placed(frame)) for shape, frame in obstacles]
    for shape in [shape for shape, _ in arm.bodies.values()] + [shape for shape, _ in obstacles]:
        shape.computeLocalAABB()
    differences, contacts, unequal = [], 0, 0
    for index, (positions, line) in enumerate(zip(all_positions, rest, strict=True)):
        ours = float(line.split(",")[0])
        theirs = 1e3 * least(arm, pairs, obstacles, positions)
        contacts += theirs <= 0.0
        if (ours > 0.0) != (theirs > 0.0):
            unequal += 1
            print(f"  {title}, posture {index}: armill {line}, coal {theirs:.9f} mm")
        elif theirs > 0.0:
            differences.append(abs(ours - theirs))
            if differences[-1] > TOLERANCE_MM:
                print(f"  {title}, posture {index}: armill {line}, coal {theirs:.9f} mm")
    worst = 1e3 * max(differences)
    print(
        f"{title}: {count} postures, {contacts} in contact, contact differs in {unequal}, "
        f"largest difference of the others {worst:.2g} um; pairs in contact in every posture: {sorted(map(sorted, left_out)) or 'none'}",
        flush=True,
    )
    return unequal == 0 and worst <= 1e3 * TOLERANCE_MM


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("folder", type=Path, help="the folder of the ROS packages")
    options.add_argument("--count", type=int, default=10_000, help="postures of each arm")
    options.add_argument("--program", type=Path, default=PROGRAM, help="the example clearances of armill-validation")
    given = options.parse_args()
    passed = [compare(given.folder, title, file, given.count, given.program) for title, file in ARMS.items()]
    sys.exit(0 if all(passed) else 1)


if __name__ == "__main__":
    main()
