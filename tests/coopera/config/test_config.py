from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from coopera.config.schema import Config, default_data_dir, load_config
from coopera.core.errors import ConfigError
from coopera.studies.catalogues import Catalogues, next_folder, resolve

KNOWN = Catalogues(
    people=["amara", "bruno", "chen", "dalia"],
    scenes=["maple"],
    methods=["ours", "random"],
    needs={1: (1, 1, 5), 2: (1, 5, 5), 3: (3, 1, 9), 4: (3, 3, 9)},
)


def study(folder: Path, text: str) -> Path:
    path = folder / "study.yaml"
    path.write_text(text)
    return path


def test_flags_win_over_the_file_and_the_file_over_the_defaults(tmp_path: Path) -> None:
    path = study(tmp_path, "days: 2\nseed: 7\nmodels: {human: a, judge: b}\n")
    config = load_config(path, {"days": 3, "hours": None, "models": {"human": "c"}})
    assert (config.days, config.seed, config.hours) == (3, 7, 13)
    assert (config.models.human, config.models.robot, config.models.judge) == ("c", "offline", "b")


def test_a_resolved_configuration_survives_being_written_and_read(tmp_path: Path) -> None:
    config = resolve(Config(setting=3, seed=5, frame_size=(64, 48), out=tmp_path / "x"), KNOWN)
    again = load_config(study(tmp_path, config.to_yaml()))
    assert again == config.model_copy(update={"out": None})
    assert "out" not in yaml.safe_load(config.to_yaml())


def test_a_setting_decides_what_is_left_open() -> None:
    config = resolve(Config(setting=3), KNOWN)
    assert (config.humans, config.scenes, config.days) == (["amara", "bruno", "chen"], ["maple"], 9)
    assert config.day_hours == list(range(9, 22))


@pytest.mark.parametrize("setting", [1, 2, 3, 4])
def test_what_ships_is_enough_for_every_setting_and_an_imported_home_takes_no_ones_place(
    tmp_path: Path, setting: int
) -> None:
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "abbey.json").write_text("{}")
    config = resolve(Config(setting=setting, data_dir=tmp_path))
    wanted = {1: 1, 2: 5, 3: 1, 4: 3}[setting]
    assert config.scenes == ["maple", "oak", "pine", "rowan", "willow"][:wanted]


def test_run_folders_are_numbered_without_a_clock(tmp_path: Path) -> None:
    (tmp_path / "run-001").mkdir()
    (tmp_path / "run-003").mkdir()
    assert next_folder(tmp_path) == tmp_path / "run-002"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("dayz: 3", "study.yaml: there is no field 'dayz' (did you mean days?)."),
        ("zzz: 3", "there is no field 'zzz' (known are setting, collab, humans"),
        ("models: {humn: x}", "there is no field 'humn' (did you mean human?)."),
        ("days: -1", "study.yaml: days must be a whole number from 1 to 366, not -1."),
        ("days: two", "days must be a whole number from 1 to 366, not 'two'."),
        ("days: 2.0", "days must be a whole number from 1 to 366, not 2.0."),
        ("setting: 7", "setting must be 1, 2, 3 or 4, not 7."),
        ("setting: true", "setting must be 1, 2, 3 or 4, not True."),
        ("setting: [1]", "setting must be 1, 2, 3 or 4, not [1]."),
        ("humans: amara", "humans must be a list of one or more persona ids, not 'amara'."),
        ("humans: [amara, 3]", "humans must be a list of one or more persona ids, not 3."),
        ("humans: []", "humans must be a list of one or more persona ids, not []."),
        ("models: {human: 3}", "models.human must be a model such as offline, not 3."),
        ("frame_size: [320]", "frame_size must be two whole numbers from 32 to 2048, [width, height], not"),
        ("perception: {motion_confused: 2}", "perception.motion_confused must be a share from 0 to 1, not 2."),
        ("perception: {joint_nose: 0}", "there is no field 'joint_nose' (did you mean joint_noise?)."),
        ("pictures: film", "pictures must be sampled, none or video, not 'film'."),
        ("base_url: localhost", "base_url must be an address such as http://localhost:8000/v1, without user and"),
        ("- 1\n- 2", "the study file must be a mapping of fields to values, not a list."),
        ("days: 1\ndays: 2", "study.yaml, line 2: this is not valid YAML ('days' stands twice)."),
        ("a: [1", "study.yaml, line 2: this is not valid YAML"),
        ("a: " + "[" * 5000, "study.yaml, line 1: this is not valid YAML (it is nested more than 64 deep)."),
        ("1: 2", "field names must be words, not 1."),
        ("days: !!python/object/apply:os.getcwd []", "study.yaml, line 1: this is not valid YAML"),
    ],
)
def test_a_mistake_in_a_file_is_one_sentence_with_file_field_and_what_was_expected(
    tmp_path: Path, text: str, sentence: str
) -> None:
    with pytest.raises(ConfigError) as err:
        load_config(study(tmp_path, text + "\n"))
    assert sentence in str(err.value)
    assert str(tmp_path / "study.yaml") in str(err.value)
    assert "\n" not in str(err.value)


