from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from coopera.core.errors import ConfigError, CooperaError, RunError
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import HandOver, PickPlace
from coopera.graphs import Method, RobotView, Services
from coopera.graphs.robots.own_robot import OwnRobot
from tests.graphs.conftest import MakeServices
from tests.graphs.test_day import run_study


class Copycat:
    """Offers what was said to be right before, and a whisk at first."""

    def __init__(self) -> None:
        self.liked: list[str] = []

    def help(self, view: RobotView) -> Proposal:
        things = self.liked or ["whisk", "novel"]
        return Proposal(
            intentions=[IntentionCandidate(text="Do as ever", accepted=False)],
            tasks=[offer(thing, accepted=thing != "novel") for thing in [*things, things[0]]],
        )

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        for hour in account.hours:
            for item in hour.feedback:
                if item.kind == "task" and item.helpful:
                    self.liked.append(item.text.removeprefix("bring the "))
        self.liked = sorted(set(self.liked))
        return {"liked": len(self.liked)}


class Keeper(Copycat):
    """The same, with a file of its own."""

    def save(self, folder: Path) -> None:
        (folder / "liked.txt").write_text("\n".join(self.liked))

    def load(self, folder: Path) -> None:
        text = (folder / "liked.txt").read_text()
        if not text:
            raise CooperaError(f"{folder}: holds nothing")
        self.liked = text.splitlines()


def offer(thing: str, *, accepted: bool | None = True, probability: float | None = None) -> TaskCandidate:
    act = HandOver(object=thing)
    return TaskCandidate(intention="Do as ever", thought="", act=act, accepted=accepted, probability=probability)


def services_with(make_services: MakeServices, robot: type[Copycat], **options: Any) -> Services:
    services = make_services(**options)
    method = Method(name="own", own=robot)
    return replace(services, method=method, own=OwnRobot(robot, services.recorder))


def test_it_helps_learns_and_is_scored_as_ours_is(make_services: MakeServices) -> None:
    services = services_with(make_services, Copycat)
    run_study(services)
    first, second = (services.recorder.read_day(day)[0] for day in (0, 1))
    assert first.robot is not None
    assert second.robot is not None
    assert [(t.act.object, t.accepted) for t in first.robot.tasks] == [("whisk", True), ("novel", False)]  # type: ignore[union-attr]
    assert [o.act.object for o in first.robot.outcomes] == ["whisk"]  # type: ignore[union-attr]
    assert [t.act.object for t in second.robot.tasks] == ["whisk"]  # type: ignore[union-attr]
    assert second.success is not None
    assert second.success.predicate.f1 == 1
    assert services.recorder.evenings[0].learned == {"liked": 1}  # type: ignore[attr-defined]


@pytest.mark.parametrize("robot", [Copycat, Keeper])
def test_another_process_has_it_as_it_was_after_its_last_evening(
    make_services: MakeServices, robot: type[Copycat]
) -> None:
    services = services_with(make_services, robot)
    run_study(services)
    again = OwnRobot(robot, services.recorder)
    again.be_at([0, 1])
    assert again.robot.liked == ["whisk"]  # type: ignore[attr-defined]
    again.be_at([])
    assert again.robot.liked == []  # type: ignore[attr-defined]


def test_where_its_own_file_is_broken_the_evenings_are_taught_again(
    make_services: MakeServices, caplog: pytest.LogCaptureFixture
) -> None:
    services = services_with(make_services, Keeper)
    run_study(services)
    (services.recorder.adapters_folder(1) / "robot" / "liked.txt").write_text("")
    again = OwnRobot(Keeper, services.recorder)
    again.be_at([0, 1])
    assert again.robot.liked == ["whisk"]  # type: ignore[attr-defined]
    assert "its evenings are taught again" in caplog.text


def test_a_damaged_evening_is_named(make_services: MakeServices) -> None:
    services = services_with(make_services, Copycat)
    run_study(services, n=1)
    (services.recorder.adapters_folder(0) / "account.json").write_text("{")
    with pytest.raises(RunError, match=r"account\.json: what the robot was told this evening cannot be read"):
        OwnRobot(Copycat, services.recorder).be_at([0])


def test_what_it_is_told_says_nothing_of_how_it_was_scored(make_services: MakeServices) -> None:
    services = services_with(make_services, Copycat)
    run_study(services, n=1)
    account = DayAccount.model_validate_json((services.recorder.adapters_folder(0) / "account.json").read_text())
    assert [hour.intention for hour in account.hours] == ["Cook a meal"] * 3
    assert {task.correct for hour in account.hours for task in hour.robot.tasks} == {None}
    assert "success" not in account.model_dump_json()


PLACING = TaskCandidate(
    intention="Do as ever",
    thought="",
    act=PickPlace(object="mug_1", object_id=5, receptacle="desk_1", receptacle_id=1),
    accepted=True,
)


@pytest.mark.parametrize(
    ("task", "why"),
    [
        (offer("spoon", accepted=None), '"bring the spoon" must be accepted or not'),
        (offer("spoon", probability=1.5), r'the probability of "bring the spoon" must lie in \[0, 1\], not 1.5'),
        (PLACING, "must be a hand_over in collaboration type 2, not a pick_place"),
    ],
)
def test_a_proposal_that_breaks_a_rule_ends_the_run_with_its_reason(
    make_services: MakeServices, task: TaskCandidate, why: str
) -> None:
    class Rude(Copycat):
        def help(self, view: RobotView) -> Proposal:
            return Proposal(tasks=[task])

    with pytest.raises(RunError, match=f"method own: .*{why}"):
        run_study(services_with(make_services, Rude), n=1)


def test_a_robot_whose_help_takes_anything_but_the_view_is_refused_before_it_helps(make_services: MakeServices) -> None:
    class Older(Copycat):
        def help(self, given: object, ctx: object) -> Proposal:  # type: ignore[override]
            return Proposal()

    wanted = r"Older\.help must take the RobotView alone, help\(self, view\), not \(given: 'object', ctx: 'object'\)"
    with pytest.raises(ConfigError, match=wanted):
        services_with(make_services, Older)
