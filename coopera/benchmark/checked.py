"""The hidden-seed check: the keeper of a board runs a submission again on seeds that nobody else can know.

The seeds follow from the keeper's secret and the submission's own table, so that neither can be fitted to them. The
check is written beside the results, sealed with the secret. It holds neither the secret nor the seeds.
"""

from __future__ import annotations

import hashlib
import hmac
from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from coopera.config.files import canonical_json, reason, write_atomic
from coopera.core.errors import ConfigError, RunError
from coopera.core.people import Frozen
from coopera.evaluation.analysis import endpoint_of, late_units, plain
from coopera.evaluation.comparing import Of, Unit, clustered_mean, noise
from coopera.evaluation.results import Card, Row
from coopera.rundir.trace_files import damaged, read_json

FILE = "check.json"
SHORTEST = 16
_ALPHA = 0.05


class Compared(Frozen):
    """A method in one setting and type: what was submitted and what came of hidden seeds.

    Attributes:
        floor: What the difference of the two may be by the scatter between seeds alone.
    """

    method: str
    setting: str
    collab: int
    submitted: float
    hidden: float
    floor: float

    @property
    def agrees(self) -> bool:
        """Whether the two differ by no more than seeds do."""
        return abs(self.submitted - self.hidden) <= self.floor


class Check(Frozen):
    """What came of a hidden-seed check.

    Attributes:
        table: SHA-256 of the table that was checked.
        seeds: How many hidden seeds there were.
        compared: Every method in every setting and type.
        differ: Fingerprints in which the keeper's run is another.
        seal: HMAC-SHA256 of the rest by the keeper's secret.
    """

    table: str
    seeds: int
    compared: list[Compared]
    differ: list[str]
    seal: str = ""

    @property
    def agrees(self) -> bool:
        """Whether everything agrees."""
        return all(one.agrees for one in self.compared)

    def of(self, method: str, setting: str, collab: int) -> str:
        """In a word, for one method."""
        key = (method, setting, collab)
        found = [one.agrees for one in self.compared if (one.method, one.setting, one.collab) == key]
        return ("agrees" if found[0] else "DIFFERS") if found else "not checked"


def read_secret(path: Path) -> bytes:
    """The keeper's secret.

    Raises:
        ConfigError: If there is none, or it could be guessed.
    """
    try:
        secret = path.read_bytes().strip()
    except OSError as err:
        raise ConfigError(f"{path}: the secret cannot be read ({reason(err)}).") from err
    if len(secret) < SHORTEST:
        raise ConfigError(f"{path}: the secret has {len(secret)} bytes, and must have {SHORTEST} or more.")
    return secret


def hidden_seeds(secret: bytes, card: Card, count: int) -> list[int]:
    """Seeds for a submission, none of which it has itself."""
    found: list[int] = []
    number = 0
    while len(found) < count:
        drawn = hmac.new(secret, f"{card.sha256}|{number}".encode(), hashlib.sha256).digest()
        seed, number = int.from_bytes(drawn[:4], "big") >> 1, number + 1
        if seed not in (*card.seeds, *found):
            found.append(seed)
    return found


def compare_hidden(card: Card, submitted: Sequence[Row], hidden: Sequence[Row], other: Card) -> Check:
    """Compare what was submitted with what the keeper's run gave, within the noise between seeds.

    Args:
        card: The submission's.
        submitted: Its rows.
        hidden: The rows of the keeper's run.
        other: The card of that run.

    Raises:
        RunError: If there are too few seeds to tell the noise.
    """
    endpoint = endpoint_of(card)
    theirs = late_units(plain(submitted), endpoint.measure, endpoint)
    ours = late_units(plain(hidden), endpoint.measure, endpoint)
    cells = sorted({(method, str(key[0]), int(str(key[1]))) for method, each in theirs.items() for key in each})
    compared = []
    for method, setting, collab in cells:
        one = _of(theirs[method], setting, collab)
        two = _of(ours.get(method, {}), setting, collab)
        if not two:
            continue
        # seeds of the two are not compared with each other here, so that a difference is no noise
        both = {(*key[:3], f"{name} {key[3]}", *key[4:]): unit for name, each in (("submitted", one), ("hidden", two))
                for key, unit in each.items()}  # fmt: skip
        level = 1 - _ALPHA / len(cells)
        floors = [noise(both, each, level=level) for each in (one, two)]
        if None in floors:
            raise RunError("check: two hidden seeds or more are needed to tell the noise.")
        compared.append(
            Compared(
                method=method,
                setting=setting,
                collab=collab,
                submitted=clustered_mean(list(one.values())).mean,
                hidden=clustered_mean(list(two.values())).mean,
                floor=sum(floor.floor**2 for floor in floors if floor) ** 0.5,
            )
        )
    mine, marks = (each.fingerprints.model_dump() if each.fingerprints else {} for each in (other, card))
    differ = sorted(name for name in mine if name != "mixed" and mine[name] != marks.get(name))
    return Check(table=card.sha256, seeds=len(other.seeds), compared=compared, differ=differ)


def _of(units: dict[Of, Unit], setting: str, collab: int) -> dict[Of, Unit]:
    return {key: unit for key, unit in units.items() if (key[0], key[1]) == (setting, collab)}


def write_check(folder: Path, check: Check, secret: bytes) -> Path:
    """Write a check beside the results that it is of.

    Raises:
        RunError: If it cannot be written.
    """
    path = folder / FILE
    sealed = check.model_copy(update={"seal": _seal(check, secret)})
    try:
        write_atomic(path, canonical_json(sealed.model_dump()))
    except OSError as err:
        raise RunError(f"{path}: the check cannot be written ({reason(err)}).") from err
    return path


def read_check(folder: Path, table: str, secret: bytes | None = None) -> Check | None:
    """The check beside some results; None where there is none.

    Raises:
        ConfigError: If it is of another table, or the secret was given and did not seal it.
    """
    path = folder / FILE
    if not path.is_file():
        return None
    try:
        found = Check.model_validate(read_json(path))
    except (ValidationError, RunError) as err:
        raise ConfigError(str(damaged(path, err)) if isinstance(err, ValidationError) else str(err)) from None
    if found.table != table:
        raise ConfigError(f"{path}: this check is of another table; check these results again.")
    if secret is not None and not hmac.compare_digest(found.seal, _seal(found, secret)):
        raise ConfigError(f"{path}: this check was not made with this secret; check these results again.")
    return found


def _seal(check: Check, secret: bytes) -> str:
    text = canonical_json(check.model_dump(exclude={"seal"}))
    return hmac.new(secret, text.encode(), hashlib.sha256).hexdigest()
