"""Robots, studies and tables in memory are accepted where files are, and give the same answer."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest

import armill
from armill._commands import _tables
from conftest import ROOT

POSE = {"at_mm": [1000, 0, 800], "tilt_deg": 90, "tool_mm": [0, 0, 150], "wrench_n": [3, -5, 5]}
GROOVE = ROOT / "studies/mh12-groove"
CELL = """format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[3, -5, -5], [3, -5, 5]] }
[[analysis]]
kind = "map"
[[analysis]]
kind = "path"
name = "ring"
circle = { radius_mm = 100 }
"""


@pytest.fixture
def temporary(tmp_path, monkeypatch) -> Path:
    """The folder of temporary files, for this test alone: other programs have theirs elsewhere."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", None)
    return folder


def test_a_robot_is_an_operand(mh12, tmp_path, temporary):
    assert armill.pose(mh12, **POSE).json == armill.pose("yaskawa/mh12", **POSE).json
    soft = mh12.with_compliance(2 * mh12.joint_compliance, source="test")
    file = tmp_path / "mh12.toml"
    file.write_text(soft.to_toml())
    answer = armill.pose(soft, **POSE)
    assert answer.postures == armill.pose(file, **POSE).postures
    stiff = armill.pose(mh12, **POSE).postures[0]["deviation_um"]
    assert np.allclose(answer.postures[0]["deviation_um"], 2 * np.array(stiff), rtol=1e-6)
    # A robot read from a file is that of the file, whatever becomes of it.
    loaded = armill.Robot.load(file)
    file.unlink()
    assert armill.pose(loaded, **POSE).postures == answer.postures
    assert armill.robots(mh12).json == armill.robots("yaskawa/mh12").json
    assert not list(temporary.iterdir())


def test_objects_that_are_neither_are_refused():
    with pytest.raises(TypeError, match="expected a name, a path, a Robot or a Study, given int"):
        armill.pose(3, **POSE)
    with pytest.raises(TypeError, match="robot: expected a Robot, a name of the library or a path, given int"):
        armill.Study.load(GROOVE, robot=3)


def test_a_study_is_an_operand(tmp_path):
    out = {"out": tmp_path / "out", "no_pictures": True, "force": True}
    witness = armill.posture(GROOVE, **out)
    assert armill.posture(armill.Study.load(GROOVE), **out).json == witness.json
    assert armill.posture(armill.Study.load("mh12-groove"), **out).json == armill.posture("mh12-groove", **out).json
    # The text of a study that is in no file is read relative to its folder, where nothing is left.
    cell = tmp_path / "cell"
    shutil.copytree(GROOVE, cell)
    names = sorted(path.name for path in cell.iterdir())
    text = (cell / "study.toml").read_text().replace("tolerance_um", "tolerance_um ", 1)
    study = armill.Study.from_text(text, cell)
    assert armill.posture(study, **out).json == witness.json
    assert sorted(path.name for path in cell.iterdir()) == names
    with pytest.raises(armill.InputError, match="the study cannot be written to its folder"):
        armill.posture(armill.Study.from_text(text, tmp_path / "none"), **out)


@pytest.fixture
def cell(tmp_path) -> Path:
    """The folder of a study."""
    folder = tmp_path / "cell"
    folder.mkdir()
    (folder / "study.toml").write_text(CELL)
    return folder


def test_a_study_with_another_robot(mh12, cell, tmp_path):
    witness = armill.Study.from_text(CELL.replace("yaskawa/mh12", "fanuc/r2000ic"), cell).run().answer["maps"]
    assert armill.Study.load(cell).robot is None
    for robot in ("fanuc/r2000ic", armill.Robot.load("fanuc/r2000ic")):
        study = armill.Study.load(cell, robot=robot)
        assert study.robot == armill.Robot.load("fanuc/r2000ic") and study.text == CELL
        assert study.run().answer["maps"] == witness
        assert armill.Study.from_text(CELL, cell, robot=robot).run().answer["maps"] == witness
    soft = mh12.with_compliance(2 * mh12.joint_compliance)
    found, nominal = (armill.Study.load(cell, robot=robot).run() for robot in (soft, mh12))
    assert nominal.json == armill.Study.load(cell).run().json
    ratio = found.answer["maps"][0]["max_in_plane_um"] / nominal.answer["maps"][0]["max_in_plane_um"]
    assert abs(ratio - 2) < 1e-5
    # As an operand too: with a temporary file of the study and of the robot.
    out = {"out": tmp_path / "out", "no_pictures": True, "force": True}
    posture = armill.posture(armill.Study.load(cell, robot=soft), **out)
    assert posture.within_tolerance and posture.json != armill.posture(cell, **out).json
    assert [path.name for path in cell.iterdir()] == ["study.toml"]
    with pytest.raises(armill.InputError, match="did you mean `yaskawa/mh12`"):
        armill.Study.load(cell, robot="yaskawa/mh21")
    # Problems of the text are reported in its own lines.
    wrong = armill.Study.from_text(CELL + "nonsense = 3\n", cell, robot=soft)
    assert wrong.problems[0]["line"] == CELL.count("\n") + 1
    with pytest.raises(armill.InputError, match="nonsense"):
        armill.posture(wrong, **out)


