"""The common form for all packages: the joint axes at zero joint positions.

    base_from_flange(q) = exp(S1 q1) ... exp(Sn qn) base_from_flange(0)

The screw S of a joint is read off the Jacobian at zero: its column has the velocity v that it gives the flange, and the direction a
of its axis, which passes through flange + a x v. Source: Lynch & Park, Modern Robotics, 2017, chapter 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import armill

Floats = NDArray[np.float64]

# Directions and lengths (m) nearer to a coordinate axis or to zero than this are that: rounding of a Jacobian, no more.
_ROUNDING = 1e-12
# How far a chain may be from the one that it was made of, m and rad.
_SAME = 1e-9
# Joint positions at which they are compared.
_COMPARED = 8


@dataclass(frozen=True)
class Joint:
    """A joint at zero: its name, whether it slides, direction and a point of its axis in base, limits (rad, m) or None."""

    name: str
    slides: bool
    direction: Floats
    point: Floats
    limits: tuple[float, float] | None


@dataclass(frozen=True)
class Body:
    """A link at zero: the index of its joint, its mass, its centre of mass in base, and its inertia about that in base axes."""

    joint: int
    mass: float
    centre: Floats
    inertia: Floats


@dataclass(frozen=True)
class Screws:
    """Joints from base to flange, the pose of the flange at zero joint positions, and the links with masses."""

    name: str
    joints: list[Joint]
    base_from_flange: Floats
    bodies: tuple[Body, ...] = ()

    def steps(self) -> list[Floats]:
        """From the point of each axis to that of the next, and last to the flange, m, base axes."""
        points = [np.zeros(3), *(joint.point for joint in self.joints), self.base_from_flange[:3, 3]]
        return [_snapped(after - before) for before, after in zip(points, points[1:])]


def screws(
    name: str,
    names: Sequence[str],
    limits: Sequence[tuple[float, float] | None],
    at_zero: tuple[ArrayLike, ArrayLike],
) -> Screws:
    """(4, 4) pose and (6, n) Jacobian of the flange at zero, translation first -> the joints."""
    pose, jacobian = (np.asarray(each, dtype=float) for each in at_zero)
    flange = pose[:3, 3]
    joints: list[Joint] = []
    near = np.zeros(3)
    for i, column in enumerate(jacobian.T):
        v, a = column[:3], column[3:]
        slides = bool(np.linalg.norm(a) < _ROUNDING)
        direction = _snapped((v if slides else a) / np.linalg.norm(v if slides else a))
        if not slides:
            on_axis = flange + np.cross(a, v)
            # The point of the axis nearest to the point of the previous axis.
            near = on_axis + direction * ((near - on_axis) @ direction)
        joints.append(Joint(names[i], slides, direction, _snapped(near), limits[i]))
    return Screws(name, joints, pose)


def of_robot(robot: armill.Robot) -> Screws:
    """The screws of an arm."""
    zero = np.zeros(robot.dof)
    limits = [(float(low), float(high)) if np.isfinite([low, high]).all() else None for low, high in robot.limits]
    return screws(robot.name, robot.joint_names, limits, (robot.forward(zero), robot.jacobian(zero)))


def to_robot(found: Screws, source: str) -> armill.Robot:
    """The arm with these joints; `source` states their origin."""
    return armill.Robot.from_text(_toml(found, source), "armill", name=found.name)


def compared(
    what: str,
    count: int,
    made: Callable[[Floats], ArrayLike],
    given: Callable[[Floats], ArrayLike],
) -> None:
    """Refuses a chain that differs from its original: coupled joints, or joints that are neither revolute nor prismatic."""
    random = np.random.default_rng(1)
    for _ in range(_COMPARED):
        q = random.uniform(-1.0, 1.0, count)
        off = float(np.abs(np.asarray(made(q)) - np.asarray(given(q))).max())
        if not off < _SAME:
            raise ValueError(
                f"{what}: the converted chain differs by {off:.3g} (m, rad): coupled joints, and joints that are neither "
                "revolute nor prismatic, cannot be converted"
            )


def coordinate_axis(direction: Floats) -> tuple[str, int] | None:
    """The coordinate axis along a direction, and 1 or -1."""
    i = int(np.argmax(np.abs(direction)))
    return ("xyz"[i], int(np.sign(direction[i]))) if abs(direction[i]) == 1.0 else None


def turned_to(direction: Floats) -> tuple[float, float]:
    """Angles about z, then y, that turn z onto a direction, rad."""
    x, y, z = direction
    return float(np.arctan2(y, x)), float(np.arctan2(np.hypot(x, y), z))


def fixed_angles(rotation: Floats) -> tuple[float, float, float]:
    """Angles about z, then y, then x of the frame reached so far, rad."""
    pitch = float(np.arctan2(-rotation[2, 0], np.hypot(rotation[0, 0], rotation[1, 0])))
    if abs(abs(pitch) - np.pi / 2) < _ROUNDING**0.5:
        # About z and x alike: all of it about z.
        return float(np.arctan2(-rotation[0, 1], rotation[1, 1])), pitch, 0.0
    roll = float(np.arctan2(rotation[2, 1], rotation[2, 2]))
    return float(np.arctan2(rotation[1, 0], rotation[0, 0])), pitch, roll


def _snapped(values: Floats) -> Floats:
    whole = np.round(values)
    return np.where(np.abs(values - whole) < _ROUNDING, whole, values)


def _toml(found: Screws, source: str) -> str:
    motions: list[str] = []
    joints: list[str] = []
    steps = found.steps()
    for step, joint in zip(steps, found.joints):
        motions += _along(step)
        axis = coordinate_axis(joint.direction)
        sign = axis[1] if axis is not None else 1
        turns = [] if axis is not None else list(zip("zy", turned_to(joint.direction)))
        verb = "along" if joint.slides else "about"
        motions += [_about(name, angle) for name, angle in turns]
        motions.append(f'{{ {verb} = "{axis[0] if axis else "z"}", joint = {_text(joint.name)} }}')
        motions += [_about(name, -angle) for name, angle in reversed(turns)]
        joints.append(_joint(joint, sign))
    motions += _along(steps[-1])
    angles = zip("zyx", fixed_angles(found.base_from_flange[:3, :3]))
    motions += [_about(name, angle) for name, angle in angles if abs(angle) > _ROUNDING]
    listed = "".join(f"  {motion},\n" for motion in motions)
    place = f'what = "chain and joint limits"\nwhere = {_text(source)}\nlicence = "that of the model"\n'
    head = f"format = 1\nname = {_text(found.name)}\n\n[chain]\nsource = \"given\"\nmotions = [\n{listed}]\n"
    masses = "".join(_mass(found.joints[body.joint], body) for body in found.bodies)
    return f"{head}\n{''.join(joints)}{masses}[sources.given]\n{place}"


def _mass(joint: Joint, body: Body) -> str:
    """The table of a link, in the frame right after the motion of its joint."""
    axes = np.eye(3)
    if coordinate_axis(joint.direction) is None:
        about_z, about_y = turned_to(joint.direction)
        (c, s), (d, t) = ((np.cos(angle), np.sin(angle)) for angle in (about_z, about_y))
        axes = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[d, 0, t], [0, 1, 0], [-t, 0, d]])
    centre = [1e3 * float(part) for part in axes.T @ (body.centre - joint.point)]
    inertia = axes.T @ body.inertia @ axes
    rows = [[float(part) for part in row] for row in (inertia + inertia.T) / 2]
    numbers = f"mass_kg = {body.mass!r}\ncentre_mm = {centre!r}\ninertia_kg_m2 = {rows!r}\n"
    return f'[[mass]]\nat = {_text(joint.name)}\n{numbers}source = "given"\n\n'


def _along(step: Floats) -> list[str]:
    return [f'{{ along = "{name}", length_mm = {1e3 * float(part)!r} }}' for name, part in zip("xyz", step) if part]


def _about(name: str, angle: float) -> str:
    return f'{{ about = "{name}", angle_deg = {float(np.degrees(angle))!r} }}'


def _joint(joint: Joint, sign: int) -> str:
    limits = ""
    if joint.limits is not None:
        unit, factor = ("mm", 1e3) if joint.slides else ("deg", 180 / np.pi)
        low, high = (factor * limit for limit in joint.limits)
        limits = f"limits_{unit} = [{low!r}, {high!r}]\n"
    return f'[[joint]]\nname = {_text(joint.name)}\nsign = {sign}\n{limits}source = "given"\n\n'


def _text(text: Any) -> str:
    escaped = str(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
