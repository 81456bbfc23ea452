"""The springs of an arm, identified from load tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from armill.plot._answers import Json, Source
from armill.plot._style import BLUE, FAINT, HALO, INK, ORANGE, legend_below, number, picture, several, set_title

# (value, uncertainty, factor to the unit of the axis, its label) of springs that turn and springs that slide.
_KINDS = (
    ("compliance_rad_per_n_m", "compliance_u_rad_per_n_m", 1e6, "compliance (µrad/(N m))"),
    ("compliance_um_per_n", "compliance_u_um_per_n", 1.0, "compliance (µm/N)"),
)
@picture
def identify(
    source: Any,
    *,
    ax: Sequence[Axes] | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> list[Axes]:
    """Answer of identify -> [springs, residuals]: compliances with intervals of ± 2 u, and the residual of each test, µm.

    Hollow symbols: springs that the tests determine by less than half; their values are mostly prior knowledge. Prismatic
    springs, if there are any, have separate axes before the residuals.
    """
    found = Source(source, "identify")
    springs: list[Json] = found.need("springs", "armill identify")
    kinds = [kind for kind in _KINDS if any(spring[kind[0]] is not None for spring in springs)]
    rows = [[spring for spring in springs if spring[kind[0]] is not None] for kind in kinds]
    count = len(kinds) + 1
    if ax is None:
        axes = _sheet([len(each) for each in rows])
    else:
        axes = several(ax, count, (7.0, 8.0), 1)
    for each, kind, some in zip(axes, kinds, rows):
        _springs(each, found.data, kind, some)
    _residuals(axes[-1], found.data)
    return axes


def _sheet(counts: list[int]) -> list[Axes]:
    import matplotlib.pyplot as plt

    heights = [1.4 + 0.24 * count for count in counts]
    figure = plt.figure(figsize=(7.4, sum(heights) + 3.4), layout="constrained")
    axes = figure.subplots(len(counts) + 1, 1, height_ratios=[*heights, 3.2], squeeze=False)
    return several(list(axes.flat), len(counts) + 1, (7.4, 8.0), 1)


def _springs(ax: Axes, answer: Json, kind: tuple[str, str, float, str], springs: list[Json]) -> None:
    value, spread, factor, label = kind
    shown: set[bool] = set()
    means = [factor * spring[value] for spring in springs]
    lows = [mean - 2 * factor * (spring[spread] or 0.0) for mean, spring in zip(means, springs)]
    # A logarithmic scale has no zero: intervals that include zero start at the left edge.
    edge = 0.3 * min((low if low > 0 else mean for low, mean in zip(lows, means) if mean > 0), default=1e-3)
    for i, spring in enumerate(springs):
        known = spring["fraction_known_from_tests"] >= 0.5
        mean, low = means[i], max(lows[i], edge)
        what = "determined by the tests, ± 2 u" if known else "mostly prior knowledge, ± 2 u"
        ax.plot([low, 2 * mean - lows[i]], [i, i], color=BLUE if known else ORANGE, linewidth=2.2, solid_capstyle="butt")
        ax.plot(
            mean, i, "o", markersize=6, color=BLUE if known else ORANGE, markerfacecolor=BLUE if known else "white",
            label=None if known in shown else what, linestyle="none",
        )
        shown.add(known)
    ax.set_xscale("log")
    ax.set_xlim(left=edge)
    ax.set_yticks(range(len(springs)), [spring["name"] for spring in springs])
    ax.set_ylim(len(springs) - 0.4, -0.6)
    ax.grid(True, axis="x", color=FAINT, linewidth=0.6)
    ax.set_xlabel(label)
    counts = f"{answer['tests']} tests, {answer['readings']} readings"
    set_title(ax, f"{answer['robot']}: springs", f"{counts}; intervals from the left edge include zero")
    legend_below(ax, columns=2)


def _residuals(ax: Axes, answer: Json) -> None:
    tests: list[Json] = answer["by_test"]
    numbers = np.arange(1, len(tests) + 1)
    for key, label, marker, colour in (
        ("residual_um", "with this test used", "o", BLUE),
        ("left_out_um", "predicted without it", "_", INK),
    ):
        sizes = [_size(test[key]) for test in tests]
        ax.plot(numbers, sizes, marker, color=colour, markersize=4 if marker == "o" else 7, linestyle="none", label=label)
    ax.vlines(numbers, 0, [_size(test["residual_um"]) for test in tests], color=BLUE, linewidth=1.0)
    for i, test in enumerate(tests, start=1):
        if test["outlier"]:
            ax.annotate(
                f"{test['name']}: outlier", (i, _size(test["residual_um"])), xytext=(6, 2), textcoords="offset points",
                color=ORANGE, fontweight="bold", path_effects=HALO,
            )
    known = [(key, name) for key, name in (("residual", "used"), ("left_out", "left out")) if answer[key]]
    means = ", ".join(f"{name} {number(answer[key]['mean_um'])} µm" for key, name in known)
    ax.set_xlim(0, len(tests) + 1)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("test, in the order of the table")
    ax.set_ylabel("distance from the\nprediction (µm)")
    set_title(ax, "Residuals", f"mean {means}")
    legend_below(ax, columns=2)


def _size(residual: list[float | None] | None) -> float:
    if residual is None:
        return float("nan")
    return float(np.linalg.norm([part for part in residual if part is not None]))
