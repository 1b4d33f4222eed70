"""Recipes of what people wear, care for themselves with and play with."""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    BLUE,
    CREAM,
    DARK,
    GLASS,
    GREEN,
    RED,
    STEEL,
    WHITE,
    WOOD,
    YELLOW,
    Kit,
    Recipe,
    shade,
)


def tube_of_paste(kit: Kit) -> None:
    """Draw a tube lying: flat at the left, round at the right, with a cap and a stripe."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.44, 0, h * 0.2), (w * 0.12, d, h * 0.3), shade(kit.colour, 0.85))
    kit.box((-w * 0.16, 0, h * 0.06), (w * 0.46, d * 0.9, h * 0.6))
    kit.rod((w * 0.12, 0, h * 0.42), min(h * 0.42, d / 2), w * 0.5, axis="x")
    kit.box((-w * 0.1, 0, h * 0.66), (w * 0.4, d * 0.4, 0.002), RED)
    kit.tube((w * 0.42, 0, h * 0.42), h * 0.3, w * 0.14, BLUE, "x")


def spray_bottle(kit: Kit) -> None:
    """Draw a bottle with a trigger and a nozzle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.8, d, h * 0.58))
    kit.box((0, 0, h * 0.16), (w * 0.82, d * 1.02, h * 0.26), WHITE)
    kit.tube((0, 0, h * 0.58), d * 0.2, h * 0.2)
    kit.box((-w * 0.12, 0, h * 0.82), (w * 0.76, d * 0.5, h * 0.16), RED)
    kit.box((-w * 0.28, 0, h * 0.62), (w * 0.1, d * 0.3, h * 0.22), RED)
    kit.box((-w * 0.52, 0, h * 0.85), (w * 0.1, d * 0.3, h * 0.08), WHITE)


def razor(kit: Kit) -> None:
    """Draw a razor: a head across at the left, and a handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.42, 0, 0), (w * 0.14, d, h * 0.7), STEEL)
    kit.box((-w * 0.47, 0, 0), (w * 0.04, d * 0.9, h * 0.5), BLUE)
    kit.rod((w * 0.08, 0, h * 0.5), h * 0.45, w * 0.82, axis="x")


def lipstick(kit: Kit) -> None:
    """Draw a lipstick standing open, or a stick of glue."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r, h * 0.45, BLACK)
    kit.tube((0, 0, h * 0.45), r * 0.85, h * 0.2, YELLOW)
    kit.rod((0, 0, h * 0.78), r * 0.65, h * 0.44)


def hair_dryer(kit: Kit) -> None:
    """Draw a hair dryer lying: barrel with a nozzle at the left, and a grip."""
    w, d, h = kit.w, kit.d, kit.h
    kit.tube((-w * 0.36, 0, h / 2), h * 0.34, w * 0.28, BLACK, "x")
    kit.tube((w * 0.1, 0, h / 2), h * 0.5, w * 0.64, axis="x")
    kit.tube((w * 0.44, 0, h / 2), h * 0.42, w * 0.1, DARK, "x")
    kit.rod((w * 0.12, d * 0.34, h / 2), h * 0.24, d * 0.6, axis="y")


def glasses(kit: Kit) -> None:
    """Draw a pair of glasses, folded open: two lenses, a bridge and two sides."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.tube((side * w * 0.27, d * 0.42, h / 2), h * 0.5, 0.006, axis="y")
        kit.tube((side * w * 0.27, d * 0.42, h / 2), h * 0.4, 0.008, GLASS, "y")
        kit.rod((side * w * 0.48, -d * 0.04, h * 0.65), 0.003, d * 0.9, axis="y")
    kit.rod((0, d * 0.42, h * 0.6), 0.003, w * 0.3, axis="x")


def mask(kit: Kit) -> None:
    """Draw a soft mask lying, with a band at each side."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.tube((side * w * 0.18, 0, 0), min(d / 2, w * 0.2), h * 0.8)
        kit.box((side * w * 0.44, 0, 0), (w * 0.12, d * 0.2, h * 0.4), BLACK)
    kit.box((0, -d * 0.1, 0), (w * 0.36, d * 0.7, h * 0.8))
    kit.box((0, -d * 0.3, h * 0.8), (w * 0.5, d * 0.1, 0.002), WHITE)


