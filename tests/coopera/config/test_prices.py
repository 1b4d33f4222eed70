from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from coopera.config.prices import Prices, check_money, in_words, read_prices
from coopera.core.errors import ConfigError
from coopera.core.hour import ModelCall
from coopera.models.settings import Budget

GOOD = """
as_of: 2026-05-01
currency: EUR
models:
  "openai:small-*": {in: 0.5, out: 2}
  "openai:*": {in: 1, out: 10}
"""


def prices(tmp_path: Path, text: str = GOOD) -> Prices:
    path = tmp_path / "prices.yaml"
    path.write_text(text)
    return read_prices(path)


def call(model: str, **more: Any) -> ModelCall:
    given = {"tokens_in": 1_000_000, "tokens_out": 100_000, **more}
    return ModelCall(node="n", prompt="judge/tasks", prompt_sha="0", model=model, messages=[], reply="", **given)


def test_the_first_pattern_that_fits_a_model_counts(tmp_path: Path) -> None:
    """A million tokens in and a tenth of one out: 0.5 + 0.2, and 1 + 1."""
    known = prices(tmp_path)
    assert known.money("openai:small-2", 1e6, 1e5) == pytest.approx(0.7)
    assert known.money("openai:large+images", 1e6, 1e5) == pytest.approx(2.0)


def test_a_bill_says_what_has_no_price_and_leaves_out_what_was_not_paid(tmp_path: Path) -> None:
    calls = [call("openai:a"), call("openai:a", cached=True), call("offline"), call("mistral:b")]
    bill = prices(tmp_path).bill(calls)
    assert bill == {"spent": 2.0, "currency": "EUR", "as_of": "2026-05-01", "unpriced": ["mistral:b"]}
    assert in_words(bill) == "Cost: 2.00 EUR, by the prices of 2026-05-01; without a price: mistral:b."


@pytest.mark.parametrize(
    "spec",
    [
        "offline:words",
        "smol",
        "huggingface:a/b+images",
        "recorded:runs/a",
        "object:HuggingFaceChat:a",
        "object:OfflineChatModel",
    ],
)
def test_what_runs_in_this_process_costs_nothing(spec: str, tmp_path: Path) -> None:
    bill = prices(tmp_path).bill([call(spec)])
    assert (bill["spent"], bill["unpriced"]) == (0.0, [])


@pytest.mark.parametrize("spec", ["mistral:b", "smollm:1", "object:ChatOpenAI:gpt-4o"])
def test_a_limit_of_money_that_a_model_would_never_reach_is_refused(spec: str, tmp_path: Path) -> None:
    known, limit = prices(tmp_path), Budget(money=1.0)
    check_money(limit, known, ["openai:a", "smol", "offline"])
    check_money(Budget(calls=1), None, [spec])
    with pytest.raises(ConfigError, match=f"^budget.money: the model {spec} has no price in "):
        check_money(limit, known, ["openai:a", spec])
    with pytest.raises(ConfigError, match="--prices FILE that it began with, and has none"):
        check_money(limit, None, ["openai:a"])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("in: 1,", "in: a,", "models.openai:*.in must be a price of a million tokens, from 0 up, not 'a'."),
        ("in: 1,", "in: -1,", "models.openai:*.in must be a price of a million tokens, from 0 up, not -1."),
        ("in: 1, ", "", "models.openai:*.in must be a price of a million tokens, from 0 up, not missing."),
        ("as_of: 2026-05-01", "as_of: May", "as_of must be a day such as 2026-05-01, not 'May'."),
        ("currency: EUR", "", "currency must be a word such as EUR, not missing."),
        ("in: 1,", "foo: 1, in: 1,", "there is no field 'models.openai:*.foo' (known are in and out)."),
        ("currency:", "money: 3\ncurrency:", "there is no field 'money' (known are as_of, currency and models)."),
    ],
)
def test_a_wrong_file_of_prices_is_refused_in_a_sentence(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in GOOD
    with pytest.raises(ConfigError) as err:
        prices(tmp_path, GOOD.replace(old, new))
    assert str(err.value) == f"{tmp_path / 'prices.yaml'}: {said}"
