"""Direct finetuning of the robot's own language model: from what is seen to one intention and its tasks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, TypeAdapter, ValidationError

from coopera.core.clock import Clock, hour_label
from coopera.core.errors import CooperaError
from coopera.core.hour import DayAccount, IntentionCandidate, Proposal, TaskCandidate
from coopera.core.household import Collab, HandOver, PickPlace
from coopera.core.people import Frozen, PersonId
from coopera.evaluation.baselines import Occasion, occasions_of, offer, sight_of
from coopera.graphs.robots.robot_view import RobotView
from coopera.models.classifiers.state import replace_bytes
from coopera.models.parsing import BadReplyError, Wanted, read_reply

if TYPE_CHECKING:
    from coopera.models.finetuning import FinetunedChat

_PAST = "past.json"
_OF_CODE = {"kind", "object_id", "receptacle_id"}
"""Fields of an act that no model is asked for."""
_OCCASIONS = TypeAdapter(list[Occasion])


class PutReply(Frozen):
    """What the model replies in type 1."""

    intention: Annotated[str, Field(min_length=1, max_length=200)]
    tasks: Annotated[list[PickPlace], Field(max_length=8)]


class BringReply(Frozen):
    """What the model replies in type 2."""

    intention: Annotated[str, Field(min_length=1, max_length=200)]
    tasks: Annotated[list[HandOver], Field(max_length=8)]


REPLY: dict[Collab, type[PutReply] | type[BringReply]] = {1: PutReply, 2: BringReply}


class FinetunedModel:
    """The robot's language model itself, finetuned each evening on the day (PAPER §4.3, direct finetuning).

    From what is seen of the hour it replies with one intention and its tasks, all of which are accepted. Before its
    first evening it proposes nothing. DEVIATES: the paper does not say how it is finetuned; here it is LoRA by the
    recipe of `lora-instruct`, going on from evening to evening.
    """

    def __init__(self, model: str, recipe: Path | None = None) -> None:
        """Load the model; see `coopera.models.finetuning.FinetunedChat`."""
        from coopera.models.finetuning import FinetunedChat  # noqa: PLC0415 - heavy

        self._chat: FinetunedChat = FinetunedChat(model, recipe)
        self._past: list[Occasion] = []

    def help(self, view: RobotView) -> Proposal:
        """Propose the finetuned model's candidates; after an unreadable reply there are none, as a fallback says."""
        if not self._chat.trained:
            return Proposal(fallbacks=["nothing has been told yet"])
        reply = REPLY[view.collab]
        things = {kind: view.home.objects(kind) for kind in ("fixed", "movable")} if view.collab == 1 else {}
        wanted: Wanted[PutReply | BringReply] = Wanted(reply, things)
        text = self._chat.reply(question(view.person, view.clock, sight_of(view.observation)), wanted.enforced)
        try:
            said = read_reply(text, wanted).reply
        except BadReplyError as err:
            return Proposal(fallbacks=[f"the finetuned model's reply cannot be used: {err}"])
        tasks = [
            TaskCandidate(intention=said.intention, thought="as learned", act=act, probability=1.0, accepted=True)
            for act in said.tasks
        ]
        return Proposal(
            intentions=[IntentionCandidate(text=said.intention, probability=1.0, accepted=True)], tasks=tasks
        )

    def learn(self, account: DayAccount, *, seed: int) -> dict[str, Any]:
        """Train on all accounts so far, or on the newest of them."""
        self._past += occasions_of(account)
        lessons = [lesson(one) for one in self._past]
        return dict(self._chat.train(lessons, seed=seed)) if lessons else {"lessons": 0}

    def save(self, folder: Path) -> None:
        """Write the adapter and what it was trained on."""
        self._chat.save(folder)
        replace_bytes(folder / _PAST, _OCCASIONS.dump_json(self._past))

    def load(self, folder: Path) -> None:
        """Read what `save` wrote."""
        self._chat.load(folder)
        try:
            self._past = _OCCASIONS.validate_json((folder / _PAST).read_bytes())
        except (OSError, ValidationError) as err:
            raise CooperaError(f"{folder / _PAST}: what the model was told cannot be read ({err})") from err


def question(person: PersonId, clock: Clock, sight: str) -> str:
    """What the model is asked in an hour."""
    return (
        f"You are a robot that helps {person} at home. It is {hour_label(clock.hour)} of day {clock.day + 1}. {sight} "
        "What does the person intend, and which tasks would help them? Answer with one JSON object."
    )


def lesson(one: Occasion) -> tuple[str, str]:
    """The question of an hour, with what would have been the right reply."""
    tasks = [act.model_dump(exclude=_OF_CODE) for act in map(offer, one.acts)]
    said = json.dumps({"intention": one.intention, "tasks": tasks}, ensure_ascii=False)
    return question(one.person, one.clock, one.sight), said
