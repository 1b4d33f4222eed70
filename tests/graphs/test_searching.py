"""What of a home the person is offered: what they want first, then what is near to their intention."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from langchain_core.embeddings import Embeddings

from coopera.core.clock import Clock
from coopera.core.hour import DayPlan, Found, LoggedHour, SearchSizes
from coopera.core.household import ObjectMap, SceneId
from coopera.graphs import build_human_graph
from coopera.graphs.human import human_hour
from coopera.graphs.players.player import Player
from coopera.graphs.players.stated import Logged
from tests.fakes import MARA, STIR, FakeHome, ScriptedAsk, placing, type2_answers
from tests.graphs.conftest import MakeServices


class Meanings(Embeddings):
    """Each word has a direction of its own, but a couch has that of a sofa."""

    alike = {"couch": "sofa", "brainstorm": "wardrobe"}

    def embed_query(self, text: str) -> list[float]:
        vector = np.zeros(512)
        for word in text.lower().split():
            letters = self.alike.get(word, word)
            vector[sum(n * ord(letter) for n, letter in enumerate(letters, start=1)) % 512] += 1.0
        return [float(value) for value in vector / np.linalg.norm(vector)]

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [self.embed_query(text) for text in texts]


def home(fixed: list[str], movable: list[str] | None = None) -> FakeHome:
    """The fake home with other objects, all in the study."""
    made = FakeHome()
    made.fixed = {name: (n, "study") for n, name in enumerate(["stove_1", *fixed])}
    made.movable = {name: (100 + n, "study") for n, name in enumerate(movable or ["book_1"])}
    return made


def found(
    make_services: MakeServices,
    where: FakeHome,
    *wants: str,
    text: str = "Brainstorm",
    collab: int = 2,
    objects: int = 3,
    player: Player | None = None,
) -> Found:
    """What Search finds for a person who wants these."""
    answers = type2_answers()
    answers["human/intention"] = lambda v: {"intention": text, "wants": list(wants)}
    answers["human/tasks_type1"] = lambda v: {"tasks": [placing("book_1", "stove_1", 100, 0)]}
    answers["human/tasks_type2"] = lambda v: {"tasks": STIR[: v["n_tasks"]]}
    for node in ("profile", "scene"):
        done = {"reviews": [{"yes": True}], "add": []}
        answers[f"human/reflect_{node}_type1"] = lambda v, done=done: done  # type: ignore[misc]
    plan = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=[9], collab=collab)  # type: ignore[arg-type]
    more: dict[str, Any] = {"player": player} if player else {}
    services = make_services(
        ask=ScriptedAsk(answers), home=where, sizes=SearchSizes(objects=objects, motions=1), **more
    )
    ctx = replace(services.human(plan), embeddings=Meanings())
    done = build_human_graph().invoke({"clock": Clock(day=0, hour=9), "hours": [9]}, context=ctx)  # type: ignore[arg-type]
    return human_hour(done).found  # type: ignore[arg-type]


def names(objects: ObjectMap) -> list[str]:
    return list(objects)


def test_what_is_wanted_comes_before_what_is_near_to_the_intentions_words(make_services: MakeServices) -> None:
    where = home(["wardrobe_1", "wardrobe_2", "desk_1", "desk_2", "office_chair_1"])
    assert names(found(make_services, where).fixed)[:2] == ["wardrobe_1", "wardrobe_2"]
    fixed = found(make_services, where, "desk", "Office chair", objects=5).fixed
    assert names(fixed)[:3] == ["desk_1", "office_chair_1", "wardrobe_1"]
    assert "desk_2" in fixed


def test_a_bound_leaves_something_of_each_want(make_services: MakeServices) -> None:
    where = home([*(f"rug_{n}" for n in range(1, 9)), "desk_1", "sofa_1"])
    assert names(found(make_services, where, "rug", "desk", "sofa").fixed) == ["rug_1", "desk_1", "sofa_1"]


def test_words_around_a_name_plurals_and_the_last_word_alone_are_understood(make_services: MakeServices) -> None:
    where = home(["dining_chair_1", "office_chair_1", "desk_1", "floor_lamp_1", "piano_1", "sofa_1"])
    for want, meant in {
        "my old desk in the corner": {"desk_1"},
        "two chairs": {"dining_chair_1", "office_chair_1"},
        "Desks": {"desk_1"},
        "reading lamp": {"floor_lamp_1"},
        "couch": {"sofa_1"},
    }.items():
        assert set(names(found(make_services, where, want, objects=len(meant)).fixed)) == meant, want


@pytest.mark.parametrize(
    ("wants", "name"),
    [
        ("storage boxes", "storage_box_1"),
        ("boxes", "storage_box_1"),
        ("dishes", "dish_1"),
        ("a glass", "reading_glasses_1"),
        ("wine glasses", "wine_glass_1"),
        ("knives", "bread_knife_1"),
        ("the shelves", "wall_shelf_1"),
        ("stoves", "stove_2"),
        ("vases", "vase_1"),
        ("batteries", "battery_1"),
        ("shoe", "shoes_1"),
        ("toys", "toy_1"),
    ],
)
def test_one_and_many_of_a_kind_have_the_same_name(make_services: MakeServices, wants: str, name: str) -> None:
    where = home(["wardrobe_1", "wardrobe_2"], ["book_1", "pen_1", name])
    offered = names(found(make_services, where, wants, collab=1, objects=1).movable)
    assert offered == [name]


def test_furniture_and_things_are_found_apart_and_a_thing_is_not_the_furniture_nearest_to_it(
    make_services: MakeServices,
) -> None:
    where = home(["bookshelf_1", "desk_1"], ["book_1", "notebook_1", "pen_1"])
    both = found(make_services, where, "desk", "pen", "notebook", collab=1, objects=2)
    assert names(both.fixed)[0] == "desk_1"
    assert set(both.movable) == {"pen_1", "notebook_1"}
    assert found(make_services, where, "pen", "desk").movable == {}


def test_what_the_home_does_not_have_finds_nothing(make_services: MakeServices) -> None:
    where = home(["wardrobe_1", "desk_1"])
    without = found(make_services, where).fixed
    assert found(make_services, where, "theremin", "  ", "!?").fixed == without


def test_the_intentions_own_words_are_searched_by_where_nobody_says_what_they_want(make_services: MakeServices) -> None:
    where = home(["wardrobe_1", "desk_1", "piano_1"])
    assert names(found(make_services, where, text="Brainstorm at the piano", objects=1).fixed) == ["piano_1"]


def test_the_steps_of_a_log_say_what_is_wanted(make_services: MakeServices) -> None:
    where = home(["wardrobe_1", "armchair_1", "bookshelf_1"])
    steps = ["take a novel from the bookshelf", "sit down in the armchair"]
    log = LoggedHour(day=0, hour=9, intention="Brainstorm", tasks=steps)
    fixed = found(make_services, where, player=Logged(lambda plan, clock: log), objects=2).fixed
    assert set(names(fixed)) == {"armchair_1", "bookshelf_1"}
