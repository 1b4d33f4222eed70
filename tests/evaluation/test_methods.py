from __future__ import annotations

from importlib.metadata import EntryPoint

import pytest

from coopera.core.errors import ConfigError
from coopera.core.registry import Registry
from coopera.evaluation import methods
from coopera.graphs import Method

OWN = Method(name="written_by_hand", learns=False)
NO_METHOD = "a word"


@pytest.fixture(autouse=True)
def _installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three entry points of another package, as pip would have installed them."""
    values = {"habits": f"{__name__}:OWN", "gone": "no_such_module:METHOD", "word": f"{__name__}:NO_METHOD"}
    registry = Registry("method", Method, registered=dict(methods.METHODS))
    installed = {name: EntryPoint(name, value, registry.group) for name, value in values.items()}
    monkeypatch.setitem(vars(registry), "_installed", installed)
    monkeypatch.setattr(methods, "_METHODS", registry)


def test_methods_of_other_packages_are_choices_under_the_name_they_are_registered_by() -> None:
    assert methods.known_methods()[-3:] == ["gone", "habits", "word"]
    found = methods.find_method("habits")
    assert (found.name, found.learns) == ("habits", False)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("gone", r"gone of another package \(no_such_module:METHOD\) cannot be loaded: No module named"),
        ("word", r"word of another package .* must give a Method, and gives str"),
        ("nothing", r"there is no method 'nothing' \(known are ours, paper, direct_prompting"),
    ],
)
def test_a_method_that_cannot_be_used_is_named_with_its_reason(name: str, why: str) -> None:
    with pytest.raises(ConfigError, match=f"method: {why}"):
        methods.find_method(name)


def test_a_method_can_be_registered_in_a_script_once_under_a_name_of_its_own() -> None:
    assert methods.register(OWN) is methods.register(OWN)
    assert methods.find_method("written_by_hand") is OWN
    with pytest.raises(ConfigError, match="the name 'ours' is taken by another method"):
        methods.register(Method(name="ours", learns=False))
