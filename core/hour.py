"""The hour of a person and of a robot: intentions, tasks, candidates, and the record of it all."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from markupsafe import Markup
from pydantic import Field

from coopera.core.clock import Clock
from coopera.core.household import Act, Collab, ObjectMap, Outcome, Percept, SceneId
from coopera.core.notebook.cards import bar, card, note, table
from coopera.core.people import Belief, BigFive, Circumstance, Frozen, PersonId, is_empty, is_none
from coopera.core.setting import Setting
from coopera.core.success import Success

CandidateKind: TypeAlias = Literal["intention", "task"]
"""The kinds of candidates: the robot imagines them, and a classifier gives a verdict on each."""


class Reasons(Frozen):
    """Why: the person's traits, earlier intentions, earlier tasks, and (robot only) what was seen."""

    human: str = ""
    intentions: str = ""
    tasks: str = ""
    vision: str = ""


class Intention(Frozen):
    """What the person is up to this hour: high level, naming no object.

    Attributes:
        text: In words.
        reasons: Why, where a model has said so.
        continues: Whether it goes on with what was begun in an earlier hour of the day.
        away: Whether the person is outside the home: no tasks, and the robot has nothing to see.
        wants: The furniture and things that it is done with, in a few words each; empty where nobody has said so.
    """

    text: str
    reasons: Reasons = Reasons()
    continues: bool = False
    away: bool = False
    wants: list[str] = Field([], exclude_if=is_empty)


class Task(Frozen):
    """One step of an intention; `id` is "<hour>.<number from 1>", as in "9.2"."""

    id: str
    thought: str
    reasons: Reasons = Reasons()
    act: Act


class Recalled(Frozen):
    """One retrieved memory: score = recency x relevance (PAPER §3.2).

    `source`, where a robot recalls: told by the person in an evening; seen today; or guessed today, which nobody has
    confirmed.
    """

    kind: CandidateKind
    text: str
    hour: int
    relevance: float
    recency: float
    score: float
    source: Literal["told", "seen", "guessed"] | None = Field(None, exclude_if=is_none)


class Found(Frozen):
    """What Search found for an intention: objects the tasks may use, and example motions."""

    fixed: ObjectMap
    movable: ObjectMap
    motions: list[str]


class SearchSizes(Frozen):
    """How many objects and motions Search finds for an intention, at most: 30 and 5 in the authors' code.

    In collaboration type 1 as many of the fixed and as many of the movable objects.
    """

    objects: Annotated[
        int,
        Field(strict=True, ge=1, le=1000),
        Setting("Objects the person is offered for an intention.", flag="--search-objects"),
    ] = 30
    motions: Annotated[
        int,
        Field(strict=True, ge=1, le=1000),
        Setting("Motions the person is offered for an intention.", flag="--search-motions"),
    ] = 5


class TaskVerdict(Frozen):
    """What a reflection says of one task."""

    ok: bool
    comment: str = ""


class Reflection(Frozen):
    """One round of reflection: verdicts by task, and what it changed (before -> after).

    `overruled` are changes that were not made, since the other reflection changed the same task, or there were enough.
    """

    node: Literal["reflect_profile", "reflect_scene"]
    verdicts: list[TaskVerdict]
    changes: list[str]
    overruled: list[str] = Field([], exclude_if=is_empty)


class HumanHour(Frozen):
    """All that the human graph did in an hour."""

    recalled: list[Recalled]
    intention: Intention
    found: Found
    tasks: list[Task]
    reflections: list[Reflection]
    circumstances: list[Circumstance] = []
    """What was different in the person's life that day."""
    repairs: list[str] = []
    """Tasks that code had to mend after both reflections, as sentences."""


class LoggedHour(Frozen):
    """What a real person wrote down of an hour: the intention and, where known, the tasks in their own words.

    `continues` and `away` as in `Intention`.
    """

    day: int = Field(ge=0)
    hour: int = Field(ge=0, le=23)
    intention: str = Field(min_length=1, max_length=300)
    tasks: Annotated[list[Annotated[str, Field(min_length=1, max_length=300)]], Field(max_length=8)] = []
    continues: bool = False
    away: bool = False


