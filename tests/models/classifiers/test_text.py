from __future__ import annotations

import subprocess
import sys

from coopera.core.hour import Example
from coopera.core.people import BigFive, PersonId
from coopera.models.classifiers.text import Inputs, lesson, sentence_pair, sentences


def at(day: int, hour: int, person: str = "ann", **fields: object) -> Example:
    return Example(person=PersonId(person), day=day, hour=hour, candidate=f"{person} {day} {hour}", **fields)  # type: ignore[arg-type]


def test_a_pair_says_when_who_after_what_and_then_the_candidate() -> None:
    example = at(
        0,
        15,
        intention="drink tea",
        profile="Reads a lot.",
        big_five=BigFive(openness=4.5, neuroticism=1.5),
        intentions=["cook"],
        tasks=["bring the pot"],
    )
    first, second = sentence_pair(example)
    assert first == "3 pm. Earlier: cook. Reads a lot. high openness, low neuroticism. With: bring the pot."
    assert second == "ann 0 15, to drink tea"


def test_a_pair_of_what_nothing_is_known_about_says_only_when() -> None:
    assert sentence_pair(at(0, 9)) == ("9 am.", "ann 0 9")


def test_a_lesson_is_in_order_of_time_and_leaves_the_unanswered_out() -> None:
    taught = lesson([at(1, 9, label=True), at(0, 12, label=False), at(0, 9)], Inputs())
    assert taught.hours == [12, 33]
    assert taught.labels == [False, True]
    assert taught.teaches


def test_each_persons_newest_picture_stands_for_all_their_examples() -> None:
    taught = lesson(
        [
            at(0, 9, label=True),
            at(1, 9, label=True, profile="old"),
            at(2, 9, label=True, profile="new", big_five=BigFive()),
            at(2, 10, "bob", label=True),
        ],
        Inputs(),
    )
    assert [e.profile for e in taught.examples] == ["new", "new", "new", ""]
    assert [e.big_five is None for e in taught.examples] == [False, False, False, True]


def test_of_too_many_examples_each_person_keeps_the_newest() -> None:
    ann = [at(day, 9, label=True) for day in range(10)]
    bob = [at(day, 10, "bob", label=False) for day in range(2)]
    taught = lesson([*ann, *bob], Inputs(), most=5)
    assert [e.candidate for e in taught.examples] == ["bob 0 10", "bob 1 10", "ann 7 9", "ann 8 9", "ann 9 9"]


def test_hidden_hours_still_keep_days_apart_in_a_lesson() -> None:
    taught = lesson([at(0, 9, label=True), at(1, 20, label=False)], Inputs(time=False))
    assert taught.hours == [9, 44]
    assert len({e.hour for e in taught.examples}) == 1


def test_a_profile_is_split_into_its_sentences() -> None:
    assert sentences(" Likes tea! Reads 2.5 books a week.  ") == ["Likes tea!", "Reads 2.5 books a week."]
    assert sentences("") == []


def test_the_package_can_be_imported_without_anything_heavy() -> None:
    code = "import coopera.models.classifiers, sys; print({'torch', 'sklearn', 'scipy', 'peft'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_the_robots_order_is_said_where_it_is_known_and_may_be_seen() -> None:
    example = at(0, 9, rank=0)
    assert sentence_pair(example)[0] == "9 am. Guess 1."
    assert sentence_pair(Inputs(rank=False).show(example))[0] == "9 am."
