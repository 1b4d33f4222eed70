"""Recipes of small things of the kitchen: dishes, cookware, bottles, packets and food."""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    DARK,
    DARK_WOOD,
    GREEN,
    PAPER,
    RED,
    STEEL,
    WHITE,
    WOOD,
    YELLOW,
    Colour,
    Kit,
    Recipe,
    shade,
)


def mug(kit: Kit) -> None:
    """Draw a mug with coffee in it and a handle at its right."""
    r = kit.d / 2
    x = -(kit.w - kit.d) / 2
    kit.tube((x, 0, 0), r, kit.h)
    kit.tube((x, 0, kit.h), r * 0.82, 0.002, (0.3, 0.17, 0.08))
    kit.box((x + r + 0.022, 0, kit.h * 0.25), (0.012, 0.016, kit.h * 0.55))
    for z in (0.25, 0.7):
        kit.box((x + r + 0.008, 0, kit.h * z), (0.03, 0.016, 0.012))


def plate(kit: Kit) -> None:
    """Draw a plate: a rim and a coloured middle."""
    kit.tube((0, 0, 0), kit.w * 0.35, kit.h * 0.6, shade(kit.colour, 0.8))
    kit.tube((0, 0, kit.h * 0.4), kit.w / 2, kit.h * 0.5)
    kit.tube((0, 0, kit.h * 0.9), kit.w * 0.33, kit.h * 0.1, shade(kit.colour, 0.85))


def bowl(kit: Kit) -> None:
    """Draw a bowl that widens upwards."""
    for i, part in enumerate((0.55, 0.78, 0.93, 1.0)):
        kit.tube((0, 0, kit.h * 0.25 * i), kit.w / 2 * part, kit.h * 0.25)
    kit.tube((0, 0, kit.h), kit.w * 0.42, 0.002, shade(kit.colour, 0.6))


def glass(kit: Kit) -> None:
    """Draw a drinking glass with a rim of light."""
    kit.tube((0, 0, 0), kit.w * 0.42, kit.h * 0.6, (0.5, 0.72, 0.88))
    kit.tube((0, 0, kit.h * 0.6), kit.w * 0.5, kit.h * 0.4, (0.85, 0.94, 0.98))


def teapot(kit: Kit) -> None:
    """Draw a round teapot: lid with knob, spout at the left, handle at the right."""
    r = min(kit.d, kit.h * 0.8) / 2
    kit.ball((0, 0, r), r)
    kit.tube((0, 0, r * 1.75), r * 0.55, 0.012, shade(kit.colour, 0.7))
    kit.ball((0, 0, kit.h - 0.015), 0.015, shade(kit.colour, 0.7))
    kit.box((-r * 1.1, 0, r), (r * 0.7, 0.025, 0.025))
    kit.box((-r * 1.4, 0, r), (0.025, 0.025, r * 0.7))
    kit.box((r * 1.4, 0, r * 0.5), (0.018, 0.02, r))
    for z in (0.5, 1.4):
        kit.box((r * 1.15, 0, r * z), (r * 0.55, 0.02, 0.018))


