"""Hugging Face models in this process: text models, and models that look at pictures, as one LangChain chat model.

Sampling draws its noise from a generator of the call's own seed (the Gumbel-max trick: the highest of logits divided by
temperature plus Gumbel noise is a draw from the softmax), so no global random state is read or changed.
"""

from __future__ import annotations

import base64
import functools
import io
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import torch
from jinja2 import TemplateError
from langchain_core.callbacks import CallbackManagerForLLMRun
from langchain_core.language_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.messages.ai import UsageMetadata
from langchain_core.outputs import ChatGeneration, ChatResult
from PIL import Image
from pydantic import PrivateAttr
from transformers import (
    AutoConfig,
    AutoModelForCausalLM,
    AutoModelForImageTextToText,
    AutoProcessor,
    AutoTokenizer,
    LogitsProcessor,
    LogitsProcessorList,
)
from typing_extensions import override

from core.errors import ConfigError, ModelCallError

NEW_TOKENS = 2048  # most tokens of one reply
_ROLES = {"human": "user", "ai": "assistant", "system": "system"}


@dataclass(frozen=True, slots=True)
class _Loaded:
    """Weights, and what turns messages into their input: a tokenizer, or a processor where the model sees."""

    model: Any
    front: Any
    sees: bool
    lock: threading.Lock

    @property
    def tokenizer(self) -> Any:
        return getattr(self.front, "tokenizer", self.front)

    @property
    def room(self) -> int:
        """The most tokens that prompt and reply may have together."""
        config = self.model.config.get_text_config()
        return int(getattr(config, "max_position_embeddings", None) or 1_000_000)


class HuggingFaceChat(BaseChatModel):
    """A chat model in this process; `invoke` takes `temperature` (0 takes the likeliest) and `seed`."""

    path: str
    new_tokens: int = NEW_TOKENS
    _loaded: _Loaded = PrivateAttr()

    def __init__(self, loaded: _Loaded, **fields: Any) -> None:
        """Wrap loaded weights."""
        super().__init__(**fields)
        self._loaded = loaded

    @property
    def sees(self) -> bool:
        """Whether the model looks at pictures."""
        return self._loaded.sees

    @property
    @override
    def _llm_type(self) -> str:
        return "coopera-huggingface"

    @override
    def _generate(
        self,
        messages: list[BaseMessage],
        stop: list[str] | None = None,
        run_manager: CallbackManagerForLLMRun | None = None,
        **kwargs: Any,
    ) -> ChatResult:
        """Answer the messages.

        Raises:
            ModelCallError: If the messages do not fit, or the model fails on them.
        """
        temperature, seed = float(kwargs.get("temperature", 0.0)), int(kwargs.get("seed", 0))
        try:
            with self._loaded.lock, torch.inference_mode():
                reply, tokens_in = self._reply(messages, temperature, seed)
        except (RuntimeError, ValueError, LookupError, TypeError, OSError, TemplateError) as err:
            raise ModelCallError(f"{self.path}: the model failed on the prompt: {' '.join(str(err).split())}") from err
        ids = reply.tolist()
        ended = bool(ids) and ids[-1] in _ends(self._loaded)
        text = self._loaded.tokenizer.decode(ids, skip_special_tokens=True)
        usage = UsageMetadata(input_tokens=tokens_in, output_tokens=len(ids), total_tokens=tokens_in + len(ids))
        told = {"finish_reason": "stop" if ended else "length", "model_name": self.path}
        message = AIMessage(content=text, usage_metadata=usage, response_metadata=told)
        return ChatResult(generations=[ChatGeneration(message=message)])

    def _reply(self, messages: Sequence[BaseMessage], temperature: float, seed: int) -> tuple[torch.Tensor, int]:
        """Return the ids of the new tokens, shape (T,), and how many tokens the prompt has."""
        loaded = self._loaded
        chat = [_turn(message, loaded.sees) for message in messages]
        given = loaded.front.apply_chat_template(
            chat, add_generation_prompt=True, tokenize=True, return_dict=True, return_tensors="pt"
        ).to(loaded.model.device)
        length = int(given["input_ids"].shape[1])
        if length >= loaded.room:
            raise ModelCallError(f"{self.path}: a prompt of {length} tokens does not fit into its {loaded.room}")
        draw = LogitsProcessorList([GumbelDraw(temperature, seed)] if temperature > 0 else [])
        out = loaded.model.generate(
            **given,
            max_new_tokens=min(self.new_tokens, loaded.room - length),
            do_sample=False,
            num_beams=1,
            logits_processor=draw,
            pad_token_id=_pad(loaded),
        )
        return out[0, length:].cpu(), length


