"""Notebooks as pages: their text and code; results are those of the reader's machine."""

import json

from . import repository

FOLDER = "python/notebooks"


def page(path: str) -> str:
    """The page of a notebook."""
    return path.removesuffix(".ipynb") + ".md" if path.endswith(".ipynb") else path


def cell(content: dict) -> str:
    source = "".join(content["source"])
    return source if content["cell_type"] == "markdown" else f"```python\n{source}\n```"


def texts() -> dict[str, str]:
    """A page for each notebook, and the list of them."""
    paths = [path for path in repository.inside(FOLDER) if path.endswith(".ipynb")]
    found = {page(path): "\n\n".join(map(cell, json.loads(repository.read(path) or "")["cells"])) + "\n" for path in paths}
    title = lambda content: content.split("\n", 1)[0].lstrip("# ")
    items = "".join(f"- [{title(content)}]({path.rsplit('/', 1)[1]})\n" for path, content in found.items())
    return {f"{FOLDER}/README.md": f"# Notebooks\n\nEach notebook runs in less than a minute, with `pip install 'armill[plot]'`.\n\n{items}", **found}
