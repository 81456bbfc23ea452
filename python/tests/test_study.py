"""A study is checked, run and written with the bytes of the command."""

from __future__ import annotations

import json
import re
import subprocess

import numpy as np
import pytest

import armill
from conftest import ROOT

GROOVE = ROOT / "studies/mh12-groove"


@pytest.fixture(scope="session")
def result() -> armill.Result:
    return armill.Study.load(GROOVE).run()


def test_a_study_gives_the_bytes_of_the_command_on_any_number_of_threads(result, command, tmp_path):
    printed = subprocess.run(
        [command, "run", GROOVE, "--out", tmp_path / "out", "--no-pictures", "--json"],
        capture_output=True,
        check=True,
    )
    assert result.json.encode() == printed.stdout
    # The file has the same bytes, followed by the list of its files.
    answer = result.json.rstrip().removesuffix("}")
    assert (tmp_path / "out/result.json").read_text().startswith(f'{answer},"files":{{')
    assert armill.Study.load(GROOVE).run(threads=1).json == result.json
    text = (GROOVE / "study.toml").read_text()
    assert armill.Study.from_text(text, GROOVE).run().json == result.json


def test_the_answer_is_available_as_values(result):
    assert result.answer == json.loads(result.json)
    assert result.sentence == result.answer["answer"] and result.warnings == result.answer["warnings"]
    assert result.analyses == armill.Study.load(GROOVE).analyses


def test_writes_the_files_of_the_command(command, tmp_path):
    cell = tmp_path / "cell"
    subprocess.run([command, "new", cell], capture_output=True, check=True)
    result = armill.Study.load(cell).run()
    files = result.write(tmp_path / "here")
    subprocess.run([command, "run", cell, "--out", tmp_path / "there"], capture_output=True, check=True)
    names = sorted(path.name for path in (tmp_path / "there").iterdir())
    assert sorted(path.name for path in (tmp_path / "here").iterdir()) == names
    assert {path.name for path in files} == set(names) - {".armill-files"}
    for name in names:
        assert (tmp_path / "here" / name).read_bytes() == (tmp_path / "there" / name).read_bytes(), name
    written = armill.Study.load(cell).run(tmp_path / "run", pictures=False)
    answer = written.json.rstrip().removesuffix("}")
    assert (tmp_path / "run/result.json").read_text().startswith(f'{answer},"files":{{')
    assert not list((tmp_path / "run").glob("*.svg"))
    for name, svg in result.pictures.items():
        assert (tmp_path / "there" / f"{name}.svg").read_text() == svg


def test_the_live_page_answers_with_the_same_bytes(result, command, tmp_path):
    import http.client
    import urllib.parse

    server = subprocess.Popen([command, "serve", GROOVE, "--no-open"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        assert server.stdout is not None
        url = urllib.parse.urlsplit(server.stdout.readline().decode().strip())
        token = urllib.parse.parse_qs(url.query or url.fragment)["token"][0]
        page = http.client.HTTPConnection(url.hostname or "", url.port, timeout=60)
        headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}
        page.request("POST", "/api/answer", json.dumps({"text": (GROOVE / "study.toml").read_text()}), headers)
        answered = page.getresponse()
        body = answered.read()
        page.close()
        assert answered.status == 200, body
        assert body.rstrip(b"\n") == result.json.encode().rstrip(b"\n")
    finally:
        server.terminate()
        server.communicate()


def test_tables_are_read_without_a_copy_by_pyarrow_pandas_and_polars(result):
    import pandas
    import polars
    import pyarrow

    for analysis in result.analyses:
        table = result.table(analysis)
        arrow = pyarrow.table(table)
        assert arrow.column_names == table.columns and arrow.num_rows == len(table) > 0
        assert pyarrow.schema(table) == arrow.schema
        described = arrow.schema.field(0).metadata
        assert described[b"description"]
        frame = polars.DataFrame(table)
        assert frame.columns == table.columns and frame.height == len(table)
        assert pandas.DataFrame.from_arrow(table).shape == (len(table), len(table.columns))
        for name in table.columns:
            assert frame[name].null_count() == arrow[name].null_count
    # Load cases are integers, numbered from 1 as in the JSON.
    cases = pyarrow.table(result.table())["worst_case"]
    assert pyarrow.types.is_integer(cases.type) and min(case for case in cases.to_pylist() if case is not None) >= 1
    # Two readers share the same memory.
    table = result.table()
    number = next(name for name in table.columns if name.endswith("_mm"))
    one, two = (pyarrow.table(table)[number].chunk(0).buffers()[1] for _ in range(2))
    assert one.address == two.address


def test_a_table_has_the_numbers_of_its_parquet_file(result, tmp_path):
    import pyarrow
    import pyarrow.parquet

    result.write(tmp_path, pictures=False)
    for analysis in result.analyses:
        table = pyarrow.table(result.table(analysis))
        slug = re.sub(r"[\W_]+", "-", analysis.lower()).strip("-")
        written = pyarrow.parquet.read_table(tmp_path / f"{slug}.parquet")
        assert written.column_names == table.column_names and written.num_rows == table.num_rows
        for name in table.column_names:
            ours, theirs = table[name], written[name]
            if pyarrow.types.is_floating(ours.type):
                # A file keeps the significant decimals.
                a, b = (np.asarray(side.fill_null(0.0)) for side in (ours, theirs))
                assert np.abs(a - b).max() <= 1e-3 * max(1.0, np.abs(a).max()), name


def test_reports_an_unknown_analysis_with_the_known_ones(result):
    with pytest.raises(armill.InputError, match=f"(?s)the study has no analysis `x`.*{result.analyses[0]}"):
        result.table("x")


def test_reports_all_problems_of_a_study_like_the_command(command, tmp_path):
    text = (GROOVE / "study.toml").read_text() + '\n[[analysis]]\nkind = "map"\nlimit = 3\nname = 7\n'
    (tmp_path / "study.toml").write_text(text)
    study = armill.Study.load(tmp_path)
    assert len(study.problems) >= 2
    for problem in study.problems:
        assert problem["file"] == str(tmp_path / "study.toml") and problem["line"] > 1 and problem["message"]
    printed = subprocess.run([command, "check", tmp_path, "--json"], capture_output=True, text=True)
    assert printed.returncode == 2 and json.loads(printed.stdout)["problems"] == study.problems
    for fails in (study.check, study.run, lambda: study.analyses):
        with pytest.raises(armill.InputError) as refused:
            fails()
        assert refused.value.problems == study.problems
        assert str(refused.value).rstrip() == printed.stderr.rstrip()


def test_reports_progress_and_an_exception_of_it_stops_the_run(tmp_path):
    text = (GROOVE / "study.toml").read_text()
    fine = text.replace("step_mm = ", "step_mm = 2 # ", 1)
    assert fine != text
    study = armill.Study.from_text(fine, GROOVE)
    counts: list[int] = []

    class Enough(Exception):
        pass

    def progress(count: int) -> None:
        counts.append(count)
        if count > 0:
            raise Enough

    with pytest.raises(Enough):
        study.run(tmp_path / "out", progress=progress)
    assert counts == sorted(counts) and 0 < counts[-1] < study.point_count
    assert not (tmp_path / "out/result.json").exists()


def test_refuses_a_missing_study():
    with pytest.raises(armill.InputError, match="no study at no/such"):
        armill.Study.load("no/such")
