"""The style of the pictures: sizes, colours, titles and axes.

Settings are changed while a picture is drawn and restored afterwards. Fonts are those of the caller. Colours are those of Okabe
and Ito, and viridis: they are distinguishable with colour-blindness, and in print without colour.
"""

from __future__ import annotations

import functools
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

BLUE, ORANGE, GREEN, PINK = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
SKY, AMBER, YELLOW, GREY = "#56b4e9", "#e69f00", "#f0e442", "#999999"
COLOURS = (BLUE, ORANGE, GREEN, PINK, SKY, AMBER, YELLOW, GREY)
INK, SOFT, FAINT, TOLERANCE = "#1a1a1a", "#5a5a5a", "#dddddd", "#c8102e"
COLOUR_MAP = "viridis"
HALO: list[AbstractPathEffect] = [withStroke(linewidth=2.5, foreground="white")]

_RULES: dict[str, Any] = {
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "axes.titlesize": 11,
    "axes.grid": False,
    "axes.axisbelow": True,
    "figure.constrained_layout.use": False,
    "font.size": 9,
    "hatch.linewidth": 0.6,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "text.color": INK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
}

P = ParamSpec("P")
T = TypeVar("T")


def picture(draw: Callable[P, T]) -> Callable[P, T]:
    """A function that draws with the settings above and restores them afterwards.

    All other settings are left as they are, so that a backend may change its own when it starts with the first figure.
    """

    @functools.wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> T:
        settings: Any = mpl.rcParams
        before = {key: settings[key] for key in _RULES}
        settings.update(_RULES)
        try:
            return draw(*args, **kwargs)
        finally:
            settings.update(before)

    return drawn


def one(ax: Any, size: tuple[float, float], projection: str | None = None) -> Axes:
    """The given axes, or those of a new figure of ``size`` in inches."""
    if ax is None:
        figure = plt.figure(figsize=size, layout="constrained")
        return _settled(figure.add_subplot(projection=projection))
    if not isinstance(ax, Axes):
        raise TypeError(f"ax: expected matplotlib axes, given {type(ax).__name__}")
    expected = projection or "rectilinear"
    if ax.name != expected:
        raise ValueError(f"ax: expected {expected} axes, as by figure.add_subplot(projection={projection!r}); these are {ax.name}")
    return ax


def several(
    ax: Sequence[Axes] | NDArray[Any] | None,
    count: int,
    size: tuple[float, float],
    columns: int,
    **shared: Any,
) -> list[Axes]:
    """``count`` given axes, or those of a new figure."""
    if ax is None:
        rows = -(-count // columns)
        figure = plt.figure(figsize=size, layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False, **shared)
        for spare in grid.flat[count:]:
            spare.set_axis_off()
        return [_settled(each) for each in grid.flat[:count]]
    given = list(np.ravel(np.asarray(ax, dtype=object)))
    if len(given) < count:
        raise ValueError(f"ax: expected {count} axes, given {len(given)}")
    return [one(each, size) for each in given[:count]]


def _settled(ax: Axes) -> Axes:
    """Ticks are created when a figure is drawn: their style is set here."""
    for name in ("x", "y"):
        ax.tick_params(axis=name, which="both", color=INK, labelcolor=INK, labelsize=8.5, width=0.8)
    return ax


def title(ax: Axes, text: str, subtitle: str = "", lift: float = 0.0) -> None:
    """A bold title on the left with a subtitle; `lift` points higher, above labels on top of the axes."""
    width = _room(ax)
    lines = textwrap.wrap(subtitle, max(24, int(13.0 * width)))
    heading = textwrap.fill(text, max(18, int(9.0 * width)))
    # With `y` given, matplotlib does not move the title.
    ax.set_title(heading, loc="left", fontweight="bold", y=1.0, pad=7 + lift + 11.5 * len(lines))
    if lines:
        note = ax.annotate(
            "\n".join(lines), (0, 1), xycoords="axes fraction", xytext=(0, 5 + lift), textcoords="offset points",
            color=SOFT, fontsize=8.5, va="bottom", annotation_clip=False,
        )
        note.set_in_layout(False)


def _room(ax: Axes) -> float:
    """The width for a title, in inches: that of the column of the axes."""
    figure = ax.get_figure(root=True)
    width = float(figure.get_size_inches()[0]) if figure is not None else 6.4
    cell = ax.get_subplotspec()
    if cell is None:
        return width * ax.get_position().width
    return width * len(cell.colspan) / cell.get_gridspec().ncols


def legend_below(ax: Axes, columns: int = 3, drop: float = -0.13) -> None:
    """A legend below the axes."""
    handles, _ = ax.get_legend_handles_labels()
    if handles:
        ax.legend(loc="upper left", bbox_to_anchor=(0.0, drop), ncols=columns, borderaxespad=0.0, columnspacing=1.4)


def rounded(low: float, high: float, about: int = 8) -> NDArray[np.float64]:
    """About ``about`` round levels from ``low`` to ``high``."""
    if not high > low:
        high = low + max(abs(low) * 1e-3, 1e-3)
    return np.asarray(MaxNLocator(nbins=about, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high), dtype=float)


def number(value: float) -> str:
    """A value with three significant digits."""
    if value == 0 or not np.isfinite(value):
        return "0" if value == 0 else "-"
    decimals = max(0, 2 - int(np.floor(np.log10(abs(value)))))
    return f"{value:.{decimals}f}"
