"""Recipes of furniture: things to sit and lie on, to store in and to put things on.

Heights at which things are put agree with `surfaces` in catalogue.yaml (fractions of the object's height).
"""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    CREAM,
    DARK,
    DARK_WOOD,
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


def _upholstered(kit: Kit, cushions: int) -> None:
    w, d, h = kit.w, kit.d, kit.h
    arm, back, seat = min(0.2, w * 0.16), d * 0.26, h * 0.5
    kit.box((0, 0, 0.06), (w, d, seat - 0.18), shade(kit.colour, 0.75))
    kit.box((0, -d / 2 + back / 2, 0.06), (w, back, h - 0.06))
    for side in (-1, 1):
        kit.box((side * (w - arm) / 2, 0, 0.06), (arm, d, h * 0.68), shade(kit.colour, 0.88))
    inner = (w - 2 * arm) / cushions
    for i in range(cushions):
        x = -w / 2 + arm + inner * (i + 0.5)
        kit.box((x, back / 2, seat - 0.12), (inner - 0.02, d - back, 0.12), shade(kit.colour, 1.15))
        kit.box((x, -d / 2 + back + 0.05, seat), (inner - 0.04, 0.1, h * 0.42), shade(kit.colour, 1.1))
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.06), d / 2 - 0.06, 0), (0.05, 0.05, 0.06), DARK_WOOD)


def sofa(kit: Kit) -> None:
    """Draw a sofa: base, back, two arms and seat cushions."""
    _upholstered(kit, 3)


def armchair(kit: Kit) -> None:
    """Draw an armchair: a sofa with one cushion."""
    _upholstered(kit, 1)


def dining_chair(kit: Kit) -> None:
    """Draw a wooden chair: four legs, seat, back posts with slats."""
    w, d, h = kit.w, kit.d, kit.h
    seat = h * 0.5
    kit.legs(seat, 0.045)
    kit.box((0, 0, seat - 0.05), (w, d, 0.05), shade(kit.colour, 1.25))
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.025), -d / 2 + 0.025, seat), (0.045, 0.045, h - seat))
    for level in (0.2, 0.5, 0.8):
        kit.box((0, -d / 2 + 0.025, seat + (h - seat) * level), (w - 0.08, 0.025, 0.07))


def office_chair(kit: Kit) -> None:
    """Draw an office chair: star base, gas column, seat, arms and a tall back."""
    w, d, h = kit.w, kit.d, kit.h
    seat = h * 0.5
    kit.box((0, 0, 0.03), (w * 0.9, 0.06, 0.05), BLACK)
    kit.box((0, 0, 0.03), (0.06, d * 0.9, 0.05), BLACK)
    for x, y in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        kit.ball((x * w * 0.43, y * d * 0.43, 0.035), 0.035, DARK)
    kit.tube((0, 0, 0.08), 0.035, seat - 0.14, STEEL)
    kit.box((0, 0.03, seat - 0.08), (w * 0.82, d * 0.82, 0.08))
    kit.box((0, -d / 2 + 0.04, seat + 0.05), (w * 0.78, 0.07, h - seat - 0.05))
    for side in (-1, 1):
        kit.box((side * w * 0.44, 0, seat + 0.16), (0.05, d * 0.5, 0.035), BLACK)
        kit.box((side * w * 0.44, -0.05, seat - 0.04), (0.03, 0.05, 0.2), BLACK)


