from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

import chromadb
import numpy as np
import pytest
from chromadb.config import Settings

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory import MemoryStream, Record, bundled
from coopera.memory.folder import CHROMA
from coopera.memory.ram import RamClient, RamCollection
from tests.memory.fakes import Letters


def texts_of(found: Sequence[tuple[str, ...]] | Sequence[object]) -> list[str]:
    return [record.text for record in found]  # type: ignore[attr-defined]


@pytest.fixture(params=["folder", "ram"])
def stream(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[MemoryStream]:
    where = tmp_path / "store" if request.param == "folder" else RamClient()
    with MemoryStream.open(where, "human/mara/intentions", Letters()) as opened:
        yield opened


def test_a_score_is_the_cosine_times_the_decay_to_the_hours_ago(stream: MemoryStream) -> None:
    stream.add(["ab"], 10)
    stream.add(["a"], 12)
    [first, second] = stream.recall("a", now=14, k=5)
    # a: cosine 1, two hours ago -> 0.95^2 = 0.9025;  ab: cosine 1/sqrt 2, four hours ago -> 0.7071 x 0.8145 = 0.5760
    assert first[:5] == ("a", 12, 1.0, pytest.approx(0.9025, rel=1e-15), pytest.approx(0.9025, rel=1e-15))
    assert second.relevance == pytest.approx(0.5**0.5, rel=1e-7)
    assert second.score == second.relevance * second.recency == pytest.approx(0.57594, rel=1e-4)


def test_recent_memories_beat_slightly_better_ones_and_no_more_than_that(stream: MemoryStream) -> None:
    stream.add(["a"], 0)
    stream.add(["ab"], 6)  # 0.7071 against 0.95^6 = 0.7351
    assert texts_of(stream.recall("a", now=6, k=2)) == ["a", "ab"]
    stream.add(["ab"], 7)  # 0.7071 against 0.95^7 = 0.6983
    assert texts_of(stream.recall("a", now=7, k=1)) == ["ab"]


def test_of_equal_scores_the_newer_comes_first(stream: MemoryStream) -> None:
    stream.add(["a", "aa", "b", "aaa"], 3)
    assert texts_of(stream.recall("a", now=3, k=3)) == ["aaa", "aa", "a"]


def test_the_future_and_what_is_before_since_are_not_recalled(stream: MemoryStream) -> None:
    for hour in range(5):
        stream.add(["a" * (hour + 1)], hour)
    assert texts_of(stream.recall("a", now=3, k=9)) == ["aaaa", "aaa", "aa", "a"]
    assert texts_of(stream.recall("a", now=3, k=9, since=2)) == ["aaaa", "aaa"]
    assert stream.recall("a", now=3, k=9, since=4) == []
    assert stream.recall("a", now=-1, k=9) == []


def test_a_pause_of_years_does_not_blur_the_order(stream: MemoryStream) -> None:
    stream.add(["ab"], 0)
    stream.add(["a"], 1)
    assert texts_of(stream.recall("ab", now=200_000, k=2)) == ["ab", "a"]
    assert stream.recall("ab", now=200_000, k=1)[0].score == 0


def test_how_relevant_everything_is_is_told_in_order_of_time_whatever_its_age(stream: MemoryStream) -> None:
    assert stream.relevances(["a", "b"], now=9).relevances.shape == (2, 0)
    stream.add(["a", "b"], 0)
    stream.add(["ab"], 5)
    stream.add(["a"], 7)
    recalled = {(one.text, one.hour): one.relevance for one in stream.recall("a", now=5, k=9)}
    texts, hours, relevances = stream.relevances(["a", "b"], now=5)
    assert (texts, hours) == (["a", "b", "ab"], [0, 0, 5])
    assert relevances[0].tolist() == [recalled["a", 0], recalled["b", 0], recalled["ab", 5]]
    assert relevances.tolist() == [stream.relevances([one], now=5).relevances[0].tolist() for one in "ab"]
    assert stream.relevances(["a"], now=9, since=5)[:2] == (["ab", "a"], [5, 7])
    assert stream.relevances([], now=9).relevances.shape == (0, 4)
    texts, hours, relevances = stream.relevances(["a"], now=9, since=8)
    assert (texts, hours, relevances.shape) == ([], [], (1, 0))


def test_what_lies_without_the_bounds_is_as_relevant_as_the_nearest_of_them(stream: MemoryStream) -> None:
    stream.add(["a", "b", "ab", "aab"], 0)
    exact = stream.relevances(["a", "bb"], now=5).relevances
    for low, high in (np.sort(exact[0])[1:3], (0.0, 1.0), (0.5, 0.5)):
        told = stream.relevances(["a", "bb"], now=5, within=(low, high))
        assert told.texts == ["a", "b", "ab", "aab"]
        assert told.relevances.tolist() == np.clip(exact, low, high).tolist()


def test_recalling_changes_nothing(stream: MemoryStream) -> None:
    stream.add(["a", "b"], 0)
    assert stream.recall("a", now=5, k=2) == stream.recall("a", now=5, k=2)
    assert len(stream) == 2


def test_latest_gives_the_newest_first_and_records_the_oldest(stream: MemoryStream) -> None:
    stream.add(["a", "b"], 0, [{"n": 1}, {}])
    stream.add(["c"], 4)
    assert texts_of(stream.latest(2)) == ["c", "b"]
    assert texts_of(stream.latest(9)) == ["c", "b", "a"]
    assert stream.latest(0) == []
    assert [tuple(record) for record in stream.records()] == [("a", 0, {"n": 1}), ("b", 0, {}), ("c", 4, {})]
    assert texts_of(list(stream.records(since=1))) == ["c"]


def test_metadata_comes_back_as_it_was_given(stream: MemoryStream) -> None:
    own = {"act": {"kind": "pick_place", "object_id": 3}, "notes": ["ä", None, 0.1], "hour": "mine"}
    stream.add(["a"], 0, [own])
    assert stream.recall("a", now=0, k=1)[0].metadata == own
    assert stream.latest(1)[0].metadata == own


def test_another_opening_finds_everything_as_it_was(tmp_path: Path) -> None:
    with MemoryStream.open(tmp_path, "x", Letters()) as stream:
        for hour in range(0, 30, 3):
            stream.add(["a" * hour + "b", "c" * hour + "d"], hour)
        before = stream.recall("ab", now=40, k=20)
    with MemoryStream.open(str(tmp_path), "x", Letters()) as stream:
        assert stream.recall("ab", now=40, k=20) == before
        assert len(stream) == 20


def test_streams_of_one_store_are_apart_and_their_names_are_free(tmp_path: Path) -> None:
    names = ["human/mara/intentions", "human/mara/tasks", "x", " spaces und Übung ☕ ", "n" * 200]
    streams = [MemoryStream.open(tmp_path, name, Letters()) for name in names]
    for number, stream in enumerate(streams):
        stream.add(["a" * (number + 1)], number)
    assert [texts_of(stream.latest(5)) for stream in streams] == [["a"], ["aa"], ["aaa"], ["aaaa"], ["aaaaa"]]
    for stream in streams:
        stream.close()


def test_two_objects_for_one_stream_see_the_same_records(tmp_path: Path) -> None:
    first = MemoryStream.open(tmp_path, "x", Letters())
    second = MemoryStream.open(tmp_path, "x", Letters(), decay=0.5)
    first.add(["a"], 0)
    second.add(["b"], 1)
    assert texts_of(first.latest(2)) == ["b", "a"]
    assert second.recall("a", now=1, k=1)[0].recency == 0.5
    first.close()
    second.add(["c"], 2)
    assert len(second) == 3
    second.close()


def test_forgetting_an_hour_lets_it_be_done_again(tmp_path: Path) -> None:
    stream = MemoryStream.open(tmp_path, "x", Letters())
    for hour in range(5):
        stream.add(["a", "b"], hour)
    assert stream.forget_from(9) == 0
    assert stream.forget_from(3) == 4
    stream.add(["c", "d"], 3)
    assert texts_of(stream.latest(3)) == ["d", "c", "b"]
    stream.close()
    with MemoryStream.open(tmp_path, "x", Letters()) as again:
        assert texts_of(again.recall("cd", now=3, k=2)) == ["d", "c"]
        assert again.forget_from(-5) == 8
        assert len(again) == 0
        again.add(["a"], -7)


def test_more_than_a_thousand_records_are_forgotten_and_written_again(tmp_path: Path) -> None:
    """Beyond Chroma's sync threshold of 1000 rows, where its index goes to files."""
    stream = MemoryStream.open(tmp_path, "x", Letters())
    for hour in range(3):
        stream.add([f"{'abcd'[n % 4]} {n}" for n in range(900)], hour)
    assert stream.forget_from(1) == 1800
    stream.add([f"{'dcba'[n % 4]} new {n}" for n in range(1200)], 1)
    before = stream.recall("ab", now=2, k=2100)
    stream.close()
    with MemoryStream.open(tmp_path, "x", Letters()) as again:
        assert again.recall("ab", now=2, k=2100) == before
        assert len(before) == 2100
        assert texts_of(again.latest(1)) == ["a new 1199"]


def test_a_store_can_be_a_chroma_client_of_the_caller(tmp_path: Path) -> None:
    client = chromadb.PersistentClient(str(tmp_path), settings=Settings(anonymized_telemetry=False))
    with MemoryStream.open(client, "x", Letters()) as stream:
        stream.add(["a"], 0)
    with MemoryStream.open(client, "x", Letters()) as stream:
        assert texts_of(stream.recall("a", now=0, k=1)) == ["a"]


def test_what_was_added_is_recalled_without_asking_the_store_for_its_text(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    get = RamCollection.get
    monkeypatch.setattr(
        RamCollection, "get", lambda self, **given: asked.append(given["include"]) or get(self, **given)
    )
    with MemoryStream.open(RamClient(), "s", Letters()) as stream:
        stream.add([f"record {number}" for number in range(600)], hour=3, metadata=[{"pair": (1, 2)}] * 600)
        asked.clear()
        recalled = stream.recall("record", now=3, k=400)
        assert {tuple(one.metadata["pair"]) for one in recalled} == {(1, 2)}
        assert isinstance(recalled[0].metadata["pair"], list), "as the store would give it back"
        assert len(list(stream.records())) == 600
        assert len(stream.relevances(["record"], now=3).texts) == 600
    assert not asked


def test_with_real_embeddings_what_was_meant_is_recalled(tmp_path: Path) -> None:
    with MemoryStream.open(tmp_path, "x", bundled()) as stream:
        stream.add(["brew some coffee", "water the plants", "play the guitar"], 9)
        assert texts_of(stream.recall("make a hot drink", now=10, k=1)) == ["brew some coffee"]


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda s: s.add([""], 1), "not empty"),
        (lambda s: s.add(["a", " \n"], 1), "not empty"),
        (lambda s: s.add([None], 1), "not empty"),
        (lambda s: s.add("abc", 1), "list of texts"),
        (lambda s: s.add(["a" * 5_000_000], 1), "at most 100000 characters, not 5000000"),
        (lambda s: s.add(["a \ud800"], 1), "valid Unicode"),
        (lambda s: s.add(["a"], 1, [{"x": "\ud800"}]), "JSON"),
        (lambda s: s.add(["a"], 10**18), "within"),
        (lambda s: s.recall("a", 10**30, 1), "within"),
        (lambda s: s.recall("a", 1, 1, since="monday"), "whole number, not 'monday'"),
        (lambda s: s.add(["a"], 0), "hour 0 is before hour 1"),
        (lambda s: s.add(["a"], 1.5), "whole number, not 1.5"),
        (lambda s: s.add(["a"], True), "whole number"),
        (lambda s: s.add(["a"], 1, [{}, {}]), "1 texts came with 2"),
        (lambda s: s.add(["a"], 1, [{"x": float("nan")}]), "JSON"),
        (lambda s: s.add(["a"], 1, [{"x": object()}]), "JSON"),
        (lambda s: s.add(["a"], 1, ["no mapping"]), "mapping"),
        (lambda s: s.recall("", 1, 1), "not empty"),
        (lambda s: s.recall("a" * 5_000_000, 1, 1), "at most"),
        (lambda s: s.recall("a", 1, 0), "k must be at least 1, not 0"),
        (lambda s: s.recall("a", 1, -3), "k must be at least 1, not -3"),
        (lambda s: s.recall("a", "now", 1), "whole number"),
        (lambda s: s.relevances([""], 1), "not empty"),
        (lambda s: s.relevances("a", 1), "a list of texts, not the text 'a'"),
        (lambda s: s.relevances(["a"], "now"), "whole number"),
        (lambda s: s.relevances(["a"], 1, since="monday"), "whole number, not 'monday'"),
        (lambda s: s.relevances(["a"], 1, within=(0.6, 0.3)), r"the lower one first, not \(0.6, 0.3\)"),
        (lambda s: s.relevances(["a"], 1, within=(0.3, float("nan"))), "bounds of relevance must be two numbers"),
        (lambda s: s.relevances(["a"], 1, within=0.3), "bounds of relevance must be two numbers"),
        (lambda s: s.relevances(["a"], 1, within=("low", "high")), "bounds of relevance must be two numbers"),
        (lambda s: s.latest(-1), "negative"),
    ],
)
def test_bad_input_is_told_and_changes_nothing(stream: MemoryStream, call: object, says: str) -> None:
    stream.add(["a"], 1)
    with pytest.raises(ConfigError, match=says):
        call(stream)  # type: ignore[operator]
    assert texts_of(stream.latest(9)) == ["a"]
    stream.add(["b"], np.int64(1))


