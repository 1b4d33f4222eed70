"""Tasks of the person and of the robot: executable, distinct, in order, fitting, and a person's own."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.affordances import affordances
from coopera.core.clock import Clock
from coopera.core.errors import ModelCallError
from coopera.core.household import plain
from coopera.models.offline.household.knowledge import Activity, shipped
from coopera.models.offline.household.reading import Surroundings, class_of
from tests.models.offline.lives import somebody
from tests.models.offline.questions import FIXED, MOVABLE, as_tasks, ask, left_by, memory, person, when

BAKE = "Make a homemade treat"
KEEPER = person(profile="I love to bake. I am a neat person. I have a dog and a cat.")
_NOTHING: dict[str, Any] = {"recalled_intentions": [], "recalled_tasks": []}


def _known(name: str) -> Activity:
    return shipped().activities[shipped().index[name]]


def _wished(who: dict[str, Any], activity: Activity) -> set[tuple[str, str]]:
    """What such a person puts where for an activity."""
    return set(somebody(who["profile"], **who["big_five"]).at_home(activity, Surroundings(FIXED)).places)


def _moves(who: dict[str, Any], intention: str = BAKE, *, seed: int = 0, n: int = 5, **changed: Any) -> Any:
    given_ = {**when(0, 10), **who, **_NOTHING, "fixed": FIXED, "motions": ["dance"], **changed}
    return ask("human/tasks_type2", seed=seed, **given_, intention=intention, n_tasks=n).tasks


def _places(who: dict[str, Any], intention: str = BAKE, *, seed: int = 0, n: int = 3, **changed: Any) -> Any:
    given_ = {**when(0, 10), **who, **_NOTHING, "fixed": FIXED, "movable": MOVABLE, **changed}
    return ask("human/tasks_type1", seed=seed, **given_, intention=intention, n_tasks=n).tasks


@pytest.mark.parametrize("known", shipped().activities, ids=lambda a: a.id)
def test_every_wording_of_every_activity_becomes_that_activitys_tasks(known: Activity) -> None:
    for seed, wording in enumerate([*known.canonical, f"Carry on: {known.canonical[0]}, full of energy"]):
        moves = _moves(KEEPER, wording, seed=seed)
        assert [task.act.in_hand in known.things for task in moves] == [True] * 5
        assert len({task.act.in_hand for task in moves}) == 5
        assert {class_of(task.act.target) for task in moves} <= set(known.fixed)
        assert {task.act.motion for task in moves} <= set(known.all_motions)
        assert [t.act for t in moves if t.act.motion not in shipped().uses[t.act.in_hand]] == []
        assert [t.act for t in moves if not affordances().suits(t.act.motion, class_of(t.act.target))] == []
        places = _places(KEEPER, wording, seed=seed)
        assert {(class_of(t.act.object), class_of(t.act.receptacle)) for t in places} <= _wished(KEEPER, known)
        assert len({task.act.describe() for task in places}) == 3


def test_tasks_come_in_the_order_in_which_things_come_into_play() -> None:
    order = list(_known("bake").things)
    for seed in range(10):
        turns = [order.index(task.act.in_hand) for task in _moves(person(), seed=seed)]
        assert turns == sorted(turns)


def test_who_has_no_pet_takes_nothing_of_a_pets_in_hand() -> None:
    play = _known("pet_play").canonical[0]
    owns, lacks = ({t.act.in_hand for s in range(8) for t in _moves(who, play, seed=s)} for who in (KEEPER, person()))
    assert {"leash", "feather wand", "dog treat"} & owns
    assert not {"leash", "feather wand", "dog treat"} & lacks


def test_a_person_keeps_to_favourites_and_another_has_others() -> None:
    def things(name: str) -> list[set[str]]:
        says = f"I am called {name}. I love to bake."
        return [{task.act.in_hand for task in _moves(person(profile=says), seed=seed)} for seed in range(12)]

    lives = {name: things(name) for name in ("anna", "berta", "carla", "dora")}
    same = [len(a & b) / 5 for life in lives.values() for a in life for b in life if a is not b]
    others = [len(a & b) / 5 for n in lives for m in lives if n < m for a in lives[n] for b in lives[m]]
    assert np.mean(same) > np.mean(others) + 0.1
    assert len({frozenset(some) for life in lives.values() for some in life}) > 4


def test_an_intention_in_other_words_is_understood_by_likeness() -> None:
    tasks = _moves(person(), "I will read a good story in peace now")
    assert {task.act.in_hand for task in tasks} <= set(_known("read").things)


def test_what_was_in_hand_today_is_preferred_and_named_in_the_reason() -> None:
    now = Clock(day=0, hour=10)
    before = [memory("stir a pot at the stove with the whisk in hand", 0, 9, now)]
    plainly = sum("whisk" in [t.act.in_hand for t in _moves(person(), seed=s)] for s in range(60))
    reminded = [_moves(person(), seed=s, recalled_tasks=before) for s in range(60)]
    assert sum("whisk" in [t.act.in_hand for t in tasks] for tasks in reminded) >= plainly
    reasons = [t.reason_tasks for tasks in reminded for t in tasks if t.act.in_hand == "whisk"]
    assert reasons
    assert all("already had the whisk" in reason for reason in reasons)


_SOME_FIXED = st.sets(st.sampled_from(sorted(FIXED)), min_size=1, max_size=8)
_SOME_MOVABLE = st.sets(st.sampled_from(sorted(MOVABLE)), min_size=1, max_size=8)
_WORDINGS = st.sampled_from([a.canonical[0] for a in shipped().activities])


@settings(max_examples=40)
@given(_SOME_FIXED, _SOME_MOVABLE, _WORDINGS, st.integers(0, 2**60))
def test_in_any_home_person_and_robot_give_as_many_distinct_executable_tasks_as_there_can_be(
    some_fixed: set[str], some_movable: set[str], intention: str, seed: int
) -> None:
    fixed = {name: FIXED[name] for name in sorted(some_fixed)}
    movable = {name: MOVABLE[name] for name in sorted(some_movable)}
    possible = len({class_of(name) for name in movable}) * len({class_of(name) for name in fixed})
    told = {"intention": intention, "n_tasks": 3, "fixed": fixed, "movable": movable, **when(0, 10), **_NOTHING}
    robot = {"big_five": None, "profile": None, "first_task": None}
    for tasks in (
        ask("human/tasks_type1", seed=seed, **told, **person()).tasks,
        ask("robot/tasks_type1", seed=seed, **told, **robot).tasks,
    ):
        assert len({task.act.describe() for task in tasks}) == len(tasks) >= min(3, possible)
        for task in tasks:
            assert movable[task.act.object][0] == task.act.object_id
            assert fixed[task.act.receptacle][0] == task.act.receptacle_id
    moves = _moves(person(), intention, seed=seed, fixed=fixed)
    assert [fixed[task.act.target][0] for task in moves] == [task.act.target_id for task in moves]
    assert len({task.act.in_hand for task in moves}) == 5


def test_a_home_without_anything_to_do_tasks_with_is_said() -> None:
    with pytest.raises(ModelCallError, match="no movable or no fixed object"):
        _places(person(), movable={})
    with pytest.raises(ModelCallError, match="no fixed object"):
        _moves(person(), fixed={})


def _robot(prompt: str, seed: int = 0, **changed: Any) -> Any:
    extra = {"movable": MOVABLE, "first_task": None, "n_tasks": 3} if prompt.endswith("1") else {"n_tasks": 5}
    asked = {
        **when(1, 10),
        **_NOTHING,
        "big_five": None,
        "profile": None,
        "intention": BAKE,
        "fixed": FIXED,
        **extra,
        **changed,
    }
    return ask(prompt, seed=seed, **asked).tasks


def test_the_robot_brings_what_the_activity_needs_and_other_things_at_other_times() -> None:
    batches = [{task.act.object for task in _robot("robot/tasks_type2", seed)} for seed in range(10)]
    assert all(batch <= set(_known("bake").things) and len(batch) == 5 for batch in batches)
    assert len({frozenset(batch) for batch in batches}) > 3


def test_the_robot_brings_what_it_remembers_the_person_using() -> None:
    now = Clock(day=1, hour=10)
    used = [memory("stir a pot at the kitchen counter with the mixing bowl in hand", 0, 10, now)]

    def brought(recalled: list[dict[str, Any]]) -> int:
        return sum(
            "mixing bowl" in [t.act.object for t in _robot("robot/tasks_type2", seed, recalled_tasks=recalled)]
            for seed in range(40)
        )

    assert brought([]) < 32 < brought(used)


def test_the_robot_does_not_do_again_what_the_person_is_doing() -> None:
    for seed in range(20):
        done = f"put the {plain('sugar_box')} on the {plain('kitchen_counter')}"
        texts = [task.act.describe() for task in _robot("robot/tasks_type1", seed, first_task=done)]
        assert len(texts) == 3
        assert done not in texts


def test_the_robot_puts_things_where_it_remembers_them_put() -> None:
    now = Clock(day=1, hour=10)
    used = [memory("put the tray on the dining table", 0, 10, now)]
    texts = [[t.act.describe() for t in _robot("robot/tasks_type1", s, recalled_tasks=used)] for s in range(30)]
    assert sum("put the tray on the dining table" in some for some in texts) > 20


class Reflected(NamedTuple):
    """What a reflection said of each task, and the acts that it leaves."""

    reviews: list[Any]
    acts: list[Any]


def _reflect(prompt: str, tasks: Any, who: dict[str, Any] | None = None, **changed: Any) -> Any:
    extra: dict[str, Any] = {"movable": MOVABLE} if prompt.endswith("1") else {}
    extra |= who or person()
    if "scene" in prompt:
        extra |= {"n_tasks": 3 if prompt.endswith("1") else 5, "findings": []}
        extra |= {"motions": []} if prompt.endswith("2") else {}
    else:
        extra |= _NOTHING
    given_ = {**when(0, 10), "intention": BAKE, "fixed": FIXED, **extra, **changed}
    given_["tasks"] = tasks if isinstance(tasks[0], dict) else as_tasks(tasks)
    reply = ask(prompt, **given_)
    return Reflected(reply.reviews, left_by(reply, given_["tasks"]))


def test_the_first_reflection_moves_a_motion_to_where_it_can_be_made() -> None:
    tasks = as_tasks(_moves(person()))
    tasks[0]["act"] |= {"motion": "knead dough", "target": "stove_1", "target_id": FIXED["stove_1"][0]}
    reply = _reflect("human/reflect_profile_type2", tasks)
    assert "nobody would knead dough at the stove" in reply.reviews[0].reason
    moved = next(act for act in reply.acts if act.motion == "knead dough")
    assert class_of(moved.target) in ("kitchen_counter", "kitchen_cabinet", "dining_table")


def test_a_home_without_the_usual_places_still_puts_things_where_somebody_would() -> None:
    fixed = {name: FIXED[name] for name in ("fridge_1", "kitchen_counter_1", "bookshelf_1")}
    movable = {name: MOVABLE[name] for name in ("glass_1", "mug_1", "book_1", "plate_1", "tuna_can_1", "spoon_1")}
    placed = {
        (class_of(t.act.object), class_of(t.act.receptacle)) for t in _places(person(), fixed=fixed, movable=movable)
    }
    assert placed <= shipped().usual_places


@pytest.mark.parametrize("kind", ["type1", "type2"])
def test_good_tasks_pass_both_reflections_unchanged(kind: str) -> None:
    tasks = as_tasks(_places(person()) if kind == "type1" else _moves(person()))
    fitting = _reflect(f"human/reflect_profile_{kind}", tasks).acts
    for task, act in zip(tasks, fitting, strict=True):
        task |= {"act": act.model_dump(exclude={"kind"}), "text": act.describe()}
    for node in ("profile", "scene"):
        reply = _reflect(f"human/reflect_{node}_{kind}", tasks)
        assert [v.yes for v in reply.reviews] == [True] * len(tasks)
        assert [review.task for review in reply.reviews] == [None] * len(tasks)
        assert [act.describe() for act in reply.acts] == [task["text"] for task in tasks]


def test_the_first_reflection_throws_out_what_is_of_no_use_or_repeated_or_out_of_place() -> None:
    tasks = as_tasks(_moves(person()))
    tasks[1]["act"] = {**tasks[1]["act"], "in_hand": "chainsaw"}
    tasks[2]["act"] = {**tasks[2]["act"], "in_hand": tasks[0]["act"]["in_hand"]}
    tasks[3]["act"] = {**tasks[3]["act"], "target": "bathtub_1", "target_id": FIXED["bathtub_1"][0]}
    reply = _reflect("human/reflect_profile_type2", tasks)
    assert [v.yes for v in reply.reviews][:4] == [True, False, False, False]
    assert "chainsaw is of no use" in reply.reviews[1].reason
    assert "already" in reply.reviews[2].reason
    assert "bathtub is not the place" in reply.reviews[3].reason
    assert len({act.in_hand for act in reply.acts} & set(_known("bake").things)) == 5
    assert {class_of(act.target) for act in reply.acts} <= set(_known("bake").fixed)


def test_the_first_reflection_breaks_monotony_and_mends_the_order() -> None:
    tasks = as_tasks(_moves(person()))[::-1]
    for number, task in enumerate(tasks, start=1):
        task["act"] = {**task["act"], "motion": "stir a pot"}
        task["id"] = f"10.{number}"
    reply = _reflect("human/reflect_profile_type2", tasks)
    assert [act.motion for act in reply.acts].count("stir a pot") <= 3
    order = [list(_known("bake").things).index(act.in_hand) for act in reply.acts]
    assert order == sorted(order)
    assert any("needed earlier" in v.reason for v in reply.reviews)


def test_the_first_reflection_puts_things_as_this_person_does() -> None:
    tasks = as_tasks(_places(person()))
    tasks[0]["act"] |= {"object": "toy_car_1", "object_id": MOVABLE["toy_car_1"][0]}
    reply = _reflect("human/reflect_profile_type1", tasks)
    assert [v.yes for v in reply.reviews] == [False, True, True]
    assert {(class_of(act.object), class_of(act.receptacle)) for act in reply.acts} <= _wished(person(), _known("bake"))


@pytest.mark.parametrize("kind", ["type1", "type2"])
def test_the_second_reflection_mends_names_and_ids_that_do_not_exist(kind: str) -> None:
    spot, number = ("receptacle", "receptacle_id") if kind == "type1" else ("target", "target_id")
    tasks = as_tasks(_places(person()) if kind == "type1" else _moves(person()))
    tasks[0]["act"] = {**tasks[0]["act"], spot: "kitchen_counter_99", number: 4711}
    tasks[1]["act"] = {**tasks[1]["act"], number: 4711}
    reply = _reflect(f"human/reflect_scene_{kind}", tasks)
    assert [v.yes for v in reply.reviews[:3]] == [False, False, True]
    assert getattr(reply.acts[0], spot) == "kitchen_counter_1"
    assert all(FIXED[getattr(act, spot)][0] == getattr(act, number) for act in reply.acts)


@pytest.mark.parametrize("kind", ["type1", "type2"])
def test_the_second_reflection_has_just_as_many_tasks_as_asked_for(kind: str) -> None:
    tasks = as_tasks(_places(person()) if kind == "type1" else _moves(person()))
    for n_tasks in (1, 2, 3, 5):
        reply = _reflect(f"human/reflect_scene_{kind}", tasks, n_tasks=n_tasks)
        assert len({act.describe() for act in reply.acts}) == n_tasks == len(reply.acts)
        assert len(reply.reviews) == len(tasks)


@pytest.mark.parametrize("kind", ["type1", "type2"])
def test_what_was_found_wrong_about_a_task_is_obeyed(kind: str) -> None:
    tasks = as_tasks(_places(person()) if kind == "type1" else _moves(person()))
    found = [f"Task 10.2: the {tasks[1]['text']} cannot be done, somebody sleeps there.", "The weather is bad."]
    reply = _reflect(f"human/reflect_scene_{kind}", tasks, findings=found)
    assert [v.yes for v in reply.reviews][:3] == [True, False, True]
    assert reply.reviews[1].reason == found[0]
    assert reply.acts[1].describe() != tasks[1]["text"]
    assert reply.acts[0].describe() == tasks[0]["text"]
    assert len(reply.acts) == len(tasks)


def test_a_persons_own_words_say_whether_a_thing_goes_on_or_in() -> None:
    steps = ["put the plate on the dishwasher", "lay the book in the wardrobe", "carry the shirt to the wardrobe"]
    placed = [t.act.describe() for t in _places(person(), steps=[*steps, "put the mug in the sofa"], n=4)]
    assert placed == [
        "put the plate on the dishwasher",
        "put the book in the wardrobe",
        "put the shirt in the wardrobe",
        "put the mug on the sofa",
    ]


def test_the_second_reflection_leaves_it_to_the_person_whether_a_thing_goes_on_or_in() -> None:
    tasks = as_tasks(_places(person(), steps=["put the plate on the dishwasher", "put the spoon in the dishwasher"]))
    kept = [act.describe() for act in _reflect("human/reflect_scene_type1", tasks, n_tasks=2).acts]
    assert kept == [task["text"] for task in tasks]
