"""The same point has the same deviation, shares and uncertainty through `Robot.evaluate` and in the table of a study."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import armill
from conftest import ROOT

MH12 = ROOT / "robots/yaskawa/mh12.toml"

# What the robot file of an MH12 has in addition: every source of deviation that needs no study.
PARTS = """
[[spring]]
at = "L"
about = "x"
compliance_rad_per_n_m = 8e-7
compliance_u_rad_per_n_m = 1e-7
source = "test"

[[spring]]
at = "base"
about = "y"
compliance_rad_per_n_m = 5e-8
compliance_u_rad_per_n_m = 1e-8
source = "test"

[repeatability]
pose_mm = 0.08
source = "test"

[model_error]
percent = 9.4
source = "test"

[sources.test]
what = "made up"
where = "this test"
licence = "none"
"""
BACKLASH = """compliance_u_source = "assumed"
backlash_deg = 0.008
backlash_u_deg = 0.001
backlash_side = "torque"
backlash_source = "test"
"""
STUDY = """format = 1
robot = "worn.toml"
tolerance_um = 100
posture = { branch = "front elbow-up no-flip" }
plane = { centre_mm = [950, 50, 750], tilt_deg = 25, half_size_mm = 100, step_mm = 100 }
[load]
cases_n = [[60, -35, 20], [-20, 50, 30]]
[tool]
flange_from_tool_mm_deg = [60, 0, 150, 0, 30, 0]
[[analysis]]
kind = "map"
name = "plate"
"""


def test_a_point_is_the_same_in_an_evaluation_and_in_a_table(tmp_path: Path) -> None:
    worn = MH12.read_text(encoding="utf-8").replace('compliance_u_source = "assumed"\n', BACKLASH)
    assert worn.count("backlash_deg") > 1
    (tmp_path / "worn.toml").write_text(worn + PARTS, encoding="utf-8")
    table = armill.Study.from_text(STUDY, tmp_path).run().table("plate")
    robot = armill.Robot.load(tmp_path / "worn.toml")
    joints = np.radians(np.stack([table[f"joint_{name}_deg"] for name in robot.joint_names], axis=1))
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    flange_from_tool = np.array([[c, 0, s, 0.06], [0, 1, 0, 0], [-s, 0, c, 0.15], [0, 0, 0, 1]])
    poses = robot.forward(joints, flange_from_tool)
    forces = np.array([[60.0, -35.0, 20.0], [-20.0, 50.0, 30.0]])
    found = robot.evaluate(poses, forces, flange_from_tool, branch="front elbow-up no-flip")
    assert found.reachable.all()
    for given, column in [
        (found.in_plane, "in_plane_um"),
        (found.in_plane_uncertainty, "in_plane_u_um"),
        (found.normal_deviation, "normal_um"),
        (found.magnitude, "full_um"),
    ]:
        np.testing.assert_allclose(given * 1e6, table[column], rtol=1e-9, err_msg=column)
    for index, name in enumerate(robot.contributors):
        shares = found.contributions[:, index] * 1e6
        np.testing.assert_allclose(shares, table[f"share_{name}_um"], rtol=1e-7, atol=1e-9, err_msg=name)
    np.testing.assert_array_equal(found.worst_case + 1, table["worst_case"])
