"""A path, coloured by the deviation."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import BoundaryNorm

from armill.plot import _plane
from armill.plot._answers import Source
from armill.plot._setting import breaks, in_plane, words
from armill.plot._style import HALO, INK, colour_bar, colour_map, legend_below, letters, number, one, picture, rounded, set_title

_NEEDED = ("x_mm", "y_mm", "z_mm", "distance_mm", "in_plane_um")


@picture
def path(
    source: Any,
    analysis: str | None = None,
    *,
    table: Any = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
    cmap: Any = None,
    cbar: bool = True,
) -> Axes:
    """Result, name of a path -> axes: the path in its plane, coloured by the deviation across the tool, µm.

    The worst points are numbered, the worst first. Unreachable segments are dotted.
    """
    found = Source(source, "path", table)
    answer = found.one("paths", analysis)
    columns = found.columns(answer["name"], _NEEDED)
    across, up = in_plane(answer, columns)
    values = columns["in_plane_um"].astype(float)
    ends = np.column_stack([across, up])
    segments = np.stack([ends[:-1], ends[1:]], axis=1)
    colours = np.fmax(values[:-1], values[1:])
    drawn = np.ones(len(segments), dtype=bool)
    drawn[breaks(columns) - 1] = False
    lost = drawn & ~(np.isfinite(values[:-1]) & np.isfinite(values[1:]))
    shown = drawn & ~lost
    ax = one(ax, (6.6, 5.8))
    if lost.any():
        ax.add_collection(LineCollection(list(segments[lost]), colors=INK, linestyles=":", linewidths=1.0, label="unreachable"))
    if shown.any():
        steps = rounded(float(colours[shown].min()), float(colours[shown].max()))
        lines = LineCollection(list(segments[shown]), cmap=colour_map(), norm=BoundaryNorm(steps, 256), linewidths=4.0)
        lines.set_array(colours[shown])
        lines.set_capstyle("round")
        ax.add_collection(lines)
        bar = colour_bar(lines, ax, "deviation across the tool (µm)", shrink=0.85)
        if bar is not None:
            _plane.mark_tolerance(bar.ax, answer["setting"]["tolerance_um"])
    for i, point in enumerate(answer["worst_points"], start=1):
        y, z = point["point"]["in_plane_mm"]
        label = f"worst points: {number(answer['max_in_plane_um'])} µm at 1" if i == 1 else None
        ax.plot(y, z, "o", markersize=5, markerfacecolor="white", markeredgecolor=INK, zorder=4, label=label)
        ax.annotate(
            str(i), (y, z), xytext=(6, 5), textcoords="offset points", fontsize=letters(9), fontweight="bold", path_effects=HALO, zorder=5
        )
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    ax.margins(0.12)
    # Seen from the tool side.
    ax.invert_xaxis()
    _plane.name_axes(ax)
    tolerance = answer["setting"]["tolerance_um"]
    share = f"{100 * answer['fraction_within']:.1f} % within {tolerance:g} µm"
    set_title(ax, answer["name"], f"{share}; {words(answer)}")
    legend_below(ax, 2)
    return ax
