"""A person through and through: stated facts bind, reasons are one's own, ids do not matter, and changes show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from coopera.core.clock import Clock
from coopera.core.household import plain
from coopera.evaluation.people.divergence import jensen_shannon
from coopera.models.offline.household.knowledge import key, shipped
from coopera.models.offline.household.reading import class_of
from coopera.models.offline.human.persona import shipped_aspects
from coopera.models.offline.human.verdicts import serves_from
from tests.models.offline.lives import lived, of_hours, share, somebody
from tests.models.offline.questions import (
    FIXED,
    MOVABLE,
    activity,
    as_tasks,
    ask,
    intend,
    left_by,
    live,
    memory,
    person,
    when,
)

WHEELCHAIR = "I use a wheelchair since an accident. I love music and sports. I like to dance and to run."
VEGAN = "I am a vegan. I love to cook and bake for my friends."
ALLERGIC = "I am allergic to eggs and peanuts. I love to bake."
TEETOTAL = "I do not drink alcohol. I love to have guests and to relax in the evening."
DAIRY = {"milk carton", "cheese", "butter", "egg", "yogurt cup", "ice cream tub", "tuna can"}
PETS = {"leash", "dog treat", "feather wand", "litter scoop", "litter bag", "pet brush", "clicker"}
HOBBY = {"text": "I have taken up painting", "more": {"paint": 4.0}, "never": [], "work": None, "strength": 1.0}


def _hours(who: dict[str, Any], days: int = 8) -> list[tuple[str, list[Any]]]:
    """Activity and acts of each hour in both collaboration types, with both reflections: 208 hours in 8 days."""
    hours = []
    for day in range(days):
        for hour, text in enumerate(live(who, day), start=9):
            acts = [act for collab in (1, 2) for act in _acts(who, text, day, hour, collab)]
            hours.append((activity(text), acts))
    return hours


def _acts(who: dict[str, Any], text: str, day: int, hour: int, collab: int) -> list[Any]:
    now = {**when(day, hour), **who, "intention": text, "fixed": FIXED}
    home: dict[str, Any] = {"movable": MOVABLE} if collab == 1 else {"motions": []}
    things: dict[str, Any] = {"movable": MOVABLE} if collab == 1 else {}
    nothing: dict[str, Any] = {"recalled_intentions": [], "recalled_tasks": []}
    count = 3 if collab == 1 else 5
    seed = 100 * day + hour
    drafts = ask(f"human/tasks_type{collab}", seed=seed, **now, **nothing, **home, n_tasks=count).tasks
    tasks = as_tasks(drafts)
    found = [f"Task {tasks[0]['id']}: it does not go."]
    first = ask(f"human/reflect_profile_type{collab}", seed=seed, **now, **nothing, **things, tasks=tasks)
    scene = ask(
        f"human/reflect_scene_type{collab}", seed=seed, **now, **home, tasks=tasks, n_tasks=count, findings=found
    )
    return [*(task.act for task in drafts), *left_by(first, tasks), *left_by(scene, tasks)]


def _touched(hours: Sequence[tuple[str, Sequence[Any]]]) -> set[str]:
    acts = [act for _, some in hours for act in some]
    return {act.in_hand if hasattr(act, "in_hand") else plain(class_of(act.object)) for act in acts}


@pytest.mark.parametrize(
    ("says", "activities", "things", "motions"),
    [
        (WHEELCHAIR, {"cardio", "sing"}, {"jump rope", "running shoes"}, {"dance", "jump rope", "kick", "do squats"}),
        (VEGAN, set(), DAIRY, set()),
        (ALLERGIC, set(), {"egg", "nuts"}, set()),
        (TEETOTAL, set(), {"wine bottle", "beer can"}, set()),
        ("I am retired. I have no pets.", {"pet_play", "pet_care", "desk_work"}, PETS, set()),
    ],
    ids=["wheelchair", "vegan", "allergic", "teetotal", "no pet"],
)
def test_what_is_stated_binds_in_two_hundred_hours_of_both_collaboration_types(
    says: str, activities: set[str], things: set[str], motions: set[str]
) -> None:
    hours = _hours(person(profile=says))
    facts = somebody(says).facts
    assert activities <= facts.never
    assert things <= facts.never_things
    assert motions <= facts.never_motions
    assert 2 * len(hours) >= 200
    assert not {doing for doing, _ in hours} & facts.never
    assert not _touched(hours) & facts.never_things
    assert not {getattr(act, "motion", "") for _, acts in hours for act in acts} & facts.never_motions


def test_without_the_statement_the_same_things_are_taken() -> None:
    touched = _touched(_hours(person(profile="I love to cook and bake for my friends. I like to relax."), 5))
    assert touched & DAIRY
    assert "wine bottle" in touched


def test_in_a_home_of_forbidden_things_a_teetotaller_puts_anything_else_away() -> None:
    movable = {name: MOVABLE[name] for name in ("wine_bottle_1", "mug_1", "book_1", "plate_1")}
    for who, drinks in ((person(profile="I love to read."), True), (person(profile=TEETOTAL), False)):
        placed: set[str] = set()
        for known in shipped().activities:
            given: dict[str, Any] = {"recalled_intentions": [], "recalled_tasks": [], "movable": movable}
            now = {**when(0, 10), **who, "intention": known.canonical[0], "fixed": FIXED, "n_tasks": 3}
            placed |= {class_of(task.act.object) for task in ask("human/tasks_type1", **now, **given).tasks}
        assert ("wine_bottle" in placed) == drinks


def test_reasons_quote_the_persons_own_sentences_alone_and_say_habit_where_there_is_none() -> None:
    own = "I love to bake cookies. I am a sports fan."
    borrowed = [one.says for aspect in shipped_aspects() for one in aspect.statements[:2]]
    who = person(profile=" ".join([own, *(f"{says}." for says in borrowed)]), openness=4.5)
    reasons = [
        intend(who, hour, seed=seed, day=day).reason_human
        for seed in range(8)
        for day in (0, 5)
        for hour in range(9, 22)
    ]
    quoted = {key(part.split('"')[0]) for reason in reasons for part in reason.split('I say of myself: "')[1:]}
    assert quoted
    assert quoted <= {key(sentence) for sentence in own.split(". ")}
    assert not quoted & {key(sentence) for sentence in borrowed}
    said = [reason for reason in reasons if "I say of myself" not in reason and " speaks for it" not in reason]
    assert said
    assert all("habit" in reason for reason in said)


def test_reasons_of_tasks_quote_nobody_else_either() -> None:
    borrowed = [one.says for aspect in shipped_aspects() for one in aspect.statements[:2]]
    who = person(profile=" ".join(["I love to bake cookies.", *(f"{says}." for says in borrowed)]))
    for known in shipped().activities:
        given: dict[str, Any] = {"recalled_intentions": [], "recalled_tasks": [], "motions": [], "fixed": FIXED}
        now = {**when(0, 10), **who, "intention": known.canonical[0], "n_tasks": 5}
        for task in ask("human/tasks_type2", **now, **given).tasks:
            if "I say of myself" in task.reason_human:
                assert "bake cookies" in task.reason_human
            else:
                assert "It is a habit" in task.reason_human


def _spent(profile: str, seed: int) -> np.ndarray:
    """Shares of the activities in 20 days of a person whose draws come from `seed`, as another id's do."""
    index = shipped().index
    days = lived(somebody(profile), 20, seed=seed)
    return np.bincount([index[hour.doing] for day in days for hour in day], minlength=len(index)) / (20 * 13)


