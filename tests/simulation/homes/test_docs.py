from __future__ import annotations

from pathlib import Path

from coopera.simulation.homes.scene import Scene, parse_scene
from coopera.simulation.ways.home_check import check

DOC = Path(__file__).parents[3] / "docs" / "scenes.md"


def test_the_home_in_the_documentation_is_one() -> None:
    text = DOC.read_text(encoding="utf-8").split("```json\n")[1].split("```")[0]
    studio = parse_scene(text, "docs/scenes.md")
    assert check(studio) == []


def test_the_schema_describes_every_field_that_a_person_writes() -> None:
    schema = Scene.model_json_schema()
    assert {"id", "rooms", "doors", "objects"} <= set(schema["properties"])
    for part in ("Room", "Doorway", "SceneObject"):
        assert schema["$defs"][part]["additionalProperties"] is False
        assert schema["$defs"][part]["description"]
