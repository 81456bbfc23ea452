"""The Python blocks of README and guide run; every public name documents its result."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

import armill
from armill import _armill
from conftest import ROOT

PAGES = ["README.md", "python/README.md", "docs/guide/python.md", "docs/guide/many-machines.md"]


def blocks(page: Path) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", PAGES)
def test_python_blocks_of_a_page_run(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    found = blocks(ROOT / page)
    assert found
    names: dict[str, object] = {}
    for number, block in enumerate(found, 1):
        exec(compile(block, f"{page}, block {number}", "exec"), names)
    assert capsys.readouterr().out


def public() -> list[tuple[str, object]]:
    things: list[tuple[str, object]] = []
    for name in armill.__all__:
        thing = getattr(armill, name)
        if name == "__version__":
            continue
        things.append((name, thing))
        if inspect.isclass(thing) and not issubclass(thing, BaseException):
            members = [member for member in vars(thing) if not member.startswith("_")]
            things += [(f"{name}.{member}", getattr(thing, member)) for member in members]
    return things


@pytest.mark.parametrize(("name", "thing"), public(), ids=lambda value: value if isinstance(value, str) else "")
def test_every_public_name_documents_its_result(name, thing):
    text = inspect.getdoc(thing)
    assert text, name
    first = text.splitlines()[0]
    if inspect.isclass(thing):
        assert len(first) > 15, name
    else:
        assert "->" in first or name == "Study.check", f"{name}: {first}"


def test_functions_of_arrays_document_shapes_in_their_first_line():
    for name in ("forward", "jacobian", "compliance", "deviation", "contributions", "gravity"):
        first = inspect.getdoc(getattr(armill.Robot, name)).splitlines()[0]
        assert re.search(r"\(n, dof\).*-> \(n, ", first), first
    for name in ("inverse", "evaluate"):
        assert "(n, 4, 4) poses" in inspect.getdoc(getattr(armill.Robot, name)).splitlines()[0]


def test_all_names_of_the_native_part_are_public_or_used():
    own = {name for name in vars(_armill) if not name.startswith("_")}
    assert own - set(armill.__all__) == {"arithmetic", "call", "command", "options"}
    assert armill.__version__ == _armill.__version__
    assert (Path(inspect.getfile(armill)).parent / "py.typed").is_file()
