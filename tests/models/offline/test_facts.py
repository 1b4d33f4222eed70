"""What a profile states binds: each fact keeps its sentence, and says what is never done and what is done more."""

from __future__ import annotations

from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.core.naming import plain
from coopera.models.offline.household.knowledge import Household, shipped
from coopera.models.offline.household.statements import sentences
from coopera.models.offline.human import facts_file
from coopera.models.offline.human.facts import MOST, Facts, borrowed, facts
from coopera.models.offline.human.persona import shipped_aspects
from coopera.people.shipped import catalogue

EXERCISES = {"jump rope", "do jumping jacks", "run on the spot", "kick", "dance wildly"}
NO_PETS = {"pet_play", "pet_care"}
NOT_LEARNED = {"guitar", "piano"}
PEOPLE = catalogue(Path("nowhere"))


def of(*said: str) -> Facts:
    return facts(" ".join(said), shipped())


def says(read: Facts) -> set[str]:
    return {fact.says for fact in read.listed}


def test_an_old_man_with_one_leg_in_a_wheelchair_never_jumps_rope_or_kicks() -> None:
    read = of("I am an old man.", "I have only one leg, so I use a wheelchair.", "I like to read.")
    assert {"is old", "has one leg", "uses a wheelchair"} <= says(read)
    assert read.life_stage == "older"
    assert read.age is None
    assert read.never >= {"cardio"}
    assert read.never_motions >= EXERCISES
    assert "jump rope" in read.never_things
    assert "read" in read.because


@pytest.mark.parametrize(
    ("said", "never", "motions", "things"),
    [
        ("I am blind.", {"read", "watch_series"}, {"sit and read"}, {"book"}),
        ("I was born deaf.", {"listen", "call"}, {"talk on the phone"}, {"radio"}),
        ("I lost my left leg in the war.", {"cardio"}, {"kick"}, {"jump rope"}),
        ("I broke my arm last week.", {"guitar", "knit"}, {"do push-ups"}, {"dumbbell"}),
        ("I am expecting twins in two months.", set(), {"jump rope"}, {"wine bottle", "beer can"}),
        ("I have asthma.", set(), {"run on the spot"}, {"jump rope"}),
        ("I am 84 years old.", {"cardio"}, {"jump rope", "do squats"}, {"kettlebell"}),
        ("I am afraid of water.", {"bath"}, {"lie in the bath"}, {"bubble bath"}),
        ("I do not own a television.", {"watch_series", "sports_tv"}, {"sit and watch the screen"}, {"remote control"}),
        ("I hate to exercise.", {"strength", "cardio"}, set(), set()),
        ("I am a vegan.", set(), set(), {"milk carton", "cheese", "egg"}),
        ("I am allergic to peanuts and milk.", set(), set(), {"nuts", "milk carton", "ice cream tub"}),
        ("I do not drink alcohol.", set(), set(), {"wine bottle", "beer can"}),
        ("I never drink coffee.", set(), set(), {"coffee beans"}),
        ("I have celiac disease.", set(), set(), {"bread slice", "pasta box"}),
        ("I am diabetic.", set(), set(), {"sugar box"}),
        ("I do not believe in God.", set(), set(), {"holy book"}),
        ("I do not own a computer.", set(), set(), {"laptop"}),
    ],
)
def test_a_stated_fact_rules_out_what_it_rules_out(
    said: str, never: set[str], motions: set[str], things: set[str]
) -> None:
    read = of(said)
    assert never <= read.never
    assert motions <= read.never_motions
    assert things <= read.never_things
    assert not set(read.pulls) & read.never
    assert not set(read.because) & read.never


@pytest.mark.parametrize(
    "said",
    [
        "I do not use a wheelchair.",
        "My dad uses a wheelchair.",
        "I care for my mother in a wheelchair.",
        "I live with my brother, who is deaf.",
        "I used to be in a wheelchair.",
        "I went on a blind date.",
        "I am blind in one eye and color blind.",
        "My wife is pregnant.",
        "I'd give an arm and a leg for a good dinner.",
        "I am paralyzed with shyness at parties.",
        "I cannot walk the dog today.",
        "I teach deaf children.",
        "My daughter has asthma.",
    ],
)
def test_no_body_is_limited_by_a_relative_a_past_a_denial_or_a_figure_of_speech(said: str) -> None:
    assert not [fact for fact in of(said).listed if fact.kind == "body"]


