"""How people spend their hours, in the nine categories in which tables of time use count them."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

Category: TypeAlias = Literal["sleeping", "work", "food_prep", "laundry", "tv", "eating", "exercise", "travel", "other"]
DayType: TypeAlias = Literal["weekday", "weekend"]

CATEGORIES: tuple[Category, ...] = get_args(Category)
"""In the order that is used everywhere; "other" is whatever is none of the rest."""
DAY_TYPES: tuple[DayType, ...] = get_args(DayType)


def day_type(day: int) -> DayType:
    """Whether a day of the calendar is of the working week; day 0 is a Monday, as in `coopera.core.clock`."""
    return "weekend" if day % 7 >= 5 else "weekday"
