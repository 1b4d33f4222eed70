"""The super-categories of HSSD, as the paper sorts them into things that move and things that stay (PAPER App. B)."""

from __future__ import annotations

DYNAMIC = (
    *("trashcan", "decor", "dining ware", "plant", "electronics", "animate object", "apparel", "liquid container"),
    *("kitchen ware", "tray", "bathroom accessory", "gym equipment", "toy", "wearable"),
)
"""An object of one of these, which carries nothing itself, can be moved."""
STATIC = (
    *("storage furniture", "support furniture", "seating furniture", "floor covering", "lighting"),
    *("sleeping furniture", "bathroom fixtures", "mirror", "large kitchen appliance", "large appliance"),
    *("kitchen bathroom fixture", "vehicle", "heating cooling", "medium kitchen appliance", "display", "arch"),
    *("curtain", "small kitchen appliance"),
)
"""Objects of these stay where they are."""
