from __future__ import annotations

import asyncio
import dataclasses
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coopera.core.clock import Clock
from coopera.core.errors import ModelOutputError, RunError
from coopera.core.hour import DayPlan, Example, HourRecord, Observation
from coopera.core.household import Percept, SceneId
from coopera.core.people import Belief, BigFive
from coopera.core.randomness import Address
from coopera.core.replies import IntentionReply
from coopera.graphs import RobotContext, RobotView, build_robot_graph
from coopera.graphs.hour import robot_view
from coopera.graphs.robot import robot_hour
from coopera.graphs.robots.robot_view import HomeView
from tests.fakes import MARA, FakeHome, FolderRecorder, ScriptedAsk, placing, type2_answers
from tests.graphs.conftest import MakeServices
from tests.graphs.test_day import run_study

TEN = Clock(day=1, hour=10)
SEEN = Observation(percept=Percept(room="kitchen", near=["stove_1"], motion="stirring"))
KNOWN = Belief(big_five=BigFive(openness=4), profile="Cooks a lot.")


def robot(make_services: MakeServices, collab: int = 2, seen: Observation = SEEN, **options: Any) -> RobotContext:
    plan = DayPlan(day=1, episode_day=1, person=MARA.id, scene=SceneId("toy"), hours=[10], collab=collab)  # type: ignore[arg-type]
    services = make_services(**options)
    view = robot_view(services, plan, TEN, seen, KNOWN, MARA.id)
    return RobotContext(view, services.home(plan.scene), services.method, services.learner)


def watch(ctx: RobotContext) -> Any:
    return robot_hour(build_robot_graph().invoke({}, context=ctx), ctx.view.observation)  # type: ignore[arg-type]


def test_the_nodes_are_those_of_the_design() -> None:
    nodes = [name for name in build_robot_graph().get_graph().nodes if not name.startswith("__")]
    assert nodes == ["observe", "imagine_intentions", "classify_intentions", "imagine_tasks", "classify_tasks", "act"]


def test_untrained_the_papers_accepts_everything_and_imagines_tasks_once_per_intention(
    make_services: MakeServices,
) -> None:
    ask = ScriptedAsk(type2_answers())
    hour = watch(robot(make_services, ask=ask, method="paper"))
    assert [(c.text, c.probability, c.accepted) for c in hour.intentions] == [
        ("Cook a meal", 0.5, True),
        ("Read quietly", 0.5, True),
        ("Tidy the home", 0.5, True),
    ]
    assert sorted(v["intention"] for v in ask.variables_of("robot/tasks_type2")) == [
        "Cook a meal",
        "Read quietly",
        "Tidy the home",
    ]
    draws = sorted(at.draw for name, at, _ in ask.asked if name == "robot/tasks_type2")
    assert draws == [0, 1, 2]


def test_graphs_can_be_awaited_side_by_side_with_the_results_of_each_alone(make_services: MakeServices) -> None:
    answers, together = type2_answers(), threading.Barrier(4, timeout=30)
    said = answers["robot/intentions"]

    def once_all_have_asked(variables: dict[str, Any]) -> dict[str, Any]:
        together.wait()
        return said(variables)

    answers["robot/intentions"] = once_all_have_asked
    contexts = [robot(make_services, ask=ScriptedAsk(answers)) for _ in range(4)]

    async def live() -> list[Any]:
        graph = build_robot_graph()
        return await asyncio.gather(*(graph.ainvoke({}, context=ctx) for ctx in contexts))

    assert [robot_hour(state, SEEN) for state in asyncio.run(live())] == [watch(robot(make_services))] * 4


def test_a_thing_imagined_for_two_intentions_counts_once_for_the_likelier(make_services: MakeServices) -> None:
    tasks = watch(robot(make_services, method="paper")).tasks
    assert [(t.act.object, t.intention) for t in tasks] == [
        ("spoon", "Cook a meal"),
        ("whisk", "Cook a meal"),
        ("novel", "Read quietly"),
        ("broom", "Tidy the home"),
    ]


def test_only_accepted_tasks_are_done_in_the_home(make_services: MakeServices) -> None:
    ctx = robot(make_services, method="paper")
    ctx.learner.classifiers["task"].train(
        [_labelled("bring the whisk", False), _labelled("bring the novel", True)], seed=0
    )
    hour = watch(ctx)
    assert [o.act.object for o in hour.outcomes] == ["novel", "spoon", "broom"]
    assert [a.object for _, a, _ in ctx.home.performed] == ["novel", "spoon", "broom"]  # type: ignore[attr-defined]


def test_where_no_intention_is_accepted_the_likeliest_goes_on_and_that_is_said(make_services: MakeServices) -> None:
    ctx = robot(make_services)
    texts = ("Cook a meal", "Read quietly", "Tidy the home")
    ctx.learner.classifiers["intention"].train([_labelled(text, False) for text in texts], seed=0)
    hour = watch(ctx)
    assert [c.accepted for c in hour.intentions] == [True, False, False]
    assert hour.fallbacks == ["no intention was accepted: the most probable one went on"]


