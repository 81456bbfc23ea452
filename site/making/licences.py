"""The licences of what the site contains from others: style, scripts and icons of the theme."""

from importlib.metadata import distribution
from pathlib import Path

import material

PACKAGES = {"mkdocs-material": "style, scripts and search", "mkdocstrings-python": "style of the Python reference"}


def licence(package: str) -> str:
    """The text of the licence of an installed package."""
    files = distribution(package).files or []
    found = (file for file in files if file.parts[0].endswith(".dist-info") and file.name.upper().startswith("LICENSE"))
    return Path(next(found).locate()).read_text(encoding="utf-8")


def used_icons() -> Path:
    """The licence of the icons of `site/mkdocs.yml`, all of one set, and of the theme itself."""
    return Path(material.__file__).parent / "templates" / ".icons" / "material" / "LICENSE"


def block(title: str, content: str) -> str:
    return f"## {title}\n\n```text\n{content.strip()}\n```\n"


def texts() -> dict[str, str]:
    """The page of licences."""
    parts = [block(f"{package} {distribution(package).version}: {what}", licence(package)) for package, what in PACKAGES.items()]
    parts.append(block("Material Design Icons: icons", used_icons().read_text(encoding="utf-8")))
    head = (
        "# Licences\n\narmill and this documentation: Apache-2.0 or MIT, at your choice ([LICENSE-APACHE](../../LICENSE-APACHE), "
        "[LICENSE-MIT](../../LICENSE-MIT)). The site also contains, from others:\n\n"
    )
    return {"site/pages/licences.md": head + "\n".join(parts)}
