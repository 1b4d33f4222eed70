"""A real person at the terminal: shows what is asked, and reads the answer line by line."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from rich.console import Console

from coopera.core.errors import WaitingError
from coopera.core.interview import MOST_STEPS, Answer, Question
from coopera.core.naming import printable

LATER = "later"

_HOW_1 = 'Per task say what goes where: "thing | place" by number or name, such as "2 | 1", or in your own words.'
_HOW_2 = (
    'Per task say "place | motion | thing in your hand", place and motion by number or in words, such as '
    '"1 | 3 | mug", or say it in your own words. A robot brings the thing in your hand; it may be any small thing.'
)


class Terminal:
    """Asks on a console; `read` gives the next line and raises EOFError when there is none (input by default)."""

    def __init__(self, console: Console | None = None, read: Callable[[], str] = input) -> None:
        self._console = console or Console(stderr=True, highlight=False, soft_wrap=True)
        self._read = read

    def __call__(self, question: Question) -> Answer:
        """Ask one question.

        Raises:
            WaitingError: If the person says "later" or is gone; the question then waits in the run.
        """
        self._console.rule(align="left")
        self._say(f"{question.weekday}, {question.time}. You are {question.name}.")
        if question.problem:
            self._console.print(printable(question.problem), style="yellow", markup=False)
        if question.kind == "intention":
            return self._intention(question)
        return self._tasks(question) if question.kind == "tasks" else self._feedback(question)

    def _intention(self, question: Question) -> str:
        if question.today:
            self._say("Today so far:")
            self._list(question.today, bullet="-")
        self._say(f"Your rooms: {', '.join(question.rooms)}.")
        self._say(f'What do you want to do this hour, in one sentence? ("{LATER}" stops here and waits for you.)')
        return self._line(question)

    def _tasks(self, question: Question) -> list[str]:
        self._say(f'You want to: "{question.intention}".')
        if question.things:
            self._say("Things you may move:")
            self._list(f"{name} ({room})" for name, room in question.things.items())
        self._say("Places nearby:")
        self._list(f"{name} ({room})" for name, room in question.places.items())
        if question.motions:
            self._say("Motions, for example:")
            self._list(question.motions)
        self._say(_HOW_1 if question.collab == 1 else _HOW_2)
        self._say(f"{question.n_tasks} tasks are usual; an empty line ends the list.")
        steps: list[str] = []
        while len(steps) < MOST_STEPS:
            self._console.print(f"{len(steps) + 1}>", end=" ")
            if not (line := self._line(question)):
                break
            steps.append(line)
        return steps

    def _feedback(self, question: Question) -> list[str]:
        self._say(f'You wanted to: "{question.intention}". You did:')
        self._list(question.tasks, bullet="-")
        how = "from 1 (of no use) to 5 (just what you needed)" if question.graded else "yes or no"
        self._say(f'The robot thought of this. Was it right? Answer {how}, with a reason if you like: "no, too early".')
        answers = []
        for number, item in enumerate(question.items, 1):
            self._say(f"{number}. {item}")
            self._console.print(">", end=" ")
            answers.append(self._line(question))
        return answers

    def _line(self, question: Question) -> str:
        try:
            line = self._read().strip()
        except EOFError:
            line = LATER
        if line.lower() == LATER:
            raise WaitingError(f"The run waits for {question.name}: day {question.day}, {question.time}.")
        return line

    def _say(self, text: str) -> None:
        self._console.print(printable(text), markup=False)

    def _list(self, items: Iterable[str], bullet: str = "") -> None:
        for number, item in enumerate(items, 1):
            self._say(f"  {bullet or number} {item}")
