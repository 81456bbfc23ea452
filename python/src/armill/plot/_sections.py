"""Many planes in one figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from armill.plot import _plane
from armill.plot._answers import Json, Missing, Source
from armill.plot._setting import words
from armill.plot._style import TOLERANCE, colour_bar, legend_below, letters, picture, rounded, several


@picture
def sections(
    source: Any,
    analysis: str | None = None,
    *,
    levels: Sequence[float] | None = None,
    ax: Sequence[Axes] | None = None,
    title: str | bool = True,
    legend: bool = True,
    cmap: Any = None,
    cbar: bool = True,
) -> list[Axes]:
    """Result, name of an analysis for sections -> list of axes, one per plane: deviation over distances or tilts, µm.

    All planes have the same levels. `ax` takes as many axes as there are planes.
    """
    found = Source(source, "sections")
    planes, name = _of_one_analysis(found.need("maps", "armill run"), analysis)
    values = [_plane.grid(plane, "in_plane_um")[2] for plane in planes]
    known = np.concatenate([each[np.isfinite(each)] for each in values])
    if not known.size:
        raise Missing(f"sections: no point of {name!r} is reachable")
    steps = np.asarray(levels, dtype=float) if levels is not None else rounded(known.min(), known.max(), 9)
    columns = 4 if len(planes) in (4, 7, 8) or len(planes) > 9 else min(3, len(planes))
    rows = -(-len(planes) // columns)
    size = (2.35 * columns + 1.2, 2.45 * rows + 1.3)
    axes = several(ax, len(planes), size, columns, sharex=True, sharey=True)
    bands: list[Any] = []
    for i, (each, plane) in enumerate(zip(axes, planes)):
        drawn = _plane.fill(each, plane, "in_plane_um", steps)
        bands += [drawn] if np.isfinite(values[i]).any() else []
        _plane.lines(each, plane, "in_plane_um", steps, labelled=False)
        _plane.tolerance_line(each, plane)
        label = plane["name"].removeprefix(f"{name}: ")
        share = 100 * plane["fraction_within"]
        each.set_title(f"{label}\n{share:.0f} % within", loc="left", fontsize=letters(9))
        each.label_outer()
    figure: Any = axes[0].get_figure(root=True)
    for i, each in enumerate(axes):
        if i % columns == 0:
            each.set_ylabel("z′ (mm)")
        if i + columns >= len(planes):
            each.set_xlabel("y′ (mm)")
            each.tick_params(labelbottom=True)
    tolerance = planes[0]["setting"]["tolerance_um"]
    bar = colour_bar(bands[0], axes, _plane.VALUES["in_plane_um"], shrink=0.8, aspect=28)
    if bar is not None:
        _plane.mark_tolerance(bar.ax, tolerance)
    handles = [Line2D([], [], color=TOLERANCE, linewidth=2.6, label=f"tolerance {tolerance:g} µm"), *_plane.reason_handles(planes)]
    if title and (ax is None or isinstance(title, str)):
        heading = title if isinstance(title, str) else f"{name}: {_shared(planes[0])}"
        figure.suptitle(heading, x=0.01, ha="left", fontsize=letters(11), fontweight="bold")
    if figure.get_layout_engine() is None:
        legend_below(axes[columns * (rows - 1)], 3, handles)
    elif legend:
        fits = max(1, min(3, len(handles), int(figure.get_size_inches()[0] / 2.2)))
        figure.legend(handles=handles, loc="outside lower left", ncols=fits, handlelength=2.4)
    return axes


def _of_one_analysis(maps: list[Json], analysis: str | None) -> tuple[list[Json], str]:
    """The planes `ANALYSIS: ...` of one analysis, and its name."""
    names = list(dict.fromkeys(plane["name"].rsplit(": ", 1)[0] for plane in maps if ": " in plane["name"]))
    if not names:
        raise Missing("sections: the answer has no sections: an analysis of kind `sections` gives them")
    name = names[0] if analysis is None else analysis
    planes = [plane for plane in maps if plane["name"].startswith(f"{name}: ")]
    if not planes:
        raise Missing(f"sections: {name!r} is not among the sections: {', '.join(map(repr, names))}")
    return planes, name


def _shared(plane: Json) -> str:
    """The common setting of all planes, in words."""
    parts = [part for part in words(plane).split(", ") if not part.startswith("tilt ")]
    return ", ".join(parts)



