"""Elementary transform sequences of the Robotics Toolbox for Python."""

from __future__ import annotations

from typing import Any

import numpy as np

import armill
from armill.interop import _screws


def to_ets(robot: armill.Robot) -> Any:
    """Robot -> roboticstoolbox.ETS: base to flange, joint signs and limits as those of the robot."""
    rtb = _package()
    et = rtb.ET
    found = _screws.of_robot(robot)
    steps = found.steps()
    parts: list[Any] = []
    for i, (step, joint) in enumerate(zip(steps, found.joints)):
        parts += _along(et, step)
        axis = _screws.coordinate_axis(joint.direction)
        around, down = (0.0, 0.0) if axis is not None else _screws.turned_to(joint.direction)
        name, sign = axis or ("z", 1)
        options: dict[str, Any] = {"flip": sign < 0, "jindex": i}
        if joint.limits is not None:
            # A flipped joint has a reversed axis; its limits are those of the robot.
            options["qlim"] = np.array(joint.limits)
        moves = getattr(et, ("t" if joint.slides else "R") + name)(**options)
        turned = [] if axis is not None else [et.Rz(around), et.Ry(down)]
        back = [] if axis is not None else [et.Ry(-down), et.Rz(-around)]
        parts += [*turned, moves, *back]
    rotation = np.eye(4)
    rotation[:3, :3] = found.base_from_flange[:3, :3]
    parts += [*_along(et, steps[-1]), et.SE3(rotation)]
    ets = rtb.ETS(parts)
    _screws.compared("to_ets", robot.dof, lambda q: _forward(ets, q), robot.forward)
    return ets


def from_ets(ets: Any, *, name: str | None = None) -> armill.Robot:
    """roboticstoolbox.ETS (or a robot of the toolbox) -> Robot: base to the end of the sequence.

    Joints are called q1, q2, ... and have the limits of the sequence.
    """
    given = ets
    if not hasattr(ets, "jacob0") or not hasattr(ets, "n"):
        raise TypeError(f"from_ets: expected a roboticstoolbox.ETS, given {type(ets).__name__}")
    if callable(getattr(ets, "ets", None)):
        ets = ets.ets()
    count = int(ets.n)
    if list(ets.jindices) != list(range(count)):
        raise ValueError(f"from_ets: joints are numbered {list(map(int, ets.jindices))}: expected 0 to {count - 1} from base on")
    zero = np.zeros(count)
    limits = [_limits(joint) for joint in ets.joints()]
    names = [f"q{i}" for i in range(1, count + 1)]
    called = name or str(getattr(given, "name", "") or "ets")
    found = _screws.screws(called, names, limits, (_forward(ets, zero), ets.jacob0(zero)))
    robot = _screws.to_robot(found, "a sequence of the Robotics Toolbox")
    _screws.compared("from_ets", count, robot.forward, lambda q: _forward(ets, q))
    return robot


def _along(et: Any, step: Any) -> list[Any]:
    return [getattr(et, f"t{name}")(float(part)) for name, part in zip("xyz", step) if part]


def _limits(joint: Any) -> tuple[float, float] | None:
    limits = joint.qlim
    if limits is None or not np.isfinite(limits).all():
        return None
    low, high = (float(limit) for limit in limits)
    return (low, high)


def _forward(ets: Any, q: Any) -> Any:
    pose = ets.fkine(q)
    return np.asarray(getattr(pose, "A", pose))


def _package() -> Any:
    try:
        import roboticstoolbox
    except ImportError as error:
        raise ImportError("to_ets needs the Robotics Toolbox: pip install 'armill[interop]'") from error
    return roboticstoolbox
