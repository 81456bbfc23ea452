"""The deviation along a path."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from armill.plot._answers import Source
from armill.plot._setting import breaks, words
from armill.plot._style import BLUE, GREEN, HALO, INK, ORANGE, PINK, TOLERANCE, legend_below, letters, one, picture, set_title

_PARTS = (
    ("in_plane_um", "in-plane, across the tool", INK, "-", 1.9),
    ("along_um", "along the track", BLUE, "--", 1.3),
    ("cross_um", "across the track, to its left", ORANGE, "-", 1.3),
    ("axial_um", "along the tool, away from the part", GREEN, "-.", 1.3),
)


@picture
def along(
    source: Any,
    analysis: str | None = None,
    *,
    table: Any = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Result, name of a path -> axes: the deviation and its components along the path, µm over mm.

    The worst points are numbered, the worst first. Components are those of the worst load case.
    """
    found = Source(source, "along", table)
    answer = found.one("paths", analysis)
    columns = found.columns(answer["name"], ["x_mm", "y_mm", "z_mm", "distance_mm", *(name for name, *_ in _PARTS)])
    ax = one(ax, (7.6, 4.6))
    # Separate cuts are not joined by a line.
    gaps = breaks(columns)
    distance = np.insert(columns["distance_mm"].astype(float), gaps, np.nan)
    for name, label, colour, dashes, width in _PARTS:
        values = np.insert(columns[name].astype(float), gaps, np.nan)
        ax.plot(distance, values, color=colour, linestyle=dashes, linewidth=width, label=label)
    tolerance = answer["setting"]["tolerance_um"]
    ax.axhline(tolerance, color=TOLERANCE, linewidth=2.2, label=f"tolerance {tolerance:g} µm", zorder=1.5)
    ax.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    _mark_worst(ax, answer["worst_points"])
    unreachable = ~np.isfinite(columns["in_plane_um"].astype(float))
    if unreachable.any():
        here = columns["distance_mm"].astype(float)[unreachable]
        ax.plot(here, np.zeros(len(here)), "x", color=PINK, markersize=4, label=f"unreachable ({len(here)} points)")
    known = distance[np.isfinite(distance)]
    ax.set_xlim(0.0, float(known.max()) if len(known) else 1.0)
    ax.margins(y=0.12)
    ax.set_xlabel("along the path (mm)")
    ax.set_ylabel("deviation (µm)")
    set_title(ax, f"{answer['name']}: deviation along the path", words(answer))
    legend_below(ax, columns=2)
    return ax


def _mark_worst(ax: Axes, worst: list[Any]) -> None:
    for i, point in enumerate(worst, start=1):
        place = (point["distance_mm"], point["point"]["in_plane_um"])
        label = f"worst points: 1 by {point['cause']}" if i == 1 else None
        ax.plot(*place, "o", markersize=5, markerfacecolor="white", markeredgecolor=INK, zorder=4, clip_on=False, label=label)
        ax.annotate(
            str(i), place, xytext=(0, 7), textcoords="offset points", fontsize=letters(9), fontweight="bold", ha="center", path_effects=HALO
        )
