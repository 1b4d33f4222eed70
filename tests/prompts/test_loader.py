"""The prompt folder: what is shipped, what may replace it, and what is refused with file and line."""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coopera.core.asks import PROMPTS
from coopera.core.errors import PromptError
from coopera.prompts import PromptLibrary, check
from coopera.prompts.examples import examples
from coopera.prompts.loader import SHIPPED

GUESSES = "human/feedback_intentions"
HEAD = """---
id: human/feedback_intentions
version: 2
model_role: human
reply: VerdictsReply
temperature: 0.25
inputs: [guesses]
paper: ours
---
"""
GOOD = HEAD + "{% for guess in guesses %}\n- {{ guess }}\n{% endfor %}\n"


def overlay(folder: Path, text: str, name: str = GUESSES) -> Path:
    path = folder / f"{name}.md"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def refusal(folder: Path, text: str, name: str = GUESSES) -> str:
    """The error of an overlay with this file, which must name the file; returned without its path."""
    path = overlay(folder, text, name)
    with pytest.raises(PromptError) as err:
        PromptLibrary(folder)
    assert str(err.value).startswith(str(path))
    assert "\n" not in str(err.value)
    assert check(folder) == [str(err.value)]
    return str(err.value).removeprefix(str(path))


@pytest.fixture(scope="module")
def shipped() -> PromptLibrary:
    return PromptLibrary()


def test_a_rendered_prompt_carries_what_the_door_needs(shipped: PromptLibrary) -> None:
    rendered = shipped.render("judge/tasks", examples("judge/tasks")[0])
    raw = (SHIPPED / "judge/tasks.md").read_bytes()
    assert (rendered.role, rendered.reply) == ("judge", "VerdictsReply")
    assert rendered.sha == hashlib.sha256(raw).hexdigest() == shipped.hashes()["judge/tasks"]


def test_an_overlay_replaces_only_the_files_it_has(shipped: PromptLibrary, tmp_path: Path) -> None:
    path = overlay(tmp_path, GOOD)
    mine = PromptLibrary(tmp_path)
    assert mine.render(GUESSES, examples(GUESSES)[0]).text.startswith("- Unwind")
    assert mine.path(GUESSES) == path
    assert mine.head(GUESSES).version == 2
    changed = {name for name in PROMPTS if mine.hashes()[name] != shipped.hashes()[name]}
    assert changed == {GUESSES}
    assert check(tmp_path) == []


def test_a_copy_of_the_shipped_folder_is_a_good_overlay() -> None:
    assert check(SHIPPED) == []


@pytest.mark.parametrize("form", [GOOD.replace("\n", "\r\n"), "\ufeff" + GOOD])
def test_windows_line_ends_and_byte_order_marks_are_accepted(tmp_path: Path, form: str) -> None:
    overlay(tmp_path, "").write_bytes(form.encode())
    assert PromptLibrary(tmp_path).render(GUESSES, examples(GUESSES)[0]).text.count("- ") == 3


def test_a_folder_that_is_missing_empty_or_holds_unknown_prompts_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PromptError, match="no such folder"):
        PromptLibrary(tmp_path / "nowhere")
    with pytest.raises(PromptError, match="no prompt in this folder"):
        PromptLibrary(tmp_path)
    overlay(tmp_path, GOOD, "humans/intention")
    with pytest.raises(PromptError, match=r"humans/intention\.md: .*did you mean human/intention\?"):
        PromptLibrary(tmp_path)


def test_hidden_files_and_other_kinds_of_file_are_passed_over(tmp_path: Path) -> None:
    overlay(tmp_path, GOOD)
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "HEAD").write_text("x")
    (tmp_path / "human" / ".feedback.md.swp").write_text("x")
    (tmp_path / "picture.png").write_bytes(b"x")
    assert PromptLibrary(tmp_path).head(GUESSES).version == 2


