from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.humans import find
from coopera.persona_import import COLUMNS, import_people, person_id, read_rows
from core.errors import ConfigError, ModelOutputError
from core.hour import ModelCall
from core.people import BigFive
from core.protocols import Reply, Role
from core.randomness import Address
from core.replies import BigFiveReply, ProfileReply

HEAD = b"user 1 personas,user 2 personas,Best Generated Conversation\r\n"
ROWS = [("I bake.\nI have a dog.", "I sing.", "User 1: Hi!\nUser 2: Hello, you."), ("I knit.", "I run.", "User 1: Yo")]


class FakeAsk:
    """Extends a profile by a word; fails on a profile that says so and on any other prompt."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, Address]] = []

    def __call__(
        self,
        prompt: str,
        reply: type[Reply],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Reply:
        self.asked.append((prompt, at))
        if prompt == "persona/profile" and reply is ProfileReply:
            if "FAIL" in variables["profile_1"]:
                raise ModelOutputError(prompt, "…", "it is no JSON")
            assert set(variables) == {"profile_1", "profile_2", "conversation"}
            return reply.model_validate({"profile": f"Extended: {variables['profile_1']}"})
        if prompt == "persona/big_five" and reply is BigFiveReply:
            assert variables["profile"].startswith("Extended: ")
            return reply.model_validate({"big_five": {"openness": 4.5}})
        raise AssertionError(prompt)

    def sees(self, role: Role) -> bool:
        return False

    def take_calls(self) -> list[ModelCall]:
        return []


def published(path: Path, rows: Sequence[Sequence[str]] = ROWS, *, bom: bool = False, between: str = "") -> Path:
    """Write rows as the corpus has them: CRLF, quotes, line breaks within fields."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow(row)
        out.write(between)
    path.write_bytes(out.getvalue().encode("utf-8-sig" if bom else "utf-8"))
    return path


@pytest.mark.parametrize("bom", [False, True])
@pytest.mark.parametrize("between", ["", "\r\n", ",,\r\n", " , ,\r\n"])
def test_the_corpus_is_read_with_bom_quotes_and_blank_rows(tmp_path: Path, bom: bool, between: str) -> None:
    rows = read_rows(published(tmp_path / "x.csv", bom=bom, between=between))
    assert [tuple(row[2:]) for row in rows] == ROWS
    assert [row.number for row in rows] == [1, 2]


TEXT = st.text(st.characters(exclude_categories=["Cs", "Cc"], include_characters="\n,\"'"), min_size=1)


@given(st.lists(st.tuples(TEXT, TEXT, TEXT).filter(lambda row: row[0].strip()), min_size=1, max_size=5))
def test_any_text_comes_back_as_it_was_written(tmp_path_factory: pytest.TempPathFactory, rows: list[Any]) -> None:
    path = published(tmp_path_factory.mktemp("csv") / "x.csv", rows)
    assert [tuple(row[2:]) for row in read_rows(path)] == [tuple(cell.strip() for cell in row) for row in rows]


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"user 1 personas,Best Generated Conversation\r\na,b\r\n", "line 1: the column 'user 2 personas' is missing"),
        (b"", "line 1: the column 'user 1 personas' is missing; the header has an empty line"),
        (HEAD, "no row with a persona"),
        (
            HEAD + b"a,b\r\n",
            "line 2 (row 1): expected 3 columns",
        ),
        (HEAD + b" ,b,c\r\n", "must hold a persona"),
        (HEAD + b"a,b,c\r\nd\xe9j\xe0,b,c\r\n", "line 3"),
        (
            HEAD + b'"a,b,c\r\n',
            "(row 1): this is not valid CSV",
        ),
    ],
)
def test_a_broken_file_is_one_sentence_naming_file_and_row(tmp_path: Path, data: bytes, sentence: str) -> None:
    path = tmp_path / "broken.csv"
    path.write_bytes(data)
    with pytest.raises(ConfigError) as err:
        read_rows(path)
    assert sentence in str(err.value)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)


def test_each_row_becomes_a_person_through_the_one_door(tmp_path: Path) -> None:
    path = published(tmp_path / "synthetic_persona_chat_valid.csv")
    ask = FakeAsk()
    done = import_people(path, ask, tmp_path / "humans")
    assert done.written == ["spc-valid-0001", "spc-valid-0002"]
    first = find("spc-valid-0001", tmp_path)
    assert first.profile == "Extended: I bake.\nI have a dog."
    assert first.big_five == BigFive(openness=4.5)
    assert first.source == "synthetic_persona_chat_valid.csv, row 1"
    assert [prompt for prompt, _ in ask.asked] == ["persona/profile", "persona/big_five"] * 2
    assert {at.person for _, at in ask.asked} == {"spc-valid-0001", "spc-valid-0002"}


def test_a_second_import_keeps_those_who_are_there_unless_forced(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv")
    import_people(path, FakeAsk(), tmp_path / "humans", limit=1)
    edited = tmp_path / "humans" / "x-0001.yaml"
    edited.write_text(edited.read_text().replace("Extended", "Edited"))
    again = import_people(path, FakeAsk(), tmp_path / "humans")
    assert again == (["x-0002"], ["x-0001"])
    assert "Edited" in edited.read_text()
    assert import_people(path, FakeAsk(), tmp_path / "humans", force=True).kept == []
    assert "Edited" not in edited.read_text()


def test_a_model_that_fails_leaves_those_before_and_no_half_file(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv", [ROWS[0], ("FAIL", "b", "c")])
    with pytest.raises(ModelOutputError):
        import_people(path, FakeAsk(), tmp_path / "humans")
    assert [file.name for file in (tmp_path / "humans").iterdir()] == ["x-0001.yaml"]


def test_a_name_that_the_persona_says_is_taken_over(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv", [("I sing. My name is Rosa.", "b", "c")])
    import_people(path, FakeAsk(), tmp_path)
    assert "name: Rosa" in (tmp_path / "x-0001.yaml").read_text()


@pytest.mark.parametrize(
    ("file", "person"),
    [
        ("synthetic_persona_chat_valid.csv", "spc-valid-0007"),
        ("Synthetic-Persona-Chat_train.csv", "spc-train-0007"),
        ("New-Synthetic-Persona-Chat_test.csv", "spc-test-0007"),
        ("my people!.csv", "my-people-0007"),
        ("é.csv", "person-0007"),
    ],
)
def test_ids_come_from_the_file_name_and_the_row(file: str, person: str) -> None:
    assert person_id(Path(file), 7) == person
