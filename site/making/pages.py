"""The pages of the documentation: Markdown files of the repository, and pages generated from its libraries."""

import fnmatch
import posixpath
import re
from dataclasses import dataclass
from functools import cache

from mkdocs.structure.files import File

from . import libraries, licences, notebooks, repository, studies

# Pages of the root and of folders that are not pages as a whole.
SINGLE = ("README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "web/README.md")
FOLDERS = ("docs/", "validation/", "site/pages/")
PICTURES = (".png", ".svg")
# Beginnings of addresses in the site, where they differ from the paths of the repository.
MOVED = {
    "site/pages/": "",
    "docs/": "",
    "robots/README.md": "library/robots.html",
    "materials/README.md": "library/materials.html",
    "CHANGELOG.md": "changes.html",
    "ARCHITECTURE.md": "development/architecture.html",
    "CONTRIBUTING.md": "development/contributing.html",
    "SECURITY.md": "development/security.html",
    "web/README.md": "development/web.html",
}
# Pages that introduce a section of the navigation; other files of this name are pages as any other.
INTRODUCTIONS = re.compile(r"(site/pages/[\w-]+/|validation/|studies/|python/notebooks/)?README\.md")


@dataclass(frozen=True)
class Source:
    """A page: of a file of the repository, or with the text that is given."""

    path: str
    generated: str | None = None

    def text(self) -> str:
        return self.generated if self.generated is not None else repository.read(self.path) or ""


@cache
def collected() -> dict[str, Source]:
    """All pages by their paths in the repository."""
    single = [path for path in SINGLE if path in repository.paths()]
    inside = [path for path in repository.paths() if path.startswith(FOLDERS) and path.endswith(".md")]
    found = {path: Source(path) for path in [*single, *sorted(inside)]}
    for generate in (libraries.robots, libraries.materials, studies.texts, notebooks.texts, licences.texts):
        found |= {path: Source(path, content) for path, content in generate().items()}
    return found


def address(path: str) -> str:
    """Where a page is in the site."""
    for begin, moved in MOVED.items():
        if path == begin:
            return moved
        if begin.endswith("/") and path.startswith(begin):
            path = moved + path.removeprefix(begin)
            break
    folder, name = posixpath.split(path.removesuffix(".md"))
    return posixpath.join(folder, "index" if name == "README" else name) + ".html"


def is_picture(path: str) -> bool:
    """Whether a page shows the file."""
    return path.endswith(PICTURES)


def placed(file: File, where: str) -> File:
    """The file at an address of the site."""
    file.dest_uri = where
    if file.name == "index" and not INTRODUCTIONS.fullmatch(file.src_uri):
        file.name = posixpath.dirname(file.src_uri)
    return file


def files(config, found: dict[str, Source]) -> list[File]:
    """The pages, and the pictures that they show."""
    content = [placed(File.generated(config, path, content=source.text()), address(path)) for path, source in found.items()]
    pictures = [path for path in repository.inside("docs/pictures") if is_picture(path)]
    absolute = lambda path: str(repository.ROOT / path)
    return content + [placed(File.generated(config, path, abs_src_path=absolute(path)), path.removeprefix("docs/")) for path in pictures]


def assets(config) -> list[File]:
    """Style and scripts of the site, in `assets/`."""
    absolute = lambda path: str(repository.ROOT / path)
    return [File.generated(config, path.removeprefix("site/"), abs_src_path=absolute(path)) for path in repository.inside("site/assets")]


def expanded(nav: list, found: dict[str, Source]) -> list:
    """The navigation with every page of `FOLDER/*` in place of it; `*` is one folder or one file."""
    result = []
    for item in nav:
        if isinstance(item, dict):
            result += [{title: expanded(value, found) if isinstance(value, list) else value} for title, value in item.items()]
        elif "*" in item:
            result += [path for path in sorted(found) if fnmatch.fnmatch(path, item) and path.count("/") == item.count("/")]
        else:
            result.append(item)
    return result
