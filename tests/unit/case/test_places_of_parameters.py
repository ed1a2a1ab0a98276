"""Physics names parameters of its calls; the case file finds the key and the line that they came from."""

import pytest

import moyai
from moyai.case.faults import places_of_keys
from moyai.case.findings import KEYS
from moyai.core.errors import InputError
from moyai.core.kinds import structure_kind, structure_kinds

CASE = moyai.load_case(moyai.template("breakwater"))


def line_of(text):
    """Number of the line of the template that begins with a text."""
    return 1 + next(k for k, line in enumerate(CASE.text.splitlines()) if line.strip().startswith(text))


@pytest.mark.parametrize("kind", structure_kinds())
def test_every_parameter_leads_to_a_key_of_the_schema(kind):
    places = places_of_keys(structure_kind(kind).schema())
    roots = {name for found in places.values() for place in found for name in place.split(".")[:1]}
    for key in (KEYS | structure_kind(kind).keys()).values():
        block, _, name = key.rpartition(".")
        assert (block in places.get(name, ())) if block else (name in roots), key


@pytest.mark.parametrize(
    ("parameter", "key", "line"),
    [
        ("draught", "structure.draught", "draught:"),
        ("water_depth", "site.water_depth", "water_depth:"),
        ("lines[0].anchor", "lines[0].anchor", "anchor:"),
        # of a key that the file leaves out, the block that lacks it
        ("lines.seaward.bed_friction", "lines[0].bed_friction", "- name: seaward"),
        ("lines.seaward.anchor", "lines[0].anchor", "anchor:"),
        ("breakwater", "structure", "kind: breakwater"),
    ],
)
def test_an_error_of_a_run_gets_key_and_line(parameter, key, line):
    found = CASE.located(InputError("too large", parameter=parameter, allowed="at most 1", remedy="make it smaller"))
    assert (found.fault.path, found.fault.line) == (key, line_of(line))
    assert str(found).endswith(f"{key}: too large; allowed: at most 1; make it smaller")
    assert f":{found.fault.line}:" in str(found)


def test_what_no_key_gives_stays_as_it_is():
    error = InputError("too large", parameter="frequency_step")
    assert CASE.located(error) is error


def test_a_run_raises_at_the_line(monkeypatch):
    def refuse(*_):
        raise InputError("the unit capsizes", parameter="mass")

    monkeypatch.setattr(structure_kind("breakwater"), "run", refuse)
    with pytest.raises(InputError, match=r":\d+:\d+: structure\.mass: the unit capsizes$"):
        moyai.run(CASE)
