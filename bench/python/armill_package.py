"""The Python package: deviations under four forces at known joint positions, in one call; rows for `cargo xtask bench`.

usage: python bench/python/armill_package.py [--quick]

Requires numpy and a wheel that was built for release. The answers are an array that the call allocates.
"""

import sys

import numpy as np
from arm import COMPLIANCE, FORCES, TOOL
from clock import print_rates

import armill

ROUNDS, QUICK_ROUNDS = 15, 3
FEW, MANY = 100_000, 1_000_000
THREADS = 2


def main():
    robot = armill.Robot.load("yaskawa/mh12").with_compliance(COMPLIANCE)
    tool = np.eye(4)
    tool[2, 3] = TOOL
    forces = np.array(FORCES)
    joints = np.random.default_rng(8).uniform(-2.0, 2.0, (MANY, 6))

    def of(work, count, threads):
        given = joints[:count]
        note = f"robot.deviation, {count} poses a call"
        return ("armill for Python", work, count, note, lambda: robot.deviation(given, forces, tool, threads=threads), threads)

    many = "dev from angles, a million poses a call"
    print_rates(
        [of("dev from angles", FEW, 1), of(many, MANY, 1), of(many, MANY, THREADS)],
        QUICK_ROUNDS if "--quick" in sys.argv else ROUNDS,
    )


if __name__ == "__main__":
    main()
