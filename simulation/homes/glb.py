"""Read where the surface of a binary glTF 2.0 file lies: its corners and triangles, in the file's own frame.

Of materials only the base colour is read, of a picture its mean. Where a primitive is compressed, the box that the
format demands for it stands for its corners.
"""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Annotated, Any, NamedTuple, NoReturn, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field, ValidationError
from pydantic.alias_generators import to_camel

from coopera.core.errors import ConfigError
from coopera.core.foreign.files import load_json, read_limited
from coopera.core.foreign.pictures import open_picture
from coopera.simulation.homes.untrusted import Loose

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Item = TypeVar("Item")

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_MOST_OF = {number: float(np.iinfo(kind).max) for number, kind in _TYPES.items() if kind != "<f4"}
_TRIANGLES = 4
_UNKNOWN: Array = np.full(3, np.nan)
FARTHEST = 1e6  # metres from the origin
_GAMMA = 1 / 2.2
"""Factors are light, colours on a screen are not."""
MOST_PARTS = 10_000
"""No more parts (a primitive at a node) are shown by a file."""
MOST_CORNERS = 2_000_000
"""No more corners, and no more triangles, have all that a file shows; a mesh counts at each node that shows it."""
_MOST = 100_000  # entries of each list of the file's description
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_Index = Annotated[int, Field(ge=0, lt=2**40)]
_Some: TypeAlias = Annotated[list[Item], Field(max_length=_MOST)]
_Three = tuple[float, float, float]


class Mesh(NamedTuple):
    """Corners of shape (n, 3), and triangles as rows of three of their numbers, shape (m, 3), each with a colour.

    Colours are channels in [0, 1], shape (m, 3); NaN where the file tells none that we can read.
    """

    corners: Array
    triangles: Indices
    colours: Array


class _Gltf(Loose):
    model_config = ConfigDict(alias_generator=to_camel)


class _Accessor(_Gltf):
    buffer_view: _Index | None = None
    byte_offset: _Index = 0
    component_type: int
    normalized: bool = False
    count: _Index
    min: list[float] | None = None
    max: list[float] | None = None
    sparse: Any = None


class _View(_Gltf):
    buffer: _Index
    byte_offset: _Index = 0
    byte_length: _Index
    byte_stride: Annotated[int, Field(ge=4, le=252)] | None = None


class _Primitive(_Gltf):
    attributes: dict[str, _Index]
    indices: _Index | None = None
    material: _Index | None = None
    mode: int = _TRIANGLES
    extensions: dict[str, Any] = {}


class _Picture(_Gltf):
    index: _Index


class _Metallic(_Gltf):
    base_color_factor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    base_color_texture: _Picture | None = None


class _Material(_Gltf):
    pbr_metallic_roughness: _Metallic | None = None


class _Texture(_Gltf):
    source: _Index | None = None


class _Image(_Gltf):
    buffer_view: _Index | None = None


class _Mesh(_Gltf):
    primitives: _Some[_Primitive] = []


class _Node(_Gltf):
    children: _Some[_Index] = []
    mesh: _Index | None = None
    matrix: Annotated[list[float], Field(min_length=16, max_length=16)] | None = None
    translation: _Three = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    scale: _Three = (1.0, 1.0, 1.0)

    @property
    def transform(self) -> Array:
        """The node's own transform, shape (4, 4)."""
        if self.matrix is not None:
            return np.array(self.matrix).reshape(4, 4).T
        whole = np.eye(4)
        x, y, z, w = self.rotation
        whole[:3, :3] = rotation_matrix((w, x, y, z)) * np.array(self.scale)
        whole[:3, 3] = self.translation
        return whole


class _Scene(_Gltf):
    nodes: _Some[_Index] = []


class _Document(_Gltf):
    scene: _Index = 0
    scenes: _Some[_Scene] = []
    nodes: _Some[_Node] = []
    meshes: _Some[_Mesh] = []
    materials: _Some[_Material] = []
    textures: _Some[_Texture] = []
    images: _Some[_Image] = []
    accessors: _Some[_Accessor] = []
    buffer_views: _Some[_View] = []
    buffers: _Some[dict[str, Any]] = []


