"""The live page inside of pages that use an example study."""

import html
import posixpath
import re

from . import studies, text

# `armill new DIR` copies this one where no example is named.
FIRST = "mh12-groove"
COMMAND = re.compile(r"^\$ armill new [\w-]+(?: --example ([\w-]+))?$", re.MULTILINE)
# Pages of a single study begin with it; the others show it when it is opened.
OF_STUDY = re.compile(r"^studies/([\w-]+)/README\.md$")
CHOICE = "<!-- live examples -->"


def frame(name: str, url: str, source: str = "src") -> str:
    """The live page with a study, and a link to it alone; nothing is loaded before it is in view, and with the attribute
    `data-src` nothing before the block around it is opened (`assets/live.js`).
    """
    address = posixpath.relpath("live/index.html", posixpath.dirname(url) or ".") + f"?example={name}"
    title = html.escape(studies.study(name)["title"])
    return (
        f'<div class="live"><iframe {source}="{address}" title="Live page: {title}" loading="lazy"></iframe>\n'
        f'<p><a class="md-button" href="{address}" target="_blank">Open in full</a> '
        "Change a value: map, posture and shares follow. The page calculates in this browser; nothing is sent.</p></div>"
    )


def folded(name: str, url: str, is_open: bool = False) -> str:
    """The same, opened by the reader."""
    title = html.escape(studies.study(name)["title"])
    return f'<details class="example"{" open" if is_open else ""}><summary>Try it: {title} (<code>{name}</code>, 6 MB)</summary>\n{frame(name, url, "data-src")}\n</details>'


def used(block: str) -> str | None:
    """The example that the commands of a block copy."""
    command = COMMAND.search(block)
    name = command and (command[1] or FIRST)
    return name if name in studies.names() else None


def embedded(markdown: str, path: str, url: str) -> str:
    """The text of a page with the live page behind the first block that copies an example."""
    if CHOICE in markdown:
        names = studies.names()
        names.sort(key=lambda name: name != FIRST)
        return markdown.replace(CHOICE, "\n\n".join(folded(name, url, name == FIRST) for name in names))
    if study := OF_STUDY.match(path):
        head, block, rest = markdown.partition("## study.toml")
        return f"{head}{frame(study[1], url)}\n\n{block}{rest}"
    if path != "README.md" and not path.startswith("docs/guide/"):
        return markdown
    lines = markdown.split("\n")
    flags = text.is_code(lines)
    begin = None
    for index, (line, code) in enumerate(zip(lines, flags)):
        if code and begin is None:
            begin = index
        ends = begin is not None and index > begin and line == "```"
        if ends and (name := used("\n".join(lines[begin:index]))):
            return "\n".join([*lines[: index + 1], "", folded(name, url), "", *lines[index + 1 :]])
        if ends:
            begin = None
    return markdown
