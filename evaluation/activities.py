"""Groups of household activities, by which results are broken down."""

from __future__ import annotations

from collections.abc import Callable

from langchain_core.embeddings import Embeddings

from coopera.memory import Search

GROUPS: dict[str, str] = {
    "cook or bake": "cook a meal or bake something in the kitchen",
    "eat or drink": "eat a meal, have a snack or a warm drink",
    "clean or tidy": "clean, tidy up, do the laundry or wash the dishes",
    "exercise": "exercise, stretch, do yoga or work out",
    "work or study": "work at the desk, study or do paperwork",
    "read or write": "read a book or write a letter or a diary",
    "make or practise": "paint, knit, repair something or play an instrument",
    "watch or play": "watch a film, listen to music or play games",
    "care for oneself": "wash, groom, get dressed or take care of one's health",
    "rest": "rest, nap, meditate or get ready for bed",
    "plants and pets": "water the plants or look after the pet",
    "other people": "call a friend, welcome guests or spend time with the family",
}
"""Name -> what an intention is compared with."""


def nearest_group(embeddings: Embeddings) -> Callable[[str], str]:
    """Return a function from an intention to its group: the one most similar to it by cosine."""
    names = {text: name for name, text in GROUPS.items()}
    search = Search(embeddings, list(names))
    return lambda intention: names[search.top(intention, 1)[0][0]]
