"""Bringing a reply into the form of its schema where its meaning is plain, and counting each leniency by kind.

| kind | what was put right |
|---|---|
| `json` | quotes, commas, comments, words of Python |
| `wrapper` | an object around the answer, or a level too many or too few |
| `list` | a list without its object, a single item without its list, items under numbers; no words among words |
| `extra field` | a field that was not asked for: dropped |
| `field name` | another spelling, or a usual other name |
| `null` | nothing, where a text, list or task was asked for: empty, or what the field says by default |
| `number` | a number in quotes, a share in percent, "4/5" |
| `yes/no` | a word for true or false |
| `text` | a text that was a number or a list, a choice with other capitals, or a changed task's thought: the reason |
| `cut` | a reason, or a list of what is wanted, longer than there is room for |
| `name` | an object's name with other capitals or spaces, or without its number |
| `id` | a name that was missing or wrong, found by the id |

What is still wrong after that, validation finds. What would be a guess is a problem here: a verdict said twice and
differently, items numbered in another order, a score that is not there, an object unlike its id, a task that is
turned down without a word of what becomes of it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from coopera.core.household import ObjectMap
from coopera.models.reading.fields import WRAPPERS, is_spelling, meant, same
from coopera.models.reading.lists import HINTS, ITEM_NUMBER, is_in_order, out_of_order, split, words_in
from coopera.models.reading.loose_json import nested
from coopera.models.reading.names import agrees, id_in, mended, name_in
from coopera.models.reading.words import (
    as_boolean,
    as_choice,
    as_number,
    as_verdict,
    contradict,
    cut,
    explains,
    is_blank,
    is_nothing,
)

UNKNOWN = -1
"""The id of an object that is not there."""
_LEVELS = 4
_MISSING = object()


@dataclass(frozen=True, slots=True)
class Fit:
    """One reply on its way into its form.

    Attributes:
        schema: The reply type's whole JSON schema.
        objects: By type and field, the objects that a name may mean.
        counted: How often each leniency was needed.
        problems: What would have to be guessed, in words for the model.
    """

    schema: Mapping[str, Any]
    objects: Mapping[str, Mapping[str, ObjectMap]]
    counted: Counter[str] = field(default_factory=Counter)
    problems: list[str] = field(default_factory=list)

    def whole(self, value: Any) -> Any:
        """Fit a whole reply."""
        return self._fit(value, self.schema, "", "")

    def _fit(self, value: Any, schema: Mapping[str, Any], name: str, place: str) -> Any:
        kind = ""
        if "$ref" in schema:
            kind = schema["$ref"].rpartition("/")[2]
            schema = self.schema["$defs"][kind]
        if options := schema.get("anyOf"):
            return self._option(value, options, name, place)
        if "enum" in schema:
            return self._choice(value, schema["enum"])
        match schema.get("type"):
            case "object":
                return self._object(value, schema, kind, place)
            case "array":
                return self._hints(value, schema) if name in HINTS else self._array(value, schema["items"], name, place)
            case "string":
                return self._text(value, schema, name, place)
            case "boolean":
                return self._boolean(value)
            case "number" | "integer":
                return self._number(value, schema)
            case _:
                return value

    def _option(self, value: Any, options: list[dict[str, Any]], name: str, place: str) -> Any:
        wanted = [one for one in options if one.get("type") != "null"]
        if len(wanted) < len(options) and value is None:
            return None
        if len(wanted) < len(options) and (value == {} or (isinstance(value, str) and is_nothing(value))):
            self.counted["null"] += 1
            return None
        return self._fit(value, wanted[0], name, place) if len(wanted) == 1 else value

    def _choice(self, value: Any, choices: list[Any]) -> Any:
        if value in choices or (chosen := as_choice(value, choices)) is None:
            return value
        self.counted["text"] += 1
        return chosen

    def _text(self, value: Any, schema: Mapping[str, Any], name: str, place: str) -> Any:
        said = value
        if isinstance(value, dict) and isinstance(value.get("name"), str):
            said = value["name"]
        elif isinstance(value, list) and value and all(isinstance(part, str) for part in value):
            said = "; ".join(value) if explains(name) else value[0] if len(value) == 1 else value
        elif explains(name) and isinstance(value, int | float):
            said = str(value)
        if said is not value:
            self.counted["text"] += 1
        if not isinstance(said, str):
            return said
        if said and schema.get("minLength") and is_blank(said, name):
            self.problems.append(f"{place}: {said.strip()[:40]} only holds the place of what should stand there")
        if said and explains(name) and not schema.get("minLength") and is_nothing(said):
            self.counted["null"] += 1
            return ""
        most = schema.get("maxLength")
        if most is not None and len(said) > most and explains(name):
            self.counted["cut"] += 1
            return cut(said, most)
        return said

    def _boolean(self, value: Any) -> Any:
        said = as_verdict(value)
        if said is None or said is value:
            return value
        self.counted["yes/no"] += 1
        return said

    def _number(self, value: Any, schema: Mapping[str, Any]) -> Any:
        said = as_number(value, schema.get("maximum")) if isinstance(value, str) else value
        if schema["type"] == "integer" and isinstance(said, float) and said.is_integer():
            said = int(said)
        if said is None or said is value:
            return value
        self.counted["number"] += 1
        return said

    def _array(self, value: Any, item: Mapping[str, Any], name: str, place: str) -> Any:
        items = self._listed(value, item)
        if not isinstance(items, list):
            return value
        if items is not value:
            self.counted["list"] += 1
        if out_of_order(items, self._properties(item)):
            self.problems.append(f"{place}: the items are numbered in another order than the one asked for")
        return [self._fit(one, item, name, f"{place}.{n}") for n, one in enumerate(items)]

    def _hints(self, value: Any, schema: Mapping[str, Any]) -> list[str]:
        """Short texts that decide nothing: those with a meaning, as many as there is room for."""
        given = split(value) if isinstance(value, str) else value
        found = list(words_in(given))
        made = [cut(said, most) if len(said) > (most := schema["items"]["maxLength"]) else said for said in found]
        made = made[: schema["maxItems"]]
        if found != value:
            self.counted["list"] += 1
        if made != found:
            self.counted["cut"] += 1
        return made

    def _listed(self, value: Any, item: Mapping[str, Any]) -> Any:
        """A list that was written otherwise: inside a text, in another list, under numbers, or as its only item."""
        if isinstance(value, str):
            if (inside := self._nested(value)) is not None:
                return self._listed(inside, item)
            return split(value) if item.get("type") in ("string", "integer") else value
        if isinstance(value, list) and len(value) == 1 and isinstance(value[0], list):
            return value[0]
        if not isinstance(value, dict):
            return value
        known = self._properties(item)
        if any(meant(key, known) for key in value):
            return [value]
        (key, inside), *others = value.items() or [("", None)]
        if not others and isinstance(inside, list):
            return inside
        if not others and isinstance(inside, dict) and same(key) in WRAPPERS:
            return self._listed(inside, item)
        numbers = [ITEM_NUMBER.fullmatch(key) for key in value]
        counted = [int(found[1]) for found in numbers if found]
        return list(value.values()) if len(counted) == len(value) and is_in_order(counted) else value

    def _object(self, value: Any, schema: Mapping[str, Any], kind: str, place: str) -> Any:
        known: Mapping[str, Any] = schema.get("properties", {})
        if not known:
            return value
        given = self._opened(value, schema, known)
        if not isinstance(given, dict):
            return value
        fields = self._named(given, known, place)
        self._gather(fields, given, known)
        self._name_objects(fields, kind, place)
        if "yes" in known and "task" in known:
            self._review(fields, known["task"], place)
        made: dict[str, Any] = {}
        for one, part in known.items():
            if "const" in part:
                continue  # code knows it
            if one not in fields:
                self._refuse_missing(one, part, place)
            elif fields[one] is None and not _may_be_null(part):
                self._nothing(made, one, part, place)
            else:
                made[one] = self._fit(fields[one], part, one, f"{place}.{one}" if place else one)
        return made

    def _opened(self, value: Any, schema: Mapping[str, Any], known: Mapping[str, Any]) -> Any:
        """The object that holds the fields, whatever is around it."""
        for _ in range(_LEVELS):
            if isinstance(value, str) and (inside := self._nested(value)) is not None:
                value = inside
            elif isinstance(value, list):
                lists = _lists(schema)
                if len(value) == 1 and isinstance(value[0], dict) and any(meant(key, known) for key in value[0]):
                    self.counted["wrapper"] += 1
                    return value[0]
                if len(lists) != 1:
                    return value
                self.counted["list"] += 1
                return {lists[0]: value}
            elif not isinstance(value, dict):
                needed = schema.get("required", [])
                if value is None or len(needed) != 1 or _is_one_of(value, known[needed[0]]) is False:
                    return value
                self.counted["wrapper"] += 1
                return {needed[0]: value}
            elif inside := self._inside(value, known):
                self.counted["wrapper"] += 1
                value = inside[0]
            else:
                return value
        return value

    def _inside(self, value: Mapping[str, Any], known: Mapping[str, Any]) -> list[Any]:
        """What the only wrapper of an object holds that has no field of its own."""
        if any(meant(key, known) and not _wraps(key, value[key], known) for key in value):
            return []
        titled = {*WRAPPERS, same(str(self.schema.get("title", "")))}
        held = [part for key, part in value.items() if same(key) in titled and isinstance(part, dict | list | str)]
        held = [part for part in held if not isinstance(part, str) or part.strip().startswith(("{", "["))]
        if len(held) == 1:
            return held
        lists = [one for one, part in known.items() if part.get("type") == "array"]
        others = [part for part in value.values() if isinstance(part, list)]
        return others if len(lists) == len(others) == 1 and len(known) == 1 else []

    def _named(self, given: Mapping[str, Any], known: Mapping[str, Any], place: str) -> dict[str, Any]:
        """The fields under their own names; the others are dropped."""
        fields: dict[str, Any] = {key: value for key, value in given.items() if key in known}
        for key, value in given.items():
            one = None if key in known else meant(key, known)
            if one is None:
                continue
            if one not in fields:
                self.counted["field name"] += 1
                fields[one] = value
            elif fields[one] != value and (
                is_spelling(key, one) or contradict(fields[one], value) or (one == "task" and isinstance(value, dict))
            ):
                self.problems.append(f"{place or 'the object'}: {one} and {key[:40]} say different things")
            else:
                self.counted["extra field"] += 1
        if "yes" in fields and as_boolean(str(given.get("no"))) not in (None, not as_verdict(fields["yes"])):
            self.problems.append(f"{place or 'the object'}: it says yes and no at once")
        return fields

    def _gather(self, fields: dict[str, Any], given: Mapping[str, Any], known: Mapping[str, Any]) -> None:
        """Put fields that stand one level too high into the object that they belong to; count what is left over."""
        over = {key: value for key, value in given.items() if meant(key, known) is None}
        for one, part in known.items():
            inner = self._properties(part)
            if one in fields or not inner:
                continue
            belongs = {key: value for key, value in over.items() if meant(key, inner)}
            there = {meant(key, inner) for key in belongs}
            if belongs and (not _may_be_null(part) or there >= set(self._inner(part).get("required", ()))):
                self.counted["wrapper"] += 1
                fields[one] = belongs
                over = {key: value for key, value in over.items() if key not in belongs}
        if over:
            self.counted["extra field"] += len(over)

    def _review(self, fields: dict[str, Any], part: Mapping[str, Any], place: str) -> None:
        """See that a no says what becomes of the task; a changed one without a thought takes the reason for it.

        Only a null that was written drops a task: one under an unknown name, or a bare act, may be what it becomes.
        """
        task, reason, draft = fields.get("task"), fields.get("reason"), self._properties(part)
        said = as_verdict(fields.get("yes"))
        if said and not isinstance(task, dict | None):  # such as "no change needed", which counts for nothing
            fields["task"] = None
            self.counted["null"] += 1
        elif said is False and fields.get("task", {}) == {}:
            self.problems.append(f"{place}: its task is missing: say the task as it should be, or null where it goes")
        elif isinstance(task, dict) and isinstance(reason, str) and not is_nothing(reason):
            act = task["act"] if isinstance(task.get("act"), dict) else task
            bare = any(meant(key, self._properties(draft["act"])) for key in act)
            if bare and not any(meant(key, draft) == "thought" for key in task):
                fields["task"] = {"thought": reason, **task}
                self.counted["text"] += 1

    def _name_objects(self, fields: dict[str, Any], kind: str, place: str) -> None:
        """Mend names of objects, from their ids where they are missing, and fill in the ids."""
        for one, objects in self.objects.get(kind, {}).items():
            said, key = name_in(fields.get(one)), f"{one}_id"
            number = id_in(fields.get(key))
            by_id = next((name for name, where in objects.items() if where[0] == number), None)
            if id_in(said) is not None:  # an id in the name's place
                number = id_in(said)
                said, by_id = None, next((name for name, where in objects.items() if where[0] == number), None)
            name = mended(said, objects) if isinstance(said, str) else None
            if name is None and by_id is not None and agrees(said, by_id):
                name = by_id
                self.counted["id"] += 1
            elif name is not None and name != fields.get(one):
                self.counted["name"] += 1
            if name is not None:
                fields[one], fields[key] = name, objects[name][0]
            else:
                fields[key] = UNKNOWN if number is None else number

    def _refuse_missing(self, one: str, part: Mapping[str, Any], place: str) -> None:
        """A score that is not there is none: the middle of the scale would be a guess."""
        if part.get("type") in ("number", "integer") and part.get("default") is not None:
            self.problems.append(f"{place}.{one}: it is missing".lstrip("."))

    def _nothing(self, made: dict[str, Any], one: str, part: Mapping[str, Any], place: str) -> None:
        """Take null for nothing: what the field says by default, an empty text or an empty list."""
        kind = part.get("type")
        if kind in ("number", "integer") and part.get("default", _MISSING) is not None:
            made[one] = None  # which validation refuses
        elif "default" in part:
            self.counted["null"] += 1
        elif kind in ("string", "array"):
            self.counted["null"] += 1
            made[one] = "" if kind == "string" else []
        else:
            made[one] = None

    def _inner(self, schema: Mapping[str, Any]) -> Mapping[str, Any]:
        """A schema itself, or the one that it refers to, or the only one that may stand there if not null."""
        options = [one for one in schema.get("anyOf", ()) if one.get("type") != "null"]
        inner: Mapping[str, Any] = options[0] if len(options) == 1 else schema
        return self.schema["$defs"][inner["$ref"].rpartition("/")[2]] if "$ref" in inner else inner

    def _properties(self, schema: Mapping[str, Any]) -> Mapping[str, Any]:
        """The fields of an object, of the one that is referred to, or of the one that may be left out."""
        found: Mapping[str, Any] = self._inner(schema).get("properties", {})
        return found

    def _nested(self, text: str) -> Any:
        """JSON inside a text; None where there is none that can be read."""
        try:
            inside = nested(text)
        except (ValueError, RecursionError):
            return None
        if inside is not None:
            self.counted["wrapper"] += 1
        return inside


def _lists(schema: Mapping[str, Any]) -> list[str]:
    """The lists that an object must have, or else those that it may have."""
    lists = [one for one, part in schema["properties"].items() if part.get("type") == "array"]
    return [one for one in lists if one in schema.get("required", ())] or lists


def _wraps(key: str, value: Any, known: Mapping[str, Any]) -> bool:
    """Whether a field by one of its other names holds an object instead of what belongs there."""
    return key not in known and same(key) in WRAPPERS and isinstance(value, dict)


def _may_be_null(schema: Mapping[str, Any]) -> bool:
    return any(one.get("type") == "null" for one in schema.get("anyOf", ()))


def _is_one_of(value: Any, schema: Mapping[str, Any]) -> bool:
    """Whether a bare value can be the only field that an object needs."""
    if schema.get("type") == "boolean":
        return isinstance(value, bool | str) and as_verdict(value) is not None
    if schema.get("type") in ("number", "integer"):
        most = schema.get("maximum")
        return not isinstance(value, bool) and (not isinstance(value, str) or as_number(value, most) is not None)
    return isinstance(value, str) and schema.get("type") == "string"