def gloves(kit: Kit) -> None:
    """Draw a pair of gloves lying: hands, thumbs and cuffs."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        x = side * w * 0.26
        kit.box((x, -d * 0.36, 0), (w * 0.3, d * 0.28, h * 0.8), shade(kit.colour, 0.75))
        kit.box((x, d * 0.0, 0), (w * 0.38, d * 0.46, h))
        for i in range(3):
            kit.rod((x + w * (i - 1) * 0.12, d * 0.34, h / 2), min(h / 2, w * 0.06), d * 0.34, axis="y")
        kit.rod((x - side * w * 0.2, d * 0.1, h / 2), min(h / 2, w * 0.06), d * 0.26, axis="y")


def trousers(kit: Kit) -> None:
    """Draw trousers lying: a waistband and two legs."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.36, 0), (w * 0.8, d * 0.28, h))
    kit.box((0, -d * 0.46, h), (w * 0.8, d * 0.08, 0.004), BLACK)
    kit.box((0, -d * 0.46, h), (w * 0.1, d * 0.09, 0.006), STEEL)
    for side in (-1, 1):
        kit.box((side * w * 0.24, d * 0.14, 0), (w * 0.34, d * 0.72, h * 0.9), shade(kit.colour, 0.95))
        kit.box((side * w * 0.24, d * 0.14, h * 0.9), (w * 0.02, d * 0.7, 0.002), shade(kit.colour, 1.4))


def socks(kit: Kit) -> None:
    """Draw a pair of socks lying: legs, feet and striped bands."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        x = side * w * 0.25
        kit.box((x, -d * 0.15, 0), (w * 0.24, d * 0.7, h))
        kit.box((x + w * 0.1, d * 0.34, 0), (w * 0.42, d * 0.3, h), shade(kit.colour, 0.85))
        kit.box((x, -d * 0.42, h), (w * 0.24, d * 0.1, 0.003), WHITE)
        kit.box((x, -d * 0.25, h), (w * 0.24, d * 0.06, 0.003), RED)


def apron(kit: Kit) -> None:
    """Draw an apron lying: bib, skirt with a pocket, and bands."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.22, 0), (w * 0.5, d * 0.4, h))
    kit.box((0, d * 0.22, 0), (w * 0.9, d * 0.56, h))
    kit.box((0, d * 0.2, h), (w * 0.4, d * 0.22, 0.003), shade(kit.colour, 0.7))
    for side in (-1, 1):
        kit.rod((side * w * 0.2, -d * 0.42, h / 2), 0.006, d * 0.16, CREAM, "y")
        kit.rod((side * w * 0.48, -d * 0.02, h / 2), 0.006, w * 0.2, CREAM, "x")


def beads(kit: Kit) -> None:
    """Draw beads on a string, laid in a ring."""
    r = min(kit.w, kit.d) / 2
    for x, y in ((1, 0), (0.8, 0.6), (0.3, 0.95), (-0.3, 0.95), (-0.8, 0.6), (-1, 0), (-0.8, -0.6), (-0.3, -0.95)):
        kit.ball((x * r * 0.9, y * r * 0.9, kit.h / 2), kit.h / 2, shade(kit.colour, 1.0 + 0.3 * (x > 0)))
    for x, y in ((0.3, -0.95), (0.8, -0.6)):
        kit.ball((x * r * 0.9, y * r * 0.9, kit.h / 2), kit.h / 2)
    kit.ball((0, -r, kit.h / 2), kit.h * 0.6, YELLOW)


