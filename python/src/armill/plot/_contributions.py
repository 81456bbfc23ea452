"""The contribution of each joint to the deviation."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from armill.plot._answers import Json, Missing, Source
from armill.plot._setting import words
from armill.plot._style import COLOURS, INK, is_narrow, legend_below, letters, number, one, picture, set_title


@picture
def contributions(
    source: Any,
    analysis: str | None = None,
    *,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Result, name of a map or path -> axes: stacked bars, the contribution of each joint to the in-plane deviation, µm.

    For a map at the largest and smallest deviation, for a path at its worst points. Contributions that reduce the deviation are
    to the left of zero. All together add up to the deviation, which is marked by a line.
    """
    answer = _map_or_path(Source(source, "contributions"), analysis)
    points = _points(answer)
    names: list[str] = answer["setting"]["contributors"]
    values = np.array([point["joint_share_um"] for _, point in points], dtype=float)
    ax = one(ax, (7.2, 1.7 + 0.5 * len(points)))
    rows = np.arange(len(points))
    beyond, before = np.zeros(len(points)), np.zeros(len(points))
    for i, name in enumerate(names):
        # Up to sixteen contributors: eight colours, then the same hatched.
        pattern = "" if i < len(COLOURS) else "////"
        share = values[:, i]
        start = np.where(share >= 0, beyond, before)
        ax.barh(
            rows, share, left=start, height=0.62, color=COLOURS[i % len(COLOURS)], edgecolor="white", linewidth=0.6,
            hatch=pattern, label=name,
        )
        beyond, before = beyond + np.maximum(share, 0), before + np.minimum(share, 0)
    for row, (_, point) in enumerate(points):
        label = "deviation" if row == 0 else None
        ax.plot([point["in_plane_um"]] * 2, [row - 0.4, row + 0.4], color=INK, linewidth=1.6, label=label, zorder=3)
        ax.annotate(
            f"{number(point['in_plane_um'])} µm", (max(beyond[row], point["in_plane_um"]), row), xytext=(5, 0),
            textcoords="offset points", va="center", fontsize=letters(9), fontweight="bold",
        )
    ax.set_yticks(rows, [label for label, _ in points])
    ax.invert_yaxis()
    ax.axvline(0.0, color=INK, linewidth=0.8)
    ax.set_xlim(min(0.0, 1.08 * float(before.min())), 1.16 * float(beyond.max()))
    ax.set_xlabel("contribution (µm)" if is_narrow(ax) else "contribution to the in-plane deviation (µm)")
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right"]].set_visible(False)
    set_title(ax, f"{answer['name']}: contribution of each joint", words(answer))
    legend_below(ax, columns=min(8, len(names) + 1))
    return ax


def _map_or_path(source: Source, analysis: str | None) -> Json:
    """The map or path with this name; by default the first."""
    both: list[Json] = [*(source.data.get("maps") or []), *(source.data.get("paths") or [])]
    named = [each for each in both if analysis in (None, each["name"])]
    if named:
        return named[0]
    if not both:
        raise Missing("contributions: the answer has neither maps nor paths: give that of `armill run`")
    names = ", ".join(repr(each["name"]) for each in both)
    raise Missing(f"contributions: {analysis!r} is not among the maps and paths: {names}")


def _points(answer: Json) -> list[tuple[str, Json]]:
    if "worst_points" in answer:
        points = [(f"{i}: at {each['distance_mm']:.0f} mm", each["point"]) for i, each in enumerate(answer["worst_points"], 1)]
    else:
        points = [(label, answer[key]) for key, label in (("worst", "largest"), ("best", "smallest")) if answer[key] is not None]
    if not points:
        raise Missing(f"contributions: no point of {answer['name']!r} is reachable")
    return points


