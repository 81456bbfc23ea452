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
