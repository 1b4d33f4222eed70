from __future__ import annotations

import pytest

from benchmarks.offers import auc, of_things, read_pairs, threshold, whole
from coopera.core.hour import Task, TaskCandidate
from coopera.core.household import FreeMotion, HandOver
from coopera.evaluation.measures.similar import SIMILAR, helps, in_words
from coopera.evaluation.predicate import Predicate
from coopera.memory.embeddings import bundled

DRAW = FreeMotion(target_id=1, target="desk_1", in_hand="sketchbook_1", motion="draw")


def test_an_offer_is_compared_as_a_whole_with_each_task_by_the_threshold_of_its_kind() -> None:
    task = Task(id="9.2", thought="Sketch ideas.", act=DRAW)
    offer = TaskCandidate(intention="Work", thought="To note ideas", act=HandOver(object="notebook_1"))
    heard: list[tuple[str, str]] = []

    def alike(one: str, other: str) -> float:
        heard.append((one, other))
        return SIMILAR["hand_over"]

    assert helps(alike, offer, [task])
    assert heard == [
        ("To note ideas. bring the notebook.", "Sketch ideas. draw at the desk with the sketchbook in hand.")
    ]
    assert not helps(lambda one, other: SIMILAR["hand_over"] - 0.01, offer, [task])
    assert not helps(alike, offer, [])


def test_a_task_is_said_with_one_stop_after_its_thought() -> None:
    assert in_words(" Rest. ", "bring the pillow") == "Rest. bring the pillow."


def test_thresholds_are_set_on_tasks_that_report_nothing() -> None:
    setting, reporting = read_pairs()
    assert min(len(setting), len(reporting)) >= 60
    assert not {pair.wanted for pair in setting} & {pair.wanted for pair in reporting}
    for half in (setting, reporting):
        assert 0.3 < sum(pair.helps for pair in half) / len(half) < 0.6


@pytest.mark.slow
def test_on_held_out_offers_whole_tasks_tell_better_than_things_alone() -> None:
    setting, reporting = read_pairs()
    with bundled() as embeddings:
        predicate = Predicate(embeddings)
        for kind, at in SIMILAR.items():
            ours = [pair for pair in setting if pair.kind == kind]
            set_at = threshold([whole(predicate, pair) for pair in ours], [pair.helps for pair in ours])
            assert set_at == pytest.approx(at, abs=0.03), "the threshold in use is the one that the first half sets"
            theirs = [pair for pair in reporting if pair.kind == kind]
            labels = [pair.helps for pair in theirs]
            by_whole = auc([whole(predicate, pair) for pair in theirs], labels)
            assert by_whole > 0.85 > auc([of_things(predicate, pair) for pair in theirs], labels)
