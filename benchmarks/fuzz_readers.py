"""What `benchmarks.fuzz` tries: readers of files from elsewhere, some good files for each, and how to change them."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from shutil import rmtree
from typing import Any, NamedTuple

import numpy as np
import yaml
from PIL import Image

from benchmarks import fuzz_mutations as change
from coopera.benchmark.grid_runs import load_grid
from coopera.config.prices import read_prices
from coopera.config.schema import load_config
from coopera.core.errors import CooperaError
from coopera.core.foreign.pictures import open_picture
from coopera.core.replies import FreeMotionReply
from coopera.evaluation.people.time_use import read_time_use
from coopera.evaluation.results import from_csv
from coopera.memory import transfer
from coopera.models.classifiers.instruction import read_recipe
from coopera.models.offline.household import knowledge
from coopera.models.offline.human import facts_file
from coopera.models.parsing import BadReplyError, Wanted, read_reply
from coopera.models.recorded import Past
from coopera.people.changes import open_changes
from coopera.people.import_chat import read_rows
from coopera.people.import_diary import read_published
from coopera.people.log_file import looks_like_log, read_log
from coopera.people.shipped import read_persona
from coopera.prompts import loader
from coopera.prompts.examples import examples
from coopera.report.page import gather_pictures, render
from coopera.report.study_forms import read_key, read_participants
from coopera.rundir.directory import RunDir
from coopera.rundir.export import export
from coopera.simulation.bodies.body_file import read_body
from coopera.simulation.goals.files import read_goals
from coopera.simulation.homes.glb import read_glb
from coopera.simulation.homes.meshes import look_of, part_file
from coopera.simulation.homes.scene import MeshPart, dump_scene, load_scene
from coopera.simulation.making.hssd.files import Folder
from coopera.simulation.motions import user_folder
from coopera.simulation.motions.smplx import read_capture, retarget
from tests.coopera.fake_run import fake_run
from tests.coopera.people.survey import activities
from tests.simulation.synthetic_hssd import SCENE, boxes_document, write_glb, write_hssd

ROOT = Path(__file__).parents[1]


class Target(NamedTuple):
    """A reader made ready in a folder: the file that is changed, how it was, and what reads it."""

    path: Path
    seeds: Sequence[bytes]
    read: Callable[[], object]


class Reader(NamedTuple):
    """A reader, how its files are changed, and the errors that are its sentences."""

    ready: Callable[[Path], Target]
    mutate: change.Mutate
    ours: tuple[type[Exception], ...] = (CooperaError,)


def _of_file(name: str, seeds: Sequence[bytes], read: Callable[[Path], object]) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        return Target(folder / name, seeds, lambda: read(folder / name))

    return ready


def _yaml(data: Any) -> bytes:
    return yaml.dump(data, Dumper=yaml.CSafeDumper, allow_unicode=True, sort_keys=False).encode()


def _loaded(name: str) -> Any:
    return yaml.load((ROOT / name).read_bytes(), yaml.CSafeLoader)


# Of a run


def _run(name: str, read: Callable[[Path], object], *more: str) -> Callable[[Path], Target]:
    """A run of one hour, one file of which is changed, or what `read` asks for."""

    def ready(folder: Path) -> Target:
        root = folder / "run"
        fake_run(root, days=1, hours=1, frames=2)
        seeds = [(root / one).read_bytes() for one in (name, *more)]
        return Target(root / name, seeds, lambda: read(root))

    return ready


def _hour(root: Path) -> object:
    run = RunDir.open(root)
    return run.hours(), run.summary()


def _evening(root: Path) -> object:
    return RunDir.open(root).evenings()


def _export(root: Path) -> object:
    rmtree(root / "out", ignore_errors=True)
    return export(RunDir.open(root), root / "out")


def _report(root: Path) -> object:
    run = RunDir.open(root)
    return render(run, gather_pictures(run, 100_000))


def _run_json(root: Path) -> object:
    run = RunDir.open(root)
    return run.state, run.prices, run.resumable, run.spent()


def _recorded(root: Path) -> object:
    return Past(root)


# Of homes and bodies


def _hssd(name: str) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        root = write_hssd(folder / "hssd")
        return Target(root / name, [(root / name).read_bytes()], lambda: _read_hssd(root))

    return ready


def _read_hssd(root: Path) -> object:
    hssd = Folder(root)
    scene = hssd.scene(SCENE)
    regions = [(one.title, one.floor, one.x0, one.x1, one.z0, one.z1) for one in hssd.regions(SCENE, required=True)]
    made: list[tuple[object, object, bool]] = []
    for number, one in enumerate(scene.object_instances):
        try:
            made.append((hssd.template(SCENE, number, one.template_name), one.scale, one.by_mass))
        except FileNotFoundError as err:  # a sentence for the user, who may leave such things out
            made.append((str(err), one.scale, one.by_mass))
    return regions, made, hssd.stage(SCENE)


def _glb() -> bytes:
    document, data = boxes_document([((0, 0, 0), (1, 1, 1)), ((2, 0, 0), (3, 1, 1))], translation=[1, 0, 0])
    picture = _picture("PNG")
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(picture)})
    document |= {
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "baseColorTexture": {"index": 0}}}]
    }
    document |= {"textures": [{"source": 0}], "images": [{"bufferView": 2, "mimeType": "image/png"}]}
    document["meshes"][0]["primitives"][0]["material"] = 0
    document["nodes"] += [
        {"children": [0], "rotation": [0, 0, 0, 1], "scale": [2, 1, 1]},
        {"matrix": np.eye(4).ravel().tolist(), "mesh": 0},
    ]
    document["scenes"] = [{"nodes": [1, 2]}]
    path = Path("/dev/shm/coopera-fuzz-seed.glb") if Path("/dev/shm").is_dir() else Path("coopera-fuzz-seed.glb")
    write_glb(path, document, data + picture)
    found = path.read_bytes()
    path.unlink()
    return found


def _read_glb(path: Path) -> object:
    return look_of(read_glb(path), "#336699")


def _obj(path: Path) -> object:
    return part_file(path.parent, MeshPart(file=path.name, colour="#336699"))


def _scene(path: Path) -> object:
    scene = load_scene(path)
    return dump_scene(scene), scene.walls()


def _small_scene() -> bytes:
    data = json.loads((ROOT / "simulation/scenes/maple.json").read_text(encoding="utf-8"))
    fixed = [one for one in data["objects"] if one["fixed"]][:3]
    names = {one["name"] for one in fixed}
    loose = [one for one in data["objects"] if not one["fixed"] and one.get("on") in names][:3]
    return json.dumps({**data, "objects": fixed + loose}).encode()


def _body(name: str) -> Callable[[Path], Target]:
    def ready(folder: Path) -> Target:
        for one in ("fetch.yaml", "fetch.urdf", "ball.obj"):
            (folder / one).write_bytes((ROOT / "simulation/bodies" / one).read_bytes())
        return Target(folder / name, [(folder / name).read_bytes()], lambda: read_body(folder / "fetch.yaml"))

    return ready


# Of motions and pictures


def _picture(kind: str) -> bytes:
    out = io.BytesIO()
    Image.fromarray(np.arange(432, dtype=np.uint8).reshape(12, 12, 3)).save(out, kind)
    return out.getvalue()


def _read_picture(path: Path) -> object:
    with open_picture(path.read_bytes()) as image:
        return image.convert("RGB").resize((8, 8))


def _capture(path: Path) -> object:
    return retarget(read_capture(path))


def _motion_x() -> bytes:
    out = io.BytesIO()
    np.save(out, np.linspace(-1, 1, 5 * 322, dtype=np.float32).reshape(5, 322))
    return out.getvalue()


def _amass() -> list[bytes]:
    rows = np.linspace(-1, 1, 8 * 156).reshape(8, 156)
    found = []
    for parts in ({"poses": rows}, {"root_orient": rows[:, :3], "pose_body": rows[:, 3:66]}):
        out = io.BytesIO()
        np.savez_compressed(out, trans=rows[:, :3], mocap_frame_rate=np.array(60.0), gender=np.array("x"), **parts)
        found.append(out.getvalue())
    return found


def _motions(folder: Path) -> Target:
    path = folder / "motions.yaml"
    seeds = [_yaml({"wave.npy": {"caption": "wave the hand", "class": "stand", "posture": "stand", "hold": "right"}})]
    return Target(path, seeds, lambda: user_folder._entries(folder, {"wave.npy"}))


# Of people


def _persona(path: Path) -> object:
    return read_persona(path)


def _log(path: Path) -> object:
    return looks_like_log(path), read_log(path)


def _diaries(path: Path) -> object:
    return read_published(path)


def _conversations(path: Path) -> object:
    return read_rows(path)


def _changes(path: Path) -> object:
    changes = open_changes(str(path), 0)
    return [changes("amara", day) for day in (0, 15, 40)]  # type: ignore[arg-type]


def _time_use(path: Path) -> object:
    return read_time_use(path)


def _answers(path: Path) -> object:
    return read_participants([path], "s1")


def _key(path: Path) -> object:
    return read_key(path)


# Of studies


def _config(path: Path) -> object:
    return load_config(path).to_yaml()


def _grid(path: Path) -> object:
    return load_grid(path, {})


def _results(path: Path) -> object:
    return from_csv(path.read_text(encoding="utf-8", errors="replace"), str(path))


def _prices(path: Path) -> object:
    return read_prices(path)


def _goals(path: Path) -> object:
    return [str(goal) for goal in read_goals(path).values()]


def _recipe(path: Path) -> object:
    return read_recipe(path)


def _memory(path: Path) -> object:
    return list(transfer._read(path))


# Of models


def _prompt(path: Path) -> object:
    prompt = loader._read("human/intention", path)
    filled = [
        prompt.template.fill({name: one[name] for name in prompt.head.inputs}) for one in examples(prompt.head.id)
    ]
    if any(" at 0x" in text.lower() for text in filled):
        raise AssertionError("an address stands in a prompt")
    return filled


def _household(path: Path) -> object:
    return knowledge.load(path)


def _few_activities() -> bytes:
    data = _loaded("models/offline/household.yaml")
    few = [{**one, "follows": []} for one in data["activities"][:2]]
    return _yaml({"looks_like": data["looks_like"], "activities": few})


def _facts(path: Path) -> object:
    return facts_file.load(path)


def _few_facts() -> bytes:
    data = _loaded("models/offline/human/facts.yaml")
    return _yaml(
        {key: value[:3] if isinstance(value, list) else dict(list(value.items())[:3]) for key, value in data.items()}
    )


def _reply(folder: Path) -> Target:
    wanted = Wanted(FreeMotionReply, examples("human/tasks_type2")[0])
    act = {"kind": "free_motion", "target": "armchair_1", "in_hand": "mug", "motion": "sit and read"}
    task = {"thought": "I want to sit.", "reason_human": "", "reason_intentions": "", "reason_tasks": "", "act": act}
    text = json.dumps({"tasks": [task, task, task, task, task]})
    seeds = [f"<think>hm</think>Sure:\n```json\n{text}\n```".encode(), text.replace('"', "'").encode(), text.encode()]
    path = folder / "reply.txt"
    return Target(path, seeds, lambda: read_reply(path.read_text(encoding="utf-8", errors="replace"), wanted))


_HOUR, _EVENING = "trace/day-00/hour-09.json", "trace/day-00/evening.json"
_LOG = b"day,hour,intention,tasks,continues,away\n0,9,Bake bread,get flour; heat the oven,no,no\n0,10,Rest,,yes,\n"
_DIARY = b"day,start,end,activity,tasks,away\n0,07:30,08:15,Eat,make tea,\n0,09:00,12:30,Work,,yes\n0,23:00,25:30,TV,,"
_SAID = (
    b'{"day": 0, "hour": 9, "intention": "Bake", "tasks": ["get flour"], "away": false}\n'
    b'{"day": 0, "hour": 10, "intention": "Rest"}\n'
)
_CHAT = (
    b'user 1 personas,user 2 personas,Best Generated Conversation\n"I bake.\nI have cats.",I run.,'
    b'"User 1: Hi!\nUser 2: Hello."\nI sail.,I swim.,Hi.\n'
)
_HOMER = (
    b'{"A/train/000": {"schedule": [["breakfast", 485, 528], ["leave_home", 540, 550], ["reading", 700, 760]]}, '
    b'"A/train/001": {"schedule": [["breakfast", 480, 500]]}}'
)
_TEXTS = (
    b'{"kind": "coopera memory stream", "version": 1, "stream": "life", "model": "m"}\n'
    b'{"text": "I baked.", "hour": 3, "metadata": {"kind": "task"}}\n'
)
_CHANGES = _yaml(
    {
        "moods": True,
        "changes": [
            {
                "kind": "illness",
                "text": "I have the flu",
                "day": 12,
                "until": 17,
                "more": {"nap": 3.0},
                "never": ["cardio"],
            },
            {
                "kind": "job",
                "text": "A new job",
                "day": 30,
                "work": {"at": "outside", "days": [0, 1], "start": 8, "end": 15},
            },
            {"kind": "drift", "text": "I read more", "day": 20, "ramp": 30, "more": {"read": 3.0}, "person": "amara"},
        ],
    }
)
_GOALS = _yaml(
    {
        "goals": {
            "tidy": {"all": ["clean(every plate)", {"not": "open(fridge)"}]},
            "mug": "on(mug, dining table) or inside(mug, dishwasher)",
            "day": {"then": ["at(human, kitchen)", "holding(human, mug)"]},
            "rest": {"eventually": "performed(human, sit and rest)"},
        }
    }
)
_STUDY = _yaml(
    {
        "setting": 2,
        "collab": 1,
        "humans": ["amara", "bruno"],
        "scenes": ["maple"],
        "days": 2,
        "hours": 3,
        "method": "ours",
        "seed": 3,
        "models": {"human": "offline", "robot": "offline", "judge": "offline"},
        "budget": {"calls": 100},
        "pictures": "none",
    }
)
_GRID = _yaml(
    {"methods": ["ours", "random"], "settings": ["1", "2"], "collab": [1, 2], "seeds": 2, "days": 2, "hours": 3}
)
_PRICES = _yaml({"as_of": "2026-01-01", "currency": "USD", "models": {"openai:gpt-4o": {"in": 2.5, "out": 10}}})
_ANSWERS = b'{"study": "s1", "participant": "p", "answers": {"A1": "B", "M2": "C"}}'
_KEY = b'{"study": "s1", "choices": {"A1": "B"}, "matches": {"M1": "C"}, "people": {"A1": "amara"}}'
_HOURS = b"\n".join((ROOT / "docs/results/offline-seeds/hours.csv").read_bytes().split(b"\n")[:6])
_TIME_USE = (ROOT / "evaluation/people/time_use_atus_2022_23.csv").read_bytes()
_BOX = (
    b"v 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nv 0.0000 1.0000 0.0000\nvn 0.000 0.000 1.000\nf 1//1 2//1 3//1\n"
)

READERS: dict[str, Reader] = {
    "hour": Reader(_run(_HOUR, _hour), change.in_json),
    "evening": Reader(_run(_EVENING, _evening), change.in_json),
    "export": Reader(_run(_HOUR, _export), change.in_json),
    "report": Reader(_run(_HOUR, _report), change.in_json),
    "report-evening": Reader(_run(_EVENING, _report), change.in_json),
    "run-json": Reader(_run("run.json", _run_json), change.in_json),
    "recorded": Reader(_run(_HOUR, _recorded), change.in_json),
    "prompt": Reader(
        _of_file("intention.md", [(ROOT / "prompts/human/intention.md").read_bytes()], _prompt), change.anywhere
    ),
    "reply": Reader(_reply, change.anywhere, (CooperaError, BadReplyError)),
    "household": Reader(_of_file("household.yaml", [_few_activities()], _household), change.in_yaml),
    "facts": Reader(_of_file("facts.yaml", [_few_facts()], _facts), change.in_yaml),
    "persona": Reader(
        _of_file("amara.yaml", [(ROOT / "coopera/personas/amara.yaml").read_bytes()], _persona), change.in_yaml
    ),
    "config": Reader(_of_file("study.yaml", [_STUDY], _config), change.in_yaml),
    "grid": Reader(_of_file("grid.yaml", [_GRID], _grid), change.in_yaml),
    "prices": Reader(_of_file("prices.yaml", [_PRICES], _prices), change.in_yaml),
    "recipe": Reader(
        _of_file("recipe.yaml", [(ROOT / "models/classifiers/lora_instruct.yaml").read_bytes()], _recipe),
        change.in_yaml,
    ),
    "changes": Reader(_of_file("changes.yaml", [_CHANGES], _changes), change.in_yaml),
    "goals": Reader(_of_file("goals.yaml", [_GOALS], _goals), change.in_yaml),
    "motions": Reader(_motions, change.in_yaml),
    "body": Reader(_body("fetch.yaml"), change.in_yaml),
    "urdf": Reader(_body("fetch.urdf"), change.anywhere),
    "log": Reader(_of_file("log.csv", [_LOG, _DIARY], _log), change.in_cells),
    "log-lines": Reader(_of_file("log.jsonl", [_SAID], _log), change.in_lines),
    "diary-homer": Reader(_of_file("homer.json", [_HOMER], _diaries), change.in_json),
    "diary-atus": Reader(_of_file("atusact.dat", [activities().encode()], _diaries), change.in_cells),
    "conversations": Reader(_of_file("chat.csv", [_CHAT], _conversations), change.in_cells),
    "time-use": Reader(_of_file("use.csv", [_TIME_USE], _time_use), change.in_cells),
    "results": Reader(_of_file("hours.csv", [_HOURS], _results), change.in_cells),
    "answers": Reader(_of_file("a.json", [_ANSWERS], _answers), change.in_json),
    "answers-paper": Reader(
        _of_file("a.csv", [b"participant,question,answer\np,A1,b\np,M1,c\nq,A1,a\n"], _answers), change.in_cells
    ),
    "key": Reader(_of_file("key.json", [_KEY], _key), change.in_json),
    "memory": Reader(_of_file("life.jsonl", [_TEXTS], _memory), change.in_lines),
    "scene": Reader(_of_file("maple.json", [_small_scene()], _scene), change.in_json),
    "hssd-scene": Reader(_hssd(f"scenes/{SCENE}.scene_instance.json"), change.in_json),
    "hssd-rooms": Reader(_hssd(f"semantics/scenes/{SCENE}.semantic_config.json"), change.in_json),
    "hssd-object": Reader(_hssd("objects/b/b2mug.object_config.json"), change.in_json),
    "hssd-table": Reader(_hssd("semantics/objects.csv"), change.in_cells),
    "glb": Reader(_of_file("thing.glb", [_glb()], _read_glb), change.in_glb),
    "obj": Reader(_of_file("part.obj", [_BOX * 4], _obj), change.anywhere),
    "npy": Reader(_of_file("clip.npy", [_motion_x()], _capture), change.in_npy),
    "npz": Reader(_of_file("clip.npz", _amass(), _capture), change.in_npz),
    "picture": Reader(
        _of_file("p.png", [_picture(kind) for kind in ("PNG", "JPEG", "WEBP")], _read_picture),
        change.anywhere,
        (ValueError,),
    ),
}
