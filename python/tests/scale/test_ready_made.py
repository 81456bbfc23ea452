"""Predefined sweeps compared with the calls they consist of, and a large one with a killed worker."""

from __future__ import annotations

import os
import pickle
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import armill
from armill import scale
from armill.scale.fingerprint import request_of
from armill.scale.sweeps.studies import toml_of

from .conftest import Killer, busy_of_ray, manifest, sums

RING = """format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[3, -5, -5], [3, -5, 5], [3, 5, -5], [3, 5, 5]] }
[[analysis]]
kind = "path"
name = "ring"
circle = { radius_mm = 100 }
"""


@pytest.fixture
def ring(tmp_path: Path) -> armill.Study:
    return armill.Study.from_text(RING, tmp_path)


def test_placements_are_evaluated_as_a_study_with_the_part_there(ring: armill.Study) -> None:
    nominal = ring.nominal_placement()
    assert nominal.tolist() == [1.0, 0.0, 0.8, 0.0, 0.0, 0.0, 0.0]
    scores = ring.evaluate_placements([nominal, nominal + [0.05, 0.1, -0.1, 0, 0, 0, 0]])
    assert (scores.point_count, scores.case_count, len(scores)) == (360, 4, 2)
    for cost, centre in zip(scores.cost, ([1000, 0, 800], [1050, 100, 700]), strict=True):
        answer = armill.Study.from_text(RING.replace("[1000, 0, 800]", str(centre)), ".").run().answer
        assert abs(answer["paths"][0]["max_in_plane_um"] - cost * 1e6) < 1e-3, "answers have three decimals"
    assert scores.n_unreachable.tolist() == [0, 0]
    assert set(scores.branch) == {"front elbow-up no-flip"} or len(scores.branch) == 2


def test_one_placement_has_a_result_without_the_first_axis(ring: armill.Study) -> None:
    scores = ring.evaluate_placements(ring.nominal_placement())
    assert scores.cost.shape == scores.n_unreachable.shape == ()
    assert scores.cost == ring.evaluate_placements([ring.nominal_placement()]).cost[0]


def test_any_number_of_threads_gives_equal_costs(ring: armill.Study) -> None:
    places = ring.nominal_placement() + np.linspace(-0.2, 0.2, 70)[:, None] * [1, 1, 1, 1, 1, 0, 1]
    one, three = (ring.evaluate_placements(places, threads=threads) for threads in (1, 3))
    assert one.cost.tobytes() == three.cost.tobytes()
    assert one.branch == three.branch


@pytest.mark.parametrize(
    ("places", "message"),
    [
        (np.zeros((3, 5)), r"places: expected shape \(\.\.\., 6\), \(\.\.\., 7\) or \(\.\.\., 8\)"),
        (np.zeros((2, 6, 3)), "expected shape"),
        ([[0, 0, np.nan, 0, 0, 0]], r"places\[0, 2\] is"),
        (np.zeros((1, 8)), "has no rail"),
    ],
)
def test_refuses_invalid_places(ring: armill.Study, places: Any, message: str) -> None:
    with pytest.raises(armill.InputError, match=message):
        ring.evaluate_placements(places)
    with pytest.raises(armill.InputError, match="other"):
        ring.evaluate_placements(np.zeros((1, 6)), analysis="other")


def test_a_study_can_be_pickled(ring: armill.Study) -> None:
    again = pickle.loads(pickle.dumps(ring))
    assert (again.text, again.folder) == (ring.text, ring.folder)
    assert again.evaluate_placements([ring.nominal_placement()]).cost == ring.evaluate_placements([ring.nominal_placement()]).cost


