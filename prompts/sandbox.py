"""Templates that can only say things: Jinja2, cut down to text, variables, `if`, `for` and harmless filters.

A prompt folder may come from anyone, so nothing in a template may reach Python's insides, read a file,
or run on and on. What is allowed is listed; everything else is refused when the file is read, with its line.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any

from jinja2 import StrictUndefined, TemplateError, TemplateSyntaxError, Undefined, nodes
from jinja2 import Template as JinjaTemplate
from jinja2.meta import find_undeclared_variables
from jinja2.sandbox import ImmutableSandboxedEnvironment

from coopera.core.errors import PromptError
from coopera.core.household import plain

MAX_RANGE = 100
MAX_NUMBER = 1000
MAX_LOOP_DEPTH = 2
MAX_RENDERED = 400_000  # characters

_FILTERS = frozenset(
    ("abs", "capitalize", "count", "d", "default", "dictsort", "first", "float", "int", "items", "join", "last")
    + ("length", "list", "lower", "map", "max", "min", "reject", "rejectattr", "reverse", "round", "select")
    + ("selectattr", "sort", "string", "sum", "title", "tojson", "trim", "truncate", "unique", "upper", "wordcount")
)
_METHODS = frozenset(
    ("capitalize", "endswith", "get", "items", "keys", "lower", "startswith", "strip", "title", "upper", "values")
)
_NODES = (
    *(nodes.Template, nodes.Output, nodes.TemplateData, nodes.Name, nodes.Const, nodes.List, nodes.Tuple, nodes.Dict),
    *(nodes.Pair, nodes.Getattr, nodes.Getitem, nodes.Slice, nodes.For, nodes.If, nodes.CondExpr, nodes.Filter),
    *(nodes.Test, nodes.Compare, nodes.Operand, nodes.And, nodes.Or, nodes.Not, nodes.Add, nodes.Sub, nodes.Neg),
    *(nodes.Pos, nodes.Concat, nodes.Call, nodes.Keyword),
)
_WORDS = {
    nodes.Include: "include",
    nodes.Import: "import",
    nodes.FromImport: "import",
    nodes.Extends: "extends",
    nodes.Mul: "*",
    nodes.Pow: "**",
    nodes.Mod: "%",
    nodes.Div: "/",
    nodes.FloorDiv: "//",
    nodes.Assign: "set",
    nodes.AssignBlock: "set",
}
_FAILURES = (TemplateError, ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


@dataclass(frozen=True, slots=True)
class Template:
    """A checked template.

    Attributes:
        file: What error messages call it.
        variables: The variables it uses, each with the line of its first use.
    """

    file: str
    variables: Mapping[str, int]
    _code: JinjaTemplate

    def fill(self, variables: Mapping[str, Any]) -> str:
        """Render, without leading or trailing blank lines.

        Raises:
            PromptError: Naming file and line, if a value lacks what the template asks of it or the text grows too long.
        """
        pieces: list[str] = []
        length = 0
        try:
            for piece in self._code.generate(dict(variables)):
                pieces.append(piece)
                length += len(piece)
                if length > MAX_RENDERED:
                    raise PromptError(f"{self.file}: the filled prompt is longer than {MAX_RENDERED} characters")
        except _FAILURES as err:
            line = _line_in(err.__traceback__, self.file)
            raise PromptError(f"{self.file}{f':{line}' if line else ''}: {_sentence(err)}") from err
        return "".join(pieces).strip()


def by_room(objects: Mapping[str, Sequence[Any]]) -> dict[str, list[str]]:
    """Turn `{name: [id, room]}` into `{room: [names]}`: rooms sorted, the names of each in the given order."""
    rooms: dict[str, list[str]] = {}
    for name, (_, room) in objects.items():
        rooms.setdefault(room, []).append(name)
    return dict(sorted(rooms.items()))


def kinds(names: Iterable[str]) -> list[str]:
    """Name each kind once, in words: "dining chair" for "dining_chair_1" and "dining_chair_2"."""
    return list(dict.fromkeys(map(plain, names)))


def by_kind(lists: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    """Turn `{name: [texts]}` into `{kind in words: [texts]}`, what is said of several of a kind once."""
    merged: dict[str, dict[str, None]] = {}
    for name, texts in lists.items():
        merged.setdefault(plain(name), {}).update(dict.fromkeys(texts))
    return {kind: list(texts) for kind, texts in merged.items()}


_OURS: dict[str, Any] = {"by_kind": by_kind, "by_room": by_room, "kinds": kinds}
"""Filters of our own, beside Jinja's: they print a home in few words."""


