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
from coopera.simulation.acts.plans import Play
from coopera.simulation.homes.catalogue import catalogue
from coopera.simulation.homes.scene import Room, Scene, SceneObject
from coopera.simulation.motions.library import Motion
from coopera.simulation.sight.recording import Filming, Moment, Shot
from coopera.simulation.sight.stage import Camera, Stage
from coopera.simulation.sight.timing import TICKS
from coopera.simulation.state.agents import PersonAgent

VIEWS, BESIDE = (62.0, -38.0), (118.0, -100.0)
"""Where the cameras stand, in degrees from where the person looks, to the left; and where before tall furniture."""
_TALL = 1.05
_FILMED = 8.0
"""A motion is filmed for so many seconds at least."""
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
}
_AROUND: dict[str, list[str]] = {"pour a drink": ["glass"]}
"""What else is there, on the furniture before one."""


class Take(NamedTuple):
    """A motion as somebody makes it in the studio."""

    motion: Motion
    world: World
    stage: Stage
    shot: Shot

    @property
    def views(self) -> tuple[float, float]:
        """Where the cameras stand."""
        target = next(piece for piece in self.world.layout.fixed if piece.id == 1)
        return BESIDE if target.size[2] > _TALL and self.world.state.person().place != target.xy else VIEWS

    def moment(self, share: float) -> Moment:
        """What is seen after a share of the motion's period."""
        first = self.shot.ticks - round(max(_FILMED, 2 * self.motion.keys.period) * TICKS)
        return self.shot.at(first + round(share * self.motion.keys.period * TICKS))

    def picture(self, share: float, view: float, size: tuple[int, int]) -> Image.Image:
        """The person after a share of the period, from so many degrees beside where they look."""
        person = self.world.state.person()
        self.stage.show(self.world.state, self.moment(share))
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
    first = _object(1, cls, (0.0, 0.0, 0.0), 0.0)
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
        RuntimeError: If that is refused.
    """
    with World(studio(motion), agents=[PersonAgent()]) as world:
        outcome = world.perform(HUMAN, usual_act(motion, world))
        if not outcome.ok:
            raise RuntimeError(f"{motion.caption}: {outcome.reason}")
        stage = Stage(world.layout, [HUMAN], {})
        try:
            person = world.state.person()
            film = Filming(world._ground, world.state, HUMAN, HUMAN).film([Play(HUMAN, person, motion)], HUMAN)
            yield Take(motion, world, stage, film.shots[-1])
        finally:
            stage.close()


def strip(motion: Motion, shares: Sequence[float], size: tuple[int, int]) -> Image.Image:
    """A motion at some shares of its period: a row for each view."""
    sheet = Image.new("RGB", (len(shares) * size[0], len(VIEWS) * size[1]), "white")
    with take(motion) as made:
        for row, view in enumerate(made.views):
            for column, share in enumerate(shares):
                sheet.paste(made.picture(share, view, size), (column * size[0], row * size[1]))
    return sheet
