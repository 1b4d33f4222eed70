"""Recipes of what cleaning and carrying take, and of what runs, foams and lies about while something is done."""

from __future__ import annotations

from coopera.simulation.shapes.kit import BLACK, BLUE, CREAM, DARK, GREEN, RED, STEEL, WHITE, YELLOW, Kit, Recipe, shade


def cleaning_cloth(kit: Kit) -> None:
    """Draw a cloth lying in soft folds, with a bright hem."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.4))
    for x, y, part in ((-0.3, 0.1, 0.9), (-0.05, -0.08, 1.0), (0.22, 0.05, 0.85)):
        kit.rod((x * w, y * d, h * 0.5), h * 0.5 * part, d * 0.8, shade(kit.colour, 0.8 + 0.2 * part), "y")
    for side in (-1, 1):
        kit.box((side * w * 0.46, 0, h * 0.4), (w * 0.06, d, 0.002), WHITE)


def bucket(kit: Kit) -> None:
    """Draw a bucket that widens upwards, with water and a handle."""
    r, h = kit.w / 2, kit.h
    for i, part in enumerate((0.76, 0.84, 0.92)):
        kit.tube((0, 0, h * 0.25 * i), r * part, h * 0.25)
    kit.tube((0, 0, h * 0.75), r, h * 0.05, shade(kit.colour, 0.7))
    kit.tube((0, 0, h * 0.8), r * 0.86, 0.003, (0.6, 0.82, 0.92))
    for side in (-1, 1):
        kit.rod((side * r * 0.92, 0, h * 0.86), 0.006, h * 0.24, STEEL)
    kit.rod((0, 0, h * 0.98), 0.008, kit.w * 0.95, STEEL, "x")


def mop(kit: Kit) -> None:
    """Draw a mop lying: strings at the left, a clamp and a long pole."""
    w, d, h = kit.w, kit.d, kit.h
    kit.tube((w * 0.1, 0, h * 0.5), 0.013, w * 0.8, BLUE, "x")
    kit.box((-w * 0.33, 0, h * 0.2), (w * 0.06, d * 0.5, h * 0.6), BLUE)
    for i in range(7):
        kit.rod((-w * (0.425 - 0.012 * (i % 2)), d * (-0.42 + 0.14 * i), h * 0.4), h * 0.4, w * 0.15, CREAM, "x")


def vacuum_cleaner(kit: Kit) -> None:
    """Draw an upright vacuum cleaner lying: a wide nozzle at the left, the body and a long handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.45, 0, 0), (w * 0.1, d, h * 0.7), DARK)
    kit.box((-w * 0.4, 0, h * 0.2), (w * 0.06, d * 0.4, h * 0.6), STEEL)
    kit.rod((-w * 0.14, 0, h * 0.6), min(h * 0.4, d * 0.3), w * 0.46, axis="x")
    kit.tube((-w * 0.02, 0, h * 0.6), min(h * 0.42, d * 0.31), w * 0.04, BLACK, "x")
    kit.tube((w * 0.24, 0, h * 0.6), 0.014, w * 0.5, STEEL, "x")
    kit.rod((w * 0.45, 0, h * 0.6), 0.022, w * 0.1, BLACK, "x")


def dustpan(kit: Kit) -> None:
    """Draw a dustpan: a flat pan with sides, open to the left, and a handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.18, 0, 0), (w * 0.64, d, h * 0.15))
    for side in (-1, 1):
        kit.box((-w * 0.18, side * d * 0.48, 0), (w * 0.64, d * 0.04, h * 0.8))
    kit.box((w * 0.12, 0, 0), (w * 0.04, d, h), shade(kit.colour, 0.8))
    kit.rod((w * 0.32, 0, h * 0.7), h * 0.2, w * 0.4, axis="x")


def cardboard_box(kit: Kit) -> None:
    """Draw a cardboard box: open flaps, a strip of tape and a label."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.94))
    kit.box((0, 0, h * 0.94), (w, d * 0.14, h * 0.02), (0.85, 0.75, 0.55))
    kit.box((0, d / 2, 0), (w * 0.12, 0.003, h * 0.94), (0.85, 0.75, 0.55))
    kit.box((w * 0.25, d / 2, h * 0.3), (w * 0.28, 0.004, h * 0.24), WHITE)
    for side in (-1, 1):
        kit.box((0, side * d * 0.26, h * 0.96), (w * 0.98, d * 0.44, h * 0.04), shade(kit.colour, 1.15))