def backpack(kit: Kit) -> None:
    """Draw a backpack: main bag, front pocket, flap, grip and straps."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.1, 0), (w, d * 0.75, h * 0.86))
    kit.box((0, d * 0.36, h * 0.08), (w * 0.7, d * 0.28, h * 0.4), shade(kit.colour, 0.75))
    kit.box((0, 0, h * 0.78), (w * 1.02, d * 0.8, h * 0.1), shade(kit.colour, 0.65))
    kit.rod((0, -d * 0.3, h * 0.96), h * 0.03, w * 0.4, BLACK, "x")
    for side in (-1, 1):
        kit.rod((side * w * 0.3, -d * 0.48, h * 0.45), 0.014, h * 0.7, BLACK)
        kit.box((side * w * 0.2, d * 0.3, h * 0.55), (0.02, 0.02, h * 0.26), YELLOW)


def umbrella(kit: Kit) -> None:
    """Draw a folded umbrella lying: a tip, the cloth and a curved grip towards the right."""
    w, r = kit.w, kit.h / 2
    kit.rod((-w * 0.44, 0, r), r * 0.2, w * 0.12, STEEL, "x")
    for x, part, long in ((-0.3, 0.6, 0.24), (-0.12, 0.85, 0.24), (0.06, 1.0, 0.24)):
        kit.tube((x * w, 0, r), r * part, w * long, axis="x")
    kit.rod((w * 0.3, 0, r), r * 0.28, w * 0.3, STEEL, "x")
    kit.rod((w * 0.46, 0, r), r * 0.45, w * 0.1, WOOD, "x")
    kit.rod((w * 0.49, kit.d * 0.3, r), r * 0.4, kit.d * 0.6, WOOD, "y")


def watch(kit: Kit) -> None:
    """Draw a watch lying: a round face with hands, and its strap."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.45, d, h * 0.4), shade(kit.colour, 0.7))
    kit.tube((0, 0, h * 0.3), w / 2, h * 0.6, STEEL)
    kit.tube((0, 0, h * 0.9), w * 0.42, 0.002, WHITE)
    kit.box((0, w * 0.12, h), (w * 0.05, w * 0.26, 0.001), BLACK)
    kit.box((w * 0.1, 0, h), (w * 0.2, w * 0.05, 0.001), BLACK)


