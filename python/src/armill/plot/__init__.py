"""Pictures of results, one call each, by matplotlib.

Every function takes a ``Result``, the ``Answer`` of a command, the dict of their JSON or the folder that a command wrote, and gives
the axes that it drew on; ``ax=`` draws on those of the caller. Nothing of matplotlib's settings is changed. Lengths are in mm,
deviations in µm.

================  ===========================================================================
``map``           deviation over a plane: contours, the limit bold, hatches out of reach
``region``        where on the plane the limit holds, how surely, and what fits into it
``sections``      many planes on one sheet
``path``          a path, coloured by its deviation
``along``         the deviation and its parts over the length of a path
``shares``        which joint the deviation comes from
``polar``         a circle under load, or the runs of a ball-bar, magnified
``turns``         how the tool is turned along a path, among all turns
``roundness``     a measured profile and its four circles
``budget``        what the error of a measured circle is made of; its waves
``placement``     what a place of the part is worth
``identify``      springs with intervals, and what load tests leave unexplained
``robot``         the arm in 3-D
``stiffness``     compliance at the tool as an ellipsoid
================  ===========================================================================
"""

from importlib.util import find_spec

if find_spec("matplotlib") is None:
    raise ImportError("armill.plot needs matplotlib: pip install 'armill[plot]'")

from armill.plot._along import along
from armill.plot._answers import Missing
from armill.plot._budget import budget
from armill.plot._identify import identify
from armill.plot._map import map
from armill.plot._path import path
from armill.plot._placement import placement
from armill.plot._polar import polar
from armill.plot._region import region
from armill.plot._robot import robot, skeleton
from armill.plot._roundness import roundness
from armill.plot._sections import sections
from armill.plot._shares import shares
from armill.plot._stiffness import stiffness
from armill.plot._turns import turns

__all__ = [
    "Missing",
    "along",
    "budget",
    "identify",
    "map",
    "path",
    "placement",
    "polar",
    "region",
    "robot",
    "roundness",
    "sections",
    "shares",
    "skeleton",
    "stiffness",
    "turns",
]
