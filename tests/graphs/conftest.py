from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from coopera.evaluation import METHODS, Measure
from coopera.graphs import Services
from coopera.graphs.life import LivedNow
from coopera.graphs.players.person_models import PERSON_MODELS
from coopera.graphs.players.simulated import Simulated
from coopera.graphs.robots.learning import KINDS, Learner
from coopera.graphs.robots.own_robot import OwnRobot
from coopera.memory import MemoryStream
from tests.fakes import MARA, FakeHome, FolderRecorder, LetterEmbeddings, ScriptedAsk, TableClassifier, type2_answers

MakeServices = Callable[..., Services]


@pytest.fixture
def make_services(tmp_path: Path) -> Iterator[MakeServices]:
    """Services over fakes, with a real memory; `folder` may be shared by two of them, one after the other."""
    opened: dict[tuple[Path, str], MemoryStream] = {}

    def make(
        *,
        ask: ScriptedAsk | None = None,
        home: FakeHome | None = None,
        method: str = "ours",
        folder: Path = tmp_path,
        frames: int = 0,
        person: str = "full",
        **changed: Any,
    ) -> Services:
        home = home or FakeHome()
        recorder = FolderRecorder(folder)
        ask = ask or ScriptedAsk(type2_answers())
        embeddings = LetterEmbeddings()

        def stream(name: str) -> MemoryStream:
            if (folder, name) not in opened:
                opened[folder, name] = MemoryStream.open(folder / "memory", name, embeddings)
            return opened[folder, name]

        return Services(
            ask=ask,
            method=METHODS[method],
            home=lambda scene: home,
            stream=stream,
            embeddings=embeddings,
            learner=Learner(dict.fromkeys(KINDS, TableClassifier), recorder),
            own=OwnRobot(own, recorder) if (own := METHODS[method].own) else None,
            recorder=recorder,
            score=Measure(ask, embeddings),
            seed=0,
            frames=frames,
            person=PERSON_MODELS[person],
            **{"player": Simulated(), "life": LivedNow(), "people": {MARA.id: MARA}, **changed},
        )

    yield make
    for one in opened.values():
        one.close()
