"""Recipes of household things: clothes, textiles, care, containers, pets, craft and cleaning."""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    BLUE,
    CREAM,
    DARK,
    DARK_WOOD,
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


def towel(kit: Kit) -> None:
    """Draw a folded towel with stripes."""
    for i in range(3):
        tone = shade(kit.colour, 1.0 + 0.12 * (i % 2))
        kit.box((0, -0.004 * i, kit.h * i / 3), (kit.w, kit.d, kit.h / 3 - 0.002), tone)
    kit.box((kit.w * 0.3, 0, kit.h), (kit.w * 0.08, kit.d, 0.002), WHITE)
    kit.box((-kit.w * 0.3, 0, kit.h), (kit.w * 0.08, kit.d, 0.002), WHITE)


def toothbrush(kit: Kit) -> None:
    """Draw a toothbrush in a beaker."""
    kit.tube((0, 0, 0), kit.w * 0.45, kit.h * 0.5, (0.6, 0.8, 0.9))
    kit.box((0.01, 0, kit.h * 0.1), (0.014, 0.012, kit.h * 0.9))
    kit.box((0.01, 0.014, kit.h * 0.84), (0.014, 0.02, kit.h * 0.16), WHITE)


def hairbrush(kit: Kit) -> None:
    """Draw a hairbrush: oval head with bristles, handle."""
    kit.box((-kit.w * 0.22, 0, kit.h * 0.5), (kit.w * 0.44, kit.d, kit.h * 0.5))
    kit.box((-kit.w * 0.22, 0, 0), (kit.w * 0.38, kit.d * 0.8, kit.h * 0.5), BLACK)
    kit.box((kit.w * 0.25, 0, kit.h * 0.5), (kit.w * 0.5, kit.d * 0.4, kit.h * 0.4))


def toilet_paper(kit: Kit) -> None:
    """Draw a standing roll with its core and a loose sheet."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h)
    kit.tube((0, 0, kit.h), kit.w * 0.18, 0.002, (0.6, 0.5, 0.38))
    kit.box((kit.w * 0.3, kit.w * 0.42, 0), (kit.w * 0.4, 0.004, kit.h), shade(kit.colour, 0.88))


def laundry_basket(kit: Kit) -> None:
    """Draw a basket with dark holes and clothes at the top."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.9, d * 0.9, h * 0.5))
    kit.box((0, 0, h * 0.5), (w, d, h * 0.35))
    for i in range(4):
        x = w * (-0.3 + 0.2 * i)
        kit.box((x, 0, h * 0.2), (w * 0.07, d * 0.92, h * 0.12), shade(kit.colour, 0.55))
        kit.box((x, 0, h * 0.55), (w * 0.07, d * 1.01, h * 0.12), shade(kit.colour, 0.55))
    for x, y, colour in ((-0.2, 0.1, RED), (0.15, -0.1, BLUE), (0.1, 0.2, CREAM)):
        kit.box((x * w, y * d, h * 0.8), (w * 0.4, d * 0.4, h * 0.2), colour)


def shirt(kit: Kit) -> None:
    """Draw a folded shirt: body, sleeves, collar and buttons."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.66, d, h))
    for side in (-1, 1):
        kit.box((side * w * 0.4, d * 0.26, 0), (w * 0.2, d * 0.4, h * 0.8), shade(kit.colour, 0.88))
        kit.box((side * w * 0.08, d * 0.44, h), (w * 0.14, d * 0.12, 0.012), shade(kit.colour, 1.5))
    for i in range(4):
        kit.tube((0, d * (-0.36 + 0.2 * i), h), 0.008, 0.003, WHITE)


def hat(kit: Kit) -> None:
    """Draw a hat: brim, crown and ribbon."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h * 0.1)
    kit.tube((0, 0, kit.h * 0.1), kit.w * 0.3, kit.h * 0.9)
    kit.tube((0, 0, kit.h * 0.1), kit.w * 0.31, kit.h * 0.22, DARK)


def shoes(kit: Kit) -> None:
    """Draw a pair of shoes, toes to the front."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        x = side * w * 0.27
        kit.box((x, 0, 0), (w * 0.42, d, h * 0.2), WHITE)
        kit.box((x, -d * 0.2, h * 0.2), (w * 0.4, d * 0.55, h * 0.8))
        kit.box((x, d * 0.2, h * 0.2), (w * 0.4, d * 0.5, h * 0.4))
        kit.box((x, -d * 0.2, h * 0.95), (w * 0.28, d * 0.4, h * 0.06), BLACK)


def handbag(kit: Kit) -> None:
    """Draw a handbag with a flap, a clasp and a handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.62))
    kit.box((0, d * 0.06, h * 0.34), (w * 0.96, d, h * 0.3), shade(kit.colour, 0.75))
    kit.box((0, d * 0.58, h * 0.33), (0.04, 0.012, 0.04), YELLOW)
    for side in (-1, 1):
        kit.box((side * w * 0.28, 0, h * 0.6), (0.02, 0.02, h * 0.4), shade(kit.colour, 0.6))
    kit.box((0, 0, h - 0.02), (w * 0.58, 0.02, 0.02), shade(kit.colour, 0.6))


