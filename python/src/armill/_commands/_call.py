"""Calls of commands by name."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar, cast

from armill import _armill
from armill._answer import Answer
from armill._commands._tables import TableFiles

#: Commands whose `out` is a robot file.
ROBOT_FILES = ("identify", "calibrate", "learn", "journal", "drives", "motion")

F = TypeVar("F", bound=Callable[..., Answer])


def command_help(command: str) -> str:
    """command name -> str: the help of the command, its operands and options."""
    about, options = _armill.options(command.replace("_", "-"))
    operands = [(name, help) for name, is_operand, help in options if is_operand]
    return "\n".join([about, "", *_lines(operands), *_lines(_options(command))])


def command(function: F) -> F:
    """Adds the options of a command to the documentation of its function."""
    lines = [f"    {line}" for line in _lines(_options(function.__name__))]
    general = [
        "    threads                  Number of threads; all processors if not given",
        "    progress                 Function that is called with the number of points finished",
    ]
    function.__doc__ = "\n".join([str(function.__doc__).rstrip(), "", "Options:", "", *lines, *general])
    return function


def call(command: str, operands: Sequence[Any], given: Mapping[str, Any]) -> Answer:
    """command, operands, the arguments of its function by name -> Answer.

    Robots, studies and tables in memory stand for files.
    """
    names = [name for name, _ in _options(command)]
    options = {name: _option(given[name]) for name in names if given[name] is not None}
    with TableFiles() as files:
        paths = files.of(operands)
        for name, value in options.items():
            if isinstance(value, (list, tuple)):
                options[name] = files.of(cast("Sequence[Any]", value))
            else:
                (options[name],) = files.of([value])
        try:
            json, messages, within_tolerance = _armill.call(command, paths, options, given["threads"], given["progress"])
        except _armill.InputError as error:
            error.args = (files.without_folder(str(error)),)
            error.problems = [{key: files.without_folder(value) for key, value in each.items()} for each in error.problems]
            raise
        text, lines = files.without_folder(json), [files.without_folder(line) for line in messages]
    out = given.get("out")
    robot_file = os.path.abspath(out) if command in ROBOT_FILES and out is not None else None
    return Answer(text, lines, within_tolerance, robot_file)


def _option(value: Any) -> Any:
    """Names for names, such as those of columns, as the command takes them."""
    if isinstance(value, Mapping):
        pairs: list[tuple[Any, Any]] = list(value.items())  # pyright: ignore
        if all(isinstance(other, str) for _, other in pairs):
            return [f"{own}={other}" for own, other in pairs]
    return value


def _options(command: str) -> list[tuple[str, str]]:
    """Name and help of each option; the number of threads is one of every function."""
    _, options = _armill.options(command.replace("_", "-"))
    return [(name, help) for name, is_operand, help in options if not is_operand and name != "threads"]


def _lines(options: Sequence[tuple[str, str]]) -> list[str]:
    return [f"{name:<24} {help}" for name, help in options]
