"""Errors of sweeps.

==================  ==============================================================================
``InputError``      of ``armill``: an invalid value, or the folder of another sweep
``SweepFailed``     a part failed, the disk is full, the cluster is lost; finished parts are kept
``MissingExtra``    a package that a backend needs is not installed
==================  ==============================================================================
"""

from __future__ import annotations

import importlib
from typing import Any

from armill import InputError


class SweepFailed(RuntimeError):
    """A sweep that stopped before its end. Finished parts are kept: repeat the call to continue."""


class MissingExtra(ImportError):
    """A package is not installed; the message says how to install it."""


def refused(message: str, hint: str) -> InputError:
    """Bad input, as the command reports it."""
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
