"""Results behave as containers do: rows, columns, indices, copies, equality, notebooks."""

from __future__ import annotations

import copy
import pickle
import re

import numpy as np
import pytest

import armill
from conftest import ROOT

FORCES = np.array([[3.0, -5.0, 5.0], [-20.0, 4.0, 1.0]])
GROOVE = ROOT / "studies/mh12-groove"


@pytest.fixture(scope="session")
def result() -> armill.Result:
    return armill.Study.load(GROOVE).run()


@pytest.fixture(scope="session")
def table(result: armill.Result) -> armill.Table:
    return result.table()


def test_columns_of_a_table_are_arrays(table):
    import pyarrow

    arrow = pyarrow.table(table)
    for name in table.columns:
        column, values = table[name], arrow[name].to_pylist()
        assert len(column) == len(table)
        if np.ma.isMaskedArray(column) or column.dtype.kind == "f":
            missing = np.ma.getmaskarray(column) if np.ma.isMaskedArray(column) else np.isnan(column)
            assert [value is None for value in values] == missing.tolist(), name
            assert [value for value in values if value is not None] == np.ma.getdata(column)[~missing].tolist(), name
        else:
            assert column.tolist() == values, name
    assert table["x_mm"].dtype == np.float64 and table["worst_case"].dtype == np.int64
    with pytest.raises(KeyError, match="no column `x`: it has"):
        table["x"]


def test_pandas_takes_a_table_as_it_is(table):
    pandas = pytest.importorskip("pandas")
    frame = table.to_pandas()
    again = pandas.DataFrame(table)
    assert list(frame.columns) == list(again.columns) == table.columns
    assert len(frame) == len(again) == len(table)
    assert np.array_equal(frame["in_plane_um"], table["in_plane_um"], equal_nan=True)
    assert np.array_equal(again["in_plane_um"], table["in_plane_um"], equal_nan=True)
    assert str(frame["worst_case"].dtype) in {"int64", "Int64"}
    rows = list(table)
    assert len(rows) == len(table) and list(rows[0]) == table.columns
    assert rows[7]["x_mm"] == table["x_mm"][7]


def test_missing_integers_stay_integers(tmp_path):
    import pyarrow
    import pyarrow.parquet

    text = (GROOVE / "study.toml").read_text()
    far = armill.Study.from_text(text.replace("half_size_mm = ", "half_size_mm = 900 # ", 1).replace("step_mm = ", "step_mm = 100 # ", 1), GROOVE)
    result = far.run()
    table = result.table()
    cases = table["worst_case"]
    assert np.ma.isMaskedArray(cases) and cases.dtype == np.int64 and 0 < cases.mask.sum() < len(cases)
    assert set(cases.compressed().tolist()) <= {1, 2, 3, 4, 5, 6, 7, 8}
    assert str(table.to_pandas()["worst_case"].dtype) == "Int64"
    again = pickle.loads(pickle.dumps(table))
    assert pyarrow.table(again).equals(pyarrow.table(table), check_metadata=True)
    # The file has integers too.
    result.write(tmp_path, pictures=False)
    slug = re.sub(r"[\W_]+", "-", result.analyses[0].lower()).strip("-")
    written = pyarrow.parquet.read_table(tmp_path / f"{slug}.parquet")["worst_case"]
    assert written.type == pyarrow.int64() and written.null_count == cases.mask.sum()
    assert [case for case in written.to_pylist() if case is not None] == cases.compressed().tolist()


def test_tables_and_results_are_pickled(result):
    import pyarrow

    again = pickle.loads(pickle.dumps(result))
    assert again.json == result.json and again.sentence == result.sentence and again.warnings == result.warnings
    assert again.analyses == result.analyses and again.pictures == result.pictures
    for name in result.analyses:
        assert pyarrow.table(again.table(name)).equals(pyarrow.table(result.table(name)), check_metadata=True)
        assert again.table(name).name == result.table(name).name
    with pytest.raises(armill.InputError, match="a result that was pickled cannot be written"):
        again.write("nowhere")
    assert pickle.loads(pickle.dumps(again)).json == result.json