@pytest.mark.parametrize(
    ("was", "now", "said"),
    [
        ("id: human/feedback_intentions", "id: human/intention", ':2: "id" must be human/feedback_intentions'),
        ("version: 2", "version: two", ':3: "version"'),
        ("version: 2", "version: 0", ':3: "version"'),
        ("version: 2\n", "", ':1: "version": Field required'),
        ("model_role: human", "model_role: robot", ':4: "model_role" must be human, not robot'),
        ("model_role: human", "model_role: cat", ':4: "model_role"'),
        ("reply: VerdictsReply", "reply: TraitsReply", ':5: "reply" must be VerdictsReply'),
        ("temperature: 0.25", "temperature: hot", ':6: "temperature"'),
        ("temperature: 0.25", "temperature: .nan", ':6: "temperature"'),
        ("temperature: 0.25", "temperature: 3", ':6: "temperature"'),
        ("inputs: [guesses]", "inputs: [guesses, guesses]", ':7: "inputs" names guesses twice'),
        ("inputs: [guesses]", "inputs: [guesses, weather]", ':7: there is no variable "weather"'),
        ("inputs: [guesses]", "inputs: [guesses, time]", ':7: "inputs" names "time", which the text does not use'),
        ("inputs: [guesses]", "inputs: []", ':10: the variable "guesses" is used but is not among "inputs"'),
        ("inputs: [guesses]", "inputs: [guesses", ":8: the front matter is not YAML"),
        ("paper: ours", "paper: ''", ':8: "paper"'),
        ("paper: ours", "papers: ours", ':1: "paper": Field required'),
        ("paper: ours", "paper: !!python/object/apply:os.system [ls]", ":8: the front matter is not YAML"),
        ("---\nid", "id", ":1: a prompt begins with its front matter"),
        ("paper: ours\n---", "paper: ours", ":1: a prompt begins with its front matter"),
        ("{{ guess }}", "{{ gues }}", ':11: there is no variable "gues" here: did you mean guesses?'),
        ("{{ guess }}", "{{ guess.text }}", ":11: 'str object' has no attribute 'text'"),
        ("{{ guess }}", "{{ guess", ":12: "),
        ("{% endfor %}", "", ":11: "),
        ("{{ guess }}", "{{ guess | shout }}", ":11: "),
    ],
)
def test_a_broken_file_is_refused_with_its_line(tmp_path: Path, was: str, now: str, said: str) -> None:
    assert was in GOOD
    assert refusal(tmp_path, GOOD.replace(was, now)).startswith(said)


@pytest.mark.parametrize(
    "attack",
    [
        "{{ ''.__class__ }}",
        "{{ ''.__class__.__mro__[1].__subclasses__() }}",
        "{{ guesses['__class__'] }}",
        "{{ guesses[('_' ~ '_class_' ~ '_')] }}",
        "{{ guesses | attr('append') }}",
        "{{ guesses | map('attr', 'real') | list }}",
        "{{ guesses.append(1) }}",
        "{{ guesses[0].format(guesses) }}",
        "{{ '%999999999d' % 1 }}",
        "{{ 'a' * 999 }}",
        "{{ 10 ** 10 }}",
        "{% for a in range(10 ** 9) %}x{% endfor %}",
        "{% for a in range(999999999) %}x{% endfor %}",
        "{% for a in range(999) %}x{% endfor %}",
        "{% for a in guesses %}{% for b in guesses %}{% for c in guesses %}x{% endfor %}{% endfor %}{% endfor %}",
        "{% for a in guesses recursive %}{{ loop(guesses) }}{% endfor %}",
        "{% include '/etc/passwd' %}",
        "{% import '/etc/passwd' as x %}",
        "{% extends '/etc/passwd' %}",
        "{% macro again() %}{{ again() }}{% endmacro %}{{ again() }}",
        "{% set a = guesses %}",
        "{{ lipsum() }}",
        "{{ cycler.__init__.__globals__ }}",
        "{{ self }}",
        "{{ range }}",
        "{{ guesses | map('upper') }}",
        "{{ " + "(" * 500 + "1" + ")" * 500 + " }}",
        "{{ guesses | round }}",
        "{% if guesses %}" * 101 + "x" + "{% endif %}" * 101,
        "{% if guesses %}{{ 1 + 1 }}{% endif %}" * 900,
    ],
)
def test_a_template_cannot_reach_out_or_run_on(tmp_path: Path, attack: str) -> None:
    said = refusal(tmp_path, GOOD + attack + "\n")
    assert said.startswith(":13: ") or "nested too deeply" in said


