"""What is true of a home now, as functions; `evaluate` takes any goal of one moment as text.

The usual notation: "on(mug, dining table)", "holding(human, mug)", "near(robot, sofa)", "at(human, kitchen)",
"performed(sit and read)", or "performed(ana, sit and read)" where there is more than one person. All that can be said
is in `coopera.simulation.goals.tree.PREDICATES`.
"""

from __future__ import annotations

from coopera.simulation.goals.atoms import Moment, Similarity, true
from coopera.simulation.goals.atoms import at as at
from coopera.simulation.goals.atoms import holding as holding
from coopera.simulation.goals.atoms import near as near
from coopera.simulation.goals.atoms import performed as performed
from coopera.simulation.goals.judging import holds
from coopera.simulation.goals.reading import read_goal
from coopera.simulation.goals.tree import Atom
from coopera.simulation.homes.scene import Scene
from coopera.simulation.state.home_state import HomeState


def on(scene: Scene, state: HomeState, cls: str, receptacle: str) -> bool:
    """Whether some thing of a class is on some furniture of a class; what is inside it is not on it."""
    return true(Moment(scene, state), Atom("on", (cls, receptacle)))


def evaluate(scene: Scene, state: HomeState, predicate: str, similarity: Similarity | None = None) -> bool:
    """Whether a written goal holds.

    Raises:
        ConfigError: If it is none, is about a day, or has a word that means nothing in this home.
    """
    return holds(read_goal(predicate), scene, state, similarity)
