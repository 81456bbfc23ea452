"""The Content-Security-Policy of a page: own files alone, and the scripts inside of the page by their hashes."""

import base64
import hashlib
import re

# Styles inside of a page set the alignment of columns; pictures of the theme are `data:` in its style.
RULES = (
    "default-src 'none'; script-src 'self'{hashes}; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; frame-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'"
)
# Scripts without a source; data in a script element (`type="application/json"`) is not run and needs no hash.
SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)
FIRST = '<meta charset="utf-8">'


def added(page: str) -> str:
    """The page with its policy, before everything that it applies to."""
    digests = {base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in SCRIPT.findall(page)}
    hashes = "".join(f" 'sha256-{digest}'" for digest in sorted(digests))
    meta = f'<meta http-equiv="Content-Security-Policy" content="{RULES.format(hashes=hashes)}">'
    return page.replace(FIRST, FIRST + meta, 1)
