"""coopera's people as the life of an environment: lived now by any model, or met again from a finished run."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from coopera.config.schema import Config
from coopera.core.errors import ConfigError
from coopera.core.hour import DayPlan, HumanHour
from coopera.core.household import Act
from coopera.evaluation.predicate import Predicate
from coopera.graphs.services import Services
from coopera.rundir.directory import RunDir
from coopera.simulation import World, load_scene
from coopera.simulation.env.life import Hour, Planned
from coopera.studies.assemble import open_embeddings, open_world
from coopera.studies.catalogues import resolve
from coopera.studies.study import new_run, plan_days

if TYPE_CHECKING:
    from coopera.simulation.env.gym import HomeEnv

ENVIRONMENT = "coopera/Home-v0"
"""gymnasium.make("coopera.studies.environment:coopera/Home-v0", person="amara") is make_env(person="amara")."""


class Living:
    """A person of coopera who decides each hour anew, with their memory of this episode."""

    def __init__(self, config: Config) -> None:
        """Take a resolved configuration with one person in one home; its seed is set by each episode."""
        self._config, self._open = config, ExitStack()
        self._plans = plan_days(config)
        self._services: Services | None = None
        self._last: tuple[DayPlan, int, HumanHour] | None = None

    @property
    def hours(self) -> list[Hour]:
        """All hours of all days."""
        return [Hour(plan.day, hour) for plan in self._plans for hour in plan.hours]

    def begin(self, world: World, seed: int) -> None:
        """Forget the last episode; the person lives in the very home of the environment."""
        self.close()
        folder = self._open.enter_context(tempfile.TemporaryDirectory(prefix="coopera-env-"))
        config = self._config.model_copy(update={"seed": seed, "out": Path(folder) / "life"})
        _, services = self._open.enter_context(new_run(config, resumable=False))
        self._services, self._last = replace(services, home=lambda scene: world), None

    def tasks(self, hour: Hour) -> list[Act]:
        """What the person decides to do; the hour before is remembered first. Nothing while they are away.

        Raises:
            HourError: If a language model's reply cannot be used.
        """
        if self._services is None:
            raise ValueError("the life has not begun: call reset")
        services, plan = self._services, self._plans[hour.day]
        if self._last is not None:
            before, position, lived = self._last
            services.life.end(services, before, before.clock(position), lived)
        position = plan.hours.index(hour.hour)
        lived = services.life.decide(services, plan, plan.clock(position))
        self._last = plan, position, lived
        return [] if lived.intention.away else [task.act for task in lived.tasks]

    def close(self) -> None:
        """Take the episode's files away."""
        self._open.close()
        self._services = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()


def recorded_life(path: Path, person: str | None = None) -> Planned:
    """The hours that a person lived in a run, as they were; the run may have been without a robot.

    Args:
        path: The run directory.
        person: Whose; by default the run's only person.

    Raises:
        ConfigError: If there is no run, nobody of that id in it, or it has several people and none was named.
    """
    hours = RunDir.open(path).hours()
    people = sorted({hour.person for hour in hours})
    if person is None and len(people) != 1:
        raise ConfigError(
            f"{path}: expected a run of one person, or one of {', '.join(people) or 'nobody'} to be named."
        )
    who = person or people[0]
    acts = {
        Hour(hour.episode_day, hour.hour): [task.act for task in hour.human.tasks]
        for hour in hours
        if hour.person == who and hour.human is not None
    }
    if not acts:
        raise ConfigError(f"{path}: nobody of the id {who} has lived an hour in this run.")
    return Planned(acts)


def make_env(  # noqa: PLR0913 - what a home with somebody in it is made of
    person: str = "amara",
    scene: str = "maple",
    *,
    days: int = 1,
    hours: int = 13,
    collab: int = 1,
    model: str = "offline",
    recorded: Path | str | None = None,
    robot: str = "fetch",
    brings: Sequence[str] = (),
    **settings: Any,
) -> HomeEnv:
    """A home with a person of coopera's as a Gymnasium environment (the extra `gym`).

    Args:
        person: An id, or the path of a person file.
        scene: An id, or the path of a home.
        days: Days of an episode.
        hours: Hours of a day.
        collab: 1, tasks of putting things somewhere; 2, motions for which things can be brought.
        model: What plays the person: see docs/models.md.
        recorded: A run whose days are met again in place of new ones: the same in each episode, and fast.
        robot: The robot's body.
        brings: See `coopera.simulation.env.coding.Coding`.
        settings: `sees`, `watches`, `overlap` and `rewards` of `HomeEnv`.

    Raises:
        ConfigError: If one of them is wrong, or the extra is missing.
    """
    try:
        from coopera.simulation.env.gym import HomeEnv  # noqa: PLC0415 - an optional extra
    except ModuleNotFoundError as err:
        raise ConfigError(
            "An environment needs the package gymnasium: pip install -c constraints.txt -e '.[gym]'"
        ) from err
    given = {"humans": [person], "scenes": [scene], "days": days, "hours": hours, "collab": collab, "robot": robot}
    config = resolve(Config.model_validate({**given, "models": {"human": model}, "pictures": "none", "method": "none"}))
    with ExitStack() as opened:
        embeddings = opened.enter_context(open_embeddings(config))
        where = (config.scenes or [scene])[0]
        layout = load_scene(config.files.scenes.get(where, where), [config.data_dir / "scenes"])
        life = recorded_life(Path(recorded)) if recorded else opened.enter_context(Living(config))
        world = opened.enter_context(open_world(config, layout, embeddings))
        helps = Predicate(embeddings).helps
        return HomeEnv(world, life, brings=brings, helps=helps, resources=opened.pop_all(), **settings)


if find_spec("gymnasium") is not None:
    import_module("gymnasium").register(id=ENVIRONMENT, entry_point=make_env)