class Observation(Frozen):
    """What the robot is given of the hour: neither the intention nor a task after the first.

    `frames`: picture files, relative to the run directory, robot views first. `percept`: set if none are looked at.
    `first_task`: the text of the first task, in collaboration type 1 only (PAPER §3.1).
    """

    frames: list[str] = []
    percept: Percept | None = None
    first_task: str | None = None


class IntentionCandidate(Frozen):
    """An intention the robot imagines; whether it was right stands in the evening's feedback. `evidence`: `Example`."""

    text: str
    reasons: Reasons = Reasons()
    evidence: dict[str, float] = Field({}, exclude_if=is_empty)
    probability: float | None = None
    accepted: bool | None = None


class TaskCandidate(Frozen):
    """A task the robot imagines for one of its intentions (by text). `correct`: predicate success."""

    intention: str
    thought: str
    reasons: Reasons = Reasons()
    act: Act
    evidence: dict[str, float] = Field({}, exclude_if=is_empty)
    probability: float | None = None
    accepted: bool | None = None
    correct: bool | None = None


class RobotHour(Frozen):
    """All that the robot graph did in an hour."""

    observation: Observation
    seen: str = Field("", exclude_if=is_empty)
    """What its language model says it saw, before it guessed; a robot that looks at pictures recalls by this."""
    recalled: list[Recalled] = []
    intentions: list[IntentionCandidate]
    tasks: list[TaskCandidate]
    outcomes: list[Outcome] = []
    fallbacks: list[str] = []
    """Which defined fallbacks were used, e.g. "no intention accepted"."""
    with_whom: PersonId | None = None
    """Whom the robot took the person for, where the identity is unknown."""
    belief: Belief | None = None
    """The robot's belief in this hour, where traits are inferred each hour."""


class Proposal(Frozen):
    """A robot's answer to an hour: its candidates with its verdicts. Each `accepted` must be set; see `RobotHour`.

    The tasks are the superset that success is measured over; the accepted ones are then done, most probable first.
    """

    intentions: list[IntentionCandidate] = []
    tasks: list[TaskCandidate] = []
    recalled: list[Recalled] = []
    fallbacks: list[str] = []


class ModelCall(Frozen):
    """One call through the one door, as it stands in the trace."""

    node: str
    prompt: str
    prompt_sha: str
    model: str
    messages: list[dict[str, Any]]
    reply: str
    seconds: float = 0.0
    tokens_in: int = 0
    tokens_out: int = 0
    attempts: int = 1
    cached: bool = False
    faults: list[str] = []
    leniencies: dict[str, int] = Field({}, exclude_if=is_empty)
    """What was put right in the form of the reply, and how often, by kind (`coopera.models.reading.fitting`)."""
    late: bool = Field(False, exclude_if=is_empty)
    """Whether it belongs to an hour and was made in the evening, when nobody waited for it."""


class HourRecord(Frozen):
    """The file trace/day-DD/hour-HH.json; `episode` and `episode_day` as in `DayPlan`."""

    day: int
    episode: int
    episode_day: int
    hour: int
    person: PersonId
    scene: SceneId
    human: HumanHour | None
    robot: RobotHour | None
    world: dict[str, Any]
    success: Success | None
    status: Literal["ok", "failed"]
    reason: str = ""
    calls: list[ModelCall] = []

    def _repr_html_(self) -> str:
        """The hour on a card in a notebook."""
        human, robot = self.human, self.robot
        clock = Clock(day=self.episode_day, hour=self.hour)
        where = f"{clock.weekday}, {clock.label}: {self.person} in {self.scene} (day {self.day}, {self.status})"
        body = [note(self.reason)] if self.reason else []
        if human:
            body.append(table(["the person did"], [[task.act.describe()] for task in human.tasks]))
        if robot:
            said = [[one.text, bar(one.probability), _yes(one.accepted)] for one in robot.intentions]
            body.append(table(["the robot thought", "chance", "accepted"], said))
            marks = [
                [one.act.describe(), bar(one.probability), _yes(one.accepted), _yes(one.correct)] for one in robot.tasks
            ]
            body.append(table(["and offered", "chance", "accepted", "right"], marks))
        return card(human.intention.text if human else "No intention", where, *body)


