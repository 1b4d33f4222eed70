"""What a run may spend on models: counted as it is spent, and refused beyond the limit."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeAlias

from coopera.core.errors import BudgetError
from coopera.models.settings import Budget, Spent

Charge: TypeAlias = Callable[[str, int, int], float]
"""What a reply of a model costs, by the tokens of messages and reply."""


def for_nothing(model: str, tokens_in: int, tokens_out: int) -> float:
    """Where no price is known, no money is counted."""
    return 0.0


class Meter:
    """Counts what models were asked for; replies from the cache and from a recorded run cost nothing. Thread-safe."""

    def __init__(
        self, budget: Budget, spent: Spent | None = None, charge: Charge = for_nothing, currency: str = "money"
    ) -> None:
        """Go on from what was spent before; `currency` is that of what `charge` says."""
        self._budget, self._charge, self._currency = budget, charge, currency
        self._spent = spent or Spent()
        self._lock = threading.Lock()

    @property
    def spent(self) -> Spent:
        """All that was spent so far."""
        with self._lock:
            return self._spent

    def begin(self) -> None:
        """Count a call that is about to be made, so that calls made at once do not share the last one allowed.

        Raises:
            BudgetError: If the budget is spent; the call must not be made.
        """
        with self._lock:
            for name, used in self._spent:
                limit = getattr(self._budget, name)
                if limit is not None and used >= limit:
                    raise BudgetError(f"the budget of {limit} {self._unit(name)} is spent ({self._so_far()})")
            self._spent = self._spent.model_copy(update={"calls": self._spent.calls + 1})

    def end(self, model: str, tokens_in: int, tokens_out: int) -> None:
        """Count what a call took."""
        with self._lock:
            tokens = self._spent.tokens + tokens_in + tokens_out
            money = self._spent.money + self._charge(model, tokens_in, tokens_out)
            self._spent = self._spent.model_copy(update={"tokens": tokens, "money": money})

    def _unit(self, name: str) -> str:
        return self._currency if name == "money" else name

    def _so_far(self) -> str:
        counted = f"{self._spent.calls} calls, {self._spent.tokens} tokens"
        return f"{self._spent.money:.4f} {self._currency}, {counted}" if self._spent.money else counted
