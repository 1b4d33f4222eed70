from __future__ import annotations

from pathlib import Path

from coopera.core.people import PersonId
from coopera.rundir.lives import read_recorded


def test_a_recorded_person_may_have_kept_a_diary(tmp_path: Path) -> None:
    path = tmp_path / "amara.csv"
    path.write_text("day,start,end,activity\n0,09:00,11:00,Bake\n")
    recorded = read_recorded([path], [PersonId("amara")])
    assert [(hour.hour, hour.intention) for hour in recorded[PersonId("amara")]] == [(9, "Bake"), (10, "Bake")]
