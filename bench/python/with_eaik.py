"""EAIK: closed forms by subproblems in C++, called for a batch of poses on one thread."""

import numpy as np
from eaik.IK_HP import HPRobot

from arm import *


def mh12():
    """Axes and steps at joint positions zero: upper arm up, forearm to the front."""
    x, y, z = np.eye(3)
    axes = np.array([z, y, y, x, y, x]) * np.array(SIGNS)[:, None]
    steps = np.array([C1 * z, A1 * x, C2 * z, -A2 * z + C3 * x, 0 * x, 0 * x, LEVER * x])
    return HPRobot(axes, steps)


def targets(poses):
    """4 x 4 a pose; the rotation counts from joint positions zero, where the tool's z is base x."""
    at_zero = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    out = np.tile(np.eye(4), (len(poses), 1, 1))
    rows = poses.reshape(-1, 3, 4)
    out[:, :3, :3], out[:, :3, 3] = rows[:, :, :3] @ at_zero.T, rows[:, :, 3]
    return list(out)


def difference(robot, batch, angles):
    """Largest distance (rad) of the yardstick's posture from the nearest of EAIK's."""
    worst = 0.0
    for found, expected in zip(robot.IK_batched(batch, 1), angles):
        turns = (np.array(found.Q) - expected) / (2 * np.pi)
        worst = max(worst, np.min(np.max(np.abs(turns - np.round(turns)), axis=1)) * 2 * np.pi)
    return worst