@pytest.mark.parametrize(
    ("said", "age", "stage"),
    [
        ("I am 34.", 34, "adult"),
        ("I'm a 22-year-old barista.", 22, "young"),
        ("I turned 40 last month.", 40, "adult"),
        ("I'm in my seventies.", 75, "older"),
        ("I am in my late 60s.", 68, "older"),
        ("I am twenty five years old.", 25, "young"),
        ("I am 12years old.", 12, "young"),
        ("I am a grandmother of five.", None, "older"),
        ("I am 55 and a grandmother.", 55, "adult"),
        ("I am 6 feet tall.", None, None),
        ("I am 5'4\".", None, None),
        ("I am 29 weeks pregnant.", None, None),
        ("I am 100% sure.", None, None),
        ("I have lived here for 45 years.", None, None),
        ("My son is 12 years old.", None, None),
        ("I have a 12-year-old dog.", None, None),
    ],
)
def test_an_age_is_read_where_one_is_stated(said: str, age: int | None, stage: str | None) -> None:
    read = of(said)
    assert (read.age, read.life_stage) == (age, stage)


@pytest.mark.parametrize(
    ("said", "employment", "workplace"),
    [
        ("I love my job as a teacher.", "employed", "outside"),
        ("I am a night nurse.", "employed", "outside"),
        ("I drive a truck for a living.", "employed", "outside"),
        ("I work at a bookstore.", "employed", "outside"),
        ("I run a small shop.", "employed", "outside"),
        ("I work from home as an engineer.", "employed", "home"),
        ("I am a freelance writer.", "employed", "home"),
        ("I am an accountant who works from a home office.", "employed", "home"),
        ("I'm a stay-at-home mum of three.", "not_working", None),
        ("I am between jobs.", "not_working", None),
        ("I am a retired teacher.", "retired", None),
        ("I am in college to become a nurse.", "student", "outside"),
        ("I work at a bar at night to pay for college.", "student", "outside"),
        ("My mother is a nurse.", None, None),
        ("I am married to a doctor.", None, None),
        ("I am a nurse's daughter.", None, None),
        ("I was a truck driver for twenty years.", None, None),
        ("I want to be a lawyer.", None, None),
        ("I volunteer at a shelter.", None, None),
        ("I am a good cook.", None, None),
        ("I am not a doctor.", None, None),
    ],
)
def test_work_is_read_with_its_place(said: str, employment: str | None, workplace: str | None) -> None:
    read = of(said)
    assert read.employment == employment
    if workplace is not None or employment is None:
        assert read.workplace == workplace


def test_the_hours_of_work_are_read() -> None:
    assert of("I work as a guard on night shifts.").work_time == "nights"
    assert of("I work Monday to Friday in an office.").work_time == "weekdays"
    assert of("I work at a bar on weekends.").work_time == "weekends"
    assert of("I work out at night.").work_time is None
    assert of("I am retired, and my wife works nights.").work_time is None


def test_who_is_retired_does_no_desk_work_but_who_writes_all_the_same_still_writes() -> None:
    read = of("I am retired.", "I write poems every morning.")
    assert "desk_work" in read.never
    assert read.because["journal"] == "I write poems every morning."


@pytest.mark.parametrize(
    ("said", "allowed"),
    [
        ("I have two dogs.", NO_PETS),
        ("I have 5cats.", NO_PETS),
        ("I live with an old terrier called Biscuit.", NO_PETS),
        ("Two cats live with me.", NO_PETS),
        ("I have two goldfish.", {"pet_care"}),
        ("I play the guitar in a band.", {"guitar"}),
        ("I am a piano teacher.", {"piano"}),
        ("I play several instruments.", NOT_LEARNED),
        ("I love dogs.", set()),
        ("I don't have a dog.", set()),
        ("My dog died last year.", set()),
        ("My sister has a dog and a cat.", set()),
        ("I wish I had a cat.", set()),
        ("I walk dogs for a living.", set()),
        ("I have a dog phobia.", set()),
        ("I have fish for dinner.", set()),
        ("I love hot dogs.", set()),
        ("I used to play the guitar.", set()),
        ("I want to learn the piano.", set()),
        ("My boyfriend plays the guitar.", set()),
        ("My favorite band is from Ohio.", set()),
    ],
)
def test_animals_and_instruments_are_only_for_who_states_to_have_or_play_them(said: str, allowed: set[str]) -> None:
    assert (NO_PETS | NOT_LEARNED) - of(said).never == allowed


