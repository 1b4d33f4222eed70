"""Diary days of the American Time Use Survey, as the U.S. Bureau of Labor Statistics publishes them.

Of the activity file (atusact_2023.dat, comma-separated) these columns are read: TUCASEID, TUSTARTTIM, TUSTOPTIME,
TEWHERE, and the activity's code from TRCODEP, else TRCODE, else TUTIER1CODE, TUTIER2CODE and TUTIER3CODE. Beside it,
under the published names: TUDIARYDAY (1 is Sunday) of the respondent file (atusresp_2023.dat), and the age from TEAGE
of the roster (atusrost_2023.dat) or PRTAGE of the CPS file (atuscps_2023.dat), where TULINENO is 1. Files are read as a
stream, so that they may be of any size.

A respondent has one day, from 4 am to 4 am; what lasts longer ends there. Its number in the diary is the weekday, 0
being Monday. TEWHERE 1 is the respondent's home; travelling (18) is away wherever it is, and where the place is not
known or was not asked (0 and below, as for sleep), work (05) alone is away. Activities of 50 are
not known, and stay open.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import groupby, islice
from pathlib import Path
from typing import NamedTuple

from coopera.config.files import reason
from coopera.core.clock import WEEKDAYS
from coopera.core.errors import ConfigError
from coopera.core.foreign.tables import Line, rows_of
from coopera.people.diary import DAY, Episode, as_clock
from coopera.people.published import PersonDiary, Published, counted, nobody, words

FOUR = 4 * 60  # the survey's day begins and ends at 4 am
_HOME = 1  # TEWHERE
_WORK, _TRAVEL, _UNKNOWN = "05", "18", "50"
_LONGEST = 65_536  # characters of a line; the published ones have a few hundred
_MOST = 1440  # activities of a day: one a minute
_CODES = (("TRCODEP",), ("TRCODE",), ("TUTIER1CODE", "TUTIER2CODE", "TUTIER3CODE"))
_TIME = re.compile(r"([01]?[0-9]|2[0-3]):([0-5][0-9])(?::[0-5][0-9])?")
_CASE = re.compile(r"[0-9A-Za-z_-]{1,40}")


class _Line(NamedTuple):
    """One line of a file of the survey: where it stands, and the columns that are read."""

    where: str
    cells: Mapping[str, str]


def read_atus(path: Path, who: str | None, limit: int | None) -> Published:
    """Read the days of respondents.

    Raises:
        ConfigError: If a file lacks a column or holds a value that is none, the times of a day are out of order, a
            respondent stands in two places of the file, or nobody is there; names the file and the line.
    """
    weekdays, ages = _weekdays(path), _ages(path)
    people: list[PersonDiary] = []
    met: dict[str, None] = {}
    by_category: Counter[str] = Counter()
    open_: Counter[str] = Counter()
    with _lines(path, ("TUCASEID", "TUSTARTTIM", "TUSTOPTIME", "TEWHERE"), _CODES) as lines:
        for case, group in groupby(lines, key=_case):
            day = list(islice(group, _MOST + 1))
            if len(day) > _MOST:
                raise ConfigError(f"{day[-1].where}: the respondent {case} has more than {_MOST} activities in a day.")
            if case in met:
                raise ConfigError(f"{day[0].where}: the respondent {case} has stood before, with others between.")
            met[case] = None
            if who in (None, case):
                weekday = weekdays.get(case)
                episodes = list(_episodes(day, weekday or 0, by_category, open_))
                people.append(PersonDiary(case, _about(weekday, ages.get(case)), episodes))
            if people and (who is not None or len(people) == limit):
                break
    if not met:
        raise ConfigError(f"{path}: the file has a header and no activity.")
    if not people:
        raise nobody(path, str(who), list(met))
    return Published([one for one in people if one.episodes], list(_notes(people, weekdays, by_category, open_)))


def _notes(
    people: Sequence[PersonDiary], weekdays: Mapping[str, int], by_category: Counter[str], open_: Counter[str]
) -> Iterator[str]:
    if by_category:
        yield f"Codes without words of their own, said by their major category: {counted(by_category)}."
    if open_:
        yield f"Codes of activities that are not known, left open: {counted(open_)}."
    if unknown := sum(one.who not in weekdays for one in people):
        yield f"The weekday of {unknown} is in no atusresp file beside this one, so their day is 0."
    if empty := [one.who for one in people if not one.episodes]:
        yield f"Nothing is known of the day of {', '.join(empty[:8])}, so nothing is written."


def _about(weekday: int | None, age: int | None) -> str:
    said = [WEEKDAYS[weekday] if weekday is not None else "", f"aged {age}" if age is not None else ""]
    return ", ".join(part for part in said if part)


def _episodes(lines: Sequence[_Line], day: int, by_category: Counter[str], open_: Counter[str]) -> Iterator[Episode]:
    """The episodes of a respondent's day; counts codes that have no words."""
    before = FOUR
    for at, line in enumerate(lines):
        start, end = _since_four(line, "TUSTARTTIM"), _since_four(line, "TUSTOPTIME")
        if start < before:
            raise ConfigError(
                f"{line.where}: TUSTARTTIM is {as_clock(start % DAY)}, before the activity before has ended."
            )
        if end <= start:
            if at + 1 < len(lines):
                stop = as_clock(end % DAY)
                raise ConfigError(f"{line.where}: TUSTOPTIME is {stop}, and only the last activity may end after 4 am.")
            end = FOUR + DAY
        before = end
        code = _code(line)
        activities, major = words("atus")["activities"], words("atus")["major"]
        if code[:2] == _UNKNOWN or code[:2] not in major:
            open_[code] += 1
            continue
        by_category.update([] if code in activities else [code])
        said = activities.get(code, major[code[:2]])
        yield Episode(day=day, start=start, end=end, activity=said, away=_away(line, code))


