from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from langgraph.checkpoint.memory import InMemorySaver
from langgraph.checkpoint.serde.jsonplus import JsonPlusSerializer
from langgraph.checkpoint.sqlite import SqliteSaver

from coopera.core.errors import ModelOutputError
from coopera.core.hour import DayPlan, Evening, Example
from coopera.core.household import HUMAN, SceneId
from coopera.graphs import STATE_TYPES, Services, build_day_graph, build_study_graph, first_day
from tests.fakes import MARA, FakeHome, FolderRecorder, ScriptedAsk, placing, reviewed, type2_answers
from tests.graphs.conftest import MakeServices


def days(count: int, hours: int = 3) -> list[DayPlan]:
    return [
        DayPlan(day=d, episode_day=d, person=MARA.id, scene=SceneId("toy"), hours=[9 + n for n in range(hours)])
        for d in range(count)
    ]


def run_study(services: Services, saver: SqliteSaver | None = None, *, go_on: bool = False, n: int = 2) -> Any:
    graph = build_study_graph(saver)
    given: Any = None if go_on else {"schedule": days(n)}
    return graph.invoke(given, {"configurable": {"thread_id": "study"}}, context=services)


def run_saved(services: Services, folder: Path, *, go_on: bool = False) -> None:
    with closing(sqlite3.connect(folder / "checkpoints.sqlite", check_same_thread=False)) as connection:
        saver = SqliteSaver(connection, serde=JsonPlusSerializer(allowed_msgpack_modules=list(STATE_TYPES)))
        run_study(services, saver, go_on=go_on)


def files(folder: Path) -> dict[str, bytes]:
    kept = [
        path for path in folder.rglob("*") if path.is_file() and path.parts[len(folder.parts)] in ("trace", "adapters")
    ]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(kept)}


def test_the_nodes_are_those_of_the_design() -> None:
    nodes = [name for name in build_day_graph().get_graph().nodes if not name.startswith("__")]
    assert nodes == ["start_day", "hour", "feedback", "infer_traits", "learn", "end_day"]


def test_each_hour_the_home_draws_the_person_who_lives_it(make_services: MakeServices) -> None:
    home = FakeHome()
    build_day_graph().invoke(first_day(days(1)[0]), context=make_services(home=home))
    assert home.inhabitants == [(HUMAN, MARA.id)] * 3


def test_a_day_is_lived_hour_by_hour_and_ends_with_an_evening(make_services: MakeServices) -> None:
    services = make_services()
    steps = [name for update in build_day_graph().stream(first_day(days(1)[0]), context=services) for name in update]
    assert steps == ["start_day", "hour", "hour", "hour", "feedback", "infer_traits", "learn", "end_day"]
    hours = services.recorder.read_day(0)
    assert [hour.hour for hour in hours] == [9, 10, 11]
    assert all(hour.status == "ok" and hour.success and hour.calls for hour in hours)
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert evening.belief.profile == "Cooks a lot."
    assert evening.learned["intention"] == {"examples": 9, "positives": 3, "seen": 9.0}


def test_streaming_with_subgraphs_shows_the_nodes_of_person_and_robot(make_services: MakeServices) -> None:
    day = build_day_graph()
    given = first_day(days(1, hours=1)[0])
    stream = day.stream(given, context=make_services(), stream_mode="updates", subgraphs=True)
    seen = [name for _, update in stream for name in update]
    assert sorted(seen[5:7]) == ["reflect_profile", "reflect_scene"], "they run at once, and end in any order"
    assert seen[:5] + seen[7:11] == [
        "start_day",
        "recall",
        "propose",
        "search",
        "decompose",
        "merge",
        "mend",
        "human",
        "demonstrate",
    ]
    assert {"observe", "imagine_intentions", "imagine_tasks", "act", "robot", "finish", "score", "record"} <= set(seen)


def test_without_a_robot_a_life_is_lived_alone_and_all_tasks_are_done(make_services: MakeServices) -> None:
    home, ask = FakeHome(), ScriptedAsk(type2_answers())
    services = make_services(home=home, ask=ask, method="none", frames=2)
    run_study(services, n=1)
    hours = services.recorder.read_day(0)
    assert [(hour.status, hour.robot, hour.success) for hour in hours] == [("ok", None, None)] * 3
    assert [act for _, act, _ in home.performed] == [
        task.act for hour in hours if hour.human for task in hour.human.tasks
    ]
    assert {prompt.split("/")[0] for prompt, _, _ in ask.asked} == {"human"}
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert (evening.feedback, evening.learned) == ([], {})