def test_placements_over_coordinates(ring: armill.Study, tmp_path: Path) -> None:
    x, spin = np.linspace(0.7, 2.5, 19), np.radians([-30, 0, 30])
    sweep = scale.placements(ring, x_mm=x * 1e3, spin_deg=np.degrees(spin))
    assert sweep.evaluation_count == 19 * 3 * 360 * 4
    frame = scale.run(sweep, tmp_path / "sweep", items_per_part=10, workers=2).read().to_table()
    places = np.tile(ring.nominal_placement(), (57, 1))
    places[:, 0], places[:, 6] = np.repeat(x * 1e3 / 1e3, 3), np.tile(np.radians(np.degrees(spin)), 19)
    scores = ring.evaluate_placements(places)
    assert frame["unreachable_points"].to_pylist() == scores.n_unreachable.tolist()
    assert frame["branch"].to_pylist() == scores.branch
    assert np.allclose(frame["x_mm"], np.repeat(x, 3) * 1e3)
    assert np.allclose(frame["spin_deg"], np.tile([-30, 0, 30], 19))
    costs = frame["cost_um"].to_pylist()
    all_unreachable = scores.n_unreachable == 360
    assert all_unreachable.any()
    assert np.array_equal(np.isinf(scores.cost), ~scores.reachable)
    assert np.array_equal(scores.reachable, scores.n_unreachable == 0)
    assert np.array_equal(np.isnan(scores.cost_of_reachable), all_unreachable)
    assert not all_unreachable.all()
    assert [cost is None for cost in costs] == all_unreachable.tolist()
    assert [cost for cost in costs if cost is not None] == (scores.cost_of_reachable[~all_unreachable] * 1e6).tolist()


def test_placements_given_one_by_one(ring: armill.Study, tmp_path: Path) -> None:
    places = ring.nominal_placement()[:6] + np.linspace(0, 0.1, 7)[:, None]
    frame = scale.run(scale.placements(ring, places), tmp_path / "sweep").read().to_table()
    assert frame["cost_um"].to_pylist() == (ring.evaluate_placements(places).cost * 1e6).tolist()
    assert frame["place"].to_pylist() == list(range(7))


def test_refuses_invalid_placements(ring: armill.Study) -> None:
    with pytest.raises(armill.InputError, match="a placement has no coordinate `yaw`"):
        scale.placements(ring, yaw=[0.0])
    with pytest.raises(armill.InputError, match="is not on a rail"):
        scale.placements(ring, rail_mm=[0.0])
    with pytest.raises(armill.InputError, match="twice or not at all"):
        scale.placements(ring)
    with pytest.raises(armill.InputError, match="x_mm: expected finite numbers"):
        scale.placements(ring, x_mm=[np.inf])
    # The name without a unit, of earlier versions, gives the one with it.
    for old, new in (("x", "x_mm"), ("spin", "spin_deg")):
        with pytest.raises(armill.InputError, match=f"no coordinate `{old}`\n  help: `{new}`"):
            scale.placements(ring, **{old: [0.7]})


def test_a_file_that_a_study_names_is_part_of_the_request(tmp_path: Path) -> None:
    robot = (Path(__file__).parents[3] / "robots/yaskawa/mh12.toml").read_text()
    (tmp_path / "arm.toml").write_text(robot)
    study = armill.Study.from_text(RING.replace("yaskawa/mh12", "arm.toml"), tmp_path)
    before = request_of(scale.placements(study, x_mm=[900]))
    assert before == request_of(scale.placements(study, x_mm=[900]))
    (tmp_path / "arm.toml").write_text(robot + "\n# measured again\n")
    after = request_of(scale.placements(study, x_mm=[900]))
    assert [name for name in after if after[name] != before[name]] == ["work.files"]


def test_deviations_are_those_of_evaluate(tmp_path: Path) -> None:
    robot = armill.Robot.load("yaskawa/mh12")
    joints = np.radians(np.random.default_rng(3).uniform(-25, 25, (40, 6)) + [0, 20, -10, 0, 40, 0])
    poses = robot.forward(joints)
    poses[7, 0, 3] = 9.0
    forces = [[30.0, 0, -50], [0, 40, -50], [0, 0, -80]]
    samples = robot.joint_compliance * np.random.default_rng(4).uniform(0.8, 1.2, (5, 6))
    sweep = scale.deviations(robot, forces, poses=poses, samples=samples, normal=[0, 0, 1])
    assert sweep.evaluation_count == 5 * 40 * 3
    frame = scale.run(sweep, tmp_path, items_per_part=27, workers=2).read().to_table()
    assert frame["sample"].to_pylist() == np.repeat(np.arange(5), 120).tolist()
    assert frame["case"].to_pylist() == [0, 1, 2] * 200
    evaluations = [robot.with_compliance(sample).evaluate(poses, forces, normal=[0, 0, 1]) for sample in samples]
    expected = np.concatenate([each.deviation for each in evaluations]).reshape(-1, 3) * 1e6
    missing = np.repeat(np.concatenate([~each.reachable for each in evaluations]), 3)
    assert 0 < missing.sum() < len(missing)
    for axis, name in enumerate(("dx_um", "dy_um", "dz_um")):
        column = frame[name].to_pylist()
        assert [value is None for value in column] == missing.tolist()
        assert [value for value in column if value is not None] == expected[~missing, axis].tolist()
    branches = np.concatenate([each.branch for each in evaluations])
    assert frame["branch"].to_pylist() == np.repeat(branches, 3).tolist()


