"""coopera's people in an environment for learners."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
import pytest

import coopera
from coopera.core.errors import ConfigError

WAIT = np.array([0, 0, 0])


def lived(env: gymnasium.Env[dict[str, object], np.ndarray], seed: int) -> list[str]:
    env.reset(seed=seed)
    acts, over = [], False
    while not over:
        acts += [act.describe() for act in env.unwrapped.household.left]  # type: ignore[attr-defined]
        *_, over, _, _ = env.step(WAIT)
    return acts


def test_a_person_lives_as_the_seed_says_and_another_day_with_another_seed() -> None:
    env = gymnasium.make("coopera.studies.environment:coopera/Home-v0", person="amara", hours=4, watches=False)

    first, again, other = lived(env, 1), lived(env, 1), lived(env, 2)
    env.close()

    assert first == again
    assert first != other


def test_the_days_of_a_run_can_be_met_again(tmp_path: Path) -> None:
    run = tmp_path / "run"
    given = {"humans": ["amara"], "scenes": ["maple"], "days": 1, "hours": 2, "pictures": "none", "method": "none"}
    coopera.run_study(coopera.Config.model_validate({**given, "out": run}))

    env = coopera.make_env("amara", "maple", recorded=run, watches=False)
    found = lived(env, 5)
    told = coopera.recorded_life(run, "amara")
    env.close()

    assert set(found) <= {act.describe() for hour in told.hours for act in told.tasks(hour)}
    assert len(told.hours) == 2
    with pytest.raises(ConfigError, match="nobody of the id bruno"):
        coopera.recorded_life(run, "bruno")


def test_a_person_who_is_not_there_is_said_in_a_sentence() -> None:
    with pytest.raises(ConfigError, match="nobody-here"):
        coopera.make_env("nobody-here")