class GumbelDraw(LogitsProcessor):
    """Turns taking the highest logit into a seeded draw at a temperature; good for one sequence at a time."""

    def __init__(self, temperature: float, seed: int) -> None:
        """Start the noise anew from a seed; the temperature must be above 0."""
        self._temperature = temperature
        self._noise = torch.Generator().manual_seed(seed)

    def __call__(self, input_ids: torch.Tensor, scores: torch.Tensor) -> torch.Tensor:
        """Return the noisy scores, shape (B, V); noise is drawn on the CPU, so that devices agree."""
        uniform = torch.rand(scores.shape, generator=self._noise, dtype=torch.float64).clamp_min(1e-300)
        gumbel = -torch.log(-torch.log(uniform))
        return scores.to(torch.float64) / self._temperature + gumbel.to(scores.device)


@functools.lru_cache(maxsize=4)
def open_model(path: str) -> HuggingFaceChat:
    """Load a repository or folder once, for all roles that ask for it.

    Weights come from safetensors files only, and code that a repository brings along is never run.

    Raises:
        ConfigError: If it cannot be loaded, or is no chat model.
    """
    safe: dict[str, Any] = {"trust_remote_code": False}
    try:
        config = AutoConfig.from_pretrained(path, **safe)
        sees = hasattr(config, "vision_config")
        front = (AutoProcessor if sees else AutoTokenizer).from_pretrained(path, **safe)
        kind = AutoModelForImageTextToText if sees else AutoModelForCausalLM
        dtype = "auto" if torch.cuda.is_available() else torch.float32
        model: Any = kind.from_pretrained(path, dtype=dtype, use_safetensors=True, **safe)
    except (OSError, ValueError, KeyError, ImportError, RuntimeError) as err:
        reason = " ".join(str(err).split())
        raise ConfigError(f"the model huggingface:{path} cannot be loaded: {reason}") from err
    if not front.chat_template:
        raise ConfigError(f"huggingface:{path} is no chat model: it has no chat template")
    model.to("cuda" if torch.cuda.is_available() else "cpu").eval()
    return HuggingFaceChat(_Loaded(model, front, sees, threading.Lock()), path=path)


def _turn(message: BaseMessage, sees: bool) -> dict[str, Any]:
    """One message as chat templates take it."""
    role = _ROLES.get(message.type, "user")
    if not sees:
        return {"role": role, "content": message.text}
    parts: list[dict[str, Any]] = []
    for block in message.content_blocks:
        if block["type"] == "image":
            picture = Image.open(io.BytesIO(base64.b64decode(block["base64"]))).convert("RGB")
            parts.append({"type": "image", "image": picture})
        elif block["type"] == "text":
            parts.append({"type": "text", "text": block["text"]})
    return {"role": role, "content": parts}


def _ends(loaded: _Loaded) -> set[int]:
    """Ids of the tokens that end a reply."""
    ends = loaded.model.generation_config.eos_token_id
    return set(ends) if isinstance(ends, list) else {ends}


def _pad(loaded: _Loaded) -> int:
    """Any valid id: with one sequence nothing is padded, but `generate` asks for it."""
    for known in (loaded.tokenizer.pad_token_id, *sorted(i for i in _ends(loaded) if i is not None)):
        if known is not None:
            return int(known)
    return 0
