"""The cost of placements of the part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from armill.plot._answers import Json, Missing, Source
from armill.plot._style import AMBER, BLUE, FAINT, GREY, INK, TOLERANCE, is_narrow, legend_below, number, picture, several, set_title

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
_GOALS = {"worst": "largest", "mean": "mean", "above-tolerance": "above the tolerance, mean"}


@picture
def placement(
    source: Any,
    costs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    *,
    tolerance_um: float | None = None,
    ax: Sequence[Axes] | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> list[Axes]:
    """`placement.json`, costs over free coordinates -> [front, one axes per coordinate]: cost of placements, µm.

    The front is the smallest deviation over the margin to joint limits and singularities. `costs` has the values and costs of
    coordinates such as `x_mm`, with all others as recommended; NaN where the path is not reachable. `source` is the folder that
    `armill place` wrote, its `placement.json`, or the dict of it.
    """
    answer = Source(source, "placement", file="placement.json")
    by_margin: list[Json] = answer.need("by_margin", "armill place")
    costs = costs or {}
    unknown = [degree for degree in costs if degree not in _NAMES]
    if unknown:
        raise Missing(f"placement: costs: {', '.join(unknown)} is not a coordinate: they are {', '.join(_NAMES)}")
    count = 1 + len(costs)
    columns = min(2, count)
    axes = several(ax, count, (4.6 * columns + 1.2, 3.9 * -(-count // columns)), columns)
    _front(axes[0], answer.data, by_margin, tolerance_um)
    for each, (degree, (values, cost)) in zip(axes[1:], costs.items()):
        _degree(each, answer.data, degree, (np.asarray(values, dtype=float), np.asarray(cost, dtype=float)), tolerance_um)
    return axes


def _what(answer: Json) -> str:
    component = {"in-plane": "in-plane", "cross-track": "cross-track", "axial": "axial"}[answer["component"]]
    return f"{_GOALS[answer['objective']]} {component} deviation (µm)"


def _front(ax: Axes, answer: Json, by_margin: list[Json], tolerance_um: float | None) -> None:
    known = [each for each in by_margin if each["cost_um"] is not None]
    margins = [each["margin_deg"] for each in known]
    ax.plot(margins, [each["cost_um"] for each in known], "o-", color=BLUE, markersize=5, label="smallest, by margin")
    recommended: Json = answer["recommended"]
    spread = 2 * recommended["cost_u_um"] if recommended["cost_u_um"] is not None else None
    ax.errorbar(
        answer["margin_deg"], recommended["cost_um"], yerr=spread, fmt="D", color=INK, markerfacecolor=AMBER, markersize=7, capsize=4,
        zorder=4, label="recommended placement, ± 2 u",
    )
    drawn: Json = answer["nominal"]
    if drawn["unreachable_points"] == 0:
        ax.axhline(drawn["cost_um"], color=GREY, linestyle="--", label=f"nominal {number(drawn['cost_um'])} µm")
    _tolerance(ax, tolerance_um)
    ax.set_ylim(bottom=0.0)
    ax.margins(y=0.1)
    ax.set_xlabel("margin (deg)" if is_narrow(ax) else "margin to joint limits and singularities (deg)")
    ax.set_ylabel(_what(answer))
    x, y, z = answer["place"]["centre_mm"]
    place = f"({x:.0f}, {y:.0f}, {z:.0f}) mm"
    set_title(ax, f"{answer['analysis']}: cost of the margin", f"{number(recommended['cost_um'])} µm at {place}, {recommended['branch'] or 'best branch'}")
    legend_below(ax, columns=2)


def _degree(ax: Axes, answer: Json, degree: str, curve: tuple[Any, Any], tolerance_um: float | None) -> None:
    values, cost = curve
    if values.shape != cost.shape or values.ndim != 1:
        raise Missing(f"placement: costs: {degree} has {values.shape} values and {cost.shape} costs: give the same number of both")
    free = {each["degree"]: each for each in answer["free"]}
    ax.plot(values, cost, color=BLUE, label="others as recommended")
    unreachable = values[~np.isfinite(cost)]
    if len(unreachable):
        ax.plot(unreachable, np.zeros(len(unreachable)), "x", color=INK, markersize=4, label="not reachable everywhere", clip_on=False)
    if degree in free:
        degree_of_freedom: Json = free[degree]
        ax.axvline(degree_of_freedom["value"], color=AMBER, linewidth=2.0, label=f"recommended {degree_of_freedom['value']:.1f}")
        for i, bound in enumerate((degree_of_freedom["least"], degree_of_freedom["greatest"])):
            if values.min() <= bound <= values.max():
                ax.axvline(bound, color=GREY, linestyle=":", label="bound" if i == 0 else None)
    _tolerance(ax, tolerance_um)
    ax.set_ylim(bottom=0.0)
    ax.grid(True, color=FAINT, linewidth=0.6)
    ax.set_xlabel(_NAMES[degree])
    ax.set_ylabel(_what(answer))
    set_title(ax, f"Over {_NAMES[degree].split(' (')[0]}", "all other coordinates as recommended")
    legend_below(ax, columns=2)


def _tolerance(ax: Axes, tolerance_um: float | None) -> None:
    if tolerance_um is not None:
        ax.axhline(tolerance_um, color=TOLERANCE, linewidth=2.0, label=f"tolerance {tolerance_um:g} µm")
