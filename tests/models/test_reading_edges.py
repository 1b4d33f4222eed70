"""What a reader says of replies that it refuses, what it counts, and what must not be read at all."""

from __future__ import annotations

import json
from typing import Any

import pytest

from coopera.core.people import Frozen
from coopera.core.replies import REPLIES, FreeMotionDraft, FreeMotionReply, PickPlaceReply, VerdictsReply
from coopera.models.parsing import BadReplyError, Wanted, read_reply
from coopera.models.reading.names import nearest
from tests.models.test_reading import GIVEN, HOME


def test_the_names_nearest_to_an_unknown_one_are_suggested() -> None:
    text = '{"tasks": [{"thought": "To read.", "act": {"object": "magazine_2", "receptacle": "tabel"}}]}'
    said = read_reply(text, Wanted(PickPlaceReply, {**HOME, "n_tasks": 1})).strays
    assert 'there is no "magazine_2"; the nearest are ["magazine_1"]' in said
    assert 'there is no "tabel"; the nearest are ["table_1", "table_2"]' in said
    assert nearest("unicorn", HOME["movable"]) == []


def test_ids_come_from_the_prompt_and_those_of_unknown_objects_stand_for_none() -> None:
    text = '{"tasks": [{"thought": "x", "act": {"target": "bed_1", "in_hand": "book", "motion": "rest"}}]}'
    assert read_reply(text, Wanted(FreeMotionReply, HOME)).reply.tasks[0].act.target_id == -1
    own = '{"tasks": [{"thought": "x", "act": {"target_id": 4, "target": "bed_1", "in_hand": "b", "motion": "rest"}}]}'
    assert read_reply(own, Wanted(FreeMotionReply, {})).reply.tasks[0].act.target_id == 4
    with pytest.raises(BadReplyError, match="target_id: Field required"):
        read_reply(text, Wanted(FreeMotionReply, {}))


class Checked(Frozen):
    """A verdict on a draft, with the draft as it should be where it must change."""

    reason: str = ""
    yes: bool
    task: FreeMotionDraft | None = None


class CheckedReply(Frozen):
    """Verdicts on drafts, and further drafts."""

    items: list[Checked]
    more: list[FreeMotionDraft] = []


DRAFT = {"thought": "Peace.", "act": {"target": "Sofa", "in_hand": "book", "motion": "rest"}}


@pytest.mark.parametrize(
    ("value", "changed"),
    [
        ({"items": [{"yes": "yes", "task": "null"}, {"yes": "no", "task": DRAFT}], "more": None}, [None, 7]),
        ([{"yes": True, "task": {}}, {"yes": False, **DRAFT}], [None, 7]),
        ({"items": [{"yes": True, "thought": "It may stay."}]}, [None]),
    ],
)
def test_what_may_be_left_out_is_read_as_left_out_and_what_is_there_is_kept(value: Any, changed: list[Any]) -> None:
    reply = read_reply(json.dumps(value), Wanted(CheckedReply, HOME)).reply
    assert [one.task and one.task.act.target_id for one in reply.items] == changed


def test_each_leniency_is_counted_by_kind() -> None:
    text = "{'answer': {'verdicts': [{'yes': 'yes', 'reason': None, 'id': 1}, {'yes': False, 'reason': 'w " + "w " * 300
    found = read_reply(text + "', 'id': 2}]}}", Wanted(VerdictsReply, GIVEN["two"]))
    assert found.leniencies == {"cut": 1, "extra field": 2, "json": 1, "null": 1, "wrapper": 1, "yes/no": 1}
    reason = found.reply.verdicts[1].reason
    assert len(reason) <= 400
    assert reason.endswith("w…")


MANY_WANTS = [f"thing {n}" for n in range(13)]
LONG_WANT = "a very soft cushion " * 5


@pytest.mark.parametrize(
    ("wants", "read_as", "leniency"),
    [
        (["desk", None], ["desk"], "list"),
        (["", "none", "...", "N/A", 7, True], [], "list"),
        ("none", [], "list"),
        ("desk, pen", ["desk", "pen"], "list"),
        ('["desk", "pen"]', ["desk", "pen"], "list"),
        (5, [], "list"),
        ({"furniture": ["desk"], "things": ["pen", {"name": "ink"}]}, ["desk", "pen", "ink"], "list"),
        ([[[[[["deep"]]]]]], [], "list"),
        (["\ud800"], [], "list"),
        (MANY_WANTS, MANY_WANTS[:12], "cut"),
        ([LONG_WANT[:81]], [LONG_WANT[:71] + "…"], "cut"),
        (["desk", "pen"], ["desk", "pen"], None),
        (["string"], ["string"], None),
    ],
)
def test_what_is_wanted_never_costs_the_intention(wants: Any, read_as: list[str], leniency: str | None) -> None:
    found = read_reply(json.dumps({"intention": "Write", "wants": wants}), Wanted(REPLIES["IntentionReply"], {}))
    assert found.reply.model_dump()["wants"] == read_as
    assert found.leniencies == ({leniency: 1} if leniency else {})


def test_a_review_that_drops_a_task_without_saying_so_is_told_what_is_missing() -> None:
    with pytest.raises(BadReplyError, match="say the task as it should be, or null"):
        read_reply('{"reviews": [{"yes": false}]}', Wanted(REPLIES["FreeMotionReflectionReply"], GIVEN["draft"]))


def test_thinking_without_an_end_is_no_answer() -> None:
    with pytest.raises(BadReplyError, match="its thinking never ended"):
        read_reply('<think>{"verdicts": [true, true]}', Wanted(VerdictsReply, GIVEN["two"]))


def test_a_lost_comma_joins_no_items_of_a_list() -> None:
    wanted = Wanted(REPLIES["IntentionReply"], {})
    with pytest.raises(BadReplyError, match="a comma is missing"):
        read_reply('{"intention": "Read", "wants": ["sofa" "book"]}', wanted)
    two_lines = '{"intention": "Read", "wants": ["sofa"\n"book"]}'
    assert read_reply(two_lines, wanted).reply.model_dump()["wants"] == ["sofa", "book"]


@pytest.mark.parametrize(
    "text",
    [
        '{"verdicts": ' * 20_000,
        "{" * 50_000,
        "[" * 50_000,
        '[{"a":' * 20_000,
        '{"verdicts": [{"yes": ' + "9" * 5_000 + "}, {}]}",
        '{"grades": [{"grade": 1e999}, {"grade": -Infinity}]}',
        '{"verdicts": [{"yes": NaN}, {"yes": NaN}]}',
        '"' * 100_000,
        "{'" * 50_000,
        '{"answer": ' * 5 + '{"verdicts": [true, true]}' + "}" * 5,
        json.dumps({"answer": json.dumps({"answer": "[" * 10_000})}),
    ],
    ids=lambda text: text[:30],
)
@pytest.mark.parametrize("reply", ["VerdictsReply", "GradesReply"])
def test_depth_and_size_without_end_are_refused_in_a_sentence(text: str, reply: str) -> None:
    with pytest.raises(BadReplyError) as err:
        read_reply(text, Wanted(REPLIES[reply], GIVEN["two"]))
    assert 0 < len(str(err.value)) < 500
