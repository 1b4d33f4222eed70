from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

from benchmarks import audit


def stored(path: Path, **more: object) -> Path:
    affected = {"package": {"name": "Jinja2", "ecosystem": "PyPI"}, "versions": ["3.0.0", "3.1.2"]}
    advisory = {"id": "GHSA-1", "summary": "sandbox escape", "affected": [affected], **more}
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("GHSA-1.json", json.dumps(advisory))
    return path


def test_a_pinned_version_that_an_advisory_names_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "constraints.txt").write_text("# pins\njinja2==3.1.2\ntorch==2.9.0+cpu\n")
    command = ["audit", str(tmp_path / "constraints.txt"), str(stored(tmp_path / "all.zip"))]
    monkeypatch.setattr("sys.argv", command)
    assert audit.main() == 1
    assert capsys.readouterr().out == ("jinja2 3.1.2: GHSA-1 sandbox escape\n2 packages, 1 known weaknesses\n")


def test_other_versions_and_withdrawn_advisories_are_no_weakness(tmp_path: Path) -> None:
    assert not list(audit.weaknesses(audit.pins("jinja2==3.1.6"), stored(tmp_path / "a.zip")))
    withdrawn = stored(tmp_path / "b.zip", withdrawn="2026-01-01T00:00:00Z")
    assert not list(audit.weaknesses(audit.pins("jinja2==3.1.2"), withdrawn))


def test_every_package_is_pinned_to_one_version() -> None:
    lines = (Path(__file__).parents[2] / "constraints.txt").read_text(encoding="utf-8").splitlines()
    assert len(audit.pins("\n".join(lines))) == len([line for line in lines if "==" in line])
