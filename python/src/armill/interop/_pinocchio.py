"""Models of pinocchio."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

import armill
from armill.interop import _screws

# Names of the flange frame by default, in this order.
_FLANGES = ("tool0", "flange")


def to_pinocchio(robot: armill.Robot) -> Any:
    """Robot -> pinocchio.Model: one joint per joint of the robot, with its name and limits, and a frame `flange`. No masses."""
    pin = _package()
    found = _screws.of_robot(robot)
    model = pin.Model()
    model.name = robot.name
    parent = 0
    steps = found.steps()
    for step, joint in zip(steps, found.joints):
        placement = pin.SE3(np.eye(3), np.asarray(step))
        low, high = joint.limits if joint.limits is not None else (-np.inf, np.inf)
        free = np.full(1, np.inf)
        parent = model.addJoint(
            parent, _joint(pin, joint), placement, joint.name, free, free, np.array([low]), np.array([high])
        )
    last = pin.SE3(np.array(found.base_from_flange[:3, :3]), np.asarray(steps[-1]))
    model.addFrame(pin.Frame("flange", parent, last, pin.FrameType.OP_FRAME))
    data = model.createData()
    _screws.compared("to_pinocchio", robot.dof, lambda q: _forward(pin, (model, data, "flange"), q), robot.forward)
    return model


def from_pinocchio(model: Any, frame: str | None = None, *, name: str | None = None) -> armill.Robot:
    """pinocchio.Model -> Robot: a chain of revolute or prismatic joints, up to the frame `frame`.

    By default the flange is the frame `tool0`, else `flange`, else the last frame of the model. Masses and inertias are converted;
    those of rotors (`armature`) are not.
    """
    pin = _package()
    if not isinstance(model, pin.Model):
        raise TypeError(f"from_pinocchio: expected a pinocchio.Model, given {type(model).__name__}")
    flange = frame or next((known for known in _FLANGES if model.existFrame(known)), model.frames[-1].name)
    if not model.existFrame(flange):
        known = ", ".join(each.name for each in model.frames)
        raise ValueError(f"from_pinocchio: the model has no frame {flange!r}; it has {known}")
    count = model.njoints - 1
    if list(model.parents)[1:] != list(range(count)) or model.frames[model.getFrameId(flange)].parentJoint != count:
        raise ValueError(f"from_pinocchio: {flange!r} is not at the end of a chain without side branches: reduce the model first")
    if model.nv != count:
        raise ValueError(f"from_pinocchio: {count} joints have {model.nv} degrees of freedom: each must be revolute or prismatic with one axis")
    data = model.createData()
    limits = [_limits(model, i) for i in range(1, model.njoints)]
    zero = np.zeros(count)
    where = (model, data, flange)
    at_zero = (_forward(pin, where, zero), _jacobian(pin, where, zero))
    found = _screws.screws(name or model.name or "model", list(model.names)[1:], limits, at_zero)
    found = replace(found, bodies=tuple(_bodies(pin, model, data)))
    robot = _screws.to_robot(found, f"a model of pinocchio, {model.name}")
    _screws.compared("from_pinocchio", count, robot.forward, lambda q: _forward(pin, where, q))
    return robot


def _joint(pin: Any, joint: _screws.Joint) -> Any:
    axis = _screws.coordinate_axis(joint.direction)
    kind = "P" if joint.slides else "R"
    if axis is not None and axis[1] > 0:
        return getattr(pin, f"JointModel{kind}{axis[0].upper()}")()
    general = pin.JointModelPrismaticUnaligned if joint.slides else pin.JointModelRevoluteUnaligned
    return general(np.array(joint.direction))


def _bodies(pin: Any, model: Any, data: Any) -> list[_screws.Body]:
    """The links with masses, at zero joint positions."""
    pin.forwardKinematics(model, data, _configuration(pin, model, np.zeros(model.nv)))
    bodies: list[_screws.Body] = []
    for joint in range(1, model.njoints):
        inertia, place = model.inertias[joint], data.oMi[joint]
        if inertia.mass > 0:
            turned = place.rotation @ inertia.inertia @ place.rotation.T
            bodies.append(_screws.Body(joint - 1, float(inertia.mass), place.act(inertia.lever), turned))
    return bodies


def _limits(model: Any, joint: int) -> tuple[float, float] | None:
    at = model.joints[joint].idx_q
    if model.joints[joint].nq != 1:
        # A continuous joint has cosine and sine as coordinates.
        return None
    limits = model.lowerPositionLimit[at], model.upperPositionLimit[at]
    known = all(np.isfinite(limits)) and max(map(abs, limits)) < 1e6 and limits[0] < limits[1]
    return (float(limits[0]), float(limits[1])) if known else None


def _configuration(pin: Any, model: Any, q: Any) -> Any:
    return pin.integrate(model, pin.neutral(model), np.asarray(q, dtype=float))


def _forward(pin: Any, where: tuple[Any, Any, str], q: Any) -> Any:
    model, data, frame = where
    pin.framesForwardKinematics(model, data, _configuration(pin, model, q))
    return np.array(data.oMf[model.getFrameId(frame)].homogeneous)


def _jacobian(pin: Any, where: tuple[Any, Any, str], q: Any) -> Any:
    model, data, frame = where
    pin.computeJointJacobians(model, data, _configuration(pin, model, q))
    pin.updateFramePlacements(model, data)
    return np.array(pin.getFrameJacobian(model, data, model.getFrameId(frame), pin.LOCAL_WORLD_ALIGNED))


def _package() -> Any:
    try:
        import pinocchio  # type: ignore[import-untyped]
    except ImportError as error:
        raise ImportError("this needs pinocchio: pip install 'armill[interop]', or its wheel `pin`") from error
    return pinocchio
