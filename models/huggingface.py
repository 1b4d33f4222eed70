"""Hugging Face models in this process: text models, and models that look at pictures, as one LangChain chat model.

Weights are loaded once, prompts that arrive together are answered together, and a reply is held to its JSON schema
while it is decoded (`coopera.models.constrained`). Sampling draws from a generator of the call's own seed, so no global
random state is read or changed.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
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
    LogitsProcessorList,
)
from typing_extensions import override

from coopera.core.errors import ConfigError, ModelCallError
from coopera.core.lazy import made_once
from coopera.models.batching import Batcher
from coopera.models.constrained import Drawing, Grammars, HeldReply
from coopera.models.settings import CallSettings
from coopera.models.small.manner import PLAIN, Manner

_GPU_BATCH = 16
_ROLES = {"human": "user", "ai": "assistant", "system": "system"}
_AS_TENSORS: dict[str, Any] = {"return_tensors": "pt", "padding": True}
_FAILURES = (RuntimeError, ValueError, LookupError, TypeError, OSError, TemplateError)


@dataclass(frozen=True, slots=True)
class _Loaded:
    """Weights, and what turns messages into their input: a tokenizer, or a processor where the model sees."""

    path: str
    model: Any
    front: Any
    sees: bool
    ends: list[int]
    grammars: Grammars | None
    weights: str

    @property
    def tokenizer(self) -> Any:
        return getattr(self.front, "tokenizer", self.front)

    @property
    def room(self) -> int:
        """The most tokens that prompt and reply may have together."""
        config = self.model.config.get_text_config()
        return int(getattr(config, "max_position_embeddings", None) or 1_000_000)


@dataclass(frozen=True, slots=True)
class _Question:
    """One prompt, as a chat template takes it, and how its reply is to be drawn."""

    chat: list[dict[str, Any]]
    pictures: int
    temperature: float
    seed: int
    max_tokens: int
    schema: Mapping[str, Any] | None
    manner: Manner


class HuggingFaceChat(BaseChatModel):
    """A chat model in this process.

    `invoke` takes `temperature` (0 takes the likeliest), `seed`, `max_tokens`, the `schema` that the reply must
    fit, and the `manner` in which free text is drawn. A reply that had to be closed or cut at the length limit has
    the finish reason "length".
    """

    path: str
    _loaded: _Loaded = PrivateAttr()
    _answer: Batcher[_Question, AIMessage] = PrivateAttr()

    def __init__(self, loaded: _Loaded, batch: int = 1) -> None:
        """Wrap loaded weights."""
        super().__init__(path=loaded.path)
        self._loaded = loaded
        self._answer = Batcher(self._answer_all, size=batch, kind=lambda question: question.pictures)

    @property
    def sees(self) -> bool:
        """Whether the model looks at pictures."""
        return self._loaded.sees

    @property
    def weights(self) -> str:
        """What tells these weights from others of the same name: a commit, or the files' sizes and times."""
        return self._loaded.weights

    @property
    def constrains(self) -> bool:
        """Whether replies can be held to a schema; only slow tokenizers stand in the way."""
        return self._loaded.grammars is not None

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
        """Answer the messages, together with those of other threads that wait.

        Raises:
            ModelCallError: If the messages do not fit, or the model fails on them.
        """
        chat = [_turn(message, self.sees) for message in messages]
        question = _Question(
            chat,
            pictures=sum(part["type"] == "image" for turn in chat if self.sees for part in turn["content"]),
            temperature=float(kwargs.get("temperature", 0.0)),
            seed=int(kwargs.get("seed", 0)),
            max_tokens=int(kwargs.get("max_tokens", CallSettings().max_tokens)),
            schema=kwargs.get("schema"),
            manner=kwargs.get("manner", PLAIN),
        )
        return ChatResult(generations=[ChatGeneration(message=self._answer(question))])

    def _answer_all(self, questions: Sequence[_Question]) -> list[AIMessage | Exception]:
        """Answer questions together; if this fails, one by one, so a bad question spoils only its own answer."""
        try:
            with torch.inference_mode():
                return list(self._generate_together(questions))
        except _FAILURES as err:
            if len(questions) == 1:
                what = " ".join(str(err).split())
                return [ModelCallError(f"{self.path}: the model failed on the prompt: {what}")]
        except ModelCallError as err:
            if len(questions) == 1:
                return [err]
        return [answer for question in questions for answer in self._answer_all([question])]

    def _generate_together(self, questions: Sequence[_Question]) -> list[AIMessage]:
        loaded = self._loaded
        given = loaded.front.apply_chat_template(
            [question.chat for question in questions],
            add_generation_prompt=True,
            tokenize=True,
            return_dict=True,
            **({"processor_kwargs": _AS_TENSORS} if self.sees else _AS_TENSORS),
        ).to(loaded.model.device)
        lengths = [int(length) for length in given["attention_mask"].sum(dim=1)]
        rows = [self._row(question, length) for question, length in zip(questions, lengths, strict=True)]
        if len(rows) == 1 and not self.sees:
            new = _grow(loaded.model, given["input_ids"], rows[0])
            return [self._message(new, rows[0], lengths[0])]
        out = loaded.model.generate(
            **given,
            max_new_tokens=max(row.limit for row in rows),
            do_sample=False,
            num_beams=1,
            logits_processor=LogitsProcessorList([Drawing(rows)]),
            eos_token_id=loaded.ends,
            pad_token_id=_pad(loaded),
        )
        new = out[:, given["input_ids"].shape[1] :].tolist()
        return [self._message(*entry) for entry in zip(new, rows, lengths, strict=True)]

    def _row(self, question: _Question, length: int) -> HeldReply:
        loaded = self._loaded
        if length >= loaded.room:
            raise ModelCallError(f"{self.path}: a prompt of {length} tokens does not fit into its {loaded.room}")
        room = loaded.room - length
        limit = min(question.max_tokens, room)
        row = HeldReply(
            temperature=question.temperature, seed=question.seed, limit=limit, ends=loaded.ends, manner=question.manner
        )
        if question.schema is not None and loaded.grammars is not None:
            row.hold_to(loaded.grammars, question.schema, room)
        return row

    def _message(self, new: list[int], row: HeldReply, tokens_in: int) -> AIMessage:
        end = next((n for n, token in enumerate(new) if token in self._loaded.ends), None)
        ids = new[: len(new) if end is None else end]
        text = self._loaded.tokenizer.decode(ids, skip_special_tokens=True, clean_up_tokenization_spaces=False)
        tokens_out = min(len(ids) + 1, row.limit)
        cut = row.closed or len(ids) >= row.limit
        return AIMessage(
            content=text,
            usage_metadata=UsageMetadata(
                input_tokens=tokens_in, output_tokens=tokens_out, total_tokens=tokens_in + tokens_out
            ),
            response_metadata={"finish_reason": "length" if cut else "stop", "model_name": self.path},
        )


