"""Text embeddings that never change: each text is encoded alone, once, and remembered by its content."""

from __future__ import annotations

import hashlib
import logging
import sqlite3
import threading
from collections.abc import Callable, Sequence
from itertools import islice
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from langchain_core.embeddings import Embeddings
from typing_extensions import override

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory import minilm
from coopera.memory.minilm import Vector

_LOG = logging.getLogger(__name__)
_HUGGING_FACE = "Hugging Face "
_IN_RAM = 65_536  # vectors kept in RAM where there is no file; 100 MB of MiniLM's
_BEFORE_DISK = 1024  # those in RAM where a file holds all; 1.5 MB of MiniLM's
_PAGE = 8192  # bytes of a file's page: in SQLite's usual half of it a vector of MiniLM's would not fit
_UNIT_ERROR = 1e-6  # how far float32 norms of unit vectors are from 1
_PATIENCE = 60.0  # seconds that a process waits for another one's write

Encode = Callable[[str], Vector]


class CachedEmbeddings(Embeddings):
    """A LangChain `Embeddings` with a cache in RAM and, if a path is given, in SQLite.

    Used in a `with` statement, or closed, it lets go of the file; the next text that is not in RAM opens it again.
    Two processes may share the file. The key is the SHA-256 of the model's identity and the text. Texts are encoded
    one by one, so the bits of an embedding depend on its text alone.

    Attributes:
        model_id: Identity of the model; part of each key, and noted in every store that uses the model.
        dimension: Numbers per vector, where it is known beforehand.
        misses: How many texts had to be encoded so far.
    """

    def __init__(self, encode: Encode, model_id: str, cache: Path | None = None, dimension: int | None = None) -> None:
        """Wrap an encoder.

        Args:
            encode: Maps a text to a float32 vector of unit norm, shape (d,).
            model_id: Must differ between encoders that give different vectors.
            cache: SQLite file to use or create; None keeps the cache in RAM.
            dimension: Numbers per vector, if known without encoding.
        """
        self.model_id = model_id
        self.dimension = dimension
        self.misses = 0
        self._encode = encode
        self._ram: dict[str, Vector] = {}
        self._lock, self._encoding = threading.RLock(), threading.Lock()
        self._disk = _Disk(cache, model_id) if cache is not None else None

    @override
    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        """Return one vector per text; the floats are exactly the float32 values."""
        return [vector.tolist() for vector in self._vectors(texts)]

    @override
    def embed_query(self, text: str) -> list[float]:
        """Return the text's vector; a query is encoded as a document is."""
        values: list[float] = self._vectors([text])[0].tolist()
        return values

    def array(self, texts: Sequence[str]) -> Vector:
        """Return the vectors of n texts as an array, shape (n, d), float32."""
        vectors = self._vectors(texts)
        return np.stack(vectors) if vectors else np.zeros((0, 0), np.float32)

    def close(self) -> None:
        """Close the cache file until it is needed again; closing twice does no harm."""
        with self._lock:
            if self._disk is not None:
                self._disk.close()

    def __enter__(self) -> Self:
        """Return the embeddings themselves."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the cache file."""
        self.close()

    def _vectors(self, texts: Sequence[str]) -> list[Vector]:
        """Return each text's vector, in order, from RAM, from disk, or by encoding it.

        What is there is not held up by what another thread is encoding.
        """
        asked = list(dict.fromkeys(map(_checked, texts)))
        with self._lock:
            found = self._there(asked)
        for text in asked:
            if text not in found:
                with self._encoding:
                    with self._lock:
                        made = self._ram.get(text)
                    found[text] = self._made(text) if made is None else made
        return [found[text] for text in texts]

    def _there(self, texts: Sequence[str]) -> dict[str, Vector]:
        """Return the vectors that are in RAM or on disk; those asked for last are the last to leave RAM."""
        found = {text: vector for text in texts if (vector := self._ram.pop(text, None)) is not None}
        self._ram |= found
        if self._disk is not None and (missing := [text for text in texts if text not in found]):
            found |= (read := self._disk.read(missing))
            self._remember(read)
        return found

    def _made(self, text: str) -> Vector:
        """Encode a text, and remember its vector."""
        vector = self._encode(text)
        if vector.dtype != np.float32 or vector.ndim != 1 or not np.isfinite(vector).all():
            raise MemoryStoreError(f"{self.model_id}: the encoder gave no finite float32 vector for {text[:60]!r}")
        vector.setflags(write=False)
        with self._lock:
            self.misses += 1
            self._remember({text: vector})
            if self._disk is not None:
                self._disk.write(text, vector)
        return vector

    def _remember(self, found: dict[str, Vector]) -> None:
        """Keep vectors in RAM; where that is full, the oldest go."""
        self._ram.update(found)
        most = _IN_RAM if self._disk is None else _BEFORE_DISK
        for text in list(islice(self._ram, max(0, len(self._ram) - most))):
            del self._ram[text]


