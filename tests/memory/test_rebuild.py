from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory import MemoryStream, Recollection, bundled, repair
from coopera.memory.folder import DamagedMemoryError
from coopera.memory.rebuild import Repaired
from coopera.memory.store import Store
from tests.memory.fakes import Letters

Break = Callable[[Path], None]
TELLS = "damaged: .*`coopera memory repair` rebuilds it from its texts, if .* whole, and `coopera doctor --repair` from"


def text(number: int) -> str:
    return "".join(letter * (number * prime % 7 + 1) for letter, prime in zip("abcd", (3, 5, 11, 13), strict=True))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of 1200 records and a small one; beyond 1000 rows Chroma's index goes to files."""
    folder = tmp_path_factory.mktemp("whole") / "memory"
    with MemoryStream.open(folder, "x", Letters()) as stream, MemoryStream.open(folder, "y", Letters()) as small:
        for hour in range(4):
            stream.add([text(hour * 300 + n) for n in range(300)], hour, [{"n": n} for n in range(300)])
        small.add(["a", "b"], 7)
    return folder


@pytest.fixture
def store(whole: Path, tmp_path: Path) -> Path:
    shutil.copytree(whole, tmp_path / "memory")
    return tmp_path / "memory"


def answers(folder: Path) -> list[Recollection]:
    """Read all of the stream "x", and use its index by writing to it, as a program would."""
    with MemoryStream.open(folder, "x", Letters()) as stream:
        found = stream.recall("abbd", 5, 1300) + stream.recall("c", 2, 9)
        stream.add([text(n) for n in range(1000)], 9)
        stream.forget_from(9)
        return found


def index_file(name: str, change: Callable[[bytes], bytes]) -> Break:
    def break_(folder: Path) -> None:
        for path in folder.glob(f"*/{name}"):
            path.write_bytes(change(path.read_bytes()))

    return break_


def flipped(data: bytes) -> bytes:
    return bytes(byte ^ 255 if place % 97 == 0 else byte for place, byte in enumerate(data))


