"""What is done when: needs, sleep, chores, what lasts, work and absence, over many days of many people."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from coopera.core.clock import Clock
from coopera.graphs.players.changes import Change, Work, as_variables
from coopera.models.offline.household.knowledge import FIRST, Activity, shipped
from coopera.models.offline.human.person import PrivateLife
from coopera.models.offline.human.routine import Choice, Done, Moment, choose
from tests.models.offline.lives import Hour, lived, of_hours, sense, share, somebody
from tests.models.offline.questions import activity, intend, memory, person

NAMES = ("anna", "berta", "carla", "dora", "emil", "frida", "gus", "hans", "ida", "jon", "kim", "lea", "mia", "nora")
WASHING = ("wash_up", "bath")
WEEKDAYS, WEEKENDS = range(5), (5, 6)
NURSE = "I work as a nurse at the hospital."


def _people(says: str = "") -> list[PrivateLife]:
    return [somebody(f"I am called {name}. {says}".strip()) for name in NAMES]


def _some(says: str = "", days: int = 14, *, lasting: bool = True, absence: bool = False) -> list[list[Hour]]:
    return [day for life in _people(says) for day in lived(life, days, lasting=lasting, absence=absence)]


@lru_cache(maxsize=1)
def _lasting() -> list[list[Hour]]:
    return _some(days=28)


@lru_cache(maxsize=1)
def _hourly() -> list[list[Hour]]:
    return _some(lasting=False)


def _known(name: str) -> Activity:
    return shipped().activities[shipped().index[name]]


def _on(days: list[list[Hour]], weekdays: object) -> list[list[Hour]]:
    return [day for day in days if day[0].weekday in tuple(weekdays)]  # type: ignore[arg-type]


@pytest.mark.parametrize("name", [one.id for one in shipped().activities if one.daily])
def test_a_need_is_met_on_about_the_share_of_days_that_the_file_says_and_at_its_hours(name: str) -> None:
    serving = {name, *_known(name).instead}
    for days in (_lasting(), _hourly()):
        assert share(days, *serving) == pytest.approx(_known(name).daily, abs=0.04)
        hours = Counter(hour.hour for day in days for hour in day if hour.doing == name)
        usual = np.array(_known(name).hours) / sum(_known(name).hours)
        mean = sum(hour * count for hour, count in hours.items()) / hours.total()
        if not _known(name).instead:
            assert mean == pytest.approx(FIRST + float(usual @ np.arange(len(usual))), abs=0.7)


def test_everybody_washes_on_nearly_every_day_in_their_own_way() -> None:
    ways = set()
    for life in _people():
        days = lived(life, 28)
        assert share(days, *WASHING) >= 0.85
        way = next(name for name in WASHING if life.household.index[name] in life.time.daily)
        ways.add(way)
        assert share(days, way) > share(days, *(set(WASHING) - {way}))
    assert ways == set(WASHING)


def test_who_rises_early_is_up_and_has_lunch_before_who_sleeps_late() -> None:
    early, late = _some("I am an early riser."), _some("I sleep late.")
    assert share(early, "sleep_in") < 0.05 < 0.2 < share(late, "sleep_in")

    def lunch(days: list[list[Hour]]) -> float:
        return float(np.mean([hour.hour for day in days for hour in day if hour.doing == "lunch"]))

    assert lunch(early) + 1.5 < lunch(late)


def test_sleeping_late_is_for_weekends_and_over_once_something_else_has_begun() -> None:
    assert share(_on(_lasting(), WEEKENDS), "sleep_in") > 1.5 * share(_on(_lasting(), WEEKDAYS), "sleep_in")
    for day in _lasting():
        asleep = [hour.doing == "sleep_in" for hour in day]
        assert asleep == sorted(asleep, reverse=True)


def test_a_chore_follows_its_cause_and_seldom_comes_else() -> None:
    pairs = [(before, hour) for day in _lasting() for before, hour in zip(day, day[1:], strict=False)]
    after: dict[str, list[bool]] = {}
    for before, hour in pairs:
        after.setdefault(before.doing, []).append(hour.doing == "dishes")
    causes = _known("dishes").after
    for cause in ("dinner", "lunch"):
        assert np.mean(after[cause]) == pytest.approx(causes[cause], abs=0.15)
    assert np.mean(after["dinner"]) > np.mean(after["lunch"])
    elsewhere = [yes for doing, found in after.items() if doing not in causes for yes in found]
    assert np.mean(elsewhere) < 0.05
    assert all(before.doing in causes for before, hour in pairs if hour.why == "chore")


def test_the_orderly_wash_up_at_once_more_often() -> None:
    tidy, untidy = (
        [d for name in NAMES for d in lived(somebody(f"I am {name}.", conscientiousness=c), 14)] for c in (5.0, 1.0)
    )
    assert share(tidy, "dishes") > share(untidy, "dishes") + 0.2


def test_some_things_take_hours_and_what_goes_on_is_said_to() -> None:
    for day in _lasting():
        for i, hour in enumerate(day):
            before = [earlier.doing for earlier in day[:i]]
            if hour.continues:
                assert hour.doing in before
            elif hour.doing in before:
                assert _known(hour.doing).repeatable
                assert hour.doing not in before[-2:]
    lengths = [1 + sum(h.continues for h in day if h.doing == "watch_series") for day in _lasting()]
    watched = [n for day, n in zip(_lasting(), lengths, strict=True) if any(h.doing == "watch_series" for h in day)]
    assert 1.3 < np.mean(watched) < 3.0


def test_what_was_interrupted_by_something_short_is_often_taken_up_again() -> None:
    moment = {"hour": 19, "weekday": 0, "absence": False, "possible": np.ones(len(shipped().activities), dtype=bool)}
    life, nothing = somebody("I am retired."), np.zeros(len(shipped().activities))

    def resumed(between: str, *, lasting: bool = True) -> float:
        index = shipped().index
        today = [
            *(Done(index[need], 9 + i) for i, need in enumerate(("breakfast", "wash_up", "bath", "lunch", "dinner"))),
            Done(index["watch_series"], 17),
            Done(index[between], 18),
        ]
        at = Moment(today=today, lasting=lasting, extra=nothing, **moment)  # type: ignore[arg-type]
        series = Choice(index["watch_series"], continues=True, why="going on")
        return float(np.mean([choose(life, at, np.random.default_rng(s), 0.7) == series for s in range(200)]))

    assert 0.2 < resumed("snack") < 0.6
    assert resumed("tidy") == resumed("snack", lasting=False) == 0.0


def test_what_goes_on_is_put_in_other_words_and_its_reason_says_so() -> None:
    who = person("x", "I am retired. I love to watch series on television.")
    now = Clock(day=0, hour=15)
    first = _known("video_games").canonical[0]
    today = [memory("Get some breakfast and wake up slowly", 0, 9, now), memory(first, 0, 14, now)]
    replies = [intend(who, 15, seed=seed, today=today, may_go_on=True) for seed in range(60)]
    went_on = [reply for reply in replies if reply.continues]
    assert went_on
    assert {activity(reply.intention) for reply in went_on} == {"video_games"}
    assert first not in {reply.intention for reply in went_on}
    assert all("longer than an hour" in reply.reason_intentions for reply in went_on)
    assert not any(intend(who, 15, seed=seed, today=today).continues for seed in range(60))


def test_hour_by_hour_nothing_comes_twice_running_or_twice_a_day_unless_it_bears_repeating() -> None:
    for day in _hourly():
        assert not any(hour.continues for hour in day)
        for i, hour in enumerate(day):
            earlier = [one.doing for one in day[:i]]
            assert hour.doing not in earlier[-2:]
            assert hour.doing not in earlier or _known(hour.doing).repeatable


def test_what_ends_the_day_is_followed_by_nothing_but_what_it_leads_to() -> None:
    closed = 0
    for day in (*_lasting(), *_hourly()):
        closing: str | None = None
        for hour in day:
            if closing is not None and not hour.continues:
                closed += 1
                assert hour.doing in _known(closing).follows
            closing = hour.doing if _known(hour.doing).closes else closing
    assert closed > 5


def test_at_an_hour_of_no_weight_nobody_does_it() -> None:
    for hour in (hour for days in (_lasting(), _hourly()) for day in days for hour in day):
        assert _known(hour.doing).hours[hour.hour - FIRST] > 0, hour


def test_who_works_elsewhere_goes_there_at_their_hours_where_people_may_leave_and_is_free_where_not() -> None:
    away, home = _some(NURSE, absence=True), _some(NURSE)
    assert of_hours(home, "work_out_of_home", "desk_work") == of_hours(away, "desk_work") == 0
    assert of_hours(away, "work_out_of_home") > 0.2
    for life in _people(NURSE):
        schedule = life.time.schedule
        for day in lived(life, 14, absence=True):
            at_work = [hour for hour in day if hour.doing == "work_out_of_home"]
            assert schedule is not None or not at_work
            assert all(schedule.covers(hour.weekday, hour.hour) for hour in at_work if schedule)


def test_at_home_nobody_does_what_is_done_elsewhere() -> None:
    elsewhere = [one.id for one in shipped().activities if one.away]
    assert of_hours(_lasting(), *elsewhere) == of_hours(_hourly(), *elsewhere) == 0
    assert of_hours(_some("I love to go out.", absence=True), "errands", "see_people") > 0.02


def test_nothing_of_home_comes_between_two_hours_of_work_elsewhere() -> None:
    broken = total = 0
    for day in _some(NURSE, absence=True):
        at_work = [i for i, hour in enumerate(day) if hour.doing == "work_out_of_home"]
        if at_work:
            total += 1
            broken += at_work != list(range(at_work[0], at_work[-1] + 1))
    assert total > 50
    assert broken < 0.3 * total  # somebody may leave early, and come back


def test_the_retired_have_no_work_and_weekends_all_week() -> None:
    for life in _people("I am retired."):
        assert life.time.schedule is None
        assert np.array_equal(life.wish(0, 10), life.wish(6, 10))
    assert of_hours(_some("I am retired.", absence=True), "desk_work", "work_out_of_home", "school") == 0


def test_pupils_learn_away_from_home_or_at_their_desk() -> None:
    says = "I am a student at university."
    assert of_hours(_some(says, absence=True), "school") > 0.15
    assert of_hours(_some(says), "school", "desk_work", "work_out_of_home") == 0


def test_the_employed_work_on_weekdays_more_than_on_weekends_and_most_days_differ_by_it() -> None:
    worked = [of_hours(_on(_lasting(), days), "desk_work") for days in (WEEKDAYS, WEEKENDS)]
    assert worked[0] > 1.5 * worked[1] > 0
    free = [of_hours(_on(_lasting(), days), "watch_series", "sports_tv", "read") for days in (WEEKDAYS, WEEKENDS)]
    assert free[1] > free[0]


def test_work_is_not_begun_in_the_middle_of_a_day_off() -> None:
    needs = {one.id for one in shipped().activities if one.daily}
    chores = {one.id for one in shipped().activities if one.after}
    for life in _people():
        schedule = life.time.schedule
        for day in lived(life, 14):
            worked = [hour for hour in day if hour.why == "work"]
            if worked and schedule is not None:
                before = [h for h in day if schedule.start <= h.hour < worked[0].hour]
                assert {h.doing for h in before} <= {"sleep_in", *needs, *WASHING, *chores}


def test_a_life_knows_its_household() -> None:
    assert somebody("I am retired.").household is sense().household


def test_a_new_job_gives_hours_of_work_whatever_the_profile_says_and_a_lost_one_takes_them() -> None:
    def worked(profile: str, **work: Any) -> list[int]:
        change = Change(kind="job", text="My work is another one now", day=0, work=Work(**work))
        days = lived(somebody(profile), WEEKDAYS, changes=as_variables([change], 0))
        return [hour.hour for day in days for hour in day if hour.doing == "desk_work"]

    new = worked("I am 75 years old and retired.", at="home", start=10, end=15)
    assert len(new) >= 15
    assert set(new) <= set(range(10, 15))
    assert not worked("I work from home on weekdays.", at="nowhere")
    assert not worked("I work from home on weekdays.", at="outside")  # nobody is ever away here