def test_an_unreadable_task_reply_costs_that_intention_alone_and_is_said(make_services: MakeServices) -> None:
    answers = type2_answers()
    fine = answers["robot/tasks_type2"]

    def garbled(variables: dict[str, Any]) -> dict[str, Any]:
        if variables["intention"] == "Read quietly":
            raise ModelOutputError("robot/tasks_type2", "???", "not JSON")
        return fine(variables)

    answers["robot/tasks_type2"] = garbled
    hour = watch(robot(make_services, ask=ScriptedAsk(answers), method="paper"))
    assert {t.intention for t in hour.tasks} == {"Cook a meal", "Tidy the home"}
    [sentence] = hour.fallbacks
    assert sentence.startswith('no tasks for "Read quietly"')


def test_where_no_task_can_be_imagined_it_only_watches_and_that_is_said(make_services: MakeServices) -> None:
    answers = type2_answers()

    def garbled(_: dict[str, Any]) -> dict[str, Any]:
        raise ModelOutputError("robot/tasks_type2", "???", "not JSON")

    answers["robot/tasks_type2"] = garbled
    hour = watch(robot(make_services, ask=ScriptedAsk(answers)))
    assert hour.tasks == hour.outcomes == []
    assert "no valid task was imagined: the robot only watches" in hour.fallbacks


def test_an_unreadable_superset_of_intentions_ends_the_hour(make_services: MakeServices) -> None:
    answers = type2_answers()

    def garbled(_: dict[str, Any]) -> dict[str, Any]:
        raise ModelOutputError("robot/intentions", "???", "not JSON")

    answers["robot/intentions"] = garbled
    with pytest.raises(ModelOutputError, match="robot/intentions"):
        watch(robot(make_services, ask=ScriptedAsk(answers)))


def test_it_recalls_what_it_was_told_of_earlier_days_and_what_it_guessed_today(make_services: MakeServices) -> None:
    ask = ScriptedAsk(type2_answers())
    ctx = robot(make_services, ask=ask)
    history, guesses = (make_services().memories(kept, 0, MARA.id) for kept in ("history", "guesses"))
    history.add("Bake bread", ["knead dough"], now=10)
    guesses.add("A wrong guess of yesterday", [], now=10)
    guesses.add("Tidy the home", [], now=24 + 9)
    hour = watch(ctx)
    assert {m.text for m in hour.recalled} == {"Bake bread", "knead dough", "Tidy the home"}
    [variables] = ask.variables_of("robot/intentions")
    assert {m["when"] for m in variables["recalled_intentions"]} == {"9 am", "day 1, 10 am"}


def test_without_traits_and_context_neither_prompts_nor_classifiers_see_them(make_services: MakeServices) -> None:
    for method, absent in (("no_traits", ("profile", "big_five")), ("no_context", ("recalled_intentions",))):
        ask = ScriptedAsk(type2_answers())
        ctx = robot(make_services, ask=ask, method=method)
        make_services().memories("history", 0, MARA.id).add("Bake bread", [], now=10)
        watch(ctx)
        [variables] = ask.variables_of("robot/intentions")
        assert not any(variables[name] for name in absent)


def test_random_accepts_everything_whatever_was_learned(make_services: MakeServices) -> None:
    ctx = robot(make_services, method="random")
    ctx.learner.classifiers["intention"].train([_labelled("Cook a meal", False)], seed=0)
    assert all(c.accepted for c in watch(ctx).intentions)


def test_in_type_1_the_robot_is_given_the_first_task_in_words_and_may_use_what_can_be_moved(
    make_services: MakeServices,
) -> None:
    answers = type2_answers()
    answers["robot/tasks_type1"] = lambda v: {"tasks": [placing("mug_1", "desk_1", 5, 1)]}
    ask = ScriptedAsk(answers)
    seen = SEEN.model_copy(update={"first_task": "put the mug on the stove"})
    watch(robot(make_services, collab=1, seen=seen, ask=ask))
    variables = ask.variables_of("robot/tasks_type1")[0]
    assert variables["first_task"] == "put the mug on the stove"
    assert variables["movable"] == FakeHome().movable


def test_nothing_true_about_the_hour_is_in_what_a_robot_may_know() -> None:
    """None of these types holds the truth; see also test_leaks.py."""
    assert [field.name for field in dataclasses.fields(RobotView)] == [
        *("clock", "observation", "pictures", "person", "belief", "collab", "home", "history", "guesses"),
        *("ask", "looks"),
    ]
    assert set(Observation.model_fields) == {"frames", "percept", "first_task"}


def test_a_robot_looks_at_the_home_and_neither_acts_in_it_nor_reads_its_state(make_services: MakeServices) -> None:
    view = robot(make_services).view.home
    assert (view.rooms, view.motions) == (FakeHome.rooms, FakeHome.motions)
    assert view.objects("fixed") == FakeHome().fixed
    assert view.objects("movable") == FakeHome().movable
    assert [view.class_of(name) for name in ("mug_2", "no_such_thing")] == ["mug", "no_such_thing"]
    public = {name for name in dir(HomeView) if not name.startswith("_")}
    assert public == {
        *("classes", "class_of", "fixed", "misfit", "motions", "movable", "objects", "of", "rooms", "scene", "states"),
    }


