from __future__ import annotations

import pytest

from coopera.core.errors import ConfigError
from coopera.models.offline.household.knowledge import shipped as household
from coopera.simulation.goals.predicates import evaluate, performed
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.state.home_state import HomeState, PersonState, RobotState, ThingState
from coopera.simulation.world import World
from tests.simulation.flat import bring, flat, move, put


@pytest.fixture(scope="module")
def world():
    with World(flat()) as world:
        world.perform("robot", bring("toothbrush"))
        world.perform("human", move("sofa_1", "toothbrush", "sit and rest"))
        world.perform("robot", put("mug_1", "dining_table_1"))
        yield world


@pytest.mark.parametrize(
    ("predicate", "holds"),
    [
        ("on(mug, dining table)", True),
        ("on(mug, dining_table)", True),
        ("on(mug, kitchen counter)", False),
        ("on(unicorn, dining table)", False),
        ("holding(human, toothbrush)", True),
        ("holding(person, mug)", False),
        ("holding(robot, toothbrush)", False),
        ("near(human, sofa)", True),
        ("near(robot, sofa)", False),
        ("near(robot, dining table)", True),
        ("at(human, living room)", True),
        ("at(robot, living room)", False),
        ("performed(sit and rest)", True),
        ("performed(dance)", False),
        ("  at( robot , kitchen ) ", True),
    ],
)
def test_a_written_predicate_says_what_is_true_of_the_home(world, predicate, holds) -> None:
    assert world.holds(predicate) is holds


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "a predicate such as on(mug, sofa), 'not' or '(' was expected, and there it ends"),
        ("on(mug)", "it is written on(thing, furniture)"),
        ("on mug sofa", "'(' was expected, not 'mug'"),
        ("under(mug, sofa)", "known are on, inside"),
        ("insid(mug, fridge)", "did you mean inside?"),
        ("holding(cat, mug)", "'cat' is nobody here, the agent being human or robot"),
        ("wearing(robot, hat)", "'robot' is no person"),
        ("at(human)", "it is written at(agent, room)"),
        ("at(human, kitchn)", "there is no room 'kitchn' (did you mean kitchen?)"),
        ("on(mug, dinning table)", "there is no furniture 'dinning table' (did you mean dining table?)"),
        ("on(mug, apple)", "there is no furniture 'apple' (it is a thing)"),
        ("on(sofa, bed)", "'sofa' is furniture, where a thing was expected"),
        ("on(books, sofa)", "no home knows 'books' (did you mean book?)"),
        ("inside(mug, sofa)", "nothing is kept inside a sofa, but in bathroom cabinet"),
        ("open(sofa)", "'sofa' has no such state; open can be said of"),
        ("form(apple, sliced)", "'sliced' must be one of whole, cut, cooked"),
        ("near(every human, sofa)", '"every" can be said of objects only'),
        ("eventually(on(mug, sofa))", "is about a day, of which one moment says nothing"),
    ],
)
def test_what_cannot_be_true_or_false_of_the_home_is_refused_in_a_sentence(world, text, sentence) -> None:
    with pytest.raises(ConfigError) as refused:
        world.holds(text)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("thing", ["unicorn", "hot water bottle", "a very red mug"])
def test_a_thing_may_be_called_anything_as_it_may_come_out_of_the_magic_box(world, thing) -> None:
    assert not world.holds(f"holding(robot, {thing})")


def test_a_motion_counts_as_performed_from_a_similarity_of_six_tenths_on(world) -> None:
    assert performed(world.state, "relax for a while", lambda a, b: 0.6)
    assert not performed(world.state, "relax for a while", lambda a, b: 0.59)
    assert not performed(world.state, "relax for a while")


# From here on states are made by hand: what is asked is the state alone, however it came about.


class Home:
    """The flat with a fridge and a wardrobe, in which everything can be put anywhere."""

    def __init__(self) -> None:
        layout = flat()
        rows = [("fridge", "kitchen", (8.6, 0.5, 0.0)), ("plate", "kitchen", (6.0, 3.2, 0.75))]
        rows += [("plate", "kitchen", (8.5, 2.2, 0.9)), ("laptop", "living room", (2.0, 2.3, 0.44))]
        carriers = ["dining_table_1", "kitchen_counter_1", "coffee_table_1"]
        self.things = {}
        new = []
        for number, (cls, room, place) in enumerate(rows):
            fixed = cls == "fridge"
            name = "plate_2" if number == 2 else f"{cls}_1"
            on = None if fixed else carriers[number - 1]
            size = (0.7, 0.7, 1.8) if fixed else (0.2, 0.2, 0.03)
            new.append(SceneObject(id=50 + number, name=name, cls=cls, category="thing", fixed=fixed, room=room,
                                   position=place, size=size, colour="#ffffff", on=on))  # fmt: skip
        self.scene = layout.model_copy(update={"objects": [*layout.objects, *new]})
        person = PersonState(spot=(6.2, 2.0), place=(6.2, 2.0))
        self.state = HomeState(scene="flat", agents={"human": person, "robot": RobotState(spot=(1.0, 2.0))})

    def put(self, name: str, x: float, y: float, z: float, *, on: str | None = None, inside: str | None = None) -> Home:
        self.state = self.state.with_thing(name, ThingState(position=(x, y, z), yaw=0.0, on=on, inside=inside))
        return self

    def make(self, name: str, **condition: bool | str) -> Home:
        self.state = self.state.with_condition(self.scene.object(name), condition)
        return self

    def says(self, text: str) -> bool:
        return evaluate(self.scene, self.state, text)


