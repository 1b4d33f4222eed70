"""What keeps a person's days from being alike: sides of their life, the week, and what they did on earlier days."""

from __future__ import annotations

import pytest

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan
from coopera.core.household import SceneId
from coopera.core.people import Persona
from coopera.graphs import build_human_graph
from coopera.graphs.players.changes import Change, Work
from coopera.graphs.players.living import Living
from coopera.graphs.players.variety import rhythm, side
from tests.fakes import MARA, ScriptedAsk, type2_answers
from tests.graphs.conftest import MakeServices

SIDES = [
    "I bake rye bread.",
    "I sail on Saturdays!",
    "Who would not love cats?",
    "I nap at weekends.",
    "I run on working days.",
]
LIFE = " ".join(SIDES)
HOURS = [9, 10, 11]


def test_each_side_of_a_life_gets_its_turn_once_in_a_round_in_ever_new_order() -> None:
    rounds = [[side(LIFE, 7, MARA, 5 * lap + n) for n in range(5)] for lap in range(4)]
    assert all(sorted(one) == sorted(SIDES) for one in rounds)
    assert len({tuple(one) for one in rounds}) > 1


@pytest.mark.parametrize(
    ("life", "sides"),
    [
        ("I work at St. Mary's, e.g. Mr. Smith helps.", ["I work at St. Mary's, e.g. Mr. Smith helps."]),
        ("I sew, knit etc. here. I rise at 6 a.m. to sew.", ["I sew, knit etc. here.", "I rise at 6 a.m. to sew."]),
        ("I sleep from 10 p.m. My cat J. Abrams hunts.", ["I sleep from 10 p.m.", "My cat J. Abrams hunts."]),
        ("I bake. I nap. I sew. I run. I am a nurse. Yes!", ["I bake. I nap.", "I sew. I run.", "I am a nurse. Yes!"]),
        ("I nap.", ["I nap."]),
    ],
)  # fmt: skip
def test_a_side_does_not_end_at_an_abbreviation_and_is_not_a_scrap(life: str, sides: list[str]) -> None:
    assert sorted(side(life, 7, MARA, turn) for turn in range(len(sides))) == sorted(sides)


def test_whose_turn_it_is_depends_on_the_seed_the_person_and_the_turn_alone() -> None:
    turns = range(40)
    mine = [side(LIFE, 7, MARA, turn) for turn in turns]
    other = MARA.model_copy(update={"id": "zoe"})
    assert mine == [side(LIFE, 7, MARA, turn) for turn in turns]
    assert mine != [side(LIFE, 8, MARA, turn) for turn in turns]
    assert mine != [side(LIFE, 7, other, turn) for turn in turns]


@pytest.mark.parametrize(
    ("day", "said"),
    [
        (0, 'Monday, the first day of the week; you say: "I run on working days."'),
        (5, 'Saturday, the sixth day of the week, the weekend; you say: "I sail on Saturdays!"; you say: '
            '"I nap at weekends."'),
        (13, 'Sunday, the seventh day of the week, the weekend; you say: "I nap at weekends."'),
    ],
)  # fmt: skip
def test_the_rhythm_of_the_week_is_what_the_profile_says_of_such_a_day(day: int, said: str) -> None:
    assert rhythm(LIFE, Clock(day=day, hour=9), []) == said


def test_hours_of_work_that_came_with_a_change_belong_to_the_rhythm_and_nothing_is_made_up() -> None:
    job = Change(text="I have a job", day=0, work=Work(at="outside", days=(0, 1), start=8, end=15))
    flu = Change(text="I have the flu", day=0)
    monday, friday = Clock(day=0, hour=9), Clock(day=4, hour=9)
    assert rhythm("I bake.", monday, [flu]) == "Monday, the first day of the week"
    assert rhythm("I bake.", monday, [job]).endswith("; you work outside the home from 8 am to 3 pm")
    assert rhythm("I bake.", friday, [job, flu]).endswith("; you do not work on this day")


def ask_on(make_services: MakeServices, day: int, hour: int, living: Living, person: str = "full") -> dict[str, object]:
    """The question for an intention, to somebody who has lived two days and a morning."""
    answers = type2_answers()
    answers["human/day"] = lambda v: {"intentions": [{"intention": "Sleep"}] * len(HOURS)}
    ask = ScriptedAsk(answers)
    mara: Persona = MARA.model_copy(update={"profile": LIFE, "notes": LIFE})
    plan = DayPlan(day=day, episode_day=day, person=MARA.id, scene=SceneId("toy"), hours=HOURS, collab=2)
    services = make_services(ask=ask, living=living, people={MARA.id: mara}, person=person)
    ctx = services.human(plan)
    if not list(ctx.memories.intentions.records()):
        for now, text in ((9, "Bake"), (10, "Nap"), (24 + 9, "Nap"), (24 + 10, "Sail"), (48 + 9, "Read")):
            ctx.memories.add(text, [], now=now)
    build_human_graph().invoke({"clock": Clock(day=day, hour=hour), "hours": HOURS}, context=ctx)  # type: ignore[arg-type]
    [asked] = ask.variables_of("human/intention" if person == "full" else "human/day")
    return asked


def test_earlier_days_are_known_in_one_line_only_where_people_remember_them(make_services: MakeServices) -> None:
    assert ask_on(make_services, 2, 10, Living())["earlier_days"] == ""
    known = ask_on(make_services, 2, 10, Living(remembers_days=True))["earlier_days"]
    assert known == "yesterday: Nap, Sail; 2 days ago: Bake"
    assert ask_on(make_services, 0, 9, Living(remembers_days=True))["earlier_days"] == ""


def test_the_sides_take_turns_hour_by_hour_over_the_days(make_services: MakeServices) -> None:
    asked = [ask_on(make_services, day, hour, Living()) for day, hour in ((0, 9), (0, 10), (0, 11), (1, 9), (1, 10))]
    assert sorted(str(one["side"]) for one in asked) == sorted(SIDES)
    assert asked[0]["rhythm"] == rhythm(LIFE, Clock(day=0, hour=9), [])


def test_a_day_planned_at_once_has_one_side_and_the_next_day_another(make_services: MakeServices) -> None:
    at_once = [ask_on(make_services, day, 10, Living(), "single_shot") for day in range(5)]
    assert sorted(str(one["side"]) for one in at_once) == sorted(SIDES)
    assert at_once[1]["fixed"]
