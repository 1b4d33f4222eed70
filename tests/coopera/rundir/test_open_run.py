"""A run as a notebook sees it: tables, cards, and one sentence where something is missing."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from coopera import RunDir, open_run
from coopera.core.errors import ConfigError
from coopera.core.hour import HourRecord
from coopera.memory import MemoryStream
from coopera.memory.ram import RamClient
from coopera.rundir.run import Run
from coopera.simulation import load_scene
from tests.fakes import LetterEmbeddings

HOSTILE = '<script>alert("x")</script>' + "‮" + "y" * 100_000


@pytest.fixture
def run(small_run: RunDir) -> Run:
    return open_run(small_run.root)


def test_a_run_has_a_row_for_each_hour_and_the_figures_of_its_trace(run: Run) -> None:
    pytest.importorskip("pandas", reason="the tables need pandas")
    hours = run.hours
    assert list(zip(hours["day"], hours["hour"], strict=True)) == [(one.day, one.hour) for one in run.records]
    assert list(hours["status"]).count("failed") == 1
    one = run.records[0]
    assert one.human is not None
    assert one.success is not None
    first = hours.iloc[0]
    assert (first["intention"], first["person"], first["tp"]) == (
        one.human.intention.text,
        "amara",
        one.success.predicate.tp,
    )


def test_a_candidate_has_a_row_with_what_the_person_said_of_it(run: Run) -> None:
    pytest.importorskip("pandas", reason="the tables need pandas")
    rows = run.candidates
    wanted = sum(len(one.robot.intentions) + len(one.robot.tasks) for one in run.records if one.robot)
    assert len(rows) == wanted
    told = run.evenings[0].feedback[0]
    found = rows[(rows["day"] == 0) & (rows["hour"] == told.hour) & (rows["text"] == told.text)].iloc[0]
    assert (found["kind"], found["helpful"], found["said"]) == (told.kind, told.helpful, told.reason)


def test_a_call_has_a_row_and_an_evenings_call_no_hour(run: Run) -> None:
    pytest.importorskip("pandas", reason="the tables need pandas")
    calls = run.calls
    assert len(calls) == sum(len(one.calls) for one in [*run.records, *run.evenings])
    assert calls["hour"].isna().sum() == sum(len(one.calls) for one in run.evenings)
    assert set(calls["node"]) >= {call.node for call in run.records[0].calls}


def test_without_pandas_the_tables_say_what_to_install_and_the_rest_works(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ConfigError, match=r"need pandas: pip install coopera\[notebook\]"):
        _ = run.hours
    assert "amara" in run._repr_html_()


def test_a_folder_without_a_run_and_an_hour_that_is_not_there_are_named(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="this folder holds no run"):
        open_run(tmp_path)
    with pytest.raises(ConfigError, match="there is no day 9, 9 am"):
        run.hour(9, 9)


def test_the_cards_of_run_hour_home_and_memory_hold_no_script_and_load_nothing(run: Run) -> None:
    with MemoryStream.open(RamClient(), "human/0/amara/intentions", LetterEmbeddings()) as stream:
        stream.add(["read <b>a novel</b>"], 9)
        memory = stream._repr_html_()
    assert "read &lt;b&gt;a novel&lt;/b&gt;" in memory
    assert "closed" in stream._repr_html_()
    home = load_scene("maple")
    for card in (run._repr_html_(), run.records[0]._repr_html_(), home._repr_html_(), memory):
        assert "<script" not in card
        assert "http" not in card.replace("http://www.w3.org", "")
        assert "src=" not in card
    assert home._repr_html_().count("<rect") > len(home.objects)
    assert all(room.name in home._repr_html_() for room in home.rooms)


def test_hostile_text_stands_on_a_card_as_text_and_no_longer_than_a_card_is(run: Run) -> None:
    hour = run.records[0]
    assert hour.human is not None
    bad = hour.human.intention.model_copy(update={"text": HOSTILE})
    worse: HourRecord = hour.model_copy(update={"human": hour.human.model_copy(update={"intention": bad})})
    card = worse._repr_html_()
    assert "<script" not in card
    assert "&lt;script&gt;" in card
    assert len(card) < 20_000
