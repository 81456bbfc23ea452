"""A program as users write it, checked by mypy and pyright, not run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

import armill
from armill import scale


def deviations(robot: armill.Robot, joints: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    evaluation = robot.evaluate(robot.forward(joints), [0, 0, -50], branch="best", normal=(0, 0, 1))
    names: list[str] = evaluation.branch
    reason: str | None = evaluation.reason(0)
    print(names, reason, evaluation.within_limits.all(), robot.inverse(np.eye(4)).offsets[-1])
    room = np.empty((len(joints), 3))
    robot.deviation(joints, np.zeros((len(joints), 3)), paired=True, compliances=robot.joint_compliance, out=room)
    postures = robot.inverse(robot.forward(joints))
    print(postures[0].shape, postures[0, 0].shape, [part.shape for part in postures[1:3]], robot.branch_of(joints)[0])
    return robot.deviation(joints.tolist(), [[1.0, 2.0, 3.0]], threads=2)


def uncertain(robot: armill.Robot, joints: npt.NDArray[np.float64]) -> armill.VarianceShares:
    given = robot.with_compliance(np.full(6, 1e-6), np.diag(np.full(6, 1e-14)), source="typed")
    samples: armill.Samples = given.sample(100, "random", seed=1)
    cloud: npt.NDArray[np.float64] = given.deviation(joints, [0, 0, 1], samples=samples[:50], all_sources=True)
    u: npt.NDArray[np.float64] | None = given.standard_uncertainty
    print(cloud.shape, u is None, given.uncertain_inputs[0]["name"], given.samples_at(armill.normal_draws(3, 6)).cut.sum())
    return armill.sobol_indices(given, function=lambda each: each.z[:, 0], by="source")


def study(path: Path) -> str:
    try:
        result: armill.Result = armill.Study.load(path).run(progress=lambda count: None)
    except armill.InputError as refused:
        return str(refused.problems[0]["message"])
    table: armill.Table = result.table()
    return result.sentence + table.columns[0]


def commands(frame: npt.NDArray[np.float64]) -> armill.Answer:
    robot = armill.Robot.load("yaskawa/mh12")
    answer: armill.Answer = armill.pose(robot, at_mm=[1000, 0, 800], compliance_class="light")
    study = armill.Study.load("mh12-groove", robot=robot)
    armill.place(study, x_mm=[700, 1300], objective="mean", rank_by="plus-two-sigma")
    armill.identify({"A1_deg": frame, "fx_n": frame.tolist()}, robot=robot, prior="none")
    armill.calibrate(study.run().table(), robot=robot, columns={"x_mm": "Measured X"}, validation=0.2)
    scale.placements(study, x_mm=np.linspace(700, 1100, 5), spin_deg=[0.0, 10.0])
    scale.deviations(robot, [0, 0, -50], joints=frame, samples=frame)
    # What type checkers find.
    robot.evaluate(np.eye(4), [0, 0, -50], branch="fornt")  # type: ignore[arg-type] # pyright: ignore
    armill.pose(robot, at_m=[1, 0, 0.8])  # type: ignore[call-arg] # pyright: ignore
    scale.placements(study, x=[0.7])  # type: ignore[call-arg] # pyright: ignore
    moves: armill.ToolPath = armill.read_path("part.nc", unit="mm")
    print(answer["postures"], answer.messages, moves.points.shape)
    return answer