def cube(kit: Kit) -> None:
    """Draw a cube with coloured fields: dice, or a puzzle to turn."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    for x, y, colour in ((-0.26, -0.26, RED), (0.26, -0.26, BLUE), (-0.26, 0.26, YELLOW), (0.26, 0.26, GREEN)):
        kit.box((x * w, y * d, h), (w * 0.42, d * 0.42, 0.001), colour)
        kit.box((x * w, d / 2, h * (0.5 + y - 0.21)), (w * 0.42, 0.002, h * 0.42), shade(colour, 0.8))


def chess_board(kit: Kit) -> None:
    """Draw a chequered board with a few pieces."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.3))
    for i in range(8):
        x, y = -0.375 + 0.25 * (i % 4), 0.125 + 0.25 * (i % 2) - 0.5 * (i // 4)
        kit.box((w * x, d * y, h * 0.3), (w * 0.25, d * 0.25, 0.002), CREAM)
    for x, y, colour in ((-0.38, -0.4, BLACK), (-0.1, -0.4, BLACK), (0.2, -0.3, BLACK)):
        kit.tube((x * w, y * d, h * 0.3), w * 0.035, h * 0.7, colour)
    for x, y in ((-0.3, 0.4), (0.12, 0.3), (0.38, 0.4)):
        kit.tube((x * w, y * d, h * 0.3), w * 0.035, h * 0.7, WHITE)


def chess_piece(kit: Kit) -> None:
    """Draw a turned figure: foot, body and head."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r, h * 0.14)
    kit.tube((0, 0, h * 0.14), r * 0.7, h * 0.16)
    kit.tube((0, 0, h * 0.3), r * 0.42, h * 0.3)
    kit.tube((0, 0, h * 0.6), r * 0.7, h * 0.06)
    kit.ball((0, 0, h * 0.84), min(h * 0.16, r * 0.8))


def rubber_duck(kit: Kit) -> None:
    """Draw a rubber duck: body, head, beak, eyes and tail."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((0, -d * 0.06, h * 0.3), h * 0.3, d * 0.85, axis="y")
    kit.ball((0, d * 0.2, h * 0.74), h * 0.26)
    kit.box((0, d * 0.46, h * 0.66), (w * 0.3, d * 0.16, h * 0.1), (0.95, 0.5, 0.1))
    kit.box((0, -d * 0.42, h * 0.4), (w * 0.3, d * 0.16, h * 0.2))
    for side in (-1, 1):
        kit.ball((side * w * 0.14, d * 0.38, h * 0.84), h * 0.04, BLACK)


def palette(kit: Kit) -> None:
    """Draw a painter's palette with blobs of colour."""
    w, d, h = kit.w, kit.d, kit.h
    for x in (-0.16, 0.16):
        kit.tube((x * w, 0, 0), min(d / 2, w * 0.34), h * 0.5)
    kit.tube((w * 0.26, -d * 0.2, h * 0.5), d * 0.08, 0.001, BLACK)
    for x, y, colour in (
        (-0.3, 0.15, RED),
        (-0.12, 0.3, YELLOW),
        (0.1, 0.3, BLUE),
        (0.28, 0.18, GREEN),
        (-0.32, -0.15, WHITE),
    ):
        kit.ball((x * w, y * d, h * 0.7), h * 0.6, colour)


def canvas(kit: Kit) -> None:
    """Draw a canvas lying: a frame, a white ground and the beginning of a picture."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.8), WOOD)
    kit.box((0, 0, h * 0.8), (w * 0.98, d * 0.98, h * 0.2), WHITE)
    kit.box((0, -d * 0.2, h), (w * 0.86, d * 0.4, 0.001), (0.5, 0.7, 0.95))
    kit.box((0, d * 0.18, h), (w * 0.86, d * 0.3, 0.001), GREEN)
    kit.tube((w * 0.2, -d * 0.2, h), d * 0.1, 0.002, YELLOW)


def kettlebell(kit: Kit) -> None:
    """Draw a kettlebell: a heavy ball and a handle."""
    r = min(kit.w / 2, kit.h * 0.33)
    kit.ball((0, 0, r), r)
    for side in (-1, 1):
        kit.rod((side * r * 0.6, 0, kit.h * 0.74), r * 0.16, kit.h * 0.45, STEEL)
    kit.rod((0, 0, kit.h * 0.94), kit.h * 0.06, r * 1.5, STEEL, "x")


def puzzle_piece(kit: Kit) -> None:
    """Draw a piece of a jigsaw puzzle with its knobs."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.7, d * 0.7, h))
    kit.tube((w * 0.4, 0, 0), w * 0.13, h)
    kit.tube((0, d * 0.4, 0), w * 0.13, h)
    kit.tube((-w * 0.28, 0, h), w * 0.1, 0.001, WHITE)
    kit.box((0, -d * 0.1, h), (w * 0.4, d * 0.2, 0.001), BLUE)


def figurine(kit: Kit) -> None:
    """Draw a small figure on a foot: skirt, arms and head."""
    r, h = kit.w / 2, kit.h
    kit.box((0, 0, 0), (kit.w, kit.d, h * 0.1), DARK)
    for z, part in ((0.1, 0.8), (0.25, 0.6), (0.4, 0.45)):
        kit.tube((0, 0, h * z), r * part, h * 0.15)
    kit.tube((0, 0, h * 0.55), r * 0.4, h * 0.18, shade(kit.colour, 0.8))
    kit.rod((0, 0, h * 0.66), r * 0.14, r * 1.7, CREAM, "x")
    kit.ball((0, 0, h * 0.86), h * 0.13, CREAM)


def metronome(kit: Kit) -> None:
    """Draw a pyramid with a dial and a pendulum."""
    w, d, h = kit.w, kit.d, kit.h
    for i, part in enumerate((1.0, 0.84, 0.68, 0.52)):
        kit.box((0, 0, h * 0.25 * i), (w * part, d * part, h * 0.25))
    kit.box((0, d * 0.36, h * 0.2), (w * 0.3, 0.05 * d, h * 0.7), CREAM, tilt=0.12)
    kit.box((0, d * 0.42, h * 0.15), (0.006, 0.006, h * 0.85), STEEL, tilt=0.12)


def record_player(kit: Kit) -> None:
    """Draw a record player: base, record, arm and a knob."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.7))
    kit.tube((-w * 0.1, 0, h * 0.7), min(w, d) * 0.4, h * 0.16, BLACK)
    kit.tube((-w * 0.1, 0, h * 0.86), min(w, d) * 0.14, 0.002, RED)
    kit.rod((w * 0.36, 0, h * 0.93), h * 0.07, d * 0.7, STEEL, "y")
    kit.tube((w * 0.4, d * 0.36, h * 0.7), w * 0.04, h * 0.2, STEEL)


PERSONAL_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        *(tube_of_paste, spray_bottle, razor, lipstick, hair_dryer, glasses, mask, gloves, trousers, socks, apron),
        *(beads, backpack, umbrella, watch, cube, chess_board, chess_piece, rubber_duck, palette, canvas, kettlebell),
        *(puzzle_piece, figurine, metronome, record_player),
    )
}
