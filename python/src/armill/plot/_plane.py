"""One plane as contours: what maps and sections share."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.contour import QuadContourSet
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from armill.plot._answers import Json, Missing
from armill.plot._style import COLOUR_MAP, HALO, INK, LIMIT

Floats = NDArray[np.float64]

VALUES = {
    "in_plane_um": "in-plane deviation (µm)",
    "in_plane_u_um": "standard uncertainty of the in-plane deviation (µm)",
    "normal_um": "deviation along the normal (µm)",
    "full_um": "deviation (µm)",
}
REASONS = {
    "too_far": ("too far", "///"),
    "too_near": ("too near", "\\\\\\"),
    "inside_lateral_offset": ("inside the lateral offset", "|||"),
    "no_posture_inside_limits": ("no posture inside joint limits", "xxx"),
    "not_found": ("no posture found", "---"),
    "other_branch": ("held in another branch only", "+++"),
    "unverified": ("not verified", "***"),
    "unstable": ("no stable rest under the load", "ooo"),
}


def grid(answer: Json, value: str) -> tuple[Floats, Floats, Floats]:
    """y' of the columns, z' of the rows, the values; NaN where the arm does not hold the tool."""
    if value not in VALUES:
        raise ValueError(f"value: expected one of {', '.join(VALUES)}; given {value!r}")
    cells: Json = answer["grid"]
    y, z = (np.array(cells[key], dtype=float) for key in ("y_mm", "z_mm"))
    if len(y) < 2 or len(z) < 2:
        raise Missing(f"{answer['name']}: a line of points is no map: give the plane a half size along y' and z'")
    values = np.array(cells[value], dtype=float).reshape(len(z), len(y))
    return y, z, values


def fill(ax: Axes, answer: Json, value: str, levels: Floats) -> QuadContourSet:
    """Bands between levels, and hatches where the arm does not hold the tool."""
    y, z, values = grid(answer, value)
    hatch(ax, answer, y, z)
    masked = np.ma.masked_invalid(values)
    norm = BoundaryNorm(levels, 256)
    with warnings.catch_warnings():
        # A plane out of reach as a whole has hatches alone.
        warnings.simplefilter("ignore", UserWarning)
        filled = ax.contourf(y, z, masked, levels=levels, cmap=COLOUR_MAP, norm=norm, zorder=1)
    # Seen from the tool side.
    ax.set_xlim(y.max(), y.min())
    ax.set_ylim(z.min(), z.max())
    ax.set_aspect("equal")
    return filled


def lines(ax: Axes, answer: Json, value: str, levels: Floats, labelled: bool) -> None:
    """Thin lines at the levels, with their values where they hide nothing."""
    y, z, values = grid(answer, value)
    if not crossed(values, levels):
        return
    inner = [level for level in levels if np.nanmin(values) < level < np.nanmax(values)]
    drawn = ax.contour(y, z, np.ma.masked_invalid(values), levels=inner, colors=INK, linewidths=0.5, zorder=2)
    if labelled:
        texts = ax.clabel(drawn, inline=False, fontsize=8, fmt=lambda level: f"{level:g}", colors=INK)
        for text in texts:
            text.set_path_effects(HALO)
            text.set_zorder(5)
        thin(ax, texts, [answer[key]["in_plane_mm"] for key in ("best", "worst")])


def limit_line(ax: Axes, answer: Json) -> bool:
    """The limit, bold; whether it crosses the plane."""
    y, z, values = grid(answer, "in_plane_um")
    limit = answer["setting"]["tolerance_um"]
    if not crossed(values, [limit]):
        return False
    halo: list[AbstractPathEffect] = [withStroke(linewidth=4.6, foreground="white")]
    ax.contour(
        y, z, np.ma.masked_invalid(values), levels=[limit], colors=LIMIT, linewidths=2.6, zorder=3
    ).set_path_effects(halo)
    return True


def crossed(values: Floats, levels: Iterable[float]) -> bool:
    """Whether a level lies between the least and the greatest value."""
    if not np.isfinite(values).any():
        return False
    low, high = np.nanmin(values), np.nanmax(values)
    return any(low < level < high for level in levels)


def hatch(ax: Axes, answer: Json, y: Floats, z: Floats) -> None:
    """Cells without an answer, each reason with a hatch of its own."""
    # A whole cell to all sides, since bands end at the last point that is held.
    half = (abs(y[1] - y[0]), abs(z[1] - z[0]))
    for remark in answer["grid"]["remarks"]:
        if remark["reason"] not in REASONS:
            continue
        points = np.array(remark["points"])
        centres = np.column_stack([y[points % len(y)], z[points // len(y)]])
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        cells = [centre + np.multiply(corner, half) for centre in centres for corner in [*corners, corners[0]]]
        codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY] * len(centres)
        _, pattern = REASONS[remark["reason"]]
        ax.add_patch(
            PathPatch(Path(cells, codes), facecolor="#f2f2f2", edgecolor="#8c8c8c", hatch=pattern, linewidth=0.0, zorder=0.5)
        )


def reason_handles(answers: Iterable[Json]) -> list[Any]:
    """What the hatches mean, with how many points there are of each."""
    counts: dict[str, int] = {}
    for answer in answers:
        for remark in answer["grid"]["remarks"]:
            if remark["reason"] in REASONS:
                counts[remark["reason"]] = counts.get(remark["reason"], 0) + len(remark["points"])
    return [
        Patch(
            facecolor="#f2f2f2", edgecolor="#8c8c8c", linewidth=0.0, hatch=REASONS[reason][1],
            label=f"{REASONS[reason][0]} ({count} {'point' if count == 1 else 'points'})",
        )
        for reason, count in counts.items()
    ]


def thin(ax: Axes, texts: Iterable[Text], marked: Iterable[Any]) -> None:
    """Takes away labels that lie over others, over points that are marked, or across the edge of the axes."""
    figure = ax.get_figure(root=True)
    if figure is not None:
        figure.draw_without_rendering()
    kept: list[Any] = [Bbox.from_bounds(x - 8, y - 8, 16, 16) for x, y in (ax.transData.transform(place) for place in marked)]
    frame = ax.get_window_extent()
    for text in texts:
        box = text.get_window_extent()
        inside = frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1
        if inside and not any(box.expanded(1.1, 1.1).overlaps(other) for other in kept):
            kept.append(box)
        else:
            text.remove()


def name_axes(ax: Axes) -> None:
    """Axes of the plane, seen from the tool side."""
    ax.set_xlabel("across, y′ (mm)")
    ax.set_ylabel("along the plane, z′ (mm)")


def mark_limit(bar_ax: Axes, limit: float) -> None:
    """The limit on the bar of colours."""
    low, high = sorted(bar_ax.get_ylim())
    if low < limit < high:
        bar_ax.axhline(limit, color="white", linewidth=4.2)
        bar_ax.axhline(limit, color=LIMIT, linewidth=2.6)


