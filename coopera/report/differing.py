"""Where the measures of success differ, as tables for the terminal, plain data, and the report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coopera.evaluation.robot.differences import Offer, Pattern, offers_of, pairs_of, patterns_of
from coopera.report.progress import figure

PATTERNS, EXAMPLES = 8, 3
"""How many ways of differing are shown, and how many offers of each."""
MARK = {True: "yes", False: "no", None: "–"}

__all__ = ["as_data", "as_page", "offers_of", "pair_rows", "pattern_rows"]


def pair_rows(offers: Sequence[Offer]) -> tuple[list[str], list[list[str]]]:
    """The two by two of each two measures: offers that both, one, the other, or neither takes for helpful."""
    columns = ["measures", "both yes", "first only", "second only", "both no", "agree", "kappa"]
    rows = []
    for pair in pairs_of(offers):
        counts = [str(n) for n in (pair.both, pair.only_one, pair.only_other, pair.neither)]
        agreeing = "–" if pair.agreeing is None else f"{100 * pair.agreeing:.0f} %"
        rows.append([f"{pair.one}, {pair.other}", *counts, agreeing, figure(pair.kappa)])
    return columns, rows


def pattern_rows(offers: Sequence[Offer]) -> tuple[list[str], list[list[str]]]:
    """Who says yes and who says no, and of how many offers."""
    patterns = patterns_of(offers)[:PATTERNS]
    names = list(dict.fromkeys(name for pattern in patterns for name in pattern.said))
    rows = [[*_marks(pattern, names), str(len(pattern.offers)), pattern.offers[0].offer] for pattern in patterns]
    return [*names, "offers", "such as"], rows


def as_page(offers: Sequence[Offer]) -> dict[str, Any] | None:
    """What the report shows; None where there is nothing to compare."""
    columns, rows = pair_rows(offers)
    if not rows:
        return None
    names = pattern_rows(offers)[0][:-2]
    patterns = [
        {"said": _marks(pattern, names), "count": len(pattern.offers), "examples": _distinct(pattern.offers)}
        for pattern in patterns_of(offers)[:PATTERNS]
    ]
    return {"columns": columns, "rows": rows, "names": names, "patterns": patterns, "offers": len(offers)}


def as_data(offers: Sequence[Offer]) -> dict[str, Any]:
    """As plain data."""
    pairs = [{**p._asdict(), "agreeing": p.agreeing, "kappa": p.kappa} for p in pairs_of(offers)]
    patterns = [
        {"said": p.said, "offers": len(p.offers), "examples": [one._asdict() for one in _distinct(p.offers)]}
        for p in patterns_of(offers)
    ]
    return {"offers": len(offers), "pairs": pairs, "patterns": patterns}


def _marks(pattern: Pattern, names: Sequence[str]) -> list[str]:
    return [MARK[pattern.said.get(name)] for name in names]


def _distinct(offers: Sequence[Offer]) -> list[Offer]:
    """The first offers of each wording."""
    first: dict[str, Offer] = {}
    for offer in offers:
        first.setdefault(offer.offer, offer)
    return list(first.values())[:EXAMPLES]