def bench(kit: Kit) -> None:
    """Draw a bench: a plank with a pad on two side panels."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.05), 0, 0), (0.06, d * 0.9, h - 0.06), DARK_WOOD)
    kit.box((0, 0, h * 0.3), (w - 0.1, 0.04, 0.06), DARK_WOOD)
    kit.box((0, 0, h - 0.1), (w, d, 0.04), WOOD)
    kit.box((0, 0, h - 0.06), (w * 0.97, d * 0.94, 0.06))


def stool(kit: Kit) -> None:
    """Draw a round stool on four legs."""
    kit.legs(kit.h - 0.04, 0.04, DARK_WOOD, inset=0.04)
    kit.box((0, 0, kit.h * 0.35), (kit.w * 0.7, 0.03, 0.03), DARK_WOOD)
    kit.tube((0, 0, kit.h - 0.05), min(kit.w, kit.d) / 2, 0.05)


def bed(kit: Kit) -> None:
    """Draw a bed: headboard at the back, mattress, pillows, and a blanket over the lower half."""
    w, d, h = kit.w, kit.d, kit.h
    top = h * 0.5
    kit.box((0, -d / 2 + 0.035, 0), (w, 0.07, h), DARK_WOOD)
    kit.box((0, 0.035, 0.08), (w, d - 0.07, top * 0.4), WOOD)
    kit.box((0, 0.035, 0.08 + top * 0.4), (w - 0.04, d - 0.09, top * 0.6 - 0.1), WHITE)
    kit.box((0, d * 0.14, top - 0.15), (w, d * 0.68, 0.15))
    kit.box((0, -d * 0.2, top - 0.02), (w - 0.02, d * 0.06, 0.025), shade(kit.colour, 1.5))
    for side in (-1, 1):
        kit.box((side * w * 0.24, -d * 0.37, top - 0.03), (w * 0.4, d * 0.17, 0.11), CREAM)
        kit.box((side * (w / 2 - 0.05), d / 2 - 0.05, 0), (0.07, 0.07, 0.08), DARK_WOOD)


def _doors(kit: Kit, x: float, width: float, z: float, height: float, colour: Colour, *, hinges: int = 2) -> None:
    each = width / hinges
    for i in range(hinges):
        middle = x - width / 2 + each * (i + 0.5)
        kit.box((middle, kit.d / 2 - 0.008, z), (each - 0.025, 0.016, height), colour)
        knob = middle + (each * 0.36 if i % 2 == 0 and hinges > 1 else -each * 0.36)
        kit.box((knob, kit.d / 2 + 0.008, z + height * 0.5), (0.02, 0.025, 0.1), STEEL)


def _drawers(kit: Kit, rows: int, low: float, high: float, colour: Colour) -> None:
    each = (high - low) / rows
    for i in range(rows):
        kit.box((0, kit.d / 2 - 0.008, low + each * i + 0.012), (kit.w - 0.06, 0.016, each - 0.024), colour)
        kit.box((0, kit.d / 2 + 0.008, low + each * (i + 0.5) - 0.01), (kit.w * 0.3, 0.025, 0.022), STEEL)


def wardrobe(kit: Kit) -> None:
    """Draw a wardrobe: two doors at the right, an open column with boards at the left."""
    w, d, h = kit.w, kit.d, kit.h
    open_w = w * 0.36
    left = -w / 2
    kit.box((left + open_w + (w - open_w) / 2, 0, 0), (w - open_w, d - 0.02, h))
    kit.box((left + 0.01, 0, 0), (0.02, d, h))
    kit.box((left + open_w / 2, -d / 2 + 0.01, 0), (open_w, 0.02, h), shade(kit.colour, 0.55))
    for level in (0.0, 0.3, 0.5, 0.99):
        kit.box((left + open_w / 2, 0, h * level - (0.02 if level else 0)), (open_w, d, 0.02), shade(kit.colour, 0.9))
    kit.rod((left + open_w / 2, 0, h * 0.93), 0.012, open_w, STEEL, "x")
    kit.box((left + open_w * 0.45, 0, h * 0.66), (0.05, d * 0.7, h * 0.25), RED)
    kit.box((left + open_w * 0.65, 0, h * 0.68), (0.05, d * 0.7, h * 0.23), YELLOW)
    _doors(kit, left + open_w + (w - open_w) / 2, w - open_w, 0.06, h - 0.1, shade(kit.colour, 1.2))


def dresser(kit: Kit) -> None:
    """Draw a chest of drawers."""
    kit.box((0, 0, 0.05), (kit.w, kit.d - 0.02, kit.h - 0.05))
    kit.box((0, 0, 0), (kit.w - 0.1, kit.d - 0.1, 0.05), DARK_WOOD)
    _drawers(kit, 4, 0.07, kit.h - 0.03, shade(kit.colour, 1.3))


def _boards(kit: Kit, levels: tuple[float, ...]) -> None:
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.0125), 0, 0), (0.025, d, h))
    kit.box((0, -d / 2 + 0.01, 0), (w, 0.02, h), shade(kit.colour, 0.6))
    for level in levels:
        kit.box((0, 0, h * level - 0.025 if level else 0.0), (w, d, 0.025))


def bookshelf(kit: Kit) -> None:
    """Draw a bookshelf: boards at 0.03, 0.3, 0.55 and 0.79 of its height, books on the top and bottom ones."""
    w, d, h = kit.w, kit.d, kit.h
    _boards(kit, (0.0, 0.3, 0.55, 0.79, 1.0))
    rows: tuple[tuple[float, float, float, Colour], ...] = (
        (0.79, -0.34, 0.14, RED),
        (0.79, -0.19, 0.12, (0.2, 0.35, 0.6)),
        (0.79, -0.04, 0.16, (0.85, 0.75, 0.5)),
        (0.79, 0.2, 0.2, (0.2, 0.45, 0.3)),
        (0.03, -0.25, 0.4, (0.45, 0.3, 0.5)),
        (0.03, 0.22, 0.36, (0.75, 0.5, 0.25)),
    )
    for level, x, share, colour in rows:
        kit.box((x * w, -0.02, h * level), (share * w, d * 0.7, h * 0.155), colour)


def storage_shelf(kit: Kit) -> None:
    """Draw an open metal shelf with storage boxes at the bottom and top."""
    w, d, h = kit.w, kit.d, kit.h
    kit.legs(h, 0.035, DARK)
    for level in (0.08, 0.36, 0.64, 0.92):
        kit.box((0, 0, h * level - 0.02), (w, d, 0.02))
    kit.box((-w * 0.24, 0, h * 0.08), (w * 0.42, d * 0.85, h * 0.2), (0.75, 0.6, 0.4))
    kit.box((w * 0.24, 0, h * 0.08), (w * 0.38, d * 0.8, h * 0.16), (0.3, 0.5, 0.65))
    kit.box((0, 0, h * 0.92), (w * 0.4, d * 0.8, h * 0.08), (0.75, 0.6, 0.4))


def kitchen_cabinet(kit: Kit) -> None:
    """Draw a kitchen cupboard: two doors under a thin top."""
    kit.box((0, 0, 0), (kit.w - 0.04, kit.d - 0.04, 0.08), DARK)
    kit.box((0, -0.01, 0.08), (kit.w, kit.d - 0.02, kit.h - 0.11))
    kit.box((0, 0, kit.h - 0.03), (kit.w, kit.d, 0.03), WOOD)
    _doors(kit, 0, kit.w, 0.1, kit.h - 0.16, shade(kit.colour, 0.88))


def bathroom_cabinet(kit: Kit) -> None:
    """Draw a small white cabinet on feet: a drawer over a door."""
    kit.legs(0.1, 0.03, STEEL, inset=0.02)
    kit.box((0, -0.01, 0.1), (kit.w, kit.d - 0.02, kit.h - 0.1))
    _doors(kit, 0, kit.w, 0.13, (kit.h - 0.1) * 0.62, shade(kit.colour, 0.86), hinges=1)
    kit.box((0, kit.d / 2 - 0.008, kit.h * 0.78), (kit.w - 0.05, 0.016, kit.h * 0.17), shade(kit.colour, 0.86))
    kit.box((0, kit.d / 2 + 0.008, kit.h * 0.86), (0.12, 0.02, 0.02), STEEL)


def shoe_rack(kit: Kit) -> None:
    """Draw a slatted rack with two boards and a few shoes on the lower one."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.015), 0, 0), (0.03, d, h), DARK_WOOD)
    for level in (0.3, 1.0):
        kit.box((0, 0, h * level - 0.025), (w, d, 0.025))
    for i, colour in enumerate((BLACK, RED, (0.3, 0.4, 0.7))):
        for step in (-0.05, 0.05):
            kit.box((w * (-0.3 + 0.3 * i) + step, 0, h * 0.3), (0.08, d * 0.8, 0.08), colour)


