"""What people are told of a setting: it stands beside the field's type, and all that shows a setting reads it.

The data folder's default is here, too, since models keep their weights there.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Setting:
    """The words of a configuration's field, put into its annotation; type, range and default stand in the field.

    Attributes:
        help: What the setting decides, in one sentence.
        expected: What its value may be, in words; empty where type and range say it.
        flag: Its flag on the command line; None where it stands in a study file only. On a section, such as `models`,
            the flag sets all its fields.
        metavar: What stands for the value in help, such as DIR; empty takes the values, or the type.
        unset: What holds where nothing is given, in words; empty where the default says it.
        values: Names that may be given, where no type says them and they cost nothing to know.
        formerly: What the setting was called before; the old name, and `--` with it, work for a version.
        listed: The word after `coopera list` that lists the values; empty where there is no list.
    """

    help: str
    expected: str = ""
    flag: str | None = None
    metavar: str = ""
    unset: str = ""
    values: tuple[str, ...] = ()
    formerly: str = ""
    listed: str = ""


def default_data_dir() -> Path:
    """Where imported people and homes live: COOPERA_DATA_DIR, else the user's own data folder."""
    given = os.environ.get("COOPERA_DATA_DIR")
    if given:
        return Path(given).expanduser()
    base = os.environ.get("XDG_DATA_HOME")
    return (Path(base) if base else Path.home() / ".local" / "share") / "coopera"
