"""Pictures of results, one call each, by matplotlib.

Every function accepts a ``Result``, the ``Answer`` of a command, the dict of their JSON or the folder that a command wrote. It
returns the axes that it drew on; ``ax=`` draws on given axes. The settings of matplotlib are not changed. Lengths are in mm,
deviations in µm.

================  ===========================================================================
``map``           deviation over a plane: contours, the tolerance bold, hatches where unreachable
``region``        the region within the tolerance, its uncertainty, and inscribed shapes
``sections``      many planes in one figure
``path``          a path, coloured by its deviation
``along``         the deviation and its components along a path
``contributions`` contribution of each joint to the deviation
``polar``         a circle under load, or the runs of a ball-bar, magnified
``turns``         the spin of the tool along a path, among all spins
``roundness``     a measured profile and its four circles
``budget``        the error budget of a measured circle, and its harmonics
``placement``     the cost of placements of the part
``identify``      springs with intervals, and the residuals of the load tests
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
from armill.plot._contributions import contributions
from armill.plot._identify import identify
from armill.plot._map import map
from armill.plot._path import path
from armill.plot._placement import placement
from armill.plot._polar import polar
from armill.plot._region import region
from armill.plot._robot import robot, skeleton
from armill.plot._roundness import roundness
from armill.plot._sections import sections
from armill.plot._stiffness import stiffness
from armill.plot._turns import turns

__all__ = [
    "Missing",
    "along",
    "budget",
    "contributions",
    "identify",
    "map",
    "path",
    "placement",
    "polar",
    "region",
    "robot",
    "roundness",
    "sections",
    "skeleton",
    "stiffness",
    "turns",
]