def test_evaluations_and_postures_are_pickled(mh12, joints):
    poses = mh12.forward(joints)
    poses[3, 0, 3] = 9.0
    evaluation, postures = mh12.evaluate(poses, FORCES, normal=[0, 0, 1]), mh12.inverse(poses)
    for again in (pickle.loads(pickle.dumps(evaluation)), copy.deepcopy(evaluation)):
        for name in (
            "reachable", "joints", "deviation", "in_plane", "in_plane_uncertainty", "normal_deviation", "magnitude",
            "worst_case", "within_limits", "contributions",
        ):  # fmt: skip
            ours, theirs = getattr(evaluation, name), getattr(again, name)
            assert ours.dtype == theirs.dtype and ours.shape == theirs.shape and ours.tobytes() == theirs.tobytes(), name
        assert (again.branch, again.singularity) == (evaluation.branch, evaluation.singularity)
        assert again.reason(3) == evaluation.reason(3) is not None and len(again) == 300
    again = pickle.loads(pickle.dumps(postures))
    for name in ("joints", "pose_index", "offsets", "within_limits"):
        assert np.array_equal(getattr(again, name), getattr(postures, name)), name
    assert again.branch == postures.branch and again.reason(3) == postures.reason(3)
    assert np.array_equal(again[5], postures[5]) and pickle.loads(pickle.dumps(again)).branch == postures.branch


def test_placement_evaluations_are_pickled():
    study = armill.Study.from_text(
        (GROOVE / "study.toml").read_text() + '\n[[analysis]]\nkind = "path"\nname = "ring"\ncircle = { radius_mm = 50 }\n', GROOVE
    )
    places = study.nominal_placement("ring") + np.linspace(0, 0.4, 6).reshape(2, 3, 1) * [1, 1, 0, 0, 0, 0, 0]
    found = study.evaluate_placements(places, analysis="ring")
    assert found.cost.shape == found.reachable.shape == (2, 3) and len(found) == 6
    again = pickle.loads(pickle.dumps(found))
    for name in ("cost", "cost_of_reachable", "n_unreachable", "reachable"):
        assert np.array_equal(getattr(again, name), getattr(found, name), equal_nan=True), name
    assert (again.branch, again.point_count, again.case_count) == (found.branch, found.point_count, found.case_count)


def test_a_study_is_pickled_with_its_robot(mh12):
    study = armill.Study.load(GROOVE, robot=mh12.with_compliance(2 * mh12.joint_compliance))
    again = pickle.loads(pickle.dumps(study))
    assert again.robot == study.robot and again.run().answer["maps"] == study.run().answer["maps"]


def test_postures_are_a_sequence(mh12, joints):
    postures = mh12.inverse(mh12.forward(joints[:5]))
    each = list(postures)
    assert len(each) == 5 and all(np.array_equal(each[i], postures[i]) for i in range(5))
    assert np.array_equal(postures[np.int64(-1)], each[4])
    assert [len(part) for part in postures[1:4]] == [len(part) for part in each[1:4]]
    assert [part.tolist() for part in postures[::-2]] == [part.tolist() for part in each[::-2]]
    with pytest.raises(TypeError):
        postures["first"]


def test_joints_of_one_position_give_one_result(mh12):
    q = np.full(6, 0.1)
    assert mh12.forward(q).shape == (4, 4) and mh12.jacobian(q).shape == (6, 6) and mh12.compliance(q).shape == (6, 6)
    assert mh12.deviation(q, [1, 2, 3]).shape == (3,) and mh12.contributions(q, [1, 2, 3]).shape == (6, 3)


def test_robots_are_equal_where_their_texts_are(mh12, tmp_path):
    other = armill.Robot.load("yaskawa/mh12")
    assert mh12 == other and hash(mh12) == hash(other) and mh12 == pickle.loads(pickle.dumps(mh12))
    soft = mh12.with_compliance(2 * mh12.joint_compliance)
    assert mh12 != soft and soft == mh12.with_compliance(2 * mh12.joint_compliance)
    assert mh12 != armill.Robot.load("fanuc/r2000ic") and mh12 != "yaskawa/mh12"
    assert len({mh12, other, soft}) == 2