def nightstand(kit: Kit) -> None:
    """Draw a bedside table with two drawers on short legs."""
    kit.legs(0.12, 0.035, DARK_WOOD, inset=0.02)
    kit.box((0, -0.01, 0.12), (kit.w, kit.d - 0.02, kit.h - 0.12))
    _drawers(kit, 2, 0.14, kit.h - 0.02, shade(kit.colour, 1.3))


def desk(kit: Kit) -> None:
    """Draw a writing desk: top, drawers at the right, legs at the left."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h - 0.035), (w, d, 0.035), shade(kit.colour, 1.2))
    kit.box((w / 2 - 0.2, 0, 0), (0.38, d - 0.06, h - 0.035))
    for i in range(3):
        z = 0.06 + i * (h - 0.1) / 3
        kit.box((w / 2 - 0.2, d / 2 - 0.03, z), (0.33, 0.02, (h - 0.1) / 3 - 0.03), shade(kit.colour, 1.35))
        kit.box((w / 2 - 0.2, d / 2 - 0.015, z + (h - 0.1) / 6 - 0.02), (0.12, 0.02, 0.02), STEEL)
    for y in (-1, 1):
        kit.box((-w / 2 + 0.04, y * (d / 2 - 0.04), 0), (0.05, 0.05, h - 0.035), DARK)
    kit.box((-w / 2 + 0.04, 0, 0.1), (0.03, d - 0.1, 0.03), DARK)


def _table(kit: Kit, leg: float, *, shelf: bool = False) -> None:
    kit.legs(kit.h - 0.04, leg, shade(kit.colour, 0.75), inset=0.02)
    kit.box((0, 0, kit.h - 0.04), (kit.w, kit.d, 0.04))
    kit.box((0, 0, kit.h - 0.1), (kit.w - 0.12, kit.d - 0.12, 0.06), shade(kit.colour, 0.85))
    if shelf:
        kit.box((0, 0, kit.h * 0.3), (kit.w - 0.08, kit.d - 0.08, 0.025), shade(kit.colour, 0.85))


def coffee_table(kit: Kit) -> None:
    """Draw a low table with a shelf under its top."""
    _table(kit, 0.05, shelf=True)


def dining_table(kit: Kit) -> None:
    """Draw a table on four strong legs."""
    _table(kit, 0.08)


def side_table(kit: Kit) -> None:
    """Draw a small round table on one foot."""
    kit.tube((0, 0, 0), min(kit.w, kit.d) * 0.34, 0.03, DARK)
    kit.tube((0, 0, 0.03), 0.03, kit.h - 0.06, DARK)
    kit.tube((0, 0, kit.h - 0.03), min(kit.w, kit.d) / 2, 0.03)


def kitchen_counter(kit: Kit) -> None:
    """Draw a base unit: plinth, drawer and doors under a stone worktop."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -0.03, 0), (w, d - 0.08, 0.1), DARK)
    kit.box((0, -0.015, 0.1), (w, d - 0.03, h - 0.14))
    kit.box((0, 0, h - 0.04), (w, d, 0.04), (0.42, 0.42, 0.44))
    _doors(kit, 0, w, 0.13, h * 0.6, shade(kit.colour, 0.9))
    kit.box((0, d / 2 - 0.008, h * 0.78), (w - 0.05, 0.016, h * 0.14), shade(kit.colour, 0.9))
    kit.box((0, d / 2 + 0.008, h * 0.84), (w * 0.4, 0.02, 0.02), STEEL)


