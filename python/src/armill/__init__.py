"""How far from the drawing will this robot cut, why, and what can be done about it?

Arrays of numpy in and out, batch first: ``(n, dof)`` joints, ``(n, 4, 4)`` poses, ``(n, cases, 3)`` deviations. SI units:
m, rad, N, N m. A single item is taken without the first axis, and answered without it.

====================  =====================================================================
``Robot``             a robot of the library or of a file, and what it answers about poses
``Study``             a study file: check it, run it, take its results
``pose``, ...         every command as a function, with the options of the command
``read_path``         the points of a tool path
``armill.scale``      sweeps over many machines (``armill[scale]``)
====================  =====================================================================
"""

from armill._answer import Answer
from armill._armill import (
    Cancelled,
    Fault,
    Held,
    InputError,
    Judged,
    Postures,
    Result,
    Robot,
    Study,
    Table,
    ToolPath,
    __version__,
    read_path,
)
from armill._commands import (
    advise,
    backlash,
    ballbar,
    budget,
    calibrate,
    command_help,
    compare,
    compensate,
    forces,
    identify,
    materials,
    path_accuracy,
    place,
    pose,
    pose_accuracy,
    posture,
    robots,
    roundness,
)

__all__ = [
    "Answer",
    "Cancelled",
    "Fault",
    "Held",
    "InputError",
    "Judged",
    "Postures",
    "Result",
    "Robot",
    "Study",
    "Table",
    "ToolPath",
    "__version__",
    "advise",
    "backlash",
    "ballbar",
    "budget",
    "calibrate",
    "command_help",
    "compare",
    "compensate",
    "forces",
    "identify",
    "materials",
    "path_accuracy",
    "place",
    "pose",
    "pose_accuracy",
    "posture",
    "read_path",
    "robots",
    "roundness",
]
