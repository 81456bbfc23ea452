"""The finished pages take their place in the site, next to the live page."""

import shutil
from pathlib import Path

from .repository import ROOT

SITE = ROOT / "target" / "site"


def move(built: str) -> None:
    """Replaces everything in the site but the live page."""
    SITE.mkdir(parents=True, exist_ok=True)
    for old in SITE.iterdir():
        if old.name != "live":
            shutil.rmtree(old) if old.is_dir() else old.unlink()
    # It names addresses, which are known only where the site is published.
    Path(built, "sitemap.xml").unlink(missing_ok=True)
    for new in Path(built).iterdir():
        shutil.move(new, SITE / new.name)
