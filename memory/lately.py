"""The records of a stream that are in RAM, in pieces of consecutive ones: those added or read last."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from coopera.memory.questions import Texts
from coopera.memory.rows import Record

PIECE = 512
"""Consecutive records that come and go together."""


@dataclass(slots=True)
class _Piece:
    """A piece as columns by place: texts recur and are shared, so that a record takes 16 bytes, not some 300."""

    texts: list[str | None] = field(default_factory=lambda: [None] * PIECE)
    hours: list[int] = field(default_factory=lambda: [0] * PIECE)
    own: dict[int, Mapping[str, Any]] = field(default_factory=dict)
    free: int = PIECE
    """How many of its records are not here."""


class Lately:
    """Records by position, at most so many; where that is full, the piece goes that nobody asked for the longest."""

    def __init__(self, most: int) -> None:
        """Start empty, with room for all pieces that `most` consecutive records may lie in."""
        self._pieces: OrderedDict[int, _Piece] = OrderedDict()
        self._most = most // PIECE + 1

    def of(self, positions: Sequence[int]) -> dict[int, Record]:
        """Return those records that are here."""
        found: dict[int, Record] = {}
        at, piece = -1, None
        for position in positions:
            number, place = divmod(position, PIECE)
            if number != at:
                at, piece = number, self._asked(number)
            if piece is not None and (text := piece.texts[place]) is not None:
                found[position] = Record(text, piece.hours[place], piece.own.get(place, {}))
        return found

    def texts(self, start: int, stop: int) -> Texts | None:
        """Return the texts and hours of consecutive records; None if one is not here."""
        texts: list[str | None] = []
        hours: list[int] = []
        while start < stop:
            number, place = divmod(start, PIECE)
            if (piece := self._asked(number)) is None:
                return None
            end = min(stop, (number + 1) * PIECE)
            part = slice(place, place + end - start)
            if piece.free and None in piece.texts[part]:
                return None
            texts += piece.texts[part]
            hours += piece.hours[part]
            start = end
        return Texts(cast(list[str], texts), hours)

    def keep(self, records: Iterable[tuple[int, Record]]) -> None:
        """Keep records, by position."""
        for position, (text, hour, own) in records:
            number, place = divmod(position, PIECE)
            piece = self._pieces.get(number)
            if piece is None:
                piece = self._pieces[number] = _Piece()
                if len(self._pieces) > self._most:
                    self._pieces.popitem(last=False)
            piece.free -= piece.texts[place] is None
            piece.texts[place], piece.hours[place] = text, hour
            if own:
                piece.own[place] = own

    def _asked(self, number: int) -> _Piece | None:
        piece = self._pieces.get(number)
        if piece is not None:
            self._pieces.move_to_end(number)
        return piece

    def clear(self) -> None:
        """Keep none."""
        self._pieces.clear()