def _since_four(line: _Line, column: str) -> int:
    """A time in minutes of the survey's day: 4:00 is 240, and 3:59 of the night after it 1679."""
    said = _TIME.fullmatch(line.cells[column])
    if not said:
        raise ConfigError(f"{line.where}: {column} must be a time such as 04:00:00, not {line.cells[column][:60]!r}.")
    minute = 60 * int(said[1]) + int(said[2])
    return minute if minute >= FOUR else minute + DAY


def _code(line: _Line) -> str:
    columns = next(names for names in _CODES if names[0] in line.cells)
    size = 6 // len(columns)
    code = "".join(line.cells[name].zfill(size) for name in columns)
    if not re.fullmatch(r"[0-9]{6}", code):
        raise ConfigError(f"{line.where}: {columns[0]} must be an activity code such as 110101, not {code[:60]!r}.")
    return code


def _away(line: _Line, code: str) -> bool:
    place = _number(line, "TEWHERE")
    if code[:2] == _TRAVEL or place > _HOME:
        return True
    return place < _HOME and code[:2] == _WORK


def _weekdays(path: Path) -> dict[str, int]:
    """The weekday (0 is Monday) of each respondent, where the respondent file lies beside the activity file."""
    beside = _beside(path, "atusresp")
    if not beside:
        return {}
    found = {}
    with _lines(beside, ("TUCASEID", "TUDIARYDAY")) as lines:
        for line in lines:
            day = _number(line, "TUDIARYDAY")
            if not 1 <= day <= 7:
                raise ConfigError(f"{line.where}: TUDIARYDAY must be from 1 (Sunday) to 7 (Saturday), not {day}.")
            found[_case(line)] = (day - 2) % 7
    return found


def _ages(path: Path) -> dict[str, int]:
    """The age of each respondent, where a file that says it lies beside the activity file."""
    for file, column in (("atusrost", "TEAGE"), ("atuscps", "PRTAGE")):
        if beside := _beside(path, file):
            with _lines(beside, ("TUCASEID", "TULINENO", column)) as lines:
                return {_case(line): _number(line, column) for line in lines if _number(line, "TULINENO") == 1}
    return {}


def _beside(path: Path, name: str) -> Path | None:
    other = path.with_name(path.name.lower().replace("atusact", name))
    return other if other.name != path.name.lower() and other.is_file() else None


def _case(line: _Line) -> str:
    case = line.cells["TUCASEID"]
    if not _CASE.fullmatch(case):
        raise ConfigError(f"{line.where}: TUCASEID must be a number such as 20230101230001, not {case[:60]!r}.")
    return case


def _number(line: _Line, column: str) -> int:
    said = line.cells[column]
    if not re.fullmatch(r"-?[0-9]{1,6}", said):
        raise ConfigError(f"{line.where}: {column} must be a whole number, not {said[:60]!r}.")
    return int(said)


@contextmanager
def _lines(path: Path, needed: Sequence[str], either: Sequence[Sequence[str]] = ()) -> Iterator[Iterator[_Line]]:
    """Open a file of the survey and read it line by line: the needed columns, and the first complete of some others."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = iter(partial(file.readline, _LONGEST), "")
            yield _read(path, rows_of(path, lines), needed, either)
    except FileNotFoundError:
        raise ConfigError(f"{path}: there is no such file.") from None
    except OSError as err:
        raise ConfigError(f"{path}: the file cannot be read ({reason(err)}).") from err
    except UnicodeDecodeError as err:
        raise ConfigError(f"{path}: the file must be UTF-8 text ({err.reason}).") from err


def _read(path: Path, lines: Iterator[Line], needed: Sequence[str], either: Sequence[Sequence[str]]) -> Iterator[_Line]:
    header = [name.strip().upper() for name in next(lines).cells]
    columns = list(needed)
    if either:
        columns += next((names for names in either if set(names) <= set(header)), either[0])
    for column in columns:
        if column not in header:
            found = ", ".join(islice(header, 8)) or "an empty line"
            raise ConfigError(f"{path}, line 1: the column {column} is missing; the header begins with {found}.")
    at = [header.index(column) for column in columns]
    for number, cells in lines:
        if len(cells) != len(header):
            raise ConfigError(f"{path}, line {number}: expected {len(header)} cells, found {len(cells)}.")
        yield _Line(f"{path}, line {number}", {column: cells[i].strip() for column, i in zip(columns, at, strict=True)})
