"""Recipes of things for free time and work: pictures, books, devices, toys, sport and music."""

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
    SCREEN,
    STEEL,
    WHITE,
    YELLOW,
    Kit,
    Recipe,
    shade,
)


def picture_frame(kit: Kit) -> None:
    """Draw a framed picture of a meadow, leaning back."""
    w, d, h = kit.w, kit.d, kit.h
    lean = 0.12
    kit.box((0, 0, 0), (w, 0.02, h), tilt=lean)
    for low, colour in ((0.12, GREEN), (0.5, (0.6, 0.8, 0.95))):
        forward = (0.5 - low - 0.19) * h * lean + 0.009
        kit.box((0, forward, h * low), (w * 0.76, 0.008, h * 0.38), colour, tilt=lean)
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


LEISURE_THINGS: dict[str, Recipe] = {
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
        guitar,
    )
}
