"""The offline routine model as a LangChain chat model. It is not a language model."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping
from threading import RLock
from typing import Any

import numpy as np
from langchain_core.callbacks import CallbackManagerForLLMRun
from langchain_core.embeddings import Embeddings
from langchain_core.language_models.chat_models import BaseChatModel
from langchain_core.messages import AIMessage, BaseMessage
from langchain_core.outputs import ChatGeneration, ChatResult
from pydantic import ConfigDict, Field, PrivateAttr
from typing_extensions import override

from coopera.core.asks import ASKS
from coopera.core.errors import ModelCallError
from coopera.core.lazy import made_once
from coopera.core.protocols import Role
from coopera.core.replies import REPLIES
from coopera.models.offline.household.knowledge import Household, robots, shipped
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.replies import Human
from coopera.models.offline.judge import Judge
from coopera.models.offline.robot.replies import Robot

RULES = "9"
"""Raised whenever the same question may get another answer; it enters every cache key."""

_SIDES: dict[Role, type[Human] | type[Robot] | type[Judge]] = {"human": Human, "robot": Robot, "judge": Judge}


def usual_household(role: Role) -> Household:
    """The household file of a role: the person has one, robot and judge have another."""
    return shipped() if role == "human" else robots()


@made_once(8)
def _common_sense(household: Household, embeddings: Embeddings) -> CommonSense:
    """What the roles of one household share, and all runs of a process that compare texts in the same way."""
    return CommonSense(household, embeddings)


class OfflineChatModel(BaseChatModel):
    """A routine model that answers coopera's prompts without any language model, network or GPU.

    It is no language model and does not read the prompt's text. It answers from the prompt's variables, by rules over a
    household knowledge file and by MiniLM similarity of texts. `messages[-1].additional_kwargs["coopera"]` must hold
    {"prompt", "variables", "seed", "temperature"}; `coopera.core.asks` lists the variables of each prompt. The reply is
    the JSON of the prompt's reply type. The same question with the same seed gets the same answer on every machine.

    Person and robot differ in common sense, as two people do: each reads a household file of its own, and the judge
    reads the robot's. Only the role "human" can reach a person's private parameters. docs/offline-model.md explains the
    uses and the limits.
    """

    model_config = ConfigDict(arbitrary_types_allowed=True)

    role: Role
    embeddings: Embeddings
    household: Household = Field(default_factory=lambda given: usual_household(given["role"]))

    _side: Human | Robot | Judge = PrivateAttr()
    _lock: RLock = PrivateAttr(default_factory=RLock)

    @override
    def model_post_init(self, context: Any, /) -> None:
        """Build this role's side; texts are encoded when first needed."""
        make = _common_sense if isinstance(self.embeddings, Hashable) else CommonSense
        sense = make(self.household, self.embeddings)
        self._side = _SIDES[self.role](sense)

    @property
    @override
    def _llm_type(self) -> str:
        return "coopera-offline"

    @property
    @override
    def _identifying_params(self) -> Mapping[str, Any]:
        return {"model_name": "offline", "role": self.role, "rules": RULES, "household": self.household.sha256}

    @override
    def _generate(
        self,
        messages: list[BaseMessage],
        stop: list[str] | None = None,
        run_manager: CallbackManagerForLLMRun | None = None,
        **kwargs: Any,
    ) -> ChatResult:
        """Answer the last message.

        Raises:
            ModelCallError: If the message carries no question, one of another role, or one that lacks a variable.
        """
        asked = messages[-1].additional_kwargs.get("coopera") if messages else None
        if not isinstance(asked, Mapping):
            raise ModelCallError("the offline model answers coopera's own prompts only, and this message carries none")
        content = self._answer(asked)
        words_in = sum(len(str(message.content).split()) for message in messages)
        words_out = len(content.split())
        message = AIMessage(
            content=content,
            response_metadata={"model_name": "offline"},
            usage_metadata={
                "input_tokens": words_in,  # words: it has no tokens
                "output_tokens": words_out,
                "total_tokens": words_in + words_out,
            },
        )
        return ChatResult(generations=[ChatGeneration(message=message)])

    def _answer(self, asked: Mapping[str, Any]) -> str:
        if missing := [name for name in ("prompt", "variables", "seed", "temperature") if name not in asked]:
            raise ModelCallError(f"the question to the offline model lacks its {missing[0]}")
        prompt, variables = str(asked["prompt"]), asked["variables"]
        spec = ASKS.get(prompt)
        if spec is None or spec.role != self.role:
            known = f"is for the role {spec.role}" if spec else "is not known to it"
            raise ModelCallError(f"{prompt}: the offline model in the role {self.role} cannot answer this: it {known}")
        if lacking := sorted(spec.variables - set(variables)):
            raise ModelCallError(f"{prompt}: the variable {lacking[0]!r} is missing")
        rng = np.random.default_rng(int(asked["seed"]))
        with self._lock:
            reply = self._side.answer(prompt, variables, rng, float(asked["temperature"]))
        if not isinstance(reply, REPLIES[spec.reply]):
            raise ModelCallError(f"{prompt}: the offline model made a {type(reply).__name__}, not a {spec.reply}")
        return json.dumps(reply.model_dump(mode="json"), ensure_ascii=False)
