"""How people look follows from who they are, and what they wear from what they do."""

from __future__ import annotations

from coopera.core.people import Looks
from coopera.people.shipped import SHIPPED, read_persona
from coopera.simulation.motions.library import load_library
from coopera.simulation.people.appearance import Appearance, appearance_of, outfit_for, stated_looks
from coopera.simulation.people.paints import PAINTS, painted
from coopera.simulation.people.palettes import HAIRS

GREYS = (HAIRS["grey"], HAIRS["white"])


def looks_of(person: str, profile: str = "") -> Appearance:
    return appearance_of(profile, person)


def test_two_people_look_different_and_the_same_one_the_same() -> None:
    people = [looks_of(f"person-{number}") for number in range(40)]
    assert len(set(people)) == 40
    appearance_of.cache_clear()
    assert people == [looks_of(f"person-{number}") for number in range(40)]


def test_looks_are_drawn_as_they_were() -> None:
    """The draw has an address: it is the same in every process, and on every machine."""
    looks = looks_of("amara")
    assert (looks.hair_style, looks.beard, looks.glasses) == ("cropped", "shaven", "round")
    assert (looks.day.top, looks.day.bottom) == ("tee", "trousers")
    assert round(looks.measures.girth, 4) == 0.9663


def test_old_people_are_grey_more_often_than_not_and_young_ones_are_not() -> None:
    old = [looks_of(f"p{n}", "I am 68, a retired cabinet maker, and I read.") for n in range(60)]
    retired = [looks_of(f"p{n}", "I am a retired teacher.") for n in range(60)]
    young = [looks_of(f"p{n}", "I am 22 and study law.") for n in range(60)]
    assert sum(one.hair in GREYS for one in old) > 45
    assert sum(one.hair in GREYS for one in retired) > 45
    assert sum(one.hair in GREYS for one in young) == 0
    assert all(one.lined for one in old)


def test_a_profile_is_read_for_what_it_says_of_its_writer_alone() -> None:
    assert stated_looks("I am a 34-year-old nurse, and my mother is 70.").age == 34
    assert stated_looks("I'm in my seventies and wear reading glasses.").age == 75
    assert stated_looks("I am a mother of two.").figure == "woman"
    assert stated_looks("I am 68, a carpenter and a widower.").figure == "man"
    assert stated_looks("I wear thick glasses and comb my long beard.") == Looks(glasses=True, beard="full")
    assert stated_looks("I ring my mother, and I live with my retired father, who is bald.") == Looks()
    assert stated_looks("I am close to my grandfather. I drink from tall glasses.") == Looks()
    assert stated_looks("I am 20 minutes from work.") == Looks()


def test_a_child_is_drawn_as_the_youngest_body_there_is() -> None:
    assert stated_looks("I am 12 years old. I like video games.").age == 16


def test_what_a_file_states_comes_first_and_leaves_the_rest_as_drawn() -> None:
    drawn = appearance_of("I am 70.", "somebody", Looks(figure="woman"))
    stated = appearance_of("I am 70.", "somebody", Looks(figure="woman", hair="bun", hair_colour="red", glasses=True))
    assert (stated.hair_style, stated.hair) == ("bun", HAIRS["red"])
    assert stated.glasses is not None
    assert (stated.skin, stated.measures, stated.day) == (drawn.skin, drawn.measures, drawn.day)


def test_people_who_ship_state_their_looks_and_all_differ() -> None:
    people = [read_persona(path) for path in sorted(SHIPPED.glob("*.yaml"))]
    assert all(one.appearance is not None for one in people)
    assert len({appearance_of(one.profile, one.id, one.appearance) for one in people}) == len(people)


def test_every_motion_has_an_outfit_that_suits_it() -> None:
    library = load_library()
    outfits = {caption: outfit_for(caption, "bed_1") for caption in library.captions}
    dressed = {name: {c for c, outfit in outfits.items() if outfit == name} for name in set(outfits.values())}
    assert dressed["bath"] == {"take a shower", "lie in the bath", "dry off with a towel"}
    assert dressed["sleep"] == {"lie down", "take a nap", "lie and read"}
    assert dressed["sport"] == {caption for caption in library.captions if library[caption].cls == "exercise"}
    assert outfit_for("take a nap", "sofa_1") == "day"


def test_balls_take_the_persons_colours_and_the_bath_leaves_no_shirt() -> None:
    looks = looks_of("person-3")
    day = painted(looks, "day")
    assert set(day) == set(PAINTS)
    assert day["skin"] == looks.skin
    assert day["shirt"] == looks.day.top_colour
    man = appearance_of("", "person-3", Looks(figure="man"))
    assert painted(man, "bath")["shirt"] == man.skin
