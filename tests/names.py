"""Names of our own in prose: where they stand in docstrings, comments and pages, and what they lead to."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).parents[1]
ROOMS = ("core", "prompts", "memory", "models", "simulation", "graphs", "evaluation")
PACKAGE = ROOT / "coopera"

_DOTTED = re.compile(r"(?<![\w./\"-])coopera(?:\.[A-Za-z_]\w*)+")
_OF_A_ROOM = re.compile(rf"`((?:{'|'.join(ROOMS)})(?:\.[A-Za-z_]\w*)+)[`(\[ ]")
_PATH = re.compile(
    rf"(?<![\w./-])((?:{'|'.join((*ROOMS, 'coopera', 'tests', 'benchmarks', 'examples', 'docs'))})(?:/[\w-]+)*/[\w-]+"
    r"\.(?:py|md|yaml|json|urdf|j2))\b"
)
_FILES = ("py", "md", "yaml", "yml", "json", "csv", "toml", "cfg", "sqlite", "html")


def pages() -> list[Path]:
    """The Markdown pages that people read, without the prompts and what a benchmark wrote."""
    return sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])


def modules() -> list[Path]:
    """Our Python files, each once."""
    tops = (*ROOMS, "benchmarks", "examples", "tests")
    ours = [path for top in tops for path in (ROOT / top).rglob("*.py")]
    own = [
        path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).parts[0] not in ROOMS
    ]  # links to the rooms
    return sorted([*ours, *own])


def prose(path: Path) -> Iterator[tuple[int, str]]:
    """Each docstring and comment of a module, and each line of a page, with the line it begins in."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        yield from enumerate(text.splitlines(), 1)
        return
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.lineno, node.value.value
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


def names_in(text: str) -> set[str]:
    """The dotted names of ours in a text, all with `coopera.` before them."""
    short = {f"coopera.{name}" for name in _OF_A_ROOM.findall(text) if name.rpartition(".")[2] not in _FILES}
    return {*_DOTTED.findall(text), *short}


def paths_in(text: str) -> set[str]:
    """The files of ours that a text names."""
    return set(_PATH.findall(text))


def leads_somewhere(name: str) -> bool:
    """Whether a dotted name is a module of ours, or something that can be reached from one."""
    parts = name.split(".")
    for size in range(len(parts), 0, -1):
        try:
            if find_spec(".".join(parts[:size])) is None:
                continue
        except ModuleNotFoundError:
            continue
        return size == len(parts) or _has(import_module(".".join(parts[:size])), parts[size:])
    return False


def _has(thing: object, attributes: list[str]) -> bool:
    for name in attributes:
        known = {*getattr(thing, "model_fields", ()), *getattr(thing, "__annotations__", ())}
        if not hasattr(thing, name):
            return name in known and name == attributes[-1]
        thing = getattr(thing, name)
    return True
