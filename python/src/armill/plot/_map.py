"""The deviation over a plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from armill.plot import _plane
from armill.plot._answers import Source
from armill.plot._setting import words
from armill.plot._style import AMBER, INK, TOLERANCE, colour_bar, legend_below, number, one, picture, rounded, set_title


@picture
def map(
    source: Any,
    analysis: str | None = None,
    *,
    value: str = "in_plane_um",
    levels: Sequence[float] | None = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
    cmap: Any = None,
    cbar: bool = True,
) -> Axes:
    """Result, name of a map -> axes: contours of the deviation over a plane, µm.

    The tolerance is bold. Unreachable parts of the plane are hatched, with the reason in the legend. `value` is a list of the
    grid: in_plane_um, in_plane_u_um, normal_um, full_um. The plane is seen from the tool side: y' points to the left.
    """
    answer = Source(source, "map").one("maps", analysis)
    _, _, values = _plane.grid(answer, value)
    reached = bool(np.isfinite(values).any())
    default = rounded(*((np.nanmin(values), np.nanmax(values)) if reached else (0.0, 1.0)))
    steps = np.unique(np.asarray(levels, dtype=float)) if levels is not None else default
    ax = one(ax, (6.4, 6.6))
    filled = _plane.fill(ax, answer, value, steps)
    _plane.name_axes(ax)
    set_title(ax, answer["name"], words(answer))
    handles: list[Any] = []
    bar = colour_bar(filled, ax, _plane.VALUES[value], shrink=0.8) if reached else None
    if reached and value == "in_plane_um":
        tolerance = answer["setting"]["tolerance_um"]
        if bar is not None:
            _plane.mark_tolerance(bar.ax, tolerance)
        beyond = "" if _plane.tolerance_line(ax, answer) else ", not crossed"
        handles.append(Line2D([], [], color=TOLERANCE, linewidth=2.6, label=f"tolerance {tolerance:g} µm{beyond}"))
        for key, label, marker, face in (("best", "smallest", "D", AMBER), ("worst", "largest", "o", "white")):
            point = answer[key]
            place = point["in_plane_mm"]
            caption = f"{label} {number(point['in_plane_um'])} µm"
            handles.extend(
                ax.plot(
                    *place, marker, markersize=7, markerfacecolor=face, markeredgecolor=INK, markeredgewidth=1.4,
                    linestyle="none", label=caption, zorder=6, clip_on=False,
                )
            )
    handles += _plane.reason_handles([answer])
    legend_below(ax, 2, handles)
    # Last, when the axes have their size: labels are kept apart in it.
    _plane.lines(ax, answer, value, steps, labelled=True)
    return ax
