"""What a run may spend on models: counted as it is spent, and refused beyond the limit."""

from __future__ import annotations

import threading

from core.errors import BudgetError
from models.settings import Budget, Spent


class Meter:
    """Counts what models were asked for; replies from the cache and from a replayed run cost nothing. Thread-safe."""

    def __init__(self, budget: Budget, spent: Spent | None = None) -> None:
        """Go on from what was spent before."""
        self._budget = budget
        before = spent or Spent()
        self._calls, self._tokens = before.calls, before.tokens
        self._lock = threading.Lock()

    @property
    def spent(self) -> Spent:
        """All that was spent so far."""
        with self._lock:
            return Spent(calls=self._calls, tokens=self._tokens)

    def check(self) -> None:
        """Go on, or not.

        Raises:
            BudgetError: If the budget is spent.
        """
        spent = self.spent
        for name in ("calls", "tokens"):
            limit, used = getattr(self._budget, name), getattr(spent, name)
            if limit is not None and used >= limit:
                raise BudgetError(f"the budget of {limit} {name} is spent ({spent.calls} calls, {spent.tokens} tokens)")

    def add(self, tokens: int) -> None:
        """Count a call."""
        with self._lock:
            self._calls += 1
            self._tokens += tokens
