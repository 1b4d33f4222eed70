"""What an evening and a verdict cost: seconds of learning by day, and verdicts beside the authors' sampling.

    python -m benchmarks.evenings --classifiers kernel lora lora-instruct --days 1 5 20 50

An evening learns from a day of one person of the toy household and from the rehearsed examples of earlier days
(`coopera.graphs.robots.rehearsal`). So the evening after 50 days can be measured without simulating them. Seconds are
processor time of one thread. Growth is the last evening's time divided by that after 5 days, or after the first number
of days asked for later.
`lora-instruct` runs on a random model of Mistral's architecture, and its seconds hold for this size only (--hidden,
--layers). The ratio to sampling compares two ways of asking the same model. Random weights seldom end a text early:
this is the worst case for sampling.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import torch
from langchain_core.embeddings import Embeddings

from benchmarks.tiny_mistral import tiny_recipe
from benchmarks.toy_household import Robot, draw_person, live_day
from coopera.core.hour import CandidateKind, Example
from coopera.graphs.robots.rehearsal import keep
from coopera.memory.embeddings import bundled
from coopera.models.classifiers import known_classifiers, make_classifier
from coopera.models.classifiers.causal import open_base
from coopera.models.classifiers.instruction import read_recipe
from coopera.prompts import PromptLibrary

PERSON = 1000
FULL = 5  # after so many days there are as many examples as an evening takes, so that it should grow no longer
INSTRUCT = PromptLibrary().instruct
SAMPLES, TOKENS = 3, 100  # the authors' code: so many texts of so many tokens for each verdict


def imagined(days: int, embeddings: Embeddings) -> dict[CandidateKind, list[list[Example]]]:
    """What a robot imagines and is told on each of some days."""
    person = draw_person(0, PERSON)
    robot = Robot(person, 0, embeddings)
    found: dict[CandidateKind, list[list[Example]]] = {"intention": [], "task": []}
    for day in range(days):
        lived = live_day(person, 0, day)
        intentions, tasks = [], []
        for hour in lived:
            for activity, guess in robot.imagine_intentions(hour):
                right = activity == hour.activity
                intentions.append(guess.model_copy(update={"label": right}))
                if right or guess.rank == 0:
                    for task in robot.imagine_tasks(hour, activity, guess):
                        helps = right and task.candidate.removeprefix("bring the ") in hour.things
                        tasks.append(task.model_copy(update={"label": helps}))
        found["intention"].append(intentions)
        found["task"].append(tasks)
        robot.learn_person(lived)
    return found


def evening(
    name: str, day: int, lived: dict[CandidateKind, list[list[Example]]], embeddings: Embeddings, recipe: Path
) -> float:
    """Processor seconds of learning in the evening after so many days, going on from the evening before."""
    seconds = 0.0
    for kind, days in lived.items():
        judge = make_classifier(name, kind=kind, embeddings=embeddings, recipe=recipe, instruct=INSTRUCT)
        kept = keep(example for before in days[: day - 1] for example in before)
        if kept:
            judge.train(kept, seed=0)  # an evening before, so that this one goes on
        start = time.process_time()
        judge.train([*kept, *days[day - 1]], seed=day)
        seconds += time.process_time() - start
    return seconds


def verdicts(lived: dict[CandidateKind, list[list[Example]]], recipe: Path, timed: int) -> str:
    """25 verdicts by one forward pass, and by sampling as the authors' code does, at the same model."""
    base = open_base(read_recipe(recipe).model_dump_json())
    texts = [INSTRUCT(example) for example in lived["intention"][0][:25]]
    torch.set_num_threads(1)
    base.model.eval()
    with torch.no_grad():
        start = time.process_time()
        base.scores(texts)
        ours = time.process_time() - start
        start = time.process_time()
        read = 0
        for text in texts[:timed]:
            given = base.tokenizer(text, return_tensors="pt")
            read += int(given["input_ids"].shape[1])
            base.model.generate(
                input_ids=given["input_ids"],
                attention_mask=given["attention_mask"],
                do_sample=True,
                num_return_sequences=SAMPLES,
                max_new_tokens=TOKENS,
                min_new_tokens=TOKENS,
                pad_token_id=0,
            )
        theirs = (time.process_time() - start) / timed * len(texts)
    written = SAMPLES * TOKENS * len(texts)
    return (
        f"25 verdicts: {ours:.2f} s by one forward pass ({len(texts)} x {read / timed:.0f} tokens read, none written), "
        f"{theirs:.1f} s by sampling ({written} tokens written; {timed} timed): {theirs / ours:.0f} times"
    )


def main() -> None:
    """Print the evenings as a table, then the cost of verdicts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--classifiers", nargs="+", choices=known_classifiers(), default=known_classifiers())
    parser.add_argument("--days", nargs="+", type=int, default=[1, 5, 20, 50])
    parser.add_argument("--hidden", type=int, default=64, help="width of the random causal model")
    parser.add_argument("--layers", type=int, default=2, help="layers of the random causal model")
    parser.add_argument("--timed", type=int, default=5, help="verdicts timed by sampling, of 25")
    chosen = parser.parse_args()
    full = next((place for place, day in enumerate(chosen.days) if day >= FULL), 0)
    with tempfile.TemporaryDirectory() as folder:
        embeddings = bundled(Path(folder) / "embeddings.sqlite")
        lived = imagined(max(chosen.days), embeddings)
        recipe = tiny_recipe(Path(folder), hidden=chosen.hidden, layers=chosen.layers)
        print("| classifier | " + " | ".join(f"after {day} days" for day in chosen.days) + " | growth | peak MB |")
        print("|---|" + "---|" * (len(chosen.days) + 2))
        for name in chosen.classifiers:
            one = make_classifier(name, kind="task", embeddings=embeddings, recipe=recipe, instruct=INSTRUCT)
            one.train(lived["task"][0], seed=0)
            seconds = [evening(name, day, lived, embeddings, recipe) for day in chosen.days]
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            cells = " | ".join(f"{one:.2f} s" for one in seconds)
            print(f"| {name} | {cells} | {seconds[-1] / seconds[full]:.2f} | {peak:.0f} |", flush=True)
        print(verdicts(lived, recipe, chosen.timed))
        embeddings.close()


if __name__ == "__main__":
    main()
