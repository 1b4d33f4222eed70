"""What a robot's language model reads: what was seen, told and only guessed, each in a list of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Observation, RobotHour
from coopera.core.household import Collab, Percept, SceneId
from coopera.core.people import Belief
from coopera.core.protocols import Role
from coopera.core.randomness import Address
from coopera.core.replies import IntentionsReply
from coopera.graphs import RobotContext, build_robot_graph
from coopera.graphs.hour import robot_view
from coopera.graphs.robot import robot_hour
from coopera.graphs.robots.traits import guesses
from coopera.prompts import PromptLibrary
from tests.fakes import MARA, ScriptedAsk, placing, type2_answers
from tests.graphs.conftest import MakeServices

COOKED = [f"stir a pot at the stove with the {thing} in hand" for thing in ("pot", "ladle")]
READ = [f"sit and read at the sofa with the {thing} in hand" for thing in ("novel", "blanket")]
TOLD = {9: ("Cook a meal", COOKED), 11: ("Read quietly", READ)}
PERCEPT = Percept(room="kitchen", near=["stove_1"], motion="dance", in_hand="pot")
SIGHTS: dict[str, tuple[Collab, Observation]] = {
    "type 1": (1, Observation(percept=PERCEPT, first_task="put the mug on the stove")),
    "type 2 with a percept": (2, Observation(percept=PERCEPT)),
    "type 2 with pictures": (2, Observation(frames=["robot-0.webp"])),
}
BEGAN = {1: "put the book on the desk", 2: "In the hall, the person is at the shelf, holding something like a book."}
SAW = "At the stove in the kitchen, the person holds a ladle."


class Reader(ScriptedAsk):
    """Keeps what a language model would read."""

    def __init__(self, saw: str, looks: bool) -> None:
        said, answers = type2_answers(), type2_answers()
        answers["robot/intentions"] = lambda v: {"seen": saw, **said["robot/intentions"](v)}
        answers["robot/tasks_type1"] = lambda v: {"tasks": [placing("book_1", "desk_1", 4, 1)]}
        super().__init__(answers)
        self.looks, self.prompts, self.read = looks, PromptLibrary(), list[tuple[str, str]]()

    def __call__(
        self,
        prompt: str,
        reply: type[Any],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Any:
        self.read.append((prompt, self.prompts.fill(prompt, variables)))
        return super().__call__(prompt, reply, at=at, variables=variables, images=images)

    def sees(self, role: Role) -> bool:
        return self.looks

    def texts(self, prompt: str) -> list[str]:
        return [text for name, text in self.read if name.startswith(prompt)]


def watch(
    make_services: MakeServices, sight: str, *, method: str = "ours", saw: str = SAW
) -> tuple[RobotHour, Reader, RobotContext]:
    """An hour of the second day, at 10; this morning the robot saw one thing and guessed others."""
    collab, seen = SIGHTS[sight]
    ask = Reader(saw, looks=seen.percept is None)
    plan = DayPlan(day=1, episode_day=1, person=MARA.id, scene=SceneId("toy"), hours=[10], collab=collab)
    services = make_services(ask=ask, method=method)
    history, guessed = (services.memories(kept, 0, MARA.id) for kept in ("history", "guesses"))
    for kept in (history, guessed):
        kept.forget_from(0)
    history.extend((now, wanted, done) for now, (wanted, done) in TOLD.items())
    guessed.add("Tidy the home", ["bring the broom"], 33, seen=[BEGAN[collab]])
    view = robot_view(services, plan, Clock(day=1, hour=10), seen, Belief(), MARA.id)
    ctx = RobotContext(view, services.home(plan.scene), services.method, services.learner)
    done = build_robot_graph().invoke({}, context=ctx)
    return robot_hour(done, view.observation), ask, ctx  # type: ignore[arg-type]


def lists(text: str) -> dict[str, str]:
    """The parts of a prompt that say where their lines come from, by that word."""
    found: dict[str, str] = {}
    for part in text.split("\n\n"):
        kind = part.split(":")[0].split()[0]
        if kind in ("Told", "Guessed", "Seen"):
            found[kind] = found.get(kind, "") + part
    return found


@pytest.mark.parametrize("method", ["ours", "paper"])
@pytest.mark.parametrize("sight", SIGHTS)
def test_what_was_seen_told_and_guessed_stands_in_lists_of_its_own(
    make_services: MakeServices, sight: str, method: str
) -> None:
    _, ask, _ = watch(make_services, sight, method=method)
    for text in [*ask.texts("robot/intentions"), *ask.texts("robot/tasks")]:
        known = lists(text)
        assert "9 am, your guess: Tidy the home" in known["Guessed"]
        assert "9 am, your offer: bring the broom" in known["Guessed"]
        assert "Nobody has confirmed them" in known["Guessed"]
        assert "Cook a meal" in known["Told"]
        assert not any(mine in known["Told"] for mine in ("Tidy the home", "broom", "book"))
        assert "day 1" not in known["Guessed"] + known.get("Seen", "")
        assert f"9 am: {BEGAN[SIGHTS[sight][0]]}" in known["Seen"]
        assert "book" not in known["Guessed"]


@pytest.mark.parametrize("sight", SIGHTS)
def test_an_hour_is_remembered_with_what_was_seen_of_its_first_task(make_services: MakeServices, sight: str) -> None:
    hour, _, _ = watch(make_services, sight)
    [past] = guesses([(10, hour)], 24)
    first = {
        "type 1": "put the mug on the stove",
        "type 2 with a percept": PERCEPT.caption(),
        "type 2 with pictures": SAW,
    }[sight]
    marked = past.done(Clock(day=1, hour=12), "guessed")
    assert (marked[0]["text"], marked[0]["source"]) == (first, "seen")
    assert {task["source"] for task in marked[1:]} <= {"guessed"}
    nothing = hour.model_copy(update={"observation": Observation(), "seen": ""})
    assert [past.seen for past in guesses([(10, nothing)], 24)] == [[]]


def test_what_was_told_of_like_intentions_stands_in_the_task_prompt_of_ours(make_services: MakeServices) -> None:
    for method, told in (("ours", True), ("paper", False)):
        _, ask, _ = watch(make_services, "type 2 with pictures", method=method)
        [cooking] = [text for text in ask.texts("robot/tasks") if text.count("up to: Cook a meal")]
        assert (f'when they wanted "Cook a meal": {"; ".join(COOKED)}.' in cooking) is told


@pytest.mark.parametrize(
    ("sight", "done"),
    [
        ("type 1", "Already done: put the mug on the stove"),
        ("type 2 with a percept", "Already done, as far as you saw: In the kitchen, the person seems to dance at the"),
        ("type 2 with pictures", f"Already done, as far as you saw: {SAW}"),
    ],
)
def test_the_task_prompt_says_what_was_seen_and_that_it_is_over(
    make_services: MakeServices, sight: str, done: str
) -> None:
    for method in ("ours", "paper"):
        hour, ask, _ = watch(make_services, sight, method=method)
        assert hour.seen == SAW
        assert all(done in text for text in ask.texts("robot/tasks"))
        held = method == "ours" and sight == "type 2 with a percept"
        assert all(("In hand already, so do not offer it: pot" in text) is held for text in ask.texts("robot/tasks"))


def test_a_first_task_that_is_told_in_words_is_contradicted_by_no_percept(make_services: MakeServices) -> None:
    hour, ask, _ = watch(make_services, "type 1")
    assert not any("dance" in text for _, text in ask.read)
    assert "is at the stove, holding something like a pot" in ask.texts("robot/intentions")[0]
    assert hour.observation.percept == PERCEPT.model_copy(update={"motion": ""})
    assert "dance" in watch(make_services, "type 2 with a percept")[1].texts("robot/intentions")[0]


def test_a_robot_that_looks_at_pictures_recalls_by_what_it_saw_in_them(make_services: MakeServices) -> None:
    queries: list[str] = []
    for sight, saw, expected in (
        ("type 2 with pictures", SAW, ["10 am, Tuesday. ", f"10 am, Tuesday. {SAW}"]),
        ("type 2 with pictures", "", ["10 am, Tuesday. "]),
        ("type 2 with a percept", SAW, [f"10 am, Tuesday. {PERCEPT.caption()}"]),
    ):
        queries.clear()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("coopera.graphs.robot.recall_weeks", lambda view, query: queries.append(query) or [])
            watch(make_services, sight, saw=saw)
        assert queries == expected


def test_what_it_says_it_saw_ranks_the_told_hours(make_services: MakeServices) -> None:
    chances = {}
    for saw in (SAW, "The person sits on the sofa with a blanket."):
        hour, _, _ = watch(make_services, "type 2 with pictures", saw=saw)
        chances[saw] = {one.text: one.evidence["told"] for one in hour.intentions}
    cooking, reading = chances.values()
    assert cooking["Cook a meal"] > cooking["Read quietly"]
    assert reading["Read quietly"] > reading["Cook a meal"]


def test_a_reply_may_say_nothing_of_what_was_seen_and_says_it_first_where_it_does(make_services: MakeServices) -> None:
    assert IntentionsReply.model_validate({"intentions": [{"intention": "Cook a meal"}]}).seen == ""
    assert next(iter(IntentionsReply.model_json_schema()["properties"])) == "seen"
    hour, ask, _ = watch(make_services, "type 2 with pictures", saw="")
    assert not any("Already done, as far as" in text for text in ask.texts("robot/tasks"))
    assert "seen" not in hour.model_dump()
