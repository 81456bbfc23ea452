"""Each command with an answer in JSON, as a function.

Operands (files, robot, study) come first, options by name: those of the command with ``_`` for ``-``. For example,
``--at-mm 1000,0,800`` is ``at_mm=[1000, 0, 800]``, and a flag is ``True``. ``armill.command_help("pose")`` lists them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from armill import _armill
from armill._answer import Answer

Path = str | os.PathLike[str]
Progress = Callable[[int], object]


def command_help(command: str) -> str:
    """command name -> str: the help of the command, its operands and options."""
    about, options = _armill.options(command.replace("_", "-"))
    lines = [f"{name:<24} {help}" for name, is_operand, help in options if not is_operand and name != "threads"]
    operands = [f"{name:<24} {help}" for name, is_operand, help in options if is_operand]
    return "\n".join([about, "", *operands, *lines])


def _call(
    command: str,
    operands: tuple[Path, ...],
    options: dict[str, Any],
) -> Answer:
    threads = options.pop("threads", None)
    progress = options.pop("progress", None)
    return Answer(*_armill.call(command, list(operands), options, threads, progress))


def robots(robot: Path | None = None, **options: Any) -> Answer:
    """robot or nothing -> Answer: the robot library, or the data of one robot."""
    return _call("robots", () if robot is None else (robot,), options)


def materials(material: str | None = None, **options: Any) -> Answer:
    """material or nothing -> Answer: the material library, or the data of one material."""
    return _call("materials", () if material is None else (material,), options)


def pose(robot: Path, **options: Any) -> Answer:
    """robot -> Answer: all postures at one pose: joints, compliance, deviation."""
    return _call("pose", (robot,), options)


def posture(study: Path, **options: Any) -> Answer:
    """study -> Answer: the best spin of the tool and branch along the paths of a study."""
    return _call("posture", (study,), options)


def place(study: Path, **options: Any) -> Answer:
    """study -> Answer: the placement of the part with the smallest deviation of a path."""
    return _call("place", (study,), options)


def advise(study: Path, **options: Any) -> Answer:
    """study -> Answer: measures to bring a path within its tolerance."""
    return _call("advise", (study,), options)


def compare(*studies: Path, **options: Any) -> Answer:
    """studies -> Answer: the same path in several robot cells, compared."""
    return _call("compare", studies, options)


def compensate(study: Path, **options: Any) -> Answer:
    """study -> Answer: compensated paths, on which the tool follows the nominal path."""
    return _call("compensate", (study,), options)


def identify(tests: Path | None = None, **options: Any) -> Answer:
    """table of load tests -> Answer: joint compliances; with ``plan`` and no table, a plan of load tests."""
    return _call("identify", () if tests is None else (tests,), options)


def calibrate(file: Path, **options: Any) -> Answer:
    """table of measured poses -> Answer: calibrated lengths, angles and joint zeros of the arm."""
    return _call("calibrate", (file,), options)


def forces(file: Path, **options: Any) -> Answer:
    """record of a dynamometer -> Answer: forces without drift, averaged over spindle revolutions."""
    return _call("forces", (file,), options)


def roundness(*files: Path, **options: Any) -> Answer:
    """measured profiles -> Answer: roundness deviation: the four reference circles, filter, harmonics."""
    return _call("roundness", files, options)


def ballbar(*files: Path, **options: Any) -> Answer:
    """ball-bar tests -> Answer: circular deviation and its causes."""
    return _call("ballbar", files, options)


def backlash(study: Path, **options: Any) -> Answer:
    """study -> Answer: backlash of each joint from ball-bar tests; the best test circles; synthetic tests."""
    return _call("backlash", (study,), options)


def pose_accuracy(file: Path, **options: Any) -> Answer:
    """table of measured poses -> Answer: pose accuracy and pose repeatability (ISO 9283)."""
    return _call("pose-accuracy", (file,), options)


def path_accuracy(*files: Path, **options: Any) -> Answer:
    """measured paths -> Answer: path accuracy and path repeatability (ISO 9283)."""
    return _call("path-accuracy", files, options)


def budget(study: Path, **options: Any) -> Answer:
    """study -> Answer: the error budget of a measured circle, and the predicted part of it."""
    return _call("budget", (study,), options)
