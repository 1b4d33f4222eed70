"""The plan of an act, whichever it is."""

from __future__ import annotations

from coopera.core.household import Act, AgentId, HandOver, PickPlace
from coopera.simulation.acts.activity import free_motion
from coopera.simulation.acts.fitting import check_hands_over, check_moves
from coopera.simulation.acts.plans import Ground, Plan, Watch
from coopera.simulation.acts.skills import hand_over, pick_place
from coopera.simulation.state.home_state import HomeState


def planned(ground: Ground, state: HomeState, agent: AgentId, act: Act, watch: Watch | None) -> Plan:
    """What an agent would do, step by step; with `watch`, a robot goes first to see it.

    Raises:
        UnableError: With the reason why it cannot be done.
    """
    if isinstance(act, PickPlace):
        return pick_place(ground, state, agent, act, watch)
    if isinstance(act, HandOver):
        check_hands_over(ground, state, agent, act.object)
        return hand_over(ground, state, agent, act)
    check_moves(ground, agent)
    return free_motion(ground, state, agent, act, watch)
