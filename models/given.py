"""A chat model that a script has made itself, in the place of a spec: a text like all others, with the object in it.

The text, such as "object:ChatOpenAI:gpt-4o", is what a run records. An object cannot be written down, so whoever goes
on with a run gives it again.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias, Union

if TYPE_CHECKING:
    from langchain_core.language_models import BaseChatModel

OBJECT = "object"
"""What a spec of this kind begins with."""
IMAGES = "+images"
"""What a spec ends with whose model looks at pictures and does not say so itself."""
Chosen: TypeAlias = Union[str, "BaseChatModel"]
"""A model: by its spec, or the object itself."""
_NAMES = ("model_name", "model", "model_id", "deployment_name", "path")
_CHAT_MODELS = "langchain_core.language_models.chat_models"


class GivenModel(str):
    """The spec of a chat model that was given as an object.

    Attributes:
        model: The object.
    """

    model: BaseChatModel

    __slots__ = ("model",)

    def __new__(cls, model: BaseChatModel, *, images: bool = False) -> GivenModel:
        """Name an object by its class and its model.

        Args:
            model: A chat model of LangChain.
            images: Whether it looks at pictures, where its profile does not say so.
        """
        named = next((said for name in _NAMES if isinstance(said := getattr(model, name, None), str) and said), "")
        spec = ":".join(part for part in (OBJECT, type(model).__name__, "_".join(named.split())) if part)
        made = super().__new__(cls, f"{spec}{IMAGES}" if images else spec)
        made.model = model
        return made

    @property
    def mark(self) -> str:
        """A fingerprint of the object, by its settings in plain text and numbers: 64 hex digits. No key is in it."""
        fields = {name: getattr(self.model, name, None) for name in sorted(type(self.model).model_fields)}
        plain = {name: value for name, value in fields.items() if isinstance(value, str | int | float)}
        return hashlib.sha256(f"{self.model._get_llm_string()} {plain}".encode()).hexdigest()

    def __reduce__(self) -> tuple[Any, ...]:
        """Let a copy have the same object."""
        return _again, (self.model, self.endswith(IMAGES))


def _again(model: BaseChatModel, images: bool) -> GivenModel:
    return GivenModel(model, images=images)


def is_chat_model(value: object) -> bool:
    """Whether something is a chat model of LangChain, which is not imported to find out."""
    module = sys.modules.get(_CHAT_MODELS)
    return module is not None and isinstance(value, module.BaseChatModel)


def as_spec(value: Any) -> Any:
    """A chat model as a spec; all else as it is."""
    return GivenModel(value) if is_chat_model(value) else value


def by_role(value: Any, roles: tuple[str, ...]) -> Any:
    """One model for all roles as a mapping; all else as it is, with objects as specs."""
    chosen = as_spec(value)
    if isinstance(chosen, str):
        return dict.fromkeys(roles, chosen)
    return {role: as_spec(one) for role, one in chosen.items()} if isinstance(chosen, Mapping) else chosen
