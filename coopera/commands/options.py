"""Options that several commands share; those that are settings are made from the settings' declarations."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, get_origin

import typer
from typer.models import OptionInfo

from coopera.config.declared import OLD_WORDS_GO, Declared
from coopera.config.schema import SETTINGS
from coopera.core.errors import ConfigError, deprecated

RunPath = Annotated[Path, typer.Argument(metavar="RUN", help="A run directory, such as runs/run-001.")]
AsJson = Annotated[bool, typer.Option("--json", help="End with one line of JSON on standard output.")]

PageHost = Annotated[
    str,
    typer.Option("--host", metavar="ADDRESS", help="Where pages listen; on another than 127.0.0.1 they need a token."),
]
PagePort = Annotated[int, typer.Option("--port", metavar="N", help="The pages' port; 0 takes any that is free.")]
PageName = Annotated[
    str | None,
    typer.Option("--name", metavar="NAME", help="Name of a proxy with TLS before the pages; they then need a token."),
]
STOPPED = 130  # what shells give a program that Ctrl-C ended
HOST, PORT = "127.0.0.1", 8765


def _completer(one: Declared) -> Callable[[str], list[str]]:
    """Return what completes a setting's value on a shell; of a list, its last name."""

    def complete(incomplete: str) -> list[str]:
        before, comma, last = incomplete.rpartition(",") if get_origin(one.type) is list else ("", "", incomplete)
        names = [str(value) for value in one.values]
        if one.words.listed:
            from coopera.commands.rows import rows_of

            names = [row["id"] for row in rows_of(one.words.listed)]
        return [f"{before}{comma}{name}" for name in names if name.startswith(last)]

    return complete


def option(name: str, *flags: str) -> OptionInfo:
    """The option of a setting: its flag (or others), what it decides, what it may be, and what holds without it."""
    one = SETTINGS[name]
    names = flags or (one.words.flag or "",)
    found: OptionInfo = typer.Option(
        *names, metavar=one.metavar, help=one.help, show_default=False, autocompletion=_completer(one)
    )
    return found


Model = Annotated[str | None, option("models")]
BaseUrl = Annotated[str | None, option("base_url")]
PromptFolder = Annotated[Path | None, option("prompts")]
DataFolder = Annotated[Path | None, option("data_dir", "--out")]
CallBudget = Annotated[int | None, option("budget.calls")]
TokenBudget = Annotated[int | None, option("budget.tokens")]
MoneyBudget = Annotated[float | None, option("budget.money")]


def takes_settings(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the flags of all settings that have one, in the place of its parameter `flags`.

    The command receives there what was given, as `load_config` takes it.
    """
    signature = inspect.signature(command, eval_str=True)
    made = {one.name.replace(".", "_"): one for one in SETTINGS.values() if one.words.flag}
    old = {f"formerly_{name}": one for name, one in made.items() if one.words.formerly}
    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        parameters += [*_parameters(made), *_parameters(old, old=True)] if parameter.name == "flags" else [parameter]

    def with_settings(**given: Any) -> None:
        flags = {one.name: given.pop(name) for name, one in made.items()}
        for name, one in old.items():
            if (value := given.pop(name)) is not None:
                flags[one.name] = _given_by_old_flag(one, value, flags[one.name])
        command(flags=nested(flags), **given)

    with_settings.__name__, with_settings.__doc__ = command.__name__, command.__doc__
    with_settings.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    return with_settings


def nested(flags: Mapping[str, Any]) -> dict[str, Any]:
    """What flags give, as `load_config` takes it: by field, those of a section in a mapping; None was not given."""
    found: dict[str, Any] = {}
    for name, value in flags.items():
        one = SETTINGS[name]
        section, _, field = name.rpartition(".")
        if value is None:
            continue
        if one.section:
            found[name] = dict.fromkeys(one.section.model_fields, value) | found.get(name, {})
        elif section:
            found[section] = found.get(section, {}) | {field: value}
        else:
            found[name] = as_list(value) if get_origin(one.type) is list else value
    return found


def as_list(text: str | None) -> list[str] | None:
    """Split "a,b" into its names; None stays None."""
    return None if text is None else [name.strip() for name in text.split(",") if name.strip()]


def _given_by_old_flag(one: Declared, value: Any, today: Any) -> Any:
    before, now = _old_flag(one), one.words.flag
    if today is not None:
        raise ConfigError(f"{before} and {now} are one setting, and only {now} may be given.")
    deprecated(before, f"{now}", OLD_WORDS_GO)
    return value


def _old_flag(one: Declared) -> str:
    return f"--{one.words.formerly}"


def _parameters(made: Mapping[str, Declared], *, old: bool = False) -> Iterator[inspect.Parameter]:
    for name, one in made.items():
        kind = type(one.values[0]) if one.values else one.type if one.type in (int, float, bool, Path) else str
        found = typer.Option(_old_flag(one), hidden=True) if old else option(one.name)
        annotation = Annotated[kind | None, found]  # type: ignore[valid-type]
        yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=annotation)
