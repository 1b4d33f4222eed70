"""Rules of the house that no linter knows: no module over 400 lines, and no comparison with a method's name."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

from coopera.evaluation import METHODS

ROOMS = ("core", "prompts", "memory", "models", "simulation", "graphs", "evaluation", "coopera", "tests")
LINES = 400


def main() -> int:
    root = Path(__file__).parents[1]
    problems = []
    for path in sorted(p for room in ROOMS for p in (root / room).rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        lines = text.count("\n")
        if lines > LINES:
            problems.append(f"{path.relative_to(root)}: {lines} lines, at most {LINES}")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Compare) and path.parts[len(root.parts)] != "tests":
                names = {getattr(side, "value", None) for side in (node.left, *node.comparators)}
                if names & set(METHODS):
                    problems.append(f"{path.relative_to(root)}:{node.lineno}: compares with a method's name")
    sys.stdout.write("".join(f"{problem}\n" for problem in problems))
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
