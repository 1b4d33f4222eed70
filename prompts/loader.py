"""The prompt folder: every file read and checked before the first model call, and filled when asked for.

A prompt is a Markdown file `<role>/<name>.md`: YAML front matter between two lines of `---`, then a template
(`coopera.prompts.sandbox`). The front matter has exactly these keys:

- `id`: the prompt's name, as its path says;
- `version`: a whole number from 1, raised when the wording changes, since that changes results;
- `model_role`: human, robot or judge: whose language model answers; or classifier, for the text that one is tuned on;
- `reply`: the type of the answer, from `coopera.core.replies`; its JSON schema is added by the door, not written here;
- `temperature`: 0 to 2;
- `inputs`: the variables that the template uses, from `coopera.core.asks`;
- `paper`: where the paper has this prompt, or "ours".
"""

from __future__ import annotations

import difflib
import functools
import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import Field, ValidationError

from coopera.core.asks import ASKS, INSTRUCTION, PROMPTS
from coopera.core.clock import hour_label
from coopera.core.errors import PromptError
from coopera.core.hour import Example
from coopera.core.people import Frozen
from coopera.core.protocols import Rendered, Role
from coopera.core.strict_yaml import load_yaml
from coopera.prompts.examples import examples
from coopera.prompts.sandbox import Template, compile_template

SHIPPED = Path(__file__).parent
MAX_BYTES = 65_536
_TEXT = {".md", ".markdown", ".txt", ""}


class FrontMatter(Frozen):
    """The head of a prompt file."""

    id: str
    version: Annotated[int, Field(strict=True, ge=1)]
    model_role: Role | Literal["classifier"]
    reply: str
    temperature: Annotated[float, Field(strict=True, ge=0, le=2, allow_inf_nan=False)]
    inputs: list[str]
    paper: Annotated[str, Field(min_length=1)]


@dataclass(frozen=True, slots=True)
class Prompt:
    """A checked prompt file."""

    path: Path
    text: str
    sha: str
    head: FrontMatter
    template: Template


class PromptLibrary:
    """All prompts, the shipped ones and a folder's that replace them; implements `coopera.core.protocols.Prompts`."""

    def __init__(self, overlay: Path | None = None) -> None:
        """Read and check every file, filling each with example variables.

        Args:
            overlay: A folder whose files replace the shipped ones of the same path.

        Raises:
            PromptError: Naming file and line of the first problem.
        """
        self._prompts = {name: _read(name, SHIPPED / f"{name}.md") for name in sorted(PROMPTS)}
        if overlay is not None:
            for name, path in _files_of(overlay):
                self._prompts[name] = _read(name, path)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all prompts, sorted."""
        return tuple(self._prompts)

    def render(self, name: str, variables: Mapping[str, Any]) -> Rendered:
        """Fill a prompt that is asked.

        Args:
            name: Such as "human/intention".
            variables: At least the declared inputs, and only what `coopera.core.asks` has for this prompt.

        Raises:
            PromptError: Naming file and line.
        """
        text, prompt = self.fill(name, variables), self._of(name)
        return Rendered(
            name=name,
            role=ASKS[name].role,
            text=text,
            sha=prompt.sha,
            reply=prompt.head.reply,
            temperature=prompt.head.temperature,
        )

    def instruct(self, example: Example) -> str:
        """Fill the classifiers' instruction; a causal model's next token is its Yes or No.

        Raises:
            PromptError: Naming file and line.
        """
        variables = {
            "candidate": example.candidate,
            "intention": example.intention,
            "profile": example.profile,
            "big_five": str(example.big_five or ""),
            "intentions": example.intentions,
            "tasks": example.tasks,
            "time": hour_label(example.hour),
            "place": None if example.rank is None else example.rank + 1,
        }
        return self.fill(INSTRUCTION, variables) + "\n"

    def fill(self, name: str, variables: Mapping[str, Any]) -> str:
        """Fill any prompt's template.

        Raises:
            PromptError: Naming file and line.
        """
        prompt = self._of(name)
        missing = [f'"{i}"' for i in prompt.head.inputs if i not in variables]
        surplus = [f'"{given}"' for given in sorted(set(variables) - PROMPTS[name].variables)]
        if missing or surplus:
            wrong = (
                f"{', '.join(missing)} was not given" if missing else f"{', '.join(surplus)} is not a variable of it"
            )
            raise PromptError(f"{prompt.path}:{_line_of('inputs', prompt.text)}: {wrong}")
        return prompt.template.fill({i: variables[i] for i in prompt.head.inputs})

    def show(self, name: str, *, filled: bool = False) -> str:
        """A prompt's file as it stands, or its text filled with an example.

        Raises:
            PromptError: If there is no such prompt.
        """
        prompt = self._of(name)
        return self.fill(name, examples(name)[0]) if filled else prompt.text

    def head(self, name: str) -> FrontMatter:
        """A prompt's front matter."""
        return self._of(name).head

    def path(self, name: str) -> Path:
        """The file that a prompt was read from."""
        return self._of(name).path

    def hashes(self) -> dict[str, str]:
        """SHA-256 of each prompt file's bytes, by name."""
        return {name: prompt.sha for name, prompt in self._prompts.items()}

    def _of(self, name: str) -> Prompt:
        if name not in self._prompts:
            raise PromptError(_unknown(name))
        return self._prompts[name]


def check(folder: Path) -> list[str]:
    """Say everything that is wrong with a folder of prompts, one sentence per file; nothing means it can be used."""
    problems: list[str] = []
    try:
        for relative, path in _all_files(folder):
            try:
                _read(_known(relative, path), path)
            except PromptError as err:
                problems.append(str(err))
    except PromptError as err:
        problems.append(str(err))
    return problems