def test_deviations_at_joints_are_those_of_deviation(tmp_path: Path) -> None:
    robot = armill.Robot.load("yaskawa/mh12")
    joints = np.radians(np.random.default_rng(3).uniform(-25, 25, (40, 6)) + [0, 20, -10, 0, 40, 0])
    # Another branch than the nominal one, and a joint beyond its limit.
    joints[3:6, 4] *= -1
    joints[8, 1] = robot.limits[1, 1] + 0.1
    forces = [[30.0, 0, -50], [0, 40, -50]]
    samples = robot.joint_compliance * np.random.default_rng(4).uniform(0.8, 1.2, (3, 6))
    frame = scale.run(scale.deviations(robot, forces, joints=joints, samples=samples), tmp_path, items_per_part=27).read().to_table()
    expected = robot.deviation(joints, forces, compliances=samples).reshape(-1, 3) * 1e6
    for axis, name in enumerate(("dx_um", "dy_um", "dz_um")):
        assert frame[name].to_pylist() == expected[:, axis].tolist()
    branches = robot.branch_of(joints)
    assert len(set(branches)) == 3
    assert frame["branch"].to_pylist() == np.tile(np.repeat(branches, 2), 3).tolist()
    within = np.ones(40, dtype=bool)
    within[8] = False
    assert frame["within_joint_limits"].to_pylist() == np.tile(np.repeat(within, 2), 3).tolist()
    assert frame["joints"].to_pylist() == np.tile(np.repeat(np.arange(40), 2), 3).tolist()


def test_refuses_invalid_deviations() -> None:
    robot = armill.Robot.load("yaskawa/mh12")
    pose = robot.forward(np.zeros((1, 6)))
    with pytest.raises(armill.InputError, match=r"samples: .* shape \(n, 6\), given \(1, 5\)"):
        scale.deviations(robot, [0, 0, 1], poses=pose, samples=np.ones(5))
    with pytest.raises(armill.InputError, match=r"poses: expected shape \(n, 4, 4\)"):
        scale.deviations(robot, [0, 0, 1], poses=pose[0])
    with pytest.raises(armill.InputError, match=r"joints: expected shape \(n, 6\)"):
        scale.deviations(robot, [0, 0, 1], joints=np.zeros(6))
    with pytest.raises(ValueError, match="forces"):
        scale.deviations(robot, [0, 0], poses=pose)
    with pytest.raises(armill.InputError, match="both or not at all"):
        scale.deviations(robot, [0, 0, 1])
    with pytest.raises(armill.InputError, match="`branch` applies to poses"):
        scale.deviations(robot, [0, 0, 1], joints=np.zeros((1, 6)), branch="best")


def test_sweeps_take_a_robot_in_place_of_that_of_the_study(ring: armill.Study, tmp_path: Path) -> None:
    robot = armill.Robot.load("yaskawa/mh12")
    soft = robot.with_compliance(2 * robot.joint_compliance, source="test")
    study = armill.Study.from_text(RING, robot=soft)
    places = ring.nominal_placement()[None]
    again = scale.run(scale.placements(study, places), tmp_path / "places").read().to_table()["cost_um"][0].as_py()
    once = ring.evaluate_placements(places).cost[0] * 1e6
    # A robot file has seven digits of a compliance.
    assert abs(again / once - 2) < 1e-5
    frame = scale.run(scale.studies([ring, study], robots=[robot, soft]), tmp_path / "studies", items_per_part=1).read().to_table()
    largest = np.array(frame["max_in_plane_um"].to_pylist())
    assert np.abs(largest / largest[0] - [1, 2, 1, 2]).max() < 1e-3
    frame = scale.run(scale.studies([ring, study]), tmp_path / "two", items_per_part=1).read().to_table()
    assert np.abs(np.array(frame["max_in_plane_um"].to_pylist()) / largest[:2] - 1).max() < 1e-12


