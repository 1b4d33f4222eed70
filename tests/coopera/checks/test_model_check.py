from __future__ import annotations

from pathlib import Path

import pytest

from coopera.checks import model as model_check
from coopera.models.settings import CallSettings
from tests.coopera.commands.test_cli import Cli
from tests.fakes import LetterEmbeddings
from tests.serving import serving
from tests.tiny import SEEING, random_llava, word_tokenizer


def test_a_server_is_tried_with_real_calls(coopera: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-secret-and-long")
    with serving() as url:
        said = coopera("models", "check", "openai:tiny+images", "--base-url", url, "--json")
    assert said.code == 0
    assert said.json["structure"] == "json_schema"
    assert [check["check"] for check in said.json["checks"]] == ["structured reply", "objects that exist", "pictures"]
    assert all(check["ok"] and check["attempts"] == 1 for check in said.json["checks"])
    assert "sk-secret" not in said.out + said.err


def test_a_server_that_says_nothing_useful_fails_the_check(coopera: Cli) -> None:
    with serving("--refuse", "response_format", "tools") as url:
        said = coopera("models", "check", "openai:tiny", "--base-url", url)
    assert said.code == 1
    assert "FAILS: structured reply, told in words only" in said.out


def test_a_model_that_is_not_there_is_refused_or_fails(coopera: Cli, tmp_path: Path) -> None:
    assert coopera("models", "check", f"huggingface:{tmp_path / 'nowhere'}").code == 2
    study = tmp_path / "study.yaml"
    study.write_text("calls: {retries: 0}")
    said = coopera("models", "check", "openai:x", "--base-url", "http://127.0.0.1:9/v1", "--study", study)
    assert said.code == 1
    assert "Connection error" in said.out


def test_a_tiny_model_with_eyes_passes(tmp_path: Path) -> None:
    model = random_llava(tmp_path / "llava", word_tokenizer(SEEING, "<image>"))
    backend, tried = model_check.check_model(
        f"huggingface:{model}",
        base_url=None,
        settings=CallSettings(max_tokens=64),
        embeddings=LetterEmbeddings(),
    )
    assert [one.ok for one in tried] == [True, True, True]
    assert "works: structured reply, held to a JSON schema" in model_check.in_words(backend, tried[0])


def test_a_household_file_is_counted_and_what_no_home_has_is_named(coopera: Cli, tmp_path: Path) -> None:
    shipped = Path(__file__).parents[3] / "examples" / "my_household.yaml"
    own = tmp_path / "own.yaml"

    def checked(file: Path) -> model_check.Tried:
        given = {"base_url": None, "settings": CallSettings(), "embeddings": LetterEmbeddings()}
        return model_check.check_model(f"offline:{file}", **given)[1][-1]

    assert checked(shipped).ok
    assert checked(shipped).words.startswith("53 activities; ")
    own.write_text(shipped.read_text().replace("[workbench, desk,", "[workbenche, desk,"))
    assert not checked(own).ok
    assert "field 'fixed': no home has the furniture 'workbenche'; did you mean 'workbench'?" in checked(own).words
    own.write_text(shipped.read_text().replace("glue: repair with tools", "glue: fly"))
    said = coopera("models", "check", f"offline:{own}")
    assert said.code == 2
    assert f"{own}: activity 'model_railway', field 'things.glue': 'fly' is not listed under looks_like" in said.err
