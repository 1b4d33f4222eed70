"""Recipes of bathroom, kitchen and household fixtures and appliances.

Heights at which things are put agree with `surfaces` in catalogue.yaml (fractions of the object's height).
"""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    CREAM,
    DARK,
    DARK_WOOD,
    GLASS,
    RED,
    SCREEN,
    STEEL,
    WHITE,
    WOOD,
    YELLOW,
    Colour,
    Kit,
    Recipe,
    shade,
)

BURNERS = ((-0.23, -0.22), (-0.23, 0.22), (0.23, -0.22), (0.23, 0.22))
"""The middles of a stove's burners, as shares of its width and depth."""


def floor_lamp(kit: Kit) -> None:
    """Draw a standing lamp: foot, pole, a small tray half way up, and a shade."""
    r, h = min(kit.w, kit.d) / 2, kit.h
    kit.tube((0, 0, 0), r * 0.8, 0.03, DARK)
    kit.tube((0, 0, 0.03), 0.018, h - 0.1, DARK)
    kit.tube((0, 0, h * 0.42 - 0.02), r * 0.95, 0.02, WOOD)
    for i, part in enumerate((1.0, 0.88, 0.76, 0.64)):
        kit.tube((0, 0, h - 0.34 + i * 0.085), r * part, 0.085, shade(kit.colour, 1.0 + 0.08 * i))


def toilet(kit: Kit) -> None:
    """Draw a toilet: foot, bowl with seat and dark water, and the tank at the back."""
    w, d, h = kit.w, kit.d, kit.h
    seat = h * 0.52
    kit.box((0, -d * 0.05, 0), (w * 0.5, d * 0.6, seat * 0.75))
    kit.tube((0, d * 0.14, seat * 0.5), w * 0.46, seat * 0.4)
    kit.box((0, -d * 0.1, seat * 0.6), (w * 0.9, d * 0.3, seat * 0.3))
    kit.tube((0, d * 0.14, seat * 0.9), w * 0.5, seat * 0.1, shade(kit.colour, 0.9))
    kit.tube((0, d * 0.14, seat), w * 0.32, 0.006, (0.35, 0.45, 0.55))
    kit.box((0, -d / 2 + d * 0.14, seat * 0.9), (w, d * 0.28, h - seat * 0.9))
    kit.box((0, -d / 2 + d * 0.14, h - 0.03), (w * 1.02, d * 0.3, 0.03), shade(kit.colour, 0.88))
    kit.box((w * 0.35, -d / 2 + d * 0.29, h * 0.86), (0.07, 0.03, 0.02), STEEL)


def _basin(kit: Kit, rim: float, depth: float, thickness: float, colour: Colour | None = None) -> None:
    """Draw four walls around a hole: the inside of a tub or sink whose rim is at height `rim`."""
    w, d = kit.w, kit.d
    for side in (-1, 1):
        kit.box((side * (w - thickness) / 2, 0, rim - depth), (thickness, d, depth), colour)
        kit.box((0, side * (d - thickness) / 2, rim - depth), (w, thickness, depth), colour)


def bathtub(kit: Kit) -> None:
    """Draw a bathtub: hollow, with water, a tap at the left end and a wooden board across the right end."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.25))
    _basin(kit, h * 0.96, h * 0.71, 0.07)
    kit.box((0, 0, h * 0.25), (w - 0.14, d - 0.14, h * 0.38), (0.6, 0.82, 0.92))
    kit.box((w * 0.25, 0, h * 0.96), (w * 0.34, d, h * 0.04), WOOD)
    kit.box((-w / 2 + 0.035, 0, h * 0.96), (0.05, 0.05, 0.16), STEEL)
    kit.box((-w / 2 + 0.09, 0, h * 0.96 + 0.13), (0.14, 0.04, 0.03), STEEL)


def shower(kit: Kit) -> None:
    """Draw a shower: tray, tiled back, shower head on a pole, a glass pane's frame, a ledge."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, 0.08), WHITE)
    kit.tube((0, 0.1, 0.08), 0.05, 0.005, DARK)
    kit.box((0, -d / 2 + 0.02, 0.08), (w, 0.04, h - 0.08))
    kit.box((-w / 2 + 0.02, 0, 0.08), (0.04, d, h - 0.08), shade(kit.colour, 1.2))
    kit.rod((0.05, -d / 2 + 0.07, h * 0.7), 0.015, h * 0.5, STEEL)
    kit.box((0.05, -d / 2 + 0.15, h * 0.93), (0.03, 0.2, 0.03), STEEL)
    kit.tube((0.05, -d / 2 + 0.26, h * 0.9), 0.1, 0.03, STEEL)
    kit.box((0.05, -d / 2 + 0.06, h * 0.48), (0.12, 0.06, 0.06), STEEL)
    for z in (0.08, h - 0.03):
        kit.box((w / 2 - 0.015, 0, z), (0.03, d, 0.03), STEEL)
    kit.box((w / 2 - 0.015, d / 2 - 0.015, 0), (0.03, 0.03, h), STEEL)


