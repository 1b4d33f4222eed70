"""What is true of a home now, as functions; `evaluate` takes any goal of one moment as text.

The usual notation: "on(mug, dining table)", "holding(human, mug)", "near(robot, sofa)", "at(human, kitchen)",
"performed(sit and read)", or "performed(ana, sit and read)" where there is more than one person. All that can be said
is in `coopera.simulation.acts.goals.tree.PREDICATES`.
"""

from __future__ import annotations

from coopera.simulation.acts.goals.atoms import Moment, Similarity, true
from coopera.simulation.acts.goals.atoms import at as at
from coopera.simulation.acts.goals.atoms import holding as holding
from coopera.simulation.acts.goals.atoms import near as near
from coopera.simulation.acts.goals.atoms import performed as performed
from coopera.simulation.acts.goals.judging import holds
from coopera.simulation.acts.goals.reading import read_goal
from coopera.simulation.acts.goals.tree import Atom
from coopera.simulation.acts.state import HomeState
from coopera.simulation.homes.scene import Scene


def on(scene: Scene, state: HomeState, cls: str, receptacle: str) -> bool:
    """Whether some thing of a class is on some furniture of a class; what is inside it is not on it."""
    return true(Moment(scene, state), Atom("on", (cls, receptacle)))


def evaluate(scene: Scene, state: HomeState, predicate: str, similarity: Similarity | None = None) -> bool:
    """Whether a written goal holds.

    Raises:
        ConfigError: If it is none, is about a day, or has a word that means nothing in this home.
    """
    return holds(read_goal(predicate), scene, state, similarity)