def test_an_answer_is_the_dict_or_list_that_it_holds():
    answer = armill.pose("yaskawa/mh12", at_mm=[1000, 0, 800])
    assert list(answer) == list(answer.data) == list(answer.keys()) and dict(answer) == answer.data
    assert "robot" in answer and "nonsense" not in answer and len(answer) == len(answer.data)
    assert dict(answer.items()) == answer.data and list(answer.values()) == list(answer.data.values())
    assert answer.get("robot") == answer["robot"] and answer.get("nonsense", 3) == 3
    assert answer == armill.pose("yaskawa/mh12", at_mm=[1000, 0, 800]) != armill.pose("yaskawa/mh12", at_mm=[900, 0, 800])
    again = pickle.loads(pickle.dumps(answer))
    assert again == answer and again.data == answer.data
    library = armill.robots()
    assert list(library) == library.data and len(library) == len(library.data)


def test_notebooks_show_tables(mh12, result, table):
    assert "<td>S</td>" in mh12._repr_html_() and "MH12" in mh12._repr_html_()
    shown = table._repr_html_()
    assert shown.count("<tr>") == 11 and "<th>x_mm</th>" in shown
    assert f"<b>{result.sentence}</b>" in result._repr_html_().replace("&lt;", "<")
    evaluation = mh12.evaluate(mh12.forward(np.full(6, 0.2)), [0, 0, -50])
    assert "in_plane" in evaluation._repr_html_()
    answer = armill.pose("yaskawa/mh12", at_mm=[1000, 0, 800])
    assert "<th>postures</th>" in answer._repr_html_() and "<script" not in answer._repr_html_()
    assert "<table>" in armill.robots()._repr_html_()


def test_results_become_dicts_frames_and_data_sets(mh12, joints):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    poses = mh12.forward(joints[:12])
    poses[3, 0, 3] = 9.0
    flat = mh12.evaluate(poses, FORCES, normal=[0, 0, 1])
    assert list(flat.to_dict()) == [
        "reachable", "joints", "deviation", "in_plane", "in_plane_uncertainty", "normal_deviation", "magnitude",
        "worst_case", "within_limits", "contributions", "branch", "singularity",
    ]  # fmt: skip
    frame = flat.to_pandas()
    assert frame.index.name == "pose" and len(frame) == 12 and frame.attrs["units"]["joints_L"] == "rad"
    assert np.array_equal(frame["deviation_1_z"], flat.deviation[:, 1, 2], equal_nan=True)
    assert np.array_equal(frame["contributions_U"], flat.contributions[:, 2], equal_nan=True) and frame["branch"].tolist() == flat.branch
    assert isinstance(frame, pandas.DataFrame) and frame["worst_case"].dtype == np.int64

    grid = mh12.evaluate(poses.reshape(3, 4, 4, 4), FORCES, normal=[0, 0, 1])
    data = grid.to_xarray(dims=["row", "column"])
    assert isinstance(data, xarray.Dataset) and dict(data.sizes) == {"row": 3, "column": 4, "joint": 6, "case": 2, "axis": 3, "contributor": 6}
    assert data.deviation.dims == ("row", "column", "case", "axis") and data.deviation.attrs["units"] == "m"
    assert data.in_plane.attrs["long_name"].startswith("largest in-plane deviation")
    assert np.array_equal(data.deviation.sel(axis="z"), grid.deviation[..., 2], equal_nan=True)
    assert data.joint.values.tolist() == mh12.joint_names and data.joint_unit.values.tolist() == ["rad"] * 6
    assert list(grid.to_pandas().index.names) == ["pose_0", "pose_1"] and data.branch.values.ravel().tolist() == grid.branch
    assert set(grid.to_xarray().sizes) >= {"pose_0", "pose_1"}
    with pytest.raises(ValueError, match="dims: expected 2 names, given row"):
        grid.to_xarray(dims=["row"])
    paired = mh12.evaluate(poses, np.tile(FORCES, (6, 1)), normal=[0, 0, 1], paired=True).to_xarray()
    assert paired.deviation.dims == ("pose", "axis")
    samples = mh12.sample(3)
    spread = mh12.evaluate(poses, FORCES, normal=[0, 0, 1], samples=samples).to_xarray(dims=["sample", "pose"])
    assert spread.deviation.dims == ("sample", "pose", "case", "axis")

    postures = mh12.inverse(poses[:3]).to_pandas()
    assert {"joints_0", "pose_index", "branch", "within_limits"} <= set(postures.columns)
    drawn = samples.to_xarray()
    assert drawn.z.dims == ("sample", "input") and drawn.input.values[0] == "compliance S"
    assert np.array_equal(drawn.compliances, samples.compliances) and drawn.compliances.attrs["units"] == "rad/(N*m)"
    assert np.array_equal(samples.to_pandas()["z_compliance U"], samples.z[:, 2])


