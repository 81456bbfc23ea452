"""The post-processor and the import script with the matrices of the package robodk, and armill as witness."""

from __future__ import annotations

import importlib.util
import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import armill
import numpy as np
import pytest
from robodk import robolink
from robodk.robomath import Mat, eye, pose_2_xyzrpw, rotx, roty, rotz, transl

import to_robodk

HERE = Path(__file__).parent
ROBOT = armill.Robot.load("fanuc/r2000ic")
TOOL = transl(10, 20, 250) * rotx(0.1) * rotz(0.3)
FRAME = transl(1600, 100, 800) * rotz(0.4) * rotx(0.05)
START = np.radians([5, 10, -25, 8, -60, 20])


def post():
    spec = importlib.util.spec_from_file_location("Armill", HERE / "posts/Armill.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def mm(pose: np.ndarray) -> Mat:
    """base_from_tool of armill, m -> Mat, mm."""
    scaled = np.array(pose)
    scaled[:3, 3] *= 1000
    return Mat(scaled.tolist())


def metres(pose: Mat) -> np.ndarray:
    scaled = np.array(pose.Rows(), float)
    scaled[:3, 3] /= 1000
    return scaled


def reached(joints: np.ndarray) -> Mat:
    return mm(ROBOT.forward(joints, metres(TOOL)))


def written(folder: Path, frame: Mat = FRAME) -> tuple[object, list[Mat]]:
    """A program with a joint move, straight moves with a rotation, and an arc; returns the post and the poses of its targets."""
    made = post().RobotPost(None, "Fanuc R-2000iC", 6)
    start = reached(START)
    poses = [start, start * transl(60, 0, 0), start * transl(60, 40, 0) * rotz(0.2) * rotx(0.15), start * transl(90, 55, 0), start * transl(120, 40, 0)]
    joints = [0.0] * 6
    made.ProgStart("Pocket 1")
    made.setFrame(frame, 1, "Part")
    made.setTool(TOOL, 1, "Spindle")
    local = [frame.inv() * pose for pose in poses]
    made.MoveJ(local[0], np.degrees(START).tolist())
    made.RunCode("SpindleOn(9000)", True)
    made.setSpeed(10)
    made.MoveL(local[1], joints)
    made.MoveL(local[2], joints)
    made.setSpeed(5)
    made.MoveC(local[3], joints, local[4], joints)
    made.ProgFinish("Pocket 1")
    made.ProgSave(str(folder), "Pocket 1")
    return made, poses


def run(folder: Path) -> tuple[dict, dict[str, np.ndarray]]:
    study = folder / "pocket-1.toml"
    study.write_text(study.read_text(encoding="utf-8").replace('"MAKER/MODEL"', '"fanuc/r2000ic"'), encoding="utf-8")
    command = shutil.which("armill") or str(Path(sys.executable).parent / "armill")
    done = subprocess.run([command, "run", str(study), "--no-pictures", "--out", str(folder / "out")], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = (folder / "out/pocket-1.csv").read_text(encoding="utf-8").splitlines()
    names = rows[0].split(",")
    cells = [row.split(",") for row in rows[1:]]
    return json.loads((folder / "out/result.json").read_text(encoding="utf-8")), {
        name: np.array([float(row[i]) if re.fullmatch(r"-?[\d.e-]+", row[i]) else np.nan for row in cells]) for i, name in enumerate(names)
    }


def test_armill_follows_the_program_with_the_same_joints(tmp_path: Path) -> None:
    made, poses = written(tmp_path)
    assert made.LOG == ""
    result, columns = run(tmp_path)
    joints = np.radians(np.column_stack([columns[f"joint_{name}_deg"] for name in ROBOT.joint_names]))
    tips = ROBOT.forward(joints, metres(TOOL))
    for pose in (*poses[:3], poses[4]):
        # Every target is a point of the path, with its position and its rotation about all three axes; poses[3] is on the arc.
        near = int(np.argmin(np.linalg.norm(tips[:, :3, 3] - metres(pose)[:3, 3], axis=1)))
        assert np.abs(tips[near] - metres(pose)).max() < 2e-6
    assert np.abs(joints[0] - START).max() < 1e-5
    # On the arc every point has the distance of the circle through the three targets, within the chord.
    a, b, c = (metres(pose)[:3, 3] for pose in poses[2:])
    sides = [np.linalg.norm(b - c), np.linalg.norm(c - a), np.linalg.norm(a - b)]
    radius = np.prod(sides) / (2 * np.linalg.norm(np.cross(b - a, c - a)))
    weights = [sides[i] ** 2 * (sides[i - 2] ** 2 + sides[i - 1] ** 2 - sides[i] ** 2) for i in range(3)]
    centre = (weights[0] * a + weights[1] * b + weights[2] * c) / sum(weights)
    on_arc = np.isclose(columns["feed_mm_per_s"], 5)
    off = np.linalg.norm(tips[on_arc][:, :3, 3] - centre, axis=1) - radius
    assert on_arc.sum() > 50 and np.abs(off).max() < 1.5e-6
    assert result["paths"][0]["unreachable"] == 0


def test_a_turned_frame_changes_only_the_numbers(tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    columns = []
    for folder, frame in ((first, FRAME), (second, transl(900, -200, 500) * roty(math.pi / 3) * rotz(1.0))):
        folder.mkdir()
        written(folder, frame)
        columns.append(run(folder)[1])
    for name in ("x_mm", "y_mm", "z_mm", "full_um", "joint_J6_deg"):
        first_values, second_values = columns[0][name], np.interp(columns[0]["distance_mm"], columns[1]["distance_mm"], columns[1][name])
        assert np.abs(first_values - second_values).max() < 1e-2 * np.ptp(first_values), name


def test_the_way_back_gives_the_poses(tmp_path: Path) -> None:
    _, poses = written(tmp_path)
    points = to_robodk.read(tmp_path / "pocket-1.csv")
    assert points[0]["rapid"] and points[1]["feed"] == 600
    for pose, point in ((poses[0], points[0]), (poses[1], points[1]), (poses[-1], points[-1])):
        found = to_robodk.pose_of(point, FRAME)
        assert np.abs(np.array(found.Rows()) - np.array((FRAME.inv() * pose).Rows())).max() < 2e-6


class Item:
    """An item of a station that records what is done with it."""

    def __init__(self, station: "Station", pose: Mat | None = None, valid: bool = True) -> None:
        self.station, self.pose, self.valid = station, pose, valid

    def Valid(self) -> bool:
        return self.valid

    def PoseAbs(self) -> Mat:
        return self.pose

    def Parent(self) -> "Item":
        return Item(self.station, eye(4))

    def setPose(self, pose: Mat) -> None:
        self.pose = pose

    def __getattr__(self, name: str):
        # A method that the real item does not have is an error.
        getattr(robolink.Item, name)
        return lambda *values: self.station.calls.append((name, *values))


class Station:
    def __init__(self, missing: str | None = None) -> None:
        self.calls, self.missing = [], missing

    def Item(self, name: str, kind: int) -> Item:
        return Item(self, FRAME if kind == robolink.ITEM_TYPE_FRAME else eye(4), valid=name != self.missing)

    def AddProgram(self, name: str, robot: Item) -> Item:
        return Item(self)

    def AddTarget(self, name: str, parent: Item, robot: Item) -> Item:
        return Item(self)

    def Render(self, always: bool) -> None:
        self.calls.append(("Render", always))


def test_program_in_a_station(tmp_path: Path) -> None:
    _, poses = written(tmp_path)
    points = to_robodk.read(tmp_path / "pocket-1.csv")
    station = Station()
    to_robodk.build(station, points, "Pocket", "Part", "Spindle", 1.0)
    moves = [call for call in station.calls if call[0] in ("MoveJ", "MoveL")]
    assert [name for name, _ in moves[:2]] == ["MoveJ", "MoveL"] and len(moves) == len(points)
    assert [call[1] for call in station.calls if call[0] == "setSpeed"] == [10.0, 5.0]
    assert np.abs(np.array((FRAME * moves[-1][1].pose).Rows()) - np.array(poses[-1].Rows())).max() < 2e-6
    assert (to_robodk.ROBOT, to_robodk.FRAME, to_robodk.TOOL) == (robolink.ITEM_TYPE_ROBOT, robolink.ITEM_TYPE_FRAME, robolink.ITEM_TYPE_TOOL)
    for name in ("Item", "AddProgram", "AddTarget", "Render"):
        assert hasattr(robolink.Robolink, name)


def test_errors(tmp_path: Path) -> None:
    points = [{"x_mm": 0, "y_mm": 0, "z_mm": 0, "i": 0, "j": 0, "k": 1, "spin_deg": 0, "feed": None, "rapid": False}]
    with pytest.raises(ValueError, match="no reference frame Part"):
        to_robodk.build(Station("Part"), points, "a", "Part", "Spindle")
    table = tmp_path / "a.csv"
    table.write_text("x_mm,y_mm,z_mm\n1,2,3\n")
    with pytest.raises(ValueError, match="no column i, j, k, spin_deg"):
        to_robodk.read(table)
    table.write_text("x_mm,y_mm,z_mm,i,j,k,spin_deg\n1,2,x,0,0,1,0\n")
    with pytest.raises(ValueError, match=r"a\.csv:2: could not convert"):
        to_robodk.read(table)
    assert to_robodk.main([str(tmp_path / "none.csv"), "--frame", "a", "--tool", "b"]) == 2
    made = post().RobotPost(None, "KUKA", 6)
    made.MoveJ(None, [1.0, 2.0])
    assert made.LOG.startswith("a move to joints 1 2 is left out") and not made.rows
    with pytest.raises(ValueError, match="external axes"):
        made.MoveL(eye(4), [0.0] * 7)
    made.setSpeed(10)
    made.MoveL(transl(1, 0, 0), [0.0] * 6)
    made.setTool(transl(0, 0, 9))
    assert "differs from the tool of the first move" in made.LOG
    made.MoveC(transl(2, 0, 0), [0.0] * 6, transl(3, 0, 0), [0.0] * 6)
    assert "two straight moves" in made.LOG and len(made.rows) == 3


@pytest.mark.parametrize("turn", [rotx(math.pi), roty(math.pi), rotz(math.pi) * rotx(0.0), rotx(1e-7), rotx(2.0) * rotz(1.0)])
def test_rotations_between_poses(turn: Mat) -> None:
    module = post()
    a = transl(1, 2, 3) * rotz(0.7)
    b = a * transl(5, 0, 0) * turn
    assert np.abs(np.array(module.on_line(a, b, 1.0).Rows()) - np.array(b.Rows())).max() < 1e-9
    half = module.on_line(a, b, 0.5)
    assert module.turn_between(a, half) == pytest.approx(module.turn_between(a, b) / 2, abs=1e-6)


def test_spin_is_that_of_armill() -> None:
    joints = np.radians([[10, 20, -30, 40, 50, 60], [0, 0, 0, 0, -90, 0]])
    for pose in ROBOT.forward(joints, metres(TOOL)):
        point = {"i": -pose[0, 2], "j": -pose[1, 2], "k": -pose[2, 2], "x_mm": 0, "y_mm": 0, "z_mm": 0, "spin_deg": post().spin(mm(pose))}
        found = to_robodk.pose_of(point, eye(4))
        assert np.abs(np.array(found.Rows())[:3, :3] - pose[:3, :3]).max() < 1e-9
    assert pose_2_xyzrpw(eye(4)) == [0, 0, 0, 0, 0, 0]