def test_a_robot_is_an_option(cell, tmp_path):
    out = {"out": tmp_path / "a", "no_pictures": True, "force": True}
    named = armill.compare(cell, robot=["fanuc/r2000ic"], **out)
    given = armill.compare(armill.Study.load(cell), robot=armill.Robot.load("fanuc/r2000ic"), **out)
    assert given.json == named.json


def columns_of(file: Path) -> dict[str, np.ndarray]:
    import csv

    with open(file, newline="") as text:
        rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    return {name: np.array([float(row[name]) if row[name] else np.nan for row in rows]) for name in rows[0]}


@pytest.fixture
def tests(tmp_path, mh12) -> Path:
    """Load tests with the displacements that the robot of the library predicts."""
    plan = tmp_path / "plan.csv"
    armill.identify(plan=12, robot="yaskawa/mh12", tool_mm=[0, 0, 150], out=plan)
    columns = columns_of(plan)
    tool = np.eye(4)
    tool[2, 3] = 0.15
    joints = np.radians(np.stack([columns[f"{name}_deg"] for name in mh12.joint_names], axis=1))
    forces = np.stack([columns[f"f{axis}_n"] for axis in "xyz"], axis=1)
    moved = mh12.deviation(joints, forces, tool, paired=True)
    for i, axis in enumerate("xyz"):
        columns[f"d{axis}_mm"] = moved[:, i] * 1e3
    file = tmp_path / "tests.csv"
    _tables.write(columns, file)
    return file


def test_a_table_is_an_operand(tests, mh12, temporary):
    pandas, polars, pyarrow = (pytest.importorskip(name) for name in ("pandas", "polars", "pyarrow"))
    options = {"robot": mh12, "tool_mm": [0, 0, 150], "unknowns": "drives"}
    witness = armill.identify(tests, **options)
    columns = columns_of(tests)
    frame = pandas.DataFrame(columns)
    for table in (columns, {k: v.tolist() for k, v in columns.items()}, frame, polars.DataFrame(columns), pyarrow.table(columns)):
        assert armill.identify(table, **options).json == witness.json, type(table)
    assert not list(temporary.iterdir())
    # What is missing is an empty cell.
    holes = {name: np.ma.masked_invalid(np.where(np.arange(len(values)) == 3, np.nan, values)) for name, values in columns.items() if name == "dz_mm"}
    masked = armill.identify({**columns, **holes}, **options)
    assert masked.json == armill.identify(frame.assign(dz_mm=frame["dz_mm"].where(frame.index != 3)), **options).json
    assert masked.json != witness.json
    with pytest.raises(ValueError, match="columns of one length, given a 2, b 1"):
        armill.identify({"a": [1, 2], "b": [1]}, robot=mh12)
    with pytest.raises(ValueError, match=r"column `a` has the shape \(1, 2\)"):
        armill.identify({"a": [[1, 2]]}, robot=mh12)


def test_tables_of_several_files_and_options(tmp_path):
    angles = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    radius = 25 + 0.01 * np.cos(3 * angles)
    points = {"x_mm": radius * np.cos(angles), "y_mm": radius * np.sin(angles)}
    paths = [tmp_path / f"table-{i}.csv" for i in (1, 2)]
    for path in paths:
        _tables.write(points, path)
    by_tables = armill.roundness(points, points, harmonics=5)
    # The names of the files, without the folder.
    by_paths = armill.roundness(*paths, harmonics=5)
    assert by_tables.json == by_paths.json.replace(f"{tmp_path}/", "") and by_tables[1]["file"] == "table-2.csv"
    line = {"x_mm": np.linspace(0, 100, 30), "y_mm": np.zeros(30), "z_mm": np.zeros(30)}
    runs = [{**line, "y_mm": np.full(30, offset)} for offset in (0.1, 0.2)]
    by_tables = armill.path_accuracy(*runs, commanded=line)
    paths = [tmp_path / f"table-{i}.csv" for i in (1, 2, 3)]
    for table, path in zip([*runs, line], paths, strict=True):
        _tables.write(table, path)
    by_paths = armill.path_accuracy(*paths[:2], commanded=paths[2])
    assert by_tables.json == by_paths.json.replace(f"{tmp_path}/", "")


def test_problems_of_a_table_name_it_without_its_folder(mh12):
    with pytest.raises(armill.InputError, match=r"^error: table-1\.csv|^table-1\.csv") as refused:
        armill.identify({"A1_deg": [1.0], "nonsense": [2.0]}, robot=mh12, tool_mm=[0, 0, 150])
    assert "armill-" not in str(refused.value) + str(refused.value.problems)


def test_names_of_columns_are_given_by_name(tmp_path):
    options = armill.command_help("calibrate")
    assert "columns" in options
    with pytest.raises(armill.InputError) as refused:
        armill.calibrate({"a": [1.0]}, robot="yaskawa/mh12", columns={"x_mm": "Measured X"})
    assert "Usage" not in str(refused.value)
