"""The household file: what is shipped hangs together, and what does not is refused with file, activity and field."""

from __future__ import annotations

import json
import re
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from coopera.core.affordances import affordances
from coopera.core.errors import ConfigError
from coopera.core.household import plain
from coopera.core.people import TRAITS, BigFive
from coopera.models.offline.household.knowledge import SHIPPED, Activity, load, robots, shipped
from coopera.models.offline.household.placing import Placement
from coopera.models.offline.household.reading import Piece

ROOT = Path(__file__).parents[3]
ACTIVITIES = shipped().activities
BOTH = (*ACTIVITIES, *robots().activities)
KINDS = (
    "kitchen",
    "living room",
    "dining room",
    "bedroom",
    "bathroom",
    "study",
    "hallway",
    "laundry room",
    "hobby room",
)

VERBS = """
add admire advance alter arrange assemble attempt attend bake banish be begin bend binge breathe bring brood
browse brush build burn call calm capture care carry catch challenge chase chat check cheer choose clean clear
close collect concentrate construct continue cook cram create crochet cross dance daydream deal decide decorate
design dim display dive do doze draw dress drift drive drop eat end enjoy escape exercise experiment fall feed
fiddle fight figure fill find finish fix float focus follow fool freshen gain get give go grab groom have head
heat hold host idle improve improvise jam join keep knit laugh lean learn let lie lift linger listen look lose
make master meet move muse nibble nod note organise paint pamper pause pick plan play plunge polish post
practise prepare preserve provide push put puzzle rack read rearrange receive recover reflect refuel rehearse
relax remove repair rescue rest restore retire return review revise roll romp root round run satisfy savour see
seek set settle sew show sing sit sketch sleep slow snack sneak snooze soak solve sort speak spend start stay
still stitch stop stretch strum study take talk teach tend think throw tidy tinker train treat try turn unwind
use visit wake walk warm wash watch welcome whip wind wipe work write
"""


@lru_cache(maxsize=2)
def _read(name: str) -> Any:
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


def test_about_forty_activities_are_shipped_and_each_hour_offers_many() -> None:
    assert 40 <= len(ACTIVITIES) <= 60
    for hour in range(13):
        assert sum(activity.hours[hour] >= 0.5 for activity in ACTIVITIES) >= 10


@pytest.mark.parametrize("activity", ACTIVITIES, ids=lambda a: a.id)
def test_an_activity_is_described_in_full(activity: Activity) -> None:
    assert 4 <= len(activity.wordings) <= 6
    assert re.match(r"I\b|Knitting", activity.statement)
    if not activity.away:  # of an hour away there is nothing to see, and nothing is taken in hand or put anywhere
        assert 8 <= len(activity.things) <= 12
        assert 7 <= len(activity.places) <= 10
    assert len(set(activity.places)) == len(activity.places)
    assert set(activity.rooms) <= set(KINDS)
    assert activity.source


@pytest.mark.parametrize("activity", BOTH, ids=lambda a: a.id)
def test_wordings_are_high_level_speak_of_nobody_and_name_no_object(activity: Activity) -> None:
    catalogue = _read("simulation/homes/catalogue.yaml")
    objects = {plain(cls) for kind in ("fixed", "movable") for cls in catalogue[kind]} | set(activity.things)
    named = re.compile(rf"\b({'|'.join(map(re.escape, sorted(objects)))})s?\b")
    for wording in activity.expansions():
        assert not re.search(r"\b(I|my|me|he|she)\b", wording)
        assert named.search(wording.lower()) is None, wording


def test_an_intention_can_be_put_in_thousands_of_short_ways_that_begin_with_a_verb() -> None:
    counts = {activity.id: len(list(activity.expansions())) for activity in ACTIVITIES}
    assert sum(counts.values()) >= 3000
    assert min(counts.values()) >= 40
    wordings = [wording for activity in ACTIVITIES for wording in activity.expansions()]
    assert [wording for wording in wordings if len(wording.split()) > 9] == []
    assert {wording.split()[0].lower() for wording in wordings} - set(VERBS.split()) == set()
    assert [wording for wording in wordings if re.search(r"\ba [aeio]|\ban [^aeiouh]|\b(\w+) \1\b|  ", wording)] == []


