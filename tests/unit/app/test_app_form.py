"""The form of a case: every scalar of the file is a field; what it offers to add can be added."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from moyai.case.form import form_of
from moyai.case.templates import template
from moyai.case.text_changes import with_key
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import InputError

TEMPLATES = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member")


def parts(group: dict[str, Any]) -> Iterator[dict[str, Any]]:
    yield group
    for entry in group["entries"]:
        yield from parts(entry) if "entries" in entry else (entry,)


def kind_of(name: str) -> str:
    return "cage" if name == "rigid_cage" else name


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_scalar_of_the_file_is_a_field_with_help(name: str) -> None:
    data = parse_yaml(template(name)).data
    found = {tuple(one["path"]): one for one in parts(form_of(data, kind_of(name)))}

    def scalars(value: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
        if isinstance(value, dict | list):
            for key, item in value.items() if isinstance(value, dict) else enumerate(value):
                yield from scalars(item, (*path, key))
        else:
            yield path

    every = [path for path in scalars(data, ()) if path != ("moyai",)]
    assert all(path in found and "type" in found[path] for path in every)
    named = [path for path in every if isinstance(path[-1], str)]
    unexplained = [path for path in named if not found[path]["help"] and not found[path]["choices"]]
    assert len(unexplained) <= 0.1 * len(named), unexplained


@pytest.mark.slow
@pytest.mark.parametrize("name", TEMPLATES)
def test_what_is_offered_can_be_added_alone(name: str) -> None:
    document = parse_yaml(template(name))
    added = 0
    for group in parts(form_of(document.data, kind_of(name))):
        for one in group.get("absent", ()):
            try:
                changed = with_key(document, (*group["path"], one["key"]), one["start"], after=one["after"])
            except InputError as error:
                raise AssertionError((group["dotted"], one)) from error
            added += 1
            lines = changed.text.splitlines()
            old = document.text.splitlines()
            kept = sum(line in lines for line in old)
            assert kept >= len(old) - 1
    assert added > 20


def test_choices_truths_and_units() -> None:
    document = parse_yaml(template("breakwater"))
    found = {one["dotted"]: one for one in parts(form_of(document.data, "breakwater"))}
    assert found["structure.kind"]["type"] == "choice"
    shape = found["structure.section.shape"]
    assert shape["type"] == "choice" and "circle" in shape["choices"]
    assert found["structure.draught"]["type"] == "number"
    assert found["structure.draught"]["value"] == document.data["structure"]["draught"]
    assert found["structure.draught"]["help"].startswith("Draught")
    assert not found["site.gravity"]["removable"]
    truth = form_of(
        {"structure": {"kind": "breakwater"}, "settings": {"drift": False, "sensitivity": {}}}, "breakwater"
    )
    settings = next(one for one in truth["entries"] if one["dotted"] == "settings")
    assert settings["entries"][0]["type"] == "truth" and settings["entries"][0]["removable"]


def test_a_sea_that_stands_alone_has_its_fields() -> None:
    sea = {"name": "a", "kind": "regular", "height": "1 m", "period": "6 s", "heading_deg": 0}
    form = form_of({"waves": sea, "structure": {"kind": "breakwater"}}, "breakwater")
    waves = next(one for one in form["entries"] if one["dotted"] == "waves")
    kinds = {one["label"]: one["type"] for one in waves["entries"]}
    assert kinds["Kind"] == "choice" and kinds["Height"] == "number" and kinds["Name"] == "text"


@pytest.mark.parametrize("data", [{}, {"structure": 1}, {"waves": [1, {}, []]}, {"lines": {"a": [None]}}, {"x": None}])
def test_a_faulty_case_has_a_form_too(data: Any) -> None:
    for kind in ("breakwater", "curtain", "cage", "network", "member"):
        assert form_of(data, kind)["absent"]
