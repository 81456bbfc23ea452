"""Signatures, stubs and help say what the functions take."""

from __future__ import annotations

import ast
import inspect
import typing
from pathlib import Path
from typing import Literal  # noqa: F401

import pytest

import armill
from armill import _armill, _types

STUB = Path(inspect.getfile(armill)).parent / "_armill.pyi"
COMMANDS = [name for name in armill.__all__ if getattr(getattr(armill, name), "__module__", "").startswith("armill._commands.")]


def documented(stub: ast.Module) -> dict[str, str | None]:
    """The documentation of every class, method and function in the stub, by name; of overloads that of the first."""
    found: dict[str, str | None] = {}

    def look(body: list[ast.stmt], prefix: str) -> None:
        for node in body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                found.setdefault(prefix + node.name, ast.get_docstring(node))
            if isinstance(node, ast.ClassDef):
                look(node.body, f"{prefix}{node.name}.")

    look(stub.body, "")
    return found


def test_the_stub_has_the_documentation_of_the_module():
    for name, text in documented(ast.parse(STUB.read_text())).items():
        last = name.rpartition(".")[2]
        if last.startswith("_"):
            continue
        thing: object = _armill
        for part in name.split("."):
            thing = inspect.getattr_static(thing, part)
        thing = getattr(thing, "__func__", thing)
        assert text == inspect.getdoc(thing), name


def public() -> list[tuple[str, object]]:
    things = [(name, getattr(armill, name)) for name in armill.__all__]
    for name, thing in list(things):
        if inspect.isclass(thing) and not issubclass(thing, BaseException):
            members = [member for member in vars(thing) if not member.startswith("_")]
            things += [(f"{name}.{member}", getattr(thing, member)) for member in members]
    return [(name, thing) for name, thing in things if callable(thing) and not inspect.isclass(thing)]


@pytest.mark.parametrize(("name", "function"), public(), ids=lambda value: value if isinstance(value, str) else "")
def test_signatures_name_every_option_and_its_default(name, function):
    for parameter in inspect.signature(function).parameters.values():
        assert parameter.default is not Ellipsis, f"{name}({parameter})"
        assert parameter.kind is not parameter.VAR_KEYWORD, f"{name}({parameter})"


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_has_the_options_of_its_command_line(name):
    if name == "command_help":
        return
    function = getattr(armill, name)
    _, options = _armill.options(name.replace("_", "-"))
    expected = [option for option, is_operand, _ in options if not is_operand and option != "threads"]
    parameters = inspect.signature(function).parameters.values()
    keywords = [parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY]
    assert keywords == [*expected, "threads", "progress"]
    for option in expected:
        assert f"    {option} " in function.__doc__
    assert all("Any" not in str(parameter.annotation) for parameter in parameters)


def test_every_branch_of_the_type_is_a_branch(mh12):
    pose = mh12.forward([0.1, 0.2, -0.3, 0.1, 0.5, 0.2])
    named = [f"{front} elbow-{up} {flip}" for front in ("front", "back") for up in ("up", "down") for flip in ("no-flip", "flip")]
    branches = typing.get_args(_types.Branch)
    assert set(named) <= set(branches) and len(branches) == 28
    for branch in branches:
        mh12.evaluate(pose, [0, 0, -50], branch=branch)


@pytest.mark.parametrize("name", COMMANDS)
def test_the_choices_of_the_types_are_those_of_the_commands(name):
    if name == "command_help":
        return
    for parameter in inspect.signature(getattr(armill, name)).parameters.values():
        for choice in choices(parameter.annotation):
            with pytest.raises(armill.InputError) as refused:
                armill_call(name, parameter.name, choice)
            # The choice itself is accepted: something else is missing.
            assert "invalid value" not in str(refused.value), (parameter.name, choice)


def choices(annotation: str) -> list[str]:
    """The words that a type permits."""
    parts = [getattr(_types, part, None) if part.isidentifier() else part for part in annotation.split(" | ")]
    found = [typing.get_args(eval(part) if isinstance(part, str) and part.startswith("Literal[") else part) for part in parts]
    return [choice for each in found for choice in each if isinstance(choice, str)]


def test_a_choice_that_is_none_is_refused():
    assert choices("Objective | None") == ["worst", "mean", "above-tolerance"] and choices('float | Literal["found"]') == ["found"]
    with pytest.raises(armill.InputError, match="invalid value"):
        armill_call("place", "objective", "best")


def armill_call(command: str, option: str, choice: str) -> None:
    """A call with this choice that has no file."""
    name = command.replace("_", "-")
    options = {option: choice} | ({"robot": "yaskawa/mh12"} if name in {"calibrate", "pose-accuracy", "identify"} else {})
    _armill.call(name, ["no/such"] if name != "pose" else ["yaskawa/mh21"], options | ({"at_mm": [1, 2, 3]} if name == "pose" else {}))
