"""The user studies on paper and in the browser: one self-contained page, its key, and people's answers read back."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from pydantic import ValidationError

from coopera.config.files import canonical_json, read_text, write_output
from coopera.core.errors import ConfigError
from coopera.evaluation.people.studies import Answers, Key, Made, Study
from coopera.rundir.lives import read_answers

TEMPLATES = Path(__file__).parents[1] / "templates"
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
    style, script = ((TEMPLATES / name).read_text(encoding="utf-8") for name in ("study.css", "study.js"))
    return environment.get_template("study.html.j2").render(study=study, style=Markup(style), script=Markup(script))


def read_key(path: Path) -> Key:
    """Read study-key.json.

    Raises:
        ConfigError: If it is no key.
    """
    try:
        return Key.model_validate(read_answers(path))
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
            found.append(Answers.model_validate(read_answers(path)))
        except ValidationError as err:
            raise ConfigError(f"{path}: these are no answers to a user study ({_first(err)}).") from err
    return found


def _from_paper(path: Path, study: str) -> list[Answers]:
    reader = csv.reader(io.StringIO(read_text(path, "CSV file"), newline=""), strict=True)
    answers: dict[str, dict[str, str]] = {}
    try:
        if tuple(name.strip().lower() for name in next(reader, [])) != _COLUMNS:
            raise ConfigError(f"{path}, line 1: the columns must be {', '.join(_COLUMNS)}.")
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(_COLUMNS):
                raise ConfigError(f"{path}, line {reader.line_num}: expected 3 cells, found {len(cells)}.")
            participant, question, answer = (cell.strip() for cell in cells)
            given = answers.setdefault(participant, {})
            if question in given:
                raise ConfigError(f"{path}, line {reader.line_num}: {participant!r} answered {question} before.")
            given[question] = answer.upper()
    except csv.Error as err:
        raise ConfigError(f"{path}, line {reader.line_num}: this is not valid CSV ({err}).") from err
    return [Answers(study=study, participant=name, answers=given) for name, given in answers.items()]


def _first(err: ValidationError) -> str:
    first = err.errors(include_url=False)[0]
    field = ".".join(str(part) for part in first["loc"]) or "the file"
    return f"{field}: {first['msg'].lower()}"
