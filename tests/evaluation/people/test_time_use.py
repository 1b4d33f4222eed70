"""A table of time use is read whole or refused, with the line or hour, the field and what was expected."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coopera.core.errors import ConfigError
from coopera.core.time_use import CATEGORIES, day_type
from coopera.evaluation.people.time_use import SHIPPED, SOURCE, named_time_use, read_time_use
from tests.evaluation.people.tables import Shares, rows, write


def _asleep_till_eight(hour: int) -> Shares:
    return {"sleeping": 100.0} if hour < 8 else {"work": 40.0, "other": 60.5}


WEEK = rows("A", "weekday", _asleep_till_eight)
"""Line 2 is hour 0, sleeping; each hour has nine lines."""


def test_the_working_week_starts_on_monday_day_0() -> None:
    assert [day_type(day) for day in range(8)] == [*["weekday"] * 5, "weekend", "weekend", "weekday"]


def test_the_shipped_table_is_whole_and_says_where_it_comes_from() -> None:
    table = named_time_use("shipped")
    assert list(table.shares) == [(s, kind) for s in ("O1", "O2") for kind in ("weekday", "weekend")]
    for shares in table.shares.values():
        assert shares.shape == (24, 9)
        assert shares.sum(axis=1) == pytest.approx(np.ones(24))
    assert table.shares["O1", "weekday"][20, CATEGORIES.index("tv")] == pytest.approx(0.24118)
    assert named_time_use("atus").source == SOURCE
    licence = SHIPPED.with_suffix(".md").read_text(encoding="utf-8")
    assert " ".join(licence.split()).find(SOURCE) > 0


def test_a_table_of_ones_own_is_read_by_name_of_column_and_scaled_to_one(tmp_path: Path) -> None:
    table = read_time_use(write(tmp_path / "own.csv", WEEK))
    assert table.strata == ["A"]
    assert table.source == str(tmp_path / "own.csv")
    shares = table.shares["A", "weekday"]
    assert shares[7, CATEGORIES.index("sleeping")] == 1
    assert shares[8, CATEGORIES.index("work")] == pytest.approx(40 / 100.5)
    turned = write(tmp_path / "turned.csv", [row[::-1] for row in WEEK], header=tuple(reversed(_columns())))
    assert np.array_equal(read_time_use(turned).shares["A", "weekday"], shares)
    windows = tmp_path / "windows.csv"
    windows.write_bytes(b"\xef\xbb\xbf" + (tmp_path / "own.csv").read_bytes().replace(b"\n", b"\r\n") + b"\r\n")
    assert np.array_equal(read_time_use(windows).shares["A", "weekday"], shares)


def test_one_stratum_can_be_chosen_and_an_unknown_one_is_refused() -> None:
    assert named_time_use("shipped").only("O2").strata == ["O2"]
    with pytest.raises(ConfigError, match=r"--stratum: 'O3' is not in the table, which has O1, O2\."):
        named_time_use("shipped").only("O3")


def _columns() -> tuple[str, ...]:
    return ("hour", "category", "weighted_pct", "stratum", "day_type")


@pytest.mark.parametrize(
    ("line", "column", "value", "said"),
    [
        (2, 0, "24", r"line 2: hour must be a whole number from 0 to 23, not '24'"),
        (2, 0, "-1", r"line 2: hour must be"),
        (2, 0, "1.5", r"line 2: hour must be"),
        (2, 0, "٣", r"line 2: hour must be"),
        (3, 1, "gaming", r"line 3: category must be one of sleeping, work, .*, other, not 'gaming'"),
        (3, 2, "100.5", r"line 3: weighted_pct must be a number from 0 to 100, not '100.5'"),
        (3, 2, "-0.1", r"line 3: weighted_pct must be"),
        (3, 2, "nan", r"line 3: weighted_pct must be"),
        (3, 2, "inf", r"line 3: weighted_pct must be"),
        (3, 2, "1_0", r"line 3: weighted_pct must be"),
        (3, 2, "", r"line 3: weighted_pct must be"),
        (3, 3, "", r"line 3: stratum must be a name of 1 to 40"),
        (3, 4, "sunday", r"line 3: day_type must be weekday or weekend, not 'sunday'"),
        (3, 1, "sleeping", r"line 3: stratum A, weekday, hour 0, sleeping stands already in line 2"),
        (3, 2, "1.2", r"stratum A, weekday, hour 0: weighted_pct sums to 101\.2; expected is 100 within 1"),
        (2, 2, "98", r"hour 0: weighted_pct sums to 98; expected"),
    ],
)
def test_a_wrong_cell_is_refused(tmp_path: Path, line: int, column: int, value: str, said: str) -> None:
    table = [list(row) for row in WEEK]
    table[line - 2][column] = value
    path = write(tmp_path / "own.csv", table)
    with pytest.raises(ConfigError, match=said) as refused:
        read_time_use(path)
    assert str(refused.value).startswith(str(path))


def test_a_missing_hour_or_category_is_refused_for_each_stratum_and_day_type(tmp_path: Path) -> None:
    hourless = write(tmp_path / "a.csv", WEEK, rows("A", "weekend", _asleep_till_eight)[: 9 * 23])
    with pytest.raises(ConfigError, match=r"stratum A, weekend, hour 23: the hour is missing; expected are all hours"):
        read_time_use(hourless)
    with pytest.raises(ConfigError, match=r"stratum A, weekday, hour 0: the category tv is missing; expected are all"):
        read_time_use(write(tmp_path / "b.csv", [row for row in WEEK if row[:2] != ["0", "tv"]]))


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", r"line 1: the column hour is missing; expected are hour, category"),
        (b"hour,category,weighted_pct,stratum,day_type\n", r"no row below its header"),
        (b"hour,category,weighted_pct,stratum,day_type,note\n", r"line 1: the column 'note' is unknown"),
        (b"hour,category,weighted_pct,stratum,day_type,hour\n", r"line 1: the column 'hour' stands twice"),
        (b"hour,category,stratum,day_type\n", r"line 1: the column weighted_pct is missing"),
        (b"hour,category,weighted_pct,stratum,day_type\n0,tv\n", r"line 2: expected 5 cells, found 2"),
        (b'hour,category,weighted_pct,stratum,day_type\n0,"tv', r"line 2: this is not valid CSV"),
        (b"hour,category,weighted_pct,stratum,day_type\n0,\xff", r"line 2: the table of time use must be UTF-8"),
        (b"\n" * 2_000_001, r"at most 500000 lines"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "own.csv"
    path.write_bytes(content)
    with pytest.raises(ConfigError, match=said):
        read_time_use(path)


def test_no_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"nothing\.csv: there is no such table .* named 'shipped' or 'atus'"):
        named_time_use(str(tmp_path / "nothing.csv"))
    with pytest.raises(ConfigError, match="must be a file"):
        read_time_use(tmp_path)
