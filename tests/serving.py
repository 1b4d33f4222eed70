"""Starting `tests.server` in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def serving(*options: str) -> Iterator[str]:
    """Run the server while the context lasts; gives its base URL."""
    root = Path(__file__).parents[1]
    command = [sys.executable, "-m", "tests.server", *options]
    environment = {**os.environ, "PYTHONPATH": str(root), "OMP_NUM_THREADS": "1"}
    with subprocess.Popen(
        command, cwd=root, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        try:
            yield f"http://127.0.0.1:{server.stdout.readline().strip()}/v1"
        finally:
            server.kill()


def done(base_url: str) -> list[str]:
    """What the server did, one kind per request."""
    with urllib.request.urlopen(f"{base_url}/done", timeout=10) as answer:
        kinds: list[str] = json.load(answer)
    return kinds
