from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coopera.core.errors import ConfigError, ModelCallError, ModelOutputError
from coopera.core.hour import ModelCall
from coopera.core.people import BigFive, PersonId
from coopera.core.protocols import Reply, Role
from coopera.core.randomness import Address
from coopera.core.replies import BigFiveReply, BigFiveTestReply, ProfileReply
from coopera.people.import_chat import COLUMNS, Imported, Maker, import_people, person_id, read_rows
from coopera.people.shipped import find

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
            assert set(variables) == {"name", "profile_1", "profile_2", "conversation"}
            return reply.model_validate({"profile": f"Extended: {variables['profile_1']}"})
        assert variables["profile"].startswith("Extended: ")
        if prompt == "persona/big_five" and reply is BigFiveReply:
            return reply.model_validate({"big_five": {"openness": 4.5}})
        if prompt == "persona/big_five_test" and reply is BigFiveTestReply:
            assert len(variables["statements"]) == 50
            return reply.model_validate({"answers": [3 + (at.draw == 4)] * 50})
        raise AssertionError(prompt)

    def sees(self, role: Role) -> bool:
        return False

    def instant(self, role: Any) -> bool:
        return True

    def take_calls(self, at: Any = None) -> list[ModelCall]:
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
        (HEAD + b"a" * 10_000_000 + b",b,c\r\n", "field larger than field limit"),
        (HEAD + b"a" * 50_000 + b",b,c\r\n", "a persona has at most 20000 characters, and this one has 50000"),
        (HEAD + b"a,b,c\r\nd\xe9j\xe0,b,c\r\n", "line 3"),
        (
            HEAD + b'"a,b,c\r\n',
            "line 2: this is not valid CSV",
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


def make(path: Path, folder: Path, ask: FakeAsk | None = None, **options: Any) -> Imported:
    prompts = dict.fromkeys(("persona/profile", "persona/big_five", "persona/big_five_test"), "sha")
    return import_people(path, Maker(ask or FakeAsk(), "fake", prompts), folder, **options)


def test_each_row_becomes_a_person_through_the_one_door(tmp_path: Path) -> None:
    path = published(tmp_path / "synthetic_persona_chat_valid.csv")
    ask = FakeAsk()
    done = make(path, tmp_path / "humans", ask)
    assert done.written == ["spc-valid-0001", "spc-valid-0002"]
    first = find("spc-valid-0001", tmp_path)
    assert first.profile == "Extended: I bake.\nI have a dog."
    assert first.notes == "I bake. I have a dog."
    assert first.source == "synthetic_persona_chat_valid.csv, row 1"
    asked = [(prompt, at.draw) for prompt, at in ask.asked if at.person == "spc-valid-0001"]
    trials = [(prompt, n) for n in range(5) for prompt in ("persona/big_five", "persona/big_five_test")]
    assert asked == [("persona/profile", 0), *trials]


def test_the_votes_of_five_trials_stand_in_the_persona_file(tmp_path: Path) -> None:
    make(published(tmp_path / "x.csv"), tmp_path / "humans", limit=1)
    person = find("x-0001", tmp_path)
    # per trait 5 direct readings and 5 tests vote: openness 5 x 4.5 against 4 x 3.0 and 1 x 3.4
    assert person.big_five == BigFive(openness=4.5)
    assert person.provenance is not None
    assert (person.provenance.file, person.provenance.row, person.provenance.model) == ("x.csv", 1, "fake")
    assert set(person.provenance.prompts.values()) == {"sha"}
    assert [trial.answers[0] for trial in person.provenance.trials] == [3, 3, 3, 3, 4]


def test_a_second_import_keeps_those_who_are_there_unless_forced(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv")
    make(path, tmp_path / "humans", limit=1)
    edited = tmp_path / "humans" / "x-0001.yaml"
    edited.write_text(edited.read_text().replace("Extended", "Edited"))
    again = make(path, tmp_path / "humans")
    assert again == (["x-0002"], ["x-0001"], {})
    assert "Edited" in edited.read_text()
    assert make(path, tmp_path / "humans", force=True).kept == []
    assert "Edited" not in edited.read_text()


def test_a_row_whose_replies_cannot_be_used_is_passed_over_and_said(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv", [("FAIL", "b", "c"), ROWS[0]])
    told: list[tuple[str, str]] = []
    done = make(path, tmp_path / "humans", on_person=lambda person, what: told.append((person, what)))
    assert done.written == ["x-0002"]
    assert "it is no JSON" in done.failed[PersonId("x-0001")]
    assert sorted(told) == [("x-0001", "failed"), ("x-0002", "written")]
    assert [file.name for file in (tmp_path / "humans").iterdir()] == ["x-0002.yaml"]


def test_an_import_that_is_stopped_goes_on_where_it_was_and_ends_as_one_that_was_not(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv", [(f"I like the number {n}.", "b", "c") for n in range(12)])
    written: list[str] = []

    def impatient(person: str, what: str) -> None:
        written.append(person)
        if len(written) == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make(path, tmp_path / "stopped", workers=3, on_person=impatient)
    left = {file.name for file in (tmp_path / "stopped").iterdir()}
    assert left == {f"{person}.yaml" for person in written}
    again = make(path, tmp_path / "stopped", workers=3)
    assert set(again.kept) == set(written)
    make(path, tmp_path / "whole")
    files = [{file.name: file.read_bytes() for file in (tmp_path / name).iterdir()} for name in ("stopped", "whole")]
    assert files[0] == files[1]
    assert len(files[0]) == 12


def test_a_server_that_is_gone_ends_the_import_at_once(tmp_path: Path) -> None:
    class Gone(FakeAsk):
        def __call__(self, prompt: str, reply: type[Reply], /, **given: Any) -> Reply:
            raise ModelCallError("nobody answers")

    with pytest.raises(ModelCallError):
        make(published(tmp_path / "x.csv"), tmp_path / "humans", Gone())
    assert not list(tmp_path.glob("humans/*.yaml"))


def test_a_name_that_the_persona_says_is_taken_over(tmp_path: Path) -> None:
    path = published(tmp_path / "x.csv", [("I sing. My name is Rosa.", "b", "c")])
    make(path, tmp_path)
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
