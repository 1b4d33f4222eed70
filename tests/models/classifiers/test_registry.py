from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.models.classifiers import (
    ClassifierSpec,
    Wanted,
    find_classifier,
    known_classifiers,
    make_classifier,
    register_classifier,
    registry,
)
from tests.dropped import drop
from tests.fakes import LetterEmbeddings
from tests.models.classifiers.test_text import at

DOCS = Path(__file__).parents[3] / "docs" / "classifiers.md"


def test_every_classifier_that_ships_says_what_it_is_and_is_found_without_anything_heavy() -> None:
    code = (
        "import sys; from coopera.models.classifiers import *; "
        "specs = [find_classifier(name) for name in known_classifiers()]; "
        "assert all(spec.about for spec in specs); "
        "print({'torch', 'sklearn', 'scipy', 'peft'} & set(sys.modules), *[spec.name for spec in specs])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy, *names = done.stdout.split()
    assert (heavy, names) == ("set()", known_classifiers())
    assert {"kernel", "lora", "lora-instruct"} <= set(names)


def test_an_unknown_classifier_is_refused_with_the_nearest_and_the_known_names() -> None:
    known = ", ".join(known_classifiers())
    with pytest.raises(ConfigError, match=rf"classifier: .*'kernal' \(did you mean kernel\? known are {known}\)"):
        make_classifier("kernal", kind="task", embeddings=LetterEmbeddings())


def test_the_file_that_the_documentation_shows_is_a_choice_once_it_is_in_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = DOCS.read_text().split("```python\n")[1].split("```")[0]
    drop(monkeypatch, tmp_path, "coopera.models.classifiers.shipped", "one_sided", shown)
    assert "one-sided" in known_classifiers()
    assert find_classifier("one-sided").about == "says how often yes was right"
    judge, again = (make_classifier("one-sided", kind="task", embeddings=LetterEmbeddings()) for _ in range(2))
    judge.train([at(0, 9, label=yes) for yes in (True, False, False, False)], seed=0)
    judge.save(tmp_path)
    again.load(tmp_path)
    assert again.probabilities([at(0, 9)]) == [0.25]


def test_a_script_can_register_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Wanted) -> None:
        raise ConfigError("not today")

    monkeypatch.setattr(registry._CLASSIFIERS, "_registered", {})
    register_classifier(ClassifierSpec("moody", "may refuse", refuse))  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match="not today"):
        make_classifier("moody", kind="task", embeddings=LetterEmbeddings())
