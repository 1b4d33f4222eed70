"""Recipes of a person's belongings: books, devices, toys, clothes, care, sport, craft and cleaning things."""

from __future__ import annotations

from simulation.shapes import (
    BLACK,
    CREAM,
    DARK,
    DARK_WOOD,
    GREEN,
    PAPER,
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

BLUE: Colour = (0.2, 0.4, 0.75)


def picture_frame(kit: Kit) -> None:
    """Draw a framed picture of a meadow, leaning back."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, 0.02, h), tilt=0.12)
    kit.box((0, 0.012, h * 0.14), (w * 0.78, 0.006, h * 0.36), GREEN, tilt=0.12)
    kit.box((0, 0.002, h * 0.5), (w * 0.78, 0.012, h * 0.36), (0.6, 0.8, 0.95), tilt=0.12)
    kit.box((0, -d * 0.3, 0), (0.02, d * 0.4, h * 0.3), DARK)


def book(kit: Kit) -> None:
    """Draw a closed book: cover, pages, title."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, h * 0.15))
    kit.box((0.004, 0, h * 0.15), (w - 0.012, d - 0.012, h * 0.7), PAPER)
    kit.box((0, 0, h * 0.85), (w, d, h * 0.15))
    kit.box((-w / 2 + 0.003, 0, 0), (0.006, d, h))
    kit.box((0, d * 0.15, h), (w * 0.6, d * 0.2, 0.001), YELLOW)


def magazine(kit: Kit) -> None:
    """Draw a thin bright magazine with a picture and a headline."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    kit.box((0, -0.02, kit.h), (kit.w * 0.8, kit.d * 0.5, 0.001), (0.9, 0.75, 0.6))
    kit.box((0, kit.d * 0.36, kit.h), (kit.w * 0.8, kit.d * 0.14, 0.001), WHITE)


def notebook(kit: Kit) -> None:
    """Draw a spiral notebook."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    kit.box((kit.w * 0.05, 0, kit.h), (kit.w * 0.6, kit.d * 0.3, 0.001), PAPER)
    for i in range(6):
        kit.box((-kit.w / 2, kit.d * (-0.4 + 0.16 * i), 0), (0.018, 0.008, kit.h + 0.006), STEEL)


def sketchbook(kit: Kit) -> None:
    """Draw an open pad with a sketch and a pencil."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.5))
    kit.box((0, 0, kit.h * 0.5), (kit.w * 0.94, kit.d * 0.94, kit.h * 0.4), PAPER)
    kit.tube((-kit.w * 0.15, 0, kit.h * 0.9), kit.d * 0.2, 0.001, (0.5, 0.5, 0.5))
    kit.box((kit.w * 0.15, kit.d * 0.1, kit.h * 0.9), (0.008, kit.d * 0.5, 0.001), DARK)
    kit.rod((kit.w * 0.32, 0, kit.h), 0.006, kit.d * 0.6, YELLOW, "y")


def pen(kit: Kit) -> None:
    """Draw a pen with a cap and a tip."""
    r = kit.h / 2
    kit.tube((0, 0, r), r, kit.w * 0.8, axis="x")
    kit.tube((-kit.w * 0.32, 0, r), r * 1.2, kit.w * 0.3, BLACK, "x")
    kit.rod((kit.w * 0.44, 0, r), r * 0.5, kit.w * 0.12, STEEL, "x")


def laptop(kit: Kit) -> None:
    """Draw an open laptop, its screen at the back."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, 0), (w, d, 0.018))
    kit.box((0, d * 0.1, 0.018), (w * 0.86, d * 0.4, 0.002), BLACK)
    kit.box((0, -d / 2 + 0.012, 0.018), (w, 0.012, h - 0.018), tilt=0.15)
    kit.box((0, -d / 2 + 0.02, 0.03), (w * 0.92, 0.006, h - 0.045), (0.45, 0.7, 0.95), tilt=0.15)


def tablet(kit: Kit) -> None:
    """Draw a tablet lying flat, lit."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.8), BLACK)
    kit.box((0, 0, kit.h * 0.8), (kit.w * 0.88, kit.d * 0.9, kit.h * 0.2), (0.5, 0.75, 0.9))
    kit.box((0, kit.d * 0.15, kit.h), (kit.w * 0.6, kit.d * 0.25, 0.001), WHITE)


def phone(kit: Kit) -> None:
    """Draw a phone lying flat with coloured icons."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.8))
    kit.box((0, 0, kit.h * 0.8), (kit.w * 0.86, kit.d * 0.9, kit.h * 0.2), SCREEN)
    for i, colour in enumerate((RED, YELLOW, GREEN)):
        kit.box((kit.w * (-0.25 + 0.25 * i), kit.d * 0.2, kit.h), (kit.w * 0.16, kit.d * 0.1, 0.001), colour)


def remote_control(kit: Kit) -> None:
    """Draw a long black remote control with buttons."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    kit.tube((0, kit.d * 0.38, kit.h), kit.w * 0.16, 0.003, RED)
    for i in range(6):
        x, y = (-0.22 if i % 2 else 0.22), 0.18 - 0.16 * (i // 2)
        kit.box((kit.w * x, kit.d * y, kit.h), (kit.w * 0.22, kit.d * 0.08, 0.003), STEEL)


def game_controller(kit: Kit) -> None:
    """Draw a game controller: two grips, two sticks and four buttons."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, d * 0.1, h * 0.25), (w * 0.75, d * 0.7, h * 0.5))
    for side in (-1, 1):
        kit.rod((side * w * 0.38, 0, h * 0.42), min(h * 0.42, w * 0.13), d, axis="y")
        kit.tube((side * w * 0.16, -d * 0.05, h * 0.75), w * 0.07, h * 0.2, BLACK)
    for x, y, colour in ((0, 0.1, RED), (0.09, 0, GREEN), (-0.09, 0, BLUE), (0, -0.1, YELLOW)):
        kit.tube((w * (0.33 + x), d * (0.2 + y), h * 0.75), w * 0.04, h * 0.15, colour)


def camera(kit: Kit) -> None:
    """Draw a camera: body, lens in front, viewfinder and shutter button."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, -d * 0.2, 0), (w, d * 0.6, h * 0.8))
    kit.box((0, -d * 0.2, h * 0.8), (w * 0.35, d * 0.5, h * 0.2), DARK)
    kit.tube((0, d * 0.25, h * 0.38), h * 0.34, d * 0.4, DARK, "y")
    kit.tube((0, d * 0.46, h * 0.38), h * 0.24, d * 0.08, (0.35, 0.5, 0.75), "y")
    kit.tube((w * 0.36, -d * 0.2, h * 0.8), h * 0.08, h * 0.07, RED)


def headphones(kit: Kit) -> None:
    """Draw headphones standing on their cups: two cups and a band."""
    w, h = kit.w, kit.h
    for side in (-1, 1):
        kit.tube((side * w * 0.38, 0, h * 0.28), h * 0.28, w * 0.2, axis="x")
        kit.tube((side * w * 0.25, 0, h * 0.28), h * 0.25, w * 0.1, BLACK, "x")
        kit.box((side * w * 0.42, 0, h * 0.3), (0.016, 0.03, h * 0.55), DARK)
        kit.box((side * w * 0.27, 0, h * 0.8), (w * 0.28, 0.03, 0.016), DARK)
    kit.box((0, 0, h - 0.02), (w * 0.5, 0.03, 0.02), DARK)


def radio(kit: Kit) -> None:
    """Draw a radio: speaker, dial, handle and aerial."""
    w, d, h = kit.w, kit.d, kit.h * 0.75
    kit.box((0, 0, 0), (w, d, h))
    kit.tube((-w * 0.25, d / 2, h * 0.48), h * 0.36, 0.01, BLACK, "y")
    kit.box((w * 0.22, d / 2, h * 0.58), (w * 0.4, 0.008, h * 0.22), CREAM)
    kit.tube((w * 0.22, d / 2, h * 0.28), h * 0.14, 0.02, STEEL, "y")
    kit.box((0, 0, h + 0.03), (w * 0.7, 0.02, 0.015), STEEL)
    for side in (-1, 1):
        kit.box((side * w * 0.34, 0, h), (0.015, 0.02, 0.04), STEEL)
    kit.tube((w * 0.45, -d * 0.3, h), 0.004, kit.h * 0.25, STEEL)


def alarm_clock(kit: Kit) -> None:
    """Draw an alarm clock: round face with hands, two bells and two feet."""
    r = kit.w * 0.42
    kit.tube((0, 0, r + 0.015), r, kit.d, axis="y")
    kit.tube((0, kit.d / 2, r + 0.015), r * 0.85, 0.004, WHITE, "y")
    kit.box((0, kit.d / 2 + 0.004, r + 0.015), (0.008, 0.003, r * 0.7), BLACK)
    kit.box((r * 0.25, kit.d / 2 + 0.004, r + 0.012), (r * 0.5, 0.003, 0.008), BLACK)
    for side in (-1, 1):
        kit.ball((side * r * 0.6, 0, kit.h - r * 0.3), r * 0.35, STEEL)
        kit.box((side * r * 0.6, 0, 0), (0.015, kit.d * 0.6, 0.03), DARK)


def toy_car(kit: Kit) -> None:
    """Draw a toy car: body, cabin with windows, four wheels."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h * 0.2), (w, d * 0.84, h * 0.4))
    kit.box((-w * 0.06, 0, h * 0.6), (w * 0.5, d * 0.76, h * 0.4), (0.6, 0.8, 0.95))
    kit.box((-w * 0.06, 0, h * 0.93), (w * 0.5, d * 0.8, h * 0.07))
    for x in (-0.3, 0.3):
        for y in (-0.42, 0.42):
            kit.tube((x * w, y * d, h * 0.22), h * 0.22, d * 0.16, BLACK, "y")
    kit.box((w / 2, 0, h * 0.35), (0.004, d * 0.6, h * 0.14), YELLOW)


def teddy_bear(kit: Kit) -> None:
    """Draw a sitting teddy bear."""
    w, d, h = kit.w, kit.d, kit.h
    light = shade(kit.colour, 1.5)
    kit.ball((0, -d * 0.1, h * 0.3), h * 0.28)
    kit.ball((0, d * 0.08, h * 0.28), h * 0.2, light)
    kit.ball((0, 0, h * 0.7), h * 0.22)
    kit.ball((0, h * 0.18, h * 0.66), h * 0.09, light)
    kit.ball((0, h * 0.26, h * 0.69), h * 0.03, BLACK)
    for side in (-1, 1):
        kit.ball((side * h * 0.18, 0, h * 0.9), h * 0.09)
        kit.ball((side * w * 0.36, d * 0.1, h * 0.38), h * 0.12)
        kit.rod((side * w * 0.25, d * 0.3, h * 0.1), h * 0.1, d * 0.4, axis="y")
        kit.ball((side * h * 0.09, h * 0.19, h * 0.76), h * 0.028, BLACK)


def puzzle_box(kit: Kit) -> None:
    """Draw a flat box with a patchwork lid."""
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h))
    for i, colour in enumerate((RED, YELLOW, GREEN, BLUE, WHITE, (0.8, 0.45, 0.7))):
        x, y = -0.28 + 0.28 * (i % 3), -0.22 + 0.44 * (i // 3)
        kit.box((kit.w * x, kit.d * y, kit.h), (kit.w * 0.26, kit.d * 0.4, 0.002), colour)


def board_game(kit: Kit) -> None:
    """Draw a chequered game board with two pieces."""
    side = min(kit.w, kit.d)
    kit.box((0, 0, 0), (kit.w, kit.d, kit.h * 0.35))
    for i in range(4):
        for j in range(4):
            if (i + j) % 2 == 0:
                x, y = side * (-0.345 + 0.23 * i), side * (-0.345 + 0.23 * j)
                kit.box((x, y, kit.h * 0.35), (side * 0.22, side * 0.22, 0.002), CREAM)
    kit.tube((-side * 0.1, 0.02, kit.h * 0.35), 0.018, kit.h * 0.65, RED)
    kit.tube((side * 0.13, -0.04, kit.h * 0.35), 0.018, kit.h * 0.65, BLUE)


def tennis_ball(kit: Kit) -> None:
    """Draw a yellow-green ball with a seam."""
    kit.ball((0, 0, kit.h / 2), kit.h / 2)
    kit.tube((0, 0, kit.h * 0.48), kit.h * 0.5, 0.004, WHITE)


def dumbbell(kit: Kit) -> None:
    """Draw a dumbbell: a steel bar between two pairs of discs."""
    r = kit.h / 2
    kit.tube((0, 0, r), r * 0.3, kit.w * 0.6, STEEL, "x")
    for side in (-1, 1):
        kit.tube((side * kit.w * 0.33, 0, r), r, kit.w * 0.16, axis="x")
        kit.tube((side * kit.w * 0.45, 0, r), r * 0.75, kit.w * 0.1, axis="x")


def yoga_mat(kit: Kit) -> None:
    """Draw a rolled-up mat with two straps."""
    r = kit.h / 2
    kit.tube((0, 0, r), r, kit.w, axis="x")
    for side in (-1, 1):
        kit.tube((side * kit.w * 0.25, 0, r), r * 1.04, 0.03, BLACK, "x")
        kit.tube((side * kit.w / 2, 0, r), r * 0.5, 0.004, shade(kit.colour, 0.5), "x")


def jump_rope(kit: Kit) -> None:
    """Draw a coiled rope with two handles."""
    r = kit.d * 0.4
    kit.tube((0, 0, 0), r, kit.h * 0.6)
    kit.tube((0, 0, kit.h * 0.6), r * 0.6, 0.002, DARK)
    for side in (-1, 1):
        kit.rod((side * kit.w * 0.38, 0.01, kit.h * 0.4), kit.h * 0.4, kit.d * 0.8, RED, "y")


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
    """Draw a plump cushion with a paler middle."""
    w, d, h = kit.w, kit.d, kit.h
    kit.box((0, 0, h * 0.3), (w, d, h * 0.35))
    kit.box((0, 0, h * 0.1), (w * 0.84, d * 0.84, h * 0.8))
    kit.box((0, 0, 0), (w * 0.5, d * 0.5, h), shade(kit.colour, 1.3))


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


def guitar(kit: Kit) -> None:
    """Draw a guitar lying on its back, neck towards the right."""
    w, d, h = kit.w, kit.d, kit.h
    kit.tube((-w / 2 + d / 2, 0, 0), d / 2, h * 0.7)
    kit.tube((-w / 2 + d * 1.0, 0, 0), d * 0.37, h * 0.7)
    kit.tube((-w / 2 + d * 0.85, 0, h * 0.7), d * 0.14, 0.003, BLACK)
    kit.box((-w / 2 + d * 0.35, 0, h * 0.7), (0.03, d * 0.4, 0.012), DARK_WOOD)
    neck = w - d * 1.35
    kit.box((w / 2 - neck / 2, 0, h * 0.62), (neck, 0.055, 0.025), DARK_WOOD)
    kit.box((w / 2 - 0.07, 0, h * 0.6), (0.14, 0.085, 0.025), BLACK)
    kit.box((w * 0.02, 0, h * 0.72), (w * 0.8, 0.012, 0.004), STEEL)


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


BELONGINGS: dict[str, Recipe] = {
    recipe.__name__: recipe
    for recipe in (
        picture_frame,
        book,
        magazine,
        notebook,
        sketchbook,
        pen,
        laptop,
        tablet,
        phone,
        remote_control,
        game_controller,
        camera,
        headphones,
        radio,
        alarm_clock,
        toy_car,
        teddy_bear,
        puzzle_box,
        board_game,
        tennis_ball,
        dumbbell,
        yoga_mat,
        jump_rope,
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
        guitar,
        paint_box,
        knitting_basket,
        scissors,
        toolbox,
        sewing_kit,
        tissue_box,
        broom,
        feather_duster,
    )
}
