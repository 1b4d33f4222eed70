"""A plausible run made of core types alone: no model, no world. The trace and the report are tried on it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from coopera.config.schema import Config
from coopera.core.hour import (
    Evening,
    FeedbackItem,
    Found,
    HourRecord,
    HumanHour,
    Intention,
    IntentionCandidate,
    ModelCall,
    Observation,
    Reasons,
    Recalled,
    Reflection,
    RobotHour,
    Task,
    TaskCandidate,
    TaskVerdict,
)
from coopera.core.household import Act, FreeMotion, HandOver, Outcome, Percept, PickPlace
from coopera.core.people import TRAITS, Belief, BigFive, Persona
from coopera.core.randomness import rng_at
from coopera.core.success import Success
from coopera.evaluation.counts import count
from coopera.evaluation.measures.help import help_given
from coopera.people.shipped import find
from coopera.rundir.directory import RunDir

LIVES = [
    ("Have a slow breakfast", "kitchen", "dining_table_1", "stir", ["mug", "plate", "spoon", "banana", "teapot"]),
    ("Stretch and breathe for a while", "living room", "rug_1", "stretch", ["yoga_mat", "towel", "water_bottle"]),
    ("Tidy up the kitchen", "kitchen", "kitchen_sink_1", "wipe", ["sponge", "towel", "plate", "bleach_bottle"]),
    ("Catch up with the family", "living room", "sofa_1", "talk on the phone", ["phone", "mug", "notebook"]),
    ("Cook a stew for the week", "kitchen", "stove_1", "stir a pot", ["cooking_pot", "spatula", "kitchen_knife"]),
    ("Rest with a favourite show", "living room", "television_1", "sit and watch", ["remote_control", "blanket"]),
    ("Practise the songs for Sunday", "living room", "armchair_1", "sing", ["radio", "notebook", "glass"]),
    ("Do a small load of washing", "laundry room", "washing_machine_1", "load", ["laundry_basket", "shirt", "towel"]),
    ("Plan the coming days", "study", "desk_1", "write", ["notebook", "pen", "laptop", "mug"]),
]


def fake_run(
    root: Path,
    *,
    people: tuple[str, ...] = ("amara",),
    days: int = 5,
    hours: int = 13,
    collab: int = 2,
    frames: int = 8,
    seed: int = 0,
    finished: bool = True,
    lived: bool = True,
) -> RunDir:
    """Write a run in which the robot grows better; hour 16 of day 1 failed and one candidate is unscored."""
    config = Config(
        humans=list(people), scenes=["maple"], days=days, hours=hours, collab=collab, out=root, frames=frames, seed=seed
    )
    personas = [find(person, config.data_dir) for person in people]
    prompts = {"human/intention": "ab" * 32, "robot/intentions": "cd" * 32}
    models = dict.fromkeys(("human", "robot", "judge"), "offline routine model")
    with RunDir.create(config, people=personas, prompts=prompts, models=models) as run:
        for day in range(days * len(people) if lived else 0):
            persona = personas[day // days]
            records = [_hour(run, persona, day, day % days, hour, config) for hour in config.day_hours]
            for record in records:
                run.write_hour(record)
            run.write_evening(_evening(records, persona, days, seed))
        if finished:
            run.finish()
    return run


def _hour(run: RunDir, persona: Persona, day: int, episode_day: int, hour: int, config: Config) -> HourRecord:
    rng = rng_at(config.seed, persona.id, day, hour)
    base = {"day": day, "episode": day // (config.days or 5), "episode_day": episode_day, "hour": hour}
    base |= {"person": persona.id, "scene": "maple"}
    if (day, hour) == (1, 16):
        call = _call("human/intention", rng, reply="I would rather not say.", faults=["no JSON object found"] * 3)
        why = "human/intention: the model's reply cannot be used: no JSON object found"
        return HourRecord(
            **base, human=None, robot=None, world={}, success=None, status="failed", reason=why, calls=[call]
        )
    human = _human(hour, rng, config.collab)
    robot, success = _robot(run, human, day, episode_day, hour, rng, config)
    done = [
        Outcome(agent="human", act=task.act, ok=True, metres=round(float(rng.uniform(1, 9)), 2)) for task in human.tasks
    ]
    world = {"outcomes": [one.model_dump() for one in done], "after": {"mug_1": [1.0, 2.0, 0.8]}}
    names = ["human/intention", "human/tasks_type2", "robot/intentions", "robot/tasks_type2", "judge/tasks"]
    calls = [_call(name, rng, faults=["Extra data at character 812"] if rng.random() < 0.03 else []) for name in names]
    return HourRecord(**base, human=human, robot=robot, world=world, success=success, status="ok", calls=calls)


def _human(hour: int, rng: np.random.Generator, collab: int) -> HumanHour:
    text, room, target, motion, things = LIVES[int(rng.integers(len(LIVES)))]
    why = Reasons(human="It suits how I am.", intentions="I was busy before.", tasks="The mug was already out.")
    acts = [_act(collab, target, motion, thing) for thing in things[: 3 if collab == 1 else 5]]
    tasks = [
        Task(id=f"{hour}.{n}", thought=f"I want the {a.describe()[:20]}…", reasons=why, act=a)
        for n, a in enumerate(acts, 1)
    ]
    recalled = [
        Recalled(
            kind=kind, text=LIVES[n][0], hour=hour + 8 - n, relevance=0.61 - n / 20, recency=0.95**n, score=0.6 - n / 15
        )
        for kind in ("intention", "task")
        for n in range(3 if hour > 9 else 0)
    ]
    found = Found(
        fixed={target: (3, room), "shelf_1": (4, room)},
        movable={f"{thing}_1": (20 + n, room) for n, thing in enumerate(things)},
        motions=[motion, "reach up", "bend down"],
    )
    verdicts = [TaskVerdict(ok=True), TaskVerdict(ok=False, comment="this does not belong to what I am doing")]
    changes = ["put the pen on the desk -> put the mug on the desk"]
    return HumanHour(
        recalled=recalled,
        intention=Intention(text=text, reasons=why, wants=things[:1]),
        found=found,
        tasks=tasks,
        reflections=[
            Reflection(node="reflect_profile", verdicts=verdicts, changes=changes),
            Reflection(node="reflect_scene", verdicts=[TaskVerdict(ok=True)] * len(tasks), changes=[]),
        ],
    )


def _act(collab: int, target: str, motion: str, thing: str) -> PickPlace | FreeMotion:
    if collab == 1:
        return PickPlace(object_id=21, object=f"{thing}_1", receptacle_id=3, receptacle=target)
    return FreeMotion(target_id=3, target=target, in_hand=thing, motion=motion)


def _robot(
    run: RunDir, human: HumanHour, day: int, age: int, hour: int, rng: np.random.Generator, config: Config
) -> tuple[RobotHour, Success]:
    skill = 1 - math.exp(-(age + 0.6) / 2)
    others = [life for life in LIVES if life[0] != human.intention.text]
    picks = [others[int(n)] for n in rng.choice(len(others), 4, replace=False)]
    truth = next(life for life in LIVES if life[0] == human.intention.text)
    lives = [truth, *picks] if rng.random() < 0.8 else picks
    intentions, tasks = [], []
    for life in lives:
        right = life is truth
        p = float(np.clip(0.5 + skill * (0.32 if right else -0.3) + rng.normal(0, 0.15), 0.02, 0.98)) if age else 0.5
        intentions.append(
            IntentionCandidate(text=life[0], probability=p, accepted=p >= 0.5, reasons=Reasons(vision="seen"))
        )
        for thing in life[4][:4] if p >= 0.5 else []:
            q = float(np.clip(p + rng.normal(0, 0.12), 0.02, 0.98)) if age else 0.5
            act = _act(1, life[2], "", thing) if config.collab == 1 else HandOver(object=thing)
            correct = None if rng.random() < 0.01 else right and thing in truth[4]
            tasks.append(
                TaskCandidate(intention=life[0], thought=f"They may need the {thing}.", act=act, probability=q,
                              accepted=q >= 0.5, correct=correct)
            )  # fmt: skip
    frames = _frames(run, day, hour, truth[1], config) if config.pictures == "sampled" else []
    first = human.tasks[0].act
    percept = Percept(room=truth[1], near=[truth[2]], motion=truth[3], in_hand=truth[4][0], visible=["sofa_1"])
    outcomes = [
        Outcome(agent="robot", act=task.act, ok=rng.random() < 0.9, reason="" if rng.random() < 0.9 else "no free path",
                metres=round(float(rng.uniform(1, 9)), 2))
        for task in tasks
        if task.accepted
    ]  # fmt: skip
    observation = Observation(
        frames=frames, percept=percept, first_task=first.describe() if config.collab == 1 else None
    )
    accepted, correct = [bool(t.accepted) for t in tasks], [t.correct for t in tasks]
    judged = [None if c is None else bool(c) ^ bool(rng.random() < 0.1) for c in correct]
    useful = [[_helps(one.act, task.act) for task in human.tasks[1:]] for one in outcomes]
    given = help_given(outcomes, useful, remaining=len(human.tasks) - 1)
    by_judge = count(accepted, judged).model_copy(update={"verdicts": judged})
    success = Success(predicate=count(accepted, correct), judge=by_judge, help=given)
    fallbacks = [] if tasks else ["no intention accepted"]
    return RobotHour(
        observation=observation, recalled=[], intentions=intentions, tasks=tasks, outcomes=outcomes, fallbacks=fallbacks
    ), success


def _helps(act: Act, wanted: Act) -> bool:
    if isinstance(act, HandOver) and isinstance(wanted, FreeMotion):
        return act.object == wanted.in_hand
    return act.describe() == wanted.describe()


def _frames(run: RunDir, day: int, hour: int, room: str, config: Config) -> list[str]:
    folder = run.frames_folder(day, hour)
    files = []
    for view in ("robot", "human"):
        for n in range(config.frames):
            path = folder / f"{view}-{n}.webp"
            image = Image.new("RGB", config.frame_size, (200 - 2 * hour, 205, 190 + hour))
            draw = ImageDraw.Draw(image)
            draw.polygon([(0, 240), (320, 240), (250, 130), (70, 130)], fill=(178, 150, 120))
            x = 60 + n * 26
            draw.ellipse((x, 90, x + 24, 114), fill=(230, 190, 160))
            draw.rectangle((x - 4, 114, x + 28, 190), fill=(60, 90 + 10 * (hour % 10), 150))
            draw.text((8, 8), f"{view} {n} {room}", fill=(20, 20, 20))
            image.save(path, quality=80)
            files.append(path.relative_to(run.root).as_posix())
    return files


def _evening(records: list[HourRecord], persona: Persona, days: int, seed: int) -> Evening:
    first = records[0]
    items = []
    for record in records:
        if record.human and record.robot:
            for candidate in record.robot.intentions:
                same = candidate.text == record.human.intention.text
                reason = "That is what I did." if same else "I did something else."
                items.append(
                    FeedbackItem(hour=record.hour, kind="intention", text=candidate.text,
                                 accepted=bool(candidate.accepted), helpful=same, reason=reason)
                )  # fmt: skip
            for task in record.robot.tasks:
                items.append(
                    FeedbackItem(hour=record.hour, kind="task", text=task.act.describe(), accepted=bool(task.accepted),
                                 helpful=task.correct, reason="I used it." if task.correct else "I had no use for it.")
                )  # fmt: skip
    rng = rng_at(seed, persona.id, first.day, "evening")
    pull = 1 - 0.6 ** (first.episode_day + 1)
    guess = {
        t: float(np.clip(3 + pull * (getattr(persona.big_five, t) - 3) + rng.normal(0, 0.2), 1, 5)) for t in TRAITS
    }
    return Evening(
        day=first.day,
        episode=first.episode,
        episode_day=first.episode_day,
        person=first.person,
        scene=first.scene,
        feedback=items,
        belief=Belief(
            big_five=BigFive(**guess),
            profile="They keep an orderly home. They care for others. They like warm drinks and rest <b>early</b>.",
        ),
        traits_reasons={"big_five": "They tidy every day.", "profile": "Seen in most hours."},
        learned={"intentions": {"examples": len(items), "loss": 0.4}, "tasks": {"examples": len(items), "loss": 0.5}},
        calls=[_call("robot/traits", rng)],
    )


def _call(
    prompt: str, rng: np.random.Generator, reply: str = '{"yes": true}', faults: list[str] | None = None
) -> ModelCall:
    faults = faults or []
    return ModelCall(
        node=prompt.partition("/")[2],
        prompt=prompt,
        prompt_sha="ab" * 32,
        model="offline routine model",
        messages=[{"role": "user", "content": f"It is time for {prompt}. " + "Some words of the prompt. " * 40}],
        reply=reply,
        seconds=round(float(rng.uniform(0.001, 0.03)), 4),
        tokens_in=int(rng.integers(300, 900)),
        tokens_out=int(rng.integers(20, 200)),
        attempts=1 + len(faults),
        faults=faults,
    )
