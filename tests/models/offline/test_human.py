"""A person's days: lifelike, never the same thing twice, and nobody's but this person's."""

from __future__ import annotations

import re
from collections import Counter
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.clock import Clock
from coopera.core.naming import plain
from coopera.evaluation.people.divergence import jensen_shannon
from coopera.models.offline.household.knowledge import shipped
from coopera.models.offline.household.statements import statements
from tests.models.offline.questions import FIXED, MOVABLE, ROOMS, activity, ask, intend, live, memory, person

PEOPLE = [
    person("mara", "I love to bake cookies. I love talking with my family and friends.", extroversion=4.5),
    person("tom", "I play video games and stream them. I work hard in my job and career.", extroversion=1.5),
    person("ida", "I am a neat and organized person. I love to read books.", conscientiousness=4.8, openness=4.0),
    person("lee", "I work out and lift weights. I am a sports fan.", neuroticism=1.5, openness=1.8),
]


_UNTIL_4 = (("breakfast", 9), ("wash_up", 10), ("bath", 11), ("lunch", 12), ("tidy", 13))


@lru_cache(maxsize=1)
def _lives() -> list[list[list[str]]]:
    """Five days of each of PEOPLE."""
    return [[live(who, day, seed=1) for day in range(5)] for who in PEOPLE]


def _days() -> list[list[str]]:
    return [[activity(text) for text in day] for life in _lives() for day in life]


def test_a_day_planned_at_once_has_an_intention_for_each_hour_and_none_twice_within_three() -> None:
    labels = [Clock(day=0, hour=hour).label for hour in range(9, 22)]
    reply = ask(
        "human/day", weekday="Monday", day=0, **PEOPLE[0], rooms=ROOMS, fixed=FIXED, movable={}, hours=labels, seed=3
    )
    plan = [activity(one.intention) for one in reply.intentions]
    assert len(plan) == 13
    assert all(len(set(plan[i : i + 3])) == 3 for i in range(11))


def test_the_same_seed_gives_the_same_day_and_another_a_different_one() -> None:
    assert live(PEOPLE[0], seed=7) == live(PEOPLE[0], seed=7)
    assert live(PEOPLE[0], seed=7) != live(PEOPLE[0], seed=8)


def test_nothing_is_done_twice_a_day_but_what_bears_repeating_three_hours_later() -> None:
    repeatable = {known.id for known in shipped().activities if known.repeatable}
    repeats = 0
    for day in _days():
        for hour, doing in enumerate(day):
            if doing in day[:hour]:
                repeats += 1
                assert doing in repeatable
                assert doing not in day[max(hour - 2, 0) : hour]
    assert repeats > 0


def test_meals_come_at_mealtimes_on_most_days_and_the_night_is_prepared_at_night() -> None:
    hours: dict[str, Counter[int]] = {}
    for day in _days():
        for hour, doing in enumerate(day, start=9):
            hours.setdefault(doing, Counter())[hour] += 1
    days = len(_days())
    assert sum(hours["lunch"][h] for h in (11, 12, 13, 14)) >= 0.7 * days
    assert sum(hours["dinner"][h] for h in (17, 18, 19, 20)) >= 0.6 * days
    nights = hours["bedtime"] + hours.get("sleep", Counter())
    assert not set(nights) - {19, 20, 21}
    assert nights[21] >= 0.25 * days  # sleep begins at 21 for some and later for others
    assert sum(hours["breakfast"].values()) >= 0.8 * days
    assert not set(hours["breakfast"]) - {9, 10, 11}
    assert not set(hours["lunch"]) - {10, 11, 12, 13, 14, 15, 16}


def test_after_the_evening_routine_only_quiet_things_follow() -> None:
    known = shipped().activities[shipped().index["bedtime"]]
    nights = [day[day.index("bedtime") + 1 :] for day in _days() if "bedtime" in day]
    today = [memory(known.canonical[0], 0, 20, Clock(day=0, hour=21))]
    late = {activity(intend(PEOPLE[0], 21, seed=s, today=today).intention) for s in range(40)}
    assert 3 <= len(late) <= len(known.follows)
    assert late | {doing for night in nights for doing in night} <= set(known.follows)


