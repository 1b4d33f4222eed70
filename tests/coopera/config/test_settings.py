"""Each setting is declared once: its flag, its help, its errors and its page follow."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
from pydantic import Field

from coopera.config.declared import declared
from coopera.config.reference import page
from coopera.config.schema import SETTINGS, Config
from coopera.core.people import Frozen
from coopera.core.setting import Setting
from coopera.studies.catalogues import resolve
from tests.coopera.conftest import Said

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "settings.md"


class Inner(Frozen):
    share: Annotated[float, Field(ge=0, le=1), Setting("How much.")] = 0.5


class Outer(Frozen):
    most: Annotated[Annotated[int, Field(ge=2)] | None, Setting("At most.", unset="all")] = None
    kind: Annotated[Literal["tea", "milk", "water"], Setting("What to drink.", flag="--kind")] = "milk"
    folder: Annotated[Path | None, Setting("Where.", metavar="DIR")] = None
    inner: Annotated[Inner, Setting("Shares.")] = Inner()


def test_range_values_and_default_of_a_setting_are_read_from_its_field() -> None:
    found = declared(Outer)
    assert list(found) == ["most", "kind", "folder", "inner", "inner.share"]
    assert found["most"].expected == "a whole number from 2 up"
    assert found["most"].help == "At most. [from 2 up; default: all]"
    assert found["kind"].expected == "tea, milk or water"
    assert (found["kind"].metavar, found["kind"].unset) == ("tea|milk|water", "milk")
    assert found["folder"].expected == "the path of a folder"
    assert found["inner"].expected == "a mapping with any of share"
    assert (found["inner.share"].range, found["inner.share"].unset) == ("0 to 1", "0.5")


def test_a_setting_without_words_is_refused() -> None:
    class Silent(Frozen):
        most: int = 1

    with pytest.raises(TypeError, match="the field most is declared without a Setting"):
        declared(Silent)


def test_the_page_of_settings_is_the_one_that_the_declarations_give() -> None:
    made = subprocess.run([sys.executable, "-m", "coopera.config.reference"], capture_output=True, check=True)
    assert made.stdout.decode() == page()
    assert PAGE.read_text(encoding="utf-8") == page(), "python -m coopera.config.reference > docs/reference/settings.md"


def test_every_flag_stands_in_the_help_of_run_with_its_values_and_its_default(
    coopera: Callable[..., Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "10000")
    monkeypatch.setenv("TERMINAL_WIDTH", "10000")
    shown = " ".join(coopera("run", "--help").out.split())
    for one in SETTINGS.values():
        if one.words.flag:
            assert f"{one.words.flag} {one.metavar or ''}".strip() in shown
            assert " ".join(one.help.split()) in shown


def test_what_every_setting_says_of_itself_is_one_sentence() -> None:
    for one in SETTINGS.values():
        assert one.words.help.endswith("."), one.name
        assert ". " not in one.words.help, one.name


@pytest.mark.parametrize(
    ("flags", "field", "value"),
    [
        (["--setting", 2], "setting", 2),
        (["--person-model", "single_shot"], "person_model", "single_shot"),
        (["--humans", "joan, amara"], "humans", ["joan", "amara"]),
        (["--prompts", "mine"], "prompts", Path("mine")),
        (["--budget-calls", 3], "budget", {"calls": 3, "tokens": None, "money": None, "prices": None}),
        (["--model", "a", "--judge-model", "b"], "models", {"human": "a", "robot": "a", "judge": "b"}),
    ],
)
def test_a_flag_sets_its_field(
    coopera: Callable[..., Said], monkeypatch: pytest.MonkeyPatch, flags: list[Any], field: str, value: Any
) -> None:
    asked: list[Config] = []

    class EnoughError(SystemExit):
        pass

    def stop(config: Config) -> Config:
        asked.append(config)
        raise EnoughError

    monkeypatch.setattr(f"{resolve.__module__}.resolve", stop)
    with pytest.raises(EnoughError):
        coopera("run", *flags)
    found = getattr(asked[0], field)
    assert (found.model_dump() if hasattr(found, "model_dump") else found) == value
