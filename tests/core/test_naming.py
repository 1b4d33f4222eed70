from __future__ import annotations

from coopera.core.naming import ends_with


def test_words_end_with_whole_words_alone() -> None:
    assert ends_with("tea", "tea")
    assert ends_with("green tea", "tea")
    assert ends_with("cup of green tea", "green tea")
    assert not ends_with("green tea", "ea")
    assert not ends_with("tea towel", "tea")
    assert not ends_with("tea", "green tea")
