"""A real person at the terminal: shows what is asked, and reads and checks the answer line by line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from rich.console import Console

from coopera.core.errors import WaitingError
from coopera.core.interview import MOST_STEPS, Answer, Card, Entry, Question
from coopera.core.naming import printable
from coopera.graphs.players.real_person import read_intention, read_step, read_verdict
from coopera.people.answers import Answers, Check, Sitting

LATER, UNDO = "later", "undo"

_HOW_1 = 'Per task say what goes where: "thing | place" by number or name, such as "2 | 1", or in your own words.'
_HOW_2 = (
    'Per task say "place | motion | thing in your hand", place and motion by number or in words, such as '
    '"1 | 3 | mug", or say it in your own words. A robot brings the thing in your hand; it may be any small thing.'
)


def _reads(question: Question, line: str) -> str:
    return read_step(line, question)


class Terminal:
    """Asks on a console; `read` gives the next line and raises EOFError when there is none (input by default).

    Each line is checked when it is given, and kept in the run once the run is known (`attend`).
    """

    def __init__(self, console: Console | None = None, read: Callable[[], str] = input) -> None:
        self._console = console or Console(stderr=True, highlight=False, soft_wrap=True)
        self._read = read
        self._check: Check = _reads
        self._answers: Answers | None = None
        self._sitting: Sitting | None = None

    def attend(self, sitting: Sitting) -> None:
        """Keep what is said in a run, and check each step there."""
        self._sitting, self._check, self._answers = sitting, sitting.check, Answers(sitting.root)

    def __call__(self, question: Question) -> Answer:
        """Ask one question.

        Raises:
            WaitingError: If the person says "later" or is gone; the question then waits in the run.
        """
        self._welcome(question)
        if self._answers and (given := self._answers.final(question)) is not None:
            return given
        self._console.rule(align="left")
        when = f"{question.weekday}, {'evening' if question.kind == 'feedback' else question.time}"
        self._say(f"{when}. You are {question.name}.")
        if question.problem:
            self._problem(question.problem)
        if question.kind == "intention":
            answer: Answer = self._intention(question)
        else:
            answer = self._tasks(question) if question.kind == "tasks" else self._feedback(question)
        return self._answers.give(question, answer) if self._answers else answer

    def _welcome(self, question: Question) -> None:
        """Before the first question: who is it, and do they agree?"""
        if self._sitting is None or self._answers is None or self._answers.participant().id:
            return
        consent, id = self._sitting.consent(), self._sitting.config.real_person.participant
        if not consent and not id:
            return
        if consent:
            self._say(consent)
        while not id:
            self._say("Your participant number?")
            id = self._line(question)
        while consent and self._line_after('Do you agree? ("yes" goes on)', question).lower() not in {"y", "yes"}:
            self._problem('Without a "yes" nothing is asked.')
        self._answers.agree(id, consent)

    def _intention(self, question: Question) -> str:
        if question.today:
            self._say("Today so far:")
            self._list(question.today, bullet="-")
        self._say(f"Your rooms: {', '.join(question.rooms)}.")
        self._say(f'What do you want to do this hour, in one sentence? ("{LATER}" stops here and waits for you.)')
        while True:
            try:
                return read_intention(self._line(question))
            except ValueError as err:
                self._problem(str(err))

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
        self._say(f'{question.n_tasks} tasks are usual; an empty line ends the list, "{UNDO}" takes the last one back.')
        steps = self._kept(question)
        while len(steps) < MOST_STEPS:
            line = self._line_after(f"{len(steps) + 1}>", question, end=" ")
            if line.lower() == UNDO:
                steps = self._keep(question, steps[:-1])
            elif line:
                try:
                    steps = self._keep(question, [*steps, self._check(question, line)])
                except ValueError as err:
                    self._problem(str(err))
            elif steps:
                break
            else:
                self._problem("Please give at least one step.")
        return steps

    def _feedback(self, question: Question) -> list[str]:
        how = "from 1 (of no use) to 5 (just what you needed)" if question.graded else "yes or no"
        self._say(f'The robot thought of this. Was it right? Answer {how}, with a reason if you like: "no, too early".')
        self._say(f'"skip" leaves it open, "{UNDO}" goes back to the one before.')
        if question.of > len(question.items):
            self._say(f"You are asked {len(question.items)} things of {question.of}.")
        answers = self._kept(question)
        asked = [(card, entry) for card in _cards(question) for entry in card.entries]
        shown: Card | None = None
        while len(answers) < len(asked):
            card, entry = asked[len(answers)]
            if card is not shown:
                self._card(shown := card)
            self._say(f"{len(answers) + 1}. {_said(question, entry)}")
            line = self._line_after(">", question, end=" ")
            if line.lower() == UNDO:
                answers = self._keep(question, answers[:-1])
                continue
            try:
                read_verdict(line, len(answers) + 1, question.graded)
            except ValueError as err:
                self._problem(str(err))
            else:
                answers = self._keep(question, [*answers, line])
        return answers

    def _card(self, card: Card) -> None:
        if card.intention:
            self._say(f'{card.time}: you wanted to: "{card.intention}". You did:')
            self._list(card.tasks, bullet="-")
        if card.robot:
            self._say("The robot did:")
            self._list(card.robot, bullet="-")

    def _kept(self, question: Question) -> list[str]:
        kept = self._answers.draft(question).lines if self._answers and not question.problem else []
        if kept:
            self._say("Kept from before:")
            self._list(kept)
        return kept

    def _keep(self, question: Question, lines: list[str]) -> list[str]:
        if self._answers:
            self._answers.keep(question, lines)
        return lines

    def _line_after(self, prompt: str, question: Question, end: str = "\n") -> str:
        self._console.print(prompt, end=end, markup=False)
        return self._line(question)

    def _line(self, question: Question) -> str:
        try:
            line = self._read().strip()
        except EOFError:
            line = LATER
        if line.lower() == LATER:
            raise WaitingError(f"The run waits for {question.name}: day {question.day}, {question.time}.")
        return line

    def _problem(self, sentence: str) -> None:
        self._console.print(printable(sentence), style="yellow", markup=False)

    def _say(self, text: str) -> None:
        self._console.print(printable(text), markup=False)

    def _list(self, items: Iterable[str], bullet: str = "") -> None:
        for number, item in enumerate(items, 1):
            self._say(f"  {bullet or number} {item}")


def _cards(question: Question) -> Sequence[Card]:
    """The evening's cards; of a question without any, one with all items."""
    entries = [Entry(item=number, kind="task") for number in range(len(question.items))]
    return question.cards or [Card(hour=question.hour, time=question.time, intention="", entries=entries)]


def _said(question: Question, entry: Entry) -> str:
    said = question.items[entry.item]
    return f"{said}, for: {entry.under}" if entry.under else f"You were going to: {said}" if question.cards else said
