"""A page for each example study, with its files and the live page."""

import tomllib

from . import repository

LANGUAGES = {"toml": "toml", "csv": "text", "ngc": "text"}
LARGEST = 12_000


def names() -> list[str]:
    """The example studies."""
    return [path.split("/")[1] for path in repository.inside("studies") if path.endswith("/study.toml")]


def study(name: str) -> dict:
    return tomllib.loads(repository.read(f"studies/{name}/study.toml") or "")


def shown(path: str) -> str:
    """A file of a study; of a long one the first lines."""
    content = repository.read(path) or ""
    name = path.rsplit("/", 1)[1]
    rest = ""
    if len(content) > LARGEST:
        lines = content.split("\n")
        content, rest = "\n".join(lines[:40]), f"\n\nThe first 40 of {len(lines)} lines."
    return f"## {name}\n\n```{LANGUAGES.get(name.rsplit('.', 1)[1], 'text')}\n{content.rstrip()}\n```{rest}\n"


def texts() -> dict[str, str]:
    """The list of studies, and a page for each."""
    rows, found = [], {}
    for name in names():
        content = study(name)
        question = content.get("question", "")
        rows.append(f"| [`{name}`]({name}/README.md) | {content['title']} | {question} |")
        files = sorted(repository.inside(f"studies/{name}"), key=lambda path: (not path.endswith("study.toml"), path))
        body = "\n".join(shown(path) for path in files)
        found[f"studies/{name}/README.md"] = (
            f"# {content['title']}\n\n{question}\n\n```sh\narmill new cell --example {name}\narmill run cell\n```\n\n{body}"
        )
    head = "# Example studies\n\nEach example can be [tried in the browser](../site/pages/try-it.md), or copied with `armill new DIR --example NAME`.\n\n"
    found["studies/README.md"] = head + "| name | study | question |\n|---|---|---|\n" + "\n".join(rows) + "\n"
    return found
