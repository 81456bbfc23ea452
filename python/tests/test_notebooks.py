"""Notebooks run from the first cell to the last, print nothing on stderr, and are stored without output."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"
NAMES = sorted(path.stem for path in FOLDER.glob("*.ipynb"))
SYNTHETIC = "SYNTHETIC tests: ARMILL_SAMPLES is not set"


def ran(name, folder=FOLDER):
    """Text and number of pictures of a notebook, run in a folder, by default its own."""
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert not [output["text"] for output in outputs if output.get("name") == "stderr"]
    text = "".join(output["text"] for output in outputs if output.get("name") == "stdout")
    return text, sum("image/png" in output.get("data", {}) for output in outputs)


def test_the_folder_has_five_notebooks():
    assert NAMES == ["fanuc-identification", "monte-carlo", "own-robot", "paper-in-ten-cells", "placement-with-sensitivity"]


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_are_stored_without_output(name):
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    assert notebook.cells[0].cell_type == "markdown" and notebook.cells[0].source.startswith("# ")
    assert name != "paper-in-ten-cells" or len(code) == 10


@pytest.mark.filterwarnings("default")
def test_the_paper_runs_and_reports_its_readings():
    text, pictures = ran("paper-in-ten-cells")
    assert pictures == 8
    assert "49.7 to   58.7 um  consistent" in text and "no point on the plane is within 50 µm" in text


@pytest.mark.filterwarnings("default")
def test_own_robot_results_in_a_map():
    text, pictures = ran("own-robot")
    assert pictures == 7
    assert "4 postures, 4 inside the joint limits" in text and "assumed, not measured" in text


@pytest.mark.filterwarnings("default")
def test_the_springs_of_the_fanuc_are_the_published_ones():
    if "ARMILL_SAMPLES" not in os.environ:
        pytest.skip("ARMILL_SAMPLES is not set")
    text, pictures = ran("fanuc-identification")
    assert pictures == 3 and SYNTHETIC not in text
    # docs/theory/identification.md has the same figures.
    for left_out in ("20.8 %", "16.4 %", "8.8 %", "by hand 20.83 %, by the command 20.83 %"):
        assert left_out in text


@pytest.mark.filterwarnings("default")
def test_without_measured_tests_synthetic_ones_are_used_and_reported(monkeypatch):
    monkeypatch.delenv("ARMILL_SAMPLES", raising=False)
    text, pictures = ran("fanuc-identification")
    assert pictures == 3 and SYNTHETIC in text


@pytest.mark.filterwarnings("default")
def test_the_fanuc_notebook_runs_outside_the_repository(monkeypatch, tmp_path):
    monkeypatch.delenv("ARMILL_SAMPLES", raising=False)
    text, pictures = ran("fanuc-identification", tmp_path)
    assert pictures == 3 and SYNTHETIC in text


@pytest.mark.filterwarnings("default")
def test_the_placement_is_found_and_is_robust_to_other_compliances():
    text, pictures = ran("placement-with-sensitivity")
    assert pictures == 2
    assert "nominal   cost 139.74 um (the study reports 139.74)" in text
    assert "the recommended placement is better in 100.0 % of all draws" in text and "U twice as soft" in text


@pytest.mark.filterwarnings("default")
def test_monte_carlo_agrees_with_the_law_of_propagation():
    text, pictures = ran("monte-carlo")
    assert pictures == 2
    assert "ratio of standard uncertainties" in text and "measure first: J" in text
