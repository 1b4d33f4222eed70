"""Whatever a model says, the tasks that leave the person's graph can be tried at home, or the hour fails in words."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coopera.core.asks import ASKS
from coopera.core.clock import Clock
from coopera.core.errors import ModelOutputError
from coopera.core.hour import DayPlan, ModelCall
from coopera.core.household import HUMAN, SceneId
from coopera.core.randomness import Address
from coopera.core.replies import REPLIES
from coopera.graphs import build_human_graph
from coopera.graphs.human import human_hour
from coopera.graphs.players.checks import findings
from coopera.graphs.robots.method import Numbers
from coopera.models.parsing import BadReplyError, Wanted, read_reply
from tests.fakes import MARA, FakeHome, moving, placing
from tests.graphs.conftest import MakeServices

NAMES = st.sampled_from(["stove_1", "desk_1", "sofa", "mug_2", "book_1", "none", "", "oven", "x" * 120]) | st.text(
    max_size=20
)
NUMBERS = st.integers(-5, 99)
PLACING = st.builds(placing, NAMES, NAMES, NUMBERS, NUMBERS)
MOVING = st.builds(moving, NAMES, NAMES, NAMES, NUMBERS)


def reviews(kind: Any) -> Any:
    said = st.fixed_dictionaries({"yes": st.booleans()}, optional={"task": st.none() | kind})
    return st.fixed_dictionaries({"reviews": st.lists(said, max_size=9)}, optional={"add": st.lists(kind, max_size=3)})


OBJECTS: Any = st.fixed_dictionaries(
    {},
    optional={
        "intention": st.sampled_from(["Cook", "", "Read"]),
        "tasks": st.lists(PLACING, max_size=9) | st.lists(MOVING, max_size=9) | st.none(),
        "reviews": st.lists(st.fixed_dictionaries({"yes": st.booleans()}), min_size=1, max_size=3),
    },
)


NINE: Any = {"clock": Clock(day=0, hour=9), "hours": [9]}


class AnyAsk:
    """Reads each drawn reply as the door does; one that cannot be read is the door's error.

    All are drawn beforehand, since the reflections ask in threads.
    """

    def __init__(self, draw: Any, collab: int) -> None:
        kind = PLACING if collab == 1 else MOVING
        fitting = {
            "human/intention": st.just({"intention": "Cook"}),
            f"human/tasks_type{collab}": st.lists(kind, min_size=1, max_size=8).map(lambda tasks: {"tasks": tasks}),
            f"human/reflect_profile_type{collab}": reviews(kind),
            f"human/reflect_scene_type{collab}": reviews(kind),
        }
        rounds = range(Numbers.SCENE_ROUNDS)
        self._drawn = {
            prompt: [draw(st.one_of(good, good, good, OBJECTS, st.text())) for _ in rounds]
            for prompt, good in fitting.items()
        }

    def __call__(self, prompt: str, reply: type[Any], /, *, at: Address, variables: Any, images: Any = ()) -> Any:
        assert REPLIES[ASKS[prompt].reply] is reply
        drawn = self._drawn[prompt][at.draw]
        text = drawn if isinstance(drawn, str) else json.dumps(drawn)
        try:
            return read_reply(text, Wanted(reply, variables)).reply
        except BadReplyError as err:
            raise ModelOutputError(prompt, text, str(err)) from err

    def sees(self, role: Any) -> bool:
        return False

    def instant(self, role: Any) -> bool:
        return True

    def take_calls(self, at: Any = None) -> list[ModelCall]:
        return []


@pytest.mark.parametrize("collab", [1, 2])
def test_tasks_that_leave_can_be_tried_or_the_hour_fails_with_a_reason(
    make_services: MakeServices, tmp_path: Path, collab: Any
) -> None:
    home, left = FakeHome(), []
    plan = DayPlan(day=0, episode_day=0, person=MARA.id, scene=SceneId("toy"), hours=[9], collab=collab)
    graph = build_human_graph()

    @settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
    @given(st.data())
    def live(data: Any) -> None:
        ctx = make_services(ask=AnyAsk(data.draw, collab), home=home).human(plan)
        try:
            hour = human_hour(graph.invoke(NINE, context=ctx))
        except ModelOutputError:  # the hour's graph records it as failed, with the reason
            return
        left.append(hour)
        assert 1 <= len(hour.tasks) <= 5
        assert findings(hour.tasks, home, HUMAN, len(hour.tasks)) == []

    live()
    assert left  # some hours must have been lived, or nothing was shown
