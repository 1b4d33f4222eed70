"""Recipes of tools and of what is worked with: in the workshop, for cleaning, for writing and at the computer."""

from __future__ import annotations

from coopera.simulation.shapes.kit import (
    BLACK,
    BLUE,
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


def hammer(kit: Kit) -> None:
    """Draw a hammer lying: a steel head across at the left, and a handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.42, 0, 0), (w * 0.14, d, h), STEEL)
    kit.box((-w * 0.42, d * 0.4, 0), (w * 0.17, d * 0.2, h * 1.05), DARK)
    kit.rod((w * 0.07, 0, h / 2), h * 0.38, w * 0.86, WOOD, "x")


def screwdriver(kit: Kit) -> None:
    """Draw a screwdriver: a steel shaft and a thick coloured handle towards the right."""
    r = kit.h / 2
    kit.rod((-kit.w * 0.2, 0, r), r * 0.3, kit.w * 0.6, STEEL, "x")
    kit.rod((kit.w * 0.28, 0, r), r, kit.w * 0.44, axis="x")
    kit.tube((kit.w * 0.08, 0, r), r * 0.7, kit.w * 0.06, BLACK, "x")


def pliers(kit: Kit) -> None:
    """Draw pliers: jaws, a pivot and two coloured handles."""
    w, d, h = kit.w, kit.d, kit.h
    for side in (-1, 1):
        kit.box((-w * 0.36, side * d * 0.13, 0), (w * 0.28, d * 0.2, h), STEEL)
        kit.rod((w * 0.18, side * d * 0.34, h / 2), h * 0.45, w * 0.64, axis="x")
        kit.rod((-w * 0.14, side * d * 0.2, h / 2), h * 0.4, w * 0.16, STEEL, "x")
    kit.tube((-w * 0.2, 0, 0), d * 0.22, h * 1.1, DARK)


def drill(kit: Kit) -> None:
    """Draw a drill standing on its battery: bit to the left, motor, grip."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((-w * 0.4, 0, h * 0.8), 0.006, w * 0.24, STEEL, "x")
    kit.tube((-w * 0.24, 0, h * 0.8), d * 0.28, w * 0.14, BLACK, "x")
    kit.tube((w * 0.12, 0, h * 0.8), min(d * 0.48, h * 0.2), w * 0.6, axis="x")
    kit.box((w * 0.18, 0, h * 0.2), (w * 0.22, d * 0.5, h * 0.5), BLACK)
    kit.box((w * 0.14, 0, 0), (w * 0.44, d * 0.9, h * 0.22))


def saw(kit: Kit) -> None:
    """Draw a saw lying: a long toothed blade and a grip with a hole."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.14, 0, 0), (w * 0.72, d * 0.7, h * 0.3), STEEL)
    for i in range(6):
        kit.box((w * (-0.44 + 0.11 * i), d * 0.37, 0), (w * 0.05, d * 0.08, h * 0.3), shade(STEEL, 0.7))
    kit.box((w * 0.36, 0, 0), (w * 0.28, d, h))
    kit.box((w * 0.38, 0, h), (w * 0.12, d * 0.4, 0.001), PAPER)


def tape(kit: Kit) -> None:
    """Draw a roll lying flat: tape, thread or a measure, with its loose end."""
    r, h = min(kit.w, kit.d) / 2, kit.h
    kit.tube((0, 0, 0), r, h)
    kit.tube((0, 0, h), r * 0.5, 0.002, CREAM)
    kit.tube((0, 0, h), r * 0.3, 0.004, DARK)
    kit.box((kit.w * 0.3, r - 0.003, 0), (kit.w * 0.4, 0.004, h), shade(kit.colour, 0.75))


def small_heap(kit: Kit) -> None:
    """Draw a low heap: soil, dust, nails or beans."""
    w, d, h = kit.w, kit.d, kit.h
    kit.tube((0, 0, 0), min(w, d) * 0.48, h * 0.3, shade(kit.colour, 0.85))
    kit.tube((0, 0, h * 0.3), min(w, d) * 0.32, h * 0.3)
    kit.tube((0, 0, h * 0.6), min(w, d) * 0.16, h * 0.3)
    for x, y in ((-0.42, 0.2), (0.4, -0.24), (0.3, 0.4), (-0.3, -0.4), (0.46, 0.12), (-0.1, 0.46)):
        kit.ball((x * w, y * d, h * 0.12), h * 0.14, shade(kit.colour, 0.7))


def level(kit: Kit) -> None:
    """Draw a long bar with a window: a spirit level or a ruler."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    kit.box((0, 0, h), (w * 0.12, d * 0.5, 0.002), GREEN)
    for i in range(9):
        kit.box((w * (-0.44 + 0.11 * i), d * 0.36, h), (w * 0.008, d * 0.28, 0.001), BLACK)


def light_bulb(kit: Kit) -> None:
    """Draw a light bulb standing on its thread."""
    r = kit.w / 2
    kit.tube((0, 0, 0), r * 0.45, kit.h * 0.28, STEEL)
    kit.tube((0, 0, kit.h * 0.28), r * 0.6, kit.h * 0.16)
    kit.ball((0, 0, kit.h - r), r)


def paint_brush(kit: Kit) -> None:
    """Draw a brush: bristles at the left, a metal band and a handle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((-w * 0.4, 0, 0), (w * 0.2, d, h), (0.85, 0.75, 0.5))
    kit.box((-w * 0.25, 0, 0), (w * 0.1, d, h * 1.05), STEEL)
    kit.rod((w * 0.15, 0, h / 2), h * 0.42, w * 0.7, axis="x")


def scrub_brush(kit: Kit) -> None:
    """Draw a brush with a wooden back and bristles below."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h * 0.55), (w, d, h * 0.45))
    for x in (-0.36, -0.12, 0.12, 0.36):
        kit.box((x * w, 0, 0), (w * 0.17, d * 0.85, h * 0.55), CREAM)


def trowel(kit: Kit) -> None:
    """Draw a small shovel: a blade that narrows to the left, and a grip."""
    w, d, h = kit.w, kit.d, kit.h
    for x, part in ((-0.42, 0.5), (-0.32, 0.85), (-0.18, 1.0)):
        kit.box((x * w, 0, 0), (w * 0.16, d * part, h * 0.3), STEEL)
    kit.rod((0, 0, h * 0.4), h * 0.2, w * 0.3, STEEL, "x")
    kit.rod((w * 0.32, 0, h * 0.5), h * 0.5, w * 0.36, axis="x")


def iron(kit: Kit) -> None:
    """Draw an iron: a steel sole that narrows to the front, body and grip."""
    w, d, h = kit.w, kit.d, kit.h
    for y, part in ((-0.22, 1.0), (0.14, 0.8), (0.38, 0.45)):
        kit.box((0, y * d, 0), (w * part, d * 0.36, h * 0.12), STEEL)
        kit.box((0, y * d * 0.95, h * 0.12), (w * part * 0.9, d * 0.34, h * 0.3))
    kit.box((0, -d * 0.1, h * 0.85), (w * 0.35, d * 0.7, h * 0.15), DARK)
    for y in (-0.4, 0.2):
        kit.box((0, y * d, h * 0.4), (w * 0.3, d * 0.1, h * 0.48), DARK)


def ironing_board(kit: Kit) -> None:
    """Draw an ironing board standing: a long cover on crossed legs."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((w * 0.05, 0, h - 0.04), (w * 0.9, d, 0.04))
    kit.box((-w * 0.44, 0, h - 0.04), (w * 0.12, d * 0.6, 0.04))
    for x in (-0.28, 0.28):
        kit.box((x * w, 0, 0), (0.03, d * 0.8, 0.03), STEEL)
        kit.tube((x * w, 0, 0), 0.014, h - 0.04, STEEL)


def clothes_hanger(kit: Kit) -> None:
    """Draw a hanger lying: shoulders, a bar and a hook."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((0, d * 0.4, h / 2), h * 0.5, w, axis="x")
    for side in (-1, 1):
        kit.box((side * w * 0.25, d * 0.18, 0), (w * 0.5, d * 0.14, h))
        kit.box((side * w * 0.1, d * 0.02, 0), (w * 0.22, d * 0.14, h))
    kit.rod((0, -d * 0.2, h / 2), h * 0.3, d * 0.4, STEEL, "y")
    kit.rod((w * 0.04, -d * 0.4, h / 2), h * 0.3, w * 0.12, STEEL, "x")


def peg(kit: Kit) -> None:
    """Draw clothes pegs: pairs of wooden halves with a spring."""
    w, d, h = kit.w, kit.d, kit.h
    for x in (-0.3, 0.0, 0.3):
        for z in (0.0, 0.55):
            kit.box((x * w, 0, z * h), (w * 0.2, d, h * 0.4))
        kit.box((x * w, -d * 0.1, 0), (w * 0.22, d * 0.12, h), STEEL)


def yarn(kit: Kit) -> None:
    """Draw a ball of wool with its windings and a loose end."""
    r = kit.h / 2
    kit.ball((0, 0, r), r)
    kit.tube((0, 0, r * 0.85), r * 1.02, r * 0.3, shade(kit.colour, 1.3))
    kit.tube((0, 0, r), r * 1.02, r * 0.3, shade(kit.colour, 0.8), "x")
    kit.rod((0, r, 0.004), 0.003, kit.w, axis="x")


def reel(kit: Kit) -> None:
    """Draw a reel of thread standing."""
    r, h = kit.w / 2, kit.h
    for z in (0.0, 0.85):
        kit.tube((0, 0, z * h), r, h * 0.15, WOOD)
    kit.tube((0, 0, h * 0.15), r * 0.8, h * 0.7)
    kit.rod((r * 0.6, r * 0.8, h * 0.3), 0.003, r, axis="x")


def needle(kit: Kit) -> None:
    """Draw two long needles side by side, a knob at the right of each."""
    for y in (-0.3, 0.3):
        kit.rod((0, y * kit.d, kit.h / 2), kit.h * 0.3, kit.w * 0.96, axis="x")
        kit.ball((kit.w * 0.48, y * kit.d, kit.h / 2), kit.h * 0.5, RED)


def sheet(kit: Kit) -> None:
    """Draw a sheet of paper with a headline and lines of writing."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    kit.box((-w * 0.1, -d * 0.38, h), (w * 0.6, d * 0.08, 0.001), DARK)
    for i in range(6):
        kit.box((-w * 0.03 * (i % 2), d * (-0.22 + 0.11 * i), h), (w * (0.78 - 0.06 * (i % 2)), d * 0.025, 0.001), BLUE)


def card(kit: Kit) -> None:
    """Draw a card with a picture and a line of writing."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    kit.box((-w * 0.22, 0, h), (w * 0.4, d * 0.7, 0.001), (0.45, 0.65, 0.85))
    kit.box((-w * 0.22, d * 0.2, h), (w * 0.4, d * 0.3, 0.0015), GREEN)
    for y in (-0.2, 0.0, 0.2):
        kit.box((w * 0.24, y * d, h), (w * 0.36, d * 0.05, 0.001), DARK)


def envelope(kit: Kit) -> None:
    """Draw an envelope with a flap, an address and a stamp."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    for y in (0.06, 0.16, 0.26):
        kit.box((w * 0.08, y * d, h), (w * 0.4, d * 0.03, 0.001), DARK)
    kit.box((w * 0.36, -d * 0.3, h), (w * 0.16, d * 0.24, 0.001), RED)
    kit.box((0, -d * 0.46, h), (w, d * 0.06, 0.001), shade(kit.colour, 0.75))


def disc(kit: Kit) -> None:
    """Draw a disc on its sleeve: a record or a film."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.5))
    kit.tube((w * 0.08, 0, h * 0.5), min(w, d) * 0.46, h * 0.4, BLACK)
    kit.tube((w * 0.08, 0, h * 0.9), min(w, d) * 0.16, 0.001, RED)
    kit.tube((w * 0.08, 0, h * 0.9), min(w, d) * 0.02, 0.002, WHITE)


def keyboard(kit: Kit) -> None:
    """Draw a keyboard with four rows of keys and a space bar."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.6))
    for i in range(4):
        for x, wide in ((-0.2, 0.5), (0.28, 0.36)):
            kit.box((x * w, d * (-0.34 + 0.19 * i), h * 0.6), (w * wide, d * 0.14, h * 0.4), shade(kit.colour, 1.4))
    kit.box((-w * 0.05, d * 0.4, h * 0.6), (w * 0.4, d * 0.13, h * 0.4), shade(kit.colour, 1.6))


def computer_mouse(kit: Kit) -> None:
    """Draw a computer mouse with a wheel and its cable."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((0, 0, h * 0.45), min(h * 0.45, w / 2), d, axis="y")
    kit.box((0, 0, 0), (w, d * 0.7, h * 0.45))
    kit.tube((0, -d * 0.25, h * 0.85), h * 0.16, w * 0.12, RED, "x")
    kit.rod((0, -d * 0.7, 0.004), 0.003, d * 0.5, BLACK, "y")


def cable(kit: Kit) -> None:
    """Draw a cable lying in loops, with a plug: also a leash, laces or a belt."""
    r, t = min(kit.w, kit.d) / 2, max(kit.h * 0.4, 0.004)
    for i in range(3):
        x, turn = 0.08 * r * (i - 1), 0.92 - 0.14 * i
        for side in (-1, 1):
            kit.rod((x, side * r * turn, t * (1 + i * 0.5)), t, r * 1.3, axis="x")
            kit.rod((x + side * r * turn, 0, t * (1 + i * 0.5)), t, r * 1.3, axis="y")
    kit.box((kit.w * 0.42, kit.d * 0.3, 0), (kit.w * 0.16, kit.d * 0.14, kit.h), DARK)


def speaker(kit: Kit) -> None:
    """Draw a loudspeaker: two round cones in a box."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h))
    for z, part in ((0.3, 0.4), (0.76, 0.22)):
        kit.tube((0, d / 2, h * z), w * part, 0.01, BLACK, "y")
        kit.tube((0, d / 2 + 0.006, h * z), w * part * 0.5, 0.01, STEEL, "y")


def microphone(kit: Kit) -> None:
    """Draw a microphone lying: a round mesh head and a grip."""
    r = kit.h / 2
    kit.ball((-kit.w / 2 + r, 0, r), r, STEEL)
    kit.tube((-kit.w / 2 + 1.8 * r, 0, r), r * 0.9, r * 0.3, BLACK, "x")
    kit.rod((r, 0, r), r * 0.6, kit.w - 2 * r, axis="x")


def desk_lamp(kit: Kit) -> None:
    """Draw a small lamp: foot, stem and a lit shade."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r * 0.7, h * 0.06, DARK)
    kit.tube((0, 0, h * 0.06), 0.009, h * 0.6, STEEL)
    for z, part in ((0.62, 1.0), (0.74, 0.85), (0.86, 0.7)):
        kit.tube((0, 0, h * z), r * part, h * 0.13, kit.colour)
    kit.ball((0, 0, h * 0.62), r * 0.35, YELLOW)


def tripod(kit: Kit) -> None:
    """Draw a stand on three legs with a flat top: for a camera, notes or a canvas."""
    w, d, h = kit.w, kit.d, kit.h
    kit.tube((0, 0, h * 0.3), 0.014, h * 0.5, DARK)
    for x, y in ((-0.4, 0.3), (0.4, 0.3), (0.0, -0.42)):
        kit.rod((x * w * 0.5, y * d * 0.5, 0.03), 0.011, w * 0.5, DARK, "x" if y > 0 else "y")
        kit.tube((x * w * 0.5, y * d * 0.5, 0), 0.011, h * 0.35, DARK)
    kit.box((0, 0, h * 0.66), (w * 0.9, 0.02, h * 0.34), tilt=0.25)
    kit.box((0, d * 0.08, h * 0.64), (w * 0.9, d * 0.1, 0.015), DARK_WOOD)


WORKSHOP_THINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        *(hammer, screwdriver, pliers, drill, saw, tape, small_heap, level, light_bulb, paint_brush, scrub_brush),
        *(trowel, iron, ironing_board, clothes_hanger, peg, yarn, reel, needle, sheet, card, envelope, disc, keyboard),
        *(computer_mouse, cable, speaker, microphone, desk_lamp, tripod),
    )
}