def _grow(model: Any, prompt: torch.Tensor, row: HeldReply) -> list[int]:
    """Draw one reply to a prompt of shape (1, T); tokens that must come are read in one go with the next pass."""
    new: list[int] = []
    given, past = prompt, None
    while True:
        if ahead := row.forced():
            new += ahead
            given = torch.cat([given, torch.tensor([ahead], device=given.device)], dim=1)
        if row.done:
            return new
        out = model(input_ids=given, past_key_values=past, use_cache=True, logits_to_keep=1)
        past = out.past_key_values
        token = row.draw(out.logits[0, -1].float())
        new.append(token)
        given = torch.tensor([[token]], device=given.device)


def open_model(path: str, settings: CallSettings | None = None) -> HuggingFaceChat:
    """Load a repository or folder once, for all roles and studies that ask for it.

    Weights come from safetensors files only, and code that a repository brings along is never run.

    Raises:
        ConfigError: If it cannot be loaded, or is no chat model.
    """
    chosen = settings or CallSettings()
    return _open(path, chosen.device, chosen.dtype, chosen.batch)


@made_once(4)
def _open(path: str, device: str, dtype: str, batch: int | None) -> HuggingFaceChat:
    safe: dict[str, Any] = {"trust_remote_code": False}
    place = _place(path, device)
    number = ("auto" if place.type == "cuda" else torch.float32) if dtype == "auto" else getattr(torch, dtype)
    if Path(path).is_absolute() and not Path(path).is_dir():
        raise ConfigError(f"the model huggingface:{path} cannot be loaded: there is no such folder")
    try:
        config = AutoConfig.from_pretrained(path, **safe)
        sees = hasattr(config, "vision_config")
        front = (AutoProcessor if sees else AutoTokenizer).from_pretrained(path, **safe)
        kind = AutoModelForImageTextToText if sees else AutoModelForCausalLM
        model: Any = kind.from_pretrained(path, dtype=number, use_safetensors=True, **safe)
        if not front.chat_template:
            raise ConfigError(f"huggingface:{path} is no chat model: it has no chat template")
        model.to(place).eval()
    except (OSError, ValueError, KeyError, ImportError, RuntimeError) as err:
        reason = " ".join(str(err).split())
        raise ConfigError(f"the model huggingface:{path} cannot be loaded: {reason}") from err
    batch = batch or (_GPU_BATCH if place.type == "cuda" else 1)
    return _chat(path, model, front, sees=sees, weights=_weights(path, config), batch=batch)