def washbasin(kit: Kit) -> None:
    """Draw a washbasin on a pedestal: bowl with water, a tap, and a shelf at its left."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.12, 0), (w * 0.28, d * 0.4, h * 0.8))
    kit.box((0, 0, h * 0.78), (w, d, h * 0.13))
    _basin(kit, h, h * 0.1, 0.05)
    kit.box((0, 0, h * 0.91), (w - 0.1, d - 0.1, 0.012), (0.55, 0.75, 0.88))
    kit.box((-w * 0.34, 0, h * 0.9), (w * 0.32, d, h * 0.1))
    kit.tube((w * 0.12, -d / 2 + 0.06, h), 0.018, 0.16, STEEL)
    kit.rod((w * 0.12, -d / 2 + 0.11, h + 0.15), 0.016, 0.14, STEEL, "y")
    kit.ball((w * 0.12, -d / 2 + 0.05, h + 0.18), 0.025, STEEL)


def kitchen_sink(kit: Kit) -> None:
    """Draw a sink unit: cupboard, steel basin with water at the right, draining board at the left, a high tap."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.015, 0), (w, d - 0.03, h * 0.84))
    for side in (-1, 1):
        kit.box((side * w * 0.25, d / 2 - 0.008, 0.12), (w * 0.46, 0.016, h * 0.66), shade(kit.colour, 0.88))
        kit.box((side * 0.05, d / 2 + 0.005, h * 0.5), (0.02, 0.02, 0.1), STEEL)
    _basin(kit, h, h * 0.16, 0.07, STEEL)
    kit.box((-w * 0.27, 0, h * 0.84), (w * 0.46, d, h * 0.16), STEEL)
    kit.box((w * 0.2, 0, h * 0.84), (w * 0.5, d - 0.1, 0.05), (0.45, 0.62, 0.75))
    kit.tube((w * 0.2, -d / 2 + 0.05, h), 0.02, 0.28, WHITE)
    kit.rod((w * 0.2, -d / 2 + 0.14, h + 0.27), 0.02, 0.22, WHITE, "y")


def mirror(kit: Kit) -> None:
    """Draw a standing mirror: frame, bright glass with a glint, and a low ledge in front."""
    w, d, h = kit.w, kit.d, kit.h
    ledge = h * 0.28
    kit.box((0, -d / 2 + 0.03, ledge), (w, 0.05, h - ledge), shade(kit.colour, 0.8))
    kit.box((0, -d / 2 + 0.06, ledge + 0.06), (w - 0.12, 0.012, h - ledge - 0.12), (0.78, 0.9, 0.96))
    kit.box((-w * 0.12, -d / 2 + 0.067, ledge + 0.3), (w * 0.08, 0.006, (h - ledge) * 0.5), WHITE)
    kit.box((w * 0.04, -d / 2 + 0.067, ledge + 0.45), (w * 0.05, 0.006, (h - ledge) * 0.4), WHITE)
    kit.box((0, 0, ledge - 0.03), (w, d, 0.03))
    kit.box((0, -0.02, 0), (w * 0.9, d - 0.06, ledge - 0.03), shade(kit.colour, 0.7))