def test_a_robot_that_changes_nothing_in_the_home_meets_the_days_of_the_life_alone(
    make_services: MakeServices, tmp_path: Path
) -> None:
    alone = make_services(method="none", folder=tmp_path / "alone")
    helped = make_services(folder=tmp_path / "helped")
    for services in (alone, helped):
        run_study(services, n=2)
    lives = [[h.human for day in (0, 1) for h in services.recorder.read_day(day)] for services in (alone, helped)]
    assert lives[0] == lives[1]


def test_the_robot_watches_only_the_first_task_and_the_person_does_the_rest(make_services: MakeServices) -> None:
    home = FakeHome()
    services = make_services(home=home, frames=2)
    run_study(services, n=1)
    recorded = [act for agent, act, record in home.performed if record]
    assert len(recorded) == 3
    assert sum(agent == "human" for agent, _, _ in home.performed) == 15
    [robot] = {hour.robot.observation.model_dump_json() for hour in services.recorder.read_day(0)[:1] if hour.robot}
    assert "whisk" not in robot
    assert "frames/day-00/hour-09/robot-0.webp" in robot


def test_each_act_of_the_robot_is_kept_in_pictures_that_it_is_never_shown(
    make_services: MakeServices, tmp_path: Path
) -> None:
    seen = []
    for count in (0, 2):
        home, answers = FakeHome(), type2_answers()
        answers["human/tasks_type1"] = lambda v: {"tasks": [placing("book_1", "desk_1", 4, 1)]}
        for node in ("profile", "scene"):
            answers[f"human/reflect_{node}_type1"] = lambda v: reviewed()
        answers["robot/tasks_type1"] = lambda v: {"tasks": [placing("mug_1", "desk_1", 5, 1)]}
        ask, folder = ScriptedAsk(answers), tmp_path / str(count)
        services = make_services(home=home, ask=ask, folder=folder, frames=2, help_frames=count)
        plan = days(1, hours=1)[0].model_copy(update={"collab": 1})
        build_day_graph().invoke(first_day(plan), context=services)
        hours = services.recorder.read_day(0)
        seen.append([hour.model_copy(update={"calls": []}) for hour in hours])
        by_robot = [record for agent, _, record in home.performed if agent == "robot"]
        assert by_robot
        assert set(by_robot) == {count > 0}
        for hour in hours:
            assert hour.robot is not None
            folder = services.recorder.frames_folder(0, hour.hour)
            done = [n for n, one in enumerate(hour.robot.outcomes) if one.ok]
            kept = {path.name for path in folder.glob("help-*")}
            assert kept == {f"help-{n}-{k}.webp" for n in done for k in range(count)}
            assert not any("help" in name for name in hour.robot.observation.frames)
    assert seen[0] == seen[1]


@pytest.mark.parametrize(("relation", "left"), [("inside", 0), ("on", 1)])
def test_a_task_is_left_to_the_person_unless_the_robot_has_put_the_thing_in_or_on_as_they_want(
    make_services: MakeServices, relation: str, left: int
) -> None:
    answers, home = type2_answers(), FakeHome()
    home.fixed["fridge_1"] = (7, "kitchen")
    wanted, offered = placing("mug_1", "fridge_1", 5, 7), placing("mug_1", "fridge_1", 5, 7)
    wanted["act"]["relation"], offered["act"]["relation"] = "inside", relation
    tasks = [placing("book_1", "desk_1", 4, 1), wanted]
    answers["human/tasks_type1"] = lambda v: {"tasks": tasks}
    for node in ("profile", "scene"):
        answers[f"human/reflect_{node}_type1"] = lambda v: reviewed()
    answers["robot/tasks_type1"] = lambda v: {"tasks": [offered]}
    plan = days(1, hours=1)[0].model_copy(update={"collab": 1})
    build_day_graph().invoke(first_day(plan), context=make_services(home=home, ask=ScriptedAsk(answers)))
    by_person = [act.describe() for agent, act, _ in home.performed if agent == "human"]
    assert by_person.count("put the mug in the fridge") == left


def test_what_was_learned_on_the_first_day_is_used_on_the_second(make_services: MakeServices) -> None:
    services = make_services(method="paper")
    run_study(services)
    first, second = (services.recorder.read_day(day)[0] for day in (0, 1))
    assert first.robot is not None
    assert second.robot is not None
    assert [c.accepted for c in first.robot.intentions] == [True, True, True]
    assert [c.accepted for c in second.robot.intentions] == [True, False, False]
    assert first.success is not None
    assert second.success is not None
    assert (first.success.predicate.f1 or 0) < (second.success.predicate.f1 or 0)
    assert "Cook a meal" in {m.text for m in second.robot.recalled}


