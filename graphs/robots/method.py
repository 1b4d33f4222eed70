"""A method is data: what the robot does and sees. The defaults are the paper's; `evaluation.METHODS` lists them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from coopera.graphs.robots.rehearsal import REHEARSED

if TYPE_CHECKING:
    from pathlib import Path

    from coopera.core.hour import CandidateKind
    from coopera.core.protocols import Classifier
    from coopera.graphs.robots.own_robot import KnowPeople, MakeRobot, Robot


@dataclass(frozen=True, slots=True)
class Method:
    """One way for the robot to help; `evaluation.METHODS` lists them.

    Attributes:
        name: As given to `--method`.
        traits: Whether the inferred Big Five and profile enter prompts and classifiers.
        context: Whether retrieved intentions and tasks enter prompts and classifiers.
        order: Whether the classifiers see the robot's own order of its candidates. DEVIATES: the paper's do not. They
            do not see the observation either, and the order sums it up.
        time_only: Whether the classifiers see nothing but the candidate and the time.
        intentions: "inferred" from the observation; "given" by the person; or "skipped": the tasks are imagined
            directly for the observation, without an intention.
        n_intentions: How many intention candidates are imagined; by default the paper's number.
        verdicts: "classifiers" keeps what the trained classifiers find likely; "accept" keeps everything, "reject"
            nothing, "first" the first intention with all of its tasks.
        remembers: How the robot's memory fades: by the "hours", as the paper's does; or by "days", with most of it told
            and a sense for the time of day and the kind of day (`graphs.robots.recall`).
        told: Whether the told hours of like intentions, with their tasks, go to the prompts, and decide how many tasks
            are imagined.
        skips_held: Whether what the person holds or has just done is never offered.
        evidence: Whether classifiers see the proposer's probabilities and the counts of what was told, and whether the
            robot goes by these until its first evening (the best guess and its tasks). Otherwise it then accepts all.
        accepts: "half": what is more probable than not, as the paper does; "need": what is worth it for the F1 over the
            person's needs (`graphs.robots.verdicts`).
        turns: Whether what was told before a turn in the person's life counts less (`graphs.robots.turns`).
        replay: How many earlier examples of intentions and of tasks an evening goes over again.
        learns: Whether the evening trains the classifiers, or one's own robot.
        judge: Makes a classifier of one's own for a kind of candidate; by default the run's `classifier` is taken.
        other_backbone: Whether the robot's language model is the run's `backbone` instead of its own.
        robot: Whether there is a robot at all; without one a person's life is simulated alone.
        own: The class of a robot of one's own, which takes the place of our graph (`graphs.robots.own_robot`).
            Of the other fields it meets `traits` (whether the evening infers a belief about the person) and `learns`.
        knows: Makes the robot in place of `own` from the true people, by the text and the traits that they live by, and
            by their household file: a ceiling. Refused where the person is not simulated by the offline model.
        swapped: Whether the evening is another person's: their account, and their answers to the robot's candidates.
            What the robot still gains cannot come from knowing whom it lives with. Needs an earlier life of several.
        tunes: Makes the robot in place of `own` if the robot's model is one of Hugging Face. This robot finetunes the
            model of that name by a recipe (None: the shipped one). Models elsewhere are refused.
    """

    name: str
    traits: bool = True
    context: bool = True
    order: bool = True
    time_only: bool = False
    intentions: Literal["inferred", "given", "skipped"] = "inferred"
    n_intentions: int | None = None
    verdicts: Literal["classifiers", "accept", "reject", "first"] = "classifiers"
    remembers: Literal["hours", "days"] = "hours"
    told: bool = False
    skips_held: bool = False
    evidence: bool = False
    accepts: Literal["half", "need"] = "half"
    turns: bool = False
    replay: tuple[int, int] = (REHEARSED, REHEARSED)
    learns: bool = True
    other_backbone: bool = False
    robot: bool = True
    judge: Callable[[CandidateKind], Classifier] | None = None
    own: MakeRobot | None = None
    knows: KnowPeople | None = None
    swapped: bool = False
    tunes: Callable[[str, Path | None], Robot] | None = None

    @property
    def told_the_truth(self) -> bool:
        """Whether it is declared to be given what a robot cannot know, so that no audit can hold it to that."""
        return self.intentions == "given" or self.knows is not None


class Numbers:
    """How many of each thing the paper's method asks for, by collaboration type (facts of the paper and its code)."""

    HUMAN_TASKS = {1: 3, 2: 5}  # PAPER §3.1
    ROBOT_INTENTIONS = {1: 3, 2: 5}  # PAPER App. D says 5; the authors' code asks for 3 in type 1
    ROBOT_TASKS = {1: 3, 2: 5}  # PAPER App. D
    DIRECT_TASKS = 8  # ours: where no intention is inferred, as many tasks as one reply may hold
    RECALL_INTENTIONS = 3  # PAPER §4.1
    RECALL_TASKS = 5  # PAPER §4.1
    RECALL_WEEKS = {"intention": 6, "task": 6}  # ours: where the memory is one of weeks
    MOST_TASKS = {1: 5, 2: 8}  # ours: where much was told; as many as one reply may hold in type 2
    TOLD_HOURS = {"intention": 10, "task": 6}  # ours: how many told hours a prompt gives
    SCENE_ROUNDS = 3  # ours: second reflections at most, while code still finds something wrong