def test_the_same_persona_under_two_ids_lives_alike_and_two_personas_do_not() -> None:
    profiles = ["I love to bake. I am retired.", "I work hard. I play video games.", "I knit and read.", VEGAN]
    same = [jensen_shannon(_spent(one, 1), _spent(one, 2)) for one in profiles]
    others = [jensen_shannon(_spent(one, 1), _spent(other, 2)) for one, other in combinations(profiles, 2)]
    assert max(same) < min(others)
    assert 2 * np.mean(same) < np.mean(others)


def _with(*changes: Mapping[str, Any]) -> list[Any]:
    return lived(somebody("I am retired. I like it quiet."), 20, changes=changes)


def test_a_new_hobby_is_taken_up_and_one_that_has_not_begun_is_not() -> None:
    usual, hobby = of_hours(_with(), "paint"), of_hours(_with(HOBBY), "paint")
    half = of_hours(_with({**HOBBY, "strength": 0.5}), "paint")
    assert usual < half < hobby
    assert hobby > usual + 0.1
    assert _with({**HOBBY, "strength": 0.0}) == _with()


def test_what_stops_is_done_no_longer_while_all_else_goes_on() -> None:
    assert share(_with(), "watch_series") > 0
    over = _with(
        {"text": "The television is broken", "more": {}, "never": ["watch_series"], "work": None, "strength": 1.0}
    )
    assert share(over, "watch_series") == 0
    assert share(over, "lunch") > 0.9


