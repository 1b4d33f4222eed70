from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.core.people import TRAITS, BigFive, Persona
from coopera.people.shipped import SHIPPED, catalogue, find, known_ids, read_persona, shipped_ids, write_persona

GUEST = Persona(id="guest-1", name="Guest", profile="I like tea.", big_five=BigFive(openness=4), source="test")


def test_ten_people_ship_each_in_eight_to_fourteen_sentences() -> None:
    people = [read_persona(SHIPPED / f"{person}.yaml") for person in shipped_ids()]
    assert len(people) == 10
    for person in people:
        sentences = re.split(r"(?<=[.!?]) ", person.profile)
        assert 8 <= len(sentences) <= 14, person.id
        assert sum(bool(re.search(r"\b(I|My|my|me)\b", one)) for one in sentences) == len(sentences), person.id


def test_the_shipped_people_differ_as_much_as_real_people_do() -> None:
    scores = np.array([[getattr(person.big_five, trait) for trait in TRAITS] for person in catalogue(Path("/nowhere"))])
    assert 0.7 <= scores.std(axis=0, ddof=1).mean() <= 1.1


def test_imported_people_are_found_as_the_shipped_ones_are(tmp_path: Path) -> None:
    write_persona(GUEST, tmp_path / "humans")
    assert find("guest-1", tmp_path) == GUEST
    assert known_ids(tmp_path)[-1] == "guest-1"
    assert catalogue(tmp_path)[-1] == GUEST


@pytest.mark.parametrize("person", ["nobody", "../../etc/passwd", "", "Amara", "a" * 100])
def test_an_unknown_id_is_refused_and_reaches_no_file(person: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there is no person"):
        find(person, tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("openness: 4.0", "openness: 6", "big_five.openness must be a number from 1 to 5, not '6'"),
        ("name: Guest", "nick: Guest", "there is no field 'nick'|the field name is missing"),
        ("id: guest-1", "id: guest-2", "id must be the file's name, 'guest-1', not 'guest-2'"),
        ("id: guest-1", "id: Guest 1", "id must be lower-case letters, digits"),
        ("profile: I like tea.", "profile: ''", "profile must be a text of 1 to 20000 characters"),
        (
            "source: test",
            "appearance: {hair: mohawk}",
            "appearance.hair must be bald, ring, cropped, .* or curly, not 'mo",
        ),
        ("source: test", "appearance: {age: 7}", "appearance.age must be a whole number from 16 to 110, not '7'"),
        ("source: test", "appearance: red", "appearance must be a mapping of some of figure, age, .*beard, not 'red'"),
        ("source: test", "appearance: {weight: 3}", r"no field 'appearance.weight' \(known are figure, age, build"),
    ],
)
def test_a_faulty_persona_file_names_file_and_field(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    path = write_persona(GUEST, tmp_path)
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(ConfigError, match=sentence) as err:
        read_persona(path)
    assert str(path) in str(err.value)


def test_a_folder_that_cannot_hold_people_is_a_clear_refusal(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="people cannot be stored here"):
        write_persona(GUEST, tmp_path / "file" / "humans")
