"""Things from the magic box look like what they are called."""

from __future__ import annotations

import pytest

from benchmarks.things_sheet import household_names
from coopera.core.affordances import affordances
from coopera.core.errors import ConfigError
from coopera.simulation.homes.catalogue import SHAPES, catalogue, parts_of
from coopera.simulation.homes.magic_box import alike, looks, read_looks, shape_of
from coopera.simulation.motions.library import load_library
from coopera.simulation.shapes.kit import MOST_PARTS
from coopera.simulation.shapes.lettering import strokes


def test_no_thing_of_the_shipped_household_files_is_a_plain_box() -> None:
    assert len(household_names()) > 400
    assert [name for name in household_names() if shape_of(name).cls not in SHAPES] == []


def test_nothing_that_a_motion_brings_with_it_is_a_plain_box() -> None:
    for motion in load_library().motions:
        for aid in motion.keys.aids:
            assert shape_of(aid.thing).cls in SHAPES, aid.thing


def test_words_for_the_tools_of_motions_have_a_shape() -> None:
    for said in affordances().motions.values():
        for word in affordances().names(said.tools):
            assert shape_of(word).cls in SHAPES, word


def test_every_look_is_drawn_within_the_engine_and_at_about_its_size() -> None:
    for words in looks():
        shape = shape_of(words)
        parts = parts_of(shape.cls, shape.size, shape.rgb)
        assert 2 <= len(parts) <= MOST_PARTS, words
        for axis in range(3):
            low = min(part.position[axis] - part.around[axis] for part in parts)
            high = max(part.position[axis] + part.around[axis] for part in parts)
            slack = 0.06 + 0.12 * shape.size[axis]
            floor = 0.0 if axis == 2 else -shape.size[axis] / 2
            assert low >= floor - slack, words
            assert high <= floor + shape.size[axis] + slack, words
            assert high - low >= 0.5 * shape.size[axis], words


@pytest.mark.parametrize("recipe", sorted(set(SHAPES) - set(catalogue().fixed) - set(catalogue().movable)))
def test_a_recipe_of_the_magic_box_bears_any_proportions(recipe: str) -> None:
    for size in ((0.02, 0.02, 0.02), (5.0, 0.02, 0.3), (0.05, 3.0, 0.05), (0.1, 0.1, 4.0)):
        for part in parts_of(recipe, size, (0.2, 0.4, 0.6)):
            assert min(*part.half, part.radius, part.length) > 0
            assert all(0 <= channel <= 1 for channel in part.rgba)


def test_words_that_come_near_known_ones_in_meaning_look_like_them_and_count_as_themselves() -> None:
    known = {cls.replace("_", " ") for cls in catalogue().movable} | set(looks())
    assert set(alike().values()) <= known
    assert not set(alike()) & known
    for words, near in alike().items():
        assert shape_of(words).cls == shape_of(near).cls
    assert shape_of("red sneakers").cls == "shoes"
    assert shape_of("red sneakers").kind == "red_sneakers"


@pytest.mark.parametrize("nonsense", ["zorble", "Grandma's harp", "42", "???", "qwertz blorp"])
def test_what_nothing_is_known_of_is_a_labelled_box(nonsense: str) -> None:
    shape = shape_of(nonsense)
    parts = parts_of(shape.cls, shape.size, shape.rgb)
    assert {part.kind for part in parts} == {"box"}
    assert 4 < len(parts) <= MOST_PARTS
    assert shape.kind == nonsense.lower().replace(" ", "_")


def test_every_letter_of_the_alphabet_is_another_one() -> None:
    letters = ["".join(map(str, strokes(letter))) for letter in "abcdefghijklmnopqrstuvwxyz"]
    assert len(set(letters)) == len(letters)


@pytest.mark.parametrize(
    ("text", "cls"),
    [
        ("fork", "fork"),
        ("forks", "fork"),
        ("glass of wine", "glass"),
        ("jam jar of water", "jar"),
        ("phone charger", "cable"),
        ("old leather boots", "shoes"),
        ("a big box", "cardboard_box"),
    ],
)
def test_the_longest_known_words_of_a_name_decide_and_of_what_holds_something_its_vessel(text: str, cls: str) -> None:
    assert shape_of(text).cls == cls


def test_what_a_thing_counts_as_is_a_class_of_the_catalogue_or_its_own_words() -> None:
    assert shape_of("cup of tea").kind == "mug"
    assert shape_of("phone charger").kind == "phone_charger"


@pytest.mark.parametrize(
    "text",
    ["spoon: rocket", "spoon: [rocket, [0.1, 0.1, 0.1], '#ffffff']", "spoon: [book, [0, 1, 1], red]", "- a", "a: ["],
)
def test_an_unusable_file_of_looks_is_refused_with_its_words(tmp_path, text: str) -> None:
    path = tmp_path / "looks.yaml"
    path.write_text(text)
    with pytest.raises(ConfigError, match="looks.yaml"):
        read_looks(path)