def test_a_vector_that_is_no_direction_is_refused(stream: MemoryStream) -> None:
    with pytest.raises(MemoryStoreError, match=r"norm 0\.0 for the text 'xyz'"):
        stream.add(["a", "xyz"], 0)
    assert len(stream) == 0
    stream.add(["a"], 0)
    with pytest.raises(MemoryStoreError, match="norm"):
        stream.recall("xyz", 0, 1)


@pytest.mark.parametrize("name", ["", "  ", "n" * 201, None])
def test_a_bad_name_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match="1 to 200 characters"):
        MemoryStream.open(tmp_path, name, Letters())


def test_a_name_that_cannot_be_printed_is_refused(tmp_path: Path) -> None:
    for name in ("a\nb", "a\0b", "\ud800"):
        with pytest.raises(ConfigError, match="must be printable"):
            MemoryStream.open(tmp_path, name, Letters())


def test_odd_texts_come_back_as_they_were(stream: MemoryStream) -> None:
    odd = ["a\0b", "a\r\n\tb", "a 'quoted' \"text\"; DROP TABLE", "a" * 100_000, "a 茶 \U0001f600 e\u0301", "  a  "]
    stream.add(odd, 0, [{"text": text} for text in odd])
    assert [(record.text, record.metadata["text"]) for record in stream.records()] == [(text, text) for text in odd]
    assert {item.text for item in stream.recall("a\0", 0, 9)} == set(odd)


