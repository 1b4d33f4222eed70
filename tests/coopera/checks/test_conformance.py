from __future__ import annotations

import pytest

from coopera.checks.method import ConformanceError, check_method
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import HandOver
from coopera.evaluation import METHODS
from coopera.graphs import Method, RobotView

pytestmark = pytest.mark.slow  # each lives a few hours in the shipped home


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


@pytest.mark.parametrize("name", [name for name, method in METHODS.items() if method.robot])
@pytest.mark.parametrize("collab", [1, 2])
def test_every_method_keeps_to_the_rules(name: str, collab: int) -> None:
    check_method(METHODS[name], collabs=[collab], hours=2)  # type: ignore[list-item]


def test_a_robot_that_learns_while_it_helps_is_found_out() -> None:
    with pytest.raises(ConformanceError, match="a run that was stopped and went on must equal one that was not"):
        check_method(Method(name="forgetful", own=Forgetful), collabs=[2], hours=1)


def test_a_robot_that_fails_on_an_odd_evening_is_found_out() -> None:
    with pytest.raises(ConformanceError, match="an evening without any hour must be learned from without harm"):
        check_method(Method(name="fragile", own=Fragile), collabs=[2], hours=1)