def fridge(kit: Kit) -> None:
    """Draw a fridge: a large door under a freezer door, long handles."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.02, 0.04), (w, d - 0.06, h - 0.04), shade(kit.colour, 0.85))
    kit.box((0, 0, 0), (w * 0.9, d * 0.8, 0.04), DARK)
    kit.box((0, d / 2 - 0.025, 0.06), (w - 0.01, 0.05, h * 0.6))
    kit.box((0, d / 2 - 0.025, h * 0.6 + 0.08), (w - 0.01, 0.05, h * 0.4 - 0.09))
    kit.box((-w * 0.38, d / 2 + 0.015, h * 0.25), (0.025, 0.03, h * 0.3), DARK)
    kit.box((-w * 0.38, d / 2 + 0.015, h * 0.72), (0.025, 0.03, h * 0.18), DARK)
    kit.box((w * 0.2, d / 2 + 0.003, h * 0.75), (0.09, 0.006, 0.12), YELLOW)
    kit.box((w * 0.05, d / 2 + 0.003, h * 0.85), (0.06, 0.006, 0.06), RED)


def stove(kit: Kit) -> None:
    """Draw a stove: four burners, oven window with a handle, knobs."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.01, 0), (w, d - 0.02, h - 0.02))
    kit.box((0, 0, h - 0.02), (w, d, 0.014), BLACK)
    for x, y in BURNERS:
        kit.tube((x * w, y * d, h - 0.006), 0.08 if y < 0 else 0.1, 0.006, (0.55, 0.14, 0.1))
    kit.box((0, d / 2 - 0.005, h * 0.2), (w * 0.84, 0.02, h * 0.42), BLACK)
    kit.box((0, d / 2 - 0.002, h * 0.28), (w * 0.62, 0.02, h * 0.24), (0.5, 0.3, 0.12))
    kit.box((0, d / 2 + 0.02, h * 0.66), (w * 0.8, 0.03, 0.025), STEEL)
    for i in range(5):
        kit.tube((w * (-0.36 + 0.18 * i), d / 2, h * 0.83), 0.025, 0.04, DARK, "y")


def dishwasher(kit: Kit) -> None:
    """Draw a dishwasher: a front with a dark control strip and a wide handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.02, 0), (w, d - 0.04, h - 0.03), shade(kit.colour, 0.8))
    kit.box((0, 0, h - 0.03), (w, d, 0.03), (0.42, 0.42, 0.44))
    kit.box((0, d / 2 - 0.02, 0.08), (w - 0.02, 0.03, h * 0.72))
    kit.box((0, d / 2 - 0.02, 0.1 + h * 0.72), (w - 0.02, 0.03, h * 0.13), BLACK)
    kit.box((0, d / 2 + 0.01, h * 0.7), (w * 0.7, 0.03, 0.03), STEEL)
    kit.box((w * 0.25, d / 2 - 0.003, h * 0.86), (0.12, 0.006, 0.03), (0.3, 0.8, 0.5))
    for i in range(3):
        kit.tube((w * (-0.35 + 0.1 * i), d / 2, h * 0.875), 0.012, 0.012, STEEL, "y")


def washing_machine(kit: Kit) -> None:
    """Draw a washing machine: a round glass door with a rim, drawer and dial."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.015, 0), (w, d - 0.03, h))
    kit.tube((0, d / 2 - 0.01, h * 0.45), w * 0.36, 0.04, STEEL, "y")
    kit.tube((0, d / 2, h * 0.45), w * 0.27, 0.04, (0.2, 0.3, 0.42), "y")
    kit.box((0, d / 2 - 0.012, h * 0.83), (w - 0.02, 0.02, h * 0.13), shade(kit.colour, 0.8))
    kit.box((-w * 0.3, d / 2 - 0.002, h * 0.85), (w * 0.3, 0.02, h * 0.09), WHITE)
    kit.tube((w * 0.12, d / 2, h * 0.895), 0.035, 0.04, DARK, "y")
    kit.box((w * 0.33, d / 2, h * 0.87), (0.1, 0.01, 0.04), SCREEN)


def microwave(kit: Kit) -> None:
    """Draw a microwave: dark window at the left, keypad at the right."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.01, 0), (w, d - 0.02, h))
    kit.box((-w * 0.12, d / 2 - 0.008, h * 0.14), (w * 0.66, 0.016, h * 0.72), BLACK)
    kit.box((w * 0.36, d / 2 - 0.008, h * 0.14), (w * 0.22, 0.016, h * 0.72), DARK)
    kit.box((w * 0.36, d / 2, h * 0.68), (w * 0.17, 0.006, h * 0.14), (0.3, 0.9, 0.5))
    kit.box((w * 0.22, d / 2 + 0.01, h * 0.2), (0.02, 0.02, h * 0.6), STEEL)


def coffee_machine(kit: Kit) -> None:
    """Draw a coffee machine: tower, head, drip tray and a glass jug with coffee."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.12))
    kit.box((0, -d * 0.3, h * 0.12), (w, d * 0.4, h * 0.88))
    kit.box((0, 0, h * 0.72), (w, d, h * 0.28))
    kit.tube((0, d * 0.16, h * 0.12), w * 0.34, h * 0.26, (0.28, 0.15, 0.07))
    kit.tube((0, d * 0.16, h * 0.38), w * 0.3, h * 0.16, GLASS)
    kit.tube((w * 0.25, d / 2, h * 0.86), 0.02, 0.02, RED, "y")


