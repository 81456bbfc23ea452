"""The spin of the tool along a path, among all possible spins."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike, NDArray

from armill.plot._answers import Columns, Json, Missing, Source
from armill.plot._setting import words
from armill.plot._style import INK, colour_bar, colour_map, legend_below, one, picture, rounded, set_title

_SLIDES = "_mm"


@picture
def turns(
    source: Any,
    analysis: str | None = None,
    *,
    robot: Any = None,
    tool: ArrayLike | None = None,
    turn_count: int = 73,
    table: Any = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
    cmap: Any = None,
    cbar: bool = True,
) -> Axes:
    """Result and name of a path with a search -> axes: the chosen spin of the tool, deg over mm.

    With `robot` (armill.Robot) and `tool` (4, 4) flange_from_tool also the deviation at `turn_count` other spins, in the same
    branch under the load cases of the path, µm; unreachable spins are hatched.
    """
    found = Source(source, "turns", table)
    answer = found.one("paths", analysis)
    if answer["search"] is None:
        raise Missing(f"turns: {answer['name']!r} has no search: an analysis with `posture.search` has one")
    columns = found.columns(answer["name"], ["line", "distance_mm", "turn_deg"])
    distance, chosen = (columns[name].astype(float) for name in ("distance_mm", "turn_deg"))
    ax = one(ax, (7.6, 4.8))
    if robot is not None:
        _lattice(ax, answer, columns, (robot, tool), turn_count)
    # The spin may exceed half a turn: it is shown modulo one turn.
    within = (chosen + 180.0) % 360.0 - 180.0
    around = np.flatnonzero(np.abs(np.diff(within)) > 180.0) + 1
    along, turned = (np.insert(values, around, np.nan) for values in (distance, within))
    colour = INK if robot is None else "white"
    line = ax.plot(along, turned, color=colour, linewidth=2.2, label="chosen spin", zorder=4)
    if robot is not None:
        line[0].set_path_effects([*_outline()])
    for place in answer["search"]["breaks"]:
        for at in distance[columns["line"].astype(float) == place][:1]:
            ax.axvline(at, color=INK, linestyle=":", linewidth=1.2, label="change of posture")
    ax.set_xlim(float(np.nanmin(distance)), float(np.nanmax(distance)))
    ax.set_ylim(-180, 180)
    ax.set_yticks(range(-180, 181, 60))
    ax.set_xlabel("along the path (mm)")
    ax.set_ylabel("spin of the tool (deg)")
    better = f"largest {answer['max_in_plane_um']:.1f} µm, without search {answer['search']['without']['max_in_plane_um']:.1f} µm"
    set_title(ax, f"{answer['name']}: spin of the tool", f"{better}; {words(answer)}")
    legend_below(ax)
    return ax


def _outline() -> list[Any]:
    from matplotlib.patheffects import Normal, Stroke

    return [Stroke(linewidth=4.6, foreground=INK), Normal()]


def _lattice(ax: Axes, answer: Json, columns: Columns, arm: tuple[Any, Any], turn_count: int) -> None:
    """The deviation at all points and spins, evaluated by the arm."""
    robot, tool = arm
    cases: list[list[float]] = answer["setting"]["cases_n"]
    if not cases or answer["setting"]["load_frame"] != "base_link":
        raise Missing("turns: the load varies along this path: only the chosen spin can be drawn, without robot=")
    all_turns = np.linspace(-180.0, 180.0, turn_count)
    joints = _joints(answer, columns, robot)
    chosen = columns["turn_deg"].astype(float)
    known = np.flatnonzero(np.isfinite(joints).all(axis=1))
    poses: NDArray[np.float64] = robot.forward(joints[known], tool)
    about = np.radians(all_turns[:, None] - chosen[None, known])
    spun = np.zeros((*about.shape, 4, 4))
    spun[..., 0, 0] = spun[..., 1, 1] = np.cos(about)
    spun[..., 1, 0] = np.sin(about)
    spun[..., 0, 1] = -spun[..., 1, 0]
    spun[..., 2, 2] = spun[..., 3, 3] = 1.0
    requested = (poses[None] @ spun).reshape(-1, 4, 4)
    branch = answer["followed_branch"] or "best"
    normal = answer["setting"]["normal_axis"]
    found = robot.evaluate(requested, np.asarray(cases, dtype=float), tool, branch=branch, normal=normal)
    values = np.full((turn_count, len(joints)), np.nan)
    valid = np.asarray(found.reachable) & np.asarray(found.within_limits)
    values[:, known] = np.where(valid, 1e6 * np.asarray(found.in_plane), np.nan).reshape(about.shape)
    distance = columns["distance_mm"].astype(float)
    ax.set_facecolor("#f2f2f2")
    finite = values[np.isfinite(values)]
    if not finite.size:
        raise Missing("turns: the arm reaches none of these spins in the branch of the path: check the arm and the tool")
    steps = rounded(float(finite.min()), float(finite.max()))
    mesh = ax.pcolormesh(
        distance, all_turns, np.ma.masked_invalid(values), cmap=colour_map(), norm=BoundaryNorm(steps, 256), shading="nearest",
        rasterized=True,
    )
    colour_bar(mesh, ax, "in-plane deviation (µm)")
    if not valid.all():
        unreachable = np.isnan(values).astype(float)
        ax.contourf(distance, all_turns, unreachable, levels=[0.5, 1.5], colors="none", hatches=["///"])
        ax.add_patch(
            Rectangle(
                (0, 0), 0, 0, facecolor="#f2f2f2", edgecolor="#8c8c8c", hatch="///", linewidth=0,
                label="out of reach or outside joint limits",
            )
        )


def _joints(answer: Json, columns: Columns, robot: Any) -> NDArray[np.float64]:
    """(n, dof) joint positions of the table, rad (m)."""
    names: list[str] = list(robot.joint_names)
    needed = [f"joint_{name}_deg" if f"joint_{name}_deg" in columns else f"joint_{name}{_SLIDES}" for name in names]
    missing = [name for name in needed if name not in columns]
    if missing:
        raise Missing(f"turns: the table of {answer['name']!r} is of another arm: it has no {', '.join(missing)}")
    return np.column_stack(
        [columns[name].astype(float) * (1e-3 if name.endswith(_SLIDES) else np.pi / 180) for name in needed]
    )