def _yes(answer: bool | None) -> Markup:
    """A tick or a cross, which those who do not see them are told in words."""
    if answer is None:
        return Markup("–")
    mark = '<span style="color:{}" role="img" aria-label="{}">{}</span>'
    return Markup(mark).format(*(("#2b8a4d", "yes", "✓") if answer else ("#c0483a", "no", "✗")))


class FeedbackItem(Frozen):
    """The person's yes or no, with a reason, to one candidate of the robot."""

    hour: int
    kind: CandidateKind
    text: str
    accepted: bool
    helpful: bool | None
    """None where the person gave no answer, or none that could be read: no label is made of it."""
    reason: str = ""
    grade: int | None = Field(None, ge=1, le=5)
    """How helpful, from 1 to 5, where feedback is graded."""
    asked: bool = Field(True, exclude_if=bool)
    """Whether a real person was asked: not about what was left out since there were too many questions."""
    answered_as: str = Field("", exclude_if=is_empty)
    """The text of what they were asked in its place, since it says nearly the same."""
    slip: bool = False
    """Whether the person said the opposite of what they meant; for the trace, never for the robot."""


class HourAccount(Frozen):
    """The person's account of one hour, given in the evening: the intention, the tasks, and feedback on the candidates.

    `robot` is the robot's own hour. In it `correct` is None throughout: an account holds no measure.
    """

    hour: int
    intention: str
    tasks: list[Act]
    robot: RobotHour
    feedback: list[FeedbackItem] = []


class DayAccount(Frozen):
    """All that a robot learns from in the evening of a day. `day` is the person's own calendar, from 0 (`episode_day`).

    `belief` is what the robot believes of the person since this evening. Hours that failed are left out.
    """

    person: PersonId
    day: int
    hours: list[HourAccount]
    belief: Belief = Belief()


class Evening(Frozen):
    """The file trace/day-DD/evening.json; `episode` and `episode_day` as in `DayPlan`."""

    day: int
    episode: int
    episode_day: int
    person: PersonId
    scene: SceneId
    feedback: list[FeedbackItem]
    belief: Belief
    traits_reasons: dict[str, str] = {}
    learned: dict[str, Any] = {}
    calls: list[ModelCall] = []


class DayPlan(Frozen):
    """One day of a schedule: its person, its home and its hours.

    `day` numbers the days of a run and names the day's folder. An `episode` is one robot's time with its people: the
    robot's knowledge starts anew with each episode. `episode_day` (from 0) is the day within the episode. Learning
    curves count by it, and it is the person's own calendar.
    """

    day: int = Field(ge=0)
    episode: int = Field(0, ge=0)
    episode_day: int = Field(ge=0)
    person: PersonId
    scene: SceneId
    hours: list[int]
    collab: Collab = 2

    def clock(self, position: int) -> Clock:
        """The hour at a position of the day, in the person's calendar."""
        return Clock(day=self.episode_day, hour=self.hours[position])


class Example(Frozen):
    """What a yes/no classifier is shown, in the paper's fields (PAPER App. C.2), and the label.

    `person` keeps people apart. `candidate` is the intention's text or the task's description. `evidence` is what was
    estimated and counted before any verdict (`coopera.graphs.robots.evidence`).
    """

    person: PersonId
    day: int
    hour: int
    candidate: str
    intention: str = ""
    """For a task: the intention it belongs to."""
    profile: str = ""
    big_five: BigFive | None = None
    intentions: list[str] = []
    """Previous relevant intentions, best first."""
    tasks: list[str] = []
    """Previous relevant tasks, best first."""
    rank: int | None = Field(None, ge=0)
    """Place of the intention (for a task: of its intention) among the robot's candidates, 0 being the first.

    None where the robot did not imagine it, or where its order is not to be known.
    """
    evidence: dict[str, float] = Field({}, exclude_if=is_empty)
    counts: float = Field(1.0, gt=0, le=1, exclude_if=lambda counts: counts == 1)
    """How much it still counts, where the person has changed since. Classifiers that cannot weigh leave it out."""
    label: bool | None = None

    def but(self, **changes: Any) -> Example:
        """Return the example with other values; itself where it has these already, since there are thousands."""
        same = all(getattr(self, name) == value for name, value in changes.items())
        return self if same else self.model_copy(update=changes)