def test_a_candidate_that_cannot_be_done_in_the_home_is_dropped_before_it_is_judged_and_that_is_said(
    make_services: MakeServices,
) -> None:
    answers = type2_answers()
    acts = [placing("mug_9", "desk_1", 9, 1), placing("mug_2", "desk_1", 66, 1), placing("mug_1", "desk_1", 5, 1)]
    answers["robot/tasks_type1"] = lambda v: {"tasks": acts}
    hour = watch(robot(make_services, collab=1, ask=ScriptedAsk(answers)))
    assert [(task.act.object, task.accepted) for task in hour.tasks] == [("mug_1", True)]
    assert hour.fallbacks == [
        '"put the mug on the desk" was dropped: "mug_2" has the id 6, not 66.',
        '"put the mug on the desk" was dropped: There is no movable object "mug_9".',
    ]


def test_anything_can_be_brought_but_furniture(make_services: MakeServices) -> None:
    answers = type2_answers()
    things = ("anvil", "sofa_1")
    answers["robot/tasks_type2"] = lambda v: {"tasks": [{"thought": "so", "act": {"object": t}} for t in things]}
    hour = watch(robot(make_services, ask=ScriptedAsk(answers)))
    assert [task.act.object for task in hour.tasks] == ["anvil"]
    assert hour.fallbacks == ['"bring the sofa" was dropped: The sofa_1 is furniture.']


@pytest.mark.parametrize("collab", [1, 2])
def test_the_robot_knows_how_things_are_where_it_is_and_in_what_it_saw_and_nowhere_else(
    make_services: MakeServices, collab: int
) -> None:
    answers = type2_answers()
    answers["robot/tasks_type1"] = lambda v: {"tasks": [placing("mug_1", "desk_1", 5, 1)]}
    home, ask = FakeHome(), ScriptedAsk(answers)
    home.said = {"mug_1": "dirty", "stove_1": "on", "desk_1": "dirty", "book_1": "cut"}
    percept = Percept(room="study", near=["desk_1"], motion="", states={"desk_1": "dirty", "stove_1": "off"})
    watch(robot(make_services, collab, Observation(percept=percept), ask=ask, home=home))
    assert ask.variables_of(f"robot/tasks_type{collab}")[0]["states"] == {
        "desk_1": "dirty",
        "mug_1": "dirty",
        "stove_1": "on",
    }
    assert ask.variables_of("robot/intentions")[0]["percept"]["states"] == percept.states


def test_a_robot_asks_with_its_own_prompts_alone(make_services: MakeServices) -> None:
    ask = robot(make_services).view.ask
    with pytest.raises(RunError, match=r"human/intention: a robot asks prompts of its own role alone \(robot/intent"):
        ask("human/intention", IntentionReply, at=Address(MARA.id, 1, 10, "peek"), variables={})
    assert not hasattr(ask, "take_calls")


def test_a_robot_reads_its_memories_and_writes_none(make_services: MakeServices) -> None:
    view = robot(make_services).view
    make_services().memories("history", 0, MARA.id).add("Bake bread", ["knead dough"], now=10)
    assert [one.text for one in view.history.tasks.recall("dough", 34, 3)] == ["knead dough"]
    assert [one.text for one in view.history.intentions.records(since=5)] == ["Bake bread"]
    for kept in (*view.history, *view.guesses):
        offered = {name for name in dir(kept) if not name.startswith("_")}
        assert offered == {"of", "recall", "records", "texts", "relevances"}


def _labelled(candidate: str, yes: bool) -> Example:
    return Example(person=MARA.id, day=0, hour=9, candidate=candidate, label=yes)


def test_an_hour_that_stands_has_all_its_pictures(make_services: MakeServices, tmp_path: Path) -> None:
    home, missing = FakeHome(), []

    class Counting(FolderRecorder):
        def write_hour(self, record: HourRecord, after: Callable[[], None] | None = None) -> None:
            if after:
                after()
            missing.append(len(home.late))
            super().write_hour(record)

    services = make_services(home=home, frames=2, help_frames=1)
    run_study(dataclasses.replace(services, recorder=Counting(tmp_path)), n=1)
    assert missing == [0, 0, 0]
    assert len(list(tmp_path.glob("frames/*/*/*.webp"))) > 12


@pytest.mark.parametrize("looks", [True, False])
def test_a_robot_that_looks_at_pictures_has_them_before_it_thinks(make_services: MakeServices, looks: bool) -> None:
    home, late = FakeHome(), []
    answers = type2_answers()
    tasks = answers["robot/tasks_type2"]
    answers["robot/tasks_type2"] = lambda v: (late.append(len(home.late)), tasks(v))[1]
    ask = ScriptedAsk(answers)
    ask.seeing = {"robot"} if looks else set()
    run_study(make_services(home=home, ask=ask, frames=2), n=1)
    assert set(late) == {0 if looks else 4}
