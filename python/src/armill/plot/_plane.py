"""One plane as contours, for maps and sections."""

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
from armill.plot._style import HALO, INK, TOLERANCE, colour_map, is_narrow, letters

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
    "other_branch": ("reachable in another branch only", "+++"),
    "unverified": ("not verified", "***"),
    "unstable": ("no stable equilibrium under the load", "ooo"),
}


def grid(answer: Json, value: str) -> tuple[Floats, Floats, Floats]:
    """y' of the columns, z' of the rows, the values; NaN where unreachable."""
    if value not in VALUES:
        raise ValueError(f"value: expected one of {', '.join(VALUES)}; given {value!r}")
    cells: Json = answer["grid"]
    y, z = (np.array(cells[key], dtype=float) for key in ("y_mm", "z_mm"))
    if len(y) < 2 or len(z) < 2:
        raise Missing(f"{answer['name']}: a line of points is not a map: give the plane a half size along y' and z'")
    values = np.array(cells[value], dtype=float).reshape(len(z), len(y))
    return y, z, values


def fill(ax: Axes, answer: Json, value: str, levels: Floats) -> QuadContourSet:
    """Bands between levels, and hatches where unreachable."""
    y, z, values = grid(answer, value)
    hatch(ax, answer, y, z)
    masked = np.ma.masked_invalid(values)
    norm = BoundaryNorm(levels, 256)
    with warnings.catch_warnings():
        # A plane that is unreachable as a whole has only hatches.
        warnings.simplefilter("ignore", UserWarning)
        filled = ax.contourf(y, z, masked, levels=levels, cmap=colour_map(), norm=norm, zorder=1)
    # Seen from the tool side.
    ax.set_xlim(y.max(), y.min())
    ax.set_ylim(z.min(), z.max())
    ax.set_aspect("equal")
    return filled


def lines(ax: Axes, answer: Json, value: str, levels: Floats, labelled: bool) -> None:
    """Thin lines at the levels, with their values where there is room."""
    y, z, values = grid(answer, value)
    if not crossed(values, levels):
        return
    inner = [level for level in levels if np.nanmin(values) < level < np.nanmax(values)]
    drawn = ax.contour(y, z, np.ma.masked_invalid(values), levels=inner, colors=INK, linewidths=0.5, zorder=2)
    if labelled:
        texts = ax.clabel(drawn, inline=False, fontsize=letters(8), fmt=lambda level: f"{level:g}", colors=INK)
        for text in texts:
            text.set_path_effects(HALO)
            text.set_zorder(5)
        thin(ax, texts, [answer[key]["in_plane_mm"] for key in ("best", "worst")])


def tolerance_line(ax: Axes, answer: Json) -> bool:
    """The tolerance as a bold contour; whether it crosses the plane."""
    y, z, values = grid(answer, "in_plane_um")
    tolerance = answer["setting"]["tolerance_um"]
    if not crossed(values, [tolerance]):
        return False
    halo: list[AbstractPathEffect] = [withStroke(linewidth=4.6, foreground="white")]
    ax.contour(
        y, z, np.ma.masked_invalid(values), levels=[tolerance], colors=TOLERANCE, linewidths=2.6, zorder=3
    ).set_path_effects(halo)
    return True


def crossed(values: Floats, levels: Iterable[float]) -> bool:
    """Whether a level is between the smallest and the largest value."""
    if not np.isfinite(values).any():
        return False
    low, high = np.nanmin(values), np.nanmax(values)
    return any(low < level < high for level in levels)


def hatch(ax: Axes, answer: Json, y: Floats, z: Floats) -> None:
    """Cells without a value, with one hatch per reason."""
    # A whole cell to all sides, since bands end at the last reachable point.
    half = (abs(y[1] - y[0]), abs(z[1] - z[0]))
    for flag in answer["grid"]["flags"]:
        if flag["reason"] not in REASONS:
            continue
        points = np.array(flag["points"])
        centres = np.column_stack([y[points % len(y)], z[points // len(y)]])
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        cells = [centre + np.multiply(corner, half) for centre in centres for corner in [*corners, corners[0]]]
        codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY] * len(centres)
        _, pattern = REASONS[flag["reason"]]
        ax.add_patch(
            PathPatch(Path(cells, codes), facecolor="#f2f2f2", edgecolor="#8c8c8c", hatch=pattern, linewidth=0.0, zorder=0.5)
        )


def reason_handles(answers: Iterable[Json]) -> list[Any]:
    """Legend entries of the hatches, with the number of points of each."""
    counts: dict[str, int] = {}
    for answer in answers:
        for flag in answer["grid"]["flags"]:
            if flag["reason"] in REASONS:
                counts[flag["reason"]] = counts.get(flag["reason"], 0) + len(flag["points"])
    return [
        Patch(
            facecolor="#f2f2f2", edgecolor="#8c8c8c", linewidth=0.0, hatch=REASONS[reason][1],
            label=f"{REASONS[reason][0]} ({count} {'point' if count == 1 else 'points'})",
        )
        for reason, count in counts.items()
    ]


def thin(ax: Axes, texts: Iterable[Text], marked: Iterable[Any]) -> None:
    """Removes labels that overlap others, marked points, or the edge of the axes."""
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
    narrow = is_narrow(ax)
    ax.set_xlabel("y′ (mm)" if narrow else "across, y′ (mm)")
    ax.set_ylabel("z′ (mm)" if narrow else "along the plane, z′ (mm)")


def mark_tolerance(bar_ax: Axes, tolerance: float) -> None:
    """The tolerance on the colour bar."""
    low, high = sorted(bar_ax.get_ylim())
    if low < tolerance < high:
        bar_ax.axhline(tolerance, color="white", linewidth=4.2)
        bar_ax.axhline(tolerance, color=TOLERANCE, linewidth=2.6)