def tray(kit: Kit) -> None:
    """Draw a tray with a rim and two dark grips."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.3))
    for side in (-1, 1):
        kit.box((side * (kit.w / 2 - 0.008), 0, 0), (0.016, kit.d, kit.h), shade(kit.colour, 0.7))
        kit.box((0, side * (kit.d / 2 - 0.008), 0), (kit.w, 0.016, kit.h * 0.7), shade(kit.colour, 0.7))
        kit.box((side * (kit.w / 2 - 0.006), 0, kit.h * 0.7), (0.02, kit.d * 0.4, kit.h * 0.4), BLACK)


def frying_pan(kit: Kit) -> None:
    """Draw a frying pan, its handle towards the right."""
    r = kit.d / 2
    x = -kit.w / 2 + r
    kit.tube((x, 0, 0), r, kit.h)
    kit.tube((x, 0, kit.h), r * 0.86, 0.002, DARK)
    kit.box((x + r + (kit.w - kit.d) / 2 - 0.01, 0, kit.h * 0.6), (kit.w - kit.d + 0.02, 0.03, 0.018), BLACK)


def cooking_pot(kit: Kit) -> None:
    """Draw a pot with a lid and two handles."""
    r = kit.d / 2
    kit.tube((0, 0, 0), r, kit.h * 0.8)
    kit.tube((0, 0, kit.h * 0.8), r * 1.03, kit.h * 0.08, shade(kit.colour, 1.3))
    kit.ball((0, 0, kit.h * 0.93), kit.h * 0.07, BLACK)
    for side in (-1, 1):
        kit.box((side * (r + 0.018), 0, kit.h * 0.6), (0.04, 0.08, 0.02), BLACK)


def kettle(kit: Kit) -> None:
    """Draw an electric kettle: foot plate, tapering body, spout and handle."""
    r = kit.d / 2
    kit.tube((0, 0, 0), r, kit.h * 0.08, BLACK)
    for i, part in enumerate((0.95, 0.85, 0.74)):
        kit.tube((0, 0, kit.h * (0.08 + 0.27 * i)), r * part, kit.h * 0.27)
    kit.tube((0, 0, kit.h * 0.89), r * 0.6, kit.h * 0.06, BLACK)
    kit.box((-r * 0.9, 0, kit.h * 0.68), (r * 0.6, 0.03, 0.035))
    kit.box((r * 1.3, 0, kit.h * 0.25), (0.022, 0.028, kit.h * 0.6), BLACK)
    kit.box((r, 0, kit.h * 0.8), (r * 0.7, 0.028, 0.025), BLACK)


def cutting_board(kit: Kit) -> None:
    """Draw a wooden board with a grip and a hole."""
    kit.box((-0.02, 0, 0), (kit.w - 0.04, kit.d, kit.h))
    kit.box((kit.w / 2 - 0.03, 0, 0), (0.06, kit.d * 0.35, kit.h))
    kit.tube((kit.w / 2 - 0.025, 0, kit.h), 0.012, 0.001, BLACK)
    kit.box((-0.02, 0, kit.h), (kit.w * 0.8, 0.008, 0.001), shade(kit.colour, 0.7))


def kitchen_knife(kit: Kit) -> None:
    """Draw a knife lying flat: steel blade and dark handle."""
    kit.box((-kit.w * 0.18, 0, 0), (kit.w * 0.64, kit.d, kit.h * 0.5), STEEL)
    kit.box((kit.w * 0.32, 0, 0), (kit.w * 0.36, kit.d * 0.7, kit.h))


def spoon(kit: Kit) -> None:
    """Draw a spoon: a round bowl and a thin handle."""
    kit.tube((-kit.w * 0.38, 0, 0), kit.d / 2, kit.h)
    kit.box((kit.w * 0.12, 0, 0), (kit.w * 0.76, kit.d * 0.3, kit.h * 0.7))


def spatula(kit: Kit) -> None:
    """Draw a spatula: a flat slotted blade and a handle."""
    kit.box((-kit.w * 0.36, 0, 0), (kit.w * 0.28, kit.d, kit.h * 0.5))
    for y in (-0.2, 0.2):
        kit.box((-kit.w * 0.36, y * kit.d, kit.h * 0.5), (kit.w * 0.2, kit.d * 0.12, 0.001), WHITE)
    kit.box((kit.w * 0.14, 0, 0), (kit.w * 0.72, kit.d * 0.25, kit.h), DARK_WOOD)


def _bottle(kit: Kit, neck: float, cap: Colour, label: Colour, *, shoulder: float = 0.62) -> None:
    r = kit.w / 2
    kit.tube((0, 0, 0), r, kit.h * shoulder)
    kit.tube((0, 0, kit.h * 0.16), r * 1.06, kit.h * 0.3, label)
    kit.tube((0, 0, kit.h * shoulder), r * 0.72, kit.h * 0.08)
    kit.tube((0, 0, kit.h * (shoulder + 0.08)), r * neck, kit.h * (0.84 - shoulder))
    kit.tube((0, 0, kit.h * 0.91), r * neck * 1.15, kit.h * 0.09, cap)


def water_bottle(kit: Kit) -> None:
    """Draw a sports bottle with a wide cap."""
    _bottle(kit, 0.55, BLACK, WHITE, shoulder=0.7)


def wine_bottle(kit: Kit) -> None:
    """Draw a dark bottle with a long neck and a cream label."""
    _bottle(kit, 0.38, RED, (0.93, 0.88, 0.72), shoulder=0.58)


def mustard_bottle(kit: Kit) -> None:
    """Draw a yellow squeeze bottle with a pointed cap."""
    kit.box((0, 0, 0), (kit.w, kit.d * 0.8, kit.h * 0.68))
    kit.box((0, 0, kit.h * 0.2), (kit.w * 0.8, kit.d * 0.84, kit.h * 0.25), RED)
    kit.tube((0, 0, kit.h * 0.68), kit.d * 0.3, kit.h * 0.14, RED)
    kit.tube((0, 0, kit.h * 0.82), kit.d * 0.12, kit.h * 0.18, RED)


def bleach_bottle(kit: Kit) -> None:
    """Draw a white jug with a blue cap, label and grip."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.7))
    kit.box((0, 0, kit.h * 0.18), (kit.w * 0.9, kit.d * 1.03, kit.h * 0.34), (0.15, 0.4, 0.75))
    kit.box((-kit.w * 0.15, 0, kit.h * 0.7), (kit.w * 0.5, kit.d * 0.6, kit.h * 0.16))
    kit.tube((-kit.w * 0.15, 0, kit.h * 0.86), kit.d * 0.28, kit.h * 0.14, (0.1, 0.3, 0.65))
    kit.box((kit.w * 0.36, 0, kit.h * 0.6), (kit.w * 0.2, kit.d * 0.35, kit.h * 0.22))


