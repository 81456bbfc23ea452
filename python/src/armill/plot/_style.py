"""The style of the pictures: sizes, colours, titles and axes.

Settings are changed while a picture is drawn and restored afterwards; those that differ from the defaults of matplotlib are
the caller's and are kept. Colours are those of Okabe and Ito, and viridis: they are distinguishable with colour-blindness, and
in print without colour.
"""

from __future__ import annotations

import functools
import inspect
import textwrap
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

BLUE, ORANGE, GREEN, PINK = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
SKY, AMBER, YELLOW, GREY = "#56b4e9", "#e69f00", "#f0e442", "#999999"
COLOURS = (BLUE, ORANGE, GREEN, PINK, SKY, AMBER, YELLOW, GREY)
INK, SOFT, FAINT, TOLERANCE = "#1a1a1a", "#5a5a5a", "#dddddd", "#c8102e"
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


#: Axes narrower than this, in inches, have a short title and small letters, as in a column of a journal.
NARROW = 4.5
#: Size of letters in wide axes, points, to which all others are in proportion.
_BASE = 9.0


@dataclass
class Look:
    """What the caller wants of a picture: the options that all have. A title of the caller is that of the first axes."""

    title: str | bool = True
    legend: bool = True
    cmap: Any = None
    cbar: bool = True


_LOOK: ContextVar[Look] = ContextVar("_LOOK")


def picture(draw: Callable[P, T]) -> Callable[P, T]:
    """A function that draws with the settings above and restores them afterwards.

    All other settings are left as they are, so that a backend may change its own when it starts with the first figure. The
    options ``title``, ``legend``, ``cmap`` and ``cbar`` of the function apply to the helpers of this file.
    """
    names = [name for name in inspect.signature(draw).parameters if name in Look.__dataclass_fields__]

    @functools.wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> T:
        settings: Any = mpl.rcParams
        defaults: Any = mpl.rcParamsDefault
        rules = {key: value for key, value in _RULES.items() if settings[key] == defaults[key]}
        before = {key: settings[key] for key in rules}
        settings.update(rules)
        options: dict[str, Any] = {name: kwargs[name] for name in names if name in kwargs}
        token = _LOOK.set(Look(**options))
        try:
            return draw(*args, **kwargs)
        finally:
            _LOOK.reset(token)
            settings.update(before)

    return drawn


def letters(size: float) -> float:
    """A size of letters, points, in proportion to that of the settings."""
    return size * float(mpl.rcParams["font.size"]) / _BASE


def colour_map() -> Any:
    """The colour map of the caller, or that of the settings."""
    chosen = _LOOK.get().cmap
    return mpl.rcParams["image.cmap"] if chosen is None else chosen


def colour_bar(drawn: Any, ax: Any, label: str, **options: Any) -> Any:
    """A colour bar next to the axes; None if the caller wants none."""
    if not _LOOK.get().cbar:
        return None
    first = ax if isinstance(ax, Axes) else ax[0]
    if is_narrow(first):
        options = {"aspect": 25, "pad": 0.03, "fraction": 0.06} | options
    return first.figure.colorbar(drawn, ax=ax, label=label, **options)


def wants_legend() -> bool:
    """Whether the caller wants a legend."""
    return _LOOK.get().legend


def is_narrow(ax: Axes) -> bool:
    """Whether the axes are those of a column of a journal."""
    return _room(ax) < NARROW


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
    return _settled(ax) if is_narrow(ax) else ax


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
    settings: Any = mpl.rcParams
    for name in ("x", "y"):
        getattr(ax, f"{name}axis").label.set_size(settings["axes.labelsize"])
        ax.tick_params(axis=name, which="both", color=INK, labelcolor=INK, labelsize=settings[f"{name}tick.labelsize"], width=0.8)
    return ax


def set_title(ax: Axes, text: str, subtitle: str = "", lift: float = 0.0) -> None:
    """A bold title on the left with a subtitle; `lift` points higher, above labels on top of the axes.

    A title of the caller has no subtitle, nor have narrow axes.
    """
    look = _LOOK.get()
    if look.title is False or look.title == "":
        return
    width, scale, heading = _room(ax), letters(1.0), text
    if isinstance(look.title, str):
        heading, subtitle = look.title, ""
        look.title = True
    elif width < NARROW:
        subtitle = ""
    size: dict[str, Any] = {"fontsize": letters(9.0)} if width < NARROW else {}
    lines = textwrap.wrap(subtitle, max(24, int(13.0 * width / scale)))
    heading = textwrap.fill(heading, max(18, int((8.5 if size else 9.0) * width / scale)))
    # With `y` given, matplotlib does not move the title.
    ax.set_title(heading, loc="left", fontweight="bold", y=1.0, pad=7 + lift + 11.5 * scale * len(lines), **size)
    if lines:
        note = ax.annotate(
            "\n".join(lines), (0, 1), xycoords="axes fraction", xytext=(0, 5 + lift), textcoords="offset points",
            color=SOFT, fontsize=letters(8.5), va="bottom", annotation_clip=False,
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


def legend_below(ax: Axes, columns: int = 3, handles: list[Any] | None = None, centred: bool = False) -> None:
    """A legend below the axes and their labels, in one or two columns below narrow ones."""
    if handles is None:
        handles, _ = ax.get_legend_handles_labels()
    if not handles or not wants_legend():
        return
    options: dict[str, Any] = {"columnspacing": 1.4}
    labels = [str(handle.get_label()) for handle in handles]
    if is_narrow(ax):
        options = {"fontsize": letters(7.0), "columnspacing": 1.0, "handlelength": 1.6, "labelspacing": 0.3}
        # As many characters as fit next to the handle, in one column.
        most = max(20, int(13.5 * (_room(ax) - 0.6) / letters(1.0)))
        labels = [textwrap.fill(label, most) for label in labels]
        columns = max(1, min(columns, most // (3 + max(len(line) for label in labels for line in label.splitlines()))))
    place: tuple[Any, float] = ("upper center", 0.5) if centred else ("upper left", 0.0)
    figure: Any = ax.get_figure(root=True)
    # In inches, since the axes shrink to make room for the legend.
    under = ax.transAxes + ScaledTranslation(0.0, -_below(ax), figure.dpi_scale_trans)
    ax.legend(
        handles, labels, loc=place[0], bbox_to_anchor=(place[1], 0.0), bbox_transform=under, borderaxespad=0.0, ncols=columns, **options
    )
    if ax.name == "polar":
        # Its layout needs one more pass, since it keeps its shape.
        figure.draw_without_rendering()


def _below(ax: Axes) -> float:
    """The height of the labels below the axes, with a margin, in inches."""
    figure: Any = ax.get_figure(root=True)
    figure.draw_without_rendering()
    frame: Any = ax.get_window_extent()
    axes: Any = ax
    parts = [axes.xaxis, axes.yaxis, *([axes.zaxis] if hasattr(axes, "zaxis") else [])]
    boxes = [axis.get_tightbbox(figure._get_renderer()) for axis in parts]
    lowest = min((box.y0 for box in boxes if box is not None), default=frame.y0)
    return float((frame.y0 - lowest) / figure.dpi + letters(6.0) / 72)


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