def test_a_dog_is_led_and_a_cat_is_not() -> None:
    assert "leash" not in of("I have a dog.").never_things
    assert "leash" in of("I have a cat.").never_things


@pytest.mark.parametrize(
    ("said", "spoken"),
    [
        ("I love to cook and bake.", {"dinner", "bake"}),
        ("I can't live without coffee.", {"hot_drink"}),
        ("I never skip breakfast.", {"breakfast"}),
        ("My husband and I love to hike.", {"cardio"}),
        ("I go jogging with my dog.", {"cardio", "pet_play", "pet_care"}),
        ("I am retired but still run marathons.", {"cardio"}),
        ("Knitting is my passion.", {"knit"}),
        ("I listen to concerts rather than watch television.", {"listen"}),
        ("I don't drink coffee, I prefer tea.", {"hot_drink"}),
        ("I play it by ear.", set()),
        ("I run out of money every month.", set()),
        ("I run a business from an office.", set()),
        ("I'm dog tired after work.", set()),
        ("I'm dying to dance with you.", set()),
        ("I read people like a book.", set()),
        ("I eat like a horse.", set()),
        ("I feel like a fish out of water.", set()),
        ("I used to paint.", set()),
        ("I loved dancing when I was young.", set()),
        ("My brother plays video games.", set()),
        ("I watch my son play soccer.", set()),
        ("I want to be a dancer.", set()),
        ("I would rather be asleep than read a book.", set()),
    ],
)
def test_only_what_the_person_says_to_do_is_a_reason_for_an_activity(said: str, spoken: set[str]) -> None:
    read = of(said)
    assert set(read.because) == spoken
    assert all(read.because[activity] in sentences(said) for activity in spoken)


@pytest.mark.parametrize("said", ["I hate reading.", "I never read.", "Reading bores me.", "I don't like to read."])
def test_what_is_hated_is_done_no_more_or_much_less(said: str) -> None:
    read = of(said)
    assert "read" in read.never or read.pulls["read"] <= -2
    assert "read" not in read.because


def test_a_denial_ends_where_a_new_clause_begins() -> None:
    read = of("I do not smoke and love gardening, but I hate cooking, cleaning and reading.")
    assert "plants" in read.because
    assert {"dust", "read"} <= read.never


def test_who_hates_to_cook_still_eats() -> None:
    read = of("I hate cooking.")
    assert "dinner" not in read.never
    assert read.pulls["bake"] < 0
    assert any("dinner stays" in effect for fact in read.listed for effect in fact.effects)


def test_what_age_suggests_gives_way_to_what_the_person_does() -> None:
    assert "run on the spot" in of("I am 84.").never_motions
    runner = of("I am 84.", "I run marathons.")
    assert "cardio" not in runner.never
    assert "run on the spot" not in runner.never_motions
    assert runner.because["cardio"] == "I run marathons."


def test_a_wheelchair_does_not_give_way() -> None:
    read = of("I use a wheelchair.", "I love running.")
    assert "cardio" in read.never
    assert "cardio" not in read.pulls


@pytest.mark.parametrize(
    ("said", "least", "most"),
    [
        ("I wake up at 5 every morning.", -4, -1),
        ("I am an early bird.", -4, -1),
        ("I am a night owl.", 1, 3),
        ("I sleep until noon.", 3, 5),
        ("I am not a morning person.", 1, 3),
        ("My roommate is a night owl.", 0, 0),
    ],
)
def test_the_day_lies_earlier_or_later(said: str, least: float, most: float) -> None:
    assert least <= of(said).hours_shift <= most


def test_every_statement_of_the_import_is_borrowed_and_is_no_reason() -> None:
    for aspect in shipped_aspects():
        for one in aspect.statements:
            assert [*map(borrowed, sentences(f"{one.says}."))] == [True]
    read = of("I watch a series in the evening.")
    assert read.pulls["watch_series"] > 0
    assert read.because == {}
    assert [fact.own for fact in read.listed] == [False]


def test_own_words_are_believed_before_borrowed_ones() -> None:
    read = of("I take on small jobs from home and work when I feel like it.", "I am a bus driver.")
    assert (read.employment, read.workplace) == ("employed", "outside")
    assert not borrowed("I am a bus driver.")


