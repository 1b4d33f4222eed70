"""What the robot makes of what it sees, remembers and believes; and what it believes in the evening."""

from __future__ import annotations

from typing import Any

import pytest

from coopera.core.clock import Clock
from coopera.core.people import TRAITS
from coopera.models.offline.household.knowledge import shipped
from tests.models.offline.questions import activity, ask, imagine, live, memory, percept, person

NOW = Clock(day=1, hour=15)


def _ids(reply: Any) -> list[str]:
    return [activity(item.intention) for item in reply.intentions]


@pytest.mark.parametrize("n", [1, 3, 5, 8])
def test_it_proposes_as_many_different_intentions_as_asked_for(n: int) -> None:
    assert len(set(_ids(imagine(n=n)))) == n


def test_it_goes_by_the_hour_where_it_knows_nothing_else() -> None:
    assert _ids(imagine(hour=12, n=1)) == ["lunch"]
    assert _ids(imagine(hour=21, percept=percept(room="bedroom"), n=1)) == ["bedtime"]


def test_it_goes_by_room_furniture_motion_and_thing_seen() -> None:
    seen = percept(room="hobby room", near=["workbench_1"], motion="work with the hands at a surface", in_hand="hammer")
    assert _ids(imagine(hour=15, percept=seen))[0] == "repair"
    seen = percept(room="living room", near=["rug_1"], motion="exercise", in_hand="yoga_mat")
    assert _ids(imagine(hour=15, percept=seen))[0] in {"yoga", "strength"}
    assert "in the hobby room" not in imagine(percept=seen).intentions[0].reason_vision


def test_it_is_not_led_astray_by_one_wrong_percept() -> None:
    seen = percept(room="hobby room", near=["workbench_1"], motion="exercise", in_hand="hammer")
    assert "repair" in _ids(imagine(hour=15, percept=seen))


def test_it_understands_the_first_task_in_words() -> None:
    reply = imagine(hour=15, percept=None, first_task="put the knitting basket on the armchair", n=3)
    assert _ids(reply)[0] == "knit"
    assert "knitting basket" in reply.intentions[0].reason_vision


def test_it_expects_at_an_hour_what_it_remembers_of_that_hour_in_the_persons_own_words() -> None:
    told = [memory("Work on balance and flexibility, full of energy", 0, 15, NOW)]
    seen = percept(room="living room")
    reply = imagine(day=1, hour=15, percept=seen, recalled_intentions=told)
    assert "Work on balance and flexibility, full of energy" in [item.intention for item in reply.intentions]
    at_night = [memory("Work on balance and flexibility, full of energy", 0, 21, NOW)]
    later = imagine(day=1, hour=15, percept=seen, recalled_intentions=at_night, n=8)
    assert "Work on balance and flexibility, full of energy" not in [item.intention for item in later.intentions]


def test_it_does_not_expect_again_what_was_done_today_but_what_follows_it() -> None:
    noon = Clock(day=1, hour=13)
    eaten = [memory("Make a simple lunch", 1, 12, noon)]
    kitchen = percept(room="kitchen", near=["kitchen_sink_1"], motion="work with the hands at a surface")
    fresh = _ids(imagine(day=1, hour=13, percept=kitchen))
    after = _ids(imagine(day=1, hour=13, percept=kitchen, recalled_intentions=eaten))
    assert fresh[0] == "lunch"
    assert after[0] == "dishes"


def test_what_it_believes_of_the_person_counts() -> None:
    seen = percept(room="living room")
    open_minded = dict.fromkeys(TRAITS, 3.0) | {"openness": 5.0, "extroversion": 1.0, "conscientiousness": 1.0}
    outgoing = dict.fromkeys(TRAITS, 3.0) | {"extroversion": 5.0, "agreeableness": 5.0}
    assert _ids(imagine(hour=16, percept=seen, big_five=open_minded)) != _ids(
        imagine(hour=16, percept=seen, big_five=outgoing)
    )
    told = _ids(imagine(hour=16, percept=seen, profile="This person likes to puzzle over something tricky."))
    assert "puzzle" in told
    assert "puzzle" not in _ids(imagine(hour=16, percept=seen))


def test_it_expects_nothing_that_the_home_has_no_room_for() -> None:
    for item in _ids(imagine(rooms=["bathroom", "bedroom"], n=8)):
        assert {"bathroom", "bedroom"} & set(shipped().activities[shipped().index[item]].rooms)


def test_each_reason_says_what_it_rests_on() -> None:
    told = [memory("Make a simple lunch", 0, 12, Clock(day=1, hour=12))]
    seen = percept(room="kitchen", near=["stove_1"], in_hand="tomato")
    first = imagine(day=1, hour=12, percept=seen, recalled_intentions=told, n=1).intentions[0]
    assert first.intention == "Make a simple lunch"
    assert "On an earlier day" in first.reason_intentions
    assert "the kitchen" in first.reason_vision
    assert "the tomato in hand" in first.reason_vision
    assert first.reason_human == "Nothing is known of this person yet."


def _evening(lived: list[str], profile: str | None = None, tasks: list[str] | None = None) -> Any:
    now = Clock(day=0, hour=21)
    told = [memory(text, 0, 9 + i, now) for i, text in enumerate(lived)]
    done = [memory(text, 0, 9, now) for text in tasks or []]
    return ask("robot/traits", intentions=told, tasks=done, profile=profile, evening=True)


def test_traits_are_read_from_what_was_done_and_little_evidence_says_little() -> None:
    tidy = ["Restore order at home", "Fight the dust", "Take care of the floors", "Get some work done"]
    art = ["Make some art", "Read for pleasure", "Work on a poem or a story", "Find some inner calm"]
    orderly, artist = _evening(tidy).big_five, _evening(art).big_five
    assert orderly.conscientiousness > artist.conscientiousness
    assert artist.openness > orderly.openness
    assert abs(_evening(art[:1]).big_five.openness - 3) < abs(_evening(art * 3).big_five.openness - 3)
    assert _evening([]).big_five.openness == 3.0


def test_the_profile_has_three_sentences_what_when_and_with_which_things() -> None:
    lived = live(person())
    tasks = ["stir a pot at the stove with the whisk in hand", "wash dishes at the sink with the whisk in hand"]
    what, when_, things = _evening(lived, tasks=tasks).profile.rstrip(".").split(". ")
    assert what.startswith("This person likes to")
    assert all(part in when_ for part in ("morning", "afternoon", "evening"))
    assert things == "The things most often in use are the whisk"


def test_the_profile_revises_the_one_before_it() -> None:
    first = _evening(["Make some art"] * 2 + ["Read for pleasure"])
    second = _evening(["Make a simple lunch", "Read for pleasure"], profile=first.profile)
    assert "be creative with colours" in second.profile
    assert second.profile.index("lost in a good story") < second.profile.index("make a simple lunch")
    assert "the earlier profile knew 1 of the activities" in second.reasons_profile


def test_a_foreign_home_and_motion_are_no_stumbling_block() -> None:
    seen = percept(room="castle", near=["throne_1"], motion="juggle with swords", in_hand="crown")
    assert len(imagine(percept=seen, rooms=["castle"]).intentions) == 5
