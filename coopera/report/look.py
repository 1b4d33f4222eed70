"""The look that all pages share: where the templates are, and the style of a page that is one file."""

from __future__ import annotations

from pathlib import Path

TEMPLATES = Path(__file__).parents[1] / "templates"


def style_with(name: str) -> str:
    """The shared look, then what a page has of its own in `templates/NAME`."""
    return "".join((TEMPLATES / one).read_text(encoding="utf-8") for one in ("look.css", name))
