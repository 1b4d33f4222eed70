"""The shipped prompts: what each says, to whom, and in which order."""

from __future__ import annotations

import pytest

from coopera.core.asks import PROMPTS
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
from coopera.prompts.loader import SHIPPED


@pytest.fixture(scope="module")
def shipped() -> PromptLibrary:
    return PromptLibrary()


@pytest.mark.parametrize("name", sorted(PROMPTS))
def test_every_shipped_prompt_reads_well_with_every_example(shipped: PromptLibrary, name: str) -> None:
    for variables in examples(name):
        text = shipped.fill(name, variables)
        assert text == text.strip()
        assert "\n\n\n" not in text, "no gaps of two blank lines"
        assert not any(mark in text for mark in ("{{", "{%", "None", "  -", "[]", "Undefined"))
        assert all(len(line) < 1500 for line in text.splitlines())


def test_there_is_a_prompt_for_each_ask_and_no_other(shipped: PromptLibrary) -> None:
    files = {path.relative_to(SHIPPED).with_suffix("").as_posix() for path in SHIPPED.glob("*/*.md")}
    assert set(shipped.names) == set(PROMPTS) == files


@pytest.mark.parametrize(
    ("name", "temperature"),
    [
        ("human/intention", 0.7),
        ("human/tasks_type1", 0.7),
        ("human/tasks_type2", 0.7),
        ("human/reflect_profile_type1", 0.25),
        ("human/reflect_scene_type2", 0.25),
        ("human/feedback_tasks", 0.25),
        ("robot/intentions", 0.25),
        ("robot/traits", 0.25),
        ("judge/tasks", 0.25),
    ],
)
def test_proposing_is_warmer_than_judging(shipped: PromptLibrary, name: str, temperature: float) -> None:
    assert shipped.render(name, examples(name)[0]).temperature == temperature


def test_what_changes_by_the_hour_stands_behind_what_stays(shipped: PromptLibrary) -> None:
    for name in ("human/intention", "human/tasks_type2", "robot/intentions", "robot/tasks_type1"):
        first, other = examples(name)[0], {**examples(name)[0], "time": "8 pm", "recalled_tasks": []}
        texts = [shipped.render(name, variables).text for variables in (first, other)]
        same = next(n for n, (a, b) in enumerate(zip(*texts, strict=False)) if a != b)
        assert same > 0.6 * len(texts[0]), name


def test_the_robot_is_asked_about_the_pictures_only_where_there_is_no_percept(shipped: PromptLibrary) -> None:
    blind, seeing = examples("robot/intentions")[:2]
    assert "holding something like a book" in shipped.render("robot/intentions", blind).text
    assert "pictures" in shipped.render("robot/intentions", seeing).text
    assert "pictures" not in shipped.render("robot/intentions", blind).text


def test_a_person_reads_what_can_be_done_at_which_furniture(shipped: PromptLibrary) -> None:
    full = examples("human/tasks_type2")[0]
    twice = {**full, "can": {**full["can"], "armchair_2": ["sit and read", "take a nap"]}}
    lines = shipped.render("human/tasks_type2", twice).text.splitlines()
    assert "- armchair: sit and read, put on headphones, take a nap" in lines
    assert not any(line.startswith("- coffee table:") for line in lines)  # nothing is said of it


@pytest.mark.parametrize("name", ["human/intention", "human/day", "human/tasks_type1", "human/tasks_type2"])
def test_a_person_reads_of_their_home_once_room_by_room_and_without_ids(shipped: PromptLibrary, name: str) -> None:
    full = examples(name)[0]
    lines = shipped.render(name, full).text.splitlines()
    plainly = name in ("human/intention", "human/day")
    furniture = "armchair, bookshelf, coffee table" if plainly else "armchair_1, bookshelf_1, coffee_table_1"
    assert lines.count(f"- living room: {furniture}") == 1
    assert not any("(id" in line for line in lines)


@pytest.mark.parametrize("name", ["human/intention", "human/day"])
def test_a_list_that_is_cut_says_so(shipped: PromptLibrary, name: str) -> None:
    def home(count: int) -> str:
        names = {f"kind{chr(97 + n % 26)}{chr(97 + n // 26)}_1": [n, "hall"] for n in range(count)}
        return shipped.render(name, {**examples(name)[0], "fixed": names, "movable": names}).text

    assert "and others" not in home(25)
    for line in ("- hall: kindaa, ", "The small things in it: kindaa, "):
        [cut] = [one for one in home(151).splitlines() if one.startswith(line)]
        assert cut.removesuffix(".").endswith(" and others")


@pytest.mark.parametrize("name", ["human/intention", "human/day"])
def test_the_day_of_the_week_is_said_once(shipped: PromptLibrary, name: str) -> None:
    assert shipped.render(name, examples(name)[0]).text.count("Wednesday") == 1


