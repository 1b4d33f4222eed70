"""What fits: what can be done at a piece of furniture and with what, and what goes where.

Only what never changes while people and robots move about is asked here. A refusal names what would do.
"""

from __future__ import annotations

from coopera.core.affordances import Classes, Relation, affordances
from coopera.core.household import AgentId, FreeMotion, plain
from coopera.core.naming import ends_with
from coopera.simulation.acts.plans import Ground, UnableError
from coopera.simulation.acts.resting import bed_for, seat_for
from coopera.simulation.homes.catalogue import interiors
from coopera.simulation.homes.scene import SceneObject
from coopera.simulation.motions.library import Motion
from coopera.simulation.state.home_state import HomeState

_NAMED = 4
_WORDS = 120


def check_hands_over(ground: Ground, state: HomeState, agent: AgentId, name: str) -> None:
    """Only robots hand over, and only what can be carried.

    Raises:
        UnableError: Otherwise.
    """
    if agent not in ground.robots:
        raise UnableError("only the robot hands things over")
    check_words(name)
    wanted = state.find(ground.scene, name)
    if wanted is not None and wanted.fixed:
        raise UnableError(f"the {plain(name)} cannot be carried")


def check_moves(ground: Ground, agent: AgentId) -> None:
    """Only people move freely.

    Raises:
        UnableError: If it is a robot.
    """
    if agent not in ground.people:
        raise UnableError("only the person moves freely")


def check_place(ground: Ground, motion: Motion, target: SceneObject) -> None:
    """A motion can be done at a piece of furniture: by the affordances, and as there is a seat or a place to lie.

    Raises:
        UnableError: If not; names furniture of this home that would do.
    """
    if not affordances().suits(motion.caption, target.cls):
        raise UnableError(
            f"nobody can {motion.caption} at the {plain(target.name)}; {_instead(ground, motion, target)}"
        )
    if not bears(ground, motion, target):
        how = "sit" if motion.posture == "sit" else "lie"
        raise UnableError(
            f"there is nothing to {how} on at the {plain(target.name)} to {motion.caption}; "
            f"{_instead(ground, motion, target)}"
        )


def check_in_hand(ground: Ground, state: HomeState, act: FreeMotion) -> None:
    """What is to be in hand can be held.

    Raises:
        UnableError: If it is furniture.
    """
    check_words(act.in_hand)
    wanted = state.find(ground.scene, act.in_hand)
    if wanted is not None and wanted.fixed:
        raise UnableError(f"the {plain(act.in_hand)} cannot be held in a hand")


def check_words(name: str) -> None:
    """The words for a thing say something, and no more than the name of a thing may have.

    Raises:
        UnableError: Otherwise.
    """
    if not name.strip() or len(name) > _WORDS:
        raise UnableError(f"a thing is named in 1 to {_WORDS} characters, not {len(name)}")


def check_tools(ground: Ground, state: HomeState, act: FreeMotion, caption: str) -> None:
    """What a motion needs is in the hand, or somewhere in the home.

    Raises:
        UnableError: If not; names what would do.
    """
    known = affordances()
    needs = known.of(caption).needs
    if not needs or in_hand_is(ground, state, act.in_hand, needs):
        return
    if not any(is_one_of(state, thing, needs) for thing in state.objects(ground.scene)):
        names = [plain(name) for name in known.names(needs)]
        raise UnableError(
            f"to {caption} one needs a {' or a '.join(names[:_NAMED])}, and this home has none: "
            f"one of these must be in hand"
        )


def in_hand_is(ground: Ground, state: HomeState, in_hand: str, classes: Classes) -> bool:
    """Whether a thing, named by its name or in words, is one of some classes or groups."""
    thing = state.find(ground.scene, in_hand)
    return affordances().means_one_of(in_hand, classes) if thing is None else is_one_of(state, thing, classes)


def is_one_of(state: HomeState, thing: SceneObject, classes: Classes) -> bool:
    """Whether a thing is one of some classes or groups: by its class, or by its words if it is from the magic box."""
    known = state.box.get(thing.name)
    return (
        affordances().is_one_of(thing.cls, classes)
        if known is None
        else affordances().means_one_of(known.text, classes)
    )


def kind_of(state: HomeState, thing: SceneObject, classes: Classes) -> str:
    """Which of some classes or words a thing is: "apron" for a red apron; its own class where it is none of them."""
    known = state.box.get(thing.name)
    words = plain(thing.cls if known is None else known.text).lower()
    names = [plain(name).lower() for name in affordances().names(classes)]
    return max((name for name in names if ends_with(words, name)), key=len, default=words)


def check_receptacle(ground: Ground, thing: SceneObject, receptacle: SceneObject, relation: Relation) -> None:
    """A thing can be on, or inside, a receptacle.

    Raises:
        UnableError: If it is the thing itself, has no inside, or is too small; names what would do.
    """
    if thing.name == receptacle.name:
        raise UnableError(f"the {plain(thing.name)} cannot be put on itself")
    if relation == "on":
        return
    rows = interiors(receptacle)
    if not rows:
        containers = [one.name for one in ground.scene.fixed if interiors(one)]
        instead = f"; {' and '.join(containers[:_NAMED])} would do" if containers else ""
        raise UnableError(f"nothing can be put inside the {plain(receptacle.name)}{instead}")
    if not receptacle.fixed and affordances().contains(thing.cls):
        raise UnableError(f"the {plain(thing.name)}, which holds things itself, does not go into another one")
    width, depth = sorted(thing.size[:2])
    if not any(
        surface.clear >= thing.size[2]
        and min(surface.x1 - surface.x0, surface.y1 - surface.y0) >= width
        and max(surface.x1 - surface.x0, surface.y1 - surface.y0) >= depth
        for surface in rows
    ):
        raise UnableError(f"the {plain(thing.name)} is too large to go inside the {plain(receptacle.name)}")


def bears(ground: Ground, motion: Motion, target: SceneObject) -> bool:
    """Whether there is something to sit or lie on for a motion at a piece of furniture."""
    if motion.posture == "sit":
        standing = not affordances().of(motion.caption).seated
        return standing or target.cls == "rug" or seat_for(ground, target, []) is not None
    if motion.posture == "lie":
        return target.cls == "rug" or bed_for(target, []) is not None
    return True


def _instead(ground: Ground, motion: Motion, target: SceneObject) -> str:
    """Which furniture of the home would do for a motion, that of the same room first."""
    known = affordances()
    fits = [one for one in ground.scene.fixed if known.suits(motion.caption, one.cls) and bears(ground, motion, one)]
    fits.sort(key=lambda one: (one.room != target.room, one.name))
    if fits:
        return f"{' or '.join(one.name for one in fits[:_NAMED])} would do"
    places = [plain(cls) for cls in known.of(motion.caption).at or ()]
    return f"it takes a {' or a '.join(places[:_NAMED])}, and this home has none that would do"
