"""What docstrings, comments and pages name is there: nobody is sent to a module that has moved."""

from __future__ import annotations

import ast
import re

from tests.names import PACKAGE, ROOT, leads_somewhere, modules, names_in, pages, paths_in, prose

# the groups of entry points under which other packages name their values
_NO_MODULES = {"coopera.methods", "coopera.measures", "coopera.classifiers"}


# files that a page tells its reader to write
_TO_WRITE = {"models/classifiers/shipped/one_sided.py", "evaluation/measures/boldness.py"}


def test_every_name_of_ours_in_prose_leads_somewhere() -> None:
    named = {
        (name, f"{path.relative_to(ROOT)}:{line}")
        for path in (*modules(), *pages())
        for line, text in prose(path)
        for name in names_in(text) - _NO_MODULES
    }
    lost = {name for name in {name for name, _ in named} if not leads_somewhere(name)}
    assert sorted(f"{where} names {name}" for name, where in named if name in lost) == []


def test_every_file_of_ours_in_prose_is_there() -> None:
    lost = [
        f"{path.relative_to(ROOT)}:{line} names {file}"
        for path in (*modules(), *pages())
        for line, text in prose(path)
        for file in paths_in(text) - _TO_WRITE
        if not (ROOT / file).exists()
    ]
    assert lost == []


def test_every_room_says_in_two_sentences_what_lives_there() -> None:
    rooms = [path for path in modules() if path.name == "__init__.py" and ROOT / "tests" not in path.parents]
    assert PACKAGE / "__init__.py" in rooms
    says = {
        str(path.relative_to(ROOT)): ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) for path in rooms
    }
    assert [room for room, text in says.items() if len(re.findall(r"[.?](?=\s|$)", text or "")) < 2] == []


def test_the_index_lists_every_page() -> None:
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\]\(([\w./-]+\.md)\)", index))
    there = {page.relative_to(ROOT / "docs").as_posix() for page in (ROOT / "docs").rglob("*.md")}
    written = {page for page in there if re.fullmatch(r"results/.+/tables.md", page)}  # by a benchmark
    assert linked - {"../README.md", "../CONTRIBUTING.md", "../CHANGELOG.md"} == there - written - {"README.md"}
