"""Questions to the offline model as the graphs put them, and a home to put them in."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from langchain_core.embeddings import Embeddings
from langchain_core.messages import HumanMessage

from coopera.core.asks import ASKS
from coopera.core.big_five_test import ITEMS
from coopera.core.clock import Clock
from coopera.core.household import FreeMotion, Percept, PickPlace
from coopera.core.replies import REPLIES
from coopera.models.offline.chat import OfflineChatModel
from coopera.models.offline.household.knowledge import shipped
from coopera.models.offline.household.reading import class_of

ROOMS = [
    "bathroom",
    "bedroom",
    "dining room",
    "hallway",
    "hobby room",
    "kitchen",
    "laundry room",
    "living room",
    "study",
]
_ROOM_OF = {"bathtub": "bathroom", "washbasin": "bathroom", "bed": "bedroom", "dining_table": "dining room"}


class WordEmbeddings(Embeddings):
    """Unit vectors of hashed words: texts are near each other by shared words. Fast, and the same everywhere."""

    @lru_cache(maxsize=10_000)  # noqa: B019 - lives as long as the test run
    def embed_query(self, text: str) -> list[float]:
        vector = np.full(256, 1e-3)
        for word in text.lower().replace("_", " ").split():
            vector[int.from_bytes(hashlib.sha256(word.strip(".,!?").encode()).digest()[:2], "little") % 256] += 1.0
        return [float(value) for value in vector / np.linalg.norm(vector)]

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [self.embed_query(text) for text in texts]


WORDS = WordEmbeddings()
_NOTHING: dict[str, Any] = {
    "steps": [],
    "so_far": [],
    "seen": None,
    "direct": False,
    "can": {},
    "states": {},
    "changes": [],
    "may_go_on": False,
    "may_leave": False,
    "now_at": {},
    "told": [],
    "in_hand": None,
    "side": "I love to bake.",
    "rhythm": "Monday, the first day of the week",
    "earlier_days": "",
}


@lru_cache(maxsize=3)
def model(role: str) -> OfflineChatModel:
    """A role by its rules alone: whatever it plays, it knows the person's household file."""
    return OfflineChatModel(role=role, embeddings=WORDS, household=shipped())  # type: ignore[arg-type]


def ask(prompt: str, *, seed: int = 0, temperature: float = 0.7, **variables: Any) -> Any:
    """Ask as the door does: plain JSON data in, the prompt's reply type out."""
    return ask_model(model(ASKS[prompt].role), prompt, seed=seed, temperature=temperature, **variables)


def ask_model(chat: OfflineChatModel, prompt: str, *, seed: int = 0, temperature: float = 0.7, **variables: Any) -> Any:
    for name, nothing in _NOTHING.items():
        if name in ASKS[prompt].variables:
            variables.setdefault(name, nothing)
    assert set(variables) == set(ASKS[prompt].variables)
    asked = {"prompt": prompt, "variables": json.loads(json.dumps(variables)), "seed": seed, "temperature": temperature}
    reply = chat.invoke([HumanMessage("(the rendered prompt)", additional_kwargs={"coopera": asked})])
    return REPLIES[ASKS[prompt].reply].model_validate_json(str(reply.content))


def home() -> tuple[dict[str, Any], dict[str, Any]]:
    """A home with one of everything that the household file speaks of, and two mugs and two desks."""
    household = shipped()
    fixed = sorted({cls for a in household.activities for cls in (*a.fixed, *(spot for _, spot in a.places))})
    movable = sorted({thing for a in household.activities for thing, _ in a.places})
    rooms = {cls: a.rooms[0] for a in reversed(household.activities) for cls in a.fixed} | _ROOM_OF
    names = [f"{cls}_1" for cls in fixed] + ["desk_2"]
    things = [f"{cls}_1" for cls in movable] + ["mug_2"]
    return (
        {name: (i, rooms.get(class_of(name), "living room")) for i, name in enumerate(sorted(names))},
        {name: (500 + i, "living room") for i, name in enumerate(sorted(things))},
    )


FIXED, MOVABLE = home()


def when(day: int, hour: int) -> dict[str, Any]:
    clock = Clock(day=day, hour=hour)
    return {"time": clock.label, "hour": hour, "weekday": clock.weekday, "day": day}


def person(name: str = "mara", profile: str = "I love to bake. I am a neat person.", **traits: float) -> dict[str, Any]:
    scores = dict.fromkeys(("openness", "conscientiousness", "extroversion", "agreeableness", "neuroticism"), 3.0)
    return {"person": name, "name": name.title(), "big_five": scores | traits, "profile": profile}


def memory(text: str, day: int, hour: int, now: Clock) -> dict[str, Any]:
    then = Clock(day=day, hour=hour)
    label = then.label if day == now.day else f"day {day + 1}, {then.label}"
    return {"when": label, "hours_ago": now.now - then.now, "text": text}


