from __future__ import annotations

import inspect

import pytest

from coopera.checks.method import check_method
from coopera.core.errors import ConformanceError
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import HandOver
from coopera.evaluation import METHODS
from coopera.graphs import Method, RobotView

slow = pytest.mark.slow  # each lives a few hours in the shipped home


class Forgetful:
    """Learns while it helps, which an interrupted hour undoes."""

    def __init__(self) -> None:
        self.helped = 0

    def help(self, view: RobotView) -> Proposal:
        self.helped += 1
        act = HandOver(object=f"cup {self.helped}")
        usual = IntentionCandidate(text="Something", accepted=True)
        return Proposal(
            intentions=[usual], tasks=[TaskCandidate(intention=usual.text, thought="", act=act, accepted=True)]
        )

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, int]:
        return {"hours": len(account.hours)}


class Fragile(Forgetful):
    """Cannot stand an evening of a day without hours."""

    def help(self, view: RobotView) -> Proposal:
        return Proposal()

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, int]:
        return {"first": min(hour.hour for hour in account.hours)}


@slow
@pytest.mark.parametrize("name", [name for name, one in METHODS.items() if one.robot and not one.swapped])  # two people
@pytest.mark.parametrize("collab", [1, 2])
def test_every_method_keeps_to_the_rules(name: str, collab: int) -> None:
    check_method(METHODS[name], collabs=[collab], hours=2)  # type: ignore[list-item]


@slow
def test_a_robot_that_learns_while_it_helps_is_found_out() -> None:
    with pytest.raises(ConformanceError, match="a run that was stopped and went on must equal one that was not"):
        check_method(Method(name="forgetful", own=Forgetful), collabs=[2], hours=1)


@slow
def test_a_robot_that_fails_on_an_odd_evening_is_found_out() -> None:
    with pytest.raises(ConformanceError, match="an evening without any hour must be learned from without harm"):
        check_method(Method(name="fragile", own=Fragile), collabs=[2], hours=1)


class Peeker(Forgetful):
    """Looks up what the person wants, in the hour that is being lived."""

    def help(self, view: RobotView) -> Proposal:
        frame = inspect.currentframe()
        while frame is not None and "human" not in (frame.f_locals.get("state") or {}):
            frame = frame.f_back
        assert frame is not None
        wanted = IntentionCandidate(text=frame.f_locals["state"]["human"].intention.text, accepted=True)
        return Proposal(intentions=[wanted])


def test_a_robot_that_peeks_at_what_it_must_infer_is_found_out() -> None:
    with pytest.raises(ConformanceError, match="method peeker, .*: in two lives that look alike, what it did at"):
        check_method(Method(name="peeker", own=Peeker), collabs=[2], hours=1)
