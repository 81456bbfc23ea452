"""The arm as a line from base to tool."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from armill.plot._style import BLUE, GREEN, GREY, INK, ORANGE, legend_below, letters, one, picture, set_title

Floats = NDArray[np.float64]

# Axes whose angle has a sine below this are parallel.
_PARALLEL = 1e-6


@picture
def robot(
    arm: Any,
    joints: ArrayLike,
    tool: ArrayLike | None = None,
    *,
    ax: Any = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Robot, (dof,) or (n, dof) joints -> 3-D axes: the arm in each posture, mm, counted from base.

    Dots are where one axis passes nearest to the next, which need not be where the castings bend. The last posture is drawn
    bold, those before it faintly. `tool` (4, 4) is flange_from_tool; orange, green and black are its axes x, y, z.
    """
    if not callable(getattr(arm, "with_compliance", None)):
        raise TypeError(f"robot: expected an armill.Robot, given {type(arm).__name__}")
    postures = np.atleast_2d(np.asarray(joints, dtype=float))
    drawn = one(ax, (6.4, 6.4), "3d")
    ax = drawn
    every = [np.zeros((1, 3))]
    for i, posture in enumerate(postures):
        last = i == len(postures) - 1
        line, pose = 1e3 * skeleton(arm, posture, tool), np.asarray(arm.forward(posture, tool))
        every.append(line)
        colour = BLUE if last else GREY
        ax.plot(
            *line.T, color=colour, linewidth=4.0 if last else 2.0, alpha=1.0 if last else 0.5, marker="o",
            markersize=6 if last else 3, markerfacecolor="white", markeredgecolor=colour, solid_joinstyle="round",
            label=("posture" if len(postures) == 1 else "last posture") if last else ("others" if i == 0 else None),
        )
        if last:
            _axes_of_tool(ax, pose, 0.12 * float(np.ptp(np.vstack(every), axis=0).max()))
    _shadow(ax, every[-1])
    _box(ax, np.vstack(every))
    set_title(ax, arm.name, f"TCP at {_place(every[-1][-1])} mm")
    legend_below(ax, columns=5)
    return drawn


def skeleton(arm: Any, posture: Floats, tool: ArrayLike | None = None) -> Floats:
    """(m, 3) points from base to TCP, m: feet of the shortest lines between one axis and the next.

    An axis of direction a that gives the TCP the velocity v passes through TCP + a x v. Prismatic joints have a
    direction but no position, and are omitted.
    """
    tip = np.asarray(arm.forward(posture, tool))[:3, 3]
    screws = [(screw[:3], screw[3:]) for screw in _screws(arm, posture, tool)]
    turning = [(v, a) for v, a in screws if np.linalg.norm(a) > _PARALLEL]
    points = [np.zeros(3)]
    before: tuple[Floats, Floats] | None = None
    for v, a in turning:
        at = tip + np.cross(a, v)
        here = at + a * ((points[-1] - at) @ a)
        points.extend([here] if before is None else _feet(before, (at, a), points[-1]))
        before = (at, a)
    points.append(tip)
    return np.array(points)


def _screws(arm: Any, posture: Floats, tool: ArrayLike | None) -> list[Floats]:
    """The twist of the TCP by each axis of the chain, translation first, with either sign.

    Not the columns of the Jacobian: the columns of coupled joints move two axes. The compliance of one joint alone is
    C = c S S', which has its screw S.
    """
    rigid = np.zeros(arm.dof)
    others = np.asarray(arm.with_compliance(rigid).compliance(posture, tool))
    found: list[Floats] = []
    for i in range(arm.dof):
        alone = rigid.copy()
        alone[i] = 1.0
        c = np.asarray(arm.with_compliance(alone).compliance(posture, tool)) - others
        largest = int(np.argmax(np.diag(c)))
        found.append(c[largest] / np.sqrt(c[largest, largest]))
    return found


def _feet(one_axis: tuple[Floats, Floats], other: tuple[Floats, Floats], near: Floats) -> list[Floats]:
    """The foot on the one axis and that on the other; of parallel axes those nearest to `near`."""
    (p, a), (q, b) = one_axis, other
    across = np.cross(a, b)
    size = across @ across
    if size < _PARALLEL**2:
        foot = p + a * ((near - p) @ a)
        return [foot, q + b * ((foot - q) @ b)]
    between = q - p
    s = np.linalg.det(np.array([between, b, across])) / size
    t = np.linalg.det(np.array([between, a, across])) / size
    return [p + s * a, q + t * b]


def _axes_of_tool(ax: Axes, pose: Floats, length: float) -> None:
    at = 1e3 * pose[:3, 3]
    for i, (colour, name) in enumerate(((ORANGE, "x"), (GREEN, "y"), (INK, "z"))):
        end = at + length * pose[:3, i]
        label = f"tool {name}"
        ax.plot(*np.array([at, end]).T, color=colour, linewidth=2.2, label=label)


def _shadow(ax: Axes, line: Floats) -> None:
    floor = line.copy()
    floor[:, 2] = min(0.0, float(line[:, 2].min()))
    ax.plot(*floor.T, color=GREY, linewidth=1.2, alpha=0.6)


def _box(ax: Any, points: Floats) -> None:
    """The same scale along all three axes, and room about the arm."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = (low + high) / 2, 0.58 * float((high - low).max())
    for name, centre in zip("xyz", middle):
        getattr(ax, f"set_{name}lim")(centre - half, centre + half)
        getattr(ax, f"set_{name}label")(f"{name} (mm)", labelpad=6)
        ax.tick_params(axis=name, labelsize=letters(8))
    ax.set_box_aspect((1, 1, 1))
    ax.view_init(elev=22, azim=-62)


def _place(point: Floats) -> str:
    return "(" + ", ".join(f"{part + 0.0:.0f}" for part in np.round(point)) + ")"