def toaster(kit: Kit) -> None:
    """Draw a toaster with two slots, slices of toast and a lever."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.1), DARK)
    kit.box((0, 0, h * 0.1), (w, d, h * 0.72))
    for y in (-0.2, 0.2):
        kit.box((0, y * d, h * 0.82), (w * 0.75, d * 0.16, 0.004), BLACK)
        kit.box((0, y * d, h * 0.82), (w * 0.5, d * 0.1, h * 0.18), (0.8, 0.58, 0.3))
    kit.box((w / 2 + 0.008, 0, h * 0.55), (0.02, 0.05, 0.025), BLACK)


def television(kit: Kit) -> None:
    """Draw a flat television on a foot, its screen lit in three bands."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w * 0.6, d, 0.018), DARK)
    kit.box((0, -d * 0.3, 0.018), (0.1, 0.05, h * 0.14), DARK)
    kit.box((0, -d * 0.3, h * 0.12), (w, 0.05, h * 0.88), BLACK)
    for i, colour in enumerate(((0.25, 0.5, 0.25), (0.35, 0.55, 0.75), (0.55, 0.75, 0.92))):
        kit.box((0, -d * 0.3 + 0.026, h * (0.17 + 0.26 * i)), (w * 0.94, 0.005, h * 0.26), colour)


def fireplace(kit: Kit) -> None:
    """Draw a fireplace: mantel, dark opening, logs and flames."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((side * w * 0.38, 0, 0), (w * 0.22, d * 0.94, h * 0.9))
    kit.box((0, 0, h * 0.64), (w * 0.6, d * 0.94, h * 0.26))
    kit.box((0, -d / 2 + 0.03, 0), (w * 0.6, 0.06, h * 0.66), BLACK)
    kit.box((0, 0, 0), (w * 0.56, d * 0.9, 0.04), DARK)
    kit.box((0, 0, h * 0.93), (w, d, h * 0.07), DARK_WOOD)
    kit.box((0, 0, h * 0.9), (w * 0.94, d * 0.94, h * 0.03), shade(kit.colour, 0.8))
    for y in (-0.03, 0.08):
        kit.tube((0, y, 0.09), 0.05, w * 0.42, DARK_WOOD, "x")
    for x, z, r, colour in ((-0.1, 0.22, 0.08, (0.95, 0.5, 0.1)), (0.08, 0.25, 0.09, YELLOW), (0, 0.33, 0.06, RED)):
        kit.ball((x, 0.02, z), r, colour)


def radiator(kit: Kit) -> None:
    """Draw a ribbed radiator with a valve and a top board."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.01, h * 0.14), (w * 0.94, d * 0.4, h * 0.76), shade(kit.colour, 0.75))
    ribs = 9
    for i in range(ribs):
        kit.box((w * (-0.44 + 0.88 * i / (ribs - 1)), 0, h * 0.1), (w * 0.06, d * 0.8, h * 0.84))
    kit.box((0, 0, h - 0.025), (w, d, 0.025))
    kit.rod((w * 0.47, d * 0.2, h * 0.2), 0.025, 0.09, RED, "y")
    for side in (-1, 1):
        kit.box((side * w * 0.4, 0, 0), (0.03, 0.04, h * 0.12), DARK)