class _Disk:
    """The SQLite file behind the cache. Calls come under the owner's lock."""

    def __init__(self, path: Path, model_id: str) -> None:
        self._path = path
        self._salt = hashlib.sha256(model_id.encode() + b"\0")
        self._opened: sqlite3.Connection | None = None
        try:
            self._db()
        except (OSError, sqlite3.Error) as err:
            raise self._broken(err) from err

    def read(self, texts: Sequence[str]) -> dict[str, Vector]:
        """Return the vectors that are there, by text.

        They are asked for one by one: sqlite3 keeps a compiled statement for each number of keys in one question. The
        file is locked once for all, which saves a third.
        """
        found: dict[str, Vector] = {}
        try:
            with self._db() as db:
                db.execute("BEGIN")
                for text in texts:
                    row = db.execute("SELECT vector FROM vectors WHERE key = ?", (self._key(text),)).fetchone()
                    if row is not None:
                        found[text] = np.frombuffer(row[0], "<f4")
        except (OSError, sqlite3.Error, ValueError) as err:
            raise self._broken(err) from err
        return found

    def write(self, text: str, vector: Vector) -> None:
        """Add a vector; one that another process added in the meantime stays."""
        blob = vector.astype("<f4").tobytes()
        try:
            self._db().execute("INSERT OR IGNORE INTO vectors VALUES (?, ?)", (self._key(text), blob))
        except (OSError, sqlite3.Error) as err:
            raise self._broken(err) from err

    def close(self) -> None:
        if self._opened is not None:
            self._opened.close()
            self._opened = None

    def _db(self) -> sqlite3.Connection:
        """Return the open file, opened now if need be."""
        if self._opened is None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            made = sqlite3.connect(self._path, timeout=_PATIENCE, isolation_level=None, check_same_thread=False)
            try:
                made.execute(f"PRAGMA page_size={_PAGE}")  # of a new file
                made.execute("PRAGMA journal_mode=WAL")
                made.execute("PRAGMA synchronous=NORMAL")
                made.execute("CREATE TABLE IF NOT EXISTS vectors(key BLOB PRIMARY KEY, vector BLOB) WITHOUT ROWID")
            except sqlite3.Error:
                made.close()
                raise
            self._opened = made
        return self._opened

    def _key(self, text: str) -> bytes:
        digest = self._salt.copy()
        digest.update(text.encode())
        return digest.digest()

    def _broken(self, err: Exception) -> MemoryStoreError:
        return MemoryStoreError(
            f"{self._path}: cannot be used as a cache of embeddings ({err}); it may be deleted, it is rebuilt as needed"
        )


def _checked(text: str) -> str:
    """Refuse a text that no tokeniser and no database could take."""
    try:
        text.encode()
    except UnicodeEncodeError as err:
        raise ConfigError(f"a text to embed is not valid Unicode: {text[:60]!r}") from err
    return text


