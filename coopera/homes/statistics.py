"""The figure that compares homes as the paper's does: objects by super-category, and what each home has."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from coopera.core.errors import ConfigError
from coopera.simulation.homes.scene import Scene

_STATIC, _DYNAMIC = "#7c8aa5", "#d98a4a"


def draw(homes: Sequence[Scene], path: Path) -> None:
    """Draw the objects of all homes by super-category, and the rooms and objects of each, as a picture.

    Raises:
        ConfigError: If it cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - heavy
    from matplotlib.figure import Figure  # noqa: PLC0415 - heavy

    figure = Figure(figsize=(11, 8), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    fixed = Counter(thing.category for home in homes for thing in home.fixed)
    movable = Counter(thing.category for home in homes for thing in home.movable)
    names = sorted({*fixed, *movable}, key=lambda name: (fixed[name] + movable[name], name))
    left.barh(names, [fixed[name] for name in names], color=_STATIC, label="fixed")
    left.barh(names, [movable[name] for name in names], left=[fixed[n] for n in names], color=_DYNAMIC, label="movable")
    for row, name in enumerate(names):
        left.text(fixed[name] + movable[name] + 1, row, str(fixed[name] + movable[name]), va="center", fontsize=8)
    left.set_title(f"Objects by super-category, {len(homes)} homes")
    left.legend(loc="lower right", frameon=False)
    places = range(len(homes))
    ids = [f"{home.id}\n{len(home.rooms)} rooms" for home in homes]
    right.bar([place - 0.2 for place in places], [len(home.fixed) for home in homes], 0.4, color=_STATIC)
    right.bar([place + 0.2 for place in places], [len(home.movable) for home in homes], 0.4, color=_DYNAMIC)
    for place, home in enumerate(homes):
        right.text(place - 0.2, len(home.fixed) + 1, str(len(home.fixed)), ha="center", fontsize=8)
        right.text(place + 0.2, len(home.movable) + 1, str(len(home.movable)), ha="center", fontsize=8)
    right.set_xticks(list(places), ids, fontsize=8)
    right.set_title("Objects and rooms by home")
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=100, metadata={"Software": None} if path.suffix == ".png" else None)
    except (OSError, ValueError) as err:
        raise ConfigError(f"{path}: the picture cannot be written ({err}).") from err
