"""From a thing (and a place) in words to what a robot can do about it."""

from __future__ import annotations

from coopera.core.affordances import affordances
from coopera.core.household import Act, HandOver, PickPlace, Use, plain
from coopera.graphs.robots.robot_view import RobotView


def help_with(view: RobotView, use: Use) -> Act | None:
    """Bring the thing or, in type 1, put one of its kind where it goes; None where the home has no such thing."""
    if view.collab != 1:
        act: Act = HandOver(object=use.thing)
        return None if view.home.misfit(act) else act
    things = [name for name in view.home.movable if plain(name) == use.thing]
    spots = [name for name in view.home.fixed if plain(name) == use.place]
    if not things or not spots:
        return None
    act = PickPlace(
        object_id=view.home.movable[things[0]][0],
        object=things[0],
        receptacle_id=view.home.fixed[spots[0]][0],
        receptacle=spots[0],
        relation=affordances().relation(view.home.class_of(things[0]), view.home.class_of(spots[0])),
    )
    return None if view.home.misfit(act) else act
