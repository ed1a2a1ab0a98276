"""Every kind of case file: which schema reads which structure, and the JSON Schema that editors use.

A structure brings its own root schema; the kind written at ``structure.kind`` chooses it.
"""

from __future__ import annotations

from typing import Any

from moyai.case.schema_types import Block
from moyai.case.templates import kind_of_file
from moyai.core.kinds import structure_kind, structure_kinds
from moyai.core.options import check_word

_DRAFT = "http://json-schema.org/draft-07/schema#"


def root_schema(kind: str) -> type[Block]:
    """Return the root schema of a structure's case files.

    Parameters
    ----------
    kind : str
        Name of a kind of structure, for instance ``breakwater``.

    Returns
    -------
    type of Block
        The pydantic model of the whole file.

    Raises
    ------
    InputError
        For an unknown kind, or a kind of another package that cannot be loaded.

    Examples
    --------
    >>> from moyai.case import root_schema
    >>> root_schema("member").__name__
    'MemberCase'
    """
    check_word(kind, structure_kinds(), "kind")
    schema: type[Block] = structure_kind(kind).schema()
    return schema


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 7) of all case files, for completion and checks in an editor.

    The root is chosen by ``structure.kind``, so that messages speak of that structure only.

    Returns
    -------
    dict
        For :func:`json.dumps`.

    Examples
    --------
    >>> from moyai.case import json_schema
    >>> json_schema()["required"]
    ['moyai', 'structure']
    """
    definitions: dict[str, Any] = {}
    choices = []
    for kind in structure_kinds():
        whole = root_schema(kind).model_json_schema(by_alias=True, ref_template="#/definitions/{model}")
        parts = whole.pop("$defs", {})
        name = root_schema(kind).__name__
        definitions.update({key: _tidy(part) for key, part in parts.items()})
        definitions[name] = _tidy(whole)
        choices.append(
            {
                "if": {"properties": {"structure": {"properties": {"kind": {"const": kind}}, "required": ["kind"]}}},
                "then": {"$ref": f"#/definitions/{name}"},
            }
        )
    return {
        "$schema": _DRAFT,
        "title": "moyai case file",
        "description": "A structure, its site and its analyses. Plain numbers are SI, headings in degrees.",
        "type": "object",
        "required": ["moyai", "structure"],
        "properties": {
            "moyai": {"const": 1, "description": "Version of the case file format."},
            "structure": {
                "type": "object",
                "required": ["kind"],
                "properties": {"kind": {"enum": list(structure_kinds()), "description": "Kind of structure."}},
            },
        },
        "allOf": choices,
        "definitions": definitions,
    }


def file_json_schema(name: str) -> dict[str, Any]:
    """Return the JSON Schema (draft 7) of one kind of file: a structure, or a file of ``measure``, ``study``, ``fit``.

    Raises
    ------
    InputError
        For an unknown kind.
    """
    whole = kind_of_file(name).file_schema(name).model_json_schema(by_alias=True, ref_template="#/definitions/{model}")
    definitions = {key: _tidy(part) for key, part in whole.pop("$defs", {}).items()}
    return {"$schema": _DRAFT, "title": f"moyai: {name}", **_tidy(whole), "definitions": definitions}


def _tidy(node: Any) -> Any:
    """Return a node as editors understand it best.

    A choice by a key (pydantic's ``discriminator``) becomes ``if``/``then``, so that a fault is reported against the
    chosen form alone; ``null`` goes, since a key without value is a fault; ranges join the descriptions.
    """
    if isinstance(node, list):
        return [_tidy(item) for item in node]
    if not isinstance(node, dict):
        return node
    out = {key: _tidy(value) for key, value in node.items()}
    # Keys of a block are names of the user's choice where they stand under "properties"
    if "discriminator" in node and isinstance(node["discriminator"], dict) and "mapping" in node["discriminator"]:
        out = {**{key: value for key, value in out.items() if key not in ("oneOf", "discriminator")}, **_choice(node)}
    forms = out.get("anyOf")
    if isinstance(forms, list) and {"type": "null"} in forms:
        kept = [form for form in forms if form != {"type": "null"}]
        del out["anyOf"]
        out = {**kept[0], **out} if len(kept) == 1 else {**out, "anyOf": kept}
    if out.get("default", 0) is None:
        del out["default"]
    if isinstance(out.get("title"), str):
        # Titles made of key names only repeat them
        del out["title"]
    if isinstance(out.get("unit"), str) and "anyOf" in out:
        out = _say_unit(out)
    if "$ref" in out and len(out) > 1:
        # Draft 7 overlooks what stands next to a reference
        out["allOf"] = [*out.get("allOf", []), {"$ref": out.pop("$ref")}]
    if "prefixItems" in out:
        out["items"] = out.pop("prefixItems")
    return out


def _choice(node: dict[str, Any]) -> dict[str, Any]:
    key = node["discriminator"]["propertyName"]
    mapping = node["discriminator"]["mapping"]
    return {
        "type": "object",
        "required": [key],
        "properties": {key: {"enum": list(mapping)}},
        "allOf": [
            {"if": {"properties": {key: {"const": value}}, "required": [key]}, "then": {"$ref": reference}}
            for value, reference in mapping.items()
        ],
    }


def _say_unit(node: dict[str, Any]) -> dict[str, Any]:
    unit, limits = node.pop("unit"), node.pop("range", "")
    facts = [f"plain numbers in {unit}" if unit else "", limits]
    said = "; ".join(fact for fact in facts if fact)
    if said:
        node["description"] = f"{node.get('description', '')} [{said}]".strip()
    return node
