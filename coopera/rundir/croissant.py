"""Croissant metadata of exported lives: files, fields and fingerprints (https://docs.mlcommons.org/croissant, 1.0).

Written without the library; the tests hand it to the library's own validator where that is installed.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coopera.config.files import canonical_json, write_atomic
from coopera.config.schema import Config
from coopera.core.version import __version__
from coopera.rundir.directory import RunDir
from coopera.rundir.fingerprints import fingerprints

FILE = "croissant.json"
SIMULATED = "simulated"
LICENCE = "https://www.apache.org/licenses/LICENSE-2.0"
_PARQUET = "application/x-parquet"
_TYPES = {
    "int64": "sc:Integer",
    "string": "sc:Text",
    "bool_": "sc:Boolean",
    **dict.fromkeys(("float32", "float64"), "sc:Float"),
}
_REFERENCES = {"frames/task_index": "tasks/task_index", "frames/episode_index": "episodes/episode_index"}
_TERMS = (
    "citeAs column conformsTo equivalentProperty extract field fileProperty fileObject fileSet format includes "
    "isLiveDataset jsonPath key md5 parentField path recordSet references regex repeated replace samplingRate "
    "separator source subField transform"
)
_CONTEXT: dict[str, Any] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    **{term: f"cr:{term}" for term in _TERMS.split()},
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "rai": "http://mlcommons.org/croissant/RAI/",
    "sc": "https://schema.org/",
}


class Records(NamedTuple):
    """A record set: rows of one kind, in one or several Parquet files.

    Attributes:
        columns: Arrow types by name, as the export writes them.
        files: Where they lie in the data set's folder, by a pattern.
        key: The columns by which a row is known.
    """

    name: str
    about: str
    columns: Mapping[str, str]
    files: str
    key: Sequence[str]


def write_croissant(run: RunDir, out: Path, records: Sequence[Records], about: Mapping[str, str]) -> Path:
    """Write `out/croissant.json`, once the files are there; returns its path.

    Args:
        run: Whose lives they are.
        out: The data set's folder.
        records: Its record sets.
        about: What each column is, by its name.

    Raises:
        OSError: If it cannot be written.
    """
    marks = fingerprints([run]).model_dump(exclude={"mixed"})
    config = run.config
    facts = {
        **{f"fingerprint of {name}": mark for name, mark in marks.items()},
        "method": config.method,
        "models": ", ".join(f"{role}: {spec}" for role, spec in run.info.get("models", {}).items()),
        "household": config.household,
        "seed": str(config.seed),
    }
    sources = sorted({persona.source.split(":")[0] for persona in run.people().values()})
    data = {
        "@context": _CONTEXT,
        "@type": "sc:Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "name": f"coopera-{run.root.name}",
        "description": "Days of people in simulated homes with a robot that learns to help them, hour by hour. "
        f"{whose_days(config)} Persona texts ({', '.join(sources)}) keep the licence of their source.",
        "license": LICENCE if config.played_by == SIMULATED else "What the person who lived these days consented to.",
        "creator": {"@type": "sc:Organization", "name": f"coopera {__version__}"},
        "citeAs": "coopera: simulated people, and robots that learn whom they live with",
        "version": "1.0.0",
        "datePublished": str(run.info.get("started", ""))[:10],
        "additionalProperty": [
            {"@type": "sc:PropertyValue", "name": name, "value": value} for name, value in facts.items()
        ],
        "distribution": [one for each in records for one in _distribution(each, out)],
        "recordSet": [_record_set(each, out, about) for each in records],
    }
    path = out / FILE
    write_atomic(path, canonical_json(data))
    return path


def whose_days(config: Config) -> str:
    """Whether a real person's days are in an export, in a sentence."""
    if config.played_by == SIMULATED:
        return "The people are simulated; no real person's days are in it."
    return f"REAL DAYS ARE IN IT: the person's decisions were made by a real one ({config.played_by})."


def _distribution(records: Records, out: Path) -> list[dict[str, Any]]:
    """Each file with its SHA-256, and where there are several, the set of them."""
    found: list[dict[str, Any]] = []
    for path in _paths(records, out):
        name = path.relative_to(out).as_posix()
        with path.open("rb") as file:
            mark = hashlib.file_digest(file, "sha256").hexdigest()
        found.append(
            {
                "@type": "cr:FileObject",
                "@id": name,
                "name": name,
                "contentUrl": name,
                "contentSize": f"{path.stat().st_size} B",
                "encodingFormat": _PARQUET,
                "sha256": mark,
            }
        )
    if len(found) > 1:
        files = {"includes": records.files, "encodingFormat": _PARQUET}
        found.append({"@type": "cr:FileSet", "@id": _set(records), "name": _set(records), **files})
    return found


def _record_set(records: Records, out: Path, about: Mapping[str, str]) -> dict[str, Any]:
    paths = _paths(records, out)
    source = (
        {"fileObject": {"@id": paths[0].relative_to(out).as_posix()}}
        if len(paths) == 1
        else {"fileSet": {"@id": _set(records)}}
    )
    fields = []
    for name, kind in records.columns.items():
        inner, known = kind.removeprefix("list of "), f"{records.name}/{name}"
        one: dict[str, Any] = {
            "@type": "cr:Field",
            "@id": known,
            "name": known,
            "description": about[name],
            "dataType": _TYPES[inner],
            "source": {**source, "extract": {"column": name}},
        }
        if inner != kind:
            one["repeated"] = True
        if known in _REFERENCES:
            one["references"] = {"field": {"@id": _REFERENCES[known]}}
        fields.append(one)
    return {
        "@type": "cr:RecordSet",
        "@id": records.name,
        "name": records.name,
        "description": records.about,
        "key": [{"@id": f"{records.name}/{name}"} for name in records.key],
        "field": fields,
    }


def _paths(records: Records, out: Path) -> list[Path]:
    return sorted(out.glob(records.files))


def _set(records: Records) -> str:
    return f"{records.name}-files"
