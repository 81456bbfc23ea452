"""Radial deviation of a circle: predicted under load, or measured by a ball-bar."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from armill.plot import _rings
from armill.plot._answers import Columns, Json, Missing, Source
from armill.plot._setting import in_plane, plane_axes, words
from armill.plot._style import BLUE, COLOURS, GREEN, number, one, picture, set_title

# Largest difference of radial deviations of a table and of the answer, by rounding.
_DIGITS_UM = 0.01


@picture
def polar(
    source: Any,
    analysis: str | None = None,
    *,
    table: Any = None,
    ax: Axes | None = None,
    title: str | bool = True,
    legend: bool = True,
) -> Axes:
    """Result and name of a circle, or Answer of ballbar -> polar axes: radial deviation around the circle, magnified, µm.

    For a predicted circle one curve per load case, seen from the tool side, angles from +y' towards z'. For a ball-bar one curve
    per run, clockwise and anticlockwise in two colours, repeats dashed; the runs are from `runs.csv` of the folder, or `table`.
    """
    found = Source(source, "polar", table)
    ax = one(ax, (6.4, 6.9), "polar")
    if "runs" in found.data and "circular_bidirectional_um" in found.data:
        _runs(ax, found)
    else:
        _cases(ax, found, analysis)
    return ax


def _cases(ax: Axes, found: Source, analysis: str | None) -> None:
    answer = found.one("paths", analysis)
    circle: list[Json] | None = answer["circle_cases"]
    if not circle:
        raise Missing(f"polar: {answer['name']!r} is not a circle that is reachable everywhere")
    names = [f"deviation_{axis}_case_{case['case']}_um" for case in circle for axis in "xyz"]
    columns = found.columns(answer["name"], ["x_mm", "y_mm", "z_mm", *names])
    angles, radial = radial_um(answer, columns, [case["case"] for case in circle])
    for values, case in zip(radial, circle):
        off = max(abs(values.max() - case["max_radial_um"]), abs(values.min() - case["min_radial_um"]))
        if off > _DIGITS_UM + 1e-4 * abs(values).max():
            raise Missing(f"polar: the table is not of {answer['name']!r}: its radial deviations are off by {number(off)} µm")
    division = _rings.draw(ax, float(radial.min()), float(radial.max()), ("+y′", "+z′", "−y′", "−z′"))
    # Seen from the tool side: y' grows to the left, z' up.
    ax.set_theta_zero_location("W")  # type: ignore[attr-defined]
    ax.set_theta_direction(-1)  # type: ignore[attr-defined]
    ax.set_rlabel_position(285.0)  # type: ignore[attr-defined]
    _rings.nominal(ax, division)
    forces: list[list[float]] = answer["setting"]["cases_n"]
    for i, (values, case) in enumerate(zip(radial, circle)):
        force = f", F = ({', '.join(f'{part:g}' for part in forces[i])}) N" if i < len(forces) else ""
        label = f"case {case['case']}{force}"
        ax.plot(*_rings.closed(angles, values), color=COLOURS[i % len(COLOURS)], label=label)
    roundness = number(answer["roundness_um"])
    set_title(ax, answer["name"], f"out of round by {roundness} µm at most; {words(answer)}", _rings.LIFT)
    _rings.legend(ax, columns=2)


def radial_um(answer: Json, columns: Columns, cases: list[int]) -> tuple[Any, Any]:
    """Angles from +y' towards z', rad, and the radial deviation of each case at them, outwards positive."""
    y, z = in_plane(answer, columns)
    across, up = plane_axes(answer)
    outwards = (np.outer(y, across) + np.outer(z, up)) / np.hypot(y, z)[:, None]
    radial = [
        sum(columns[f"deviation_{axis}_case_{case}_um"].astype(float) * outwards[:, i] for i, axis in enumerate("xyz"))
        for case in cases
    ]
    return np.arctan2(z, y) % (2 * np.pi), np.array(radial)


def _runs(ax: Axes, found: Source) -> None:
    runs: list[Json] = found.data["runs"]
    columns = found.columns(None, ["angle_deg", *(f"{run['name']}_um" for run in runs)], file="runs.csv")
    angles = np.radians(columns["angle_deg"].astype(float))
    values = [columns[f"{run['name']}_um"].astype(float) for run in runs]
    known = np.concatenate([each[np.isfinite(each)] for each in values])
    first, second = found.data["axes"] or ("x", "y")
    names = (f"+{first}", f"+{second}", f"−{first}", f"−{second}")
    division = _rings.draw(ax, float(known.min()), float(known.max()), names)
    ax.set_rlabel_position(285.0)  # type: ignore[attr-defined]
    _rings.nominal(ax, division)
    seen: dict[str, int] = {}
    for run, each in zip(runs, values):
        way = run["direction"]
        repeat = seen[way] = seen.get(way, -1) + 1
        dashes = ("-", "--", ":", "-.")[repeat % 4]
        colour = BLUE if way == "CW" else GREEN
        ax.plot(angles, each, color=colour, linestyle=dashes, linewidth=1.3, label=run["name"])
    _start(ax, runs, angles, values)
    parts = [f"G(b) {number(found.data['circular_bidirectional_um'])} µm"] if found.data["circular_bidirectional_um"] else []
    parts += [f"{each['direction']} G {number(each['circular_um'])} µm" for each in found.data["directions"]]
    parts.append(f"centre {found.data['centring']['centre']}")
    set_title(ax, f"Circular test, radius {found.data['radius_mm']:g} mm", "; ".join(parts), _rings.LIFT)
    _rings.legend(ax)


def _start(ax: Axes, runs: list[Json], angles: Any, values: Any) -> None:
    """The start of the runs, where the bar feeds in."""
    for i, (run, each) in enumerate(zip(runs, values)):
        start = np.radians(run["start_deg"] % 360)
        nearest = int(np.argmin(np.abs(np.angle(np.exp(1j * (angles - start))))))
        if np.isfinite(each[nearest]):
            label = "start" if i == 0 else None
            ax.plot(angles[nearest], each[nearest], "o", color="black", markersize=4, label=label, zorder=4, linestyle="none")
