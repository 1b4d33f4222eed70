from __future__ import annotations

import pytest

from coopera.evaluation.rating.reliability import cohen, fleiss, krippendorff, pairwise


def test_cohens_kappa_of_fifty_grants() -> None:
    # 20 yes by both, 15 no by both, 5 and 10 apart: observed 0.7, by chance 0.5, so 0.4 (a textbook example)
    one = [True] * 25 + [False] * 25
    other = [True] * 20 + [False] * 5 + [True] * 10 + [False] * 15
    assert cohen(one, other) == pytest.approx(0.4, abs=1e-12)


def test_fleiss_kappa_of_ten_subjects_and_fourteen_raters() -> None:
    # Fleiss (1971), as it is quoted everywhere: 0.210
    counts = [
        (0, 0, 0, 0, 14), (0, 2, 6, 4, 2), (0, 0, 3, 5, 6), (0, 3, 9, 2, 0), (2, 2, 8, 1, 1),
        (7, 7, 0, 0, 0), (3, 2, 6, 3, 0), (2, 5, 3, 2, 2), (6, 5, 2, 1, 0), (0, 2, 2, 3, 7),
    ]  # fmt: skip
    items = [[label for label, n in enumerate(row) for _ in range(n)] for row in counts]
    assert fleiss(items) == pytest.approx(0.210, abs=0.0005)


def test_krippendorffs_alpha_of_four_observers_with_missing_labels() -> None:
    # Krippendorff (2011), "Computing Krippendorff's alpha-reliability", C: nominal data with missing values, 0.743
    observers = ["123321412...", "12332241253."[:10] + ".3", ".33323422" + "51.", "123324412" + "51."]
    units = [[one[n] for one in observers if one[n] != "."] for n in range(12)]
    assert krippendorff(units) == pytest.approx(0.743, abs=0.0005)


def test_krippendorffs_alpha_of_two_observers() -> None:
    # the same paper, A: two observers, binary data, no missing values: 0.095
    one, other = "0100000010", "1110010000"
    assert krippendorff([list(pair) for pair in zip(one, other, strict=True)]) == pytest.approx(0.095, abs=0.0005)


def test_where_all_say_the_same_there_is_no_agreement_beyond_chance() -> None:
    assert cohen([True, True], [True, True]) is None
    assert fleiss([[True, True], [True, True]]) is None
    assert krippendorff([[True, True], [True, True]]) is None


def test_with_nothing_in_common_there_is_no_agreement() -> None:
    assert cohen([], []) is None
    assert cohen([None, True], [True, None]) is None
    assert fleiss([]) is None
    assert fleiss([[True, False], [True]]) is None
    assert krippendorff([[True], [False]]) is None


def test_each_two_raters_are_compared_over_what_both_rated() -> None:
    answers = {"a": {"x": True, "y": False, "z": True}, "b": {"x": True, "y": False}, "c": {"q": True}}
    assert pairwise(answers) == {("a", "b"): 1.0}