def crate(kit: Kit) -> None:
    """Draw a crate of slats with vegetables in it."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.96, d * 0.96, h * 0.1))
    for z in (0.12, 0.5):
        for side in (-1, 1):
            kit.box((0, side * d * 0.48, h * z), (w, d * 0.04, h * 0.26))
            kit.box((side * w * 0.48, 0, h * z), (w * 0.04, d, h * 0.26))
    for x, y, colour in (
        (-0.25, -0.1, RED),
        (0.05, 0.15, GREEN),
        (0.28, -0.15, (0.95, 0.55, 0.15)),
        (-0.1, -0.25, GREEN),
    ):
        kit.ball((x * w, y * d, h * 0.6), min(w, d) * 0.2, colour)


def drying_rack(kit: Kit) -> None:
    """Draw a rack for washing: two frames, bars and a cloth on it."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        for y in (-0.4, 0.4):
            kit.tube((side * w * 0.47, y * d, 0), 0.012, h, STEEL)
        kit.rod((side * w * 0.47, 0, h - 0.012), 0.012, d, STEEL, "y")
    for y in (-0.4, -0.13, 0.13, 0.4):
        kit.rod((0, y * d, h - 0.02), 0.008, w, STEEL, "x")
    kit.box((-w * 0.15, d * 0.14, h * 0.45), (w * 0.4, 0.012, h * 0.53))


def lights(kit: Kit) -> None:
    """Draw a string of small lights."""
    w, d, h = kit.w, kit.d, kit.h
    for y in (-0.3, 0.3):
        kit.rod((0, y * d, h * 0.3), h * 0.12, w, GREEN, "x")
    for i in range(10):
        colour = (YELLOW, RED, BLUE, WHITE, GREEN)[i % 5]
        kit.ball((w * (-0.45 + 0.1 * i), d * (0.3 if i % 2 else -0.3), h * 0.55), h * 0.4, colour)


def flowers(kit: Kit) -> None:
    """Draw a bunch of flowers lying in its paper."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((w * 0.28, 0, h * 0.4), h * 0.2, w * 0.44, GREEN, "x")
    kit.box((w * 0.05, 0, 0), (w * 0.4, d * 0.7, h * 0.8), CREAM)
    for x, y, colour in (
        (-0.3, -0.3, RED),
        (-0.38, 0.0, YELLOW),
        (-0.3, 0.3, WHITE),
        (-0.2, -0.1, YELLOW),
        (-0.2, 0.16, RED),
    ):
        kit.ball((x * w, y * d, h * 0.6), min(d * 0.2, h * 0.4), colour)


def bath_bubbles(kit: Kit) -> None:
    """Draw foam on water."""
    w, d, h = kit.w, kit.d, kit.h
    spots = (
        (-0.4, -0.3),
        (-0.35, 0.25),
        (-0.15, -0.38),
        (-0.1, 0.38),
        (0.12, -0.3),
        (0.1, 0.3),
        (0.35, -0.2),
        (0.34, 0.3),
    )
    for i, (x, y) in enumerate(spots):
        kit.ball((x * w, y * d, 0.0), h * (0.7 + 0.12 * (i % 3)))
        kit.ball((x * w + h * 0.8, y * d + h * 0.4, 0.0), h * 0.55, WHITE)


def stream_of_water(kit: Kit) -> None:
    """Draw what runs out of a bottle."""
    kit.tube((0, 0, 0), kit.w * 0.5, kit.h * 0.6)
    kit.tube((0, 0, kit.h * 0.5), kit.w * 0.35, kit.h * 0.5)


def shower_of_water(kit: Kit) -> None:
    """Draw water that falls in thin streams."""
    w, d, h = kit.w, kit.d, kit.h
    spots = (
        (-0.45, 0),
        (-0.3, 0.4),
        (-0.3, -0.4),
        (0, 0.48),
        (0, -0.48),
        (0.3, 0.4),
        (0.3, -0.4),
        (0.45, 0),
        (0.15, 0.1),
    )
    for i, (x, y) in enumerate(spots):
        kit.tube((x * w, y * d, h * 0.06 * (i % 3)), 0.004, h * (0.88 - 0.06 * (i % 2)))


CHORE_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        *(cleaning_cloth, bucket, mop, vacuum_cleaner, dustpan, cardboard_box, crate, drying_rack, lights, flowers),
        *(bath_bubbles, stream_of_water, shower_of_water),
    )
}
