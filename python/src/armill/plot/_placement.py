"""What a place of the part is worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from armill.plot._answers import Json, Missing, Source
from armill.plot._style import AMBER, BLUE, FAINT, GREY, INK, LIMIT, legend_below, number, picture, several, title

_NAMES = {
    "x_mm": "x of the part (mm)",
    "y_mm": "y of the part (mm)",
    "z_mm": "z of the part (mm)",
    "heading_deg": "heading of the part (deg)",
    "tilt_deg": "tilt of the part (deg)",
    "roll_deg": "roll of the part (deg)",
    "spin_deg": "spin of the tool (deg)",
    "rail_mm": "rail (mm)",
}
_GOALS = {"worst": "largest", "mean": "mean", "above-tolerance": "above the limit, mean"}


@picture
def placement(
    source: Any,
    costs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    *,
    tolerance_um: float | None = None,
    ax: Sequence[Axes] | None = None,
) -> list[Axes]:
    """`placement.json`, costs over free degrees -> [front, a picture each degree]: what the place of the part is worth, µm.

    The front is the least deviation over the margin to joint limits and singularities. `costs` has for degrees such as `x_mm` the
    values and what comes of them, all else as it was found; NaN where the arm does not hold the path. `source` is the folder that
    `armill place` wrote, its `placement.json`, or the dict of it.
    """
    answer = Source(source, "placement", file="placement.json")
    by_margin: list[Json] = answer.need("by_margin", "armill place")
    costs = costs or {}
    unknown = [degree for degree in costs if degree not in _NAMES]
    if unknown:
        raise Missing(f"placement: costs: no degree is called {', '.join(unknown)}; there are {', '.join(_NAMES)}")
    count = 1 + len(costs)
    columns = min(2, count)
    axes = several(ax, count, (4.6 * columns + 1.2, 3.9 * -(-count // columns)), columns)
    _front(axes[0], answer.data, by_margin, tolerance_um)
    for each, (degree, (values, cost)) in zip(axes[1:], costs.items()):
        _degree(each, answer.data, degree, (np.asarray(values, dtype=float), np.asarray(cost, dtype=float)), tolerance_um)
    return axes


def _what(answer: Json) -> str:
    counted = {"in-plane": "in-plane", "cross-track": "cross-track", "axial": "axial"}[answer["counts"]]
    return f"{_GOALS[answer['goal']]} {counted} deviation (µm)"


def _front(ax: Axes, answer: Json, by_margin: list[Json], tolerance_um: float | None) -> None:
    known = [each for each in by_margin if each["cost_um"] is not None]
    margins = [each["margin_deg"] for each in known]
    ax.plot(margins, [each["cost_um"] for each in known], "o-", color=BLUE, markersize=5, label="least, by margin")
    found: Json = answer["found"]
    spread = 2 * found["cost_u_um"] if found["cost_u_um"] is not None else None
    ax.errorbar(
        answer["margin_deg"], found["cost_um"], yerr=spread, fmt="D", color=INK, markerfacecolor=AMBER, markersize=7, capsize=4,
        zorder=4, label="place found, ± 2 u",
    )
    drawn: Json = answer["nominal"]
    if drawn["unreachable_points"] == 0:
        ax.axhline(drawn["cost_um"], color=GREY, linestyle="--", label=f"as drawn {number(drawn['cost_um'])} µm")
    _limit(ax, tolerance_um)
    ax.set_ylim(bottom=0.0)
    ax.margins(y=0.1)
    ax.set_xlabel("margin to joint limits and singularities (deg)")
    ax.set_ylabel(_what(answer))
    x, y, z = answer["place"]["centre_mm"]
    place = f"({x:.0f}, {y:.0f}, {z:.0f}) mm"
    title(ax, f"{answer['analysis']}: what room costs", f"{number(found['cost_um'])} µm at {place}, {found['branch'] or 'best branch'}")
    legend_below(ax, columns=2, drop=-0.2)


def _degree(ax: Axes, answer: Json, degree: str, curve: tuple[Any, Any], tolerance_um: float | None) -> None:
    values, cost = curve
    if values.shape != cost.shape or values.ndim != 1:
        raise Missing(f"placement: costs: {degree} has {values.shape} values and {cost.shape} costs: give as many of each")
    free = {each["degree"]: each for each in answer["free"]}
    ax.plot(values, cost, color=BLUE, label="all else as found")
    lost = values[~np.isfinite(cost)]
    if len(lost):
        ax.plot(lost, np.zeros(len(lost)), "x", color=INK, markersize=4, label="not held everywhere", clip_on=False)
    if degree in free:
        told: Json = free[degree]
        ax.axvline(told["found"], color=AMBER, linewidth=2.0, label=f"found {told['found']:.1f}")
        for i, bound in enumerate((told["least"], told["greatest"])):
            if values.min() <= bound <= values.max():
                ax.axvline(bound, color=GREY, linestyle=":", label="bound" if i == 0 else None)
    _limit(ax, tolerance_um)
    ax.set_ylim(bottom=0.0)
    ax.grid(True, color=FAINT, linewidth=0.6)
    ax.set_xlabel(_NAMES[degree])
    ax.set_ylabel(_what(answer))
    title(ax, f"Over {_NAMES[degree].split(' (')[0]}", "all other degrees as they were found")
    legend_below(ax, columns=2, drop=-0.2)


def _limit(ax: Axes, tolerance_um: float | None) -> None:
    if tolerance_um is not None:
        ax.axhline(tolerance_um, color=LIMIT, linewidth=2.0, label=f"limit {tolerance_um:g} µm")
