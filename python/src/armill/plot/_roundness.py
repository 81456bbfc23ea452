"""A measured profile, and its four reference circles."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from armill.plot import _rings
from armill.plot._answers import Json, Source
from armill.plot._style import BLUE, GREEN, ORANGE, PINK, number, one, picture, set_title


@picture
def roundness(
    source: Any,
    *,
    table: Any = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Answer of roundness -> polar axes: the profile magnified, with the four reference circles, µm.

    The points are from `roundness.csv` that the command writes (``out=folder``), given as `table`, or from the folder; without
    them only the circles are drawn.
    """
    found = Source(source, "roundness", table)
    lsci: Json = found.need("lsci", "armill roundness")
    centre, radius = np.array(lsci["centre_mm"], dtype=float), float(lsci["radius_mm"])
    around = np.linspace(0, 2 * np.pi, 721)
    circles = _circles(found.data, centre, radius, around)
    curves = [values for _, _, _, values in circles]
    profile = None
    if found.has_table("roundness.csv"):
        columns = found.columns(None, ["angle_deg", "deviation_um"], file="roundness.csv")
        profile = (np.radians(columns["angle_deg"].astype(float)), columns["deviation_um"].astype(float))
        curves.append(profile[1])
    ax = one(ax, (6.4, 6.9), "polar")
    every = np.concatenate(curves)
    division = _rings.draw(ax, float(every.min()), float(every.max()), ("+x", "+y", "−x", "−y"))
    ax.set_rlabel_position(105.0)  # type: ignore[attr-defined]
    _rings.nominal(ax, division, f"LSCI, RONt {number(1e3 * lsci['ront_mm'])} µm")
    if profile is not None:
        ax.plot(*_rings.closed(*profile), color=BLUE, linewidth=1.2, label="profile")
    for label, colour, dashes, values in circles:
        ax.plot(around, values, color=colour, linestyle=dashes, linewidth=1.6, label=label)
    upr = found.data["filter_upr"]
    filtered = f"filtered at {upr:g} UPR" if upr is not None else "not filtered"
    conditions = f"{found.data['points']} points, radius {radius:.4f} mm, {filtered}"
    set_title(ax, f"Roundness of {found.data['file']}", conditions, _rings.LIFT)
    _rings.legend(ax, columns=2)
    return ax


def _circles(answer: Json, centre: Any, radius: float, around: NDArray[np.float64]) -> list[tuple[str | None, str, Any, Any]]:
    """Label, colour, dashes and deviation from the least-squares circle, µm, of every other circle."""

    def off(circle: Json, size: float) -> NDArray[np.float64]:
        x, y = np.array(circle["centre_mm"], dtype=float) - centre
        offset = x * np.sin(around) - y * np.cos(around)
        out: NDArray[np.float64] = x * np.cos(around) + y * np.sin(around) + np.sqrt(size * size - offset * offset) - radius
        return 1e3 * out

    circles: list[tuple[str | None, str, Any, Any]] = []
    if (mzci := answer["mzci"]) is not None:
        label = f"MZCI, RONt {number(1e3 * mzci['ront_mm'])} µm"
        for i, size in enumerate(mzci["radii_mm"]):
            circles.append((label if i == 0 else None, ORANGE, "-", off(mzci, size)))
    for key, colour, dashes in (("mcci", GREEN, (0, (5, 3))), ("mici", PINK, (0, (2, 2)))):
        if (circle := answer[key]) is not None:
            label = f"{key.upper()}, RONt {number(1e3 * circle['ront_mm'])} µm"
            circles.append((label, colour, dashes, off(circle, circle["radius_mm"])))
    return circles


