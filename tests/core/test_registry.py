from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError
from coopera.core.registry import Registry

FILE = "from tests.core.test_registry import Hat\nHAT = Hat('{name}', {size})\n"
WORD = "a word"


@dataclass(frozen=True)
class Hat:
    name: str
    size: int


OFFERED = Hat("bowler", 4)


@pytest.fixture
def hats(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Registry[Hat]:
    """Hats that ship in a package of files, and hats of another package, as pip would have installed it."""
    package = f"shop_{tmp_path.name}"
    folder = tmp_path / package
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "top_hat.py").write_text(FILE.format(name="top-hat", size=9))
    (folder / "cap.py").write_text(FILE.format(name="cap", size=1))
    (folder / "torn.py").write_text("import no_such_thing")
    (folder / "glove.py").write_text("HAT = 5")
    (folder / "_pins.py").write_text("raise AssertionError")
    monkeypatch.syspath_prepend(str(tmp_path))
    made = Registry("hat", Hat, package=package, dash="-")
    offers = {"melon": f"{__name__}:OFFERED", "gone": "no_such_module:HAT", "word": f"{__name__}:WORD"}
    entries = {name: EntryPoint(name, value, made.group) for name, value in offers.items()}
    monkeypatch.setitem(vars(made), "_installed", entries)
    return made


def test_every_file_of_the_package_is_a_value_of_its_own_name(hats: Registry[Hat]) -> None:
    assert hats.known() == ["cap", "glove", "top-hat", "torn", "gone", "melon", "word"]
    assert hats.find("top-hat") == Hat("top-hat", 9)


def test_a_value_of_another_package_has_the_name_it_is_offered_by(hats: Registry[Hat]) -> None:
    assert hats.group == "coopera.hats"
    assert hats.find("melon") == Hat("melon", 4)


def test_a_value_can_be_registered_once_under_a_name_of_its_own(hats: Registry[Hat]) -> None:
    assert hats.register(Hat("beret", 2)) == hats.register(Hat("beret", 2)) == hats.find("beret")
    for taken in ("beret", "cap", "melon"):
        with pytest.raises(ConfigError, match=f"hat: the name '{taken}' is taken by another hat"):
            hats.register(Hat(taken, 7))


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("top_hat", r"there is no hat 'top_hat' \(did you mean top-hat\? known are cap, glove, "),
        ("xyz", r"there is no hat 'xyz' \(known are cap"),
        ("torn", r"shop_\w+\.torn cannot be loaded: No module named 'no_such_thing'"),
        ("glove", r"shop_\w+\.glove must give a Hat, and gives int"),
        ("gone", r"gone of another package \(no_such_module:HAT\) cannot be loaded: No module named"),
        ("word", r"word of another package .* must give a Hat, and gives str"),
    ],
)
def test_what_cannot_be_used_is_named_with_its_reason(hats: Registry[Hat], name: str, why: str) -> None:
    with pytest.raises(ConfigError, match=f"hat: {why}"):
        hats.find(name)