def scarf(kit: Kit) -> None:
    """Draw a folded striped scarf with fringes."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    for x in (-0.3, 0, 0.3):
        kit.box((x * w, 0, h), (w * 0.12, d, 0.002), shade(kit.colour, 1.6))
    for i in range(5):
        kit.box((w * (-0.4 + 0.2 * i), d / 2 + 0.012, 0), (0.012, 0.03, h * 0.5), shade(kit.colour, 0.7))


def cushion(kit: Kit) -> None:
    """Draw a plump cushion: a rounded edge around a thick middle."""
    w, d, h = kit.w, kit.d, kit.h
    r = h * 0.34
    kit.box((0, 0, h * 0.08), (w - 2 * r, d - 2 * r, h * 0.84))
    kit.box((0, 0, 0), (w * 0.55, d * 0.55, h), shade(kit.colour, 1.25))
    for side in (-1, 1):
        kit.rod((0, side * (d / 2 - r), h / 2), r, w, axis="x")
        kit.rod((side * (w / 2 - r), 0, h / 2), r, d, axis="y")


def blanket(kit: Kit) -> None:
    """Draw a folded chequered blanket."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.48))
    kit.box((0, 0, h * 0.5), (w * 0.97, d * 0.97, h * 0.5), shade(kit.colour, 1.15))
    for x in (-0.25, 0.15):
        kit.box((x * w, 0, h), (w * 0.1, d * 0.97, 0.003), CREAM)
        kit.box((0, x * d, h), (w * 0.97, d * 0.1, 0.003), shade(kit.colour, 0.6))


def trash_can(kit: Kit) -> None:
    """Draw a pedal bin with a dark lid."""
    r = kit.w / 2
    kit.tube((0, 0, 0), r * 0.9, kit.h * 0.06, BLACK)
    kit.tube((0, 0, kit.h * 0.06), r * 0.94, kit.h * 0.76)
    kit.tube((0, 0, kit.h * 0.82), r, kit.h * 0.1, BLACK)
    kit.tube((0, 0, kit.h * 0.92), r * 0.7, kit.h * 0.08, BLACK)
    kit.box((0, r, 0.01), (0.08, 0.06, 0.015), BLACK)