def wrap(path: str, model: Any, tokenizer: Any) -> HuggingFaceChat:
    """Make a chat model of a text model that is loaded already, such as one with adapters.

    Raises:
        ConfigError: If it is no chat model.
    """
    if not tokenizer.chat_template:
        raise ConfigError(f"huggingface:{path} is no chat model: it has no chat template")
    return _chat(path, model, tokenizer, sees=False, weights="", batch=1)


def _chat(path: str, model: Any, front: Any, *, sees: bool, weights: str, batch: int) -> HuggingFaceChat:
    tokenizer = getattr(front, "tokenizer", front)
    tokenizer.padding_side = "left"
    ends = _ends(path, model, tokenizer)
    if tokenizer.pad_token_id is None:
        tokenizer.pad_token = tokenizer.convert_ids_to_tokens(ends[0])
    loaded = _Loaded(path, model, front, sees, ends, _grammars(model, tokenizer, ends), weights)
    return HuggingFaceChat(loaded, batch)


def _place(path: str, device: str) -> torch.device:
    if device == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    if device.startswith("cuda") and not torch.cuda.is_available():
        raise ConfigError(f"the model huggingface:{path} cannot go to {device}: there is no GPU that torch can use")
    return torch.device(device)


def _grammars(model: Any, tokenizer: Any, ends: list[int]) -> Grammars | None:
    try:
        return Grammars(tokenizer, int(model.config.get_text_config().vocab_size), ends)
    except ValueError:
        return None


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


def _weights(path: str, config: Any) -> str:
    stats = [(file.name, file.stat()) for file in sorted(Path(path).glob("*.safetensors"))]
    return str(
        getattr(config, "_commit_hash", None) or [(name, stat.st_size, stat.st_mtime_ns) for name, stat in stats]
    )


def _ends(path: str, model: Any, tokenizer: Any) -> list[int]:
    """Ids of the tokens that end a reply, sorted."""
    known = model.generation_config.eos_token_id
    given = known if isinstance(known, list) else [known]
    ends = {int(end) for end in (*given, tokenizer.eos_token_id) if end is not None}
    if not ends:
        raise ConfigError(f"huggingface:{path} is no chat model: it has no token that ends a reply")
    return sorted(ends)


def _pad(loaded: _Loaded) -> int:
    return int(loaded.tokenizer.pad_token_id)
