"""A robot with every uncertain input that a robot file may have but a learnt residual."""

from __future__ import annotations

import re

import armill

OTHER = '''
[repeatability]
pose_mm = 0.06
source = "guess"

[model_error]
percent = 4.0
source = "guess"

[covariance]
of = ["S", "L"]
matrix_rad2_per_n2_m2 = [[4e-14, 2e-14], [2e-14, 9e-14]]
source = "guess"

[geometry_covariance]
of = ["S along x", "L about y", "B along z"]
matrix_mm_deg = [[0.01, 0.0002, 0.0], [0.0002, 0.0004, 0.0], [0.0, 0.0, 0.0025]]
source = "guess"

[[spring]]
at = "U"
about = "x"
compliance_rad_per_n_m = 4e-7
compliance_u_rad_per_n_m = 1e-7
source = "guess"

[sources.guess]
what = "numbers of a test"
where = "here"
licence = "none"
'''


def text(other: str = OTHER) -> str:
    """The MH12 of the library with backlash, springs and uncertainties."""
    found = armill.Robot.load("yaskawa/mh12").to_toml()
    backlash = 'backlash_deg = 0.004\nbacklash_u_deg = 0.0006\nbacklash_side = "{}"\nbacklash_source = "guess"\n'
    for joint, side in (("L", "motion"), ("U", "torque")):
        name = re.search(rf"\[\[joint\]\]\nname = \"{joint}\"\n", found)
        assert name, joint
        found = found[: name.end()] + backlash.format(side) + found[name.end() :]
    return found + other


def robot() -> armill.Robot:
    """The robot of this text."""
    return armill.Robot.from_text(text(), "armill", "uncertain")
