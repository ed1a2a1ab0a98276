"""The JSON Schema for editors: valid itself, complete, and of one mind with the reader."""
# ruff: noqa: E501  (one variation a line reads best)

import json

import pytest
from case_files import changed, faults
from pydantic import TypeAdapter, ValidationError

from moyai.case.schema import json_schema, root_schema
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.kinds import structure_kinds


@pytest.fixture(scope="module")
def schema():
    return json_schema()


@pytest.fixture(scope="module")
def validator(schema):
    """An independent validator of JSON Schema."""
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; '.[test]' brings it")
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def blocks(node, path=""):
    """Every schema node that describes a block of keys."""
    if isinstance(node, dict):
        if "additionalProperties" in node and "properties" in node:
            yield path, node
        for key, value in node.items():
            yield from blocks(value, f"{path}/{key}")
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from blocks(value, f"{path}/{index}")


def test_every_key_is_described_and_unknown_keys_are_refused(schema):
    found = list(blocks(schema))
    assert len(found) > 25
    for path, node in found:
        assert node["additionalProperties"] is False or path.endswith("water_levels"), path
        assert node.get("description"), path
        for key, entry in node["properties"].items():
            referenced = schema["definitions"].get(entry.get("$ref", "").removeprefix("#/definitions/"), {})
            assert entry.get("description") or referenced.get("description"), f"{path}: {key}"


def test_quantities_state_their_unit_and_range(schema):
    structure = schema["definitions"]["BreakwaterStructure"]["properties"]
    assert structure["length"]["description"].endswith("[plain numbers in m; greater than 0 m]")
    assert {"type": "number", "exclusiveMinimum": 0.0} in structure["length"]["anyOf"]
    depth = schema["definitions"]["SiteKeys"]["properties"]["water_depth"]
    assert {"enum": ["infinite"]} in depth["anyOf"]


def test_every_reference_leads_somewhere_and_stands_alone(schema):
    text = json.dumps(schema)
    assert "$defs" not in text
    assert "prefixItems" not in text
    assert '"discriminator"' not in text

    def walk(node):
        if isinstance(node, dict):
            if "$ref" in node:
                assert node.keys() == {"$ref"}
                assert node["$ref"].removeprefix("#/definitions/") in schema["definitions"]
            for value in node.values():
                walk(value)
        elif isinstance(node, list):
            for value in node:
                walk(value)

    walk(schema)


@pytest.mark.parametrize("kind", structure_kinds())
def test_the_templates_fit_the_schema_and_the_reader(validator, kind):
    assert list(validator.iter_errors(parse_yaml(template(kind)).data)) == []


@pytest.mark.parametrize("kind", structure_kinds())
def test_the_templates_are_plain_ascii_and_without_faults(kind):
    text = template(kind)
    assert text.isascii()
    assert max(len(line) for line in text.splitlines()) <= 130
    assert faults(text) == []


def test_the_examples_fit_the_schema(validator, request):
    files = sorted((request.config.rootpath / "examples").glob("*.yaml"))
    assert files
    for file in files:
        assert list(validator.iter_errors(parse_yaml(file.read_text(encoding="utf-8")).data)) == [], file


@pytest.mark.parametrize(
    "change",
    [
        ("draught: 3 m", "draugth: 3 m"),
        ("water_depth: 10 m", "water_depth: -10"),
        ("water_depth: 10 m", "water_depth: shallow"),
        ("periods: [4, 5, 6]", "periods: []"),
        ("periods: [4, 5, 6]", "periods: [4]\n    period: 5 s"),
        ("heading_deg: 10", "heading_deg: 10\n    from_bearing_deg: 70"),
        ("    heading_deg: 10\n", ""),
        ("kind: jonswap", "kind: jonswop"),
        ("peak_enhancement: 3.3", "peak_enhancement: 33"),
        ("shape: rectangle", "shape: circle"),
        ("structure:\n  kind: breakwater", "structure:\n  kind: curtin"),
        ("  draught: 3 m\n", ""),
        ("roll_gyradius: 2.67 m", "roll_gyradius: 2.67 m\n  roll_inertia: 3"),
        ("modes: [sway, heave, roll]", "modes: [pitch]"),
        ("count: 2", "count: 0"),
        ("{catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}", "{length: 54.0 m, axial_stiffness: 1e8}"),
        ("analyses: [statics", "analyses: [statik"),
        ("moyai: 1", "moyai: 2"),
        ("current: {speed: 0.3 m/s,", "current: {profile: {table: []},"),
        ("analyses:", "settings: {drift: no}\nanalyses:"),
    ],
)
def test_schema_and_reader_refuse_the_same(validator, change):
    text = changed(change)
    assert faults(text)
    assert list(validator.iter_errors(parse_yaml(text).data))


@pytest.mark.parametrize(
    "change",
    [
        ("water_depth: 10 m", "water_depth: 10"),
        ("periods: [4, 5, 6]", "period: 5"),
        ("periods: [4, 5, 6]", "periods: {from: 4 s, to: 6 s, count: 3}"),
        ("heading_deg: 10", "heading_deg: 10 deg"),
        ("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-10, 0.1], [0, 0.2]]},"),
        ("current: {speed: 0.3 m/s,", "current: {speed: 0.3, profile: {power_law: 0.143},"),
        ("    peak_enhancement: 3.3", "    peak_enhancement: 3.3\n    spreading: {kind: cosine_2s, exponent: 10}"),
        ("analyses:", "settings: {frequencies: {from: 0.1 Hz, to: 0.4 Hz, count: 20}, time: {ramp: auto}}\nanalyses:"),
        ("{catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}", "{length: 54.0 m, axial_stiffness: inextensible, submerged_mass: 79.2 kg/m}"),
        ("{shape: rectangle, beam: 10 m, height: 4.5 m}", "{shape: polygon, points: [[-5, 0], [5, 0], [5, 4.5], [-5, 4.5]]}"),
    ],
)  # fmt: skip
def test_schema_and_reader_accept_the_same(validator, change):
    text = changed(change)
    assert faults(text) == []
    assert list(validator.iter_errors(parse_yaml(text).data)) == []


def test_every_kind_has_a_root_schema_and_a_template():
    for kind in structure_kinds():
        assert "structure" in root_schema(kind).model_fields
        assert f"kind: {kind}" in template(kind)


def test_an_example_lies_in_the_range_of_its_key() -> None:
    """A missing peak enhancement of 1 to 20 was to be given 'for instance 0.15'."""
    from moyai.case.schema_types import QuantityOf
    from moyai.core import quantities

    assert QuantityOf(quantities.NUMBER, least=1.0, most=20.0).example == ""
    assert QuantityOf(quantities.NUMBER, above=0.0).example
    assert QuantityOf(quantities.LENGTH, above=0.0).example


def test_what_rounding_leaves_of_zero_is_zero():
    """A place that a script has turned; a length that small by itself is none."""
    from moyai.case.schema_types import Length, PositiveLength

    assert TypeAdapter(Length).validate_python(6.1e-16) == 0.0 and TypeAdapter(Length).validate_python(0.01) == 0.01
    with pytest.raises(ValidationError):
        TypeAdapter(Length).validate_python(1e-150)
    with pytest.raises(ValidationError):
        TypeAdapter(PositiveLength).validate_python(6.1e-16)
