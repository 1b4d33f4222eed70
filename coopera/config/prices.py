"""What models cost: a file of prices by model, and the money that calls came to. No prices ship, since they change.

as_of: 2026-05-01        # the day on which you looked them up
currency: EUR
models:                  # per million tokens; the first pattern that fits a model counts
  "openai:small-*": {in: 0.25, out: 2.0}
  "openai:*": {in: 1.25, out: 10.0}
"""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any

from pydantic import ConfigDict, Field, ValidationError, field_validator

from coopera.config.files import read_yaml
from coopera.core.errors import ConfigError
from coopera.core.hour import ModelCall
from coopera.core.people import Frozen
from coopera.models.given import IMAGES
from coopera.models.recorded import recorded_run
from coopera.models.settings import Budget
from coopera.models.specs import runs_here

_MILLION = 1_000_000
_DIGITS = 6
_EXPECTED = {
    "as_of": "a day such as 2026-05-01",
    "currency": "a word such as EUR",
    "models": "a mapping of models, or of patterns such as openai:*, to {in: PRICE, out: PRICE}",
}

Money = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Price(Frozen):
    """Of a million tokens, by the messages (`in`) and by the reply (`out`)."""

    model_config = ConfigDict(populate_by_name=True)

    tokens_in: Money = Field(alias="in")
    tokens_out: Money = Field(alias="out")


class Prices(Frozen):
    """The prices of models by their specs, and when they were looked up."""

    as_of: str = Field(pattern=r"^\d{4}-\d\d-\d\d$")
    currency: str = Field(min_length=1, max_length=12)
    models: dict[str, Price] = Field(min_length=1)

    @field_validator("as_of", mode="before")
    @classmethod
    def _as_written(cls, value: Any) -> Any:
        """YAML reads a day as a date."""
        return value.isoformat() if hasattr(value, "isoformat") else value

    def of(self, spec: str) -> Price | None:
        """The price of a model; what runs in this process costs nothing here, and None is one without a price."""
        if runs_here(spec) or recorded_run(spec) is not None:
            return Price(tokens_in=0, tokens_out=0)
        name = spec.removesuffix(IMAGES)
        return next((price for pattern, price in self.models.items() if fnmatchcase(name, pattern)), None)

    def money(self, spec: str, tokens_in: float, tokens_out: float) -> float:
        """What so many tokens of a model cost; nothing, where it has no price."""
        price = self.of(spec)
        return (tokens_in * price.tokens_in + tokens_out * price.tokens_out) / _MILLION if price else 0.0

    def bill(self, calls: Iterable[ModelCall]) -> dict[str, Any]:
        """What some calls cost: `spent`, `currency`, `as_of`, and the models without a price.

        Replies from the cache cost nothing.
        """
        paid = [call for call in calls if not call.cached]
        spent = sum(self.money(call.model, call.tokens_in, call.tokens_out) for call in paid)
        unpriced = sorted({call.model for call in paid if self.of(call.model) is None})
        return {**self.about(spent), "unpriced": unpriced}

    def about(self, spent: float) -> dict[str, Any]:
        """A sum with its currency and the day of the prices."""
        return {"spent": round(spent, _DIGITS), "currency": self.currency, "as_of": self.as_of}


def read_prices(path: Path) -> Prices:
    """Read a file of prices.

    Raises:
        ConfigError: Naming the file, the field and what was expected.
    """
    data = read_yaml(path, "file of prices")
    try:
        return Prices.model_validate(data)
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        place = [str(part) for part in first["loc"]]
        field = ".".join(place)
        if first["type"] == "extra_forbidden":
            known = "in and out" if len(place) > 1 else "as_of, currency and models"
            raise ConfigError(f"{path}: there is no field {field!r} (known are {known}).") from None
        wanted = "a price of a million tokens, from 0 up" if len(place) > 1 else _EXPECTED[place[0]]
        given = "missing" if first["type"] == "missing" else repr(first["input"])
        raise ConfigError(f"{path}: {field} must be {wanted}, not {given}.") from None


def check_money(budget: Budget, prices: Prices | None, specs: Iterable[str]) -> None:
    """Refuse a limit to the money that would never be reached, since what models cost is not known.

    Args:
        budget: What the run may spend.
        prices: Those that the run was told when it began.
        specs: The models that play its roles.

    Raises:
        ConfigError: Naming a model that has no price.
    """
    if budget.money is None:
        return
    if prices is None:
        raise ConfigError("budget.money: a run counts money by the --prices FILE that it began with, and has none.")
    unpriced = next((spec for spec in specs if prices.of(spec) is None), None)
    if unpriced is not None:
        raise ConfigError(f"budget.money: the model {unpriced} has no price in the run's file of prices.")


def in_words(bill: dict[str, Any]) -> str:
    """A bill in a sentence."""
    said = f"Cost: {bill['spent']:.2f} {bill['currency']}, by the prices of {bill['as_of']}"
    return f"{said}; without a price: {', '.join(bill['unpriced'])}." if bill.get("unpriced") else f"{said}."