def intend(who: dict[str, Any], hour: int, *, seed: int = 0, day: int = 0, **changed: Any) -> Any:
    """human/intention with nothing recalled, unless `changed` says otherwise."""
    temperature = changed.pop("temperature", 0.7)
    nothing = {"recalled_intentions": [], "recalled_tasks": [], "states": {}, "today": []}
    given = {**nothing, "rooms": ROOMS, "fixed": FIXED, "movable": {}, **changed}
    return ask("human/intention", seed=seed, temperature=temperature, **when(day, hour), **who, **given)


def live(who: dict[str, Any], day: int = 0, seed: int = 0, rooms: Sequence[str] = ROOMS) -> list[str]:
    """The intentions of a day, each knowing those before it."""
    lived: list[str] = []
    for hour in range(9, 22):
        now = Clock(day=day, hour=hour)
        today = [memory(text, day, 9 + i, now) for i, text in enumerate(lived)]
        reply = intend(who, hour, seed=1000 * seed + 100 * day + hour, day=day, today=today, rooms=list(rooms))
        lived.append(reply.intention)
    return lived


def left_by(reply: Any, tasks: Sequence[Any]) -> list[Any]:
    """The acts that a reflection leaves of some tasks as prompts have them, by the rule of `coopera.core.replies`."""
    after = [task["act"] if said.yes else said.task for task, said in zip(tasks, reply.reviews, strict=True)]
    kind: Any = PickPlace if "object" in tasks[0]["act"] else FreeMotion
    kept = [kind.model_validate(one) if isinstance(one, dict) else one.act for one in after if one is not None]
    return [*kept, *(draft.act for draft in reply.add)]


def as_tasks(drafts: Sequence[Any], hour: int = 10) -> list[dict[str, Any]]:
    """Drafts as the graphs hand tasks on."""
    return [
        {"id": f"{hour}.{n}", "thought": d.thought, "text": d.act.describe(), "act": d.act.model_dump(exclude={"kind"})}
        for n, d in enumerate(drafts, start=1)
    ]


def percept(**seen: Any) -> dict[str, Any]:
    what = Percept(**{"room": "kitchen", "near": [], "motion": "", "in_hand": None, **seen})
    return {**what.model_dump(), "states": what.states, "caption": what.caption()}


def imagine(*, hour: int = 10, day: int = 0, n: int = 5, **changed: Any) -> Any:
    """robot/intentions knowing nothing, unless `changed` says otherwise."""
    given = {
        "big_five": None,
        "profile": None,
        "recalled_intentions": [],
        "recalled_tasks": [],
        "rooms": ROOMS,
        "percept": percept(),
        "first_task": None,
        **changed,
    }
    return ask("robot/intentions", **when(day, hour), **given, n_intentions=n)


def activity(text: str) -> str:
    """Id of the activity that one of its own wordings names, touch or no touch."""
    known = shipped().named(text)
    assert known is not None, f"{text!r} is no wording of the household file"
    return known.id


def sample(prompt: str) -> dict[str, Any]:
    """Plausible variables for any prompt."""
    drafts2 = ask("human/tasks_type2", **{k: _ALL[k] for k in ASKS["human/tasks_type2"].variables}).tasks
    drafts1 = ask("human/tasks_type1", **{k: _ALL[k] for k in ASKS["human/tasks_type1"].variables}).tasks
    tasks = as_tasks(drafts1 if prompt.endswith("type1") else drafts2)
    return {name: tasks if name == "tasks" else _ALL[name] for name in ASKS[prompt].variables}


_ALL: dict[str, Any] = {
    **when(0, 10),
    **person(),
    "recalled_intentions": [],
    "recalled_tasks": [],
    "rooms": ROOMS,
    "today": [],
    "hours": ["9 am", "12 pm", "9 pm"],
    "intention": "Make a homemade treat",
    "seen": None,
    "direct": False,
    "intentions": [{"when": "9 am", "hours_ago": 12, "text": "Make a homemade treat"}],
    "fixed": FIXED,
    "movable": MOVABLE,
    "motions": [],
    "can": {},
    **_NOTHING,
    "n_tasks": 3,
    "n_intentions": 4,
    "findings": [],
    "guesses": ["Make a homemade treat", "Take a short nap"],
    "offers": [{"thought": "useful", "text": "bring the whisk"}],
    "percept": percept(),
    "first_task": None,
    "statements": [item.says for item in ITEMS],
    "evening": True,
    "profile_1": "I love to bake.\nI have two dogs.",
    "profile_2": "I am old.",
    "conversation": "User 1: Hi! I work in a bakery downtown.\nUser 2: I paint.",
}
