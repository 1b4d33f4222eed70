"""What `lora-instruct` learns on the language model in the box, against the same training on random weights.

>>> coopera run --days 3 --out runs/lived && python -m benchmarks.small_model runs/lived

The run's feedback on intentions is taken apart by hours: the first ten hours train, all later ones are asked. The
recipe was chosen beforehand and is the same for both. The interval of an AUC is the middle 95 % of 2,000 draws of whole
hours with replacement, since an hour's candidates are not independent.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import torch
from sklearn.metrics import roc_auc_score
from transformers import AutoConfig, AutoTokenizer, LlamaForCausalLM
from transformers.utils import logging as chatter

from coopera.core.hour import Example
from coopera.models.classifiers import Inputs
from coopera.models.classifiers.instruction import InstructRecipe, read_recipe
from coopera.models.classifiers.lora_instruct import LoraInstructClassifier
from coopera.models.small.weights import folder_of
from coopera.prompts import PromptLibrary

HOURS = 10
RECIPE = {"epochs": 3, "learning_rate": 5e-4, "dropout": 0.05, "batch": 4, "accumulation": 1, "tokens": 512}
DRAWS = 2000


def main() -> None:
    """Train on both, and print what each was worth."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, help="A run with feedback on more than ten hours.")
    given = parser.parse_args()
    chatter.disable_progress_bar()
    lessons, asked = divided(given.run)
    sys.stdout.write(f"{len(lessons)} examples of {HOURS} hours train, {len(asked)} of later hours are asked\n")
    with tempfile.TemporaryDirectory() as folder:
        for name, base in (("smol", folder_of("smol")), ("random weights", random_like_smol(Path(folder)))):
            sys.stdout.write(f"{name}: {tried(base, lessons, asked)}\n")
            sys.stdout.flush()


def divided(run: Path) -> tuple[list[Example], list[Example]]:
    """All examples of the first hours, and those of the others."""
    files = sorted((run / "adapters").glob("day-*/intention/examples.jsonl"))
    lines = [line for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    examples = [Example.model_validate_json(line) for line in lines]
    first = sorted({(e.day, e.hour) for e in examples})[:HOURS]
    return [e for e in examples if (e.day, e.hour) in first], [e for e in examples if (e.day, e.hour) not in first]


def random_like_smol(folder: Path) -> str:
    """Write weights of the same architecture, drawn as for a training from scratch, with the same tokenizer."""
    like = folder_of("smol")
    torch.manual_seed(0)
    LlamaForCausalLM(AutoConfig.from_pretrained(like)).save_pretrained(folder)
    AutoTokenizer.from_pretrained(like).save_pretrained(folder)
    return str(folder)


def tried(base: str, lessons: Sequence[Example], asked: Sequence[Example]) -> str:
    """Train, ask, save and load; say how well the labels are told apart."""
    recipe = InstructRecipe.model_validate(read_recipe().model_dump() | RECIPE | {"base": base, "devices": "cpu"})

    def fresh() -> LoraInstructClassifier:
        return LoraInstructClassifier(
            kind="intention", inputs=Inputs(), instruct=PromptLibrary().instruct, recipe=recipe
        )

    one, other, began = fresh(), fresh(), time.process_time()
    told = one.train(lessons, seed=1)
    seconds = time.process_time() - began
    scores = np.array(one.probabilities(asked))
    with tempfile.TemporaryDirectory() as folder:
        one.save(Path(folder))
        other.load(Path(folder))
    same = other.probabilities(asked) == scores.tolist()
    low, high = interval(asked, scores)
    auc = roc_auc_score([e.label for e in asked], scores)
    return (
        f"AUC {auc:.2f} ({low:.2f} to {high:.2f}), last loss {told['loss']:.3f}, {seconds:.0f} CPU seconds to train, "
        f"verdicts after loading {'identical' if same else 'DIFFERENT'}"
    )


def interval(asked: Sequence[Example], scores: npt.NDArray[np.float64]) -> tuple[float, float]:
    """The middle 95 % of AUCs over draws of whole hours; draws with one class only are left out."""
    rng, labels = np.random.default_rng(0), np.array([bool(e.label) for e in asked])
    hours = [(e.day, e.hour) for e in asked]
    rows = [np.flatnonzero([hour == one for hour in hours]) for one in sorted(set(hours))]
    found = []
    for _ in range(DRAWS):
        drawn = np.concatenate([rows[n] for n in rng.integers(len(rows), size=len(rows))])
        if 0 < labels[drawn].sum() < len(drawn):
            found.append(roc_auc_score(labels[drawn], scores[drawn]))
    low, high = np.quantile(found, [0.025, 0.975])
    return float(low), float(high)


if __name__ == "__main__":
    main()
