"""Which household file an offline model reads: the one that it names, or the one that its role is to have."""

from __future__ import annotations

from pathlib import Path

from coopera.core.errors import ConfigError
from coopera.core.protocols import Role
from coopera.models.offline.household.knowledge import ROBOTS
from coopera.models.settings import OWN, SHARED


def household_file(spec: str) -> Path | None:
    """The household file of one's own that an offline model's spec names, if it names one."""
    kind, colon, name = spec.partition(":")
    return Path(name).expanduser() if kind == "offline" and colon and name != "words" else None


def household_of(spec: str, role: Role, household: str) -> Path | None:
    """The household file that a model reads in a role, other than the person's shipped one; None where it reads that.

    A file that the model names wins. The person always keeps theirs; what is no offline model reads none.

    Args:
        spec: The model.
        role: Whom it plays.
        household: The setting: `own`, `shared` or a file.

    Raises:
        ConfigError: If the setting is none of these.
    """
    plain = spec.partition(":")[0] == "offline" and role != "human"
    return household_file(spec) or (chosen_household(household) if plain else None)


def chosen_household(household: str) -> Path | None:
    """The file that the setting `household` names; None for `shared`.

    Raises:
        ConfigError: If there is no such file.
    """
    if household in (OWN, SHARED):
        return ROBOTS if household == OWN else None
    path = Path(household).expanduser()
    if not path.is_file():
        raise ConfigError(
            f"household: {household} is neither {OWN} nor {SHARED}, and there is no household file of that name."
        )
    return path
