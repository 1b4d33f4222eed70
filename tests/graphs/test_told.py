"""What a robot of weeks makes of what it was told: proposals, counts, verdicts, and a memory that fades by the day."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Example, Observation
from coopera.core.household import FreeMotion, HandOver, Percept, PickPlace, SceneId, Use, use_of
from coopera.core.people import Belief
from coopera.evaluation import METHODS
from coopera.graphs import RobotContext, build_robot_graph
from coopera.graphs.hour import robot_view
from coopera.graphs.robot import robot_hour
from coopera.graphs.robots.evidence import of_intentions
from coopera.graphs.robots.method import Numbers
from coopera.graphs.robots.recall import recall_weeks, weight
from coopera.graphs.robots.told import ToldHour, share, told_hours, used_in, uses_of
from tests.fakes import MARA, FakeHome, ScriptedAsk, TableClassifier, placing, type2_answers
from tests.graphs.conftest import MakeServices

STIRRING = Observation(percept=Percept(room="kitchen", near=["stove_1"], motion="stirring", in_hand="pot"))
COOKING = [f"stir a pot at the stove with the {thing} in hand" for thing in ("pot", "spoon", "ladle")]
READING = [f"sit and read at the sofa with the {thing} in hand" for thing in ("novel", "blanket")]


def robot(
    make_services: MakeServices,
    *,
    day: int = 3,
    hour: int = 10,
    seen: Observation = STIRRING,
    collab: int = 2,
    told: dict[int, tuple[str, list[str]]] | None = None,
    guessed: dict[int, str] | None = None,
    **options: Any,
) -> RobotContext:
    """A robot in an hour, after it was told of others: {global hour: (intention, tasks)}."""
    plan = DayPlan(day=day, episode_day=day, person=MARA.id, scene=SceneId("toy"), hours=[hour], collab=collab)  # type: ignore[arg-type]
    services = make_services(**options)
    history, guesses = (services.memories(kept, 0, MARA.id) for kept in ("history", "guesses"))
    history.extend((now, intention, tasks) for now, (intention, tasks) in (told or {}).items())
    guesses.extend((now, intention, []) for now, intention in (guessed or {}).items())
    view = robot_view(services, plan, Clock(day=day, hour=hour), seen, Belief(), MARA.id)
    return RobotContext(view, services.home(plan.scene), services.method, services.learner)


def watch(ctx: RobotContext) -> Any:
    return robot_hour(build_robot_graph().invoke({}, context=ctx), ctx.view.observation)  # type: ignore[arg-type]


TOLD = {10: ("Cook a meal", COOKING), 20: ("Read quietly", READING), 34: ("Cook a meal", COOKING)}


@pytest.mark.parametrize(
    ("act", "use"),
    [
        (
            FreeMotion(target_id=1, target="stove_1", in_hand="wooden_spoon", motion="stir"),
            Use("wooden spoon", "stove"),
        ),
        (PickPlace(object_id=1, object="mug_2", receptacle_id=2, receptacle="side_table_1"), Use("mug", "side table")),
        (HandOver(object="mug_2"), Use("mug")),
    ],
)
def test_what_an_act_says_of_itself_can_be_read_back(act: Any, use: Use) -> None:
    assert use_of(act.describe()) == use
    assert use_of("hum a song") is None


def test_the_told_tasks_of_like_intentions_go_to_the_task_prompt_the_most_alike_first(
    make_services: MakeServices,
) -> None:
    ask = ScriptedAsk(type2_answers())
    watch(robot(make_services, ask=ask, told=TOLD))
    asked = {v["intention"]: v for v in ask.variables_of("robot/tasks_type2")}
    told = asked["Cook a meal"]["told"]
    assert [one["intention"] for one in told[:2]] == ["Cook a meal", "Cook a meal"]
    assert [one["when"] for one in told[:2]] == ["day 2, 10 am", "day 1, 10 am"]  # the newer counts more
    assert told[0]["tasks"] == COOKING[1:]  # the pot is in hand already
    assert asked["Cook a meal"]["in_hand"] == "pot"


def test_the_papers_robot_is_told_nothing_of_this(make_services: MakeServices) -> None:
    ask = ScriptedAsk(type2_answers())
    hour = watch(robot(make_services, ask=ask, told=TOLD, method="paper"))
    for prompt in ("robot/intentions", "robot/tasks_type2"):
        assert all(v["told"] == [] for v in ask.variables_of(prompt))
    assert all(v["in_hand"] is None for v in ask.variables_of("robot/tasks_type2"))
    assert {v["n_tasks"] for v in ask.variables_of("robot/tasks_type2")} == {5}
    assert not any(one.evidence for one in [*hour.intentions, *hour.tasks])


def test_what_the_person_holds_is_never_offered_whatever_the_model_says(make_services: MakeServices) -> None:
    answers = type2_answers()
    answers["robot/tasks_type2"] = lambda v: {
        "tasks": [{"thought": "x", "act": {"object": t}} for t in ("pot", "fork")]
    }
    hour = watch(robot(make_services, ask=ScriptedAsk(answers)))
    assert [task.act.object for task in hour.tasks] == ["fork"]
    assert '"bring the pot" was dropped: The person has it already.' in hour.fallbacks
    theirs = watch(robot(make_services, ask=ScriptedAsk(answers), method="paper"))
    assert {task.act.object for task in theirs.tasks} == {"pot", "fork"}


def test_in_type_1_the_step_just_seen_is_never_offered(make_services: MakeServices) -> None:
    answers = type2_answers()
    acts = [placing("mug_2", "sofa_1", 6, 2), placing("book_1", "sofa_1", 4, 2)]
    answers["robot/tasks_type1"] = lambda v: {"tasks": acts}
    seen = Observation(first_task="put the mug on the sofa")
    hour = watch(robot(make_services, collab=1, seen=seen, ask=ScriptedAsk(answers)))
    assert [task.act.object for task in hour.tasks] == ["book_1"]


def test_as_many_tasks_are_imagined_as_were_often_told_up_to_a_cap(make_services: MakeServices) -> None:
    for n, asked_for in ((2, 5), (7, 7), (12, 8)):
        things = [f"thing{chr(97 + i)}" for i in range(n)]
        cooked = [
            "stir at the stove with the pot in hand",
            *(f"stir at the stove with the {t} in hand" for t in things),
        ]
        ask = ScriptedAsk(type2_answers())
        watch(robot(make_services, ask=ask, told={10: ("Cook a meal", cooked)}, day=1))
        [count] = [v["n_tasks"] for v in ask.variables_of("robot/tasks_type2") if v["intention"] == "Cook a meal"]
        assert count == asked_for
        for kept in make_services().memories("history", 0, MARA.id):
            kept.forget_from(0)


def test_untrained_it_follows_its_best_guess_with_all_of_its_tasks(make_services: MakeServices) -> None:
    hour = watch(robot(make_services))
    assert [(c.text, c.accepted) for c in hour.intentions] == [
        ("Cook a meal", True),
        ("Read quietly", False),
        ("Tidy the home", False),
    ]
    assert [(t.act.object, t.accepted) for t in hour.tasks] == [("spoon", True), ("whisk", True)]


def test_untrained_it_takes_the_proposers_own_probability_where_it_gives_one(make_services: MakeServices) -> None:
    answers = type2_answers()
    said = {"Cook a meal": 0.2, "Read quietly": 0.7}
    answers["robot/intentions"] = lambda v: {
        "intentions": [{"intention": text, "probability": p} for text, p in said.items()]
    }
    hour = watch(robot(make_services, ask=ScriptedAsk(answers)))
    assert [(c.text, c.probability, c.accepted) for c in hour.intentions] == [
        ("Cook a meal", 0.2, False),
        ("Read quietly", 0.7, True),
    ]


def test_a_method_that_accepts_the_first_guess_accepts_it_whatever_was_learned(make_services: MakeServices) -> None:
    hour = watch(robot(make_services, method="first_guess", told={10: ("Read quietly", READING)}))
    assert [c.accepted for c in hour.intentions] == [True, False, False]
    assert all(task.accepted for task in hour.tasks)


def test_a_thing_that_was_told_counts_more_than_one_that_was_not(make_services: MakeServices) -> None:
    tasks = watch(robot(make_services, told=TOLD)).tasks
    evidence = {task.act.object: task.evidence for task in tasks}
    for name in ("prior", "told", "sight", "hour"):
        assert evidence["spoon"][name] > evidence["whisk"][name]
    assert evidence["spoon"]["support"] > 0


def test_an_order_without_probabilities_is_mixed_with_what_was_told(make_services: MakeServices) -> None:
    told = told_hours(robot(make_services, told=TOLD).view)
    reading = [float(hour.intention == "Read quietly") for hour in told]
    cooking = [1 - one for one in reading]
    by_order = of_intentions([], [[], []], [None, None])
    assert [one["prior"] for one in by_order] == [0.5, 0.25]
    second, first = of_intentions(told, [reading, cooking], [None, None])
    assert first["prior"] > 0.5 > second["prior"]  # the pot in hand and the hour speak for cooking
    assert of_intentions(told, [reading], [0.9])[0]["prior"] == 0.9


def test_told_hours_join_an_hours_intention_with_its_tasks_and_leave_today_and_long_ago_out(
    make_services: MakeServices,
) -> None:
    told = {10: ("Long ago", COOKING), 70 * 24 + 9: ("Cook a meal", COOKING), 70 * 24 + 10: ("Hum", [])}
    hours = told_hours(robot(make_services, day=72, told=told).view)
    assert [(hour.intention, hour.tasks) for hour in hours] == [("Cook a meal", tuple(COOKING)), ("Hum", ())]
    assert hours[0].looks > hours[1].looks


def test_what_was_told_fades_by_the_day_and_counts_more_at_a_like_hour_of_a_like_day() -> None:
    now = Clock(day=8, hour=10)  # a Tuesday
    assert weight(now, 7 * 24 + 10) > 0.9  # yesterday at this hour: by the paper's decay it were 0.29
    assert weight(now, 7 * 24 + 10) > weight(now, 1 * 24 + 10) > 0.7
    assert weight(now, 7 * 24 + 10) > weight(now, 7 * 24 + 15) > weight(now, 7 * 24 + 21)
    assert weight(now, 4 * 24 + 10) > weight(now, 5 * 24 + 10)  # a Friday, a Saturday


def test_half_of_what_is_recalled_was_told_however_much_was_guessed_today(make_services: MakeServices) -> None:
    told = {day * 24 + 10: (f"Cook meal {'abcdefgh'[day]}", []) for day in range(8)}
    guessed = {8 * 24 + hour: f"Guess {'abcdefghijkl'[hour - 9]}" for hour in range(9, 20)}
    view = robot(make_services, day=8, hour=20, told=told, guessed=guessed).view
    sources = [one.source for one in recall_weeks(view, "8 pm, Tuesday.")]
    assert sorted(filter(None, sources)) == ["guessed"] * 3 + ["told"] * 3
    only_told = [one.source for one in recall_weeks(robot(make_services, day=9, hour=9).view, "9 am")]
    assert set(only_told) == {"told"}
    assert len(only_told) == 6


def test_a_text_that_was_told_often_is_recalled_once_as_of_its_best_hour(make_services: MakeServices) -> None:
    told = {day * 24 + hour: ("Cook a meal" if hour == 10 else "Read", []) for day in range(4) for hour in (10, 20)}
    recalled = recall_weeks(robot(make_services, day=4, hour=10, told=told).view, "Cook a meal")
    assert [one.text for one in recalled] == ["Cook a meal", "Read"]
    assert recalled[0].hour == 3 * 24 + 10
    assert recalled[0].score == recalled[0].relevance * weight(Clock(day=4, hour=10), 3 * 24 + 10)


def test_what_was_told_is_ranked_as_if_each_text_had_been_scored_at_all_of_its_hours(
    make_services: MakeServices,
) -> None:
    told = {
        24 * day + hour: (
            f"Cook meal {(day + hour) % 5}",
            [f"stir a pot at the stove with the spoon {day % 9} in hand"],
        )
        for day in range(20)
        for hour in (8, 12)  # alike at 10
    }
    view = robot(make_services, day=20, hour=10, told=told).view
    for kind, stream in (("intention", view.history.intentions), ("task", view.history.tasks)):
        texts, hours, [alike] = stream.relevances(["Cook"], 20 * 24 - 1)
        columns = zip(alike, hours, texts, strict=True)
        scored = sorted((-one * weight(view.clock, hour), -hour, text) for one, hour, text in columns)
        best = {text: (text, -hour, -score) for score, hour, text in reversed(scored)}
        ranked = sorted(best.values(), key=lambda one: (-one[2], -one[1], one[0]))
        recalled = [one for one in recall_weeks(view, "Cook") if one.kind == kind]
        assert [(one.text, one.hour, one.score) for one in recalled] == ranked[: len(recalled)]
        assert len(recalled) == min(len(ranked), Numbers.RECALL_WEEKS[kind])


def test_a_guess_is_marked_as_one_in_prompts_and_in_the_trace(make_services: MakeServices) -> None:
    ask = ScriptedAsk(type2_answers())
    hour = watch(robot(make_services, ask=ask, told=TOLD, guessed={3 * 24 + 9: "Tidy the home"}))
    assert {one.text: one.source for one in hour.recalled if one.kind == "intention"} == {
        "Cook a meal": "told",
        "Read quietly": "told",
        "Tidy the home": "guessed",
    }
    [variables] = ask.variables_of("robot/intentions")
    assert {m["text"]: m["source"] for m in variables["recalled_intentions"]}["Tidy the home"] == "guessed"


def test_without_context_nothing_is_told_to_the_prompts_and_nothing_is_counted(make_services: MakeServices) -> None:
    ask = ScriptedAsk(type2_answers())
    hour = watch(robot(make_services, ask=ask, told=TOLD, method="no_context"))
    assert all(v["told"] == [] for v in ask.variables_of("robot/intentions"))
    assert {c.evidence["support"] for c in hour.intentions} == {0.0}


def test_a_habit_brings_what_was_used_in_hours_like_this_one_and_nothing_that_is_in_hand(
    make_services: MakeServices,
) -> None:
    made = METHODS["habit"].own
    assert made is not None
    said = made().help(robot(make_services, told=TOLD).view)
    assert said.intentions[0].text == "Cook a meal"
    assert [task.act.object for task in said.tasks if task.accepted] == ["ladle", "spoon"]  # type: ignore[union-attr]
    nothing = made().help(robot(make_services, day=0).view)
    assert nothing.tasks == []
    assert nothing.fallbacks == ["nothing has been told yet"]


def test_a_habit_of_type_1_puts_one_of_the_things_where_they_were_put(make_services: MakeServices) -> None:
    made = METHODS["habit"].own
    assert made is not None
    tidying = ["put the mug on the desk", "put the book on the sofa", "put the vase on the sofa"]
    seen = Observation(first_task="put the mug on the desk")
    view = robot(make_services, collab=1, seen=seen, told={10: ("Tidy up", tidying), 34: ("Tidy up", tidying)}).view
    said = made().help(view)
    assert [task.act.describe() for task in said.tasks if task.accepted] == ["put the book on the sofa"]
    assert FakeHome().movable["book_1"][0] == said.tasks[0].act.object_id  # type: ignore[union-attr]


class Sure(TableClassifier):
    """Knows one chance for all."""

    def __init__(self, p: float, chances: bool) -> None:
        super().__init__()
        self.p, self.gives_chances = p, chances

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        return [self.p] * len(examples)


@pytest.mark.parametrize(
    ("p", "chances", "method", "accepted"),
    [
        (0.4, True, "ours", True),  # worth it for the person's needs
        (0.3, True, "ours", False),
        (0.4, False, "ours", False),  # the classifier has put its place to decide at 0.5
        (0.6, False, "ours", True),
        (0.4, True, "paper", False),
    ],
)
def test_a_chance_is_accepted_where_it_pays_for_needs_and_any_other_verdict_from_a_half(
    make_services: MakeServices, p: float, chances: bool, method: str, accepted: bool
) -> None:
    ctx = robot(make_services, method=method)
    ctx.learner.classifiers["task"] = Sure(p, chances)
    tasks = watch(ctx).tasks
    assert tasks
    assert {task.accepted for task in tasks} == {accepted}


def test_a_told_hour_counts_once_for_a_thing_however_often_it_was_used_in_it() -> None:
    def hour(now: int, *uses: Use) -> ToldHour:
        return ToldHour(now, "cook", (), uses, near=1.0, looks=1.0, wide=1.0)

    told = [
        hour(9, Use("pot", "stove"), Use("Pot", "table"), Use("pot", "stove")),
        hour(10, Use("novel")),
        hour(11, Use("spoon"), Use("pot")),
    ]
    uses, weights = uses_of(told), [0.5, 0.25, 0.125]
    assert used_in(uses, Use("pot")) == [0, 2]
    assert used_in(uses, Use("pot", "table")) == [0, 2], "where no place was named, it may be this one"
    assert used_in(uses, Use("novel", "sofa")) == [1]
    assert used_in(uses, Use("ladle")) == []
    assert share([0, 2], weights, usual=0.5, patience=1.0) == pytest.approx((0.625 + 0.5) / (0.875 + 1.0))
