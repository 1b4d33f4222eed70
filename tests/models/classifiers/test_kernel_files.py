from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import CooperaError
from coopera.models.classifiers import Inputs
from tests.models.classifiers.feedback import WORDS, WordEmbeddings, ask, days, kernel, tea_in_the_morning


def test_a_saved_classifier_answers_as_before(tmp_path: Path) -> None:
    judge, again = kernel(), kernel()
    taught = days(tea_in_the_morning, profile="A quiet writer.", intentions=["wash clothes"], tasks=["bring the mug"])
    judge.train(taught, seed=0)
    judge.save(tmp_path / "a")
    again.load(tmp_path / "a")
    assert again.probabilities(taught) == judge.probabilities(taught)
    again.save(tmp_path / "b")
    assert {f.name: f.read_bytes() for f in (tmp_path / "a").iterdir()} == {
        f.name: f.read_bytes() for f in (tmp_path / "b").iterdir()
    }


def test_an_untrained_classifier_can_be_saved_and_makes_a_trained_one_forget(tmp_path: Path) -> None:
    kernel().save(tmp_path)
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    judge.load(tmp_path)
    assert judge.probabilities([ask("drink tea", 9)]) == [0.5]


def test_a_folder_of_another_kind_is_refused(tmp_path: Path) -> None:
    kernel(kind="task").save(tmp_path)
    with pytest.raises(CooperaError, match=r"classifier.json: field 'kind' is 'task', expected 'intention'"):
        kernel().load(tmp_path)


def test_a_folder_of_a_classifier_that_sees_other_fields_is_refused(tmp_path: Path) -> None:
    kernel(inputs=Inputs(traits=False)).save(tmp_path)
    with pytest.raises(CooperaError, match="field 'inputs'"):
        kernel().load(tmp_path)


def test_a_folder_learned_on_other_embeddings_is_refused(tmp_path: Path) -> None:
    kernel(embeddings=WordEmbeddings("elvish")).save(tmp_path)
    with pytest.raises(CooperaError, match="other embeddings"):
        kernel().load(tmp_path)


def test_a_folder_of_another_version_is_refused(tmp_path: Path) -> None:
    kernel().save(tmp_path)
    path = tmp_path / "classifier.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"version": 99}))
    with pytest.raises(CooperaError, match="field 'version' is 99"):
        kernel().load(tmp_path)


def test_an_empty_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CooperaError, match="no saved classifier"):
        kernel().load(tmp_path)


@pytest.mark.parametrize("name", ["classifier.json", "kernel.npz"])
def test_a_damaged_file_is_refused_and_what_was_known_stays(tmp_path: Path, name: str) -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    judge.save(tmp_path)
    before = judge.probabilities([ask("drink tea", 9)])
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: len(whole) // 2])
    with pytest.raises(CooperaError, match="damaged"):
        judge.load(tmp_path)
    assert judge.probabilities([ask("drink tea", 9)]) == before


def test_arrays_that_do_not_fit_together_are_refused(tmp_path: Path) -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    judge.save(tmp_path)
    with np.load(tmp_path / "kernel.npz") as stored:
        arrays = dict(stored)
    np.savez(tmp_path / "kernel.npz", **(arrays | {"weights": arrays["weights"][:-1]}))
    with pytest.raises(CooperaError, match="damaged"):
        judge.load(tmp_path)


def test_a_folder_of_an_earlier_version_with_vectors_in_place_of_texts_is_read(tmp_path: Path) -> None:
    judge, again = kernel(), kernel()
    taught = days(tea_in_the_morning, profile="A quiet writer.")
    judge.train(taught, seed=0)
    judge.save(tmp_path)
    with np.load(tmp_path / "kernel.npz") as stored:
        arrays = dict(stored)
    texts = json.loads(arrays.pop("texts").tobytes())
    vectors = np.array(WORDS.embed_documents(texts), np.float32)
    np.savez(tmp_path / "kernel.npz", **arrays, vectors=vectors)
    again.load(tmp_path)
    again.save(tmp_path / "again")
    again.load(tmp_path / "again")
    assert again.probabilities(taught) == judge.probabilities(taught)


@pytest.mark.parametrize("texts", [b"[]", b"{}", b"[1]", b"[", b"\xff"])
def test_texts_that_are_none_are_refused(tmp_path: Path, texts: bytes) -> None:
    judge = kernel()
    judge.train(days(tea_in_the_morning), seed=0)
    judge.save(tmp_path)
    with np.load(tmp_path / "kernel.npz") as stored:
        arrays = dict(stored)
    np.savez(tmp_path / "kernel.npz", **(arrays | {"texts": np.frombuffer(texts, np.uint8)}))
    with pytest.raises(CooperaError, match="damaged"):
        judge.load(tmp_path)


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(CooperaError, match="cannot be saved"):
        kernel().save(tmp_path / "file")
