"""Recipes of what is seen of a motion besides what is in hand: a laid place, an open book, a cat at its bowl."""

from __future__ import annotations

import itertools
import math

from coopera.simulation.shapes.kit import BLACK, BLUE, CREAM, DARK, GREEN, RED, STEEL, WHITE, YELLOW, Kit, Recipe, shade

_ORANGE = (0.93, 0.5, 0.14)


def place_setting(kit: Kit) -> None:
    """Draw a place laid at a table: mat, plate, knife and spoon at the right, fork at the left, napkin and glass."""
    w, d, h = kit.w, kit.d, kit.h
    place_mat(kit)
    kit.tube((0, 0, 0.006), d * 0.33, 0.012, WHITE)
    kit.tube((0, 0, 0.018), d * 0.24, 0.003, shade(BLUE, 1.6))
    for x, wide in ((-0.36, 0.05), (0.34, 0.035), (0.42, 0.05)):
        kit.box((x * w, -d * 0.1, 0.006), (0.016, d * 0.62, 0.006), STEEL)
        kit.box((x * w, d * 0.24, 0.006), (w * wide, d * 0.2, 0.006), STEEL)
    for k, part in enumerate((0.5, 0.42, 0.5)):
        kit.tube((w * 0.36, d * 0.42, 0.006 + k * h * 0.33), h * 0.26 * part * 2, h * 0.33, (0.72, 0.87, 0.95))


def place_mat(kit: Kit) -> None:
    """Draw a mat with a border, to lay a place on."""
    kit.box((0, 0, 0), (kit.w, kit.d, 0.003))
    kit.box((0, 0, 0.003), (kit.w * 0.94, kit.d * 0.92, 0.001), shade(kit.colour, 1.35))


def plant_stand(kit: Kit) -> None:
    """Draw a slim stand for a plant: three levels on four legs."""
    kit.legs(kit.h, 0.03, shade(kit.colour, 0.7))
    for share in (0.15, 0.55, 0.97):
        kit.box((0, 0, kit.h * share), (kit.w, kit.d, kit.h * 0.03))


def cat(kit: Kit) -> None:
    """Draw a cat that stands with its head low before it (+y), and its tail up."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((0, -d * 0.08, h * 0.46), w * 0.36, d * 0.62, axis="y")
    for y in (-0.28, -0.1, 0.06):
        kit.rod((0, y * d, h * 0.48), w * 0.365, w * 0.74, shade(kit.colour, 0.7), "x")
    for x in (-0.22, 0.22):
        for y in (-0.28, 0.14):
            kit.rod((x * w, y * d, h * 0.18), w * 0.11, h * 0.36)
    kit.ball((0, d * 0.32, h * 0.5), w * 0.4)
    kit.ball((0, d * 0.42, h * 0.45), w * 0.22, CREAM)
    for x in (-1, 1):
        kit.rod((x * w * 0.24, d * 0.3, h * 0.72), w * 0.1, h * 0.2)
        kit.ball((x * w * 0.17, d * 0.41, h * 0.57), w * 0.07, BLACK)
    kit.rod((0, -d * 0.42, h * 0.74), w * 0.09, h * 0.56)


def dog(kit: Kit) -> None:
    """Draw a dog that stands: long muzzle (+y), hanging ears, collar and a raised tail."""
    w, d, h = kit.w, kit.d, kit.h
    kit.rod((0, -d * 0.08, h * 0.5), w * 0.36, d * 0.66, axis="y")
    for x in (-0.22, 0.22):
        for y in (-0.3, 0.14):
            kit.rod((x * w, y * d, h * 0.22), w * 0.12, h * 0.44)
    kit.tube((0, d * 0.2, h * 0.64), w * 0.28, 0.03, RED)
    kit.ball((0, d * 0.3, h * 0.76), w * 0.36)
    kit.rod((0, d * 0.42, h * 0.7), w * 0.18, d * 0.2, WHITE, "y")
    kit.ball((0, d * 0.49, h * 0.74), w * 0.1, BLACK)
    for x in (-1, 1):
        kit.rod((x * w * 0.38, d * 0.26, h * 0.7), w * 0.12, h * 0.3, shade(kit.colour, 0.5))
        kit.ball((x * w * 0.16, d * 0.4, h * 0.84), w * 0.07, BLACK)
    kit.rod((0, -d * 0.44, h * 0.72), w * 0.08, h * 0.4)


def full_bowl(kit: Kit) -> None:
    """Draw a pet's bowl, heaped with food."""
    r, h = kit.w / 2, kit.h
    kit.tube((0, 0, 0), r, h * 0.6)
    kit.tube((0, 0, h * 0.6), r * 0.88, h * 0.08, shade(kit.colour, 0.6))
    for x, y, part in ((0, 0, 1.0), (0.4, 0.2, 0.7), (-0.4, 0.25, 0.7), (0.1, -0.45, 0.7), (-0.35, -0.3, 0.6)):
        kit.ball((x * r, y * r, h * 0.62), r * 0.36 * part, (0.5, 0.3, 0.14))


