"""Each command as a function: the bytes of the command, its errors, its options."""

from __future__ import annotations

import inspect
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import armill
from conftest import ROOT

POSE = {"at_mm": [1000, 0, 800], "tilt_deg": 90, "tool_mm": [0, 0, 150], "wrench_n": [3, -5, 5]}
TYPED = ["pose", "yaskawa/mh12", "--at-mm", "1000,0,800", "--tilt-deg", "90", "--tool-mm", "0,0,150", "--wrench-n", "3,-5,5"]
COMMANDS = [
    "robots", "materials", "pose", "posture", "place", "advise", "compare", "compensate", "identify", "calibrate", "learn", "journal", "tracker",
    "forces", "roundness", "ballbar", "backlash", "pose_accuracy", "path_accuracy", "motion", "drives", "frf", "stability", "budget",
    "modes", "receptance", "export",
]  # fmt: skip


def typed(command, *words) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([command, *map(str, words)], capture_output=True)


def test_a_pose_gives_the_bytes_of_the_command(command):
    answer = armill.pose("yaskawa/mh12", **POSE)
    assert answer.json.encode() == typed(command, *TYPED, "--json").stdout
    as_arrays = {key: np.array(value) for key, value in POSE.items()}
    assert armill.pose("yaskawa/mh12", **as_arrays, load_dependent=False, drawing=None).json == answer.json
    assert answer["postures"] == answer.postures == answer.data["postures"] == json.loads(answer.json)["postures"]
    assert "postures" in dir(answer) and "postures" in repr(answer)
    with pytest.raises(AttributeError, match="no `nonsense`"):
        answer.nonsense


def test_the_pose_of_the_command_is_the_pose_of_the_arrays(mh12):
    answer = armill.pose("yaskawa/mh12", **POSE)
    tool = np.eye(4)
    tool[2, 3] = 0.15
    for posture in answer.postures:
        q = np.radians(posture["joints_deg"])
        deviation = mh12.deviation(q, POSE["wrench_n"], tool)
        assert np.abs(deviation * 1e6 - posture["deviation_um"]).max() < 1e-6
        assert np.abs(mh12.jacobian(q, tool) - posture["jacobian"]).max() < 1e-12
        assert np.abs(mh12.compliance(q, tool) - posture["compliance"]).max() < 1e-16


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_a_function_and_its_help_names_its_options(name):
    function = getattr(armill, name)
    assert callable(function) and "-> Answer" in inspect.getdoc(function).splitlines()[0]
    text = armill.command_help(name)
    assert len(text.splitlines()) >= 2, text


def test_every_command_with_an_answer_is_a_function(command):
    listed = typed(command, "--help").stdout.decode().split("Commands:")[1].split("Options:")[0]
    first = [line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line[2:3].isalpha()]
    names = {name.replace("-", "_") for name in first} - {"help"}
    # `run` and `check` are methods of Study; the others have no answer in JSON.
    assert names - set(COMMANDS) == {"run", "check", "new", "serve", "completions", "man"}


def test_a_table_of_points_gives_the_bytes_of_the_command(command, tmp_path, monkeypatch):
    angles = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    radius = 25 + 0.01 * np.cos(3 * angles)
    file = tmp_path / "-bore.csv"
    points = np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1)
    np.savetxt(file, points, delimiter=",", header="x_mm,y_mm", comments="")
    answer = armill.roundness(file, harmonics=5, out=tmp_path / "out")
    printed = typed(command, "roundness", file, "--harmonics", 5, "--json", "--out", tmp_path / "out")
    assert printed.returncode == 0 and answer.json.encode() == printed.stdout
    assert answer.messages == printed.stderr.decode().splitlines()
    monkeypatch.chdir(tmp_path)
    printed = typed(command, "roundness", "--json", "--", "-bore.csv")
    assert armill.roundness("-bore.csv").json.encode() == printed.stdout != b""


def test_libraries_and_studies_give_the_bytes_of_the_command(command, tmp_path):
    assert armill.materials().json.encode() == typed(command, "materials", "--json").stdout
    assert armill.robots("yaskawa/mh12").json.encode() == typed(command, "robots", "yaskawa/mh12", "--json").stdout
    cell = tmp_path / "cell"
    assert typed(command, "new", cell).returncode == 0
    both = armill.compare(cell, robot=["kuka/kr120r2500pro", "fanuc/m20ia"], threads=1)
    printed = typed(command, "compare", cell, "--robot", "kuka/kr120r2500pro", "--robot", "fanuc/m20ia", "--json")
    assert printed.returncode == 0 and both.json.encode() == printed.stdout
    counts: list[int] = []
    path = armill.compensate(cell, out=tmp_path / "out", threads=2, progress=counts.append)
    printed = typed(command, "compensate", cell, "--out", tmp_path / "out", "--json")
    assert printed.returncode == 0 and path.json.encode() == printed.stdout
    assert counts == sorted(counts)


