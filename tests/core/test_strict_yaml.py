from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from coopera.config.files import read_yaml
from coopera.core.errors import ConfigError
from coopera.core.strict_yaml import load_yaml

BOMB = "a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n"


def test_plain_data_are_read_as_yaml_says() -> None:
    text = "days: 3\nnames: [amara, 'yes']\nat: 2024-11-05\nshare: 0.5\non: true\nnone:\n"
    assert load_yaml(text) == yaml.safe_load(text)
    assert load_yaml("") is None


@pytest.mark.parametrize(
    ("text", "line", "problem"),
    [
        ("a: 1\na: 2", 2, "stands twice"),
        (BOMB, 2, "an alias"),
        ("a: !!set {x, y}", 1, "a tag"),
        ("a: !!bool maybe", 1, "a tag"),
        ("a: !!int x", 1, "a tag"),
        ("a: !!timestamp x", 1, "a tag"),
        ("a: !!python/object:os.system x", 1, "a tag"),
        ("b: 1\na: 2024-13-45", 2, "'2024-13-45' cannot be read"),
        (f"a: {'9' * 5000}", 1, "cannot be read"),
        ("a: 0x_", 1, "'0x_' cannot be read"),
        ("a: 0b_", 1, "'0b_' cannot be read"),
        (f"a: {'[' * 2000}", 1, "nested more than 64 deep"),
        ("a: [1, 2", 2, "expected"),
        ("a: 1\nb: \x07", 2, "characters are not allowed"),
        ("? {a: 1}\n: 2", 1, "unhashable"),
        ("a: 1\n--- \nb: 2", 2, "more than one document"),
    ],
)
def test_what_is_refused_is_said_with_its_line(text: str, line: int, problem: str, tmp_path: Path) -> None:
    file = tmp_path / "study.yaml"
    file.write_text(text)
    with pytest.raises(ConfigError) as refused:
        read_yaml(file, "study")
    assert f"study.yaml, line {line}: " in str(refused.value)
    assert problem in str(refused.value)
    assert len(str(refused.value)) < 300 + len(str(file))


def test_a_file_of_millions_of_values_is_refused_before_it_is_built() -> None:
    with pytest.raises(yaml.MarkedYAMLError, match="more than 500000 values"):
        load_yaml("[" + "1," * 600_000 + "]")
    with pytest.raises(yaml.MarkedYAMLError, match="characters"):
        load_yaml("a" * 5_000_001)
