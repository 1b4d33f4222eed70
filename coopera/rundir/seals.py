"""Seals: what a run has finished, by SHA-256, so that a file which was lost or altered since is told by its name.

There is a seal of the start (config, people, homes), one of each finished day, and one of the end (the figures). Each
names the seal before it, so that none can go unnoticed. A seal says nothing of time: the same files, the same bytes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import yaml
from pydantic import AfterValidator, ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import RunError
from coopera.core.naming import sha256
from coopera.core.people import Frozen
from coopera.core.strict_yaml import load_yaml

START, END = "seal.json", "seal-end.json"
REMADE = "remade.json"
"""Files that `coopera doctor` made anew and that came out with other bytes than those sealed, by their new SHA-256."""
FIGURES = ("metrics.csv", "summary.json")
REPORT = "report.html"

_LASTING = ("schema", "prompts", "models", "knowledge", "versions", "resumable", "prices")
_OF_A_DAY = ("frames", "video", "adapters")


def _inside(name: str) -> str:
    parts = name.split("/")
    if not name or name.startswith("/") or ".." in parts or not name.isprintable():
        raise ValueError("expected the path of a file in the run")
    return name


Name = Annotated[str, AfterValidator(_inside)]


class Seal(Frozen):
    """What was finished at one time.

    Attributes:
        files: SHA-256 by the file's path in the run. Of config.yaml all counts but the budget, which a resume may
            raise; of run.json what stays the same from the beginning to the end.
        before: The seal before this one, likewise.
        removed: Files of an earlier seal that were removed on purpose (`--keep-adapters`).
    """

    files: dict[Name, str]
    before: dict[Name, str] = {}
    removed: list[Name] = []


class Broken(NamedTuple):
    """A sealed file that is not as it was sealed."""

    file: str
    """Its path in the run."""
    what: Literal["missing", "altered"]
    by: str
    """The seal that names it."""

    @property
    def kind(self) -> str:
        """The first part of its path, such as "trace" or "adapters"; of a seal, "seal"."""
        return "seal" if Path(self.file).name in (START, END, REMADE) else self.file.partition("/")[0]


def seal_start(root: Path, info: Mapping[str, Any]) -> None:
    """Seal what a run starts with; `info` is what run.json will say.

    Raises:
        OSError: If it cannot be written.
    """
    write_seal(root / START, seal_of_start(root, info))


def seal_of_start(root: Path, info: Mapping[str, Any]) -> Seal:
    """What `seal_start` writes."""
    given = sorted(path for name in ("people", "scenes") for path in (root / name).rglob("*") if path.is_file())
    files = {"config.yaml": _config_sha(root / "config.yaml"), "run.json": _info_sha(info)}
    return Seal(files=files | {_name(root, path): file_sha(path) for path in given})


def seal_of_day(root: Path, day: int) -> Seal:
    """What a finished day has, without what goes because of it."""
    trace = root / "trace" / f"day-{day:02d}"
    paths = [*trace.glob("hour-[0-9][0-9].json"), trace / "evening.json"]
    for name in _OF_A_DAY:
        paths += [path for path in (root / name / f"day-{day:02d}").rglob("*") if path.is_file()]
    whole = [path for path in sorted(paths) if not path.name.startswith(".") and path.suffix != ".part"]
    return Seal(files={_name(root, path): file_sha(path) for path in whole}, before=_before(root, day))


def write_seal(path: Path, seal: Seal) -> None:
    """Write a seal as a whole.

    Raises:
        OSError: If it cannot be written.
    """
    write_atomic(path, seal_text(seal))


def seal_text(seal: Seal) -> str:
    """A seal as it stands on file."""
    return canonical_json(seal.model_dump())


def seal_end(root: Path) -> None:
    """Seal the figures of a finished run.

    Raises:
        OSError: If it cannot be written.
    """
    files = {name: file_sha(root / name) for name in (*FIGURES, REPORT) if (root / name).is_file()}
    write_seal(root / END, Seal(files=files, before=_before(root, None)))


def seal_report(root: Path) -> None:
    """Add the report, as it now is, to the seal of the end, where there is one."""
    seal = read_seal(root / END)
    if seal is not None:
        write_seal(root / END, seal.model_copy(update={"files": seal.files | {REPORT: file_sha(root / REPORT)}}))


def note_remade(root: Path, files: Iterable[str]) -> None:
    """Say that files were made anew with other bytes than before."""
    known = read_seal(root / REMADE) or Seal(files={})
    write_seal(root / REMADE, Seal(files=known.files | {name: file_sha(root / name) for name in files}))


def day_seal(root: Path, day: int) -> Path:
    """The file trace/day-DD/seal.json, there or not."""
    return root / "trace" / f"day-{day:02d}" / START


def is_sealed(root: Path) -> bool:
    """Whether a run was begun by a version that seals."""
    return (root / START).is_file() or any(root.glob(f"trace/day-*/{START}"))


def read_seal(path: Path) -> Seal | None:
    """Read a seal; None where there is none.

    Raises:
        RunError: If it is damaged.
    """
    try:
        return Seal.model_validate_json(path.read_bytes())
    except FileNotFoundError:
        return None
    except OSError as err:
        raise RunError(f"{path}: the seal cannot be read ({reason(err)}).") from err
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        field = ".".join(str(part) for part in first["loc"]) or "the whole file"
        raise RunError(f"{path}: the seal is damaged ({field}: {first['msg'].lower()}).") from err


def seals(root: Path) -> Iterator[Path]:
    """The seals of a run, in order."""
    yield from (root / START, *sorted(root.glob(f"trace/day-*/{START}")), root / END)


def broken(root: Path) -> list[Broken]:
    """What was lost or altered since it was sealed, in order; nothing of a run without seals."""
    found: dict[str, Broken] = {}
    there: list[tuple[str, Seal]] = []
    for path in seals(root):
        name = _name(root, path)
        try:
            seal = read_seal(path)
        except RunError:
            found.setdefault(name, Broken(name, "altered", name))
            continue
        there += [(name, seal)] if seal else []
    remade, removed = _remade(root), {name for _, seal in there for name in seal.removed}
    for by, seal in there:
        for name, sha in {**seal.before, **seal.files}.items():
            now = _sha_now(root, name)
            if now is None and name not in removed:
                found.setdefault(name, Broken(name, "missing", by))
            elif now not in (None, sha, remade.get(name)):
                found.setdefault(name, Broken(name, "altered", by))
    return list(found.values())


def sealed_sha(root: Path, name: str) -> str | None:
    """The SHA-256 that the first seal which names a file has of it; None where none does, or none can be read."""
    for path in seals(root):
        try:
            seal = read_seal(path)
        except RunError:
            continue
        if seal and (sha := seal.before.get(name) or seal.files.get(name)):
            return sha
    return None


def in_one_line(root: Path) -> str:
    """What `broken` found, in a line; empty where all is as it was sealed."""
    found = broken(root)
    if not found:
        return ""
    first, others = found[0], len(found) - 1
    more = f", and so {'is' if others == 1 else 'are'} {others} more" if others else ""
    told = f"{first.file} is missing" if first.what == "missing" else f"{first.file} is not as it was"
    return f"{root}: {told}{more}; `coopera doctor {root}` tells more."


def refuse_broken(root: Path) -> None:
    """Refuse a run whose coming hours would rest on something that is not as it was sealed.

    Pictures decide nothing of what comes, and figures are made again.

    Raises:
        RunError: Naming the first such file and what can be done.
    """
    for one in broken(root):
        if one.kind not in ("frames", "video", *FIGURES, REPORT):
            what = "is missing" if one.what == "missing" else "is not as it was"
            raise RunError(f"{root / one.file}: this file {what}, by {one.by}; {_way_out(root, one)}.")


def _way_out(root: Path, one: Broken) -> str:
    doctor = f"`coopera doctor {root} --repair`"
    if one.kind == "adapters":
        return f"{doctor} trains it again"
    if one.kind == "seal":
        return f"restore it, or let {doctor} write it again if all that it names is whole"
    if one.kind in ("people", "scenes"):
        return f"restore it, or let {doctor} look for the same one among those installed"
    if one.kind == "trace":
        again = f"delete that day's {START} and all that came after the file, to have it lived again"
        return f"restore it, since nothing else holds it, or {again}"
    return "restore it, since nothing else holds it"


def _before(root: Path, day: int | None) -> dict[str, str]:
    """The newest seal before a day (None: of all), by its name."""
    earlier = [root / START, *(path for path in sorted(root.glob(f"trace/day-*/{START}")) if _is_before(path, day))]
    last = [path for path in earlier if path.is_file()][-1:]
    return {_name(root, path): file_sha(path) for path in last}


def _is_before(path: Path, day: int | None) -> bool:
    number = path.parent.name.removeprefix("day-")
    return number.isdigit() and (day is None or int(number) < day)


def _remade(root: Path) -> dict[str, str]:
    try:
        return (read_seal(root / REMADE) or Seal(files={})).files
    except RunError:
        return {}


def _sha_now(root: Path, name: str) -> str | None:
    """The SHA-256 of a file by its name in a seal, or None where it cannot be read as what it is."""
    path = root / name
    if path.exists() and not path.is_file():
        return "unreadable"
    try:
        if name == "config.yaml":
            return _config_sha(path)
        if name == "run.json":
            return _info_sha(json.loads(path.read_text(encoding="utf-8")))
        return file_sha(path)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, AttributeError, yaml.YAMLError, RunError):
        return "unreadable"


def _config_sha(path: Path) -> str:
    data = load_yaml(path.read_text(encoding="utf-8"))
    return _sha({name: value for name, value in data.items() if name != "budget"})


def _info_sha(info: Mapping[str, Any]) -> str:
    return _sha({name: info.get(name) for name in _LASTING})


def _sha(data: Any) -> str:
    return sha256(canonical_json(data, indent=None))


def file_sha(path: Path) -> str:
    """The SHA-256 of a file.

    Raises:
        OSError: If it cannot be read.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _name(root: Path, path: Path) -> str:
    return path.relative_to(root).as_posix()
