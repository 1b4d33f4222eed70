"""How free text is drawn: nothing is said twice, and what is no free text is drawn as ever."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import torch

from coopera.models.constrained import HeldReply
from coopera.models.huggingface import HuggingFaceChat, open_model
from coopera.models.settings import CallSettings
from coopera.models.small.free_text import FreeText, nucleus
from coopera.models.small.manner import PLAIN, SMALL, Manner
from tests.tiny import byte_tokenizer, random_llama

QUOTE = 7


@pytest.fixture(scope="module")
def llama(tmp_path_factory: pytest.TempPathFactory) -> HuggingFaceChat:
    return open_model(str(random_llama(tmp_path_factory.mktemp("llama"), byte_tokenizer())))


def _said(manner: Manner, *tokens: int) -> FreeText:
    text = FreeText(manner, frozenset({QUOTE}))
    for token in tokens:
        text.add(token)
    return text


def test_a_sequence_that_was_said_is_not_finished_again_and_not_in_the_next_text_either() -> None:
    scores = torch.zeros(10)
    manner = Manner(no_repeat=3)
    assert _said(manner, 1, 2, 3, 1, 2).held_back(scores)[3] == -torch.inf
    assert _said(manner, 1, 2, 3, QUOTE, 1, 2).held_back(scores)[3] == -torch.inf
    assert torch.equal(_said(manner, 1, 2, 3, 2).held_back(scores), scores), "another beginning"
    assert torch.equal(_said(manner, 1, 2, 3, 1, QUOTE, 2).held_back(scores), scores), "no sequence over a text's end"


def test_what_was_said_is_penalised_once_and_towards_less_likely() -> None:
    held = _said(Manner(repetition_penalty=2.0), 1, 1, 2).held_back(torch.tensor([1.0, 1.0, -1.0]))
    assert held.tolist() == [1.0, 0.5, -2.0]


def test_a_texts_end_is_never_held_back() -> None:
    ended = _said(SMALL, *([1, QUOTE] * 5)).held_back(torch.ones(10))
    assert ended[QUOTE] == 1.0
    assert ended[1] < 1.0


def test_the_nucleus_is_the_likeliest_tokens_that_reach_the_share() -> None:
    shares = torch.tensor([0.1, 0.5, 0.15, 0.25])
    assert nucleus(shares, 0.7).tolist() == pytest.approx([0, 0.5, 0, 0.25])
    assert nucleus(shares, 0.01).tolist() == pytest.approx([0, 0.5, 0, 0])
    assert torch.equal(nucleus(shares, 1.0), shares)


def test_settings_win_over_a_models_own_manner() -> None:
    assert CallSettings().manner() == PLAIN
    assert CallSettings().manner(SMALL) == SMALL
    assert CallSettings(no_repeat=0, top_p=1.0).manner(SMALL) == SMALL._replace(no_repeat=0, top_p=1.0)


def test_free_text_does_not_repeat_itself_and_names_may(tmp_path: Path) -> None:
    looping = open_model(str(random_llama(tmp_path, byte_tokenizer(), initializer_range=1e-4)))
    word = {"type": "string", "pattern": r"^[ !#-\[\]-~]{60}$"}
    item = {"type": "object", "properties": {"say": word, "name": {"enum": ["mug_1"]}}, "required": ["say", "name"]}
    schema = {"type": "array", "items": item | {"additionalProperties": False}, "minItems": 2, "maxItems": 2}

    def repeats(manner: Manner) -> int:
        said = looping.invoke("Go!", temperature=0.0, schema=schema, max_tokens=4000, manner=manner).text
        assert [one["name"] for one in json.loads(said)] == ["mug_1"] * 2
        pieces = [one["say"][n : n + 3] for one in json.loads(said) for n in range(len(one["say"]) - 2)]
        return len(pieces) - len(set(pieces))

    assert repeats(PLAIN) > 10, "such a model goes in circles"
    assert repeats(Manner(no_repeat=3)) == 0


def test_only_free_text_is_warmed_up(llama: HuggingFaceChat) -> None:
    def said(schema: dict[str, object], temperature: float) -> set[str]:
        manner = Manner(least_temperature=temperature)
        asked = {"temperature": 0.0, "schema": schema, "max_tokens": 64, "manner": manner}
        return {llama.invoke("Go!", seed=seed, **asked).text for seed in range(6)}

    assert len(said({"type": "string", "minLength": 9, "maxLength": 9}, 2.0)) > 1
    assert len(said({"type": "boolean"}, 2.0)) == 1


def test_what_must_come_needs_no_pass_of_the_network(llama: HuggingFaceChat) -> None:
    fields = {f"a_long_name_{n}": {"type": "boolean"} for n in range(4)}
    schema = {"type": "object", "properties": fields, "required": list(fields), "additionalProperties": False}
    passes: list[int] = []
    hook = llama._loaded.model.register_forward_pre_hook(lambda *_: passes.append(1))
    try:
        reply = llama.invoke("Go!", temperature=1.0, seed=3, schema=schema, max_tokens=200)
    finally:
        hook.remove()
    assert set(json.loads(reply.text)) == set(fields)
    assert len(passes) < reply.usage_metadata["output_tokens"] / 3


def test_a_forced_end_counts_towards_the_limit() -> None:
    row = HeldReply(temperature=0.0, seed=0, limit=2, ends=[9])
    row._forced.extend([1, 2, 3])
    assert (row.forced(), row.done) == ([1, 2], True)
