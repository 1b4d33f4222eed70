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


class Entry(Frozen):
    """One thing of the evening's: its place in `Question.items`, and what it is.

    Attributes:
        item: Place in `Question.items`, from 0.
        kind: What the robot imagined.
        under: Of a task: the intention that the robot imagined it for.
        also: What else it stands for, since it says nearly the same; the answer counts for these, too.
    """

    item: int
    kind: Literal["intention", "task"]
    under: str = ""
    also: list[str] = []


class Card(Frozen):
    """One hour in the evening: what the person wanted and did, what the robot did, and what is asked of it.

    Attributes:
        time: The hour in words.
        tasks: What the person did, in words.
        robot: What the robot did, in words; what it tried and could not do says so.
        entries: What is asked, intentions first.
    """

    hour: int
    time: str
    intention: str
    tasks: list[str] = []
    robot: list[str] = []
    entries: list[Entry] = []


class Question(Frozen):
    """One question to a real person; it waits, for days if need be, until it is answered.

    Attributes:
        kind: What is asked for: this hour's intention, its tasks, or in the evening feedback on the day.
        scene: The home.
        time: The hour in words, such as "9 am".
        today: What the person has set out to do today so far, in order, each with its time.
        rooms: The rooms of the home.
        intention: What the person wanted this hour ("tasks").
        places: Fixed objects near to the intention, nearest first: {name: room} ("tasks").
        things: Movable objects near to it, in collaboration type 1: {name: room} ("tasks").
        motions: Example motions, in collaboration type 2 ("tasks").
        can: What can be done at some of the places, in type 2: {name: motions} ("tasks").
        n_tasks: How many tasks there should be ("tasks").
        items: The robot's candidates in words, each to be judged ("feedback").
        cards: The same, hour by hour, with what happened then ("feedback").
        of: How many candidates there were, before those that say the same were taken together and some drawn
            ("feedback").
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
    scene: str = ""
    rooms: list[str] = []
    today: list[str] = []
    intention: str = ""
    places: dict[str, str] = {}
    things: dict[str, str] = {}
    motions: list[str] = []
    can: dict[str, list[str]] = {}
    n_tasks: int = 0
    items: list[str] = []
    cards: list[Card] = []
    of: int = 0
    graded: bool = False
    problem: str = ""
