"""Copies of the source files to which pages link, as plain text, so that no link is dead."""

import html
import posixpath

from mkdocs.structure.files import File

from . import notebooks, pages, repository, text

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'self'; img-src 'self'; base-uri 'none'; form-action 'none'">
<meta name="viewport" content="width=device-width,initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{path} - armill</title>
<link rel="icon" href="{root}assets/icon.svg">
<link rel="stylesheet" href="{root}assets/source.css">
</head>
<body>
<p><a href="{root}index.html">armill</a> / {path}</p>
{body}
</body>
</html>
"""


def meant(path: str) -> str:
    """The page that describes a file or folder of the repository, or the path itself."""
    folder = path.removesuffix("/study.toml")
    for page in (f"{folder}/README.md", notebooks.page(path)):
        if page in pages.collected() and (path == folder or path.startswith("studies/")):
            return page
    return path


def address(path: str) -> str:
    """Where the copy of a file, or the list of a folder, is in the site."""
    return f"source/{path}.html" if path in repository.paths() else f"source/{path}/index.html"


def targets(found: dict[str, pages.Source]) -> set[str]:
    """All files and folders to which pages link and that are not pages."""
    linked: set[str] = set()
    for page, source in found.items():

        def note(target: str) -> str:
            path = meant(repository.resolved(page, target.split("#")[0])) if text.is_relative(target) else page
            if path not in found and not pages.is_picture(path):
                linked.add(path)
            return target

        text.with_links(source.text(), note)
    return linked


def linked(markdown: str, page: str) -> str:
    """The text of a page with links to copies in place of links to source files."""
    found = pages.collected()

    def changed(target: str) -> str:
        if not text.is_relative(target):
            return target
        path, hash_, anchor = target.partition("#")
        path = meant(repository.resolved(page, path)) if path else page
        is_there = path in repository.paths() or repository.inside(path)
        if path not in found and not pages.is_picture(path) and is_there:
            path = address(path)
        return posixpath.relpath(path, posixpath.dirname(page) or ".") + hash_ + anchor

    return text.with_links(markdown, changed)


def files(config, found: dict[str, pages.Source]) -> list[File]:
    """The copies; of a folder the list of its files, and these."""
    wanted, copies = sorted(targets(found)), {}
    for path in wanted:
        inside = repository.inside(path)
        if inside:
            copies[path] = listing(path, inside)
        # Neither a folder nor a file: the generator reports the broken link.
        for file in inside or [path] * (path in repository.paths()):
            content = repository.read(file)
            copies[file] = f"<pre>{html.escape(content)}</pre>" if content is not None else "<p>This file is not text.</p>"
    return [File.generated(config, address(path), content=page(path, body)) for path, body in copies.items()]


def page(path: str, body: str) -> str:
    """A page of its own, without scripts."""
    return PAGE.format(path=html.escape(path), body=body, root="../" * address(path).count("/"))


def listing(folder: str, inside: tuple[str, ...]) -> str:
    """Links to all files of a folder."""
    here = posixpath.dirname(address(folder))
    items = (f'<li><a href="{posixpath.relpath(address(file), here)}">{html.escape(file)}</a></li>' for file in inside)
    return f"<ul>{''.join(items)}</ul>"
