"""Robots from and to other packages: the Robotics Toolbox and pinocchio.

=====================  ===================================================================
``to_ets``             Robot -> ``roboticstoolbox.ETS``
``from_ets``           ``roboticstoolbox.ETS``, or a robot that has one -> Robot
``to_pinocchio``       Robot -> ``pinocchio.Model``
``from_pinocchio``     ``pinocchio.Model`` -> Robot
=====================  ===================================================================

Chain, joint names and limits go over; compliances, masses and sources do not. Whatever is made is compared with what it was made
of at random joint positions before it is given, to a nanometre and a nanoradian. Poses of spatialmath (``SE3``) and scipy need no
conversion: ``Robot.inverse`` and all else that takes poses takes them as they are.

``pip install 'armill[interop]'`` brings both packages.
"""

from armill.interop._pinocchio import from_pinocchio, to_pinocchio
from armill.interop._roboticstoolbox import from_ets, to_ets

__all__ = ["from_ets", "from_pinocchio", "to_ets", "to_pinocchio"]