def tv_stand(kit: Kit) -> None:
    """Draw a long low board with an open middle and two doors."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h - 0.03), (w, d, 0.03))
    kit.box((0, 0, 0.05), (w, d, 0.03))
    kit.box((0, -d / 2 + 0.01, 0.05), (w, 0.02, h - 0.05), shade(kit.colour, 0.6))
    for side in (-1, 1):
        kit.box((side * w * 0.34, 0, 0.05), (w * 0.32, d - 0.02, h - 0.06), shade(kit.colour, 1.2))
        kit.box((side * w * 0.22, d / 2, h * 0.45), (0.02, 0.02, 0.12), STEEL)
    kit.box((0, 0.02, 0.08), (w * 0.24, d * 0.6, 0.06), BLACK)
    kit.box((0, 0, 0), (w * 0.9, d * 0.7, 0.05), DARK)


def workbench(kit: Kit) -> None:
    """Draw a workbench: thick top, tool board at the back, a red vice."""
    w, d, h = kit.w, kit.d, kit.h
    top = h * 0.62
    kit.legs(top - 0.07, 0.09, DARK_WOOD)
    kit.box((0, 0, top * 0.2), (w - 0.1, d - 0.1, 0.03), DARK_WOOD)
    kit.box((0, 0, top - 0.07), (w, d, 0.07))
    kit.box((0, -d / 2 + 0.015, top), (w, 0.03, h - top), shade(kit.colour, 0.6))
    kit.box((-w * 0.3, -d / 2 + 0.04, top + 0.15), (0.03, 0.02, 0.25), YELLOW)
    kit.box((-w * 0.3, -d / 2 + 0.045, top + 0.36), (0.14, 0.03, 0.05), STEEL)
    kit.box((-w * 0.08, -d / 2 + 0.04, top + 0.14), (0.06, 0.02, 0.28), RED)
    kit.box((w * 0.12, -d / 2 + 0.04, top + 0.2), (0.24, 0.02, 0.12), STEEL)
    kit.box((w * 0.34, -d / 2 + 0.04, top + 0.14), (0.03, 0.02, 0.28), BLACK)
    kit.box((w * 0.42, d / 2 - 0.09, top), (0.12, 0.16, 0.13), RED)


def rug(kit: Kit) -> None:
    """Draw a flat rug with a border and a field."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.6), shade(kit.colour, 0.6))
    kit.box((0, 0, 0), (kit.w - 0.12, kit.d - 0.12, kit.h * 0.8))
    kit.box((0, 0, 0), (kit.w * 0.55, kit.d * 0.55, kit.h), shade(kit.colour, 1.35))