def test_what_a_wording_says_plainly_is_its_first_alternatives() -> None:
    for activity in ACTIVITIES:
        assert len(activity.canonical) == len(activity.wordings)
        assert not any(set(text) & set("{|}") for text in activity.canonical)
    assert ACTIVITIES[0].canonical[0] == "Start the day with a proper breakfast"


def test_everything_placed_and_every_spot_is_a_class_that_homes_have() -> None:
    catalogue = _read("simulation/homes/catalogue.yaml")
    for activity in BOTH:
        assert {thing for thing, _ in activity.places} <= set(catalogue["movable"])
        assert {spot for _, spot in activity.places} | set(activity.fixed) <= set(catalogue["fixed"])


def test_each_motion_of_an_activity_can_be_made_at_one_of_its_spots() -> None:
    suits = affordances().suits
    homeless = [(a.id, m) for a in BOTH for m in a.all_motions if not any(suits(m, spot) for spot in a.fixed)]
    assert homeless == []


def test_people_put_things_inside_where_they_usually_are_and_on_top_otherwise() -> None:
    def placed(thing: str, spot: str) -> str:
        return Placement(Piece(f"{thing}_1", thing, 1, "kitchen"), Piece(f"{spot}_1", spot, 2, "kitchen"), 0).words()

    assert placed("plate", "dishwasher") == "the plate in the dishwasher"
    assert placed("shirt", "wardrobe") == "the shirt in the wardrobe"
    assert placed("plate", "dining_table") == "the plate on the dining table"
    assert placed("book", "wardrobe") == "the book on the wardrobe"


def test_everything_that_is_placed_fits_where_it_is_placed() -> None:
    catalogue = _read("simulation/homes/catalogue.yaml")

    def fits(thing: str, spot: str) -> bool:
        (width, depth, height), kind = catalogue["movable"][thing]["size"], catalogue["fixed"][spot]
        for _, x0, x1, y0, y1, clear in kind["surfaces"]:
            room = sorted(((x1 - x0) * kind["size"][0], (y1 - y0) * kind["size"][1]))
            if min(width, depth) <= room[0] and max(width, depth) <= room[1] and height <= clear:
                return True
        return spot in catalogue["movable"][thing]["put"]  # homes have it there, so it does

    assert [(a.id, *place) for a in BOTH for place in a.places if not fits(*place)] == []


def test_motions_are_those_of_the_simulation_and_look_as_it_says() -> None:
    motions = _read("simulation/motions/motions.yaml")["motions"]
    for household in (shipped(), robots()):
        assert household.looks_like == {motion["caption"]: motion["class"] for motion in motions}


def test_activities_can_be_told_apart_by_more_than_one_thing() -> None:
    for one in ACTIVITIES:
        for other in ACTIVITIES:
            if one.id < other.id and not (one.away or other.away):
                assert len(set(one.things) & set(other.things)) <= len(one.things) // 2, (one.id, other.id)


def test_an_average_personality_is_drawn_nowhere_and_loadings_point_both_ways() -> None:
    household = shipped()
    assert np.all(household.trait_pull(BigFive()) == 0)
    tidy, paint = household.index["tidy"], household.index["paint"]
    pull = household.trait_pull(BigFive(conscientiousness=5, openness=1))
    assert pull[tidy] > 0 > pull[paint]
    for trait in range(len(TRAITS)):
        assert household.loadings[:, trait].max() > 0 > household.loadings[:, trait].min()


@lru_cache(maxsize=1)
def _three_activities() -> str:
    data = yaml.safe_load(SHIPPED.read_text(encoding="utf-8"))
    data["activities"] = data["activities"][:3]
    for activity in data["activities"]:
        activity["follows"] = []
    return json.dumps(data)


