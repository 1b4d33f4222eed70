"""Recipes of food, what it is packed in, and small tools of kitchen and table."""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    CREAM,
    DARK,
    DARK_WOOD,
    GREEN,
    PAPER,
    RED,
    STEEL,
    WHITE,
    WOOD,
    YELLOW,
    Kit,
    Recipe,
    shade,
)


def fork(kit: Kit) -> None:
    """Draw a fork lying flat: three prongs, a neck and a handle towards the right."""
    w, d, h = kit.w, kit.d, kit.h
    for y in (-0.36, 0.0, 0.36):
        kit.box((-w * 0.38, y * d, 0), (w * 0.24, d * 0.16, h * 0.6))
    kit.box((-w * 0.22, 0, 0), (w * 0.1, d, h * 0.6))
    kit.box((w * 0.16, 0, 0), (w * 0.68, d * 0.4, h))


def table_knife(kit: Kit) -> None:
    """Draw a knife for the table: a broad blade and a thicker handle towards the right."""
    kit.box((-kit.w * 0.24, 0, 0), (kit.w * 0.52, kit.d, kit.h * 0.4))
    kit.box((kit.w * 0.26, 0, 0), (kit.w * 0.48, kit.d * 0.75, kit.h), shade(kit.colour, 0.75))


def ladle(kit: Kit) -> None:
    """Draw a ladle: a deep bowl and a long handle towards the right."""
    r = kit.d / 2
    kit.tube((-kit.w / 2 + r, 0, 0), r, kit.h)
    kit.tube((-kit.w / 2 + r, 0, kit.h), r * 0.85, 0.001, DARK)
    kit.rod((r, 0, kit.h * 0.8), 0.008, kit.w - 2 * r, axis="x")


def whisk(kit: Kit) -> None:
    """Draw a whisk: a cage of wires and a handle towards the right."""
    w, r = kit.w, kit.h / 2
    for y, z in ((-0.8, 0), (0.8, 0), (0, -0.8), (0, 0.8), (0, 0)):
        kit.rod((-w * 0.24, y * r, r + z * r), 0.003, w * 0.52, axis="x")
    kit.tube((-w * 0.3, 0, r), r, 0.006, axis="x")
    kit.rod((w * 0.25, 0, r), r * 0.45, w * 0.5, DARK, "x")


def rolling_pin(kit: Kit) -> None:
    """Draw a rolling pin with a grip at each end."""
    r = kit.h / 2
    kit.tube((0, 0, r), r, kit.w * 0.64, axis="x")
    for side in (-1, 1):
        kit.rod((side * kit.w * 0.4, 0, r), r * 0.5, kit.w * 0.2, DARK_WOOD, "x")


def jar(kit: Kit) -> None:
    """Draw a jar: contents behind glass, a label and a lid."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r, h * 0.78)
    kit.tube((0, 0, h * 0.22), r * 1.02, h * 0.34, PAPER)
    kit.tube((0, 0, h * 0.78), r * 0.85, h * 0.06, shade(kit.colour, 1.5))
    kit.tube((0, 0, h * 0.84), r * 0.92, h * 0.16, STEEL)


def carton(kit: Kit) -> None:
    """Draw a drink's carton: a coloured band, a gable and a cap."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.78), WHITE)
    kit.box((0, 0, h * 0.2), (w * 1.02, d * 1.02, h * 0.3))
    for side in (-1, 1):
        kit.box((0, side * d * 0.2, h * 0.76), (w, 0.006, h * 0.2), WHITE, tilt=side * 0.6)
    kit.box((0, 0, h * 0.9), (w, d * 0.12, h * 0.1), WHITE)
    kit.tube((w * 0.1, d * 0.26, h * 0.82), w * 0.16, h * 0.07)


def sack(kit: Kit) -> None:
    """Draw a filled bag: bulging, gathered at the top, with a label."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.9, d, h * 0.75))
    kit.box((0, 0, h * 0.1), (w, d * 0.9, h * 0.5))
    kit.box((0, 0, h * 0.75), (w * 0.7, d * 0.6, h * 0.12), shade(kit.colour, 0.8))
    kit.box((0, 0, h * 0.87), (w * 0.9, d * 0.25, h * 0.13))
    kit.box((0, d / 2, h * 0.2), (w * 0.6, 0.004, h * 0.35), PAPER)


def pouch(kit: Kit) -> None:
    """Draw a bag of something to nibble: a crimped edge above and below, and a bright picture."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h * 0.08), (w * 0.94, d, h * 0.84))
    for z in (0.0, 0.92):
        kit.box((0, 0, h * z), (w, d * 0.2, h * 0.08), shade(kit.colour, 0.7))
    kit.ball((0, d * 0.36, h * 0.5), min(w * 0.26, d * 0.5), YELLOW)
    kit.box((0, d * 0.5, h * 0.74), (w * 0.7, 0.006, h * 0.1), WHITE)


