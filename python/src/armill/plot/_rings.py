"""Radial deviations round a circle, magnified: what polar pictures share.

The radius of a picture is the deviation itself, in µm: the nominal circle is at 0, with room inside for negative values.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from armill.plot._style import FAINT, HALO, INK, SOFT, legend_below, letters, rounded

Floats = NDArray[np.float64]


def draw(ax: Axes, low: float, high: float, directions: tuple[str, str, str, str]) -> float:
    """Rings from below ``low`` to above ``high`` µm, and the names of the four directions; gives the division."""
    span = max(high - low, 1e-6)
    rings = rounded(min(low, 0.0), max(high, 0.0), 6)
    division = float(rings[1] - rings[0])
    ax.set_rorigin(rings[0] - 0.55 * max(span, rings[-1] - rings[0]))  # type: ignore[attr-defined]
    ax.set_ylim(rings[0], rings[-1])
    # The outermost has no label: the labels of the directions are there.
    ax.set_yticks(rings, [*(f"{ring:+g} µm" if ring else "0 µm" for ring in rings[:-1]), ""])
    for label in ax.get_yticklabels():
        label.set_path_effects(HALO)
        label.set_zorder(6)
    ax.tick_params(axis="y", labelsize=letters(8), labelcolor=INK)
    turns = np.arange(0, 360, 30)
    names = [directions[turn // 90] if turn % 90 == 0 else f"{turn}°" for turn in turns]
    ax.set_xticks(np.radians(turns), names)
    for turn, label in zip(turns, ax.get_xticklabels()):
        label.set_fontweight("bold" if turn % 90 == 0 else "normal")
        label.set_color(INK if turn % 90 == 0 else SOFT)
    ax.grid(True, color=FAINT, linewidth=0.7)
    for name in ("polar", "inner"):
        ax.spines[name].set_color(FAINT)
    return division


# Points by which titles are above the label of the direction at the top.
LIFT = 20.0


def nominal(ax: Axes, division: float, what: str = "nominal circle") -> None:
    """The circle from which deviations count."""
    around = np.linspace(0, 2 * np.pi, 361)
    label = f"{what}; one ring {division:g} µm"
    ax.plot(around, np.zeros_like(around), color=INK, linestyle="--", linewidth=1.0, label=label, zorder=2.2)


def closed(angles: Floats, values: Floats) -> tuple[Floats, Floats]:
    """The points with the first one repeated at the end, if they form a full circle."""
    order = np.argsort(angles, kind="stable")
    angles, values = angles[order], values[order]
    steps = np.diff(angles)
    around = 2 * np.pi - (angles[-1] - angles[0])
    if len(steps) and around <= 2.5 * float(np.max(steps)):
        return np.append(angles, angles[0] + 2 * np.pi), np.append(values, values[0])
    return angles, values


def legend(ax: Axes, columns: int = 3) -> None:
    """The legend under the picture."""
    legend_below(ax, columns, centred=True)
