"""numpy, in blocks that stay in cache: with sines and arctangents, and without any trigonometry.

Columns e are the twelve numbers of base_from_tool, row by row: e[2], e[6], e[10] is the tool axis, e[3], e[7], e[11]
the TCP. Without trigonometry the joint axes come from the elbow and wrist points:

    z4 = forearm's direction, n = z4 x a, delta = sum c_i v_i (v_i . F), v_4 = h n, v_5 = h (n x a) / |n|, v_6 = 0

with a the tool axis and h the distance from wrist centre to TCP. Valid only for a tool along axis 6.
"""

import numpy as np

from arm import *

BLOCK = 8192  # poses; fewer cost more calls, more fall out of cache


def in_blocks(work, columns, out):
    """out[..., i] = work(columns[:, i]), block by block."""
    for start in range(0, columns.shape[1], BLOCK):
        stop = start + BLOCK
        out[..., start:stop] = work(columns[:, start:stop])
    return out


def reduced_in_blocks(work, columns):
    """Does work block by block and keeps nothing: large results are not to be measured as memory traffic."""
    for start in range(0, columns.shape[1], BLOCK):
        work(columns[:, start : start + BLOCK])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def wrist_centre(e):
    return e[3] - LEVER * e[2], e[7] - LEVER * e[6], e[11] - LEVER * e[10]


def two_link(u, v):
    """Angles 2 and 3, the branch bent forwards and the other."""
    squared = u * u + v * v
    at_shoulder = np.arccos((squared + C2 * C2 - FOREARM_SQUARED) / (2 * C2 * np.sqrt(squared)))
    at_elbow = np.arccos((squared - C2 * C2 - FOREARM_SQUARED) / (2 * C2 * FOREARM))
    lift, crank = np.arctan2(u, v), np.arctan2(A2, C3)
    return (lift - at_shoulder, at_elbow - crank), (lift + at_shoulder, -at_elbow - crank)


def wrist(e, t1, t2, t3):
    s1, c1, s23, c23 = np.sin(t1), np.cos(t1), np.sin(t2 + t3), np.cos(t2 + t3)
    along = e[2] * s23 * c1 + e[6] * s23 * s1 + e[10] * c23
    t4 = np.arctan2(e[6] * c1 - e[2] * s1, e[2] * c23 * c1 + e[6] * c23 * s1 - e[10] * s23)
    t5 = np.arctan2(np.sqrt(1 - along * along), along)
    t6 = np.arctan2(
        e[1] * s23 * c1 + e[5] * s23 * s1 + e[9] * c23, -e[0] * s23 * c1 - e[4] * s23 * s1 - e[8] * c23
    )
    return t4, t5, t6


def front_up(e):
    x, y, z = wrist_centre(e)
    t1 = np.arctan2(y, x)
    t2, t3 = two_link(np.sqrt(x * x + y * y) - A1, z - C1)[0]
    return (t1, t2, t3, *wrist(e, t1, t2, t3))


def ik8(e):
    """Joint positions, 8 branches x 6 joints x poses."""
    x, y, z = wrist_centre(e)
    r, turn = np.sqrt(x * x + y * y), np.arctan2(y, x)
    front, back = two_link(r - A1, z - C1), two_link(-r - A1, z - C1)
    behind = turn - np.copysign(np.pi, turn)
    arms = ((turn, *front[0]), (turn, *front[1]), (behind, *back[1]), (behind, *back[0]))
    out = np.empty((8, 6, e.shape[1]))
    for index, (t1, t2, t3) in enumerate(arms):
        t4, t5, t6 = wrist(e, t1, t2, t3)
        for flip, theta in enumerate(((t1, t2, t3, t4, t5, t6), (t1, t2, t3, t4 + np.pi, -t5, t6 - np.pi))):
            for joint in range(6):
                out[2 * index + flip, joint] = (theta[joint] + OFFSETS[joint]) * SIGNS[joint]
    return out


