from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from coopera.cli import main
from coopera.core.household import PickPlace
from coopera.simulation import World
from coopera.simulation.homes.scene import Scene, dump_scene, load_scene
from tests.simulation.flat import flat
from tests.simulation.synthetic_hssd import SCENE, write_hssd


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path / "data"))
    return tmp_path / "data"


def test_an_imported_home_of_hssd_is_listed_and_lived_in(
    tmp_path: Path, data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["scenes", "import", str(write_hssd(tmp_path / "hssd")), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)
    assert (found["id"], found["problems"]) == (SCENE, [])
    assert len(found["skipped"]) == 3
    assert "another storey" in (data / "scenes" / f"{SCENE}.import.txt").read_text()
    assert main(["scenes", "list", "--json"]) == 0
    assert SCENE in [home["id"] for home in json.loads(capsys.readouterr().out)]
    home = load_scene(SCENE, [data / "scenes"])
    with World(home) as world:
        act = PickPlace(object_id=1, object="mug_1", receptacle_id=3, receptacle="bed_1")
        assert world.perform("human", act).ok
        assert world.as_scene().object_map("movable")["mug_1"] == (1, "bedroom")
        assert world.perform(
            "robot", act.model_copy(update={"object": "mug_2", "object_id": home.object("mug_2").id})
        ).ok


def test_importing_twice_needs_force(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    instance = write_hssd(tmp_path / "hssd") / "scenes" / f"{SCENE}.scene_instance.json"
    assert main(["scenes", "import", str(instance)]) == 0
    assert main(["scenes", "import", str(instance)]) == 2
    assert "--force" in capsys.readouterr().err
    assert main(["scenes", "import", str(instance), "--force"]) == 0


def test_a_home_written_by_hand_is_imported_and_one_with_problems_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "flat.json"
    file.write_text(dump_scene(flat()))
    assert main(["scenes", "import", str(file)]) == 0
    floating = flat().object("tennis_ball_1")
    assert floating is not None
    others = [thing for thing in flat().objects if thing != floating]
    bad = flat().model_copy(update={"objects": [*others, floating.model_copy(update={"position": (3.3, 3.6, 1.5)})]})
    file.write_text(dump_scene(bad))
    capsys.readouterr()
    assert main(["scenes", "check", str(file)]) == 1
    assert "tennis_ball_1 floats 1.50 m above the floor" in capsys.readouterr().out


def test_a_home_is_generated_stored_and_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "new" / "home.png"
    asked = ["scenes", "generate", "--rooms", "1", "--seed", "5", "--id", "hut", "--things", "6", "--png", str(picture)]
    assert main([*asked, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["id"], found["rooms"], found["problems"]) == ("hut", 1, [])
    assert load_scene(found["file"]).id == "hut"
    with Image.open(picture) as image:
        assert image.size == (960, 720)
    assert main(asked) == 2
    assert main([*asked[:-2], "--id", "maple"]) == 2
    assert "ships with coopera" in capsys.readouterr().err


def test_statistics_count_the_objects_of_each_super_category(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "statistics.png"
    assert main(["scenes", "statistics", "pine", "rowan", "--png", str(picture), "--json"]) == 0
    pine, rowan = json.loads(capsys.readouterr().out)
    assert pine["id"] == "pine"
    assert sum(pine["categories"].values()) == pine["fixed"] + pine["movable"]
    assert rowan["rooms"] == 5
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["import", "nowhere"], "nowhere: there is no such file or folder"),
        (["import", "."], "there is no file <id>.scene_instance.json"),
        (["show", "maple", "--png", "/proc/none/x.png"], "picture cannot be written"),
        (["generate", "--rooms", "99"], "1 to 24 rooms, not 99"),
        (["generate", "--rooms", "1", "--id", "../x"], "home's id is lower-case"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_sentence(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["scenes", *arguments]) == 2
    assert said in capsys.readouterr().err


def test_the_schema_is_that_of_the_homes_that_ship(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scenes", "schema"]) == 0
    assert json.loads(capsys.readouterr().out) == Scene.model_json_schema()
