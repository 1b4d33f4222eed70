"""How much old evidence still counts: a posterior over when the person last changed.

Each memory in the mixture knows what came since one moment. A memory that foretells better gains weight, so after a
change those that begin there take over, and nothing fades while nothing changes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

HAZARD = 0.01
"""Share of steps at which a person is expected to change before anything is known of the person."""
REMNANT = 0.05
"""What evidence from before a change still counts: enough to start from, and soon outvoted."""
MOST = 24
"""Memories kept; the lightest go. The newest ones stay for `_YOUNG` steps, since they cannot have proved anything."""
_YOUNG = 6


class Fading:
    """A mixture of memories by their beginnings, weighed by what they foretold.

    After Adams and MacKay (2007, arXiv:0710.3742). A step is whatever is foretold at once: a day, or a single choice.

    Attributes:
        starts: The step with which each memory begins, ascending; one that knows everything begins with 0.
    """

    def __init__(self, *, hazard: float = HAZARD) -> None:
        """Start with the one memory that knows everything."""
        self.starts: list[int] = [0]
        self._hazard = hazard
        self._log = np.zeros(1)
        self._newest = 0

    @property
    def weights(self) -> Floats:
        """The probability of each memory, in the order of `starts`; they sum to 1."""
        found: Floats = np.exp(self._log)
        return found

    def begin(self, step: int) -> None:
        """Let the person perhaps have changed just before this step; steps must ascend.

        Raises:
            ValueError: If the step is not later than the last one.
        """
        if step <= self._newest:
            raise ValueError(f"step {step} does not come after step {self._newest}")
        self._newest = step
        self._log = np.append(self._log + np.log1p(-self._hazard), np.log(self._hazard))
        self.starts.append(step)
        if len(self.starts) > MOST:
            old = [place for place, start in enumerate(self.starts) if start <= step - _YOUNG]
            least = min(old, key=lambda place: self._log[place])
            del self.starts[least]
            self._log = np.delete(self._log, least)
            self._normalise()

    def learn(self, log_likelihoods: Sequence[float] | Floats) -> None:
        """Weigh the memories by the log-likelihood, in nats, that each gave to what then happened."""
        self._log = self._log + np.asarray(log_likelihoods, np.float64)
        self._normalise()

    def of(self, steps: Ints) -> Floats:
        """Return what the evidence of each step counts, in [REMNANT, 1], shape as given; 1 without a change since."""
        begun = np.concatenate([[0.0], np.cumsum(self.weights)])
        kept = np.minimum(begun[np.searchsorted(np.array(self.starts), steps, side="right")], 1.0)
        found: Floats = REMNANT + (1.0 - REMNANT) * kept
        return found

    def _normalise(self) -> None:
        self._log = self._log - np.logaddexp.reduce(self._log)
