"""A headless Chromium for tests of pages: the distribution's own, driven by Playwright, which downloads none."""

from __future__ import annotations

import importlib.util
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
needs_browser = pytest.mark.skipif(
    CHROMIUM is None or importlib.util.find_spec("playwright") is None,
    reason="there is no Chromium (apt-get install chromium), or no Playwright (pip install -e .[dev])",
)


@dataclass
class Watched:
    """A page, with what went wrong on it and what it asked of other machines."""

    page: Any
    complaints: list[str] = field(default_factory=list)
    elsewhere: list[str] = field(default_factory=list)


@contextmanager
def browsing(**how: Any) -> Iterator[Watched]:
    """A page of a browser; after the test it must have had no error and asked nothing of another machine."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - it may not be there

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(**{"viewport": {"width": 1280, "height": 900}, **how})
        watched = Watched(page)
        page.set_default_timeout(60_000)
        page.on("console", lambda said: said.type in {"error", "warning"} and watched.complaints.append(said.text))
        page.on("pageerror", lambda error: watched.complaints.append(str(error)))
        page.on("request", lambda asked: _is_elsewhere(asked.url) and watched.elsewhere.append(asked.url))
        try:
            yield watched
        finally:
            browser.close()
        assert watched.complaints == []
        assert watched.elsewhere == []


def _is_elsewhere(url: str) -> bool:
    parts = urlsplit(url)
    return parts.scheme not in {"data", "blob", "file", "about"} and parts.hostname not in {"127.0.0.1", "localhost"}
