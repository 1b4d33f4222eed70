"""The wall: what is private to a person cannot be reached from the robot's or the judge's side."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from coopera.core.asks import ASKS
from tests.models.offline.questions import FIXED, MOVABLE, ask, imagine, live, percept, person, sample, when

ROOT = Path(__file__).parents[3]
PRIVATE = {f"coopera.models.offline.human.{name}" for name in ("person", "style", "choosing", "replies", "tasks")}


def _imports(module: str) -> set[str]:
    """Modules of ours that a module's source imports, wherever in it."""
    path = ROOT / Path(*module.split("."))
    source = path.with_suffix(".py") if path.with_suffix(".py").exists() else path / "__init__.py"
    if not source.exists():
        return set()
    found: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            package = str(node.module)
            lazy = getattr(import_module(package), "_WHERE", {}) if package.startswith("models") else {}
            found.add(package)
            found.update(lazy.get(alias.name, f"{package}.{alias.name}") for alias in node.names)
        elif source.name != "__init__.py" and isinstance(node, ast.Constant) and str(node.value).startswith("models."):
            found.add(str(node.value))  # imported by name, if it is
    return found


def _reachable(module: str) -> set[str]:
    seen: set[str] = set()
    todo = [module]
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += sorted(_imports(name))
    return seen


@pytest.mark.parametrize("side", ["coopera.models.offline.robot.replies", "coopera.models.offline.judge"])
def test_nothing_that_robot_or_judge_import_however_far_is_private(side: str) -> None:
    assert _reachable(side) & PRIVATE == set()
    assert "coopera.models.offline.household.knowledge" in _reachable(side)


def test_the_same_walk_finds_the_private_side_from_the_person() -> None:
    assert _reachable("coopera.models.offline.human.replies") >= PRIVATE


def test_a_process_with_only_their_sides_has_not_loaded_the_private_modules() -> None:
    sides = "coopera.models.offline.robot.replies, coopera.models.offline.judge"
    code = f"import sys, {sides}; assert not {PRIVATE!r} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


_ASKED = """
import sys
read = set()
sys.addaudithook(lambda event, given: read.add(str(given[0])) if event == "open" else None)
from coopera.core.asks import ASKS
from coopera.core.randomness import Address
from coopera.core.replies import REPLIES
from coopera.models.backends import open_backend
from coopera.models.door import Door
from coopera.prompts import PromptLibrary
from coopera.prompts.examples import examples
opened = {role: open_backend("offline:words", role, None, household=sys.argv[1]) for role in ("robot", "judge")}
door = Door(prompts=PromptLibrary(), backends=opened, seed=0)
for name, spec in ASKS.items():
    for variables in examples(name) if spec.role != "human" else ():
        door(name, REPLIES[spec.reply], at=Address("nora", 0, 9, "node"), variables=variables)
print(*sorted(name.replace("\\\\", "/").rpartition("/")[2] for name in read if name.endswith("household.yaml")))
"""


@pytest.mark.parametrize(("household", "read"), [("own", "robot_household.yaml"), ("shared", "household.yaml")])
def test_robot_and_judge_read_their_own_household_file_and_never_the_persons(household: str, read: str) -> None:
    code = [sys.executable, "-c", _ASKED, household]
    done = subprocess.run(code, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [read]


def test_no_prompt_of_robot_or_judge_is_given_who_the_person_is() -> None:
    for spec in ASKS.values():
        if spec.role != "human":
            assert not spec.variables & {"person", "name"}
    assert "profile" not in ASKS["judge/tasks"].variables


def test_the_robot_answers_alike_whoever_lives_beside_it() -> None:
    def answers() -> list[str]:
        seen = percept(room="kitchen", near=["stove_1"], motion="eat or drink", in_hand="spoon")
        task = {
            **when(0, 10),
            "big_five": None,
            "profile": None,
            "recalled_intentions": [],
            "recalled_tasks": [],
            "intention": "Make a homemade treat",
            "fixed": FIXED,
        }
        return [
            imagine(percept=seen).model_dump_json(),
            ask("robot/tasks_type2", **task, n_tasks=5).model_dump_json(),
            ask("robot/tasks_type1", **task, movable=MOVABLE, first_task=None, n_tasks=3).model_dump_json(),
            ask("robot/traits", **sample("robot/traits")).model_dump_json(),
            ask("judge/tasks", **sample("judge/tasks")).model_dump_json(),
        ]

    before = answers()
    baker = live(person("mara", "I love to bake cookies, bread and cakes."))
    after_baker = answers()
    gamer = live(person("tom", "I play video games and stream them.", extroversion=1.0))
    assert baker != gamer
    assert before == after_baker == answers()