def test_people_differ_from_each_other_more_than_from_themselves() -> None:
    ids = list(shipped().index)

    def what(day: list[str]) -> np.ndarray:
        return np.bincount([ids.index(activity(text)) for text in day], minlength=len(ids)) / len(day)

    lives = [[what(day) for day in life] for life in _lives()]
    within = [jensen_shannon(a, b) for life in lives for i, a in enumerate(life) for b in life[:i]]
    between = [jensen_shannon(a, b) for i, life in enumerate(lives) for other in lives[:i] for a in life for b in other]
    assert np.mean(between) > np.mean(within) + 0.1


def test_what_the_profile_says_and_what_the_traits_say_shows_in_the_days() -> None:
    count = [Counter(activity(text) for day in life for text in day) for life in _lives()]
    mara, tom, ida, lee = count
    assert mara["bake"] + mara["call"] > max(other["bake"] + other["call"] for other in (tom, ida, lee))
    assert tom["video_games"] > max(other["video_games"] for other in (mara, ida, lee))
    assert lee["strength"] + lee["sports_tv"] > max(c["strength"] + c["sports_tv"] for c in (mara, tom, ida))
    chores = [
        sum(
            activity(text) in ("tidy", "dust", "sweep")
            for n in range(20)
            for text in live(person(profile=f"I am retired. I am number {n}.", conscientiousness=c))
        )
        for c in (1, 5)
    ]
    assert chores[1] > 2 * chores[0]


def test_the_same_persona_under_another_id_is_the_same_person_whose_days_differ_by_the_draws_alone() -> None:
    assert live(person("anna"), seed=1) == live(person("berta"), seed=1)
    assert live(person("anna"), seed=1) != live(person("berta"), seed=2)
    assert live(person("anna", "I read."), seed=1) != live(person("anna", "I read a lot."), seed=1)


def test_a_person_is_the_same_whatever_the_name_on_the_door() -> None:
    assert live(person("anna")) == live({**person("anna"), "name": "Somebody Else"})


@settings(max_examples=15)
@given(st.sets(st.sampled_from(ROOMS), min_size=1), st.integers(9, 21), st.integers(0, 2**40))
def test_only_what_the_home_has_rooms_for_is_intended(rooms: set[str], hour: int, seed: int) -> None:
    doing = activity(intend(person(), hour, seed=seed, rooms=sorted(rooms)).intention)
    known = shipped().activities[shipped().index[doing]]
    assert rooms & set(known.rooms)


def test_a_second_bedroom_is_a_bedroom_and_a_strange_home_stops_nobody() -> None:
    doing = {activity(intend(person(), 21, seed=seed, rooms=["bedroom 2"]).intention) for seed in range(10)}
    assert all("bedroom" in shipped().activities[shipped().index[d]].rooms for d in doing)
    assert intend(person(), 12, rooms=["dungeon"]).intention


def test_a_low_temperature_makes_habits_of_chances() -> None:
    def variety(temperature: float) -> int:
        return len({activity(intend(PEOPLE[1], 15, seed=s, temperature=temperature).intention) for s in range(30)})

    assert variety(0.05) < variety(0.7) < variety(3.0)


def test_what_follows_depends_on_what_was_done() -> None:
    def after(text: str) -> int:
        now = Clock(day=0, hour=14)
        today = [memory(text, 0, 13, now)]
        return sum(activity(intend(PEOPLE[0], 14, seed=s, today=today).intention) == "dishes" for s in range(200))

    assert after("Make a simple lunch") > after("Browse around for a while")


