from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from coopera.memory.numbering import Numbering, position_of


def test_ids_carry_the_number_of_the_cut_after_which_they_were_written() -> None:
    once = Numbering().cut(3, 5)
    assert [once.id(place) for place in (2, 3, 7)] == ["000000000002", "000000000003.1", "000000000007.1"]
    twice = once.cut(6, 8)
    assert [twice.id(place) for place in (2, 5, 6)] == ["000000000002", "000000000005.1", "000000000006.2"]
    below = twice.cut(1, 9)
    assert [below.id(place) for place in (0, 1, 6)] == ["000000000000", "000000000001.3", "000000000006.3"]
    assert (once.ghosts, twice.ghosts, below.ghosts) == (2, 4, 12)


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 9)), max_size=40))
def test_an_id_is_never_used_twice_and_always_leads_to_the_living_record(steps: list[tuple[bool, int]]) -> None:
    """Compare with a plain list: rows are only ever added to the store, under new ids."""
    numbering, living, rows, written = Numbering(), [], {}, 0
    for appends, amount in steps:
        if appends:
            for _ in range(amount):
                key = numbering.id(len(living))
                assert key not in rows
                rows[key] = written
                living.append(written)
                written += 1
        elif amount < len(living):
            numbering = numbering.cut(amount, len(living))
            del living[amount:]
    numbering = Numbering.of(numbering.metadata())
    assert [rows[numbering.id(place)] for place in range(len(living))] == living
    assert numbering.id(len(living)) not in rows
    assert len(rows) - numbering.ghosts == len(living)
    assert all(position_of(numbering.id(place)) == place for place in range(len(living)))