def test_what_a_household_does_not_have_changes_nothing() -> None:
    assert _with({"text": "x", "more": {"fly": 9.0}, "never": ["fly"], "work": None, "strength": 1.0}) == _with()


def test_what_is_different_is_given_as_the_reason_for_what_it_speaks_for_and_for_nothing_else() -> None:
    who = person(profile="I am retired. I like it quiet.")
    for day in (0, 5):
        for seed in range(20):
            reply = intend(who, 15, seed=seed, day=day, changes=[HOBBY])
            assert (HOBBY["text"] in reply.reason_human) == (activity(reply.intention) == "paint")
    painted = [intend(who, 15, seed=seed, changes=[HOBBY]).reason_human for seed in range(40)]
    assert any(reason.startswith("I have taken up painting.") for reason in painted)
    now = Clock(day=0, hour=15)
    faded = [
        intend(who, 15, seed=s, changes=[{**HOBBY, "strength": 0.0}], today=[memory("Paint", 0, 9, now)])
        for s in range(20)
    ]
    assert not any(HOBBY["text"] in reply.reason_human for reply in faded)


def test_the_line_from_which_things_serve_is_ones_own_every_evening_and_lower_for_the_agreeable() -> None:
    names = [f"I am called {n}." for n in range(200)]
    lines = [serves_from({**when(3, 20), **person(profile=says)}) for says in names]
    assert lines == [serves_from({**when(9, 21), **person("other", says)}) for says in names]
    assert len(set(lines)) == len(names)
    assert np.mean(lines) == pytest.approx(0.6, abs=0.02)
    assert 0.03 < np.std(lines) < 0.07
    for says, line in zip(names, lines, strict=True):
        kind, stern = (serves_from(person(profile=says, agreeableness=a)) for a in (5.0, 1.0))
        assert kind < line < stern


def test_the_own_line_decides_the_evenings_answer() -> None:
    names = [f"I am called {n}." for n in range(40)]
    act = {"target_id": 1, "target": "kitchen_counter_1", "in_hand": "big red mixing bowl", "motion": "stir a pot"}
    text = "stir a pot at the kitchen counter with the big red mixing bowl in hand"
    tasks = [{"id": "9.1", "thought": "", "text": text, "act": act}]
    offers = [
        {"thought": "", "text": f"bring the {thing}"} for thing in ("red mixing bowl", "red mixing pot", "guitar")
    ]
    said = set()
    for says in names:
        given = {**when(0, 10), **person(profile=says), "intention": "Make a homemade treat"}
        answers = [v.yes for v in ask("human/feedback_tasks", **given, tasks=tasks, offers=offers).verdicts]
        said.add(tuple(answers))
        assert not answers[-1]
    assert len(said) > 1
