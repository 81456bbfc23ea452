"""Shared by the tests: an arm, joint positions, paths."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import armill

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def mh12() -> armill.Robot:
    return armill.Robot.load("yaskawa/mh12")


@pytest.fixture(scope="session")
def tool() -> np.ndarray:
    """flange_from_tool: 150 mm out, bent by 30 degrees."""
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    return np.array([[c, 0, s, 0.05], [0, 1, 0, -0.02], [-s, 0, c, 0.15], [0, 0, 0, 1]])


@pytest.fixture
def joints(mh12: armill.Robot) -> np.ndarray:
    """300 joint positions inside the limits, away from their ends."""
    low, high = mh12.limits.T
    spread = np.random.default_rng(11).uniform(0.2, 0.8, (300, mh12.dof))
    return low + spread * (high - low)


@pytest.fixture(scope="session")
def samples() -> Path:
    folder = os.environ.get("ARMILL_SAMPLES")
    if folder is None:
        pytest.skip("ARMILL_SAMPLES is not set")
    return Path(folder)


@pytest.fixture(scope="session")
def command() -> Path:
    """The command built without Python, the reference for bytes."""
    path = Path(os.environ.get("ARMILL_BIN", ROOT / "target" / "debug" / "armill"))
    assert path.is_file(), f"{path} is not built: cargo build"
    return path