@pytest.fixture
def home() -> Home:
    return Home()


def test_what_is_inside_is_not_on(home) -> None:
    home.put("apple_1", 8.6, 0.5, 1.0, inside="fridge_1")
    assert home.says("inside(apple, fridge) and not on(apple, fridge) and not on_floor(apple)")
    assert not home.says("on(apple, dining table)")


def test_what_is_inside_a_thing_inside_furniture_is_inside_both_and_in_their_room(home) -> None:
    home.state = home.state.out_of_box(home.scene, "robot", "handbag")
    home.put("handbag_1", 8.6, 0.5, 1.0, inside="fridge_1").put("book_1", 0.0, 0.0, 0.0, inside="handbag_1")
    assert home.says("inside(book, handbag) and inside(book, fridge) and in_room(book, kitchen)")
    assert not home.says("inside(mug, fridge)")


def test_what_is_held_or_worn_is_on_nothing_and_next_to_nothing(home) -> None:
    home.state = home.state.with_held("human", "mug_1").out_of_box(home.scene, "robot", "straw hat")
    home.state = home.state.with_worn("human", "straw_hat_1")
    assert home.says("holding(human, mug) and wearing(human, hat) and wearing(person, straw hat)")
    for thing in ("mug", "straw hat"):
        assert home.says(f"not on({thing}, kitchen counter) and not on_floor({thing}) and not next_to({thing}, plate)")
        assert home.says(f"in_room({thing}, kitchen) and near(human, {thing}) and not near(robot, {thing})")


def test_an_object_can_be_meant_by_its_exact_name(home) -> None:
    assert home.says("on(plate_1, dining_table_1) and on(plate_2, kitchen counter)")
    assert not home.says("on(plate_2, dining table)")
    assert not home.says("on(plate_7, dining table)")  # there is none, which may be otherwise in another home


def test_an_atom_is_true_for_some_object_and_with_every_for_all_of_them(home) -> None:
    home.make("plate_1", clean=False)
    assert home.says("clean(plate) and not clean(every plate)")
    home.make("plate_2", clean=False)
    assert home.says("not clean(plate)")
    assert not home.says("holding(human, unicorn) or on(every unicorn, sofa)")


def test_things_lie_on_the_floor_where_nothing_carries_them(home) -> None:
    assert home.says("on_floor(tennis ball) and not on_floor(mug) and in_room(tennis_ball, Living Room)")


@pytest.mark.parametrize(
    ("x", "z", "on", "together"),
    [
        (6.45, 0.75, "dining_table_1", True),  # beside the apple
        (6.3, 0.0, None, False),  # on the floor under it
        (7.0, 0.75, "dining_table_1", False),  # 0.6 m of table between them
        (6.87, 0.75, "dining_table_1", True),  # just within 0.5 m
    ],
)
def test_things_are_next_to_each_other_within_half_a_metre_on_one_level(home, x, z, on, together) -> None:
    home.put("mug_1", x, 3.5, z, on=on)
    assert home.says("next_to(mug, apple)") is together
    assert home.says("next_to(apple, mug)") is together


def test_nothing_is_next_to_itself_or_to_what_carries_it_or_through_a_wall(home) -> None:
    assert not home.says("next_to(apple, apple)")
    assert not home.says("next_to(cushion, sofa)")
    home.put("mug_1", 4.4, 1.0, 0.0).put("apple_1", 4.6, 1.0, 0.0)
    assert not home.says("next_to(mug, apple)")
    assert home.says("next_to(dining chair, dining table)")


def test_things_inside_are_next_to_each_other_only_in_one_container(home) -> None:
    home.put("apple_1", 8.6, 0.5, 1.0, inside="fridge_1").put("mug_1", 8.6, 0.6, 1.0, on="kitchen_counter_1")
    assert not home.says("next_to(apple, mug)")
    home.put("mug_1", 8.6, 0.6, 1.0, inside="fridge_1")
    assert home.says("next_to(apple, mug)")


def test_states_are_asked_of_the_objects_that_have_them(home) -> None:
    assert home.says(
        "not open(fridge) and not powered(laptop) and clean(mug) and not filled(mug) and form(apple, whole)"
    )
    home.make("fridge_1", open=True).make("laptop_1", powered=True).make("apple_1", form="cut")
    home.make("mug_1", clean=False, filled="Green tea")
    assert home.says("open(fridge) and powered(laptop) and not clean(mug) and filled(mug) and form(apple, cut)")
    assert home.says(
        "filled(mug, tea) and filled(mug, green TEA) and not filled(mug, coffee) and not filled(mug, green)"
    )


def test_a_thing_out_of_the_magic_box_is_what_it_was_called_by_its_last_words(home) -> None:
    home.state = home.state.out_of_box(home.scene, "robot", "Big red Mug")
    name = home.state.agents["robot"].thing
    assert home.says(f"holding(robot, mug) and holding(robot, red mug) and holding(robot, {name})")
    assert not home.says("holding(robot, red)")


def test_no_thing_that_the_offline_person_is_brought_is_taken_for_a_slip(home) -> None:
    things = {thing for activity in household().activities for thing in activity.things}
    assert len(things) > 100
    assert not [thing for thing in sorted(things) if home.says(f'holding(human, "{thing}")')]
