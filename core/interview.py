"""What a real person in the loop is asked, and the answers, as plain data that a terminal or a web page can show."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from coopera.core.household import Collab
from coopera.core.people import Frozen, PersonId

MOST_STEPS = 8
"""Steps of one hour at most, as many as a model's reply may have tasks."""

Answer: TypeAlias = str | list[str]
"""To "intention" a text; to "tasks" the steps as texts; to "feedback" a text per item, such as "no, I was reading"."""

Step = Annotated[str, Field(min_length=1, max_length=300)]


class Question(Frozen):
    """One question to a real person; it waits, for days if need be, until it is answered.

    Attributes:
        kind: What is asked for: this hour's intention, its tasks, or the evening's feedback on one hour.
        time: The hour in words, such as "9 am".
        today: What the person has set out to do today so far, in order, each with its time.
        rooms: The rooms of the home.
        intention: What the person wanted this hour ("tasks" and "feedback").
        places: Fixed objects near to the intention, nearest first: {name: room} ("tasks").
        things: Movable objects near to it, in collaboration type 1: {name: room} ("tasks").
        motions: Example motions, in collaboration type 2 ("tasks").
        n_tasks: How many tasks there should be ("tasks").
        tasks: The tasks of that hour in words ("feedback").
        items: The robot's candidates in words, each to be judged ("feedback").
        graded: Whether items are judged from 1 to 5 instead of by yes or no ("feedback").
        problem: What was wrong with the last answer to this question; empty the first time.
    """

    kind: Literal["intention", "tasks", "feedback"]
    person: PersonId
    name: str
    day: int
    hour: int
    time: str
    weekday: str
    collab: Collab
    rooms: list[str] = []
    today: list[str] = []
    intention: str = ""
    places: dict[str, str] = {}
    things: dict[str, str] = {}
    motions: list[str] = []
    n_tasks: int = 0
    tasks: list[str] = []
    items: list[str] = []
    graded: bool = False
    problem: str = ""
