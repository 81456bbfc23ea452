"""The setting of an answer: the text under the title, and the axes of its plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armill.plot._answers import Columns, Json

Vector = NDArray[np.float64]


def words(answer: Json) -> str:
    """Branch, plane, tool and load of a map or path, in words."""
    setting: Json = answer["setting"]
    parts = [answer.get("followed_branch") or answer["branch"]]
    if setting["tilt_deg"] is not None:
        parts.append(f"tilt {setting['tilt_deg']:g}°")
    length = setting["tool_length_mm"]
    parts.append(f"TCP {length:.0f} mm from the flange" if length else "bare flange")
    cases = len(setting["cases_n"])
    if cases > 1:
        parts.append(f"worst of {cases} load cases")
    parts.append(f"positions relative to {setting['base']}")
    return ", ".join(parts)


def plane_axes(answer: Json) -> tuple[Vector, Vector]:
    """The axes y' and z' of the plane, in the reference frame of positions.

    ``v = a y' + b z'`` for a point at v from the centre, and ``z' = y' x n``.
    """
    setting: Json = answer["setting"]
    normal = np.array(setting["normal_axis"], dtype=float)
    if setting["tilt_deg"] is not None:
        across = np.array([0.0, 1.0, 0.0])
        return across, np.cross(across, normal)
    point: Json = answer["worst"]
    a, b = point["in_plane_mm"]
    v = np.array(point["xyz_mm"], dtype=float) - setting["centre_mm"]
    v -= (v @ normal) * normal
    across = (a * v + b * np.cross(normal, v)) / (a * a + b * b)
    across /= np.linalg.norm(across)
    return across, np.cross(across, normal)


def in_plane(answer: Json, columns: Columns) -> tuple[Vector, Vector]:
    """y' and z' of every point of a table, mm from the centre of the plane."""
    places = np.column_stack([columns[name] for name in ("x_mm", "y_mm", "z_mm")]).astype(float)
    places -= np.array(answer["setting"]["centre_mm"], dtype=float)
    across, up = plane_axes(answer)
    return places @ across, places @ up


def breaks(columns: Columns) -> NDArray[np.intp]:
    """Indices of the first points of separate cuts."""
    places = np.column_stack([columns[name] for name in ("x_mm", "y_mm", "z_mm")]).astype(float)
    gone = np.linalg.norm(np.diff(places, axis=0), axis=1)
    along = np.diff(columns["distance_mm"].astype(float))
    # An arc between two points is longer than its chord.
    return np.flatnonzero(gone > 1.01 * along + 1e-3) + 1
