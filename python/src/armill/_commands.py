"""Every command that answers in JSON, as a function.

Operands (files, robot, study) come first, options by name: those of the command with ``_`` for ``-``, so that
``--at-mm 1000,0,800`` is ``at_mm=[1000, 0, 800]`` and a flag is ``True``. ``armill.command_help("pose")`` lists them.
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
    """command name -> str: what the command does, and its operands and options."""
    about, options = _armill.options(command.replace("_", "-"))
    lines = [f"{name:<24} {help}" for name, is_operand, help in options if not is_operand and name != "threads"]
    operands = [f"{name:<24} {help}" for name, is_operand, help in options if is_operand]
    return "\n".join([about, "", *operands, *lines])


def _ask(
    command: str,
    operands: tuple[Path, ...],
    options: dict[str, Any],
) -> Answer:
    threads = options.pop("threads", None)
    progress = options.pop("progress", None)
    return Answer(*_armill.ask(command, list(operands), options, threads, progress))


def robots(robot: Path | None = None, **options: Any) -> Answer:
    """robot or nothing -> Answer: the robot library, or one robot in full."""
    return _ask("robots", () if robot is None else (robot,), options)


def materials(material: str | None = None, **options: Any) -> Answer:
    """material or nothing -> Answer: the material library, or one material."""
    return _ask("materials", () if material is None else (material,), options)


def pose(robot: Path, **options: Any) -> Answer:
    """robot -> Answer: every posture of one pose: joints, compliance, deviation."""
    return _ask("pose", (robot,), options)


def posture(study: Path, **options: Any) -> Answer:
    """study -> Answer: the best turn of the tool and branch along the paths of a study."""
    return _ask("posture", (study,), options)


def place(study: Path, **options: Any) -> Answer:
    """study -> Answer: where the part should lie so that a path deviates least."""
    return _ask("place", (study,), options)


def advise(study: Path, **options: Any) -> Answer:
    """study -> Answer: what to do so that a path holds its tolerance."""
    return _ask("advise", (study,), options)


def compare(*studies: Path, **options: Any) -> Answer:
    """studies -> Answer: the same path in several cells side by side."""
    return _ask("compare", studies, options)


def compensate(study: Path, **options: Any) -> Answer:
    """study -> Answer: the paths to command so that the tool goes where it is drawn."""
    return _ask("compensate", (study,), options)


def identify(tests: Path | None = None, **options: Any) -> Answer:
    """table of load tests -> Answer: joint compliances; with ``plan`` and no table which tests to do."""
    return _ask("identify", () if tests is None else (tests,), options)


def calibrate(file: Path, **options: Any) -> Answer:
    """table of measured poses -> Answer: lengths, angles and zeros of this very arm."""
    return _ask("calibrate", (file,), options)


def forces(file: Path, **options: Any) -> Answer:
    """record of a dynamometer -> Answer: what is in it, without drift and teeth."""
    return _ask("forces", (file,), options)


def roundness(*files: Path, **options: Any) -> Answer:
    """measured profiles -> Answer: how round they are: the four reference circles, filter, harmonics."""
    return _ask("roundness", files, options)


def ballbar(*files: Path, **options: Any) -> Answer:
    """runs of a ball-bar -> Answer: how round the tool goes, and why not rounder."""
    return _ask("ballbar", files, options)


def backlash(study: Path, **options: Any) -> Answer:
    """study -> Answer: how much play each joint has, from a ball-bar; which circles tell; made-up tests."""
    return _ask("backlash", (study,), options)


def pose_accuracy(file: Path, **options: Any) -> Answer:
    """table of measured poses -> Answer: how near the arm comes to its poses, and how alike."""
    return _ask("pose-accuracy", (file,), options)


def path_accuracy(*files: Path, **options: Any) -> Answer:
    """measured paths -> Answer: how near the tip keeps to a path, and how alike."""
    return _ask("path-accuracy", files, options)


def budget(study: Path, **options: Any) -> Answer:
    """study -> Answer: what the error of a measured circle is made of, and how much of it is predicted."""
    return _ask("budget", (study,), options)
