"""The user studies on paper and in the browser: one self-contained page, its key, and people's answers read back."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from pydantic import ValidationError

from coopera.config.files import canonical_json, write_output
from coopera.core.errors import ConfigError
from coopera.core.foreign.files import read_json, read_text
from coopera.core.foreign.tables import read_table
from coopera.evaluation.people.studies import Answers, Key, Made, Study
from coopera.report.look import TEMPLATES, style_with
from coopera.report.policy import content_policy

_COLUMNS = ("participant", "question", "answer")


def write_study(folder: Path, made: Made) -> None:
    """Write study.html for the participants, and study-key.json for whoever evaluates.

    Raises:
        ConfigError: If the folder cannot be written.
    """
    write_output(folder / "study.html", render(made.study))
    write_output(folder / "study-key.json", canonical_json(made.key.model_dump()))


def render(study: Study) -> str:
    """The page as text; it loads nothing, and sends nothing."""
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style, script = style_with("study.css"), (TEMPLATES / "study.js").read_text(encoding="utf-8")
    return environment.get_template("study.html.j2").render(
        study=study,
        style=Markup(style),
        script=Markup(script),
        policy=content_policy(styles=[style], scripts=[script]),
    )


def read_key(path: Path) -> Key:
    """Read study-key.json.

    Raises:
        ConfigError: If it is no key.
    """
    try:
        return Key.model_validate(read_json(path))
    except ValidationError as err:
        raise ConfigError(f"{path}: this is no key of a user study ({_first(err)}).") from err


def read_participants(paths: Sequence[Path], study: str) -> list[Answers]:
    """Read answers: JSON as the page saves it, one participant each, or CSV with participant, question, answer.

    CSV is for answers on paper, of any number of participants; they are taken to be of the study given.

    Raises:
        ConfigError: If a file cannot be used.
    """
    found: list[Answers] = []
    for path in paths:
        if path.suffix.lower() == ".csv":
            found += _from_paper(path, study)
            continue
        try:
            found.append(Answers.model_validate(read_json(path)))
        except ValidationError as err:
            raise ConfigError(f"{path}: these are no answers to a user study ({_first(err)}).") from err
    return found


def _from_paper(path: Path, study: str) -> list[Answers]:
    rows = read_table(path, read_text(path, "CSV file"))
    if tuple(name.strip().lower() for name in next(rows).cells) != _COLUMNS:
        raise ConfigError(f"{path}, line 1: the columns must be {', '.join(_COLUMNS)}.")
    answers: dict[str, dict[str, str]] = {}
    for line, cells in rows:
        if len(cells) != len(_COLUMNS):
            raise ConfigError(f"{path}, line {line}: expected 3 cells, found {len(cells)}.")
        participant, question, answer = (cell.strip() for cell in cells)
        given = answers.setdefault(participant, {})
        if question in given:
            raise ConfigError(f"{path}, line {line}: {participant!r} answered {question} before.")
        given[question] = answer.upper()
    return [Answers(study=study, participant=name, answers=given) for name, given in answers.items()]


def _first(err: ValidationError) -> str:
    first = err.errors(include_url=False)[0]
    field = ".".join(str(part) for part in first["loc"]) or "the file"
    return f"{field}: {first['msg'].lower()}"
