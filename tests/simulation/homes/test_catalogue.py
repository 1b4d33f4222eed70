from __future__ import annotations

import math
from pathlib import Path

import pytest
import yaml

from coopera.core.affordances import affordances
from coopera.core.errors import ConfigError
from coopera.simulation.homes.catalogue import (
    FILE,
    RECIPES,
    catalogue,
    interiors,
    lying_place,
    parts_of,
    read_catalogue,
    seat,
    surfaces,
)
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.shapes.kit import MOST_PARTS, Part

VOCABULARY_FIXED = 45
VOCABULARY_MOVABLE = 84
TAPS = ("bathtub", "kitchen_sink", "washbasin")
"""What stands above their rims is not counted in their height."""
HIGHEST = 1.3
"""The robot's arm was measured to reach this high."""


def instance(cls: str, *, yaw: float = 0.0) -> SceneObject:
    kind = catalogue().fixed[cls]
    return SceneObject(
        id=0,
        name=f"{cls}_1",
        cls=cls,
        category=kind.category,
        fixed=True,
        room="r",
        position=(2.0, 3.0, 0.0),
        yaw=yaw,
        size=kind.size,
        colour="#808080",
    )


def box_of(part: Part) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Bounds of a part, ignoring small tilts of boxes."""
    if part.kind == "box":
        half = part.half
    else:
        reach = part.radius if part.kind == "sphere" else part.length / 2 + (part.kind == "capsule") * part.radius
        half = (part.radius, part.radius, part.radius)
        if part.kind != "sphere":
            axis = 2 if abs(part.orientation[3]) == 1 else (0 if part.orientation[1] else 1)
            half = tuple(reach if i == axis else part.radius for i in range(3))  # type: ignore[assignment]
    low_high = tuple((p - h, p + h) for p, h in zip(part.position, half, strict=True))
    return low_high[0], low_high[1], low_high[2]


def test_the_whole_vocabulary_is_known_and_each_class_has_a_recipe() -> None:
    known = catalogue()
    assert len(known.fixed) == VOCABULARY_FIXED
    assert len(known.movable) == VOCABULARY_MOVABLE
    assert set(RECIPES) == set(known.fixed) | set(known.movable)


@pytest.mark.parametrize("cls", sorted(RECIPES))
def test_a_recipe_stays_within_the_engine_and_about_the_size_of_the_thing(cls: str) -> None:
    known = catalogue()
    size = (known.fixed.get(cls) or known.movable[cls]).size
    parts = parts_of(cls, size, (0.5, 0.5, 0.5))
    assert 2 <= len(parts) <= MOST_PARTS
    for axis, (low, high) in enumerate([(-size[0] / 2, size[0] / 2), (-size[1] / 2, size[1] / 2), (0.0, size[2])]):
        slack = 0.06 + 0.12 * size[axis] + (0.3 if axis == 2 and cls in TAPS else 0.0)
        edges = [box_of(part)[axis] for part in parts]
        assert min(edge[0] for edge in edges) >= low - slack
        assert max(edge[1] for edge in edges) <= high + slack
        assert max(edge[1] for edge in edges) - min(edge[0] for edge in edges) >= 0.6 * size[axis]


@pytest.mark.parametrize("cls", sorted(RECIPES))
def test_a_recipe_bears_any_proportions(cls: str) -> None:
    sizes = [(0.02, 0.02, 0.02), (5.0, 0.02, 0.3), (0.05, 3.0, 0.05), (0.1, 0.1, 4.0)]
    for part in (part for size in sizes for part in parts_of(cls, size, (0.2, 0.4, 0.6))):
        assert min(part.half) > 0
        assert part.radius > 0
        assert part.length > 0
        assert all(0 <= channel <= 1 for channel in part.rgba)
        assert math.isclose(sum(q * q for q in part.orientation), 1.0, abs_tol=1e-9)


def test_an_unknown_class_is_a_plain_box_with_its_top_as_surface() -> None:
    thing = instance("sofa").model_copy(update={"cls": "spaceship", "size": (1.0, 1.0, 0.7)})
    assert {part.kind for part in parts_of("spaceship", thing.size, thing.rgb)} == {"box"}
    assert [surface.z for surface in surfaces(thing)] == [0.7]
    assert catalogue().category("space_ship") == "space ship"


@pytest.mark.parametrize("cls", sorted(catalogue().fixed))
def test_every_piece_of_furniture_takes_things_within_reach_and_within_its_outline(cls: str) -> None:
    thing = instance(cls)
    for surface in surfaces(thing):
        assert 0 < surface.z <= HIGHEST
        assert -thing.size[0] / 2 <= surface.x0 < surface.x1 <= thing.size[0] / 2
        assert -thing.size[1] / 2 <= surface.y0 < surface.y1 <= thing.size[1] / 2


@pytest.mark.parametrize("cls", sorted(catalogue().fixed))
def test_a_surface_lies_on_something_that_is_drawn_there(cls: str) -> None:
    thing = instance(cls)
    parts = parts_of(cls, thing.size, thing.rgb)
    for surface in surfaces(thing):
        x, y = (surface.x0 + surface.x1) / 2, (surface.y0 + surface.y1) / 2
        tops = [
            edges[2][1]
            for edges in map(box_of, parts)
            if edges[0][0] - 0.02 <= x <= edges[0][1] + 0.02 and edges[1][0] - 0.02 <= y <= edges[1][1] + 0.02
        ]
        assert min(abs(top - surface.z) for top in tops) < 0.045


def test_one_sits_at_seat_height_facing_the_front() -> None:
    rest = seat(instance("armchair", yaw=math.pi / 2))
    assert rest is not None
    assert 0.35 < rest.z < 0.5
    assert rest.heading == pytest.approx(math.pi)
    assert rest.x < 2.0  # in front of the backrest, which stands at +x after the turn


def test_one_sits_only_on_seats_and_lies_only_where_a_body_fits() -> None:
    assert seat(instance("fridge")) is None
    assert lying_place(instance("armchair")) is None
    bed = lying_place(instance("bed"))
    assert bed is not None
    assert bed.heading == pytest.approx(math.pi / 2)
    tub = lying_place(instance("bathtub"))
    assert tub is not None
    assert tub.heading == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("stands: opposite:sofa", "stands: opposite:throne", "tv_stand"),
        ("stands: centre", "stands: ceiling", r"fixed\.dining_table"),
        ("- tuna", "- tuna", ""),
        ("category: vehicle", "category: rocket", r"fixed\.bicycle\.category must be one of.*'rocket'"),
        ("category: plant", "category: storage furniture", r"movable\.potted_plant\.category must be one of"),
        ("area: 18", "area: -3", r"rooms\.(kitchen|bedroom)\.area"),
        ("- dishwasher", "- dishwaser", "kitchen.*dishwaser"),
    ],
)
def test_a_mistake_in_an_edited_catalogue_is_named(tmp_path: Path, old: str, new: str, field: str) -> None:
    path = tmp_path / "catalogue.yaml"
    text = yaml.safe_dump(yaml.safe_load(FILE.read_text(encoding="utf-8")), width=1000, sort_keys=False)
    path.write_text(text.replace(old, new), encoding="utf-8")
    if not field:
        assert read_catalogue(path) == catalogue()
        return
    assert old in text
    with pytest.raises(ConfigError, match=rf"catalogue\.yaml.*{field}"):
        read_catalogue(path)


def test_a_catalogue_that_is_no_yaml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "c.yaml"
    path.write_text("fixed: [", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"c\.yaml"):
        read_catalogue(path)


@pytest.mark.parametrize("cls", sorted({**affordances().inside, **affordances().holds}))
def test_what_holds_things_has_places_for_them_within_its_outline(cls: str) -> None:
    known = catalogue()
    kind = known.fixed.get(cls) or known.movable[cls]
    thing = instance("fridge").model_copy(update={"cls": cls, "size": kind.size})
    w, d, h = kind.size
    places = interiors(thing)
    assert places
    for place in places:
        assert 0 < place.z < place.z + place.clear <= h
        assert -w / 2 < place.x0 < place.x1 < w / 2
        assert -d / 2 < place.y0 < place.y1 < d / 2
        assert place.z <= HIGHEST


def test_nothing_goes_into_what_has_no_inside() -> None:
    assert interiors(instance("dining_table")) == []
    assert interiors(instance("fridge").model_copy(update={"cls": "spaceship"})) == []
