"""The check of links finds what is broken, and nothing else."""

import tempfile
import unittest
from pathlib import Path

from making import checked

POLICY = '<meta http-equiv="Content-Security-Policy" content="default-src \'self\'">'


class Checked(unittest.TestCase):
    def problems(self, files: dict[str, str], live: dict[str, str] | None = None) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            for place, content in [("site", files), ("built/live", live or {})]:
                for path, text in content.items():
                    file = Path(folder, place, path)
                    file.parent.mkdir(parents=True, exist_ok=True)
                    file.write_text(text, encoding="utf-8")
            return checked.problems(Path(folder, "site"), Path(folder, "built"))

    def test_links_to_pages_anchors_pictures_and_other_servers_pass(self):
        page = POLICY + '<a href="b/c.html#there">x</a><a href="#here" id="here">y</a><img src="b/d.svg"><a href="https://example.org">z</a>'
        files = {"a.html": page, "b/c.html": POLICY + '<a href="../a.html">x</a><p id="there">', "b/d.svg": ""}
        self.assertEqual(self.problems(files), [])

    def test_missing_files_and_anchors_are_reported(self):
        page = POLICY + '<a href="missing.html">x</a><a href="#missing">y</a><img src="missing.png"><a href="../out.html">z</a>'
        problems = self.problems({"a.html": page})
        self.assertEqual(len(problems), 4, problems)
        self.assertIn("a.html: `missing.html` leads nowhere", problems)
        self.assertIn("a.html: `#missing` leads to an anchor that is not there", problems)
        self.assertIn("a.html: `../out.html` leads out of the site", problems)

    def test_requests_to_other_servers_are_reported(self):
        page = POLICY + '<script src="https://example.org/a.js"></script><link href="//example.org/a.css">'
        problems = self.problems({"a.html": page, "a.css": "@import 'https://example.org/b.css';"})
        self.assertEqual(len(problems), 3, problems)

    def test_a_page_without_policy_is_reported(self):
        self.assertEqual(self.problems({"a.html": "<p>"}), ["a.html: no Content-Security-Policy"])

    def test_the_live_page_is_looked_up_where_it_was_built(self):
        page = {"a.html": POLICY + '<iframe src="live/index.html?example=x"></iframe><iframe data-src="live/other.html"></iframe>'}
        self.assertEqual(self.problems(page, {"index.html": ""}), ["a.html: `live/other.html` leads nowhere"])
        self.assertEqual(self.problems(page), [])