def test_a_file_that_is_not_utf8_is_refused_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    path.write_bytes(b"days: 1\nmethod: \xff\n")
    with pytest.raises(ConfigError, match=r"study\.yaml, line 2: the study file must be UTF-8 text"):
        load_config(path)


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        ({"days": 0}, "--days must be a whole number from 1 to 366, not 0."),
        ({"base_url": "x"}, "--base-url must be an address"),
        ({"models": {"robot": ""}}, "--robot-model must be a model such as offline, not ''."),
        (
            {"models": dict.fromkeys(("human", "robot", "judge"), "")},
            "--model must be a model such as offline, not ''.",
        ),
    ],
)
def test_a_mistake_in_a_flag_names_the_flag(tmp_path: Path, flags: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigError) as err:
        load_config(study(tmp_path, "seed: 1\n"), flags)
    assert str(err.value).startswith(sentence)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"humans": ["bob"]}, "humans: there is no person 'bob' (known are amara, bruno, chen, dalia)."),
        ({"humans": ["amra"]}, "humans: there is no person 'amra' (did you mean amara?"),
        ({"humans": ["amara", "amara"]}, "humans: amara stands twice"),
        ({"scenes": ["mapel"]}, "scenes: there is no home 'mapel' (did you mean maple?"),
        ({"method": "theirs"}, "method: there is no method 'theirs'"),
        ({"setting": 2}, "scenes: setting 2 needs 5, and only maple exists."),
        ({"setting": 4}, "scenes: setting 4 needs 3, and only maple exists."),
        ({"setting": 3, "humans": ["amara", "bruno"]}, "humans: setting 3 takes 3 or a multiple of it, not 2"),
        ({"robot": "tank"}, "robot: there is no robot 'tank' (known are fetch, husky_panda, stretch, tiago)."),
        ({"motions": Path("/nowhere")}, "motions: /nowhere must be a folder with .npy or .npz clips"),
        ({"prompts": Path("/nowhere")}, "prompts: /nowhere must be a folder of prompt files"),
    ],
)
def test_names_are_checked_against_what_there_is(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigError) as err:
        resolve(Config(**changes), KNOWN)
    assert str(err.value).startswith(sentence)


def test_imported_people_live_where_the_environment_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("COOPERA_DATA_DIR", str(tmp_path))
    assert default_data_dir() == tmp_path
    monkeypatch.delenv("COOPERA_DATA_DIR")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "share"))
    assert default_data_dir() == tmp_path / "share" / "coopera"


def test_how_much_search_finds_can_be_said_and_stands_in_the_run(tmp_path: Path) -> None:
    config = load_config(study(tmp_path, "search: {motions: 2}\n"), {"search": {"objects": 12}})
    assert (config.search.objects, config.search.motions) == (12, 2)
    assert yaml.safe_load(config.to_yaml())["search"] == {"objects": 12, "motions": 2}
    with pytest.raises(ConfigError, match="--search-objects must be a whole number from 1 to 1000, not 0"):
        load_config(flags={"search": {"objects": 0}})
    with pytest.raises(ConfigError, match=r"study.yaml: search.motions must be a whole number from 1 to 1000"):
        load_config(study(tmp_path, "search: {motions: many}\n"))


def test_a_wrong_household_file_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    wrong = study(tmp_path, "extends: shipped\nactivities: [{id: kite}]\n")
    models = {"human": f"offline:{wrong}"}
    with pytest.raises(ConfigError, match=r"study\.yaml: activity 'kite', field 'wordings'"):
        resolve(load_config(flags={"models": models, "out": tmp_path / "run"}), KNOWN)
    assert not (tmp_path / "run").exists()


def test_a_robot_that_sees_nothing_gets_small_pictures_whatever_it_knows() -> None:
    sizes = [load_config(flags={"models": {"robot": spec}}).frame_size for spec in ("offline:my.yaml", "openai:x")]
    assert sizes == [(320, 240), (1024, 768)]
