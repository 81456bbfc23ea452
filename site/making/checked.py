"""Every link, picture, script and style of the finished pages leads to a file of the site, and every anchor to a place."""

import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# What the browser requests by itself: never from another server.
REQUESTED = {("img", "src"), ("script", "src"), ("iframe", "src"), ("iframe", "data-src"), ("link", "href"), ("source", "src"), ("object", "data")}
LINKS = REQUESTED | {("a", "href")}
IN_STYLE = re.compile(r"url\(\s*['\"]?(https?:)?//|@import\s+['\"]?(https?:)?//")


class Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, content: str):
        super().__init__()
        self.links: list[tuple[str, str, str]] = []
        self.anchors: set[str] = set()
        self.has_policy = False
        self.feed(content)

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if value and (tag, name) in LINKS:
                self.links.append((tag, name, value))
            if value and (name == "id" or (tag, name) == ("a", "name")):
                self.anchors.add(value)
            self.has_policy |= (name, value) == ("http-equiv", "Content-Security-Policy")


@cache
def page(path: Path) -> Page:
    return Page(path.read_text(encoding="utf-8"))


def problem(at: Path, tag: str, name: str, link: str, site: Path, live: Path) -> str | None:
    """What is wrong with a link of a page; nothing if it is correct."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        from_elsewhere = (tag, name) in REQUESTED and parts.scheme != "data"
        return "is requested from another server" if from_elsewhere else None
    target = (at.parent / unquote(parts.path)).resolve() if parts.path else at
    if not target.is_relative_to(site):
        return "leads out of the site"
    if target.is_relative_to(site / "live"):
        built = live / "live"
        return None if (built / target.relative_to(site / "live")).is_file() or not built.is_dir() else "leads nowhere"
    if not target.is_file():
        return "leads nowhere"
    anchor = unquote(parts.fragment)
    if anchor and target.suffix == ".html" and anchor not in page(target).anchors | {"__tabbed", "top"}:
        return "leads to an anchor that is not there"
    return None


def problems(folder: str | Path, live: str | Path) -> list[str]:
    """All problems of the pages in a folder, one a line; `live` is the site that has the live page, if it was built."""
    site, found = Path(folder).resolve(), []
    for path in sorted(site.rglob("*.html")):
        at, content = path.relative_to(site), page(path)
        if not content.has_policy:
            found.append(f"{at}: no Content-Security-Policy")
        for tag, name, link in content.links:
            if what := problem(path, tag, name, link, site, Path(live).resolve()):
                found.append(f"{at}: `{link}` {what}")
    for path in sorted(site.rglob("*.css")):
        if IN_STYLE.search(path.read_text(encoding="utf-8")):
            found.append(f"{path.relative_to(site)}: requests a file from another server")
    return found
