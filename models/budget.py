"""What a run may spend on models: counted as it is spent, and refused beyond the limit."""

from __future__ import annotations

import threading

from coopera.core.errors import BudgetError
from coopera.models.settings import Budget, Spent


class Meter:
    """Counts what models were asked for; replies from the cache and from a recorded run cost nothing. Thread-safe."""

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

    def begin(self) -> None:
        """Count a call that is about to be made, so that calls made at once do not share the last one allowed.

        Raises:
            BudgetError: If the budget is spent; the call must not be made.
        """
        with self._lock:
            spent = {"calls": self._calls, "tokens": self._tokens}
            for name, used in spent.items():
                limit = getattr(self._budget, name)
                if limit is not None and used >= limit:
                    raise BudgetError(
                        f"the budget of {limit} {name} is spent ({self._calls} calls, {self._tokens} tokens)"
                    )
            self._calls += 1

    def end(self, tokens: int) -> None:
        """Count what a call took."""
        with self._lock:
            self._tokens += tokens
