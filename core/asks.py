"""What may be asked of a language model: per prompt its role, its reply, and the variables code supplies.

A prompt file may use any subset of the variables listed here, and no other. Values are plain JSON data:

- a *memory* is `{"when": "day 1, 9 am", "hours_ago": 3, "text": "..."}`, best first; a robot's also have `source`:
  "told" by the person of an earlier day, "seen" today, or only "guessed" today, which nobody has confirmed;
- `told` are hours of earlier days that the person told a robot of, `{"when", "hours_ago", "intention", "tasks",
  "weight"}`, the most telling first: for intentions those that looked like this hour, for tasks those of like
  intentions. `weight` from 0 to 1 is how much an hour counts. It is empty where a method does without;
- `in_hand` is the thing in the person's hand, to be offered by nobody; None where that is not known or not to count;
- `fixed` and `movable` are `{object name: [id, room]}`: all of the home where an intention is asked for (`movable` is
  empty in type 2), else those that were found for it; `big_five` is `{trait: score}`;
- a *task* is `{"id", "thought", "text", "act"}`, `text` being the act in words;
- `can` is `{furniture: [captions of motions that can be done there]}` for the kinds of furniture that were found first;
  what can be done anywhere is named at none;
- `states` is `{object: its states in words}`, such as "open" or "dirty", of all that is not as at first: for the person
  in their whole home, for the robot where it is and in what it saw;
- `changes` are what is different in the person's life these days, `{"kind", "text", "strength", "more", "never",
  "work"}`, the last four as `coopera.graphs.players.changes` has them;
- `side` is one side of the person's life in their own words, whose turn it is; `rhythm` says which day of the week it
  is and what the profile and the changes say of such a day; `earlier_days` is what they did on earlier days in one
  line, empty on the first day and where they remember today alone;
- `may_go_on` and `may_leave` say whether an intention may go on for hours, and whether the person may leave the home;
- `now_at` is `{thing: where it is now}`, such as "on desk_1", of the things that the drafted tasks are about;
- `so_far` are the tasks, in words, of the hour that the intention goes on from; empty for a new one;
- `steps` are a real person's own words for the tasks, empty for a simulated one;
- `guesses` and `offers` are the robot's candidates, as persons and judges are asked about them: intentions are texts,
  tasks have `text` and `thought`;
- in the classifiers' instruction `big_five` is a text, `intentions` and `tasks` are texts, and `place` is the
  candidate's place in the robot's list, from 1, or None;
- `seen` is the first task as the robot saw it, in words, which is over by now; None where it has no words for it;
- `direct` says whether the robot goes straight from what it saw, without an intention; `intention` is then what it saw;
- `percept` is a `Percept` as data with its `caption`, or None where the model looks at the pictures.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from coopera.core.protocols import Role

_MEMORY = ("recalled_intentions", "recalled_tasks")
_PERSON = ("person", "name", "big_five", "profile")  # `person` is the id
_TIME = ("time", "hour", "weekday", "day")
_VARIETY = ("side", "rhythm", "earlier_days")
_BELIEF = ("big_five", "profile")  # inferred by the robot; None before the first evening


class AskSpec(NamedTuple):
    """The contract of one prompt."""

    role: Role
    reply: str
    variables: frozenset[str]


def _spec(role: Role, reply: str, *variables: str) -> AskSpec:
    return AskSpec(role, reply, frozenset(variables))


ASKS: dict[str, AskSpec] = {
    "persona/profile": _spec("human", "ProfileReply", "name", "profile_1", "profile_2", "conversation"),
    "persona/big_five": _spec("human", "BigFiveReply", "profile"),
    "persona/big_five_test": _spec("human", "BigFiveTestReply", "profile", "statements"),
    "human/intention": _spec(
        "human",
        "IntentionReply",
        *_TIME,
        *_PERSON,
        *_MEMORY,
        *("rooms", "fixed", "movable", "states", "today", "changes", "may_go_on", "may_leave", *_VARIETY),
    ),
    "human/day": _spec(
        "human",
        "DayReply",
        *("weekday", "day", *_PERSON, "rooms", "fixed", "movable", "hours", "changes", "may_leave", *_VARIETY),
    ),
    "human/tasks_type1": _spec(
        "human",
        "PickPlaceReply",
        *_TIME,
        *_PERSON,
        *_MEMORY,
        *("intention", "fixed", "movable", "states", "so_far", "n_tasks", "steps"),
    ),
    "human/tasks_type2": _spec(
        "human",
        "FreeMotionReply",
        *_TIME,
        *_PERSON,
        *_MEMORY,
        *("intention", "fixed", "motions", "can", "states", "so_far", "n_tasks", "steps"),
    ),
    "human/reflect_profile_type1": _spec(
        "human", "PickPlaceReflectionReply", *_TIME, *_PERSON, *_MEMORY, "intention", "fixed", "movable", "tasks"
    ),
    "human/reflect_profile_type2": _spec(
        "human", "FreeMotionReflectionReply", *_TIME, *_PERSON, *_MEMORY, "intention", "fixed", "tasks"
    ),
    "human/reflect_scene_type1": _spec(
        "human",
        "PickPlaceReflectionReply",
        *_TIME,
        *_PERSON,
        *("intention", "fixed", "movable", "states", "now_at", "tasks", "n_tasks", "findings"),
    ),
    "human/reflect_scene_type2": _spec(
        "human",
        "FreeMotionReflectionReply",
        *_TIME,
        *_PERSON,
        *("intention", "fixed", "motions", "can", "states", "tasks", "n_tasks", "findings"),
    ),
    "human/feedback_intentions": _spec("human", "VerdictsReply", *_TIME, *_PERSON, "intention", "guesses"),
    "human/feedback_tasks": _spec("human", "VerdictsReply", *_TIME, *_PERSON, "intention", "tasks", "offers"),
    "human/grade_intentions": _spec("human", "GradesReply", *_TIME, *_PERSON, "intention", "guesses"),
    "human/grade_tasks": _spec("human", "GradesReply", *_TIME, *_PERSON, "intention", "tasks", "offers"),
    "robot/traits": _spec("robot", "TraitsReply", "intentions", "tasks", "profile", "evening"),
    "robot/intentions": _spec(
        "robot", "IntentionsReply", *_TIME, *_BELIEF, *_MEMORY, "told", "rooms", "percept", "first_task", "n_intentions"
    ),
    "robot/tasks_type1": _spec(
        "robot",
        "PickPlaceReply",
        *_TIME,
        *_BELIEF,
        *_MEMORY,
        *("told", "intention", "fixed", "movable", "states", "first_task", "direct", "n_tasks"),
    ),
    "robot/tasks_type2": _spec(
        "robot",
        "HandOverReply",
        *_TIME,
        *_BELIEF,
        *_MEMORY,
        *("told", "in_hand", "intention", "fixed", "states", "seen", "direct", "n_tasks"),
    ),
    "judge/tasks": _spec("judge", "VerdictsReply", "time", "intention", "tasks", "offers"),
}
"""By prompt, in the order in which they are asked in an hour and in an evening."""


class InstructionSpec(NamedTuple):
    """The contract of the text that a classifier is tuned on: it is never asked, its next token is weighed."""

    role: Literal["classifier"]
    reply: Literal["YesOrNo"]
    variables: frozenset[str]


INSTRUCTION = "classifier/instruction"
PROMPTS: dict[str, AskSpec | InstructionSpec] = {
    **ASKS,
    INSTRUCTION: InstructionSpec(
        "classifier",
        "YesOrNo",
        frozenset(("candidate", "intention", "profile", "big_five", "intentions", "tasks", "time", "place")),
    ),
}
"""All prompts: those that are asked, and the classifiers' instruction."""
