"""The files of a Habitat data set as they are published, each read once and checked.

Habitat's layout is general: a `*.scene_instance.json` places templates, and a template is a `*.object_config.json` or
`*.stage_config.json`, an entry of a `*.scene_dataset_config.json`, or a mesh alone. Files are found by their names,
wherever in the folder they lie. HSSD adds a table of what its objects are, and both may tell rooms.
https://aihabitat.org/docs/habitat-sim/attributesJSON.html
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import exists, read_text
from coopera.core.foreign.files import read_json as read_any_json
from coopera.core.foreign.tables import read_table
from coopera.simulation.homes.glb import Array
from coopera.simulation.homes.mesh_files import FORMATS
from coopera.simulation.homes.untrusted import as_model, read_json
from coopera.simulation.making.habitat.schema import (
    AssetConfig,
    CatalogueRow,
    Dataset,
    Group,
    Instance,
    Lexicon,
    Region,
    SceneInstance,
    Semantics,
)

_INSTANCE = ".scene_instance.json"
_OBJECT = ".object_config.json"
_STAGE = ".stage_config.json"
_DATASET = ".scene_dataset_config.json"
_SEMANTICS = ".semantic_config.json"
_LEXICON = "semantic_lexicon.json"
_KINDS = (_INSTANCE, _OBJECT, _STAGE, _DATASET, _SEMANTICS, _LEXICON)
MOST_FILES = 500_000
"""No folder holds more."""


class _Source(NamedTuple):
    """Where a template is written: files and attributes, the later ones above the former, or a mesh alone."""

    base: Path
    files: tuple[Path, ...] = ()
    first: dict[str, Any] = {}
    last: dict[str, Any] = {}


class Template(NamedTuple):
    """What an object or a stage is made from; `name` is what its file is called."""

    config: AssetConfig
    asset: Path
    frame: Array
    """Rotation from the asset's own frame to Habitat's, shape (3, 3)."""
    row: CatalogueRow
    opening: bool
    name: str = ""
    label: str = ""
    """What the lexicon of the data set calls it; empty where it does not."""


class Folder:
    """A folder with a Habitat data set."""

    def __init__(self, root: Path) -> None:
        """Look at the names of a folder's files; none is read yet.

        Raises:
            ConfigError: If there is no scene in it, or more than `MOST_FILES`.
        """
        self.root = root
        self._files: dict[str, list[Path]] = {}
        for count, path in enumerate(_below(root)):
            if count >= MOST_FILES:
                raise ConfigError(f"{root}: the folder holds more than {MOST_FILES} files.")
            kind = next((end for end in _KINDS if path.name.endswith(end)), path.suffix.lower())
            self._files.setdefault(kind, []).append(path)
        if _INSTANCE not in self._files:
            raise ConfigError(f"{root}: there is no file <id>{_INSTANCE} in this folder, and so no scene of Habitat.")
        self.scene = lru_cache(maxsize=8)(self._scene)

    @classmethod
    def around(cls, path: Path) -> Folder:
        """The folder that a scene's or a data set's file belongs to: the nearest with a data set, or with objects/."""
        if path.is_dir():
            return cls(path)
        for folder in list(path.absolute().parents)[:4]:
            if (folder / "objects").is_dir() or any(folder.glob(f"*{_DATASET}")):
                return cls(folder)
        return cls(path.parent)

    def ids(self) -> list[str]:
        """Names of all scenes, sorted."""
        return sorted(self._by_name(_INSTANCE))

    @cached_property
    def has_table(self) -> bool:
        """Whether a table says what the objects are, as in HSSD."""
        return (self.root / "semantics" / "objects.csv").exists()

    def _by_name(self, end: str) -> dict[str, Path]:
        """Files of one kind by their names without the kind; of two that are called alike, the first by its path."""
        return {path.name[: -len(end)]: path for path in reversed(self._files.get(end, []))}

    def _scene(self, id: str) -> SceneInstance:
        return read_json(self._scene_file(id), SceneInstance)

    def with_origin(self, id: str, instance: Instance) -> Instance:
        """The instance, with the scene's origin of translations where it has none of its own."""
        origin = instance.translation_origin or self.scene(id).translation_origin
        return instance.model_copy(update={"translation_origin": origin})

    def regions(self, id: str) -> list[Region]:
        """The rooms of a scene; none where no file tells them.

        Raises:
            ConfigError: If the file is wrong.
        """
        path = self._semantics.get(id)
        if path is None:
            return []
        found = read_json(path, Semantics).region_annotations
        for number, region in enumerate(found):
            if not region.has_place:
                raise ConfigError(f"{path}, field region_annotations.{number}: must have poly_loop, or both bounds.")
        return found

    def template(self, id: str, number: int, name: str) -> Template:
        """What an object of a scene is made from.

        Raises:
            FileNotFoundError: If one of its files is missing; its text is one sentence for the user.
            ConfigError: If one of them is wrong.
        """
        found = _find(self._objects, name, _OBJECT)
        if found is None:
            field = f"object_instances.{number}.template_name"
            key = _key(name, _OBJECT)
            raise FileNotFoundError(
                f"{self._scene_file(id)}, field {field}: there is no file {key}{_OBJECT} in {self.root}."
            )
        key, source = found
        row = self._rows.get(key) or self._rows.get(key.partition("_part_")[0]) or CatalogueRow()
        return self._template(key, source, row)

    def stage(self, id: str) -> Template | None:
        """What the walls and floors are made from; None where the scene has no stage or its files are missing."""
        placed = self.scene(id).stage_instance
        if placed is None:
            return None
        found = _find(self._stages, placed.template_name, _STAGE)
        try:
            return self._template(*found, CatalogueRow()) if found else None
        except FileNotFoundError:
            return None

    def _scene_file(self, id: str) -> Path:
        return self._by_name(_INSTANCE)[id]

    def _template(self, name: str, source: _Source, row: CatalogueRow) -> Template:
        path = source.files[-1] if source.files else source.base
        said = dict(source.first)
        for file in source.files:
            content = read_any_json(file)
            if not isinstance(content, dict):
                raise ConfigError(f"{file}: a template is a JSON object.")
            said |= content
        config = as_model(path, said | source.last, AssetConfig)
        asset = config.render_asset or config.collision_asset
        field = "render_asset" if config.render_asset or not config.collision_asset else "collision_asset"
        if not asset:
            raise ConfigError(f"{path}, field {field}: must name a glb file.")
        file = Path(os.path.normpath(source.base.parent / asset))
        if not file.is_relative_to(os.path.normpath(self.root)):
            raise ConfigError(f"{path}, field {field}: must name a file within {self.root}, not {asset!r}.")
        if not exists(file):
            raise FileNotFoundError(f"{path}, field {field}: there is no file {file}.")
        label = "" if config.semantic_id is None else self._words.get(config.semantic_id, "")
        return Template(config, file, _frame(config, path), row, "openings" in path.parts, name, label)

    @cached_property
    def _objects(self) -> dict[str, _Source]:
        return self._sources(_OBJECT, lambda dataset: dataset.objects)

    @cached_property
    def _stages(self) -> dict[str, _Source]:
        return self._sources(_STAGE, lambda dataset: dataset.stages)

    def _sources(self, end: str, group: Callable[[Dataset], Group]) -> dict[str, _Source]:
        """All templates of a kind by their names: meshes alone, files of templates, and what a data set says."""
        groups = [group(dataset) for dataset in self._datasets.values()]
        kinds = {kind for one in groups for kind in one.paths}
        if not groups and end not in self._files:
            kinds = set(FORMATS)
        alone = [path for kind in FORMATS if kind in kinds for path in self._files.get(kind, [])]
        found = {path.stem: _Source(path, last={"render_asset": path.name}) for path in alone}
        found |= {key: _Source(path, (path,)) for key, path in self._by_name(end).items()}
        for path, dataset in self._datasets.items():
            said = group(dataset)
            found = {key: one._replace(first=said.default_attributes | one.first) for key, one in found.items()}
            for entry in said.configs:
                base = _find(found, entry.original_file, end) if entry.original_file else None
                handle = entry.template_handle or (base[0] if base else "")
                source = base[1] if base else _Source(path, first=said.default_attributes)
                found[_key(handle, end)] = source._replace(last=source.last | entry.attributes)
        return found

    @cached_property
    def _datasets(self) -> dict[Path, Dataset]:
        return {path: read_json(path, Dataset) for path in self._files.get(_DATASET, [])}

    @cached_property
    def _semantics(self) -> dict[str, Path]:
        return self._by_name(_SEMANTICS)

    @cached_property
    def _words(self) -> dict[int, str]:
        return {one.id: one.name for path in self._files.get(_LEXICON, []) for one in read_json(path, Lexicon).classes}

    @cached_property
    def _rows(self) -> dict[str, CatalogueRow]:
        if not self.has_table:
            return {}
        path = self.root / "semantics" / "objects.csv"
        lines = read_table(path, read_text(path))
        names = next(lines).cells
        if "id" not in names or "super_category" not in names:
            raise ConfigError(f"{path}, line 1: the columns must have the names id and super_category.")
        rows = (dict(zip(names, cells, strict=False)) for _, cells in lines)
        return {
            row["id"]: CatalogueRow(*(row.get(name, "").strip() for name in CatalogueRow._fields))
            for row in rows
            if "id" in row
        }


def _below(root: Path) -> Iterator[Path]:
    """All files of a folder, by their paths; links to folders are not followed."""
    for folder, inner, names in os.walk(root):
        inner.sort()
        yield from (Path(folder, name) for name in sorted(names))


def _key(handle: str, end: str) -> str:
    return Path(handle).name.removesuffix(end)


def _find(found: dict[str, _Source], handle: str, end: str) -> tuple[str, _Source] | None:
    """The template that a handle names, else, as in Habitat, the first whose name holds it."""
    key = _key(handle, end)
    if key not in found:
        key = next((one for one in sorted(found) if key and key in one), "")
    return (key, found[key]) if key else None


def _frame(config: AssetConfig, path: Path) -> Array:
    """The rotation that takes the asset's up to +Y and its front to -Z."""
    up, front = np.array(config.up), np.array(config.front)
    right = np.cross(front, up)
    if not np.isclose([np.linalg.norm(up), np.linalg.norm(front), np.linalg.norm(right)], 1.0, atol=1e-3).all():
        raise ConfigError(f"{path}, field up: up and front must be directions of length 1 at right angles.")
    return np.array([right, up, -front])