def rotation_matrix(wxyz: tuple[float, float, float, float]) -> Array:
    """Turn a quaternion into a rotation, shape (3, 3); not finite where its length is 0 or beyond all numbers."""
    length = math.hypot(*wxyz)
    w, x, y, z = np.array(wxyz) / length if length else np.full(4, np.nan)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def read_glb(path: Path) -> Mesh:
    """Read all triangles of a file's scene, each node moved to its place.

    Raises:
        ConfigError: If the file cannot be read or is no such file; names it and the field.
    """
    return _Reader(path).mesh()


def _mean(data: bytes) -> Array:
    try:
        with open_picture(data) as one:
            pixels: Array = np.asarray(one.convert("RGB").resize((8, 8)), dtype=np.float64)
    except ValueError:
        return _UNKNOWN
    return np.asarray(pixels.mean(axis=(0, 1)) / 255)


class _Reader:
    """One file being read."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._means: dict[int, Array] = {}
        text, self._binary = self._chunks()
        try:
            self._document = _Document.model_validate(load_json(text))
        except ValidationError as err:
            first = err.errors(include_url=False)[0]
            self._refuse(".".join(map(str, first["loc"])) or "JSON", first["msg"])
        except ValueError as err:
            self._refuse("JSON", f"is not valid: {err}")

    def mesh(self) -> Mesh:
        """Walk the tree of nodes and gather what they show."""
        document = self._document
        children = {child for node in document.nodes for child in node.children}
        roots = [number for number in range(len(document.nodes)) if number not in children]
        if document.scenes:
            roots = self._at(document.scenes, document.scene, "scene").nodes
        corners: list[Array] = []
        triangles: list[Indices] = []
        colours: list[Array] = []
        seen: set[int] = set()
        waiting = [(number, np.eye(4), "scenes") for number in reversed(roots)]
        count = shown = 0
        while waiting:
            number, above, field = waiting.pop()
            node = self._at(document.nodes, number, field)
            if number in seen:
                self._refuse(field, f"node {number} stands twice in the tree, as in a circle")
            seen.add(number)
            here = above @ node.transform
            waiting += [(child, here, f"nodes.{number}.children") for child in reversed(node.children)]
            if node.mesh is None:
                continue
            for n, primitive in enumerate(self._at(document.meshes, node.mesh, f"nodes.{number}.mesh").primitives):
                points, faces = self._primitive(primitive, f"meshes.{node.mesh}.primitives.{n}")
                shown += len(faces)
                if len(corners) >= MOST_PARTS or count + len(points) > MOST_CORNERS or shown > MOST_CORNERS:
                    self._refuse(f"nodes.{number}", f"the file shows more than {MOST_CORNERS} corners or triangles")
                corners.append(self._moved(points, here, f"nodes.{number}"))
                triangles.append(faces + count)
                colours.append(np.tile(self._colour(primitive.material), (len(faces), 1)))
                count += len(points)
        if not count:
            self._refuse("meshes", "shows nothing: there is no mesh with a POSITION in its scene")
        return Mesh(np.concatenate(corners), np.concatenate(triangles), np.concatenate(colours))

    def _moved(self, points: Array, here: Array, field: str) -> Array:
        with np.errstate(all="ignore"):
            moved: Array = points @ here[:3, :3].T + here[:3, 3]
        if not (np.abs(moved) < FARTHEST).all():
            self._refuse(field, "moves its mesh out of all bounds")
        return moved

    def _chunks(self) -> tuple[bytes, bytes]:
        data = read_limited(self._path)
        if len(data) < 20 or data[:4] != b"glTF":
            self._refuse("header", "must be that of a binary glTF file")
        version, length = struct.unpack_from("<II", data, 4)
        size, kind = struct.unpack_from("<II", data, 12)
        if version != 2 or length > len(data) or kind != _JSON or 20 + size > len(data):
            self._refuse("header", f"must be that of a whole glTF 2 file of {len(data)} bytes")
        after = 20 + size
        if after + 8 > len(data):
            return data[20:after], b""
        more, kind = struct.unpack_from("<II", data, after)
        return data[20:after], data[after + 8 : after + 8 + more] if kind == _BIN else b""

    def _primitive(self, primitive: _Primitive, field: str) -> tuple[Array, Indices]:
        nothing = np.zeros((0, 3), dtype=np.int64)
        if "POSITION" not in primitive.attributes:
            return np.zeros((0, 3)), nothing
        number = primitive.attributes["POSITION"]
        field = f"{field}.attributes.POSITION"
        accessor = self._at(self._document.accessors, number, field)
        if accessor.buffer_view is None or accessor.sparse is not None:
            return self._corners_of_box(accessor, f"accessors.{number}"), nothing
        points = self._values(accessor, 3, f"accessors.{number}").astype(np.float64)
        if accessor.normalized and accessor.component_type in _MOST_OF:  # KHR_mesh_quantization
            points = np.maximum(points / _MOST_OF[accessor.component_type], -1.0)
        if not np.isfinite(points).all():
            self._refuse(f"accessors.{number}", "holds a number that is not finite")
        if primitive.indices is None:
            faces: NDArray[Any] = np.arange(len(points))
        else:
            indices = self._at(self._document.accessors, primitive.indices, field)
            if indices.buffer_view is None:
                return points, nothing
            faces = self._values(indices, 1, f"accessors.{primitive.indices}").ravel()
        if primitive.mode != _TRIANGLES:
            return points, nothing
        faces = faces[: len(faces) // 3 * 3].reshape(-1, 3).astype(np.int64)
        if faces.size and int(faces.max()) >= len(points):
            self._refuse(f"accessors.{primitive.indices}", f"names a corner beyond the last, {len(points) - 1}")
        return points, faces

    def _colour(self, number: int | None) -> Array:
        """What a material looks like in one colour."""
        if number is None:
            return _UNKNOWN
        metallic = self._at(self._document.materials, number, "materials").pbr_metallic_roughness or _Metallic()
        factor = np.clip(metallic.base_color_factor[:3], 0.0, 1.0) ** _GAMMA
        if metallic.base_color_texture is None:
            return np.asarray(factor)
        return np.asarray(factor * self._mean(metallic.base_color_texture.index, f"materials.{number}"))

    def _mean(self, number: int, field: str) -> Array:
        """The mean of a texture's picture; unknown where it is of a kind that we do not read, such as KTX2."""
        source = self._at(self._document.textures, number, f"{field}.baseColorTexture.index").source
        if source is None:
            return _UNKNOWN
        image = self._at(self._document.images, source, f"textures.{number}.source")
        if image.buffer_view is None:
            return _UNKNOWN
        view = self._at(self._document.buffer_views, image.buffer_view, f"images.{source}.bufferView")
        if source not in self._means:
            self._means[source] = _mean(self._binary[view.byte_offset :][: view.byte_length])
        return self._means[source]

    def _corners_of_box(self, accessor: _Accessor, field: str) -> Array:
        if accessor.min is None or accessor.max is None or len(accessor.min) != 3 or len(accessor.max) != 3:
            self._refuse(field, "must give min and max, three numbers each")
        ends = np.array([accessor.min, accessor.max])
        if accessor.normalized and accessor.component_type in _MOST_OF:
            ends = ends / _MOST_OF[accessor.component_type]
        grid = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1)
        return np.asarray(grid.reshape(-1, 3))

    def _values(self, accessor: _Accessor, width: int, field: str) -> NDArray[Any]:
        view = self._at(self._document.buffer_views, accessor.buffer_view or 0, f"{field}.bufferView")
        buffer = self._at(self._document.buffers, view.buffer, f"bufferViews.{accessor.buffer_view}.buffer")
        if accessor.component_type not in _TYPES:
            self._refuse(f"{field}.componentType", f"must be one of {', '.join(map(str, _TYPES))}")
        kind = np.dtype(_TYPES[accessor.component_type])
        stride = view.byte_stride or width * kind.itemsize
        start = view.byte_offset + accessor.byte_offset
        end = start + max(accessor.count - 1, 0) * stride + width * kind.itemsize
        if "uri" in buffer or view.buffer or (accessor.count and end > len(self._binary)):
            self._refuse(field, "must lie within the data of the file itself")
        if not accessor.count:
            return np.zeros((0, width), kind)
        return np.ndarray((accessor.count, width), kind, self._binary, start, (stride, kind.itemsize))

    def _at(self, items: list[Item], number: int, field: str) -> Item:
        if number >= len(items):
            self._refuse(field, f"names number {number}, and there are only {len(items)}")
        return items[number]

    def _refuse(self, field: str, why: str) -> NoReturn:
        raise ConfigError(f"{self._path}, field {field}: {why}.")
