"""The records of a stream that are in RAM, in pieces of consecutive ones: those added or read last."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, cast

from coopera.memory.questions import Texts
from coopera.memory.rows import Record

PIECE = 512
"""Consecutive records that come and go together."""


class _Piece(NamedTuple):
    """A piece as columns by place: texts recur and are shared, so that a record takes 16 bytes, not some 300."""

    texts: list[str | None]
    hours: list[int]
    own: dict[int, Mapping[str, Any]]


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
            texts += piece.texts[part]
            hours += piece.hours[part]
            start = end
        return None if None in texts else Texts(cast(list[str], texts), hours)

    def keep(self, records: Iterable[tuple[int, Record]]) -> None:
        """Keep records, by position."""
        for position, (text, hour, own) in records:
            number, place = divmod(position, PIECE)
            piece = self._pieces.get(number)
            if piece is None:
                piece = self._pieces[number] = _Piece([None] * PIECE, [0] * PIECE, {})
                if len(self._pieces) > self._most:
                    self._pieces.popitem(last=False)
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
