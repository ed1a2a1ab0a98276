"""The form of a case, made from the JSON Schema of its kind and from what its file holds.

A block becomes a group, a scalar of the file a field, an absent key an entry of the list of what can be added.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from moyai.case.yaml_reader import KeyPath, dotted
from moyai.language import said, spoken_language

_MOST_ENTRIES = 60
_DEEPEST = 8
_RULES = ("required", "properties")

Node = dict[str, Any]


def form_of(data: Any, kind: str) -> dict[str, Any]:
    """Return the form of a case as a tree of groups.

    Parameters
    ----------
    data : object
        Content of the file as read.
    kind : str
        Kind of structure.

    Returns
    -------
    dict
        ``path``, ``label``, ``help``, ``entries`` (fields and groups), ``absent`` (keys that can be added, each with
        a value to start with); a field has ``type`` (``number``, ``text``, ``choice``, ``truth``), ``value``,
        ``choices``, ``removable``.
    """
    from moyai.case.schema import root_schema

    name = root_schema(kind).__name__
    return _group({"$ref": f"#/definitions/{name}"}, data, (), said("The case"), removable=False)


@cache
def _definitions() -> dict[str, Any]:
    from moyai.case.schema import json_schema

    return dict(json_schema()["definitions"])


def _group(node: Node, value: Any, path: KeyPath, label: str, *, removable: bool) -> dict[str, Any]:
    schema = _fitting(node, value)
    group: dict[str, Any] = {
        "path": list(path),
        "dotted": dotted(path),
        "label": label,
        "help": _help_of(schema.get("description", "")),
        "removable": removable,
        "entries": [],
        "absent": [],
    }
    if len(path) > _DEEPEST:
        return group
    if isinstance(value, list):
        shown = value[:_MOST_ENTRIES]
        inner = schema.get("items", {})
        for place, item in enumerate(shown):
            part = inner[min(place, len(inner) - 1)] if isinstance(inner, list) and inner else inner
            group["entries"].append(_entry(part or {}, item, (*path, place), _entry_name(item, place), len(value) > 1))
        group["more"] = len(value) - len(shown)
        return group
    known = schema.get("properties", {})
    needed = set(schema.get("required", ()))
    extra = schema.get("additionalProperties")
    for key, item in value.items():
        if not path and key == "moyai":
            continue  # the version of the format is no choice of the user
        part = known.get(key, extra if isinstance(extra, dict) else {})
        free = key not in needed and len(value) > 1
        group["entries"].append(_entry(part, item, (*path, key), _words(key), free))
    missing = [key for key in known if key not in value]
    before = list(known)
    for key in missing:
        start = start_of(known[key])
        if start is not None:
            after = next((one for one in reversed(before[: before.index(key)]) if one in value), "")
            words = _help_of(_plain(_fitting(known[key], start).get("description", "")))
            group["absent"].append({"key": key, "help": words, "start": start, "after": after})
    return group


def _entry(node: Node, value: Any, path: KeyPath, label: str, removable: bool) -> dict[str, Any]:
    if isinstance(value, dict | list):
        return _group(node, value, path, label, removable=removable)
    forms = _forms(node)
    choices = [str(word) for form in forms for word in (*form.get("enum", ()), *_const(form))]
    types = {form.get("type") for form in forms if "enum" not in form and "const" not in form}
    numeric = {"number", "integer"} & types
    if isinstance(value, bool) or types == {"boolean"}:
        kind = "truth" if isinstance(value, bool) else "text"
    elif choices and not types & {"number", "integer", "string"}:
        kind = "choice"
    else:
        kind = "number" if numeric else "text"
    return {
        "path": list(path),
        "dotted": dotted(path),
        "label": label,
        "help": _help_of(_plain(_described(node, forms))),
        "removable": removable,
        "type": kind,
        "value": value if isinstance(value, bool | str) or value is None else _digits(value),
        "choices": choices,
        "quoted": kind == "text" and not choices and isinstance(value, str),
    }


def _digits(value: Any) -> str:
    return f"{value:.15g}" if isinstance(value, float) else str(value)


def _described(node: Node, forms: list[Node]) -> str:
    return node.get("description") or next((form["description"] for form in forms if form.get("description")), "")


def _const(form: Node) -> tuple[Any, ...]:
    return (form["const"],) if "const" in form else ()


def _entry_name(item: Any, place: int) -> str:
    name = item.get("name") if isinstance(item, dict) else None
    return str(name) if name else str(place + 1)


def _words(key: Any) -> str:
    """Return a key as words; in another language as it stands in the file, with its meaning in the help."""
    if spoken_language() != "en":
        return str(key)
    words = str(key).removesuffix("_deg").replace("_", " ")
    return words[:1].upper() + words[1:]


def _plain(words: str) -> str:
    return re.sub(r"\s+", " ", words.replace("`", "")).strip()


def _help_of(words: str) -> str:
    """Return a help in the language in force, the range in brackets behind it for itself."""
    text, bracket, range_ = words.removesuffix("]").rpartition("[") if words.endswith("]") else (words, "", "")
    return " ".join(filter(None, (said(text.strip()), f"[{said(range_)}]" if bracket else "")))


def _forms(node: Node) -> list[Node]:
    """Return every form that a node may take, references followed."""
    if "$ref" in node:
        return _forms({**_definitions()[node["$ref"].rsplit("/", 1)[1]], **_but(node, "$ref")})
    for key in ("anyOf", "oneOf"):
        parts = [part for part in node.get(key, ()) if set(part) - {"required"}]
        if parts:
            return [form for part in parts for form in _forms(part)]
    if "else" in node and node.get("if") == {"type": "array"}:
        return [*_forms(node["then"]), *_forms(node["else"])]
    parts = [part for part in node.get("allOf", ()) if "$ref" in part]
    if parts and "properties" not in node:
        return [form for part in parts for form in _forms({**part, **_but(node, "allOf")})]
    return [node]


def _but(node: Node, *keys: str) -> Node:
    return {key: value for key, value in node.items() if key not in keys}


def _fitting(node: Node, value: Any) -> Node:
    """Return the form of a node that a value takes, with the keys that its choices bring."""
    forms = _forms(node)
    wanted = "object" if isinstance(value, dict) else "array" if isinstance(value, list) else None
    of_type = [form for form in forms if wanted is None or form.get("type", wanted) == wanted] or [{}]
    whole = [_chosen(form, value) for form in of_type]
    best = max(whole, key=lambda form: _fit(form, value))
    return {**best, "description": node.get("description") or best.get("description", "")}


def _chosen(form: Node, value: Any) -> Node:
    """Return a form with what ``if`` and ``then`` add for this value."""
    for part in form.get("allOf", ()):
        if "if" in part and isinstance(value, dict) and _holds(part["if"], value):
            key = next(iter(part["if"]["properties"]))
            then = _fitting(part["then"], value)
            choices = form.get("properties", {}).get(key, {})
            kept = {**then.get("properties", {}), key: {**then.get("properties", {}).get(key, {}), **choices}}
            kept[key].pop("const", None)
            return {**then, "properties": kept}
    return form


def _holds(condition: Node, value: dict[str, Any]) -> bool:
    return all(value.get(key) == part.get("const") for key, part in condition.get("properties", {}).items())


def _fit(form: Node, value: Any) -> int:
    """Return how well a form fits: choices of its keys first, then the keys that it knows."""
    if not isinstance(value, dict):
        return 0
    known = form.get("properties", {})
    score = 0
    for key, item in value.items():
        if key not in known:
            score -= 0 if isinstance(form.get("additionalProperties"), dict) else 3
            continue
        allowed = [word for one in _forms(known[key]) for word in (*one.get("enum", ()), *_const(one))]
        plain = any("type" in one and "enum" not in one and "const" not in one for one in _forms(known[key]))
        score += 1 if not allowed or plain or item in allowed else -20
    return score - sum(key not in value for key in form.get("required", ()))


def start_of(node: Node, depth: int = 0) -> Any:
    """Return a value that a key of this schema can start with; None where there is no sensible one."""
    if node.get("default") not in (None, [], {}):
        return node["default"]
    if node.get("examples"):
        return node["examples"][0]
    for form in _forms(node):
        found = _start_of_form(form, depth)
        if found is not None:
            return found
    return None


def _start_of_form(form: Node, depth: int) -> Any:
    if form.get("examples"):
        return form["examples"][0]
    for key in ("default", "const"):
        if form.get(key) not in (None, [], {}):
            return form[key]
    if form.get("enum"):
        return form["enum"][0]
    kind = form.get("type")
    if kind in ("number", "integer"):
        # A number with a unit says more: it is another form of the same key
        return form.get("minimum", 1) if kind == "integer" else None
    if kind == "boolean":
        return True
    if kind == "object" and depth < 4:
        return _start_of_block(form, depth)
    if kind == "array" and depth < 4 and isinstance(form.get("items"), dict):
        inner = start_of(form["items"], depth + 1)
        return None if inner is None else [inner] * max(1, form.get("minItems", 1))
    return "name" if kind == "string" and "pattern" not in form else None


def _start_of_block(form: Node, depth: int) -> Any:
    first = next((part["then"] for part in form.get("allOf", ()) if "if" in part), None)
    if first is not None:
        return start_of(first, depth)
    known = form.get("properties", {})
    keys = list(form.get("required", ()))
    for part in form.get("allOf", ()):
        for rule in (*part.get("oneOf", ()), *part.get("anyOf", ()))[:1]:
            keys += [key for key in rule.get("required", ()) if key not in keys]
    starts = {key: start_of(known[key], depth + 1) for key in keys if key in known}
    if any(value is None for value in starts.values()):
        return None
    if not starts:
        # A block without needed keys starts with the first that has a value
        found = ((key, start_of(part, depth + 1)) for key, part in known.items())
        starts = dict([next(((key, value) for key, value in found if value is not None), ("", None))])
    return None if None in starts.values() else starts