def curtain(kit: Kit) -> None:
    """Draw a window with its sill and two drawn-back curtains on a rod."""
    w, d, h = kit.w, kit.d, kit.h
    sill = h * 0.44
    kit.box((0, -d / 2 + 0.01, sill), (w * 0.62, 0.02, h * 0.48), (0.62, 0.83, 0.97))
    kit.box((0, -d / 2 + 0.025, sill), (0.04, 0.01, h * 0.48), WHITE)
    kit.box((0, -d / 2 + 0.025, h * 0.68), (w * 0.62, 0.01, 0.04), WHITE)
    kit.box((0, 0, sill - 0.04), (w * 0.66, d, 0.04), CREAM)
    kit.box((0, -d * 0.2, 0), (w * 0.6, d * 0.5, sill - 0.04), shade(WHITE, 0.93))
    for side in (-1, 1):
        for i in range(3):
            x = side * w * (0.31 + 0.075 * i)
            kit.box(
                (x, 0.01, 0.03),
                (w * 0.08, d * (0.45 if i % 2 else 0.65), h * 0.92),
                shade(kit.colour, 1 - 0.14 * (i % 2)),
            )
    kit.rod((0, 0.01, h * 0.97), 0.018, w, DARK_WOOD, "x")


def bay_window(kit: Kit) -> None:
    """Draw a window in an arch of bricks, on a low wall with a deep sill."""
    w, d, h = kit.w, kit.d, kit.h
    sill = h * 0.3
    kit.box((0, -0.01, 0), (w, d - 0.02, sill - 0.04), (0.72, 0.45, 0.36))
    kit.box((0, 0, sill - 0.04), (w, d, 0.04), CREAM)
    kit.box((0, -d / 2 + 0.02, sill), (w * 0.8, 0.02, h * 0.58), (0.62, 0.83, 0.97))
    for x in (-0.2, 0.2):
        kit.box((x * w, -d / 2 + 0.04, sill), (0.04, 0.02, h * 0.58), WHITE)
    kit.box((0, -d / 2 + 0.04, sill + h * 0.3), (w * 0.8, 0.02, 0.04), WHITE)
    for side in (-1, 1):
        kit.box((side * w * 0.45, -d * 0.2, sill), (w * 0.1, d * 0.6, h * 0.52))
        kit.box((side * w * 0.36, -d * 0.2, h * 0.82), (w * 0.12, d * 0.6, h * 0.08))
        kit.box((side * w * 0.2, -d * 0.2, h * 0.88), (w * 0.26, d * 0.6, h * 0.06))
    kit.box((0, -d * 0.2, h * 0.92), (w * 0.34, d * 0.6, h * 0.08))


def bicycle(kit: Kit) -> None:
    """Draw a bicycle along x, its front wheel to the left: wheels, frame, saddle, handlebar, a crate on the carrier."""
    w, d, h = kit.w, kit.d, kit.h
    wheel = min(h * 0.31, w * 0.2)
    for side in (-1, 1):
        kit.tube((side * (w / 2 - wheel), 0, wheel), wheel, 0.04, BLACK, "y")
        kit.tube((side * (w / 2 - wheel), 0, wheel), wheel * 0.8, 0.05, STEEL, "y")
    kit.box((0, 0, wheel), (w - 2 * wheel, 0.04, 0.05))
    kit.box((-w * 0.04, 0, h * 0.68), (w * 0.44, 0.04, 0.05))
    kit.box((w * 0.16, 0, wheel), (0.04, 0.04, h * 0.86 - wheel))
    kit.box((-w * 0.25, 0, wheel), (0.05, 0.05, h * 0.96 - wheel))
    kit.rod((-w * 0.25, 0, h * 0.97), 0.02, d, BLACK, "y")
    kit.box((w * 0.16, 0, h * 0.86), (0.26, 0.16, 0.06), DARK_WOOD)
    kit.tube((0, 0, wheel * 0.9), 0.1, 0.06, DARK, "y")
    kit.box((w * 0.36, 0, h * 0.66), (w * 0.24, d * 0.75, h * 0.06), WOOD)
    for side in (-1, 1):
        kit.box((w * 0.36, side * d * 0.36, h * 0.72), (w * 0.24, 0.02, h * 0.08), WOOD)
    kit.box((w * 0.1, d * 0.2, 0), (0.03, 0.03, wheel), DARK)


FIXTURES: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        floor_lamp,
        toilet,
        bathtub,
        shower,
        washbasin,
        kitchen_sink,
        mirror,
        fridge,
        stove,
        dishwasher,
        washing_machine,
        microwave,
        coffee_machine,
        toaster,
        television,
        fireplace,
        radiator,
        curtain,
        bay_window,
        bicycle,
    )
}
