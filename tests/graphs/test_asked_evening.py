"""What a real person is asked in the evening: what says the same once, not too much, and every answer in its place."""

from __future__ import annotations

import numpy as np
import pytest
from langchain_core.embeddings import Embeddings

from coopera.core.clock import Clock
from coopera.core.hour import Found, HumanHour, Intention, IntentionCandidate, Observation, RobotHour, TaskCandidate
from coopera.core.household import FreeMotion, HandOver
from coopera.graphs.players.evening import SPARED, Lived, evening_of, quotas
from coopera.graphs.players.real_person import Verdict

ADDRESS = (0, "mara", 0)


class ByFirstWord(Embeddings):
    """Texts with the same first word say the same."""

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [np.random.default_rng(sum(map(ord, text.split()[0]))).normal(size=64).tolist() for text in texts]

    def embed_query(self, text: str) -> list[float]:
        return self.embed_documents([text])[0]


def hour(clock_hour: int, guesses: list[str], things: list[str]) -> Lived:
    human = HumanHour(
        recalled=[],
        intention=Intention(text=f"Live at {clock_hour}"),
        found=Found(fixed={}, movable={}, motions=[]),
        tasks=[],
        reflections=[],
    )
    tasks = [TaskCandidate(intention=guesses[0], thought="", act=HandOver(object=thing)) for thing in things]
    robot = RobotHour(
        observation=Observation(), intentions=[IntentionCandidate(text=text) for text in guesses], tasks=tasks
    )
    return Lived(Clock(day=0, hour=clock_hour), human, robot)


def ask(*hours: Lived, most: int = 60) -> tuple[list[str], list[list[int]]]:
    found = evening_of(hours, ByFirstWord(), most=most, address=ADDRESS)
    return found.items, found.drawn


def test_what_says_nearly_the_same_in_an_hour_is_asked_once_and_the_answer_counts_for_all() -> None:
    lived = hour(9, ["Read a book", "Cook a meal", "Read in a novel"], ["mug", "mug_2", "spoon"])
    asked = evening_of([lived], ByFirstWord(), most=60, address=ADDRESS)
    assert asked.items == ["Read a book", "Cook a meal", "bring the mug", "bring the spoon"]
    assert asked.cards[0].entries[0].also == ["Read in a novel"]
    assert asked.of == 6
    said = [Verdict(True, "yes I did"), Verdict(False, ""), Verdict(False, "no mug"), Verdict(True, "")]
    (verdicts,) = asked.handed_out(said)
    assert [one.yes for one in verdicts] == [True, False, True, False, False, True]
    assert verdicts[0].answered_as == ""
    assert (verdicts[2].answered_as, verdicts[2].reason) == ("Read a book", "yes I did")


def test_the_same_offer_in_two_hours_is_two_questions() -> None:
    assert ask(hour(9, ["Read"], ["mug"]), hour(10, ["Read"], ["mug"]))[0] == ["Read", "bring the mug"] * 2


def test_tasks_with_other_things_are_never_the_same_however_they_are_worded() -> None:
    def sits(target: str, words: str) -> TaskCandidate:
        act = FreeMotion(target_id=1, target=target, in_hand="novel", motion=words)
        return TaskCandidate(intention="Read", thought="", act=act)

    lived = hour(9, ["Read"], [])
    tasks = [sits("sofa_1", "sit down"), sits("sofa_2", "sit and rest"), sits("bed_1", "sit down")]
    lived = lived._replace(robot=lived.robot.model_copy(update={"tasks": tasks}))
    assert len(ask(lived)[0]) == 3  # the intention, one sofa, the bed


def test_of_too_many_questions_each_hour_has_its_share_drawn_by_the_seed() -> None:
    hours = [hour(9 + n, [f"{word} it" for word in "abcdefgh"], [f"thing{i}" for i in range(12)]) for n in range(4)]
    items, drawn = ask(*hours, most=10)
    assert len(items) == 10
    assert [len(one) for one in drawn] == [3, 3, 2, 2]
    assert ask(*hours, most=10) == (items, drawn)
    assert evening_of(hours, ByFirstWord(), most=10, address=(1, "mara", 0)).drawn != drawn
    asked = evening_of(hours, ByFirstWord(), most=10, address=ADDRESS)
    verdicts = asked.handed_out([Verdict(True, "")] * 10)
    assert sum(one.asked for of_hour in verdicts for one in of_hour) == 10
    spared = next(one for one in verdicts[0] if not one.asked)
    assert (spared.yes, spared.reason) == (None, SPARED)


@pytest.mark.parametrize(
    ("sizes", "most", "shares"),
    [
        ([5, 5], 60, [5, 5]),
        ([9, 1, 9], 7, [3, 1, 3]),
        ([0, 4], 2, [0, 2]),
        ([3, 3, 3], 2, [1, 1, 0]),
        ([], 5, []),
    ],
)
def test_shares_are_as_equal_as_can_be(sizes: list[int], most: int, shares: list[int]) -> None:
    assert quotas(sizes, most) == shares