def mill(kit: Kit) -> None:
    """Draw a mill or shaker: a waisted body and a round head."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r, h * 0.3)
    kit.tube((0, 0, h * 0.3), r * 0.7, h * 0.3)
    kit.tube((0, 0, h * 0.6), r * 0.95, h * 0.18)
    kit.tube((0, 0, h * 0.78), r * 0.75, h * 0.1, STEEL)
    kit.ball((0, 0, h * 0.92), h * 0.08, STEEL)


def loaf(kit: Kit) -> None:
    """Draw a loaf of bread with cuts across its crust."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.92, d, h * 0.6))
    kit.rod((0, 0, h * 0.56), min(h * 0.44, d / 2), w, axis="x")
    for x in (-0.28, 0.0, 0.28):
        kit.box((x * w, 0, h * 0.95), (w * 0.05, d * 0.6, h * 0.06), CREAM)


def bread_slice(kit: Kit) -> None:
    """Draw a slice of bread lying: a crust around the crumb, rounded behind."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, d * 0.06, 0), (w * 0.9, d * 0.84, h * 0.98))
    for side in (-1, 1):
        kit.tube((side * w * 0.28, -d * 0.3, 0), w * 0.22, h * 0.98)
    kit.box((0, d * 0.06, h * 0.5), (w * 0.76, d * 0.7, h * 0.52), shade(kit.colour, 1.5))


def cake_slice(kit: Kit) -> None:
    """Draw a piece of cake: two layers, icing and a cherry."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.34))
    kit.box((0, 0, h * 0.34), (w, d, h * 0.08), CREAM)
    kit.box((0, 0, h * 0.42), (w, d, h * 0.28))
    kit.box((0, 0, h * 0.7), (w * 1.02, d * 1.02, h * 0.12), WHITE)
    kit.ball((0, 0, h * 0.9), h * 0.1, RED)


def cookie(kit: Kit) -> None:
    """Draw a biscuit with dark chips."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h * 0.8)
    for x, y in ((-0.2, 0.1), (0.22, 0.18), (0.05, -0.25), (-0.15, -0.2), (0.28, -0.1)):
        kit.ball((x * kit.w, y * kit.w, kit.h * 0.8), kit.w * 0.07, (0.25, 0.13, 0.06))


def egg(kit: Kit) -> None:
    """Draw an egg lying in a low cup."""
    r = kit.w / 2
    kit.tube((0, 0, 0), r * 0.7, kit.h * 0.3, WHITE)
    kit.ball((0, 0, kit.h * 0.3 + r * 0.7), r * 0.9)
    kit.ball((0, 0, kit.h - r * 0.6), r * 0.6)


def carrot(kit: Kit) -> None:
    """Draw a long vegetable that tapers to the left, with leaves at the right."""
    w, r = kit.w, kit.h / 2
    for x, part, long in ((-0.3, 0.5, 0.4), (-0.1, 0.75, 0.4), (0.12, 1.0, 0.36)):
        kit.rod((x * w, 0, r), r * part, w * long, axis="x")
    for y in (-0.3, 0.0, 0.3):
        kit.box((w * 0.4, y * kit.d, r), (w * 0.2, kit.d * 0.14, 0.006), GREEN)


def cucumber(kit: Kit) -> None:
    """Draw a long even vegetable."""
    kit.rod((0, 0, kit.h / 2), kit.h / 2, kit.w, axis="x")
    for y in (-0.25, 0.25):
        kit.rod((0, y * kit.d, kit.h * 0.9), kit.h * 0.06, kit.w * 0.8, shade(kit.colour, 1.4), "x")
    kit.ball((kit.w * 0.49, 0, kit.h / 2), kit.h * 0.12, YELLOW)


def wedge(kit: Kit) -> None:
    """Draw a piece of cheese with holes, its rind at the back."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, d * 0.06, 0), (w, d * 0.88, h))
    kit.box((0, -d * 0.44, 0), (w, d * 0.12, h), shade(kit.colour, 0.7))
    for x, z in ((-0.28, 0.6), (0.05, 0.35), (0.3, 0.7)):
        kit.ball((x * w, d * 0.48, z * h), h * 0.13, shade(kit.colour, 0.75))
    kit.tube((-w * 0.15, d * 0.1, h), h * 0.15, 0.001, shade(kit.colour, 0.75))


