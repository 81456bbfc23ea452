"""The stiffness of the arm at the tool, by direction."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from armill.plot._style import BLUE, GREEN, ORANGE, SKY, legend_below, letters, number, one, picture, set_title


@picture
def stiffness(
    arm: Any,
    joints: ArrayLike,
    tool: ArrayLike | None = None,
    *,
    ax: Any = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Robot, (dof,) joints -> 3-D axes: the deviation of the tool under 1 N in all directions, µm/N, base axes.

    The forces form a sphere, the deviations an ellipsoid. Its half axes are the principal compliances; the legend gives the
    stiffness along each, N/µm. `tool` (4, 4) is flange_from_tool.
    """
    if not callable(getattr(arm, "compliance", None)):
        raise TypeError(f"stiffness: expected an armill.Robot, given {type(arm).__name__}")
    posture = np.asarray(joints, dtype=float)
    if posture.ndim != 1:
        raise ValueError(f"stiffness: joints: expected shape ({arm.dof},), given {posture.shape}")
    # µm/N: translations under forces are first in a compliance.
    c = 1e6 * np.asarray(arm.compliance(posture, tool))[:3, :3]
    sizes, axes = np.linalg.eigh((c + c.T) / 2)
    drawn = one(ax, (6.4, 6.4), "3d")
    ax = drawn
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 61), np.linspace(0, np.pi, 31))
    forces = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    x, y, z = np.einsum("ij,jkl->ikl", c, forces)
    ax.plot_surface(x, y, z, color=SKY, alpha=0.28, linewidth=0)
    ax.plot_wireframe(x, y, z, color=BLUE, linewidth=0.35, alpha=0.5, rstride=3, cstride=5)
    for size, axis, colour, name in zip(sizes[::-1], axes.T[::-1], (ORANGE, GREEN, BLUE), ("softest", "middle", "stiffest")):
        ends = np.array([-size * axis, size * axis])
        stiff = f"{number(1 / size)} N/µm" if size > 0 else "rigid"
        ax.plot(*ends.T, color=colour, linewidth=2.6, label=f"{name}: {number(size)} µm/N, {stiff}")
    half = 1.05 * float(sizes[-1]) or 1.0
    for axis_name in "xyz":
        getattr(ax, f"set_{axis_name}lim")(-half, half)
        getattr(ax, f"set_{axis_name}label")(f"{axis_name} (µm/N)", labelpad=6)
        ax.tick_params(axis=axis_name, labelsize=letters(8))
    ax.set_box_aspect((1, 1, 1))
    ax.view_init(elev=22, azim=-62)
    place = ", ".join(f"{part + 0.0:.0f}" for part in np.round(1e3 * np.asarray(arm.forward(posture, tool))[:3, 3]))
    set_title(ax, f"{arm.name}: compliance at the tool", f"TCP at ({place}) mm; deviation under 1 N, base axes")
    legend_below(ax, columns=1)
    return drawn