def test_units_are_those_that_pint_reads(mh12, joints, result):
    pytest.importorskip("pint_xarray")
    quantified = mh12.evaluate(mh12.forward(joints[:4]), FORCES, normal=[0, 0, 1]).to_xarray().pint.quantify()
    assert str(quantified.deviation.pint.units) == "meter" and str(quantified.joints.pint.units) == "radian"
    plane = result.to_xarray().pint.quantify()
    assert str(plane.in_plane_um.pint.to("m").pint.units) == "meter"
    assert str(mh12.sample(2).to_xarray().pint.quantify().compliances.pint.units) == "radian / meter / newton"


def test_maps_and_tables_are_labelled(result, table):
    pytest.importorskip("xarray")
    plane = result.to_xarray(result.analyses[0])
    grid = result.answer["maps"][0]["grid"]
    assert dict(plane.sizes) == {"z": len(grid["z_mm"]), "y": len(grid["y_mm"])}
    assert np.array_equal(plane.y, grid["y_mm"]) and plane.y.attrs["units"] == "mm"
    # The table has more digits than the JSON.
    expected = np.array(grid["in_plane_um"], dtype=float).reshape(plane.in_plane_um.shape)
    assert np.allclose(plane.in_plane_um, expected, atol=0.051, equal_nan=True) and plane.in_plane_um.attrs["units"] == "um"
    assert plane.in_plane_um.attrs["long_name"] == table.descriptions["in_plane_um"] and table.units["in_plane_um"] == "um"
    sections = result.to_xarray("Table 4, best branch")
    assert sections.in_plane_um.dims == ("section", "z", "y")
    assert np.array_equal(sections.in_plane_um.values.ravel(), result.table("Table 4, best branch")["in_plane_um"], equal_nan=True)
    rows = table.to_xarray()
    assert dict(rows.sizes) == {"row": len(table)} and table.to_xarray(dims=["point"]).in_plane_um.dims == ("point",)
    assert result.to_pandas().equals(table.to_pandas()) and list(table.to_dict()) == table.columns


def test_a_volume_is_labelled(result):
    pytest.importorskip("xarray")
    box, table = result.to_xarray("Space, 800 mm box"), result.table("Space, 800 mm box")
    assert list(box.sizes) == ["z", "y", "x"] and box.in_plane_um.size == len(table)
    assert np.array_equal(box.in_plane_um.values.ravel(), table["in_plane_um"], equal_nan=True)
    for axis in "xyz":
        assert np.array_equal(box[axis], np.unique(table[f"{axis}_mm"])) and box[axis].attrs["units"] == "mm"
    point = box.isel(z=2, y=1, x=3)
    assert (float(point.x), float(point.y), float(point.z)) == (float(point.x_mm), float(point.y_mm), float(point.z_mm))