def test_refusals_have_the_message_of_the_command(command):
    for operands, options, words in [
        (["yaskawa/mh21"], {"at_mm": [1, 2, 3]}, ["pose", "yaskawa/mh21", "--at-mm", "1,2,3"]),
        (["yaskawa/mh12"], {"at_mm": [1, 2]}, ["pose", "yaskawa/mh12", "--at-mm=1,2"]),
        (["yaskawa/mh12"], {"at_mm": ["a"]}, ["pose", "yaskawa/mh12", "--at-mm=a"]),
        (["yaskawa/mh12"], {}, ["pose", "yaskawa/mh12"]),
    ]:
        with pytest.raises(armill.InputError) as refused:
            armill.pose(*operands, **options)
        printed = typed(command, *words, "--json")
        assert printed.returncode == 2
        message = printed.stderr.decode().rstrip().removeprefix("error: ")
        if "Usage:" in message:
            # The usage differs from that of the command.
            message, ours = (text.split("Usage:")[0] for text in (message, str(refused.value)))
            assert ours == message and refused.value.problems[0]["message"] == str(refused.value)
        else:
            assert str(refused.value).rstrip() == message
            reported = json.loads(printed.stdout)["problems"] if printed.stdout else refused.value.problems
            assert refused.value.problems == reported and reported[0]["message"]


def test_reports_unknown_options_with_the_known_ones():
    with pytest.raises(TypeError, match="unexpected keyword argument 'at_m'"):
        armill.pose("yaskawa/mh12", at_m=[1, 2, 3])
    assert "at_mm" in inspect.signature(armill.pose).parameters
    with pytest.raises(armill.InputError, match="requires True or False"):
        armill.pose("yaskawa/mh12", at_mm=[1, 2, 3], load_dependent="yes")
    with pytest.raises(TypeError, match="at_mm: expected a text, a number"):
        armill.pose("yaskawa/mh12", at_mm=object())


def test_reports_the_tolerance_with_strict(tmp_path):
    study = ROOT / "studies/mh12-groove"
    loose = armill.posture(study, out=tmp_path / "a", no_pictures=True)
    assert loose.within_tolerance
    strict = armill.posture(study, out=tmp_path / "a", no_pictures=True, strict=True)
    assert strict.json == loose.json and any("results in" in line for line in strict.messages)


def test_the_command_of_the_wheel_is_the_command(command):
    script = os.path.join(os.path.dirname(sys.executable), "armill")
    for words in ([*TYPED, "--json"], ["pose", "yaskawa/mh21", "--at-mm", "1,2,3"], ["--version"], ["nonsense"], []):
        printed = typed(command, *words)
        for surface in ([script], [sys.executable, "-m", "armill"]):
            ours = subprocess.run([*surface, *words], capture_output=True)
            assert (ours.returncode, ours.stdout, ours.stderr) == (printed.returncode, printed.stdout, printed.stderr), words


def test_moves_of_a_program_are_arrays(tmp_path):
    file = tmp_path / "ring.nc"
    file.write_text("G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F600\nG1 X10\nG3 X10 Y20 I0 J10 F1200\nM30\n")
    path = armill.read_path(file)
    assert path.format == "gcode" and len(path) == path.points.shape[0] == 4
    assert np.allclose(path.points[-1], [0.01, 0.02, -0.001], atol=1e-15)
    assert path.cuts.tolist() == [False, True, True, True]
    assert np.allclose(path.feed, [0.0, 0.01, 0.01, 0.02], atol=1e-15)
    assert np.allclose(path.sweep, [0, 0, 0, np.pi]) and path.line.tolist() == [2, 3, 4, 5]
    assert np.allclose(path.arc_centre[-1][:2], [0.01, 0.01]) and np.allclose(path.arc_axis[-1], [0, 0, 1])
    assert len(path.operations) > path.operation.max()
    with pytest.raises(armill.InputError, match="cannot read"):
        armill.read_path(tmp_path / "none.nc")
    file.write_text("G1 X10 Y1a F\n")
    with pytest.raises(armill.InputError) as refused:
        armill.read_path(file)
    assert refused.value.problems[0]["line"] == 1
    with pytest.raises(armill.InputError, match="`foot` is not a unit"):
        armill.read_path(file, unit="foot")
