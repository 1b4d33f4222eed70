"""What docstrings, comments and pages name is there: nobody is sent to a module that has moved."""

from __future__ import annotations

from tests.names import PACKAGE, ROOT, leads_somewhere, modules, names_in, pages, paths_in, prose

_NO_MODULES = {"coopera.methods"}  # the group of entry points under which other packages name their methods


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
        for file in paths_in(text)
        if not (ROOT / file).exists()
    ]
    assert lost == []


def test_every_room_says_in_a_sentence_or_more_what_lives_there() -> None:
    rooms = [path for path in modules() if path.name == "__init__.py" and ROOT / "tests" not in path.parents]
    assert PACKAGE / "__init__.py" in rooms
    assert [str(path) for path in rooms if not next(prose(path), (0, ""))[1].strip()] == []
