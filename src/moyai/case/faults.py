"""From pydantic's errors to faults in plain words: where, what, what is allowed, what was probably meant."""

from __future__ import annotations

import copy
import difflib
import typing
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from pydantic import ValidationError

from moyai.case.schema_types import Block, Notes, QuantityOf
from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted
from moyai.core.errors import Fault
from moyai.core.units import plain_text

#: Most keys of the other forms of a block that are listed
_MOST_FORMS = 5
# What engineers call a key elsewhere, where the spelling alone would not lead to it
_SYNONYMS = {
    "width": "beam", "breadth": "beam", "draft": "draught", "weight": "mass", "displacement": "mass",
    "hs": "significant_height", "hm0": "significant_height", "h13": "significant_height", "tp": "peak_period",
    "t13": "significant_period", "gamma": "peak_enhancement", "h": "height", "t": "period",
    "kg": "centre_of_gravity_above_keel",
    "g": "gravity", "rho": "density", "depth": "water_depth", "ea": "axial_stiffness", "mbl": "breaking_load",
    "type": "kind", "number": "count", "direction": "heading_deg", "angle": "heading_deg",
    "radius_of_gyration": "roll_gyradius",
    "gyradius": "roll_gyradius", "moorings": "lines", "mooring": "lines", "cd": "current_drag_coefficient",
    "viscosity": "kinematic_viscosity", "nu": "kinematic_viscosity",
    "zeta": "fraction_of_critical", "levels": "water_levels", "environment": "site",
}  # fmt: skip


def did_you_mean(word: str, candidates: Iterable[str]) -> str:
    """Return ``did you mean 'x'?`` for the nearest candidate, or an empty string."""
    found = nearest(word, candidates)
    return f"did you mean '{found}'?" if found else ""


def nearest(word: str, candidates: Iterable[str]) -> str:
    """Return the candidate that ``word`` most likely stands for, or an empty string."""
    names = list(candidates)
    folded = {name.lower().replace("-", "_"): name for name in names}
    plain = str(word).strip().lower().replace("-", "_").replace(" ", "_")
    if plain in folded:
        return folded[plain]
    if _SYNONYMS.get(plain) in names:
        return _SYNONYMS[plain]
    close = difflib.get_close_matches(plain, folded, n=1, cutoff=0.6)
    return folded[close[0]] if close else ""


def data_path(location: tuple[str | int, ...], data: Any) -> KeyPath:
    """Return the path in the file of pydantic's ``location``, which also names forms of choices."""
    path: list[str | int] = []
    current = data
    for index, item in enumerate(location):
        if isinstance(item, str) and item.startswith(("<", "[")):
            continue
        inside = (isinstance(current, dict) and item in current) or (
            isinstance(current, list) and isinstance(item, int) and item < len(current)
        )
        if inside:
            current = current[item]
            path.append(item)
        elif index == len(location) - 1 and isinstance(current, (dict, list)) and type(item) is _key_type(current):
            path.append(item)
    return tuple(path)


def _key_type(container: Any) -> type:
    return str if isinstance(container, dict) else int


def value_at(data: Any, path: KeyPath) -> Any:
    """Return the value at ``path``, ``None`` where there is none."""
    for item in path:
        try:
            data = data[item]
        except (KeyError, IndexError, TypeError):
            return None
    return data


