"""A small made-up sample in the published form of the American Time Use Survey: nobody's days."""

from __future__ import annotations

from pathlib import Path

ACT_HEADER = (
    "TUCASEID,TUACTIVITY_N,TEWHERE,TUACTDUR,TUACTDUR24,TUSTARTTIM,TUSTOPTIME,TRCODEP,TRTIER1P,TRTIER2P,"
    "TUTIER1CODE,TUTIER2CODE,TUTIER3CODE"
)
ANN, BEN = "20990101000001", "20990101000002"
DAYS = {
    # the last activity is longer than the survey's day, as in the published files
    ANN: [
        ("04:00:00", "06:30:00", "010101", -1),
        ("06:30:00", "07:00:00", "010201", -1),
        ("07:00:00", "07:30:00", "110101", 1),
        ("07:30:00", "08:00:00", "180501", 12),
        ("08:00:00", "12:00:00", "050101", 2),
        ("12:00:00", "12:30:00", "110101", 4),
        ("12:30:00", "17:00:00", "050101", 2),
        ("17:00:00", "17:30:00", "180501", 12),
        ("17:30:00", "18:15:00", "020201", 1),
        ("18:15:00", "18:45:00", "110101", 1),
        ("18:45:00", "19:00:00", "500106", -1),
        ("19:00:00", "22:00:00", "120303", 1),
        ("22:00:00", "00:30:00", "130136", 1),
        ("00:30:00", "07:00:00", "010101", -1),
    ],
    BEN: [("04:00:00", "09:00:00", "010101", -1), ("09:00:00", "04:00:00", "050101", 1)],
}


def activities(*days: tuple[str, list[tuple[str, str, str, int]]]) -> str:
    """The text of an activity file."""
    rows = [ACT_HEADER]
    for case, day in days or DAYS.items():
        for number, (start, stop, code, place) in enumerate(day, 1):
            tiers = ",".join((code[:2], code[:4], code[:2], code[2:4], code[4:]))
            rows.append(f"{case},{number},{place},0,0,{start},{stop},{code},{tiers}")
    return "\r\n".join(rows) + "\r\n"


def write_survey(folder: Path) -> Path:
    """Write the three files of a survey year; Ann's day was a Sunday, Ben's a Wednesday."""
    path = folder / "atusact_2099.dat"
    path.write_text(activities())
    (folder / "atusresp_2099.dat").write_text(f"TUCASEID,TULINENO,TUDIARYDAY\n{ANN},1,1\n{BEN},1,4\n")
    (folder / "atuscps_2099.dat").write_text(f"TUCASEID,TULINENO,PRTAGE\n{ANN},1,41\n{ANN},2,9\n{BEN},1,67\n")
    return path
