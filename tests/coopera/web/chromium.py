"""A real browser without a window, for the tests of pages: it notes errors, and requests that leave the machine."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

PATHS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


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
        home = "/".join(address.split("/")[:3])
        page.on("console", lambda told: self.errors.append(told.text) if told.type == "error" else None)
        page.on("pageerror", lambda err: self.errors.append(str(err)))
        page.on("request", lambda sent: None if sent.url.startswith(home) else self.left.append(sent.url))
        page.goto(address)
        return page


@contextmanager
def browser() -> Iterator[Browser]:
    """The browser of this machine; the test is skipped where there is none."""
    path = next((found for name in PATHS if (found := shutil.which(name))), None)
    if path is None:
        pytest.skip(f"no browser is installed here: none of {', '.join(PATHS)} is found")
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="playwright drives the browser, and is not installed"
    )
    with playwright.sync_playwright() as driver:
        # a container's root may not make the sandbox, and shared memory may be small there
        found = driver.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-dev-shm-usage"])
        try:
            yield Browser(found)
        finally:
            found.close()
