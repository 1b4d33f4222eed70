"""The free text of a reply as it grows: what should not be said next, and which tokens are likely at all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Set

import torch

from coopera.models.small.manner import Manner


class FreeText:
    """The free text of a growing reply, and what should not be said next.

    The penalty is that of Keskar et al. 2019 (CTRL): the logit of a token that was said is divided by it, or multiplied
    where it is negative. Tokens with a quotation mark end a text in JSON and are never held back.
    """

    def __init__(self, manner: Manner, ends: Set[int]) -> None:
        """Start with nothing said; `ends` are the tokens that hold a quotation mark."""
        self._manner, self._ends = manner, ends
        self._said: set[int] = set()
        self._text: list[int] = []
        self._followed: defaultdict[tuple[int, ...], set[int]] = defaultdict(set)

    def add(self, token: int, *, free: bool = True) -> None:
        """Note a token that was drawn; what the grammar chose, such as the rest of a character, is not remembered."""
        if token in self._ends:
            return self.end()
        if not free:
            return None
        self._said.add(token)
        self._text.append(token)
        n = self._manner.no_repeat
        if n and len(self._text) >= n:
            self._followed[tuple(self._text[-n:-1])].add(token)
        return None

    def end(self) -> None:
        """Note that the text has ended; the next one may not repeat what it said either."""
        self._text = []

    def held_back(self, scores: torch.Tensor) -> torch.Tensor:
        """Scores of shape (V,), lower for what was said, and -inf for what would repeat a sequence of tokens."""
        penalty, n = self._manner.repetition_penalty, self._manner.no_repeat
        scores = scores.clone()
        if penalty != 1.0 and self._said:
            said = torch.tensor(sorted(self._said), device=scores.device)
            known = scores[said]
            scores[said] = torch.where(known > 0, known / penalty, known * penalty)
        before = tuple(self._text[len(self._text) - n + 1 :]) if n and len(self._text) >= n - 1 else None
        banned = sorted(self._followed.get(before, ())) if before is not None else []
        if banned:
            scores[banned] = -torch.inf
        return scores


def nucleus(shares: torch.Tensor, top_p: float) -> torch.Tensor:
    """Shares of shape (V,), 0 for all but the likeliest tokens that together reach `top_p` (Holtzman et al. 2020)."""
    ordered, places = shares.sort(descending=True, stable=True)
    beyond = ordered.cumsum(0) - ordered >= top_p * ordered.sum()
    return shares.index_fill(0, places[beyond], 0.0)
