"""What a page may do: run the script and the styles that it was written with, show pictures within it, and no more."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterable


def content_policy(*, styles: Iterable[str], scripts: Iterable[str] = (), coloured: bool = False) -> str:
    """The Content-Security-Policy of a page that is one file.

    A text that got into the page as HTML by a mistake of ours could neither run a script nor load or send anything.

    Args:
        styles: The texts of the page's `<style>` elements, as they stand in it.
        scripts: Those of its `<script>` elements.
        coloured: Whether elements have a `style` of their own, as cells of a map and our drawings do.
    """
    attributes = "'unsafe-inline'" if coloured else "'none'"
    parts = [
        "default-src 'none'",
        "img-src data:",
        f"style-src {_hashes(styles)}",
        f"style-src-attr {attributes}",
        f"script-src {_hashes(scripts)}",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return "; ".join(parts)


def served_policy() -> str:
    """The Content-Security-Policy of a page that a server of ours hands out.

    It loads and sends nothing but from and to that server, runs the scripts that lie there, and is in no other's frame.
    Elements may have a `style` of their own, as cells of a map and our drawings do.
    """
    parts = [
        "default-src 'none'",
        "img-src 'self' data:",
        "media-src 'self'",
        "style-src 'self'",
        "style-src-attr 'unsafe-inline'",
        "script-src 'self'",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'self'",
        "frame-ancestors 'none'",
    ]
    return "; ".join(parts)


def _hashes(texts: Iterable[str]) -> str:
    """The sources of a policy that let in just these texts."""
    found = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in dict.fromkeys(texts)]
    return " ".join(f"'sha256-{one}'" for one in found) or "'none'"