@pytest.mark.parametrize("decay", [0, -1, 1.01, float("nan")])
def test_a_bad_decay_is_refused(tmp_path: Path, decay: float) -> None:
    with pytest.raises(ConfigError, match="decay"):
        MemoryStream.open(tmp_path, "x", Letters(), decay)


def test_an_unknown_stream_is_told_with_those_that_are_there(tmp_path: Path) -> None:
    MemoryStream.open(tmp_path, "known", Letters()).close()
    with pytest.raises(ConfigError, match="no memory stream 'other'; those there: known"):
        MemoryStream.open(tmp_path, "other", Letters(), create=False)
    with pytest.raises(ConfigError, match="there is no memory store"):
        MemoryStream.open(tmp_path / "nothing", "other", Letters(), create=False)
    assert not (tmp_path / "nothing").exists()


def test_a_stream_of_another_model_dimension_or_space_is_refused_with_the_reason(tmp_path: Path) -> None:
    with MemoryStream.open(tmp_path, "x", Letters()) as stream:
        stream.add(["a"], 0)
        with pytest.raises(MemoryStoreError, match="written with the embeddings 'letters', not 'others'"):
            MemoryStream.open(tmp_path, "x", Letters("others"))
    with pytest.raises(MemoryStoreError, match="written with the embeddings 'letters', not 'others'"):
        MemoryStream.open(tmp_path, "x", Letters("others"))
    with pytest.raises(MemoryStoreError, match="vectors of 4 numbers, not 6"):
        MemoryStream.open(tmp_path, "x", Letters(letters="dimens"))
    MemoryStream.open(tmp_path, "x", Letters()).close()