def halved(data: bytes) -> bytes:
    return data[: len(data) // 2]


def without_index(folder: Path) -> None:
    for path in folder.iterdir():
        if path.is_dir():
            shutil.rmtree(path)


def sql(command: str) -> Break:
    def break_(folder: Path) -> None:
        database = sqlite3.connect(folder / "chroma.sqlite3")
        assert database.execute(command).rowcount == 1
        database.commit()
        database.close()

    return break_


def row(position: int) -> str:
    """SQL for the number of a record's row."""
    return f"(SELECT id FROM embeddings WHERE embedding_id = '{position:012d}')"


def written(position: int, record: str) -> Break:
    """Put another record, as SQL, in the place of one."""
    return sql(f"UPDATE embedding_metadata SET string_value = {record} WHERE key = 'record' AND id = {row(position)}")


INDEX_FILES = ("data_level0.bin", "header.bin", "link_lists.bin", "index_metadata.pickle")
SLOW_BREAKS = [
    pytest.param(index_file(name, change), id=f"{name} {change.__name__}")
    for name in INDEX_FILES
    for change in (flipped, halved)
]


def test_a_copy_of_a_whole_store_is_as_good_as_the_store(store: Path, whole: Path) -> None:
    assert answers(store) == answers(whole)


@pytest.mark.parametrize("break_", [pytest.param(index_file("link_lists.bin", flipped), id="links")])
def test_a_damaged_index_is_told_and_rebuilt_from_the_texts(store: Path, whole: Path, break_: Break) -> None:
    """Unchecked, these links would make Chroma write until the disk is full."""
    expected = answers(whole)
    break_(store)
    with pytest.raises(MemoryStoreError, match=TELLS):
        answers(store)
    assert repair(store, Letters()) == [Repaired("x", 1200, 0, 0), Repaired("y", 2, 0, 0)]
    assert answers(store) == expected
    assert repair(store, Letters()) == []
    with MemoryStream.open(store, "y", Letters()) as small:
        assert [record.text for record in small.latest(5)] == ["b", "a"]
    assert sorted(path.name for path in store.parent.iterdir()) == ["memory", "memory.damaged"]


@pytest.mark.slow
@pytest.mark.parametrize("break_", [*SLOW_BREAKS, pytest.param(without_index, id="no index")])
def test_any_damage_to_the_index_is_told_and_rebuilt_or_does_no_harm(store: Path, whole: Path, break_: Break) -> None:
    expected = answers(whole)
    break_(store)
    try:
        assert answers(store) == expected
    except MemoryStoreError as err:
        assert "memory repair" in str(err)  # noqa: PT017 - either is right
    repair(store, Letters())
    assert answers(store) == expected


def test_an_index_left_half_written_by_a_crash_is_rebuilt_on_opening_and_told(
    store: Path, whole: Path, caplog: pytest.LogCaptureFixture
) -> None:
    expected = answers(whole)
    (store / "closed.json").unlink()  # as while a process has it open
    index_file("link_lists.bin", halved)(store)
    assert answers(store) == expected
    assert "after a crash; rebuilt from its texts without loss" in caplog.text
    assert sorted(path.name for path in store.parent.iterdir()) == ["memory", "memory.damaged"]


def test_a_crash_that_took_a_record_with_it_is_told_instead_of_healed(store: Path) -> None:
    (store / "closed.json").unlink()
    index_file("link_lists.bin", halved)(store)
    sql(f"DELETE FROM embeddings WHERE id = {row(299)}")(store)
    with pytest.raises(DamagedMemoryError, match=TELLS):
        answers(store)
    assert sorted(path.name for path in store.parent.iterdir()) == ["memory"]


def test_a_rebuilding_that_was_killed_between_its_two_renamings_is_finished(store: Path, whole: Path) -> None:
    store.rename(store.with_name("memory.repaired"))
    assert answers(store) == answers(whole)


def test_a_store_that_is_open_bears_no_seal(store: Path) -> None:
    with MemoryStream.open(store, "x", Letters()):
        assert not (store / "closed.json").exists()
    assert (store / "closed.json").exists()


@pytest.mark.parametrize("record", ["000000003 1 1 evil", "000000003 1 evil", "evil", "soon 1 1 evil", "3 x y evil"])
def test_a_text_that_was_changed_behind_our_back_is_not_served(store: Path, record: str) -> None:
    written(1199, f"'{record}'")(store)
    with pytest.raises(DamagedMemoryError, match="the text of record 1199 is not what was written"):
        MemoryStream.open(store, "x", Letters())


def test_a_lost_vector_is_told_and_made_again_from_its_text(store: Path, whole: Path) -> None:
    sql("DELETE FROM embeddings WHERE id = (SELECT min(id) FROM embeddings WHERE length(embedding_id) = 40)")(store)
    with closing(sqlite3.connect(store / "chroma.sqlite3")) as database, database:
        database.execute("DELETE FROM embeddings_queue WHERE length(id) = 40")
    with pytest.raises(DamagedMemoryError, match="vectors cannot be read"):
        answers(store)
    assert repair(store, Letters()) == [Repaired("x", 1200, 0, 0), Repaired("y", 2, 0, 0)]
    assert answers(store) == answers(whole)


@pytest.mark.slow
def test_altered_and_missing_records_are_counted_and_the_rest_is_kept(store: Path) -> None:
    written(4, "'000000000 1 1 abc'")(store)
    written(699, "'000099999' || substr(string_value, 10)")(store)
    sql(f"DELETE FROM embeddings WHERE id = {row(299)}")(store)
    with pytest.raises(DamagedMemoryError, match="not numbered 0 to 1198"):
        answers(store)
    assert repair(store, Letters()) == [Repaired("x", 1199, missing=1, altered=2), Repaired("y", 2, 0, 0)]
    with MemoryStream.open(store, "x", Letters()) as stream:
        records = list(stream.records())
    assert records[4].text == "abc"
    assert (records[698].text, records[698].hour) == (text(699), 2)  # between its neighbours, not in hour 99999
    assert records[299].text == text(300)


@pytest.mark.slow
def test_where_the_texts_are_lost_too_repair_says_so_and_changes_nothing(store: Path) -> None:
    database = store / "chroma.sqlite3"
    database.write_bytes(halved(database.read_bytes()))
    before = {path: path.read_bytes() for path in store.rglob("*") if path.is_file()}
    with pytest.raises(MemoryStoreError, match="texts of the memory cannot be read either"):
        repair(store, Letters())
    assert {path: path.read_bytes() for path in before} == before
    with pytest.raises(MemoryStoreError, match=TELLS):
        MemoryStream.open(store, "x", Letters())


def test_repair_wants_a_store_that_nobody_uses_and_the_right_embeddings(store: Path, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there is no memory store"):
        repair(tmp_path / "nothing")
    with MemoryStream.open(store, "x", Letters()), pytest.raises(MemoryStoreError, match="in use by process"):
        repair(store, Letters())
    index_file("link_lists.bin", flipped)(store)
    with pytest.raises(MemoryStoreError, match="'letters' are not known by their name"):
        repair(store)
    with pytest.raises(MemoryStoreError, match="written with the embeddings 'letters', not 'others'"):
        repair(store, Letters("others"))
    assert not (tmp_path / "memory.damaged").exists()


@pytest.mark.slow
def test_the_bundled_embeddings_are_found_by_their_name(tmp_path: Path) -> None:
    cache = tmp_path / "cache.sqlite"
    with bundled(cache) as embeddings, MemoryStream.open(tmp_path / "m", "x", embeddings) as stream:
        stream.add(["make tea", "read"], 0)
        expected = stream.recall("drink", 1, 2)
    written(0, "'000000000 1 1 make tea'")(tmp_path / "m")
    assert repair(tmp_path / "m") == [Repaired("x", 2, missing=0, altered=1)]
    with bundled(cache) as embeddings, MemoryStream.open(tmp_path / "m", "x", embeddings) as stream:
        assert stream.recall("drink", 1, 2) == expected


def test_a_fork_does_not_inherit_the_stream(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with MemoryStream.open(store, "x", Letters()) as stream:
        monkeypatch.setattr("os.getpid", lambda: -1)
        with pytest.raises(MemoryStoreError, match="before a fork"):
            stream.latest(1)
        with pytest.raises(MemoryStoreError, match="in use by process"):
            Store.open(store)
        monkeypatch.undo()
        assert len(stream.latest(1)) == 1