def pizza_slice(kit: Kit) -> None:
    """Draw a piece of pizza that narrows to the front, with slices of sausage."""
    w, d, h = kit.w, kit.d, kit.h
    for i in range(5):
        kit.box((0, d * (-0.3 + 0.18 * i), 0), (w * (0.92 - 0.2 * i), d * 0.19, h * 0.6))
    kit.rod((0, -d * 0.43, h * 0.5), h * 0.5, w, WOOD, "x")
    for x, y in ((-0.2, -0.2), (0.18, -0.12), (0.0, 0.12)):
        kit.tube((x * w, y * d, h * 0.6), w * 0.11, h * 0.1, RED)


def grapes(kit: Kit) -> None:
    """Draw a heap of round small things: grapes, nuts or sweets."""
    r = min(kit.w, kit.d) * 0.19
    for x, y, z in (
        *((-0.3, -0.25, 0), (0.0, -0.3, 0), (0.3, -0.2, 0), (-0.25, 0.15, 0), (0.1, 0.1, 0), (0.32, 0.2, 0)),
        *((-0.05, 0.32, 0), (-0.12, -0.1, 1), (0.16, -0.08, 1), (0.04, 0.18, 1)),
    ):
        tone = shade(kit.colour, 0.8 + 0.12 * (abs(x) * 10 % 4))
        kit.ball((x * kit.w, y * kit.d, r + z * (kit.h - 2 * r)), r, tone)


def bar(kit: Kit) -> None:
    """Draw a bar of chocolate half out of its wrapper."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((w * 0.15, 0, 0), (w * 0.7, d, h))
    kit.box((w * 0.15, 0, h), (w * 0.4, d * 0.6, 0.001), CREAM)
    for i in range(2):
        for side in (-1, 1):
            kit.box((w * (-0.28 - 0.12 * i), side * d * 0.23, 0), (w * 0.11, d * 0.42, h * 0.9), (0.28, 0.15, 0.07))


def scales(kit: Kit) -> None:
    """Draw kitchen scales: a flat foot, a lit number and a round plate."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.5))
    kit.box((0, d * 0.36, h * 0.5), (w * 0.4, d * 0.16, h * 0.1), (0.55, 0.8, 0.6))
    kit.tube((0, -d * 0.08, h * 0.5), w * 0.12, h * 0.2, DARK)
    kit.tube((0, -d * 0.08, h * 0.7), min(w, d) * 0.4, h * 0.3, STEEL)


def mixer(kit: Kit) -> None:
    """Draw a hand mixer: body, grip and two beaters."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h * 0.5), (w, d, h * 0.25))
    kit.box((0, 0, h * 0.88), (w * 0.8, d * 0.5, h * 0.12))
    kit.box((w * 0.34, 0, h * 0.7), (w * 0.12, d * 0.5, h * 0.2))
    for y in (-0.25, 0.25):
        kit.tube((-w * 0.3, y * d, h * 0.2), 0.004, h * 0.3, STEEL)
        kit.ball((-w * 0.3, y * d, h * 0.14), h * 0.13, STEEL)


def popcorn(kit: Kit) -> None:
    """Draw a striped tub that is full of light puffs."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.86, d * 0.86, h * 0.7), WHITE)
    for x in (-0.28, 0.0, 0.28):
        kit.box((x * w, 0, 0), (w * 0.12, d * 0.88, h * 0.7))
    for x, y in ((-0.25, -0.2), (0.22, -0.25), (0.0, 0.05), (-0.24, 0.25), (0.25, 0.22)):
        kit.ball((x * w, y * d, h * 0.78), w * 0.2, CREAM)


def egg_carton(kit: Kit) -> None:
    """Draw a carton with eggs in two rows."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.6))
    for x in (-0.33, 0.0, 0.33):
        for y in (-0.25, 0.25):
            kit.ball((x * w, y * d, h * 0.68), min(w * 0.14, h * 0.32), CREAM)
    kit.box((0, -d / 2, h * 0.5), (w, 0.008, h * 0.5), BLACK if kit.colour == DARK else shade(kit.colour, 0.8))


PANTRY_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        *(fork, table_knife, ladle, whisk, rolling_pin, jar, carton, sack, pouch, mill, loaf, bread_slice, cake_slice),
        *(cookie, egg, carrot, cucumber, wedge, pizza_slice, grapes, bar, scales, mixer, popcorn, egg_carton),
    )
}