def test_studies_with_robots_and_changes(ring: armill.Study, tmp_path: Path) -> None:
    robots = ["yaskawa/mh12", "fanuc/r2000ic"]
    sweep = scale.studies(
        [ring],
        [{}, {"plane.centre_mm": [1050, 50, 700]}],
        robots=robots,
        columns={"full_um": "paths.0.max_full_um", "roundness_um": "paths.0.roundness_um"},
    )
    frame = scale.run(sweep, tmp_path / "sweep", items_per_part=1).read().to_table()
    changed = RING.replace("[1000, 0, 800]", "[1050, 50, 700]")
    for row, (robot, text) in enumerate((robot, text) for robot in robots for text in (RING, changed)):
        answer = armill.Study.from_text(text.replace("yaskawa/mh12", robot), ".").run().answer
        assert frame["answer"][row].as_py() == answer["answer"]
        assert frame["max_in_plane_um"][row].as_py() == answer["paths"][0]["max_in_plane_um"]
        assert frame["roundness_um"][row].as_py() == answer["paths"][0]["roundness_um"]
        assert frame["warnings"][row].as_py() == len(answer["warnings"])


def test_reports_an_invalid_change_before_the_first_run(ring: armill.Study) -> None:
    with pytest.raises(armill.InputError, match="tolerance_um"):
        scale.studies([ring], [{}, {"tolerance_um": -1}])


def test_reports_a_column_missing_in_the_result(ring: armill.Study, tmp_path: Path) -> None:
    sweep = scale.studies([ring], columns={"x": "paths.7.roundness_um"})
    with pytest.raises(scale.SweepFailed, match=r"the result has no `paths\.7\.roundness_um`"):
        scale.run(sweep, tmp_path / "sweep", items_per_part=1)


def test_toml_tables_are_written_as_they_are_read() -> None:
    tomllib = pytest.importorskip("tomllib")
    table = {"a": 1, "b c": {"d": [1.5, 1e-300, -0.0], "e": [{"f": True}, {}]}, "g": 'x"\\\n\x7f\u00b5\t', "h": []}
    assert tomllib.loads(toml_of(table)) == table


# ---- 10^8 evaluations


@pytest.fixture(scope="session")
def large(tmp_path_factory: pytest.TempPathFactory) -> scale.Plan:
    """A ring of 360 points under 4 cases at 70 000 placements: 1.008e8 evaluations in 70 parts."""
    ring = armill.Study.from_text(RING, tmp_path_factory.mktemp("ring"))
    axes = {"x_mm": np.linspace(800, 1100, 50), "y_mm": np.linspace(-200, 200, 40), "spin_deg": np.linspace(-35, 35, 35)}
    plan = scale.plan(scale.placements(ring, **axes), items_per_part=1000)
    assert plan.sweep.evaluation_count > 1e8
    return plan


@pytest.fixture(scope="session")
def undisturbed(large: scale.Plan, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Its parts, made by threads of one process."""
    folder = tmp_path_factory.mktemp("undisturbed")
    scale.run(large, folder / "sweep")
    found = sums(folder / "sweep")
    shutil.rmtree(folder)
    return found


@pytest.mark.filterwarnings("default")
def test_a_hundred_million_on_dask_with_a_killed_worker_equal_an_undisturbed_run(
    large: scale.Plan, undisturbed: list[str], client: Any, tmp_path: Path
) -> None:
    pids = client.run(os.getpid)
    killer = Killer(tmp_path, 10, lambda: next(iter(pids.values())))
    done = scale.run(large, tmp_path, client)
    assert 10 <= killer.join() < 70, "killed in the middle"
    assert (done.part_count, done.rows) == (70, 70_000)
    assert sums(tmp_path) == undisturbed
    assert manifest(tmp_path)["complete"]


@pytest.mark.filterwarnings("default")
def test_a_hundred_million_on_ray_with_a_killed_worker_equal_an_undisturbed_run(
    large: scale.Plan, undisturbed: list[str], four_of_ray: Any, tmp_path: Path
) -> None:
    killer = Killer(tmp_path, 10, busy_of_ray)
    scale.run(large, tmp_path, "ray")
    assert 10 <= killer.join() < 70, "killed in the middle"
    assert sums(tmp_path) == undisturbed