def test_a_fact_keeps_the_sentence_verbatim_and_says_what_follows() -> None:
    profile = "I'm 68, a retired cabinet maker — and a widower. I've two cats; I fix Whatever breaks!"
    read = facts(profile, shipped())
    assert {fact.sentence for fact in read.listed} <= set(sentences(profile))
    assert any(fact.effects == ("life stage: older",) for fact in read.listed if fact.kind == "age")
    assert any("employment: retired" in fact.effects for fact in read.listed)


def test_what_is_not_stated_is_listed_without_a_sentence() -> None:
    read = of("I say nothing.")
    assert read.listed == ()
    assert {fact.says for fact in read.unstated} >= {"states no animal to look after", "states to play no piano"}
    assert {fact.sentence for fact in read.unstated} == {""}
    assert read.never == NO_PETS | NOT_LEARNED


def test_the_shipped_people_are_read() -> None:
    read = {person.id: facts(person.profile, shipped()) for person in PEOPLE}
    assert {name: (one.age, one.employment, one.workplace) for name, one in read.items()} == {
        "amara": (34, "employed", "outside"),
        "bruno": (68, "retired", None),
        "chen": (22, "student", "home"),
        "dalia": (41, "employed", "home"),
        "elias": (29, "employed", "home"),
        "fumiko": (58, "employed", "home"),
        "gus": (45, "employed", "outside"),
        "hanna": (37, "employed", "home"),
        "idris": (31, "employed", "home"),
        "joan": (73, "retired", None),
    }
    assert {name for name, one in read.items() if "pet_play" not in one.never} == {"gus", "joan"}
    assert {name for name, one in read.items() if "guitar" not in one.never} == {"gus"}
    assert {name for name, one in read.items() if "piano" not in one.never} == {"fumiko"}
    assert {name for name, one in read.items() if "jump rope" in one.never_motions} == {"gus", "hanna", "joan"}
    assert all(len(one.because) >= 6 for one in read.values())
    assert all(abs(pull) <= MOST for one in read.values() for pull in one.pulls.values())


def test_reading_twice_gives_the_same() -> None:
    profile = PEOPLE[0].profile
    assert facts(profile, shipped()).model_dump_json() == facts(profile, shipped()).model_dump_json()


def test_the_rules_speak_of_the_household_and_of_every_activity() -> None:
    file, household = facts_file.shipped(), shipped()
    effects = [*file.rules, *file.ages]
    assert set(file.activities) == set(household.index)
    named = {name for one in effects for name in (*one.never, *one.more, *one.less, *one.speaks_for)}
    assert named <= set(household.index)
    assert {motion for one in effects for motion in one.never_motions} <= set(household.looks_like)
    things = {plain(thing) for one in household.activities for thing in one.things}
    things |= {plain(movable) for movable, _ in household.usual_places}
    listed = {thing for one in effects for thing in one.never_things}
    listed |= {thing for names in file.foods.values() for thing in names}
    assert listed | set(file.requires.things) <= things
    gives = {name for rule in file.rules for name in rule.gives} | {one.gives for one in file.activities.values()}
    assert set(file.requires.says) <= gives


def test_what_a_household_of_ones_own_lacks_is_skipped() -> None:
    known = shipped()
    kept = tuple(one.model_copy(update={"follows": ()}) for one in known.activities if one.id in ("read", "dinner"))
    small = Household(looks_like=known.looks_like, activities=kept)
    read = facts("I am blind. I have a dog. I run marathons. I am a vegan.", small)
    assert read.never == {"read"}
    assert set(read.pulls) <= {"read", "dinner"}
    assert "dumbbell" not in read.never_things


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("never: [cardio, sing]", "nevar: [cardio, sing]", "nevar"),
        ("kind: body", "kind: bodily", "kind"),
        ("rank: 3", "rank: '3'", "rank"),
        ("any: ['wheel ?chairs", "any: ['(wheel ?chairs", "regular expression"),
        ("<outside_job>", "<outdoor_job>", "outdoor_job"),
        ("requires:", "requires: {}\nrequires:", "stands twice"),
    ],
)
def test_a_file_with_a_mistake_is_refused_with_one_sentence(tmp_path: Path, before: str, after: str, said: str) -> None:
    text = facts_file.SHIPPED.read_text(encoding="utf-8")
    wrong = tmp_path / "facts.yaml"
    wrong.write_text(text.replace(before, after), encoding="utf-8")
    assert before in text
    with pytest.raises(ConfigError, match=said) as refused:
        facts_file.load(wrong)
    assert str(wrong) in str(refused.value)
    assert "\n" not in str(refused.value)
