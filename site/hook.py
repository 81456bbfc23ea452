"""What the documentation adds to its generator: pages from the whole repository, and checks.

Order of events: `on_config` completes the navigation, `on_files` collects the pages, `on_page_markdown` adapts their text,
`on_page_content` their signatures, `on_post_page` adds the policy, `on_post_build` checks all links and moves the pages to `target/site`.
"""

import logging

from mkdocs.plugins import event_priority

from making import checked, live, pages, policy, published, python_types, sources, text

log = logging.getLogger("mkdocs.hooks.armill")


def on_config(config):
    """Completes the navigation; pages that need a server are left out."""
    config.nav = pages.expanded(config.nav, pages.collected())
    config.theme.static_templates.clear()
    config.extra["homepage"] = "index.html"
    return config


def on_files(files, config):
    """All pages, pictures and copies of the source files to which pages link."""
    for file in list(files):
        if file.src_dir == config.docs_dir:
            files.remove(file)
    found = pages.collected()
    for file in [*pages.files(config, found), *sources.files(config, found), *pages.assets(config)]:
        files.append(file)
    return files


def on_page_markdown(markdown, page, config, files):
    """The text of a page as the generator needs it."""
    path = page.file.src_uri
    if path.startswith(("CHANGELOG", "ARCHITECTURE", "validation/", "python/notebooks/")):
        page.meta["search"] = {"boost": 0.5}  # After the pages that explain.
    if path in ("validation/TABLE.md", "site/pages/try-it.md"):
        page.meta["hide"] = ["toc"]  # Wide, without sections.
    markdown = sources.linked(text.nested(markdown), path)
    return live.embedded(markdown, path, page.url)


def on_page_content(html, page, config, files):
    """Signatures of the Python reference in names that the reader knows."""
    return python_types.explained(html) if page.file.src_uri.startswith("site/pages/python/") else html


def on_post_page(output, page, config):
    """The page with its policy; the search has a name for readers who cannot see it."""
    dialog = 'data-md-component="search" role="dialog"'
    return policy.added(output.replace(dialog, f'{dialog} aria-label="Search"', 1))


@event_priority(-200)  # After the plugin that writes the index of the search.
def on_post_build(config):
    """Reports each broken link as a warning, which fails a strict build; without one the pages are moved to the site."""
    problems = checked.problems(config.site_dir, published.SITE)
    for problem in problems:
        log.warning(problem)
    if not problems:
        published.move(config.site_dir)
