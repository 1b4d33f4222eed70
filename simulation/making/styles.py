"""Styles of furniture: what is done to its colours. Appliances and what is of ceramic keep theirs."""

from __future__ import annotations

from coopera.simulation.homes.scene import SceneObject

STYLES: dict[str, tuple[tuple[float, float, float], float]] = {
    "": ((0.0, 0.0, 0.0), 0.0),
    "light": ((0.93, 0.89, 0.82), 0.5),
    "dark": ((0.20, 0.14, 0.11), 0.5),
    "grey": ((0.55, 0.56, 0.58), 0.6),
    "warm": ((0.72, 0.42, 0.22), 0.4),
}
"""By name: the colour that a style adds, and how much of it."""
_STYLED = ("storage furniture", "support furniture", "seating furniture", "sleeping furniture", "curtain")


def styled(thing: SceneObject, style: str) -> SceneObject:
    """A piece of furniture in a style."""
    tint, share = STYLES[style]
    if not share or thing.category not in _STYLED:
        return thing
    mixed = (round(255 * (own * (1 - share) + new * share)) for own, new in zip(thing.rgb, tint, strict=True))
    return thing.model_copy(update={"colour": "#" + "".join(f"{channel:02x}" for channel in mixed)})
