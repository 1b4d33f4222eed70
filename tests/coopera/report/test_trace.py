from __future__ import annotations

import io
import json

import pytest
from rich.console import Console

from coopera.core.errors import ConfigError
from coopera.core.household import HUMAN, FreeMotion, Outcome
from coopera.report.tree import evening_tree, hour_tree, print_json, print_trees
from coopera.rundir.directory import RunDir


def shown(run: RunDir, day: int | None, hour: int | None) -> str:
    console = Console(width=4000, record=True, file=io.StringIO())
    print_trees(run, day, hour, console)
    return console.export_text()


def test_an_hour_shows_everything_that_was_thought_done_and_judged(small_run: RunDir) -> None:
    text = shown(small_run, 0, 10)
    record = small_run.read_day(0)[1]
    assert "day 0, 10 am · amara in maple" in text
    assert f"intention: {record.human.intention.text}" in text
    assert "who they are: It suits how I am." in text
    assert f"wanted: {record.human.intention.wants[0]}" in text
    for task in record.human.tasks:
        assert f"{task.id} {task.act.describe()}" in text
    assert "reflect_profile: 1 of 2 fine" in text
    assert "score 0.600 = recency 1.000 x relevance 0.610" in text
    for candidate in record.robot.intentions:
        assert f"{candidate.probability:.3f} intention {candidate.text}" in text
    assert ("right" in text) == any(task.correct for task in record.robot.tasks)
    counts = record.success.predicate
    assert f"(tp {counts.tp}, fp {counts.fp}, fn {counts.fn}, tn {counts.tn}, unscored {counts.unscored})" in text
    assert "robot/intentions · offline routine model" in text
    assert "evening" not in text


def test_a_motion_in_other_words_is_shown_with_its_clip_and_what_was_compared(
    small_run: RunDir,
) -> None:
    record = small_run.read_day(0)[1]
    act = FreeMotion(target_id=2, target="rug_1", in_hand="whistle", motion="march briskly")
    meant = Outcome(agent=HUMAN, act=act, ok=True, motion="run on the spot", cosine=0.41, asked="march with whistle")
    none = meant.model_copy(update={"motion": "stand and wait", "cosine": 0.2, "neutral": True})
    overruled = record.human.reflections[0].model_copy(update={"overruled": ["10.1: dance -> dropped"]})
    shown_hour = record.model_copy(
        update={
            "robot": record.robot.model_copy(update={"outcomes": [meant, none]}),
            "human": record.human.model_copy(update={"reflections": [overruled]}),
        }
    )
    console = Console(width=4000, record=True, file=io.StringIO())
    console.print(hour_tree(shown_hour))
    text = console.export_text()
    assert "as run on the spot (cosine 0.41 with 'march with whistle')" in text
    assert "as stand and wait, which is neutral: no motion comes near (cosine 0.20 with 'march with whistle')" in text
    assert "overruled 10.1: dance -> dropped" in text


def test_a_failed_hour_says_why_and_shows_the_faults(small_run: RunDir) -> None:
    text = shown(small_run, 1, 16)
    assert "failed: human/intention: the model's reply cannot be used" in text
    assert text.count("fault no JSON object found") == 3
    assert "4 attempts" in text


def test_a_day_ends_with_its_evening_and_no_markup_is_taken_from_data(small_run: RunDir) -> None:
    text = shown(small_run, 0, None)
    assert text.count("day 0, ") == 9
    assert "day 0, evening" in text
    assert "rest <b>early</b>." in text


def test_json_is_one_line_and_the_files_as_they_are(small_run: RunDir, capsys: pytest.CaptureFixture[str]) -> None:
    print_json(small_run, 0, 10)
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    assert json.loads(out) == json.loads((small_run.root / "trace/day-00/hour-10.json").read_text())
    print_json(small_run, None, None)
    found = json.loads(capsys.readouterr().out)
    assert len(found) == 4 * (8 + 1)
    assert "feedback" in found[8]
    assert [one["hour"] for one in found[:8]] == list(range(9, 17))


@pytest.mark.parametrize(
    ("day", "hour", "sentence"),
    [(9, None, "--day: there is no day 9 in .*; it has days 0 to 3"), (0, 8, "--hour: there is no hour 8 on day 0")],
)
def test_a_day_or_hour_that_is_not_there_is_refused(
    small_run: RunDir, day: int, hour: int | None, sentence: str
) -> None:
    with pytest.raises(ConfigError, match=sentence):
        shown(small_run, day, hour)


def test_an_evening_says_which_answers_were_slips(small_run: RunDir) -> None:
    evening = small_run.evenings()[0]
    first, *others = evening.feedback
    slipped = evening.model_copy(update={"feedback": [first.model_copy(update={"slip": True}), *others]})
    console = Console(width=4000, record=True, file=io.StringIO())
    console.print(evening_tree(slipped))
    assert console.export_text().count("(a slip: they meant the opposite)") == 1
    assert "slip" not in shown(small_run, evening.day, None)