def piano(kit: Kit) -> None:
    """Draw an upright piano: body, keyboard with black keys, and pedals."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.2, 0), (w, d * 0.6, h))
    kit.box((0, d * 0.28, h * 0.5), (w, d * 0.44, h * 0.08))
    kit.box((0, d * 0.3, h * 0.58), (w * 0.88, d * 0.34, 0.025), WHITE)
    for i in range(7):
        kit.box((w * (-0.37 + 0.123 * i), d * 0.26, h * 0.58 + 0.025), (w * 0.04, d * 0.2, 0.015), BLACK)
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.04), d * 0.42, 0), (0.07, 0.08, h * 0.5))
    kit.box((0, d * 0.1, h * 0.7), (w * 0.4, 0.02, h * 0.2), CREAM)
    kit.box((0, d * 0.13, 0.04), (0.2, 0.1, 0.02), YELLOW)


def treadmill(kit: Kit) -> None:
    """Draw a treadmill: deck with a black belt, two posts, handles and a console."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.11))
    kit.box((0, 0.05, h * 0.11), (w * 0.72, d * 0.88, 0.012), BLACK)
    kit.box((0, -d / 2 + 0.14, 0), (w, 0.28, h * 0.17), DARK)
    for side in (-1, 1):
        kit.box((side * (w / 2 - 0.04), -d / 2 + 0.2, 0), (0.06, 0.08, h * 0.92), STEEL)
        kit.rod((side * (w / 2 - 0.04), -d / 2 + 0.4, h * 0.72), 0.025, 0.5, BLACK, "y")
    kit.box((0, -d / 2 + 0.2, h * 0.76), (w, 0.1, h * 0.24), DARK, tilt=0.3)
    kit.box((0, -d / 2 + 0.25, h * 0.83), (w * 0.55, 0.06, h * 0.13), SCREEN, tilt=0.3)


FURNITURE: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        sofa,
        armchair,
        dining_chair,
        office_chair,
        bench,
        stool,
        bed,
        wardrobe,
        dresser,
        bookshelf,
        storage_shelf,
        kitchen_cabinet,
        bathroom_cabinet,
        shoe_rack,
        nightstand,
        desk,
        coffee_table,
        dining_table,
        side_table,
        kitchen_counter,
        tv_stand,
        workbench,
        rug,
        piano,
        treadmill,
    )
}