def falling_food(kit: Kit) -> None:
    """Draw dry food that falls out of a bag."""
    for k in range(9):
        kit.ball((kit.w * (0.35 * (k % 3) - 0.35), kit.d * (0.3 * (k % 2) - 0.15), kit.h * (0.1 + 0.1 * k)), 0.014)


def spread_blanket(kit: Kit) -> None:
    """Draw a blanket that is spread, with folds, and a turned-down end (-x)."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.5))
    for k, x in enumerate((-0.3, -0.1, 0.12, 0.34)):
        kit.rod((x * w, 0, h * 0.4), h * (0.45 + 0.1 * (k % 2)), d, shade(kit.colour, 1.0 + 0.12 * (k % 2)), "y")
        kit.box((x * w + 0.07, 0, h * 0.5), (w * 0.05, d, 0.003), CREAM)
    kit.box((-w * 0.44, 0, 0), (w * 0.12, d, h), WHITE)


def foam(kit: Kit) -> None:
    """Draw white foam in a heap of bubbles."""
    w, d, h = kit.w, kit.d, kit.h
    for k in range(15):
        angle, away = 2.4 * k, 0.12 * math.sqrt(k)
        at = (away * w * math.cos(angle), away * d * math.sin(angle), h * 0.25 * (1.0 + (k % 3)) * (1.0 - away))
        kit.ball(at, h * (0.26 + 0.07 * (k % 4)), WHITE if k % 3 else (0.86, 0.94, 1.0))


def dish_rack(kit: Kit) -> None:
    """Draw a rack with plates on edge in it, and a mug."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.08), STEEL)
    for side in (-1, 1):
        kit.rod((0, side * d * 0.48, h * 0.4), 0.006, w, STEEL, "x")
        for x in (-0.48, 0.48):
            kit.tube((x * w, side * d * 0.48, 0), 0.005, h * 0.4, STEEL)
    for k, x in enumerate((-0.36, -0.2, -0.04, 0.12)):
        kit.tube((x * w, 0, h * 0.52), min(d, h) * 0.46, 0.012, WHITE if k % 2 else (0.75, 0.86, 0.95), "x")
    kit.tube((w * 0.34, 0, h * 0.08), w * 0.1, h * 0.4, RED)


def dishes(kit: Kit) -> None:
    """Draw a pile of plates with a bowl on top, and foam on it."""
    r, h = kit.w / 2, kit.h
    for k in range(5):
        kit.tube((0.01 * (k % 2), 0, h * 0.1 * k), r * 0.55, h * 0.05, WHITE)
        kit.tube((0.01 * (k % 2), 0, h * (0.05 + 0.1 * k)), r, h * 0.05, (0.62, 0.76, 0.88) if k % 2 else CREAM)
    kit.tube((0, 0, h * 0.5), r * 0.5, h * 0.2, BLUE)
    kit.tube((0, 0, h * 0.7), r * 0.7, h * 0.25, BLUE)
    kit.tube((0, 0, h * 0.95), r * 0.6, 0.002, shade(BLUE, 0.45))
    for x, y in ((0.6, 0.3), (-0.5, 0.5), (0.2, -0.7)):
        kit.ball((x * r, y * r, h * 0.52), h * 0.14, WHITE)


