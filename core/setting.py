"""What people are told of a setting: it stands beside the field's type, and all that shows a setting reads it."""

from __future__ import annotations

from dataclasses import dataclass


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