def test_motions_are_shown_for_inspiration_only_where_nothing_is_known_of_the_furniture(shipped: PromptLibrary) -> None:
    for name in ("human/tasks_type2", "human/reflect_scene_type2"):
        full = examples(name)[0]
        assert "walk in a circle" not in shipped.render(name, full).text
        assert "walk in a circle" in shipped.render(name, {**full, "can": {}}).text


def test_what_was_seen_earlier_stands_in_the_prompts_of_either_type(shipped: PromptLibrary) -> None:
    for name in ("robot/intentions", "robot/tasks_type1", "robot/tasks_type2"):
        text = shipped.render(name, examples(name)[0]).text
        assert "Seen: what the person began earlier hours of today with:\n- 1 pm: " in text


def test_the_home_of_an_intention_stays_short_however_much_stands_in_it(shipped: PromptLibrary) -> None:
    few = examples("human/intention")[0]
    fixed = {f"kind{chr(97 + n % 26)}{n}_1": [n, "hall"] for n in range(500)}
    many = {**few, "fixed": fixed, "movable": fixed}
    assert len(shipped.render("human/intention", many).text) < len(shipped.render("human/intention", few).text) + 2000


def test_a_person_says_what_they_want_among_the_homes_own_things_only_where_tasks_move_them(
    shipped: PromptLibrary,
) -> None:
    moved, brought = (shipped.render("human/intention", examples("human/intention")[n]).text for n in (0, 2))
    assert "The small things in it: blanket, book, mug, teapot." in moved
    assert "small things in it" not in brought
    assert "they are brought to you" in brought


def test_who_checks_the_scene_reads_the_home_by_room_and_what_can_be_done(shipped: PromptLibrary) -> None:
    lines = shipped.render("human/reflect_scene_type2", examples("human/reflect_scene_type2")[0]).text.splitlines()
    assert "- living room: armchair_1, bookshelf_1, coffee_table_1" in lines
    assert "- armchair: sit and read, put on headphones" in lines


def test_who_checks_the_scene_reads_where_the_drafted_things_are(shipped: PromptLibrary) -> None:
    text = shipped.render("human/reflect_scene_type1", examples("human/reflect_scene_type1")[0]).text
    assert "14.1 Put book_2 (now on desk_1) on coffee_table_1." in text


def test_people_and_robots_read_how_things_are_where_that_is_not_as_usual(shipped: PromptLibrary) -> None:
    told = [name for name, spec in PROMPTS.items() if "states" in spec.variables]
    assert "robot/tasks_type2" in told
    for name in told:
        full = examples(name)[0]
        assert "- mug_1: dirty, with tea in it" in shipped.render(name, full).text.splitlines()
        assert "not as usual" not in shipped.render(name, {**full, "states": {}}).text
    seen = examples("robot/intentions")[0]
    assert "Not as usual: coffee_table_1 (dirty)." in shipped.render("robot/intentions", seen).text


def test_a_home_is_described_by_rooms_once_and_without_ids(shipped: PromptLibrary) -> None:
    names = shipped.render("robot/tasks_type1", examples("robot/tasks_type1")[0]).text
    assert "- living room: armchair_1, bookshelf_1, coffee_table_1\n- study: desk_1" in names
    assert "- kitchen: mug_1, teapot_1\n" in names
    assert "(id " not in names
    kitchen = {"stove_1": [1, "kitchen"], "dining_chair_2": [2, "kitchen"], "dining_chair_1": [3, "kitchen"]}
    fixed = {"sofa_1": [4, "living room"], **kitchen}
    kinds = shipped.render("robot/tasks_type2", {**examples("robot/tasks_type2")[0], "fixed": fixed}).text
    assert "- kitchen: stove, dining chair\n- living room: sofa\n" in kinds


def test_what_differs_between_the_guesses_of_an_hour_stands_behind_what_does_not(shipped: PromptLibrary) -> None:
    for name in ("robot/tasks_type1", "robot/tasks_type2"):
        first = examples(name)[0]
        texts = [shipped.render(name, {**first, **other}).text for other in ({}, {"intention": "Dust", "told": []})]
        same = next(n for n, (a, b) in enumerate(zip(*texts, strict=False)) if a != b)
        assert texts[0][:same].endswith("Your guess of what the person is up to: "), name


def test_a_robot_without_a_belief_does_not_say_that_it_was_told_nothing(shipped: PromptLibrary) -> None:
    for name in ("robot/intentions", "robot/tasks_type1", "robot/tasks_type2"):
        text = shipped.render(name, {**examples(name)[0], "profile": None, "big_five": None}).text
        assert "You do not know yet what this person is like." in text
        assert "know nothing" not in text.replace("Leave empty what you know nothing about.", "")
