"""numba, poses as columns: the loop of the yardstick, and the one without trigonometry.

The equations are those of with_numpy.py; every constant of the arm is known to the compiler. Tuned as numba's own
performance tips say: `fastmath`; `error_model="numpy"`, for the check for a division by zero that Python's model asks
for is a branch, and a loop with it gets no vectors; columns, so that neighbouring poses are neighbours in memory;
output allocated once; indices from 0, which need no check of the sign. With threads, `parallel` over contiguous blocks.
"""

import math

import numpy as np
from numba import njit, prange

from arm import *

K1, K2, K3, K4, K5, K6 = COMPLIANCE
TUNED = {"fastmath": True, "error_model": "numpy"}
BLOCK = 1000  # poses


@njit(**TUNED, inline="always")
def in_plane_squared(d0, d1, d2):
    out = d0 * NORMAL[0] + d1 * NORMAL[1] + d2 * NORMAL[2]
    d0, d1, d2 = d0 - out * NORMAL[0], d1 - out * NORMAL[1], d2 - out * NORMAL[2]
    return d0 * d0 + d1 * d1 + d2 * d2


@njit(**TUNED, inline="always")
def largest_in_plane(b00, b01, b02, b11, b12, b22):
    """Of delta = B F over the forces, B the 3 x 3 compliance."""
    largest = 0.0
    for force in FORCES:
        f0, f1, f2 = force
        largest = max(
            largest,
            in_plane_squared(
                b00 * f0 + b01 * f1 + b02 * f2, b01 * f0 + b11 * f1 + b12 * f2, b02 * f0 + b12 * f1 + b22 * f2
            ),
        )
    return math.sqrt(largest)


@njit(**TUNED)
def dev(e, out):
    for i in range(out.size):
        e11, e12, e13, px = e[0, i], e[1, i], e[2, i], e[3, i]
        e21, e22, e23, py = e[4, i], e[5, i], e[6, i], e[7, i]
        e31, e32, e33, pz = e[8, i], e[9, i], e[10, i], e[11, i]
        x, y, z = px - LEVER * e13, py - LEVER * e23, pz - LEVER * e33
        t1 = math.atan2(y, x)
        u, v = math.sqrt(x * x + y * y) - A1, z - C1
        squared = u * u + v * v
        t2 = math.atan2(u, v) - math.acos((squared + C2 * C2 - FOREARM_SQUARED) / (2 * C2 * math.sqrt(squared)))
        t3 = math.acos((squared - C2 * C2 - FOREARM_SQUARED) / (2 * C2 * FOREARM)) - math.atan2(A2, C3)
        s1, c1, s23, c23 = math.sin(t1), math.cos(t1), math.sin(t2 + t3), math.cos(t2 + t3)
        t4 = math.atan2(e23 * c1 - e13 * s1, e13 * c23 * c1 + e23 * c23 * s1 - e33 * s23)
        s2, c2, s4, c4 = math.sin(t2), math.cos(t2), math.sin(t4), math.cos(t4)
        ahead, z2 = c1 * px + s1 * py - A1, pz - C1
        z3, back = z2 - C2 * c2, ahead - C2 * s2
        n0, n1, n2 = s23 * s1 * e33 - c23 * e23, c23 * e13 - s23 * c1 * e33, s23 * c1 * e23 - s23 * s1 * e13
        y0, y1, y2 = -c4 * s1 - s4 * c23 * c1, c4 * c1 - s4 * c23 * s1, s4 * s23
        m0, m1, m2 = y1 * e33 - y2 * e23, y2 * e13 - y0 * e33, y0 * e23 - y1 * e13
        w2, w3, w4, w5 = K2, K3, K4 * LEVER * LEVER, K5 * LEVER * LEVER
        out[i] = largest_in_plane(
            K1 * py * py + w2 * c1 * z2 * c1 * z2 + w3 * c1 * z3 * c1 * z3 + w4 * n0 * n0 + w5 * m0 * m0,
            -K1 * py * px + w2 * c1 * z2 * s1 * z2 + w3 * c1 * z3 * s1 * z3 + w4 * n0 * n1 + w5 * m0 * m1,
            -w2 * c1 * z2 * ahead - w3 * c1 * z3 * back + w4 * n0 * n2 + w5 * m0 * m2,
            K1 * px * px + w2 * s1 * z2 * s1 * z2 + w3 * s1 * z3 * s1 * z3 + w4 * n1 * n1 + w5 * m1 * m1,
            -w2 * s1 * z2 * ahead - w3 * s1 * z3 * back + w4 * n1 * n2 + w5 * m1 * m2,
            w2 * ahead * ahead + w3 * back * back + w4 * n2 * n2 + w5 * m2 * m2,
        )


@njit(**TUNED)
def dev_without_trigonometry(e, out):
    for i in range(out.size):
        e13, px, e23, py, e33, pz = e[2, i], e[3, i], e[6, i], e[7, i], e[10, i], e[11, i]
        x, y, z = px - LEVER * e13, py - LEVER * e23, pz - LEVER * e33
        r = math.sqrt(x * x + y * y)
        c1, s1, u, v = x / r, y / r, r - A1, z - C1
        squared = u * u + v * v
        k1 = (squared + (C2 * C2 - FOREARM_SQUARED)) * (0.5 / C2)
        k2 = math.copysign(math.sqrt((REACH_SQUARED - squared) * (squared - FOLD_SQUARED)) * (0.5 / C2), u)
        eu, ev = (u * k1 - v * k2) * (C2 / squared), (v * k1 + u * k2) * (C2 / squared)
        fu, fv = u - eu, v - ev
        s23 = (C3 / FOREARM_SQUARED) * fu - (A2 / FOREARM_SQUARED) * fv
        c23 = (A2 / FOREARM_SQUARED) * fu + (C3 / FOREARM_SQUARED) * fv
        ahead, z2 = c1 * px + s1 * py - A1, pz - C1
        z3, back = z2 - ev, ahead - eu
        n0, n1, n2 = s23 * s1 * e33 - c23 * e23, c23 * e13 - s23 * c1 * e33, s23 * c1 * e23 - s23 * s1 * e13
        m0, m1, m2 = n1 * e33 - n2 * e23, n2 * e13 - n0 * e33, n0 * e23 - n1 * e13
        w4, w5 = K4 * LEVER * LEVER, K5 * LEVER * LEVER / (n0 * n0 + n1 * n1 + n2 * n2)
        p2, p3 = K2 * z2 * z2 + K3 * z3 * z3, K2 * z2 * ahead + K3 * z3 * back
        out[i] = largest_in_plane(
            K1 * py * py + p2 * c1 * c1 + w4 * n0 * n0 + w5 * m0 * m0,
            -K1 * py * px + p2 * c1 * s1 + w4 * n0 * n1 + w5 * m0 * m1,
            -p3 * c1 + w4 * n0 * n2 + w5 * m0 * m2,
            K1 * px * px + p2 * s1 * s1 + w4 * n1 * n1 + w5 * m1 * m1,
            -p3 * s1 + w4 * n1 * n2 + w5 * m1 * m2,
            K2 * ahead * ahead + K3 * back * back + w4 * n2 * n2 + w5 * m2 * m2,
        )


def blocked(columns):
    """(12, poses) -> (blocks, 12, BLOCK): each block contiguous."""
    return np.ascontiguousarray(columns.reshape(12, -1, BLOCK).transpose(1, 0, 2))


def on_all_threads(function):
    """The loop over blocks, shared among threads."""

    def blocks(columns, out):
        for block in prange(out.shape[0]):
            function(columns[block], out[block])

    return njit(**TUNED, parallel=True)(blocks)
