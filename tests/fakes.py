"""Fakes for whole rooms: small, working stand-ins that a graph cannot tell from the real thing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from langchain_core.embeddings import Embeddings

from coopera.core.affordances import affordances
from coopera.core.asks import ASKS
from coopera.core.hour import Evening, Example, HourRecord, ModelCall
from coopera.core.household import HUMAN, Act, AgentId, HandOver, ObjectMap, Outcome, Percept, PickPlace, SceneId
from coopera.core.people import BigFive, Persona, PersonId
from coopera.core.protocols import Role
from coopera.core.randomness import Address

MARA = Persona(
    id=PersonId("mara"),
    name="Mara",
    profile="I love to bake. I read crime novels.",
    big_five=BigFive(openness=4.5),
    notes="I love to bake.",
)


class LetterEmbeddings(Embeddings):
    """Unit vectors of letter counts: texts that share letters are near each other."""

    model_id = "letters"

    def embed_query(self, text: str) -> list[float]:
        counts = np.array([1e-3 + text.lower().count(chr(97 + n)) for n in range(26)])
        return [float(value) for value in (counts / np.linalg.norm(counts)).astype(np.float32)]

    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        return [self.embed_query(text) for text in texts]

    def __enter__(self) -> LetterEmbeddings:
        return self

    def __exit__(self, *error: object) -> None:
        """There is no file to close."""


class FakeHome:
    """Three fixed and three movable objects in two rooms; what fits, and is not `unfit`, works unless `broken`."""

    scene = SceneId("toy")
    rooms = ["kitchen", "study"]
    motions = ["wipe the surface", "sit and read", "stir a pot"]

    def __init__(self) -> None:
        self.fixed: ObjectMap = {"desk_1": (1, "study"), "sofa_1": (2, "study"), "stove_1": (3, "kitchen")}
        self.movable: ObjectMap = {"book_1": (4, "study"), "mug_1": (5, "kitchen"), "mug_2": (6, "kitchen")}
        self._built = dict(self.movable)
        self.performed: list[tuple[AgentId, Act, bool]] = []
        self.broken: set[str] = set()
        self.inhabitants: list[tuple[AgentId, PersonId]] = []
        self.said: dict[str, str] = {}
        self.unfit: set[tuple[str, str]] = set()
        self.late: list[Path] = []
        """Pictures that are there only once somebody has waited for them."""

    def objects(self, kind: Literal["fixed", "movable"]) -> ObjectMap:
        return dict(sorted((self.fixed if kind == "fixed" else self.movable).items()))

    def class_of(self, name: str) -> str:
        return name.rsplit("_", 1)[0]

    def misfit(self, agent: AgentId, act: Act) -> str:
        if isinstance(act, HandOver):
            if agent == HUMAN:
                return "Only the robot hands things over."
            return f"The {act.object} is furniture." if act.object in self.fixed else ""
        if isinstance(act, PickPlace):
            if wrong := _no_object(act.object, act.object_id, self.movable, "movable"):
                return wrong
            places = self.fixed if act.relation == "on" else {**self.fixed, **self.movable}
            if wrong := _no_object(act.receptacle, act.receptacle_id, places, "fixed"):
                return wrong
            holds = act.relation == "on" or affordances().contains(self.class_of(act.receptacle))
            return "" if holds else f"Nothing can be put into the {act.receptacle}."
        if wrong := _no_object(act.target, act.target_id, self.fixed, "fixed"):
            return wrong
        suits = affordances().suits(act.motion, self.class_of(act.target))
        fits = suits and (act.motion, act.target) not in self.unfit
        return "" if fits else f"Nobody can {act.motion} at the {act.target}."

    def states(self, room: str | None = None) -> dict[str, str]:
        places = {**self.fixed, **self.movable}
        return {name: said for name, said in sorted(self.said.items()) if room in (None, places[name][1])}

    def room_of(self, agent: AgentId) -> str:
        return "kitchen"

    def place_of(self, thing: str) -> str:
        return "on the floor" if thing in self.movable else ""

    def perform(self, agent: AgentId, act: Act, *, record: bool = False, watcher: AgentId | None = None) -> Outcome:
        self.performed.append((agent, act, record))
        if act.describe() in self.broken:
            return Outcome(agent=agent, act=act, ok=False, reason="out of reach")
        if isinstance(act, PickPlace):
            self.movable[act.object] = (act.object_id, self.fixed[act.receptacle][1])
        return Outcome(agent=agent, act=act, ok=True, metres=1.0)

    def percept(self, rng: np.random.Generator) -> Percept:
        return Percept(room="kitchen", near=["stove_1"], motion="stirring", in_hand=None, visible=["mug_1"])

    def frames(self, count: int, folder: Path, name: str | None = None, *, wait: bool = True) -> list[Path]:
        folder.mkdir(parents=True, exist_ok=True)
        views = ("robot", "human") if name is None else (name,)
        paths = [folder / f"{view}-{n}.webp" for view in views for n in range(count)]
        self.late += paths
        if wait:
            self._develop()
        return paths

    def frames_due(self) -> Callable[[], None] | None:
        return self._develop if self.late else None

    def _develop(self) -> None:
        for path in self.late:
            path.write_bytes(b"picture")
        self.late = []

    def inhabit(self, agent: AgentId, person: Persona) -> None:
        self.inhabitants.append((agent, person.id))

    def snapshot(self) -> dict[str, Any]:
        return {"movable": {name: list(place) for name, place in self.movable.items()}}

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        places = snapshot["movable"] if snapshot else self._built
        self.movable = {name: (place[0], place[1]) for name, place in places.items()}


def _no_object(name: str, number: int, objects: ObjectMap, kind: str) -> str:
    if name not in objects:
        return f'There is no {kind} object "{name}".'
    return f'"{name}" has the id {objects[name][0]}, not {number}.' if objects[name][0] != number else ""


Answer = Callable[[dict[str, Any]], dict[str, Any]]


class ScriptedAsk:
    """The one door with scripted answers by prompt; an unscripted call fails, and so does a wrong variable."""

    def __init__(self, answers: Mapping[str, Answer]) -> None:
        self.answers = answers
        self.asked: list[tuple[str, Address, dict[str, Any]]] = []
        self.slow: set[Role] = set()
        self.seeing: set[Role] = set()
        self._calls: list[tuple[Address, ModelCall]] = []

    def __call__(
        self,
        prompt: str,
        reply: type[Any],
        /,
        *,
        at: Address,
        variables: Mapping[str, Any],
        images: Sequence[Path] = (),
    ) -> Any:
        assert set(variables) <= ASKS[prompt].variables, f"{prompt} is given {set(variables) - ASKS[prompt].variables}"
        assert reply.__name__ == ASKS[prompt].reply
        self.asked.append((prompt, at, dict(variables)))
        answer = reply.model_validate(self.answers[prompt](dict(variables)))
        call = ModelCall(node=at.node, prompt=prompt, prompt_sha="0", model="scripted", messages=[], reply=str(answer))
        self._calls.append((at, call))
        return answer

    def sees(self, role: Role) -> bool:
        return role in self.seeing

    def instant(self, role: Role) -> bool:
        return role not in self.slow

    def take_calls(self, at: Address | None = None) -> list[ModelCall]:
        made = [pair for pair in self._calls if at in (None, pair[0])]
        self._calls = [pair for pair in self._calls if pair not in made]
        order = list(ASKS)  # threads end in any order
        made.sort(key=lambda pair: (pair[0].hour, order.index(pair[1].prompt), pair[0].draw))
        return [call for _, call in made]

    def variables_of(self, prompt: str) -> list[dict[str, Any]]:
        """What was handed to each call of a prompt, in order."""
        return [variables for name, _, variables in self.asked if name == prompt]


def placing(thing: str, place: str, thing_id: int = 0, place_id: int = 0) -> dict[str, Any]:
    """A pick-and-place draft as a model would write it."""
    act = {"object": thing, "object_id": thing_id, "receptacle": place, "receptacle_id": place_id}
    return {"thought": f"The {thing} belongs on the {place}.", "act": act}


def moving(target: str, thing: str, motion: str, target_id: int = 0) -> dict[str, Any]:
    """A free-motion draft as a model would write it."""
    act = {"target": target, "target_id": target_id, "in_hand": thing, "motion": motion}
    return {"thought": f"I {motion}.", "act": act}


def reviewed(*tasks: dict[str, Any] | None, drop: Sequence[int] = (), add: Sequence[Any] = ()) -> dict[str, Any]:
    """A reflection as a model would write it: None for a task that stays, else what it becomes; `drop` goes."""
    reviews = [{"reason": "so", "yes": task is None and n not in drop, "task": task} for n, task in enumerate(tasks)]
    return {"reviews": reviews, "add": list(add)}


STIR = [moving("stove_1", thing, f"stir a pot {thing}", 3) for thing in ("spoon", "ladle", "whisk", "fork", "spatula")]


def type2_answers() -> dict[str, Answer]:
    """A person who cooks each hour with five things, and a robot that imagines three lives for them."""
    agree = {"reviews": [{"reason": "fine", "yes": True}] * 5}
    offers = {"Cook a meal": ["spoon", "whisk"], "Read quietly": ["novel"], "Tidy the home": ["broom", "spoon"]}
    return {
        "human/intention": lambda v: {"intention": "Cook a meal", "reason_human": f"It is {v['time']}."},
        "human/tasks_type2": lambda v: {"tasks": STIR},
        "human/reflect_profile_type2": lambda v: agree,
        "human/reflect_scene_type2": lambda v: agree,
        "human/feedback_intentions": lambda v: {"verdicts": [{"yes": g == v["intention"]} for g in v["guesses"]]},
        "human/feedback_tasks": lambda v: {
            "verdicts": [{"yes": any(o["text"].split()[-1] in t["text"] for t in v["tasks"])} for o in v["offers"]]
        },
        "robot/intentions": lambda v: {"intentions": [{"intention": text} for text in offers]},
        "robot/tasks_type2": lambda v: {
            "tasks": [
                {"thought": "it helps", "act": {"object": thing}} for thing in offers.get(v["intention"], ["spoon"])
            ]
        },
        "robot/traits": lambda v: {"big_five": BigFive(openness=4).model_dump(), "profile": "Cooks a lot."},
        "judge/tasks": lambda v: {"verdicts": [{"yes": True}] * len(v["offers"])},
    }


class TableClassifier:
    """Remembers the label of each candidate text; 0.5 for what it never saw."""

    def __init__(self) -> None:
        self.table: dict[str, bool] = {}

    def probabilities(self, examples: Sequence[Example]) -> list[float]:
        return [0.5 if e.candidate not in self.table else float(self.table[e.candidate]) for e in examples]

    def train(self, examples: Sequence[Example], *, seed: int) -> dict[str, float]:
        self.table.update({e.candidate: bool(e.label) for e in examples})
        return {"seen": float(len(examples))}

    def save(self, folder: Path) -> None:
        (folder / "table.txt").write_text("\n".join(f"{int(v)} {k}" for k, v in sorted(self.table.items())))

    def load(self, folder: Path) -> None:
        lines = (folder / "table.txt").read_text().splitlines()
        self.table = {line[2:]: line[0] == "1" for line in lines}


class FolderRecorder:
    """A run directory without its ceremony."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.evenings: dict[int, Evening] = {}

    def frames_folder(self, day: int, hour: int) -> Path:
        return self.root / f"frames/day-{day:02d}/hour-{hour:02d}"

    def write_hour(self, record: HourRecord, after: Callable[[], None] | None = None) -> None:
        if after:
            after()
        path = self._day(record.day) / f"hour-{record.hour:02d}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(record.model_dump_json())

    def read_hour(self, day: int, hour: int) -> HourRecord | None:
        path = self._day(day) / f"hour-{hour:02d}.json"
        return HourRecord.model_validate_json(path.read_text()) if path.exists() else None

    def read_evening(self, day: int) -> Evening | None:
        return self.evenings.get(day)

    def read_day(self, day: int) -> list[HourRecord]:
        return [HourRecord.model_validate_json(path.read_text()) for path in sorted(self._day(day).glob("hour-*.json"))]

    def write_evening(self, evening: Evening) -> None:
        self.evenings[evening.day] = evening

    def adapters_folder(self, day: int) -> Path:
        return self.root / f"adapters/day-{day:02d}"

    def _day(self, day: int) -> Path:
        return self.root / f"trace/day-{day:02d}"