@pytest.mark.parametrize(
    "attack",
    [
        "{{ guesses | map('map', 'upper') | list }}",
        "{{ guesses | map('map', 'upper') | join(', ') }}",
        "{{ guesses | map('upper') | upper }}",
        "{{ guesses | reverse | string }}",
        "{{ guesses | select('string') ~ '' }}",
        "{{ [guesses[0].upper] }}",
        "{{ guesses[0].upper ~ '' }}",
        "{{ guesses[0]['upper'] ~ '' }}",
        "{{ guesses | map(attribute='upper') | list }}",
        "{{ guesses | map(attribute='upper') | join }}",
        "{{ ''.upper ~ '' }}",
        "{{ range ~ '' }}",
        "{% for guess in guesses %}{{ loop.cycle ~ '' }}{% endfor %}",
    ],
)
def test_a_template_never_writes_out_where_something_lies_in_memory(tmp_path: Path, attack: str) -> None:
    assert "cannot be written out" in refusal(tmp_path, GOOD + attack + "\n")


def test_a_template_that_says_nothing_for_ever_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    overlay(tmp_path, HEAD + "{% for a in guesses %}{% for b in guesses %}{% endfor %}{% endfor %}\n{{ guesses[0] }}\n")
    library = PromptLibrary(tmp_path)
    assert library.render(GUESSES, {"guesses": ["nap"]}).text == "nap"
    monkeypatch.setattr("coopera.prompts.sandbox.MAX_SECONDS", -1.0)  # of the clock, whatever the machine
    with pytest.raises(PromptError, match="takes longer than"):
        library.render(GUESSES, {"guesses": ["nap"]})


@pytest.mark.parametrize("value", ["!!bool x", "!!timestamp x", "0x_", "2024-13-45", "[" * 200])
def test_a_front_matter_of_odd_values_is_refused_with_its_line(tmp_path: Path, value: str) -> None:
    said = refusal(tmp_path, GOOD.replace("temperature: 0.25", f"temperature: {value}"))
    assert re.match(r":\d+: ", said)


def test_a_prompt_that_grows_without_end_is_cut_short(tmp_path: Path) -> None:
    overlay(tmp_path, HEAD + "{% for guess in guesses %}\n{{ guess }}\n{% endfor %}\n")
    with pytest.raises(PromptError, match="longer than"):
        PromptLibrary(tmp_path).render(GUESSES, {"guesses": ["x" * 1000] * 500})


def test_harmless_jinja_is_allowed(tmp_path: Path) -> None:
    body = (
        "{# a note #}{% for n in range(2) %}{{ n }}{% endfor %} {{ guesses | length + 1 }} {{ guesses[0][:6] | upper }}"
        " {{ guesses | join(', ') | truncate(5, true, '~', 0) }}"
        " {{ 'many' if guesses else 'none' }} {% raw %}{{ x }}{% endraw %}\n"
    )
    overlay(tmp_path, HEAD + body)
    text = PromptLibrary(tmp_path).render(GUESSES, {"guesses": ["nap and read"]}).text
    assert text == "01 2 NAP AN nap ~ many {{ x }}"


def test_a_home_is_printed_by_room_and_by_kind(tmp_path: Path) -> None:
    head = HEAD.replace("[guesses]", "[can, fixed]").replace(GUESSES, "human/tasks_type2")
    head = head.replace("VerdictsReply", "FreeMotionReply")
    body = (
        "{% for room, names in (fixed | by_room).items() %}{{ room }}: {{ names | join(', ') }}; {% endfor %}"
        "{{ fixed | kinds | join(', ') }}; "
        "{% for kind, motions in (can | by_kind).items() %}{{ kind }}: {{ motions | join(', ') }}. {% endfor %}\n"
    )
    overlay(tmp_path, head + body, "human/tasks_type2")
    fixed = {"wing_chair_2": [5, "study"], "stove_1": [1, "kitchen"], "wing_chair_1": [2, "study"]}
    can = {"wing_chair_2": ["sit", "nap"], "stove_1": ["stir"], "wing_chair_1": ["sit", "read"]}
    text = PromptLibrary(tmp_path).render("human/tasks_type2", {"fixed": fixed, "can": can}).text
    rooms, can_do = "kitchen: stove_1; study: wing_chair_2, wing_chair_1", "wing chair: sit, nap, read. stove: stir."
    assert text == f"{rooms}; wing chair, stove; {can_do}"


