"""Triangles in the graphics card's memory, and the order in which stretches of them are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from coopera.simulation.drawing.scenery import Batch, Piece
from coopera.simulation.drawing.unheld import render

_LAYOUT = ("3f 4i1 4f1 2f 1i", "at", "normal", "paint", "uv", "tag")
"""`scenery.VERTEX`."""


class Stored:
    """A batch in the graphics card's memory; `release` it after use."""

    def __init__(self, context: Any, shadow: Any, batch: Batch) -> None:
        """Bring a batch there; `shadow` is the program that casts shadows."""
        self._context = context
        self.vertices = context.buffer(batch.vertices.tobytes())
        self.faces = context.buffer(batch.faces.tobytes())
        self._held = batch.vertices
        self._seen: dict[int, Any] = {}
        self.cast = context.vertex_array(shadow, [(self.vertices, "3f 20x", "at")], self.faces)
        self.set(batch.pieces)

    def seen(self, program: Any) -> Any:
        """The vertex array that a program draws as the camera sees it."""
        if program.glo not in self._seen:
            self._seen[program.glo] = self._context.vertex_array(program, [(self.vertices, *_LAYOUT)], self.faces)
        return self._seen[program.glo]

    def holds(self, batch: Batch) -> bool:
        """Whether this is the memory of a batch as it was before."""
        return batch.vertices is self._held

    def rewrite(self, batch: Batch) -> None:
        """Take over what has changed of the batch."""
        for vertices, faces in batch.changed:
            _write(self.vertices, batch.vertices, vertices)
            _write(self.faces, batch.faces, faces)
        self.set(batch.pieces)

    def set(self, pieces: list[Piece]) -> None:
        """Know which stretches there are."""
        self.pieces = pieces
        self.first = np.array([piece.first for piece in pieces], dtype=np.uint32)
        self.count = np.array([piece.length for piece in pieces], dtype=np.uint32)
        self.low = np.array([piece.low for piece in pieces], dtype=np.float64).reshape(-1, 3)
        self.high = np.array([piece.high for piece in pieces], dtype=np.float64).reshape(-1, 3)
        self.room = np.array([piece.room for piece in pieces], dtype=np.int64)
        self.above = np.array([piece.above for piece in pieces], dtype=bool)
        self.casts = np.array([piece.casts for piece in pieces], dtype=bool)
        self.closed = np.array([piece.closed for piece in pieces], dtype=bool)
        self.lies = np.array([piece.lies for piece in pieces], dtype=bool)

    def draw(self, array: Any, chosen: NDArray[np.int64]) -> None:
        """Draw some stretches, in this order, but the closed ones first: half of their triangles cost little then."""
        context, closed = self._context, self.closed[chosen]
        for some, flags in (
            (chosen[closed], context.DEPTH_TEST | context.CULL_FACE),
            (chosen[~closed], context.DEPTH_TEST),
        ):
            if len(some):
                context.enable_only(flags)
                rows = np.zeros((len(some), 5), dtype=np.uint32)
                rows[:, 0], rows[:, 1], rows[:, 2] = self.count[some], 1, self.first[some]
                orders = context.buffer(rows.tobytes())
                render(array, orders)
                orders.release()

    def release(self) -> None:
        """Give the memory back."""
        for one in (*self._seen.values(), self.cast, self.vertices, self.faces):
            one.release()


def _write(buffer: Any, values: NDArray[Any], part: slice) -> None:
    """Bring some rows to the graphics card."""
    if part.start < part.stop:
        buffer.write(values[part].tobytes(), offset=part.start * values.strides[0])