def _packet(kit: Kit, band: Colour, dot: Colour) -> None:
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    kit.box((0, 0, kit.h * 0.55), (kit.w * 1.01, kit.d * 1.03, kit.h * 0.25), band)
    kit.box((0, kit.d / 2, kit.h * 0.15), (kit.w * 0.5, 0.004, kit.h * 0.3), dot)


def cracker_box(kit: Kit) -> None:
    """Draw a tall packet with a white band and golden crackers on it."""
    _packet(kit, WHITE, (0.9, 0.65, 0.25))


def sugar_box(kit: Kit) -> None:
    """Draw a yellow and white packet."""
    _packet(kit, WHITE, (0.2, 0.35, 0.7))


def pudding_box(kit: Kit) -> None:
    """Draw a small flat brown packet."""
    _packet(kit, (0.95, 0.9, 0.75), (0.5, 0.28, 0.12))


def gelatin_box(kit: Kit) -> None:
    """Draw a low box with a light band and a red berry."""
    _packet(kit, PAPER, RED)


def _can(kit: Kit, label: Colour) -> None:
    kit.tube((0, 0, 0), kit.w / 2, kit.h, STEEL)
    kit.tube((0, 0, kit.h * 0.1), kit.w / 2 * 1.03, kit.h * 0.42)
    kit.tube((0, 0, kit.h * 0.52), kit.w / 2 * 1.03, kit.h * 0.38, label)


def tomato_soup_can(kit: Kit) -> None:
    """Draw a red and white can."""
    _can(kit, WHITE)


def tuna_can(kit: Kit) -> None:
    """Draw a flat blue can."""
    _can(kit, YELLOW)


def chips_can(kit: Kit) -> None:
    """Draw a tall tube with a light lid."""
    _can(kit, YELLOW)


def coffee_can(kit: Kit) -> None:
    """Draw a wide can with a brown label."""
    _can(kit, DARK_WOOD)


def potted_meat_can(kit: Kit) -> None:
    """Draw a low tin with flat sides, a yellow band and a ring to open it."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    kit.box((0, 0, kit.h * 0.25), (kit.w * 1.01, kit.d * 1.01, kit.h * 0.45), YELLOW)
    kit.box((0, 0, kit.h * 0.94), (kit.w * 0.96, kit.d * 0.96, kit.h * 0.06), STEEL)
    kit.tube((0, 0, kit.h), kit.d * 0.2, 0.003, DARK)


def banana(kit: Kit) -> None:
    """Draw a banana: three pieces along a bow, dark ends."""
    r, d, w = kit.h / 2, kit.d, kit.w
    kit.rod((0, -d / 2 + r, r), r, w * 0.5, axis="x")
    for side in (-1, 1):
        kit.rod((side * w * 0.28, -d * 0.12, r), r * 0.95, w * 0.3, axis="x")
        kit.rod((side * w * 0.39, d / 2 - r * 1.4, r), r * 0.85, w * 0.2, axis="x")
        kit.ball((side * w * 0.47, d / 2 - r, r), r * 0.4, DARK_WOOD)


def _fruit(kit: Kit) -> None:
    kit.ball((0, 0, kit.h * 0.48), min(kit.w, kit.h) * 0.48)


def apple(kit: Kit) -> None:
    """Draw an apple with a stalk and a leaf."""
    _fruit(kit)
    kit.tube((0, 0, kit.h * 0.9), 0.004, kit.h * 0.16, DARK_WOOD)
    kit.box((0.014, 0, kit.h), (0.025, 0.014, 0.004), GREEN)


def lemon(kit: Kit) -> None:
    """Draw a lemon with its two tips."""
    kit.ball((0, 0, kit.h * 0.48), kit.h * 0.48)
    kit.rod((0, 0, kit.h * 0.48), kit.h * 0.2, kit.w, axis="x")


def orange(kit: Kit) -> None:
    """Draw an orange with a green dot."""
    _fruit(kit)
    kit.tube((0, 0, kit.h * 0.95), 0.006, 0.004, GREEN)


def sponge(kit: Kit) -> None:
    """Draw a sponge with a green scouring side."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.7))
    kit.box((0, 0, kit.h * 0.7), (kit.w, kit.d, kit.h * 0.3), GREEN)