@functools.lru_cache(maxsize=256)
def compile_template(file: str, body: str, first_line: int) -> Template:
    """Parse and check a template whose first line is line `first_line` (from 1) of its file.

    Raises:
        PromptError: Naming file and line.
    """
    environment = _environment()
    source = "\n" * (first_line - 1) + body
    try:
        tree = environment.parse(source, filename=file)
        _refuse_what_is_not_allowed(file, tree)
        names = find_undeclared_variables(tree) - set(environment.globals)
        code = environment.compile(tree, name=file, filename=file)
    except TemplateSyntaxError as err:
        raise PromptError(f"{file}:{err.lineno}: {_sentence(err)}") from err
    except RecursionError as err:
        raise PromptError(f"{file}: the template is nested too deeply") from err
    used = {node.name: node.lineno for node in reversed(list(tree.find_all(nodes.Name))) if node.name in names}
    return Template(file, dict(sorted(used.items())), JinjaTemplate.from_code(environment, code, environment.globals))


@functools.cache
def _environment() -> ImmutableSandboxedEnvironment:
    environment = ImmutableSandboxedEnvironment(
        undefined=StrictUndefined, finalize=_sayable, autoescape=False, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals = {"range": _short_range}
    environment.filters = {name: known for name, known in environment.filters.items() if name in _FILTERS} | _OURS
    return environment


def _sayable(value: object) -> object:
    """Let through what reads as text; a missing value or Python's own objects would leave rubbish in a prompt."""
    if value is None:
        raise TypeError("a value that may be missing (None) is written out: put it inside an if")
    if not isinstance(value, str | int | float | list | tuple | Mapping | Undefined):
        raise TypeError(f"a {type(value).__name__} cannot be written out")
    return value


def _short_range(*args: int) -> range:
    numbers = range(*args)
    if len(numbers) > MAX_RANGE:
        raise ValueError(f"a range may have at most {MAX_RANGE} numbers, not {len(numbers)}")
    return numbers


def _refuse_what_is_not_allowed(file: str, tree: nodes.Template) -> None:
    for node, depth in _walk(tree, 0):
        if (problem := _problem(node, depth)) is not None:
            raise PromptError(f"{file}:{node.lineno}: {problem}")


def _walk(node: nodes.Node, depth: int) -> Iterator[tuple[nodes.Node, int]]:
    depth += isinstance(node, nodes.For)
    yield node, depth
    for child in node.iter_child_nodes():
        yield from _walk(child, depth)


def _problem(node: nodes.Node, depth: int) -> str | None:
    if not isinstance(node, _NODES):
        word = _WORDS.get(type(node), type(node).__name__.lower())
        return f'"{word}" is not possible in a prompt: use text, variables, if, for and filters'
    if depth > MAX_LOOP_DEPTH:
        return f"loops may be nested {MAX_LOOP_DEPTH} deep at most"
    if isinstance(node, nodes.Getattr) and node.attr.startswith("_"):
        return f'the attribute "{node.attr}" is not for prompts'
    if isinstance(node, nodes.Const):
        return _problem_of_constant(node.value)
    if isinstance(node, nodes.Call):
        return _problem_of_call(node.node)
    if isinstance(node, nodes.Filter):
        if node.name not in _FILTERS | set(_OURS):
            known = ", ".join(sorted(_FILTERS | set(_OURS)))
            return f'there is no filter "{node.name}" for prompts: use one of {known}'
        given = [*node.args, *(keyword.value for keyword in node.kwargs)]
        if not all(isinstance(value, nodes.Const) for value in given):
            return f'what the filter "{node.name}" is given must be written out, not computed'
    return None


def _problem_of_constant(value: object) -> str | None:
    if isinstance(value, int | float) and not abs(value) <= MAX_NUMBER:
        return f"numbers in a prompt's braces may not pass {MAX_NUMBER}"
    if isinstance(value, str) and "__" in value:
        return "names with two underscores are not for prompts"
    return None


def _problem_of_call(called: nodes.Node) -> str | None:
    if isinstance(called, nodes.Name) and called.name == "range":
        return None
    if isinstance(called, nodes.Getattr) and called.attr in _METHODS:
        return None
    what = called.attr if isinstance(called, nodes.Getattr) else getattr(called, "name", "this")
    return f'"{what}" cannot be called in a prompt'


def _line_in(traceback: TracebackType | None, file: str) -> int | None:
    line = None
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == file:
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return line


def _sentence(err: BaseException) -> str:
    return " ".join(str(err).split()) or type(err).__name__
