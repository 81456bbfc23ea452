"""The region of a plane within the tolerance."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Patch, PathPatch, Rectangle
from matplotlib.path import Path

from armill.plot import _plane
from armill.plot._answers import Json, Source
from armill.plot._setting import words
from armill.plot._style import BLUE, INK, ORANGE, SKY, legend_below, one, picture, set_title

_POSSIBLY, _ROBUSTLY = "#d3e8f5", "#4a9fcf"


@picture
def region(
    source: Any,
    analysis: str | None = None,
    *,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Result, name of a map -> axes: the region within the tolerance, its uncertainty, and inscribed shapes.

    Robustly and possibly within are with twice the standard uncertainty added and subtracted.
    """
    answer = Source(source, "region").one("maps", analysis)
    found: Json = answer["region"]
    certainty: Json = answer["certainty"]
    y, z, _ = _plane.grid(answer, "in_plane_um")
    ax = one(ax, (6.4, 6.6))
    _plane.hatch(ax, answer, y, z)
    handles: list[Any] = []
    areas = (
        ("possibly within", certainty["boundary_possibly_mm"], certainty["area_possibly_mm2"], _POSSIBLY, "none", 1.0),
        ("within", found["boundary_mm"], found["area_mm2"], SKY, BLUE, 1.1),
        ("robustly within", certainty["boundary_robust_mm"], certainty["area_robust_mm2"], _ROBUSTLY, "none", 1.2),
    )
    for label, boundary, area_mm2, face, edge, order in areas:
        if boundary:
            ax.add_patch(PathPatch(outline(boundary), facecolor=face, edgecolor="none", zorder=order))
        if boundary and edge != "none":
            ax.add_patch(PathPatch(outline(boundary), facecolor="none", edgecolor=edge, linewidth=2.2, zorder=2))
        handles.append(Patch(facecolor=face, edgecolor=edge, linewidth=1.6, label=f"{label}: {_area(area_mm2)}"))
    if found["rectangle_mm"] is not None:
        (left, low), (right, high) = found["rectangle_mm"]
        corner, size = (min(left, right), min(low, high)), (abs(right - left), abs(high - low))
        label = f"rectangle {size[0]:.0f} mm x {size[1]:.0f} mm"
        shape = Rectangle(corner, *size, fill=False, edgecolor=INK, linewidth=1.4, linestyle="--", zorder=3, label=label)
        handles.append(ax.add_patch(shape))
    if found["circle_centre_mm"] is not None:
        radius = found["circle_radius_mm"]
        label = f"circle of radius {radius:.0f} mm"
        ring = Circle(found["circle_centre_mm"], radius, fill=False, edgecolor=ORANGE, linewidth=1.6, zorder=3, label=label)
        handles.append(ax.add_patch(ring))
    ax.set_xlim(y.max(), y.min())
    ax.set_ylim(z.min(), z.max())
    ax.set_aspect("equal")
    _plane.name_axes(ax)
    tolerance = answer["setting"]["tolerance_um"]
    share = f"{100 * answer['fraction_within']:.1f} % of the points within {tolerance:g} µm"
    set_title(ax, f"{answer['name']}: region within {tolerance:g} µm", f"{share}; {words(answer)}")
    handles += _plane.reason_handles([answer])
    legend_below(ax, 2, handles)
    return ax


def outline(boundary: list[list[list[float]]]) -> Path:
    """One path of closed lines; those inside others turn the other way, and so are holes."""
    loops = [np.array(line, dtype=float) for line in boundary]
    vertices: list[Any] = []
    codes: list[Any] = []
    for i, loop in enumerate(loops):
        inside = sum(Path(other).contains_point(loop[0]) for j, other in enumerate(loops) if j != i)
        x, y = loop.T
        turns_left = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) > 0
        if turns_left != (inside % 2 == 0):
            loop = loop[::-1]
        vertices.extend([*loop, loop[0]])
        codes.extend([Path.MOVETO, *[Path.LINETO] * (len(loop) - 1), Path.CLOSEPOLY])
    return Path(vertices, codes)


def _area(mm2: float) -> str:
    return f"{mm2 / 1e6:.3f} m²" if mm2 >= 1e5 else f"{mm2 / 1e2:.0f} cm²"
