"""Templates that can only say things: Jinja2, cut down to text, variables, `if`, `for` and harmless filters.

A prompt folder may come from anyone, so nothing in a template may reach Python's insides, read a file,
or run on and on. What is allowed is listed; everything else is refused when the file is read, with its line.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
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
MAX_NODES = 5_000  # parts of a template: a text, a name, a comparison
MAX_DEPTH = 60  # parts within each other; an if within an if is one deeper
MAX_SECONDS = 10.0  # for filling it

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
        length, end = 0, time.monotonic() + MAX_SECONDS
        try:
            for piece in self._code.generate(dict(variables)):
                if time.monotonic() > end:
                    raise PromptError(f"{self.file}: the prompt takes longer than {MAX_SECONDS:g} s to fill")
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
        for loop in tree.find_all(nodes.For):
            loop.body.insert(0, nodes.Output([nodes.TemplateData("")]))  # each round is seen, even if it says nothing
        names = find_undeclared_variables(tree) - set(environment.globals)
        code = environment.compile(tree, name=file, filename=file)
    except TemplateSyntaxError as err:
        raise PromptError(f"{file}:{err.lineno}: {_sentence(err)}") from err
    except (RecursionError, SyntaxError, MemoryError) as err:  # SyntaxError: Python's own limit of nesting
        raise PromptError(f"{file}: the template is nested too deeply") from err
    except _FAILURES as err:  # what it says without any variable was tried already
        raise PromptError(f"{file}: {_sentence(err)}") from err
    used = {node.name: node.lineno for node in reversed(list(tree.find_all(nodes.Name))) if node.name in names}
    return Template(file, dict(sorted(used.items())), JinjaTemplate.from_code(environment, code, environment.globals))


class _Method:
    """A method or function of Python's: it can be called, and never written out, which would show an address."""

    def __init__(self, method: Callable[..., Any]) -> None:
        self._method = method

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._method(*args, **kwargs)

    def __repr__(self) -> str:
        raise TypeError("a method cannot be written out: call it, with ()")


class _Lazy:
    """What a filter such as `map` gives: it can be walked through, and never written out, as a `_Method`."""

    def __init__(self, values: Iterator[Any]) -> None:
        self._values = values

    def __iter__(self) -> Iterator[Any]:
        return self._values

    def __repr__(self) -> str:
        raise TypeError("what comes one by one cannot be written out: use join or list")


class _Environment(ImmutableSandboxedEnvironment):
    """Jinja's sandbox, in which nothing has an address of Python's in its text."""

    def getattr(self, obj: Any, attribute: str) -> Any:
        return _as_said(super().getattr(obj, attribute))

    def getitem(self, obj: Any, argument: Any) -> Any:
        return _as_said(super().getitem(obj, argument))


def _as_said(value: Any) -> Any:
    return _Method(value) if callable(value) and not isinstance(value, Undefined) else value


def _never_an_address(known: Callable[..., Any]) -> Callable[..., Any]:
    """A filter whose generators, which Jinja would write out as their address, are `_Lazy`."""

    @functools.wraps(known)
    def never_an_address(*args: Any, **kwargs: Any) -> Any:
        found = known(*args, **kwargs)
        return _Lazy(found) if isinstance(found, Iterator) else found

    return never_an_address


@functools.cache
def _environment() -> ImmutableSandboxedEnvironment:
    environment = _Environment(
        undefined=StrictUndefined, finalize=_sayable, autoescape=False, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals = {"range": _Method(_short_range)}
    allowed = {name: known for name, known in environment.filters.items() if name in _FILTERS} | _OURS
    environment.filters = {name: _never_an_address(known) for name, known in allowed.items()}
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
    waiting: list[tuple[nodes.Node, int, int]] = [(tree, 0, 0)]
    count = 0
    while waiting:
        node, loops, deep = waiting.pop()
        loops, count = loops + isinstance(node, nodes.For), count + 1
        problem = _problem(node, loops)
        if deep > MAX_DEPTH:
            problem = f"it is nested more than {MAX_DEPTH} deep"
        if count > MAX_NODES:
            problem = f"a template may have {MAX_NODES} parts at most"
        if problem is not None:
            raise PromptError(f"{file}:{node.lineno}: {problem}")
        waiting += [(child, loops, deep + 1) for child in reversed([*node.iter_child_nodes()])]


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
