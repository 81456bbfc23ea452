"""The error budget of a measured circle."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from armill.plot._answers import Json, Missing, Source
from armill.plot._style import BLUE, GREEN, INK, ORANGE, is_narrow, legend_below, letters, number, picture, several, set_title, wants_legend

_SUMS = (
    ("as_functions_um", "added with their signs"),
    ("root_sum_square_um", "root of the squares"),
    ("plain_um", "plain sum"),
)


@picture
def budget(
    source: Any,
    *,
    ax: Sequence[Axes] | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> list[Axes]:
    """Answer of budget, or Result with what was measured -> [bars, waves]: contributions and the part, µm; harmonics.

    Bars are largest radial deviations, with twice the scatter of one cut.
    """
    found = Source(source, "budget")
    answer: Json = found.data if "contributions" in found.data else found.need("measured", "armill budget")
    rows = _rows(answer)
    bars, waves = several(ax, 2, (8.2, 6.6), 1)
    _bars(bars, answer, rows)
    _waves(waves, answer)
    return [bars, waves]


def _rows(answer: Json) -> list[tuple[str, float, float, str]]:
    """Label, largest, scatter and colour of each bar."""
    rows = [(each["name"], each["largest_um"], each["scatter_um"], BLUE) for each in answer["contributions"]]
    sums: Json = answer["sums"]
    scatter = (sums["with_scatter_um"] - sums["as_functions_um"]) / 2
    rows += [(label, sums[key], scatter if key == "as_functions_um" else 0.0, ORANGE) for key, label in _SUMS]
    if answer["part"] is not None:
        rows.append(("part, measured", answer["part"]["largest_um"], 0.0, GREEN))
        rows.append(("part, not explained", answer["part"]["residual"]["largest_um"], 0.0, GREEN))
    return rows


def _bars(ax: Axes, answer: Json, rows: list[tuple[str, float, float, str]]) -> None:
    what = {BLUE: "contribution", ORANGE: "together", GREEN: "measured"}
    shown: set[str] = set()
    for i, (_, largest, scatter, colour) in enumerate(rows):
        ax.barh(i, largest, height=0.64, color=colour, label=None if colour in shown else what[colour])
        shown.add(colour)
        if scatter:
            label = None if "scatter" in shown else "twice the scatter of one cut"
            shown.add("scatter")
            ax.errorbar(largest, i, xerr=[[0.0], [2 * scatter]], color=INK, capsize=3, linewidth=1.2, label=label)
        scattered = f", s {scatter:.1f} µm" if scatter else ""
        note = ax.annotate(
            f"{largest:.1f} µm{scattered}", (largest + 2 * scatter, i), xytext=(6, 0), textcoords="offset points", va="center",
            fontweight="bold",
        )
        if is_narrow(ax):
            # Narrow axes shrink for the text, which moves with their edge.
            note.set_in_layout(False)
            note.set_fontsize(letters(7.0))
    ax.set_yticks(range(len(rows)), [textwrap.fill(label, 18) if is_narrow(ax) else label for label, *_ in rows])
    ax.tick_params(axis="y", length=0)
    if is_narrow(ax):
        ax.tick_params(axis="y", labelsize=letters(6.5))
    ax.invert_yaxis()
    ax.set_xlim(0.0, (1.9 if is_narrow(ax) else 1.24) * max(largest + 2 * scatter for _, largest, scatter, _ in rows))
    ax.set_xlabel("largest radial deviation (µm)")
    ax.spines[["top", "right"]].set_visible(False)
    datum = answer["datum"]
    conditions = f"circle of {answer['radius_mm']:g} mm, {answer['branch']}; centre {datum['centre']}, radius {datum['radius']}"
    set_title(ax, f"{answer['analysis']}: error budget", conditions)
    legend_below(ax, columns=4)


def _waves(ax: Axes, answer: Json) -> None:
    part: Json | None = answer["part"]
    if part is None:
        raise Missing("budget: no measured part to compare harmonics with: give it in [measured]")
    waves = part["waves"]
    counts = np.array([wave["waves"] for wave in waves])
    ax.bar(counts - 0.2, [wave["measured_um"] for wave in waves], width=0.4, color=GREEN, label="part")
    ax.bar(counts + 0.2, [wave["predicted_um"] for wave in waves], width=0.4, color=BLUE, label="predicted")
    phases = [wave["phase_difference_deg"] for wave in waves]
    names = [f"{count}\n{phase:+.0f}°" if phase is not None else str(count) for count, phase in zip(counts, phases)]
    names = [str(count) for count in counts] if is_narrow(ax) else names
    ax.set_xticks(counts, [name.replace("-0°", "0°").replace("+0°", "0°") for name in names])
    explained = "" if is_narrow(ax) else "; below: phase of the prediction minus phase of the part"
    ax.set_xlabel(f"waves per revolution{explained}")
    ax.set_ylabel("amplitude (µm)")
    ax.spines[["top", "right"]].set_visible(False)
    rest = number(part["residual"]["rms_um"])
    set_title(ax, "Harmonics", f"{part['explained_percent']:.1f} % of the part explained, residual {rest} µm rms")
    if wants_legend():
        ax.legend(loc="upper right")
