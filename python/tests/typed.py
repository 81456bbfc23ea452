"""A program as users write it, checked by mypy and pyright, not run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

import armill


def deviations(robot: armill.Robot, joints: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    evaluation = robot.evaluate(robot.forward(joints), [0, 0, -50], branch="best", normal=(0, 0, 1))
    names: list[str] = evaluation.branch
    reason: str | None = evaluation.reason(0)
    print(names, reason, evaluation.within_limits.all(), robot.inverse(np.eye(4)).offsets[-1])
    return robot.deviation(joints.tolist(), [[1.0, 2.0, 3.0]], threads=2)


def study(path: Path) -> str:
    try:
        result: armill.Result = armill.Study.load(path).run(progress=lambda count: None)
    except armill.InputError as refused:
        return str(refused.problems[0]["message"])
    table: armill.Table = result.table()
    return result.sentence + table.columns[0]


def commands() -> armill.Answer:
    answer: armill.Answer = armill.pose("yaskawa/mh12", at_mm=[1000, 0, 800])
    moves: armill.ToolPath = armill.read_path("part.nc", unit="mm")
    print(answer["postures"], answer.messages, moves.points.shape)
    return answer