def _broken(tmp_path: Path, change: Any) -> Path:
    data = json.loads(_three_activities())
    change(data)
    path = tmp_path / "household.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return path


def test_a_correct_small_file_is_read(tmp_path: Path) -> None:
    assert [a.id for a in load(_broken(tmp_path, lambda data: None)).activities] == ["breakfast", "lunch", "dinner"]


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("hours", [1.0] * 12, r"activity 'lunch', field 'hours'.*13"),
        ("hours", [0.0] * 13, r"activity 'lunch', field 'hours'.*above 0"),
        ("statement", 7, r"activity 'lunch', field 'statement'"),
        ("big_five", {"grumpiness": 0.5}, r"activity 'lunch', field 'big_five'.*'grumpiness' is not one of openness"),
        ("big_five", {"openness": 3}, r"activity 'lunch', field 'big_five.openness'"),
        ("follows", ["fly"], r"activity 'lunch', field 'follows': there is no activity 'fly'"),
        ("motions", ["fly"], r"activity 'lunch', field 'motions': 'fly' is not listed under looks_like"),
        ("assumed", ["openness"], r"activity 'lunch', field 'assumed': 'openness' has no loading in big_five"),
        (
            "wordings",
            ["{Eat|Cook} a {good|proper} {dinner|}", "Eat"],
            r"'Cook a proper dinner' stands also in .* 'lunch'",
        ),
        ("wordings", ["Eat {well|Well}"], r"'lunch', field 'wordings': 'Eat Well' stands also in activity 'lunch'"),
        ("wordings", ["Eat {well"], r"activity 'lunch', field 'wordings\.0': 'Eat {well' has a brace without"),
        ("wordings", ["Eat", "Eat {|}"], r"activity 'lunch', field 'wordings\.1': 'Eat {\|}' has braces with nothing"),
        ("wordings", ["Eat {well}"], r"activity 'lunch', field 'wordings': at least two wordings"),
        ("wordings", ["Cook a proper dinner", "Eat"], r"field 'wordings'.*'Cook a proper dinner'"),
        ("things", {}, r"activity 'lunch', field 'things'"),
        ("colour", "red", r"activity 'lunch', field 'colour'"),
        ("uses", {"gaming": 30}, r"activity 'lunch', field 'uses': 'gaming' is not one of sleeping"),
        ("uses", {"eating": 0}, r"activity 'lunch', field 'uses.eating'.*1"),
        ("uses", {"eating": 61}, r"activity 'lunch', field 'uses.eating'.*60"),
        ("uses", {"eating": True}, r"activity 'lunch', field 'uses.eating'.*integer"),
        ("uses", {"eating": 40, "tv": 30}, r"activity 'lunch', field 'uses': the minutes are 70 in all, at most 60"),
        ("uses", ["eating"], r"activity 'lunch', field 'uses'.*dictionary"),
    ],
)
def test_a_mistake_is_refused_with_file_activity_and_field(tmp_path: Path, field: str, value: Any, said: str) -> None:
    path = _broken(tmp_path, lambda data: data["activities"][1].update({field: value}))
    with pytest.raises(ConfigError, match=said) as refused:
        load(path)
    assert str(path) in str(refused.value)


def test_an_hour_of_an_activity_counts_as_it_says_or_as_other(tmp_path: Path) -> None:
    def change(data: Any) -> None:
        data["activities"][0].pop("uses", None)
        data["activities"][1]["uses"] = {"eating": 30, "food_prep": 5}

    breakfast, lunch, _ = load(_broken(tmp_path, change)).activities
    assert breakfast.minutes == {"other": 60}
    assert lunch.minutes == {"eating": 30, "food_prep": 5}


def test_a_file_that_still_says_where_motions_are_done_is_told_where_that_now_stands(tmp_path: Path) -> None:
    whole = _broken(tmp_path, lambda data: data.update(done_at={"fly": ["sofa"]}))
    for path in (whole, _own(tmp_path, done_at={})):
        with pytest.raises(ConfigError, match=r"field 'done_at': .* now stands in core/affordances\.yaml"):
            load(path)