def test_a_folder_that_is_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(ConfigError, match=r"is no memory store, since it has no chroma\.sqlite3 but thesis\.txt"):
        MemoryStream.open(tmp_path, "x", Letters())
    with pytest.raises(ConfigError, match="this is a file"):
        MemoryStream.open(tmp_path / "thesis.txt", "x", Letters())
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


def test_a_second_process_is_told_who_has_the_store(tmp_path: Path) -> None:
    code = (
        "import sys\n"
        "from coopera.memory.store import Store\n"
        "from coopera.core.errors import MemoryStoreError\n"
        "try:\n    Store.open(sys.argv[1])\nexcept MemoryStoreError as err:\n    print(err)\nelse:\n    print('opened')"
    )

    def other_process() -> str:
        return subprocess.run(
            [sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=True
        ).stdout

    with MemoryStream.open(tmp_path, "x", Letters()):
        assert f"in use by process {os.getpid()} on " in other_process()
    assert other_process() == "opened\n"


def test_a_closed_stream_says_so(stream: MemoryStream) -> None:
    stream.close()
    stream.close()
    with pytest.raises(MemoryStoreError, match="closed"):
        stream.add(["a"], 0)


def test_chromas_log_which_each_write_reads_through_stays_short(tmp_path: Path) -> None:
    with MemoryStream.open(tmp_path, "life", Letters()) as stream:
        for day in range(5):
            stream.extend([Record("a" * (day * 60 + n + 1), day * 24, {}) for n in range(60)])
        with closing(sqlite3.connect(tmp_path / CHROMA)) as database:
            [waiting] = database.execute("SELECT count(*) FROM embeddings_queue").fetchone()
    assert waiting < 300  # of 600: those of the stream, and the vectors of its texts