def vase(kit: Kit) -> None:
    """Draw a bellied vase with three flowers."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r * 0.55, h * 0.08)
    kit.ball((0, 0, h * 0.25), min(r, h * 0.2))
    kit.tube((0, 0, h * 0.38), r * 0.4, h * 0.16)
    kit.tube((0, 0, h * 0.54), r * 0.5, h * 0.04)
    flowers: tuple[tuple[float, float, float, Colour], ...] = (
        (-0.5, 0, 0.86, RED),
        (0.5, 0.2, 0.9, YELLOW),
        (0, -0.4, 0.95, WHITE),
    )
    for x, y, z, colour in flowers:
        kit.tube((x * r * 0.6, y * r * 0.6, h * 0.5), 0.006, h * (z - 0.52), GREEN)
        kit.ball((x * r, y * r, h * z - 0.02), r * 0.38, colour)


def candle(kit: Kit) -> None:
    """Draw a candle on a saucer, alight."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h * 0.1, STEEL)
    kit.tube((0, 0, kit.h * 0.1), kit.w * 0.32, kit.h * 0.66)
    kit.ball((0, 0, kit.h * 0.86), kit.h * 0.09, (1.0, 0.65, 0.1))


def watering_can(kit: Kit) -> None:
    """Draw a watering can: body, long spout with a rose at the left, hoop handle."""
    r = kit.d / 2
    kit.tube((kit.w * 0.12, 0, 0), r, kit.h * 0.65)
    kit.box((-kit.w * 0.22, 0, kit.h * 0.28), (kit.w * 0.4, 0.025, 0.03))
    kit.box((-kit.w * 0.4, 0, kit.h * 0.28), (0.03, 0.03, kit.h * 0.5))
    kit.tube((-kit.w * 0.42, 0, kit.h * 0.76), 0.035, 0.02, shade(kit.colour, 0.7))
    for side in (-1, 1):
        kit.box((kit.w * 0.12 + side * r * 0.8, 0, kit.h * 0.6), (0.018, 0.022, kit.h * 0.38))
    kit.box((kit.w * 0.12, 0, kit.h - 0.02), (r * 1.6, 0.022, 0.02))


def soap_dispenser(kit: Kit) -> None:
    """Draw a pump bottle."""
    kit.tube((0, 0, 0), kit.w / 2, kit.h * 0.64)
    kit.tube((0, 0, kit.h * 0.64), kit.w * 0.15, kit.h * 0.26, STEEL)
    kit.box((0, kit.w * 0.2, kit.h * 0.9), (0.02, kit.w * 0.8, kit.h * 0.1), STEEL)


def potted_plant(kit: Kit) -> None:
    """Draw a plant in a pot: dark earth and a crown of leaves."""
    r, h = min(kit.w, kit.d) / 2, kit.h
    kit.tube((0, 0, 0), r * 0.6, h * 0.2)
    kit.tube((0, 0, h * 0.2), r * 0.75, h * 0.12)
    kit.tube((0, 0, h * 0.32), r * 0.6, 0.004, DARK_WOOD)
    kit.tube((0, 0, h * 0.32), 0.012, h * 0.3, WOOD)
    for x, y, z in ((0, 0, 0.84), (-0.5, 0.1, 0.62), (0.5, -0.1, 0.66), (0.05, 0.5, 0.6), (0, -0.5, 0.68)):
        kit.ball((x * r, y * r, z * h), min(r * 0.5, h * 0.16), shade(GREEN, 0.8 + z * 0.4))


KITCHEN_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        mug,
        plate,
        bowl,
        glass,
        teapot,
        tray,
        frying_pan,
        cooking_pot,
        kettle,
        cutting_board,
        kitchen_knife,
        spoon,
        spatula,
        water_bottle,
        wine_bottle,
        mustard_bottle,
        bleach_bottle,
        cracker_box,
        sugar_box,
        pudding_box,
        gelatin_box,
        tomato_soup_can,
        tuna_can,
        chips_can,
        coffee_can,
        potted_meat_can,
        banana,
        apple,
        lemon,
        orange,
        sponge,
        vase,
        candle,
        watering_can,
        soap_dispenser,
        potted_plant,
    )
}
