"""The terminal, as everything that is drawn goes to it: no text of a model, person or file can take it over."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.text import Text
from typing_extensions import override

from coopera.core.naming import printable


class PlainConsole(Console):
    """A console that shows control characters instead of obeying them; colours come from markup and style alone."""

    @override
    def render_str(self, text: str, **how: Any) -> Text:
        return super().render_str(printable(text), **how)