def test_examples_tell_the_place_of_the_guess_and_the_truth_that_was_not_guessed_has_none(
    make_services: MakeServices,
) -> None:
    answers = type2_answers()
    answers["human/intention"] = lambda v: {"intention": "Sing loudly"}
    services = make_services(ask=ScriptedAsk(answers))
    run_study(services, n=1)
    lines = (services.recorder.adapters_folder(0) / "intention" / "examples.jsonl").read_text().splitlines()
    ranks = {e.candidate: (e.rank, e.label) for e in map(Example.model_validate_json, lines)}
    assert ranks == {
        "Sing loudly": (None, True),
        "Cook a meal": (0, False),
        "Read quietly": (1, False),
        "Tidy the home": (2, False),
    }


def test_a_new_episode_starts_with_a_robot_that_knows_nothing(make_services: MakeServices) -> None:
    services = make_services()
    one, two = days(2)
    other = two.model_copy(update={"episode": 1, "episode_day": 0})
    build_study_graph().invoke({"schedule": [one, other]}, context=services)
    again = services.recorder.read_day(1)[0].robot
    assert again is not None
    assert [c.probability for c in again.intentions] == [0.5, 0.25, 0.125]  # by its own order
    assert again.recalled == []


def test_an_hour_whose_reply_cannot_be_read_is_failed_with_its_reason_and_the_day_goes_on(
    make_services: MakeServices,
) -> None:
    answers = type2_answers()
    fine = answers["robot/intentions"]

    def at_ten(variables: dict[str, Any]) -> dict[str, Any]:
        if variables["hour"] == 10:
            raise ModelOutputError("robot/intentions", "???", "not JSON")
        return fine(variables)

    answers["robot/intentions"] = at_ten
    services = make_services(ask=ScriptedAsk(answers))
    run_study(services, n=1)
    hours = services.recorder.read_day(0)
    assert [hour.status for hour in hours] == ["ok", "failed", "ok"]
    assert "not JSON" in hours[1].reason
    assert hours[1].human is not None
    assert hours[1].success is None


def test_feedback_that_cannot_be_read_makes_no_label(make_services: MakeServices) -> None:
    answers = type2_answers()
    answers["human/feedback_tasks"] = lambda v: {"verdicts": [{"yes": True}]}
    services = make_services(ask=ScriptedAsk(answers))
    run_study(services, n=1)
    evening = services.recorder.evenings[0]  # type: ignore[attr-defined]
    assert {item.helpful for item in evening.feedback if item.kind == "task"} == {None}
    assert evening.learned["task"]["examples"] == 0


class Killed(BaseException):
    """Stands for a process that dies: nothing in the graphs may catch it."""


@pytest.mark.parametrize("at", ["propose", "imagine_tasks", "score", "infer_traits"])
@pytest.mark.parametrize("moment", [1, 4])
def test_a_study_killed_anywhere_and_resumed_equals_one_that_was_not(
    make_services: MakeServices, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at: str, moment: int
) -> None:
    monkeypatch.setenv("LANGGRAPH_STRICT_MSGPACK", "true")
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    for folder in (whole, broken):
        folder.mkdir()
    run_saved(make_services(folder=whole), whole)
    ask = DyingAsk(at, moment if at != "infer_traits" else min(moment, 2))
    with pytest.raises(Killed):
        run_saved(make_services(folder=broken, ask=ask), broken)
    run_saved(make_services(folder=broken), broken, go_on=True)
    assert files(broken) == files(whole)


class DyingAsk(ScriptedAsk):
    """Dies at the n-th call of a node."""

    def __init__(self, node: str, moment: int) -> None:
        super().__init__(type2_answers())
        self.node, self.left = node, moment

    def __call__(self, prompt: str, reply: type[Any], /, **given: Any) -> Any:
        if given["at"].node == self.node:
            self.left -= 1
            if self.left == 0:
                raise Killed
        return super().__call__(prompt, reply, **given)


def test_a_study_begins_with_the_home_as_it_was_built_whoever_used_it_before(make_services: MakeServices) -> None:
    home = FakeHome()
    home.movable["mug_1"] = (5, "study")
    final = run_study(make_services(home=home), n=1)
    assert final["worlds"]["toy"]["movable"]["mug_1"] == [5, "kitchen"]


