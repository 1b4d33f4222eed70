"""Realistic variables for each prompt: what `show` fills a prompt with, and what every prompt file is tried on.

The first example of a prompt is a full one. The others are what code also sends: the first hour of a life,
when nothing is remembered or believed yet, and a robot whose model looks at the pictures itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from coopera.core.asks import INSTRUCTION, PROMPTS
from coopera.core.big_five_test import ITEMS

_ACTS_1 = [
    {"object_id": 52, "object": "book_2", "receptacle_id": 3, "receptacle": "coffee_table_1"},
    {"object_id": 47, "object": "blanket_1", "receptacle_id": 2, "receptacle": "armchair_1"},
    {"object_id": 61, "object": "teapot_1", "receptacle_id": 3, "receptacle": "coffee_table_1"},
]
_TEXTS_1 = [
    "put the book on the coffee table",
    "put the blanket on the armchair",
    "put the teapot on the coffee table",
]
_THOUGHTS_1 = [
    "I lay my novel where I will sit.",
    "I make my reading chair warm and soft.",
    "I want tea within reach while I read.",
]
_ACTS_2 = [
    {"target_id": 9, "target": "bookshelf_1", "in_hand": "book", "motion": "stand and leaf through the pages"},
    {"target_id": 2, "target": "armchair_1", "in_hand": "blanket", "motion": "sit down and tuck up the legs"},
    {"target_id": 3, "target": "coffee_table_1", "in_hand": "mug", "motion": "lean forward and take a sip"},
    {"target_id": 2, "target": "armchair_1", "in_hand": "reading glasses", "motion": "sit and read"},
    {"target_id": 9, "target": "bookshelf_1", "in_hand": "book", "motion": "reach up high"},
]
_TEXTS_2 = [
    "stand and leaf through the pages at the bookshelf with the book in hand",
    "sit down and tuck up the legs at the armchair with the blanket in hand",
    "lean forward and take a sip at the coffee table with the mug in hand",
    "sit and read at the armchair with the reading glasses in hand",
    "reach up high at the bookshelf with the book in hand",
]
_THOUGHTS_2 = [
    "I choose what to read next.",
    "I settle into my corner.",
    "I drink my tea before it gets cold.",
    "I lose myself in the story for a while.",
    "I put the volume back where it belongs.",
]


def _tasks(thoughts: list[str], texts: list[str], acts: list[dict[str, Any]]) -> list[dict[str, Any]]:
    rows = enumerate(zip(thoughts, texts, acts, strict=True), start=1)
    return [{"id": f"14.{n}", "thought": thought, "text": text, "act": act} for n, (thought, text, act) in rows]


_TASKS = {1: _tasks(_THOUGHTS_1, _TEXTS_1, _ACTS_1), 2: _tasks(_THOUGHTS_2, _TEXTS_2, _ACTS_2)}
_PROFILE = (
    "I teach history at a secondary school and I write a small blog about old houses. I bake bread on most mornings, "
    "I read novels in the afternoon, and I stretch before bed because my back complains. "
    "I like quiet company and tidy rooms."
)
_BIG_FIVE = {
    "openness": 4.5,
    "conscientiousness": 3.5,
    "extroversion": 2.0,
    "agreeableness": 4.0,
    "neuroticism": 2.5,
}

_FULL: dict[str, Any] = {
    "time": "2 pm",
    "hour": 14,
    "weekday": "Wednesday",
    "day": 2,
    "person": "nora",
    "name": "Nora",
    "big_five": _BIG_FIVE,
    "profile": _PROFILE,
    "profile_1": "I teach history. I have two sisters. I like to bake bread. My back hurts when I sit too long.",
    "profile_2": "I drive a taxi. I love football. I have a cat.",
    "conversation": "User 1: Hi! How was your day?\nUser 2: Long, I drove all night. And yours?\n"
    "User 1: I marked essays, then I baked a rye bread to calm down.\nUser 2: I wish my cat could bake.",
    "statements": [item.says for item in ITEMS],
    "rooms": ["bathroom", "bedroom", "kitchen", "living room", "study"],
    "today": [
        {"when": "9 am", "hours_ago": 5, "text": "Start the day slowly with breakfast"},
        {"when": "1 pm", "hours_ago": 1, "text": "Tidy the living room"},
    ],
    "recalled_intentions": [
        {"when": "1 pm", "hours_ago": 1, "text": "Tidy the living room"},
        {"when": "9 am", "hours_ago": 5, "text": "Start the day slowly with breakfast"},
    ],
    "told": [
        {
            "when": "day 1, 2 pm",
            "hours_ago": 48,
            "intention": "Relax with some quiet reading",
            "tasks": ["sit and read at the armchair with the book in hand"],
            "weight": 0.8,
        },
    ],
    "in_hand": "book",
    "recalled_tasks": [
        {
            "when": "1 pm",
            "hours_ago": 1,
            "text": "wipe the top at the coffee table with the sponge in hand",
        },
        {
            "when": "9 am",
            "hours_ago": 5,
            "text": "sit and eat at the dining table with the bowl in hand",
        },
    ],
    "intention": "Relax with some quiet reading",
    "fixed": {
        "armchair_1": [2, "living room"],
        "bookshelf_1": [9, "living room"],
        "coffee_table_1": [3, "living room"],
        "desk_1": [14, "study"],
    },
    "movable": {
        "blanket_1": [47, "bedroom"],
        "book_2": [52, "study"],
        "mug_1": [58, "kitchen"],
        "teapot_1": [61, "kitchen"],
    },
    "motions": ["sit and read", "stretch both arms", "lean forward", "reach up", "walk in a circle"],
    "can": {
        "armchair_1": ["sit and read", "put on headphones"],
        "bookshelf_1": ["put things away on a shelf", "dust the shelves"],
        "desk_1": ["write by hand", "wipe the surface"],
    },
    "states": {"coffee_table_1": "dirty", "mug_1": "dirty, with tea in it"},
    "side": "I stretch before bed because my back complains.",
    "rhythm": "Wednesday, the third day of the week; you work at home from 9 am to 1 pm",
    "earlier_days": "yesterday: Bake bread, Mark essays; 2 days ago: Clean the kitchen",
    "now_at": {"book_2": "on desk_1", "blanket_1": "inside wardrobe_1", "teapot_1": "on kitchen_counter_1"},
    "so_far": ["take the novel from the shelf at the bookshelf with the book in hand"],
    "changes": [
        {
            "kind": "illness",
            "text": "I have a bad cold",
            "strength": 1.0,
            "more": {"nap": 2.0},
            "never": ["cardio"],
            "work": None,
        }
    ],
    "may_go_on": True,
    "may_leave": True,
    "n_tasks": 5,
    "steps": ["get my book from the shelf", "sit in the armchair and read"],
    "findings": ['Task 14.2: There is no fixed object "armchair_2".', "There must be 5 tasks, not 4."],
    "hours": ["9 am", "10 am", "11 am", "12 pm", "1 pm", "2 pm"],
    "tasks": _TASKS[2],
    "guesses": ["Unwind with a book", "Clean the living room", "Prepare for tomorrow's work"],
    "offers": [
        {"thought": "A warm drink goes well with reading.", "text": "bring the mug"},
        {"thought": "The shelf may need dusting.", "text": "bring the feather duster"},
    ],
    "percept": {
        "room": "living room",
        "near": ["bookshelf_1"],
        "motion": "stand and turn something over",
        "in_hand": "book",
        "visible": ["armchair_1", "bookshelf_1", "coffee_table_1"],
        "states": {"coffee_table_1": "dirty"},
        "caption": "In the living room, the person seems to stand and turn something over at the bookshelf, "
        "holding something like a book.",
    },
    "first_task": None,
    "seen": None,
    "direct": False,
    "n_intentions": 5,
    "intentions": [
        {"when": "9 am", "hours_ago": 12, "text": "Start the day slowly with breakfast"},
        {"when": "2 pm", "hours_ago": 7, "text": "Relax with some quiet reading"},
        {"when": "9 pm", "hours_ago": 0, "text": "Get ready for the night"},
    ],
}
_BARE: dict[str, Any] = {
    "time": "9 am",
    "hour": 9,
    "weekday": "Monday",
    "day": 0,
    "today": [],
    "recalled_intentions": [],
    "recalled_tasks": [],
    "told": [],
    "in_hand": None,
    "findings": [],
    "states": {},
    "steps": [],
    "so_far": [],
    "rhythm": "Monday, the first day of the week",
    "earlier_days": "",
    "changes": [],
    "may_go_on": False,
    "may_leave": False,
    "percept": None,
    "profile_2": "",
    "conversation": "",
}
_UNKNOWN: dict[str, Any] = {"intentions": [], "tasks": [], "place": None}
_INSTRUCTION: dict[str, Any] = {
    "candidate": "bring the mug",
    "intention": "Unwind with a book",
    "profile": "Likes calm, indoor pastimes. Keeps the rooms in order. Reads in the afternoon.",
    "big_five": "openness 3.80, conscientiousness 4.10, extroversion 2.20, agreeableness 3.60, neuroticism 2.40",
    "intentions": ["Start the day slowly with breakfast", "Relax with some quiet reading"],
    "tasks": ["put the bowl on the dining table", "put the cushion on the sofa"],
    "time": "2 pm",
    "place": 1,
}
_ROBOT_PROFILE = "Likes calm, indoor pastimes. Keeps the rooms in order. Reads in the afternoon."
_WIPING = (
    "In the living room, the person seems to wipe the surface at the coffee table, holding something like a cloth."
)
_ROBOTS_INTENTIONS = [
    {"when": "day 2, 2 pm", "hours_ago": 24, "text": "Read for pleasure", "source": "told"},
    {"when": "1 pm", "hours_ago": 1, "text": "Tidy the living room", "source": "guessed"},
]


def _robots_tasks(collab: int) -> list[dict[str, Any]]:
    """What a robot recalls: told, seen, and offered today without knowing whether it was right."""
    if collab == 2:
        return [
            {"when": "day 2, 2 pm", "hours_ago": 24, "text": _TEXTS_2[1], "source": "told"},
            {"when": "1 pm", "hours_ago": 1, "text": _WIPING, "source": "seen"},
            {"when": "1 pm", "hours_ago": 1, "text": "bring the sponge", "source": "guessed"},
        ]
    return [
        {"when": "day 2, 2 pm", "hours_ago": 24, "text": _TEXTS_1[1], "source": "told"},
        {"when": "1 pm", "hours_ago": 1, "text": "put the cushion on the sofa", "source": "seen"},
        {"when": "1 pm", "hours_ago": 1, "text": "put the blanket on the sofa", "source": "guessed"},
    ]


def _of_type(collab: int) -> dict[str, Any]:
    if collab == 2:
        return {"n_tasks": 5, "n_intentions": 5, "tasks": _TASKS[2]}
    offers = [
        {"thought": _THOUGHTS_1[2], "text": _TEXTS_1[2]},
        {"thought": "The desk may be used next.", "text": "put the mug on the desk"},
    ]
    return {
        "n_tasks": 3,
        "n_intentions": 3,
        "tasks": _TASKS[1],
        "offers": offers,
        "recalled_tasks": [
            {"when": "1 pm", "hours_ago": 1, "text": "put the cushion on the sofa"},
            {"when": "9 am", "hours_ago": 5, "text": "put the bowl on the dining table"},
        ],
        "first_task": _TEXTS_1[0],
        "findings": ['Task 14.2: There is no fixed object "armchair_2".', "There must be 3 tasks, not 2."],
    }


def _as_robot(collab: int) -> dict[str, Any]:
    seen = _TEXTS_1[0] if collab == 1 else _FULL["percept"]["caption"]
    return {
        "profile": _ROBOT_PROFILE,
        "recalled_intentions": _ROBOTS_INTENTIONS,
        "recalled_tasks": _robots_tasks(collab),
        "seen": seen,
    }


def _evening(full: Mapping[str, Any]) -> dict[str, Any]:
    """A day as the person tells of it."""
    told = {"source": "told"}
    intentions = [memory | told for memory in _FULL["intentions"]]
    return {**full, "intentions": intentions, "tasks": [m | told for m in _FULL["recalled_tasks"]], "evening": True}


_GUESSED_DAY = {"intentions": _ROBOTS_INTENTIONS[1:], "tasks": _robots_tasks(1)[1:], "evening": False}


def examples(name: str) -> list[Mapping[str, Any]]:
    """Variables to fill a prompt with, a full example first.

    Args:
        name: One of `coopera.core.asks.PROMPTS`.
    """
    if name == INSTRUCTION:
        return [_INSTRUCTION, _INSTRUCTION | {**dict.fromkeys(("intention", "profile", "big_five"), ""), **_UNKNOWN}]
    spec = PROMPTS[name]
    collab = 1 if name.endswith("type1") else 2
    full = {**_FULL, **_of_type(collab)}
    if spec.role == "robot":
        full |= _as_robot(collab)
    cases = [full, {**full, **_BARE}]
    if spec.role == "robot":
        cases[1] |= {"profile": None, "big_five": None}
    if "offers" in spec.variables or "first_task" in spec.variables:
        cases.append({**full, **_of_type(1), **(_as_robot(1) if spec.role == "robot" else {})})
    if "rhythm" in spec.variables:  # type 2, where things of any kind are brought
        cases.append({**full, "movable": {}})
    if "direct" in spec.variables:
        cases.append({**full, "told": [], "direct": True, "intention": full["seen"]})
    if name == "robot/traits":
        cases = [_evening(full), {**_evening(full), "profile": None}, {**full, **_GUESSED_DAY}]
    elif "offers" in spec.variables:  # the person's remaining tasks only, and none at all where there was but one
        cases = [{**case, "tasks": case["tasks"][1:]} for case in cases] + [{**full, "tasks": []}]
    return [{variable: case[variable] for variable in sorted(spec.variables)} for case in cases]
