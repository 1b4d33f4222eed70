"""A server's address holds nothing secret, and one that does is not repeated."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.coopera.conftest import Said

SECRET = [
    "http://ada:s3cret@localhost:8000/v1",
    "https://s3cret@localhost/v1",
    "http://ada:x/s3cret@localhost/v1",
    "http://ada:x@s3cret@localhost/v1",
    "http://localhost/v1?key=s3cret",
    "http://localhost/v1#s3cret",
]


@pytest.mark.parametrize("address", SECRET)
def test_an_address_with_something_secret_is_refused_and_not_repeated(
    coopera: Callable[..., Said], tmp_path: Path, address: str
) -> None:
    Path("study.yaml").write_text(f"base_url: {address!r}\n")
    Path("grid.yaml").write_text(f"methods: [ours]\nseeds: 1\nrun: {{base_url: {address!r}}}\n")
    for told in (
        ["run", "--out", "made", "--model", "openai:x", "--base-url", address],
        ["run", "study.yaml", "--out", "made"],
        ["benchmark", "grid.yaml", "--out", "made"],
        ["models", "check", "openai:x", "--base-url", address],
    ):
        done = coopera(*told)
        assert done.code == 2
        assert "COOPERA_SERVER_LOGIN" in done.err
        assert "s3cret" not in done.err + done.out
        assert done.err.count("\n") == 1
    assert not any(b"s3cret" in path.read_bytes() for path in Path("made").rglob("*") if path.is_file())
