"""Charts as inline SVG: lines over days, bars over hours, and true against inferred traits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from markupsafe import Markup

from coopera.core.people import TRAITS, BigFive

_LEFT, _RIGHT, _TOP, _BOTTOM = 34, 14, 16, 30


class Series(NamedTuple):
    """One line: `kind` is its CSS class, values in [0, 1] or None where there is no figure."""

    name: str
    kind: str
    values: Sequence[float | None]
    labelled: bool = False


def lines(
    series: Sequence[Series],
    ticks: Sequence[str],
    *,
    width: int = 520,
    height: int = 250,
    label: str = "Success by day",
) -> Markup:
    """Lines over evenly spaced ticks, with figures at the points of labelled series."""
    frame = _Frame(width, height, len(ticks))
    marks = [_axes(frame, ticks)]
    for one in series:
        points = [(n, frame.x(n), frame.y(value), value) for n, value in enumerate(one.values) if value is not None]
        path = " ".join(f"{'L' if n else 'M'}{x:.1f} {y:.1f}" for n, (_, x, y, _) in enumerate(points))
        marks.append(Markup('<path class="line {}" d="{}"/>').format(one.kind, path))
        for n, x, y, value in points:
            title = f"{one.name}, {ticks[n]}: {value:.3f}"
            dot = '<circle class="dot {}" cx="{:.1f}" cy="{:.1f}" r="3.5"><title>{}</title></circle>'
            marks.append(Markup(dot).format(one.kind, x, y, title))
            if one.labelled:
                text = '<text class="value {}" x="{:.1f}" y="{:.1f}" text-anchor="middle">{:.2f}</text>'
                below = any(value < (other.values[n] or 0) for other in series)  # keep clear of a line above
                marks.append(Markup(text).format(one.kind, x, y + 17 if below and y < frame.y(0.08) else y - 9, value))
    return _svg(frame, marks, label)


def bars(values: Sequence[float | None], ticks: Sequence[str], *, width: int = 520, height: int = 250) -> Markup:
    """Bars over evenly spaced ticks, each with its figure."""
    frame = _Frame(width, height, len(ticks), inset=True)
    marks = [_axes(frame, ticks)]
    half = min(frame.step * 0.34, 22)
    for n, value in enumerate(values):
        if value is None:
            continue
        x, y, zero = frame.x(n), frame.y(value), frame.y(0)
        bar = '<rect class="col" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" rx="2"><title>{}</title></rect>'
        marks.append(Markup(bar).format(x - half, y, 2 * half, max(zero - y, 0.5), f"{ticks[n]}: {value:.3f}"))
        text = '<text class="value" x="{:.1f}" y="{:.1f}" text-anchor="middle">{:.2f}</text>'
        marks.append(Markup(text).format(x, y - 5, value))
    return _svg(frame, marks, "Success by hour of day")


def traits(true: BigFive | None, inferred: BigFive | None, before: BigFive | None = None) -> Markup:
    """The Big Five on their scale from 1 to 5: hollow what is true, filled what the robot believes."""
    width, row, left = 420, 30, 128
    span = width - left - 20

    def at(score: float) -> float:
        return left + span * (score - 1) / 4

    marks = []
    for n, trait in enumerate(TRAITS):
        y = 16 + n * row
        marks.append(Markup('<text class="tick" x="0" y="{}">{}</text>').format(y + 4, trait))
        marks.append(Markup('<line class="grid" x1="{}" x2="{}" y1="{}" y2="{}"/>').format(at(1), at(5), y, y))
        real, seen = (getattr(one, trait) if one else None for one in (true, inferred))
        if before is not None:
            was = getattr(before, trait)
            mark = '<circle class="was" cx="{:.1f}" cy="{}" r="3.5"><title>the day before: {:.2f}</title></circle>'
            marks.append(Markup(mark).format(at(was), y, was))
        if real is not None and seen is not None:
            gap = '<line class="gap" x1="{:.1f}" x2="{:.1f}" y1="{}" y2="{}"/>'
            marks.append(Markup(gap).format(at(real), at(seen), y, y))
        if real is not None:
            mark = '<circle class="true" cx="{:.1f}" cy="{}" r="6"><title>true: {:.2f}</title></circle>'
            marks.append(Markup(mark).format(at(real), y, real))
        if seen is not None:
            mark = '<circle class="seen" cx="{:.1f}" cy="{}" r="5"><title>inferred: {:.2f}</title></circle>'
            marks.append(Markup(mark).format(at(seen), y, seen))
    foot = 16 + len(TRAITS) * row
    for score in (1, 2, 3, 4, 5):
        text = '<text class="tick" x="{:.1f}" y="{}" text-anchor="middle">{}</text>'
        marks.append(Markup(text).format(at(score), foot, score))
    return Markup('<svg class="traits" viewBox="0 0 {} {}" role="img" aria-label="Big Five">{}</svg>').format(
        width, foot + 8, Markup("").join(marks)
    )


def calibration(
    bins: Mapping[str, Sequence[tuple[float, float, int]]], *, width: int = 520, height: int = 300
) -> Markup:
    """Reliability: what was said (across) against what was right (up), a dot per bin, larger the more verdicts.

    Args:
        bins: CSS class -> (mean probability, share of right, how many) of each bin that has any.
        width: In SVG units.
        height: In SVG units.
    """
    frame = _Frame(width, height, 5)

    def across(share: float) -> float:
        return frame.x(0) + share * (frame.x(4) - frame.x(0))

    marks = [_axes(frame, ["0", ".25", ".5", ".75", "1"])]
    ideal = '<line class="grid" stroke-dasharray="3 4" x1="{:.1f}" x2="{:.1f}" y1="{:.1f}" y2="{:.1f}"/>'
    marks.append(Markup(ideal).format(across(0), across(1), frame.y(0), frame.y(1)))
    for kind, points in bins.items():
        for said, right, count in points:
            dot = '<circle class="dot {}" cx="{:.1f}" cy="{:.1f}" r="{:.1f}"><title>{}</title></circle>'
            title = f"{kind}: said {said:.2f}, right {right:.2f}, {count} verdicts"
            marks.append(Markup(dot).format(kind, across(said), frame.y(right), 3 + min(count, 400) ** 0.5 / 4, title))
    return _svg(frame, marks, "Calibration: probability said against share right")


class _Frame:
    """Where a plot's points stand, in SVG units."""

    def __init__(self, width: int, height: int, ticks: int, *, inset: bool = False) -> None:
        self.width, self.height = width, height
        room = width - _LEFT - _RIGHT
        self.step = room / max(ticks, 1) if inset or ticks < 2 else (room - 28) / (ticks - 1)
        self._start = _LEFT + (self.step / 2 if inset or ticks < 2 else 14)

    def x(self, tick: int) -> float:
        return self._start + tick * self.step

    def y(self, value: float) -> float:
        return _TOP + (self.height - _TOP - _BOTTOM) * (1 - value)


def _axes(frame: _Frame, ticks: Sequence[str]) -> Markup:
    marks = []
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = frame.y(share)
        line = '<line class="grid" x1="{}" x2="{}" y1="{:.1f}" y2="{:.1f}"/>'
        marks.append(Markup(line).format(_LEFT, frame.width - _RIGHT, y, y))
        text = '<text class="tick" x="{}" y="{:.1f}" text-anchor="end">{:g}</text>'
        marks.append(Markup(text).format(_LEFT - 6, y + 4, share))
    every = max(1, -(-len(ticks) // 20))
    for n, tick in enumerate(ticks):
        if n % every == 0:
            text = '<text class="tick" x="{:.1f}" y="{}" text-anchor="middle">{}</text>'
            marks.append(Markup(text).format(frame.x(n), frame.height - 10, tick))
    return Markup("").join(marks)


def _svg(frame: _Frame, marks: Sequence[Markup], label: str) -> Markup:
    return Markup('<svg class="chart" viewBox="0 0 {} {}" role="img" aria-label="{}">{}</svg>').format(
        frame.width, frame.height, label, Markup("").join(marks)
    )