def _all_files(folder: Path) -> list[tuple[str, Path]]:
    """All text files of a folder but hidden ones, as (path in the folder, path), sorted."""
    if not folder.is_dir():
        raise PromptError(f"{folder}: there is no such folder of prompts")
    found: list[tuple[str, Path]] = []
    for base, folders, files in os.walk(folder, onerror=_refuse):
        folders[:] = [name for name in folders if not name.startswith((".", "__"))]
        paths = [Path(base, name) for name in files if not name.startswith(".") and Path(name).suffix in _TEXT]
        found += [(path.relative_to(folder).as_posix(), path) for path in paths]
    if not found:
        raise PromptError(f"{folder}: there is no prompt in this folder; one would be called {next(iter(PROMPTS))}.md")
    return sorted(found)


def _refuse(err: OSError) -> None:
    raise PromptError(f"{err.filename}: this folder cannot be read: {err.strerror}") from err


def _files_of(folder: Path) -> Iterator[tuple[str, Path]]:
    for relative, path in _all_files(folder):
        yield _known(relative, path), path


def _known(relative: str, path: Path) -> str:
    name = relative.removesuffix(".md")
    if not relative.endswith(".md") or name not in PROMPTS:
        raise PromptError(f"{path}: {_unknown(name)}")
    return name


def _unknown(name: str) -> str:
    near = difflib.get_close_matches(name, PROMPTS, n=1)
    hint = f"did you mean {near[0]}?" if near else f"the prompts are {', '.join(sorted(PROMPTS))}"
    return f'there is no prompt "{name}": {hint}'


def _read(name: str, path: Path) -> Prompt:
    """Read and check one file, down to filling it with every example."""
    try:
        raw = path.read_bytes()
    except OSError as err:
        raise PromptError(f"{path}: the prompt cannot be read: {err.strerror}") from err
    return _checked(name, path, raw)


@functools.lru_cache(maxsize=256)
def _checked(name: str, path: Path, raw: bytes) -> Prompt:
    """The prompt that a file of these bytes holds: runs one after the other read most of them again."""
    if len(raw) > MAX_BYTES:
        raise PromptError(f"{path}: a prompt may have at most {MAX_BYTES} bytes, not {len(raw)}")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as err:
        line = raw[: err.start].count(b"\n") + 1
        raise PromptError(f"{path}:{line}: a prompt must be UTF-8 text") from err
    lines = text.splitlines()
    end = next((n for n, line in enumerate(lines[1:], start=1) if line.rstrip() == "---"), None)
    if not lines or lines[0].rstrip() != "---" or end is None:
        raise PromptError(f"{path}:1: a prompt begins with its front matter between two lines of ---")
    head = _front_matter(name, path, "\n".join(lines[1:end]), text)
    template = compile_template(str(path), "\n".join(lines[end + 1 :]), end + 2)
    _compare_inputs(name, path, text, head, template)
    for variables in examples(name):
        if not template.fill({i: variables[i] for i in head.inputs}):
            raise PromptError(f"{path}:{end + 2}: the prompt says nothing")
    return Prompt(path, text, hashlib.sha256(raw).hexdigest(), head, template)


def _front_matter(name: str, path: Path, front: str, text: str) -> FrontMatter:
    try:
        head = FrontMatter.model_validate(load_yaml(front))
    except yaml.MarkedYAMLError as err:
        line = err.problem_mark.line + 2 if err.problem_mark else 1
        raise PromptError(f"{path}:{line}: the front matter is not YAML: {err.problem}") from err
    except (yaml.YAMLError, ValueError, RecursionError) as err:
        if not isinstance(err, ValidationError):
            raise PromptError(f"{path}:1: the front matter is not YAML: {' '.join(str(err).split())}") from err
        problem = err.errors(include_url=False, include_input=False)[0]
        field = str(problem["loc"][0]) if problem["loc"] else "front matter"
        raise PromptError(f'{path}:{_line_of(field, text)}: "{field}": {problem["msg"]}') from err
    spec = PROMPTS[name]
    for field, expected in (("id", name), ("model_role", spec.role), ("reply", spec.reply)):
        if (given := getattr(head, field)) != expected:
            raise PromptError(f'{path}:{_line_of(field, text)}: "{field}" must be {expected}, not {given}')
    return head


def _compare_inputs(name: str, path: Path, text: str, head: FrontMatter, template: Template) -> None:
    line = _line_of("inputs", text)
    known = PROMPTS[name].variables
    repeated = sorted({i for i in head.inputs if head.inputs.count(i) > 1})
    if repeated:
        raise PromptError(f'{path}:{line}: "inputs" names {repeated[0]} twice')
    for variable, at in template.variables.items():
        if variable not in known:
            raise PromptError(f'{path}:{at}: there is no variable "{variable}" here: {_hint(variable, known)}')
        if variable not in head.inputs:
            raise PromptError(f'{path}:{at}: the variable "{variable}" is used but is not among "inputs"')
    for variable in head.inputs:
        if variable not in known:
            raise PromptError(f'{path}:{line}: there is no variable "{variable}" here: {_hint(variable, known)}')
        if variable not in template.variables:
            raise PromptError(f'{path}:{line}: "inputs" names "{variable}", which the text does not use')


def _hint(variable: str, known: frozenset[str]) -> str:
    near = difflib.get_close_matches(variable, sorted(known), n=1)
    return f"did you mean {near[0]}?" if near else f"it may be any of {', '.join(sorted(known))}"


def _line_of(field: str, text: str) -> int:
    """Line (from 1) on which a front matter field stands; 1 where it does not."""
    pattern = re.compile(rf"\s*[\"']?{re.escape(field)}[\"']?\s*:")
    return next((n for n, line in enumerate(text.splitlines(), start=1) if pattern.match(line)), 1)