def test_a_filter_for_homes_refuses_what_is_no_home(tmp_path: Path) -> None:
    assert ":10: " in refusal(tmp_path, HEAD + "{{ guesses | by_room }}\n")


def test_a_value_that_may_be_missing_must_be_guarded(tmp_path: Path) -> None:
    head = HEAD.replace(GUESSES, "robot/traits").replace("human", "robot").replace("VerdictsReply", "TraitsReply")
    head = head.replace("[guesses]", "[profile]")
    assert ":10: " in refusal(tmp_path, head + "So far: {{ profile }}\n", "robot/traits")
    overlay(tmp_path, head + "So far: {{ profile or 'nothing' }}\n", "robot/traits")
    assert PromptLibrary(tmp_path).names


def test_files_that_are_no_text_or_too_long_are_refused(tmp_path: Path) -> None:
    path = overlay(tmp_path, "")
    path.write_bytes(GOOD.encode() + b"\n\xff\xfe")
    with pytest.raises(PromptError, match=r"\.md:14: a prompt must be UTF-8"):
        PromptLibrary(tmp_path)
    path.write_text(GOOD + "x" * 70_000)
    with pytest.raises(PromptError, match="at most 65536 bytes"):
        PromptLibrary(tmp_path)


def test_check_names_every_broken_file(tmp_path: Path) -> None:
    overlay(tmp_path, "nothing")
    overlay(tmp_path, GOOD, "robot/traits")
    overlay(tmp_path, GOOD, "robot/dance")
    problems = check(tmp_path)
    assert len(problems) == 3
    assert check(tmp_path / "nowhere") == [f"{tmp_path / 'nowhere'}: there is no such folder of prompts"]


def test_rendering_wants_every_declared_input_and_no_stranger(shipped: PromptLibrary) -> None:
    variables = dict(examples("judge/tasks")[0])
    with pytest.raises(PromptError, match=r'judge/tasks\.md:7: "mood" is not a variable'):
        shipped.render("judge/tasks", {**variables, "mood": "good"})
    del variables["offers"]
    with pytest.raises(PromptError, match=r'judge/tasks\.md:7: "offers" was not given'):
        shipped.render("judge/tasks", variables)
    with pytest.raises(PromptError, match="did you mean judge/tasks"):
        shipped.render("judge/task", variables)


def test_an_error_while_rendering_names_file_and_line(shipped: PromptLibrary) -> None:
    variables = {**examples("judge/tasks")[0], "offers": [{"text": "bring the mug"}]}
    with pytest.raises(PromptError, match=r"judge/tasks\.md:\d+: 'dict object' has no attribute 'thought'") as err:
        shipped.render("judge/tasks", variables)
    line = int(str(err.value).split(":")[1])
    assert "offer.thought" in (SHIPPED / "judge/tasks.md").read_text().splitlines()[line - 1]


@settings(max_examples=60)
@given(st.lists(st.text(max_size=40), max_size=4))
def test_what_people_write_never_acts_as_a_template(shipped: PromptLibrary, guesses: list[str]) -> None:
    marked = [f"{{{{ 7*7 }}}}{guess}{{% endfor %}}" for guess in guesses]
    text = shipped.render(GUESSES, {**examples(GUESSES)[0], "guesses": marked}).text
    assert all(guess in text for guess in marked)


def test_show_gives_the_file_or_the_filled_text(shipped: PromptLibrary) -> None:
    assert shipped.show("judge/tasks") == (SHIPPED / "judge/tasks.md").read_text()
    assert "bring the mug" in shipped.show("judge/tasks", filled=True)


def test_importing_the_room_imports_nothing_heavy() -> None:
    heavy = "{'torch', 'langchain_core', 'transformers'}"
    code = f"import sys, prompts; prompts.PromptLibrary(); print({heavy} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
