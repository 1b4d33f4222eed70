"""A bare room with what a motion needs, and somebody who makes it there: for sheets of motions and tests by eye.

The person goes to the furniture and acts as in any home; only the cameras are ours.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from PIL import Image

from benchmarks.motions_at_home import usual_things
from coopera.core.affordances import affordances
from coopera.core.household import HUMAN, FreeMotion, SceneId
from coopera.simulation import World
from coopera.simulation.acts.planning import planned
from coopera.simulation.acts.plans import Plan, Play
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.motions.library import Motion
from coopera.simulation.sight.recording import Filming, Moment, Recording
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.timing import TICKS
from coopera.simulation.state.agents import PersonAgent
from coopera.simulation.state.home_state import PersonState

VIEWS, BESIDE = (62.0, -38.0), (118.0, -100.0)
"""Where the cameras stand, in degrees from where the person looks, to the left; and where before tall furniture."""
_TALL = 1.05
_CLEAR = {
    "shower": (-38.0, -62.0),
    "wardrobe": (-105.0, -145.0),
    "dishwasher": (95.0, -120.0),
    "washing_machine": (95.0, -120.0),
}
"""Where they stand at furniture of which a wall or a door hides who stands there from elsewhere."""
_THINGS = {
    "pour a drink": "wine bottle",
    "set the table": "plate",
    "tie the shoes": "running shoes",
    "wipe the surface": "soft cloth",
    "type on a keyboard": "laptop",
    "eat a meal": "plate",
    "sweep the floor": "broom",
    "mop the floor": "mop",
    "lie in the bath": "sponge",
    "fry in a pan": "frying pan",
    "stir a pot": "soup pot",
    "chop vegetables": "cutting board",
    "knead dough": "rolling pin",
    "do a puzzle": "jigsaw puzzle",
    "box and punch": "boxing gloves",
    "fold clothes": "t-shirt",
    "play the piano": "sheet music",
    "brush teeth": "toothbrush",
    "carry a box": "cardboard box",
    "load the machine": "plate",
}
"""What is in hand, where it is not the first thing that people usually have."""
_PLACES = {
    "wipe the surface": "dining_table",
    "pour a drink": "dining_table",
    "eat a meal": "dining_table",
    "type on a keyboard": "desk",
    "tie the shoes": "bench",
    "make the bed": "bed",
    "take a shower": "shower",
    "look in the mirror": "mirror",
    "sweep the floor": "rug",
    "mop the floor": "rug",
    "drink from a cup": "dining_table",
    "draw and paint": "desk",
    "write by hand": "desk",
    "do a puzzle": "dining_table",
    "water plants": "side_table",
    "feed the pet": "rug",
    "dust the shelves": "bookshelf",
    "fold clothes": "dining_table",
    "put on clothes": "rug",
}
_TURNED = {"bed": math.pi, "dishwasher": math.pi / 2, "washing_machine": math.pi / 2}
"""Furniture whose front is not where people come from otherwise (radians)."""
_AROUND: dict[str, list[str]] = {"pour a drink": ["glass"]}
"""What else is there, on the furniture before one."""


class Take(NamedTuple):
    """A motion as `person` makes it in the studio, at the end of `recording`."""

    motion: Motion
    stage: Stage
    recording: Recording
    person: PersonState

    @property
    def views(self) -> tuple[float, float]:
        """Where the cameras stand."""
        target = next(piece for piece in self.stage.scene.fixed if piece.id == 1)
        if target.cls in _CLEAR:
            return _CLEAR[target.cls]
        return BESIDE if target.size[2] > _TALL and self.person.place != target.xy else VIEWS

    def moment(self, share: float) -> Moment:
        """What is seen after a share of the motion's period."""
        shot = self.recording.shots[-1]
        assert shot.begun is not None
        return shot.at(shot.begun + round(share * self.motion.keys.period * TICKS))

    def picture(self, share: float, view: float, size: tuple[int, int]) -> Image.Image:
        """The person after a share of the period, from so many degrees beside where they look."""
        person = self.person
        self.stage.show(self.recording.state, self.moment(share))
        low = person.posture in ("lie", "floor")
        angle, away = person.yaw + math.radians(view), 2.2 if low else 2.1
        x, y = person.place[0] + 0.3 * math.cos(person.yaw), person.place[1] + 0.3 * math.sin(person.yaw)
        eye = (x + away * math.cos(angle), y + away * math.sin(angle), 1.9 if low else 1.75)
        target = (x, y, person.support + 0.2 if low else 0.85)
        image, _ = self.stage.picture(Camera(eye, target, 46.0), (2 * size[0], 2 * size[1]))
        return Image.fromarray(image).resize(size, Image.Resampling.LANCZOS)


