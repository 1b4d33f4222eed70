"""What follows from a run's trace, made again: trained classifiers, pictures and videos.

It is made in a folder of its own, and only files that are missing or altered are taken from there.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Collection, Sequence
from pathlib import Path

from langchain_core.embeddings import Embeddings

from coopera.core.hour import DayPlan, HourRecord
from coopera.evaluation import find_method
from coopera.graphs.recorded import told
from coopera.graphs.robots.learning import KEPT, KEPT_PLAIN, account_of, unpack_kept
from coopera.rundir.directory import RunDir
from coopera.rundir.earlier_life import open_earlier_life
from coopera.simulation import World
from coopera.studies.assemble import open_pupil
from coopera.studies.replay import replay


def learn_again(run: RunDir, plans: Sequence[DayPlan], wrong: Collection[str], embeddings: Embeddings) -> list[str]:
    """Train what evenings have left behind again, from the trace and from what is whole.

    Args:
        run: The run; its trace is whole.
        plans: Its days.
        wrong: Files in its folder `adapters`, as paths in the run.
        embeddings: The sentence encoder of the run.

    Returns:
        Which of them were made.

    Raises:
        CooperaError: If a classifier cannot be trained here.
    """
    days = open_earlier_life(run.config)
    stranger = days.stranger if days and find_method(run.config.method).swapped else None
    with tempfile.TemporaryDirectory(prefix="coopera-") as name:
        apart = RunDir(Path(name), run.config, run.info, None)
        if (run.root / "adapters").is_dir():
            shutil.copytree(run.root / "adapters", apart.root / "adapters")
        for file in wrong:
            (apart.root / file).unlink(missing_ok=True)
        pupil = open_pupil(run.config, apart, run.people(), embeddings)
        before: list[DayPlan] = []
        for plan in plans:
            if not (evening := run.read_evening(plan.day)):
                break
            before = [one for one in before if one.episode == plan.episode]
            if any(file.startswith(f"adapters/day-{plan.day:02d}/") for file in wrong):
                hours = told(plan, run.read_day(plan.day), stranger)
                account = account_of(plan, hours, evening.feedback, evening.belief)
                pupil.learn(plan.day, [one.day for one in before], account)
            before.append(plan)
        for file in wrong:
            if file.endswith(f"/{KEPT_PLAIN}") and (apart.root / file).with_name(KEPT).is_file():
                unpack_kept((apart.root / file).parent)
        return _taken(apart.root, run.root, wrong)


def film_again(run: RunDir, wrong: Collection[str]) -> list[str]:
    """Do the run's acts again, and render the pictures and videos that are wrong.

    Returns:
        Which of them were made.

    Raises:
        RunError: If the run met days lived before: those cannot be done again here.
    """
    with tempfile.TemporaryDirectory(prefix="coopera-") as name:
        apart = RunDir(Path(name), run.config, run.info, None)

        def look(record: HourRecord, world: World) -> None:
            at = f"day-{record.day:02d}/hour-{record.hour:02d}"
            if any(file.startswith(f"frames/{at}/") for file in wrong):
                world.frames(run.config.frames, apart.frames_folder(record.day, record.hour))
            if f"video/{at}.mp4" in wrong:
                world.film(apart.video_file(record.day, record.hour))

        def helped(record: HourRecord, number: int, world: World) -> None:
            folder = f"frames/day-{record.day:02d}/hour-{record.hour:02d}"
            if any(file.startswith(f"{folder}/help-{number}-") for file in wrong):
                world.frames(run.config.help_frames, apart.root / folder, f"help-{number}")

        for _ in replay(run, look, helped=helped):
            pass
        return _taken(apart.root, run.root, wrong)


def _taken(source: Path, root: Path, wrong: Collection[str]) -> list[str]:
    """Put files in their places, each as a whole."""
    made = [name for name in sorted(wrong) if (source / name).is_file()]
    for name in made:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        half = (root / name).with_name(f".{(root / name).name}.doctor.tmp")
        shutil.copyfile(source / name, half)
        half.replace(root / name)
    return made
