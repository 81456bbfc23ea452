"""The wheel in an empty environment: numpy is installed, README runs, the command exists; the import is quick."""

from __future__ import annotations

import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from conftest import ROOT
from test_docs import blocks


@pytest.fixture(scope="session")
def wheel() -> Path:
    wheels = sorted((ROOT / "target/python-wheels").glob("armill-*.whl"), key=lambda path: path.stat().st_mtime)
    assert wheels, "build the wheel first: cargo xtask test says how"
    return wheels[-1]


def test_the_wheel_runs_in_an_empty_environment(wheel, tmp_path):
    venv.create(tmp_path / "venv", with_pip=True)
    python = tmp_path / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", wheel], check=True)
    listed = subprocess.run([python, "-m", "pip", "list", "--format=freeze"], capture_output=True, text=True, check=True)
    names = {line.split("==")[0].lower() for line in listed.stdout.splitlines()}
    assert names - {"pip", "setuptools", "wheel"} == {"armill", "numpy"}
    for block in blocks(ROOT / "README.md"):
        ran = subprocess.run([python, "-c", block], cwd=tmp_path, capture_output=True, text=True)
        assert ran.returncode == 0 and ran.stdout, ran.stderr
    ran = subprocess.run([tmp_path / "venv/bin/armill", "robots"], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0 and "yaskawa/mh12" in ran.stdout


def test_the_wheel_is_for_every_python_from_3_10_and_typed(wheel):
    assert "cp310-abi3" in wheel.name
    with zipfile.ZipFile(wheel) as files:
        names = files.namelist()
        metadata = files.read(next(name for name in names if name.endswith("METADATA"))).decode()
    assert {"armill/py.typed", "armill/_armill.pyi"} <= set(names)
    needs = [line for line in metadata.splitlines() if line.startswith("Requires-Dist") and "extra" not in line]
    assert needs == ["Requires-Dist: numpy>=1.23"]
    assert not any("test" in name for name in names)


def test_the_import_is_quick_and_does_not_load_numpy():
    code = "import sys, time; t = time.process_time(); import armill; print(time.process_time() - t); assert 'numpy' not in sys.modules"
    seconds = min(
        float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)
        for _ in range(3)
    )
    # CPU time, independent of other load. numpy is loaded at first use.
    assert seconds < 0.15, f"{seconds * 1e3:.0f} ms"
