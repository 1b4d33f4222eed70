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
def browsing(*flags: str, bad: frozenset[str] = frozenset({"error", "warning"}), **how: Any) -> Iterator[Watched]:
    """A page of a browser; after the test it must have had no error and asked nothing of another machine.

    `flags` are the browser's, `bad` what it must not say on its console, `how` is for the page.
    """
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - it may not be there

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *flags])
        page = browser.new_page(**{"viewport": {"width": 1280, "height": 900}, **how})
        watched = Watched(page)
        page.set_default_timeout(60_000)
        page.on("console", lambda said: said.type in bad and watched.complaints.append(said.text))
        page.on("pageerror", lambda error: watched.complaints.append(str(error)))
        page.on("request", lambda asked: _is_elsewhere(asked.url) and watched.elsewhere.append(asked.url))
        try:
            yield watched
        finally:
            browser.close()
        assert watched.complaints == []
        assert watched.elsewhere == []


class Browser:
    """One browser; each page has a context, so cookies and storage, of its own unless it is given one."""

    def __init__(self, chromium: Any) -> None:
        self._chromium = chromium
        self.errors: list[str] = []
        self.left: list[str] = []

    def context(self, width: int = 1280, height: int = 900) -> Any:
        return self._chromium.new_context(viewport={"width": width, "height": height}, locale="en-GB")

    def page(self, address: str, context: Any = None, *, width: int = 1280, height: int = 900) -> Any:
        page = (context or self.context(width, height)).new_page()
        page.on("console", lambda told: self.errors.append(told.text) if told.type == "error" else None)
        page.on("pageerror", lambda err: self.errors.append(str(err)))
        page.on("request", lambda sent: _is_elsewhere(sent.url) and self.left.append(sent.url))
        page.goto(address)
        return page


@contextmanager
def browser() -> Iterator[Browser]:
    """A browser for several pages at once."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - it may not be there

    with sync_playwright() as driver:
        # a container's root may not make the sandbox, and shared memory may be small there
        found = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage"])
        try:
            yield Browser(found)
        finally:
            found.close()


def _is_elsewhere(url: str) -> bool:
    parts = urlsplit(url)
    return parts.scheme not in {"data", "blob", "file", "about"} and parts.hostname not in {"127.0.0.1", "localhost"}