def _own(tmp_path: Path, **fields: Any) -> Path:
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump({"extends": "shipped", **fields}), encoding="utf-8")
    return path


def _activity(index: int, **changed: Any) -> dict[str, Any]:
    return {**json.loads(_three_activities())["activities"][index], **changed}


def test_a_file_of_ones_own_replaces_adds_and_keeps(tmp_path: Path) -> None:
    wordings = ["Fly a kite indoors", "Test the wind"]
    new = _activity(1, id="kite", wordings=wordings, motions=["fly"], follows=["lunch"])
    lunch = _activity(1, wordings=["Eat nothing at noon", "Fast for an hour"])
    own = load(_own(tmp_path, activities=[lunch, new], looks_like={"fly": "exercise"}))
    assert list(own.index) == [*shipped().index, "kite"]
    assert own.activities[own.index["lunch"]].wordings == tuple(lunch["wordings"])
    assert own.activities[own.index["dinner"]] == shipped().activities[shipped().index["dinner"]]
    assert load(_own(tmp_path)) == shipped()


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"extends": "nothing"}, r"field 'extends'"),
        ({"activities": [{"id": "kite"}]}, r"activity 'kite', field 'wordings'"),
        ({"activities": "kite"}, r"field 'activities'"),
        ({"colour": "red"}, r"field 'colour'"),
    ],
)
def test_a_mistake_in_a_file_of_ones_own_is_refused_by_its_name(
    tmp_path: Path, fields: dict[str, Any], said: str
) -> None:
    with pytest.raises(ConfigError, match=rf"own\.yaml: {said}"):
        load(_own(tmp_path, **fields))


def test_a_file_of_ones_own_may_neither_double_an_id_nor_take_a_wording_of_another(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"own\.yaml: activity 'kite', field 'id': each id may be used once only"):
        load(_own(tmp_path, activities=[_activity(1, id="kite"), _activity(1, id="kite")]))
    with pytest.raises(ConfigError, match=r"own\.yaml: activity 'kite', field 'wordings'.*stands also in"):
        load(_own(tmp_path, activities=[_activity(1, id="kite")]))
    with pytest.raises(ConfigError, match=r"activity 'kite', field 'things\.plate': 'fly' is not listed"):
        load(
            _own(
                tmp_path,
                activities=[
                    _activity(1, id="kite", wordings=["a b", "c d"], things={**_activity(1)["things"], "plate": "fly"})
                ],
            )
        )


def test_what_is_assumed_says_so_and_the_documentation_counts_it() -> None:
    assert [a.id for a in BOTH if bool(a.assumed) != ("assumption" in a.source)] == []
    said = (ROOT / "docs/offline-model.md").read_text(encoding="utf-8")
    for household, words in ((shipped(), "{} of the {} loadings"), (robots(), "{} of the robot's {}")):
        assumed = sum(len(activity.assumed) for activity in household.activities)
        loadings = sum(len(activity.big_five) for activity in household.activities)
        assert words.format(assumed, loadings) in said


def test_two_activities_of_one_name_are_refused(tmp_path: Path) -> None:
    path = _broken(tmp_path, lambda data: data["activities"][2].update({"id": "lunch"}))
    with pytest.raises(ConfigError, match="activity 'lunch', field 'id'"):
        load(path)


@pytest.mark.parametrize(("content", "found"), [("- a", "a list"), ("", "nothing"), ("tea", "a str")])
def test_a_household_file_that_is_no_mapping_is_refused_in_one_sentence(
    tmp_path: Path, content: str, found: str
) -> None:
    path = tmp_path / "home.yaml"
    path.write_text(content)
    with pytest.raises(ConfigError, match=rf"home\.yaml: a household file must be a mapping .*, not {found}\.$"):
        load(path)


@pytest.mark.parametrize("content", [b"activities: [", b"\xff\xfe", b"[]", b"activities: 3\nlooks_like: {a: b}\n"])
def test_what_is_no_household_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "home.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigError, match=r"home\.yaml"):
        load(path)
