"""The pages of the documentation hold the reference that the schemas give today."""

import json

import pytest
from jsonschema import Draft7Validator
from typer.testing import CliRunner

from moyai.case.reference import called, pages, reference_markdown, renew
from moyai.case.schema import file_json_schema
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.main import app
from moyai.core.kinds import structure_kinds, templates


@pytest.mark.parametrize("name", pages())
def test_the_page_is_up_to_date(request, name):
    page = (request.config.rootpath / "docs" / name).read_text(encoding="utf-8")
    assert renew(page, name) == page, "run: python -m moyai.case.reference docs"


@pytest.mark.parametrize("name", list(templates()))
def test_every_template_is_a_file_of_its_schema(name):
    document = parse_yaml(template(name)).data
    schema = file_json_schema(name)
    faults = [str(fault.message) for fault in Draft7Validator(schema).iter_errors(json.loads(json.dumps(document)))]
    assert faults == []
    misspelt = {**document, "titel": "x"}
    assert list(Draft7Validator(schema).iter_errors(json.loads(json.dumps(misspelt))))


def test_new_without_a_kind_lists_all_of_them():
    said = CliRunner().invoke(app, ["new"])
    assert said.exit_code == 0
    for name in templates():
        assert f"  {name} " in said.stdout
    wrong = CliRunner().invoke(app, ["schema", "recrods"])
    assert wrong.exit_code == 2 and "did you mean 'records'" in wrong.stderr


def test_every_kind_and_key_is_listed():
    text = "".join(reference_markdown(page) for page in pages())
    for kind in structure_kinds():
        assert f"## Case of a {called(kind)}" in text
    for key in ("water_depth", "peak_enhancement", "bilge_radius", "bed_friction", "line_slacks", "from_bearing_deg"):
        assert f"| `{key}` |" in text
    assert "| `draught` |" in text
    assert "length [m], greater than 0 m or 'infinite' | **required** |" in text


@pytest.mark.parametrize("name", pages())
def test_every_key_has_a_meaning(name):
    rows = [line for line in reference_markdown(name).splitlines() if line.startswith("| `")]
    assert rows and not [row for row in rows if not row.split(" | ")[1].strip()]
