"""The person's feedback in the evening: yes or no, or a grade, with a reason, to each of the robot's candidates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from coopera.core.replies import Grade, GradesReply, VerdictReply, VerdictsReply
from coopera.models.offline.household.offers import Want, wants
from coopera.models.offline.household.reading import big_five_of, clip, said
from coopera.models.offline.household.sense import CommonSense
from coopera.models.offline.human.person import private_rng

MEANS_THE_SAME = 0.7  # cosine from which another wording still means the person's intention
SERVES = 3  # grade from which the answer is a yes
NEARLY = 0.8  # similarity from which a thing is nearly the one wanted
HARDLY = 0.4  # similarity under which a thing has nothing to do with the one wanted
HELPS = 0.6  # similarity from which a thing serves the average person as well as the one wanted, as in PAPER §4.3
LENIENT = 0.03  # by how much a point of agreeableness lowers it
FUSSY = 0.05  # by how much people differ in it besides


def feedback_intentions(sense: CommonSense, variables: Mapping[str, Any]) -> VerdictsReply:
    """Answer human/feedback_intentions: is the candidate my intention, in these words or others?"""
    return _as_verdicts(_guesses(sense, variables))


def feedback_tasks(sense: CommonSense, variables: Mapping[str, Any]) -> VerdictsReply:
    """Answer human/feedback_tasks: would the candidate have helped with one of the remaining tasks?"""
    return _as_verdicts(_offers(sense, variables))


def grade_intentions(sense: CommonSense, variables: Mapping[str, Any]) -> GradesReply:
    """Answer human/grade_intentions: how near is the candidate to my intention?"""
    return GradesReply(grades=_guesses(sense, variables))


def grade_tasks(sense: CommonSense, variables: Mapping[str, Any]) -> GradesReply:
    """Answer human/grade_tasks: how much would the candidate have helped?"""
    return GradesReply(grades=_offers(sense, variables))


def _as_verdicts(grades: Sequence[Grade]) -> VerdictsReply:
    return VerdictsReply(verdicts=[VerdictReply(yes=one.grade >= SERVES, reason=one.reason) for one in grades])


def _guesses(sense: CommonSense, variables: Mapping[str, Any]) -> list[Grade]:
    truth = str(variables["intention"])
    doing = sense.recognise(truth).activity
    grades = []
    for guess in map(said, variables["guesses"]):
        likeness = sense.similarity(guess, truth)
        if sense.recognise(guess).activity.id == doing.id:
            reason, grade = "That is what I was up to.", 5
        elif likeness >= MEANS_THE_SAME:
            reason, grade = f'That comes close enough to "{truth}".', 4
        else:
            reason, grade = f'No, I wanted something else: "{truth}".', 2 if likeness >= HARDLY else 1
        grades.append(Grade(grade=grade, reason=clip(reason, 400)))
    return grades


def _offers(sense: CommonSense, variables: Mapping[str, Any]) -> list[Grade]:
    needed, from_ = wants(variables["tasks"]), serves_from(variables)
    return [_helps(sense, offer, needed, from_) for offer in wants(variables["offers"])]


def serves_from(variables: Mapping[str, Any]) -> float:
    """Return the similarity from which a thing serves this person; some are content with less than others.

    DEVIATES: in the paper the measure and the person would draw the line at the same place. Drawn from the profile's
    text, so that somebody is as particular every evening.
    """
    agreeable = big_five_of(variables["big_five"]).agreeableness - 3.0
    own = float(private_rng(str(variables["profile"]), "fussy").normal(0.0, FUSSY))
    return HELPS - LENIENT * agreeable + own


def _helps(sense: CommonSense, offer: Want, needed: Sequence[Want], from_: float) -> Grade:
    if not needed:
        return Grade(grade=1, reason="There was nothing left to help with.")
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
        return Grade(grade=5, reason=clip(f"Yes, I needed just that: {want.text}.", 400))
    if score >= from_:
        reason = f"Yes, that would have served me to {want.text}."
        return Grade(grade=4 if score >= NEARLY else SERVES, reason=clip(reason, 400))
    reason = f"No, I had no use for it; I went on to {needed[0].text}."
    return Grade(grade=2 if score >= HARDLY else 1, reason=clip(reason, 400))