def sliced_food(kit: Kit) -> None:
    """Draw slices of a carrot and of a cucumber, and the rest of both."""
    w, d, h = kit.w, kit.d, kit.h
    for row, colour in ((-0.26, _ORANGE), (0.24, GREEN)):
        for k in range(5):
            kit.tube((w * (-0.46 + 0.1 * k), row * d, h * 0.5), h * 0.5, 0.008, shade(colour, 1.0 + 0.2 * (k % 2)), "x")
        kit.rod((w * 0.26, row * d, h * 0.5), h * 0.45, w * 0.48, colour, "x")


def open_book(kit: Kit) -> None:
    """Draw an open book from its pages' side: lines of text, and the cover around them."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.3))
    for side in (-1, 1):
        kit.box((side * w * 0.245, 0, h * 0.3), (w * 0.47, d * 0.94, h * 0.7), CREAM)
        for k in range(6):
            kit.box((side * w * 0.25, d * (0.36 - 0.14 * k), h), (w * 0.36, d * 0.035, 0.001), DARK)


def knitting(kit: Kit) -> None:
    """Draw a piece of knitting that hangs from two needles."""
    w, d, h = kit.w, kit.d, kit.h
    for k in range(7):
        kit.box((0, 0, h * 0.12 * k), (w * 0.6, d * 0.4, h * 0.12), shade(kit.colour, 1.0 if k % 2 else 1.4))
    for side in (-1, 1):
        kit.rod((side * w * 0.14, side * d * 0.25, h * 0.9), 0.007, w * 0.8, STEEL, "x")
        kit.ball((side * w * 0.54, side * d * 0.25, h * 0.9), 0.014, YELLOW)


def steam(kit: Kit) -> None:
    """Draw steam that rises in three thin winding lines."""
    w, h = kit.w, kit.h
    for x in (-0.35, 0.0, 0.35):
        for k in range(5):
            bend = 0.14 if k % 2 else -0.02
            kit.rod(((x + bend) * w, 0, h * (0.12 + 0.18 * k)), w * 0.035, h * 0.24, (0.86, 0.88, 0.9))


def rope_over(kit: Kit) -> None:
    """Draw a skipping rope on its way over the head: an arc from one end's handle to the other's."""
    _arc(kit, up=1.0)


def rope_under(kit: Kit) -> None:
    """Draw a skipping rope on its way under the feet."""
    _arc(kit, up=-1.0)


def _arc(kit: Kit, up: float) -> None:
    w, h = kit.w, kit.h
    base = 0.0 if up > 0 else h
    for side in (-1, 1):
        kit.rod((side * w / 2, 0, base), 0.016, 0.13, BLACK, "x")
    turns = [math.pi * k / 13 for k in range(14)]
    places = [(w / 2 * math.cos(angle), 0.0, base + up * h * math.sin(angle)) for angle in turns]
    for first, second in itertools.pairwise(places):
        kit.bar(first, second, kit.d / 2)


def garment(kit: Kit) -> None:
    """Draw a jumper that is held up by its shoulders: body, neck and sleeves."""
    w, d, h = kit.w, kit.d, kit.h
    ribbing = shade(kit.colour, 0.7)
    for k, wide in enumerate((0.5, 0.48, 0.46, 0.48)):
        kit.box((0, 0, h * (0.06 + 0.22 * k)), (w * wide, d, h * 0.23))
    kit.box((0, 0, 0), (w * 0.46, d * 1.1, h * 0.07), ribbing)
    kit.box((0, d * 0.08, h * 0.9), (w * 0.2, d, h * 0.08), ribbing)
    _sleeves(kit)


def worn_garment(kit: Kit) -> None:
    """Draw the same jumper around a body."""
    w, d, h = kit.w, kit.d, kit.h
    ribbing = shade(kit.colour, 0.7)
    for low, tall, colour in ((0.0, 0.08, ribbing), (0.08, 0.84, kit.colour)):
        kit.box((0, 0, low * h), (w * 0.28, d * 0.8, tall * h), colour)
        for side in (-1, 1):
            kit.tube((side * w * 0.14, 0, low * h), d * 0.4, tall * h, colour)
    kit.rod((0, 0, h * 0.88), d * 0.3, w * 0.62, axis="x")
    kit.tube((0, 0, h * 0.94), w * 0.11, h * 0.14, ribbing)
    _sleeves(kit)


def _sleeves(kit: Kit) -> None:
    for side in (-1, 1):
        shoulder, wrist = (side * kit.w * 0.24, 0.0, kit.h * 0.86), (side * kit.w * 0.45, 0.0, kit.h * 0.44)
        kit.bar(shoulder, wrist, kit.w * 0.085)
        kit.ball(wrist, kit.w * 0.088, shade(kit.colour, 0.7))


def hung_garment(kit: Kit) -> None:
    """Draw a shirt on a hanger."""
    w, d, h = kit.w, kit.d, kit.h
    for k, wide in enumerate((0.52, 0.5, 0.5, 0.54)):
        kit.box((0, 0, h * 0.2 * k), (w * wide, d, h * 0.21))
    for side in (-1, 1):
        kit.bar((side * w * 0.25, 0.0, h * 0.74), (side * w * 0.36, 0.0, h * 0.3), w * 0.08, shade(kit.colour, 0.85))
        kit.bar((0, 0, h * 0.9), (side * w * 0.27, 0, h * 0.8), 0.012, DARK)
    kit.box((0, d * 0.1, h * 0.76), (w * 0.18, d, h * 0.05), WHITE)
    for k in range(3):
        kit.ball((0, d * 0.5, h * (0.16 + 0.2 * k)), 0.013, WHITE)
    kit.bar((0, 0, h * 0.88), (0, 0, h * 0.96), 0.008, STEEL)
    kit.bar((0, 0, h * 0.97), (w * 0.06, 0, h), 0.008, STEEL)


def exercise_mat(kit: Kit) -> None:
    """Draw a mat that is rolled out on the floor, with stripes along it."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    for side in (-1, 1):
        kit.box((0, side * kit.d * 0.42, kit.h), (kit.w * 0.96, kit.d * 0.03, 0.001), WHITE)


def puzzle(kit: Kit) -> None:
    """Draw a puzzle half laid: a patch of coloured pieces, and some loose ones."""
    w, d, h = kit.w, kit.d, kit.h
    colours = (RED, YELLOW, GREEN, BLUE, _ORANGE, WHITE)
    for row in range(3):
        for column in range(5):
            done = column + row < 5
            x, y = w * (-0.4 + 0.18 * column), d * (0.32 - 0.3 * row)
            size = (w * 0.17, d * 0.28, h) if done else (w * 0.12, d * 0.2, h)
            kit.box((x if done else x + 0.02, y, 0), size, colours[(2 * column + row) % 6])


STAGED: dict[str, Recipe] = {
    f"staged_{recipe.__name__}": recipe
    for recipe in (
        *(
            place_setting,
            place_mat,
            plant_stand,
            cat,
            dog,
            full_bowl,
            falling_food,
            spread_blanket,
            foam,
            dish_rack,
            dishes,
        ),
        *(sliced_food, open_book, knitting, steam, exercise_mat, puzzle),
        *(rope_over, rope_under, garment, worn_garment, hung_garment),
    )
}
