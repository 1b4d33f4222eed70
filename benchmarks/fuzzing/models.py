"""Readers of what models are given, what they answer and what they remember, for `benchmarks.fuzz`."""

from __future__ import annotations

import json
from pathlib import Path

from benchmarks.fuzzing import mutations as change
from benchmarks.fuzzing.kit import ROOT, Reader, Target, in_yaml, loaded, of_file
from coopera.core.errors import CooperaError
from coopera.core.replies import FreeMotionReply
from coopera.memory import transfer
from coopera.models.classifiers.instruction import read_recipe
from coopera.models.offline.household import knowledge
from coopera.models.offline.human import facts_file
from coopera.models.parsing import BadReplyError, Wanted, read_reply
from coopera.prompts import loader
from coopera.prompts.examples import examples


def _recipe(path: Path) -> object:
    return read_recipe(path)


def _memory(path: Path) -> object:
    return list(transfer._read(path))


def _prompt(path: Path) -> object:
    prompt = loader._read("human/intention", path)
    filled = [
        prompt.template.fill({name: one[name] for name in prompt.head.inputs}) for one in examples(prompt.head.id)
    ]
    if any(" at 0x" in text.lower() for text in filled):
        raise AssertionError("an address stands in a prompt")
    return filled


def _household(path: Path) -> object:
    return knowledge.load(path)


def _few_activities() -> bytes:
    data = loaded("models/offline/household.yaml")
    few = [{**one, "follows": []} for one in data["activities"][:2]]
    return in_yaml({"looks_like": data["looks_like"], "activities": few})


def _facts(path: Path) -> object:
    return facts_file.load(path)


def _few_facts() -> bytes:
    data = loaded("models/offline/human/facts.yaml")
    return in_yaml(
        {key: value[:3] if isinstance(value, list) else dict(list(value.items())[:3]) for key, value in data.items()}
    )


def _reply(folder: Path) -> Target:
    wanted = Wanted(FreeMotionReply, examples("human/tasks_type2")[0])
    act = {"kind": "free_motion", "target": "armchair_1", "in_hand": "mug", "motion": "sit and read"}
    task = {"thought": "I want to sit.", "reason_human": "", "reason_intentions": "", "reason_tasks": "", "act": act}
    text = json.dumps({"tasks": [task, task, task, task, task]})
    seeds = [f"<think>hm</think>Sure:\n```json\n{text}\n```".encode(), text.replace('"', "'").encode(), text.encode()]
    path = folder / "reply.txt"
    return Target(path, seeds, lambda: read_reply(path.read_text(encoding="utf-8", errors="replace"), wanted))


_TEXTS = (
    b'{"kind": "coopera memory stream", "version": 1, "stream": "life", "model": "m"}\n'
    b'{"text": "I baked.", "hour": 3, "metadata": {"kind": "task"}}\n'
)

READERS: dict[str, Reader] = {
    "prompt": Reader(
        of_file("intention.md", [(ROOT / "prompts/human/intention.md").read_bytes()], _prompt), change.anywhere
    ),
    "reply": Reader(_reply, change.anywhere, (CooperaError, BadReplyError)),
    "household": Reader(of_file("household.yaml", [_few_activities()], _household), change.in_yaml),
    "facts": Reader(of_file("facts.yaml", [_few_facts()], _facts), change.in_yaml),
    "recipe": Reader(
        of_file("recipe.yaml", [(ROOT / "models/classifiers/lora_instruct.yaml").read_bytes()], _recipe),
        change.in_yaml,
    ),
    "memory": Reader(of_file("life.jsonl", [_TEXTS], _memory), change.in_lines),
}
