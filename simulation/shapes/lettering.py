"""A box with a letter on it: how a thing is drawn that nothing is known of but its name."""

from __future__ import annotations

from coopera.simulation.shapes.kit import DARK, MOST_PARTS, PAPER, Kit, shade

_ROWS = {
    "a": "010 101 111 101 101",
    "b": "110 101 110 101 110",
    "c": "111 100 100 100 111",
    "d": "110 101 101 101 110",
    "e": "111 100 111 100 111",
    "f": "111 100 111 100 100",
    "g": "111 100 101 101 111",
    "h": "101 101 111 101 101",
    "i": "111 010 010 010 111",
    "j": "001 001 001 101 111",
    "k": "101 101 110 101 101",
    "l": "100 100 100 100 111",
    "m": "10001 11011 10101 10001 10001",
    "n": "1001 1101 1011 1001 1001",
    "o": "111 101 101 101 111",
    "p": "111 101 111 100 100",
    "q": "111 101 101 111 001",
    "r": "111 101 110 101 101",
    "s": "111 100 111 001 111",
    "t": "111 010 010 010 010",
    "u": "101 101 101 101 111",
    "v": "101 101 101 101 010",
    "w": "10001 10001 10101 11011 10001",
    "x": "101 101 010 101 101",
    "y": "101 101 010 010 010",
    "z": "111 001 010 100 111",
}
"""Each letter as rows of points, from above."""
_UNKNOWN = "111 001 010 000 010"


def strokes(letter: str) -> list[tuple[float, float, float, float]]:
    """A letter as rectangles: middle (right, up from its own middle), width and height, as shares of its height."""
    rows = _ROWS.get(letter.lower(), _UNKNOWN).split()
    unit, wide = 1 / len(rows), len(rows[0])
    left = {(x, y) for y, row in enumerate(rows) for x, point in enumerate(row) if point == "1"}
    found = []
    while left:
        x, y = min(left, key=lambda at: (at[1], at[0]))
        down = _run(left, x, y, 0, 1)
        across = _run(left, x, y, 1, 0)
        dx, dy = (1, len(down)) if len(down) > len(across) else (len(across), 1)
        left -= set(down if dx == 1 else across)
        found.append(((x + dx / 2 - wide / 2) * unit, 0.5 - (y + dy / 2) * unit, dx * unit, dy * unit))
    return found


def _run(points: set[tuple[int, int]], x: int, y: int, dx: int, dy: int) -> list[tuple[int, int]]:
    """The unbroken line of points that begins at one of them."""
    found = []
    while (x, y) in points:
        found.append((x, y))
        x, y = x + dx, y + dy
    return found


def labelled_box(kit: Kit, name: str) -> None:
    """Draw a box with a lid and a paper label that bears the first letter of a name: before, and above if it fits."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.85))
    kit.box((0, 0, h * 0.85), (w * 0.96, d * 0.96, h * 0.15), shade(kit.colour, 0.7))
    marks, high = strokes(name[:1]), min(h * 0.55, w * 0.55)
    kit.box((0, d / 2, h * 0.42 - high * 0.65), (high * 1.2, 0.002, high * 1.3), PAPER)
    for x, up, wide, tall in marks:  # seen from the front, the box's left is its +x
        kit.box((-x * high, d / 2 + 0.002, h * 0.42 + (up - tall / 2) * high), (wide * high, 0.002, tall * high), DARK)
    if len(kit.parts) + 1 + len(marks) > MOST_PARTS:
        return
    high = min(w, d) * 0.55
    kit.box((0, 0, h), (high * 1.2, high * 1.3, 0.001), PAPER)
    for x, up, wide, tall in marks:
        kit.box((-x * high, -up * high, h + 0.001), (wide * high, tall * high, 0.001), DARK)
