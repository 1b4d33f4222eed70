"""What there is to choose from, as rows. Each kind has one function, which tells id and description of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, Literal, TypeAlias

Rows: TypeAlias = list[dict[str, Any]]
Kind = Literal["methods", "measures", "classifiers", "robots", "homes", "people", "models", "prompts"]


def rows_of(kind: str) -> Rows:
    """All of a kind, each with at least `id` and, in one line, `about`."""
    return _KINDS[kind]()


def _methods() -> Rows:
    from coopera.evaluation import METHODS, known_methods

    return [{"id": name, "about": _of_method(METHODS.get(name))} for name in known_methods()]


def _of_method(method: Any) -> str:
    """A method as its differences from ours or the paper's; another package's is not loaded to be listed."""
    from coopera.evaluation.methods import OURS, PAPER

    if method is None:
        return "of another package"
    if method in (OURS, PAPER):
        return "the best that we have" if method is OURS else "the paper's method"
    if method.knows is not None:
        return "a ceiling: it knows the true person"
    if method.own is not None:
        own = getattr(method.own, "__doc__", None) or type(method.own).__doc__ or ""
        return f"another robot: {_first_sentence(own)}"
    names = [field.name for field in fields(method) if field.name != "name"]
    given = {
        base.name: {name: getattr(method, name) for name in names if getattr(method, name) != getattr(base, name)}
        for base in (PAPER, OURS)
    }
    base = min(given, key=lambda name: len(given[name]))
    said = ", ".join(f"{name}={getattr(value, '__name__', value)}" for name, value in given[base].items())
    return f"{base} with {said}"


def _measures() -> Rows:
    from coopera.evaluation.measuring import find_measure, known_measures

    return [{"id": name, "about": find_measure(name).about} for name in known_measures()]


def _classifiers() -> Rows:
    from coopera.models.classifiers import find_classifier, known_classifiers

    return [{"id": name, "about": find_classifier(name).about} for name in known_classifiers()]


def _robots() -> Rows:
    from coopera.simulation.bodies.robot import about_robot, known_robots

    return [{"id": name, "about": about_robot(name)} for name in known_robots()]


def _homes() -> Rows:
    from coopera.config.schema import default_data_dir
    from coopera.homes.stored import figures
    from coopera.simulation.homes.scene import list_scenes, load_scene

    folders = [default_data_dir() / "scenes"]
    found = [figures(load_scene(scene, folders)) for scene in list_scenes(folders)]
    about = "{rooms} rooms, {fixed} fixed and {movable} movable objects"
    return [
        {**{name: home[name] for name in ("id", "rooms", "fixed", "movable")}, "about": about.format(**home)}
        for home in found
    ]


def _people() -> Rows:
    from coopera.config.schema import default_data_dir
    from coopera.people.shipped import catalogue

    people = catalogue(default_data_dir())
    return [{**one.model_dump(mode="json"), "about": f"{one.name}: {_first_sentence(one.profile)}"} for one in people]


def _models() -> Rows:
    from coopera.models.backends import SPECS

    return [{"id": spec, "about": about} for spec, about in SPECS.items()]


def _prompts() -> Rows:
    return prompt_rows(None)


def prompt_rows(folder: Path | None) -> Rows:
    """The prompts, with those of a folder in place of shipped ones of the same name."""
    from coopera.prompts import PromptLibrary

    library = PromptLibrary(folder)
    heads = {name: library.head(name) for name in library.names}
    return [
        {
            **head.model_dump(mode="json"),
            "sha": library.hashes()[name],
            "file": str(library.path(name)),
            "about": f"asks the {head.model_role}'s model, which replies by {head.reply} ({head.paper})",
        }
        for name, head in heads.items()
    ]


def _first_sentence(text: str) -> str:
    line = " ".join(text.split())
    return line.partition(". ")[0].rstrip(".")


_KINDS: dict[str, Callable[[], Rows]] = {
    "methods": _methods,
    "measures": _measures,
    "classifiers": _classifiers,
    "robots": _robots,
    "homes": _homes,
    "people": _people,
    "models": _models,
    "prompts": _prompts,
}
