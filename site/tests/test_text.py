"""Markdown as it is written for GitHub becomes that of the generator."""

import unittest

from making import live, pages, policy, sources, text


class Text(unittest.TestCase):
    def test_nested_items_are_indented_by_four(self):
        self.assertEqual(text.nested("1. a\n   - b\n  - c\n```\n  - d\n```\n"), "1. a\n    - b\n    - c\n```\n  - d\n```\n")

    def test_links_outside_code_are_replaced(self):
        page = "[a](b.md#c) [`d`](e.rs), [`f`](g.rs) `[h](i.md)` ![j](k.png)\n```\n[l](m.md)\n```"
        seen = []
        same = text.with_links(page, lambda target: seen.append(target) or target)
        self.assertEqual(same, page)
        self.assertEqual(seen, ["b.md#c", "e.rs", "g.rs", "k.png"])

    def test_source_files_become_copies_and_pages_stay_pages(self):
        page = "[a](../../crates/core/src/predict.rs) [b](../../robots) [c](../notation.md#units) [d](https://example.org)"
        expected = "[a](../../source/crates/core/src/predict.rs.html) [b](../../robots/README.md) [c](../notation.md#units) [d](https://example.org)"
        self.assertEqual(sources.linked(page, "docs/guide/predict.md"), expected)

    def test_studies_have_their_own_pages(self):
        page = "[a](studies/mh12-groove/study.toml) [b](studies/mh12-groove)"
        self.assertEqual(sources.linked(page, "README.md"), "[a](studies/mh12-groove/README.md) [b](studies/mh12-groove/README.md)")

    def test_addresses(self):
        addresses = {"README.md": "index.html", "docs/guide/README.md": "guide/index.html", "docs/notation.md": "notation.html", "site/pages/try-it.md": "try-it.html"}
        for path, address in addresses.items():
            self.assertEqual(pages.address(path), address)
        self.assertEqual(len(set(map(pages.address, pages.collected()))), len(pages.collected()))

    def test_licences_are_those_of_the_packages(self):
        page = pages.collected()["site/pages/licences.md"].text()
        self.assertRegex(page, r"(?s)mkdocs-material .*Martin Donath.*mkdocstrings-python .*Mazzucotelli")
        self.assertNotIn("Font Awesome", page.partition("Material Design Icons")[0])

    def test_the_live_page_follows_the_block_that_copies_an_example(self):
        block = "```console\n$ armill new pocket --example r2000ic-pocket\ncreated\n```\n"
        page = live.embedded(f"a\n\n{block}\nb\n\n{block}", "docs/guide/a.md", "guide/a.html")
        self.assertEqual(page.count("<iframe"), 1)
        self.assertIn('data-src="../live/index.html?example=r2000ic-pocket"', page)
        self.assertLess(page.index("created"), page.index("<iframe"))
        self.assertLess(page.index("<iframe"), page.index("\nb\n"))
        for other in ("```console\n$ armill new cell\n```\n", "a `--example NAME`\n", "`mh12-groove`\n"):
            self.assertEqual(live.embedded(other, "docs/guide/a.md", "guide/a.html"), other)

    def test_the_live_page_follows_the_paragraph_that_names_an_example(self):
        page = live.embedded("a example `mh12-groove`, and\nb\n\nc\n", "docs/guide/a.md", "guide/a.html")
        self.assertLess(page.index("\nb\n"), page.index("<iframe"))
        self.assertLess(page.index("</details>"), page.index("\nc\n"))

    def test_the_policy_names_each_script_of_the_page(self):
        page = policy.added('<meta charset="utf-8"><script>var a=1</script><script id="b" type="application/json">{}</script>')
        self.assertEqual(page.count("'sha256-"), 1)
        self.assertLess(page.index("Content-Security-Policy"), page.index("<script>"))
