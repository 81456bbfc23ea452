"""Predict, explain and reduce the machining error of industrial robots.

Arrays of numpy in and out, batch first: ``(n, dof)`` joints, ``(n, 4, 4)`` poses, ``(n, cases, 3)`` deviations. SI units:
m, rad, N, N m. A single item is given without the first axis; its result has no first axis either.

====================  =====================================================================
``Robot``             a robot of the library or of a file: kinematics, compliance, deviations
``Study``             a study file: check it, run it, read its results
``pose``, ...         each command as a function, with the options of the command
``read_path``         the moves of a tool path
``sobol_indices``     what each uncertain input explains of the variance; ``variance_shares``: by the law of propagation
``armill.scale``      sweeps over many machines (``armill[scale]``)
====================  =====================================================================
"""

from armill._answer import Answer
from armill._armill import (
    Cancelled,
    Evaluation,
    Fault,
    InputError,
    PlacementEvaluations,
    Postures,
    Result,
    Robot,
    Samples,
    Study,
    Table,
    ToolPath,
    __version__,
    normal_draws,
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
    drives,
    export,
    forces,
    frf,
    identify,
    journal,
    learn,
    materials,
    modes,
    motion,
    path_accuracy,
    place,
    pose,
    pose_accuracy,
    posture,
    receptance,
    robots,
    roundness,
    tracker,
    stability,
)
from armill._sensitivity import VarianceShares, sobol_indices, variance_shares

__all__ = [
    "Answer",
    "Cancelled",
    "Evaluation",
    "Fault",
    "InputError",
    "PlacementEvaluations",
    "Postures",
    "Result",
    "Robot",
    "Samples",
    "Study",
    "Table",
    "ToolPath",
    "VarianceShares",
    "__version__",
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
    "normal_draws",
    "path_accuracy",
    "place",
    "pose",
    "pose_accuracy",
    "posture",
    "read_path",
    "receptance",
    "robots",
    "roundness",
    "sobol_indices",
    "stability",
    "tracker",
    "variance_shares",
]
