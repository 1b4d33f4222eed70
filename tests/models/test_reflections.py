"""The door and the reflections: what a reply is held to, and the order of calls that were made at once."""

from __future__ import annotations

import json

from coopera.core.replies import FreeMotionReflectionReply
from tests.models.test_door import AT, door_to


def test_a_reflection_reviews_each_task_once_and_names_objects_of_the_prompt_in_what_it_changes() -> None:
    act = {"target": "stove_9", "in_hand": "book", "motion": "sit and read"}
    change = {"reason": "no stove", "yes": False, "task": {"thought": "I sit.", "act": act}}
    stays = {"reason": "fine", "yes": True, "task": None}
    right = {**change, "task": {**change["task"], "act": {**act, "target": "sofa_2"}}}  # type: ignore[dict-item]
    door, model = door_to(*(json.dumps({"reviews": some}) for some in ([stays], [stays, change], [stays, right])))
    variables = {"say": "Look.", "fixed": {"sofa_2": [2, "study"]}, "tasks": [{}, {}]}
    reply = door("judge/tasks", FreeMotionReflectionReply, at=AT, variables=variables)
    assert [review.task is None for review in reply.reviews] == [True, False]
    assert "reviews: there must be 2 of them, not 1" in model.asked[1][-1].text
    assert 'reviews.1.task.act.target: there is no "stove_9"' in model.asked[2][-1].text


def test_calls_of_parallel_nodes_come_out_in_the_order_of_the_prompts() -> None:
    door, _ = door_to(*['{"reviews": []}'] * 4)
    later = AT._replace(hour=AT.hour + 1)
    for node, at in (("scene", AT), ("scene", later), ("profile", later), ("profile", AT)):
        prompt = f"human/reflect_{node}_type2"
        door(prompt, FreeMotionReflectionReply, at=at._replace(node=node), variables={"say": "Look."})
    assert [c.node for c in door.take_calls()] == ["profile", "scene", "profile", "scene"]
