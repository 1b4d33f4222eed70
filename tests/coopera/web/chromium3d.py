"""A headless Chromium that draws in three dimensions without a graphics card, by its own debugging protocol."""

from __future__ import annotations

import base64
import importlib
import io
import json
import os
import shutil
import subprocess
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Picture: TypeAlias = NDArray[np.uint8]
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
_FLAGS = ("--headless=new", "--no-sandbox", "--no-first-run", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


class Tab:
    """One page: what it asked for, what it complained of, what it looks like."""

    def __init__(self, socket: Any) -> None:
        self._socket, self._count = socket, 0
        self.requests: list[str] = []
        self.complaints: list[str] = []

    def call(self, method: str, **params: Any) -> Any:
        self._count += 1
        self._socket.send(json.dumps({"id": self._count, "method": method, "params": params}))
        while True:
            said = json.loads(self._socket.recv(timeout=60))
            if said.get("id") == self._count:
                return said.get("result", {})
            self._hear(said["method"], said["params"])

    def open(self, file: Path) -> None:
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setLocaleOverride", locale="en-US")
        self.call("Page.navigate", url=file.resolve().as_uri())

    def picture(self) -> Picture:
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))

    def _hear(self, method: str, said: Any) -> None:
        if method == "Network.requestWillBeSent":
            self.requests.append(said["request"]["url"])
        elif method == "Runtime.exceptionThrown" or (
            method == "Runtime.consoleAPICalled" and said["type"] in ("error", "assert")
        ):
            self.complaints.append(json.dumps(said)[:500])
        elif method == "Log.entryAdded" and said["entry"]["level"] == "error":
            self.complaints.append(said["entry"]["text"])


@contextmanager
def tab(folder: Path) -> Iterator[Tab]:
    """A tab of a browser that keeps its things in `folder`."""
    connect = importlib.import_module("websockets.sync.client").connect
    command = [str(CHROMIUM), *_FLAGS, f"--user-data-dir={folder}", "--remote-debugging-port=0", "about:blank"]
    spoken = {**os.environ, "LANG": "en_US.UTF-8", "LC_ALL": "en_US.UTF-8"}
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=spoken) as browser:
        assert browser.stderr is not None
        try:
            address = next(line.split()[-1] for line in browser.stderr if "DevTools listening" in line)
            port = address.split(":")[2].partition("/")[0]
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=30) as listed:
                page = next(one for one in json.load(listed) if one["type"] == "page")
            with connect(page["webSocketDebuggerUrl"], max_size=None) as socket:
                yield Tab(socket)
        finally:
            browser.terminate()
