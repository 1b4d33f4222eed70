"""A card in a notebook: a title, a line below it, and what else there is; tables, and bars for chances."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from markupsafe import Markup, escape

LONGEST = 300  # characters of one text on a card

# Half-transparent greys show on light and on dark pages alike; a notebook says which it is to its own pages only.
_CARD = (
    "border:1px solid #8886;border-radius:12px;padding:14px 18px;margin:6px 0;max-width:60em;"
    "font:14px/1.5 ui-sans-serif,system-ui,'Segoe UI',Arial,sans-serif"
)
_CELL = "text-align:left;vertical-align:top;padding:3px 14px 3px 0;border-bottom:1px solid #8883;white-space:normal"
_SOFT = "opacity:.68"
_BAR = (
    '<span style="display:inline-block;width:4.5em;height:.55em;border-radius:3px;background:#8883;margin-right:.5em">'
    '<span style="display:block;width:{:.0f}%;height:100%;border-radius:3px;background:#0d8577"></span></span>{:.2f}'
)


def card(title: str, about: str = "", *body: Markup) -> str:
    """The HTML of a card."""
    head = Markup('<div style="font:600 17px/1.3 ui-serif,Georgia,serif">{}</div>').format(short(title))
    line = Markup('<div style="{};margin-bottom:8px">{}</div>').format(_SOFT, short(about)) if about else Markup("")
    return str(Markup('<div style="{}">{}{}{}</div>').format(_CARD, head, line, Markup("").join(body)))


def short(text: object) -> str:
    """A text that fits on a card."""
    said = str(text)
    return said if len(said) <= LONGEST else f"{said[: LONGEST - 1]}…"


def note(text: object) -> Markup:
    """A paragraph."""
    return Markup('<p style="margin:4px 0">{}</p>').format(short(text))


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> Markup:
    """A table; cells that are markup already stay as they are. Nothing where there are no rows."""
    body = [_row("td", row) for row in rows]
    if not body:
        return Markup("")
    style = "border-collapse:collapse;margin:8px 0;font-variant-numeric:tabular-nums;text-align:left"
    head = _row("th", [Markup('<span style="{};font-weight:500">{}</span>').format(_SOFT, one) for one in heads])
    return Markup('<table style="{}">{}{}</table>').format(style, head, Markup("").join(body))


def bar(chance: float | None) -> Markup:
    """A number from 0 to 1 as a bar; a dash where there is none."""
    return Markup("–") if chance is None else Markup(_BAR).format(100 * min(max(chance, 0.0), 1.0), chance)


def _row(kind: str, cells: Sequence[object]) -> Markup:
    made = [
        Markup('<{0} style="{1}">{2}</{0}>').format(
            Markup(kind), _CELL, cell if isinstance(cell, Markup) else escape("–" if cell is None else short(cell))
        )
        for cell in cells
    ]
    return Markup("<tr>{}</tr>").format(Markup("").join(made))
