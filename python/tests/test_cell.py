"""Clearances of a study with a cell: by hand, in tables and answers."""

from __future__ import annotations

import numpy as np

import armill
from conftest import ROOT

# Tool down on a plane 300 mm above the base; a spindle of 120 mm diameter, whose end is 80 mm above the tip, next to a wall.
STUDY = f"""format = 1
robot = {str(ROOT / "validation/urdf-forward/mh12.urdf")!r}
compliance = {{ class = "light" }}
tolerance_um = 1000
tool = {{ flange_from_tool_mm_deg = [0, 0, 280, 0, 0, 0], body = [
  {{ name = "spindle", cylinder_mm = {{ from = [0, 0, 0], to = [0, 0, 200], diameter = 120 }} }},
] }}
plane = {{ centre_mm = [900, 0, 300], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }}
load = {{ cases_n = [[3, 5, 5]] }}
[floor]
height_mm = 0
[[obstacle]]
name = "wall"
box_mm = {{ from = [1080, -1000, 0], to = [1100, 1000, 2000] }}
"""


def test_the_clearance_of_every_point_is_that_by_hand():
    result = armill.Study.from_text(STUDY, ROOT).run()
    table = result.table("map")
    by_hand = 1080 - 60 - table["x_mm"]
    assert len(table) == 25 and np.ptp(table["x_mm"]) > 150
    assert np.allclose(table["clearance_mm"], by_hand, atol=1e-3)
    answer = result.answer["maps"][0]
    assert answer["nearest"] == ["spindle", "wall"]
    assert np.isclose(answer["least_clearance_mm"], np.min(table["clearance_mm"]), atol=1e-6)
    assert "map-clearance" in result.pictures


def test_the_floor_is_the_nearest_where_it_is_near():
    text = STUDY.replace("height_mm = 0", "height_mm = -10").replace("0, 300]", "0, 0]")
    result = armill.Study.from_text(text, ROOT).run()
    # The end of the spindle is 80 mm above the tip.
    assert np.allclose(np.max(result.table("map")["clearance_mm"]), 90, atol=1e-3)
    problem = STUDY.replace("height_mm = 0", "height_mm = 50")
    problems = armill.Study.from_text(problem, ROOT).problems
    assert any("the floor at 50 mm is above the base" in one["message"] for one in problems)


def test_the_bodies_of_a_robot_are_in_its_data(tmp_path):
    file = tmp_path / "bodies.svg"
    found = armill.robots("yaskawa/mh12", drawing=file, bodies=True)
    assert {body["shape"] for body in found["bodies"]} <= {"capsule", "box", "cylinder"}
    assert all(body["accuracy_mm"] > 0 for body in found["bodies"])
    assert f"{len(found['bodies'])} bodies of its links" in file.read_text()
