"""Each command with an answer in JSON, as a function.

Operands (files, robot, study) come first, options by name: those of the command with ``_`` for ``-``. For example,
``--at-mm 1000,0,800`` is ``at_mm=[1000, 0, 800]``, and a flag is ``True``. A robot or study may be given as an object, and
a table as a data frame, an Arrow table or arrays by column name. ``armill.command_help("pose")`` lists the options.
"""

from armill._commands._call import command_help
from armill._commands.exports import export
from armill._commands.libraries import materials, modes, pose, receptance, robots
from armill._commands.measurements import (
    ballbar,
    calibrate,
    drives,
    forces,
    frf,
    identify,
    journal,
    learn,
    motion,
    path_accuracy,
    pose_accuracy,
    roundness,
    tracker,
)
from armill._commands.studies import advise, backlash, budget, compare, compensate, place, posture, stability

__all__ = [
    "advise",
    "backlash",
    "ballbar",
    "budget",
    "calibrate",
    "command_help",
    "compare",
    "compensate",
    "drives",
    "export",
    "forces",
    "frf",
    "identify",
    "journal",
    "learn",
    "materials",
    "modes",
    "motion",
    "path_accuracy",
    "place",
    "pose",
    "pose_accuracy",
    "posture",
    "receptance",
    "robots",
    "roundness",
    "tracker",
    "stability",
]