def test_results_are_equal_where_their_numbers_are(mh12, joints, result, table):
    poses = mh12.forward(joints[:12])
    poses[3, 0, 3] = 9.0
    one = mh12.evaluate(poses, FORCES, normal=[0, 0, 1])
    assert one == mh12.evaluate(poses, FORCES, normal=[0, 0, 1]) == pickle.loads(pickle.dumps(one))
    assert one != mh12.evaluate(poses, 2 * FORCES, normal=[0, 0, 1]) and one != "evaluation" and len({one, pickle.loads(pickle.dumps(one))}) == 1
    postures = mh12.inverse(poses)
    assert postures == pickle.loads(pickle.dumps(postures)) != mh12.inverse(poses[:5])
    study = armill.Study.load(GROOVE)
    assert study == armill.Study.load(GROOVE) == pickle.loads(pickle.dumps(study)) != armill.Study.load(GROOVE, robot=mh12.with_compliance(mh12.joint_compliance))
    again = pickle.loads(pickle.dumps(result))
    assert again == result and again["maps"] == result.answer["maps"] and result != study
    assert table == pickle.loads(pickle.dumps(table)) and table != result.table(result.analyses[1])
    assert one.contributors == mh12.contributors and one.joint_names == mh12.joint_names


def test_a_tool_path_is_pickled(tmp_path):
    program = tmp_path / "part.nc"
    program.write_text("G21 G90 G17\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG2 X10 Y10 I5 J5\nG1 X20\nM30\n")
    path = armill.read_path(program)
    program.unlink()
    again = pickle.loads(pickle.dumps(path))
    assert again == path and np.array_equal(again.points, path.points) and again.notes == path.notes and again.operations == path.operations
    frame = path.to_pandas() if pytest.importorskip("pandas") else None
    assert np.array_equal(frame["points_x"], path.points[:, 0]) and frame.attrs["units"]["feed"] == "m/s"
    assert "<table>" in path._repr_html_() and len({path, again}) == 1


def test_everything_is_shown_in_notebooks(mh12, joints):
    study = armill.Study.load(GROOVE)
    shown = [mh12.inverse(mh12.forward(joints[:2])), study, armill.Study.from_text("format = 1\n"), mh12.sample(4)]
    assert all("<table>" in each._repr_html_() for each in shown)
    assert "Fig. 6" in study._repr_html_()


def test_a_missing_package_is_named(mh12, joints, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r'xarray is not installed .*: pip install "armill\[xarray\]"'):
        mh12.evaluate(mh12.forward(joints[:2]), FORCES, normal=[0, 0, 1]).to_xarray()
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r'pip install "armill\[pandas\]"'):
        mh12.sample(2).to_pandas()


def test_answers_give_robots_and_samples_of_them(tmp_path):
    import answers

    answers.springs()
    rows = (answers.folder() / "tests.csv").read_text().splitlines(keepends=True)
    # Without the test that is wrong.
    (tmp_path / "tests.csv").write_text("".join(rows[:8] + rows[9:]))
    options = {"robot": "yaskawa/mh12", "tool_mm": [0, 60, 150], "out": tmp_path / "found.toml"}
    answer = armill.identify(tmp_path / "tests.csv", **options)
    found = answer.updated_robot()
    assert found.compliance_covariance.any() and found.joint_compliance[2] == pytest.approx(4e-5, rel=0.1)
    samples = answer.samples(1 << 12, seed=3)
    springs = np.hstack([samples.compliances, samples.spring_compliances])
    size = np.sqrt(np.outer(*[np.diag(found.compliance_covariance)] * 2))
    inside = np.diag(found.compliance_covariance) ** 0.5 < 0.2 * found.spring_compliance
    part = np.ix_(inside, inside)
    assert inside.sum() >= 3
    assert np.allclose(np.cov(springs.T)[part], found.compliance_covariance[part], atol=0.03 * size[part].max())
    assert pickle.loads(pickle.dumps(answer)).updated_robot() == found
    with pytest.raises(ValueError, match="the command wrote no robot file"):
        answers.springs().samples(3)
