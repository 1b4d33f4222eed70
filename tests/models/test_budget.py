from __future__ import annotations

import pytest

from coopera.core.errors import BudgetError
from coopera.models.budget import Meter
from coopera.models.settings import Budget, Spent


def test_calls_made_at_once_do_not_share_the_last_one_allowed() -> None:
    meter = Meter(Budget(calls=3), Spent(calls=1, tokens=5))
    meter.begin()
    meter.begin()
    with pytest.raises(BudgetError, match=r"the budget of 3 calls is spent \(3 calls, 5 tokens\)"):
        meter.begin()
    assert meter.spent == Spent(calls=3, tokens=5)


def test_a_budget_of_tokens_ends_with_the_call_that_reaches_it() -> None:
    meter = Meter(Budget(tokens=10))
    meter.begin()
    meter.end("m", 4, 5)
    meter.begin()
    meter.end("m", 4, 5)
    with pytest.raises(BudgetError, match=r"the budget of 10 tokens is spent \(2 calls, 18 tokens\)"):
        meter.begin()


def test_a_budget_of_money_ends_with_the_call_that_reaches_it() -> None:
    meter = Meter(Budget(money=0.5), charge=lambda model, *_: 0.25 if model == "m" else 0.0, currency="EUR")
    for model in ("m", "free", "m"):
        meter.begin()
        meter.end(model, 1, 1)
    with pytest.raises(BudgetError, match=r"the budget of 0.5 EUR is spent \(0.5000 EUR, 3 calls, 6 tokens\)"):
        meter.begin()
    assert meter.spent == Spent(calls=3, tokens=6, money=0.5)