def pet_bowl(kit: Kit) -> None:
    """Draw a flared feeding bowl with dry food and a bone on it."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h * 0.45)
    kit.tube((0, 0, kit.h * 0.45), kit.w * 0.44, kit.h * 0.45)
    kit.tube((0, 0, kit.h * 0.9), kit.w * 0.38, kit.h * 0.1, (0.5, 0.3, 0.15))
    kit.box((0, kit.w * 0.47, kit.h * 0.25), (kit.w * 0.3, 0.02, kit.h * 0.2), WHITE)


def pet_toy(kit: Kit) -> None:
    """Draw a toy bone."""
    r = kit.h / 2
    kit.rod((0, 0, r), r * 0.6, kit.w * 0.8, axis="x")
    for x in (-1, 1):
        for y in (-1, 1):
            kit.ball((x * (kit.w / 2 - r), y * (kit.d / 2 - r), r), r)


def paint_box(kit: Kit) -> None:
    """Draw an open paint box with wells of colour and a brush."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.6))
    colours = (RED, YELLOW, GREEN, BLUE, (0.55, 0.25, 0.6), (0.95, 0.5, 0.15), WHITE, BLACK)
    for i, colour in enumerate(colours):
        x, y = -0.36 + 0.24 * (i % 4), -0.2 + 0.4 * (i // 4)
        kit.box((x * w, y * d, h * 0.6), (w * 0.19, d * 0.28, h * 0.15), colour)
    kit.rod((0, 0, h * 0.85), h * 0.12, w * 0.85, WOOD, "x")


def knitting_basket(kit: Kit) -> None:
    """Draw a wicker basket with balls of wool and two needles."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r * 0.88, h * 0.3)
    kit.tube((0, 0, h * 0.3), r, h * 0.25, shade(kit.colour, 0.85))
    for x, y, colour in ((-0.4, 0.1, RED), (0.35, 0.3, BLUE), (0.2, -0.4, YELLOW)):
        kit.ball((x * r, y * r, h * 0.62), r * 0.42, colour)
    for side in (-1, 1):
        kit.tube((side * 0.03, 0, h * 0.4), 0.006, h * 0.6, STEEL)


def scissors(kit: Kit) -> None:
    """Draw scissors: two blades and two rings."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((-w * 0.2, side * d * 0.1, 0), (w * 0.6, d * 0.14, h * 0.6), STEEL)
        kit.tube((w * 0.3, side * d * 0.27, 0), min(d * 0.27, w * 0.2), h)
        kit.tube((w * 0.3, side * d * 0.27, h), min(d * 0.15, w * 0.11), 0.001, WHITE)


def toolbox(kit: Kit) -> None:
    """Draw a toolbox: lid, grip and two clasps."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.52))
    kit.box((0, 0, h * 0.52), (w, d, h * 0.24), shade(kit.colour, 0.75))
    kit.box((0, 0, h * 0.88), (w * 0.45, 0.035, h * 0.12), BLACK)
    for side in (-1, 1):
        kit.box((side * w * 0.2, 0, h * 0.74), (0.03, 0.035, h * 0.2), BLACK)
        kit.box((side * w * 0.3, d / 2, h * 0.44), (0.05, 0.012, h * 0.16), STEEL)


def sewing_kit(kit: Kit) -> None:
    """Draw a sewing box with reels of thread on top."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.6))
    for i, colour in enumerate((RED, BLUE, YELLOW)):
        x = kit.w * (-0.28 + 0.28 * i)
        kit.tube((x, 0, kit.h * 0.6), kit.d * 0.15, kit.h * 0.34, colour)
        kit.tube((x, 0, kit.h * 0.94), kit.d * 0.18, kit.h * 0.06, WOOD)


def tissue_box(kit: Kit) -> None:
    """Draw a tissue box with a tissue standing out."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.68))
    kit.box((0, 0, kit.h * 0.68), (kit.w * 0.5, kit.d * 0.25, 0.002), DARK)
    kit.box((0, 0, kit.h * 0.66), (kit.w * 0.3, 0.012, kit.h * 0.34), WHITE, tilt=0.25)
    kit.box((0.01, 0.01, kit.h * 0.66), (kit.w * 0.22, 0.012, kit.h * 0.28), WHITE, tilt=-0.3)


def broom(kit: Kit) -> None:
    """Draw a broom lying down, bristles at the left."""
    r = kit.h * 0.3
    kit.tube((kit.w * 0.08, 0, kit.h * 0.5), min(r, 0.014), kit.w * 0.84, WOOD, "x")
    kit.box((-kit.w * 0.37, 0, 0), (kit.w * 0.05, kit.d * 0.8, kit.h))
    kit.box((-kit.w * 0.445, 0, 0), (kit.w * 0.11, kit.d, kit.h * 0.9), YELLOW)


def feather_duster(kit: Kit) -> None:
    """Draw a duster: a fluffy head at the left and a handle."""
    r = min(kit.h, kit.d) / 2
    for i, part in enumerate((0.75, 1.0, 0.8)):
        kit.ball((kit.w * (-0.36 + 0.15 * i), 0, r), r * part, shade(kit.colour, 0.9 + 0.15 * i))
    kit.rod((kit.w * 0.22, 0, r), 0.011, kit.w * 0.54, DARK_WOOD, "x")


def fish_bowl(kit: Kit) -> None:
    """Draw a round bowl of water with a goldfish in it."""
    r, h = min(kit.w, kit.d) / 2, kit.h
    kit.tube((0, 0, 0), r * 0.6, h * 0.06, STEEL)
    for low, part in ((0.06, 0.86), (0.24, 1.0), (0.42, 1.0), (0.6, 0.9)):
        kit.tube((0, 0, h * low), r * part, h * 0.18, (0.5, 0.78, 0.92))
    kit.tube((0, 0, h * 0.78), r * 0.82, h * 0.04, (0.86, 0.94, 0.98))
    for side in (-1, 1):  # seen through the glass from the front and from the back
        kit.ball((0, side * r * 0.82, h * 0.46), r * 0.3)
        kit.box((r * 0.34, side * r * 0.84, h * 0.36), (r * 0.22, r * 0.2, h * 0.2), shade(kit.colour, 0.75))
        kit.ball((-r * 0.2, side * r * 1.04, h * 0.5), r * 0.07, BLACK)
    kit.rod((-r * 0.5, r * 0.4, h * 0.8), r * 0.07, h * 0.3, GREEN)


HOUSEHOLD_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        towel,
        toothbrush,
        hairbrush,
        toilet_paper,
        laundry_basket,
        shirt,
        hat,
        shoes,
        handbag,
        scarf,
        cushion,
        blanket,
        trash_can,
        pet_bowl,
        pet_toy,
        paint_box,
        knitting_basket,
        scissors,
        toolbox,
        sewing_kit,
        tissue_box,
        broom,
        feather_duster,
        fish_bowl,
    )
}