def _object(number: int, cls: str, place: tuple[float, float, float], yaw: float, on: str | None = None) -> SceneObject:
    kind = catalogue().fixed.get(cls)
    known = kind or catalogue().movable[cls]
    what = {"id": number, "name": f"{cls}_{number}", "cls": cls, "category": known.category, "fixed": kind is not None}
    where = {"room": "studio", "position": place, "yaw": yaw, "on": on}
    return SceneObject.model_validate({**what, **where, "size": known.size, "colour": known.colours[0]})


def studio(motion: Motion, furniture: str = "") -> Scene:
    """The room, the furniture at which a motion is made, a seat before it where one sits, and what is around."""
    places = affordances().of(motion.caption).at
    cls = furniture or _PLACES.get(motion.caption) or (places[0] if places else "rug")
    if motion.posture == "floor":
        cls = "rug"
    first = _object(1, cls, (0.0, 0.0, 0.0), _TURNED.get(cls, 0.0))
    pieces = [first]
    kind = catalogue().fixed[cls]
    depth, top = first.size[1], first.size[2]
    if motion.posture == "sit" and kind.seat is None and cls != "rug":
        seat = {"desk": "office_chair", "piano": "stool"}.get(cls, "dining_chair")
        deep = catalogue().fixed[seat].size[1]
        pieces.append(_object(2, seat, (0.0, depth / 2 + 0.42 * deep + 0.04, 0.0), math.pi))
    for number, thing in enumerate(_AROUND.get(motion.caption, ()), start=3):
        pieces.append(_object(number, thing, (0.06, depth / 2 - 0.2, top), 0.0, first.name))
    room = Room(name="studio", kind="study", x0=-3.5, y0=-3.5, x1=3.5, y1=3.5)
    return Scene(id=SceneId("studio"), rooms=[room], objects=pieces)


def usual_act(motion: Motion, world: World) -> FreeMotion:
    """A motion at the studio's first furniture, with a usual thing in hand."""
    target = next(piece for piece in world.layout.fixed if piece.id == 1)
    thing = _THINGS.get(motion.caption) or usual_things().get(motion.caption, "mug")
    return FreeMotion(target_id=target.id, target=target.name, in_hand=thing, motion=motion.caption)


@contextmanager
def take(motion: Motion) -> Iterator[Take]:
    """Somebody who makes a motion in the studio, with a usual thing in hand.

    Raises:
        UnableError: If that is refused.
    """
    with World(studio(motion), agents=[PersonAgent()]) as world:
        plan = planned(world._ground, world.state, HUMAN, usual_act(motion, world), None)
        stage = Stage(world.layout, [HUMAN], {})
        try:
            yield Take(motion, stage, *_filmed(world, plan))
        finally:
            stage.close()


def _filmed(world: World, plan: Plan) -> tuple[Recording, PersonState]:
    """An act up to its motion, and who makes that."""
    number, play = next((k, step) for k, step in enumerate(plan.steps) if isinstance(step, Play))
    before = world.state.model_copy(update={"box": plan.state.box})
    return Filming(world._ground, before, HUMAN, HUMAN).film(plan.steps[: number + 1], HUMAN), play.person


def strip(motion: Motion, shares: Sequence[float], size: tuple[int, int]) -> Image.Image:
    """A motion at some shares of its period: a row for each view."""
    sheet = Image.new("RGB", (len(shares) * size[0], len(VIEWS) * size[1]), "white")
    with take(motion) as made:
        for row, view in enumerate(made.views):
            for column, share in enumerate(shares):
                sheet.paste(made.picture(share, view, size), (column * size[0], row * size[1]))
    return sheet
