"""Rules of the house that no linter knows, for each module and for the folders as rooms.

A module has at most 400 lines and compares with no method's name. A folder holds at most some twenty modules. Neither
modules nor folders import each other in a circle, imports for the type checker included.
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from coopera.evaluation import METHODS

ROOT = Path(__file__).parents[1]
ROOMS = ("core", "prompts", "memory", "models", "simulation", "graphs", "evaluation", "coopera")
LINES = 400
MODULES = 21
Arrows = Mapping[str, set[str]]


def main() -> int:
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(_modules((*ROOMS, "tests")))}
    ours = {path: tree for path, tree in trees.items() if path.relative_to(ROOT).parts[0] != "tests"}
    problems = [*_long(trees), *_crowded(trees), *_methods_named(ours), *_circles(ours)]
    sys.stdout.write("".join(f"{problem}\n" for problem in problems))
    return bool(problems)


def _modules(rooms: Iterable[str]) -> Iterator[Path]:
    """All modules, each once: the links of coopera/ are left out."""
    for room in rooms:
        yield from (path for path in (ROOT / room).rglob("*.py") if path.resolve() == path)


def _long(paths: Iterable[Path]) -> Iterator[str]:
    for path in paths:
        lines = path.read_text(encoding="utf-8").count("\n")
        if lines > LINES:
            yield f"{path.relative_to(ROOT)}: {lines} lines, at most {LINES}"


def _crowded(paths: Iterable[Path]) -> Iterator[str]:
    for folder, count in Counter(path.parent for path in paths).items():
        if count > MODULES:
            yield f"{folder.relative_to(ROOT)}: {count} modules, at most {MODULES}; it wants rooms"


def _methods_named(trees: Mapping[Path, ast.Module]) -> Iterator[str]:
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Compare):
                names = {getattr(side, "value", None) for side in (node.left, *node.comparators)}
                if names & set(METHODS):
                    yield f"{path.relative_to(ROOT)}:{node.lineno}: compares with a method's name"


def _circles(trees: Mapping[Path, ast.Module]) -> Iterator[str]:
    known = {_name(path): path for path in trees if path.name != "__init__.py"}
    modules = {name: set(_imported(trees[path], known)) - {name} for name, path in known.items()}
    folders: dict[str, set[str]] = {}
    for name, targets in modules.items():
        here = name.rpartition(".")[0]
        folders.setdefault(here, set()).update({one.rpartition(".")[0] for one in targets} - {here})
    for what, arrows in (("modules", modules), ("folders", folders)):
        try:
            TopologicalSorter(arrows).prepare()
        except CycleError as err:
            yield f"a circle of {what}: {' <- '.join(err.args[1])}"


def _imported(tree: ast.Module, known: Mapping[str, Path]) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                yield from (name for name in (node.module, f"{node.module}.{alias.name}") if name in known)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)


def _name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts if parts[0] == "coopera" else ("coopera", *parts))


if __name__ == "__main__":
    sys.exit(main())