def test_reasons_name_the_sentence_the_trait_and_the_earlier_intention_they_rely_on() -> None:
    said, traits, earlier, tasks = set(), set(), set(), set()
    now = Clock(day=0, hour=20)
    today = [memory("Make a simple lunch", 0, 12, now), memory("Learn something new", 0, 19, now)]
    recalled = [memory("chop vegetables at the stove with the tomato in hand", 0, 12, now)]
    for seed in range(60):
        reply = intend(PEOPLE[2], 20, seed=seed, today=today, recalled_tasks=recalled)
        said.add('"I love to read books"' in reply.reason_human)
        traits.add("conscientiousness of 4.8" in reply.reason_human)
        earlier.add("Learn something new" in reply.reason_intentions)
        tasks.add(recalled[0]["text"] in reply.reason_tasks)
    assert said == traits == {True, False}
    assert True in earlier
    assert tasks == {True}
    assert intend(PEOPLE[2], 9).reason_intentions == "Nothing has been done yet today."


@pytest.mark.parametrize("profile", ["", ".", "Ich backe gern.", "I " * 4000, "no\n" * 50, "🍪 cookies!"])
def test_any_profile_leads_to_a_life(profile: str) -> None:
    assert len(live(person("x", profile))) == 13


def test_sentences_are_sorted_into_habits_aversions_and_other_people() -> None:
    told = statements(
        "I love to bake. I do not drink alcohol. My sister is a pole dancer. I never skip breakfast. "
        "My father taught me to fish. I hate the color orange but I like red. She sings."
    )
    assert told.habits == ["I love to bake.", "I never skip breakfast.", "My father taught me to fish.", "I like red."]
    assert told.aversions == ["I do not drink alcohol.", "I hate the color orange"]
    assert told.others == ["My sister is a pole dancer.", "She sings."]


def test_dirty_dishes_are_washed_up_a_little_more_often_and_nothing_else_is() -> None:
    neat, now = person(profile="I am retired. I wash the dishes at once.", conscientiousness=5.0), Clock(day=0, hour=16)
    today = [memory(shipped().activities[shipped().index[done]].canonical[0], 0, hour, now) for done, hour in _UNTIL_4]

    def washing_up(states: dict[str, str]) -> int:
        wished = [activity(intend(neat, 16, seed=s, states=states, today=today).intention) for s in range(200)]
        return wished.count("dishes")

    usual = washing_up({})
    assert washing_up({"fridge_1": "open", "mug_1": "with tea in it", "sofa_1": "dirty"}) == usual
    assert usual < washing_up({"plate_2": "open, dirty"}) < 3 * usual


def test_nobody_speaks_of_the_morning_in_the_evening_or_of_tonight_at_noon() -> None:
    said = [(hour, text) for life in _lives() for day in life for hour, text in enumerate(day, start=9)]
    assert not [text for hour, text in said if hour >= 14 and "morning" in text]
    assert not [text for hour, text in said if hour < 15 and re.search("tonight|evening", text)]


def test_an_intention_says_what_it_is_done_with_and_of_furniture_only_what_the_home_has() -> None:
    fixed = {name: place for name, place in FIXED.items() if not name.startswith("sofa")}
    for hour in range(9, 22):
        brought = intend(PEOPLE[0], hour, seed=hour, fixed=fixed)
        done = shipped().activities[shipped().index[activity(brought.intention)]]
        assert 1 <= len(brought.wants) <= 12
        assert set(brought.wants) <= {plain(cls) for cls in done.fixed} - {"sofa"} | set(done.thing_names)
        moved = intend(PEOPLE[0], hour, seed=hour, fixed=fixed, movable=MOVABLE)
        assert moved.intention == brought.intention
        assert set(moved.wants) <= {plain(name) for name in (*fixed, *MOVABLE)}


def test_who_goes_out_wants_nothing_of_the_home() -> None:
    worker = person(profile="I work in an office in town.")
    replies = [intend(worker, 10, seed=seed, may_leave=True, may_go_on=True) for seed in range(8)]
    assert any(reply.away for reply in replies)
    assert all(bool(reply.wants) != reply.away for reply in replies)
