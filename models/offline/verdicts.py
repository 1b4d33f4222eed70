"""The person's evening: yes or no, with a reason, to what the robot guessed and offered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from core.replies import VerdictReply, VerdictsReply
from models.offline.offers import Want, wants
from models.offline.reading import clip, said
from models.offline.sense import CommonSense

MEANS_THE_SAME = 0.7  # cosine from which another wording still means the person's intention
HELPS = 0.6  # PAPER §4.3: similarity from which a thing serves as well as the one wanted


def feedback_intentions(sense: CommonSense, variables: Mapping[str, Any]) -> VerdictsReply:
    """Answer human/feedback_intentions: was the guess what I was up to, in these words or others?"""
    truth = str(variables["intention"])
    doing = sense.recognise(truth).activity
    verdicts = []
    for guess in map(said, variables["guesses"]):
        if sense.recognise(guess).activity.id == doing.id:
            reason, yes = "That is what I was up to.", True
        elif sense.similarity(guess, truth) >= MEANS_THE_SAME:
            reason, yes = f'That comes close enough to "{truth}".', True
        else:
            reason, yes = f'No, I wanted something else: "{truth}".', False
        verdicts.append(VerdictReply(yes=yes, reason=clip(reason, 400)))
    return VerdictsReply(verdicts=verdicts)


def feedback_tasks(sense: CommonSense, variables: Mapping[str, Any]) -> VerdictsReply:
    """Answer human/feedback_tasks: would the offer have helped with one of the tasks that were left?"""
    needed = wants(variables["tasks"])
    return VerdictsReply(verdicts=[_helps(sense, offer, needed) for offer in wants(variables["offers"])])


def _helps(sense: CommonSense, offer: Want, needed: Sequence[Want]) -> VerdictReply:
    if not needed:
        return VerdictReply(yes=False, reason="There was nothing left to help with.")
    # Where things are put somewhere, both the thing and the place must serve; where a thing is handed over, it must.
    scores = [
        min(sense.similarity(offer.thing, want.thing), sense.similarity(offer.spot, want.spot))
        if offer.spot is not None and want.spot is not None
        else sense.similarity(offer.thing, want.thing)
        for want in needed
    ]
    best = max(range(len(needed)), key=lambda i: (scores[i], -i))
    want, score = needed[best], scores[best]
    if score >= 0.999:
        return VerdictReply(yes=True, reason=clip(f"Yes, I needed just that: {want.text}.", 400))
    if score >= HELPS:
        return VerdictReply(yes=True, reason=clip(f"Yes, that would have served me to {want.text}.", 400))
    return VerdictReply(yes=False, reason=clip(f"No, I had no use for it; I went on to {needed[0].text}.", 400))