def bundled(cache: Path | None = None) -> CachedEmbeddings:
    """Return the embeddings of the installed all-MiniLM-L6-v2, 384 numbers per text; nothing is downloaded.

    The model loads with the first text that is in no cache, and is shared by all that this function returns.

    Args:
        cache: SQLite file that keeps the vectors, created if need be; None keeps them in RAM.

    Raises:
        MemoryStoreError: If the cache file cannot be used.
    """
    return CachedEmbeddings(lambda text: minilm.shared().encode(text), minilm.model_id(), cache, minilm.DIMENSION)


def hugging_face(model: str, cache: Path | None = None) -> CachedEmbeddings:
    """Return the embeddings of any sentence-transformers or Hugging Face encoder, by name or folder.

    A name is looked up among the downloaded models, and downloaded at the first text if it is not there.

    Args:
        model: Such as "BAAI/bge-small-en-v1.5", or a folder.
        cache: As for `bundled`.

    Raises:
        MemoryStoreError: At the first text, if the model cannot be loaded.
    """
    return CachedEmbeddings(_HuggingFace(model), _HUGGING_FACE + model, cache)


def by_identity(model_id: str, cache: Path | None = None) -> CachedEmbeddings:
    """Return the embeddings that a stream was written with.

    Raises:
        MemoryStoreError: If they are of the caller's own making.
    """
    if model_id.startswith(_HUGGING_FACE):
        return hugging_face(model_id.removeprefix(_HUGGING_FACE), cache)
    if model_id == minilm.model_id():
        return bundled(cache)
    raise MemoryStoreError(f"the embeddings {model_id!r} are not known by their name; they must be given")


class _HuggingFace:
    """An encoder that loads with its first text."""

    def __init__(self, model: str) -> None:
        self._name = model
        self._model: Embeddings | None = None

    def __call__(self, text: str) -> Vector:
        if self._model is None:
            import torch  # noqa: PLC0415 - heavy
            from langchain_huggingface import HuggingFaceEmbeddings  # noqa: PLC0415

            torch.set_num_threads(1)
            try:
                self._model = HuggingFaceEmbeddings(
                    model_name=self._name,
                    model_kwargs={"device": "cpu"},
                    encode_kwargs={"normalize_embeddings": True},
                )
            except (OSError, ValueError) as err:
                raise MemoryStoreError(f"the embedding model {self._name!r} cannot be loaded: {err}") from err
        return np.asarray(self._model.embed_query(text), np.float32)


def as_array(embeddings: Embeddings, texts: Sequence[str]) -> Vector:
    """Return the vectors of n texts as an array, shape (n, d), float32, from any LangChain embeddings."""
    if isinstance(embeddings, CachedEmbeddings):
        return embeddings.array(texts)
    if not texts:
        return np.zeros((0, 0), np.float32)
    return np.asarray(embeddings.embed_documents(list(texts)), np.float32)


def identity(embeddings: Embeddings) -> str:
    """Return what tells one embedding model from another: `model_id`, or else the class and the model's name."""
    known = getattr(embeddings, "model_id", None)
    if isinstance(known, str):
        return known
    name = getattr(embeddings, "model_name", None) or getattr(embeddings, "model", None)
    kind = type(embeddings).__qualname__
    return f"{kind} {name}" if isinstance(name, str) else kind


def unit(vectors: Vector, texts: Sequence[str]) -> Vector:
    """Scale vectors to unit norm, leaving alone those that have it.

    Args:
        vectors: Shape (n, d).
        texts: What they stand for, for messages.

    Raises:
        MemoryStoreError: If a vector is not finite, or zero.
    """
    norms = np.sqrt(np.square(vectors, dtype=np.float64).sum(1))
    for text, norm in zip(texts, norms, strict=True):
        if not np.isfinite(norm) or norm == 0:
            raise MemoryStoreError(f"the embeddings gave a vector of norm {norm} for the text {text[:60]!r}")
    scaled = (vectors / norms[:, None]).astype(np.float32)
    return np.where((np.abs(norms - 1) <= _UNIT_ERROR)[:, None], vectors, scaled)