class FaultTranslator:
    """Turns the errors of one validation into faults, and corrects the data so that later checks can still run."""

    def __init__(self, document: CaseDocument, notes: Notes, root: type[Block]) -> None:
        self.document = document
        self.notes = notes
        self.root = root
        self.faults: list[Fault] = []
        self.renamed: dict[KeyPath, str] = {}
        self.dropped: list[KeyPath] = []
        self.repairable = True

    def translate(self, error: ValidationError | None) -> list[Fault]:
        """Return all faults, in the order of the file."""
        items = [] if error is None else error.errors(include_url=False)
        paths = [data_path(item["loc"], self.document.data) for item in items]
        # Unknown keys first: one that is a misspelt required key explains why that one is missing
        for item, path in zip(items, paths):
            if item["type"] == "extra_forbidden":
                self._unknown_key(path)
        meant = {(*path[:-1], name) for path, name in self.renamed.items()}
        for item, path in zip(items, paths):
            if (item["type"] == "missing" and path in meant) or self._explained(item, path):
                continue
            if item["type"] != "extra_forbidden":
                self.faults.append(self._fault(item, path))
                self._note_repair(item["type"], path)
        self._faults_between_keys(meant)
        return sorted(dict.fromkeys(self.faults), key=lambda fault: (fault.line, fault.column))

    def _explained(self, item: Mapping[str, Any], path: KeyPath) -> bool:
        """Whether a list counts as too short only because faulty entries, reported apart, were left out."""
        value = value_at(self.document.data, path)
        return bool(item["type"] == "too_short" and len(value or ()) >= item["ctx"]["min_length"])

    def _faults_between_keys(self, meant: set[KeyPath]) -> None:
        places = {id(block): path for path, block in _blocks(self.document.data, ())}
        for block, key, message, remedy in self.notes.faults:
            path = places.get(block)
            if path is None:
                # A single block that stands for a list of one keeps its identity; anything else is not in the file
                continue
            if not key and any(name[:-1] == path and f"'{name[-1]}'" in message for name in meant):
                continue
            where = (*path, key) if key else path
            self.faults.append(self.document.fault(where, message, remedy=remedy, of_key=True))
            self.repairable = False

    def _unknown_key(self, path: KeyPath) -> None:
        key = str(path[-1])
        block = value_at(self.document.data, path[:-1])
        model = self.notes.models.get(id(block))
        allowed = model.key_names() if model else ()
        found = nearest(key, [name for name in allowed if name not in block])
        if found:
            remedy = f"did you mean '{found}'?"
            self.renamed[path] = found
        else:
            self.dropped.append(path)
            here = dotted(tuple(step for step in path[:-1] if isinstance(step, str)))
            places = places_of_keys(self.root)
            elsewhere = places.get(key, {})
            forms = [name for name, homes in places.items() if here in homes and name not in allowed]
            if ":" in key or "=" in key:
                remedy = "a space belongs behind ':'"
            elif nearest(key, allowed) and allowed:
                remedy = f"'{nearest(key, allowed)}' is given already"
            elif elsewhere.get(here):
                remedy = f"'{key}' is for 'kind: {elsewhere[here]}'"
            elif len(elsewhere) == 1 and here not in elsewhere:
                remedy = f"'{key}' belongs under '{next(iter(elsewhere))}'"
            elif 0 < len(forms) <= _MOST_FORMS:
                remedy = f"another form of '{here}' has {', '.join(repr(name) for name in forms)}"
            else:
                remedy = ""
        listed = ", ".join(allowed) if len(allowed) <= 25 and not found else ""
        self.faults.append(
            self.document.fault(path, f"unknown key '{key}'", allowed=listed, remedy=remedy, of_key=True)
        )

    def _note_repair(self, kind: str, path: KeyPath) -> None:
        """Remember a wrong value of an optional key as one that can be left out; others end the repair."""
        block = value_at(self.document.data, path[:-1])
        model = self.notes.models.get(id(block))
        name = path[-1] if path else None
        field = next((f for key, f in model.model_fields.items() if name in (key, f.alias)), None) if model else None
        grouped = model is not None and any(name in group for group in (*model.exactly_one, *model.at_least_one))
        if kind == "missing" or field is None or field.is_required() or grouped:
            self.repairable = False
        else:
            self.dropped.append(path)

    def repaired(self) -> Any:
        """Return a copy of the data with misspelt keys renamed and wrong optional ones left out, or ``None``."""
        if not self.repairable:
            return None
        data = copy.deepcopy(self.document.data)
        for path, name in self.renamed.items():
            block = value_at(data, path[:-1])
            block[name] = block.pop(path[-1])
            target = (*path[:-1], name)
            for table in (self.document.keys, self.document.values):
                for known in [known for known in table if known[: len(path)] == path]:
                    table[(*target, *known[len(path) :])] = table[known]
        for path in self.dropped:
            block = value_at(data, path[:-1])
            if isinstance(block, dict):
                block.pop(path[-1], None)
        return data

    def _fault(self, item: Mapping[str, Any], path: KeyPath) -> Fault:
        kind, context = item["type"], item.get("ctx", {})
        value = value_at(self.document.data, path)
        fault = self.document.fault
        if kind == "moyai":
            return fault(path, context["message"], allowed=context["allowed"], remedy=context["remedy"])
        if kind == "missing":
            return self._missing(path)
        if kind == "union_tag_invalid":
            # A form chosen by a function, not by a key of the schema, is chosen by 'kind' all the same
            key = "kind" if "()" in context["discriminator"] else context["discriminator"].strip("'")
            choices = [choice.strip(" '<>") for choice in context["expected_tags"].split(",")]
            return self._not_among((*path, key), context["tag"].strip("<>"), choices)
        if kind == "union_tag_not_found":
            key = context["discriminator"].strip("'")
            if isinstance(value, dict):
                options = ", ".join(self._choices(path, key))
                return fault((*path, key), f"the key '{key}' is missing", allowed=options, of_key=True)
            return fault(path, f"expected a block of keys; got {_shown(value)}")
        if kind == "literal_error":
            choices = [choice.strip(" '") for choice in context["expected"].replace(" or ", ",").split(",")]
            return self._not_among(path, value, choices)
        if kind in ("model_type", "dict_type", "model_attributes_type"):
            return fault(path, f"expected a block of keys; got {_shown(value)}")
        if kind in ("tuple_type", "list_type"):
            return fault(path, f"expected a list; got {_shown(value)}", remedy="write it in brackets: [...]")
        if kind in ("too_short", "too_long"):
            return self._wrong_count(kind, path, context, value)
        message, allowed = _PLAIN.get(kind, (None, ""))
        if message is None:
            return fault(path, str(item["msg"]))
        limits = {name: text for name, text in context.items() if name in ("ge", "le", "gt", "lt")}
        allowed = allowed.format(**context) if context and "{" in allowed else allowed
        remedy = did_you_mean(str(value), ["true", "false"]) if kind == "bool_type" else ""
        if kind == "int_type" and isinstance(value, str) and plain_text(value).isdigit():
            remedy = f"write {plain_text(value)}, without quotes and with half-width digits"
        if kind == "bool_type" and not remedy:
            remedy = _truth_meant(value)
        return fault(path, message.format(value=_shown(value), **limits), allowed=allowed, remedy=remedy)

    def _wrong_count(self, kind: str, path: KeyPath, context: Mapping[str, Any], value: Any) -> Fault:
        count = len(value) if isinstance(value, (list, dict)) else 0
        what = "block" if isinstance(value, dict) else "list"
        limit = context.get("min_length" if kind == "too_short" else "max_length", 1)
        message = f"the {what} is empty" if not count else f"the {what} has {count} entries"
        bound = "at least" if kind == "too_short" else "at most"
        return self.document.fault(path, message, allowed=f"{bound} {limit} entr{'y' if limit == 1 else 'ies'}")

    def _choices(self, path: KeyPath, key: str) -> list[str]:
        """Return what ``key`` may be in the block at ``path``, whose form it chooses."""
        names = [name for name in path if isinstance(name, str)]
        parent = (
            self.notes.models.get(id(value_at(self.document.data, path[: path.index(names[-1])]))) if names else None
        )
        field = (
            next((f for name, f in parent.model_fields.items() if names[-1] in (name, f.alias)), None)
            if parent
            else None
        )
        found: list[str] = []
        for model in _models_in(field.annotation) if field else ():
            if key in model.model_fields:
                found.extend(str(choice) for choice in typing.get_args(model.model_fields[key].annotation))
        return found

    def _missing(self, path: KeyPath) -> Fault:
        name = path[-1]
        if isinstance(name, int):
            row = value_at(self.document.data, path[:-1])
            count = len(row) if isinstance(row, list) else 0
            return self.document.fault(path[:-1], f"the list has {count} value(s)", allowed=f"at least {name + 1}")
        block = value_at(self.document.data, path[:-1])
        model = self.notes.models.get(id(block))
        field = next((f for key, f in model.model_fields.items() if name in (key, f.alias)), None) if model else None
        remedy = ""
        if field is not None:
            described = (field.description or "").rstrip(".")
            example = next(
                (f", for instance '{m.example}'" for m in field.metadata if isinstance(m, QuantityOf) and m.example), ""
            )
            remedy = f"give it: {described}{example}" if described else ""
        return self.document.fault(path, f"the key '{name}' is missing", remedy=remedy, of_key=True)

    def _not_among(self, path: KeyPath, value: Any, choices: list[str]) -> Fault:
        remedy = did_you_mean(str(value), choices)
        if choices == ["1"] and path == ("moyai",):
            remedy = "this program reads version 1; a newer file needs a newer program"
        return self.document.fault(
            path, f"{_shown(value)} is not known here", allowed=", ".join(choices), remedy=remedy
        )


