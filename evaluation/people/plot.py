"""The figures of the checks as a picture: ours with intervals, the controls, and the paper's beside them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from coopera.evaluation.people.figures import FULL, IN_DETAIL, Figure

_INK, _OURS, _PAPER, _CONTROL, _ABLATION = "#222222", "#1f6f8b", "#d1495b", "#9a9a9a", "#8fb9c6"


def draw(figures: Sequence[Figure], path: Path, caption: str) -> None:
    """Draw the measured figures into a PNG file, one row each, with `caption` below (seeds and command)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - heavy
    from matplotlib.figure import Figure as Picture  # noqa: PLC0415

    rows = [figure for figure in figures if figure.value is not None and figure.check not in IN_DETAIL]
    picture = Picture(figsize=(9.0, 1.5 + 0.36 * max(len(rows), 1)), layout="constrained")
    FigureCanvasAgg(picture)
    axes = picture.subplots()
    axes.axvline(0, color="#cccccc", linewidth=0.8)
    for place, figure in enumerate(rows):
        value = float(figure.value or 0.0)
        color = _OURS if figure.variant == FULL else _ABLATION
        if figure.low is not None and figure.high is not None:
            axes.plot([figure.low, figure.high], [place, place], color=color, linewidth=4, solid_capstyle="round")
        axes.plot(value, place, "o", color=color, markersize=8, markeredgecolor="white")
        if figure.control is not None:
            axes.plot(figure.control, place, "|", color=_CONTROL, markersize=13, markeredgewidth=2)
        if figure.paper is not None:
            axes.plot(figure.paper, place, "D", color=_PAPER, markersize=6, markeredgecolor="white")
    axes.set_yticks(range(len(rows)), [_label(figure) for figure in rows], fontsize=9, color=_INK)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(axis="x", color="#eeeeee")
    axes.set_axisbelow(True)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(left=False)
    for style, color, name in (("o", _OURS, "ours, 95 % interval"), ("o", _ABLATION, "ours, ablation")):
        axes.plot([], [], style, color=color, label=name)
    axes.plot([], [], "D", color=_PAPER, label="paper")
    axes.plot([], [], "|", color=_CONTROL, markersize=12, markeredgewidth=2, label="ours, control")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, fontsize=8, frameon=False)
    picture.supxlabel(caption, fontsize=7, color="#666666", wrap=True)
    picture.savefig(path, dpi=150, metadata={"Software": None})


def _label(figure: Figure) -> str:
    variant = "" if figure.variant == FULL else f" [{figure.variant.replace('_', ' ')}]"
    return f"{figure.check}: {figure.measure}{variant}"
