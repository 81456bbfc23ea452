"""The arm and the loads of bench/src/workload.rs; lengths m, angles rad."""

import math

A1, A2, C1, C2, C3, C4, TOOL = 0.155, -0.200, 0.450, 0.614, 0.640, 0.100, 0.150
LEVER = C4 + TOOL  # wrist centre to TCP
FOREARM_SQUARED = A2 * A2 + C3 * C3
FOREARM = math.sqrt(FOREARM_SQUARED)
REACH_SQUARED, FOLD_SQUARED = (C2 + FOREARM) ** 2, (C2 - FOREARM) ** 2
OFFSETS = (0.0, 0.0, -math.pi / 2, 0.0, 0.0, math.pi)
SIGNS = (1.0, 1.0, -1.0, -1.0, -1.0, -1.0)
COMPLIANCE = (2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5)
NORMAL = (-1.0, 0.0, 0.0)
FORCES = ((3.0, -5.0, -5.0), (3.0, -5.0, 5.0), (3.0, 5.0, -5.0), (3.0, 5.0, 5.0))