_PLAIN: dict[str, tuple[str, str]] = {
    "int_type": ("expected a whole number; got {value}", ""),
    "int_from_float": ("expected a whole number; got {value}", ""),
    "greater_than_equal": ("{value} is out of range", "at least {ge}"),
    "less_than_equal": ("{value} is out of range", "at most {le}"),
    "bool_type": ("expected true or false; got {value}", ""),
    "string_type": ("expected text; got {value}", "text, in quotes where it looks like a number"),
    "string_too_short": ("the text is empty", "at least one character"),
    "string_too_long": ("the text is too long", "at most {max_length} characters"),
}


def _truth_meant(value: Any) -> str:
    folded = str(value).lower()
    if folded in ("yes", "on", "y"):
        return "did you mean 'true'?"
    return "did you mean 'false'?" if folded in ("no", "off", "n") else ""


def _shown(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a block of keys"
    if isinstance(value, list):
        return "a list"
    text = " ".join(str(value).split())
    return f"'{text if len(text) <= 60 else text[:57] + '...'}'"


def _blocks(data: Any, path: KeyPath) -> Iterable[tuple[KeyPath, Any]]:
    if isinstance(data, dict):
        yield path, data
        for key, value in data.items():
            yield from _blocks(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from _blocks(value, (*path, index))


@cache
def places_of_keys(root: type[Block]) -> dict[str, dict[str, str]]:
    """Return for every key the blocks of a case file that it may stand in, each with the ``kind`` that has it there."""
    found: dict[str, dict[str, str]] = {}

    def walk(model: type[Block], path: KeyPath, kind: str) -> None:
        own = typing.get_args(model.model_fields["kind"].annotation) if "kind" in model.model_fields else ()
        kind = str(own[0]) if len(own) == 1 and path != ("structure",) else kind
        for name, field in model.model_fields.items():
            key = field.alias or name
            if path:
                found.setdefault(key, {}).setdefault(dotted(path), kind)
            for inner in _models_in(field.annotation):
                if len(path) < 6:
                    walk(inner, (*path, key), kind)

    walk(root, (), "")
    return found


def _models_in(annotation: Any) -> Iterable[type[Block]]:
    if isinstance(annotation, type) and issubclass(annotation, Block):
        yield annotation
    for part in typing.get_args(annotation):
        yield from _models_in(part)