class Failing(ScriptedAsk):
    """Fails where the robot is to describe the person, the first time."""

    failed = False

    def __call__(self, prompt: str, reply: type[Any], /, **given: Any) -> Any:
        if prompt == "robot/traits" and not self.failed:
            self.failed = True
            raise OSError("the network is gone")
        return super().__call__(prompt, reply, **given)


def test_an_evening_that_broke_off_keeps_the_calls_that_were_made_before(
    make_services: MakeServices, tmp_path: Path
) -> None:
    services, whole = (
        make_services(folder=tmp_path / "broken", ask=Failing(type2_answers())),
        make_services(folder=tmp_path / "whole"),
    )
    for folder in ("broken", "whole"):
        (tmp_path / folder).mkdir()
    run_saved(whole, tmp_path / "whole")
    with pytest.raises(OSError, match="network"):
        run_saved(services, tmp_path / "broken")
    services.ask.take_calls()  # as another process would have none of them
    run_saved(services, tmp_path / "broken", go_on=True)
    assert [call.prompt for call in services.recorder.evenings[0].calls].count("human/feedback_tasks") == 3  # type: ignore[attr-defined]
    assert services.recorder.evenings == whole.recorder.evenings  # type: ignore[attr-defined]


def test_what_stands_in_the_trace_is_taken_over_with_all_memories(make_services: MakeServices, tmp_path: Path) -> None:
    first = make_services(folder=tmp_path / "first")
    run_study(first)
    ask = ScriptedAsk({})
    again = replace(make_services(folder=tmp_path / "again", ask=ask), recorder=first.recorder)
    run_study(again)
    assert ask.asked == []
    for owner in ("human", "history", "guesses"):
        kept = [
            [(r.text, r.hour) for stream in services.memories(owner, 0, MARA.id) for r in stream.records()]
            for services in (first, again)
        ]
        assert kept[0] == kept[1] != []


def test_an_hour_that_is_lived_again_knows_nothing_of_what_came_after_it(
    make_services: MakeServices, tmp_path: Path
) -> None:
    services = make_services(folder=tmp_path / "first")
    run_study(services)
    ask, elsewhere = ScriptedAsk(type2_answers()), make_services(folder=tmp_path / "again").recorder
    run_study(replace(services, recorder=elsewhere, ask=ask))
    told = [
        [memory for memory in given["recalled_intentions"] + given["recalled_tasks"] if memory["source"] == "told"]
        + given["told"]
        for given in ask.variables_of("robot/intentions")
    ]
    assert not any(told[:3]), "nobody had told it anything on the first day"
    assert all(told[3:])


class Stopping(FolderRecorder):
    """Is killed right after it has written an evening, the first time."""

    killed = False

    def write_evening(self, evening: Evening) -> None:
        super().write_evening(evening)
        if not self.killed:
            self.killed = True
            raise KeyboardInterrupt


def test_an_evening_that_stands_in_the_trace_is_learned_once_though_its_checkpoint_is_lost(
    make_services: MakeServices, tmp_path: Path
) -> None:
    recorder = Stopping(tmp_path)
    services = make_services()
    services = replace(services, recorder=recorder, learner=replace(services.learner, recorder=recorder))
    with pytest.raises(KeyboardInterrupt):
        run_saved(services, tmp_path)
    run_saved(services, tmp_path, go_on=True)
    assert [evening.learned["intention"]["examples"] for evening in recorder.evenings.values()] == [9, 18]


@pytest.mark.parametrize("node", ["infer_traits", "learn"])
def test_an_evening_under_way_in_the_checkpoint_is_not_asked_for_again_if_it_stands_in_the_trace(
    make_services: MakeServices, tmp_path: Path, node: str
) -> None:
    whole = make_services(folder=tmp_path / "whole")
    run_study(whole, n=1)
    ask = ScriptedAsk({})
    late = replace(make_services(folder=tmp_path / "late", ask=ask), recorder=whole.recorder)
    day = build_day_graph(InMemorySaver())
    config: Any = {"configurable": {"thread_id": "day"}}
    state = {**first_day(days(1)[0]), "position": 3, "feedback": [], "traits_reasons": {}}
    day.update_state(config, state, as_node={"infer_traits": "feedback", "learn": "infer_traits"}[node])
    done = day.invoke(None, config, context=late)
    assert ask.asked == []
    assert done["beliefs"][MARA.id].profile == "Cooks a lot."
    assert done["learned"] == [0]