def screws(theta):
    """(axis, velocity of the TCP) of each joint."""
    t1, t2, t3, t4, t5, _ = theta
    s1, c1, s2, c2 = np.sin(t1), np.cos(t1), np.sin(t2), np.cos(t2)
    s23, c23, s4, c4 = np.sin(t2 + t3), np.cos(t2 + t3), np.sin(t4), np.cos(t4)
    s5, c5 = np.sin(t5), np.cos(t5)
    zero, one = np.zeros_like(s1), np.ones_like(s1)
    across, side, along = (c23 * c1, c23 * s1, -s23), (-s1, c1, zero), (s23 * c1, s23 * s1, c23)
    z5 = tuple(c4 * b - s4 * a for a, b in zip(across, side))
    z6 = tuple(s5 * (c4 * a + s4 * b) + c5 * c for a, b, c in zip(across, side, along))
    shoulder = (A1 * c1, A1 * s1, C1 * one)
    elbow = (shoulder[0] + C2 * s2 * c1, shoulder[1] + C2 * s2 * s1, C1 + C2 * c2)
    centre = tuple(o + A2 * a + C3 * c for o, a, c in zip(elbow, across, along))
    tcp = tuple(o + LEVER * z for o, z in zip(centre, z6))
    lines = (
        ((zero, zero, one), (zero, zero, C1 * one)),
        (side, shoulder),
        (side, elbow),
        (along, centre),
        (z5, centre),
        (z6, centre),
    )
    return [(axis, cross(axis, tuple(t - o for t, o in zip(tcp, on)))) for axis, on in lines]


def largest_in_plane(velocities, weights):
    """Of delta = B F over the forces, with B = sum w_i v_i v_i^T."""
    b = {}
    for row, column in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
        b[row, column] = b[column, row] = sum(w * v[row] * v[column] for v, w in zip(velocities, weights))
    largest = 0.0
    for force in FORCES:
        delta = [b[row, 0] * force[0] + b[row, 1] * force[1] + b[row, 2] * force[2] for row in range(3)]
        out = dot(delta, NORMAL)
        in_plane = [delta[i] - out * NORMAL[i] for i in range(3)]
        largest = np.maximum(largest, dot(in_plane, in_plane))
    return np.sqrt(largest)


def dev(e):
    return largest_in_plane([v for _, v in screws(front_up(e))], COMPLIANCE)


def dev_without_trigonometry(e):
    a, p = (e[2], e[6], e[10]), (e[3], e[7], e[11])
    x, y, z = wrist_centre(e)
    r = np.sqrt(x * x + y * y)
    c1, s1, u, v = x / r, y / r, r - A1, z - C1
    squared = u * u + v * v
    k1 = (squared + (C2 * C2 - FOREARM_SQUARED)) * (0.5 / C2)
    k2 = np.copysign(np.sqrt((REACH_SQUARED - squared) * (squared - FOLD_SQUARED)) * (0.5 / C2), u)
    per_square = C2 / squared
    eu, ev = (u * k1 - v * k2) * per_square, (v * k1 + u * k2) * per_square
    fu, fv = u - eu, v - ev
    s23 = (C3 / FOREARM_SQUARED) * fu - (A2 / FOREARM_SQUARED) * fv
    c23 = (A2 / FOREARM_SQUARED) * fu + (C3 / FOREARM_SQUARED) * fv
    n = cross((s23 * c1, s23 * s1, c23), a)
    m = cross(n, a)
    ahead = c1 * p[0] + s1 * p[1] - A1  # TCP before axis 2, in the arm's plane
    z2, z3 = p[2] - C1, p[2] - C1 - ev
    velocities = (
        (-p[1], p[0], np.zeros_like(r)),
        (c1 * z2, s1 * z2, -ahead),
        (c1 * z3, s1 * z3, eu - ahead),
        n,
        m,
    )
    lever = LEVER * LEVER
    weights = (*COMPLIANCE[:3], COMPLIANCE[3] * lever, COMPLIANCE[4] * lever / dot(n, n))
    return largest_in_plane(velocities, weights)


def c66(e):
    """6 x 6 x poses."""
    s = np.empty((6, 6, e.shape[1]))
    for joint, (axis, velocity) in enumerate(screws(front_up(e))):
        for i in range(3):
            s[joint, i], s[joint, 3 + i] = velocity[i], axis[i]
    weighted = s * np.array(COMPLIANCE)[:, None, None]
    out = np.empty((6, 6, e.shape[1]))
    for row in range(6):
        for column in range(row, 6):
            np.sum(weighted[:, row] * s[:, column], axis=0, out=out[row, column])
            out[column, row] = out[row, column]
    return out
