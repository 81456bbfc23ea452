"""Real answers for pictures, each made once."""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path

import numpy as np

import armill

PATHS = """
format = 1
robot = "yaskawa/mh12"
tolerance_um = 300
tool = { flange_from_tool_mm_deg = [60, 0, 150, 0, 35, 0] }
plane = { centre_mm = [900, 100, 500], tilt_deg = 60, half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[30, 0, -20], [0, 30, -20]] }

[[analysis]]
kind = "path"
name = "groove"
circle = { radius_mm = 100 }
step_mm = 10

[[analysis]]
kind = "path"
name = "turned"
circle = { radius_mm = 100 }
step_mm = 10
posture.search = { step_deg = 20 }

[[analysis]]
kind = "path"
name = "pocket"
rectangle = { size_mm = [160, 100] }
step_mm = 8
"""
FAR = """
format = 1
robot = "yaskawa/mh12"
tolerance_um = 50
plane = { centre_mm = [1150, 200, 700], rotation_deg = [0, 40, 20], half_size_mm = 500, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }

[[analysis]]
kind = "map"
name = "far plate"

[[analysis]]
kind = "path"
name = "round"
circle = { radius_mm = 60 }
"""
PLACE = """
format = 1
robot = "yaskawa/mh12"
tolerance_um = 50
plane = { centre_mm = [1000, 0, 800], half_size_mm = 200, step_mm = 10 }
load = { cases_n = [[3, -5, -5], [3, -5, 5], [3, 5, -5], [3, 5, 5]] }
posture.branch = "front elbow-up"

[place]
x_mm = [700, 1300]
tilt_deg = [-60, 90]

[[analysis]]
kind = "path"
name = "groove"
circle = { radius_mm = 100 }
step_mm = 40
"""
MEASURED = """
format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[3, 5, 5]] }
measured = { part = "cmm.csv", ballbar = ["ballbar.csv"] }

[[analysis]]
kind = "path"
name = "groove"
circle = { radius_mm = 100 }
"""


@functools.cache
def folder() -> Path:
    """Folder of the answers until the tests end."""
    kept = tempfile.TemporaryDirectory(prefix="armill-plot-")
    _KEPT.append(kept)
    return Path(kept.name)


_KEPT: list[tempfile.TemporaryDirectory[str]] = []


def written(name: str, text: str) -> Path:
    path = folder() / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


@functools.cache
def paper() -> armill.Result:
    return armill.Study.load("mh12-groove").run()


@functools.cache
def paths() -> armill.Result:
    return armill.Study.from_text(PATHS).run()


@functools.cache
def far() -> armill.Result:
    return armill.Study.from_text(FAR).run()


def tool() -> np.ndarray:
    """That of the paths."""
    c, s = np.cos(np.radians(35)), np.sin(np.radians(35))
    return np.array([[c, 0, s, 0.06], [0, 1, 0, 0], [-s, 0, c, 0.15], [0, 0, 0, 1]])


@functools.cache
def placed() -> Path:
    study = written("place/study.toml", PLACE)
    armill.place(study.parent, out=study.parent / "out", no_pictures=True)
    return study.parent / "out"


@functools.cache
def bore() -> tuple[armill.Answer, Path]:
    angles = np.radians(np.arange(0, 360, 0.5))
    radii = 25 + 0.004 * np.cos(3 * angles) + 0.0015 * np.sin(5 * angles) + 0.0004 * np.sin(61 * angles)
    rows = "".join(f"{np.degrees(a):.1f},{r:.7f}\n" for a, r in zip(angles, radii))
    out = folder() / "bore"
    return armill.roundness(written("bore.csv", "angle_deg,radius_mm\n" + rows), out=out), out / "roundness.csv"


def _ring(run: int, way: int, angles: np.ndarray) -> np.ndarray:
    s, c = np.sign(np.sin(angles)), np.sign(np.cos(angles))
    gap = way * (15 * s * np.cos(angles) - 9 * c * np.sin(angles))
    return 12 + 30 * np.cos(2 * angles) - 15 * np.sin(2 * angles) + gap + 3 * np.sin(29 * angles + run + way)


@functools.cache
def ballbar() -> tuple[armill.Answer, Path]:
    angles = np.radians(np.arange(0.25, 360, 0.5))
    rows = [
        f"{np.degrees(a):.2f},{d:.3f},{'CW' if way < 0 else 'CCW'},{run}\n"
        for run in (1, 2)
        for way in (-1, 1)
        for a, d in zip(angles[::way], _ring(run, way, angles[::way]))
    ]
    head = "# radius_mm: 100\n# plane: XY\nangle_deg,radius_dev_um,direction,run\n"
    out = folder() / "ballbar"
    return armill.ballbar(written("bar.csv", head + "".join(rows)), out=out), out


@functools.cache
def budget() -> armill.Answer:
    def path(angles: np.ndarray) -> np.ndarray:
        return 45 * np.cos(2 * angles - 0.7) + 18 * np.cos(3 * angles + 0.4)

    rows = [
        f"{k + 0.5},{path(a) + way * 30 * np.sign(np.sin(a - 0.3)) + 2 * np.sin(29 * a + run + way):.3f},{name},{run}\n"
        for run in (1, 2)
        for way, name in ((-1, "CW"), (1, "CCW"))
        for k, a in enumerate(np.radians(np.arange(0.5, 360)))
    ]
    written("budget/ballbar.csv", "# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n" + "".join(rows))
    angles = np.radians(np.arange(0, 360, 5))
    radii = 100 + (path(angles) + 30 * np.sign(np.sin(angles - 0.3)) + 3 * np.sin(17 * angles)) / 1000
    cells = "".join(f"{np.degrees(a):.0f},{r:.5f}\n" for a, r in zip(angles, radii))
    written("budget/cmm.csv", "angle_deg,radius_mm\n" + cells)
    return armill.budget(written("budget/study.toml", MEASURED))


@functools.cache
def springs() -> armill.Answer:
    """Found out of tests that are made up with the compliances of the robot file, one of them wrong."""
    robot = armill.Robot.load("yaskawa/mh12")
    random = np.random.default_rng(5)
    low, high = robot.limits.T
    joints = low + random.uniform(0.3, 0.7, (30, 6)) * (high - low)
    forces = random.normal(0, 60, (30, 3))
    point = np.eye(4)
    point[:3, 3] = [0, 0.06, 0.15]
    moved = np.array([robot.deviation(q, f, point) for q, f in zip(joints, forces)])
    moved += random.normal(0, 10e-6, moved.shape)
    moved[7] *= -1
    names = [*(f"q{i}_deg" for i in range(1, 7)), "fx_n", "fy_n", "fz_n", "dx_mm", "dy_mm", "dz_mm"]
    rows = np.hstack([np.degrees(joints), forces, 1e3 * moved])
    text = ",".join(names) + "\n" + "".join(",".join(f"{cell:.9f}" for cell in row) + "\n" for row in rows)
    return armill.identify(written("tests.csv", text), robot="yaskawa/mh12", tool_mm=[0, 60, 150])
