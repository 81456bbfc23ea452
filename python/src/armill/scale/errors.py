"""What goes wrong with a sweep.

==================  ==============================================================================
``InputError``      of ``armill``: what was asked cannot be, or the folder is of another sweep
``SweepFailed``     a part failed, the disk is full, the cluster is gone; what is done stays
``MissingExtra``    a package that a backend needs is not installed
==================  ==============================================================================
"""

from __future__ import annotations

import importlib
from typing import Any

from armill import InputError


class SweepFailed(RuntimeError):
    """A sweep that stopped before its end. What is done stays: the same call goes on from there."""


class MissingExtra(ImportError):
    """A package that is not installed; its text says how to."""


def refused(message: str, hint: str) -> InputError:
    """Bad input, told as the command tells it."""
    error = InputError(f"{message}\n  help: {hint}")
    error.problems = [{"message": message, "hint": hint}]
    return error


def needed(module: str, extra: str) -> Any:
    """The module of a package that only sweeps need. Raises MissingExtra where it is not installed."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        raise MissingExtra(
            f'{package} is not installed ({error}): pip install "armill[{extra}]"', name=package
        ) from error
