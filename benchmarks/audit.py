"""Known weaknesses of pinned packages, from a stored list: `python -m benchmarks.audit constraints.txt all.zip`.

The list is OSV's for PyPI, a zip of one JSON file per advisory; it says itself which versions are affected. Ends with 1
where a pinned version is.
"""

from __future__ import annotations

import json
import re
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple


class Weakness(NamedTuple):
    """An advisory that names a pinned version."""

    package: str
    version: str
    advisory: str
    summary: str


def main() -> int:
    """Print what is known; 1 where there is something."""
    pinned, advisories = pins(Path(sys.argv[1]).read_text(encoding="utf-8")), Path(sys.argv[2])
    found = sorted(set(weaknesses(pinned, advisories)))
    for one in found:
        sys.stdout.write(f"{one.package} {one.version}: {one.advisory} {one.summary}\n")
    sys.stdout.write(f"{len(pinned)} packages, {len(found)} known weaknesses\n")
    return bool(found)


def pins(text: str) -> dict[str, str]:
    """Versions by package, of lines such as "jinja2==3.1.6"."""
    lines = (line.partition("#")[0].partition(";")[0].strip() for line in text.splitlines())
    pairs = (line.split("==") for line in lines if "==" in line)
    return {_plain(name): version.partition("+")[0] for name, version in pairs}


def weaknesses(pinned: dict[str, str], advisories: Path) -> Iterator[Weakness]:
    """The advisories of a stored list that name a pinned version."""
    with zipfile.ZipFile(advisories) as archive:
        for name in archive.namelist():
            data = json.loads(archive.read(name))
            for affected in data.get("affected", []) if "withdrawn" not in data else []:
                package = _plain(affected.get("package", {}).get("name", ""))
                if pinned.get(package) in affected.get("versions", []):
                    yield Weakness(package, pinned[package], data["id"], data.get("summary", ""))


def _plain(name: str) -> str:
    """A package's name as the index compares names."""
    return re.sub(r"[-_.]+", "-", name.strip()).lower()


if __name__ == "__main__":
    sys.exit(main())
