"""Robots from and to other packages: the Robotics Toolbox and pinocchio.

=====================  ===================================================================
``to_ets``             Robot -> ``roboticstoolbox.ETS``
``from_ets``           ``roboticstoolbox.ETS``, or a robot that has one -> Robot
``to_pinocchio``       Robot -> ``pinocchio.Model``
``from_pinocchio``     ``pinocchio.Model`` -> Robot
=====================  ===================================================================

Kinematic chain, joint names and limits are converted; compliances, masses and sources are not. Each result is compared with its
original at random joint positions, to 1 nm and 1 nrad. Poses of spatialmath (``SE3``) and scipy need no conversion:
``Robot.inverse`` and all other functions of poses accept them.

``pip install 'armill[interop]'`` installs both packages.
"""

from armill.interop._pinocchio import from_pinocchio, to_pinocchio
from armill.interop._roboticstoolbox import from_ets, to_ets

__all__ = ["from_ets", "from_pinocchio", "to_ets", "to_pinocchio"]
