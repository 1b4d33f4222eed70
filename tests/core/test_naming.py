from __future__ import annotations

import json

import pytest

from coopera.core.naming import ends_with, printable


def test_words_end_with_whole_words_alone() -> None:
    assert ends_with("tea", "tea")
    assert ends_with("green tea", "tea")
    assert ends_with("cup of green tea", "green tea")
    assert not ends_with("green tea", "ea")
    assert not ends_with("tea towel", "tea")
    assert not ends_with("tea", "green tea")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("tea\nand\ttoast – für 茶 🫖", "tea\nand\ttoast – für 茶 🫖"),
        ("\x1b[31mred", "\\u001b[31mred"),
        ("a\rb\x00\x7f\x9b", "a\\u000db\\u0000\\u007f\\u009b"),
        ("\u202etxt.exe\u2028\ud800", "\\u202etxt.exe\\u2028\\ud800"),
    ],
)
def test_control_characters_are_written_out(text: str, shown: str) -> None:
    assert printable(text) == printable(shown) == shown
    assert json.loads(printable(json.dumps(text, ensure_ascii=False))) == text
