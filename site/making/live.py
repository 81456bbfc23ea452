"""The live page inside of pages that use an example study."""

import html
import posixpath
import re

from . import studies, text

# The first one of the page with all of them.
FIRST = "mh12-groove"
# How a page uses an example study.
USE = re.compile(r"--example ([\w-]+)|\brun studies/([\w-]+)|\bplace studies/([\w-]+)|Study\.load\(\"([\w-]+)\"|example `([\w-]+)`")
# Pages that name one, with another subject.
WITHOUT = ("docs/guide/install.md", "docs/guide/many-machines.md", "docs/guide/site.md")
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
    return f'<details class="example"{" open" if is_open else ""}><summary>Try an example: {title} (<code>{name}</code>, 6 MB)</summary>\n{frame(name, url, "data-src")}\n</details>'


def used(line: str) -> str | None:
    """The example study that a line of a page uses."""
    names = (name for found in USE.findall(line) for name in found)
    return next((name for name in names if name in studies.names()), None)


def embedded(markdown: str, path: str, url: str) -> str:
    """The text of a page with the live page behind the first block or paragraph that uses an example study."""
    if CHOICE in markdown:
        names = studies.names()
        names.sort(key=lambda name: name != FIRST)
        return markdown.replace(CHOICE, "\n\n".join(folded(name, url, name == FIRST) for name in names))
    if study := OF_STUDY.match(path):
        head, block, rest = markdown.partition("## study.toml")
        return f"{head}{frame(study[1], url)}\n\n{block}{rest}"
    if path in WITHOUT or not (path == "README.md" or path.startswith("docs/guide/")):
        return markdown
    lines = markdown.split("\n")
    flags = text.is_code(lines)
    for index, line in enumerate(lines):
        if name := used(line):
            inside = flags[index]
            end = next((at for at in range(index, len(lines)) if (not flags[at] if inside else not lines[at])), len(lines))
            return "\n".join([*lines[:end], "", folded(name, url), "", *lines[end:]])
    return markdown
