from __future__ import annotations

import pytest

from tests.memory.fakes import Letters


@pytest.fixture
def letters() -> Letters:
    return Letters()
